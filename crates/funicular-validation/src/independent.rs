//! Fourteen robots, compared with a separate program.

use super::reference::{
    ComplexMatrix, IndependentReference, IndependentRobot, Matrix, ModeList, ReferenceResponse, robot,
};
use super::section::{WRONG, with_scaled};
use super::{
    Bound, Case, ComparedQuantity, Comparison, Declared, DifferenceKind, Level, NegativeControl, largest, over,
    reference, slug, worst,
};
use anyhow::{Result, ensure};
use funicular::cable::{CableModel, Sag};
use funicular::dynamics::{Assembly, Dynamics, DynamicsError, Linearisation};
use funicular::math::{Complex, Mat6, Vec3, Vec6, rotation};
use funicular::modes;
use funicular::response::{self, Quantity};
use funicular::robot::{Damping, Robot, WinchMode};
use funicular::statics::{self, Equilibrium, StaticModel};
use std::f64::consts::TAU;

pub(super) const SECTION: Declared = Declared {
    id: "robots",
    title: "Fourteen robots, computed independently",
    note: "Both programs have the same models and no code in common. The equilibria are found without a given \
           start. All entries of a matrix are compared, moments and rotations divided by the mean distance of the \
           attachments from the origin; the table shows the largest entry. All values of a list are compared; the \
           table shows the last or the largest value.",
    rows: || rows(&reference::independent()?),
    controls: &[
        NegativeControl {
            id: "gravity",
            wrong: "gravity 1 % too large",
            proves: "the weight of platform and cables",
            rows: || of_changed(|toml| with_scaled(toml, "gravity_m_s2", WRONG, usize::MAX)),
        },
        NegativeControl {
            id: "ea",
            wrong: "Young's modulus of the ropes 1 % too large",
            proves: "the stretch of the cables",
            rows: || of_changed(|toml| with_scaled(toml, "youngs_modulus_pa", WRONG, usize::MAX)),
        },
        NegativeControl {
            id: "inertia",
            wrong: "moments of inertia of the platform 1 % too large",
            proves: "the rotation of the platform in its modes",
            rows: || of_changed(|toml| with_scaled(toml, "inertia_kg_m2", WRONG, usize::MAX)),
        },
        NegativeControl {
            id: "lever",
            wrong: "attachment of the first cable mirrored at the origin",
            proves: "the sign of the levers of the cables",
            rows: || of_changed(|toml| with_scaled(toml, "attachment_m", -1.0, 1)),
        },
        NegativeControl {
            id: "damping",
            wrong: "damping ratio of the ropes 1 % too large",
            proves: "the loss in the cables",
            rows: || of_changed(|toml| with_scaled(toml, "damping_ratio", WRONG, usize::MAX)),
        },
    ],
};

fn rows(independent: &IndependentReference) -> Result<Vec<Comparison>> {
    let mut rows = Vec::new();

    for given in &independent.cases {
        let (robot, lengths) = robot(&given.toml)?;
        let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None)?;
        ensure!(
            given.equilibrium.cables.len() == robot.cables.len(),
            "{}: the reference needs one row per cable",
            given.id
        );

        let springs = statics::forward(&robot, &lengths, StaticModel::Spring, None)?;
        let compared = RobotComparison {
            case: Case::new(Level::Program, &independent.about, &slug(&given.id), &given.id),
            given,
            robot,
            rest,
        };

        compared.equilibrium(&mut rows);
        compared.springs(&springs, &mut rows);
        compared.static_stiffness(&mut rows)?;
        compared.shallow_dynamic_stiffness(&mut rows)?;
        compared.modes(&mut rows)?;
        compared.responses(&mut rows)?;
    }

    Ok(rows)
}

/// Compares pairs (theirs, ours), each relative to itself. The pair with the largest reference number is shown.
fn each(quantity: ComparedQuantity, pairs: &[[f64; 2]], tolerance: f64) -> Comparison {
    let difference = worst(pairs.iter().map(|[a, b]| over((a - b).abs(), a.abs())));
    let [a, b] = pairs.iter().copied().max_by(|x, y| x[0].total_cmp(&y[0])).unwrap_or_default();
    let difference = (difference, DifferenceKind::Relative);
    quantity.numbers(pairs.len()).row((&[a], &[b]), difference, tolerance, Bound::Rounding)
}

/// Comparisons of the first robot with a change of its file.
fn of_changed(change: fn(&str) -> String) -> Result<Vec<Comparison>> {
    let mut independent = reference::independent()?;
    independent.cases.truncate(1);
    independent.cases.iter_mut().for_each(|of| of.toml = change(&of.toml));
    rows(&independent)
}

struct RobotComparison<'a> {
    case: Case<'a>,
    given: &'a IndependentRobot,
    robot: Robot,
    rest: Equilibrium,
}

impl RobotComparison<'_> {
    fn equilibrium(&self, rows: &mut Vec<Comparison>) {
        let (case, theirs, cables) = (&self.case, &self.given.equilibrium, &self.given.equilibrium.cables);
        let position: [f64; 3] = self.rest.pose.position_w.into();
        rows.push(case.of("position", "position [m]").absolute(&theirs.position_m, &position, 1e-10, Bound::Rounding));
        let turn = rotation::quaternion_wxyz(&self.rest.pose.rot_wp);
        rows.push(case.of("quaternion", "quaternion w, x, y, z").absolute(
            &theirs.quaternion_wxyz,
            &turn,
            1e-10,
            Bound::Rounding,
        ));

        // Both ends of every cable; the largest is shown.
        let pairs: Vec<[f64; 2]> = cables
            .iter()
            .zip(&self.rest.cables)
            .flat_map(|(a, b)| [[a.tension_platform_n, b.tension_platform], [a.tension_anchor_n, b.tension_anchor]])
            .collect();
        rows.push(each(case.of("tensions", "tensions at both ends, largest [N]"), &pairs, 1e-9));
        let without_strain = self.without_strain(&self.robot);
        let sags: Vec<Sag> =
            self.rest.cables.iter().enumerate().map(|(i, cable)| Sag::of(&without_strain, i, cable)).collect();
        let pairs: Vec<[f64; 2]> = cables.iter().zip(&sags).map(|(a, b)| [a.sag_ratio, b.ratio()]).collect();
        rows.push(each(case.of("sag", "sag over chord, largest"), &pairs, 1e-9));

        let pairs: Vec<[f64; 2]> = cables.iter().zip(&sags).map(|(a, b)| [a.lambda2, b.lambda2]).collect();
        rows.push(each(case.of("lambda2", "λ², largest"), &pairs, 1e-9));
        let pairs: Vec<[f64; 2]> = cables.iter().zip(&self.rest.cables).map(|(a, b)| [a.chord_m, b.chord()]).collect();
        rows.push(each(case.of("chords", "chords, largest [m]"), &pairs, 1e-12));
        let forces = cables.iter().zip(&self.rest.cables).map(|(a, b)| {
            let theirs = Vec3::from(a.force_on_platform_n);
            (b.force_on_platform_w - theirs).norm() / theirs.norm()
        });
        let shown = |force: Vec3| <[f64; 3]>::from(force);
        rows.push(case.of("forces", "forces on the platform, first [N]").numbers(3 * cables.len()).row(
            (&shown(Vec3::from(cables[0].force_on_platform_n)), &shown(self.rest.cables[0].force_on_platform_w)),
            (worst(forces), DifferenceKind::Relative),
            1e-9,
            Bound::Rounding,
        ));
    }

    fn springs(&self, springs: &Equilibrium, rows: &mut Vec<Comparison>) {
        let (case, theirs) = (&self.case, &self.given.spring);
        let position: [f64; 3] = springs.pose.position_w.into();
        rows.push(case.of("springs-position", "springs: position [m]").absolute(
            &theirs.position_m,
            &position,
            1e-10,
            Bound::Rounding,
        ));
        let tensions: Vec<f64> = springs.cables.iter().map(|cable| cable.tension_platform).collect();
        let quantity = "springs: tensions [N]";
        rows.push(case.of("springs-tensions", quantity).together(&theirs.tension_n, &tensions, 1e-9, Bound::Rounding));
    }

    /// Compares matrices by the maximum difference relative to the largest entry, with rotations scaled by ℓ.
    fn matrix(&self, quantity: ComparedQuantity, theirs: &Matrix, ours: &Mat6) -> Comparison {
        let ell = self.robot.platform_length();
        let scale = |i: usize| if i < 3 { 1.0 } else { 1.0 / ell };
        let entries = |of: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
            (0..36).map(|n| of(n / 6, n % 6) * scale(n / 6) * scale(n % 6)).collect()
        };
        let (theirs, ours) = (entries(&|i, j| theirs[i][j]), entries(&|i, j| ours[(i, j)]));
        let mut row = quantity.together(&theirs, &ours, 1e-9, Bound::Rounding);
        let size = largest(&theirs);
        let at = theirs.iter().position(|value| value.abs() >= size).unwrap_or(0);
        (row.theirs, row.ours) = (vec![theirs[at]], vec![ours[at]]);
        row
    }

    fn static_stiffness(&self, rows: &mut Vec<Comparison>) -> Result<()> {
        let consistent = statics::tangent_stiffness(&self.robot, &self.rest).ok_or(DynamicsError::Rigid)?;
        let theirs = &self.given.static_tangent_consistent;
        let quantity = self.case.of("tangent", "static stiffness, consistent [N/m]");
        rows.push(self.matrix(quantity, theirs, &consistent));
        let linearisation = Linearisation {
            cable_model: CableModel::CatenaryStatic,
            assembly: Assembly::WithoutGeometricStiffness,
            in_plane_only: false,
            winches: WinchMode::AsGiven,
        };
        let end_stiffness = Dynamics::about(&self.robot, &self.rest, linearisation, 0.0)?.stiffness(0.0).map(|k| k.re);
        rows.push(self.matrix(
            self.case.of("tangent-without-geometric", "static stiffness, without geometric stiffness [N/m]"),
            &self.given.static_tangent_paper,
            &end_stiffness,
        ));
        Ok(())
    }

    fn shallow_dynamic(
        &self,
        robot: &Robot,
        assembly: Assembly,
        in_plane_only: bool,
    ) -> Result<Dynamics, DynamicsError> {
        let linearisation = Linearisation {
            cable_model: CableModel::ShallowDynamic,
            assembly,
            in_plane_only,
            winches: WinchMode::AsGiven,
        };
        Dynamics::about(&self.without_strain(robot), &self.rest, linearisation, self.given.modes.below_hz)
    }

    /// The robot with ropes whose stretched cables have the EA, mass and damping per length of the file. The reference
    /// takes these numbers for shallow cables and leaves out their strain, as the paper does (docs/theory.md, equation
    /// (18a)).
    fn without_strain(&self, robot: &Robot) -> Robot {
        let mut robot = robot.clone();
        for (cable, state) in robot.cables.iter_mut().zip(&self.rest.cables) {
            let Some(hanging) = &state.hanging else { continue };
            let stretched = cable.material.axial_stiffness;
            cable.material.axial_stiffness -= hanging.catenary.parallel_tension();
            let stretch = stretched / cable.material.axial_stiffness;
            cable.material.mass_per_length *= stretch;
            if let Damping::Viscous(damping) = &mut cable.material.damping {
                *damping *= stretch;
            }
        }
        robot
    }

    fn shallow_dynamic_stiffness(&self, rows: &mut Vec<Comparison>) -> Result<()> {
        let given = self.given;
        let omega = given.closed_form_at_hz * TAU;
        let mut quiet = self.robot.clone();

        for cable in &mut quiet.cables {
            cable.material.damping = Damping::Ratio(0.0);
        }

        let at = format!("shallow-dynamic at {} Hz", given.closed_form_at_hz);
        for (assembly, in_plane_only, id, name, theirs) in [
            (Assembly::Consistent, false, "shallow", "consistent", &given.closed_form_consistent_undamped),
            (
                Assembly::WithoutGeometricStiffness,
                false,
                "shallow-without-geometric",
                "without geometric stiffness",
                &given.closed_form_paper_undamped,
            ),
            (
                Assembly::Consistent,
                true,
                "shallow-in-plane",
                "in plane only",
                &given.closed_form_consistent_in_plane_only_undamped,
            ),
        ] {
            let k = self.shallow_dynamic(&quiet, assembly, in_plane_only)?.stiffness(omega).map(|k| k.re);
            rows.push(self.matrix(self.case.of(id, &format!("{at}, {name} [N/m]")), theirs, &k));
        }

        let k = self.shallow_dynamic(&self.robot, Assembly::Consistent, false)?.stiffness(omega);
        let ComplexMatrix { real, imag } = &given.closed_form_consistent_damped;
        let quantity = format!("{at}, damped, real part [N/m]");
        rows.push(self.matrix(self.case.of("shallow-damped-real", &quantity), real, &k.map(|k| k.re)));
        let quantity = format!("{at}, damped, imaginary part [N/m]");
        rows.push(self.matrix(self.case.of("shallow-damped-imaginary", &quantity), imag, &k.map(|k| k.im)));

        Ok(())
    }

    fn modes(&self, rows: &mut Vec<Comparison>) -> Result<()> {
        for (in_plane_only, id, name, theirs) in [
            (false, "", "", &self.given.modes),
            (true, "-in-plane", ", in plane only", &self.given.modes_in_plane_only),
        ] {
            let ModeList { below_hz, frequencies_hz, platform_at_rest } = theirs;
            let found =
                modes::below(&self.shallow_dynamic(&self.robot, Assembly::Consistent, in_plane_only)?, *below_hz);

            let count = format!("modes below {below_hz} Hz{name}");
            // A list that its mode count does not certify does not pass.
            let certified = if found.certified { found.modes.len() } else { 0 };
            rows.push(self.case.of(&format!("count{id}"), &count).count(frequencies_hz.len(), certified));

            let resting: f64 = platform_at_rest.iter().map(|(_, several)| several).sum();
            let found_resting = found.modes.iter().filter(|mode| mode.platform_energy_fraction == 0.0).count();
            rows.push(
                self.case
                    .of(&format!("resting{id}"), &format!("of them with the platform at rest{name}"))
                    .count(resting as usize, found_resting),
            );

            let pairs: Vec<[f64; 2]> =
                frequencies_hz.iter().zip(&found.modes).map(|(a, b)| [*a, b.frequency_hz]).collect();
            rows.push(each(
                self.case.of(&format!("frequencies{id}"), &format!("natural frequencies{name}, last [Hz]")),
                &pairs,
                1e-10,
            ));
        }

        Ok(())
    }

    fn responses(&self, rows: &mut Vec<Comparison>) -> Result<()> {
        let dynamics = self.shallow_dynamic(&self.robot, Assembly::Consistent, false)?;
        let along = |direction_w: Vec3, point_p: Vec3| response::along(&direction_w, &point_p, &self.rest.pose);
        let frf = &self.given.frf;
        let (up, aside) = (along(Vec3::z(), Vec3::zeros()), along(Vec3::y(), Vec3::zeros()));
        let ours = |frequencies: &[f64], input: &Vec6, output: &Vec6, quantity| {
            response::frf(&dynamics, frequencies, input, output, quantity)
        };

        let az = ours(&frf.frequency_hz, &up, &up, Quantity::Acceleration)?;
        let ay = ours(&frf.frequency_hz, &up, &aside, Quantity::Acceleration)?;
        rows.push(Self::response(
            self.case.of("accelerance-z", "accelerance az/fz, largest [1/kg]"),
            &frf.az,
            &frf.az,
            &az,
        ));
        // For a symmetric robot ay is zero, so its difference is relative to az.
        rows.push(Self::response(
            self.case.of("accelerance-y", "accelerance ay/fz, largest [1/kg]"),
            &frf.ay,
            &frf.az,
            &ay,
        ));

        let offset = &self.given.frf_offset;
        let input = along(Vec3::from(offset.input_direction_w), Vec3::from(offset.input_point_p));
        let output = along(Vec3::from(offset.output_direction_w), Vec3::from(offset.output_point_p));
        let x = ours(&offset.frequency_hz, &input, &output, Quantity::Displacement)?;
        let quantity = self.case.of("receptance", "receptance between offset points, largest [m/N]");
        rows.push(Self::response(quantity, &offset.response, &offset.response, &x));
        Ok(())
    }

    /// Compares responses relative to the larger of the reference and `scale` at each frequency. The largest modulus
    /// is shown.
    fn response(
        quantity: ComparedQuantity,
        theirs: &ReferenceResponse,
        scale: &ReferenceResponse,
        ours: &[Complex],
    ) -> Comparison {
        let complex = |of: &ReferenceResponse| -> Vec<Complex> {
            of.real.iter().zip(&of.imag).map(|(re, im)| Complex::new(*re, *im)).collect()
        };
        let (theirs, scale) = (complex(theirs), complex(scale));
        let gaps = (0..theirs.len().max(ours.len())).map(|i| match (theirs.get(i), scale.get(i), ours.get(i)) {
            (Some(a), Some(s), Some(b)) => (b - a).norm() / s.norm().max(a.norm()),
            _ => f64::NAN,
        });
        let difference = worst(gaps);
        let shown = |of: &[Complex]| largest(&of.iter().map(|z| z.norm()).collect::<Vec<_>>());
        let shown = (&[shown(&theirs)][..], &[shown(ours)][..]);
        quantity.numbers(2 * theirs.len()).row(shown, (difference, DifferenceKind::Relative), 1e-8, Bound::Rounding)
    }
}

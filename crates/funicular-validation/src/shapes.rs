//! Shapes of undamped modes: energies, modal masses, displacements along the cables.

use super::reference::{ModeShape, ShapesOfRobot, robot};
use super::{Bound, Case, ComparedQuantity, Comparison, DifferenceKind, Level, largest, worst};
use anyhow::{Context, Result, ensure};
use funicular::cable_motion::CableStations;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::Vec3;
use funicular::modes::{self, Kind as ModeKind, Mode};
use funicular::robot::Robot;
use funicular::statics::{self, Equilibrium, StaticModel};

/// Maximum differences of one mode.
struct Differences {
    /// Relative difference of the frequency.
    frequency: f64,
    /// Absolute difference of energy fractions, divided by 1 + 0.001/gap.
    energy: f64,
    /// Relative difference of the modal mass, divided by 1 + 0.001/gap; `None` with the platform at rest.
    modal_mass: Option<f64>,
    /// Difference of displacements, relative to the largest displacement.
    shape: f64,
}

/// Compares the modes of one robot: one row per quantity.
pub(super) fn of_robot(source: &str, given: &ShapesOfRobot, toml: &str) -> Result<Vec<Comparison>> {
    let case = Case::new(Level::Program, source, &format!("{}/shapes", given.robot), &given.robot);
    let (robot, lengths) = robot(toml)?;
    let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None)?;
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), given.below_hz)?;
    let list = modes::below(&dynamics, given.below_hz).modes;
    ensure!(!given.modes.is_empty(), "{}: no modes to compare", given.robot);

    let compared = ShapeComparison { robot: &robot, rest: &rest, dynamics: &dynamics, fractions: &given.fractions };
    let pairs = given.modes.iter().map(|theirs| Some((theirs, list.get(theirs.index)?)));
    let pairs: Vec<_> = pairs.collect::<Option<_>>().context("a mode that the list does not have")?;
    let all = pairs.iter().map(|(theirs, ours)| compared.differences(theirs, ours)).collect::<Result<Vec<_>>>()?;
    let rests = |ours: &Mode| ours.kind == ModeKind::Cable && ours.shape.iter().all(|x| *x == 0.0);
    let at_rest = pairs.iter().filter(|(_, ours)| rests(ours)).count();
    let last_moving = pairs.iter().rev().find_map(|(theirs, ours)| Some((*theirs, *ours, theirs.modal_mass_kg?)));
    let (theirs, ours, modal_mass) = last_moving.context("a mode that moves the platform")?;

    let platform = theirs.kinetic_energy_fraction["platform"];
    let several = given.modes.len();
    let row =
        |quantity: ComparedQuantity, kind: DifferenceKind, shown: (f64, f64), differences: Vec<f64>, tolerance| {
            let difference = (worst(differences.into_iter()), kind);
            quantity.numbers(several).row((&[shown.0], &[shown.1]), difference, tolerance, Bound::Elements)
        };
    Ok(vec![
        case.of("resting", &format!("modes with the platform at rest, of {several}"))
            .count(given.modes.iter().filter(|mode| mode.platform_at_rest).count(), at_rest),
        row(
            case.of("frequencies", &format!("{several} natural frequencies, last that moves the platform [Hz]")),
            DifferenceKind::Relative,
            (theirs.frequency_hz, ours.frequency_hz),
            all.iter().map(|d| d.frequency).collect(),
            1e-11,
        ),
        // The error of an eigenvector is the error of the frequency divided by the gap to the next one: 1e-12/gap.
        row(
            case.of("energies", "fractions of the kinetic energy, divided by 1 + 0.001/gap; platform's"),
            DifferenceKind::Absolute,
            (platform, ours.platform_energy_fraction),
            all.iter().map(|d| d.energy).collect(),
            1e-9,
        ),
        row(
            case.of("modal-masses", "modal masses, divided by 1 + 0.001/gap, last [kg]"),
            DifferenceKind::Relative,
            (modal_mass, ours.modal_mass),
            all.iter().filter_map(|d| d.modal_mass).collect(),
            1e-8,
        ),
        // Cables are resolved until their frequencies are known to 1e-11. Errors of the shape enter frequencies
        // squared.
        row(
            case.of("displacements", "displacements of the cables, largest [m/√kg]"),
            DifferenceKind::Relative,
            compared.largest_displacements(theirs, ours)?,
            all.iter().map(|d| d.shape).collect(),
            3e-6,
        ),
    ])
}

struct ShapeComparison<'a> {
    robot: &'a Robot,
    rest: &'a Equilibrium,
    dynamics: &'a Dynamics,
    fractions: &'a [f64],
}

impl ShapeComparison<'_> {
    fn differences(&self, theirs: &ModeShape, ours: &Mode) -> Result<Differences> {
        let nearness = 1.0 + 1e-3 / theirs.relative_gap_to_neighbour;

        let energies = &theirs.kinetic_energy_fraction;
        let fraction = |name: &str| energies.get(name).copied().unwrap_or(f64::NAN);
        let of_cables = self.robot.cables.iter().zip(&ours.cable_energy_fractions);
        let gaps = of_cables.map(|(cable, ours)| (ours - fraction(&cable.name)).abs());
        let energy = worst(gaps.chain([(ours.platform_energy_fraction - fraction("platform")).abs()]));

        let (a, b) = self.displacements(theirs, ours)?;
        // The sign of a shape is free, but it is the same for all cables of the mode.
        let off = |sign: f64| worst(a.iter().zip(&b).map(|(a, b)| (a - sign * b).abs()));
        let (same, opposite) = (off(1.0), off(-1.0));
        let shape = if opposite < same { opposite } else { same } / largest(&a);

        Ok(Differences {
            frequency: (ours.frequency_hz / theirs.frequency_hz - 1.0).abs(),
            energy: energy / nearness,
            modal_mass: theirs.modal_mass_kg.map(|mass| (ours.modal_mass / mass - 1.0).abs() / nearness),
            shape,
        })
    }

    /// Displacements of all cables in the reference and in the program, for unit modal mass, world axes.
    fn displacements(&self, theirs: &ModeShape, ours: &Mode) -> Result<(Vec<f64>, Vec<f64>)> {
        let (mut a, mut b) = (Vec::new(), Vec::new());
        for (i, cable) in self.robot.cables.iter().enumerate() {
            let stations = CableStations::new(self.robot, self.rest, self.dynamics, i, self.fractions, false)?;
            let axes = stations.axes;
            let given = theirs.cable_displacement_m.get(&cable.name).context("displacements of every cable")?;
            ensure!(given.len() == self.fractions.len(), "a displacement at every place");
            for (moved, expected) in stations.in_mode(self.dynamics, ours).into_iter().zip(given) {
                let [e, n, across] = moved;
                let moved: Vec3 = (axes.e * e + axes.n * n + axes.b * across) / ours.modal_mass.sqrt();
                a.extend(expected);
                b.extend(moved.iter());
            }
        }
        Ok((a, b))
    }

    fn largest_displacements(&self, theirs: &ModeShape, ours: &Mode) -> Result<(f64, f64)> {
        let (a, b) = self.displacements(theirs, ours)?;
        Ok((largest(&a), largest(&b)))
    }
}

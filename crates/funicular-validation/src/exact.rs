//! Cable model `catenary-dynamic`, of single cables and in robots.

use super::reference::{ExactCable, ExactReference, ExactRobot, IndependentReference, Published, robot};
use super::section::WRONG;
use super::{
    Bound, Case, ComparedQuantity, Comparison, Declared, DifferenceKind, Level, NegativeControl, largest, reference,
    slug, worst,
};
use anyhow::{Context, Result};
use funicular::cable::CableModel;
use funicular::cable::catenary_dynamic::CatenaryDynamic;
use funicular::catenary::space::HangingCable;
use funicular::catenary::{Catenary, Rope};
use funicular::dynamics::{Assembly, Dynamics, Linearisation};
use funicular::math::{Complex, Mat3, Vec3};
use funicular::modes;
use funicular::response::{self, Quantity};
use funicular::robot::WinchMode;
use funicular::statics::{self, StaticModel};
use std::f64::consts::TAU;

pub(super) const SECTION: Declared = Declared {
    id: "catenary-dynamic",
    title: "Catenary-dynamic cables, computed independently",
    note: "Vibration about the elastic catenary, of any sag, axial waves included. The other program uses finite \
           elements in extended precision and transfer matrices; ours one element of high degree and its poles. Of \
           lists and matrices the last or largest value is shown and all are compared. The vertical cable of the \
           literature does not stretch; ours has an axial stiffness of 1e10 N.",
    rows: || rows(&reference::published()?, &reference::exact()?, &reference::independent()?),
    controls: &[
        NegativeControl {
            id: "axial-inertia",
            wrong: "cable model shallow-dynamic, which has no axial inertia",
            proves: "axial waves, and the shape of the sag",
            rows: || of_first(CableModel::ShallowDynamic, |_| ()),
        },
        NegativeControl {
            id: "ea",
            wrong: "axial stiffness EA of the single cables 1 % too large",
            proves: "the stretch of a vibrating cable",
            rows: || of_first(CableModel::CatenaryDynamic, |of| of.axial_stiffness_n *= WRONG),
        },
        NegativeControl {
            id: "mass",
            wrong: "mass per length of the single cables 1 % too large",
            proves: "the mass of a vibrating cable",
            rows: || of_first(CableModel::CatenaryDynamic, |of| of.mass_kg_per_m *= WRONG),
        },
        NegativeControl {
            id: "viscous",
            wrong: "viscous damping of the single cables 1 % too large",
            proves: "the loss in a vibrating cable",
            rows: || of_first(CableModel::CatenaryDynamic, |of| of.end_stiffness.viscous_n_s_m2 *= WRONG),
        },
    ],
};

fn rows(published: &Published, reference: &ExactReference, robots: &IndependentReference) -> Result<Vec<Comparison>> {
    let mut rows = of_exact(reference, robots, CableModel::CatenaryDynamic)?;
    rows.extend(bessel(published)?);
    Ok(rows)
}

/// Comparisons with the separate program.
fn of_exact(reference: &ExactReference, robots: &IndependentReference, model: CableModel) -> Result<Vec<Comparison>> {
    let mut rows = Vec::new();

    for cable in &reference.cables {
        rows.extend(alone(&reference.about, cable)?);
    }
    for case in &reference.robots {
        let toml = &robots.cases.iter().find(|other| other.id == case.id).context("a robot of independent.json")?.toml;
        rows.extend(in_robot(&reference.about, case, toml, model)?);
    }

    Ok(rows)
}

/// Comparisons of the first cable with a change, and of the first robot with a cable model.
fn of_first(model: CableModel, change: fn(&mut ExactCable)) -> Result<Vec<Comparison>> {
    let (mut exact, independent) = (reference::exact()?, reference::independent()?);
    exact.cables.truncate(1);
    exact.robots.truncate(1);
    exact.cables.iter_mut().for_each(change);
    of_exact(&exact, &independent, model)
}

fn alone(source: &str, of: &ExactCable) -> Result<Vec<Comparison>> {
    let case = Case::new(Level::Program, source, &slug(&of.id), &of.id);
    let gravity = Vec3::from(of.gravity_m_s2);
    let rope = Rope {
        unstrained_length: of.unstrained_length_m,
        weight_per_length: of.mass_kg_per_m * gravity.norm(),
        axial_stiffness: of.axial_stiffness_n,
    };
    let hanging = HangingCable::new(Vec3::from(of.start_m), Vec3::from(of.end_m), -gravity.normalize(), rope)?;
    let all = [&of.clamped_in_plane_hz, &of.clamped_out_of_plane_hz, &of.end_stiffness.frequency_hz];

    let highest = worst(all.iter().map(|list| largest(list)));
    let exact = CatenaryDynamic::new(&hanging.catenary, of.mass_kg_per_m, 1.01 * highest * TAU)?;
    let hertz = |squares: &[f64]| squares.iter().map(|square| square.sqrt() / TAU).collect::<Vec<_>>();
    let (in_plane, across) = (hertz(&exact.in_plane.poles), hertz(&exact.out_of_plane.poles));

    Ok(vec![
        last(case.of("in-plane", "clamped frequencies in plane, last [Hz]"), &of.clamped_in_plane_hz, &in_plane, 1e-9),
        last(
            case.of("out-of-plane", "clamped frequencies out of plane, last [Hz]"),
            &of.clamped_out_of_plane_hz,
            &across,
            1e-9,
        ),
        platform_end(&case, of, &hanging, &exact),
        both_ends(&case, of, &hanging, &exact),
    ])
}

/// Compares each frequency relative to itself. The program may find more frequencies than the reference lists.
fn last(quantity: ComparedQuantity, theirs: &[f64], ours: &[f64], tolerance: f64) -> Comparison {
    let gaps = theirs.iter().enumerate().map(|(i, a)| ours.get(i).map_or(f64::NAN, |b| (b / a - 1.0).abs()));
    let at = theirs.len().saturating_sub(1);
    let shown = (theirs.get(at..).unwrap_or_default(), ours.get(at..=at).unwrap_or_default());
    let numbers = theirs.len();
    quantity.numbers(numbers).row(shown, (worst(gaps), DifferenceKind::Relative), tolerance, Bound::Elements)
}

/// Compares the stiffness of the start of the cable with the end fixed, at all frequencies.
fn platform_end(case: &Case, of: &ExactCable, hanging: &HangingCable, exact: &CatenaryDynamic) -> Comparison {
    let (h, v) = hanging.axes_w();
    let b = h.cross(&v);
    let of = &of.end_stiffness;
    let mut gaps = Vec::new();
    let mut shown = (0.0, 0.0);

    for (frequency, matrix) in of.frequency_hz.iter().zip(&of.undamped) {
        let k = exact.undamped(frequency * TAU);
        let mixed = h * v.transpose();
        let ours: Mat3 = h * h.transpose() * k.axial
            + (mixed + mixed.transpose()) * k.coupling
            + v * v.transpose() * k.normal
            + b * b.transpose() * k.out_of_plane;
        let theirs = Mat3::from_fn(|i, j| matrix[i][j]);
        gaps.push((ours - theirs).amax() / theirs.amax());
        shown = (theirs.amax(), ours.amax());
    }

    let quantity = "end stiffness, largest at the last frequency [N/m]";
    case.of("end-stiffness", quantity).row(
        (&[shown.0], &[shown.1]),
        (worst(gaps.into_iter()), DifferenceKind::Relative),
        1e-9,
        Bound::Elements,
    )
}

/// Compares the 6×6 stiffness of both ends at all frequencies, undamped and with either damping of the rope.
fn both_ends(case: &Case, of: &ExactCable, hanging: &HangingCable, exact: &CatenaryDynamic) -> Comparison {
    let theirs = &of.end_stiffness;
    let mut gaps = Vec::new();
    let mut shown = (0.0, 0.0);

    for (k, frequency) in theirs.frequency_hz.iter().enumerate() {
        let omega = frequency * TAU;
        let square = omega * omega;
        // Either damping makes ω² complex: equation (27).
        let with_ratio = Complex::new(square, -2.0 * theirs.xi * square);
        let with_viscosity = Complex::new(square, -theirs.viscous_n_s_m2 * omega / of.mass_kg_per_m);
        for (square, real, imag) in [
            (Complex::new(square, 0.0), &theirs.undamped, None),
            (with_ratio, &theirs.xi_real, Some(&theirs.xi_imag)),
            (with_viscosity, &theirs.viscous_real, Some(&theirs.viscous_imag)),
        ] {
            let expected = |i: usize, j: usize| Complex::new(real[k][i][j], imag.map_or(0.0, |imag| imag[k][i][j]));
            let ours = end_matrix(hanging, exact, square);
            let places = || (0..36).map(|n| (n / 6, n % 6));
            let size = worst(places().map(|(i, j)| expected(i, j).norm()));
            gaps.extend(places().map(|(i, j)| (ours[i][j] - expected(i, j)).norm() / size));
            shown = (size, worst(ours.iter().flatten().map(|entry| entry.norm())));
        }
    }

    let quantity =
        format!("stiffness of both ends, undamped, ξ = {}, {} N s/m², last [N/m]", theirs.xi, theirs.viscous_n_s_m2);
    case.of("both-ends", &quantity).row(
        (&[shown.0], &[shown.1]),
        (worst(gaps.into_iter()), DifferenceKind::Relative),
        1e-9,
        Bound::Elements,
    )
}

/// Stiffness of both ends in world axes, start first, at a complex ω².
fn end_matrix(hanging: &HangingCable, exact: &CatenaryDynamic, square: Complex) -> [[Complex; 6]; 6] {
    let (h, v) = hanging.axes_w();
    let (pair, b) = ([h, v], h.cross(&v));
    std::array::from_fn(|row| {
        std::array::from_fn(|column| {
            // Index of the end and of the world component.
            let ((end, i), (other, j)) = ((row / 3, row % 3), (column / 3, column % 3));
            let across = exact.out_of_plane.entry(end, other, square);
            let in_plane = (0..4).map(|n| {
                let (p, q) = (n / 2, n % 2);
                let entry = exact.in_plane.entry(2 * end + p, 2 * other + q, square);
                entry * pair[p][i] * pair[q][j]
            });
            across * b[i] * b[j] + in_plane.sum::<Complex>()
        })
    })
}

fn in_robot(source: &str, of: &ExactRobot, toml: &str, cable_model: CableModel) -> Result<Vec<Comparison>> {
    let case = Case::new(Level::Program, source, &slug(&of.id), &of.id);
    let (robot, lengths) = robot(toml)?;
    let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None)?;

    let linearisation = Linearisation {
        cable_model,
        assembly: Assembly::Consistent,
        in_plane_only: false,
        winches: WinchMode::AsGiven,
    };
    let dynamics = Dynamics::about(&robot, &rest, linearisation, of.below_hz)?;
    let found = modes::below(&dynamics, of.below_hz);

    // A list that its mode count does not certify does not pass.
    let certified = if found.certified { found.modes.len() } else { 0 };
    let frequencies: Vec<f64> = found.modes.iter().map(|mode| mode.frequency_hz).collect();
    let z = response::along(&Vec3::z(), &Vec3::zeros(), &rest.pose);
    let ours = response::frf(&dynamics, &of.frf.frequency_hz, &z, &z, Quantity::Acceleration)?;
    let theirs: Vec<Complex> =
        of.frf.response.real.iter().zip(&of.frf.response.imag).map(|(re, im)| Complex::new(*re, *im)).collect();

    let gaps = theirs.iter().enumerate().map(|(i, a)| ours.get(i).map_or(f64::NAN, |b| (b - a).norm() / a.norm()));
    let modulus = |of: &[Complex]| [largest(&of.iter().map(|z| z.norm()).collect::<Vec<_>>())];

    Ok(vec![
        case.of("count", &format!("modes below {} Hz", of.below_hz)).count(of.frequencies_hz.len(), certified),
        last(case.of("frequencies", "natural frequencies, last [Hz]"), &of.frequencies_hz, &frequencies, 1e-9),
        case.of("accelerance", "accelerance az/fz, largest [1/kg]").numbers(2 * theirs.len()).row(
            (&modulus(&theirs), &modulus(&ours)),
            (worst(gaps), DifferenceKind::Relative),
            1e-8,
            Bound::Elements,
        ),
    ])
}

fn bessel(published: &Published) -> Result<Vec<Comparison>> {
    const STIFF: f64 = 1e10;
    let of = &published.bessel_cable;
    let weight_per_length = of.mass_kg_per_m * of.gravity_m_s2;
    let mut rows = Vec::new();
    for row in &of.rows {
        let rope = Rope { unstrained_length: of.length_m, weight_per_length, axial_stiffness: STIFF };
        let mean = row.lower_tension_n + 0.5 * weight_per_length * of.length_m;
        let cable = Catenary::between(0.0, of.length_m * (1.0 + mean / STIFF), rope)?;
        let exact = CatenaryDynamic::new(&cable, of.mass_kg_per_m, 1.2 * row.clamped_rad_per_s[2])?;
        let found: Vec<f64> = exact.out_of_plane.poles.iter().take(3).map(|square| square.sqrt()).collect();
        let case = Case::new(
            Level::Exact,
            &of.source,
            &format!("bessel/{}n", row.lower_tension_n),
            &format!("vertical, {} N below", row.lower_tension_n),
        );
        let stretch = Bound::Model("stretch, T/EA");
        rows.push(case.of("clamped", "first clamped ω [rad/s]").relative(
            &row.clamped_rad_per_s,
            &found,
            1e-7,
            stretch,
        ));
    }
    Ok(rows)
}

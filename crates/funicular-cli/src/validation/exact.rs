//! Exact cables, alone and in the fourteen robots, against a separate program.

use super::reference::{Exact as Given, Independent, robot};
use super::{Bound, Case, Kind, Row, Section, over, worst};
use anyhow::{Context, Result};
use funicular::cable::CableModel;
use funicular::cable::exact::Exact;
use funicular::catenary::Rope;
use funicular::catenary::space::HangingCable;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{Complex, Vec3};
use funicular::modes;
use funicular::response::{self, Direction, Quantity};
use funicular::statics::{self, StaticModel};
use std::f64::consts::TAU;

pub(super) fn section(exact: &Given, independent: &Independent) -> Result<Section> {
    let mut rows = Vec::new();
    for cable in &exact.cables {
        let case = Case { name: cable.id.clone(), source: &exact.about };
        let gravity = Vec3::from(cable.gravity_m_s2);
        let rope = Rope {
            unstrained_length: cable.unstrained_length_m,
            weight_per_length: cable.mass_kg_per_m * gravity.norm(),
            axial_stiffness: cable.axial_stiffness_n,
        };
        let hanging = HangingCable::new(Vec3::from(cable.start_m), Vec3::from(cable.end_m), -gravity, rope)?;
        for (name, theirs, in_plane) in
            [("in plane", &cable.clamped_in_plane_hz, true), ("out of plane", &cable.clamped_out_of_plane_hz, false)]
        {
            let last = theirs.iter().copied().fold(0.0, f64::max);
            let ours = Exact::new(&hanging.catenary, cable.mass_kg_per_m, 1.01 * last * TAU)?;
            let poles = if in_plane { &ours.in_plane.poles } else { &ours.out_of_plane.poles };
            let ours: Vec<f64> = poles.iter().take(theirs.len()).map(|pole| pole.sqrt() / TAU).collect();
            rows.push(last_of(&case, &format!("first twelve clamped frequencies {name}, last [Hz]"), theirs, &ours));
        }
    }
    for given in &exact.robots {
        let case = Case { name: given.id.clone(), source: &exact.about };
        let text = &independent.cases.iter().find(|case| case.id == given.id).context("a robot without a file")?.toml;
        let (robot, lengths) = robot(text)?;
        let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None)?;
        let linearisation = Linearisation { cable_model: CableModel::Exact, ..Linearisation::default() };
        let dynamics = Dynamics::about(&robot, &rest, linearisation, given.below_hz)?;
        let found = modes::below(&dynamics, given.below_hz);
        let certified = if found.certified { found.modes.len() } else { 0 };
        rows.push(case.count(&format!("modes below {} Hz", given.below_hz), given.frequencies_hz.len(), certified));
        let ours: Vec<f64> = found.modes.iter().map(|mode| mode.frequency_hz).collect();
        rows.push(last_of(&case, "natural frequencies, last [Hz]", &given.frequencies_hz, &ours));
        let z = Direction::Along { direction_w: Vec3::z(), point_p: Vec3::zeros() }.vector(&rest.pose);
        let ours = response::frf(&dynamics, &given.frf.frequency_hz, &z, &z, Quantity::Acceleration)?;
        let theirs: Vec<Complex> =
            given.frf.real.iter().zip(&given.frf.imag).map(|(re, im)| Complex::new(*re, *im)).collect();
        let difference = worst(theirs.iter().zip(&ours).map(|(a, b)| (a - b).norm() / a.norm()));
        let most = |of: &[Complex]| of.iter().map(|z| z.norm()).fold(0.0, f64::max);
        let (shown, measure) = ((&[most(&theirs)][..], &[most(&ours)][..]), (difference, Kind::Relative));
        rows.push(case.row("accelerance az/fz, largest [1/kg]", shown, measure, 1e-8, Bound::Rounding));
    }
    Ok(Section {
        title: "Exact cables, computed independently",
        note: "Vibration about the elastic catenary, of any sag, axial waves included. The other program uses finite \
               elements in extended precision and transfer matrices; ours one element of high degree and its poles. Of \
               lists the last value is shown and all are compared.",
        rows,
    })
}

/// All numbers of two lists, each over its own size; the last ones are shown.
fn last_of(case: &Case<'_>, quantity: &str, theirs: &[f64], ours: &[f64]) -> Row {
    let difference = if theirs.len() == ours.len() {
        worst(theirs.iter().zip(ours).map(|(a, b)| over((a - b).abs(), *a)))
    } else {
        f64::NAN
    };
    let shown = (&theirs[theirs.len().saturating_sub(1)..], &ours[ours.len().saturating_sub(1)..]);
    case.row(quantity, shown, (difference, Kind::Relative), 1e-9, Bound::Rounding)
}

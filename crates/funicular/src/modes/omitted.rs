//! Bounds of what the modes above a limit add to the motion and to the tensions that commanded lengths excite
//! (docs/theory.md, equations (46i1) to (46i3)).
//!
//! Relative to the place where its lengths hold it at rest, the robot is driven by the inertia of that place. A mode
//! takes part with `p_k`, the mass product of its shape with the displacements of slow lengths. The squares of all
//! `p_k` add up to the mass of these displacements, as the compliances of all modes add up to the static one, so that
//! what the known modes leave of both bounds the others.

use super::command::LengthCommand;
use super::decay::point_rows;
use super::{Modes, release};
use crate::cable::catenary_dynamic::DriveSignal;
use crate::dynamics::Dynamics;
use crate::math::{Complex, DMat, DVec, Vec3, Vec6};
use std::f64::consts::TAU;

/// Modes above the limit of a list, in the motion of a point and in the mean tensions of the cables.
#[derive(Debug, Clone, PartialEq)]
pub struct OmittedModes {
    /// Compliance of the point along all axes that the listed modes leave [m/N].
    compliance: f64,
    /// Mass of the displacements by slow lengths that the listed modes leave, per pair of cables [kg].
    mass: DMat,
    /// Limit of the list [rad/s].
    above: f64,
    /// Stiffness of the stretch of each cable [N/m].
    stretch: Vec<f64>,
}

/// Bounds for one command.
#[derive(Debug, Clone, PartialEq)]
pub struct OmittedMotion {
    /// Distance that they move the point from the end of the command on [m].
    pub distance: f64,
    /// Change of the tension of each cable, averaged along it, at any time [N].
    pub mean_tensions: Vec<f64>,
}

/// Frequency at which the mass of slow displacements is found, over the first natural frequency: its error is four
/// times the fourth power, and rounding takes 1e-16 over the square.
const SLOW: f64 = 1e-2;

/// Part of the mass below which a mass that is left is rounding.
const ROUNDING: f64 = 1e-8;

impl OmittedModes {
    /// Modes above the limit of a list, for a point at `arm_w` from the platform origin, world axes [m], and cables
    /// whose stretch has a stiffness [N/m]. The dynamics have no losses. `None` for a robot whose lengths have no such
    /// bound: with motors that turn, flexible supports, or a cable without a commanded length.
    pub fn of(lossless: &Dynamics, modes: &Modes, arm_w: &Vec3, stretch: Vec<f64>) -> Option<Self> {
        let above = TAU * modes.below_hz;
        let first = modes.modes.first().map_or(above, |mode| TAU * mode.frequency_hz);
        let whole = slow_mass(lossless, SLOW * first)?;
        let mut mass = whole.clone();
        for mode in &modes.modes {
            let omega = TAU * mode.frequency_hz;
            let Some(rows) = forces_by_lengths(lossless, omega) else { continue };
            let part = DVec::from_iterator(rows.len(), rows.iter().map(|row| row.dot(&mode.motion.platform)));
            let part = part / (omega * omega);
            // A mode at a clamped frequency of a cable has no finite row: it stays in what is left.
            if part.iter().all(|of| of.is_finite()) && mode.platform_energy_fraction > 0.0 {
                mass -= &part * part.transpose();
            }
        }

        let size = whole.diagonal().max();
        if !(size.is_finite() && mass.diagonal().min() >= -MAX_NEGATIVE * size) {
            return None;
        }
        mass += DMat::identity(mass.nrows(), mass.nrows()) * (ROUNDING * size);
        let rows = point_rows(lossless, arm_w);
        let compliance = rows.iter().map(|row| release::left_of_compliance(lossless, modes, row)).sum();
        Some(Self { compliance, mass, above, stretch })
    }

    /// Bounds for a command.
    pub fn bounds(&self, command: &LengthCommand) -> OmittedMotion {
        let size = |of: &[f64]| {
            let of = DVec::from_column_slice(of);
            of.dot(&(&self.mass * &of)).max(0.0).sqrt()
        };
        // Bounds of the integral of the acceleration of the lengths with e^{iωt}, at the end and at any time.
        let [at_end, at_any] = match command {
            LengthCommand::Stop { rates, profile } => {
                let passed = passed(profile.boxes(), self.above);
                [passed.iter().product::<f64>(), passed.first().copied().unwrap_or(1.0)].map(|of| of * size(rates))
            }
            LengthCommand::Move { by, profile } => {
                let (passed, longest) = (passed(profile.boxes(), self.above), longest(profile.boxes()));
                let later: f64 = passed.iter().skip(1).product();
                let of_rate = 2.0 / longest[0];
                let of_acceleration = 4.0 / (self.above * longest[0] * longest[1]);
                [of_rate * later, (1.5 * of_rate).min(of_acceleration)].map(|of| of * size(by))
            }
            LengthCommand::Samples { times, lengths } => [total_of_jumps(times, lengths, size); 2],
        };
        OmittedMotion {
            distance: self.compliance.sqrt() * at_end,
            mean_tensions: self.stretch.iter().map(|stiffness| stiffness.sqrt() * at_any).collect(),
        }
    }
}

/// Part of the mass that may be missing by rounding before the bound is given up.
const MAX_NEGATIVE: f64 = 1e-5;

/// Part of a vibration that passes each box of a course, the longest first, at or above an angular frequency.
fn passed(boxes: &[f64], above: f64) -> Vec<f64> {
    let mut passed: Vec<f64> = boxes.iter().map(|duration| (2.0 / (above * duration)).min(1.0)).collect();
    passed.sort_by(f64::total_cmp);
    passed
}

/// Two longest boxes of a course [s]; zero for those that it has not.
fn longest(boxes: &[f64]) -> [f64; 2] {
    let mut sorted = boxes.to_vec();
    sorted.sort_by(|a, b| b.total_cmp(a));
    [0, 1].map(|k| sorted.get(k).copied().unwrap_or_default())
}

/// Sum of the sizes of all jumps of the rates of lengths that change along straight lines.
fn total_of_jumps(times: &[f64], lengths: &[Vec<f64>], size: impl Fn(&[f64]) -> f64) -> f64 {
    let mut before = vec![0.0; lengths.first().map_or(0, Vec::len)];
    let mut total = 0.0;
    for (time, row) in times.windows(2).zip(lengths.windows(2)) {
        let rates: Vec<f64> = row[1].iter().zip(&row[0]).map(|(to, from)| (to - from) / (time[1] - time[0])).collect();
        let jump: Vec<f64> = rates.iter().zip(&before).map(|(rate, before)| rate - before).collect();
        total += size(&jump);
        before = rates;
    }
    total + size(&before)
}

/// Stiffness between commanded lengths and platform at one frequency.
struct LengthStiffness {
    /// Stiffness of the platform over its scaled coordinates.
    platform: DMat,
    /// Force on the held platform per length, by columns.
    coupling: DMat,
    /// Force on the length per length, the platform held, on the diagonal.
    own: DMat,
}

impl LengthStiffness {
    /// Stiffness at ω [rad/s]; `None` for a robot whose lengths have none.
    fn of(lossless: &Dynamics, omega: f64) -> Option<Self> {
        let (rows, dof) = (forces_by_lengths(lossless, omega)?, lossless.dof());
        let held = lossless.dynamic_stiffness(omega);
        Some(Self {
            platform: DMat::from_fn(dof, dof, |i, j| held[(i, j)]),
            coupling: DMat::from_fn(dof, rows.len(), |i, j| rows[j][i]),
            own: DMat::from_diagonal(&DVec::from_vec(own_stiffness(lossless, omega)?)),
        })
    }
}

/// Mass of the displacements by slow lengths, per pair of cables [kg]: the derivatives of each part by ω², of which the
/// platform follows at rest. Differences of the parts lose fewer digits than those of their sum.
fn slow_mass(lossless: &Dynamics, omega: f64) -> Option<DMat> {
    let [rest, slow, twice] = [0.0, omega, 2.0 * omega].map(|omega| LengthStiffness::of(lossless, omega));
    let (rest, slow, twice) = (rest?, slow?, twice?);
    let by_square = |of: fn(&LengthStiffness) -> &DMat| {
        let near = (of(&rest) - of(&slow)) / (omega * omega);
        let far = (of(&rest) - of(&twice)) / (4.0 * omega * omega);
        (near * 4.0 - far) / 3.0
    };
    let (platform, coupling, own) =
        (by_square(|of| &of.platform), by_square(|of| &of.coupling), by_square(|of| &of.own));
    let moved = rest.platform.clone().lu().solve(&rest.coupling)?;
    let crossed = moved.transpose() * coupling;
    Some(own - &crossed - crossed.transpose() + moved.transpose() * platform * &moved)
}

/// Force on the held platform per commanded length of each cable, over the platform's scaled coordinates.
fn forces_by_lengths(lossless: &Dynamics, omega: f64) -> Option<Vec<Vec6>> {
    let of = |i: usize| {
        let term = lossless.terms().iter().find(|term| term.cable() == i)?;
        let vector = term.form().by_poles()?.signal_vector(DriveSignal::Length, Complex::from(omega))?;
        Some(term.axes().iter().zip(vector).map(|(axis, part)| *axis * part.re).sum())
    };
    (0..lossless.cable_count()).map(of).collect()
}

/// Force on each commanded length per length, the platform held [N/m]. `None` with supports, and with motors, whose
/// commands are no lengths.
fn own_stiffness(lossless: &Dynamics, omega: f64) -> Option<Vec<f64>> {
    if lossless.supports().is_some() {
        return None;
    }
    let of = |i: usize| {
        let form = lossless.terms().iter().find(|term| term.cable() == i)?.form().by_poles()?;
        form.own_stiffness_of_length(Complex::from(omega)).map(|of| of.re)
    };
    (0..lossless.cable_count()).map(of).collect()
}

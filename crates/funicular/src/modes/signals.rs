//! Signals of a cable in a free motion: its commanded length and its tension.
//!
//! The row of a signal over the motion of the platform has the poles of the clamped cable. Where a motion has the
//! frequency of such a pole, as in a symmetric robot, the platform hardly moves along the pole and the row is infinite:
//! the product of both is the part of the clamped mode, whose amplitude the motion has as a number of its own. On a
//! circle of frequencies about the pole the platform end is moved so far along the pole that the cable has this
//! amplitude. The signal is then analytic, and its mean over the circle is its value at the centre (docs/theory.md,
//! equation (46i)).

use super::decay::PoleMotion;
use crate::cable::catenary_dynamic::{CarrierMotion, CatenaryDynamicEnd, DriveSignal, Family};
use crate::dynamics::Dynamics;
use crate::math::{CDMat, Complex};
use std::f64::consts::TAU;

/// Relative distance of a pole within which the row of a signal loses too many digits.
const MAX_GAP: f64 = 1e-6;

/// Relative distance within which poles count on the circle, a part of which is its radius.
const BESIDE: f64 = 1e-3;

/// Radius of the circle over the frequency, and the number of its points: with a pole beyond [`BESIDE`] the mean is
/// wrong by `(2 RADIUS/BESIDE)^POINTS`, 4e-9 of its part.
const RADIUS: f64 = 1e-4;
const POINTS: usize = 12;

/// Minimum part of a direction that is new beside those of the nearer poles.
const MIN_NEW: f64 = 1e-3;

/// Minimum square of the participation of a pole over the mass at the end of the cable. A mode without it does not move
/// the platform, so that no release or command brings it about by the platform.
const MIN_PARTICIPATION: f64 = 1e-20;

/// Product of a free motion with the row of a signal of cable `i` at its complex frequency: platform and supports move,
/// and what lies between them follows. `None` if the cable has no such signal, as the length of a cable without mass.
pub(super) fn signal_at(dynamics: &Dynamics, free: &PoleMotion, i: usize, signal: DriveSignal) -> Option<Complex> {
    if signal == DriveSignal::Length && dynamics.is_at_rest(i) {
        return None;
    }
    let moved = CableSignal::of(dynamics, free, i)?;
    let near = moved.near_poles(dynamics, free, i);
    if near.iter().any(|pole| pole.gap <= MAX_GAP) {
        return moved.on_circle(signal, free.omega, near);
    }
    moved.signal(signal, free.omega, &moved.end)
}

/// Motion of the ends of a cable.
struct CableSignal<'a> {
    form: &'a CatenaryDynamicEnd,
    /// Motion of the platform end in the axes (e, n, b) of the cable.
    end: [Complex; 3],
    /// Motions of the carrier of the other end, with their sizes.
    carried: Vec<(Complex, CarrierMotion)>,
}

/// Clamped mode near the frequency of a motion.
struct Near {
    family: Family,
    index: usize,
    /// Participation of the platform end (e, n, b) [√kg].
    direction: [f64; 3],
    /// Amplitude in the motion.
    amplitude: Complex,
    /// Relative distance of the pole from the motion, in squares of frequencies.
    gap: f64,
}

impl<'a> CableSignal<'a> {
    fn of(dynamics: &'a Dynamics, free: &PoleMotion, i: usize) -> Option<Self> {
        let t = dynamics.terms().iter().position(|term| term.cable() == i)?;
        let term = &dynamics.terms()[t];
        let mut carried = Vec::new();
        if let Some((first, motions)) = dynamics.supports().and_then(|supports| supports.carrier_motions(t)) {
            carried.extend(free.found.supports[first..].iter().copied().zip(motions));
        }
        Some(Self { form: term.form().by_poles()?, end: term.axes().map(|axis| free.along(axis)), carried })
    }

    /// Signal at a frequency, for a motion of the platform end.
    fn signal(&self, signal: DriveSignal, omega: Complex, end: &[Complex; 3]) -> Option<Complex> {
        let row = self.form.signal_vector(signal, omega)?;
        let mut sum: Complex = row.iter().zip(end).map(|(row, moved)| row * moved).sum();
        for (size, motion) in &self.carried {
            sum += self.form.signal_by_carrier(motion, signal, omega)? * size;
        }
        Some(sum)
    }

    /// Signal at a frequency near poles, as the mean over a circle.
    fn on_circle(&self, signal: DriveSignal, center: Complex, near: Vec<Near>) -> Option<Complex> {
        let near = independent(near, self.form.end_mass());
        let mut sum = Complex::new(0.0, 0.0);
        for k in 0..POINTS {
            let angle = TAU * (k as f64 + 0.5) / POINTS as f64;
            let omega = center * (1.0 + Complex::from_polar(RADIUS, angle));
            sum += self.signal(signal, omega, &self.end_at(omega, &near))?;
        }
        Some(sum / POINTS as f64)
    }

    /// Clamped modes of cable `i` with their amplitudes in a motion, without those that are far from its frequency.
    fn near_poles(&self, dynamics: &Dynamics, free: &PoleMotion, i: usize) -> Vec<Near> {
        let (square, _) = dynamics.square_by_damping(i, free.omega);
        let poles = self.form.near_poles(&Dynamics::near_of_border(self.form, square));
        let of_cable = |t: usize| dynamics.terms()[t].cable() == i;
        let near = poles.into_iter().filter_map(|pole| {
            let (family, index, direction) = (pole.family, pole.index, pole.direction);
            let amplitudes = free.found.near.iter();
            let found = amplitudes.into_iter().find(|of| of_cable(of.0) && of.1 == family && of.2 == index)?;
            // With losses the cable resonates beside its pole: it then has a large amplitude.
            let by_end = self.form.amplitudes_by_platform(direction.map(Complex::from), free.omega, &[(family, index)]);
            let size: f64 = direction.iter().map(|g| g * g).sum();
            let by_size = (size / by_end[0].norm()).min(f64::INFINITY);
            let gap = if by_end[0].norm().is_finite() { by_size } else { 0.0 };
            let gap = gap.min((pole.pole - square).norm() / square.norm());
            Some(Near { family, index, direction, amplitude: found.3, gap })
        });
        near.filter(|pole| pole.gap <= BESIDE).collect()
    }

    /// Motion of the platform end at a frequency at which these clamped modes have their amplitudes.
    fn end_at(&self, omega: Complex, near: &[Near]) -> [Complex; 3] {
        let modes: Vec<(Family, usize)> = near.iter().map(|pole| (pole.family, pole.index)).collect();
        let mut found = self.form.amplitudes_by_platform(self.end, omega, &modes);
        for (size, motion) in &self.carried {
            let by_carrier = self.form.amplitudes_by_carrier(motion, omega, &modes);
            found.iter_mut().zip(by_carrier).for_each(|(sum, of)| *sum += of * size);
        }
        let columns: Vec<Vec<Complex>> = (near.iter())
            .map(|pole| self.form.amplitudes_by_platform(pole.direction.map(Complex::from), omega, &modes))
            .collect();
        let matrix = CDMat::from_fn(near.len(), near.len(), |r, c| columns[c][r]);
        let missing = CDMat::from_fn(near.len(), 1, |r, _| near[r].amplitude - found[r]);

        let mut end = self.end;
        if let Some(along) = matrix.lu().solve(&missing) {
            for (c, pole) in near.iter().enumerate() {
                end.iter_mut().zip(pole.direction).for_each(|(moved, g)| *moved += along[(c, 0)] * g);
            }
        }
        end
    }
}

/// Poles whose directions are independent, the nearest first.
fn independent(mut poles: Vec<Near>, mass: f64) -> Vec<Near> {
    poles.sort_by(|a, b| a.gap.total_cmp(&b.gap));
    let mut basis: Vec<[f64; 3]> = Vec::new();
    let dot = |a: &[f64; 3], b: &[f64; 3]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    poles.retain(|pole| {
        let square = dot(&pole.direction, &pole.direction);
        let mut rest = pole.direction;
        for unit in &basis {
            let along = dot(&rest, unit);
            rest.iter_mut().zip(unit).for_each(|(part, unit)| *part -= along * unit);
        }
        let size = dot(&rest, &rest).sqrt();
        let is_new = square > MIN_PARTICIPATION * mass && size > MIN_NEW * square.sqrt();
        if is_new {
            basis.push(rest.map(|part| part / size));
        }
        is_new
    });
    poles
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::Linearisation;
    use crate::modes::decay::pole_motions;
    use crate::modes::{self, damped};
    use crate::robot::{Robot, StretchLoss};
    use crate::statics::{self, StaticModel};

    /// Signals near a pole, but not at it, have enough digits by the row and are those of the circle, without losses of
    /// the stretch and with them.
    #[test]
    fn the_circle_gives_the_signals_of_the_row() {
        for factor in [0.0, 0.02] {
            let mut robot = Robot::from_toml(funicular_robots::KNTU_PLANAR).unwrap();
            robot.cables.iter_mut().for_each(|of| of.material.stretch_loss = StretchLoss { factor, time: 0.0 });
            let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
            let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 60.0).unwrap();
            let found = modes::below(&dynamics, 60.0);
            let damped = damped::damped_modes(&dynamics, &found);

            let mut compared = 0;
            for free in pole_motions(&dynamics, &found, &damped).unwrap() {
                for (i, signal) in (0..4).flat_map(|i| [DriveSignal::Length, DriveSignal::Tension].map(|of| (i, of))) {
                    let moved = CableSignal::of(&dynamics, &free, i).unwrap();
                    assert!(signal_at(&dynamics, &free, i, signal).unwrap().norm().is_finite());
                    let near = moved.near_poles(&dynamics, &free, i);
                    if near.is_empty() || near.iter().any(|pole| pole.gap <= MAX_GAP) {
                        continue;
                    }
                    let row = moved.signal(signal, free.omega, &moved.end).unwrap();
                    let circle = moved.on_circle(signal, free.omega, near).unwrap();
                    let size = free.omega.norm_sqr() * free.found.near.iter().map(|of| of.3.norm()).fold(0.0, f64::max);
                    assert!((row - circle).norm() <= 1e-7 * (row.norm() + size), "{factor} {i}: {row} {circle}");
                    compared += 1;
                }
            }
            assert!(compared > 20, "{compared}");
        }
    }
}

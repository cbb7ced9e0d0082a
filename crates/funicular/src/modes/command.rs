//! Free motions that commanded lengths leave behind: after a move, a stop, or any table of lengths.
//!
//! The response to lengths is its static value and a sum over the poles, each driven by the rates of the lengths:
//! `(R_k/λ_k) ∫ ℓ̇ e^{λ_k(t−τ)} dτ` (docs/theory.md, equation (46i)). R_k has the row of the length command at the
//! pole.

use super::Modes;
use super::damped::DampedModes;
use super::decay::{Decay, DecayError, DecayingMotion, PoleMotion, point_rows, pole_motions};
use super::signals::signal_at;
use crate::cable::catenary_dynamic::DriveSignal;
use crate::dynamics::Dynamics;
use crate::math::{Complex, Vec3};
use crate::path::{Profile, mean_exponential};

/// Command of the unstrained lengths over time from t = 0 on, which ends at rest. One number per cable, in the order of
/// the file.
#[derive(Debug, Clone, PartialEq)]
pub enum LengthCommand {
    /// The lengths change from rest to rest.
    Move {
        /// Change of each length [m].
        by: Vec<f64>,
        /// Course of the change.
        profile: Profile,
    },
    /// The lengths change at constant rates before, and then stop.
    Stop {
        /// Rate of each length [m/s].
        rates: Vec<f64>,
        /// Course of the loss of speed.
        profile: Profile,
    },
    /// Straight lines between samples; constant before and after.
    Samples {
        /// Times [s], rising.
        times: Vec<f64>,
        /// Lengths at each time, relative to any lengths [m].
        lengths: Vec<Vec<f64>>,
    },
}

/// Free motion with what lengths do to it.
#[derive(Debug, Clone, PartialEq)]
pub struct CommandedMotion {
    /// Index of the mode among the undamped modes of the list; `None` for a damped mode without such a partner.
    pub mode: Option<usize>,
    /// Complex frequency ω [rad/s]; λ = iω.
    pub omega: Complex,
    /// Motion of the point, world axes [m], in any scale.
    point: [Complex; 3],
    /// Tension at the platform of each cable [N], in the same scale.
    tensions: Vec<Complex>,
    /// Amplitude in this scale per unit of `∫ ℓ̇ e^{λ(t−τ)} dτ` of each cable [1/m].
    by_length: Vec<Complex>,
}

/// Free motions of a robot that commanded lengths excite.
#[derive(Debug, Clone, PartialEq)]
pub struct CommandedMotions {
    /// Motions, in the order of the damped modes; those with the platform at rest are left out.
    pub motions: Vec<CommandedMotion>,
}

impl LengthCommand {
    /// Time of its end [s].
    pub fn duration(&self) -> f64 {
        match self {
            Self::Move { profile, .. } | Self::Stop { profile, .. } => profile.duration(),
            Self::Samples { times, .. } => times.last().copied().unwrap_or_default(),
        }
    }

    /// `Σ w_i ∫ ℓ̇_i e^{λ(T−τ)} dτ` at its end T.
    fn at_end(&self, lambda: Complex, weights: &[Complex]) -> Complex {
        match self {
            Self::Move { by, profile } => profile.at_end(lambda) * weighted(weights, by),
            Self::Stop { rates, profile } => -profile.at_end(lambda) / lambda * weighted(weights, rates),
            Self::Samples { times, .. } => self.until(lambda, weights, &[times.last().copied().unwrap_or_default()])[0],
        }
    }

    /// Integrals up to each of several times [s], ascending.
    fn until(&self, lambda: Complex, weights: &[Complex], times: &[f64]) -> Vec<Complex> {
        match self {
            Self::Move { by, profile } => {
                let factor = weighted(weights, by);
                times.iter().map(|time| profile.until(lambda, *time) * factor).collect()
            }
            Self::Stop { rates, profile } => {
                // Integrated by parts; the first term is the lag behind a steady motion.
                let factor = -weighted(weights, rates) / lambda;
                let at = |time: f64| profile.until(lambda, time) + (1.0 - profile.done(time));
                times.iter().map(|time| at(*time) * factor).collect()
            }
            Self::Samples { times: at, lengths } => {
                let path: Vec<Complex> = lengths.iter().map(|lengths| weighted(weights, lengths)).collect();
                along_lines(lambda, at, &path, times)
            }
        }
    }
}

/// `∫ ẇ e^{λ(t−τ)} dτ` up to each of the times of `until`, for straight lines between the values `path` at times `at`.
fn along_lines(lambda: Complex, at: &[f64], path: &[Complex], until: &[f64]) -> Vec<Complex> {
    let (mut next, mut now, mut sum) = (0, at.first().copied().unwrap_or_default(), Complex::new(0.0, 0.0));
    let advanced =
        |sum: Complex, rate: Complex, by: f64| sum * (lambda * by).exp() + rate * mean_exponential(lambda * by) * by;
    let rate = |next: usize| match (next, path.get(next)) {
        (0, _) | (_, None) => Complex::new(0.0, 0.0),
        (_, Some(end)) => (end - path[next - 1]) / (at[next] - at[next - 1]),
    };
    let mut found = Vec::with_capacity(until.len());
    for time in until {
        while at.get(next).is_some_and(|at| at <= time) {
            sum = advanced(sum, rate(next), at[next] - now);
            now = at[next];
            next += 1;
        }
        if *time > now {
            sum = advanced(sum, rate(next), time - now);
            now = *time;
        }
        found.push(sum);
    }
    found
}

fn weighted(weights: &[Complex], values: &[f64]) -> Complex {
    weights.iter().zip(values).map(|(weight, value)| weight * *value).sum()
}

impl CommandedMotion {
    /// λ = iω [1/s].
    fn lambda(&self) -> Complex {
        Complex::i() * self.omega
    }

    fn of(dynamics: &Dynamics, free: &PoleMotion, point: [Complex; 3]) -> Result<Self, DecayError> {
        let cables = 0..dynamics.cable_count();
        let signals = |signal: DriveSignal| -> Result<Vec<Complex>, DecayError> {
            cables.clone().map(|i| signal_at(dynamics, free, i, signal).ok_or(DecayError::NoLength(i))).collect()
        };
        // R/λ = i (l·u)(u·b)/(slope iω).
        let factor = 1.0 / (free.found.slope * free.omega);
        let by_length = signals(DriveSignal::Length)?.into_iter().map(|b| b * factor).collect();
        Ok(Self { mode: free.mode, omega: free.omega, point, tensions: signals(DriveSignal::Tension)?, by_length })
    }
}

impl CommandedMotions {
    /// Free motions of a robot at a point at `arm_w` from the platform origin, world axes [m].
    ///
    /// # Errors
    /// [`DecayError`]; a cable without mass or of another model than `catenary-dynamic` has no row of its length.
    pub fn of(dynamics: &Dynamics, undamped: &Modes, damped: &DampedModes, arm_w: &Vec3) -> Result<Self, DecayError> {
        let rows = point_rows(dynamics, arm_w);
        let free = pole_motions(dynamics, undamped, damped)?;
        let motions = free.iter().map(|free| CommandedMotion::of(dynamics, free, free.of_point(&rows)));
        Ok(Self { motions: motions.collect::<Result<_, _>>()? })
    }

    /// Motion of the point from the end of a command on, relative to its new rest; t = 0 at the end.
    pub fn after(&self, command: &LengthCommand) -> Decay {
        Decay::of(self.motions.iter().map(|motion| {
            let size = command.at_end(motion.lambda(), &motion.by_length);
            let amplitude = motion.point.map(|along| along * size);
            DecayingMotion { mode: motion.mode, omega: motion.omega, amplitude }
        }))
    }

    /// Difference of the point from the static place of the lengths at each of several times since the start of a
    /// command [s], ascending; world axes [m].
    pub fn beside_static(&self, command: &LengthCommand, times: &[f64]) -> Vec<Vec3> {
        let mut found = vec![Vec3::zeros(); times.len()];
        for motion in &self.motions {
            let sizes = command.until(motion.lambda(), &motion.by_length, times);
            for (found, size) in found.iter_mut().zip(sizes) {
                *found += Vec3::from(motion.point.map(|along| 2.0 * (along * size).re));
            }
        }
        found
    }

    /// Difference of the tension of each cable at the platform from that of the lengths at rest, at each of several
    /// times since the start of a command [s], ascending [N]. The force that moves the ropes themselves during the
    /// command is left out: at most their mass times the acceleration of their lengths, and their damping times its
    /// rate.
    pub fn tensions_beside_static(&self, command: &LengthCommand, times: &[f64]) -> Vec<Vec<f64>> {
        let cables = self.motions.first().map_or(0, |motion| motion.tensions.len());
        let mut found = vec![vec![0.0; cables]; times.len()];
        for motion in &self.motions {
            let sizes = command.until(motion.lambda(), &motion.by_length, times);
            for (found, size) in found.iter_mut().zip(sizes) {
                found.iter_mut().zip(&motion.tensions).for_each(|(sum, along)| *sum += 2.0 * (along * size).re);
            }
        }
        found
    }
}

//! Free decay of a point of the platform: a sum over the damped modes, and the times from which on it is small
//! (docs/theory.md, equations (46f) and (46g)).

use super::Modes;
use super::damped::{AT_REST, DampedModes};
use crate::dynamics::{DampedMotion, Dynamics};
use crate::math::{Complex, Vec3, Vec6, order};
use std::f64::consts::TAU;
use thiserror::Error;

/// Decay of the motion of a point of the platform, relative to its rest: `y(t) = Σ 2 Re(A_k e^{λ_k t})`.
#[derive(Debug, Clone, PartialEq)]
pub struct Decay {
    /// Decaying motions, in the order of the damped modes; those with the platform at rest are left out.
    pub motions: Vec<DecayingMotion>,
}

/// Motion of a point in one damped mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DecayingMotion {
    /// Index of the mode among the undamped modes of the list; `None` for a damped mode without such a partner.
    pub mode: Option<usize>,
    /// Complex frequency ω [rad/s]; λ = iω.
    pub omega: Complex,
    /// Complex amplitude A at time zero, world axes [m].
    pub amplitude: [Complex; 3],
}

/// Reason for which a decay has no closed form.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum DecayError {
    /// The closed form of the shallow-dynamic cable has no motions at complex frequencies.
    #[error("the cable model `shallow-dynamic` has no motions at complex frequencies: choose `catenary-dynamic`")]
    Model,
    /// A cable has no commanded length, by its index in the order of the file.
    #[error(
        "cable number {} has no length that is commanded: every cable needs mass and the cable model \
         `catenary-dynamic`", .0 + 1
    )]
    NoLength(usize),
    /// A mode does not oscillate.
    #[error(
        "motions that are damped so strongly that they do not oscillate ({0}) have no place in the closed form of a \
         decay: give winches and platform less damping"
    )]
    Overdamped(usize),
    /// A mode grows.
    #[error(
        "the mode at {frequency_hz:.4} Hz grows, because its damping ratio is negative, as by the delay of a control: \
         lower the gains of the motors, or give ropes or platform more damping"
    )]
    Grows {
        /// Frequency [Hz].
        frequency_hz: f64,
    },
    /// Two motions of the platform are one, not only their frequencies.
    #[error(
        "two motions of the platform meet in one at {frequency_hz:.4} Hz, so that their decay is not a sum of \
         exponentials: change the damping of ropes or platform a little, or simulate the motion"
    )]
    Shared {
        /// Frequency [Hz].
        frequency_hz: f64,
    },
}

impl DecayError {
    /// True if the request is valid, but the robot has no such decay.
    pub fn is_no_solution(&self) -> bool {
        !matches!(self, Self::Model | Self::NoLength(_))
    }
}

/// Fraction of the tolerance below which the last crossing counts as found.
const AT_TOLERANCE: f64 = 1e-9;

/// Maximum number of steps back in time: ten thousand periods with a hundred steps.
const MAX_STEPS: usize = 1_000_000;

impl DecayingMotion {
    /// Rate of decay, −Re λ [1/s]; zero without damping.
    pub fn rate(&self) -> f64 {
        self.omega.im
    }

    /// Amplitude at time zero [m]: half of the long axis of the ellipse on which the point moves.
    pub fn size(&self) -> f64 {
        let (re, im) = (Vec3::from(self.amplitude.map(|a| a.re)), Vec3::from(self.amplitude.map(|a| a.im)));
        let (a, b, c) = (re.norm_squared(), re.dot(&im), im.norm_squared());
        let largest = 0.5 * (a + c) + (0.25 * (a - c) * (a - c) + b * b).sqrt();
        2.0 * largest.sqrt()
    }

    /// Bound of its speed at time zero [m/s].
    fn speed(&self) -> f64 {
        let norm = self.amplitude.iter().map(Complex::norm_sqr).sum::<f64>().sqrt();
        2.0 * norm * self.omega.norm()
    }
}

impl Decay {
    /// Decay of these motions. Those at one complex frequency are one motion, of the sum of their amplitudes: how it is
    /// parted among them has no meaning.
    pub(super) fn of(all: impl Iterator<Item = DecayingMotion>) -> Self {
        let mut motions: Vec<DecayingMotion> = Vec::new();
        for motion in all {
            match motions.last_mut().filter(|last| last.omega == motion.omega) {
                Some(last) => last.amplitude.iter_mut().zip(motion.amplitude).for_each(|(sum, part)| *sum += part),
                None => motions.push(motion),
            }
        }
        Self { motions }
    }

    /// Displacement of the point from its rest at a time [m].
    pub fn at(&self, time: f64) -> Vec3 {
        let mut sum = Vec3::zeros();
        for motion in &self.motions {
            let factor = (Complex::i() * motion.omega * time).exp() * 2.0;
            sum += Vec3::from(motion.amplitude.map(|amplitude| (amplitude * factor).re));
        }
        sum
    }

    /// Bound of the distance of the point from its rest at a time [m].
    pub fn envelope(&self, time: f64) -> f64 {
        self.motions.iter().map(|motion| motion.size() * (-motion.rate() * time).exp()).sum()
    }

    /// Motions that keep their amplitudes, because nothing damps them.
    pub fn undamped(&self) -> impl Iterator<Item = &DecayingMotion> {
        self.motions.iter().filter(|motion| motion.rate() == 0.0)
    }

    /// Time from which on the bound of the distance is at most `tolerance` [m]: the point stays within it. Infinite if
    /// the undamped motions alone are larger.
    pub fn surely_settled(&self, tolerance: f64) -> f64 {
        if self.envelope(0.0) <= tolerance {
            return 0.0;
        }
        if self.undamped().map(DecayingMotion::size).sum::<f64>() > tolerance {
            return f64::INFINITY;
        }
        let rates = self.motions.iter().map(DecayingMotion::rate).filter(|rate| *rate > 0.0);
        let slowest = rates.fold(f64::INFINITY, f64::min);
        let mut after = 1.0 / slowest;
        while self.envelope(after) > tolerance {
            after *= 2.0;
        }
        let mut before = 0.0;
        while after - before > 1e-12 * after {
            let middle = 0.5 * (before + after);
            if self.envelope(middle) > tolerance { before = middle } else { after = middle }
        }
        after
    }

    /// Last time at which the point is at the distance `tolerance` [m] from its rest; zero if it never is, infinite if
    /// the undamped motions alone are larger.
    ///
    /// From the sure time backwards: within the remaining distance over the largest speed, no crossing is possible.
    pub fn settled(&self, tolerance: f64) -> f64 {
        let speed = |time: f64| -> f64 {
            self.motions.iter().map(|motion| motion.speed() * (-motion.rate() * time).exp()).sum()
        };
        let mut time = self.surely_settled(tolerance);
        if time.is_infinite() {
            return time;
        }
        for _ in 0..MAX_STEPS {
            let left = tolerance - self.at(time).norm();
            if time <= 0.0 || left <= AT_TOLERANCE * tolerance {
                break;
            }
            let step = left / speed(time);
            time -= left / speed(time - step);
        }
        time.max(0.0)
    }
}

/// Motion at a pole of the response, of the robot without forces.
pub(super) struct PoleMotion {
    /// Index of the mode among the undamped modes of the list.
    pub(super) mode: Option<usize>,
    /// Complex frequency ω [rad/s]; λ = iω.
    pub(super) omega: Complex,
    /// Motion, and the derivative of its quadratic form by ω.
    pub(super) found: DampedMotion,
}

impl PoleMotion {
    /// Product of the motion of the platform with a scaled vector, see [`scaled`].
    pub(super) fn along(&self, row: &Vec6) -> Complex {
        (0..6).map(|k| self.found.platform[k] * row[k]).sum()
    }

    /// Motion of a point along the world axes, as scaled vectors of [`point_rows`].
    pub(super) fn of_point(&self, rows: &[Vec6; 3]) -> [Complex; 3] {
        rows.each_ref().map(|row| self.along(row))
    }
}

/// Part of the rate of decay up to which the places of two zeros are one: over the time in which the motion decays to a
/// millionth, their phases then differ by at most 1.4e-5.
const SAME_PLACE: f64 = 1e-6;

/// Relative distance of zeros whose motions are found together: alone they would hold a part of each other, of rounding
/// over this distance.
const TOGETHER: f64 = 1e-9;

/// Maximum size of a damping ratio that counts as rounding: the zero is found with an error of this size.
const NO_DAMPING: f64 = 1e-12;

/// Complex frequency whose damping is zero if it is rounding.
fn without_rounding(omega: Complex) -> Complex {
    if omega.im.abs() <= NO_DAMPING * omega.norm() { omega.re.into() } else { omega }
}

/// Motions at all poles, without modes in which the platform rests.
///
/// # Errors
/// [`DecayError`].
pub(super) fn pole_motions(
    dynamics: &Dynamics,
    undamped: &Modes,
    damped: &DampedModes,
) -> Result<Vec<PoleMotion>, DecayError> {
    if damped.overdamped > 0 {
        return Err(DecayError::Overdamped(damped.overdamped));
    }
    let by_poles = dynamics.terms().iter().all(|term| term.form().by_poles().is_some());
    let partners = damped.modes.iter().enumerate().map(|(i, mode)| (Some(i), mode));
    let moves = |mode: &Option<usize>| mode.is_none_or(|i: usize| undamped.modes[i].platform_energy_fraction > AT_REST);
    let all: Vec<(Option<usize>, Complex)> =
        partners.chain(damped.others.iter().map(|mode| (None, mode))).map(|(mode, of)| (mode, of.omega)).collect();

    let mut motions = Vec::with_capacity(all.len());
    for group in groups(&all) {
        if !group.iter().any(|k| moves(&all[*k].0)) {
            continue;
        }
        let mean = without_rounding(group.iter().map(|k| all[*k].1).sum::<Complex>() / group.len() as f64);
        let frequency_hz = mean.norm() / TAU;
        if let Some(k) = group.iter().find(|k| without_rounding(all[**k].1).im < 0.0) {
            return Err(DecayError::Grows { frequency_hz: all[*k].1.norm() / TAU });
        }
        let refused = if by_poles { DecayError::Shared { frequency_hz } } else { DecayError::Model };
        if let [k] = group[..]
            && let Some(found) = dynamics.damped_motion(mean)
        {
            motions.push(PoleMotion { mode: all[k].0, omega: mean, found });
            continue;
        }

        let same = (SAME_PLACE * mean.im).max(NO_DAMPING * mean.norm());
        let found = dynamics.shared_motions(mean, group.len(), same).ok_or(refused)?;
        let members = group.iter().map(|k| Some(*k)).chain(std::iter::repeat(None));
        motions.extend(found.into_iter().zip(members).map(|((gap, found), member)| PoleMotion {
            mode: member.and_then(|k| all[k].0),
            omega: without_rounding(mean + gap),
            found,
        }));
    }
    Ok(motions)
}

/// Zeros whose motions are found together, by their indices; groups in the order of their first members.
fn groups(zeros: &[(Option<usize>, Complex)]) -> Vec<Vec<usize>> {
    let mut ascending: Vec<usize> = (0..zeros.len()).collect();
    order::sort_ascending(&mut ascending, |k| zeros[*k].1.re);
    let mut groups: Vec<Vec<usize>> = Vec::with_capacity(zeros.len());
    for k in ascending {
        let omega = zeros[k].1;
        let near = |group: &Vec<usize>| {
            let gap = group.iter().map(|other| (zeros[*other].1 - omega).norm()).fold(f64::INFINITY, f64::min);
            gap <= (TOGETHER * omega.norm()).max(SAME_PLACE * omega.im)
        };
        // Zeros with almost the same real part follow each other.
        let found = groups.iter_mut().rev().take(MAX_BESIDE).find(|group| near(group));
        match found {
            Some(group) => group.push(k),
            None => groups.push(vec![k]),
        }
    }
    for group in &mut groups {
        group.sort_unstable();
    }
    groups.sort_by_key(|group| group[0]);
    groups
}

/// Maximum number of groups with almost the same real part among which that of a zero is sought.
const MAX_BESIDE: usize = 16;

/// Scaled vectors of the displacement of a point at `arm_w` from the platform origin along the world axes [m].
pub(super) fn point_rows(dynamics: &Dynamics, arm_w: &Vec3) -> [Vec6; 3] {
    [Vec3::x(), Vec3::y(), Vec3::z()].map(|axis| {
        let moment = arm_w.cross(&axis);
        scaled(dynamics, &Vec6::new(axis.x, axis.y, axis.z, moment.x, moment.y, moment.z))
    })
}

/// Scaled vector over the platform's coordinates of a vector about its origin.
pub(super) fn scaled(dynamics: &Dynamics, vector: &Vec6) -> Vec6 {
    let scale = dynamics.scale();
    dynamics.coordinates().motion().reduced(&Vec6::from_fn(|i, _| vector[i] / scale[i]))
}

//! Free decay after a wrench on the platform is released: closed form over the damped modes.
//!
//! The wrench f has held the platform away from its equilibrium. With the residues R_k of the response at the poles
//! λ_k the point moves by `y(t) = Σ 2 Re(A_k e^{λ_k t})`, `A_k = −R_k f/λ_k` (docs/theory.md, equations (46f) to (46h)).

use super::Modes;
use super::damped::DampedModes;
use crate::dynamics::Dynamics;
use crate::math::{Complex, Vec3, Vec6};
use thiserror::Error;

/// Decay of the motion of a point of the platform, relative to the equilibrium without the wrench.
#[derive(Debug, Clone, PartialEq)]
pub struct Release {
    /// Decaying motions, in the order of the damped modes; those with the platform at rest are left out.
    pub motions: Vec<DecayingMotion>,
    /// Displacement of the point under the wrench [m], linear.
    pub held: Vec3,
    /// Bound of what the modes above the limit add to the displacement at the release [m].
    pub omitted: f64,
}

/// Motion of a point in one damped mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DecayingMotion {
    /// Index of the mode among the undamped modes of the list; `None` for a damped mode without such a partner.
    pub mode: Option<usize>,
    /// Complex frequency ω [rad/s]; λ = iω.
    pub omega: Complex,
    /// Complex amplitude A at the release, world axes [m].
    pub amplitude: [Complex; 3],
}

/// Reason for which a decay has no closed form.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum ReleaseError {
    /// The closed form of the shallow-dynamic cable has no motions at complex frequencies.
    #[error("the cable model `shallow-dynamic` has no motions at complex frequencies: choose `catenary-dynamic`")]
    Model,
    /// A mode does not oscillate.
    #[error(
        "motions that are damped so strongly that they do not oscillate ({0}) have no place in the closed form of a decay: \
         give winches and platform less damping"
    )]
    Overdamped(usize),
    /// A mode does not decay.
    #[error(
        "the mode at {frequency_hz:.4} Hz does not decay: give the ropes `damping_ratio` and `axial_loss_factor`, or the \
         platform `translational_damping_n_s_m`"
    )]
    NoDecay {
        /// Frequency [Hz].
        frequency_hz: f64,
    },
    /// Modes share a complex frequency.
    #[error(
        "modes of the platform share the complex frequency at {frequency_hz:.4} Hz: their motions cannot be parted"
    )]
    Shared {
        /// Frequency [Hz].
        frequency_hz: f64,
    },
}

impl ReleaseError {
    /// True if the request is valid, but the robot has no such decay.
    pub fn is_no_solution(&self) -> bool {
        !matches!(self, Self::Model)
    }
}

/// Fraction of the tolerance below which the last crossing counts as found.
const AT_TOLERANCE: f64 = 1e-9;

/// Maximum number of steps back in time: ten thousand periods with a hundred steps.
const MAX_STEPS: usize = 1_000_000;

impl DecayingMotion {
    /// Rate of decay, −Re λ [1/s].
    pub fn rate(&self) -> f64 {
        self.omega.im
    }

    /// Amplitude at the release [m]: half of the long axis of the ellipse on which the point moves.
    pub fn size(&self) -> f64 {
        let (re, im) = (Vec3::from(self.amplitude.map(|a| a.re)), Vec3::from(self.amplitude.map(|a| a.im)));
        let (a, b, c) = (re.norm_squared(), re.dot(&im), im.norm_squared());
        let largest = 0.5 * (a + c) + (0.25 * (a - c) * (a - c) + b * b).sqrt();
        2.0 * largest.sqrt()
    }

    /// Bound of its speed at the release [m/s].
    fn speed(&self) -> f64 {
        let norm = self.amplitude.iter().map(Complex::norm_sqr).sum::<f64>().sqrt();
        2.0 * norm * self.omega.norm()
    }
}

impl Release {
    /// Decay after the release of a `wrench` on the platform about its origin, world axes [N, N·m]; the point lies at
    /// `arm_w` from the origin, world axes [m].
    ///
    /// # Errors
    /// [`ReleaseError`].
    pub fn of(
        dynamics: &Dynamics,
        undamped: &Modes,
        damped: &DampedModes,
        wrench: &Vec6,
        arm_w: &Vec3,
    ) -> Result<Self, ReleaseError> {
        if damped.overdamped > 0 {
            return Err(ReleaseError::Overdamped(damped.overdamped));
        }
        let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
        let rows = axes.map(|axis| {
            let moment = arm_w.cross(&axis);
            scaled(dynamics, &Vec6::new(axis.x, axis.y, axis.z, moment.x, moment.y, moment.z))
        });
        let force = scaled(dynamics, wrench);

        // Residues at the poles, without modes in which the platform rests.
        let partners = damped.modes.iter().enumerate().map(|(i, mode)| (Some(i), mode));
        let mut motions = Vec::new();
        for (mode, of) in partners.chain(damped.others.iter().map(|mode| (None, mode))) {
            if mode.is_some_and(|i| undamped.modes[i].platform_energy_fraction == 0.0) {
                continue;
            }
            let frequency_hz = of.frequency_hz();
            if of.omega.im <= 0.0 {
                return Err(ReleaseError::NoDecay { frequency_hz });
            }
            let by_poles = dynamics.terms().iter().all(|term| term.form().by_poles().is_some());
            let found = dynamics.damped_motion(of.omega).ok_or(if by_poles {
                ReleaseError::Shared { frequency_hz }
            } else {
                ReleaseError::Model
            })?;
            let along = |row: &Vec6| -> Complex { (0..6).map(|k| found.platform[k] * row[k]).sum() };
            // i (l·u)(u·f)/slope over −λ = −iω.
            let factor = -along(&force) / (found.slope * of.omega);
            motions.push(DecayingMotion {
                mode,
                omega: of.omega,
                amplitude: rows.each_ref().map(|row| factor * along(row)),
            });
        }

        let (held, omitted) = at_rest(dynamics, undamped, &force, &rows);
        Ok(Self { motions, held, omitted })
    }

    /// Displacement of the point at a time after the release [m].
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

    /// Time from which on the bound of the distance is at most `tolerance` [m]: the point stays within it.
    pub fn surely_settled(&self, tolerance: f64) -> f64 {
        if self.envelope(0.0) <= tolerance {
            return 0.0;
        }
        let slowest = self.motions.iter().map(DecayingMotion::rate).fold(f64::INFINITY, f64::min);
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

    /// Last time at which the point is at the distance `tolerance` [m] from its rest; zero if it never is.
    ///
    /// From the sure time backwards: within the remaining distance over the largest speed, no crossing is possible.
    pub fn settled(&self, tolerance: f64) -> f64 {
        let speed = |time: f64| -> f64 {
            self.motions.iter().map(|motion| motion.speed() * (-motion.rate() * time).exp()).sum()
        };
        let mut time = self.surely_settled(tolerance);
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

/// Scaled vector over the platform's coordinates of a vector about its origin.
fn scaled(dynamics: &Dynamics, vector: &Vec6) -> Vec6 {
    let scale = dynamics.scale();
    dynamics.coordinates().motion().reduced(&Vec6::from_fn(|i, _| vector[i] / scale[i]))
}

/// Displacement under a scaled force, and the bound of what the modes above the limit add to it: by the inequality of
/// Cauchy and Schwarz the product of what they add to the compliances of force and displacement.
fn at_rest(dynamics: &Dynamics, undamped: &Modes, force: &Vec6, rows: &[Vec6; 3]) -> (Vec3, f64) {
    let dof = dynamics.dof();
    let stiffness = dynamics.dynamic_stiffness(0.0).view((0, 0), (dof, dof)).into_owned();
    let solved = |of: &Vec6| -> Vec6 {
        let solved = stiffness.clone().lu().solve(&of.rows(0, dof).into_owned());
        solved.map_or_else(|| Vec6::repeat(f64::NAN), |x| Vec6::from_fn(|i, _| if i < dof { x[i] } else { 0.0 }))
    };
    let rest = |of: &Vec6| -> f64 {
        let by_mode = |mode: &super::Mode| {
            let part = mode.motion.platform.dot(of) / (std::f64::consts::TAU * mode.frequency_hz);
            part * part
        };
        (of.dot(&solved(of)) - undamped.modes.iter().map(by_mode).sum::<f64>()).max(0.0)
    };
    let moved = solved(force);
    let omitted = rest(force) * rows.iter().map(rest).sum::<f64>();
    (Vec3::from(rows.each_ref().map(|row| row.dot(&moved))), omitted.sqrt())
}

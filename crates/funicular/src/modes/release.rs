//! Free decay after a wrench on the platform is released: closed form over the damped modes.
//!
//! The wrench f has held the platform away from its equilibrium. With the residues R_k of the response at the poles
//! λ_k the amplitudes are `A_k = −R_k f/λ_k` (docs/theory.md, equations (46f) to (46h)).

use super::Modes;
use super::damped::DampedModes;
use super::decay::{Decay, DecayError, DecayingMotion, PoleMotion, point_rows, pole_motions, scaled};
use super::signals::signal_at;
use crate::cable::catenary_dynamic::DriveSignal;
use crate::dynamics::Dynamics;
use crate::math::{Complex, Vec3, Vec6};

/// Decay after a release, relative to the equilibrium without the wrench.
#[derive(Debug, Clone, PartialEq)]
pub struct Release {
    /// Motion of the point from the release on.
    pub decay: Decay,
    /// Displacement of the point under the wrench [m], linear.
    pub held: Vec3,
    /// Bound of what the modes above the limit add to the displacement at the release [m].
    pub omitted: f64,
    /// Motions of platform and tensions from the release on.
    pub free: Vec<ReleasedMotion>,
}

/// Free motion after a release, relative to the rest without the wrench: each value is `2 Re(A e^{iωt})`.
#[derive(Debug, Clone, PartialEq)]
pub struct ReleasedMotion {
    /// Complex frequency ω [rad/s].
    pub omega: Complex,
    /// Amplitudes of the platform about its origin, world axes: displacement [m] and rotation [rad].
    pub platform: [Complex; 6],
    /// Amplitude of the tension of each cable at the platform [N]; `None` for a cable without vibrations of its own,
    /// which follows the platform as at rest.
    pub tensions: Vec<Option<Complex>>,
}

impl Release {
    /// Decay after the release of a `wrench` on the platform about its origin, world axes [N, N·m]; the point lies at
    /// `arm_w` from the origin, world axes [m].
    ///
    /// # Errors
    /// [`DecayError`].
    pub fn of(
        dynamics: &Dynamics,
        undamped: &Modes,
        damped: &DampedModes,
        wrench: &Vec6,
        arm_w: &Vec3,
    ) -> Result<Self, DecayError> {
        let (rows, force) = (point_rows(dynamics, arm_w), scaled(dynamics, wrench));
        let all = pole_motions(dynamics, undamped, damped)?;
        // i (l·u)(u·f)/slope over −λ = −iω.
        let factor = |free: &PoleMotion| -free.along(&force) / (free.found.slope * free.omega);
        let motions = all.iter().map(|free| {
            let factor = factor(free);
            let amplitude = free.of_point(&rows).map(|along| factor * along);
            DecayingMotion { mode: free.mode, omega: free.omega, amplitude }
        });
        let axes: [Vec6; 6] = std::array::from_fn(|k| scaled(dynamics, &Vec6::ith(k, 1.0)));
        let released = |free: &PoleMotion| {
            let factor = factor(free);
            let tension = |i: usize| signal_at(dynamics, free, i, DriveSignal::Tension).map(|along| factor * along);
            ReleasedMotion {
                omega: free.omega,
                platform: axes.each_ref().map(|axis| factor * free.along(axis)),
                tensions: (0..dynamics.cable_count()).map(tension).collect(),
            }
        };
        let free = all.iter().map(released).collect();

        let (held, omitted) = at_rest(dynamics, undamped, &force, &rows);
        Ok(Self { decay: Decay::of(motions), held, omitted, free })
    }
}

impl Release {
    /// Bound of what the modes above the limit of a list add to the displacement at the release of a `wrench`, as
    /// [`Release::omitted`].
    pub fn omitted_by(dynamics: &Dynamics, undamped: &Modes, wrench: &Vec6, arm_w: &Vec3) -> f64 {
        at_rest(dynamics, undamped, &scaled(dynamics, wrench), &point_rows(dynamics, arm_w)).1
    }
}

/// Displacement under a scaled force, and the bound of what the modes above the limit add to it: by the inequality of
/// Cauchy and Schwarz the product of what they add to the compliances of force and displacement.
fn at_rest(dynamics: &Dynamics, undamped: &Modes, force: &Vec6, rows: &[Vec6; 3]) -> (Vec3, f64) {
    let moved = moved_by(dynamics, force);
    let rest = |of: &Vec6| left_of_compliance(dynamics, undamped, of);
    let omitted = rest(force) * rows.iter().map(rest).sum::<f64>();
    (Vec3::from(rows.each_ref().map(|row| row.dot(&moved))), omitted.sqrt())
}

/// Static displacement under a scaled force, over the platform's scaled coordinates.
fn moved_by(dynamics: &Dynamics, force: &Vec6) -> Vec6 {
    let dof = dynamics.dof();
    let stiffness = dynamics.dynamic_stiffness(0.0).view((0, 0), (dof, dof)).into_owned();
    let solved = stiffness.lu().solve(&force.rows(0, dof).into_owned());
    solved.map_or_else(|| Vec6::repeat(f64::NAN), |x| Vec6::from_fn(|i, _| if i < dof { x[i] } else { 0.0 }))
}

/// Compliance along a scaled vector that the modes above the limit have [m/N].
pub(super) fn left_of_compliance(dynamics: &Dynamics, undamped: &Modes, of: &Vec6) -> f64 {
    let by_mode = |mode: &super::Mode| {
        let part = mode.motion.platform.dot(of) / (std::f64::consts::TAU * mode.frequency_hz);
        part * part
    };
    (of.dot(&moved_by(dynamics, of)) - undamped.modes.iter().map(by_mode).sum::<f64>()).max(0.0)
}

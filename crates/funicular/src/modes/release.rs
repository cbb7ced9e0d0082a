//! Free decay after a wrench on the platform is released: closed form over the damped modes.
//!
//! The wrench f has held the platform away from its equilibrium. With the residues R_k of the response at the poles
//! λ_k the amplitudes are `A_k = −R_k f/λ_k` (docs/theory.md, equations (46f) to (46h)).

use super::Modes;
use super::damped::DampedModes;
use super::decay::{Decay, DecayError, DecayingMotion, point_rows, pole_motions, scaled};
use crate::dynamics::Dynamics;
use crate::math::{Vec3, Vec6};

/// Decay after a release, relative to the equilibrium without the wrench.
#[derive(Debug, Clone, PartialEq)]
pub struct Release {
    /// Motion of the point from the release on.
    pub decay: Decay,
    /// Displacement of the point under the wrench [m], linear.
    pub held: Vec3,
    /// Bound of what the modes above the limit add to the displacement at the release [m].
    pub omitted: f64,
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
        let motions = pole_motions(dynamics, undamped, damped)?.into_iter().map(|free| {
            // i (l·u)(u·f)/slope over −λ = −iω.
            let factor = -free.along(&force) / (free.found.slope * free.omega);
            let amplitude = free.of_point(&rows).map(|along| factor * along);
            DecayingMotion { mode: free.mode, omega: free.omega, amplitude }
        });

        let (held, omitted) = at_rest(dynamics, undamped, &force, &rows);
        Ok(Self { decay: Decay::of(motions), held, omitted })
    }
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

//! Stiffness that the drag of the wind adds because it turns with the cables, and the stiffness that includes it.

use super::equilibrium::{CableState, Equilibrium};
use super::model::StaticModel;
use super::stiffness::tangent_stiffness;
use crate::drive::derivatives::{DriveDerivatives, place, straight_chord};
use crate::math::{Mat3, Mat6, inverse6, symmetric_part};
use crate::platform::{Coordinates, add_congruent};
use crate::robot::Robot;

/// Stiffness against small slow displacements in wind: the derivative `−∂wrench/∂(δp, δθ)` at an equilibrium, with the
/// drag turning with the cables. About the platform origin, world axes [N/m, N, N·m]. In wind it is not symmetric;
/// without wind it equals [`tangent_stiffness`] to the last bit.
///
/// `None` for ideal cables. Zero for motions that the platform does not have. A moment fixed in the world counts as in
/// [`tangent_stiffness`].
///
/// # Example
/// ```
/// use funicular::robot::{Robot, Wind};
/// use funicular::{math::Vec3, statics::{self, StaticModel}};
/// let text = funicular_robots::YUAN2014_4MM
///     .replace("damping_ratio = 0.003", "damping_ratio = 0.003\ndrag_coefficient = 1.2");
/// let wind = Wind { velocity_w: Vec3::new(15.0, 0.0, 0.0), ..Wind::default() };
/// let robot = Robot::from_toml(&text)?.with_wind(wind);
/// let rest = statics::solve(&robot, StaticModel::Catenary, None)?.equilibrium;
/// let tangent = statics::tangent_with_drag(&robot, &rest).ok_or("elastic cables have a tangent")?;
/// assert!(statics::antisymmetric_fraction(&robot, &tangent) > 1e-5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # References
/// docs/theory.md, equation (49d).
pub fn tangent_with_drag(robot: &Robot, equilibrium: &Equilibrium) -> Option<Mat6> {
    let held = tangent_stiffness(robot, equilibrium)?;
    Some(drag_stiffness(robot, equilibrium).map_or(held, |turn| held + turn))
}

/// Part of [`tangent_with_drag`] due to the turn of the drag; 6×6, about the platform origin, world axes, not symmetric
/// [N/m, N, N·m]. `None` if no drag turns: without wind, without drag coefficients, or with cables that carry no load
/// along them (static models `ideal` and `spring`).
///
/// # References
/// docs/theory.md, equation (49c).
pub fn drag_stiffness(robot: &Robot, equilibrium: &Equilibrium) -> Option<Mat6> {
    if equilibrium.model != StaticModel::Catenary || !robot.wind_turns_with_cables() {
        return None;
    }
    let mut total = Mat6::zeros();
    for (i, cable) in equilibrium.cables.iter().enumerate() {
        if let Some(turned) = force_by_turn_w(robot, i, cable) {
            // The chord shortens as the attachment moves along it: the signs of −∂Φ/∂x and ∂d/∂x cancel.
            add_congruent(&mut total, &turned, &cable.lever_w);
        }
    }
    Some(Coordinates::of(robot).allowed_matrix(&total))
}

/// Force of cable `i` on the platform by its chord through the turn of the drag, 3×3, world axes [N/m]. Over a pulley
/// the chord turns with the exit point of a straight cable, because the drag is that of a straight cable.
fn force_by_turn_w(robot: &Robot, i: usize, state: &CableState) -> Option<Mat3> {
    let hanging = state.hanging.as_ref()?;
    let Some(drive) = &state.drive else {
        return Some(hanging.force_by_load_w() * robot.line_load_by_chord(i, &state.chord_w())?);
    };

    let mut anchor = robot.cables[i].anchor.clone();
    if let Some(support) = anchor.support {
        anchor.displace(&robot.supports[support], &state.displacement_w);
    }
    let attachment_w = state.attachment_w;
    let turn = robot.line_load_by_chord(i, &(anchor.exit_w(&attachment_w) - attachment_w))?;
    let by_load = DriveDerivatives::of(hanging, &anchor, drive.contact.as_ref())?.force_w;
    let by_load = Mat3::from_fn(|k, j| by_load[k][place::LOAD + j]);
    let Some(pulley) = &anchor.pulley else { return Some(by_load * turn) };
    let chord = straight_chord(pulley, &(anchor.point_w - attachment_w))?;
    Some(by_load * turn * Mat3::from_fn(|k, j| chord[k][place::REACH + j]))
}

/// Ratio of the antisymmetric part of a stiffness to the complete stiffness: Frobenius norms of the scaled matrices
/// (theory (3)), with moments over ℓ and rotations times ℓ.
pub fn antisymmetric_fraction(robot: &Robot, stiffness: &Mat6) -> f64 {
    let matrix = Coordinates::of(robot).scale_matrix(stiffness);
    let size = matrix.norm();
    if size > 0.0 { 0.5 * (matrix - matrix.transpose()).norm() / size } else { 0.0 }
}

/// Relative effect of the drag's turn on static displacements: the largest change of the displacement under any small
/// load, over the displacement with the drag held; rotations times ℓ, moments over ℓ. `None` if no drag turns, or if
/// the stiffness is singular.
///
/// # References
/// docs/theory.md, equation (49e).
pub fn drag_effect(robot: &Robot, equilibrium: &Equilibrium) -> Option<f64> {
    let turn = drag_stiffness(robot, equilibrium)?;
    let whole = tangent_stiffness(robot, equilibrium)? + turn;
    let coordinates = Coordinates::of(robot);
    let [turn, mut whole] = [turn, whole].map(|k| coordinates.reduce_matrix(&k));
    (coordinates.count()..6).for_each(|k| whole[(k, k)] = 1.0);
    let effect = (inverse6(&whole)? * turn).singular_values().max();
    effect.is_finite().then_some(effect)
}

/// Stiffness along each coordinate of the platform: load along it over the motion along it, all other motions free
/// [N/m, N m/rad]; one over the diagonal of the compliance. In wind the drag turns with the cables.
///
/// `None` for ideal cables, and if the stiffness is singular.
pub fn stiffness_along_coordinates(robot: &Robot, equilibrium: &Equilibrium) -> Option<Vec<f64>> {
    // Symmetric to rounding; the stiffness added by the turn of the drag is not.
    let mut whole = symmetric_part(&tangent_stiffness(robot, equilibrium)?);
    if let Some(turn) = drag_stiffness(robot, equilibrium) {
        whole += turn;
    }

    let motion = &robot.platform.motion;
    let n = motion.count();
    let mut reduced = motion.reduced_matrix(&whole);
    (n..6).for_each(|k| reduced[(k, k)] = 1.0);
    let compliance = inverse6(&reduced)?;
    Some((0..n).map(|k| 1.0 / compliance[(k, k)]).collect())
}

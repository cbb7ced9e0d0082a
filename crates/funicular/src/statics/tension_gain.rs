//! Nearness to a singular pose: largest tension needed per unit wrench.

use super::equilibrium::Equilibrium;
use crate::math::{DMat, Mat6, Vec6, symmetric};
use crate::platform::Coordinates;
use crate::robot::Robot;

/// Largest tension needed per unit wrench [N/N]: 1/σ_min of the scaled unit wrenches (moments divided by ℓ), the norm
/// of the smallest tensions that balance the worst wrench of size one. Grows without bound towards a singular pose.
///
/// Slack cables do not count. `None` if fewer cables than degrees of freedom are taut, infinite at a singular pose.
pub fn tension_gain(robot: &Robot, equilibrium: &Equilibrium) -> Option<f64> {
    let n = robot.platform.motion.count();
    let (values, _) = symmetric::eigen(&wrench_gram(robot, equilibrium)?, n);
    // Squares below the rounding of their sum count as zero.
    let least = if values[0] > 1e-14 * values[n - 1] { values[0] } else { 0.0 };
    Some(1.0 / least.sqrt())
}

/// True if [`tension_gain`] is above a limit; takes a fraction of its time.
pub(crate) fn tension_gain_exceeds(robot: &Robot, equilibrium: &Equilibrium, limit: f64) -> bool {
    let Some(mut gram) = wrench_gram(robot, equilibrium) else { return false };
    let n = robot.platform.motion.count();
    for k in 0..6 {
        gram[(k, k)] += if k < n { -1.0 / (limit * limit) } else { 1.0 };
    }
    gram.cholesky().is_none()
}

/// Inverse condition number: smallest over largest singular value of the matrix of the cables' directions, with moments
/// over ℓ, in the platform's coordinates. 0 at a singular pose, 1 if all degrees of freedom are constrained equally.
pub fn inverse_condition(robot: &Robot, equilibrium: &Equilibrium) -> f64 {
    let coordinates = Coordinates::of(robot);
    let columns: Vec<Vec6> = (equilibrium.cables.iter())
        .map(|cable| coordinates.reduce_force(&cable.chord_w().normalize(), &cable.lever_w))
        .collect();
    let matrix = DMat::from_fn(coordinates.count(), columns.len(), |i, j| columns[j][i]);
    let values = matrix.singular_values();
    let (least, most) = (values.min(), values.max());
    if most > 0.0 { least / most } else { 0.0 }
}

/// Gram matrix of the scaled unit wrenches of all cables that are not slack, in the platform's coordinates; `None` if
/// they are fewer than the degrees of freedom.
fn wrench_gram(robot: &Robot, equilibrium: &Equilibrium) -> Option<Mat6> {
    let coordinates = Coordinates::of(robot);
    let (mut gram, mut pulling) = (Mat6::zeros(), 0);
    for cable in equilibrium.cables.iter().filter(|cable| !cable.is_slack()) {
        let force = cable.force_on_platform_w.try_normalize(0.0).unwrap_or_else(|| cable.chord_w().normalize());
        let unit = coordinates.reduce_force(&force, &cable.lever_w);
        gram += unit * unit.transpose();
        pulling += 1;
    }
    (pulling >= coordinates.count()).then_some(gram)
}

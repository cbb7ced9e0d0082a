//! Potential energy of a robot at a pose.

use super::equilibrium::Equilibrium;
use super::{ropes, supports};
use crate::drive::CableAtRest;
use crate::robot::{Pose, Robot};

/// Potential energy [J] of cables, platform and load at an equilibrium, up to a constant: weights are measured from the
/// world's origin, and cables without force have no energy. The moment of a load has no energy and is left out. The
/// drag of the wind counts as if it kept its direction. Ideal cables have neither weight nor strain.
///
/// # Example
/// ```
/// # use funicular::{robot::{Pose, Robot}, statics::{self, StaticModel}};
/// # let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM)?;
/// let pose = Pose::new([0.2, 0.0, 0.6], [0.0; 3]);
/// let ideal = statics::inverse(&robot, &pose, StaticModel::Ideal)?;
/// assert!((statics::energy(&robot, &ideal) - 10.55 * 9.81 * 0.6).abs() < 1e-9); // m g z
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn energy(robot: &Robot, equilibrium: &Equilibrium) -> f64 {
    let cables: Vec<CableAtRest> = (equilibrium.cables.iter())
        .filter_map(|cable| Some(CableAtRest { span: cable.hanging.clone()?, drive: cable.drive.clone() }))
        .collect();
    let lengths: Vec<f64> = equilibrium.cables.iter().map(|cable| cable.unstrained_length).collect();
    let is_elastic = cables.len() == robot.cables.len();
    let of_ropes = if is_elastic { ropes::energy_of_references(robot, &cables, &lengths) } else { 0.0 };
    let of_supports = if robot.has_supports() && is_elastic {
        supports::energy(robot, &cables, &lengths, &equilibrium.support_displacements(robot))
    } else {
        0.0
    };
    of_parts(robot, &equilibrium.pose, cables.iter()) + of_supports + of_ropes
}

/// Potential energy [J] of cables that hang at a pose, in equilibrium or not, with platform and load.
pub(super) fn of_parts<'a>(robot: &Robot, pose: &Pose, cables: impl Iterator<Item = &'a CableAtRest>) -> f64 {
    let com_w = pose.point_w(&robot.platform.center_of_mass_p);
    let loaded_w = pose.point_w(&robot.load.point_p);
    let of_loads = robot.force_at_mass_centre_w().dot(&com_w) + robot.load.force_w.dot(&loaded_w);
    cables.map(CableAtRest::energy).sum::<f64>() - of_loads
}

//! How far the pose of simpler static models is off, over a range of platform masses (the paper's Fig. 6).

use crate::math::roots;
use crate::robot::{Pose, Robot};
use crate::statics::{self, Equilibrium, StaticModel, StaticsError};

/// Poses of the three static models at one platform mass.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseErrorPoint {
    /// Platform mass [kg].
    pub mass: f64,
    /// Equilibrium with ideal cables, whose pose does not depend on the mass. An error with more cables than degrees of freedom,
    /// where rigid cables of given lengths do not close, and where one of them would have to push.
    pub ideal: Result<Equilibrium, StaticsError>,
    /// Equilibrium with springs.
    pub spring: Result<Equilibrium, StaticsError>,
    /// Equilibrium with catenaries.
    pub catenary: Result<Equilibrium, StaticsError>,
}

/// Distance between two poses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseDifference {
    /// Translation of the platform origin, world axes [m].
    pub translation: [f64; 3],
    /// Its length [m].
    pub distance: f64,
    /// Angle of the rotation between both [rad].
    pub angle: f64,
}

impl PoseDifference {
    /// From `from` to `to`.
    pub fn between(from: &Pose, to: &Pose) -> Self {
        let translation = to.position_w - from.position_w;
        let angle = from.rot_wp.angle_to(&to.rot_wp);
        Self { translation: translation.into(), distance: translation.norm(), angle }
    }
}

impl PoseErrorPoint {
    /// Finds all three equilibria for unstrained lengths [m] at a platform mass [kg].
    pub fn at_mass(robot: &Robot, lengths: &[f64], mass: f64) -> Self {
        let robot = robot.with_mass(mass);
        let rest = |model| statics::forward(&robot, lengths, model, None);
        Self {
            mass,
            ideal: rest(StaticModel::Ideal),
            spring: rest(StaticModel::Spring),
            catenary: rest(StaticModel::Catenary),
        }
    }

    /// From the ideal pose to that of the springs.
    pub fn spring_from_ideal(&self) -> Option<PoseDifference> {
        difference(&self.ideal, &self.spring)
    }

    /// From the ideal pose to that of the catenaries.
    pub fn catenary_from_ideal(&self) -> Option<PoseDifference> {
        difference(&self.ideal, &self.catenary)
    }

    /// From the pose of the catenaries to that of the springs: the error of the spring model.
    pub fn spring_from_catenary(&self) -> Option<PoseDifference> {
        difference(&self.catenary, &self.spring)
    }
}

fn difference(
    from: &Result<Equilibrium, StaticsError>,
    to: &Result<Equilibrium, StaticsError>,
) -> Option<PoseDifference> {
    Some(PoseDifference::between(&from.as_ref().ok()?.pose, &to.as_ref().ok()?.pose))
}

/// From which mass on the spring model is good enough.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Threshold {
    /// At every mass of the range.
    Everywhere,
    /// From this mass [kg] to the end of the range; below it lies at least one mass where it is not.
    From(f64),
    /// Not at the end of the range.
    Nowhere,
}

/// The mass [kg] from which on the spring pose stays within `tolerance` [m] of the catenary pose, up to the last of
/// `points`, which ascend in mass. Refined between two points to 1e-6 of the mass. A mass at which one of both has no
/// equilibrium counts as not good enough.
pub fn threshold(robot: &Robot, lengths: &[f64], points: &[PoseErrorPoint], tolerance: f64) -> Threshold {
    let excess =
        |point: &PoseErrorPoint| point.spring_from_catenary().map_or(f64::INFINITY, |d| d.distance - tolerance);
    match points.iter().rposition(|point| excess(point) > 0.0) {
        None => Threshold::Everywhere,
        Some(last) if last + 1 == points.len() => Threshold::Nowhere,
        Some(last) => {
            let (low, high) = (&points[last], &points[last + 1]);
            let f = |mass: f64| excess(&PoseErrorPoint::at_mass(robot, lengths, mass));
            Threshold::From(roots::brent(low.mass, excess(low), high.mass, excess(high), f))
        }
    }
}

//! Pose error of the simpler static models over a range of platform masses (the paper's Fig. 6).

use crate::math::roots;
use crate::robot::{Pose, Robot};
use crate::statics::{self, Equilibrium, StaticModel, StaticsError};

/// Poses of the three static models at one platform mass.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseErrorPoint {
    /// Platform mass [kg].
    pub mass: f64,
    /// Equilibrium with ideal cables, whose pose does not depend on the mass. It is an error if rigid cables of the
    /// given lengths do not close, as with more cables than degrees of freedom, or if a cable would push.
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
    /// Length of the translation [m].
    pub distance: f64,
    /// Angle of the rotation between both poses [rad].
    pub angle: f64,
}

impl PoseDifference {
    /// Difference from the pose `from` to the pose `to`.
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

    /// Difference from the pose with ideal cables to the pose with springs.
    pub fn spring_from_ideal(&self) -> Option<PoseDifference> {
        difference(&self.ideal, &self.spring)
    }

    /// Difference from the pose with ideal cables to the pose with catenaries.
    pub fn catenary_from_ideal(&self) -> Option<PoseDifference> {
        difference(&self.ideal, &self.catenary)
    }

    /// Difference from the pose with catenaries to the pose with springs: the error of the spring model.
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

/// Range of platform masses in which the spring model is good enough.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Threshold {
    /// Good enough at every mass of the range.
    Everywhere,
    /// Good enough from this mass [kg] to the end of the range, but not at every mass below.
    From(f64),
    /// Not good enough at the end of the range.
    Nowhere,
}

/// Minimum mass [kg] above which the spring pose stays within `tolerance` [m] of the catenary pose, up to the last of
/// `points`, which ascend in mass. The mass is refined between two points to 1e-6 of its value. A mass without an
/// equilibrium of both models counts as not good enough.
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

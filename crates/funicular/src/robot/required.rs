//! Loads that a robot has to bear at every pose where it works.

use super::{Load, LoadError, PlatformMotion};
use crate::math::{Vec3, Vec6};
use thiserror::Error;

/// Required loads: everything that acts on the platform in addition to the dead load. The parts add up in every
/// combination (Minkowski sum); the dead load alone is always required, too. The required velocities stand beside the
/// loads.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RequiredLoads {
    /// Shape of the set of forces and moments.
    pub shape: LoadShape,
    /// Half widths of the force, world axes [N], not negative.
    pub force_w: Vec3,
    /// Half widths of the moment about the platform origin, world axes [N m], not negative.
    pub moment_w: Vec3,
    /// Loads of which any one may act; each has its own point of action.
    pub listed: Vec<Load>,
    /// Payload of uncertain mass and place.
    pub payload: RequiredPayload,
    /// Half widths of the acceleration of the platform origin from rest, world axes [m/s²], not negative.
    pub acceleration_w: Vec3,
    /// Half widths of the angular acceleration from rest, world axes [rad/s²], not negative.
    pub angular_acceleration_w: Vec3,
    /// Speed of wind from any horizontal direction on the platform [m/s]; its force is added to that of the robot's
    /// wind.
    pub wind_speed: f64,
    /// Half widths of the velocity of the platform origin that the winches have to give, world axes [m/s], not
    /// negative. It is no load: it changes neither load factor nor margins.
    pub velocity_w: Vec3,
    /// Half widths of the angular velocity, world axes [rad/s], not negative; no load either.
    pub angular_velocity_w: Vec3,
    /// Shape of the set of velocities, and of that of angular velocities.
    pub velocity_shape: LoadShape,
}

/// Set of twists: of a velocity and an angular velocity, each in a box or in an ellipsoid of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TwistSet {
    /// Half widths or half axes, world axes [m/s, rad/s], not negative.
    pub half_widths: Vec6,
    /// Shape of either part.
    pub shape: LoadShape,
}

/// Payload of uncertain mass and centre of mass, carried by the platform.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RequiredPayload {
    /// Minimum mass [kg]; it belongs to the dead load.
    pub min_mass: f64,
    /// Maximum mass [kg].
    pub max_mass: f64,
    /// Middle of the centres of mass, platform frame [m].
    pub center_p: Vec3,
    /// Half widths of the box of the centres of mass, platform frame [m], not negative.
    pub center_reach_p: Vec3,
}

/// Shape of a set of forces and moments with given half widths.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LoadShape {
    /// Every component varies by itself.
    #[default]
    Box,
    /// Ellipsoid with these half axes; equal half axes give a ball.
    Ellipsoid,
}

/// Required loads that contradict themselves or the platform.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum RequiredLoadsError {
    /// The range of the payload is reversed.
    #[error(
        "the minimum payload {min} kg is above the maximum payload {max} kg: exchange the two, or leave out the minimum"
    )]
    PayloadReversed {
        /// Minimum [kg].
        min: f64,
        /// Maximum [kg].
        max: f64,
    },
    /// A component that cannot act on a point mass.
    #[error(
        "a point mass does not turn: leave out the required moment, angular acceleration, angular velocity and centre \
         of the payload"
    )]
    TurnsPointMass,
    /// A listed load has no meaning for the platform.
    #[error(transparent)]
    Listed(#[from] LoadError),
}

impl RequiredLoads {
    /// True if no load is required but the dead load.
    pub fn is_empty(&self) -> bool {
        let no_vector = [self.force_w, self.moment_w, self.acceleration_w, self.angular_acceleration_w]
            .iter()
            .all(|of| *of == Vec3::zeros());
        no_vector && self.listed.is_empty() && self.payload.max_mass == 0.0 && self.wind_speed == 0.0
    }

    /// Twists that the winches have to give: velocity of the platform origin [m/s], then angular velocity [rad/s],
    /// world axes.
    pub fn twists_w(&self) -> TwistSet {
        TwistSet { half_widths: stacked(&self.velocity_w, &self.angular_velocity_w), shape: self.velocity_shape }
    }

    /// Half widths of the box of accelerations from rest: of the platform origin [m/s²], then angular [rad/s²], world
    /// axes.
    pub fn accelerations_w(&self) -> Vec6 {
        stacked(&self.acceleration_w, &self.angular_acceleration_w)
    }

    /// Refuses loads that contradict themselves or have no meaning for a platform with this motion.
    ///
    /// # Errors
    /// [`RequiredLoadsError`].
    pub fn check(&self, motion: &PlatformMotion) -> Result<(), RequiredLoadsError> {
        let RequiredPayload { min_mass: min, max_mass: max, center_p, center_reach_p } = self.payload;
        if min > max {
            return Err(RequiredLoadsError::PayloadReversed { min, max });
        }
        let turning = [self.moment_w, self.angular_acceleration_w, self.angular_velocity_w, center_p, center_reach_p];
        if *motion == PlatformMotion::PointMass && turning.iter().any(|of| *of != Vec3::zeros()) {
            return Err(RequiredLoadsError::TurnsPointMass);
        }
        self.listed.iter().try_for_each(|load| Ok(load.check(motion)?))
    }
}

impl TwistSet {
    /// Box with these half widths.
    pub fn in_box(half_widths: Vec6) -> Self {
        Self { half_widths, shape: LoadShape::Box }
    }

    /// True if the set has no twist but zero.
    pub fn is_empty(&self) -> bool {
        self.half_widths == Vec6::zeros()
    }

    /// Largest value of a linear function of the twist, given by its row: equation (40z3).
    pub fn largest(&self, row: &Vec6) -> f64 {
        let scaled = row.component_mul(&self.half_widths);
        match self.shape {
            LoadShape::Box => scaled.abs().sum(),
            LoadShape::Ellipsoid => scaled.fixed_rows::<3>(0).norm() + scaled.fixed_rows::<3>(3).norm(),
        }
    }

    /// Twist at which a linear function is largest; parts that do not matter are zero.
    pub fn farthest(&self, row: &Vec6) -> Vec6 {
        let scaled = row.component_mul(&self.half_widths);
        let unit = match self.shape {
            LoadShape::Box => scaled.map(|of| if of == 0.0 { 0.0 } else { of.signum() }),
            LoadShape::Ellipsoid => {
                let [linear, angular] = [0, 3].map(|from| {
                    let part: Vec3 = scaled.fixed_rows::<3>(from).into();
                    part.try_normalize(0.0).unwrap_or_else(Vec3::zeros)
                });
                stacked(&linear, &angular)
            }
        };
        unit.component_mul(&self.half_widths)
    }

    /// Twists at the corners of the box of the half widths, moved into the set: all corners of a box, and points of the
    /// surface of an ellipsoid in every octant.
    pub(crate) fn corners(&self) -> impl Iterator<Item = Vec6> + use<> {
        let half_widths = self.half_widths;
        let inside = match self.shape {
            LoadShape::Box => Vec6::repeat(1.0),
            LoadShape::Ellipsoid => {
                let part = |from: usize| {
                    let count = (from..from + 3).filter(|axis| half_widths[*axis] > 0.0).count();
                    Vec3::repeat((count.max(1) as f64).sqrt().recip())
                };
                stacked(&part(0), &part(3))
            }
        };
        let axes: Vec<usize> = (0..6).filter(|axis| half_widths[*axis] > 0.0).collect();
        (0..1_usize << axes.len()).map(move |corner| {
            let mut twist_w = Vec6::zeros();
            for (bit, axis) in axes.iter().enumerate() {
                let side = if corner >> bit & 1 == 0 { 1.0 } else { -1.0 };
                twist_w[*axis] = side * inside[*axis] * half_widths[*axis];
            }
            twist_w
        })
    }
}

/// Six components of a motion: linear, then angular.
pub(crate) fn stacked(linear: &Vec3, angular: &Vec3) -> Vec6 {
    Vec6::new(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)
}

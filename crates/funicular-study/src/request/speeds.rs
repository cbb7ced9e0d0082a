//! Request about the speeds that the winches allow at a pose.

use super::key::declared;
use super::parts::{RobotText, State, Tensions, check};
use crate::values::not_negative;
use anyhow::Result;
use funicular::robot::LoadShape;

declared! {
    /// Velocities that the winches have to give the platform; they replace those of [required] in the robot file.
    #[derive(Copy)]
    pub struct RequiredVelocities {
        /// Largest required velocity of the platform origin, both ways along each world axis [m/s].
        required_velocity_m_s: Option<[f64; 3]> = None => (Vector).under("Required velocities");
        /// Largest required angular velocity, both ways about each world axis [rad/s].
        required_angular_velocity_rad_s: Option<[f64; 3]> = None => (Vector).under("Required velocities");
        /// Shape of the set of required velocities, and of that of angular velocities: an ellipsoid with equal half
        /// axes is every direction up to one speed.
        #[serde(with = "crate::names::optional")]
        required_velocity_shape: Option<LoadShape> = None => (name::<LoadShape>())
            .form("SHAPE").under("Required velocities").otherwise("from the robot file, or box");
    }
}

impl RequiredVelocities {
    /// Checks the numbers.
    ///
    /// # Errors
    /// A number that is not finite, or a negative half width.
    pub(crate) fn check(&self) -> Result<()> {
        let widths = [
            ("required_velocity_m_s", self.required_velocity_m_s),
            ("required_angular_velocity_rad_s", self.required_angular_velocity_rad_s),
        ];
        widths.into_iter().try_for_each(|(key, width)| {
            width.iter().flatten().try_for_each(|value| check(key, Some(*value), not_negative))
        })
    }
}

declared! {
    /// Speeds that the winches allow at a pose: what each has to do for the required velocities, how fast the platform
    /// can move, and the powers of the motors.
    ///
    /// The platform moves so slowly that its tensions are those at rest; they follow their rule from pose to pose.
    pub struct SpeedsRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Required velocities.
        #[serde(flatten)]
        required: RequiredVelocities = RequiredVelocities::default() => group;
        /// State and loads.
        #[serde(flatten)]
        state: State = State::default() => group;
        /// Rule and limits of tensions.
        #[serde(flatten)]
        tensions: Tensions = Tensions::default() => group;
    }
    examples {
        "funicular speeds robots/cogiro-winches.toml --pose 1,1,1.5 --set winches.drum.max_speed_m_s=3 \
         --required-velocity-m-s 1,1,0.5",
        "funicular speeds robots/cogiro-winches.toml --pose 1,1,1.5 --set winches.drum.max_power_w=2000 --set \
         winches.drum.gear_efficiency=0.9",
        "funicular map robots/cogiro-winches.toml --grid x=-4:4:17 --grid z=1.5 --set winches.drum.max_speed_m_s=3 \
         --required-velocity-m-s 1,1,1 --quantity speed-factor -o cogiro.parquet",
    }
}

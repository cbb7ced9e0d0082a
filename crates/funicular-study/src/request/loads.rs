//! Requests about the loads that the robot has to bear at a pose.

use super::key::declared;
use super::parts::{RobotText, State, Tensions, check, check_vector};
use crate::values::not_negative;
use anyhow::Result;
use funicular::robot::LoadShape;

declared! {
    /// Loads that the robot has to bear in addition to the dead load; they replace those of [required] in the robot
    /// file.
    #[derive(Copy)]
    pub struct Requirements {
        /// Largest required force, both ways along each world axis [N].
        required_force_n: Option<[f64; 3]> = None => (Vector).under("Required loads");
        /// Largest required moment about the platform origin, both ways about each world axis [N m].
        required_moment_n_m: Option<[f64; 3]> = None => (Vector).under("Required loads");
        /// Shape of the set of required forces and moments.
        #[serde(with = "crate::names::optional")]
        required_shape: Option<LoadShape> = None =>
            (name::<LoadShape>()).form("SHAPE").under("Required loads").otherwise("from the robot file, or box");
        /// Minimum required payload [kg], which is always carried.
        required_payload_min_kg: Option<f64> = None => (Number(NotNegative)).under("Required loads");
        /// Maximum required payload [kg].
        required_payload_max_kg: Option<f64> = None => (Number(NotNegative)).under("Required loads");
        /// Middle of the centres of mass of the required payload, platform frame [m].
        required_payload_center_m: Option<[f64; 3]> = None => (Vector).under("Required loads");
        /// Largest distance of the centre of mass of the payload from this middle, both ways along each axis of the
        /// platform [m].
        required_payload_center_reach_m: Option<[f64; 3]> = None => (Vector).under("Required loads");
        /// Largest required acceleration of the platform origin from rest, both ways along each world axis [m/s²].
        required_acceleration_m_s2: Option<[f64; 3]> = None => (Vector).under("Required loads");
        /// Largest required angular acceleration from rest, both ways about each world axis [rad/s²].
        required_angular_acceleration_rad_s2: Option<[f64; 3]> = None => (Vector).under("Required loads");
        /// Speed of the required wind from every horizontal direction, on platform and ropes [m/s].
        required_wind_speed_m_s: Option<f64> = None => (Number(NotNegative)).under("Required loads");
    }
}

impl Requirements {
    /// Checks the numbers.
    ///
    /// # Errors
    /// A number that is not finite, or a negative half width, mass or speed.
    pub(crate) fn check(&self) -> Result<()> {
        check_vector("required_payload_center_m", self.required_payload_center_m)?;
        let widths = [
            ("required_force_n", self.required_force_n),
            ("required_moment_n_m", self.required_moment_n_m),
            ("required_payload_center_reach_m", self.required_payload_center_reach_m),
            ("required_acceleration_m_s2", self.required_acceleration_m_s2),
            ("required_angular_acceleration_rad_s2", self.required_angular_acceleration_rad_s2),
        ];
        for (key, width) in widths {
            width.iter().flatten().try_for_each(|value| check(key, Some(*value), not_negative))?;
        }
        check("required_payload_min_kg", self.required_payload_min_kg, not_negative)?;
        check("required_payload_max_kg", self.required_payload_max_kg, not_negative)?;
        check("required_wind_speed_m_s", self.required_wind_speed_m_s, not_negative)
    }
}

declared! {
    /// Loads that the cables hold at a pose, compared with the required ones: verdict, load factor, what binds,
    /// margins.
    ///
    /// All tensions within the limits count, not only those of a tension rule.
    pub struct LoadsRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Required loads.
        #[serde(flatten)]
        required: Requirements = Requirements::default() => group;
        /// State and loads.
        #[serde(flatten)]
        state: State = State::default() => group;
        /// Rule and limits of tensions.
        #[serde(flatten)]
        tensions: Tensions = Tensions::default() => group;
    }
    examples {
        "funicular loads robots/cogiro.toml --pose 1,1,1.5 --required-force-n 150,150,150 --required-moment-n-m \
         30,30,30",
        "funicular loads robots/cogiro.toml --pose 1,1,1.5 --required-payload-max-kg 200 --required-acceleration-m-s2 \
         1,1,1",
        "funicular map robots/cogiro.toml --grid x=-6:6:25 --grid y=-4:4:17 --grid z=1.5 --required-force-n \
         150,150,150 --quantity load-factor -o cogiro.parquet",
    }
}

//! Loads of a request: force, moment, wind, load of the cables, payload.

use crate::request::{self, Load};
use anyhow::{Result, bail};
use funicular::math::Vec3;
use funicular::robot::{PlatformMotion, Robot, Wind};

/// Robot with the loads of a request. Loads that the request does not give come from the robot file.
pub(super) fn with_load(mut robot: Robot, load: &Load) -> Result<Robot> {
    for vector in load.of_file() {
        if let Some(value) = vector.value {
            *(vector.of_robot)(&mut robot) = value.into();
        }
    }

    if load.wind_m_s.is_some() {
        let speed = robot.wind.velocity_w.norm();
        if speed > Wind::MAX_SPEED {
            bail!(
                "⟪wind_m_s⟫ is a wind of {speed} m/s, it must be at most {} m/s: air is compressible at higher speeds",
                Wind::MAX_SPEED
            );
        }
    }

    if let Some(load) = load.cable_load_n_per_m {
        robot = robot.with_cable_load(load.into());
    }

    if load.load_point_m.is_some() && robot.load.force_w.norm() == 0.0 {
        bail!("⟪load_point_m⟫ is the point of a force, but there is no force: give ⟪force_n⟫");
    }

    robot.load.check(&robot.platform.motion)?;
    Ok(robot)
}

/// Centre of mass of a payload that a request gives, platform frame [m].
///
/// # Errors
/// A number that is not finite, or a centre beside a point mass.
pub(crate) fn payload_center(robot: &Robot, center_m: Option<[f64; 3]>) -> Result<Option<Vec3>> {
    request::check_vector("payload_center_m", center_m)?;
    let center_p = center_m.map(Vec3::from);
    if robot.platform.motion == PlatformMotion::PointMass && center_p.is_some_and(|center| center.norm() > 0.0) {
        bail!("a point mass has no payload beside its origin: leave out ⟪payload_center_m⟫");
    }
    Ok(center_p)
}

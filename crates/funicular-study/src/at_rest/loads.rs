//! Loads of a request: force, moment, wind, load of the cables, payload.

use crate::request::{self, Load};
use anyhow::{Result, bail};
use funicular::math::Vec3;
use funicular::robot::{self, PlatformMotion, Robot, Wind};

/// Robot with the loads of a request. Loads that the request does not give come from the robot file.
pub(super) fn with_load(mut robot: Robot, load: &Load) -> Result<Robot> {
    let Load { force_n, moment_n_m, load_point_m, wind_m_s, cable_load_n_per_m } = *load;
    let or = |given: Option<[f64; 3]>, of_file: Vec3| given.map_or(of_file, Vec3::from);

    robot.load = robot::Load {
        force_w: or(force_n, robot.load.force_w),
        moment_w: or(moment_n_m, robot.load.moment_w),
        point_p: or(load_point_m, robot.load.point_p),
    };

    if let Some(velocity_w) = wind_m_s.map(Vec3::from) {
        let speed = velocity_w.norm();
        if speed > Wind::MAX_SPEED {
            bail!(
                "⟪wind_m_s⟫ is a wind of {speed} m/s, it must be at most {} m/s: air is compressible at higher speeds",
                Wind::MAX_SPEED
            );
        }
        robot.wind.velocity_w = velocity_w;
    }

    if let Some(load) = cable_load_n_per_m {
        robot = robot.with_cable_load(load.into());
    }

    if load_point_m.is_some() && robot.load.force_w.norm() == 0.0 {
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

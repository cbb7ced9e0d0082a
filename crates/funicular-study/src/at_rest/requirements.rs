//! Required loads of a request.

use crate::request::{RequiredVelocities, Requirements};
use anyhow::{Result, bail};
use funicular::math::Vec3;
use funicular::robot::{RequiredPayload, Robot, Wind};

/// Robot with the required loads of a request. Loads that the request does not give come from the robot file.
///
/// # Errors
/// Numbers that are no loads, a reversed range of the payload, or loads that have no meaning for the platform.
pub(crate) fn with_required(mut robot: Robot, request: &Requirements) -> Result<Robot> {
    request.check()?;
    let or = |given: Option<[f64; 3]>, of_file: Vec3| given.map_or(of_file, Vec3::from);
    let own = &mut robot.required;

    own.force_w = or(request.required_force_n, own.force_w);
    own.moment_w = or(request.required_moment_n_m, own.moment_w);
    own.shape = request.required_shape.unwrap_or(own.shape);
    own.acceleration_w = or(request.required_acceleration_m_s2, own.acceleration_w);
    own.angular_acceleration_w = or(request.required_angular_acceleration_rad_s2, own.angular_acceleration_w);
    own.wind_speed = request.required_wind_speed_m_s.unwrap_or(own.wind_speed);

    let RequiredPayload { min_mass, max_mass, center_p, center_reach_p } = own.payload;
    own.payload = RequiredPayload {
        min_mass: request.required_payload_min_kg.unwrap_or(min_mass),
        max_mass: request.required_payload_max_kg.unwrap_or(max_mass),
        center_p: or(request.required_payload_center_m, center_p),
        center_reach_p: or(request.required_payload_center_reach_m, center_reach_p),
    };

    if own.wind_speed > Wind::MAX_SPEED {
        bail!("⟪required_wind_speed_m_s⟫ is {} m/s, it must be at most {} m/s", own.wind_speed, Wind::MAX_SPEED);
    }
    robot.required.check(&robot.platform.motion)?;
    Ok(robot)
}

/// Robot with the required velocities of a request. Those that the request does not give come from the robot file.
///
/// # Errors
/// Numbers that are no half widths, or an angular velocity of a point mass.
pub(crate) fn with_required_velocities(mut robot: Robot, request: &RequiredVelocities) -> Result<Robot> {
    request.check()?;
    let or = |given: Option<[f64; 3]>, of_file: Vec3| given.map_or(of_file, Vec3::from);
    let own = &mut robot.required;
    own.velocity_w = or(request.required_velocity_m_s, own.velocity_w);
    own.angular_velocity_w = or(request.required_angular_velocity_rad_s, own.angular_velocity_w);
    own.velocity_shape = request.required_velocity_shape.unwrap_or(own.velocity_shape);
    robot.required.check(&robot.platform.motion)?;
    Ok(robot)
}

//! Rows of a trajectory, and their columns.

use super::at_time::lengths;
use super::samples::MotionSamples;
use super::used::UsedLimit;
use crate::analyses::fields::{self, AXES};
use crate::analyses::shared::PoseRow;
use crate::columns::{Columns, column, parts};
use funicular::math::Vec6;
use funicular::modes;
use funicular::robot::Robot;
use funicular::statics::StaticModel;
use serde::Serialize;

/// Robot at one time of a path. Lists have a number per cable.
#[derive(Serialize)]
pub struct TrajectoryRow {
    /// Time since the start of the path.
    pub t_s: f64,
    #[serde(flatten)]
    pub pose: PoseRow,
    pub velocity_m_s: [f64; 3],
    pub angular_velocity_rad_s: [f64; 3],
    pub acceleration_m_s2: [f64; 3],
    pub angular_acceleration_rad_s2: [f64; 3],
    pub unstrained_lengths_m: Vec<f64>,
    /// Positive while a cable is paid out.
    pub length_rates_m_s: Vec<f64>,
    pub length_accelerations_m_s2: Vec<f64>,
    pub tensions_platform_n: Vec<f64>,
    pub tensions_anchor_n: Vec<f64>,
    /// Speed of the stretched cable at the drum, positive while it is paid out.
    pub cable_speeds_m_s: Vec<f64>,
    /// Torque of each motor, positive in the direction that winds in; none without a radius of the drum. Empty without
    /// winches.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub motor_torques_n_m: Vec<Option<f64>>,
    /// Power of each motor, negative while it brakes. Empty without winches.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub motor_powers_w: Vec<Option<f64>>,
    /// First natural frequency at rest under these tensions; absent for cables without sag.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub first_frequency_hz: Option<f64>,
    /// Distance of the nearest pair beyond the required one; absent if the robot file says nothing about distances.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance_margin_m: Option<f64>,
    /// Limit of which the largest part is used; absent without limits.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limit: Option<&'static str>,
    /// Cable to which it belongs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limit_cable: Option<String>,
    /// Used over allowed; absent where nothing is allowed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub used_part: Option<f64>,
}

impl TrajectoryRow {
    /// Row with this number; a row on a jump has the values just after it.
    pub(super) fn of(robot: &Robot, samples: &MotionSamples, row: usize, used: Option<&(UsedLimit, f64)>) -> Self {
        let k = samples.rows[row];
        let motion = &samples.motions[k];
        let (point, rest) = (&motion.point, &motion.equilibrium);
        let winches: Vec<_> = (0..robot.cables.len()).map(|i| samples.winch(robot, k, i)).collect();
        let has_winches = winches.iter().any(|winch| winch.motor.is_some());
        let of_motors = |of: fn(&funicular::robot::MotorLoad) -> Option<f64>| -> Vec<Option<f64>> {
            let values = winches.iter().map(|winch| winch.motor.as_ref().and_then(of));
            if has_winches { values.collect() } else { Vec::new() }
        };
        let halves = |of: &Vec6| [[of[0], of[1], of[2]], [of[3], of[4], of[5]]];
        let [velocity_m_s, angular_velocity_rad_s] = halves(&point.velocity_w);
        let [acceleration_m_s2, angular_acceleration_rad_s2] = halves(&point.acceleration_w);
        let first = || modes::first(robot, rest).ok().map(|first| first.frequency_hz);
        let used = used.filter(|(_, part)| *part > 0.0);

        Self {
            t_s: samples.times[k],
            pose: PoseRow::of(&rest.pose),
            velocity_m_s,
            angular_velocity_rad_s,
            acceleration_m_s2,
            angular_acceleration_rad_s2,
            unstrained_lengths_m: lengths(motion),
            length_rates_m_s: motion.length_rates.clone(),
            length_accelerations_m_s2: samples.accelerations[k].clone(),
            tensions_platform_n: rest.cables.iter().map(|cable| cable.tension_platform).collect(),
            tensions_anchor_n: rest.cables.iter().map(|cable| cable.tension_anchor).collect(),
            cable_speeds_m_s: winches.iter().map(|winch| winch.speed).collect(),
            motor_torques_n_m: of_motors(|motor| motor.torque),
            motor_powers_w: of_motors(|motor| Some(motor.power)),
            first_frequency_hz: if rest.model == StaticModel::Catenary { first() } else { None },
            clearance_margin_m: samples.nearest[row].as_ref().map(funicular::clearance::Clearance::margin),
            limit: used.map(|(limit, _)| limit.name()),
            limit_cable: used.and_then(|(limit, _)| limit.cable()).map(|i| robot.cables[i].name.clone()),
            used_part: used.map(|(_, part)| *part).filter(|part| part.is_finite()),
        }
    }

    /// Columns of the rows for cables of these names; those of winches and distances are there if there are such.
    pub fn columns(cables: &[String], has_winches: bool, has_distances: bool) -> Columns<Self> {
        let names = || cables.to_vec();
        let [position, angles] =
            fields::pose(|row: &Self| Some(row.pose.position_m), |row: &Self| Some(row.pose.roll_pitch_yaw_deg));
        let lowest = |row: &Self| row.tensions_platform_n.iter().copied().fold(f64::INFINITY, f64::min);
        let highest = |row: &Self| row.tensions_anchor_n.iter().copied().fold(0.0, f64::max);
        let fastest = |row: &Self| row.cable_speeds_m_s.iter().map(|speed| speed.abs()).fold(0.0, f64::max);
        Columns::new([
            column("t_s", "s", "time since the start of the path", |row: &Self| row.t_s).decimals("t", "s", 3),
            position.shown("position", "m", |row, style| style.vector(&row.pose.position_m, 3)),
            angles.shown("roll, pitch, yaw", "°", |row, style| style.vector(&row.pose.roll_pitch_yaw_deg, 2)),
            parts("velocity_{}_m_s", AXES, "m/s", "velocity of the platform origin, {}", |row: &Self| row.velocity_m_s),
            parts("angular_velocity_{}_rad_s", AXES, "rad/s", "angular velocity of the platform, {}", |row: &Self| {
                row.angular_velocity_rad_s
            }),
            parts("acceleration_{}_m_s2", AXES, "m/s²", "acceleration of the platform origin, {}", |row: &Self| {
                row.acceleration_m_s2
            }),
            parts(
                "angular_acceleration_{}_rad_s2",
                AXES,
                "rad/s²",
                "angular acceleration of the platform, {}",
                |row: &Self| row.angular_acceleration_rad_s2,
            ),
            parts("unstrained_length_{}_m", names(), "m", "unstrained length of cable {}", |row: &Self| {
                row.unstrained_lengths_m.clone()
            }),
            parts("length_rate_{}_m_s", names(), "m/s", "rate of the unstrained length of cable {}", |row: &Self| {
                row.length_rates_m_s.clone()
            }),
            parts(
                "length_acceleration_{}_m_s2",
                names(),
                "m/s²",
                "acceleration of the unstrained length of cable {}",
                |row: &Self| row.length_accelerations_m_s2.clone(),
            ),
            parts("tension_platform_{}_n", names(), "N", "tension of cable {} at the platform", |row: &Self| {
                row.tensions_platform_n.clone()
            })
            .shown("lowest tension", "N", move |row, style| style.significant(lowest(row), 4)),
            parts("tension_anchor_{}_n", names(), "N", "tension of cable {} at the anchor", |row: &Self| {
                row.tensions_anchor_n.clone()
            })
            .shown("largest", "N", move |row, style| style.significant(highest(row), 4)),
            parts(
                "cable_speed_{}_m_s",
                names(),
                "m/s",
                "speed of cable {} at the drum, positive while it is paid out",
                |row: &Self| row.cable_speeds_m_s.clone(),
            )
            .shown("largest speed", "m/s", move |row, style| style.decimals(fastest(row), 3)),
            parts(
                "motor_torque_{}_n_m",
                names(),
                "N m",
                "torque of the motor of cable {}, positive while it winds in",
                |row: &Self| row.motor_torques_n_m.clone(),
            )
            .only_if(has_winches),
            parts(
                "motor_power_{}_w",
                names(),
                "W",
                "power of the motor of cable {}, negative while it brakes",
                |row: &Self| row.motor_powers_w.clone(),
            )
            .only_if(has_winches),
            column("first_frequency_hz", "Hz", "first natural frequency", |row: &Self| row.first_frequency_hz)
                .decimals("f1", "Hz", 3),
            column("clearance_margin_m", "m", "distance of the nearest pair beyond the required one", |row: &Self| {
                row.clearance_margin_m
            })
            .decimals("clearance margin", "m", 3)
            .only_if(has_distances),
            column("limit", "", "limit of which the largest part is used", |row: &Self| row.limit).plain("limit"),
            column("limit_cable", "", "cable to which this limit belongs", |row: &Self| row.limit_cable.clone())
                .plain("of cable"),
            column("used_part", "1", "used part of this limit, above 1 beyond it", |row: &Self| row.used_part)
                .decimals("used", "", 3),
        ])
    }
}

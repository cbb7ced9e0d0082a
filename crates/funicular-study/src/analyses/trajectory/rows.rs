//! Rows of a trajectory, and their columns.

use super::at_time::lengths;
use super::samples::MotionSamples;
use super::used::UsedLimit;
use crate::analyses::shared::MotionRow;
use crate::rows::rows;
use funicular::modes;
use funicular::robot::Robot;
use funicular::statics::StaticModel;

rows! {
    /// Robot at one time of a path. Lists have a number per cable.
    pub struct TrajectoryRow in tables(cables: &[String], has_winches: bool, has_distances: bool) {
        /// Time since the start of the path.
        pub t_s: f64 => one.decimals("t", 3);
        /// Motion of the platform.
        pub motion: MotionRow = spread => columns([3, 2]);
        /// Unstrained length of cable {}.
        pub unstrained_lengths_m: Vec<f64> => each(cables, "unstrained_length_{}_m");
        /// Rate of the unstrained length of cable {}.
        ///
        /// Positive while it is paid out.
        pub length_rates_m_s: Vec<f64> => each(cables, "length_rate_{}_m_s");
        /// Acceleration of the unstrained length of cable {}.
        pub length_accelerations_m_s2: Vec<f64> => each(cables, "length_acceleration_{}_m_s2");
        /// Tension of cable {} at the platform.
        pub tensions_platform_n: Vec<f64> => each(cables, "tension_platform_{}_n").lowest("lowest tension", 4);
        /// Tension of cable {} at the anchor.
        pub tensions_anchor_n: Vec<f64> => each(cables, "tension_anchor_{}_n").largest("largest", 4);
        /// Speed of cable {} at the drum, positive while it is paid out.
        pub cable_speeds_m_s: Vec<f64> => each(cables, "cable_speed_{}_m_s")
            .shown("largest speed", "m/s", |row, style| style.decimals(row.fastest(), 3));
        /// Torque of the motor of cable {}, positive while it winds in.
        ///
        /// None without a radius of the drum. Empty without winches.
        pub motor_torques_n_m: Vec<Option<f64>> = sparse => each(cables, "motor_torque_{}_n_m").only_if(has_winches);
        /// Power of the motor of cable {}, negative while it brakes.
        ///
        /// Empty without winches.
        pub motor_powers_w: Vec<Option<f64>> = sparse => each(cables, "motor_power_{}_w").only_if(has_winches);
        /// First natural frequency.
        ///
        /// At rest under these tensions; absent for cables without sag.
        pub first_frequency_hz: Option<f64> => one.decimals("f1", 3);
        /// Distance of the nearest pair beyond the required one.
        ///
        /// Absent if the robot file says nothing about distances.
        pub clearance_margin_m: Option<f64> => one.decimals("clearance margin", 3).only_if(has_distances);
        /// Limit of which the largest part is used.
        ///
        /// Absent without limits.
        pub limit: Option<&'static str> => one.plain("limit");
        /// Cable to which this limit belongs.
        pub limit_cable: Option<String> => one.plain("of cable");
        /// Used part of this limit, above 1 beyond it.
        ///
        /// Absent where nothing is allowed.
        pub used_part: Option<f64> => one.decimals("used", 3);
    }
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
        let first = || modes::first(robot, rest).ok().map(|first| first.frequency_hz);
        let used = used.filter(|(_, part)| *part > 0.0);

        Self {
            t_s: samples.times[k],
            motion: MotionRow::of(&rest.pose, &point.velocity_w, &point.acceleration_w),
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

    /// Largest speed of a cable [m/s].
    fn fastest(&self) -> f64 {
        self.cable_speeds_m_s.iter().map(|speed| speed.abs()).fold(0.0, f64::max)
    }
}

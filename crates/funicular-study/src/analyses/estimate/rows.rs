//! Rows of an estimate, and their columns.

use crate::analyses::shared::{AXES, PoseRow};
use crate::rows::rows;
use funicular::estimation::{Estimate, Estimator, Slackness};

/// Deviation within which the centre of mass of a payload is told [m].
const CENTER_KNOWN: f64 = 0.1;

rows! {
    /// Estimated state at one time. Lists have a number per cable. Deviations are absent where the readings do not fit
    /// their stated noise.
    pub struct EstimateRow in tables(cables: &[String]) {
        /// Time of the log.
        pub t_s: f64 => one.decimals("t", 3);
        /// Pose.
        pub pose: PoseRow = spread => columns([4, 3]);
        /// Standard deviation of the position, {}.
        pub position_std_m: Option<[f64; 3]> => each(AXES);
        /// Standard deviation of small turns about the world's axes, {}.
        pub rotation_std_deg: Option<[f64; 3]> => each(AXES);
        /// Velocity of the platform origin, {}.
        pub velocity_m_s: [f64; 3] => each(AXES);
        /// Standard deviation of the velocity, {}.
        pub velocity_std_m_s: Option<[f64; 3]> => each(AXES);
        /// Angular velocity of the platform, {}.
        pub angular_velocity_rad_s: [f64; 3] => each(AXES);
        /// Standard deviation of the angular velocity, {}.
        pub angular_velocity_std_rad_s: Option<[f64; 3]> => each(AXES);
        /// Payload beyond the platform of the file.
        pub payload_kg: f64 => one.decimals("payload", 2);
        /// Standard deviation of the payload.
        pub payload_std_kg: Option<f64> => one.decimals("±", 2);
        /// Centre of mass of the payload, platform frame, {}.
        ///
        /// Absent while payload or first moment are too uncertain.
        pub payload_center_m: Option<[f64; 3]> => each(AXES);
        /// External force besides the loads of the file, {}.
        pub force_n: [f64; 3] => each(AXES);
        /// Standard deviation of the external force, {}.
        pub force_std_n: Option<[f64; 3]> => each(AXES);
        /// Tension of cable {} at the anchor or drum.
        pub tensions_n: Vec<f64> => each(cables, "tension_{}_n").lowest("lowest tension", 4);
        /// Standard deviation of the tension of cable {}.
        pub tensions_std_n: Option<Vec<f64>> => each(cables, "tension_{}_std_n");
        /// State of cable {}: `slack`, `taut`, or `unknown`.
        pub slack: Vec<&'static str> => each(cables, "slack_{}");
        /// Reading of the load cell of cable {} less the expected one, in its standard deviations.
        ///
        /// Absent at a time without a reading of every load cell.
        pub residuals: Option<Vec<f64>> => each(cables, "residual_{}");
        /// True if the readings of the last half second fit their stated noise.
        pub is_trusted: bool => one;
        /// True while the platform vibrates: payload and its centre are then read from means of tensions alone.
        pub rings: bool => one;
    }
}

rows! {
    /// Alarm of a test.
    pub struct EstimateAlarm in tables() {
        /// Time of the log.
        pub t_s: f64 => one.decimals("t", 3);
        /// Fault: `slip`, `load-cell`, `payload`, `force`, `cut`, `stuck`, `undecided`, or `restart`.
        pub fault: &'static str => one.plain("fault");
        /// Cable with the fault.
        pub cable: Option<String> => one.plain("cable");
        /// Size of the fault: slip [m], step of a load cell [N], payload [kg], force along z [N].
        pub size: Option<f64> => one;
        /// Standard deviation of the size.
        pub size_std: Option<f64> => one;
        /// Sentence about the alarm.
        pub text: String => one.plain("what");
    }
}

rows! {
    /// Readings of one kind of sensor beside their stated noise.
    pub struct SensorFit in tables() with {
        let band = |of: &Self, style: crate::columns::Style| style.range(of.band, 3);
    } rows {
        /// Sensor.
        pub sensor: &'static str => one.plain("sensor");
        /// Number of readings.
        pub readings: usize => one.plain("readings");
        /// Squared residuals by their covariance, per reading.
        ///
        /// One if noise and model are true.
        pub squares: f64 => one.decimals("mean square", 3);
        /// Band that holds the mean square with 95 % if noise and model are true.
        pub band: [f64; 2] => each(["from", "to"], "band_{}").shown("95 % band", "", band);
        /// Readings left out as outliers.
        pub outliers: usize => one.plain("outliers");
        /// Sentence about the residuals.
        pub text: String => one.plain("what");
    }
}

rows! {
    /// Constant errors of the sensors of one cable at the end of the log.
    pub struct CableErrors in tables() {
        /// Cable.
        pub cable: String => one.plain("cable");
        /// Length less its reading.
        pub offset_m: f64 => one.shown("offset", "mm", |of, style| style.decimals(1e3 * of.offset_m, 3));
        /// Standard deviation of the offset.
        pub offset_std_m: f64 => one.shown("±", "mm", |of, style| style.decimals(1e3 * of.offset_std_m, 3));
        /// Constant error of the load cell.
        ///
        /// Absent without readings.
        pub tension_bias_n: Option<f64> => one.decimals("bias", 2);
        /// Standard deviation of this error.
        pub tension_bias_std_n: Option<f64> => one.decimals("±", 2);
        /// Root mean square of the residuals of its load cell, in their standard deviations.
        pub residual_ratio: Option<f64> => one.decimals("residuals", 2);
    }
}

impl EstimateRow {
    /// Row of the present state of a filter.
    pub(super) fn now(t_s: f64, estimator: &mut Estimator, is_trusted: bool) -> Self {
        let residuals = estimator.relative_innovations();
        let residuals = residuals.iter().all(|z| z.is_finite()).then(|| residuals.to_vec());
        let of = estimator.state();
        let cables = &of.cables[..estimator.cables()];
        let std = |of: &[Estimate; 3]| is_trusted.then(|| of.map(|part| part.std));
        let value = |of: &[Estimate; 3]| of.map(|part| part.value);
        Self {
            t_s,
            pose: PoseRow::of(&of.pose),
            position_std_m: is_trusted.then_some(of.position_std),
            rotation_std_deg: is_trusted.then(|| of.rotation_std.map(f64::to_degrees)),
            velocity_m_s: value(&of.velocity),
            velocity_std_m_s: std(&of.velocity),
            angular_velocity_rad_s: value(&of.angular_velocity),
            angular_velocity_std_rad_s: std(&of.angular_velocity),
            payload_kg: of.payload.value,
            payload_std_kg: is_trusted.then_some(of.payload.std),
            payload_center_m: of.payload_center(CENTER_KNOWN).filter(|_| is_trusted).map(|center| value(&center)),
            force_n: value(&of.force),
            force_std_n: std(&of.force),
            tensions_n: cables.iter().map(|cable| cable.tension.value).collect(),
            tensions_std_n: is_trusted.then(|| cables.iter().map(|cable| cable.tension.std).collect()),
            slack: (cables.iter())
                .map(|cable| match cable.slackness {
                    _ if !is_trusted => "unknown",
                    Slackness::Slack => "slack",
                    Slackness::Taut => "taut",
                    Slackness::Unknown => "unknown",
                })
                .collect(),
            residuals,
            is_trusted,
            rings: of.rings,
        }
    }
}

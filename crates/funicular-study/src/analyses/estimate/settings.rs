//! Settings of the filter from a request.

use crate::request::SensorModel;
use funicular::estimation::{EstimationSettings, ProcessNoise, SensorNoise, StatePriors};
use funicular::math::Vec3;

impl SensorModel {
    /// Settings of the filter.
    pub(crate) fn settings(&self) -> EstimationSettings {
        EstimationSettings {
            noise: SensorNoise {
                length: self.length_std_m,
                tension: self.tension_std_n,
                angle: self.cable_angle_std_rad,
                gyroscope: self.gyroscope_std_rad_s,
                accelerometer: self.accelerometer_std_m_s2,
                tracker: self.tracker_std_m,
            },
            priors: StatePriors {
                payload: [self.payload_kg, self.payload_std_kg],
                first_moment: self.first_moment_std_kg_m,
                force: self.force_std_n,
                moment: self.moment_std_n_m,
                offset: self.offset_std_m,
                tension_bias: self.tension_bias_std_n,
                ..StatePriors::default()
            },
            process: ProcessNoise {
                wrench_time: self.force_time_s,
                friction: self.friction,
                ..ProcessNoise::default()
            },
            inertial_unit_p: Vec3::from(self.inertial_unit_m),
            tracked_point_p: Vec3::from(self.tracked_point_m),
        }
    }
}

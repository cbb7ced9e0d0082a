//! Required loads and velocities of a robot file, as `check` describes them.

use crate::rows::rows;
use crate::text::{short, vector};
use funicular::math::Vec3;
use funicular::robot::{LoadShape, RequiredLoads, RequiredPayload};

rows! {
    /// Loads that the robot has to bear in addition to the dead load, and velocities that its winches have to give.
    /// A load that is not required is absent.
    pub struct CheckedRequired {
        /// `box` or `ellipsoid`: the shape of the set of forces, moments and so on.
        pub shape: &'static str;
        pub force_n: Option<[f64; 3]>;
        pub moment_n_m: Option<[f64; 3]>;
        pub payload_min_kg: Option<f64>;
        pub payload_max_kg: Option<f64>;
        pub payload_center_m: Option<[f64; 3]>;
        pub payload_center_reach_m: Option<[f64; 3]>;
        pub acceleration_m_s2: Option<[f64; 3]>;
        pub angular_acceleration_rad_s2: Option<[f64; 3]>;
        pub wind_speed_m_s: Option<f64>;
        pub velocity_m_s: Option<[f64; 3]>;
        pub angular_velocity_rad_s: Option<[f64; 3]>;
    }
}

impl CheckedRequired {
    /// Row for required loads; `None` if nothing is required but listed loads.
    pub(super) fn of(required: &RequiredLoads) -> Option<Self> {
        let RequiredPayload { min_mass, max_mass, center_p, center_reach_p } = required.payload;
        let given = |of: Vec3| (of != Vec3::zeros()).then(|| of.into());
        let number = |of: f64| (of != 0.0).then_some(of);
        let row = Self {
            shape: match required.shape {
                LoadShape::Box => "box",
                LoadShape::Ellipsoid => "ellipsoid",
            },
            force_n: given(required.force_w),
            moment_n_m: given(required.moment_w),
            payload_min_kg: number(min_mass),
            payload_max_kg: number(max_mass),
            payload_center_m: given(center_p),
            payload_center_reach_m: given(center_reach_p),
            acceleration_m_s2: given(required.acceleration_w),
            angular_acceleration_rad_s2: given(required.angular_acceleration_w),
            wind_speed_m_s: number(required.wind_speed),
            velocity_m_s: given(required.velocity_w),
            angular_velocity_rad_s: given(required.angular_velocity_w),
        };
        (!row.parts().is_empty()).then_some(row)
    }

    /// Requirements, a phrase for each.
    pub fn parts(&self) -> Vec<String> {
        let vectors = [
            ("force", &self.force_n, "N"),
            ("moment", &self.moment_n_m, "N m"),
            ("acceleration", &self.acceleration_m_s2, "m/s²"),
            ("angular acceleration", &self.angular_acceleration_rad_s2, "rad/s²"),
            ("velocity", &self.velocity_m_s, "m/s"),
            ("angular velocity", &self.angular_velocity_rad_s, "rad/s"),
        ];
        let each = |(name, of, unit): &(&str, &Option<[f64; 3]>, &str)| {
            Some(format!("{name} ±({}) {unit}", vector(of.as_ref()?, 4)))
        };
        let mut parts: Vec<String> = vectors.iter().filter_map(each).collect();
        if self.payload_min_kg.is_some() || self.payload_max_kg.is_some() {
            let [least, most] = [self.payload_min_kg, self.payload_max_kg].map(|mass| short(mass.unwrap_or(0.0), 4));
            let at = self.payload_center_m.map_or_else(String::new, |at| format!(" at ({}) m", vector(&at, 4)));
            let reach = self.payload_center_reach_m.map_or_else(String::new, |of| format!(" ±({}) m", vector(&of, 4)));
            parts.push(format!("payload {least} to {most} kg{at}{reach}"));
        }
        if let Some(speed) = self.wind_speed_m_s {
            parts.push(format!("wind {} m/s from any horizontal direction", short(speed, 4)));
        }
        parts
    }
}

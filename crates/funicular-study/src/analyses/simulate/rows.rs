//! Rows of a simulation, and their columns.

use crate::analyses::fields::AXES;
use crate::analyses::shared::MotionRow;
use crate::request::PointValue;
use crate::rows::rows;
use funicular::math::Vec3;
use funicular::robot::Robot;
use funicular::simulation::{CableSample, RobotSample};

rows! {
    /// Robot at one time. Lists have a number per cable.
    pub struct SimulatedRow in tables(names: &RowNames) read back {
        /// Time.
        pub t_s: f64 => one.decimals("t", 3);
        /// Motion of the platform.
        pub motion: MotionRow = spread => columns([5, 3]);
        /// Tension of cable {} at the platform.
        pub tensions_platform_n: Vec<f64> => each(&names.cables, "tension_platform_{}_n").lowest("lowest tension", 4);
        /// Tension of cable {} at the anchor.
        pub tensions_anchor_n: Vec<f64> => each(&names.cables, "tension_anchor_{}_n").largest("largest", 4);
        /// Unstrained length of cable {}.
        pub unstrained_lengths_m: Vec<f64> => each(&names.cables, "unstrained_length_{}_m");
        /// Rate of the unstrained length of cable {}.
        ///
        /// Positive while it is paid out.
        pub length_rates_m_s: Vec<f64> => each(&names.cables, "length_rate_{}_m_s");
        /// Position of a chosen point, {}.
        ///
        /// World frame.
        pub points_m: Vec<[f64; 3]> = sparse => each(names.coordinates(), "point_{}_m");
        /// Velocity of a chosen point, {}.
        ///
        /// World axes.
        pub point_velocities_m_s: Vec<[f64; 3]> = sparse => each(names.coordinates(), "point_velocity_{}_m_s");
        /// Distance of the nearest pair beyond the required one.
        ///
        /// Absent if the robot file says nothing about distances.
        pub clearance_margin_m: Option<f64> => one.decimals("clearance margin", 3).only_if(names.has_distances);
        /// Kinetic energy.
        pub kinetic_energy_j: f64 => one.significant("kinetic energy", 3);
        /// Energy of the stretch of the ropes.
        pub strain_energy_j: f64 => one;
        /// Energy of height.
        pub potential_energy_j: f64 => one;
        /// Work of the winches since the start.
        pub work_of_winches_j: f64 => one;
        /// Work at moving anchors since the start.
        pub work_of_anchors_j: f64 => one;
        /// Work of loads, pushes and wind since the start.
        pub work_of_loads_j: f64 => one;
        /// Energy lost in damping since the start.
        pub dissipated_j: f64 => one;
        /// Energy that payloads brought, less what they took away.
        pub energy_of_payloads_j: f64 => one;
        /// Defect of the energy balance.
        pub energy_defect_j: f64 => one.about("what the books of the energy are off by");
    }
}

/// Names in the columns of the rows, and which columns there are.
#[derive(Debug, Clone)]
pub struct RowNames {
    /// Names of the cables.
    pub cables: Vec<String>,
    /// Names of the chosen points.
    pub points: Vec<String>,
    /// True if the rows have distances.
    pub has_distances: bool,
}

impl RowNames {
    /// Names of the rows of a robot with these points.
    pub fn of(robot: &Robot, points: &[PointValue]) -> Self {
        Self {
            cables: robot.cables.iter().map(|cable| cable.name.clone()).collect(),
            points: points.iter().map(|point| point.name.clone()).collect(),
            has_distances: robot.judges_clearance(),
        }
    }

    /// Names of the coordinates of the chosen points.
    fn coordinates(&self) -> Vec<String> {
        self.points.iter().flat_map(|point| AXES.map(|axis| format!("{point}_{axis}"))).collect()
    }
}

impl SimulatedRow {
    /// Row of a sample, with these points of the platform and this distance.
    pub(super) fn of(sample: &RobotSample, points: &[PointValue], clearance_margin_m: Option<f64>) -> Self {
        let motion = MotionRow::of(&sample.pose, &sample.velocity_w, &sample.acceleration_w);
        let each = |of: fn(&CableSample) -> f64| sample.cables.iter().map(of).collect();
        let energy = &sample.energy;
        let (velocity, omega) = (Vec3::from(motion.velocity_m_s), Vec3::from(motion.angular_velocity_rad_s));
        let levers = || points.iter().map(|point| sample.pose.rot_wp * Vec3::from(point.point_m));
        Self {
            t_s: sample.time,
            motion,
            tensions_platform_n: each(|cable| cable.tension_platform),
            tensions_anchor_n: each(|cable| cable.tension_anchor),
            unstrained_lengths_m: each(|cable| cable.length.value),
            length_rates_m_s: each(|cable| cable.length.rate),
            points_m: levers().map(|lever| (sample.pose.position_w + lever).into()).collect(),
            point_velocities_m_s: levers().map(|lever| (velocity + omega.cross(&lever)).into()).collect(),
            clearance_margin_m,
            kinetic_energy_j: energy.kinetic,
            strain_energy_j: energy.strain,
            potential_energy_j: energy.potential,
            work_of_winches_j: energy.winches,
            work_of_anchors_j: energy.anchors,
            work_of_loads_j: energy.loads,
            dissipated_j: energy.dissipated,
            energy_of_payloads_j: energy.payloads,
            energy_defect_j: energy.defect(),
        }
    }
}

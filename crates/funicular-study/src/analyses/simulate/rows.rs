//! Rows of a simulation, and their columns.

use crate::analyses::fields::{self, AXES};
use crate::analyses::shared::PoseRow;
use crate::columns::{Columns, Field, column, parts};
use crate::request::PointValue;
use funicular::math::{Vec3, Vec6};
use funicular::robot::Robot;
use funicular::simulation::{CableSample, RobotSample};
use serde::Serialize;

/// Robot at one time. Lists have a number per cable.
#[derive(Serialize)]
pub struct SimulatedRow {
    pub t_s: f64,
    #[serde(flatten)]
    pub pose: PoseRow,
    pub velocity_m_s: [f64; 3],
    pub angular_velocity_rad_s: [f64; 3],
    pub acceleration_m_s2: [f64; 3],
    pub angular_acceleration_rad_s2: [f64; 3],
    pub tensions_platform_n: Vec<f64>,
    pub tensions_anchor_n: Vec<f64>,
    pub unstrained_lengths_m: Vec<f64>,
    /// Positive while a cable is paid out.
    pub length_rates_m_s: Vec<f64>,
    /// Positions of the chosen points, world frame.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub points_m: Vec<[f64; 3]>,
    /// Velocities of the chosen points, world axes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub point_velocities_m_s: Vec<[f64; 3]>,
    /// Distance of the nearest pair beyond the required one; absent if the robot file says nothing about distances.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance_margin_m: Option<f64>,
    pub kinetic_energy_j: f64,
    pub strain_energy_j: f64,
    pub potential_energy_j: f64,
    /// Work since the start.
    pub work_of_winches_j: f64,
    pub work_of_loads_j: f64,
    pub dissipated_j: f64,
    /// Energy that payloads brought, less what they took away.
    pub energy_of_payloads_j: f64,
    pub energy_defect_j: f64,
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
}

impl SimulatedRow {
    /// Row of a sample, with these points of the platform and this distance.
    pub(super) fn of(sample: &RobotSample, points: &[PointValue], clearance_margin_m: Option<f64>) -> Self {
        let halves = |of: &Vec6| [[of[0], of[1], of[2]], [of[3], of[4], of[5]]];
        let [velocity_m_s, angular_velocity_rad_s] = halves(&sample.velocity_w);
        let [acceleration_m_s2, angular_acceleration_rad_s2] = halves(&sample.acceleration_w);
        let each = |of: fn(&CableSample) -> f64| sample.cables.iter().map(of).collect();
        let energy = &sample.energy;
        let (velocity, omega) = (Vec3::from(velocity_m_s), Vec3::from(angular_velocity_rad_s));
        let levers = || points.iter().map(|point| sample.pose.rot_wp * Vec3::from(point.point_m));
        Self {
            t_s: sample.time,
            pose: PoseRow::of(&sample.pose),
            velocity_m_s,
            angular_velocity_rad_s,
            acceleration_m_s2,
            angular_acceleration_rad_s2,
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
            work_of_loads_j: energy.loads,
            dissipated_j: energy.dissipated,
            energy_of_payloads_j: energy.payloads,
            energy_defect_j: energy.defect(),
        }
    }

    /// Columns of the rows for cables and points of the platform of these names.
    pub fn columns(names: &RowNames) -> Columns<Self> {
        let RowNames { cables, points, has_distances } = names;
        let names = || cables.clone();
        let of_points: Vec<String> =
            points.iter().flat_map(|point| AXES.map(|axis| format!("{point}_{axis}"))).collect();
        let [position, angles] =
            fields::pose(|row: &Self| Some(row.pose.position_m), |row: &Self| Some(row.pose.roll_pitch_yaw_deg));
        let lowest = |row: &Self| row.tensions_platform_n.iter().copied().fold(f64::INFINITY, f64::min);
        let highest = |row: &Self| row.tensions_anchor_n.iter().copied().fold(0.0, f64::max);
        let motion = [
            column("t_s", "s", "time", |row: &Self| row.t_s).decimals("t", "s", 3),
            position.shown("position", "m", |row, style| style.vector(&row.pose.position_m, 5)),
            angles.shown("roll, pitch, yaw", "°", |row, style| style.vector(&row.pose.roll_pitch_yaw_deg, 3)),
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
            parts("tension_platform_{}_n", names(), "N", "tension of cable {} at the platform", |row: &Self| {
                row.tensions_platform_n.clone()
            })
            .shown("lowest tension", "N", move |row, style| style.significant(lowest(row), 4)),
            parts("tension_anchor_{}_n", names(), "N", "tension of cable {} at the anchor", |row: &Self| {
                row.tensions_anchor_n.clone()
            })
            .shown("largest", "N", move |row, style| style.significant(highest(row), 4)),
            parts("unstrained_length_{}_m", names(), "m", "unstrained length of cable {}", |row: &Self| {
                row.unstrained_lengths_m.clone()
            }),
            parts("length_rate_{}_m_s", names(), "m/s", "rate of the unstrained length of cable {}", |row: &Self| {
                row.length_rates_m_s.clone()
            }),
            parts("point_{}_m", of_points.clone(), "m", "position of a chosen point, {}", |row: &Self| {
                row.points_m.concat()
            }),
            parts("point_velocity_{}_m_s", of_points, "m/s", "velocity of a chosen point, {}", |row: &Self| {
                row.point_velocities_m_s.concat()
            }),
        ];
        let margin =
            column("clearance_margin_m", "m", "distance of the nearest pair beyond the required one", |row: &Self| {
                row.clearance_margin_m
            })
            .decimals("clearance margin", "m", 3)
            .only_if(*has_distances);
        Columns::new(motion.into_iter().chain([margin]).chain(Self::energies()))
    }

    /// Columns of the energies and works.
    fn energies() -> Vec<Field<Self>> {
        vec![
            column("kinetic_energy_j", "J", "kinetic energy", |row: &Self| row.kinetic_energy_j).significant(
                "kinetic energy",
                "J",
                3,
            ),
            column("strain_energy_j", "J", "energy of the stretch of the ropes", |row: &Self| row.strain_energy_j),
            column("potential_energy_j", "J", "energy of height", |row: &Self| row.potential_energy_j),
            column("work_of_winches_j", "J", "work of the winches since the start", |row: &Self| row.work_of_winches_j),
            column("work_of_loads_j", "J", "work of loads, pushes and wind since the start", |row: &Self| {
                row.work_of_loads_j
            }),
            column("dissipated_j", "J", "energy lost in damping since the start", |row: &Self| row.dissipated_j),
            column(
                "energy_of_payloads_j",
                "J",
                "energy that payloads brought, less what they took away",
                |row: &Self| row.energy_of_payloads_j,
            ),
            column("energy_defect_j", "J", "what the books of the energy are off by", |row: &Self| row.energy_defect_j),
        ]
    }
}

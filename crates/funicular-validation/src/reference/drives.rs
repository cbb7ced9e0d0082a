//! Contents of drives.json.

use super::ReferenceTable;
use anyhow::{Context, Result};
use serde::Deserialize;

/// Reads drives.json.
pub(crate) fn drives() -> Result<Drives> {
    serde_json::from_str(include_str!("../../reference/drives.json")).context("drives.json")
}

/// Content of drives.json.
#[derive(Deserialize)]
pub(crate) struct Drives {
    pub(crate) straight: ReferenceTable<StraightOverPulley>,
    pub(crate) sagging: ReferenceTable<SaggingOverPulley>,
    pub(crate) cables: ReferenceTable<CableToWinch>,
    pub(crate) robots: ReferenceTable<RobotWithWinches>,
    pub(crate) vibration: ReferenceTable<DrivenRobot>,
    pub(crate) moving_cables: ReferenceTable<DrivenCable>,
    pub(crate) friction_corners: ReferenceTable<FrictionCorner>,
    pub(crate) friction_half_widths: ReferenceTable<FrictionHalfWidths>,
}

/// Straight cable without mass over a pulley.
#[derive(Deserialize)]
pub(crate) struct StraightOverPulley {
    pub(crate) case: String,
    pub(crate) radius_m: f64,
    pub(crate) entry_direction: [f64; 3],
    pub(crate) entry_point_m: [f64; 3],
    pub(crate) platform_point_m: [f64; 3],
    pub(crate) wrap_rad: f64,
    pub(crate) exit_point_m: [f64; 3],
    pub(crate) length_m: f64,
    /// Size of the last printed digit.
    pub(crate) printed_digits: f64,
}

/// Sagging cable over a pulley at the origin, in the plane of x and z.
#[derive(Deserialize)]
pub(crate) struct SaggingOverPulley {
    pub(crate) case: String,
    pub(crate) platform_point_along_up_m: [f64; 2],
    pub(crate) radius_m: f64,
    pub(crate) weight_n_per_m: f64,
    pub(crate) axial_stiffness_n: f64,
    pub(crate) unstrained_length_m: f64,
    pub(crate) force_at_platform_along_up_n: [f64; 2],
    pub(crate) tension_platform_n: f64,
    pub(crate) tension_exit_n: f64,
    pub(crate) tension_drum_n: f64,
    pub(crate) wrap_rad: f64,
    pub(crate) exit_point_along_up_m: [f64; 2],
    pub(crate) free_length_m: f64,
    /// Entries xx, xz, zz and yy.
    pub(crate) stiffness_n_per_m: [f64; 4],
}

/// Cable over a pulley to a winch.
#[derive(Deserialize)]
pub(crate) struct CableToWinch {
    pub(crate) case: String,
    pub(crate) entry_point_m: [f64; 3],
    pub(crate) entry_direction: [f64; 3],
    pub(crate) radius_m: f64,
    pub(crate) drum_side_length_m: f64,
    pub(crate) winch_stiffness_n_per_m: Option<f64>,
    pub(crate) axial_stiffness_n: f64,
    pub(crate) mass_kg_per_m: f64,
    pub(crate) unstrained_length_m: f64,
    pub(crate) platform_point_m: [f64; 3],
    pub(crate) tension_exit_n: f64,
    pub(crate) tension_drum_n: f64,
    pub(crate) wrap_rad: f64,
    pub(crate) exit_point_m: [f64; 3],
    pub(crate) kink_rad: f64,
    /// Unstrained lengths of free span, arc and drum side.
    pub(crate) lengths_m: [f64; 3],
    pub(crate) force_on_platform_n: [f64; 3],
    pub(crate) stiffness_n_per_m: [[f64; 3]; 3],
    pub(crate) force_per_unstrained_length_n_per_m: [f64; 3],
    pub(crate) energy_j: f64,
}

/// Inertia and control of a drive; masses and gains at the cable.
#[derive(Deserialize)]
pub(crate) struct DriveParts {
    pub(crate) wheel_inertia_kg_m2: f64,
    pub(crate) swivel_inertia_kg_m2: f64,
    pub(crate) drum_mass_kg: f64,
    pub(crate) motor_mass_kg: f64,
    /// `ideal`, `position` or `torque`.
    pub(crate) control: String,
    pub(crate) position_gain_n_per_m: f64,
    pub(crate) speed_gain_n_s_per_m: f64,
    pub(crate) cable_damping_ratio: f64,
}

/// Vibration of a robot whose drives have inertia and control.
#[derive(Deserialize)]
pub(crate) struct DrivenRobot {
    /// Case of the robot.
    pub(crate) case: String,
    #[serde(flatten)]
    pub(crate) parts: DriveParts,
    /// All undamped natural frequencies up to the last.
    pub(crate) frequencies_hz: Vec<f64>,
    /// Motion of the platform per commanded length, or per force of a motor: (6, cables).
    pub(crate) responses: Vec<DriveResponse>,
    /// Motion of the platform per motion of the base, anchors and drums, in six directions: (6, 6).
    pub(crate) base: Vec<DriveResponse>,
    /// Damped modes with the damping of the servos alone.
    #[serde(default)]
    pub(crate) servo_damped: Option<ServoDamped>,
}

/// Complex 6×m matrix at a frequency.
#[derive(Deserialize)]
pub(crate) struct DriveResponse {
    pub(crate) frequency_hz: f64,
    pub(crate) re: Vec<Vec<f64>>,
    pub(crate) im: Vec<Vec<f64>>,
}

/// Damped modes whose undamped partners lie below a limit.
#[derive(Deserialize)]
pub(crate) struct ServoDamped {
    pub(crate) below_hz: f64,
    /// |ω|/2π.
    pub(crate) frequency_hz: Vec<f64>,
    pub(crate) damping_ratio: Vec<f64>,
}

/// Cable over a pulley to a winch with inertia, its platform end at a point.
#[derive(Deserialize)]
pub(crate) struct DrivenCable {
    /// Case of the cable at rest.
    pub(crate) case: String,
    #[serde(flatten)]
    pub(crate) parts: DriveParts,
    /// `massless` or `rod`.
    pub(crate) drum_side: String,
    /// All natural frequencies with the platform end held, up to the last.
    pub(crate) clamped_frequencies_hz: Vec<f64>,
    pub(crate) dynamic: Vec<DrivenCableAt>,
}

/// Dynamic stiffness of the platform end and force per commanded length at a frequency, world axes.
#[derive(Deserialize)]
pub(crate) struct DrivenCableAt {
    pub(crate) frequency_hz: f64,
    pub(crate) stiffness_re: [[f64; 3]; 3],
    pub(crate) stiffness_im: [[f64; 3]; 3],
    pub(crate) length_re: [f64; 3],
    pub(crate) length_im: [f64; 3],
    /// Force on the platform end per motion of the anchor, its drum fixed: (3, 3).
    pub(crate) anchor_re: [[f64; 3]; 3],
    pub(crate) anchor_im: [[f64; 3]; 3],
    /// Force on the platform end per motion of anchor and drum: (3, 3). `None` where the source leaves out the inertia
    /// of the drum side that moves along.
    #[serde(default)]
    pub(crate) base_re: Option<[[f64; 3]; 3]>,
    #[serde(default)]
    pub(crate) base_im: Option<[[f64; 3]; 3]>,
}

/// Robot whose cables run over equal pulleys to equal winches.
#[derive(Deserialize)]
pub(crate) struct RobotWithWinches {
    pub(crate) case: String,
    pub(crate) mass_kg: f64,
    pub(crate) center_of_mass_m: [f64; 3],
    pub(crate) inertia_kg_m2: [[f64; 3]; 3],
    pub(crate) axial_stiffness_n: f64,
    pub(crate) mass_kg_per_m: f64,
    pub(crate) radius_m: f64,
    pub(crate) drum_side_length_m: f64,
    pub(crate) winch_stiffness_n_per_m: Option<f64>,
    pub(crate) anchors_m: Vec<[f64; 3]>,
    pub(crate) attachments_m: Vec<[f64; 3]>,
    pub(crate) unstrained_lengths_m: Vec<f64>,
    pub(crate) position_m: [f64; 3],
    pub(crate) roll_pitch_yaw_deg: [f64; 3],
    pub(crate) tension_exit_n: Vec<f64>,
    pub(crate) tension_drum_n: Vec<f64>,
    pub(crate) stiffness_6x6: [[f64; 6]; 6],
}

/// Equilibrium with friction after given last motions of the cables.
#[derive(Deserialize)]
pub(crate) struct FrictionCorner {
    pub(crate) case: String,
    /// Case of the robot.
    pub(crate) robot: String,
    pub(crate) friction_coefficient: f64,
    /// True per cable that last ran towards the platform, false per cable that last ran towards its drum.
    pub(crate) last_towards_platform: Vec<bool>,
    pub(crate) position_m: [f64; 3],
    /// Rows of the rotation matrix.
    pub(crate) rotation: [[f64; 3]; 3],
    pub(crate) tension_exit_n: Vec<f64>,
    pub(crate) tension_drum_n: Vec<f64>,
}

/// Half widths of the interval in which friction leaves a robot, to first order in the friction.
#[derive(Deserialize)]
pub(crate) struct FrictionHalfWidths {
    pub(crate) case: String,
    /// Case of the robot.
    pub(crate) robot: String,
    pub(crate) friction_coefficient: f64,
    pub(crate) translation_m: [f64; 3],
    pub(crate) rotation_rad: [f64; 3],
}

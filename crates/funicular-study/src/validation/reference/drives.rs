//! Contents of drives.json.

use super::ReferenceTable;
use anyhow::{Context, Result};
use serde::Deserialize;

/// Reads drives.json.
pub(in crate::validation) fn drives() -> Result<Drives> {
    serde_json::from_str(include_str!("../../../reference/drives.json")).context("drives.json")
}

/// Content of drives.json.
#[derive(Deserialize)]
pub(in crate::validation) struct Drives {
    pub(in crate::validation) straight: ReferenceTable<StraightOverPulley>,
    pub(in crate::validation) sagging: ReferenceTable<SaggingOverPulley>,
    pub(in crate::validation) cables: ReferenceTable<CableToWinch>,
    pub(in crate::validation) robots: ReferenceTable<RobotWithWinches>,
    pub(in crate::validation) vibration: ReferenceTable<DrivenRobot>,
    pub(in crate::validation) moving_cables: ReferenceTable<DrivenCable>,
    pub(in crate::validation) friction_corners: ReferenceTable<FrictionCorner>,
    pub(in crate::validation) friction_half_widths: ReferenceTable<FrictionHalfWidths>,
}

/// Straight cable without mass over a pulley.
#[derive(Deserialize)]
pub(in crate::validation) struct StraightOverPulley {
    pub(in crate::validation) case: String,
    pub(in crate::validation) radius_m: f64,
    pub(in crate::validation) entry_direction: [f64; 3],
    pub(in crate::validation) entry_point_m: [f64; 3],
    pub(in crate::validation) platform_point_m: [f64; 3],
    pub(in crate::validation) wrap_rad: f64,
    pub(in crate::validation) exit_point_m: [f64; 3],
    pub(in crate::validation) length_m: f64,
    /// Size of the last printed digit.
    pub(in crate::validation) printed_digits: f64,
}

/// Sagging cable over a pulley at the origin, in the plane of x and z.
#[derive(Deserialize)]
pub(in crate::validation) struct SaggingOverPulley {
    pub(in crate::validation) case: String,
    pub(in crate::validation) platform_point_along_up_m: [f64; 2],
    pub(in crate::validation) radius_m: f64,
    pub(in crate::validation) weight_n_per_m: f64,
    pub(in crate::validation) axial_stiffness_n: f64,
    pub(in crate::validation) unstrained_length_m: f64,
    pub(in crate::validation) force_at_platform_along_up_n: [f64; 2],
    pub(in crate::validation) tension_platform_n: f64,
    pub(in crate::validation) tension_exit_n: f64,
    pub(in crate::validation) tension_drum_n: f64,
    pub(in crate::validation) wrap_rad: f64,
    pub(in crate::validation) exit_point_along_up_m: [f64; 2],
    pub(in crate::validation) free_length_m: f64,
    /// Entries xx, xz, zz and yy.
    pub(in crate::validation) stiffness_n_per_m: [f64; 4],
}

/// Cable over a pulley to a winch.
#[derive(Deserialize)]
pub(in crate::validation) struct CableToWinch {
    pub(in crate::validation) case: String,
    pub(in crate::validation) entry_point_m: [f64; 3],
    pub(in crate::validation) entry_direction: [f64; 3],
    pub(in crate::validation) radius_m: f64,
    pub(in crate::validation) drum_side_length_m: f64,
    pub(in crate::validation) winch_stiffness_n_per_m: Option<f64>,
    pub(in crate::validation) axial_stiffness_n: f64,
    pub(in crate::validation) mass_kg_per_m: f64,
    pub(in crate::validation) unstrained_length_m: f64,
    pub(in crate::validation) platform_point_m: [f64; 3],
    pub(in crate::validation) tension_exit_n: f64,
    pub(in crate::validation) tension_drum_n: f64,
    pub(in crate::validation) wrap_rad: f64,
    pub(in crate::validation) exit_point_m: [f64; 3],
    pub(in crate::validation) kink_rad: f64,
    /// Unstrained lengths of free span, arc and drum side.
    pub(in crate::validation) lengths_m: [f64; 3],
    pub(in crate::validation) force_on_platform_n: [f64; 3],
    pub(in crate::validation) stiffness_n_per_m: [[f64; 3]; 3],
    pub(in crate::validation) force_per_unstrained_length_n_per_m: [f64; 3],
    pub(in crate::validation) energy_j: f64,
}

/// Inertia and control of a drive; masses and gains at the cable.
#[derive(Deserialize)]
pub(in crate::validation) struct DriveParts {
    pub(in crate::validation) wheel_inertia_kg_m2: f64,
    pub(in crate::validation) swivel_inertia_kg_m2: f64,
    pub(in crate::validation) drum_mass_kg: f64,
    pub(in crate::validation) motor_mass_kg: f64,
    /// `ideal`, `position` or `torque`.
    pub(in crate::validation) control: String,
    pub(in crate::validation) position_gain_n_per_m: f64,
    pub(in crate::validation) speed_gain_n_s_per_m: f64,
    pub(in crate::validation) cable_damping_ratio: f64,
}

/// Vibration of a robot whose drives have inertia and control.
#[derive(Deserialize)]
pub(in crate::validation) struct DrivenRobot {
    /// Case of the robot.
    pub(in crate::validation) case: String,
    #[serde(flatten)]
    pub(in crate::validation) parts: DriveParts,
    /// All undamped natural frequencies up to the last.
    pub(in crate::validation) frequencies_hz: Vec<f64>,
    /// Motion of the platform per commanded length, or per force of a motor: (6, cables).
    pub(in crate::validation) responses: Vec<DriveResponse>,
    /// Motion of the platform per motion of the base, anchors and drums, in six directions: (6, 6).
    pub(in crate::validation) base: Vec<DriveResponse>,
    /// Damped modes with the damping of the servos alone.
    #[serde(default)]
    pub(in crate::validation) servo_damped: Option<ServoDamped>,
}

/// Complex 6×m matrix at a frequency.
#[derive(Deserialize)]
pub(in crate::validation) struct DriveResponse {
    pub(in crate::validation) frequency_hz: f64,
    pub(in crate::validation) re: Vec<Vec<f64>>,
    pub(in crate::validation) im: Vec<Vec<f64>>,
}

/// Damped modes whose undamped partners lie below a limit.
#[derive(Deserialize)]
pub(in crate::validation) struct ServoDamped {
    pub(in crate::validation) below_hz: f64,
    /// |ω|/2π.
    pub(in crate::validation) frequency_hz: Vec<f64>,
    pub(in crate::validation) damping_ratio: Vec<f64>,
}

/// Cable over a pulley to a winch with inertia, its platform end at a point.
#[derive(Deserialize)]
pub(in crate::validation) struct DrivenCable {
    /// Case of the cable at rest.
    pub(in crate::validation) case: String,
    #[serde(flatten)]
    pub(in crate::validation) parts: DriveParts,
    /// `massless` or `rod`.
    pub(in crate::validation) drum_side: String,
    /// All natural frequencies with the platform end held, up to the last.
    pub(in crate::validation) clamped_frequencies_hz: Vec<f64>,
    pub(in crate::validation) dynamic: Vec<DrivenCableAt>,
}

/// Dynamic stiffness of the platform end and force per commanded length at a frequency, world axes.
#[derive(Deserialize)]
pub(in crate::validation) struct DrivenCableAt {
    pub(in crate::validation) frequency_hz: f64,
    pub(in crate::validation) stiffness_re: [[f64; 3]; 3],
    pub(in crate::validation) stiffness_im: [[f64; 3]; 3],
    pub(in crate::validation) length_re: [f64; 3],
    pub(in crate::validation) length_im: [f64; 3],
    /// Force on the platform end per motion of the anchor, its drum fixed: (3, 3).
    pub(in crate::validation) anchor_re: [[f64; 3]; 3],
    pub(in crate::validation) anchor_im: [[f64; 3]; 3],
    /// Force on the platform end per motion of anchor and drum: (3, 3). `None` where the source leaves out the inertia
    /// of the drum side that moves along.
    #[serde(default)]
    pub(in crate::validation) base_re: Option<[[f64; 3]; 3]>,
    #[serde(default)]
    pub(in crate::validation) base_im: Option<[[f64; 3]; 3]>,
}

/// Robot whose cables run over equal pulleys to equal winches.
#[derive(Deserialize)]
pub(in crate::validation) struct RobotWithWinches {
    pub(in crate::validation) case: String,
    pub(in crate::validation) mass_kg: f64,
    pub(in crate::validation) center_of_mass_m: [f64; 3],
    pub(in crate::validation) inertia_kg_m2: [[f64; 3]; 3],
    pub(in crate::validation) axial_stiffness_n: f64,
    pub(in crate::validation) mass_kg_per_m: f64,
    pub(in crate::validation) radius_m: f64,
    pub(in crate::validation) drum_side_length_m: f64,
    pub(in crate::validation) winch_stiffness_n_per_m: Option<f64>,
    pub(in crate::validation) anchors_m: Vec<[f64; 3]>,
    pub(in crate::validation) attachments_m: Vec<[f64; 3]>,
    pub(in crate::validation) unstrained_lengths_m: Vec<f64>,
    pub(in crate::validation) position_m: [f64; 3],
    pub(in crate::validation) roll_pitch_yaw_deg: [f64; 3],
    pub(in crate::validation) tension_exit_n: Vec<f64>,
    pub(in crate::validation) tension_drum_n: Vec<f64>,
    pub(in crate::validation) stiffness_6x6: [[f64; 6]; 6],
}

/// Equilibrium with friction after given last motions of the cables.
#[derive(Deserialize)]
pub(in crate::validation) struct FrictionCorner {
    pub(in crate::validation) case: String,
    /// Case of the robot.
    pub(in crate::validation) robot: String,
    pub(in crate::validation) friction_coefficient: f64,
    /// True per cable that last ran towards the platform, false per cable that last ran towards its drum.
    pub(in crate::validation) last_towards_platform: Vec<bool>,
    pub(in crate::validation) position_m: [f64; 3],
    /// Rows of the rotation matrix.
    pub(in crate::validation) rotation: [[f64; 3]; 3],
    pub(in crate::validation) tension_exit_n: Vec<f64>,
    pub(in crate::validation) tension_drum_n: Vec<f64>,
}

/// Half widths of the interval in which friction leaves a robot, to first order in the friction.
#[derive(Deserialize)]
pub(in crate::validation) struct FrictionHalfWidths {
    pub(in crate::validation) case: String,
    /// Case of the robot.
    pub(in crate::validation) robot: String,
    pub(in crate::validation) friction_coefficient: f64,
    pub(in crate::validation) translation_m: [f64; 3],
    pub(in crate::validation) rotation_rad: [f64; 3],
}

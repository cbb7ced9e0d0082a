//! Contents of the files in crates/funicular-study/reference.

use anyhow::{Context, Result, anyhow};
use funicular::robot::{Robot, State};
use serde::Deserialize;
use std::collections::BTreeMap;

/// Table of a reference file: a source and rows.
#[derive(Deserialize)]
pub(super) struct ReferenceTable<R> {
    pub(super) source: String,
    pub(super) rows: Vec<R>,
}

/// Content of published.json.
#[derive(Deserialize)]
pub(super) struct Published {
    pub(super) catenary_grid: ReferenceTable<GridCable>,
    pub(super) catenary_moorpy: ReferenceTable<MoorpyCable>,
    pub(super) hanging_lines: ReferenceTable<HangingLine>,
    pub(super) isolated_cable: IsolatedCable,
    pub(super) irvine_caughey: ReferenceTable<Roots>,
    pub(super) fig2_cable: Fig2,
    pub(super) fig2_closed_form: ReferenceTable<ClosedFormRow>,
    pub(super) fig2_finite_elements: ReferenceTable<FiniteElementRow>,
    pub(super) bessel_cable: Bessel,
    pub(super) paper_robot_equilibria: ReferenceTable<PaperEquilibrium>,
    pub(super) paper_robot_ideal_poses: ReferenceTable<IdealPose>,
    pub(super) cube_point_mass: Cube,
}

/// Input of the catenary.
#[derive(Deserialize)]
pub(super) struct HungBetween {
    pub(super) span_m: f64,
    pub(super) rise_m: f64,
    pub(super) unstrained_length_m: f64,
    pub(super) axial_stiffness_n: f64,
    pub(super) weight_n_per_m: f64,
}

#[derive(Deserialize)]
pub(super) struct GridCable {
    #[serde(flatten)]
    pub(super) hung: HungBetween,
    pub(super) horizontal_force_n: f64,
    pub(super) vertical_force_at_end_n: f64,
    pub(super) end_stiffness_xx_xz_zz_n_per_m: [f64; 3],
}

#[derive(Deserialize)]
pub(super) struct MoorpyCable {
    #[serde(flatten)]
    pub(super) hung: HungBetween,
    pub(super) horizontal_force_n: f64,
    pub(super) vertical_force_at_start_n: f64,
    pub(super) vertical_force_at_end_n: f64,
}

#[derive(Deserialize)]
pub(super) struct HangingLine {
    pub(super) case: String,
    pub(super) source: String,
    #[serde(flatten)]
    pub(super) hung: HungBetween,
    pub(super) horizontal_force_n: Option<f64>,
    pub(super) sag_at_mid_m: Option<f64>,
    pub(super) horizontal_force_kn: Option<f64>,
    pub(super) tension_at_end_kn: Option<f64>,
    pub(super) tension_at_start_kn: Option<f64>,
}

#[derive(Deserialize)]
pub(super) struct IsolatedCable {
    pub(super) source: String,
    pub(super) metres_per_foot: f64,
    pub(super) youngs_modulus_kip_per_in2: f64,
    pub(super) area_in2: f64,
    pub(super) weight_kip_per_ft: f64,
    pub(super) span_ft: f64,
    pub(super) unstrained_lengths_ft: [f64; 2],
    pub(super) load_kip: f64,
    pub(super) node_at_rest_ft: [f64; 2],
    pub(super) displacement_under_load_m: [f64; 2],
    pub(super) published_displacement_m: [f64; 2],
}

#[derive(Deserialize)]
pub(super) struct Roots {
    /// λ²; `None` for the inextensible cable.
    pub(super) lambda2: Option<f64>,
    pub(super) roots: [f64; 4],
}

#[derive(Deserialize)]
pub(super) struct Fig2 {
    pub(super) source: String,
    pub(super) chord_m: f64,
    pub(super) inclination_deg: f64,
    pub(super) tension_n: f64,
    pub(super) youngs_modulus_pa: f64,
    pub(super) area_m2: f64,
    pub(super) mass_kg_per_m: f64,
    pub(super) gravity_m_s2: f64,
    pub(super) published: Fig2Printed,
    pub(super) from_table_ii: Fig2Defined,
    pub(super) mass_of_published_lambda2_kg_per_m: f64,
}

#[derive(Deserialize)]
pub(super) struct Fig2Printed {
    pub(super) lambda2: f64,
    pub(super) epsilon: f64,
    pub(super) effective_length_over_chord: f64,
}

#[derive(Deserialize)]
pub(super) struct Fig2Defined {
    pub(super) source: String,
    pub(super) lambda2: f64,
    pub(super) epsilon: f64,
}

#[derive(Deserialize)]
pub(super) struct ClosedFormRow {
    pub(super) frequency_hz: f64,
    pub(super) damping_ratio: f64,
    pub(super) axial_n_per_m: [f64; 2],
    pub(super) coupling_n_per_m: [f64; 2],
    pub(super) normal_n_per_m: [f64; 2],
    pub(super) out_of_plane_n_per_m: [f64; 2],
}

#[derive(Deserialize)]
pub(super) struct FiniteElementRow {
    pub(super) frequency_hz: f64,
    pub(super) upper_end_moves: bool,
    pub(super) stiffness_xx_xz_zz_yy_n_per_m: [f64; 4],
}

#[derive(Deserialize)]
pub(super) struct Bessel {
    pub(super) source: String,
    pub(super) length_m: f64,
    pub(super) mass_kg_per_m: f64,
    pub(super) gravity_m_s2: f64,
    pub(super) rows: Vec<BesselRow>,
}

#[derive(Deserialize)]
pub(super) struct BesselRow {
    pub(super) lower_tension_n: f64,
    pub(super) clamped_rad_per_s: [f64; 3],
    pub(super) stiffness_at_rest_n_per_m: f64,
    pub(super) stiffness_at_1_rad_per_s_n_per_m: f64,
}

#[derive(Deserialize)]
pub(super) struct PaperEquilibrium {
    pub(super) robot: String,
    pub(super) mass_kg: f64,
    pub(super) position_m: [f64; 3],
    pub(super) tension_platform_n: [f64; 6],
}

#[derive(Deserialize)]
pub(super) struct IdealPose {
    pub(super) robot: String,
    pub(super) position_m: [f64; 3],
    pub(super) rotation_vector_deg: [f64; 3],
}

#[derive(Deserialize)]
pub(super) struct Cube {
    pub(super) source: String,
    pub(super) position_m: [f64; 3],
    pub(super) longest_cable_m: f64,
    pub(super) mass_kg_per_m: f64,
    pub(super) axial_stiffness_n: f64,
    pub(super) limit_hz: f64,
    pub(super) rows: Vec<CubeRow>,
}

#[derive(Deserialize)]
pub(super) struct CubeRow {
    pub(super) model: String,
    pub(super) unstrained_length_m: [f64; 8],
    pub(super) frequencies_hz: Vec<f64>,
}

/// Content of independent.json.
#[derive(Deserialize)]
pub(super) struct IndependentReference {
    #[serde(rename = "_about")]
    pub(super) about: String,
    pub(super) cases: Vec<IndependentRobot>,
}

pub(super) type Matrix = [[f64; 6]; 6];

#[derive(Deserialize)]
pub(super) struct IndependentRobot {
    pub(super) id: String,
    pub(super) toml: String,
    pub(super) equilibrium: Equilibrium,
    pub(super) spring: SpringEquilibrium,
    pub(super) static_tangent_consistent: Matrix,
    pub(super) static_tangent_paper: Matrix,
    pub(super) closed_form_at_hz: f64,
    pub(super) closed_form_consistent_undamped: Matrix,
    pub(super) closed_form_paper_undamped: Matrix,
    pub(super) closed_form_consistent_in_plane_only_undamped: Matrix,
    pub(super) closed_form_consistent_damped: ComplexMatrix,
    pub(super) modes: ModeList,
    pub(super) modes_in_plane_only: ModeList,
    pub(super) frf: ReferenceFrf,
    pub(super) frf_offset: ReferenceFrfOffset,
}

#[derive(Deserialize)]
pub(super) struct Equilibrium {
    pub(super) position_m: [f64; 3],
    pub(super) quaternion_wxyz: [f64; 4],
    pub(super) cables: Vec<ReferenceCable>,
}

#[derive(Deserialize)]
pub(super) struct ReferenceCable {
    pub(super) tension_platform_n: f64,
    pub(super) tension_anchor_n: f64,
    pub(super) chord_m: f64,
    pub(super) sag_ratio: f64,
    pub(super) lambda2: f64,
    pub(super) force_on_platform_n: [f64; 3],
}

#[derive(Deserialize)]
pub(super) struct SpringEquilibrium {
    pub(super) position_m: [f64; 3],
    pub(super) tension_n: Vec<f64>,
}

#[derive(Deserialize)]
pub(super) struct ComplexMatrix {
    pub(super) real: Matrix,
    pub(super) imag: Matrix,
}

#[derive(Deserialize)]
pub(super) struct ModeList {
    pub(super) below_hz: f64,
    pub(super) frequencies_hz: Vec<f64>,
    /// Frequencies of modes with the platform at rest, and the number of such modes at each.
    pub(super) platform_at_rest: Vec<(f64, f64)>,
}

#[derive(Deserialize)]
pub(super) struct ReferenceResponse {
    pub(super) real: Vec<f64>,
    pub(super) imag: Vec<f64>,
}

#[derive(Deserialize)]
pub(super) struct ReferenceFrf {
    pub(super) frequency_hz: Vec<f64>,
    pub(super) ay: ReferenceResponse,
    pub(super) az: ReferenceResponse,
}

#[derive(Deserialize)]
pub(super) struct ReferenceFrfOffset {
    pub(super) frequency_hz: Vec<f64>,
    pub(super) input_direction_w: [f64; 3],
    pub(super) input_point_p: [f64; 3],
    pub(super) output_direction_w: [f64; 3],
    pub(super) output_point_p: [f64; 3],
    #[serde(flatten)]
    pub(super) response: ReferenceResponse,
}

/// Content of exact.json.
#[derive(Deserialize)]
pub(super) struct ExactReference {
    #[serde(rename = "_about")]
    pub(super) about: String,
    pub(super) cables: Vec<ExactCable>,
    pub(super) robots: Vec<ExactRobot>,
}

#[derive(Deserialize)]
pub(super) struct ExactCable {
    pub(super) id: String,
    pub(super) start_m: [f64; 3],
    pub(super) end_m: [f64; 3],
    pub(super) unstrained_length_m: f64,
    pub(super) axial_stiffness_n: f64,
    pub(super) mass_kg_per_m: f64,
    pub(super) gravity_m_s2: [f64; 3],
    pub(super) clamped_in_plane_hz: Vec<f64>,
    pub(super) clamped_out_of_plane_hz: Vec<f64>,
    pub(super) end_stiffness: ExactStiffness,
}

#[derive(Deserialize)]
pub(super) struct ExactStiffness {
    pub(super) frequency_hz: Vec<f64>,
    /// Stiffness of both ends, start first.
    pub(super) undamped: Vec<Matrix>,
    /// Constant damping ratio of `xi_real` and `xi_imag`.
    pub(super) xi: f64,
    pub(super) xi_real: Vec<Matrix>,
    pub(super) xi_imag: Vec<Matrix>,
    /// Viscous damping of `viscous_real` and `viscous_imag`.
    pub(super) viscous_n_s_m2: f64,
    pub(super) viscous_real: Vec<Matrix>,
    pub(super) viscous_imag: Vec<Matrix>,
}

/// Robot of independent.json.
#[derive(Deserialize)]
pub(super) struct ExactRobot {
    pub(super) id: String,
    pub(super) below_hz: f64,
    pub(super) frequencies_hz: Vec<f64>,
    pub(super) frf: ExactFrf,
}

#[derive(Deserialize)]
pub(super) struct ExactFrf {
    pub(super) frequency_hz: Vec<f64>,
    #[serde(flatten)]
    pub(super) response: ReferenceResponse,
}

/// Content of damped.json.
#[derive(Deserialize)]
pub(super) struct Damped {
    #[serde(rename = "_about")]
    pub(super) about: String,
    #[serde(rename = "damped_modes")]
    pub(super) robots: Vec<DampedRobot>,
    pub(super) point_frf: Vec<PointRobot>,
    pub(super) shapes: Vec<ShapesOfRobot>,
}

/// Robot of independent.json with other damping.
#[derive(Deserialize)]
pub(super) struct DampedRobot {
    pub(super) case: String,
    pub(super) robot: String,
    pub(super) cable_damping: BTreeMap<String, RopeDamping>,
    pub(super) platform_damping: Option<PlatformDamping>,
    pub(super) below_hz: f64,
    pub(super) modes: Vec<DampedFrequency>,
}

#[derive(Deserialize)]
#[serde(untagged)]
pub(super) enum RopeDamping {
    Ratio { damping_ratio: f64 },
    Viscous { viscous_damping_n_s_m2: f64 },
}

#[derive(Deserialize)]
pub(super) struct PlatformDamping {
    pub(super) translation_n_s_m: [f64; 3],
    pub(super) rotation_n_m_s_rad: [f64; 3],
}

#[derive(Deserialize)]
pub(super) struct DampedFrequency {
    pub(super) re_hz: f64,
    pub(super) im_hz: f64,
}

/// Responses between points of cables and platform.
#[derive(Deserialize)]
pub(super) struct PointRobot {
    pub(super) robot: String,
    pub(super) frequency_hz: Vec<f64>,
    pub(super) pairs: Vec<PointPair>,
}

#[derive(Deserialize)]
pub(super) struct PointPair {
    pub(super) force: ReferencePoint,
    pub(super) displacement: ReferencePoint,
    #[serde(flatten)]
    pub(super) response: ReferenceResponse,
}

/// Point on a cable, or the origin of the platform.
#[derive(Deserialize)]
pub(super) struct ReferencePoint {
    pub(super) cable: Option<String>,
    #[serde(default)]
    pub(super) fraction: f64,
    pub(super) direction_world: [f64; 3],
}

/// Some undamped modes of a robot of independent.json.
#[derive(Deserialize)]
pub(super) struct ShapesOfRobot {
    pub(super) robot: String,
    pub(super) below_hz: f64,
    /// Fractions of the cables' lengths from the platform.
    pub(super) fractions: Vec<f64>,
    pub(super) modes: Vec<ModeShape>,
}

#[derive(Deserialize)]
pub(super) struct ModeShape {
    /// Index in the list of modes, from 0.
    pub(super) index: usize,
    pub(super) frequency_hz: f64,
    pub(super) relative_gap_to_neighbour: f64,
    pub(super) platform_at_rest: bool,
    /// Modal mass; `None` if the platform is at rest, because the shape then has no amplitude of the platform as its
    /// scale.
    pub(super) modal_mass_kg: Option<f64>,
    /// Fractions of the platform and of every cable by its name.
    pub(super) kinetic_energy_fraction: BTreeMap<String, f64>,
    /// World components at each of the `fractions`, for unit modal mass.
    pub(super) cable_displacement_m: BTreeMap<String, Vec<[f64; 3]>>,
}

pub(super) fn damped() -> Result<Damped> {
    serde_json::from_str(include_str!("../../reference/damped.json")).context("damped.json")
}

pub(super) fn published() -> Result<Published> {
    serde_json::from_str(include_str!("../../reference/published.json")).context("published.json")
}

pub(super) fn independent() -> Result<IndependentReference> {
    serde_json::from_str(include_str!("../../reference/independent.json")).context("independent.json")
}

pub(super) fn exact() -> Result<ExactReference> {
    serde_json::from_str(include_str!("../../reference/exact.json")).context("exact.json")
}

/// Reads a robot and its unstrained lengths.
pub(super) fn robot(text: &str) -> Result<(Robot, Vec<f64>)> {
    let robot = Robot::from_toml(text)?;
    match robot.state.clone() {
        State::Lengths(lengths) => Ok((robot, lengths)),
        State::Pose(_) | State::Unknown => Err(anyhow!("{} gives no unstrained lengths", robot.name)),
    }
}

/// Reads a robot of the library by the name of its file.
pub(super) fn library(name: &str) -> Result<(Robot, Vec<f64>)> {
    robot(match name {
        "yuan2014-4mm" => funicular_robots::YUAN2014_4MM,
        "yuan2014-8mm" => funicular_robots::YUAN2014_8MM,
        "sap2000-8-cable-point-mass" => funicular_robots::SAP2000_8_CABLE_POINT_MASS,
        other => return Err(anyhow!("the comparisons use no robot {other}")),
    })
}

/// Content of gradients.json.
pub(super) fn gradients() -> Result<GradientReference> {
    serde_json::from_str(include_str!("../../reference/gradients.json")).context("gradients.json")
}

/// Content of gradients.json.
#[derive(Deserialize)]
pub(super) struct GradientReference {
    pub(super) source: String,
    pub(super) robots: Vec<GradientRobot>,
}

#[derive(Deserialize)]
pub(super) struct GradientRobot {
    pub(super) id: String,
    pub(super) toml: String,
    pub(super) position_m: [f64; 3],
    pub(super) frequency_hz: Vec<f64>,
    pub(super) lengths_held: Vec<GradientRow>,
    pub(super) pose_held: Vec<GradientRow>,
}

/// Derivatives of all results by one number of the robot.
#[derive(Deserialize)]
pub(super) struct GradientRow {
    pub(super) path: String,
    /// Translation and rotation vector, with the lengths held.
    pub(super) pose: Option<Vec<f64>>,
    /// Unstrained lengths, with the pose held.
    pub(super) lengths: Option<Vec<f64>>,
    pub(super) tension_platform: Vec<f64>,
    pub(super) tension_anchor: Vec<f64>,
    pub(super) frequency_hz: Vec<f64>,
}

/// Content of drives.json.
pub(super) fn drives() -> Result<Drives> {
    serde_json::from_str(include_str!("../../reference/drives.json")).context("drives.json")
}

/// Content of drives.json.
#[derive(Deserialize)]
pub(super) struct Drives {
    pub(super) straight: ReferenceTable<StraightOverPulley>,
    pub(super) sagging: ReferenceTable<SaggingOverPulley>,
    pub(super) cables: ReferenceTable<CableToWinch>,
    pub(super) robots: ReferenceTable<RobotWithWinches>,
    pub(super) vibration: ReferenceTable<DrivenRobot>,
    pub(super) moving_cables: ReferenceTable<DrivenCable>,
    pub(super) friction_corners: ReferenceTable<FrictionCorner>,
    pub(super) friction_half_widths: ReferenceTable<FrictionHalfWidths>,
}

/// Straight cable without mass over a pulley.
#[derive(Deserialize)]
pub(super) struct StraightOverPulley {
    pub(super) case: String,
    pub(super) radius_m: f64,
    pub(super) entry_direction: [f64; 3],
    pub(super) entry_point_m: [f64; 3],
    pub(super) platform_point_m: [f64; 3],
    pub(super) wrap_rad: f64,
    pub(super) exit_point_m: [f64; 3],
    pub(super) length_m: f64,
    /// Size of the last printed digit.
    pub(super) printed_digits: f64,
}

/// Sagging cable over a pulley at the origin, in the plane of x and z.
#[derive(Deserialize)]
pub(super) struct SaggingOverPulley {
    pub(super) case: String,
    pub(super) platform_point_along_up_m: [f64; 2],
    pub(super) radius_m: f64,
    pub(super) weight_n_per_m: f64,
    pub(super) axial_stiffness_n: f64,
    pub(super) unstrained_length_m: f64,
    pub(super) force_at_platform_along_up_n: [f64; 2],
    pub(super) tension_platform_n: f64,
    pub(super) tension_exit_n: f64,
    pub(super) tension_drum_n: f64,
    pub(super) wrap_rad: f64,
    pub(super) exit_point_along_up_m: [f64; 2],
    pub(super) free_length_m: f64,
    /// Entries xx, xz, zz and yy.
    pub(super) stiffness_n_per_m: [f64; 4],
}

/// Cable over a pulley to a winch.
#[derive(Deserialize)]
pub(super) struct CableToWinch {
    pub(super) case: String,
    pub(super) entry_point_m: [f64; 3],
    pub(super) entry_direction: [f64; 3],
    pub(super) radius_m: f64,
    pub(super) drum_side_length_m: f64,
    pub(super) winch_stiffness_n_per_m: Option<f64>,
    pub(super) axial_stiffness_n: f64,
    pub(super) mass_kg_per_m: f64,
    pub(super) unstrained_length_m: f64,
    pub(super) platform_point_m: [f64; 3],
    pub(super) tension_exit_n: f64,
    pub(super) tension_drum_n: f64,
    pub(super) wrap_rad: f64,
    pub(super) exit_point_m: [f64; 3],
    pub(super) kink_rad: f64,
    /// Unstrained lengths of free span, arc and drum side.
    pub(super) lengths_m: [f64; 3],
    pub(super) force_on_platform_n: [f64; 3],
    pub(super) stiffness_n_per_m: [[f64; 3]; 3],
    pub(super) force_per_unstrained_length_n_per_m: [f64; 3],
    pub(super) energy_j: f64,
}

/// Inertia and control of a drive; masses and gains at the cable.
#[derive(Deserialize)]
pub(super) struct DriveParts {
    pub(super) wheel_inertia_kg_m2: f64,
    pub(super) swivel_inertia_kg_m2: f64,
    pub(super) drum_mass_kg: f64,
    pub(super) motor_mass_kg: f64,
    /// `ideal`, `position` or `torque`.
    pub(super) control: String,
    pub(super) position_gain_n_per_m: f64,
    pub(super) speed_gain_n_s_per_m: f64,
    pub(super) cable_damping_ratio: f64,
}

/// Vibration of a robot whose drives have inertia and control.
#[derive(Deserialize)]
pub(super) struct DrivenRobot {
    /// Case of the robot.
    pub(super) case: String,
    #[serde(flatten)]
    pub(super) parts: DriveParts,
    /// All undamped natural frequencies up to the last.
    pub(super) frequencies_hz: Vec<f64>,
    /// Motion of the platform per commanded length, or per force of a motor: (6, cables).
    pub(super) responses: Vec<DriveResponse>,
    /// Motion of the platform per motion of the base, anchors and drums, in six directions: (6, 6).
    pub(super) base: Vec<DriveResponse>,
    /// Damped modes with the damping of the servos alone.
    #[serde(default)]
    pub(super) servo_damped: Option<ServoDamped>,
}

/// Complex 6×m matrix at a frequency.
#[derive(Deserialize)]
pub(super) struct DriveResponse {
    pub(super) frequency_hz: f64,
    pub(super) re: Vec<Vec<f64>>,
    pub(super) im: Vec<Vec<f64>>,
}

/// Damped modes whose undamped partners lie below a limit.
#[derive(Deserialize)]
pub(super) struct ServoDamped {
    pub(super) below_hz: f64,
    /// |ω|/2π.
    pub(super) frequency_hz: Vec<f64>,
    pub(super) damping_ratio: Vec<f64>,
}

/// Cable over a pulley to a winch with inertia, its platform end at a point.
#[derive(Deserialize)]
pub(super) struct DrivenCable {
    /// Case of the cable at rest.
    pub(super) case: String,
    #[serde(flatten)]
    pub(super) parts: DriveParts,
    /// `massless` or `rod`.
    pub(super) drum_side: String,
    /// All natural frequencies with the platform end held, up to the last.
    pub(super) clamped_frequencies_hz: Vec<f64>,
    pub(super) dynamic: Vec<DrivenCableAt>,
}

/// Dynamic stiffness of the platform end and force per commanded length at a frequency, world axes.
#[derive(Deserialize)]
pub(super) struct DrivenCableAt {
    pub(super) frequency_hz: f64,
    pub(super) stiffness_re: [[f64; 3]; 3],
    pub(super) stiffness_im: [[f64; 3]; 3],
    pub(super) length_re: [f64; 3],
    pub(super) length_im: [f64; 3],
    /// Force on the platform end per motion of the anchor, its drum fixed: (3, 3).
    pub(super) anchor_re: [[f64; 3]; 3],
    pub(super) anchor_im: [[f64; 3]; 3],
    /// Force on the platform end per motion of anchor and drum: (3, 3). `None` where the source leaves out the inertia of
    /// the drum side that moves along.
    #[serde(default)]
    pub(super) base_re: Option<[[f64; 3]; 3]>,
    #[serde(default)]
    pub(super) base_im: Option<[[f64; 3]; 3]>,
}

/// Robot whose cables run over equal pulleys to equal winches.
#[derive(Deserialize)]
pub(super) struct RobotWithWinches {
    pub(super) case: String,
    pub(super) mass_kg: f64,
    pub(super) center_of_mass_m: [f64; 3],
    pub(super) inertia_kg_m2: [[f64; 3]; 3],
    pub(super) axial_stiffness_n: f64,
    pub(super) mass_kg_per_m: f64,
    pub(super) radius_m: f64,
    pub(super) drum_side_length_m: f64,
    pub(super) winch_stiffness_n_per_m: Option<f64>,
    pub(super) anchors_m: Vec<[f64; 3]>,
    pub(super) attachments_m: Vec<[f64; 3]>,
    pub(super) unstrained_lengths_m: Vec<f64>,
    pub(super) position_m: [f64; 3],
    pub(super) roll_pitch_yaw_deg: [f64; 3],
    pub(super) tension_exit_n: Vec<f64>,
    pub(super) tension_drum_n: Vec<f64>,
    pub(super) stiffness_6x6: [[f64; 6]; 6],
}

/// Equilibrium with friction after given last motions of the cables.
#[derive(Deserialize)]
pub(super) struct FrictionCorner {
    pub(super) case: String,
    /// Case of the robot.
    pub(super) robot: String,
    pub(super) friction_coefficient: f64,
    /// True per cable that last ran towards the platform, false per cable that last ran towards its drum.
    pub(super) last_towards_platform: Vec<bool>,
    pub(super) position_m: [f64; 3],
    /// Rows of the rotation matrix.
    pub(super) rotation: [[f64; 3]; 3],
    pub(super) tension_exit_n: Vec<f64>,
    pub(super) tension_drum_n: Vec<f64>,
}

/// Half widths of the interval in which friction leaves a robot, to first order in the friction.
#[derive(Deserialize)]
pub(super) struct FrictionHalfWidths {
    pub(super) case: String,
    /// Case of the robot.
    pub(super) robot: String,
    pub(super) friction_coefficient: f64,
    pub(super) translation_m: [f64; 3],
    pub(super) rotation_rad: [f64; 3],
}

/// Content of measured.json.
pub(super) fn measured() -> Result<Measured> {
    serde_json::from_str(include_str!("../../reference/measured.json")).context("measured.json")
}

/// Content of measured.json.
#[derive(Deserialize)]
pub(super) struct Measured {
    pub(super) grab: ReferenceTable<MeasuredPose>,
}

/// Pose of a robot with measured natural frequencies.
#[derive(Deserialize)]
pub(super) struct MeasuredPose {
    pub(super) experiment: usize,
    pub(super) cables: usize,
    pub(super) position_m: [f64; 3],
    /// Angles of the rotation Rx(a) Ry(b) Rz(c).
    pub(super) angles_xyz_rad: [f64; 3],
    pub(super) lengths_m: Vec<f64>,
    /// Frequencies of the source's model, ascending.
    pub(super) model_hz: Vec<f64>,
    /// Frequencies for fixed points instead of the pulleys, by a separate program, ascending.
    pub(super) fixed_points_hz: Vec<f64>,
    /// Measured frequencies; `None` where no peak was found.
    pub(super) measured_hz: Vec<Option<f64>>,
}

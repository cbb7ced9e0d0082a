//! Contents of published.json.

use super::ReferenceTable;
use anyhow::{Context, Result};
use serde::Deserialize;

/// Reads published.json.
pub(crate) fn published() -> Result<Published> {
    serde_json::from_str(include_str!("../../reference/published.json")).context("published.json")
}

/// Content of published.json.
#[derive(Deserialize)]
pub(crate) struct Published {
    pub(crate) catenary_grid: ReferenceTable<GridCable>,
    pub(crate) catenary_moorpy: ReferenceTable<MoorpyCable>,
    pub(crate) hanging_lines: ReferenceTable<HangingLine>,
    pub(crate) isolated_cable: IsolatedCable,
    pub(crate) irvine_caughey: ReferenceTable<Roots>,
    pub(crate) fig2_cable: Fig2,
    pub(crate) fig2_closed_form: ReferenceTable<ClosedFormRow>,
    pub(crate) fig2_finite_elements: ReferenceTable<FiniteElementRow>,
    pub(crate) bessel_cable: Bessel,
    pub(crate) paper_robot_equilibria: ReferenceTable<PaperEquilibrium>,
    pub(crate) paper_robot_ideal_poses: ReferenceTable<IdealPose>,
    pub(crate) cube_point_mass: Cube,
}

/// Input of the catenary.
#[derive(Deserialize)]
pub(crate) struct HungBetween {
    pub(crate) span_m: f64,
    pub(crate) rise_m: f64,
    pub(crate) unstrained_length_m: f64,
    pub(crate) axial_stiffness_n: f64,
    pub(crate) weight_n_per_m: f64,
}

#[derive(Deserialize)]
pub(crate) struct GridCable {
    #[serde(flatten)]
    pub(crate) hung: HungBetween,
    pub(crate) horizontal_force_n: f64,
    pub(crate) vertical_force_at_end_n: f64,
    pub(crate) end_stiffness_xx_xz_zz_n_per_m: [f64; 3],
}

#[derive(Deserialize)]
pub(crate) struct MoorpyCable {
    #[serde(flatten)]
    pub(crate) hung: HungBetween,
    pub(crate) horizontal_force_n: f64,
    pub(crate) vertical_force_at_start_n: f64,
    pub(crate) vertical_force_at_end_n: f64,
}

#[derive(Deserialize)]
pub(crate) struct HangingLine {
    pub(crate) case: String,
    pub(crate) source: String,
    #[serde(flatten)]
    pub(crate) hung: HungBetween,
    pub(crate) horizontal_force_n: Option<f64>,
    pub(crate) sag_at_mid_m: Option<f64>,
    pub(crate) horizontal_force_kn: Option<f64>,
    pub(crate) tension_at_end_kn: Option<f64>,
    pub(crate) tension_at_start_kn: Option<f64>,
}

#[derive(Deserialize)]
pub(crate) struct IsolatedCable {
    pub(crate) source: String,
    pub(crate) metres_per_foot: f64,
    pub(crate) youngs_modulus_kip_per_in2: f64,
    pub(crate) area_in2: f64,
    pub(crate) weight_kip_per_ft: f64,
    pub(crate) span_ft: f64,
    pub(crate) unstrained_lengths_ft: [f64; 2],
    pub(crate) load_kip: f64,
    pub(crate) node_at_rest_ft: [f64; 2],
    pub(crate) displacement_under_load_m: [f64; 2],
    pub(crate) published_displacement_m: [f64; 2],
}

#[derive(Deserialize)]
pub(crate) struct Roots {
    /// λ²; `None` for the inextensible cable.
    pub(crate) lambda2: Option<f64>,
    pub(crate) roots: [f64; 4],
}

#[derive(Deserialize)]
pub(crate) struct Fig2 {
    pub(crate) source: String,
    pub(crate) chord_m: f64,
    pub(crate) inclination_deg: f64,
    pub(crate) tension_n: f64,
    pub(crate) youngs_modulus_pa: f64,
    pub(crate) area_m2: f64,
    pub(crate) mass_kg_per_m: f64,
    pub(crate) gravity_m_s2: f64,
    pub(crate) published: Fig2Printed,
    pub(crate) from_table_ii: Fig2Defined,
    pub(crate) mass_of_published_lambda2_kg_per_m: f64,
}

#[derive(Deserialize)]
pub(crate) struct Fig2Printed {
    pub(crate) lambda2: f64,
    pub(crate) epsilon: f64,
    pub(crate) effective_length_over_chord: f64,
}

#[derive(Deserialize)]
pub(crate) struct Fig2Defined {
    pub(crate) source: String,
    pub(crate) lambda2: f64,
    pub(crate) epsilon: f64,
}

#[derive(Deserialize)]
pub(crate) struct ClosedFormRow {
    pub(crate) frequency_hz: f64,
    pub(crate) damping_ratio: f64,
    pub(crate) axial_n_per_m: [f64; 2],
    pub(crate) coupling_n_per_m: [f64; 2],
    pub(crate) normal_n_per_m: [f64; 2],
    pub(crate) out_of_plane_n_per_m: [f64; 2],
}

#[derive(Deserialize)]
pub(crate) struct FiniteElementRow {
    pub(crate) frequency_hz: f64,
    pub(crate) upper_end_moves: bool,
    pub(crate) stiffness_xx_xz_zz_yy_n_per_m: [f64; 4],
}

#[derive(Deserialize)]
pub(crate) struct Bessel {
    pub(crate) source: String,
    pub(crate) length_m: f64,
    pub(crate) mass_kg_per_m: f64,
    pub(crate) gravity_m_s2: f64,
    pub(crate) rows: Vec<BesselRow>,
}

#[derive(Deserialize)]
pub(crate) struct BesselRow {
    pub(crate) lower_tension_n: f64,
    pub(crate) clamped_rad_per_s: [f64; 3],
    pub(crate) stiffness_at_rest_n_per_m: f64,
    pub(crate) stiffness_at_1_rad_per_s_n_per_m: f64,
}

#[derive(Deserialize)]
pub(crate) struct PaperEquilibrium {
    pub(crate) robot: String,
    pub(crate) mass_kg: f64,
    pub(crate) position_m: [f64; 3],
    pub(crate) tension_platform_n: [f64; 6],
}

#[derive(Deserialize)]
pub(crate) struct IdealPose {
    pub(crate) robot: String,
    pub(crate) position_m: [f64; 3],
    pub(crate) rotation_vector_deg: [f64; 3],
}

#[derive(Deserialize)]
pub(crate) struct Cube {
    pub(crate) source: String,
    pub(crate) position_m: [f64; 3],
    pub(crate) longest_cable_m: f64,
    pub(crate) mass_kg_per_m: f64,
    pub(crate) axial_stiffness_n: f64,
    pub(crate) limit_hz: f64,
    pub(crate) rows: Vec<CubeRow>,
}

#[derive(Deserialize)]
pub(crate) struct CubeRow {
    pub(crate) model: String,
    pub(crate) unstrained_length_m: [f64; 8],
    pub(crate) frequencies_hz: Vec<f64>,
}

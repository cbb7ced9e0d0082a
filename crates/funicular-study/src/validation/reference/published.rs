//! Contents of published.json.

use super::ReferenceTable;
use anyhow::{Context, Result};
use serde::Deserialize;

/// Reads published.json.
pub(in crate::validation) fn published() -> Result<Published> {
    serde_json::from_str(include_str!("../../../reference/published.json")).context("published.json")
}

/// Content of published.json.
#[derive(Deserialize)]
pub(in crate::validation) struct Published {
    pub(in crate::validation) catenary_grid: ReferenceTable<GridCable>,
    pub(in crate::validation) catenary_moorpy: ReferenceTable<MoorpyCable>,
    pub(in crate::validation) hanging_lines: ReferenceTable<HangingLine>,
    pub(in crate::validation) isolated_cable: IsolatedCable,
    pub(in crate::validation) irvine_caughey: ReferenceTable<Roots>,
    pub(in crate::validation) fig2_cable: Fig2,
    pub(in crate::validation) fig2_closed_form: ReferenceTable<ClosedFormRow>,
    pub(in crate::validation) fig2_finite_elements: ReferenceTable<FiniteElementRow>,
    pub(in crate::validation) bessel_cable: Bessel,
    pub(in crate::validation) paper_robot_equilibria: ReferenceTable<PaperEquilibrium>,
    pub(in crate::validation) paper_robot_ideal_poses: ReferenceTable<IdealPose>,
    pub(in crate::validation) cube_point_mass: Cube,
}

/// Input of the catenary.
#[derive(Deserialize)]
pub(in crate::validation) struct HungBetween {
    pub(in crate::validation) span_m: f64,
    pub(in crate::validation) rise_m: f64,
    pub(in crate::validation) unstrained_length_m: f64,
    pub(in crate::validation) axial_stiffness_n: f64,
    pub(in crate::validation) weight_n_per_m: f64,
}

#[derive(Deserialize)]
pub(in crate::validation) struct GridCable {
    #[serde(flatten)]
    pub(in crate::validation) hung: HungBetween,
    pub(in crate::validation) horizontal_force_n: f64,
    pub(in crate::validation) vertical_force_at_end_n: f64,
    pub(in crate::validation) end_stiffness_xx_xz_zz_n_per_m: [f64; 3],
}

#[derive(Deserialize)]
pub(in crate::validation) struct MoorpyCable {
    #[serde(flatten)]
    pub(in crate::validation) hung: HungBetween,
    pub(in crate::validation) horizontal_force_n: f64,
    pub(in crate::validation) vertical_force_at_start_n: f64,
    pub(in crate::validation) vertical_force_at_end_n: f64,
}

#[derive(Deserialize)]
pub(in crate::validation) struct HangingLine {
    pub(in crate::validation) case: String,
    pub(in crate::validation) source: String,
    #[serde(flatten)]
    pub(in crate::validation) hung: HungBetween,
    pub(in crate::validation) horizontal_force_n: Option<f64>,
    pub(in crate::validation) sag_at_mid_m: Option<f64>,
    pub(in crate::validation) horizontal_force_kn: Option<f64>,
    pub(in crate::validation) tension_at_end_kn: Option<f64>,
    pub(in crate::validation) tension_at_start_kn: Option<f64>,
}

#[derive(Deserialize)]
pub(in crate::validation) struct IsolatedCable {
    pub(in crate::validation) source: String,
    pub(in crate::validation) metres_per_foot: f64,
    pub(in crate::validation) youngs_modulus_kip_per_in2: f64,
    pub(in crate::validation) area_in2: f64,
    pub(in crate::validation) weight_kip_per_ft: f64,
    pub(in crate::validation) span_ft: f64,
    pub(in crate::validation) unstrained_lengths_ft: [f64; 2],
    pub(in crate::validation) load_kip: f64,
    pub(in crate::validation) node_at_rest_ft: [f64; 2],
    pub(in crate::validation) displacement_under_load_m: [f64; 2],
    pub(in crate::validation) published_displacement_m: [f64; 2],
}

#[derive(Deserialize)]
pub(in crate::validation) struct Roots {
    /// λ²; `None` for the inextensible cable.
    pub(in crate::validation) lambda2: Option<f64>,
    pub(in crate::validation) roots: [f64; 4],
}

#[derive(Deserialize)]
pub(in crate::validation) struct Fig2 {
    pub(in crate::validation) source: String,
    pub(in crate::validation) chord_m: f64,
    pub(in crate::validation) inclination_deg: f64,
    pub(in crate::validation) tension_n: f64,
    pub(in crate::validation) youngs_modulus_pa: f64,
    pub(in crate::validation) area_m2: f64,
    pub(in crate::validation) mass_kg_per_m: f64,
    pub(in crate::validation) gravity_m_s2: f64,
    pub(in crate::validation) published: Fig2Printed,
    pub(in crate::validation) from_table_ii: Fig2Defined,
    pub(in crate::validation) mass_of_published_lambda2_kg_per_m: f64,
}

#[derive(Deserialize)]
pub(in crate::validation) struct Fig2Printed {
    pub(in crate::validation) lambda2: f64,
    pub(in crate::validation) epsilon: f64,
    pub(in crate::validation) effective_length_over_chord: f64,
}

#[derive(Deserialize)]
pub(in crate::validation) struct Fig2Defined {
    pub(in crate::validation) source: String,
    pub(in crate::validation) lambda2: f64,
    pub(in crate::validation) epsilon: f64,
}

#[derive(Deserialize)]
pub(in crate::validation) struct ClosedFormRow {
    pub(in crate::validation) frequency_hz: f64,
    pub(in crate::validation) damping_ratio: f64,
    pub(in crate::validation) axial_n_per_m: [f64; 2],
    pub(in crate::validation) coupling_n_per_m: [f64; 2],
    pub(in crate::validation) normal_n_per_m: [f64; 2],
    pub(in crate::validation) out_of_plane_n_per_m: [f64; 2],
}

#[derive(Deserialize)]
pub(in crate::validation) struct FiniteElementRow {
    pub(in crate::validation) frequency_hz: f64,
    pub(in crate::validation) upper_end_moves: bool,
    pub(in crate::validation) stiffness_xx_xz_zz_yy_n_per_m: [f64; 4],
}

#[derive(Deserialize)]
pub(in crate::validation) struct Bessel {
    pub(in crate::validation) source: String,
    pub(in crate::validation) length_m: f64,
    pub(in crate::validation) mass_kg_per_m: f64,
    pub(in crate::validation) gravity_m_s2: f64,
    pub(in crate::validation) rows: Vec<BesselRow>,
}

#[derive(Deserialize)]
pub(in crate::validation) struct BesselRow {
    pub(in crate::validation) lower_tension_n: f64,
    pub(in crate::validation) clamped_rad_per_s: [f64; 3],
    pub(in crate::validation) stiffness_at_rest_n_per_m: f64,
    pub(in crate::validation) stiffness_at_1_rad_per_s_n_per_m: f64,
}

#[derive(Deserialize)]
pub(in crate::validation) struct PaperEquilibrium {
    pub(in crate::validation) robot: String,
    pub(in crate::validation) mass_kg: f64,
    pub(in crate::validation) position_m: [f64; 3],
    pub(in crate::validation) tension_platform_n: [f64; 6],
}

#[derive(Deserialize)]
pub(in crate::validation) struct IdealPose {
    pub(in crate::validation) robot: String,
    pub(in crate::validation) position_m: [f64; 3],
    pub(in crate::validation) rotation_vector_deg: [f64; 3],
}

#[derive(Deserialize)]
pub(in crate::validation) struct Cube {
    pub(in crate::validation) source: String,
    pub(in crate::validation) position_m: [f64; 3],
    pub(in crate::validation) longest_cable_m: f64,
    pub(in crate::validation) mass_kg_per_m: f64,
    pub(in crate::validation) axial_stiffness_n: f64,
    pub(in crate::validation) limit_hz: f64,
    pub(in crate::validation) rows: Vec<CubeRow>,
}

#[derive(Deserialize)]
pub(in crate::validation) struct CubeRow {
    pub(in crate::validation) model: String,
    pub(in crate::validation) unstrained_length_m: [f64; 8],
    pub(in crate::validation) frequencies_hz: Vec<f64>,
}

//! Contents of workspaces.json.

use anyhow::{Context, Result};
use serde::Deserialize;
use std::fmt::Write as _;

/// Reads workspaces.json.
pub(crate) fn workspaces() -> Result<WorkspaceReference> {
    serde_json::from_str(include_str!("../../reference/workspaces.json")).context("workspaces.json")
}

/// Content of workspaces.json.
#[derive(Deserialize)]
pub(crate) struct WorkspaceReference {
    pub(crate) source: String,
    pub(crate) box_shaped: BoxShapedRobot,
    pub(crate) cogiro: RequiredBoxOfCogiro,
}

/// Robot whose anchors are the corners of a box, with a plate as its platform.
#[derive(Deserialize)]
pub(crate) struct BoxShapedRobot {
    /// Sides of the frame, whose floor is z = 0, and of the plate.
    pub(crate) frame_m: [f64; 3],
    plate_m: [f64; 2],
    tension_limits_n: [f64; 2],
    pub(crate) center_m: [f64; 3],
    pub(crate) rays: usize,
    /// First and last width of the bracket of the search.
    pub(crate) search_m: [f64; 2],
    pub(crate) closed_form_m3: f64,
    pub(crate) closed_form_m2: f64,
    pub(crate) all_tensions_m3: f64,
    pub(crate) all_tensions_m2: f64,
}

impl BoxShapedRobot {
    /// Robot file without weight.
    pub(crate) fn robot_file(&self) -> String {
        let [minimum, maximum] = self.tension_limits_n;
        let mut text = format!(
            "name = \"IPAnema1Design\"\ngravity_m_s2 = [0.0, 0.0, 0.0]\n[platform]\nmass_kg = 1.0\n\
             inertia_kg_m2 = [0.01, 0.01, 0.01]\n[materials.rope]\nmass_kg_per_m = 1e-6\naxial_stiffness_n = 1e6\n\
             minimum_tension_n = {minimum}\nmaximum_tension_n = {maximum}\n"
        );
        let ([x, y, z], [a, b]) = (self.frame_m.map(|side| 0.5 * side), self.plate_m.map(|side| 0.5 * side));
        let corners = [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)];
        let anchors = [2.0 * z, 0.0].into_iter().flat_map(|height| corners.map(|corner| (corner, height)));
        for (number, ((right, back), height)) in (1..).zip(anchors) {
            let _ = write!(
                text,
                "[[cables]]\nname = \"{number}\"\nanchor_m = [{:?}, {:?}, {height:?}]\nattachment_m = [{:?}, {:?}, \
                 0.0]\n\
                 material = \"rope\"\n",
                right * x,
                back * y,
                right * a,
                back * b
            );
        }
        text
    }
}

/// CoGiRo with a box of required loads.
#[derive(Deserialize)]
pub(crate) struct RequiredBoxOfCogiro {
    pub(crate) tension_limits_n: [f64; 2],
    /// Half widths of the box of forces and moments.
    pub(crate) required_box_n_nm: [f64; 6],
    pub(crate) box_m: [[f64; 3]; 2],
    pub(crate) step_m: f64,
    pub(crate) volume_m3: f64,
    /// Volume with half of these steps.
    pub(crate) halved_volume_m3: f64,
    pub(crate) center_m: [f64; 3],
    /// Ends of the rays along +x, -x, +y, -y, +z, -z.
    pub(crate) ends_m: [f64; 6],
}

//! Table of lengths in JSON.

use super::{COORDINATES, Firmware};
use anyhow::Result;
use serde::Serialize;

/// Name and version of the form.
const SCHEMA: &str = "funicular-length-table/1";

#[derive(Serialize)]
struct JsonTable {
    schema: &'static str,
    meaning: &'static str,
    robot: String,
    robot_file: String,
    robot_file_crc32: String,
    changes: Vec<String>,
    static_model: &'static str,
    tension_rule: Option<&'static str>,
    tolerance_m: f64,
    error: TableError,
    change_by_10_percent_more_axial_stiffness_m: Option<f64>,
    change_by_10_percent_more_mass_per_m_m: Option<f64>,
    axes: Vec<TableAxis>,
    fixed_position_m: [f64; 3],
    fixed_roll_pitch_yaw_deg: [f64; 3],
    total_degree: usize,
    exponents: Vec<Vec<usize>>,
    cables: Vec<TableCable>,
    self_test: Vec<TestedPose>,
}

#[derive(Serialize)]
struct TableError {
    largest_m: f64,
    cable: String,
    at: Vec<f64>,
    tested_poses: usize,
    fitted_poses: usize,
}

#[derive(Serialize)]
struct TableAxis {
    name: &'static str,
    from: f64,
    to: f64,
}

#[derive(Serialize)]
struct TableCable {
    name: String,
    minimum_tension_n: Option<f64>,
    maximum_tension_n: Option<f64>,
    anchor_m: [f64; 3],
    attachment_m: [f64; 3],
    coefficients_m: Vec<f64>,
}

#[derive(Serialize)]
struct TestedPose {
    at: Vec<f64>,
    length_m: Vec<f64>,
}

/// Meaning of the numbers, for a reader of the file alone.
const MEANING: &str = "unstrained length = |anchor_m - p - R attachment_m| + sum of coefficients_m[k] times the \
                       product of Chebyshev polynomials T_n(t) of the degrees exponents[k], t = (2 v - from - to)/(to \
                       - from) along each axis; R = Rz(yaw) Ry(pitch) Rx(roll)";

/// Text of a table in JSON.
pub(super) fn text(of: &Firmware) -> Result<String> {
    let table = &of.table;
    let cable = |(i, cable): (usize, &funicular::robot::Cable)| TableCable {
        name: cable.name.clone(),
        minimum_tension_n: cable.limits().minimum,
        maximum_tension_n: cable.limits().maximum,
        anchor_m: table.lines[i].anchor_w.into(),
        attachment_m: table.lines[i].attachment_p.into(),
        coefficients_m: table.coefficients[i].clone(),
    };
    let tested = |at: Vec<f64>| TestedPose {
        length_m: (0..table.lines.len()).map(|cable| table.length(cable, &at)).collect(),
        at,
    };
    let axes = table.pose_box.sides().iter();
    let whole = JsonTable {
        schema: SCHEMA,
        meaning: MEANING,
        robot: of.robot.name.clone(),
        robot_file: of.request.robot.name.clone(),
        robot_file_crc32: of.checksum(),
        changes: of.changes(),
        static_model: of.static_model(),
        tension_rule: of.rule,
        tolerance_m: of.tolerance,
        error: TableError {
            largest_m: table.error,
            cable: of.robot.cables[table.error_at.0].name.clone(),
            at: table.error_at.1.clone(),
            tested_poses: table.tested,
            fitted_poses: table.fitted,
        },
        change_by_10_percent_more_axial_stiffness_m: table.by_stiffness,
        change_by_10_percent_more_mass_per_m_m: table.by_mass,
        axes: axes.map(|side| TableAxis { name: COORDINATES[side.axis], from: side.from, to: side.to }).collect(),
        fixed_position_m: table.pose_box.base().position_w.into(),
        fixed_roll_pitch_yaw_deg: table.pose_box.angles_deg(),
        total_degree: table.basis.degree(),
        exponents: table.basis.exponents().to_vec(),
        cables: of.robot.cables.iter().enumerate().map(cable).collect(),
        self_test: of.self_tests().into_iter().map(tested).collect(),
    };
    Ok(serde_json::to_string_pretty(&whole)? + "\n")
}

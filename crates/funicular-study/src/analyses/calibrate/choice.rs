//! Unknowns that a request names: by their kind, as in `unknowns`, or by the path of a value, as in results.

use super::{TOOL, UNKNOWNS, is_for_tool, words};
use crate::names::suggestion;
use crate::request::CalibrateRequest;
use crate::set_values::{self, ANY};
use anyhow::{Result, bail};
use funicular::calibration::CalibrationUnknown;
use funicular::robot::Robot;

/// Name of the kind of an unknown.
fn kind(unknown: &CalibrationUnknown) -> &'static str {
    match unknown {
        CalibrationUnknown::Anchor { .. } => "anchors",
        CalibrationUnknown::Attachment { .. } => "attachments",
        CalibrationUnknown::Offset { .. } => "offsets",
        CalibrationUnknown::Scale => "scale",
        CalibrationUnknown::AxialStiffness => "axial-stiffness",
        CalibrationUnknown::Mass => "mass",
        CalibrationUnknown::PulleyRadius { .. } => "pulley-radii",
        CalibrationUnknown::SupportStiffness => "support-stiffness",
    }
}

/// Indices of the unknowns that a name stands for: a kind, a path, or a path with `*` or to a vector.
///
/// # Errors
/// A name that no unknown has.
pub(super) fn chosen(key: &str, name: &str, unknowns: &[CalibrationUnknown], robot: &Robot) -> Result<Vec<usize>> {
    let paths: Vec<String> = unknowns.iter().map(|unknown| words::path(robot, unknown).0).collect();
    let keys = |path: &str| set_values::path(path).map_or_else(|_| Vec::new(), |path| path.keys().to_vec());
    let wanted = keys(name);
    let is_below = |path: &str| {
        let own = keys(path);
        !wanted.is_empty()
            && own.len() >= wanted.len()
            && wanted.iter().zip(&own).all(|(wanted, own)| wanted == ANY || wanted == own)
    };
    let is_chosen = |k: &usize| kind(&unknowns[*k]) == name || paths[*k] == name.trim() || is_below(&paths[*k]);
    let found: Vec<usize> = (0..unknowns.len()).filter(is_chosen).collect();
    if found.is_empty() {
        let known: Vec<String> = UNKNOWNS.map(str::to_owned).into_iter().chain(paths).collect();
        bail!(
            "⟪{key}⟫: no unknown is called `{name}`{}; name a kind of ⟪unknowns⟫, or the path of a value",
            suggestion(name, &known)
        );
    }
    Ok(found)
}

/// Mark for each unknown whose deviation a proposal reduces: all without names, or where the tool is named alone.
///
/// # Errors
/// A name that no unknown has, or names beside that of the tool.
pub(super) fn proposed_for(
    request: &CalibrateRequest,
    unknowns: &[CalibrationUnknown],
    robot: &Robot,
) -> Result<Vec<bool>> {
    let names = &request.propose_for;
    if is_for_tool(request) && names.len() > 1 {
        bail!("⟪propose_for⟫: {TOOL} stands alone, because lengths and positions have no common weight");
    }
    if names.is_empty() || is_for_tool(request) {
        return Ok(vec![true; unknowns.len()]);
    }
    all_chosen("propose_for", names, unknowns, robot)
}

/// Mark for each unknown, from a list of names.
///
/// # Errors
/// A name that no unknown has.
pub(super) fn all_chosen(
    key: &str,
    names: &[String],
    unknowns: &[CalibrationUnknown],
    robot: &Robot,
) -> Result<Vec<bool>> {
    let mut marks = vec![false; unknowns.len()];
    for name in names {
        chosen(key, name, unknowns, robot)?.into_iter().for_each(|k| marks[k] = true);
    }
    Ok(marks)
}

//! `parameters`: all numbers of a robot file.

use super::found;
use crate::request::RobotText;
use anyhow::{Result, anyhow};
use funicular::robot::parameters::{Parameter, Parameters};
use serde::Serialize;

/// Results of `parameters`: the numbers of a robot.
#[derive(Serialize)]
pub struct ParameterList {
    #[serde(skip)]
    pub robot: String,
    /// Numbers in the order of the file's documentation: robot, platform, ropes, cables, load, wind, pose.
    pub parameters: Vec<ParameterRow>,
    #[serde(skip)]
    pub warnings: Vec<String>,
}

/// Number of a robot.
#[derive(Serialize)]
pub struct ParameterRow {
    /// Path for `set` and `vary`.
    pub path: String,
    pub value: f64,
    /// Unit; `1` for a ratio.
    pub unit: &'static str,
    /// Permitted range in words.
    pub range: String,
    /// Minimum of the range.
    pub minimum: f64,
    /// Maximum of the range, or the limit below which values are permitted.
    pub maximum: f64,
    pub meaning: &'static str,
    /// Name in words with the unit.
    pub label: String,
    /// True if the file gives the number; otherwise the value is the default.
    pub given: bool,
}

impl ParameterRow {
    fn of(parameter: &Parameter) -> Self {
        let Parameter { value, unit, range, about, given, .. } = *parameter;
        let (minimum, maximum) = (range.minimum(), range.maximum());
        let (path, label) = (parameter.path(), parameter.label());
        Self { path, label, value, unit, range: range.to_string(), minimum, maximum, meaning: about, given }
    }
}

found!(ParameterList, "parameters");

/// Lists the numbers of a robot file after its changes.
///
/// # Errors
/// A change of a value that the file does not have, or a file that the reader refuses.
pub fn run(robot: &RobotText) -> Result<ParameterList> {
    let file = robot.read()?;
    let parameters = Parameters::from_toml(&file.text).map_err(|error| anyhow!("{error}"))?;
    Ok(ParameterList {
        robot: file.robot.name,
        parameters: parameters.list().iter().map(ParameterRow::of).collect(),
        warnings: Vec::new(),
    })
}

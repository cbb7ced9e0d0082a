//! `parameters`: every number of a robot file.

use super::found;
use crate::request::RobotText;
use anyhow::{Result, anyhow};
use funicular::robot::parameters::{Parameter, Parameters};
use serde::Serialize;

/// The numbers of a robot.
#[derive(Serialize)]
pub struct ParameterList {
    #[serde(skip)]
    pub robot: String,
    /// In the order of the file's description: robot, platform, ropes, cables, load, wind, pose.
    pub parameters: Vec<ParameterRow>,
    #[serde(skip)]
    pub warnings: Vec<String>,
}

/// One number of a robot.
#[derive(Serialize)]
pub struct ParameterRow {
    /// Path, as `set` and `vary` take it.
    pub path: String,
    pub value: f64,
    /// Unit, `1` for a ratio.
    pub unit: &'static str,
    /// Numbers that it may be, in words.
    pub range: String,
    /// The smallest of them.
    pub minimum: f64,
    /// The largest of them, or the limit below which they are.
    pub maximum: f64,
    pub meaning: &'static str,
    /// The file gives it; else the value is the default.
    pub given: bool,
}

impl ParameterRow {
    fn of(parameter: &Parameter) -> Self {
        let Parameter { value, unit, range, about, given, .. } = *parameter;
        let (minimum, maximum) = (range.minimum(), range.maximum());
        let path = parameter.path();
        Self { path, value, unit, range: range.to_string(), minimum, maximum, meaning: about, given }
    }
}

found!(ParameterList, "parameters");

/// The numbers of a robot file, with its changes.
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

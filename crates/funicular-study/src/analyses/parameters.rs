//! `parameters`: all numbers of a robot file.

use super::found;
use crate::columns::{ResultTable, Tabled};
use crate::request::RobotText;
use crate::rows::rows;
use crate::table::Column;
use anyhow::{Result, anyhow};
use funicular::robot::parameters::{Parameter, Parameters};

/// Magnitude from which a value is shown with an exponent.
const LONG: f64 = 1e7;

rows! {
    /// Results of `parameters`: the numbers of a robot.
    pub struct ParameterList {
        pub robot: String = hidden;
        /// Numbers in the order of the file's documentation: robot, platform, ropes, cables, load, wind, pose.
        pub parameters: Vec<ParameterRow>;
        pub warnings: Vec<String> = hidden;
    }
}

rows! {
    /// Number of a robot.
    pub struct ParameterRow in tables() {
        /// Path of the number for `set`, `vary` and `fit`.
        pub path: String => one.plain("path");
        /// Value, in the unit of the row.
        pub value: f64 => one.unit("")
            .shown("value", "", |row, _| {
                if row.value.abs() < LONG { format!("{}", row.value) } else { format!("{:e}", row.value) }
            });
        /// Unit; `1` for a ratio.
        pub unit: &'static str => one.plain("unit");
        /// Range that is allowed, in words.
        pub range: String => one.plain("range");
        /// Lower end of the range.
        pub minimum: f64 => one.unit("");
        /// Upper end of the range.
        ///
        /// Maximum of the range, or the limit below which values are permitted.
        pub maximum: f64 => one.unit("");
        /// Meaning of the number.
        pub meaning: &'static str => one
            .shown("meaning", "", |row, _| {
                if row.given { row.meaning.to_owned() } else { format!("{} (default)", row.meaning) }
            });
        /// Name in words with the unit.
        pub label: String;
        /// The file gives the number; otherwise the value is the default.
        ///
        /// True if the file gives the number; otherwise the value is the default.
        pub given: bool => one;
    }
}

impl ParameterRow {
    fn of(parameter: &Parameter) -> Self {
        let Parameter { value, unit, range, about, given, .. } = *parameter;
        let (minimum, maximum) = (range.minimum(), range.maximum());
        let (path, label) = (parameter.path(), parameter.label());
        Self { path, label, value, unit, range: range.to_string(), minimum, maximum, meaning: about, given }
    }
}

impl Tabled for ParameterList {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        vec![("", ParameterRow::columns().described())]
    }

    fn table(&self) -> ResultTable<'_> {
        ResultTable::new(ParameterRow::columns(), &self.parameters)
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

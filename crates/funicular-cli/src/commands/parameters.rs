//! `parameters`: text and CSV.

use crate::output::Printed;
use crate::table::Table;
use funicular_study::analyses::parameters::{ParameterList, ParameterRow};

impl Printed for ParameterList {
    fn text(&self) -> String {
        let table = Table::of(&ParameterRow::columns(), &self.parameters);
        format!("{}: {} numbers\n\n{table}", self.robot, self.parameters.len())
    }
}

//! `validate`: text and CSV.

use crate::output::Printed;
use funicular_study::validation;
use funicular_study::validation::Validated;

impl Printed for Validated {
    fn text(&self) -> String {
        validation::markdown(&self.sections)
    }
}

//! `validate`: text.

use crate::output::Printed;
use funicular_validation::{Validated, markdown};

impl Printed for Validated {
    fn text(&self) -> String {
        markdown(self)
    }
}

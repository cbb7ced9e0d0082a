//! Robot file that cannot be used, as an error of any analysis.

use funicular::robot::spec::SpecError;
use thiserror::Error;

/// Robot file that the reader refuses, with all errors and the text to which they refer.
#[derive(Debug, Error)]
#[error("{}", .error.render(name, text, false).trim_end())]
pub struct Refused {
    /// Origin of the text.
    pub name: String,
    /// Text with its changes.
    pub text: String,
    /// Errors that the reader found.
    pub error: SpecError,
}

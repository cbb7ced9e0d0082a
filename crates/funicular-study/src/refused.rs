//! Robot file that cannot be used, as an error of any analysis.

use funicular::robot::spec::SpecError;
use funicular::suggest::is_hidden;
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

impl Refused {
    /// Error of a text. The text is kept to be shown, so that what hides or turns text in a terminal is replaced by
    /// signs of the same number of bytes: the places of the errors count bytes.
    pub(crate) fn new(name: String, text: &str, error: SpecError) -> Self {
        let mut shown = String::with_capacity(text.len());
        for c in text.chars() {
            match c.len_utf8() {
                // Control characters of one byte have signs of their own where the text is shown.
                1 => shown.push(c),
                _ if !is_hidden(c) => shown.push(c),
                2 => shown.push_str("??"),
                3 => shown.push('\u{fffd}'),
                _ => shown.push_str("\u{fffd}?"),
            }
        }
        Self { name, text: shown, error }
    }
}

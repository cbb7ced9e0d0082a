//! Contents of files, with sentences about them.

use crate::destination::Bytes;
use funicular_pages::figures::{Figure, RequestFigure};

/// Content of a file, ready to be written.
pub(crate) struct Made {
    pub(crate) bytes: Bytes,
    /// Sentences about the file that the user should know.
    pub(crate) warnings: Vec<String>,
    /// Notes for the user.
    pub(crate) notes: Vec<String>,
    /// Size of the content in words.
    pub(crate) size: Option<String>,
}

impl From<Vec<u8>> for Made {
    fn from(bytes: Vec<u8>) -> Self {
        Self { bytes: Bytes::File(bytes), warnings: Vec::new(), notes: Vec::new(), size: None }
    }
}

/// Figure with sentences about it.
pub(super) struct Drawn {
    pub(super) figure: Figure,
    pub(super) warnings: Vec<String>,
    pub(super) notes: Vec<String>,
}

/// Figure without a sentence.
pub(super) fn plain(figure: Figure) -> Drawn {
    Drawn { figure, warnings: Vec::new(), notes: Vec::new() }
}

impl From<RequestFigure> for Drawn {
    fn from(RequestFigure { figure, warnings }: RequestFigure) -> Self {
        Self { figure, warnings, notes: Vec::new() }
    }
}

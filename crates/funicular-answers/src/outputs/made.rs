//! Contents of files, with sentences about them.

use crate::destination::Bytes;
use anyhow::{Result, anyhow};
use funicular_pages::figures::{Figure, RequestFigure};
use funicular_study::columns::ResultTable;

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

/// Size of a page in words.
pub(crate) fn size_of_page(bytes: usize) -> String {
    format!("{:.1} MB", bytes as f64 / 1e6)
}

/// Table as CSV with a header.
///
/// # Errors
/// A cell that cannot be written.
pub fn as_csv(ResultTable { columns, mut rows }: ResultTable<'_>) -> Result<Vec<u8>> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record(columns.iter().map(|column| &column.name))?;
    rows.try_for_each(|row| table.serialize(row))?;
    table.into_inner().map_err(|error| anyhow!("{}", error.error()))
}

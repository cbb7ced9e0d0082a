//! Parquet files of a build without the feature `parquet`: every use is refused.
//!
//! The names are those of `parquet.rs`, so that the rest of the crate is the same in both builds.

use crate::{FilesError, Rows};
use funicular_study::table::{Chunk, Part, Record};
use serde_json::Value;
use std::convert::Infallible;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Refuses to write rows. It is not reached, because [`Format::of`](crate::Format::of) refuses the file before.
pub(crate) fn write(_out: impl Write + Send, _record: &Record, _rows: &dyn Rows, _complete: bool) -> io::Result<()> {
    Err(io::Error::new(io::ErrorKind::Unsupported, "this program was built without Parquet files"))
}

/// Parquet file of a sweep; no value of this type can exist.
pub(crate) struct ParquetFile {
    pub(crate) path: PathBuf,
    pub(crate) json: Value,
    pub(crate) robot_file: String,
    pub(crate) part: Option<Part>,
    pub(crate) complete: bool,
    pub(crate) rows: usize,
    none: Infallible,
}

impl ParquetFile {
    /// Refuses every file.
    pub(crate) fn open(path: &Path) -> Result<Self, FilesError> {
        Err(FilesError::WithoutParquet { path: path.to_owned() })
    }

    /// Cannot be called, because no value of this type exists.
    pub(crate) fn each(
        &self,
        _first: usize,
        _chunk_rows: usize,
        _take: &mut dyn FnMut(Chunk) -> io::Result<()>,
    ) -> io::Result<()> {
        match self.none {}
    }
}

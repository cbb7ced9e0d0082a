//! Reading of the rows of a Parquet file in chunks, for example for plots.

use crate::FilesError;
use crate::merge::record_of;
use crate::parquet::ParquetFile;
use funicular_study::table::{Chunk, Record, SweepRows};
use std::path::Path;

/// Parquet file of a sweep, opened for reading.
pub struct SweepFile {
    file: ParquetFile,
    /// Record of the sweep: robot, plan and columns.
    pub record: Record,
    /// True if the file holds all rows of its plan or part.
    pub complete: bool,
    /// Index of the first row among the rows of all parts.
    pub first_row: usize,
    /// Number of rows in the file.
    pub rows: usize,
}

impl SweepFile {
    /// Opens the file and reads its metadata.
    ///
    /// # Errors
    /// [`FilesError`]: a file that cannot be read, or that was not written by a sweep of this version.
    pub fn open(path: &Path) -> Result<Self, FilesError> {
        let file = ParquetFile::open(path)?;
        let mut record = record_of(&file, path)?;
        record.part = file.part;
        let not_ours = |reason: &str| FilesError::NotOurs { path: path.to_owned(), reason: reason.to_owned() };
        let (complete, rows) = (file.complete, file.rows);
        let range = record.range();
        if range.end > record.chunks() || rows > record.rows_of(range.clone()) {
            return Err(not_ours("it has more rows than its plan"));
        }
        let first_row = range.start * record.chunk_rows;
        Ok(Self { file, record, complete, first_row, rows })
    }

    /// File whose record is known.
    pub(crate) fn of_parts(file: ParquetFile, record: Record, complete: bool, rows: usize) -> Self {
        Self { file, record, complete, first_row: 0, rows }
    }

    /// Passes the rows to `take` in chunks, in order.
    ///
    /// # Errors
    /// [`FilesError`]: a file that is damaged, or whose columns are not those of its record.
    pub fn each(&self, mut take: impl FnMut(&Chunk)) -> Result<(), FilesError> {
        /// Rows per chunk: enough to read fast, few enough to hold in memory.
        const ROWS: usize = 4096;
        self.file
            .each(0, ROWS, &mut |chunk| {
                self.record.check(&chunk)?;
                take(&chunk);
                Ok(())
            })
            .map_err(|cause| FilesError::Read { path: self.file.path.clone(), cause })
    }
}

impl SweepRows for SweepFile {
    fn record(&self) -> &Record {
        &self.record
    }

    fn rows(&self) -> usize {
        self.rows
    }

    fn first_row(&self) -> usize {
        self.first_row
    }

    fn is_complete(&self) -> bool {
        self.complete
    }

    fn each(&self, take: &mut dyn FnMut(&Chunk)) -> anyhow::Result<()> {
        Ok(Self::each(self, take)?)
    }
}

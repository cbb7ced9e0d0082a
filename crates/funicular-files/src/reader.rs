//! Rows read back from a file, for pictures.

use crate::FilesError;
use crate::merge::record_of;
use crate::parquet::ParquetFile;
use funicular_study::sweep::{Chunk, Record, SweepRows};
use std::path::Path;

/// A Parquet file of a sweep.
pub struct SweepFile {
    file: ParquetFile,
    /// What it says of itself.
    pub record: Record,
    /// It has all rows that it is to hold.
    pub complete: bool,
    /// Place of its first row among those of all parts.
    pub first_row: usize,
    /// Rows that it has.
    pub rows: usize,
}

impl SweepFile {
    /// Opens it and reads what it says of itself.
    ///
    /// # Errors
    /// [`FilesError`]: a file that cannot be read, or that no sweep of this version has written.
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

    /// Its rows in chunks, in order.
    ///
    /// # Errors
    /// [`FilesError`]: a file that is damaged, or whose columns are not those of its record.
    pub fn each(&self, mut take: impl FnMut(&Chunk)) -> Result<(), FilesError> {
        /// Enough to read fast, few to hold.
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

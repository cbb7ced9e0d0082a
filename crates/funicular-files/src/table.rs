//! Rows in memory: what a sweep without a file ends in, and what its file is read into.

use crate::arrow::{self, Builders};
use crate::parquet::{GROUP, ParquetFile};
use crate::{FilesError, Format, Rows, journal, merge, write_whole};
use arrow_array::RecordBatch;
use arrow_schema::{ArrowError, Schema};
use funicular_study::sweep::{Chunk, Record, Values};
use std::io;
use std::path::Path;
use std::sync::Arc;

/// The rows of a sweep, with what it is.
#[derive(Debug, Clone)]
pub struct Table {
    record: Record,
    schema: Arc<Schema>,
    batches: Vec<RecordBatch>,
}

/// A [`Table`] that grows, chunk after chunk.
pub struct Growing {
    record: Record,
    schema: Arc<Schema>,
    batches: Vec<RecordBatch>,
    builders: Builders,
    filled: usize,
    next: usize,
}

impl Growing {
    /// Without rows.
    pub fn new(record: Record) -> Self {
        let (schema, builders) = (Arc::new(arrow::schema(&record)), Builders::new(&record.columns));
        let next = record.range().start;
        Self { record, schema, batches: Vec::new(), builders, filled: 0, next }
    }

    /// The first chunk that is missing.
    pub fn next(&self) -> usize {
        self.next
    }

    /// Takes the next chunk.
    ///
    /// # Errors
    /// None for chunks of this record.
    ///
    /// # Panics
    /// For any other chunk.
    pub fn add(&mut self, chunk: &Chunk) -> Result<(), ArrowError> {
        assert_eq!(chunk.index, self.next, "chunks come in order");
        self.builders.add(chunk, 0..chunk.rows());
        self.filled += chunk.rows();
        self.next += 1;
        if self.filled >= GROUP {
            self.cut()?;
        }
        Ok(())
    }

    fn cut(&mut self) -> Result<(), ArrowError> {
        if self.filled > 0 {
            self.batches.push(self.builders.finish(&self.schema)?);
            self.filled = 0;
        }
        Ok(())
    }

    /// What was added.
    ///
    /// # Errors
    /// None for chunks of this record.
    pub fn finish(mut self) -> Result<Table, ArrowError> {
        self.cut()?;
        Ok(Table { record: self.record, schema: self.schema, batches: self.batches })
    }
}

impl Table {
    /// Reads a file that a sweep has written, complete or not.
    ///
    /// # Errors
    /// [`FilesError::Read`], [`FilesError::NotOurs`].
    pub fn read(path: &Path) -> Result<Self, FilesError> {
        let file = ParquetFile::open(path)?;
        let record = Record { part: file.part, ..merge::record_of(&file, path)? };
        let mut growing = Growing::new(record);
        let (first, rows) = (growing.next, growing.record.chunk_rows);
        let read = file.each(first, rows, &mut |chunk| {
            growing.record.check(&chunk)?;
            growing.add(&chunk).map_err(io::Error::other)
        });
        read.and_then(|()| growing.finish().map_err(io::Error::other))
            .map_err(|cause| FilesError::Read { path: path.to_owned(), cause })
    }

    /// What the sweep is.
    pub fn record(&self) -> &Record {
        &self.record
    }

    /// Names, types, units.
    pub fn schema(&self) -> &Arc<Schema> {
        &self.schema
    }

    /// The rows.
    pub fn batches(&self) -> &[RecordBatch] {
        &self.batches
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.batches.iter().map(RecordBatch::num_rows).sum()
    }

    /// Every row of the plan, or of its part, is there.
    pub fn is_complete(&self) -> bool {
        self.rows() == self.record.rows_of(self.record.range())
    }

    /// One column, all rows.
    pub fn column(&self, index: usize) -> Option<Values> {
        let mut all: Option<Values> = None;
        for batch in &self.batches {
            let one = arrow::values(&batch.project(&[index]).ok()?)?.pop()?;
            match (&mut all, one) {
                (Some(Values::Real(all)), Values::Real(more)) => all.extend(more),
                (Some(Values::Flag(all)), Values::Flag(more)) => all.extend(more),
                (Some(Values::Text(all)), Values::Text(more)) => all.extend(more),
                (all, one) => *all = Some(one),
            }
        }
        all.or_else(|| self.record.columns.get(index).map(|column| Values::new(column.kind, 0)))
    }

    /// Writes the rows, as a whole or not at all; byte for byte the file that a sweep with a file writes.
    ///
    /// # Errors
    /// [`FilesError`]: a place that cannot be written, or a format that does not fit.
    pub fn write(&self, path: &Path) -> Result<(), FilesError> {
        let format = Format::of(path)?;
        crate::resumable_writer::check_place(path, format, &self.record)?;
        if format == Format::Vti && !self.is_complete() {
            let reason = "an image has no holes, and rows are missing".to_owned();
            return Err(FilesError::NoImage { path: path.to_owned(), reason });
        }
        let path = &crate::behind_link(path);
        write_whole(path, format, &self.record, self, self.is_complete()).map_err(|cause| FilesError::Write {
            path: path.clone(),
            saved: "the rows are still in memory".to_owned(),
            cause,
        })
    }
}

impl Rows for Table {
    fn each(&self, take: &mut dyn FnMut(Chunk) -> io::Result<()>) -> io::Result<()> {
        for (index, batch) in self.batches.iter().enumerate() {
            let columns =
                arrow::values(batch).ok_or_else(|| io::Error::other("a column of a kind that no sweep has"))?;
            take(Chunk { index, columns })?;
        }
        Ok(())
    }
}

/// Adds a chunk to bytes on their way to another process, with a checksum.
///
/// # Errors
/// A chunk that is too large.
pub fn pack(bytes: &mut Vec<u8>, chunk: &Chunk) -> io::Result<()> {
    journal::write_frame(bytes, &journal::encode(chunk))
}

/// The chunks of a record in bytes that [`pack`] has made.
///
/// # Errors
/// Bytes that are torn, or of another record.
pub fn unpack(mut bytes: &[u8], record: &Record) -> io::Result<Vec<Chunk>> {
    let torn = || io::Error::new(io::ErrorKind::InvalidData, "these are no whole chunks of this sweep");
    let mut chunks = Vec::new();
    while !bytes.is_empty() {
        let frame = journal::read_frame(&mut bytes)?.ok_or_else(torn)?;
        chunks.push(journal::decode(&frame, record).ok_or_else(torn)?);
    }
    Ok(chunks)
}

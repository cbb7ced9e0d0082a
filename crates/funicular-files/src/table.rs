//! Rows of a sweep in memory: the result of a sweep without a file, or the content of a file.

use crate::arrow::{self, ColumnBuilders};
use crate::parquet::ParquetFile;
use crate::{FilesError, Format, GROUP_ROWS, Rows, journal, merge, write_complete};
use arrow_array::RecordBatch;
use arrow_schema::{ArrowError, Schema};
use funicular_study::table::{Chunk, Record, Values};
use std::io;
use std::path::Path;
use std::sync::Arc;

/// Rows of a sweep together with its record (robot, plan and columns).
#[derive(Debug, Clone)]
pub struct Table {
    record: Record,
    schema: Arc<Schema>,
    batches: Vec<RecordBatch>,
}

/// Builder of a [`Table`] that takes one chunk after another.
pub struct TableBuilder {
    record: Record,
    schema: Arc<Schema>,
    batches: Vec<RecordBatch>,
    builders: ColumnBuilders,
    filled: usize,
    next: usize,
}

impl TableBuilder {
    /// Creates a table without rows.
    pub fn new(record: Record) -> Self {
        let (schema, builders) = (Arc::new(arrow::schema(&record)), ColumnBuilders::new(&record.columns));
        let next = record.range().start;
        Self { record, schema, batches: Vec::new(), builders, filled: 0, next }
    }

    /// Index of the first missing chunk.
    pub fn next(&self) -> usize {
        self.next
    }

    /// Adds the next chunk.
    ///
    /// # Errors
    /// The error of Arrow; it does not occur for chunks of this record.
    ///
    /// # Panics
    /// If `chunk` is not the next chunk.
    pub fn add(&mut self, chunk: &Chunk) -> Result<(), ArrowError> {
        assert_eq!(chunk.index, self.next, "chunks come in order");
        self.builders.add(chunk, 0..chunk.rows());
        self.filled += chunk.rows();
        self.next += 1;
        if self.filled >= GROUP_ROWS {
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

    /// Returns the table of all added rows.
    ///
    /// # Errors
    /// The error of Arrow; it does not occur for chunks of this record.
    pub fn finish(mut self) -> Result<Table, ArrowError> {
        self.cut()?;
        Ok(Table { record: self.record, schema: self.schema, batches: self.batches })
    }
}

impl Table {
    /// Reads a Parquet file of a sweep, complete or not.
    ///
    /// # Errors
    /// [`FilesError::Read`], [`FilesError::NotOurs`].
    pub fn read(path: &Path) -> Result<Self, FilesError> {
        let file = ParquetFile::open(path)?;
        let record = Record { part: file.part, ..merge::record_of(&file, path)? };
        let mut builder = TableBuilder::new(record);
        let (first, rows) = (builder.next, builder.record.chunk_rows);
        let read = file.each(first, rows, &mut |chunk| {
            builder.record.check(&chunk)?;
            builder.add(&chunk).map_err(io::Error::other)
        });
        read.and_then(|()| builder.finish().map_err(io::Error::other))
            .map_err(|cause| FilesError::Read { path: path.to_owned(), cause })
    }

    /// Record of the sweep: robot, plan and columns.
    pub fn record(&self) -> &Record {
        &self.record
    }

    /// Arrow schema with names, types and units.
    pub fn schema(&self) -> &Arc<Schema> {
        &self.schema
    }

    /// Rows as Arrow record batches.
    pub fn batches(&self) -> &[RecordBatch] {
        &self.batches
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.batches.iter().map(RecordBatch::num_rows).sum()
    }

    /// True if all rows of the plan, or of its part, are there.
    pub fn is_complete(&self) -> bool {
        self.rows() == self.record.rows_of(self.record.range())
    }

    /// Values of one column in all rows; `None` if there is no such column.
    pub fn column(&self, index: usize) -> Option<Values> {
        let mut all: Option<Values> = None;
        for batch in &self.batches {
            let one = arrow::values(&batch.project(&[index]).ok()?)?.pop()?;
            match &mut all {
                Some(all) => all.extend(&one, 0..one.len()),
                None => all = Some(one),
            }
        }
        all.or_else(|| self.record.columns.get(index).map(|column| Values::new(column.kind, 0)))
    }

    /// Writes the rows to a file that appears only when it is complete. Its bytes are those that a sweep with a file
    /// writes.
    ///
    /// # Errors
    /// [`FilesError`]: a path that cannot be written, or a format that does not fit the rows.
    pub fn write(&self, path: &Path) -> Result<(), FilesError> {
        let format = Format::of(path)?;
        crate::resumable_writer::check_place(path, format, &self.record)?;
        if format == Format::Vti && !self.is_complete() {
            let reason = "an image needs all of its values, and rows are missing".to_owned();
            return Err(FilesError::NoImage { path: path.to_owned(), reason });
        }
        let path = &crate::behind_link(path);
        write_complete(path, format, &self.record, self, self.is_complete()).map_err(|cause| FilesError::Write {
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
                arrow::values(batch).ok_or_else(|| io::Error::other("a column has a type that no sweep writes"))?;
            take(Chunk { index, columns })?;
        }
        Ok(())
    }
}

/// Appends a chunk with a checksum to bytes that go to another process.
///
/// # Errors
/// A chunk that is too large.
pub fn pack(bytes: &mut Vec<u8>, chunk: &Chunk) -> io::Result<()> {
    journal::write_frame(bytes, &journal::encode(chunk))
}

/// Reads the chunks from bytes that [`pack`] has written.
///
/// # Errors
/// Bytes that are incomplete, damaged, or of another record.
pub fn unpack(mut bytes: &[u8], record: &Record) -> io::Result<Vec<Chunk>> {
    let torn = || io::Error::new(io::ErrorKind::InvalidData, "these bytes are not complete chunks of this sweep");
    let mut chunks = Vec::new();
    while !bytes.is_empty() {
        let frame = journal::read_frame(&mut bytes)?.ok_or_else(torn)?;
        chunks.push(journal::decode(&frame, record).ok_or_else(torn)?);
    }
    Ok(chunks)
}

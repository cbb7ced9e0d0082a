//! Rows as CSV: a header, all digits, an empty field for a missing value.

use crate::Rows;
use funicular_study::table::{Chunk, Column, Record, Values};
use std::io::{self, Write};

/// Writer of chunks as CSV.
pub struct CsvRows<W: Write> {
    out: csv::Writer<W>,
}

impl<W: Write> CsvRows<W> {
    /// Writes the header.
    ///
    /// # Errors
    /// The error of `out`.
    pub fn new(out: W, columns: &[Column]) -> io::Result<Self> {
        let mut out = csv::Writer::from_writer(out);
        out.write_record(columns.iter().map(|column| column.name.as_str())).map_err(below)?;
        Ok(Self { out })
    }

    /// Adds the rows of a chunk.
    ///
    /// # Errors
    /// The error of `out`.
    pub fn add(&mut self, chunk: &Chunk) -> io::Result<()> {
        let mut number = String::new();
        for row in 0..chunk.rows() {
            for column in &chunk.columns {
                match column {
                    Values::Real(values) => {
                        number.clear();
                        if let Some(value) = values[row] {
                            use std::fmt::Write as _;
                            // `{:?}` gives the shortest text that is read back as the same number.
                            let _ = write!(number, "{value:?}");
                        }
                        self.out.write_field(number.as_bytes()).map_err(below)?;
                    }
                    Values::Flag(values) => {
                        self.out.write_field(if values[row] { "true" } else { "false" }).map_err(below)?;
                    }
                    Values::Text(values) => {
                        self.out.write_field(values[row].as_deref().unwrap_or("")).map_err(below)?;
                    }
                }
            }
            self.out.write_record(None::<&[u8]>).map_err(below)?;
        }
        Ok(())
    }

    /// Flushes `out`.
    ///
    /// # Errors
    /// The error of `out`.
    pub fn finish(mut self) -> io::Result<()> {
        self.out.flush()
    }
}

/// Error of the underlying writer with its kind, which the standard conversion of `csv::Error` loses.
fn below(error: csv::Error) -> io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => error,
        other => io::Error::other(format!("{other:?}")),
    }
}

pub(crate) fn write(out: impl Write, record: &Record, rows: &dyn Rows) -> io::Result<()> {
    let mut csv = CsvRows::new(out, &record.columns)?;
    rows.each(&mut |chunk| csv.add(&chunk))?;
    csv.finish()
}

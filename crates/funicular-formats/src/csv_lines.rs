//! CSV texts with the line numbers of their records, for messages.

use anyhow::{Result, anyhow, bail};

/// Line number of a record, from 1. It is counted here, because the position of the reader points to the end of the
/// previous record, before blank lines, and does not count all kinds of line ends.
pub fn line_at(bytes: &[u8], position: &csv::Position) -> usize {
    LineCounter::new(bytes).at(position)
}

/// Line numbers of records in ascending order, each counted on from the one before.
struct LineCounter<'a> {
    bytes: &'a [u8],
    /// Number of bytes in which the ends of lines have been counted.
    counted: usize,
    line: usize,
}

impl<'a> LineCounter<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, counted: 0, line: 1 }
    }

    fn at(&mut self, position: &csv::Position) -> usize {
        let bytes = self.bytes;
        let from = usize::try_from(position.byte()).unwrap_or(bytes.len()).min(bytes.len());
        let ends = |byte: &u8| matches!(byte, b'\r' | b'\n');
        let begin = from + bytes[from..].iter().take_while(|byte| ends(byte)).count();
        let ends_line = |i: &usize| bytes[*i] == b'\n' || (bytes[*i] == b'\r' && bytes.get(i + 1) != Some(&b'\n'));
        self.line += (self.counted..begin).filter(ends_line).count();
        self.counted = begin;
        self.line
    }
}

/// CSV text whose first line names the columns. Lines that begin with # are comments.
pub(crate) struct CsvText<'a> {
    path: &'a str,
    bytes: &'a [u8],
    reader: csv::Reader<&'a [u8]>,
    /// Names of the columns.
    pub(crate) header: Vec<String>,
}

impl<'a> CsvText<'a> {
    /// Reads the header.
    ///
    /// # Errors
    /// A text that cannot be read, or a column that is there twice.
    pub(crate) fn open(path: &'a str, bytes: &'a [u8]) -> Result<Self> {
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(bytes);
        let header = reader.headers().map_err(|error| anyhow!("cannot read {path}: {error}"))?;
        let header: Vec<String> = header.iter().map(|name| name.trim_start_matches('\u{feff}').to_owned()).collect();
        if let Some((_, twice)) = header.iter().enumerate().find(|(i, name)| header[..*i].contains(name)) {
            bail!("{path} has the column `{twice}` twice: keep one of them");
        }
        Ok(Self { path, bytes, reader, header })
    }

    /// Records below the header, each with its line in the file, from 1.
    ///
    /// # Errors
    /// A text that cannot be read, or a line with another number of values.
    pub(crate) fn records(self) -> impl Iterator<Item = Result<(usize, csv::StringRecord)>> {
        let Self { path, bytes, reader, .. } = self;
        let mut lines = LineCounter::new(bytes);
        reader.into_records().map(move |record| match record {
            Ok(record) => Ok((record.position().map_or(0, |position| lines.at(position)), record)),
            Err(error) => Err(match error.kind() {
                csv::ErrorKind::UnequalLengths { pos: Some(position), expected_len, len } => anyhow!(
                    "{path}, line {}: {len} values, but {expected_len} in the header: give all lines the same columns",
                    lines.at(position)
                ),
                _ => anyhow!("cannot read {path}: {error}"),
            }),
        })
    }
}

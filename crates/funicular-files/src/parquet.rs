//! Rows as Parquet files, with units, robot and plan in the metadata.

mod arrow_schema;
mod columns;

use crate::sealed::{self, Seal, SealingWriter};
use crate::{FilesError, Format, GROUP_ROWS, Rows};
use ::parquet::basic::Compression;
use ::parquet::errors::ParquetError;
use ::parquet::file::metadata::KeyValue;
use ::parquet::file::properties::{EnabledStatistics, WriterProperties};
use ::parquet::file::reader::{FileReader, SerializedFileReader};
use ::parquet::file::writer::SerializedFileWriter;
use ::parquet::schema::types::ColumnPath;
use funicular_study::table::{Chunk, Column, ColumnKind, Part, Record, Values};
use serde_json::Value;
use std::fs::File;
use std::io::{self, Write};
use std::path::Path;
use std::sync::Arc;

/// Keys of the file's metadata.
const PLAN: &str = "funicular.plan";
const ROBOT: &str = "funicular.robot";
const PART: &str = "funicular.part";
const COMPLETE: &str = "funicular.complete";

/// Message for a file without a checksum.
const NO_CHECKSUM: &str = "its metadata lack the checksum: another program or an older version wrote it, or it is \
                           damaged; compute it again";

/// Writes rows and the checksum of the complete file. The bytes depend only on the record and the rows.
pub(crate) fn write(out: impl Write + Send, record: &Record, rows: &dyn Rows, complete: bool) -> io::Result<()> {
    let schema = columns::schema(&record.columns).map_err(io_error)?;
    let properties = Arc::new(properties(record, complete));
    let mut writer = SerializedFileWriter::new(SealingWriter::new(out), schema, properties).map_err(io_error)?;

    // Row groups have one size, whatever the chunks' size.
    let mut group = empty(&record.columns);
    rows.each(&mut |chunk| {
        let mut from = 0;
        while from < chunk.rows() {
            let to = chunk.rows().min(from + GROUP_ROWS - group[0].len());
            for (column, values) in group.iter_mut().zip(&chunk.columns) {
                column.extend(values, from..to);
            }
            from = to;
            if group[0].len() == GROUP_ROWS {
                let full = std::mem::replace(&mut group, empty(&record.columns));
                write_group(&mut writer, &full).map_err(io_error)?;
            }
        }
        Ok(())
    })?;
    if group.first().is_some_and(|column| !column.is_empty()) {
        write_group(&mut writer, &group).map_err(io_error)?;
    }

    // The footer follows, which holds the checksum of all pages: they have to be written before.
    writer.append_key_value_metadata(KeyValue::new(sealed::KEY.to_owned(), sealed::BLANK.to_owned()));
    writer.flush()?;
    writer.inner_mut().hold();
    writer.into_inner().map_err(io_error)?.seal()
}

/// Columns without rows.
fn empty(columns: &[Column]) -> Vec<Values> {
    columns.iter().map(|column| Values::new(column.kind, 0)).collect()
}

fn write_group<W: Write + Send>(writer: &mut SerializedFileWriter<W>, group: &[Values]) -> Result<(), ParquetError> {
    let mut out = writer.next_row_group()?;
    for values in group {
        let column = out.next_column()?.expect("the schema has a field for each column");
        columns::write(column, values)?;
    }
    out.close().map(drop)
}

fn properties(record: &Record, complete: bool) -> WriterProperties {
    let mut about = vec![
        KeyValue::new(PLAN.to_owned(), record.to_json().to_string()),
        KeyValue::new(ROBOT.to_owned(), record.robot_file.clone()),
        KeyValue::new(COMPLETE.to_owned(), complete.to_string()),
    ];
    about.push(KeyValue::new(arrow_schema::KEY.to_owned(), arrow_schema::encoded(&record.columns)));
    about.extend(record.part.map(|part| KeyValue::new(PART.to_owned(), part.to_string())));

    let mut properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_created_by(format!("funicular {}", env!("CARGO_PKG_VERSION")))
        .set_max_row_group_row_count(Some(GROUP_ROWS))
        .set_statistics_enabled(EnabledStatistics::Chunk)
        .set_key_value_metadata(Some(about));

    // Results hardly ever repeat, so a dictionary would make the file larger. The coordinates in front do repeat.
    let behind = record.columns.iter().skip_while(|column| column.kind == ColumnKind::Real);
    for column in behind.filter(|column| column.kind == ColumnKind::Real) {
        properties = properties.set_column_dictionary_enabled(ColumnPath::new(vec![column.name.clone()]), false);
    }
    properties.build()
}

/// I/O error inside an error of the Parquet library, unchanged; other errors are wrapped.
fn io_error(error: ParquetError) -> io::Error {
    match error {
        ParquetError::External(inner) => match inner.downcast::<io::Error>() {
            Ok(error) => *error,
            Err(inner) => io::Error::other(inner),
        },
        error => io::Error::other(error),
    }
}

/// Parquet file written by a sweep.
pub(crate) struct ParquetFile {
    pub(crate) path: std::path::PathBuf,
    /// Record without the robot file.
    pub(crate) json: Value,
    pub(crate) robot_file: String,
    pub(crate) part: Option<Part>,
    pub(crate) complete: bool,
    pub(crate) rows: usize,
}

impl ParquetFile {
    /// Checks the file's checksum, then reads its metadata.
    pub(crate) fn open(path: &Path) -> Result<Self, FilesError> {
        let not_ours = |reason: &str| FilesError::NotOurs { path: path.to_owned(), reason: reason.to_owned() };
        let unreadable = |cause| FilesError::Read { path: path.to_owned(), cause };
        if path.is_dir() {
            return Err(unreadable(io::Error::new(io::ErrorKind::IsADirectory, "it is a directory; give the file")));
        }
        // The checksum comes first: not even the lengths in a damaged file can be trusted.
        match sealed::check(path).map_err(unreadable)? {
            Seal::Intact => {}
            Seal::Broken => return Err(FilesError::Damaged { path: path.to_owned() }),
            Seal::None => return Err(not_ours(NO_CHECKSUM)),
            Seal::NoParquet => {
                return Err(match Format::of(path) {
                    Ok(Format::Csv | Format::Vti) => FilesError::NotParquet { path: path.to_owned() },
                    _ => not_ours("it is no Parquet file, or only the beginning of a Parquet file"),
                });
            }
        }

        let file = File::open(path).map_err(unreadable)?;
        let reader = SerializedFileReader::new(file)
            .map_err(|error| not_ours(&format!("it is no Parquet file that this program can read ({error})")))?;
        let metadata = reader.metadata().file_metadata();
        let pairs = metadata.key_value_metadata();
        let get = |key: &str| {
            let pair = pairs?.iter().find(|pair| pair.key == key)?;
            pair.value.clone()
        };

        let missing = || not_ours("its metadata lack the plan");
        let json = serde_json::from_str(&get(PLAN).ok_or_else(missing)?).map_err(|_| missing())?;
        let part = get(PART).map(|part| part.parse()).transpose().map_err(|error: String| not_ours(&error))?;
        Ok(Self {
            path: path.to_owned(),
            json,
            robot_file: get(ROBOT).ok_or_else(missing)?,
            part,
            complete: get(COMPLETE).as_deref() == Some("true"),
            rows: usize::try_from(metadata.num_rows()).unwrap_or(0),
        })
    }

    /// Passes the rows to `take` in chunks of `chunk_rows` rows; the first chunk has the index `first`.
    pub(crate) fn each(
        &self,
        first: usize,
        chunk_rows: usize,
        take: &mut dyn FnMut(Chunk) -> io::Result<()>,
    ) -> io::Result<()> {
        let reader = SerializedFileReader::new(File::open(&self.path)?).map_err(io_error)?;
        let mut index = first;
        let mut chunk: Vec<Values> = Vec::new();

        for group in 0..reader.num_row_groups() {
            // A reader per column, and the kind of the column's values.
            let group = reader.get_row_group(group).map_err(io_error)?;
            let readers: Result<Vec<_>, _> = (0..group.num_columns()).map(|i| group.get_column_reader(i)).collect();
            let mut readers = readers.map_err(io_error)?;
            let kinds: Option<Vec<ColumnKind>> = readers.iter().map(columns::kind).collect();
            let kinds = kinds.ok_or_else(|| {
                io::Error::new(io::ErrorKind::InvalidData, "a column has a type that no sweep writes")
            })?;

            // Chunks may reach from one row group into the next.
            let mut left = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
            while left > 0 {
                if chunk.is_empty() {
                    chunk = kinds.iter().map(|kind| Values::new(*kind, chunk_rows)).collect();
                }
                let count = left.min(chunk_rows - chunk[0].len());
                for (reader, values) in readers.iter_mut().zip(&mut chunk) {
                    columns::read(reader, count, values).map_err(io_error)?;
                }
                left -= count;
                if chunk[0].len() == chunk_rows {
                    take(Chunk { index, columns: std::mem::take(&mut chunk) })?;
                    index += 1;
                }
            }
        }
        if chunk.is_empty() { Ok(()) } else { take(Chunk { index, columns: chunk }) }
    }
}

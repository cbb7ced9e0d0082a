//! Rows as Parquet files, with units, robot and plan in the metadata.

use crate::arrow::{self, ColumnBuilders};
use crate::sealed::{self, Seal, SealingWriter};
use crate::{FilesError, Format, Rows};
use ::parquet::arrow::ArrowWriter;
use ::parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use ::parquet::basic::Compression;
use ::parquet::errors::ParquetError;
use ::parquet::file::metadata::KeyValue;
use ::parquet::file::properties::{EnabledStatistics, WriterProperties};
use ::parquet::schema::types::ColumnPath;
use funicular_study::sweep::{Chunk, Kind, Part, Record};
use serde_json::Value;
use std::fs::File;
use std::io::{self, Write};
use std::path::Path;
use std::sync::Arc;

/// Rows per row group; this many are in memory at a time.
pub(crate) const GROUP_ROWS: usize = 1 << 16;

/// Keys of the file's metadata.
const PLAN: &str = "funicular.plan";
const ROBOT: &str = "funicular.robot";
const PART: &str = "funicular.part";
const COMPLETE: &str = "funicular.complete";

/// Message for a file without a checksum.
const NO_CHECKSUM: &str = "its metadata lack the checksum: another program or an older version wrote it, or it is damaged; \
                           compute it again";

/// Writes rows and the checksum of the complete file. The bytes depend only on the record and the rows.
pub(crate) fn write(out: impl Write + Send, record: &Record, rows: &dyn Rows, complete: bool) -> io::Result<()> {
    let schema = Arc::new(arrow::schema(record));
    let properties = properties(record, complete);
    let mut writer =
        ArrowWriter::try_new(SealingWriter::new(out), Arc::clone(&schema), Some(properties)).map_err(io_error)?;

    // Batches have one size, whatever the chunks' size: their size decides where pages begin.
    let mut group = ColumnBuilders::new(&record.columns);
    let mut filled = 0;
    rows.each(&mut |chunk| {
        let mut from = 0;
        while from < chunk.rows() {
            let to = chunk.rows().min(from + GROUP_ROWS - filled);
            group.add(&chunk, from..to);
            filled += to - from;
            from = to;
            if filled == GROUP_ROWS {
                writer.write(&group.finish(&schema).map_err(io::Error::other)?).map_err(io_error)?;
                writer.flush().map_err(io_error)?;
                filled = 0;
            }
        }
        Ok(())
    })?;
    if filled > 0 {
        writer.write(&group.finish(&schema).map_err(io::Error::other)?).map_err(io_error)?;
        writer.flush().map_err(io_error)?;
    }

    // The footer follows, which holds the checksum of all pages: they have to be written before.
    writer.append_key_value_metadata(KeyValue::new(sealed::KEY.to_owned(), sealed::BLANK.to_owned()));
    writer.sync()?;
    writer.inner_mut().hold();
    writer.into_inner().map_err(io_error)?.seal()
}

fn properties(record: &Record, complete: bool) -> WriterProperties {
    let mut about = vec![
        KeyValue::new(PLAN.to_owned(), record.to_json().to_string()),
        KeyValue::new(ROBOT.to_owned(), record.robot_file.clone()),
        KeyValue::new(COMPLETE.to_owned(), complete.to_string()),
    ];
    about.extend(record.part.map(|part| KeyValue::new(PART.to_owned(), part.to_string())));

    let mut properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_created_by(format!("funicular {}", env!("CARGO_PKG_VERSION")))
        .set_max_row_group_row_count(Some(GROUP_ROWS))
        .set_statistics_enabled(EnabledStatistics::Chunk)
        .set_key_value_metadata(Some(about));

    // Results hardly ever repeat, so a dictionary would make the file larger. The coordinates in front do repeat.
    let behind = record.columns.iter().skip_while(|column| column.kind == Kind::Real);
    for column in behind.filter(|column| column.kind == Kind::Real) {
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
        let reader = ParquetRecordBatchReaderBuilder::try_new(file)
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
        let file = File::open(&self.path)?;
        let reader = ParquetRecordBatchReaderBuilder::try_new(file).map_err(io_error)?;
        let reader = reader.with_batch_size(chunk_rows).build().map_err(io_error)?;
        for (i, batch) in reader.enumerate() {
            let batch = batch.map_err(io::Error::other)?;
            let columns = arrow::values(&batch).ok_or_else(|| {
                io::Error::new(io::ErrorKind::InvalidData, "a column has a type that no sweep writes")
            })?;
            take(Chunk { index: first + i, columns })?;
        }
        Ok(())
    }
}

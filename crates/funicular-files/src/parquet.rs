//! Rows as Parquet, with units, robot and plan.

use crate::arrow::{self, Builders};
use crate::sealed::{self, Seal, Sealing};
use crate::{FilesError, Format, Rows};
use ::parquet::arrow::ArrowWriter;
use ::parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use ::parquet::basic::Compression;
use ::parquet::errors::ParquetError;
use ::parquet::file::metadata::KeyValue;
use ::parquet::file::properties::{EnabledStatistics, WriterProperties};
use ::parquet::schema::types::ColumnPath;
use funicular_study::sweep::{Chunk, ColumnKind, Part, Record};
use serde_json::Value;
use std::fs::File;
use std::io::{self, Write};
use std::path::Path;
use std::sync::Arc;

/// Rows of a group: what is in memory at a time.
pub(crate) const GROUP: usize = 1 << 16;

/// Keys of the file's metadata.
const PLAN: &str = "funicular.plan";
const ROBOT: &str = "funicular.robot";
const PART: &str = "funicular.part";
const COMPLETE: &str = "funicular.complete";

/// Why a file without a checksum is not read.
const NO_CHECKSUM: &str = "its metadata lack the checksum: another program or an older version wrote it, or it is damaged; \
                           compute it again";

/// Writes rows, and the checksum of the whole file; the bytes depend on record and rows alone.
pub(crate) fn write(out: impl Write + Send, record: &Record, rows: &dyn Rows, complete: bool) -> io::Result<()> {
    let schema = Arc::new(arrow::schema(record));
    let properties = properties(record, complete);
    let mut writer = ArrowWriter::try_new(Sealing::new(out), Arc::clone(&schema), Some(properties)).map_err(other)?;

    // Batches of one size, however rows come: they decide where pages begin.
    let mut group = Builders::new(&record.columns);
    let mut filled = 0;
    rows.each(&mut |chunk| {
        let mut from = 0;
        while from < chunk.rows() {
            let to = chunk.rows().min(from + GROUP - filled);
            group.add(&chunk, from..to);
            filled += to - from;
            from = to;
            if filled == GROUP {
                writer.write(&group.finish(&schema).map_err(io::Error::other)?).map_err(other)?;
                writer.flush().map_err(other)?;
                filled = 0;
            }
        }
        Ok(())
    })?;
    if filled > 0 {
        writer.write(&group.finish(&schema).map_err(io::Error::other)?).map_err(other)?;
        writer.flush().map_err(other)?;
    }

    // What follows is the footer, which holds the checksum: the pages have to be out before.
    writer.append_key_value_metadata(KeyValue::new(sealed::KEY.to_owned(), sealed::BLANK.to_owned()));
    writer.sync()?;
    writer.inner_mut().hold();
    writer.into_inner().map_err(other)?.seal()
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
        .set_max_row_group_row_count(Some(GROUP))
        .set_statistics_enabled(EnabledStatistics::Chunk)
        .set_key_value_metadata(Some(about));
    // Results repeat nowhere; a dictionary of them all would make the file larger.
    let behind = record.columns.iter().skip_while(|column| column.kind == ColumnKind::Real);
    for column in behind.filter(|column| column.kind == ColumnKind::Real) {
        properties = properties.set_column_dictionary_enabled(ColumnPath::new(vec![column.name.clone()]), false);
    }
    properties.build()
}

/// What went wrong below, as it was.
fn other(error: ParquetError) -> io::Error {
    match error {
        ParquetError::External(inner) => match inner.downcast::<io::Error>() {
            Ok(error) => *error,
            Err(inner) => io::Error::other(inner),
        },
        error => io::Error::other(error),
    }
}

/// A file that a sweep has written.
pub(crate) struct ParquetFile {
    pub(crate) path: std::path::PathBuf,
    /// All of its record but the robot.
    pub(crate) json: Value,
    pub(crate) robot_file: String,
    pub(crate) part: Option<Part>,
    pub(crate) complete: bool,
    pub(crate) rows: usize,
}

impl ParquetFile {
    /// Reads what the file says of itself, once its checksum has shown that it is as it was written.
    pub(crate) fn open(path: &Path) -> Result<Self, FilesError> {
        let not_ours = |reason: &str| FilesError::NotOurs { path: path.to_owned(), reason: reason.to_owned() };
        let unreadable = |cause| FilesError::Read { path: path.to_owned(), cause };
        if path.is_dir() {
            return Err(unreadable(io::Error::new(io::ErrorKind::IsADirectory, "it is a directory; give the file")));
        }
        // Nothing of a damaged file is decoded: not even its lengths are to be believed.
        match sealed::check(path).map_err(unreadable)? {
            Seal::Whole => {}
            Seal::Broken => return Err(FilesError::Damaged { path: path.to_owned() }),
            Seal::None => return Err(not_ours(NO_CHECKSUM)),
            Seal::NoParquet => {
                return Err(match Format::of(path) {
                    Ok(Format::Csv | Format::Vti) => FilesError::NotParquet { path: path.to_owned() },
                    _ => not_ours("it is no Parquet file, or only the beginning of one"),
                });
            }
        }
        let file = File::open(path).map_err(unreadable)?;
        let reader = ParquetRecordBatchReaderBuilder::try_new(file)
            .map_err(|error| not_ours(&format!("it is no Parquet file that this program reads ({error})")))?;
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

    /// Its rows in chunks of a size, the first with this index.
    pub(crate) fn each(
        &self,
        first: usize,
        chunk_rows: usize,
        take: &mut dyn FnMut(Chunk) -> io::Result<()>,
    ) -> io::Result<()> {
        let file = File::open(&self.path)?;
        let reader = ParquetRecordBatchReaderBuilder::try_new(file).map_err(other)?;
        let reader = reader.with_batch_size(chunk_rows).build().map_err(other)?;
        for (i, batch) in reader.enumerate() {
            let batch = batch.map_err(io::Error::other)?;
            let columns = arrow::values(&batch)
                .ok_or_else(|| io::Error::new(io::ErrorKind::InvalidData, "a column of a kind that no sweep writes"))?;
            take(Chunk { index: first + i, columns })?;
        }
        Ok(())
    }
}

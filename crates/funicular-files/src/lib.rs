//! Files of funicular: the results of maps and sweeps.
//!
//! A [`Job`] takes the [chunks](funicular_study::table::Chunk) of a [plan](funicular_study::sweep::Plan) in order and
//! appends them to a [journal](Job) beside the file. A run that was interrupted, killed or lost its power can therefore
//! be continued. The file itself is written from the journal when all chunks are there, and appears only when it is
//! complete. Parquet, CSV and VTK files hold the same rows.
//!
//! The feature `parquet`, on by default, adds Parquet files. Without it the crate writes CSV and VTK and refuses
//! Parquet files with a message. The feature `arrow` adds rows in memory in the format of Apache Arrow, `Table`.

#[cfg(feature = "arrow")]
pub mod arrow;
pub mod atomic_file;
mod csv;
pub mod endings;
pub mod fmu;
mod guard;
mod journal;
pub mod mat;
mod merge;
mod mesh_files;
#[cfg(feature = "parquet")]
mod parquet;
#[cfg(not(feature = "parquet"))]
#[path = "without_parquet.rs"]
mod parquet;
mod proof;
mod reader;
mod resumable_writer;
#[cfg(feature = "parquet")]
mod sealed;
#[cfg(feature = "arrow")]
pub mod table;
pub mod threads;
mod uncertainty;
mod vti;
mod workspace;

/// Checksum of a file: the CRC-32 of a journal's frames.
pub use crc32fast::Hasher as Checksum;
pub use guard::Guard;
pub use merge::merge;
pub use mesh_files::beside;
pub use proof::ProofRun;
pub use reader::SweepFile;
pub use resumable_writer::{Begin, Job, Opened};
#[cfg(feature = "arrow")]
pub use table::Table;
pub use threads::Outcome;
pub use uncertainty::{UncertaintyOutcome, UncertaintyRun};
pub use workspace::{WorkspaceOutcome, WorkspaceRun};

use endings::Kind;
use funicular_study::columns::ResultTable;
use funicular_study::table::{Chunk, Record, RecordDifference, Values};
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;
use thiserror::Error;

/// Reason why a file of a sweep cannot be read or written. Messages name options by their keys between ⟪ and ⟫, for
/// [`worded`](funicular_study::wording::worded).
#[derive(Debug, Error)]
pub enum FilesError {
    /// The ending of a file stands for no format of rows.
    #[error("the ending of {} names no format: choose .parquet, .csv or .vti (for ParaView)", .path.display())]
    Ending {
        /// The file.
        path: PathBuf,
    },
    /// The ending of a file stands for another kind of content than the one to be written.
    #[error(
        "{} would hold {written}, and .{ending} means {means}; choose a name that ends in {fitting}",
        .path.display()
    )]
    OtherEnding {
        /// The file.
        path: PathBuf,
        /// Content to be written, in words.
        written: String,
        /// Ending of the file, without the dot.
        ending: String,
        /// Meaning of the ending, in words.
        means: &'static str,
        /// Endings that fit.
        fitting: String,
    },
    /// A file to be written is also read, or is written twice.
    #[error("{0}")]
    Clash(String),
    /// Results cannot be written to this path.
    #[error("cannot write to {}: {reason}", .path.display())]
    Place {
        /// The file.
        path: PathBuf,
        /// Reason.
        reason: String,
    },
    /// The rows were computed, but writing them failed.
    #[error("cannot write {}: {}; {saved}", .path.display(), io_reason(.cause))]
    Write {
        /// The file.
        path: PathBuf,
        /// Work that is safe, and the next step.
        saved: String,
        /// Error of the system.
        cause: io::Error,
    },
    /// A file cannot be read.
    #[error("cannot read {}: {}", .path.display(), io_reason(.cause))]
    Read {
        /// The file.
        path: PathBuf,
        /// Error of the system.
        cause: io::Error,
    },
    /// An earlier run left a journal, and the caller chose neither to continue nor to discard it.
    #[error(
        "{} holds {done} of {rows} rows of an unfinished run: continue with ⟪resume⟫, or start again with ⟪discard⟫",
        .journal.display()
    )]
    Unfinished {
        /// The journal.
        journal: PathBuf,
        /// Rows in the journal.
        done: usize,
        /// Rows of the request.
        rows: usize,
    },
    /// The file at the journal's path is no journal.
    #[error(
        "{} is no journal of funicular that this version can read: move it away, or start again with ⟪discard⟫",
        .path.display()
    )]
    NoJournal {
        /// The file.
        path: PathBuf,
    },
    /// Another process writes the journal.
    #[error("another run is writing {}: wait for it, or choose another file", .path.display())]
    Locked {
        /// The journal.
        path: PathBuf,
    },
    /// A file or journal belongs to another sweep.
    #[error("{} belongs to another sweep: {difference}; {advice}", .path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
        /// Difference between the two sweeps.
        difference: RecordDifference,
        /// Next step for the user.
        advice: &'static str,
    },
    /// The checksum of a file does not match its bytes.
    #[error(
        "{} is damaged, or another program has rewritten it: its checksum does not match its bytes; copy it again from \
         an intact copy, or remove it and compute it again",
        .path.display()
    )]
    Damaged {
        /// The file.
        path: PathBuf,
    },
    /// A file lacks data that a sweep writes.
    #[error("{} was not written by a sweep of funicular: {reason}", .path.display())]
    NotOurs {
        /// The file.
        path: PathBuf,
        /// The missing or wrong data.
        reason: String,
    },
    /// The format of a file keeps the rows only, without robot and plan.
    #[error(
        "{} holds only rows, without robot and plan: write the sweep to a .parquet file and use that file",
        .path.display()
    )]
    NotParquet {
        /// The file.
        path: PathBuf,
    },
    /// A Parquet file was requested from a build without the feature `parquet`.
    #[error(
        "cannot read or write {}: this program was built without Parquet files; write .csv or .vti, or build it with \
         the feature parquet, which is on by default",
        .path.display()
    )]
    WithoutParquet {
        /// The file.
        path: PathBuf,
    },
    /// The rows do not form an image for ParaView.
    #[error("{}: {reason}; write .parquet or .csv", .path.display())]
    NoImage {
        /// The file.
        path: PathBuf,
        /// Reason.
        reason: String,
    },
    /// The given parts are not exactly the parts of one sweep.
    #[error("{0}")]
    Parts(String),
}

/// Error of the system in words; plain words where the system's own are hard to understand.
fn io_reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::StorageFull => "the disk is full".to_owned(),
        io::ErrorKind::QuotaExceeded => "the disk quota is used up".to_owned(),
        _ => error.to_string(),
    }
}

/// Advice for the time before the next attempt.
fn to_do(error: &io::Error) -> &'static str {
    match error.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => "make room",
        _ => "fix the cause",
    }
}

/// A format of rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Apache Parquet: columns with units, robot and plan in the file.
    Parquet,
    /// Comma-separated text with all digits.
    Csv,
    /// VTK image of a grid, for ParaView.
    Vti,
}

impl Format {
    /// Format that the ending of a file stands for.
    ///
    /// # Errors
    /// [`FilesError::Ending`] for any other ending, [`FilesError::WithoutParquet`] for `.parquet` without the feature.
    pub fn of(path: &Path) -> Result<Self, FilesError> {
        match Kind::of(path) {
            Some(Kind::Parquet) if cfg!(not(feature = "parquet")) => {
                Err(FilesError::WithoutParquet { path: path.to_owned() })
            }
            Some(Kind::Parquet) => Ok(Self::Parquet),
            Some(Kind::Csv) => Ok(Self::Csv),
            Some(Kind::Vti) => Ok(Self::Vti),
            _ => Err(FilesError::Ending { path: path.to_owned() }),
        }
    }
}

/// Source of rows in chunks that can be read several times.
trait Rows {
    /// Passes every chunk to `take`, in order.
    fn each(&self, take: &mut dyn FnMut(Chunk) -> io::Result<()>) -> io::Result<()>;
}

/// Rows per row group of a Parquet file and per batch of a table in memory.
#[cfg(any(feature = "arrow", feature = "parquet"))]
const GROUP_ROWS: usize = 1 << 16;

/// Time that a run which was stopped has for the file of its finished rows: clusters kill a job soon after they ask it
/// to end.
pub const WRITE_WITHIN: Duration = Duration::from_millis(800);

/// Ending added to the name of a file of rows for the journal of an unfinished run.
const JOURNAL: &str = ".partial";

/// Ending added to the name of a file of rows for the new file while it is written.
const NEW: &str = ".writing";

/// Writes rows to a file that appears only when it is complete. Until then the rows are in `FILE.writing`.
fn write_complete(path: &Path, format: Format, record: &Record, rows: &dyn Rows, all_rows: bool) -> io::Result<()> {
    atomic_file::write_locked(path, &with_ending(path, NEW), |file| {
        let out = io::BufWriter::with_capacity(1 << 20, file);
        match format {
            Format::Parquet => parquet::write(out, record, rows, all_rows),
            Format::Csv => csv::write(out, record, rows),
            Format::Vti => vti::write(out, record, rows),
        }
    })
}

/// Target of a symbolic link, because the file is replaced and not the link. Any other path is returned unchanged.
fn behind_link(path: &Path) -> PathBuf {
    if path.is_symlink() { path.canonicalize().unwrap_or_else(|_| path.to_owned()) } else { path.to_owned() }
}

/// Path with `ending` appended to the file name.
fn with_ending(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(ending);
    name.into()
}

/// Rows of a result as the bytes of a Parquet file, whose metadata name the command.
///
/// # Errors
/// [`io::ErrorKind::Unsupported`] without the feature `parquet`.
pub fn parquet_of_result(command: &str, ResultTable { columns, rows }: ResultTable<'_>) -> io::Result<Vec<u8>> {
    let mut values: Vec<Values> = columns.iter().map(|column| Values::new(column.kind, 0)).collect();
    for row in rows {
        for (values, cell) in values.iter_mut().zip(row) {
            cell.add_to(values);
        }
    }
    let chunk = Chunk { index: 0, columns: values };
    let rows = chunk.rows();
    let plan = [("command".to_owned(), command.into())].into_iter().collect();
    let record = Record { robot_file: String::new(), plan, columns, rows, chunk_rows: rows, part: None };
    let mut bytes = Vec::new();
    parquet::write(&mut bytes, &record, &OneChunk(chunk), true)?;
    Ok(bytes)
}

/// Rows of a single chunk.
struct OneChunk(Chunk);

impl Rows for OneChunk {
    fn each(&self, take: &mut dyn FnMut(Chunk) -> io::Result<()>) -> io::Result<()> {
        take(self.0.clone())
    }
}

pub use csv::CsvRows;

/// Example of README.md, which is tested like those of the documentation.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

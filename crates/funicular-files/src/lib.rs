//! Files of funicular: the results of maps and sweeps.
//!
//! A [`Job`] takes the [chunks](funicular_study::sweep::Chunk) of a [plan](funicular_study::sweep::Plan) in order. They go to a
//! [journal](Job) beside the file first, so that a run that ends by any means can go on; the file itself is written from it
//! as a whole. Parquet, CSV and VTK hold the same rows; `arrow::batch` gives them in memory.
//!
//! The feature `parquet`, on by default, brings Parquet files and rows in memory. Without it the crate writes CSV and VTK, and
//! refuses Parquet files with a message.

#[cfg(feature = "parquet")]
pub mod arrow;
pub mod atomic_file;
mod csv;
pub mod endings;
mod guard;
mod journal;
mod merge;
#[cfg(feature = "parquet")]
mod parquet;
#[cfg(not(feature = "parquet"))]
#[path = "without_parquet.rs"]
mod parquet;
mod reader;
mod resumable_writer;
#[cfg(feature = "parquet")]
mod sealed;
#[cfg(feature = "parquet")]
pub mod table;
pub mod threads;
mod vti;

pub use guard::Guard;
pub use merge::merge;
pub use reader::SweepFile;
pub use resumable_writer::{Begin, Job, Opened};
#[cfg(feature = "parquet")]
pub use table::Table;
pub use threads::Outcome;

use endings::Kind;
use funicular_study::sweep::{Chunk, Record, RecordDifference};
use std::fs::{self, OpenOptions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Why a file of a sweep cannot be read or written. A message names options by their keys between ⟪ and ⟫, for
/// [`worded`](funicular_study::wording::worded).
#[derive(Debug, Error)]
pub enum FilesError {
    /// The ending of a file says no format.
    #[error("the ending of {} names no format: .parquet, .csv or .vti (for ParaView)", .path.display())]
    Ending {
        /// The file.
        path: PathBuf,
    },
    /// A file of text whose ending says that it is something else.
    #[error("{} would hold {written}, and .{ending} means {means}; choose a name that ends in {fitting}", .path.display())]
    OtherEnding {
        /// The file.
        path: PathBuf,
        /// What would be written into it, in words.
        written: String,
        /// Its ending, without the dot.
        ending: String,
        /// The meaning of the ending, in words.
        means: &'static str,
        /// The endings that fit.
        fitting: String,
    },
    /// A file that would be written over one that is read, or over another that is written.
    #[error("{0}")]
    Clash(String),
    /// A place that results cannot be written to.
    #[error("cannot write to {}: {reason}", .path.display())]
    Place {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// The rows are there, but writing them failed.
    #[error("cannot write {}: {}; {saved}", .path.display(), told(.cause))]
    Write {
        /// The file.
        path: PathBuf,
        /// What is safe, and what to do.
        saved: String,
        /// What the system says.
        cause: io::Error,
    },
    /// A file that cannot be read.
    #[error("cannot read {}: {}", .path.display(), told(.cause))]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        cause: io::Error,
    },
    /// Work in the way.
    #[error(
        "{} holds {done} of {rows} rows of a run that did not end: go on with ⟪resume⟫, or begin anew with ⟪discard⟫",
        .journal.display()
    )]
    Unfinished {
        /// The journal.
        journal: PathBuf,
        /// Rows that it has.
        done: usize,
        /// Rows that were asked for.
        rows: usize,
    },
    /// A file that is no journal where one would be.
    #[error("{} is no journal of funicular that this version can read: move it away, or begin anew with ⟪discard⟫", .path.display())]
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
    /// A file or journal of something else.
    #[error("{} belongs to another sweep: {difference}; {advice}", .path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
        /// What differs.
        difference: RecordDifference,
        /// What to do.
        advice: &'static str,
    },
    /// A file whose bytes are not those that were written.
    #[error(
        "{} is damaged, or another program has written it anew: its checksum is not that of its bytes; copy it again \
         from where it is whole, or remove it and compute it again",
        .path.display()
    )]
    Damaged {
        /// The file.
        path: PathBuf,
    },
    /// A file without what a sweep writes into it.
    #[error("{} was not written by a sweep of funicular: {reason}", .path.display())]
    NotOurs {
        /// The file.
        path: PathBuf,
        /// What is missing or wrong.
        reason: String,
    },
    /// Rows in a format that does not say what they are.
    #[error("{} holds rows alone, without robot and plan: write the sweep to a .parquet file and give that", .path.display())]
    NotParquet {
        /// The file.
        path: PathBuf,
    },
    /// A Parquet file, and a build without the feature `parquet`.
    #[error(
        "cannot read or write {}: this program was built without Parquet files; write .csv or .vti, or build it with \
         the feature parquet, which is on by default",
        .path.display()
    )]
    WithoutParquet {
        /// The file.
        path: PathBuf,
    },
    /// A grid that ParaView's images do not have.
    #[error("{}: {reason}; write .parquet or .csv", .path.display())]
    NoImage {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// Parts that do not make a whole.
    #[error("{0}")]
    Parts(String),
}

/// What the system says, in words where they help.
fn told(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::StorageFull => "the disk is full".to_owned(),
        io::ErrorKind::QuotaExceeded => "the disk quota is used up".to_owned(),
        _ => error.to_string(),
    }
}

/// What to do about it before another try.
fn to_do(error: &io::Error) -> &'static str {
    match error.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => "make room",
        _ => "mend that",
    }
}

/// A format of rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Columns with units, robot and plan in the file.
    Parquet,
    /// Text, every digit.
    Csv,
    /// An image for ParaView, of a grid.
    Vti,
}

impl Format {
    /// By the ending of a file.
    ///
    /// # Errors
    /// [`FilesError::Ending`] for any other, [`FilesError::WithoutParquet`] for `.parquet` without the feature.
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

/// Rows in chunks, as often as they are asked for.
trait Rows {
    /// Every chunk in order.
    fn each(&self, take: &mut dyn FnMut(Chunk) -> io::Result<()>) -> io::Result<()>;
}

/// Behind the name of a file of rows: the journal of a run that has not ended.
const JOURNAL: &str = ".partial";

/// Behind the name of a file of rows: the file that will take its place.
const NEW: &str = ".writing";

/// Writes rows to a file, as a whole or not at all. Until then they are in `FILE.writing`: a name that the next try takes
/// over, so that nothing is left of a run that was killed here.
fn write_whole(path: &Path, format: Format, record: &Record, rows: &dyn Rows, complete: bool) -> io::Result<()> {
    let beside = with_ending(path, NEW);
    let file = OpenOptions::new().write(true).create(true).truncate(false).open(&beside)?;
    if let Err(TryLockError::WouldBlock) = file.try_lock() {
        return Err(io::Error::new(io::ErrorKind::ResourceBusy, "another run is writing it"));
    }
    let write = || {
        file.set_len(0)?;
        let out = io::BufWriter::with_capacity(1 << 20, &file);
        match format {
            Format::Parquet => parquet::write(out, record, rows, complete)?,
            Format::Csv => csv::write(out, record, rows)?,
            Format::Vti => vti::write(out, record, rows)?,
        }
        if let Ok(metadata) = fs::metadata(path) {
            file.set_permissions(metadata.permissions())?;
        }
        // The journal goes once the file is there: it has to be on the disk by then.
        file.sync_data()?;
        fs::rename(&beside, path)
    };
    write().inspect_err(|_| drop(fs::remove_file(&beside)))
}

/// Through a symbolic link to the file it stands for: that one is to be replaced, not the link. Any other path is as the
/// user gave it.
fn behind_link(path: &Path) -> PathBuf {
    if path.is_symlink() { path.canonicalize().unwrap_or_else(|_| path.to_owned()) } else { path.to_owned() }
}

/// The name of a file with more behind it.
fn with_ending(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(ending);
    name.into()
}

pub use csv::CsvRows;

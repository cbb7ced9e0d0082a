//! Writing of one file of rows that may take several runs: journal, continuation and completion.

use crate::atomic_file::{TemporaryFile, is_read_only, is_regular_or_new};
use crate::journal::{self, Found, Journal};
use crate::parquet::ParquetFile;
use crate::{FilesError, Format, Rows, behind_link, vti, with_ending, write_complete};
use funicular_study::table::{Chunk, Record, RecordDifference};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Treatment of the work of an earlier run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Begin {
    /// Refuse to start if an earlier run left work.
    Anew,
    /// Continue the earlier run.
    Resume,
    /// Discard the work of the earlier run.
    Discard,
}

impl Begin {
    /// Treatment that two options ask for; to resume goes first.
    pub fn of(resume: bool, discard: bool) -> Self {
        match (resume, discard) {
            (true, _) => Self::Resume,
            (_, true) => Self::Discard,
            _ => Self::Anew,
        }
    }
}

/// File of rows that is being written.
pub struct Job {
    path: PathBuf,
    format: Format,
    journal: Journal,
}

/// Result of opening the file of a sweep.
pub enum Opened {
    /// Chunks are missing: compute them from [`Job::next`] on.
    Work(Box<Job>),
    /// The file is already the complete result of this plan.
    Done,
}

impl Job {
    /// Opens the file of a sweep: checks that it can be written, looks for the work of an earlier run, and locks the
    /// journal.
    ///
    /// The journal is `FILE.partial`. With [`Begin::Resume`] its chunks are kept, and an incomplete frame at its end is
    /// cut off.
    ///
    /// # Errors
    /// [`FilesError`]: a path that cannot be written, a format that does not fit the rows, work of an earlier run with
    /// [`Begin::Anew`], or work of another sweep.
    pub fn open(path: &Path, record: Record, begin: Begin) -> Result<Opened, FilesError> {
        let path = &behind_link(path);
        let format = Format::of(path)?;
        check_place(path, format, &record)?;
        let partial = with_ending(path, crate::JOURNAL);
        if begin == Begin::Resume
            && !partial.exists()
            && path.exists()
            && format == Format::Parquet
            && is_done(path, &record)?
        {
            return Ok(Opened::Done);
        }
        let journal = open_journal(&partial, record, begin)?;
        Ok(Opened::Work(Box::new(Self { path: path.clone(), format, journal })))
    }

    /// Index of the first missing chunk.
    pub fn next(&self) -> usize {
        self.journal.next
    }

    /// Number of rows in the journal.
    pub fn done(&self) -> usize {
        self.journal.done()
    }

    /// Path of the journal.
    pub fn journal(&self) -> &Path {
        &self.journal.path
    }

    /// Passes every chunk of the journal to `take`, in order.
    ///
    /// # Errors
    /// [`FilesError::Read`].
    pub fn each(&self, take: &mut dyn FnMut(Chunk)) -> Result<(), FilesError> {
        let each = self.journal.each(&mut |chunk| {
            take(chunk);
            Ok(())
        });
        each.map_err(|cause| FilesError::Read { path: self.journal.path.clone(), cause })
    }

    /// Adds the next chunk to the journal.
    ///
    /// # Errors
    /// [`FilesError::Write`], with the number of rows that are safe.
    ///
    /// # Panics
    /// If `chunk` is not the next chunk.
    pub fn add(&mut self, chunk: &Chunk) -> Result<(), FilesError> {
        self.journal.add(chunk).map_err(|source| self.failed(&self.journal.path, source))
    }

    /// Writes the complete file and removes the journal.
    ///
    /// # Errors
    /// [`FilesError::Write`]; the journal stays.
    ///
    /// # Panics
    /// If chunks are missing.
    pub fn finish(mut self) -> Result<(), FilesError> {
        assert_eq!(self.next(), self.journal.record().range().end, "all chunks are there");
        self.journal.sync().map_err(|source| self.failed(&self.journal.path, source))?;
        write_complete(&self.path, self.format, self.journal.record(), &self.journal, true)
            .map_err(|source| self.failed(&self.path, source))?;
        // The result is written: a journal that cannot be removed is no loss.
        let _ = fs::remove_file(&self.journal.path);
        Ok(())
    }

    /// Writes the rows computed so far if that takes no longer than `within`, keeps the journal, and returns a sentence
    /// on where the rows are. A continued run writes the file in any case.
    ///
    /// A complete Parquet file is not replaced. An existing .csv file is not replaced either, because it cannot show
    /// whether it is complete. An image is not written, because it needs all of its values.
    ///
    /// # Errors
    /// [`FilesError::Write`]; the journal stays.
    pub fn interrupt(mut self, within: Duration) -> Result<String, FilesError> {
        let begin = Instant::now();
        self.journal.sync().map_err(|source| self.failed(&self.journal.path, source))?;
        let replaces_nothing = match self.format {
            Format::Parquet => !self.path.exists() || ParquetFile::open(&self.path).is_ok_and(|file| !file.complete),
            Format::Csv => !self.path.exists(),
            Format::Vti => false,
        };
        if !replaces_nothing || self.done() == 0 {
            return Ok(self.safe());
        }
        let rows = InTime { rows: &self.journal, begin, within };
        match write_complete(&self.path, self.format, self.journal.record(), &rows, false) {
            Err(error) if error.kind() == io::ErrorKind::TimedOut => return Ok(self.safe()),
            written => written.map_err(|source| self.failed(&self.path, source))?,
        }
        let mark = match self.format {
            Format::Csv => "which cannot show that it is incomplete",
            Format::Parquet | Format::Vti => "marked as incomplete",
        };
        Ok(format!("{}; they are also in {}, {mark}", self.safe(), self.path.display()))
    }

    /// Sentence on the rows in the journal.
    fn safe(&self) -> String {
        let rows = self.journal.record().rows_of(self.journal.record().range());
        format!("{} of {rows} rows are safe in {}", self.done(), self.journal.path.display())
    }

    fn failed(&self, path: &Path, cause: io::Error) -> FilesError {
        let saved = format!("{}: {}, then continue with ⟪resume⟫", self.safe(), crate::to_do(&cause));
        FilesError::Write { path: path.to_owned(), saved, cause }
    }
}

/// Rows of which reading ends with an error when its time is over.
struct InTime<'a> {
    rows: &'a dyn Rows,
    begin: Instant,
    within: Duration,
}

impl Rows for InTime<'_> {
    fn each(&self, take: &mut dyn FnMut(Chunk) -> io::Result<()>) -> io::Result<()> {
        self.rows.each(&mut |chunk| {
            if self.begin.elapsed() >= self.within {
                return Err(io::ErrorKind::TimedOut.into());
            }
            take(chunk)
        })
    }
}

/// Checks that a file can be written at `path`, and that the rows fit the format.
pub(crate) fn check_place(path: &Path, format: Format, record: &Record) -> Result<(), FilesError> {
    let place = |reason: String| FilesError::Place { path: path.to_owned(), reason };
    if path.is_dir() {
        return Err(place("it is a directory; add a file name".to_owned()));
    }
    if !is_regular_or_new(path) {
        return Err(place("it is no regular file; name a regular file, or leave out ⟪output_file⟫".to_owned()));
    }
    if is_read_only(path) {
        return Err(place("it is read-only".to_owned()));
    }
    TemporaryFile::beside(path).map_err(|error| place(crate::io_reason(&error)))?;
    if format == Format::Vti {
        vti::check(record).map_err(|reason| FilesError::NoImage { path: path.to_owned(), reason })?;
    }
    if record.part.is_some() && format != Format::Parquet {
        return Err(place(
            "a part has to be a .parquet file, because only this format records the part's number".to_owned(),
        ));
    }
    Ok(())
}

/// True if the file is already the complete result.
fn is_done(path: &Path, record: &Record) -> Result<bool, FilesError> {
    let file = ParquetFile::open(path)?;
    let other_part =
        || RecordDifference::of_values("part", &journal::shown_part(file.part), &journal::shown_part(record.part));
    if let Some(difference) = record.difference(&file.json, &file.robot_file).or_else(other_part) {
        let advice = "choose another file, or replace this one without ⟪resume⟫";
        return Err(FilesError::Foreign { path: path.to_owned(), difference, advice });
    }
    Ok(file.complete && file.rows == record.rows_of(record.range()))
}

fn open_journal(partial: &Path, record: Record, begin: Begin) -> Result<Journal, FilesError> {
    let path = || partial.to_owned();
    let unreadable = |cause| FilesError::Read { path: path(), cause };
    let unwritable = |source| FilesError::Place { path: path(), reason: crate::io_reason(&source) };
    let file = Journal::lock(partial)?;
    let found = match begin {
        Begin::Discard => Found::Nothing,
        Begin::Anew | Begin::Resume => journal::inspect(&file, &record).map_err(unreadable)?,
    };

    match found {
        Found::Nothing => Journal::begin(partial, file, record).map_err(|source| {
            // The new journal holds no rows yet.
            let _ = fs::remove_file(partial);
            unwritable(source)
        }),
        Found::Foreign => Err(FilesError::NoJournal { path: path() }),
        Found::Chunks { difference: Some(difference), .. } => {
            let advice = "choose another file, or start again with ⟪discard⟫";
            Err(FilesError::Foreign { path: path(), difference, advice })
        }
        Found::Chunks { done, rows, .. } if begin == Begin::Anew => {
            Err(FilesError::Unfinished { journal: path(), done, rows })
        }
        Found::Chunks { end, next, .. } => Journal::resume(partial, file, record, end, next).map_err(unwritable),
    }
}

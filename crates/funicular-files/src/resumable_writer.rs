//! One file of rows from the first chunk to the last, over as many runs as it takes.

use crate::atomic_file::{Temporary, is_regular_or_new};
use crate::journal::{self, Found, Journal};
use crate::parquet::ParquetFile;
use crate::{FilesError, Format, Rows, behind_link, vti, with_ending, write_whole};
use funicular_study::sweep::{Chunk, Record, RecordDifference};
use std::fs;
use std::path::{Path, PathBuf};

/// What to do about an earlier run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Begin {
    /// Refuse to lose its work.
    Anew,
    /// Go on with it.
    Resume,
    /// Forget it.
    Discard,
}

/// A file that is being made.
pub struct Job {
    path: PathBuf,
    format: Format,
    journal: Journal,
}

/// What there is to do.
pub enum Opened {
    /// Chunks to compute, from [`Job::next`] on.
    Work(Box<Job>),
    /// Nothing: the file is the whole result of this plan.
    Done,
}

impl Job {
    /// Opens the file of a sweep: checks that it can be written, finds what an earlier run has left, and keeps others out.
    ///
    /// The journal is `FILE.partial`. With [`Begin::Resume`] its chunks are taken over, a torn end is cut off.
    ///
    /// # Errors
    /// [`FilesError`]: a place that cannot be written, a format that does not fit, work of an earlier run that nobody asked
    /// to resume, or work of another sweep.
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

    /// The first chunk that is missing.
    pub fn next(&self) -> usize {
        self.journal.next
    }

    /// Rows that are safe.
    pub fn done(&self) -> usize {
        self.journal.done()
    }

    /// The journal.
    pub fn journal(&self) -> &Path {
        &self.journal.path
    }

    /// The chunks that are there.
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

    /// Takes the next chunk.
    ///
    /// # Errors
    /// [`FilesError::Write`], with what is safe.
    ///
    /// # Panics
    /// For any other chunk.
    pub fn add(&mut self, chunk: &Chunk) -> Result<(), FilesError> {
        self.journal.add(chunk).map_err(|source| self.failed(&self.journal.path, source))
    }

    /// Writes the file, as a whole, and removes the journal.
    ///
    /// # Errors
    /// [`FilesError::Write`]; the journal stays.
    ///
    /// # Panics
    /// If chunks are missing.
    pub fn finish(mut self) -> Result<(), FilesError> {
        assert_eq!(self.next(), self.journal.record().range().end, "all chunks are there");
        self.journal.sync().map_err(|source| self.failed(&self.journal.path, source))?;
        write_whole(&self.path, self.format, self.journal.record(), &self.journal, true)
            .map_err(|source| self.failed(&self.path, source))?;
        // The result is there; a journal that stays is a nuisance, no loss.
        let _ = fs::remove_file(&self.journal.path);
        Ok(())
    }

    /// Writes the rows there are, and keeps the journal; what is safe where, in a sentence. A whole file that is there is
    /// not replaced, nor any .csv, which does not say whether it is whole; an image has no holes and is not written.
    ///
    /// # Errors
    /// [`FilesError::Write`]; the journal stays.
    pub fn interrupt(mut self) -> Result<String, FilesError> {
        self.journal.sync().map_err(|source| self.failed(&self.journal.path, source))?;
        let replaces_nothing = match self.format {
            Format::Parquet => !self.path.exists() || ParquetFile::open(&self.path).is_ok_and(|file| !file.complete),
            Format::Csv => !self.path.exists(),
            Format::Vti => false,
        };
        if !replaces_nothing || self.done() == 0 {
            return Ok(self.safe());
        }
        write_whole(&self.path, self.format, self.journal.record(), &self.journal, false)
            .map_err(|source| self.failed(&self.path, source))?;
        let mark = match self.format {
            Format::Csv => "which does not say that it is incomplete",
            Format::Parquet | Format::Vti => "marked as incomplete",
        };
        Ok(format!("{}; {} has them, {mark}", self.safe(), self.path.display()))
    }

    /// What the journal holds, in words.
    fn safe(&self) -> String {
        let rows = self.journal.record().rows_of(self.journal.record().range());
        format!("{} of {rows} rows are safe in {}", self.done(), self.journal.path.display())
    }

    fn failed(&self, path: &Path, cause: std::io::Error) -> FilesError {
        let saved = format!("{}: {}, then go on with ⟪resume⟫", self.safe(), crate::to_do(&cause));
        FilesError::Write { path: path.to_owned(), saved, cause }
    }
}

/// Checks that a file can be written there, and that the format fits.
pub(crate) fn check_place(path: &Path, format: Format, record: &Record) -> Result<(), FilesError> {
    let place = |reason: String| FilesError::Place { path: path.to_owned(), reason };
    if path.is_dir() {
        return Err(place("it is a directory; add a file name".to_owned()));
    }
    if !is_regular_or_new(path) {
        return Err(place("it is no regular file; name one, or leave out ⟪output_file⟫".to_owned()));
    }
    if fs::metadata(path).is_ok_and(|metadata| metadata.permissions().readonly()) {
        return Err(place("it is read-only".to_owned()));
    }
    Temporary::beside(path).map_err(|error| place(crate::told(&error)))?;
    if format == Format::Vti {
        vti::check(record).map_err(|reason| FilesError::NoImage { path: path.to_owned(), reason })?;
    }
    if record.part.is_some() && format != Format::Parquet {
        return Err(place("a part has to be a .parquet file, which says what it is a part of".to_owned()));
    }
    Ok(())
}

/// The file is the whole result already.
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
    let unwritable = |source| FilesError::Place { path: path(), reason: crate::told(&source) };
    let file = Journal::lock(partial)?;
    let found = match begin {
        Begin::Discard => Found::Nothing,
        Begin::Anew | Begin::Resume => journal::look(&file, &record).map_err(unreadable)?,
    };
    match found {
        Found::Nothing => Journal::begin(partial, file, record).map_err(|source| {
            // Nothing is in it that anyone could go on with.
            let _ = fs::remove_file(partial);
            unwritable(source)
        }),
        Found::Foreign => Err(FilesError::NoJournal { path: path() }),
        Found::Chunks { difference: Some(difference), .. } => {
            let advice = "choose another file, or begin anew with ⟪discard⟫";
            Err(FilesError::Foreign { path: path(), difference, advice })
        }
        Found::Chunks { done, rows, .. } if begin == Begin::Anew => {
            Err(FilesError::Unfinished { journal: path(), done, rows })
        }
        Found::Chunks { end, next, .. } => Journal::go_on(partial, file, record, end, next).map_err(unwritable),
    }
}

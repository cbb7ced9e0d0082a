//! Rows on their way into memory or a file.

use super::plan::Whole;
use super::table::PyTable;
use crate::errors;
use crate::threads::Threads;
use funicular_files::table::{Table, TableBuilder, unpack};
use funicular_files::{Format, Job};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// Where rows go.
enum Place {
    Memory(TableBuilder),
    File(Box<Job>, PathBuf),
}

impl Place {
    fn add(&mut self, chunk: &funicular_study::sweep::Chunk) -> PyResult<()> {
        match self {
            Self::Memory(rows) => rows.add(chunk).map_err(|error| PyRuntimeError::new_err(error.to_string())),
            Self::File(job, _) => job.add(chunk).map_err(|error| errors::files(&error)),
        }
    }

    fn next(&self) -> usize {
        match self {
            Self::Memory(rows) => rows.next(),
            Self::File(job, _) => job.next(),
        }
    }
}

/// Rows of a plan as they come, in order.
#[pyclass(name = "SweepWork", module = "funicular._funicular")]
pub(crate) struct PyWork {
    whole: Arc<Whole>,
    /// None once it has ended.
    into: Option<Place>,
}

impl PyWork {
    pub(crate) fn in_memory(whole: Arc<Whole>) -> Self {
        let into = Place::Memory(TableBuilder::new(whole.record.clone()));
        Self { whole, into: Some(into) }
    }

    pub(crate) fn in_file(whole: Arc<Whole>, job: Job, path: PathBuf) -> Self {
        Self { whole, into: Some(Place::File(Box::new(job), path)) }
    }

    fn open(&mut self) -> PyResult<&mut Place> {
        self.into.as_mut().ok_or_else(ended)
    }
}

fn ended() -> PyErr {
    PyValueError::new_err("this sweep has ended")
}

#[pymethods]
impl PyWork {
    /// The first chunk that is missing.
    #[getter]
    fn next_chunk(&mut self) -> PyResult<usize> {
        Ok(self.open()?.next())
    }

    /// Rows that are there.
    #[getter]
    fn done(&mut self) -> PyResult<usize> {
        let next = self.open()?.next();
        Ok(self.whole.done(next))
    }

    /// The file that holds the rows until the end; None in memory.
    #[getter]
    fn journal(&mut self) -> PyResult<Option<PathBuf>> {
        Ok(match self.open()? {
            Place::Memory(_) => None,
            Place::File(job, _) => Some(job.journal().to_owned()),
        })
    }

    /// Takes chunks that `SweepPlan.compute` has made, the next ones.
    fn add(&mut self, py: Python<'_>, chunks: &[u8]) -> PyResult<()> {
        let whole = Arc::clone(&self.whole);
        let into = self.open()?;
        py.detach(|| {
            for chunk in unpack(chunks, &whole.record)? {
                if chunk.index != into.next() {
                    return Err(PyValueError::new_err(format!(
                        "chunk {} is not the next, {}",
                        chunk.index,
                        into.next()
                    )));
                }
                into.add(&chunk)?;
            }
            Ok(())
        })
    }

    /// Computes all chunks that are missing here, side by side; `progress` is called with the rows there and all rows.
    #[pyo3(signature = (threads=None, progress=None))]
    fn run(&mut self, py: Python<'_>, threads: Option<Threads>, progress: Option<Py<PyAny>>) -> PyResult<()> {
        let threads = Threads::of(threads);
        let whole = Arc::clone(&self.whole);
        let into = self.open()?;
        let chunks = into.next()..whole.record.range().end;
        let done = AtomicUsize::new(chunks.start);
        let mut told = Instant::now();
        let tell = || match &progress {
            None => Ok(()),
            Some(progress) => Python::attach(|py| {
                progress.call1(py, (whole.done(done.load(Ordering::Relaxed)), whole.rows())).map(drop)
            }),
        };
        py.detach(|| {
            let tell = &tell;
            let take = |chunk: funicular_study::sweep::Chunk| {
                into.add(&chunk)?;
                done.store(chunk.index + 1, Ordering::Relaxed);
                Ok(())
            };
            let look = || {
                crate::interrupt::look()?;
                if told.elapsed() >= TELL {
                    told = Instant::now();
                    tell()?;
                }
                Ok(())
            };
            whole.run(chunks, threads, take, look)?;
            tell()
        })
    }

    /// Ends it: writes the file, as a whole. The table of rows; None where that would be read from a Parquet file.
    fn finish(&mut self, py: Python<'_>) -> PyResult<Option<PyTable>> {
        if self.open()?.next() < self.whole.record.range().end {
            return Err(PyValueError::new_err("chunks are missing"));
        }
        let into = self.into.take().ok_or_else(ended)?;
        let whole = Arc::clone(&self.whole);
        py.detach(|| match into {
            Place::Memory(rows) => finished(rows).map(Some),
            Place::File(job, path) => {
                let table = if is_parquet(&path) {
                    None
                } else {
                    let mut rows = TableBuilder::new(whole.record.clone());
                    let mut added = Ok(());
                    job.each(&mut |chunk| {
                        if added.is_ok() {
                            added = rows.add(&chunk);
                        }
                    })
                    .map_err(|error| errors::files(&error))?;
                    added.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
                    Some(finished(rows)?)
                };
                job.finish().map_err(|error| errors::files(&error))?;
                Ok(table)
            }
        })
    }

    /// Ends it early: what is safe, in a sentence; None in memory.
    fn interrupt(&mut self, py: Python<'_>) -> PyResult<Option<String>> {
        let Some(Place::File(job, _)) = self.into.take() else { return Ok(None) };
        let safe = py.detach(|| job.interrupt()).map_err(|error| errors::files(&error))?;
        Ok(Some(format!("{safe}; the same call with `resume=True` goes on")))
    }
}

/// Time between two reports of progress.
const TELL: std::time::Duration = std::time::Duration::from_millis(200);

fn is_parquet(path: &Path) -> bool {
    Format::of(path).is_ok_and(|format| format == Format::Parquet)
}

fn finished(rows: TableBuilder) -> PyResult<PyTable> {
    let table: Table = rows.finish().map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    Ok(PyTable::of(table))
}

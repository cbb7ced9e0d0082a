//! Collection of the rows of a plan in memory or in a file.

use super::plan_data::PlanData;
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

/// Destination of the rows.
enum RowStore {
    Memory(TableBuilder),
    File(Box<Job>, PathBuf),
}

impl RowStore {
    fn add(&mut self, chunk: &funicular_study::table::Chunk) -> PyResult<()> {
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

/// Collection of the rows of a plan, in their order.
#[pyclass(name = "SweepWork", module = "funicular._funicular")]
pub(crate) struct PyWork {
    data: Arc<PlanData>,
    /// `None` after the end.
    store: Option<RowStore>,
}

impl PyWork {
    pub(crate) fn in_memory(data: Arc<PlanData>) -> Self {
        let store = RowStore::Memory(TableBuilder::new(data.record.clone()));
        Self { data, store: Some(store) }
    }

    pub(crate) fn in_file(data: Arc<PlanData>, job: Job, path: PathBuf) -> Self {
        Self { data, store: Some(RowStore::File(Box::new(job), path)) }
    }

    fn open(&mut self) -> PyResult<&mut RowStore> {
        self.store.as_mut().ok_or_else(ended)
    }
}

fn ended() -> PyErr {
    PyValueError::new_err("this sweep has ended")
}

#[pymethods]
impl PyWork {
    /// Index of the first missing chunk.
    #[getter]
    fn next_chunk(&mut self) -> PyResult<usize> {
        Ok(self.open()?.next())
    }

    /// Number of finished rows.
    #[getter]
    fn done(&mut self) -> PyResult<usize> {
        let next = self.open()?.next();
        Ok(self.data.done(next))
    }

    /// File that contains the rows until the end; None for rows in memory.
    #[getter]
    fn journal(&mut self) -> PyResult<Option<PathBuf>> {
        Ok(match self.open()? {
            RowStore::Memory(_) => None,
            RowStore::File(job, _) => Some(job.journal().to_owned()),
        })
    }

    /// Adds the next chunks, as bytes of `SweepPlan.compute`.
    fn add(&mut self, py: Python<'_>, chunks: &[u8]) -> PyResult<()> {
        let data = Arc::clone(&self.data);
        let store = self.open()?;
        py.detach(|| {
            for chunk in unpack(chunks, &data.record)? {
                if chunk.index != store.next() {
                    return Err(PyValueError::new_err(format!(
                        "chunk {} is not the next, {}",
                        chunk.index,
                        store.next()
                    )));
                }
                store.add(&chunk)?;
            }
            Ok(())
        })
    }

    /// Computes all missing chunks in parallel; `progress` is called with the number of finished rows and of all rows.
    #[pyo3(signature = (threads=None, progress=None))]
    fn run(&mut self, py: Python<'_>, threads: Option<Threads>, progress: Option<Py<PyAny>>) -> PyResult<()> {
        let threads = Threads::of(threads);
        let data = Arc::clone(&self.data);
        let store = self.open()?;

        let chunks = store.next()..data.record.range().end;
        let done = AtomicUsize::new(chunks.start);

        let mut reported = Instant::now();
        let report = || match &progress {
            None => Ok(()),
            Some(progress) => Python::attach(|py| {
                progress.call1(py, (data.done(done.load(Ordering::Relaxed)), data.rows())).map(drop)
            }),
        };

        py.detach(|| {
            let report = &report;
            let take = |chunk: funicular_study::table::Chunk| {
                store.add(&chunk)?;
                done.store(chunk.index + 1, Ordering::Relaxed);
                Ok(())
            };

            let check = || {
                crate::interrupt::check_signals()?;
                if reported.elapsed() >= REPORT_INTERVAL {
                    reported = Instant::now();
                    report()?;
                }
                Ok(())
            };
            data.run(chunks, threads, take, check)?;
            report()
        })
    }

    /// Ends the collection and writes the file. Returns the table of rows, or None if it is in a Parquet file.
    fn finish(&mut self, py: Python<'_>) -> PyResult<Option<PyTable>> {
        if self.open()?.next() < self.data.record.range().end {
            return Err(PyValueError::new_err("chunks are missing"));
        }

        let store = self.store.take().ok_or_else(ended)?;
        let data = Arc::clone(&self.data);
        py.detach(|| match store {
            RowStore::Memory(rows) => finished(rows).map(Some),
            RowStore::File(job, path) => {
                let table = if is_parquet(&path) {
                    None
                } else {
                    let mut rows = TableBuilder::new(data.record.clone());
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

    /// Ends the collection early. Returns a sentence about the rows that are safe, or None for rows in memory.
    fn interrupt(&mut self, py: Python<'_>) -> PyResult<Option<String>> {
        let Some(RowStore::File(job, _)) = self.store.take() else { return Ok(None) };
        let safe = py.detach(|| job.interrupt(funicular_files::WRITE_WITHIN)).map_err(|error| errors::files(&error))?;
        Ok(Some(format!("{safe}; the same call with `resume=True` continues")))
    }
}

/// Time between two reports of progress.
const REPORT_INTERVAL: std::time::Duration = std::time::Duration::from_millis(200);

fn is_parquet(path: &Path) -> bool {
    Format::of(path).is_ok_and(|format| format == Format::Parquet)
}

fn finished(rows: TableBuilder) -> PyResult<PyTable> {
    let table: Table = rows.finish().map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    Ok(PyTable::of(table))
}

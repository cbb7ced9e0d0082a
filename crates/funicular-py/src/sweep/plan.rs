//! A map or sweep that is ready to run: as it travels to workers, and its chunks.

use super::work::PyWork;
use crate::arrays::Reduced;
use crate::errors;
use crate::interrupt::on_threads;
use crate::threads::Threads;
use funicular_files::{Begin, Job, Opened, table};
use funicular_study::request::Request;
use funicular_study::sweep::{Chunk, Part, PreparedSweep, Record};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::num::NonZeroUsize;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

/// A plan with all that it is made of.
pub(crate) struct Whole {
    sweep: PreparedSweep,
    pub(crate) record: Record,
}

impl Whole {
    fn of(request: &Request, part: Option<Part>) -> anyhow::Result<Self> {
        let sweep = PreparedSweep::new(request)?;
        let record = sweep.record(&sweep.plan()?, part);
        Ok(Self { sweep, record })
    }

    /// Number of rows to compute.
    pub(crate) fn rows(&self) -> usize {
        self.record.rows_of(self.record.range())
    }

    /// Number of rows before a chunk.
    pub(crate) fn done(&self, next: usize) -> usize {
        self.record.rows_of(self.record.range().start..next)
    }

    /// Computes chunks on threads of this call alone, and hands them over in order to this one, which looks for Ctrl-C.
    pub(crate) fn run(
        &self,
        chunks: Range<usize>,
        threads: NonZeroUsize,
        take: impl FnMut(Chunk) -> PyResult<()>,
        look: impl FnMut() -> PyResult<()>,
    ) -> PyResult<()> {
        let plan = self.sweep.plan().map_err(|error| errors::study(&error.into()))?;
        on_threads(chunks, threads, |index, given_up| plan.evaluate(index, given_up), take, look)
    }
}

/// A map or sweep; a pickle of it is its request as JSON.
#[pyclass(frozen, name = "SweepPlan", module = "funicular._funicular")]
pub(crate) struct PyPlan {
    request: Request,
    pub(crate) whole: Arc<Whole>,
}

impl PyPlan {
    pub(crate) fn of(py: Python<'_>, request: Request, part: Option<String>) -> PyResult<Self> {
        let part =
            part.map(|part| part.parse().map_err(|reason| errors::input(format!("`part`: {reason}")))).transpose()?;
        let whole = py.detach(|| Whole::of(&request, part)).map_err(|error| errors::study(&error))?;
        Ok(Self { request, whole: Arc::new(whole) })
    }
}

#[pymethods]
impl PyPlan {
    /// Of a request as JSON, or one of its parts, as "3/8".
    #[new]
    #[pyo3(signature = (request, part=None))]
    fn new(py: Python<'_>, request: &str, part: Option<String>) -> PyResult<Self> {
        Self::of(py, Request::from_json(request).map_err(|error| errors::study(&error.into()))?, part)
    }

    /// Number of rows.
    #[getter]
    fn rows(&self) -> usize {
        self.whole.rows()
    }

    /// The first chunk of rows; each is computed by itself.
    #[getter]
    fn first_chunk(&self) -> usize {
        self.whole.record.range().start
    }

    /// The chunk behind the last.
    #[getter]
    fn chunks(&self) -> usize {
        self.whole.record.range().end
    }

    /// Rows of every chunk but the last.
    #[getter]
    fn chunk_rows(&self) -> usize {
        self.whole.record.chunk_rows
    }

    /// Chunks from `first` to before `end`, as bytes that `SweepWork.add` takes.
    #[pyo3(signature = (first, end, threads=Threads(NonZeroUsize::MIN)))]
    fn compute<'py>(
        &self,
        py: Python<'py>,
        first: usize,
        end: usize,
        threads: Threads,
    ) -> PyResult<Bound<'py, PyBytes>> {
        if first > end || end > self.chunks() {
            return Err(errors::input(format!("there are no chunks {first} to {end} of {}", self.chunks())));
        }
        let mut bytes = Vec::new();
        py.detach(|| {
            self.whole.run(
                first..end,
                threads.0,
                |chunk| table::pack(&mut bytes, &chunk).map_err(PyErr::from),
                crate::interrupt::look,
            )
        })?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Begins to collect rows, in memory or in a file; None if the file has them all.
    #[pyo3(signature = (file=None, resume=false, discard=false))]
    fn begin(&self, py: Python<'_>, file: Option<PathBuf>, resume: bool, discard: bool) -> PyResult<Option<PyWork>> {
        let begin = match (resume, discard) {
            (true, true) => return Err(errors::input("give `resume` or `discard`, not both".to_owned())),
            (true, false) => Begin::Resume,
            (false, true) => Begin::Discard,
            (false, false) => Begin::Anew,
        };
        let whole = Arc::clone(&self.whole);
        let Some(path) = file else {
            if resume || discard {
                return Err(errors::input("`resume` and `discard` go with `file`".to_owned()));
            }
            if whole.record.part.is_some() {
                return Err(errors::input("`part` goes with `file`: parts become one file".to_owned()));
            }
            return Ok(Some(PyWork::in_memory(whole)));
        };
        let opened =
            py.detach(|| Job::open(&path, whole.record.clone(), begin)).map_err(|error| errors::files(&error))?;
        Ok(match opened {
            Opened::Done => None,
            Opened::Work(job) => Some(PyWork::in_file(whole, *job, path)),
        })
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> Reduced<'py, (String, Option<String>)> {
        let Self { request, whole } = slf.get();
        let part = whole.record.part.map(|part| part.to_string());
        (slf.get_type().into_any(), (request.to_value().to_string(), part))
    }
}

//! Plan of a map or sweep, which is sent to workers and computes chunks of rows.

use super::plan_data::PlanData;
use super::work::PyWork;
use crate::arrays::PickleParts;
use crate::errors;
use crate::threads::Threads;
use funicular_files::{Begin, Job, Opened, table};
use funicular_study::request::Request;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Arc;

/// Plan of a map or sweep; its pickle is the request as JSON.
#[pyclass(frozen, name = "SweepPlan", module = "funicular._funicular")]
pub(crate) struct PyPlan {
    request: Request,
    pub(crate) data: Arc<PlanData>,
}

impl PyPlan {
    pub(crate) fn of(py: Python<'_>, request: Request, part: Option<String>) -> PyResult<Self> {
        let part =
            part.map(|part| part.parse().map_err(|reason| errors::input(format!("`part`: {reason}")))).transpose()?;
        let data = py.detach(|| PlanData::of(&request, part)).map_err(|error| errors::study(&error))?;
        Ok(Self { request, data: Arc::new(data) })
    }
}

#[pymethods]
impl PyPlan {
    /// Makes the plan of a request in JSON; `part` is one of its parts, such as "3/8".
    #[new]
    #[pyo3(signature = (request, part=None))]
    fn new(py: Python<'_>, request: &str, part: Option<String>) -> PyResult<Self> {
        Self::of(py, Request::from_json(request).map_err(|error| errors::study(&error.into()))?, part)
    }

    /// Number of rows.
    #[getter]
    fn rows(&self) -> usize {
        self.data.rows()
    }

    /// Index of the first chunk of rows; chunks are computed independently.
    #[getter]
    fn first_chunk(&self) -> usize {
        self.data.record.range().start
    }

    /// Index behind the last chunk.
    #[getter]
    fn chunks(&self) -> usize {
        self.data.record.range().end
    }

    /// Number of rows of every chunk but the last.
    #[getter]
    fn chunk_rows(&self) -> usize {
        self.data.record.chunk_rows
    }

    /// Computes the chunks from `first` (included) to `end` (excluded), as bytes for `SweepWork.add`.
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
            self.data.run(
                first..end,
                threads.0,
                |chunk| table::pack(&mut bytes, &chunk).map_err(PyErr::from),
                crate::interrupt::check_signals,
            )
        })?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Begins to collect rows in memory or in a file; None if the file has all rows. Warns of values of the robot that
    /// no usual robot has.
    /// `level` is the number of functions between the user and this call.
    #[pyo3(signature = (file=None, resume=false, discard=false, level=2))]
    fn begin(
        &self,
        py: Python<'_>,
        file: Option<PathBuf>,
        resume: bool,
        discard: bool,
        level: i32,
    ) -> PyResult<Option<PyWork>> {
        let begin = match (resume, discard) {
            (true, true) => return Err(errors::input("give `resume` or `discard`, not both".to_owned())),
            (true, false) => Begin::Resume,
            (false, true) => Begin::Discard,
            (false, false) => Begin::Anew,
        };

        let data = Arc::clone(&self.data);
        if file.is_none() && (resume || discard) {
            return Err(errors::input("`resume` and `discard` go with `file`".to_owned()));
        }
        if file.is_none() && data.record.part.is_some() {
            return Err(errors::input("`part` goes with `file`: parts are joined as files".to_owned()));
        }

        // Before any work, so that a slip can be corrected at once.
        data.warn(py, level)?;

        let Some(path) = file else { return Ok(Some(PyWork::in_memory(data))) };
        let opened =
            py.detach(|| Job::open(&path, data.record.clone(), begin)).map_err(|error| errors::files(&error))?;
        Ok(match opened {
            Opened::Done => None,
            Opened::Work(job) => Some(PyWork::in_file(data, *job, path)),
        })
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PickleParts<'py, (String, Option<String>)> {
        let Self { request, data } = slf.get();
        let part = data.record.part.map(|part| part.to_string());
        (slf.get_type().into_any(), (request.to_value().to_string(), part))
    }
}

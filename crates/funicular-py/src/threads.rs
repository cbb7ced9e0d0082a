//! How many threads of this process compute.

use crate::arrays::Count;
use pyo3::inspect::PyStaticExpr;
use pyo3::prelude::*;
use std::num::NonZeroUsize;
use std::thread;

/// A number of threads from Python.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Threads(pub(crate) NonZeroUsize);

impl Threads {
    /// The most that are started, as of the program.
    const MOST: usize = 1024;

    /// One a processor if none is given.
    pub(crate) fn of(given: Option<Self>) -> NonZeroUsize {
        given.map_or_else(|| thread::available_parallelism().unwrap_or(NonZeroUsize::MIN), |Self(threads)| threads)
    }
}

impl<'a, 'py> FromPyObject<'a, 'py> for Threads {
    type Error = PyErr;

    const INPUT_TYPE: PyStaticExpr = <usize as FromPyObject<'a, 'py>>::INPUT_TYPE;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        let rule = format!("give at least one and at most {}", Self::MOST);
        let count = object.extract::<Count>()?.within("threads", 1..=Self::MOST, &rule)?;
        Ok(Self(NonZeroUsize::new(count).unwrap_or(NonZeroUsize::MIN)))
    }
}

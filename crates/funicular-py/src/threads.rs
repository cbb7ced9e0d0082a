//! Number of threads of this process that compute.

use crate::arrays::Count;
use funicular_files::threads::{self, THREADS};
use pyo3::inspect::PyStaticExpr;
use pyo3::prelude::*;
use std::num::NonZeroUsize;

/// Number of threads from Python.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Threads(pub(crate) NonZeroUsize);

impl Threads {
    /// The number given, or one thread per processor.
    pub(crate) fn of(given: Option<Self>) -> NonZeroUsize {
        threads::or_all(given.map(|Self(threads)| threads))
    }
}

impl<'a, 'py> FromPyObject<'a, 'py> for Threads {
    type Error = PyErr;

    const INPUT_TYPE: PyStaticExpr = <usize as FromPyObject<'a, 'py>>::INPUT_TYPE;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        let rule = format!("give at least one and at most {}", THREADS.end());
        let count = object.extract::<Count>()?.within("threads", THREADS, &rule)?;
        Ok(Self(NonZeroUsize::new(count).unwrap_or(NonZeroUsize::MIN)))
    }
}

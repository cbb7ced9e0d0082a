//! How many threads of this process compute.

use crate::errors;
use pyo3::exceptions::PyOverflowError;
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
        let count = match object.extract::<usize>() {
            // Negative or huge.
            Err(error) if error.is_instance_of::<PyOverflowError>(object.py()) => None,
            count => NonZeroUsize::new(count?).filter(|count| count.get() <= Self::MOST),
        };
        count.map(Self).ok_or_else(|| {
            let most = Self::MOST;
            errors::input(format!("`threads` is {}: give at least one and at most {most}", object.as_any()))
        })
    }
}

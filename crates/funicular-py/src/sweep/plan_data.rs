//! Plan of a map or sweep as data, shared by the classes that compute its rows.

use crate::errors;
use crate::interrupt::on_threads;
use funicular_study::request::Request;
use funicular_study::sweep::PreparedSweep;
use funicular_study::table::{Chunk, Part, Record};
use pyo3::prelude::*;
use std::num::NonZeroUsize;
use std::ops::Range;

/// Sweep that is ready to run, and the record of its rows.
pub(crate) struct PlanData {
    sweep: PreparedSweep,
    pub(crate) record: Record,
}

impl PlanData {
    pub(crate) fn of(request: &Request, part: Option<Part>) -> anyhow::Result<Self> {
        let sweep = PreparedSweep::new(request)?;
        let record = sweep.record(&sweep.plan()?, part);
        Ok(Self { sweep, record })
    }

    /// Number of rows to compute.
    pub(crate) fn rows(&self) -> usize {
        self.record.rows_of(self.record.range())
    }

    /// Number of rows before the chunk `next`.
    pub(crate) fn done(&self, next: usize) -> usize {
        self.record.rows_of(self.record.range().start..next)
    }

    /// Shows the warnings about the robot; `level` is that of [`errors::warn`].
    pub(crate) fn warn(&self, py: Python<'_>, level: i32) -> PyResult<()> {
        self.sweep.warnings().iter().try_for_each(|warning| errors::warn(py, "RobotWarning", warning, level))
    }

    /// Computes chunks on new threads and passes them in order to `take` on the calling thread; `check` looks for
    /// Ctrl-C.
    pub(crate) fn run(
        &self,
        chunks: Range<usize>,
        threads: NonZeroUsize,
        take: impl FnMut(Chunk) -> PyResult<()>,
        check: impl FnMut() -> PyResult<()>,
    ) -> PyResult<()> {
        let plan = self.sweep.plan().map_err(|error| errors::study(&error.into()))?;
        on_threads(chunks, threads, |index, cancelled| plan.evaluate(index, cancelled), take, check)
    }
}

//! Progress of a reduction: reports between its steps, which can stop it.

use super::ReductionError;
use std::ops::Range;

/// Number of steps of a reduction, whatever its size. They take about equal times for large models.
pub const STEPS: usize = 100;

/// Reports of a reduction.
pub(super) struct Steps<'a> {
    report: &'a mut dyn FnMut(usize) -> bool,
    /// Number of steps of the last report, which never decreases.
    last: usize,
}

impl<'a> Steps<'a> {
    pub(super) fn new(report: &'a mut dyn FnMut(usize) -> bool) -> Self {
        Self { report, last: 0 }
    }

    /// Reports that `done` of `all` parts of a phase, which has the steps `phase`, are finished.
    ///
    /// # Errors
    /// [`ReductionError::Stopped`] if the observer stops the work.
    pub(super) fn reached(&mut self, phase: &Range<usize>, done: usize, all: usize) -> Result<(), ReductionError> {
        self.last = self.last.max(phase.start + phase.len() * done.min(all) / all.max(1));
        if (self.report)(self.last) { Ok(()) } else { Err(ReductionError::Stopped) }
    }
}

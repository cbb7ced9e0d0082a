//! Workspace of a robot on several threads.

use crate::threads::in_order;
use funicular::math::Vec3;
use funicular_study::analyses::workspace::{FoundSoFar, SearchedSet, Workspace, WorkspaceStudy};
use std::convert::Infallible;
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicBool, Ordering};

/// Number of positions that a thread takes at once: some milliseconds of work.
const POSITIONS_AT_ONCE: usize = 32;

/// End of the work.
pub enum WorkspaceOutcome {
    /// Results; if the work was stopped, of the steps that were ready.
    Found(Box<Workspace>),
    /// Positions that were asked before the work was stopped, too few for a surface.
    Stopped(FoundSoFar),
}

/// Way of computing a workspace.
pub struct WorkspaceRun<'a> {
    /// Number of threads; the results do not depend on it.
    pub threads: NonZeroUsize,
    /// Flag that stops the work at its next position.
    pub cancel: &'a AtomicBool,
}

impl WorkspaceRun<'_> {
    /// Finds the workspace of a study. `progress` gets the number of positions that are done, of those known to be
    /// needed, and what was found so far.
    ///
    /// # Errors
    /// No position that meets the conditions.
    pub fn run(
        &self,
        study: &WorkspaceStudy,
        progress: &mut dyn FnMut(usize, usize, &FoundSoFar),
    ) -> anyhow::Result<WorkspaceOutcome> {
        let (mut done, mut so_far) = (0, FoundSoFar::default());
        let mut evaluate = |set: SearchedSet, positions: &[Vec3]| {
            let total = done + positions.len();
            let chunks: Vec<&[Vec3]> = positions.chunks(POSITIONS_AT_ONCE).collect();
            let compute = |chunk: usize, given_up: &dyn Fn() -> bool| {
                let values = chunks[chunk].iter().map(|position| (!given_up()).then(|| study.value(set, position)));
                values.collect::<Option<Vec<_>>>()
            };
            let mut values = Vec::with_capacity(positions.len());
            let outcome = in_order(0..chunks.len(), self.threads, self.cancel, compute, |chunk: Vec<Option<f64>>| {
                so_far.add(set, &positions[values.len()..][..chunk.len()], &chunk);
                done += chunk.len();
                values.extend(chunk);
                progress(done, total, &so_far);
                Ok::<(), Infallible>(())
            });
            let is_complete = outcome.is_ok() && values.len() == positions.len();
            (is_complete && !self.cancel.load(Ordering::Relaxed)).then_some(values)
        };
        let found = study.find(&mut evaluate)?;
        Ok(found.map_or(WorkspaceOutcome::Stopped(so_far), |found| WorkspaceOutcome::Found(Box::new(found))))
    }
}

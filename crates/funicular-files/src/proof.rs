//! Proof about a box of poses on several threads.

use crate::threads::in_order;
use funicular::proof::{BoxProof, PositionBox, ProofStatement};
use funicular_study::analyses::prove::{ProofStudy, Proved};
use std::convert::Infallible;
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicBool, Ordering};

/// Number of boxes that a thread takes at once: a millisecond of work.
const BOXES_AT_ONCE: usize = 16;

/// Way of proving.
pub struct ProofRun<'a> {
    /// Number of threads; the results do not depend on it.
    pub threads: NonZeroUsize,
    /// Flag that stops the work at its next box; what was found until then is kept.
    pub cancel: &'a AtomicBool,
    /// Time since the start [s].
    pub elapsed: &'a dyn Fn() -> f64,
}

impl ProofRun<'_> {
    /// Divides the box of a study. `report` gets the number of boxes that are done, of the most that are wanted, and
    /// what was found so far.
    ///
    /// # Errors
    /// The errors of [`ProofStudy::find`].
    pub fn run(&self, study: &ProofStudy, report: &mut dyn FnMut(usize, usize, &str)) -> anyhow::Result<Proved> {
        let mut prove = |statement: &ProofStatement, boxes: &[PositionBox]| {
            let chunks: Vec<&[PositionBox]> = boxes.chunks(BOXES_AT_ONCE).collect();
            let compute = |chunk: usize, given_up: &dyn Fn() -> bool| {
                let proofs = chunks[chunk].iter().map(|region| (!given_up()).then(|| statement.prove(region)));
                proofs.collect::<Option<Vec<BoxProof>>>()
            };
            let mut proofs = Vec::with_capacity(boxes.len());
            let outcome = in_order(0..chunks.len(), self.threads, self.cancel, compute, |chunk: Vec<BoxProof>| {
                proofs.extend(chunk);
                Ok::<(), Infallible>(())
            });
            let is_complete = outcome.is_ok() && proofs.len() == boxes.len();
            (is_complete && !self.cancel.load(Ordering::Relaxed)).then_some(proofs)
        };
        study.find(&mut prove, Some(self.elapsed), report)
    }
}

//! Progress of long work, told to whoever asked for it.

/// A front end's eye on an analysis: it may draw a bar, and it may stop the work.
pub trait Watch {
    /// Called between steps of the work: `done` of `total` `what` (a plural noun, as in "frequencies") are ready.
    fn progress(&mut self, done: usize, total: usize, what: &'static str) {
        let _ = (done, total, what);
    }

    /// Whether the work shall stop at its next step.
    fn is_cancelled(&self) -> bool {
        false
    }
}

/// Nobody watches.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Watch for Silent {}

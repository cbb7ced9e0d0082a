//! Progress of long work, reported to a front end.

/// Observer of an analysis. It can show progress, and it can stop the work.
pub trait Watch {
    /// Reports progress between steps of the work: `done` of `total` `what` (a plural noun, such as "frequencies") are
    /// ready.
    fn progress(&mut self, done: usize, total: usize, what: &'static str) {
        let _ = (done, total, what);
    }

    /// Notes what was found so far, which the next report shows.
    fn note(&mut self, so_far: &str) {
        let _ = so_far;
    }

    /// True if the work shall stop at its next step.
    fn is_cancelled(&self) -> bool {
        false
    }

    /// Seconds since some time; `None` without a clock, as in a browser.
    fn now_s(&self) -> Option<f64> {
        None
    }
}

/// Observer that shows nothing and never stops the work.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Watch for Silent {}

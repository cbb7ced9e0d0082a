//! Progress bar or spinner for work that takes more than a second, on a terminal only.

use crate::interrupt::{self, Computes};
use funicular_study::Watch;
use indicatif::{ProgressBar, ProgressStyle};
use std::sync::atomic::Ordering;
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// Time before progress is shown. Most commands end before it.
const PATIENCE: Duration = Duration::from_millis(700);

/// Counts finished items up to `total`.
pub(crate) struct Progress {
    started: Instant,
    total: usize,
    done: usize,
    what: &'static str,
    template: &'static str,
    bar: Option<ProgressBar>,
}

/// Template with the count and the remaining time.
const PLAIN: &str = "{bar:40} {human_pos}/{human_len} {msg}, {eta} left";
/// Template with the count, the rate per second and the remaining time.
const WITH_RATE: &str = "{bar:40} {human_pos}/{human_len} {msg}, {per_sec}, {eta} left";

impl Progress {
    pub(crate) fn new(total: usize, what: &'static str) -> Self {
        Self { started: Instant::now(), total, done: 0, what, template: PLAIN, bar: None }
    }

    /// Adds the rate to the display.
    pub(crate) fn with_rate(total: usize, what: &'static str) -> Self {
        let mut progress = Self::new(total, what);
        progress.template = WITH_RATE;
        progress
    }

    /// Adds `count` finished items.
    pub(crate) fn advance(&mut self, count: usize) {
        self.done += count;
        if self.bar.is_none() && self.started.elapsed() > PATIENCE {
            // indicatif draws on stderr, and draws nothing if stderr is not a terminal.
            let bar = ProgressBar::new(self.total as u64).with_elapsed(self.started.elapsed());
            if let Ok(style) = ProgressStyle::with_template(self.template) {
                bar.set_style(style);
            }
            bar.set_message(self.what);
            self.bar = Some(bar);
        }
        if let Some(bar) = &self.bar {
            bar.set_length(self.total as u64);
            bar.set_position(self.done as u64);
        }
    }

    /// Advances to `done` finished items of `total`, which may have grown.
    pub(crate) fn reach(&mut self, done: usize, total: usize) {
        self.total = total;
        self.advance(done.saturating_sub(self.done));
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// Progress bar of an analysis, drawn if stderr is a terminal. Ctrl-C stops the analysis while it exists.
pub(crate) struct TerminalProgress {
    /// Bar, and what it counts.
    bar: Option<(Progress, &'static str)>,
    _computes: Computes,
}

impl TerminalProgress {
    pub(crate) fn new() -> Self {
        Self { bar: None, _computes: interrupt::stop_analysis() }
    }
}

impl Watch for TerminalProgress {
    fn is_cancelled(&self) -> bool {
        interrupt::STOPPED.load(Ordering::Relaxed)
    }

    fn progress(&mut self, done: usize, total: usize, what: &'static str) {
        // Another kind of work has a bar of its own.
        if self.bar.as_ref().is_some_and(|(_, shown)| *shown != what) {
            self.bar = None;
        }
        let (bar, _) = self.bar.get_or_insert_with(|| (Progress::with_rate(total, what), what));
        bar.reach(done, total);
    }
}

/// Spinner that appears once a command takes long, and stays until it is dropped.
pub(crate) struct WaitingSpinner {
    done: Option<(Sender<()>, JoinHandle<()>)>,
}

impl WaitingSpinner {
    pub(crate) fn for_(what: &'static str) -> Self {
        let (done, is_done) = mpsc::channel();
        let thread = thread::spawn(move || {
            if is_done.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                let spinner = ProgressBar::new_spinner().with_message(what);
                spinner.enable_steady_tick(Duration::from_millis(120));
                // An error means that the sender was dropped: the work has ended.
                let _ = is_done.recv();
                spinner.finish_and_clear();
            }
        });
        Self { done: Some((done, thread)) }
    }
}

impl Drop for WaitingSpinner {
    fn drop(&mut self) {
        if let Some((done, thread)) = self.done.take() {
            drop(done);
            // The line is cleared before anything else is printed. A failed spinner is ignored.
            let _ = thread.join();
        }
    }
}

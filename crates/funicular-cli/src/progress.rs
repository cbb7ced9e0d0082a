//! A bar or a spinner for what takes over a second, on a terminal only.

use funicular_study::Watch;
use indicatif::{ProgressBar, ProgressStyle};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// How long a command stays silent; most are done by then.
const PATIENCE: Duration = Duration::from_millis(700);

/// Counts what is done of `total`.
pub(crate) struct Progress {
    started: Instant,
    total: usize,
    done: usize,
    what: &'static str,
    template: &'static str,
    bar: Option<ProgressBar>,
}

/// What is done, and the time left.
const PLAIN: &str = "{bar:40} {human_pos}/{human_len} {msg}, {eta} left";
/// With how many a second.
const WITH_RATE: &str = "{bar:40} {human_pos}/{human_len} {msg}, {per_sec}, {eta} left";

impl Progress {
    pub(crate) fn new(total: usize, what: &'static str) -> Self {
        Self { started: Instant::now(), total, done: 0, what, template: PLAIN, bar: None }
    }

    /// Which shows the rate, too.
    pub(crate) fn with_rate(total: usize, what: &'static str) -> Self {
        let mut progress = Self::new(total, what);
        progress.template = WITH_RATE;
        progress
    }

    /// `count` more are done.
    pub(crate) fn advance(&mut self, count: usize) {
        self.done += count;
        if self.bar.is_none() && self.started.elapsed() > PATIENCE {
            // indicatif draws on stderr, and nothing where that is no terminal.
            let bar = ProgressBar::new(self.total as u64).with_elapsed(self.started.elapsed());
            if let Ok(style) = ProgressStyle::with_template(self.template) {
                bar.set_style(style);
            }
            bar.set_message(self.what);
            self.bar = Some(bar);
        }
        if let Some(bar) = &self.bar {
            bar.set_position(self.done as u64);
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// A bar for the progress of an analysis, drawn where there is a terminal.
#[derive(Default)]
pub(crate) struct Shown {
    bar: Option<Progress>,
}

impl Watch for Shown {
    fn progress(&mut self, done: usize, total: usize, what: &'static str) {
        let bar = self.bar.get_or_insert_with(|| Progress::with_rate(total, what));
        bar.advance(done - bar.done);
    }
}

/// A spinner from the time on when waiting has become long, until it is dropped.
pub(crate) struct Waiting {
    done: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Waiting {
    pub(crate) fn for_(what: &'static str) -> Self {
        let (done, is_done) = mpsc::channel();
        let thread = thread::spawn(move || {
            if is_done.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                let spinner = ProgressBar::new_spinner().with_message(what);
                spinner.enable_steady_tick(Duration::from_millis(120));
                // An error is a sender that is gone: done as well.
                let _ = is_done.recv();
                spinner.finish_and_clear();
            }
        });
        Self { done: Some((done, thread)) }
    }
}

impl Drop for Waiting {
    fn drop(&mut self) {
        if let Some((done, thread)) = self.done.take() {
            drop(done);
            // The line is clear before anything else is printed. A spinner that failed is no reason to fail.
            let _ = thread.join();
        }
    }
}

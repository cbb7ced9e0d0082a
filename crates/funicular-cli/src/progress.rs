//! A bar for what takes over a second, on a terminal only.

use indicatif::{ProgressBar, ProgressStyle};
use std::time::{Duration, Instant};

/// How long a command stays silent; most are done by then.
const PATIENCE: Duration = Duration::from_millis(700);

/// Counts what is done of `total`.
pub(crate) struct Progress {
    started: Instant,
    total: usize,
    done: usize,
    what: &'static str,
    bar: Option<ProgressBar>,
}

impl Progress {
    pub(crate) fn new(total: usize, what: &'static str) -> Self {
        Self { started: Instant::now(), total, done: 0, what, bar: None }
    }

    /// `count` more are done.
    pub(crate) fn advance(&mut self, count: usize) {
        self.done += count;
        if self.bar.is_none() && self.started.elapsed() > PATIENCE {
            // indicatif draws on stderr, and nothing where that is no terminal.
            let bar = ProgressBar::new(self.total as u64);
            let template = "{bar:40} {human_pos}/{human_len} {msg}, {eta} left";
            if let Ok(style) = ProgressStyle::with_template(template) {
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

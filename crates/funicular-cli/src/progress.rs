//! Progress of work that takes long: a bar or spinner on a terminal, a line every ten seconds anywhere else.

use crate::errors;
use crate::interrupt::{self, Computes};
use funicular_study::Watch;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::{self, IsTerminal};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::sync::{Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// Time before progress is shown. Most commands end before it.
const PATIENCE: Duration = Duration::from_millis(700);

/// Time between two lines of progress into a file or pipe.
const BETWEEN_LINES: Duration = Duration::from_secs(10);

/// Items that are done, of those known to be needed, for the next line.
static SHOWN: Mutex<Option<(usize, usize, &'static str)>> = Mutex::new(None);

/// Finds so far, for the next line.
static NOTED: Mutex<String> = Mutex::new(String::new());

/// Flag that is set while a thread writes lines.
static WRITES_LINES: AtomicBool = AtomicBool::new(false);

/// Thread that writes a line of progress every ten seconds while it exists, if stderr is no terminal and no other one
/// writes them.
pub(crate) struct ProgressLines {
    thread: Option<(Sender<()>, JoinHandle<()>)>,
}

impl ProgressLines {
    pub(crate) fn new() -> Self {
        if io::stderr().is_terminal() || WRITES_LINES.swap(true, Ordering::Relaxed) {
            return Self { thread: None };
        }
        show(None);
        note("");
        let (done, is_done) = mpsc::channel();
        let started = Instant::now();
        let thread = thread::Builder::new().spawn(move || {
            while is_done.recv_timeout(BETWEEN_LINES) == Err(RecvTimeoutError::Timeout) {
                let shown = *SHOWN.lock().unwrap_or_else(PoisonError::into_inner);
                let noted = NOTED.lock().unwrap_or_else(PoisonError::into_inner).clone();
                errors::to_stderr(&line(shown, &noted, started.elapsed()));
            }
        });
        // A system without threads has no lines.
        Self { thread: thread.ok().map(|thread| (done, thread)) }
    }
}

impl Drop for ProgressLines {
    fn drop(&mut self) {
        if let Some((done, thread)) = self.thread.take() {
            drop(done);
            // No line comes after what is printed next.
            let _ = thread.join();
            WRITES_LINES.store(false, Ordering::Relaxed);
        }
    }
}

fn note(so_far: &str) {
    so_far.clone_into(&mut NOTED.lock().unwrap_or_else(PoisonError::into_inner));
}

fn show(items: Option<(usize, usize, &'static str)>) {
    *SHOWN.lock().unwrap_or_else(PoisonError::into_inner) = items;
}

/// Line about items that are done, of those known to be needed, after a time, and about what was found so far.
fn line(shown: Option<(usize, usize, &'static str)>, noted: &str, after: Duration) -> String {
    let seconds = after.as_secs();
    let line = match shown {
        Some((done, total, what)) if done > 0 && total > done => {
            let left = after.as_secs_f64() * (total - done) as f64 / done as f64;
            format!("{done} of {total} {what} after {seconds} s, about {left:.0} s left for these")
        }
        Some((done, _, what)) => format!("{done} {what} after {seconds} s"),
        None => format!("computing for {seconds} s"),
    };
    if noted.is_empty() { line } else { format!("{line}; {noted}") }
}

/// Counts finished items up to `total`.
pub(crate) struct Progress {
    started: Instant,
    total: usize,
    done: usize,
    what: &'static str,
    template: &'static str,
    bar: Option<ProgressBar>,
    _lines: ProgressLines,
}

/// Template with the count and the remaining time.
const PLAIN: &str = "{bar:40} {human_pos}/{human_len} {msg}, {eta} left";
/// Template with the count, the rate per second and the remaining time.
const WITH_RATE: &str = "{bar:40} {human_pos}/{human_len} {msg}, {per_sec}, {eta} left";

impl Progress {
    pub(crate) fn new(total: usize, what: &'static str) -> Self {
        let lines = ProgressLines::new();
        Self { started: Instant::now(), total, done: 0, what, template: PLAIN, bar: None, _lines: lines }
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
        show(Some((self.done, self.total, self.what)));
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

/// Progress of an analysis. Ctrl-C stops the analysis while it exists.
pub(crate) struct TerminalProgress {
    /// Bar, and what it counts.
    bar: Option<(Progress, &'static str)>,
    _computes: Computes,
    _lines: ProgressLines,
}

impl TerminalProgress {
    pub(crate) fn new() -> Self {
        Self { bar: None, _computes: interrupt::stop_analysis(), _lines: ProgressLines::new() }
    }
}

impl Watch for TerminalProgress {
    fn is_cancelled(&self) -> bool {
        interrupt::STOPPED.load(Ordering::Relaxed)
    }

    fn note(&mut self, so_far: &str) {
        note(so_far);
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
    _lines: ProgressLines,
}

impl WaitingSpinner {
    pub(crate) fn for_(what: &'static str) -> Self {
        let (done, is_done) = mpsc::channel();
        let thread = thread::Builder::new().spawn(move || {
            if is_done.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                let spinner = ProgressBar::new_spinner().with_message(what);
                spinner.enable_steady_tick(Duration::from_millis(120));
                // An error means that the sender was dropped: the work has ended.
                let _ = is_done.recv();
                spinner.finish_and_clear();
            }
        });
        Self { done: thread.ok().map(|thread| (done, thread)), _lines: ProgressLines::new() }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_say_what_is_done_and_what_is_left() {
        let after = Duration::from_secs(20);
        assert_eq!(
            line(Some((50, 200, "positions")), "", after),
            "50 of 200 positions after 20 s, about 60 s left for these"
        );
        assert_eq!(
            line(Some((200, 200, "positions")), "7 of 9 meet them", after),
            "200 positions after 20 s; 7 of 9 meet them"
        );
        assert_eq!(line(Some((0, 200, "rows")), "", after), "0 rows after 20 s");
        assert_eq!(line(None, "", after), "computing for 20 s");
    }
}

//! Ctrl-C, and the SIGTERM by which a cluster ends a job: work stops at its next step, with the exit code of SIGINT.

use crate::errors;
use anyhow::{Context, Result};
use funicular_answers::Stopped;
use std::process;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

/// Time that an analysis has for its next step. One eigenvalue problem of a large model takes longer.
const PATIENCE: Duration = Duration::from_secs(1);

/// Time after which a run whose rows are stored ends in any case. A row may take longer, and the rows before it are
/// safe at any moment.
const END_WITHIN: Duration = Duration::from_millis(1700);

/// Flag that Ctrl-C or the end of a job sets.
pub(crate) static STOPPED: AtomicBool = AtomicBool::new(false);

/// Flag that is set while an analysis computes and nothing is written.
static COMPUTES: AtomicBool = AtomicBool::new(false);

/// Calls a function at Ctrl-C and at the end of a job.
#[cfg(not(target_family = "wasm"))]
fn handle(work: impl FnMut() + Send + 'static) -> Result<(), ctrlc::Error> {
    ctrlc::set_handler(work)
}

/// Drops a function for Ctrl-C: a page ends the worker in which the program runs.
#[cfg(target_family = "wasm")]
fn handle(_: impl FnMut() + Send + 'static) -> Result<(), std::convert::Infallible> {
    Ok(())
}

/// Handles Ctrl-C for rows: the first one stops at the next row, the second one at once. With `otherwise` the program
/// ends with this message if that row and all that follows it take too long.
pub(crate) fn stop_at_next_row(otherwise: Option<String>) -> Result<()> {
    handle(move || {
        if STOPPED.swap(true, Ordering::Relaxed) {
            process::exit(errors::STOPPED.into());
        }
        if let Some(message) = otherwise.clone() {
            thread::spawn(|| {
                thread::sleep(END_WITHIN);
                errors::report(&Stopped(message).into());
                process::exit(errors::STOPPED.into());
            });
        }
    })
    .context("cannot listen for Ctrl-C")
}

/// Handles Ctrl-C for an analysis while the returned value exists: it stops at the next step, or after a second,
/// because nothing has to be stored. Otherwise, Ctrl-C ends the program at once.
pub(crate) fn stop_analysis() -> Computes {
    COMPUTES.store(true, Ordering::Relaxed);
    // Without a handler Ctrl-C ends the program at once, which is no error of the analysis.
    let _ = handle(|| {
        if STOPPED.swap(true, Ordering::Relaxed) || !COMPUTES.load(Ordering::Relaxed) {
            process::exit(errors::STOPPED.into());
        }
        thread::spawn(|| {
            thread::sleep(PATIENCE);
            if COMPUTES.load(Ordering::Relaxed) {
                errors::report(&Stopped("stopped before the end".to_owned()).into());
                process::exit(errors::STOPPED.into());
            }
        });
    });
    Computes
}

/// Part of a run in which Ctrl-C stops an analysis.
pub(crate) struct Computes;

impl Drop for Computes {
    fn drop(&mut self) {
        COMPUTES.store(false, Ordering::Relaxed);
    }
}

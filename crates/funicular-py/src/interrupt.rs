//! Long work without Python's lock, which ends at Ctrl-C.

use funicular_files::threads::in_order;
use funicular_study::Watch;
use pyo3::prelude::*;
use std::num::NonZeroUsize;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel, sync_channel};
use std::sync::{Arc, LazyLock};
use std::thread;
use std::time::{Duration, Instant};

/// Time between two checks for Ctrl-C.
const INTERVAL: Duration = Duration::from_millis(50);

/// Checks for Ctrl-C in code that does not hold Python's lock.
#[expect(clippy::redundant_closure_for_method_calls, reason = "the method is of one lifetime, the closure of any")]
pub(crate) fn check_signals() -> PyResult<()> {
    Python::attach(|py| py.check_signals())
}

/// Seconds since this function was first called.
pub(crate) fn seconds() -> f64 {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed().as_secs_f64()
}

/// Watch of work on a new thread, which stops at its next step after Ctrl-C.
#[derive(Clone, Default)]
struct Stop(Arc<AtomicBool>);

impl Watch for Stop {
    fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    fn now_s(&self) -> Option<f64> {
        Some(seconds())
    }
}

/// Runs work without steps on a new thread while the calling thread checks for signals.
///
/// At Ctrl-C the caller gets the exception at once; the thread ends when its work is done, and its result is dropped.
pub(crate) fn interruptible<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    interruptible_in_steps(py, |_| work())
}

/// Runs work on a new thread while the calling thread checks for signals.
///
/// At Ctrl-C the caller gets the exception at once; the thread ends at the next step of its work, and its result is
/// dropped.
pub(crate) fn interruptible_in_steps<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&mut dyn Watch) -> T + Send + 'static,
) -> PyResult<T> {
    let stop = Stop::default();
    let mut watch = stop.clone();
    until_signal(py, &stop, move || work(&mut watch), Some)
}

/// Runs work on a new thread while the calling thread checks for signals; Ctrl-C sets the flag that the work looks at.
///
/// The work ends at its next look and gives what it has, beside the exception. The exception of a second Ctrl-C comes
/// at once, and the result is dropped.
pub(crate) fn interruptible_by_flag<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&AtomicBool) -> T + Send + 'static,
) -> PyResult<(T, Option<PyErr>)> {
    let stop = Stop::default();
    let flag = Arc::clone(&stop.0);
    let mut raised = None;
    let found = until_signal(
        py,
        &stop,
        move || work(&flag),
        |error| match raised.replace(error) {
            Some(first) => raised.replace(first),
            None => None,
        },
    )?;
    Ok((found, raised))
}

/// Runs work on a new thread until it ends or a signal comes, which sets `stop`. `keep` takes the exception of a
/// signal, and gives back the one that ends the wait.
fn until_signal<T: Send + 'static>(
    py: Python<'_>,
    stop: &Stop,
    work: impl FnOnce() -> T + Send + 'static,
    mut keep: impl FnMut(PyErr) -> Option<PyErr> + Send,
) -> PyResult<T> {
    py.detach(|| {
        let (sender, receiver) = channel();
        let worker = thread::Builder::new().spawn(move || {
            // The receiver is gone after Ctrl-C.
            let _ = sender.send(work());
        })?;

        loop {
            match receiver.recv_timeout(INTERVAL) {
                Ok(result) => return Ok(result),
                Err(RecvTimeoutError::Timeout) => {
                    if let Err(error) = check_signals() {
                        stop.0.store(true, Ordering::Relaxed);
                        if let Some(error) = keep(error) {
                            return Err(error);
                        }
                    }
                }
                Err(RecvTimeoutError::Disconnected) => match worker.join() {
                    Err(panic) => std::panic::resume_unwind(panic),
                    Ok(()) => unreachable!("a worker that ends has sent its result"),
                },
            }
        }
    })
}

/// Maximum number of results that wait to be taken.
const MAX_WAITING: usize = 8;

/// Computes items on new threads, and passes the results in order to `take` on the calling thread.
///
/// `check` runs every [`INTERVAL`]. Its error ends the work: finished results are still taken, and the error is
/// returned.
pub(crate) fn on_threads<T: Send>(
    items: Range<usize>,
    threads: NonZeroUsize,
    compute: impl Fn(usize, &dyn Fn() -> bool) -> Option<T> + Sync,
    mut take: impl FnMut(T) -> PyResult<()>,
    mut check: impl FnMut() -> PyResult<()>,
) -> PyResult<()> {
    let cancel = AtomicBool::new(false);
    thread::scope(|scope| {
        let (sender, receiver) = sync_channel(MAX_WAITING);
        let (cancel, compute) = (&cancel, &compute);
        let runner = scope.spawn(move || in_order(items, threads, cancel, compute, |item| sender.send(item)));
        let ended = hand_over(&receiver, cancel, &mut take, &mut check);

        // The remaining results are not needed.
        cancel.store(true, Ordering::Relaxed);
        drop(receiver);
        match runner.join() {
            Err(panic) => std::panic::resume_unwind(panic),
            Ok(_) => ended,
        }
    })
}

/// Passes results to `take` in their order of arrival, until the last one or the first that cannot be taken.
///
/// An error of `check` sets `cancel`; finished results are still taken, and the error is returned.
fn hand_over<T>(
    arriving: &Receiver<T>,
    cancel: &AtomicBool,
    take: &mut impl FnMut(T) -> PyResult<()>,
    check: &mut impl FnMut() -> PyResult<()>,
) -> PyResult<()> {
    let mut checked = Instant::now();
    loop {
        match arriving.recv_timeout(INTERVAL) {
            Ok(result) => take(result)?,
            Err(RecvTimeoutError::Disconnected) => return Ok(()),
            Err(RecvTimeoutError::Timeout) => {}
        }

        if checked.elapsed() < INTERVAL {
            continue;
        }
        checked = Instant::now();
        if let Err(interrupt) = check() {
            cancel.store(true, Ordering::Relaxed);
            // Finished results are kept. An error of `take` is dropped here: the interrupt is reported.
            let _ = arriving.iter().try_for_each(take);
            return Err(interrupt);
        }
    }
}

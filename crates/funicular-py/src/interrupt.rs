//! Long work without Python's lock, given up at Ctrl-C.

use funicular_files::threads::in_order;
use pyo3::prelude::*;
use std::num::NonZeroUsize;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

/// Time between two looks for Ctrl-C.
const LOOK: Duration = Duration::from_millis(50);

/// Looks for Ctrl-C, from where Python's lock is not held.
#[expect(clippy::redundant_closure_for_method_calls, reason = "the method is of one lifetime, the closure of any")]
pub(crate) fn look() -> PyResult<()> {
    Python::attach(|py| py.check_signals())
}

/// Does work on a thread of its own while this one looks for signals. At Ctrl-C the caller has its lock and its exception
/// at once; the thread ends when its work is done, and nobody sees the result.
pub(crate) fn interruptible<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    py.detach(|| {
        let (sender, receiver) = channel();
        let worker = thread::Builder::new().spawn(move || {
            // Nobody listens after Ctrl-C.
            let _ = sender.send(work());
        })?;
        loop {
            match receiver.recv_timeout(LOOK) {
                Ok(result) => return Ok(result),
                Err(RecvTimeoutError::Timeout) => look()?,
                Err(RecvTimeoutError::Disconnected) => match worker.join() {
                    Err(panic) => std::panic::resume_unwind(panic),
                    Ok(()) => unreachable!("a worker that ends has sent its result"),
                },
            }
        }
    })
}

/// Results that may wait between the threads and who takes them.
const WAITING: usize = 8;

/// Computes items on threads of this call alone, and hands them over in order to this one, which looks for Ctrl-C. An error
/// of `look` asks for the end, takes what is finished, and is the result.
pub(crate) fn on_threads<T: Send>(
    items: Range<usize>,
    threads: NonZeroUsize,
    compute: impl Fn(usize, &dyn Fn() -> bool) -> Option<T> + Sync,
    mut take: impl FnMut(T) -> PyResult<()>,
    mut look: impl FnMut() -> PyResult<()>,
) -> PyResult<()> {
    let cancel = AtomicBool::new(false);
    thread::scope(|scope| {
        let (sender, receiver) = sync_channel(WAITING);
        let (cancel, compute) = (&cancel, &compute);
        let runner = scope.spawn(move || in_order(items, threads, cancel, compute, |item| sender.send(item)));
        let ended = hand_over(&receiver, cancel, &mut take, &mut look);

        // Nobody takes the rest.
        cancel.store(true, Ordering::Relaxed);
        drop(receiver);
        match runner.join() {
            Err(panic) => std::panic::resume_unwind(panic),
            Ok(_) => ended,
        }
    })
}

/// Hands over results as they come, until there are none or one cannot be taken: then none behind it can, either. An
/// error of `look` asks with `cancel` for the end, takes what is finished, and is the result.
fn hand_over<T>(
    arriving: &Receiver<T>,
    cancel: &AtomicBool,
    take: &mut impl FnMut(T) -> PyResult<()>,
    look: &mut impl FnMut() -> PyResult<()>,
) -> PyResult<()> {
    let mut looked = Instant::now();
    loop {
        match arriving.recv_timeout(LOOK) {
            Ok(result) => take(result)?,
            Err(RecvTimeoutError::Disconnected) => return Ok(()),
            Err(RecvTimeoutError::Timeout) => {}
        }
        if looked.elapsed() < LOOK {
            continue;
        }
        looked = Instant::now();
        if let Err(interrupt) = look() {
            cancel.store(true, Ordering::Relaxed);
            // What is finished is not thrown away; if it cannot be taken, the reason to end is known already.
            let _ = arriving.iter().try_for_each(take);
            return Err(interrupt);
        }
    }
}

//! Work on several threads, handed over in order; how many threads there may be.

use funicular_study::sweep::{Chunk, Plan};
use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::ops::{Range, RangeInclusive};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex, PoisonError, mpsc};
use std::thread;

/// Numbers of threads that may be requested.
pub const THREADS: RangeInclusive<usize> = 1..=1024;

/// Checks a number of threads.
///
/// # Example
/// ```
/// use funicular_files::threads;
///
/// assert_eq!(threads::checked(8).map(usize::from), Some(8));
/// assert!(threads::checked(0).is_none() && threads::checked(1025).is_none());
/// ```
pub fn checked(count: usize) -> Option<NonZeroUsize> {
    NonZeroUsize::new(count).filter(|_| THREADS.contains(&count))
}

/// The number requested, or one thread per processor.
pub fn or_all(requested: Option<NonZeroUsize>) -> NonZeroUsize {
    requested.unwrap_or_else(|| thread::available_parallelism().unwrap_or(NonZeroUsize::MIN))
}

/// Items that may be finished ahead of the next one that is due, per thread: this bounds the memory, and how long one slow
/// item may hold up the others.
const AHEAD: usize = 8;

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// Every item was delivered.
    Complete,
    /// It was cancelled; every item before this one was delivered.
    Cancelled {
        /// The first that was not.
        next: usize,
    },
}

/// What the threads share.
struct Shared {
    next: AtomicUsize,
    stop: AtomicBool,
    /// The item that is due.
    due: Mutex<usize>,
    moved: Condvar,
}

impl Shared {
    fn stop(&self) {
        self.stop.store(true, Ordering::Relaxed);
        // Taken, so that nobody is between looking and waiting.
        drop(self.due.lock().unwrap_or_else(PoisonError::into_inner));
        self.moved.notify_all();
    }
}

/// Stops the others when a thread ends by a panic; they would wait for its item for ever.
struct Guard<'a>(&'a Shared);

impl Drop for Guard<'_> {
    fn drop(&mut self) {
        if thread::panicking() {
            self.0.stop();
        }
    }
}

/// Computes chunks of a plan on threads of this call alone, and delivers them in order to the calling thread. The results
/// do not depend on the number of threads. Raised from any thread, `cancel` ends the run between two points.
///
/// # Errors
/// The first error of `deliver`; it ends the run.
pub fn run<E>(
    plan: &Plan<'_>,
    chunks: Range<usize>,
    threads: NonZeroUsize,
    cancel: &AtomicBool,
    deliver: impl FnMut(Chunk) -> Result<(), E>,
) -> Result<Outcome, E> {
    in_order(chunks, threads, cancel, |index, given_up| plan.evaluate(index, given_up), deliver)
}

/// Computes items on threads of this call alone, and delivers them in order to the calling thread. `compute` takes the
/// number of the item, and a question to ask now and then: whether to give up, with `None`.
///
/// A pool that outlives the call would not survive a fork, and the process pools of Python fork.
///
/// # Errors
/// The first error of `deliver`; it ends the run.
pub fn in_order<T: Send, E>(
    items: Range<usize>,
    threads: NonZeroUsize,
    cancel: &AtomicBool,
    compute: impl Fn(usize, &dyn Fn() -> bool) -> Option<T> + Sync,
    mut deliver: impl FnMut(T) -> Result<(), E>,
) -> Result<Outcome, E> {
    let shared = Shared {
        next: AtomicUsize::new(items.start),
        stop: AtomicBool::new(false),
        due: Mutex::new(items.start),
        moved: Condvar::new(),
    };
    let lead = AHEAD.saturating_mul(threads.get());
    let (finished, arriving) = mpsc::channel::<(usize, T)>();
    thread::scope(|scope| {
        for _ in 0..threads.get().min(items.len()) {
            let (shared, items, compute, finished) = (&shared, &items, &compute, finished.clone());
            scope.spawn(move || {
                let _guard = Guard(shared);
                let given_up = || cancel.load(Ordering::Relaxed) || shared.stop.load(Ordering::Relaxed);
                while let Some(index) = take(shared, items, lead) {
                    let Some(item) = compute(index, &given_up) else { break };
                    if finished.send((index, item)).is_err() {
                        break;
                    }
                }
            });
        }
        drop(finished);

        // Items arrive in any order; those that are ahead wait for the one that is due.
        let mut waiting = BTreeMap::new();
        let mut due = items.start;
        for (index, item) in arriving {
            waiting.insert(index, item);
            while let Some(item) = waiting.remove(&due) {
                if let Err(error) = deliver(item) {
                    shared.stop();
                    return Err(error);
                }
                due += 1;
            }
            *shared.due.lock().unwrap_or_else(PoisonError::into_inner) = due;
            shared.moved.notify_all();
            if cancel.load(Ordering::Relaxed) {
                shared.stop();
            }
        }
        Ok(if due == items.end { Outcome::Complete } else { Outcome::Cancelled { next: due } })
    })
}

/// The next item to compute, when it is not too far ahead of the one that is due.
fn take(shared: &Shared, items: &Range<usize>, lead: usize) -> Option<usize> {
    let index = shared.next.fetch_add(1, Ordering::Relaxed);
    if index >= items.end {
        return None;
    }
    let mut due = shared.due.lock().unwrap_or_else(PoisonError::into_inner);
    while index >= due.saturating_add(lead) && !shared.stop.load(Ordering::Relaxed) {
        due = shared.moved.wait(due).unwrap_or_else(PoisonError::into_inner);
    }
    (!shared.stop.load(Ordering::Relaxed)).then_some(index)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    /// Items of very different size, each its square.
    fn squares(threads: usize, cancel: &AtomicBool, stop_at: Option<usize>) -> (Result<Outcome, usize>, Vec<usize>) {
        let mut delivered = Vec::new();
        let compute = |index: usize, given_up: &dyn Fn() -> bool| {
            for _ in 0..(index % 7) * 1000 {
                std::hint::black_box(index);
            }
            (!given_up()).then_some(index * index)
        };
        let outcome = in_order(3..200, NonZeroUsize::new(threads).unwrap(), cancel, compute, |square| {
            delivered.push(square);
            if stop_at == Some(square) { Err(square) } else { Ok(()) }
        });
        (outcome, delivered)
    }

    #[test]
    fn items_come_in_order_on_any_number_of_threads() {
        let expected: Vec<usize> = (3..200).map(|i| i * i).collect();
        for threads in [1, 2, 7, 300] {
            assert_eq!(squares(threads, &AtomicBool::new(false), None), (Ok(Outcome::Complete), expected.clone()));
        }
    }

    #[test]
    fn a_run_that_is_cancelled_or_refused_ends_behind_whole_items() {
        let (refused, delivered) = squares(3, &AtomicBool::new(false), Some(100));
        assert_eq!((refused, delivered), (Err(100), (3..=10).map(|i| i * i).collect()));

        let cancel = AtomicBool::new(false);
        let mut delivered = Vec::new();
        let outcome = in_order(
            0..1000,
            NonZeroUsize::MIN,
            &cancel,
            |index, _| Some(index),
            |index| {
                delivered.push(index);
                cancel.store(index == 5, Ordering::Relaxed);
                Ok::<(), Infallible>(())
            },
        );
        let Ok(Outcome::Cancelled { next }) = outcome else { panic!("{outcome:?}") };
        assert!(next >= 6 && delivered == (0..next).collect::<Vec<_>>(), "{next}");
    }

    #[test]
    fn a_panic_of_one_thread_does_not_leave_the_others_waiting() {
        let run = || {
            in_order(
                0..500,
                NonZeroUsize::new(2).unwrap(),
                &AtomicBool::new(false),
                |index, _| {
                    assert!(index != 20, "on purpose");
                    Some(index)
                },
                |_| Ok::<(), Infallible>(()),
            )
        };
        assert!(std::panic::catch_unwind(run).is_err());
    }
}

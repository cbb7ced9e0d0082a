//! Parallel work on several threads with results delivered in order; limits on the number of threads.

use funicular_study::sweep::Plan;
use funicular_study::table::Chunk;
use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::ops::{Range, RangeInclusive};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex, PoisonError, mpsc};
use std::thread;

/// Allowed numbers of threads.
pub const THREADS: RangeInclusive<usize> = 1..=1024;

/// Checks a requested number of threads; `None` if it is outside [`THREADS`].
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

/// Requested number of threads; by default one thread per processor.
pub fn or_all(requested: Option<NonZeroUsize>) -> NonZeroUsize {
    requested.unwrap_or_else(|| thread::available_parallelism().unwrap_or(NonZeroUsize::MIN))
}

/// Maximum number of items per thread that may be computed ahead of the next item to deliver. A large number costs
/// memory; a small number makes the other threads wait for one slow item.
const AHEAD: usize = 8;

/// End of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// Every item was delivered.
    Complete,
    /// The run was cancelled; every item before `next` was delivered.
    Cancelled {
        /// First item that was not delivered.
        next: usize,
    },
}

/// State shared by the threads.
struct Shared {
    next: AtomicUsize,
    stop: AtomicBool,
    /// Next item to deliver.
    due: Mutex<usize>,
    moved: Condvar,
}

impl Shared {
    fn stop(&self) {
        self.stop.store(true, Ordering::Relaxed);
        // Take the lock once, so that no thread can miss the wake-up between its check and its wait.
        drop(self.due.lock().unwrap_or_else(PoisonError::into_inner));
        self.moved.notify_all();
    }
}

/// Stops the other threads if a thread panics; otherwise they would wait forever for its item.
struct StopOnPanic<'a>(&'a Shared);

impl Drop for StopOnPanic<'_> {
    fn drop(&mut self) {
        if thread::panicking() {
            self.0.stop();
        }
    }
}

/// Computes chunks of a plan on threads of this call and delivers them in order to the calling thread. The results do
/// not depend on the number of threads. Setting `cancel` from any thread ends the run between two points.
///
/// # Errors
/// First error of `deliver`, which ends the run.
pub fn run<E>(
    plan: &Plan<'_>,
    chunks: Range<usize>,
    threads: NonZeroUsize,
    cancel: &AtomicBool,
    deliver: impl FnMut(Chunk) -> Result<(), E>,
) -> Result<Outcome, E> {
    in_order(chunks, threads, cancel, |index, given_up| plan.evaluate(index, given_up), deliver)
}

/// Computes items on threads of this call and delivers them in order to the calling thread.
///
/// `compute` takes the number of the item and a function that it has to call regularly: if the function returns true,
/// `compute` stops and returns `None`.
///
/// The threads end with the call. A pool that outlives the call would not survive a fork, and Python's process pools
/// fork.
///
/// # Errors
/// First error of `deliver`, which ends the run.
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
    let mut started = 0;
    let (finished, arriving) = mpsc::channel::<(usize, T)>();

    thread::scope(|scope| {
        for _ in 0..threads.get().min(items.len()) {
            let (shared, items, compute, finished) = (&shared, &items, &compute, finished.clone());
            let thread = thread::Builder::new().spawn_scoped(scope, move || {
                let _guard = StopOnPanic(shared);
                let given_up = || cancel.load(Ordering::Relaxed) || shared.stop.load(Ordering::Relaxed);
                while let Some(index) = take(shared, items, lead) {
                    let Some(item) = compute(index, &given_up) else { break };
                    if finished.send((index, item)).is_err() {
                        break;
                    }
                }
            });
            // Not every system has threads, or more of them.
            started += usize::from(thread.is_ok());
        }
        drop(finished);
        if started == 0 {
            return alone(items.clone(), cancel, &compute, &mut deliver);
        }

        // Items arrive in any order; an early item waits until the items before it have been delivered.
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

/// Computes items one after the other on the calling thread and delivers each.
fn alone<T, E>(
    items: Range<usize>,
    cancel: &AtomicBool,
    compute: &impl Fn(usize, &dyn Fn() -> bool) -> Option<T>,
    deliver: &mut impl FnMut(T) -> Result<(), E>,
) -> Result<Outcome, E> {
    let given_up = || cancel.load(Ordering::Relaxed);
    for next in items {
        let item = if given_up() { None } else { compute(next, &given_up) };
        let Some(item) = item else { return Ok(Outcome::Cancelled { next }) };
        deliver(item)?;
    }
    Ok(Outcome::Complete)
}

/// Returns the next item to compute; waits while it is too far ahead of the next item to deliver.
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

    /// Squares of numbers; the time per item varies strongly.
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
    fn a_run_that_is_cancelled_or_refused_delivers_a_contiguous_range_of_items() {
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
    fn a_system_without_threads_delivers_the_same_items() {
        let square = |index: usize, given_up: &dyn Fn() -> bool| (!given_up()).then_some(index * index);
        let (cancel, mut delivered) = (AtomicBool::new(false), Vec::new());
        let run = |stop_at: usize, delivered: &mut Vec<usize>| {
            alone(3..200, &cancel, &square, &mut |found| {
                delivered.push(found);
                cancel.store(found == stop_at, Ordering::Relaxed);
                if found == 10_000 && stop_at == 0 { Err(found) } else { Ok(()) }
            })
        };
        assert_eq!(run(0, &mut delivered), Err(10_000));
        assert_eq!(delivered, (3..=100).map(|i| i * i).collect::<Vec<usize>>());

        delivered.clear();
        assert_eq!(run(25, &mut delivered), Ok(Outcome::Cancelled { next: 6 }));
        assert_eq!(delivered, [9, 16, 25]);
        cancel.store(false, Ordering::Relaxed);
        delivered.clear();
        assert_eq!(run(1, &mut delivered), Ok(Outcome::Complete));
        assert_eq!(delivered, squares(2, &AtomicBool::new(false), None).1);
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

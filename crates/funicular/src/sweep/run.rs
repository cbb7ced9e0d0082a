//! Chunks on several threads, handed over in order.

use super::{Chunk, Plan};
use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex, PoisonError, mpsc};
use std::thread;

/// Chunks that may be finished ahead of the next one that is due, for each thread: what memory is bounded by, and what
/// one slow chunk may hold up.
const AHEAD: usize = 8;

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// Every chunk was delivered.
    Complete,
    /// It was cancelled; every chunk before this one was delivered.
    Cancelled {
        /// The first that was not.
        next: usize,
    },
}

/// What the threads share.
struct Shared {
    next: AtomicUsize,
    stop: AtomicBool,
    /// The chunk that is due.
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

/// Stops the others when a thread ends by a panic; they would wait for its chunk for ever.
struct Guard<'a>(&'a Shared);

impl Drop for Guard<'_> {
    fn drop(&mut self) {
        if thread::panicking() {
            self.0.stop();
        }
    }
}

impl Plan<'_> {
    /// Computes chunks on `threads` threads and delivers them in order to this one. The results do not depend on the
    /// number of threads. Raised from any thread, `cancel` ends it between two points.
    ///
    /// # Errors
    /// What `deliver` returns; it ends the run.
    pub fn run<E>(
        &self,
        chunks: Range<usize>,
        threads: NonZeroUsize,
        cancel: &AtomicBool,
        mut deliver: impl FnMut(Chunk) -> Result<(), E>,
    ) -> Result<Outcome, E> {
        let shared = Shared {
            next: AtomicUsize::new(chunks.start),
            stop: AtomicBool::new(false),
            due: Mutex::new(chunks.start),
            moved: Condvar::new(),
        };
        let lead = AHEAD.saturating_mul(threads.get());
        let (finished, arriving) = mpsc::channel::<Chunk>();
        thread::scope(|scope| {
            for _ in 0..threads.get().min(chunks.len()) {
                let (shared, chunks, finished) = (&shared, &chunks, finished.clone());
                scope.spawn(move || {
                    let _guard = Guard(shared);
                    while let Some(index) = take(shared, chunks, lead) {
                        let given_up = || cancel.load(Ordering::Relaxed) || shared.stop.load(Ordering::Relaxed);
                        let Some(chunk) = self.evaluate(index, given_up) else { break };
                        if finished.send(chunk).is_err() {
                            break;
                        }
                    }
                });
            }
            drop(finished);
            let mut waiting = BTreeMap::new();
            let mut due = chunks.start;
            for chunk in arriving {
                waiting.insert(chunk.index, chunk);
                while let Some(chunk) = waiting.remove(&due) {
                    if let Err(error) = deliver(chunk) {
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
            Ok(if due == chunks.end { Outcome::Complete } else { Outcome::Cancelled { next: due } })
        })
    }
}

/// The next chunk to compute, when it is not too far ahead of the one that is due.
fn take(shared: &Shared, chunks: &Range<usize>, lead: usize) -> Option<usize> {
    let index = shared.next.fetch_add(1, Ordering::Relaxed);
    if index >= chunks.end {
        return None;
    }
    let mut due = shared.due.lock().unwrap_or_else(PoisonError::into_inner);
    while index >= due.saturating_add(lead) && !shared.stop.load(Ordering::Relaxed) {
        due = shared.moved.wait(due).unwrap_or_else(PoisonError::into_inner);
    }
    (!shared.stop.load(Ordering::Relaxed)).then_some(index)
}

//! Entries of a queue from which that with the least lower bound comes first.

use std::cmp::Ordering;

/// Entry of a [`BinaryHeap`](std::collections::BinaryHeap), whose greatest is that with the least bound.
pub(super) struct Bounded<T> {
    /// Lower bound of what is searched.
    pub(super) lower: f64,
    /// Thing that has this bound.
    pub(super) of: T,
}

impl<T> PartialEq for Bounded<T> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl<T> Eq for Bounded<T> {}

impl<T> PartialOrd for Bounded<T> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<T> Ord for Bounded<T> {
    fn cmp(&self, other: &Self) -> Ordering {
        other.lower.total_cmp(&self.lower)
    }
}

//! Allocator that counts what the present thread reserves.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

struct Counting;

thread_local! {
    static RESERVED: Cell<usize> = const { Cell::new(0) };
}

unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        RESERVED.with(|count| count.set(count.get() + 1));
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, address: *mut u8, layout: Layout) {
        unsafe { System.dealloc(address, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// Result of work, and how often it reserved memory.
pub(crate) fn reserved<T>(work: impl FnOnce() -> T) -> (T, usize) {
    let before = RESERVED.with(Cell::get);
    let result = work();
    (result, RESERVED.with(Cell::get) - before)
}

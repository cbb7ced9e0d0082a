//! Checks and copies of memory that the caller hands over.

use crate::layout::Sized32;
use crate::status::{BAD_INPUT, BAD_POINTER, BAD_STRUCT};
use funicular::control_loop::{LoopInput, MAX_CABLES, pose_from_quaternion};
use funicular::math::{Vec3, Vec6};
use funicular::path::PathPoint;
use std::ffi::c_char;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::{mem, ptr};

/// Result of a step at the border: a value, or the status to return.
pub(crate) type Checked<T> = Result<T, i32>;

/// Refuses an address that is missing or not aligned for its type.
pub(crate) fn check<T>(address: *const T) -> Checked<()> {
    if address.is_null() || !address.is_aligned() { Err(BAD_POINTER) } else { Ok(()) }
}

/// Runs code that must not unwind into another language; `None` after a panic.
pub(crate) fn guarded<T>(work: impl FnOnce() -> T) -> Option<T> {
    catch_unwind(AssertUnwindSafe(work)).ok()
}

/// Copy of a caller's struct, whole members only; those beyond its size are zero.
///
/// # Safety
/// If not null, `from` points to as many readable bytes as the number there says.
pub(crate) unsafe fn read_struct<T: Sized32>(from: *const T) -> Checked<T> {
    check(from)?;
    // SAFETY: not null, aligned, and the caller gives at least the size.
    let given = unsafe { from.cast::<u32>().read() } as usize;
    if given < T::LEAST {
        return Err(BAD_STRUCT);
    }
    let mut whole = T::default();
    // Every member that may be missing has eight bytes.
    let bytes = whole_members::<T>(given);
    // SAFETY: the caller gives `given` bytes, `whole` has at least `bytes`, and any bits are a value (see `Sized32`).
    unsafe { ptr::copy_nonoverlapping(from.cast::<u8>(), (&raw mut whole).cast::<u8>(), bytes) };
    Ok(whole)
}

/// Writes a struct back to the caller, as far as its size reaches.
///
/// # Safety
/// As for [`read_struct`], and the bytes are writable.
pub(crate) unsafe fn write_struct<T: Sized32>(to: *mut T, value: &T, given: u32) {
    let bytes = whole_members::<T>(given as usize);
    // SAFETY: both have at least `bytes`.
    unsafe { ptr::copy_nonoverlapping(ptr::from_ref(value).cast::<u8>(), to.cast::<u8>(), bytes) };
}

fn whole_members<T>(given: usize) -> usize {
    let bytes = given.min(mem::size_of::<T>());
    bytes - bytes % 8
}

/// Copy of an array of the caller.
///
/// # Safety
/// If not null, `from` points to `count` readable numbers.
pub(crate) unsafe fn read_array(from: *const f64, count: usize) -> Checked<[f64; MAX_CABLES]> {
    check(from)?;
    let mut values = [0.0; MAX_CABLES];
    let count = count.min(values.len());
    // SAFETY: not null, aligned; `values` has room for `count`.
    unsafe { ptr::copy_nonoverlapping(from, values.as_mut_ptr(), count) };
    Ok(values)
}

/// Refuses an array that is wanted and not aligned; null means not wanted.
pub(crate) fn check_wanted(to: *mut f64) -> Checked<()> {
    if to.is_null() { Ok(()) } else { check(to) }
}

/// Writes values to an array of the caller, if it is wanted.
///
/// # Safety
/// If not null, `to` is aligned and points to as many writable numbers as there are values.
pub(crate) unsafe fn write_array(to: *mut f64, values: impl Iterator<Item = f64>) {
    if to.is_null() {
        return;
    }
    for (i, value) in values.enumerate() {
        // SAFETY: the caller has room for all values.
        unsafe { to.add(i).write(value) };
    }
}

/// Writes a text with a zero at its end, cut where the memory ends; returns nothing if there is no memory.
///
/// # Safety
/// If not null, `to` points to `bytes` writable bytes.
pub(crate) unsafe fn write_text(to: *mut c_char, bytes: usize, text: &str) {
    if to.is_null() || bytes == 0 {
        return;
    }
    let mut end = text.len().min(bytes - 1);
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    // SAFETY: `end` bytes and the zero have room.
    unsafe {
        ptr::copy_nonoverlapping(text.as_ptr(), to.cast::<u8>(), end);
        to.add(end).write(0);
    }
}

/// Input of the core.
pub(crate) fn loop_input(input: &crate::layout::PoseInput) -> Checked<LoopInput> {
    let pose = pose_from_quaternion(input.position_m, input.quaternion_wxyz).ok_or(BAD_INPUT)?;
    let six = |a: [f64; 3], b: [f64; 3]| Vec6::new(a[0], a[1], a[2], b[0], b[1], b[2]);
    let motion = PathPoint {
        pose,
        velocity_w: six(input.velocity_m_s, input.angular_velocity_rad_s),
        acceleration_w: six(input.acceleration_m_s2, input.angular_acceleration_rad_s2),
        jerk_w: Vec6::zeros(),
    };
    Ok(LoopInput { motion, force_w: Vec3::from(input.force_n), moment_w: Vec3::from(input.moment_n_m) })
}

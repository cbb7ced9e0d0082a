//! Objects that the library owns behind their addresses: one thread at a time, of no use after a panic.

use crate::border::{Checked, check, guarded, write_text};
use crate::status::{BAD_HANDLE, BAD_INPUT, BAD_MODEL, BAD_POINTER, BUSY, CERTIFIED, PANIC, POISONED, text};
use funicular::control_loop::pose_from_quaternion;
use funicular::robot::{Pose, Robot};
use std::borrow::Cow;
use std::cell::UnsafeCell;
use std::ffi::c_char;
use std::slice;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Number that says what is at an address; zero after its end.
pub trait OwnedKind {
    /// The number.
    const KIND: u64;
}

/// Object of the library with its state.
pub struct Owned<T> {
    kind: AtomicU64,
    busy: AtomicBool,
    poisoned: AtomicBool,
    state: UnsafeCell<T>,
}

/// Status with the message that tells it.
pub(crate) type Told<T> = Result<T, (i32, Cow<'static, str>)>;

/// Memory of the caller for a message.
#[derive(Clone, Copy)]
pub(crate) struct MessageRoom {
    pub(crate) to: *mut c_char,
    pub(crate) bytes: usize,
}

impl MessageRoom {
    /// No message.
    pub(crate) const NONE: Self = Self { to: std::ptr::null_mut(), bytes: 0 };
}

/// Status with its own text.
pub(crate) fn silent(status: i32) -> (i32, Cow<'static, str>) {
    (status, Cow::Borrowed(text(status)))
}

impl<T: OwnedKind> Owned<T> {
    /// Makes an object and writes its address, or the message.
    ///
    /// # Safety
    /// If not null, `out` may be written, and the message has its number of bytes.
    pub(crate) unsafe fn make(out: *mut *mut Self, message: MessageRoom, make: impl FnOnce() -> Told<T>) -> i32 {
        let make = || -> Told<Box<Self>> {
            check(out).map_err(silent)?;
            let state = UnsafeCell::new(make()?);
            let (kind, busy, poisoned) = (AtomicU64::new(T::KIND), AtomicBool::new(false), AtomicBool::new(false));
            Ok(Box::new(Self { kind, busy, poisoned, state }))
        };
        let (status, why) = match guarded(make).unwrap_or_else(|| Err(silent(PANIC))) {
            Ok(owned) => {
                // SAFETY: `out` was checked.
                unsafe { out.write(Box::into_raw(owned)) };
                (CERTIFIED, Cow::Borrowed(""))
            }
            Err(told) => told,
        };
        // SAFETY: promised by the caller.
        unsafe { write_text(message.to, message.bytes, &why) };
        status
    }

    /// Runs a call with the state of the object at an address, one thread at a time, and writes the message.
    ///
    /// # Safety
    /// If not null, the address was returned by this library, and the object was not freed. The message has its number
    /// of bytes.
    pub(crate) unsafe fn call(
        address: *const Self,
        message: MessageRoom,
        work: impl FnOnce(&mut T) -> Told<()>,
    ) -> i32 {
        // SAFETY: promised by the caller.
        let (status, why) = match unsafe { Self::run(address, work) } {
            Ok(()) => (CERTIFIED, Cow::Borrowed("")),
            Err(told) => told,
        };
        // SAFETY: promised by the caller.
        unsafe { write_text(message.to, message.bytes, &why) };
        status
    }

    /// # Safety
    /// As for [`Self::call`].
    unsafe fn run(address: *const Self, work: impl FnOnce(&mut T) -> Told<()>) -> Told<()> {
        // SAFETY: promised by the caller.
        let this = unsafe { Self::at(address) }.map_err(silent)?;
        if this.busy.compare_exchange(false, true, Ordering::Acquire, Ordering::Relaxed).is_err() {
            return Err(silent(BUSY));
        }
        let done = if this.poisoned.load(Ordering::Relaxed) {
            Err(silent(POISONED))
        } else {
            // SAFETY: `busy` makes this the only reference to the state.
            let state = unsafe { &mut *this.state.get() };
            guarded(|| work(state)).unwrap_or_else(|| {
                this.poisoned.store(true, Ordering::Relaxed);
                Err(silent(PANIC))
            })
        };
        this.busy.store(false, Ordering::Release);
        done
    }

    /// Object at an address.
    ///
    /// # Safety
    /// As for [`Self::call`].
    unsafe fn at<'a>(address: *const Self) -> Checked<&'a Self> {
        check(address)?;
        // SAFETY: the caller promises that an object is there.
        let this = unsafe { &*address };
        if this.kind.load(Ordering::Acquire) == T::KIND { Ok(this) } else { Err(BAD_HANDLE) }
    }

    /// Ends the object at an address, and frees its memory.
    ///
    /// # Safety
    /// As for [`Self::call`].
    pub(crate) unsafe fn free(address: *mut Self) -> i32 {
        if address.is_null() {
            return CERTIFIED;
        }
        // SAFETY: promised by the caller.
        let this = match unsafe { Self::at(address) } {
            Ok(this) => this,
            Err(status) => return status,
        };
        if this.busy.compare_exchange(false, true, Ordering::Acquire, Ordering::Relaxed).is_err() {
            return BUSY;
        }
        this.kind.store(0, Ordering::Release);
        // SAFETY: it came from `Box::into_raw`, and no other thread is in it.
        guarded(|| drop(unsafe { Box::from_raw(address) })).map_or(PANIC, |()| CERTIFIED)
    }
}

/// Memory of a caller that is read: `count` values.
///
/// # Safety
/// If not null, the address has that many values, which nobody writes during the call.
pub(crate) unsafe fn read<'a, T>(from: *const T, count: usize) -> Checked<&'a [T]> {
    check(from)?;
    if count > isize::MAX as usize / size_of::<T>() {
        return Err(BAD_POINTER);
    }
    // SAFETY: not null, aligned, and promised by the caller.
    Ok(unsafe { slice::from_raw_parts(from, count) })
}

/// Robot of the text of a file.
pub(crate) fn robot_of_bytes(bytes: &[u8]) -> Told<Robot> {
    let name = "robot file";
    let text = str::from_utf8(bytes).map_err(|error| (BAD_MODEL, format!("{name} is not UTF-8: {error}").into()))?;
    Robot::from_toml(text).map_err(|error| (BAD_MODEL, error.render(name, text, false).into()))
}

/// Pose of x, y, z and a quaternion at an address; `None` if it is null.
///
/// # Safety
/// If not null, the address has seven numbers.
pub(crate) unsafe fn pose_at(address: *const f64) -> Told<Option<Pose>> {
    if address.is_null() {
        return Ok(None);
    }
    // SAFETY: promised by the caller.
    let numbers = unsafe { read(address, 7) }.map_err(silent)?;
    let [x, y, z, quaternion @ ..] = numbers else { return Err(silent(BAD_INPUT)) };
    let quaternion: [f64; 4] = quaternion.try_into().map_err(|_| silent(BAD_INPUT))?;
    pose_from_quaternion([*x, *y, *z], quaternion).map(Some).ok_or_else(|| silent(BAD_INPUT))
}

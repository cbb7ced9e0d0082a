//! Exported functions of set-up: version, texts, models, memory of loops.

use crate::border::{Checked, check, guarded, write_text};
use crate::handles::{Loop, Model};
use crate::status::{BAD_HANDLE, BAD_MEMORY, BAD_MODEL, BAD_POINTER, CERTIFIED, IN_USE, NOT_FOR_LOOP, PANIC, text};
use funicular::control_loop::LoopModel;
use funicular::robot::Robot;
use std::ffi::{CStr, c_char, c_void};
use std::{mem, ptr, slice};

/// Version of the functions and structs.
pub const ABI_VERSION: i32 = 1;

/// Largest robot file [bytes]: a thousand times the usual size.
const MAX_FILE: u64 = 16 << 20;

/// `fn_abi_version`: version of the functions and structs.
#[unsafe(no_mangle)]
pub extern "C" fn fn_abi_version() -> i32 {
    ABI_VERSION
}

/// `fn_status_text`: text of a status.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_status_text(status: i32, to: *mut c_char, bytes: usize) -> i32 {
    if to.is_null() || bytes == 0 {
        return BAD_POINTER;
    }
    // SAFETY: the caller gives `bytes`.
    unsafe { write_text(to, bytes, text(status)) };
    CERTIFIED
}

/// `fn_model_from_toml`: model of the text of a robot file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_model_from_toml(
    toml: *const c_char,
    bytes: usize,
    out: *mut *mut Model,
    message: *mut c_char,
    message_bytes: usize,
) -> i32 {
    if toml.is_null() || bytes > isize::MAX as usize {
        return BAD_POINTER;
    }
    if let Err(status) = check(out) {
        return status;
    }
    // SAFETY: the caller gives `bytes` that nobody writes during the call.
    let toml = unsafe { slice::from_raw_parts(toml.cast::<u8>(), bytes) };
    // SAFETY: `out` was checked, and the message has its number of bytes.
    unsafe { give_model(|| model_of_bytes("robot file", toml), out, message, message_bytes) }
}

/// `fn_model_from_file`: model of a robot file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_model_from_file(
    path: *const c_char,
    out: *mut *mut Model,
    message: *mut c_char,
    message_bytes: usize,
) -> i32 {
    if path.is_null() {
        return BAD_POINTER;
    }
    if let Err(status) = check(out) {
        return status;
    }
    // SAFETY: the caller gives a text with a zero at its end.
    let path = unsafe { CStr::from_ptr(path) };
    let make = || {
        let path = path.to_str().map_err(|_| (BAD_MODEL, "the path is not UTF-8".to_owned()))?;
        let refused = |error: std::io::Error| (BAD_MODEL, format!("{path} cannot be read: {error}"));
        let size = std::fs::metadata(path).map_err(refused)?.len();
        if size > MAX_FILE {
            return Err((BAD_MODEL, format!("{path} has {size} bytes: a robot file has at most {MAX_FILE}")));
        }
        model_of_bytes(path, &std::fs::read(path).map_err(refused)?)
    };
    // SAFETY: `out` was checked, and the message has its number of bytes.
    unsafe { give_model(make, out, message, message_bytes) }
}

/// Model of the bytes of a robot file, or the status and its message.
pub(crate) fn model_of_bytes(name: &str, bytes: &[u8]) -> Result<LoopModel, (i32, String)> {
    let text = str::from_utf8(bytes).map_err(|error| (BAD_MODEL, format!("{name} is not UTF-8: {error}")))?;
    let robot = Robot::from_toml(text).map_err(|error| (BAD_MODEL, error.render(name, text, false)))?;
    LoopModel::new(robot).map_err(|error| (NOT_FOR_LOOP, error.to_string()))
}

/// Gives a new model to the caller, or writes why there is none.
unsafe fn give_model(
    make: impl FnOnce() -> Result<LoopModel, (i32, String)>,
    out: *mut *mut Model,
    message: *mut c_char,
    message_bytes: usize,
) -> i32 {
    let (status, why) = match guarded(make) {
        Some(Ok(model)) => {
            // SAFETY: `out` was checked.
            unsafe { out.write(Box::into_raw(Model::new(model))) };
            (CERTIFIED, String::new())
        }
        Some(Err(refused)) => refused,
        None => (PANIC, text(PANIC).to_owned()),
    };
    // SAFETY: the message has its number of bytes.
    unsafe { write_text(message, message_bytes, &why) };
    status
}

/// `fn_model_cables`: number of cables of a model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_model_cables(model: *const Model, cables: *mut u32) -> i32 {
    let count = || -> Checked<i32> {
        // SAFETY: promised by the caller.
        let model = unsafe { Model::at(model) }?;
        check(cables)?;
        // SAFETY: checked.
        unsafe { cables.write(model.checked.cables() as u32) };
        Ok(CERTIFIED)
    };
    count().unwrap_or_else(|status| status)
}

/// `fn_model_free`: frees a model, unless it has loops.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_model_free(model: *mut Model) -> i32 {
    if model.is_null() {
        return CERTIFIED;
    }
    // SAFETY: promised by the caller.
    match unsafe { Model::at(model) } {
        Err(status) => return status,
        Ok(this) if !this.end() => return IN_USE,
        Ok(_) => {}
    }
    // SAFETY: it came from `Box::into_raw`, it has no loops, and `end` is true once.
    guarded(|| drop(unsafe { Box::from_raw(model) })).map_or(PANIC, |()| CERTIFIED)
}

/// `fn_loop_bytes`: memory of a loop.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_loop_bytes(model: *const Model, bytes: *mut usize, alignment: *mut usize) -> i32 {
    let sizes = || -> Checked<i32> {
        // SAFETY: promised by the caller.
        unsafe { Model::at(model) }?;
        check(bytes)?;
        check(alignment)?;
        // SAFETY: checked.
        unsafe {
            bytes.write(mem::size_of::<Loop>());
            alignment.write(mem::align_of::<Loop>());
        }
        Ok(CERTIFIED)
    };
    sizes().unwrap_or_else(|status| status)
}

/// `fn_loop_init`: makes a loop in memory of the caller.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_loop_init(
    model: *const Model,
    memory: *mut c_void,
    bytes: usize,
    out: *mut *mut Loop,
) -> i32 {
    let init = || -> Checked<i32> {
        // SAFETY: promised by the caller.
        let model = unsafe { Model::at(model) }?;
        check(out)?;
        let place = memory.cast::<Loop>();
        if place.is_null() {
            return Err(BAD_POINTER);
        }
        if bytes < mem::size_of::<Loop>() || !place.is_aligned() {
            return Err(BAD_MEMORY);
        }
        let new = Loop::new(model).ok_or(BAD_HANDLE)?;
        // SAFETY: the memory has the size and alignment of a loop; `out` was checked.
        unsafe {
            ptr::write(place, new);
            out.write(place);
        }
        Ok(CERTIFIED)
    };
    init().unwrap_or_else(|status| status)
}

/// `fn_loop_end`: ends a loop.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_loop_end(handle: *mut Loop) -> i32 {
    // SAFETY: promised by the caller.
    unsafe { Loop::end(handle) }.map_or_else(|status| status, |()| CERTIFIED)
}

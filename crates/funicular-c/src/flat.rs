//! The functions with plain arrays, for programs that cannot make structs with pointers: MATLAB, Octave, Julia.
//!
//! A session is a model with one loop, in memory of this library.

use crate::border::{Checked, check, check_wanted, guarded, read_array, write_array};
use crate::handles::{Loop, Model};
use crate::layout::{ForwardResult, InverseResult, PoseInput, Summarised, WrenchResult};
use crate::loop_calls::{fn_forward, fn_forward_cold, fn_inverse, fn_reset, fn_wrench};
use crate::model_calls::{fn_loop_end, fn_model_free, fn_model_from_file};
use crate::status::{BAD_HANDLE, BAD_POINTER, CERTIFIED, PANIC};
use funicular::control_loop::MAX_CABLES;
use std::ffi::c_char;
use std::mem::size_of;
use std::ptr;

/// Number of numbers of an input: position, quaternion, velocity, angular velocity, acceleration, angular acceleration,
/// force, moment.
pub const INPUT: usize = 25;

/// Number of numbers of a missing wrench: size, direction of force and moment, cables at their maximum.
pub const MISSING: usize = 8;

/// `fn_flat_open`: session of a robot file; null with a message if there is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_flat_open(
    path: *const c_char,
    session: *mut *mut Session,
    message: *mut c_char,
    message_bytes: u32,
) -> i32 {
    if let Err(status) = check(session) {
        return status;
    }
    let mut model: *mut Model = ptr::null_mut();
    // SAFETY: promised by the caller; `model` is a place for the model.
    let status = unsafe { fn_model_from_file(path, &raw mut model, message, message_bytes as usize) };
    if status < CERTIFIED {
        return status;
    }
    // SAFETY: the model was just made, and the session is the only one to know it.
    let made =
        guarded(|| Loop::new(unsafe { &*model }).map(|of| Box::new(Session { model, of, missing: [0.0; MISSING] })));
    match made {
        Some(Some(new)) => {
            // SAFETY: checked.
            unsafe { session.write(Box::into_raw(new)) };
            CERTIFIED
        }
        Some(None) => BAD_HANDLE,
        None => PANIC,
    }
}

/// Model with one loop.
pub struct Session {
    model: *mut Model,
    of: Loop,
    /// Missing wrench of the last `fn_flat_inverse` with a result.
    missing: [f64; MISSING],
}

fn missing_of(result: &InverseResult) -> [f64; MISSING] {
    let [fx, fy, fz] = result.missing_force;
    let [mx, my, mz] = result.missing_moment;
    [result.missing_n, fx, fy, fz, mx, my, mz, f64::from(result.missing_at_maximum)]
}

/// `fn_flat_missing`: proof of the last `fn_flat_inverse` with a result that no tensions within the limits exist.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_flat_missing(session: *mut Session, missing: *mut f64) -> i32 {
    if check(session).is_err() || check(missing).is_err() {
        return BAD_POINTER;
    }
    // SAFETY: promised by the caller, who has room for eight numbers.
    unsafe { write_array(missing, (*session).missing.into_iter()) };
    CERTIFIED
}

/// `fn_flat_close`: ends a session.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_flat_close(session: *mut Session) -> i32 {
    if session.is_null() {
        return CERTIFIED;
    }
    if check(session).is_err() {
        return BAD_POINTER;
    }
    // SAFETY: promised by the caller: the session was opened here and not closed.
    unsafe {
        let ended = fn_loop_end(&raw mut (*session).of);
        if ended < CERTIFIED {
            return ended;
        }
        let freed = fn_model_free((*session).model);
        guarded(|| drop(Box::from_raw(session))).map_or(PANIC, |()| freed)
    }
}

/// `fn_flat_cables`: number of cables, or a negative status.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_flat_cables(session: *mut Session) -> i32 {
    if check(session).is_err() {
        return BAD_POINTER;
    }
    // SAFETY: promised by the caller.
    unsafe { (*(*session).model).checked.cables() as i32 }
}

/// `fn_flat_reset`: the next call starts cold.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_flat_reset(session: *mut Session) -> i32 {
    if check(session).is_err() {
        return BAD_POINTER;
    }
    // SAFETY: promised by the caller.
    unsafe { fn_reset(&raw mut (*session).of) }
}

/// `fn_flat_status_text`: text of a status.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_flat_status_text(status: i32, to: *mut c_char, bytes: u32) -> i32 {
    // SAFETY: promised by the caller.
    unsafe { crate::model_calls::fn_status_text(status, to, bytes as usize) }
}

/// Input of 25 numbers as a struct.
unsafe fn input_of(input: *const f64) -> Checked<PoseInput> {
    check(input)?;
    let mut numbers = [0.0; INPUT];
    // SAFETY: checked; the caller gives 25 numbers.
    unsafe { ptr::copy_nonoverlapping(input, numbers.as_mut_ptr(), INPUT) };
    let three = |first: usize| [numbers[first], numbers[first + 1], numbers[first + 2]];
    Ok(PoseInput {
        struct_size: size_of::<PoseInput>() as u32,
        reserved: 0,
        position_m: three(0),
        quaternion_wxyz: [numbers[3], numbers[4], numbers[5], numbers[6]],
        velocity_m_s: three(7),
        angular_velocity_rad_s: three(10),
        acceleration_m_s2: three(13),
        angular_acceleration_rad_s2: three(16),
        force_n: three(19),
        moment_n_m: three(22),
    })
}

/// `fn_flat_inverse`: pose to lengths and tensions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_flat_inverse(
    session: *mut Session,
    input: *const f64,
    summary: *mut f64,
    length_m: *mut f64,
    length_rate_m_s: *mut f64,
    length_acceleration_m_s2: *mut f64,
    tension_platform_n: *mut f64,
    tension_drum_n: *mut f64,
) -> i32 {
    let call = || -> Checked<i32> {
        check(session)?;
        check_wanted(summary)?;
        let mut result = InverseResult {
            struct_size: size_of::<InverseResult>() as u32,
            cables: MAX_CABLES as u32,
            length_m,
            length_rate_m_s,
            length_acceleration_m_s2,
            tension_platform_n,
            tension_drum_n,
            ..InverseResult::default()
        };
        // SAFETY: promised by the caller; the arrays have room for all cables of the session.
        unsafe {
            let input = input_of(input)?;
            let status = fn_inverse(&raw mut (*session).of, &raw const input, &raw mut result);
            if status >= CERTIFIED {
                write_array(summary, result.summary().into_iter());
                (*session).missing = missing_of(&result);
            }
            Ok(status)
        }
    };
    call().unwrap_or_else(|status| status)
}

/// `fn_flat_forward`: lengths to position and quaternion; without `start` from the last pose, and if there is none from
/// nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_flat_forward(
    session: *mut Session,
    length_m: *const f64,
    start: *const f64,
    summary: *mut f64,
    position_quaternion: *mut f64,
    tension_platform_n: *mut f64,
    tension_drum_n: *mut f64,
) -> i32 {
    let call = || -> Checked<i32> {
        check(session)?;
        check_wanted(summary)?;
        check_wanted(position_quaternion)?;
        let mut result = ForwardResult {
            struct_size: size_of::<ForwardResult>() as u32,
            cables: MAX_CABLES as u32,
            tension_platform_n,
            tension_drum_n,
            ..ForwardResult::default()
        };
        // SAFETY: promised by the caller; the arrays have as many numbers as the session has cables.
        unsafe {
            let count = (*(*session).model).checked.cables();
            let lengths = read_array(length_m, count)?;
            let handle = &raw mut (*session).of;
            let count = count as u32;
            let mut status = if start.is_null() {
                fn_forward(handle, lengths.as_ptr(), count, ptr::null(), &raw mut result)
            } else {
                let start = input_of(start)?;
                fn_forward(handle, lengths.as_ptr(), count, &raw const start, &raw mut result)
            };
            if status == crate::status::NO_START {
                status = fn_forward_cold(handle, lengths.as_ptr(), count, &raw mut result);
            }
            if status >= CERTIFIED {
                write_array(summary, result.summary().into_iter());
                let pose = result.position_m.into_iter().chain(result.quaternion_wxyz);
                write_array(position_quaternion, pose);
            }
            Ok(status)
        }
    };
    call().unwrap_or_else(|status| status)
}

/// `fn_flat_wrench`: tensions at the drums to force, moment and payload (seven numbers).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_flat_wrench(
    session: *mut Session,
    input: *const f64,
    tension_drum_n: *const f64,
    load: *mut f64,
) -> i32 {
    let call = || -> Checked<i32> {
        check(session)?;
        check(load)?;
        let mut result = WrenchResult { struct_size: size_of::<WrenchResult>() as u32, ..WrenchResult::default() };
        // SAFETY: promised by the caller; there are as many tensions as the session has cables.
        unsafe {
            let (input, count) = (input_of(input)?, (*(*session).model).checked.cables());
            let tensions = read_array(tension_drum_n, count)?;
            let handle = &raw mut (*session).of;
            let status = fn_wrench(handle, &raw const input, tensions.as_ptr(), count as u32, &raw mut result);
            if status >= CERTIFIED {
                let numbers = result.force_n.into_iter().chain(result.moment_n_m).chain([result.payload_kg]);
                write_array(load, numbers);
            }
            Ok(status)
        }
    };
    call().unwrap_or_else(|status| status)
}

//! Exported functions of the loop: none reserves memory, but for the cold start.

use crate::border::{Checked, check_wanted, loop_input, read_array, read_struct, write_array, write_struct};
use crate::handles::Loop;
use crate::layout::{ForwardResult, InverseResult, PoseInput, Summarised, WrenchResult};
use crate::status::{BAD_STRUCT, CERTIFIED, NO_START, of_fault, of_status};
use funicular::control_loop::{ControlLoop, LoopCable, LoopInput, LoopModel, LoopState, MAX_CABLES};
use funicular::math::{Vec3, Vec6};
use funicular::path::PathPoint;

/// `fn_inverse`: pose to lengths and tensions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_inverse(handle: *mut Loop, input: *const PoseInput, result: *mut InverseResult) -> i32 {
    // SAFETY: promised by the caller for all addresses.
    unsafe {
        Loop::call(handle, |model, state| {
            let (input, mut of) = (loop_input(&read_struct(input)?)?, read_struct(result.cast_const())?);
            check_rows(&of.rows(), of.cables, model)?;
            let with_rates = !of.length_rate_m_s.is_null() || !of.length_acceleration_m_s2.is_null();
            let found = state.inverse(model, &input, with_rates).map_err(of_fault)?;
            of.fill(&found);
            write_rows(&of.rows(), &found, model.cables());
            write_struct(result, &of, of.struct_size);
            Ok(of.status)
        })
    }
}

/// `fn_forward`: lengths to pose and tensions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_forward(
    handle: *mut Loop,
    length_m: *const f64,
    cables: u32,
    start: *const PoseInput,
    result: *mut ForwardResult,
) -> i32 {
    // SAFETY: promised by the caller for all addresses.
    unsafe {
        Loop::call(handle, |model, state| {
            let start = if start.is_null() { None } else { Some(loop_input(&read_struct(start)?)?) };
            forward(model, (length_m, cables), result, |lengths| {
                let pose = start.as_ref().map(|start| &start.motion.pose);
                state.forward(model, lengths, start.as_ref(), pose).map_err(of_fault)
            })
        })
    }
}

/// `fn_forward_cold`: lengths to pose from nothing; may reserve memory.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_forward_cold(
    handle: *mut Loop,
    length_m: *const f64,
    cables: u32,
    result: *mut ForwardResult,
) -> i32 {
    // SAFETY: promised by the caller for all addresses.
    unsafe {
        Loop::call(handle, |model, state| {
            forward(model, (length_m, cables), result, |lengths| state.forward_cold(model, lengths).map_err(of_fault))
        })
    }
}

/// Lengths of the caller to a result of the caller.
unsafe fn forward(
    model: &LoopModel,
    (length_m, cables): (*const f64, u32),
    result: *mut ForwardResult,
    find: impl FnOnce(&[f64]) -> Checked<LoopState>,
) -> Checked<i32> {
    if (cables as usize) < model.cables() {
        return Err(BAD_STRUCT);
    }
    // SAFETY: promised by the caller.
    let (lengths, mut of) = unsafe { (read_array(length_m, model.cables())?, read_struct(result.cast_const())?) };
    check_rows(&of.rows(), of.cables, model)?;
    let found = find(&lengths[..model.cables()])?;
    of.fill(&found);
    // SAFETY: the arrays were checked, and the struct has its size.
    unsafe {
        write_rows(&of.rows(), &found, model.cables());
        write_struct(result, &of, of.struct_size);
    }
    Ok(of.status)
}

/// `fn_wrench`: tensions at the drums to the load on the platform.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_wrench(
    handle: *mut Loop,
    input: *const PoseInput,
    tension_drum_n: *const f64,
    cables: u32,
    result: *mut WrenchResult,
) -> i32 {
    // SAFETY: promised by the caller for all addresses.
    unsafe {
        Loop::call(handle, |model, state| {
            if (cables as usize) < model.cables() {
                return Err(BAD_STRUCT);
            }
            let input = loop_input(&read_struct(input)?)?;
            let tensions = read_array(tension_drum_n, model.cables())?;
            let mut of = read_struct(result.cast_const())?;
            let load = state.load(model, &input, &tensions[..model.cables()]).map_err(of_fault)?;
            of.status = CERTIFIED;
            (of.force_n, of.moment_n_m, of.payload_kg) = (load.force_w.into(), load.moment_w.into(), load.payload);
            write_struct(result, &of, of.struct_size);
            Ok(CERTIFIED)
        })
    }
}

/// `fn_reset`: the next call starts cold.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_reset(handle: *mut Loop) -> i32 {
    let reset = |_: &LoopModel, state: &mut ControlLoop| {
        state.reset();
        Ok(CERTIFIED)
    };
    // SAFETY: promised by the caller.
    unsafe { Loop::call(handle, reset) }
}

/// `fn_warm_up`: runs every path once at the pose of the robot file, and leaves the state as it was.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_warm_up(handle: *mut Loop) -> i32 {
    // SAFETY: promised by the caller.
    unsafe { Loop::call(handle, |model, _| warm_up(model)) }
}

fn warm_up(model: &LoopModel) -> Checked<i32> {
    let home = model.home().ok_or(NO_START)?;
    let mut state = ControlLoop::new();
    let slowly = Vec6::new(1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3);
    let allowed = model.robot().platform.motion.allowed(&slowly);
    let moving = PathPoint { velocity_w: allowed, ..PathPoint::at_rest(home) };
    let mut status = CERTIFIED;
    for _ in 0..2 {
        let found = state.inverse(model, &LoopInput::moving(moving), true).map_err(of_fault)?;
        status = of_status(found.status);
        let (mut lengths, mut tensions) = ([0.0; MAX_CABLES], [0.0; MAX_CABLES]);
        for (i, cable) in found.cables.iter().enumerate() {
            (lengths[i], tensions[i]) = (cable.length, cable.tension_drum);
        }
        let count = model.cables();
        // The paths have to run once; their results are not used.
        let _ = state.forward(model, &lengths[..count], None, None);
        let _ = state.load(model, &LoopInput::at_rest(home), &tensions[..count]);
    }
    // Far outside, so that the search beyond the limits runs too.
    let outside = home.moved(&(Vec3::x() * (10.0 * model.robot().platform_length())), &Vec3::zeros());
    let _ = state.inverse(model, &LoopInput::at_rest(&outside), false);
    Ok(status)
}

/// Array of a result, and its number for a cable.
type Row = (*mut f64, fn(&LoopCable) -> f64);

impl InverseResult {
    fn rows(&self) -> [Row; 7] {
        [
            (self.length_m, |cable| cable.length),
            (self.length_rate_m_s, |cable| cable.length_rate),
            (self.length_acceleration_m_s2, |cable| cable.length_acceleration),
            (self.free_length_m, |cable| cable.free_length),
            (self.tension_platform_n, |cable| cable.tension_platform),
            (self.tension_drum_n, |cable| cable.tension_drum),
            (self.margin_n, |cable| cable.margin),
        ]
    }

    fn fill(&mut self, found: &LoopState) {
        self.summarise(found);
        self.reserved = 0;
        (self.missing_n, self.missing_at_maximum) = found.missing.map_or((0.0, 0), |of| (of.size, of.at_maximum));
        self.missing_force = found.missing.map_or([0.0; 3], |of| of.force_w.into());
        self.missing_moment = found.missing.map_or([0.0; 3], |of| of.moment_w.into());
    }
}

impl ForwardResult {
    fn rows(&self) -> [Row; 4] {
        [
            (self.free_length_m, |cable| cable.free_length),
            (self.tension_platform_n, |cable| cable.tension_platform),
            (self.tension_drum_n, |cable| cable.tension_drum),
            (self.margin_n, |cable| cable.margin),
        ]
    }

    fn fill(&mut self, found: &LoopState) {
        self.summarise(found);
        self.position_m = found.pose.position_w.into();
        let q = found.pose.rot_wp.quaternion();
        self.quaternion_wxyz = [q.w, q.i, q.j, q.k];
    }
}

/// Writes the arrays of a result that are wanted.
///
/// # Safety
/// They were checked by [`check_rows`].
unsafe fn write_rows(rows: &[Row], found: &LoopState, count: usize) {
    for (array, number) in rows {
        // SAFETY: the array is aligned and has room for all cables.
        unsafe { write_array(*array, found.cables.iter().take(count).map(number)) };
    }
}

/// Refuses arrays that are wanted and not aligned, or have no room for all cables.
fn check_rows(rows: &[Row], room: u32, model: &LoopModel) -> Checked<()> {
    let is_wanted = rows.iter().any(|(array, _)| !array.is_null());
    if is_wanted && (room as usize) < model.cables() {
        return Err(BAD_STRUCT);
    }
    rows.iter().try_for_each(|(array, _)| check_wanted(*array))
}

//! Exported functions of the simulation step by step.

use crate::border::{check, write_text};
use crate::owned::{MessageRoom, Owned, OwnedKind, Told, pose_at, read, robot_of_bytes, silent};
use crate::status::{BAD_INPUT, BAD_MEMORY, BAD_STATE, FAILED, NO_REST, REFUSED};
use funicular::math::Vec3;
use funicular::robot::{Pose, Robot, State};
use funicular::simulation::{
    CutAt, ElementMesh, RobotSample, SimulationEvent, SimulationSettings, StepError, StepSignals, SteppedSimulation,
};
use funicular::statics::{self, StaticModel};
use std::borrow::Cow;
use std::ffi::{CStr, c_char, c_void};
use std::ptr;

/// Bytes of a number.
const WORD: usize = 8;

/// `fn_sim`: a robot in motion.
pub type Sim = Owned<SimState>;

impl OwnedKind for SimState {
    const KIND: u64 = 0x666e_5f73_696d_756c;
}

/// Simulation with its signals, the inputs of the next step, and the present sample.
pub struct SimState {
    simulation: SteppedSimulation,
    signals: StepSignals,
    inputs: Vec<f64>,
    outputs: Vec<f64>,
}

fn of_step(error: &StepError) -> (i32, Cow<'static, str>) {
    let status = match error {
        StepError::Failed(_) => FAILED,
        StepError::NotSaved | StepError::Damaged | StepError::OtherRobot => BAD_STATE,
        StepError::NotFinite { .. } => BAD_INPUT,
        _ => REFUSED,
    };
    (status, error.to_string().into())
}

impl SimState {
    fn new(robot: &Robot, start: Option<(&[f64], Option<Pose>)>, settings: &SimulationSettings) -> Told<Self> {
        let no_rest = |error: &dyn std::fmt::Display| (NO_REST, Cow::from(error.to_string()));
        let found = match start {
            None => statics::solve(robot, StaticModel::Catenary, None).map(|found| found.equilibrium),
            Some((lengths, None)) => {
                let state = State::Lengths(lengths.to_vec());
                let rule = statics::TensionRule::default();
                statics::solve_at(robot, &state, StaticModel::Catenary, &rule).map(|found| found.equilibrium)
            }
            Some((lengths, Some(pose))) => statics::forward(robot, lengths, StaticModel::Catenary, Some(&pose)),
        };
        let rest = found.map_err(|error| no_rest(&error))?;
        let (robot, rest) = rest.with_dynamic_stiffness(robot);
        let begun = SteppedSimulation::new(&robot, &rest, &[], settings);
        let mut simulation = begun.map_err(|error| no_rest(&error))?;
        let signals = StepSignals::of(&mut simulation);
        let [inputs, outputs] =
            [&signals.inputs, &signals.outputs].map(|list| list.iter().map(|signal| signal.start).collect());
        Ok(Self { simulation, signals, inputs, outputs })
    }

    fn take(&mut self, sample: &RobotSample) {
        self.outputs = self.signals.values(sample);
    }

    fn happen(&mut self, event: &SimulationEvent) -> Told<()> {
        self.simulation.happen(event).map_err(|error| of_step(&error))?;
        let now = self.simulation.now();
        self.take(&now);
        Ok(())
    }

    /// State of the simulation, behind it the inputs, and a sum of them.
    fn save(&mut self) -> Vec<u8> {
        let mut bytes = self.simulation.save();
        let inputs: Vec<u8> = self.inputs.iter().flat_map(|value| value.to_le_bytes()).collect();
        bytes.extend(&inputs);
        bytes.extend(checksum(&inputs).to_le_bytes());
        bytes
    }

    fn restore(&mut self, bytes: &[u8]) -> Told<()> {
        let behind = (self.inputs.len() + 1) * WORD;
        let split = bytes.len().checked_sub(behind).ok_or_else(|| silent(BAD_STATE))?;
        let (state, inputs) = bytes.split_at(split);
        let (inputs, sum) = inputs.split_at(behind - WORD);
        if sum != checksum(inputs).to_le_bytes() {
            return Err(silent(BAD_STATE));
        }
        self.simulation.restore(state).map_err(|error| of_step(&error))?;
        self.inputs = inputs.as_chunks::<WORD>().0.iter().map(|word| f64::from_le_bytes(*word)).collect();
        let now = self.simulation.now();
        self.take(&now);
        Ok(())
    }

    /// Value of a signal by its number.
    fn value(&self, signal: usize) -> Option<f64> {
        self.inputs.get(signal).or_else(|| self.outputs.get(signal.checked_sub(self.inputs.len())?)).copied()
    }
}

/// Hash by Fowler, Noll and Vo (FNV-1a, 64 bits).
fn checksum(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3))
}

/// `fn_sim_new`: simulation of the text of a robot file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_sim_new(
    toml: *const c_char,
    bytes: usize,
    elements: u32,
    degree: u32,
    tolerance_m: f64,
    length_m: *const f64,
    cables: u32,
    pose: *const f64,
    out: *mut *mut Sim,
    message: *mut c_char,
    message_bytes: usize,
) -> i32 {
    let room = MessageRoom { to: message, bytes: message_bytes };
    // SAFETY: the caller gives `bytes`, `cables` lengths and seven numbers of a pose.
    let make = || unsafe {
        let robot = robot_of_bytes(read(toml.cast::<u8>(), bytes).map_err(silent)?)?;
        let lengths = if length_m.is_null() { None } else { Some(read(length_m, cables as usize).map_err(silent)?) };
        let pose = pose_at(pose)?;
        if lengths.is_some_and(|lengths| lengths.iter().any(|length| !length.is_finite())) {
            return Err(silent(BAD_INPUT));
        }
        let settings = settings_of(elements, degree, tolerance_m)?;
        SimState::new(&robot, lengths.map(|lengths| (lengths, pose)), &settings)
    };
    // SAFETY: promised by the caller.
    unsafe { Sim::make(out, room, make) }
}

/// Settings; zero for the usual ones.
fn settings_of(elements: u32, degree: u32, tolerance: f64) -> Told<SimulationSettings> {
    let refused = |what: String| Err((REFUSED, Cow::from(what)));
    let mut settings = SimulationSettings::default();
    if elements > 0 {
        settings.mesh.elements = elements as usize;
    }
    if degree > 0 {
        settings.mesh.degree = degree as usize;
    }
    if tolerance != 0.0 {
        settings.tolerance = tolerance;
    }
    let [least, most] = SimulationSettings::TOLERANCES;
    if settings.mesh.elements > ElementMesh::MAX_ELEMENTS || settings.mesh.degree > ElementMesh::MAX_DEGREE {
        let (elements, degree) = (ElementMesh::MAX_ELEMENTS, ElementMesh::MAX_DEGREE);
        return refused(format!("a rope has at most {elements} elements of degree {degree}"));
    }
    if !(least..=most).contains(&settings.tolerance) {
        return refused(format!("the tolerance is {tolerance} m: give {least} to {most} m"));
    }
    Ok(settings)
}

/// `fn_sim_free`: ends a simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_sim_free(sim: *mut Sim) -> i32 {
    // SAFETY: promised by the caller.
    unsafe { Sim::free(sim) }
}

/// `fn_sim_signals`: numbers of inputs and outputs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_sim_signals(sim: *mut Sim, inputs: *mut u32, outputs: *mut u32) -> i32 {
    // SAFETY: promised by the caller for all addresses.
    unsafe {
        Sim::call(sim, MessageRoom::NONE, |state| {
            check(inputs).and_then(|()| check(outputs)).map_err(silent)?;
            inputs.write(state.inputs.len() as u32);
            outputs.write(state.outputs.len() as u32);
            Ok(())
        })
    }
}

/// `fn_sim_signal_name`: name and unit of a signal.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_sim_signal_name(
    sim: *mut Sim,
    signal: u32,
    name: *mut c_char,
    name_bytes: usize,
    unit: *mut c_char,
    unit_bytes: usize,
) -> i32 {
    // SAFETY: promised by the caller for all addresses.
    unsafe {
        Sim::call(sim, MessageRoom::NONE, |state| {
            let of = state.signals.inputs.iter().chain(&state.signals.outputs).nth(signal as usize);
            let of = of.ok_or_else(|| silent(REFUSED))?;
            write_text(name, name_bytes, &of.name);
            write_text(unit, unit_bytes, of.unit);
            Ok(())
        })
    }
}

/// `fn_sim_find`: number of the signal of a name.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_sim_find(sim: *mut Sim, name: *const c_char, signal: *mut u32) -> i32 {
    // SAFETY: promised by the caller for all addresses.
    unsafe {
        Sim::call(sim, MessageRoom::NONE, |state| {
            check(signal).and_then(|()| check(name)).map_err(silent)?;
            let name = CStr::from_ptr(name).to_str().map_err(|_| silent(REFUSED))?;
            let mut all = state.signals.inputs.iter().chain(&state.signals.outputs);
            let found = all.position(|of| of.name == name).ok_or_else(|| silent(REFUSED))?;
            signal.write(found as u32);
            Ok(())
        })
    }
}

/// `fn_sim_set`: values of inputs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_sim_set(sim: *mut Sim, signals: *const u32, values: *const f64, count: usize) -> i32 {
    // SAFETY: promised by the caller for all addresses.
    unsafe {
        Sim::call(sim, MessageRoom::NONE, |state| {
            if count == 0 {
                return Ok(());
            }
            let (signals, values) = (read(signals, count).map_err(silent)?, read(values, count).map_err(silent)?);
            if signals.iter().any(|signal| *signal as usize >= state.inputs.len()) {
                return Err(silent(REFUSED));
            }
            if values.iter().any(|value| !value.is_finite()) {
                return Err(silent(BAD_INPUT));
            }
            signals.iter().zip(values).for_each(|(signal, value)| state.inputs[*signal as usize] = *value);
            Ok(())
        })
    }
}

/// `fn_sim_get`: values of inputs and outputs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_sim_get(sim: *mut Sim, signals: *const u32, values: *mut f64, count: usize) -> i32 {
    // SAFETY: promised by the caller for all addresses.
    unsafe {
        Sim::call(sim, MessageRoom::NONE, |state| {
            if count == 0 {
                return Ok(());
            }
            let signals = read(signals, count).map_err(silent)?;
            check(values).map_err(silent)?;
            let found: Option<Vec<f64>> = signals.iter().map(|signal| state.value(*signal as usize)).collect();
            let found = found.ok_or_else(|| silent(REFUSED))?;
            ptr::copy_nonoverlapping(found.as_ptr(), values, found.len());
            Ok(())
        })
    }
}

/// `fn_sim_time`: present time.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_sim_time(sim: *mut Sim, time_s: *mut f64) -> i32 {
    // SAFETY: promised by the caller for all addresses.
    unsafe {
        Sim::call(sim, MessageRoom::NONE, |state| {
            check(time_s).map_err(silent)?;
            time_s.write(state.simulation.time());
            Ok(())
        })
    }
}

/// `fn_sim_step`: advances by an interval.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_sim_step(
    sim: *mut Sim,
    interval_s: f64,
    message: *mut c_char,
    message_bytes: usize,
) -> i32 {
    // SAFETY: promised by the caller for all addresses.
    unsafe {
        Sim::call(sim, MessageRoom { to: message, bytes: message_bytes }, |state| {
            let SimState { simulation, signals, inputs, .. } = state;
            let sample = signals.step(simulation, interval_s, inputs).map_err(|error| of_step(&error))?;
            state.take(&sample);
            Ok(())
        })
    }
}

/// `fn_sim_cut`: cuts a cable at the platform.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_sim_cut(sim: *mut Sim, cable: u32, message: *mut c_char, message_bytes: usize) -> i32 {
    // SAFETY: promised by the caller for all addresses.
    unsafe {
        Sim::call(sim, MessageRoom { to: message, bytes: message_bytes }, |state| {
            let at = CutAt::Time(state.simulation.time());
            state.happen(&SimulationEvent::Cut { cable: cable as usize, at, place: 0.0 })
        })
    }
}

/// Point of a payload; null for the centre of mass.
unsafe fn point(point_m: *const f64) -> Told<Option<Vec3>> {
    if point_m.is_null() {
        return Ok(None);
    }
    // SAFETY: the caller gives three numbers.
    let point_m = unsafe { read(point_m, 3) }.map_err(silent)?;
    let point_p = Vec3::from_column_slice(point_m);
    if point_p.norm().is_finite() { Ok(Some(point_p)) } else { Err(silent(BAD_INPUT)) }
}

/// `fn_sim_release`: lets a payload go.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_sim_release(
    sim: *mut Sim,
    mass_kg: f64,
    point_m: *const f64,
    message: *mut c_char,
    message_bytes: usize,
) -> i32 {
    // SAFETY: promised by the caller for all addresses.
    unsafe {
        Sim::call(sim, MessageRoom { to: message, bytes: message_bytes }, |state| {
            let (time, point_p) = (state.simulation.time(), point(point_m)?);
            state.happen(&SimulationEvent::Release { time, mass: mass_kg, point_p })
        })
    }
}

/// `fn_sim_pick`: takes a payload up.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_sim_pick(
    sim: *mut Sim,
    mass_kg: f64,
    point_m: *const f64,
    message: *mut c_char,
    message_bytes: usize,
) -> i32 {
    // SAFETY: promised by the caller for all addresses.
    unsafe {
        Sim::call(sim, MessageRoom { to: message, bytes: message_bytes }, |state| {
            let (time, point_p) = (state.simulation.time(), point(point_m)?);
            state.happen(&SimulationEvent::Pick { time, mass: mass_kg, point_p, velocity_w: None })
        })
    }
}

/// `fn_sim_save`: writes the state to memory of the caller.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_sim_save(sim: *mut Sim, memory: *mut c_void, bytes: *mut usize) -> i32 {
    // SAFETY: promised by the caller for all addresses.
    unsafe {
        Sim::call(sim, MessageRoom::NONE, |state| {
            check(bytes).map_err(silent)?;
            let saved = state.save();
            let room = bytes.read();
            bytes.write(saved.len());
            if memory.is_null() || room < saved.len() {
                return Err(silent(BAD_MEMORY));
            }
            ptr::copy_nonoverlapping(saved.as_ptr(), memory.cast::<u8>(), saved.len());
            Ok(())
        })
    }
}

/// `fn_sim_restore`: takes over a state from memory of the caller.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_sim_restore(sim: *mut Sim, memory: *const c_void, bytes: usize) -> i32 {
    // SAFETY: promised by the caller for all addresses.
    unsafe {
        Sim::call(sim, MessageRoom::NONE, |state| {
            let saved = read(memory.cast::<u8>(), bytes).map_err(silent)?;
            state.restore(saved)
        })
    }
}

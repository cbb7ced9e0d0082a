//! The simulation step by step as a C program calls it: results of the core, the same bits from a saved state, every
//! wrong use with its status.
#![allow(missing_docs)]
#![allow(clippy::undocumented_unsafe_blocks, reason = "every call here is one that a C program could make")]

use funicular::robot::Robot;
use funicular::simulation::{SimulationSettings, StepInputs, SteppedSimulation, WrenchInput};
use funicular::statics::{self, StaticModel};
use funicular_c::status::*;
use funicular_c::{
    Sim, fn_sim_cut, fn_sim_find, fn_sim_free, fn_sim_get, fn_sim_new, fn_sim_pick, fn_sim_release, fn_sim_restore,
    fn_sim_save, fn_sim_set, fn_sim_signal_name, fn_sim_signals, fn_sim_step, fn_sim_time,
};
use std::ffi::CString;
use std::ptr::{null, null_mut};

const ROBOT: &str = funicular_robots::YUAN2014_4MM;

fn new(toml: &str, tolerance: f64) -> (i32, *mut Sim, String) {
    let (mut sim, mut message) = (null_mut(), [0_u8; 1000]);
    let text = message.as_mut_ptr().cast();
    let (toml, bytes, out) = (toml.as_ptr().cast(), toml.len(), &raw mut sim);
    let status = unsafe { fn_sim_new(toml, bytes, 0, 0, tolerance, null(), 0, null(), out, text, 1000) };
    let end = message.iter().position(|byte| *byte == 0).unwrap();
    (status, sim, String::from_utf8(message[..end].to_vec()).unwrap())
}

fn find(sim: *mut Sim, name: &str) -> u32 {
    let (name, mut signal) = (CString::new(name).unwrap(), 0);
    assert_eq!(unsafe { fn_sim_find(sim, name.as_ptr(), &raw mut signal) }, CERTIFIED);
    signal
}

fn set(sim: *mut Sim, name: &str, value: f64) -> i32 {
    let signal = find(sim, name);
    unsafe { fn_sim_set(sim, &raw const signal, &raw const value, 1) }
}

fn get(sim: *mut Sim, name: &str) -> f64 {
    let (signal, mut value) = (find(sim, name), f64::NAN);
    assert_eq!(unsafe { fn_sim_get(sim, &raw const signal, &raw mut value, 1) }, CERTIFIED);
    value
}

fn step(sim: *mut Sim, interval: f64) -> i32 {
    unsafe { fn_sim_step(sim, interval, null_mut(), 0) }
}

/// All outputs.
fn outputs(sim: *mut Sim) -> Vec<f64> {
    let (mut inputs, mut outputs) = (0, 0);
    assert_eq!(unsafe { fn_sim_signals(sim, &raw mut inputs, &raw mut outputs) }, CERTIFIED);
    let signals: Vec<u32> = (inputs..inputs + outputs).collect();
    let mut values = vec![0.0; signals.len()];
    let status = unsafe { fn_sim_get(sim, signals.as_ptr(), values.as_mut_ptr(), signals.len()) };
    assert_eq!(status, CERTIFIED);
    values
}

fn save(sim: *mut Sim) -> Vec<u8> {
    let mut bytes = 0;
    unsafe {
        assert_eq!(fn_sim_save(sim, null_mut(), &raw mut bytes), BAD_MEMORY);
        let mut memory = vec![0_u8; bytes];
        assert_eq!(fn_sim_save(sim, memory.as_mut_ptr().cast(), &raw mut bytes), CERTIFIED);
        memory
    }
}

#[test]
fn steps_are_those_of_the_core() {
    let (status, sim, message) = new(ROBOT, 1e-6);
    assert_eq!(status, CERTIFIED, "{message}");
    let robot = Robot::from_toml(ROBOT).unwrap();
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    let settings = SimulationSettings { tolerance: 1e-6, ..SimulationSettings::default() };
    let mut core = SteppedSimulation::new(&robot, &rest, &[], &settings).unwrap();
    assert_eq!(set(sim, "force_x_n", 20.0), CERTIFIED);
    let wrench = WrenchInput { force_w: [20.0, 0.0, 0.0].into(), ..WrenchInput::default() };
    let inputs = StepInputs { wrench: Some(wrench), ..StepInputs::default() };
    let mut time = 0.0;
    for _ in 0..20 {
        assert_eq!(step(sim, 0.002), CERTIFIED);
        let sample = core.step(0.002, &inputs).unwrap();
        assert!((get(sim, "x_m") - sample.pose.position_w.x).abs() < 1e-9);
        assert!((get(sim, "acceleration_x_m_s2") - sample.acceleration_w.x).abs() < 1e-3);
        let tension = sample.cables[0].tension_platform;
        assert!((get(sim, "tension_platform_1_n") - tension).abs() < 1e-3 * tension);
        assert_eq!(unsafe { fn_sim_time(sim, &raw mut time) }, CERTIFIED);
        assert!((time - sample.time).abs() < 1e-15);
    }
    assert!((get(sim, "x_m") - rest.pose.position_w.x).abs() > 1e-5);

    // A winch and an anchor that move.
    let (length, place) = (get(sim, "length_1_m"), get(sim, "anchor_2_z_m"));
    for k in 1..=10 {
        let time = 0.002 * f64::from(k);
        assert_eq!(set(sim, "length_1_m", length + time * time), CERTIFIED);
        assert_eq!(set(sim, "length_rate_1_m_s", 2.0 * time), CERTIFIED);
        assert_eq!(set(sim, "anchor_2_z_m", place + time * time), CERTIFIED);
        assert_eq!(set(sim, "anchor_velocity_2_z_m_s", 2.0 * time), CERTIFIED);
        assert_eq!(step(sim, 0.002), CERTIFIED);
    }
    assert!((get(sim, "unstrained_length_1_m") - length - 4e-4).abs() < 1e-12);
    assert!((get(sim, "unstrained_length_rate_1_m_s") - 0.04).abs() < 1e-12);
    assert_eq!(unsafe { fn_sim_free(sim) }, CERTIFIED);
}

#[test]
fn a_saved_state_goes_on_with_the_same_bits_also_in_another_simulation() {
    let [first, second] = [(); 2].map(|()| new(ROBOT, 1e-6).1);
    assert_eq!(set(first, "force_z_n", 15.0), CERTIFIED);
    for _ in 0..3 {
        assert_eq!(step(first, 0.003), CERTIFIED);
    }
    let saved = save(first);
    let go_on = |sim: *mut Sim| {
        for _ in 0..3 {
            assert_eq!(step(sim, 0.002), CERTIFIED);
        }
        assert_eq!(unsafe { fn_sim_release(sim, 0.5, null(), null_mut(), 0) }, CERTIFIED);
        assert_eq!(unsafe { fn_sim_cut(sim, 2, null_mut(), 0) }, CERTIFIED);
        assert_eq!(step(sim, 0.002), CERTIFIED);
        outputs(sim)
    };
    let expected = go_on(first);
    for sim in [first, second] {
        assert_eq!(unsafe { fn_sim_restore(sim, saved.as_ptr().cast(), saved.len()) }, CERTIFIED);
        assert_eq!(go_on(sim), expected);
    }

    // Damaged bytes of the state and of the inputs behind it, a part of it, and the state of another robot.
    let before = save(second);
    for place in [30, saved.len() - 12] {
        let mut damaged = saved.clone();
        damaged[place] ^= 1;
        assert_eq!(unsafe { fn_sim_restore(second, damaged.as_ptr().cast(), damaged.len()) }, BAD_STATE);
    }
    assert_eq!(unsafe { fn_sim_restore(second, saved.as_ptr().cast(), 7) }, BAD_STATE);
    let other = new(ROBOT, 1e-5).1;
    assert_eq!(unsafe { fn_sim_restore(other, saved.as_ptr().cast(), saved.len()) }, BAD_STATE);
    assert_eq!(save(second), before);
    for sim in [first, second, other] {
        assert_eq!(unsafe { fn_sim_free(sim) }, CERTIFIED);
    }
}

#[test]
fn wrong_calls_are_refused_and_change_nothing() {
    let (status, sim, _) = new("[platform", 0.0);
    assert!(status == BAD_MODEL && sim.is_null());
    let (status, _, message) = new(ROBOT, 1.0);
    assert!(status == REFUSED && message.contains("the tolerance is 1 m"), "{message}");
    let sim = new(ROBOT, 1e-6).1;
    let before = save(sim);
    for interval in [0.0, -1.0, 10.0, f64::NAN] {
        assert_eq!(step(sim, interval), REFUSED);
    }
    let (unknown, mut signal) = (CString::new("lenght_1_m").unwrap(), 0);
    let (value, far) = (1.0, 100_000_u32);
    unsafe {
        assert_eq!(fn_sim_find(sim, unknown.as_ptr(), &raw mut signal), REFUSED);
        assert_eq!(fn_sim_set(sim, &raw const far, &raw const value, 1), REFUSED);
        assert_eq!(fn_sim_set(sim, &raw const far, null(), 1), BAD_POINTER);
        assert_eq!(fn_sim_signal_name(sim, far, null_mut(), 0, null_mut(), 0), REFUSED);
        assert_eq!(fn_sim_cut(sim, 6, null_mut(), 0), REFUSED);
        assert_eq!(fn_sim_pick(sim, -1.0, null(), null_mut(), 0), REFUSED);
        assert_eq!(fn_sim_free(null_mut()), CERTIFIED);
        assert_eq!(fn_sim_step(null_mut(), 0.1, null_mut(), 0), BAD_POINTER);
    }
    assert_eq!(set(sim, "force_x_n", f64::NAN), BAD_INPUT);
    assert_eq!(save(sim), before);

    // A length that jumps is refused by the step, which leaves the rest as it was.
    let length = get(sim, "length_1_m");
    assert_eq!(set(sim, "length_1_m", length + 0.5), CERTIFIED);
    let mut message = [0_u8; 200];
    assert_eq!(unsafe { fn_sim_step(sim, 0.001, message.as_mut_ptr().cast(), 200) }, REFUSED);
    assert!(String::from_utf8_lossy(&message).contains("would change by 0.5 m"));
    assert_eq!(set(sim, "length_1_m", length), CERTIFIED);
    assert_eq!(save(sim), before);
    assert_eq!(unsafe { fn_sim_free(sim) }, CERTIFIED);
}

#[test]
fn signals_have_names_and_units() {
    let sim = new(ROBOT, 1e-6).1;
    let (mut inputs, mut outputs) = (0, 0);
    let mut all = Vec::new();
    unsafe {
        assert_eq!(fn_sim_signals(sim, &raw mut inputs, &raw mut outputs), CERTIFIED);
        for signal in 0..inputs + outputs {
            let (mut name, mut unit) = ([0_u8; 60], [0_u8; 10]);
            let (to, unit_to) = (name.as_mut_ptr().cast(), unit.as_mut_ptr().cast());
            assert_eq!(fn_sim_signal_name(sim, signal, to, 60, unit_to, 10), CERTIFIED);
            let text = |of: &[u8]| String::from_utf8_lossy(of).trim_end_matches('\0').to_owned();
            all.push((text(&name), text(&unit)));
        }
    }
    // Six cables with two numbers each, six anchors with six, force, moment and wind.
    assert_eq!((inputs, outputs), (12 + 36 + 9, 7 + 12 + 24 + 1));
    assert!(all.contains(&("length_rate_1_m_s".to_owned(), "m/s".to_owned())), "{all:?}");
    assert!((0..all.len()).all(|k| all[k + 1..].iter().all(|(name, _)| *name != all[k].0)));
    assert_eq!(unsafe { fn_sim_free(sim) }, CERTIFIED);
}

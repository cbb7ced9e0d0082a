//! The estimator as a C program calls it: states of the core to the last bit, no memory in the loop, every wrong use
//! with its status and nothing changed.
#![allow(missing_docs)]
#![allow(clippy::float_cmp, reason = "both sides are the same numbers to the last bit")]
#![allow(clippy::undocumented_unsafe_blocks, reason = "every call here is one that a C program could make")]

mod counting;

use counting::reserved;
use funicular::estimation::{EstimationSettings, Estimator, SensorReadings, StatePriors};
use funicular::math::Vec3;
use funicular::robot::Robot;
use funicular_c::est_layout::{EstFault, EstReadings, EstResult, EstSettings};
use funicular_c::status::*;
use funicular_c::{
    Est, fn_est_defaults, fn_est_explain, fn_est_free, fn_est_get, fn_est_new, fn_est_restart, fn_est_take_fault,
    fn_est_update,
};
use std::ptr::{null, null_mut};

const CABLES: usize = 8;

fn document(name: &str) -> String {
    std::fs::read_to_string(format!("{}/../../docs/estimation/{name}", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

/// Rows of the log of the documents: time, lengths, tensions, accelerometer, gyroscope, tracker; NaN where a cell is
/// empty.
fn log() -> Vec<Vec<f64>> {
    let text = document("run.csv");
    let rows = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    rows.map(|row| row.split(',').map(|word| word.parse().unwrap_or(f64::NAN)).collect()).collect()
}

/// Bits of the readings that are not there.
fn missing(values: &[f64]) -> u32 {
    values.iter().enumerate().map(|(i, value)| u32::from(value.is_nan()) << i).sum()
}

fn readings(row: &[f64]) -> EstReadings {
    EstReadings {
        struct_size: size_of::<EstReadings>() as u32,
        cables: CABLES as u32,
        length_m: row[1..].as_ptr(),
        tension_n: row[9..].as_ptr(),
        accelerometer_m_s2: row[17..].as_ptr(),
        gyroscope_rad_s: row[20..].as_ptr(),
        tracker_m: row[23..].as_ptr(),
        length_missing: missing(&row[1..9]),
        tension_missing: missing(&row[9..17]),
        accelerometer_missing: missing(&row[17..20]),
        gyroscope_missing: missing(&row[20..23]),
        tracker_missing: missing(&row[23..26]),
        ..EstReadings::default()
    }
}

fn of_core(row: &[f64]) -> SensorReadings {
    let mut readings = SensorReadings::default();
    readings.lengths[..8].copy_from_slice(&row[1..9]);
    readings.tensions[..8].copy_from_slice(&row[9..17]);
    readings.accelerometer.copy_from_slice(&row[17..20]);
    readings.gyroscope.copy_from_slice(&row[20..23]);
    readings.tracker.copy_from_slice(&row[23..26]);
    readings
}

fn settings() -> EstSettings {
    let mut of = EstSettings { struct_size: size_of::<EstSettings>() as u32, ..EstSettings::default() };
    assert_eq!(unsafe { fn_est_defaults(&raw mut of) }, CERTIFIED);
    (of.payload_std_kg, of.first_moment_std_kg_m) = (0.5, 0.05);
    (of.inertial_unit_m, of.tracked_point_m) = ([0.1, 0.0, 0.5], [0.0, 0.0, 1.0]);
    of
}

fn new(settings: &EstSettings, readings: &EstReadings) -> (i32, *mut Est, String) {
    let (toml, mut est, mut message) = (document("robot.toml"), null_mut(), [0_u8; 500]);
    let text = message.as_mut_ptr().cast();
    let bytes = toml.len();
    let status =
        unsafe { fn_est_new(toml.as_ptr().cast(), bytes, settings, readings, null(), &raw mut est, text, 500) };
    let end = message.iter().position(|byte| *byte == 0).unwrap();
    (status, est, String::from_utf8(message[..end].to_vec()).unwrap())
}

/// Numbers of each cable, and the result that points at them.
struct CableRows {
    tension: [f64; CABLES],
    tension_std: [f64; CABLES],
    slack: [f64; CABLES],
}

impl CableRows {
    fn new() -> Self {
        Self { tension: [-1.0; CABLES], tension_std: [-1.0; CABLES], slack: [7.0; CABLES] }
    }

    fn result(&mut self) -> EstResult {
        EstResult {
            struct_size: size_of::<EstResult>() as u32,
            cables: CABLES as u32,
            tension_n: self.tension.as_mut_ptr(),
            tension_std_n: self.tension_std.as_mut_ptr(),
            slack: self.slack.as_mut_ptr(),
            ..EstResult::default()
        }
    }
}

fn get(est: *mut Est) -> (EstResult, CableRows) {
    let mut rows = CableRows::new();
    let mut result = rows.result();
    assert_eq!(unsafe { fn_est_get(est, &raw mut result) }, CERTIFIED);
    (result, rows)
}

#[test]
fn updates_are_those_of_the_core_without_memory() {
    let log = log();
    let (status, est, message) = new(&settings(), &readings(&log[0]));
    assert_eq!(status, CERTIFIED, "{message}");
    let core_settings = EstimationSettings {
        priors: StatePriors { payload: [0.0, 0.5], first_moment: 0.05, ..StatePriors::default() },
        inertial_unit_p: Vec3::new(0.1, 0.0, 0.5),
        tracked_point_p: Vec3::new(0.0, 0.0, 1.0),
        ..EstimationSettings::default()
    };
    let robot = Robot::from_toml(&document("robot.toml")).unwrap();
    let mut core = Estimator::new(robot, core_settings, &of_core(&log[0]), None).unwrap();
    let (mut rows, mut alarms, mut rang) = (CableRows::new(), Vec::new(), false);
    let mut result = rows.result();
    for pair in log.windows(2) {
        let (given, step) = (readings(&pair[1]), pair[1][0] - pair[0][0]);
        let (status, memory) = reserved(|| unsafe { fn_est_update(est, &raw const given, step, &raw mut result) });
        assert_eq!((status, memory), (CERTIFIED, 0), "{} s", pair[1][0]);
        let notes = core.update(&of_core(&pair[1]), step).unwrap();
        let state = core.state();
        assert_eq!(result.position_m, <[f64; 3]>::from(state.pose.position_w));
        assert_eq!(result.payload_kg.to_bits(), state.payload.value.to_bits());
        assert_eq!(rows.tension[3].to_bits(), state.cables[3].tension.value.to_bits());
        assert_eq!(result.is_trusted == 1, notes.is_trusted);
        let std = if notes.is_trusted { state.payload.std } else { f64::INFINITY };
        assert_eq!(result.payload_std_kg.to_bits(), std.to_bits());
        rang |= result.rings == 1;
        if result.alarm != 0 {
            alarms.push((result.alarm, result.alarm_cable, result.time_s));
        }
    }
    // The payload of the log.
    assert!(rang && alarms.len() == 1 && alarms[0].0 == 3 && alarms[0].1 == -1, "{alarms:?}");
    assert!((alarms[0].2 - 3.0) < 0.07 && (result.payload_kg - 18.393).abs() < 3.0 * result.payload_std_kg);
    assert!(rows.slack.iter().all(|slack| [-1.0, 0.0, 1.0].contains(slack)));
    let (_, memory) = reserved(|| get(est));
    assert_eq!(memory, 0);
    assert_eq!(unsafe { fn_est_free(est) }, CERTIFIED);
}

#[test]
fn wrong_calls_are_refused_and_change_nothing() {
    let log = log();
    let (_, est, _) = new(&settings(), &readings(&log[0]));
    for pair in log.windows(2).take(20) {
        let given = readings(&pair[1]);
        assert_eq!(unsafe { fn_est_update(est, &raw const given, pair[1][0] - pair[0][0], null_mut()) }, CERTIFIED);
    }
    let (before, rows_before) = get(est);
    let given = readings(&log[21]);
    let mut rows = CableRows::new();
    let mut result = rows.result();
    let good = log[21].clone();
    let mut bad = good.clone();
    bad[4] = f64::NAN;
    let mut none = good.clone();
    none[2] = -1.0;
    let with = |row: &[f64]| EstReadings { length_missing: 0, ..readings(row) };
    let no_rows = EstReadings { cables: 7, ..given };
    let short = EstReadings { struct_size: 8, ..given };
    unsafe {
        for (readings, step, wanted) in [
            (with(&bad), 0.01, BAD_INPUT),
            (with(&none), 0.01, BAD_INPUT),
            (no_rows, 0.01, BAD_STRUCT),
            (short, 0.01, BAD_STRUCT),
            (given, 0.0, REFUSED),
            (given, f64::NAN, REFUSED),
            (given, 2.0, REFUSED),
        ] {
            let (status, memory) = reserved(|| fn_est_update(est, &raw const readings, step, &raw mut result));
            assert_eq!((status, memory), (wanted, 0));
        }
        assert_eq!(fn_est_update(est, null(), 0.01, &raw mut result), BAD_POINTER);
        assert_eq!(fn_est_update(null_mut(), &raw const given, 0.01, &raw mut result), BAD_POINTER);
        result.cables = 3;
        assert_eq!(fn_est_update(est, &raw const given, 0.01, &raw mut result), BAD_STRUCT);
        assert_eq!(fn_est_take_fault(est, 9, 0), REFUSED);
        assert_eq!(fn_est_take_fault(est, 1, 8), REFUSED);
        let lacks = EstReadings { length_missing: 1, ..given };
        for forget in [0, 1] {
            let mut message = [0_u8; 200];
            let text = message.as_mut_ptr().cast();
            assert_eq!(fn_est_restart(est, &raw const lacks, null(), forget, text, 200), REFUSED);
            assert!(String::from_utf8_lossy(&message).contains("cable \"1\" has none"));
        }
    }
    assert_eq!(rows.tension[0], -1.0);
    let (after, rows_after) = get(est);
    assert_eq!((after.position_m, after.time_s), (before.position_m, before.time_s));
    assert_eq!((rows_after.tension, rows_after.tension_std), (rows_before.tension, rows_before.tension_std));

    // Encoders that are silent for longer than 0.2 s, and the way back.
    let silent = EstReadings { length_m: null(), ..given };
    let lost = (0..40).map(|_| unsafe { fn_est_update(est, &raw const silent, 0.01, null_mut()) });
    let statuses: Vec<i32> = lost.collect();
    assert!(statuses.starts_with(&[CERTIFIED; 19]) && statuses.ends_with(&[LOST; 19]), "{statuses:?}");
    assert!(get(est).0.position_m.iter().all(|value| value.is_finite()));
    let payload = get(est).0.payload_std_kg;
    assert_eq!(unsafe { fn_est_restart(est, &raw const given, null(), 0, null_mut(), 0) }, CERTIFIED);
    assert!(get(est).0.payload_std_kg <= payload);
    assert_eq!(unsafe { fn_est_update(est, &raw const given, 0.01, null_mut()) }, CERTIFIED);

    // With everything forgotten it is that of the start.
    let (_, anew, _) = new(&settings(), &given);
    assert_eq!(unsafe { fn_est_restart(est, &raw const given, null(), 1, null_mut(), 0) }, CERTIFIED);
    assert_eq!(get(est).0.payload_std_kg.to_bits(), get(anew).0.payload_std_kg.to_bits());
    assert_eq!(get(est).0.position_m, get(anew).0.position_m);
    for est in [est, anew] {
        assert_eq!(unsafe { fn_est_free(est) }, CERTIFIED);
    }
}

#[test]
fn starts_that_cannot_be_have_a_message() {
    let log = log();
    let mut wrong = settings();
    wrong.tension_std_n = 0.0;
    let (status, est, message) = new(&wrong, &readings(&log[0]));
    assert!(status == REFUSED && est.is_null() && message.contains("tension_std_n is 0"), "{message}");
    wrong = settings();
    wrong.payload_std_kg = f64::NAN;
    assert_eq!(new(&wrong, &readings(&log[0])).0, REFUSED);
    let none = EstReadings { length_m: null(), ..readings(&log[0]) };
    let (status, _, message) = new(&settings(), &none);
    assert!(status == REFUSED && message.contains("cable \"1\" has none"), "{message}");
}

/// A rope that slips by a millimetre at rest: alarm, explanation, and an estimator that follows it.
#[test]
fn a_slip_is_explained_and_taken() {
    let log = log();
    let mut row = log[0].clone();
    let only = |row: &[f64]| EstReadings {
        gyroscope_rad_s: null(),
        accelerometer_m_s2: null(),
        tracker_m: null(),
        ..readings(row)
    };
    let (_, est, _) = new(&settings(), &only(&row));
    // Tensions that the robot has at rest, and noise without a pattern.
    let rest = get(est).1.tension;
    let mut seed = 1_u64;
    let mut noise = || {
        (0..12)
            .map(|_| {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                (seed >> 11) as f64 / (1_u64 << 53) as f64
            })
            .sum::<f64>()
            - 6.0
    };
    let lengths = row[1..9].to_vec();
    let (mut alarm, mut rows) = (0, CableRows::new());
    let mut result = rows.result();
    for k in 0..600 {
        for i in 0..CABLES {
            row[1 + i] = lengths[i] + 2e-5 * noise();
            let lost = if i == 2 && k >= 500 { 68.0 } else { 0.0 };
            row[9 + i] = rest[i] - lost + 3.0 * noise();
        }
        let given = only(&row);
        assert_eq!(unsafe { fn_est_update(est, &raw const given, 0.002, &raw mut result) }, CERTIFIED);
        if result.alarm != 0 {
            alarm = result.alarm_cable;
            assert_eq!((result.alarm, k < 504), (7, true));
            break;
        }
    }
    assert_eq!(alarm, 2);
    let (mut faults, mut count, mut is_decided) = ([EstFault::default(); 8], 0, 0);
    let status = unsafe { fn_est_explain(est, faults.as_mut_ptr(), 8, &raw mut count, &raw mut is_decided) };
    assert!(status == CERTIFIED && count > 1 && faults[0].cable == 2 && faults[0].worse_by == 0.0, "{faults:?}");
    assert_eq!(unsafe { fn_est_take_fault(est, faults[0].kind, faults[0].cable) }, CERTIFIED);
    assert_eq!(unsafe { fn_est_free(est) }, CERTIFIED);
}

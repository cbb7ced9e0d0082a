//! Estimator: logs of simulated robots, and truths drawn from its own model.

use funicular::control_loop::MAX_CABLES;
use funicular::estimation::{Estimator, EstimationSettings, SensorGroup, SensorReadings, StatePriors};
use funicular::math::Vec3;
use funicular::robot::Robot;

/// File of docs/estimation.
fn document(name: &str) -> String {
    let path = format!("{}/../../docs/estimation/{name}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

fn robot() -> Robot {
    Robot::from_toml(&document("robot.toml")).unwrap()
}

/// Settings with which the noise of the log was drawn.
fn settings() -> EstimationSettings {
    EstimationSettings {
        priors: StatePriors { payload: [0.0, 0.5], first_moment: 0.05, ..StatePriors::default() },
        inertial_unit_p: Vec3::new(0.1, 0.0, 0.5),
        tracked_point_p: Vec3::new(0.0, 0.0, 1.0),
        ..EstimationSettings::default()
    }
}

/// Rows of the log: time and readings.
fn log() -> Vec<(f64, SensorReadings)> {
    let text = document("run.csv");
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    assert!(lines.next().unwrap().starts_with("t_s,length_1_m"));
    let number = |word: &str| if word.is_empty() { f64::NAN } else { word.parse().unwrap() };
    lines
        .map(|line| {
            let values: Vec<f64> = line.split(',').map(number).collect();
            let mut readings = SensorReadings::default();
            readings.lengths[..8].copy_from_slice(&values[1..9]);
            readings.tensions[..8].copy_from_slice(&values[9..17]);
            readings.accelerometer.copy_from_slice(&values[17..20]);
            readings.gyroscope.copy_from_slice(&values[20..23]);
            readings.tracker.copy_from_slice(&values[23..26]);
            (values[0], readings)
        })
        .collect()
}

/// Readings without the inertial unit.
fn without_inertial_unit(readings: &SensorReadings) -> SensorReadings {
    SensorReadings { accelerometer: [f64::NAN; 3], gyroscope: [f64::NAN; 3], ..*readings }
}

#[test]
fn probe() {
    let rows = log();
    let mut estimator = Estimator::new(robot(), settings(), &without_inertial_unit(&rows[0].1), None).unwrap();
    for pair in rows.windows(2) {
        let notes = estimator.update(&without_inertial_unit(&pair[1].1), pair[1].0 - pair[0].0).unwrap();
        let t = pair[1].0;
        if notes.alarm.is_some() || notes.gated > 0 {
            println!("{t:.2} {notes:?}");
        }
        if ((t * 100.0).round() as i64) % 50 == 0 {
            let s = estimator.state();
            println!(
                "{t:.2} p {:?} ±{:?}\n  rot ±{:?} m {:.3} ±{:.4} v {:?} trusted {} rings {} s {:?}\n T1 {:?}",
                s.pose.position_w, s.position_std, s.rotation_std, s.payload.value, s.payload.std, s.velocity, notes.is_trusted,
                s.rings, s.first_moment, s.cables[0]
            );
        }
    }
    for group in SensorGroup::ALL {
        println!("{} {:?} {:?}", group.name(), estimator.consistency(group).per_freedom(), estimator.consistency(group).band());
    }
    println!("{:?} {MAX_CABLES}", estimator.whiteness());
}

//! Estimator: logs of simulated robots, and truths drawn from its own model.

mod simulated;

use funicular::estimation::{
    EstimationError, EstimationSettings, Estimator, FaultKind, SensorGroup, SensorReadings, StatePriors,
};
use funicular::math::Vec3;
use funicular::robot::{Robot, State};
use funicular::statics::{self, StaticModel};

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

/// State of the log at some times by a separate program (NumPy) with the same model and settings: time, position,
/// its deviation, deviation of the turn, payload with its deviation, deviation of the velocity.
type LogState = (f64, [f64; 3], [f64; 3], [f64; 3], [f64; 2], [f64; 3]);

/// Values of the separate program.
const SEPARATE: [LogState; 3] = [
    (
        0.5,
        [0.001696, 0.001723, 1.507802],
        [0.0006371, 0.0008391, 0.0004095],
        [0.0008985, 0.0007146, 0.0006371],
        [-0.033, 0.3782],
        [0.0006948, 0.0007113, 0.0006633],
    ),
    (
        1.5,
        [0.052929, 0.027392, 1.489145],
        [0.0005596, 0.0006366, 0.0002508],
        [0.0006316, 0.0005812, 0.0006329],
        [-0.0676, 0.3711],
        [0.0006943, 0.000711, 0.0006624],
    ),
    (
        2.5,
        [0.001745, -0.045046, 1.474035],
        [0.0005408, 0.000591, 0.000229],
        [0.000582, 0.0005623, 0.0006273],
        [-0.1322, 0.3676],
        [0.0006943, 0.0007112, 0.0006612],
    ),
];

/// Before the payload is taken up the filter agrees with a separate program within a tenth of a deviation, and its
/// deviations within 1 %; the rest are roundings of the separate program and its start.
#[test]
fn a_log_gives_the_estimates_of_a_separate_program() {
    let rows = log();
    let mut estimator = Estimator::new(robot(), settings(), &without_inertial_unit(&rows[0].1), None).unwrap();
    let mut compared = 0;
    for pair in rows.windows(2).take_while(|pair| pair[1].0 < 2.95) {
        let notes = estimator.update(&without_inertial_unit(&pair[1].1), pair[1].0 - pair[0].0).unwrap();
        assert!(notes.alarm.is_none() && notes.is_trusted, "{} {notes:?}", pair[1].0);
        let here = SEPARATE.iter().find(|(time, ..)| (time - pair[1].0).abs() < 1e-9);
        let Some((_, position, position_std, rotation_std, payload, velocity_std)) = here else { continue };
        let state = estimator.state();
        let close = |found: f64, expected: f64, part: f64| {
            assert!((found / expected - 1.0).abs() < part, "{} s: {found} {expected}", pair[1].0);
        };
        for k in 0..3 {
            let off = state.pose.position_w[k] - position[k];
            assert!(off.abs() < 0.1 * position_std[k], "{} s: {off}", pair[1].0);
            close(state.position_std[k], position_std[k], 0.01);
            close(state.rotation_std[k], rotation_std[k], 0.01);
            close(state.velocity[k].std, velocity_std[k], 0.01);
        }
        assert!((state.payload.value - payload[0]).abs() < 0.1 * payload[1], "{:?}", state.payload);
        close(state.payload.std, payload[1], 0.01);
        compared += 1;
    }
    assert_eq!(compared, SEPARATE.len());
    let consistency = estimator.consistency(SensorGroup::Tensions);
    let ratio = consistency.per_freedom().unwrap();
    assert!((0.9..1.1).contains(&ratio), "{ratio}");
}

/// A payload is found 40 ms after it was taken up, and after 3 s its value lies within three stated deviations of at
/// most 1 kg of the truth, although the ropes vibrate at frequencies that the filter does not have.
#[test]
fn a_payload_that_is_taken_up_is_found_with_a_true_deviation() {
    for inertial_unit in [false, true] {
        let of = |readings: &SensorReadings| {
            if inertial_unit { *readings } else { without_inertial_unit(readings) }
        };
        let rows = log();
        let mut estimator = Estimator::new(robot(), settings(), &of(&rows[0].1), None).unwrap();
        let mut alarms = Vec::new();
        for pair in rows.windows(2) {
            let notes = estimator.update(&of(&pair[1].1), pair[1].0 - pair[0].0).unwrap();
            alarms.extend(notes.alarm);
            let state = estimator.state();
            let off = (state.payload.value - 18.393) / state.payload.std;
            if pair[1].0 > 3.1 {
                assert!(off.abs() < 3.0, "{} s: {:?}", pair[1].0, state.payload);
            }
        }
        assert_eq!(alarms.len(), 1, "{alarms:?}");
        assert_eq!(alarms[0].kind, Some(FaultKind::Payload));
        assert!((alarms[0].time - 3.0) < 0.07, "{alarms:?}");
        let state = estimator.state();
        assert!(state.payload.std < 1.0, "{:?}", state.payload);
    }
}

/// Deviations at one pose by a separate program with the same priors: x, y, z [mm], roll [deg] and
/// payload [kg].
#[test]
fn one_pose_at_rest_has_the_deviations_of_a_separate_program() {
    let robot = robot();
    let State::Lengths(lengths) = &robot.state else { panic!("the file gives lengths") };
    let rest = statics::forward(&robot, lengths, StaticModel::Catenary, None).unwrap();
    let mut settings = EstimationSettings::default();
    settings.noise.tension = 1.0;
    let mut only = SensorReadings::default();
    only.lengths[..8].copy_from_slice(lengths);
    let mut with_cells = only;
    for (tension, cable) in with_cells.tensions.iter_mut().zip(&rest.cables) {
        *tension = cable.tension_anchor;
    }
    let expected = [(only, [0.65, 0.87, 2.66, 0.065, 20.0]), (with_cells, [0.64, 0.85, 1.01, 0.063, 0.60])];
    for (readings, expected) in expected {
        let state = Estimator::new(robot.clone(), settings, &readings, None).unwrap().state();
        let [x, y, z] = state.position_std.map(|std| 1e3 * std);
        let found = [x, y, z, state.rotation_std[0].to_degrees(), state.payload.std];
        for (found, expected) in found.iter().zip(expected) {
            // Half a unit of the last printed digit, and a little.
            assert!((found - expected).abs() < 0.015 * expected.max(0.4), "{found} {expected}");
        }
    }
}

/// Numbers without a pattern, normal with deviation one.
struct RestDraws(u64);

impl RestDraws {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        (-2.0 * self.uniform().ln()).sqrt() * (std::f64::consts::TAU * self.uniform()).cos()
    }
}

/// Mean squares of errors over stated deviations of position, payload and the tensions of all cables, and NIS of the
/// load cells, for robots at rest with drawn offsets, biases, forces and payloads. The statics room has no part of the
/// filter. `factor` multiplies the biases of the truth, which the settings do not know.
fn mean_squares(draws_count: u32, factor: f64) -> ([f64; 12], f64) {
    let robot = robot();
    let State::Lengths(lengths) = &robot.state else { panic!("the file gives lengths") };
    let mut settings = EstimationSettings::default();
    (settings.noise.tension, settings.priors.payload) = (1.0, [30.0, 5.0]);
    // The truth rests, so that tensions have no part of a velocity.
    (settings.priors.velocity, settings.priors.angular_velocity) = (0.0, 0.0);
    let (noise, priors) = (settings.noise, settings.priors);
    let mut draws = RestDraws(5);
    let (mut sums, mut nis) = ([0.0; 12], 0.0);
    let share = 1.0 / f64::from(draws_count);
    for _ in 0..draws_count {
        let mut truth = robot.clone();
        let payload = priors.payload[0] + priors.payload[1] * draws.normal();
        truth.load.force_w = Vec3::from_fn(|_, _| priors.force * draws.normal()) + robot.gravity_w * payload;
        let first = Vec3::from_fn(|_, _| priors.first_moment * draws.normal());
        truth.load.moment_w = first.cross(&robot.gravity_w) + Vec3::from_fn(|_, _| priors.moment * draws.normal());
        let rest = statics::forward(&truth, lengths, StaticModel::Catenary, None).unwrap();
        let mut readings = SensorReadings::default();
        for (i, length) in lengths.iter().enumerate() {
            readings.lengths[i] = length + priors.offset * draws.normal() + noise.length * draws.normal();
            let tension = rest.cables[i].tension_anchor;
            readings.tensions[i] =
                tension + factor * priors.tension_bias * draws.normal() + noise.tension * draws.normal();
        }
        let mut estimator = Estimator::new(robot.clone(), settings, &readings, None).unwrap();
        let state = estimator.state();
        let off = state.pose.position_w - rest.pose.position_w;
        let errors = (0..3)
            .map(|k| off[k] / state.position_std[k])
            .chain([(state.payload.value - payload) / state.payload.std])
            .chain((0..8).map(|i| {
                let tension = state.cables[i].tension;
                (tension.value - rest.cables[i].tension_anchor) / tension.std
            }));
        sums.iter_mut().zip(errors).for_each(|(sum, error)| *sum += error * error * share);
        nis += estimator.consistency(SensorGroup::Tensions).per_freedom().unwrap() * share;
    }
    (sums, nis)
}

/// Stated deviations hold the errors of drawn truths: 4000 squares have a mean of one within 0.075 (3.3 deviations of
/// such a mean, for twelve of them), the 32000 of the innovations within 0.027. Biases that are a twentieth larger than
/// stated are found.
#[test]
fn deviations_at_rest_are_true_for_drawn_robots() {
    let (squares, nis) = mean_squares(4000, 1.0);
    assert!(squares.iter().all(|square| (square - 1.0).abs() < 0.075), "{squares:?}");
    assert!((nis - 1.0).abs() < 0.027, "{nis}");
    let (_, larger) = mean_squares(1000, 1.05);
    assert!(larger > 1.027, "{larger}");
}

/// A slip of 1 mm at rest raises an alarm within three samples, and the right cable is named with its millimetre.
#[test]
fn a_slip_of_a_millimetre_is_found_on_its_cable() {
    let robot = robot();
    let State::Lengths(lengths) = &robot.state else { panic!("the file gives lengths") };
    let rest = statics::forward(&robot, lengths, StaticModel::Catenary, None).unwrap();
    for slipping in [0, 2, 7] {
        let mut draws = RestDraws(slipping as u64 + 1);
        let mut read = |slip: f64| {
            let mut readings = SensorReadings::default();
            for (i, length) in lengths.iter().enumerate() {
                readings.lengths[i] = length + 2e-5 * draws.normal();
                // In the first milliseconds the platform stays where it is: the stiffness of the cable alone counts.
                let soft = if i == slipping { 68e3 * slip } else { 0.0 };
                readings.tensions[i] = rest.cables[i].tension_anchor - soft + 3.0 * draws.normal();
            }
            readings
        };
        let mut estimator = Estimator::new(robot.clone(), settings(), &read(0.0), None).unwrap();
        for _ in 0..500 {
            let notes = estimator.update(&read(0.0), 0.002).unwrap();
            assert!(notes.alarm.is_none(), "{notes:?} {:?}", estimator.whiteness());
        }
        let alarm = (1..=3).find_map(|_| estimator.update(&read(1e-3), 0.002).unwrap().alarm);
        assert_eq!(alarm.and_then(|alarm| alarm.cable), Some(slipping), "{alarm:?}");
        let verdict = estimator.explain().unwrap();
        let first = verdict.hypotheses[0].unwrap();
        assert_eq!(first.cable, Some(slipping), "{verdict:?}");
    }
}

#[test]
fn what_cannot_be_used_is_an_error_and_leaves_no_number_that_is_none() {
    let rows = log();
    let missing = SensorReadings { lengths: [f64::NAN; 16], ..rows[0].1 };
    let refused = Estimator::new(robot(), settings(), &missing, None).unwrap_err();
    assert!(matches!(&refused, EstimationError::NoLength { cable } if cable == "1"), "{refused}");

    let mut estimator = Estimator::new(robot(), settings(), &rows[0].1, None).unwrap();
    for step in [0.0, -0.01, f64::NAN, 1e9] {
        let refused = estimator.update(&rows[1].1, step).unwrap_err();
        assert!(matches!(refused, EstimationError::BadStep { .. }), "{refused}");
    }
    // Encoders that are silent: the estimate goes on for 0.2 s.
    let silent = SensorReadings::default();
    for _ in 0..19 {
        estimator.update(&silent, 0.01).unwrap();
        assert!(estimator.state().pose.position_w.iter().all(|value| value.is_finite()));
    }
    let _ = estimator.update(&silent, 0.01);
    let lost = estimator.update(&silent, 0.01).unwrap_err();
    assert!(matches!(lost, EstimationError::EncodersLost { .. }), "{lost}");
}

/// Deviations at rest by differences of the statics, which share no tangent with the filter: every number that the
/// filter does not know is moved by a small part of its prior, and the readings give least squares about these
/// differences. They agree within 0.2 %, which is what the differences leave.
#[test]
fn deviations_at_rest_are_those_of_differences_of_the_statics() {
    let robot = robot();
    let State::Lengths(lengths) = &robot.state else { panic!("the file gives lengths") };
    let mut settings = EstimationSettings::default();
    settings.priors.payload = [30.0, 5.0];
    // The tension of a moving cable has a part of its own, which no statics has.
    (settings.priors.velocity, settings.priors.angular_velocity) = (0.0, 0.0);
    let (noise, priors) = (settings.noise, settings.priors);

    // Causes: wrench, payload, first moment, error of each length.
    let stds: Vec<f64> = [priors.force; 3]
        .into_iter()
        .chain([priors.moment; 3])
        .chain([priors.payload[1]])
        .chain([priors.first_moment; 3])
        .chain([priors.offset.hypot(noise.length); 8])
        .collect();
    let at = |cause: Option<(usize, f64)>| {
        let value = |k: usize| cause.filter(|(of, _)| *of == k).map_or(0.0, |(_, value)| value);
        let mut truth = robot.clone();
        let payload = priors.payload[0] + value(6);
        truth.load.force_w = Vec3::from_fn(|k, _| value(k)) + robot.gravity_w * payload;
        let rest = |truth: &Robot| {
            let lengths: Vec<f64> = lengths.iter().enumerate().map(|(i, length)| length + value(10 + i)).collect();
            statics::forward(truth, &lengths, StaticModel::Catenary, None).unwrap()
        };
        // The first moment is that in platform axes, so that its moment follows the turn.
        let mut found = rest(&truth);
        for _ in 0..3 {
            let first = found.pose.rot_wp * Vec3::from_fn(|k, _| value(7 + k));
            truth.load.moment_w = first.cross(&robot.gravity_w) + Vec3::from_fn(|k, _| value(3 + k));
            found = rest(&truth);
        }
        let tensions = found.cables.iter().map(|cable| cable.tension_anchor);
        found.pose.position_w.iter().copied().chain(tensions).collect::<Vec<f64>>()
    };
    let by_cause: Vec<Vec<f64>> = (stds.iter().enumerate())
        .map(|(k, std)| {
            let step = 0.01 * std;
            let ends = [at(Some((k, step))), at(Some((k, -step)))];
            ends[0].iter().zip(&ends[1]).map(|(up, down)| (up - down) / (2.0 * step) * std).collect()
        })
        .collect();

    // Covariance of position and tensions, less what the load cells tell, one after the other.
    let mut rows: Vec<Vec<f64>> = (0..11).map(|k| by_cause.iter().map(|of| of[k]).collect()).collect();
    rows.push((0..stds.len()).map(|k| if k == 6 { stds[6] } else { 0.0 }).collect());
    let mut covariance: Vec<Vec<f64>> =
        (rows.iter()).map(|a| rows.iter().map(|b| a.iter().zip(b).map(|(a, b)| a * b).sum()).collect()).collect();
    for i in 0..8 {
        let column: Vec<f64> = covariance.iter().map(|row| row[3 + i]).collect();
        let spread = column[3 + i] + noise.tension.powi(2) + priors.tension_bias.powi(2);
        for (row, a) in covariance.iter_mut().zip(&column) {
            row.iter_mut().zip(&column).for_each(|(entry, b)| *entry -= a * b / spread);
        }
    }

    let mut readings = SensorReadings::default();
    readings.lengths[..8].copy_from_slice(lengths);
    readings.tensions[..8].copy_from_slice(&at(None)[3..]);
    let state = Estimator::new(robot.clone(), settings, &readings, None).unwrap().state();
    let found = (state.position_std.into_iter())
        .chain(state.cables[..8].iter().map(|cable| cable.tension.std))
        .chain([state.payload.std]);
    for (k, found) in found.enumerate() {
        let expected = covariance[k][k].sqrt();
        assert!((found / expected - 1.0).abs() < 2e-3, "{k}: {found} {expected}");
    }
}

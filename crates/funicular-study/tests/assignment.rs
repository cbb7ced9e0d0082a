//! Frequencies without numbers: the true modes are found, or the result says that they are not determined.

use funicular_study::analyses::identify::Identified;
use funicular_study::{Request, Results, Silent, run};
use serde_json::{Value, json};

const HALL: &str = include_str!("../../../docs/quick-start/hall.toml");

fn results(request: &Value) -> Results {
    run(&Request::from_json(&request.to_string()).unwrap(), &mut Silent).unwrap()
}

fn identified(request: &Value) -> Identified {
    match results(request) {
        Results::Identify(found) => *found,
        _ => panic!("identify was requested"),
    }
}

/// Natural frequencies of the six-cable robot with another mass.
fn frequencies(mass: f64) -> Vec<f64> {
    let robot = json!({"text": funicular_robots::YUAN2014_4MM, "set": [{"path": "platform.mass_kg", "value": mass}]});
    let Results::Modes(found) = results(&json!({"command": "modes", "robot": robot, "below_hz": 4.0})) else {
        panic!("modes were requested")
    };
    found.modes.iter().map(|mode| mode.frequency_hz).collect()
}

/// Mass of the six-cable robot from frequencies without numbers.
fn mass(measured: &[f64], more: &Value) -> Identified {
    let measured: Vec<Value> = measured.iter().map(|hz| json!({"frequency_hz": hz})).collect();
    let mut request = json!({
        "command": "identify", "robot": {"text": funicular_robots::YUAN2014_4MM}, "fit": [{"path": "platform.mass_kg"}],
        "experiments": [{"frequencies": measured}],
    });
    request.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    identified(&request)
}

/// A wrong mass of 10.9 kg fits these with χ²/n = 1.02, and it is the nearest one to the mass of the file.
#[test]
fn the_true_modes_are_found_beyond_a_wrong_minimum() {
    let all = frequencies(14.3);
    let measured: Vec<f64> = [1, 2, 4, 6, 8].map(|number| all[number - 1]).to_vec();
    let found = mass(&measured, &json!({}));
    assert!((found.values[0].value - 14.3).abs() < 1e-5, "{}", found.values[0].value);
    assert_eq!(found.frequencies.iter().map(|row| row.number).collect::<Vec<_>>(), [1, 2, 4, 6, 8]);
    let assignment = found.assignment.unwrap();
    assert!(assignment.determined, "{:?}", assignment.doubts);
    assert_eq!((assignment.frequencies, assignment.random_lists), (5, 100));
    let second = assignment.second_best.unwrap();
    assert!((second.values[0] - 10.87).abs() < 0.1 && (second.chi2 - 4.1).abs() < 0.1, "{:?}", second.values);
    assert_ne!(second.numbers, [1, 2, 4, 6, 8]);
    // The frequencies of the second best modes are those of its mass.
    let of_second = frequencies(second.values[0]);
    for (number, hz) in second.numbers.iter().zip(&second.frequency_hz) {
        assert!((of_second[number - 1] / hz - 1.0).abs() < 1e-9);
    }
}

/// A list of noise as large as the distance of the modes fits many masses, and no interval is given.
#[test]
fn lists_that_any_robot_fits_have_no_interval() {
    let check = |frequencies: &[f64]| {
        let measured: Vec<Value> = frequencies.iter().map(|hz| json!({"frequency_hz": hz})).collect();
        let found = identified(&json!({
            "command": "identify", "robot": {"text": HALL}, "fit": [{"path": "platform.mass_kg"}],
            "profile": ["platform.mass_kg"],
            "experiments": [{"hold_lengths_of_pose": true, "frequencies": measured}],
        }));
        let row = &found.values[0];
        assert!(row.deviation.is_none() && row.interval_95.is_none() && row.profile.is_none(), "{}", row.value);
        let assignment = found.assignment.unwrap();
        assert!(!assignment.determined && assignment.random_as_good > 10, "{:?}", assignment.doubts);
        assert!(found.warnings.iter().any(|text| text.contains("is not determined for 3 frequencies")));
    };
    // Frequencies of modes 1 and some more in rad/s, and three random numbers.
    check(&[7.73, 8.84, 9.25]);
    check(&[5.792, 9.543, 11.306]);
}

/// Numbers between 0 and 1 without a pattern.
fn uniform(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1_u64 << 53) as f64
}

/// Masses up to 40 % away, some of the lowest modes, and errors from none to the assumed 1 %: the true mass is the best
/// or the second best one, or the result has no interval. An interval that is given holds it.
#[test]
fn no_interval_is_both_tight_and_wrong() {
    let mut state = 20_141;
    let mut determined = 0;
    for trial in 0..12 {
        let true_mass = 10.55 * (0.68 * (uniform(&mut state) - 0.5)).exp();
        let noise = [0.0, 0.001, 0.003, 0.01][trial % 4];
        let all = frequencies(true_mass);
        let measured: Vec<f64> = (all.iter().take(14))
            .filter_map(|hz| {
                let (kept, error) = (uniform(&mut state) < 0.45, uniform(&mut state) - 0.5);
                kept.then_some(hz * (1.0 + 12.0_f64.sqrt() * noise * error))
            })
            .collect();
        let found = mass(&measured, &json!({"frequency_noise": 0.01}));
        let row = &found.values[0];
        let Some(deviation) = row.deviation else { continue };
        determined += 1;
        // Exact frequencies are fitted to the rounding of a search.
        let tolerance = (3.5 * deviation).max(1e-4 * true_mass);
        assert!((row.value - true_mass).abs() <= tolerance, "{trial}: {} ± {deviation} for {true_mass}", row.value);
    }
    assert!(determined >= 4, "{determined}");
}

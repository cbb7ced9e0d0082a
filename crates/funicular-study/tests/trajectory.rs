//! `trajectory` by requests: largest values, jumps, used parts, and rows with few digits.

use funicular_study::{Request, Silent, run};
use serde_json::{Value, json};

/// Results of a move of CoGiRo with further keys.
fn found(more: &Value) -> Value {
    let mut request = json!({
        "command": "trajectory", "robot": { "name": "cogiro.toml", "text": funicular_robots::COGIRO },
    });
    for (key, value) in more.as_object().unwrap() {
        request[key] = value.clone();
    }
    let request: Request = serde_json::from_value(request).unwrap();
    let results = run(&request, &mut Silent).unwrap_or_else(|error| panic!("{error}"));
    serde_json::to_value(&results).unwrap()
}

fn moved(more: &Value) -> Value {
    let mut all = json!({
        "pose": [0.0, 0.0, 1.5, 0.0, 0.0, 0.0], "move_to": [1.0, 0.6, 1.5, 0.0, 0.0, 0.0], "speed_m_s": 1.0,
        "acceleration_m_s2": 2.0, "jerk_m_s3": 20.0,
    });
    for (key, value) in more.as_object().unwrap() {
        all[key] = value.clone();
    }
    found(&all)
}

fn extreme(found: &Value, what: &str) -> (f64, bool) {
    let of = found["extremes"].as_array().unwrap().iter().find(|of| of["what"] == what).unwrap();
    (of["value"].as_f64().unwrap(), of.get("no_bound").is_some())
}

#[test]
fn largest_values_do_not_depend_on_the_rows() {
    for (more, jumps) in [(json!({}), false), (json!({ "course": "jerk-limited" }), true)] {
        let of = |step: f64| {
            let mut all = more.clone();
            all["sample_time_s"] = step.into();
            moved(&all)
        };
        let coarse = of(0.04);
        for step in [0.01, 0.004] {
            let fine = of(step);
            for what in ["largest speed", "largest acceleration"] {
                let ((a, _), (b, no_bound)) = (extreme(&coarse, what), extreme(&fine, what));
                assert!((a - b).abs() < 0.01 * b, "{more} {step} {what}: {a} {b}");
                assert_eq!(no_bound, jumps && what == "largest acceleration", "{more} {what}");
            }
        }
        assert_eq!(coarse["path_jumps"].as_array().unwrap().is_empty(), !jumps);
        let used = coarse["used"].as_array().unwrap();
        let part = used.iter().find(|of| of["limit"] == "maximum-tension").unwrap()["part"].as_f64().unwrap();
        assert!((part - extreme(&coarse, "largest tension").0 / 5000.0).abs() < 1e-9);
    }
}

/// The rule `stiffest` bends at 7.79 s, where two stiffnesses meet: no limit is reached, and no tension jumps.
#[test]
fn a_bend_of_a_rule_between_rows_is_found() {
    let of = |step: f64| {
        moved(&json!({
            "pose": [0.0, 0.0, 2.0, 0.0, 0.0, 0.0], "move_to": [-2.7277, 0.0411, 1.9895, 0.0, 0.0, 0.0],
            "speed_m_s": 0.3, "acceleration_m_s2": 1.0, "jerk_m_s3": 40.0, "tension_rule": "stiffest",
            "sample_time_s": step,
        }))
    };
    for step in [0.1, 0.02] {
        let found = of(step);
        // Rows of 0.1 ms have 0.2830 m/s with differences of a noise of 0.0003 m/s.
        let speed = extreme(&found, "largest speed").0;
        assert!((speed - 0.2825).abs() < 0.001, "{step} {speed}");
        let acceleration = found["extremes"].as_array().unwrap().iter();
        let acceleration = acceleration.into_iter().find(|of| of["what"] == "largest acceleration").unwrap();
        let why = acceleration["no_bound"].as_str().unwrap();
        assert!(acceleration.get("value").is_none() && why.contains("stiffnesses meet or part"), "{why}");
    }
}

#[test]
fn steps_are_exact_and_the_last_is_shorter() {
    let of = moved(&json!({ "sample_time_s": 0.03 }));
    let times: Vec<f64> = of["rows"].as_array().unwrap().iter().map(|row| row["t_s"].as_f64().unwrap()).collect();
    let last = times.len() - 1;
    assert!((0..last).all(|k| (times[k] - 0.03 * k as f64).abs() < 1e-14));
    assert!(times[last].total_cmp(&of["duration_s"].as_f64().unwrap()).is_eq());
    assert!(times[last] - times[last - 1] <= 0.03);
}

#[test]
fn rounded_rows_are_smoothed_within_half_a_digit() {
    let path = |digits: i32| {
        let unit = 10.0_f64.powi(digits);
        let column = |value: fn(f64) -> f64| -> Vec<f64> {
            (0..=150).map(|k| (value(f64::from(k) / 150.0) * unit).round() / unit).collect()
        };
        let times: Vec<f64> = (0..=150).map(|k| f64::from(k) / 100.0).collect();
        let x = column(|u| 0.8 * (u - (std::f64::consts::TAU * u).sin() / std::f64::consts::TAU));
        json!({ "t_s": times, "x_m": x, "y_m": column(|_| 0.2), "z_m": column(|_| 1.5) })
    };
    let tension = |more: &Value| extreme(&found(more), "largest tension").0;
    let exact = tension(&json!({ "path": path(9) }));
    let rounded = tension(&json!({ "path": path(4) }));
    let smooth = tension(&json!({ "path": path(4), "row_tolerance_m": 5e-5 }));
    assert!((smooth - exact).abs() < 5e-3 * exact, "{smooth} {exact}");
    assert!((rounded - exact).abs() > 4.0 * (smooth - exact).abs(), "{rounded} {smooth} {exact}");
}

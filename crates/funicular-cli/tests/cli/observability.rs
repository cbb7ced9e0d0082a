//! `observability`: deviations of a separate program, and requests that are refused.

use super::{json, project, robot, run, stderr};
use serde_json::Value;

fn observed(more: &[&str]) -> Value {
    json(&[&["observability", &project("docs/estimation/robot.toml")], more].concat())
}

fn case<'a>(found: &'a Value, name: &str) -> &'a Value {
    let cases = found["cases"].as_array().unwrap();
    cases.iter().find(|case| case["with"] == name).unwrap_or_else(|| panic!("{name} is not in {found}"))
}

fn number_of<'a>(found: &'a Value, name: &str) -> &'a Value {
    let numbers = found["numbers"].as_array().unwrap();
    numbers.iter().find(|number| number["number"] == name).unwrap_or_else(|| panic!("{name} is not in {found}"))
}

/// Deviations of x, y, z [mm], of the turn about x [deg] and of the payload [kg] at one pose of CoGiRo, by a separate
/// program (NumPy) with the same noise and priors, to its printed digits. Its tracker tells the height alone: x and y
/// are joined by hand with the 1 mm of a tracker, 1/σ² = 1/0.65² + 1/1².
#[test]
fn one_pose_has_the_deviations_of_a_separate_program() {
    let expected: [(&str, &str, [f64; 5]); 4] = [
        ("none", "encoders alone", [0.65, 0.87, 2.66, 0.065, 20.0]),
        ("none", "and tensions", [0.64, 0.85, 1.01, 0.063, 0.60]),
        ("none", "and tracker", [0.545, 0.656, 0.94, 0.059, 10.0]),
        ("tensions,tracker", "these sensors", [0.539, 0.648, 0.71, 0.058, 0.60]),
    ];
    let mut tracked = Vec::new();
    for (sensors, with, expected) in expected {
        let found = observed(&["--sensors", sensors, "--tension-std-n", "1"]);
        let case = case(&found, with);
        let of = |key: &str, k: usize| case[key][k].as_f64().unwrap();
        let position = [0, 1, 2].map(|k| 1e3 * of("position_std_m", k));
        let payload = case["payload_std_kg"].as_f64().unwrap();
        let values = [position[0], position[1], position[2], of("rotation_std_deg", 0), payload];
        for (value, expected) in values.iter().zip(expected) {
            // Half a unit of the last printed digit, and a little.
            assert!((value - expected).abs() < 0.015 * expected.max(0.4), "{with}: {values:?} {expected}");
        }
        tracked.push(values[2]);
    }
    // More sensors never make a number worse.
    assert!(tracked[3] < tracked[1] && tracked[3] < tracked[2]);
}

#[test]
fn what_sensors_determine_is_said_with_the_best_addition() {
    let found = observed(&["--sensors", "none"]);
    let payload = number_of(&found, "payload");
    assert_eq!(payload["determined"], "prior");
    assert_eq!(payload["best_addition"], "and tensions", "{payload}");
    let told = found["not_determined"].to_string();
    assert!(told.contains("payload: ± 20.0 kg is what was known beforehand; tensions would make it ±"), "{told}");
    // A single load cell tells the payload, though less well than all.
    let one = case(&found, "and the load cell of cable 3");
    let all = case(&found, "and tensions")["payload_std_kg"].as_f64().unwrap();
    let one = one["payload_std_kg"].as_f64().unwrap();
    assert!(one < 12.0 && one > all, "{one} {all}");

    let found = observed(&["--sensors", "tensions"]);
    assert_eq!(number_of(&found, "payload")["determined"], "sensors");
    // Several poses tell the payload better than one, and what was given exactly stays so.
    let one = number_of(&found, "payload")["std"].as_f64().unwrap();
    let grid = ["--grid", "x=-1:1:2", "--grid", "y=-1:1:2", "--grid", "z=1.5"];
    let several = observed(&[&["--sensors", "tensions", "--offset-std-m", "0"], &grid[..]].concat());
    assert_eq!(several["poses"], 4);
    let four = number_of(&several, "payload")["std"].as_f64().unwrap();
    // The constant errors of the load cells stay: less than by the root of four.
    assert!(four < 0.8 * one && four > 0.5 * one, "{four} {one}");
    let offset = number_of(&several, "offset of a length");
    assert_eq!((&offset["determined"], offset["std"].as_f64()), (&"given".into(), Some(0.0)));
}

/// A planar robot turns and moves in its plane only: numbers of the other directions are known exactly.
#[test]
fn a_planar_robot_has_numbers_of_its_plane() {
    let found = json(&["observability", &robot("kntu-planar.toml"), "--pose", "0,0,0", "--sensors", "tracker"]);
    let given: Vec<&str> = found["numbers"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|number| number["determined"] == "given")
        .map(|number| number["number"].as_str().unwrap())
        .collect();
    assert!(given.len() >= 3 && given.iter().any(|name| name.starts_with("position")), "{given:?}");
    let further = found["cases"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|case| case["with"].as_str().unwrap().contains("at a distance of"));
    assert!(further.count() <= 4);
}

#[test]
fn requests_that_contradict_themselves_are_refused() {
    let file = project("docs/estimation/robot.toml");
    for (words, told) in [
        (&["--sensors", "tension"][..], "did you mean `tensions`?"),
        (&["--sensors", "tracker,tracker"], "--sensors has tracker twice"),
        (&["--sensors", "none,tracker"], "--sensors has none and others"),
        (&["--static-model", "ideal"], "leave out --static-model"),
        (&["--grid", "x=-1:1:31"], "there are 31 poses: give 1 to 30"),
        (&["--further-pose-m", "0"], "--further-pose-m"),
    ] {
        let refused = run(&[&["observability", &file][..], words].concat());
        assert_eq!(refused.status.code(), Some(2), "{}", stderr(&refused));
        assert!(stderr(&refused).contains(told), "{words:?}: {}", stderr(&refused));
    }
}

//! `gradient`: derivatives against differences of the program itself, choice of results and numbers, refusals.

use super::{csv, json, number, robot, run, run_with, stderr, succeed, yuan};
use serde_json::Value;

/// Derivative of a result by the number at a path.
fn derivative(found: &Value, result: &str, path: &str) -> f64 {
    let parameters = found["parameters"].as_array().unwrap();
    let column = parameters.iter().position(|parameter| parameter["path"] == path).unwrap_or_else(|| panic!("{path}"));
    let results = found["results"].as_array().unwrap();
    let row = results.iter().find(|row| row["name"] == result).unwrap_or_else(|| panic!("{result}: {results:?}"));
    number(&row["derivatives"][column])
}

/// Difference of a value over a step, to second order.
fn difference(step: f64, at: impl Fn(f64) -> f64) -> f64 {
    (at(step) - at(-step)) / (2.0 * step)
}

#[test]
fn derivatives_are_differences_of_the_program_with_lengths_and_with_the_pose_held() {
    // Options replace the pose of the file, so the derivatives belong to another state than its own.
    let pose = ["--pose", "0.1,0,0.5,0,2,3"];
    let found = json(&[&["gradient", "ROBOT", "--below-hz", "3", "--hold", "pose"], &pose[..]].concat());
    assert_eq!((found["held"].as_str(), found["per"].as_str()), (Some("pose"), Some("unit")));
    let frequency = |set: String| {
        number(
            &json(&[&["modes", "ROBOT", "--below-hz", "3", "--set", &set], &pose[..]].concat())["modes"][0]["frequency_hz"],
        )
    };
    for (path, value, step) in [
        ("platform.mass_kg", 10.55, 1e-2),
        ("cables.2.anchor_m.z", 3.822, 1e-4),
        ("materials.rope-4mm.mass_kg_per_m", 0.067, 1e-4),
    ] {
        let expected = difference(step, |step| frequency(format!("{path}={}", value + step)));
        let ours = derivative(&found, "frequency 1", path);
        // Third order of the step: a thousandth of the value at most.
        assert!((ours - expected).abs() < 1e-5 * expected.abs().max(1e-3), "{path}: {ours} {expected}");
    }

    let found = json(&["gradient", "ROBOT", "--of", "tensions,pose"]);
    assert_eq!(found["held"], "lengths");
    let statics = |step: f64, key: &str| {
        let set = format!("loads.force_n=[{step},0,0]");
        number(&json(&["statics", "ROBOT", "--set", &set])["cables"][2][key])
    };
    let expected = difference(0.05, |step| statics(step, "tension_anchor_n"));
    let ours = derivative(&found, "tension of cable \"3\" at the anchor", "loads.force_n.x");
    assert!((ours - expected).abs() < 1e-4 * expected.abs(), "{ours} {expected}");
}

/// With the rule held, a tension follows the rule at the changed robot. With the pose alone held it does so only where
/// the directions of the cables stay.
#[test]
fn derivatives_by_the_rule_of_the_tensions_are_differences_of_statics() {
    let cogiro = robot("cogiro.toml");
    let state = ["--pose", "1,2,1.5", "--target-tension-n", "350"];
    let gradient =
        |hold: &str| json(&[&["gradient", &cogiro, "--of", "tensions", "--hold", hold], &state[..]].concat());
    let found = gradient("rule");
    assert_eq!(found["held"], "rule");
    assert!(found["held_means"].as_str().unwrap().ends_with("such that the tensions obey the rule `closest`"));
    for (path, value, step) in [("platform.mass_kg", 91.058, 1e-2), ("cables.2.attachment_m.y", 0.3508, 1e-4)] {
        let expected = difference(step, |step| {
            let set = format!("{path}={}", value + step);
            number(&json(&[&["statics", &cogiro, "--set", &set], &state[..]].concat())["cables"][2]["tension_anchor_n"])
        });
        let name = "tension of cable \"3\" at the anchor";
        let ours = derivative(&found, name, path);
        assert!((ours - expected).abs() < 1e-5 * expected.abs(), "{path}: {ours} {expected}");
        let changing_least = derivative(&gradient("pose"), name, path);
        let differs = (changing_least - expected).abs() > 1e-4 * expected.abs();
        assert_eq!(differs, path.starts_with("cables"), "{path}: {changing_least} {expected}");
    }
}

#[test]
fn steps_are_factors_of_the_derivatives_and_patterns_choose_numbers() {
    let of = |more: &[&str]| {
        json(&[&["gradient", "ROBOT", "--of", "tensions", "--by", "cables.*.anchor_m.z,platform"], more].concat())
    };
    let unit = of(&[]);
    let paths: Vec<&str> = unit["parameters"].as_array().unwrap().iter().map(|p| p["path"].as_str().unwrap()).collect();
    assert!(paths.contains(&"platform.mass_kg") && paths.contains(&"cables.6.anchor_m.z"), "{paths:?}");
    assert!(!paths.iter().any(|path| path.ends_with("anchor_m.x") || path.starts_with("materials")), "{paths:?}");

    let name = "tension of cable \"1\" at the platform";
    let by_mass = |found: &Value| derivative(found, name, "platform.mass_kg");
    let percent = of(&["--per", "percent"]);
    assert!((by_mass(&percent) - 0.1055 * by_mass(&unit)).abs() < 1e-12);
    let tolerance = of(&["--per", "tolerance", "--tolerances", "platform.mass_kg=2%,cables.*.anchor_m=0.002"]);
    assert!((by_mass(&tolerance) - 0.211 * by_mass(&unit)).abs() < 1e-12);
    let [by_unit, by_tolerance] = [&unit, &tolerance].map(|found| derivative(found, name, "cables.6.anchor_m.z"));
    assert!((by_tolerance - 0.002 * by_unit).abs() < 1e-15, "{by_tolerance} {by_unit}");

    // A table stands for all its numbers, and an index for the name of a component.
    let of = |path: &str| json(&["gradient", "ROBOT", "--of", "tensions", "--by", path])["parameters"].clone();
    let paths = |path: &str| -> Vec<String> {
        of(path).as_array().unwrap().iter().map(|of| of["path"].as_str().unwrap().to_owned()).collect()
    };
    let table = paths("cables.1");
    assert!(table.len() > 5 && table.iter().all(|path| path.starts_with("cables.1.")), "{table:?}");
    assert_eq!(paths("cables.2.anchor_m.1"), ["cables.2.anchor_m.y"]);

    let (header, rows) = csv(&["gradient", "ROBOT", "--of", "tensions", "--by", "platform.mass_kg"]);
    assert_eq!((header.len(), rows.len()), (10, 12));
    let text = succeed(&["gradient", "ROBOT", "--of", "stiffness-min,lengths", "--hold", "pose", "--by", "platform"]);
    assert!(
        text.contains("Held: the pose is held, the lengths follow.") && text.contains("minimum stiffness = "),
        "{text}"
    );
}

#[test]
fn modes_that_share_a_frequency_have_a_block_and_a_response_two_rows() {
    // A point mass on four equal cables: horizontal motions share a frequency.
    let cables: Vec<String> = [("1", "2.0, 0.0"), ("2", "-2.0, 0.0"), ("3", "0.0, 2.0"), ("4", "0.0, -2.0")]
        .iter()
        .map(|(name, point)| {
            format!(
                "[[cables]]\nname = \"{name}\"\nmaterial = \"rope\"\nanchor_m = [{point}, \
                3.0]\nunstrained_length_m = 2.8\n"
            )
        })
        .collect();
    let cables = cables.concat();
    let text = format!(
        "name = \"square\"\n[platform]\nmotion = \"point-mass\"\nmass_kg = 10.0\n[materials.rope]\naxial_stiffness_n = \
         1e5\n\
         mass_kg_per_m = 0.05\n{cables}"
    );
    let options = ["gradient", "-", "--cable-model", "catenary-static", "--below-hz", "40", "--format", "json"];
    let output = run_with(&options, &text);
    assert!(output.status.success(), "{}", stderr(&output));
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    let entries = found["results"].as_array().unwrap().iter().filter(|row| row["block_entry"].is_array()).count();
    assert_eq!(entries, 3, "{found}");

    let response =
        ["--of", "response", "--at-hz", "1.3", "--input", "fz", "--output", "az", "--by", "materials.*.damping_ratio"];
    let found = json(&[&["gradient", "ROBOT"], &response[..]].concat());
    assert_eq!(found["results"].as_array().unwrap().len(), 2);
    assert_eq!(found["results"][0]["unit"], "(m/s²)/N");
}

#[test]
fn tensions_and_poses_follow_pulleys_and_winches() {
    let winches = robot("cogiro-winches.toml");
    let found = json(&["gradient", &winches, "--of", "tensions,pose,stiffness-min"]);
    let statics = |path: &str, value: f64| {
        let found = json(&["statics", &winches, "--set", &format!("{path}={value}")]);
        ["tension_platform_n", "tension_drum_n"].map(|key| {
            number(&found["cables"][0].get(key).map_or_else(|| found["cables"][0]["drive"][key].clone(), Clone::clone))
        })
    };
    for (path, value, step) in [
        ("pulleys.wheel.radius_m", 0.05, 1e-3),
        ("pulleys.wheel.entry_direction.x", 0.0, 1e-2),
        ("winches.drum.drum_side_length_m", 5.4, 1e-3),
    ] {
        for (k, end) in ["platform", "drum"].iter().enumerate() {
            let expected = difference(step, |step| statics(path, value + step)[k]);
            let ours = derivative(&found, &format!("tension of cable \"1\" at the {end}"), path);
            // Third order of the step, which is a hundredth of the value at most.
            assert!((ours - expected).abs() < 1e-3 * expected.abs(), "{path} {end}: {ours} {expected}");
        }
    }
}

#[test]
fn vibration_follows_the_control_of_winches() {
    let text = std::fs::read_to_string(robot("cogiro-winches.toml")).unwrap();
    let text = text.replace("gear_ratio = 3\n", "gear_ratio = 3\ncontrol = \"position\"\nbandwidth_hz = 5\n");
    let of = |text: &str, arguments: &[&str]| -> Value {
        let output = run_with(&[arguments, &["--format", "json"]].concat(), text);
        serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{arguments:?}: {}", stderr(&output)))
    };
    let response = ["--of", "response", "--at-hz", "1.7", "--input", "length:3", "--output", "z"];
    let modes = ["gradient", "-", "--below-hz", "3.45", "--by", "winches", "--of", "frequencies"];
    let by_winches = of(&text, &modes);
    let by_response = of(&text, &[&["gradient", "-", "--by", "winches"], &response[..]].concat());
    for (key, value, step) in [("bandwidth_hz", 5.0, 0.02), ("gear_ratio", 3.0, 0.01)] {
        let changed = |step: f64| text.replace(&format!("{key} = {value}"), &format!("{key} = {}", value + step));
        let path = format!("winches.drum.{key}");
        for (result, found, arguments) in [
            ("frequency 3", &by_winches, &modes[..]),
            (
                "response at 1.7 Hz, real part",
                &by_response,
                &[&["gradient", "-", "--by", "winches"], &response[..]].concat()[..],
            ),
        ] {
            let value = |step: f64| {
                let found = of(&changed(step), arguments);
                let results = found["results"].as_array().unwrap();
                number(&results.iter().find(|row| row["name"] == result).unwrap()["value"])
            };
            let (expected, ours) = (difference(step, value), derivative(found, result, &path));
            // Third order of the step.
            assert!((ours - expected).abs() < 1e-3 * expected.abs(), "{path}, {result}: {ours} {expected}");
        }
    }
}

/// The example of a robot on posts: numbers of its supports and of the drum sides from the ground.
#[test]
fn a_robot_on_posts_has_derivatives_by_the_numbers_of_its_supports() {
    let posts = super::project("docs/pulleys/posts.toml");
    let found = json(&["gradient", &posts, "--of", "tensions,frequencies,damping", "--below-hz", "1"]);
    let at = |step: f64, path: &str, value: f64| {
        let set = format!("{path}={}", value + step);
        let of = |command: &[&str]| json(&[command, &["--set", &set]].concat());
        let modes = of(&["modes", &posts, "--below-hz", "1"]);
        let tension = number(&of(&["statics", &posts])["cables"][4]["tension_platform_n"]);
        [number(&modes["modes"][0]["frequency_hz"]), tension]
    };
    for (path, value, step) in [
        ("supports.west.stiffness_n_per_m.xx", 1.5e5, 1e3),
        ("supports.east-south.mass_kg", 15.0, 0.1),
        ("winches.drum.drum_side_length_m", 3.0, 1e-3),
    ] {
        // A principal stiffness is the first of three numbers in the file.
        let set = path.replace(".xx", ".0");
        let (low, high) = (at(-step, &set, value), at(step, &set, value));
        for (k, result) in ["frequency 1", "tension of cable \"5\" at the platform"].iter().enumerate() {
            let expected = (high[k] - low[k]) / (2.0 * step);
            let ours = derivative(&found, result, path);
            // Third order of the step, and the rounding of the values, 1e-11.
            let allowed = 1e-3 * expected.abs() + 1e-9 / step;
            assert!((ours - expected).abs() < allowed, "{path}, {result}: {ours} {expected}");
        }
    }
}

#[test]
fn requests_without_derivatives_are_refused_with_the_reason() {
    let (cogiro, three_cables) = (robot("cogiro.toml"), robot("grab-3-cables.toml"));
    for (arguments, expected) in [
        (&["gradient", "ROBOT"][..], "`frequencies` needs --below-hz"),
        (&["gradient", "ROBOT", "--of", "tension"], "did you mean `tensions`?"),
        (
            &["gradient", "ROBOT", "--of", "pose", "--by", "platform.mas_kg"],
            "no such number; did you mean `platform.mass_kg`?",
        ),
        (&["gradient", "ROBOT", "--of", "pose", "--tolerances", "platform.mass_kg"], "write PATH=VALUE"),
        (&["gradient", "ROBOT", "--of", "response", "--at-hz", "1"], "`response` needs --input"),
        (&["gradient", "ROBOT", "--below-hz", "2", "--cable-model", "shallow-dynamic"], "not `shallow-dynamic`"),
        (&["gradient", "ROBOT", "--below-hz", "2", "--in-plane-only"], "need all terms of the stiffness"),
        (
            &["gradient", &three_cables, "--of", "tensions", "--hold", "pose"],
            "--hold pose: 3 cables cannot hold the pose of a platform with 6 degrees of freedom by their lengths; give \
             --hold lengths",
        ),
        (
            &["gradient", &cogiro, "--of", "lengths", "--hold", "rule"],
            "needs tensions that a rule has chosen: give --pose",
        ),
        (
            &[
                "gradient",
                &cogiro,
                "--of",
                "lengths",
                "--hold",
                "rule",
                "--pose",
                "0,0,1.5",
                "--tension-rule",
                "stiffest",
            ],
            "rule `stiffest` have no derivatives",
        ),
        (&["gradient", &cogiro, "--of", "pose", "--pose", "0,0,1.5", "--static-model", "ideal"], "need elastic cables"),
        (
            &["gradient", "ROBOT", "--of", "response", "--at-hz", "1", "--input", "cable:3@0.5:fz", "--output", "z"],
            "inputs and outputs on the platform",
        ),
    ] {
        let output = run(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(expected), "{arguments:?}: {}", stderr(&output));
    }

    // A slack cable without weight begins to pull at its chord: no derivative.
    let text = yuan()
        .replace("mass_kg_per_m = 0.067", "mass_kg_per_m = 0")
        .replace("unstrained_length_m = 6.863", "unstrained_length_m = 9.0");
    let output = run_with(&["gradient", "-", "--of", "tensions"], &text);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(stderr(&output).contains("at the edge of being slack"), "{}", stderr(&output));
}

/// The centre of the tensions has derivatives at every pose, also at a symmetric one.
#[test]
fn the_centre_of_the_tensions_is_followed() {
    let cogiro = robot("cogiro.toml");
    let arguments = ["gradient", &cogiro, "--of", "lengths", "--hold", "rule", "--pose", "0,0,1.5"];
    let text = succeed(&[&arguments[..], &["--tension-rule", "centre"]].concat());
    assert!(text.contains("the tensions obey the rule `centre`"), "{text}");
}

/// An empty list of modes is said, as a caveat: below 0.5 Hz there is none, below 1.1 Hz there is one.
#[test]
fn a_limit_below_the_first_frequency_is_a_caveat() {
    let deviations = ["--deviations", "platform.mass_kg=1%"];
    for command in [&["gradient"][..], &["uncertainty", deviations[0], deviations[1]][..]] {
        let found = |hz: &str| {
            json(&[&command[..1], &["ROBOT"], &command[1..], &["--of", "frequencies", "--below-hz", hz]].concat())
        };
        let said = "no natural frequency lies below 0.5 Hz: raise --below-hz";
        let warnings = |found: &Value| found["warnings"].as_array().unwrap().iter().any(|text| text == said);
        assert!(warnings(&found("0.5")), "{command:?}");
        assert!(!warnings(&found("1.1")), "{command:?}");
    }
}

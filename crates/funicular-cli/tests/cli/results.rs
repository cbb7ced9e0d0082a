//! What every command's output has in common: its keys, formats and warnings.

use super::{close, command, csv, json, number, robot, run, run_with, stderr, stdout, succeed, yuan};
use serde_json::Value;

#[test]
fn every_json_names_schema_command_and_robot_and_holds_no_null() {
    for line in [
        "check ROBOT",
        "parameters ROBOT",
        "statics ROBOT",
        "statics ROBOT --static-model ideal",
        "stiffness ROBOT --at-hz 2",
        "modes ROBOT --below-hz 3",
        "frf ROBOT --from-hz 0 --to-hz 3 --points 50 --input fz --output ay",
        "compare ROBOT --below-hz 3",
        "pose-error ROBOT --mass-kg 10:90:3 --tolerance-mm 5",
        "cable ROBOT --name 1 --from-hz 0 --to-hz 3 --points 5",
    ] {
        let arguments: Vec<&str> = line.split(' ').collect();
        let value = json(&arguments);
        assert_eq!(value["schema"], "funicular/1", "{line}");
        assert_eq!(value["command"], arguments[0], "{line}");
        assert_eq!(value["robot"], "INSA Rennes 6-cable suspended robot, 4 mm cables", "{line}");
        assert!(value["warnings"].is_array(), "{line}");
        assert!(!value.to_string().contains("null"), "{line}");
        let (header, rows) = csv(&arguments);
        assert!(!header.is_empty() && !rows.is_empty(), "{line}");
        let text = succeed(&arguments);
        assert!(!text.contains("NaN") && !text.contains("inf") && text.ends_with('\n'), "{line}: {text}");
    }
}

#[test]
fn massless_and_slack_cables_leave_their_keys_out() {
    let text = yuan().replace("mass_kg_per_m = 0.067", "mass_kg_per_m = 0");
    let value: Value =
        serde_json::from_str(stdout(&run_with(&["statics", "-", "--format", "json"], &text))).expect("it is JSON");
    assert!(value["cables"][0].get("string_frequency_hz").is_none());
    assert!(close(number(&value["cables"][0]["sag_ratio"]), 0.0, 0.0));
    let slack = json(&["statics", "ROBOT", "--static-model", "spring", "--set", "cables.1.unstrained_length_m=9"]);
    assert!(slack["cables"][0].get("lambda2").is_none());
    assert!(slack["warnings"][0].as_str().unwrap().contains("slack"), "{}", slack["warnings"]);
    for format in ["text", "csv"] {
        let output = run_with(&["modes", "-", "--below-hz", "9", "--format", format], &text);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert!(!stdout(&output).contains("NaN"));
    }
}

#[test]
fn warnings_go_to_stderr_and_into_the_json() {
    let arguments = ["modes", "ROBOT", "--below-hz", "400", "--cable-model", "spring", "--format", "json"];
    let output = run(&arguments);
    assert!(stderr(&output).starts_with("warning: 400 Hz"), "{}", stderr(&output));
    let value: Value = serde_json::from_str(stdout(&output)).unwrap();
    assert!(value["warnings"][0].as_str().unwrap().contains("axial"));
}

#[test]
fn set_changes_cables_by_name_and_text_without_quotes() {
    let value = json(&["check", "ROBOT", "--set", "cables.3.unstrained_length_m=6.5", "--set", "name=other"]);
    assert!(close(number(&value["cables"][2]["unstrained_length_m"]), 6.5, 0.0));
    assert_eq!(value["robot"], "other");
    let heavy = json(&["statics", "ROBOT", "--set", "platform.mass_kg=20"]);
    let same = json(&["statics", "ROBOT", "--mass-kg", "20"]);
    assert_eq!(heavy["pose"], same["pose"]);
}

#[test]
fn every_robot_of_the_library_is_checked_and_rests() {
    for name in ["yuan2014-4mm.toml", "yuan2014-8mm.toml", "cogiro.toml", "sap2000-8-cable-point-mass.toml"] {
        let path = robot(name);
        assert!(json(&["check", &path])["cables"].as_array().unwrap().len() >= 6);
        assert!(number(&json(&["statics", &path])["residual"]) <= 1e-10, "{name}");
    }
}

#[test]
fn output_is_the_same_every_time() {
    let once = || command(&["modes", "ROBOT", "--below-hz", "10"]).output().unwrap().stdout;
    assert_eq!(once(), once());
}

#[test]
fn a_list_without_modes_says_so_without_an_empty_table() {
    let text = succeed(&["modes", "ROBOT", "--below-hz", "0.5"]);
    assert!(text.contains("count below 0.5 Hz is 0, the list has 0 modes") && !text.contains("f [Hz]"), "{text}");
    let text = succeed(&[
        "frf",
        "ROBOT",
        "--from-hz",
        "0",
        "--to-hz",
        "0.2",
        "--points",
        "9",
        "--input",
        "fz",
        "--output",
        "z",
    ]);
    let compared = succeed(&["compare", "ROBOT", "--below-hz", "0.5"]);
    assert!(compared.contains("no modes, as the reference") && !compared.contains("[Hz]"), "{compared}");
    assert!(text.contains("0 peaks") && !text.contains("peak [Hz]"), "{text}");
}

#[test]
fn every_listed_parameter_is_one_that_set_takes_and_its_value_changes_nothing() {
    for robot in [robot("cogiro.toml"), robot("kntu-planar.toml"), "ROBOT".to_owned()] {
        let listed = json(&["parameters", &robot]);
        let rows = listed["parameters"].as_array().unwrap();
        assert!(rows.len() > 40, "{robot}: {}", rows.len());
        let changes: Vec<String> =
            rows.iter().map(|row| format!("--set={}={}", row["path"].as_str().unwrap(), row["value"])).collect();
        let set: Vec<&str> = ["check", robot.as_str()].into_iter().chain(changes.iter().map(String::as_str)).collect();
        assert_eq!(json(&set), json(&["check", &robot]));
        for row in rows {
            let [value, minimum, maximum] = ["value", "minimum", "maximum"].map(|key| row[key].as_f64().unwrap());
            assert!((minimum..=maximum).contains(&value), "{row}");
        }
    }
}

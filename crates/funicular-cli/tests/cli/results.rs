//! Keys, formats and warnings that the output of every command has in common.

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
        "gradient ROBOT --below-hz 1.1 --of frequencies,damping,tensions",
        "uncertainty ROBOT --deviations platform.mass_kg=1% --tolerances cables.*.anchor_m=0.0001",
        "uncertainty ROBOT --deviations platform.mass_kg=10% --method sampled --samples 20",
        "pose-error ROBOT --mass-kg 10:90:3 --tolerance-mm 5",
        "cable ROBOT --name 1 --from-hz 0 --to-hz 3 --points 5",
        "identify ROBOT --fit platform.mass_kg --measured-tensions-n 17,36,40,15,50,52 --starts 1",
        "design ROBOT --pose 0,0,0.5 --change platform.mass_kg=±1 --goal platform --min-stiffness-n-per-m 10",
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

/// Young's modulus in GPa given as Pa, in every command that has an equilibrium, and in `check`.
#[test]
fn an_implausible_value_is_warned_of_once_by_every_command() {
    let slip = ["--set", "materials.rope-4mm.youngs_modulus_pa=20"];
    let warning = "rope \"rope-4mm\": Young's modulus is 20 Pa, usual is 3e8 to 3e11 Pa: GPa given as Pa?";
    for line in [
        "check ROBOT",
        "statics ROBOT --pose 0,0,1",
        "modes ROBOT --pose 0,0,1 --below-hz 3",
        "stiffness ROBOT --pose 0,0,1",
        "cable ROBOT --name 1 --pose 0,0,1 --from-hz 0 --to-hz 3 --points 5",
        "map ROBOT --pose 0,0,1 --grid x=0:0.1:2",
        "map ROBOT --pose 0,0,1 --grid x=0:0.1:2 --format json",
        "map ROBOT --pose 0,0,1 --grid x=0:0.1:2 --format csv",
        "sweep ROBOT --pose 0,0,1 --vary platform.mass_kg=10,11",
        "report ROBOT --pose 0,0,1 --below-hz 2 -o -",
    ] {
        let arguments: Vec<&str> = line.split(' ').chain(slip).collect();
        let output = run(&arguments);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(0), "{line}: {said}");
        assert_eq!(said.matches(warning).count(), 1, "{line}: {said}");
        if line.starts_with("report") {
            assert!(!stdout(&output).contains("used within their range"), "{line}");
        }
    }

    // A remark where a value may be meant.
    let noted = succeed(&["check", "ROBOT", "--set", "materials.rope-4mm.youngs_modulus_pa=80e9"]);
    assert!(noted.contains("Note: rope \"rope-4mm\": `diameter_m` gives the area of the full circle"), "{noted}");
}

/// Pose of the file, of an option, and of a command that holds its lengths.
#[test]
fn an_angle_beyond_a_full_turn_is_warned_of() {
    let warning = "warning: yaw of the pose is 720 degrees, usual is -360 to 360 degrees: ";
    let without_lengths = std::fs::read_to_string(robot("cogiro.toml")).unwrap();
    let without_lengths: Vec<&str> =
        without_lengths.lines().filter(|line| !line.starts_with("unstrained_length_m")).collect();
    let text = without_lengths.join("\n") + "\n[state]\nposition_m = [0, 0, 1]\nroll_pitch_yaw_deg = [0, 0, 720]\n";
    let said = |line: &str| {
        let arguments: Vec<&str> = line.split(' ').collect();
        let output = run_with(&arguments, &text);
        assert_eq!(output.status.code(), Some(0), "{line}: {}", stderr(&output));
        stderr(&output).to_owned()
    };

    for line in [
        "check -",
        "statics -",
        "statics - --pose 0,0,1.5,0,0,720",
        "statics - --pose 0,0,1.5,0,0,720 --hold-lengths-of-pose --mass-kg 310",
        "modes - --below-hz 3",
        "map - --grid x=0:0.1:2",
        "report - --below-hz 2 -o -",
    ] {
        let said = said(line);
        assert_eq!(said.matches(warning).count(), 1, "{line}: {said}");
    }
    // The pose of the option replaces that of the file.
    assert!(!said("statics - --pose 0,0,1.5,0,0,7").contains("degrees"));
}

#[test]
fn an_error_comes_with_the_implausible_values_that_may_cause_it() {
    let far = ["statics", "ROBOT", "--pose", "0,0,1500"];
    let output = run(&far);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    let lines: Vec<&str> = said.lines().collect();
    assert!(lines.len() == 2 && lines[0].starts_with("error: no tensions found that hold this pose"), "{said}");
    assert!(lines[0].contains("no cable pulls against the load of 3"), "{said}");
    assert!(
        lines[1].starts_with("warning: distance of the platform") && lines[1].ends_with("mm or cm given as m?"),
        "{said}"
    );
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

//! `estimate`: the log of the documents, what its sensors do not determine, and logs that are refused.

use super::{json, project, run, stderr, stdout};
use std::fmt::Write as _;
use std::fs;

/// Words with the priors with which the noise of the log was drawn.
const PRIORS: [&str; 8] = [
    "--payload-std-kg",
    "0.5",
    "--first-moment-std-kg-m",
    "0.05",
    "--inertial-unit-m",
    "0.1,0,0.5",
    "--tracked-point-m",
    "0,0,1",
];

fn log_text() -> String {
    let text = fs::read_to_string(project("docs/estimation/run.csv")).unwrap();
    text.lines().filter(|line| !line.starts_with('#')).fold(String::new(), |mut text, line| {
        let _ = writeln!(text, "{line}");
        text
    })
}

/// Log with some of its columns, cells changed by a function of row and name.
fn log_with(keeps: impl Fn(&str) -> bool, cell: impl Fn(usize, &str, &str) -> String) -> String {
    let text = log_text();
    let names: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    let mut found = String::new();
    for (row, line) in text.lines().enumerate() {
        let cells = names.iter().zip(line.split(',')).filter(|(name, _)| keeps(name));
        let cells = cells.map(|(name, value)| if row == 0 { value.to_owned() } else { cell(row - 1, name, value) });
        let _ = writeln!(found, "{}", cells.collect::<Vec<_>>().join(","));
    }
    found
}

fn same(_: usize, _: &str, value: &str) -> String {
    value.to_owned()
}

/// Words of an estimate from a text.
fn of_text(folder: &tempfile::TempDir, text: &str, more: &[&str]) -> Vec<String> {
    let path = folder.path().join("run.csv").display().to_string();
    fs::write(&path, text).unwrap();
    let robot = project("docs/estimation/robot.toml");
    let words = ["estimate", &robot, "--log", &path].into_iter().chain(more.iter().copied());
    words.map(str::to_owned).collect()
}

fn found(text: &str, more: &[&str]) -> serde_json::Value {
    let folder = tempfile::tempdir().unwrap();
    let words = of_text(&folder, text, more);
    json(&words.iter().map(String::as_str).collect::<Vec<_>>())
}

fn refused(text: &str, code: i32) -> String {
    let folder = tempfile::tempdir().unwrap();
    let words = of_text(&folder, text, &[]);
    let refused = run(&words.iter().map(String::as_str).collect::<Vec<_>>());
    assert_eq!(refused.status.code(), Some(code), "{}", stderr(&refused));
    stderr(&refused).to_owned()
}

fn number(value: &serde_json::Value) -> f64 {
    value.as_f64().unwrap()
}

#[test]
fn the_log_of_the_documents_gives_the_state_and_one_alarm() {
    let found = found(&log_text(), &PRIORS);
    let rows = found["rows"].as_array().unwrap();
    assert_eq!((rows.len(), &found["log_rows"]), (601, &601.into()));
    let alarms = found["alarms"].as_array().unwrap();
    assert_eq!((alarms.len(), &alarms[0]["fault"]), (1, &"payload".into()), "{alarms:?}");
    // The truth of the simulation: the payload, and the pose at 2.5 s.
    let (size, std) = (number(&alarms[0]["size"]), number(&alarms[0]["size_std"]));
    assert!((size - 18.393).abs() < 3.0 * std && std < 1.0, "{size} {std}");
    let row = rows.iter().find(|row| (number(&row["t_s"]) - 2.5).abs() < 1e-9).unwrap();
    for (k, truth) in [0.001_999_6, -0.045_448_9, 1.474_100_8].into_iter().enumerate() {
        let (value, std) = (number(&row["position_m"][k]), number(&row["position_std_m"][k]));
        assert!((value - truth).abs() < 3.0 * std && std < 1e-3, "{k}: {value} {truth} {std}");
    }
    for (k, truth) in [-0.073_183, -0.092_447, -0.002_421].into_iter().enumerate() {
        let (value, std) = (number(&row["velocity_m_s"][k]), number(&row["velocity_std_m_s"][k]));
        assert!((value - truth).abs() < 3.0 * std, "{k}: {value} {truth} {std}");
    }
    assert!(row["slack"].as_array().unwrap().iter().all(|state| state == "taut"), "{row}");
    // Rows that are asked for at larger times are some of these.
    let few = self::found(&log_text(), &[&PRIORS[..], &["--every-s", "0.5"]].concat());
    let few = few["rows"].as_array().unwrap();
    assert_eq!((few.len(), &few[1]), (13, &rows[50]));
}

#[test]
fn lengths_alone_determine_no_payload_and_tensions_only_as_its_prior() {
    let text = log_with(|name| name == "t_s" || name.starts_with("length_"), same);
    let found = found(&text, &[]);
    let told = found["not_determined"].to_string();
    assert!(told.contains("the payload is not determined by these sensors"), "{told}");
    assert!(found["fit"].as_str().unwrap().contains("nothing tests it"), "{found}");
    let last = found["rows"].as_array().unwrap().last().unwrap();
    assert!((number(&last["payload_std_kg"]) / 20.0 - 1.0).abs() < 0.01, "{last}");
    // A payload known to 20 kg leaves the tensions to about 80 N; the file has a minimum of 100 N.
    let lists = ["tensions_n", "tensions_std_n", "slack"].map(|key| last[key].as_array().unwrap());
    let mut kinds = std::collections::BTreeSet::new();
    for ((tension, std), slack) in lists[0].iter().zip(lists[1]).zip(lists[2]) {
        let (tension, std) = (number(tension), number(std));
        assert!((60.0..110.0).contains(&std), "{std}");
        let is_taut = tension - 100.0 > 1.645 * std;
        assert_eq!(slack, if is_taut { "taut" } else { "unknown" }, "{tension} {std}");
        kinds.insert(is_taut);
    }
    assert_eq!(kinds.len(), 2, "{last}");
}

#[test]
fn other_units_and_names_give_the_same_estimate() {
    let plain = found(&log_text(), &PRIORS);
    let text = log_with(
        |_| true,
        |_, name, value| match (name.starts_with("gyroscope"), value) {
            (true, value) if !value.is_empty() => value.parse::<f64>().unwrap().to_degrees().to_string(),
            _ => value.to_owned(),
        },
    );
    let text = text.replacen("_rad_s", "_deg_s", 3).replacen("length_1_m", "unstrained_length_1_m", 1);
    let text = text.replacen("tension_anchor_1_n", "tension_1_n", 1);
    let other = found(&text, &PRIORS);
    let end = |of: &serde_json::Value| number(&of["rows"].as_array().unwrap()[600]["payload_kg"]);
    assert!((end(&plain) - end(&other)).abs() < 1e-6, "{} {}", end(&plain), end(&other));
}

#[test]
fn a_slip_and_a_sensor_that_sticks_are_named() {
    // Cable 5 becomes 3 mm longer at 1 s, which its encoder does not see: its tension falls by 68 N/mm, less what the
    // others take; in the first samples the platform stays where it is.
    let slip = log_with(
        |name| !name.starts_with("acc") && !name.starts_with("gyro"),
        |row, name, value| match (row, name) {
            (100..103, "tension_anchor_5_n") => (value.parse::<f64>().unwrap() - 200.0).to_string(),
            _ => value.to_owned(),
        },
    );
    let short: String = slip.lines().take(104).fold(String::new(), |text, line| text + line + "\n");
    let found_slip = found(&short, &PRIORS);
    let alarms = found_slip["alarms"].as_array().unwrap();
    assert!(!alarms.is_empty() && alarms[0]["cable"] == "5", "{alarms:?}");
    assert!((1.0..1.03).contains(&number(&alarms[0]["t_s"])), "{alarms:?}");

    let stuck = log_with(
        |_| true,
        |row, name, value| match (row, name) {
            (100.., "tension_anchor_2_n") => "330.0".to_owned(),
            _ => value.to_owned(),
        },
    );
    let found_stuck = found(&stuck, &PRIORS);
    let alarms = found_stuck["alarms"].to_string();
    assert!(alarms.contains("the load cell of cable 2 repeats one reading"), "{alarms}");
}

#[test]
fn a_pause_of_the_log_starts_the_estimate_anew() {
    let text = log_with(
        |_| true,
        |row, name, value| match name {
            "t_s" if row >= 200 => (value.parse::<f64>().unwrap() + 30.0).to_string(),
            _ => value.to_owned(),
        },
    );
    let found = found(&text, &PRIORS);
    let alarms = found["alarms"].as_array().unwrap();
    assert_eq!(alarms[0]["fault"], "restart", "{alarms:?}");
    assert!(alarms[0]["text"].as_str().unwrap().contains("the log pauses for 30.0 s"), "{alarms:?}");
}

#[test]
fn logs_with_a_fault_are_refused_with_its_place() {
    let renamed = log_text().replacen("tension_anchor_3_n", "tension_anchro_3_n", 1);
    let told = refused(&renamed, 2);
    assert!(told.contains("did you mean `tension_anchor_3_n`?") && told.contains("a log has t_s"), "{told}");

    let falling = log_with(
        |_| true,
        |row, name, value| match (row, name) {
            (7, "t_s") => "0.05".to_owned(),
            _ => value.to_owned(),
        },
    );
    let told = refused(&falling, 2);
    assert!(told.contains("run.csv, line 9") && told.contains("0.05 s is before the row before, 0.06 s"), "{told}");
    let repeated = log_with(
        |_| true,
        |row, name, value| match (row, name) {
            (7, "t_s") => "0.06".to_owned(),
            _ => value.to_owned(),
        },
    );
    assert!(refused(&repeated, 2).contains("is also that of the row before"), "{}", refused(&repeated, 2));

    let not_a_number = log_with(
        |_| true,
        |row, name, value| match (row, name) {
            (3, "length_4_m") => "nan".to_owned(),
            _ => value.to_owned(),
        },
    );
    let told = refused(&not_a_number, 2);
    assert!(told.contains("line 5") && told.contains("`length_4_m`"), "{told}");

    let twice = log_text().replacen("tension_anchor_2_n", "tension_1_n", 1);
    assert!(refused(&twice, 2).contains("readings of one sensor"), "{}", refused(&twice, 2));
    let missing = log_with(|name| name != "length_8_m", same);
    assert!(refused(&missing, 2).contains("there is no column `length_8_m`"), "{}", refused(&missing, 2));
    let no_time = log_with(|name| name != "t_s", same);
    assert!(refused(&no_time, 2).contains("no column `t_s`"), "{}", refused(&no_time, 2));
    let millimetres = log_with(
        |_| true,
        |_, name, value| {
            let factor = if name.starts_with("length_") { 1e3 } else { return value.to_owned() };
            (factor * value.parse::<f64>().unwrap()).to_string()
        },
    );
    assert!(refused(&millimetres, 2).contains("length_NAME_mm"), "{}", refused(&millimetres, 2));
    let gravities = log_with(
        |_| true,
        |_, name, value| {
            let gravity = if name.starts_with("accelerometer_") { 9.81 } else { return value.to_owned() };
            (value.parse::<f64>().unwrap() / gravity).to_string()
        },
    );
    assert!(refused(&gravities, 2).contains("multiples of the earth's gravity"), "{}", refused(&gravities, 2));
    let empty = log_with(
        |_| true,
        |_, name, value| match name {
            "length_1_m" => String::new(),
            _ => value.to_owned(),
        },
    );
    assert!(refused(&empty, 2).contains("no row has the lengths of all cables"), "{}", refused(&empty, 2));
    assert!(refused("t_s,length_1_m\n0,9.9\n", 2).contains("there are 1 rows"));
}

/// Two cables whose columns are exchanged are a robot that does not fit.
#[test]
fn a_robot_that_does_not_fit_is_told_and_has_no_deviations() {
    let text = log_text();
    let (head, rows) = text.split_once('\n').unwrap();
    let head = head.replace("tension_anchor_1_n", "X").replace("tension_anchor_2_n", "tension_anchor_1_n");
    let head = head.replace('X', "tension_anchor_2_n").replace("length_1_m", "Y").replace("length_2_m", "length_1_m");
    let swapped = format!("{}\n{rows}", head.replace('Y', "length_2_m"));
    let folder = tempfile::tempdir().unwrap();
    let words = of_text(&folder, &swapped, &[]);
    let output = run(&words.iter().map(String::as_str).collect::<Vec<_>>());
    let told = format!("{}{}", stdout(&output), stderr(&output));
    match output.status.code() {
        Some(0) => assert!(told.contains("does not fit the robot at rest"), "{told}"),
        code => assert!(code == Some(1) && told.contains("equilibrium"), "{code:?} {told}"),
    }
}

#[test]
fn a_point_mass_on_three_cables_is_followed() {
    let robot = r#"
name = "tripod"
[platform]
mass_kg = 20.0
motion = "point-mass"
[materials.rope]
axial_stiffness_n = 2e5
mass_kg_per_m = 0.05
axial_damping_time_s = 1e-3
[[cables]]
name = "a"
material = "rope"
anchor_m = [4.0, 0.0, 5.0]
unstrained_length_m = 5.0
[[cables]]
name = "b"
material = "rope"
anchor_m = [-2.0, 3.5, 5.0]
unstrained_length_m = 5.0
[[cables]]
name = "c"
material = "rope"
anchor_m = [-2.0, -3.5, 5.0]
unstrained_length_m = 5.0
"#;
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    fs::write(path("robot.toml"), robot).unwrap();
    let rest = json(&["statics", &path("robot.toml")]);
    let tension = |i: usize| number(&rest["cables"][i]["tension_anchor_n"]);
    let row = |k: usize| format!("{},5,5,5,{},{},{}\n", 0.01 * k as f64, tension(0), tension(1), tension(2));
    let head = "t_s,length_a_m,length_b_m,length_c_m,tension_anchor_a_n,tension_anchor_b_n,tension_anchor_c_n\n";
    fs::write(path("run.csv"), (0..50).fold(head.to_owned(), |text, k| text + &row(k))).unwrap();
    let found = json(&["estimate", &path("robot.toml"), "--log", &path("run.csv")]);
    let last = found["rows"].as_array().unwrap().last().unwrap();
    for k in 0..3 {
        let off = number(&last["position_m"][k]) - number(&rest["pose"]["position_m"][k]);
        assert!(off.abs() < 1e-4, "{k}: {off}");
    }
    assert!(number(&last["payload_kg"]).abs() < 0.1 && last["rotation_std_deg"][0] == 0.0, "{last}");
}

#[test]
fn a_log_that_does_not_fit_says_so_first_and_names_the_sensor() {
    // The tracked point is 1 m above the origin; without it the tracker contradicts everything.
    let told = found(&log_text(), &PRIORS[..6]);
    let fit = told["fit"].as_str().unwrap();
    assert!(fit.starts_with("the log does not fit this robot: in ") && fit.contains("those of the tracker"), "{fit}");
    let right = found(&log_text(), &PRIORS);
    assert!(!right["fit"].as_str().unwrap().contains("does not fit"), "{right}");
}

#[test]
fn sensors_determine_what_the_table_of_the_document_says() {
    let document = fs::read_to_string(project("docs/estimation.md")).unwrap();
    let stated = |row: &str| {
        let line = document.lines().find(|line| line.starts_with(row)).unwrap().to_owned();
        line.split('±').skip(1).map(|part| part.split_whitespace().next().unwrap().to_owned()).collect::<Vec<_>>()
    };
    let at_rest = |keeps: &dyn Fn(&str) -> bool, words: &[&str]| {
        let text: Vec<String> =
            log_with(|name| name == "t_s" || keeps(name), same).lines().map(str::to_owned).collect();
        found(&(text[..3].join("\n") + "\n"), words)["rows"][0].clone()
    };
    let millimetres = |row: &serde_json::Value| format!("{:.1}", 1e3 * number(&row["position_std_m"][2]));

    let lengths = at_rest(&|name| name.starts_with("length_"), &[]);
    assert_eq!(stated("| lengths alone"), [millimetres(&lengths)]);
    let cells = at_rest(
        &|name| name.starts_with("length_") || name.starts_with("tension_"),
        &["--tension-std-n", "1", "--tension-bias-std-n", "5"],
    );
    let payload = format!("{:.1}", number(&cells["payload_std_kg"]));
    assert_eq!(stated("| and load cells"), [payload, millimetres(&cells)]);
}

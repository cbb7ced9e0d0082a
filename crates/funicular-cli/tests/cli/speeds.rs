//! `speeds`, and the quantities of maps and sweeps.

use super::{csv, json, number, robot, run, stderr, succeed};

const POSE: [&str; 2] = ["--pose", "1,1,1.5"];
const LIMITS: [&str; 6] = [
    "--set",
    "winches.drum.max_speed_m_s=3",
    "--set",
    "winches.drum.max_power_w=900",
    "--set",
    "winches.drum.gear_efficiency=0.9",
];
const BOX: [&str; 4] = ["--required-velocity-m-s", "1,1,0.5", "--required-angular-velocity-rad-s", "0.2,0.2,0.2"];

fn speeds(more: &[&str]) -> serde_json::Value {
    json(&[&["speeds", &robot("cogiro-winches.toml")], &POSE[..], more].concat())
}

#[test]
fn the_factor_of_the_required_velocities_is_where_a_winch_reaches_its_limit() {
    let found = speeds(&[&LIMITS[..], &BOX].concat());
    let factor = number(&found["required"]["speed_factor"]["value"]);
    assert_eq!(found["required"]["reached"].as_bool(), Some(factor >= 1.0));

    // A box of that size uses all of one limit.
    let times = |numbers: &str| -> String {
        numbers.split(',').map(|of| (factor * of.parse::<f64>().unwrap()).to_string()).collect::<Vec<_>>().join(",")
    };
    let scaled = [BOX[0], &times(BOX[1]), BOX[2], &times(BOX[3])];
    let at_limit = speeds(&[&LIMITS[..], &scaled].concat());
    let used = at_limit["cables"]
        .as_array()
        .unwrap()
        .iter()
        .flat_map(|cable| ["used_speed", "used_power", "used_brake_power"].map(|key| number(&cable[key])));
    let most = used.fold(0.0, f64::max);
    assert!((most - 1.0).abs() < 1e-9, "{most}");

    // Along one axis the speed times the rate is that of the winch.
    let forward = &found["directions"][0]["forward"];
    let cables = found["cables"].as_array().unwrap();
    let cable = cables.iter().find(|cable| cable["name"] == forward["cable"]).unwrap();
    let speed = number(&cable["rate_per_velocity"][0]) * number(&forward["value"]);
    let largest = if speed < 0.0 { "speed_max_in_m_s" } else { "speed_max_out_m_s" };
    assert!((speed.abs() - number(&cable[largest])).abs() < 1e-9);

    // The torque at rest is that of the tension, R T / i.
    let torque = number(&cable["tension_drum_n"]) * 0.0675 / 3.0;
    assert!((number(&cable["motor_torque_at_rest_n_m"]) - torque).abs() < 1e-9);
}

#[test]
fn the_table_of_the_file_and_the_options_mean_the_same() {
    let set =
        ["--set", "required.velocity_m_s=[1, 1, 0.5]", "--set", "required.angular_velocity_rad_s=[0.2, 0.2, 0.2]"];
    assert_eq!(speeds(&[&LIMITS[..], &set].concat()), speeds(&[&LIMITS[..], &BOX].concat()));

    // Required velocities are no loads.
    let loads = |more: &[&str]| json(&[&["loads", &robot("cogiro-winches.toml")], &POSE[..], more].concat());
    assert_eq!(loads(&set), loads(&[]));
}

#[test]
fn the_text_says_what_limits_and_what_to_give() {
    let robot = robot("cogiro-winches.toml");
    let line = [&["speeds", &robot], &POSE[..]].concat();
    let text = succeed(&[&line[..], &LIMITS, &BOX].concat());
    for words in ["speed factor", "of the winch of cable", "motors that drive", "forward", "torque at rest", "of power"]
    {
        assert!(text.contains(words), "{words}: {text}");
    }
    let text = succeed(&line);
    assert!(text.contains("give --required-velocity-m-s") && text.contains("no winch limits it"), "{text}");

    // Beyond the end of the torque–speed curve a part of the torque has no value.
    let curve = ["--set", "winches.drum.torque_speed_rad_s=[0, 20]", "--set", "winches.drum.torque_speed_n_m=[50, 50]"];
    let beyond = [&line[..], &curve, &BOX].concat();
    assert!(succeed(&beyond).contains("beyond"));
    let found = json(&beyond);
    assert!(found["cables"][0]["used_torque"].is_null() && found["required"]["reached"].as_bool() == Some(false));
    let (header, rows) = csv(&beyond);
    assert!(header.contains(&"rate_rz_m_per_rad".to_owned()) && rows.len() == 8, "{header:?}");
}

#[test]
fn check_shows_the_limits_of_winches() {
    let robot = robot("cogiro-winches.toml");
    let curve = [
        "--set",
        "winches.drum.torque_speed_rad_s=[0, 300]",
        "--set",
        "winches.drum.torque_speed_n_m=[60, 20]",
        "--set",
        "winches.drum.max_brake_power_w=400",
    ];
    let line = [&["check", &robot], &LIMITS[..], &curve].concat();
    let text = succeed(&line);
    assert!(text.contains("3 m/s, 900 W, braking 400 W, torque curve to 300 rad/s"), "{text}");
    assert!(text.contains("gear η = 0.9"), "{text}");
    let winch = &json(&line)["cables"][0]["winch"];
    assert_eq!(winch["max_speed_m_s"], 3.0);
    assert_eq!(winch["torque_speed_n_m"], serde_json::json!([60.0, 20.0]));
    assert!(json(&["check", &robot])["cables"][0]["winch"]["max_speed_m_s"].is_null());
}

#[test]
fn a_robot_with_lengths_keeps_its_tensions() {
    let found = json(&[&["speeds", &robot("cogiro-winches.toml")], &LIMITS[..], &BOX].concat());
    let rest = json(&["statics", &robot("cogiro-winches.toml")]);
    for (ours, theirs) in found["cables"].as_array().unwrap().iter().zip(rest["cables"].as_array().unwrap()) {
        assert!((number(&ours["tension_drum_n"]) - number(&theirs["drive"]["tension_drum_n"])).abs() < 1e-9);
    }
    assert!(found["tension_rule"].is_null());
}

#[test]
fn a_kink_of_the_rule_is_a_warning() {
    let output = run(&["speeds", &robot("kntu-planar.toml"), "--pose", "0,0,0"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains("the rule `lowest` has no derivatives"), "{}", stderr(&output));
}

#[test]
fn maps_have_the_measures_and_say_why_one_is_missing() {
    let robot = robot("cogiro-winches.toml");
    let grid = [
        "--grid",
        "x=1",
        "--grid",
        "y=1",
        "--grid",
        "z=1.5",
        "--quantity",
        "speed-factor,speed-max:z,speed-max:rz,motor-power,brake-power",
    ];
    let map = [&["map", &robot], &POSE[..], &grid].concat();
    let (header, rows) = csv(&[&map[..], &LIMITS, &BOX].concat());
    let value = |name: &str| rows[0][header.iter().position(|column| column == name).unwrap()].clone();
    let found = speeds(&[&LIMITS[..], &BOX].concat());
    let both = |row: &serde_json::Value| number(&row["forward"]["value"]).min(number(&row["backward"]["value"]));
    for (name, theirs) in [
        ("speed_factor", number(&found["required"]["speed_factor"]["value"])),
        ("speed_max_z_m_s", both(&found["directions"][2])),
        ("speed_max_rz_rad_s", both(&found["directions"][5])),
        ("motor_power_w", number(&found["required"]["driving_power_w"])),
        ("brake_power_w", number(&found["required"]["braking_power_w"])),
    ] {
        let ours: f64 = value(name).parse().unwrap();
        assert!((ours - theirs).abs() <= 1e-9 * theirs.abs(), "{name}: {ours} {theirs}");
    }
    assert_eq!(value("status"), "ok");

    // A planar platform does not leave its plane.
    let planar = super::robot("kntu-planar.toml");
    let grid = ["map", &planar, "--grid", "x=0", "--quantity", "speed-max:z"];
    let (header_of_planar, rows_of_planar) = csv(&grid);
    let reason = header_of_planar.iter().position(|column| column == "reason").unwrap();
    assert!(rows_of_planar[0][reason].contains("cannot make this motion"), "{rows_of_planar:?}");

    let (header, rows) = csv(&[&map[..], &LIMITS].concat());
    let status = header.iter().position(|column| column == "status").unwrap();
    assert_eq!(rows[0][status], "no-speed");
}

#[test]
fn what_has_no_speeds_is_refused_with_a_remedy() {
    let cases: [(&str, &[&str], &str); 5] = [
        ("cogiro-winches.toml", &["--required-velocity-m-s", "-1,0,0"], "required-velocity-m-s"),
        ("cogiro-winches.toml", &["--set", "required.velocity_ms=[1, 1, 1]"], "velocity_m_s"),
        ("cogiro-winches.toml", &["--set", "winches.drum.max_speed_m_s=0"], "must be positive"),
        ("grab-2-cables.toml", &[], "at least as many cables as degrees of freedom"),
        ("yuan2014-4mm.toml", &["--set", "required.angular_velocity_rad_s=1"], "three numbers"),
    ];
    for (name, arguments, words) in cases {
        let output = run(&[&["speeds", &robot(name)], arguments].concat());
        let (code, message) = (output.status.code(), stderr(&output));
        assert!(code == Some(2) && message.contains(words), "{arguments:?}: {code:?} {message}");
    }
}

//! `loads`, and the quantities of maps and sweeps.

use super::{csv, json, number, robot, run, stderr, succeed};

const POSE: [&str; 2] = ["--pose", "1,1,1.5"];
const BOX: [&str; 4] = ["--required-force-n", "150,150,150", "--required-moment-n-m", "30,30,30"];

fn loads(more: &[&str]) -> serde_json::Value {
    json(&[&["loads", &robot("cogiro.toml")], &POSE[..], more].concat())
}

#[test]
fn the_binding_load_is_held_just_below_the_load_factor_and_refused_just_above() {
    let found = loads(&BOX);
    let required = &found["required"];
    let factor = number(&required["load_factor"]);
    assert!(required["held"].as_bool() == Some(factor >= 1.0) && found["dead_load_held"].as_bool() == Some(true));
    assert!(factor <= number(&required["load_factor_upper_bound"]));
    assert!(factor >= number(&required["load_factor_lower_bound"]));

    // `statics` under multiples of the load that binds.
    let robot = robot("cogiro.toml");
    let with = |multiple: f64| {
        let vector = |key: &str| {
            let values = required[key].as_array().unwrap().iter().map(|value| (multiple * number(value)).to_string());
            values.collect::<Vec<_>>().join(",")
        };
        let load = ["--force-n", &vector("force_n"), "--moment-n-m", &vector("moment_n_m")].map(str::to_owned);
        let load: Vec<&str> = load.iter().map(String::as_str).collect();
        run(&[&["statics", &robot], &POSE[..], &load].concat()).status.code()
    };
    assert_eq!((with(0.999_99 * factor), with(1.000_01 * factor)), (Some(0), Some(1)));

    let (header, rows) = csv(&[&["loads", &robot], &POSE[..], &BOX].concat());
    assert!(header.contains(&"load_factor".to_owned()) && rows.len() == 1, "{header:?}");
    let text = succeed(&[&["loads", &robot], &POSE[..], &BOX].concat());
    assert!(text.contains("Load factor") && text.contains("binding load") && text.contains("by position"), "{text}");
}

#[test]
fn the_load_factor_has_derivatives_by_the_pose_and_by_numbers_of_the_file() {
    let factor = |x: &str, more: &[&str]| {
        let found = json(&[&["loads", &robot("cogiro.toml"), "--pose", x], &BOX[..], more].concat());
        number(&found["required"]["load_factor"])
    };
    let required = &loads(&BOX)["required"];
    let differences = [
        (&required["load_factor_by_position_per_m"][0], factor("1.001,1,1.5", &[]) - factor("0.999,1,1.5", &[]), 0.002),
        (
            &required["load_factor_by_rotation_per_rad"][2],
            factor("1,1,1.5,0,0,0.1", &[]) - factor("1,1,1.5,0,0,-0.1", &[]),
            0.2_f64.to_radians(),
        ),
    ];
    for (derivative, change, step) in differences {
        // Central differences have an error of second order in steps of a thousandth.
        assert!((number(derivative) - change / step).abs() < 1e-4 * (change / step).abs(), "{derivative} {change}");
    }

    let set = ["--set", "required.force_n=[150, 150, 150]", "--set", "required.moment_n_m=[30, 30, 30]"];
    let what = ["--of", "load-factor", "--by", "platform.mass_kg", "--hold", "pose"];
    let found = json(&[&["gradient", &robot("cogiro.toml")], &POSE[..], &set, &what].concat());
    let (result, mass) = (&found["results"][0], number(&found["parameters"][0]["value"]));
    assert!((number(&result["value"]) - number(&required["load_factor"])).abs() < 1e-12);
    let [low, high] = [-0.1, 0.1].map(|step| factor("1,1,1.5", &["--mass-kg", &format!("{}", mass + step)]));
    let (derivative, difference) = (number(&result["derivatives"][0]), (high - low) / 0.2);
    assert!((derivative - difference).abs() < 1e-5 * difference.abs(), "{derivative} {difference}");

    // Without required loads there is no load factor.
    let found = json(&[&["gradient", &robot("cogiro.toml")], &POSE[..], &what].concat());
    assert!(found["refused"][0]["reason"].as_str().unwrap().contains("[required]"), "{found}");
}

#[test]
fn the_table_of_the_file_and_the_options_mean_the_same() {
    let set = ["--set", "required.force_n=[150, 150, 150]", "--set", "required.moment_n_m=[30, 30, 30]"];
    assert_eq!(loads(&set)["required"], loads(&BOX)["required"]);
    let ball = loads(&[&BOX[..], &["--required-shape", "ellipsoid"]].concat());
    assert!(number(&ball["required"]["load_factor"]) > number(&loads(&BOX)["required"]["load_factor"]));
    assert!(loads(&[])["required"].is_null());
    assert_eq!(loads(&["--mass-kg", "4000"])["dead_load_held"].as_bool(), Some(false));
}

#[test]
fn maps_have_the_measures_and_say_why_one_is_missing() {
    let robot = robot("cogiro.toml");
    let quantities = "closure,tension-factor,load-factor,capacity-margin,acceleration-max";
    // The pose gives the orientation of the grid.
    let grid = ["--grid", "x=1", "--grid", "y=1", "--grid", "z=1.5", "--quantity", quantities];
    let map = [&["map", &robot], &POSE[..], &grid].concat();
    let (header, rows) = csv(&[&map[..], &BOX].concat());
    let value = |name: &str| rows[0][header.iter().position(|column| column == name).unwrap()].clone();
    let found = loads(&BOX);
    let same = |name: &str, other: &serde_json::Value| {
        let (ours, theirs) = (value(name).parse::<f64>().unwrap(), number(other));
        assert!((ours - theirs).abs() <= 1e-9 * theirs.abs(), "{name}: {ours} {theirs}");
    };
    same("load_factor", &found["required"]["load_factor"]);
    same("capacity_margin_n", &found["capacity_margin_n"]);
    same("acceleration_max_m_s2", &found["acceleration_max_m_s2"]);
    assert_eq!(value("closure").parse::<f64>(), Ok(0.0));
    assert_eq!(value("status"), "ok");

    let (header, rows) = csv(&map);
    let status = header.iter().position(|column| column == "status").unwrap();
    assert_eq!(rows[0][status], "required-load");
}

#[test]
fn loads_that_contradict_themselves_are_refused_with_a_remedy() {
    let cogiro = robot("cogiro.toml");
    let refused = |more: &[&str]| {
        let output = run(&[&["loads", &cogiro], &POSE[..], more].concat());
        (output.status.code(), stderr(&output).to_owned())
    };
    let cases: [(&[&str], &str); 5] = [
        (&["--required-payload-min-kg", "50", "--required-payload-max-kg", "20"], "minimum payload 50 kg is above"),
        (&["--required-force-n", "-1,0,0"], "required-force-n"),
        (&["--required-wind-speed-m-s", "500"], "at most 110 m/s"),
        (&["--set", "required.force_m=[1, 1, 1]"], "force_n"),
        (&["--set", "required.payload_min_kg=5"], "exchange the two"),
    ];
    for (arguments, words) in cases {
        let (code, message) = refused(arguments);
        assert!(code == Some(2) && message.contains(words), "{arguments:?}: {code:?} {message}");
    }
}

/// The pose alone decides on wrench closure, so that a map has it also where no tensions hold the dead load.
#[test]
fn closure_is_known_where_the_dead_load_is_not_held() {
    let (header, rows) = csv(&[
        "map",
        &robot("ipanema2.toml"),
        "--grid",
        "x=-9:9:3",
        "--grid",
        "y=0",
        "--grid",
        "z=1",
        "--quantity",
        "load-factor,closure,tension-factor",
        "--required-force-n",
        "10,10,10",
    ]);
    let at = |name: &str| header.iter().position(|column| column == name).unwrap();
    let [feasible, closure, factor] = ["feasible", "closure", "tension_factor"].map(at);
    let value = |row: usize, column: usize| rows[row][column].as_str();
    assert_eq!([0, 1, 2].map(|row| value(row, feasible)), ["false", "true", "false"]);
    assert_eq!([0, 1, 2].map(|row| value(row, closure)), ["0.0", "1.0", "0.0"]);
    assert!([0, 2].iter().all(|row| value(*row, factor) == "0.0" && value(*row, at("load_factor")).is_empty()));
}

/// The weight of a payload is at right angles to the plane of a level planar robot, which does not feel it.
#[test]
fn a_payload_that_a_planar_robot_does_not_feel_is_held_without_limit() {
    let arguments = ["loads", &robot("kntu-planar.toml"), "--required-payload-max-kg", "5"];
    let found = json(&arguments);
    assert!(found["required"]["held"].as_bool() == Some(true) && found["required"]["load_factor"].is_null(), "{found}");
    assert!(succeed(&arguments).contains("motions that the platform does not have"));
}

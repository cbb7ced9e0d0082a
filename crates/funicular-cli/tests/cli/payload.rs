//! `payload`, and the quantity of maps and sweeps.

use super::{close, csv, json, number, numbers, robot, run, stderr, succeed};

const POSE: [&str; 2] = ["--pose", "1,2,1.5"];

fn payload(more: &[&str]) -> serde_json::Value {
    json(&[&["payload", &robot("cogiro.toml")], &POSE[..], more].concat())
}

#[test]
fn the_maximum_payload_is_held_and_a_larger_one_is_not() {
    let found = payload(&["--payload-center-m", "0,0,-0.3"]);
    assert_eq!(number(&found["minimum"]["payload_kg"]), 0.0);
    let maximum = number(&found["maximum"]["payload_kg"]);
    let excluded = number(&found["maximum"]["excluded_from_kg"]);
    assert!(maximum > 300.0 && excluded > maximum && excluded < 1.001 * maximum, "{maximum} {excluded}");

    // The payload as a force at its centre, in another command.
    let robot = robot("cogiro.toml");
    let with = |mass: f64| {
        let force = format!("0,0,{}", -9.81 * mass);
        let load = ["--force-n", &force, "--load-point-m", "0,0,-0.3"];
        run(&[&["statics", &robot], &POSE[..], &load].concat()).status.code()
    };
    assert_eq!((with(0.9999 * maximum), with(1.0001 * maximum)), (Some(0), Some(1)));

    let cables = found["maximum"]["cables"].as_array().unwrap();
    let places: Vec<&str> = cables.iter().filter_map(|cable| cable["limit_place"].as_str()).collect();
    assert!(!places.is_empty() && places.len() < cables.len() && places.contains(&"anchor"), "{places:?}");
    for cable in cables {
        let reached = cable["limit_reached"].is_string();
        assert_eq!(reached, cable["limit_place"].is_string(), "{cable}");
        assert_eq!(reached, number(&cable["tension_margin_n"]).abs() < 1e-2, "{cable}");
    }
}

#[test]
fn limits_of_the_command_line_and_the_need_of_a_payload_are_told() {
    let lower = number(&payload(&["--max-tension-n", "2000"])["maximum"]["payload_kg"]);
    let higher = number(&payload(&[])["maximum"]["payload_kg"]);
    assert!(0.0 < lower && lower < 0.5 * higher, "{lower} {higher}");

    let needed = payload(&["--min-tension-n", "500", "--mass-kg", "20"]);
    let (least, most) = (number(&needed["minimum"]["payload_kg"]), number(&needed["maximum"]["payload_kg"]));
    assert!(0.0 < least && least < most, "{least} {most}");
    let text = succeed(
        &[&["payload", &robot("cogiro.toml")], &POSE[..], &["--min-tension-n", "500", "--mass-kg", "20"]].concat(),
    );
    assert!(text.contains("with less a cable is below its minimum tension"), "{text}");
    let (header, rows) = csv(&[&["payload", &robot("cogiro.toml")], &POSE[..]].concat());
    assert_eq!((header[0].as_str(), rows.len()), ("bound", 8));
}

#[test]
fn no_payload_is_no_solution_with_a_reason() {
    let cogiro = robot("cogiro.toml");
    let refused = |more: &[&str]| {
        let output = run(&[&["payload", &cogiro], more].concat());
        (output.status.code(), stderr(&output).to_owned())
    };
    let (code, text) = refused(&["--pose", "1,2,1.5", "--mass-kg", "20000"]);
    assert!(code == Some(1) && text.contains("is too heavy for this pose by"), "{text}");
    let (code, text) = refused(&["--pose", "100,2,1.5"]);
    assert!(code == Some(1) && text.contains("no tensions hold this pose"), "{text}");
    let (code, text) = refused(&["--pose", "1,2,1.5", "--payload-center-m", "0,0"]);
    assert!(code == Some(2) && text.contains("x,y,z"), "{text}");
    let (code, text) = refused(&["--pose", "1,2,1.5", "--set", "gravity_m_s2=[0,0,0]"]);
    assert!(code == Some(2) && text.contains("no gravity"), "{text}");

    let text = succeed(&["payload", "ROBOT", "--pose", "0,0,0.5"]);
    assert!(text.contains("unlimited") && text.contains("--max-tension-n"), "{text}");
}

/// Oracle of the column: the command at the same pose.
#[test]
fn a_map_has_the_payload_of_each_pose() {
    let cogiro = robot("cogiro.toml");
    let quantities = ["--quantity", "payload-max,tension-max,tensions,tension-max-cable"];
    let grid = ["--grid", "x=-1:1:3", "--grid", "y=2", "--grid", "z=1.5", "--payload-center-m", "0,0,-0.3"];
    let (header, rows) = csv(&[&["map", &cogiro], &POSE[..], &grid, &quantities].concat());
    let at = |name: &str| header.iter().position(|column| column == name).unwrap_or_else(|| panic!("{name}"));
    let expected = number(&payload(&["--payload-center-m", "0,0,-0.3"])["maximum"]["payload_kg"]);
    let found: f64 = rows[2][at("payload_max_kg")].parse().unwrap();
    assert!(close(found, expected, 1e-6 * expected), "{found} {expected}");
    assert!(rows[2][at("payload_limits")].contains("maximum at anchor"), "{rows:?}");

    // The cable with the maximum tension: the anchors are above, so it has the maximum at its platform end too.
    let tension = |name: &str| rows[2][at(&format!("tension_platform_{name}_n"))].parse::<f64>().unwrap();
    let tightest = &rows[2][at("tension_max_cable")];
    assert!((1..=8).all(|i| tension(&i.to_string()) <= tension(tightest) + 3.0), "{tightest}");

    let (header, rows) =
        csv(&["map", "ROBOT", "--grid", "x=0", "--grid", "y=0", "--grid", "z=0.5", "--quantity", "payload-max"]);
    assert_eq!(rows[0][header.iter().position(|column| column == "status").unwrap()], "unlimited");
    let camera = robot("stadium-camera.toml");
    let output = run(&["map", &camera, "--grid", "x=0", "--grid", "y=0", "--grid", "z=5", "--quantity", "payload-max"]);
    // Four cables for three degrees of freedom hold poses.
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[test]
fn held_lengths_move_the_platform_of_every_command() {
    let cogiro = robot("cogiro.toml");
    let hold = ["--pose", "1,2,1.5", "--hold-lengths-of-pose", "--tension-rule", "middle"];
    let statics = |more: &[&str]| json(&[&["statics", &cogiro], &hold[..], more].concat());

    // Without a change the platform stays, and the lengths are those of the pose.
    let still = statics(&[]);
    assert!(number(&still["held"]["distance_m"]) < 1e-9);
    let pose = json(&["statics", &cogiro, "--pose", "1,2,1.5", "--tension-rule", "middle"]);
    let lengths = |of: &serde_json::Value| -> Vec<f64> {
        of["cables"].as_array().unwrap().iter().map(|cable| number(&cable["unstrained_length_m"])).collect()
    };
    let held = lengths(&pose);
    for more in [&["--mass-kg", "250"][..], &["--set", "platform.mass_kg=250"], &["--force-n", "50,0,-900"]] {
        let moved = statics(more);
        assert_eq!(lengths(&moved), held, "{more:?}");
        assert_eq!(moved["tension_rule"], "middle");
        let by = numbers(&moved["held"]["translation_m"]);
        assert!(by[2] < -1e-4 && number(&moved["held"]["distance_m"]) < 0.1, "{more:?}: {by:?}");

        // The long way round: the lengths copied to another call.
        let copied = held.iter().map(|length| format!("{length:?}")).collect::<Vec<_>>().join(",");
        let by_hand = json(&[&["statics", &cogiro, "--lengths-m", &copied], more].concat());
        let (one, other) = (numbers(&moved["pose"]["position_m"]), numbers(&by_hand["pose"]["position_m"]));
        assert!(one.iter().zip(&other).all(|(one, other)| close(*one, *other, 1e-9)), "{one:?} {other:?}");
    }

    // A sweep has the poses of the single commands, and so has a map.
    let rows =
        csv(&[&["sweep", &cogiro, "--vary", "platform.mass_kg=160,250", "--quantity", "pose"], &hold[..]].concat());
    let z = rows.0.iter().position(|column| column == "pose_z_m").unwrap();
    let expected = numbers(&statics(&["--mass-kg", "250"])["pose"]["position_m"])[2];
    assert_eq!(rows.1[1][z].parse::<f64>().unwrap(), expected);
    let grid = ["--grid", "x=1", "--grid", "y=2", "--grid", "z=1.5", "--mass-kg", "250", "--quantity", "pose"];
    let rows = csv(&[&["map", &cogiro], &hold[..], &grid].concat());
    let z = rows.0.iter().position(|column| column == "pose_z_m").unwrap();
    assert_eq!(rows.1[0][z].parse::<f64>().unwrap(), expected);

    // Masses of `pose-error` at the lengths of a pose: the catenary pose moves as the equilibrium does.
    let error =
        json(&["pose-error", &cogiro, "--pose", "1,2,1.5", "--tension-rule", "middle", "--mass-kg", "160:250:2"]);
    assert_eq!(numbers(&error["unstrained_length_m"]), held);
    assert_eq!(error["held"]["tension_rule"], "middle");

    for (arguments, says) in [
        (&["statics", "ROBOT", "--hold-lengths-of-pose"][..], "needs a pose: give --pose"),
        (&["statics", "ROBOT", "--hold-lengths-of-pose", "--lengths-m", "1,2,3,4,5,6"], "cannot be used with"),
        (&["sweep", "ROBOT", "--hold-lengths-of-pose", "--vary", "platform.mass_kg=1,2"], "needs a pose: give --pose"),
        (&["pose-error", "ROBOT", "--tension-rule", "lowest", "--mass-kg", "10:20:2"], "nothing to choose"),
    ] {
        let output = run(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(says), "{}", stderr(&output));
    }
}

/// Every command that finds an equilibrium takes the rule and says which one it has used.
#[test]
fn the_tension_rule_reaches_every_command() {
    let cogiro = robot("cogiro.toml");
    let range = ["--from-hz", "1", "--to-hz", "5", "--points", "5"];
    let commands: [&[&str]; 6] = [
        &["stiffness"],
        &["modes", "--below-hz", "4"],
        &["frf", "--input", "fz", "--output", "az", "--from-hz", "1", "--to-hz", "5", "--points", "5"],
        &["compare", "--below-hz", "4"],
        &["cable", "--name", "3", range[0], range[1], range[2], range[3], range[4], range[5]],
        &["reduce", "--below-hz", "4", "--input", "fz", "--output", "z"],
    ];
    for command in commands {
        let with = |rule: &[&str]| {
            let mut line = vec![command[0], &cogiro, "--pose", "1,2,1.5"];
            line.extend(&command[1..]);
            line.extend(rule);
            (json(&line), succeed(&line))
        };
        let (found, text) = with(&["--tension-rule", "middle"]);
        assert_eq!(found["tension_rule"], "middle", "{command:?}");
        assert!(text.contains("tensions by the rule `middle`") || command[0] == "reduce", "{text}");
        let (closest, _) = with(&["--target-tension-n", "900", "--max-tension-n", "4000"]);
        assert_eq!(closest["tension_rule"], "closest", "{command:?}");
        let (lowest, _) = with(&[]);
        assert_eq!(lowest["tension_rule"], "lowest", "{command:?}");
        assert!(found != lowest && closest != lowest, "{command:?}");
    }
}

//! Goals without derivatives of their own against the commands that tell their values, choices that are not numbers,
//! and remedies for poses that are not held.

use super::*;
use funicular_study::wording::Words;

/// CoGiRo with required loads and velocities.
fn required() -> String {
    let required = "[required]\nforce_n = [200, 200, 100]\nvelocity_m_s = [1, 1, 0.5]\n";
    format!("{}\n{required}", funicular_robots::COGIRO)
}

/// Result of a command as JSON.
fn answer(command: &str, text: &str, more: &Value) -> Result<Value, Error> {
    let mut request = json!({"command": command, "robot": {"text": text}});
    for (key, value) in more.as_object().unwrap() {
        request[key] = value.clone();
    }
    let found = run(&Request::from_json(&request.to_string()).unwrap(), &mut Silent)?;
    Ok(serde_json::from_slice(&found.to_json(Words::Json)?).unwrap())
}

/// Design of CoGiRo with required loads, by the rule `lowest`.
fn design_of(more: &Value) -> Result<Designed, Error> {
    let mut request = json!({"robot": {"text": required()}, "target_tension_n": null, "pose": [1.0, 2.0, 1.5]});
    for (key, value) in more.as_object().unwrap() {
        request[key] = value.clone();
    }
    designed(&request)
}

fn anchors_and_attachments() -> Value {
    json!([
        {"path": "cables.*.anchor_m.z", "plus_minus": 0.3},
        {"path": "cables.*.attachment_m", "plus_minus": 0.05},
    ])
}

#[test]
fn goals_of_winches_and_clearance_are_what_their_commands_tell() {
    for goal in ["winch-power", "winch-tension", "winch-speed"] {
        let found = design_of(&json!({"goal": goal, "change": anchors_and_attachments()})).unwrap();
        // A speed follows the direction of the rope alone, which bounds of 30 cm turn by little.
        let gain = if goal == "winch-speed" { 0.001 } else { 0.01 };
        assert!(found.after < (1.0 - gain) * found.before, "{goal}: {} {}", found.before, found.after);
        for (text, value) in [(required(), found.before), (found.robot_file.clone(), found.after)] {
            let winches = answer("winches", &text, &json!({"pose": [1.0, 2.0, 1.5]})).unwrap();
            let asked = winches["asked"].as_array().unwrap();
            let told = asked.iter().find(|row| goal.ends_with(row["quantity"].as_str().unwrap())).unwrap();
            // Both are the same function of the same file.
            assert!((told["value"].as_f64().unwrap() / value - 1.0).abs() < 1e-9, "{goal}: {told} {value}");
        }
    }

    let found = design_of(&json!({"goal": "clearance", "change": anchors_and_attachments()})).unwrap();
    assert!(found.after > 1.05 * found.before, "{} {}", found.before, found.after);
    let least = answer("clearance", &found.robot_file, &json!({"pose": [1.0, 2.0, 1.5]})).unwrap();
    let margin = least["pairs"][0]["distance_m"].as_f64().unwrap() - least["pairs"][0]["required_m"].as_f64().unwrap();
    assert!((margin - found.after).abs() < 1e-9, "{margin} {}", found.after);
}

#[test]
fn the_workspace_grows_by_the_poses_that_loads_holds() {
    let grid = json!([
        {"axis": "x", "values": [-5.0, 0.0, 5.0]},
        {"axis": "y", "values": [-3.0, 0.0, 3.0]},
        {"axis": "z", "values": [1.0, 3.0]},
    ]);
    let change = json!([{"path": "cables.*.anchor_m.z", "plus_minus": 0.5}]);
    let found = design_of(&json!({"pose": null, "grid": grid, "goal": "workspace", "change": change})).unwrap();
    assert!(found.after > found.before, "{} {}", found.before, found.after);

    // The load factor of every pose is that of `loads`; a pose that is not held has none.
    let mut held = 0;
    for pose in &found.poses {
        let [x, y, z] = pose.position_m;
        let told = answer("loads", &found.robot_file, &json!({"pose": [x, y, z]}));
        let factor = told.ok().and_then(|told| told["required"]["load_factor"].as_f64()).unwrap_or(0.0);
        assert!((factor - pose.after).abs() < 1e-9 * (1.0 + factor), "{factor} {}", pose.after);
        held += usize::from(factor >= 1.0);
    }
    let sentence = found.limits.iter().find(|sentence| sentence.starts_with("Of 18 poses")).unwrap();
    assert!(sentence.contains(&format!("and {held} with the chosen ones")), "{sentence} {held}");

    let refusal = designed(&json!({"pose": [1.0, 2.0, 1.5], "target_tension_n": null, "goal": "workspace",
        "change": [{"path": "cables.*.anchor_m.z", "plus_minus": 0.5}]}));
    assert!(refusal.err().unwrap().to_string().contains("[required]"));
}

#[test]
fn limits_of_tensions_are_values_of_a_design() {
    let change = json!([{"path": "materials.*.minimum_tension_n", "minimum": 10.0, "maximum": 150.0}]);
    let found = design_of(&json!({"goal": "load-factor", "change": change})).unwrap();
    assert!((found.values[0].value - 10.0).abs() < 1e-9 && found.after > 1.2 * found.before, "{}", found.after);

    // The gain per unit of more room is that of a file with 1 N less.
    let with = |minimum: f64| {
        let text = required().replace("minimum_tension_n = 100", &format!("minimum_tension_n = {minimum}"));
        load_factor(&text, [1.0, 2.0, 1.5])
    };
    let gain = with(9.9) - with(10.0);
    assert!(
        (10.0 * gain / found.values[0].gain_per_unit - 1.0).abs() < 1e-3,
        "{gain} {}",
        found.values[0].gain_per_unit
    );

    // Frequencies have no derivatives by limits, and say so.
    let change = json!([{"path": "materials.*.minimum_tension_n", "plus_minus": 5.0}]);
    let error = design_of(&json!({"change": change})).err().unwrap().to_string();
    assert!(error.contains("minimum_tension_n") && error.contains("load-factor"), "{error}");
}

#[test]
fn ropes_and_connections_are_chosen_by_the_goal() {
    let change = json!([{"path": "cables.*.anchor_m.z", "plus_minus": 0.3}]);
    let ropes = json!([
        {"name": "thin", "axial_stiffness_n": 3e5, "mass_kg_per_m": 0.05, "maximum_tension_n": 400.0},
        {
            "name": "strong", "axial_stiffness_n": 9e5, "mass_kg_per_m": 0.1, "diameter_m": 0.006,
            "maximum_tension_n": 6000.0,
        },
        {"name": "weak", "axial_stiffness_n": 9e5, "mass_kg_per_m": 0.1, "maximum_tension_n": 120.0},
    ]);
    let found = design_of(&json!({"goal": "load-factor", "change": change, "ropes": ropes})).unwrap();
    let of = |name: &str| found.ropes.iter().find(|row| row.name == name).unwrap();
    assert!(of("strong").chosen && of("strong").after == Some(found.after));
    assert!(of("thin").after.is_none_or(|after| after < found.after) && of("weak").reason.is_some());
    assert!(found.robot_file.contains("maximum_tension_n = 6000") && found.robot_file.contains("diameter_m = 0.006"));

    let exchanged = design_of(&json!({"goal": "load-factor", "change": change, "reconnect": true})).unwrap();
    let alone = design_of(&json!({"goal": "load-factor", "change": change})).unwrap();
    assert!(exchanged.after > alone.after && !exchanged.exchanges.is_empty(), "{} {}", exchanged.after, alone.after);
    assert!((load_factor(&exchanged.robot_file, [1.0, 2.0, 1.5]) / exchanged.after - 1.0).abs() < 1e-9);
}

#[test]
fn a_pose_that_is_not_held_comes_with_what_would_cure_it() {
    let change = json!([{"path": "cables.*.anchor_m.z", "plus_minus": 0.3}]);
    let pose = json!([7.0, 2.0, 2.0]);
    let request = json!({"robot": cogiro(), "target_tension_n": null, "pose": pose, "change": change});
    let error = designed(&request).err().unwrap();
    assert_eq!(error.kind(), ErrorKind::NoSolution);
    let text = error.to_string();
    let (_, cure) = text.split_once("minimum tension of all cables ").unwrap();
    let minimum: f64 = cure.split(' ').next().unwrap().parse().unwrap();

    // With this minimum the pose is held, with 0.2 N more, twice the accuracy of a remedy, it is not.
    let holds = |minimum: f64| {
        let robot =
            funicular_robots::COGIRO.replace("minimum_tension_n = 100", &format!("minimum_tension_n = {minimum}"));
        answer("statics", &robot, &json!({"pose": pose})).is_ok()
    };
    assert!(holds(minimum - 0.005) && !holds(minimum + 0.2), "{minimum}: {text}");
}

//! `new` and `schema`: files with which a user begins, and numbers of vectors by their paths.

use super::{command, json, json_of, number, project, run, run_with, stderr, stdout, succeed};

/// Text of a new robot file.
fn new(arguments: &[&str]) -> String {
    succeed(&[&["new"], arguments].concat())
}

#[test]
fn every_command_runs_on_a_new_robot_at_once() {
    let table = project("docs/robot-file.csv");
    for arguments in [
        &[][..],
        &["--cables", "6", "--name", "rig", "--mass-kg", "20", "--box-m", "0.4,0.3,0.2"],
        &["--motion", "planar-xz"],
        &["--motion", "planar", "--cables", "3"],
        &["--motion", "planar-xy"],
        &["--motion", "planar-xy", "--cables", "7", "--box-m", "0.3,0.2,0.1"],
        &["--motion", "point-mass", "--rope", "7x7"],
        &["--rope", "hmpe", "--diameter-m", "0.006"],
        &["--from-csv", &table, "--csv-unit", "mm", "--mass-kg", "60"],
    ] {
        let text = new(arguments);
        for line in [&["check", "-"][..], &["statics", "-"], &["modes", "-", "--below-hz", "5"], &["parameters", "-"]] {
            let output = run_with(line, &text);
            assert_eq!(output.status.code(), Some(0), "{arguments:?} {line:?}: {}", stderr(&output));
            // A guide carries a platform that lies in its plane, which is said.
            let is_told = |line: &&str| !(arguments.contains(&"planar-xy") && line.contains("the guide carries it"));
            let told: Vec<&str> = stderr(&output).lines().filter(is_told).collect();
            assert!(told.is_empty(), "{arguments:?} {line:?}: {told:?}");
        }
        assert_eq!(json_of(&["statics", "-"], &text)["stable"], true, "{arguments:?}");
    }
}

#[test]
fn a_new_file_is_never_written_over_another_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("robot.toml");
    let path = path.to_str().unwrap();
    let output = run(&["new", "-o", path]);
    let pose = "start pose: position (0.000, 0.000, 2.400) m, roll, pitch, yaw (0.00, 0.00, 0.00)°";
    assert_eq!(stderr(&output).trim(), format!("wrote {path}\n{pose}"));
    let written = std::fs::read_to_string(path).unwrap();
    assert_eq!(written, new(&[]));

    let again = run(&["new", "--cables", "4", "-o", path]);
    assert_eq!(again.status.code(), Some(2));
    assert!(stderr(&again).contains("exists and may hold your own numbers"), "{}", stderr(&again));
    assert_eq!(std::fs::read_to_string(path).unwrap(), written);
    let wrong = run(&["new", "-o", "robot.json"]);
    assert_eq!(wrong.status.code(), Some(2), "{}", stderr(&wrong));
}

#[test]
fn mistakes_in_the_options_of_new_say_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("points.csv");
    std::fs::write(&path, "1,4,4,6,1,1,0\n2,-4,4,6,-1,x,0\n").unwrap();
    let path = path.to_str().unwrap();
    for (arguments, says) in [
        (&["--cables", "1"][..], "--cables 1: one cable does not keep"),
        (&["--cables", "0"], "give 2 to 64 cables"),
        (&["--cables", "many"], "invalid value 'many'"),
        (&["--motion", "planar-xyz"], "a similar value exists: 'planar-xy'"),
        (&["--box-m", "1,2"], "2 numbers where x,y,z are needed"),
        (&["--axial-stiffness-n", "1e6"], "give --mass-kg-per-m"),
        (&["--csv-unit", "mm"], "--csv-unit is the unit of the table of --from-csv"),
        (&["--from-csv", "none.csv"], "cannot read none.csv"),
        (&["--from-csv", path], "points.csv, line 2, attachment y: `x` is not a number"),
    ] {
        let output = run(&[&["new"], arguments].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(says), "{arguments:?}: {}", stderr(&output));
        assert!(stdout(&output).is_empty());
    }
    // A robot that hangs nowhere is written with a warning.
    let output = run(&["new", "--pose", "0,0,9"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(stderr(&output).contains("give another --pose"), "{}", stderr(&output));
}

#[test]
fn the_schema_is_json_with_the_keys_of_the_file() {
    let schema: serde_json::Value = serde_json::from_str(&succeed(&["schema"])).unwrap();
    assert_eq!(schema["$schema"], "http://json-schema.org/draft-07/schema#");
    assert_eq!(schema["required"], serde_json::json!(["name", "platform", "materials", "cables"]));
    let highest = &schema["properties"]["wind"]["properties"]["velocity_m_s"]["items"]["maximum"];
    assert_eq!(highest.as_f64(), Some(110.0));
}

#[test]
fn one_number_of_a_vector_is_set_varied_and_listed() {
    let text = new(&[]);
    let statics = |set: &str| json_of(&["statics", "-", "--set", set], &text);
    // The table [loads] has only comments, and the index is another name of z.
    let loaded = statics("loads.force_n.2=-50");
    assert_eq!(loaded, statics("loads.force_n.z=-50"));
    assert_eq!(loaded, statics("loads.force_n=[0, 0, -50]"));
    assert_eq!(loaded["load"]["force_n"][2].as_f64(), Some(-50.0));

    let listed = json_of(&["parameters", "-", "--set", "state.position_m.2=2.2"], &text);
    let value = |path: &str| {
        let rows = listed["parameters"].as_array().unwrap();
        rows.iter().find(|row| row["path"] == path).map(|row| (number(&row["value"]), row["given"].clone()))
    };
    assert_eq!(value("state.position_m.z"), Some((2.2, true.into())));
    // Names in words, for a page or a table.
    for (path, label) in [
        ("platform.mass_kg", "mass of the platform [kg]"),
        ("materials.rope.damping_ratio", "damping ratio of moving the rope (rope)"),
        ("cables.3.anchor_m.z", "exit point of the cable (3), z [m]"),
        ("state.position_m.x", "origin of the platform frame in the world frame, x [m]"),
    ] {
        let rows = listed["parameters"].as_array().unwrap();
        assert_eq!(rows.iter().find(|row| row["path"] == path).unwrap()["label"], label);
    }
    // Tables that a file lacks are listed with their defaults.
    let plain = json(&["parameters", "ROBOT"]);
    let paths: Vec<&str> =
        plain["parameters"].as_array().unwrap().iter().filter_map(|row| row["path"].as_str()).collect();
    assert!(paths.contains(&"loads.force_n.z") && paths.contains(&"wind.velocity_m_s.x"), "{paths:?}");

    let output = command(&[
        "sweep",
        "ROBOT",
        "--pose",
        "0,0,0.5",
        "--vary",
        "cables.1.anchor_m.2=2.9,3",
        "--vary",
        "wind.velocity_m_s.0=0,5",
        "--quantity",
        "tension-max",
        "--format",
        "csv",
    ]);
    let output = { output }.output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stdout(&output).starts_with("cables.1.anchor_m.2,wind.velocity_m_s.0,"), "{}", stdout(&output));

    for (set, says) in [
        ("loads.force_n.3=1", "`loads.force_n` has the numbers x, y and z, or 0, 1 and 2, and no `3`"),
        ("platform.inertia_kg_m2.0.3=1", "xx, yy, zz, xy, xz and yz, or 0, 1 and 2 for principal moments"),
        ("platform.inertia_kg_m2.0.1=1", "has only the principal moments"),
        ("platform.mass_kg.0=1", "`platform.mass_kg` is a value and has no keys"),
        ("loads.force_n.2=x", "text"),
    ] {
        let output = run_with(&["statics", "-", "--set", set], &text);
        assert_eq!(output.status.code(), Some(2), "{set}");
        assert!(stderr(&output).contains(says), "{set}: {}", stderr(&output));
    }
}

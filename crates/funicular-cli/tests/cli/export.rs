//! Tests of `export`: files for other programs. scripts/cross-check runs these programs on the files.

use super::{robot, run, run_with, stderr, stdout, succeed, yuan};

/// Position of the robot in a file with lengths.
fn position(text: &str) -> Vec<f64> {
    let output = run_with(&["statics", "-", "--format", "json"], text);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let found: serde_json::Value = serde_json::from_str(stdout(&output)).unwrap();
    found["pose"]["position_m"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

#[test]
fn a_robot_exported_to_moordyn_and_imported_again_has_the_same_equilibrium() {
    // CoGiRo's lengths have several equilibria; the platform's frame decides which one is found.
    for name in ["yuan2014-4mm.toml", "cogiro.toml", "sap2000-8-cable-point-mass.toml", "nist-robocrane.toml"] {
        let directory = tempfile::tempdir().unwrap();
        let input = directory.path().join("robot.txt");
        let path = input.to_str().unwrap();
        // With 400 segments the lengths of lines and cables agree to a tenth of a micrometre.
        succeed(&["export", &robot(name), "--to", "moordyn", "--segments", "400", "-o", path]);
        let imported = succeed(&["import", path]);
        let ours = position(&std::fs::read_to_string(robot(name)).unwrap());
        let theirs = position(&imported);
        for (a, b) in ours.iter().zip(&theirs) {
            assert!((a - b).abs() < 1e-6, "{name}: {ours:?} {theirs:?}");
        }
    }
}

/// Script for MoorDyn of the robot with a payload, to which a scenario happens.
fn moving(scenario: &str, options: &[&str]) -> std::process::Output {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("scenario.toml");
    std::fs::write(&path, scenario).unwrap();
    let of = ["export", "ROBOT", "--to", "moordyn", "--mass-kg", "12.5", "--scenario", path.to_str().unwrap()];
    run(&[&of[..], options].concat())
}

/// Value of a line `KEY = VALUE` of a script.
fn value_of<'a>(script: &'a str, key: &str) -> &'a str {
    script.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix(" = ")).unwrap_or_else(|| panic!("{key}"))
}

#[test]
fn a_script_for_moordyn_has_the_mass_after_a_release_and_the_place_before() {
    let release = "[[release]]\nat_s = 0.5\nmass_kg = 1.95\n";
    let script = moving(release, &["--for", "2", "--segments", "5"]);
    assert_eq!(script.status.code(), Some(0), "{}", stderr(&script));
    let script = stdout(&script);
    assert_eq!(["START_S", "END_S", "ROW_S", "MOVED"].map(|key| value_of(script, key)), ["0.5", "2", "0.002", "[]"]);
    let before = succeed(&["export", "ROBOT", "--to", "moordyn", "--mass-kg", "12.5", "--segments", "5"]);
    let body = before.lines().find(|line| line.contains("  free  ")).unwrap();
    assert!(body.contains("  12.5  0|0|0  "), "{before}");
    assert!(script.contains(&body.replace("  12.5  0|0|0  ", "  10.55  0|0|0  ")), "{script}");
    for line in before.lines().filter(|line| line.contains("rope-4mm_")) {
        assert!(script.contains(line), "the lines are those before the release: {line}");
    }
}

#[test]
fn a_script_for_moordyn_has_the_lengths_of_the_winches_until_they_stand() {
    let scenario = "[[lengths]]\nat_s = 0.5\nduration_s = 1.0\nchange_m = { 2 = -0.1 }\n\
                    [[stop]]\nat_s = 1.0\nduration_s = 0.5\n";
    let script = moving(scenario, &["--segments", "5"]);
    assert_eq!(script.status.code(), Some(0), "{}", stderr(&script));
    let script = stdout(&script);
    assert_eq!(["START_S", "END_S", "MOVED"].map(|key| value_of(script, key)), ["0", "10", "[2]"]);
    let rows: Vec<(f64, [f64; 1], [f64; 1])> = (script.lines().skip_while(|line| *line != "COMMANDS = ["))
        .skip(1)
        .take_while(|line| *line != "]")
        .map(|line| serde_json::from_str(line.trim().trim_end_matches(',')).unwrap())
        .collect();
    assert_eq!((rows[0], rows[rows.len() - 1].0), ((0.5, [0.0], [0.0]), 1.5));
    // Half of the change, at the largest rate, when the brake begins; half of what follows at that rate when it ends.
    let (_, [change], [rate]) = rows.iter().find(|(time, ..)| (time - 1.0).abs() < 1e-9).unwrap();
    assert!((change + 0.05).abs() < 1e-12 && (rate + 0.1875).abs() < 1e-12, "{change} {rate}");
    let (_, [change], [rate]) = rows[rows.len() - 1];
    assert!((change + 0.05 + 0.5 * 0.5 * 0.1875).abs() < 1e-12 && rate == 0.0, "{change} {rate}");
}

#[test]
fn a_script_for_moordyn_breaks_lines_in_their_order() {
    let scenario = "[[cut]]\ncable = \"4\"\nat_s = 0.3\n[[cut]]\ncable = \"1\"\nat_s = 0.2\n";
    let script = moving(scenario, &["--segments", "5"]);
    assert_eq!(script.status.code(), Some(0), "{}", stderr(&script));
    // The first six points are the anchors of the six cables.
    assert_eq!(value_of(stdout(&script), "CUTS"), "[[0.2,1,7],[0.3,4,10]]");
}

#[test]
fn events_that_moordyn_cannot_hold_are_refused_by_their_names() {
    let release = "[[release]]\nat_s = 0.5\nmass_kg = 1.0\n";
    let lengths = "[[lengths]]\nat_s = 0.1\nduration_s = 1.0\nchange_m = { 2 = -0.1 }\n";
    let cut = "[[cut]]\ncable = \"1\"\nat_s = 0.2\n";
    let [tension, push] = [
        "[[tension]]\nat_s = 0.5\nduration_s = 1.0\ntension_n = { 1 = 9.0 }\n",
        "[[push]]\nat_s = 0.5\nduration_s = 1.0\nforce_n = [1.0, 0.0, 0.0]\n",
    ];
    for (scenario, says) in [
        (release.replace("release", "pick"), "[[pick]] of --scenario: a body of MoorDyn keeps the mass"),
        (tension.to_owned(), "[[tension]] of --scenario: a line of MoorDyn has a length"),
        (push.to_owned(), "[[push]] of --scenario: MoorDyn has no forces on a body"),
        ("[[cut]]\ncable = \"1\"\nat_s = 0.1\nplace_m = 2.0\n".to_owned(), "place_m"),
        (
            "[[cut]]\ncable = \"1\"\nat_tension_n = 900.0\n".to_owned(),
            "[[cut]] of --scenario: a line of MoorDyn breaks when the script says so",
        ),
        (release.to_owned() + &release.replace("0.5", "0.6"), "[[release]] number 2 of --scenario is at another time"),
        (release.to_owned() + lengths, "[[release]] of --scenario: at 0.5 s the robot is no longer at rest"),
        (release.to_owned() + cut, "[[release]] of --scenario: at 0.5 s the robot is no longer at rest"),
        (
            cut.to_owned() + &cut.replace("0.2", "0.3"),
            "[[cut]] number 2 of --scenario: cable \"1\" has been cut before",
        ),
        (release.replace("1.0", "13.0"), "[[release]] of --scenario: the payload's 13 kg leave nothing"),
        (release.replace("0.5", "11.0"), "[[release]] of --scenario: its time 11 s is not within the simulated time"),
        (release.replace("0.5", "10.0"), "[[release]] of --scenario is at the end"),
    ] {
        let output = moving(&scenario, &[]);
        assert_eq!(output.status.code(), Some(2), "{scenario}: {}", stderr(&output));
        assert!(stderr(&output).contains(says) && stdout(&output).is_empty(), "{scenario}: {}", stderr(&output));
    }
    let path = super::project("docs/simulation/release.toml");
    for (options, says) in [
        (vec!["--to", "vtk", "--scenario", &path], "has no events: leave out --scenario"),
        (vec!["--to", "moordyn", "--for", "2"], "--duration-s is the time of a --scenario"),
        (vec!["--to", "moordyn", "--scenario", &path, "-o", "drop.xml"], "would hold a Python script for MoorDyn"),
    ] {
        let output = run(&[&["export", "ROBOT"][..], &options].concat());
        assert_eq!(output.status.code(), Some(2), "{options:?}");
        assert!(stderr(&output).contains(says), "{options:?}: {}", stderr(&output));
    }
}

#[test]
fn ropes_whose_long_names_begin_alike_stay_apart_in_moordyn_and_on_the_way_back() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("robot.txt");
    let rope = "rope ".repeat(1000);
    // Each cable has its own rope with its own mass. The names differ only in their last letter; hyphens begin
    // sections.
    let mut text = yuan();
    let begin = text.find("[materials.rope-4mm]").unwrap();
    let end = begin + text[begin..].find("\n[[").unwrap_or(text[begin..].len());
    let material = text[begin..end].to_owned();
    let mut materials = String::new();
    for i in 1..=6 {
        let named = material.replace("[materials.rope-4mm]", &format!("[materials.\"{rope}---{i}\"]"));
        materials += &named.replace("mass_kg_per_m = 0.067", &format!("mass_kg_per_m = 0.06{i}"));
        text = text.replacen("material = \"rope-4mm\"", &format!("material = \"{rope}---{i}\""), 1);
    }
    text.replace_range(begin..end, &materials);
    let output = run_with(&["export", "-", "--to", "moordyn", "--segments", "5", "-o", path.to_str().unwrap()], &text);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let imported = succeed(&["import", path.to_str().unwrap()]);
    assert_eq!(imported.matches("[materials.").count(), 6, "{imported}");
    let again = run_with(&["statics", "-"], &imported);
    assert_eq!(again.status.code(), Some(0), "{}", stderr(&again));

    // A file of another program with long names that differ only at their ends.
    let long = "x".repeat(3000);
    let mut file = std::fs::read_to_string(&path).unwrap();
    for i in 1..=6 {
        let name = file.lines().find_map(|line| {
            let word = line.split_whitespace().next()?;
            (word.starts_with("rope") && word.ends_with(&format!("_{i}"))).then(|| word.to_owned())
        });
        file = file.replace(&name.unwrap(), &format!("{long}{i}"));
    }
    std::fs::write(&path, file).unwrap();
    let imported = succeed(&["import", path.to_str().unwrap()]);
    assert_eq!(imported.matches("[materials.").count(), 6, "{imported}");
}

#[test]
fn a_script_for_opensees_has_the_robot_its_numbers_and_the_requested_frequencies() {
    let script = succeed(&["export", "ROBOT", "--to", "opensees", "--segments", "3"]);
    assert!(script.starts_with("#!/usr/bin/env python3\n") && script.ends_with(")\n"));
    let line = |start: &str| script.lines().find(|line| line.starts_with(start)).unwrap().to_owned();
    assert_eq!(line("NAME"), "NAME = \"INSA Rennes 6-cable suspended robot, 4 mm cables\"");
    assert_eq!(line("FREQUENCIES_HZ").matches(',').count(), 9);
    assert_eq!(script.matches("\"bar_length\":").count(), 6);
    let script = succeed(&["export", "ROBOT", "--to", "opensees", "--modes-below-hz", "2"]);
    let line = script.lines().find(|line| line.starts_with("FREQUENCIES_HZ")).unwrap();
    assert_eq!(line.matches(',').count(), 7, "eight modes lie below 2 Hz: {line}");
}

#[test]
fn a_vtk_file_has_as_many_numbers_as_it_says() {
    let file = succeed(&["export", "ROBOT", "--to", "vtk", "--segments", "7", "--modes-below-hz", "1.3"]);
    let document = roxmltree::Document::parse(&file).unwrap();
    let piece = document.descendants().find(|node| node.has_tag_name("Piece")).unwrap();
    assert_eq!((piece.attribute("NumberOfPoints"), piece.attribute("NumberOfLines")), (Some("54"), Some("6")));
    let mut names = Vec::new();
    for array in document.descendants().filter(|node| node.has_tag_name("DataArray")) {
        let count = array.text().unwrap().split_whitespace().filter(|word| word.parse::<f64>().is_ok()).count();
        if array.attribute("type") == Some("Float64") {
            let components: usize = array.attribute("NumberOfComponents").map_or(1, |n| n.parse().unwrap());
            assert_eq!(count, 54 * components, "{:?}", array.attribute("Name"));
            names.push(array.attribute("Name").unwrap());
        }
    }
    let modes = ["mode_001_1.0207_Hz", "mode_002_1.1876_Hz", "mode_003_1.2231_Hz", "mode_004_1.2662_Hz"];
    assert_eq!(names, [&["position_m", "tension_n", "arc_length_m"], &modes[..]].concat());
}

/// Numbers of an attribute.
fn numbers(node: roxmltree::Node, attribute: &str) -> Vec<f64> {
    node.attribute(attribute).unwrap().split(' ').map(|x| x.parse().unwrap()).collect()
}

#[test]
fn a_model_of_mujoco_rests_at_the_equilibrium_of_springs() {
    let names = ["cogiro.toml", "cogiro-winches.toml", "kntu-planar.toml", "stadium-camera.toml", "grab-3-cables.toml"];
    for name in names {
        let file = succeed(&["export", &robot(name), "--to", "mujoco"]);
        let document = roxmltree::Document::parse(&file).unwrap();
        let found: serde_json::Value =
            serde_json::from_str(&succeed(&["statics", &robot(name), "--static-model", "spring", "--format", "json"]))
                .unwrap();
        let named = |name: &str| document.descendants().find(|node| node.attribute("name") == Some(name)).unwrap();

        let position = numbers(named("platform"), "pos");
        let expected: Vec<f64> = serde_json::from_value(found["pose"]["position_m"].clone()).unwrap();
        let off = position.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-9, "{name}: {position:?} {expected:?}");

        let cables = found["cables"].as_array().unwrap();
        let forces = document.descendants().find(|node| node.attribute("name") == Some("forces")).unwrap();
        let tensions = &numbers(forces, "ctrl")[cables.len()..];
        for (cable, tension) in cables.iter().zip(tensions) {
            let expected = cable["tension_platform_n"].as_f64().unwrap();
            assert!((tension / expected - 1.0).abs() < 1e-6, "{name}: {tension} {expected}");
            // The cable only pulls, and has no force at the length of its spring.
            let winch = named(&format!("length:{}", cable["name"].as_str().unwrap()));
            let [bias, stiffness] = numbers(winch, "biasprm")[..2] else { panic!("three numbers") };
            assert!(numbers(winch, "forcerange")[1] == 0.0 && stiffness < 0.0 && bias > 0.0);
        }
        let pulleys = file.matches("<body name=\"pulley:").count();
        let expected = cables.iter().filter(|cable| cable["drive"]["wrap_deg"].is_f64()).count();
        assert_eq!(pulleys, expected, "{name}");
    }
}

#[test]
fn a_cable_of_mujoco_in_pieces_has_the_mass_the_stiffness_and_the_end_of_the_rope() {
    const PIECES: usize = 5;

    let file = succeed(&["export", &robot("cogiro.toml"), "--to", "mujoco", "--cable-pieces", &PIECES.to_string()]);
    let found: serde_json::Value =
        serde_json::from_str(&succeed(&["statics", &robot("cogiro.toml"), "--format", "json"])).unwrap();
    let document = roxmltree::Document::parse(&file).unwrap();
    let named = |kind: &str, name: &str| {
        document.descendants().find(|node| node.has_tag_name(kind) && node.attribute("name") == Some(name)).unwrap()
    };
    let value = |node: roxmltree::Node, attribute: &str| numbers(node, attribute)[0];
    let platform = named("body", "platform");

    for cable in found["cables"].as_array().unwrap() {
        let name = cable["name"].as_str().unwrap();
        let length = cable["unstrained_length_m"].as_f64().unwrap();
        let bars: Vec<_> = (1..PIECES).map(|k| named("body", &format!("cable:{name}:{k}"))).collect();

        // Half of the last piece hangs from the anchor; the weight of the chain is corrected by 1e-4 of it.
        let inner =
            |body: roxmltree::Node, tag: &str| body.children().find(|node| node.has_tag_name(tag)).unwrap().id();
        let mass: f64 =
            bars.iter().map(|body| value(document.get_node(inner(*body, "inertial")).unwrap(), "mass")).sum();
        let expected = 0.064 * length * (1.0 - 0.5 / PIECES as f64);
        assert!((mass / expected - 1.0).abs() < 1e-3, "{name}: {mass} {expected}");

        // Both springs in series are the rope.
        let winch = named("general", &format!("length:{name}"));
        let stretch = named("joint", &format!("stretch:{name}"));
        let compliance = 1.0 / value(stretch, "stiffness") + 1.0 / value(winch, "gainprm");
        assert!((compliance * -numbers(winch, "forcerange")[0] / length - 1.0).abs() < 1e-9, "{name}: {compliance}");

        // From the platform along the bars to the tip, and from there to the anchor with the force of the tendon.
        let mut tip_p = [0.0; 3];
        for at in
            bars.iter().map(|body| numbers(*body, "pos")).chain([numbers(named("site", &format!("tip:{name}")), "pos")])
        {
            (0..3).for_each(|i| tip_p[i] += at[i]);
        }
        let [w, x, y, z] = numbers(platform, "quat")[..] else { panic!("four numbers") };
        let turn = [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ];
        let origin = numbers(platform, "pos");
        let anchor = numbers(named("site", &format!("anchor:{name}")), "pos");
        let tip = |i: usize| origin[i] + (0..3).map(|j| turn[i][j] * tip_p[j]).sum::<f64>();
        let last = (0..3).map(|i| (anchor[i] - tip(i)).powi(2)).sum::<f64>().sqrt();
        let [bias, minus_k] = numbers(winch, "biasprm")[..2] else { panic!("three numbers") };
        let tension = -(bias + minus_k * last);
        let [low, high] = ["tension_platform_n", "tension_anchor_n"].map(|key| cable[key].as_f64().unwrap());
        assert!(low < tension && tension < high && high - tension < 0.2 * (high - low), "{low} {tension} {high}");
        assert!((numbers(winch, "ctrlrange")[0] / last + 0.8).abs() < 1e-9);
    }
}

#[test]
fn links_of_gazebo_and_of_viewers_are_where_the_robot_rests() {
    for name in ["cogiro.toml", "stadium-camera.toml", "grab-3-cables.toml"] {
        let found: serde_json::Value =
            serde_json::from_str(&succeed(&["statics", &robot(name), "--static-model", "spring", "--format", "json"]))
                .unwrap();
        let cables = found["cables"].as_array().unwrap();
        let expected: Vec<f64> = serde_json::from_value(found["pose"]["position_m"].clone()).unwrap();

        let sdf = succeed(&["export", &robot(name), "--to", "sdf"]);
        let document = roxmltree::Document::parse(&sdf).unwrap();
        let named = |name: &str| document.descendants().find(|node| node.attribute("name") == Some(name)).unwrap();
        let child = |node: roxmltree::Node, tag: &str| {
            let inner = node.descendants().find(|node| node.tag_name().name() == tag).unwrap();
            inner.text().unwrap().split(' ').map(|x| x.parse().unwrap()).collect::<Vec<f64>>()
        };
        let link =
            document.descendants().find(|node| node.has_tag_name("link") && node.attribute("name") == Some("platform"));
        assert!((child(link.unwrap(), "pose")[2] - expected[2]).abs() < 1e-9, "{name}");
        for cable in cables {
            let spring =
                named(&format!("attachment_{}", cable["name"].as_str().unwrap())).next_sibling_element().unwrap();
            let [stiffness, free] =
                ["stiffness", "free_length"].map(|key| child(spring, &format!("linear_spring_damper_{key}"))[0]);
            let tension = stiffness * (cable["chord_m"].as_f64().unwrap() - free);
            assert!((tension / cable["tension_platform_n"].as_f64().unwrap() - 1.0).abs() < 1e-6, "{name}: {tension}");
        }

        let urdf = succeed(&["export", &robot(name), "--to", "urdf"]);
        let document = roxmltree::Document::parse(&urdf).unwrap();
        let joints = document.descendants().filter(|node| node.has_tag_name("joint")).count();
        assert_eq!(joints, 1 + 2 * cables.len(), "{name}");
    }
    let planar = succeed(&["export", &robot("kntu-planar.toml"), "--to", "urdf"]);
    assert!(planar.contains("type=\"planar\"") && planar.contains("<axis xyz=\"0 0 1\"/>"), "{planar}");
}

#[test]
fn flexible_supports_are_fixed_where_springs_leave_them_and_the_file_says_so() {
    let posts = yuan().replacen("[[cables]]", "[[cables]]\nsupport = \"post\"", 2)
        + "\n[supports.post]\nstiffness_n_per_m = 50000\n";
    let output = run_with(&["statics", "-", "--static-model", "spring", "--format", "json"], &posts);
    let found: serde_json::Value = serde_json::from_str(stdout(&output)).unwrap();
    let expected = found["pose"]["position_m"][2].as_f64().unwrap();
    let file = run_with(&["export", "-", "--to", "mujoco"], &posts);
    let document = roxmltree::Document::parse(stdout(&file)).unwrap();
    let platform = document.descendants().find(|node| node.attribute("name") == Some("platform")).unwrap();
    assert!((numbers(platform, "pos")[2] - expected).abs() < 1e-9, "{expected}");
    let says = "have no flexible supports: anchors are fixed where they are at rest";
    assert!(stdout(&file).contains(says) && stderr(&file).contains(says), "{}", stderr(&file));
}

#[test]
fn a_model_of_mujoco_says_what_it_leaves_out_and_holds_any_name() {
    let awkward = yuan()
        .replace("name = \"1\"", "name = \"<&\\uFFFE --\\\"\"")
        .replace("[platform]", "[platform]\ntranslational_damping_n_s_m = [5.0, 5.0, 5.0]");
    let output = run_with(&["export", "-", "--to", "mujoco"], &awkward);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let (file, told) = (stdout(&output), stderr(&output));
    let document = roxmltree::Document::parse(file).unwrap();
    assert!(document.descendants().any(|node| node.attribute("name") == Some("length:<&_ --\"")), "{file}");
    for lost in
        ["of rope beside 10.55 kg of the platform", "the viscous damping of the platform is left out", "is \"<&_"]
    {
        assert!(told.contains(lost), "{lost}: {told}");
    }
    assert!(file.contains("- the viscous damping of the platform is left out"), "{file}");
}

#[test]
fn a_pose_of_a_redundant_robot_is_exported_with_the_tensions_of_the_rule() {
    let script = |rule: &str| {
        succeed(&[
            "export",
            &robot("cogiro.toml"),
            "--to",
            "opensees",
            "--pose",
            "1,1,1.5",
            "--tension-rule",
            rule,
            "--segments",
            "2",
        ])
    };
    let tensions = |script: String| script.lines().find(|line| line.starts_with("TENSIONS_N")).unwrap().to_owned();
    assert_ne!(tensions(script("lowest")), tensions(script("middle")));
}

#[test]
fn a_script_for_opensees_has_the_guide_and_the_load() {
    let load = ["--force-n", "1,2,3", "--load-point-m", "0.1,0,0.2", "--moment-n-m", "0.1,0.2,0.3", "--segments", "2"];
    let line = |text: &str, start: &str| text.lines().find(|line| line.starts_with(start)).unwrap().to_owned();
    let rows = |text: &str| serde_json::from_str::<Vec<[[f64; 3]; 2]>>(&line(text, "LOADS = ")[8..]).unwrap();
    let script = succeed(
        &[&["export", &robot("kntu-planar.toml"), "--to", "opensees", "--modes-below-hz", "20"], &load[..]].concat(),
    );
    assert_eq!(line(&script, "GUIDED"), "GUIDED = 2");
    // The force and two couples about the normal.
    assert_eq!(rows(&script).len(), 5);
    let script = succeed(&[&["export", "ROBOT", "--to", "opensees", "--modes-below-hz", "1"], &load[..]].concat());
    assert_eq!(line(&script, "GUIDED"), "GUIDED = None");
    assert_eq!(rows(&script).len(), 13);
    assert!(line(&script, "LOADS").contains(",[1.0,2.0,3.0]],"), "the force as it was given");
}

#[test]
fn robots_that_cannot_be_exported_are_refused_with_the_reason() {
    let sideways = yuan().replace("[platform]", "gravity_m_s2 = [0.1, 0.0, -9.81]\n[platform]");
    let planar = std::fs::read_to_string(robot("kntu-planar.toml")).unwrap();
    let massless = yuan().replace("mass_kg_per_m = 0.067", "mass_kg_per_m = 0.0");
    for (robot, arguments, says) in [
        (yuan(), "--to moordyn --static-model spring", "leave out --static-model"),
        (yuan(), "--to moordyn --modes-below-hz 3", "MoorDyn has no modes"),
        (yuan(), "--to moordyn --segments 0", "--segments"),
        (yuan(), "--to abaqus", "possible values: opensees, moordyn, mujoco, sdf, urdf, vtk"),
        (yuan(), "--to mujoco --static-model ideal", "ideal cables have no stiffness, which MuJoCo needs"),
        (yuan(), "--to mujoco --modes-below-hz 3", "MuJoCo has no modes"),
        (yuan(), "--to opensees --cable-pieces 4", "--cable-pieces is for MuJoCo: for OpenSees leave it out"),
        (yuan(), "--to mujoco --cable-pieces 1", "give a whole number from 2 to 100"),
        (yuan(), "--to mujoco --cable-pieces 4 --cable-load-n-per-m 0,0,-1", "cable \"1\" has wind or another load"),
        (yuan(), "--to mujoco --cable-pieces 4 --static-model spring", "leave out --static-model"),
        (massless.clone(), "--to mujoco --cable-pieces 4", "no cable has mass"),
        (yuan(), "--to vtk --modes-below-hz 1e4", "lower the frequency limit"),
        (sideways, "--to moordyn", "MoorDyn has it along -z only"),
        (massless, "--to moordyn", "cable \"1\" has no mass"),
        (planar.clone(), "--to sdf", "SDF has no joint that guides a body in a plane"),
        (planar, "--to moordyn", "nothing guides them in a plane"),
        (yuan(), "--to moordyn --force-n 0,0,-1", "MoorDyn's input has no forces but weight and water"),
        (yuan(), "--to moordyn --moment-n-m 0,0,1", "MoorDyn's input has no forces but weight and water"),
    ] {
        let arguments: Vec<&str> = ["export", "-"].into_iter().chain(arguments.split(' ')).collect();
        let output = run_with(&arguments, &robot);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(says) && stdout(&output).is_empty(), "{arguments:?}: {}", stderr(&output));
    }
    let loose = run_with(
        &["export", "-", "--to", "opensees", "--lengths-m", "8,6.565,6.756,6.663,6.801,6.604"],
        &yuan().replace("mass_kg_per_m = 0.067", "mass_kg_per_m = 0.0"),
    );
    assert_eq!(loose.status.code(), Some(1), "{}", stderr(&loose));
    assert!(stderr(&loose).contains("cable \"1\" has no tension"), "{}", stderr(&loose));
    assert_eq!(run(&["export", "ROBOT"]).status.code(), Some(2), "a program has to be named");
}

//! `statics`: keys, poses and lengths, tensions by rules, other equilibria, what is none.

use super::{close, json, json_of, number, numbers, robot, run, run_with, stderr, stdout, succeed, yuan};
use serde_json::Value;

#[test]
fn statics_has_the_published_pose_and_the_keys() {
    let value = json(&["statics", "ROBOT"]);
    let position = numbers(&value["pose"]["position_m"]);
    for (found, expected) in position.iter().zip([0.020_304_9, 0.010_231_8, 0.455_485_0]) {
        assert!(close(*found, expected, 1e-6), "{position:?}");
    }
    assert!(close(numbers(&value["pose"]["quaternion_wxyz"]).iter().map(|q| q * q).sum(), 1.0, 1e-12));
    assert!(number(&value["residual"]) <= 1e-10);
    assert_eq!(value["stable"], true);
    assert_eq!(value["static_model"], "catenary");
    assert!(number(&value["stiffness_min_n_per_m"]) > 0.0 && value["iterations"].is_u64());
    let cables = value["cables"].as_array().unwrap();
    assert_eq!(cables.len(), 6);
    for key in ["unstrained_length_m", "tension_platform_n", "tension_anchor_n", "chord_m", "sag_ratio", "lambda2"] {
        assert!(cables.iter().all(|cable| number(&cable[key]) > 0.0), "{key}");
    }
    assert_eq!(cables[0]["name"], "1");
    let forces: Vec<f64> = cables.iter().map(|cable| numbers(&cable["force_on_platform_n"])[2]).collect();
    assert!(close(forces.iter().sum(), 10.55 * 9.81, 1e-8), "the cables carry the weight");
}

#[test]
fn pose_and_lengths_are_inverse_to_each_other() {
    let there = json(&["statics", "ROBOT", "--pose", "-0.05,0.02,0.5,1,-2,3", "--mass-kg", "20"]);
    let lengths: Vec<String> =
        there["cables"].as_array().unwrap().iter().map(|c| c["unstrained_length_m"].to_string()).collect();
    let back = json(&["statics", "ROBOT", "--lengths-m", &lengths.join(","), "--set", "platform.mass_kg=20"]);
    for key in ["position_m", "roll_pitch_yaw_deg"] {
        let (a, b) = (numbers(&there["pose"][key]), numbers(&back["pose"][key]));
        assert!(a.iter().zip(&b).all(|(a, b)| close(*a, *b, 1e-7)), "{a:?} {b:?}");
    }
    assert!(close(numbers(&there["pose"]["position_m"])[0], -0.05, 1e-12));
}

#[test]
fn tensions_of_a_redundant_robot_follow_the_rule_and_show_their_limits() {
    let cogiro = robot("cogiro.toml");
    let pose = ["statics", &cogiro, "--pose", "1,1,1.5"];
    let of = |options: &[&str]| json(&[&pose, options].concat());
    let tensions = |value: &Value| -> Vec<f64> {
        value["cables"].as_array().unwrap().iter().map(|c| number(&c["tension_platform_n"])).collect()
    };
    let lowest = of(&[]);
    assert_eq!(lowest["tension_rule"], "lowest");
    assert!(number(&lowest["residual"]) <= 1e-10);
    for cable in lowest["cables"].as_array().unwrap() {
        assert_eq!((number(&cable["minimum_tension_n"]), number(&cable["maximum_tension_n"])), (100.0, 5000.0));
        assert!(number(&cable["tension_margin_n"]) > -1e-4 && number(&cable["tension_margin"]) < 0.5);
    }
    let reached = |value: &Value| value["cables"].as_array().unwrap().iter().any(|c| c["limit_reached"] == "minimum");
    let sum = |value: &Value| tensions(value).iter().sum::<f64>();
    let wide = of(&["--max-tension-n", "800", "--min-tension-n", "265"]);
    assert!(reached(&wide), "{wide}");
    assert!(tensions(&wide).iter().all(|t| *t > 264.0 && *t < 800.0));
    let middle = of(&["--tension-rule", "middle", "--max-tension-n", "800"]);
    let min_margin = |value: &Value| {
        let margins = value["cables"].as_array().unwrap().iter().map(|c| number(&c["tension_margin_n"]));
        margins.fold(f64::INFINITY, f64::min)
    };
    assert!(min_margin(&middle) >= min_margin(&of(&["--max-tension-n", "800"])));
    let centre = of(&["--tension-rule", "centre", "--max-tension-n", "800"]);
    assert_eq!(centre["tension_rule"], "centre");
    assert!(min_margin(&centre) > 0.5 * min_margin(&middle) && min_margin(&centre) <= min_margin(&middle) + 1e-6);
    let stiffest = of(&["--tension-rule", "stiffest", "--max-tension-n", "800"]);
    let stiffness = |value: &Value| number(&value["stiffness_min_n_per_m"]);
    assert!(stiffness(&stiffest) >= stiffness(&middle) && stiffness(&stiffest) >= stiffness(&lowest));
    let closest = of(&["--target-tension-n", "450"]);
    assert_eq!(closest["tension_rule"], "closest");
    assert!(sum(&closest) > sum(&lowest));
    let text = succeed(&pose);
    assert!(text.contains("tensions by the rule `lowest`") && text.contains("100 to 5000"), "{text}");
    // The other analyses start from the same state.
    assert!(succeed(&["modes", &cogiro, "--pose", "1,1,1.5", "--below-hz", "3"]).contains("Certified"));
}

#[test]
fn a_state_beyond_its_limits_is_warned_of_with_numbers() {
    let output = run(&["statics", "ROBOT", "--max-tension-n", "50"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(stderr(&output).contains("above its `maximum_tension_n` of 50 N"), "{}", stderr(&output));
    let rope = "materials.rope-4mm.breaking_load_n=52";
    let output = run(&["statics", "ROBOT", "--set", rope]);
    assert!(stderr(&output).contains("its rope breaks at 52 N"), "{}", stderr(&output));
}

#[test]
fn a_maximum_above_the_breaking_load_is_refused_by_every_analysis() {
    let (cogiro, breaks) = (robot("cogiro.toml"), "above the breaking load 10000 N of its rope");
    let at = ["--pose", "1,2,1.5"];
    for command in [
        &["statics"][..],
        &["modes", "--below-hz", "3"],
        &["payload"],
        &["map", "--grid", "z=1:2:2", "--quantity", "tension-max"],
    ] {
        let with = |maximum: &str| {
            let named = [&command[..1], &[cogiro.as_str()], &command[1..], &at].concat();
            run(&[&named[..], &["--max-tension-n", maximum]].concat())
        };
        let refused = with("10000.1");
        assert_eq!(refused.status.code(), Some(2), "{command:?}: {}", stderr(&refused));
        let message = stderr(&refused);
        assert!(message.contains("cable \"1\": maximum tension 10000.1 N is"), "{message}");
        assert!(message.contains(breaks) && message.contains("give --max-tension-n of at most 10000"), "{message}");
        assert!(stdout(&refused).is_empty());
        // The breaking load itself is allowed, as in a robot file.
        assert_eq!(with("10000").status.code(), Some(0), "{command:?}");
    }

    // The message names the weakest rope, whatever the order of the cables.
    let text = std::fs::read_to_string(&cogiro).unwrap();
    let fifth = "name = \"5\"\nmaterial = \"wire-rope-4mm\"";
    assert_eq!(text.matches(fifth).count(), 1);
    let weak =
        "\n[materials.weak]\naxial_stiffness_n = 1e6\nmass_kg_per_m = 0.1\ndamping_ratio = 0\nbreaking_load_n = 4000\n";
    let text = text.replace(fifth, "name = \"5\"\nmaterial = \"weak\"") + weak;
    let refused = run_with(&["statics", "-", "--pose", "1,2,1.5", "--max-tension-n", "20000"], &text);
    assert_eq!(refused.status.code(), Some(2), "{}", stderr(&refused));
    assert!(stderr(&refused).contains("cable \"5\": maximum tension 20000 N"), "{}", stderr(&refused));
    assert!(stderr(&refused).contains("of at most 4000"), "{}", stderr(&refused));
}

#[test]
fn statics_names_another_stable_equilibrium_and_all_lists_them() {
    let text = succeed(&["statics", "ROBOT"]);
    assert!(text.contains("These lengths have another stable equilibrium"), "{text}");
    let all = json(&["statics", "ROBOT", "--all"]);
    let rows = all["equilibria"].as_array().unwrap();
    assert!(rows.len() >= 4 && all.get("other_stable").is_none());
    assert_eq!((&all["search"]["index_sum"], &all["search"]["expected_index_sum"]), (&0.into(), &0.into()));
    assert_eq!((rows[0]["energy_j"].as_f64(), &rows[0]["stable"]), (Some(0.0), &true.into()));
    assert!(rows[0]["distance_m"].as_f64().unwrap() < 1e-8);
    assert!(rows.windows(2).all(|pair| pair[0]["energy_j"].as_f64() <= pair[1]["energy_j"].as_f64()));
    let text = succeed(&["statics", "ROBOT", "--all"]);
    assert!(
        text.contains("as theory requires, as many equilibria have an even as an odd number of unstable directions"),
        "{text}"
    );
    let csv = succeed(&["statics", "ROBOT", "--all", "--format", "csv"]);
    assert!(csv.starts_with("stable,falling_directions,"), "{csv}");
    assert_eq!(csv.lines().count(), rows.len() + 1);
    let output = run(&["statics", "ROBOT", "--all", "--static-model", "ideal"]);
    assert_eq!(output.status.code(), Some(2), "{}", stdout(&output));
}

#[test]
fn what_is_no_equilibrium_is_not_given_as_one() {
    let refused = |args: &[&str], said: &str| {
        let output = run(args);
        assert_eq!(output.status.code(), Some(1), "{args:?}");
        assert!(stderr(&output).contains(said) && stdout(&output).is_empty(), "{}", stderr(&output));
    };
    refused(&["statics", "ROBOT", "--set", "gravity_m_s2=[0,0,-1e-12]"], "the loads are too small for cables as stiff");
    let push = ["statics", "ROBOT", "--static-model", "ideal", "--pose", "0,3,0.6"];
    refused(&push, "cable \"2\" would need -138.0");
    let text = succeed(&["statics", "ROBOT", "--set", "gravity_m_s2=[0,0,0]"]);
    assert!(text.contains("No load and no tension: no residual, after"), "{text}");
}

#[test]
fn a_load_is_the_files_or_the_options() {
    let file = format!("{}\n[loads]\nforce_n = [0, 0, -98.1]\n", yuan());
    let of_file = json_of(&["statics", "-"], &file);
    let of_options = json(&["statics", "ROBOT", "--force-n", "0,0,-98.1"]);
    assert_eq!(of_file["pose"], of_options["pose"]);
    assert_eq!(numbers(&of_options["load"]["force_n"]), [0.0, 0.0, -98.1]);
    let none = json_of(&["statics", "-", "--force-n", "0,0,0"], &file);
    let bare = json(&["statics", "ROBOT"]);
    assert!(none["pose"] == bare["pose"] && bare.get("load").is_none());
    assert!(succeed(&["statics", "ROBOT", "--moment-n-m", "0,1,0"]).contains("moment (0.0000, 1.0000, 0.0000) N m"));
    for arguments in [
        &["modes", "ROBOT", "--below-hz", "3", "--force-n", "5,0,0", "--load-point-m", "0,0,-0.1"][..],
        &["stiffness", "ROBOT", "--moment-n-m", "0,1,0"],
    ] {
        succeed(arguments);
    }
    let refused = run(&["statics", "ROBOT", "--load-point-m", "0,0,1"]);
    assert!(refused.status.code() == Some(2) && stderr(&refused).contains("give --force-n"));
}

/// The example of a robot on posts: displacements of its supports, and the interval of friction with them.
#[test]
fn a_robot_on_posts_has_an_interval_of_friction() {
    let robot = super::project("docs/pulleys/posts.toml");
    let found = json(&["statics", &robot, "--friction-interval"]);
    let names: Vec<&str> = found["supports"].as_array().unwrap().iter().map(|s| s["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["east-north", "east-south", "west"]);
    let height = numbers(&found["friction_interval"]["translation_m"][2]);
    assert!(height[0] < -1e-5 && height[1] > 1e-5, "{height:?}");

    // With the pose held the supports would move.
    let refused = super::run(&["statics", &robot, "--friction-interval", "--pose", "0,0,0.5,0,0,0"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(stderr(&refused).contains("its drum on the ground"), "{}", stderr(&refused));
}

#[test]
fn friction_of_pulleys_leaves_an_interval() {
    let robot = super::project("docs/pulleys/winches.toml");
    let run = |arguments: &[&str]| super::run(&[&["statics", robot.as_str()], arguments].concat());

    // Without the option the equilibrium is that without friction, with a warning of its size.
    let left_out = run(&[]);
    let smooth = run(&["--set", "pulleys.wheel.efficiency=1"]);
    assert_eq!(stdout(&left_out), stdout(&smooth));
    let warning =
        "leaves out the friction of pulleys, which changes the tension at the drum of cable \"1\" by up to 2 %";
    assert!(stderr(&left_out).contains(warning), "{}", stderr(&left_out));
    assert!(stderr(&left_out).contains("--friction-interval gives"), "{}", stderr(&left_out));
    assert_eq!(stderr(&smooth), "");
    let modes = super::run(&["modes", &robot, "--below-hz", "1"]);
    assert_eq!((modes.status.code(), stderr(&modes)), (Some(0), ""));
    let checked = succeed(&["check", &robot]);
    assert!(checked.contains("η = 0.98"), "{checked}");

    // Lengths held.
    let found = run(&["--friction-interval"]);
    assert_eq!((found.status.code(), stderr(&found)), (Some(0), ""));
    assert!(stdout(&found).starts_with(stdout(&left_out).trim_end()), "{}", stdout(&found));
    assert!(stdout(&found).contains("translation x, y, z") && stdout(&found).contains("beyond exit [mm]"));
    let printed = run(&["--friction-interval", "--format", "json"]);
    let json: Value = serde_json::from_str(stdout(&printed)).unwrap();
    let interval = &json["friction_interval"];
    assert_eq!(interval["held"], "lengths");
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    for pair in interval["translation_m"].as_array().unwrap() {
        assert!(number(&pair[0]) < 0.0 && number(&pair[1]) > 0.0, "{pair}");
    }
    let csv = run(&["--friction-interval", "--format", "csv"]);
    let header = stdout(&csv).lines().next().unwrap();
    assert!(header.ends_with("tension_anchor_max_n,tension_drum_min_n,tension_drum_max_n"), "{header}");
    assert!(stdout(&csv).lines().all(|line| line.split(',').count() == header.split(',').count()));

    // Pose held, and lengths of a pose held.
    let pose = ["--pose", "0.02,0.01,0.45,0.4,3.1,-0.2", "--friction-interval"];
    let held = run(&pose);
    assert!(stdout(&held).contains("with the pose held") && !stdout(&held).contains("translation x"));
    let held = run(&[&pose[..], &["--hold-lengths-of-pose", "--mass-kg", "12"]].concat());
    assert!(stdout(&held).contains("with the lengths held"), "{}{}", stdout(&held), stderr(&held));

    // A robot without friction.
    let refused = super::run(&["statics", "ROBOT", "--friction-interval"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(stderr(&refused).contains("no cable runs over a pulley with friction: give [pulleys.NAME]"));
}

/// Pulleys and winches in every command that takes a robot.
#[test]
fn commands_follow_cables_over_pulleys() {
    let library =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots/yuan2014-4mm.toml")).unwrap();
    // The lengths count from the drum: some 3.1 m more.
    let longer = |line: &str| match line.strip_prefix("unstrained_length_m = ") {
        Some(length) => format!("unstrained_length_m = {}\npulley = \"wheel\"\nwinch = \"drum\"\n", {
            let length: f64 = length.split(' ').next().unwrap().parse().unwrap();
            length + 3.068
        }),
        None => format!("{line}\n"),
    };
    let tables = "[pulleys.wheel]\nradius_m = 0.05\nentry_direction = [0, 0, 1]\n[winches.drum]\n\
                  drum_side_length_m = 3.0\nstiffness_n_per_m = 5e4\n[[cables]]\n";
    let robot: String = library.lines().map(longer).collect::<String>().replacen("[[cables]]\n", tables, 1);
    let printed = |arguments: &[&str]| {
        let output = run_with(arguments, &robot);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
        stdout(&output).to_owned()
    };

    assert!(printed(&["check", "-"]).contains("entry direction"));
    lengths_to_the_anchors_hold_the_pose_without_pulleys(&robot, &library);
    let statics = printed(&["statics", "-"]);
    assert!(statics.contains("wrap [°]") && statics.contains("Stable"), "{statics}");
    let header = printed(&["statics", "-", "--format", "csv"]).lines().next().unwrap().to_owned();
    assert!(header.ends_with("free_length_m,arc_length_m,drum_side_length_m,winch_yield_m"), "{header}");
    assert!(printed(&["modes", "-", "--below-hz", "2"]).contains("Certified"));
    let compared = printed(&["compare", "-", "--below-hz", "2"]);
    assert!(compared.contains("catenary-dynamic") && compared.contains("shallow-dynamic [Hz]"), "{compared}");
    assert!(
        printed(&["frf", "-", "--input", "fz", "--output", "z", "--from-hz", "1", "--to-hz", "2", "--points", "5"])
            .contains("peaks")
    );
    let rows = printed(&[
        "sweep",
        "-",
        "--vary",
        "pulleys.wheel.radius_m=0.01:0.2:3",
        "--quantity",
        "exit-tensions,drum-tensions,wrap-max",
        "--format",
        "csv",
    ]);
    assert!(
        rows.contains("tension_anchor_1_n,") && rows.contains("tension_drum_1_n") && rows.contains("wrap_max_deg"),
        "{rows}"
    );
    let page = printed(&["report", "-", "--below-hz", "2", "-o", "-"]);
    assert!(page.contains("tension, drum") && page.contains("exit points held") && page.contains("drum of cable"));
    let moordyn = run_with(&["export", "-", "--to", "moordyn"], &robot);
    assert!(stdout(&moordyn).contains("Pulleys and winches are left out"), "{}", stdout(&moordyn));
    assert!(stderr(&moordyn).contains("MoorDyn has no pulleys and no winches: the lines of the cables 1, 2, 3"));
    let opensees = printed(&["export", "-", "--to", "opensees", "--segments", "2"]);
    assert_eq!(opensees.matches("\"support\":{\"behind\":").count(), 6, "{opensees}");

    // An attachment inside a wheel, and a cable of half its length.
    let inside = run_with(&["statics", "-", "--pose", "0,0,1", "--set", "pulleys.wheel.radius_m=5"], &robot);
    assert_eq!(inside.status.code(), Some(2), "{}", stderr(&inside));
    assert!(stderr(&inside).contains("inside the wheel of its pulley"), "{}", stderr(&inside));
    let short = run_with(&["statics", "-", "--set", "cables.1.unstrained_length_m=4.5"], &robot);
    assert!(stderr(&short).contains("strain of cable"), "{}", stderr(&short));
}

/// The lengths to the anchors that `check` lists are those that hold the pose of the robot without its pulleys, but for
/// the radius of the wheels.
fn lengths_to_the_anchors_hold_the_pose_without_pulleys(driven: &str, fixed: &str) {
    let json = |arguments: &[&str], robot: &str| -> Value {
        let output = run_with(&[arguments, &["--format", "json"]].concat(), robot);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        serde_json::from_str(stdout(&output)).unwrap()
    };
    let rest = json(&["statics", "-"], driven);
    let [position, angles] = ["position_m", "roll_pitch_yaw_deg"].map(|key| numbers(&rest["pose"][key]));
    let pose: Vec<String> = position.iter().chain(&angles).map(f64::to_string).collect();
    let held = json(&["statics", "-", &format!("--pose={}", pose.join(","))], fixed);

    let checked = json(&["check", "-"], driven);
    for (cable, held) in checked["cables"].as_array().unwrap().iter().zip(held["cables"].as_array().unwrap()) {
        let parts = &cable["length_parts"];
        let [to_anchor, beyond] = ["to_anchor_m", "beyond_anchor_m"].map(|key| number(&parts[key]));
        assert!((to_anchor + beyond - number(&cable["unstrained_length_m"])).abs() < 1e-12, "{cable}");
        // Directions differ by the radius over the length, 0.05 m over 7 m, and so do tensions, stretch and sag.
        assert!((to_anchor - number(&held["unstrained_length_m"])).abs() < 2e-3, "{cable}");
        assert!(beyond > 3.0 && beyond < 3.2, "drum side, and the way around the wheel: {cable}");
    }
    assert!(json(&["check", "-"], fixed)["cables"][0].get("length_parts").is_none());
}

#[test]
fn the_centre_has_a_certificate_and_a_pose_beyond_the_limits_a_proof() {
    let cogiro = robot("cogiro.toml");
    let pose = ["statics", &cogiro, "--pose", "1,1,1.5", "--tension-rule", "centre"];
    let proof = json(&pose)["centre"].clone();
    assert_eq!((&proof["unique"], number(&proof["max_curvature"])), (&Value::Bool(true), 0.5));
    assert!((0.0..0.1).contains(&number(&proof["curvature"])), "{proof}");
    assert!(proof["curvature_cable"].is_string() && proof.get("convexity_min").is_none(), "{proof}");
    let text = succeed(&pose);
    assert!(text.contains("Tensions: proved to be the only centre (curvature at most "), "{text}");
    assert!(json(&["statics", &cogiro, "--pose", "1,1,1.5"]).get("centre").is_none());

    // Two metres beyond the border: a force inwards is missing, with cables at both limits.
    let outside = run(&["statics", &cogiro, "--pose", "6.5,0,1", "--tension-rule", "centre"]);
    let message = stderr(&outside);
    assert_eq!(outside.status.code(), Some(1), "{message}");
    assert!(message.contains("; proof: even with cable") && message.contains(" at the minimum "), "{message}");
}

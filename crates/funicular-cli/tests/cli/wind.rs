//! Wind, loads along cables, and other equilibria, as a user meets them.

use super::{json, run, stderr, stdout, succeed};

const DRAG: [&str; 4] = ["--set", "materials.rope-4mm.drag_coefficient=1.2", "--set", "platform.drag_area_m2=0.2"];

#[test]
fn wind_pushes_the_platform_and_is_said() {
    let robot = "ROBOT";
    let calm = json(&["statics", robot]);
    let windy = json(&[&["statics", robot, "--wind-m-s", "8,0,0"][..], &DRAG[..]].concat());
    let x = |of: &serde_json::Value| of["pose"]["position_m"][0].as_f64().unwrap();
    assert!(x(&windy) > x(&calm) + 1e-3);
    assert_eq!(windy["wind"]["velocity_m_s"][0], 8.0);
    assert!(calm.get("wind").is_none());
    assert!(windy["warnings"].as_array().unwrap().is_empty(), "{windy}");
    let text = succeed(&[&["statics", robot, "--wind", "8,0,0"][..], &DRAG[..]].concat());
    assert!(text.contains(" m/s, air of 1.225 kg/m³"), "{text}");
    // Its modes are certified as in still air: vibration has a symmetric stiffness.
    let modes = json(&[&["modes", robot, "--below-hz", "4", "--wind-m-s", "8,0,0"][..], &DRAG[..]].concat());
    assert_eq!(modes["certified"], true);
}

#[test]
fn wind_on_ropes_without_drag_is_warned_of_and_a_hurricane_beyond_the_formula_refused() {
    let output = run(&["statics", "ROBOT", "--wind-m-s", "8,0,0"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(stderr(&output).contains("the wind does not act on cables of \"rope-4mm\""), "{}", stderr(&output));
    let output = run(&["statics", "ROBOT", "--wind-m-s", "0,200,0"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("at most 110 m/s"), "{}", stderr(&output));
    let output = run(&["statics", "ROBOT", "--set", "materials.rope-4mm.drag_diameter_m=0.01"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("no `drag_coefficient`"), "{}", stderr(&output));
}

#[test]
fn a_load_along_the_cables_makes_them_sag_and_is_refused_where_it_cannot_be_said() {
    let plain = json(&["statics", "ROBOT"]);
    let iced = json(&["statics", "ROBOT", "--cable-load-n-per-m", "0,0,-0.6"]);
    let sag = |of: &serde_json::Value| of["cables"][0]["sag_ratio"].as_f64().unwrap();
    assert!(sag(&iced) > 1.3 * sag(&plain), "{} {}", sag(&iced), sag(&plain));
    let output = run(&["export", "ROBOT", "--to", "moordyn", "--cable-load-n-per-m", "0,0,-0.6"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("along the cables"), "{}", stderr(&output));
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
    assert!(text.contains("as many with an even as with an odd number of falling directions"), "{text}");
    let csv = succeed(&["statics", "ROBOT", "--all", "--format", "csv"]);
    assert!(csv.starts_with("stable,falling_directions,"), "{csv}");
    assert_eq!(csv.lines().count(), rows.len() + 1);
    let output = run(&["statics", "ROBOT", "--all", "--static-model", "ideal"]);
    assert_eq!(output.status.code(), Some(2), "{}", stdout(&output));
}

#[test]
fn stiffness_in_wind_turns_the_drag_and_a_named_model_says_what_it_leaves_out() {
    const STRONG: [&str; 6] = [
        "--set",
        "materials.rope-4mm.drag_coefficient=1.2",
        "--set",
        "materials.rope-4mm.drag_diameter_m=0.02",
        "--wind-m-s",
        "25,0,0",
    ];
    let stiffness = |more: &[&str]| json(&[&["stiffness", "ROBOT"][..], &STRONG, more].concat());
    let entry = |of: &serde_json::Value, i: usize, j: usize| of["real"][i][j].as_f64().unwrap();
    let asymmetry = |of: &serde_json::Value| (entry(of, 0, 2) - entry(of, 2, 0)).abs();
    let whole = stiffness(&[]);
    let part = whole["antisymmetric_part"].as_f64().unwrap();
    assert!(part > 1e-4 && asymmetry(&whole) > 1e-4 * entry(&whole, 0, 0).abs(), "{whole}");
    assert!(whole["warnings"].as_array().unwrap().is_empty(), "{whole}");
    let text = succeed(&[&["stiffness", "ROBOT"][..], &STRONG].concat());
    assert!(text.contains("The drag of the wind turns with the cables: the matrix is not symmetric"), "{text}");
    assert!(text.contains(&format!("antisymmetric part is {}", &format!("{:.6}", 100.0 * part)[..3])), "{part} {text}");

    // Symmetric, with the drag held, and with a word on it.
    let held = stiffness(&["--cable-model", "catenary-tangent"]);
    assert!(held.get("antisymmetric_part").is_none() && asymmetry(&held) < 1e-6 * entry(&held, 0, 0).abs());
    assert!((entry(&held, 0, 0) - entry(&whole, 0, 0)).abs() > 1e-4 * entry(&held, 0, 0).abs());
    let warned = held["warnings"][0].as_str().unwrap();
    assert!(warned.contains("the drag of the wind turns with the cables"), "{warned}");
    assert!(warned.contains("% (rotations times the platform's size)") && warned.contains("`stiffness` at 0 Hz"));
    let modes = json(&[&["modes", "ROBOT", "--below-hz", "3"][..], &STRONG].concat());
    assert!(modes["warnings"].to_string().contains("drag of the wind turns"), "{}", modes["warnings"]);

    // Still air: nothing new is said.
    let still = json(&["stiffness", "ROBOT"]);
    assert!(still.get("antisymmetric_part").is_none() && still["warnings"].as_array().unwrap().is_empty());
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
    assert!(text.contains("No load and no tension: nothing to balance, after"), "{text}");
}

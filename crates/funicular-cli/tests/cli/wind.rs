//! Wind, loads along cables, and other equilibria, as a user meets them.

use super::{json, run, stderr, succeed};

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
    let text = succeed(&[&["statics", robot, "--wind-m-s", "8,0,0"][..], &DRAG[..]].concat());
    assert!(text.contains(" m/s, air density 1.225 kg/m³"), "{text}");
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

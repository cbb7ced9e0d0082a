//! `stiffness`: static and dynamic, with the drag of the wind.

use super::{close, json, numbers, succeed};

#[test]
fn stiffness_at_rest_is_the_symmetric_tangent_and_above_it_that_of_the_exact_cables() {
    let still = json(&["stiffness", "ROBOT"]);
    assert_eq!(still["cable_model"], "catenary-static");
    assert_eq!(still["assembly"], "consistent");
    let rows: Vec<Vec<f64>> = still["real"].as_array().unwrap().iter().map(numbers).collect();
    let imag: Vec<Vec<f64>> = still["imag"].as_array().unwrap().iter().map(numbers).collect();
    assert!(rows.len() == 6 && imag.iter().flatten().all(|k| *k == 0.0));
    for i in 0..6 {
        for j in 0..6 {
            assert!(close(rows[i][j], rows[j][i], 1e-8 * rows[0][0]));
        }
    }
    let moving = json(&["stiffness", "ROBOT", "--at-hz", "2"]);
    assert_eq!(moving["cable_model"], "catenary-dynamic");
    assert!(moving["imag"].as_array().unwrap().iter().flat_map(numbers).any(|k| k != 0.0));
    let shallow = json(&["stiffness", "ROBOT", "--cable-model", "shallow-dynamic"]);
    assert_eq!(shallow["cable_model"], "shallow-dynamic");
    assert_eq!(
        json(&["stiffness", "ROBOT", "--assembly", "without-geometric-stiffness"])["cable_model"],
        "catenary-static"
    );
    assert!(json(&["stiffness", "ROBOT", "--static-model", "spring"])["static_model"] == "spring");
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
    let part = whole["antisymmetric_fraction"].as_f64().unwrap();
    assert!(part > 1e-4 && asymmetry(&whole) > 1e-4 * entry(&whole, 0, 0).abs(), "{whole}");
    assert!(whole["warnings"].as_array().unwrap().is_empty(), "{whole}");
    let text = succeed(&[&["stiffness", "ROBOT"][..], &STRONG].concat());
    assert!(text.contains("The drag of the wind turns with the cables: the matrix is not symmetric"), "{text}");
    assert!(text.contains(&format!("antisymmetric part is {}", &format!("{:.6}", 100.0 * part)[..3])), "{part} {text}");

    // Symmetric, with the drag held, and with a word on it.
    let held = stiffness(&["--cable-model", "catenary-static"]);
    assert!(held.get("antisymmetric_fraction").is_none() && asymmetry(&held) < 1e-6 * entry(&held, 0, 0).abs());
    assert!((entry(&held, 0, 0) - entry(&whole, 0, 0)).abs() > 1e-4 * entry(&held, 0, 0).abs());
    let warned = held["warnings"][0].as_str().unwrap();
    assert!(warned.contains("the drag of the wind turns with the cables"), "{warned}");
    assert!(warned.contains("% (rotations times the platform's size)") && warned.contains("`stiffness` at 0 Hz"));
    let modes = json(&[&["modes", "ROBOT", "--below-hz", "3"][..], &STRONG].concat());
    assert!(modes["warnings"].to_string().contains("drag of the wind turns"), "{}", modes["warnings"]);

    // Still air: nothing new is said.
    let still = json(&["stiffness", "ROBOT"]);
    assert!(still.get("antisymmetric_fraction").is_none() && still["warnings"].as_array().unwrap().is_empty());
}

/// Six cables on a circle: motions are independent, up to rounding.
#[test]
fn rounding_is_printed_as_zero_and_stays_in_the_json() {
    let path = super::robot("fast.toml");
    let arguments = ["stiffness", path.as_str(), "--pose", "0,0,100"];
    let text = super::succeed(&arguments);
    assert!(text.contains("per x [m]") && text.contains("fx [N]") && !text.contains("e-"), "{text}");
    let rounding = super::json(&arguments)["real"][0][1].as_f64().unwrap();
    assert!(rounding != 0.0 && rounding.abs() < 1e-9, "{rounding}");
}

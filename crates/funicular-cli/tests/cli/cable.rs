//! `cable`: the stiffness of one cable.

use super::{close, json, number, numbers};

#[test]
fn the_stiffness_of_a_cable_is_the_same_in_its_own_and_in_world_axes() {
    for model in ["catenary-dynamic", "shallow-dynamic", "shallow-static", "spring", "catenary-static"] {
        let value = json(&[
            "cable",
            "ROBOT",
            "--name",
            "1",
            "--from-hz",
            "0",
            "--to-hz",
            "3",
            "--points",
            "4",
            "--cable-model",
            model,
        ]);
        let trace = |i: usize| {
            let world = &value["world"]["real"][i];
            (0..3).map(|k| number(&world[k][k])).sum::<f64>()
        };
        let local = |key: &str| numbers(&value["local"][key]["real"]);
        let (a, c, o) = (local("k_a"), local("k_c"), local("k_o"));
        for i in 0..4 {
            let sum = a[i] + c[i] + o[i];
            assert!(close(trace(i), sum, 1e-9 * (a[i].abs() + c[i].abs() + o[i].abs())), "{model} {i}");
        }
        assert_eq!(value["clamped_frequencies_hz"].is_array(), matches!(model, "shallow-dynamic" | "catenary-dynamic"));
    }
}

//! Derivatives of the predictions: gradients against differences.

use super::super::unknowns::unknowns;
use super::*;
use crate::request::Request;
use serde_json::{Value, json};

const ROBOT: &str = r#"
gravity_m_s2 = [0.0, 0.0, -9.81]
name = "test rig"
[platform]
mass_kg = 20.0
center_of_mass_m = [0.01, 0.02, 0.05]
inertia_kg_m2 = [0.8, 0.9, 1.2]
[loads]
force_n = [3.0, -2.0, -10.0]
[materials.rope]
youngs_modulus_pa = 20e9
diameter_m = 0.0035
mass_kg_per_m = 0.05
damping_ratio = 0.01
[[cables]]
name = "1"
material = "rope"
anchor_m = [2.0, 2.0, 3.0]
attachment_m = [0.3, 0.1, 0.1]
unstrained_length_m = 3.3
[[cables]]
name = "2"
material = "rope"
anchor_m = [2.0, -2.0, 3.0]
attachment_m = [0.3, -0.1, -0.1]
unstrained_length_m = 3.4
[[cables]]
name = "3"
material = "rope"
anchor_m = [-2.0, 2.0, 3.0]
attachment_m = [-0.3, 0.2, -0.1]
unstrained_length_m = 3.4
[[cables]]
name = "4"
material = "rope"
anchor_m = [-2.0, -2.0, 3.0]
attachment_m = [-0.3, -0.2, 0.1]
unstrained_length_m = 3.3
[[cables]]
name = "5"
material = "rope"
anchor_m = [0.0, 2.5, 3.2]
attachment_m = [0.0, 0.3, 0.0]
unstrained_length_m = 3.4
[[cables]]
name = "6"
material = "rope"
anchor_m = [2.5, 0.0, 3.2]
attachment_m = [0.2, -0.2, 0.0]
unstrained_length_m = 3.6
"#;

/// Values of every kind that an experiment may hold or change.
const FIT: [&str; 11] = [
    "platform.mass_kg",
    "platform.center_of_mass_m.x",
    "platform.inertia_kg_m2.xx",
    "materials.rope.youngs_modulus_pa",
    "materials.rope.diameter_m",
    "materials.rope.mass_kg_per_m",
    "materials.rope.damping_ratio",
    "cables.2.anchor_m.z",
    "cables.5.unstrained_length_m",
    "cables.1.attachment_m.y",
    "loads.force_n.z",
];

/// Checks the derivatives of all predictions of an experiment, away from the values of the file.
fn check(experiment: &Value, cable_model: &str, expected_equilibria: usize) {
    let fit: Vec<Value> = FIT.iter().map(|path| json!({"path": path})).collect();
    let request = json!({
        "command": "identify", "robot": {"text": ROBOT}, "fit": fit, "experiments": [experiment],
        "cable_model": cable_model,
    });
    let Ok(Request::Identify(request)) = Request::from_json(&request.to_string()) else { panic!("it is a request") };
    let parameters = Parameters::from_toml(ROBOT).unwrap();
    let unknowns = unknowns(&parameters, &request.fit).unwrap();
    let never = || false;
    let mut model = IdentifiedModel::new(&parameters, &unknowns, &request, &never).unwrap();
    // The chain of derivatives is taken at these values, not at those of the file.
    let x: Vec<f64> =
        unknowns.iter().enumerate().map(|(k, one)| one.coordinate(one.start) + 0.02 * (1.0 + k as f64).sin()).collect();

    let solved = model.solve(&x, None).unwrap();
    let before = model.evaluations;
    let columns = model.derivatives(&x, &solved).unwrap();
    assert_eq!(model.evaluations - before, expected_equilibria);

    for (k, column) in columns.iter().enumerate() {
        // The error of two differences of which one has half the step is of the fourth order in it.
        let step = 0.25 * STEP * unknowns[k].spread();
        let [coarse, fine] = [step, 0.5 * step].map(|step| model.differences(&x, 0, &solved[0], k, step).unwrap());
        let by_differences: Vec<Complex> =
            fine.iter().zip(&coarse).map(|(fine, coarse)| (fine * 4.0 - coarse) / 3.0).collect();
        assert_eq!(column.len(), by_differences.len());

        for (i, (own, other)) in column.iter().zip(&by_differences).enumerate() {
            let subject = std::mem::discriminant(&model.observations[i].subject);
            let is_alike = |of: &Observation| std::mem::discriminant(&of.subject) == subject;
            let same = by_differences.iter().zip(&model.observations).filter(|(_, observation)| is_alike(observation));
            let largest = same.fold(0.0_f64, |largest, (value, _)| largest.max(value.norm()));
            // An equilibrium that is converged to 1e-12 m leaves 1e-7 of a difference over such a step.
            let error = (own - other).norm();
            assert!(
                error <= 1e-5 * largest + 2e-7,
                "{} of observation {i}: {own} by gradients, {other} by differences",
                FIT[k]
            );
        }
    }
}

/// Response at frequencies from `from_hz` on.
fn response(output: &str, from_hz: f64) -> Value {
    let frequency_hz: Vec<f64> = (0..6).map(|i| from_hz + 1.33 * f64::from(i)).collect();
    json!({
        "input": "fz", "output": output, "input_point_m": [0.1, 0.05, 0.0], "output_point_m": [0.2, 0.1, 0.0],
        "frequency_hz": frequency_hz, "real": vec![1.0; 6], "imag": vec![0.5; 6],
    })
}

const POSE: [f64; 6] = [0.25, 0.1, 0.9, 4.0, -3.0, 6.0];

#[test]
fn gradients_are_the_differences_with_lengths_held() {
    // The signals of the second response have other frequencies and are a group of their own.
    let responses = [response("ax", 0.61), response("az", 0.8), response("vz", 0.61)];
    check(
        &json!({
            "measured_pose": POSE, "measured_tensions_n": [1.0, 2.0, 3.0, 4.0, 5.0, 6.0], "responses": responses,
        }),
        "catenary-dynamic",
        0,
    );
    let list = json!([{"frequency_hz": 2.0, "label": "3"}, {"frequency_hz": 3.0, "label": "5"}]);
    check(&json!({"frequencies": list}), "catenary-static", 0);
}

/// Values that an experiment states do not follow the file.
#[test]
fn gradients_are_the_differences_where_an_experiment_has_its_own_state() {
    check(
        &json!({
            "mass_kg": 25.0, "force_n": [0.0, 5.0, 0.0], "lengths_m": [3.3, 3.35, 3.4, 3.3, 3.45, 3.6],
            "measured_pose": POSE, "responses": [response("ax", 0.61)],
        }),
        "catenary-static",
        0,
    );
    // Five of the cables.
    check(
        &json!({
            "cables": ["1", "2", "4", "5", "6"], "measured_pose": POSE,
            "measured_tensions_n": [1.0, 2.0, 3.0, 4.0, 5.0],
        }),
        "spring",
        0,
    );
}

#[test]
fn gradients_are_the_differences_with_the_pose_held() {
    check(
        &json!({
            "pose": [0.2, 0.1, 0.9, 2.0, -3.0, 4.0], "measured_lengths_m": [3.3, 3.4, 3.4, 3.3, 3.4, 3.6],
            "frequencies": [{"frequency_hz": 2.0, "label": "2"}],
        }),
        "spring",
        0,
    );
}

/// A damping ratio to first order has no gradient: two equilibria per value.
#[test]
fn differences_replace_gradients_that_do_not_exist() {
    let list = json!([{"frequency_hz": 2.0, "label": "2", "damping_ratio": 0.01}]);
    check(&json!({"frequencies": list}), "spring", 2 * FIT.len());
}

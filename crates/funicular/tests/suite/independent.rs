//! Fourteen robots against a separate program; see the head of reference/independent.json.

use funicular::cable::{CableModel, Sag};
use funicular::dynamics::{Assembly, Dynamics, Linearisation};
use funicular::math::{Mat6, Vec3, rotation};
use funicular::modes;
use funicular::response::{self, Quantity};
use funicular::robot::{Robot, State};
use funicular::statics::{self, Equilibrium, Stability, StaticModel};
use serde_json::Value;
use std::sync::LazyLock;

static CASES: LazyLock<Vec<Value>> = LazyLock::new(|| {
    let all: Value = serde_json::from_str(include_str!("../../reference/independent.json")).unwrap();
    all["cases"].as_array().unwrap().clone()
});

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
}

fn matrix(value: &Value) -> Mat6 {
    let rows: Vec<Vec<f64>> = value.as_array().unwrap().iter().map(numbers).collect();
    Mat6::from_fn(|i, j| rows[i][j])
}

fn robot_of(case: &Value) -> (Robot, Vec<f64>) {
    let robot = Robot::from_toml(case["toml"].as_str().unwrap()).unwrap();
    let State::Lengths(lengths) = robot.state.clone() else { panic!("cases give lengths") };
    (robot, lengths)
}

fn rest(case: &Value, model: StaticModel) -> (Robot, Equilibrium) {
    let (robot, lengths) = robot_of(case);
    let rest = statics::forward(&robot, &lengths, model, None).unwrap_or_else(|e| panic!("{}: {e}", case["id"]));
    (robot, rest)
}

/// Largest difference over the largest entry, rotations scaled by ℓ.
fn difference(robot: &Robot, ours: &Mat6, theirs: &Mat6) -> f64 {
    let ell = robot.platform_length();
    let scale = |i: usize| if i < 3 { 1.0 } else { 1.0 / ell };
    let scaled = |m: &Mat6| Mat6::from_fn(|i, j| m[(i, j)] * scale(i) * scale(j));
    (scaled(ours) - scaled(theirs)).amax() / scaled(theirs).amax()
}

#[test]
fn equilibria_need_no_start_and_agree_to_nanometres() {
    for case in CASES.iter() {
        let (robot, rest) = rest(case, StaticModel::Catenary);
        let id = &case["id"];
        let expected = &case["equilibrium"];
        let position = Vec3::from_column_slice(&numbers(&expected["position_m"]));
        // Bound: strain of 1e-5 at rounding of the lengths, 1e-16/1e-5 of some metres; seen 3e-12.
        assert!((rest.pose.position_w - position).norm() < 1e-10, "{id}");
        let q = rotation::quaternion_wxyz(&rest.pose.rot_wp);
        for (ours, theirs) in q.iter().zip(numbers(&expected["quaternion_wxyz"])) {
            assert!((ours - theirs).abs() < 1e-10, "{id}: {ours} {theirs}");
        }
        assert!(rest.residual <= statics::RESIDUAL_LIMIT, "{id}: {}", rest.residual);
        assert!(matches!(rest.stability, Stability::Stable { .. }), "{id}");
        for (i, (ours, theirs)) in rest.cables.iter().zip(expected["cables"].as_array().unwrap()).enumerate() {
            let close = |a: f64, key: &str| {
                let b = theirs[key].as_f64().unwrap();
                assert!((a - b).abs() <= 1e-9 * b.abs(), "{id} cable {i} {key}: {a} {b}");
            };
            close(ours.tension_platform, "tension_platform_n");
            close(ours.tension_anchor, "tension_anchor_n");
            close(ours.chord(), "chord_m");
            let sag = Sag::of(&robot, i, ours);
            close(sag.ratio(), "sag_ratio");
            close(sag.lambda2, "lambda2");
            let force = Vec3::from_column_slice(&numbers(&theirs["force_on_platform_n"]));
            assert!((ours.force_on_platform_w - force).norm() < 1e-9 * force.norm(), "{id} cable {i}");
        }
    }
}

#[test]
fn spring_equilibria_agree_also_where_cables_go_slack() {
    for case in CASES.iter() {
        let (_, rest) = rest(case, StaticModel::Spring);
        let position = Vec3::from_column_slice(&numbers(&case["spring"]["position_m"]));
        let gap = (rest.pose.position_w - position).norm();
        assert!(gap < 1e-8, "{}: {gap:e}", case["id"]);
        for (ours, theirs) in rest.cables.iter().zip(numbers(&case["spring"]["tension_n"])) {
            assert!((ours.tension_platform - theirs).abs() < 1e-6 * theirs.max(1.0), "{}", case["id"]);
        }
    }
}

#[test]
fn static_stiffness_agrees_in_both_assemblies() {
    for case in CASES.iter() {
        let (robot, rest) = rest(case, StaticModel::Catenary);
        let consistent = statics::tangent_stiffness(&robot, &rest).unwrap();
        let gap = difference(&robot, &consistent, &matrix(&case["static_tangent_consistent"]));
        assert!(gap < 1e-9, "{} consistent: {gap:e}", case["id"]);
        let linearisation =
            Linearisation { cable_model: CableModel::CatenaryTangent, assembly: Assembly::Paper, in_plane_only: false };
        let paper = Dynamics::about(&robot, &rest, linearisation, 20.0).unwrap().stiffness(0.0).map(|k| k.re);
        let gap = difference(&robot, &paper, &matrix(&case["static_tangent_paper"]));
        assert!(gap < 1e-9, "{} paper: {gap:e}", case["id"]);
    }
}

fn closed(robot: &Robot, rest: &Equilibrium, assembly: Assembly, in_plane_only: bool) -> Dynamics {
    let linearisation = Linearisation { cable_model: CableModel::ClosedForm, assembly, in_plane_only };
    Dynamics::about(robot, rest, linearisation, 20.0).unwrap()
}

fn undamped(robot: &Robot) -> Robot {
    let mut robot = robot.clone();
    for cable in &mut robot.cables {
        cable.material.damping = funicular::robot::Damping::Ratio(0.0);
    }
    robot
}

#[test]
fn closed_form_stiffness_agrees_damped_and_undamped() {
    for case in CASES.iter() {
        let (robot, rest) = rest(case, StaticModel::Catenary);
        let omega = case["closed_form_at_hz"].as_f64().unwrap() * std::f64::consts::TAU;
        let quiet = undamped(&robot);
        for (robot, assembly, in_plane_only, key) in [
            (&quiet, Assembly::Consistent, false, "closed_form_consistent_undamped"),
            (&quiet, Assembly::Paper, false, "closed_form_paper_undamped"),
            (&quiet, Assembly::Consistent, true, "closed_form_consistent_in_plane_only_undamped"),
        ] {
            let k = closed(robot, &rest, assembly, in_plane_only).stiffness(omega).map(|k| k.re);
            let gap = difference(robot, &k, &matrix(&case[key]));
            assert!(gap < 1e-9, "{} {key}: {gap:e}", case["id"]);
        }
        let k = closed(&robot, &rest, Assembly::Consistent, false).stiffness(omega);
        let theirs = &case["closed_form_consistent_damped"];
        for (ours, key) in [(k.map(|k| k.re), "real"), (k.map(|k| k.im), "imag")] {
            let gap = difference(&robot, &ours, &matrix(&theirs[key]));
            assert!(gap < 1e-9, "{} damped {key}: {gap:e}", case["id"]);
        }
    }
}

#[test]
fn every_natural_frequency_is_found_and_none_invented() {
    for case in CASES.iter() {
        let (robot, rest) = rest(case, StaticModel::Catenary);
        for (in_plane_only, key) in [(false, "modes"), (true, "modes_in_plane_only")] {
            let dynamics = closed(&robot, &rest, Assembly::Consistent, in_plane_only);
            let found = modes::below(&dynamics, 20.0);
            let expected = numbers(&case[key]["frequencies_hz"]);
            assert!(found.certified, "{} {key}", case["id"]);
            assert_eq!(found.modes.len(), expected.len(), "{} {key}", case["id"]);
            for (mode, theirs) in found.modes.iter().zip(&expected) {
                let gap = (mode.frequency_hz / theirs - 1.0).abs();
                assert!(gap < 1e-9, "{} {key} at {theirs} Hz: {gap:e}", case["id"]);
            }
            let resting = found.modes.iter().filter(|m| m.platform_energy_fraction == 0.0).count();
            let pairs = case[key]["platform_at_rest"].as_array().unwrap();
            let expected: f64 = pairs.iter().map(|pair| numbers(pair)[1]).sum();
            assert_eq!(resting, expected as usize, "{} {key}", case["id"]);
        }
    }
}

#[test]
fn responses_agree_at_the_origin_and_between_offset_points() {
    for case in CASES.iter() {
        let (robot, rest) = rest(case, StaticModel::Catenary);
        let dynamics = closed(&robot, &rest, Assembly::Consistent, false);
        let along = |direction_w: Vec3, point_p: Vec3| response::along(&direction_w, &point_p, &rest.pose);
        let origin = Vec3::zeros();
        let compare = |theirs: &Value, frequencies: &[f64], input, output, quantity, scale: &Value| {
            let ours = response::frf(&dynamics, frequencies, &input, &output, quantity).unwrap();
            let (re, im) = (numbers(&theirs["real"]), numbers(&theirs["imag"]));
            let (sre, sim) = (numbers(&scale["real"]), numbers(&scale["imag"]));
            for (i, value) in ours.iter().enumerate() {
                let size = sre[i].hypot(sim[i]).max(re[i].hypot(im[i]));
                let gap = (value.re - re[i]).hypot(value.im - im[i]) / size;
                assert!(gap < 1e-8, "{} at {} Hz: {gap:e}", case["id"], frequencies[i]);
            }
        };
        let frf = &case["frf"];
        let frequencies = numbers(&frf["frequency_hz"]);
        for (axis, key) in [(Vec3::y(), "ay"), (Vec3::z(), "az")] {
            // ay of a symmetric robot is zero: compared with az.
            let (input, output) = (along(Vec3::z(), origin), along(axis, origin));
            compare(&frf[key], &frequencies, input, output, Quantity::Acceleration, &frf["az"]);
        }
        let offset = &case["frf_offset"];
        let vector = |key: &str| Vec3::from_column_slice(&numbers(&offset[key]));
        let input = along(vector("input_direction_w"), vector("input_point_p"));
        let output = along(vector("output_direction_w"), vector("output_point_p"));
        compare(offset, &numbers(&offset["frequency_hz"]), input, output, Quantity::Displacement, offset);
    }
}

//! The exact cable, alone and in robots, against a separate program; see the head of reference/exact.json.

use funicular::cable::CableModel;
use funicular::cable::exact::{Exact, ExactError};
use funicular::catenary::space::HangingCable;
use funicular::catenary::{Catenary, Rope};
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{Complex, Vec3};
use funicular::modes;
use funicular::response::{self, Quantity};
use funicular::robot::{Robot, State};
use funicular::statics::{self, StaticModel};
use serde_json::Value;
use std::f64::consts::TAU;
use std::sync::LazyLock;

use crate::reference;

static REFERENCE: LazyLock<Value> =
    LazyLock::new(|| serde_json::from_str(include_str!("../../reference/exact.json")).unwrap());

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
}

fn vector(value: &Value) -> Vec3 {
    Vec3::from_column_slice(&numbers(value))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

/// The cable of a case, its exact stiffness up to a frequency, and its mass per length.
fn cable(case: &Value, up_to_hz: f64) -> (HangingCable, Exact, f64) {
    let gravity = vector(&case["gravity_m_s2"]);
    let m = number(&case["mass_kg_per_m"]);
    let rope = Rope {
        unstrained_length: number(&case["unstrained_length_m"]),
        weight_per_length: m * gravity.norm(),
        axial_stiffness: number(&case["axial_stiffness_n"]),
    };
    let hanging = HangingCable::new(vector(&case["start_m"]), vector(&case["end_m"]), -gravity, rope).unwrap();
    let exact = Exact::new(&hanging.catenary, m, up_to_hz * TAU).unwrap();
    (hanging, exact, m)
}

#[test]
fn clamped_frequencies_agree_in_plane_and_out_at_any_sag() {
    for case in REFERENCE["cables"].as_array().unwrap() {
        let in_plane = numbers(&case["clamped_in_plane_hz"]);
        let across = numbers(&case["clamped_out_of_plane_hz"]);
        let (_, exact, _) = cable(case, in_plane[11].max(across[11]) * 1.01);
        assert!(exact.error < 1e-10, "{}: {:e}", case["id"], exact.error);
        for (ours, theirs) in
            exact.in_plane.poles.iter().zip(&in_plane).chain(exact.out_of_plane.poles.iter().zip(&across))
        {
            let gap = (ours.sqrt() / TAU / theirs - 1.0).abs();
            assert!(gap < 1e-9, "{} at {theirs} Hz: {gap:e}", case["id"]);
        }
    }
}

/// 3×3 blocks of a cable's end stiffness in world axes from its components (start h, v, end h, v; start b, end b).
fn block(
    hanging: &HangingCable,
    plane: impl Fn(usize, usize) -> Complex,
    across: impl Fn(usize, usize) -> Complex,
    (row, column): (usize, usize),
) -> [[Complex; 3]; 3] {
    let (h, v) = hanging.axes_w();
    let b = h.cross(&v);
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let pair = [h, v];
            let mut sum = across(row, column) * b[i] * b[j];
            for (p, u) in pair.iter().enumerate() {
                for (q, w) in pair.iter().enumerate() {
                    sum += plane(2 * row + p, 2 * column + q) * u[i] * w[j];
                }
            }
            sum
        })
    })
}

#[test]
fn both_ends_have_the_stiffness_of_transfer_matrices_undamped_and_damped() {
    for case in REFERENCE["cables"].as_array().unwrap() {
        let theirs = &case["end_stiffness"];
        let frequencies = numbers(&theirs["frequency_hz"]);
        let (hanging, exact, m) = cable(case, frequencies[frequencies.len() - 1] * 1.01);
        let (xi, c) = (number(&theirs["xi"]), number(&theirs["viscous_n_s_m2"]));
        for (k, frequency) in frequencies.iter().enumerate() {
            let omega = frequency * TAU;
            for (name, square) in [
                ("undamped", Complex::new(omega * omega, 0.0)),
                ("xi", Complex::new(omega * omega, -2.0 * xi * omega * omega)),
                ("viscous", Complex::new(omega * omega, -c * omega / m)),
            ] {
                let expected = |row: usize, column: usize| {
                    let part = |suffix: &str| number(&theirs[format!("{name}{suffix}")][k][row][column]);
                    if name == "undamped" {
                        Complex::new(part(""), 0.0)
                    } else {
                        Complex::new(part("_real"), part("_imag"))
                    }
                };
                let size = (0..6)
                    .flat_map(|r| (0..6).map(move |c| (r, c)))
                    .map(|(r, c)| expected(r, c).norm())
                    .fold(0.0, f64::max);
                for at in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    let ours = block(
                        &hanging,
                        |i, j| exact.in_plane.damped([(i, j)], square)[0],
                        |i, j| exact.out_of_plane.damped([(i, j)], square)[0],
                        at,
                    );
                    for (i, row) in ours.iter().enumerate() {
                        for (j, entry) in row.iter().enumerate() {
                            let gap = (entry - expected(3 * at.0 + i, 3 * at.1 + j)).norm() / size;
                            assert!(gap < 1e-9, "{} {name} {frequency} Hz block {at:?}: {gap:e}", case["id"]);
                        }
                    }
                }
            }
        }
    }
}

fn robot(id: &str) -> (Robot, Vec<f64>) {
    let all: Value = serde_json::from_str(include_str!("../../reference/independent.json")).unwrap();
    let cases = all["cases"].as_array().unwrap().clone();
    let case = cases.into_iter().find(|case| case["id"] == id).unwrap();
    let robot = Robot::from_toml(case["toml"].as_str().unwrap()).unwrap();
    let State::Lengths(lengths) = robot.state.clone() else { panic!("cases give lengths") };
    (robot, lengths)
}

const EXACT: Linearisation = Linearisation {
    cable_model: CableModel::Exact,
    assembly: funicular::dynamics::Assembly::Consistent,
    in_plane_only: false,
};

#[test]
fn every_exact_natural_frequency_is_found_and_none_invented() {
    for case in REFERENCE["robots"].as_array().unwrap() {
        let (robot, lengths) = robot(case["id"].as_str().unwrap());
        let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None).unwrap();
        let limit = number(&case["below_hz"]);
        let dynamics = Dynamics::about(&robot, &rest, EXACT, limit).unwrap();
        let found = modes::below(&dynamics, limit);
        let expected = numbers(&case["frequencies_hz"]);
        assert!(found.certified, "{}", case["id"]);
        assert_eq!(found.modes.len(), expected.len(), "{}", case["id"]);
        for (mode, theirs) in found.modes.iter().zip(&expected) {
            let gap = (mode.frequency_hz / theirs - 1.0).abs();
            assert!(gap < 1e-9, "{} at {theirs} Hz: {gap:e}", case["id"]);
        }
    }
}

#[test]
fn exact_responses_agree_with_the_files_damping() {
    for case in REFERENCE["robots"].as_array().unwrap() {
        let (robot, lengths) = robot(case["id"].as_str().unwrap());
        let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None).unwrap();
        let dynamics = Dynamics::about(&robot, &rest, EXACT, 20.0).unwrap();
        let z = response::along(&Vec3::z(), &Vec3::zeros(), &rest.pose);
        let frf = &case["frf"];
        let frequencies = numbers(&frf["frequency_hz"]);
        let ours = response::frf(&dynamics, &frequencies, &z, &z, Quantity::Acceleration).unwrap();
        for (i, (re, im)) in numbers(&frf["real"]).into_iter().zip(numbers(&frf["imag"])).enumerate() {
            let gap = (ours[i] - Complex::new(re, im)).norm() / re.hypot(im);
            assert!(gap < 1e-8, "{} at {} Hz: {gap:e}", case["id"], frequencies[i]);
        }
    }
}

#[test]
fn at_rest_it_is_the_catenary_taut_it_is_the_string_massless_it_is_the_spring() {
    let rope = Rope { unstrained_length: 6.9, weight_per_length: 0.657, axial_stiffness: 251_327.0 };
    let sagging = Catenary::between(5.54, 4.025, rope).unwrap();
    let exact = Exact::new(&sagging, 0.067, 20.0).unwrap();
    let [[hh, hv], [_, vv]] = sagging.tangent();
    let k = exact.undamped(0.0);
    assert_eq!([k.axial, k.coupling, k.normal].map(f64::to_bits), [hh, hv, vv].map(f64::to_bits));
    // A weightless string: transverse clamped frequencies k/(2 L0) √(C/m), C = EA T/(EA + T); axial ones with EA.
    let rope = Rope { unstrained_length: 10.0, weight_per_length: 0.0, axial_stiffness: 1e5 };
    let taut = Catenary::between(10.05, 0.0, rope).unwrap();
    let tension = taut.tension_at_start();
    let m = 0.05;
    let across = (1e5 * tension / (1e5 + tension) / m).sqrt() / 20.0;
    let string = Exact::new(&taut, m, 12.0 * across * TAU).unwrap();
    for (k, pole) in string.out_of_plane.poles.iter().take(10).enumerate() {
        let exact = (k as f64 + 1.0) * across;
        assert!((pole.sqrt() / TAU / exact - 1.0).abs() < 1e-11, "{k}");
    }
    let light = Exact::new(&taut, 1e-17, 100.0).unwrap().undamped(100.0);
    assert!(
        (light.axial / (1e5 / 10.0) - 1.0).abs() < 1e-12
            && (light.out_of_plane / (tension / 10.05) - 1.0).abs() < 1e-12
    );
}

#[test]
fn it_is_symmetric_positive_in_mass_and_passive_with_damping() {
    for case in REFERENCE["cables"].as_array().unwrap() {
        let (_, exact, m) = cable(case, 12.0);
        for i in 1..200 {
            let omega = 0.37 * f64::from(i);
            let mass = exact.moving_mass(omega);
            assert!(
                mass.axial > 0.0
                    && mass.axial * mass.normal >= mass.coupling * mass.coupling
                    && mass.out_of_plane > 0.0
            );
            for (re, im) in [(omega * omega, -0.006 * omega * omega), (omega * omega, -0.05 * omega / m)] {
                let k = exact.damped(Complex::new(re, im));
                let determinant = k.axial.im * k.normal.im - k.coupling.im * k.coupling.im;
                assert!(k.axial.im > 0.0 && k.normal.im > 0.0 && k.out_of_plane.im > 0.0, "{} {omega}", case["id"]);
                assert!(determinant > -1e-9 * k.axial.im * k.normal.im, "{} {omega}", case["id"]);
            }
        }
    }
}

#[test]
fn a_vertical_cable_is_that_of_bessel_functions() {
    // Theirs does not stretch.
    let of = |key| reference::number(reference::table("bessel_cable"), key);
    let (length, mass, gravity) = (of("length_m"), of("mass_kg_per_m"), of("gravity_m_s2"));
    assert_eq!(reference::rows("bessel_cable").len(), 3);
    for row in reference::rows("bessel_cable") {
        let tension = reference::number(row, "lower_tension_n");
        let frequencies: [f64; 3] = reference::numbers(row, "clamped_rad_per_s");
        let ea = 1e10;
        let weight = mass * gravity * length;
        let rope = Rope { unstrained_length: length, weight_per_length: mass * gravity, axial_stiffness: ea };
        let rise = length * (1.0 + (tension + 0.5 * weight) / ea);
        let cable = Catenary::between(0.0, rise, rope).unwrap();
        let exact = Exact::new(&cable, mass, 60.0).unwrap();
        for (pole, theirs) in exact.out_of_plane.poles.iter().zip(frequencies) {
            // What remains is the elasticity, T/EA.
            assert!((pole.sqrt() / theirs - 1.0).abs() < 1e-7, "{tension} N: {} for {theirs}", pole.sqrt());
        }
    }
}

#[test]
fn a_cable_without_tension_and_a_limit_out_of_reach_are_refused() {
    let slack = Rope { unstrained_length: 12.0, weight_per_length: 0.0, axial_stiffness: 1e5 };
    let cable = Catenary::between(10.0, 0.0, slack).unwrap();
    assert_eq!(Exact::new(&cable, 0.1, 10.0).unwrap_err(), ExactError::NoTension);
    let hanging = Rope { unstrained_length: 12.0, weight_per_length: 5.0, axial_stiffness: 1e5 };
    let cable = Catenary::between(0.0, 2.0, hanging).unwrap();
    assert_eq!(Exact::new(&cable, 0.1, 10.0).unwrap_err(), ExactError::NoTension);
    let cable = Catenary::between(10.0, 0.0, hanging).unwrap();
    assert!(matches!(Exact::new(&cable, 0.5, 1e5), Err(ExactError::TooFine { .. })));
}

//! Catenary-dynamic cables against limits and identities.

use crate::library::library;
use funicular::cable::catenary_dynamic::{CatenaryDynamic, CatenaryDynamicError};
use funicular::catenary::{Catenary, Rope};
use funicular::math::Complex;
use std::f64::consts::TAU;

/// Cables as span, rise, ratio of length to chord, axial stiffness [N], mass per length [kg/m]: taut, sagging, inclined
/// up and down, near the vertical, slack at one and a half times the chord.
const CABLES: [[f64; 5]; 8] = [
    [7.0, 0.0, 0.998, 251_327.0, 0.067],
    [7.0, 0.0, 1.04, 251_327.0, 0.067],
    [5.5, 4.0, 1.0008, 251_327.0, 0.067],
    [5.5, -4.0, 1.006, 251_327.0, 0.067],
    [3.5, 6.0, 1.03, 1e6, 0.27],
    [0.6, -7.0, 1.0005, 251_327.0, 0.067],
    [0.6, 7.0, 0.98, 2e4, 0.02],
    [4.0, 3.0, 1.5, 251_327.0, 0.067],
];

/// Catenary-dynamic stiffness of one of these cables up to a frequency, and its mass per length.
fn cable([span, rise, ratio, axial_stiffness, mass]: [f64; 5], up_to_hz: f64) -> (CatenaryDynamic, f64) {
    let unstrained_length = ratio * f64::hypot(span, rise);
    let rope = Rope { unstrained_length, weight_per_length: mass * 9.81, axial_stiffness };
    let catenary = Catenary::between(span, rise, rope).unwrap();
    (CatenaryDynamic::new(&catenary, mass, up_to_hz * TAU).unwrap(), mass)
}

#[test]
fn the_clamped_frequencies_do_not_depend_on_how_far_they_are_asked_for() {
    for given in CABLES {
        let ((near, _), (far, _)) = (cable(given, 6.0), cable(given, 15.0));
        assert!(near.error < 1e-10 && far.error < 1e-10, "{given:?}: {:e} {:e}", near.error, far.error);
        let below = |poles: &[f64]| poles.iter().filter(|pole| pole.sqrt() < 6.0 * TAU).count();
        for (near, far) in
            [(&near.in_plane.poles, &far.in_plane.poles), (&near.out_of_plane.poles, &far.out_of_plane.poles)]
        {
            let count = below(near);
            assert_eq!(count, below(far), "{given:?}");
            for (a, b) in near[..count].iter().zip(far) {
                assert!(((a / b).sqrt() - 1.0).abs() < 1e-9, "{given:?}: {a} {b}");
            }
        }
    }
}

#[test]
fn at_rest_it_is_the_catenary_taut_it_is_the_string_massless_it_is_the_spring() {
    let rope = Rope { unstrained_length: 6.9, weight_per_length: 0.657, axial_stiffness: 251_327.0 };
    let sagging = Catenary::between(5.54, 4.025, rope).unwrap();
    let cable = CatenaryDynamic::new(&sagging, 0.067, 20.0).unwrap();
    let [[hh, hv], [_, vv]] = sagging.tangent();
    let k = cable.undamped(0.0);
    assert_eq!([k.axial, k.coupling, k.normal].map(f64::to_bits), [hh, hv, vv].map(f64::to_bits));
    // String without weight: transverse clamped frequencies k/(2 L0) √(C/m), C = EA T/(EA + T); axial ones with EA.
    let rope = Rope { unstrained_length: 10.0, weight_per_length: 0.0, axial_stiffness: 1e5 };
    let taut = Catenary::between(10.05, 0.0, rope).unwrap();
    let tension = taut.tension_at_start();
    let m = 0.05;
    let transverse = (1e5 * tension / (1e5 + tension) / m).sqrt() / 20.0;
    let string = CatenaryDynamic::new(&taut, m, 12.0 * transverse * TAU).unwrap();
    for (k, pole) in string.out_of_plane.poles.iter().take(10).enumerate() {
        let exact = (k as f64 + 1.0) * transverse;
        assert!((pole.sqrt() / TAU / exact - 1.0).abs() < 1e-11, "{k}");
    }
    let light = CatenaryDynamic::new(&taut, 1e-17, 100.0).unwrap().undamped(100.0);
    assert!(
        (light.axial / (1e5 / 10.0) - 1.0).abs() < 1e-12
            && (light.out_of_plane / (tension / 10.05) - 1.0).abs() < 1e-12
    );
}

#[test]
fn it_is_symmetric_positive_in_mass_and_passive_with_damping() {
    for given in CABLES {
        let (of_given, m) = cable(given, 12.0);
        for i in 1..200 {
            let omega = 0.37 * f64::from(i);
            let mass = of_given.effective_mass(omega);
            assert!(
                mass.axial > 0.0
                    && mass.axial * mass.normal >= mass.coupling * mass.coupling
                    && mass.out_of_plane > 0.0
            );
            for (re, im) in [(omega * omega, -0.006 * omega * omega), (omega * omega, -0.05 * omega / m)] {
                let k = of_given.damped(Complex::new(re, im));
                let determinant = k.axial.im * k.normal.im - k.coupling.im * k.coupling.im;
                assert!(k.axial.im > 0.0 && k.normal.im > 0.0 && k.out_of_plane.im > 0.0, "{given:?} {omega}");
                assert!(determinant > -1e-9 * k.axial.im * k.normal.im, "{given:?} {omega}");
            }
        }
    }
}

#[test]
fn a_cable_without_tension_and_a_limit_out_of_reach_are_refused() {
    let slack = Rope { unstrained_length: 12.0, weight_per_length: 0.0, axial_stiffness: 1e5 };
    let cable = Catenary::between(10.0, 0.0, slack).unwrap();
    assert_eq!(CatenaryDynamic::new(&cable, 0.1, 10.0).unwrap_err(), CatenaryDynamicError::NoTension);
    let hanging = Rope { unstrained_length: 12.0, weight_per_length: 5.0, axial_stiffness: 1e5 };
    let cable = Catenary::between(0.0, 2.0, hanging).unwrap();
    assert_eq!(CatenaryDynamic::new(&cable, 0.1, 10.0).unwrap_err(), CatenaryDynamicError::NoTension);
    let cable = Catenary::between(10.0, 0.0, hanging).unwrap();
    assert!(matches!(CatenaryDynamic::new(&cable, 0.5, 1e5), Err(CatenaryDynamicError::TooFine { .. })));
}

#[test]
fn the_cables_of_the_library_need_few_functions() {
    // DESIGN.md states these numbers, for the frequencies of a report.
    let (mut usual, mut of_fast) = (Vec::new(), Vec::new());
    for (name, robot, rest) in library() {
        for (i, state) in rest.cables.iter().enumerate() {
            let mass_per_length = robot.cables[i].material.mass_per_length;
            if mass_per_length > 0.0 {
                let catenary = &state.hanging.as_ref().unwrap().catenary;
                let cable = CatenaryDynamic::new(catenary, mass_per_length, 20.0 * TAU).unwrap();
                assert!(cable.error <= 1e-11, "{name} {i}: {:e}", cable.error);
                // Nodes between elements and bubbles, per direction.
                let functions = cable.degrees.iter().sum::<usize>() - 1;
                if name.starts_with("fast") { of_fast.push(functions) } else { usual.push(functions) }
            }
        }
    }
    usual.sort_unstable();
    let range = (usual.first().copied(), usual.last().copied());
    assert_eq!((range, of_fast.iter().max()), ((Some(9), Some(72)), Some(&208)));
    assert!(usual[usual.len() / 2] < 20, "{usual:?}");
}

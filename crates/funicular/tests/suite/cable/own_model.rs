//! A cable model of one's own, through the interface alone: a taut string without sag, far end held.

use funicular::cable::catenary_dynamic::{CatenaryDynamicEnd, PoleResidue};
use funicular::cable::{CableModel, DynamicCable, EndStiffness, LocalAxes};
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::Vec3;
use funicular::modes;
use funicular::robot::{Pose, Robot, TensionLimits};
use funicular::statics::{self, CableState, StaticModel};
use std::array::from_fn;
use std::f64::consts::PI;

/// Number of clamped modes of a string. The others change the stiffness by some β⁴/N³ of T/l, which is 1e-9 of it for
/// the highest frequency of the test.
const POLES: usize = 4000;

/// Robot without gravity at a pose where its cables are taut.
fn straight_robot() -> (Robot, statics::Equilibrium) {
    let limits = TensionLimits { minimum: Some(100.0), maximum: Some(5000.0) };
    let mut robot = Robot::from_toml(funicular_robots::IPANEMA2).unwrap().with_tension_limits(limits);
    robot.gravity_w = Vec3::zeros();
    let pose = Pose::new([0.2, -0.1, 1.1], [0.0; 3]);
    let rest = statics::inverse(&robot, &pose, StaticModel::Catenary).unwrap();
    (robot, rest)
}

/// Taut string with `factor` times the tension of the cable: a spring along the chord, waves across it.
fn string(robot: &Robot, i: usize, state: &CableState, limit_hz: f64, factor: f64) -> EndStiffness {
    let (rope, chord) = (&robot.cables[i].material, state.chord());
    let axes = LocalAxes::of_chord(&state.attachment_w, &state.anchor_w, &Vec3::z());
    let tension = factor * state.tension_platform;
    let mass = rope.mass_per_length * state.unstrained_length / chord;
    let spring = rope.axial_stiffness / state.unstrained_length;

    // Linear motion between the ends, and the modes of the clamped string.
    let held = [[1.0, -1.0], [-1.0, 1.0]].map(|row: [f64; 2]| row.map(|entry| entry * tension / chord));
    let moved = [[2.0, 1.0], [1.0, 2.0]].map(|row: [f64; 2]| row.map(|entry| entry * mass * chord / 6.0));
    let number = |k: usize| (k + 1) as f64;
    let poles: Vec<f64> = (0..POLES).map(|k| (number(k) * PI / chord).powi(2) * tension / mass).collect();
    let ends = |k: usize| {
        let size = (2.0 * mass * chord).sqrt() / (number(k) * PI);
        [size, if k.is_multiple_of(2) { size } else { -size }]
    };

    let across = |matrix: [[f64; 2]; 2], along: f64| -> [[f64; 4]; 4] {
        from_fn(|r| {
            from_fn(|c| match (r % 2, c % 2) {
                (0, 0) => {
                    if r == c {
                        along
                    } else {
                        -along
                    }
                }
                (1, 1) => matrix[r / 2][c / 2],
                _ => 0.0,
            })
        })
    };
    let in_plane = PoleResidue::new(
        across(held, spring),
        across(moved, 0.0),
        poles.clone(),
        (0..POLES).map(|k| [0.0, ends(k)[0], 0.0, ends(k)[1]]).collect(),
    );
    let out_of_plane = PoleResidue::new(held, moved, poles, (0..POLES).map(ends).collect());
    let end = CatenaryDynamicEnd::of_families(axes, in_plane, out_of_plane, (mass, rope.damping), limit_hz);
    EndStiffness::Dynamic(DynamicCable::CatenaryDynamic(Box::new(end)))
}

/// Natural frequencies below a limit with strings of `factor` times the tension, and their certificate.
fn with_strings(limit_hz: f64, factor: f64) -> (Vec<f64>, bool) {
    let (robot, rest) = straight_robot();
    let dynamics = Dynamics::of_ends(&robot, &rest, Linearisation::default(), |i, state| {
        Ok(string(&robot, i, state, limit_hz, factor))
    })
    .unwrap();
    let found = modes::below(&dynamics, limit_hz);
    (found.modes.iter().map(|mode| mode.frequency_hz).collect(), found.certified)
}

/// Without load the shallow span is a string in closed form.
#[test]
fn a_string_by_poles_vibrates_as_the_closed_form_of_a_span_without_sag() {
    const LIMIT_HZ: f64 = 60.0;
    let (robot, rest) = straight_robot();
    let shallow = Linearisation { cable_model: CableModel::ShallowDynamic, ..Linearisation::default() };
    let dynamics = Dynamics::about(&robot, &rest, shallow, LIMIT_HZ).unwrap();
    let expected: Vec<f64> = modes::below(&dynamics, LIMIT_HZ).modes.iter().map(|mode| mode.frequency_hz).collect();
    let (found, is_certified) = with_strings(LIMIT_HZ, 1.0);
    assert!(is_certified && found.len() == expected.len() && found.len() > 20, "{} {}", found.len(), expected.len());
    for (a, b) in found.iter().zip(&expected) {
        assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
    }

    // A tension that is 1 % larger is seen.
    let (other, _) = with_strings(LIMIT_HZ, 1.01);
    assert!(other.iter().zip(&expected).any(|(a, b)| (a / b - 1.0).abs() > 1e-3));
}

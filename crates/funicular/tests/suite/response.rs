//! Frequency responses: the vector kernel against plain elimination, and the physics against identities.

mod adaptive;

use funicular::cable::CableModel;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{Complex, Vec3, Vec6};
use funicular::response::{self, Port, Quantity, ResponseError, Signal};
use funicular::robot::{Damping, Robot, State, StretchLoss, WinchMode};
use funicular::statics::{self, Equilibrium, StaticModel};
use std::f64::consts::TAU;

fn load(text: &str) -> (Robot, Equilibrium) {
    let robot = Robot::from_toml(text).unwrap();
    let State::Lengths(lengths) = robot.state.clone() else { panic!("given by lengths") };
    let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None).unwrap();
    (robot, rest)
}

const ROBOTS: [&str; 4] = [
    funicular_robots::YUAN2014_4MM,
    funicular_robots::YUAN2014_8MM,
    funicular_robots::COGIRO,
    funicular_robots::SAP2000_8_CABLE_POINT_MASS,
];

#[test]
fn the_vector_kernel_equals_plain_elimination() {
    // 0 Hz, the series near 0 Hz, single lanes at the end of a block, damping beyond the range of the fast functions.
    let frequencies: Vec<f64> = (0..1003).map(|i| 0.03 * f64::from(i)).collect();
    for text in ROBOTS {
        let (robot, rest) = load(text);
        let lossless = StretchLoss::default();
        let cases = [
            (Damping::Ratio(0.003), lossless),
            (Damping::Ratio(0.3), lossless),
            (Damping::Viscous(0.02), StretchLoss { factor: 0.05, time: 1e-3 }),
            (Damping::Viscous(3.0), lossless),
        ];
        for (damping, loss) in cases {
            let mut robot = robot.clone();
            for cable in &mut robot.cables {
                (cable.material.damping, cable.material.stretch_loss) = (damping, loss);
            }
            for cable_model in CableModel::ALL {
                for in_plane_only in [false, true] {
                    let linearisation = Linearisation { cable_model, in_plane_only, ..Default::default() };
                    let dynamics = Dynamics::about(&robot, &rest, linearisation, 20.0).unwrap();
                    let fast = response::receptances(&dynamics, &frequencies).unwrap();
                    let (input, output) =
                        (Vec6::new(1.0, 0.2, -0.3, 0.1, 0.4, 0.0), Vec6::new(0.0, 0.3, 1.0, 0.0, -0.2, 0.1));
                    let one = response::frf(&dynamics, &frequencies, &input, &output, Quantity::Displacement).unwrap();
                    for (i, frequency) in frequencies.iter().enumerate() {
                        let plain = response::receptance(&dynamics, frequency * TAU);
                        let gap = (fast[i] - plain).norm() / plain.norm();
                        // Elimination without pivoting may lose six of sixteen digits (see the kernel).
                        assert!(gap < 1e-9, "{} {damping:?} {cable_model} {frequency} Hz: {gap:e}", robot.name);
                        let wanted: Complex = (0..6)
                            .flat_map(|r| (0..6).map(move |c| (r, c)))
                            .map(|(r, c)| plain[(r, c)] * (output[r] * input[c]))
                            .sum();
                        assert!((one[i] - wanted).norm() < 1e-9 * plain.norm(), "{frequency} Hz");
                    }
                }
            }
        }
    }
}

#[test]
fn at_rest_the_response_is_the_compliance_and_far_up_it_is_the_mass() {
    let (robot, rest) = load(ROBOTS[0]);
    let linearisation = Linearisation { cable_model: CableModel::CatenaryStatic, ..Default::default() };
    let dynamics = Dynamics::about(&robot, &rest, linearisation, 20.0).unwrap();
    let compliance = statics::tangent_stiffness(&robot, &rest).unwrap().try_inverse().unwrap();
    let still = response::receptances(&dynamics, &[0.0]).unwrap()[0].map(|z| z.re);
    assert!((still - compliance).amax() < 1e-10 * compliance.amax());
    let z = response::along(&Vec3::z(), &Vec3::zeros(), &rest.pose);
    let fast = response::frf(&dynamics, &[1e5], &z, &z, Quantity::Acceleration).unwrap()[0];
    assert!((fast.re * robot.platform.mass - 1.0).abs() < 1e-6, "accelerance tends to 1/m");
}

#[test]
fn reciprocity_and_positive_power_hold_between_any_two_points() {
    let (robot, rest) = load(ROBOTS[1]);
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 20.0).unwrap();
    let frequencies: Vec<f64> = (1..500).map(|i| 0.04 * f64::from(i)).collect();
    let a = response::along(&Vec3::new(1.0, 2.0, -0.5), &Vec3::new(0.1, 0.0, 0.3), &rest.pose);
    let b = response::about(&Vec3::new(0.0, 3.0, 1.0));
    let there = response::frf(&dynamics, &frequencies, &a, &b, Quantity::Velocity).unwrap();
    let back = response::frf(&dynamics, &frequencies, &b, &a, Quantity::Velocity).unwrap();
    let own = response::frf(&dynamics, &frequencies, &a, &a, Quantity::Velocity).unwrap();
    for i in 0..frequencies.len() {
        assert!((there[i] - back[i]).norm() < 1e-9 * there[i].norm());
        assert!(own[i].re > 0.0, "a damped robot takes power from a force at {} Hz", frequencies[i]);
    }
}

#[test]
fn velocity_and_acceleration_are_the_derivatives_of_displacement() {
    let (robot, rest) = load(ROBOTS[2]);
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 20.0).unwrap();
    let u = response::along(&Vec3::x(), &Vec3::zeros(), &rest.pose);
    let f = 3.7;
    let [x, v, a] = [Quantity::Displacement, Quantity::Velocity, Quantity::Acceleration]
        .map(|quantity| response::frf(&dynamics, &[f], &u, &u, quantity).unwrap()[0]);
    let omega = Complex::new(0.0, TAU * f);
    assert!((v - x * omega).norm() < 1e-15 * v.norm() && (a - x * omega * omega).norm() < 1e-14 * a.norm());
}

#[test]
fn a_free_direction_without_stiffness_is_an_error_not_infinity() {
    let (mut robot, rest) = load(ROBOTS[0]);
    // Springs without stiffness: nothing resists at 0 Hz.
    for cable in &mut robot.cables {
        cable.material.axial_stiffness = 1e-12;
    }
    let linearisation = Linearisation {
        cable_model: CableModel::Spring,
        assembly: funicular::dynamics::Assembly::WithoutGeometricStiffness,
        in_plane_only: false,
        winches: WinchMode::AsGiven,
    };
    let mut dynamics = Dynamics::about(&robot, &rest, linearisation, 20.0).unwrap();
    let u = Vec6::new(0.0, 0.0, 1.0, 0.0, 0.0, 0.0);
    assert!(response::frf(&dynamics, &[0.0], &u, &u, Quantity::Displacement).unwrap()[0].norm() > 1e10);
    let slack = {
        let mut state = rest.clone();
        for cable in &mut state.cables {
            cable.tension_platform = 0.0;
            cable.hanging = None;
        }
        state
    };
    dynamics = Dynamics::about(&robot, &slack, linearisation, 20.0).unwrap();
    let refused = response::frf(&dynamics, &[0.0, 1.0], &u, &u, Quantity::Displacement);
    assert_eq!(refused.unwrap_err(), ResponseError::Resonance { frequency_hz: 0.0 });
}

#[test]
fn responses_of_several_pairs_are_those_of_each_pair_to_the_last_digit() {
    let (robot, rest) = load(ROBOTS[0]);
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 20.0).unwrap();
    let frequencies: Vec<f64> = (0..203).map(|i| 0.03 * f64::from(i)).collect();
    let along = |direction_w| Signal::Along { direction_w, point_p: Vec3::new(0.1, -0.2, 0.05) };
    let on_cable = |fraction| Signal::OnCable { cable: 2, fraction, direction_w: Vec3::new(0.0, 0.3, 1.0) };
    let signals =
        [along(Vec3::x()), along(Vec3::z()), Signal::About { axis_w: Vec3::y() }, on_cable(0.4), on_cable(0.7)];
    let ports = Port::all(&robot, &rest, &dynamics, &signals, true).unwrap();
    let quantities = [Quantity::Displacement, Quantity::Velocity, Quantity::Acceleration];

    // Ports on the platform alone, and with ports on a cable, which also moves by itself.
    for inputs in [&ports[..2], &ports[1..]] {
        for outputs in [&ports[..3], &ports[2..]] {
            let outputs: Vec<(Port, Quantity)> = outputs.iter().cloned().zip(quantities).collect();
            let rows = response::matrix(&dynamics, &frequencies, inputs, &outputs).unwrap();
            assert_eq!(rows.len(), inputs.len() * outputs.len());
            let pairs = outputs.iter().flat_map(|output| inputs.iter().map(move |input| (input, output)));
            for (row, (input, (output, quantity))) in rows.iter().zip(pairs) {
                let one = response::between(&dynamics, &frequencies, input, output, *quantity).unwrap();
                assert_eq!(row, &one);
            }
        }
    }
}

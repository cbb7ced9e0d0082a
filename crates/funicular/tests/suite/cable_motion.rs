//! Points along the cables: forces on them, and the contribution of a mode to their responses.

use crate::library::{at_rest, independent_robot};
use funicular::cable::CableModel;
use funicular::cable_motion::CableStations;
use funicular::dynamics::{Assembly, Dynamics, Linearisation};
use funicular::math::Vec3;
use funicular::modes;
use funicular::response::{self, Port, Quantity, Signal};
use funicular::robot::{Damping, WinchMode};

const EXACT: Linearisation = Linearisation {
    cable_model: CableModel::CatenaryDynamic,
    assembly: Assembly::Consistent,
    in_plane_only: false,
    winches: WinchMode::AsGiven,
};

#[test]
fn a_force_on_a_cable_that_the_model_does_not_know_is_refused() {
    let robot = independent_robot("insa-4mm-10.55kg");
    let rest = at_rest(&robot);
    let closed = Linearisation { cable_model: CableModel::ShallowDynamic, ..EXACT };
    let dynamics = Dynamics::about(&robot, &rest, closed, 5.0).unwrap();
    let refused = CableStations::new(&robot, &rest, &dynamics, 0, &[0.5], false).unwrap_err();
    assert!(refused.to_string().contains("needs the model `catenary-dynamic`"), "{refused}");
    let dynamics = Dynamics::about(&robot, &rest, EXACT, 5.0).unwrap();
    let middle = Signal::OnCable { cable: 0, fraction: 0.5, direction_w: Vec3::z() };
    let make = || Port::all(&robot, &rest, &dynamics, &[middle], true).unwrap().remove(0);
    let (one, apart) = (make(), make());
    let between = |a, b| response::between(&dynamics, &[1.0], a, b, Quantity::Displacement);
    assert!(between(&one, &one).is_ok());
    assert_eq!(between(&one, &apart).unwrap_err(), response::ResponseError::SameCable);
}

#[test]
fn what_a_mode_adds_to_a_response_is_its_residue() {
    // Near a natural frequency without damping, (ω_n² − ω²) X tends to the product of the mode's motions at both ports
    // over the modal mass; also if a cable's pole is so near that its amplitude is a separate unknown.
    let mut robot = independent_robot("insa-4mm-10.55kg");
    for cable in &mut robot.cables {
        cable.material.damping = Damping::Ratio(0.0);
    }
    let rest = at_rest(&robot);
    let dynamics = Dynamics::about(&robot, &rest, EXACT, 12.0).unwrap();
    let found = modes::below(&dynamics, 10.0);
    let z = Signal::Along { direction_w: Vec3::z(), point_p: Vec3::zeros() };
    let on = |cable, fraction, direction_w| Signal::OnCable { cable, fraction, direction_w };
    let pairs = [
        [z, z],
        [z, on(2, 0.37, Vec3::x())],
        [on(2, 0.8, Vec3::y()), on(4, 0.25, Vec3::z())],
        [on(2, 0.8, Vec3::y()), on(2, 0.37, Vec3::x())],
    ];
    let pairs = pairs.map(|signals| {
        let mut ports = Port::all(&robot, &rest, &dynamics, &signals, true).unwrap();
        (ports.remove(0), ports.remove(0))
    });
    let residue = |(input, output): &(Port, Port), mode: &modes::Mode| {
        [&input, &output].iter().map(|port| port.in_mode(&dynamics, mode).unwrap()).product::<f64>() / mode.modal_mass
    };
    let largest = pairs.each_ref().map(|pair| found.modes.iter().map(|m| residue(pair, m).abs()).fold(0.0, f64::max));
    let mut beside_poles = 0;
    for (i, mode) in found.modes.iter().enumerate() {
        let gap = |j: usize| found.modes.get(j).map_or(1.0, |m| (m.frequency_hz / mode.frequency_hz - 1.0).abs());
        let gap = gap(i + 1).min(if i > 0 { gap(i - 1) } else { 1.0 });
        let pole = dynamics.clamped_frequencies_below(75.0).into_iter().map(|(pole, _)| pole / std::f64::consts::TAU);
        let to_pole = pole.map(|pole| (pole / mode.frequency_hz - 1.0).abs()).fold(1.0, f64::min);
        if gap < 1e-4 {
            continue;
        }
        beside_poles += usize::from(to_pole < 4e-4);
        let beside = mode.frequency_hz * (1.0 + 1e-5 * gap);
        let square = |hz: f64| (hz * std::f64::consts::TAU).powi(2);
        let distance = square(mode.frequency_hz) - square(beside);
        for (pair, largest) in pairs.iter().zip(largest) {
            let response =
                response::between(&dynamics, &[beside], &pair.0, &pair.1, Quantity::Displacement).unwrap()[0];
            let residue = residue(pair, mode);
            // A neighbouring mode at the distance `gap` contributes 1e-5 of its residue.
            let off = (response.re * distance - residue).abs();
            assert!(off < 1e-3 * residue.abs() + 3e-5 * largest, "mode {i}: {off:e} of {residue}");
        }
    }
    assert!(beside_poles > 3, "{beside_poles} modes lie beside a pole");
}

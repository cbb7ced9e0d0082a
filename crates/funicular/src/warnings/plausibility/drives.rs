//! Plausibility of pulleys and winches: sizes, inertias, stiffness and control.

use super::{Implausible, likely, outside, usual};
use crate::robot::{Control, GuideWheel, Pulley, Robot, Winch};
use std::f64::consts::TAU;

/// Warnings about all pulleys and winches, each named once.
pub(super) fn check(robot: &Robot) -> Vec<Implausible> {
    let mut found: Vec<Implausible> = Vec::new();
    for cable in &robot.cables {
        let of_pulley = cable.anchor.pulley.iter().flat_map(pulley);
        let of_winch = cable.anchor.winch.iter().flat_map(|of| winch(of, cable.material.axial_stiffness));
        for warning in of_pulley.chain(of_winch) {
            if !found.contains(&warning) {
                found.push(warning);
            }
        }
    }
    found
}

fn pulley(pulley: &Pulley) -> Vec<Implausible> {
    let named = |quantity: &str| format!("pulley \"{}\": {quantity}", pulley.name);
    let lengths: &[(f64, &str)] = &[(1e-3, "radius in mm given as m"), (1e-2, "radius in cm given as m")];
    let radius =
        outside(named("radius"), pulley.radius, "m", usual::PULLEY_RADIUS, |value| likely(value, [0.01, 0.5], lengths));

    // A radius in a wrong unit makes the masses at the cable wrong as well.
    let at_cable = |what: &str, inertia: f64| {
        let mass = inertia / (pulley.radius * pulley.radius);
        let what = named(&format!("{what} over the square of the radius"));
        (radius.is_none() && inertia > 0.0).then(|| outside(what, mass, "kg", usual::WHEEL_MASS, inertia_slip))?
    };
    let inertias = [at_cable("inertia", pulley.inertia), at_cable("swivel inertia", pulley.swivel_inertia)];
    radius.clone().into_iter().chain(inertias.into_iter().flatten()).collect()
}

fn inertia_slip(value: f64) -> String {
    let slips: &[(f64, &str)] = &[
        (1e-4, "inertia in kg cm² given as kg m²"),
        (1e-6, "inertia in kg mm² given as kg m²"),
        (1e-7, "inertia in g cm² given as kg m²"),
    ];
    likely(value, [0.01, 50.0], slips)
}

fn winch(winch: &Winch, axial_stiffness: f64) -> Vec<Implausible> {
    let named = |quantity: &str| format!("winch \"{}\": {quantity}", winch.name);

    let lengths: &[(f64, &str)] = &[(1e-3, "length in mm given as m")];
    let drum_side = outside(named("drum side"), winch.drum_side_length, "m", usual::DRUM_SIDE, |value| {
        likely(value, [0.05, 100.0], lengths)
    });

    let mass = winch.drum_mass + winch.motor_mass;
    let inertia = if mass > 0.0 {
        outside(named("inertia of drum and motor at the cable"), mass, "kg", usual::WINCH_MASS, |value| {
            let slips: &[(f64, &str)] = &[
                (1e-4, "inertia in kg cm² given as kg m²"),
                (1e-6, "inertia in kg mm² given as kg m², or radius of the drum in km"),
                (1e6, "radius of the drum in mm given as m"),
                (1e4, "radius of the drum in cm given as m"),
            ];
            likely(value, [0.1, 1e3], slips)
        })
    } else {
        None
    };

    let stiffness = outside(
        named("axial stiffness of the cable over that of the winch"),
        axial_stiffness / winch.stiffness,
        "m",
        usual::LENGTH_OF_WINCH,
        |value| {
            likely(
                value,
                [0.0, 50.0],
                &[(1e-3, "stiffness in kN/m given as N/m"), (1e-6, "stiffness in MN/m given as N/m")],
            )
        },
    );

    let guide_wheel = |wheel: &GuideWheel| {
        let what = format!("guide wheel \"{}\": inertia over the square of the radius", wheel.name);
        (wheel.mass > 0.0).then(|| outside(what, wheel.mass, "kg", usual::WHEEL_MASS, inertia_slip))?
    };
    let guide_wheels = winch.guide_wheels.iter().map(guide_wheel);

    // The mass decides the bandwidth: a wrong one has its own warning.
    let control = if inertia.is_none() && mass > 0.0 { control(winch, mass) } else { Vec::new() };
    [drum_side, inertia, stiffness].into_iter().chain(guide_wheels).chain(control).flatten().collect()
}

/// Implausible values of the position control of a winch whose drum and motor have a mass at the cable [kg].
fn control(winch: &Winch, mass: f64) -> Vec<Option<Implausible>> {
    let Control::Position(servo) = &winch.control else { return Vec::new() };
    let named = |quantity: &str| format!("winch \"{}\": {quantity} of its control", winch.name);

    let omega = (servo.position_gain / mass).sqrt();
    let bandwidth = outside(named("bandwidth"), omega / TAU, "Hz", usual::BANDWIDTH, |value| {
        let slips = [(1.0 / TAU, "bandwidth in rad/s given as Hz"), (1e-3, "gain in N mm given as N m")];
        likely(value, [0.5, 50.0], &slips)
    });

    let ratio = servo.speed_gain / (2.0 * mass * omega);
    let damping = outside(named("damping ratio"), ratio, "", usual::CONTROL_DAMPING, |value| {
        likely(value, [0.2, 2.0], &[(1e-2, "damping ratio in per cent given as a fraction")])
    });

    let delay = outside(named("delay"), servo.delay, "s", usual::DELAY, |value| {
        likely(value, [1e-4, 0.03], &[(1e-3, "delay in ms given as s")])
    });
    vec![bandwidth, damping, delay]
}

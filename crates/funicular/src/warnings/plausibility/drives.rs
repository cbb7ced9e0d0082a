//! Plausibility of pulleys and winches: sizes, inertias, stiffness and control, against the cable and the platform.

use super::geometry::lengths;
use super::{Implausible, Outlier, SOME_SLIP, likely, outside, usual};
use crate::robot::{Cable, Control, GuideWheel, Pulley, PulleyFriction, Robot, Winch};
use std::f64::consts::{PI, TAU};

/// Sizes with which a drive is compared.
#[derive(Clone, Copy)]
struct Scale {
    /// Mass of the platform [kg], and its weight [N].
    platform: f64,
    weight: f64,
    /// Longest cable [m]; `None` if the lengths are unknown or wrong themselves.
    longest: Option<f64>,
    /// Diameter of the rope, or the largest that a rope of its mass can have [m]; `None` without both.
    diameter: Option<f64>,
    /// Axial stiffness of the cable [N].
    axial_stiffness: f64,
}

impl Scale {
    fn of(robot: &Robot, cable: &Cable, geometry_fits: bool) -> Self {
        let longest = lengths(robot).into_iter().fold(0.0, f64::max);
        let rope = &cable.material;
        let of_mass = (rope.mass_per_length > 0.0).then(|| rope.mass_per_length / usual::DENSITY[0]);
        let area = rope.dimensions.section.map(|section| section.area()).or(of_mass);
        Self {
            platform: robot.platform.mass,
            weight: robot.platform.mass * robot.gravity_w.norm(),
            longest: Some(longest).filter(|longest| geometry_fits && *longest > 0.0),
            diameter: area.map(|area| (4.0 * area / PI).sqrt()),
            axial_stiffness: rope.axial_stiffness,
        }
    }
}

/// Warnings about all pulleys and winches, each named once; those that compare them with lengths only if the geometry
/// fits.
pub(super) fn check(robot: &Robot, geometry_fits: bool) -> Vec<Implausible> {
    let (mut found, mut pulleys, mut winches) = (Vec::new(), Vec::new(), Vec::new());
    for cable in &robot.cables {
        let scale = Scale::of(robot, cable, geometry_fits);
        if let Some(of) = cable.anchor.pulley.as_ref().filter(|of| !pulleys.contains(&of.name)) {
            let warnings = pulley(of, scale);
            pulleys.extend((!warnings.is_empty()).then(|| of.name.clone()));
            found.extend(warnings);
        }
        if let Some(of) = cable.anchor.winch.as_ref().filter(|of| !winches.contains(&of.name)) {
            let warnings = winch(of, scale);
            winches.extend((!warnings.is_empty()).then(|| of.name.clone()));
            found.extend(warnings);
        }
    }
    found
}

/// Radius of a pulley or drum, named `what`: by itself, against the rope and against the longest cable.
fn radius(what: &str, radius: f64, scale: Scale) -> Option<Implausible> {
    let lengths: &[(f64, &str)] =
        &[(1e-3, "radius in mm given as m"), (1e-2, "radius in cm given as m"), (1e3, "radius in km given as m")];
    let against = |of: &str, length: Option<f64>, range, inner| {
        outside(format!("{what} over {of}"), radius / length?, "", range, |value| likely(value, inner, lengths))
    };
    let alone = || outside(what, radius, "m", usual::PULLEY_RADIUS, |value| likely(value, [0.01, 0.5], lengths));
    let rope = || against("the diameter of the rope", scale.diameter, usual::RADIUS_OVER_ROPE, [3.0, 100.0]);
    let cable = || against("the longest cable", scale.longest, usual::RADIUS_OVER_CABLE, [1e-4, 0.05]);
    alone().or_else(rope).or_else(cable)
}

/// Inertia of a wheel, named `what`, over that of a steel disc of its radius that is as thick as the radius.
fn inertia(what: &str, inertia: f64, radius: f64, range: [f64; 2]) -> Option<Implausible> {
    if inertia == 0.0 {
        return None;
    }
    let disc = 0.5 * PI * usual::STEEL_DENSITY * radius.powi(5);
    let what = format!("{what} over that of a steel disc of its radius, as thick as the radius,");
    outside(what, inertia / disc, "", range, |value| likely(value, [1e-3, 0.5 * range[1]], INERTIA_SLIPS))
}

/// Slips of the unit of an inertia that is too large.
const INERTIA_SLIPS: &[(f64, &str)] = &[
    (1e-3, "inertia in g m² given as kg m²"),
    (1e-4, "inertia in kg cm² given as kg m²"),
    (1e-6, "inertia in kg mm² given as kg m²"),
    (1e-7, "inertia in g cm² given as kg m²"),
];

fn pulley(pulley: &Pulley, scale: Scale) -> Vec<Implausible> {
    let named = |quantity: &str| format!("pulley \"{}\": {quantity}", pulley.name);
    let of_friction = friction(pulley);
    let of_radius = radius(&named("radius"), pulley.radius, scale);
    if of_radius.is_some() {
        // A radius in a wrong unit makes everything that is compared with it wrong as well.
        return of_radius.into_iter().chain(of_friction).collect();
    }

    let at_cable = |what: &str, inertia: f64| {
        let mass = inertia / (pulley.radius * pulley.radius);
        let what = named(&format!("{what} over the square of the radius"));
        (inertia > 0.0).then(|| outside(what, mass, "kg", usual::WHEEL_MASS, inertia_slip))?
    };
    let of = |what: &str, number: f64, range: [f64; 2]| {
        inertia(&named(what), number, pulley.radius, range).or_else(|| at_cable(what, number))
    };
    let inertias = [
        of("inertia", pulley.inertia, usual::WHEEL_OVER_DISC),
        of("swivel inertia", pulley.swivel_inertia, usual::DRUM_OVER_DISC),
    ];
    inertias.into_iter().flatten().chain(of_friction).collect()
}

fn friction(pulley: &Pulley) -> Option<Implausible> {
    let Some(PulleyFriction::Efficiency(efficiency)) = pulley.friction else { return None };
    let what = format!("pulley \"{}\": efficiency", pulley.name);
    outside(what, efficiency, "", usual::EFFICIENCY, |_| {
        "the loss given as efficiency, or per cent divided by 100 once more? A wheel has 0.9 to 0.99".to_owned()
    })
}

fn inertia_slip(value: Outlier) -> String {
    likely(value, [0.01, 50.0], INERTIA_SLIPS)
}

fn winch(winch: &Winch, scale: Scale) -> Vec<Implausible> {
    let named = |quantity: &str| format!("winch \"{}\": {quantity}", winch.name);

    // A radius or a gear ratio that is wrong makes the numbers at the cable wrong as well.
    let ratio = outside(named("gear ratio"), winch.gear_ratio, "", usual::GEAR_RATIO, |value| {
        if value.is_too_large() {
            SOME_SLIP.to_owned()
        } else {
            "turns of the drum per turn of the motor? It is turns of the motor per turn of the drum".to_owned()
        }
    });
    let of_radius = winch.drum_radius.and_then(|drum| radius(&named("radius of the drum"), drum, scale));
    let at_axis: Vec<Implausible> = of_radius.into_iter().chain(ratio).collect();
    let mass = winch.drum_mass + winch.motor_mass;
    let at_cable = if at_axis.is_empty() { at_cable(winch, mass, scale) } else { at_axis };

    let guide_wheel = |wheel: &GuideWheel| {
        let named =
            |quantity: &str| format!("guide wheel \"{}\": inertia over the square of the radius{quantity}", wheel.name);
        let alone = outside(named(""), wheel.mass, "kg", usual::WHEEL_MASS, inertia_slip);
        let over = || {
            let what = named(", over the mass of the platform,");
            outside(what, wheel.mass / scale.platform, "", usual::WHEEL_OVER_PLATFORM, inertia_slip)
        };
        (wheel.mass > 0.0).then(|| alone.or_else(over))?
    };
    let guide_wheels = winch.guide_wheels.iter().filter_map(guide_wheel);
    [drum_side(winch, scale), stiffness(winch, scale)]
        .into_iter()
        .flatten()
        .chain(at_cable)
        .chain(guide_wheels)
        .chain(limits(winch, scale))
        .collect()
}

/// Efficiency of the gear and limits of a winch.
fn limits(winch: &Winch, scale: Scale) -> impl Iterator<Item = Implausible> + use<> {
    let named = |quantity: &str| format!("winch \"{}\": {quantity}", winch.name);
    let limits = &winch.limits;
    let given = |limit: f64| limit.is_finite().then_some(limit);
    let over_weight = |number: f64| (scale.weight > 0.0).then(|| number / scale.weight);

    let efficiency =
        outside(named("efficiency of the gear"), winch.gear_efficiency, "", usual::GEAR_EFFICIENCY, |_| {
            "the loss given as efficiency, or per cent divided by 100 once more? A gear has 0.4 to 0.99".to_owned()
        });
    let speed = given(limits.speed).and_then(|speed| {
        outside(named("largest speed"), speed, "m/s", usual::CABLE_SPEED, |value| {
            likely(value, [0.01, 20.0], &[(1e-3, "speed in mm/s given as m/s"), (1e3, "speed in km/s given as m/s")])
        })
    });
    let acceleration = given(limits.acceleration).and_then(|acceleration| {
        outside(named("largest acceleration"), acceleration, "m/s²", usual::CABLE_ACCELERATION, |value| {
            likely(value, [0.01, 500.0], &[(1e-3, "acceleration in mm/s² given as m/s²")])
        })
    });

    let largest_torque = limits.torque_speed.iter().map(|[_, torque]| *torque).reduce(f64::max);
    let torque = largest_torque.map_or(limits.torque, |of_curve| of_curve.min(limits.torque));
    let torque = winch.drum_radius.zip(given(torque)).and_then(|(radius, torque)| {
        let what = named("force of the largest torque at the cable, over the weight of the platform,");
        let force = torque * winch.gear_ratio / radius;
        outside(what, over_weight(force)?, "", usual::MOTOR_OVER_WEIGHT, |value| {
            let slips = [
                (1e-3, "torque in N mm given as N m"),
                (1e-2, "torque in N cm given as N m"),
                (1e3, "torque in kN m given as N m"),
            ];
            likely(value, [0.1, 50.0], &slips)
        })
    });
    let power = given(limits.power).and_then(|power| {
        let what = named("largest power over the weight of the platform");
        outside(what, over_weight(power)?, "m/s", usual::POWER_OVER_WEIGHT, |value| {
            likely(value, [0.02, 50.0], &[(1e3, "power in kW given as W"), (1e-3, "power in mW given as W")])
        })
    });
    let motor_speed = limits.torque_speed.last().and_then(|[speed, _]| {
        outside(named("last speed of the torque–speed curve"), *speed, "rad/s", usual::MOTOR_SPEED, |value| {
            likely(value, [10.0, 1e3], &[(TAU / 60.0, "turns per minute given as rad/s")])
        })
    });
    [efficiency, speed, acceleration, torque, power, motor_speed].into_iter().flatten()
}

/// Length of the cable behind the anchor, by itself and against the longest cable.
fn drum_side(winch: &Winch, scale: Scale) -> Option<Implausible> {
    let what = format!("winch \"{}\": drum side", winch.name);
    let slips: &[(f64, &str)] = &[(1e-3, "length in mm given as m"), (1e-2, "length in cm given as m")];
    let length = winch.drum_side_length;
    let alone = outside(what.clone(), length, "m", usual::DRUM_SIDE, |value| likely(value, [0.05, 100.0], slips));
    alone.or_else(|| {
        let what = format!("{what} over the longest cable");
        outside(what, length / scale.longest?, "", usual::DRUM_SIDE_OVER_CABLE, |value| {
            likely(value, [0.0, 2.0], slips)
        })
    })
}

/// Stiffness of a winch against the cable and the weight of the platform.
fn stiffness(winch: &Winch, scale: Scale) -> Option<Implausible> {
    let named = |quantity: &str| format!("winch \"{}\": {quantity}", winch.name);
    let slips: &[(f64, &str)] = &[
        (1.0_f64.to_radians(), "shaft stiffness in N m per degree given as N m/rad"),
        (1e-3, "stiffness in kN/m or N/mm given as N/m, or shaft stiffness in kN m given as N m"),
        (1e-6, "stiffness in MN/m or kN/mm given as N/m"),
    ];
    if winch.stiffness.is_infinite() {
        return None;
    }

    let stiff = outside(named("stiffness at the cable"), winch.stiffness, "N/m", usual::WINCH_STIFFNESS, |_| {
        "shaft stiffness in N mm given as N m? A rigid winch needs no stiffness".to_owned()
    });
    let like_cable = scale.axial_stiffness / winch.stiffness;
    let soft = || {
        let what = named("axial stiffness of the cable over that of the winch");
        outside(what, like_cable, "m", usual::LENGTH_OF_WINCH, |value| likely(value, [0.0, 50.0], slips))
    };
    let over_cable = || {
        let what = named("stretch over that of the longest cable");
        outside(what, like_cable / scale.longest?, "", usual::WINCH_OVER_CABLE, |value| {
            likely(value, [0.0, 2.0], slips)
        })
    };
    let yields = || {
        let what = named("stretch under the weight of the platform, over the longest cable,");
        let value = scale.weight / winch.stiffness / scale.longest?;
        outside(what, value, "", usual::WINCH_YIELD, |value| likely(value, [0.0, 3e-3], slips))
    };
    stiff.or_else(soft).or_else(over_cable).or_else(yields)
}

/// Numbers about the axis of the drum, whose inertias have together a mass at the cable [kg].
fn at_cable(winch: &Winch, mass: f64, scale: Scale) -> Vec<Implausible> {
    let named = |quantity: &str| format!("winch \"{}\": {quantity}", winch.name);
    let damping = (winch.damping > 0.0).then(|| {
        let (of, mass) = if mass > 0.0 { ("drum and motor", mass) } else { ("the platform", scale.platform) };
        let what = named(&format!("viscous damping over the mass of {of} at the cable"));
        outside(what, winch.damping / mass, "1/s", usual::WINCH_DAMPING, |_| {
            "damping in N mm s given as N m s, or a stiffness given as damping?".to_owned()
        })
    });
    let damping = damping.flatten();
    if mass == 0.0 {
        return damping.into_iter().collect();
    }

    let wheel = || {
        let radius = winch.drum_radius?;
        let number = winch.drum_mass * radius * radius;
        inertia(&named("inertia of the drum"), number, radius, usual::DRUM_OVER_DISC)
    };
    let motor = || {
        let number = winch.motor_mass * winch.drum_radius?.powi(2) / (winch.gear_ratio * winch.gear_ratio);
        outside(named("inertia of the motor"), number, "kg m²", usual::MOTOR_INERTIA, |value| {
            likely(value, [1e-7, 0.1], INERTIA_SLIPS)
        })
    };
    let slips: Vec<(f64, &str)> = [
        INERTIA_SLIPS,
        &[
            (1e-6, "radius of the drum in km"),
            (1e6, "radius of the drum in mm given as m"),
            (1e4, "radius of the drum in cm given as m"),
            (winch.gear_ratio.powi(-2), "inertia of the motor at the drum, which includes the gear ratio already"),
        ],
    ]
    .concat();
    let alone = || {
        outside(named("inertia of drum and motor at the cable"), mass, "kg", usual::WINCH_MASS, |value| {
            likely(value, [0.1, 1e3], &slips)
        })
    };
    let over_platform = || {
        let what = named(&format!(
            "inertia of drum and motor at the cable, {} kg, over the mass of the platform",
            super::number(mass)
        ));
        outside(what, mass / scale.platform, "", usual::WINCH_OVER_PLATFORM, |value| {
            likely(value, [1e-3, 30.0], &slips)
        })
    };
    let inertia = wheel().or_else(motor).or_else(alone).or_else(over_platform);

    // The mass decides the bandwidth and the damping: a wrong one has its own warning.
    if inertia.is_some() {
        return inertia.into_iter().collect();
    }
    damping.into_iter().chain(control(winch, mass)).collect()
}

/// Implausible values of the position control of a winch whose drum and motor have a mass at the cable [kg].
fn control(winch: &Winch, mass: f64) -> impl Iterator<Item = Implausible> + use<> {
    let named = |quantity: &str| format!("winch \"{}\": {quantity} of its control", winch.name);
    let servo = if let Control::Position(servo) = winch.control { Some(servo) } else { None };

    let found = servo.map(|servo| {
        let omega = (servo.position_gain / mass).sqrt();
        // The bandwidth goes with the root of the gain.
        let root = 1e3_f64.sqrt();
        let bandwidth = outside(named("bandwidth"), omega / TAU, "Hz", usual::BANDWIDTH, |value| {
            let slips = [
                (1.0 / TAU, "bandwidth in rad/s given as Hz"),
                (1.0 / root, "gain in N mm given as N m"),
                (root, "gain in kN m given as N m"),
            ];
            likely(value, [0.5, 50.0], &slips)
        });

        let ratio = servo.speed_gain / (2.0 * mass * omega);
        let damping = outside(named("damping ratio"), ratio, "", usual::CONTROL_DAMPING, |value| {
            likely(value, [0.2, 2.0], &[(1e-2, "damping ratio in per cent given as a fraction")])
        });

        let delay = outside(named("delay"), servo.delay, "s", usual::DELAY, |value| {
            likely(value, [1e-4, 0.03], &[(1e-3, "delay in ms given as s")])
        });
        [bandwidth, damping, delay]
    });
    found.into_iter().flatten().flatten()
}

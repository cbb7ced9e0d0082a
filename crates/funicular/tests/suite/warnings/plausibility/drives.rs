//! Slips at pulleys, winches and flexible supports.

use super::{changed, check, hall, hall_with_drives, said, scaled};
use funicular::robot::Robot;
use funicular::statics::{self, StaticModel};
use funicular::warnings::plausibility;
use std::f64::consts::PI;

#[test]
fn slips_at_pulleys_and_winches_are_named() {
    let hall = hall_with_drives();
    assert_eq!(said(&Robot::from_toml(&hall).unwrap()), "");

    let mut misses = Vec::new();
    for (key, factor, expected) in [
        ("radius_m", 1e2, "radius in cm given as m"),
        ("radius_m", 1e3, "give the radius in metres"),
        ("inertia_kg_m2", 1e3, "inertia in g m² given as kg m²"),
        ("inertia_kg_m2", 1e4, "inertia in kg cm² given as kg m²"),
        ("swivel_inertia_kg_m2", 1e4, "inertia in kg cm² given as kg m²"),
        ("drum_side_length_m", 1e3, "length in mm given as m"),
        ("drum_side_length_m", 1e2, "length in cm given as m"),
        ("drum_radius_m", 1e3, "radius in mm given as m"),
        ("drum_radius_m", 1e2, "radius in cm given as m"),
        ("drum_inertia_kg_m2", 1e4, "inertia in kg cm² given as kg m²"),
        ("drum_inertia_kg_m2", 1e3, "inertia in g m² given as kg m²"),
        ("motor_inertia_kg_m2", 1e4, "inertia in kg cm² given as kg m²"),
        ("motor_inertia_kg_m2", 1e3, "inertia in g m² given as kg m²"),
        ("motor_inertia_kg_m2", 1e6, "inertia in kg mm² given as kg m²"),
        ("gear_ratio", 0.04, "turns of the drum per turn of the motor?"),
        ("stiffness_n_per_m", 1e-3, "stiffness in kN/m or N/mm given as N/m"),
        ("damping_n_m_s_per_rad", 1e3, "damping in N mm s given as N m s"),
        ("efficiency", 0.03 / 0.97, "the loss given as efficiency"),
        ("bandwidth_hz", 1e3, "bandwidth of its control"),
        ("control_damping_ratio", 1e2, "damping ratio in per cent given as a fraction"),
        ("delay_s", 1e3, "delay in ms given as s"),
        ("gear_efficiency", 0.1 / 0.9, "the loss given as efficiency"),
        ("max_speed_m_s", 1e3, "speed in mm/s given as m/s"),
        ("max_acceleration_m_s2", 1e3, "acceleration in mm/s² given as m/s²"),
        ("max_torque_n_m", 1e-3, "torque in kN m given as N m"),
        ("max_power_w", 1e-3, "power in kW given as W"),
        ("torque_speed_rad_s", 30.0 / PI, "turns per minute given as rad/s"),
    ] {
        check(key, &scaled(&hall, key, factor), &[expected], &mut misses);
    }
    // The smaller of limit and curve counts.
    let in_n_mm = scaled(&scaled(&hall, "max_torque_n_m", 1e3), "torque_speed_n_m", 1e3);
    check("torques", &in_n_mm, &["torque in N mm given as N m"], &mut misses);
    assert!(misses.is_empty(), "{}", misses.join("\n"));
}

/// Pulleys, drums and gears of any usual size against the unit in which they may be given: a small motor with a small
/// platform, a large one with a large platform, and slips between.
#[test]
fn drives_are_compared_with_the_cable_and_the_platform() {
    let hall = hall_with_drives();
    let with =
        |changes: &[(&str, f64)]| changes.iter().fold(hall.clone(), |text, (key, factor)| scaled(&text, key, *factor));
    let mut misses = Vec::new();
    for (slip, changes, expected) in [
        // 71,000 kg at the cable: 12 kg cm² given as 12 kg m².
        ("motor in kg cm²", vec![("motor_inertia_kg_m2", 1e4)], "inertia of the motor is 12 kg m²"),
        (
            "motor of 0.5 kg cm² at a gear of 10",
            vec![("motor_inertia_kg_m2", 0.5 / 0.0012), ("gear_ratio", 2.0)],
            "over the mass of the platform is",
        ),
        ("pulley of 20 mm in cm", vec![("radius_m", 0.4e2), ("inertia_kg_m2", 0.01)], "radius over the diameter"),
        ("drum of 75 mm in cm", vec![("drum_radius_m", 7.5 / 0.0675)], "radius of the drum is 7.5 m"),
        ("drum of 20 mm in cm", vec![("drum_radius_m", 2.0 / 0.0675)], "radius of the drum over the diameter"),
        ("stiff winch in N/mm", vec![("stiffness_n_per_m", 0.02)], "stretch over that of the longest cable"),
    ] {
        check(slip, &with(&changes), &[expected], &mut misses);
    }
    assert!(misses.is_empty(), "{}", misses.join("\n"));

    // Drives that are right: small and geared, large and direct, soft, rigid.
    for (what, changes) in [
        ("worm gear", vec![("motor_inertia_kg_m2", 0.01), ("gear_ratio", 20.0)]),
        ("direct drive", vec![("motor_inertia_kg_m2", 50.0), ("gear_ratio", 0.2)]),
        ("small wheels", vec![("radius_m", 0.3), ("inertia_kg_m2", 0.01), ("swivel_inertia_kg_m2", 0.1)]),
        ("large wheels", vec![("radius_m", 6.0), ("inertia_kg_m2", 500.0), ("swivel_inertia_kg_m2", 1e3)]),
        ("soft winch", vec![("stiffness_n_per_m", 0.1)]),
        ("stiff winch", vec![("stiffness_n_per_m", 1e3)]),
        ("drum on the other side of the hall", vec![("drum_side_length_m", 6.0)]),
    ] {
        assert_eq!(said(&Robot::from_toml(&with(&changes)).unwrap()), "", "{what}");
    }
}

#[test]
fn slips_at_flexible_supports_are_named() {
    let post = |number: usize| format!("[supports.{number}]\nstiffness_n_per_m = 200000.0\nmass_kg = 40.0\n\n");
    let mut hall = changed(&hall(), &[("[state]", &((1..5).map(post).collect::<String>() + "[state]"))]);
    for cable in 1..=8_usize {
        let name = format!("name = \"{cable}\"\n");
        hall = changed(&hall, &[(&name, &format!("{name}support = \"{}\"\n", cable.div_ceil(2)))]);
    }
    assert_eq!(said(&Robot::from_toml(&hall).unwrap()), "");

    let mut misses = Vec::new();
    let stiffness = "stiffness_n_per_m";
    for (key, factor, expected) in [
        (stiffness, 1e-3, "displacement under the weight of the platform"),
        (stiffness, 1e-3, "stiffness in N/mm or kN/m given as N/m?"),
        (stiffness, 1e-6, "stiffness in kN/mm or MN/m given as N/m?"),
        (stiffness, 1e6, "A rigid frame needs no `support`"),
    ] {
        check(key, &scaled(&hall, key, factor), &[expected], &mut misses);
    }
    let heavy = hall.replace("mass_kg = 40.0", "mass_kg = 40000.0");
    check("mass", &heavy, &["mass in g given as kg"], &mut misses);
    let per_cent = hall.replace("mass_kg = 40.0", "mass_kg = 40.0\ndamping_ratio = 0.5");
    check("damping", &per_cent, &["damping ratio is 0.5", "per cent given as a fraction"], &mut misses);
    let one = (2..5).fold(hall.clone(), |text, post| text.replace(&format!("support = \"{post}\""), "support = \"1\""));
    check(
        "one table",
        &one,
        &["support \"1\": distance of its anchors, 23.32 m", "several posts in one table?"],
        &mut misses,
    );
    // Stiff posts yield little to the weight, but less than the cables.
    let stiff = scaled(&hall, stiffness, 0.01);
    check("stiff posts", &stiff, &["over the axial stiffness of its stiffest cable", "stiffness in N/mm"], &mut misses);
    assert!(misses.is_empty(), "{}", misses.join("\n"));

    // At an equilibrium, a support that moves far is named.
    let slip = scaled(&hall, stiffness, 2e-3);
    let robot = Robot::from_toml(&slip).unwrap();
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    let said: Vec<String> = plausibility::of_equilibrium(&robot, &rest).iter().map(ToString::to_string).collect();
    let moved = rest.support_displacements(&robot)[0].norm();
    assert!(moved > 1.0 && said.concat().contains("displacement of support \""), "{moved} {said:?}");
    let robot = Robot::from_toml(&hall).unwrap();
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    assert!(plausibility::of_equilibrium(&robot, &rest).is_empty());
}

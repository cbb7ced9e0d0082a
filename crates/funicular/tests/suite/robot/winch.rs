//! Motor of a winch: torque, speed and power against hand numbers and the balance of powers, limits and their reading.

use funicular::robot::{LimitOfWinch, MotorLoad, Robot, Winch, WinchLimits};
use proptest::prelude::*;

/// Winch with a drum of 0.1 m and a gear of 1:5; inertias and damping at the cable.
fn winch() -> Winch {
    Winch {
        drum_radius: Some(0.1),
        gear_ratio: 5.0,
        gear_efficiency: 0.8,
        drum_mass: 20.0,
        motor_mass: 10.0,
        damping: 50.0,
        ..Winch::rigid("drum", 2.0)
    }
}

/// True if two numbers are equal up to rounding, infinite ones included.
fn is_near(found: f64, expected: f64) -> bool {
    (found - expected).abs() <= 1e-12 * expected.abs() || (found.is_infinite() && expected.is_infinite())
}

fn assert_near<const N: usize>(found: [f64; N], expected: [f64; N]) {
    let all = found.iter().zip(&expected).all(|(found, expected)| is_near(*found, *expected));
    assert!(all, "{found:?} instead of {expected:?}");
}

/// Every number by hand, at a tension of 400 N.
#[test]
fn torque_speed_and_power_of_the_motor_are_those_of_hand_calculations() {
    for (what, (speed, acceleration), (motor_speed, torque, power)) in [
        // 400 N · 0.1 m / 5.
        ("at rest", (0.0, 0.0), (0.0, 8.0, 0.0)),
        // (400 + 50 · 2) N / 0.8 = 625 N.
        ("winds in", (-2.0, 0.0), (100.0, 12.5, 1250.0)),
        // (400 − 50 · 2) N · 0.8 = 240 N.
        ("pays out", (2.0, 0.0), (-100.0, 4.8, -480.0)),
        // (400 + 20 · 3 + 100) N / 0.8 + 10 · 3 N = 730 N.
        ("winds in faster and faster", (-2.0, -3.0), (100.0, 14.6, 1460.0)),
        // Behind the gear 400 − 20 · 30 + 100 = −100 N brakes: −100 N · 0.8 − 10 · 30 N = −380 N.
        ("stops while it winds in", (-2.0, 30.0), (100.0, -7.6, -760.0)),
        // 400 + 20 · 3 = 460 N, and 30 N of the motor.
        ("starts to wind in", (0.0, -3.0), (0.0, 9.8, 0.0)),
    ] {
        let motor = winch().motor(400.0, speed, acceleration);
        let found = [motor.speed.unwrap(), motor.torque.unwrap(), motor.power];
        for (found, expected) in found.into_iter().zip([motor_speed, torque, power]) {
            assert!((found - expected).abs() < 1e-10, "{what}: {found} instead of {expected}");
        }
    }

    let without_radius = Winch { drum_radius: None, ..winch() }.motor(400.0, -2.0, 0.0);
    assert_eq!((without_radius.speed, without_radius.torque), (None, None));
    assert!((without_radius.power - 1250.0).abs() < 1e-10);
}

proptest! {
    /// Power balance: the motor gives what the cable takes, the change of the kinetic energies, and losses, which are
    /// never negative; without damping and at an efficiency of one there are none.
    #[test]
    fn the_power_of_the_motor_is_that_of_cable_masses_and_losses(
        tension in 0.0..1e4_f64, speed in -10.0..10.0_f64, acceleration in -50.0..50.0_f64,
        efficiency in 0.3..1.0_f64, damping in 0.0..500.0_f64,
    ) {
        let winch = Winch { gear_efficiency: efficiency, damping, ..winch() };
        let motor = winch.motor(tension, speed, acceleration);
        prop_assert!((motor.torque.unwrap() * motor.speed.unwrap() - motor.power).abs() <= 1e-12 * motor.power.abs());

        // Kinetic energy ½ (M_D + M_M) v².
        let kinetic = (winch.drum_mass + winch.motor_mass) * speed * acceleration;
        let scale = tension * speed.abs() + kinetic.abs() + damping * speed * speed + motor.power.abs();
        let losses = motor.power + tension * speed - kinetic;
        prop_assert!(losses >= damping * speed * speed - 1e-12 * scale);

        let ideal = Winch { gear_efficiency: 1.0, ..winch }.motor(tension, speed, acceleration);
        let of_damping = ideal.power + tension * speed - kinetic;
        prop_assert!((of_damping - damping * speed * speed).abs() <= 1e-12 * scale);
    }

    /// A limit holds in both directions of the cable.
    #[test]
    fn limits_do_not_depend_on_the_direction(speed in 0.0..10.0_f64, torque in 0.0..30.0_f64,
        motor_speed in 0.0..500.0_f64) {
        let limits = limits();
        let turned = |sign: f64, of: LimitOfWinch| {
            let motor = MotorLoad { speed: Some(sign * motor_speed), torque: Some(-sign * torque), power: 0.0 };
            let uses = limits.use_of(sign * speed, -sign * speed, &motor);
            uses.into_iter().find(|(other, _)| *other == of).unwrap().1
        };
        for of in [LimitOfWinch::Speed, LimitOfWinch::Acceleration, LimitOfWinch::Torque] {
            prop_assert!(is_near(turned(1.0, of), turned(-1.0, of)));
        }
    }
}

/// Limits with a curve of three corners.
fn limits() -> WinchLimits {
    WinchLimits {
        speed: 4.0,
        acceleration: 20.0,
        torque: 25.0,
        power: 2000.0,
        brake_power: 500.0,
        torque_speed: vec![[0.0, 30.0], [100.0, 30.0], [300.0, 10.0]],
    }
}

#[test]
fn a_use_is_used_over_allowed_and_the_torque_counts_against_the_smaller_limit() {
    let limits = limits();
    let motor = |speed: f64, torque: f64, power: f64| MotorLoad { speed: Some(speed), torque: Some(torque), power };
    let uses = |motor: MotorLoad| limits.use_of(-3.0, 5.0, &motor).map(|(_, part)| part);

    assert_near(uses(motor(0.0, 20.0, 1000.0)), [0.75, 0.25, 0.8, 0.5, 0.0]);
    assert_near(uses(motor(0.0, -20.0, -1000.0)), [0.75, 0.25, 0.8, 0.0, 2.0]);
    assert_eq!(limits.use_of(0.0, 0.0, &motor(0.0, 0.0, 0.0)).map(|(of, _)| of), LimitOfWinch::ALL);

    // The curve: below the limit of torque from 150 rad/s on, then down to 10 N m, then nothing.
    for (speed, allowed) in [(0.0, 25.0), (120.0, 25.0), (150.0, 25.0), (200.0, 20.0), (-200.0, 20.0), (300.0, 10.0)] {
        assert!((limits.torque_at(speed) - allowed).abs() < 1e-12, "{speed}");
    }
    assert_near([limits.torque_at(300.1)], [0.0]);
    assert_near([uses(motor(301.0, 1.0, 0.0))[2]], [f64::INFINITY]);
    assert_near([uses(motor(301.0, 0.0, 0.0))[2]], [0.0]);
    let one_corner = WinchLimits { torque_speed: vec![[0.0, 5.0]], ..WinchLimits::NONE };
    assert_eq!((one_corner.torque_at(0.0), one_corner.torque_at(1.0)), (5.0, 0.0));

    // Without limits, and without a radius of the drum.
    let none = WinchLimits::default();
    assert_near(none.use_of(-3.0, 5.0, &motor(100.0, 20.0, 1000.0)).map(|(_, part)| part), [0.0; 5]);
    let load = MotorLoad { speed: None, torque: None, power: -250.0 };
    assert_near(limits.use_of(4.0, 0.0, &load).map(|(_, part)| part), [1.0, 0.0, 0.0, 0.0, 0.5]);
}

/// File of one cable with these lines in the table of its winch.
fn with(lines: &str) -> String {
    format!(
        "name = \"one\"\n[platform]\nmass_kg = 1.0\nmotion = \"point-mass\"\n[materials.rope]\n\
         axial_stiffness_n = 2e4\nmass_kg_per_m = 0.1\n[winches.drum]\n{lines}\n[[cables]]\nname = \"1\"\n\
         material = \"rope\"\nwinch = \"drum\"\nanchor_m = [0, 0, 3]\nunstrained_length_m = 2.0\n"
    )
}

#[test]
fn limits_are_read_and_without_them_there_are_none() {
    let read = |lines: &str| Robot::from_toml(&with(lines)).unwrap().cables[0].anchor.winch.clone().unwrap();

    let all = read(
        "drum_radius_m = 0.1\ngear_efficiency = 0.9\nmax_speed_m_s = 4.0\nmax_acceleration_m_s2 = 20\n\
         max_torque_n_m = 25\nmax_power_w = 2e3\nmax_brake_power_w = 500\n\
         torque_speed_rad_s = [0, 100, 300.0]\ntorque_speed_n_m = [30, 30, 10]",
    );
    assert_eq!((&all.limits, all.gear_efficiency), (&limits(), 0.9));

    let none = read("drum_radius_m = 0.1");
    assert_eq!((none.limits, none.gear_efficiency), (WinchLimits::NONE, 1.0));
    // A motor brakes as it drives if the file says nothing else.
    assert_near([read("max_power_w = 2e3").limits.brake_power], [2e3]);
    assert_near([read("max_brake_power_w = 2e3").limits.power], [f64::INFINITY]);
}

#[test]
fn wrong_limits_of_winches_are_refused_with_place_and_remedy() {
    for (lines, message, help) in [
        ("max_speed_m_s = 0", "`max_speed_m_s` is 0, it must be positive", "max_speed_m_s = 3.0"),
        ("max_power_w = -1", "`max_power_w` is -1, it must be positive", "max_power_w"),
        ("max_torque_n_m = 5", "has `max_torque_n_m`, but no `drum_radius_m`", "a torque by the radius"),
        ("gear_efficiency = 92", "`gear_efficiency` is 92, it must be at most 1", "not per cent"),
        ("gear_efficiency = 0", "`gear_efficiency` is 0, it must be positive", ""),
        ("torque_speed_rad_s = [0, 5]", "has `torque_speed_rad_s`, but no `torque_speed_n_m`", "torque_speed_n_m = ["),
        ("torque_speed_n_m = [5]", "has `torque_speed_n_m`, but no `torque_speed_rad_s`", "torque_speed_rad_s = ["),
        ("torque_speed_rad_s = 5\ntorque_speed_n_m = [5]", "`torque_speed_rad_s` is a number, it must be a list", "["),
        ("torque_speed_rad_s = []\ntorque_speed_n_m = []", "`torque_speed_rad_s` is an empty list", "remove the line"),
        (
            "torque_speed_rad_s = [0, 5]\ntorque_speed_n_m = [5]",
            "`torque_speed_n_m` has 1 numbers, `torque_speed_rad_s` 2",
            "one torque for each speed",
        ),
        ("torque_speed_rad_s = [1, 5]\ntorque_speed_n_m = [5, 5]", "begins at 1 rad/s, it must begin at 0", "add"),
        (
            "torque_speed_rad_s = [0, 5, 5]\ntorque_speed_n_m = [5, 5, 0]",
            "number 3 of `torque_speed_rad_s` is 5 rad/s, not above 5 rad/s",
            "rising",
        ),
        (
            "torque_speed_rad_s = [0, 5]\ntorque_speed_n_m = [5, -1]",
            "number 2 of `torque_speed_n_m` is -1, it must not be negative",
            "",
        ),
        (
            "torque_speed_rad_s = [0, nan]\ntorque_speed_n_m = [5, 1]",
            "number 2 of `torque_speed_rad_s` is nan, it must be finite",
            "",
        ),
    ] {
        // The drum has a radius unless its absence is the error.
        let radius = if message.contains("no `drum_radius_m`") { "" } else { "drum_radius_m = 0.1\n" };
        let error = Robot::from_toml(&with(&format!("{radius}{lines}"))).unwrap_err();
        let issue = &error.issues()[0];
        assert!(issue.message.contains(message), "{lines}: {}", issue.message);
        assert!(issue.help.as_deref().unwrap_or_default().contains(help), "{lines}: {:?}", issue.help);
    }
}

/// Required velocities are read beside the loads and are none.
#[test]
fn required_velocities_are_no_loads() {
    let required = |lines: &str| Robot::from_toml(&(with("") + "[required]\n" + lines)).map(|robot| robot.required);

    let moving = required("velocity_m_s = [1, 2, 0.5]").unwrap();
    assert_eq!(moving.velocity_w.as_slice(), [1.0, 2.0, 0.5]);
    assert!(moving.is_empty());

    let error = required("angular_velocity_rad_s = [0, 0, 0.1]").unwrap_err().to_string();
    assert!(error.contains("a point mass does not turn: leave out") && error.contains("angular velocity"), "{error}");
    assert!(required("velocity_m_s = [-1, 0, 0]").unwrap_err().to_string().contains("must not be negative"));
}

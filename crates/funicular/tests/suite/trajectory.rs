//! A robot in motion along a path: rates and accelerations of lengths against differences, inertia, frequencies.

use funicular::math::Vec3;
use funicular::path::{CourseForm, MotionLimits, PlatformPath, Side};
use funicular::robot::{Pose, Robot};
use funicular::statics::{self, Limit, StaticModel, TensionRule};
use funicular::trajectory::{AlongPath, InMotion, length_accelerations};

/// Smooth path through a pose that moves every coordinate that the platform has.
fn path(robot: &Robot, around: &Pose, reach: f64) -> PlatformPath {
    let times: Vec<f64> = (0..81).map(|k| 0.05 * f64::from(k)).collect();
    let pose = |t: &f64| {
        let (a, b) = (1.3 * t, 0.9 * t + 0.4);
        let motion = &robot.platform.motion;
        let moved = [a.sin(), b.cos(), (a + b).sin(), 0.3 * b.sin(), 0.3 * a.cos(), 0.4 * (a - b).sin()];
        let allowed = motion.allowed(&funicular::math::Vec6::from(moved)) * reach;
        around.moved(&Vec3::new(allowed[0], allowed[1], allowed[2]), &Vec3::new(allowed[3], allowed[4], allowed[5]))
    };
    PlatformPath::of_table(&times, &times.iter().map(pose).collect::<Vec<_>>()).unwrap()
}

fn lengths(motion: &InMotion) -> Vec<f64> {
    motion.equilibrium.cables.iter().map(|cable| cable.unstrained_length).collect()
}

/// Rates along a path are the differences of the lengths at neighbouring times, wherever no limit is reached between.
fn check_rates(robot: &Robot, around: &Pose, reach: f64, rule: &TensionRule, rope_inertia: bool) {
    let path = path(robot, around, reach);
    let mut along = AlongPath::new(robot, StaticModel::Catenary, rule.clone(), rope_inertia);
    let mut checked = 0;
    for k in 0..12 {
        let (time, step) = (0.3 + 0.29 * f64::from(k), 2e-4);
        let [before, here, after] = [-step, 0.0, step].map(|by| along.at(&path.at(time + by)).unwrap());
        assert_eq!(here.no_exact_rates, None);
        if !before.held.are_alike(&here.held) || !after.held.are_alike(&here.held) {
            continue;
        }
        checked += 1;
        let differences =
            lengths(&before).into_iter().zip(lengths(&after)).map(|(from, to)| (to - from) / (2.0 * step));
        for (rate, difference) in here.length_rates.iter().zip(differences) {
            // Differences: 1e-12 m over the step, and a third derivative of 10 m/s³ times a sixth of its square.
            assert!((rate - difference).abs() < 2e-7, "{}, {time}: {rate} {difference}", robot.name);
        }
    }
    assert!(checked > 6, "{checked}");
}

#[test]
fn rates_are_differences_of_lengths_for_every_kind_of_robot() {
    let center = Pose::new([0.3, -0.2, 1.5], [0.0, 2.0, 5.0]);
    let cogiro = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    let mut loaded = cogiro.clone();
    loaded.load.force_w = Vec3::new(50.0, -30.0, 20.0);
    loaded.load.point_p = Vec3::new(0.2, 0.1, -0.3);
    loaded.platform.center_of_mass_p = Vec3::new(0.05, -0.1, 0.15);
    for rope_inertia in [false, true] {
        check_rates(&cogiro, &center, 0.8, &TensionRule::Lowest, rope_inertia);
        check_rates(&loaded, &center, 0.8, &TensionRule::Closest(vec![900.0]), rope_inertia);
        let yuan = Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap();
        check_rates(&yuan, &Pose::new([0.1, 0.05, 0.5], [0.0; 3]), 0.05, &TensionRule::Lowest, rope_inertia);
    }
    let winches = Robot::from_toml(include_str!("../../../../docs/pulleys/winches.toml")).unwrap();
    let pose = statics::solve(&winches, StaticModel::Catenary, None).unwrap().equilibrium.pose;
    check_rates(&winches, &pose, 0.1, &TensionRule::Lowest, false);
}

#[test]
fn ideal_cables_have_the_rates_of_their_chords() {
    let robot = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    let path = path(&robot, &Pose::new([0.3, -0.2, 1.5], [0.0; 3]), 0.8);
    let mut along = AlongPath::new(&robot, StaticModel::Ideal, TensionRule::Lowest, false);
    let found = along.at(&path.at(1.1)).unwrap();
    let chord = |time: f64, i: usize| robot.cables[i].chord_w(&path.at(time).pose).norm();
    for (i, rate) in found.length_rates.iter().enumerate() {
        let difference = (chord(1.1 + 1e-5, i) - chord(1.1 - 1e-5, i)) / 2e-5;
        assert!((rate - difference).abs() < 1e-8, "{rate} {difference}");
    }
}

#[test]
fn the_rule_without_derivatives_has_rates_by_differences() {
    let mut robot = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    robot = robot.with_tension_limits(funicular::robot::TensionLimits { minimum: Some(100.0), maximum: Some(2000.0) });
    let path = path(&robot, &Pose::new([0.3, -0.2, 1.5], [0.0; 3]), 0.1);
    let mut along = AlongPath::new(&robot, StaticModel::Catenary, TensionRule::Stiffest, false);
    let found = along.at(&path.at(1.0)).unwrap();
    assert!(found.no_exact_rates.is_some() && found.length_rates.iter().all(|rate| rate.is_finite()));
}

#[test]
fn an_upward_acceleration_is_a_heavier_platform() {
    let robot = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    let limits = MotionLimits { speed: 2.0, acceleration: 2.0, ..MotionLimits::default() };
    let poses = [Pose::new([0.0, 0.0, 1.0], [0.0; 3]), Pose::new([0.0, 0.0, 2.5], [0.0; 3])];
    let path = PlatformPath::through(&poses, &limits, CourseForm::JerkLimited, 0.0).unwrap();
    let point = path.at(0.3);
    assert!((point.acceleration_w[2] - 2.0).abs() < 1e-12);

    let mut along = AlongPath::new(&robot, StaticModel::Catenary, TensionRule::Lowest, false);
    let moving = along.at(&point).unwrap();
    // The force of the inertia acts at the centre of mass as the weight does.
    let mut heavier = robot.clone();
    heavier.load.force_w -= Vec3::new(0.0, 0.0, 2.0 * robot.platform.mass);
    heavier.load.point_p = robot.platform.center_of_mass_p;
    let rest = statics::inverse(&heavier, &point.pose, StaticModel::Catenary).unwrap();
    for (moving, rest) in moving.equilibrium.cables.iter().zip(&rest.cables) {
        assert!((moving.tension_platform - rest.tension_platform).abs() < 1e-7 * rest.tension_platform);
    }
}

#[test]
fn fewer_cables_than_degrees_of_freedom_follow_no_path() {
    let mut robot = Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap();
    robot.cables.truncate(5);
    let path = path(&robot, &Pose::new([0.1, 0.05, 0.5], [0.0; 3]), 0.05);
    let mut along = AlongPath::new(&robot, StaticModel::Catenary, TensionRule::Lowest, false);
    let error = along.at(&path.at(0.5)).unwrap_err();
    assert!(error.to_string().contains('5'), "{error}");
}

#[test]
fn limits_that_are_reached_are_told() {
    let robot = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    let path = path(&robot, &Pose::new([2.0, 1.0, 1.5], [0.0; 3]), 0.3);
    let least_of = |motion: &InMotion| -> Vec<f64> {
        let least = |cable: &statics::CableState| cable.hanging.as_ref().unwrap().catenary.min_tension();
        motion.equilibrium.cables.iter().map(least).collect()
    };
    let at = |robot: &Robot| {
        AlongPath::new(robot, StaticModel::Catenary, TensionRule::Lowest, false).at(&path.at(0.7)).unwrap()
    };

    // A minimum a little above what the lowest tensions leave.
    let free = at(&robot);
    let minimum = 1.002 * least_of(&free).into_iter().fold(f64::INFINITY, f64::min);
    let limits = funicular::robot::TensionLimits { minimum: Some(minimum), maximum: Some(5000.0) };
    let found = at(&robot.with_tension_limits(limits));
    for (at_limit, least) in found.held.at_limit.iter().zip(least_of(&found)) {
        assert_eq!(*at_limit == Some(Limit::Minimum), least < minimum * (1.0 + 1e-6), "{least} {minimum}");
    }
    assert!(found.held.at_limit.contains(&Some(Limit::Minimum)) && !free.held.at_limit.contains(&Some(Limit::Minimum)));
}

#[test]
fn accelerations_of_lengths_are_of_fifth_order_and_do_not_reach_over_jumps() {
    let length = |t: f64| (2.0 * t).sin() + 0.3 * t.powi(4);
    let rate = |t: f64| 2.0 * (2.0 * t).cos() + 1.2 * t.powi(3);
    let acceleration = |t: f64| -4.0 * (2.0 * t).sin() + 3.6 * t * t;
    let error = |parts: usize| {
        // Unequal steps.
        let times: Vec<f64> = (0..=parts).map(|k| (k as f64 / parts as f64).powf(1.2)).collect();
        let [lengths, rates] = [length, rate].map(|of| times.iter().map(|t| vec![of(*t)]).collect::<Vec<_>>());
        let found = length_accelerations(&times, &lengths, &rates, |_| true);
        (1..parts).map(|k| (found[k][0] - acceleration(times[k])).abs()).fold(0.0, f64::max)
    };
    let (coarse, fine) = (error(20), error(40));
    assert!(coarse < 1e-5 && fine < coarse / 12.0, "{coarse} {fine}");

    // A kink between two samples.
    let times = [0.0, 0.1, 0.2, 0.3, 0.4];
    let lengths = times.map(|t: f64| vec![if t < 0.25 { t * t } else { 0.0625 + 3.0 * (t - 0.25) }]);
    let rates = times.map(|t: f64| vec![if t < 0.25 { 2.0 * t } else { 3.0 }]);
    let found = length_accelerations(&times, &lengths, &rates, |k| k != 2);
    for (found, expected) in found.iter().zip([2.0, 2.0, 2.0, 0.0, 0.0]) {
        assert!((found[0] - expected).abs() < 1e-10, "{found:?}");
    }
}

#[test]
fn the_frequency_of_a_motion_is_that_of_its_acceleration() {
    let times: Vec<f64> = (0..=400).map(|k| 0.01 * f64::from(k)).collect();
    let pose = |t: &f64| Pose::new([0.1 * (std::f64::consts::TAU * 2.0 * t).cos(), 0.0, 1.0], [0.0; 3]);
    let path = PlatformPath::of_table(&times, &times.iter().map(pose).collect::<Vec<_>>()).unwrap();
    // A window of 4 s spreads the line of 2 Hz over ± 0.25 Hz.
    for (part, most) in [(0.5, 2.1), (0.95, 2.6)] {
        let found = path.frequency_below_which(part, 1.0);
        assert!((1.9..most).contains(&found), "{part}: {found}");
    }
    assert!(
        (path.slowed(4.0).frequency_below_which(0.5, 1.0) - path.frequency_below_which(0.5, 1.0) / 4.0).abs() < 1e-12
    );
}

#[test]
fn rates_at_corners_are_the_differences_on_their_side() {
    let robot = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    let limits = MotionLimits { speed: 2.0, acceleration: 2.0, jerk: 20.0, ..MotionLimits::default() };
    // The first is so short that two of its phases end together.
    for end in [[0.3, 0.2, 1.5], [4.0, 2.0, 1.5]] {
        for form in CourseForm::ALL {
            let poses = [Pose::new([0.0, 0.0, 1.5], [0.0; 3]), Pose::new(end, [0.0; 3])];
            let path = PlatformPath::through(&poses, &limits, form, 0.0).unwrap();
            let mut along = AlongPath::new(&robot, StaticModel::Catenary, TensionRule::Lowest, false);
            let middle = 0.5 * path.duration();
            let times = path.corners().into_iter().map(|corner| corner.time).chain([middle, 0.3 * middle]);
            for time in times.collect::<Vec<_>>() {
                for (side, step) in [(Side::Before, -2e-4), (Side::After, 2e-4)] {
                    let mut at = |by: f64| along.at(&path.beside(time + by, side)).unwrap();
                    let rates = at(0.0).length_rates;
                    let [here, near, far] = [0.0, step, 2.0 * step].map(|by| lengths(&at(by)));
                    for (i, rate) in rates.iter().enumerate() {
                        let difference = (4.0 * near[i] - 3.0 * here[i] - far[i]) / (2.0 * step);
                        // A third of the square of the step times a third derivative of some 100 m/s³.
                        assert!((rate - difference).abs() < 2e-5, "{form:?} {time} {side:?} {i}: {rate} {difference}");
                    }
                }
            }
        }
    }
}

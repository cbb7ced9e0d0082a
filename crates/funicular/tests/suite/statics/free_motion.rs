//! Robots whose cables all end at one point or on one line of the platform.

use funicular::robot::{Robot, State, TensionLimits};
use funicular::statics::{self, PayloadSide, RequestedPayload, Solution, StaticModel, StaticsError, TensionRule};
use std::fmt::Write as _;

/// Robot with cables from these anchors to these attachments [m].
fn robot(platform: &str, mass_per_length: f64, cables: &[([f64; 3], [f64; 3])]) -> Robot {
    let mut text = format!(
        "name = \"few directions\"\n[platform]\n{platform}\n[materials.rope]\naxial_stiffness_n = 1e6\n\
         mass_kg_per_m = {mass_per_length}\n"
    );
    for (i, (anchor, attachment)) in cables.iter().enumerate() {
        write!(text, "[[cables]]\nname = \"{i}\"\nmaterial = \"rope\"\nanchor_m = {anchor:?}\n").unwrap();
        if !platform.contains("point-mass") {
            writeln!(text, "attachment_m = {attachment:?}").unwrap();
        }
    }
    Robot::from_toml(&text).unwrap()
}

const CORNERS: [[f64; 2]; 4] = [[4.0, 3.0], [-4.0, 3.0], [-4.0, -3.0], [4.0, -3.0]];

/// Bar on eight cables, four at each of its ends.
fn bar() -> Robot {
    let cables = CORNERS.map(|[x, y]| [([x, y, 4.0], [0.0, 0.0, -0.4]), ([x, y, 0.1], [0.0, 0.0, 0.4])]);
    let mut robot = robot("mass_kg = 5\ninertia_kg_m2 = [0.4, 0.4, 0.01]", 0.0, cables.as_flattened());
    robot.state = State::Pose(funicular::robot::Pose::new([0.1, 0.2, 1.5], [0.0; 3]));
    robot
}

/// Camera of 20 kg below one point on the first `count` of six cables, or a point mass there.
fn camera(platform: &str, count: usize) -> Robot {
    let mut anchors: Vec<([f64; 3], [f64; 3])> = CORNERS.map(|[x, y]| ([x, y, 4.0], [0.0; 3])).to_vec();
    anchors.extend([([0.0, 5.0, 4.0], [0.0; 3]), ([0.0, -5.0, 4.0], [0.0; 3])]);
    let mut robot = robot(platform, 0.05, &anchors[..count]);
    robot.state = State::Pose(funicular::robot::Pose::new([0.5, 0.2, 1.5], [0.0; 3]));
    robot
}

const BELOW: &str = "mass_kg = 20\ninertia_kg_m2 = [0.5, 0.5, 0.1]\ncenter_of_mass_m = [0, 0, -0.3]";

fn tensions(found: &Solution) -> Vec<f64> {
    found.equilibrium.cables.iter().map(|cable| cable.tension_platform).collect()
}

/// Tensions by a quadratic program of a separate program, residual 2e-12, four decimals.
#[test]
fn a_bar_held_at_its_two_ends_has_the_nearest_tensions_above_the_minimum_and_turns_freely() {
    let robot = bar().with_tension_limits(TensionLimits { minimum: Some(5.0), maximum: None });
    let found = statics::solve(&robot, StaticModel::Spring, None).unwrap();
    let expected = [29.7079, 5.5858, 28.9258, 5.3641, 26.2551, 5.0, 26.9262, 5.0];
    for (found, expected) in tensions(&found).iter().zip(expected) {
        assert!((found - expected).abs() < 1e-4, "{found} {expected}");
    }
    assert!(found.rule.is_some() && found.equilibrium.residual < 1e-12);
    let free = statics::free_motions(&robot, &found.equilibrium);
    assert!(free.len() == 1 && free[0].is_held == Some(false), "{free:?}");
    assert_eq!(free[0].to_string(), "turn about (0.000, 0.000, 1.000) through (0.100, 0.200, 1.500) m");
}

/// The centre of mass is straight below the point, so the tensions are those of a point mass.
#[test]
fn a_camera_below_one_point_has_the_tensions_of_a_point_mass() {
    for count in [4, 5, 6] {
        let point =
            statics::solve(&camera("mass_kg = 20\nmotion = \"point-mass\"", count), StaticModel::Catenary, None);
        let robot = camera(BELOW, count);
        let found = statics::solve(&robot, StaticModel::Catenary, None).unwrap();
        for (found, expected) in tensions(&found).iter().zip(tensions(&point.unwrap())) {
            assert!((found / expected - 1.0).abs() < 1e-9, "{count}: {found} {expected}");
        }
        assert!(found.rule.is_some());
        let held: Vec<_> = statics::free_motions(&robot, &found.equilibrium).iter().map(|free| free.is_held).collect();
        assert_eq!(held, [Some(false), Some(true), Some(true)]);
    }
}

#[test]
fn a_camera_that_its_weight_would_turn_is_refused_with_the_turn() {
    let robot = camera("mass_kg = 20\ninertia_kg_m2 = [0.5, 0.5, 0.1]\ncenter_of_mass_m = [0.1, 0, -0.3]", 6);
    let error = statics::solve(&robot, StaticModel::Spring, None).unwrap_err();
    assert!(
        matches!(error, StaticsError::Singular { .. }) && error.to_string().contains("turn the platform"),
        "{error}"
    );
}

/// Loads whose centre of mass is straight below the common point are carried; others would turn the platform.
#[test]
fn a_payload_beside_the_common_point_is_refused_with_the_turn_that_it_causes() {
    let robot = camera(BELOW, 6).with_tension_limits(TensionLimits { minimum: None, maximum: Some(300.0) });
    let State::Pose(pose) = robot.state else { panic!("the state is a pose") };
    let bound = |x: f64| {
        let center_p = funicular::math::Vec3::new(x, 0.0, -0.3);
        let requested = RequestedPayload { center_p, side: PayloadSide::Maximum, prove: false };
        statics::payload_bound(&robot, &pose, StaticModel::Catenary, requested, None)
    };
    let mass = bound(0.0).unwrap().mass;
    let lifted = statics::solve(&robot.with_mass(20.0 + mass * (1.0 - 1e-4)), StaticModel::Catenary, None);
    assert!(mass > 10.0 && lifted.is_ok(), "{mass} {lifted:?}");
    let error = bound(0.2).unwrap_err();
    assert!(matches!(error, StaticsError::UnbalancedPayload { .. }) && error.is_no_solution(), "{error}");
    assert!(error.to_string().contains("turn about (0.000, 1.000, 0.000)"), "{error}");
}

#[test]
fn the_rule_stiffest_is_refused_where_no_tension_changes_the_least_stiffness() {
    for robot in [bar(), camera(BELOW, 6)] {
        let robot = robot.with_tension_limits(TensionLimits { minimum: None, maximum: Some(300.0) });
        assert!(statics::leaves_choice(&robot));
        let error = statics::solve(&robot, StaticModel::Catenary, Some(TensionRule::Stiffest)).unwrap_err();
        assert_eq!(error, StaticsError::StiffestNeedsSpread);
        assert!(statics::solve(&robot, StaticModel::Catenary, Some(TensionRule::Middle)).is_ok());
    }
    assert!(!statics::leaves_choice(&Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap()));
}

/// Crate of 400 kg on slings of 2.5 m from one hook.
fn slings(from: impl Fn(usize) -> [f64; 3], lengths: &[f64]) -> Robot {
    let attachments = [[1.2, 0.8, 0.5], [-1.2, 0.8, 0.5], [-1.2, -0.8, 0.5], [1.2, -0.8, 0.5]];
    let cables: Vec<_> = attachments.into_iter().enumerate().map(|(i, at)| (from(i), at)).take(lengths.len()).collect();
    let mut robot = robot("mass_kg = 400\ninertia_kg_m2 = [40, 70, 90]", 0.4, &cables);
    robot.state = State::Lengths(lengths.to_vec());
    robot
}

#[test]
fn slings_from_one_hook_hold_their_crate_which_turns_freely_about_the_vertical_through_the_hook() {
    let hook = [0.0, 0.0, 6.0];
    let robot = slings(|_| hook, &[2.5; 4]);
    let found = statics::solve(&robot, StaticModel::Spring, None).unwrap().equilibrium;

    // Straight slings: four equal tensions T at the angle θ carry the weight, and T stretches them.
    let (weight, reach) = (400.0 * 9.81, 1.2_f64.hypot(0.8));
    let mut length = 2.5_f64;
    for _ in 0..100 {
        let cosine = (length * length - reach * reach).sqrt() / length;
        length = 2.5 * (1.0 + weight / (4.0 * cosine) / 1e6);
    }
    let drop = (length * length - reach * reach).sqrt();
    assert!((found.pose.position_w.z - (6.0 - drop - 0.5)).abs() < 1e-9, "{}", found.pose.position_w.z);
    for cable in &found.cables {
        assert!((cable.tension_platform / (weight * length / drop / 4.0) - 1.0).abs() < 1e-9);
    }
    let free = statics::free_motions(&robot, &found);
    assert!(free.iter().any(|motion| motion.to_string().starts_with("turn about (0.000, 0.000, 1.000)")), "{free:?}");

    // Sagging ones are the limit of slings whose anchors are apart by a micrometre.
    let sagging = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    let apart = slings(|i| [1e-6 * i as f64, 0.0, 6.0], &[2.5; 4]);
    let apart = statics::solve(&apart, StaticModel::Catenary, None).unwrap().equilibrium;
    assert!((sagging.pose.position_w.z - apart.pose.position_w.z).abs() < 1e-5);
    for (one, other) in sagging.cables.iter().zip(&apart.cables) {
        assert!((one.tension_platform - other.tension_platform).abs() < 1e-3 * other.tension_platform);
    }
    let warned = funicular::warnings::plausibility::of_robot(&robot);
    assert!(warned.iter().any(|of| of.to_string().contains("all cables have one anchor, (0, 0, 6) m")), "{warned:?}");
}

#[test]
fn slings_of_different_lengths_and_two_falls_from_one_sheave_are_computed() {
    let robot = slings(|_| [0.5, -0.2, 6.0], &[2.5, 2.6, 2.4]);
    let found = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    // The centre of mass hangs below the hook; the ropes, three kilograms beside it, move it by millimetres.
    let center_w = found.pose.point_w(&robot.platform.center_of_mass_p);
    let beside = center_w - funicular::math::Vec3::new(0.5, -0.2, center_w.z);
    assert!(beside.norm() < 5e-3, "{beside}");

    let falls = [([0.0, 0.0, 9.0], [0.0; 3]), ([0.0, 0.0, 9.0], [0.0; 3])];
    let mut two = self::robot("mass_kg = 50\nmotion = \"point-mass\"", 0.2, &falls);
    two.state = State::Lengths(vec![8.0, 8.01]);
    let found = statics::solve(&two, StaticModel::Catenary, None).unwrap().equilibrium;
    let carried: f64 = found.cables.iter().map(|cable| cable.tension_anchor).sum();
    let weight = 9.81 * (50.0 + 0.2 * 16.01);
    assert!((carried / weight - 1.0).abs() < 1e-3, "{carried} {weight}");
}

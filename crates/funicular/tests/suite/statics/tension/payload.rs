//! Minimum and maximum payload. Oracle: tension distributions of robots with the payload as a part of the platform,
//! whose existence is bisected over the mass.

use super::{COGIRO, POINT, seven_cables};
use crate::random::any_robot;
use funicular::math::Vec3;
use funicular::robot::{Load, Pose, Robot, TensionLimits};
use funicular::statics::{
    self, Limit, PayloadBound, PayloadSide, RequestedPayload, StaticModel, StaticsError, TensionPlace, TensionRange,
    TensionRule,
};
use proptest::prelude::*;

/// Robot with cables above and below the platform.
const HALL: &str = r#"
name = "hall"
[platform]
mass_kg = 60.0
inertia_kg_m2 = [4.45, 6.25, 8.2]
[materials.rope]
axial_stiffness_n = 1.4e6
mass_kg_per_m = 0.13
minimum_tension_n = 50.0
maximum_tension_n = 2000.0
[[cables]]
name = "1"
material = "rope"
anchor_m = [10, 6, 8]
attachment_m = [0.5, 0.4, -0.25]
[[cables]]
name = "2"
material = "rope"
anchor_m = [10, 6, 7]
attachment_m = [0.5, 0.4, 0.25]
[[cables]]
name = "3"
material = "rope"
anchor_m = [-10, 6, 8]
attachment_m = [-0.5, 0.4, -0.25]
[[cables]]
name = "4"
material = "rope"
anchor_m = [-10, 6, 7]
attachment_m = [-0.5, 0.4, 0.25]
[[cables]]
name = "5"
material = "rope"
anchor_m = [-10, -6, 8]
attachment_m = [-0.5, -0.4, -0.25]
[[cables]]
name = "6"
material = "rope"
anchor_m = [-10, -6, 7]
attachment_m = [-0.5, -0.4, 0.25]
[[cables]]
name = "7"
material = "rope"
anchor_m = [10, -6, 8]
attachment_m = [0.5, -0.4, -0.25]
[[cables]]
name = "8"
material = "rope"
anchor_m = [10, -6, 7]
attachment_m = [0.5, -0.4, 0.25]
"#;

fn bound(
    robot: &Robot,
    pose: &Pose,
    model: StaticModel,
    side: PayloadSide,
    center_p: Vec3,
) -> Result<PayloadBound, StaticsError> {
    let requested = RequestedPayload { center_p, side, prove: true };
    statics::payload_bound(robot, pose, model, requested, None)
}

/// Robot with a payload as a load: its limits are those without payload.
fn with_payload(robot: &Robot, pose: &Pose, center_p: &Vec3, mass: f64) -> Robot {
    let (own, weight_w) = (robot.load, robot.gravity_w * mass);
    let arm_w = pose.rot_wp * (center_p - own.point_p);
    robot.with_load(Load {
        force_w: own.force_w + weight_w,
        moment_w: own.moment_w + arm_w.cross(&weight_w),
        point_p: own.point_p,
    })
}

fn is_held(robot: &Robot, pose: &Pose, model: StaticModel, center_p: &Vec3, mass: f64) -> bool {
    let loaded = with_payload(robot, pose, center_p, mass);
    statics::distribute_tensions(&loaded, pose, model, &TensionRule::Lowest).is_ok()
}

/// Largest payload that is held, by bisection between one that is held and one that is not.
fn bisected(robot: &Robot, pose: &Pose, model: StaticModel, center_p: &Vec3, mut held: f64, mut not: f64) -> f64 {
    assert!(is_held(robot, pose, model, center_p, held) && !is_held(robot, pose, model, center_p, not), "{held} {not}");
    while (held - not).abs() > 1e-9 * (held.abs() + not.abs()) {
        let middle = 0.5 * (held + not);
        if is_held(robot, pose, model, center_p, middle) { held = middle } else { not = middle }
    }
    held
}

/// Pose of the point mass at the lengths of its file.
fn point_pose() -> Pose {
    let robot = Robot::from_toml(POINT).unwrap();
    statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium.pose
}

fn limited(text: &str, minimum: f64, maximum: f64) -> Robot {
    let limits = TensionLimits { minimum: Some(minimum), maximum: Some(maximum) };
    Robot::from_toml(text).unwrap().with_tension_limits(limits)
}

/// Every robot, pose and centre has the payload at which the tension distribution of the loaded robot ends to exist.
#[test]
fn the_maximum_payload_is_where_tensions_within_the_limits_end() {
    let cases = [
        (Robot::from_toml(HALL).unwrap(), Pose::new([0.0, 0.0, 3.0], [0.0; 3]), Vec3::zeros()),
        (Robot::from_toml(HALL).unwrap(), Pose::new([3.0, 2.0, 4.0], [0.0, 0.0, 3.0]), Vec3::new(0.1, 0.0, -0.3)),
        (limited(COGIRO, 100.0, 3000.0), Pose::new([1.0, 2.0, 1.5], [0.0; 3]), Vec3::new(0.0, 0.1, 0.2)),
        (limited(COGIRO, 100.0, 3000.0), Pose::new([-5.0, 3.0, 2.5], [2.0, 0.0, 5.0]), Vec3::zeros()),
        (limited(funicular_robots::IPANEMA2, 20.0, 2000.0), Pose::new([0.0, 0.0, 1.0], [0.0; 3]), Vec3::zeros()),
        (seven_cables(0.05, 5.0, 900.0), Pose::new([0.1, 0.1, 0.1], [0.0; 3]), Vec3::new(0.02, 0.0, 0.05)),
        (limited(POINT, 1.0, 1e4), point_pose(), Vec3::zeros()),
    ];
    for (robot, pose, center_p) in cases {
        for model in [StaticModel::Ideal, StaticModel::Spring, StaticModel::Catenary] {
            let found = bound(&robot, &pose, model, PayloadSide::Maximum, center_p);
            let found = found.unwrap_or_else(|error| panic!("{}, {model:?}: {error}", robot.name));
            // A payload may be needed to keep the cables taut, so the bisection begins just below the maximum.
            let size = found.mass + robot.platform.mass;
            let held = found.mass - 1e-2 * size;
            let expected = bisected(&robot, &pose, model, &center_p, held, 4.0 * found.mass.abs() + 10.0);

            // The limits are met to a millionth, in both ways.
            assert!(
                (found.mass - expected).abs() < 2e-6 * size,
                "{}, {model:?}: {} {expected}",
                robot.name,
                found.mass
            );
            let excluded = found.excluded_from.unwrap_or_else(|| panic!("{}, {model:?}", robot.name));
            // The last attempt of a proof is a thousandth of the forces beyond, which contain the minimum tensions.
            assert!(excluded > found.mass && excluded < found.mass + 3e-3 * size, "{}: {excluded}", robot.name);
            assert!(found.residual < statics::RESIDUAL_LIMIT && found.iterations < 10, "{}", found.iterations);

            for (i, cable) in found.cables.iter().enumerate() {
                let margin = TensionRange::of(&robot, i, &cable.chord_w()).margin(cable);
                assert!(margin.distance() > -1e-6 * margin.range.maximum, "{}: {}", robot.name, margin.distance());
                let reached = found.limits.iter().find(|of| of.cable == i).map(|of| of.limit);
                assert_eq!(reached, margin.reached(), "{}, {model:?}, cable {i}", robot.name);
            }
        }
    }
}

/// Published nowhere, but found by an exhaustive sweep in steps of a kilogram: 605 kg in all, and the upper cables are
/// at their limits at the anchors.
#[test]
fn the_hall_robot_holds_545_kg_besides_its_platform_of_60_kg() {
    let robot = Robot::from_toml(HALL).unwrap();
    let pose = Pose::new([0.0, 0.0, 3.0], [0.0; 3]);
    let found = bound(&robot, &pose, StaticModel::Catenary, PayloadSide::Maximum, Vec3::zeros()).unwrap();
    assert!((545.0..546.0).contains(&found.mass), "{}", found.mass);
    for name in ["1", "3", "5", "7"] {
        let of = found.limits.iter().find(|of| robot.cables[of.cable].name == name).expect("it is at its limit");
        assert_eq!((of.limit, of.place), (Limit::Maximum, TensionPlace::Anchor));
    }
}

/// With as many straight cables as degrees of freedom, every tension is linear in the payload.
#[test]
fn the_payload_of_as_many_straight_cables_is_the_first_limit_on_a_line() {
    let robot = limited(funicular_robots::YUAN2014_4MM, 5.0, 300.0);
    let pose = Pose::new([0.3, 0.1, 0.6], [0.0, 2.0, 0.0]);
    let center_p = Vec3::new(0.02, -0.01, 0.1);
    let tensions = |mass: f64| -> Vec<f64> {
        let loaded = with_payload(&robot, &pose, &center_p, mass);
        let rest = statics::inverse(&loaded, &pose, StaticModel::Ideal).unwrap();
        rest.cables.iter().map(|cable| cable.tension_platform).collect()
    };
    let (without, with) = (tensions(0.0), tensions(1.0));
    let limits = without.iter().zip(&with).map(|(without, with)| {
        let rate = with - without;
        (if rate > 0.0 { 300.0 - without } else { 5.0 - without }) / rate
    });
    let expected = limits.fold(f64::INFINITY, f64::min);
    let found = bound(&robot, &pose, StaticModel::Ideal, PayloadSide::Maximum, center_p).unwrap();
    assert!((found.mass - expected).abs() < 1e-9 * expected, "{} {expected}", found.mass);
    assert_eq!(found.limits.len(), 1);
}

/// A light platform on cables with high minimum tensions, all of them above: only a payload keeps the cables taut.
#[test]
fn a_payload_may_be_needed() {
    let robot = limited(COGIRO, 400.0, 3000.0).with_mass(20.0);
    let pose = Pose::new([1.0, 2.0, 1.5], [0.0; 3]);
    let center_p = robot.platform.center_of_mass_p;
    for model in [StaticModel::Spring, StaticModel::Catenary] {
        assert!(!is_held(&robot, &pose, model, &center_p, 0.0));
        let least = bound(&robot, &pose, model, PayloadSide::Minimum, center_p).unwrap();
        let most = bound(&robot, &pose, model, PayloadSide::Maximum, center_p).unwrap();
        assert!(0.0 < least.mass && least.mass < most.mass, "{} {}", least.mass, most.mass);
        let expected = bisected(&robot, &pose, model, &center_p, 0.5 * (least.mass + most.mass), 0.0);
        assert!((least.mass - expected).abs() < 2e-6 * (least.mass + 20.0), "{} {expected}", least.mass);
        assert!(least.excluded_from.is_some_and(|mass| mass < least.mass && mass > 0.99 * least.mass));
        assert!(least.limits.iter().any(|of| of.limit == Limit::Minimum));
    }
    // A platform that is held without payload needs none.
    let heavy = limited(COGIRO, 100.0, 3000.0);
    let least = bound(&heavy, &pose, StaticModel::Catenary, PayloadSide::Minimum, center_p).unwrap();
    assert!(least.mass.abs() == 0.0);
}

#[test]
fn a_platform_that_is_too_heavy_has_a_negative_payload() {
    let robot = limited(COGIRO, 100.0, 3000.0);
    let pose = Pose::new([1.0, 2.0, 1.5], [0.0; 3]);
    let center_p = robot.platform.center_of_mass_p;
    let most = bound(&robot, &pose, StaticModel::Catenary, PayloadSide::Maximum, center_p).unwrap().mass;
    let heavier = robot.with_mass(robot.platform.mass + most + 25.0);
    let found = bound(&heavier, &pose, StaticModel::Catenary, PayloadSide::Maximum, center_p).unwrap();
    assert!((found.mass + 25.0).abs() < 1e-6 * heavier.platform.mass, "{}", found.mass);
}

#[test]
fn without_maximum_tensions_no_payload_is_too_heavy() {
    let mut robot = Robot::from_toml(COGIRO).unwrap();
    for cable in &mut robot.cables {
        cable.tension_limits = TensionLimits::default();
        cable.material.tension_limits = TensionLimits::default();
        cable.material.breaking_load = None;
    }
    let pose = Pose::new([1.0, 2.0, 1.5], [0.0; 3]);
    let center_p = robot.platform.center_of_mass_p;
    for model in [StaticModel::Ideal, StaticModel::Catenary] {
        let found = bound(&robot, &pose, model, PayloadSide::Maximum, center_p).unwrap();
        assert!(found.mass == f64::INFINITY && found.limits.is_empty() && found.cables.is_empty());
    }
    // A payload far beside the attachments tips the platform.
    let found = bound(&robot, &pose, StaticModel::Catenary, PayloadSide::Maximum, Vec3::new(30.0, 0.0, 0.0)).unwrap();
    assert!(found.mass.is_finite() && found.limits.iter().all(|of| of.limit == Limit::Minimum), "{found:?}");
}

#[test]
fn what_has_no_payload_is_refused() {
    let pose = Pose::new([1.0, 2.0, 1.5], [0.0; 3]);
    let mut robot = limited(COGIRO, 100.0, 3000.0);
    let refused = |robot: &Robot| {
        bound(robot, &pose, StaticModel::Catenary, PayloadSide::Maximum, Vec3::zeros()).unwrap_err().code()
    };
    robot.gravity_w = Vec3::zeros();
    assert_eq!(refused(&robot), "weightless-payload");
    robot.gravity_w = Vec3::new(0.0, 0.0, -9.81);
    robot.cables.truncate(5);
    assert_eq!(refused(&robot), "cable-count");
    // Far outside the anchors no payload helps.
    let far = Pose::new([100.0, 0.0, 1.5], [0.0; 3]);
    let robot = limited(COGIRO, 100.0, 3000.0);
    let error = bound(&robot, &far, StaticModel::Catenary, PayloadSide::Maximum, Vec3::zeros()).unwrap_err();
    assert_eq!(error, StaticsError::NoPayload);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..Default::default() })]

    /// Random robots whose cables sag: beyond the payload, which is proved, no tensions are found; at the payload the
    /// limits hold.
    #[test]
    fn payloads_of_random_robots_keep_their_limits(
        (robot, _) in any_robot(),
        x in -0.3f64..0.3,
        y in -0.3f64..0.3,
    ) {
        let pose = Pose::new([x, y, 0.3], [0.0; 3]);
        let robot = robot.with_tension_limits(TensionLimits { minimum: None,
            maximum: Some(50.0 * robot.platform.mass) });
        let center_p = Vec3::new(0.05, 0.0, 0.0);
        let Ok(found) = bound(&robot, &pose, StaticModel::Catenary, PayloadSide::Maximum,
            center_p) else { return Ok(()) };
        prop_assume!(found.mass.is_finite() && robot.cables.len() > 6);
        prop_assert!(found.residual < statics::RESIDUAL_LIMIT);
        for (i, cable) in found.cables.iter().enumerate() {
            let margin = TensionRange::of(&robot, i, &cable.chord_w()).margin(cable);
            prop_assert!(margin.distance() > -1e-6 * margin.range.maximum, "{}", margin.distance());
        }
        for beyond in [1.0, 1.1, 2.0] {
            if let Some(mass) = found.excluded_from {
                let beyond = mass + (beyond - 1.0) * (mass.abs() + robot.platform.mass);
                prop_assert!(!is_held(&robot, &pose, StaticModel::Catenary, &center_p, beyond));
            }
        }
    }
}

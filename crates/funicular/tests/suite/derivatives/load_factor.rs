//! Gradient of the load factor, against central differences of the load factor.

use super::{changes, extrapolated, rule_with_drives};
use funicular::gradient::{GradientError, Gradients, Hold, LoadFactorGradient};
use funicular::math::Vec3;
use funicular::robot::{
    Load, LoadShape, Pose, RequiredLoads, RequiredPayload, Robot, RobotChange, TensionLimits, Wind,
};
use funicular::statics::{self, LoadCapacity, StaticModel};
use std::fmt::Write as _;

struct LoadCase {
    name: String,
    robot: Robot,
    pose: Pose,
    model: StaticModel,
}

impl LoadCase {
    fn gradient(&self) -> Result<LoadFactorGradient, GradientError> {
        LoadFactorGradient::of(&LoadCapacity::at(&self.robot, &self.pose, self.model, None)?)
    }

    /// Load factor of the robot with a change, which may move the pose, too.
    fn changed(&self, change: &RobotChange, step: f64) -> Option<f64> {
        let robot = self.robot.changed(change, step);
        let pose = self.pose.moved(&(change.position_w * step), &(change.rotation_w * step));
        let capacity = LoadCapacity::at(&robot, &pose, self.model, None).ok()?;
        Some(capacity.load_factor().ok()?.value)
    }

    /// The six motions of the platform, then changes of every other kind, with names and steps.
    fn changes(&self) -> Vec<(String, RobotChange, f64)> {
        let none = || RobotChange::none(self.robot.cables.len());
        let mut all = Vec::new();
        for k in 0..3 {
            let axis = Vec3::ith(k, 1.0);
            all.push((format!("position {k}"), RobotChange { position_w: axis, ..none() }, 2e-3));
            all.push((format!("rotation {k}"), RobotChange { rotation_w: axis, ..none() }, 2e-3));
        }
        all.extend(changes(&self.robot).into_iter().map(|(what, change, step)| (what.to_owned(), change, step)));
        all
    }
}

/// Required loads of every kind, in proportion to a force.
fn all_kinds(force: f64) -> RequiredLoads {
    RequiredLoads {
        force_w: Vec3::new(1.0, 0.7, 0.4) * force,
        moment_w: Vec3::new(0.1, 0.05, 0.2) * force,
        listed: vec![Load {
            force_w: Vec3::new(0.3, -0.2, -0.5) * force,
            moment_w: Vec3::new(0.02, 0.0, -0.03) * force,
            point_p: Vec3::new(0.2, -0.1, 0.3),
        }],
        payload: RequiredPayload {
            min_mass: 0.01 * force,
            max_mass: 0.05 * force,
            center_p: Vec3::new(0.05, 0.1, -0.2),
            center_reach_p: Vec3::new(0.1, 0.05, 0.0),
        },
        acceleration_w: Vec3::new(0.4, 0.3, 0.5),
        angular_acceleration_w: Vec3::new(0.1, 0.0, 0.2),
        ..RequiredLoads::default()
    }
}

fn cases() -> Vec<LoadCase> {
    let mut all = Vec::new();
    let mut add = |name: &str, robot: &Robot, required: RequiredLoads, poses: &[[f64; 6]], model| {
        let robot = Robot { required, ..robot.clone() };
        for [x, y, z, a, b, c] in poses {
            let (robot, pose) = (robot.clone(), Pose::new([*x, *y, *z], [*a, *b, *c]));
            all.push(LoadCase { name: format!("{name} at {x}, {y}, {z}, {model:?}"), robot, pose, model });
        }
    };
    let poses = [[1.0, 0.5, 1.5, 2.0, -1.0, 3.0], [-2.5, 1.5, 2.2, 0.0, 4.0, -6.0], [0.3, -2.0, 0.8, 0.0, 0.0, 0.0]];
    let forces = |force: f64, moment: f64| RequiredLoads {
        force_w: Vec3::repeat(force),
        moment_w: Vec3::repeat(moment),
        ..RequiredLoads::default()
    };

    let cogiro = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    add("CoGiRo", &cogiro, forces(150.0, 30.0), &poses, StaticModel::Catenary);
    add("CoGiRo, all kinds", &cogiro, all_kinds(200.0), &poses, StaticModel::Catenary);
    add("CoGiRo, all kinds", &cogiro, all_kinds(200.0), &poses, StaticModel::Spring);

    // A ball of forces, and wind of the robot on the cables; required wind on the platform and straight cables.
    let limits = TensionLimits { minimum: Some(100.0), maximum: Some(3000.0) };
    let mut ipanema = Robot::from_toml(funicular_robots::IPANEMA2).unwrap().with_tension_limits(limits);
    ipanema.platform.drag_area = 0.8;
    ipanema.cables.iter_mut().for_each(|cable| cable.material.drag_width = Some(0.006));
    let ipanema = ipanema.with_wind(Wind { velocity_w: Vec3::new(8.0, 3.0, 0.5), ..Wind::default() });
    let ball = RequiredLoads { shape: LoadShape::Ellipsoid, ..forces(200.0, 40.0) };
    let windy = RequiredLoads { wind_speed: 10.0, ..ball.clone() };
    let poses = [[1.0, 0.5, 1.2, 2.0, -1.0, 3.0], [-1.5, 0.8, 1.5, 0.0, 4.0, -6.0]];
    add("IPAnema", &ipanema, ball, &poses, StaticModel::Catenary);
    add("IPAnema, required wind", &ipanema, windy, &poses, StaticModel::Spring);

    // Pulleys, winches and wind of random robots.
    for number in 0..12 {
        let of_rule = rule_with_drives::random_case(number);
        let weight = of_rule.robot.platform.mass * 9.81;
        let limits = TensionLimits { minimum: Some(0.03 * weight), maximum: Some(3.0 * weight) };
        let mut robot = of_rule.robot.with_tension_limits(limits);
        robot.required = forces(0.2 * weight, 0.02 * weight);
        all.push(LoadCase { name: format!("random {number}"), robot, pose: of_rule.pose, model: of_rule.model });
    }
    all
}

/// Difference of a gradient along a change from that of the load factor, over its tolerance. The load factor is found
/// to 1e-11 or better, over steps that change it by 1e-4 to 1e-2; `None` if it does not exist on both sides.
fn error_over_tolerance(case: &LoadCase, by: &RobotChange, (change, step): (&RobotChange, f64)) -> Option<f64> {
    let (difference, added) = extrapolated(step, |h| Some(vec![case.changed(change, h)?]))?;
    let tolerance = 2e-8 * difference[0].abs() + 1e-2 * added + 1e-11 / step;
    Some((by.dot(change) - difference[0]).abs() / tolerance)
}

/// Every number of the robot and every motion of the platform change the load factor as the load factor of the changed
/// robot says.
#[test]
fn the_load_factor_follows_every_number_and_the_pose() {
    let (mut compared, mut cases_compared) = (0, 0);
    for case in cases() {
        let found = match case.gradient() {
            Ok(found) => found,
            // Random poses whose dead load is not held.
            Err(GradientError::LoadFactor(_)) => continue,
            Err(error) => panic!("{}: {error}", case.name),
        };
        cases_compared += 1;
        for (what, change, step) in case.changes() {
            let Some(error) = error_over_tolerance(&case, &found.gradient, (&change, step)) else { continue };
            assert!(error <= 1.0, "{}, {what}: {error} of the tolerance", case.name);
            compared += 1;
        }
    }
    assert!(cases_compared >= 15 && compared > 300, "{cases_compared} {compared}");
}

/// The comparison sees a robot that is other by 1 %.
#[test]
fn a_gradient_of_a_robot_that_is_one_percent_heavier_is_told_apart() {
    for case in cases().into_iter().take(3) {
        let mut heavier = LoadCase { robot: case.robot.clone(), name: case.name.clone(), ..case };
        heavier.robot.platform.mass *= 1.01;
        let by = heavier.gradient().unwrap().gradient;
        for (what, change, step) in case.changes().into_iter().filter(|(what, ..)| what.starts_with("position")) {
            let error = error_over_tolerance(&case, &by, (&change, step)).unwrap();
            assert!(error > 1e3, "{what}: {error}");
        }
    }
}

/// With the lengths held, the platform moves with the robot, and the load factor with it.
#[test]
fn the_load_factor_follows_the_platform_if_the_lengths_are_held() {
    let mut robot = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    robot.required.force_w = Vec3::repeat(150.0);
    let pose = Pose::new([1.0, 0.5, 1.5], [2.0, -1.0, 3.0]);
    let rest = statics::inverse(&robot, &pose, StaticModel::Catenary).unwrap();
    let lengths: Vec<f64> = rest.cables.iter().map(|cable| cable.unstrained_length).collect();
    let by = Gradients::new(&robot, &rest, Hold::Lengths).unwrap().load_factor().unwrap().gradient;
    let mut compared = 0;
    for (what, change, step) in changes(&robot) {
        let factor = |h: f64| {
            let robot = robot.changed(&change, h);
            let lengths: Vec<f64> =
                lengths.iter().zip(&change.cables).map(|(l, of)| l + h * of.unstrained_length).collect();
            let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, Some(&pose)).ok()?;
            let capacity = LoadCapacity::at(&robot, &rest.pose, StaticModel::Catenary, None).ok()?;
            Some(vec![capacity.load_factor().ok()?.value])
        };
        let Some((difference, added)) = extrapolated(step, factor) else { continue };
        let error = (by.dot(&change) - difference[0]).abs();
        // Poses are found to 1e-11 m or so.
        assert!(error <= 1e-7 * difference[0].abs() + added + 1e-10 / step, "{what}: {error:e} of {difference:?}");
        compared += 1;
    }
    assert!(compared >= 9, "{compared}");
}

#[test]
fn load_factors_without_derivatives_are_refused_with_the_reason() {
    let required = RequiredLoads { force_w: Vec3::repeat(100.0), ..RequiredLoads::default() };
    let robot = Robot { required, ..Robot::from_toml(funicular_robots::COGIRO).unwrap() };
    let refused = |robot: &Robot, position: [f64; 3], model: StaticModel| {
        let capacity = LoadCapacity::at(robot, &Pose::new(position, [0.0; 3]), model, None).unwrap();
        LoadFactorGradient::of(&capacity).unwrap_err().to_string()
    };

    let none = Robot { required: RequiredLoads::default(), ..robot.clone() };
    let message = refused(&none, [1.0, 0.5, 1.5], StaticModel::Catenary);
    assert!(message.contains("required"), "{message}");
    let mut unlimited = robot.clone();
    for cable in &mut unlimited.cables {
        cable.tension_limits = TensionLimits { minimum: Some(1.0), maximum: None };
        (cable.material.tension_limits, cable.material.breaking_load) = (TensionLimits::default(), None);
    }
    let downwards = Load { force_w: Vec3::new(0.0, 0.0, -100.0), ..Load::default() };
    unlimited.required = RequiredLoads { listed: vec![downwards], ..RequiredLoads::default() };
    let message = refused(&unlimited, [0.0, 0.0, 1.5], StaticModel::Catenary);
    assert!(message.contains("no maximum tension"), "{message}");
    let mut windy = robot.clone();
    windy.required.wind_speed = 5.0;
    windy.cables[0].material.drag_width = Some(0.01);
    let message = refused(&windy, [1.0, 0.5, 1.5], StaticModel::Catenary);
    assert!(message.contains("required wind"), "{message}");
    let message = refused(&robot, [1.0, 0.5, 1.5], StaticModel::Ideal);
    assert!(message.contains("ideal cables are rigid"), "{message}");

    // Four cables are alike in the middle of a symmetric robot, where three limits would do.
    let mut text =
        "name = \"symmetric\"\n[platform]\nmass_kg = 20.0\ninertia_kg_m2 = [1.0, 1.0, 1.0]\n[materials.rope]\n\
                    axial_stiffness_n = 1e5\nmass_kg_per_m = 0.02\n"
            .to_owned();
    for i in 0..8 {
        let sign = |bit: usize| if i & bit == 0 { 1.0 } else { -1.0 };
        let (x, y, z) = (sign(1), sign(2), sign(4));
        writeln!(
            text,
            "[[cables]]\nname = \"{i}\"\nmaterial = \"rope\"\nanchor_m = [{}, {}, {}]\nattachment_m = [{}, {}, {}]",
            4.0 * x,
            3.0 * y,
            2.0 * z,
            0.3 * x,
            0.2 * y,
            -0.1 * z
        )
        .unwrap();
    }
    let limits = TensionLimits { minimum: Some(20.0), maximum: Some(1000.0) };
    let symmetric = Robot { required: unlimited.required.clone(), ..Robot::from_toml(&text).unwrap() };
    let message = refused(&symmetric.with_tension_limits(limits), [0.0; 3], StaticModel::Catenary);
    assert!(message.contains("different derivatives on both sides"), "{message}");
}

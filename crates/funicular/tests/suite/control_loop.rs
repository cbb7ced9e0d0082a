//! Statics in a control loop: equal to the statics of the program, rates equal to those along a path, lengths to pose
//! and tensions to load as inverses, and statuses of everything that goes wrong.

use crate::library::library;
use funicular::control_loop::{
    ControlLoop, LoopFault, LoopInput, LoopModel, LoopState, LoopStatus, NotForLoop, pose_from_quaternion,
};
use funicular::math::{Vec3, Vec6};
use funicular::path::PathPoint;
use funicular::robot::{Constraint, PlatformMotion, Pose, Robot, TensionLimits};
use funicular::statics::{self, Equilibrium, StaticModel, StaticsError, TensionRule, tension_centre};
use funicular::trajectory::AlongPath;

/// Numbers between −1 and 1 that repeat with their seed.
struct Spread(u64);

impl Spread {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self, size: f64) -> Vec3 {
        Vec3::from_fn(|_, _| size * self.next())
    }

    fn six(&mut self, linear: f64, angular: f64) -> Vec6 {
        let (v, w) = (self.vector(linear), self.vector(angular));
        Vec6::new(v.x, v.y, v.z, w.x, w.y, w.z)
    }

    /// Pose near another one, within the motions of the platform.
    fn near(&mut self, robot: &Robot, pose: &Pose, reach: f64, turn: f64) -> Pose {
        let motion = robot.platform.motion;
        let step = motion.allowed(&self.six(reach, turn));
        pose.moved(&Vec3::new(step[0], step[1], step[2]), &Vec3::new(step[3], step[4], step[5]))
    }
}

/// Robots of the library that a loop can compute, those without maximum tensions with one.
fn robots() -> Vec<(String, LoopModel, Pose)> {
    let all = library().into_iter().filter(|(_, robot, _)| !robot.constraint().is_under());
    all.filter_map(|(name, mut robot, rest)| {
        let highest = rest.cables.iter().map(|cable| cable.tension_platform).fold(0.0, f64::max);
        if robot.cables.iter().any(|cable| cable.limits().maximum.is_none()) {
            robot = robot.with_tension_limits(TensionLimits { minimum: None, maximum: Some(3.0 * highest) });
        }
        Some((name, LoopModel::new(robot).ok()?, rest.pose))
    })
    .collect()
}

fn close(a: f64, b: f64, relative: f64) -> bool {
    (a - b).abs() <= relative * a.abs().max(b.abs()) + 1e-12
}

fn check_equal(name: &str, found: &LoopState, rest: &Equilibrium) {
    for (i, state) in rest.cables.iter().enumerate() {
        let cable = &found.cables[i];
        for (a, b) in [
            (cable.length, state.unstrained_length),
            (cable.free_length, state.free_length()),
            (cable.tension_platform, state.tension_platform),
            (cable.tension_drum, state.tension_drum()),
        ] {
            assert!(close(a, b, 1e-10), "{name}, cable {i}: {a} {b}");
        }
    }
}

#[test]
fn results_are_those_of_the_program() {
    let mut spread = Spread(1);
    let (mut certified, mut missed) = ([0, 0], 0);
    for (name, model, home) in robots() {
        let robot = model.robot();
        let size = robot.platform_length();
        let (mut warm, mut held) = (ControlLoop::new(), 0);
        for k in 0..60 {
            let pose = spread.near(robot, &home, 0.6 * size, 0.1);
            let mut cold = ControlLoop::new();
            let input = LoopInput::at_rest(&pose);
            let results = [cold.inverse(&model, &input, false), warm.inverse(&model, &input, false)];
            let catenary = StaticModel::Catenary;
            let has_choice = robot.constraint().is_redundant();
            let rest = if has_choice {
                tension_centre(robot, &pose, catenary, None).map(|centre| centre.equilibrium)
            } else {
                statics::inverse(robot, &pose, catenary)
            };
            for found in &results {
                match (&rest, found) {
                    (Ok(rest), Ok(found)) if found.status <= LoopStatus::Accepted => {
                        check_equal(&name, found, rest);
                        held += usize::from(found.status == LoopStatus::Certified);
                    }
                    // The only tensions may be beyond limits, which the program's statics does not judge.
                    (Ok(rest), Ok(found)) if !has_choice && found.status == LoopStatus::BeyondLimits => {
                        check_equal(&name, found, rest);
                    }
                    // With as many cables as degrees of freedom the program tries many starts for slack cables.
                    (Ok(_), Err(LoopFault::NotFound)) if !has_choice => missed += 1,
                    (Ok(_), other) => panic!("{name}, {k}: {other:?}"),
                    (Err(_), Ok(found)) => {
                        assert!(found.status >= LoopStatus::BeyondLimits, "{name}, {k}: {:?}", found.status);
                    }
                    (Err(_), Err(fault)) => {
                        assert!(matches!(fault, LoopFault::NotFound | LoopFault::Singular), "{fault}");
                    }
                }
            }
        }
        println!("{name}: {held} of 120 certified");
        certified[usize::from(robot.constraint().is_redundant())] += held;
    }
    assert!(certified[0] > 100 && certified[1] > 500 && missed < 12, "{certified:?} {missed}");
}

/// Rates by the derivatives of the centre, accelerations by differences of these, with inertia; over pulleys and
/// without, rigid platforms, a point mass and a planar robot.
#[test]
fn lengths_move_as_along_a_path() {
    let mut spread = Spread(2);
    for (name, model, home) in robots() {
        let robot = model.robot();
        if !robot.constraint().is_redundant() {
            continue;
        }
        let size = robot.platform_length();
        let mut along = AlongPath::new(robot, StaticModel::Catenary, TensionRule::Centre, false);
        let mut compared = 0;
        for _ in 0..6 {
            let six = |spread: &mut Spread| robot.platform.motion.allowed(&spread.six(0.3 * size, 0.1));
            let pose = spread.near(robot, &home, 0.1 * size, 0.02);
            let motion = PathPoint {
                pose,
                velocity_w: six(&mut spread),
                acceleration_w: six(&mut spread),
                jerk_w: six(&mut spread),
            };
            let found = ControlLoop::new().inverse(&model, &LoopInput::moving(motion), true);
            let (Ok(found), Ok(exact)) = (found, along.at(&motion)) else { continue };
            if found.status != LoopStatus::Certified || exact.no_exact_rates.is_some() {
                continue;
            }
            check_equal(&name, &found, &exact.equilibrium);
            let speed = exact.length_rates.iter().fold(0.0, |most: f64, rate| most.max(rate.abs()));
            for (i, rate) in exact.length_rates.iter().enumerate() {
                let got = found.cables[i].length_rate;
                assert!((got - rate).abs() < 1e-8 * speed, "{name}, cable {i}: {got} {rate} of {speed}");
            }

            // The rates at times nearby, by a path of the same derivatives.
            let step = 1e-3;
            let rates = [-2.0, -1.0, 1.0, 2.0].map(|part| along.at(&later(&motion, part * step)).unwrap().length_rates);
            let size: f64 = found.cables.iter().map(|cable| cable.length_acceleration.abs()).fold(0.0, f64::max);
            for (i, cable) in found.cables.iter().enumerate().take(robot.cables.len()) {
                let difference = 8.0 * (rates[2][i] - rates[1][i]) - (rates[3][i] - rates[0][i]);
                let (wanted, got) = (difference / (12.0 * step), cable.length_acceleration);
                assert!((wanted - got).abs() < 1e-5 * size, "{name}, cable {i}: {wanted} {got} of {size}");
            }
            compared += 1;
        }
        println!("{name}: {compared}");
        assert!(compared > 0 || name != "cogiro", "{name}");
    }
}

/// Motion a time later with constant jerk.
fn later(point: &PathPoint, time: f64) -> PathPoint {
    let change =
        point.velocity_w * time + point.acceleration_w * (time * time / 2.0) + point.jerk_w * (time.powi(3) / 6.0);
    let part = |first: usize| Vec3::new(change[first], change[first + 1], change[first + 2]);
    PathPoint {
        pose: point.pose.moved(&part(0), &part(3)),
        velocity_w: point.velocity_w + point.acceleration_w * time + point.jerk_w * (time * time / 2.0),
        acceleration_w: point.acceleration_w + point.jerk_w * time,
        jerk_w: point.jerk_w,
    }
}

#[test]
fn lengths_lead_back_to_the_pose_and_tensions_to_the_load() {
    let mut spread = Spread(3);
    for (name, model, home) in robots() {
        let robot = model.robot();
        let size = robot.platform_length();
        let weight = robot.platform.mass * robot.gravity_w.norm();
        let mut back = 0;
        for _ in 0..10 {
            let pose = spread.near(robot, &home, 0.1 * size, 0.02);
            let can_turn = robot.platform.motion.can_turn();
            let wrench = spread.six(0.02 * weight, if can_turn { 0.01 * weight * size } else { 0.0 });
            let wrench = robot.platform.motion.allowed(&wrench);
            let part = |first: usize| Vec3::new(wrench[first], wrench[first + 1], wrench[first + 2]);
            let input = LoopInput { force_w: part(0), moment_w: part(3), ..LoopInput::at_rest(&pose) };
            let mut control = ControlLoop::new();
            let Ok(found) = control.inverse(&model, &input, false) else { continue };
            if found.status > LoopStatus::Accepted {
                continue;
            }
            let cables = &found.cables[..model.cables()];

            // From a pose a few millimetres away.
            let start = spread.near(robot, &pose, 2e-3 * size, 1e-3);
            let lengths: Vec<f64> = cables.iter().map(|cable| cable.length).collect();
            let Ok(forward) = control.forward(&model, &lengths, Some(&input), Some(&start)) else {
                panic!("{name}: no pose");
            };
            let moved = (forward.pose.position_w - pose.position_w).norm();
            let turned = forward.pose.rot_wp.angle_to(&pose.rot_wp);
            // Unstable equilibria have no certificate.
            assert!(moved < 1e-8 * size && turned < 1e-8, "{name}: {moved:e} {turned:e} {forward:?}");
            assert!(forward.error_length < 1e-6 * size);
            back += usize::from(forward.status == LoopStatus::Certified);

            let tensions: Vec<f64> = cables.iter().map(|cable| cable.tension_drum).collect();
            let load = control.load(&model, &input, &tensions).unwrap();
            let error = (load.force_w - input.force_w).norm() + (load.moment_w - input.moment_w).norm() / size;
            assert!(error < 1e-8 * weight, "{name}: {error}");
        }
        println!("{name}: {back} of 10 certified");
        assert!(back > 0 || !name.starts_with("cogiro"), "{name}");
    }
}

#[test]
fn a_payload_is_weighed() {
    let robot = Robot::from_toml(funicular_robots::COGIRO_WINCHES).unwrap();
    let heavier = robot.with_mass(robot.platform.mass + 25.0);
    let pose = Pose::new([0.5, -0.5, 1.2], [0.0, 0.0, 3.0]);
    let [empty, loaded] = [robot, heavier].map(|robot| LoopModel::new(robot).unwrap());
    let input = LoopInput::at_rest(&pose);
    let found = ControlLoop::new().inverse(&loaded, &input, false).unwrap();
    let tensions: Vec<f64> = found.cables[..8].iter().map(|cable| cable.tension_drum).collect();
    let load = ControlLoop::new().load(&empty, &input, &tensions).unwrap();
    assert!((load.payload - 25.0).abs() < 1e-8, "{load:?}");
    let slack = ControlLoop::new().load(&empty, &input, &[0.0; 8]);
    assert_eq!(slack, Err(LoopFault::TooSlack { cable: 0 }));
}

fn cogiro() -> LoopModel {
    LoopModel::new(Robot::from_toml(funicular_robots::COGIRO).unwrap()).unwrap()
}

#[test]
fn bad_input_changes_nothing_and_poses_outside_have_a_status() {
    let model = cogiro();
    let mut control = ControlLoop::new();
    let home = Pose::new([1.0, -2.0, 1.5], [0.0; 3]);
    let first = control.inverse(&model, &LoopInput::at_rest(&home), true).unwrap();
    assert_eq!(first.status, LoopStatus::Certified);

    for bad in [f64::NAN, f64::INFINITY, -1e300] {
        let mut inputs = [LoopInput::at_rest(&home); 5];
        inputs[0].motion.pose.position_w.y = bad;
        inputs[1].motion.velocity_w[4] = bad;
        inputs[2].motion.acceleration_w[0] = bad;
        inputs[3].force_w.x = bad;
        inputs[4].moment_w.z = bad;
        for input in &inputs {
            assert_eq!(control.inverse(&model, input, true), Err(LoopFault::BadInput));
            assert_eq!(control.load(&model, input, &[500.0; 8]), Err(LoopFault::BadInput));
        }
        assert_eq!(control.forward(&model, &[bad; 8], None, None), Err(LoopFault::BadInput));
        assert_eq!(control.load(&model, &LoopInput::at_rest(&home), &[bad; 8]), Err(LoopFault::BadInput));
    }
    assert_eq!(control.forward(&model, &[1.0; 7], None, None), Err(LoopFault::BadInput));
    assert_eq!(ControlLoop::new().forward(&model, &[9.0; 8], None, None), Err(LoopFault::NoStart));

    // Nothing has changed: the next step is as short as it would have been.
    let again = control.inverse(&model, &LoopInput::at_rest(&home), true).unwrap();
    assert!(again.iterations <= 2 && again.cables[3].length.to_bits() != 0, "{}", again.iterations);

    // A metre and a half a kilometre outside.
    let outside = |x: f64| LoopInput::at_rest(&Pose::new([x, 0.0, 1.0], [0.0; 3]));
    let found = control.inverse(&model, &outside(6.4), false).unwrap();
    assert!(found.status == LoopStatus::BeyondLimits && found.least_margin < 0.0, "{found:?}");
    let far = control.inverse(&model, &outside(500.0), false).unwrap();
    assert!(far.status >= LoopStatus::BeyondLimits, "{far:?}");
    let mut count = 0;
    for x in 0..200 {
        let Ok(found) = control.inverse(&model, &outside(5.0 + f64::from(x)), true) else { continue };
        let is_finite = |cable: &funicular::control_loop::LoopCable| {
            cable.length.is_finite() && cable.length_rate.is_finite() && cable.margin.is_finite()
        };
        assert!(found.cables[..8].iter().all(is_finite));
        count += usize::from(found.status == LoopStatus::Held && found.age > 0);
    }
    println!("{count} held");
}

#[test]
fn quaternions_of_either_sign_are_normalised_and_others_are_refused() {
    let model = cogiro();
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let quaternion = [half, 0.02, 0.0, half];
    let at = |scale: f64| pose_from_quaternion([0.5, 0.0, 1.0], quaternion.map(|part| part * scale));
    let lengths = [1.0, -1.0, 1.0005, 0.9995].map(|scale| {
        let found = ControlLoop::new().inverse(&model, &LoopInput::at_rest(&at(scale).unwrap()), false);
        found.unwrap().cables[0].length
    });
    assert!(lengths.iter().all(|length| (length - lengths[0]).abs() < 1e-12), "{lengths:?}");
    for bad in [1.01, 0.99, 0.0, f64::NAN, f64::INFINITY, 1e300] {
        assert!(at(bad).is_none(), "{bad}");
    }
}

#[test]
fn robots_that_a_loop_cannot_compute_are_refused_by_their_keys() {
    let robot = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    let changed = |change: &dyn Fn(&mut Robot)| {
        let mut robot = robot.clone();
        change(&mut robot);
        LoopModel::new(robot).map(|_| ()).unwrap_err()
    };
    let many = changed(&|robot| {
        robot.cables.extend_from_within(..);
        robot.cables.extend_from_within(..1);
    });
    assert_eq!(many, NotForLoop::TooManyCables { cables: 17 });
    let few = changed(&|robot| robot.cables.truncate(5));
    assert_eq!(few, NotForLoop::TooFewCables { cables: 5, dof: 6 });
    let loose = changed(&|robot| {
        for cable in &mut robot.cables {
            cable.tension_limits.maximum = None;
            cable.material.tension_limits.maximum = None;
            cable.material.breaking_load = None;
        }
    });
    assert!(matches!(&loose, NotForLoop::NoMaximum { .. }) && loose.to_string().contains("maximum_tension_n"));
    let against = changed(&|robot| {
        robot.cables[2].tension_limits = TensionLimits { minimum: Some(500.0), maximum: Some(500.0) };
    });
    assert!(matches!(against, NotForLoop::LimitsContradict { .. }));
    let point = changed(&|robot| robot.cables.iter_mut().for_each(|cable| cable.attachment_p = Vec3::zeros()));
    assert_eq!(point, NotForLoop::FreeMotion);

    // Sixteen cables have room, and as many as degrees of freedom need no maximum.
    let mut sixteen = robot.clone();
    sixteen.cables.extend_from_within(..);
    let model = LoopModel::new(sixteen).unwrap();
    let found = ControlLoop::new().inverse(&model, &LoopInput::at_rest(&Pose::new([0.5, 0.0, 1.0], [0.0; 3])), true);
    assert_eq!(found.unwrap().status, LoopStatus::Certified);
    let six = LoopModel::new(Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap()).unwrap();
    assert!(six.robot().constraint() == Constraint::Fully && six.robot().platform.motion == PlatformMotion::Rigid);
}

#[test]
fn the_same_calls_give_the_same_digits_after_a_reset_and_in_other_threads() {
    let model = cogiro();
    let run = |control: &mut ControlLoop| -> Vec<u64> {
        let mut spread = Spread(5);
        let poses = (0..50).map(|_| Pose::new([4.0 * spread.next(), 3.0 * spread.next(), 1.5], [0.0; 3]));
        let results = poses.map(|pose| control.inverse(&model, &LoopInput::at_rest(&pose), false).unwrap());
        results.flat_map(|state| state.cables.map(|cable| cable.length.to_bits())).collect()
    };
    let mut control = ControlLoop::new();
    let first = run(&mut control);
    control.reset();
    assert_eq!(run(&mut control), first);
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..8).map(|_| scope.spawn(|| run(&mut ControlLoop::new()))).collect();
        assert!(threads.into_iter().all(|thread| thread.join().unwrap() == first));
    });
}

/// Outside of its workspace CoGiRo has no tensions within the limits. The least violation is that of the rule `middle`.
#[test]
fn beyond_the_limits_the_violation_is_little_more_than_the_least() {
    let robot = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    let robot = robot.with_tension_limits(TensionLimits { minimum: Some(100.0), maximum: Some(5000.0) });
    let model = LoopModel::new(robot.clone()).unwrap();
    let mut control = ControlLoop::new();
    for x in [5.335, 5.35, 5.4, 5.5, 5.7, 6.0] {
        let pose = Pose::new([x, 0.0, 1.0], [0.0; 3]);
        let input = LoopInput::at_rest(&pose);
        let [cold, warm] = [ControlLoop::new().inverse(&model, &input, true), control.inverse(&model, &input, true)];
        let (cold, warm) = (cold.unwrap(), warm.unwrap());
        let none = statics::distribute_tensions(&robot, &pose, StaticModel::Catenary, &TensionRule::Middle);
        let Err(StaticsError::BeyondLimits(least)) = none else { panic!("{x}: {none:?}") };
        println!(
            "{x} m: {:.3} N, least {:.3} N; {} and {} steps",
            -cold.least_margin, least.by, cold.iterations, warm.iterations
        );
        assert!(cold.status == LoopStatus::BeyondLimits && warm.status == LoopStatus::BeyondLimits);
        assert!((cold.least_margin - warm.least_margin).abs() < 1e-6, "{} {}", cold.least_margin, warm.least_margin);
        // The parabolas pull back with a width of 4.9 N.
        assert!(-cold.least_margin > least.by * (1.0 - 1e-6) && -cold.least_margin < 1.4 * least.by + 2.0, "{x}");
    }
}

/// The default minimum grows with the cable, so that it meets a low maximum at some poses only.
#[test]
fn limits_that_contradict_at_a_pose_have_a_fault() {
    let mut robot = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    for cable in &mut robot.cables {
        cable.tension_limits = TensionLimits { minimum: None, maximum: Some(20.0) };
        cable.material.tension_limits.minimum = None;
    }
    let model = LoopModel::new(robot).unwrap();
    let far = LoopInput::at_rest(&Pose::new([40.0, 0.0, 1.0], [0.0; 3]));
    let found = ControlLoop::new().inverse(&model, &far, true);
    assert!(matches!(found, Err(LoopFault::LimitsContradict { .. })), "{found:?}");
}

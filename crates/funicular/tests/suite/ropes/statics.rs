//! Statics of ropes over sheaves.

use super::{BODY, Fall, HEAVY, LIGHT, POINT, hanging, robot_of, text_of};
use funicular::math::{Mat6, Vec3, Vec6};
use funicular::robot::{Pose, Robot, State};
use funicular::statics::{self, Equilibrium, StaticModel, TensionRule};

const GRAVITY: f64 = 9.81;

fn rest(robot: &Robot) -> Equilibrium {
    statics::solve(robot, StaticModel::Catenary, None).unwrap().equilibrium
}

/// Robot whose cables are ropes of their own.
fn separate(robot: &Robot) -> Robot {
    Robot { ropes: Vec::new(), ..robot.clone() }
}

/// Two vertical falls carry half of the weight each, and the platform rests on a stiffness of 4 EA/L.
#[test]
fn each_fall_of_a_block_carries_half_of_the_load() {
    let falls = [Fall::new([0.0; 3], Some(7.0), None), Fall::new([0.0; 3], Some(3.0), Some(0))];
    let found = rest(&robot_of(POINT, LIGHT, &falls));
    let half = 0.5 * 100.0 * GRAVITY;
    let length = 10.0_f64;
    for cable in &found.cables {
        assert!((cable.tension_platform - half).abs() < 1e-9 * half);
        assert!((cable.unstrained_length - 5.0).abs() < 1e-9);
    }
    assert!((found.pose.position_w.z + 5.0 * (1.0 + half / 2e5)).abs() < 1e-9);
    let stiffness = statics::tangent_stiffness(&robot_of(POINT, LIGHT, &falls), &found).unwrap();
    assert!((stiffness[(2, 2)] - 4.0 * 2e5 / length).abs() < 1e-6 * stiffness[(2, 2)]);
}

/// Without weight the parts have one strain, and the platform hangs at the lowest point of an ellipse whose foci are
/// the anchors: both parts have one angle θ to the vertical, sin θ = d/ℓ.
#[test]
fn a_light_rope_between_two_anchors_hangs_at_the_bottom_of_an_ellipse() {
    let robot = hanging(LIGHT, [4.0, 4.0]);
    let found = rest(&robot);
    let (across, drop, length) = (5.0_f64, 1.5_f64, 8.0_f64);
    let mut tension = 0.5 * 100.0 * GRAVITY;
    let mut cos = 1.0;
    for _ in 0..200 {
        let sin = across / (length * (1.0 + tension / 2e5));
        cos = (1.0 - sin * sin).sqrt();
        tension = 0.5 * 100.0 * GRAVITY / cos;
    }
    let whole = length * (1.0 + tension / 2e5);
    let first = 0.5 * (whole + drop / cos);
    let expected = Vec3::new(-3.0 + first * (1.0 - cos * cos).sqrt(), 0.0, 1.0 - first * cos);
    assert!((found.pose.position_w - expected).norm() < 1e-9, "{} {expected}", found.pose.position_w);
    for cable in &found.cables {
        assert!((cable.tension_platform - tension).abs() < 1e-8 * tension);
    }
    let sum: f64 = found.cables.iter().map(|cable| cable.unstrained_length).sum();
    assert!((sum - length).abs() < 1e-12 && found.residual < 1e-10 && found.stability.is_stable() == Some(true));
}

/// The rope's division of its length is the one of least energy among those of two separate ropes, found by a search
/// that knows nothing of sheaves; which lengths the file gives each cable does not matter.
#[test]
fn a_heavy_rope_divides_itself_at_the_least_energy() {
    let robot = hanging(HEAVY, [4.0, 4.0]);
    let two = separate(&robot);
    let at = |first: f64| statics::forward(&two, &[first, 8.0 - first], StaticModel::Catenary, None).unwrap();
    let energy = |first: f64| statics::energy(&two, &at(first));
    let (mut low, mut high) = (3.0, 7.0);
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    for _ in 0..60 {
        let (a, b) = (high - golden * (high - low), low + golden * (high - low));
        if energy(a) < energy(b) { high = b } else { low = a }
    }
    let first = 0.5 * (low + high);

    for lengths in [[4.0, 4.0], [1.0, 7.0], [6.5, 1.5]] {
        let found = rest(&hanging(HEAVY, lengths));
        // The energy is flat at its minimum: its place has half of the digits.
        assert!((found.cables[0].unstrained_length - first).abs() < 1e-5);
        assert!((found.pose.position_w - at(first).pose.position_w).norm() < 1e-5);
        let [a, b] = [0, 1].map(|i| found.cables[i].tension_platform);
        assert!((a - b).abs() < 1e-9 * a, "{a} {b}");
        assert!((statics::energy(&hanging(HEAVY, lengths), &found) - energy(first)).abs() < 1e-8);
    }
}

/// A platform with two ropes: one over two sheaves of the platform, which are apart, one over a sheave of the platform
/// and one of the frame to the platform again; with pulleys and a winch that yields.
fn platform() -> Robot {
    let falls = [
        Fall::of_body([-4.0, -3.0, 5.0], [-0.8, -0.6, 0.2], None, "winch = \"drum\""),
        Fall::of_body([-4.0, 3.0, 5.2], [-0.8, 0.6, 0.3], Some(0), ""),
        Fall::of_body([4.0, 3.0, 5.0], [0.8, 0.6, 0.2], None, "pulley = \"wheel\"\nwinch = \"drum\""),
        Fall::of_body([3.9, 2.0, 5.0], [0.8, 0.5, 0.2], Some(2), ""),
        Fall::of_body([3.9, -2.5, 4.9], [0.7, -0.6, 0.2], Some(3), ""),
        Fall::of_body([4.0, -3.0, 5.0], [0.8, -0.6, 0.1], None, ""),
    ];
    robot_of(BODY, HEAVY, &falls)
}

#[test]
fn the_stiffness_of_running_ropes_is_the_derivative_of_their_wrench() {
    let robot = platform();
    let found = rest(&robot);
    assert!(found.residual < 1e-10, "{}", found.residual);
    let lengths = [5.0, 5.0, 5.0, 5.0, 5.0, 5.0];
    let wrench = |motion: Vec6| {
        let pose = found.pose.moved(&motion.fixed_rows::<3>(0).into(), &motion.fixed_rows::<3>(3).into());
        statics::wrench(&robot, &pose, &lengths, StaticModel::Catenary).unwrap()
    };
    let step = 1e-5;
    let mut expected = Mat6::zeros();
    for k in 0..6 {
        let motion = Vec6::from_fn(|i, _| if i == k { step } else { 0.0 });
        expected.set_column(k, &((wrench(-motion) - wrench(motion)) / (2.0 * step)));
    }
    let stiffness = statics::tangent_stiffness(&robot, &found).unwrap();
    let error = (stiffness - expected).norm() / expected.norm();
    assert!(error < 1e-7, "{error} {stiffness} {expected}");

    // The ropes run: with their lengths held by sheaves at rest the platform is stiffer.
    let mut stuck = robot.clone();
    stuck.ropes.iter_mut().flat_map(|rope| &mut rope.efficiencies).for_each(|efficiency| *efficiency = 0.95);
    let held = statics::tangent_stiffness(&stuck, &found).unwrap();
    let alone = statics::tangent_stiffness(&separate(&robot), &found).unwrap();
    assert!((held - alone).norm() < 1e-12 * alone.norm());
    let softer = (alone - stiffness).symmetric_eigenvalues();
    assert!(softer.max() > 0.1 * alone.norm() && softer.min() > -1e-9 * alone.norm(), "{softer}");
}

#[test]
fn lengths_of_a_pose_give_the_pose_back() {
    let falls = |count: usize| -> Vec<Fall> {
        (0..count)
            .flat_map(|k| {
                let angle = 0.4 + std::f64::consts::TAU * k as f64 / count as f64;
                let (sin, cos) = angle.sin_cos();
                [
                    Fall::new([4.0 * cos, 4.0 * sin, 5.0], None, None),
                    Fall::new([4.2 * cos, 4.1 * sin + 0.3, 5.5], None, Some(2 * k)),
                ]
            })
            .collect()
    };
    let pose = Pose::new([0.3, -0.2, 1.0], [0.0; 3]);
    for (count, rope) in [(3, HEAVY), (3, LIGHT), (4, HEAVY), (5, LIGHT)] {
        let robot = Robot { state: State::Pose(pose), ..robot_of(POINT, rope, &falls(count)) };
        let rule = (count > 3).then_some(TensionRule::Lowest);
        let held = statics::solve(&robot, StaticModel::Catenary, rule.clone()).unwrap();
        assert_eq!(held.rule, rule);
        let found = held.equilibrium;
        assert!(found.residual < 1e-10);
        for pair in found.cables.chunks(2) {
            let [a, b] = [pair[0].tension_platform, pair[1].tension_platform];
            assert!((a - b).abs() < 1e-9 * a && a > 0.0, "{a} {b}");
        }
        let lengths: Vec<f64> = found.cables.iter().map(|cable| cable.unstrained_length).collect();
        let back = statics::forward(&robot, &lengths, StaticModel::Catenary, None).unwrap();
        assert!((back.pose.position_w - pose.position_w).norm() < 1e-8, "{count} {}", back.pose.position_w);
    }
}

/// One rope holds the poses on one curve: where both parts have one angle to the vertical.
#[test]
fn one_rope_finds_the_nearest_pose_that_it_can_hold() {
    let at = |position: [f64; 3]| Robot {
        state: State::Pose(Pose::new(position, [0.0; 3])),
        ..robot_of(
            POINT,
            "axial_stiffness_n = 1e9\nmass_kg_per_m = 0.0",
            &[Fall::new([-2.0, 0.0, 0.0], None, None), Fall::new([2.0, 0.0, 0.0], None, Some(0))],
        )
    };
    let found = statics::solve(&at([0.4, 0.3, -3.0]), StaticModel::Catenary, None).unwrap();
    let (_, distance) = found.requested_pose.unwrap();
    assert!((distance - 0.5).abs() < 1e-7);
    assert!((found.equilibrium.pose.position_w - Vec3::new(0.0, 0.0, -3.0)).norm() < 1e-6);
}

#[test]
fn what_is_not_one_rope_is_refused() {
    let falls = [Fall::new([0.0; 3], Some(7.0), None), Fall::new([1.0, 0.0, 0.0], Some(3.0), Some(0))];
    let text = text_of(POINT, LIGHT, &falls);
    let refused = |text: &str| Robot::from_toml(text).unwrap_err().to_string();
    let shares = "shares_rope_with = \"1\"";
    assert!(text.contains(shares));
    for (changed, message) in [
        ("shares_rope_with = \"3\"", "there is no cable \"3\""),
        ("shares_rope_with = \"2\"", "this rope has no end"),
        ("sheave_efficiency = 0.9", "`sheave_efficiency` is that of a sheave between two cables of one rope"),
        ("shares_rope_with = \"1\"\nsheave_efficiency = 1.2", "`sheave_efficiency` is 1.2, it must be at most 1"),
        ("shares_rope_with = \"1\"\nload_n_per_m = [1, 0, 0]", "bears another load along it"),
    ] {
        let error = refused(&text.replace(shares, changed));
        assert!(error.contains(message), "{error}");
    }
    let third = [falls[0], falls[1], Fall::new([2.0, 0.0, 0.0], Some(3.0), Some(0))];
    assert!(refused(&text_of(POINT, LIGHT, &third)).contains("two cables continue the rope of cable \"1\""));

    let robot = Robot::from_toml(&text).unwrap();
    assert_eq!(robot.ropes[0].cables, [0, 1]);
    let error = statics::solve(&robot, StaticModel::Ideal, None).unwrap_err();
    assert!(error.to_string().contains("rigid cables"), "{error}");
}

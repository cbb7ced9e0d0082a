//! Linearised robots: the count of natural frequencies, and a double pendulum with a closed form.

use crate::library::at_rest;
use crate::statics::crane;
use funicular::cable::CableModel;
use funicular::dynamics::{Assembly, Dynamics, Linearisation};
use funicular::math::Vec3;
use funicular::modes;
use funicular::robot::{Pose, Robot, State};
use funicular::statics::{self, Stability, StaticModel};
use std::f64::consts::TAU;

#[test]
fn counts_grow_by_one_at_every_listed_frequency_and_nowhere_else() {
    let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap();
    let rest = at_rest(&robot);
    for assembly in [Assembly::Consistent, Assembly::WithoutGeometricStiffness] {
        let dynamics = Dynamics::about(&robot, &rest, Linearisation { assembly, ..Default::default() }, 20.0).unwrap();
        let found = modes::below(&dynamics, 20.0);
        assert!(found.certified);
        for (i, mode) in found.modes.iter().enumerate() {
            let omega = mode.frequency_hz * TAU;
            assert!(dynamics.modes_below(omega * (1.0 - 1e-9)) <= i, "{assembly:?} {i}");
            assert!(dynamics.modes_below(omega * (1.0 + 1e-9)) > i, "{assembly:?} {i}");
        }
    }
}

#[test]
fn a_body_on_one_cable_hangs_with_its_centre_of_mass_below_the_anchor_and_swings_like_a_double_pendulum() {
    let robot = crane(1, 0.0);
    let rest = statics::forward(&robot, &[3.0], StaticModel::Catenary, None).unwrap();
    let center = rest.pose.point_w(&robot.platform.center_of_mass_p);
    let attachment = rest.cables[0].attachment_w;
    let anchor = robot.cables[0].anchor.reference_w();
    for point in [center, attachment] {
        assert!((point - anchor).xy().norm() < 1e-8 && point.z < anchor.z, "{point}");
    }
    assert!(center.z < attachment.z);
    // Rotation about the cable is indifferent, not unstable.
    assert!(matches!(rest.stability, Stability::Unstable { directions: 1, min_stiffness: 0.0 }));
    // Double pendulum about each of its two principal axes normal to the cable: l1 the cable, l2 to the centre of mass.
    let (l1, l2) = ((anchor - attachment).norm(), (attachment - center).norm());
    let down = rest.pose.rot_wp.inverse() * Vec3::z();
    let [a, b] = {
        let first = down.cross(&Vec3::x()).normalize();
        [first, down.cross(&first)]
    };
    let inertia = robot.platform.inertia_p;
    // Free rotation about the cable follows the swing: it is eliminated from the moments of inertia.
    let of = |u: Vec3, v: Vec3| {
        let moment = |u: Vec3, v: Vec3| u.dot(&(inertia * v));
        moment(u, v) - moment(u, down) * moment(v, down) / moment(down, down)
    };
    let across = eigenvalues(of(a, a), of(a, b), of(b, b));
    let (m, g) = (60.0, 9.81);
    let mut expected: Vec<f64> = across
        .into_iter()
        .flat_map(|j| {
            // Angles of cable and body: mass [[m l1², m l1 l2], [·, m l2² + J]], stiffness m g diag(l1, l2).
            let (p, q, r) = (m * l1 * l1, m * l1 * l2, m * l2 * l2 + j);
            let (k1, k2) = (m * g * l1, m * g * l2);
            let (aa, bb, cc) = (p * r - q * q, p * k2 + r * k1, k1 * k2);
            let root = (bb * bb - 4.0 * aa * cc).sqrt();
            [(bb - root) / (2.0 * aa), (bb + root) / (2.0 * aa)].map(|x| x.sqrt() / TAU)
        })
        .collect();
    expected.sort_by(f64::total_cmp);
    let linearisation = Linearisation { cable_model: CableModel::CatenaryStatic, ..Default::default() };
    let found = modes::below(&Dynamics::about(&robot, &rest, linearisation, 5.0).unwrap(), 5.0);
    let ours: Vec<f64> = found.modes.iter().map(|m| m.frequency_hz).filter(|f| *f > 1e-3).collect();
    assert_eq!(ours.len(), 4, "{ours:?} {expected:?}");
    for (ours, expected) in ours.iter().zip(expected) {
        assert!((ours / expected - 1.0).abs() < 2e-3, "{ours} {expected}");
    }
}

/// Eigenvalues of [[a, b], [b, c]].
fn eigenvalues(a: f64, b: f64, c: f64) -> [f64; 2] {
    let (mean, half) = (0.5 * (a + c), (0.25 * (a - c).powi(2) + b * b).sqrt());
    [mean - half, mean + half]
}

/// Equation (35d) from the public matrices alone: the static mass is the curvature of the stiffness over frequency.
fn platform_frequency_by_differences(dynamics: &Dynamics) -> f64 {
    const SLOW: f64 = 0.02;
    let real = |omega: f64| dynamics.stiffness(omega).map(|entry| entry.re);
    let still = real(0.0);
    let mass = dynamics.mass() + (still - real(SLOW)) / (SLOW * SLOW);
    let values = (mass.try_inverse().unwrap() * still).complex_eigenvalues();
    let lowest = values.iter().map(|value| value.re).fold(f64::INFINITY, f64::min);
    lowest.sqrt() / TAU
}

#[test]
fn the_smooth_frequency_of_the_platform_is_that_of_slow_motion() {
    for text in [funicular_robots::COGIRO, funicular_robots::YUAN2014_4MM, funicular_robots::COGIRO_WINCHES] {
        let robot = Robot::from_toml(text).unwrap();
        let rest = at_rest(&robot);
        let about = |cable_model| {
            let linearisation = Linearisation { cable_model, ..Default::default() };
            Dynamics::about(&robot, &rest, linearisation, 1.0).unwrap()
        };
        let dynamics = about(CableModel::CatenaryDynamic);
        let ours = dynamics.platform_frequency().unwrap();
        let other = platform_frequency_by_differences(&dynamics);
        assert!((ours / other - 1.0).abs() < 1e-5, "{ours} {other}");

        // Without mass of the cables it is the first mode itself, with it not below the lowest of all modes.
        let springs = about(CableModel::Spring);
        let exact = modes::below(&springs, 40.0).modes[0].frequency_hz;
        let of_springs = springs.platform_frequency().unwrap();
        assert!((of_springs / exact - 1.0).abs() < 1e-9, "{of_springs} {exact}");
        let (_, found) = modes::lowest(&robot, &rest, Linearisation::default(), 1, 1e3).unwrap();
        assert!(ours >= found.modes[0].frequency_hz * (1.0 - 1e-9));
    }
}

/// Along a path on which the first mode of the platform jumps by two thirds, steps of 5 cm change it by 3 % at most.
#[test]
fn the_smooth_frequency_of_the_platform_is_continuous_where_the_first_mode_jumps() {
    let mut robot = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    let mut jump = |of: &dyn Fn(&Robot, &statics::Equilibrium) -> f64| {
        let values: Vec<f64> = (0..=80)
            .map(|k| {
                robot.state = State::Pose(Pose::new([-4.0 + 0.05 * f64::from(k), 1.0, 1.5], [0.0; 3]));
                of(&robot, &statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium)
            })
            .collect();
        values.windows(2).map(|pair| (pair[1] / pair[0] - 1.0).abs()).fold(0.0, f64::max)
    };
    let smooth = jump(&|robot, rest| {
        Dynamics::about(robot, rest, Linearisation::default(), 1.0).unwrap().platform_frequency().unwrap()
    });
    let first = jump(&|robot, rest| {
        let share = modes::PLATFORM_SHARE;
        let (_, list) = modes::lowest_with_platform(robot, rest, Linearisation::default(), share, 1e3).unwrap();
        list.modes[list.first_platform(share).unwrap()].frequency_hz
    });
    assert!(smooth < 0.03 && first > 0.2, "{smooth} {first}");
}

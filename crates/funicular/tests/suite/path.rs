//! Paths of the platform: derivatives against differences, limits that are reached, splines against what they pass.

use funicular::math::{Rotation, Vec3, Vec6};
use funicular::path::{
    CourseForm, Leg, LegWay, MotionLimits, PathCorner, PathError, PathPoint, PlatformPath, Profile, Side,
    smoothed_within,
};
use funicular::robot::{Pose, Robot};

fn limits() -> MotionLimits {
    MotionLimits {
        speed: 1.0,
        acceleration: 2.0,
        jerk: 10.0,
        angular_speed: 0.8,
        angular_acceleration: 3.0,
        angular_jerk: 20.0,
    }
}

fn corners() -> [Pose; 4] {
    [
        Pose::new([0.0, 0.0, 1.0], [0.0; 3]),
        Pose::new([0.0, 0.0, 2.0], [10.0, 0.0, 0.0]),
        Pose::new([1.5, 0.5, 2.0], [10.0, -20.0, 30.0]),
        Pose::new([1.5, 0.5, 1.2], [0.0, 0.0, 50.0]),
    ]
}

fn through(form: CourseForm, blend: f64) -> PlatformPath {
    PlatformPath::through(&corners(), &limits(), form, blend).unwrap()
}

fn circle(form: CourseForm) -> PlatformPath {
    let start = Pose::new([1.0, 0.0, 1.5], [5.0, 0.0, 10.0]);
    PlatformPath::circle(&start, (&Vec3::new(0.0, 0.0, 1.0), &Vec3::new(0.0, 0.2, 1.0)), 1.5, &limits(), form).unwrap()
}

fn smooth_pose(t: f64) -> Pose {
    let (u, v) = (1.3 * t, 0.7 * t);
    let angles = [15.0 * u.sin(), 20.0 * v.cos(), 60.0 * (0.5 * t).sin()];
    Pose::new([1.5 * u.cos(), 1.2 * u.sin(), 1.6 + 0.15 * v.sin()], angles)
}

fn table(rows: usize) -> PlatformPath {
    let times: Vec<f64> = (0..rows).map(|k| 4.0 * k as f64 / (rows - 1) as f64 + 2.0).collect();
    let poses: Vec<Pose> = times.iter().map(|t| smooth_pose(*t - 2.0)).collect();
    PlatformPath::of_table(&times, &poses).unwrap()
}

/// Difference of two motions over a time, as a rate.
fn rate(before: &PathPoint, after: &PathPoint, time: f64) -> [Vec6; 3] {
    let way = after.pose.position_w - before.pose.position_w;
    let turn = (after.pose.rot_wp * before.pose.rot_wp.inverse()).scaled_axis();
    let pose = Vec6::new(way.x, way.y, way.z, turn.x, turn.y, turn.z);
    [pose, after.velocity_w - before.velocity_w, after.acceleration_w - before.acceleration_w].map(|of| of / time)
}

/// The derivatives of a path are those of its poses, wherever its jerk does not jump.
fn check_derivatives(path: &PlatformPath, times: impl Iterator<Item = f64>) {
    for time in times {
        let step = 1e-5 * path.duration();
        let here = path.at(time);
        let found = rate(&path.at(time - step), &path.at(time + step), 2.0 * step);
        let expected = [here.velocity_w, here.acceleration_w, here.jerk_w];
        for (order, (found, expected)) in found.iter().zip(expected).enumerate() {
            // A central difference of a quantity of size 10 with third derivatives up to 1e4.
            assert!((found - expected).norm() < 2e-6 * (1.0 + expected.norm()), "{time}: {order} {found} {expected}");
        }
    }
}

/// Times of a path that are irrational parts of it, so that they miss its corners.
fn times_of(path: &PlatformPath) -> impl Iterator<Item = f64> + '_ {
    (1..60).map(|k| path.duration() * ((f64::from(k) * 0.618_033_988_75) % 1.0))
}

#[test]
fn derivatives_are_those_of_the_poses() {
    for form in CourseForm::ALL {
        for path in [through(form, 0.0), through(form, 0.6), circle(form), circle(form).slowed(1.7)] {
            check_derivatives(&path, times_of(&path));
        }
    }
    let path = table(41);
    check_derivatives(&path, times_of(&path));
}

#[test]
fn a_move_reaches_its_limits_and_not_more() {
    // With and without phases of constant speed and of constant acceleration.
    for (way, peaks) in [(5.0, [1.0, 2.0, 10.0]), (0.3, [f64::NAN, 2.0, 10.0]), (1e-3, [f64::NAN, f64::NAN, 10.0])] {
        let ends = [Pose::new([0.0; 3], [0.0; 3]), Pose::new([0.0, way, 0.0], [0.0; 3])];
        let path = PlatformPath::through(&ends, &limits(), CourseForm::JerkLimited, 0.0).unwrap();
        let largest = |of: fn(&PathPoint) -> Vec6| {
            let at = |k: usize| of(&path.at(path.duration() * (k as f64 + 0.5) / 20_000.0)).norm();
            (0..20_000).map(at).fold(0.0, f64::max)
        };
        let found = [largest(|p| p.velocity_w), largest(|p| p.acceleration_w), largest(|p| p.jerk_w)];
        for ((found, peak), limit) in found.iter().zip(peaks).zip([1.0, 2.0, 10.0]) {
            assert!(*found <= limit * (1.0 + 1e-9), "{way}: {found} {limit}");
            assert!(peak.is_nan() || (found - peak).abs() < 1e-3 * peak, "{way}: {found} {peak}");
            assert!(!peak.is_nan() || *found < 0.95 * limit, "{way}: {found} {limit}");
        }
        assert!((path.at(path.duration()).pose.position_w - ends[1].position_w).norm() < 1e-12);
    }
}

#[test]
fn the_jerk_jumps_where_it_is_said_and_nowhere_else() {
    for (path, jumps) in [
        (through(CourseForm::JerkLimited, 0.5), true),
        (circle(CourseForm::Quintic).slowed(1.3), true),
        (through(CourseForm::ContinuousJerk, 0.5), false),
        (circle(CourseForm::ContinuousJerk), false),
        (through(CourseForm::Septic, 0.0), false),
    ] {
        let corners = path.corners();
        assert!(corners.windows(2).all(|pair| pair[0].time < pair[1].time) && corners.len() >= 2);
        assert_eq!(corners.iter().any(|corner| corner.order <= PathCorner::JERK), jumps);

        let jumps: Vec<f64> =
            corners.iter().filter(|corner| corner.order <= PathCorner::JERK).map(|corner| corner.time).collect();
        let step = 1e-5 * path.duration();
        for k in 1..40_000 {
            let (before, after) =
                (path.duration() * f64::from(k) / 40_000.0, path.duration() * f64::from(k + 1) / 40_000.0);
            let change = (path.at(after).jerk_w - path.at(before).jerk_w).norm();
            let is_near = jumps.iter().any(|jump| (before - step..=after + step).contains(jump));
            assert!(is_near || change < 0.2, "{before}: {change}");
        }
    }
}

#[test]
fn both_sides_of_a_corner_are_the_limits_of_the_motion_there() {
    for form in CourseForm::ALL {
        for path in [through(form, 0.0), through(form, 0.7), circle(form).slowed(0.7)] {
            let by = 1e-7 * path.duration();
            for corner in path.corners() {
                for (side, sign) in [(Side::Before, -1.0), (Side::After, 1.0)] {
                    let (here, near) = (path.beside(corner.time, side), path.at(corner.time + sign * by));
                    // A jerk that changes at most by 10 m/s³ within 1 ms.
                    assert!((here.jerk_w - near.jerk_w).norm() < 0.02, "{form:?} {corner:?} {side:?}");
                    assert!((here.acceleration_w - near.acceleration_w).norm() < 1e-4);
                }
            }
        }
    }
}

#[test]
fn phases_that_end_together_are_one_corner_or_none() {
    // A short move reaches neither its speed nor a constant speed: in the middle its jerk is the same on both sides.
    let limits = MotionLimits { speed: 2.0, acceleration: 2.0, jerk: 20.0, ..MotionLimits::default() };
    for way in [0.01, 0.3, 0.360_555_127_546_398_9, 0.7] {
        let ends = [Pose::new([0.0; 3], [0.0; 3]), Pose::new([way, 0.0, 0.0], [0.0; 3])];
        let path = PlatformPath::through(&ends, &limits, CourseForm::JerkLimited, 0.0).unwrap();
        let middle = 0.5 * path.duration();
        assert!((path.at(middle).jerk_w[0] + 20.0).abs() < 1e-6, "{way}: {}", path.at(middle).jerk_w[0]);
        assert!(path.corners().iter().all(|corner| (corner.time - middle).abs() > 1e-3 * middle), "{way}");
    }
}

#[test]
fn a_profile_without_jerk_limit_is_a_trapezoid_and_without_rate_limit_a_triangle() {
    assert!((Profile::limited(0.5, 1.0, f64::INFINITY).duration() - 2.5).abs() < 1e-14);
    let triangle = Profile::limited(f64::INFINITY, 1.0, f64::INFINITY);
    assert!((triangle.duration() - 2.0).abs() < 1e-14 && (triangle.derivative(0.999_999, 1) - 1.0).abs() < 1e-5);
    // Jerk alone: four equal phases of 1/(2·4^(1/3)) … of the cube root of the way over the jerk.
    let jerk = Profile::limited(f64::INFINITY, f64::INFINITY, 2.0);
    assert!((jerk.duration() - 4.0 * (1.0_f64 / 4.0).cbrt()).abs() < 1e-14);
    assert!((jerk.done(0.5 * jerk.duration()) - 0.5).abs() < 1e-14);
}

#[test]
fn a_quintic_course_reaches_the_limit_that_binds() {
    let ends = [Pose::new([0.0; 3], [0.0; 3]), Pose::new([3.0, 0.0, 0.0], [0.0; 3])];
    for (given, of) in [
        (MotionLimits { speed: 0.7, acceleration: 50.0, jerk: 1e4, ..limits() }, 0),
        (MotionLimits { speed: 50.0, acceleration: 2.0, jerk: 1e4, ..limits() }, 1),
        (MotionLimits { speed: 50.0, acceleration: 50.0, jerk: 4.0, ..limits() }, 2),
    ] {
        let path = PlatformPath::through(&ends, &given, CourseForm::Quintic, 0.0).unwrap();
        let largest = (0..=20_000)
            .map(|k| path.at(path.duration() * (f64::from(k) + 1e-9) / 20_000.0))
            .map(|p| [p.velocity_w, p.acceleration_w, p.jerk_w][of].norm())
            .fold(0.0, f64::max);
        let limit = [given.speed, given.acceleration, given.jerk][of];
        assert!((largest - limit).abs() < 1e-6 * limit, "{of}: {largest} {limit}");
    }
}

#[test]
fn blended_moves_arrive_earlier_and_round_their_corners() {
    let (stopping, rounding) = (through(CourseForm::JerkLimited, 0.0), through(CourseForm::JerkLimited, 1.0));
    assert_eq!(stopping.misses(), [0.0, 0.0]);
    assert!(rounding.duration() < stopping.duration() - 0.5);
    assert!(rounding.misses().iter().all(|miss| (0.01..0.3).contains(miss)), "{:?}", rounding.misses());
    for path in [stopping, rounding] {
        let end = path.at(path.duration() + 1.0);
        let turn = (end.pose.rot_wp * corners()[3].rot_wp.inverse()).angle();
        assert!((end.pose.position_w - corners()[3].position_w).norm() < 1e-12 && turn < 1e-12);
        assert_eq!(end.velocity_w, Vec6::zeros());
    }
}

/// Largest translational and angular acceleration and jerk, over their limits, at times that are not those of the
/// search.
fn largest_parts(path: &PlatformPath, limits: &MotionLimits) -> [f64; 3] {
    let mut found = [0.0_f64; 3];
    let corners: Vec<f64> = path.corners().iter().map(|corner| corner.time).collect();
    let between =
        corners.windows(2).flat_map(|pair| (0..=700).map(|k| pair[0] + (pair[1] - pair[0]) * f64::from(k) / 700.0));
    for time in between {
        for side in [Side::Before, Side::After] {
            let point = path.beside(time, side);
            for (k, (of, [linear, angular])) in [
                (point.velocity_w, [limits.speed, limits.angular_speed]),
                (point.acceleration_w, [limits.acceleration, limits.angular_acceleration]),
                (point.jerk_w, [limits.jerk, limits.angular_jerk]),
            ]
            .into_iter()
            .enumerate()
            {
                let size = |from: usize| of.fixed_rows::<3>(from).norm();
                found[k] = found[k].max(size(0) / linear).max(size(3) / angular);
            }
        }
    }
    found
}

#[test]
fn blends_and_circles_keep_every_limit() {
    let at = |x: f64, y: f64, yaw: f64| Pose::new([x, y, 1.0], [0.0, 0.0, yaw]);
    let ways: [&[Pose]; 5] = [
        &corners(),
        // A right angle, a way back, a straight line with unequal parts, and a turn alone after a translation.
        &[at(0.0, 0.0, 0.0), at(2.0, 0.0, 0.0), at(2.0, 3.0, 0.0)],
        &[at(0.0, 0.0, 0.0), at(2.0, 0.0, 0.0), at(0.1, 0.0, 0.0)],
        &[at(0.0, 0.0, 0.0), at(0.3, 0.0, 0.0), at(4.0, 0.0, 0.0)],
        &[at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0), at(1.0, 0.0, 90.0), at(1.0, 0.001, 90.0)],
    ];
    for form in CourseForm::ALL {
        for poses in ways {
            for blend in [0.3, 1.0] {
                let path = PlatformPath::through(poses, &limits(), form, blend).unwrap();
                let parts = largest_parts(&path, &limits());
                assert!(parts.iter().all(|part| *part <= 1.0 + 1e-6), "{form:?} {blend} {parts:?}");
                let stopping = PlatformPath::through(poses, &limits(), form, 0.0).unwrap();
                assert!(path.duration() <= stopping.duration() * (1.0 + 1e-9), "{form:?} {blend}");
            }
        }
        for turns in [0.02, 0.3, -1.5, 6.0] {
            let start = Pose::new([0.4, 0.0, 1.5], [0.0; 3]);
            let about = (&Vec3::new(0.0, 0.0, 1.0), &Vec3::z());
            let path = PlatformPath::circle(&start, about, turns, &limits(), form).unwrap();
            let parts = largest_parts(&path, &limits());
            assert!(parts.iter().all(|part| *part <= 1.0 + 1e-6), "{form:?} {turns} {parts:?}");
            assert!(parts.iter().any(|part| *part > 0.99), "{form:?} {turns} {parts:?}");
        }
    }
}

#[test]
fn a_continuous_jerk_costs_the_time_of_one_change_of_the_acceleration() {
    let ends = [Pose::new([0.0; 3], [0.0; 3]), Pose::new([5.0, 0.0, 0.0], [0.0; 3])];
    let of = |form| PlatformPath::through(&ends, &limits(), form, 0.0).unwrap();
    let (smooth, jumping) = (of(CourseForm::ContinuousJerk), of(CourseForm::JerkLimited));
    // 2 m/s² at 10 m/s³.
    assert!((smooth.duration() - jumping.duration() - 0.2).abs() < 1e-12);
    let used = smooth.used_parts(&limits());
    for part in [used.speed, used.acceleration, used.jerk] {
        assert!((part - 1.0).abs() < 1e-9, "{used:?}");
    }
}

#[test]
fn smoothed_values_round_to_those_of_the_table() {
    // Unequal times, and a motion that rests at both ends.
    let times: Vec<f64> = (0..=300).map(|k| 0.01 * f64::from(k) + 0.002 * f64::from(k % 3)).collect();
    let value = |t: &f64| 2.0 - 1.5 * (1.2 * t).cos();
    let acceleration = |t: f64| 1.5 * 1.44 * (1.2 * t).cos();
    for unit in [1e-3, 1e-4, 1e-9] {
        let rounded: Vec<f64> = times.iter().map(|t| (value(t) / unit).round() * unit).collect();
        let smooth = smoothed_within(&times, &rounded, 0.5 * unit);
        assert!(smooth.iter().zip(&rounded).all(|(a, b)| (a - b).abs() < 0.5 * unit));

        // Divided differences of both.
        let bend = |x: &[f64], k: usize| {
            let (left, right) = (times[k] - times[k - 1], times[k + 1] - times[k]);
            2.0 * ((x[k + 1] - x[k]) / right - (x[k] - x[k - 1]) / left) / (left + right)
        };
        let error = |x: &[f64]| {
            (2..times.len() - 2).map(|k| (bend(x, k) - acceleration(times[k])).abs()).fold(0.0_f64, f64::max)
        };
        let (before, after) = (error(&rounded), error(&smooth));
        assert!(unit < 1e-6 || (before > 1.0e4 * unit && after < 0.02 * before), "{unit}: {before} {after}");
        assert!(after < 0.3, "{unit}: {after}");
    }
    assert_eq!(smoothed_within(&[0.0, 1.0, 2.0], &[0.0, 5.0, 1.0], 0.5), [0.0, 5.0, 1.0]);
}

#[test]
fn a_circle_keeps_radius_plane_and_limits() {
    for form in CourseForm::ALL {
        let path = circle(form);
        let (center, axis) = (Vec3::new(0.0, 0.0, 1.0), Vec3::new(0.0, 0.2, 1.0).normalize());
        let start = path.at(0.0).pose.position_w - center;
        for k in 0..=1000 {
            let point = path.at(path.duration() * f64::from(k) / 1000.0);
            let from = point.pose.position_w - center;
            assert!((from.norm() - start.norm()).abs() < 1e-13 && (from.dot(&axis) - start.dot(&axis)).abs() < 1e-13);
            assert!(point.acceleration_w.norm() < 2.0 * 1.000_1 && point.jerk_w.norm() < 10.0 * 1.000_1);
        }
        // One and a half turns end opposite.
        let end = path.at(path.duration()).pose.position_w - center;
        let across = |v: Vec3| v - axis * v.dot(&axis);
        assert!((across(end) + across(start)).norm() < 1e-12);
    }
}

#[test]
fn a_table_of_a_polynomial_of_the_fifth_degree_is_that_polynomial() {
    let position = |t: f64| [1.0 + t - t.powi(3) + 0.2 * t.powi(5), 0.5 * t.powi(4), 2.0 - 0.1 * t.powi(2)];
    let times: Vec<f64> = [0.0, 0.1, 0.35, 0.5, 0.9, 1.0, 1.2, 1.7, 1.8, 2.0].to_vec();
    let poses: Vec<Pose> = times.iter().map(|t| Pose::new(position(*t), [0.0; 3])).collect();
    let path = PlatformPath::of_table(&times, &poses).unwrap();
    for k in 0..=100 {
        let t = 0.02 * f64::from(k);
        let point = path.at(t);
        assert!((point.pose.position_w - Vec3::from(position(t))).norm() < 1e-11, "{t}");
        let velocity = Vec3::new(1.0 - 3.0 * t * t + t.powi(4), 2.0 * t.powi(3), -0.2 * t);
        assert!((point.twist()[0] - velocity).norm() < 1e-9, "{t}: {velocity} {}", point.velocity_w);
    }
}

#[test]
fn a_finer_table_is_nearer_to_its_curve_by_the_fifth_power() {
    let error = |rows: usize| {
        let path = table(rows);
        let at = |k: usize| {
            let t = 4.0 * (k as f64 + 0.3) / 500.0;
            let step = 1e-4;
            let [velocity, ..] = rate(
                &PathPoint::at_rest(&smooth_pose(t - step)),
                &PathPoint::at_rest(&smooth_pose(t + step)),
                2.0 * step,
            );
            (path.at(t).velocity_w - velocity).norm()
        };
        (0..500).map(at).fold(0.0, f64::max)
    };
    let (coarse, fine) = (error(17), error(33));
    assert!(coarse < 2e-2 && fine < coarse / 20.0, "{coarse} {fine}");
}

#[test]
fn the_inertia_is_the_loss_of_momentum_and_its_rate_is_exact() {
    let mut robot = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    robot.platform.center_of_mass_p = Vec3::new(0.1, -0.05, 0.2);
    robot.platform.inertia_p[(0, 1)] = 3.0;
    robot.platform.inertia_p[(1, 0)] = 3.0;
    let momentum = |point: &PathPoint| {
        let [linear, omega] = point.twist();
        let arm = point.pose.rot_wp * robot.platform.center_of_mass_p;
        let matrix = point.pose.rot_wp.to_rotation_matrix();
        let tensor = matrix.matrix() * robot.platform.inertia_p * matrix.matrix().transpose();
        let p = (linear + omega.cross(&arm)) * robot.platform.mass;
        // About the fixed origin of the world.
        [p, (point.pose.position_w + arm).cross(&p) + tensor * omega]
    };

    for path in [table(41), through(CourseForm::Quintic, 0.5)] {
        for time in times_of(&path) {
            let (step, here) = (1e-5, path.at(time));
            let [before, after] = [time - step, time + step].map(|t| path.at(t));
            let [[p0, l0], [p1, l1]] = [&before, &after].map(momentum);
            let [force, moment] = here.inertia(&robot);
            let about_world = moment + here.pose.position_w.cross(&force);
            assert!(((p1 - p0) / (2.0 * step) + force).norm() < 1e-5 * (1.0 + force.norm()), "{time}");
            assert!(((l1 - l0) / (2.0 * step) + about_world).norm() < 1e-5 * (1.0 + about_world.norm()), "{time}");

            let [[f0, m0], [f1, m1]] = [&before, &after].map(|point| point.inertia(&robot));
            let [force_rate, moment_rate] = here.inertia_rate(&robot);
            let size = 1.0 + force_rate.norm() + moment_rate.norm();
            assert!(((f1 - f0) / (2.0 * step) - force_rate).norm() < 1e-4 * size, "{time}");
            assert!(((m1 - m0) / (2.0 * step) - moment_rate).norm() < 1e-4 * size, "{time}");
        }
    }
}

#[test]
fn faults_of_paths_are_named() {
    let pose = |x: f64| Pose::new([x, 0.0, 0.0], [0.0; 3]);
    let fault = |times: &[f64], poses: &[Pose]| PlatformPath::of_table(times, poses).unwrap_err().to_string();
    assert!(fault(&[0.0, 1.0, 1.0], &[pose(0.0), pose(1.0), pose(2.0)]).contains("row 3 of the path: 1 s"));

    let turned = Pose { rot_wp: Rotation::from_scaled_axis(Vec3::new(0.0, 0.0, 3.1)), ..pose(1.0) };
    let text = fault(&[0.0, 1.0], &[pose(0.0), turned]);
    assert!(text.contains("rows 1 and 2") && text.contains("177.6"), "{text}");

    let times: Vec<f64> = (0..20).map(|k| 0.1 * f64::from(k)).collect();
    let mut poses: Vec<Pose> = times.iter().map(|t| pose(0.1 * t)).collect();
    assert!(PlatformPath::of_table(&times, &poses).is_ok());
    poses[10] = pose(7.0);
    poses[11..].iter_mut().for_each(|pose| pose.position_w.x += 7.0);
    let text = fault(&times, &poses);
    assert!(text.contains("rows 10 and 11") && text.contains("jump"), "{text}");

    let none = MotionLimits { angular_speed: f64::INFINITY, ..limits() };
    let no_limit = PlatformPath::through(&corners(), &none, CourseForm::JerkLimited, 0.0);
    assert_eq!(no_limit, Err(PathError::NoLimit { of: "turn" }));
    let same = [corners()[0], corners()[1], corners()[1]];
    let no_move = PlatformPath::through(&same, &limits(), CourseForm::JerkLimited, 0.0);
    assert_eq!(no_move, Err(PathError::NoMove { first: 2 }));
    let on_axis = (&Vec3::zeros(), &Vec3::z());
    let no_radius =
        PlatformPath::circle(&Pose::new([0.0, 0.0, 2.0], [0.0; 3]), on_axis, 1.0, &limits(), CourseForm::Quintic);
    assert_eq!(no_radius, Err(PathError::NoRadius));
}

/// Job of a straight move, a quarter circle, a helix of one and a half turns, and a slow move back.
fn job() -> (Pose, Vec<Leg>) {
    let at = |x: f64, y: f64, z: f64| Pose::new([x, y, z], [0.0, 0.0, 20.0]);
    let arc = |center: [f64; 3], angle: f64| LegWay::Arc { center_w: center.into(), axis_w: Vec3::z() * 2.0, angle };
    let leg = |to: Pose, way: LegWay, speed: f64| Leg { to, way, speed };
    let legs = vec![
        leg(at(1.0, 0.0, 1.0), LegWay::Straight, f64::INFINITY),
        leg(at(1.5, 0.5, 1.0), arc([1.0, 0.5, 1.0], std::f64::consts::FRAC_PI_2), 0.4),
        leg(at(0.9, 0.5, 1.3), arc([1.2, 0.5, 1.0], -3.0 * std::f64::consts::PI), 0.3),
        leg(at(0.0, 0.0, 1.0), LegWay::Straight, 0.2),
    ];
    (at(0.0, 0.0, 1.0), legs)
}

#[test]
fn a_job_follows_its_lines_and_arcs_at_their_feed_rates_within_all_limits() {
    let (start, legs) = job();
    for form in CourseForm::ALL {
        for blend in [0.0, 1.0] {
            let path = PlatformPath::along(&start, &legs, &limits(), form, blend).unwrap();
            check_derivatives(&path, times_of(&path));
            let parts = largest_parts(&path, &limits());
            assert!(parts.iter().all(|part| *part <= 1.0 + 1e-6), "{form:?} {blend} {parts:?}");
            let end = path.at(path.duration()).pose;
            assert!((end.position_w - start.position_w).norm() < 1e-12, "{form:?} {blend}");
        }

        // Stopping at every end: each point is on the way of its move, and no move is faster than its feed rate.
        let path = PlatformPath::along(&start, &legs, &limits(), form, 0.0).unwrap();
        let mut fastest = [0.0_f64; 4];
        for k in 0..=4000 {
            let point = path.at(path.duration() * f64::from(k) / 4000.0);
            let position = point.pose.position_w;
            let [from_first, from_second] = [Vec3::new(1.0, 0.5, 1.0), Vec3::new(1.2, 0.5, 1.0)].map(|center| {
                let out = position - center;
                (out.x.hypot(out.y) - if center.x < 1.1 { 0.5 } else { 0.3 }).abs()
            });
            let rise = position.z - 1.0;
            let off = [
                position.y.abs() + rise.abs(),
                from_first + rise.abs(),
                from_second,
                // The line from (0.9, 0.5, 1.3) to the start.
                Vec3::new(0.9, 0.5, 0.3).normalize().cross(&(position - Vec3::z())).norm(),
            ];
            let (of, least) = off.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1)).unwrap();
            assert!(*least < 1e-12, "{form:?} {k} {off:?}");
            let apart = off.iter().filter(|off| **off < 1e-6).count() == 1;
            if apart {
                fastest[of] = fastest[of].max(point.velocity_w.norm());
            }
        }
        for (fastest, feed) in fastest.iter().zip([1.0, 0.4, 0.3, 0.2]) {
            assert!(*fastest <= feed * (1.0 + 1e-9) && *fastest > 0.5 * feed, "{form:?} {fastest} {feed}");
        }
    }
    let no_radius = [Leg { way: LegWay::Arc { center_w: Vec3::z(), axis_w: Vec3::z(), angle: 1.0 }, ..legs[0] }];
    let fault = PlatformPath::along(&start, &no_radius, &limits(), CourseForm::JerkLimited, 0.0);
    assert_eq!(fault, Err(PathError::NoRadius));
}

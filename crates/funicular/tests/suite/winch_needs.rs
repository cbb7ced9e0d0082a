//! Needs of winches: a tripod by hand, all vertices of the required loads and corners of the velocities one by one,
//! accelerations against differences of lengths, required wind, loads that are not held.

use funicular::math::{Rotation, Vec3, Vec6};
use funicular::robot::{Load, LoadShape, Pose, Robot, State};
use funicular::speeds::WinchSpeeds;
use funicular::statics::{self, CableState, Equilibrium, StaticModel, TensionRule};
use funicular::winch_needs::{WinchNeed, WinchNeeds, WinchNeedsError};

const RULE: TensionRule = TensionRule::Lowest;

fn needs(robot: &Robot, pose: &Pose) -> WinchNeeds {
    WinchNeeds::at(robot, pose, StaticModel::Catenary, &RULE).unwrap()
}

/// Point mass on three ropes without mass that leave winches on a circle of 3 m, 4 m above it.
fn tripod(mass: f64) -> Robot {
    let cable = |k: u32| {
        let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 3.0).sin_cos();
        format!(
            "[[cables]]\nname = \"{k}\"\nmaterial = \"rope\"\nwinch = \"drum\"\nanchor_m = [{}, {}, 4]\n",
            3.0 * cos,
            3.0 * sin
        )
    };
    let cables: String = (0..3).map(cable).collect();
    let text = format!(
        "name = \"tripod\"\n[platform]\nmass_kg = {mass}\nmotion = \"point-mass\"\n\
         [materials.rope]\naxial_stiffness_n = 1e11\nmass_kg_per_m = 0.0\n[winches.drum]\ndrum_radius_m = 0.1\n\
         gear_ratio = 5\ngear_efficiency = 0.8\n{cables}"
    );
    Robot::from_toml(&text).unwrap()
}

#[test]
fn the_winches_of_a_tripod_are_those_of_a_hand_calculation() {
    let (mass, gravity, speed, acceleration, payload) = (60.0, 9.81, 2.0, 3.0, 20.0);
    let mut robot = tripod(mass);
    robot.required.velocity_w = Vec3::new(0.0, 0.0, speed);
    robot.required.acceleration_w = Vec3::new(0.0, 0.0, acceleration);
    robot.required.payload.max_mass = payload;
    let found = needs(&robot, &Pose::new([0.0; 3], [0.0; 3]));

    // Ropes of 5 m with the cosine 0.8 against the vertical.
    let tension = (mass + payload) * (gravity + acceleration) / 3.0 / 0.8;
    let of_rope = speed * 0.8;
    let expected = [
        (WinchNeed::Tension, tension),
        (WinchNeed::Speed, of_rope),
        (WinchNeed::Acceleration, acceleration * 0.8 + (speed * 0.6).powi(2) / 5.0),
        (WinchNeed::Torque, tension * 0.1 / 5.0 / 0.8),
        (WinchNeed::Power, tension * of_rope / 0.8),
        (WinchNeed::BrakePower, tension * of_rope * 0.8),
    ];
    for cable in &found.cables {
        for (need, expected) in expected {
            let value = cable.of(need).unwrap().value;
            assert!((value / expected - 1.0).abs() < 1e-7, "{need:?}: {value} {expected}");
        }
        // The largest power lifts, the largest braking power lowers.
        assert!(cable.of(WinchNeed::Power).unwrap().twist_w[2] > 0.0);
        assert!(cable.of(WinchNeed::BrakePower).unwrap().twist_w[2] < 0.0);
        assert!(cable.stroke() < 1e-7);
    }
    let heavier =
        needs(&Robot { required: robot.required.clone(), ..tripod(1.01 * mass) }, &Pose::new([0.0; 3], [0.0; 3]));
    let ratio = heavier.of_one(WinchNeed::Tension).unwrap().1.value / tension;
    assert!((ratio - (1.01 * mass + payload) / (mass + payload)).abs() < 1e-7);
}

/// Vertices of a box with these half widths.
fn vertices(half: &Vec3) -> Vec<Vec3> {
    let sign = |k: usize, bit: usize| if k >> bit & 1 == 0 { -1.0 } else { 1.0 };
    (0..8).map(|k| Vec3::new(half.x * sign(k, 0), half.y * sign(k, 1), half.z * sign(k, 2))).collect()
}

/// Equilibrium of a robot that carries a load and accelerates.
fn under(robot: &Robot, pose: &Pose, force_w: Vec3, moment_w: Vec3, acceleration_w: Vec3) -> (Robot, Equilibrium) {
    let inertia_w = -acceleration_w * robot.platform.mass;
    let center_w = pose.rot_wp * robot.platform.center_of_mass_p;
    let mut loaded = robot.clone();
    loaded.load = Load {
        force_w: robot.load.force_w + force_w + inertia_w,
        moment_w: robot.load.moment_w + moment_w + center_w.cross(&inertia_w),
        ..robot.load
    };
    let rest = statics::solve_at(&loaded, &State::Pose(*pose), StaticModel::Catenary, &RULE).unwrap().equilibrium;
    (loaded, rest)
}

/// Second derivative of the length of a straight rope while its end moves with a constant twist, by differences of the
/// distance between the ends.
fn bend(state: &CableState, twist_w: &Vec6) -> f64 {
    let step = 1e-2;
    let length = |time: f64| {
        let turn = Rotation::from_scaled_axis(twist_w.fixed_rows::<3>(3) * time);
        let shift = twist_w.fixed_rows::<3>(0) * time + turn * state.lever_w - state.lever_w;
        (state.attachment_w + shift - state.anchor_w).norm()
    };
    let second = |step: f64| (length(step) - 2.0 * length(0.0) + length(-step)) / (step * step);
    ((4.0 * second(step) - second(2.0 * step)) / 3.0).abs()
}

/// CoGiRo on winches at three poses: every vertex of forces, moments and accelerations with every corner of the
/// velocities, without the short cuts of the needs.
#[test]
fn needs_are_the_largest_of_all_vertices_and_corners() {
    let mut robot = Robot::from_toml(funicular_robots::COGIRO_WINCHES).unwrap();
    robot.required.force_w = Vec3::new(40.0, 25.0, 60.0);
    robot.required.moment_w = Vec3::new(5.0, 0.0, 8.0);
    robot.required.acceleration_w = Vec3::new(0.5, 0.3, 0.4);
    robot.required.velocity_w = Vec3::new(1.0, 0.7, 0.4);
    robot.required.angular_velocity_w = Vec3::new(0.0, 0.0, 0.2);
    for pose in [[0.5, 1.0, 1.5], [-2.0, 1.5, 2.0], [2.0, -1.5, 1.2]].map(|at| Pose::new(at, [0.0, 0.0, 4.0])) {
        let found = needs(&robot, &pose);
        let mut largest = vec![[0.0_f64; 5]; robot.cables.len()];
        let mut lengths = vec![[f64::INFINITY, f64::NEG_INFINITY]; robot.cables.len()];
        let unloaded = [Vec3::zeros()];
        let loads = (vertices(&robot.required.force_w).into_iter())
            .flat_map(|force| vertices(&robot.required.moment_w).into_iter().map(move |moment| (force, moment)))
            .chain(unloaded.iter().map(|zero| (*zero, *zero)));
        for (force, moment) in loads {
            for acceleration in vertices(&robot.required.acceleration_w).into_iter().chain(unloaded) {
                let (loaded, rest) = under(&robot, &pose, force, moment, acceleration);
                let speeds = WinchSpeeds::at(&loaded, &rest, Some(&RULE)).unwrap();
                for (i, winch) in speeds.winches().iter().enumerate() {
                    let most = &mut largest[i];
                    let twists = || {
                        let linear = vertices(&robot.required.velocity_w).into_iter();
                        linear.flat_map(|v| [-0.2, 0.2].map(|turn| Vec6::new(v.x, v.y, v.z, 0.0, 0.0, turn)))
                    };
                    let bend = twists().map(|twist| bend(&rest.cables[i], &twist)).fold(0.0, f64::max);
                    let accelerations = robot.required.acceleration_w;
                    let rate = winch.by_twist.fixed_rows::<3>(0).abs().dot(&accelerations) + bend;
                    most[0] = most[0].max(rest.cables[i].tension_drum());
                    let length = rest.cables[i].unstrained_length;
                    lengths[i] = [lengths[i][0].min(length), lengths[i][1].max(length)];
                    most[4] = most[4].max(rate);
                    for speed in twists().map(|twist| winch.by_twist.dot(&twist)) {
                        most[1] = most[1].max(speed.abs());
                        for rate in [-rate, rate] {
                            let motor = winch.winch.motor(winch.tension, speed, rate);
                            most[2] = most[2].max(motor.power);
                            most[3] = most[3].max(motor.torque.unwrap().abs());
                        }
                    }
                }
            }
        }
        for (i, cable) in found.cables.iter().enumerate() {
            let value = |need| cable.of(need).unwrap().value;
            let needs =
                [WinchNeed::Tension, WinchNeed::Speed, WinchNeed::Power, WinchNeed::Torque, WinchNeed::Acceleration];
            let of = needs.map(value);
            for (value, expected) in of.iter().zip(&largest[i]) {
                assert!((value / expected - 1.0).abs() < 2e-9, "{pose:?} {i}: {of:?} {:?}", largest[i]);
            }
            assert!((cable.lengths[0] - lengths[i][0]).abs() < 1e-9 && (cable.lengths[1] - lengths[i][1]).abs() < 1e-9);
        }
    }
}

/// The acceleration of a rope while the platform moves and turns steadily is the second difference of its length; the
/// needs take straight ropes.
#[test]
fn accelerations_are_second_differences_of_lengths() {
    let mut robot = Robot::from_toml(funicular_robots::COGIRO_WINCHES).unwrap();
    let (velocity_w, turn_w) = (Vec3::new(1.2, 0.0, 0.0), Vec3::new(0.0, 0.0, 0.5));
    robot.required.velocity_w = velocity_w;
    robot.required.angular_velocity_w = turn_w;
    let pose = Pose::new([1.0, -0.5, 1.5], [0.0; 3]);
    let found = needs(&robot, &pose);
    let step = 2e-3;
    let lengths = |time: f64, turn: f64| -> Vec<f64> {
        let position = pose.position_w + velocity_w * time;
        let at = Pose::new(position.into(), [0.0, 0.0, (turn * time).to_degrees()]);
        let rest = statics::inverse(&robot, &at, StaticModel::Catenary).unwrap();
        rest.cables.iter().map(|cable: &CableState| cable.unstrained_length).collect()
    };
    let accelerations = [0.5, -0.5].map(|turn| {
        let [before, here, after] = [-step, 0.0, step].map(|time| lengths(time, turn));
        (0..8).map(|i| (before[i] - 2.0 * here[i] + after[i]) / (step * step)).collect::<Vec<f64>>()
    });
    for (i, cable) in found.cables.iter().enumerate() {
        let expected = accelerations.iter().map(|of| of[i].abs()).fold(0.0, f64::max);
        let value = cable.of(WinchNeed::Acceleration).unwrap().value;
        assert!((value - expected).abs() < 0.03 * expected + 2e-3, "{i}: {value} {expected}");
    }
}

/// Wind from some side raises the tensions of ropes with a drag width; the robot's own statics in this wind has them.
#[test]
fn wind_is_among_the_loads() {
    let mut robot = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    for cable in &mut robot.cables {
        cable.material.drag_width = Some(0.005);
    }
    robot.platform.drag_area = 0.8;
    let pose = Pose::new([1.0, 0.5, 1.5], [0.0; 3]);
    let calm = needs(&robot, &pose).of_one(WinchNeed::Tension).unwrap().1.value;
    robot.required.wind_speed = 15.0;
    let found = needs(&robot, &pose);
    assert!(found.of_one(WinchNeed::Tension).unwrap().1.value > 1.02 * calm);

    let largest = (0..24)
        .map(|k| {
            let angle = f64::from(k) * std::f64::consts::TAU / 24.0;
            let wind =
                funicular::robot::Wind { velocity_w: Vec3::new(angle.cos(), angle.sin(), 0.0) * 15.0, ..robot.wind };
            let blown = robot.with_wind(wind);
            let rest = statics::solve_at(&blown, &State::Pose(pose), StaticModel::Catenary, &RULE).unwrap().equilibrium;
            rest.cables.iter().map(CableState::tension_drum).collect::<Vec<f64>>()
        })
        .fold(vec![0.0_f64; 8], |most, of| most.iter().zip(of).map(|(a, b)| a.max(b)).collect());
    for (cable, expected) in found.cables.iter().zip(&largest) {
        let value = cable.of(WinchNeed::Tension).unwrap().value;
        assert!((value / expected - 1.0).abs() < 5e-3, "{value} {expected}");
    }
}

/// A velocity that the guide of a planar robot does not let through bends no rope.
#[test]
fn a_planar_robot_moves_in_its_plane_alone() {
    let mut robot = Robot::from_toml(funicular_robots::KNTU_PLANAR).unwrap();
    let pose = Pose::new([0.2, 0.1, 0.0], [0.0; 3]);
    let across = [Vec3::x(), Vec3::y(), Vec3::z()]
        .into_iter()
        .find(|axis| !robot.platform.motion.can_follow(&Vec6::new(axis.x, axis.y, axis.z, 0.0, 0.0, 0.0)));
    let along = Vec3::repeat(0.5) - across.unwrap() * 0.5;
    let accelerations = |robot: &Robot| {
        let found = needs(robot, &pose);
        found.cables.iter().map(|cable| cable.of(WinchNeed::Acceleration).unwrap().value).collect::<Vec<f64>>()
    };
    robot.required.velocity_w = along;
    let in_plane = accelerations(&robot);
    assert!(in_plane.iter().all(|value| *value > 0.01), "{in_plane:?}");
    robot.required.velocity_w = along + across.unwrap() * 3.0;
    for (with, without) in accelerations(&robot).iter().zip(&in_plane) {
        assert!((with - without).abs() < 1e-12, "{with} {without}");
    }
}

#[test]
fn a_load_that_is_not_held_is_named() {
    let mut robot = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    robot.required.force_w = Vec3::new(1e5, 0.0, 0.0);
    let pose = Pose::new([0.0, 0.0, 1.5], [0.0; 3]);
    let error = WinchNeeds::at(&robot, &pose, StaticModel::Catenary, &RULE).unwrap_err();
    assert!(
        matches!(error, WinchNeedsError::NotHeld { load_w, .. } if (load_w[0].abs() - 1e5).abs() < 1e-6),
        "{error}"
    );
    assert!(error.to_string().contains("100000.0, 0.0, 0.0) N"), "{error}");
}

/// Velocities in a ball: the speed of the tripod is that of the rope's own direction, and the bend of a rope across it;
/// with turns as well no sampled twist bends more, and one bends nearly as much.
#[test]
fn needs_in_a_ball_of_velocities_are_those_of_its_worst_twist() {
    let mut robot = tripod(60.0);
    robot.required.velocity_w = Vec3::repeat(2.0);
    robot.required.velocity_shape = LoadShape::Ellipsoid;
    for cable in &needs(&robot, &Pose::new([0.0; 3], [0.0; 3])).cables {
        let value = |need| cable.of(need).unwrap().value;
        // Any direction with 2 m/s; ropes of 5 m.
        assert!((value(WinchNeed::Speed) / 2.0 - 1.0).abs() < 1e-7);
        assert!((value(WinchNeed::Acceleration) / (4.0 / 5.0) - 1.0).abs() < 1e-7);
    }

    let mut robot = Robot::from_toml(funicular_robots::COGIRO_WINCHES).unwrap();
    let (half, turn) = (Vec3::new(1.0, 0.7, 0.4), Vec3::new(0.3, 0.3, 0.6));
    robot.required.velocity_w = half;
    robot.required.angular_velocity_w = turn;
    robot.required.velocity_shape = LoadShape::Ellipsoid;
    let pose = Pose::new([0.5, 1.0, 1.5], [0.0, 0.0, 4.0]);
    let found = needs(&robot, &pose);
    let rest = statics::solve_at(&robot, &State::Pose(pose), StaticModel::Catenary, &RULE).unwrap().equilibrium;
    for (cable, state) in found.cables.iter().zip(&rest.cables) {
        let need = cable.of(WinchNeed::Acceleration).unwrap();
        let mut sampled = 0.0_f64;
        for k in 1..4000 {
            let of = |root: f64| 2.0 * (f64::from(k) * root.sqrt()).fract() - 1.0;
            let [v, w] = [[2.0, 3.0, 5.0], [7.0, 11.0, 13.0]].map(|roots| Vec3::from(roots.map(of)).normalize());
            let twist = Vec6::new(v.x * half.x, v.y * half.y, v.z * half.z, w.x * turn.x, w.y * turn.y, w.z * turn.z);
            sampled = sampled.max(bend(state, &twist));
        }
        let reached = bend(state, &need.twist_w);
        assert!(sampled < need.value * (1.0 + 1e-6) && sampled > 0.8 * need.value, "{sampled} of {}", need.value);
        assert!((reached / need.value - 1.0).abs() < 1e-4, "{reached} at the twist of {}", need.value);
    }
}

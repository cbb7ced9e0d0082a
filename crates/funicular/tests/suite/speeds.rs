//! Speeds that winches allow: limits of one winch by hand, boxes of twists against samples, rates against differences
//! of lengths, powers against the work of the weight.

use funicular::gradient::LengthRates;
use funicular::math::{Vec3, Vec6};
use funicular::robot::{LimitOfWinch, LoadShape, Pose, Robot, State, TwistSet, WinchLimits};
use funicular::speeds::WinchSpeeds;
use funicular::statics::{self, Equilibrium, StaticModel, TensionRule};
use proptest::prelude::*;

/// Weight that hangs on a rope without mass below a winch [N]: the tension at the drum.
const WEIGHT: f64 = 400.0;

/// Axial stiffness of that rope [N].
const STIFFNESS: f64 = 1e8;

/// Winch with a drum of 0.1 m, a gear of 1:5 with an efficiency of 0.8, and these lines, above a weight of 400 N.
fn above_weight(lines: &str) -> WinchSpeeds {
    let mass = WEIGHT / 9.81;
    let text = format!(
        "name = \"hoist\"\n[platform]\nmass_kg = {mass}\nmotion = \"point-mass\"\n[materials.rope]\n\
         axial_stiffness_n = {STIFFNESS}\nmass_kg_per_m = 0.0\n[winches.drum]\ndrum_radius_m = 0.1\ngear_ratio = 5\n\
         gear_efficiency = 0.8\n{lines}\n[[cables]]\nname = \"1\"\nmaterial = \"rope\"\nwinch = \"drum\"\n\
         anchor_m = [0, 0, 9]\nunstrained_length_m = 2.0\n"
    );
    let robot = Robot::from_toml(&text).unwrap();
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    // Stretched, the cable is as fast as the platform.
    let upwards = Vec6::ith(2, -1.0 / (1.0 + WEIGHT / STIFFNESS));
    WinchSpeeds::of_rates(
        &robot,
        &rest,
        &LengthRates { by_pose: vec![upwards], by_load: vec![Vec6::zeros()], by_rope_load: vec![vec![Vec3::zeros()]] },
    )
}

/// True if two speeds are equal up to the rounding of the equilibrium, infinite ones included.
fn is_near(found: f64, expected: f64) -> bool {
    (found - expected).abs() < 1e-8 || (found.is_infinite() && expected.is_infinite())
}

#[test]
fn the_largest_speeds_of_one_winch_are_those_of_hand_calculations() {
    use LimitOfWinch::{BrakePower, Power, Speed, Torque};
    // At the motor the weight is 400 · 0.1 / 5 = 8 N m: 10 N m while it lifts, 6.4 N m while it lowers.
    let curve = "torque_speed_rad_s = [0, 100, 300]\ntorque_speed_n_m = [30, 30, 0]";
    // A curve that falls below 10 N m between 40 and 60 rad/s.
    let dip = "torque_speed_rad_s = [0, 50, 100]\ntorque_speed_n_m = [30, 5, 30]";
    for (lines, inwards, outwards) in [
        ("", (f64::INFINITY, None), (f64::INFINITY, None)),
        ("max_speed_m_s = 1.5", (1.5, Some(Speed)), (1.5, Some(Speed))),
        // 1000 · 0.8 / 400, and 500 / (400 · 0.8).
        ("max_power_w = 1000\nmax_brake_power_w = 500", (2.0, Some(Power)), (1.5625, Some(BrakePower))),
        // (400 + 100 u) u = 800; lowering, 0.8 (400 − 100 v) v has its maximum, 320 W, below the limit. Beyond 4 m/s
        // the damping is more than the weight and the motor drives: (100 v − 400) v = 800.
        (
            "damping_n_m_s_per_rad = 1.0\nmax_power_w = 1000\nmax_brake_power_w = 330",
            (-2.0 + 12.0_f64.sqrt(), Some(Power)),
            (2.0 + 12.0_f64.sqrt(), Some(Power)),
        ),
        // 30 − 0.15 (ω − 100) is 10 at 233.3 rad/s and 6.4 at 257.3 rad/s.
        (curve, (0.02 * 700.0 / 3.0, Some(Torque)), (0.02 * (100.0 + 23.6 / 0.15), Some(Torque))),
        // 30 − 0.5 ω is 10 at 40 rad/s and 6.4 at 47.2 rad/s: the end is the first place beyond the limit.
        (dip, (0.8, Some(Torque)), (0.944, Some(Torque))),
        // Too weak to lift; lowers.
        ("max_torque_n_m = 9\nmax_speed_m_s = 2", (0.0, Some(Torque)), (2.0, Some(Speed))),
        // The curve ends at 50 rad/s with torque left.
        ("torque_speed_rad_s = [0, 50]\ntorque_speed_n_m = [30, 30]", (1.0, Some(Torque)), (1.0, Some(Torque))),
    ] {
        let speeds = above_weight(lines);
        let winch = &speeds.winches()[0];
        for (what, found, expected) in [("in", winch.inwards, inwards), ("out", winch.outwards, outwards)] {
            let (value, limit) = expected;
            assert!(is_near(found.value, value), "{lines}: {what} {} instead of {value}", found.value);
            assert_eq!(found.limit, limit, "{lines}: {what}");
        }
        // The platform moves as fast as the cable: upwards by winding in.
        let [up, down] = [1.0, -1.0].map(|sign| speeds.along(&(Vec6::ith(2, 1.0) * sign)));
        for (platform, cable) in [(up, winch.inwards), (down, winch.outwards)] {
            assert!(is_near(platform.value, cable.value), "{lines}");
        }
        assert!(speeds.along(&Vec6::ith(0, 1.0)).value.is_infinite());
        assert_eq!(up.cable, inwards.1.map(|limit| (0, limit)));
    }
}

/// CoGiRo with pulleys and winches of these limits.
fn cogiro(lines: &str) -> Robot {
    let text = funicular_robots::COGIRO_WINCHES.replacen("gear_ratio = 3", &format!("gear_ratio = 3\n{lines}"), 1);
    Robot::from_toml(&text).unwrap()
}

fn at(robot: &Robot, pose: &Pose, rule: &TensionRule) -> Equilibrium {
    statics::distribute_tensions(robot, pose, StaticModel::Catenary, rule).unwrap()
}

/// Speed of each cable at its drum from the lengths of two neighbouring poses, which know nothing of rates.
#[test]
fn rates_are_those_of_the_lengths_of_neighbouring_poses() {
    let robot = cogiro("stiffness_n_per_m = 2e5");
    let pose = Pose::new([1.0, -0.5, 1.5], [2.0, -3.0, 5.0]);
    for rule in [TensionRule::Closest(vec![400.0]), TensionRule::Lowest] {
        let rest = at(&robot, &pose, &rule);
        let speeds = WinchSpeeds::at(&robot, &rest, Some(&rule)).unwrap();

        for axis in 0..6 {
            let step = 1e-4;
            let [ahead, behind] = [step, -step].map(|step| at(&robot, &moved(&pose, axis, step), &rule));
            for (i, winch) in speeds.winches().iter().enumerate() {
                let rate = (ahead.cables[i].unstrained_length - behind.cables[i].unstrained_length) / (2.0 * step);
                let stretch = 1.0 + winch.tension / robot.cables[i].material.axial_stiffness;
                let difference = (winch.by_twist[axis] - rate * stretch).abs();
                // Differences of second order, and lengths to 1e-11 m.
                assert!(difference < 2e-6, "{rule:?}, axis {axis}, cable {i}: {difference}");
            }
        }
    }
}

/// Pose a step along or about an axis of the world away.
fn moved(pose: &Pose, axis: usize, step: f64) -> Pose {
    let mut moved = *pose;
    if axis < 3 {
        moved.position_w[axis] += step;
    } else {
        moved.rot_wp = funicular::math::Rotation::from_scaled_axis(Vec3::ith(axis - 3, step)) * moved.rot_wp;
    }
    moved
}

/// At a symmetric pose the rule `lowest` has a kink: two cables leave their minimum at once. The sag of these slack
/// cables makes the rates on its two sides differ by some per cent; those of tensions that change least lie between.
#[test]
fn where_the_rule_has_a_kink_the_rates_lie_between_those_of_its_two_sides() {
    let robot = Robot::from_toml(funicular_robots::KNTU_PLANAR).unwrap();
    let (rule, pose) = (TensionRule::Lowest, Pose::new([0.0; 3], [0.0; 3]));
    let rest = at(&robot, &pose, &rule);
    let speeds = WinchSpeeds::at(&robot, &rest, Some(&rule)).unwrap();
    assert!(!speeds.follows_rule && LengthRates::of(&robot, &rest, &rule).is_err());

    for axis in [0, 1] {
        let step = 1e-3;
        let [ahead, behind] = [step, -step].map(|step| at(&robot, &moved(&pose, axis, step), &rule));
        for (i, winch) in speeds.winches().iter().enumerate() {
            let rate = |side: &Equilibrium, step: f64| {
                (side.cables[i].unstrained_length - rest.cables[i].unstrained_length) / step
            };
            let sides = [rate(&ahead, step), rate(&behind, -step)];
            let [low, high] = [sides[0].min(sides[1]), sides[0].max(sides[1])];
            assert!(
                high - low > 0.01 && (low..high).contains(&winch.by_twist[axis]),
                "{low} {high} {}",
                winch.by_twist
            );
        }
    }
}

/// Rigid ropes without mass store nothing: without losses the motors give what the weight takes.
#[test]
fn without_losses_the_powers_are_the_work_of_the_weight() {
    let robot = cogiro("");
    let pose = Pose::new([1.0, -0.5, 1.5], [0.0; 3]);
    let rule = TensionRule::Closest(vec![400.0]);
    let rest = statics::distribute_tensions(&robot, &pose, StaticModel::Ideal, &rule).unwrap();
    let speeds = WinchSpeeds::at(&robot, &rest, Some(&rule)).unwrap();

    let weight = robot.platform.mass * 9.81;
    let center_w = pose.rot_wp * robot.platform.center_of_mass_p;
    for twist in [[0.0, 0.0, 0.7, 0.0, 0.0, 0.0], [1.0, 0.3, -0.2, 0.1, -0.4, 0.2]] {
        let twist = Vec6::from(twist);
        let angular = Vec3::new(twist[3], twist[4], twist[5]);
        let up = twist[2] + angular.cross(&center_w).z;
        let powers = speeds.powers_at(&twist);
        assert!((powers.driving - powers.braking - weight * up).abs() < 1e-8 * weight, "{powers:?}");
        // A lift alone brakes none of the cables, which all come from above.
        assert!(powers.driving > 0.0 && (powers.braking > 0.0) == (twist[0] > 0.0));
    }
}

/// Rules, limits and losses of every kind at once.
fn limited(efficiency: f64, damping: f64, limits: &WinchLimits) -> WinchSpeeds {
    let mut robot = cogiro("");
    for cable in &mut robot.cables {
        let winch = cable.anchor.winch.as_mut().unwrap();
        (winch.gear_efficiency, winch.damping, winch.limits) = (efficiency, damping, limits.clone());
    }
    let State::Lengths(lengths) = &robot.state else { panic!("its file gives lengths") };
    let rest = statics::forward(&robot, lengths, StaticModel::Catenary, None).unwrap();
    WinchSpeeds::at(&robot, &rest, None).unwrap()
}

prop_compose! {
    fn any_limits()(
        speed in 0.5..6.0_f64, torque in 10.0..80.0_f64, power in 100.0..5e3_f64, brake_power in 100.0..5e3_f64,
        corners in prop::collection::vec((1.0..150.0_f64, 0.0..80.0_f64), 0..4), at_rest in 10.0..80.0_f64,
    ) -> WinchLimits {
        let mut at = 0.0;
        let rising = corners.iter().map(|(step, torque)| { at += step; [at, *torque] });
        let torque_speed = if corners.is_empty() { Vec::new() } else { [[0.0,
            at_rest]].into_iter().chain(rising).collect() };
        WinchLimits { speed, acceleration: f64::INFINITY, torque, power, brake_power, torque_speed }
    }
}

/// Twists in the unit box; some of them corners.
fn twists() -> impl Strategy<Value = Vec<[f64; 6]>> {
    let component = prop_oneof![-1.0..1.0_f64, Just(1.0), Just(-1.0)];
    prop::collection::vec(prop::array::uniform6(component), 30)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// No twist of the box needs more of any winch, or more power, than the numbers for the box; inside the box times
    /// the factor no winch is beyond a limit, and a little outside one is.
    #[test]
    fn a_box_is_judged_by_its_worst_twist(
        efficiency in 0.5..1.0_f64, damping in prop_oneof![Just(0.0), 1.0..200.0_f64], limits in any_limits(),
        half_widths in prop::array::uniform6(0.0..2.0_f64), twists in twists(),
    ) {
        let speeds = limited(efficiency, damping, &limits);
        let half_widths = Vec6::from(half_widths);
        let boxed = TwistSet::in_box(half_widths);
        let (factor, powers) = (speeds.factor(&boxed), speeds.powers(&boxed));
        let most_used = |twist_w: &Vec6| {
            speeds.winches().iter().fold(0.0_f64, |most, winch| {
                let speed = winch.by_twist.dot(twist_w);
                let uses = winch.winch.limits.use_of(speed, 0.0, &winch.winch.motor(winch.tension, speed, 0.0));
                uses.iter().fold(most, |most, (_, part)| most.max(*part))
            })
        };

        for twist in twists {
            let twist_w = half_widths.component_mul(&Vec6::from(twist));
            let sum = speeds.powers_at(&twist_w);
            prop_assert!(sum.driving <= powers.driving * (1.0 + 1e-12));
            if damping == 0.0 {
                prop_assert!(sum.braking <= powers.braking * (1.0 + 1e-12));
            }
            for winch in speeds.winches() {
                let worst = winch.worst_in(&boxed);
                let speed = winch.by_twist.dot(&twist_w);
                let motor = winch.winch.motor(winch.tension, speed, 0.0);
                prop_assert!(speed.abs() <= worst.speed * (1.0 + 1e-12));
                prop_assert!(motor.power <= worst.driving * (1.0 + 1e-12));
                prop_assert!(-motor.power <= worst.braking * (1.0 + 1e-12));
                for ((_, used), (_, most)) in winch.winch.limits.use_of(speed, 0.0, &motor).iter().zip(worst.uses) {
                    prop_assert!(*used <= most * (1.0 + 1e-12));
                }
            }
            if factor.value > 0.0 {
                prop_assert!(most_used(&(twist_w * factor.value)) <= 1.0 + 1e-9);
            }
        }

        // The corner that moves the winch at its largest speed, in its worse direction.
        let (i, _) = factor.cable.unwrap();
        let corner = speeds.winches()[i].by_twist.map(f64::signum).component_mul(&half_widths);
        let beyond = [1.0, -1.0].map(|sign| most_used(&(corner * (sign * factor.value * (1.0 + 1e-6) + sign * 1e-9))));
        prop_assert!(beyond[0].max(beyond[1]) > 1.0);
    }
}

/// Twists of two unit balls, of velocities and angular velocities: many inside, and many on both surfaces.
fn twists_in_balls(count: usize) -> impl Iterator<Item = Vec6> {
    // Fractions of irrational numbers fill the cube evenly.
    let ways = [2.0_f64, 3.0, 5.0, 7.0, 11.0, 13.0].map(f64::sqrt);
    (1..=count).map(move |k| {
        let of = |axis: usize| 2.0 * (k as f64 * ways[axis]).fract() - 1.0;
        let ball = |from: usize| {
            let point = Vec3::new(of(from), of(from + 1), of(from + 2));
            if k % 2 == 0 || point.norm() > 1.0 { point.normalize() } else { point }
        };
        let (linear, angular) = (ball(0), ball(3));
        Vec6::new(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)
    })
}

/// In ellipsoids the largest speed is reached and no twist exceeds it; with equal half axes it is the speed times the
/// length of the rates. Sums of powers found by the ascent are never below those of the samples.
#[test]
fn ellipsoids_are_judged_by_their_worst_twist() {
    let pose = Pose::new([1.0, 1.0, 1.5], [3.0, -2.0, 10.0]);
    let robot = cogiro("gear_efficiency = 0.9");
    let rest = at(&robot, &pose, &TensionRule::Lowest);
    let speeds = WinchSpeeds::at(&robot, &rest, None).unwrap();
    for half_widths in [[1.5, 1.5, 1.5, 0.0, 0.0, 0.0], [1.0, 0.5, 0.0, 0.1, 0.2, 0.3], [0.0, 0.0, 0.0, 0.2, 0.2, 0.2]]
    {
        let half_widths = Vec6::from(half_widths);
        let set = TwistSet { half_widths, shape: LoadShape::Ellipsoid };
        let boxed = TwistSet::in_box(half_widths);
        for winch in speeds.winches() {
            let most = winch.speed_in(&set);
            let farthest = set.farthest(&winch.by_twist);
            assert!((winch.by_twist.dot(&farthest) / most - 1.0).abs() < 1e-12, "it is reached");
            let scaled = farthest.zip_map(&half_widths, |of, half| if half > 0.0 { of / half } else { 0.0 });
            assert!(scaled.fixed_rows::<3>(0).norm() < 1.0 + 1e-12 && scaled.fixed_rows::<3>(3).norm() < 1.0 + 1e-12);
            let sampled = twists_in_balls(4000).map(|unit| winch.by_twist.dot(&unit.component_mul(&half_widths)).abs());
            let sampled = sampled.fold(0.0, f64::max);
            assert!(sampled <= most * (1.0 + 1e-12) && sampled > 0.9 * most, "{sampled} of {most}");
            assert!(most <= winch.speed_in(&boxed) * (1.0 + 1e-12));
        }
        if half_widths[3] == 0.0 {
            let winch = &speeds.winches()[0];
            let length = winch.by_twist.fixed_rows::<3>(0).norm();
            assert!((winch.speed_in(&set) - 1.5 * length).abs() < 1e-12);
        }
        let powers = speeds.powers(&set);
        let mut sampled = [0.0_f64; 2];
        for unit in twists_in_balls(4000) {
            let of = speeds.powers_at(&unit.component_mul(&half_widths));
            sampled = [sampled[0].max(of.driving), sampled[1].max(of.braking)];
        }
        for (most, sampled) in [powers.driving, powers.braking].into_iter().zip(sampled) {
            assert!(sampled <= most * (1.0 + 1e-9) && sampled > 0.85 * most, "{sampled} of {most}");
        }
        assert!(speeds.factor(&set).value >= speeds.factor(&boxed).value * (1.0 - 1e-12));
    }
}

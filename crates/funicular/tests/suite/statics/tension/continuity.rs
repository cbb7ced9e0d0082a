//! Continuity of rules along lines of poses: on all robots of the library, with steps that are refined 200-fold.
//!
//! The variable `FUNICULAR_LINES=10000`, or a range of numbers such as `137..138`, selects other lines than the suite.

use crate::random::campaign::asked;
use funicular::math::{Vec3, Vec6};
use funicular::robot::{Pose, Robot, State, TensionLimits};
use funicular::statics::{self, StaticModel, TensionRule};
use std::ops::Range;

/// Lines of the suite.
const FEW: Range<u64> = 0..120;

/// Steps of a line, and parts of the step with the largest change.
const STEPS: usize = 12;
const PARTS: usize = 200;

/// Part of the largest change of a step that one of its 200 parts may keep: a smooth change keeps some 1/200, one that
/// is steepest beside a kink a few times that, a jump all.
const KEPT: f64 = 0.1;

/// Change over the largest tension that is rounding: rules other than the centre are exact to a millionth.
const ROUNDING: f64 = 1e-5;

/// Numbers from 0 to 1 of a line.
struct RandomNumbers(u64);

impl RandomNumbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Redundant robots of the library with a pose that their file holds, all with a maximum tension.
fn robots() -> Vec<(Robot, Pose)> {
    let mut robots = Vec::new();
    for (_, text) in funicular_robots::ALL {
        let robot = Robot::from_toml(text).unwrap();
        if !robot.constraint().is_redundant() {
            continue;
        }
        let pose = match &robot.state {
            State::Pose(pose) => *pose,
            State::Lengths(lengths) => statics::forward(&robot, lengths, StaticModel::Catenary, None).unwrap().pose,
            State::Unknown => continue,
        };
        let highest = statics::solve_at(&robot, &State::Pose(pose), StaticModel::Catenary, &TensionRule::Lowest);
        let highest = highest.unwrap().equilibrium;
        let highest = highest.cables.iter().map(|cable| cable.tension_platform).fold(0.0, f64::max);
        let has_maxima = robot.cables.iter().all(|cable| cable.limits().maximum.is_some());
        let limits = TensionLimits { minimum: None, maximum: (!has_maxima).then_some(4.0 * highest) };
        robots.push((robot.with_tension_limits(limits), pose));
    }
    robots
}

/// Largest part of a change of a tension that stays within one of 200 parts of the step in which it is; `None` if a
/// pose of the line is not held, or nothing changes.
fn kept(robot: &Robot, rule: &TensionRule, pose: &dyn Fn(f64) -> Pose) -> Option<f64> {
    let tensions = |t: f64| -> Option<Vec<f64>> {
        let found = statics::distribute_tensions(robot, &pose(t), StaticModel::Catenary, rule).ok()?;
        Some(found.cables.iter().map(|cable| cable.tension_platform).collect())
    };
    let change = |a: &Vec<f64>, b: &Vec<f64>| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let along = |from: f64, to: f64, parts: usize| -> Option<(f64, f64, f64)> {
        let mut last = tensions(from)?;
        let mut largest = (0.0, from);
        let size = last.iter().copied().fold(0.0, f64::max);
        for k in 1..=parts {
            let next = tensions(from + (to - from) * k as f64 / parts as f64)?;
            let by = change(&last, &next);
            if by > largest.0 {
                largest = (by, from + (to - from) * (k - 1) as f64 / parts as f64);
            }
            last = next;
        }
        Some((largest.0, largest.1, size))
    };
    let (coarse, at, _) = along(0.0, 1.0, STEPS)?;
    let (fine, _, size) = along(at, at + 1.0 / STEPS as f64, PARTS)?;
    (coarse > 0.0).then_some((fine - ROUNDING * size).max(0.0) / coarse)
}

#[test]
fn tensions_of_centre_and_lowest_do_not_jump_on_lines_of_all_robots() {
    let robots = robots();
    assert!(robots.len() >= 6, "{}", robots.len());
    let asked = asked("FUNICULAR_LINES", FEW);
    let mut followed = vec![0; robots.len()];
    let mut worst = (0.0, 0);
    for line in asked.clone() {
        let (robot, base) = &robots[line as usize % robots.len()];
        let mut random = RandomNumbers(line.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x5bd1_e995);
        let length = robot.cables.iter().map(|cable| cable.chord_w(base).norm()).fold(f64::INFINITY, f64::min);
        let mut end = || {
            let reach = |k: usize| if k < 3 { 0.25 * length } else { 0.15 };
            let motion = Vec6::from_fn(|k, _| reach(k) * (2.0 * random.next() - 1.0));
            robot.platform.motion.allowed(&motion)
        };
        let [from, to] = [end(), end()];
        let pose_of = |part: f64, t: f64| {
            let motion = (from + (to - from) * t) * part;
            base.moved(&Vec3::new(motion[0], motion[1], motion[2]), &Vec3::new(motion[3], motion[4], motion[5]))
        };
        for rule in [TensionRule::Centre, TensionRule::Lowest] {
            // A line that leaves the workspace is followed nearer to the pose of the file.
            let of_part = |part: f64| kept(robot, &rule, &|t| pose_of(part, t));
            let Some(kept) = [1.0, 0.5, 0.25].into_iter().find_map(of_part) else { continue };
            followed[line as usize % robots.len()] += 1;
            if kept > worst.0 {
                worst = (kept, line);
            }
            assert!(kept < KEPT, "line {line}, {}, {}: a jump, {kept}", robot.name, rule.name());
        }
    }
    println!("{followed:?} lines followed, largest part kept {} on line {}", worst.0, worst.1);
    if asked == FEW {
        assert!(followed.iter().all(|count| *count > 5), "{followed:?}");
        assert!(followed.iter().sum::<usize>() > 150, "{followed:?}");
    }
}

/// The measure finds a jump: the rule `middle` jumps by 68 N between two poses of CoGiRo that are 24 nm apart.
#[test]
fn a_jump_of_the_middle_is_found() {
    let robot = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    let pose = |t: f64| {
        let turn = [-0.238899985, 5.835693707, -0.570301491];
        let s = t - 0.46;
        Pose::new([3.198456389 + 2e-3 * s, -2.261249935 - 1e-3 * s, 3.574254715 + 5e-4 * s], turn)
    };
    assert!(kept(&robot, &TensionRule::Middle, &pose).unwrap() > 0.8);
    assert!(kept(&robot, &TensionRule::Centre, &pose).unwrap() < KEPT);
}

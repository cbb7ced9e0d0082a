//! Derivatives of tensions that follow a rule, against central differences of the tension distribution.

use super::{changes, distance, extrapolated, list};
use crate::random::Draw;
use funicular::cable::CableModel;
use funicular::gradient::{GradientError, Gradients, Hold};
use funicular::math::{Rotation, Vec3};
use funicular::robot::{Pose, Robot, RobotChange, TensionLimits, Wind};
use funicular::statics::{self, Equilibrium, Limit, StaticModel, TensionRange, TensionRule};
use std::fmt::Write as _;

/// Robot with more cables than degrees of freedom at a pose.
pub(super) struct RuleCase {
    pub(super) name: String,
    pub(super) robot: Robot,
    pub(super) pose: Pose,
    pub(super) rule: TensionRule,
    pub(super) model: StaticModel,
}

impl RuleCase {
    pub(super) fn at(&self, robot: &Robot, pose: &Pose) -> Option<Equilibrium> {
        statics::distribute_tensions(robot, pose, self.model, &self.rule).ok()
    }

    /// Equilibrium of the robot with a change, which may move the pose, too.
    pub(super) fn changed(&self, change: &RobotChange, step: f64) -> Option<(Robot, Equilibrium)> {
        let robot = self.robot.changed(change, step);
        let pose = Pose {
            position_w: self.pose.position_w + change.position_w * step,
            rot_wp: Rotation::from_scaled_axis(change.rotation_w * step) * self.pose.rot_wp,
        };
        let rest = self.at(&robot, &pose)?;
        Some((robot, rest))
    }
}

/// Tensions at both ends and lengths, these times a stiffness per length [N/m].
fn values(rest: &Equilibrium, stiffness: f64) -> Vec<f64> {
    let cables = rest.cables.iter();
    cables.flat_map(|c| [c.tension_platform, c.tension_anchor, c.unstrained_length * stiffness]).collect()
}

/// Robot with 7 to 9 cables between random points, some of them from below. `decades` are the logarithms of the axial
/// stiffness and of the mass per length; `turned` gives the angle of an attachment about the vertical, from the number
/// of the cable and the angle of its anchor.
pub(super) fn random_robot(
    draw: &mut Draw,
    number: u64,
    decades: [(f64, f64); 2],
    turned: impl Fn(&mut Draw, usize, f64) -> f64,
) -> Robot {
    let cables = 7 + (number % 3) as usize;
    let [stiffness, mass] = decades;
    let mut text = format!(
        "name = \"random\"\n[platform]\nmass_kg = {}\ninertia_kg_m2 = [0.9, 1.0, 1.1]\n[materials.rope]\n\
         axial_stiffness_n = {}\nmass_kg_per_m = {}\n",
        draw.decades(1.0, 2.3),
        draw.decades(stiffness.0, stiffness.1),
        draw.decades(mass.0, mass.1),
    );
    for i in 0..cables {
        let around = std::f64::consts::TAU * (i as f64 + 0.5 * draw.between(0.0, 1.0)) / cables as f64;
        let z = if i % 4 == 3 { -draw.between(1.0, 3.0) } else { draw.between(3.0, 5.0) };
        let anchor = [6.0 * around.cos(), 5.0 * around.sin(), z];
        let turned = turned(draw, i, around);
        let attachment = [0.4 * turned.cos(), 0.4 * turned.sin(), draw.between(-0.3, 0.3)];
        writeln!(
            text,
            "[[cables]]\nname = \"{i}\"\nmaterial = \"rope\"\nanchor_m = {anchor:?}\nattachment_m = {attachment:?}"
        )
        .unwrap();
    }
    Robot::from_toml(&text).unwrap()
}

/// Random robot at a random pose, whose tensions follow a rule.
fn random_case(number: u64) -> RuleCase {
    let mut draw = Draw(number);
    let turned = |draw: &mut Draw, _: usize, around: f64| 2.3 * around + draw.between(-0.5, 0.5);
    let robot = random_robot(&mut draw, number, [(3.7, 6.0), (-2.5, -0.3)], turned);
    let position_w = Vec3::from(draw.vector(0.6));
    let pose = Pose { position_w, rot_wp: Rotation::from_scaled_axis(draw.vector(0.1).into()) };
    let weight = robot.platform.mass * 9.81;
    let (robot, rule) = match number % 4 {
        0 => (robot, TensionRule::Lowest),
        1 => (robot, TensionRule::Closest(vec![draw.between(0.1, 1.5) * weight])),
        2 => {
            let limits = TensionLimits { minimum: Some(0.05 * weight), maximum: Some(1.2 * weight) };
            (robot.with_tension_limits(limits), TensionRule::Closest(vec![1.3 * weight]))
        }
        _ => {
            let limits = TensionLimits { minimum: Some(0.02 * weight), maximum: Some(3.0 * weight) };
            (robot.with_tension_limits(limits), TensionRule::Middle)
        }
    };
    let model = if number % 5 == 4 { StaticModel::Spring } else { StaticModel::Catenary };
    RuleCase { name: format!("random {number}, {rule:?}, {model:?}"), robot, pose, rule, model }
}

/// Robots of the library with more cables than degrees of freedom, with several rules each, and random ones.
fn cases() -> Vec<RuleCase> {
    let mut all: Vec<RuleCase> = (0..60).map(random_case).collect();
    for (file, robot, rest) in crate::library::library() {
        if robot.cables.len() <= robot.platform.motion.count() {
            continue;
        }
        let mean = rest.cables.iter().map(|cable| cable.tension_platform).sum::<f64>() / robot.cables.len() as f64;
        let limits = TensionLimits { minimum: Some(0.3 * mean), maximum: Some(3.0 * mean) };
        let limited = robot.with_tension_limits(limits);
        for (robot, rule) in [
            (robot.clone(), TensionRule::Lowest),
            (robot.clone(), TensionRule::Closest(vec![mean])),
            (limited.clone(), TensionRule::Closest(vec![0.5 * mean])),
            (limited.clone(), TensionRule::Middle),
            (limited, TensionRule::Centre),
        ] {
            let (name, pose) = (format!("{file}, {rule:?}"), rest.pose);
            all.push(RuleCase { name, robot, pose, rule, model: StaticModel::Catenary });
        }
    }

    // Wind, a load, a tilt and ropes that sag, so that limits act at every place of a cable.
    let mut robot = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    robot.cables.iter_mut().for_each(|cable| {
        cable.material.mass_per_length = 0.6;
        cable.material.drag_width = Some(0.005);
    });
    robot.load.force_w = Vec3::new(40.0, -30.0, -80.0);
    robot.load.moment_w = Vec3::new(3.0, 2.0, -1.0);
    robot.load.point_p = Vec3::new(0.05, -0.1, 0.08);
    robot.platform.drag_area = 0.2;
    let robot = robot.with_wind(Wind { velocity_w: Vec3::new(12.0, 5.0, 1.0), ..Wind::default() });
    for (minimum, rule) in [
        (Some(250.0), TensionRule::Closest(vec![300.0])),
        (Some(150.0), TensionRule::Centre),
        (None, TensionRule::Lowest),
        (None, TensionRule::Closest(vec![10.0, 300.0, 200.0, 400.0, 350.0, 150.0, 350.0, 350.0])),
    ] {
        let pose = Pose {
            position_w: Vec3::new(1.0, 1.5, 1.2),
            rot_wp: Rotation::from_scaled_axis(Vec3::new(0.05, 0.02, -0.1)),
        };
        let robot = if minimum.is_some() {
            robot.with_tension_limits(TensionLimits { minimum, maximum: Some(2000.0) })
        } else {
            let mut robot = robot.clone();
            robot.cables.iter_mut().for_each(|cable| {
                (cable.material.tension_limits.minimum, cable.tension_limits.minimum) = (None, None);
            });
            robot
        };
        all.push(RuleCase {
            name: format!("in wind, {minimum:?}, {rule:?}"),
            robot,
            pose,
            rule,
            model: StaticModel::Catenary,
        });
    }
    all
}

/// Number of cables at a limit.
fn at_limits(case: &RuleCase, rest: &Equilibrium) -> usize {
    let reached = |(i, state): (usize, &statics::CableState)| {
        TensionRange::of(&case.robot, i, &state.chord_w()).margin(state).reached().is_some()
    };
    rest.cables.iter().enumerate().filter(|cable| reached(*cable)).count()
}

/// Every number changes the tensions and the lengths as the distribution of the changed robot says. The distribution
/// ends when tensions change by 1e-10 of their size, over steps that change them by 1e-4 to 1e-2. Half of the
/// extrapolation's own part is spared. The centre is found to rounding, but its limits have narrow rounded corners: a
/// turn of the load by a thousandth moves the lowest point of a level rope to its end. So its differences count where
/// those of a tenfold longer step are the same.
#[test]
fn tensions_follow_their_rule_with_every_number_of_the_robot() {
    let (mut compared, mut limited, mut refused, mut centres) = (0, 0, 0, 0);
    for case in cases() {
        let is_centre = case.rule == TensionRule::Centre;
        let (noise, steps): (f64, &[f64]) =
            if is_centre { (1e-11, &[1.0, 1e-1, 1e-2, 1e-3, 1e-4]) } else { (1e-9, &[1.0, 1e-2, 1e-4]) };
        let Some(rest) = case.at(&case.robot, &case.pose) else { continue };
        let gradients = match Gradients::by_rule(&case.robot, &rest, &case.rule) {
            Ok(gradients) => gradients,
            Err(GradientError::OneSided { .. } | GradientError::DefaultMinimum { .. }) => {
                refused += 1;
                continue;
            }
            Err(error) => panic!("{}: {error}", case.name),
        };
        let stiffness = case.robot.cables[0].material.axial_stiffness;
        let (platform, anchor, lengths) =
            (gradients.tensions_platform(), gradients.tensions_anchor(), gradients.lengths());
        let mut all = changes(&case.robot);
        all.retain(|(what, ..)| *what != "length");
        let none = RobotChange::none(case.robot.cables.len());
        all.push(("position", RobotChange { position_w: Vec3::new(0.2, 1.0, -0.4), ..none.clone() }, 1e-4));
        if case.robot.platform.motion.count() == 6 {
            all.push(("turn", RobotChange { rotation_w: Vec3::new(0.2, 1.0, -0.4), ..none }, 1e-4));
        }
        for (what, change, step) in all {
            let found: Vec<f64> = (0..case.robot.cables.len())
                .flat_map(|i| [platform[i].dot(&change), anchor[i].dot(&change), lengths[i].dot(&change) * stiffness])
                .collect();
            let motion = case.robot.platform.motion;
            if what == "position" && motion.count() < 3 {
                continue;
            }
            // Shorter steps, if the first ones cross a change of the limits that are reached.
            let size_of_tensions = rest.cables.iter().map(|c| c.tension_platform).fold(0.0, f64::max);
            let (mut smooth, mut longer) = (None, None);
            for shorter in steps {
                let step = step * shorter;
                let differences =
                    extrapolated(step, |h| case.changed(&change, h).map(|(_, rest)| values(&rest, stiffness)));
                let Some((differences, added)) = differences else { continue };
                let (error, size) = distance(&found, &differences);
                let rounding = noise * size_of_tensions / step;
                let last: Option<Vec<f64>> = longer.replace(differences.clone());
                let is_same = |last: &Vec<f64>| distance(last, &differences).0 <= 1e-5 * size + rounding;
                if added <= 1e-4 * size && (!is_centre || last.as_ref().is_some_and(is_same)) {
                    smooth = Some((error, size, added, rounding));
                    break;
                }
            }
            let Some((error, size, added, rounding)) = smooth else { continue };
            assert!(
                error <= 1e-5 * size + added + rounding,
                "{}, {what}: {error:e} of {size:e}, extrapolation {added:e}, rounding {rounding:e}",
                case.name
            );
            compared += 1;
            centres += usize::from(is_centre);
            limited += usize::from(at_limits(&case, &rest) > 0);
        }
    }
    assert!(centres > 40, "{centres}");
    assert!(compared > 500 && limited > 150 && refused < 10, "{compared} {limited} {refused}");
}

/// First natural frequency and minimum stiffness follow the rule, too: what a design changes. Frequencies are certain
/// to 1e-10 of themselves, over steps that change them by 1e-4.
#[test]
fn frequencies_and_stiffness_follow_the_rule_of_the_tensions() {
    let mut compared = 0;
    for (text, [x, y, target]) in [
        (funicular_robots::COGIRO, [0.0, 0.0, 350.0]),
        (funicular_robots::COGIRO, [2.0, -1.5, 350.0]),
        (funicular_robots::COGIRO, [-3.0, 1.0, 200.0]),
        (funicular_robots::COGIRO_WINCHES, [2.0, -1.5, 350.0]),
    ] {
        let robot = Robot::from_toml(text).unwrap();
        let (pose, rule) = (Pose::new([x, y, 1.5], [0.0; 3]), TensionRule::Closest(vec![target]));
        let case = RuleCase { name: String::new(), robot: robot.clone(), pose, rule, model: StaticModel::Catenary };
        let results = |robot: &Robot, rest: &Equilibrium| {
            let (_, modes) = list(robot, rest, CableModel::CatenaryDynamic, 6.0).unwrap();
            vec![modes[0].frequency_hz, 1e-4 * rest.stability.min_stiffness().unwrap()]
        };
        let rest = case.at(&robot, &case.pose).unwrap();
        let (dynamics, modes) = list(&robot, &rest, CableModel::CatenaryDynamic, 6.0).unwrap();
        let gradients = Gradients::by_rule(&robot, &rest, &case.rule).unwrap();
        assert_eq!(gradients.hold(), Hold::Rule);
        let first = gradients.vibration(&dynamics).unwrap().frequency(&modes[0]).unwrap();
        let stiffness = gradients.min_stiffness().unwrap();
        for (what, change, step) in changes(&robot) {
            if what == "length" {
                continue;
            }
            let found = [first.dot(&change), 1e-4 * stiffness.dot(&change)];
            let differences =
                extrapolated(step, |h| case.changed(&change, h).map(|(robot, rest)| results(&robot, &rest)));
            let (differences, _) = differences.unwrap();
            for (found, difference) in found.iter().zip(&differences) {
                let allowed = 1e-5 * difference.abs() + 1e-9 / step;
                assert!((found - difference).abs() <= allowed, "({x}, {y}), {what}: {found} {difference}");
                compared += 1;
            }
        }
    }
    assert!(compared > 40, "{compared}");
}

/// Rules without derivatives, tensions of another rule, and limits that do not press.
#[test]
fn tensions_without_derivatives_by_a_rule_are_refused() {
    let robot = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    let pose = Pose::new([0.5, 0.3, 1.5], [0.0; 3]);
    let closest = TensionRule::Closest(vec![350.0]);
    let rest = statics::distribute_tensions(&robot, &pose, StaticModel::Catenary, &closest).unwrap();
    let refused = |rule: &TensionRule| Gradients::by_rule(&robot, &rest, rule).err().unwrap();
    assert_eq!(refused(&TensionRule::Stiffest), GradientError::Stiffest);
    assert!(matches!(refused(&TensionRule::Lowest), GradientError::NotByRule { rule: "lowest", .. }));
    assert!(matches!(refused(&TensionRule::Closest(vec![300.0])), GradientError::NotByRule { .. }));
    assert_eq!(Gradients::new(&robot, &rest, Hold::Rule).err(), Some(GradientError::NoRule));

    // A maximum exactly at the tension that the rule chooses anyway.
    let (highest, state) =
        rest.cables.iter().enumerate().max_by(|(_, a), (_, b)| a.tension_anchor.total_cmp(&b.tension_anchor)).unwrap();
    let mut limited = robot.clone();
    limited.cables[highest].tension_limits.maximum = Some(state.hanging.as_ref().unwrap().catenary.max_tension());
    let rest = statics::distribute_tensions(&limited, &pose, StaticModel::Catenary, &closest).unwrap();
    let error = Gradients::by_rule(&limited, &rest, &closest).err().unwrap();
    let GradientError::OneSided { limit, .. } = &error else { panic!("{error}") };
    assert_eq!(*limit, Some(Limit::Maximum));
    assert!(error.to_string().contains("the limit does not change the tensions"), "{error}");
}

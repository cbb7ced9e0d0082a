//! Derivatives of tensions that follow a rule over pulleys and to winches, against differences of the tension
//! distribution, for random robots with more cables than degrees of freedom.

use super::tension_rule::{RuleCase, random_robot};
use super::{distance, drives};
use crate::random::Draw;
use funicular::gradient::{GradientError, Gradients};
use funicular::math::{Rotation, Vec3};
use funicular::robot::{Control, Pose, Pulley, RobotChange, Servo, TensionLimits, Winch, Wind};
use funicular::statics::{CableState, Equilibrium, StaticModel, TensionRange, TensionRule};

/// Robot over pulleys with upright or inclined axes and to winches, rigid or not; every third cable of some robots has
/// no pulley, another none of both.
pub(super) fn random_case(number: u64) -> RuleCase {
    let mut draw = Draw(1000 + number);
    let turned = |draw: &mut Draw, i: usize, around: f64| {
        // The cables pull alternately in both senses about the vertical.
        let sense = if i.is_multiple_of(2) { 1.0 } else { -1.0 };
        around + sense * draw.between(0.6, 1.4)
    };
    let mut robot = random_robot(&mut draw, number, [(4.0, 6.0), (-2.5, -0.5)], turned);

    // Drives.
    let (mixed, inclined, yields) = (draw.between(0.0, 1.0) < 0.5, number % 2 == 1, draw.between(0.0, 1.0) < 0.6);
    let (radius, drum_side) = (draw.between(0.02, 0.15), draw.between(0.0, 4.0));
    for (i, cable) in robot.cables.iter_mut().enumerate() {
        cable.material.drag_width = Some(0.006);
        let lean = if inclined { Vec3::from(draw.vector(0.5)) } else { Vec3::zeros() };
        let upwards = cable.anchor.point_w.z.signum();
        let (stiffness, gain) = (draw.decades(4.3, 6.0), draw.decades(4.3, 6.0));
        if !(mixed && i % 3 == 1) {
            let direction_w = (Vec3::z() * upwards + lean).normalize();
            cable.anchor.pulley = Some(Pulley::new("wheel", radius * (1.0 + 0.1 * i as f64), direction_w));
        }
        if !(mixed && i % 6 == 4) {
            let mut winch = Winch::rigid("drum", drum_side);
            if yields {
                winch.stiffness = stiffness;
                let servo = Servo { position_gain: gain, speed_gain: 30.0, integral: i % 2 == 0, delay: 0.0 };
                winch.control = Control::Position(servo);
            }
            cable.anchor.winch = Some(winch);
        }
    }

    // Loads and wind.
    let weight = robot.platform.mass * 9.81;
    robot.load.force_w = Vec3::from(draw.vector(0.1 * weight));
    robot.load.point_p = Vec3::from(draw.vector(0.1));
    robot.platform.drag_area = 0.1;
    if draw.between(0.0, 1.0) < 0.5 {
        let velocity_w = Vec3::from(draw.vector(12.0));
        robot = robot.with_wind(Wind { velocity_w, ..Wind::default() });
    }

    // Rule and limits; without limits of the file the minimum is a multiple of the rope's load.
    let limits = |low: f64, high: f64| TensionLimits { minimum: Some(low * weight), maximum: Some(high * weight) };
    let (robot, rule) = match number % 7 {
        0 => (robot, TensionRule::Lowest),
        1 => (robot, TensionRule::Closest(vec![draw.between(0.1, 1.5) * weight])),
        2 => (robot.with_tension_limits(limits(0.05, 1.2)), TensionRule::Closest(vec![1.3 * weight])),
        3 => (robot.with_tension_limits(limits(0.2, 2.0)), TensionRule::Closest(vec![0.1 * weight])),
        4 => (robot.with_tension_limits(limits(0.1, 3.0)), TensionRule::Lowest),
        5 => {
            let default = TensionLimits { minimum: None, maximum: Some(3.0 * weight) };
            (robot.with_tension_limits(default), TensionRule::Middle)
        }
        _ => (robot.with_tension_limits(limits(0.02, 3.0)), TensionRule::Middle),
    };
    let position_w = Vec3::from(draw.vector(0.4));
    let pose = Pose { position_w, rot_wp: Rotation::from_scaled_axis(draw.vector(0.1).into()) };
    let model = if number % 5 == 4 { StaticModel::Spring } else { StaticModel::Catenary };
    RuleCase { name: format!("{number}, {rule:?}"), robot, pose, rule, model }
}

/// Tensions at both ends and at the drum, and lengths, these times a stiffness per length [N/m].
fn values(rest: &Equilibrium, stiffness: f64) -> Vec<f64> {
    let of = |c: &CableState| [c.tension_platform, c.tension_anchor, c.tension_drum(), c.unstrained_length * stiffness];
    rest.cables.iter().flat_map(of).collect()
}

/// Cables at a limit: [in the span, at the drum].
fn at_limits(case: &RuleCase, rest: &Equilibrium) -> [usize; 2] {
    let mut counts = [0; 2];
    for (i, state) in rest.cables.iter().enumerate() {
        let margin = TensionRange::of(&case.robot, i, &state.chord_w()).margin(state);
        if margin.reached().is_some() {
            let drum = state.tension_drum();
            counts[usize::from(state.drive.is_some() && (drum <= margin.min || drum >= margin.max))] += 1;
        }
    }
    counts
}

/// Derivatives along one change of the robot, compared with differences.
struct Compared {
    what: &'static str,
    /// Step of the differences.
    step: f64,
    error: f64,
    /// Size of the differences, and the part that the extrapolation has added.
    size: f64,
    added: f64,
}

/// Derivatives along changes of all numbers and of the pose, compared with differences where these are smooth.
fn compared_with_differences(case: &RuleCase, gradients: &Gradients<'_>) -> Vec<Compared> {
    let none = RobotChange::none(case.robot.cables.len());
    let stiffness = case.robot.cables[0].material.axial_stiffness;
    let (platform, anchor, drum, lengths) =
        (gradients.tensions_platform(), gradients.tensions_anchor(), gradients.tensions_drum(), gradients.lengths());
    let mut all = drives::changes(&case.robot);
    all.retain(|(what, _)| *what != "length");
    all.push(("position", RobotChange { position_w: Vec3::new(0.02, 0.1, -0.04), ..none.clone() }));
    all.push(("turn", RobotChange { rotation_w: Vec3::new(0.02, 0.1, -0.04), ..none }));
    let compared = all.into_iter().filter_map(|(what, change)| {
        let found: Vec<f64> = (0..case.robot.cables.len())
            .flat_map(|i| {
                let length = &lengths[i];
                [&platform[i], &anchor[i], &drum[i], length].map(|of| of.dot(&change))
            })
            .enumerate()
            .map(|(k, value)| if k % 4 == 3 { value * stiffness } else { value })
            .collect();

        // Shorter steps, if the first ones cross a change of the limits that are reached.
        [0.1, 1e-2, 1e-3].into_iter().find_map(|step| {
            let differences = drives::extrapolated(step, |h| Some(values(&case.changed(&change, h)?.1, stiffness)));
            let (differences, added) = differences?;
            let (error, size) = distance(&found, &differences);
            let (added, _) = distance(&added, &vec![0.0; added.len()]);
            (added <= 1e-7 * size).then_some(Compared { what, step, error, size, added })
        })
    });
    compared.collect()
}

/// Every number changes the tensions and the lengths as the distribution of the changed robot says. The distribution
/// ends when tensions change by 1e-10 of their size; the tensions of deeply sagging cables, which it approaches slowly,
/// then lack up to 5e-9. Most are found to 1e-12, so that the differences agree to 1e-8.
#[test]
fn tensions_over_pulleys_follow_their_rule_with_every_number_of_the_robot() {
    let (mut compared, mut limited, mut by_rule) = ([0; 2], [0; 2], [0; 3]);
    let (mut refused, mut agreeing) = (0, 0);
    for number in 0..90 {
        let case = random_case(number);
        let Some(rest) = case.at(&case.robot, &case.pose) else { continue };
        let gradients = match Gradients::by_rule(&case.robot, &rest, &case.rule) {
            Ok(gradients) => gradients,
            Err(GradientError::OneSided { .. } | GradientError::DefaultMinimum { .. }) => {
                refused += 1;
                continue;
            }
            Err(error) => panic!("{}: {error}", case.name),
        };
        let size_of_tensions = rest.cables.iter().map(|c| c.tension_platform).fold(0.0, f64::max);
        let at = at_limits(&case, &rest);
        for Compared { what, step, error, size, added } in compared_with_differences(&case, &gradients) {
            // The extrapolation multiplies the lack of the values by four.
            let rounding = 4.0 * 5e-9 * size_of_tensions / step;
            assert!(
                error <= 1e-8 * size + added + rounding,
                "{}, {what}: {error:e} of {size:e}, extrapolation {added:e}, rounding {rounding:e}, step \
                 {step}, at limits {at:?}",
                case.name
            );
            agreeing += usize::from(error <= 1e-8 * size);
            compared[usize::from(case.model == StaticModel::Spring)] += 1;
            limited[0] += usize::from(at[0] > 0);
            limited[1] += usize::from(at[1] > 0);
            by_rule[match case.rule {
                TensionRule::Lowest => 0,
                TensionRule::Closest(_) => 1,
                _ => 2,
            }] += 1;
        }
    }
    let total = compared[0] + compared[1];
    assert!(compared[0] > 300 && compared[1] > 50 && agreeing > total * 9 / 10, "{agreeing} of {compared:?}");
    assert!(limited[0] > 50 && limited[1] > 30, "{limited:?}");
    assert!(by_rule.iter().all(|count| *count > 80) && refused < 10, "{by_rule:?} {refused}");
}

/// Centre of the tensions, which the same robots over pulleys have within given limits and above a default minimum;
/// many of their ropes sag so deeply that the exit points move with the tensions.
#[test]
fn the_centre_over_pulleys_follows_every_number_of_the_robot() {
    let (mut compared, mut worst) = (0, 0.0_f64);
    for number in 0..40 {
        let case = random_case(number);
        let weight = case.robot.platform.mass * 9.81;
        let minimum = (number % 4 > 0 || case.model == StaticModel::Spring).then_some(0.05 * weight);
        let robot = case.robot.with_tension_limits(TensionLimits { minimum, maximum: Some(4.0 * weight) });
        let name = format!("{number}, centre, minimum {minimum:?}");
        let case = RuleCase { name, rule: TensionRule::Centre, robot, ..case };
        let Some(rest) = case.at(&case.robot, &case.pose) else { continue };
        let gradients = match Gradients::by_rule(&case.robot, &rest, &case.rule) {
            Ok(gradients) => gradients,
            Err(GradientError::DefaultMinimum { .. }) => continue,
            Err(error) => panic!("{}: {error}", case.name),
        };
        for Compared { what, error, size, added, .. } in compared_with_differences(&case, &gradients) {
            let name = &case.name;
            assert!(error <= 1e-5 * size + added, "{name}, {what}: {error:e} of {size:e}, extrapolation {added:e}");
            worst = worst.max((error - added) / size);
            compared += 1;
        }
    }
    assert!(compared > 200 && worst > 0.0, "{compared} {worst:e}");
}

//! Gradients of robots with pulleys and winches against differences of the program itself, for random robots.

use super::{distance, lengths_of};
use funicular::gradient::{Gradients, Hold};
use funicular::math::Vec3;
use funicular::robot::{CableChange, Control, Pulley, Robot, RobotChange, Servo, Winch, Wind};
use funicular::statics::{self, Equilibrium, StaticModel};
use proptest::prelude::*;

/// Numbers of a random robot with drives.
#[derive(Debug, Clone)]
pub(super) struct Chosen {
    pub(super) radius: f64,
    /// Inclination of the swivel axes.
    pub(super) incline: [f64; 2],
    pub(super) drum_side: f64,
    /// Stiffness of the winches [N/m]; rigid beyond 1e6.
    pub(super) stiffness: f64,
    /// Position gain of a control without integral action [N/m]; an ideal one beyond 1e6.
    pub(super) gain: f64,
    pub(super) wind: [f64; 3],
    /// Wrap of a cable without pulley: every third cable has none.
    pub(super) mixed: bool,
    pub(super) longer: f64,
}

pub(super) fn chosen() -> impl Strategy<Value = Chosen> {
    let incline = prop_oneof![Just([0.0, 0.0]), [-0.5..0.5_f64, -0.5..0.5]];
    let wind = prop_oneof![Just([0.0; 3]), [-15.0..15.0_f64, -15.0..15.0, -3.0..3.0]];
    let drive = (0.02..0.12_f64, incline, 0.0..4.0_f64, 4.3..6.5_f64, 4.0..6.5_f64);
    (drive, wind, any::<bool>(), -0.002..0.004_f64).prop_map(
        |((radius, incline, drum_side, stiffness, gain), wind, mixed, longer)| {
            let (stiffness, gain) = (10_f64.powf(stiffness), 10_f64.powf(gain));
            Chosen { radius, incline, drum_side, stiffness, gain, wind, mixed, longer }
        },
    )
}

/// Robot with the chosen drives, at rest with lengths that are given.
pub(super) fn robot_of(chosen: &Chosen) -> Option<(Robot, Equilibrium)> {
    let text = funicular_robots::YUAN2014_4MM
        .replace("damping_ratio = 0.003", "damping_ratio = 0.003\ndrag_coefficient = 1.2");
    let mut robot = Robot::from_toml(&text).unwrap();
    let straight = statics::forward(&robot, &super::LENGTHS, StaticModel::Catenary, None).ok()?;
    robot.load.force_w = Vec3::new(5.0, -3.0, -8.0);
    robot.load.moment_w = Vec3::new(0.3, 0.2, -0.1);
    robot.load.point_p = Vec3::new(0.05, -0.1, 0.08);
    robot.platform.drag_area = 0.02;
    let mut robot = robot.with_wind(Wind { velocity_w: Vec3::from(chosen.wind), ..Wind::default() });

    for (i, cable) in robot.cables.iter_mut().enumerate() {
        let without = chosen.mixed && i % 3 == 1;
        let side = if i % 2 == 0 { 1.0 } else { -0.7 };
        let [x, y] = chosen.incline;
        if !without {
            let direction_w = Vec3::new(x * side, y, 1.0).normalize();
            cable.anchor.pulley = Some(Pulley::new("wheel", chosen.radius * (1.0 + 0.1 * i as f64), direction_w));
        }
        if !(chosen.mixed && i % 3 == 2) {
            let mut winch = Winch::rigid("drum", chosen.drum_side);
            if chosen.stiffness < 1e6 {
                winch.stiffness = chosen.stiffness;
            }
            if chosen.gain < 1e6 {
                let servo = Servo { position_gain: chosen.gain, speed_gain: 30.0, integral: i % 2 == 0, delay: 0.0 };
                winch.control = Control::Position(servo);
            }
            cable.anchor.winch = Some(winch);
        }
    }

    let held = statics::inverse(&robot, &straight.pose, StaticModel::Catenary).ok()?;
    let lengths: Vec<f64> = lengths_of(&held).iter().map(|length| length * (1.0 + chosen.longer)).collect();
    let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, Some(&held.pose)).ok()?;
    let taut = rest.cables.iter().all(|cable| cable.tension_platform > 4.0);
    (taut && rest.stability.is_stable() == Some(true) && rest.residual < 1e-11).then_some((robot, rest))
}

/// Changes of the numbers of the robot, random over all cables, with a usual size each: changes of about a thousandth.
pub(super) fn changes(robot: &Robot) -> Vec<(&'static str, RobotChange)> {
    let none = || RobotChange::none(robot.cables.len());
    let mut all = vec![
        ("mass", RobotChange { mass: 1.0, ..none() }),
        ("gravity", RobotChange { gravity_w: Vec3::new(0.3, -0.2, 1.0), ..none() }),
        ("centre", RobotChange { center_of_mass_p: Vec3::new(0.03, 0.02, -0.03), ..none() }),
        ("force", RobotChange { force_w: Vec3::new(3.0, 2.0, -4.0), ..none() }),
        ("point", RobotChange { point_p: Vec3::new(0.1, 0.05, -0.1), ..none() }),
    ];
    if robot.wind.velocity_w != Vec3::zeros() {
        all.push(("wind", RobotChange { wind_velocity_w: Vec3::new(2.0, -1.0, 0.5), ..none() }));
        all.push(("density", RobotChange { air_density: 0.1, ..none() }));
    }
    let mut of_cables = |name, set: &dyn Fn(&Robot, usize, f64, &mut CableChange)| {
        let mut change = none();
        for (i, cable) in change.cables.iter_mut().enumerate() {
            set(robot, i, (1.7 * i as f64 + 0.3).sin(), cable);
        }
        all.push((name, change));
    };
    of_cables("anchor", &|_, _, x, cable| cable.anchor_w = Vec3::new(0.03, 0.05 * x, -0.02) * x);
    of_cables("attachment", &|_, _, x, cable| cable.attachment_p = Vec3::new(0.01, -0.01 * x, 0.02) * x);
    of_cables("length", &|_, _, x, cable| cable.unstrained_length = 0.01 * x);
    of_cables("stiffness", &|robot, i, x, cable| {
        cable.axial_stiffness = 0.1 * x * robot.cables[i].material.axial_stiffness;
    });
    of_cables("rope", &|_, _, x, cable| cable.mass_per_length = 0.01 * x);
    of_cables("load", &|_, _, x, cable| cable.load_per_length_w = Vec3::new(0.1, 0.1 * x, -0.1));
    of_cables("drag", &|_, _, x, cable| cable.drag_width = 3e-4 * x);
    of_cables("radius", &|_, _, x, cable| cable.pulley.radius = 0.005 * x);
    of_cables("direction", &|robot, i, x, cable| {
        if let Some(pulley) = &robot.cables[i].anchor.pulley {
            cable.pulley.entry_direction_w = pulley.entry_direction_w.cross(&Vec3::new(0.6, 0.5 * x, -0.3)) * 0.3;
        }
    });
    of_cables("drum side", &|_, _, x, cable| cable.winch.drum_side_length = 0.02 * x);
    of_cables("winch", &|robot, i, x, cable| {
        let stiffness = robot.cables[i].anchor.winch.as_ref().map_or(0.0, |winch| winch.stiffness);
        cable.winch.stiffness = if stiffness.is_finite() { 0.2 * x * stiffness } else { 0.0 };
    });
    of_cables("gain", &|robot, i, x, cable| {
        if let Some(Control::Position(servo)) = robot.cables[i].anchor.winch.as_ref().map(|winch| winch.control) {
            cable.winch.position_gain = 0.2 * x * servo.position_gain;
        }
    });
    all
}

/// Central differences at a step, at a half and at a quarter of it, extrapolated twice; and how much the last one adds.
pub(super) fn extrapolated(step: f64, mut at: impl FnMut(f64) -> Option<Vec<f64>>) -> Option<(Vec<f64>, f64)> {
    let mut central = |h: f64| -> Option<Vec<f64>> {
        let (low, high) = (at(-h)?, at(h)?);
        Some(low.iter().zip(&high).map(|(low, high)| (high - low) / (2.0 * h)).collect())
    };
    let (one, half, quarter) = (central(step)?, central(0.5 * step)?, central(0.25 * step)?);
    let twice = |coarse: &[f64], fine: &[f64], factor: f64| -> Vec<f64> {
        coarse.iter().zip(fine).map(|(coarse, fine)| fine + (fine - coarse) / (factor - 1.0)).collect()
    };
    let (first, second) = (twice(&one, &half, 4.0), twice(&half, &quarter, 4.0));
    let best = twice(&first, &second, 16.0);
    let added = distance(&best, &second).0;
    Some((best, added))
}

/// Equilibrium of the changed robot with lengths held, apart from their own change.
pub(super) fn changed(robot: &Robot, rest: &Equilibrium, change: &RobotChange, h: f64) -> Option<(Robot, Equilibrium)> {
    let changed = robot.changed(change, h);
    let lengths: Vec<f64> =
        lengths_of(rest).iter().zip(&change.cables).map(|(l, c)| l + h * c.unstrained_length).collect();
    let at = statics::forward(&changed, &lengths, StaticModel::Catenary, Some(&rest.pose)).ok()?;
    (at.residual < 1e-11).then_some((changed, at))
}

/// Pose, tensions, and the stiffness if no drag turns.
fn values(robot: &Robot, rest: &Equilibrium, from: &Equilibrium) -> Vec<Vec<f64>> {
    let turn = (rest.pose.rot_wp * from.pose.rot_wp.inverse()).scaled_axis();
    let of = |value: fn(&statics::CableState) -> f64| rest.cables.iter().map(value).collect::<Vec<f64>>();
    let tangent = statics::tangent_stiffness(robot, rest).unwrap();
    let mut all = vec![
        (rest.pose.position_w - from.pose.position_w).iter().copied().collect(),
        turn.iter().copied().collect(),
        of(|cable| cable.tension_platform),
        of(|cable| cable.tension_anchor),
        of(statics::CableState::tension_drum),
        vec![tangent[(0, 0)], tangent[(1, 4)] + tangent[(4, 1)], tangent[(5, 5)]],
    ];
    if !(robot.wind.velocity_w != Vec3::zeros()) {
        all.push(vec![rest.stability.min_stiffness().unwrap()]);
    }
    all
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 6, failure_persistence: None, ..Default::default() })]

    /// Pose, tensions and stiffness with lengths held. The forward solver finds an equilibrium to 1e-12 of the forces, over
    /// steps that change them by a hundredth or so; the differences extrapolate two orders of the step.
    #[test]
    fn statics_with_drives_follow_every_number(chosen in chosen()) {
        let Some((robot, rest)) = robot_of(&chosen) else { return Err(TestCaseError::reject("no such rest")) };
        let gradients = Gradients::new(&robot, &rest, Hold::Lengths).unwrap();
        let entry = |i, j| gradients.tangent_entry(i, j).unwrap();
        let pose = gradients.pose();
        let twice = |gradient: RobotChange| [gradient.clone(), gradient];
        let mut ours: Vec<Vec<Vec<RobotChange>>> = [
            pose[..3].to_vec(), pose[3..].to_vec(), gradients.tensions_platform(), gradients.tensions_anchor(),
            gradients.tensions_drum(),
        ].into_iter().map(|rows| rows.into_iter().map(|row| vec![row]).collect()).collect();
        ours.push(vec![vec![entry(0, 0)], twice(entry(1, 4)).to_vec(), vec![entry(5, 5)]]);
        if !(robot.wind.velocity_w != Vec3::zeros()) {
            ours.push(vec![vec![gradients.min_stiffness().unwrap()]]);
        }

        let sizes = values(&robot, &rest, &rest);
        let mut compared = 0;
        for (what, change) in changes(&robot) {
            let step = 0.1;
            let flat = extrapolated(step, |h| {
                let (robot, at) = changed(&robot, &rest, &change, h)?;
                Some(values(&robot, &at, &rest).concat())
            });
            let Some((differences, added)) = flat else { continue };
            // Beside a slack cable or another equilibrium a step is too long.
            let (_, size) = distance(&differences, &differences);
            if added > 1e-7 * size {
                continue;
            }
            let mut first = 0;
            for (k, rows) in ours.iter().enumerate() {
                let found: Vec<f64> = rows.iter().map(|row| row.iter().map(|of| of.dot(&change)).sum()).collect();
                let (error, size) = distance(&found, &differences[first..first + found.len()]);
                first += found.len();
                // Rounding of the values over the step: 1e-12 of the tensions, of lengths and of the stiffness.
                let value = sizes[k].iter().fold(0.0_f64, |size, value| size.max(value.abs())).max(1.0);
                let allowed = 1e-9 * size + 3e-11 * value / step;
                prop_assert!(error <= allowed, "{what}, {k}: {error:e} of {size:e}, {found:?} {differences:?}");
                compared += 1;
            }
        }
        prop_assert!(compared > 30, "{compared}");
    }
}

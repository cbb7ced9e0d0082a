//! Gradients of robots with pulleys and winches against differences of the program itself, for random robots.

use super::{distance, lengths_of};
use funicular::cable::CableModel;
use funicular::cable::catenary_dynamic::DriveSignal;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::gradient::{Gradients, Hold};
use funicular::math::Vec3;
use funicular::modes::{self, Mode};
use funicular::response::{self, Port, Quantity, Signal};
use funicular::robot::{
    CableChange, Control, Damping, DrumSide, GuideWheel, GuideWheelChange, Pulley, Robot, RobotChange, Servo,
    StretchLoss, Winch, WinchMode, Wind,
};
use funicular::statics::{self, Equilibrium, StaticModel};
use proptest::prelude::*;

/// Numbers of a random robot with drives.
#[derive(Debug, Clone)]
pub(super) struct DriveNumbers {
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

pub(super) fn chosen() -> impl Strategy<Value = DriveNumbers> {
    let incline = prop_oneof![Just([0.0, 0.0]), [-0.5..0.5_f64, -0.5..0.5]];
    let wind = prop_oneof![Just([0.0; 3]), [-15.0..15.0_f64, -15.0..15.0, -3.0..3.0]];
    let drive = (0.02..0.12_f64, incline, 0.0..4.0_f64, 4.3..6.5_f64, 4.0..6.5_f64);
    (drive, wind, any::<bool>(), -0.002..0.004_f64).prop_map(
        |((radius, incline, drum_side, stiffness, gain), wind, mixed, longer)| {
            let (stiffness, gain) = (10_f64.powf(stiffness), 10_f64.powf(gain));
            DriveNumbers { radius, incline, drum_side, stiffness, gain, wind, mixed, longer }
        },
    )
}

/// Robot with the chosen drives, at rest with lengths that are given.
pub(super) fn robot_of(chosen: &DriveNumbers) -> Option<(Robot, Equilibrium)> {
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
        cable.material.stretch_loss = StretchLoss { factor: 0.03 * (i % 2) as f64, time: 4e-4 * (i % 3) as f64 };
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
    of_cables("loss", &|_, _, x, cable| (cable.loss_factor, cable.damping_time) = (0.01 * x, 1e-4 * x));
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

/// Central differences at a step, at a half and at a quarter of it, extrapolated twice; and how much the last one adds
/// to each.
pub(super) fn extrapolated(step: f64, mut at: impl FnMut(f64) -> Option<Vec<f64>>) -> Option<(Vec<f64>, Vec<f64>)> {
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
    let added = best.iter().zip(&second).map(|(best, second)| (best - second).abs()).collect();
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
    #![proptest_config(ProptestConfig { cases: 5, failure_persistence: None, ..Default::default() })]

    /// Pose, tensions and stiffness with lengths held. The forward solver finds an equilibrium to 1e-12 of the forces,
    /// over steps that change them by a hundredth or so; the differences extrapolate two orders of the step.
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

        let (step, groups) = (0.1, values(&robot, &rest, &rest));
        // Rounding of the values: 1e-11 of the largest of their group.
        let noise: Vec<f64> = groups.iter().flat_map(|group| {
            let largest = group.iter().fold(1.0, |size: f64, value| size.max(value.abs()));
            vec![1e-11 * largest / (0.125 * step); group.len()]
        }).collect();
        let mut compared = 0;
        for (what, change) in changes(&robot) {
            let found = differences_within_resonance(step, &noise, 1, |h| {
                let (robot, at) = changed(&robot, &rest, &change, h)?;
                Some(values(&robot, &at, &rest).concat())
            });
            let Some((differences, bound)) = found else { continue };
            let mut first = 0;
            for (k, rows) in ours.iter().enumerate() {
                let found: Vec<f64> = rows.iter().map(|row| row.iter().map(|of| of.dot(&change)).sum()).collect();
                let places = first..first + found.len();
                first = places.end;
                // Beside a slack cable or another equilibrium every step is too long.
                let of_group = bound[places.clone()].iter().fold(0.0, |most: f64, bound| most.max(*bound));
                if of_group.is_infinite() {
                    continue;
                }
                let (error, size) = distance(&found, &differences[places]);
                let allowed = 1e-9 * size + of_group;
                prop_assert!(error <= allowed, "{what}, {k}: {error:e} of {size:e}, {found:?} {differences:?}");
                compared += 1;
            }
        }
        prop_assert!(compared > 30, "{compared}");
    }
}

/// Inertias, losses and controls of a random robot, and the mode of its winches.
#[derive(Debug, Clone)]
pub(super) struct Moving {
    wheel: f64,
    swivel: f64,
    drum: f64,
    motor: f64,
    damping: f64,
    speed_gain: f64,
    delay: f64,
    rod: bool,
    guides: usize,
    ratio: f64,
    pub(super) winches: WinchMode,
}

pub(super) fn moving() -> impl Strategy<Value = Moving> {
    let masses = (0.0..0.5_f64, 0.0..2e-3_f64, 0.1..2.0_f64, 0.5..8.0_f64);
    let losses = (1.0..40.0_f64, 10.0..200.0_f64, prop_oneof![Just(0.0), Just(0.003)]);
    let winches = prop_oneof![
        3 => Just(WinchMode::AsGiven), 1 => Just(WinchMode::Clamped), 1 => Just(WinchMode::Torque),
        1 => Just(WinchMode::Stuck)
    ];
    (masses, losses, any::<bool>(), 0..3_usize, 1e-3..0.02_f64, winches).prop_map(
        |((wheel, swivel, drum, motor), (damping, speed_gain, delay), rod, guides, ratio, winches)| Moving {
            wheel,
            swivel,
            drum,
            motor,
            damping,
            speed_gain,
            delay,
            rod,
            guides,
            ratio,
            winches,
        },
    )
}

/// Gives the drives of a robot their inertias and losses; at rest nothing changes.
pub(super) fn set_moving(robot: &mut Robot, moving: &Moving) {
    for (i, cable) in robot.cables.iter_mut().enumerate() {
        cable.material.damping = Damping::Ratio(moving.ratio);
        if let Some(pulley) = &mut cable.anchor.pulley {
            pulley.inertia = moving.wheel * pulley.radius * pulley.radius;
            pulley.swivel_inertia = moving.swivel;
        }
        let Some(winch) = &mut cable.anchor.winch else { continue };
        winch.drum_mass = moving.drum * (1.0 + 0.1 * i as f64);
        winch.motor_mass = moving.motor;
        winch.damping = moving.damping;
        winch.drum_side = if moving.rod { DrumSide::Rod } else { DrumSide::Massless };
        if let Control::Position(servo) = &mut winch.control {
            (servo.speed_gain, servo.delay) = (moving.speed_gain, moving.delay);
        }
        let length = winch.drum_side_length;
        if length > 0.1 {
            let wheel = |k: usize| GuideWheel {
                name: format!("{k}"),
                distance: length * (k + 1) as f64 / (moving.guides + 1) as f64 * (1.0 - 0.03 * i as f64),
                mass: 0.2 + 0.1 * k as f64,
            };
            winch.guide_wheels = (0..moving.guides).map(wheel).collect();
        }
    }
}

/// Changes of the numbers that only count in vibration.
pub(super) fn changes_of_moving(robot: &Robot) -> Vec<(&'static str, RobotChange)> {
    let none = || RobotChange::none(robot.cables.len());
    let mut all = Vec::new();
    let mut of_cables = |name, set: &dyn Fn(f64, &Robot, usize, &mut CableChange)| {
        let mut change = none();
        for (i, cable) in change.cables.iter_mut().enumerate() {
            set((2.1 * i as f64 + 0.7).sin(), robot, i, cable);
        }
        all.push((name, change));
    };
    of_cables("wheel", &|x, robot, i, cable| {
        cable.pulley.inertia = robot.cables[i].anchor.pulley.as_ref().map_or(0.0, |of| 0.2 * x * of.inertia);
    });
    of_cables("swivel", &|x, robot, i, cable| {
        cable.pulley.swivel_inertia =
            robot.cables[i].anchor.pulley.as_ref().map_or(0.0, |of| 0.2 * x * of.swivel_inertia);
    });
    of_cables("drum", &|x, _, _, cable| cable.winch.drum_mass = 0.03 * x);
    of_cables("motor", &|x, _, _, cable| cable.winch.motor_mass = 0.1 * x);
    of_cables("motor's damping", &|x, _, _, cable| cable.winch.damping = 0.3 * x);
    of_cables("speed gain", &|x, _, _, cable| cable.winch.speed_gain = 1.0 * x);
    of_cables("delay", &|x, _, _, cable| cable.winch.delay = 1e-4 * x);
    of_cables("guides", &|x, robot, i, cable| {
        let count = robot.cables[i].anchor.winch.as_ref().map_or(0, |winch| winch.guide_wheels.len());
        cable.guide_wheels = vec![GuideWheelChange { distance: 0.01 * x, mass: 0.02 }; count];
    });
    of_cables("damping", &|x, _, _, cable| cable.damping = 1e-4 * x);
    all
}

/// Frequency limit of the lists [Hz].
const BELOW_HZ: f64 = 4.0;

fn linearised(robot: &Robot, rest: &Equilibrium, winches: WinchMode, cable_model: CableModel) -> Option<Dynamics> {
    let linearisation = Linearisation { winches, cable_model, ..Linearisation::default() };
    Dynamics::about(robot, rest, linearisation, BELOW_HZ).ok()
}

/// True if the error of a derivative is that of the differences: 1e-8 of the largest derivative of the row, and the
/// `bound` of the differences: what the extrapolation adds, and noise of the value over the step. The noise is what
/// forward statics leaves: responses of light cables in wind scatter by 6e-10, and differences by this over their step,
/// while the gradient stays the same.
fn agrees(ours: f64, (difference, bound): (f64, f64), largest: f64) -> bool {
    (ours - difference).abs() <= 1e-8 * largest + bound
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 5, failure_persistence: None, ..Default::default() })]

    /// Natural frequencies of robots with drives, of every mode that is alone, in all modes of the winches. They have
    /// eleven digits; the steps change them by 1e-6 to 1e-3.
    #[test]
    fn frequencies_with_drives_follow_every_number(
        chosen in chosen(),
        moving in moving(),
        model in prop_oneof![
            4 => Just(CableModel::CatenaryDynamic), 1 => Just(CableModel::CatenaryStatic), 1 => Just(CableModel::Spring)
        ],
        first in 0..6_usize,
    ) {
        let Some((mut robot, rest)) = robot_of(&chosen) else { return Err(TestCaseError::reject("no such rest")) };
        set_moving(&mut robot, &moving);
        let Some(dynamics) = linearised(&robot, &rest, moving.winches, model) else {
            return Err(TestCaseError::reject("the cable runs out"))
        };
        let modes = modes::below(&dynamics, BELOW_HZ).modes;
        let gradients = Gradients::new(&robot, &rest, Hold::Lengths).unwrap();
        let vibration = gradients.vibration(&dynamics).unwrap();
        let alone = |k: usize| {
            let is_far = |other: &Mode| (other.frequency_hz / modes[k].frequency_hz - 1.0).abs() > 0.01;
            let gap = |other: Option<&Mode>| other.is_none_or(is_far);
            gap(modes.get(k + 1)) && gap(k.checked_sub(1).and_then(|k| modes.get(k)))
        };
        let chosen: Vec<usize> = (0..modes.len().saturating_sub(1)).filter(|k| alone(*k)).collect();
        let rows: Vec<RobotChange> = chosen.iter().map(|k| vibration.frequency(&modes[*k]).unwrap()).collect();
        let values = |robot: &Robot, rest: &Equilibrium| -> Option<Vec<f64>> {
            let found = modes::below(&linearised(robot, rest, moving.winches, model)?, BELOW_HZ).modes;
            (found.len() > *chosen.last()?).then(|| chosen.iter().map(|k| found[*k].frequency_hz).collect())
        };
        if chosen.is_empty() {
            return Err(TestCaseError::reject("no mode is alone"));
        }
        let mut all = changes(&robot);
        all.extend(changes_of_moving(&robot));
        let ours = |d: usize| rows.iter().map(|row| row.dot(&all[d].1)).collect();
        compare(&robot, &rest, &all, (first, 6), &ours, (3e-11, 1), &values)?;
    }
}

/// Signals on the platform.
fn signals() -> ([Signal; 2], [(Signal, Quantity); 2]) {
    let along = |direction_w, point_p| Signal::Along { direction_w, point_p };
    let first = along(Vec3::new(0.2, 0.1, 1.0), Vec3::new(0.1, 0.05, 0.02));
    let second = Signal::About { axis_w: Vec3::new(0.0, 1.0, 0.2) };
    let out = along(Vec3::new(1.0, -0.2, 0.3), Vec3::new(-0.1, 0.0, 0.1));
    ([first, second], [(out, Quantity::Acceleration), (first, Quantity::Displacement)])
}

/// Steps, over that of the differences, whose second differences are the noise of the values: nothing is curved there.
const SCATTER: [f64; 2] = [1e-9, 2e-9];

/// Maximum number of halvings of a step of differences.
const MAX_HALVINGS: i32 = 8;

/// Sum of the magnitudes of the weights with which an extrapolated difference takes the noise of its values over the
/// last step: 64/45 of the last central difference, 20/45 and 1/45 of the two before, whose steps are twice and four
/// times as long. Values whose noise has these signs exist: it is the same computation that scatters by its last
/// iteration.
const WEIGHTS: f64 = (64.0 + 20.0 / 2.0 + 1.0 / 4.0) / 45.0;

/// Central differences at steps that are halved, extrapolated twice, and a bound of their error from the `noise` of
/// the values. The bound is infinite where no step is short enough.
///
/// A response has complex poles at its resonances, a frequency has branch points where it comes near another. The
/// central differences beside one at the distance ρ are those of `1/(1 − x)`, `x = (h/ρ)²`, at a step h. What the last
/// extrapolation adds is x²/64, what the one before adds is x/16, and the error is x³/64: it falls to a 64th with each
/// halving. With x < 1/2 the change of the extrapolated value from one halving to the next therefore bounds the error
/// of the finer one. Both steps are needed: beside a far pole with a large part, a near one with a small part is not
/// seen in the additions at one step. For a response x is complex: real and imaginary part alone can be small by
/// chance, so that each number is judged by its size over its `parts`, two for a complex number.
fn differences_within_resonance(
    step: f64,
    noise: &[f64],
    parts: usize,
    mut at: impl FnMut(f64) -> Option<Vec<f64>>,
) -> Option<(Vec<f64>, Vec<f64>)> {
    /// Maximum x of a step.
    const SHORT: f64 = 0.5;

    let count = noise.len();
    let (mut best, mut bound) = (vec![0.0; count], vec![f64::INFINITY; count]);
    let [mut central, mut first, mut second]: [Vec<Vec<f64>>; 3] = Default::default();
    for halvings in 0..=MAX_HALVINGS {
        let h = step * 0.5_f64.powi(halvings);
        let (low, high) = (at(-h)?, at(h)?);
        central.push(low.iter().zip(&high).map(|(low, high)| (high - low) / (2.0 * h)).collect());
        let last_two = |of: &[Vec<f64>]| of.len().checked_sub(2).map(|k| (of[k].clone(), of[k + 1].clone()));
        let Some((coarse, fine)) = last_two(&central) else { continue };
        first.push((0..count).map(|i| fine[i] + (fine[i] - coarse[i]) / 3.0).collect());
        let Some((coarser, finer)) = last_two(&first) else { continue };
        second.push((0..count).map(|i| finer[i] + (finer[i] - coarser[i]) / 15.0).collect());
        let Some((before, now)) = last_two(&second) else { continue };

        for i in (0..count).filter(|i| bound[*i].is_infinite()).collect::<Vec<_>>() {
            let number = i - i % parts..i - i % parts + parts;
            let change =
                |from: &[f64], to: &[f64]| number.clone().map(|i| (to[i] - from[i]).powi(2)).sum::<f64>().sqrt();
            let (added, added_before) = (change(&finer, &now), change(&fine, &finer));
            let noise_here = WEIGHTS * noise[i] / h;
            if 4.0 * added <= SHORT * added_before || added_before <= noise_here {
                (best[i], bound[i]) = (now[i], change(&before, &now) + noise_here);
            }
        }
        if bound.iter().all(|bound| bound.is_finite()) {
            break;
        }
    }
    Some((best, bound))
}

/// Noise of each value: these digits of its size, or half of the second difference at steps too short for curvature,
/// which shows where the iterations of forward statics end. Most robots have less than 1e-9, one with motors under
/// constant torque and a light drum side 9e-8.
fn noise(
    here: &[f64],
    digits: f64,
    at: &dyn Fn(f64) -> Option<Vec<f64>>,
    step: f64,
    size_of_number: &dyn Fn(&[f64], usize) -> f64,
) -> Vec<f64> {
    let pairs: Vec<_> = SCATTER.iter().filter_map(|part| Some((at(-part * step)?, at(part * step)?))).collect();
    let scatter = |(low, high): &(Vec<f64>, Vec<f64>), i: usize| {
        let halves: Vec<f64> = (0..here.len()).map(|i| 0.5 * (low[i] + high[i]) - here[i]).collect();
        size_of_number(&halves, i)
    };
    let of_value =
        |i: usize| pairs.iter().map(|pair| scatter(pair, i)).fold(digits * size_of_number(here, i), f64::max);
    (0..here.len()).map(of_value).collect()
}

/// Compares the derivatives of `values` along changes with differences: every `count`-th change from the number `first`
/// on.
fn compare(
    robot: &Robot,
    rest: &Equilibrium,
    all: &[(&'static str, RobotChange)],
    (first, count): (usize, usize),
    ours: &dyn Fn(usize) -> Vec<f64>,
    (digits, parts): (f64, usize),
    values: &dyn Fn(&Robot, &Equilibrium) -> Option<Vec<f64>>,
) -> Result<(), TestCaseError> {
    let step = 0.02;
    let here = values(robot, rest).unwrap();
    // Noise and the largest derivative are those of the complex number: its real part alone can be small by chance.
    let size_of_number =
        |values: &[f64], i: usize| values[i - i % parts..][..parts].iter().map(|part| part.powi(2)).sum::<f64>().sqrt();
    let rows: Vec<Vec<f64>> = (0..all.len()).map(ours).collect();
    let (mut compared, mut passed_over) = (0, 0);
    for (d, (what, change)) in all.iter().enumerate().skip(first).step_by(count) {
        let at = |h: f64| {
            let (robot, at) = changed(robot, rest, change, h)?;
            values(&robot, &at)
        };
        let noise = noise(&here, digits, &at, step, &size_of_number);
        let found = differences_within_resonance(step, &noise, parts, at);
        let Some((differences, bound)) = found else { continue };
        for (i, difference) in differences.iter().enumerate() {
            if bound[i].is_infinite() {
                passed_over += 1;
                continue;
            }
            compared += 1;
            let largest = rows.iter().fold(0.0, |most: f64, row| most.max(size_of_number(row, i)));
            prop_assert!(
                agrees(rows[d][i], (*difference, bound[i]), largest),
                "{what}, value {i} {}: {} {difference}, largest {largest}, bound {}",
                here[i],
                rows[d][i],
                bound[i]
            );
        }
    }
    prop_assert!(passed_over <= compared / 10, "{passed_over} of {}", compared + passed_over);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3, failure_persistence: None, ..Default::default() })]

    /// Damped frequencies and damping ratios of robots whose drives have losses. Zeros have ten digits or more.
    #[test]
    fn damped_modes_with_drives_follow_every_number(chosen in chosen(), moving in moving(), first in 0..13_usize) {
        const LIMIT_HZ: f64 = 1.3;
        let Some((mut robot, rest)) = robot_of(&chosen) else { return Err(TestCaseError::reject("no such rest")) };
        set_moving(&mut robot, &moving);
        let linearised = |robot: &Robot, rest: &Equilibrium| {
            let linearisation = Linearisation { winches: moving.winches, ..Linearisation::default() };
            Dynamics::about(robot, rest, linearisation, LIMIT_HZ).ok()
        };
        let Some(dynamics) = linearised(&robot, &rest) else { return Err(TestCaseError::reject("the cable runs out")) };
        let gradients = Gradients::new(&robot, &rest, Hold::Lengths).unwrap();
        let vibration = gradients.vibration(&dynamics).unwrap();
        let damped = |dynamics: &Dynamics| {
            let found = modes::damped::damped_modes(dynamics, &modes::below(dynamics, LIMIT_HZ));
            found.certified.then_some(found.modes)
        };
        let Some(found) = damped(&dynamics) else { return Err(TestCaseError::reject("no certified list")) };
        let alone = |k: usize| {
            let distance = |other: usize| (found[other].omega - found[k].omega).norm() / found[k].omega.norm();
            (0..found.len()).filter(|other| *other != k).all(|other| distance(other) > 3e-3)
        };
        let oscillates = |k: &usize| found[*k].omega.re > 0.1 * found[*k].omega.norm();
        let picked: Vec<usize> = (0..found.len()).filter(|k| alone(*k)).filter(oscillates).take(6).collect();
        let mut rows = Vec::new();
        for k in &picked {
            let of = vibration.damped(&found[*k]).unwrap();
            rows.extend([of.frequency_hz, of.damping_ratio]);
        }

        // The mode of a changed robot is the nearest.
        let values = |robot: &Robot, rest: &Equilibrium| -> Option<Vec<f64>> {
            let list = damped(&linearised(robot, rest)?)?;
            let mut values = Vec::new();
            for k in &picked {
                let distance = |mode: &modes::damped::DampedMode| (mode.omega - found[*k].omega).norm();
                let mode = list.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
                values.extend([mode.frequency_hz(), mode.damping_ratio()]);
            }
            Some(values)
        };
        let mut all = changes(&robot);
        all.extend(changes_of_moving(&robot));
        let ours = |d: usize| rows.iter().map(|row| row.dot(&all[d].1)).collect();
        compare(&robot, &rest, &all, (first, 13), &ours, (3e-10, 1), &values)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 5, failure_persistence: None, ..Default::default() })]

    /// Responses between signals on the platform and of a drive: commanded length, force of the motor, motion of the
    /// drum.
    #[test]
    fn responses_with_drives_follow_every_number(chosen in chosen(), moving in moving(), first in 0..5_usize) {
        let Some((mut robot, rest)) = robot_of(&chosen) else { return Err(TestCaseError::reject("no such rest")) };
        set_moving(&mut robot, &moving);
        let linearised = |robot: &Robot, rest: &Equilibrium| {
            linearised(robot, rest, moving.winches, CableModel::CatenaryDynamic)
        };
        let Some(dynamics) = linearised(&robot, &rest) else { return Err(TestCaseError::reject("the cable runs out")) };
        let gradients = Gradients::new(&robot, &rest, Hold::Lengths).unwrap();
        let vibration = gradients.vibration(&dynamics).unwrap();

        // Signals on the platform, and those of the first drive that exist.
        let (inputs, outputs) = signals();
        let (mut inputs, mut outputs) = (inputs.to_vec(), outputs.to_vec());
        for signal in [DriveSignal::Length, DriveSignal::Motor, DriveSignal::Drum] {
            let of_drive = Signal::Drive { cable: 0, signal };
            let exists = Port::all(&robot, &rest, &dynamics, &[of_drive], false).is_ok();
            let is_known = vibration.responses(&[of_drive], &[outputs[0]], &[1.0], &[]).is_ok();
            // A cable that a rigid drum holds at the exit point has a commanded length, but no gradient of it.
            prop_assert!(exists || !is_known);
            if is_known {
                inputs.push(of_drive);
                if signal.is_output() {
                    outputs.push((of_drive, Quantity::Displacement));
                }
            }
        }
        let frequencies_hz = [0.6, 1.3, 2.71];
        let values = |robot: &Robot, rest: &Equilibrium| -> Option<Vec<f64>> {
            let dynamics = linearised(robot, rest)?;
            let from = Port::all(robot, rest, &dynamics, &inputs, false).ok()?;
            let measured: Vec<Signal> = outputs.iter().map(|(signal, _)| *signal).collect();
            let to = Port::all(robot, rest, &dynamics, &measured, false).ok()?;
            let to: Vec<_> = to.into_iter().zip(outputs.iter().map(|(_, quantity)| *quantity)).collect();
            let rows = response::matrix(&dynamics, &frequencies_hz, &from, &to).ok()?;
            Some(rows.iter().flatten().flat_map(|z| [z.re, z.im]).collect())
        };

        let mut all = changes(&robot);
        all.extend(changes_of_moving(&robot));
        let directions: Vec<RobotChange> = all.iter().map(|(_, change)| change.clone()).collect();
        let found = vibration.responses(&inputs, &outputs, &frequencies_hz, &directions).unwrap();
        let here: Vec<f64> = found.iter().flatten().flat_map(|at| [at.value.re, at.value.im]).collect();
        for (ours, expected) in here.chunks(2).zip(values(&robot, &rest).unwrap().chunks(2)) {
            let (error, size) = distance(ours, expected);
            prop_assert!(error <= 1e-9 * size, "{ours:?} {expected:?}");
        }
        let ours = |d: usize| found.iter().flatten().flat_map(|at| [at.along[d].re, at.along[d].im]).collect();
        compare(&robot, &rest, &all, (first, 5), &ours, (1e-9, 2), &values)?;
    }
}

//! Gradients of symmetric robots with equal pulleys and winches: modes that share a frequency, and modes with the
//! platform at rest at the poles of their cables, against differences.

use super::{drives, lengths_of};
use crate::random::Draw;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::gradient::{Gradients, Hold};
use funicular::math::{DMat, Vec3};
use funicular::modes::{self, Mode};
use funicular::robot::{
    Control, Damping, DrumSide, GuideWheel, Pose, Pulley, Robot, RobotChange, Servo, Winch, WinchMode,
};
use funicular::statics::{self, Equilibrium, StaticModel, TensionRule};
use std::collections::HashMap;
use std::f64::consts::TAU;
use std::fmt::Write as _;

/// Frequency limit of the lists [Hz].
const BELOW_HZ: f64 = 7.0;

/// Steps of differences, of which each frequency takes the largest one over which its modes stay far from
/// others and do not mix with them much.
const STEPS: [f64; 3] = [0.1, 0.02, 0.004];

/// Point mass on three to five cables, equal but for their turn about the vertical, with random drives.
fn symmetric_robot(number: u64) -> Option<(Robot, Equilibrium, WinchMode)> {
    let mut draw = Draw(77 + number);
    let count = 3 + (number % 3) as usize;
    let turned = |i: usize| TAU * i as f64 / count as f64;
    let mut text = "name = \"symmetric\"\n[platform]\nmotion = \"point-mass\"\nmass_kg = 10.0\n[materials.rope]\n\
                    axial_stiffness_n = 1e5\nmass_kg_per_m = 0.3\n"
        .to_owned();
    for i in 0..count {
        let (sine, cosine) = turned(i).sin_cos();
        let anchor = [2.0 * cosine, 2.0 * sine, 3.0];
        writeln!(text, "[[cables]]\nname = \"{i}\"\nmaterial = \"rope\"\nanchor_m = {anchor:?}").unwrap();
    }
    let mut robot = Robot::from_toml(&text).unwrap();

    // Axes that lean radially, and for every second robot tangentially, which couples the motions in plane and out of
    // plane.
    let tangential = if number % 2 == 1 { draw.between(-0.4, 0.4) } else { 0.0 };
    let (radius, radial) = (draw.between(0.03, 0.12), draw.between(-0.4, 0.4));
    let (side, guides) = (draw.between(0.2, 3.0), draw.between(0.0, 2.99) as usize);
    let servo = Servo { position_gain: draw.decades(4.5, 6.0), speed_gain: 40.0, integral: false, delay: 0.0 };
    let (drum_mass, motor_mass) = (draw.between(0.1, 1.0), draw.between(0.5, 6.0));
    let (stiffness, is_rod) = (draw.decades(4.5, 6.0), draw.between(0.0, 1.0) < 0.5);
    let (wheel, swivel) = (draw.between(0.0, 0.4), draw.between(0.0, 1e-3));
    for (i, cable) in robot.cables.iter_mut().enumerate() {
        cable.material.damping = Damping::Ratio(0.003);
        let (sine, cosine) = turned(i).sin_cos();
        let direction_w =
            Vec3::new(radial * cosine - tangential * sine, radial * sine + tangential * cosine, 1.0).normalize();
        let mut pulley = Pulley::new("wheel", radius, direction_w);
        (pulley.inertia, pulley.swivel_inertia) = (wheel * radius * radius, swivel);
        cable.anchor.pulley = Some(pulley);
        let mut winch = Winch::rigid("drum", side);
        (winch.stiffness, winch.control) = (stiffness, Control::Position(servo));
        (winch.drum_mass, winch.motor_mass) = (drum_mass, motor_mass);
        winch.drum_side = if is_rod { DrumSide::Rod } else { DrumSide::Massless };
        winch.guide_wheels = (0..guides)
            .map(|k| GuideWheel {
                name: format!("{k}"),
                distance: side * (k + 1) as f64 / (guides + 1) as f64,
                mass: 0.2,
            })
            .collect();
        cable.anchor.winch = Some(winch);
    }
    let modes = [WinchMode::AsGiven, WinchMode::Clamped, WinchMode::Torque, WinchMode::Stuck];
    let winches = modes[(number % 4) as usize];

    // Lengths that are equal to the last digit.
    let pose = Pose::new([0.0, 0.0, draw.between(0.5, 1.2)], [0.0; 3]);
    let held = statics::distribute_tensions(&robot, &pose, StaticModel::Catenary, &TensionRule::Lowest).ok()?;
    let mean = lengths_of(&held).iter().sum::<f64>() / count as f64;
    let rest = statics::forward(&robot, &vec![mean; count], StaticModel::Catenary, Some(&pose)).ok()?;
    Some((robot, rest, winches))
}

/// All modes below the limit, certified.
fn list(robot: &Robot, rest: &Equilibrium, winches: WinchMode) -> Option<(Dynamics, Vec<Mode>)> {
    let linearisation = Linearisation { winches, ..Linearisation::default() };
    let dynamics = Dynamics::about(robot, rest, linearisation, BELOW_HZ).ok()?;
    let found = modes::below(&dynamics, BELOW_HZ);
    found.certified.then_some((dynamics, found.modes))
}

/// Modes of each frequency that stands alone: first and number. Modes beside a gap of less than 2e-4 would mix within a
/// step.
fn groups(modes: &[Mode]) -> Vec<(usize, usize)> {
    let mut all = Vec::new();
    let mut next = 0;
    while next < modes.len() {
        let count = modes[next].multiplicity;
        let hz = modes[next].frequency_hz;
        let far = |k: Option<usize>| {
            let other = k.and_then(|k| modes.get(k));
            other.is_none_or(|other| (other.frequency_hz / hz - 1.0).abs() > 2e-4)
        };
        if far(next.checked_sub(1)) && far(Some(next + count)) && next + count < modes.len() {
            all.push((next, count));
        }
        next += count;
    }
    all
}

/// Along a change, the eigenvalues λ of the block of modes that share a frequency f are their one-sided derivatives.
/// Sums of powers of the parted frequencies are smooth in the size h of the change, `Σ (f_k − f)^m / h^m → Σ λ_k^m`,
/// and with all of them known the λ are known: so they are compared, m up to the number of modes, with extrapolated
/// differences. A single mode is the case of one, also with the platform at rest, where its frequency is a pole of the
/// cables' stiffness.
#[test]
fn modes_with_equal_drives_part_by_the_eigenvalues_of_their_blocks() {
    let (mut single, mut shared) = ([0; 2], [0; 2]);
    for number in 0..9 {
        let Some((robot, rest, winches)) = symmetric_robot(number) else { continue };
        let Some((dynamics, modes)) = list(&robot, &rest, winches) else { continue };
        let gradients = Gradients::new(&robot, &rest, Hold::Lengths).unwrap();
        let vibration = gradients.vibration(&dynamics).unwrap();

        let groups = groups(&modes);
        let blocks: Vec<_> = groups
            .iter()
            .map(|(first, count)| vibration.block(&modes[*first..first + count].iter().collect::<Vec<_>>()))
            .collect();
        let mut all = drives::changes(&robot);
        all.retain(|(what, _)| !["centre", "point", "attachment", "drag", "force"].contains(what));
        all.extend(drives::changes_of_moving(&robot));
        let matrix = |block: &Vec<Vec<RobotChange>>, change: &RobotChange| {
            DMat::from_fn(block.len(), block.len(), |i, j| block[i][j].dot(change))
        };

        for (what, change) in all.iter().skip((number % 8) as usize).step_by(8) {
            // Lists of the changed robot, by the size of the change.
            let mut lists: HashMap<u64, Option<Vec<f64>>> = HashMap::new();
            let mut frequencies = |h: f64| -> Option<Vec<f64>> {
                let found = || {
                    let (robot, at) = drives::changed(&robot, &rest, change, h)?;
                    let (_, found) = list(&robot, &at, winches)?;
                    Some(found.iter().map(|mode| mode.frequency_hz).collect())
                };
                lists.entry(h.to_bits()).or_insert_with(found).clone()
            };
            for ((first, count), block) in groups.iter().zip(&blocks) {
                let hz = modes[*first].frequency_hz;
                let matrix = matrix(block, change);
                assert!(
                    (&matrix - matrix.transpose()).amax() < 1e-9 * matrix.amax().max(1e-9 * hz),
                    "{number}, {what}"
                );
                // The largest slope of the group, by any change.
                let largest = all.iter().fold(0.0, |most: f64, (_, change)| {
                    block.iter().flatten().fold(most, |most, entry| most.max(entry.dot(change).abs()))
                });
                let slope = matrix.amax().max(1e-3 * largest);
                let gap = modes.iter().enumerate().filter(|(k, _)| !(*first..first + count).contains(k));
                let gap = gap.map(|(_, mode)| (mode.frequency_hz - hz).abs()).fold(hz, f64::min);
                let mut powers = |h: f64| {
                    let all = frequencies(h)?;
                    let parted = all.get(*first..first + count)?;
                    let sum = |m: i32| parted.iter().map(|of| (of - hz).powi(m)).sum::<f64>() / h.powi(m - 1);
                    Some((1_i32..).take(*count).map(sum).collect::<Vec<f64>>())
                };
                let smooth = STEPS.into_iter().filter(|step| step * slope < 0.05 * gap).find_map(|step| {
                    let (differences, added) = drives::extrapolated(step, &mut powers)?;
                    let is_smooth = (1_i32..).zip(&added).all(|(m, added)| *added < 1e-5 * slope.powi(m));
                    is_smooth.then_some((step, differences, added))
                });
                let Some((step, differences, added)) = smooth else { continue };
                let mut power = matrix.clone();
                for (m, (difference, added)) in (1_i32..).zip(differences.iter().zip(&added)) {
                    // Single frequencies have 1e-12, those that lie close to others 1e-10; over the step.
                    let digits = if *count == 1 { 3e-11 } else { 4e-10 };
                    let rounding = digits * hz / step * f64::from(m) * slope.powi(m - 1);
                    let allowed = 1e-8 * slope.powi(m) + added + rounding;
                    let ours = power.trace();
                    assert!(
                        (ours - difference).abs() <= allowed,
                        "{number}, {winches:?}, {what}, mode {first} of {count} at {hz} Hz, power {m}: {ours:e} \
                         {difference:e}, allowed {allowed:e}, added {added:e}, rounding {rounding:e}, step {step}"
                    );
                    power = &power * &matrix;
                }
                let at_rest = usize::from(modes[*first].shape.iter().all(|entry| entry.abs() <= 0.0));
                let counts = if *count == 1 { &mut single } else { &mut shared };
                counts[at_rest] += 1;
            }
        }
    }
    assert!(single.iter().chain(&shared).all(|count| *count > 15), "single {single:?} shared {shared:?}");
}

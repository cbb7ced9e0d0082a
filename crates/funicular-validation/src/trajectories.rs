//! Lengths, tensions and rates along a path.

use super::reference::{MovingRobot, MovingRow, TrajectoryReference, library_text};
use super::section::WRONG;
use super::{Bound, Case, ComparedQuantity, Comparison, Declared, DifferenceKind, Level, NegativeControl, reference};
use anyhow::Result;
use funicular::math::Vec6;
use funicular::path::{PathPoint, PlatformPath};
use funicular::robot::{Pose, Robot, TensionLimits};
use funicular::statics::{StaticModel, TensionRule};
use funicular::trajectory::{AlongPath, InMotion};
use std::f64::consts::TAU;

/// Maximum differences: of lengths [m], of tensions over the largest one, of rates [m/s], of powers over the largest
/// one. The reference prints 13 digits; its rates agree with differences to 1e-10 m/s.
const LENGTHS: f64 = 1e-9;
const TENSIONS: f64 = 1e-9;
const RATES: f64 = 1e-9;
const POWERS: f64 = 1e-8;

/// Number of rows of the table from which the jerk comes, and time before and after the path that it covers [s].
const ROWS: usize = 1601;
const BESIDE: f64 = 0.25;

/// Period of the path [s].
const PERIOD: f64 = 5.0;

pub(super) const SECTION: Declared = Declared {
    id: "trajectories",
    title: "Motion along a path, computed independently",
    note: "Largest differences over all cables and ten times of a closed path, with the inertia of the platform. \
           The rates contain the change of sag, stretch and tensions.",
    rows: || rows(&reference::trajectories()?),
    controls: &[
        NegativeControl {
            id: "acceleration",
            wrong: "accelerations 1 % too large",
            proves: "the inertia of the platform",
            rows: || of_changed(|row| row.acceleration = row.acceleration.map(|part| part * WRONG)),
        },
        NegativeControl {
            id: "twist",
            wrong: "velocities 1 % too large",
            proves: "the rates of the lengths",
            rows: || of_changed(|row| row.twist = row.twist.map(|part| part * WRONG)),
        },
    ],
};

fn rows(reference: &TrajectoryReference) -> Result<Vec<Comparison>> {
    let mut rows = Vec::new();
    for of in &reference.robots {
        let [minimum, maximum] = of.tension_limits_n.map(Some);
        let robot = Robot::from_toml(library_text(&of.robot)?)?.with_tension_limits(TensionLimits { minimum, maximum });
        let case = Case::new(Level::Program, &reference.source, &of.robot, &of.robot);
        rows.extend(along_path(&case, &robot, of)?);
    }
    Ok(rows)
}

/// Comparisons of the first robot with a change of all rows.
fn of_changed(change: fn(&mut MovingRow)) -> Result<Vec<Comparison>> {
    let mut reference = reference::trajectories()?;
    reference.robots.truncate(1);
    reference.robots.iter_mut().for_each(|of| of.rows.iter_mut().for_each(change));
    rows(&reference)
}

/// Position and angles of the path of the reference.
fn pose(of: &MovingRobot, t: f64) -> Pose {
    let u = TAU * t / PERIOD;
    let position = [1.5 * u.cos(), 1.2 * u.sin(), 1.6 + 0.15 * (2.0 * u).sin()].map(|x| of.scale * x);
    let angles = [3.0 * u.sin(), 2.0 * (2.0 * u).cos(), 5.0 * u.cos()].map(|x| of.scale * x);
    Pose::new([position[0], position[1], position[2] + of.lift_m], angles)
}

/// Tensions at the platform, then those at the anchors.
fn tensions(motion: &InMotion) -> Vec<f64> {
    let cables = &motion.equilibrium.cables;
    cables.iter().map(|cable| cable.tension_platform).chain(cables.iter().map(|cable| cable.tension_anchor)).collect()
}

/// Powers at the anchors: tension times the rate of the stretched rope.
fn powers(robot: &Robot, motion: &InMotion) -> Vec<f64> {
    let each = motion.equilibrium.cables.iter().zip(&robot.cables).zip(&motion.length_rates);
    each.map(|((state, cable), rate)| {
        let stretched = 1.0 + state.tension_anchor / cable.material.axial_stiffness;
        -state.tension_anchor * rate * stretched
    })
    .collect()
}

fn along_path(case: &Case, robot: &Robot, of: &MovingRobot) -> Result<[Comparison; 4]> {
    let step = (PERIOD + 2.0 * BESIDE) / (ROWS - 1) as f64;
    let times: Vec<f64> = (0..ROWS).map(|k| k as f64 * step - BESIDE).collect();
    let poses: Vec<Pose> = times.iter().map(|t| pose(of, *t)).collect();
    let path = PlatformPath::of_table(&times, &poses)?;

    let mut along = AlongPath::new(robot, StaticModel::Catenary, TensionRule::Lowest, false);
    let mut found: Vec<(&MovingRow, InMotion)> = Vec::new();
    for row in &of.rows {
        let [x, y, z, roll, pitch, yaw] = row.pose;
        let point = PathPoint {
            pose: Pose::new([x, y, z], [roll, pitch, yaw]),
            velocity_w: Vec6::from(row.twist),
            acceleration_w: Vec6::from(row.acceleration),
            // The reference does not give it.
            jerk_w: path.at(row.t_s + BESIDE).jerk_w,
        };
        found.push((row, along.at(&point)?));
    }

    let compared = |quantity: ComparedQuantity,
                    theirs: fn(&MovingRow) -> Vec<f64>,
                    ours: &dyn Fn(&InMotion) -> Vec<f64>,
                    (limit, kind)| {
        let pairs = found.iter().flat_map(|(row, motion)| theirs(row).into_iter().zip(ours(motion)));
        let pairs: Vec<(f64, f64)> = pairs.collect();
        let size = match kind {
            DifferenceKind::Absolute => 1.0,
            DifferenceKind::Relative => pairs.iter().fold(0.0, |most: f64, (their, _)| most.max(their.abs())),
        };
        let worst = super::worst(pairs.iter().map(|(their, our)| (our - their).abs() / size));
        let (their, our) = pairs[0];
        let quantity = quantity.numbers(pairs.len());
        quantity.row((&[their], &[our]), (worst, kind), limit, Bound::Digits("digits of the reference"))
    };
    Ok([
        compared(
            case.of("lengths", "unstrained lengths; the first is shown [m]"),
            |row| row.lengths_m.clone(),
            &|motion| motion.equilibrium.cables.iter().map(|cable| cable.unstrained_length).collect(),
            (LENGTHS, DifferenceKind::Absolute),
        ),
        compared(
            case.of("tensions", "tensions at both ends over the largest; the first is shown [N]"),
            |row| [row.tensions_platform_n.clone(), row.tensions_anchor_n.clone()].concat(),
            &tensions,
            (TENSIONS, DifferenceKind::Relative),
        ),
        compared(
            case.of("rates", "rates of the lengths; the first is shown [m/s]"),
            |row| row.rates_m_s.clone(),
            &|motion| motion.length_rates.clone(),
            (RATES, DifferenceKind::Absolute),
        ),
        compared(
            case.of("powers", "powers at the anchors over the largest; the first is shown [W]"),
            |row| row.powers_w.clone(),
            &|motion| powers(robot, motion),
            (POWERS, DifferenceKind::Relative),
        ),
    ])
}

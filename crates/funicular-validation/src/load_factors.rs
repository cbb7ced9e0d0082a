//! Load factors of required boxes of loads, and wrench closure.

use super::reference::{LoadFactorReference, LoadedPose, LoadedRobot, library_text};
use super::section::WRONG;
use super::{Bound, Case, Comparison, Declared, DifferenceKind, Level, NegativeControl, reference, slug};
use anyhow::{Context, Result};
use funicular::math::Vec3;
use funicular::robot::{Pose, Robot, TensionLimits};
use funicular::statics::{self, LoadCapacity, StaticModel, WrenchClosure};

/// Maximum relative difference of load factors of straight cables: the reference prints 13 digits of numbers that two
/// algorithms gave alike to 3e-14.
const STRAIGHT: f64 = 1e-11;

/// Maximum relative difference of load factors of sagging cables: both programs end a search at a change of about 1e-8,
/// and where a cable is nearly slack, optima are flat.
const SAGGING: f64 = 1e-6;

/// Maximum difference of tension factors, numbers up to 1 that the reference prints with 13 digits.
const TENSION_FACTOR: f64 = 1e-10;

/// Cause that bounds all differences.
const ACCURACY: &str = "accuracy of the other program";

pub(super) const SECTION: Declared = Declared {
    id: "load-factors",
    title: "Load factors, computed independently",
    note: "Largest multiple of a box of forces and moments that the cables hold in addition to the weight of the \
           platform, at random poses; wrench closure and tension factor. The other program solves a problem per \
           vertex of the box; here facets and the vertices that they leave open.",
    rows: || rows(&reference::load_factors()?),
    controls: &[
        NegativeControl {
            id: "required",
            wrong: "required loads 1 % too large",
            proves: "the size of the required loads",
            rows: || of_changed(|of| of.required_box_n_nm = of.required_box_n_nm.map(|half| half * WRONG)),
        },
        NegativeControl {
            id: "maximum",
            wrong: "maximum tension 1 % too large",
            proves: "the limits of the tensions",
            rows: || of_changed(|of| of.tension_limits_n[1] *= WRONG),
        },
    ],
};

fn rows(reference: &LoadFactorReference) -> Result<Vec<Comparison>> {
    let mut rows = Vec::new();
    for of in &reference.robots {
        let (case, robot) = case_of(&reference.source, of)?;
        rows.extend(load_factors(&case, &robot, of)?);
        rows.extend(closures(&case, &robot, of));
    }
    Ok(rows)
}

/// Comparisons of all robots with a change.
fn of_changed(change: fn(&mut LoadedRobot)) -> Result<Vec<Comparison>> {
    let mut reference = reference::load_factors()?;
    for of in &mut reference.robots {
        of.rows.truncate(5);
        change(of);
    }
    rows(&reference)
}

/// Case with its robot.
fn case_of<'a>(source: &'a str, of: &LoadedRobot) -> Result<(Case<'a>, Robot)> {
    let [minimum, maximum] = of.tension_limits_n.map(Some);
    let mut robot = Robot::from_toml(library_text(&of.robot)?)?.with_tension_limits(TensionLimits { minimum, maximum });
    let [x, y, z, roll, pitch, yaw] = of.required_box_n_nm;
    robot.required.force_w = Vec3::new(x, y, z);
    robot.required.moment_w = Vec3::new(roll, pitch, yaw);
    for cable in &mut robot.cables {
        let rope = &mut cable.material;
        rope.mass_per_length = of.mass_kg_per_m.unwrap_or(rope.mass_per_length);
    }
    Ok((
        Case::new(
            Level::Program,
            source,
            &format!("{}/{}", slug(&of.id), of.static_model),
            &format!("{}, {} cables", of.id, of.static_model),
        ),
        robot,
    ))
}

fn pose_of(row: &LoadedPose) -> Pose {
    let [x, y, z, roll, pitch, yaw] = row.pose;
    Pose::new([x, y, z], [roll, pitch, yaw])
}

/// Load factors, and the verdicts on dead load and required loads.
fn load_factors(case: &Case, robot: &Robot, of: &LoadedRobot) -> Result<[Comparison; 2]> {
    let (model, tolerance) = match of.static_model.as_str() {
        "ideal" => (StaticModel::Ideal, STRAIGHT),
        _ => (StaticModel::Catenary, SAGGING),
    };
    let (mut pairs, mut other_verdicts) = (Vec::new(), 0);
    for row in &of.rows {
        let found = LoadCapacity::at(robot, &pose_of(row), model, None)?.load_factor_value().ok();
        pairs.extend(row.load_factor.zip(found));
        let verdict = |factor: Option<f64>| (factor.is_some(), factor.is_some_and(|of| of >= 1.0));
        other_verdicts += usize::from(verdict(row.load_factor) != verdict(found));
    }

    let difference = |(their, our): &(f64, f64)| (our - their).abs() / their.abs();
    let (their, our) =
        pairs.iter().copied().max_by(|a, b| difference(a).total_cmp(&difference(b))).context("no dead load is held")?;
    let compared = pairs.len();
    let quantity = "load factor with the largest difference";
    Ok([
        case.of("verdicts", "poses with another verdict").count(0, other_verdicts),
        case.of("load-factor", quantity).numbers(compared).relative(
            &[their],
            &[our],
            tolerance,
            Bound::Digits(ACCURACY),
        ),
    ])
}

/// Closure and tension factors of the poses for which they are known.
fn closures(case: &Case, robot: &Robot, of: &LoadedRobot) -> Vec<Comparison> {
    let listed = of.rows.iter().filter_map(|row| Some((row, row.tension_factor?, row.closure?)));
    let found: Vec<(f64, bool, WrenchClosure)> = listed
        .map(|(row, factor, is_closed)| (factor, is_closed, statics::wrench_closure(robot, &pose_of(row))))
        .collect();
    let Some((largest, _, ours)) = found.iter().max_by(|a, b| a.0.total_cmp(&b.0)) else { return Vec::new() };

    let other = found.iter().filter(|(_, is_closed, found)| *is_closed != found.is_closed()).count();
    let difference = super::worst(found.iter().map(|(factor, _, found)| (factor - found.tension_factor).abs()));
    let shown: (&[f64], &[f64]) = (&[*largest], &[ours.tension_factor]);
    let quantity = "tension factors; the largest is shown";
    let bound = Bound::Digits(ACCURACY);
    vec![
        case.of("closure", "poses with another closure").count(0, other),
        case.of("tension-factors", quantity).numbers(found.len()).row(
            shown,
            (difference, DifferenceKind::Absolute),
            TENSION_FACTOR,
            bound,
        ),
    ]
}

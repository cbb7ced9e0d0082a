//! Distances between cables, straight and sagging.

use super::reference::{DistanceReference, MeasuredPairs, PairsAtPose, library_text};
use super::section::WRONG;
use super::{Bound, Case, Comparison, Declared, DifferenceKind, Level, NegativeControl, reference, slug};
use anyhow::{Result, bail};
use funicular::clearance::{ClearancePair, Surroundings};
use funicular::robot::{Pose, RequiredClearance, Robot, State, TensionLimits};
use funicular::statics::{self, StaticModel};

/// Maximum difference of distances between straight cables [m]: the reference prints 13 digits.
const STRAIGHT: f64 = 1e-11;

/// Maximum difference of distances between sagging cables [m]: the other program ends its search at 2e-9 m.
const SAGGING: f64 = 3e-9;

pub(super) const SECTION: Declared = Declared {
    id: "distances",
    title: "Distances between cables, computed independently",
    note: "Least distance of the centre lines of every pair of cables at random poses, with tensions by the rule \
           `lowest`. The other program halves arcs until bounds from their chords meet.",
    rows: || rows(&reference::distances()?),
    controls: &[NegativeControl {
        id: "pose",
        wrong: "positions 1 % too far from the origin",
        proves: "the place of the cables",
        rows: || {
            let mut reference = reference::distances()?;
            for of in &mut reference.robots {
                of.rows.truncate(2);
                of.rows.iter_mut().for_each(|row| row.pose[..3].iter_mut().for_each(|x| *x *= WRONG));
            }
            rows(&reference)
        },
    }],
};

fn rows(reference: &DistanceReference) -> Result<Vec<Comparison>> {
    let mut rows = Vec::new();
    for of in &reference.robots {
        let [minimum, maximum] = of.tension_limits_n.map(Some);
        let mut robot =
            Robot::from_toml(library_text(&of.robot)?)?.with_tension_limits(TensionLimits { minimum, maximum });
        robot.clearance = Some(RequiredClearance { from_end: Some(0.0), ..RequiredClearance::default() });
        let case = Case::new(Level::Program, &reference.source, &slug(&of.id), &of.id);
        rows.extend(distances(&case, &robot, of)?);
    }
    Ok(rows)
}

/// Distances of straight and of sagging cables.
fn distances(case: &Case, robot: &Robot, of: &MeasuredPairs) -> Result<[Comparison; 2]> {
    let kinds = [
        (("straight", "distances of straight cables; the least is shown [m]"), StaticModel::Ideal, STRAIGHT),
        (("sagging", "distances of sagging cables; the least is shown [m]"), StaticModel::Catenary, SAGGING),
    ];
    let compared = kinds.map(|((id, quantity), model, tolerance)| {
        let mut pairs: Vec<(f64, f64)> = Vec::new();
        for row in &of.rows {
            pairs.extend(at_pose(robot, row, model)?);
        }
        let worst = super::worst(pairs.iter().map(|(their, our)| (our - their).abs()));
        let Some((their, our)) = pairs.iter().min_by(|a, b| a.0.total_cmp(&b.0)) else { bail!("no pairs") };
        let difference = (worst, DifferenceKind::Absolute);
        let quantity = case.of(id, quantity).numbers(pairs.len());
        Ok(quantity.row((&[*their], &[*our]), difference, tolerance, Bound::Digits("end of the other search")))
    });
    let [straight, sagging] = compared;
    Ok([straight?, sagging?])
}

/// Distances of a pose: those of the reference with those of the program.
fn at_pose(robot: &Robot, row: &PairsAtPose, model: StaticModel) -> Result<Vec<(f64, f64)>> {
    let [x, y, z, roll, pitch, yaw] = row.pose;
    let state = State::Pose(Pose::new([x, y, z], [roll, pitch, yaw]));
    let posed = Robot { state, ..robot.clone() };
    // The lengths of the sagging cables hold the straight ones, too: only their ends count.
    let rest = statics::solve(&posed, StaticModel::Catenary, None)?.equilibrium;
    let mut rest = rest;
    if model == StaticModel::Ideal {
        rest.cables.iter_mut().for_each(|cable| cable.hanging = None);
    }
    let radii: Vec<f64> = robot.cables.iter().map(funicular::robot::Cable::radius).collect();
    let found = Surroundings::of(&posed).clearances(&rest, None);
    let distance = |i: usize, j: usize| {
        let of_pair = found.iter().find(|found| found.pair == ClearancePair::Cables(i - 1, j - 1));
        of_pair.map_or(f64::NAN, |found| found.distance + radii[i - 1] + radii[j - 1])
    };
    let theirs = |straight: f64, sagging: f64| if model == StaticModel::Ideal { straight } else { sagging };
    Ok(row.pairs.iter().map(|(i, j, straight, sagging)| (theirs(*straight, *sagging), distance(*i, *j))).collect())
}

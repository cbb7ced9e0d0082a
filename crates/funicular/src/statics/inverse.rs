//! Pose to unstrained lengths and tensions; here as many cables as freedoms, in `tension` more.

mod starts;

use super::collect::collect;
use super::equilibrium::{Equilibrium, RESIDUAL_LIMIT};
use super::error::StaticsError;
use super::ideal::{self, pushing, straight_tensions};
use super::loaded_cable::{LONGEST, LoadedCable};
use super::model::StaticModel;
use super::residual::scaled_residual;
use crate::catenary::space::HangingCable;
use crate::math::{Mat6, Vec6};
use crate::platform::{Coordinates, StraightCable, balance, load_size, load_wrench, wrench_of};
use crate::robot::{Pose, Robot};

/// The unstrained lengths and tensions that hold the platform at a pose by as many cables as degrees of freedom.
///
/// Straight cables have a linear solution; sagging ones start from it, with half of each cable's weight on the
/// platform, and a Newton iteration on the lengths follows whose steps are taken in the tension parallel to the chord, in
/// which the forces of a taut cable are nearly linear, and in the length where a slack one gets slacker. Where that leads
/// nowhere, a damped iteration searches from other starts, deeply sagging ones among them.
///
/// # Errors
/// [`StaticsError`]: a singular pose, a straight cable that would have to push, no tensions found for sagging ones,
/// coinciding ends, or no convergence.
pub(super) fn determinate(robot: &Robot, pose: &Pose, model: StaticModel) -> Result<Equilibrium, StaticsError> {
    let cables = robot.cables.len();
    robot.platform.freedoms.check(pose)?;
    let mut load = load_wrench(robot, pose);
    let loaded = LoadedCable::all(robot, pose, model);
    for cable in &loaded {
        let StraightCable { lever_w, chord_w } = StraightCable::at(cable.cable, pose);
        let chord = chord_w.norm();
        load += wrench_of(&(cable.load.vector_w() * (0.5 * chord)), &lever_w);
    }
    let tensions = match straight_tensions(robot, pose, &load) {
        Err(StaticsError::Singular) if model == StaticModel::Catenary => return slack(robot, pose, &loaded),
        tensions => tensions?,
    };
    match model {
        StaticModel::Ideal => match pushing(&tensions) {
            Some((i, tension)) => Err(StaticsError::WouldPush { cable: robot.cables[i].name.clone(), tension }),
            None => Ok(ideal::collect(robot, *pose, &tensions, 0)),
        },
        StaticModel::Spring => {
            if let Some(i) = weakest(&tensions).filter(|&i| tensions[i] <= 0.0) {
                return Err(StaticsError::WouldPush { cable: robot.cables[i].name.clone(), tension: tensions[i] });
            }
            let lengths: Vec<f64> = (0..cables)
                .map(|i| {
                    let cable = &robot.cables[i];
                    let chord = cable.chord_w(pose).norm();
                    chord / (1.0 + tensions[i] / cable.material.axial_stiffness)
                })
                .collect();
            let hanging = hang_all(&loaded, pose, &lengths);
            Ok(collect(robot, *pose, model, hanging, &lengths, 0))
        }
        StaticModel::Catenary => sagging(robot, pose, &loaded, &tensions),
    }
}

/// A solution that needs this many times the tension of straight cables, one of which would push, counts as none. In
/// 15,000 such poses of the paper's robot the ratio runs from 1 through 2.5 (half of them) and 10 (all but 2 %) to 550
/// beside singular poses.
const OUT_OF_PROPORTION: f64 = 100.0;

fn weakest(tensions: &[f64]) -> Option<usize> {
    (0..tensions.len()).min_by(|&i, &j| tensions[i].total_cmp(&tensions[j]))
}

fn hang_all(loaded: &[LoadedCable<'_>], pose: &Pose, lengths: &[f64]) -> Vec<HangingCable> {
    loaded.iter().zip(lengths).map(|(cable, &length)| cable.hang(pose, length)).collect()
}

fn sagging(
    robot: &Robot,
    pose: &Pose,
    loaded: &[LoadedCable<'_>],
    straight: &[f64],
) -> Result<Equilibrium, StaticsError> {
    let start: Vec<HangingCable> = (loaded.iter().zip(straight))
        .map(|(cable, tension)| {
            let chord = cable.chord_w(pose).norm();
            // A cable that straight statics finds pushing starts as a deeply sagging one.
            let least = (0.25 * cable.load.size * chord).max(1e-9 * cable.axial_stiffness());
            cable.hang_with_tension(pose, tension.max(least))
        })
        .collect();
    let mut found = balanced(robot, pose, start.clone(), lengthened);
    if found.residual > RESIDUAL_LIMIT {
        // Each way now and then holds a pose by hundreds of metres of rope where the other does not.
        let before = found.iterations;
        found = balanced(robot, pose, start, tightened);
        found.iterations += before;
    }

    // Where a straight cable would push, sagging ones may still hold the pose, by their weight; or only by tensions out
    // of all proportion, which no one means.
    let pushing = weakest(straight).filter(|&i| straight[i] <= 0.0);
    let proportion = straight.iter().fold(0.0, |most: f64, t| most.max(t.abs()));
    let far_fetched = |found: &Balanced| pushing.is_some() && found.strongest() > OUT_OF_PROPORTION * proportion;
    let accept = |found: &Balanced| found.residual <= RESIDUAL_LIMIT && !far_fetched(found);
    let mut starts = 1;
    let searched = if accept(&found) {
        None
    } else if pushing.is_some() && is_out_of_reach(robot, pose, loaded, straight)? {
        starts = 0;
        None
    } else {
        starts::search(robot, pose, loaded, accept)
    };
    if let Some(searched) = searched {
        starts += searched.starts;
        let iterations = found.iterations + searched.best.iterations;
        if accept(&searched.best) || searched.best.residual < found.residual {
            found = searched.best;
        }
        found.iterations = iterations;
    }
    if accept(&found) {
        return Ok(found.collected(robot, pose));
    }

    if let Some(i) = pushing {
        let (cable, tension) = (robot.cables[i].name.clone(), straight[i]);
        // Without sag the straight solution is the only one.
        if loaded.iter().all(|cable| cable.load.size == 0.0) {
            return Err(StaticsError::WouldPush { cable, tension });
        }
        let residual = found.residual;
        let greatest = (residual <= RESIDUAL_LIMIT).then(|| found.strongest());
        return Err(StaticsError::NotFound { cable, tension, starts, residual, greatest });
    }
    let (p, Balanced { residual, iterations, .. }) = (pose.position_w, found);
    Err(StaticsError::NotConverged { iterations, residual, limit: RESIDUAL_LIMIT, x: p.x, y: p.y, z: p.z })
}

/// Whether the weight of sagging cables cannot make up for a straight cable that pushes, unless one of them is longer
/// than [`LONGEST`] times its chord: (39c) of docs/theory.md.
///
/// A sagging cable pulls as a straight one does, less at most its whole weight. So the straight tensions without the
/// cables' weights, changed by what the weights can do at most, have to be positive.
fn is_out_of_reach(
    robot: &Robot,
    pose: &Pose,
    loaded: &[LoadedCable<'_>],
    straight: &[f64],
) -> Result<bool, StaticsError> {
    let mut reach = straight.to_vec();
    let mut sizes: Vec<f64> = straight.iter().map(|tension| tension.abs()).collect();
    for cable in loaded {
        let StraightCable { lever_w, chord_w } = StraightCable::at(cable.cable, pose);
        let chord = chord_w.norm();
        let by_weight = straight_tensions(robot, pose, &wrench_of(&-cable.load.up_w, &lever_w))?;
        for ((reach, size), rate) in reach.iter_mut().zip(&mut sizes).zip(by_weight) {
            // The straight tensions have half of the weight of a cable as long as its chord.
            let change = (LONGEST * rate.max(0.0) - 0.5 * rate) * cable.load.size * chord;
            *reach += change;
            *size += change.abs();
        }
    }
    Ok(reach.iter().zip(sizes).any(|(reach, size)| *reach < -1e-9 * size))
}

/// Cables whose chords do not span the freedoms: sagging ones may, since they do not pull along their chords.
fn slack(robot: &Robot, pose: &Pose, loaded: &[LoadedCable<'_>]) -> Result<Equilibrium, StaticsError> {
    let limit = OUT_OF_PROPORTION * load_size(robot);
    let accept = |found: &Balanced| found.residual <= RESIDUAL_LIMIT && found.strongest() <= limit;
    match starts::search(robot, pose, loaded, accept) {
        Some(searched) if accept(&searched.best) => Ok(searched.best.collected(robot, pose)),
        _ => Err(StaticsError::Singular),
    }
}

struct Balanced {
    hanging: Vec<HangingCable>,
    residual: f64,
    iterations: usize,
}

impl Balanced {
    /// The greatest tension at the platform [N].
    fn strongest(&self) -> f64 {
        self.hanging.iter().fold(0.0, |most: f64, cable| most.max(cable.catenary.tension_at_start()))
    }

    fn collected(self, robot: &Robot, pose: &Pose) -> Equilibrium {
        let lengths: Vec<f64> = self.hanging.iter().map(|cable| cable.catenary.rope().unstrained_length).collect();
        collect(robot, *pose, StaticModel::Catenary, self.hanging, &lengths, self.iterations)
    }
}

/// Newton's method on the lengths, from a start; `step` makes the cable of a change of length.
fn balanced(
    robot: &Robot,
    pose: &Pose,
    mut hanging: Vec<HangingCable>,
    step: fn(&HangingCable, f64) -> HangingCable,
) -> Balanced {
    let coordinates = Coordinates::of(robot);
    let (mut wrench, mut residual) = unbalanced(robot, &coordinates, pose, &hanging);
    let mut iterations = 0;
    let mut damping = 1.0;
    while iterations < 100 && residual > 1e-14 {
        iterations += 1;
        let mut columns = Mat6::identity();
        for (i, cable) in hanging.iter().enumerate() {
            let lever_w = cable.start_w - pose.position_w;
            columns.set_column(i, &coordinates.reduce_force(&cable.force_by_length_w(), &lever_w));
        }
        let right = -coordinates.reduce(&wrench);
        let Some(change) = columns.lu().solve(&right) else { break };
        let next: Vec<HangingCable> =
            (hanging.iter().zip(&change)).map(|(cable, change)| step(cable, damping * change)).collect();
        let (next_wrench, next_residual) = unbalanced(robot, &coordinates, pose, &next);
        if next_residual < residual {
            (hanging, wrench, residual) = (next, next_wrench, next_residual);
            damping = (2.0 * damping).min(1.0);
        } else if residual < RESIDUAL_LIMIT {
            break;
        } else {
            damping *= 0.25;
            if damping < 1e-6 {
                break;
            }
        }
    }
    Balanced { hanging, residual, iterations }
}

/// Wrench that is left, and its scaled size.
fn unbalanced(robot: &Robot, coordinates: &Coordinates, pose: &Pose, hanging: &[HangingCable]) -> (Vec6, f64) {
    let forces = hanging.iter().map(|cable| (cable.force_on_start_w(), cable.start_w - pose.position_w));
    let (wrench, scale) = balance(robot, pose, forces);
    (wrench, scaled_residual(coordinates, &wrench, scale))
}

/// A cable some length longer [m], to first order: forces are nearly linear in the parallel tension where it is taut, but
/// in the length, by its weight, where it hangs slack and gets slacker.
fn lengthened(cable: &HangingCable, change: f64) -> HangingCable {
    let rope = cable.catenary.rope();
    let tension = cable.catenary.parallel_tension();
    if change > 0.0 && tension < 0.5 * rope.weight_per_length * cable.chord_w().norm() {
        return cable.at_length(rope.unstrained_length + change);
    }
    tightened(cable, change)
}

/// The same in the tension alone.
fn tightened(cable: &HangingCable, change: f64) -> HangingCable {
    let tension = cable.catenary.parallel_tension();
    let wanted = tension + change * cable.catenary.parallel_tension_by_length();
    at_tension(cable, wanted.max(0.2 * tension))
}

/// The cable between the same points whose parallel tension is `wanted` > 0 [N].
fn at_tension(cable: &HangingCable, wanted: f64) -> HangingCable {
    let rope = cable.catenary.rope();
    // Slacker cables need a search that knows no bound from the tension.
    if wanted >= 0.01 * rope.weight_per_length * cable.chord_w().norm() {
        return cable.at_parallel_tension(wanted);
    }
    let (mut low, mut high) = (0.0, f64::INFINITY);
    let mut cable = cable.clone();
    for _ in 0..80 {
        let length = cable.catenary.rope().unstrained_length;
        let tension = cable.catenary.parallel_tension();
        if tension > wanted {
            low = length;
        } else {
            high = length;
        }
        // Taut, τ grows like c − L; sagging, like 1/√(L − c): its logarithm is between both.
        let step = (tension / wanted).ln() * tension / cable.catenary.parallel_tension_by_length();
        let next = length - step;
        // Newton squares the error, and only a step on the way is wanted: what counts is the balance afterwards.
        let last = step.abs() <= 1e-9 * length;
        let next = if last || (next > low && next < high) {
            next
        } else if high.is_finite() {
            0.5 * (low + high)
        } else {
            2.0 * low
        };
        cable = cable.at_length(next);
        if last {
            break;
        }
    }
    cable
}

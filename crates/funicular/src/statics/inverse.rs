//! Pose to unstrained lengths and tensions; here as many cables as degrees of freedom, in `tension` more.

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
    robot.platform.motion.check(pose)?;

    // Straight cables, with half of each cable's load.
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
            Some((i, tension)) => Err(StaticsError::NegativeTension { cable: robot.cables[i].name.clone(), tension }),
            None => Ok(ideal::collect(robot, *pose, &tensions, 0)),
        },
        StaticModel::Spring => {
            if let Some(i) = weakest(&tensions).filter(|&i| tensions[i] <= 0.0) {
                return Err(StaticsError::NegativeTension {
                    cable: robot.cables[i].name.clone(),
                    tension: tensions[i],
                });
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

/// Least tension of a first guess: over the weight of a cable as long as its chord, and over its axial stiffness where it
/// has no weight. A cable that straight statics finds pushing starts with it as a deeply sagging one. At a
/// quarter of the weight a level cable is 1.8 chords long; with less its forces hardly follow its length, and with much
/// more the start is a taut cable, which pushing ones are far from.
pub(super) const MIN_GUESS: f64 = 0.25;
pub(super) const MIN_STRAIN: f64 = 1e-9;

/// Rounding of what weights can make up for, over the sizes that are added: some 1e-16 times the condition of the
/// straight balance, which may be 1e10 ([`straight_tensions`]). A pose is called out of reach only beyond it.
const REACH_ROUNDING: f64 = 1e-9;

/// Limit of steps of Newton's method, a guard: a way that leads nowhere ends by [`MIN_FRACTION`].
const MAX_ITERATIONS: usize = 100;

/// Scaled residual that is as good as zero. Rounding of six forces leaves 1e-15 and more; a limit below it would cost the
/// steps until one does not gain, one far above it digits that the last step brings for nothing.
const BALANCED: f64 = 1e-14;

/// Fraction of Newton's step: its factors after a step that gains and one that does not, and the fraction at which the
/// way has come to nothing. The whole step comes back within two or three that gain; a fraction of a millionth that does
/// not gain points to a place of least imbalance, which is none of balance.
const FASTER: f64 = 2.0;
const SLOWER: f64 = 0.25;
const MIN_FRACTION: f64 = 1e-6;

/// Parallel tension over the weight of a cable as long as its chord below which a cable is slack enough to follow its length rather than its tension:
/// at one half of its weight a level cable sags by a quarter of its chord.
const SLACK: f64 = 0.5;

/// Part of its tension that a cable keeps at least in one step. At zero a step could slacken it for ever; near 1, slack
/// poses are reached in many steps.
const MIN_SLACKENED: f64 = 0.2;

/// Parallel tension over the weight below which the length of a cable is sought without the bound that the tension gives.
/// A level cable is e⁵⁰ chords long there, and the bound soon leaves the range of numbers.
const NO_BOUND: f64 = 0.01;

/// Limit of steps of the search for a length, most of them halvings of an interval; and the relative size of the last one.
/// Newton squares the error, and only a step on the way is wanted: what counts is the balance afterwards.
const MAX_LENGTH_STEPS: usize = 80;
const LENGTH_STEP: f64 = 1e-9;

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
            let least = (MIN_GUESS * cable.load.size * chord).max(MIN_STRAIN * cable.axial_stiffness());
            cable.hang_with_tension(pose, tension.max(least))
        })
        .collect();

    // Newton's method from there.
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
            return Err(StaticsError::NegativeTension { cable, tension });
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
    Ok(reach.iter().zip(sizes).any(|(reach, size)| *reach < -REACH_ROUNDING * size))
}

/// Cables whose chords do not span the degrees of freedom: sagging ones may, since they do not pull along their chords.
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
    let mut fraction = 1.0;
    while iterations < MAX_ITERATIONS && residual > BALANCED {
        iterations += 1;

        // The step, cut.
        let mut columns = Mat6::identity();
        for (i, cable) in hanging.iter().enumerate() {
            let lever_w = cable.start_w - pose.position_w;
            columns.set_column(i, &coordinates.reduce_force(&cable.force_by_length_w(), &lever_w));
        }
        let right = -coordinates.reduce(&wrench);
        let Some(change) = columns.lu().solve(&right) else { break };
        let next: Vec<HangingCable> =
            (hanging.iter().zip(&change)).map(|(cable, change)| step(cable, fraction * change)).collect();

        // Taken if it is a gain.
        let (next_wrench, next_residual) = unbalanced(robot, &coordinates, pose, &next);
        if next_residual < residual {
            (hanging, wrench, residual) = (next, next_wrench, next_residual);
            fraction = (FASTER * fraction).min(1.0);
        } else if residual < RESIDUAL_LIMIT {
            break;
        } else {
            fraction *= SLOWER;
            if fraction < MIN_FRACTION {
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
    if change > 0.0 && tension < SLACK * rope.weight_per_length * cable.chord_w().norm() {
        return cable.at_length(rope.unstrained_length + change);
    }
    tightened(cable, change)
}

/// A cable some length longer [m], to first order in its parallel tension.
fn tightened(cable: &HangingCable, change: f64) -> HangingCable {
    let tension = cable.catenary.parallel_tension();
    let wanted = tension + change * cable.catenary.parallel_tension_by_length();
    at_tension(cable, wanted.max(MIN_SLACKENED * tension))
}

/// The cable between the same points whose parallel tension is `wanted` > 0 [N].
fn at_tension(cable: &HangingCable, wanted: f64) -> HangingCable {
    let rope = cable.catenary.rope();
    // Slacker cables need a search that knows no bound from the tension.
    if wanted >= NO_BOUND * rope.weight_per_length * cable.chord_w().norm() {
        return cable.at_parallel_tension(wanted);
    }

    let (mut low, mut high) = (0.0, f64::INFINITY);
    let mut cable = cable.clone();
    for _ in 0..MAX_LENGTH_STEPS {
        // The interval.
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
        let last = step.abs() <= LENGTH_STEP * length;
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

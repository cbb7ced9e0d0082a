//! Inverse statics, pose to unstrained lengths and tensions, for as many cables as degrees of freedom; module `tension`
//! treats more cables.

mod starts;

use super::collect::without_stability;
use super::equilibrium::{Equilibrium, RESIDUAL_LIMIT};
use super::error::{RopeRefusal, StaticsError};
use super::exit_points;
use super::ideal::{self, most_negative, straight_tensions};
use super::loaded_cable::{LoadedCable, MAX_LENGTH_RATIO};
use super::model::StaticModel;
use super::residual::scaled_residual;
use super::ropes;
use super::tension::Obstacle;
use crate::catenary::space::HangingCable;
use crate::drive::CableAtRest;
use crate::math::{Mat6, Vec6};
use crate::platform::{Coordinates, StraightCable, balance, load_size, load_wrench, wrench_of};
use crate::robot::{Pose, Robot};

/// Unstrained lengths and tensions that hold the platform at a pose with as many cables as degrees of freedom; pulleys
/// turn towards the cables.
///
/// # Errors
/// [`StaticsError`], as `at_exit_points`; an attachment inside a wheel.
pub(super) fn determinate(robot: &Robot, pose: &Pose, model: StaticModel) -> Result<Equilibrium, StaticsError> {
    ropes::refuse(robot, RopeRefusal::Analysis)?;
    exit_points::equilibrium(robot, pose, model, |held, _| at_exit_points(held, pose, model))
}

/// Unstrained lengths and tensions that hold the platform at a pose with as many cables as degrees of freedom, which
/// end at fixed points.
///
/// Straight cables have a linear solution. Sagging cables start from it, with half of each cable's weight on the
/// platform. A Newton iteration on the lengths follows. Its steps are taken in the tension parallel to the chord, in
/// which the forces of a taut cable are nearly linear, and in the length where a slack cable gets slacker. If it does
/// not converge, a damped iteration searches from other starts, deeply sagging ones among them.
///
/// # Errors
/// [`StaticsError`]: a singular pose, a straight cable that would need negative tension, no tensions found for sagging
/// cables, coinciding ends, or no convergence.
fn at_exit_points(robot: &Robot, pose: &Pose, model: StaticModel) -> Result<Equilibrium, StaticsError> {
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
        Err(StaticsError::Singular { .. }) if model == StaticModel::Catenary => {
            return without_straight_solution(robot, pose, &loaded);
        }
        tensions => tensions?,
    };

    match model {
        StaticModel::Ideal => match most_negative(&tensions) {
            Some((i, tension)) => {
                let cable = robot.cables[i].name.clone();
                Err(StaticsError::NegativeTension { cable, tension, obstacle: obstacle(robot, pose, model) })
            }
            None => Ok(ideal::collect(robot, *pose, &tensions, 0)),
        },
        StaticModel::Spring => {
            if let Some(i) = weakest(&tensions).filter(|&i| tensions[i] <= 0.0) {
                return Err(StaticsError::NegativeTension {
                    cable: robot.cables[i].name.clone(),
                    tension: tensions[i],
                    obstacle: obstacle(robot, pose, model),
                });
            }
            let lengths: Vec<f64> = (0..cables)
                .map(|i| {
                    let cable = &robot.cables[i];
                    let chord = cable.chord_w(pose).norm();
                    chord / (1.0 + tensions[i] / cable.material.axial_stiffness)
                })
                .collect();
            Ok(without_stability(robot, *pose, model, hang_all(&loaded, pose, &lengths), &lengths, 0))
        }
        StaticModel::Catenary => sagging_cables(robot, pose, &loaded, &tensions),
    }
}

/// Minimum tension of a first guess: over the weight of a cable as long as its chord, and over its axial stiffness if
/// it has no weight. A cable with negative tension in straight statics starts with it, as a deeply sagging one. At a
/// quarter of the weight a level cable is 1.8 chords long. With less its forces hardly follow its length; with much
/// more the start is a taut cable, far from the solution.
pub(super) const MIN_GUESS: f64 = 0.25;
pub(super) const MIN_STRAIN: f64 = 1e-9;

/// Rounding of the tensions that weights can contribute, over the magnitudes that are added: some 1e-16 times the
/// condition number of the straight balance, which may be 1e10 ([`straight_tensions`]). A pose is called out of reach
/// only beyond it.
const REACH_ROUNDING: f64 = 1e-9;

/// Maximum number of Newton steps, a guard: an iteration that does not converge ends by [`MIN_FRACTION`].
const MAX_ITERATIONS: usize = 100;

/// Scaled residual that counts as zero. Rounding of six forces leaves 1e-15 and more. A lower limit would cost further
/// steps until one does not gain; a much higher one would lose digits that the last step gives at no extra cost.
const BALANCED: f64 = 1e-14;

/// Fraction of Newton's step: its factors after a step that gains and one that does not, and the fraction at which the
/// iteration is given up. The full step comes back within two or three successful steps. If a millionth of a step does
/// not gain, the iteration has reached a local minimum of the imbalance, not a balance.
const FRACTION_AFTER_GAIN: f64 = 2.0;
const FRACTION_AFTER_FAILURE: f64 = 0.25;
const MIN_FRACTION: f64 = 1e-6;

/// Parallel tension over the weight of a cable as long as its chord, below which steps are taken in the length rather
/// than in the tension: at one half of its weight a level cable sags by a quarter of its chord.
const SLACK: f64 = 0.5;

/// Minimum ratio of a cable's tension after a step to that before. At zero a step could slacken it beyond return; near
/// 1, slack poses take many steps.
const MIN_SLACKENED: f64 = 0.2;

/// Parallel tension over the weight below which the length of a cable is searched without the bound given by the
/// tension. A level cable is e⁵⁰ chords long there, and the bound soon leaves the range of numbers.
const NO_BOUND: f64 = 0.01;

/// Maximum number of steps of the search for a length, most of them halvings of an interval; and the relative size of
/// the last step. Newton's method squares the error, and the length only serves a step: the balance afterwards decides.
const MAX_LENGTH_STEPS: usize = 80;
const LENGTH_STEP: f64 = 1e-9;

/// Maximum ratio of a solution's tension to that of straight cables, if one of these would be negative; beyond it the
/// solution does not count. In 15,000 such poses of the paper's robot the ratio runs from 1 through 2.5 (median) and 10
/// (98 %) to 550 near singular poses.
const MAX_TENSION_RATIO: f64 = 100.0;

/// Direction in which no cable pulls at a pose.
fn obstacle(robot: &Robot, pose: &Pose, model: StaticModel) -> Option<Box<Obstacle>> {
    Obstacle::at(robot, pose, model).map(Box::new)
}

fn weakest(tensions: &[f64]) -> Option<usize> {
    (0..tensions.len()).min_by(|&i, &j| tensions[i].total_cmp(&tensions[j]))
}

fn hang_all(loaded: &[LoadedCable<'_>], pose: &Pose, lengths: &[f64]) -> Vec<CableAtRest> {
    loaded.iter().zip(lengths).map(|(cable, &length)| cable.hang(pose, length)).collect()
}

/// Equilibrium of sagging cables at a pose: Newton's method from cables with the tensions of `straight` ones, then from
/// other starts.
fn sagging_cables(
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

    // Newton's method from this start.
    let mut found = newton(robot, pose, start.clone(), lengthened);
    if found.residual > RESIDUAL_LIMIT {
        // Each of the two steps sometimes finds a solution with hundreds of metres of rope where the other does not.
        let before = found.iterations;
        found = newton(robot, pose, start, tightened);
        found.iterations += before;
    }

    // Where a straight cable would have negative tension, sagging ones may still hold the pose by their weight; or only
    // by excessive tensions, which nobody wants.
    let negative = weakest(straight).filter(|&i| straight[i] <= 0.0);
    let proportion = straight.iter().fold(0.0, |most: f64, t| most.max(t.abs()));
    let excessive = |found: &CableSearch| negative.is_some() && found.max_tension() > MAX_TENSION_RATIO * proportion;
    let accept = |found: &CableSearch| found.residual <= RESIDUAL_LIMIT && !excessive(found);
    let mut starts = 1;
    let searched = if accept(&found) {
        None
    } else if negative.is_some() && is_out_of_reach(robot, pose, loaded, straight)? {
        starts = 0;
        None
    } else {
        starts::search(robot, pose, loaded, accept)
    };

    // The better of both searches.
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

    // No equilibrium: say why.
    let Some(i) = negative else {
        let (p, CableSearch { residual, iterations, .. }) = (pose.position_w, found);
        return Err(StaticsError::NotConverged { iterations, residual, limit: RESIDUAL_LIMIT, x: p.x, y: p.y, z: p.z });
    };
    let is_straight = loaded.iter().all(|cable| cable.load.size == 0.0);
    Err(negative_tension(robot, pose, (i, straight[i]), is_straight, starts, &found))
}

/// Error of a pose at which a straight cable `i` would have a negative tension, and sagging cables that hold it were
/// not found. If no cable can sag, `is_straight` is true: the straight solution is then the only one.
fn negative_tension(
    robot: &Robot,
    pose: &Pose,
    (i, tension): (usize, f64),
    is_straight: bool,
    starts: usize,
    found: &CableSearch,
) -> StaticsError {
    let cable = robot.cables[i].name.clone();
    let obstacle = obstacle(robot, pose, StaticModel::Catenary);
    if is_straight {
        return StaticsError::NegativeTension { cable, tension, obstacle };
    }

    let residual = found.residual;
    let max_tension = (residual <= RESIDUAL_LIMIT).then(|| found.max_tension());
    StaticsError::NotFound { cable, tension, starts, residual, max_tension, obstacle }
}

/// True if the weight of sagging cables cannot compensate the negative tension of a straight cable, unless one of them
/// is longer than [`MAX_LENGTH_RATIO`] times its chord: (39c) of docs/theory.md.
///
/// A sagging cable pulls like a straight one, less at most its complete weight. So the straight tensions without the
/// cables' weights, changed by the maximum contribution of the weights, have to be positive.
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
            // The straight tensions contain half of the weight of a cable as long as its chord.
            let change = (MAX_LENGTH_RATIO * rate.max(0.0) - 0.5 * rate) * cable.load.size * chord;
            *reach += change;
            *size += change.abs();
        }
    }
    Ok(reach.iter().zip(sizes).any(|(reach, size)| *reach < -REACH_ROUNDING * size))
}

/// Inverse statics at a pose where the chords do not span the degrees of freedom: sagging cables may, since they do not
/// pull along their chords.
fn without_straight_solution(
    robot: &Robot,
    pose: &Pose,
    loaded: &[LoadedCable<'_>],
) -> Result<Equilibrium, StaticsError> {
    let limit = MAX_TENSION_RATIO * load_size(robot);
    let accept = |found: &CableSearch| found.residual <= RESIDUAL_LIMIT && found.max_tension() <= limit;
    match starts::search(robot, pose, loaded, accept) {
        Some(searched) if accept(&searched.best) => Ok(searched.best.collected(robot, pose)),
        _ => Err(StaticsError::singular(robot, pose, StaticModel::Catenary)),
    }
}

struct CableSearch {
    hanging: Vec<HangingCable>,
    residual: f64,
    iterations: usize,
}

impl CableSearch {
    /// Maximum tension at the platform [N].
    fn max_tension(&self) -> f64 {
        self.hanging.iter().fold(0.0, |most: f64, cable| most.max(cable.catenary.tension_at_start()))
    }

    fn collected(self, robot: &Robot, pose: &Pose) -> Equilibrium {
        let lengths: Vec<f64> = self.hanging.iter().map(|cable| cable.catenary.rope().unstrained_length).collect();
        let cables = self.hanging.into_iter().map(CableAtRest::fixed).collect();
        without_stability(robot, *pose, StaticModel::Catenary, cables, &lengths, self.iterations)
    }
}

/// Newton's method on the lengths from a start; `step` makes the cable for a change of length.
fn newton(
    robot: &Robot,
    pose: &Pose,
    mut hanging: Vec<HangingCable>,
    step: fn(&HangingCable, f64) -> HangingCable,
) -> CableSearch {
    let coordinates = Coordinates::of(robot);
    let (mut wrench, mut residual) = wrench_residual(robot, &coordinates, pose, &hanging);
    let mut iterations = 0;
    let mut fraction = 1.0;
    while iterations < MAX_ITERATIONS && residual > BALANCED {
        iterations += 1;

        // Reduced Newton step.
        let mut columns = Mat6::identity();
        for (i, cable) in hanging.iter().enumerate() {
            let lever_w = cable.start_w - pose.position_w;
            columns.set_column(i, &coordinates.reduce_force(&cable.force_by_length_w(), &lever_w));
        }
        let right = -coordinates.reduce(&wrench);
        let Some(change) = columns.lu().solve(&right) else { break };
        let next: Vec<HangingCable> =
            (hanging.iter().zip(&change)).map(|(cable, change)| step(cable, fraction * change)).collect();

        // Take it if it is a gain.
        let (next_wrench, next_residual) = wrench_residual(robot, &coordinates, pose, &next);
        if next_residual < residual {
            (hanging, wrench, residual) = (next, next_wrench, next_residual);
            fraction = (FRACTION_AFTER_GAIN * fraction).min(1.0);
        } else if residual < RESIDUAL_LIMIT {
            break;
        } else {
            fraction *= FRACTION_AFTER_FAILURE;
            if fraction < MIN_FRACTION {
                break;
            }
        }
    }
    CableSearch { hanging, residual, iterations }
}

/// Remaining wrench, and its scaled size.
fn wrench_residual(robot: &Robot, coordinates: &Coordinates, pose: &Pose, hanging: &[HangingCable]) -> (Vec6, f64) {
    let forces = hanging.iter().map(|cable| (cable.force_on_start_w(), cable.start_w - pose.position_w));
    let (wrench, scale) = balance(robot, pose, forces);
    (wrench, scaled_residual(coordinates, &wrench, scale))
}

/// Cable made longer by `change` [m], to first order: in the parallel tension where it is taut, since its forces are
/// nearly linear in it; in the length where it hangs slack and gets slacker, since its weight acts.
fn lengthened(cable: &HangingCable, change: f64) -> HangingCable {
    let rope = cable.catenary.rope();
    let tension = cable.catenary.parallel_tension();
    if change > 0.0 && tension < SLACK * rope.weight_per_length * cable.chord_w().norm() {
        return cable.at_length(rope.unstrained_length + change);
    }
    tightened(cable, change)
}

/// Cable made longer by `change` [m], to first order in its parallel tension.
fn tightened(cable: &HangingCable, change: f64) -> HangingCable {
    let tension = cable.catenary.parallel_tension();
    let target = tension + change * cable.catenary.parallel_tension_by_length();
    at_tension(cable, target.max(MIN_SLACKENED * tension))
}

/// Cable between the same points with the parallel tension `target` > 0 [N].
fn at_tension(cable: &HangingCable, target: f64) -> HangingCable {
    let rope = cable.catenary.rope();
    // Slacker cables need a search without the bound from the tension.
    if target >= NO_BOUND * rope.weight_per_length * cable.chord_w().norm() {
        return cable.at_parallel_tension(target);
    }

    let (mut low, mut high) = (0.0, f64::INFINITY);
    let mut cable = cable.clone();
    for _ in 0..MAX_LENGTH_STEPS {
        // Update the interval.
        let length = cable.catenary.rope().unstrained_length;
        let tension = cable.catenary.parallel_tension();
        if tension > target {
            low = length;
        } else {
            high = length;
        }

        // A taut cable's τ grows like c − L, a sagging one's like 1/√(L − c); the logarithm is in between.
        let step = (tension / target).ln() * tension / cable.catenary.parallel_tension_by_length();
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

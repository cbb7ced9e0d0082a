//! Unstrained lengths to pose.

use super::collect::collect;
use super::equilibrium::{Equilibrium, MAX_RESIDUAL_OF_ROUNDING, RESIDUAL_LIMIT};
use super::error::StaticsError;
use super::loaded_cable::LoadedCable;
use super::model::StaticModel;
use super::residual::{check_lengths, elastic_rounding, scaled_residual};
use super::stiffness::assembled;
use super::{energy, ideal, start};
use crate::catenary::space::HangingCable;
use crate::math::{Mat6, Vec6, inertia};
use crate::platform::{Coordinates, balance, load_size};
use crate::robot::{Pose, Robot};

/// Limit of iterations. Robots of the library take 4 to 12; random ones whose platform slides down a narrow valley of
/// stiff ropes, some of them slack, up to 450.
const MOST_ITERATIONS: usize = 5000;

/// The pose in which the platform rests for given unstrained lengths [m], one a cable in file order.
///
/// `spring` and `catenary`: minimises the potential energy of cables and platform by Newton's method with shifted
/// stiffness, so that what it finds is a stable equilibrium wherever there is one near, or an indifferent one; any number
/// of cables. `ideal`: closes the lengths, as many cables as freedoms, all of which have to pull. `start`: where to begin; without it
/// the pose that straight cables of these lengths come closest to.
///
/// # Errors
/// [`StaticsError`]: lengths that do not fit the robot, ideal cables that are not as many as freedoms or one of which
/// would have to push, a start out of a planar platform's plane, no equilibrium within [`RESIDUAL_LIMIT`], or, where
/// rounding of stiff cables leaves more, none within [`MAX_RESIDUAL_OF_ROUNDING`].
///
/// # Example
/// ```
/// # use funicular::{robot::Robot, statics::{self, StaticModel}};
/// # let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM)?;
/// let lengths = [6.863, 6.565, 6.756, 6.663, 6.801, 6.604];
/// let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None)?;
/// assert!((rest.pose.position_w.z - 0.455_48).abs() < 1e-5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn forward(
    robot: &Robot,
    lengths: &[f64],
    model: StaticModel,
    start: Option<&Pose>,
) -> Result<Equilibrium, StaticsError> {
    check_lengths(robot, lengths)?;
    let (cables, freedoms) = (robot.cables.len(), robot.platform.freedoms.count());
    if model == StaticModel::Ideal && cables != freedoms {
        return Err(StaticsError::CableCount { cables, freedoms });
    }
    if let Some(start) = start {
        robot.platform.freedoms.check(start)?;
    }
    let pose = start.copied().unwrap_or_else(|| start::pose_from_lengths(robot, lengths));
    match model {
        StaticModel::Ideal => ideal::forward(robot, lengths, pose),
        StaticModel::Spring | StaticModel::Catenary => elastic(robot, lengths, model, pose),
    }
}

/// Everything the search needs to know about one pose.
pub(super) struct Trial {
    pub(super) pose: Pose,
    pub(super) cables: Vec<HangingCable>,
    /// Wrench on the platform in its coordinates, scaled.
    pub(super) wrench: Vec6,
    pub(super) residual: f64,
    /// [`RESIDUAL_LIMIT`], or what rounding of the pose leaves in very stiff cables under very small loads: below it the
    /// search cannot come nearer. Whether the place is an equilibrium, [`Search::holds`] says.
    pub(super) limit: f64,
    pub(super) energy: f64,
}

/// The robot with its lengths: energy, wrench and stiffness at any pose.
pub(super) struct Search<'a> {
    robot: &'a Robot,
    lengths: &'a [f64],
    /// The cables; the drag of the wind is that of one pose, so that all loads have a potential.
    loaded: Vec<LoadedCable<'a>>,
    /// Force that rounding of chords leaves [N].
    rounding: f64,
    pub(super) coordinates: Coordinates,
    /// The platform may turn; else its orientation is held.
    pub(super) turns: bool,
}

impl<'a> Search<'a> {
    /// With the drag that the cables have at `pose`.
    pub(super) fn new(robot: &'a Robot, lengths: &'a [f64], model: StaticModel, pose: &Pose) -> Self {
        let loaded = LoadedCable::all(robot, pose, model);
        let (coordinates, rounding) = (Coordinates::of(robot), elastic_rounding(robot));
        Self { robot, lengths, loaded, rounding, coordinates, turns: true }
    }

    pub(super) fn at(&self, pose: Pose) -> Trial {
        let cables: Vec<HangingCable> =
            self.loaded.iter().zip(self.lengths).map(|(cable, &length)| cable.hang(&pose, length)).collect();
        let forces = cables.iter().map(|cable| (cable.force_on_start_w(), cable.start_w - pose.position_w));
        let (wrench, force_scale) = balance(self.robot, &pose, forces);
        let energy = energy::of_parts(self.robot, &pose, cables.iter());
        let wrench = if self.turns { wrench } else { Vec6::from_fn(|i, _| if i < 3 { wrench[i] } else { 0.0 }) };
        let residual = scaled_residual(&self.coordinates, &wrench, force_scale);
        let limit = if force_scale > 0.0 { RESIDUAL_LIMIT.max(self.rounding / force_scale) } else { RESIDUAL_LIMIT };
        let wrench = self.coordinates.reduce(&wrench);
        Trial { pose, cables, wrench, residual, limit, energy }
    }

    /// Whether the platform is in equilibrium there: to [`RESIDUAL_LIMIT`]; or as well as rounding allows, if that is
    /// [`MAX_RESIDUAL_OF_ROUNDING`] at least, or if nothing is there to be balanced.
    pub(super) fn holds(&self, trial: &Trial) -> bool {
        trial.residual <= trial.limit.min(MAX_RESIDUAL_OF_ROUNDING)
            || (self.carries_nothing(trial) && trial.residual <= trial.limit)
    }

    /// Nothing acts on the platform and its cables, and all tensions together are rounding.
    fn carries_nothing(&self, trial: &Trial) -> bool {
        trial.limit >= 1.0 && load_size(self.robot) == 0.0 && self.loaded.iter().all(|cable| cable.load.size == 0.0)
    }

    /// The equilibrium at a place that [holds](Self::holds).
    pub(super) fn collected(&self, trial: Trial, model: StaticModel, iterations: usize) -> Equilibrium {
        let nothing = self.carries_nothing(&trial);
        let mut equilibrium = collect(self.robot, trial.pose, model, trial.cables, self.lengths, iterations);
        if nothing {
            equilibrium.residual = 0.0;
        }
        equilibrium
    }

    /// Why a place is no equilibrium.
    fn refused(&self, trial: &Trial, iterations: usize) -> StaticsError {
        let (p, residual) = (trial.pose.position_w, trial.residual);
        if trial.limit > MAX_RESIDUAL_OF_ROUNDING {
            let (rounding, limit) = (self.rounding, MAX_RESIDUAL_OF_ROUNDING);
            return StaticsError::LostInRounding { iterations, residual, limit, rounding, x: p.x, y: p.y, z: p.z };
        }
        let limit = trial.limit;
        StaticsError::NotConverged { iterations, residual, limit, x: p.x, y: p.y, z: p.z }
    }

    /// Symmetric part of the tangent stiffness in the platform's coordinates, scaled; a unit diagonal beyond them.
    pub(super) fn stiffness(&self, trial: &Trial) -> Mat6 {
        let parts =
            trial.cables.iter().map(|c| (c.tangent_w(), c.force_on_start_w(), c.start_w - trial.pose.position_w));
        let total = assembled(self.robot, &trial.pose, parts);
        let mut total = self.coordinates.reduce_symmetric(&total);
        let freedoms = self.coordinates.freedoms();
        for row in (0..6).filter(|&k| k >= freedoms.count() || !self.turns && freedoms.is_rotation(k)) {
            total.row_mut(row).fill(0.0);
            total.column_mut(row).fill(0.0);
            total[(row, row)] = 1.0;
        }
        total
    }

    /// Work of the load's moment along a step; a moment that stays fixed in the world has no energy.
    fn work(&self, step: &Vec6) -> f64 {
        let step = self.coordinates.expand(step);
        self.robot.load.moment_w.dot(&step.fixed_rows::<3>(3)) / self.coordinates.ell()
    }
}

/// Scaled residual at which a search ends at once. Rounding leaves 1e-15 to 1e-12: where it leaves more than this, the
/// search ends when no step betters the residual.
pub(super) const AT_REST: f64 = 1e-13;

/// Limit of rounds in which the drag of the wind follows the cables; each gains a factor, see theory, section 15.
const MOST_ROUNDS: usize = 100;

/// The stable equilibrium that elastic cables come to from a start.
pub(super) fn elastic(
    robot: &Robot,
    lengths: &[f64],
    model: StaticModel,
    start: Pose,
) -> Result<Equilibrium, StaticsError> {
    let mut search = Search::new(robot, lengths, model, &start);
    let (mut here, mut iterations) = search.rest(start);
    if robot.wind_turns_with_cables() {
        // At rest under the drag of one pose, the platform meets that of another; the two draw near, each round by the
        // part that the drag's turn is of the stiffness.
        let mut last = f64::INFINITY;
        for _ in 0..MOST_ROUNDS {
            search = Search::new(robot, lengths, model, &here.pose);
            here = search.at(here.pose);
            if here.residual < AT_REST || (here.residual < here.limit && here.residual > 0.5 * last) {
                break;
            }
            last = here.residual;
            let more;
            (here, more) = search.rest(here.pose);
            iterations += more;
        }
    }
    if !search.holds(&here) {
        return Err(search.refused(&here, iterations));
    }
    Ok(search.collected(here, model, iterations))
}

/// Part of the mean unstrained length that the platform may move by in one step, …
const REACH: f64 = 0.2;

/// … and of the mean distance to the anchors, where the platform is so far from them that it is more: with steps of the
/// lengths alone, a platform of kilometres on cables of metres took hundreds of them to come to rest. Cables have to be
/// twice as long as unstrained for it, so that it changes no search of a robot near its place.
const FAR_REACH: f64 = 0.1;

/// Angle that the platform may turn by in one step [rad]. Large turns are taken in several: at a whole radian a rotation
/// differs from its first order by half of itself.
const MAX_TURN: f64 = 0.5;

/// Part of the work expected of a step, to first order, that the energy has to fall by (Armijo's condition). Of a quadratic
/// energy a full step of Newton's method gains one half, a step at the edge of divergence nothing.
const ARMIJO: f64 = 1e-4;

/// Saddles that one search leaves; each time the energy falls, so that none is met twice.
const MAX_ESCAPES: usize = 3;

impl Search<'_> {
    /// A step from a place cut to what may be taken at once, and how many times that it was: half a radian, a fifth of
    /// the mean cable or a tenth of the mean distance.
    pub(super) fn limited(&self, from: &Trial, step: &Vec6) -> (Vec6, f64) {
        let lengths: f64 = self.lengths.iter().sum();
        let chords: f64 = from.cables.iter().map(|cable| cable.chord_w().norm()).sum();
        let reach = (REACH * lengths).max(FAR_REACH * chords) / self.lengths.len() as f64;
        let motion = self.coordinates.expand(step);
        let length = (motion.fixed_rows::<3>(0).norm() / reach)
            .max(motion.fixed_rows::<3>(3).norm() / (MAX_TURN * self.coordinates.ell()));
        (if length > 1.0 { step / length } else { *step }, length)
    }

    /// Where the energy is least, from a start downhill; and the iterations taken. Where none was found, what was reached.
    pub(super) fn rest(&self, start: Pose) -> (Trial, usize) {
        let stiffest: f64 = self.loaded.iter().map(LoadedCable::axial_stiffness).sum();
        let least_diagonal = 1e-9 * stiffest / self.lengths.iter().copied().fold(0.0, f64::max);
        let mut here = self.at(start);
        let mut shift = 0.0;
        let (mut refused, mut exhausted) = (false, false);
        let mut escapes = 0;
        let mut iterations = 0;

        while iterations < MOST_ITERATIONS {
            iterations += 1;
            let stiffness = self.stiffness(&here);
            let near = here.residual < here.limit;
            if near {
                // The last digits are those of Newton's method alone.
                shift = 0.0;
            }

            // The end, unless the place is a saddle.
            if here.residual < AT_REST || (near && exhausted) {
                // A saddle is left along its weakest direction: the energy falls both ways.
                if escapes < MAX_ESCAPES
                    && inertia::negative_eigenvalues(&stiffness, self.coordinates.count()) > 0
                    && let Some(lower) = descend_from_saddle(self, &here, &stiffness)
                {
                    escapes += 1;
                    (here, shift, exhausted) = (lower, 0.0, false);
                    continue;
                }
                break;
            }

            // The step. Where all cables are slack there is no stiffness to compare with.
            let diagonal = stiffness.diagonal().amax().max(least_diagonal);
            let Some(step) = shifted_step(&stiffness, &here.wrench, &mut shift, diagonal) else { break };
            let (step, length) = self.limited(&here, &step);
            let next = self.at(self.coordinates.moved(&here.pose, &step));

            // Whether it is a gain. Near rest the energy drowns in rounding; there the residual decides.
            let expected = step.dot(&here.wrench);
            let lower = next.energy - self.work(&step) < here.energy - ARMIJO * expected;
            let quieter = next.residual < 0.9 * here.residual && here.residual < 1e-4;

            // Taken, or tried again with a larger shift.
            if next.residual.is_finite() && (lower || quieter) {
                // Down a narrow valley (stiff ropes, a light platform, slack cables) the shift that has just been found
                // necessary still is.
                shift *= if length > 1.0 {
                    1.0
                } else if refused {
                    0.5
                } else {
                    0.1
                };
                (refused, exhausted) = (false, false);
                if shift < 1e-12 * diagonal {
                    shift = 0.0;
                }
                here = next;
            } else if near {
                // Rounding: nothing better is to be had.
                exhausted = true;
            } else {
                shift = (if refused { 10.0 } else { 3.0 } * shift).max(1e-6 * diagonal);
                refused = true;
                if shift > 1e9 * diagonal {
                    break;
                }
            }
        }

        (here, iterations)
    }
}

/// Solves `(K + shift) step = wrench` with the least shift that makes the matrix positive definite.
fn shifted_step(stiffness: &Mat6, wrench: &Vec6, shift: &mut f64, diagonal: f64) -> Option<Vec6> {
    for _ in 0..60 {
        if let Some(factor) = (stiffness + Mat6::identity() * *shift).cholesky() {
            return Some(factor.solve(wrench));
        }
        *shift = (4.0 * *shift).max(1e-6 * diagonal).max(1e-12);
    }
    None
}

/// A point of lower energy beside a saddle, on the side and at the distance that lowers it most.
fn descend_from_saddle(search: &Search<'_>, here: &Trial, stiffness: &Mat6) -> Option<Trial> {
    let (values, vectors) = inertia::eigen(stiffness, search.coordinates.count());
    let noise = 1e-10 * values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    if values[0] > -noise {
        return None;
    }
    [0.3, -0.3, 0.1, -0.1, 0.01, -0.01]
        .into_iter()
        .map(|part| vectors[0] * (part * search.coordinates.ell()))
        .map(|step| (search.at(search.coordinates.moved(&here.pose, &step)), search.work(&step)))
        .map(|(trial, work)| (trial.energy - work, trial))
        .filter(|(energy, trial)| *energy < here.energy && trial.residual.is_finite())
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, trial)| trial)
}

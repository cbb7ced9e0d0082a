//! Forward statics: unstrained lengths to pose.

use super::collect::{with_stability, without_stability};
use super::equilibrium::{Equilibrium, MAX_RESIDUAL_OF_ROUNDING, RESIDUAL_LIMIT};
use super::error::StaticsError;
use super::loaded_cable::LoadedCable;
use super::model::StaticModel;
use super::residual::{check_lengths, elastic_rounding, scaled_residual};
use super::ropes::RunningEnd;
use super::stiffness::assembled;
use super::supports::{self, CablesOnSupports};
use super::{energy, ideal, initial_pose, ropes};
use crate::drive::CableAtRest;
use crate::math::{Mat6, Vec3, Vec6, symmetric};
use crate::platform::{Coordinates, balance, load_size};
use crate::robot::{Pose, Robot};
use std::ops::ControlFlow;

/// Maximum number of iterations. Robots of the library take 4 to 12. Random robots whose platform slides down a narrow
/// valley of stiff ropes, some of them slack, take up to 450.
const MAX_ITERATIONS: usize = 5000;

/// Equilibrium for given unstrained lengths [m], one per cable in file order.
///
/// `spring` and `catenary`, any number of cables: minimises the potential energy of cables and platform by Newton's
/// method with shifted stiffness. So it finds a stable equilibrium if there is one near, or an indifferent one.
/// `ideal`, as many cables as degrees of freedom: closes the lengths; all tensions have to be positive. `ideal`, fewer
/// cables: a stable or indifferent equilibrium as well. `start` is the start pose; without it the search begins at the
/// pose at which straight cables of these lengths come closest to closing.
///
/// # Errors
/// [`StaticsError`]: lengths that do not fit the robot; more ideal cables than degrees of freedom, or ideal cables that
/// would need negative tension; a start out of a planar platform's plane; no equilibrium within
/// [`RESIDUAL_LIMIT`], or, where rounding of stiff cables leaves more, within [`MAX_RESIDUAL_OF_ROUNDING`].
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
    ropes::check(robot, model)?;
    if model == StaticModel::Ideal && robot.constraint().is_redundant() {
        let (cables, dof) = (robot.cables.len(), robot.platform.motion.count());
        return Err(StaticsError::CableCount { cables, dof });
    }

    if let Some(start) = start {
        robot.platform.motion.check(start)?;
    }

    let pose = start.copied().unwrap_or_else(|| initial_pose::pose_from_lengths(robot, lengths));
    if model == StaticModel::Ideal && robot.has_supports() {
        let solve = |rigid: &Robot| forward(rigid, lengths, model, Some(&pose));
        return supports::on_flexible_supports(robot, solve, |found: &mut Equilibrium| &mut found.cables, &[]);
    }

    match model {
        StaticModel::Ideal if robot.constraint().is_under() => {
            ideal::forward_of_few(robot, lengths, pose, |lengths, start| {
                descend_to_equilibrium(robot, lengths, StaticModel::Spring, start)
            })
        }
        StaticModel::Ideal => ideal::forward(robot, lengths, pose),
        StaticModel::Spring | StaticModel::Catenary => descend_to_equilibrium(robot, lengths, model, pose),
    }
}

/// State of the search at one pose.
pub(super) struct TrialPose {
    pub(super) pose: Pose,
    pub(super) cables: Vec<CableAtRest>,
    /// Displacements of the supports [m]; empty for a rigid frame.
    displacements_w: Vec<Vec3>,
    /// Unstrained lengths [m] as ropes over sheaves have divided them; empty without such ropes.
    divided: Vec<f64>,
    /// Wrench on the platform in its coordinates, scaled.
    pub(super) wrench: Vec6,
    pub(super) residual: f64,
    /// [`RESIDUAL_LIMIT`], or the residual left by rounding of the pose for very stiff cables under very small loads:
    /// the search cannot get below it. [`EnergySearch::is_equilibrium`] decides whether the pose is an equilibrium.
    pub(super) limit: f64,
    pub(super) energy: f64,
}

/// Robot with its lengths: energy, wrench and stiffness at any pose.
pub(super) struct EnergySearch<'a> {
    robot: &'a Robot,
    lengths: &'a [f64],
    /// Cables with their loads; the drag of the wind is that of one pose, so that all loads have a potential.
    loaded: Vec<LoadedCable<'a>>,
    /// Force left by rounding of the chords [N].
    rounding: f64,
    pub(super) coordinates: Coordinates,
    /// True if the platform may turn; otherwise its orientation is held.
    pub(super) turns: bool,
}

impl<'a> EnergySearch<'a> {
    /// Search with the drag that the cables have at `pose`.
    pub(super) fn new(robot: &'a Robot, lengths: &'a [f64], model: StaticModel, pose: &Pose) -> Self {
        let loaded = LoadedCable::all(robot, pose, model);
        let (coordinates, rounding) = (Coordinates::of(robot), elastic_rounding(robot));
        Self { robot, lengths, loaded, rounding, coordinates, turns: true }
    }

    /// Search with the drag that the cables have at a trial, with its displaced supports.
    fn with_drag_of(robot: &'a Robot, lengths: &'a [f64], model: StaticModel, trial: &TrialPose) -> Self {
        let mut search = Self::new(robot, lengths, model, &trial.pose);
        if robot.has_supports() {
            let displaced = robot.displaced(&trial.displacements_w);
            for (i, loaded) in search.loaded.iter_mut().enumerate() {
                loaded.load = LoadedCable::at(&displaced, i, &trial.pose, model).load;
            }
        }
        search
    }

    pub(super) fn at(&self, pose: Pose) -> TrialPose {
        let divided = if self.robot.has_ropes_over_sheaves() {
            ropes::divided(self.robot, &self.loaded, self.lengths, &pose)
        } else {
            Vec::new()
        };
        let lengths = if divided.is_empty() { self.lengths } else { &divided };
        let (cables, displacements_w): (Vec<CableAtRest>, Vec<Vec3>) = if self.robot.has_supports() {
            let settled = CablesOnSupports::at(self.robot, &self.loaded, self.lengths, &pose);
            (settled.cables, settled.displacements_w)
        } else {
            let hung = self.loaded.iter().zip(lengths).map(|(cable, &length)| cable.hang(&pose, length));
            (hung.collect(), Vec::new())
        };
        let forces = cables.iter().map(|cable| (cable.force_w(), cable.span.start_w - pose.position_w));
        let (wrench, force_scale) = balance(self.robot, &pose, forces);
        let energy = energy::of_parts(self.robot, &pose, cables.iter())
            + supports::energy(self.robot, &cables, self.lengths, &displacements_w)
            + ropes::energy_of_references(self.robot, &cables, lengths);
        let wrench = if self.turns { wrench } else { Vec6::from_fn(|i, _| if i < 3 { wrench[i] } else { 0.0 }) };
        let residual = scaled_residual(&self.coordinates, &wrench, force_scale);
        let limit = if force_scale > 0.0 { RESIDUAL_LIMIT.max(self.rounding / force_scale) } else { RESIDUAL_LIMIT };
        let wrench = self.coordinates.reduce(&wrench);
        TrialPose { pose, cables, displacements_w, divided, wrench, residual, limit, energy }
    }

    /// True if the platform is in equilibrium: to [`RESIDUAL_LIMIT`]; or as well as rounding allows, if that is below
    /// [`MAX_RESIDUAL_OF_ROUNDING`] or there is nothing to balance.
    pub(super) fn is_equilibrium(&self, trial: &TrialPose) -> bool {
        trial.residual <= trial.limit.min(MAX_RESIDUAL_OF_ROUNDING)
            || (self.is_unloaded(trial) && trial.residual <= trial.limit)
    }

    /// True if no load acts on the platform and its cables, and all tensions together are rounding.
    fn is_unloaded(&self, trial: &TrialPose) -> bool {
        trial.limit >= 1.0 && load_size(self.robot) == 0.0 && self.loaded.iter().all(|cable| cable.load.size == 0.0)
    }

    /// Equilibrium at a pose that [is an equilibrium](Self::is_equilibrium).
    pub(super) fn collected(&self, trial: TrialPose, model: StaticModel, iterations: usize) -> Equilibrium {
        let nothing = self.is_unloaded(&trial);
        let TrialPose { pose, cables, displacements_w, divided, .. } = trial;
        let lengths = if divided.is_empty() { self.lengths } else { &divided };
        let equilibrium = without_stability(self.robot, pose, model, cables, lengths, iterations);
        let mut equilibrium =
            with_stability(self.robot, supports::displaced(self.robot, equilibrium, &displacements_w));
        if nothing {
            equilibrium.residual = 0.0;
        }
        equilibrium
    }

    /// Error for a pose that is not an equilibrium.
    fn refused(&self, trial: &TrialPose, iterations: usize) -> StaticsError {
        let (p, residual) = (trial.pose.position_w, trial.residual);
        if trial.limit > MAX_RESIDUAL_OF_ROUNDING {
            let (rounding, limit) = (self.rounding, MAX_RESIDUAL_OF_ROUNDING);
            return StaticsError::LostInRounding { iterations, residual, limit, rounding, x: p.x, y: p.y, z: p.z };
        }
        let limit = trial.limit;
        StaticsError::NotConverged { iterations, residual, limit, x: p.x, y: p.y, z: p.z }
    }

    /// Symmetric part of the tangent stiffness in the platform's coordinates, scaled; a unit diagonal beyond them.
    pub(super) fn stiffness(&self, trial: &TrialPose) -> Mat6 {
        let parts = trial.cables.iter().map(|c| (c.tangent_w(), c.force_w(), c.span.start_w - trial.pose.position_w));
        let mut total = assembled(self.robot, &trial.pose, parts);
        if self.robot.has_supports() {
            let carried = trial.cables.iter().zip(self.lengths).enumerate().filter_map(|(i, (cable, length))| {
                let on_support = supports::stiffness_on_support(self.robot, i, cable, *length, &trial.displacements_w)?;
                Some((i, on_support, cable.span.start_w - trial.pose.position_w))
            });
            total -= supports::lost_stiffness(self.robot, carried);
        }
        if self.robot.has_ropes_over_sheaves() {
            let ends: Vec<RunningEnd> =
                trial.cables.iter().map(|cable| RunningEnd::of_trial(cable, &trial.pose)).collect();
            total -= ropes::lost_stiffness(self.robot.ropes.iter().map(|rope| rope.cables.as_slice()), &ends);
        }
        let mut total = self.coordinates.reduce_symmetric(&total);
        let motion = self.coordinates.motion();
        for row in (0..6).filter(|&k| k >= motion.count() || !self.turns && motion.is_rotation(k)) {
            total.row_mut(row).fill(0.0);
            total.column_mut(row).fill(0.0);
            total[(row, row)] = 1.0;
        }
        total
    }

    /// Work of the load's moment along a step; a moment that is fixed in the world has no energy.
    fn work(&self, step: &Vec6) -> f64 {
        let step = self.coordinates.expand(step);
        self.robot.load.moment_w.dot(&step.fixed_rows::<3>(3)) / self.coordinates.ell()
    }
}

/// Scaled residual at which a search ends at once. Rounding leaves 1e-15 to 1e-12; if it leaves more than this value,
/// the search ends when no step reduces the residual.
pub(super) const CONVERGED: f64 = 1e-13;

/// Ratio to the previous round's residual above which a round counts as no gain, once the residual is below its limit.
/// Near 1, rounds that improve by rounding only would go on; far below, rounds that gain slowly would be the last.
const STALLED_ROUND: f64 = 0.5;

/// Maximum number of rounds in which the drag of the wind follows the cables; each round gains a factor, see theory,
/// section 15.
const MAX_ROUNDS: usize = 100;

/// Maximum number of rounds after each other without a lower residual.
const MAX_IDLE_ROUNDS: usize = 10;

/// Stable equilibrium that elastic cables reach from a start.
pub(super) fn descend_to_equilibrium(
    robot: &Robot,
    lengths: &[f64],
    model: StaticModel,
    start: Pose,
) -> Result<Equilibrium, StaticsError> {
    let mut search = EnergySearch::new(robot, lengths, model, &start);
    let (mut here, mut iterations) = search.minimise(start);

    if robot.wind_turns_with_cables() {
        // Each equilibrium is found with the drag of the previous pose. Pose and drag converge: each round reduces the
        // difference by the ratio of the drag's turn to the stiffness.
        let (mut last, mut least, mut idle) = (f64::INFINITY, f64::INFINITY, 0);
        for _ in 0..MAX_ROUNDS {
            search = EnergySearch::with_drag_of(robot, lengths, model, &here);
            here = search.at(here.pose);
            if here.residual < CONVERGED || (here.residual < here.limit && here.residual > STALLED_ROUND * last) {
                break;
            }

            // Drag that jumps between two poses, or a platform that slides away, comes to no end.
            idle = if here.residual < least { 0 } else { idle + 1 };
            if idle > MAX_IDLE_ROUNDS || iterations > MAX_ITERATIONS {
                break;
            }
            (last, least) = (here.residual, least.min(here.residual));
            let more;
            (here, more) = search.minimise(here.pose);
            iterations += more;
        }
    }

    if !search.is_equilibrium(&here) {
        return Err(search.refused(&here, iterations));
    }
    let found = search.collected(here, model, iterations);
    ropes::check_balance(robot, &found.cables)?;
    Ok(found)
}

/// Maximum translation per step as a fraction of the mean unstrained length, …
const REACH: f64 = 0.2;

/// … and of the mean distance to the anchors, which counts if the platform is so far away that it gives more. With
/// steps limited by the lengths alone, a platform kilometres away on cables of metres took hundreds of steps. This
/// limit counts only if the mean distance is above twice the mean unstrained length, so it changes no search of a robot
/// near its equilibrium.
const FAR_REACH: f64 = 0.1;

/// Maximum rotation per step [rad]; larger turns are made in several steps. At one radian a rotation differs from its
/// first order by half of itself.
const MAX_TURN: f64 = 0.5;

/// Minimum decrease of the energy as a fraction of the work expected to first order (Armijo's condition). For a
/// quadratic energy a full Newton step gains one half, a step at the edge of divergence nothing.
const ARMIJO: f64 = 1e-4;

/// Maximum number of saddles that one search leaves; the energy falls each time, so none is met twice.
const MAX_ESCAPES: usize = 3;

impl EnergySearch<'_> {
    /// Step limited to the maximum step, and the factor by which it exceeded it: half a radian, a fifth of the mean
    /// cable or a tenth of the mean distance.
    pub(super) fn limited(&self, from: &TrialPose, step: &Vec6) -> (Vec6, f64) {
        let lengths: f64 = self.lengths.iter().sum();
        let chords: f64 = from.cables.iter().map(|cable| cable.span.chord_w().norm()).sum();
        let reach = (REACH * lengths).max(FAR_REACH * chords) / self.lengths.len() as f64;
        let motion = self.coordinates.expand(step);
        let length = (motion.fixed_rows::<3>(0).norm() / reach)
            .max(motion.fixed_rows::<3>(3).norm() / (MAX_TURN * self.coordinates.ell()));
        (if length > 1.0 { step / length } else { *step }, length)
    }

    /// Minimum of the energy downhill from a start, and the number of iterations. If no minimum was found: the last
    /// pose.
    pub(super) fn minimise(&self, start: Pose) -> (TrialPose, usize) {
        let (here, iterations, _) = self.descend(start);
        (here, iterations)
    }

    /// Newton's method with a shifted stiffness from a start: last pose, number of iterations, and reason of the end.
    fn descend(&self, start: Pose) -> (TrialPose, usize, Exit) {
        let mut descent = Descent::new(self, start);
        for iterations in 1..=MAX_ITERATIONS {
            if let ControlFlow::Break(exit) = descent.iterate() {
                return (descent.here, iterations, exit);
            }
        }
        (descent.here, MAX_ITERATIONS, Exit::TooManyIterations)
    }
}

/// Reason why a descent ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Exit {
    /// The residual is below [`CONVERGED`].
    Converged,
    /// The residual is below its limit, and rounding lets no step reduce it.
    AtRounding,
    /// No shift within the limit of tries makes the stiffness positive definite: its entries are not finite.
    NeverDefinite,
    /// No step gains, even a very short one.
    NoGain,
    /// [`MAX_ITERATIONS`] reached.
    TooManyIterations,
}

/// Outcome of the last step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum LastStep {
    /// Taken, or no step yet.
    Taken,
    /// Refused, since it did not reduce energy or residual; the next step starts from the same pose with a larger
    /// shift.
    Refused,
    /// Refused with the residual below its limit: rounding allows no lower residual.
    BelowRounding,
}

/// Minimum reference diagonal of the stiffness for the shifts, over the stiffness of all cables pulling in one
/// direction. It counts if all cables are slack and their stiffness comes from their weight. 1e-5 and more would be
/// stiffer than slack ropes and shorten their steps; zero would leave the shifts without a reference.
const MIN_DIAGONAL: f64 = 1e-9;

/// Maximum ratio of the residual after a step to that before, for a step that is taken for its residual alone. Nearer
/// to 1, rounding counts as progress; far below, the last steps of a search in a narrow valley are refused.
const MAX_RESIDUAL_RATIO: f64 = 0.9;

/// Residual below which a step may be taken for its residual alone. The energy has some 14 digits and falls with the
/// square of the residual, so it decides nothing below 1e-7. Above 1e-4 it decides, and residuals would lead to
/// saddles.
const ENERGY_WITHOUT_DIGITS: f64 = 1e-4;

/// Factors of the shift after a step taken at full length, and after a step that needed a larger shift before. Newton's
/// convergence needs the shift gone within a few steps; but in a narrow valley (stiff ropes, a light platform, slack
/// cables) a shift that has just been necessary still is. With 1 the final convergence would be linear; with 0 every
/// second step in a valley would be refused.
const SHIFT_AFTER_STEP: f64 = 0.1;
const SHIFT_AFTER_REFUSAL: f64 = 0.5;

/// Factors of the shift after the first refused step, and after each further one. Below 2 a search spends its time on
/// refused steps; above 10 its steps are far shorter than necessary.
const SHIFT_AT_FIRST_REFUSAL: f64 = 3.0;
const SHIFT_AT_FURTHER_REFUSALS: f64 = 10.0;

/// Shifts relative to the stiffness: the first one, the value below which a shift counts as zero, and the last one. The
/// first has to be above rounding (1e-16 times the condition number of the stiffness) and far below the stiffness. With
/// the last one a step is a billionth of the wrench over the stiffness, which hardly changes a pose in double
/// precision.
const FIRST_SHIFT: f64 = 1e-6;
const NO_SHIFT: f64 = 1e-12;
const MAX_SHIFT: f64 = 1e9;

/// State of a descent.
struct Descent<'a, 's> {
    search: &'a EnergySearch<'s>,
    here: TrialPose,
    /// Shift added to the diagonal of the stiffness [N/m].
    shift: f64,
    last: LastStep,
    /// Number of saddles left so far.
    escapes: usize,
    /// [`MIN_DIAGONAL`] in [N/m].
    min_diagonal: f64,
}

impl<'a, 's> Descent<'a, 's> {
    fn new(search: &'a EnergySearch<'s>, start: Pose) -> Self {
        let stiffest: f64 = search.loaded.iter().map(LoadedCable::axial_stiffness).sum();
        let min_diagonal = MIN_DIAGONAL * stiffest / search.lengths.iter().copied().fold(0.0, f64::max);
        let here = search.at(start);
        Self { search, here, shift: 0.0, last: LastStep::Taken, escapes: 0, min_diagonal }
    }

    /// Step, taken or refused; or the end of the descent.
    fn iterate(&mut self) -> ControlFlow<Exit> {
        let stiffness = self.search.stiffness(&self.here);
        let near = self.here.residual < self.here.limit;
        if near {
            // The last digits come from Newton's method without shift.
            self.shift = 0.0;
        }

        // End, unless the pose is a saddle.
        if self.here.residual < CONVERGED {
            return self.leave_saddle(&stiffness, Exit::Converged);
        }
        if near && self.last == LastStep::BelowRounding {
            return self.leave_saddle(&stiffness, Exit::AtRounding);
        }

        // Compute the step. If all cables are slack there is no stiffness to compare with.
        let diagonal = stiffness.diagonal().amax().max(self.min_diagonal);
        let Some(step) = shifted_step(&stiffness, &self.here.wrench, &mut self.shift, diagonal) else {
            return ControlFlow::Break(Exit::NeverDefinite);
        };
        let (step, length) = self.search.limited(&self.here, &step);
        let next = self.search.at(self.search.coordinates.moved(&self.here.pose, &step));

        // Take it, or try again with a larger shift.
        if self.is_gain(&step, &next) {
            self.take(next, length, diagonal);
        } else if near {
            self.last = LastStep::BelowRounding;
        } else {
            return self.refuse(diagonal);
        }
        ControlFlow::Continue(())
    }

    /// Leaves a saddle: continues from a pose of lower energy along its weakest direction, in which the energy falls
    /// both ways. Ends if the pose is not a saddle.
    fn leave_saddle(&mut self, stiffness: &Mat6, exit: Exit) -> ControlFlow<Exit> {
        if self.escapes < MAX_ESCAPES
            && symmetric::negative_eigenvalues(stiffness, self.search.coordinates.count()) > 0
            && let Some(lower) = descend_from_saddle(self.search, &self.here, stiffness)
        {
            self.escapes += 1;
            (self.here, self.shift, self.last) = (lower, 0.0, LastStep::Taken);
            return ControlFlow::Continue(());
        }
        ControlFlow::Break(exit)
    }

    /// True if a step lowers the energy enough, or, where the energy drowns in rounding, the residual.
    fn is_gain(&self, step: &Vec6, next: &TrialPose) -> bool {
        let expected = step.dot(&self.here.wrench);
        let lower = next.energy - self.search.work(step) < self.here.energy - ARMIJO * expected;
        let smaller_residual =
            next.residual < MAX_RESIDUAL_RATIO * self.here.residual && self.here.residual < ENERGY_WITHOUT_DIGITS;
        next.residual.is_finite() && (lower || smaller_residual)
    }

    /// Takes a step that was shortened by the factor `length` if that is above 1.
    fn take(&mut self, next: TrialPose, length: f64, diagonal: f64) {
        if length <= 1.0 {
            let refused = self.last == LastStep::Refused;
            self.shift *= if refused { SHIFT_AFTER_REFUSAL } else { SHIFT_AFTER_STEP };
        }
        if self.shift < NO_SHIFT * diagonal {
            self.shift = 0.0;
        }
        (self.here, self.last) = (next, LastStep::Taken);
    }

    /// Shortens the next step by a larger shift.
    fn refuse(&mut self, diagonal: f64) -> ControlFlow<Exit> {
        let again = self.last == LastStep::Refused;
        let factor = if again { SHIFT_AT_FURTHER_REFUSALS } else { SHIFT_AT_FIRST_REFUSAL };
        self.shift = (factor * self.shift).max(FIRST_SHIFT * diagonal);
        self.last = LastStep::Refused;
        if self.shift > MAX_SHIFT * diagonal { ControlFlow::Break(Exit::NoGain) } else { ControlFlow::Continue(()) }
    }
}

/// Maximum number of tries for a shift. With [`SHIFT_GROWTH`] they reach from the first shift to more than 1e30 times
/// the stiffness: only entries that are not finite need more.
const MAX_SHIFT_TRIES: usize = 60;

/// Factor from one try for a shift to the next. Below 2 the tries cost more than the step; a factor of 100 would
/// shorten steps unnecessarily.
const SHIFT_GROWTH: f64 = 4.0;

/// Minimum shift [N/m], for a platform that nothing holds.
const MIN_SHIFT: f64 = 1e-12;

/// Solves `(K + shift) step = wrench` with the smallest of the tried shifts that makes the matrix positive definite.
fn shifted_step(stiffness: &Mat6, wrench: &Vec6, shift: &mut f64, diagonal: f64) -> Option<Vec6> {
    for _ in 0..MAX_SHIFT_TRIES {
        if let Some(factor) = (stiffness + Mat6::identity() * *shift).cholesky() {
            return Some(factor.solve(wrench));
        }
        *shift = (SHIFT_GROWTH * *shift).max(FIRST_SHIFT * diagonal).max(MIN_SHIFT);
    }
    None
}

/// Minimum magnitude of a negative eigenvalue of the stiffness, relative to the largest one, above which it is more
/// than rounding. Rounding of the stiffness leaves some 1e-14; a saddle within 1e-10 is left so slowly that it counts
/// as indifferent.
const NOISE: f64 = 1e-10;

/// Steps by which a saddle is left in both directions, in units of ℓ and radians. Nearer than 0.01 the energy hardly
/// falls; beyond 0.3 the platform may reach another valley.
const ESCAPES: [f64; 6] = [0.3, -0.3, 0.1, -0.1, 0.01, -0.01];

/// Pose of lower energy near a saddle, on the side and at the distance with the lowest energy.
fn descend_from_saddle(search: &EnergySearch<'_>, here: &TrialPose, stiffness: &Mat6) -> Option<TrialPose> {
    let (values, vectors) = symmetric::eigen(stiffness, search.coordinates.count());
    let noise = NOISE * values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    if values[0] > -noise {
        return None;
    }
    ESCAPES
        .into_iter()
        .map(|part| vectors[0] * (part * search.coordinates.ell()))
        .map(|step| (search.at(search.coordinates.moved(&here.pose, &step)), search.work(&step)))
        .map(|(trial, work)| (trial.energy - work, trial))
        .filter(|(energy, trial)| *energy < here.energy && trial.residual.is_finite())
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, trial)| trial)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rotation;

    const LENGTHS: [f64; 6] = [6.863, 6.565, 6.756, 6.663, 6.801, 6.604];

    fn robot() -> Robot {
        Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap()
    }

    /// Result of a descent.
    fn descent(robot: &Robot, start: Pose) -> (TrialPose, usize, Exit) {
        EnergySearch::new(robot, &LENGTHS, StaticModel::Catenary, &start).descend(start)
    }

    #[test]
    fn a_usual_search_ends_at_rest_or_at_rounding_within_a_few_iterations() {
        let robot = robot();
        let (here, iterations, exit) = descent(&robot, initial_pose::pose_from_lengths(&robot, &LENGTHS));
        assert!(matches!(exit, Exit::Converged | Exit::AtRounding), "{exit:?}");
        assert!(here.residual < here.limit && iterations < 20, "{} after {iterations}", here.residual);
    }

    #[test]
    fn from_its_own_end_a_search_ends_at_once() {
        let robot = robot();
        let (first, ..) = descent(&robot, initial_pose::pose_from_lengths(&robot, &LENGTHS));
        let (second, iterations, exit) = descent(&robot, first.pose);
        assert!(matches!(exit, Exit::Converged | Exit::AtRounding), "{exit:?}");
        assert!(iterations <= 3 && second.residual <= first.residual, "{iterations}");
    }

    #[test]
    fn a_place_that_is_no_number_has_no_step() {
        let robot = robot();
        let nowhere = Pose { position_w: crate::math::Vec3::repeat(f64::INFINITY), rot_wp: Rotation::identity() };
        let (.., exit) = descent(&robot, nowhere);
        assert_eq!(exit, Exit::NeverDefinite);
    }
}

//! Unstrained lengths to pose.

use super::collect::collect;
use super::equilibrium::{Equilibrium, MAX_RESIDUAL_OF_ROUNDING, RESIDUAL_LIMIT};
use super::error::StaticsError;
use super::loaded_cable::LoadedCable;
use super::model::StaticModel;
use super::residual::{check_lengths, elastic_rounding, scaled_residual};
use super::stiffness::assembled;
use super::{energy, ideal, initial_pose};
use crate::catenary::space::HangingCable;
use crate::math::{Mat6, Vec6, symmetric};
use crate::platform::{Coordinates, balance, load_size};
use crate::robot::{Pose, Robot};
use std::ops::ControlFlow;

/// Limit of iterations. Robots of the library take 4 to 12; random ones whose platform slides down a narrow valley of
/// stiff ropes, some of them slack, up to 450.
const MAX_ITERATIONS: usize = 5000;

/// The pose in which the platform rests for given unstrained lengths [m], one a cable in file order.
///
/// `spring` and `catenary`: minimises the potential energy of cables and platform by Newton's method with shifted
/// stiffness, so that what it finds is a stable equilibrium wherever there is one near, or an indifferent one; any number
/// of cables. `ideal`: closes the lengths, as many cables as degrees of freedom, all of which have to pull. `start`: where to begin; without it
/// the pose that straight cables of these lengths come closest to.
///
/// # Errors
/// [`StaticsError`]: lengths that do not fit the robot, ideal cables that are not as many as degrees of freedom or one of which
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
    let (cables, dof) = (robot.cables.len(), robot.platform.motion.count());
    if model == StaticModel::Ideal && cables != dof {
        return Err(StaticsError::CableCount { cables, dof });
    }
    if let Some(start) = start {
        robot.platform.motion.check(start)?;
    }
    let pose = start.copied().unwrap_or_else(|| initial_pose::pose_from_lengths(robot, lengths));
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
    /// search cannot come nearer. Whether the place is an equilibrium, [`EnergySearch::holds`] says.
    pub(super) limit: f64,
    pub(super) energy: f64,
}

/// The robot with its lengths: energy, wrench and stiffness at any pose.
pub(super) struct EnergySearch<'a> {
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

impl<'a> EnergySearch<'a> {
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
            || (self.is_unloaded(trial) && trial.residual <= trial.limit)
    }

    /// Nothing acts on the platform and its cables, and all tensions together are rounding.
    fn is_unloaded(&self, trial: &Trial) -> bool {
        trial.limit >= 1.0 && load_size(self.robot) == 0.0 && self.loaded.iter().all(|cable| cable.load.size == 0.0)
    }

    /// The equilibrium at a place that [holds](Self::holds).
    pub(super) fn collected(&self, trial: Trial, model: StaticModel, iterations: usize) -> Equilibrium {
        let nothing = self.is_unloaded(&trial);
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
        let motion = self.coordinates.motion();
        for row in (0..6).filter(|&k| k >= motion.count() || !self.turns && motion.is_rotation(k)) {
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

/// Part of the residual of the round before above which a round counts as no gain, once the residual is below its limit.
/// Near 1 rounds would go on that are better by rounding alone; far below, rounds that gain slowly would be the last.
const STALLED_ROUND: f64 = 0.5;

/// Limit of rounds in which the drag of the wind follows the cables; each gains a factor, see theory, section 15.
const MAX_ROUNDS: usize = 100;

/// The stable equilibrium that elastic cables come to from a start.
pub(super) fn elastic(
    robot: &Robot,
    lengths: &[f64],
    model: StaticModel,
    start: Pose,
) -> Result<Equilibrium, StaticsError> {
    let mut search = EnergySearch::new(robot, lengths, model, &start);
    let (mut here, mut iterations) = search.minimise(start);

    if robot.wind_turns_with_cables() {
        // At rest under the drag of one pose, the platform meets that of another; the two draw near, each round by the
        // part that the drag's turn is of the stiffness.
        let mut last = f64::INFINITY;
        for _ in 0..MAX_ROUNDS {
            search = EnergySearch::new(robot, lengths, model, &here.pose);
            here = search.at(here.pose);
            if here.residual < AT_REST || (here.residual < here.limit && here.residual > STALLED_ROUND * last) {
                break;
            }
            last = here.residual;
            let more;
            (here, more) = search.minimise(here.pose);
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

impl EnergySearch<'_> {
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
    pub(super) fn minimise(&self, start: Pose) -> (Trial, usize) {
        let (here, iterations, _) = self.descend(start);
        (here, iterations)
    }

    /// Newton's method with a shifted stiffness from a start: the last place, the iterations taken, and why it ended.
    fn descend(&self, start: Pose) -> (Trial, usize, Exit) {
        let mut descent = Descent::new(self, start);
        for iterations in 1..=MAX_ITERATIONS {
            if let ControlFlow::Break(exit) = descent.iterate() {
                return (descent.here, iterations, exit);
            }
        }
        (descent.here, MAX_ITERATIONS, Exit::TooManyIterations)
    }
}

/// Why a descent ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Exit {
    /// The residual is below [`AT_REST`].
    AtRest,
    /// The residual is below its limit, and rounding lets no step better it.
    AsFarAsRounding,
    /// No shift within the tries makes the stiffness positive definite: its entries are not finite.
    NeverDefinite,
    /// No step gains, however short.
    NoGain,
    /// [`MAX_ITERATIONS`].
    TooManyIterations,
}

/// What became of the last step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum LastStep {
    /// It was taken, or there was none.
    Taken,
    /// It was no gain; the next one is from the same place with a larger shift.
    Refused,
    /// It was no gain where the residual is below its limit: nothing better is to be had.
    DrownedInRounding,
}

/// Smallest diagonal of the stiffness that shifts are measured by, over that of all cables pulling in one direction. It
/// counts where all cables are slack, whose stiffness is their weight: 1e-5 and more would be stiffer than slack ropes
/// are, and shorten their steps; zero would leave shifts without a measure.
const MIN_DIAGONAL: f64 = 1e-9;

/// Part of the residual that a step has to leave behind at most to be taken for it alone. Nearer to 1, rounding passes for
/// progress; far below, the last steps of a search in a narrow valley are refused.
const QUIETER: f64 = 0.9;

/// Residual below which a step may be taken for its residual alone. The energy has some 14 digits and falls with the
/// square of the residual, so that it decides nothing below 1e-7; above 1e-4 it does, and residuals would lead to saddles.
const ENERGY_DROWNS: f64 = 1e-4;

/// Factors of the shift after a step that was taken at full length, and after one that needed a larger shift before:
/// Newton's own convergence needs the shift gone within a few steps, and in a narrow valley (stiff ropes, a light
/// platform, slack cables) the shift that has just been found necessary still is. At 1 the end would be linear, at 0
/// every second step in a valley would be refused.
const SHIFT_AFTER_STEP: f64 = 0.1;
const SHIFT_AFTER_REFUSAL: f64 = 0.5;

/// Factors of the shift after the first refused step, and after each further one. Below 2 a search spends its time on
/// refusals; beyond 10 it takes far shorter steps than it could.
const SHIFT_AT_FIRST_REFUSAL: f64 = 3.0;
const SHIFT_AT_FURTHER_REFUSALS: f64 = 10.0;

/// Shifts over the stiffness: the first one, below which a shift is none, and the last one. The first has to be above
/// rounding (1e-16 times the condition of the stiffness) and far below the stiffness. The step at the last one is a
/// billionth of the wrench over the stiffness, which no pose in double precision tells from standing still for long.
const FIRST_SHIFT: f64 = 1e-6;
const NO_SHIFT: f64 = 1e-12;
const MAX_SHIFT: f64 = 1e9;

/// A search on its way downhill.
struct Descent<'a, 's> {
    search: &'a EnergySearch<'s>,
    here: Trial,
    /// What is added to the diagonal of the stiffness [N/m].
    shift: f64,
    last: LastStep,
    /// Saddles left so far.
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

    /// One step, taken or refused; or the end.
    fn iterate(&mut self) -> ControlFlow<Exit> {
        let stiffness = self.search.stiffness(&self.here);
        let near = self.here.residual < self.here.limit;
        if near {
            // The last digits are those of Newton's method alone.
            self.shift = 0.0;
        }

        // The end, unless the place is a saddle.
        if self.here.residual < AT_REST {
            return self.leave_saddle(&stiffness, Exit::AtRest);
        }
        if near && self.last == LastStep::DrownedInRounding {
            return self.leave_saddle(&stiffness, Exit::AsFarAsRounding);
        }

        // The step. Where all cables are slack there is no stiffness to compare with.
        let diagonal = stiffness.diagonal().amax().max(self.min_diagonal);
        let Some(step) = shifted_step(&stiffness, &self.here.wrench, &mut self.shift, diagonal) else {
            return ControlFlow::Break(Exit::NeverDefinite);
        };
        let (step, length) = self.search.limited(&self.here, &step);
        let next = self.search.at(self.search.coordinates.moved(&self.here.pose, &step));

        // Taken, or tried again with a larger shift.
        if self.is_gain(&step, &next) {
            self.take(next, length, diagonal);
        } else if near {
            self.last = LastStep::DrownedInRounding;
        } else {
            return self.refuse(diagonal);
        }
        ControlFlow::Continue(())
    }

    /// Goes on from a place of lower energy if the platform rests on a saddle, along its weakest direction, in which the
    /// energy falls both ways; else ends.
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

    /// Whether a step lowers the energy enough, or, where the energy drowns in rounding, the residual.
    fn is_gain(&self, step: &Vec6, next: &Trial) -> bool {
        let expected = step.dot(&self.here.wrench);
        let lower = next.energy - self.search.work(step) < self.here.energy - ARMIJO * expected;
        let quieter = next.residual < QUIETER * self.here.residual && self.here.residual < ENERGY_DROWNS;
        next.residual.is_finite() && (lower || quieter)
    }

    /// Takes a step that was cut `length` times if that is more than 1.
    fn take(&mut self, next: Trial, length: f64, diagonal: f64) {
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

/// Limit of tries for a shift. Those of [`SHIFT_GROWTH`] pass from the first shift to more than 1e30 times the stiffness:
/// only entries that are not finite need more.
const MAX_SHIFT_TRIES: usize = 60;

/// Factor from one try for a shift to the next. Below 2 tries cost more than the step; a factor of 100 would shorten
/// steps for nothing.
const SHIFT_GROWTH: f64 = 4.0;

/// Smallest shift [N/m], for a platform that nothing holds.
const MIN_SHIFT: f64 = 1e-12;

/// Solves `(K + shift) step = wrench` with the least shift that makes the matrix positive definite.
fn shifted_step(stiffness: &Mat6, wrench: &Vec6, shift: &mut f64, diagonal: f64) -> Option<Vec6> {
    for _ in 0..MAX_SHIFT_TRIES {
        if let Some(factor) = (stiffness + Mat6::identity() * *shift).cholesky() {
            return Some(factor.solve(wrench));
        }
        *shift = (SHIFT_GROWTH * *shift).max(FIRST_SHIFT * diagonal).max(MIN_SHIFT);
    }
    None
}

/// Part of the largest eigenvalue of the stiffness that a negative one has to exceed to be more than rounding. Rounding of
/// the stiffness leaves some 1e-14; a saddle within 1e-10 is left so slowly that it counts as indifferent.
const NOISE: f64 = 1e-10;

/// Distances that a saddle is left by, in parts of ℓ and radians, both ways. Nearer than 0.01 the energy hardly falls; at
/// more than 0.3 the platform may come down in another valley.
const ESCAPES: [f64; 6] = [0.3, -0.3, 0.1, -0.1, 0.01, -0.01];

/// A point of lower energy beside a saddle, on the side and at the distance that lowers it most.
fn descend_from_saddle(search: &EnergySearch<'_>, here: &Trial, stiffness: &Mat6) -> Option<Trial> {
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

    /// The exit of a descent, and what rounding leaves.
    fn descent(robot: &Robot, start: Pose) -> (Trial, usize, Exit) {
        EnergySearch::new(robot, &LENGTHS, StaticModel::Catenary, &start).descend(start)
    }

    #[test]
    fn a_usual_search_ends_at_rest_or_at_rounding_within_a_few_iterations() {
        let robot = robot();
        let (here, iterations, exit) = descent(&robot, initial_pose::pose_from_lengths(&robot, &LENGTHS));
        assert!(matches!(exit, Exit::AtRest | Exit::AsFarAsRounding), "{exit:?}");
        assert!(here.residual < here.limit && iterations < 20, "{} after {iterations}", here.residual);
    }

    #[test]
    fn from_its_own_end_a_search_ends_at_once() {
        let robot = robot();
        let (first, ..) = descent(&robot, initial_pose::pose_from_lengths(&robot, &LENGTHS));
        let (second, iterations, exit) = descent(&robot, first.pose);
        assert!(matches!(exit, Exit::AtRest | Exit::AsFarAsRounding), "{exit:?}");
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

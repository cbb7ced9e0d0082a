//! Lengths to pose in a control loop.

use super::ControlLoop;
use super::input::{LoopInput, MAX_INPUT, check_pose};
use super::model::{LoopModel, MAX_CABLES};
use super::state::{LoopCable, LoopFault, LoopState, LoopStatus};
use crate::drive::CableInLoop;
use crate::math::{Mat6, Vec6};
use crate::platform::{Coordinates, balance};
use crate::robot::Pose;
use crate::statics::{self, LoadedCable, RESIDUAL_LIMIT, StaticModel, TensionRange, assembled};
use arrayvec::ArrayVec;

/// Maximum number of Newton steps; 2 to 4 are usual a millimetre from the last pose.
const MAX_STEPS: usize = 12;

/// Maximum number of halvings of a step that does not reduce the remaining wrench.
const MAX_HALVINGS: usize = 4;

/// Maximum rotation [rad], and translation over the mean length, of a step.
const MAX_TURN: f64 = 0.3;
const MAX_REACH: f64 = 0.1;

/// Step, over the size of the platform, that ends the search: Newton's method squares it.
const LAST_STEP: f64 = 1e-9;

/// Step, over the size of the cables, that is rounding.
const ROUNDING: f64 = 1e-14;

/// Maximum ratio of two steps with the same stiffness with which the bound of the error holds, (R 8) with θ ≤ ½.
const MAX_CONTRACTION: f64 = 0.5;

/// Pose from which the next search starts.
#[derive(Debug, Clone, Copy)]
pub(super) struct NearForward {
    pose: Pose,
}

/// Cables at a pose.
struct ForwardTrial {
    pose: Pose,
    cables: ArrayVec<CableInLoop, MAX_CABLES>,
    /// Remaining wrench, reduced, and its size over that of all forces.
    wrench: Vec6,
    residual: f64,
    /// Sum of the sizes of all forces [N].
    size: f64,
}

/// Lengths that are searched for.
struct WantedLengths<'a> {
    model: &'a LoopModel,
    lengths: &'a [f64],
    external: Vec6,
}

impl ControlLoop {
    /// Pose and tensions for unstrained lengths to the drums [m]. The search starts at `start`, or without it at the
    /// last pose of this loop, and finds the equilibrium next to it: a stable one is certified. `load` gives the
    /// external load and, as a motion, the inertia; its pose is not used.
    ///
    /// # Errors
    /// [`LoopFault`]: nothing is changed.
    pub fn forward(
        &mut self,
        model: &LoopModel,
        lengths: &[f64],
        load: Option<&LoopInput>,
        start: Option<&Pose>,
    ) -> Result<LoopState, LoopFault> {
        let is_length = |length: &f64| *length > 0.0 && *length <= MAX_INPUT;
        if lengths.len() != model.cables() || !lengths.iter().all(is_length) {
            return Err(LoopFault::BadInput);
        }
        let start = start.copied().or(self.near_forward.map(|near| near.pose)).or(self.last_pose);
        let start = start.ok_or(LoopFault::NoStart)?;
        let mut input = load.copied().unwrap_or_else(|| LoopInput::at_rest(&start));
        input.motion.pose = start;
        input.check(model.robot())?;

        let search = WantedLengths { model, lengths, external: input.wrench() };
        let Some(found) = search.newton(start) else {
            return Self::held(&mut self.last_forward, LoopFault::NotFound);
        };
        self.near_forward = Some(NearForward { pose: found.pose });
        self.last_pose = Some(found.pose);
        if found.status == LoopStatus::Certified {
            self.last_forward = Some(found);
        }
        Ok(found)
    }

    /// Pose and tensions for unstrained lengths from nothing, as [`statics::forward`]. It reserves memory and may take
    /// a thousand steps: for the start of a controller, not for its loop.
    ///
    /// # Errors
    /// [`LoopFault`]: nothing is changed.
    pub fn forward_cold(&mut self, model: &LoopModel, lengths: &[f64]) -> Result<LoopState, LoopFault> {
        let is_length = |length: &f64| *length > 0.0 && *length <= MAX_INPUT;
        if lengths.len() != model.cables() || !lengths.iter().all(is_length) {
            return Err(LoopFault::BadInput);
        }
        let rest = statics::forward(model.robot(), lengths, StaticModel::Catenary, None);
        let start = rest.map_err(|_| LoopFault::NotFound)?.pose;
        self.forward(model, lengths, None, Some(&start))
    }
}

impl WantedLengths<'_> {
    /// Cables at a pose, near those of another; `None` for a pose that the platform cannot have.
    fn at(&self, pose: Pose, near: Option<&ForwardTrial>) -> Option<ForwardTrial> {
        let robot = self.model.robot();
        check_pose(robot, &pose).ok()?;
        let mut cables = ArrayVec::<CableInLoop, MAX_CABLES>::new();
        for (i, (cable, length)) in robot.cables.iter().zip(self.lengths).enumerate() {
            let load = LoadedCable::at(robot, i, &pose, StaticModel::Catenary).load;
            let start_w = pose.point_w(&cable.attachment_p);
            let near = near.map(|near| &near.cables[i]);
            cables.push(CableInLoop::hang(start_w, cable, &load, *length, near)?);
        }
        let forces = cables.iter().map(|c| (c.span.force_on_start_w(), c.span.start_w - pose.position_w));
        let (wrench, size) = balance(robot, &pose, forces);
        let coordinates = self.model.coordinates();
        let size = size + coordinates.wrench_size(&self.external);
        let wrench = coordinates.reduce(&(wrench + self.external));
        let residual = larger(&coordinates, &wrench) / size.max(f64::MIN_POSITIVE);
        residual.is_finite().then_some(ForwardTrial { pose, cables, wrench, residual, size })
    }

    /// Stiffness at a pose, reduced, with a unit diagonal beyond the degrees of freedom.
    fn stiffness(&self, at: &ForwardTrial) -> Mat6 {
        let coordinates = self.model.coordinates();
        let parts =
            at.cables.iter().map(|c| (c.tangent_w(), c.span.force_on_start_w(), c.span.start_w - at.pose.position_w));
        let mut stiffness = coordinates.reduce_symmetric(&assembled(self.model.robot(), &at.pose, parts));
        (coordinates.count()..6).for_each(|k| stiffness[(k, k)] = 1.0);
        stiffness
    }

    /// Newton's method from a pose; `None` if it does not find a balance in its number of steps.
    fn newton(&self, start: Pose) -> Option<LoopState> {
        let coordinates = self.model.coordinates();
        let mut here = self.at(start, None)?;
        for step_count in 1..=MAX_STEPS {
            let matrix = self.stiffness(&here);
            let factor = matrix.cholesky();
            let step = match &factor {
                Some(factor) => factor.solve(&here.wrench),
                None => matrix.lu().solve(&here.wrench)?,
            };
            let (mut part, turn, reach) = self.limited(&step);
            let size = turn.max(reach);
            if !size.is_finite() {
                return None;
            }

            // Shorten the step until the remaining wrench falls; at rounding any step will do.
            let next = (0..=MAX_HALVINGS).find_map(|_| {
                let next = self.at(coordinates.moved(&here.pose, &(step * part)), Some(&here));
                part *= 0.5;
                next.filter(|next| next.residual < here.residual.max(RESIDUAL_LIMIT))
            })?;
            let is_last = size <= LAST_STEP;
            if is_last && next.residual <= RESIDUAL_LIMIT {
                // A further step with the same stiffness bounds the error, (R 8).
                let again = factor.as_ref().map(|factor| factor.solve(&next.wrench));
                let error = again.and_then(|again| error_bound(&step, &again, self.mean_length()));
                return Some(self.collected(&next, step_count, error));
            }
            here = next;
        }
        None
    }

    fn mean_length(&self) -> f64 {
        self.lengths.iter().sum::<f64>() / self.lengths.len() as f64
    }

    /// Largest part of a step that is allowed, with its rotation [rad] and its translation over the mean length.
    fn limited(&self, step: &Vec6) -> (f64, f64, f64) {
        let coordinates = self.model.coordinates();
        let motion = coordinates.expand(step);
        let turn = motion.fixed_rows::<3>(3).norm() / coordinates.ell();
        let reach = motion.fixed_rows::<3>(0).norm() / self.mean_length();
        ((MAX_TURN / turn).min(MAX_REACH / reach).min(1.0), turn, reach)
    }

    /// State at a pose; `error` is the bound of its error [m], `None` if the equilibrium is not proved to be stable and
    /// near.
    fn collected(&self, at: &ForwardTrial, iterations: usize, error: Option<f64>) -> LoopState {
        let robot = self.model.robot();
        let mut cables = [LoopCable::default(); MAX_CABLES];
        for (i, (cable, length)) in at.cables.iter().zip(self.lengths).enumerate() {
            let drum = cable.tension_drum();
            let range = TensionRange::of(robot, i, &cable.span.chord_w());
            cables[i] = LoopCable {
                length: *length,
                free_length: cable.span.catenary.rope().unstrained_length,
                tension_platform: cable.span.catenary.tension_at_start(),
                tension_drum: drum,
                margin: range.margin_of_span(&cable.span, drum).distance(),
                ..LoopCable::default()
            };
        }
        let state = LoopState {
            status: LoopStatus::Certified,
            age: 0,
            iterations: u32::try_from(iterations).unwrap_or(u32::MAX),
            pose: at.pose,
            error_force: at.residual * at.size,
            error_length: error.unwrap_or(LAST_STEP * self.mean_length()),
            least_margin: 0.0,
            least_margin_cable: 0,
            missing: None,
            cables,
        };
        let mut state = state.with_margins(self.model.cables());
        if state.least_margin < 0.0 {
            state.status = LoopStatus::BeyondLimits;
        } else if error.is_none() {
            state.status = LoopStatus::Accepted;
        }
        state
    }
}

/// Larger of force and moment/ℓ of a reduced wrench [N].
fn larger(coordinates: &Coordinates, reduced: &Vec6) -> f64 {
    let wrench = coordinates.expand(reduced);
    wrench.fixed_rows::<3>(0).norm().max(wrench.fixed_rows::<3>(3).norm())
}

/// Bound of the error after two steps with the same stiffness [m]; `None` if they do not contract.
fn error_bound(first: &Vec6, second: &Vec6, size: f64) -> Option<f64> {
    let (first, second) = (first.norm(), second.norm());
    let rounding = ROUNDING * size;
    if second <= rounding {
        return Some(rounding);
    }
    let contraction = second / first;
    (contraction <= MAX_CONTRACTION).then(|| second * contraction / (1.0 - contraction) + rounding)
}

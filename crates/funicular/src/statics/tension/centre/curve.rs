//! Cable whose tension along the chord varies while the pose is held, its exit point following, and its limits.

use super::corners::{RoundedTension, SpanForces};
use crate::catenary::space::HangingCable;
use crate::catenary::{Catenary, Rope};
use crate::drive::derivatives::{DriveDerivatives, OuterRow, VARIABLES, place};
use crate::drive::{BeyondExit, CableAtRest, tension_at_drum};
use crate::math::{Rotation, Vec3};
use crate::robot::{Cable, Pose, PulleyContact, Robot};
use crate::statics::equilibrium::CableState;
use crate::statics::error::StaticsError;
use crate::statics::exit_points;
use crate::statics::limits::MinimumTension;
use crate::statics::loaded_cable::LoadedCable;
use crate::statics::model::StaticModel;

/// Maximum number of Newton steps for a limit of τ, a guard: 3 are usual.
const MAX_STEPS: usize = 30;

/// Step over τ after which the next value is the limit: Newton's method squares it, and over a pulley it falls by a
/// thousandth a step.
const LAST_STEP: f64 = 1e-11;

/// Last step of a search that begins at the limit of a pose nearby: a step this small leaves less than [`LAST_STEP`].
const LAST_STEP_NEAR: f64 = 1e-8;

/// Minimum slope of a tension by τ; see `MIN_SLOPE` in `tension/search.rs`.
const MIN_SLOPE: f64 = 1e-3;

/// Minimum ratio of span to chord from which on the derivative by τ counts the motion of the exit point. A vertical
/// cable has no direction in which its horizontal force acts.
const MIN_COSINE: f64 = 1e-6;

/// Step of differences over the size of what changes. They are of the fourth order: the step leaves 1e-12 of a second
/// derivative, and rounding leaves 1e-12.
const PART: f64 = 1e-3;

/// Cable at a pose as a curve over its tension τ parallel to the chord.
#[derive(Debug, Clone)]
pub(crate) struct TensionCurve<'a> {
    robot: &'a Robot,
    i: usize,
    pub(crate) span: HangingCable,
    /// Place on the pulley; `None` without one.
    contact: Option<PulleyContact>,
    tau: f64,
}

/// Limit of τ that a limit of the tensions sets.
#[derive(Debug, Clone)]
pub(crate) struct TauLimit<'a> {
    /// Cable at the limit.
    pub(crate) curve: TensionCurve<'a>,
    /// Kind of the limit.
    pub(crate) kind: TauLimitKind,
}

/// Kinds of limits of τ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum TauLimitKind {
    /// Lowest tension in the cable at its minimum.
    Minimum(MinimumTension),
    /// Slackest cable that is considered, (37).
    Slackest,
    /// Highest tension in the cable at its maximum.
    Maximum,
}

/// Force of a cable by τ: first and second derivatives in its plane. The second ones hold the exit point.
pub(super) struct ForceByTau {
    /// World axes [-].
    pub(super) first_w: Vec3,
    /// Upwards [1/N]; the horizontal force is a straight line.
    pub(super) second_up: f64,
}

impl<'a> TensionCurve<'a> {
    /// Cable `i` with any tension.
    ///
    /// # Errors
    /// [`StaticsError::InsidePulley`].
    pub(super) fn new(robot: &'a Robot, i: usize, pose: &Pose, model: StaticModel) -> Result<Self, StaticsError> {
        exit_points::straight_contact(&robot.cables[i], pose)?;
        Ok(Self::at(robot, i, pose, model))
    }

    /// Cable `i` with any tension, its attachment outside the wheel of its pulley.
    pub(crate) fn at(robot: &'a Robot, i: usize, pose: &Pose, model: StaticModel) -> Self {
        let loaded = LoadedCable::at(robot, i, pose, model);
        let cable = &robot.cables[i];
        let contact = cable.anchor.contact(&pose.point_w(&cable.attachment_p));
        let weight = loaded.load.size * loaded.chord_w(pose).norm();
        let tau = 6.0 * Catenary::MIN_TENSION_TO_WEIGHT * weight;
        let span = loaded.hang_with_tension(pose, tau);
        Self { robot, i, span, contact, tau }
    }

    /// Cable `i` of an equilibrium.
    pub(crate) fn of_state(robot: &'a Robot, i: usize, state: &CableState) -> Option<Self> {
        let span = state.hanging.clone()?;
        let contact = state.drive.as_ref().and_then(|drive| drive.contact);
        let tau = span.catenary.parallel_tension();
        Some(Self { robot, i, span, contact, tau })
    }

    pub(crate) fn cable(&self) -> &'a Cable {
        &self.robot.cables[self.i]
    }

    /// Parallel tension τ [N].
    pub(crate) fn tau(&self) -> f64 {
        self.tau
    }

    /// True if the exit point moves with the tension.
    pub(super) fn has_moving_exit(&self) -> bool {
        self.contact.is_some() && self.weight_per_length() > 0.0
    }

    fn weight_per_length(&self) -> f64 {
        self.span.catenary.rope().weight_per_length
    }

    /// Hangs the cable with another τ [N].
    pub(crate) fn set(&mut self, tau: f64) {
        match self.contact.filter(|_| self.has_moving_exit()) {
            Some(contact) => {
                let (span, contact) = exit_points::at_own_exit_point(self.cable(), &self.span, contact, tau);
                (self.span, self.contact) = (span, Some(contact));
            }
            None => self.span = self.span.at_parallel_tension(tau),
        }
        self.tau = tau;
    }

    /// Slackest τ that is considered, (37) [N].
    pub(crate) fn slackest(&self) -> f64 {
        Catenary::MIN_TENSION_TO_WEIGHT * self.weight_per_length() * self.span.chord_w().norm()
    }

    /// Forces that give the lowest and the highest tension.
    pub(crate) fn forces(&self) -> SpanForces {
        let catenary = &self.span.catenary;
        SpanForces {
            horizontal: catenary.horizontal_force(),
            vertical: 0.5 * (catenary.vertical_force_at_start() + catenary.vertical_force_at_end()),
            weight: catenary.weight(),
            drum: self.contact.as_ref().map(|contact| tension_at_drum(&self.span, Some(contact))),
        }
    }

    /// Minimum tension of the cable [N], which by default depends on its chord.
    fn minimum(&self, kind: MinimumTension) -> f64 {
        match kind {
            MinimumTension::Given(value) => value,
            MinimumTension::OfCable { factor } => {
                let robot = self.robot;
                let chord_w = self.span.chord_w();
                let sags = self.weight_per_length() > 0.0;
                let load = if sags { self.weight_per_length() } else { robot.line_load(self.i, &chord_w).size };
                factor * load * chord_w.norm()
            }
            MinimumTension::OfPlatform { factor } => factor * self.robot.platform.mass * self.robot.gravity_w.norm(),
        }
    }

    /// Limits of τ: the tensions at which the lowest tension in the cable is at its minimum, and the highest one at its
    /// maximum. The maximum has to be finite.
    pub(crate) fn limits(&self) -> [TauLimit<'a>; 2] {
        self.limits_near(None)
    }

    /// Limits of τ by [`Self::limits`], searched from values near them.
    pub(super) fn limits_near(&self, near: Option<[f64; 2]>) -> [TauLimit<'a>; 2] {
        let near = near.filter(|_| self.weight_per_length() > 0.0);
        let last_step = if near.is_some() { LAST_STEP_NEAR } else { LAST_STEP };
        let chord_w = self.span.chord_w();
        let minimum = MinimumTension::of(self.robot, self.i, &chord_w);
        let maximum = self.cable().limits().maximum.unwrap_or(f64::INFINITY);

        let mut lower = self.clone();
        let start = near.map_or_else(|| lower.minimum(minimum), |[lower, _]| lower);
        let is_slackest = lower.search((start, last_step), SpanForces::lowest, |curve| curve.minimum(minimum));
        let kind = if is_slackest { TauLimitKind::Slackest } else { TauLimitKind::Minimum(minimum) };
        let lower = TauLimit { curve: lower, kind };

        let mut upper = self.clone();
        let start = near.map_or(maximum, |[_, upper]| upper);
        upper.search((start, last_step), SpanForces::highest, |_| maximum);
        [lower, TauLimit { curve: upper, kind: TauLimitKind::Maximum }]
    }

    /// Hangs the cable with the τ at which a tension has this value, or with the slackest τ if that is higher; true in
    /// the latter case. The search has a start, and a relative step that is its last.
    fn search(
        &mut self,
        (start, last_step): (f64, f64),
        tension: impl Fn(&SpanForces) -> RoundedTension,
        wanted: impl Fn(&Self) -> f64,
    ) -> bool {
        if self.weight_per_length() == 0.0 {
            self.set(start.max(0.0));
            return false;
        }
        let mut is_slackest = false;
        self.set(start.max(self.slackest()));
        for _ in 0..MAX_STEPS {
            let found = tension(&self.forces());
            let next = self.tau + (wanted(self) - found.value) / self.slope(&found).max(MIN_SLOPE);
            let slackest = self.slackest();
            is_slackest = next < slackest;
            let next = next.max(slackest);
            let is_last = (next - self.tau).abs() <= last_step * next;
            self.set(next);
            if is_last {
                break;
            }
        }
        is_slackest
    }

    /// Derivative of a tension by τ, the exit point held; that at the drum grows like that of the span.
    fn slope(&self, tension: &RoundedTension) -> f64 {
        let by_tau = self.span.catenary.by_parallel_tension();
        let [cos, _] = self.span.catenary.chord_direction();
        let weight = self.weight_per_length() * by_tau.length[0];
        let vertical = by_tau.vertical_at_start[0] + 0.5 * weight;
        tension.by_horizontal * cos + tension.by_vertical * vertical + tension.by_weight * weight + tension.by_drum
    }

    /// Force on the platform by τ. `follows` lets the exit point follow in the first derivative.
    pub(super) fn force_by_tau(&self, follows: bool) -> ForceByTau {
        let by_tau = self.span.catenary.by_parallel_tension();
        let second_up = by_tau.vertical_at_start[1];
        if follows && let Some(first_w) = self.force_by_tau_with_exit() {
            return ForceByTau { first_w, second_up };
        }
        let [cos, _] = self.span.catenary.chord_direction();
        let (along_w, up_w) = self.span.axes_w();
        ForceByTau { first_w: along_w * cos + up_w * by_tau.vertical_at_start[0], second_up }
    }

    /// Derivative of the force on the platform along the curve, whose exit point follows: (60t2). `None` for a fixed
    /// exit point and for a cable that is vertical.
    fn force_by_tau_with_exit(&self) -> Option<Vec3> {
        let contact = self.contact.filter(|_| self.has_moving_exit())?;
        force_by_tau_over_pulley(self.cable(), &self.span, contact)
    }

    /// Second derivatives of the force on the platform, as far as it acts along a vector: of [`Self::force_by_tau`] by
    /// the outer variables of the cable at the same τ, and by τ in the place of the length. The winch and the drum side
    /// do not count at the same τ. `None` as there.
    pub(crate) fn second_by_outer(&self, along_w: &Vec3) -> Option<OuterRow> {
        let contact = self.contact.filter(|_| self.has_moving_exit())?;
        let rope = self.span.catenary.rope();
        let mut row = [0.0; VARIABLES];
        for (variable, by) in row.iter_mut().enumerate() {
            let size = match variable {
                place::REACH..place::LOAD => self.span.chord_w().norm(),
                place::LOAD..place::AXIAL_STIFFNESS => rope.weight_per_length,
                place::AXIAL_STIFFNESS => rope.axial_stiffness,
                place::RADIUS => contact.radius,
                place::LENGTH => self.tau,
                place::DRUM_SIDE | place::COMPLIANCE => continue,
                _ => 1.0,
            };
            let at = |parts: f64| {
                let force_w = self.force_by_tau_after(contact, variable, parts * PART * size)?;
                Some(along_w.dot(&force_w))
            };
            *by = (8.0 * (at(1.0)? - at(-1.0)?) - (at(2.0)? - at(-2.0)?)) / (12.0 * PART * size);
        }
        Some(row)
    }

    /// Derivative of the force by τ after a change of one of the variables of [`Self::second_by_outer`].
    fn force_by_tau_after(&self, contact: PulleyContact, variable: usize, change: f64) -> Option<Vec3> {
        let unit = |k: usize| Vec3::from_fn(|i, _| f64::from(u8::from(i == k)));
        let mut cable = self.cable().clone();
        let (mut load_w, mut rope, mut tau) = (self.span.load_w(), self.span.catenary.rope(), self.tau);
        match variable {
            place::REACH..place::LOAD => cable.anchor.point_w += unit(variable - place::REACH) * change,
            place::LOAD..place::AXIAL_STIFFNESS => load_w += unit(variable - place::LOAD) * change,
            place::AXIAL_STIFFNESS => rope.axial_stiffness += change,
            place::LENGTH => tau += change,
            _ => {}
        }
        if let Some(pulley) = &mut cable.anchor.pulley {
            match variable {
                place::RADIUS => pulley.radius += change,
                place::TURN..place::DRUM_SIDE => {
                    let turn = Rotation::from_scaled_axis(unit(variable - place::TURN) * change);
                    pulley.entry_direction_w = turn * pulley.entry_direction_w;
                }
                _ => {}
            }
        }

        let rope = Rope { weight_per_length: load_w.norm(), ..rope };
        let up_w = -load_w / rope.weight_per_length;
        let span = HangingCable::with_parallel_tension(self.span.start_w, self.span.end_w, up_w, rope, tau);
        let (span, contact) = exit_points::at_own_exit_point(&cable, &span, contact, tau);
        force_by_tau_over_pulley(&cable, &span, contact)
    }

    /// Cable beyond the free span with its present tension.
    pub(crate) fn beyond_exit(&self) -> BeyondExit {
        BeyondExit::of(&self.span, &self.cable().anchor, self.contact.as_ref())
    }

    /// Hangs the cable with the τ at which the tension at its drum, or at its anchor without one, has a value [N]; true
    /// if there is one above the slackest τ.
    pub(crate) fn set_drum_tension(&mut self, wanted: f64) -> bool {
        let slackest = self.slackest();
        self.set(wanted.max(slackest));
        for _ in 0..MAX_STEPS {
            let step = (wanted - self.beyond_exit().tension_drum) / self.end_slope().max(MIN_SLOPE);
            let next = self.tau + step;
            if next.is_nan() || next < slackest && self.tau <= slackest {
                return false;
            }
            let next = next.max(slackest);
            let is_last = step.abs() <= LAST_STEP * next;
            self.set(next);
            if is_last {
                return true;
            }
        }
        false
    }

    /// Derivative of the tension at the end of the span by τ, the exit point held; that at the drum grows like it.
    fn end_slope(&self) -> f64 {
        let catenary = &self.span.catenary;
        let by_tau = catenary.by_parallel_tension();
        let [cos, _] = catenary.chord_direction();
        let vertical = by_tau.vertical_at_start[0] + self.weight_per_length() * by_tau.length[0];
        let (h, v) = (catenary.horizontal_force(), catenary.vertical_force_at_end());
        (h * cos + v * vertical) / h.hypot(v).max(f64::MIN_POSITIVE)
    }

    /// Cable at rest with its present tension, drum side and winch included.
    pub(crate) fn at_rest(&self) -> CableAtRest {
        CableAtRest::with_span(self.span.clone(), &self.cable().anchor, self.contact)
    }
}

/// Derivative of the force on the platform by τ for a cable with weight over a pulley, the exit point following; `None`
/// for a vertical one.
fn force_by_tau_over_pulley(cable: &Cable, span: &HangingCable, contact: PulleyContact) -> Option<Vec3> {
    let derivatives = DriveDerivatives::of(span, &cable.anchor, Some(&contact))?;
    let column = |rows: &[OuterRow; 3]| Vec3::from_fn(|k, _| rows[k][place::LENGTH]);
    let (force, chord) = (column(&derivatives.force_w), column(&derivatives.chord_w));

    // τ = H l/x, with horizontal force H, chord l and span x.
    let (along_w, _) = span.axes_w();
    let (chord_w, x) = (span.chord_w(), span.catenary.span());
    let square = chord_w.norm_squared();
    if x * x < MIN_COSINE * MIN_COSINE * square {
        return None;
    }
    let by_length = span.catenary.parallel_tension()
        * (along_w.dot(&force) / span.catenary.horizontal_force() + chord_w.dot(&chord) / square
            - along_w.dot(&chord) / x);
    Some(force / by_length)
}

//! Cable whose tension along the chord varies while the pose is held, its exit point following, and its limits.

mod second;

use super::corners::{RoundedTension, SpanForces};
use crate::catenary::Catenary;
use crate::catenary::space::HangingCable;
use crate::drive::at_tension::AtTension;
use crate::drive::{BeyondExit, CableAtRest, tension_at_drum};
use crate::math::{Mat3, Vec3};
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

/// Last step of a search that begins at the limit of a pose nearby: a step this small leaves less than [`LAST_STEP`],
/// because tensions are nearly straight lines over τ.
const LAST_STEP_NEAR: f64 = 3e-7;

/// Maximum number of steps for a place on a pulley; 1 to 4 are usual.
const MAX_PLACE_STEPS: usize = 12;

/// Maximum step of wrap and swivel angle [rad] and of the free length over itself; beyond it the place is searched by
/// rounds.
const MAX_PLACE_STEP: f64 = 0.3;

/// Next step of a place that is rounding.
const LAST_PLACE_STEP: f64 = 1e-15;

/// Ratio of two steps above which the derivatives are computed again.
const SLOW: f64 = 0.02;

/// Minimum wrap angle [rad]: near zero the swivel angle has hardly an effect.
const MIN_WRAP: f64 = 1e-3;

/// Part of the last step that a step by a slope with a held exit point may have: such a slope is a thousandth off.
const HELD_SLOPE: f64 = 1e-3;

/// Minimum slope of a tension by τ; see `MIN_SLOPE` in `tension/search.rs`.
const MIN_SLOPE: f64 = 1e-3;

/// Cable at a pose as a curve over its tension τ parallel to the chord.
#[derive(Debug, Clone)]
pub(crate) struct TensionCurve<'a> {
    robot: &'a Robot,
    i: usize,
    pub(crate) span: HangingCable,
    /// Place on the pulley; `None` without one.
    contact: Option<PulleyContact>,
    tau: f64,
    /// Inverse derivatives of the conditions for the place on the pulley, at some place nearby.
    place: Option<Mat3>,
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
        Self { robot, i, span, contact, tau, place: None }
    }

    /// Cable `i` of an equilibrium.
    pub(crate) fn of_state(robot: &'a Robot, i: usize, state: &CableState) -> Option<Self> {
        let span = state.hanging.clone()?;
        let contact = state.drive.as_ref().and_then(|drive| drive.contact);
        let tau = span.catenary.parallel_tension();
        Some(Self { robot, i, span, contact, tau, place: None })
    }

    pub(crate) fn cable(&self) -> &'a Cable {
        &self.robot.cables[self.i]
    }

    pub(super) fn robot(&self) -> &'a Robot {
        self.robot
    }

    pub(super) fn index(&self) -> usize {
        self.i
    }

    /// Cable in the form in which its tension is given.
    pub(super) fn at_tension(&self) -> AtTension<'a, f64> {
        at_tension(self.cable(), &self.span, self.contact)
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
                let (span, contact) = self
                    .at_place(contact, tau)
                    .unwrap_or_else(|| exit_points::at_own_exit_point(self.cable(), &self.span, contact, tau));
                (self.span, self.contact) = (span, Some(contact));
            }
            None => self.span = self.span.at_parallel_tension(tau),
        }
        self.tau = tau;
    }

    /// Span with another τ [N] and its place on the pulley, by Newton's method from the present place with derivatives
    /// that are computed again only if they are too far away. `None` if it does not converge there.
    fn at_place(&mut self, mut contact: PulleyContact, tau: f64) -> Option<(HangingCable, PulleyContact)> {
        let mut rope = self.span.catenary.rope();
        let mut given = self.at_tension();
        let mut last = f64::INFINITY;
        for _ in 0..MAX_PLACE_STEPS {
            given.contact = Some(contact);
            let is_fresh = self.place.is_none();
            let (inverse, conditions) = if let Some(inverse) = self.place {
                (inverse, given.span(tau, &[0.0, 0.0, rope.unstrained_length]).conditions)
            } else {
                given.place_by(tau, rope.unstrained_length)?
            };
            self.place = Some(inverse);
            let step = -inverse * Vec3::from(conditions);
            let size = step[0].abs().max(step[1].abs()).max(step[2].abs() / rope.unstrained_length);
            contact = contact.turned(step[0], step[1]);
            rope.unstrained_length += step[2];
            if size.is_nan() || size > MAX_PLACE_STEP || contact.wrap < MIN_WRAP {
                self.place = None;
                return None;
            }

            // The size of the next step, by the square or by the ratio of the last two.
            let ratio = if last.is_finite() { size / last } else { SLOW };
            let next = if is_fresh { size * size } else { size * ratio };
            if next <= LAST_PLACE_STEP {
                let (end_w, up_w) = (self.cable().anchor.point_w + contact.exit_offset_w(), self.span.axes_w().1);
                let span = HangingCable::with_parallel_tension(self.span.start_w, end_w, up_w, rope, tau);
                return Some((span, contact));
            }
            if !is_fresh && size > SLOW * last {
                self.place = None;
            }
            last = size;
        }
        self.place = None;
        None
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

    /// Source of the minimum tension at the present chord.
    pub(super) fn minimum_kind(&self) -> MinimumTension {
        MinimumTension::of(self.robot, self.i, &self.span.chord_w())
    }

    /// Minimum tension of the cable [N], which by default depends on its chord.
    pub(super) fn minimum(&self, kind: MinimumTension) -> f64 {
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
        let is_near = near.is_some();
        let last_step = if is_near { LAST_STEP_NEAR } else { LAST_STEP };
        let minimum = self.minimum_kind();
        let maximum = self.cable().limits().maximum.unwrap_or(f64::INFINITY);

        let mut lower = self.clone();
        let start = near.map_or_else(|| lower.minimum(minimum), |[lower, _]| lower);
        let is_slackest = lower.search((start, last_step, is_near), SpanForces::lowest, |curve| curve.minimum(minimum));
        let kind = if is_slackest { TauLimitKind::Slackest } else { TauLimitKind::Minimum(minimum) };
        let lower = TauLimit { curve: lower, kind };

        let mut upper = self.clone();
        let start = near.map_or(maximum, |[_, upper]| upper);
        upper.search((start, last_step, is_near), SpanForces::highest, |_| maximum);
        [lower, TauLimit { curve: upper, kind: TauLimitKind::Maximum }]
    }

    /// Hangs the cable with the τ at which a tension has this value, or with the slackest τ if that is higher; true in
    /// the latter case. The search has a start, and a relative step that is its last. `is_near` leaves the cable where
    /// it was before that step, and changes τ alone.
    fn search(
        &mut self,
        (start, last_step, is_near): (f64, f64, bool),
        tension: impl Fn(&SpanForces) -> RoundedTension,
        wanted: impl Fn(&Self) -> f64,
    ) -> bool {
        if self.weight_per_length() == 0.0 {
            self.set(start.max(0.0));
            return false;
        }
        let mut is_slackest = false;
        self.set(start.max(self.slackest()));
        let mut last: Option<[f64; 2]> = None;
        for _ in 0..MAX_STEPS {
            // The exit point follows in the slope between two places, and is held in the first one.
            let (found, wanted) = (tension(&self.forces()), wanted(self));
            let missing = wanted - found.value;
            let slope = match last {
                Some([tau, before]) if (self.tau - tau).abs() > 0.0 && self.has_moving_exit() => {
                    (before - missing) / (self.tau - tau)
                }
                _ => self.slope(&found),
            };
            let trusted = if last.is_none() && self.has_moving_exit() { HELD_SLOPE * last_step } else { last_step };
            last = Some([self.tau, missing]);
            let next = self.tau + missing / slope.max(MIN_SLOPE);
            let slackest = self.slackest();
            is_slackest = next < slackest;
            let next = next.max(slackest);
            let is_last = (next - self.tau).abs() <= trusted * next;
            if is_last && is_near {
                self.tau = next;
                break;
            }
            self.set(next);
            if is_last {
                break;
            }
        }
        is_slackest
    }

    /// Derivative of a tension by τ, the exit point held; that at the drum grows like that of the span.
    fn slope(&self, tension: &RoundedTension) -> f64 {
        let catenary = &self.span.catenary;
        let [cos, _] = catenary.chord_direction();
        let by_tau = catenary.parallel_tension_by_length().recip();
        let weight = self.weight_per_length() * by_tau;
        let vertical = catenary.start_force_by_length()[1] * by_tau + 0.5 * weight;
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
    /// exit point.
    fn force_by_tau_with_exit(&self) -> Option<Vec3> {
        let contact = self.contact.filter(|_| self.has_moving_exit())?;
        force_by_tau_over_pulley(self.cable(), &self.span, contact, self.tau)
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
/// if the conditions do not determine the exit point.
fn force_by_tau_over_pulley(cable: &Cable, span: &HangingCable, contact: PulleyContact, tau: f64) -> Option<Vec3> {
    let length = span.catenary.rope().unstrained_length;
    Some(at_tension(cable, span, Some(contact)).by_tension(tau, length)?.force_w)
}

/// Cable of a span whose tension is given.
fn at_tension<'a>(cable: &'a Cable, span: &HangingCable, contact: Option<PulleyContact>) -> AtTension<'a, f64> {
    let rope = span.catenary.rope();
    AtTension {
        start_w: span.start_w.into(),
        load: rope.weight_per_length,
        up_w: span.axes_w().1.into(),
        axial_stiffness: rope.axial_stiffness,
        anchor: &cable.anchor,
        contact,
        load_turns: false,
    }
}

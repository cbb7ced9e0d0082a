//! Place of a cable on its pulley and length of its free span, for a given length of the whole cable.
//!
//! Newton's method on the wrap angle, the swivel angle and the unstrained length of the free span. If it does not
//! converge, a slower method solves the conditions one after the other. Where a slack cable hangs beside a large wheel,
//! neither may converge; then the cable is paid out from taut to its length in steps, each solved by Newton's method.

use super::arc::Beyond;
use super::{CableAtRest, end_force_w};
use crate::catenary::Rope;
use crate::catenary::space::HangingCable;
use crate::math::{Mat3, Vec3};
use crate::robot::{Anchor, LineLoad, Pulley, PulleyContact, Winch};

/// Relative size of Newton's step below which the next state is the solution. The derivatives leave out the change of
/// the weight on the arc, at most a thousandth of the rest, so the error after such a step is below rounding.
const LAST_STEP: f64 = 1e-11;

/// Maximum number of Newton steps, a guard: a search that does not converge is left to the slow method.
const MAX_STEPS: usize = 30;

/// Maximum change of an angle per step [rad]; at half a radian the directions differ from their first order by an
/// eighth.
const MAX_TURN: f64 = 0.5;

/// Minimum ratio of the free length after a step to that before.
const MIN_SHORTENED: f64 = 0.2;

/// Maximum number of halvings of a step that does not reduce the imbalance.
const MAX_HALVINGS: usize = 8;

/// Residual below which a step is taken although it does not reduce the residual, because rounding is as large.
const ROUNDING: f64 = 1e-13;

/// Maximum number of rounds of the slow method, and of steps for one length. Each round reduces the change of the
/// angles by the ratio of the radius to the span; each step at least halves an interval.
const MAX_ROUNDS: usize = 200;
const MAX_LENGTH_STEPS: usize = 100;

/// Change of the angles [rad] per round of the slow method at which it ends.
const LAST_TURN: f64 = 1e-14;

/// Imbalance above which the slow method has not converged. Of 300,000 random cables Newton's method left 695; the slow
/// method solved some of them to 5e-16, and came back to the same places in the others with more than 3e-3.
const NOT_BALANCED: f64 = 1e-10;

/// Tensions of the taut cable from which a cable is paid out, as multiples of the weight of its chord, in the order in
/// which they are tried. With the first one it sags by a fortieth of the chord. With it alone, 7 of 300,000 random
/// cables were not found; with all three, none.
const TAUT: [f64; 3] = [5.0, 50.0, 500.0];

/// Minimum step of paying out, as a fraction of the whole way, below which no solution is found.
const MIN_PAID_OUT: f64 = 1e-4;

/// Cable of a given unstrained length over its anchor's pulley or to its winch. `rope` has the whole unstrained length.
///
/// # References
/// docs/theory.md, equations (65) to (67).
pub(super) fn at_length(start_w: Vec3, anchor: &Anchor, load: &LineLoad, rope: Rope) -> CableAtRest {
    let problem = Problem { start_w, anchor, load, rope };
    let straight = problem.straight();
    if load.size == 0.0 {
        return problem.collected(straight);
    }

    let found = problem.newton(straight).unwrap_or_else(|| {
        let slow = problem.one_after_the_other(straight);
        let is_balanced = problem.at(slow).imbalance.amax() <= NOT_BALANCED;
        if is_balanced { slow } else { problem.paid_out().unwrap_or(slow) }
    });
    problem.collected(found)
}

/// Free span and place on the pulley by [`at_length`], by Newton's method alone, from `start` and then from a straight
/// cable; `None` if neither converges.
pub(super) fn at_length_near(
    start_w: Vec3,
    anchor: &Anchor,
    load: &LineLoad,
    rope: Rope,
    start: Option<Unknowns>,
) -> Option<(HangingCable, Option<PulleyContact>)> {
    let problem = Problem { start_w, anchor, load, rope };
    let straight = problem.straight();
    let found = if load.size == 0.0 {
        straight
    } else {
        start.and_then(|start| problem.newton(start)).or_else(|| problem.newton(straight))?
    };
    Some((problem.span(&found), found.contact))
}

/// Place on the pulley at which a span would leave it along its tangent with the swivel in balance, if its exit point
/// did not move; `None` without a pulley.
pub(crate) fn contact_of_span(
    span: &HangingCable,
    anchor: &Anchor,
    contact: Option<&PulleyContact>,
) -> Option<PulleyContact> {
    let (pulley, contact) = (anchor.pulley.as_ref()?, contact?);
    Some(follow(pulley, span, contact, Beyond::kink_of(span, anchor, contact)))
}

/// Unknowns of a cable: its place on the pulley, if it has one, and the unstrained length of its free span.
#[derive(Debug, Clone, Copy)]
pub(super) struct Unknowns {
    pub(super) contact: Option<PulleyContact>,
    pub(super) free_length: f64,
}

/// Cable whose unknowns are searched.
struct Problem<'a> {
    start_w: Vec3,
    anchor: &'a Anchor,
    load: &'a LineLoad,
    /// Rope with the whole unstrained length.
    rope: Rope,
}

/// State of the search.
struct Trial {
    unknowns: Unknowns,
    span: HangingCable,
    beyond: Beyond,
    /// Conditions: force across the tangent and sideways over the tension, missing length over the whole length.
    imbalance: Vec3,
}

impl Problem<'_> {
    /// Unknowns of a straight cable without weight.
    fn straight(&self) -> Unknowns {
        let contact = self.anchor.contact(&self.start_w);
        let exit_w = self.exit_w(contact.as_ref());
        let (chord, length) = ((exit_w - self.start_w).norm(), self.rope.unstrained_length);
        let beyond = contact.map_or(0.0, |contact| contact.arc()) + self.anchor.drum_side_length();

        // All pieces have the same tension: (chord + beyond − yield T)/λ = L.
        let by_tension = self.anchor.winch.as_ref().map_or(0.0, Winch::compliance);
        let tension = (chord + beyond - length) / (length / self.rope.axial_stiffness + by_tension);
        let free_length =
            if tension > 0.0 { chord / (1.0 + tension / self.rope.axial_stiffness) } else { length - beyond };
        Unknowns { contact, free_length }
    }

    fn exit_w(&self, contact: Option<&PulleyContact>) -> Vec3 {
        self.anchor.point_w + contact.map_or_else(Vec3::zeros, PulleyContact::exit_offset_w)
    }

    fn span(&self, unknowns: &Unknowns) -> HangingCable {
        let rope = Rope { unstrained_length: unknowns.free_length, ..self.rope };
        HangingCable::between(self.start_w, self.exit_w(unknowns.contact.as_ref()), self.load.up_w, rope)
    }

    fn collected(&self, unknowns: Unknowns) -> CableAtRest {
        CableAtRest::with_span(self.span(&unknowns), self.anchor, unknowns.contact)
    }

    fn at(&self, unknowns: Unknowns) -> Trial {
        let span = self.span(&unknowns);
        let beyond = Beyond::of(&span, self.anchor, unknowns.contact.as_ref());
        let missing = unknowns.free_length + beyond.length() - self.rope.unstrained_length;
        let [across, sideways] = unknowns.contact.map_or([0.0; 2], |contact| {
            let tension = beyond.tension.max(f64::MIN_POSITIVE);
            let force_w = Vec3::from(beyond.force_w);
            let across = contact.exit_normal_w().dot(&force_w) / tension;
            [across, contact.sideways_w.dot(&force_w) / tension - beyond.kink.sin()]
        });
        let imbalance = Vec3::new(across, sideways, missing / self.rope.unstrained_length);
        Trial { unknowns, span, beyond, imbalance }
    }

    /// Newton's method with shortened steps; `None` if it does not converge.
    fn newton(&self, start: Unknowns) -> Option<Unknowns> {
        let mut here = self.at(start);
        for _ in 0..MAX_STEPS {
            // Newton's step, limited.
            let step = here.derivatives(&self.rope).lu().solve(&-here.imbalance)?;
            let [wrap, swivel, longer] = [step[0], step[1], step[2]];
            let longest = (1.0 - MIN_SHORTENED) * here.unknowns.free_length;
            let excess = (wrap.abs().max(swivel.abs()) / MAX_TURN).max(-longer / longest);
            let mut part = if excess > 1.0 { 1.0 / excess } else { 1.0 };
            let size = wrap.abs().max(swivel.abs()).max(longer.abs() / here.unknowns.free_length);
            if !size.is_finite() {
                return None;
            }

            // Shorten it until the imbalance falls.
            let before = here.imbalance.amax();
            let next = (0..MAX_HALVINGS).find_map(|_| {
                let contact = here.unknowns.contact.map(|contact| contact.turned(part * wrap, part * swivel));
                let free_length = here.unknowns.free_length + part * longer;
                let next = self.at(Unknowns { contact, free_length });
                part *= 0.5;
                (next.imbalance.amax() < before.max(ROUNDING)).then_some(next)
            });

            // End after a small step.
            here = next?;
            if size <= LAST_STEP {
                return Some(here.unknowns);
            }
        }
        None
    }

    /// Solution on the way from a taut cable to this length, on which the cable is paid out in steps; `None` if a step
    /// would be too small.
    fn paid_out(&self) -> Option<Unknowns> {
        // The taut cable.
        let with_length = |unstrained_length: f64| Problem { rope: Rope { unstrained_length, ..self.rope }, ..*self };
        let straight = self.straight();
        let chord = (self.exit_w(straight.contact.as_ref()) - self.start_w).norm();
        let path = chord + straight.contact.map_or(0.0, |contact| contact.arc()) + self.anchor.drum_side_length();
        let by_tension = path / self.rope.axial_stiffness + self.anchor.winch.as_ref().map_or(0.0, Winch::compliance);
        let (taut, mut here) = TAUT.into_iter().find_map(|multiple| {
            let length = path - multiple * self.load.size * chord * by_tension;
            let problem = with_length(length);
            (length > 0.0).then(|| problem.newton(problem.straight()))?.map(|found| (length, found))
        })?;

        // Pay out; halve a step that finds no solution, double the next one after a step that does.
        let way = self.rope.unstrained_length - taut;
        let (mut done, mut step) = (0.0_f64, 1.0_f64);
        while done < 1.0 {
            step = step.min(1.0 - done);
            let start = Unknowns { free_length: here.free_length + step * way, ..here };
            let is_last = done + step >= 1.0;
            let length = if is_last { self.rope.unstrained_length } else { taut + (done + step) * way };
            match with_length(length).newton(start) {
                Some(next) => {
                    here = next;
                    done = if is_last { 1.0 } else { done + step };
                    step *= 2.0;
                }
                None if step > MIN_PAID_OUT => step *= 0.5,
                None => return None,
            }
        }
        Some(here)
    }

    /// Slow and safe method: the free length for a place on the pulley, then the place for the direction of the cable,
    /// and so on.
    fn one_after_the_other(&self, start: Unknowns) -> Unknowns {
        let mut unknowns = start;
        for _ in 0..MAX_ROUNDS {
            // The free length.
            unknowns.free_length = self.free_length(unknowns);
            let (Some(contact), Some(pulley)) = (unknowns.contact, &self.anchor.pulley) else { break };

            // The place.
            let trial = self.at(unknowns);
            let next = follow(pulley, &trial.span, &contact, trial.beyond.kink);
            let turn = (next.wrap - contact.wrap).abs().max((next.center_w - contact.center_w).norm());
            unknowns.contact = Some(next);
            if turn <= LAST_TURN {
                break;
            }
        }
        unknowns.free_length = self.free_length(unknowns);
        unknowns
    }

    /// Free length at which all lengths add up, the place on the pulley held. The sum grows with the free length.
    fn free_length(&self, start: Unknowns) -> f64 {
        let whole = self.rope.unstrained_length;
        let missing = |free_length: f64| self.at(Unknowns { free_length, ..start }).imbalance[2];
        let (mut low, mut high) = (0.0, f64::INFINITY);
        let mut length = start.free_length.max(MIN_SHORTENED * whole);
        for _ in 0..MAX_LENGTH_STEPS {
            // Update the interval.
            let excess = missing(length);
            if excess > 0.0 {
                high = length;
            } else {
                low = length;
            }

            // The excess is nearly the missing length itself while the cable is slack; else halve the interval.
            let next = length - excess * whole;
            let next = if next > low && next < high {
                next
            } else if high.is_finite() {
                0.5 * (low + high)
            } else {
                2.0 * length
            };
            if (next - length).abs() <= f64::EPSILON * length {
                break;
            }
            length = next;
        }
        length
    }
}

impl Trial {
    /// Derivatives of the conditions by wrap, swivel angle and free length.
    fn derivatives(&self, rope: &Rope) -> Mat3 {
        let Beyond { tension, stretch, compliance, moment, .. } = self.beyond;
        let force_w = Vec3::from(self.beyond.force_w);
        let catenary = &self.span.catenary;
        let (along_w, up_w) = self.span.axes_w();
        let [h, v] = catenary.start_force_by_length();
        let force_by_length = -(along_w * h + up_w * (v + rope.weight_per_length));
        let whole = rope.unstrained_length;
        let tension_by = |force: &Vec3| force_w.dot(force) / tension.max(f64::MIN_POSITIVE);
        let missing_by_length = (1.0 - compliance * stretch * tension_by(&force_by_length)) / whole;

        let Some(contact) = self.unknowns.contact else {
            // Without a pulley only the lengths have a condition.
            return Mat3::from_diagonal(&Vec3::new(1.0, 1.0, missing_by_length));
        };

        let held = self.span.tangent_w();
        let (r, c) = (contact.radius, contact.distance_from_axis());
        let (t, n, s) = (contact.exit_direction_w(), contact.exit_normal_w(), contact.sideways_w);
        let (by_wrap, by_swivel) = (held * t * -r, held * s * -c);
        let scale = 1.0 / tension.max(f64::MIN_POSITIVE);
        let (sin, cos) = contact.wrap.sin_cos();

        // The kink falls with the tension and turns with the swivel.
        let load_w = self.span.load_w();
        let (lever, kink) = (moment / c.max(f64::MIN_POSITIVE), self.beyond.kink.sin());
        let lever_by_wrap =
            r / stretch * (1.0 - (contact.wrap - sin) * sin / (1.0 - cos).powi(2).max(f64::MIN_POSITIVE));
        let kink_by_force = |force: &Vec3| -kink * tension_by(force) * scale;
        let kink_by_wrap = kink_by_force(&by_wrap) - load_w.dot(&s) * lever_by_wrap * scale;
        let kink_by_swivel = kink_by_force(&by_swivel) + load_w.dot(&contact.center_w) * lever * scale;

        Mat3::new(
            (n.dot(&by_wrap) - t.dot(&force_w)) * scale,
            (n.dot(&by_swivel) + cos * s.dot(&force_w)) * scale,
            n.dot(&force_by_length) * scale,
            s.dot(&by_wrap) * scale - kink_by_wrap,
            // At the swivel axis the swivel angle has no effect; the unit keeps it where it is.
            if c > 0.0 { (s.dot(&by_swivel) - contact.center_w.dot(&force_w)) * scale - kink_by_swivel } else { 1.0 },
            s.dot(&force_by_length) * scale - kink_by_force(&force_by_length),
            (r / stretch - compliance * stretch * tension_by(&by_wrap)) / whole,
            -compliance * stretch * tension_by(&by_swivel) / whole,
            missing_by_length,
        )
    }
}

/// Place on a pulley for the direction in which a span pulls at its end.
fn follow(pulley: &Pulley, span: &HangingCable, contact: &PulleyContact, kink: f64) -> PulleyContact {
    let force_w = end_force_w(span);
    let along = force_w.dot(&pulley.entry_direction_w);
    let across_w = force_w - pulley.entry_direction_w * along;
    let across = across_w.norm();
    if across == 0.0 {
        return PulleyContact { wrap: if along > 0.0 { 0.0 } else { std::f64::consts::PI }, ..*contact };
    }

    // The swivel turns the wheel until the force is sideways by the kink.
    let plane = PulleyContact::new(pulley, across_w / across, 0.0);
    let sine = (-force_w.norm() * kink.sin() / across).clamp(-1.0, 1.0);
    let turned = plane.turned(0.0, sine.asin());
    let in_plane = force_w.dot(&turned.center_w);
    PulleyContact { wrap: in_plane.atan2(along).rem_euclid(std::f64::consts::TAU), ..turned }
}

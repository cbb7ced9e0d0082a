//! Inverse statics over pulleys: the exit points follow from the directions of the cables, and these from the exit
//! points.
//!
//! The solvers of inverse statics hold the exit points: they see a robot whose cables end there. Their result gives the
//! directions in which the cables leave the wheels, and so new exit points. As the direction of a cable changes, its
//! exit point moves along the cable, so that the next directions hardly change and the rounds converge.

use super::collect::with_stability;
use super::equilibrium::{CableState, Equilibrium};
use super::error::StaticsError;
use super::limits::TensionRange;
use super::model::StaticModel;
use super::supports;
use crate::catenary::space::HangingCable;
use crate::drive::{CableAtRest, contact_of_span, tension_at_drum};
use crate::math::Vec3;
use crate::robot::{Anchor, Cable, Pose, PulleyContact, Robot, TensionLimits};

/// Convergence: maximum motion of an exit point in a round, over the size of its cable. Rounding of the directions
/// leaves 1e-16 times the radius over this size.
const CONVERGED: f64 = 1e-15;

/// Maximum number of rounds, a guard.
const MAX_ROUNDS: usize = 40;

/// Tolerance of the exit point of a cable whose tension is given, over its motion in the round before: the tensions of
/// the next round change the exit point by about a millionth of this motion.
const TOLERANCE_AT_TENSION: f64 = 1e-6;

/// Maximum number of iterations for the exit point of a cable whose tension is given, a guard. Each reduces the motion
/// of the exit point by the ratio of the radius to the span, or more.
const MAX_ITERATIONS_AT_TENSION: usize = 8;

/// Equilibrium at a pose by a solver that holds the exit points of the cables and leaves the stability open. The solver
/// may start from the result of the round before.
///
/// # Errors
/// Errors of `solve`; [`StaticsError::InsidePulley`] for an attachment inside a wheel; [`StaticsError::NotConverged`].
pub(super) fn equilibrium(
    robot: &Robot,
    pose: &Pose,
    model: StaticModel,
    solve: impl Fn(&Robot, Option<&Equilibrium>) -> Result<Equilibrium, StaticsError>,
) -> Result<Equilibrium, StaticsError> {
    equilibrium_from(robot, pose, model, solve, &[])
}

/// Equilibrium by [`equilibrium`] whose search begins with the exit points and the supports of the cables `start`.
pub(super) fn equilibrium_from(
    robot: &Robot,
    pose: &Pose,
    model: StaticModel,
    solve: impl Fn(&Robot, Option<&Equilibrium>) -> Result<Equilibrium, StaticsError>,
    start: &[CableState],
) -> Result<Equilibrium, StaticsError> {
    let found = if depend_on_tensions(robot, model) {
        with_places(robot, pose, model, solve, |equilibrium| &mut equilibrium.cables, start)?
    } else {
        solve(robot, None)?
    };
    Ok(with_stability(robot, found))
}

/// True if the exit points or the lengths depend on the tensions. Straight and rigid cables without weight leave their
/// pulleys as the geometry says.
pub(super) fn depend_on_tensions(robot: &Robot, model: StaticModel) -> bool {
    robot.has_supports() || model != StaticModel::Ideal && robot.cables.iter().any(|cable| !cable.anchor.is_fixed())
}

/// Result at a pose with the exit points of its tensions, and on flexible supports with their displacements. `solve`
/// holds both, and gets the result of the round before. `cables` gives access to the cables of a result; a result
/// without cables is final. The search begins at the places of the cables `start`, if there are any.
pub(super) fn with_places<T>(
    robot: &Robot,
    pose: &Pose,
    model: StaticModel,
    solve: impl Fn(&Robot, Option<&T>) -> Result<T, StaticsError>,
    cables: impl Fn(&mut T) -> &mut Vec<CableState>,
    start: &[CableState],
) -> Result<T, StaticsError> {
    // Every round of the supports starts from the exit points of straight cables, or of the given ones.
    let at_rigid = |rigid: &Robot| {
        if depend_on_tensions(rigid, model) {
            with_exit_points(rigid, pose, &solve, &cables, start)
        } else {
            solve(rigid, None)
        }
    };
    if robot.has_supports() { supports::on_flexible_supports(robot, at_rigid, &cables, start) } else { at_rigid(robot) }
}

/// Result at a pose with the exit points of its tensions, for a robot with rigid supports.
fn with_exit_points<T>(
    robot: &Robot,
    pose: &Pose,
    solve: impl Fn(&Robot, Option<&T>) -> Result<T, StaticsError>,
    cables: impl Fn(&mut T) -> &mut Vec<CableState>,
    start: &[CableState],
) -> Result<T, StaticsError> {
    let mut contacts = straight_contacts(robot, pose)?;
    for ((contact, cable), state) in contacts.iter_mut().zip(&robot.cables).zip(start) {
        if let Some(span) = &state.hanging {
            *contact = contact_of_span(span, &cable.anchor, contact.as_ref());
        }
    }
    let mut held = with_straight_loads(robot, pose);
    let mut moved = f64::INFINITY;
    let mut last = None;

    for _ in 0..MAX_ROUNDS {
        // Hold the exit points, and solve.
        for ((held, cable), contact) in held.cables.iter_mut().zip(&robot.cables).zip(&contacts) {
            held.anchor = Anchor::from(exit_w(cable, contact.as_ref()));
        }
        let mut found = solve(&held, last.as_ref())?;

        // Places on the pulleys for the tensions of this round.
        let states = cables(&mut found);
        let mut next: Vec<Option<PulleyContact>> = (robot.cables.iter().zip(&*states).zip(&contacts))
            .map(|((cable, state), contact)| contact_of_span(state.hanging.as_ref()?, &cable.anchor, contact.as_ref()))
            .collect();
        let before = moved;
        moved = (robot.cables.iter().zip(&*states).zip(contacts.iter().zip(&next)))
            .map(|((cable, state), (here, next))| {
                let distance = (exit_w(cable, next.as_ref()) - exit_w(cable, here.as_ref())).norm();
                distance / (state.chord() + cable.anchor.reference_w().norm())
            })
            .fold(0.0, f64::max);

        // End, if they are the held ones, or if only rounding moves them.
        let at_rounding = moved < CONVERGED.sqrt() && moved >= before;
        if states.is_empty() || moved <= CONVERGED || at_rounding {
            for ((cable, state), contact) in robot.cables.iter().zip(states).zip(&contacts) {
                complete(state, cable, *contact);
            }
            return Ok(found);
        }

        // Next round. Each exit point is first iterated at the tension of its cable: this costs little, and saves
        // rounds.
        for (i, state) in cables(&mut found).iter().enumerate() {
            held.cables[i].tension_limits = limits_of_span(robot, &held, i, state, contacts[i]);
            if let (Some(span), Some(contact)) = (&state.hanging, &mut next[i]) {
                *contact = at_tension(&robot.cables[i], span, *contact, (TOLERANCE_AT_TENSION * moved).max(CONVERGED));
            }
        }
        contacts = next;
        last = Some(found);
    }

    let (p, limit) = (pose.position_w, CONVERGED);
    Err(StaticsError::NotConverged { iterations: MAX_ROUNDS, residual: moved, limit, x: p.x, y: p.y, z: p.z })
}

/// Robot whose cables end where those of an equilibrium leave their pulleys, with the limits of their free spans.
pub(super) fn held_at(robot: &Robot, pose: &Pose, cables: &[CableState]) -> Robot {
    let mut held = with_straight_loads(robot, pose);
    for (i, state) in cables.iter().enumerate() {
        let Some(span) = &state.hanging else { continue };
        let contact = contact_of_span(span, &robot.cables[i].anchor, None);
        held.cables[i].anchor = Anchor::from(exit_w(&robot.cables[i], contact.as_ref()));
        held.cables[i].tension_limits = limits_of_span(robot, &held, i, state, contact);
    }
    held
}

/// Robot whose cables carry the drag of straight cables at the pose, wherever they leave their pulleys: the drag of all
/// statics.
fn with_straight_loads(robot: &Robot, pose: &Pose) -> Robot {
    let mut held = robot.clone();
    if robot.wind_turns_with_cables() {
        for (held, cable) in held.cables.iter_mut().zip(&robot.cables) {
            let axis_w = cable.chord_w(pose).try_normalize(0.0).unwrap_or_else(Vec3::zeros);
            let width = held.material.drag_width.take().unwrap_or(0.0);
            held.load_per_length_w += robot.wind.cross_pressure_w(&axis_w) * width;
        }
    }
    held
}

/// Places of straight cables on their pulleys.
fn straight_contacts(robot: &Robot, pose: &Pose) -> Result<Vec<Option<PulleyContact>>, StaticsError> {
    robot.cables.iter().map(|cable| straight_contact(cable, pose)).collect()
}

/// Place of a straight cable on its pulley; `None` without one.
///
/// # Errors
/// [`StaticsError::InsidePulley`].
pub(super) fn straight_contact(cable: &Cable, pose: &Pose) -> Result<Option<PulleyContact>, StaticsError> {
    if let Some(distance) = distance_inside_pulley(cable, pose) {
        let radius = cable.anchor.pulley.as_ref().map_or(0.0, |pulley| pulley.radius);
        return Err(StaticsError::InsidePulley { cable: cable.name.clone(), distance, radius });
    }
    Ok(cable.anchor.contact(&pose.point_w(&cable.attachment_p)))
}

/// Distance of the attachment from the centre of its cable's wheel [m] if it is inside the wheel.
pub(crate) fn distance_inside_pulley(cable: &Cable, pose: &Pose) -> Option<f64> {
    let pulley = cable.anchor.pulley.as_ref()?;
    let distance = pulley.distance_from_center(&(pose.point_w(&cable.attachment_p) - cable.anchor.point_w));
    (distance < pulley.radius).then_some(distance)
}

fn exit_w(cable: &Cable, contact: Option<&PulleyContact>) -> Vec3 {
    cable.anchor.point_w + contact.map_or_else(Vec3::zeros, PulleyContact::exit_offset_w)
}

/// Place on its pulley of a cable with the tension of a span, from a place near it. Direction and exit point are
/// computed in turn until the exit point moves by less than `tolerance` times the size of the cable.
fn at_tension(cable: &Cable, span: &HangingCable, near: PulleyContact, tolerance: f64) -> PulleyContact {
    span_with_tension(cable, span, near, span.catenary.parallel_tension(), tolerance).1
}

/// Free span with this parallel tension [N], and its place on the pulley, from those of another tension: direction and
/// exit point are computed in turn, as by [`at_tension`].
pub(super) fn at_own_exit_point(
    cable: &Cable,
    span: &HangingCable,
    near: PulleyContact,
    tension: f64,
) -> (HangingCable, PulleyContact) {
    span_with_tension(cable, span, near, tension, CONVERGED)
}

fn span_with_tension(
    cable: &Cable,
    span: &HangingCable,
    near: PulleyContact,
    tension: f64,
    tolerance: f64,
) -> (HangingCable, PulleyContact) {
    let (rope, up_w) = (span.catenary.rope(), span.axes_w().1);
    let (mut span, mut contact) = (span.clone(), near);
    if tension <= 0.0 {
        return (span, contact);
    }
    for _ in 0..MAX_ITERATIONS_AT_TENSION {
        let end_w = exit_w(cable, Some(&contact));
        span = HangingCable::with_parallel_tension(span.start_w, end_w, up_w, rope, tension);
        let Some(next) = contact_of_span(&span, &cable.anchor, Some(&contact)) else { break };
        let moved = (exit_w(cable, Some(&next)) - end_w).norm();
        contact = next;
        if moved <= tolerance * (span.chord_w().norm() + cable.anchor.reference_w().norm()) {
            break;
        }
    }
    (span, contact)
}

/// Adds the drive to the state of a cable whose free span is known.
fn complete(state: &mut CableState, cable: &Cable, contact: Option<PulleyContact>) {
    let Some(span) = &state.hanging else { return };
    let at_rest = CableAtRest::with_span(span.clone(), &cable.anchor, contact);
    state.unstrained_length = at_rest.unstrained_length();
    state.drive = at_rest.drive;
}

/// Tension limits of the free span of cable `i` that keep the tension at its drum within the limits of the cable.
/// `held` is the robot with the loads of the cables.
fn limits_of_span(
    robot: &Robot,
    held: &Robot,
    i: usize,
    state: &CableState,
    contact: Option<PulleyContact>,
) -> TensionLimits {
    let cable = &robot.cables[i];
    let mut limits = cable.tension_limits;
    let Some(span) = state.hanging.as_ref().filter(|_| !cable.anchor.is_fixed()) else { return limits };
    let drum = tension_at_drum(span, contact.as_ref());

    let range = TensionRange::with_limits(held, i, cable.limits(), &state.chord_w());
    let (above, below) = (drum - span.catenary.max_tension(), span.catenary.min_tension() - drum);
    if above > 0.0 && range.maximum.is_finite() {
        limits.maximum = Some(range.maximum - above);
    }
    if below > 0.0 {
        limits.minimum = Some(range.minimum + below);
    }
    limits
}

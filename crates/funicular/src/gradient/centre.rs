//! Limits of τ of the rule `centre` as scalars, with their coefficients.
//!
//! A limit of τ belongs to another tension of the same cable at the same pose, with its own shape and its own exit
//! point. Its differential is that of τ there, less the change of length that keeps the lowest or the highest tension
//! at its limit. Both are followed through the partial derivatives of the cable at this tension (docs/theory.md,
//! (60t4)).

use super::GradientError;
use super::adjoint::CableAdjoint;
use super::at_limits::{Condition, TensionsAtLimits};
use super::parallel_tension::{ParallelTension, by_length};
use super::scalar::add_real;
use crate::catenary::Catenary;
use crate::drive::derivatives::{OuterRow, end, place};
use crate::math::Vec3;
use crate::statics::derivatives::{CablePartials, load_of};
use crate::statics::{CableState, MinimumTension, TauLimit, TauLimitKind, TensionCurve};

/// State of a cable at a limit of its tension, the pose held.
fn state_at(of: &CableState, curve: &TensionCurve<'_>) -> CableState {
    let at_rest = curve.at_rest();
    let catenary = &at_rest.span.catenary;
    CableState {
        anchor_w: at_rest.span.end_w,
        unstrained_length: at_rest.unstrained_length(),
        force_on_platform_w: at_rest.force_w(),
        tension_platform: catenary.tension_at_start(),
        tension_anchor: catenary.tension_at_end(),
        hanging: Some(at_rest.span),
        drive: at_rest.drive,
        ..of.clone()
    }
}

/// Adds `factor` times the coefficients of a limit of τ to a condition.
pub(super) fn add_limit(
    condition: &mut Condition,
    at: &TensionsAtLimits<'_>,
    limit: &TauLimit<'_>,
    factor: f64,
) -> Result<(), GradientError> {
    let i = condition.cable;
    if load_of(at.state(i)) == Vec3::zeros() {
        // A straight cable has one tension, which is the limit.
        let is_minimum = matches!(limit.kind, TauLimitKind::Minimum(_));
        return if is_minimum { at.add_minimum(condition, factor) } else { Ok(()) };
    }

    let state = state_at(at.state(i), &limit.curve);
    let mut there = at.equilibrium.clone();
    there.cables[i] = state.clone();
    let partials = CablePartials::new(at.robot, &there, i)?;
    let tension = ParallelTension::of(at.robot, i, &state, &partials)?;

    // The scalar that stays zero, and the share of it in the change of τ.
    let reached = reached(limit, &state, &tension);
    let share = tension.by_length / by_length(&reached, &partials);
    if let TauLimitKind::Minimum(MinimumTension::OfPlatform { .. }) = limit.kind {
        at.add_minimum(condition, factor * share)?;
    }
    let sum = &mut condition.coefficients;
    let mut of_tension = CableAdjoint::default();
    tension.add(&mut of_tension, 1.0);
    add_followed(sum, &of_tension, &partials, factor);
    add_followed(sum, &reached, &partials, -factor * share);
    Ok(())
}

/// Coefficients of the lowest or the highest tension less its limit, as far as this depends on the cable; or of τ less
/// its slackest value.
fn reached(limit: &TauLimit<'_>, state: &CableState, tension: &ParallelTension) -> CableAdjoint<f64> {
    let (q, d) = (load_of(state), state.chord_w());
    let mut sum = CableAdjoint::default();
    // A multiple of the weight of the chord.
    let add_weight = |sum: &mut CableAdjoint<f64>, factor: f64| {
        add_real(&mut sum.load, q.normalize() * (d.norm() * factor));
        add_real(&mut sum.chord, d.normalize() * (q.norm() * factor));
    };

    let rounded = match limit.kind {
        TauLimitKind::Slackest => {
            tension.add(&mut sum, 1.0);
            add_weight(&mut sum, -Catenary::MIN_TENSION_TO_WEIGHT);
            return sum;
        }
        TauLimitKind::Minimum(_) => limit.curve.forces().lowest(),
        TauLimitKind::Maximum => limit.curve.forces().highest(),
    };
    if let TauLimitKind::Minimum(MinimumTension::OfCable { factor }) = limit.kind {
        add_weight(&mut sum, -factor);
    }

    // Horizontal force, vertical force at the platform, weight of the free span, tension at the drum.
    let f = state.force_on_platform_w;
    let up = -q.normalize();
    let across = f - up * f.dot(&up);
    let horizontal = across.normalize();
    let by_weight = rounded.by_weight + 0.5 * rounded.by_vertical;
    add_real(&mut sum.force, horizontal * rounded.by_horizontal + up * rounded.by_vertical);
    let by_load = horizontal * (f.dot(&up) / q.norm() * rounded.by_horizontal)
        - across * (rounded.by_vertical / q.norm())
        - up * (state.free_length() * by_weight);
    add_real(&mut sum.load, by_load);
    sum.free_length += q.norm() * by_weight;
    sum.end[end::TENSION_DRUM] += rounded.by_drum;
    sum
}

/// Adds `factor` times coefficients over the state at a limit, followed to chord, load and stiffness, which are those
/// of the equilibrium as well, or over a pulley to the outer variables. Length is left out: all that is added together
/// does not depend on it.
fn add_followed(sum: &mut CableAdjoint<f64>, of: &CableAdjoint<f64>, partials: &CablePartials, factor: f64) {
    let force = Vec3::from(of.force);
    add_real(&mut sum.load, Vec3::from(of.load) * factor);
    sum.stiffness += of.stiffness * factor;
    let Some(drive) = &partials.drive else {
        add_real(&mut sum.chord, (Vec3::from(of.chord) + partials.stiffness_w * force) * factor);
        add_real(&mut sum.load, partials.force_by_load_w.transpose() * force * factor);
        sum.stiffness += partials.force_by_stiffness_w.dot(&force) * factor;
        return;
    };

    let by = &drive.by_outer;
    let mut add = |coefficient: f64, row: &OuterRow| {
        for (variable, (sum, by)) in sum.outer.iter_mut().zip(row).enumerate() {
            *sum += if variable == place::LENGTH { 0.0 } else { factor * coefficient * by };
        }
    };
    for k in 0..3 {
        add(of.force[k], &by.force_w[k]);
        add(of.chord[k], &by.chord_w[k]);
    }
    add(of.free_length, &by.free_length);
    of.end.iter().zip(&by.end).for_each(|(coefficient, row)| add(*coefficient, row));
}

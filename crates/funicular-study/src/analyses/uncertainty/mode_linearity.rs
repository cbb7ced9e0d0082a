//! Test of whether natural frequencies and damping ratios are nearly linear: neighbours that cross, and neighbours that
//! come near and mix.

use super::results::NominalModes;
use super::row::{Along, Row};
use crate::measure::Measure;
use crate::text::significant;
use funicular::gradient::Gradients;

/// Minimum distance of neighbouring frequencies, in standard deviations of this distance.
const CROSSING_DEVIATIONS: f64 = 2.0;

/// Range within which a frequency must be nearly linear, in standard deviations.
const DEVIATIONS: f64 = 3.0;

/// Maximum nonlinear part of the change at the ends of this range, relative to the linear part: 0.3 is a deviation 1 %
/// above the linear one, as for responses.
const MAX_NONLINEAR: f64 = 0.3;

/// Number of neighbours on either side with which a mode may mix. The part of a mode falls with the inverse distance.
const NEIGHBOURS: usize = 4;

/// Part of the change of a mode that its derivatives do not have, by mixing with its neighbours.
#[derive(Default, Clone)]
struct Mixed {
    /// Change of the frequency [Hz].
    frequency_hz: f64,
    /// Change of the damping ratio.
    damping: f64,
    /// Largest part of the frequency, and the neighbour that causes it.
    nearest: Option<(f64, usize)>,
}

/// Tests the modes of all results. Frequencies that may cross change the order of the ascending list; frequencies that
/// come near each other and mix turn away before they cross.
///
/// # References
/// docs/theory.md, equations (94d) and (94d2).
pub(super) fn test(rows: &mut [Row], modes: &NominalModes, gradients: &Gradients, along: &Along) {
    let Ok(vibration) = gradients.vibration(&modes.dynamics) else { return };
    let list = &modes.found.modes;
    let derivatives: Vec<Option<Vec<f64>>> = (list.iter().take(modes.count + NEIGHBOURS))
        .map(|mode| along.of(&vibration.frequency(mode).ok()?).ok())
        .collect();

    let crossing = crossing(modes, &derivatives, along);
    let mut mixed = vec![Mixed::default(); derivatives.len()];
    for a in 0..modes.count {
        for b in a + 1..(a + 1 + NEIGHBOURS).min(derivatives.len()) {
            let (Some(of_a), Some(of_b)) = (&derivatives[a], &derivatives[b]) else { continue };
            let Ok(coupling) = along.of(&vibration.coupling(&list[a], &list[b])) else { continue };
            let coupling = along.reach(&coupling, DEVIATIONS);
            let closing: Vec<f64> = of_b.iter().zip(of_a).map(|(b, a)| b - a).collect();
            let distance = list[b].frequency_hz - list[a].frequency_hz;
            let nearest = (distance - along.reach(&closing, DEVIATIONS)).max(0.0);

            // Two modes at this distance with this coupling.
            let apart = nearest.hypot(2.0 * coupling);
            let beyond = 0.5 * (apart - nearest);
            let share = if apart > 0.0 { beyond / apart } else { 0.0 };
            let damping = |k: usize| modes.damped.get(k).map(funicular::modes::damped::DampedMode::damping_ratio);
            let of_damping = damping(a).zip(damping(b)).map_or(0.0, |(a, b)| share * (a - b).abs());
            for (k, other) in [(a, b), (b, a)] {
                let of_mode = &mut mixed[k];
                of_mode.frequency_hz += beyond;
                of_mode.damping += of_damping;
                if of_mode.nearest.is_none_or(|(largest, _)| beyond > largest) {
                    of_mode.nearest = Some((beyond, other));
                }
            }
        }
    }

    for row in rows {
        let Some(k) = row.kind.mode() else { continue };
        if row.sampling_reason.is_some() {
            continue;
        }
        let linear = |derivatives: &Option<Vec<f64>>| {
            derivatives.as_deref().map_or(0.0, |derivatives| along.reach(derivatives, DEVIATIONS))
        };
        let bends = linear(&derivatives[k]) * MAX_NONLINEAR < mixed[k].frequency_hz
            || matches!(row.kind, Measure::Damping(_)) && linear(&row.derivatives) * MAX_NONLINEAR < mixed[k].damping;
        row.sampling_reason = crossing[k].clone().or_else(|| {
            let (_, other) = mixed[k].nearest.filter(|_| bends)?;
            Some(format!(
                "frequencies {} and {} come near each other and mix: they are {} Hz apart, and within {DEVIATIONS} \
                 deviations frequency {} changes by {} Hz and by up to {} Hz more than its derivative says",
                k.min(other) + 1,
                k.max(other) + 1,
                significant((list[k].frequency_hz - list[other].frequency_hz).abs(), 3),
                k + 1,
                significant(linear(&derivatives[k]), 3),
                significant(mixed[k].frequency_hz, 3)
            ))
        });
    }
}

/// Reasons why the results of modes are not linear because frequencies may cross: the ascending list then changes its
/// order.
fn crossing(modes: &NominalModes, derivatives: &[Option<Vec<f64>>], along: &Along) -> Vec<Option<String>> {
    let list = &modes.found.modes;
    let mut reasons: Vec<Option<String>> = vec![None; modes.count];
    for k in 0..modes.count {
        let Some(own) = &derivatives[k] else { continue };
        let (gap, reached) = match (list.get(k + 1), derivatives.get(k + 1)) {
            (Some(next), Some(Some(other))) => {
                let difference: Vec<f64> = other.iter().zip(own).map(|(a, b)| a - b).collect();
                let reached = along.reach(&difference, CROSSING_DEVIATIONS);
                (next.frequency_hz - list[k].frequency_hz, reached)
            }
            // A neighbour that shares its frequency has no single derivative; its own deviation is taken as equal.
            (Some(next), _) => {
                let reached = 2.0 * along.reach(own, CROSSING_DEVIATIONS);
                (next.frequency_hz - list[k].frequency_hz, reached)
            }
            // No further mode up to the end of the list.
            (None, _) => (modes.found.below_hz - list[k].frequency_hz, along.reach(own, CROSSING_DEVIATIONS)),
        };
        if reached >= gap {
            let number = |value: f64| significant(value, 3);
            let reason = format!(
                "frequencies {} and {} may cross: they are {} Hz apart, and {CROSSING_DEVIATIONS} deviations of this \
                 distance are {} Hz",
                k + 1,
                k + 2,
                number(gap),
                number(reached)
            );
            for mode in [k, k + 1] {
                if let Some(first) = reasons.get_mut(mode) {
                    first.get_or_insert_with(|| reason.clone());
                }
            }
        }
    }
    reasons
}

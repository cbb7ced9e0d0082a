//! Search for the values: statics first, then logarithms of responses from several starts, at last complex responses.

use super::model::IdentifiedModel;
use super::observations::{Kind, Stage};
use crate::error::Cancelled;
use anyhow::{Result, anyhow};
use funicular::math::least_squares::{LeastSquaresEnding, Minimum, minimise};

/// χ² per degree of freedom below which a start counts as found, and no other one is tried. With few degrees of freedom
/// three deviations of χ² above 1 count as found, too.
const FOUND: f64 = 1.5;

/// Maximum number of iterations of one search.
const MAX_ITERATIONS: usize = 60;

/// Maximum number of times that the last stage is repeated with other values left out; two are usual.
const MAX_ROUNDS: usize = 6;

/// Result of one start.
#[derive(Debug, Clone, serde::Serialize)]
pub struct StartRow {
    /// χ² per degree of freedom at its end; absent if the robot has no equilibrium there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub chi2_per_degree: Option<f64>,
    /// Iterations.
    pub iterations: usize,
    /// True if the search ended at a minimum.
    pub converged: bool,
}

/// Result of the search.
pub(crate) struct Searched {
    /// Best minimum, with the residuals of the last stage.
    pub(crate) best: Minimum,
    /// All starts, in their order; the last stage starts at the best.
    pub(crate) starts: Vec<StartRow>,
}

/// Searches the values from several starts.
///
/// # Errors
/// No start from which the robot has an equilibrium, or work that was stopped.
pub(crate) fn search(
    model: &mut IdentifiedModel<'_>,
    starts: usize,
    progress: &dyn Fn(usize, usize),
) -> Result<Searched> {
    let bounds: Vec<(f64, f64)> = model.unknowns.iter().map(super::Unknown::coordinate_bounds).collect();
    let nominal: Vec<f64> = model.unknowns.iter().map(|unknown| unknown.coordinate(unknown.start)).collect();
    let has = |kind: Kind, model: &IdentifiedModel<'_>| model.observations.iter().any(|o| o.kind == kind);
    let has_responses = has(Kind::Response, model);
    let only_statics = model.observations.iter().all(|observation| observation.kind == Kind::Static);

    // Statics alone converge from afar, and tell mass and centre of mass.
    let mut first = nominal.clone();
    if has(Kind::Static, model) && !only_statics {
        model.stage = Stage::Statics;
        if let Some(found) = minimise(model, &nominal, &bounds, MAX_ITERATIONS) {
            first = found.x;
        }
    }

    let mut rows: Vec<StartRow> = Vec::new();
    let mut best: Option<(f64, Minimum)> = None;
    model.stage = if has_responses { Stage::Logarithms } else { Stage::Complex };
    for number in 0..starts {
        progress(number, starts + 1);
        let start = if number == 0 { first.clone() } else { scattered(model, &first, number) };
        let Some(found) = minimise(model, &start, &bounds, MAX_ITERATIONS) else {
            rows.push(StartRow { chi2_per_degree: None, iterations: 0, converged: false });
            continue;
        };
        if found.ending == LeastSquaresEnding::Cancelled {
            return Err(Cancelled.into());
        }
        let degrees = degrees_of_freedom(model, &found).max(1) as f64;
        let per_degree = found.chi2() / degrees;
        rows.push(StartRow {
            chi2_per_degree: Some(per_degree),
            iterations: found.iterations,
            converged: found.ending == LeastSquaresEnding::Converged,
        });
        if best.as_ref().is_none_or(|(other, _)| per_degree < *other) {
            best = Some((per_degree, found));
        }
        if per_degree < FOUND.max(1.0 + 3.0 * (2.0 / degrees).sqrt()) {
            break;
        }
    }
    let Some((_, mut best)) = best else {
        let reason = model.refusal.take().unwrap_or_else(|| anyhow!("no residual is finite"));
        return Err(reason.context("the measurements cannot be computed at any start"));
    };

    if has_responses {
        model.stage = Stage::Complex;
        progress(starts, starts + 1);
        let again = |model: &mut IdentifiedModel<'_>, x: &[f64]| {
            minimise(model, x, &bounds, MAX_ITERATIONS)
                .ok_or_else(|| anyhow!("the responses at the best start cannot be computed again"))
        };
        best = again(model, &best.x)?;
        // Ranges that the model misses are known at a minimum only, and a minimum without them shows more of them.
        for _ in 0..MAX_ROUNDS {
            if best.ending == LeastSquaresEnding::Cancelled || !model.leave_out(&best.x) {
                break;
            }
            best = again(model, &best.x)?;
        }
    }
    if best.ending == LeastSquaresEnding::Cancelled {
        return Err(Cancelled.into());
    }
    progress(starts + 1, starts + 1);
    Ok(Searched { best, starts: rows })
}

/// Number of residuals less the number of unknowns. Values that are left out do not count.
pub(crate) fn degrees_of_freedom(model: &IdentifiedModel<'_>, found: &Minimum) -> usize {
    // Each of them has a real and an imaginary part.
    let left_out = 2 * model.left_out.iter().filter(|left_out| **left_out).count();
    found.residuals.len().saturating_sub(left_out + model.unknowns.len())
}

/// Start number `number`, at a distance of the spread of each value from the first one. The fixed sequence fills the box
/// of ± √3 spreads evenly, whose deviation is the spread.
fn scattered(model: &IdentifiedModel<'_>, first: &[f64], number: usize) -> Vec<f64> {
    // Additive recurrence with the roots of x^{d+1} = x + 1 (M. Roberts, 2018).
    let d = first.len() as f64;
    let mut root = 1.5_f64;
    for _ in 0..60 {
        root = (1.0 + root).powf(1.0 / (d + 1.0));
    }
    let mut place = 1.0;
    first
        .iter()
        .zip(model.unknowns)
        .map(|(x, unknown)| {
            place /= root;
            let uniform = (0.5 + place * number as f64).fract();
            x + 3.0_f64.sqrt() * (2.0 * uniform - 1.0) * unknown.spread()
        })
        .collect()
}

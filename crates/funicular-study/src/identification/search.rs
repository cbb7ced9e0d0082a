//! Search for the values: statics first, then logarithms of responses from several starts, at last complex responses.

use super::chi2::{degrees_of_freedom, noise_range};
use super::model::IdentifiedModel;
use super::observations::Stage;
use super::unknowns::Unknown;
use crate::error::Cancelled;
use anyhow::{Result, anyhow};
use funicular::math::least_squares::{LeastSquaresEnding, Minimum, minimise};

/// χ² per degree of freedom below which no further start is tried. With few degrees of freedom noise alone gives more,
/// and the maximum of [`noise_range`] takes its place.
const FOUND: f64 = 1.5;

/// Maximum number of iterations of one search.
const MAX_ITERATIONS: usize = 60;

/// Maximum number of times that the complex responses are fitted again with other deviations or other values left out;
/// two or three are usual.
const MAX_ROUNDS: usize = 6;

/// Iterations for the root of x^{d+1} = x + 1, each of which takes its error at least to a third; the root is between 1
/// and 2.
const ROOT_ITERATIONS: usize = 60;

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
    let bounds: Vec<(f64, f64)> = model.unknowns.iter().map(Unknown::coordinate_bounds).collect();
    let nominal: Vec<f64> = model.unknowns.iter().map(|unknown| unknown.coordinate(unknown.start)).collect();
    let has_responses = model.observations.iter().any(|observation| observation.subject.is_response());

    let first = first_start(model, nominal, &bounds);
    model.stage = if has_responses { Stage::Logarithms } else { Stage::Complex };
    let (mut best, rows) = best_start(model, &first, starts, &bounds, progress)?;
    if has_responses {
        progress(starts, starts + 1);
        model.stage = Stage::Complex;
        best = fit_responses(model, &best.x, &bounds)?;
    }
    if best.ending == LeastSquaresEnding::Cancelled {
        return Err(Cancelled.into());
    }
    progress(starts + 1, starts + 1);
    Ok(Searched { best, starts: rows })
}

/// First start: the values that fit poses, tensions and lengths, if there are other measurements beside them; otherwise
/// the values of the file. The static residuals converge from poor starts and determine the mass.
fn first_start(model: &mut IdentifiedModel<'_>, nominal: Vec<f64>, bounds: &[(f64, f64)]) -> Vec<f64> {
    let count = model.observations.iter().filter(|observation| observation.subject.is_static()).count();
    if count == 0 || count == model.observations.len() {
        return nominal;
    }
    model.stage = Stage::Statics;
    minimise(model, &nominal, bounds, MAX_ITERATIONS).map_or(nominal, |found| found.x)
}

/// Best minimum of the starts, which are tried until χ² is as small as noise makes it, and the results of all of them.
///
/// # Errors
/// No start from which the robot has an equilibrium, or work that was stopped.
fn best_start(
    model: &mut IdentifiedModel<'_>,
    first: &[f64],
    starts: usize,
    bounds: &[(f64, f64)],
    progress: &dyn Fn(usize, usize),
) -> Result<(Minimum, Vec<StartRow>)> {
    let mut rows: Vec<StartRow> = Vec::new();
    let mut best: Option<(f64, Minimum)> = None;
    for number in 0..starts {
        progress(number, starts + 1);
        let start = if number == 0 { first.to_vec() } else { scattered(model, first, number) };
        let Some(found) = minimise(model, &start, bounds, MAX_ITERATIONS) else {
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
        let [_, highest_of_noise] = noise_range(degrees);
        if per_degree < FOUND.max(highest_of_noise) {
            break;
        }
    }

    let best = best.map(|(_, best)| (best, rows));
    best.ok_or_else(|| {
        let reason = model.refusal.take().unwrap_or_else(|| anyhow!("no residual is finite"));
        reason.context("the measurements cannot be computed at any start")
    })
}

/// Minimum with the complex values of responses, from the best start. Assumed deviations and the ranges that the model
/// misses are known at a minimum only, and a minimum without these ranges shows more of them.
fn fit_responses(model: &mut IdentifiedModel<'_>, start: &[f64], bounds: &[(f64, f64)]) -> Result<Minimum> {
    let again = |model: &mut IdentifiedModel<'_>, x: &[f64]| {
        minimise(model, x, bounds, MAX_ITERATIONS)
            .ok_or_else(|| anyhow!("the responses at the best start cannot be computed again"))
    };
    let mut best = again(model, start)?;
    for _ in 0..MAX_ROUNDS {
        if best.ending == LeastSquaresEnding::Cancelled || !model.renew_responses(&best.x) {
            break;
        }
        best = again(model, &best.x)?;
    }
    Ok(best)
}

/// Start with this number. The starts are a fixed sequence, which fills the box of ± √3 spreads about the first one
/// evenly: a uniform distribution over it has the spread as standard deviation.
///
/// # References
/// M. Roberts, The unreasonable effectiveness of quasirandom sequences, 2018: additive recurrence with the root of
/// x^{d+1} = x + 1.
fn scattered(model: &IdentifiedModel<'_>, first: &[f64], number: usize) -> Vec<f64> {
    let dimensions = first.len() as f64;
    let mut root = 1.5_f64;
    for _ in 0..ROOT_ITERATIONS {
        root = (1.0 + root).powf(1.0 / (dimensions + 1.0));
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

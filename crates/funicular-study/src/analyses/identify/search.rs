//! Search for the values: statics first, then logarithms of responses from several starts, at last complex responses.

use super::assignment::{self, Assigning};
use super::chi2::{degrees_of_freedom, noise_range};
use super::draws::point;
use super::model::IdentifiedModel;
use super::observations::Stage;
use super::starts::{MAX_ITERATIONS, StartRow};
use super::unknowns::Unknown;
use crate::error::Cancelled;
use crate::normal::normal_quantile;
use crate::text::significant;
use anyhow::{Result, anyhow, bail};
use funicular::math::least_squares::{LeastSquaresEnding, Minimum, minimise};

/// χ² per degree of freedom below which no further start is tried. With few degrees of freedom noise alone gives more,
/// and the maximum of [`noise_range`] takes its place.
const FOUND: f64 = 1.5;

/// Maximum number of ends from which the complex responses are fitted.
const LAST_STARTS: usize = 4;

/// Difference of values, in spreads, up to which two ends are one minimum.
const NEAR: f64 = 0.02;

/// Maximum number of times that the complex responses are fitted again with other deviations or other values left out;
/// two or three are usual.
const MAX_ROUNDS: usize = 6;

/// Result of the search.
pub(crate) struct Searched {
    /// Best minimum, with the residuals of the last stage.
    pub(crate) best: Minimum,
    /// All starts, in their order; the last stage starts at the best.
    pub(crate) starts: Vec<StartRow>,
    /// Assignment of frequencies without a number, if the search has looked for others.
    pub(crate) assigning: Option<Assigning>,
    /// Sentence if the starts have ended apart and none of them fits: the search has not arrived.
    pub(crate) apart: Option<String>,
}

/// End of a start.
struct End {
    minimum: Minimum,
    per_degree: f64,
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

    let first = first_start(model, &nominal, &bounds);
    let centre = first.clone().unwrap_or_else(|| centre(model, &nominal));
    let first = first.unwrap_or(nominal);
    model.stage = if has_responses { Stage::Logarithms } else { Stage::Complex };
    if assignment::is_open(model) {
        let (best, rows, assigning) = assignment::search(model, (&first, &centre), starts, progress)?;
        progress(starts + 1, starts + 1);
        return Ok(Searched { best, starts: rows, assigning: Some(assigning), apart: None });
    }

    let (mut ends, rows) = ends(model, (&first, &centre), starts, &bounds, progress)?;
    let mut apart = apart(model, &ends);
    if has_responses {
        progress(starts, starts + 1);
        model.stage = Stage::Complex;
        ends = last_stage(model, &ends, &bounds)?;
        apart = apart.filter(|_| !is_noise(model, &ends[0]));
    }
    let best = ends.swap_remove(0).minimum;
    progress(starts + 1, starts + 1);
    Ok(Searched { best, starts: rows, assigning: None, apart })
}

/// First start: the values that fit poses, tensions and lengths, if there are other measurements beside them; otherwise
/// `None` for the values of the file. The static residuals converge from poor starts and determine the mass.
fn first_start(model: &mut IdentifiedModel<'_>, nominal: &[f64], bounds: &[(f64, f64)]) -> Option<Vec<f64>> {
    let count = model.observations.iter().filter(|observation| observation.subject.is_static()).count();
    if count == 0 || count == model.observations.len() {
        return None;
    }
    model.stage = Stage::Statics;
    minimise(model, nominal, bounds, MAX_ITERATIONS).map(|found| found.x)
}

/// Values about which further starts are drawn: those of the priors, and of the file without prior.
fn centre(model: &IdentifiedModel<'_>, nominal: &[f64]) -> Vec<f64> {
    let values = model.unknowns.iter().zip(nominal);
    values.map(|(unknown, nominal)| unknown.coordinate_prior().map_or(*nominal, |(prior, _)| prior)).collect()
}

/// True if noise explains χ² at an end.
fn is_noise(model: &IdentifiedModel<'_>, end: &End) -> bool {
    let [_, highest_of_noise] = noise_range(degrees_of_freedom(model, &end.minimum).max(1) as f64);
    end.per_degree < FOUND.max(highest_of_noise)
}

/// Ends of the starts, the best first, and a row for each start. Starts are tried until χ² is as small as noise makes
/// it.
///
/// # Errors
/// No start from which the robot has an equilibrium, or work that was stopped.
fn ends(
    model: &mut IdentifiedModel<'_>,
    (first, centre): (&[f64], &[f64]),
    starts: usize,
    bounds: &[(f64, f64)],
    progress: &dyn Fn(usize, usize),
) -> Result<(Vec<End>, Vec<StartRow>)> {
    let (mut rows, mut ends): (Vec<StartRow>, Vec<End>) = (Vec::new(), Vec::new());
    for number in 0..starts {
        progress(number, starts + 1);
        let start = if number == 0 { first.to_vec() } else { scattered(model, centre, number) };
        let found = minimise(model, &start, bounds, MAX_ITERATIONS);
        if model.is_stopped() {
            return Err(Cancelled.into());
        }
        let Some(minimum) = found else {
            rows.push(StartRow::refused());
            continue;
        };
        let degrees = degrees_of_freedom(model, &minimum).max(1) as f64;
        rows.push(StartRow::of(&minimum, degrees));
        let end = End { per_degree: minimum.chi2() / degrees, minimum };
        let is_last = is_noise(model, &end);
        ends.push(end);
        if is_last {
            break;
        }
    }

    if ends.is_empty() {
        let reason = model.refusal.take().unwrap_or_else(|| anyhow!("no residual is finite"));
        return Err(reason.context("the measurements cannot be computed at any start"));
    }
    ends.sort_by(|a, b| a.per_degree.total_cmp(&b.per_degree));
    Ok((ends, rows))
}

/// Sentence if noise does not explain the best end and only one of several starts has reached it: others may end at
/// better values.
fn apart(model: &IdentifiedModel<'_>, ends: &[End]) -> Option<String> {
    let (best, worst) = (ends.first()?, ends.last()?);
    let near = |end: &&End| is_near(model, &end.minimum.x, &best.minimum.x);
    if ends.len() < 2 || is_noise(model, best) || ends.iter().filter(near).count() > 1 {
        return None;
    }
    Some(format!(
        "the search has not arrived: {} starts ended apart, with χ²/n from {} to {}, and only one at the best values: \
         give more starts, values nearer to the true ones, or priors",
        ends.len(),
        significant(best.per_degree, 3),
        significant(worst.per_degree, 3)
    ))
}

/// True if two ends are the same minimum.
fn is_near(model: &IdentifiedModel<'_>, a: &[f64], b: &[f64]) -> bool {
    model.unknowns.iter().zip(a).zip(b).all(|((unknown, a), b)| (a - b).abs() <= NEAR * unknown.spread())
}

/// Minima with the complex values of responses, the best first, from the best ends that differ: the best logarithms are
/// not always near the best complex values.
fn last_stage(model: &mut IdentifiedModel<'_>, ends: &[End], bounds: &[(f64, f64)]) -> Result<Vec<End>> {
    let mut chosen: Vec<&[f64]> = Vec::new();
    for end in ends {
        if chosen.len() < LAST_STARTS && !chosen.iter().any(|other| is_near(model, other, &end.minimum.x)) {
            chosen.push(&end.minimum.x);
        }
    }

    // Each start has its own assumed deviations and ranges that are left out.
    let observations = model.observations.clone();
    let (mut found, mut kept): (Vec<End>, Option<_>) = (Vec::new(), None);
    for start in chosen {
        model.observations.clone_from(&observations);
        model.left_out.fill(false);
        let Ok(minimum) = fit_responses(model, start, bounds) else { continue };
        if model.is_stopped() {
            return Err(Cancelled.into());
        }
        let end = End { per_degree: minimum.chi2() / degrees_of_freedom(model, &minimum).max(1) as f64, minimum };
        let is_last = is_noise(model, &end);
        if found.first().is_none_or(|best| end.per_degree < best.per_degree) {
            kept = Some((model.choices(), model.left_out.clone(), model.observations.clone()));
            found.insert(0, end);
        } else {
            found.push(end);
        }
        if is_last {
            break;
        }
    }
    if found.is_empty() {
        bail!("the responses at the best start cannot be computed again");
    }
    if let Some((choices, left_out, observations)) = kept {
        model.choose(choices);
        model.left_out = left_out;
        model.observations = observations;
    }
    Ok(found)
}

/// Minimum with the complex values of responses, from one start. Assumed deviations and the ranges that the model
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

/// Start with this number, drawn from normal distributions with the deviations of the priors, or with usual errors.
fn scattered(model: &IdentifiedModel<'_>, centre: &[f64], number: usize) -> Vec<f64> {
    let values = centre.iter().zip(model.unknowns).zip(point(number, centre.len()));
    values.map(|((x, unknown), at)| x + unknown.spread() * normal_quantile(at)).collect()
}

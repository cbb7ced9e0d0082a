//! Judgement of a fit: deviations, correlations, combinations that the measurements do not determine, and χ².

use super::chi2::{degrees_of_freedom, noise_range};
use super::model::IdentifiedModel;
use super::unknowns::Unknown;
use crate::text::{counted, significant};
use funicular::math::DMat;
use funicular::math::least_squares::{Minimum, precision};

/// Magnitude of a correlation above which a sentence reports it.
const STRONG: f64 = 0.95;

/// Maximum part of a value in the directions that no residual sees; with more of it, the value has no deviation.
const MAX_UNSEEN: f64 = 1e-3;

/// Minimum component of a value in a weak direction, relative to the largest one, with which a message names the value.
const NAMED: f64 = 0.3;

/// Singular value of a direction, relative to the largest one, up to which the measurements do not see it.
const UNSEEN: f64 = 1e-6;

/// Maximum relative difference between the components of a direction that multiplies all values by one factor.
const COMMON_FACTOR: f64 = 0.15;

/// Judgement of a fit.
pub(crate) struct Judged {
    /// Standard deviations of the coordinates; `None` for a value that the measurements do not determine.
    pub(crate) deviations: Vec<Option<f64>>,
    /// Correlations of the values.
    pub(crate) correlations: Vec<Vec<f64>>,
    /// Singular values of the measurements alone, each value in units of its prior's deviation or its usual error.
    pub(crate) singular_values: Vec<f64>,
    /// Sentences on combinations of values that the measurements do not determine.
    pub(crate) weak: Vec<String>,
    /// Sentences on strong correlations.
    pub(crate) strong: Vec<String>,
    /// χ² per degree of freedom.
    pub(crate) chi2_per_degree: f64,
    /// Degrees of freedom: residuals less values.
    pub(crate) degrees: usize,
    /// Factor by which the deviations were multiplied.
    pub(crate) factor: f64,
    /// Sentence on χ².
    pub(crate) verdict: String,
}

/// Judges a minimum of the last stage. `is_noise_given` is true if every measurement has a deviation of its own.
pub(crate) fn judge(model: &IdentifiedModel<'_>, found: &Minimum, is_noise_given: bool) -> Judged {
    let unknowns = model.unknowns;
    let degrees = degrees_of_freedom(model, found);
    let chi2_per_degree = found.chi2() / degrees.max(1) as f64;
    let (factor, verdict) = if degrees > 0 {
        verdict(chi2_per_degree, degrees as f64, is_noise_given)
    } else {
        let (residuals, values) = (counted(found.residuals.len(), "residual"), counted(unknowns.len(), "value"));
        (1.0, format!("{residuals} for {values}: no residual is left to test the model"))
    };

    // With priors: deviations and correlations.
    let scales: Vec<f64> = unknowns.iter().map(Unknown::spread).collect();
    let all = precision(&found.jacobian, &scales);
    let deviations: Vec<Option<f64>> = (0..unknowns.len())
        .map(|i| (all.unseen[i] <= MAX_UNSEEN).then(|| factor * all.covariance[(i, i)].max(0.0).sqrt()))
        .collect();
    let correlations = correlations(&all.covariance);
    let strong = strong_correlations(unknowns, &correlations);

    // Without priors: what the measurements alone say.
    let rows = found.jacobian.nrows() - model.prior_count();
    let measured = DMat::from_fn(rows, unknowns.len(), |i, j| found.jacobian[(i, j)] / factor.max(f64::MIN_POSITIVE));
    let alone = precision(&measured, &scales);
    let floor = UNSEEN * alone.directions.first().map_or(0.0, |direction| direction.0);
    let weak = (alone.directions.iter())
        .filter(|(value, _)| *value < 1.0)
        .map(|(value, direction)| weak_sentence(model, direction, *value, *value <= floor))
        .collect();
    Judged {
        deviations,
        correlations,
        singular_values: alone.directions.iter().map(|direction| direction.0).collect(),
        weak,
        strong,
        chi2_per_degree,
        degrees,
        factor,
        verdict,
    }
}

/// Factor of the deviations of the values, and a sentence on χ² per degree of freedom.
fn verdict(chi2_per_degree: f64, degrees: f64, is_noise_given: bool) -> (f64, String) {
    let ratio = chi2_per_degree.sqrt();
    let times = significant(ratio, 3);
    if !is_noise_given {
        let sentence = format!(
            "the deviations of the measurements were assumed. The residuals are {times} times as large, and the \
             deviations of the values come from them"
        );
        return (ratio, sentence);
    }

    let [low, high] = noise_range(degrees);
    let (from, to) = (significant(low.max(0.0), 3), significant(high, 3));
    if chi2_per_degree > high {
        let sentence = format!(
            "the residuals are {times} times as large as the deviations of the measurements, and χ²/n is above the \
             range {from} to {to} that noise alone gives: the model is not complete, or the deviations are too small; \
             the deviations of the values are multiplied by {times}"
        );
        return (ratio, sentence);
    }
    let sentence = if chi2_per_degree < low {
        format!(
            "the residuals are only {times} times as large as the deviations of the measurements, and χ²/n is below \
             the range {from} to {to} that noise alone gives: these deviations are too large"
        )
    } else {
        format!("the model agrees with the measurements (noise alone gives a χ²/n between {from} and {to})")
    };
    (1.0, sentence)
}

/// Correlations of a covariance matrix; zero beside a value without variance.
fn correlations(covariance: &DMat) -> Vec<Vec<f64>> {
    let correlation = |i: usize, j: usize| {
        let size = (covariance[(i, i)] * covariance[(j, j)]).sqrt();
        if i == j {
            1.0
        } else if size > 0.0 {
            (covariance[(i, j)] / size).clamp(-1.0, 1.0)
        } else {
            0.0
        }
    };
    let n = covariance.nrows();
    (0..n).map(|i| (0..n).map(|j| correlation(i, j)).collect()).collect()
}

/// Sentences on strong correlations.
fn strong_correlations(unknowns: &[Unknown], correlations: &[Vec<f64>]) -> Vec<String> {
    let sentence = |i: usize, j: usize| {
        format!(
            "{} and {} are correlated by {}: their {} is known better than each of them",
            unknowns[j].path,
            unknowns[i].path,
            crate::text::decimals(correlations[i][j], 3),
            if correlations[i][j] > 0.0 { "difference (or ratio)" } else { "sum (or product)" }
        )
    };
    let pairs = (0..unknowns.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
    pairs.filter(|&(i, j)| correlations[i][j].abs() > STRONG).map(|(i, j)| sentence(i, j)).collect()
}

/// Sentence on a weak direction.
fn weak_sentence(model: &IdentifiedModel<'_>, direction: &[f64], value: f64, is_unseen: bool) -> String {
    let unknowns = model.unknowns;
    let largest = direction.iter().fold(0.0_f64, |most, part| most.max(part.abs()));
    let sign = if direction.iter().any(|part| *part <= -largest) { -1.0 } else { 1.0 };
    let named: Vec<usize> = (0..direction.len()).filter(|&i| direction[i].abs() >= NAMED * largest).collect();
    let part = |&i: &usize| {
        let opposite = if sign * direction[i] < 0.0 { " (the other way)" } else { "" };
        format!("{}{opposite}", unknowns[i].path)
    };
    let together = named.iter().map(part).collect::<Vec<_>>().join(", ");
    let with = if named.len() > 1 { " together" } else { "" };
    if !is_unseen {
        return format!(
            "{together}{with}: the measurements determine this combination only to {} times its prior deviation or \
             usual error, so that mainly priors and bounds decide",
            significant(1.0 / value, 3)
        );
    }

    // A common factor of masses, inertia and stiffness.
    let shares: Vec<f64> = named.iter().map(|&i| sign * direction[i] * unknowns[i].spread()).collect();
    let mean = shares.iter().sum::<f64>() / shares.len() as f64;
    let is_factor = named.len() > 1
        && named.iter().all(|&i| unknowns[i].is_log)
        && shares.iter().all(|share| (share / mean - 1.0).abs() < COMMON_FACTOR);
    let sees_force = model.observations.iter().any(|observation| observation.subject.is_response());
    if is_factor && !sees_force {
        return format!(
            "{together} have a common factor, which frequencies, damping ratios and poses do not determine: hold one \
             of them, give it a prior, or measure a tension or the magnitude of a response"
        );
    }
    format!(
        "{together}{with}: the measurements do not see this combination; hold one of the values, or give it a prior"
    )
}

//! Judgement of a fit: deviations, correlations, combinations that the measurements do not determine, and χ².

use super::model::IdentifiedModel;
use super::observations::Kind;
use super::search::degrees_of_freedom;
use super::unknowns::Unknown;
use crate::text::{counted, significant};
use funicular::math::DMat;
use funicular::math::least_squares::{Minimum, precision};

/// Magnitude of a correlation from which it is reported in words.
const STRONG: f64 = 0.95;

/// Fraction of a direction that no residual sees beyond which a value has no deviation.
const MAX_UNSEEN: f64 = 1e-3;

/// Component of a weak direction, relative to its largest one, from which a value is named in it.
const NAMED: f64 = 0.3;

/// Deviations of χ² within which the measurements agree with the model.
const AGREES: f64 = 3.0;

/// Relative difference of components up to which a direction multiplies all values by one factor.
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
    let scales: Vec<f64> = unknowns.iter().map(Unknown::spread).collect();
    let count = degrees_of_freedom(model, found);
    let degrees = count.max(1) as f64;
    let chi2_per_degree = found.chi2() / degrees;
    // χ² has the variance 2 per degree of freedom.
    let tolerance = AGREES * (2.0 / degrees).sqrt();
    let ratio = chi2_per_degree.sqrt();
    let has_degrees = count > 0;
    let (factor, verdict) = match (is_noise_given, has_degrees) {
        (_, false) => (
            1.0,
            format!(
                "{} for {}: nothing is left that could contradict the model",
                counted(found.residuals.len(), "residual"),
                counted(unknowns.len(), "value")
            ),
        ),
        (false, true) => (
            ratio,
            format!(
                "deviations of measurements were assumed; the residuals are {} times as large, and the deviations of the \
                 values follow from the residuals",
                significant(ratio, 3)
            ),
        ),
        (true, true) if chi2_per_degree > 1.0 + tolerance => (
            ratio,
            format!(
                "the residuals are {0} times as large as the deviations of the measurements: the model is not complete, or \
                 the deviations are too small; the deviations of the values are multiplied by {0}",
                significant(ratio, 3)
            ),
        ),
        (true, true) if chi2_per_degree < 1.0 - tolerance => (
            1.0,
            format!(
                "the residuals are only {} times as large as the deviations of the measurements, which are too large",
                significant(ratio, 3)
            ),
        ),
        (true, true) => (1.0, "the residuals are as large as the deviations of the measurements".to_owned()),
    };

    // With priors: deviations and correlations.
    let all = precision(&found.jacobian, &scales);
    let deviations: Vec<Option<f64>> = (0..unknowns.len())
        .map(|i| (all.unseen[i] <= MAX_UNSEEN).then(|| factor * all.covariance[(i, i)].max(0.0).sqrt()))
        .collect();
    let correlation = |i: usize, j: usize| {
        let size = (all.covariance[(i, i)] * all.covariance[(j, j)]).sqrt();
        if i == j {
            1.0
        } else if size > 0.0 {
            (all.covariance[(i, j)] / size).clamp(-1.0, 1.0)
        } else {
            0.0
        }
    };
    let n = unknowns.len();
    let correlations: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| correlation(i, j)).collect()).collect();
    let mut strong = Vec::new();
    for i in 0..n {
        for j in 0..i {
            if correlations[i][j].abs() > STRONG {
                strong.push(format!(
                    "{} and {} are correlated by {}: their {} is known better than each of them",
                    unknowns[j].path,
                    unknowns[i].path,
                    crate::text::decimals(correlations[i][j], 3),
                    if correlations[i][j] > 0.0 { "difference (or ratio)" } else { "sum (or product)" }
                ));
            }
        }
    }

    // Without priors: what the measurements alone say.
    let rows = found.jacobian.nrows() - model.prior_count();
    let measured = DMat::from_fn(rows, n, |i, j| found.jacobian[(i, j)] / factor.max(f64::MIN_POSITIVE));
    let alone = precision(&measured, &scales);
    let floor = 1e-6 * alone.directions.first().map_or(0.0, |direction| direction.0);
    let weak = (alone.directions.iter())
        .filter(|(value, _)| *value < 1.0)
        .map(|(value, direction)| weak_words(model, direction, *value, *value <= floor))
        .collect();
    Judged {
        deviations,
        correlations,
        singular_values: alone.directions.iter().map(|direction| direction.0).collect(),
        weak,
        strong,
        chi2_per_degree,
        degrees: count,
        factor,
        verdict,
    }
}

/// Sentence on a weak direction.
fn weak_words(model: &IdentifiedModel<'_>, direction: &[f64], value: f64, is_unseen: bool) -> String {
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
            "{together}{with}: the measurements determine this combination only to {} times its prior deviation or usual \
             error, so that mainly priors and bounds decide",
            significant(1.0 / value, 3)
        );
    }

    // A common factor of masses, inertia and stiffness.
    let shares: Vec<f64> = named.iter().map(|&i| sign * direction[i] * unknowns[i].spread()).collect();
    let mean = shares.iter().sum::<f64>() / shares.len() as f64;
    let is_factor = named.len() > 1
        && named.iter().all(|&i| unknowns[i].is_log)
        && shares.iter().all(|share| (share / mean - 1.0).abs() < COMMON_FACTOR);
    let sees_force = model.observations.iter().any(|observation| observation.kind == Kind::Response);
    if is_factor && !sees_force {
        return format!(
            "{together} have a common factor that no frequency, damping ratio or pose tells: hold one of them, give it a \
             prior, or measure a tension or the magnitude of a response"
        );
    }
    format!(
        "{together}{with}: the measurements do not see this combination; hold one of the values, or give it a prior"
    )
}

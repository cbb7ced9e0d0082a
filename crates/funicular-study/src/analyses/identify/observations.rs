//! Measured numbers as observations: residuals of predictions, and their weights.

use funicular::math::Complex;
use std::f64::consts::FRAC_1_SQRT_2;

/// Minimum relative deviation in the residuals of logarithms (93c): the logarithm of noise has no Gaussian distribution
/// where the deviation is small against the error of the model.
const MIN_LOG_DEVIATION: f64 = 0.02;

/// Distance of an unlabelled frequency from its mode, in standard deviations, beyond which its residual loses weight.
pub(super) const ROBUST: f64 = 5.0;

/// Distance of a value of a response from its prediction, in standard deviations of the noise, beyond which it loses
/// weight in the last stage. Gaussian noise exceeds it once in e⁹ ≈ 8,000 values.
const OUTLIER: f64 = 3.0;

/// Number of neighbours on either side over which a misfit is averaged. Errors of a model extend over a range of
/// frequencies, noise does not.
const NEIGHBOURS: usize = 3;

/// Maximum root mean square distance of a value and its neighbours, in standard deviations of the noise. Beyond it the
/// model misses this range: with seven values of Gaussian noise it happens once in ten million.
const MISFIT: f64 = 2.0;

/// Number of values that are left out on either side of such a range. A wrong model begins to bias the values before it
/// is visible: in responses with an error of the model above 11 Hz the result was 5 deviations off with 3, 3.6 with 5
/// and 1.2 with 10.
const MARGIN: usize = 10;

/// Maximum fraction of the values of responses that are left out. Beyond it no single range is the cause, and none is
/// left out.
const MAX_LEFT_OUT: f64 = 0.5;

/// Median of the magnitude of complex noise with the deviation 1: √ln 2.
const MEDIAN_MAGNITUDE: f64 = 0.832_554_611_157_697_8;

/// Quantity that was measured. The observations of an experiment stand in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Subject {
    /// Component of the difference from the measured pose: position [m], then rotation vector [rad].
    Pose(usize),
    /// Tension at the platform of the cable with this index [N].
    Tension(usize),
    /// Unstrained length of the cable with this index [m].
    Length(usize),
    /// Natural frequency with this index in the experiment [Hz].
    Frequency(usize),
    /// Damping ratio of the natural frequency with this index.
    Damping(usize),
    /// Complex value of a response.
    Response {
        /// Index of the response in the experiment.
        response: usize,
        /// Index of the frequency in the response.
        line: usize,
    },
}

impl Subject {
    /// True for a number of the equilibrium.
    pub(crate) fn is_static(self) -> bool {
        matches!(self, Self::Pose(_) | Self::Tension(_) | Self::Length(_))
    }

    /// True for a value of a response.
    pub(crate) fn is_response(self) -> bool {
        matches!(self, Self::Response { .. })
    }
}

/// Measured number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Observation {
    /// Quantity.
    pub(crate) subject: Subject,
    /// Index of the experiment.
    pub(crate) experiment: usize,
    /// Measured value.
    pub(crate) measured: Complex,
    /// Standard deviation; of frequencies and damping ratios relative, of responses that of the magnitude of the noise.
    pub(crate) deviation: f64,
    /// Noise that the deviation of a response follows from; `None` for a deviation that is given.
    pub(crate) noise: Option<AssumedNoise>,
    /// True for a frequency whose mode has to be found.
    pub(crate) is_assigned: bool,
}

/// Assumed noise of a response: a part that is proportional to the response, and a constant one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct AssumedNoise {
    /// Standard deviation relative to the magnitude of the response.
    pub(crate) relative: f64,
    /// Standard deviation where the response is zero, in its unit.
    pub(crate) constant: f64,
}

impl AssumedNoise {
    /// Standard deviation at a response.
    pub(crate) fn deviation(self, response: Complex) -> f64 {
        (self.relative * response.norm()).hypot(self.constant)
    }
}

/// Residuals that a stage of the search uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stage {
    /// Poses, tensions and lengths alone.
    Statics,
    /// Everything, with the logarithms of responses.
    Logarithms,
    /// Everything, with complex responses.
    Complex,
}

impl Observation {
    /// Appends the residuals of a prediction.
    pub(crate) fn residuals(&self, stage: Stage, predicted: Complex, weight: f64, out: &mut Vec<f64>) {
        let Self { measured, deviation, .. } = *self;
        match (self.subject, stage) {
            (Subject::Pose(_) | Subject::Tension(_) | Subject::Length(_), _) => {
                out.push((predicted.re - measured.re) / deviation);
            }
            (_, Stage::Statics) => {}
            (Subject::Frequency(_), _) => out.push(weight * (predicted.re / measured.re - 1.0) / deviation),
            (Subject::Damping(_), _) => out.push((predicted.re / measured.re).ln() / deviation),
            (Subject::Response { .. }, Stage::Logarithms) => {
                out.push((predicted.norm() / measured.norm()).ln() / self.log_deviation());
            }
            (Subject::Response { .. }, Stage::Complex) => {
                // Each part has half of the variance.
                let difference = (predicted - measured) * (weight / (deviation * FRAC_1_SQRT_2));
                out.extend([difference.re, difference.im]);
            }
        }
    }

    /// Appends the derivatives of the residuals for a derivative of the prediction.
    pub(crate) fn derivatives(
        &self,
        stage: Stage,
        predicted: Complex,
        change: Complex,
        weight: f64,
        out: &mut Vec<f64>,
    ) {
        let Self { measured, deviation, .. } = *self;
        match (self.subject, stage) {
            (Subject::Pose(_) | Subject::Tension(_) | Subject::Length(_), _) => out.push(change.re / deviation),
            (_, Stage::Statics) => {}
            (Subject::Frequency(_), _) => out.push(weight * change.re / (measured.re * deviation)),
            (Subject::Damping(_), _) => out.push(change.re / (predicted.re * deviation)),
            (Subject::Response { .. }, Stage::Logarithms) => out.push((change / predicted).re / self.log_deviation()),
            (Subject::Response { .. }, Stage::Complex) => {
                let difference = change * (weight / (deviation * FRAC_1_SQRT_2));
                out.extend([difference.re, difference.im]);
            }
        }
    }

    /// True for a value of the same response.
    fn is_beside(&self, other: &Self) -> bool {
        let response = |of: &Self| match of.subject {
            Subject::Response { response, .. } => Some((of.experiment, response)),
            _ => None,
        };
        response(self).is_some() && response(self) == response(other)
    }

    /// Standard deviation of the logarithm of the magnitude.
    fn log_deviation(&self) -> f64 {
        FRAC_1_SQRT_2 * (self.deviation / self.measured.norm()).max(MIN_LOG_DEVIATION)
    }

    /// Takes the deviation of the assumed noise from the predicted response, and returns its relative change. At the
    /// measured value it would be smaller where noise has made this value smaller, which gives such values more weight:
    /// the fitted magnitude would be too small by the square of the relative noise (docs/theory.md, section 18a).
    pub(super) fn renew_deviation(&mut self, predicted: Complex) -> f64 {
        let Some(noise) = self.noise else { return 0.0 };
        let before = std::mem::replace(&mut self.deviation, noise.deviation(predicted));
        (self.deviation / before - 1.0).abs()
    }

    /// Distance of a prediction from the measured value, in standard deviations.
    fn distance(&self, predicted: Complex) -> f64 {
        (predicted - self.measured).norm() / self.deviation
    }
}

/// Weights of all observations at predictions. A frequency whose mode was found by its distance loses weight with it,
/// because a measured mode may be missing in the list. In the last stage, values of responses lose weight that the
/// model misses by far more than the others; those of `left_out` have none.
pub(super) fn weights(observations: &[Observation], all: &[Complex], stage: Stage, left_out: &[bool]) -> Vec<f64> {
    let scale = if stage == Stage::Complex { noise_scale(observations, all, left_out) } else { 1.0 };
    let weight = |(i, (observation, predicted)): (usize, (&Observation, &Complex))| match observation.subject {
        Subject::Frequency(_) if observation.is_assigned => {
            let residual = (predicted.re / observation.measured.re - 1.0) / observation.deviation;
            1.0 / (1.0 + (residual / ROBUST).powi(2)).sqrt()
        }
        Subject::Response { .. } if stage == Stage::Complex => {
            if left_out[i] {
                return 0.0;
            }
            let alone = observation.distance(*predicted) / scale;
            let around = around(observations, all, i) / scale;
            (OUTLIER / alone).min((MISFIT / around).powi(2)).min(1.0)
        }
        _ => 1.0,
    };
    observations.iter().zip(all).enumerate().map(weight).collect()
}

/// Factor by which the noise of responses is larger than its deviations, at least 1: deviations that are all too small
/// are no reason to leave anything out.
fn noise_scale(observations: &[Observation], all: &[Complex], left_out: &[bool]) -> f64 {
    let mut distances: Vec<f64> = (observations.iter().zip(all).zip(left_out))
        .filter(|((observation, _), left_out)| observation.subject.is_response() && !**left_out)
        .map(|((observation, predicted), _)| observation.distance(*predicted))
        .collect();
    distances.sort_by(f64::total_cmp);
    let median = distances.get(distances.len() / 2).copied().unwrap_or(0.0);
    (median / MEDIAN_MAGNITUDE).max(1.0)
}

/// Values of responses to leave out at predictions of the last stage: ranges that the model misses, with a margin on
/// either side.
pub(super) fn left_out(observations: &[Observation], all: &[Complex], before: &[bool]) -> Vec<bool> {
    let scale = noise_scale(observations, all, before);
    let mut found = vec![false; observations.len()];
    for (i, observation) in observations.iter().enumerate() {
        if observation.subject.is_response() && around(observations, all, i) > MISFIT * scale {
            neighbours(observations, i, MARGIN).for_each(|near| found[near] = true);
        }
    }

    let total = observations.iter().filter(|observation| observation.subject.is_response()).count();
    if found.iter().filter(|left_out| **left_out).count() as f64 > MAX_LEFT_OUT * total as f64 {
        found.fill(false);
    }
    found
}

/// Indices of the values of the same response up to `distance` values away.
fn neighbours(observations: &[Observation], at: usize, distance: usize) -> impl Iterator<Item = usize> + use<'_> {
    let near = move |i: &usize| observations[*i].is_beside(&observations[at]);
    let range = at.saturating_sub(distance)..(at + distance + 1).min(observations.len());
    range.filter(near)
}

/// Root mean square distance of a value of a response and its neighbours.
fn around(observations: &[Observation], predicted: &[Complex], at: usize) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for i in neighbours(observations, at, NEIGHBOURS) {
        sum += observations[i].distance(predicted[i]).powi(2);
        count += 1.0;
    }
    (sum / count).sqrt()
}

//! Measured numbers as observations, and the residuals of predictions.

use crate::measurements::{LENGTH_STD_M, MeasuredResponse, POSITION_STD_M, ROTATION_STD_DEG, TENSION_STD};
use crate::request::Experiment;
use crate::request::IdentifyRequest;
use anyhow::{Result, anyhow, bail};
use funicular::math::Complex;
use std::f64::consts::FRAC_1_SQRT_2;

/// Minimum relative deviation in the residuals of logarithms (93c): the logarithm of noise has no Gaussian distribution
/// where the deviation is small against the error of the model.
const MIN_LOG_DEVIATION: f64 = 0.02;

/// Part of the median magnitude that is added to the deviation of a response without deviations: noise of sensors where the
/// response is small.
const NOISE_FLOOR: f64 = 0.003;

/// Deviations of an assigned frequency without a label beyond which its residual loses weight.
const ROBUST: f64 = 5.0;

/// Deviations of the noise beyond which a value of a response loses weight in the last stage. Gaussian noise exceeds them
/// once in e⁹ ≈ 8,000 values.
const OUTLIER: f64 = 3.0;

/// Number of values on either side over which a misfit is averaged: errors of a model reach over a range of frequencies,
/// noise does not.
const NEIGHBOURS: usize = 3;

/// Root mean square distance over a value and its neighbours, in deviations of the noise, beyond which the model does not
/// hold there: with seven values of Gaussian noise it happens once in ten million.
const MISFIT: f64 = 2.0;

/// Number of values that are left out on either side of such a range. A wrong model begins to bias the values before it
/// is visible: in responses with an error of the model above 11 Hz the result was 5 deviations off with 3, 3.6 with 5
/// and 1.2 with 10.
const MARGIN: usize = 10;

/// Fraction of the values of responses above which none is left out: then no range is to blame.
const MAX_LEFT_OUT: f64 = 0.5;

/// Median of the magnitude of complex noise with the deviation 1: √ln 2.
const MEDIAN_MAGNITUDE: f64 = 0.832_554_611_157_697_8;

/// Maximum number of a measured mode.
const MAX_NUMBER: usize = 1000;

/// Kinds of observations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Coordinate of a position, rotation about an axis, tension or length.
    Static,
    /// Natural frequency.
    Frequency,
    /// Damping ratio.
    Damping,
    /// Complex frequency response.
    Response,
}

/// Measured number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Observation {
    /// Kind.
    pub(crate) kind: Kind,
    /// Measured value.
    pub(crate) measured: Complex,
    /// Standard deviation; of frequencies and damping ratios relative, of responses that of the magnitude of the noise.
    pub(crate) deviation: f64,
    /// True for a frequency whose mode has to be found.
    pub(crate) is_assigned: bool,
    /// Number of the response in its experiment that the value belongs to.
    pub(crate) series: usize,
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
        match (self.kind, stage) {
            (Kind::Static, _) => out.push((predicted.re - measured.re) / deviation),
            (_, Stage::Statics) => {}
            (Kind::Frequency, _) => out.push(weight * (predicted.re / measured.re - 1.0) / deviation),
            (Kind::Damping, _) => out.push((predicted.re / measured.re).ln() / deviation),
            (Kind::Response, Stage::Logarithms) => {
                out.push((predicted.norm() / measured.norm()).ln() / self.log_deviation());
            }
            (Kind::Response, Stage::Complex) => {
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
        match (self.kind, stage) {
            (Kind::Static, _) => out.push(change.re / deviation),
            (_, Stage::Statics) => {}
            (Kind::Frequency, _) => out.push(weight * change.re / (measured.re * deviation)),
            (Kind::Damping, _) => out.push(change.re / (predicted.re * deviation)),
            (Kind::Response, Stage::Logarithms) => out.push((change / predicted).re / self.log_deviation()),
            (Kind::Response, Stage::Complex) => {
                let difference = change * (weight / (deviation * FRAC_1_SQRT_2));
                out.extend([difference.re, difference.im]);
            }
        }
    }

    /// Deviation of the logarithm of the magnitude.
    fn log_deviation(&self) -> f64 {
        FRAC_1_SQRT_2 * (self.deviation / self.measured.norm()).max(MIN_LOG_DEVIATION)
    }

    /// Distance from a prediction in deviations.
    fn distance(&self, predicted: Complex) -> f64 {
        (predicted - self.measured).norm() / self.deviation
    }
}

/// Weights of all observations at predictions. A frequency whose mode was found by its distance loses weight with it:
/// modes that the list does not contain must not pull. In the last stage, values of responses lose weight that the model
/// misses by far more than the others; those of `left_out` have none.
pub(super) fn weights(observations: &[Observation], all: &[Complex], stage: Stage, left_out: &[bool]) -> Vec<f64> {
    let scale = if stage == Stage::Complex { noise_scale(observations, all, left_out) } else { 1.0 };
    let weight = |(i, (observation, predicted)): (usize, (&Observation, &Complex))| match observation.kind {
        Kind::Frequency if observation.is_assigned => {
            let residual = (predicted.re / observation.measured.re - 1.0) / observation.deviation;
            1.0 / (1.0 + (residual / ROBUST).powi(2)).sqrt()
        }
        Kind::Response if stage == Stage::Complex => {
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

/// Factor by which the noise of responses is larger than its deviations, at least 1: deviations that are all too small are
/// no reason to leave anything out.
fn noise_scale(observations: &[Observation], all: &[Complex], left_out: &[bool]) -> f64 {
    let mut distances: Vec<f64> = (observations.iter().zip(all).zip(left_out))
        .filter(|((observation, _), left_out)| observation.kind == Kind::Response && !**left_out)
        .map(|((observation, predicted), _)| observation.distance(*predicted))
        .collect();
    distances.sort_by(f64::total_cmp);
    let median = distances.get(distances.len() / 2).copied().unwrap_or(0.0);
    (median / MEDIAN_MAGNITUDE).max(1.0)
}

/// Values of responses to leave out at predictions of the last stage: ranges in which the model does not hold, with a
/// margin on either side.
pub(super) fn left_out(observations: &[Observation], all: &[Complex], before: &[bool]) -> Vec<bool> {
    let scale = noise_scale(observations, all, before);
    let mut found = vec![false; observations.len()];
    for (i, observation) in observations.iter().enumerate() {
        if observation.kind == Kind::Response && around(observations, all, i) > MISFIT * scale {
            neighbours(observations, i, MARGIN).for_each(|near| found[near] = true);
        }
    }

    let total = observations.iter().filter(|observation| observation.kind == Kind::Response).count();
    if found.iter().filter(|left_out| **left_out).count() as f64 > MAX_LEFT_OUT * total as f64 {
        found.fill(false);
    }
    found
}

/// Indices of the values of the same response up to `distance` values away.
fn neighbours(observations: &[Observation], at: usize, distance: usize) -> impl Iterator<Item = usize> + use<'_> {
    let Observation { kind, series, .. } = observations[at];
    let near = move |i: &usize| observations[*i].kind == kind && observations[*i].series == series;
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

/// Observations of the lines of a response, the number `series` of its experiment.
fn of_response(
    response: &MeasuredResponse,
    series: usize,
    name: &str,
    request: &IdentifyRequest,
) -> Result<Vec<Observation>> {
    let mut found = Vec::new();
    let of = if response.name.is_empty() {
        format!("{}/{}", response.output, response.input)
    } else {
        response.name.clone()
    };
    let count = response.frequency_hz.len();
    if count == 0 || response.real.len() != count || response.imag.len() != count {
        bail!(
            "{name}, response {of}: {count} frequencies, {} real and {} imaginary parts: give as many of each, at least \
             one",
            response.real.len(),
            response.imag.len()
        );
    }
    let after = response.frequency_hz.iter().skip(1);
    if let Some((before, after)) = response.frequency_hz.iter().zip(after).find(|(before, after)| before >= after) {
        bail!(
            "{name}, response {of}: the frequencies must ascend, and {after} Hz follows {before} Hz: sort the lines, and \
             give each frequency once"
        );
    }
    let mut values = Vec::with_capacity(count);
    for ((hz, re), im) in response.frequency_hz.iter().zip(&response.real).zip(&response.imag) {
        crate::values::not_negative(*hz).map_err(|reason| anyhow!("{name}, response {of}: {reason}"))?;
        if !(re.is_finite() && im.is_finite()) {
            bail!("{name}, response {of}: the value at {hz} Hz is not finite");
        }
        values.push(Complex::new(*re, *im));
    }
    let mut magnitudes: Vec<f64> = values.iter().map(|value| value.norm()).collect();
    magnitudes.sort_by(f64::total_cmp);
    let median = magnitudes[count / 2];
    if median == 0.0 {
        bail!("{name}, response {of}: most of its values are zero");
    }
    for (i, measured) in values.into_iter().enumerate() {
        let deviation = match &response.std {
            Some(std) if std.len() != count => {
                bail!("{name}, response {of}: {count} frequencies and {} deviations", std.len())
            }
            Some(std) => crate::values::positive(std[i]).map_err(|reason| anyhow!("{name}, std: {reason}"))?,
            None => (request.response_noise * measured.norm()).hypot(NOISE_FLOOR * median),
        };
        // The logarithm of zero does not exist; such a line says no more than its deviation.
        let measured = if measured.norm() == 0.0 { Complex::new(deviation, 0.0) } else { measured };
        found.push(Observation { kind: Kind::Response, measured, deviation, is_assigned: false, series });
    }
    Ok(found)
}

/// Observations of an experiment, in the order of its predictions.
///
/// # Errors
/// Measurements of different lengths, numbers that are not possible, or no measurement at all.
pub(super) fn observations(experiment: &Experiment, name: &str, request: &IdentifyRequest) -> Result<Vec<Observation>> {
    let mut found = Vec::new();
    let mut add = |kind, measured: Complex, deviation| {
        found.push(Observation { kind, measured, deviation, is_assigned: false, series: 0 });
    };
    let positive =
        |key: &str, value: f64| crate::values::positive(value).map_err(|reason| anyhow!("{name}, {key}: {reason}"));
    let Experiment { position_std_m, rotation_std_deg, tension_std_n, length_std_m, .. } = *experiment;

    if experiment.measured_pose.is_some() {
        let position = positive("position_std_m", position_std_m.unwrap_or(POSITION_STD_M))?;
        let rotation = positive("rotation_std_deg", rotation_std_deg.unwrap_or(ROTATION_STD_DEG))?.to_radians();
        // The prediction is the difference from the measured pose.
        (0..3).for_each(|_| add(Kind::Static, Complex::default(), position));
        (0..3).for_each(|_| add(Kind::Static, Complex::default(), rotation));
    }
    if let Some(tensions) = &experiment.measured_tensions_n {
        let largest = tensions.iter().copied().fold(0.0, f64::max);
        let deviation = positive("tension_std_n", tension_std_n.unwrap_or(TENSION_STD * largest))?;
        for tension in tensions {
            add(Kind::Static, (*tension).into(), deviation);
        }
    }
    if let Some(lengths) = &experiment.measured_lengths_m {
        let deviation = positive("length_std_m", length_std_m.unwrap_or(LENGTH_STD_M))?;
        for length in lengths {
            add(Kind::Static, (*length).into(), deviation);
        }
    }
    for number in found.iter().map(|observation| observation.measured.re) {
        crate::values::finite(number).map_err(|reason| anyhow!("{name}: {reason}"))?;
    }

    // Natural frequencies, then damping ratios.
    for frequency in &experiment.frequencies {
        let hz = positive("frequency_hz", frequency.frequency_hz)?;
        let weight = frequency.weight.unwrap_or(1.0);
        if !(weight >= 0.0 && weight.is_finite()) {
            bail!("{name}: the weight {weight} of the frequency {hz} Hz must be zero or positive");
        }
        let relative = match frequency.std_hz {
            Some(std) => positive("std_hz", std)? / hz,
            None => request.frequency_noise,
        };
        // A weight of zero is an infinite deviation.
        let deviation = relative / weight.sqrt();
        if let Some(number) = frequency.number().filter(|number| *number > MAX_NUMBER) {
            bail!(
                "{name}: the label {number} of the frequency {hz} Hz is the number of a mode, which is at most \
                 {MAX_NUMBER}: leave it out, or give a name that is no number"
            );
        }
        let is_assigned = frequency.number().is_none();
        found.push(Observation { kind: Kind::Frequency, measured: hz.into(), deviation, is_assigned, series: 0 });
    }
    for frequency in &experiment.frequencies {
        if let Some(damping) = frequency.damping_ratio {
            let damping = positive("damping_ratio", damping)?;
            if damping >= 1.0 {
                bail!(
                    "{name}, damping_ratio: {damping} is not below 1, where nothing vibrates any more: 0.4 % is 0.004"
                );
            }
            let deviation = request.damping_noise / frequency.weight.unwrap_or(1.0).sqrt();
            found.push(Observation {
                kind: Kind::Damping,
                measured: damping.into(),
                deviation,
                is_assigned: false,
                series: 0,
            });
        }
    }

    for (series, response) in experiment.responses.iter().enumerate() {
        found.extend(of_response(response, series, name, request)?);
    }
    if found.is_empty() {
        bail!(
            "{name} has no measurement: give `responses`, `frequencies`, `measured_pose`, `measured_tensions_n` or \
             `measured_lengths_m`"
        );
    }
    Ok(found)
}

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
    /// True for a frequency whose mode has to be found.
    pub(crate) is_assigned: bool,
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

    /// Distance of a prediction from the measured value, in standard deviations.
    fn distance(&self, predicted: Complex) -> f64 {
        (predicted - self.measured).norm() / self.deviation
    }
}

/// Weights of all observations at predictions. A frequency whose mode was found by its distance loses weight with it:
/// modes that the list does not contain must not pull. In the last stage, values of responses lose weight that the model
/// misses by far more than the others; those of `left_out` have none.
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

/// Factor by which the noise of responses is larger than its deviations, at least 1: deviations that are all too small are
/// no reason to leave anything out.
fn noise_scale(observations: &[Observation], all: &[Complex], left_out: &[bool]) -> f64 {
    let mut distances: Vec<f64> = (observations.iter().zip(all).zip(left_out))
        .filter(|((observation, _), left_out)| observation.subject.is_response() && !**left_out)
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

/// Values of a response, one per frequency.
///
/// # Errors
/// Lists of different lengths, frequencies that do not ascend, or values that are not finite or mostly zero.
fn response_values(response: &MeasuredResponse, name: &str) -> Result<Vec<Complex>> {
    let count = response.frequency_hz.len();
    if count == 0 || response.real.len() != count || response.imag.len() != count {
        bail!(
            "{name}: {count} frequencies, {} real and {} imaginary parts: give as many of each, at least one",
            response.real.len(),
            response.imag.len()
        );
    }
    let after = response.frequency_hz.iter().skip(1);
    if let Some((before, after)) = response.frequency_hz.iter().zip(after).find(|(before, after)| before >= after) {
        bail!(
            "{name}: the frequencies must ascend, and {after} Hz follows {before} Hz: sort the lines, and give each \
             frequency once"
        );
    }

    let mut values = Vec::with_capacity(count);
    for ((hz, re), im) in response.frequency_hz.iter().zip(&response.real).zip(&response.imag) {
        crate::values::not_negative(*hz).map_err(|reason| anyhow!("{name}: {reason}"))?;
        if !(re.is_finite() && im.is_finite()) {
            bail!("{name}: the value at {hz} Hz is not finite");
        }
        values.push(Complex::new(*re, *im));
    }
    Ok(values)
}

/// Median magnitude of the values of a response.
fn median_magnitude(values: &[Complex]) -> f64 {
    let mut magnitudes: Vec<f64> = values.iter().map(|value| value.norm()).collect();
    magnitudes.sort_by(f64::total_cmp);
    magnitudes[magnitudes.len() / 2]
}

/// Reads the measurements of an experiment.
struct Reader<'a> {
    experiment: &'a Experiment,
    /// Index of the experiment.
    number: usize,
    /// Name of the experiment in messages.
    name: &'a str,
    request: &'a IdentifyRequest,
    found: Vec<Observation>,
}

/// Observations of the experiment with this index, in the order of its predictions.
///
/// # Errors
/// Measurements of different lengths, numbers that are not possible, or no measurement at all.
pub(super) fn observations(
    experiment: &Experiment,
    number: usize,
    name: &str,
    request: &IdentifyRequest,
) -> Result<Vec<Observation>> {
    let mut reader = Reader { experiment, number, name, request, found: Vec::new() };
    reader.read_statics()?;
    reader.read_frequencies()?;
    reader.read_damping()?;
    for (response, measured) in experiment.responses.iter().enumerate() {
        reader.read_response(response, measured)?;
    }
    if reader.found.is_empty() {
        bail!(
            "{name} has no measurement: give ⟪measured_pose⟫, ⟪measured_tensions_n⟫ or ⟪measured_lengths_m⟫, or measured \
             responses or natural frequencies (keys `responses` and `frequencies` of the experiment)"
        );
    }
    Ok(reader.found)
}

impl Reader<'_> {
    fn add(&mut self, subject: Subject, measured: Complex, deviation: f64) {
        let experiment = self.number;
        self.found.push(Observation { subject, experiment, measured, deviation, is_assigned: false });
    }

    /// Positive value of an option.
    fn option(&self, option: &str, value: f64) -> Result<f64> {
        crate::values::positive(value).map_err(|reason| anyhow!("{}, ⟪{option}⟫: {reason}", self.name))
    }

    /// Positive value of a key of the experiment.
    fn key(&self, key: &str, value: f64) -> Result<f64> {
        crate::values::positive(value).map_err(|reason| anyhow!("{}, key `{key}`: {reason}", self.name))
    }

    fn read_statics(&mut self) -> Result<()> {
        let Experiment { position_std_m, rotation_std_deg, tension_std_n, length_std_m, .. } = *self.experiment;
        if self.experiment.measured_pose.is_some() {
            let position = self.option("position_std_m", position_std_m.unwrap_or(POSITION_STD_M))?;
            let rotation = self.option("rotation_std_deg", rotation_std_deg.unwrap_or(ROTATION_STD_DEG))?.to_radians();
            // The prediction is the difference from the measured pose.
            (0..3).for_each(|k| self.add(Subject::Pose(k), Complex::default(), position));
            (3..6).for_each(|k| self.add(Subject::Pose(k), Complex::default(), rotation));
        }
        if let Some(tensions) = &self.experiment.measured_tensions_n {
            let largest = tensions.iter().copied().fold(0.0, f64::max);
            let deviation = self.option("tension_std_n", tension_std_n.unwrap_or(TENSION_STD * largest))?;
            (0..).zip(tensions).for_each(|(i, tension)| self.add(Subject::Tension(i), (*tension).into(), deviation));
        }
        if let Some(lengths) = &self.experiment.measured_lengths_m {
            let deviation = self.option("length_std_m", length_std_m.unwrap_or(LENGTH_STD_M))?;
            (0..).zip(lengths).for_each(|(i, length)| self.add(Subject::Length(i), (*length).into(), deviation));
        }

        for number in self.found.iter().map(|observation| observation.measured.re) {
            crate::values::finite(number).map_err(|reason| anyhow!("{}: {reason}", self.name))?;
        }
        Ok(())
    }

    fn read_frequencies(&mut self) -> Result<()> {
        let name = self.name;
        for (k, frequency) in self.experiment.frequencies.iter().enumerate() {
            let hz = self.key("frequency_hz", frequency.frequency_hz)?;
            let weight = frequency.weight.unwrap_or(1.0);
            if !(weight >= 0.0 && weight.is_finite()) {
                bail!("{name}: the weight {weight} of the frequency {hz} Hz must be zero or positive");
            }
            let relative = match frequency.std_hz {
                Some(std) => self.key("std_hz", std)? / hz,
                None => self.request.frequency_noise,
            };
            if let Some(number) = frequency.number().filter(|number| *number > MAX_NUMBER) {
                bail!(
                    "{name}: the label {number} of the frequency {hz} Hz is the number of a mode, which is at most \
                     {MAX_NUMBER}: leave it out, or give a name that is no number"
                );
            }
            self.found.push(Observation {
                subject: Subject::Frequency(k),
                experiment: self.number,
                measured: hz.into(),
                // A weight of zero is an infinite deviation.
                deviation: relative / weight.sqrt(),
                is_assigned: frequency.number().is_none(),
            });
        }
        Ok(())
    }

    fn read_damping(&mut self) -> Result<()> {
        let experiment = self.experiment;
        for (k, frequency) in experiment.frequencies.iter().enumerate() {
            let Some(damping) = frequency.damping_ratio else { continue };
            let damping = self.key("damping_ratio", damping)?;
            if damping >= 1.0 {
                bail!(
                    "{}, key `damping_ratio`: {damping} is not below 1, where nothing vibrates any more: 0.4 % is 0.004",
                    self.name
                );
            }
            let deviation = self.request.damping_noise / frequency.weight.unwrap_or(1.0).sqrt();
            self.add(Subject::Damping(k), damping.into(), deviation);
        }
        Ok(())
    }

    /// Reads the response with this index.
    fn read_response(&mut self, response: usize, given: &MeasuredResponse) -> Result<()> {
        let signals = format!("{}/{}", given.output, given.input);
        let name = format!("{}, response {}", self.name, if given.name.is_empty() { &signals } else { &given.name });
        let values = response_values(given, &name)?;
        let median = median_magnitude(&values);
        if median == 0.0 {
            bail!("{name}: most of its values are zero");
        }
        if let Some(std) = given.std.as_ref().filter(|std| std.len() != values.len()) {
            bail!("{name}: {} frequencies and {} deviations", values.len(), std.len());
        }

        for (line, measured) in values.into_iter().enumerate() {
            let deviation = match &given.std {
                Some(std) => self.key("std", std[line])?,
                None => (self.request.response_noise * measured.norm()).hypot(NOISE_FLOOR * median),
            };
            // The logarithm of zero does not exist, and a measured zero is uncertain by its deviation.
            let measured = if measured.norm() == 0.0 { Complex::new(deviation, 0.0) } else { measured };
            self.add(Subject::Response { response, line }, measured, deviation);
        }
        Ok(())
    }
}

//! Measurements of an experiment become observations, after checks of their numbers.

use super::observations::{AssumedNoise, Observation, Subject};
use crate::measurements::{LENGTH_STD_M, MeasuredResponse, POSITION_STD_M, ROTATION_STD_DEG, TENSION_STD};
use crate::request::{Experiment, IdentifyRequest};
use anyhow::{Result, anyhow, bail};
use funicular::math::Complex;

/// Part of the median magnitude of a response that is added to its assumed deviation: sensors have noise also where the
/// response is small.
const NOISE_FLOOR: f64 = 0.003;

/// Maximum number of a measured mode.
const MAX_NUMBER: usize = 1000;

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
struct ExperimentReader<'a> {
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
    let mut reader = ExperimentReader { experiment, number, name, request, found: Vec::new() };
    reader.read_statics()?;
    reader.read_frequencies()?;
    reader.read_damping()?;
    for (response, measured) in experiment.responses.iter().enumerate() {
        reader.read_response(response, measured)?;
    }
    if reader.found.is_empty() {
        bail!(
            "{name} has no measurement: give ⟪measured_pose⟫, ⟪measured_tensions_n⟫ or ⟪measured_lengths_m⟫, or \
             measured responses, natural frequencies or time histories (keys `responses`, `frequencies` and \
             `histories` of the experiment)"
        );
    }
    Ok(reader.found)
}

impl ExperimentReader<'_> {
    fn add(&mut self, subject: Subject, measured: Complex, deviation: f64) {
        let experiment = self.number;
        self.found.push(Observation { subject, experiment, measured, deviation, noise: None, is_assigned: false });
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
                noise: None,
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
                    "{}, key `damping_ratio`: {damping} is not below 1, where nothing vibrates any more: 0.4 % is \
                     0.004",
                    self.name
                );
            }
            let relative = match frequency.damping_std {
                Some(std) => self.key("damping_std", std)? / damping,
                None => self.request.damping_noise,
            };
            let deviation = relative / frequency.weight.unwrap_or(1.0).sqrt();
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

        let assumed = AssumedNoise { relative: self.request.response_noise, constant: NOISE_FLOOR * median };
        let noise = given.std.is_none().then_some(assumed);
        for (line, measured) in values.into_iter().enumerate() {
            let deviation = match &given.std {
                Some(std) => self.key("std", std[line])?,
                None => assumed.deviation(measured),
            };
            // The logarithm of zero does not exist, and a measured zero is uncertain by its deviation.
            let measured = if measured.norm() == 0.0 { Complex::new(deviation, 0.0) } else { measured };
            let (subject, experiment) = (Subject::Response { response, line }, self.number);
            self.found.push(Observation { subject, experiment, measured, deviation, noise, is_assigned: false });
        }
        Ok(())
    }
}

//! Time histories of experiments become natural frequencies with damping ratios, which are fitted like measured ones.

use super::Identified;
use crate::columns::{Columns, column, parts};
use crate::measurements::{MeasuredFrequency, MeasuredHistory};
use crate::names::{HistoryKind, Named};
use crate::quantiles::student_95;
use crate::request::{self, IdentifyRequest};
use crate::rows::rows;
use crate::text::{counted, significant};
use anyhow::{Result, anyhow, bail};
use funicular::histories::ambient::{self, Ambient, AmbientOptions};
use funicular::histories::decay::{self, DecayPoles, HalvesOfPole};
use funicular::histories::{IdentifiedPole, PoleSet, Samples, quality};
use funicular::math::DMat;

/// Jitter of the times beyond which they are not even.
const MAX_JITTER: f64 = 0.05;

/// Part of the energy near the Nyquist frequency beyond which vibrations may have been folded down.
const MAX_HIGH_ENERGY: f64 = 0.05;

/// Part of the readings at the end of a sensor's range that is told.
const MAX_CLIPPED: f64 = 0.002;

/// Range of the mean acceleration of a sensor that measures gravity [m/s²], and the range in which it is 1 g.
const GRAVITY: std::ops::Range<f64> = 9.7..9.9;
const ONE_G: std::ops::Range<f64> = 0.95..1.05;

/// Damping ratio beyond which a pole is no vibration: drift, or gusts of wind.
const MAX_DAMPING: f64 = 0.2;

/// Number of periods within a history from which on a pole is a vibration.
const MIN_PERIODS: f64 = 2.0;

rows! {
    /// Time history with what was found in it.
    #[derive(Debug, Clone)]
    pub struct HistoryOfPoles {
        /// Experiment.
        pub experiment: String;
        pub name: String;
        /// `decay` or `ambient`.
        pub kind: &'static str;
        pub samples: usize;
        /// Sensors, in the order of the shapes.
        pub channels: Vec<String>;
        pub duration_s: f64;
        pub sample_rate_hz: f64;
        /// Findings about the readings.
        pub checks: Vec<String>;
        /// Standard deviations of the noise of the sensors of a decay, in the SI unit of each.
        pub noise: Vec<f64> = sparse;
        /// χ² per degree of freedom of a decay; 1 by itself where no noise was given.
        pub chi2_per_degree: Option<f64>;
        /// Mean square of the correlations of the residuals of a decay, times the number of samples: 1 for noise.
        pub residual_correlation: Option<f64>;
        /// False if the residuals of a decay are more than noise.
        pub is_noise: Option<bool>;
        /// Order of the system of an ambient record.
        pub order: Option<usize>;
        /// Natural frequencies, ascending.
        pub poles: Vec<PoleRow>;
        /// Covariance of frequency [Hz] and damping ratio of each pole, in this order.
        pub covariance: Vec<Vec<f64>>;
        /// Stabilisation diagram of an ambient record.
        pub diagram: Vec<DiagramRow> = sparse;
        /// Sentences on what limits the result.
        pub warnings: Vec<String> = sparse;
    }
}

rows! {
    /// Natural frequency that was found in a time history.
    #[derive(Debug, Clone)]
    pub struct PoleRow {
        /// Name of the history.
        pub history: String = hidden;
        pub frequency_hz: f64;
        pub std_hz: f64;
        /// Interval that holds the frequency with 95 % [Hz].
        pub interval_95_hz: Option<[f64; 2]>;
        /// Damping ratio; absent if the record is too short for it.
        pub damping_ratio: Option<f64>;
        pub damping_std: Option<f64>;
        /// Interval that holds the damping ratio with 95 %.
        pub damping_interval_95: Option<[f64; 2]>;
        /// True if the pole is fitted like a measured natural frequency.
        pub is_vibration: bool;
        /// Real parts of the shape at the sensors; 1 at the one that sees it best.
        pub shape_real: Vec<f64>;
        /// Imaginary parts of the shape.
        pub shape_imag: Vec<f64>;
        /// Standard deviations √E|δ|² of the shape.
        pub shape_std: Vec<f64>;
        /// Frequencies in the first and the second half of a decay [Hz].
        pub halves_hz: Option<[f64; 2]>;
        /// Damping ratios in both halves.
        pub halves_damping_ratio: Option<[f64; 2]>;
        /// Largest difference of both halves, in deviations.
        pub difference_of_halves: Option<f64>;
    }
}

rows! {
    /// Pole of the stabilisation diagram of an ambient record.
    #[derive(Debug, Clone)]
    pub struct DiagramRow {
        /// Order of the system.
        pub order: usize;
        pub frequency_hz: f64;
        pub damping_ratio: f64;
        /// True if it has been found in five orders in a row.
        pub is_stable: bool;
    }
}

impl PoleRow {
    /// Pole with intervals by a factor of its deviations.
    fn of(pole: &IdentifiedPole, factor: Option<f64>, history: &HistoryOfPoles) -> Self {
        let interval = |value: f64, std: f64| factor.map(|factor| [value - factor * std, value + factor * std]);
        let is_vibration = (0.0..MAX_DAMPING).contains(&pole.damping_ratio)
            && pole.damping_ratio > 0.0
            && pole.frequency_hz * history.duration_s > MIN_PERIODS;
        Self {
            history: history.name.clone(),
            frequency_hz: pole.frequency_hz,
            std_hz: pole.frequency_std_hz,
            interval_95_hz: interval(pole.frequency_hz, pole.frequency_std_hz),
            damping_interval_95: interval(pole.damping_ratio, pole.damping_std),
            damping_ratio: Some(pole.damping_ratio),
            damping_std: Some(pole.damping_std),
            is_vibration,
            shape_real: pole.shape.iter().map(|value| value.re).collect(),
            shape_imag: pole.shape.iter().map(|value| value.im).collect(),
            shape_std: pole.shape_std.clone(),
            halves_hz: None,
            halves_damping_ratio: None,
            difference_of_halves: None,
        }
    }

    /// Adds the poles of both halves.
    fn with_halves(self, halves: Option<&HalvesOfPole>) -> Self {
        let Some(found) = halves else { return self };
        let [first, second] = &found.halves;
        Self {
            halves_hz: Some([first.frequency_hz[0], second.frequency_hz[0]]),
            halves_damping_ratio: Some([first.damping_ratio[0], second.damping_ratio[0]]),
            difference_of_halves: Some(found.difference),
            ..self
        }
    }

    /// Measured natural frequency of this pole.
    fn measured(&self) -> MeasuredFrequency {
        MeasuredFrequency {
            frequency_hz: self.frequency_hz,
            std_hz: Some(self.std_hz),
            damping_ratio: self.damping_ratio,
            damping_std: self.damping_std,
            ..MeasuredFrequency::default()
        }
    }

    /// Columns of the poles.
    pub fn columns() -> Columns<Self> {
        Columns::new([
            column("history", "", "name of the time history", |of: &Self| of.history.clone()),
            column("frequency_hz", "Hz", "natural frequency", |of: &Self| of.frequency_hz).shown(
                "frequency",
                "Hz",
                |of, style| style.significant(of.frequency_hz, 6),
            ),
            column("std_hz", "Hz", "its standard deviation", |of: &Self| of.std_hz).significant("deviation", 2),
            column("damping_ratio", "1", "damping ratio; empty if the record is too short", |of: &Self| {
                of.damping_ratio
            })
            .significant("damping ratio", 4),
            column("damping_std", "1", "its standard deviation", |of: &Self| of.damping_std)
                .significant("deviation", 2),
            column("is_vibration", "", "false for drift and gusts", |of: &Self| of.is_vibration),
            parts("{}_half_hz", ["first", "second"], "Hz", "frequency in the {} half of a decay", |of: &Self| {
                of.halves_hz.map_or([None; 2], |halves| halves.map(Some))
            }),
            column("difference_of_halves", "1", "largest difference of both halves, in deviations", |of: &Self| {
                of.difference_of_halves
            })
            .significant("halves differ by", 2),
        ])
    }
}

impl HistoryOfPoles {
    /// Warnings with the name of the history.
    pub(super) fn caveats(&self) -> impl Iterator<Item = String> + '_ {
        self.warnings.iter().map(|warning| format!("{}: {warning}", self.name))
    }

    fn of(name: String, experiment: &str, kind: HistoryKind, samples: &Samples, given: &MeasuredHistory) -> Self {
        Self {
            experiment: experiment.to_owned(),
            name,
            kind: kind.name(),
            samples: samples.count(),
            channels: given.channels.iter().map(|channel| channel.name.clone()).collect(),
            duration_s: samples.duration(),
            sample_rate_hz: 1.0 / samples.step(),
            checks: Vec::new(),
            noise: Vec::new(),
            chi2_per_degree: None,
            residual_correlation: None,
            is_noise: None,
            order: None,
            poles: Vec::new(),
            covariance: Vec::new(),
            diagram: Vec::new(),
            warnings: Vec::new(),
        }
    }

    /// Adds the poles of a decay.
    fn add_decay(&mut self, found: &DecayPoles) {
        self.noise.clone_from(&found.noise);
        self.chi2_per_degree = Some(found.chi2 / found.degrees);
        self.residual_correlation = Some(found.correlation);
        self.is_noise = Some(found.is_noise);
        self.covariance = listed(&found.found.covariance);
        let factor = factor_95(&found.found);
        let poles = found.found.poles.iter().zip(&found.halves);
        self.poles = poles.map(|(pole, halves)| PoleRow::of(pole, factor, self).with_halves(halves.as_ref())).collect();
        if !found.is_noise {
            self.warnings.push(format!(
                "the residuals of {} are more than noise: the deviations were multiplied, and frequencies that are \
                 near one another may be missing; choose a later ⟪history_from_s⟫, or leave out disturbed sensors",
                counted(self.poles.len(), "vibration")
            ));
        }
        for (pole, halves) in self.poles.iter().zip(&found.halves) {
            let Some(halves) = halves.as_ref().filter(|halves| halves.differ()) else { continue };
            let [first, second] = &halves.halves;
            self.warnings.push(format!(
                "{} Hz is not linear: {} Hz and a damping ratio of {} in the first half of the decay, {} Hz and {} in \
                 the second, {} deviations apart",
                significant(pole.frequency_hz, 5),
                significant(first.frequency_hz[0], 5),
                significant(first.damping_ratio[0], 3),
                significant(second.frequency_hz[0], 5),
                significant(second.damping_ratio[0], 3),
                significant(halves.difference, 2)
            ));
        }
    }

    /// Adds the poles of an ambient record.
    fn add_ambient(&mut self, found: &Ambient) {
        self.order = Some(found.order);
        self.covariance = listed(&found.found.covariance);
        self.diagram = (found.diagram.iter())
            .map(|pole| DiagramRow {
                order: pole.order,
                frequency_hz: pole.frequency_hz,
                damping_ratio: pole.damping_ratio,
                is_stable: pole.is_stable,
            })
            .collect();
        for pole in &found.found.poles {
            let least = Ambient::least_duration(pole);
            let mut row = PoleRow::of(pole, factor_95(&found.found), self);
            if self.duration_s < least {
                row.damping_ratio = None;
                row.damping_std = None;
                row.damping_interval_95 = None;
                self.warnings.push(format!(
                    "{} Hz has no damping ratio: {} s tell it to worse than 25 %, and {} s are needed",
                    significant(pole.frequency_hz, 5),
                    significant(self.duration_s, 4),
                    significant(least, 3)
                ));
            }
            self.poles.push(row);
        }
        for hz in &found.harmonics_hz {
            self.warnings.push(format!(
                "{} Hz hardly decays and was left out: it is the harmonic of a motor or of another machine",
                significant(*hz, 5)
            ));
        }
    }
}

impl Identified {
    /// Result without fitted values: the frequencies of histories alone.
    pub(super) fn of_histories(robot: String, robot_file: String, histories: Vec<HistoryOfPoles>) -> Self {
        let warnings = histories.iter().flat_map(|history| history.caveats().collect::<Vec<_>>()).collect();
        Self {
            robot,
            values: Vec::new(),
            chi2: 0.0,
            residuals: 0,
            degrees_of_freedom: 0,
            chi2_per_degree: 0.0,
            deviation_factor: 1.0,
            verdict: "no value was fitted".to_owned(),
            correlations: Vec::new(),
            singular_values: Vec::new(),
            weak_combinations: Vec::new(),
            strong_correlations: Vec::new(),
            converged: true,
            starts: Vec::new(),
            evaluations: 0,
            frequencies: Vec::new(),
            frequency_rms: None,
            frequency_rms_before: None,
            assignment: None,
            responses: Vec::new(),
            statics: Vec::new(),
            histories,
            proposals: Vec::new(),
            measurements_needed: None,
            robot_file,
            warnings,
        }
    }
}

/// Factor of the deviations whose intervals hold the truth with 95 %.
fn factor_95(found: &PoleSet) -> Option<f64> {
    // A known noise has infinitely many degrees, for which the conversion gives the largest number.
    student_95(found.degrees as usize)
}

/// Rows of a matrix.
fn listed(matrix: &DMat) -> Vec<Vec<f64>> {
    matrix.row_iter().map(|row| row.iter().copied().collect()).collect()
}

/// Request whose experiments have the natural frequencies of their histories, and the histories.
///
/// # Errors
/// A history that cannot be used.
pub(super) fn with_frequencies(request: &IdentifyRequest) -> Result<(IdentifyRequest, Vec<HistoryOfPoles>)> {
    request::check("history_from_s", request.history_from_s, crate::values::finite)?;
    request::check("history_to_s", request.history_to_s, crate::values::finite)?;
    let (mut completed, mut rows) = (request.clone(), Vec::new());
    for (number, experiment) in completed.experiments.iter_mut().enumerate() {
        for (k, history) in std::mem::take(&mut experiment.histories).iter().enumerate() {
            let name = match history.name.as_str() {
                "" => format!("history {} of experiment {}", k + 1, number + 1),
                name => name.to_owned(),
            };
            let row = found(history, &name, &experiment.name, request)?;
            let vibrations = row.poles.iter().filter(|pole| pole.is_vibration);
            experiment.frequencies.extend(vibrations.map(PoleRow::measured));
            rows.push(row);
        }
    }
    Ok((completed, rows))
}

/// Natural frequencies of a history.
fn found(given: &MeasuredHistory, name: &str, experiment: &str, request: &IdentifyRequest) -> Result<HistoryOfPoles> {
    let at = |reason: &dyn std::fmt::Display| anyhow!("{name}: {reason}");
    let samples = samples(given, request).map_err(|error| at(&error))?;
    let kind = request.history_kind;
    let mut row = HistoryOfPoles::of(name.to_owned(), experiment, kind, &samples, given);
    check_readings(&mut row, &samples, given);
    match kind {
        HistoryKind::Decay => {
            if samples.count() > decay::MAX_SAMPLES {
                bail!(
                    "{name}: {} samples are more than {} of a decay: choose a part with ⟪history_from_s⟫ and \
                     ⟪history_to_s⟫, or give every second one",
                    samples.count(),
                    decay::MAX_SAMPLES
                );
            }
            let noise: Option<Vec<f64>> = given.channels.iter().map(|channel| channel.std).collect();
            let found = decay::identify(&samples, noise.as_deref(), request.history_poles);
            row.add_decay(&found.map_err(|error| at(&error))?);
        }
        HistoryKind::Ambient => {
            let jitter = quality::jitter(&samples);
            if jitter > MAX_JITTER {
                bail!(
                    "{name}: the time steps vary by {} %, and a record under unknown excitation needs even ones (at \
                     most {} %): give the readings at even times",
                    significant(100.0 * jitter, 2),
                    100.0 * MAX_JITTER
                );
            }
            let options =
                AmbientOptions { order: request.history_poles.map(|poles| 2 * poles), ..AmbientOptions::default() };
            row.add_ambient(&ambient::identify(&samples, options).map_err(|error| at(&error))?);
        }
    }
    Ok(row)
}

/// Readings of a history within the range that counts.
fn samples(given: &MeasuredHistory, request: &IdentifyRequest) -> Result<Samples> {
    let (from, to) =
        (request.history_from_s.unwrap_or(f64::NEG_INFINITY), request.history_to_s.unwrap_or(f64::INFINITY));
    if from >= to {
        bail!("⟪history_from_s⟫ {from} s is not before ⟪history_to_s⟫ {to} s");
    }
    for channel in &given.channels {
        if channel.values.len() != given.time_s.len() {
            bail!("{} has {} readings for {} times", channel.name, channel.values.len(), given.time_s.len());
        }
        if channel.std.is_some_and(|std| !(std > 0.0 && std.is_finite())) {
            bail!("the deviation `std` of {} must be positive", channel.name);
        }
    }
    let counts: Vec<bool> = given.time_s.iter().map(|time| (from..=to).contains(time) || time.is_nan()).collect();
    let kept = |values: &[f64]| -> Vec<f64> {
        values.iter().zip(&counts).filter(|(_, counts)| **counts).map(|(value, _)| *value).collect()
    };
    let channels: Vec<Vec<f64>> = given.channels.iter().map(|channel| kept(&channel.values)).collect();
    Ok(Samples::new(kept(&given.time_s), &channels)?)
}

/// Adds what the readings themselves tell: times, range and resolution of sensors, folded vibrations, gravity.
fn check_readings(row: &mut HistoryOfPoles, samples: &Samples, given: &MeasuredHistory) {
    let jitter = quality::jitter(samples);
    row.checks.push(format!(
        "{} at {} Hz, time steps vary by {} %",
        counted(samples.count(), "sample"),
        significant(row.sample_rate_hz, 4),
        significant(100.0 * jitter, 2)
    ));
    if jitter > MAX_JITTER {
        row.warnings.push(format!(
            "the time steps vary by {} %; the decay is fitted at the times as they stand",
            significant(100.0 * jitter, 2)
        ));
    }
    for (c, channel) in given.channels.iter().enumerate() {
        let name = &channel.name;
        let (clipped, quantum) = (quality::clipped(samples, c), quality::quantum(samples, c));
        row.checks.push(format!(
            "{name}: resolution {}, {} at the ends of its range",
            significant(quantum, 2),
            counted(clipped, "reading")
        ));
        if clipped as f64 > MAX_CLIPPED * samples.count() as f64 {
            row.warnings.push(format!(
                "{name} is clipped: {} stand at the ends of its range; use a sensor with a larger range, or a later \
                 ⟪history_from_s⟫",
                counted(clipped, "reading")
            ));
        }
        let high = quality::high_energy(samples, c);
        if high > MAX_HIGH_ENERGY {
            row.warnings.push(format!(
                "{name} has {} % of its energy above 0.4 of the sampling rate: vibrations above half of it may have \
                 been folded down; sample faster, or filter before sampling",
                significant(100.0 * high, 2)
            ));
        }
    }
    check_gravity(row, samples, given);
}

/// Adds what the mean of an accelerometer with three axes says about gravity.
fn check_gravity(row: &mut HistoryOfPoles, samples: &Samples, given: &MeasuredHistory) {
    let find = |output: &str, point: Option<[f64; 3]>| {
        let is_it = |channel: &&crate::measurements::MeasuredChannel| {
            channel.output.as_deref() == Some(output) && channel.output_point_m == point
        };
        given.channels.iter().position(|channel| is_it(&channel))
    };
    for channel in given.channels.iter().filter(|channel| channel.output.as_deref() == Some("ax")) {
        let axes = ["ax", "ay", "az"].map(|output| find(output, channel.output_point_m));
        let [Some(x), Some(y), Some(z)] = axes else { continue };
        let mean = [x, y, z].map(|c| samples.values().column(c).mean());
        let size = mean.iter().map(|value| value * value).sum::<f64>().sqrt();
        let told = significant(size, 4);
        if GRAVITY.contains(&size) {
            row.checks.push(format!("the accelerometer measures gravity: mean {told} m/s²"));
        } else if ONE_G.contains(&size) {
            row.warnings.push(format!(
                "the mean of the accelerometer is {told} m/s²: it seems to measure in g; name its columns …_g"
            ));
        } else {
            row.checks.push(format!("gravity was removed from the accelerometer, or is wrong: mean {told} m/s²"));
        }
    }
}

//! Samples of sensors, and the poles found in them.

use crate::math::{Complex, DMat};
use std::f64::consts::TAU;
use thiserror::Error;

/// Minimum number of samples of a history.
const MIN_SAMPLES: usize = 40;

/// Maximum number of channels of a history.
const MAX_CHANNELS: usize = 60;

/// Samples that do not make a history.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SamplesError {
    /// Too few samples.
    #[error("{0} samples are too few: at least {MIN_SAMPLES} are needed")]
    Few(usize),
    /// Too few samples for blocks of time.
    #[error("{samples} samples are too few for {blocks} blocks of time: at least {least} are needed")]
    Short {
        /// Number of samples.
        samples: usize,
        /// Number of blocks.
        blocks: usize,
        /// Least number of samples.
        least: usize,
    },
    /// No channel, or too many.
    #[error("{0} channels: 1 to {MAX_CHANNELS} are possible")]
    Channels(usize),
    /// Channel with another number of samples.
    #[error("channel {channel} has {count} samples for {times} times")]
    Lengths {
        /// Number of the channel, from 1.
        channel: usize,
        /// Number of its samples.
        count: usize,
        /// Number of the times.
        times: usize,
    },
    /// Time or sample that is not finite.
    #[error("sample {0} is not finite")]
    NotFinite(usize),
    /// Times that do not ascend.
    #[error("the times must ascend, and {after} s follows {before} s (sample {sample})")]
    Order {
        /// Number of the sample, from 1.
        sample: usize,
        /// Time before [s].
        before: f64,
        /// Time after it [s].
        after: f64,
    },
    /// Channel that does not change.
    #[error("channel {0} has one value throughout: leave it out")]
    Constant(usize),
    /// History without a pole.
    #[error("no vibration was found in it")]
    NoPole,
}

/// Samples of all channels at common times.
#[derive(Debug, Clone)]
pub struct Samples {
    /// Times [s], ascending.
    time: Vec<f64>,
    /// One column per channel.
    values: DMat,
}

impl Samples {
    /// Samples of channels.
    ///
    /// # Errors
    /// Lists of different lengths, too few samples, numbers that are not finite, or times that do not ascend.
    pub fn new(time: Vec<f64>, channels: &[Vec<f64>]) -> Result<Self, SamplesError> {
        if time.len() < MIN_SAMPLES {
            return Err(SamplesError::Few(time.len()));
        }
        if !(1..=MAX_CHANNELS).contains(&channels.len()) {
            return Err(SamplesError::Channels(channels.len()));
        }
        for (i, channel) in channels.iter().enumerate() {
            if channel.len() != time.len() {
                return Err(SamplesError::Lengths { channel: i + 1, count: channel.len(), times: time.len() });
            }
        }
        for sample in 0..time.len() {
            // Squares of the numbers have to be finite as well.
            let is_usable = |value: f64| value.is_finite() && value.abs() < 1e100;
            if !is_usable(time[sample]) || !channels.iter().all(|channel| is_usable(channel[sample])) {
                return Err(SamplesError::NotFinite(sample + 1));
            }
            if sample > 0 && time[sample] <= time[sample - 1] {
                let (before, after) = (time[sample - 1], time[sample]);
                return Err(SamplesError::Order { sample: sample + 1, before, after });
            }
        }
        let values = DMat::from_fn(time.len(), channels.len(), |row, column| channels[column][row]);
        let samples = Self { time, values };
        let constant = (0..channels.len()).find(|&c| samples.spread(c) <= 1e-12 * samples.values.column(c).amax());
        constant.map_or(Ok(samples), |c| Err(SamplesError::Constant(c + 1)))
    }

    /// Number of samples.
    pub fn count(&self) -> usize {
        self.time.len()
    }

    /// Number of channels.
    pub fn channels(&self) -> usize {
        self.values.ncols()
    }

    /// Times [s].
    pub fn time(&self) -> &[f64] {
        &self.time
    }

    /// Values, one column per channel.
    pub fn values(&self) -> &DMat {
        &self.values
    }

    /// Mean time between samples [s].
    pub fn step(&self) -> f64 {
        self.duration() / (self.count() - 1) as f64
    }

    /// Time from the first sample to the last [s].
    pub fn duration(&self) -> f64 {
        self.time[self.count() - 1] - self.time[0]
    }

    /// Standard deviation of a channel.
    pub fn spread(&self, channel: usize) -> f64 {
        self.values.column(channel).variance().sqrt()
    }

    /// Samples in a range of their indices.
    pub(super) fn part(&self, range: std::ops::Range<usize>) -> Self {
        Self { time: self.time[range.clone()].to_vec(), values: self.values.rows(range.start, range.len()).into() }
    }
}

/// Pole of a history with its shape at the sensors.
#[derive(Debug, Clone, PartialEq)]
pub struct IdentifiedPole {
    /// Natural frequency |λ|/2π [Hz].
    pub frequency_hz: f64,
    /// Damping ratio −Re λ/|λ|.
    pub damping_ratio: f64,
    /// Standard deviation of the frequency [Hz].
    pub frequency_std_hz: f64,
    /// Standard deviation of the damping ratio.
    pub damping_std: f64,
    /// Shape over the channels; 1 in the channel that sees it best.
    pub shape: Vec<Complex>,
    /// Standard deviations √E|δ|² of the shape, one per channel.
    pub shape_std: Vec<f64>,
}

/// Poles of a history, ascending, with their covariance.
#[derive(Debug, Clone)]
pub struct PoleSet {
    /// Poles.
    pub poles: Vec<IdentifiedPole>,
    /// Covariance of frequency [Hz] and damping ratio of each pole, in this order.
    pub covariance: DMat,
    /// Degrees of freedom of Student's distribution of the deviations; infinite for a known noise.
    pub degrees: f64,
}

impl PoleSet {
    /// Poles with these indices, in this order.
    #[must_use]
    pub fn chosen(&self, indices: &[usize]) -> Self {
        let rows: Vec<usize> = indices.iter().flat_map(|i| [2 * i, 2 * i + 1]).collect();
        Self {
            poles: indices.iter().map(|i| self.poles[*i].clone()).collect(),
            covariance: DMat::from_fn(rows.len(), rows.len(), |a, b| self.covariance[(rows[a], rows[b])]),
            degrees: self.degrees,
        }
    }
}

/// Frequency [Hz] and damping ratio of an eigenvalue [rad/s].
pub(super) fn frequency_and_damping(eigenvalue: Complex) -> [f64; 2] {
    let size = eigenvalue.norm();
    [size / TAU, -eigenvalue.re / size]
}

/// Modal assurance criterion of two shapes: 1 for proportional ones, 0 for orthogonal ones.
pub fn mac(a: &[Complex], b: &[Complex]) -> f64 {
    let product = |x: &[Complex], y: &[Complex]| x.iter().zip(y).map(|(x, y)| x.conj() * y).sum::<Complex>();
    let squares = product(a, a).re * product(b, b).re;
    if squares > 0.0 { product(a, b).norm_sqr() / squares } else { 0.0 }
}

//! Spectra over frequency, with frequencies where they are needed, and their moments.

use super::modes::GustResonance;
use super::{Densities, GustError, Gusts};
use crate::math::order;
use std::f64::consts::LN_10;

/// Part of each moment by which one interval of the integration may be wrong. Some hundred intervals have errors far
/// below it, so that r.m.s. values are right to about 1e-4.
const SPECTRUM_TOLERANCE: f64 = 1e-5;

/// Intervals per decade from which the integration starts.
const PER_DECADE: f64 = 6.0;

/// Maximum step of the variable about a peak from which the integration starts. There the peak is `1/cosh` of the
/// variable, which five samples over a step of 2 integrate to 1e-3, and over a step of 4 miss by a tenth.
const MAX_STEP_ABOUT_PEAK: f64 = 2.0;

/// Ratio to the frequency of a peak, upwards and downwards, beyond which logarithms are the variable: the spectra of
/// gusts and the quasi-static response are smooth in them.
const PEAK_REACH: f64 = 1.5;

/// Minimum damping ratio of a peak: the frequency of a mode is known to about 1e-12, and rounding hides narrower peaks.
const MIN_RATIO: f64 = 1e-10;

/// Maximum distance of two peaks that are one, over the smaller of their half widths.
const ONE_PEAK: f64 = 0.3;

/// Maximum number of frequencies: one second of work for a robot with eight cables; and over the number of those from
/// which the integration starts, which many modes need.
const MAX_FREQUENCIES: usize = 20_000;
const MAX_OVER_FIRST: usize = 4;

/// Moments of one spectrum.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Moments {
    /// Variance, `∫S df`.
    pub variance: f64,
    /// `∫f² S df` [Hz² times the variance's unit].
    pub second: f64,
    /// Variance without the dynamics of the robot; not a number without stiffness.
    pub quasi_static: f64,
}

impl Moments {
    /// Root mean square about the mean.
    pub fn rms(&self) -> f64 {
        self.variance.sqrt()
    }

    /// Rate at which the mean is crossed upwards [Hz]; zero for a quantity that does not move.
    pub fn rate(&self) -> f64 {
        if self.variance > 0.0 { (self.second / self.variance).sqrt() } else { 0.0 }
    }

    fn add(&mut self, factor: f64, of: &Self) {
        self.variance += factor * of.variance;
        self.second += factor * of.second;
        self.quasi_static += factor * of.quasi_static;
    }
}

/// Spectra of all outputs.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectra {
    /// Frequencies [Hz], ascending.
    pub frequencies_hz: Vec<f64>,
    /// Densities at each of them.
    pub densities: Vec<Densities>,
    /// Moments of each output up to the last frequency.
    pub moments: Vec<Moments>,
    /// Variance of each output nearest to each natural frequency, in their order: up to the geometric mean with the
    /// next one. Their sum is the variance; empty without natural frequencies.
    pub by_mode: Vec<Vec<f64>>,
}

/// Spectra at one frequency.
struct Sample {
    frequency_hz: f64,
    densities: Densities,
}

/// Variable over which a piece of the spectra is integrated.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Variable {
    /// ln f.
    Logarithm,
    /// `asinh((f − f_k)/w_k)` with the place f_k of a resonance and its half width w_k [Hz]: equal steps of it are
    /// narrow at the peak and grow with the distance from it.
    AboutPeak { frequency_hz: f64, half_width_hz: f64 },
}

impl Variable {
    fn of(self, hz: f64) -> f64 {
        match self {
            Self::Logarithm => hz.ln(),
            Self::AboutPeak { frequency_hz, half_width_hz } => ((hz - frequency_hz) / half_width_hz).asinh(),
        }
    }

    fn frequency_hz(self, at: f64) -> f64 {
        match self {
            Self::Logarithm => at.exp(),
            Self::AboutPeak { frequency_hz, half_width_hz } => frequency_hz + half_width_hz * at.sinh(),
        }
    }

    /// Derivative of the frequency by the variable [Hz].
    fn slope(self, at: f64) -> f64 {
        match self {
            Self::Logarithm => at.exp(),
            Self::AboutPeak { half_width_hz, .. } => half_width_hz * at.cosh(),
        }
    }
}

/// Part of the frequencies.
#[derive(Debug, Clone, Copy, PartialEq)]
struct FrequencyPart {
    variable: Variable,
    from_hz: f64,
    to_hz: f64,
}

impl FrequencyPart {
    /// Values of the variable in equal steps, ends included.
    fn steps(&self) -> Vec<f64> {
        let step = if self.variable == Variable::Logarithm { LN_10 / PER_DECADE } else { MAX_STEP_ABOUT_PEAK };
        let (from, to) = (self.variable.of(self.from_hz), self.variable.of(self.to_hz));
        let count = ((to - from) / step).ceil().max(1.0) as usize;
        (0..=count).map(|i| from + (to - from) * i as f64 / count as f64).collect()
    }
}

/// Interval of a variable with its middle: places, and the indices of their samples.
#[derive(Debug, Clone, Copy)]
struct SpectrumInterval {
    variable: Variable,
    at: [f64; 3],
    samples: [usize; 3],
}

impl SpectrumInterval {
    /// Simpson's rule for each output.
    fn moments(&self, samples: &[Sample]) -> Vec<Moments> {
        let width = (self.at[2] - self.at[0]) / 6.0;
        let mut sums = vec![Moments::default(); samples[self.samples[0]].densities.total.len()];
        for ((at, index), weight) in self.at.iter().zip(self.samples).zip([1.0, 4.0, 1.0]) {
            let factor = weight * width * self.variable.slope(*at);
            sums.iter_mut().enumerate().for_each(|(k, sum)| sum.add(factor, &samples[index].integrand(k)));
        }
        sums
    }
}

impl Sample {
    /// Integrands over f of the moments of one output.
    fn integrand(&self, output: usize) -> Moments {
        let Self { frequency_hz, densities } = self;
        let total = densities.total[output];
        let second = frequency_hz * frequency_hz * total;
        Moments { variance: total, second, quasi_static: densities.quasi_static[output] }
    }
}

impl Gusts {
    /// Spectra of all outputs up to a frequency [Hz] or the last measured one of the gusts, and their moments. The peak
    /// of each of the `resonances`, ascending, is resolved from the start, however narrow it is. Frequencies are added
    /// until every moment is right to about 1e-4.
    ///
    /// # Errors
    /// [`GustError::Resonance`] and [`GustError::TooManyFrequencies`].
    ///
    /// # References
    /// docs/theory.md, equation (49o1).
    pub fn spectra(&self, up_to_hz: f64, resonances: &[GustResonance]) -> Result<Spectra, GustError> {
        let up_to_hz = self.field.measured_hz().last().map_or(up_to_hz, |last| last.min(up_to_hz));
        let lowest = self.field.lowest_hz().min(0.1 * up_to_hz);
        let mut samples = Vec::new();
        let mut stack = Vec::new();
        for piece in pieces([lowest, up_to_hz], resonances, self.field.measured_hz()) {
            self.add_intervals(&piece, &mut stack, &mut samples)?;
        }
        let max_frequencies = MAX_FREQUENCIES.max(MAX_OVER_FIRST * samples.len());

        // Sizes of the moments, for the tolerance.
        let mut sizes = vec![Moments::default(); self.outputs.len()];
        for interval in &stack {
            sizes.iter_mut().zip(interval.moments(&samples)).for_each(|(sum, of)| sum.add(1.0, &of));
        }
        share_noise(&mut sizes);

        // Below the lowest frequency the spectra are constant.
        let mut moments: Vec<Moments> = vec![Moments::default(); self.outputs.len()];
        let mut by_mode = VarianceByMode::new(resonances, self.outputs.len());
        let low = &samples[0];
        for (k, sum) in moments.iter_mut().enumerate() {
            sum.add(low.frequency_hz, &low.integrand(k));
            by_mode.add(k, low.frequency_hz, low.frequency_hz * low.densities.total[k]);
        }
        while let Some(interval) = stack.pop() {
            let [left, right] = self.halves(&interval, &mut samples)?;
            let whole = interval.moments(&samples);
            let mut halves = left.moments(&samples);
            halves.iter_mut().zip(right.moments(&samples)).for_each(|(sum, of)| sum.add(1.0, &of));
            let is_near = |new: f64, old: f64, size: f64| (new - old).abs() <= 15.0 * SPECTRUM_TOLERANCE * size;
            let agrees = sizes.iter().zip(&halves).zip(&whole).all(|((size, new), old)| {
                is_near(new.variance, old.variance, size.variance) && is_near(new.second, old.second, size.second)
            });
            if agrees {
                let middle_hz = samples[interval.samples[1]].frequency_hz;
                for (k, sum) in moments.iter_mut().enumerate() {
                    let mut part = Moments::default();
                    part.add(16.0 / 15.0, &halves[k]);
                    part.add(-1.0 / 15.0, &whole[k]);
                    sum.add(1.0, &part);
                    by_mode.add(k, middle_hz, part.variance);
                }
            } else {
                if samples.len() >= max_frequencies {
                    return Err(GustError::TooManyFrequencies { limit: max_frequencies });
                }
                stack.extend([left, right]);
            }
        }

        samples.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
        let frequencies_hz = samples.iter().map(|sample| sample.frequency_hz).collect();
        let densities = samples.into_iter().map(|of| of.densities).collect();
        Ok(Spectra { frequencies_hz, densities, moments, by_mode: by_mode.sums })
    }

    /// Adds the intervals of a piece and their samples. Its first sample is the last one if both are at one frequency.
    fn add_intervals(
        &self,
        piece: &FrequencyPart,
        intervals: &mut Vec<SpectrumInterval>,
        samples: &mut Vec<Sample>,
    ) -> Result<(), GustError> {
        let steps = piece.steps();
        let first_hz = piece.from_hz;
        let mut before = match samples.last() {
            Some(last) if last.frequency_hz.to_bits() == first_hz.to_bits() => samples.len() - 1,
            _ => self.sample(first_hz, samples)?,
        };
        for (i, pair) in steps.windows(2).enumerate() {
            let variable = piece.variable;
            let middle = 0.5 * (pair[0] + pair[1]);
            let middle_index = self.sample(variable.frequency_hz(middle), samples)?;
            let is_last = i + 2 == steps.len();
            let end_hz = if is_last { piece.to_hz } else { variable.frequency_hz(pair[1]) };
            let after = self.sample(end_hz, samples)?;
            let at = [pair[0], middle, pair[1]];
            intervals.push(SpectrumInterval { variable, at, samples: [before, middle_index, after] });
            before = after;
        }
        Ok(())
    }

    fn halves(&self, of: &SpectrumInterval, samples: &mut Vec<Sample>) -> Result<[SpectrumInterval; 2], GustError> {
        let SpectrumInterval { variable, at: [from, middle, to], samples: [first, second, third] } = *of;
        let mut half = |from: f64, to: f64, ends: [usize; 2]| -> Result<SpectrumInterval, GustError> {
            let middle = 0.5 * (from + to);
            let between = self.sample(variable.frequency_hz(middle), samples)?;
            Ok(SpectrumInterval { variable, at: [from, middle, to], samples: [ends[0], between, ends[1]] })
        };
        Ok([half(from, middle, [first, second])?, half(middle, to, [second, third])?])
    }

    /// Adds the spectra at a frequency; their index.
    fn sample(&self, frequency_hz: f64, samples: &mut Vec<Sample>) -> Result<usize, GustError> {
        samples.push(Sample { frequency_hz, densities: self.densities(frequency_hz)? });
        Ok(samples.len() - 1)
    }
}

/// Variance of each output nearest to each mode.
struct VarianceByMode {
    /// Frequencies at which a mode ends and the next one begins [Hz].
    edges_hz: Vec<f64>,
    sums: Vec<Vec<f64>>,
}

impl VarianceByMode {
    fn new(resonances: &[GustResonance], outputs: usize) -> Self {
        let edges_hz = resonances.windows(2).map(|pair| between(&pair[0], &pair[1])).collect();
        Self { edges_hz, sums: vec![vec![0.0; resonances.len()]; outputs] }
    }

    fn add(&mut self, output: usize, at_hz: f64, variance: f64) {
        let mode = self.edges_hz.partition_point(|edge| *edge <= at_hz);
        self.sums[output].get_mut(mode).into_iter().for_each(|sum| *sum += variance);
    }
}

/// Frequency at which the range of a resonance ends and that of the next one begins [Hz].
fn between(one: &GustResonance, next: &GustResonance) -> f64 {
    (one.frequency_hz * next.frequency_hz).sqrt()
}

/// Pieces of the frequencies between two [Hz]: about each peak as far as it is the nearest one and dominates, in
/// logarithms elsewhere, with ends at `kinks_hz` and between the ranges of all resonances, whose variances are told
/// apart.
fn pieces([lowest, highest]: [f64; 2], resonances: &[GustResonance], kinks_hz: &[f64]) -> Vec<FrequencyPart> {
    let peaks = parted(resonances);
    let edges = resonances.windows(2).map(|pair| between(&pair[0], &pair[1]));
    let mut ends: Vec<f64> = kinks_hz.iter().copied().chain(edges).collect();
    order::sort_ascending(&mut ends, |end| *end);
    let mut found = Vec::new();
    let mut add = |variable: Variable, from: f64, to: f64| {
        let (from, to) = (from.max(lowest), to.min(highest));
        let inner = ends.iter().copied().filter(|end| *end > from && *end < to);
        let mut from_hz = from;
        for to_hz in inner.chain([to]).filter(|_| to > from) {
            found.push(FrequencyPart { variable, from_hz, to_hz });
            from_hz = to_hz;
        }
    };

    let mut from = lowest;
    for (i, peak) in peaks.iter().enumerate() {
        let to = peaks.get(i + 1).map_or(highest, |next| between(peak, next)).min(highest);
        let frequency_hz = peak.frequency_hz;
        let [left, right] =
            [frequency_hz / PEAK_REACH, frequency_hz * PEAK_REACH].map(|of| of.clamp(from, to.max(from)));
        let half_width_hz = frequency_hz * peak.damping_ratio.max(MIN_RATIO);
        let about = Variable::AboutPeak { frequency_hz, half_width_hz };
        add(Variable::Logarithm, from, left);
        add(about, left, frequency_hz.min(right));
        add(about, frequency_hz.max(left), right);
        add(Variable::Logarithm, right, to);
        from = to.max(from);
    }
    add(Variable::Logarithm, from, highest);
    found
}

/// Resonances of which neighbours within a part of their widths are one, with the smallest of their widths.
fn parted(resonances: &[GustResonance]) -> Vec<GustResonance> {
    let mut peaks: Vec<GustResonance> = Vec::with_capacity(resonances.len());
    for of in resonances {
        match peaks.last_mut() {
            Some(last)
                if {
                    let ratio = last.damping_ratio.min(of.damping_ratio).max(MIN_RATIO);
                    of.frequency_hz - last.frequency_hz <= ONE_PEAK * ratio * of.frequency_hz
                } =>
            {
                last.damping_ratio = last.damping_ratio.min(of.damping_ratio);
            }
            _ => peaks.push(*of),
        }
    }
    peaks
}

/// Raises the sizes of outputs that move by rounding alone, as those that symmetry forbids, to a part of the
/// largest size: their spectra are noise, which no integration resolves.
fn share_noise(sizes: &mut [Moments]) {
    /// Square of the rounding of a solution, over the largest solution.
    const NOISE: f64 = 1e-18;

    let largest = sizes.iter().fold(Moments::default(), |largest, of| Moments {
        variance: largest.variance.max(of.variance),
        second: largest.second.max(of.second),
        quasi_static: 0.0,
    });
    for size in sizes {
        size.variance = size.variance.max(NOISE * largest.variance);
        size.second = size.second.max(NOISE * largest.second);
    }
}

//! Spectra over frequency, with frequencies where they are needed, and their moments.

use super::{Densities, GustError, Gusts};

/// Part of each moment by which one interval of the integration may be wrong. Some hundred intervals have errors far
/// below it, so that r.m.s. values are right to about 1e-4.
const SPECTRUM_TOLERANCE: f64 = 1e-5;

/// Intervals per decade from which the integration starts.
const PER_DECADE: f64 = 6.0;

/// Maximum number of frequencies: one second of work for a robot with eight cables.
const MAX_FREQUENCIES: usize = 20_000;

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
    /// Variance of each output nearest to each natural frequency, in their order: up to the geometric mean with the next
    /// one. Their sum is the variance; empty without natural frequencies.
    pub by_mode: Vec<Vec<f64>>,
}

/// Sample of the integrands over ln f.
#[derive(Clone)]
struct Sample {
    ln: f64,
    densities: Densities,
    /// Integrands of the moments of each output.
    integrands: Vec<Moments>,
}

/// SpectrumInterval with its middle.
struct SpectrumInterval {
    from: Sample,
    middle: Sample,
    to: Sample,
}

impl SpectrumInterval {
    /// Simpson's rule for each output.
    fn moments(&self) -> Vec<Moments> {
        let width = (self.to.ln - self.from.ln) / 6.0;
        (0..self.from.integrands.len())
            .map(|k| {
                let mut sum = Moments::default();
                sum.add(width, &self.from.integrands[k]);
                sum.add(4.0 * width, &self.middle.integrands[k]);
                sum.add(width, &self.to.integrands[k]);
                sum
            })
            .collect()
    }
}

impl Gusts {
    /// Spectra of all outputs up to a frequency [Hz] or the last measured one of the gusts, and their moments. Frequencies
    /// are added until every moment is right to about 1e-4; `natural_hz`, the natural frequencies of the robot,
    /// ascending, are among the first, so that no peak is missed.
    ///
    /// # Errors
    /// [`GustError::Resonance`] and [`GustError::TooManyFrequencies`].
    pub fn spectra(&self, up_to_hz: f64, natural_hz: &[f64]) -> Result<Spectra, GustError> {
        let up_to_hz = self.field.measured_hz().last().map_or(up_to_hz, |last| last.min(up_to_hz));
        let lowest = self.field.lowest_hz().min(0.1 * up_to_hz);
        let edges: Vec<f64> =
            natural_hz.iter().zip(natural_hz.iter().skip(1)).map(|(a, b)| 0.5 * (a.ln() + b.ln())).collect();
        let mut samples = Vec::new();
        let mut stack = self.first_intervals(lowest, up_to_hz, natural_hz, &mut samples)?;
        let low = samples[0].clone();

        // Sizes of the moments, for the tolerance.
        let mut sizes = vec![Moments::default(); self.outputs.len()];
        for interval in &stack {
            sizes.iter_mut().zip(interval.moments()).for_each(|(sum, of)| sum.add(1.0, &of));
        }
        share_noise(&mut sizes);

        // Below the lowest frequency the spectra are constant.
        let mut moments: Vec<Moments> = low.integrands.clone();
        let mut by_mode = vec![vec![0.0; natural_hz.len()]; self.outputs.len()];
        let mut add_to_mode = |k: usize, ln: f64, variance: f64| {
            let mode = edges.partition_point(|edge| *edge <= ln);
            by_mode[k].get_mut(mode).into_iter().for_each(|sum| *sum += variance);
        };
        low.integrands.iter().enumerate().for_each(|(k, of)| add_to_mode(k, low.ln, of.variance));
        while let Some(interval) = stack.pop() {
            let (whole, middle) = (interval.moments(), interval.middle.ln);
            let [left, right] = self.halves(interval, &mut samples)?;
            let (mut halves, more) = (left.moments(), right.moments());
            halves.iter_mut().zip(&more).for_each(|(sum, of)| sum.add(1.0, of));
            let gap = |k: usize| {
                let (size, new, old): (&Moments, &Moments, &Moments) = (&sizes[k], &halves[k], &whole[k]);
                let is_near = |new: f64, old: f64, size: f64| (new - old).abs() <= 15.0 * SPECTRUM_TOLERANCE * size;
                is_near(new.variance, old.variance, size.variance) && is_near(new.second, old.second, size.second)
            };
            if (0..halves.len()).all(gap) {
                for (k, sum) in moments.iter_mut().enumerate() {
                    sum.add(16.0 / 15.0, &halves[k]);
                    sum.add(-1.0 / 15.0, &whole[k]);
                    add_to_mode(k, middle, (16.0 * halves[k].variance - whole[k].variance) / 15.0);
                }
            } else {
                if samples.len() >= MAX_FREQUENCIES {
                    return Err(GustError::TooManyFrequencies { limit: MAX_FREQUENCIES });
                }
                stack.extend([left, right]);
            }
        }

        samples.sort_by(|a, b| a.ln.total_cmp(&b.ln));
        let frequencies_hz = samples.iter().map(|sample| sample.ln.exp()).collect();
        let densities = samples.into_iter().map(|of| of.densities).collect();
        Ok(Spectra { frequencies_hz, densities, moments, by_mode })
    }

    /// Intervals in equal ratios, with ends at the natural frequencies, between them, and at measured frequencies.
    fn first_intervals(
        &self,
        lowest: f64,
        highest: f64,
        natural_hz: &[f64],
        samples: &mut Vec<Sample>,
    ) -> Result<Vec<SpectrumInterval>, GustError> {
        let decades = (highest / lowest).log10();
        let count = (PER_DECADE * decades).ceil().max(1.0) as usize;
        let mut ends: Vec<f64> =
            (0..=count).map(|i| lowest.ln() + (highest / lowest).ln() * i as f64 / count as f64).collect();
        let between = natural_hz.iter().zip(natural_hz.iter().skip(1)).map(|(a, b)| (a * b).sqrt());
        let more = natural_hz.iter().copied().chain(between).chain(self.field.measured_hz().iter().copied());
        ends.extend(more.filter(|f| *f > lowest && *f < highest).map(f64::ln));
        ends.sort_by(f64::total_cmp);
        // Modes that share a frequency are one end.
        ends.dedup_by(|a, b| (*a - *b).abs() < 1e-9);

        let ends = ends.iter().map(|ln| self.sample(*ln, samples)).collect::<Result<Vec<_>, _>>()?;
        ends.windows(2)
            .map(|pair| {
                let middle = self.sample(0.5 * (pair[0].ln + pair[1].ln), samples)?;
                Ok(SpectrumInterval { from: pair[0].clone(), middle, to: pair[1].clone() })
            })
            .collect()
    }

    fn halves(&self, of: SpectrumInterval, samples: &mut Vec<Sample>) -> Result<[SpectrumInterval; 2], GustError> {
        let SpectrumInterval { from, middle, to } = of;
        let first = self.sample(0.5 * (from.ln + middle.ln), samples)?;
        let second = self.sample(0.5 * (middle.ln + to.ln), samples)?;
        Ok([
            SpectrumInterval { from, middle: first, to: middle.clone() },
            SpectrumInterval { from: middle, middle: second, to },
        ])
    }

    fn sample(&self, ln: f64, samples: &mut Vec<Sample>) -> Result<Sample, GustError> {
        let frequency_hz = ln.exp();
        let densities = self.densities(frequency_hz)?;
        let integrand = |(total, still): (&f64, &f64)| Moments {
            variance: frequency_hz * total,
            second: frequency_hz.powi(3) * total,
            quasi_static: frequency_hz * still,
        };
        let integrands = densities.total.iter().zip(&densities.quasi_static).map(integrand).collect();
        let sample = Sample { ln, densities, integrands };
        samples.push(sample.clone());
        Ok(sample)
    }
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

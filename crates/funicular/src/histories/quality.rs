//! Quality of samples before any fit: even times, clipped and coarse values, energy near the Nyquist frequency.

use super::poles::Samples;
use crate::math::Complex;
use std::f64::consts::TAU;

/// Minimum number of equal extreme samples in a row that shows a clipped sensor.
const CLIPPED_RUN: usize = 4;

/// Length of the pieces whose spectra are averaged.
const PIECE: usize = 64;

/// Part of the sampling rate above which energy is near the Nyquist frequency.
const HIGH: f64 = 0.4;

/// Irregularity of times: standard deviation of the time steps over their mean.
pub fn jitter(samples: &Samples) -> f64 {
    let time = samples.time();
    let step = samples.step();
    let squares: f64 = time.windows(2).map(|pair| (pair[1] - pair[0] - step).powi(2)).sum();
    (squares / (time.len() - 1) as f64).sqrt() / step
}

/// Number of samples of a channel that stand at its maximum or minimum in runs: a sensor at the end of its range.
pub fn clipped(samples: &Samples, channel: usize) -> usize {
    let column = samples.values().column(channel);
    let mut found = 0;
    for limit in [column.max(), column.min()] {
        let mut run = 0;
        for value in column.iter().copied().chain([f64::NAN]) {
            // A sensor that clips repeats the very number.
            if value.to_bits() == limit.to_bits() {
                run += 1;
            } else {
                found += if run >= CLIPPED_RUN { run } else { 0 };
                run = 0;
            }
        }
    }
    found
}

/// Step of the values of a channel: the smallest difference of two that are not equal.
pub fn quantum(samples: &Samples, channel: usize) -> f64 {
    let mut values: Vec<f64> = samples.values().column(channel).iter().copied().collect();
    values.sort_by(f64::total_cmp);
    let rounding = 1e-9 * samples.spread(channel);
    let steps = values.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > rounding);
    steps.fold(f64::INFINITY, f64::min)
}

/// Part of the energy of a channel above four tenths of the sampling rate, to which frequencies above the Nyquist
/// frequency are folded.
pub fn high_energy(samples: &Samples, channel: usize) -> f64 {
    let column = samples.values().column(channel);
    let size = PIECE.min(column.len());
    let (mut high, mut all) = (0.0, 0.0);
    for start in (0..=column.len() - size).step_by((size / 2).max(1)) {
        let piece = column.rows(start, size);
        let mean = piece.mean();
        for line in 1..=size / 2 {
            let turn = |(row, value): (usize, &f64)| {
                // Hann's window.
                let weight = (0.5 * TAU * (row as f64 + 0.5) / size as f64).sin().powi(2);
                Complex::from_polar(weight * (value - mean), -TAU * (line * row) as f64 / size as f64)
            };
            let energy = piece.iter().enumerate().map(turn).sum::<Complex>().norm_sqr();
            all += energy;
            high += if line as f64 > HIGH * size as f64 { energy } else { 0.0 };
        }
    }
    if all > 0.0 { high / all } else { 0.0 }
}

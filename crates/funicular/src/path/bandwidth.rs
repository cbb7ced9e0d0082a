//! Frequencies of a motion.

use super::PlatformPath;
use crate::math::{Complex, Vec6};
use std::f64::consts::TAU;

/// Number of times at which the acceleration is looked at.
const TIMES: usize = 512;

/// Number of frequencies per 1/duration.
const FINER: usize = 4;

impl PlatformPath {
    /// Frequency [Hz] below which the given part of `∫|a|² dt` lies, a being the acceleration with angular
    /// accelerations times a length [m]. Zero for a path without acceleration.
    pub fn frequency_below_which(&self, part: f64, length: f64) -> f64 {
        let step = self.duration() / TIMES as f64;
        let scaled = |k: usize| {
            let of = self.at(step * (k as f64 + 0.5)).acceleration_w;
            Vec6::from_fn(|i, _| if i < 3 { of[i] } else { of[i] * length })
        };
        let accelerations: Vec<Vec6> = (0..TIMES).map(scaled).collect();

        // Half of the intervals of the transform up to the highest frequency that the times show.
        let spacing = 1.0 / (FINER as f64 * self.duration());
        let powers = (0..TIMES * FINER / 2).map(|n| power(&accelerations, TAU * n as f64 * spacing * step));
        let powers: Vec<f64> = powers.collect();
        let whole: f64 = powers.iter().sum();
        let mut sum = 0.0;
        let reached = powers.iter().position(|power| {
            sum += power;
            sum >= part * whole
        });
        if whole > 0.0 { reached.unwrap_or(0) as f64 * spacing } else { 0.0 }
    }
}

/// Square of the magnitude of the Fourier transform of samples, at an angle per sample.
fn power(samples: &[Vec6], angle: f64) -> f64 {
    let turn = Complex::from_polar(1.0, -angle);
    let mut sum = [Complex::new(0.0, 0.0); 6];
    let mut phase = Complex::new(1.0, 0.0);
    for sample in samples {
        for (sum, value) in sum.iter_mut().zip(sample.iter()) {
            *sum += phase * *value;
        }
        phase *= turn;
    }
    sum.iter().map(Complex::norm_sqr).sum()
}

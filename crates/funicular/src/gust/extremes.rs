//! Expected extremes of a Gaussian process within a time, from its r.m.s. value and its rate of crossings.

use std::f64::consts::PI;

/// Least expected number of crossings of the mean for which an expected peak is given: the formula is asymptotic.
pub const MIN_CROSSINGS: f64 = 10.0;

/// Euler's constant.
const EULER: f64 = 0.577_215_664_901_532_9;

/// Largest excursion to one side in a time, over the r.m.s. value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PeakFactor {
    /// Expected value of the peak.
    pub mean: f64,
    /// Standard deviation of the peak.
    pub deviation: f64,
}

impl PeakFactor {
    /// Peak factor of a process that crosses its mean upwards at a rate [Hz], in a time [s]. `None` for fewer than
    /// [`MIN_CROSSINGS`] expected crossings.
    ///
    /// # References
    /// A. G. Davenport, Proc. Inst. Civ. Eng. 28, 1964; docs/theory.md, equation (49p).
    pub fn new(rate: f64, duration: f64) -> Option<Self> {
        let crossings = rate * duration;
        if crossings.is_nan() || crossings < MIN_CROSSINGS {
            return None;
        }
        let root = (2.0 * crossings.ln()).sqrt();
        Some(Self { mean: root + EULER / root, deviation: PI / 6.0_f64.sqrt() / root })
    }
}

/// Probability that a process with a mean, an r.m.s. value about it and a rate of crossings [Hz] falls to zero within a
/// time [s]: its crossings of a level come one by one, as those of a Gaussian process at a rare level do.
///
/// # References
/// docs/theory.md, equation (49q).
pub fn slack_probability(mean: f64, rms: f64, rate: f64, duration: f64) -> f64 {
    if rms == 0.0 {
        return if mean > 0.0 { 0.0 } else { 1.0 };
    }
    let expected = rate * duration * (-0.5 * (mean / rms).powi(2)).exp();
    if mean > 0.0 { -(-expected).exp_m1() } else { 1.0 }
}

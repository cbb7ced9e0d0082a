//! Resonances of a response and the approach to its maxima.
//!
//! A maximum is known to lie between two frequencies if the response is higher at one between them. It is approached by
//! parabolas through 1/|H|², which is a parabola at a single resonance. Other tops, as the flat ripple between two
//! resonances, are none: a parabola whose steps do not shrink gives way to a division of the larger side, as in Brent's
//! method. Both sides are narrowed, so that the height is known and not only that of the last parabola.
//!
//! Reference: R. P. Brent, Algorithms for Minimization without Derivatives, Prentice-Hall 1973, chapter 5.

use super::Measured;
use crate::modes::Mode;

/// Maximum damping ratio of a mode that counts as undamped. Rounding of its frequency would change the height of its
/// peak.
const UNDAMPED: f64 = 1e-9;
/// Relative half width of the gap at an undamped natural frequency. The curve is 80 dB above its level there.
const GAP: f64 = 5e-5;

/// Resonance of the response: a natural frequency with its half width.
#[derive(Debug, Clone, Copy)]
pub(super) struct Resonance {
    pub(super) hz: f64,
    /// Half width [Hz]; that of a gap for an undamped mode.
    pub(super) half_width: f64,
    pub(super) damped: bool,
}

impl Resonance {
    pub(super) fn of(mode: &Mode) -> Self {
        let damped = mode.damping_ratio > UNDAMPED;
        let ratio = if damped { mode.damping_ratio } else { GAP };
        Self { hz: mode.frequency_hz, half_width: ratio * mode.frequency_hz, damped }
    }
}

/// Relative accuracy of a known height. Rounding of a response that is not lost in it lies below.
const HEIGHT: f64 = 1e-10;
/// Maximum number of steps to a maximum. Five to eight are usual; the flattest ripples of random robots need 20.
const MAX_STEPS: usize = 40;
/// Fraction of the larger side at which it is divided: that of the golden section.
const GOLDEN: f64 = 0.381_966_011_250_105;
/// Minimum relative step. Rounding hides a smaller change of the frequency.
const MIN_STEP: f64 = 1e-13;

/// Maximum of one response that is being approached: three ascending frequencies and the magnitudes there. The middle
/// one is the highest.
#[derive(Debug, Clone, Copy)]
pub(super) struct BracketedMaximum {
    pub(super) channel: usize,
    hz: [f64; 3],
    magnitude: [f64; 3],
    /// Lengths of the last two steps [Hz].
    steps: [f64; 2],
}

impl BracketedMaximum {
    pub(super) fn between(channel: usize, hz: [f64; 3], magnitude: [f64; 3]) -> Self {
        Self { channel, hz, magnitude, steps: [f64::INFINITY; 2] }
    }

    /// Frequency of the highest magnitude so far [Hz].
    pub(super) fn hz(&self) -> f64 {
        self.hz[1]
    }

    /// Highest magnitude so far.
    pub(super) fn height(&self) -> f64 {
        self.magnitude[1]
    }

    /// Squares of the height relative to the three magnitudes: 1/|H|², with 1 in the middle.
    fn inverse_squares(&self) -> [f64; 3] {
        self.magnitude.map(|m| (self.height() / m).powi(2))
    }

    /// Bound that the maximum does not exceed if 1/|H|² is convex between the outer frequencies, as it is at a single
    /// resonance: each of the two secants, continued, lies below it.
    pub(super) fn bound(&self) -> f64 {
        let [x0, x1, x2] = self.hz;
        let [y0, _, y2] = self.inverse_squares();
        let (left, right) = (x1 - x0, x2 - x1);
        let fall = ((y0 - 1.0) * right / left).max((y2 - 1.0) * left / right);
        if fall < 1.0 { self.height() / (1.0 - fall).sqrt() } else { f64::INFINITY }
    }

    /// True if the height is that of the maximum.
    pub(super) fn is_known(&self) -> bool {
        self.bound() <= self.height() * (1.0 + HEIGHT)
    }

    /// Frequency of the next step [Hz]; `None` if rounding ends the approach.
    fn next_hz(&self) -> Option<f64> {
        let [x0, x1, x2] = self.hz;
        let [y0, y1, y2] = self.inverse_squares();
        let (left, right) = (x1 - x0, x2 - x1);
        let larger = if right > left { right } else { -left };

        // The vertex of the parabola, if it lies inside and the steps shrink.
        let (fall, rise) = ((y1 - y0) / left, (y2 - y1) / right);
        let curvature = (rise - fall) / (left + right);
        let vertex = -(fall * right + rise * left) / (left + right) / (2.0 * curvature);
        let shrinks = vertex > -left && vertex < right && vertex.abs() < 0.5 * self.steps[0];
        let step = if shrinks { vertex } else { GOLDEN * larger };

        // A step of which the height shows nothing narrows the larger side.
        let min_step = (0.1 * HEIGHT / curvature).sqrt().max(MIN_STEP * x1);
        let step = if step.abs() < min_step { min_step.copysign(larger) } else { step };
        (step.abs() < larger.abs()).then_some(x1 + step)
    }

    /// Narrows the interval by the magnitude at a frequency inside it.
    fn narrow(&mut self, hz: f64, magnitude: f64) {
        self.steps = [self.steps[1], (hz - self.hz[1]).abs()];
        let above = hz > self.hz[1];
        if magnitude > self.magnitude[1] {
            let end = if above { 0 } else { 2 };
            (self.hz[end], self.magnitude[end]) = (self.hz[1], self.magnitude[1]);
            (self.hz[1], self.magnitude[1]) = (hz, magnitude);
        } else {
            let end = if above { 2 } else { 0 };
            (self.hz[end], self.magnitude[end]) = (hz, magnitude);
        }
    }
}

/// Approaches maxima, all of them side by side, each until it is near enough; returns the row of all responses at each
/// maximum that has moved.
pub(super) fn approach<E>(
    maxima: &mut [BracketedMaximum],
    is_near: impl Fn(usize, &BracketedMaximum) -> bool,
    evaluate: &mut impl FnMut(&[f64]) -> Result<Vec<Vec<Measured>>, E>,
) -> Result<Vec<Option<Vec<Measured>>>, E> {
    let mut rows: Vec<Option<Vec<Measured>>> = vec![None; maxima.len()];
    for _ in 0..MAX_STEPS {
        let open = maxima.iter().enumerate().filter(|(k, maximum)| !is_near(*k, maximum));
        let next: Vec<(usize, f64)> = open.filter_map(|(k, maximum)| Some((k, maximum.next_hz()?))).collect();
        if next.is_empty() {
            break;
        }

        let hz: Vec<f64> = next.iter().map(|next| next.1).collect();
        for ((k, hz), row) in next.into_iter().zip(evaluate(&hz)?) {
            let magnitude = row[maxima[k].channel].value.norm();
            if magnitude > maxima[k].height() {
                rows[k] = Some(row);
            }
            maxima[k].narrow(hz, magnitude);
        }
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Complex;

    /// Height of the maximum of a response between −1 and 1 about 10 Hz, and the number of frequencies for it.
    fn approached(at: f64, response: impl Fn(f64) -> f64) -> (BracketedMaximum, usize) {
        let hz = [9.0, at, 11.0];
        let mut maxima = [BracketedMaximum::between(0, hz, hz.map(&response))];
        let mut count = 0;
        let mut evaluate = |hz: &[f64]| -> Result<Vec<Vec<Measured>>, ()> {
            count += hz.len();
            let measured = |hz: &f64| vec![Measured { value: Complex::new(response(*hz), 0.0), floor: 0.0 }];
            Ok(hz.iter().map(measured).collect())
        };
        approach(&mut maxima, |_, maximum| maximum.is_known(), &mut evaluate).unwrap();
        (maxima[0], count)
    }

    #[test]
    fn a_maximum_has_its_height_whatever_the_shape_of_its_top_is() {
        let resonance = |f: f64| 1.0 / (1e-4 + (f - 10.1).powi(2)).sqrt();
        let flat = |f: f64| 3.0 / (1.0 + (f - 10.2).powi(4));
        let skewed = |f: f64| (0.3 * (f - 10.3)).exp() * 2.0 / (1.0 + (f - 10.3).powi(6) + 0.15 * (f - 10.3));
        let corner = |f: f64| 1.0 - (f - 9.9).abs();
        for (name, at, response) in [
            ("resonance", 10.0, &resonance as &dyn Fn(f64) -> f64),
            ("flat", 9.7, &flat),
            ("skewed", 10.0, &skewed),
            ("corner", 10.0, &corner),
        ] {
            let (maximum, count) = approached(at, response);
            let dense = (0..=2_000_000).map(|i| response(9.0 + f64::from(i) * 1e-6)).fold(0.0, f64::max);
            assert!(maximum.height() > dense * (1.0 - 2.0 * HEIGHT), "{name}: {maximum:?} {dense} after {count}");
            assert!(count <= MAX_STEPS, "{name}: {count}");
            if name == "resonance" {
                assert!(count < 10 && (maximum.hz() - 10.1).abs() < 1e-6, "{maximum:?} after {count}");
            }
        }
    }

    #[test]
    fn noise_and_zeros_end_the_approach() {
        for response in [&(|f: f64| 1.0 + 1e-3 * (1e9 * f).sin()) as &dyn Fn(f64) -> f64, &|f: f64| {
            f64::from(u8::from((f - 10.0).abs() < f64::MIN_POSITIVE))
        }] {
            let (maximum, count) = approached(10.0, response);
            assert!(count <= MAX_STEPS && maximum.height().is_finite(), "{maximum:?} after {count}");
        }
    }
}

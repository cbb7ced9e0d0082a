//! Peaks that the frequencies of a response miss: maxima between them that are higher than the values beside them.

use super::Measured;
use super::maxima::{BracketedMaximum, Resonance, approach};
use crate::math::{Complex, order};
use crate::modes::Mode;
use std::iter::once;

/// Peak that a grid reads too low.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MissedPeak {
    /// Index of the response.
    pub response: usize,
    /// Frequency of the grid with the higher magnitude beside the peak [Hz].
    pub read_hz: f64,
    /// Magnitude at that frequency of the grid.
    pub read: f64,
    /// Frequency of the maximum [Hz].
    pub frequency_hz: f64,
    /// Magnitude at the maximum.
    pub height: f64,
}

/// Peaks that a grid reads too low.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MissedPeaks {
    /// Number of these peaks.
    pub count: usize,
    /// Peak of which the grid reads the smallest fraction.
    pub worst: MissedPeak,
}

/// Height of a peak above the value that a grid reads beside it, relative to this value, above which the grid misses
/// the peak.
pub const MISSED: f64 = 0.05;
/// Places in half widths around a natural frequency at which the response is compared with its grid. A resonance in
/// front of a background has its maximum at one of them or between, within a few per cent of the height.
const PLACES: [f64; 5] = [-2.5, -1.0, 0.0, 1.0, 2.5];
/// Maximum distance of a predicted peak from the middle of the frequencies that predict it, in half of their span.
/// Farther away the prediction is a guess.
const MAX_PREDICTED: f64 = 30.0;
/// Minimum height of a predicted peak above the values beside it, relative to these, at which the response is computed
/// at the peak.
const PREDICTED: f64 = 1e-3;
/// Maximum distance, in predicted half widths, of two predicted peaks that count as one.
const EQUAL: f64 = 0.2;
/// Maximum number of rounds of predictions. Each round uses the values of the rounds before.
const MAX_PREDICTIONS: usize = 4;

/// Response near one pole: `b + r/(f − p)` with the background b, the residue r and the pole p.
#[derive(Debug, Clone, Copy)]
struct OnePole {
    background: Complex,
    residue: Complex,
    pole: Complex,
}

impl OnePole {
    /// Response with the given values at three ascending frequencies; `None` if the values are on a straight line.
    fn through([left, middle, right]: [(f64, Complex); 3]) -> Option<Self> {
        // The divided differences are −r/((f₁ − p)(f₂ − p)).
        let below = (middle.1 - left.1) / (middle.0 - left.0);
        let above = (right.1 - middle.1) / (right.0 - middle.0);
        let pole = (below * left.0 - above * right.0) / (below - above);
        let residue = -below * (pole - left.0) * (pole - middle.0);
        let background = middle.1 + residue / (pole - middle.0);
        let finite = |z: Complex| z.re.is_finite() && z.im.is_finite();
        (finite(pole) && finite(background) && finite(residue) && pole.im.abs() > 0.0 && residue.norm() > 0.0)
            .then_some(Self { background, residue, pole })
    }

    /// Place and height of the maximum over real frequencies.
    fn top(&self) -> (f64, f64) {
        // 1/(f − p) moves on a circle through zero, and so does the response.
        let center = Complex::new(0.0, 0.5 / self.pole.im);
        let response = self.background + self.residue * center;
        let radius = self.residue.norm() * center.norm();
        let outwards = if response.norm() > 0.0 { response / response.norm() } else { Complex::new(1.0, 0.0) };
        let at = center + outwards * radius / self.residue;
        ((self.pole + at.inv()).re, response.norm() + radius)
    }
}

/// Frequency between those of a grid, with all responses there.
struct Between {
    hz: f64,
    /// Index of the next higher frequency of the grid.
    above: usize,
    /// Round of predictions that has given it; 0 for a frequency around a natural one.
    round: usize,
    row: Vec<Measured>,
}

/// Frequencies of a plain response with its values, one row per response.
#[derive(Clone, Copy)]
struct Grid<'a> {
    hz: &'a [f64],
    values: &'a [Vec<Complex>],
}

impl Grid<'_> {
    /// True if a frequency lies between two of the grid.
    fn has_inside(&self, hz: f64) -> bool {
        self.hz[0] < hz && hz < self.hz[self.hz.len() - 1]
    }

    /// Index of the first frequency of the grid that is not lower.
    fn above(&self, hz: f64) -> usize {
        self.hz.partition_point(|at| *at < hz)
    }

    /// Higher value at the ends of an interval, with its frequency.
    fn read(&self, response: usize, above: usize) -> ReadValue {
        let [low, high] = [above - 1, above].map(|i| (self.hz[i], self.values[response][i].norm()));
        let (read_hz, read) = if low.1 >= high.1 { low } else { high };
        ReadValue { read_hz, read }
    }

    /// One response in an interval: the values between its ends, and those at its ends.
    fn curve(&self, response: usize, inside: &[Between]) -> Vec<(f64, Complex)> {
        let end = |i: usize| (self.hz[i], self.values[response][i]);
        let above = inside[0].above;
        let between = inside.iter().map(|place| (place.hz, place.row[response].value));
        once(end(above - 1)).chain(between).chain(once(end(above))).collect()
    }

    /// Frequencies [Hz] of peaks that three neighbouring values predict, if one of the values is from the last round
    /// and the peak is higher than the values beside it.
    fn predicted(&self, all: &[Between], round: usize) -> Vec<f64> {
        let is_higher = |response: usize, hz: f64, height: f64| {
            let above = self.above(hz);
            // Another peak of the interval may be higher: the values on either side count.
            let next = all.partition_point(|place| place.hz < hz);
            let beside = [next.checked_sub(1), Some(next)].into_iter().flatten().filter_map(|i| all.get(i));
            let beside = beside.filter(|place| place.above == above);
            let highest = beside.map(|place| place.row[response].value.norm()).fold(0.0, f64::max);
            height > (1.0 + MISSED) * self.read(response, above).read && height > (1.0 + PREDICTED) * highest
        };

        let mut found: Vec<(f64, f64)> = Vec::new();
        for group in all.chunk_by(|a, b| a.above == b.above) {
            // Place i of the group is value i + 1 of its curve.
            let is_new = |i: usize| group.get(i).is_some_and(|place| place.round == round);
            let begins =
                |begin: &usize| begin.checked_sub(1).is_some_and(is_new) || is_new(*begin) || is_new(begin + 1);
            let begins: Vec<usize> = (0..group.len()).filter(begins).collect();
            if begins.is_empty() {
                continue;
            }

            for response in 0..self.values.len() {
                let curve = self.curve(response, group);
                for three in begins.iter().map(|begin| &curve[*begin..*begin + 3]) {
                    let Some(model) = OnePole::through([three[0], three[1], three[2]]) else { continue };
                    let (hz, height) = model.top();
                    let is_near = (hz - three[1].0).abs() <= MAX_PREDICTED * 0.5 * (three[2].0 - three[0].0);
                    if is_near && self.has_inside(hz) && height.is_finite() && is_higher(response, hz, height) {
                        found.push((hz, model.pole.im.abs()));
                    }
                }
            }
        }
        order::sort_ascending(&mut found, |of| of.0);
        found.dedup_by(|b, a| b.0 - a.0 <= EQUAL * a.1.min(b.1));
        found.into_iter().map(|of| of.0).collect()
    }

    /// Responses between the frequencies of the grid, ascending: around every natural frequency, and at the peaks
    /// beside it that these values predict.
    fn around_resonances<E>(
        &self,
        modes: &[Mode],
        evaluate: &mut impl FnMut(&[f64]) -> Result<Vec<Vec<Measured>>, E>,
    ) -> Result<Vec<Between>, E> {
        let resonances = modes.iter().map(Resonance::of).filter(|resonance| resonance.damped);
        let places = resonances.flat_map(|r| PLACES.map(|k| r.hz + k * r.half_width));
        let mut next: Vec<f64> = places.filter(|hz| self.has_inside(*hz)).collect();
        let mut all: Vec<Between> = Vec::with_capacity(next.len());
        for round in 0..=MAX_PREDICTIONS {
            if next.is_empty() {
                break;
            }
            let rows = evaluate(&next)?;
            let new = next.iter().zip(rows);
            all.extend(new.map(|(hz, row)| Between { hz: *hz, above: self.above(*hz), round, row }));

            all.retain(|place| self.hz[place.above] > place.hz);
            order::sort_ascending(&mut all, |place| place.hz);
            all.dedup_by(|b, a| b.hz - a.hz <= 0.0);
            next = self.predicted(&all, round);
        }
        Ok(all)
    }
}

/// Higher value of the grid beside a maximum.
#[derive(Debug, Clone, Copy)]
struct ReadValue {
    read_hz: f64,
    read: f64,
}

impl ReadValue {
    /// True if the maximum is higher than the grid shows.
    fn is_missed(&self, maximum: &BracketedMaximum) -> bool {
        maximum.height() > (1.0 + MISSED) * self.read
    }

    /// True if the maximum cannot be much higher than the grid shows.
    fn is_shown(&self, maximum: &BracketedMaximum) -> bool {
        maximum.bound() <= (1.0 + MISSED) * self.read
    }
}

/// Peaks between the frequencies of a grid (ascending) that are more than 5 % ([`MISSED`]) higher than the values of
/// the grid on both sides; `None` if there are none. `values` has a row per response; `modes` are the natural modes
/// between the ends of the grid; `evaluate` computes all responses at frequencies, one row per frequency.
///
/// A value between two frequencies that is higher than those at both proves a maximum there. The responses are computed
/// around every natural frequency. Three neighbouring values give a pole and so the place of a peak, which damping and
/// the other modes move away from the natural frequency. So nearly every resonance is counted that is at least 6 %
/// higher than the grid shows; one of several overlapping modes may be left out. A rise between two antiresonances,
/// without a natural frequency, may be missed. Undamped modes are not compared, because their peaks have no finite
/// height.
///
/// # Errors
/// The errors of `evaluate`.
pub fn missed_peaks<E>(
    grid_hz: &[f64],
    values: &[Vec<Complex>],
    modes: &[Mode],
    mut evaluate: impl FnMut(&[f64]) -> Result<Vec<Vec<Measured>>, E>,
) -> Result<Option<MissedPeaks>, E> {
    if grid_hz.len() < 2 {
        return Ok(None);
    }
    let grid = Grid { hz: grid_hz, values };
    let between = grid.around_resonances(modes, &mut evaluate)?;

    // Maxima among the places of each interval of the grid that may be high enough.
    let mut read_values: Vec<ReadValue> = Vec::new();
    let mut maxima: Vec<BracketedMaximum> = Vec::new();
    for group in between.chunk_by(|a, b| a.above == b.above) {
        for response in 0..values.len() {
            let read_value = grid.read(response, group[0].above);
            let floor = group.iter().map(|place| place.row[response].floor).fold(0.0, f64::max);
            let curve = grid.curve(response, group).into_iter().map(|(hz, value)| (hz, value.norm()));
            let curve: Vec<(f64, f64)> = curve.collect();

            for three in curve.windows(3) {
                let [left, top, right] = [three[0], three[1], three[2]];
                let maximum = BracketedMaximum::between(response, [left.0, top.0, right.0], [left.1, top.1, right.1]);
                if top.1 > left.1 && top.1 >= right.1 && top.1 > floor && !read_value.is_shown(&maximum) {
                    read_values.push(read_value);
                    maxima.push(maximum);
                }
            }
        }
    }

    // The height decides where the places leave it open.
    let is_decided = |k: usize, of: &BracketedMaximum| read_values[k].is_missed(of) || read_values[k].is_shown(of);
    approach(&mut maxima, is_decided, &mut evaluate)?;
    let missed: Vec<(&ReadValue, &BracketedMaximum)> =
        read_values.iter().zip(&maxima).filter(|(read_value, maximum)| read_value.is_missed(maximum)).collect();

    // The worst with its height.
    let fraction = |(read_value, maximum): &(&ReadValue, &BracketedMaximum)| read_value.read / maximum.height();
    let Some((ReadValue { read_hz, read }, worst)) = missed.iter().min_by(|a, b| fraction(a).total_cmp(&fraction(b)))
    else {
        return Ok(None);
    };
    let mut worst = [**worst];
    approach(&mut worst, |_, maximum| maximum.is_known(), &mut evaluate)?;
    let [worst] = worst;
    let worst = MissedPeak {
        response: worst.channel,
        read_hz: *read_hz,
        read: *read,
        frequency_hz: worst.hz(),
        height: worst.height(),
    };
    Ok(Some(MissedPeaks { count: missed.len(), worst }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_values_of_one_pole_give_the_top_of_the_response() {
        for (background, residue, pole) in [
            (Complex::new(0.3, -0.1), Complex::new(0.02, 0.01), Complex::new(10.0, 0.05)),
            (Complex::new(-2.0, 0.5), Complex::new(0.0, 0.1), Complex::new(9.9, -0.2)),
            (Complex::new(0.0, 0.0), Complex::new(1.0, 0.0), Complex::new(10.4, 0.01)),
        ] {
            let response = |f: f64| background + residue / (Complex::new(f, 0.0) - pole);
            let model = OnePole::through([9.7, 9.95, 10.1].map(|f| (f, response(f)))).unwrap();
            assert!((model.pole - pole).norm() < 1e-9 && (model.residue - residue).norm() < 1e-9, "{model:?}");

            let (hz, height) = model.top();
            let highest = (0..=4_000_000).map(|i| response(8.0 + f64::from(i) * 1e-6).norm()).fold(0.0, f64::max);
            assert!((height / highest - 1.0).abs() < 1e-6, "{height} {highest}");
            assert!((response(hz).norm() / height - 1.0).abs() < 1e-9, "{hz}");
        }
    }
}

//! Frequencies at which a response is drawn with the true height of every peak.
//!
//! Between two frequencies a drawn curve is a straight line over the logarithm of the magnitude. The search starts from
//! a grid, from the natural frequencies and from points around these at multiples of their half widths. Then it halves
//! every interval whose middle is not on its line. The natural frequencies are known, so that no resonance is narrower
//! than the intervals in which the halving begins. An antiresonance has no known place or width. It bends the curve far
//! beside it, so that the halving finds it, and it is resolved until rounding hides the response.

use super::maxima::{BracketedMaximum, Resonance, approach};
use super::{Measured, Peak, peaks};
use crate::math::{Complex, order};
use crate::modes::Mode;
use std::f64::consts::TAU;

/// Accuracy of a resolved curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resolution {
    /// Maximum relative error of the magnitude if its logarithm is interpolated between neighbouring frequencies.
    pub tolerance: f64,
    /// Number of frequencies beyond which no interval is halved any more.
    pub max_points: usize,
}

impl Default for Resolution {
    /// 1 % (0.09 dB) and 200,000 frequencies, which take about a second.
    fn default() -> Self {
        Self { tolerance: 0.01, max_points: 200_000 }
    }
}

/// Responses at frequencies that resolve all of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Resolved {
    /// Frequencies [Hz], ascending.
    pub frequencies_hz: Vec<f64>,
    /// Values per response, one per frequency.
    pub values: Vec<Vec<Complex>>,
    /// Undamped natural frequencies in the range [Hz]. The curves have gaps there.
    pub undamped_hz: Vec<f64>,
    /// Number of intervals that the limit of points has left coarser than the tolerance.
    pub unresolved: usize,
    /// Edges of the gaps: indices of neighbouring frequencies.
    gaps: Vec<(usize, usize)>,
}

impl Resolved {
    /// Peaks of response `i` with at least the given prominence [dB], ascending in frequency. Each has the frequency
    /// and the magnitude of the maximum. Undamped resonances have no finite height and are left out.
    pub fn peaks(&self, i: usize, min_prominence_db: f64) -> Vec<Peak> {
        let beside_gap = |at: usize| self.gaps.iter().any(|(left, right)| at == *left || at == *right);
        peaks::tops(&self.values[i], min_prominence_db)
            .into_iter()
            .filter(|top| !beside_gap(top.at))
            .map(|top| Peak {
                frequency_hz: self.frequencies_hz[top.at],
                prominence_db: top.prominence_db,
                magnitude: self.values[i][top.at].norm(),
            })
            .collect()
    }

    /// Undamped resonances of response `i` [Hz]: those undamped natural frequencies at which its magnitude grows
    /// without bound.
    pub fn undamped_resonances_hz(&self, i: usize) -> Vec<f64> {
        let magnitude = |at: usize| self.values[i][at].norm();
        let grows = |(left, right): &(usize, usize)| {
            *left > 0
                && *right + 1 < self.frequencies_hz.len()
                && magnitude(*left) > magnitude(left - 1)
                && magnitude(*right) > magnitude(right + 1)
        };
        let mut found = Vec::new();
        for gap in self.gaps.iter().filter(|gap| grows(gap)) {
            let (low, high) = (self.frequencies_hz[gap.0], self.frequencies_hz[gap.1]);
            found.extend(self.undamped_hz.iter().filter(|hz| (low..=high).contains(*hz)));
        }
        found
    }
}

/// Ratio between the distances of neighbouring starts from a natural frequency: √10.
const STEP_OUT: f64 = 3.162_277_660_168_379_5;
/// Maximum number of starts on one side of a natural frequency; they reach 1e6 half widths.
const MAX_STEPS_OUT: usize = 13;
/// Maximum distance of the middle of an interval from its line, as a fraction of the tolerance.
const HALVED: f64 = 0.4;
/// Number of successive halvings whose middles have to be on their lines. One is not enough where a curve crosses its
/// line at the middle: with 1, and with 0.2 for [`HALVED`], the error still reaches 1.003 times the tolerance.
const HALVINGS: u8 = 2;
/// Maximum difference of phase between curve and line [rad] at the middle of an interval.
const PHASE: f64 = 0.1;
/// Maximum distance of a point that is left out from the line between its neighbours, as a fraction of the tolerance.
/// With 0.8 the error between the points reaches 1.1 times the tolerance at deep antiresonances.
const LEFT_OUT: f64 = 0.6;
/// Minimum relative width of an interval, except at an antiresonance, as a fraction of the smallest damping ratio: no
/// resonance bends the curve within a narrower interval. The width is limited to the range below.
const WIDTH_PER_DAMPING: f64 = 0.02;
const WIDTHS: (f64, f64) = (1e-10, 1e-5);
/// Minimum relative width of an interval at an antiresonance: some hundred times the rounding of a frequency. The
/// response is then below 1e-9 of its terms, unless the slope is steeper than that of a resonance with a damping ratio
/// of 1e-4.
const NARROWEST: f64 = 1e-13;
/// Maximum distance of the middle of an interval from the straight line between its ends, in the complex plane and
/// relative to the length of the line, for which the interval counts as the slope of an antiresonance. Beside a
/// resonance the distance is 0.3 % at [`WIDTHS`]; for rounding it is as large as the line.
const STRAIGHT: f64 = 0.05;
/// Maximum relative distance of two frequencies that differ by rounding alone.
const SAME_FREQUENCY: f64 = 1e-14;

/// Computed frequency, with a value per response.
#[derive(Debug, Clone)]
struct CurveSample {
    hz: f64,
    values: Vec<Complex>,
    /// Logarithm of the magnitude, at least that of the floor.
    levels: Vec<f64>,
    /// True per response if it lies above the floor.
    above: Vec<bool>,
    /// Number of further halvings that have to succeed in the interval from this sample to the next one.
    open: u8,
    /// True if responses off their line in this interval are straight in the complex plane, as at an antiresonance.
    straight: bool,
    /// True if the sample belongs to the result whatever its neighbours are.
    kept: bool,
}

impl CurveSample {
    fn new(hz: f64, measured: &[Measured], open: u8, kept: bool) -> Self {
        let level = |m: &Measured| m.value.norm().max(m.floor).max(f64::MIN_POSITIVE).ln();
        Self {
            hz,
            values: measured.iter().map(|m| m.value).collect(),
            levels: measured.iter().map(level).collect(),
            above: measured.iter().map(|m| m.value.norm() > m.floor.max(f64::MIN_POSITIVE)).collect(),
            open,
            straight: false,
            kept,
        }
    }

    /// Change of phase of response `i` up to another sample, −π to π.
    fn turn(&self, to: &Self, i: usize) -> f64 {
        if self.above[i] && to.above[i] { (to.values[i] * self.values[i].conj()).arg() } else { 0.0 }
    }
}

/// Responses at a grid (ascending, at least two frequencies [Hz]) and at all further frequencies that a drawn curve
/// needs: interpolation of the logarithm of the magnitude is accurate to `resolution`, and every maximum is in the
/// result with its height. `modes` are the natural modes between the ends of the grid; `evaluate` computes all
/// responses at frequencies, one row per frequency.
///
/// Around an undamped natural frequency there is a gap of 5e-5 of the frequency on either side, because the response
/// has no bound there.
///
/// # Errors
/// The errors of `evaluate`.
pub fn resolve<E>(
    grid_hz: &[f64],
    modes: &[Mode],
    resolution: Resolution,
    mut evaluate: impl FnMut(&[f64]) -> Result<Vec<Vec<Measured>>, E>,
) -> Result<Resolved, E> {
    let (Some(&first), Some(&last)) = (grid_hz.first(), grid_hz.last()) else {
        return Ok(Resolved {
            frequencies_hz: Vec::new(),
            values: Vec::new(),
            undamped_hz: Vec::new(),
            unresolved: 0,
            gaps: Vec::new(),
        });
    };
    let resonances: Vec<Resonance> =
        modes.iter().map(Resonance::of).filter(|r| (first..=last).contains(&r.hz)).collect();
    let undamped_hz: Vec<f64> = resonances.iter().filter(|r| !r.damped).map(|r| r.hz).collect();
    let search = IntervalSearch::new(grid_hz, &resonances);

    // Grid and starts.
    let starts = search.starts(grid_hz, &resonances);
    let hz: Vec<f64> = starts.iter().map(|start| start.0).collect();
    let measured = evaluate(&hz)?;
    let mut samples: Vec<CurveSample> =
        starts.iter().zip(&measured).map(|((hz, kept), row)| CurveSample::new(*hz, row, HALVINGS, *kept)).collect();

    // Halve the intervals whose middle is not on the line between their ends.
    loop {
        let middles: Vec<(usize, f64)> = search.middles(&mut samples);
        if middles.is_empty() || samples.len() + middles.len() > resolution.max_points {
            break;
        }
        let hz: Vec<f64> = middles.iter().map(|middle| middle.1).collect();
        let measured = evaluate(&hz)?;
        samples = inserted(samples, &middles, &measured, resolution.tolerance);
    }
    let unresolved = samples.iter().filter(|sample| sample.open > 0).count();

    // Put a sample on every maximum, and leave out the samples that a line between other samples replaces.
    samples = with_maxima(samples, &search, &mut evaluate)?;
    let samples = thinned(samples, LEFT_OUT * resolution.tolerance);

    let gaps =
        (1..samples.len()).filter(|i| search.in_gap(0.5 * (samples[i - 1].hz + samples[*i].hz))).map(|i| (i - 1, i));
    let gaps = gaps.collect();
    let channels = samples.first().map_or(0, |sample| sample.values.len());
    Ok(Resolved {
        frequencies_hz: samples.iter().map(|sample| sample.hz).collect(),
        values: (0..channels).map(|i| samples.iter().map(|sample| sample.values[i]).collect()).collect(),
        undamped_hz,
        unresolved,
        gaps,
    })
}

/// Limits of the search for intervals that have to be halved.
struct IntervalSearch {
    /// Intervals around undamped natural frequencies [Hz], ascending, without common points.
    gaps: Vec<(f64, f64)>,
    /// Minimum width of an interval relative to its upper end, except at an antiresonance.
    min_width: f64,
    /// Minimum relative width at an antiresonance.
    narrowest: f64,
    /// Frequency [Hz] below which nothing is divided: a response may be zero at 0 Hz, where its logarithm has no bound.
    lowest: f64,
}

impl IntervalSearch {
    fn new(grid_hz: &[f64], resonances: &[Resonance]) -> Self {
        let mut gaps: Vec<(f64, f64)> = Vec::new();
        for resonance in resonances.iter().filter(|r| !r.damped) {
            let (low, high) = (resonance.hz - resonance.half_width, resonance.hz + resonance.half_width);
            match gaps.last_mut() {
                Some(before) if before.1 >= low => before.1 = before.1.max(high),
                _ => gaps.push((low, high)),
            }
        }

        let damping = resonances.iter().filter(|r| r.damped).map(|r| r.half_width / r.hz).fold(f64::INFINITY, f64::min);
        let positive = grid_hz.iter().copied().find(|hz| *hz > 0.0).unwrap_or(0.0);
        let lowest = if grid_hz[0] > 0.0 { 0.0 } else { 0.01 * positive };
        let min_width = (WIDTH_PER_DAMPING * damping).clamp(WIDTHS.0, WIDTHS.1);
        // Without damping the depth of an antiresonance has no bound, and a curve cannot show it.
        let is_undamped = !resonances.is_empty() && resonances.iter().all(|r| !r.damped);
        let narrowest = if is_undamped { min_width } else { NARROWEST };
        Self { gaps, min_width, narrowest, lowest }
    }

    /// True if a frequency lies inside a gap; its edges do not.
    fn in_gap(&self, hz: f64) -> bool {
        let next = self.gaps.partition_point(|gap| gap.1 <= hz);
        self.gaps.get(next).is_some_and(|gap| gap.0 < hz)
    }

    /// Grid, natural frequencies, points around them, and edges of gaps, ascending; true for those that are kept.
    fn starts(&self, grid_hz: &[f64], resonances: &[Resonance]) -> Vec<(f64, bool)> {
        let (first, last) = (grid_hz[0], grid_hz[grid_hz.len() - 1]);
        let mut all: Vec<(f64, bool)> = grid_hz.iter().map(|hz| (*hz, true)).collect();
        for (k, resonance) in resonances.iter().enumerate() {
            if resonance.damped {
                all.push((resonance.hz, false));
            }

            // Outwards in equal ratios to half of the distance to the next resonance.
            let below = k.checked_sub(1).map_or(first, |k| resonances[k].hz);
            let above = resonances.get(k + 1).map_or(last, |next| next.hz);
            for (sign, distance) in [(-1.0, resonance.hz - below), (1.0, above - resonance.hz)] {
                let mut out = resonance.half_width;
                for step in 0..MAX_STEPS_OUT {
                    if step > 0 && out > 0.5 * distance {
                        break;
                    }
                    all.push((resonance.hz + sign * out, false));
                    out *= STEP_OUT;
                }
            }
        }
        all.extend(self.gaps.iter().flat_map(|(low, high)| [(*low, true), (*high, true)]));

        // Sort, without frequencies in gaps and without equal ones.
        all.retain(|(hz, _)| (first..=last).contains(hz) && !self.in_gap(*hz));
        // Among equal frequencies the one that is kept comes first.
        order::sort_descending(&mut all, |(_, kept)| f64::from(*kept));
        order::sort_ascending(&mut all, |(hz, _)| *hz);
        // Two frequencies may differ by rounding alone: the one that is kept stays.
        all.dedup_by(|b, a| {
            let same = b.0 - a.0 <= SAME_FREQUENCY * a.0;
            if same && b.1 && !a.1 {
                *a = *b;
            }
            same
        });
        all
    }

    /// Middle of every open interval that can be divided, with the index of its lower end. Intervals that cannot be
    /// divided are closed.
    fn middles(&self, samples: &mut [CurveSample]) -> Vec<(usize, f64)> {
        let mut middles = Vec::new();
        for i in 0..samples.len() {
            if samples[i].open == 0 {
                continue;
            }
            let Some(next) = samples.get(i + 1) else {
                samples[i].open = 0;
                continue;
            };
            let (low, high) = (samples[i].hz, next.hz);
            let middle = low + 0.5 * (high - low);
            let min_width = if samples[i].straight { self.narrowest } else { self.min_width };
            let divisible = high - low > min_width * high && high > self.lowest && low < middle && middle < high;
            if divisible && !self.in_gap(middle) {
                middles.push((i, middle));
            } else {
                samples[i].open = 0;
            }
        }
        middles
    }
}

/// Samples with further ones at the middles of intervals. Both halves of an interval start again if its middle is not
/// on the line between its ends.
fn inserted(
    samples: Vec<CurveSample>,
    middles: &[(usize, f64)],
    measured: &[Vec<Measured>],
    tolerance: f64,
) -> Vec<CurveSample> {
    let mut new =
        middles.iter().zip(measured).map(|((i, hz), row)| (*i, CurveSample::new(*hz, row, 0, false))).peekable();
    let mut all: Vec<CurveSample> = Vec::with_capacity(samples.len() + middles.len());
    let mut old = samples.into_iter().enumerate().peekable();
    while let Some((i, mut low)) = old.next() {
        let Some((_, mut middle)) = new.next_if(|(at, _)| *at == i) else {
            all.push(low);
            continue;
        };

        let shape = old.peek().map_or(IntervalShape::OnLine, |(_, high)| shape(&low, &middle, high, tolerance));
        let open = if shape == IntervalShape::OnLine { low.open - 1 } else { HALVINGS };
        let straight = shape == IntervalShape::Straight || (shape == IntervalShape::OnLine && low.straight);
        (low.open, middle.open) = (open, open);
        (low.straight, middle.straight) = (straight, straight);
        all.push(low);
        all.push(middle);
    }
    all
}

/// Shape of the responses in an interval.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum IntervalShape {
    /// The middle of every response is on the line between the ends.
    OnLine,
    /// Responses off their line are straight in the complex plane.
    Straight,
    /// Any other shape.
    Bent,
}

/// Shape of the responses between two samples, by the sample in the middle.
fn shape(low: &CurveSample, middle: &CurveSample, high: &CurveSample, tolerance: f64) -> IntervalShape {
    let fraction = (middle.hz - low.hz) / (high.hz - low.hz);
    let is_on_line = |i: &usize| {
        let i = *i;
        let line = low.levels[i] + fraction * (high.levels[i] - low.levels[i]);
        let all_above = low.above[i] && middle.above[i] && high.above[i];
        let phase = if all_above { low.turn(middle, i) - fraction * low.turn(high, i) } else { 0.0 };
        // Turns are known up to full turns.
        let phase = phase - TAU * (phase / TAU).round();
        (middle.levels[i] - line).abs() <= HALVED * tolerance && phase.abs() <= PHASE
    };
    let is_straight = |i: usize| {
        let across = high.values[i] - low.values[i];
        (middle.values[i] - low.values[i] - across * fraction).norm() <= STRAIGHT * across.norm()
    };

    let mut off_line = (0..middle.levels.len()).filter(|i| !is_on_line(i)).peekable();
    if off_line.peek().is_none() {
        IntervalShape::OnLine
    } else if off_line.all(is_straight) {
        IntervalShape::Straight
    } else {
        IntervalShape::Bent
    }
}

/// Samples with one on every maximum of every response. Thinning keeps the samples on maxima.
fn with_maxima<E>(
    mut samples: Vec<CurveSample>,
    search: &IntervalSearch,
    evaluate: &mut impl FnMut(&[f64]) -> Result<Vec<Vec<Measured>>, E>,
) -> Result<Vec<CurveSample>, E> {
    let mut maxima = Vec::new();
    let mut tops = Vec::new();
    for at in 1..samples.len().saturating_sub(1) {
        let three = [&samples[at - 1], &samples[at], &samples[at + 1]];
        let hz = three.map(|sample| sample.hz);
        if search.in_gap(0.5 * (hz[0] + hz[1])) || search.in_gap(0.5 * (hz[1] + hz[2])) {
            continue;
        }
        for channel in 0..three[1].levels.len() {
            let levels = three.map(|sample| sample.levels[channel]);
            let above = three.iter().all(|sample| sample.above[channel]);
            if above && levels[1] >= levels[0] && levels[1] > levels[2] {
                let magnitude = three.map(|sample| sample.values[channel].norm());
                maxima.push(BracketedMaximum::between(channel, hz, magnitude));
                tops.push(at);
            }
        }
    }

    let rows = approach(&mut maxima, |_, maximum| maximum.is_known(), evaluate)?;
    for ((maximum, at), row) in maxima.iter().zip(tops).zip(rows) {
        match row {
            None => samples[at].kept = true,
            Some(row) => samples.push(CurveSample::new(maximum.hz(), &row, 0, true)),
        }
    }
    // Among equal frequencies the one that is kept comes first.
    order::sort_descending(&mut samples, |sample| f64::from(sample.kept));
    order::sort_ascending(&mut samples, |sample| sample.hz);
    samples.dedup_by(|b, a| b.hz - a.hz <= 0.0);
    Ok(samples)
}

/// Samples without those that a line replaces. From each remaining sample the line reaches to the last sample up to
/// which all samples are within the tolerance of the line.
fn thinned(samples: Vec<CurveSample>, tolerance: f64) -> Vec<CurveSample> {
    let count = samples.len();
    let channels = samples.first().map_or(0, |sample| sample.levels.len());
    let mut keep = vec![false; count];
    let mut from = 0;
    while from < count {
        keep[from] = true;

        // Range of slopes of the line, per response for level and phase, that all samples so far allow.
        let mut slopes = vec![[(f64::NEG_INFINITY, f64::INFINITY); 2]; channels];
        let mut turned = vec![0.0; channels];
        let mut to = from + 1;
        for next in from + 1..count {
            let distance = samples[next].hz - samples[from].hz;
            let mut on_line = true;
            for i in 0..channels {
                turned[i] += samples[next - 1].turn(&samples[next], i);
                let rise = [samples[next].levels[i] - samples[from].levels[i], turned[i]];
                for ((slope, rise), room) in slopes[i].iter_mut().zip(rise).zip([tolerance, PHASE]) {
                    on_line &= (slope.0..=slope.1).contains(&(rise / distance));
                    *slope = (slope.0.max((rise - room) / distance), slope.1.min((rise + room) / distance));
                }
            }
            if !on_line {
                break;
            }
            to = next;
            if samples[next].kept {
                break;
            }
        }
        from = to;
    }
    samples.into_iter().zip(keep).filter(|(_, keep)| *keep).map(|(sample, _)| sample).collect()
}

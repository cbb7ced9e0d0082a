//! Frequencies at which a response is drawn with the true height of every peak, and the peaks that a given grid misses.
//!
//! Between two frequencies a drawn curve is a straight line over the logarithm of the magnitude. The search starts from
//! a grid, from the natural frequencies and from points around these at multiples of their half widths. Then it halves
//! every interval whose middle is not on its line. The natural frequencies are known, so that no resonance is narrower
//! than the intervals in which the halving begins. An antiresonance has no known place or width. It bends the curve far
//! beside it, so that the halving finds it, and it is resolved until rounding hides the response.

use super::{Peak, peaks};
use crate::math::Complex;
use crate::modes::Mode;
use std::f64::consts::TAU;
use std::iter::once;

/// Value of one response at one frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// Response.
    pub value: Complex,
    /// Magnitude below which rounding hides the response. It is not resolved there.
    pub floor: f64,
}

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

/// Damping ratio up to which a mode counts as undamped. Rounding of its frequency would change a higher peak.
const UNDAMPED: f64 = 1e-9;
/// Relative half width of the gap at an undamped natural frequency. The curve is 80 dB above its level there.
const GAP: f64 = 5e-5;
/// Ratio between the distances of neighbouring starts from a natural frequency: √10.
const STEP_OUT: f64 = 3.162_277_660_168_379_5;
/// Maximum number of starts on one side of a natural frequency; they reach 1e6 half widths.
const MAX_STEPS_OUT: usize = 13;
/// Fraction of the tolerance that the middle of an interval may miss its line by.
const HALVED: f64 = 0.4;
/// Number of successive halvings whose middles have to be on their lines. One is not enough where a curve crosses its
/// line at the middle: with 1 and a fraction of 0.2 the error still reaches 1.003 of the tolerance.
const HALVINGS: u8 = 2;
/// Maximum difference of phase between curve and line [rad] at the middle of an interval.
const PHASE: f64 = 0.1;
/// Fraction of the tolerance for leaving out points that the line through their neighbours replaces. With 0.8 the error
/// between the points reaches 1.1 of the tolerance at deep antiresonances.
const LEFT_OUT: f64 = 0.6;
/// Range of the relative width below which no resonance bends the curve any more; a fiftieth of the smallest damping
/// ratio lies in it. Only an antiresonance may be narrower.
const WIDTHS: (f64, f64) = (1e-10, 1e-5);
/// Minimum relative width of an interval at an antiresonance: some hundred times the rounding of a frequency. The response
/// is then below 1e-9 of its terms, unless the slope is steeper than that of a resonance with a damping ratio of 1e-4.
const NARROWEST: f64 = 1e-13;
/// Maximum distance of the middle from the straight line between the ends of an interval, in the complex plane, relative
/// to the length of the line, for the slope of an antiresonance. Beside a resonance the distance is 0.3 % at the widths
/// in question; rounding has the size of the line.
const STRAIGHT: f64 = 0.05;
/// Maximum number of parabolas through which a maximum is approached. Three reach 1e-6 of the height of a resonance; the
/// top of a flat ripple between two resonances is not a parabola, and six leave 1e-7 there.
const MAX_PARABOLAS: usize = 12;

/// Resonance of the response: a natural frequency with its half width.
#[derive(Debug, Clone, Copy)]
struct Resonance {
    hz: f64,
    /// Half width [Hz]; that of a gap for an undamped mode.
    half_width: f64,
    damped: bool,
}

impl Resonance {
    fn of(mode: &Mode) -> Self {
        let damped = mode.damping_ratio > UNDAMPED;
        let ratio = if damped { mode.damping_ratio } else { GAP };
        Self { hz: mode.frequency_hz, half_width: ratio * mode.frequency_hz, damped }
    }
}

/// Computed frequency, with a value per response.
#[derive(Debug, Clone)]
struct Sample {
    hz: f64,
    values: Vec<Complex>,
    /// Logarithm of the magnitude, at least that of the floor.
    levels: Vec<f64>,
    /// True per response if it lies above the floor.
    above: Vec<bool>,
    /// Number of successive halvings of the interval from this sample to the next that still have to succeed.
    open: u8,
    /// True if responses off their line in this interval are straight in the complex plane, as at an antiresonance.
    straight: bool,
    /// True if the sample belongs to the result whatever its neighbours are.
    kept: bool,
}

impl Sample {
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
    let search = Search::new(grid_hz, &resonances);

    // Grid and starts.
    let starts = search.starts(grid_hz, &resonances);
    let hz: Vec<f64> = starts.iter().map(|start| start.0).collect();
    let measured = evaluate(&hz)?;
    let mut samples: Vec<Sample> =
        starts.iter().zip(&measured).map(|((hz, kept), row)| Sample::new(*hz, row, HALVINGS, *kept)).collect();

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

    // Put a sample on every maximum, and leave out what the line between its neighbours shows as well.
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

/// Limits of the search.
struct Search {
    /// Intervals around undamped natural frequencies [Hz], ascending, without common points.
    gaps: Vec<(f64, f64)>,
    /// Minimum width of an interval relative to its upper end, except at an antiresonance.
    min_width: f64,
    /// Minimum relative width at an antiresonance.
    narrowest: f64,
    /// Frequency [Hz] below which nothing is divided: a response may be zero at 0 Hz, where its logarithm has no bound.
    lowest: f64,
}

impl Search {
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
        let min_width = (0.02 * damping).clamp(WIDTHS.0, WIDTHS.1);
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

        all.retain(|(hz, _)| (first..=last).contains(hz) && !self.in_gap(*hz));
        all.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
        // Two frequencies may differ by rounding alone: the one that is kept stays.
        all.dedup_by(|b, a| {
            let same = b.0 - a.0 <= 1e-14 * a.0;
            if same && b.1 && !a.1 {
                *a = *b;
            }
            same
        });
        all
    }

    /// Middle of every open interval that can be divided, with the index of its lower end. Intervals that cannot be
    /// divided are closed.
    fn middles(&self, samples: &mut [Sample]) -> Vec<(usize, f64)> {
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

/// Samples with those at the middles of intervals. Both halves of an interval start again if its middle was not on the
/// line between its ends.
fn inserted(samples: Vec<Sample>, middles: &[(usize, f64)], measured: &[Vec<Measured>], tolerance: f64) -> Vec<Sample> {
    let mut new = middles.iter().zip(measured).map(|((i, hz), row)| (*i, Sample::new(*hz, row, 0, false))).peekable();
    let mut all: Vec<Sample> = Vec::with_capacity(samples.len() + middles.len());
    let mut old = samples.into_iter().enumerate().peekable();
    while let Some((i, mut low)) = old.next() {
        let Some((_, mut middle)) = new.next_if(|(at, _)| *at == i) else {
            all.push(low);
            continue;
        };
        let shape = old.peek().map_or(Shape::OnLine, |(_, high)| shape(&low, &middle, high, tolerance));
        let open = if shape == Shape::OnLine { low.open - 1 } else { HALVINGS };
        let straight = shape == Shape::Straight || (shape == Shape::OnLine && low.straight);
        (low.open, middle.open) = (open, open);
        (low.straight, middle.straight) = (straight, straight);
        all.push(low);
        all.push(middle);
    }
    all
}

/// Shape of the responses in an interval.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Shape {
    /// The middle of every response is on the line between the ends.
    OnLine,
    /// Responses off their line are straight in the complex plane.
    Straight,
    /// Any other shape.
    Bent,
}

/// Shape of the responses between two samples, by the sample in the middle.
fn shape(low: &Sample, middle: &Sample, high: &Sample, tolerance: f64) -> Shape {
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
        Shape::OnLine
    } else if off_line.all(is_straight) {
        Shape::Straight
    } else {
        Shape::Bent
    }
}

/// Maximum of one response that is being approached: three neighbouring frequencies and the magnitudes there. The
/// middle one is the highest.
#[derive(Debug, Clone, Copy)]
struct Maximum {
    channel: usize,
    hz: [f64; 3],
    magnitude: [f64; 3],
}

impl Maximum {
    /// Vertex of the parabola through 1/|H|², which is one at a single resonance.
    fn vertex(&self) -> Option<f64> {
        let [x0, x1, x2] = self.hz;
        let [y0, y1, y2] = self.magnitude.map(|m| (self.magnitude[1] / m).powi(2));
        let (left, right) = (x1 - x0, x2 - x1);
        let (fall, rise) = ((y1 - y0) / left, (y2 - y1) / right);
        let curvature = (rise - fall) / (left + right);
        let vertex = x1 - (fall * right + rise * left) / (left + right) / (2.0 * curvature);
        // A step below rounding changes nothing.
        let moves = (vertex - x1).abs() > 1e-6 * (x2 - x0) && (vertex - x1).abs() > 1e-13 * x1;
        (vertex > x0 && vertex < x2 && moves).then_some(vertex)
    }

    /// Narrows the interval by the magnitude at a frequency inside it.
    fn narrow(&mut self, hz: f64, magnitude: f64) {
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

/// Approaches maxima by parabolas, all of them side by side; returns the row of all responses at each maximum that has
/// moved.
fn approach<E>(
    maxima: &mut [Maximum],
    evaluate: &mut impl FnMut(&[f64]) -> Result<Vec<Vec<Measured>>, E>,
) -> Result<Vec<Option<Vec<Measured>>>, E> {
    let mut rows: Vec<Option<Vec<Measured>>> = vec![None; maxima.len()];
    let mut moving: Vec<usize> = (0..maxima.len()).collect();
    for _ in 0..MAX_PARABOLAS {
        let vertices: Vec<(usize, f64)> =
            moving.iter().filter_map(|k| maxima[*k].vertex().map(|hz| (*k, hz))).collect();
        if vertices.is_empty() {
            break;
        }

        let hz: Vec<f64> = vertices.iter().map(|vertex| vertex.1).collect();
        for ((k, hz), row) in vertices.iter().zip(evaluate(&hz)?) {
            let magnitude = row[maxima[*k].channel].value.norm();
            if magnitude > maxima[*k].magnitude[1] {
                rows[*k] = Some(row);
            }
            maxima[*k].narrow(*hz, magnitude);
        }
        moving = vertices.into_iter().map(|vertex| vertex.0).collect();
    }
    Ok(rows)
}

/// Samples with one on every maximum of every response; those at maxima are kept.
fn with_maxima<E>(
    mut samples: Vec<Sample>,
    search: &Search,
    evaluate: &mut impl FnMut(&[f64]) -> Result<Vec<Vec<Measured>>, E>,
) -> Result<Vec<Sample>, E> {
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
                maxima.push(Maximum { channel, hz, magnitude: three.map(|sample| sample.values[channel].norm()) });
                tops.push(at);
            }
        }
    }

    let rows = approach(&mut maxima, evaluate)?;
    for ((maximum, at), row) in maxima.iter().zip(tops).zip(rows) {
        match row {
            None => samples[at].kept = true,
            Some(row) => samples.push(Sample::new(maximum.hz[1], &row, 0, true)),
        }
    }
    samples.sort_by(|a, b| a.hz.total_cmp(&b.hz).then(b.kept.cmp(&a.kept)));
    samples.dedup_by(|b, a| b.hz - a.hz <= 0.0);
    Ok(samples)
}

/// Samples without those that the line between their neighbours shows as well: from each kept sample the line goes as
/// far as all samples on its way are within the tolerance.
fn thinned(samples: Vec<Sample>, tolerance: f64) -> Vec<Sample> {
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

/// Peak that a grid reads too low.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MissedPeak {
    /// Index of the response.
    pub response: usize,
    /// Frequency of the grid with the higher magnitude beside the peak [Hz].
    pub read_hz: f64,
    /// Magnitude there.
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

/// Relative height of a peak above what a grid reads beside it, above which the peak is missed.
pub const MISSED: f64 = 0.05;
/// Places in half widths around a natural frequency at which the response is compared with its grid. A resonance in
/// front of a background has its maximum at one of them or between, within a few per cent of the height.
const PLACES: [f64; 5] = [-2.5, -1.0, 0.0, 1.0, 2.5];
/// Distance between the three places from which a peak is predicted again, in predicted half widths.
const AGAIN: f64 = 0.5;
/// Maximum distance of a predicted peak, in steps of the places that predict it. Farther away the prediction is a guess.
const MAX_PREDICTED: f64 = 30.0;
/// Relative height of a predicted peak above the computed values, above which the response is computed there too.
const PREDICTED: f64 = 0.01;
/// Maximum number of predictions of a peak, each from the places of the one before.
const MAX_PREDICTIONS: usize = 4;

/// Response near one pole: `b + r/(x − p)` with the background b, the residue r and the pole p.
#[derive(Debug, Clone, Copy)]
struct OnePole {
    background: Complex,
    residue: Complex,
    pole: Complex,
}

impl OnePole {
    /// Response with the given values at x = −1, 0 and 1; `None` if they are on a straight line.
    fn through([left, middle, right]: [Complex; 3]) -> Option<Self> {
        let pole = (right - left) / (left + right - middle * 2.0);
        let background = right + pole * (middle - right);
        let residue = pole * (background - middle);
        let finite = |z: Complex| z.re.is_finite() && z.im.is_finite();
        (finite(pole) && finite(background) && finite(residue) && pole.im.abs() > 0.0 && residue.norm() > 0.0)
            .then_some(Self { background, residue, pole })
    }

    /// Place x and height of the maximum over real x.
    fn top(&self) -> (f64, f64) {
        // 1/(x − p) moves on a circle through zero, and so does the response.
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
    row: Vec<Measured>,
}

/// Values of one response at three places, from which its peak is predicted.
#[derive(Debug, Clone, Copy)]
struct Prediction {
    response: usize,
    /// Frequency in the middle [Hz], and the distance to the others.
    hz: f64,
    step: f64,
    values: [Complex; 3],
}

impl Prediction {
    /// Frequency [Hz] and height of the predicted peak, with the next step; `None` if it is too far away.
    fn peak(&self) -> Option<(f64, f64, f64)> {
        let model = OnePole::through(self.values)?;
        let (x, height) = model.top();
        let step = AGAIN * self.step * model.pole.im.abs();
        (x.abs() <= MAX_PREDICTED && height.is_finite() && step > 0.0).then_some((
            self.hz + x * self.step,
            height,
            step,
        ))
    }
}

/// Responses between the frequencies of a grid, ascending: around every natural frequency, and at each peak beside it that
/// is predicted higher than those values.
fn around_resonances<E>(
    grid_hz: &[f64],
    values: &[Vec<Complex>],
    modes: &[Mode],
    evaluate: &mut impl FnMut(&[f64]) -> Result<Vec<Vec<Measured>>, E>,
) -> Result<Vec<Between>, E> {
    let (first, last) = (grid_hz[0], grid_hz[grid_hz.len() - 1]);
    let is_inside = |hz: f64| first < hz && hz < last;
    let between = |hz: f64, row: Vec<Measured>| Between { hz, above: grid_hz.partition_point(|at| *at < hz), row };

    // Values around every natural frequency.
    let resonances: Vec<Resonance> = modes.iter().map(Resonance::of).filter(|resonance| resonance.damped).collect();
    let places = |r: &Resonance| PLACES.map(|k| r.hz + k * r.half_width);
    let hz: Vec<f64> = resonances.iter().flat_map(places).filter(|hz| is_inside(*hz)).collect();
    if hz.is_empty() {
        return Ok(Vec::new());
    }
    let mut rows = evaluate(&hz)?.into_iter();
    let mut all: Vec<Between> = Vec::with_capacity(hz.len());
    let mut predictions: Vec<Prediction> = Vec::new();
    for resonance in &resonances {
        let begin = all.len();
        all.extend(
            places(resonance).into_iter().filter(|hz| is_inside(*hz)).zip(&mut rows).map(|(hz, row)| between(hz, row)),
        );
        if let [_, left, middle, right, _] = &all[begin..] {
            let of = |response: usize| [left, middle, right].map(|place| place.row[response].value);
            let prediction =
                |response| Prediction { response, hz: resonance.hz, step: resonance.half_width, values: of(response) };
            predictions.extend((0..values.len()).map(prediction));
        }
    }

    // Values at predicted peaks that are higher than the values so far.
    for _ in 0..MAX_PREDICTIONS {
        all.sort_by(|a, b| a.hz.total_cmp(&b.hz));
        let is_new = |response: usize, hz: f64, height: f64| {
            let above = grid_hz.partition_point(|at| *at < hz);
            let read = values[response][above - 1].norm().max(values[response][above].norm());
            let inside = &all[all.partition_point(|place| place.above < above)..];
            let inside = inside.iter().take_while(|place| place.above == above);
            let highest = inside.map(|place| place.row[response].value.norm()).fold(0.0, f64::max);
            height > (1.0 + MISSED) * read && height > (1.0 + PREDICTED) * highest
        };
        let new: Vec<(usize, [f64; 3], f64)> = predictions
            .iter()
            .filter_map(|prediction| {
                let (hz, height, step) = prediction.peak()?;
                let three = [hz - step, hz, hz + step];
                let is_inside = three.iter().all(|hz| is_inside(*hz));
                (is_inside && is_new(prediction.response, hz, height)).then_some((prediction.response, three, step))
            })
            .collect();
        if new.is_empty() {
            break;
        }

        let hz: Vec<f64> = new.iter().flat_map(|(_, three, _)| *three).collect();
        let rows = evaluate(&hz)?;
        predictions.clear();
        for ((response, three, step), rows) in new.into_iter().zip(rows.chunks_exact(3)) {
            let values = [0, 1, 2].map(|k: usize| rows[k][response].value);
            predictions.push(Prediction { response, hz: three[1], step, values });
            all.extend(three.into_iter().zip(rows).map(|(hz, row)| between(hz, row.clone())));
        }
    }
    all.sort_by(|a, b| a.hz.total_cmp(&b.hz));
    all.dedup_by(|b, a| b.hz - a.hz <= 0.0);
    all.retain(|place| grid_hz[place.above] > place.hz);
    Ok(all)
}

/// Peaks between the frequencies of a grid (ascending) that are more than 5 % ([`MISSED`]) higher than the values of the
/// grid on both sides; `None` if there are none. `values` has a row per response; `modes` are the natural modes between
/// the ends of the grid; `evaluate` computes all responses at frequencies, one row per frequency.
///
/// A value between two frequencies that is higher than those at both proves a maximum there. The responses are computed
/// around every natural frequency. Three values give the pole there and so the place of the peak, which damping and the
/// other modes move away from the natural frequency. So nearly every resonance is counted that is at least 6 % higher than
/// the grid shows; one of several overlapping modes may be left out. A rise between two antiresonances, without a natural
/// frequency, may be missed. Undamped modes are not compared, because their peaks have no finite height.
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
    let between = around_resonances(grid_hz, values, modes, &mut evaluate)?;

    // Maxima among the places of each interval of the grid.
    let mut count = 0;
    let mut worst: Option<(f64, MissedPeak, Maximum)> = None;
    for group in between.chunk_by(|a, b| a.above == b.above) {
        let above = group[0].above;
        for (response, values) in values.iter().enumerate() {
            let ends = [above - 1, above].map(|i| (grid_hz[i], values[i].norm()));
            let (read_hz, read) = if ends[0].1 >= ends[1].1 { ends[0] } else { ends[1] };
            let inside = group.iter().map(|place| (place.hz, place.row[response].value.norm()));
            let curve: Vec<(f64, f64)> = once(ends[0]).chain(inside).chain(once(ends[1])).collect();
            let floor = group.iter().map(|place| place.row[response].floor).fold(0.0, f64::max);

            for three in curve.windows(3) {
                let [left, top, right] = [three[0], three[1], three[2]];
                let missed = top.1 > left.1 && top.1 >= right.1 && top.1 > (1.0 + MISSED) * read && top.1 > floor;
                if !missed {
                    continue;
                }
                count += 1;
                let fraction = read / top.1;
                if worst.as_ref().is_none_or(|(least, ..)| fraction < *least) {
                    let peak = MissedPeak { response, read_hz, read, frequency_hz: top.0, height: top.1 };
                    let maximum = Maximum {
                        channel: response,
                        hz: [left.0, top.0, right.0],
                        magnitude: [left.1, top.1, right.1],
                    };
                    worst = Some((fraction, peak, maximum));
                }
            }
        }
    }

    let Some((_, mut worst, maximum)) = worst else { return Ok(None) };
    let mut maxima = [maximum];
    approach(&mut maxima, &mut evaluate)?;
    (worst.frequency_hz, worst.height) = (maxima[0].hz[1], maxima[0].magnitude[1]);
    Ok(Some(MissedPeaks { count, worst }))
}

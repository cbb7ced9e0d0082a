//! Tests for faults with a stated rate of false alarms, and the hypotheses about an alarm.

use super::consistency::{chi2_quantile, normal_quantile};
use super::kalman::{Kalman, StepNoise, TensionFactor};
use super::readings::{SensorGroup, SensorReadings};
use super::rows::MAX_ROWS;
use super::state::StatePlaces;
use crate::control_loop::MAX_CABLES;

/// Half of the shift for which the cumulative sum is quickest [deviations].
const ALLOWANCE: f64 = 0.5;

/// Correlation of successive innovations above which the tests do not hold their rate.
pub const MAX_CORRELATION: f64 = 0.3;

/// Number of quiet readings after which the deviation of z is known within 10 %.
const MIN_QUIET: usize = 50;

/// Number of equal readings after which a sensor may be stuck, and the change that it should have shown [deviations].
const STUCK_READINGS: usize = 20;
const STUCK_CHANGE: f64 = 5.0;

/// Probability with which an alarm that one cable alone has caused is not laid to it.
const NOT_ITS_OWN: f64 = 1e-3;

/// Number of samples whose mean innovations tell whether one cable alone has raised an alarm.
const KEPT_SAMPLES: usize = 32;

/// Difference of −2 ln L below which the second hypothesis is as good as the first.
pub const UNDECIDED: f64 = 10.0;

/// Deviation of a slip within one step [m].
const SLIP: f64 = 5e-3;

/// Number of cables whose faults are compared after an alarm.
const SUSPECTS: usize = 3;

/// Kind of fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FaultKind {
    /// Length of a cable that its encoder did not see: a slipped drum, or a slipped encoder.
    Slip,
    /// Step of the bias of a load cell.
    LoadCell,
    /// Payload taken up or put down.
    Payload,
    /// External force that is larger than its prior.
    Wrench,
    /// Cable without tension that should be taut: cut, or slipped far.
    Cut,
    /// Sensor that repeats one reading.
    Stuck,
}

/// Alarm of a test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FaultAlarm {
    /// Time since the start [s].
    pub time: f64,
    /// Cable whose innovation raised it; `None` for the test of the payload, and where no cable alone explains it.
    pub cable: Option<usize>,
    /// Kind that the test itself tells, [`FaultKind::Payload`] or [`FaultKind::Stuck`]; `None` before the hypotheses
    /// are compared.
    pub kind: Option<FaultKind>,
    /// Size of the test over its limit.
    pub size: f64,
}

/// One explanation of an alarm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FaultHypothesis {
    /// Kind of fault.
    pub kind: FaultKind,
    /// Cable with the fault; `None` for payload and wrench.
    pub cable: Option<usize>,
    /// Size: slip [m], step of a load cell [N], payload [kg], vertical force [N].
    pub size: f64,
    /// Deviation of the size.
    pub std: f64,
    /// Minus twice the logarithm of the likelihood, from the best.
    pub worse_by: f64,
}

/// Explanations of an alarm, best first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FaultVerdict {
    /// Explanations, of which the first `count` count.
    pub hypotheses: [Option<FaultHypothesis>; 2 * SUSPECTS + 2],
    /// True if the first is better than the second by more than 10.
    pub is_decided: bool,
}

/// Alarm of the tests of the load cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct CableAlarm {
    /// Cable with the largest test, and its size over the limit.
    pub(super) cable: usize,
    pub(super) size: f64,
    /// True if this cable alone explains the innovations of all.
    pub(super) is_own: bool,
}

/// Sums and limits of the tests.
#[derive(Debug, Clone)]
pub(super) struct FaultTests {
    /// Rate of false alarms [1/h].
    pub(super) rate: f64,
    sums: [[f64; 2]; MAX_CABLES],
    far: [[bool; 2]; MAX_CABLES],
    /// Quiet readings: sum of squares, products with the one before, number.
    squares: f64,
    products: f64,
    /// Innovations over their deviations of the last samples, newest first.
    kept: [[f64; MAX_CABLES]; KEPT_SAMPLES],
    /// Samples since each sum was zero.
    since: [[usize; 2]; MAX_CABLES],
    quiet: usize,
    before: [f64; MAX_CABLES],
    /// Last reading of each load cell, how often it was equal, and the expected tension at the first of these.
    last: [f64; MAX_CABLES],
    equal: [usize; MAX_CABLES],
    expected: [f64; MAX_CABLES],
}

impl FaultTests {
    pub(super) fn new(rate: f64) -> Self {
        Self {
            rate,
            sums: [[0.0; 2]; MAX_CABLES],
            far: [[false; 2]; MAX_CABLES],
            squares: 0.0,
            products: 0.0,
            kept: [[f64::NAN; MAX_CABLES]; KEPT_SAMPLES],
            since: [[0; 2]; MAX_CABLES],
            quiet: 0,
            before: [f64::NAN; MAX_CABLES],
            last: [f64::NAN; MAX_CABLES],
            equal: [0; MAX_CABLES],
            expected: [0.0; MAX_CABLES],
        }
    }

    /// Deviation of z at quiet times, at least one.
    pub(super) fn deviation(&self) -> f64 {
        if self.quiet < MIN_QUIET { 1.0 } else { (self.squares / self.quiet as f64).sqrt().max(1.0) }
    }

    /// Correlation of z with its value before.
    pub(super) fn correlation(&self) -> f64 {
        if self.quiet < MIN_QUIET || self.squares == 0.0 { 0.0 } else { self.products / self.squares }
    }

    /// True if the tests hold their rate of false alarms.
    pub(super) fn hold(&self) -> bool {
        self.correlation() <= MAX_CORRELATION
    }

    /// Starts the sums anew.
    pub(super) fn reset(&mut self) {
        self.sums = [[0.0; 2]; MAX_CABLES];
        self.far = [[false; 2]; MAX_CABLES];
        self.since = [[0; 2]; MAX_CABLES];
        self.before = [f64::NAN; MAX_CABLES];
    }

    /// Tests the innovations of the load cells; half of the rate belongs to each of the two tests.
    ///
    /// # References
    /// docs/theory.md, equation (97z).
    pub(super) fn innovations(&mut self, relative: &[f64], factor: &TensionFactor, step: f64) -> Option<CableAlarm> {
        let cables = relative.len();
        let samples = 3600.0 / (step * (0.5 * self.rate).max(1e-9));
        let limit = cusum_limit(samples, cables);
        let far_limit = single_limit(samples, cables);
        let (deviation, holds) = (self.deviation(), self.hold());
        self.kept.rotate_right(1);
        self.kept[0] = [f64::NAN; MAX_CABLES];
        let mut found: Option<(usize, f64, usize)> = None;
        for (i, z) in relative.iter().copied().enumerate() {
            if !z.is_finite() {
                continue;
            }
            if z.abs() < 4.0 {
                self.squares += z * z;
                self.products += if self.before[i].is_finite() { z * self.before[i] } else { 0.0 };
                self.quiet += 1;
            }
            self.before[i] = z;
            let z = z / deviation;
            self.kept[0][i] = z;
            for (side, z) in [z, -z].into_iter().enumerate() {
                let sum = (self.sums[i][side] + z - ALLOWANCE).max(0.0);
                self.sums[i][side] = sum;
                self.since[i][side] = if sum > 0.0 { self.since[i][side] + 1 } else { 0 };
            }
            let is_far = z.abs() > far_limit;
            let two_of_three = is_far && self.far[i].contains(&true);
            self.far[i] = [is_far, self.far[i][0]];
            let side = usize::from(self.sums[i][1] > self.sums[i][0]);
            let size = self.sums[i][side] / limit;
            let size = if two_of_three { size.max(z.abs() / far_limit) } else { size };
            if holds && size >= 1.0 && found.is_none_or(|(_, other, _)| size > other) {
                found = Some((i, size, self.since[i][side].clamp(1, KEPT_SAMPLES)));
            }
        }
        let (cable, size, count) = found?;
        let is_own = self.is_own(cable, count, factor);
        self.reset();
        Some(CableAlarm { cable, size, is_own })
    }

    /// True if the mean innovations of the last samples are those of one cable: what remains without it is noise, χ²
    /// with one degree of freedom less.
    ///
    /// # References
    /// docs/theory.md, equation (97za).
    fn is_own(&self, cable: usize, count: usize, factor: &TensionFactor) -> bool {
        let rows = factor.rows();
        let Some(own) = rows.iter().position(|i| *i == cable) else { return true };
        let mut mean = [0.0; MAX_CABLES];
        for (k, i) in rows.iter().enumerate() {
            let values = self.kept[..count].iter().map(|sample| sample[*i]).filter(|z| z.is_finite());
            let (sum, number) = values.fold((0.0, 0_u32), |(sum, number), z| (sum + z, number + 1));
            mean[k] = factor.deviation(k) * sum / f64::from(number.max(1));
        }
        let mut unit = [0.0; MAX_CABLES];
        unit[own] = 1.0;
        let (mean, unit) = (factor.whitened(&mean), factor.whitened(&unit));
        let dot = |a: &[f64; MAX_CABLES], b: &[f64; MAX_CABLES]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let rest = count as f64 * (dot(&mean, &mean) - dot(&mean, &unit).powi(2) / dot(&unit, &unit));
        rows.len() < 2 || rest <= chi2_quantile(1.0 - NOT_ITS_OWN, (rows.len() - 1) as f64)
    }

    /// Load cell that repeats its reading while the tension has changed.
    pub(super) fn stuck(&mut self, readings: &SensorReadings, kalman: &Kalman) -> Option<usize> {
        let std = kalman.settings.noise.tension;
        let mut found = None;
        for i in 0..kalman.places.cables {
            let (read, expected) = (readings.tensions[i], kalman.at.cables[i].tension);
            if !read.is_finite() {
                continue;
            }
            if read.to_bits() == self.last[i].to_bits() {
                self.equal[i] += 1;
                let changed = (expected - self.expected[i]).abs() > STUCK_CHANGE * std;
                if self.equal[i] >= STUCK_READINGS && changed {
                    self.equal[i] = 0;
                    self.expected[i] = expected;
                    found = Some(i);
                }
            } else {
                (self.last[i], self.equal[i], self.expected[i]) = (read, 0, expected);
            }
        }
        found
    }
}

/// Limit of the cumulative sum with one false alarm in a number of samples.
fn cusum_limit(samples: f64, cables: usize) -> f64 {
    let target = samples * 2.0 * cables as f64 * 2.0 * ALLOWANCE * ALLOWANCE;
    let mut b = (target + 1.0).ln();
    for _ in 0..4 {
        b = (target + b + 1.0).ln();
    }
    b / (2.0 * ALLOWANCE) - 1.166
}

/// Limit of |z| of which two in three samples come once in a number of samples.
fn single_limit(samples: f64, cables: usize) -> f64 {
    // Two of three: twice the square of the probability of one, for each cable.
    let one = (1.0 / (2.0 * samples * cables as f64)).sqrt();
    normal_quantile(1.0 - 0.5 * one)
}

/// Explanations of an alarm by runs of copies of a filter over the readings since `start`, each with noise where its
/// fault would be. `relative` are the innovations at the alarm; `own` is the cable that alone explains them: payload
/// and wrench, which pull at all cables, are no explanation then.
pub(super) fn explain<'a>(
    start: &Kalman,
    rows: &(impl Iterator<Item = (&'a SensorReadings, f64)> + Clone),
    relative: &[f64; MAX_ROWS],
    own: Option<usize>,
) -> FaultVerdict {
    let places = start.places;
    let mut order: Vec<usize> = (0..places.cables).collect();
    let size = |i: usize| if relative[i].is_finite() { relative[i].abs() } else { 0.0 };
    order.sort_by(|a, b| size(*b).total_cmp(&size(*a)));

    let mut found = Vec::new();
    let mut run = |kind: FaultKind, cable: Option<usize>| {
        if let Some(hypothesis) = of_kind(start, rows.clone(), kind, cable) {
            found.push(hypothesis);
        }
    };
    for cable in order.into_iter().take(SUSPECTS) {
        run(FaultKind::Slip, Some(cable));
        run(FaultKind::LoadCell, Some(cable));
    }
    if own.is_none() {
        run(FaultKind::Payload, None);
        run(FaultKind::Wrench, None);
    }
    found.sort_by(|a, b| a.worse_by.total_cmp(&b.worse_by));
    let best = found.first().map_or(0.0, |best| best.worse_by);
    let is_decided = found.get(1).is_none_or(|second| second.worse_by - best > UNDECIDED);
    let mut hypotheses = [None; 2 * SUSPECTS + 2];
    for (place, mut hypothesis) in hypotheses.iter_mut().zip(found) {
        hypothesis.worse_by -= best;
        *place = Some(hypothesis);
    }
    FaultVerdict { hypotheses, is_decided }
}

/// Run of one hypothesis.
fn of_kind<'a>(
    start: &Kalman,
    rows: impl Iterator<Item = (&'a SensorReadings, f64)>,
    kind: FaultKind,
    cable: Option<usize>,
) -> Option<FaultHypothesis> {
    let mut kalman = start.clone();
    kalman.holds_payload = false;
    let i = cable.unwrap_or(0);
    // Slip and step of a load cell have one size in newtons, so that neither is likelier by its size alone.
    let cell = SLIP * kalman.at.cables[i].tension_by_length.abs();
    let (places, std) = match kind {
        FaultKind::Slip | FaultKind::Cut => ([StatePlaces::OFFSETS + i, 0, 0, 0], [SLIP, 0.0, 0.0, 0.0]),
        FaultKind::LoadCell | FaultKind::Stuck => ([start.places.tension_biases() + i, 0, 0, 0], [cell, 0.0, 0.0, 0.0]),
        FaultKind::Payload => {
            let first = StatePlaces::PAYLOAD;
            ([first, first + 1, first + 2, first + 3], [20.0, 2.0, 2.0, 2.0])
        }
        FaultKind::Wrench => {
            let first = StatePlaces::WRENCH;
            ([first, first + 1, first + 2, 0], [200.0, 200.0, 200.0, 0.0])
        }
    };
    let count = match kind {
        FaultKind::Payload => 4,
        FaultKind::Wrench => 3,
        _ => 1,
    };
    kalman.added = StepNoise { places, variances: std.map(|std| std * std), count };

    let value = |kalman: &Kalman| match kind {
        FaultKind::Slip | FaultKind::Cut => kalman.mean.offsets[i],
        FaultKind::LoadCell | FaultKind::Stuck => kalman.mean.tension_biases[i],
        FaultKind::Payload => kalman.mean.load.mass,
        FaultKind::Wrench => kalman.mean.load.wrench[2],
    };
    let before = value(&kalman);
    let (mut worse_by, mut least_tension) = (0.0, f64::INFINITY);
    for (readings, step) in rows {
        kalman.predict(&readings.lengths, step).ok()?;
        kalman.begin();
        for group in SensorGroup::ALL {
            if let Some(result) = kalman.measure(group, readings) {
                worse_by += result.nis + result.log_determinant;
            }
        }
        kalman.finish().ok()?;
        if readings.tensions[i].is_finite() {
            least_tension = readings.tensions[i];
        }
    }
    let place = if kind == FaultKind::Wrench { places[2] } else { places[0] };
    let is_loose = least_tension < kalman.at.cables[i].half_weight + 3.0 * kalman.settings.noise.tension;
    let kind = if kind == FaultKind::Slip && is_loose { FaultKind::Cut } else { kind };
    let std = kalman.covariance.variance(place).sqrt();
    Some(FaultHypothesis { kind, cable, size: value(&kalman) - before, std, worse_by })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Limits by docs/theory.md: 65,000 samples for h = 12, one a day at 1 kHz for h = 19.3.
    #[test]
    fn limits_of_the_cumulative_sum_have_their_stated_rates() {
        assert!((cusum_limit(65_000.0, 8) - 12.0).abs() < 0.1, "{}", cusum_limit(65_000.0, 8));
        assert!((cusum_limit(86.4e6, 8) - 19.3).abs() < 0.15, "{}", cusum_limit(86.4e6, 8));
    }
}

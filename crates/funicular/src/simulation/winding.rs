//! Unstrained length of one rope over time: changes by the winch, each with continuous rate and acceleration.

use super::rope::WoundLength;

/// Course of one change of length.
#[derive(Debug, Clone, PartialEq)]
enum LengthCourse {
    /// Change by a polynomial of the fifth degree, from rest to rest [m].
    Ramp { change: f64 },
    /// Spline through changes since its beginning, from rest to rest.
    Spline(LengthSpline),
    /// Polynomial of the time since the beginning, which goes on with the acceleration at its end.
    Commanded([f64; 6]),
    /// Brake from a rate and an acceleration to rest.
    Brake { rate: f64, acceleration: f64 },
}

/// Change of length between two times.
#[derive(Debug, Clone, PartialEq)]
struct Change {
    from: f64,
    until: f64,
    /// Length at the beginning [m].
    length: f64,
    course: LengthCourse,
}

/// Unstrained length of one rope over time.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Winding {
    pub(super) initial: f64,
    /// Length that has been cut off at the platform [m].
    pub(super) cut_off: f64,
    changes: Vec<Change>,
}

/// A change that begins before the last one has ended; with the end of that [s].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Overlap {
    pub(super) until: f64,
}

impl Winding {
    pub(super) fn constant(length: f64) -> Self {
        Self { initial: length, cut_off: 0.0, changes: Vec::new() }
    }

    /// From now on the length counts from a place this far from its old beginning [m].
    pub(super) fn cut_off(&mut self, length: f64) {
        self.cut_off += length;
    }

    /// Length, rate and acceleration at a time.
    pub(super) fn at(&self, time: f64) -> WoundLength {
        let later = self.changes.partition_point(|change| change.from <= time);
        let whole = match later.checked_sub(1).map(|k| &self.changes[k]) {
            None => WoundLength { value: self.initial, rate: 0.0, acceleration: 0.0 },
            Some(change) => change.at(time),
        };
        WoundLength { value: whole.value - self.cut_off, ..whole }
    }

    /// Time at which the last change ends [s].
    pub(super) fn ends_at(&self) -> f64 {
        self.changes.last().map_or(0.0, |change| change.until)
    }

    fn push(&mut self, from: f64, until: f64, course: LengthCourse) -> Result<(), Overlap> {
        if from < self.ends_at() {
            return Err(Overlap { until: self.ends_at() });
        }
        let length = self.at(from).value;
        self.changes.push(Change { from, until, length, course });
        Ok(())
    }

    /// Changes the length by `change` [m] within `duration` [s].
    pub(super) fn ramp(&mut self, from: f64, duration: f64, change: f64) -> Result<(), Overlap> {
        self.push(from, from + duration, LengthCourse::Ramp { change })
    }

    /// Follows lengths given at times since `from`; the first is the length at that time.
    pub(super) fn follow(&mut self, from: f64, times: &[f64], lengths: &[f64]) -> Result<(), Overlap> {
        let spline = LengthSpline::new(times, lengths);
        self.push(from, from + times[times.len() - 1], LengthCourse::Spline(spline))
    }

    /// Brings the winch to rest within `duration`; what it was to do later in its present change is left out.
    pub(super) fn brake(&mut self, from: f64, duration: f64) {
        let now = self.at(from);
        let is_winding = self.ends_at() > from;
        self.changes.retain(|change| change.from < from);
        if is_winding {
            let course = LengthCourse::Brake { rate: now.rate, acceleration: now.acceleration };
            self.changes.push(Change { from, until: from + duration, length: now.value, course });
        }
    }

    /// Takes a polynomial of the time since `from` in place of all changes; it goes on with the acceleration that it
    /// has at `until`.
    pub(super) fn command(&mut self, from: f64, until: f64, coefficients: [f64; 6]) {
        let [length, ..] = coefficients;
        self.initial = length;
        self.changes = vec![Change { from, until, length, course: LengthCourse::Commanded(coefficients) }];
    }

    /// Gives its numbers away, those of a [command](Self::command) included, to be read or replaced.
    pub(super) fn each_number(&mut self, each: &mut dyn FnMut(&mut f64)) {
        each(&mut self.initial);
        each(&mut self.cut_off);
        for Change { from, until, length, course } in &mut self.changes {
            [from, until, length].into_iter().for_each(&mut *each);
            if let LengthCourse::Commanded(coefficients) = course {
                coefficients.iter_mut().for_each(&mut *each);
            }
        }
    }

    /// Gives the numbers of its [command](Self::command) away, to be read or replaced; without one it rests.
    pub(super) fn each_commanded_number(&mut self, each: &mut dyn FnMut(&mut f64)) {
        let is_commanded = matches!(&self.changes[..], [Change { course: LengthCourse::Commanded(_), .. }]);
        if !is_commanded {
            let now = self.at(0.0).value;
            self.command(0.0, 0.0, [now, 0.0, 0.0, 0.0, 0.0, 0.0]);
        }
        self.each_number(each);
    }

    /// Times at which a change begins or ends [s].
    pub(super) fn breaks(&self) -> impl Iterator<Item = f64> + '_ {
        self.changes.iter().flat_map(|change| [change.from, change.until])
    }

    /// Times between which the length is a cubic, at least nearly: those of splines, and `parts` parts of other changes
    /// [s].
    pub(super) fn knots(&self, parts: usize) -> Vec<f64> {
        let mut knots = Vec::new();
        for (i, change) in self.changes.iter().enumerate() {
            // A brake ends the change before it.
            let until = self.changes.get(i + 1).map_or(change.until, |next| change.until.min(next.from));
            if let LengthCourse::Spline(spline) = &change.course {
                knots.extend(spline.times.iter().map(|time| change.from + time).filter(|time| *time < until));
                knots.push(until);
            } else {
                let part = (until - change.from) / parts as f64;
                knots.extend((0..=parts).map(|k| change.from + part * k as f64));
            }
        }
        knots
    }

    /// Least length of all times from `since` on, at steps of `step` [m], and its time [s].
    pub(super) fn least(&self, step: f64, since: f64) -> (f64, f64) {
        let mut least = (self.at(since).value, since);
        for (i, change) in self.changes.iter().enumerate() {
            // A brake ends the change before it.
            let until = self.changes.get(i + 1).map_or(change.until, |next| change.until.min(next.from));
            let from = change.from.max(since);
            if from > until {
                continue;
            }
            let count = ((until - from) / step).ceil().clamp(1.0, 1e5) as usize;
            for k in 0..=count {
                let time = from + (until - from) * k as f64 / count as f64;
                let length = change.at(time).value;
                if length < least.0 {
                    least = (length, time);
                }
            }
        }
        least
    }
}

impl Change {
    fn at(&self, time: f64) -> WoundLength {
        let duration = self.until - self.from;
        if let LengthCourse::Commanded(coefficients) = &self.course {
            return commanded(coefficients, time - self.from, duration);
        }
        let s = (time - self.from).clamp(0.0, duration);
        let [value, rate, acceleration] = match &self.course {
            LengthCourse::Ramp { change } => ramp(s / duration).map(|of| change * of),
            LengthCourse::Spline(spline) => spline.at(s),
            LengthCourse::Brake { rate, acceleration } => brake(*rate, *acceleration, s, duration),
            LengthCourse::Commanded(_) => [0.0; 3],
        };
        let [rate, acceleration] = match &self.course {
            LengthCourse::Ramp { .. } => [rate / duration, acceleration / (duration * duration)],
            _ => [rate, acceleration],
        };
        // A spline or brake is at rest at its end, but for rounding.
        let is_over = time >= self.until;
        WoundLength {
            value: self.length + value,
            rate: if is_over { 0.0 } else { rate },
            acceleration: if is_over { 0.0 } else { acceleration },
        }
    }
}

/// Smooth step and its derivatives over x in [0, 1].
pub(super) fn ramp(x: f64) -> [f64; 3] {
    let rest = 1.0 - x;
    [x * x * x * (10.0 - x * (15.0 - 6.0 * x)), 30.0 * x * x * rest * rest, 60.0 * x * rest * (1.0 - 2.0 * x)]
}

/// Polynomial after a time `s`, from its end on with a constant acceleration.
fn commanded([c0, c1, c2, c3, c4, c5]: &[f64; 6], s: f64, duration: f64) -> WoundLength {
    let (within, beyond) = (s.min(duration), (s - duration).max(0.0));
    let value = c0 + within * (c1 + within * (c2 + within * (c3 + within * (c4 + within * c5))));
    let rate = c1 + within * (2.0 * c2 + within * (3.0 * c3 + within * (4.0 * c4 + within * 5.0 * c5)));
    let acceleration = 2.0 * c2 + within * (6.0 * c3 + within * (12.0 * c4 + within * 20.0 * c5));
    WoundLength {
        value: value + beyond * (rate + 0.5 * beyond * acceleration),
        rate: rate + beyond * acceleration,
        acceleration,
    }
}

/// Coefficients of the polynomial between two lengths with their rates, `duration` apart; of the fifth degree with both
/// accelerations, else of the third.
pub(super) fn between(from: &WoundLength, to: &WoundLength, duration: f64, keeps_acceleration: bool) -> [f64; 6] {
    let (t, change) = (duration, to.value - from.value);
    if keeps_acceleration {
        let d = (change - t * (from.rate + 0.5 * t * from.acceleration)) / t.powi(3);
        let e = (to.rate - from.rate - t * from.acceleration) / t.powi(2);
        let f = (to.acceleration - from.acceleration) / t;
        let (c3, c4, c5) = (10.0 * d - 4.0 * e + 0.5 * f, -15.0 * d + 7.0 * e - f, 6.0 * d - 3.0 * e + 0.5 * f);
        [from.value, from.rate, 0.5 * from.acceleration, c3, c4 / t, c5 / (t * t)]
    } else {
        let mean = change / t;
        let c2 = (3.0 * mean - 2.0 * from.rate - to.rate) / t;
        let c3 = (from.rate + to.rate - 2.0 * mean) / (t * t);
        [from.value, from.rate, c2, c3, 0.0, 0.0]
    }
}

/// Coefficients of the polynomial that brakes to rest, as [`Winding::brake`].
pub(super) fn braking(from: &WoundLength, duration: f64) -> [f64; 6] {
    let (r, t) = (from.rate, duration);
    let slope = from.acceleration * t;
    let c3 = (-3.0 * r - 2.0 * slope) / 3.0 / (t * t);
    [from.value, r, 0.5 * from.acceleration, c3, (2.0 * r + slope) / 4.0 / t.powi(3), 0.0]
}

/// Change, rate and acceleration after a time `s` of braking; the rate is the cubic that begins with the given rate and
/// acceleration and ends at rest.
fn brake(rate: f64, acceleration: f64, s: f64, duration: f64) -> [f64; 3] {
    let x = s / duration;
    let slope = acceleration * duration;
    // rate(x) = r (1 − 3x² + 2x³) + slope x (1 − x)².
    let of_rate = [x - x.powi(3) + 0.5 * x.powi(4), 1.0 - 3.0 * x * x + 2.0 * x.powi(3), 6.0 * x * (x - 1.0)];
    let of_slope = [x * x * (0.5 - 2.0 / 3.0 * x + 0.25 * x * x), x * (1.0 - x).powi(2), (1.0 - x) * (1.0 - 3.0 * x)];
    let value = |k: usize| rate * of_rate[k] + slope * of_slope[k];
    [value(0) * duration, value(1), value(2) / duration]
}

/// Cubic spline with continuous acceleration through lengths, at rest at both ends.
#[derive(Debug, Clone, PartialEq)]
struct LengthSpline {
    times: Vec<f64>,
    /// Change since the first row [m].
    values: Vec<f64>,
    /// Acceleration at each row [m/s²].
    curvatures: Vec<f64>,
}

impl LengthSpline {
    /// Spline of at least two rows with rising times, the first at zero.
    fn new(times: &[f64], lengths: &[f64]) -> Self {
        let count = times.len();
        let values: Vec<f64> = lengths.iter().map(|length| length - lengths[0]).collect();
        let gaps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let speeds: Vec<f64> = (0..count - 1).map(|k| (values[k + 1] - values[k]) / gaps[k]).collect();

        // Continuity of the rate at each row; beyond the ends the rate is zero. Three diagonals, by elimination.
        let gap = |k: Option<usize>| k.and_then(|k| gaps.get(k)).copied().unwrap_or(0.0);
        let speed = |k: Option<usize>| k.and_then(|k| speeds.get(k)).copied().unwrap_or(0.0);
        let (mut upper, mut curvatures) = (vec![0.0; count], vec![0.0; count]);
        for k in 0..count {
            let (before, after) = (gap(k.checked_sub(1)), gap(Some(k)));
            let right = 6.0 * (speed(Some(k)) - speed(k.checked_sub(1)));
            let (upper_before, curvature_before) = if k > 0 { (upper[k - 1], curvatures[k - 1]) } else { (0.0, 0.0) };
            let pivot = 2.0 * (before + after) - before * upper_before;
            upper[k] = after / pivot;
            curvatures[k] = (right - before * curvature_before) / pivot;
        }
        for k in (0..count - 1).rev() {
            curvatures[k] -= upper[k] * curvatures[k + 1];
        }
        Self { times: times.to_vec(), values, curvatures }
    }

    fn at(&self, time: f64) -> [f64; 3] {
        let next = self.times.partition_point(|at| *at <= time).clamp(1, self.times.len() - 1);
        let k = next - 1;
        let gap = self.times[next] - self.times[k];
        let s = (time - self.times[k]) / gap;
        let (m0, m1) = (self.curvatures[k] * gap * gap, self.curvatures[next] * gap * gap);
        let slope = self.values[next] - self.values[k] - m0 / 3.0 - m1 / 6.0;
        let value = self.values[k] + s * (slope + s * (0.5 * m0 + s * (m1 - m0) / 6.0));
        let rate = slope + s * (m0 + 0.5 * s * (m1 - m0));
        [value, rate / gap, (m0 + s * (m1 - m0)) / (gap * gap)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rates and accelerations are the differences of the lengths, everywhere.
    fn assert_smooth(winding: &Winding, until: f64) {
        let step = 1e-5;
        for k in 1..400 {
            let time = until * f64::from(k) / 400.0 + 1.234e-4;
            let [before, now, after] = [-step, 0.0, step].map(|shift| winding.at(time + shift));
            assert!(((after.value - before.value) / (2.0 * step) - now.rate).abs() < 1e-6, "{time}");
            assert!(((after.rate - before.rate) / (2.0 * step) - now.acceleration).abs() < 1e-3, "{time}");
        }
    }

    #[test]
    fn lengths_have_continuous_rates_and_accelerations() {
        let mut winding = Winding::constant(5.0);
        winding.ramp(0.1, 1.0, -0.5).unwrap();
        winding.follow(1.5, &[0.0, 0.2, 0.5, 1.0], &[4.5, 4.6, 4.4, 5.0]).unwrap();
        assert_smooth(&winding, 3.0);
        assert!((winding.at(1.2).value - 4.5).abs() < 1e-14 && (winding.at(2.0).value - 4.4).abs() < 1e-13);
        assert!((winding.at(9.0).value - 5.0).abs() < 1e-13);
        assert_eq!(winding.ramp(2.0, 1.0, 1.0), Err(Overlap { until: 2.5 }));

        // Until the brake begins, nothing is different.
        let before = winding.clone();
        winding.brake(0.4, 0.2);
        for k in 0..=100 {
            let time = 0.4 * f64::from(k) / 100.0;
            let [with, without] = [&winding, &before].map(|of| of.at(time));
            assert!((with.value - without.value).abs() < 1e-14 && (with.rate - without.rate).abs() < 1e-13, "{time}");
            assert!((with.acceleration - without.acceleration).abs() < 1e-12, "{time}");
        }
        assert_smooth(&winding, 1.0);
        let rest = winding.at(0.6 + 1e-9);
        assert!(rest.rate == 0.0 && rest.acceleration == 0.0 && rest.value < winding.at(0.4).value);
        assert!((winding.at(9.0).value - rest.value).abs() < 1e-15);
    }
}

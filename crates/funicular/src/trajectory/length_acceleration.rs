//! Accelerations of the lengths from lengths and rates at neighbouring times.

/// Least time over which a difference is taken, if the values are smooth for so long [s]: lengths have an error of
/// 1e-12 m, which is then 4e-6 m/s².
const MIN_STEP: f64 = 5e-4;

/// Second derivative over time of values whose first derivatives are known, at every time (docs/theory.md, equation
/// (40z7)). `belongs(k)` is true if the values between the times k and k + 1 are smooth; a difference does not reach
/// over an interval that is not, unless there is no other beside it.
///
/// A neighbour is the nearest time that is at least 0.5 ms away, or the farthest one before the values cease to be
/// smooth. Times may be equal: a pair of them stands for both sides of a jump.
///
/// With both neighbours the polynomial of the fifth degree through values and rates is differentiated, with one that of
/// the third degree.
///
/// # Panics
/// If the three lists do not have the same number of rows.
///
/// # Example
/// ```
/// use funicular::trajectory::length_accelerations;
///
/// let times = [0.0, 0.3, 0.5, 0.9];
/// let lengths = times.map(|t: f64| vec![1.0 + t.powi(3)]);
/// let rates = times.map(|t: f64| vec![3.0 * t * t]);
/// let found = length_accelerations(&times, &lengths, &rates, |_| true);
/// assert!(found.iter().zip(times).all(|(row, t)| (row[0] - 6.0 * t).abs() < 1e-12));
/// ```
pub fn length_accelerations(
    times: &[f64],
    lengths: &[Vec<f64>],
    rates: &[Vec<f64>],
    belongs: impl Fn(usize) -> bool,
) -> Vec<Vec<f64>> {
    assert!(times.len() == lengths.len() && times.len() == rates.len(), "as many rows of each");
    let row = |k: usize| {
        let smooth =
            [neighbour(k, (0..k).rev(), times, &belongs), neighbour(k, k + 1..times.len(), times, |j| belongs(j - 1))];
        let any = [neighbour(k, (0..k).rev(), times, |_| true), neighbour(k, k + 1..times.len(), times, |_| true)];
        let used = if smooth == [None, None] { any } else { smooth };

        let of = |i: usize| {
            // Value beside a line over the square of the distance, with its slope.
            let bend = |j: usize| {
                let (time, rate) = (times[j] - times[k], rates[j][i] - rates[k][i]);
                let beside = lengths[j][i] - lengths[k][i] - rates[k][i] * time;
                Bend { time, value: beside / (time * time), slope: rate / (time * time) - 2.0 * beside / time.powi(3) }
            };
            2.0 * match used.map(|of| of.map(bend)) {
                [Some(before), Some(after)] => before.between(&after),
                [Some(one), None] | [None, Some(one)] => one.value - one.time * one.slope,
                [None, None] => 0.0,
            }
        };
        (0..lengths[k].len()).map(of).collect()
    };
    (0..times.len()).map(row).collect()
}

/// Time next to that with the index k on one side: the nearest of these indices that is far enough, or the farthest
/// that can be reached.
fn neighbour(
    k: usize,
    indices: impl Iterator<Item = usize>,
    times: &[f64],
    is_reached: impl Fn(usize) -> bool,
) -> Option<usize> {
    let mut found = None;
    for j in indices {
        let distance = (times[j] - times[k]).abs();
        if !is_reached(j) {
            break;
        }
        if distance > 0.0 {
            found = Some(j);
        }
        if distance >= MIN_STEP {
            break;
        }
    }
    found
}

/// `(L(t) − L(0) − L̇(0) t)/t²` with its slope.
struct Bend {
    time: f64,
    value: f64,
    slope: f64,
}

impl Bend {
    /// Value at the time 0 of the cubic through both.
    fn between(&self, after: &Self) -> f64 {
        let span = after.time - self.time;
        let s = -self.time / span;
        let (s2, s3) = (s * s, s * s * s);
        (2.0 * s3 - 3.0 * s2 + 1.0) * self.value
            + (s3 - 2.0 * s2 + s) * span * self.slope
            + (3.0 * s2 - 2.0 * s3) * after.value
            + (s3 - s2) * span * after.slope
    }
}

//! Rows of a path with few digits, or with noise: a smooth curve through them has accelerations that the motion does
//! not have.

use super::super::timed_rows::{POSE, TimedRows};
use crate::request::NumberColumns;
use crate::text::{short, significant};
use funicular::path::smoothed_within;

/// Accelerations by rounding, over those of the smoothed motion, from which on a warning comes. A motion with 1.4 m/s²
/// in steps of 1 mm every 0.1 s has some 0.2, and tensions that are right to 2 %; steps of 0.1 mm every 10 ms have 2
/// and more.
const MAX_PART: f64 = 0.4;

/// Unit of the last digit below which a column has all digits [m or degrees].
const MIN_UNIT: f64 = 1e-9;

/// Part of the noise of fourth differences that sixth differences show at least if the values are noisy: white noise
/// has 1, and smooth values the square of their frequency times the step.
const NOISE: f64 = 0.7;

/// Noise over the unit of the last digit from which on it is none of rounding, which has 0.29.
const MIN_NOISE: f64 = 0.5;

/// Standard deviations of noise within which values are smoothed.
const DEVIATIONS: f64 = 3.0;

/// Number of rows that a message names.
const NAMED: usize = 3;

/// Coordinates of a row: position [m] and angles [degrees].
const COUNT: usize = POSE.len();

/// Rows whose rounding or noise makes accelerations.
#[derive(Debug, Clone)]
pub(super) struct RoundedRows {
    /// Column with the largest of them.
    column: &'static str,
    /// Unit of its last digit, or `None` for noise [m or degrees].
    unit: Option<f64>,
    /// Standard deviation of its noise [m or degrees].
    deviation: f64,
    /// Time between two rows [s].
    step: f64,
    /// Accelerations of the rows beside those of the smoothed motion, and those of the smoothed motion [m/s²].
    by_rounding: f64,
    own: f64,
    /// Numbers of the rows with the largest, from 1.
    rows: Vec<usize>,
    /// Tolerance that takes the rounding out [m].
    tolerance: f64,
}

impl RoundedRows {
    /// Looks for them in rows of poses; `length` is that with which an angle becomes a distance [m].
    pub(super) fn of(rows: &TimedRows, columns: &NumberColumns, length: f64) -> Option<Self> {
        if rows.times.len() <= COUNT {
            return None;
        }
        let scales: [f64; COUNT] = std::array::from_fn(|k| if k < 3 { 1.0 } else { length.to_radians() });
        let errors: [RowRounding; COUNT] = std::array::from_fn(|k| RowRounding::of(rows, columns, k));
        let mut own = vec![0.0; rows.times.len()];
        let mut others: Vec<[f64; COUNT]> = vec![[0.0; COUNT]; rows.times.len()];
        for k in 0..COUNT {
            let values = unwrapped(rows, k);
            let smooth = smoothed_within(&rows.times, &values, errors[k].bound());
            let [given, smooth] = [&values, &smooth].map(|values| bends(&rows.times, values));
            for row in 0..own.len() {
                own[row] += (scales[k] * smooth[row]).powi(2);
                others[row][k] = scales[k] * (given[row] - smooth[row]).abs();
            }
        }

        let norm = |of: &[f64; COUNT]| of.iter().map(|x| x * x).sum::<f64>().sqrt();
        let own = own.into_iter().map(f64::sqrt).fold(0.0, f64::max);
        let mut order: Vec<usize> = (0..others.len()).collect();
        order.sort_by(|a, b| norm(&others[*b]).total_cmp(&norm(&others[*a])));
        let worst = order[0];
        let by_rounding = norm(&others[worst]);
        if by_rounding <= MAX_PART * own || by_rounding == 0.0 {
            return None;
        }
        let largest = |a: &usize, b: &usize| others[worst][*a].total_cmp(&others[worst][*b]);
        let k = (0..COUNT).max_by(largest)?;
        let mut named: Vec<usize> = order.iter().take(NAMED).map(|row| row + 1).collect();
        named.sort_unstable();
        let step = rows.times[(worst + 1).min(rows.times.len() - 1)] - rows.times[worst.max(1) - 1];
        Some(Self {
            column: POSE[k],
            unit: errors[k].unit,
            deviation: errors[k].deviation,
            step: 0.5 * step,
            by_rounding,
            own,
            rows: named,
            tolerance: (0..COUNT).map(|k| scales[k] * errors[k].bound()).fold(0.0, f64::max),
        })
    }

    /// Rows, reason and remedy.
    pub(super) fn warning(&self) -> String {
        let angle = if self.column.ends_with("_deg") { "°" } else { " m" };
        let reason = match self.unit {
            Some(unit) => format!(
                "`{}` of ⟪path⟫ is rounded to {}{angle} every {} s: a curve through rounded rows has accelerations of \
                 about 4 · {}/{}² = {} {angle}/s²",
                self.column,
                short(unit, 6),
                short(self.step, 6),
                short(unit, 6),
                short(self.step, 6),
                significant(4.0 * unit / self.step.powi(2), 2),
            )
            .replace("  m", " m"),
            None => format!(
                "`{}` of ⟪path⟫ has a noise of about {}{angle} every {} s",
                self.column,
                significant(self.deviation, 2),
                short(self.step, 6)
            ),
        };
        let rows: Vec<String> = self.rows.iter().map(ToString::to_string).collect();
        format!(
            "{reason}; at rows {} they are up to {} m/s², while the smoothed motion has at most {} m/s²; {}",
            rows.join(", "),
            significant(self.by_rounding, 2),
            significant(self.own, 2),
            self.remedy()
        )
    }

    /// Sentence for a pose on the path that the cables do not hold.
    pub(super) fn advice(&self) -> String {
        format!("the reason may be the rows: {}", self.warning())
    }

    fn remedy(&self) -> String {
        let tolerance = significant(self.tolerance, 2);
        match self.unit {
            Some(_) => {
                format!("give more digits, fewer rows, or ⟪row_tolerance_m⟫ {tolerance}, half a unit of the last digit")
            }
            None => format!("give fewer rows, or ⟪row_tolerance_m⟫ {tolerance}, three times the noise"),
        }
    }
}

/// True if all values of a column are one.
fn is_constant(values: &[f64]) -> bool {
    values.iter().all(|value| value.total_cmp(&values[0]).is_eq())
}

/// Error of the values of a column.
#[derive(Debug, Clone, Copy)]
struct RowRounding {
    /// Unit of the last digit; `None` for a column with all digits, and for a noisy one.
    unit: Option<f64>,
    /// Standard deviation of noise that is no rounding; zero without it.
    deviation: f64,
}

impl RowRounding {
    fn of(rows: &TimedRows, columns: &NumberColumns, k: usize) -> Self {
        // A constant is as exact as it is written.
        let varying = columns.get(POSE[k]).filter(|values| !is_constant(values));
        let Some(values) = varying else { return Self { unit: None, deviation: 0.0 } };
        let places = values.iter().map(|value| decimal_places(*value)).max().unwrap_or(0);
        let unit = 10.0_f64.powi(-i32::try_from(places).unwrap_or(i32::MAX));
        let unit = (unit > MIN_UNIT).then_some(unit);
        let noise = noise(rows, k).filter(|noise| unit.is_none_or(|unit| *noise > MIN_NOISE * unit));
        Self { unit: unit.filter(|_| noise.is_none()), deviation: noise.unwrap_or(0.0) }
    }

    /// Distance within which the true values lie.
    fn bound(self) -> f64 {
        self.unit.map_or(0.0, |unit| 0.5 * unit).max(DEVIATIONS * self.deviation)
    }
}

/// Number of digits after the point of the shortest text of a number.
fn decimal_places(value: f64) -> usize {
    format!("{value}").split_once('.').map_or(0, |(_, places)| places.len())
}

/// Standard deviation of the noise of a column with steps of one length: by fourth differences, if sixth differences
/// show as much; those of a smooth motion are far smaller. Rounding is such noise as well.
fn noise(rows: &TimedRows, k: usize) -> Option<f64> {
    let steps = rows.times.windows(2).map(|pair| pair[1] - pair[0]);
    let (shortest, longest) = steps.fold((f64::INFINITY, 0.0_f64), |(a, b), step| (a.min(step), b.max(step)));
    if longest > 1.2 * shortest {
        return None;
    }
    let root_mean_square = |order: usize, white: f64| {
        let mut values = unwrapped(rows, k);
        for _ in 0..order {
            values = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
        }
        (values.iter().map(|x| x * x).sum::<f64>() / values.len() as f64 / white).sqrt()
    };
    // Sums of squares of the binomial coefficients.
    let (fourth, sixth) = (root_mean_square(4, 70.0), root_mean_square(6, 924.0));
    (fourth > 0.0 && sixth >= NOISE * fourth).then_some(fourth)
}

/// Values of a coordinate, angles without jumps by a whole turn.
fn unwrapped(rows: &TimedRows, k: usize) -> Vec<f64> {
    let mut turns = 0.0;
    let mut last: Option<f64> = None;
    let value = |row: &Vec<f64>| {
        let value = row[k];
        if let Some(last) = last.filter(|_| k >= 3) {
            turns -= ((value - last) / 360.0).round() * 360.0;
        }
        last = Some(value);
        value + turns
    };
    rows.values.iter().map(value).collect()
}

/// Second divided differences at the rows, doubled; zero at both ends.
fn bends(times: &[f64], values: &[f64]) -> Vec<f64> {
    let mut found = vec![0.0; values.len()];
    for row in 1..values.len().saturating_sub(1) {
        let (left, right) = (times[row] - times[row - 1], times[row + 1] - times[row]);
        let slopes = (values[row + 1] - values[row]) / right - (values[row] - values[row - 1]) / left;
        found[row] = 2.0 * slopes / (left + right);
    }
    found
}

/// Smooths rows of poses by less than a distance [m], angles by what moves a point at a length [m] as far.
pub(super) fn smooth(rows: &mut TimedRows, tolerance: f64, length: f64) {
    for k in 0..COUNT {
        let bound = if k < 3 { tolerance } else { (tolerance / length).to_degrees() };
        let values = unwrapped(rows, k);
        if is_constant(&values) || !bound.is_finite() {
            continue;
        }
        for (row, value) in smoothed_within(&rows.times, &values, bound).into_iter().enumerate() {
            rows.values[row][k] = value;
        }
    }
}

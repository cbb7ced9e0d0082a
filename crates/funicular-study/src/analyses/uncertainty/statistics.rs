//! Statistics of a sample.

use super::distribution::PROBABILITY;

/// Statistics of the values of one result.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Statistics {
    /// Number of robots with a value.
    pub(crate) count: usize,
    /// Mean.
    pub(crate) mean: f64,
    /// Standard deviation.
    pub(crate) deviation: f64,
    /// Interval that holds 95 %.
    pub(crate) interval: [f64; 2],
}

impl Statistics {
    /// Statistics of values, of which those that do not exist are NaN; `None` for fewer than two values.
    pub(crate) fn of(values: impl Iterator<Item = f64>) -> Option<Self> {
        let mut sorted: Vec<f64> = values.filter(|value| value.is_finite()).collect();
        let count = sorted.len();
        if count < 2 {
            return None;
        }
        sorted.sort_by(f64::total_cmp);
        let mean = sorted.iter().sum::<f64>() / count as f64;
        let squares: f64 = sorted.iter().map(|value| (value - mean).powi(2)).sum();
        let tail = 0.5 - 0.5 * PROBABILITY;
        let interval = [quantile(&sorted, tail), quantile(&sorted, 1.0 - tail)];
        Some(Self { count, mean, deviation: (squares / (count as f64 - 1.0)).sqrt(), interval })
    }
}

/// Quantile of ascending values, with straight lines between them.
///
/// # References
/// R. J. Hyndman, Y. Fan, Sample quantiles in statistical packages, The American Statistician 50(4), 1996: definition
/// 8.
fn quantile(sorted: &[f64], p: f64) -> f64 {
    let last = sorted.len() - 1;
    let place = ((sorted.len() as f64 + 1.0 / 3.0) * p - 2.0 / 3.0).clamp(0.0, last as f64);
    let below = (place as usize).min(last);
    let above = (below + 1).min(last);
    sorted[below] + (place - below as f64) * (sorted[above] - sorted[below])
}

/// Total share of a group in the variance: half of the mean square of the change if only the values of the group are
/// drawn again, over the variance.
///
/// # References
/// M. J. W. Jansen, Analysis of variance designs for model output, Computer Physics Communications 117, 1999.
///
/// `changes` has the change of every robot and the linear change of the same robot, whose mean square is known to be
/// `linear`. The linear changes are a control variate, which takes most of the noise from the estimate; all zero they
/// change nothing.
pub(super) fn total_share(changes: impl Iterator<Item = (f64, f64)>, linear: f64, variance: f64) -> Option<f64> {
    let squares: Vec<(f64, f64)> = changes
        .filter(|(change, _)| change.is_finite())
        .map(|(change, linear)| (change * change, linear * linear))
        .collect();
    let count = squares.len() as f64;
    if squares.is_empty() || variance <= 0.0 {
        return None;
    }
    let mean = squares.iter().map(|(of, _)| of).sum::<f64>() / count;
    let mean_linear = squares.iter().map(|(_, of)| of).sum::<f64>() / count;
    let spread: f64 = squares.iter().map(|(_, of)| (of - mean_linear).powi(2)).sum();
    let common: f64 = squares.iter().map(|(one, of)| (one - mean) * (of - mean_linear)).sum();
    let factor = if spread > 0.0 { common / spread } else { 0.0 };
    Some(0.5 * (mean - factor * (mean_linear - linear)).max(0.0) / variance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statistics_of_a_row_of_numbers() {
        let found = Statistics::of((0..=1000).map(f64::from).chain([f64::NAN])).unwrap();
        assert_eq!((found.count, found.mean), (1001, 500.0));
        // Variance of n equal steps: (n² − 1)/12, times n/(n − 1) for a sample.
        assert!((found.deviation - (1001.0 * 1002.0 / 12.0_f64).sqrt()).abs() < 1e-9);
        assert!((found.interval[0] - 25.0).abs() < 0.7 && (found.interval[1] - 975.0).abs() < 0.7, "{found:?}");
        assert_eq!(Statistics::of([1.0].into_iter()), None);
    }

    #[test]
    fn total_shares_are_those_of_a_function_with_an_interaction() {
        // y = x₁ + x₁x₂ with independent standard normal x: variance 2, total shares 1 and ½.
        let points = super::super::distribution::latin_hypercube(20_000, 3, 5);
        let z = |p: f64| crate::normal::normal_quantile(p);
        let y = |a: f64, b: f64| z(a) + z(a) * z(b);
        let first = total_share(points.iter().map(|p| (y(p[0], p[1]) - y(p[2], p[1]), 0.0)), 0.0, 2.0).unwrap();
        let second = total_share(points.iter().map(|p| (y(p[0], p[1]) - y(p[0], p[2]), 0.0)), 0.0, 2.0).unwrap();
        assert!((first - 1.0).abs() < 0.03 && (second - 0.5).abs() < 0.03, "{first} {second}");

        // The linear part x₁ of the change, whose mean square is 2, makes a few robots enough for a nearly linear
        // function.
        let few = super::super::distribution::latin_hypercube(50, 3, 5);
        let change = |p: &[f64]| (z(p[0]) - z(p[2])) * (1.0 + 0.01 * z(p[1]));
        let pairs = few.iter().map(|p| (change(p), z(p[0]) - z(p[2])));
        let share = total_share(pairs, 2.0, 1.0001).unwrap();
        assert!((share - 1.0).abs() < 0.01, "{share}");
    }
}

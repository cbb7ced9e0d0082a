//! Statistics of the innovations: whether the stated deviations are true.

use super::rows::MAX_ROWS;

/// Probability beyond the bands that are told.
const BAND: f64 = 0.05;

/// Result of a group of rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct GroupResult {
    /// Squared size of the innovation by its covariance, and its degrees of freedom.
    pub(super) nis: f64,
    pub(super) count: usize,
    /// Rows left out as outliers.
    pub(super) gated: usize,
    /// Logarithm of the determinant of the covariance of the innovation.
    pub(super) log_determinant: f64,
    /// Innovations over their deviations, by cable or axis; NaN without a reading.
    pub(super) relative: [f64; MAX_ROWS],
}

/// Statistics of one group of sensors since the start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Consistency {
    /// Sum of the squared sizes of the innovations by their covariances.
    pub nis: f64,
    /// Sum of the degrees of freedom.
    pub count: usize,
    /// Rows left out as outliers.
    pub gated: usize,
    /// Sum of z² of each cable or axis, with its number and the products with the value before; z is the innovation
    /// over its deviation.
    squares: [f64; MAX_ROWS],
    counts: [usize; MAX_ROWS],
    products: [f64; MAX_ROWS],
    before: [f64; MAX_ROWS],
}

impl Default for Consistency {
    fn default() -> Self {
        Self {
            nis: 0.0,
            count: 0,
            gated: 0,
            squares: [0.0; MAX_ROWS],
            counts: [0; MAX_ROWS],
            products: [0.0; MAX_ROWS],
            before: [f64::NAN; MAX_ROWS],
        }
    }
}

impl Consistency {
    /// Adds one time.
    pub(super) fn add(&mut self, result: &GroupResult) {
        self.nis += result.nis;
        self.count += result.count;
        self.gated += result.gated;
        for (k, z) in result.relative.iter().enumerate().filter(|(_, z)| z.is_finite()) {
            self.squares[k] += z * z;
            self.counts[k] += 1;
            if self.before[k].is_finite() {
                self.products[k] += z * self.before[k];
            }
            self.before[k] = *z;
        }
    }

    /// Mean of NIS per degree of freedom: one if the noise and the model are true; `None` without readings.
    pub fn per_freedom(&self) -> Option<f64> {
        (self.count > 0).then(|| self.nis / self.count as f64)
    }

    /// Band that holds [`Self::per_freedom`] with 95 % if noise and model are true.
    pub fn band(&self) -> [f64; 2] {
        let count = self.count.max(1) as f64;
        [0.5 * BAND, 1.0 - 0.5 * BAND].map(|part| chi2_quantile(part, count) / count)
    }

    /// Root mean square of z of a cable or axis; `None` without readings.
    pub fn ratio(&self, k: usize) -> Option<f64> {
        (self.counts[k] > 0).then(|| (self.squares[k] / self.counts[k] as f64).sqrt())
    }

    /// Correlation of z of a cable or axis with its value at the time before; `None` for less than three readings.
    pub fn correlation(&self, k: usize) -> Option<f64> {
        (self.counts[k] > 2 && self.squares[k] > 0.0).then(|| self.products[k] / self.squares[k])
    }

    /// Share of the rows that were left out as outliers.
    pub fn gated_share(&self) -> f64 {
        self.gated as f64 / self.count.max(1) as f64
    }
}

/// Quantile of χ² with any number of degrees of freedom, by the cube of a normal value (Wilson and Hilferty); for one
/// degree of freedom the square of the normal quantile. Within 1 % in the range of the tests here.
pub fn chi2_quantile(probability: f64, freedom: f64) -> f64 {
    if freedom <= 1.0 {
        return normal_quantile(0.5 + 0.5 * probability).powi(2);
    }
    let part = 2.0 / (9.0 * freedom);
    freedom * (1.0 - part + normal_quantile(probability) * part.sqrt()).max(0.0).powi(3)
}

/// Quantile of the normal distribution, by Newton's method on its integral.
pub(super) fn normal_quantile(probability: f64) -> f64 {
    let tail = probability.min(1.0 - probability).max(1e-300);
    // Rational start of Hastings, good to 4.5e-4.
    let t = (-2.0 * tail.ln()).sqrt();
    let mut x =
        t - (2.515_517 + t * (0.802_853 + t * 0.010_328)) / (1.0 + t * (1.432_788 + t * (0.189_269 + t * 0.001_308)));
    for _ in 0..3 {
        let density = (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt();
        x += (upper_tail(x) - tail) / density;
    }
    if probability < 0.5 { -x } else { x }
}

/// Probability above x ≥ 0 of the normal distribution: a continued fraction far out, else a series.
pub(super) fn upper_tail(x: f64) -> f64 {
    let density = (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt();
    if x > 3.0 {
        let fraction = (1..=60).rev().fold(x, |sum, k| x + f64::from(k) / sum);
        return density / fraction;
    }
    let (mut term, mut sum) = (x, x);
    for k in 1..80 {
        term *= x * x / f64::from(2 * k + 1);
        sum += term;
    }
    0.5 - density * sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_tables() {
        for (probability, quantile) in [(0.975, 1.959_964), (0.999, 3.090_232), (0.999_999_5, 4.891_638)] {
            assert!((normal_quantile(probability) - quantile).abs() < 1e-5, "{probability}");
        }
        for (probability, freedom, quantile) in [(0.95, 1.0, 3.8415), (0.95, 8.0, 15.507), (0.025, 100.0, 74.222)] {
            let found = chi2_quantile(probability, freedom);
            assert!((found / quantile - 1.0).abs() < 0.01, "{found} {quantile}");
        }
    }
}

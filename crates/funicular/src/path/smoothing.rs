//! Smooth values near the rounded ones of a table: the smoothest ones that round to what was written (docs/theory.md,
//! equation (40z11)).

/// Number of neighbours of a row in its third difference.
const REACH: usize = 3;

/// Weights of the smoothness: the first, the factor between two, and the largest. The first leaves the barrier in
/// charge; with the last the sum of squares of the third differences is larger than its minimum by 2n/10¹⁰ half units².
const FIRST_WEIGHT: f64 = 1e-2;
const WEIGHT_FACTOR: f64 = 10.0;
const MAX_WEIGHT: f64 = 1e10;

/// Part of the sum that the barrier may leave, half of the square of Newton's decrement at which a weight is done, and
/// largest numbers of steps and of halvings of a step, for the end of the iteration: every result is inside the bounds.
const GAP: f64 = 1e-3;
const DONE: f64 = 1e-4;
const MAX_STEPS: usize = 40;
const MAX_HALVINGS: usize = 40;

/// Values at ascending times with the least sum of squares of third differences, each nearer than a bound to the given
/// one. A bound of half a unit of the last digit takes the rounding out of a table; fewer than five values stay as they
/// are.
///
/// Minimises the sum with a logarithmic barrier at the bounds by Newton's method.
///
/// # Panics
/// If there are not as many values as times.
///
/// # Example
/// ```
/// use funicular::path::smoothed_within;
///
/// let times: Vec<f64> = (0..40).map(|k| 0.1 * f64::from(k)).collect();
/// let rounded: Vec<f64> = times.iter().map(|t| ((0.73 * t * t + 0.2 * t) * 100.0).round() / 100.0).collect();
/// let smooth = smoothed_within(&times, &rounded, 0.005);
/// assert!(smooth.iter().zip(&rounded).all(|(a, b)| (a - b).abs() < 0.005));
///
/// // Second derivatives, from differences, are 1.46.
/// let error = |x: &[f64], k: usize| ((x[k + 1] - 2.0 * x[k] + x[k - 1]) / 0.01 - 1.46).abs();
/// let largest = |x: &[f64]| (1..39).map(|k| error(x, k)).fold(0.0, f64::max);
/// assert!(largest(&smooth) < 1e-3 && largest(&rounded) > 0.5);
/// ```
pub fn smoothed_within(times: &[f64], values: &[f64], bound: f64) -> Vec<f64> {
    assert!(times.len() == values.len(), "{} times, {} values", times.len(), values.len());
    let is_positive = bound > 0.0;
    if values.len() <= REACH + 1 || !is_positive {
        return values.to_vec();
    }
    let differences = ThirdDifferences::of(times);
    let given: Vec<f64> = differences.of_values(values).into_iter().map(|of| of / bound).collect();

    // Changes in units of the bound.
    let mut change = vec![0.0; values.len()];
    let mut weight = FIRST_WEIGHT;
    loop {
        minimise(&differences, &given, weight, &mut change);
        let roughness = differences.roughness(&given, &change);
        if weight >= MAX_WEIGHT || 2.0 * values.len() as f64 <= GAP * weight * roughness {
            break;
        }
        weight *= WEIGHT_FACTOR;
    }
    values.iter().zip(&change).map(|(value, change)| value + change * bound).collect()
}

/// Third differences of values at unequal times, in units of the mean step.
struct ThirdDifferences {
    /// Factors of four neighbours.
    factors: Vec<[f64; REACH + 1]>,
}

impl ThirdDifferences {
    fn of(times: &[f64]) -> Self {
        let step = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
        let of_four = |four: &[f64]| {
            std::array::from_fn(|j| {
                let others = (0..=REACH).filter(|m| *m != j);
                6.0 / others.map(|m| (four[j] - four[m]) / step).product::<f64>()
            })
        };
        Self { factors: times.windows(REACH + 1).map(of_four).collect() }
    }

    fn of_values(&self, values: &[f64]) -> Vec<f64> {
        let pairs = self.factors.iter().zip(values.windows(REACH + 1));
        pairs.map(|(factors, four)| factors.iter().zip(four).map(|(factor, value)| factor * value).sum()).collect()
    }

    /// Sum of squares after a change.
    fn roughness(&self, given: &[f64], change: &[f64]) -> f64 {
        self.of_values(change).iter().zip(given).map(|(by_change, given)| (given + by_change).powi(2)).sum()
    }

    /// Gradient of half of the sum of squares.
    fn gradient(&self, given: &[f64], change: &[f64]) -> Vec<f64> {
        let mut found = vec![0.0; change.len()];
        for (row, (factors, by_change)) in self.factors.iter().zip(self.of_values(change)).enumerate() {
            for (j, factor) in factors.iter().enumerate() {
                found[row + j] += factor * (given[row] + by_change);
            }
        }
        found
    }

    /// Lower bands of its second derivative: entry k of row i belongs to the columns i − k and i.
    fn bands(&self, weight: f64, count: usize) -> Vec<[f64; REACH + 1]> {
        let mut found = vec![[0.0; REACH + 1]; count];
        for (row, factors) in self.factors.iter().enumerate() {
            for i in 0..=REACH {
                for k in 0..=i {
                    found[row + i][k] += weight * factors[i] * factors[i - k];
                }
            }
        }
        found
    }
}

/// Newton's method for `w/2 Σ Δ³² − Σ ln(1 − z²)` from a change z inside its bounds.
fn minimise(differences: &ThirdDifferences, given: &[f64], weight: f64, change: &mut Vec<f64>) {
    let barrier = |z: &[f64]| -z.iter().map(|z| (1.0 - z * z).ln()).sum::<f64>();
    let objective = |z: &[f64]| 0.5 * weight * differences.roughness(given, z) + barrier(z);
    for _ in 0..MAX_STEPS {
        let own = |z: f64| 2.0 * z / (1.0 - z * z);
        let gradient: Vec<f64> = (differences.gradient(given, change).iter().zip(change.iter()))
            .map(|(of, z)| weight * of + own(*z))
            .collect();
        let mut bands = differences.bands(weight, change.len());
        for (band, z) in bands.iter_mut().zip(change.iter()) {
            band[0] += 2.0 * (1.0 + z * z) / (1.0 - z * z).powi(2);
        }
        let step = solve_bands(bands, &gradient);
        let decrement: f64 = step.iter().zip(&gradient).map(|(step, of)| step * of).sum();
        if 0.5 * decrement <= DONE {
            return;
        }

        let before = objective(change);
        let mut part = 1.0;
        let moved = (0..MAX_HALVINGS).find_map(|_| {
            let trial: Vec<f64> = change.iter().zip(&step).map(|(z, step)| z - part * step).collect();
            let is_inside = trial.iter().all(|z| z.abs() < 1.0);
            if is_inside && objective(&trial) <= before - 0.1 * part * decrement {
                return Some(trial);
            }
            part *= 0.5;
            None
        });
        let Some(moved) = moved else { return };
        *change = moved;
    }
}

/// Solution of a symmetric positive definite system of few bands, by Cholesky's factors without roots.
fn solve_bands(mut bands: Vec<[f64; REACH + 1]>, right: &[f64]) -> Vec<f64> {
    let count = right.len();
    for i in 0..count {
        for k in (1..=REACH.min(i)).rev() {
            // Entry of L times the pivot of its column.
            let column = i - k;
            let known = (k + 1..=REACH.min(i)).filter(|far| far - k <= REACH);
            let sum: f64 = known.map(|far| bands[i][far] * bands[i - far][0] * bands[column][far - k]).sum();
            bands[i][k] = (bands[i][k] - sum) / bands[column][0];
        }
        let squares: f64 = (1..=REACH.min(i)).map(|k| bands[i][k] * bands[i][k] * bands[i - k][0]).sum();
        bands[i][0] -= squares;
    }

    let mut found = right.to_vec();
    for i in 0..count {
        let sum: f64 = (1..=REACH.min(i)).map(|k| bands[i][k] * found[i - k]).sum();
        found[i] -= sum;
    }
    for i in (0..count).rev() {
        let after: f64 = (1..=REACH).filter(|k| i + k < count).map(|k| bands[i + k][k] * found[i + k]).sum();
        found[i] = found[i] / bands[i][0] - after;
    }
    found
}

//! Nonlinear least squares with bounds: Levenberg–Marquardt steps, the deviations of the result and its weak
//! directions.
//!
//! The crate `levenberg-marquardt` has no bounds and ends at a point without residuals. Here such a point, for example
//! a robot without equilibrium, is refused like one with a larger sum of squares, and a shorter step is tried.

use super::{DMat, DVec};

/// Minimum relative decrease of the sum of squares by a step. A smaller one, real or predicted, ends the search.
const MIN_DECREASE: f64 = 1e-10;

/// Minimum length of a step, relative to 1 plus the size of each unknown. A shorter one ends the search. It is half of
/// the digits of a number, because the sum of squares is flat at its minimum.
const MIN_STEP: f64 = 1e-8;

/// First damping of the steps, relative to the diagonal of JᵀJ.
const FIRST_DAMPING: f64 = 1e-3;

/// Maximum damping. A step with it is about 1e16 times shorter than one without damping, which is rounding.
const MAX_DAMPING: f64 = 1e16;

/// Minimum and maximum factor of the damping after a step that has decreased the sum of squares; the formula between
/// them is Nielsen's.
const MIN_DAMPING_FACTOR: f64 = 1.0 / 3.0;
const MAX_DAMPING_FACTOR: f64 = 2.0;

/// Factor of the damping after the first step in a row that has failed. It grows by itself with every further one.
const GROWTH: f64 = 2.0;

/// Minimum scale of an unknown that the damping acts on, relative to the maximum scale. So the damped matrix is regular
/// and an unknown that no residual depends on stays where it is.
const MIN_SCALE: f64 = 1e-12;

/// Least-squares problem.
pub trait LeastSquaresProblem {
    /// Residuals at a point near the last one that was linearised, with the choices (weights, assignments) of that one.
    /// `None` if there are no residuals.
    fn residuals(&mut self, x: &[f64]) -> Option<Vec<f64>>;

    /// Residuals and their derivatives at a point, one row per residual, with new choices.
    fn linearised(&mut self, x: &[f64]) -> Option<(Vec<f64>, DMat)>;

    /// True to stop the search.
    fn is_cancelled(&self) -> bool {
        false
    }
}

/// Reason why a search has ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LeastSquaresEnding {
    /// No step decreases the sum of squares by a relevant amount.
    Converged,
    /// The search has made the maximum number of iterations.
    Iterations,
    /// The problem has stopped the search.
    Cancelled,
}

/// Result of a search.
#[derive(Debug, Clone)]
pub struct Minimum {
    /// Unknowns.
    pub x: Vec<f64>,
    /// Residuals.
    pub residuals: Vec<f64>,
    /// Derivatives of the residuals.
    pub jacobian: DMat,
    /// Number of iterations.
    pub iterations: usize,
    /// Reason why the search has ended.
    pub ending: LeastSquaresEnding,
}

impl Minimum {
    /// Sum of the squares of the residuals, χ².
    pub fn chi2(&self) -> f64 {
        squares(&self.residuals)
    }
}

/// Minimises the sum of squares within bounds. The search begins at the point within the bounds that is nearest to the
/// start; `None` if there are no residuals.
///
/// # Example
/// ```
/// use funicular::math::{DMat, least_squares::{LeastSquaresProblem, minimise}};
///
/// /// Rosenbrock's valley, with its minimum at (1, 1).
/// struct Valley;
/// impl LeastSquaresProblem for Valley {
///     fn residuals(&mut self, x: &[f64]) -> Option<Vec<f64>> {
///         Some(vec![10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]])
///     }
///     fn linearised(&mut self, x: &[f64]) -> Option<(Vec<f64>, DMat)> {
///         Some((self.residuals(x)?, DMat::from_row_slice(2, 2, &[-20.0 * x[0], 10.0, -1.0, 0.0])))
///     }
/// }
/// let bounds = [(-5.0, 5.0), (-5.0, 5.0)];
/// let found = minimise(&mut Valley, &[-1.2, 1.0], &bounds, 100).unwrap();
/// assert!(found.x.iter().all(|x| (x - 1.0).abs() < 1e-8));
/// // The minimum for x₀ ≤ 0.5 is at (0.5, 0.25).
/// let found = minimise(&mut Valley, &[-1.2, 1.0], &[(-5.0, 0.5), (-5.0, 5.0)], 100).unwrap();
/// assert!(found.x[0] == 0.5 && (found.x[1] - 0.25).abs() < 1e-8);
/// ```
///
/// # References
/// K. Levenberg (1944), D. Marquardt (1963); J. J. Moré, The Levenberg–Marquardt algorithm (1978), for the scaling; H.
/// B. Nielsen, Damping parameter in Marquardt's method (1999), for the damping.
pub fn minimise<P: LeastSquaresProblem>(
    problem: &mut P,
    start: &[f64],
    bounds: &[(f64, f64)],
    max_iterations: usize,
) -> Option<Minimum> {
    let x: Vec<f64> = start.iter().zip(bounds).map(|(x, (low, high))| x.clamp(*low, *high)).collect();
    let (residuals, jacobian) = problem.linearised(&x)?;
    let scale = vec![0.0; x.len()];
    let mut search = DampedSearch { bounds, x, residuals, jacobian, scale, damping: FIRST_DAMPING };

    let (mut ending, mut iterations) = (LeastSquaresEnding::Iterations, 0);
    while iterations < max_iterations {
        iterations += 1;
        if let Some(end) = search.advance(problem) {
            ending = end;
            break;
        }
    }
    let DampedSearch { x, residuals, jacobian, .. } = search;
    Some(Minimum { x, residuals, jacobian, iterations, ending })
}

/// Search for a minimum, at its present point.
struct DampedSearch<'a> {
    bounds: &'a [(f64, f64)],
    x: Vec<f64>,
    residuals: Vec<f64>,
    jacobian: DMat,
    /// Scale of each unknown: the maximum so far of its diagonal entry of JᵀJ.
    scale: Vec<f64>,
    /// Damping relative to these scales.
    damping: f64,
}

impl DampedSearch<'_> {
    /// Moves on by one step that decreases the sum of squares; returns the reason for the end, if the search ends.
    fn advance(&mut self, problem: &mut impl LeastSquaresProblem) -> Option<LeastSquaresEnding> {
        let hessian = self.jacobian.transpose() * &self.jacobian;
        let gradient = self.jacobian.transpose() * DVec::from_column_slice(&self.residuals);
        // The scale never falls. So an unknown on which the residuals hardly depend for a while cannot run away.
        for (i, scale) in self.scale.iter_mut().enumerate() {
            *scale = scale.max(hessian[(i, i)]);
        }
        let largest = self.scale.iter().copied().fold(0.0, f64::max);
        let now = squares(&self.residuals);
        if largest == 0.0 {
            return Some(LeastSquaresEnding::Converged);
        }

        // Shorter and shorter steps until one decreases the sum.
        let mut growth = GROWTH;
        loop {
            if problem.is_cancelled() {
                return Some(LeastSquaresEnding::Cancelled);
            }
            let step = bounded_step(&self.damped(&hessian, largest), &gradient, &self.x, self.bounds);
            let predicted = predicted_decrease(&hessian, &gradient, &step);
            if self.is_short(&step) || predicted <= MIN_DECREASE * now {
                return Some(LeastSquaresEnding::Converged);
            }

            let next = self.moved(&step);
            let decrease = problem.residuals(&next).map_or(f64::NAN, |residuals| now - squares(&residuals));
            if decrease > 0.0
                && let Some(linearised) = problem.linearised(&next)
            {
                let ratio = decrease / predicted;
                self.damping *= (1.0 - (2.0 * ratio - 1.0).powi(3)).clamp(MIN_DAMPING_FACTOR, MAX_DAMPING_FACTOR);
                self.x = next;
                (self.residuals, self.jacobian) = linearised;
                return (decrease <= MIN_DECREASE * now).then_some(LeastSquaresEnding::Converged);
            }
            self.damping *= growth;
            growth *= GROWTH;
            if self.damping > MAX_DAMPING {
                return Some(LeastSquaresEnding::Converged);
            }
        }
    }

    /// Matrix JᵀJ with the damping on its diagonal.
    fn damped(&self, hessian: &DMat, largest: f64) -> DMat {
        let mut damped = hessian.clone();
        for (i, scale) in self.scale.iter().enumerate() {
            damped[(i, i)] += self.damping * scale.max(MIN_SCALE * largest);
        }
        damped
    }

    /// Point after a step, within the bounds.
    fn moved(&self, step: &[f64]) -> Vec<f64> {
        let moved = self.x.iter().zip(step).zip(self.bounds);
        moved.map(|((x, step), (low, high))| (x + step).clamp(*low, *high)).collect()
    }

    /// True if no unknown moves by more than its rounding.
    fn is_short(&self, step: &[f64]) -> bool {
        step.iter().zip(&self.x).all(|(step, x)| step.abs() <= MIN_STEP * (1.0 + x.abs()))
    }
}

fn squares(residuals: &[f64]) -> f64 {
    residuals.iter().map(|r| r * r).sum()
}

/// Decrease of the sum of squares by a step, for residuals that are linear.
fn predicted_decrease(hessian: &DMat, gradient: &DVec, step: &[f64]) -> f64 {
    let step = DVec::from_column_slice(step);
    -(2.0 * gradient.dot(&step) + step.dot(&(hessian * &step)))
}

/// Step that minimises the damped quadratic model within the bounds: unknowns that would leave them are held there one
/// after the other, and the others are solved again.
fn bounded_step(damped: &DMat, gradient: &DVec, x: &[f64], bounds: &[(f64, f64)]) -> Vec<f64> {
    let n = x.len();
    let mut step = vec![0.0; n];
    let mut is_held = vec![false; n];

    // An unknown at a bound stays there if the sum decreases outwards.
    for i in 0..n {
        let (low, high) = bounds[i];
        is_held[i] = x[i] <= low && gradient[i] > 0.0 || x[i] >= high && gradient[i] < 0.0;
    }

    for _ in 0..=n {
        // Solve for the free unknowns.
        let free: Vec<usize> = (0..n).filter(|i| !is_held[*i]).collect();
        if free.is_empty() {
            break;
        }
        let matrix = DMat::from_fn(free.len(), free.len(), |a, b| damped[(free[a], free[b])]);
        let right = DVec::from_fn(free.len(), |a, _| {
            let held: f64 = (0..n).filter(|j| is_held[*j]).map(|j| damped[(free[a], j)] * step[j]).sum();
            -gradient[free[a]] - held
        });
        let Some(factor) = matrix.cholesky() else { break };
        let solved = factor.solve(&right);

        // Hold those that leave their bounds.
        let mut left_bounds = false;
        for (a, &i) in free.iter().enumerate() {
            let (low, high) = bounds[i];
            step[i] = solved[a];
            if x[i] + step[i] < low || x[i] + step[i] > high {
                step[i] = (x[i] + step[i]).clamp(low, high) - x[i];
                is_held[i] = true;
                left_bounds = true;
            }
        }
        if !left_bounds {
            break;
        }
    }
    step
}

/// Precision of a minimum, from the derivatives of its residuals.
#[derive(Debug, Clone)]
pub struct Precision {
    /// Covariance (JᵀJ)⁻¹ of the unknowns along the directions that the residuals see.
    pub covariance: DMat,
    /// Singular values of the scaled derivatives, descending, with their unit directions in scaled unknowns.
    pub directions: Vec<(f64, Vec<f64>)>,
    /// For each unknown the length of its part in directions that no residual sees, from 0 to 1.
    pub unseen: Vec<f64>,
}

/// Singular value of a direction, relative to the maximum one, up to which the direction counts as unseen: derivatives
/// by differences have errors of 1e-7.
const UNSEEN: f64 = 1e-6;

/// Precision of unknowns with derivatives `jacobian`; each unknown is measured in units of `scales`.
///
/// # Example
/// ```
/// use funicular::math::{DMat, least_squares::precision};
///
/// // The sum of two unknowns is measured with the deviation 0.1, their difference never.
/// let found = precision(&DMat::from_row_slice(1, 2, &[10.0, 10.0]), &[1.0, 1.0]);
/// assert!((found.directions[0].0 - 200.0_f64.sqrt()).abs() < 1e-12 && found.directions[1].0 < 1e-12);
/// assert!((found.unseen[0] - 0.5_f64.sqrt()).abs() < 1e-12);
/// ```
pub fn precision(jacobian: &DMat, scales: &[f64]) -> Precision {
    let n = scales.len();
    // Zero rows make it at least square, so that all right singular vectors exist.
    let mut scaled = DMat::zeros(jacobian.nrows().max(n), n);
    for (i, scale) in scales.iter().enumerate() {
        for row in 0..jacobian.nrows() {
            scaled[(row, i)] = jacobian[(row, i)] * scale;
        }
    }
    let svd = scaled.svd(false, true);
    let right = svd.v_t.unwrap_or_else(|| DMat::identity(n, n));
    let mut directions: Vec<(f64, Vec<f64>)> =
        (0..n).map(|k| (svd.singular_values[k], (0..n).map(|i| right[(k, i)]).collect())).collect();
    directions.sort_by(|a, b| b.0.total_cmp(&a.0));

    let floor = UNSEEN * directions.first().map_or(0.0, |(value, _)| *value);
    let mut covariance = DMat::zeros(n, n);
    let mut unseen = vec![0.0_f64; n];
    for (value, direction) in &directions {
        for i in 0..n {
            if *value <= floor {
                unseen[i] += direction[i] * direction[i];
                continue;
            }
            for j in 0..n {
                covariance[(i, j)] += direction[i] * direction[j] * scales[i] * scales[j] / (value * value);
            }
        }
    }
    let unseen = unseen.into_iter().map(|part| part.sqrt().min(1.0)).collect();
    Precision { covariance, directions, unseen }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Exponential decay `a e^{−b t}` with a residual that does not exist for b < 0.
    struct MeasuredDecay {
        times: Vec<f64>,
        values: Vec<f64>,
    }

    impl LeastSquaresProblem for MeasuredDecay {
        fn residuals(&mut self, x: &[f64]) -> Option<Vec<f64>> {
            (x[1] >= 0.0)
                .then(|| self.times.iter().zip(&self.values).map(|(t, v)| x[0] * (-x[1] * t).exp() - v).collect())
        }

        fn linearised(&mut self, x: &[f64]) -> Option<(Vec<f64>, DMat)> {
            let jacobian = DMat::from_fn(self.times.len(), 2, |i, j| {
                let decay = (-x[1] * self.times[i]).exp();
                if j == 0 { decay } else { -x[0] * self.times[i] * decay }
            });
            Some((self.residuals(x)?, jacobian))
        }
    }

    #[test]
    fn a_point_without_residuals_is_no_end() {
        let mut refused = 0;
        let times: Vec<f64> = (0..20).map(|i| f64::from(i) * 0.2).collect();
        let values = times.iter().map(|t| 3.0 * (-0.05 * t).exp()).collect();
        let mut problem = MeasuredDecay { times, values };
        let unbounded = [(f64::NEG_INFINITY, f64::INFINITY); 2];
        // Undamped steps from many starts lead to b < 0.
        for start in [[3.0, 0.5], [2.0, 1.0], [5.0, 1.0], [3.0, 2.0]] {
            let (r, j) = problem.linearised(&start).unwrap();
            let step = (j.transpose() * &j).lu().solve(&(j.transpose() * DVec::from_vec(r))).unwrap();
            refused += usize::from(start[1] - step[1] < 0.0);
            let found = minimise(&mut problem, &start, &unbounded, 200).unwrap();
            assert_eq!(found.ending, LeastSquaresEnding::Converged);
            assert!((found.x[0] - 3.0).abs() < 1e-7 && (found.x[1] - 0.05).abs() < 1e-7, "{:?}", found.x);
        }
        assert!(refused > 0);
        // A bound says more than a refusal: the search slides along it.
        let found = minimise(&mut problem, &[0.1, 4.0], &[(0.0, 10.0), (0.0, 10.0)], 200).unwrap();
        assert!((found.x[0] - 3.0).abs() < 1e-7 && (found.x[1] - 0.05).abs() < 1e-7, "{:?}", found.x);
        assert!(minimise(&mut problem, &[0.1, -1.0], &unbounded, 200).is_none());
    }

    #[test]
    fn an_unknown_that_no_residual_sees_stays() {
        struct One;
        impl LeastSquaresProblem for One {
            fn residuals(&mut self, x: &[f64]) -> Option<Vec<f64>> {
                Some(vec![x[0] - 2.0])
            }
            fn linearised(&mut self, x: &[f64]) -> Option<(Vec<f64>, DMat)> {
                Some((vec![x[0] - 2.0], DMat::from_row_slice(1, 2, &[1.0, 0.0])))
            }
        }
        let found = minimise(&mut One, &[0.0, 7.0], &[(-10.0, 10.0), (-10.0, 10.0)], 50).unwrap();
        assert!((found.x[0] - 2.0).abs() < 1e-9 && (found.x[1] - 7.0).abs() <= 0.0);
        let found = precision(&found.jacobian, &[1.0, 1.0]);
        assert_eq!(found.unseen, [0.0, 1.0]);
    }

    /// The covariance of a line fit is that of the textbook.
    #[test]
    fn the_covariance_is_that_of_linear_regression() {
        let x: Vec<f64> = (0..10).map(f64::from).collect();
        let jacobian = DMat::from_fn(10, 2, |i, j| if j == 0 { 1.0 } else { x[i] });
        let found = precision(&jacobian, &[0.3, 70.0]);
        let (n, mean) = (10.0, 4.5);
        let spread: f64 = x.iter().map(|x| (x - mean) * (x - mean)).sum();
        assert!((found.covariance[(1, 1)] - 1.0 / spread).abs() < 1e-14);
        assert!((found.covariance[(0, 0)] - (1.0 / n + mean * mean / spread)).abs() < 1e-13);
        assert!((found.covariance[(0, 1)] + mean / spread).abs() < 1e-14);
    }
}

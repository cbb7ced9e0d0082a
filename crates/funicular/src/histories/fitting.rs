//! Fit of damped sinusoids to samples: nonlinear in the poles, with amplitudes and constants projected out.

use super::poles::{IdentifiedPole, PoleSet, Samples, frequency_and_damping};
use crate::math::least_squares::{LeastSquaresProblem, Minimum, minimise};
use crate::math::{Complex, DMat};
use std::f64::consts::{PI, TAU};

/// Maximum number of iterations of one fit; five to fifteen are usual.
const MAX_ITERATIONS: usize = 60;

/// Largest decay rate in units of the sampling rate: a pole beyond it has decayed within a sample.
const MAX_DECAY: f64 = 1.0;

/// Largest growth over the history: a pole that grows by more is no decay.
const MAX_GROWTH: f64 = 1.0;

/// Poles with decay rate α and frequency ω: `[α₁, ω₁, α₂, ω₂, …]` [rad/s].
pub(super) type SinusoidUnknowns = Vec<f64>;

/// Decay that is fitted.
pub(super) struct SinusoidFit<'a> {
    samples: &'a Samples,
    /// Times from the first sample on [s].
    time: Vec<f64>,
    /// Standard deviation of the noise of each channel.
    pub(super) noise: Vec<f64>,
}

/// Basis of the sinusoids at poles, and amplitudes.
struct Projected {
    /// Columns e^{−αt} cos ωt, e^{−αt} sin ωt per pole, and 1.
    basis: DMat,
    orthonormal: DMat,
    upper: DMat,
    /// Amplitudes, one column per channel.
    amplitudes: DMat,
    /// Values less their projections.
    rest: DMat,
}

impl<'a> SinusoidFit<'a> {
    pub(super) fn new(samples: &'a Samples, noise: Vec<f64>) -> Self {
        let first = samples.time()[0];
        Self { samples, time: samples.time().iter().map(|time| time - first).collect(), noise }
    }

    /// Bounds of the unknowns.
    fn bounds(&self, count: usize) -> Vec<(f64, f64)> {
        let step = self.samples.step();
        let decay = (-MAX_GROWTH / self.samples.duration(), MAX_DECAY / step);
        [decay, (0.1 / self.samples.duration(), PI / step)].repeat(count)
    }

    /// Minimum from a start, with a last step to the full digits.
    pub(super) fn fit(&mut self, start: &SinusoidUnknowns) -> Option<Minimum> {
        let bounds = self.bounds(start.len() / 2);
        let mut found = minimise(self, start, &bounds, MAX_ITERATIONS)?;
        let gradient = found.jacobian.transpose() * DMat::from_column_slice(found.residuals.len(), 1, &found.residuals);
        if let Some(factor) = (found.jacobian.transpose() * &found.jacobian).cholesky() {
            let step = factor.solve(&gradient);
            let x: SinusoidUnknowns = found.x.iter().zip(step.iter()).map(|(x, step)| x - step).collect();
            let is_within = x.iter().zip(&bounds).all(|(x, (low, high))| (low..=high).contains(&x));
            if is_within && let Some((residuals, jacobian)) = self.linearised(&x) {
                let squares: f64 = residuals.iter().map(|r| r * r).sum();
                if squares <= found.chi2() * (1.0 + 1e-12) {
                    (found.x, found.residuals, found.jacobian) = (x, residuals, jacobian);
                }
            }
        }
        Some(found)
    }

    /// Sum of the squares of the residuals of each channel, in units of its noise, with the best amplitudes.
    pub(super) fn squares(&self, x: &SinusoidUnknowns) -> Option<Vec<f64>> {
        let rest = self.projected(x)?.rest;
        Some((0..rest.ncols()).map(|c| (rest.column(c).norm() / self.noise[c]).powi(2)).collect())
    }

    /// Values less the fitted sinusoids.
    pub(super) fn rest(&self, x: &SinusoidUnknowns) -> Option<DMat> {
        Some(self.projected(x)?.rest)
    }

    /// Poles with the most energy |a|²/2α among candidates, at most `count`.
    pub(super) fn strongest(&self, candidates: &SinusoidUnknowns, count: usize) -> Option<SinusoidUnknowns> {
        let projected = self.projected(candidates)?;
        let mut energies: Vec<(f64, usize)> = (0..candidates.len() / 2)
            .map(|k| {
                let size = |row: usize, c: usize| (projected.amplitudes[(row, c)] / self.noise[c]).powi(2);
                let sum: f64 = (0..self.noise.len()).map(|c| size(2 * k, c) + size(2 * k + 1, c)).sum();
                (sum / candidates[2 * k].max(0.5 / self.samples.duration()), k)
            })
            .collect();
        energies.sort_by(|a, b| b.0.total_cmp(&a.0));
        Some(energies.iter().take(count).flat_map(|(_, k)| [candidates[2 * k], candidates[2 * k + 1]]).collect())
    }

    fn projected(&self, x: &[f64]) -> Option<Projected> {
        let columns = x.len() + 1;
        let mut basis = DMat::from_element(self.time.len(), columns, 1.0);
        for (k, pole) in x.chunks_exact(2).enumerate() {
            for (row, time) in self.time.iter().enumerate() {
                let (sin, cos) = (pole[1] * time).sin_cos();
                let size = (-pole[0] * time).exp();
                basis[(row, 2 * k)] = size * cos;
                basis[(row, 2 * k + 1)] = size * sin;
            }
        }
        let factors = basis.clone().qr();
        let (orthonormal, upper) = (factors.q(), factors.r());
        let along = orthonormal.transpose() * self.samples.values();
        let amplitudes = upper.solve_upper_triangular(&along)?;
        if !amplitudes.iter().all(|entry| entry.is_finite()) {
            return None;
        }
        let rest = self.samples.values() - &orthonormal * along;
        Some(Projected { basis, orthonormal, upper, amplitudes, rest })
    }

    /// Derivatives of the sinusoids of a channel by decay rate and frequency of each pole, one column each.
    fn sinusoid_derivatives(&self, projected: &Projected, channel: usize) -> DMat {
        let poles = (projected.basis.ncols() - 1) / 2;
        let mut columns = DMat::zeros(self.time.len(), 2 * poles);
        for k in 0..poles {
            let [a, b] = [2 * k, 2 * k + 1].map(|row| projected.amplitudes[(row, channel)]);
            for (row, time) in self.time.iter().enumerate() {
                let [cos, sin] = [2 * k, 2 * k + 1].map(|column| projected.basis[(row, column)]);
                columns[(row, 2 * k)] = -time * (a * cos + b * sin);
                columns[(row, 2 * k + 1)] = time * (b * cos - a * sin);
            }
        }
        columns
    }

    /// Poles at a minimum with covariance and shapes, ascending.
    pub(super) fn pole_set(&self, found: &Minimum, factor: f64, degrees: f64) -> Option<PoleSet> {
        let covariance = (found.jacobian.transpose() * &found.jacobian).cholesky()?.inverse() * factor;
        let projected = self.projected(&found.x)?;
        let inverse = projected.upper.clone().try_inverse()?;
        let of_amplitudes = &inverse * inverse.transpose() * factor;
        // Changes of the amplitudes of each channel with the unknowns.
        let changes: Vec<DMat> = (0..self.noise.len())
            .map(|c| -&inverse * (projected.orthonormal.transpose() * self.sinusoid_derivatives(&projected, c)))
            .collect();

        let count = found.x.len() / 2;
        let mut poles = Vec::with_capacity(count);
        let mut turn = DMat::zeros(2 * count, 2 * count);
        for k in 0..count {
            let [alpha, omega] = [found.x[2 * k], found.x[2 * k + 1]];
            let size = alpha.hypot(omega);
            let [frequency_hz, damping_ratio] = frequency_and_damping(Complex::new(-alpha, omega));
            turn[(2 * k, 2 * k)] = alpha / (size * TAU);
            turn[(2 * k, 2 * k + 1)] = omega / (size * TAU);
            turn[(2 * k + 1, 2 * k)] = omega * omega / size.powi(3);
            turn[(2 * k + 1, 2 * k + 1)] = -alpha * omega / size.powi(3);
            let (shape, shape_std) = self.shape(k, &projected, &changes, &covariance, &of_amplitudes);
            poles.push(IdentifiedPole {
                frequency_hz,
                damping_ratio,
                frequency_std_hz: 0.0,
                damping_std: 0.0,
                shape,
                shape_std,
            });
        }
        let covariance = &turn * covariance * turn.transpose();
        for (k, pole) in poles.iter_mut().enumerate() {
            pole.frequency_std_hz = covariance[(2 * k, 2 * k)].sqrt();
            pole.damping_std = covariance[(2 * k + 1, 2 * k + 1)].sqrt();
        }
        let set = PoleSet { poles, covariance, degrees };
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|a, b| set.poles[*a].frequency_hz.total_cmp(&set.poles[*b].frequency_hz));
        Some(set.chosen(&order))
    }

    /// Shape of a pole, 1 in the channel that sees it best, and its standard deviations.
    fn shape(
        &self,
        k: usize,
        projected: &Projected,
        changes: &[DMat],
        covariance: &DMat,
        of_amplitudes: &DMat,
    ) -> (Vec<Complex>, Vec<f64>) {
        let channels = self.noise.len();
        // Re(a e^{iωt}) = A cos ωt + B sin ωt with a = A − iB.
        let amplitude =
            |c: usize| Complex::new(projected.amplitudes[(2 * k, c)], -projected.amplitudes[(2 * k + 1, c)]);
        let change = |c: usize, j: usize| Complex::new(changes[c][(2 * k, j)], -changes[c][(2 * k + 1, j)]);
        let seen = |c: &usize| amplitude(*c).norm() / self.noise[*c];
        let best = (0..channels).max_by(|a, b| seen(a).total_cmp(&seen(b))).unwrap_or_default();
        let own = of_amplitudes[(2 * k, 2 * k)] + of_amplitudes[(2 * k + 1, 2 * k + 1)];

        let (mut shape, mut deviations) = (Vec::with_capacity(channels), Vec::with_capacity(channels));
        for c in 0..channels {
            let value = amplitude(c) / amplitude(best);
            shape.push(value);
            if c == best {
                deviations.push(0.0);
                continue;
            }
            let by_poles: Vec<Complex> =
                (0..covariance.nrows()).map(|j| (change(c, j) - value * change(best, j)) / amplitude(best)).collect();
            let mut variance = own * (self.noise[c].powi(2) + value.norm_sqr() * self.noise[best].powi(2))
                / amplitude(best).norm_sqr();
            for (i, a) in by_poles.iter().enumerate() {
                for (j, b) in by_poles.iter().enumerate() {
                    variance += covariance[(i, j)] * (a.conj() * b).re;
                }
            }
            deviations.push(variance.max(0.0).sqrt());
        }
        (shape, deviations)
    }
}

impl LeastSquaresProblem for SinusoidFit<'_> {
    fn residuals(&mut self, x: &[f64]) -> Option<Vec<f64>> {
        let rest = self.projected(x)?.rest;
        let count = rest.nrows();
        Some(rest.iter().enumerate().map(|(at, rest)| rest / self.noise[at / count]).collect())
    }

    /// Derivatives with the amplitudes projected out; the part that is of second order in the residuals is left out
    /// (Kaufman), so that JᵀJ is the Schur complement of all unknowns.
    fn linearised(&mut self, x: &[f64]) -> Option<(Vec<f64>, DMat)> {
        let projected = self.projected(x)?;
        let count = self.time.len();
        let mut residuals = Vec::with_capacity(count * self.noise.len());
        let mut jacobian = DMat::zeros(count * self.noise.len(), x.len());
        for (c, noise) in self.noise.iter().enumerate() {
            residuals.extend(projected.rest.column(c).iter().map(|rest| rest / noise));
            let columns = self.sinusoid_derivatives(&projected, c);
            let along = projected.orthonormal.transpose() * &columns;
            let part = (&projected.orthonormal * along - columns) / *noise;
            jacobian.view_mut((c * count, 0), (count, x.len())).copy_from(&part);
        }
        jacobian.iter().all(|entry| entry.is_finite()).then_some((residuals, jacobian))
    }
}

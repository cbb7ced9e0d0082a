//! Poles of a subspace by its shift invariance, and the subspace of a free decay (ERA).

use super::poles::Samples;
use crate::math::{Complex, DMat};

/// Maximum number of rows of a Hankel matrix; its eigenvectors take a time that grows with the cube.
const MAX_ROWS: usize = 240;

/// Number of blocks of rows of a Hankel matrix where they are not more than [`MAX_ROWS`].
const BLOCK_ROWS: usize = 40;

/// Minimum number of blocks of rows.
const MIN_BLOCK_ROWS: usize = 12;

/// Pole with its shape in arbitrary scale.
#[derive(Debug, Clone)]
pub(super) struct RawPole {
    /// Eigenvalue [rad/s].
    pub(super) eigenvalue: Complex,
    pub(super) shape: Vec<Complex>,
}

/// Poles of a system whose observability matrix has these columns: `rows` blocks of `channels` rows, a step [s] apart.
/// Poles come in pairs, of which the one with positive frequency is returned, ascending.
pub(super) fn poles_of(observability: &DMat, channels: usize, step: f64) -> Vec<RawPole> {
    let (rows, order) = observability.shape();
    let upper = observability.rows(0, rows - channels);
    let lower = observability.rows(channels, rows - channels);
    let Some(inverse) = (upper.transpose() * upper).cholesky() else { return Vec::new() };
    let shift = inverse.solve(&(upper.transpose() * lower));
    if !shift.iter().all(|entry| entry.is_finite()) {
        return Vec::new();
    }

    let first = observability.rows(0, channels);
    let mut poles = Vec::new();
    for value in shift.complex_eigenvalues().iter() {
        let eigenvalue = value.ln() / step;
        if !(eigenvalue.im > 0.0 && eigenvalue.is_finite()) {
            continue;
        }
        let Some(vector) = eigenvector(&shift, *value) else { continue };
        let entry = |c: usize| (0..order).map(|k| first[(c, k)] * vector[k]).sum::<Complex>();
        poles.push(RawPole { eigenvalue, shape: (0..channels).map(entry).collect() });
    }
    poles.sort_by(|a, b| a.eigenvalue.norm().total_cmp(&b.eigenvalue.norm()));
    poles
}

/// Eigenvector by inverse iteration, normalised.
fn eigenvector(matrix: &DMat, value: Complex) -> Option<Vec<Complex>> {
    let size = matrix.nrows();
    // A shift beside the eigenvalue keeps the matrix regular.
    let beside = value * (1.0 + 1e-10) + Complex::new(1e-12, 1e-12);
    let shifted = crate::math::CDMat::from_fn(size, size, |a, b| {
        Complex::from(matrix[(a, b)]) - if a == b { beside } else { Complex::default() }
    });
    let factors = shifted.lu();
    let mut vector = crate::math::CDMat::from_fn(size, 1, |k, _| Complex::new(1.0, 0.1 * k as f64));
    for _ in 0..3 {
        vector = factors.solve(&vector)?;
        let norm = vector.norm();
        if !(norm > 0.0 && norm.is_finite()) {
            return None;
        }
        vector /= Complex::from(norm);
    }
    Some(vector.iter().copied().collect())
}

/// Subspace of a free decay: eigenvectors of the product of its Hankel matrix with the transposed one.
pub(super) struct DecaySubspace {
    /// Eigenvectors, those of the largest eigenvalues first.
    vectors: DMat,
    channels: usize,
    step: f64,
}

impl DecaySubspace {
    /// Subspace of samples, of which `stride` are averaged to one; `None` if they are too few. Samples at uneven times
    /// are interpolated.
    pub(super) fn of(samples: &Samples, stride: usize) -> Option<Self> {
        let channels = samples.channels();
        let even = evenly(samples);
        let count = even.nrows() / stride;
        let blocks = BLOCK_ROWS.min(MAX_ROWS / channels).max(MIN_BLOCK_ROWS.min(MAX_ROWS / channels)).min(count / 3);
        if blocks < 4 {
            return None;
        }
        let mean = |row: usize, c: usize| even.view((row * stride, c), (stride, 1)).sum() / stride as f64;
        let mut values = DMat::from_fn(count, channels, mean);
        for mut column in values.column_iter_mut() {
            let (mean, spread) = (column.mean(), column.variance().sqrt());
            column.iter_mut().for_each(|value| *value = (*value - mean) / spread.max(f64::MIN_POSITIVE));
        }

        let columns = count - blocks + 1;
        let hankel = DMat::from_fn(blocks * channels, columns, |row, k| values[(row / channels + k, row % channels)]);
        let product = &hankel * hankel.transpose();
        if !product.iter().all(|entry| entry.is_finite()) {
            return None;
        }
        let found = product.symmetric_eigen();
        let mut order: Vec<usize> = (0..blocks * channels).collect();
        order.sort_by(|a, b| found.eigenvalues[*b].total_cmp(&found.eigenvalues[*a]));
        let vectors = DMat::from_fn(blocks * channels, order.len(), |row, k| found.eigenvectors[(row, order[k])]);
        Some(Self { vectors, channels, step: samples.step() * stride as f64 })
    }

    /// Poles of a system of this order.
    pub(super) fn poles(&self, order: usize) -> Vec<RawPole> {
        let order = order.min(self.vectors.nrows() - self.channels);
        poles_of(&self.vectors.columns(0, order).into(), self.channels, self.step)
    }
}

/// Values at even times, straight between the samples.
fn evenly(samples: &Samples) -> DMat {
    let (time, values, step) = (samples.time(), samples.values(), samples.step());
    let mut even = values.clone();
    let mut before = 0;
    for row in 1..time.len() - 1 {
        let at = time[0] + row as f64 * step;
        while before + 2 < time.len() && time[before + 1] <= at {
            before += 1;
        }
        let part = (at - time[before]) / (time[before + 1] - time[before]);
        for c in 0..values.ncols() {
            even[(row, c)] = values[(before, c)] + part * (values[(before + 1, c)] - values[(before, c)]);
        }
    }
    even
}

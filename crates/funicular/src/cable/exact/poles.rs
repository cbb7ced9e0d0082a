//! End stiffness by poles and residues.

use crate::math::simd::LANES;
use crate::math::{Complex, DMat};
use std::ops::Range;

/// A symmetric end stiffness by poles and residues; N end components.
#[derive(Debug, Clone, PartialEq)]
pub struct PoleResidue<const N: usize> {
    /// K_s, symmetric [N/m].
    pub stiffness: [[f64; N]; N],
    /// M_s, symmetric [kg].
    pub mass: [[f64; N]; N],
    /// ω_k² of the clamped modes, ascending [rad²/s²].
    pub poles: Vec<f64>,
    /// g_k [√kg].
    pub participation: Vec<[f64; N]>,
}

impl<const N: usize> PoleResidue<N> {
    /// Entries (i, j) of the undamped stiffness at x = ω² [N/m].
    pub fn undamped<const E: usize>(&self, entries: [(usize, usize); E], x: f64) -> [f64; E] {
        let mut sums = [0.0; E];
        for (pole, g) in self.poles.iter().zip(&self.participation) {
            let factor = 1.0 / (pole - x);
            for (sum, (i, j)) in sums.iter_mut().zip(entries) {
                *sum += g[i] * g[j] * factor;
            }
        }
        std::array::from_fn(|e| {
            let (i, j) = entries[e];
            self.stiffness[i][j] - x * (self.mass[i][j] + x * sums[e])
        })
    }

    /// Entries (i, j) of the stiffness at the complex x = ω_c² [N/m].
    pub fn damped<const E: usize>(&self, entries: [(usize, usize); E], x: Complex) -> [Complex; E] {
        let mut sums = [Complex::new(0.0, 0.0); E];
        for (pole, g) in self.poles.iter().zip(&self.participation) {
            let factor = 1.0 / (*pole - x);
            for (sum, (i, j)) in sums.iter_mut().zip(entries) {
                *sum += factor * (g[i] * g[j]);
            }
        }
        std::array::from_fn(|e| {
            let (i, j) = entries[e];
            self.stiffness[i][j] - x * (self.mass[i][j] + x * sums[e])
        })
    }

    /// Entries (i, j) of minus the derivative of the undamped stiffness by ω² [kg]:
    /// `M_s + Σ g gᵀ (2 x ω_k² − x²)/(ω_k² − x)²` at x = ω², without the poles `left_out`.
    pub fn moving_mass<const E: usize>(
        &self,
        entries: [(usize, usize); E],
        x: f64,
        left_out: Range<usize>,
    ) -> [f64; E] {
        let mut sums = entries.map(|(i, j)| self.mass[i][j]);
        let kept = |k: &usize| !left_out.contains(k);
        for k in (0..self.poles.len()).filter(kept) {
            let (pole, g) = (self.poles[k], &self.participation[k]);
            let gap = pole - x;
            let factor = x * (2.0 * pole - x) / (gap * gap);
            for (sum, (i, j)) in sums.iter_mut().zip(entries) {
                *sum += g[i] * g[j] * factor;
            }
        }
        sums
    }

    /// Entries (i, j) of the stiffness at the complex x = ω_c² [N/m] and of minus its derivative by x [kg], without the
    /// poles `left_out`.
    pub(crate) fn with_derivative<const E: usize>(
        &self,
        entries: [(usize, usize); E],
        x: Complex,
        left_out: Range<usize>,
    ) -> ([Complex; E], [Complex; E]) {
        let mut sums = [Complex::new(0.0, 0.0); E];
        let mut masses = entries.map(|(i, j)| Complex::from(self.mass[i][j]));
        let kept = |k: &usize| !left_out.contains(k);
        for k in (0..self.poles.len()).filter(kept) {
            let (pole, g) = (self.poles[k], &self.participation[k]);
            let factor = (pole - x).inv();
            let by_square = factor * factor * x * (2.0 * pole - x);
            for (e, (i, j)) in entries.into_iter().enumerate() {
                sums[e] += factor * (g[i] * g[j]);
                masses[e] += by_square * (g[i] * g[j]);
            }
        }
        let stiffness = std::array::from_fn(|e| {
            let (i, j) = entries[e];
            self.stiffness[i][j] - x * (self.mass[i][j] + x * sums[e])
        });
        (stiffness, masses)
    }

    /// The first `count` poles, and a few in place of all the others: what these answer to slow motion of the first
    /// `moving` end components. With those modes' own shapes W = P⁻¹ G as the only motion left to them (Rayleigh and Ritz),
    /// `Gᵀ (P − x)⁻¹ G` keeps its value and its slope at x = 0. The second result is the part of each mode beyond `count`
    /// in each of the new ones, by columns of unit modal mass.
    pub(crate) fn compressed(&self, count: usize, moving: usize) -> (Self, DMat) {
        let beyond = self.poles.len() - count;
        let g = DMat::from_fn(beyond, N, |k, i| self.participation[count + k][i]);
        let pole = |k: usize| self.poles[count + k];
        let mut kept = self.clone();
        kept.poles.truncate(count);
        kept.participation.truncate(count);
        let mut columns = DMat::from_fn(beyond, moving, |k, i| g[(k, i)] / pole(k));
        for mut column in columns.column_iter_mut() {
            let size = column.norm();
            if size > 0.0 {
                column /= size;
            }
        }
        // Motions that hardly differ from the others are none of their own.
        let gram = (columns.transpose() * &columns).symmetric_eigen();
        let free: Vec<usize> = (0..moving).filter(|&i| gram.eigenvalues[i] > 1e-9).collect();
        if free.is_empty() {
            return (kept, DMat::zeros(beyond, 0));
        }
        let basis = DMat::from_columns(
            &free
                .iter()
                .map(|&i| &columns * gram.eigenvectors.column(i) / gram.eigenvalues[i].sqrt())
                .collect::<Vec<_>>(),
        );
        let stiffness = basis.transpose() * DMat::from_fn(beyond, free.len(), |k, i| pole(k) * basis[(k, i)]);
        let ritz = stiffness.symmetric_eigen();
        let mut order: Vec<usize> = (0..free.len()).collect();
        order.sort_by(|&i, &j| ritz.eigenvalues[i].total_cmp(&ritz.eigenvalues[j]));
        let turn = DMat::from_columns(&order.iter().map(|&i| ritz.eigenvectors.column(i)).collect::<Vec<_>>());
        let parts = basis * turn;
        let participation = parts.transpose() * g;
        for (k, &i) in order.iter().enumerate() {
            kept.poles.push(ritz.eigenvalues[i]);
            kept.participation.push(std::array::from_fn(|n| participation[(k, n)]));
        }
        (kept, parts)
    }

    /// Number of poles below ω² = x.
    pub fn poles_below(&self, x: f64) -> usize {
        self.poles.partition_point(|pole| *pole < x)
    }
}

/// Entries of the platform end's stiffness, poles and residues each in a row, for sums in vector registers.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct EndSeries<const E: usize> {
    pub(crate) poles: Vec<f64>,
    pub(crate) residues: [Vec<f64>; E],
    pub(crate) stiffness: [f64; E],
    pub(crate) mass: [f64; E],
}

impl<const E: usize> EndSeries<E> {
    pub(super) fn of<const N: usize>(all: &PoleResidue<N>, entries: [(usize, usize); E]) -> Self {
        Self {
            poles: all.poles.clone(),
            residues: entries.map(|(i, j)| all.participation.iter().map(|g| g[i] * g[j]).collect()),
            stiffness: entries.map(|(i, j)| all.stiffness[i][j]),
            mass: entries.map(|(i, j)| all.mass[i][j]),
        }
    }

    /// Places of the poles nearer to x than the part `width`.
    pub(super) fn near(&self, x: f64, width: f64) -> Range<usize> {
        let from = self.poles.partition_point(|pole| *pole < x * (1.0 - width));
        let count = self.poles[from..].iter().take_while(|pole| **pole < x * (1.0 + width)).count();
        from..from + count
    }

    /// Undamped entries at x = ω², without the poles `left_out`.
    pub(super) fn undamped(&self, x: f64, left_out: Range<usize>) -> [f64; E] {
        let mut sums = [0.0; E];
        for range in [0..left_out.start, left_out.end..self.poles.len()] {
            let poles = &self.poles[range.clone()];
            let residues: [&[f64]; E] = std::array::from_fn(|e| &self.residues[e][range.clone()]);
            let whole = poles.len() / LANES * LANES;
            let mut lanes = [[0.0; LANES]; E];
            for (k, block) in poles.chunks_exact(LANES).enumerate() {
                let factors: [f64; LANES] = std::array::from_fn(|i| 1.0 / (block[i] - x));
                for (lanes, residues) in lanes.iter_mut().zip(residues) {
                    let block = &residues[k * LANES..(k + 1) * LANES];
                    for i in 0..LANES {
                        lanes[i] += block[i] * factors[i];
                    }
                }
            }
            for ((sum, lanes), residues) in sums.iter_mut().zip(&lanes).zip(residues) {
                *sum += lanes.iter().sum::<f64>();
                for (pole, residue) in poles[whole..].iter().zip(&residues[whole..]) {
                    *sum += residue / (pole - x);
                }
            }
        }
        std::array::from_fn(|e| self.stiffness[e] - x * (self.mass[e] + x * sums[e]))
    }
}

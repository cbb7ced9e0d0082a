//! End stiffness by poles and residues.

use crate::math::simd::LANES;
use crate::math::{Complex, DMat, order};
use std::array::from_fn;
use std::ops::Range;

/// Symmetric end stiffness by poles and residues. It has N components of both ends, those of the start before those of
/// the end. The stiffness of the start with the end held has E independent entries.
#[derive(Debug, Clone, PartialEq)]
pub struct PoleResidue<const N: usize, const E: usize> {
    /// Static stiffness K_s, symmetric [N/m].
    pub stiffness: [[f64; N]; N],
    /// Mass M_s, symmetric [kg].
    pub mass: [[f64; N]; N],
    /// Poles ω_k² of the clamped modes, ascending [rad²/s²].
    pub poles: Vec<f64>,
    /// Participations g_k of the ends in the clamped modes [√kg].
    pub participation: Vec<[f64; N]>,
    /// Entries of `g_k g_kᵀ` at the start, one row per entry, for sums in vector registers [kg].
    residues: [Vec<f64>; E],
}

/// Entries of the start's block of a symmetric matrix: out of plane only the first exists, in plane the first three,
/// with both families together all six.
const ENTRIES: [(usize, usize); 6] = [(0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2)];

/// Entries of the start's block of a symmetric matrix over both ends.
#[inline(always)]
pub(super) fn at_start<const N: usize, const E: usize>(matrix: &[[f64; N]; N]) -> [f64; E] {
    from_fn(|e| {
        let (i, j) = ENTRIES[e];
        matrix[i][j]
    })
}

/// Row and column of each entry of the start's block.
pub(super) fn entry_indices<const E: usize>() -> [(usize, usize); E] {
    from_fn(|e| ENTRIES[e])
}

/// 1/(pole − x) with one division, at a tenth of the time of the division of complex numbers.
#[inline(always)]
fn reciprocal_gap(pole: f64, x: Complex) -> Complex {
    let gap = pole - x.re;
    let scale = 1.0 / (gap * gap + x.im * x.im);
    Complex::new(gap * scale, x.im * scale)
}

impl<const N: usize, const E: usize> PoleResidue<N, E> {
    /// Stiffness zero, without poles.
    pub(super) fn none() -> Self {
        Self::new([[0.0; N]; N], [[0.0; N]; N], Vec::new(), Vec::new())
    }

    /// Stiffness from K_s [N/m], M_s [kg], the ascending ω_k² [rad²/s²], and g_k [√kg].
    pub fn new(stiffness: [[f64; N]; N], mass: [[f64; N]; N], poles: Vec<f64>, participation: Vec<[f64; N]>) -> Self {
        let residues = from_fn(|e| {
            let (i, j) = ENTRIES[e];
            participation.iter().map(|g| g[i] * g[j]).collect()
        });
        Self { stiffness, mass, poles, participation, residues }
    }

    /// Entries of K_s at the start [N/m].
    #[inline(always)]
    pub(crate) fn start_stiffness(&self) -> [f64; E] {
        at_start(&self.stiffness)
    }

    /// Entries of M_s at the start [kg].
    #[inline(always)]
    pub(crate) fn start_mass(&self) -> [f64; E] {
        at_start(&self.mass)
    }

    /// Entries of `g_k g_kᵀ` at the start [kg], for each entry one number per pole.
    #[inline(always)]
    pub(crate) fn residues(&self) -> &[Vec<f64>; E] {
        &self.residues
    }

    /// Entries of the undamped stiffness at x = ω² [N/m], without the poles `left_out`.
    pub fn undamped(&self, x: f64, left_out: Range<usize>) -> [f64; E] {
        let mut sums = [0.0; E];
        for range in [0..left_out.start, left_out.end..self.poles.len()] {
            let poles = &self.poles[range.clone()];
            let residues: [&[f64]; E] = from_fn(|e| &self.residues[e][range.clone()]);

            // Full lanes of poles, side by side.
            let whole = poles.len() / LANES * LANES;
            let mut lanes = [[0.0; LANES]; E];
            for (k, block) in poles.chunks_exact(LANES).enumerate() {
                let factors: [f64; LANES] = from_fn(|i| 1.0 / (block[i] - x));
                for (lanes, residues) in lanes.iter_mut().zip(residues) {
                    let block = &residues[k * LANES..(k + 1) * LANES];
                    for i in 0..LANES {
                        lanes[i] += block[i] * factors[i];
                    }
                }
            }

            // Sum of the lanes, and the remaining poles one by one.
            for ((sum, lanes), residues) in sums.iter_mut().zip(&lanes).zip(residues) {
                *sum += lanes.iter().sum::<f64>();
                for (pole, residue) in poles[whole..].iter().zip(&residues[whole..]) {
                    *sum += residue / (pole - x);
                }
            }
        }

        let (stiffness, mass): ([f64; E], [f64; E]) = (self.start_stiffness(), self.start_mass());
        from_fn(|e| stiffness[e] - x * (mass[e] + x * sums[e]))
    }

    /// Entries of the stiffness at the complex x = ω_c² [N/m].
    pub fn damped(&self, x: Complex) -> [Complex; E] {
        self.damped_without(x, 0..0)
    }

    /// Entries of the stiffness at the complex x = ω_c² [N/m], without the poles `left_out`.
    pub(crate) fn damped_without(&self, x: Complex, left_out: Range<usize>) -> [Complex; E] {
        let mut sums = [Complex::new(0.0, 0.0); E];
        for range in [0..left_out.start, left_out.end..self.poles.len()] {
            let poles = &self.poles[range.clone()];
            let residues: [&[f64]; E] = from_fn(|e| &self.residues[e][range.clone()]);

            // Full lanes of poles, side by side: real and imaginary parts.
            let whole = poles.len() / LANES * LANES;
            let mut lanes = [[[0.0; LANES]; 2]; E];
            for (k, block) in poles.chunks_exact(LANES).enumerate() {
                let gaps: [f64; LANES] = from_fn(|i| block[i] - x.re);
                let scales: [f64; LANES] = from_fn(|i| 1.0 / (gaps[i] * gaps[i] + x.im * x.im));
                for ([real, imaginary], residues) in lanes.iter_mut().zip(residues) {
                    let block = &residues[k * LANES..(k + 1) * LANES];
                    for i in 0..LANES {
                        let scaled = block[i] * scales[i];
                        real[i] += scaled * gaps[i];
                        imaginary[i] += scaled;
                    }
                }
            }

            // Sum of the lanes, and the remaining poles one by one.
            for ((sum, [real, imaginary]), residues) in sums.iter_mut().zip(&lanes).zip(residues) {
                *sum += Complex::new(real.iter().sum(), imaginary.iter().sum::<f64>() * x.im);
                for (pole, residue) in poles[whole..].iter().zip(&residues[whole..]) {
                    *sum += reciprocal_gap(*pole, x) * *residue;
                }
            }
        }

        let (stiffness, mass): ([f64; E], [f64; E]) = (self.start_stiffness(), self.start_mass());
        from_fn(|e| stiffness[e] - x * (mass[e] + x * sums[e]))
    }

    /// Entry (i, j) over both ends of the stiffness at the complex x = ω_c² [N/m].
    pub fn entry(&self, i: usize, j: usize, x: Complex) -> Complex {
        let poles = self.poles.iter().zip(&self.participation);
        let sum: Complex = poles.map(|(pole, g)| g[i] * g[j] / (*pole - x)).sum();
        self.stiffness[i][j] - x * (self.mass[i][j] + x * sum)
    }

    /// Entries of minus the derivative of the undamped stiffness by ω² [kg], without the poles `left_out`:
    /// `M_s + Σ g gᵀ (2 x ω_k² − x²)/(ω_k² − x)²` at x = ω².
    pub fn effective_mass(&self, x: f64, left_out: Range<usize>) -> [f64; E] {
        let mut sums = self.start_mass();
        for k in (0..self.poles.len()).filter(|k| !left_out.contains(k)) {
            let pole = self.poles[k];
            let gap = pole - x;
            let factor = x * (2.0 * pole - x) / (gap * gap);
            for (sum, residues) in sums.iter_mut().zip(&self.residues) {
                *sum += residues[k] * factor;
            }
        }
        sums
    }

    /// Entries of minus the derivative of the stiffness by x at the complex x = ω_c² [kg], without the poles
    /// `left_out`.
    pub(crate) fn damped_mass_without(&self, x: Complex, left_out: Range<usize>) -> [Complex; E] {
        let mut masses = self.start_mass().map(Complex::from);
        for k in (0..left_out.start).chain(left_out.end..self.poles.len()) {
            let factor = reciprocal_gap(self.poles[k], x);
            let by_square = factor * factor * x * (2.0 * self.poles[k] - x);
            for (mass, residues) in masses.iter_mut().zip(&self.residues) {
                *mass += by_square * residues[k];
            }
        }
        masses
    }

    /// Keeps the first `count` poles and replaces all others by a few.
    ///
    /// The modes beyond `count` may move only in the shapes W = P⁻¹ G of their response to slow motion of the first
    /// `moving` end components, and to slow `forces` on the modes (Rayleigh and Ritz). So `Gᵀ (P − x)⁻¹ G` keeps its
    /// value and its slope at x = 0, and the forces have their static response. The second result has the weights of
    /// the modes beyond `count` in each new mode, by columns of unit modal mass.
    pub(crate) fn compressed(&self, count: usize, moving: usize, forces: &[Vec<f64>]) -> (Self, DMat) {
        let beyond = self.poles.len() - count;
        let g = DMat::from_fn(beyond, N, |k, i| self.participation[count + k][i]);
        let pole = |k: usize| self.poles[count + k];
        let mut poles = self.poles[..count].to_vec();
        let mut kept = self.participation[..count].to_vec();

        // W: response of each mode to slow motion, normalised by columns.
        let shapes = moving + forces.len();
        let weight = |k: usize, i: usize| if i < moving { g[(k, i)] } else { forces[i - moving][count + k] };
        let mut columns = DMat::from_fn(beyond, shapes, |k, i| weight(k, i) / pole(k));
        for mut column in columns.column_iter_mut() {
            let size = column.norm();
            if size > 0.0 {
                column /= size;
            }
        }

        // Leave out motions that hardly differ from the others.
        let gram = (columns.transpose() * &columns).symmetric_eigen();
        let free: Vec<usize> = (0..shapes).filter(|&i| gram.eigenvalues[i] > MIN_INDEPENDENT).collect();
        if free.is_empty() {
            return (Self::new(self.stiffness, self.mass, poles, kept), DMat::zeros(beyond, 0));
        }
        let basis = DMat::from_columns(
            &free
                .iter()
                .map(|&i| &columns * gram.eigenvectors.column(i) / gram.eigenvalues[i].sqrt())
                .collect::<Vec<_>>(),
        );

        // Rayleigh and Ritz in the space of the remaining motions.
        let stiffness = basis.transpose() * DMat::from_fn(beyond, free.len(), |k, i| pole(k) * basis[(k, i)]);
        let ritz = stiffness.symmetric_eigen();
        let order = order::ascending(ritz.eigenvalues.as_slice());
        let turn = DMat::from_columns(&order.iter().map(|&i| ritz.eigenvectors.column(i)).collect::<Vec<_>>());
        let weights = basis * turn;
        let participation = weights.transpose() * g;
        for (k, &i) in order.iter().enumerate() {
            poles.push(ritz.eigenvalues[i]);
            kept.push(from_fn(|n| participation[(k, n)]));
        }
        (Self::new(self.stiffness, self.mass, poles, kept), weights)
    }

    /// Number of poles below ω² = x.
    pub(crate) fn poles_below(&self, x: f64) -> usize {
        self.poles.partition_point(|pole| *pole < x)
    }

    /// Indices of the poles in the relative distance `width` of x.
    pub(super) fn near(&self, x: f64, width: f64) -> Range<usize> {
        let from = self.poles.partition_point(|pole| *pole < x * (1.0 - width));
        let count = self.poles[from..].iter().take_while(|pole| **pole < x * (1.0 + width)).count();
        from..from + count
    }
}

/// Eigenvalue of the Gram matrix of unit motions above which a motion is independent: the square of its angle to the
/// others. Rounding of the motions leaves noise of 1e-16, whose poles would be arbitrary. Above 1e-6 a cable that hangs
/// nearly straight would lose one of its two slow motions.
const MIN_INDEPENDENT: f64 = 1e-9;

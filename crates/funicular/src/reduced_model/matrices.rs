//! Matrices of the whole robot over the platform's motion, the clamped modes of its cables and its supports.

use super::{Coordinate, DampingAt, ReductionError};
use crate::dynamics::{CableBlocks, CableRow, PlatformBlocks, SupportBlocks};
use crate::math::{CDMat, Complex, DMat, DVec, symmetric_part};
use crate::robot::Damping;
use std::f64::consts::TAU;

/// Order of the coordinates: the platform's, then per cable its clamped modes in plane and out of plane, then the
/// supports.
pub(crate) struct CoordinateLayout {
    pub(crate) dof: usize,
    pub(crate) first_of_term: Vec<usize>,
    /// First coordinate of the supports.
    pub(crate) first_support: usize,
    pub(crate) coordinates: Vec<Coordinate>,
}

impl CoordinateLayout {
    /// Order for a robot with this number of support coordinates.
    pub(crate) fn new(dof: usize, cables: &[CableBlocks], supports: usize) -> Self {
        let mut coordinates: Vec<Coordinate> = (0..dof).map(Coordinate::Platform).collect();
        let mut first_of_term = Vec::with_capacity(cables.len());
        for blocks in cables {
            first_of_term.push(coordinates.len());
            coordinates.extend(blocks.modes.iter().map(|mode| Coordinate::Clamped {
                cable: blocks.cable,
                out_of_plane: mode.out_of_plane,
                frequency_hz: mode.pole.sqrt() / TAU,
            }));
        }
        let first_support = coordinates.len();
        coordinates.extend((0..supports).map(|i| Coordinate::Support { support: i / 3, axis: i % 3 }));
        Self { dof, first_of_term, first_support, coordinates }
    }

    /// Index of a coordinate of the ends: the platform's, then those of the supports.
    fn end(&self, i: usize) -> usize {
        if i < self.dof { i } else { self.first_support + i - self.dof }
    }

    /// Adds `factor` times a row of a cable, given by its index among the terms, to a row over all coordinates.
    pub(crate) fn add_row(&self, of_cable: &CableRow, term: usize, factor: f64, row: &mut [f64]) {
        let at_modes = &mut row[self.first_of_term[term]..][..of_cable.modes.len()];
        at_modes.iter_mut().zip(&of_cable.modes).for_each(|(sum, entry)| *sum += factor * entry);
        of_cable.ends.iter().enumerate().for_each(|(i, entry)| row[self.end(i)] += factor * entry);
    }
}

/// Matrices over all coordinates.
pub(crate) struct Matrices {
    pub(crate) mass: DMat,
    /// Viscous damping.
    pub(crate) damping: DMat,
    /// Damping of cables with a constant damping ratio: the coefficient R of the damping `2ωR`.
    pub(crate) ratio: DMat,
    /// Imaginary part of the stiffness of supports with a constant damping ratio, and of ropes with a constant loss
    /// factor.
    pub(crate) loss: DMat,
    pub(crate) stiffness: DMat,
    /// Mass of the drives; part of `mass`.
    pub(crate) drives: DMat,
    /// Motions of drives on which losses act.
    pub(crate) lossy: Vec<Vec<f64>>,
}

impl Matrices {
    /// Matrices without anything, with n coordinates.
    pub(crate) fn zeros(n: usize) -> Self {
        let zeros = || DMat::zeros(n, n);
        Self {
            mass: zeros(),
            damping: zeros(),
            ratio: zeros(),
            loss: zeros(),
            stiffness: zeros(),
            drives: zeros(),
            lossy: Vec::new(),
        }
    }

    /// Matrices of the platform alone, with n coordinates in total.
    pub(crate) fn of_platform(platform: &PlatformBlocks, n: usize) -> Self {
        let f = platform.mass.nrows();
        let mut matrices = Self::zeros(n);
        let Self { mass, damping, stiffness, .. } = &mut matrices;
        for (matrix, block) in [(mass, &platform.mass), (damping, &platform.damping), (stiffness, &platform.stiffness)]
        {
            matrix.view_mut((0, 0), (f, f)).copy_from(block);
        }
        matrices
    }

    /// Dynamic stiffness `K − ω²M + iωC + 2iω²R + iS` at ω [rad/s], ω ≥ 0, with constant ratios and loss factors as
    /// they are. At rest a loss factor has no effect.
    pub(crate) fn dynamic_stiffness(&self, omega: f64) -> CDMat {
        let (square, of_loss) = (omega * omega, if omega > 0.0 { 1.0 } else { 0.0 });
        CDMat::from_fn(self.mass.nrows(), self.mass.ncols(), |i, j| {
            let at = (i, j);
            let lost = omega * self.damping[at] + 2.0 * square * self.ratio[at] + of_loss * self.loss[at];
            Complex::new(self.stiffness[at] - square * self.mass[at], lost)
        })
    }

    /// Adds the flexible supports.
    pub(crate) fn add_supports(&mut self, supports: &SupportBlocks, layout: &CoordinateLayout) {
        let (at, count) = (layout.first_support, supports.mass.nrows());
        let parts = [
            (&mut self.stiffness, &supports.stiffness),
            (&mut self.mass, &supports.mass),
            (&mut self.loss, &supports.loss),
        ];
        for (matrix, block) in parts {
            let mut view = matrix.view_mut((at, at), (count, count));
            view += block;
        }
        let mut view = self.stiffness.view_mut((0, at), (layout.dof, count));
        view += &supports.coupling;
        let mut view = self.stiffness.view_mut((at, 0), (count, layout.dof));
        view += &supports.coupling.transpose();
    }

    /// Adds a cable, given by its index among the terms.
    pub(crate) fn add_cable(&mut self, cable: &CableBlocks, term: usize, layout: &CoordinateLayout) {
        let f = cable.end_mass.nrows();
        let n = self.mass.nrows();
        let from = layout.first_of_term[term];

        // Stiffness of the ends, and ω_k² of each clamped mode.
        for (i, j) in (0..f).flat_map(|i| (0..f).map(move |j| (i, j))) {
            self.stiffness[(layout.end(i), layout.end(j))] += cable.end_stiffness[(i, j)];
        }
        for (k, mode) in cable.modes.iter().enumerate() {
            self.stiffness[(from + k, from + k)] = mode.pole;
        }

        // Mass of the ends, 1 for each clamped mode, and the participation of the mode between both.
        let mut mass = DMat::zeros(n, n);
        for (i, j) in (0..f).flat_map(|i| (0..f).map(move |j| (i, j))) {
            mass[(layout.end(i), layout.end(j))] = cable.end_mass[(i, j)];
        }
        for (k, mode) in cable.modes.iter().enumerate() {
            let at = from + k;
            mass[(at, at)] = 1.0;
            for (i, g) in mode.participation.iter().enumerate() {
                mass[(layout.end(i), at)] = *g;
                mass[(at, layout.end(i))] = *g;
            }
        }

        // The drive: its mass, which is part of that of the modes, and its losses.
        let mut rope = mass.clone();
        for part in &cable.drive {
            let mut row = vec![0.0; n];
            layout.add_row(&part.row, term, 1.0, &mut row);
            let row = DVec::from_vec(row);
            let product = &row * row.transpose();
            rope -= &product * part.mass;
            self.drives += &product * part.mass;
            if part.damping > 0.0 || part.loss > 0.0 {
                self.damping += &product * part.damping;
                self.loss += product * part.loss;
                self.lossy.push(row.as_slice().to_vec());
            }
        }

        // Damping of the rope acts where its mass is.
        match cable.damping {
            Damping::Viscous(c) => self.damping += &rope * (c / cable.mass_per_length),
            Damping::Ratio(xi) => self.ratio += &rope * xi,
        }
        self.mass += mass;
    }

    /// Viscous damping, including the replacement of constant ratios.
    pub(crate) fn all_damping(&self, at: DampingAt) -> Result<DMat, ReductionError> {
        let by_ratio = match at {
            DampingAt::Hz(hz) => &self.ratio * (2.0 * TAU * hz) + &self.loss / (TAU * hz),
            DampingAt::NaturalFrequencies => {
                at_natural_frequencies(&self.mass, &self.stiffness, &self.ratio, &self.loss)?
            }
        };
        Ok(&self.damping + by_ratio)
    }
}

/// Viscous damping matrix that replaces `2ω R + S/ω`: with the natural modes Φ, `ΦᵀMΦ = 1`, it is `MΦ W ΦᵀM` with `W_jk
/// = 2 √ω_j (ΦᵀRΦ)_jk √ω_k + (ΦᵀSΦ)_jk/√(ω_jω_k)`. It is correct at ω = ω_j = ω_k, also for the coupling of close
/// modes. R belongs to cables with a constant damping ratio, S to supports.
fn at_natural_frequencies(mass: &DMat, stiffness: &DMat, ratio: &DMat, loss: &DMat) -> Result<DMat, ReductionError> {
    let factor = mass.clone().cholesky().ok_or(ReductionError::Mass)?.l();
    let half = factor.solve_lower_triangular(stiffness).ok_or(ReductionError::Mass)?;
    let standard = factor.solve_lower_triangular(&half.transpose()).ok_or(ReductionError::Mass)?;
    let eigen = standard.symmetric_eigen();

    // MΦ = L U; Φᵀ R Φ = Uᵀ L⁻¹ R L⁻ᵀ U.
    let of_modes = |matrix: &DMat| {
        let half = factor.solve_lower_triangular(matrix).ok_or(ReductionError::Mass)?;
        let inner = factor.solve_lower_triangular(&half.transpose()).ok_or(ReductionError::Mass)?;
        Ok::<_, ReductionError>(eigen.eigenvectors.transpose() * inner * &eigen.eigenvectors)
    };
    let mut in_modes = of_modes(ratio)?;
    let roots: Vec<f64> = eigen.eigenvalues.iter().map(|square| square.max(0.0).sqrt().sqrt()).collect();
    for j in 0..roots.len() {
        for k in 0..roots.len() {
            in_modes[(j, k)] *= 2.0 * roots[j] * roots[k];
        }
    }
    if loss.amax() > 0.0 {
        // An unstable direction has no frequency at which the damping could be correct.
        let inverse = |root: f64| if root > 0.0 { root.recip() } else { 0.0 };
        in_modes += of_modes(loss)?.map_with_location(|j, k, entry| entry * inverse(roots[j]) * inverse(roots[k]));
    }
    let back = factor * eigen.eigenvectors;
    let damping = &back * in_modes * back.transpose();
    Ok(symmetric_part(&damping))
}

//! Modes from which a state space is chosen: damped modes of the second-order model below a frequency, and a few
//! motions that replace all modes above it.
//!
//! In undamped modes of unit modal mass the model is `q̈ + C q̇ + Ω² q = B f`, `y = L q`. Its dynamic stiffness `D(s) =
//! Ω² + s C + s²` is symmetric, so that the left eigenvectors are the right ones, for any damping. The eigenvalues with
//! viscous damping are the starts of those with constant damping ratios (docs/theory.md, section 13).

use super::matrices::Matrices;
use super::reference::ReferenceResponses;
use super::{InPowersOfS, ReductionError, SecondOrder, polynomial};
use crate::math::eigenvectors::upper_eigen;
use crate::math::{CDMat, Complex, DMat, DVec, order};

/// Maximum number of modes from which a state space is chosen. The eigenvalue problem has twice as many rows, and
/// nobody designs a controller for more modes.
const MAX_CANDIDATES: usize = 200;
/// Maximum sum of the sizes of the modes that are left out at once, as a fraction of the requested error.
const NEGLIGIBLE: f64 = 0.01;
/// Minimum relative size of a motion among those that replace the higher modes. A smaller one is left out.
const INDEPENDENT: f64 = 1e-8;
/// Maximum distance of eigenvalues that count as one multiple eigenvalue, in half widths of the peak. Rounding
/// separates them by about 1e-9.
pub(super) const MULTIPLE: f64 = 1e-6;
/// Minimum fraction of the kinetic energy in motions that replace higher modes, for a mode that counts as one of them.
const RESIDUAL_SHARE: f64 = 0.5;

/// Undamped modes of a second-order model, ascending in frequency, of unit modal mass.
pub(super) struct ModalModel {
    /// Angular frequencies [rad/s].
    omega: Vec<f64>,
    /// Damping `ΦᵀCΦ` [1/s].
    damping: DMat,
    /// Inputs `ΦᵀB` in powers of s, modes×inputs.
    input: InPowersOfS<DMat>,
    /// Outputs `LΦ` in powers of s, outputs×modes.
    output: InPowersOfS<DMat>,
    /// Motions of the drives on which losses act, modes×motions: they couple the modes.
    lossy: DMat,
    /// Viscous part of the damping [1/s].
    viscous: DMat,
    /// Constant damping ratios `Ξ = ΦᵀRΦ`, which act as `2ω²Ξ`.
    ratios: DMat,
    /// Imaginary part of the stiffness of supports, `ΦᵀSΦ` [1/s²].
    losses: DMat,
    /// Form of the platform's kinetic energy, `ΦᵀM_pΦ`.
    platform: DMat,
    /// Form of the drives' kinetic energy.
    drives: DMat,
    /// True for a motion that replaces higher modes.
    residual: Vec<bool>,
}

/// Ratio to the largest eigenvalue of the stiffness below which an eigenvalue is rounding.
const NO_STIFFNESS: f64 = 1e-12;
/// Ratio to the largest entry of a matrix below which its part along a free motion is rounding.
const UNCOUPLED: f64 = 1e-9;

/// Motions beside those without stiffness, as columns, between which and the latter the mass does not couple; `None` if
/// an input, an output or the damping sees a motion without stiffness.
fn beside_free_motions(model: &SecondOrder) -> Option<DMat> {
    let eigen = crate::math::symmetric_part(&model.stiffness).symmetric_eigen();
    let zero = NO_STIFFNESS * eigen.eigenvalues.amax();
    let (free, others): (Vec<usize>, Vec<usize>) =
        (0..eigen.eigenvalues.len()).partition(|k| eigen.eigenvalues[*k].abs() <= zero);
    let columns =
        |list: &[usize]| DMat::from_fn(model.mass.nrows(), list.len(), |i, k| eigen.eigenvectors[(i, list[k])]);
    let (free, others) = (columns(&free), columns(&others));
    if free.ncols() == 0 {
        return Some(others);
    }

    let own = (free.transpose() * &model.mass * &free).try_inverse()?;
    let basis = &others - &free * own * free.transpose() * &model.mass * &others;
    let is_seen = |part: DMat, whole: &DMat| part.iter().any(|x| x.abs() > UNCOUPLED * whole.amax());
    let seen = model.inputs().iter().any(|input| is_seen(free.transpose() * *input, input))
        || model.outputs().iter().any(|output| is_seen(*output * &free, output))
        || is_seen(basis.transpose() * &model.damping * &free, &model.damping);
    (!seen).then_some(basis)
}

impl ModalModel {
    /// Modes of a model; `None` if its stiffness is not positive definite. `parts` has its damping without that of
    /// constant ratios and the matrix R of these; `platform_mass` is the mass matrix of the platform alone, over the
    /// first coordinates. Of an indifferent equilibrium, the motions without stiffness are left out if no input, output
    /// or damping sees them.
    pub(super) fn new(
        model: &SecondOrder,
        parts: &Matrices,
        platform_mass: &DMat,
        is_indifferent: bool,
    ) -> Option<Self> {
        let (mut mass, mut stiffness) = (model.mass.clone(), model.stiffness.clone());
        let basis = if is_indifferent { Some(beside_free_motions(model)?) } else { None };
        if let Some(basis) = &basis {
            (mass, stiffness) = (basis.transpose() * mass * basis, basis.transpose() * stiffness * basis);
        }

        // K is factored and not M: the low frequencies then are the largest eigenvalues and keep all their digits.
        let factor = stiffness.cholesky()?.l();
        let half = factor.solve_lower_triangular(&mass)?;
        let flexible = factor.solve_lower_triangular(&half.transpose())?;
        let eigen = crate::math::symmetric_part(&flexible).symmetric_eigen();

        // Ascending in frequency, which is descending in 1/ω².
        let n = mass.nrows();
        let mut order: Vec<usize> = (0..n).collect();
        order::sort_descending(&mut order, |k| eigen.eigenvalues[*k]);
        let smallest = f64::EPSILON * eigen.eigenvalues[*order.first()?];
        let omega: Vec<f64> = order.iter().map(|k| eigen.eigenvalues[*k].max(smallest).sqrt().recip()).collect();
        let mut sorted = DMat::zeros(n, n);
        for (k, from) in order.iter().enumerate() {
            sorted.column_mut(k).copy_from(&(eigen.eigenvectors.column(*from) * omega[k]));
        }
        let mut phi = factor.transpose().solve_upper_triangular(&sorted)?;
        if let Some(basis) = basis {
            phi = basis * phi;
        }

        let at_platform = phi.rows(0, platform_mass.nrows());
        let lossy = DMat::from_fn(phi.nrows(), parts.lossy.len(), |i, k| parts.lossy[k][i]);
        Some(Self {
            damping: phi.transpose() * &model.damping * &phi,
            viscous: phi.transpose() * &parts.damping * &phi,
            ratios: phi.transpose() * &parts.ratio * &phi,
            losses: phi.transpose() * &parts.loss * &phi,
            input: model.inputs().map(|input| phi.transpose() * input),
            output: model.outputs().map(|output| output * &phi),
            lossy: phi.transpose() * lossy,
            platform: at_platform.transpose() * platform_mass * at_platform,
            drives: phi.transpose() * &parts.drives * &phi,
            residual: vec![false; n],
            omega,
        })
    }

    /// Modes below `limit` [rad/s] that the inputs and outputs see, and in place of all modes above it the motions that
    /// keep the value and the slope of their responses at zero frequency. `tolerance` is the error that is wanted.
    pub(super) fn candidates(&self, limit: f64, reference: &ReferenceResponses, tolerance: f64) -> Self {
        let below = self.omega.iter().filter(|omega| **omega < limit).count();
        let seen = self.seen(below, reference, tolerance);
        let higher = self.residual_motions(below, reference);

        // Basis over all modes: single modes, then motions of the higher modes.
        let n = self.omega.len();
        let mut basis = DMat::zeros(n, seen.len() + higher.ncols());
        for (k, mode) in seen.iter().enumerate() {
            basis[(*mode, k)] = 1.0;
        }
        basis.view_mut((below, seen.len()), (n - below, higher.ncols())).copy_from(&higher);

        let mut omega: Vec<f64> = seen.iter().map(|mode| self.omega[*mode]).collect();
        omega.extend((0..higher.ncols()).map(|k| {
            let square: f64 = (below..n).map(|j| (self.omega[j] * higher[(j - below, k)]).powi(2)).sum();
            square.sqrt()
        }));
        Self {
            damping: basis.transpose() * &self.damping * &basis,
            viscous: basis.transpose() * &self.viscous * &basis,
            ratios: basis.transpose() * &self.ratios * &basis,
            losses: basis.transpose() * &self.losses * &basis,
            input: self.input.each_ref().map(|input| basis.transpose() * input),
            output: self.output.each_ref().map(|output| output * &basis),
            lossy: basis.transpose() * &self.lossy,
            platform: basis.transpose() * &self.platform * &basis,
            drives: basis.transpose() * &self.drives * &basis,
            residual: (0..basis.ncols()).map(|k| k >= seen.len()).collect(),
            omega,
        }
    }

    /// The first modes, `below` in number, without those that no input and output see. Losses of drives couple the
    /// modes, so that all of them count.
    fn seen(&self, below: usize, reference: &ReferenceResponses, tolerance: f64) -> Vec<usize> {
        let last_hz = reference.frequencies_hz.last().expect("there are frequencies");
        let limit = last_hz * std::f64::consts::TAU;

        // Height of each mode's peak relative to the peak of a pair, the largest over all pairs.
        let outputs = self.output[0].nrows();
        let mut sized: Vec<(f64, usize)> = (0..below)
            .map(|k| {
                let (omega, loss) = (self.omega[k], self.damping[(k, k)]);
                let at = omega.min(limit);
                let amplification = 1.0 / ((omega * omega - at * at).hypot(at * loss)).max(f64::MIN_POSITIVE);
                let height = |pair: usize| {
                    let s = Complex::new(0.0, at);
                    let product = at_entry(&self.output, s, (pair % outputs, k)).norm()
                        * at_entry(&self.input, s, (k, pair / outputs)).norm();
                    let derivatives = reference.quantity(pair).derivatives().cast_signed();
                    product * amplification * at.powi(derivatives) / reference.sizes[pair]
                };
                ((0..reference.pairs()).map(height).fold(0.0, f64::max), k)
            })
            .collect();
        order::sort_descending(&mut sized, |(size, _)| *size);
        sized.truncate(MAX_CANDIDATES);

        let mut sum = 0.0;
        while let Some((size, _)) = sized.last() {
            sum += size;
            if sum > NEGLIGIBLE * tolerance || self.lossy.ncols() > 0 {
                break;
            }
            sized.pop();
        }
        let mut modes: Vec<usize> = sized.into_iter().map(|(_, mode)| mode).collect();
        modes.sort_unstable();
        modes
    }

    /// Motions of the modes from number `below` on that the inputs excite slowly and the outputs measure, as columns
    /// that are modes among themselves.
    fn residual_motions(&self, below: usize, reference: &ReferenceResponses) -> DMat {
        let count = self.omega.len() - below;
        if count == 0 {
            return DMat::zeros(0, 0);
        }

        // Forces on the modes by inputs and outputs, in each power of s at the highest frequency, and by losses.
        let last_hz = reference.frequencies_hz.last().copied().unwrap_or_default();
        let highest = last_hz * std::f64::consts::TAU;
        let powers = || [1.0, highest, highest * highest].into_iter().enumerate();
        let mut forces: Vec<DVec> = Vec::new();
        for (power, factor) in powers() {
            let scaled = self.input[power].column_iter().zip(&reference.input_scale);
            forces.extend(scaled.map(|(column, scale)| column.rows(below, count) / *scale * factor));
        }
        for (power, factor) in powers() {
            let scaled = self.output[power].row_iter().zip(&reference.output_scale);
            forces.extend(scaled.map(|(row, scale)| row.columns(below, count).transpose() / *scale * factor));
        }
        forces.extend(self.lossy.column_iter().map(|column| column.rows(below, count).into_owned()));

        let still =
            |force: &DVec| DVec::from_fn(count, |j, _| force[j] / (self.omega[below + j] * self.omega[below + j]));
        let motions: Vec<DVec> = forces.iter().map(still).collect();
        // Each input and each output counts as much as any other.
        let equal: Vec<_> = motions.iter().filter(|m| m.norm() > 0.0).map(DVec::normalize).collect();
        if equal.is_empty() {
            return DMat::zeros(count, 0);
        }
        let decomposed = DMat::from_columns(&equal).svd(true, false);
        let all = decomposed.u.expect("it was requested");
        let largest = decomposed.singular_values.max();
        let independent: Vec<_> = (0..all.ncols())
            .filter(|k| decomposed.singular_values[*k] > INDEPENDENT * largest)
            .map(|k| all.column(k).into_owned())
            .collect();
        let span = DMat::from_columns(&independent);

        // Rayleigh and Ritz: the motions that are modes among themselves.
        let scaled = DMat::from_fn(count, span.ncols(), |j, k| self.omega[below + j] * span[(j, k)]);
        let eigen = (scaled.transpose() * &scaled).symmetric_eigen();
        span * eigen.eigenvectors
    }

    /// Damped modes, each with its residues. Equal eigenvalues are one of them. `parts` gets the numbers of finished
    /// and of all eigenvalues; its error ends the work.
    ///
    /// # Errors
    /// [`ReductionError::Eigenvalues`] if the eigenvalue problem cannot be solved.
    pub(super) fn damped(
        &self,
        parts: &mut dyn FnMut(usize, usize) -> Result<(), ReductionError>,
    ) -> Result<Vec<DampedPair>, ReductionError> {
        parts(0, 1)?;
        let p = self.omega.len();
        let mut state = DMat::zeros(2 * p, 2 * p);
        for k in 0..p {
            (state[(k, p + k)], state[(p + k, k)]) = (self.omega[k], -self.omega[k]);
        }
        state.view_mut((p, p), (p, p)).copy_from(&(-&self.damping));
        let eigen = upper_eigen(&state).ok_or(ReductionError::Eigenvalues)?;

        // Groups of equal eigenvalues, in the order of their imaginary and then their real parts.
        let mut order: Vec<usize> = (0..eigen.values.len()).collect();
        order::sort_ascending(&mut order, |k| eigen.values[*k].re);
        order::sort_ascending(&mut order, |k| eigen.values[*k].im);
        let groups = order.chunk_by(|a, b| {
            let (a, b) = (eigen.values[*a], eigen.values[*b]);
            (a - b).norm() <= MULTIPLE * a.re.abs() && (a.im > 0.0) == (b.im > 0.0)
        });
        let mut done = 0;
        groups
            .map(|group| {
                parts(done, order.len())?;
                done += group.len();
                self.pair(&eigen.values, &eigen.vectors, group).ok_or(ReductionError::Eigenvalues)
            })
            .collect()
    }

    /// Residues of the eigenvalues of one group, `R = L X (Xᵀ D'(λ) X)⁻¹ Xᵀ B` with the motions X.
    fn pair(&self, values: &[Complex], vectors: &CDMat, group: &[usize]) -> Option<DampedPair> {
        let p = self.omega.len();

        // Motions q of the states (Ω q, q̇).
        let mut found = values[group[0]];
        let mut motions = CDMat::zeros(p, group.len());
        for (k, at) in group.iter().enumerate() {
            let start = CDMat::from_fn(p, 1, |i, _| vectors[(i, *at)] / self.omega[i]);
            let (value, motion) = self.with_constant_ratios(values[*at], start);
            motions.column_mut(k).copy_from(&motion.column(0));
            found = value;
        }

        let slope = self.slope(found);
        let weights = (motions.transpose() * slope * &motions).lu();
        let row = weights.solve(&(motions.transpose() * polynomial(&self.input.each_ref(), found)))?;
        let residue = polynomial(&self.output.each_ref(), found) * &motions * row;

        // Kinetic energy of the platform and of the motions that replace higher modes, over all of it.
        let all = motions.norm_squared().max(f64::MIN_POSITIVE);
        let energy = |form: &DMat| {
            let energy = (motions.adjoint() * form.map(Complex::from) * &motions).trace().re;
            (energy / all).clamp(0.0, 1.0)
        };
        let residual: f64 = (0..p).filter(|i| self.residual[*i]).map(|i| motions.row(i).norm_squared()).sum();
        Some(DampedPair {
            value: stable(found),
            residue,
            platform: energy(&self.platform),
            drives: energy(&self.drives),
            is_residual: residual > RESIDUAL_SHARE * all,
        })
    }

    /// Dynamic stiffness `D(s) = Ω² + iS + s C + s² (1 − 2iΞ)` for an oscillation, with the constant ratios. For a
    /// decay without oscillation, to which no ratio belongs, with the viscous damping that replaces them.
    fn dynamic_stiffness(&self, s: Complex) -> CDMat {
        let (viscous, of_ratio, of_support) = self.losses_at(s);
        let mut stiffness = viscous.zip_zip_map(&self.ratios, &self.losses, |c, ratio, loss| {
            s * c + s * s * of_ratio * ratio + of_support * loss
        });
        for (k, omega) in self.omega.iter().enumerate() {
            stiffness[(k, k)] += omega * omega + s * s;
        }
        stiffness
    }

    /// Derivative of the dynamic stiffness by s.
    fn slope(&self, s: Complex) -> CDMat {
        let (viscous, of_ratio, _) = self.losses_at(s);
        let mut slope = viscous.zip_map(&self.ratios, |c, ratio| c + 2.0 * s * of_ratio * ratio);
        for k in 0..self.omega.len() {
            slope[(k, k)] += 2.0 * s;
        }
        slope
    }

    /// Viscous damping at s, and the factors of the constant ratios of cables and of the losses of supports.
    fn losses_at(&self, s: Complex) -> (&DMat, Complex, Complex) {
        if s.im > 0.0 {
            (&self.viscous, Complex::new(0.0, -2.0), Complex::new(0.0, 1.0))
        } else {
            (&self.damping, 0.0.into(), 0.0.into())
        }
    }

    /// Eigenvalue and motion with constant damping ratios, from those with the viscous damping that replaces them:
    /// inverse iteration and the symmetric Rayleigh quotient.
    fn with_constant_ratios(&self, start: Complex, motion: CDMat) -> (Complex, CDMat) {
        // A larger change than this part of the half width is another mode.
        const MAX_CHANGE: f64 = 0.5;
        // Each step needs an elimination; the second one matters if modes are close.
        let steps = if self.omega.len() > 100 { 1 } else { 2 };
        if start.im <= 0.0 || (self.ratios.amax() == 0.0 && self.losses.amax() == 0.0) {
            return (start, motion);
        }

        let (mut value, mut found) = (start, motion.clone());
        for _ in 0..steps {
            let right = self.slope(value) * &found;
            let Some(solved) = self.dynamic_stiffness(value).lu().solve(&right) else { break };
            let size = solved.norm();
            if !(size.is_finite() && size > 0.0) {
                break;
            }
            found = solved.unscale(size);

            // Newton's steps of xᵀ D(s) x = 0.
            for _ in 0..3 {
                let product = |matrix: CDMat| (found.transpose() * matrix * &found)[(0, 0)];
                value -= product(self.dynamic_stiffness(value)) / product(self.slope(value));
            }
        }
        let change = (value - start).norm();
        if change.is_finite() && change <= MAX_CHANGE * start.re.abs() { (value, found) } else { (start, motion) }
    }
}

/// Value at s of an entry of a polynomial.
fn at_entry(powers: &InPowersOfS<DMat>, s: Complex, at: (usize, usize)) -> Complex {
    powers[0][at] + s * (powers[1][at] + s * powers[2][at])
}

/// Eigenvalue with a decay. Rounding may take it from motions above the limit that hardly have damping.
fn stable(value: Complex) -> Complex {
    const MIN_RATIO: f64 = 1e-9;
    Complex::new(value.re.min(-MIN_RATIO * value.norm()), value.im)
}

/// Eigenvalue λ with its conjugate, or a real eigenvalue, and its part `R/(s − λ)` of the receptances.
#[derive(Clone)]
pub(super) struct DampedPair {
    pub(super) value: Complex,
    /// Residues of displacements, outputs×inputs.
    pub(super) residue: CDMat,
    /// Fraction of the kinetic energy that the platform has.
    pub(super) platform: f64,
    /// Fraction that the drives have.
    pub(super) drives: f64,
    /// True for a motion that replaces modes above the limit.
    pub(super) is_residual: bool,
}

/// Joins neighbours whose eigenvalues differ by less than `width` half widths of their peaks.
pub(super) fn joined(pairs: &[DampedPair], width: f64) -> Vec<DampedPair> {
    let mut joined: Vec<(DampedPair, Complex)> = Vec::new();

    for pair in pairs {
        // The eigenvalue of a group stays near its first one.
        match joined.last_mut() {
            Some((last, first))
                if last.value.im > 0.0
                    && pair.value.im > 0.0
                    && (pair.value - *first).norm() <= width * first.re.abs()
                    && pair.is_residual == last.is_residual =>
            {
                let (a, b) = (last.residue.norm(), pair.residue.norm());
                let share = if a + b > 0.0 { b / (a + b) } else { 0.5 };
                last.value += (pair.value - last.value) * share;
                last.platform += (pair.platform - last.platform) * share;
                last.drives += (pair.drives - last.drives) * share;
                last.residue += &pair.residue;
            }
            _ => joined.push((pair.clone(), pair.value)),
        }
    }

    joined.into_iter().map(|(pair, _)| pair).collect()
}

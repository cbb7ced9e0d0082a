//! Parts of a state space: the states of one mode, in modal and in real coordinates (docs/theory.md, equations (46b) to
//! (46d)).

use super::Quantity;
use super::candidates::DampedPair;
use super::reference::ReferenceResponses;
use crate::math::{Complex, DMat};
use std::f64::consts::{PI, TAU};

/// Maximum residue that is rounding, relative to the largest residue of the same eigenvalue.
const RESIDUE: f64 = 1e-9;

/// Part of one pair of states, or of one state, in all responses:
/// `R/(s − λ)`, its conjugate, and a constant that makes it zero at s = 0.
#[derive(Clone)]
pub(super) struct Term {
    pub(super) value: Complex,
    /// Column of the outputs, in their quantities.
    pub(super) column: Vec<Complex>,
    /// Row of the inputs.
    pub(super) row: Vec<Complex>,
    /// Residues of all pairs of output and input.
    pub(super) residues: Vec<Complex>,
    /// Feedthrough of all pairs.
    pub(super) constants: Vec<f64>,
    pub(super) platform: f64,
    pub(super) drives: f64,
    pub(super) is_residual: bool,
    /// Maximum of the term relative to the peaks.
    pub(super) size: f64,
}

impl Term {
    pub(super) fn states(&self) -> usize {
        if self.value.im > 0.0 { 2 } else { 1 }
    }

    /// Adds `factor` times the term at a frequency [Hz] to the responses of all pairs.
    pub(super) fn add(&self, frequency_hz: f64, factor: f64, responses: &mut [Complex]) {
        self.add_strictly_proper(frequency_hz, factor, responses);
        for (response, constant) in responses.iter_mut().zip(&self.constants) {
            *response += factor * constant;
        }
    }

    /// Adds `factor` times the term without its constant.
    pub(super) fn add_strictly_proper(&self, frequency_hz: f64, factor: f64, responses: &mut [Complex]) {
        let s = Complex::new(0.0, frequency_hz * TAU);
        let upper = factor / (s - self.value);
        if self.states() == 2 {
            let lower = factor / (s - self.value.conj());
            for (response, residue) in responses.iter_mut().zip(&self.residues) {
                *response += residue * upper + residue.conj() * lower;
            }
        } else {
            for (response, residue) in responses.iter_mut().zip(&self.residues) {
                *response += residue * upper;
            }
        }
    }
}

/// Terms of a damped mode: one per independent direction of its residues.
pub(super) fn terms(pair: &DampedPair, reference: &ReferenceResponses) -> Vec<Term> {
    let (outputs, inputs) = pair.residue.shape();
    let scaled = pair.residue.map_with_location(|o, i, r| r / (reference.output_scale[o] * reference.input_scale[i]));
    let decomposed = scaled.svd(true, true);
    let (Some(left), Some(right)) = (&decomposed.u, &decomposed.v_t) else { return Vec::new() };
    let largest = decomposed.singular_values.max();
    let is_real = pair.value.im <= 0.0;

    (0..decomposed.singular_values.len())
        .filter(|k| decomposed.singular_values[*k] > RESIDUE * largest)
        .map(|k| {
            let root = decomposed.singular_values[k].sqrt();
            let column: Vec<Complex> =
                (0..outputs).map(|o| left[(o, k)] * (root * reference.output_scale[o])).collect();
            let row: Vec<Complex> = (0..inputs).map(|i| right[(k, i)] * (root * reference.input_scale[i])).collect();
            let (column, row) = if is_real { real_factors(&column, &row) } else { (column, row) };
            term(pair, column, row, reference)
        })
        .collect()
}

/// Real column and row with the same product, for the real residues of a real eigenvalue.
fn real_factors(column: &[Complex], row: &[Complex]) -> (Vec<Complex>, Vec<Complex>) {
    let largest = row.iter().copied().max_by(|a, b| a.norm().total_cmp(&b.norm())).unwrap_or_default();
    let turn = if largest.norm() > 0.0 { largest.conj() / largest.norm() } else { 1.0.into() };
    let real = |values: &[Complex], turn: Complex| values.iter().map(|z| Complex::from((z * turn).re)).collect();
    (real(column, turn.conj()), real(row, turn))
}

/// Term of a column for displacements and a row for forces.
fn term(pair: &DampedPair, mut column: Vec<Complex>, row: Vec<Complex>, reference: &ReferenceResponses) -> Term {
    let outputs = column.len();
    let value = pair.value;
    let twice = if value.im > 0.0 { 2.0 } else { 1.0 };

    // Feedthrough of the displacement, which makes it zero at s = 0, so that the static part of every mode can be added
    // elsewhere; and feedthrough of the acceleration, `s² R/(s − λ) = λ² R/(s − λ) + λ R + s R`, whose last part
    // vanishes in the sum with the conjugate for a mode of second order.
    let mut constants = vec![0.0; reference.pairs()];
    for (at, constant) in constants.iter_mut().enumerate() {
        let residue = column[at % outputs] * row[at / outputs];
        *constant = match reference.quantity(at) {
            Quantity::Displacement => twice * (residue / value).re,
            // A constant input gives no velocity. Without strong damping the residue is imaginary.
            Quantity::Velocity if reference.has_drive_losses => twice * residue.re,
            Quantity::Velocity => 0.0,
            Quantity::Acceleration => twice * (residue * value).re,
        };
    }
    for (output, entry) in column.iter_mut().enumerate() {
        *entry *= value.powu(reference.quantity(output).derivatives());
    }

    let residues = row.iter().flat_map(|b| column.iter().map(move |c| c * b)).collect();
    let DampedPair { platform, drives, is_residual, .. } = *pair;
    let mut term = Term { value, column, row, residues, constants, platform, drives, is_residual, size: 0.0 };
    let mut responses = vec![Complex::from(0.0); reference.pairs()];
    for frequency_hz in &reference.frequencies_hz {
        responses.fill(0.0.into());
        term.add(*frequency_hz, 1.0, &mut responses);
        term.size = responses.iter().zip(&reference.sizes).map(|(r, size)| r.norm() / size).fold(term.size, f64::max);
    }
    term
}

/// Matrices of one term in real coordinates: `[0, ω; −ω, −2ζω]` for a pair.
pub(super) struct RealBlock {
    pub(super) a: DMat,
    pub(super) b: DMat,
    pub(super) c: DMat,
}

impl RealBlock {
    pub(super) fn of(term: &Term, reference: &ReferenceResponses) -> Self {
        let (inputs, outputs) = (term.row.len(), term.column.len());
        let value = term.value;
        if term.states() == 1 {
            let b = DMat::from_fn(1, inputs, |_, i| term.row[i].re);
            let c = DMat::from_fn(outputs, 1, |o, _| term.column[o].re);
            return Self { a: DMat::from_element(1, 1, value.re), b, c }.balanced(reference);
        }

        // Phase for which the input acts on the second state, the velocity of the mode, as far as it can: the rows of
        // the inputs become imaginary in the mean.
        let square: Complex =
            term.row.iter().zip(&reference.input_scale).map(|(b, scale)| (b / scale) * (b / scale)).sum();
        let mut turn = Complex::from_polar(1.0, 0.5 * (PI - square.arg()));
        let largest = (0..inputs).max_by(|a, b| term.row[*a].norm().total_cmp(&term.row[*b].norm()));
        if largest.is_some_and(|i| (term.row[i] * turn).im < 0.0) {
            turn = -turn;
        }

        // The coordinates are x = 2 Re(v z) with the eigenvector v = (ω, λ) of the block.
        let omega = value.norm();
        let b = DMat::from_fn(2, inputs, |state, i| {
            let row = term.row[i] * turn;
            2.0 * if state == 0 { omega * row.re } else { (value * row).re }
        });
        let c = DMat::from_fn(outputs, 2, |o, state| {
            let column = term.column[o] / turn;
            let second = column.im / value.im;
            if state == 0 { (column.re - value.re * second) / omega } else { second }
        });
        let a = DMat::from_row_slice(2, 2, &[0.0, omega, -omega, 2.0 * value.re]);
        Self { a, b, c }.balanced(reference)
    }

    /// Scales the states so that input and output have entries of equal size, measured in their scales.
    fn balanced(mut self, reference: &ReferenceResponses) -> Self {
        let by_input: f64 =
            self.b.column_iter().zip(&reference.input_scale).map(|(b, scale)| b.norm_squared() / (scale * scale)).sum();
        let by_output: f64 =
            self.c.row_iter().zip(&reference.output_scale).map(|(c, scale)| c.norm_squared() / (scale * scale)).sum();
        if by_input > 0.0 && by_output > 0.0 {
            let factor = (by_output / by_input).sqrt().sqrt();
            self.b *= factor;
            self.c /= factor;
        }
        self
    }
}

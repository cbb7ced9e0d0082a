//! State space of a second-order model whose inputs and outputs are polynomials of s, and the polynomial part that no
//! state space has.

use super::SecondOrder;
use crate::math::{Complex, DMat};

/// State space and polynomial part of `L(s) (K + sC + s²M)⁻¹ B(s) + D(s)`, in the quantities of the outputs.
pub(super) struct Expansion {
    pub(super) a: DMat,
    pub(super) b: DMat,
    pub(super) c: DMat,
    /// Coefficients of 1, s, s² … of the polynomial part.
    pub(super) direct: Vec<DMat>,
    /// Sums of the magnitudes from which these coefficients are made.
    sizes: Vec<DMat>,
}

/// Maximum coefficient that is rounding, as a fraction of the sum of the magnitudes of its terms.
const ROUNDING: f64 = 1e-10;

impl Expansion {
    /// Expansion of a model. The forces `B₁ ḟ + B₂ f̈` move the coordinates by `M⁻¹B₂ f` at once and their velocities
    /// by `M⁻¹(B₁ − C M⁻¹B₂) f`; the states are the rest of both.
    pub(super) fn of(model: &SecondOrder) -> Self {
        let (n, inputs, outputs) = (model.mass.nrows(), model.input.ncols(), model.output.nrows());
        let factor = model.mass.clone().cholesky().expect("checked when it was made");
        let (by_motion, by_velocity) = (-factor.solve(&model.stiffness), -factor.solve(&model.damping));

        // Motion, velocity and acceleration that follow the inputs at once.
        let [by_input, by_rate, by_acceleration] = model.inputs().map(|force| factor.solve(force));
        let moved = by_acceleration;
        let pushed = by_rate + &by_velocity * &moved;
        let accelerated = by_input + &by_motion * &moved + &by_velocity * &pushed;

        // State and input.
        let mut a = DMat::zeros(2 * n, 2 * n);
        a.view_mut((0, n), (n, n)).fill_with_identity();
        a.view_mut((n, 0), (n, n)).copy_from(&by_motion);
        a.view_mut((n, n), (n, n)).copy_from(&by_velocity);
        let mut b = DMat::zeros(2 * n, inputs);
        b.view_mut((0, 0), (n, inputs)).copy_from(&pushed);
        b.view_mut((n, 0), (n, inputs)).copy_from(&accelerated);

        // Outputs: the rows of L are differentiated as often as their quantity says. Each derivative of the coordinates
        // is a row times the state, and a polynomial whose coefficients move up by one power.
        let mut c = DMat::zeros(outputs, 2 * n);
        let mut direct: Vec<DMat> = vec![DMat::zeros(outputs, inputs); HIGHEST_POWER + 1];
        let mut sizes = direct.clone();
        let of_input = b.abs();
        for (i, quantity) in model.quantities.iter().enumerate() {
            let derivatives = quantity.derivatives() as usize;
            for (power, rows) in model.outputs().iter().enumerate() {
                let row = rows.rows(i, 1).into_owned();
                if row.amax() == 0.0 {
                    continue;
                }
                let mut on_state = DMat::zeros(1, 2 * n);
                on_state.view_mut((0, 0), (1, n)).copy_from(&row);
                let mut polynomial = vec![(&row * &moved, row.abs() * moved.abs())];
                for _ in 0..power + derivatives {
                    polynomial.insert(0, (&on_state * &b, on_state.abs() * &of_input));
                    on_state *= &a;
                }
                let mut of_output = c.rows_mut(i, 1);
                of_output += on_state;
                for (power, (coefficient, size)) in polynomial.iter().enumerate() {
                    add_to_row(&mut direct[power], i, coefficient);
                    add_to_row(&mut sizes[power], i, size);
                }
            }
            for (power, matrix) in model.feedthrough.iter().enumerate() {
                let row = matrix.rows(i, 1).into_owned();
                add_to_row(&mut direct[power + derivatives], i, &row);
                add_to_row(&mut sizes[power + derivatives], i, &row.abs());
            }
        }
        Self { a, b, c, direct, sizes }
    }

    /// First pair (output, input) whose polynomial part has a power of s.
    pub(super) fn improper(&self) -> Option<(usize, usize)> {
        let pairs = || (0..self.c.nrows()).flat_map(|o| (0..self.b.ncols()).map(move |i| (o, i)));
        let powers = || self.direct.iter().zip(&self.sizes).skip(1);
        pairs().find(|at| powers().any(|(direct, size)| direct[*at].abs() > ROUNDING * size[*at]))
    }

    /// Magnitude at ω [rad/s] of the part of a response that a sum over all modes with a static correction does not
    /// contain: the powers of s of the polynomial part, and the complete polynomial part if the sum has
    /// `no_feedthrough`.
    pub(super) fn beside_modes(&self, omega: f64, (output, input): (usize, usize), no_feedthrough: bool) -> f64 {
        let sum: Complex = (self.direct.iter().enumerate().skip(usize::from(!no_feedthrough)))
            .map(|(power, direct)| Complex::new(0.0, omega).powu(power as u32) * direct[(output, input)])
            .sum();
        sum.norm()
    }
}

fn add_to_row(matrix: &mut DMat, row: usize, added: &DMat) {
    let mut sum = matrix.rows_mut(row, 1);
    sum += added;
}

/// Highest power of s: the acceleration of an output that is an acceleration itself.
const HIGHEST_POWER: usize = 4;

//! Flexible supports without mass that carry no cable with mass: their displacements follow at once and are eliminated.

use super::InPowersOfS;
use super::matrices::{CoordinateLayout, Matrices};
use crate::math::DMat;

/// Coordinates without mass, which follow the others: `e = −K_ee⁻¹ K_er y + K_ee⁻¹ f_e`.
pub(super) struct MasslessSupports {
    /// All coordinates per remaining coordinate.
    motion: DMat,
    /// Indices of the coordinates that remain.
    kept: Vec<usize>,
    /// Flexibility K_ee⁻¹ over all coordinates [m/N]; zero for the others.
    flexibility: DMat,
}

impl MasslessSupports {
    /// Supports without mass; `None` if there are none.
    pub(super) fn of(matrices: &Matrices, layout: &CoordinateLayout) -> Option<Self> {
        let n = layout.coordinates.len();
        let (still, kept): (Vec<usize>, Vec<usize>) =
            (0..n).partition(|i| *i >= layout.first_support && matrices.mass.row(*i).amax() == 0.0);
        if still.is_empty() {
            return None;
        }

        // A cable without mass may make its support unstable; then there is no model, which the caller's mass matrix
        // tells.
        let own = DMat::from_fn(still.len(), still.len(), |i, j| matrices.stiffness[(still[i], still[j])]);
        let inverse = own.try_inverse()?;
        let coupling = DMat::from_fn(still.len(), kept.len(), |i, j| matrices.stiffness[(still[i], kept[j])]);
        let follows = -&inverse * coupling;

        let (mut motion, mut flexibility) = (DMat::zeros(n, kept.len()), DMat::zeros(n, n));
        kept.iter().enumerate().for_each(|(j, i)| motion[(*i, j)] = 1.0);
        for (k, i) in still.iter().enumerate() {
            motion.row_mut(*i).copy_from(&follows.row(k));
            still.iter().enumerate().for_each(|(l, j)| flexibility[(*i, *j)] = inverse[(k, l)]);
        }
        Some(Self { motion, kept, flexibility })
    }

    /// Entries of the coordinates that remain.
    pub(super) fn kept<T: Clone>(&self, all: &[T]) -> Vec<T> {
        self.kept.iter().map(|i| all[*i].clone()).collect()
    }

    /// Matrices over the coordinates that remain.
    pub(super) fn reduced(&self, matrices: Matrices) -> Matrices {
        let of = |matrix: &DMat| self.motion.transpose() * matrix * &self.motion;
        Matrices {
            mass: of(&matrices.mass),
            damping: of(&matrices.damping),
            ratio: of(&matrices.ratio),
            loss: of(&matrices.loss),
            stiffness: of(&matrices.stiffness),
            drives: of(&matrices.drives),
            lossy: matrices.lossy.into_iter().map(|row| self.row(&row)).collect(),
        }
    }

    /// Row over the coordinates that remain.
    fn row(&self, row: &[f64]) -> Vec<f64> {
        let entry = |j: usize| self.motion.column(j).iter().zip(row).map(|(motion, entry)| motion * entry).sum();
        (0..self.kept.len()).map(entry).collect()
    }

    /// Rows of ports over the coordinates that remain.
    pub(super) fn rows(&self, rows: InPowersOfS<DMat>) -> InPowersOfS<DMat> {
        rows.map(|rows| rows * &self.motion)
    }

    /// Outputs per inputs by the forces on the eliminated coordinates, in powers of s.
    pub(super) fn direct(&self, outputs: &InPowersOfS<DMat>, inputs: &InPowersOfS<DMat>) -> InPowersOfS<DMat> {
        let product = |a: usize, b: usize| &outputs[a] * &self.flexibility * inputs[b].transpose();
        // Only constant forces act on supports without mass.
        [0, 1, 2].map(|power| (1..=power).fold(product(0, power), |sum, a| sum + product(a, power - a)))
    }
}

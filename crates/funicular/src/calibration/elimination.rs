//! Elimination of the pose of a row by Householder reflections, which keeps all digits of a row (96c).

use super::row::RowTerms;
use crate::math::{DMat, DVec};

/// Diagonal entry of the triangle of a row, relative to the largest one, up to which the row does not fix its pose.
pub(super) const OPEN_POSE: f64 = 1e-12;

/// Row whose pose is eliminated.
pub(super) struct EliminatedRow {
    /// Net rows `W = Nᵀ J_θ`.
    pub(super) net: DMat,
    /// Net residuals `e = Nᵀ r`.
    pub(super) residuals: DVec,
    /// Columns of N: directions of the row's data that its pose does not reach.
    pub(super) directions: Option<DMat>,
    /// Triangle `R`, and `Q₁ᵀ` of residuals and derivatives.
    triangle: DMat,
    upper_residuals: DVec,
    upper: DMat,
}

impl EliminatedRow {
    /// Eliminates the pose of a row whose derivatives are taken along the columns of `free`; `damping` are further rows
    /// on the coordinates of the pose, one factor each.
    pub(super) fn of(terms: &RowTerms, free: &DMat, damping: Option<&DVec>) -> Self {
        let (count, coordinates) = terms.by_pose.shape();
        let extra = damping.map_or(0, |_| coordinates);
        let mut by_pose = terms.by_pose.clone().resize_vertically(count + extra, 0.0);
        if let Some(damping) = damping {
            for c in 0..coordinates {
                by_pose[(count + c, c)] = damping[c];
            }
        }
        let mut right = DMat::zeros(count + extra, free.ncols() + 1);
        right.view_mut((0, 0), (count, free.ncols())).copy_from(&(&terms.by_unknowns * free));
        right.view_mut((0, free.ncols()), (count, 1)).copy_from(&terms.residuals);

        let factors = by_pose.qr();
        factors.q_tr_mul(&mut right);
        let height = right.nrows();
        let split = coordinates.min(height);
        let lower = right.rows(split, height - split).into_owned();
        Self {
            net: lower.columns(0, free.ncols()).into_owned(),
            residuals: lower.column(free.ncols()).into_owned(),
            directions: None,
            triangle: factors.r(),
            upper_residuals: right.view((0, free.ncols()), (split, 1)).column(0).into_owned(),
            upper: right.view((0, 0), (split, free.ncols())).into_owned(),
        }
    }

    /// Eliminates the pose without damping, and keeps the directions of the data that it does not reach.
    pub(super) fn with_directions(terms: &RowTerms, free: &DMat) -> Self {
        let (count, coordinates) = terms.by_pose.shape();
        let mut transposed = DMat::identity(count, count);
        terms.by_pose.clone().qr().q_tr_mul(&mut transposed);
        let directions = transposed.rows(coordinates.min(count), count - coordinates.min(count)).transpose();
        Self { directions: Some(directions), ..Self::of(terms, free, None) }
    }

    /// True if the data of the row fix its pose.
    pub(super) fn fixes_pose(&self) -> bool {
        let diagonal = self.triangle.diagonal().abs();
        self.triangle.is_square() && diagonal.min() > OPEN_POSE * diagonal.max()
    }

    /// Step of the pose for a step of the unknowns; zero for a pose that is not fixed.
    pub(super) fn pose_step(&self, step: &DVec) -> DVec {
        let right = -(&self.upper_residuals + &self.upper * step);
        let count = self.triangle.ncols();
        self.triangle.solve_upper_triangular(&right).unwrap_or_else(|| DVec::zeros(count))
    }
}

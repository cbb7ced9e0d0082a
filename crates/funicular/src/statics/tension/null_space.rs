//! All tensions that satisfy the linear balance: one solution, and the directions in which it may change.

use crate::math::Vec6;
use crate::statics::free_motion::SpannedWrenches;

/// Condition number of the balance beyond which the cables do not span the degrees of freedom.
const SINGULAR: f64 = 1e10;

/// Maximum share of the load along the motions that the cables leave free at which the load counts as balanced there.
/// Rounding leaves 1e-16 times the number of operations; the search for tensions ends at a residual of 1e-12.
const BALANCED_ALONG_FREE: f64 = 1e-12;

/// Solutions σ of `Cᵀ σ = b`, C with a row per cable and a column per degree of freedom: `σ = particular + N z`, N
/// orthonormal. If the rows of `Cᵀ` are dependent and b is in their range, the balance is that in the wrenches which
/// the cables span.
pub(super) struct Solutions {
    cables: usize,
    /// Number of independent equations.
    dof: usize,
    /// Orthonormal wrenches that the cables span, one per equation; `None` if they span all degrees of freedom.
    spanned: Option<Vec<Vec6>>,
    /// Orthogonal matrix, by columns: the first ones span the rows of the balance; the others, if present, are N.
    basis: Vec<f64>,
    /// Upper triangle R of `C = basis R`, by columns.
    triangle: [[f64; 6]; 6],
    /// Solution of minimum norm.
    pub particular: Vec<f64>,
}

impl Solutions {
    /// Solutions from the wrench per unit tension of every cable (its first `dof` components), each divided by its
    /// scale, and the wrench b in `right`. `None` at a singular pose whose load the cables cannot balance. The
    /// `directions` N take memory in proportion to the square of the number of cables.
    pub(super) fn of(columns: &[Vec6], scales: &[f64], right: &Vec6, dof: usize, directions: bool) -> Option<Self> {
        Self::independent(columns, scales, right, dof, directions)
            .or_else(|| Self::dependent(columns, scales, right, dof, directions))
    }

    /// Solutions of the balance in the wrenches that the cables span; `None` if they span all, or if the load has
    /// another part.
    fn dependent(columns: &[Vec6], scales: &[f64], right: &Vec6, dof: usize, directions: bool) -> Option<Self> {
        let SpannedWrenches { spanned, free } = SpannedWrenches::of(columns, dof);
        let unbalanced = free.iter().map(|free| free.dot(right).abs()).fold(0.0, f64::max);
        let is_balanced = unbalanced <= BALANCED_ALONG_FREE * right.norm();
        if spanned.is_empty() || free.is_empty() || !is_balanced {
            return None;
        }

        let along = |wrench: &Vec6| Vec6::from_fn(|k, _| spanned.get(k).map_or(0.0, |of| of.dot(wrench)));
        let columns: Vec<Vec6> = columns.iter().map(along).collect();
        let all = Self::independent(&columns, scales, &along(right), spanned.len(), directions)?;
        Some(Self { spanned: Some(spanned), ..all })
    }

    /// Solutions of a balance whose equations are independent; `None` if they are not.
    fn independent(columns: &[Vec6], scales: &[f64], right: &Vec6, dof: usize, directions: bool) -> Option<Self> {
        let cables = columns.len();
        if cables < dof {
            return None;
        }

        // Columns of the transposed balance.
        let mut reflectors = vec![0.0; cables * dof];
        for j in 0..dof {
            for i in 0..cables {
                reflectors[j * cables + i] = columns[i][j] / scales[i];
            }
        }

        // Householder's QR.
        let mut triangle = [[0.0; 6]; 6];
        for j in 0..dof {
            let (done, rest) = reflectors.split_at_mut((j + 1) * cables);
            let here = &mut done[j * cables..];
            triangle[j][..j].copy_from_slice(&here[..j]);
            let length = here[j..].iter().map(|x| x * x).sum::<f64>().sqrt();
            triangle[j][j] = if here[j] > 0.0 { -length } else { length };
            here[..j].fill(0.0);
            here[j] -= triangle[j][j];
            let squared = here[j..].iter().map(|x| x * x).sum::<f64>();
            if squared.is_nan() || squared <= 0.0 {
                return None;
            }
            let scale = (2.0 / squared).sqrt();
            here[j..].iter_mut().for_each(|x| *x *= scale);
            rest.chunks_exact_mut(cables).for_each(|column| reflect(&here[j..], &mut column[j..]));
        }

        // Q from the reflectors.
        let mut basis = vec![0.0; cables * if directions { cables } else { dof }];
        for (k, column) in basis.chunks_exact_mut(cables).enumerate() {
            column[k] = 1.0;
            for j in (0..dof).rev() {
                reflect(&reflectors[j * cables + j..(j + 1) * cables], &mut column[j..]);
            }
        }
        if condition(&triangle, dof) > SINGULAR {
            return None;
        }

        // Rᵀ y = b.
        let mut y = [0.0; 6];
        for j in 0..dof {
            y[j] = (right[j] - (0..j).map(|k| triangle[j][k] * y[k]).sum::<f64>()) / triangle[j][j];
        }

        let mut particular = vec![0.0; cables];
        for (y, column) in y.iter().zip(basis.chunks_exact(cables)).take(dof) {
            particular.iter_mut().zip(column).for_each(|(p, q)| *p += y * q);
        }
        Some(Self { cables, dof, spanned: None, basis, triangle, particular })
    }

    /// Number of independent equations.
    pub(super) fn dof(&self) -> usize {
        self.dof
    }

    /// True if N has been formed; [`Self::part`], [`Self::direction`], [`Self::along`] and [`Self::at`] need it.
    pub(super) fn has_directions(&self) -> bool {
        self.basis.len() == self.cables * self.cables
    }

    /// Participation of cable `i` in the balance: a row of an orthonormal basis of C's columns.
    pub(super) fn balance(&self, i: usize) -> Vec6 {
        Vec6::from_fn(|k, _| if k < self.dof { self.basis[k * self.cables + i] } else { 0.0 })
    }

    /// Solution nearest to a vector.
    pub(super) fn projected(&self, sigma: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut nearest: Vec<f64> = (0..self.cables).map(sigma).collect();
        // Twice: the second pass removes the rounding of the first.
        for _ in 0..2 {
            for column in self.basis.chunks_exact(self.cables).take(self.dof) {
                let along: f64 = column.iter().zip(&nearest).map(|(q, s)| q * s).sum();
                nearest.iter_mut().zip(column).for_each(|(s, q)| *s -= along * q);
            }
        }
        nearest.iter_mut().zip(&self.particular).for_each(|(s, p)| *s += p);
        nearest
    }

    /// Number of directions.
    pub(super) fn redundancy(&self) -> usize {
        self.cables - self.dof
    }

    /// Participation of cable `i` in each of the directions: a row of N.
    pub(super) fn part(&self, i: usize) -> impl Iterator<Item = &f64> {
        // Without a direction nothing is left to skip.
        self.basis[self.dof * self.cables..].iter().skip(i).step_by(self.cables)
    }

    /// Direction `k`, a column of N.
    pub(super) fn direction(&self, k: usize) -> &[f64] {
        &self.basis[(self.dof + k) * self.cables..][..self.cables]
    }

    /// Components `Nᵀ σ` of a vector along the directions.
    pub(super) fn along(&self, sigma: impl Fn(usize) -> f64) -> Vec<f64> {
        self.basis[self.dof * self.cables..]
            .chunks_exact(self.cables)
            .map(|column| column.iter().enumerate().map(|(i, q)| q * sigma(i)).sum())
            .collect()
    }

    /// Solution with these components.
    pub(super) fn at(&self, z: &[f64]) -> Vec<f64> {
        let mut sigma = self.particular.clone();
        for (z, column) in z.iter().zip(self.basis[self.dof * self.cables..].chunks_exact(self.cables)) {
            sigma.iter_mut().zip(column).for_each(|(s, q)| *s += z * q);
        }
        sigma
    }

    /// Vector y that minimises `|g − C y|`: the Lagrange multipliers of the balance if g is the gradient of the
    /// objective.
    pub(super) fn multipliers(&self, g: impl Fn(usize) -> f64) -> Vec6 {
        let mut y = Vec6::zeros();
        for k in (0..self.dof).rev() {
            let column = &self.basis[k * self.cables..(k + 1) * self.cables];
            let along: f64 = column.iter().enumerate().map(|(i, q)| q * g(i)).sum();
            let others: f64 = (k + 1..self.dof).map(|j| self.triangle[j][k] * y[j]).sum();
            y[k] = (along - others) / self.triangle[k][k];
        }
        match &self.spanned {
            Some(spanned) => spanned.iter().zip(&y).map(|(wrench, y)| wrench * *y).sum(),
            None => y,
        }
    }
}

/// Reflection `(I − v vᵀ) x` for a v of length √2.
fn reflect(v: &[f64], x: &mut [f64]) {
    let along: f64 = v.iter().zip(&*x).map(|(v, x)| v * x).sum();
    x.iter_mut().zip(v).for_each(|(x, v)| *x -= along * v);
}

/// Condition number `|R| |R⁻¹|` in Frobenius norms.
fn condition(triangle: &[[f64; 6]; 6], n: usize) -> f64 {
    let mut squared = 0.0;
    for k in 0..n {
        // Column k of the inverse.
        let mut x = [0.0; 6];
        x[k] = 1.0 / triangle[k][k];
        for i in (0..k).rev() {
            x[i] = -(i + 1..=k).map(|j| triangle[j][i] * x[j]).sum::<f64>() / triangle[i][i];
        }
        squared += x.iter().map(|x| x * x).sum::<f64>();
    }
    let size: f64 = triangle.iter().flatten().map(|r| r * r).sum();
    let condition = (size * squared).sqrt();
    if condition.is_nan() { f64::INFINITY } else { condition }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn some_columns() -> Vec<Vec6> {
        (0..8)
            .map(|i| Vec6::from_fn(|j, _| (1.0 + f64::from(i) * 1.7 + j as f64 * (0.9 + f64::from(i))).sin()))
            .collect()
    }

    #[test]
    fn every_solution_solves_and_the_directions_are_orthonormal() {
        let (columns, right) = (some_columns(), Vec6::new(1.0, -2.0, 0.3, 4.0, 0.0, -1.0));
        for n in [3, 6] {
            let scales: Vec<f64> = (0..8).map(|i| 1.0 + 0.1 * f64::from(i)).collect();
            let all = Solutions::of(&columns, &scales, &right, n, true).unwrap();
            let z: Vec<f64> = (0..all.redundancy()).map(|k| 0.5 - k as f64).collect();
            assert_eq!(z.len(), 8 - n);
            let sigma = all.at(&z);
            for j in 0..n {
                let sum: f64 = (0..8).map(|i| columns[i][j] / scales[i] * sigma[i]).sum();
                assert!((sum - right[j]).abs() < 1e-13, "{sum} {}", right[j]);
            }
            let back = all.along(|i| sigma[i]);
            assert!(back.iter().zip(&z).all(|(a, b)| (a - b).abs() < 1e-13), "{back:?}");
            let same = all.projected(|i| sigma[i]);
            assert!(same.iter().zip(&sigma).all(|(a, b)| (a - b).abs() < 1e-13), "{same:?}");
            let y = all.multipliers(|i| (0..n).map(|j| columns[i][j] / scales[i] * (1.0 + j as f64)).sum());
            assert!((0..n).all(|j| (y[j] - 1.0 - j as f64).abs() < 1e-11), "{y}");
        }
    }

    #[test]
    fn dependent_columns_are_solved_if_the_load_is_in_their_range_and_singular_otherwise() {
        let mut columns = some_columns();
        for column in &mut columns {
            column[4] = 2.0 * column[1] - column[0];
        }
        let mut right = Vec6::new(1.0, -2.0, 0.3, 4.0, 0.0, -1.0);
        assert!(Solutions::of(&columns, &[1.0; 8], &right, 6, true).is_none());
        assert!(Solutions::of(&columns, &[1.0; 8], &right, 4, true).is_some_and(|all| all.dof() == 4));

        right[4] = 2.0 * right[1] - right[0];
        let scales: Vec<f64> = (0..8).map(|i| 1.0 + 0.1 * f64::from(i)).collect();
        let all = Solutions::of(&columns, &scales, &right, 6, true).unwrap();
        assert_eq!((all.dof(), all.redundancy()), (5, 3));
        let sigma = all.at(&[0.3, -0.2, 0.7]);
        for j in 0..6 {
            let sum: f64 = (0..8).map(|i| columns[i][j] / scales[i] * sigma[i]).sum();
            assert!((sum - right[j]).abs() < 1e-13, "{sum} {}", right[j]);
        }
        // The multipliers give back a gradient that is a combination of the columns, by a wrench that they span.
        let gradient = |i: usize| (0..6).map(|j| columns[i][j] / scales[i] * (1.0 + j as f64)).sum::<f64>();
        let y = all.multipliers(gradient);
        for i in 0..8 {
            let back: f64 = (0..6).map(|j| columns[i][j] / scales[i] * y[j]).sum();
            assert!((back - gradient(i)).abs() < 1e-11, "{back} {}", gradient(i));
        }
    }
}

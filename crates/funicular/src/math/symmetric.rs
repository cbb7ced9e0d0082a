//! Eigenvalues of real symmetric matrices, and their signs by congruence.

use super::{Mat3, Mat6, Vec3, Vec6, order};

/// Number of negative eigenvalues of the leading `n`×`n` block of the symmetric `matrix`, which must be scaled.
///
/// See [`negative_eigenvalues_in`].
pub(crate) fn negative_eigenvalues(matrix: &Mat6, n: usize) -> usize {
    let mut a = [0.0; 36];
    for j in 0..n {
        for i in 0..n {
            a[j * n + i] = matrix[(i, j)];
        }
    }
    negative_eigenvalues_in(&mut a[..n * n], n)
}

/// Number of negative eigenvalues of a symmetric `n`×`n` matrix, given by columns and overwritten.
///
/// Symmetric indefinite factorisation with pivots of 1×1 and 2×2 (Bunch and Parlett 1971, complete pivoting): by
/// Sylvester's law the pivots have the signs of the eigenvalues. Complete pivoting keeps small eigenvalues accurate
/// beside very large ones. A zero matrix counts as positive.
///
/// # References
/// J. R. Bunch, B. N. Parlett, SIAM J. Numer. Anal. 8(4), 1971.
pub(crate) fn negative_eigenvalues_in(a: &mut [f64], n: usize) -> usize {
    // (1 + √17)/8 bounds the growth of the elements for both pivot sizes.
    const ALPHA: f64 = 0.640_388_203_202_208;
    assert_eq!(a.len(), n * n, "a square matrix");

    let mut negative = 0;
    let mut k = 0;
    while k < n {
        // Largest entries on and off the diagonal.
        let (mut diagonal, mut at) = (-1.0, k);
        let (mut off, mut row, mut column) = (-1.0, k, k);
        for j in k..n {
            let entry = a[j * n + j].abs();
            if entry > diagonal {
                (diagonal, at) = (entry, j);
            }
            for i in j + 1..n {
                let entry = a[j * n + i].abs();
                if entry > off {
                    (off, row, column) = (entry, i, j);
                }
            }
        }

        // A 1×1 pivot, or a 2×2 block.
        if diagonal >= ALPHA * off {
            if diagonal <= 0.0 {
                break;
            }
            swap_both(a, n, k, at);
            let pivot = a[k * n + k];
            negative += usize::from(pivot < 0.0);
            for j in k + 1..n {
                let factor = a[k * n + j] / pivot;
                for i in j..n {
                    a[j * n + i] -= a[k * n + i] * factor;
                }
            }
            k += 1;
        } else {
            swap_both(a, n, k, column);
            swap_both(a, n, k + 1, row);
            // The off-diagonal entry dominates: one eigenvalue of either sign.
            negative += 1;
            let (p, q, r) = (a[k * n + k], a[k * n + k + 1], a[(k + 1) * n + k + 1]);
            let determinant = p * r - q * q;
            for j in k + 2..n {
                let (u, v) = (a[k * n + j], a[(k + 1) * n + j]);
                let (s, t) = ((r * u - q * v) / determinant, (p * v - q * u) / determinant);
                for i in j..n {
                    a[j * n + i] -= a[k * n + i] * s + a[(k + 1) * n + i] * t;
                }
            }
            k += 2;
        }
    }
    negative
}

/// Exchanges rows and columns `i` ≤ `j` of a symmetric matrix of which only the lower triangle is up to date.
fn swap_both(a: &mut [f64], n: usize, i: usize, j: usize) {
    if i == j {
        return;
    }
    for k in 0..i {
        a.swap(k * n + i, k * n + j);
    }
    for k in i + 1..j {
        a.swap(i * n + k, k * n + j);
    }
    for k in j + 1..n {
        a.swap(i * n + k, j * n + k);
    }
    a.swap(i * n + i, j * n + j);
}

/// Eigenvalues, in ascending order, of the leading `n`×`n` block of a symmetric matrix.
pub fn eigenvalues(matrix: &Mat6, n: usize) -> Vec<f64> {
    let mut values: Vec<f64> = if n == 6 {
        matrix.symmetric_eigenvalues().iter().copied().collect()
    } else {
        matrix.view((0, 0), (n, n)).clone_owned().symmetric_eigenvalues().iter().copied().collect()
    };
    values.sort_by(f64::total_cmp);
    values
}

/// Eigenvalues (in ascending order) and eigenvectors (columns) of the leading `n`×`n` block of a symmetric matrix; the
/// other entries of the vectors are zero.
pub fn eigen(matrix: &Mat6, n: usize) -> (Vec<f64>, Vec<Vec6>) {
    let (values, vectors) = if n == 6 {
        let all = matrix.symmetric_eigen();
        (all.eigenvalues.iter().copied().collect::<Vec<f64>>(), all.eigenvectors)
    } else {
        let some = matrix.view((0, 0), (n, n)).clone_owned().symmetric_eigen();
        let mut vectors = Mat6::zeros();
        vectors.view_mut((0, 0), (n, n)).copy_from(&some.eigenvectors);
        (some.eigenvalues.iter().copied().collect(), vectors)
    };
    let order = order::ascending(&values);
    (order.iter().map(|&i| values[i]).collect(), order.iter().map(|&i| vectors.column(i).clone_owned()).collect())
}

/// Largest eigenvalue of a symmetric matrix with its eigenvector; of the two senses the one whose largest component is
/// positive.
pub fn largest_principal(matrix: &Mat3) -> (f64, Vec3) {
    let eigen = matrix.symmetric_eigen();
    let largest = eigen.eigenvalues.imax();
    let vector: Vec3 = eigen.eigenvectors.column(largest).into();
    (eigen.eigenvalues[largest], vector * vector[vector.iamax()].signum())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_saddle_without_diagonal_has_one_negative_eigenvalue() {
        let mut a = Mat6::zeros();
        a[(0, 1)] = 1.0;
        a[(1, 0)] = 1.0;
        assert_eq!(negative_eigenvalues(&a, 2), 1);
    }

    #[test]
    fn a_large_rank_one_term_does_not_hide_small_eigenvalues() {
        // 1e9 u uᵀ beside eigenvalues ±1e-3 on the complement, in a turned basis.
        let u = Vec6::new(1.0, 2.0, -1.0, 0.5, 0.3, -2.0).normalize();
        let projector = Mat6::identity() - u * u.transpose();
        let small = Mat6::from_diagonal(&Vec6::new(1.0, -1.0, 2.0, -2.0, 3.0, 4.0)) * 1e-3;
        let a = projector * small * projector + u * u.transpose() * 1e9;
        let (values, _) = eigen(&(projector * small * projector + u * u.transpose()), 6);
        assert_eq!(negative_eigenvalues(&a, 6), values.iter().filter(|v| **v < 0.0).count());
    }

    proptest! {
        #[test]
        fn the_count_equals_that_of_the_eigenvalues(entries in prop::array::uniform21(-1.0f64..1.0), n in 1usize..=6) {
            let mut a = Mat6::zeros();
            let mut next = entries.iter();
            for j in 0..6 {
                for i in j..6 {
                    a[(i, j)] = *next.next().unwrap();
                    a[(j, i)] = a[(i, j)];
                }
            }
            let (values, _) = eigen(&a, n);
            prop_assume!(values.iter().all(|v| v.abs() > 1e-9));
            prop_assert_eq!(negative_eigenvalues(&a, n), values.iter().filter(|v| **v < 0.0).count());
        }
    }
}

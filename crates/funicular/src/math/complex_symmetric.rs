//! Complex symmetric matrices: vectors that are orthogonal by them without conjugates.
//!
//! Damped motions are orthogonal in this sense: the matrices of a robot with losses are symmetric and complex. A vector
//! that is orthogonal to itself has no partner: there two motions are one.

use super::{CDMat, Complex};

/// Square of a vector without conjugates, over the sum of the sizes of its terms, below which it counts as orthogonal
/// to itself. Motions with light damping have about one; half of the digits are left at 1e-8.
const MIN_SQUARE: f64 = 1e-8;

/// Maximum number of sweeps of rotations; five are usual.
const MAX_SWEEPS: usize = 40;

/// Vectors `V`, by columns, with `VᵀGV = 1` for a complex symmetric matrix `G`; `None` if a vector is orthogonal to
/// itself.
pub(crate) fn orthogonalised(matrix: &CDMat) -> Option<CDMat> {
    let n = matrix.nrows();
    let mut vectors = CDMat::identity(n, n);
    for k in 0..n {
        // The vector with the largest square comes next; where all squares are small, the sum of two vectors has one.
        let square = |vectors: &CDMat, i: usize, j: usize| -> Complex {
            (vectors.column(i).transpose() * matrix * vectors.column(j))[(0, 0)]
        };
        let best = |vectors: &CDMat| {
            (k..n).max_by(|a, b| square(vectors, *a, *a).norm().total_cmp(&square(vectors, *b, *b).norm()))
        };
        let mut pivot = best(&vectors)?;
        let of_pair = |vectors: &CDMat| {
            let pairs = (k..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
            pairs.max_by(|a, b| square(vectors, a.0, a.1).norm().total_cmp(&square(vectors, b.0, b.1).norm()))
        };
        if let Some((i, j)) = of_pair(&vectors)
            && square(&vectors, i, j).norm() > 2.0 * square(&vectors, pivot, pivot).norm()
        {
            let sum = vectors.column(i) + vectors.column(j);
            vectors.set_column(i, &sum);
            pivot = i;
        }
        let value = square(&vectors, pivot, pivot);
        if value.norm() <= MIN_SQUARE * size_of_terms(matrix, &vectors, pivot) {
            return None;
        }

        vectors.swap_columns(k, pivot);
        let scaled = vectors.column(k) / value.sqrt();
        vectors.set_column(k, &scaled);
        for j in k + 1..n {
            let part = square(&vectors, k, j);
            let rest = vectors.column(j) - &scaled * part;
            vectors.set_column(j, &rest);
        }
    }
    Some(vectors)
}

/// Sum of the sizes of the terms of a square of a vector.
fn size_of_terms(matrix: &CDMat, vectors: &CDMat, k: usize) -> f64 {
    let of = |i: usize, j: usize| vectors[(i, k)].norm() * matrix[(i, j)].norm() * vectors[(j, k)].norm();
    (0..matrix.nrows()).map(|i| (0..matrix.nrows()).map(|j| of(i, j)).sum::<f64>()).sum()
}

/// Diagonal of `VᵀAV` for a complex symmetric matrix `A`, and `V` with `VᵀV = 1`, until entries beside the diagonal are
/// at most `tolerance`; values within it are zero. `None` if two eigenvectors are one.
pub(crate) fn diagonalised(mut matrix: CDMat, tolerance: f64) -> Option<(Vec<Complex>, CDMat)> {
    let n = matrix.nrows();
    let mut vectors = CDMat::identity(n, n);
    for _ in 0..MAX_SWEEPS {
        let mut turned = false;
        for i in 0..n {
            for j in i + 1..n {
                if matrix[(i, j)].norm() <= tolerance {
                    continue;
                }
                let (c, s) = rotation(matrix[(i, i)], matrix[(i, j)], matrix[(j, j)])?;
                let mut turn = CDMat::identity(n, n);
                (turn[(i, i)], turn[(j, j)], turn[(i, j)], turn[(j, i)]) = (c, c, s, -s);
                matrix = turn.transpose() * matrix * &turn;
                vectors *= turn;
                turned = true;
            }
        }
        if !turned {
            let zero = Complex::new(0.0, 0.0);
            let value = |k: usize| if matrix[(k, k)].norm() <= tolerance { zero } else { matrix[(k, k)] };
            return Some(((0..n).map(value).collect(), vectors));
        }
    }
    None
}

/// Cosine and sine of the complex rotation that makes the matrix `[a b; b d]` diagonal; `None` if it has one
/// eigenvector.
fn rotation(a: Complex, b: Complex, d: Complex) -> Option<(Complex, Complex)> {
    // The tangent t solves t² + 2ht − 1 = 0 with h = (d − a)/2b; the smaller root turns least.
    let half = (d - a) / (2.0 * b);
    let root = (half * half + 1.0).sqrt();
    let sums = [half + root, half - root];
    let tangent = 1.0 / if sums[0].norm() >= sums[1].norm() { sums[0] } else { sums[1] };
    let square = tangent * tangent + 1.0;
    if square.norm() <= MIN_SQUARE.sqrt() {
        return None;
    }
    let cosine = 1.0 / square.sqrt();
    Some((cosine, tangent * cosine))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(entries: [[(f64, f64); 3]; 3]) -> CDMat {
        CDMat::from_fn(3, 3, |i, j| Complex::new(entries[i][j].0, entries[i][j].1))
    }

    fn example() -> CDMat {
        matrix([
            [(0.0, 0.0), (2.0, 0.3), (0.1, -0.4)],
            [(2.0, 0.3), (0.0, 0.0), (0.7, 0.2)],
            [(0.1, -0.4), (0.7, 0.2), (-1.0, 0.5)],
        ])
    }

    #[test]
    fn vectors_are_orthogonal_without_conjugates() {
        // The first two squares are zero, so that only a sum of vectors has one.
        let vectors = orthogonalised(&example()).unwrap();
        let product = vectors.transpose() * example() * &vectors;
        assert!((product - CDMat::identity(3, 3)).norm() < 1e-13);
    }

    #[test]
    fn rotations_leave_eigenvalues_on_the_diagonal() {
        let (values, vectors) = diagonalised(example(), 1e-14).unwrap();
        assert!((vectors.transpose() * &vectors - CDMat::identity(3, 3)).norm() < 1e-12);
        for (k, value) in values.iter().enumerate() {
            let gap = example() * vectors.column(k) - vectors.column(k) * *value;
            assert!(gap.norm() < 1e-12, "{k}: {gap}");
        }
    }

    #[test]
    fn a_single_eigenvector_is_told() {
        let i = Complex::i();
        let defective = CDMat::from_row_slice(2, 2, &[1.0.into(), i, i, (-1.0).into()]);
        assert!(diagonalised(defective.clone(), 1e-12).is_none());
        let null = CDMat::from_row_slice(2, 2, &[1.0.into(), i, i, (-1.0).into()]);
        assert!(orthogonalised(&null).is_none());
    }
}

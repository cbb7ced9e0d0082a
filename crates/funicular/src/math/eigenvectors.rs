//! Eigenvalues and eigenvectors of a real matrix without symmetry.

use super::{CDMat, Complex, DMat};

/// Eigenvalues of a real matrix whose imaginary part is not negative, with an eigenvector each. The others are their
/// conjugates.
pub(crate) struct UpperEigen {
    /// Eigenvalues, not ordered.
    pub(crate) values: Vec<Complex>,
    /// Eigenvectors of length 1, one column per eigenvalue.
    pub(crate) vectors: CDMat,
}

/// Maximum number of sweeps of the iteration per row of the matrix. About two are usual.
const MAX_SWEEPS: usize = 60;

/// Eigenvalues and eigenvectors of a square matrix by the real Schur form; `None` if the iteration does not end.
///
/// # References
/// G. H. Golub, C. F. Van Loan, Matrix Computations, 4th ed. 2013, sections 7.5 and 7.6.4.
pub(crate) fn upper_eigen(matrix: &DMat) -> Option<UpperEigen> {
    let n = matrix.nrows();
    let (basis, triangular) = matrix.clone().try_schur(f64::EPSILON, MAX_SWEEPS * n + 100)?.unpack();
    let blocks = diagonal_blocks(&triangular);

    // Rounding of the entries decides how near two eigenvalues can be told apart.
    let smallest = f64::EPSILON * triangular.amax().max(f64::MIN_POSITIVE);

    let (mut values, mut columns) = (Vec::new(), Vec::new());
    for at in 0..blocks.len() {
        for value in upper_values(&triangular, blocks[at]) {
            let inner = back_substituted(&triangular, &blocks[..=at], value, smallest);
            let [re, im] = [inner.map(|z| z.re), inner.map(|z| z.im)].map(|part| &basis * part);
            let vector = re.zip_map(&im, Complex::new);
            let length = vector.norm();
            values.push(value);
            columns.push(vector.unscale(length));
        }
    }

    let mut vectors = CDMat::zeros(n, columns.len());
    for (k, column) in columns.iter().enumerate() {
        vectors.column_mut(k).copy_from(&column.column(0));
    }
    Some(UpperEigen { values, vectors })
}

/// First row and size, 1 or 2, of every diagonal block of a quasi-triangular matrix.
fn diagonal_blocks(triangular: &DMat) -> Vec<(usize, usize)> {
    let n = triangular.nrows();
    let mut blocks = Vec::with_capacity(n);
    let mut row = 0;
    while row < n {
        let size = if row + 1 < n && triangular[(row + 1, row)] != 0.0 { 2 } else { 1 };
        blocks.push((row, size));
        row += size;
    }
    blocks
}

/// Eigenvalues of a diagonal block whose imaginary part is not negative.
fn upper_values(triangular: &DMat, (row, size): (usize, usize)) -> Vec<Complex> {
    if size == 1 {
        return vec![triangular[(row, row)].into()];
    }
    let (a, b) = (triangular[(row, row)], triangular[(row, row + 1)]);
    let (c, d) = (triangular[(row + 1, row)], triangular[(row + 1, row + 1)]);
    let (middle, half) = (0.5 * (a + d), 0.5 * (a - d));
    let square = half * half + b * c;
    if square < 0.0 {
        vec![Complex::new(middle, (-square).sqrt())]
    } else {
        let root = square.sqrt();
        vec![(middle + root).into(), (middle - root).into()]
    }
}

/// Eigenvector of the quasi-triangular matrix for an eigenvalue of the last of `blocks`. Pivots below `smallest` are
/// replaced by it, so that a multiple eigenvalue has finite eigenvectors.
fn back_substituted(triangular: &DMat, blocks: &[(usize, usize)], value: Complex, smallest: f64) -> CDMat {
    let n = triangular.nrows();
    let mut vector = CDMat::zeros(n, 1);
    let (&(last, size), before) = blocks.split_last().expect("the eigenvalue belongs to a block");

    // The block of the eigenvalue.
    if size == 1 {
        vector[(last, 0)] = 1.0.into();
    } else {
        let first = Complex::from(triangular[(last, last)]) - value;
        let second = Complex::from(triangular[(last + 1, last + 1)]) - value;
        let (right, below) = (triangular[(last, last + 1)], triangular[(last + 1, last)]);
        if right.abs() + first.norm() >= below.abs() + second.norm() {
            (vector[(last, 0)], vector[(last + 1, 0)]) = (right.into(), -first);
        } else {
            (vector[(last, 0)], vector[(last + 1, 0)]) = (-second, below.into());
        }
    }

    // The blocks above it, from below.
    let end = last + size;
    for &(row, size) in before.iter().rev() {
        let known = |r: usize| -> Complex {
            (row + size..end).map(|column| -vector[(column, 0)] * triangular[(r, column)]).sum()
        };
        let pivot = |z: Complex| if z.norm() < smallest { Complex::from(smallest) } else { z };
        if size == 1 {
            vector[(row, 0)] = known(row) / pivot(triangular[(row, row)] - value);
        } else {
            let (right, below) = (triangular[(row, row + 1)], triangular[(row + 1, row)]);
            let (first, second) = (triangular[(row, row)] - value, triangular[(row + 1, row + 1)] - value);
            let matrix = [[first, right.into()], [below.into(), second]];
            let block = solved(matrix, [known(row), known(row + 1)], pivot);
            (vector[(row, 0)], vector[(row + 1, 0)]) = (block[0], block[1]);
        }
    }
    vector
}

/// Solution of two equations by elimination with complete pivoting, with `pivot` applied to both pivots. At a multiple
/// eigenvalue the equations are singular but consistent: the solution then satisfies them, with any multiple of the
/// null vector, which Cramer's rule would not do.
fn solved(matrix: [[Complex; 2]; 2], right: [Complex; 2], pivot: impl Fn(Complex) -> Complex) -> [Complex; 2] {
    // Row and column of the largest entry.
    let places = [(0, 0), (0, 1), (1, 0), (1, 1)];
    let larger = |a: (usize, usize), b: (usize, usize)| matrix[b.0][b.1].norm() > matrix[a.0][a.1].norm();
    let (i, j) = places.into_iter().fold((0, 0), |most, place| if larger(most, place) { place } else { most });

    // Elimination of the unknown `j` from the other equation.
    let first = pivot(matrix[i][j]);
    let factor = matrix[1 - i][j] / first;
    let second = pivot(matrix[1 - i][1 - j] - factor * matrix[i][1 - j]);

    let mut found = [Complex::from(0.0); 2];
    found[1 - j] = (right[1 - i] - factor * right[i]) / second;
    found[j] = (right[i] - matrix[i][1 - j] * found[1 - j]) / first;
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Maximum of `|A v − λ v|` over all eigenvectors.
    fn residual(matrix: &DMat, found: &UpperEigen) -> f64 {
        let a = matrix.map(Complex::from);
        (0..found.values.len())
            .map(|k| {
                let v = found.vectors.column(k).into_owned();
                (&a * &v - v * found.values[k]).norm()
            })
            .fold(0.0, f64::max)
    }

    #[test]
    fn eigenvectors_of_full_matrices_have_small_residuals() {
        for n in [1, 2, 3, 5, 8, 30] {
            // Fixed numbers without structure.
            let matrix = DMat::from_fn(n, n, |i, j| ((3 * i + 7 * j + i * j) as f64 * 0.618_034).fract() - 0.4);
            let found = upper_eigen(&matrix).unwrap();
            let complex = found.values.iter().filter(|value| value.im > 0.0).count();
            assert_eq!(found.values.len() + complex, n);
            assert!(residual(&matrix, &found) < 1e-12, "{n}: {}", residual(&matrix, &found));
            let trace: f64 = found.values.iter().map(|z| if z.im > 0.0 { 2.0 * z.re } else { z.re }).sum();
            assert!((trace - matrix.trace()).abs() < 1e-12);
        }
    }

    #[test]
    fn oscillators_have_their_frequencies_and_damping_also_if_two_are_equal() {
        // ω = 2 twice and ω = 5, ζ = 0.01; and an overdamped one with the rates 1 and 4.
        let mut matrix = DMat::zeros(8, 8);
        for (k, (omega, zeta)) in [(2.0, 0.01), (2.0, 0.01), (5.0, 0.01), (2.0, 1.25)].into_iter().enumerate() {
            (matrix[(k, 4 + k)], matrix[(4 + k, k)], matrix[(4 + k, 4 + k)]) = (omega, -omega, -2.0 * zeta * omega);
        }
        let found = upper_eigen(&matrix).unwrap();
        assert!(residual(&matrix, &found) < 1e-13, "{:e}", residual(&matrix, &found));
        let mut sizes: Vec<f64> = found.values.iter().map(|z| z.norm()).collect();
        sizes.sort_by(f64::total_cmp);
        for (size, expected) in sizes.iter().zip([1.0, 2.0, 2.0, 4.0, 5.0]) {
            assert!((size - expected).abs() < 1e-12, "{sizes:?}");
        }
        // The two equal ones have independent vectors.
        let equal: Vec<usize> = (0..5).filter(|k| (found.values[*k].norm() - 2.0).abs() < 1e-9).collect();
        let [a, b] = [equal[0], equal[1]].map(|k| found.vectors.column(k).into_owned());
        assert!(a.dotc(&b).norm() < 0.99);
    }
}

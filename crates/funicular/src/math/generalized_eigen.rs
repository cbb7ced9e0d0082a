//! Symmetric-definite pencil `M φ = μ K φ`, and the components of a few vectors along its eigenvectors.
//!
//! For a cable only the participation of its ends in each clamped mode is needed: a few numbers per mode instead of a
//! vector of all unknowns. Every transformation is applied to these few vectors, and no eigenvector is ever formed. K
//! is factored and not M: the large μ = 1/ω² are the low frequencies, and these keep all their digits.

use super::simd::dot;

/// Reduces the pencil `M φ = μ K φ` with K positive definite: eigenvalues μ_k (not ordered), and for each the products
/// `φ_kᵀ b` with every given vector b, φ_k normalised to `φᵀ K φ = 1`.
///
/// `stiffness` and `mass` are n×n by columns, of which the lower triangle is read; `vectors` has n rows of `count`
/// numbers. All three are consumed. `None` if K is not positive definite.
///
/// Steps: Cholesky factor, congruence, Householder's tridiagonal form, implicit QL. The vectors are transformed in
/// blocks of columns.
///
/// # References
/// G. H. Golub, C. F. Van Loan, Matrix Computations, 4th ed. 2013, sections 4.2, 8.3.1, 8.3.3 and 8.7.2.
pub fn pencil(stiffness: Vec<f64>, mass: Vec<f64>, vectors: Vec<f64>, count: usize) -> Option<(Vec<f64>, Vec<f64>)> {
    let n = stiffness.len().isqrt();
    assert!(stiffness.len() == n * n && mass.len() == n * n && vectors.len() == n * count, "shapes agree");
    pulp::Arch::new().dispatch(PencilReduction { n, count, k: stiffness, m: mass, vectors })
}

struct PencilReduction {
    n: usize,
    count: usize,
    k: Vec<f64>,
    m: Vec<f64>,
    vectors: Vec<f64>,
}

impl pulp::NullaryFnOnce for PencilReduction {
    type Output = Option<(Vec<f64>, Vec<f64>)>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        let Self { n, count, mut k, mut m, vectors } = self;
        if !cholesky(&mut k, n) {
            return None;
        }
        congruence(&k, &mut m, n);
        let (mut diagonal, mut below) = (vec![0.0; n], vec![0.0; n]);
        let factors = tridiagonalise(&mut m, n, &mut diagonal, &mut below);

        // The given vectors, block by block.
        let mut blocks = VectorBlocks::of(&vectors, n, count);
        for block in blocks.0.chunks_exact_mut(n.max(1)) {
            solve_rows(&k, n, block);
            reflect(&m, n, &factors, block);
        }
        diagonalise(&mut diagonal, &mut below, &mut blocks);
        Some((diagonal, blocks.into_rows(n, count, vectors)))
    }
}

/// Columns of a block of vectors: two of the widest registers, so that the rows of one block stay in the nearest cache
/// while all transformations pass over them.
const WIDTH: usize = 16;

/// Row of a block.
type BlockRow = [f64; WIDTH];

/// Vectors in blocks of columns: all rows of the first block, then those of the next. The last block is filled with
/// zeros.
struct VectorBlocks(Vec<BlockRow>);

impl VectorBlocks {
    #[inline(always)]
    fn of(vectors: &[f64], n: usize, count: usize) -> Self {
        let mut blocks = vec![[0.0; WIDTH]; n * count.div_ceil(WIDTH)];
        for (i, row) in vectors.chunks_exact(count.max(1)).enumerate() {
            for (b, part) in row.chunks(WIDTH).enumerate() {
                blocks[b * n + i][..part.len()].copy_from_slice(part);
            }
        }
        Self(blocks)
    }

    /// Rows of `count` numbers, in the memory of `rows`.
    #[inline(always)]
    fn into_rows(self, n: usize, count: usize, mut rows: Vec<f64>) -> Vec<f64> {
        for (i, row) in rows.chunks_exact_mut(count.max(1)).enumerate() {
            for (b, part) in row.chunks_mut(WIDTH).enumerate() {
                part.copy_from_slice(&self.0[b * n + i][..part.len()]);
            }
        }
        rows
    }
}

/// Adds `factor x` to a row.
#[inline(always)]
fn add_row(y: &mut BlockRow, factor: f64, x: &BlockRow) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += factor * x;
    }
}

/// Adds `factor x` to y.
#[inline(always)]
fn add_scaled(y: &mut [f64], factor: f64, x: &[f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += factor * x;
    }
}

/// Cholesky factorisation in place of the lower triangle; false if a pivot is not positive.
#[inline(always)]
fn cholesky(a: &mut [f64], n: usize) -> bool {
    for k in 0..n {
        let (left, right) = a.split_at_mut((k + 1) * n);
        let column = &mut left[k * n..];
        let pivot = column[k];
        if pivot.is_nan() || pivot <= 0.0 {
            return false;
        }
        let inverse = 1.0 / pivot.sqrt();
        column[k..].iter_mut().for_each(|x| *x *= inverse);
        for (j, other) in right.chunks_exact_mut(n).enumerate() {
            let j = k + 1 + j;
            add_scaled(&mut other[j..], -column[j], &column[j..]);
        }
    }
    true
}

/// Solves in place: block ← L⁻¹ block.
#[inline(always)]
fn solve_rows(l: &[f64], n: usize, block: &mut [BlockRow]) {
    for j in 0..n {
        let (done, rest) = block.split_at_mut(j + 1);
        let row = &mut done[j];
        for x in row.iter_mut() {
            *x /= l[j * n + j];
        }
        for (other, entry) in rest.iter_mut().zip(&l[j * n + j + 1..(j + 1) * n]) {
            add_row(other, -entry, row);
        }
    }
}

/// Congruence in place: a ← L⁻¹ a L⁻ᵀ, lower triangle.
#[inline(always)]
fn congruence(l: &[f64], a: &mut [f64], n: usize) {
    for k in 0..n {
        let (left, right) = a.split_at_mut((k + 1) * n);
        let column = &mut left[k * n..];
        let factor = &l[k * n..(k + 1) * n];
        let pivot = factor[k];
        column[k] /= pivot * pivot;

        let half = -0.5 * column[k];
        let (column, factor) = (&mut column[k + 1..], &factor[k + 1..]);
        for x in column.iter_mut() {
            *x /= pivot;
        }
        add_scaled(column, half, factor);

        // Remaining rows and columns, in one pass.
        for (j, other) in right.chunks_exact_mut(n).enumerate() {
            let (c, f) = (column[j], factor[j]);
            for ((x, a), b) in other[k + 1 + j..].iter_mut().zip(&factor[j..]).zip(&column[j..]) {
                *x -= c * a + f * b;
            }
        }
        add_scaled(column, half, factor);
        for j in 0..column.len() {
            let at = k + 1 + j;
            let (done, rest) = column.split_at_mut(j + 1);
            done[j] /= l[at * n + at];
            add_scaled(rest, -done[j], &l[at * n + at + 1..(at + 1) * n]);
        }
    }
}

/// Householder reflections `H = I − β v vᵀ` to tridiagonal form. The vectors v replace the columns of `a` below the
/// diagonal; the result are the factors β, zero where there is no reflection.
#[inline(always)]
fn tridiagonalise(a: &mut [f64], n: usize, diagonal: &mut [f64], below: &mut [f64]) -> Vec<f64> {
    let (mut v, mut w, mut factors) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    for k in 0..n {
        diagonal[k] = a[k * n + k];
        if k + 1 >= n {
            break;
        }

        // The column below the diagonal.
        let rest = n - k - 1;
        let (v, w) = (&mut v[..rest], &mut w[..rest]);
        v.copy_from_slice(&a[k * n + k + 1..(k + 1) * n]);
        let tail = dot(&v[1..], &v[1..]);
        if tail == 0.0 {
            below[k] = v[0];
            continue;
        }

        // H = I − β v vᵀ sends the column to α e₁.
        let norm = (v[0] * v[0] + tail).sqrt();
        let alpha = if v[0] > 0.0 { -norm } else { norm };
        v[0] -= alpha;
        let beta = 2.0 / (v[0] * v[0] + tail);
        (below[k], factors[k]) = (alpha, beta);

        // w = β A v from the lower triangle: every column serves as column and as row.
        w.fill(0.0);
        for j in 0..rest {
            let column = &a[(k + 1 + j) * n + k + 1 + j..(k + 2 + j) * n];
            w[j] += column[0] * v[j] + dot(&column[1..], &v[j + 1..]);
            add_scaled(&mut w[j + 1..], v[j], &column[1..]);
        }
        for x in w.iter_mut() {
            *x *= beta;
        }

        let half = -0.5 * beta * dot(v, w);
        add_scaled(w, half, v);

        // A ← A − v wᵀ − w vᵀ.
        for j in 0..rest {
            let (vj, wj) = (v[j], w[j]);
            let column = &mut a[(k + 1 + j) * n + k + 1 + j..(k + 2 + j) * n];
            for ((x, v), w) in column.iter_mut().zip(&v[j..]).zip(&w[j..]) {
                *x -= v * wj + w * vj;
            }
        }

        a[k * n + k + 1..(k + 1) * n].copy_from_slice(v);
    }
    factors
}

/// Applies the reflections of [`tridiagonalise`] to a block.
#[inline(always)]
fn reflect(a: &[f64], n: usize, factors: &[f64], block: &mut [BlockRow]) {
    for (k, beta) in factors.iter().enumerate().filter(|(_, beta)| **beta != 0.0) {
        let (v, rows) = (&a[k * n + k + 1..(k + 1) * n], &mut block[k + 1..]);
        let mut sums = [0.0; WIDTH];
        for (row, v) in rows.iter().zip(v) {
            add_row(&mut sums, *v, row);
        }
        for (row, v) in rows.iter_mut().zip(v) {
            add_row(row, -beta * v, &sums);
        }
    }
}

/// Rotations of neighbouring rows, in passes from a row upwards.
#[derive(Default)]
struct Rotations {
    /// First row and number of rotations of each pass.
    passes: Vec<(usize, usize)>,
    /// Cosine and sine of each rotation.
    angles: Vec<(f64, f64)>,
}

/// Rotations that are kept before they are applied: their 16 kB stay in the nearest cache beside a block.
const MAX_ROTATIONS: usize = 1024;

impl Rotations {
    /// Applies the rotations. A row that two of them share stays in registers between them.
    // No closures: only functions that are inlined are compiled for the registers that the processor has.
    #[inline(always)]
    fn apply(&self, blocks: &mut VectorBlocks, n: usize) {
        for block in blocks.0.chunks_exact_mut(n.max(1)) {
            let mut done = 0;
            for (first, count) in &self.passes {
                let mut high = block[*first];
                for (k, (c, s)) in self.angles[done..done + count].iter().enumerate() {
                    let i = first - 1 - k;
                    let mut low = block[i];
                    for (low, high) in low.iter_mut().zip(&mut high) {
                        (*low, *high) = (c * *low - s * *high, s * *low + c * *high);
                    }
                    block[i + 1] = high;
                    high = low;
                }
                block[first - count] = high;
                done += count;
            }
        }
    }

    fn clear(&mut self) {
        self.passes.clear();
        self.angles.clear();
    }
}

/// Implicit QL with Wilkinson's shift; the rotations also act on the rows of the blocks.
#[inline(always)]
fn diagonalise(d: &mut [f64], e: &mut [f64], blocks: &mut VectorBlocks) {
    let n = d.len();
    let mut rotations = Rotations::default();
    for l in 0..n {
        // Two or three passes per eigenvalue; 60 is a guard that only rounding could reach.
        for _ in 0..60 {
            // Find the end of the block that does not split.
            let split = (l..n - 1)
                .find(|&m| e[m].abs() <= f64::EPSILON * (d[m].abs() * d[m + 1].abs()).sqrt())
                .unwrap_or(n - 1);
            if split == l {
                break;
            }

            // The shift.
            let g = (d[l + 1] - d[l]) / (2.0 * e[l]);
            let mut g = d[split] - d[l] + e[l] / (g + (g * g + 1.0).sqrt().copysign(g));
            let (mut s, mut c, mut p) = (1.0, 1.0, 0.0);
            let mut deflated = false;
            let before = rotations.angles.len();

            // The rotations.
            for i in (l..split).rev() {
                let (f, b) = (s * e[i], c * e[i]);
                let r = (f * f + g * g).sqrt();
                e[i + 1] = r;
                if r == 0.0 {
                    d[i + 1] -= p;
                    deflated = true;
                    break;
                }
                (s, c) = (f / r, g / r);
                g = d[i + 1] - p;
                let r = (d[i] - g) * s + 2.0 * c * b;
                p = s * r;
                d[i + 1] = g + p;
                g = c * r - b;
                rotations.angles.push((c, s));
            }
            rotations.passes.push((split, rotations.angles.len() - before));
            if rotations.angles.len() > MAX_ROTATIONS {
                rotations.apply(blocks, n);
                rotations.clear();
            }

            if !deflated {
                d[l] -= p;
                e[l] = g;
            }
            e[split] = 0.0;
        }
    }
    rotations.apply(blocks, n);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::DMat;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn values_and_products_are_those_of_the_full_decomposition(
            n in 1usize..30,
            entries in prop::collection::vec(-1.0f64..1.0, 30 * 30),
            // One block, a whole number of them, and one more.
            count in prop::sample::select(vec![1, 3, WIDTH, 2 * WIDTH, 2 * WIDTH + 1]),
            columns in prop::collection::vec(-1.0f64..1.0, 30 * (2 * WIDTH + 1)),
        ) {
            let random = DMat::from_fn(n, n, |i, j| entries[i * 30 + j]);
            let k = &random * random.transpose() + DMat::identity(n, n);
            let m = DMat::from_fn(n, n, |i, j| entries[i.max(j) * 30 + i.min(j)]);
            let vectors = DMat::from_fn(n, count, |i, j| columns[i * count + j]);
            let rows: Vec<f64> = columns[..n * count].to_vec();
            let (values, products) = pencil(k.as_slice().to_vec(), m.as_slice().to_vec(), rows, count).unwrap();

            // Σ μ_k^p (φ_kᵀ a)(φ_kᵀ b) = aᵀ K⁻¹ (M K⁻¹)^p b: no eigenvector needed to compare.
            let inverse = k.clone().try_inverse().unwrap();
            let mut power = inverse.clone();
            for exponent in 0..4 {
                let exact = vectors.transpose() * &power * &vectors;
                for i in 0..count {
                    for j in 0..count {
                        let sum: f64 =
                            (0..n)
                                .map(|k| values[k].powi(exponent) * products[k * count + i] * products[k * count + j])
                                .sum();
                        prop_assert!((sum - exact[(i, j)]).abs() < 1e-9, "power {exponent}: {sum} {}", exact[(i, j)]);
                    }
                }
                power = &power * &m * &inverse;
            }

            let l = k.cholesky().unwrap().l();
            let solved = l.solve_lower_triangular(&m).unwrap();
            let standard = l.solve_lower_triangular(&solved.transpose()).unwrap();
            let mut theirs: Vec<f64> = standard.symmetric_eigenvalues().iter().copied().collect();
            theirs.sort_by(f64::total_cmp);
            let mut sorted = values;
            sorted.sort_by(f64::total_cmp);
            for (a, b) in sorted.iter().zip(theirs) {
                prop_assert!((a - b).abs() < 1e-11);
            }
        }
    }

    #[test]
    fn an_indefinite_stiffness_is_refused() {
        assert!(pencil(vec![1.0, 2.0, 2.0, 1.0], vec![1.0, 0.0, 0.0, 1.0], vec![0.0, 0.0], 1).is_none());
    }
}

//! Integrals of hats and bubbles over [−1, 1], and Gauss rules.

use super::{MAX_DEGREES, MAX_TERMS};
use crate::math::legendre;
use std::sync::LazyLock;

/// Index of an entry in a lower triangle by rows.
#[inline(always)]
pub(in crate::modes::fundamental) const fn place(row: usize, column: usize) -> usize {
    row * (row + 1) / 2 + column
}

/// Nonzero integrals `∫ N_a N_b dξ` of the functions of an element as (a, b ≤ a, value), by rows: hats, then bubbles.
pub(super) struct Masses {
    entries: Vec<(usize, usize, f64)>,
    /// End of each row.
    ends: Vec<usize>,
}

impl Masses {
    /// Integrals for elements with one hat, at −1, or with both hats.
    fn with_hats(hats: usize) -> Self {
        let first = -1.0 / 6f64.sqrt();
        let second = 1.0 / (3.0 * 10f64.sqrt());
        let (mut entries, mut ends) = (Vec::new(), Vec::new());
        for f in 0..MAX_DEGREES + hats - 1 {
            match (f + 1).saturating_sub(hats) {
                0 if f == 1 => entries.push((1, 0, 1.0 / 3.0)),
                0 => {}
                // Only the first two bubbles have integrals with the hats.
                1 => entries.extend((0..hats).map(|hat| (f, hat, first))),
                2 => entries.extend((0..hats).map(|hat| (f, hat, if hat == 0 { second } else { -second }))),
                k => {
                    let n = k as f64 + 1.0;
                    let value = -1.0 / ((2.0 * n - 3.0) * ((2.0 * n - 5.0) * (2.0 * n - 1.0)).sqrt());
                    entries.push((f, f - 2, value));
                }
            }

            let n = (f + 2).saturating_sub(hats) as f64;
            entries.push((f, f, if f < hats { 2.0 / 3.0 } else { 2.0 / ((2.0 * n + 1.0) * (2.0 * n - 3.0)) }));
            ends.push(entries.len());
        }
        Self { entries, ends }
    }

    /// Integrals of the first `functions` functions, at least one.
    #[inline(always)]
    pub(super) fn of(&self, functions: usize) -> &[(usize, usize, f64)] {
        &self.entries[..self.ends[functions - 1]]
    }
}

/// Mass integrals of elements with one hat and with two.
pub(super) static MASSES: LazyLock<[Masses; 2]> = LazyLock::new(|| [1, 2].map(Masses::with_hats));

/// Integrals `∫ P_l s_j s_k dξ` of the slopes s of two functions and Legendre's P_l, for l = |k − j|, |k − j| + 2, … k
/// + j; for other l they are zero.
pub(super) struct Triples {
    /// Start of each pair (k, j ≤ k).
    starts: Vec<usize>,
    values: Vec<f64>,
}

impl Triples {
    /// Integrals of the pair (k, j ≤ k), ascending in l.
    #[inline(always)]
    pub(super) fn of(&self, k: usize, j: usize) -> &[f64] {
        let at = place(k, j);
        &self.values[self.starts[at]..self.starts[at + 1]]
    }
}

/// Integrals of products of slopes, by Adams's product:
/// `P_k P_j = Σ_r a_r a_{k−r} a_{j−r}/a_{k+j−r} (2l + 1)/(2l + 2r + 1) P_l`, l = k + j − 2r, a_r = (2r − 1)!!/r!; a sum
/// of positive terms.
pub(super) static TRIPLES: LazyLock<Triples> = LazyLock::new(|| {
    let mut a = vec![1.0_f64; 2 * MAX_DEGREES];
    for r in 1..a.len() {
        a[r] = a[r - 1] * (2.0 * r as f64 - 1.0) / r as f64;
    }
    let (mut starts, mut values) = (vec![0], Vec::new());
    // Factors of the orthonormal polynomials; the slope of the hat is −1/2.
    let scale = |k: usize| if k == 0 { -0.5 } else { (k as f64 + 0.5).sqrt() };
    for k in 0..MAX_DEGREES {
        for j in 0..=k {
            for r in (0..=j).rev() {
                let l = k + j - 2 * r;
                let product = a[r] * a[k - r] * a[j - r] / a[k + j - r] * 2.0 / (2 * l + 2 * r + 1) as f64;
                values.push(product * scale(k) * scale(j));
            }
            starts.push(values.len());
        }
    }
    Triples { starts, values }
});

/// Gauss rule for Legendre coefficients.
pub(super) struct Rule {
    /// Points ξ.
    pub(super) points: Vec<f64>,
    /// For each l, the weights of the points times (2l + 1)/2 P_l(ξ).
    pub(super) weights: Vec<Vec<f64>>,
}

/// Gauss rules of 1, 2, … points.
pub(super) static RULES: LazyLock<Vec<Rule>> = LazyLock::new(|| {
    (1..=MAX_TERMS)
        .map(|count| {
            let (points, weights): (Vec<f64>, Vec<f64>) = legendre::gauss(count).into_iter().unzip();
            let polynomials: Vec<_> = points.iter().map(|xi| legendre::orthonormal(*xi, count - 1)).collect();
            let of_degree = |l: usize| {
                let weighted = |(p, weight): (&Vec<f64>, &f64)| weight * p[l] * (l as f64 + 0.5).sqrt();
                polynomials.iter().zip(&weights).map(weighted).collect()
            };
            Rule { points, weights: (0..count).map(of_degree).collect() }
        })
        .collect()
});

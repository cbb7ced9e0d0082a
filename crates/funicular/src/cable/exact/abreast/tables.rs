//! Integrals over [−1, 1] of hats and bubbles, and Gauss's rules.

use super::element::place;
use super::{MOST_DEGREES, MOST_TERMS};
use crate::math::legendre;
use std::sync::LazyLock;

/// `∫ N_a N_b dξ` of the hat at −1 (k = 0) and the bubbles N_{k+1}.
pub(super) struct Masses {
    /// With itself, with the function two below.
    own: [f64; MOST_DEGREES],
    two_below: [f64; MOST_DEGREES],
    /// Of the lowest bubble with the hat.
    first: f64,
}

impl Masses {
    /// All entries of the lower triangle, for elements with H hats (that at −1, and then that at 1 or none) and so many
    /// functions, at least two beyond the hats.
    #[inline(always)]
    pub(super) fn each<const H: usize>(&self, functions: usize, mut visit: impl FnMut(usize, usize, f64)) {
        for f in 0..H {
            visit(f, f, self.own[0]);
        }
        for f in H..functions {
            visit(f, f, self.own[f + 1 - H]);
        }
        // Bubbles meet the hats in their first two.
        visit(H, 0, self.first);
        visit(H + 1, 0, self.two_below[2]);
        if H == 2 {
            visit(1, 0, 1.0 / 3.0);
            visit(H, 1, self.first);
            visit(H + 1, 1, -self.two_below[2]);
        }
        for f in H + 2..functions {
            visit(f, f - 2, self.two_below[f + 1 - H]);
        }
    }
}

pub(super) static MASSES: LazyLock<Masses> = LazyLock::new(|| {
    let (mut own, mut two_below) = ([2.0 / 3.0; MOST_DEGREES], [0.0; MOST_DEGREES]);
    for k in 1..MOST_DEGREES {
        let n = k as f64 + 1.0;
        own[k] = 2.0 / ((2.0 * n + 1.0) * (2.0 * n - 3.0));
        if k > 2 {
            two_below[k] = -1.0 / ((2.0 * n - 3.0) * ((2.0 * n - 5.0) * (2.0 * n - 1.0)).sqrt());
        }
    }
    two_below[2] = 1.0 / (3.0 * 10f64.sqrt());
    Masses { own, two_below, first: -1.0 / 6f64.sqrt() }
});

/// `∫ P_l s_j s_k dξ` of the slopes s of two functions and Legendre's P_l, for l = |k − j|, |k − j| + 2, … k + j, outside
/// of which they vanish.
pub(super) struct Triples {
    /// Where each pair (k, j ≤ k) begins.
    starts: Vec<usize>,
    values: Vec<f64>,
}

impl Triples {
    #[inline(always)]
    pub(super) fn of(&self, k: usize, j: usize) -> &[f64] {
        let at = place(k, j);
        &self.values[self.starts[at]..self.starts[at + 1]]
    }
}

/// By Adams's product: `P_k P_j = Σ_r a_r a_{k−r} a_{j−r}/a_{k+j−r} (2l + 1)/(2l + 2r + 1) P_l`, l = k + j − 2r,
/// a_r = (2r − 1)!!/r!; a sum of positive terms.
pub(super) static TRIPLES: LazyLock<Triples> = LazyLock::new(|| {
    let mut a = vec![1.0_f64; 2 * MOST_DEGREES];
    for r in 1..a.len() {
        a[r] = a[r - 1] * (2.0 * r as f64 - 1.0) / r as f64;
    }
    let (mut starts, mut values) = (vec![0], Vec::new());
    // Of the orthonormal polynomials; the hat's slope is −1/2.
    let scale = |k: usize| if k == 0 { -0.5 } else { (k as f64 + 0.5).sqrt() };
    for k in 0..MOST_DEGREES {
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

/// A Gauss rule.
pub(super) struct Rule {
    /// ξ.
    pub(super) points: Vec<f64>,
    /// For each l the weights of the points times (2l + 1)/2 P_l(ξ).
    pub(super) weights: Vec<Vec<f64>>,
}

/// Gauss's rules of 1, 2, … points.
pub(super) static RULES: LazyLock<Vec<Rule>> = LazyLock::new(|| {
    (1..=MOST_TERMS)
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

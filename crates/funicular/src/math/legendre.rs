//! Gauss-Legendre quadrature and orthonormal Legendre polynomials.

use super::DMat;

/// Nodes and weights of the n-point Gauss rule on [−1, 1], exact to degree 2n − 1; in ascending order.
///
/// Newton's method on P_n from Tricomi's estimate of the nodes; full precision for the few hundred points used here.
///
/// # References
/// F. G. Tricomi, Ann. Mat. Pura Appl. 31, 1950.
pub(crate) fn gauss(n: usize) -> Vec<(f64, f64)> {
    let size = n as f64;
    let mut rule = vec![(0.0, 0.0); n];
    for i in 0..n.div_ceil(2) {
        // Tricomi's estimate, and Newton's method from there.
        let angle = std::f64::consts::PI * (i as f64 + 0.75) / (size + 0.5);
        let mut x = (1.0 - (size - 1.0) / (8.0 * size.powi(3))) * angle.cos();
        let mut slope = 0.0;

        for _ in 0..20 {
            let (mut before, mut value) = (1.0, x);
            for k in 2..=n {
                let k = k as f64;
                (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
            }
            slope = size * (x * value - before) / (x * x - 1.0);
            let step = value / slope;
            x -= step;
            if step.abs() < 1e-15 {
                break;
            }
        }

        // Both nodes of the pair.
        if n % 2 == 1 && i == n / 2 {
            x = 0.0;
        }
        let weight = 2.0 / ((1.0 - x * x) * slope * slope);
        rule[i] = (-x, weight);
        rule[n - 1 - i] = (x, weight);
    }
    rule
}

/// Values at ξ of the orthonormal Legendre polynomials √((2k + 1)/2) P_k, k = 0 … `degree`.
pub fn orthonormal(xi: f64, degree: usize) -> Vec<f64> {
    let mut values = vec![1.0; degree + 1];
    if degree > 0 {
        values[1] = xi;
    }
    for k in 2..=degree {
        let n = k as f64;
        values[k] = ((2.0 * n - 1.0) * xi * values[k - 1] - (n - 1.0) * values[k - 2]) / n;
    }
    for (k, value) in values.iter_mut().enumerate() {
        *value *= (k as f64 + 0.5).sqrt();
    }
    values
}

/// Mass integrals ∫ N_a N_b dξ over [−1, 1] of the functions of an element: the two hats and the bubbles
/// `N_j = ∫ p_{j−1} = (P_j − P_{j−2})/√(2(2j − 1))`, j = 2 … `degree`; (`degree` + 1)×(`degree` + 1). The slopes of the
/// bubbles are orthonormal, and their products with those of the hats are zero.
pub(crate) fn element_mass(degree: usize) -> DMat {
    let mut m = DMat::zeros(degree + 1, degree + 1);
    let mut set = |a: usize, b: usize, value: f64| {
        m[(a, b)] = value;
        m[(b, a)] = value;
    };

    // The hats, and the first two bubbles, the only ones whose product with a hat has an integral.
    set(0, 0, 2.0 / 3.0);
    set(1, 1, 2.0 / 3.0);
    set(0, 1, 1.0 / 3.0);
    // The index j of N_j is also its row, because the hats take rows 0 and 1.
    if degree >= 2 {
        let value = -1.0 / 6f64.sqrt();
        set(0, 2, value);
        set(1, 2, value);
    }
    if degree >= 3 {
        let value = 1.0 / (3.0 * 10f64.sqrt());
        set(0, 3, value);
        set(1, 3, -value);
    }

    // Products of two bubbles.
    for j in 2..=degree {
        let n = j as f64;
        set(j, j, 2.0 / ((2.0 * n + 1.0) * (2.0 * n - 3.0)));
        if j + 2 <= degree {
            set(j, j + 2, -1.0 / ((2.0 * n + 1.0) * ((2.0 * n - 1.0) * (2.0 * n + 3.0)).sqrt()));
        }
    }
    m
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_integrate_powers_exactly() {
        for n in [1_u8, 2, 3, 8, 31, 64] {
            let rule = gauss(n.into());
            for power in 0..2 * i32::from(n) {
                let sum: f64 = rule.iter().map(|(x, w)| w * x.powi(power)).sum();
                let exact = if power % 2 == 1 { 0.0 } else { 2.0 / (f64::from(power) + 1.0) };
                assert!((sum - exact).abs() < 1e-14, "{n} points, power {power}: {sum}");
            }
        }
    }

    #[test]
    fn polynomials_are_orthonormal() {
        let rule = gauss(24);
        for i in 0..20 {
            for j in 0..20 {
                let product: f64 = rule
                    .iter()
                    .map(|(x, w)| {
                        let p = orthonormal(*x, 19);
                        w * p[i] * p[j]
                    })
                    .sum();
                assert!((product - f64::from(i == j)).abs() < 1e-13);
            }
        }
    }
}

//! Polynomials of one element: nodes at the Gauss-Lobatto points, strain at the Gauss points.

use crate::math::legendre::gauss;

/// Lagrange polynomials through the p + 1 Gauss-Lobatto points of [0, 1], and their derivatives.
#[derive(Debug, Clone)]
pub(super) struct ElementBasis {
    /// Degree p of the polynomials.
    pub(super) degree: usize,
    /// Nodes in [0, 1], ascending.
    pub(super) nodes: Vec<f64>,
    /// Weights of the Gauss-Lobatto rule at the nodes; their sum is 1.
    pub(super) weights: Vec<f64>,
    /// Weights of the Gauss rule with p points; their sum is 1.
    pub(super) gauss_weights: Vec<f64>,
    /// Derivatives of the p + 1 polynomials at each Gauss point, a row per point.
    pub(super) slopes_at_gauss: Vec<f64>,
    /// Derivatives of the polynomials at each node, a row per node.
    pub(super) slopes_at_nodes: Vec<f64>,
}

impl ElementBasis {
    /// Polynomials of degree `degree`, at least 1.
    pub(super) fn new(degree: usize) -> Self {
        let nodes = lobatto_nodes(degree);
        let weights = nodes.iter().map(|node| lobatto_weight(degree, *node)).collect();
        let points: Vec<(f64, f64)> = gauss(degree).into_iter().map(|(x, w)| (0.5 * (x + 1.0), 0.5 * w)).collect();
        let slopes = |at: &[f64]| at.iter().flat_map(|x| slopes(&nodes, *x)).collect();
        let gauss_points: Vec<f64> = points.iter().map(|point| point.0).collect();
        Self {
            degree,
            weights,
            gauss_weights: points.iter().map(|point| point.1).collect(),
            slopes_at_gauss: slopes(&gauss_points),
            slopes_at_nodes: slopes(&nodes),
            nodes,
        }
    }

    /// Derivatives of the polynomials at Gauss point `g`.
    #[inline]
    pub(super) fn at_gauss(&self, g: usize) -> &[f64] {
        let width = self.degree + 1;
        &self.slopes_at_gauss[g * width..(g + 1) * width]
    }

    /// Values of the polynomials at x of the element, which may lie a little outside.
    pub(super) fn values(&self, x: f64) -> Vec<f64> {
        let value = |j: usize| {
            let others = self.nodes.iter().enumerate().filter(|(k, _)| *k != j);
            others.map(|(_, node)| (x - node) / (self.nodes[j] - node)).product()
        };
        (0..=self.degree).map(value).collect()
    }

    /// Derivatives of the polynomials at node `q`.
    #[inline]
    pub(super) fn at_node(&self, q: usize) -> &[f64] {
        let width = self.degree + 1;
        &self.slopes_at_nodes[q * width..(q + 1) * width]
    }
}

/// Value and derivative of the Legendre polynomial of degree `degree` at x, |x| < 1 for the derivative.
fn legendre(degree: usize, x: f64) -> (f64, f64) {
    let (mut before, mut value) = (1.0, x);
    for k in 2..=degree {
        let k = k as f64;
        (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
    }
    (value, degree as f64 * (before - x * value) / (1.0 - x * x))
}

/// Ends of [0, 1] and the zeros of the derivative of the Legendre polynomial between them.
fn lobatto_nodes(degree: usize) -> Vec<f64> {
    let size = degree as f64;
    let inner = |k: usize| {
        // Newton's method from the Chebyshev points: (1 − x²) P″ = 2x P′ − p (p + 1) P.
        let mut x = -(std::f64::consts::PI * k as f64 / size).cos();
        for _ in 0..50 {
            let (value, slope) = legendre(degree, x);
            let curvature = (2.0 * x * slope - size * (size + 1.0) * value) / (1.0 - x * x);
            let step = slope / curvature;
            x -= step;
            if step.abs() < 1e-16 {
                break;
            }
        }
        0.5 * (x + 1.0)
    };
    (0..=degree)
        .map(|k| match k {
            0 => 0.0,
            _ if k == degree => 1.0,
            _ => inner(k),
        })
        .collect()
}

/// Weight of the Gauss-Lobatto rule on [0, 1] at a node.
fn lobatto_weight(degree: usize, node: f64) -> f64 {
    let size = degree as f64;
    let value = legendre(degree, 2.0 * node - 1.0).0;
    1.0 / (size * (size + 1.0) * value * value)
}

/// Derivatives at x of the Lagrange polynomials through `nodes`, from their products.
fn slopes(nodes: &[f64], x: f64) -> Vec<f64> {
    let count = nodes.len();
    let slope = |j: usize| {
        (0..count)
            .filter(|m| *m != j)
            .map(|m| {
                let others = (0..count).filter(|k| *k != j && *k != m);
                others.map(|k| (x - nodes[k]) / (nodes[j] - nodes[k])).product::<f64>() / (nodes[j] - nodes[m])
            })
            .sum()
    };
    (0..count).map(slope).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Degree p is differentiated exactly, and the Lobatto rule integrates degree 2p − 1.
    #[test]
    fn polynomials_are_exact_up_to_their_degree() {
        for degree in 1..=10 {
            let basis = ElementBasis::new(degree);
            let power = i32::try_from(degree).unwrap();
            for q in 0..=degree {
                let slope: f64 = (0..=degree).map(|j| basis.at_node(q)[j] * basis.nodes[j].powi(power)).sum();
                assert!((slope - f64::from(power) * basis.nodes[q].powi(power - 1)).abs() < 1e-11, "{degree} {q}");
            }
            let top = 2 * power - 1;
            let integral: f64 = (0..=degree).map(|q| basis.weights[q] * basis.nodes[q].powi(top)).sum();
            assert!((integral - 1.0 / f64::from(top + 1)).abs() < 1e-14, "{degree}");
            assert!((basis.gauss_weights.iter().sum::<f64>() - 1.0).abs() < 1e-14);
        }
    }
}

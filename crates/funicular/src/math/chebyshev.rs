//! Polynomials of several variables in Chebyshev's basis, by their total degree.
//!
//! Variables run from −1 to 1. Of all products `T_j(x) T_k(y) …` those with `j + k + … ≤ N` are taken, in the order of
//! their total degree, so that the basis of a lower degree is the beginning of that of a higher one.

use super::{DMat, DVec};

/// Products of Chebyshev polynomials up to a total degree.
#[derive(Debug, Clone, PartialEq)]
pub struct ChebyshevBasis {
    variables: usize,
    degree: usize,
    /// Degrees of each product along the variables.
    exponents: Vec<Vec<usize>>,
}

impl ChebyshevBasis {
    /// Basis of polynomials of a number of variables up to a total degree.
    ///
    /// # Example
    /// ```
    /// use funicular::math::chebyshev::ChebyshevBasis;
    ///
    /// let basis = ChebyshevBasis::new(2, 2);
    /// assert_eq!(basis.values(&[0.5, -1.0]), [1.0, 0.5, -1.0, -0.5, -0.5, 1.0]); // 1, x, y, T2(x), x y, T2(y)
    /// ```
    pub fn new(variables: usize, degree: usize) -> Self {
        let mut exponents = Vec::new();
        for total in 0..=degree {
            add_with_sum(variables, total, &mut Vec::new(), &mut exponents);
        }
        Self { variables, degree, exponents }
    }

    /// Number of products of a basis.
    pub fn count(variables: usize, degree: usize) -> usize {
        (1..=variables).fold(1, |count: usize, k| count.saturating_mul(degree + k) / k)
    }

    /// Largest total degree.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Degrees of each product along the variables.
    pub fn exponents(&self) -> &[Vec<usize>] {
        &self.exponents
    }

    /// Basis of some of the products.
    pub(crate) fn kept(&self, keep: &[usize]) -> Self {
        let exponents: Vec<Vec<usize>> = keep.iter().map(|k| self.exponents[*k].clone()).collect();
        let degree = exponents.iter().map(|exponents| exponents.iter().sum()).max().unwrap_or(0);
        Self { variables: self.variables, degree, exponents }
    }

    /// Value of every product at a point.
    pub fn values(&self, point: &[f64]) -> Vec<f64> {
        let along: Vec<Vec<f64>> = point.iter().map(|x| along_one(*x, self.degree)).collect();
        let product = |exponents: &Vec<usize>| exponents.iter().zip(&along).map(|(k, values)| values[*k]).product();
        self.exponents.iter().map(product).collect()
    }

    /// Coefficients of the polynomials that are nearest to functions in least squares: `values[i]` holds all functions
    /// at `points[i]`; the result holds the coefficients of each function. `None` if the points do not determine them.
    pub fn fitted(&self, points: &[Vec<f64>], values: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
        let n = self.exponents.len();
        let functions = values.first().map_or(0, Vec::len);
        let mut rows = Vec::with_capacity(n * points.len());
        for point in points {
            rows.extend(self.values(point));
        }

        // The products are nearly orthogonal over points that lie as densely as those of Chebyshev, so that the normal
        // equations lose no digits that matter.
        let rows = DMat::from_row_slice(points.len(), n, &rows);
        let factor = (rows.transpose() * &rows).cholesky()?;
        let of_function = |k: usize| -> Vec<f64> {
            let right = DVec::from_iterator(points.len(), values.iter().map(|values| values[k]));
            factor.solve(&(rows.transpose() * right)).iter().copied().collect()
        };
        Some((0..functions).map(of_function).collect())
    }
}

/// Adds all exponents of so many variables with a sum, those of the first variable descending.
fn add_with_sum(variables: usize, sum: usize, begun: &mut Vec<usize>, all: &mut Vec<Vec<usize>>) {
    if variables == 0 {
        if sum == 0 {
            all.push(begun.clone());
        }
        return;
    }
    for first in (0..=sum).rev() {
        begun.push(first);
        add_with_sum(variables - 1, sum - first, begun, all);
        begun.pop();
    }
}

/// Chebyshev polynomials of one variable, from degree 0 on.
fn along_one(x: f64, degree: usize) -> Vec<f64> {
    let mut values = vec![1.0, x];
    for k in 2..=degree {
        values.push(2.0 * x * values[k - 1] - values[k - 2]);
    }
    values
}

/// Point `index` of a sequence that fills the box from −1 to 1 evenly, however many of its points are taken: multiples
/// of the powers of the root of `x^(d+1) = x + 1`, without their whole parts.
///
/// # References
/// M. Roberts, The unreasonable effectiveness of quasirandom sequences, 2018.
pub fn even_point(variables: usize, index: usize) -> Vec<f64> {
    let root = (0..60).fold(2.0_f64, |x, _| (1.0 + x).powf(1.0 / (variables as f64 + 1.0)));
    let multiple = |power: &f64| 2.0 * (0.5 + (index as f64 + 1.0) * power).fract() - 1.0;
    let powers = std::iter::successors(Some(1.0 / root), |power| Some(power / root));
    powers.take(variables).map(|power| multiple(&power)).collect()
}

/// Point `index` of a sequence that lies as densely as the points of Chebyshev: densest beside the sides of the box,
/// where polynomials would swing otherwise.
pub fn chebyshev_point(variables: usize, index: usize) -> Vec<f64> {
    even_point(variables, index).into_iter().map(|x| (std::f64::consts::FRAC_PI_2 * x).sin()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_basis_begins_with_that_of_a_lower_degree() {
        for variables in 1..=6 {
            let [lower, higher] = [2, 3].map(|degree| ChebyshevBasis::new(variables, degree));
            assert_eq!(higher.exponents()[..lower.exponents().len()], *lower.exponents());
            assert_eq!(higher.exponents().len(), ChebyshevBasis::count(variables, 3));
            assert!(higher.exponents().iter().all(|exponents| exponents.iter().sum::<usize>() <= 3));
        }
        assert_eq!([2, 3, 4].map(|degree| ChebyshevBasis::count(6, degree)), [28, 84, 210]);
    }

    /// Cosines are the oracle: `T_k(cos t) = cos k t`. A polynomial of the degree of the basis is found exactly.
    #[test]
    fn a_polynomial_is_found_exactly() {
        let basis = ChebyshevBasis::new(3, 5);
        let points: Vec<Vec<f64>> = (0..250).map(|i| chebyshev_point(3, i)).collect();
        let of = |p: &[f64]| (3.0 * p[0].acos()).cos() * (2.0 * p[2].acos()).cos() - 0.25 * p[1];
        let values: Vec<Vec<f64>> = points.iter().map(|point| vec![of(point)]).collect();
        let found = basis.fitted(&points, &values).unwrap().remove(0);
        for (exponents, found) in basis.exponents().iter().zip(found) {
            let exact = match exponents[..] {
                [3, 0, 2] => 1.0,
                [0, 1, 0] => -0.25,
                _ => 0.0,
            };
            assert!((found - exact).abs() < 1e-13, "{exponents:?}: {found}");
        }
        assert!(basis.fitted(&points[..20], &values[..20]).is_none_or(|fit| !fit[0].iter().all(|c| c.abs() < 2.0)));
    }

    /// Every part of a cube cut into eight has its share of the points.
    #[test]
    fn points_are_spread_evenly() {
        let mut counts = [0; 8];
        for i in 0..800 {
            let part = even_point(3, i).iter().fold(0, |part, x| 2 * part + usize::from(*x > 0.0));
            counts[part] += 1;
        }
        assert!(counts.iter().all(|count| (90..=110).contains(count)), "{counts:?}");
    }
}

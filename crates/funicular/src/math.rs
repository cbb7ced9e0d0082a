//! Small linear algebra under names of the field, and numerical helpers shared by the crate.
//!
//! The types are those of nalgebra under these names; no other file of the crate names nalgebra.

pub(crate) mod active_set;
pub mod chebyshev;
pub mod chosen_rows;
pub(crate) mod complex_symmetric;
pub(crate) mod dual;
pub(crate) mod eigenvectors;
pub mod generalized_eigen;
pub(crate) mod jet;
pub mod least_squares;
pub mod legendre;
pub mod max_min;
pub(crate) mod order;
pub(crate) mod roots;
pub mod rotation;
pub(crate) mod simd;
pub mod symmetric;

/// Complex number, `f64` real and imaginary part.
pub type Complex = num_complex::Complex64;
/// Vector in space; the field that holds it gives the unit.
pub type Vec3 = nalgebra::Vector3<f64>;
/// Row of three real numbers.
pub(crate) type RowVec3 = nalgebra::RowVector3<f64>;
/// Wrench (force N, moment N·m) or small motion (translation m, rotation vector rad).
pub type Vec6 = nalgebra::Vector6<f64>;
/// 3×3 matrix.
pub type Mat3 = nalgebra::Matrix3<f64>;
/// 6×6 matrix over small motions; mixed units N/m, N, N·m/rad.
pub type Mat6 = nalgebra::Matrix6<f64>;
/// Complex 6-vector.
pub(crate) type CVec6 = nalgebra::Vector6<Complex>;
/// Complex 3×3 matrix.
pub type CMat3 = nalgebra::Matrix3<Complex>;
/// Complex 6×6 matrix.
pub type CMat6 = nalgebra::Matrix6<Complex>;
/// Rotation from the platform frame to the world frame.
pub type Rotation = nalgebra::UnitQuaternion<f64>;

/// Rotation as a matrix.
pub(crate) type RotationMatrix = nalgebra::Rotation3<f64>;

/// Quaternion, not necessarily of a rotation.
pub type Quaternion = nalgebra::Quaternion<f64>;

/// Cross-product matrix `[v]×`: `skew(v) * u == v × u`.
#[inline]
pub fn skew(v: &Vec3) -> Mat3 {
    v.cross_matrix()
}

/// Unit vector normal to the unit vector `v`.
pub(crate) fn any_normal(v: &Vec3) -> Vec3 {
    let least = if v.x.abs() <= v.y.abs().min(v.z.abs()) {
        Vec3::x()
    } else if v.y.abs() <= v.z.abs() {
        Vec3::y()
    } else {
        Vec3::z()
    };
    v.cross(&least).normalize()
}

/// Symmetric part `(A + Aᵀ)/2` of a square matrix.
#[inline]
pub(crate) fn symmetric_part<D: nalgebra::Dim>(matrix: &nalgebra::OMatrix<f64, D, D>) -> nalgebra::OMatrix<f64, D, D>
where
    nalgebra::DefaultAllocator: nalgebra::allocator::Allocator<D, D>,
{
    (matrix + matrix.transpose()) * 0.5
}

/// Inverse of a 6×6 matrix by elimination with pivots; `None` if it is singular.
///
/// nalgebra's `try_inverse` calls the same elimination for more than four rows. The compiler translates its formulas
/// for up to four rows for each type of matrix, too, although no 6×6 matrix uses them.
pub(crate) fn inverse6<T: nalgebra::ComplexField>(matrix: &Matrix6<T>) -> Option<Matrix6<T>> {
    let mut inverse = matrix.clone();
    nalgebra::linalg::try_invert_to(matrix.clone(), &mut inverse).then_some(inverse)
}

/// Matrix of a fixed size.
pub(crate) type Matrix<const R: usize, const C: usize> = nalgebra::SMatrix<f64, R, C>;
/// 6×6 matrix of any scalar.
pub(crate) type Matrix6<T> = nalgebra::Matrix6<T>;
pub(crate) use nalgebra::Scalar;

/// Matrix of any size.
pub type DMat = nalgebra::DMatrix<f64>;
/// Vector whose length is known at run time.
pub(crate) type DVec = nalgebra::DVector<f64>;
/// Complex matrix of any size.
pub type CDMat = nalgebra::DMatrix<Complex>;
/// Complex vector of any length.
pub(crate) type CDVec = nalgebra::DVector<Complex>;
/// Factors of a complex matrix of any size, by elimination with exchanges.
pub(crate) type CDLu = nalgebra::LU<Complex, nalgebra::Dyn, nalgebra::Dyn>;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Every digit is that of nalgebra's own inverse, also beside a singular matrix.
        #[test]
        fn an_inverse_has_the_digits_of_nalgebra(
            entries in proptest::collection::vec(-1e3..1e3_f64, 72),
            copied in 0..6_usize,
            is_singular: bool,
        ) {
            let mut real = Mat6::from_column_slice(&entries[..36]);
            let mut complex = CMat6::from_fn(|i, j| Complex::new(entries[6 * i + j], entries[36 + 6 * i + j]));
            if is_singular {
                real.set_column(copied, &Vec6::zeros());
                complex.set_column(copied, &CVec6::zeros());
            }
            prop_assert_eq!(inverse6(&real).is_none(), is_singular);
            prop_assert_eq!(inverse6(&real), real.try_inverse());
            prop_assert_eq!(inverse6(&complex).is_none(), is_singular);
            prop_assert_eq!(inverse6(&complex), complex.try_inverse());
        }
    }
}

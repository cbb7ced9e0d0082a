//! Sums over the points of a cable: displacements by its modes, and integrals along it. They take most of the time of a
//! gradient and have the same few operations for every point, so that they run in vector instructions. Components of
//! vectors at the points stand axis by axis: all of the first, then all of the second, then all of the third.

use super::super::scalar::{Field, Vector};
use crate::cable::catenary_dynamic::Displacements;
use crate::math::{DMat, legendre};
use pulp::{Arch, Simd, WithSimd};
use std::cell::RefCell;
use std::ops::Range;
use std::sync::Arc;

/// Displacement of the points of a cable by the motion of its platform end and by its clamped modes, one column each.
pub(super) struct ShapeColumns {
    /// Components per column.
    rows: usize,
    /// The columns: one per direction of the platform end, then one per mode.
    columns: Vec<f64>,
    /// One column per direction of the far end, in slow motion.
    of_far: Vec<f64>,
}

impl ShapeColumns {
    /// Columns of these displacements, axis by axis.
    pub(super) fn of<const D: usize, const N: usize>(of: &Displacements<D, N>) -> Self {
        let rows = D * of.still.len();
        let mut columns = Vec::with_capacity(rows * (D + of.modes.len()));
        let mut of_far = Vec::with_capacity(rows * D);
        for direction in 0..D {
            for axis in 0..D {
                columns.extend(of.still.iter().map(|psi| psi[axis][direction]));
                of_far.extend(of.still.iter().map(|psi| psi[axis][D + direction]));
            }
        }
        for mode in &of.modes {
            (0..D).for_each(|axis| columns.extend(mode.iter().map(|phi| phi[axis])));
        }
        Self { rows, columns, of_far }
    }

    /// Adds the displacements by a motion of the platform end and amplitudes of the modes.
    pub(super) fn add<T: Field>(&self, displacements: &mut [T], end: &[T], amplitudes: &[T]) {
        let (of_end, of_modes) = self.columns.split_at((self.rows * end.len()).min(self.columns.len()));
        for (columns, factors) in [(of_end, end), (of_modes, amplitudes)] {
            add_columns(displacements, columns, factors);
        }
    }

    /// Adds the slow displacements by a motion of the far end.
    pub(super) fn add_far<T: Field>(&self, displacements: &mut [T], far: &[T]) {
        add_columns(displacements, &self.of_far, far);
    }
}

/// Gauss rule.
pub(super) struct GaussRule {
    /// Points ξ in [−1, 1], each with its weight.
    pub(super) points: Vec<(f64, f64)>,
    /// Integrals over [−1, ξ] at the points from the values there, by rows; the last row is the integral over [−1, 1].
    integrals: DMat,
}

impl GaussRule {
    /// Rule with this number of points. A thread makes each once: cables have few sizes, robots along a path the same.
    pub(super) fn of_size(size: usize) -> Arc<Self> {
        thread_local! {
            static KNOWN: RefCell<Vec<Arc<GaussRule>>> = const { RefCell::new(Vec::new()) };
        }
        KNOWN.with_borrow_mut(|known| {
            let of_size = known.iter().find(|rule| rule.points.len() == size).cloned();
            of_size.unwrap_or_else(|| {
                known.push(Arc::new(Self::new(size)));
                Arc::clone(&known[known.len() - 1])
            })
        })
    }

    fn new(size: usize) -> Self {
        let points = legendre::gauss(size);
        // Orthonormal polynomials at the points, and their integrals: of P_k it is (P_{k+1} − P_{k−1})/(2k + 1).
        let at_points: Vec<Vec<f64>> = points.iter().map(|(xi, _)| legendre::orthonormal(*xi, size)).collect();
        let plain = |values: &[f64], k: usize| values[k] / (k as f64 + 0.5).sqrt();
        let primitive = |values: &[f64], k: usize| {
            let below = if k == 0 { -1.0 } else { plain(values, k - 1) };
            (plain(values, k + 1) - below) / (2.0 * k as f64 + 1.0) * (k as f64 + 0.5).sqrt()
        };
        let primitives = DMat::from_fn(size, size, |i, k| primitive(&at_points[i], k));
        let expansion = DMat::from_fn(size, size, |k, j| points[j].1 * at_points[j][k]);
        let inner = primitives * expansion;
        let integrals = DMat::from_fn(size + 1, size, |i, j| if i < size { inner[(i, j)] } else { points[j].1 });
        Self { points, integrals }
    }
}

/// Element of a cable: its points among those of the cable, half its length [m] and its rule.
pub(super) struct QuadratureElement {
    pub(super) points: Range<usize>,
    pub(super) half: f64,
    pub(super) rule: Arc<GaussRule>,
}

/// Integrals of a vector from the platform end to every point, and over the whole cable [m].
pub(super) fn integrals<T: Field>(
    elements: &[QuadratureElement],
    values: &[T],
    points: usize,
) -> (Vec<Vector<T>>, Vector<T>) {
    let mut sums = vec![[T::default(); 3]; points];
    let mut whole = [T::default(); 3];
    let most = elements.iter().map(|element| element.points.len() + 1).max().unwrap_or(0);
    let mut column = vec![T::default(); most];
    for axis in 0..3 {
        let of_axis = &values[axis * points..(axis + 1) * points];
        let mut before = T::default();
        for QuadratureElement { points, half, rule } in elements {
            let column = &mut column[..=points.len()];
            column.fill(T::default());
            add_columns(column, rule.integrals.as_slice(), &of_axis[points.clone()]);

            for (sum, inner) in sums[points.clone()].iter_mut().zip(&*column) {
                sum[axis] = before + *inner * *half;
            }
            before += column[points.len()] * *half;
        }
        whole[axis] = before;
    }
    (sums, whole)
}

/// Adds columns times their factors to a vector.
fn add_columns<T: Field>(sum: &mut [T], columns: &[f64], factors: &[T]) {
    // Real and imaginary parts stand apart, so that the compiler makes vector instructions of both.
    let rows = sum.len();
    let apart: Vec<f64> = (0..T::PARTS).flat_map(|part| factors.iter().map(move |factor| factor.part(part))).collect();
    let mut sums = vec![0.0; T::PARTS * rows];
    Arch::new().dispatch(Product { sums: &mut sums, columns: &columns[..rows * factors.len()], factors: &apart, rows });
    for (i, sum) in sum.iter_mut().enumerate() {
        *sum += T::of_parts(|part| sums[part * rows + i]);
    }
}

/// Product of a matrix with vectors, each of which is a part of [`Self::factors`]; the results are those of
/// [`Self::sums`].
struct Product<'a> {
    sums: &'a mut [f64],
    columns: &'a [f64],
    factors: &'a [f64],
    rows: usize,
}

/// Columns that are added in one pass over a sum: with more of them the sum is read and written less often, and eight
/// are no faster.
const COLUMNS: usize = 4;

impl WithSimd for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { sums, columns, factors, rows } = self;
        if rows == 0 || columns.is_empty() {
            return;
        }
        let count = columns.len() / rows;
        let column = |k: usize| &columns[k * rows..(k + 1) * rows];
        let in_blocks = count - count % COLUMNS;

        for first in (0..in_blocks).step_by(COLUMNS) {
            let [a, b, c, d] = std::array::from_fn::<_, COLUMNS, _>(|k| column(first + k));
            for (sum, factors) in sums.chunks_exact_mut(rows).zip(factors.chunks_exact(count)) {
                let [of_a, of_b, of_c, of_d] = std::array::from_fn::<_, COLUMNS, _>(|k| factors[first + k]);
                for ((((sum, a), b), c), d) in sum.iter_mut().zip(a).zip(b).zip(c).zip(d) {
                    *sum += of_a * a + of_b * b + of_c * c + of_d * d;
                }
            }
        }

        for k in in_blocks..count {
            for (sum, factors) in sums.chunks_exact_mut(rows).zip(factors.chunks_exact(count)) {
                for (sum, value) in sum.iter_mut().zip(column(k)) {
                    *sum += factors[k] * value;
                }
            }
        }
    }
}

/// Vectors at the points, from their components axis by axis.
pub(super) fn vectors<T: Field>(components: &[T], points: usize) -> Vec<Vector<T>> {
    (0..points).map(|i| std::array::from_fn(|axis| components[axis * points + i])).collect()
}

/// Components of vectors at the points, axis by axis.
pub(super) fn by_axes<T: Field>(vectors: &[Vector<T>]) -> Vec<T> {
    (0..3).flat_map(|axis| vectors.iter().map(move |vector| vector[axis])).collect()
}

//! Constraint set of a polyhedron whose normals are kept as a full matrix.

use super::{ConstraintSet, DEPENDENT, Magnitude, Polyhedron, dot, worst};

/// Polyhedron with a basis of its active normals.
pub(super) struct Dense<'a> {
    set: &'a Polyhedron,
    active: Vec<usize>,
    basis: Basis,
}

impl<'a> Dense<'a> {
    pub(super) fn of(set: &'a Polyhedron) -> Self {
        Self { set, active: Vec::with_capacity(set.dimension + 1), basis: Basis::new(set.dimension) }
    }
}

impl ConstraintSet for Dense<'_> {
    #[inline]
    fn dimension(&self) -> usize {
        self.set.dimension
    }

    fn most_violated<M: Magnitude>(&self, x: &[M], tolerance: f64) -> Option<(usize, M)> {
        worst(self.set.levels.iter().enumerate().map(|(row, level)| {
            let terms = self.set.normal(row).iter().copied().zip(x.iter().copied());
            M::lack(terms, *level, tolerance)
        }))
    }

    #[inline]
    fn split(&mut self, row: usize) -> bool {
        self.basis.split(self.set.normal(row))
    }

    #[inline]
    fn split_vertical(&mut self) {
        let mut vertical = vec![0.0; self.set.dimension];
        if let Some(last) = vertical.last_mut() {
            *last = 1.0;
        }
        self.basis.split(&vertical);
    }

    #[inline]
    fn rest(&self) -> &[f64] {
        &self.basis.rest
    }

    #[inline]
    fn shares(&self) -> &[f64] {
        &self.basis.shares
    }

    #[inline]
    fn hold(&mut self, row: usize) {
        self.basis.push();
        self.active.push(row);
    }

    #[inline]
    fn release(&mut self, at: usize) {
        self.active.remove(at);
        self.basis.rebuild(self.active.iter().map(|row| self.set.normal(*row)));
    }

    /// Every point of the space is allowed.
    #[inline]
    fn restore<M: Magnitude>(&mut self, _: &mut [M]) -> bool {
        false
    }
}

/// Orthonormal basis of the active normals, and the triangle that expresses them in it.
struct Basis {
    dimension: usize,
    vectors: Vec<f64>,
    triangle: Vec<Vec<f64>>,
    /// Components, along the basis, of the normal that was split last.
    along: Vec<f64>,
    /// Outside part of this normal.
    rest: Vec<f64>,
    /// Coefficients of the active normals in its inside part.
    shares: Vec<f64>,
}

impl Basis {
    fn new(dimension: usize) -> Self {
        let rest = vec![0.0; dimension];
        Self { dimension, vectors: Vec::new(), triangle: Vec::new(), along: Vec::new(), rest, shares: Vec::new() }
    }

    /// Splits a normal into its parts inside and outside the span of the active ones; true if there is a part outside.
    fn split(&mut self, normal: &[f64]) -> bool {
        let count = self.triangle.len();
        self.rest.copy_from_slice(normal);
        self.along.clear();
        self.along.resize(count, 0.0);
        let size = dot(normal, normal).sqrt();

        // Twice: the second pass removes the rounding of the first.
        for _ in 0..2 {
            for (k, vector) in self.vectors.chunks_exact(self.dimension).enumerate() {
                let part = dot(vector, &self.rest);
                self.along[k] += part;
                self.rest.iter_mut().zip(vector).for_each(|(rest, v)| *rest -= part * v);
            }
        }

        self.shares.clear();
        self.shares.extend_from_slice(&self.along);
        for k in (0..count).rev() {
            self.shares[k] /= self.triangle[k][k];
            let share = self.shares[k];
            for j in 0..k {
                self.shares[j] -= share * self.triangle[k][j];
            }
        }

        let outside = dot(&self.rest, &self.rest).sqrt() > DEPENDENT * size && count < self.dimension;
        if !outside {
            self.rest.fill(0.0);
        }
        outside
    }

    /// Adds the normal that was split last.
    fn push(&mut self) {
        let length = dot(&self.rest, &self.rest).sqrt();
        self.vectors.extend(self.rest.iter().map(|z| z / length));
        let mut column = std::mem::take(&mut self.along);
        column.push(length);
        self.triangle.push(column);
    }

    /// Makes the basis again, from these normals.
    fn rebuild<'a>(&mut self, normals: impl Iterator<Item = &'a [f64]>) {
        self.vectors.clear();
        self.triangle.clear();
        for normal in normals {
            self.split(normal);
            self.push();
        }
    }
}

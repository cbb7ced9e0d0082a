//! Symmetric positive definite matrix of one rope, stored from the first entry of each row to the diagonal, and its
//! Cholesky factor, which fills no other place. Ropes are factored side by side ([`FactorPack`]); the factor of a
//! single one is the oracle of tests.
//!
//! [`FactorPack`]: super::side_by_side::FactorPack

#[cfg(test)]
use crate::math::Mat3;
use crate::math::Vec3;

/// Shape of the matrix of a rope: three rows for each node, from the anchor towards the platform, without the anchor.
#[derive(Debug, Clone)]
pub(super) struct Profile3 {
    /// First column of each row.
    first: Vec<usize>,
    /// Place of the first entry of each row among all entries.
    start: Vec<usize>,
    /// Number of entries.
    count: usize,
}

impl Profile3 {
    /// Shape for a number of elements of a degree.
    pub(super) fn new(elements: usize, degree: usize) -> Self {
        let free = elements * degree;
        let (mut first, mut start, mut count) = (Vec::new(), Vec::new(), 0);
        // Nodes from the anchor on; a node is coupled with those of the element on its side of the anchor.
        for node in (0..free).rev() {
            let farthest = ((node / degree + 1) * degree).min(free - 1);
            let column = 3 * (free - 1 - farthest);
            for axis in 0..3 {
                let row = 3 * (free - 1 - node) + axis;
                first.push(column);
                start.push(count);
                count += row + 1 - column;
            }
        }
        Self { first, start, count }
    }

    /// Number of rows.
    fn rows(&self) -> usize {
        self.first.len()
    }
}

/// Matrix of a rope, or its factor.
#[derive(Debug, Clone)]
pub(super) struct Skyline {
    shape: Profile3,
    /// Entries of each row from the first to the diagonal; of a factored row the diagonal's inverse.
    pub(super) values: Vec<f64>,
    /// Number of rows that are factored; the last three, of the node on the platform, may stay as a Schur complement.
    factored: usize,
}

/// A pivot that is not positive: the matrix is not that of a stable step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct NotPositive;

impl Skyline {
    /// Zero matrix.
    pub(super) fn zeros(shape: Profile3) -> Self {
        Self { values: vec![0.0; shape.count], shape, factored: 0 }
    }

    /// Leaves the last node as a Schur complement, or not.
    pub(super) fn keep_end(&mut self, keep: bool) {
        self.factored = self.rows() - if keep { 3 } else { 0 };
    }

    /// Number of rows.
    pub(super) fn rows(&self) -> usize {
        self.shape.rows()
    }

    /// True if the last node is left as a Schur complement.
    pub(super) fn keeps_end(&self) -> bool {
        self.factored < self.rows()
    }

    /// Number of nodes that are factored.
    pub(super) fn factored_nodes(&self) -> usize {
        self.factored / 3
    }

    /// First column of the rows of a node, counted from the anchor, and the places of the first entries of its rows.
    #[inline]
    pub(super) fn node(&self, node: usize) -> [usize; 4] {
        let [a, b, c] = [0, 1, 2].map(|i| self.shape.start[3 * node + i]);
        [self.shape.first[3 * node], a, b, c]
    }

    #[inline]
    fn row(&self, row: usize) -> &[f64] {
        let start = self.shape.start[row];
        &self.values[start..start + row + 1 - self.shape.first[row]]
    }

    /// `L⁻¹ b` for the factored rows, in place; returns what the last node receives of it, `A₀ᵢ Aᵢᵢ⁻¹ b`, if it is
    /// kept. `b` is in the order of the rows.
    pub(super) fn forward(&self, b: &mut [f64]) -> Vec3 {
        for row in 0..self.factored {
            let own = self.row(row);
            let first = self.shape.first[row];
            let sum = dot(&own[..row - first], &b[first..row]);
            b[row] = (b[row] - sum) * own[row - first];
        }
        if !self.keeps_end() {
            return Vec3::zeros();
        }
        Vec3::from_fn(|i, _| {
            let (row, first) = (self.factored + i, self.shape.first[self.factored + i]);
            dot(&self.row(row)[..self.factored - first], &b[first..self.factored])
        })
    }

    /// Entries of a column at the kept last node, which become zero; zero if it is not kept.
    pub(super) fn take_kept(&self, column: &mut [f64]) -> Vec3 {
        if !self.keeps_end() {
            return Vec3::zeros();
        }
        Vec3::from_fn(|i, _| std::mem::take(&mut column[self.factored + i]))
    }
}

#[cfg(test)]
impl Skyline {
    /// Sets all entries to zero.
    pub(super) fn clear(&mut self) {
        self.values.fill(0.0);
    }

    /// Adds a symmetric block between two nodes, counted from the platform; `node` is not beyond `other` from the
    /// platform. `free` is the number of nodes without the anchor.
    pub(super) fn add(&mut self, free: usize, node: usize, other: usize, block: &Mat3) {
        let (row, column) = (3 * (free - 1 - node), 3 * (free - 1 - other));
        for i in 0..3 {
            let place = self.shape.start[row + i] + column - self.shape.first[row + i];
            let width = if node == other { i + 1 } else { 3 };
            for j in 0..width {
                self.values[place + j] += block[(i, j)];
            }
        }
    }

    /// Cholesky factor in place. With `keep_end` the last node is left as the Schur complement, which is returned.
    pub(super) fn factor(&mut self, keep_end: bool) -> Result<Mat3, NotPositive> {
        self.keep_end(keep_end);
        for row in 0..self.rows() {
            let first = self.shape.first[row];
            let (before, own) = self.values.split_at_mut(self.shape.start[row]);
            for column in first..row {
                if column >= self.factored {
                    break;
                }
                let from = self.shape.first[column].max(first);
                let other = &before[self.shape.start[column] + from - self.shape.first[column]..][..=(column - from)];
                let sum = dot(&own[from - first..column - first], &other[..column - from]);
                own[column - first] = (own[column - first] - sum) * other[column - from];
            }
            if row < self.factored {
                let pivot = own[row - first] - dot(&own[..row - first], &own[..row - first]);
                if !(pivot > 0.0 && pivot.is_finite()) {
                    return Err(NotPositive);
                }
                // The diagonal holds the inverse, so that solving has no division.
                own[row - first] = 1.0 / pivot.sqrt();
            }
        }
        Ok(if keep_end { self.complement() } else { Mat3::zeros() })
    }

    /// Schur complement of the last node.
    fn complement(&self) -> Mat3 {
        let mut complement = Mat3::zeros();
        for i in 0..3 {
            for j in 0..=i {
                let (a, b) = (self.row(self.factored + i), self.row(self.factored + j));
                let coupled = self.factored - self.shape.first[self.factored + i];
                let entry = a[coupled + j] - dot(&a[..coupled], &b[..coupled]);
                complement[(i, j)] = entry;
                complement[(j, i)] = entry;
            }
        }
        complement
    }

    /// `L⁻ᵀ (b − L₀ᵀ end)` in place, `end` being the motion of the kept last node.
    pub(super) fn backward(&self, b: &mut [f64], end: &Vec3) {
        if self.keeps_end() {
            for i in 0..3 {
                let (row, first) = (self.factored + i, self.shape.first[self.factored + i]);
                subtract(&mut b[first..self.factored], end[i], &self.row(row)[..self.factored - first]);
            }
        }
        for row in (0..self.factored).rev() {
            let own = self.row(row);
            let first = self.shape.first[row];
            let value = b[row] * own[row - first];
            b[row] = value;
            subtract(&mut b[first..row], value, &own[..row - first]);
        }
    }
}

/// Scalar product in four partial sums, which the processor adds side by side.
#[inline]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (mut sums, n) = ([0.0; 4], a.len().min(b.len()));
    let whole = n - n % 4;
    for (a, b) in a[..whole].chunks_exact(4).zip(b[..whole].chunks_exact(4)) {
        for k in 0..4 {
            sums[k] += a[k] * b[k];
        }
    }
    let rest: f64 = a[whole..n].iter().zip(&b[whole..n]).map(|(a, b)| a * b).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

/// `b −= factor · a`.
#[cfg(test)]
fn subtract(b: &mut [f64], factor: f64, a: &[f64]) {
    for (b, a) in b.iter_mut().zip(a) {
        *b -= factor * a;
    }
}

//! Covariance of the error state: propagation by blocks, and updates by single rows in Joseph's form.

use super::exponential::Mat12;

/// Number of states of the platform's motion, which come first.
pub(super) const MOTION: usize = 12;

/// Symmetric covariance of a state whose first twelve components move and whose others change slowly.
///
/// Updates touch single entries with products of the same units, so that a scaling of the state by powers of two would
/// not change one bit of them.
#[derive(Debug, Clone)]
pub(super) struct Covariance {
    size: usize,
    entries: Vec<f64>,
    /// Twelve rows of intermediate products.
    moved: Vec<f64>,
}

impl Covariance {
    pub(super) fn new(size: usize) -> Self {
        Self { size, entries: vec![0.0; size * size], moved: vec![0.0; MOTION * size] }
    }

    /// Takes the entries of another covariance of the same size.
    pub(super) fn copy_from(&mut self, other: &Self) {
        self.entries.copy_from_slice(&other.entries);
    }

    pub(super) fn at(&self, i: usize, j: usize) -> f64 {
        self.entries[i * self.size + j]
    }

    /// Writes an entry and its mirror image.
    pub(super) fn put(&mut self, i: usize, j: usize, value: f64) {
        self.entries[i * self.size + j] = value;
        self.entries[j * self.size + i] = value;
    }

    pub(super) fn clear(&mut self) {
        self.entries.fill(0.0);
    }

    /// Variance along a state, which rounding does not make negative.
    pub(super) fn variance(&self, i: usize) -> f64 {
        self.at(i, i).max(0.0)
    }

    /// Forgets what is known about a state: a variance of its own without correlations.
    pub(super) fn reopen(&mut self, i: usize, variance: f64) {
        (0..self.size).for_each(|j| self.put(i, j, 0.0));
        self.put(i, i, variance);
    }

    /// Product with a column.
    pub(super) fn times(&self, column: &[f64], product: &mut [f64]) {
        product.fill(0.0);
        for (j, value) in column.iter().enumerate().filter(|(_, value)| **value != 0.0) {
            let row = &self.entries[j * self.size..][..self.size];
            product.iter_mut().zip(row).for_each(|(sum, entry)| *sum += entry * value);
        }
    }

    /// Moves the first twelve states by twelve rows `motion` over the whole state, adds `noise` to them, and multiplies
    /// the others by their `decay`.
    pub(super) fn propagate(&mut self, motion: &[f64], decay: &[f64], noise: &Mat12) {
        let n = self.size;
        for i in 0..MOTION {
            let sums = &mut self.moved[i * n..][..n];
            sums.fill(0.0);
            for k in 0..n {
                let factor = motion[i * n + k];
                if factor != 0.0 {
                    let row = &self.entries[k * n..][..n];
                    sums.iter_mut().zip(row).for_each(|(sum, entry)| *sum += factor * entry);
                }
            }
        }
        for i in MOTION..n {
            for j in MOTION..=i {
                let value = self.at(i, j) * decay[i] * decay[j];
                self.put(i, j, value);
            }
        }
        for i in 0..MOTION {
            for (j, kept) in decay.iter().enumerate().skip(MOTION) {
                let value = self.moved[i * n + j] * kept;
                self.put(i, j, value);
            }
            for j in 0..=i {
                let product: f64 = (0..n).map(|k| self.moved[i * n + k] * motion[j * n + k]).sum();
                self.put(i, j, product + 0.5 * (noise[(i, j)] + noise[(j, i)]));
            }
        }
    }

    /// Update by one row with the gain `gain`, whatever it is: (I − k hᵀ) P (I − k hᵀ)ᵀ + k r kᵀ. `product` is P h and
    /// `spread` is hᵀ P h + r.
    ///
    /// # References
    /// docs/theory.md, equation (97x).
    pub(super) fn joseph(&mut self, gain: &[f64], product: &[f64], spread: f64) {
        let n = self.size;
        for i in 0..n {
            let (gain_i, product_i) = (gain[i], product[i]);
            if gain_i == 0.0 && product_i == 0.0 {
                continue;
            }
            for j in 0..=i {
                let change = gain_i * (spread * gain[j] - product[j]) - product_i * gain[j];
                let value = self.entries[i * n + j] + change;
                self.entries[i * n + j] = value;
                self.entries[j * n + i] = value;
            }
        }
    }
}

//! Natural sizes of unknowns: a factor is no length, and counts among lengths as much as one of them does on average.

use super::Calibration;
use crate::math::DMat;

impl Calibration {
    /// True for an unknown that is a length, or the scale of the readings; false for a factor.
    pub fn is_length(&self, unknown: usize) -> bool {
        self.unknowns[unknown].is_length()
    }

    /// Metres that one unit of each unknown counts for where unknowns are added or compared: 1 for a length. A factor
    /// counts as many as make its variance the mean variance of the lengths, so that no unit decides what is weakest.
    /// Without lengths all factors count alike.
    pub(super) fn natural_sizes(&self, covariance: &DMat) -> Vec<f64> {
        let count = self.unknowns.len();
        let of_lengths: Vec<f64> =
            (0..count).filter(|&k| self.is_length(k)).map(|k| covariance[(k, k)].max(0.0)).collect();
        let mean = of_lengths.iter().sum::<f64>() / of_lengths.len().max(1) as f64;
        let size = |k: usize| {
            let variance = covariance[(k, k)];
            let is_known = !of_lengths.is_empty() && mean > 0.0 && variance > 0.0;
            if self.is_length(k) || !is_known { 1.0 } else { (mean / variance).sqrt() }
        };
        (0..count).map(size).collect()
    }

    /// Largest deviation of a combination of the lengths among the unknowns [m].
    pub fn weakest_of_lengths(&self, covariance: &DMat) -> f64 {
        let lengths: Vec<usize> = (0..self.unknowns.len()).filter(|&k| self.is_length(k)).collect();
        let of_lengths = DMat::from_fn(lengths.len(), lengths.len(), |a, b| covariance[(lengths[a], lengths[b])]);
        if lengths.is_empty() { 0.0 } else { of_lengths.symmetric_eigenvalues().max().max(0.0).sqrt() }
    }

    /// Root of the sum of the variances of the lengths among the unknowns [m].
    pub fn total_of_lengths(&self, covariance: &DMat) -> f64 {
        let lengths = (0..self.unknowns.len()).filter(|&k| self.is_length(k));
        lengths.map(|k| covariance[(k, k)]).sum::<f64>().max(0.0).sqrt()
    }
}

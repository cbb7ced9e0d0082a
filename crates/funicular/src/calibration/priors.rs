//! Values of the unknowns that are known beforehand: further residuals `(θ − θ₀)/σ₀` beside those of the rows.

use super::Calibration;
use crate::math::{DMat, DVec};

/// Prior of one unknown, in the units of the vectors of results.
#[derive(Debug, Clone, Copy)]
pub(super) struct Prior {
    unknown: usize,
    value: f64,
    deviation: f64,
}

impl Calibration {
    /// Calibration with values that are known beforehand: index of the unknown, value and standard deviation, in
    /// the units of [`Calibration::meaning`]. A scale or a factor is positive. An anchor with a prior has a place in
    /// the world, so that priors fix the frame where they are.
    #[must_use]
    pub fn with_priors(mut self, priors: &[(usize, f64, f64)]) -> Self {
        let prior = |&(unknown, known, deviation): &(usize, f64, f64)| {
            let value = self.value_of(unknown, known);
            Prior { unknown, value, deviation: deviation / self.meaning(unknown, value)[1].abs() }
        };
        self.priors = priors.iter().map(prior).collect();
        self
    }

    /// Prior of an unknown, as value and standard deviation in the units of [`Calibration::meaning`].
    pub fn prior_of(&self, unknown: usize) -> Option<(f64, f64)> {
        let prior = self.priors.iter().find(|prior| prior.unknown == unknown)?;
        let [value, rate] = self.meaning(unknown, prior.value);
        Some((value, prior.deviation * rate.abs()))
    }

    /// Number of unknowns that are known beforehand.
    pub fn prior_count(&self) -> usize {
        self.priors.len()
    }

    /// Residuals of the priors, in deviations.
    pub(super) fn prior_residuals(&self, values: &[f64]) -> DVec {
        let residuals = self.priors.iter().map(|prior| (values[prior.unknown] - prior.value) / prior.deviation);
        DVec::from_vec(residuals.collect())
    }

    /// Derivatives of these residuals along directions of the unknowns, given as columns.
    pub(super) fn prior_rows(&self, directions: &DMat) -> DMat {
        DMat::from_fn(self.priors.len(), directions.ncols(), |k, c| {
            directions[(self.priors[k].unknown, c)] / self.priors[k].deviation
        })
    }
}

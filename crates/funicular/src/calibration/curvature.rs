//! Fits with a combination of the unknowns or one of them held. A walk along the weakest combination tests the
//! covariance: noise can hide lost rank from every linearisation, but not from this walk.

use super::frame::CalibrationFrame;
use super::{Calibration, CalibrationFit, CalibrationPrecision, null_space};
use crate::math::{DMat, DVec};

/// Steps of the walk, in deviations.
const STEPS: [f64; 4] = [-2.0, -1.0, 1.0, 2.0];

/// Ranges of the rise of χ² after one and two deviations that count as a parabola; a true parabola rises by 1 and 4.
/// Sound sets were seen between 0.97 and 1.08, and 3.6 and 4.5; a set of lost rank gave 0.3, 7.6, 15 and 93.
const ONE: [f64; 2] = [0.7, 1.4];
const TWO: [f64; 2] = [3.0, 5.5];

/// Walk along the weakest combination: it is held at steps, and everything else is fitted again.
#[derive(Debug, Clone, PartialEq)]
pub struct WeakWalk {
    /// Held distances from the fit, in deviations.
    pub steps: [f64; 4],
    /// Rise of χ² at each step, relative to the variance of the residuals.
    pub rises: [f64; 4],
}

impl WeakWalk {
    /// True if χ² is a parabola along the weakest combination, so that deviations and intervals mean something.
    pub fn is_parabola(&self) -> bool {
        self.steps.iter().zip(&self.rises).all(|(step, rise)| {
            let [low, high] = if step.abs() < 1.5 { ONE } else { TWO };
            (low..=high).contains(rise)
        })
    }
}

impl Calibration {
    /// Walks along the weakest combination of a fit. `factor` multiplies the deviations where residuals are larger than
    /// the deviations of the data. `None` without unknowns.
    pub fn weak_walk(
        &self,
        fit: &CalibrationFit,
        frame: &CalibrationFrame,
        precision: &CalibrationPrecision,
        factor: f64,
    ) -> Option<WeakWalk> {
        if frame.free_count() == 0 {
            return None;
        }
        let (held, variance) = self.weakest_held(frame, precision);
        let deviation = factor * variance.max(0.0).sqrt();
        let seen = &precision.free_covariance * &held;
        let along_held = held.dot(&seen);
        let direction = if along_held > 0.0 { seen / along_held } else { held.clone() };
        let rise = |step: f64| {
            let along = &direction * (step * deviation);
            (self.fit_across(fit, frame, &along, &held).chi2 - fit.chi2) / (factor * factor)
        };
        Some(WeakWalk { steps: STEPS, rises: STEPS.map(rise) })
    }

    /// Weakest combination of the free directions with its variance; factors have the weight of lengths.
    fn weakest_held(&self, frame: &CalibrationFrame, precision: &CalibrationPrecision) -> (DVec, f64) {
        let mut scaled = frame.free.clone();
        if (0..self.unknowns.len()).all(|k| self.is_length(k)) {
            let eigen = precision.free_covariance.clone().symmetric_eigen();
            let weakest = eigen.eigenvalues.imax();
            return (eigen.eigenvectors.column(weakest).into_owned(), eigen.eigenvalues[weakest]);
        }
        for (k, size) in self.natural_sizes(&precision.covariance).into_iter().enumerate() {
            scaled.row_mut(k).scale_mut(size);
        }
        let eigen = (&scaled * &precision.free_covariance * scaled.transpose()).symmetric_eigen();
        let weakest = eigen.eigenvalues.imax();
        (scaled.transpose() * eigen.eigenvectors.column(weakest), eigen.eigenvalues[weakest])
    }

    /// Fits everything else again with one unknown held at `value`, for a profile of χ²; from a fit with another value
    /// of it. A value that the frame holds stays.
    pub fn fit_held(
        &self,
        from: &CalibrationFit,
        frame: &CalibrationFrame,
        precision: &CalibrationPrecision,
        (unknown, value): (usize, f64),
    ) -> CalibrationFit {
        let held = frame.free.row(unknown).transpose();
        if frame.holds(unknown) {
            return from.clone();
        }
        // The others follow as the covariance says, if it knows this unknown.
        let seen = &precision.free_covariance * &held;
        let seen = if held.dot(&seen) > 0.0 { seen } else { held.clone() };
        let along = &seen * ((value - from.values[unknown]) / held.dot(&seen));
        self.fit_across(from, frame, &along, &held)
    }

    /// Fit from values moved by `along` the free directions, with the combination `held` of them held.
    fn fit_across(&self, from: &CalibrationFit, frame: &CalibrationFrame, along: &DVec, held: &DVec) -> CalibrationFit {
        let values = DVec::from_column_slice(&from.values) + &frame.free * along;
        let rest = &frame.free * null_space(&DMat::from_rows(&[held.transpose()]));
        self.fit_on(from, values.as_slice(), &rest)
    }
}

//! Covariance of the calibrated numbers of a robot file, as `uncertainty` reads it.

use super::report::CalibrationReport;
use crate::rows::rows;
use funicular::calibration::CalibrationUnknown;
use funicular::robot::parameters::quoted_key;

rows! {
    /// Entry of the covariance of calibrated numbers.
    pub struct CovarianceRow in tables() {
        /// path of the first number in the robot file
        pub first: String => one.plain("first");
        /// path of the second number; that of the first for its variance
        pub second: String => one.plain("second");
        /// covariance, in the product of their units
        pub covariance: f64 => one.significant("covariance", 4).unit("");
    }
}

impl CalibrationReport<'_> {
    /// Entries that are not zero, each pair once; none if the readings leave a number undetermined or do not tell their
    /// own deviation.
    ///
    /// A true offset that is larger than its value makes the cable, at a commanded reading, longer: the number of the
    /// robot file is its unstrained length. Factors and the scale are no numbers of the file.
    pub(super) fn covariance(&self) -> Vec<CovarianceRow> {
        let Some((variance, _)) = self.noise() else { return Vec::new() };
        if !self.precision.lost.is_empty() || self.is_misfit() {
            return Vec::new();
        }
        let path = |k: usize| match self.of.unknowns[k] {
            CalibrationUnknown::Offset { cable } => {
                Some(format!("cables.{}.unstrained_length_m", quoted_key(&self.of.robot.cables[cable].name)))
            }
            of if of.is_in_file() => Some(self.paths[k].0.clone()),
            _ => None,
        };
        let numbers: Vec<(usize, String)> = (0..self.of.unknowns.len()).filter_map(|k| Some((k, path(k)?))).collect();
        let mut entries = Vec::new();
        for (n, (i, first)) in numbers.iter().enumerate() {
            for (j, second) in &numbers[n..] {
                let covariance = variance * self.precision.covariance[(*i, *j)];
                if covariance != 0.0 {
                    entries.push(CovarianceRow { first: first.clone(), second: second.clone(), covariance });
                }
            }
        }
        entries
    }
}

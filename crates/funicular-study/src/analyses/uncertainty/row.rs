//! Results with their derivatives by the numbers that deviate.

use super::distribution::half_width;
use super::inputs::{DeviatingNumber, Distribution, Inputs};
use crate::measure::Measure;
use funicular::robot::RobotChange;

/// Result with its derivatives.
#[derive(Clone)]
pub(crate) struct Row {
    /// Result.
    pub(crate) kind: Measure,
    /// Value for the undisturbed robot.
    pub(crate) value: f64,
    /// Derivatives by the numbers that deviate; absent for a result without a gradient.
    pub(crate) derivatives: Option<Vec<f64>>,
    /// Reason for sampling: why the linear deviation is not valid; absent where it is valid.
    pub(crate) sampling_reason: Option<String>,
}

impl Row {
    /// Contributions to the variance, one per number.
    pub(crate) fn contributions(&self, distributions: &[Distribution]) -> Option<Vec<f64>> {
        let derivatives = self.derivatives.as_ref()?;
        Some(derivatives.iter().zip(distributions).map(|(j, of)| (j * of.deviation()).powi(2)).collect())
    }

    /// Standard deviation, and half width of the interval that holds 95 %.
    pub(crate) fn spread(&self, distributions: &[Distribution]) -> Option<(f64, f64)> {
        self.derivatives.as_ref().map(|derivatives| spread(derivatives, distributions))
    }

    /// Linear worst case: sum of the absolute changes over all tolerances. Normal deviations have none.
    pub(crate) fn worst(&self, distributions: &[Distribution]) -> Option<f64> {
        let derivatives = self.derivatives.as_ref()?;
        Some(derivatives.iter().zip(distributions).filter_map(|(j, of)| Some((j * of.half_width()?).abs())).sum())
    }
}

/// Standard deviation of a linear result, and half width of the interval that holds 95 %.
fn spread(derivatives: &[f64], distributions: &[Distribution]) -> (f64, f64) {
    let (mut normal, mut half_widths) = (0.0, Vec::new());
    for (derivative, distribution) in derivatives.iter().zip(distributions) {
        match distribution {
            Distribution::Normal(deviation) => normal += (derivative * deviation).powi(2),
            Distribution::Uniform(width) => half_widths.push((derivative * width).abs()),
        }
    }
    let variance = normal + half_widths.iter().map(|width| width * width / 3.0).sum::<f64>();
    (variance.sqrt(), half_width(normal, &half_widths))
}

/// Maximum change of a linear result within `factor` standard deviations; tolerances bound it.
fn reach(derivatives: &[f64], distributions: &[Distribution], factor: f64) -> f64 {
    let (mut normal, mut uniform, mut bound) = (0.0, 0.0, 0.0);
    for (derivative, distribution) in derivatives.iter().zip(distributions) {
        let deviation = (derivative * distribution.deviation()).powi(2);
        match distribution.half_width() {
            None => normal += deviation,
            Some(width) => {
                uniform += deviation;
                bound += (derivative * width).abs();
            }
        }
    }
    (factor * (normal + uniform).sqrt()).min(factor * normal.sqrt() + bound)
}

/// Changes of the robot along which results are differentiated.
pub(super) struct Along<'a> {
    pub(super) inputs: &'a Inputs,
    pub(super) changes: &'a [Option<RobotChange>],
    pub(super) distributions: &'a [Distribution],
}

impl Along<'_> {
    /// Directions of all numbers; the error names a number that has none.
    pub(super) fn directions(&self) -> Result<Vec<RobotChange>, String> {
        let direction = |(input, change): (&DeviatingNumber, &Option<RobotChange>)| {
            change.clone().ok_or_else(|| format!("{} has no derivative", input.path))
        };
        self.inputs.list.iter().zip(self.changes).map(direction).collect()
    }

    /// Maximum change of a result with these derivatives within `factor` standard deviations.
    pub(super) fn reach(&self, derivatives: &[f64], factor: f64) -> f64 {
        reach(derivatives, self.distributions, factor)
    }

    /// Derivatives of a result by all numbers; the error names a number that has none.
    pub(super) fn of(&self, gradient: &RobotChange) -> Result<Vec<f64>, String> {
        let derivative = |(input, change): (&DeviatingNumber, &Option<RobotChange>)| match change {
            Some(change) => Ok(gradient.dot(change) + 0.0),
            None => Err(format!("{} has no derivative", input.path)),
        };
        self.inputs.list.iter().zip(self.changes).map(derivative).collect()
    }
}

//! Values to identify: their paths, bounds and priors, and the dimensionless coordinates in which they are searched.

use crate::chosen_numbers::{ChosenNumber, chosen_numbers};
use crate::request::FitValue;
use crate::values::MIN_POSITIVE;
use anyhow::{Result, bail};
use funicular::robot::parameters::Parameters;

/// Usual relative error of a positive value without a prior: it spreads the starts, and is the unit of weak directions.
const SPREAD: f64 = 0.3;

/// Usual error of a length that may be zero, such as a coordinate of a centre of mass [m].
const LENGTH_SPREAD: f64 = 0.03;

/// Usual magnitude of a product of inertia that the file gives as zero, relative to the mean principal moment.
const PRODUCT_OF_INERTIA: f64 = 0.1;

/// Usual magnitude of the damping of ropes that the file gives as zero: damping ratio and loss factor, and damping time
/// of the stretch [s].
const DAMPING: f64 = 0.01;
const DAMPING_TIME: f64 = 1e-3;

/// Maximum number of values that a request may fit: a Jacobian by differences takes two evaluations each.
const MAX_UNKNOWNS: usize = 200;

/// Value to identify.
#[derive(Debug, Clone)]
pub(crate) struct Unknown {
    /// Index in the list of parameters.
    pub(crate) index: usize,
    /// Path.
    pub(crate) path: String,
    /// Unit.
    pub(crate) unit: &'static str,
    /// True for a positive value, whose logarithm is searched.
    pub(crate) is_log: bool,
    /// Value in the file.
    pub(crate) start: f64,
    /// Minimum and maximum.
    pub(crate) bounds: [f64; 2],
    /// Value known beforehand and its deviation.
    pub(crate) prior: Option<(f64, f64)>,
    /// Unit of the coordinate of a value without logarithm.
    unit_step: f64,
}

impl Unknown {
    /// Coordinate of a value.
    pub(crate) fn coordinate(&self, value: f64) -> f64 {
        if self.is_log { value.ln() } else { value / self.unit_step }
    }

    /// Value of a coordinate, within the bounds.
    pub(crate) fn value(&self, coordinate: f64) -> f64 {
        let value = if self.is_log { coordinate.exp() } else { coordinate * self.unit_step };
        value.clamp(self.bounds[0], self.bounds[1])
    }

    /// Bounds of the coordinate.
    pub(crate) fn coordinate_bounds(&self) -> (f64, f64) {
        let [low, high] = self.bounds;
        (self.coordinate(low), self.coordinate(high))
    }

    /// Coordinate and deviation of the prior.
    pub(crate) fn coordinate_prior(&self) -> Option<(f64, f64)> {
        let (value, deviation) = self.prior?;
        let scale = if self.is_log { value } else { self.unit_step };
        Some((self.coordinate(value), deviation / scale))
    }

    /// Spread of the coordinate beforehand: the prior's deviation, or the usual error.
    pub(crate) fn spread(&self) -> f64 {
        match self.coordinate_prior() {
            Some((_, deviation)) => deviation,
            None if self.is_log => SPREAD,
            None => 1.0,
        }
    }

    /// Derivative of the value by the coordinate, at a value.
    pub(crate) fn rate(&self, value: f64) -> f64 {
        if self.is_log { value } else { self.unit_step }
    }
}

/// Values to identify, in the order of the request.
///
/// # Errors
/// A path that the file does not have, the same value twice, or bounds and priors that contradict each other.
pub(crate) fn unknowns(parameters: &Parameters, fit: &[FitValue]) -> Result<Vec<Unknown>> {
    if fit.is_empty() {
        bail!("⟪fit⟫ is empty: name at least one value of the robot file, as in platform.mass_kg");
    }
    let limit = (MAX_UNKNOWNS, "be identified");
    let chosen = chosen_numbers(parameters, "fit", fit, |wanted| &wanted.path, limit)?;
    chosen.iter().map(|(number, wanted)| unknown(parameters, number, wanted)).collect()
}

fn unknown(parameters: &Parameters, number: &ChosenNumber<'_>, wanted: &FitValue) -> Result<Unknown> {
    let ChosenNumber { index, parameter, .. } = *number;
    number.check_given()?;
    let (start, range) = (parameter.value, parameter.range);
    let is_moment = matches!(parameter.component, Some("xx" | "yy" | "zz"))
        || parameter.key == "inertia_kg_m2" && parameter.component.is_none();
    let is_log = start > 0.0 && (range.minimum() >= 0.0 || is_moment);

    let lowest = if is_log { range.minimum().max(MIN_POSITIVE) } else { range.minimum() };
    let allowed = [lowest, range.maximum()];
    let bounds = [wanted.minimum.unwrap_or(allowed[0]), wanted.maximum.unwrap_or(allowed[1])];
    number.check_finite([wanted.minimum, wanted.maximum, wanted.prior, wanted.prior_std])?;
    number.check_bounds(bounds, allowed)?;

    let path = parameter.path();
    let prior = checked_prior(wanted, &path, start, is_log)?;
    let unit_step = match (prior, parameter.unit) {
        (Some((_, deviation)), _) => deviation,
        (None, "m") => LENGTH_SPREAD,
        (None, _) if start != 0.0 => SPREAD * start.abs(),
        (None, "kg m²") => SPREAD * PRODUCT_OF_INERTIA * mean_moment(parameters).max(MIN_POSITIVE),
        (None, "1") if matches!(parameter.key, "damping_ratio" | "axial_loss_factor") => DAMPING,
        (None, "s") if parameter.key == "axial_damping_time_s" => DAMPING_TIME,
        (None, _) => 1.0,
    };
    Ok(Unknown { index, path, unit: parameter.unit, is_log, start, bounds, prior, unit_step })
}

/// Value known beforehand and its deviation, as a request gives them for the value `start` of the file.
///
/// # Errors
/// A deviation that is missing or not positive, or a value that is not positive although its logarithm is searched.
fn checked_prior(wanted: &FitValue, path: &str, start: f64, is_log: bool) -> Result<Option<(f64, f64)>> {
    match (wanted.prior, wanted.prior_std) {
        (value, Some(deviation)) if deviation > 0.0 => {
            let value = value.unwrap_or(start);
            if is_log && value <= 0.0 {
                bail!("⟪prior⟫ {path}: {value} is not positive");
            }
            Ok(Some((value, deviation)))
        }
        (_, Some(deviation)) => bail!("⟪prior⟫ {path}: the deviation {deviation} is not positive"),
        (Some(_), None) => bail!("⟪prior⟫ {path}: the deviation is missing, as in {path}=20±1"),
        (None, None) => Ok(None),
    }
}

/// Mean principal moment of inertia of the platform [kg m²].
fn mean_moment(parameters: &Parameters) -> f64 {
    parameters.robot().platform.inertia_p.trace() / 3.0
}

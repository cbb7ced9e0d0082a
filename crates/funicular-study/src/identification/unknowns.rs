//! Values to identify: their paths, bounds and priors, and the dimensionless coordinates in which they are searched.

use crate::request::FitValue;
use crate::set_values;
use anyhow::{Result, anyhow, bail};
use funicular::robot::parameters::{Parameter, Parameters};

/// Usual relative error of a positive value beforehand: spread of the starts, and unit of weak directions, where there is
/// no prior.
const SPREAD: f64 = 0.3;

/// Usual error of a length that may be zero, as of a centre of mass [m].
const LENGTH_SPREAD: f64 = 0.03;

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
    /// Bounds.
    pub(crate) bounds: (f64, f64),
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
        value.clamp(self.bounds.0, self.bounds.1)
    }

    /// Bounds of the coordinate.
    pub(crate) fn coordinate_bounds(&self) -> (f64, f64) {
        let (low, high) = self.bounds;
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
    let mut found: Vec<Unknown> = Vec::new();
    for wanted in fit {
        for index in matching(parameters, &wanted.path)? {
            let unknown = unknown(parameters, index, wanted)?;
            if found.iter().any(|other| other.index == index) {
                bail!("⟪fit⟫ {}: the value {} is there twice", wanted.path, unknown.path);
            }
            found.push(unknown);
        }
    }
    if found.len() > MAX_UNKNOWNS {
        bail!("⟪fit⟫ names {} values, and at most {MAX_UNKNOWNS} can be identified at once", found.len());
    }
    Ok(found)
}

/// Indices of the parameters at a path, in which `*` stands for any name; a key with components stands for all of them.
fn matching(parameters: &Parameters, text: &str) -> Result<Vec<usize>> {
    let refuse = |reason: String| anyhow!("⟪fit⟫ {text}: {reason}");
    let starred = set_values::path(&text.replace('*', "'*'").replace("''*''", "'*'")).map_err(refuse)?;
    let keys = starred.keys();
    if let Some(index) = parameters.find(keys) {
        return Ok(vec![index]);
    }
    let list = parameters.list();
    let fits = |parameter: &Parameter| {
        parameter.keys.len() >= keys.len()
            && parameter.keys.len() <= keys.len() + usize::from(parameter.component.is_some())
            && keys.iter().zip(&parameter.keys).all(|(key, own)| key == "*" || key == own)
    };
    let found: Vec<usize> = (0..list.len()).filter(|&i| fits(&list[i])).collect();
    if found.is_empty() {
        let all: Vec<String> = list.iter().map(Parameter::path).collect();
        let near = crate::names::suggestion(text, &all);
        return Err(anyhow!("⟪fit⟫ {text}: the robot file has no such number{near}"));
    }
    Ok(found)
}

fn unknown(parameters: &Parameters, index: usize, wanted: &FitValue) -> Result<Unknown> {
    let parameter = &parameters.list()[index];
    let path = parameter.path();
    let refuse = |reason: String| anyhow!("⟪fit⟫ {path}: {reason}");
    if !parameter.given {
        bail!(
            "⟪fit⟫ {path}: the robot file does not give it; write it there, or give ⟪set⟫ {path}={}",
            parameter.value
        );
    }

    let (start, range) = (parameter.value, parameter.range);
    let is_moment = matches!(parameter.component, Some("xx" | "yy" | "zz"))
        || parameter.key == "inertia_kg_m2" && parameter.component.is_none();
    let is_log = start > 0.0 && (range.minimum() >= 0.0 || is_moment);
    let (lowest, highest) =
        (if is_log { range.minimum().max(funicular_min()) } else { range.minimum() }, range.maximum());
    let bounds = (wanted.minimum.unwrap_or(lowest), wanted.maximum.unwrap_or(highest));
    for bound in [wanted.minimum, wanted.maximum, wanted.prior, wanted.prior_std].into_iter().flatten() {
        crate::values::finite(bound).map_err(refuse)?;
    }
    if bounds.0 >= bounds.1 {
        bail!("⟪fit⟫ {path}: the minimum {} is not below the maximum {}", bounds.0, bounds.1);
    }
    if bounds.0 < lowest || bounds.1 > highest {
        bail!("⟪fit⟫ {path}: the bounds {} to {} leave the range of the value: {range}", bounds.0, bounds.1);
    }
    if !(bounds.0..=bounds.1).contains(&start) {
        bail!(
            "⟪fit⟫ {path}: the value {start} of the robot file is not between the bounds {} and {}: change the bounds, \
             or the value by ⟪set⟫",
            bounds.0,
            bounds.1
        );
    }

    let prior = match (wanted.prior, wanted.prior_std) {
        (value, Some(deviation)) if deviation > 0.0 => {
            let value = value.unwrap_or(start);
            if is_log && value <= 0.0 {
                bail!("⟪prior⟫ {path}: {value} is not positive");
            }
            Some((value, deviation))
        }
        (_, Some(deviation)) => bail!("⟪prior⟫ {path}: the deviation {deviation} is not positive"),
        (Some(_), None) => bail!("⟪prior⟫ {path}: the deviation is missing, as in {path}=20±1"),
        (None, None) => None,
    };
    let unit_step = match (prior, parameter.unit) {
        (Some((_, deviation)), _) => deviation,
        (None, "m") => LENGTH_SPREAD,
        (None, _) if start != 0.0 => SPREAD * start.abs(),
        // A product of inertia of zero: a tenth of a usual moment.
        (None, "kg m²") => SPREAD * 0.1 * trace(parameters).max(funicular_min()),
        (None, _) => 1.0,
    };
    Ok(Unknown { index, path, unit: parameter.unit, is_log, start, bounds, prior, unit_step })
}

/// Minimum of a positive number of a robot file.
fn funicular_min() -> f64 {
    crate::values::MIN_POSITIVE
}

/// Mean principal moment of the platform [kg m²].
fn trace(parameters: &Parameters) -> f64 {
    parameters.robot().platform.inertia_p.trace() / 3.0
}

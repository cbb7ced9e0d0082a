//! Values of a robot file that a design may change, with their bounds.

use crate::analyses::gradient::Pattern;
use crate::names::suggestion;
use crate::request::ChangeValue;
use crate::set_values;
use anyhow::{Result, anyhow, bail};
use funicular::robot::parameters::{Parameter, Parameters};

/// Maximum number of values: the linear problems of a search have as many unknowns, and take seconds beyond.
const MAX_VARIABLES: usize = 300;

/// Value that a design may change.
#[derive(Debug, Clone)]
pub(crate) struct Variable {
    /// Index in the list of parameters.
    pub(crate) index: usize,
    pub(crate) path: String,
    pub(crate) unit: &'static str,
    /// Value in the file.
    pub(crate) start: f64,
    /// Minimum and maximum.
    pub(crate) bounds: [f64; 2],
}

/// Values to change, in the order of the request.
///
/// # Errors
/// A path that the file does not have, the same value twice, a value without derivatives, or bounds that are missing,
/// contradict each other, or exclude the present value.
pub(crate) fn variables(parameters: &Parameters, change: &[ChangeValue]) -> Result<Vec<Variable>> {
    if change.is_empty() {
        bail!(
            "⟪change⟫ is empty: name at least one value of the robot file with its bounds, as in cables.*.attachment_m=±0.05"
        );
    }
    let list = parameters.list();
    let mut found: Vec<Variable> = Vec::new();
    for wanted in change {
        let pattern = Pattern::parse("change", &wanted.path)?;
        let matching: Vec<usize> = (0..list.len()).filter(|&i| pattern.matches(&list[i].keys)).collect();
        if matching.is_empty() {
            let all: Vec<String> = list.iter().map(Parameter::path).collect();
            bail!("⟪change⟫ {}: the robot file has no such number{}", wanted.path, suggestion(&wanted.path, &all));
        }
        for index in matching {
            if found.iter().any(|other| other.index == index) {
                bail!("⟪change⟫ {}: the value {} is there twice", wanted.path, list[index].path());
            }
            found.push(variable(parameters, index, wanted)?);
        }
    }
    if found.len() > MAX_VARIABLES {
        bail!("⟪change⟫ names {} values, and at most {MAX_VARIABLES} can change at once", found.len());
    }
    Ok(found)
}

fn variable(parameters: &Parameters, index: usize, wanted: &ChangeValue) -> Result<Variable> {
    let parameter = &parameters.list()[index];
    let (path, start, range) = (parameter.path(), parameter.value, parameter.range);
    let refuse = |reason: String| anyhow!("⟪change⟫ {path}: {reason}");
    if !parameter.given {
        return Err(refuse(format!("the robot file does not give it; write it there, or give ⟪set⟫ {path}={start}")));
    }
    let is_of_state = parameter.keys.first().is_some_and(|key| key == "state");
    if is_of_state || parameter.key == "unstrained_length_m" {
        return Err(refuse(
            "the poses of a design are held, and the lengths follow from them; change another value".to_owned(),
        ));
    }
    if parameters.change(index).is_none() {
        return Err(refuse("results have no derivatives by this value, so that a design cannot choose it".to_owned()));
    }

    for bound in [wanted.minimum, wanted.maximum, wanted.plus_minus].into_iter().flatten() {
        crate::values::finite(bound).map_err(refuse)?;
    }
    let (low, high) = (range.minimum(), range.maximum());
    let bounds = match (wanted.minimum, wanted.maximum, wanted.plus_minus) {
        // Around the present value, as far as the value may go.
        (None, None, Some(reach)) if reach > 0.0 => [rounded(start - reach).max(low), rounded(start + reach).min(high)],
        (None, None, Some(reach)) => return Err(refuse(format!("±{reach} leaves no room: give a positive number"))),
        (Some(minimum), Some(maximum), None) => [minimum, maximum],
        (_, _, Some(_)) => return Err(refuse("give ± or a minimum and a maximum, not both".to_owned())),
        (_, _, None) => {
            return Err(refuse(format!("both bounds are needed, as in {path}=±0.05 or {path}=MIN:MAX")));
        }
    };
    if bounds[0] >= bounds[1] {
        return Err(refuse(format!("the minimum {} is not below the maximum {}", bounds[0], bounds[1])));
    }
    if bounds[0] < low || bounds[1] > high {
        return Err(refuse(format!("the bounds {} to {} leave the range of the value: {range}", bounds[0], bounds[1])));
    }
    if !(bounds[0]..=bounds[1]).contains(&start) {
        return Err(refuse(format!(
            "the value {start} of the robot file is not between the bounds {} and {}: change the bounds, or the value by \
             ⟪set⟫",
            bounds[0], bounds[1]
        )));
    }
    Ok(Variable { index, path, unit: parameter.unit, start, bounds })
}

impl Variable {
    /// Change of the text of the robot file to another value.
    pub(crate) fn assignment(&self, value: f64) -> Result<set_values::Assignment> {
        let path = set_values::path(&self.path).map_err(|reason| anyhow!("{reason}"))?;
        Ok(path.with("⟪change⟫", value))
    }
}

/// Number with twelve digits, without the rounding of its last ones: as a user would write it.
pub(crate) fn rounded(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}

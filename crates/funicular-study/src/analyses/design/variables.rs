//! Values of a robot file that a design may change, with their bounds.

use crate::chosen_numbers::{ChosenNumber, chosen_numbers};
use crate::request::ChangeValue;
use crate::set_values;
use anyhow::{Result, anyhow, bail};
use funicular::robot::parameters::Parameters;

/// Maximum number of values that a design may change: the linear problem of a step has as many unknowns, and takes
/// seconds beyond.
const MAX_VARIABLES: usize = 300;

/// Keys of the limits of tensions, by which some goals have differences.
const LIMITS: [&str; 2] = ["minimum_tension_n", "maximum_tension_n"];

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
    /// Place in the request of what names it.
    pub(crate) change: usize,
    /// True for a limit of tensions, by which results have no derivatives but differences.
    pub(crate) is_limit: bool,
}

/// Values to change, in the order of the request.
///
/// # Errors
/// A path that the file does not have, the same value twice, a value without derivatives, or bounds that are missing,
/// contradict each other, or exclude the present value.
pub(crate) fn variables(parameters: &Parameters, change: &[ChangeValue]) -> Result<Vec<Variable>> {
    if change.is_empty() {
        bail!(
            "⟪change⟫ is empty: name at least one value of the robot file with its bounds, as in \
             cables.*.attachment_m=±0.05"
        );
    }
    let limit = (MAX_VARIABLES, "change");
    let chosen = chosen_numbers(parameters, "change", change, |wanted| &wanted.path, limit)?;
    let place = |wanted: &ChangeValue| change.iter().position(|of| std::ptr::eq(of, wanted)).unwrap_or(0);
    chosen.iter().map(|(number, wanted)| variable(parameters, number, (wanted, place(wanted)))).collect()
}

fn variable(
    parameters: &Parameters,
    number: &ChosenNumber<'_>,
    (wanted, change): (&ChangeValue, usize),
) -> Result<Variable> {
    let ChosenNumber { index, parameter, .. } = *number;
    let (path, start, range) = (parameter.path(), parameter.value, parameter.range);
    number.check_given()?;
    let is_of_state = parameter.keys.first().is_some_and(|key| key == "state");
    if is_of_state || parameter.key == "unstrained_length_m" {
        return Err(
            number.refuse("the poses of a design are held, and the lengths follow from them; change another value")
        );
    }
    let is_limit = LIMITS.contains(&parameter.key);
    if !is_limit && parameters.change(index).is_none() {
        return Err(number.refuse("results have no derivatives by this value, so that a design cannot choose it"));
    }

    number.check_finite([wanted.minimum, wanted.maximum, wanted.plus_minus])?;
    let [low, high] = [range.minimum(), range.maximum()];
    let bounds = match (wanted.minimum, wanted.maximum, wanted.plus_minus) {
        // Around the present value, as far as the value may go.
        (None, None, Some(reach)) if reach > 0.0 => [rounded(start - reach).max(low), rounded(start + reach).min(high)],
        (None, None, Some(reach)) => {
            return Err(number.refuse(format!("±{reach} leaves no room: give a positive number")));
        }
        (Some(minimum), Some(maximum), None) => [minimum, maximum],
        (_, _, Some(_)) => return Err(number.refuse("give ± or a minimum and a maximum, not both")),
        (_, _, None) => {
            return Err(number.refuse(format!("both bounds are needed, as in {path}=±0.05 or {path}=MIN:MAX")));
        }
    };
    number.check_bounds(bounds, [low, high])?;
    Ok(Variable { index, path, unit: parameter.unit, start, bounds, change, is_limit })
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

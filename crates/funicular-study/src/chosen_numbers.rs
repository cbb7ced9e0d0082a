//! Numbers of the robot file that a request lets vary within bounds, and their checks: one rule for all commands.

use crate::parameter_pattern::ParameterPattern;
use crate::values;
use anyhow::{Result, anyhow, bail};
use funicular::robot::parameters::{Parameter, Parameters};

/// Number of the robot file that an option chooses.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ChosenNumber<'a> {
    option: &'static str,
    /// Index in the list of parameters.
    pub(crate) index: usize,
    pub(crate) parameter: &'a Parameter,
}

/// Numbers at the paths of `wanted`, in their order, each with its element of `wanted`. `limit` is their maximum
/// number, and the verb for what is done with them, as in "be identified".
///
/// # Errors
/// A path that the file does not have, the same number twice, or too many numbers.
pub(crate) fn chosen_numbers<'a, T>(
    parameters: &'a Parameters,
    option: &'static str,
    wanted: &'a [T],
    path: impl Fn(&T) -> &str,
    (max, verb): (usize, &str),
) -> Result<Vec<(ChosenNumber<'a>, &'a T)>> {
    let mut found: Vec<(ChosenNumber<'a>, &'a T)> = Vec::new();
    for element in wanted {
        let pattern = ParameterPattern::parse(option, path(element), parameters)?;
        for index in pattern.changeable(parameters)? {
            let number = ChosenNumber { option, index, parameter: &parameters.list()[index] };
            if found.iter().any(|(other, _)| other.index == index) {
                bail!("⟪{option}⟫ {}: the value {} is there twice", pattern.text(), number.parameter.path());
            }
            found.push((number, element));
        }
    }

    if found.len() > max {
        bail!("⟪{option}⟫ names {} values, and at most {max} can {verb} at once", found.len());
    }
    Ok(found)
}

impl ChosenNumber<'_> {
    /// Error with the option and the path.
    pub(crate) fn refuse(&self, reason: impl std::fmt::Display) -> anyhow::Error {
        anyhow!("⟪{}⟫ {}: {reason}", self.option, self.parameter.path())
    }

    /// Refuses a number that the robot file does not give: a default has no place where another value could be written.
    pub(crate) fn check_given(&self) -> Result<()> {
        let Parameter { given, value, .. } = self.parameter;
        if *given {
            return Ok(());
        }
        let path = self.parameter.path();
        Err(self.refuse(format!("the robot file does not give it; write it there, or give ⟪set⟫ {path}={value}")))
    }

    /// Refuses numbers of a request that are not finite.
    pub(crate) fn check_finite<const N: usize>(&self, numbers: [Option<f64>; N]) -> Result<()> {
        numbers.into_iter().flatten().try_for_each(|number| {
            values::finite(number).map_err(|reason| self.refuse(reason))?;
            Ok(())
        })
    }

    /// Refuses bounds that contradict each other, leave the `allowed` values or exclude the value of the robot file.
    pub(crate) fn check_bounds(&self, bounds: [f64; 2], allowed: [f64; 2]) -> Result<()> {
        let [low, high] = bounds;
        let Parameter { value, range, .. } = self.parameter;
        if low >= high {
            return Err(self.refuse(format!("the minimum {low} is not below the maximum {high}")));
        }
        if low < allowed[0] || high > allowed[1] {
            return Err(self.refuse(format!("the bounds {low} to {high} leave the range of the value: {range}")));
        }
        if !(low..=high).contains(value) {
            return Err(self.refuse(format!(
                "the value {value} of the robot file is not between the bounds {low} and {high}: change the bounds, or \
                 the value by ⟪set⟫"
            )));
        }
        Ok(())
    }
}

/// Bound at which a value is, `minimum` or `maximum`; `None` between them. A value within `near` of a bound is at it.
pub(crate) fn at_bound(value: f64, [low, high]: [f64; 2], near: f64) -> Option<&'static str> {
    match value {
        value if value <= low + near => Some("minimum"),
        value if value >= high - near => Some("maximum"),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_at_a_bound_within_the_distance_that_counts_as_near() {
        assert_eq!(at_bound(1.0, [1.0, 2.0], 0.0), Some("minimum"));
        assert_eq!(at_bound(2.0, [1.0, 2.0], 0.0), Some("maximum"));
        assert_eq!(at_bound(1.0 + 1e-10, [1.0, 2.0], 0.0), None);
        assert_eq!(at_bound(1.0 + 1e-10, [1.0, 2.0], 1e-9), Some("minimum"));
        assert_eq!(at_bound(2.0 - 1e-10, [1.0, 2.0], 1e-9), Some("maximum"));
    }
}

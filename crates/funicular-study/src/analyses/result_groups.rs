//! Groups of results that a request of `gradient` or `uncertainty` names: one rule for both.

use crate::names::{listed, suggestion};
use crate::request;
use anyhow::{Result, anyhow, bail};

/// Groups of results, by the names of a request.
pub(crate) const RESULT_GROUPS: [&str; 7] =
    ["pose", "lengths", "tensions", "stiffness-min", "frequencies", "damping", "response"];

/// Groups of results that a request names, with its limit of the frequencies [Hz].
///
/// # Errors
/// A name that no group has, no name at all, or a limit that is missing or not positive.
pub(crate) fn result_groups(names: &[String], below_hz: Option<f64>) -> Result<Vec<&'static str>> {
    let known = || RESULT_GROUPS.map(str::to_owned);
    let group = |name: &String| {
        let found = RESULT_GROUPS.into_iter().find(|group| group == name);
        found.ok_or_else(|| anyhow!("⟪of⟫: there is no result `{name}`{}", suggestion(name, &known())))
    };
    let groups: Vec<&str> = names.iter().map(group).collect::<Result<_>>()?;
    if groups.is_empty() {
        bail!("⟪of⟫ names no result{}", listed(&known()));
    }

    for group in ["frequencies", "damping"] {
        if groups.contains(&group) && below_hz.is_none() {
            return Err(missing_option(group, "below_hz"));
        }
    }
    below_hz.map_or(Ok(()), |hz| request::check_positive("below_hz", hz))?;
    Ok(groups)
}

/// Error of a group of results without an option that it needs.
pub(crate) fn missing_option(group: &str, option: &str) -> anyhow::Error {
    anyhow!("`{group}` needs ⟪{option}⟫")
}

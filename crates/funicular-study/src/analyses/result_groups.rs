//! Groups of results that a request of `gradient` or `uncertainty` names: one rule for both.

use crate::measure::{MEASURES, MeasureGroup};
use crate::names::{listed, suggestion};
use crate::request;
use anyhow::{Result, anyhow, bail};

/// Groups of results that a request names, with its limit of the frequencies [Hz].
///
/// # Errors
/// A name that no group has, no name at all, or a limit that is missing or not positive.
pub(crate) fn result_groups(names: &[String], below_hz: Option<f64>) -> Result<Vec<&'static MeasureGroup>> {
    let known = || MeasureGroup::names().map(str::to_owned).collect::<Vec<_>>();
    let group = |name: &String| {
        let found = MEASURES.iter().find(|group| group.name() == name);
        found.ok_or_else(|| anyhow!("⟪of⟫: there is no result `{name}`{}", suggestion(name, &known())))
    };
    let groups: Vec<&MeasureGroup> = names.iter().map(group).collect::<Result<_>>()?;
    if groups.is_empty() {
        bail!("⟪of⟫ names no result{}", listed(&known()));
    }

    // In the order of all groups, whatever the order of the request.
    let mut of_modes = MEASURES.iter().filter(|group| group.is_of_modes() && groups.contains(group));
    if let Some(group) = of_modes.next().filter(|_| below_hz.is_none()) {
        return Err(missing_option(group, "below_hz"));
    }
    below_hz.map_or(Ok(()), |hz| request::check_positive("below_hz", hz))?;
    Ok(groups)
}

/// Refuses options that none of the groups uses, because they are likely meant for a group that is not named.
///
/// # Errors
/// A limit of the frequencies or an option of a response without such results.
pub(crate) fn refuse_unused(
    groups: &[&MeasureGroup],
    below_hz: Option<f64>,
    has_at_hz: bool,
    [input, output]: [Option<&str>; 2],
    points: &request::ResponsePoints,
) -> Result<()> {
    let of_modes = groups.iter().any(|group| group.is_of_modes());
    let of_response = groups.contains(&&MeasureGroup::Response);
    for (option, is_given, is_used, wanted) in [
        ("below_hz", below_hz.is_some(), of_modes, "`frequencies` or `damping`"),
        ("at_hz", has_at_hz, of_response, "`response`"),
        ("input", input.is_some(), of_response, "`response`"),
        ("output", output.is_some(), of_response, "`response`"),
        ("input_point_m", points.input_point_m.is_some(), of_response, "`response`"),
        ("output_point_m", points.output_point_m.is_some(), of_response, "`response`"),
    ] {
        if is_given && !is_used {
            bail!("⟪{option}⟫ has no effect on {}: add {wanted} to ⟪of⟫, or leave it out", listed_alone(groups));
        }
    }
    Ok(())
}

/// Names of groups for the middle of a sentence.
fn listed_alone(groups: &[&MeasureGroup]) -> String {
    groups.iter().map(|group| format!("`{}`", group.name())).collect::<Vec<_>>().join(", ")
}

/// Caveat of a list of modes that is empty: its limit [Hz] is below the first natural frequency.
pub(crate) fn nothing_below(below_hz: f64) -> String {
    format!("no natural frequency lies below {below_hz} Hz: raise ⟪below_hz⟫")
}

/// Error of a group of results without an option that it needs.
pub(crate) fn missing_option(group: &MeasureGroup, option: &str) -> anyhow::Error {
    anyhow!("`{}` needs ⟪{option}⟫", group.name())
}

//! Tension limits and the rule that chooses the tensions.

use crate::names::TensionRuleName;
use crate::request::Tensions;
use anyhow::{Result, bail};
use funicular::robot::{Robot, TensionLimits};
use funicular::statics::TensionRule;

/// Robot with the tension limits of a request.
///
/// # Errors
/// A maximum above the breaking load of a rope, or a minimum that is not below the maximum of a cable.
pub fn with_limits(robot: &Robot, tensions: &Tensions) -> Result<Robot> {
    tensions.check()?;
    refuse_above_breaking_load(robot, tensions)?;

    let limits = TensionLimits { minimum: tensions.min_tension_n, maximum: tensions.max_tension_n };
    let robot = robot.with_tension_limits(limits);

    for cable in &robot.cables {
        if let TensionLimits { minimum: Some(minimum), maximum: Some(maximum) } = cable.limits()
            && minimum >= maximum
        {
            bail!(
                "cable \"{}\": minimum tension {minimum} N is not below its maximum {maximum} N: give ⟪min_tension_n⟫ \
                 below ⟪max_tension_n⟫ (a limit that is not given comes from the robot file)",
                cable.name
            );
        }
    }

    Ok(robot)
}

/// Refuses a maximum above the breaking load of a rope, as the reader of robot files does. The message names a cable
/// with the lowest breaking load, so that the remedy holds for every cable.
///
/// # Errors
/// A maximum above the breaking load of a rope.
fn refuse_above_breaking_load(robot: &Robot, tensions: &Tensions) -> Result<()> {
    let Some(maximum) = tensions.max_tension_n else { return Ok(()) };
    let breaking = robot.cables.iter().filter_map(|cable| cable.material.breaking_load.map(|load| (cable, load)));
    let weakest = breaking.min_by(|(_, one), (_, other)| one.total_cmp(other));
    if let Some((cable, load)) = weakest.filter(|(_, load)| maximum > *load) {
        bail!(
            "cable \"{}\": maximum tension {maximum} N is above the breaking load {load} N of its rope \"{}\": give \
             ⟪max_tension_n⟫ of at most {load}, usually a fifth to a third of it, or change `breaking_load_n` in the \
             robot file",
            cable.name,
            cable.material.name
        );
    }
    Ok(())
}

/// Tension rule of a request. Target tensions without a rule stand for the rule `closest`.
///
/// # Errors
/// The rule `closest` without target tensions, or target tensions with another rule.
pub fn rule(tensions: &Tensions) -> Result<Option<TensionRule>> {
    Ok(match (tensions.tension_rule, tensions.target_tension_n.clone()) {
        (None | Some(TensionRuleName::Closest), Some(wanted)) => Some(TensionRule::Closest(wanted)),
        (Some(TensionRuleName::Closest), None) => bail!("⟪tension_rule⟫ closest needs ⟪target_tension_n⟫"),
        (Some(_), Some(_)) => {
            bail!("⟪target_tension_n⟫ is used by ⟪tension_rule⟫ closest only: leave out one of the two options")
        }
        (Some(TensionRuleName::Lowest), None) => Some(TensionRule::Lowest),
        (Some(TensionRuleName::Middle), None) => Some(TensionRule::Middle),
        (Some(TensionRuleName::Centre), None) => Some(TensionRule::Centre),
        (Some(TensionRuleName::Stiffest), None) => Some(TensionRule::Stiffest),
        (None, None) => None,
    })
}

//! Status of a row: a fixed short code and a text that say why numbers are missing.

use funicular::robot::Robot;
use funicular::statics::{Equilibrium, StaticsError};
use funicular::warnings;
use std::borrow::Cow;

/// Status of a row.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Status {
    pub(super) code: &'static str,
    pub(super) reason: String,
}

/// Every code that a row can have, with its meaning.
pub const CODES: &[(&str, &str)] = &[
    ("ok", "all requested quantities are there"),
    ("out-of-plane", "infeasible: a planar platform cannot have this pose"),
    ("coinciding-ends", "infeasible: a cable has no length between its ends, or ends inside the wheel of its pulley"),
    ("singular", "infeasible: the cables' directions are linearly dependent"),
    (
        "negative-tension",
        "infeasible: a straight cable would have to push, and no sagging cables that hold the pose were found",
    ),
    (
        "tension-limits",
        "infeasible: no tensions are within the limits, or a tension is beyond a limit or breaking load",
    ),
    (
        "interference",
        "infeasible: cables, platform and obstacles are nearer to each other than the file allows; the quantities are \
         there",
    ),
    ("not-found", "infeasible: no tensions within the limits were found, without a proof that there are none"),
    ("not-converged", "infeasible: no equilibrium was found"),
    ("invalid-robot", "infeasible: the values of this row do not make a valid robot"),
    ("invalid-state", "infeasible: the state does not fit the robot"),
    ("unstable", "the equilibrium is unstable: the platform leaves it by itself"),
    ("slack", "a cable carries no force"),
    (
        "no-frequency",
        "there is no natural frequency: the model does not exist here, or no such mode is below the limit or among the \
         modes that are computed",
    ),
    ("not-certified", "the frequencies are not certified"),
    ("no-decay", "the mode does not decay, because nothing damps it"),
    ("no-comparison", "another model that was requested has no result here"),
    ("unlimited", "no maximum tension limits the payload"),
    ("no-payload", "no payload with tensions within the limits was found"),
    ("no-derivative", "the equilibrium or the result has no derivative here"),
    ("dead-load", "a tension with the dead load is beyond its limit, so no required load counts"),
    ("required-load", "nothing is required, or nothing limits the required loads"),
    ("no-speed", "no velocity is required, or no winch limits the speed"),
    ("no-torque", "no drum has a radius, so there is no torque of a motor"),
    ("no-gusts", "the robot file has no turbulence, or there is no linear response to it"),
];

impl Status {
    pub(super) fn new(code: &'static str, reason: &(impl ToString + ?Sized)) -> Self {
        assert!(CODES.iter().any(|known| known.0 == code));
        Self { code, reason: reason.to_string() }
    }

    pub(super) fn of_error(error: &StaticsError) -> Self {
        let code = match error.code() {
            "limits-exclude" => "tension-limits",
            "not-nearest" => "not-converged",
            "inside-pulley" => "coinciding-ends",
            code if CODES.iter().any(|known| known.0 == code) => code,
            _ => "invalid-state",
        };
        Self::new(code, error)
    }

    /// Status of an infeasible equilibrium: a tension is beyond a limit of the robot.
    pub(super) fn of_infeasible(robot: &Robot, equilibrium: &Equilibrium) -> Option<Self> {
        let beyond = (0..equilibrium.cables.len()).find_map(|i| warnings::of_tension(robot, equilibrium, i))?;
        Some(Self::new("tension-limits", &beyond))
    }

    /// Status of a feasible equilibrium with a caveat: unstable, or with a slack cable.
    pub(super) fn note_for(robot: &Robot, equilibrium: &Equilibrium) -> Option<Self> {
        if let Some(unstable) = warnings::of_stability(equilibrium) {
            return Some(Self::new("unstable", &unstable));
        }
        let slack = (0..equilibrium.cables.len()).find_map(|i| warnings::of_slack(robot, equilibrium, i))?;
        Some(Self::new("slack", &slack))
    }

    /// Code and text of a status.
    pub(super) fn of(status: Option<Self>) -> (Cow<'static, str>, Option<Cow<'static, str>>) {
        match status {
            None => (Cow::Borrowed("ok"), None),
            Some(Self { code, reason }) => (Cow::Borrowed(code), Some(Cow::Owned(reason))),
        }
    }
}

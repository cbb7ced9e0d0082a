//! Why a row has no numbers, or not all: a short code that stays, and a text.

use funicular::robot::Robot;
use funicular::statics::{Equilibrium, Stability, StaticsError};
use funicular::warnings::{self, Warning};
use std::borrow::Cow;

/// What there is to say of a row.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Status {
    pub(super) code: &'static str,
    pub(super) reason: String,
}

/// Every code that a row can have, with what it means.
pub const CODES: [(&str, &str); 15] = [
    ("ok", "everything asked is there"),
    ("out-of-plane", "infeasible: a pose that a planar platform cannot have"),
    ("coinciding-ends", "infeasible: a cable has no length between its ends"),
    ("singular", "infeasible: the cables' directions are dependent"),
    (
        "negative-tension",
        "infeasible: a straight cable would have to push, and no sagging ones that hold the pose were found",
    ),
    ("tension-limits", "infeasible: no tensions within the limits, or beyond what a rope bears"),
    ("not-found", "infeasible: no tensions within the limits found, and no proof that there are none"),
    ("not-converged", "infeasible: no equilibrium found"),
    ("invalid-robot", "infeasible: the values of this row make no robot"),
    ("invalid-state", "infeasible: the state does not fit the robot"),
    ("unstable", "an equilibrium that the platform leaves by itself"),
    ("slack", "a cable carries no force"),
    ("no-frequency", "no natural frequency to give: the model does not exist here, or none is below the limit"),
    ("not-certified", "the frequencies are not certified"),
    ("no-comparison", "another model that was asked for has no answer here"),
];

impl Status {
    pub(super) fn new(code: &'static str, reason: &(impl ToString + ?Sized)) -> Self {
        debug_assert!(CODES.iter().any(|known| known.0 == code));
        Self { code, reason: reason.to_string() }
    }

    pub(super) fn of_error(error: &StaticsError) -> Self {
        let code = match error.code() {
            "limits-exclude" => "tension-limits",
            "not-nearest" => "not-converged",
            code if CODES.iter().any(|known| known.0 == code) => code,
            _ => "invalid-state",
        };
        Self::new(code, error)
    }

    /// What makes an equilibrium infeasible: limits of tension that the robot has.
    pub(super) fn refusing(robot: &Robot, equilibrium: &Equilibrium) -> Option<Self> {
        warnings::of_statics(robot, equilibrium).iter().find_map(|warning| match warning {
            Warning::Breaks { .. } | Warning::BeyondLimit { .. } => Some(Self::new("tension-limits", warning)),
            _ => None,
        })
    }

    /// What to mind of a feasible one.
    pub(super) fn note_for(robot: &Robot, equilibrium: &Equilibrium) -> Option<Self> {
        let unstable = matches!(equilibrium.stability, Stability::Unstable { .. });
        if !unstable && !equilibrium.cables.iter().any(funicular::statics::CableState::is_slack) {
            return None;
        }
        warnings::of_statics(robot, equilibrium).iter().find_map(|warning| match warning {
            Warning::Unstable { .. } => Some(Self::new("unstable", warning)),
            Warning::Slack { .. } if !unstable => Some(Self::new("slack", warning)),
            _ => None,
        })
    }

    /// Code and text as values.
    pub(super) fn of(status: Option<Self>) -> (Cow<'static, str>, Option<Cow<'static, str>>) {
        match status {
            None => (Cow::Borrowed("ok"), None),
            Some(Self { code, reason }) => (Cow::Borrowed(code), Some(Cow::Owned(reason))),
        }
    }
}

//! Why a pose has no equilibrium, as data: a page says it in its own words beside the pose.

use funicular::statics::{LimitViolation, Obstacle, StaticsError};
use serde_json::{Value, json};

/// Cause of an error of statics; null for any other error.
///
/// `push` are the cables that would have to push, `minimum` and `maximum` the cables whose limits prevent an
/// equilibrium, and `one_sided` tells that no cable pulls against the load. `code` is the short name of the error.
pub(crate) fn of(error: &anyhow::Error) -> Value {
    let Some(error) = error.downcast_ref::<StaticsError>() else { return Value::Null };
    let obstacle = error.obstacle();
    let opposed = match obstacle {
        Some(Obstacle::NotSpanned { opposed, .. }) => opposed.clone(),
        Some(Obstacle::OneSided { .. }) | None => Vec::new(),
    };
    let negative = match error {
        StaticsError::NegativeTension { cable, .. } | StaticsError::NotFound { cable, .. } if obstacle.is_none() => {
            vec![cable.clone()]
        }
        _ => Vec::new(),
    };
    let [minimum, maximum] = violation(error).map_or_else(Default::default, |miss| {
        if obstacle.is_some() { Default::default() } else { [&miss.minimum_of, &miss.maximum_of].map(Clone::clone) }
    });
    let push = [opposed, negative].concat();
    json!({
        "code": error.code(),
        "one_sided": matches!(obstacle, Some(Obstacle::OneSided { .. })),
        "push": push,
        "minimum": minimum,
        "maximum": maximum,
    })
}

/// Limits of tensions that an error is about.
fn violation(error: &StaticsError) -> Option<&LimitViolation> {
    match error {
        StaticsError::BeyondLimits(miss) | StaticsError::NotFoundWithinLimits { miss, .. } => Some(miss),
        _ => None,
    }
}

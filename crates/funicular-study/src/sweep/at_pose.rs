//! Quantities at a single pose, for searches that go through poses of their own choice.

use super::options::Options;
use super::points::Point;
use super::quantity::Quantity;
use super::row;
use crate::table::Value;
use funicular::robot::{Pose, Robot, State};
use std::borrow::Cow;

/// Values of all columns of quantities at a pose; `None` if no tensions within the limits hold it. They are those of a
/// map with this pose.
pub(crate) fn values_at(robot: &Robot, pose: &Pose, quantities: &[Quantity], options: &Options) -> Option<Vec<Value>> {
    let state = Cow::Owned(State::Pose(*pose));
    let point = Point { coordinates: Vec::new(), robot: Ok((Cow::Borrowed(robot), state)), holder: None };
    row::values(&point, &|| None, quantities, options)
}

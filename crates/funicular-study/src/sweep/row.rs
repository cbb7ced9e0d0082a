//! Evaluation of one point: its equilibrium and the requested quantities.

use super::evaluation::{PointEvaluation, ReadParameters};
use super::options::Options;
use super::points::Point;
use super::quantity::Quantity;
use super::status::Status;
use crate::table::Value;
use funicular::gradient::Hold;
use funicular::robot::{Robot, State};
use funicular::statics::{Equilibrium, Solution};

/// Adds the `width` cells of a point that follow its coordinates: feasible, status, reason, distance from the requested
/// pose if there is such a column, then the quantities.
pub(super) fn cells(
    point: &Point,
    read: &ReadParameters<'_>,
    quantities: &[Quantity],
    options: &Options,
    with_distance: bool,
    width: usize,
    out: &mut Vec<Value>,
) {
    let begin = out.len();

    match feasible(point, options) {
        Err(status) => {
            head(false, Some(status), out);
            if with_distance {
                out.push(Value::Nothing);
            }
            if let Ok((robot, state)) = &point.robot
                && let State::Pose(pose) = &**state
                && point.holder.is_none()
            {
                for quantity in quantities {
                    quantity.values_without_rest(robot, pose, out);
                }
            }
            out.resize(begin + width, Value::Nothing);
        }
        Ok((robot, Solution { equilibrium, requested_pose, .. })) => {
            // The quantities are evaluated first, because the status depends on values that are missing.
            let hold = held_quantity(point);
            let RowValues { values, interference, missing } =
                quantity_values(robot, &equilibrium, hold, read, quantities, options);
            head(interference.is_none(), interference.or(missing), out);
            if with_distance {
                out.push(Value::real(requested_pose.map(|(_, distance)| distance)));
            }
            out.extend(values);
        }
    }
}

/// Values of quantities at a point; `None` if it is not feasible.
pub(super) fn values(
    point: &Point,
    read: &ReadParameters<'_>,
    quantities: &[Quantity],
    options: &Options,
) -> Option<Vec<Value>> {
    let (robot, Solution { equilibrium, .. }) = feasible(point, options).ok()?;
    Some(quantity_values(robot, &equilibrium, held_quantity(point), read, quantities, options).values)
}

/// Robot of a point and its equilibrium, or the reason why no equilibrium within the limits exists.
fn feasible<'p>(point: &'p Point, options: &Options) -> Result<(&'p Robot, Solution), Status> {
    let (robot, state) = point.robot.as_ref().map_err(|reason| Status::new("invalid-robot", reason))?;
    let rest = point.solve(robot, state, options).map_err(|error| Status::of_error(&error))?;
    match Status::of_infeasible(robot, &rest.equilibrium) {
        Some(status) => Err(status),
        None => Ok((robot, rest)),
    }
}

/// Quantity that stays while a number of the robot changes: the lengths if they are given or held, else the pose.
fn held_quantity(point: &Point) -> Hold {
    let of_lengths = point.robot.as_ref().is_ok_and(|(_, state)| matches!(**state, State::Lengths(_)));
    if of_lengths || point.holder.is_some() { Hold::Lengths } else { Hold::Pose }
}

/// Values of all quantities of a point.
struct RowValues {
    values: Vec<Value>,
    /// Status of an equilibrium at which things are too near to each other.
    interference: Option<Status>,
    /// First reason why a value is missing.
    missing: Option<Status>,
}

/// Values of all quantities.
fn quantity_values(
    robot: &Robot,
    rest: &Equilibrium,
    hold: Hold,
    read: &ReadParameters<'_>,
    quantities: &[Quantity],
    options: &Options,
) -> RowValues {
    let frequency_count = quantities.iter().map(Quantity::frequencies).max().unwrap_or(0);
    let mut row = PointEvaluation::new(robot, rest, hold, read, options, frequency_count);
    let mut values = Vec::new();
    for quantity in quantities {
        quantity.values(&mut row, &mut values);
    }
    RowValues { values, interference: row.interference(), missing: row.into_missing() }
}

fn head(feasible: bool, status: Option<Status>, out: &mut Vec<Value>) {
    let (code, reason) = Status::of(status);
    out.extend([Value::Flag(feasible), Value::Text(code), reason.map_or(Value::Nothing, Value::Text)]);
}

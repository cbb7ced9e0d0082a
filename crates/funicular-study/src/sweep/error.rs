//! Errors of a plan of a map or sweep that cannot be made.

use funicular::statics::{StaticModel, StaticsError};
use thiserror::Error;

/// Maximum number of points of a plan.
pub const MAX_POINTS: usize = 100_000_000;

/// Error of a plan that cannot be made.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SweepError {
    /// Unknown axis.
    #[error("there is no axis `{axis}`: x, y, z are positions [m], roll, pitch, yaw angles [degrees]")]
    UnknownAxis {
        /// Name as given.
        axis: String,
    },
    /// Axis that is given twice.
    #[error("the axis `{axis}` is given twice: give it once")]
    RepeatedAxis {
        /// Name of the column.
        axis: String,
    },
    /// Value that is given twice on an axis.
    #[error("the axis `{axis}` has the value {value} twice: leave one out")]
    RepeatedValue {
        /// Name of the axis.
        axis: String,
        /// Value that is given twice [m, degrees].
        value: f64,
    },
    /// Axis along which the platform cannot move.
    #[error("the platform cannot move along the axis `{axis}`: its motion is {dof}, with the axes {has}")]
    NoSuchMotion {
        /// Name of the axis.
        axis: &'static str,
        /// Name of the platform's motion.
        dof: &'static str,
        /// Axes along which it moves.
        has: String,
    },
    /// Axis of the position without a value.
    #[error(
        "the grid has no axis `{axis}`, and neither the robot nor an option gives a pose to take it from: add the axis \
         or a pose"
    )]
    NoPosition {
        /// Name of the axis.
        axis: &'static str,
    },
    /// No points.
    #[error("there are no points to compute: give at least one")]
    NoPoints,
    /// Too many points.
    #[error("{count} points are more than the {MAX_POINTS} of one sweep: use larger steps or several sweeps")]
    TooMany {
        /// Number of points.
        count: String,
    },
    /// No quantities.
    #[error("no quantity is requested: give at least one, for example tension-max")]
    NoQuantity,
    /// Quantity that is requested twice.
    #[error("the column `{column}` would appear twice: request each quantity once")]
    RepeatedColumn {
        /// Name of the column.
        column: String,
    },
    /// Quantity that does not exist for the static model.
    #[error("`{quantity}` does not exist for the static model `{}`: use the default, catenary", .model.name())]
    NotWithModel {
        /// Name of the quantity.
        quantity: String,
        /// Static model.
        model: StaticModel,
    },
    /// Quantity that does not exist for a robot with fewer cables than degrees of freedom.
    #[error(
        "`{quantity}` does not exist for {cables} cables with {dof} degrees of freedom, which cannot hold a given \
         pose: leave it out"
    )]
    TooFewCables {
        /// Name of the quantity.
        quantity: String,
        /// Number of cables.
        cables: usize,
        /// Number of degrees of freedom.
        dof: usize,
    },
    /// Options that are wrong for every point.
    #[error(transparent)]
    Statics(#[from] StaticsError),
}

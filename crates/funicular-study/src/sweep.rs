//! Maps and sweeps: preparation of a request, and its rows.
//!
//! A request becomes a [`PreparedSweep`] and then a [`Plan`] of points, quantities and options. Its rows come in
//! chunks. A front end runs the chunks on its own threads and keeps them in its own files, which a
//! [`Record`](crate::table::Record) describes.

mod at_pose;
mod described;
pub(crate) mod digest;
mod error;
mod evaluation;
mod frequency;
mod gusts;
mod options;
mod plan;
mod points;
mod prepared;
mod quantity;
mod robot_values;
mod row;
mod sensitivity;
mod status;

pub(crate) use at_pose::values_at;
pub(crate) use described::tables;
pub use error::{MAX_POINTS, SweepError};
pub use frequency::{PointModes, lowest_modes, no_platform_mode};
pub use options::Options;
pub use plan::Plan;
pub use points::{AXES, Point, Points, Poses};
pub use prepared::PreparedSweep;
pub(crate) use prepared::{check_poses, options_of, with_request};
pub use quantity::{MAX_FREQUENCIES, Quantity, UnknownQuantity};
pub use robot_values::{RobotValues, ValueAxis};
pub use status::CODES;

pub use crate::request::{MAX_HZ, Steps, digits};

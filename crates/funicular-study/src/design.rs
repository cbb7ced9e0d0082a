//! Design: the values of a robot file that may change, and the robot at all poses with what its results change by.

mod rows;
mod variables;

pub(crate) use rows::{AtPoses, Evaluated, PoseValues, linearisation_of_goal};
pub(crate) use variables::{Variable, rounded, variables};

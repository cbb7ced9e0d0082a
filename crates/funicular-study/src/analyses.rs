//! Analyses, one file per command: computation of a request, and its results as data.
//!
//! Every `run` returns plain data whose serialisation is the JSON of the program. Numbers that do not exist are absent,
//! never NaN. A `run` takes the request and a robot that was read and checked. `check` takes the robot alone.
//! `parameters`, `identify`, `calibrate`, `design` and `uncertainty` read the robot themselves, because they need the
//! text of its file.

mod anchor_table;
pub mod cable;
pub mod calibrate;
mod candidate_poses;
pub mod check;
pub mod clearance;
pub mod compare;
pub mod design;
pub mod estimate;
mod fields;
pub mod frf;
pub mod gradient;
pub mod gust;
pub mod identify;
pub mod loads;
pub mod modes;
pub mod observability;
pub mod parameters;
pub mod payload;
pub mod pose_error;
mod profile;
pub mod prove;
pub mod reduce;
mod result_groups;
pub mod settle;
pub mod shared;
pub mod simulate;
pub mod speeds;
pub mod statics;
pub mod stiffness;
mod timed_rows;
pub mod trajectory;
pub mod uncertainty;
pub mod winches;
pub mod workspace;

pub use reduce::control_model;

use serde::Serialize;

/// Results of one command. They serialise to the JSON of the program without the keys that all results have.
pub trait Found: Serialize {
    /// Name of the command.
    const COMMAND: &'static str;

    /// Name of the robot; empty if the results do not belong to a single robot.
    fn robot(&self) -> &str;

    /// Sentences that the user should know before trusting the numbers.
    fn warnings(&self) -> &[String];
}

impl<R: Found> Found for Box<R> {
    const COMMAND: &'static str = R::COMMAND;

    fn robot(&self) -> &str {
        (**self).robot()
    }

    fn warnings(&self) -> &[String] {
        (**self).warnings()
    }
}

macro_rules! found {
    ($results:ty, $command:literal) => {
        impl $crate::analyses::Found for $results {
            const COMMAND: &'static str = $command;

            fn robot(&self) -> &str {
                &self.robot
            }

            fn warnings(&self) -> &[String] {
                &self.warnings
            }
        }
    };
}
pub(crate) use found;

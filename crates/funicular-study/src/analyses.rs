//! One file per command: what its request computes, and the results as data.
//!
//! Every `run` takes a robot that was read and checked, and the request; it returns plain data whose serialisation is the
//! JSON of the program. Numbers that do not exist are absent, never NaN.

pub mod cable;
pub mod check;
pub mod compare;
pub mod frf;
pub mod modes;
pub mod parameters;
pub mod pose_error;
pub mod reduce;
pub mod shared;
pub mod statics;
pub mod stiffness;
pub mod validate;

use serde::Serialize;

/// Results of one command. The serialisation is the JSON without the keys that all results have.
pub trait Found: Serialize {
    /// The name of the command.
    const COMMAND: &'static str;

    /// Name of the robot; empty where the results belong to no single one.
    fn robot(&self) -> &str;

    /// Sentences that the user should know before trusting the numbers.
    fn warnings(&self) -> &[String];
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

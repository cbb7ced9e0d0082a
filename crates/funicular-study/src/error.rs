//! Error of every analysis. Its kind decides the exit code; its text is for the user.

use crate::wording::{Warned, Words, message};
use funicular::dynamics::DynamicsError;
use funicular::gradient::GradientError;
use funicular::modes::DecayError;
use funicular::reduced_model::ReductionError;
use funicular::response::ResponseError;
use funicular::robot::Robot;
use funicular::statics::{FrictionError, StaticsError};
use funicular::warnings;
use std::fmt;

/// Kind of an error. Every front end maps it to an exit code or an exception.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ErrorKind {
    /// Wrong request: the user has to change it.
    Input,
    /// Valid request for a robot that has no such solution.
    NoSolution,
    /// Error of work that was stopped from outside, by its [`Watch`](crate::Watch).
    Cancelled,
}

/// Error of a request without results, with the reason.
#[derive(Debug)]
pub struct Error {
    kind: ErrorKind,
    cause: anyhow::Error,
}

/// Error of a valid request for which no result exists.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct NoSolution(pub String);

/// Error of work that was stopped from outside.
#[derive(Debug, thiserror::Error)]
#[error("stopped before the end")]
pub struct Cancelled;

/// Error of work that was stopped from outside, with what remains of it.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct Stopped(pub String);

/// Error of statics together with the warnings about the robot, which may be its cause; without warnings, and for a
/// request that is wrong itself, the error alone. Its type stays known.
pub(crate) fn with_warnings(error: StaticsError, robot: &Robot) -> anyhow::Error {
    let warnings = if error.is_no_solution() { warnings::of_robot(robot) } else { Vec::new() };
    let error = anyhow::Error::from(error);
    if warnings.is_empty() {
        return error;
    }
    error.context(Warned { warnings: warnings.iter().map(ToString::to_string).collect() })
}

impl Error {
    /// Kind of the error.
    pub fn kind(&self) -> ErrorKind {
        self.kind
    }

    /// Message worded for a front end: options are named in the form of that front end.
    pub fn message(&self, words: Words) -> String {
        message(&self.cause, words)
    }

    /// Underlying error, for front ends that know its type.
    pub fn cause(&self) -> &anyhow::Error {
        &self.cause
    }
}

impl ErrorKind {
    /// Kind of an error of any analysis.
    pub fn of(error: &anyhow::Error) -> Self {
        if error.is::<Cancelled>() || error.is::<Stopped>() {
            return Self::Cancelled;
        }
        let no_solution = match error.downcast_ref::<StaticsError>() {
            Some(error) => error.is_no_solution(),
            None => {
                error.downcast_ref().is_some_and(DynamicsError::is_no_solution)
                    || matches!(error.downcast_ref::<ResponseError>(), Some(ResponseError::Resonance { .. }))
                    || error.downcast_ref().is_some_and(ReductionError::is_no_solution)
                    || error.downcast_ref().is_some_and(DecayError::is_no_solution)
                    || matches!(error.downcast_ref(), Some(FrictionError::Singular))
                    || matches!(error.downcast_ref(), Some(GradientError::Resonance { .. }))
                    || error.is::<NoSolution>()
            }
        };
        if no_solution { Self::NoSolution } else { Self::Input }
    }
}

impl From<anyhow::Error> for Error {
    fn from(cause: anyhow::Error) -> Self {
        Self { kind: ErrorKind::of(&cause), cause }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message(Words::Json))
    }
}

impl std::error::Error for Error {}

//! One error for every analysis: its kind decides the exit code, its text is for the user.

use crate::wording::{Words, message};
use funicular::dynamics::DynamicsError;
use funicular::response::ResponseError;
use funicular::statics::StaticsError;
use std::fmt;

/// Kind of an error; every front end maps it to its own sign (exit code, exception).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ErrorKind {
    /// The request has to change.
    Input,
    /// The request is fine, and the robot has no such solution.
    NoSolution,
    /// The work was stopped from outside.
    Cancelled,
}

/// A request that has no results, with the reason.
#[derive(Debug)]
pub struct Error {
    kind: ErrorKind,
    cause: anyhow::Error,
}

/// A result that cannot be given, though nothing is wrong with the input.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct NoSolution(pub String);

/// Work that was stopped from outside.
#[derive(Debug, thiserror::Error)]
#[error("stopped before the end")]
pub(crate) struct Cancelled;

impl Error {
    /// Kind of the error.
    pub fn kind(&self) -> ErrorKind {
        self.kind
    }

    /// The message in the words of a front end: names of options as that front end writes them.
    pub fn message(&self, words: Words) -> String {
        message(&self.cause, words)
    }

    /// The error below, for front ends that know its type.
    pub fn cause(&self) -> &anyhow::Error {
        &self.cause
    }
}

impl ErrorKind {
    /// Kind of an error of any analysis.
    pub fn of(error: &anyhow::Error) -> Self {
        if error.is::<Cancelled>() {
            return Self::Cancelled;
        }
        let no_solution = match error.downcast_ref::<StaticsError>() {
            Some(error) => error.is_no_solution(),
            None => {
                matches!(error.downcast_ref::<DynamicsError>(), Some(DynamicsError::NoTension { .. }))
                    || matches!(error.downcast_ref::<ResponseError>(), Some(ResponseError::Resonance { .. }))
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

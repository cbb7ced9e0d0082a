//! What the user sees when there is no result: one message on stderr, and the exit code.

use funicular::dynamics::DynamicsError;
use funicular::response::ResponseError;
use funicular::statics::StaticsError;
use std::io::{self, IsTerminal, Write};
use std::process::ExitCode;
use thiserror::Error;

/// The input is fine, the robot has no such solution.
const NO_SOLUTION: u8 = 1;
/// The input has to change.
const BAD_INPUT: u8 = 2;

/// The user or the system has stopped it: what a shell calls SIGINT.
const INTERRUPTED: u8 = 130;

/// A message that already says `error:` and shows its place.
#[derive(Debug, Error)]
#[error("{0}")]
pub(crate) struct Rendered(pub(crate) String);

/// A result that cannot be given, though nothing is wrong with the input.
#[derive(Debug, Error)]
#[error("{0}")]
pub(crate) struct NoSolution(pub(crate) String);

/// Work that was stopped from outside, with what is left of it.
#[derive(Debug, Error)]
#[error("{0}")]
pub(crate) struct Interrupted(pub(crate) String);

/// Prints the error and chooses the exit code.
pub(crate) fn report(error: &anyhow::Error) -> ExitCode {
    if is_broken_pipe(error) {
        // `| head` has seen enough.
        return ExitCode::SUCCESS;
    }
    let message = match error.downcast_ref::<Rendered>() {
        Some(rendered) => rendered.to_string(),
        None => format!("{} {error:#}", styled("error:", "31")),
    };
    to_stderr(&message);
    ExitCode::from(code(error))
}

/// Prints what the user should know before trusting a result.
pub(crate) fn warn(warning: &str) {
    to_stderr(&format!("{} {warning}", styled("warning:", "33")));
}

/// Prints what was done.
pub(crate) fn note(note: &str) {
    to_stderr(note);
}

/// Colours are for terminals whose user has not refused them (no-color.org).
pub(crate) fn stderr_has_colour() -> bool {
    io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}

fn styled(text: &str, colour: &str) -> String {
    if stderr_has_colour() { format!("\u{1b}[1;{colour}m{text}\u{1b}[0m") } else { text.to_owned() }
}

/// Nobody may be listening on stderr either; then there is nobody to tell.
fn to_stderr(message: &str) {
    let _ = writeln!(io::stderr().lock(), "{message}");
}

fn is_broken_pipe(error: &anyhow::Error) -> bool {
    error.downcast_ref::<io::Error>().is_some_and(|error| error.kind() == io::ErrorKind::BrokenPipe)
}

fn code(error: &anyhow::Error) -> u8 {
    if error.is::<Interrupted>() {
        return INTERRUPTED;
    }
    let no_solution = match error.downcast_ref::<StaticsError>() {
        Some(error) => error.is_no_solution(),
        None => {
            matches!(error.downcast_ref::<DynamicsError>(), Some(DynamicsError::NoTension { .. }))
                || matches!(error.downcast_ref::<ResponseError>(), Some(ResponseError::Resonance { .. }))
                || error.is::<NoSolution>()
        }
    };
    if no_solution { NO_SOLUTION } else { BAD_INPUT }
}

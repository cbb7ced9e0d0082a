//! What the user sees when there is no result: one message on stderr, and the exit code.

use funicular_study::robot_file::Refused;
use funicular_study::wording::{Words, message, worded};
use funicular_study::{Error, ErrorKind};
use std::io::{self, IsTerminal, Write};
use std::process::ExitCode;
use thiserror::Error;

/// The input is fine, the robot has no such solution.
const NO_SOLUTION: u8 = 1;
/// The input has to change.
const BAD_INPUT: u8 = 2;

/// The user or the system has stopped it: what a shell calls SIGINT.
const INTERRUPTED: u8 = 130;

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
    let text = match refused(error) {
        Some(refused) => refused.error.render(&refused.name, &refused.text, stderr_has_colour()),
        None => format!("{} {}", styled("error:", "31"), message(error, Words::Program)),
    };
    to_stderr(&text);
    ExitCode::from(code(error))
}

/// Prints what the user should know before trusting a result.
pub(crate) fn warn(warning: &str) {
    to_stderr(&format!("{} {}", styled("warning:", "33"), worded(warning, Words::Program)));
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

/// The robot file that the reader refuses, which shows its own errors at their places.
fn refused(error: &anyhow::Error) -> Option<&Refused> {
    let cause = error.downcast_ref::<Error>().map_or(error, Error::cause);
    cause.downcast_ref()
}

fn code(error: &anyhow::Error) -> u8 {
    if error.is::<Interrupted>() {
        return INTERRUPTED;
    }
    match error.downcast_ref::<Error>().map_or_else(|| ErrorKind::of(error), Error::kind) {
        ErrorKind::Input => BAD_INPUT,
        ErrorKind::NoSolution => NO_SOLUTION,
        ErrorKind::Cancelled => INTERRUPTED,
    }
}

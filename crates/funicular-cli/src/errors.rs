//! Output of a run without a result: one message on stderr, and the exit code.

use funicular_answers::Stopped;
use funicular_study::robot_file::Refused;
use funicular_study::wording::{Words, message, told};
use funicular_study::{Error, ErrorKind};
use std::io::{self, IsTerminal, Write};
use std::process::ExitCode;

/// Exit code of a valid input for a robot that has no such solution.
const NO_SOLUTION: u8 = 1;
/// Exit code of a run that the user or the system has stopped, as a shell reports SIGINT.
pub(crate) const STOPPED: u8 = 130;

/// Exit code of an input that has to change.
const BAD_INPUT: u8 = 2;

/// Prints the error and chooses the exit code.
pub(crate) fn report(error: &anyhow::Error) -> ExitCode {
    if is_broken_pipe(error) {
        // A closed pipe is not an error: the reader, for example `head`, has stopped.
        return ExitCode::SUCCESS;
    }
    let text = match refused(error) {
        Some(refused) => refused.error.render(&refused.name, &refused.text, stderr_has_colour()),
        None => format!("{} {}", styled("error:", "31"), message(error, Words::Program)),
    };
    to_stderr(&text);
    ExitCode::from(code(error))
}

/// Prints a warning that the user should know before trusting a result.
pub(crate) fn warn(warning: &str) {
    to_stderr(&format!("{} {}", styled("warning:", "33"), told(warning, Words::Program)));
}

/// Prints a note about completed work.
pub(crate) fn note(note: &str) {
    to_stderr(&told(note, Words::Program));
}

/// True if stderr is a terminal and the user has not refused colours (no-color.org).
pub(crate) fn stderr_has_colour() -> bool {
    io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}

fn styled(text: &str, colour: &str) -> String {
    if stderr_has_colour() { format!("\u{1b}[1;{colour}m{text}\u{1b}[0m") } else { text.to_owned() }
}

/// Prints a line to stderr. Errors of stderr are ignored, because they cannot be reported.
pub(crate) fn to_stderr(message: &str) {
    let _ = writeln!(io::stderr().lock(), "{message}");
}

fn is_broken_pipe(error: &anyhow::Error) -> bool {
    error.downcast_ref::<io::Error>().is_some_and(|error| error.kind() == io::ErrorKind::BrokenPipe)
}

/// Robot file that the reader refuses, if that is the error. It shows its errors at their places in the file.
fn refused(error: &anyhow::Error) -> Option<&Refused> {
    let cause = error.downcast_ref::<Error>().map_or(error, Error::cause);
    cause.downcast_ref()
}

fn code(error: &anyhow::Error) -> u8 {
    if error.is::<Stopped>() {
        return STOPPED;
    }
    match error.downcast_ref::<Error>().map_or_else(|| ErrorKind::of(error), Error::kind) {
        ErrorKind::Input => BAD_INPUT,
        ErrorKind::NoSolution => NO_SOLUTION,
        ErrorKind::Cancelled => STOPPED,
    }
}

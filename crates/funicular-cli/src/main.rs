//! The program `funicular`: arguments become a request, results become text, JSON, CSV and exit codes.

mod args;
mod commands;
mod errors;
mod output;
mod pose_csv;
mod progress;
mod robot_file;
mod sweep_run;
mod table;

use args::Cli;
use clap::Parser;
use std::io::{self, Write};
use std::process::ExitCode;

fn main() -> ExitCode {
    match Cli::try_parse() {
        Ok(cli) => match commands::run(&cli) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => errors::report(&error),
        },
        Err(usage) => tell(&usage),
    }
}

/// Prints help or the version to standard output; what is wrong with the command line goes to stderr.
fn tell(usage: &clap::Error) -> ExitCode {
    let printed = usage.print().and_then(|()| io::stdout().flush());
    match printed {
        // Help for a closed pipe is help for nobody, and so is a message to a closed stderr.
        Err(error) if !usage.use_stderr() => errors::report(&output::of_stdout(error)),
        _ => ExitCode::from(u8::try_from(usage.exit_code()).unwrap_or(2)),
    }
}

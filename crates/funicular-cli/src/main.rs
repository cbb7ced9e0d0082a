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
use std::process::ExitCode;

fn main() -> ExitCode {
    match Cli::try_parse() {
        Ok(cli) => match commands::run(&cli) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => errors::report(&error),
        },
        Err(usage) => {
            // Help for a closed pipe is help for nobody.
            let _ = usage.print();
            ExitCode::from(u8::try_from(usage.exit_code()).unwrap_or(2))
        }
    }
}

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
use clap::error::{ContextKind, ContextValue, ErrorKind};
use funicular::suggest;
use std::io::{self, Write};
use std::process::ExitCode;

fn main() -> ExitCode {
    match Cli::try_parse() {
        Ok(cli) => match commands::run(&cli) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => errors::report(&error),
        },
        Err(usage) => tell(&with_new_name(usage)),
    }
}

/// Prints help or the version to standard output; what is wrong with the command line goes to stderr.
fn tell(usage: &clap::Error) -> ExitCode {
    let printed = usage.print().and_then(|()| io::stdout().flush());
    match printed {
        // Nobody reads help in a closed pipe, nor a message on a closed stderr.
        Err(error) if !usage.use_stderr() => errors::report(&output::of_stdout(error)),
        _ => ExitCode::from(u8::try_from(usage.exit_code()).unwrap_or(2)),
    }
}

/// Adds to an error of the command line what an earlier option or value is called now.
fn with_new_name(mut usage: clap::Error) -> clap::Error {
    let text = |kind| match usage.get(kind) {
        Some(ContextValue::String(text)) => Some(text.as_str()),
        _ => None,
    };

    match usage.kind() {
        ErrorKind::InvalidValue => {
            let known = match usage.get(ContextKind::ValidValue) {
                Some(ContextValue::Strings(known)) => known.as_slice(),
                _ => &[],
            };
            let new = text(ContextKind::InvalidValue).and_then(suggest::renamed);
            if let Some(new) = new.filter(|new| known.iter().any(|name| name == new)) {
                usage.insert(ContextKind::SuggestedValue, ContextValue::String(new.to_owned()));
            }
        }

        ErrorKind::UnknownArgument => {
            let option = text(ContextKind::InvalidArg).and_then(|option| option.strip_prefix("--"));
            if let Some(new) = option.and_then(suggest::renamed) {
                usage.insert(ContextKind::SuggestedArg, ContextValue::String(format!("--{new}")));
            }
        }

        _ => {}
    }
    usage
}

//! Program `funicular`: converts arguments to a request, and results to text, JSON, CSV and exit codes.

mod args;
mod commands;
mod errors;
mod interrupt;
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
        Err(usage) => report_usage(&with_new_name(usage)),
    }
}

/// Prints help or the version to standard output, and an error of the command line to stderr.
fn report_usage(usage: &clap::Error) -> ExitCode {
    let printed = usage.print().and_then(|()| io::stdout().flush());
    match printed {
        // A closed pipe is not an error: the reader of the help has stopped. A message on a closed stderr is lost.
        Err(error) if !usage.use_stderr() => errors::report(&output::of_stdout(error)),
        _ => ExitCode::from(u8::try_from(usage.exit_code()).unwrap_or(2)),
    }
}

/// Adds the present name to an error of the command line about an earlier name of an option or value.
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
            // `--model` was an option of `reduce` only; elsewhere it may be meant for a cable model or a static model.
            let of_reduce =
                usage.get(ContextKind::Usage).is_some_and(|usage| usage.to_string().contains("funicular reduce"));
            let new = option.and_then(|option| {
                if option == "model" { of_reduce.then_some("matrices") } else { suggest::renamed(option) }
            });
            if let Some(new) = new {
                usage.insert(ContextKind::SuggestedArg, ContextValue::String(format!("--{new}")));
            }
        }

        _ => {}
    }
    usage
}

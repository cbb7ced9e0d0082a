//! Program `funicular`: converts arguments to a request, and results to text, JSON, CSV and exit codes.

mod args;
mod commands;
mod errors;
mod interrupt;
mod output;
mod progress;
mod shell;
mod sweep_run;
mod table;

use args::Cli;
use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use funicular::suggest;
use std::io::{self, Write};
use std::process::ExitCode;

fn main() -> ExitCode {
    match Cli::read() {
        Ok(cli) => match commands::run(&cli) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => errors::report(&error),
        },
        Err(usage) => report_usage(&with_new_name(usage)),
    }
}

/// Prints help or the version to standard output, and an error of the command line to stderr.
fn report_usage(usage: &clap::Error) -> ExitCode {
    let code = ExitCode::from(u8::try_from(usage.exit_code()).unwrap_or(2));
    if usage.use_stderr() {
        // With colours only where they are the only hidden characters.
        let plain = usage.render().to_string();
        let shown = suggest::shown(&plain);
        if shown != plain {
            errors::to_stderr(shown.trim_end());
            return code;
        }
    }
    let printed = usage.print().and_then(|()| io::stdout().flush());
    match printed {
        // A closed pipe is not an error: the reader of the help has stopped. A message on a closed stderr is lost.
        Err(error) if !usage.use_stderr() => errors::report(&output::of_stdout(error)),
        _ => code,
    }
}

/// Names that other programs have for a command, with its name here.
const COMMANDS_OF_OTHERS: [(&[&str], &str); 5] = [
    (&["grid"], "map"),
    (&["path", "motion"], "trajectory"),
    (&["optimize", "optimise", "optimization"], "design"),
    (&["eigen", "frequencies", "modal"], "modes"),
    (&["equilibrium", "tensions"], "statics"),
];

/// Adds the present name to an error of the command line about an earlier name of an option or value, or about the name
/// that other programs have for a command, and a tip to numbers without commas.
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
            if let Some(option) = text(ContextKind::InvalidArg).and_then(|argument| argument.strip_prefix("--")) {
                let new = present_options(option, &options_of_command());
                if !new.is_empty() {
                    usage.insert(ContextKind::SuggestedArg, ContextValue::Strings(new));
                }
                // The tip to write `--` before it takes a mistyped option for the name of a file.
                usage.remove(ContextKind::Suggested);
            } else if text(ContextKind::InvalidArg).is_some_and(|argument| argument.parse::<f64>().is_ok()) {
                let tip = StyledStr::from("the numbers of an option are separated by commas alone: `--pose 0,0,5`");
                usage.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip]));
            }
        }

        ErrorKind::InvalidSubcommand => {
            let meant = text(ContextKind::InvalidSubcommand).and_then(|name| {
                COMMANDS_OF_OTHERS.iter().find_map(|(others, ours)| others.contains(&name).then_some(*ours))
            });
            if let Some(meant) = meant {
                let found = ContextValue::Strings(vec![meant.to_owned()]);
                usage.insert(ContextKind::SuggestedSubcommand, found);
            }
        }

        _ => {}
    }
    usage
}

/// Options that an option of an earlier version, or a short form that never existed, may mean, of those that a command
/// has.
fn present_options(option: &str, known: &[String]) -> Vec<String> {
    let renamed = suggest::renamed(option);
    let candidates = match option {
        // `reduce` alone had an option `--model`, for its file.
        "model" if known.iter().any(|name| name == "matrices") => &["matrices"][..],
        "model" => &["cable-model", "static-model"],
        _ => renamed.as_slice(),
    };
    let is_known = |name: &&&str| known.iter().any(|known| known == **name);
    candidates.iter().filter(is_known).map(|name| format!("--{name}")).collect()
}

/// Names of the options of the command that the command line names, without `--`.
fn options_of_command() -> Vec<String> {
    let program = args::program();
    let command = std::env::args().skip(1).find_map(|argument| program.find_subcommand(argument));
    let options = command.into_iter().flat_map(clap::Command::get_arguments);
    options.filter_map(|option| option.get_long()).map(str::to_owned).collect()
}

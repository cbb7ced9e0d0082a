//! Arguments of the program. Most options are keys of requests and are made from their declaration; the others name
//! files.

mod declared;
mod files;
pub(crate) mod values;

use anyhow::{Context, Result};
use clap::builder::PossibleValuesParser;
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches, value_parser};
use clap_complete::Shell;
pub(crate) use files::{FigureArgs, Format, IdentifyArgs, MergeArgs, OutputArgs, ReducedTo, RequestArgs, RunArgs};
use files::{
    ModeFigureArgs, OptionalRobotArgs, ReduceArgs, RobotArgs, SampleArgs, StoredArgs, SweepFigureArgs, ThreadArgs,
};
use funicular_answers::{document, outputs};
use funicular_study::request::{self, Change, CommandInfo, Declared, Experiment, Key, RequestRobot, ResponsePoints};
use serde_json::{Map, Value};
use std::path::PathBuf;

/// Command line: a command with the options that it gives.
pub(crate) struct Cli {
    /// True if the request is printed instead of being run.
    pub(crate) print_request: bool,
    /// Name of the command.
    pub(crate) name: String,
    matches: ArgMatches,
}

impl Cli {
    /// Reads the command line of this process.
    ///
    /// # Errors
    /// Help, the version, or arguments that the command does not have.
    pub(crate) fn read() -> Result<Self, clap::Error> {
        let mut matches = program().try_get_matches()?;
        let (name, matches) = matches.remove_subcommand().unwrap_or_default();
        Ok(Self { print_request: matches.get_flag(PRINT_REQUEST), name, matches })
    }

    /// Files and figures of the command.
    ///
    /// # Errors
    /// None: the arguments have been checked when they were read.
    pub(crate) fn files<T: FromArgMatches>(&self) -> Result<T> {
        Ok(T::from_arg_matches(&self.matches)?)
    }

    /// Value of an argument, if the command line gives it.
    pub(crate) fn value<T: Clone + Send + Sync + 'static>(&self, name: &str) -> Option<&T> {
        self.matches.try_get_one(name).ok().flatten()
    }

    /// Path of the robot file, if the command line names one.
    pub(crate) fn robot_path(&self) -> Option<&PathBuf> {
        self.value("robot")
    }

    /// Changes of the robot file, or of that of a key.
    pub(crate) fn changes(&self, key: Option<&str>) -> Vec<Change> {
        self.values(&key.map_or_else(|| "set".to_owned(), declared::changes_of))
    }

    /// Values of an argument that can be given several times.
    pub(crate) fn values<T: Clone + Send + Sync + 'static>(&self, name: &str) -> Vec<T> {
        let given = self.matches.try_get_many(name).ok().flatten();
        given.map_or_else(Vec::new, |values| values.cloned().collect())
    }

    /// True for a switch that the command line gives.
    pub(crate) fn is_on(&self, name: &str) -> bool {
        self.value(name).copied().unwrap_or_default()
    }

    /// True for an argument that stands in the command line, not for its default.
    pub(crate) fn is_given(&self, name: &str) -> bool {
        self.matches.try_contains_id(name).is_ok() && self.matches.value_source(name) == Some(ValueSource::CommandLine)
    }

    /// Keys of a group that the command line gives.
    pub(crate) fn given<T: Declared>(&self) -> Map<String, Value> {
        declared::given(&self.matches, &T::keys())
    }

    /// Declaration of the command.
    ///
    /// # Errors
    /// A command that has no request.
    pub(crate) fn info(&self) -> Result<&'static CommandInfo> {
        command_of(&self.name).context("this command has no request")
    }

    /// Keys of the command's request that stand in the command line.
    pub(crate) fn keys(&self, info: &CommandInfo) -> Map<String, Value> {
        declared::given(&self.matches, &info.keys)
    }
}

const PRINT_REQUEST: &str = "print_request";

/// Commands that only the program has, for shells and for the manual.
pub(crate) const COMPLETIONS: &str = "completions";
pub(crate) const MAN: &str = "man";

fn command_of(name: &str) -> Option<&'static CommandInfo> {
    request::commands().iter().find(|command| command.name == name)
}

/// Command `completions` with its arguments, without help.
fn completions() -> Command {
    let shell = Arg::new("shell").value_name("SHELL").required(true).value_parser(value_parser!(Shell));
    Command::new(COMPLETIONS).arg(shell.help("Shell that reads the completions"))
}

/// Command `man` with its arguments, without help. Its values are the other commands.
fn man(commands: &[&'static str]) -> Command {
    let of = Arg::new("of").value_name("COMMAND").value_parser(PossibleValuesParser::new(commands.to_vec()));
    Command::new(MAN).arg(of.hide_possible_values(true).help("Command of the page [default: the whole program]"))
}

/// The program with all its commands.
pub(crate) fn program() -> Command {
    let print_request = Arg::new(PRINT_REQUEST)
        .long("print-request")
        .help("Print the request of this command as JSON instead of running it")
        .help_heading("Request")
        .action(ArgAction::SetTrue)
        .global(true);
    let run_request = declared::described(
        RequestArgs::augment_args(Command::new("request")).args(outputs::all().map(declared::output)),
        "Run a request in JSON: the options of any command and the text of the robot file in one object\n\nEvery \
         command prints its request with --print-request. The keys are the names of the options, with _ instead of -.",
        &["funicular statics robots/cogiro.toml --pose 1,2,1.5 --print-request > request.json\n  \
           funicular request request.json --format json"],
    );
    let with_completions = declared::described(
        completions(),
        "Completions of commands and options for a shell\n\nThe shell reads the text from a file of its own folder.",
        &["funicular completions bash > ~/.local/share/bash-completion/completions/funicular"],
    );
    let names: Vec<&str> = request::commands().iter().map(|command| command.name).collect();
    let with_man = declared::described(
        man(&names),
        "Page of the manual, of the program or of one command, in the format of `man`",
        &["funicular man modes > funicular-modes.1"],
    );

    Command::new("funicular")
        .version(env!("CARGO_PKG_VERSION"))
        .propagate_version(true)
        .max_term_width(110)
        .about("Statics and vibration of cable-driven parallel robots whose cables sag")
        .long_about(
            "Statics and vibration of cable-driven parallel robots whose cables sag.\n\nAll commands except `new`, \
             `schema`, `import`, `merge`, `paper`, `plot`, `validate`, `request`, `completions` and `man` read a robot \
             file (TOML). Results go to stdout, warnings and errors to stderr. Units are SI units, and the unit of \
             every value is in its name. Exit codes: 0 done, 1 no solution, 2 bad input, \
             130 stopped by Ctrl-C or the end of a job.",
        )
        .after_help("Example:\n  funicular modes robots/yuan2014-4mm.toml --below-hz 20")
        .subcommand_required(true)
        .arg_required_else_help(true)
        .arg(print_request)
        .subcommands(request::commands().iter().map(subcommand))
        .subcommands([run_request, with_completions, with_man])
}

/// Command with its robot file, the options of its request, and its files.
fn subcommand(info: &CommandInfo) -> Command {
    let command = Command::new(info.name);
    let command = match info.robot {
        RequestRobot::None => command,
        RequestRobot::Needed => RobotArgs::augment_args(command),
        RequestRobot::Embedded => OptionalRobotArgs::augment_args(command),
    };
    // The program makes one experiment of its options.
    let more = if info.name == "identify" { [ResponsePoints::keys(), Experiment::keys()].concat() } else { Vec::new() };
    let keys: Vec<Key> = info.keys.iter().cloned().chain(more).collect();
    let command = with_files(info.name, declared::with_options(command, &keys));
    declared::described(command, &info.about, info.examples)
}

/// Adds the options of a command that are not keys of its request.
fn with_files(name: &str, command: Command) -> Command {
    let stored = |command: Command, file: &'static str| {
        let command = StoredArgs::augment_args(command);
        command.mut_arg("resume", |arg| arg.requires(file)).mut_arg("discard", |arg| arg.requires(file))
    };
    let rows = |command: Command| {
        let command = RunArgs::augment_args(command);
        command
            .mut_arg("resume", |arg| arg.requires("output_file"))
            .mut_arg("discard", |arg| arg.requires("output_file"))
    };
    let command = match (name, document::destination(name)) {
        ("map", _) => rows(command).mut_arg("grid", |arg| arg.required_unless_present("poses")),
        ("sweep", _) => rows(command),
        ("merge", _) => MergeArgs::augment_args(command),
        (_, Some((default, about))) => command.arg(declared::document(default, about)),
        (_, None) => OutputArgs::augment_args(command),
    };
    let command = match name {
        "modes" => ModeFigureArgs::augment_args(command),
        "plot" => SweepFigureArgs::augment_args(command),
        "identify" => IdentifyArgs::augment_args(command),
        "reduce" => ReduceArgs::augment_args(command),
        "uncertainty" => ThreadArgs::augment_args(stored(SampleArgs::augment_args(command), "samples_file")),
        "workspace" | "prove" => ThreadArgs::augment_args(command),
        "simulate" => stored(command, "output_file").mut_arg("duration_s", |arg| arg.visible_alias("for")),
        "export" => command.mut_arg("duration_s", |arg| arg.visible_alias("for")),
        _ => command,
    };
    let files = outputs::of(name);
    let command = command.args(files.iter().map(declared::output));
    if files.iter().any(|output| output.key == "figure") { FigureArgs::augment_args(command) } else { command }
}

//! Options of the program that are keys of requests: made from their declaration, and read as JSON.

use clap::builder::{PossibleValue, PossibleValuesParser, Resettable, StyledStr, ValueParser};
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use funicular_answers::Output;
use funicular_answers::document::DefaultDestination;
use funicular_study::request::{Key, Kind, Reader};
use funicular_study::wording::{Words, worded};
use funicular_study::written;
use serde_json::{Map, Value};
use std::path::PathBuf;

/// Gives a command its help. Groups of options that were added to it before have changed that.
pub(super) fn described(command: Command, about: &str, examples: &[&str]) -> Command {
    let about = worded(about, Words::Program);
    let short = about.split("\n\n").next().unwrap_or_default().to_owned();
    let long = (about != short).then_some(about);
    let head = if examples.len() == 1 { "Example" } else { "Examples" };
    let examples = examples.join("\n  ");
    let long = Resettable::from(long.map(StyledStr::from));
    command.about(short).long_about(long).after_help(format!("{head}:\n  {examples}"))
}

/// Adds the options of keys to a command.
pub(super) fn with_options(command: Command, keys: &[Key]) -> Command {
    let own = keys.iter().filter(|key| !key.option.is_empty());
    command.args(own.flat_map(|key| [Some(option(key, keys)), changes(key)]).flatten())
}

/// Name of the option with the changes of the robot file of a key.
pub(super) fn changes_of(key: &str) -> String {
    format!("{key}_set")
}

/// Option with the changes of the robot file of a key.
fn changes(key: &Key) -> Option<Arg> {
    key.file.filter(|file| file.reader == Reader::Robot)?;
    let name = changes_of(key.name);
    let arg = Arg::new(name.clone()).long(name.replace('_', "-")).value_name("PATH=VALUE").help_heading(key.heading);
    let about = "Change a value of the other robot, as --set does (repeatable); without another file, of the same one";
    Some(arg.help(about).value_parser(funicular_study::set_values::change).action(ArgAction::Append))
}

/// Option of a file that a command writes besides its result.
pub(super) fn output(of: &'static Output) -> Arg {
    let ending = of.kinds.iter().find_map(|kind| kind.ending()).unwrap_or_default();
    let form = match (of.kinds, of.folder) {
        (_, true) => "FILE|FOLDER".to_owned(),
        ([_], _) => format!("FILE.{ending}"),
        _ => "FILE".to_owned(),
    };
    let same = if of.by_ending { "; -o with such a file does the same" } else { "" };
    let repeatable = if of.several { " (repeatable)" } else { "" };
    let about = format!("{}{same}{repeatable}", of.about);
    let arg = Arg::new(of.key).long(of.key.replace('_', "-")).value_name(form).help(about).help_heading("Output");
    let arg = arg.value_parser(value_parser!(PathBuf));
    if of.several { arg.action(ArgAction::Append) } else { arg }
}

/// Option `-o` of a command whose result is a file.
pub(super) fn document(default: DefaultDestination, about: &'static str) -> Arg {
    let arg = Arg::new("output_file").short('o').long("output-file").value_name("FILE").help(about);
    let arg = arg.help_heading("Output").value_parser(value_parser!(PathBuf));
    match default {
        DefaultDestination::Stdout => arg.default_value("-"),
        DefaultDestination::File(name) => arg.default_value(name),
        DefaultDestination::BesideRows => arg,
    }
}

/// Sentence on the file from which a key is read.
fn about_file(reader: Reader) -> &'static str {
    match reader {
        Reader::Columns | Reader::GappedColumns | Reader::Records => "; a CSV file",
        Reader::Poses => "; a CSV file with the columns x_m, y_m, z_m and optionally roll_deg, pitch_deg, yaw_deg",
        Reader::Scenario => {
            "; a TOML file with [[release]] and so on, in which a `table` of [[lengths]] names a CSV file beside it"
        }
        Reader::Robot | Reader::Source | Reader::Sources | Reader::Paths | Reader::Path => "",
    }
}

/// Form of the name of the file from which a key is read.
fn form_of_file(key: &Key) -> &'static str {
    match key.file.map(|file| file.reader) {
        Some(Reader::Columns | Reader::GappedColumns | Reader::Records | Reader::Poses) => "FILE.csv",
        Some(Reader::Scenario | Reader::Robot) => "FILE.toml",
        Some(Reader::Source | Reader::Sources) => "FILE",
        Some(Reader::Paths | Reader::Path) | None => key.form,
    }
}

/// Option of one key of a command.
fn option(key: &Key, all: &[Key]) -> Arg {
    let mut about = worded(&written::about(key), Words::Program);
    if let Some(file) = key.file {
        about += about_file(file.reader);
    }
    let otherwise = key.otherwise.map(|text| format!(" [default: {text}]")).unwrap_or_default();
    let short = about.split("\n\n").next().unwrap_or_default().to_owned() + &otherwise;
    let mut arg = Arg::new(key.name).long(key.option.clone()).help(short);
    if about.contains("\n\n") {
        arg = arg.long_help(about + &otherwise);
    }
    if !key.heading.is_empty() {
        arg = arg.help_heading(key.heading);
    }

    let of_command = |name: &&&str| all.iter().any(|key| key.name == **name && !key.option.is_empty());
    arg = arg.conflicts_with_all(key.excludes.iter().filter(of_command).copied());
    if let Some(needed) = key.needs {
        arg = arg.requires(needed);
    }
    if matches!(key.kind, Kind::Switch) {
        return arg.action(ArgAction::SetTrue);
    }

    arg = arg.value_name(form_of_file(key)).required(key.required);
    if let Some(file) = key.file {
        let arg = arg.value_parser(value_parser!(PathBuf));
        return match file.reader {
            Reader::Sources | Reader::Paths => arg.long(None).action(ArgAction::Append),
            Reader::Path => arg.long(None),
            _ => arg,
        };
    }
    if let Some(default) = default(&key.default) {
        arg = arg.default_value(default);
    }
    match &key.kind {
        Kind::Name(_, choices) => {
            let value = |name: &'static str, about: &str| PossibleValue::new(name).help(worded(about, Words::Program));
            let choices = choices.iter().map(|choice| value(choice.name, choice.about).aliases(choice.also));
            arg.value_parser(PossibleValuesParser::new(choices))
        }
        Kind::Texts | Kind::Sizes | Kind::Commas(_) => {
            arg.value_parser(parser(key)).action(ArgAction::Append).value_delimiter(',')
        }
        Kind::List(_) | Kind::OneOrMore(_) => arg.value_parser(parser(key)).action(ArgAction::Append),
        _ => arg.value_parser(parser(key)),
    }
    .allow_hyphen_values(may_be_negative(&key.kind))
}

/// True for values that may begin with a minus sign.
fn may_be_negative(kind: &Kind) -> bool {
    matches!(
        kind,
        Kind::Number(_)
            | Kind::Count(_)
            | Kind::PerCable(_)
            | Kind::OneOrPerCable(_)
            | Kind::Vector
            | Kind::Pose
            | Kind::Tensor
            | Kind::Text
    )
}

fn parser(key: &Key) -> ValueParser {
    let key = key.clone();
    ValueParser::new(move |text: &str| written::read(&key, text))
}

/// Default in the form of the command line; `None` without one.
fn default(value: &Value) -> Option<String> {
    match value {
        Value::String(text) => Some(text.clone()),
        Value::Number(number) => Some(number.as_f64().map_or_else(|| number.to_string(), |number| number.to_string())),
        Value::Array(values) if !values.is_empty() => {
            Some(values.iter().filter_map(default).collect::<Vec<_>>().join(","))
        }
        _ => None,
    }
}

/// Keys that the command line gives, as JSON.
pub(super) fn given(matches: &ArgMatches, keys: &[Key]) -> Map<String, Value> {
    let is_given = |key: &&Key| {
        !key.option.is_empty() && key.file.is_none() && matches.value_source(key.name) == Some(ValueSource::CommandLine)
    };
    keys.iter().filter(is_given).filter_map(|key| Some((key.name.to_owned(), value(matches, key)?))).collect()
}

fn value(matches: &ArgMatches, key: &Key) -> Option<Value> {
    let all = || matches.get_many::<Value>(key.name).into_iter().flatten().cloned();
    Some(match &key.kind {
        Kind::Switch => Value::Bool(true),
        Kind::Name(_, choices) => {
            let given = matches.get_one::<String>(key.name)?;
            let chosen = choices.iter().find(|choice| choice.name == given || choice.also == Some(given))?;
            chosen.name.into()
        }
        Kind::Texts | Kind::Sizes | Kind::Commas(_) | Kind::List(_) => all().collect(),
        Kind::OneOrMore(_) => match (all().next(), all().count()) {
            (Some(one), 1) => one,
            _ => all().collect(),
        },
        _ => matches.get_one::<Value>(key.name)?.clone(),
    })
}

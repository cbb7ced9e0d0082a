//! Options of the program that are keys of requests: made from their declaration, and read as JSON.

use clap::builder::{PossibleValue, PossibleValuesParser, Resettable, StyledStr, ValueParser};
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Command};
use funicular_study::request::{Key, Kind};
use funicular_study::wording::{Words, worded};
use funicular_study::written;
use serde_json::{Map, Value};

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
    command.args(keys.iter().filter(|key| !key.option.is_empty()).map(|key| option(key, keys)))
}

/// Option of one key of a command.
fn option(key: &Key, all: &[Key]) -> Arg {
    let about = worded(&written::about(key), Words::Program);
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

    arg = arg.value_name(key.form).required(key.required);
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
    let is_given =
        |key: &&Key| !key.option.is_empty() && matches.value_source(key.name) == Some(ValueSource::CommandLine);
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

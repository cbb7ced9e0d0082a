//! Values that a request gives, checked against the declaration of its keys before they are read: their kinds, their
//! ranges, and keys that need or exclude each other. Every front end passes through here.

use super::key::{Declared, Key, Kind, ProgramForm, Range};
use super::{Experiment, commands, library_words, simulate};
use super::{OfferedRope, OfferedWinch};
use crate::names::{no_such, suggestion};
use crate::units;
use anyhow::{Result, anyhow, bail};
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

type Object = Map<String, Value>;

/// Fault of a value: its place below the key, and the reason.
#[derive(Debug)]
struct Fault {
    place: String,
    reason: String,
}

impl From<String> for Fault {
    fn from(reason: String) -> Self {
        Self { place: String::new(), reason }
    }
}

impl Fault {
    fn wanted(value: &Value, wanted: &str) -> Self {
        format!("{} is no answer: give {wanted}", shown(value)).into()
    }

    /// Same fault, seen from one level above.
    fn within(self, place: &str) -> Self {
        Self { place: format!("{place}{}", self.place), ..self }
    }
}

type KeyCheck = Result<(), Fault>;

/// Checks the keys of a request of a command, whichever of them are given. `null` counts as not given.
///
/// # Errors
/// A value of another kind or out of its range, a key that is given without the one that it needs, and two keys that
/// exclude each other; the message names the key.
pub fn check_given(command: &str, given: &Object) -> Result<()> {
    let keys = commands().iter().find(|info| info.name == command).map_or(&[][..], |info| &info.keys);
    for key in keys {
        let Some(value) = given.get(key.name).filter(|value| !value.is_null()) else { continue };
        of_key(key, value).map_err(|fault| anyhow!("⟪{}⟫{}: {}", key.name, fault.place, fault.reason))?;
    }

    for key in keys.iter().filter(|key| is_given(given, key.name)) {
        if let Some(needed) = key.needs.filter(|needed| !is_given(given, needed)) {
            bail!("⟪{}⟫ means nothing without ⟪{needed}⟫: give both or neither", key.name);
        }
        if let Some(other) = key.excludes.iter().find(|other| is_given(given, other)) {
            bail!("give ⟪{other}⟫ or ⟪{}⟫, not both", key.name);
        }
    }
    Ok(())
}

/// Gives the tables of a request the units of the program: a column `length_a_in` becomes `length_a_m`.
///
/// # Errors
/// Two columns that are the same number in two units; the message names the key.
pub fn convert_units(command: &str, given: &mut Object) -> Result<()> {
    let keys = commands().iter().find(|info| info.name == command).map_or(&[][..], |info| &info.keys);
    for key in keys {
        let Some(value) = given.get_mut(key.name) else { continue };
        let tables: Vec<&mut Value> = match (&key.kind, value) {
            (Kind::Columns | Kind::GappedColumns, value) => vec![value],
            (Kind::Data(_), Value::Array(rows)) if key.name == "offers" => rows.iter_mut().collect(),
            (Kind::Data(_), Value::Object(scenario)) if key.name == "scenario" => {
                let kinds = scenario.iter_mut().filter(|(kind, _)| ["lengths", "anchor"].contains(&kind.as_str()));
                let events = kinds.filter_map(|(_, events)| events.as_array_mut()).flatten();
                events.filter_map(|event| event.get_mut("table")).collect()
            }
            _ => continue,
        };
        for table in tables.into_iter().filter_map(Value::as_object_mut) {
            units::convert_columns(table).map_err(|reason| anyhow!("⟪{}⟫: {reason}", key.name))?;
        }
    }
    Ok(())
}

/// True for a key that the user gave: a switch that is on, a value, or a list of values.
fn is_given(given: &Object, name: &str) -> bool {
    given.get(name).is_some_and(|value| match value {
        Value::Null | Value::Bool(false) => false,
        Value::Array(values) => !values.is_empty(),
        _ => true,
    })
}

/// Checks a list of experiments.
///
/// # Errors
/// A value that is none of an experiment; the message says of which.
pub(super) fn check_experiments(value: &Value) -> Result<()> {
    experiments(value).map_err(|fault| anyhow!("{}: {}", fault.place.trim_start_matches(", "), fault.reason))
}

/// Checks the lists of events of a scenario.
///
/// # Errors
/// A kind of events or a key that does not exist, or a value of another kind; the message names event and key.
pub(crate) fn check_scenario(value: &Value) -> Result<()> {
    scenario(value).map_err(|fault| match fault.place.trim_start_matches(", ") {
        "" => anyhow!("{}", fault.reason),
        place => anyhow!("{place}: {}", fault.reason),
    })
}

/// Value read as the type of its reader. What is wrong with it is said in words of this program.
///
/// # Errors
/// A value that has not this type.
pub(crate) fn read<T: DeserializeOwned>(value: Value) -> Result<T> {
    serde_json::from_value(value).map_err(|error| anyhow!("{}", library_words::of_reader(&error.to_string())))
}

fn of_key(key: &Key, value: &Value) -> KeyCheck {
    match &key.kind {
        Kind::Data(_) => of_data(key.name, value),
        kind => of_kind(kind, value),
    }
}

/// Checks data by the key under which they stand.
fn of_data(name: &str, value: &Value) -> KeyCheck {
    let text = |name| entry(name, Kind::Text, true);
    let file = || vec![text("path"), text("text"), entry("guessed_encoding", Kind::Text, false)];
    match name {
        "robot" | "compare" => {
            object(value, "a mapping with the text of a robot file as `text`", |given| {
                keys_of_object(&[entry("name", Kind::Text, false), text("text")], &["set"], given)
            })?;
            value.get("set").filter(|set| !set.is_null()).map_or(Ok(()), |set| {
                list(set, "a list of changes, each with `path` and `value`", |change| {
                    object(change, "a mapping with `path` and `value`", |given| {
                        keys_of_object(&[text("path")], &["value"], given)
                    })
                })
                .map_err(|fault| fault.within(", `set`"))
            })
        }
        "scenario" => scenario(value),
        "experiments" => experiments(value),
        "offers" => objects(value, &offer_keys()),
        "ropes" => objects(value, &rope_keys()),
        "covariance" => objects(value, &covariance_keys()),
        "responses" => objects(value, &response_keys()),
        "frequencies" => objects(value, &frequency_keys()),
        "histories" => objects(value, &history_keys()),
        "channels" => objects(value, &channel_keys()),
        "from_csv" => object(value, "a mapping with `path` and `text`", |given| keys_of_object(&file(), &[], given)),
        "files" => objects(value, &file()),
        "parts" | "cables" => of_kind(&Kind::Texts, value),
        _ => of_kind(&Kind::Text, value),
    }
}

fn of_kind(kind: &Kind, value: &Value) -> KeyCheck {
    match kind {
        Kind::Switch if value.is_boolean() => Ok(()),
        Kind::Switch => Err(Fault::wanted(value, "true or false")),
        Kind::Number(range) => number(*range, value),
        Kind::Count(range) => {
            let (first, last) = (*range.start(), *range.end());
            let limit = if last == u64::MAX { format!("from {first} on") } else { format!("from {first} to {last}") };
            match value.as_u64() {
                Some(count) if range.contains(&count) => Ok(()),
                _ => Err(format!("{} is not possible: give a whole number {limit}", shown(value)).into()),
            }
        }
        Kind::PerCable(range) | Kind::OneOrPerCable(range) => numbers(*range, None, value),
        Kind::Vector => numbers(Range::Finite, Some(3), value),
        Kind::Tensor => numbers(Range::Finite, Some(6), value),
        Kind::Pose => pose(value),
        Kind::Name(what, choices) => {
            let Value::String(name) = value else { return Err(Fault::wanted(value, &format!("the name of a {what}"))) };
            let names: Vec<String> = choices.iter().map(|choice| choice.name.to_owned()).collect();
            if names.contains(name) { Ok(()) } else { Err(no_such(what, name, &names).into()) }
        }
        Kind::Text => text(value),
        Kind::Texts | Kind::Sizes => list(value, "a list of texts", text),
        Kind::Poses => list(value, "a list of poses", |pose| numbers(Range::Finite, Some(6), pose)),
        Kind::Columns => columns(value, |value| number(Range::Finite, value)),
        Kind::GappedColumns => columns(value, |value| match value {
            Value::Null => Ok(()),
            value => number(Range::Finite, value),
        }),
        Kind::ByCable(range) => by_cable(*range, value),
        Kind::Written(form) => of_form(*form, value),
        Kind::List(form) => list(value, "a list", |item| of_form(*form, item)),
        Kind::OneOrMore(form) | Kind::Commas(form) => match value {
            Value::Array(items) => each(items, |item| of_form(*form, item)),
            one => of_form(*form, one),
        },
        Kind::Data(_) => Ok(()),
    }
}

fn of_form(form: ProgramForm, value: &Value) -> KeyCheck {
    let finite = |name, required| entry(name, Kind::Number(Range::Finite), required);
    let positive = |name, required| entry(name, Kind::Number(Range::Positive), required);
    let text_of = |name| entry(name, Kind::Text, true);
    let keys = match form {
        ProgramForm::Input | ProgramForm::Output => {
            let wanted = "a signal is a text, and several signals are a list of texts";
            return if value.is_string() { Ok(()) } else { Err(format!("{}: {wanted}", shown(value)).into()) };
        }
        ProgramForm::Quantity => return text(value),
        ProgramForm::Positive => return number(Range::Positive, value),
        ProgramForm::NotNegative => return number(Range::NotNegative, value),
        ProgramForm::MassRange => return masses(value),
        ProgramForm::Band => return numbers(Range::Positive, Some(2), value),
        ProgramForm::GridAxis | ProgramForm::Side | ProgramForm::Variation => return axis(value),
        ProgramForm::Fit => vec![
            text_of("path"),
            finite("minimum", false),
            finite("maximum", false),
            finite("prior", false),
            finite("prior_std", false),
        ],
        ProgramForm::Change => {
            vec![text_of("path"), finite("minimum", false), finite("maximum", false), positive("plus_minus", false)]
        }
        ProgramForm::Prior => vec![text_of("path"), finite("prior", false), positive("prior_std", true)],
        ProgramForm::Bound => vec![text_of("quantity"), finite("value", true)],
        ProgramForm::Point => vec![text_of("name"), entry("point_m", Kind::Vector, true)],
    };
    object(value, &with_names("a mapping with", &keys), |given| keys_of_object(&keys, &[], given))
}

/// First value, last value and their number.
fn masses(value: &Value) -> KeyCheck {
    let wanted = "a list of the first mass, the last one and their number, as in [10, 90, 81]";
    let Some([first, last, count]) = value.as_array().map(Vec::as_slice) else {
        return Err(Fault::wanted(value, wanted));
    };
    number(Range::Positive, first)?;
    number(Range::Positive, last)?;
    of_kind(&Kind::Count(2..=u64::MAX), count)
}

fn axis(value: &Value) -> KeyCheck {
    let wanted = "a mapping with `axis` and either `from`, `to` and `count`, or `values`";
    let listed = value.get("values").is_some_and(|values| !values.is_null());
    let number = |name| entry(name, Kind::Number(Range::Finite), true);
    let keys = if listed {
        vec![entry("axis", Kind::Text, true), entry("values", Kind::PerCable(Range::Finite), true)]
    } else {
        let count = entry("count", Kind::Count(0..=u64::MAX), true);
        vec![entry("axis", Kind::Text, true), number("from"), number("to"), count]
    };
    object(value, wanted, |given| keys_of_object(&keys, &[], given))
}

fn experiments(value: &Value) -> KeyCheck {
    list(value, "a list of experiments, each a mapping", |one| {
        object(one, "a mapping", |given| {
            let keys = Experiment::keys();
            if let Some(key) = given.keys().find(|key| !keys.iter().any(|of| of.name == **key)) {
                let is_of_requests = commands().iter().flat_map(|command| &command.keys).any(|of| of.name == *key);
                if is_of_requests {
                    let place = "it is a key of requests and stands beside `experiments`";
                    return Err(format!("an experiment has no key `{key}`; {place}").into());
                }
            }
            keys_of_object(&keys, &[], given)
        })
    })
    .map_err(|fault| fault.within(", experiment"))
}

fn scenario(value: &Value) -> KeyCheck {
    let kinds = simulate::event_kinds();
    let Value::Object(lists) = value else {
        return Err(Fault::wanted(value, "a mapping from kinds of events to lists of events"));
    };
    let names: Vec<String> = kinds.iter().map(|(kind, _)| (*kind).to_owned()).collect();
    for (kind, events) in lists {
        let Some((_, keys)) = kinds.iter().find(|(name, _)| name == kind) else {
            return Err(no_such("kind of events", kind, &names).into());
        };
        if events.is_null() {
            continue;
        }
        let Value::Array(events) = events else {
            let wanted = format!("a list of events, each a mapping; in a file [[{kind}]], one table for each event");
            return Err(Fault::wanted(events, &wanted).within(&format!(", `{kind}`")));
        };
        for (i, event) in events.iter().enumerate() {
            let place = format!(", [[{kind}]] number {}", i + 1);
            object(event, &with_names("a mapping with", keys), |given| keys_of_object(keys, &[], given))
                .map_err(|fault| fault.within(&place))?;
        }
    }
    Ok(())
}

/// Keys of a winch on offer.
fn offer_keys() -> Vec<Key> {
    let gives = OfferedWinch::NUMBERS.map(|name| entry(name, Kind::Number(Range::Positive), false));
    std::iter::once(entry("name", Kind::Text, true)).chain(gives).collect()
}

/// Keys of an entry of a covariance.
fn covariance_keys() -> Vec<Key> {
    let path = |name| entry(name, Kind::Text, true);
    vec![path("first"), path("second"), entry("covariance", Kind::Number(Range::Finite), true)]
}

/// Keys of a rope to choose.
fn rope_keys() -> Vec<Key> {
    let number = |name: &'static str| {
        let is_needed = OfferedRope::NEEDED.contains(&name);
        entry(name, Kind::Number(if is_needed { Range::NotNegative } else { Range::Positive }), is_needed)
    };
    std::iter::once(entry("name", Kind::Text, true)).chain(OfferedRope::NUMBERS.map(number)).collect()
}

fn response_keys() -> Vec<Key> {
    let numbers = |name, required| entry(name, Kind::PerCable(Range::Finite), required);
    vec![
        entry("name", Kind::Text, false),
        entry("input", Kind::Text, true),
        entry("input_point_m", Kind::Vector, false),
        entry("output", Kind::Text, true),
        entry("output_point_m", Kind::Vector, false),
        numbers("frequency_hz", true),
        numbers("real", true),
        numbers("imag", true),
        numbers("std", false),
    ]
}

fn history_keys() -> Vec<Key> {
    vec![
        entry("name", Kind::Text, false),
        entry("time_s", Kind::PerCable(Range::Finite), true),
        entry("channels", Kind::Data(super::shape::objects), true),
    ]
}

fn channel_keys() -> Vec<Key> {
    vec![
        entry("name", Kind::Text, true),
        entry("output", Kind::Text, false),
        entry("output_point_m", Kind::Vector, false),
        entry("values", Kind::PerCable(Range::Finite), true),
        entry("std", Kind::Number(Range::Positive), false),
    ]
}

fn frequency_keys() -> Vec<Key> {
    let number = |name, required| entry(name, Kind::Number(Range::Finite), required);
    vec![
        number("frequency_hz", true),
        number("damping_ratio", false),
        number("damping_std", false),
        number("std_hz", false),
        number("weight", false),
        entry("label", Kind::Text, false),
    ]
}

/// Key of an object inside a value.
fn entry(name: &'static str, kind: Kind, required: bool) -> Key {
    Key { name, required, ..Key::new(kind) }
}

fn with_names(begin: &str, keys: &[Key]) -> String {
    let names: Vec<String> = keys.iter().map(|key| format!("`{}`", key.name)).collect();
    format!("{begin} {}", names.join(", "))
}

/// Checks the keys of an object; `others` are keys of any kind.
fn keys_of_object(keys: &[Key], others: &[&str], given: &Object) -> KeyCheck {
    let known = |name: &str| others.contains(&name) || keys.iter().any(|key| key.name == name);
    if let Some(unknown) = given.keys().find(|name| !known(name)) {
        let names: Vec<String> =
            keys.iter().map(|key| key.name).chain(others.iter().copied()).map(Into::into).collect();
        return Err(format!("there is no key `{unknown}`{}", suggestion(unknown, &names)).into());
    }
    for key in keys {
        match given.get(key.name).filter(|value| !value.is_null()) {
            Some(value) => of_key(key, value).map_err(|fault| fault.within(&format!(", `{}`", key.name)))?,
            None if key.required => return Err(format!("it has no `{}`", key.name).into()),
            None => {}
        }
    }
    Ok(())
}

fn object(value: &Value, wanted: &str, keys: impl FnOnce(&Object) -> KeyCheck) -> KeyCheck {
    match value {
        Value::Object(given) => keys(given),
        other => Err(Fault::wanted(other, wanted)),
    }
}

/// List of objects with the same keys.
fn objects(value: &Value, keys: &[Key]) -> KeyCheck {
    list(value, "a list of mappings", |item| {
        object(item, &with_names("a mapping with", keys), |given| keys_of_object(keys, &[], given))
    })
}

fn list(value: &Value, wanted: &str, item: impl Fn(&Value) -> KeyCheck) -> KeyCheck {
    match value {
        Value::Array(items) => each(items, item),
        other => Err(Fault::wanted(other, wanted)),
    }
}

fn each(items: &[Value], item: impl Fn(&Value) -> KeyCheck) -> KeyCheck {
    for (i, value) in items.iter().enumerate() {
        item(value).map_err(|fault| fault.within(&format!(", number {}", i + 1)))?;
    }
    Ok(())
}

fn text(value: &Value) -> KeyCheck {
    if value.is_string() { Ok(()) } else { Err(Fault::wanted(value, "a text")) }
}

fn number(range: Range, value: &Value) -> KeyCheck {
    let Some(number) = value.as_f64().filter(|_| value.is_number()) else {
        let wanted = if value.is_string() { "a number, without quotes" } else { "a number" };
        return Err(Fault::wanted(value, wanted));
    };
    range.check(number).map(drop).map_err(Fault::from)
}

/// Numbers in a range, as many as are given or this many.
fn numbers(range: Range, count: Option<usize>, value: &Value) -> KeyCheck {
    let wanted = count.map_or("a list of numbers".to_owned(), |count| format!("a list of {count} numbers"));
    match value {
        Value::Array(items) if count.is_none_or(|count| items.len() == count) => {
            each(items, |item| number(range, item))
        }
        Value::Array(items) => Err(format!("{} numbers are given: give {wanted}", items.len()).into()),
        other => Err(Fault::wanted(other, &wanted)),
    }
}

fn pose(value: &Value) -> KeyCheck {
    match value {
        Value::Array(items) if matches!(items.len(), 3 | 6) => numbers(Range::Finite, None, value),
        Value::Object(given) => {
            let list = |name| entry(name, Kind::PerCable(Range::Finite), true);
            keys_of_object(&[list("position_m"), list("quaternion_wxyz")], &[], given)
        }
        _ => {
            let forms = "a pose is [x, y, z], [x, y, z, roll, pitch, yaw] or {position_m, quaternion_wxyz}";
            Err(format!("{}: {forms}", shown(value)).into())
        }
    }
}

/// Columns by their names.
fn columns(value: &Value, cell: impl Fn(&Value) -> KeyCheck) -> KeyCheck {
    let Value::Object(columns) = value else {
        return Err(Fault::wanted(value, "a table: a mapping from names of columns to lists of numbers"));
    };
    for (name, rows) in columns {
        let at = |fault: Fault| fault.within(&format!(", column `{name}`"));
        let Value::Array(rows) = rows else { return Err(at(Fault::wanted(rows, "a list of numbers"))) };
        for (i, value) in rows.iter().enumerate() {
            cell(value).map_err(|fault| at(fault.within(&format!(", row {}", i + 1))))?;
        }
    }
    Ok(())
}

/// Numbers by the names of cables.
fn by_cable(range: Range, value: &Value) -> KeyCheck {
    let Value::Object(numbers) = value else {
        return Err(Fault::wanted(value, "a mapping from names of cables to numbers"));
    };
    for (name, value) in numbers {
        number(range, value).map_err(|fault| fault.within(&format!(", cable \"{name}\"")))?;
    }
    Ok(())
}

/// Value in a message: text in quotes, and what stands for a list or a mapping.
fn shown(value: &Value) -> String {
    match value {
        Value::String(text) => format!("the text \"{text}\""),
        Value::Array(items) => format!("a list of {}", items.len()),
        Value::Object(_) => "a mapping".to_owned(),
        other => format!("`{other}`"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn of(command: &str, given: &Value) -> String {
        let Value::Object(given) = given else { panic!("an object is checked") };
        check_given(command, given).map_or_else(|error| error.to_string(), |()| String::new())
    }

    #[test]
    fn a_value_of_another_kind_is_named_with_its_key_and_place() {
        for (given, says) in [
            (json!({ "mass_kg": "5" }), "⟪mass_kg⟫: the text \"5\" is no answer: give a number, without quotes"),
            (json!({ "mass_kg": -1 }), "⟪mass_kg⟫: -1 is not positive"),
            (json!({ "lengths_m": [1, -2] }), "⟪lengths_m⟫, number 2: -2 is not positive"),
            (json!({ "force_n": [1, 2] }), "⟪force_n⟫: 2 numbers are given: give a list of 3 numbers"),
            (json!({ "force_n": [1, 2, 1e13] }), "⟪force_n⟫, number 3: 10000000000000.0 is beyond 1e12 in magnitude"),
            (json!({ "all": 1 }), "⟪all⟫: `1` is no answer: give true or false"),
            (json!({ "robot": { "text": "", "set": [{ "pth": "a" }] } }), "⟪robot⟫, `set`, number 1: there is no key"),
        ] {
            let told = of("statics", &given);
            assert!(told.starts_with(says), "{told}");
        }
        assert_eq!(of("statics", &json!({ "mass_kg": 5, "all": false, "pose": [0, 0, 1] })), "");
    }

    /// Number of a key as JSON, in a list where the key has one.
    fn number_of(kind: &Kind, number: f64) -> Option<Value> {
        match kind {
            Kind::Number(_) | Kind::Written(ProgramForm::Positive | ProgramForm::NotNegative) => Some(json!(number)),
            Kind::Count(_) if number.fract() == 0.0 => Some(json!(number as i64)),
            Kind::PerCable(_)
            | Kind::OneOrPerCable(_)
            | Kind::List(ProgramForm::Positive | ProgramForm::NotNegative)
            | Kind::Commas(ProgramForm::Positive | ProgramForm::NotNegative) => Some(json!([number])),
            Kind::Vector => Some(json!([0, number, 0])),
            Kind::Pose | Kind::Tensor => Some(json!([0, 0, number, 0, 0, 0])),
            _ => None,
        }
    }

    /// Every command, every key with numbers: the program refuses a number as an option if and only if a request
    /// refuses it, which Python and the page make of their values.
    #[test]
    fn every_numeric_option_has_one_range_for_all_front_ends() {
        let mut compared = 0;
        for command in commands() {
            for key in &command.keys {
                for number in [0.0, -1.0, -0.5, 0.5, 1.5, 1e-13, 1e13, -1e13, 1e300, 3.0] {
                    let Some(value) = number_of(&key.kind, number) else { continue };
                    let text = match &value {
                        Value::Array(items) => items.iter().map(ToString::to_string).collect::<Vec<_>>().join(","),
                        value => value.to_string(),
                    };
                    let program = crate::written::read(key, &text).map(drop);
                    let request = check_given(command.name, &Object::from_iter([(key.name.to_owned(), value)]));
                    // A key that needs another one is refused for that reason.
                    let request = request.map_err(|error| error.to_string());
                    let request = request.or_else(|why| if why.contains("means nothing") { Ok(()) } else { Err(why) });
                    let place = format!("{} {} {text}", command.name, key.name);
                    assert_eq!(program.is_err(), request.is_err(), "{place}: {program:?} {request:?}");
                    if let (Err(program), Err(request)) = (program, request) {
                        let reason = request.rsplit_once(": ").map_or(&*request, |(_, reason)| reason);
                        assert!(
                            program.replace("e+", "e").contains(reason) || matches!(key.kind, Kind::Count(_)),
                            "{place}: {program} {request}"
                        );
                    }
                    compared += 1;
                }
            }
        }
        assert!(compared > 2000, "{compared}");
    }

    #[test]
    fn keys_that_need_or_exclude_each_other_are_refused() {
        assert!(of("clearance", &json!({ "find_way": true })).contains("⟪find_way⟫ means nothing without ⟪move_to⟫"));
        assert_eq!(of("clearance", &json!({ "find_way": false })), "");
        let both = json!({ "fastest": true, "duration_s": 2 });
        assert!(of("trajectory", &both).contains("give ⟪duration_s⟫ or ⟪fastest⟫, not both"));
    }

    #[test]
    fn events_are_named_with_their_kind_number_and_key() {
        for (given, says) in [
            (json!({ "release": { "at_s": 0 } }), "`release`: a mapping is no answer: give a list of events"),
            (json!({ "relaese": [] }), "there is no kind of events `relaese`; did you mean `release`?"),
            (json!({ "release": [{ "mass_kg": 1 }] }), "[[release]] number 1: it has no `at_s`"),
            (json!({ "push": [{ "at_s": 0, "duration_s": 1, "force": [1, 2, 3] }] }), "did you mean `force_n`?"),
            (json!({ "stop": [{ "at_s": "0", "duration_s": 1 }] }), "[[stop]] number 1, `at_s`: the text \"0\""),
            (
                json!({ "lengths": [{ "at_s": 0, "table": { "t_s": [0, true] } }] }),
                "[[lengths]] number 1, `table`, column `t_s`, row 2: `true` is no answer",
            ),
            (json!({ "tension": [{ "at_s": 0, "duration_s": 1, "tension_n": 5 }] }), "names of cables to numbers"),
            (json!([1]), "a list of 1 is no answer"),
        ] {
            let told = check_scenario(&given).unwrap_err().to_string();
            assert!(told.contains(says), "{told}");
        }
        let right = json!({ "cut": [{ "cable": "1", "at_s": 0.5 }], "pick": [] });
        assert!(check_scenario(&right).is_ok());
    }
}

//! JSON Schema of requests, made from the declaration of their keys.

use super::key::{Declared, Key, Kind, ProgramForm, Range};
use super::simulate::event_kinds;
use super::{CommandInfo, Experiment, SCHEMA, commands};
use crate::wording::{Words, worded};
use serde_json::{Map, Value, json};

/// JSON Schema (draft 2020-12) of all requests: one form per command.
pub fn schema() -> Value {
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Request of funicular",
        "oneOf": commands().iter().map(of_command).collect::<Vec<_>>(),
    })
}

fn of_command(command: &CommandInfo) -> Value {
    let mut properties = Map::from_iter([
        ("schema".to_owned(), json!({ "const": SCHEMA })),
        ("command".to_owned(), json!({ "const": command.name })),
    ]);
    properties.extend(properties_of(&command.keys));
    let keys = command.keys.iter().filter(|key| key.required).map(|key| key.name);
    let required: Vec<&str> = ["command"].into_iter().chain(keys).collect();
    json!({
        "title": command.name,
        "description": worded(&command.about, Words::Json),
        "type": "object",
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    })
}

/// Properties of an object with these keys.
fn properties_of(keys: &[Key]) -> Map<String, Value> {
    keys.iter().map(|key| (key.name.to_owned(), of_key(key))).collect()
}

fn of_key(key: &Key) -> Value {
    let mut schema = of_kind(&key.kind);
    let otherwise = key.otherwise.map(|text| format!(" (default: {text})")).unwrap_or_default();
    if let Value::Object(schema) = &mut schema {
        schema.insert("description".to_owned(), (worded(&key.about, Words::Json) + &otherwise).into());
        if !key.default.is_null() {
            schema.insert("default".to_owned(), key.default.clone());
        }
    }
    schema
}

fn of_kind(kind: &Kind) -> Value {
    match kind {
        Kind::Switch => json!({ "type": "boolean" }),
        Kind::Number(range) => number(*range),
        Kind::Count(range) => json!({ "type": "integer", "minimum": range.start(), "maximum": range.end() }),
        Kind::PerCable(range) | Kind::OneOrPerCable(range) => numbers(*range, None),
        Kind::Vector => numbers(Range::Finite, Some(3)),
        Kind::Pose => pose(),
        Kind::Tensor => numbers(Range::Finite, Some(6)),
        Kind::Name(_, choices) => json!({ "enum": choices.iter().map(|choice| choice.name).collect::<Vec<_>>() }),
        Kind::Text => text(),
        Kind::Texts | Kind::Sizes => texts(),
        Kind::Poses => poses(),
        Kind::Columns => columns(),
        Kind::GappedColumns => gapped_columns(),
        Kind::ByCable(range) => json!({ "type": "object", "additionalProperties": number(*range) }),
        Kind::Written(form) => of_form(*form),
        Kind::List(form) => list(&of_form(*form)),
        Kind::OneOrMore(form) | Kind::Commas(form) => {
            json!({ "anyOf": [of_form(*form), list(&of_form(*form))] })
        }
        Kind::Data(schema) => schema(),
    }
}

fn of_form(form: ProgramForm) -> Value {
    match form {
        ProgramForm::Input | ProgramForm::Output | ProgramForm::Quantity => text(),
        ProgramForm::Positive => number(Range::Positive),
        ProgramForm::NotNegative => number(Range::NotNegative),
        ProgramForm::MassRange => mass_range(),
        ProgramForm::GridAxis | ProgramForm::Side | ProgramForm::Variation => axis(),
        ProgramForm::Fit => fit(),
        ProgramForm::Change => change(),
        ProgramForm::Prior => prior(),
        ProgramForm::Band => numbers(Range::Positive, Some(2)),
        ProgramForm::Bound => bound(),
        ProgramForm::Point => point(),
    }
}

fn list(items: &Value) -> Value {
    json!({ "type": "array", "items": items })
}

fn object(required: &[&str], properties: &Value) -> Value {
    json!({ "type": "object", "properties": properties, "required": required, "additionalProperties": false })
}

pub(super) fn text() -> Value {
    json!({ "type": "string" })
}

pub(super) fn texts() -> Value {
    list(&text())
}

/// List of objects whose keys the reader of measurements checks.
pub(super) fn objects() -> Value {
    list(&json!({ "type": "object" }))
}

fn number(range: Range) -> Value {
    let (minimum, maximum) = range.ends();
    json!({ "type": "number", "minimum": minimum, "maximum": maximum })
}

/// Numbers in a range, as many as are given or this many.
fn numbers(range: Range, count: Option<usize>) -> Value {
    let mut schema = list(&number(range));
    if let (Some(count), Value::Object(schema)) = (count, &mut schema) {
        schema.insert("minItems".to_owned(), count.into());
        schema.insert("maxItems".to_owned(), count.into());
    }
    schema
}

fn pose() -> Value {
    let by_quaternion = json!({
        "position_m": numbers(Range::Finite, Some(3)),
        "quaternion_wxyz": numbers(Range::Finite, Some(4)),
    });
    json!({
        "anyOf": [
            numbers(Range::Finite, Some(3)),
            numbers(Range::Finite, Some(6)),
            object(&["position_m", "quaternion_wxyz"], &by_quaternion),
        ],
    })
}

fn poses() -> Value {
    list(&numbers(Range::Finite, Some(6)))
}

fn columns() -> Value {
    json!({ "type": "object", "additionalProperties": numbers(Range::Finite, None) })
}

fn gapped_columns() -> Value {
    let or_gap = json!({ "anyOf": [number(Range::Finite), { "type": "null" }] });
    json!({ "type": "object", "additionalProperties": { "type": "array", "items": or_gap } })
}

fn mass_range() -> Value {
    let mass = number(Range::Positive);
    json!({ "type": "array", "prefixItems": [mass, mass, { "type": "integer", "minimum": 2 }], "items": false,
        "minItems": 3 })
}

/// Values along an axis of a grid or sweep.
fn axis() -> Value {
    let (number, count) = (number(Range::Finite), json!({ "type": "integer", "minimum": 2 }));
    let steps = json!({ "axis": text(), "from": number, "to": number, "count": count });
    let listed = json!({ "axis": text(), "values": list(&number) });
    json!({ "anyOf": [object(&["axis", "from", "to", "count"], &steps), object(&["axis", "values"], &listed)] })
}

fn fit() -> Value {
    let number = number(Range::Finite);
    let keys = json!({ "path": text(), "minimum": number, "maximum": number, "prior": number, "prior_std": number });
    object(&["path"], &keys)
}

fn change() -> Value {
    let number = number(Range::Finite);
    object(&["path"], &json!({ "path": text(), "minimum": number, "maximum": number, "plus_minus": number }))
}

fn prior() -> Value {
    let keys = json!({ "path": text(), "prior": number(Range::Finite), "prior_std": number(Range::Positive) });
    object(&["path", "prior_std"], &keys)
}

fn bound() -> Value {
    object(&["quantity", "value"], &json!({ "quantity": text(), "value": number(Range::Finite) }))
}

fn point() -> Value {
    object(&["name", "point_m"], &json!({ "name": text(), "point_m": numbers(Range::Finite, Some(3)) }))
}

/// Events of a simulation.
pub(super) fn scenario() -> Value {
    let event = |keys: &[Key]| {
        let required: Vec<&str> = keys.iter().filter(|key| key.required).map(|key| key.name).collect();
        object(&required, &properties_of(keys).into())
    };
    let lists: Map<String, Value> =
        event_kinds().iter().map(|(kind, keys)| ((*kind).to_owned(), list(&event(keys)))).collect();
    json!({ "type": "object", "properties": lists, "additionalProperties": false })
}

/// Text of a robot file with its changes.
pub(super) fn robot() -> Value {
    let change = object(&["path", "value"], &json!({ "path": text(), "value": {} }));
    object(&["text"], &json!({ "name": text(), "text": text(), "set": list(&change) }))
}

/// File of another program.
pub(super) fn file() -> Value {
    json!({ "type": "object", "properties": { "path": text(), "text": text() }, "required": ["path", "text"] })
}

pub(super) fn files() -> Value {
    list(&file())
}

pub(super) fn experiments() -> Value {
    list(&json!({
        "type": "object",
        "properties": properties_of(&Experiment::keys()),
        "additionalProperties": false,
    }))
}

//! `schema`: what programs and editors ask about the files and tables of the program.

use crate::Results;
use crate::columns::CommandTables;
use crate::json;
use crate::names::SchemaSubject;
use crate::request::{self, SchemaRequest};
use crate::robot_file::schema;
use crate::sweep;
use crate::table::Column;
use serde_json::{Map, Value, json};

/// Tables and results of commands that only a front end has.
#[derive(Default)]
pub struct MoreCommands {
    /// Tables in files.
    pub tables: Vec<CommandTables>,
    /// JSON Schemas of the results without the keys that all results have, by the name of the command.
    pub results: Vec<(&'static str, Value)>,
}

/// Text of the schema of a request: that of the robot file, that of requests or results, or the columns of results.
pub fn of_request(request: &SchemaRequest, more: MoreCommands) -> String {
    match request.of {
        SchemaSubject::RobotFile => schema::text(),
        SchemaSubject::Request => format!("{:#}\n", request::schema()),
        SchemaSubject::Columns => format!("{:#}\n", columns(more.tables)),
        SchemaSubject::Results => format!("{:#}\n", results(more.results)),
    }
}

/// Columns of the tables that the commands write as CSV: name, unit, and meaning. A command has one table or several,
/// each with the words that say when it is that one.
fn columns(more: Vec<CommandTables>) -> Value {
    let of_column = |column: Column| json!({ "name": column.name, "unit": column.unit, "about": column.about });
    let of_table = |(with, columns): (&str, Vec<Column>)| {
        json!({ "with": with,
        "columns": columns.into_iter().map(of_column).collect::<Vec<_>>() })
    };
    let of_command =
        |(name, tables): (&str, Vec<_>)| (name.to_owned(), tables.into_iter().map(of_table).collect::<Value>());
    let all = Results::tables().into_iter().chain(sweep::tables()).chain(more);
    Value::Object(all.map(of_command).collect())
}

/// JSON Schema of the results of every command. The key `unit` of a number is no keyword of JSON Schema: it says the
/// unit to readers.
fn results(more: Vec<(&'static str, Value)>) -> Value {
    let all = Results::schemas().into_iter().chain(more);
    let definitions: Map<String, Value> =
        all.map(|(command, schema)| (command.to_owned(), with_envelope(command, schema))).collect();
    let forms: Vec<Value> = definitions.keys().map(|name| json!({ "$ref": format!("#/$defs/{name}") })).collect();
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Results of funicular",
        "description": "JSON of the results of a command; `command` says which one.",
        "oneOf": forms,
        "$defs": definitions,
    })
}

/// Schema of the results of a command with the keys that all results have.
fn with_envelope(command: &str, mut schema: Value) -> Value {
    if let Some(forms) = schema.get_mut("oneOf").and_then(Value::as_array_mut) {
        for form in forms {
            *form = with_envelope(command, form.take());
        }
        return schema;
    }
    let keys = [
        ("schema", json!({ "const": json::SCHEMA, "description": "Version of the form of results" })),
        ("command", json!({ "const": command, "description": "Command of the results" })),
        (
            "warnings",
            json!({
                "type": "array", "items": { "type": "string" },
                "description": "Sentences that the user should know before trusting the numbers",
            }),
        ),
        ("robot", json!({ "type": "string", "description": "Name of the robot; absent if there are several" })),
    ];
    for (name, of_key) in keys {
        // A key that stands twice is read differently by every program.
        assert!(schema["properties"].get(name).is_none(), "results of `{command}` have a second key `{name}`");
        schema["properties"][name] = of_key;
        if let Some(required) = schema["required"].as_array_mut().filter(|_| name != "robot") {
            required.push(name.into());
        }
    }
    schema
}

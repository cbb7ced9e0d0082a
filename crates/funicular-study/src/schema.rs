//! `schema`: what programs and editors ask about the files and tables of the program.

use crate::Results;
use crate::columns::CommandTables;
use crate::names::SchemaSubject;
use crate::request::{self, SchemaRequest};
use crate::robot_file::schema;
use crate::sweep;
use crate::table::Column;
use serde_json::{Value, json};

/// Text of the schema of a request: that of the robot file, that of requests, or the columns of results. `more` are the
/// tables of commands that only the front end has.
pub fn of_request(request: &SchemaRequest, more: Vec<CommandTables>) -> String {
    match request.of {
        SchemaSubject::RobotFile => schema::text(),
        SchemaSubject::Request => format!("{:#}\n", request::schema()),
        SchemaSubject::Columns => format!("{:#}\n", columns(more)),
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

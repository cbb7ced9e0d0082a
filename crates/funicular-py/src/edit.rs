//! The text of a robot file made and changed from Python, so that every check of the reader holds.

use crate::arrays;
use crate::errors;
use funicular_files::edit;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use toml_edit::{Array, ArrayOfTables, DocumentMut, Item, Table, Value};

/// The text with values put at their paths.
pub(crate) fn with_values(text: &str, changes: &Bound<'_, PyDict>) -> PyResult<String> {
    let mut assignments = Vec::with_capacity(changes.len());
    for (path, value) in changes {
        let path: String = path.extract()?;
        let value = value_of(&path, &value, 0)?;
        let written = format!("{path}={}", value.to_string().trim());
        let assignment = edit::assignment(&written).map_err(|reason| errors::change(format!("{path}: {reason}")))?;
        assignments.push(assignment.said_after("with_"));
    }
    edit::apply(text, &assignments).map_err(|reason| {
        let reason = format!("{reason:#}");
        errors::change(reason.strip_prefix("with_ ").unwrap_or(&reason).to_owned())
    })
}

/// The text of a dictionary with the keys of a robot file.
pub(crate) fn of_dict(of: &Bound<'_, PyDict>) -> PyResult<String> {
    let mut document = DocumentMut::new();
    fill(document.as_table_mut(), "", of, 0)?;
    Ok(document.to_string())
}

/// Refuses what holds itself.
fn check_depth(path: &str, depth: usize) -> PyResult<()> {
    const DEEPEST: usize = 16;
    if depth > DEEPEST {
        return Err(errors::change(format!("`{path}` is nested more than {DEEPEST} deep: no robot file is")));
    }
    Ok(())
}

fn fill(table: &mut Table, path: &str, of: &Bound<'_, PyDict>, depth: usize) -> PyResult<()> {
    check_depth(path, depth)?;
    // Values before tables: what follows a table's head belongs to it.
    for tables in [false, true] {
        for (key, value) in of {
            let key: String =
                key.extract().map_err(|_| errors::change(format!("a key of the robot is {key}: keys are text")))?;
            let at = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
            if let Ok(inner) = value.cast::<PyDict>() {
                if tables {
                    let mut below = Table::new();
                    fill(&mut below, &at, inner, depth + 1)?;
                    table.insert(&key, Item::Table(below));
                }
            } else if let Some(rows) = tables_of(&value) {
                if tables {
                    let mut list = ArrayOfTables::new();
                    for row in rows {
                        let mut below = Table::new();
                        fill(&mut below, &at, &row, depth + 1)?;
                        list.push(below);
                    }
                    table.insert(&key, Item::ArrayOfTables(list));
                }
            } else if !tables {
                table.insert(&key, Item::Value(value_of(&at, &value, depth)?));
            }
        }
    }
    Ok(())
}

/// A list of tables, of which there is at least one.
fn tables_of<'py>(value: &Bound<'py, PyAny>) -> Option<Vec<Bound<'py, PyDict>>> {
    let list = value.cast::<PyList>().ok()?;
    let rows: Option<Vec<_>> = list.iter().map(|row| row.cast_into::<PyDict>().ok()).collect();
    rows.filter(|rows| !rows.is_empty())
}

/// A value of TOML; arrays of NumPy and their numbers, too.
fn value_of(path: &str, value: &Bound<'_, PyAny>, depth: usize) -> PyResult<Value> {
    check_depth(path, depth)?;
    if let Ok(value) = value.cast::<PyBool>() {
        return Ok(Value::from(value.is_true()));
    }
    if let Ok(value) = value.cast::<PyString>() {
        return Ok(Value::from(value.to_str()?));
    }
    if let Ok(value) = value.cast::<PyInt>() {
        return match value.extract::<i64>() {
            Ok(value) => Ok(Value::from(value)),
            Err(_) => Err(errors::change(format!("`{path}` is {value}: no value of a robot is so large"))),
        };
    }
    if let Ok(value) = value.cast::<PyFloat>() {
        return Ok(Value::from(value.value()));
    }
    if value.cast::<PyList>().is_ok() || value.cast::<PyTuple>().is_ok() {
        let items: PyResult<Array> = value.try_iter()?.map(|item| value_of(path, &item?, depth + 1)).collect();
        return Ok(Value::Array(items?));
    }
    // Numbers and arrays of other libraries, such as NumPy.
    if let Some(plain) = arrays::as_python(path, value, errors::change)? {
        return value_of(path, &plain, depth + 1);
    }
    let kind = value.get_type().name()?.to_string();
    Err(errors::change(format!("`{path}` is of type {kind}: a robot file holds numbers, text, and lists of them")))
}

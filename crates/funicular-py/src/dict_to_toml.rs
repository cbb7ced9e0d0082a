//! Text of a robot file from a dictionary of Python, so that the checks of the reader apply.

use crate::arrays;
use crate::errors;
use funicular_study::request::Change;
use funicular_study::set_values;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use serde_json::Value as Json;
use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, Value};

/// Changes of a robot file from a dictionary: values by their paths.
pub(crate) fn changes(of: &Bound<'_, PyDict>) -> PyResult<Vec<Change>> {
    let change = |(path, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        let path: String =
            path.extract().map_err(|_| errors::change(format!("a path of the changes is {path}: paths are text")))?;
        let value = json_of(&path, &value, 0)?;
        Ok(Change { path, value })
    };
    of.iter().map(change).collect()
}

/// Text of a robot file from a dictionary with its keys.
pub(crate) fn of_dict(of: &Bound<'_, PyDict>) -> PyResult<String> {
    let mut document = DocumentMut::new();
    fill(document.as_table_mut(), "", of, 0)?;
    Ok(document.to_string())
}

/// Refuses values that contain themselves.
fn check_depth(path: &str, depth: usize) -> PyResult<()> {
    const MAX_DEPTH: usize = 16;
    if depth > MAX_DEPTH {
        return Err(errors::change(format!("`{path}` is nested more than {MAX_DEPTH} deep: no robot file is")));
    }
    Ok(())
}

/// Fills a table with the keys of a dictionary.
fn fill(table: &mut Table, path: &str, of: &Bound<'_, PyDict>, depth: usize) -> PyResult<()> {
    check_depth(path, depth)?;
    let mut tables = Vec::new();
    for (key, value) in of {
        let key: String =
            key.extract().map_err(|_| errors::change(format!("a key of the robot is {key}: keys are text")))?;
        let at = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        if is_table(&value) {
            tables.push((key, at, value));
        } else {
            table.insert(&key, Item::Value(value_of(&at, &value, depth)?));
        }
    }

    // Values before tables: lines after the head of a table belong to the table.
    for (key, at, value) in tables {
        table.insert(&key, table_of(&at, &value, depth + 1)?);
    }
    Ok(())
}

/// True for a table or a list of tables.
fn is_table(value: &Bound<'_, PyAny>) -> bool {
    value.cast::<PyDict>().is_ok() || tables_of(value).is_some()
}

/// Table of a dictionary, or tables of a list of dictionaries.
fn table_of(path: &str, value: &Bound<'_, PyAny>, depth: usize) -> PyResult<Item> {
    let filled = |of: &Bound<'_, PyDict>| {
        let mut table = Table::new();
        fill(&mut table, path, of, depth)?;
        Ok(table)
    };
    if let Ok(of) = value.cast::<PyDict>() {
        return filled(of).map(Item::Table);
    }
    let rows = tables_of(value).unwrap_or_default();
    rows.iter().map(filled).collect::<PyResult<ArrayOfTables>>().map(Item::ArrayOfTables)
}

/// List of tables with at least one table.
fn tables_of<'py>(value: &Bound<'py, PyAny>) -> Option<Vec<Bound<'py, PyDict>>> {
    let list = value.cast::<PyList>().ok()?;
    let rows: Option<Vec<_>> = list.iter().map(|row| row.cast_into::<PyDict>().ok()).collect();
    rows.filter(|rows| !rows.is_empty())
}

/// Value in TOML.
fn value_of(path: &str, value: &Bound<'_, PyAny>, depth: usize) -> PyResult<Value> {
    let value = json_of(path, value, depth)?;
    set_values::from_json(&value).map_err(|reason| errors::change(format!("`{path}`: {reason}")))
}

/// Value of a robot file in JSON, also from arrays and numbers of NumPy.
fn json_of(path: &str, value: &Bound<'_, PyAny>, depth: usize) -> PyResult<Json> {
    check_depth(path, depth)?;
    if let Ok(value) = value.cast::<PyBool>() {
        return Ok(value.is_true().into());
    }
    if let Ok(value) = value.cast::<PyString>() {
        return Ok(value.to_str()?.into());
    }
    if let Ok(value) = value.cast::<PyInt>() {
        return match value.extract::<i64>() {
            Ok(value) => Ok(value.into()),
            Err(_) => Err(errors::change(format!("`{path}` is {value}: no value of a robot is so large"))),
        };
    }
    if let Ok(value) = value.cast::<PyFloat>() {
        let number = serde_json::Number::from_f64(value.value());
        let refused = || errors::change(format!("`{path}` is {}: it must be finite", value.value()));
        return number.map(Json::Number).ok_or_else(refused);
    }

    if value.cast::<PyList>().is_ok() || value.cast::<PyTuple>().is_ok() {
        return value
            .try_iter()?
            .map(|item| json_of(path, &item?, depth + 1))
            .collect::<PyResult<Vec<_>>>()
            .map(Json::Array);
    }
    // Numbers and arrays of other libraries, such as NumPy.
    if let Some(plain) = arrays::as_python(path, value, errors::change)? {
        return json_of(path, &plain, depth + 1);
    }
    let kind = value.get_type().name()?.to_string();
    Err(errors::change(format!("`{path}` is of type {kind}: give numbers, text, or lists of them")))
}

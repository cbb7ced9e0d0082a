//! The numbers of crates/funicular-study/reference/published.json: what others published or computed, each with its source.

use serde_json::Value;
use std::sync::LazyLock;

static PUBLISHED: LazyLock<Value> =
    LazyLock::new(|| serde_json::from_str(include_str!("../../../funicular-study/reference/published.json")).unwrap());

/// A table by its name.
pub(crate) fn table(name: &str) -> &'static Value {
    PUBLISHED.get(name).unwrap_or_else(|| panic!("published.json has no table {name}"))
}

/// The rows of a table.
pub(crate) fn rows(name: &str) -> &'static [Value] {
    table(name)["rows"].as_array().unwrap_or_else(|| panic!("{name} has no rows"))
}

pub(crate) fn number(row: &Value, key: &str) -> f64 {
    row[key].as_f64().unwrap_or_else(|| panic!("{key} is no number in {row}"))
}

pub(crate) fn flag(row: &Value, key: &str) -> bool {
    row[key].as_bool().unwrap_or_else(|| panic!("{key} is neither true nor false in {row}"))
}

/// As many numbers as there are, at least one.
pub(crate) fn list(row: &Value, key: &str) -> Vec<f64> {
    let values = row[key].as_array().unwrap_or_else(|| panic!("{key} is no list in {row}"));
    assert!(!values.is_empty(), "{key} is empty in {row}");
    values.iter().map(|value| value.as_f64().unwrap_or_else(|| panic!("{value} is no number in {key}"))).collect()
}

/// A fixed number of numbers.
pub(crate) fn numbers<const N: usize>(row: &Value, key: &str) -> [f64; N] {
    list(row, key).try_into().unwrap_or_else(|found: Vec<f64>| panic!("{key} has {} numbers, not {N}", found.len()))
}

#[test]
fn every_table_says_where_its_numbers_come_from() {
    for (name, table) in PUBLISHED.as_object().unwrap() {
        if name != "_about" {
            assert!(table["source"].as_str().is_some_and(|source| source.len() > 20), "{name}");
        }
    }
}

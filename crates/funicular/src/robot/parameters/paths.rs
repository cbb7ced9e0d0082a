//! Key, component and unit that follow from the path of a number alone, without a robot.

use crate::robot::spec::key::{Absent, Component, Key, KeyValue, Numeric};
use crate::robot::spec::{TABLES, TOP};

/// Key of the table at the beginning of a path, and the number of the path's keys up to it. The rest of the path names
/// a component.
pub(super) fn key_of(path: &[&str]) -> Option<(&'static Key, usize)> {
    (1..=path.len()).rev().find_map(|count| {
        let (header, key) = match path[..count] {
            [key] => (TOP.to_owned(), key),
            [
                kind @ ("materials" | "pulleys" | "winches" | "guide_wheels" | "supports" | "platform_bodies"
                | "obstacles"),
                _,
                key,
            ] => (format!("[{kind}.NAME]"), key),
            ["cables", _, key] => ("[[cables]]".to_owned(), key),
            ["required_loads", _, key] => ("[[required_loads]]".to_owned(), key),
            [table, key] => (format!("[{table}]"), key),
            _ => return None,
        };
        let table = TABLES.iter().find(|table| table.header == header)?;
        table.keys.iter().find(|known| known.name == key).map(|key| (key, count))
    })
}

/// Key that holds numbers, at the beginning of a path, and the rest of the path.
fn numbers_of<'p>(path: &'p [&'p str]) -> Option<(&'static Key, &'static Numeric, &'p [&'p str])> {
    let (key, count) = key_of(path)?;
    let KeyValue::Numbers(numbers) = &key.value else { return None };
    Some((key, numbers, &path[count..]))
}

/// Component that the end of a path names, by its name or its index from 0; `None` for a path that ends at a key of the
/// file.
///
/// # Example
/// ```
/// use funicular::robot::parameters::component;
///
/// let z = component(&["cables", "3", "anchor_m", "z"]).unwrap();
/// assert_eq!((z.row, z.column), (2, None));
/// assert_eq!(component(&["cables", "3", "anchor_m", "2"]), Some(z));
/// let xy = component(&["platform", "inertia_kg_m2", "1", "0"]).unwrap();
/// assert_eq!((xy.row, xy.column), (0, Some(1)));
/// assert!(component(&["cables", "3", "anchor_m"]).is_none());
/// ```
pub fn component<K: AsRef<str>>(path: &[K]) -> Option<ComponentOfKey> {
    let path: Vec<&str> = path.iter().map(AsRef::as_ref).collect();
    let (key, numbers, rest) = numbers_of(&path)?;
    let (row, column) = match numbers.shape.place(rest)? {
        Component::Element(i) => (i, None),
        Component::Entry(i, j) => (i, Some(j)),
    };
    Some(ComponentOfKey { row, column, beyond_key: rest.len(), default: key.default_numbers(), example: key.example })
}

/// Place of a component in the array of its key.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ComponentOfKey {
    /// Element of the vector, or row of the tensor.
    pub row: usize,
    /// Column of the tensor; the mirrored entry has the same value. `None` for an element of a vector and for a
    /// principal moment.
    pub column: Option<usize>,
    /// Number of keys of the path after the key of the array: one, or two for row and column.
    pub beyond_key: usize,
    /// Default vector, used if the file gives none.
    pub default: Option<[f64; 3]>,
    /// Line of a robot file with the whole array.
    pub example: &'static str,
}

/// Array at the beginning of a path that goes on to no number of it: the number of keys up to the array, and the names
/// and indices of its numbers for a message.
///
/// # Example
/// ```
/// use funicular::robot::parameters::unknown_component;
///
/// assert_eq!(unknown_component(&["loads", "force_n", "3"]), Some((2, "x, y and z, or 0, 1 and 2")));
/// assert_eq!(unknown_component(&["loads", "force_n", "2"]), None);
/// ```
pub fn unknown_component<K: AsRef<str>>(path: &[K]) -> Option<(usize, &'static str)> {
    let path: Vec<&str> = path.iter().map(AsRef::as_ref).collect();
    let (_, numbers, rest) = numbers_of(&path)?;
    let names = numbers.shape.names();
    let is_unknown = !rest.is_empty() && !names.is_empty() && numbers.shape.place(rest).is_none();
    is_unknown.then_some((path.len() - rest.len(), names))
}

/// Unit of the number at a path, as in [`Parameter::unit`]; `None` if no key with numbers is there.
///
/// # Example
/// ```
/// use funicular::robot::parameters::unit;
///
/// assert_eq!(unit(&["loads", "force_n", "2"]), Some("N"));
/// assert_eq!(unit(&["wind", "velocity_m_s", "x"]), Some("m/s"));
/// assert_eq!(unit(&["name"]), None);
/// ```
pub fn unit<K: AsRef<str>>(path: &[K]) -> Option<&'static str> {
    let path: Vec<&str> = path.iter().map(AsRef::as_ref).collect();
    numbers_of(&path).map(|(_, numbers, _)| numbers.unit)
}

/// True for a key that may stand at the top of the file.
pub fn is_top_key(name: &str) -> bool {
    TABLES.iter().filter(|table| table.header == TOP).flat_map(|table| table.keys).any(|key| key.name == name)
}

/// True for a table at the top of the file that may be absent: `loads`, `required`, `clearance`, `wind` and `state`.
pub fn is_optional_table(name: &str) -> bool {
    let root = TABLES.iter().filter(|table| table.header == TOP).flat_map(|table| table.keys);
    root.into_iter()
        .any(|key| key.name == name && matches!(key.value, KeyValue::Table) && key.absent != Absent::Refused)
}

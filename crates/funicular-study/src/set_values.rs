//! Changes `PATH=VALUE` of the text of a robot file. They are made before the file is read, so that all checks of the
//! reader apply and its errors point at the changed line. A path may end at one number of an array:
//! `cables.1.anchor_m.z`, or by its index from 0, `cables.1.anchor_m.2`.

use crate::names::{listed, path_suggestion, suggestion};
use crate::request::Change;
use crate::values::is_short;
use funicular::robot::parameters::{self, ComponentOfKey, Parameter, Parameters};
use std::str::FromStr;
use thiserror::Error;
use toml_edit::{Decor, DocumentMut, Item, Key, Table, TableLike, Value};

/// Value and its place in the robot file.
#[derive(Debug, Clone)]
pub struct Assignment {
    /// Text as the user wrote it.
    text: String,
    /// Option that sets the value, between ⟪ and ⟫.
    option: &'static str,
    path: Vec<String>,
    value: Value,
}

impl Assignment {
    /// Text as the user wrote it.
    pub fn text(&self) -> &str {
        &self.text
    }
}

/// Name of the option that sets values, in messages.
const OPTION: &str = "⟪set⟫";

/// Error of a value that cannot be set: the value, the reason, and the existing names.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{0}")]
pub struct EditError(String);

type Result<T, E = EditError> = std::result::Result<T, E>;

macro_rules! bail {
    ($($format:tt)*) => { return Err(EditError(format!($($format)*))) };
}

/// Keys of a robot file, from its root to a value.
#[derive(Debug, Clone, PartialEq)]
pub struct ValuePath {
    /// Text as the user wrote it.
    pub text: String,
    keys: Vec<String>,
}

impl ValuePath {
    /// Unit of the number at this path; `None` if a robot file has no number there.
    pub fn unit(&self) -> Option<&'static str> {
        parameters::unit(&self.keys)
    }

    /// Keys from the root of the file to the value.
    pub(crate) fn keys(&self) -> &[String] {
        &self.keys
    }

    /// True for a path with `*`, which stands for any key.
    pub(crate) fn is_pattern(&self) -> bool {
        self.keys.iter().any(|key| key == ANY)
    }

    /// True for a value of `[state]`, which gives the pose.
    pub(crate) fn is_of_state(&self) -> bool {
        self.keys.first().is_some_and(|key| key == "state")
    }

    /// True if another path leads to the same value, for any quoting, and for names and indices of components.
    pub fn is_same(&self, other: &Self) -> bool {
        let place = |path: &Self| {
            let component = parameters::component(&path.keys);
            let of_key = path.keys.len() - component.map_or(0, |component| component.beyond_key);
            (path.keys[..of_key].to_vec(), component.map(|at| (at.row, at.column.unwrap_or(at.row))))
        };
        // An index of a vector has no column, and neither has the name of its component.
        place(self) == place(other)
    }

    /// Assignment of a number to the value at this path, requested by `option`.
    pub fn with(&self, option: &'static str, value: f64) -> Assignment {
        let text = format!("{}={value}", self.text);
        Assignment { text, option, path: self.keys.clone(), value: Value::from(value) }
    }
}

/// Key of a path that stands for any key.
pub(crate) const ANY: &str = "*";

/// Parses `path.to.key`: keys separated by dots, quoted if they hold anything except letters, digits, _ and -.
///
/// # Errors
/// A message for the user.
pub fn path(text: &str) -> Result<ValuePath, String> {
    // A star is a key of its own, which TOML would want in quotes.
    let quoted: Vec<&str> = text.trim().split('.').map(|part| if part == ANY { "'*'" } else { part }).collect();
    let keys = Key::parse(&quoted.join(".")).map_err(|_| {
        format!(
            "`{text}` is not a path: write keys separated by dots, quoted if they hold anything except letters, \
             digits, _ and -"
        )
    })?;
    Ok(ValuePath { text: text.trim().to_owned(), keys: keys.iter().map(|key| key.get().to_owned()).collect() })
}

/// Parses `path.to.key=value` of `--set`. The value is TOML; a bare word is a text.
///
/// # Errors
/// A message for the user.
///
/// # Example
/// ```
/// use funicular_study::set_values;
///
/// let change = set_values::assignment("platform.mass_kg=20")?;
/// let changed = set_values::apply("[platform]\nmass_kg = 1\n", &[change])?;
/// assert_eq!(changed, "[platform]\nmass_kg = 20 # set: platform.mass_kg=20\n");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn assignment(text: &str) -> Result<Assignment, String> {
    let (at, value) = split(text).ok_or("it has no `=`: write PATH=VALUE, as in platform.mass_kg=20")?;
    let path = path(at)?.keys;
    let value = value.trim();
    let value = match Value::from_str(value) {
        Ok(value) => value,
        // A shell removes the quotes of `"point-mass"`. A bare word can only be meant as text.
        Err(_) if is_word(value) => Value::from(value),
        Err(_) => return Err(format!("`{value}` is not a TOML value: a number, \"text\" or an [array]")),
    };
    Ok(Assignment { text: text.to_owned(), option: OPTION, path, value })
}

/// Change of a request from a text such as `platform.mass_kg=20`.
///
/// # Errors
/// A message that says what is wrong with the text.
pub fn change(text: &str) -> Result<Change, String> {
    let Assignment { value, .. } = assignment(text)?;
    let (path, _) = split(text).unwrap_or((text, ""));
    Ok(Change { path: path.trim().to_owned(), value: to_json(&value)? })
}

/// Assignment of a JSON value to a path.
///
/// # Errors
/// A text that is not a path, or a value that a robot file cannot hold.
pub fn of_json(at: &str, value: &serde_json::Value) -> Result<Assignment, String> {
    let value = from_json(value)?;
    let text = format!("{at}={}", value.to_string().trim());
    Ok(Assignment { text, option: OPTION, path: path(at)?.keys, value })
}

fn to_json(value: &Value) -> Result<serde_json::Value, String> {
    Ok(match value {
        Value::String(text) => text.value().as_str().into(),
        Value::Integer(number) => (*number.value()).into(),
        Value::Float(number) if number.value().is_finite() => (*number.value()).into(),
        Value::Float(number) => {
            return Err(format!("{} is not possible in a robot file: it must be finite", number.value()));
        }
        Value::Boolean(truth) => (*truth.value()).into(),
        Value::Array(items) => items.iter().map(to_json).collect::<Result<Vec<_>, _>>()?.into(),
        Value::Datetime(_) | Value::InlineTable(_) => {
            return Err("only a number, \"text\", true, false or an [array] can be set".to_owned());
        }
    })
}

/// TOML value of a JSON value.
///
/// # Errors
/// A value that a robot file cannot hold.
pub fn from_json(value: &serde_json::Value) -> Result<Value, String> {
    use serde_json::Value as Json;
    Ok(match value {
        Json::String(text) => Value::from(text.as_str()),
        Json::Bool(truth) => Value::from(*truth),
        Json::Number(number) => match (number.as_i64(), number.as_f64()) {
            (Some(whole), _) => Value::from(whole),
            (None, Some(number)) if is_short(number) => Value::from(number),
            // Without the exponent it would have hundreds of zeros.
            (None, Some(number)) => format!("{number:e}").parse().unwrap_or_else(|_| Value::from(number)),
            (None, None) => return Err(format!("{number} is out of the range of numbers in a robot file")),
        },
        Json::Array(items) => items.iter().map(from_json).collect::<Result<toml_edit::Array, _>>()?.into(),
        Json::Null | Json::Object(_) => {
            return Err("only a number, a text, a truth value or a list of these can be set".to_owned());
        }
    })
}

/// Parts of a text before and after the first `=` outside quotes.
pub fn split(text: &str) -> Option<(&str, &str)> {
    let mut quote = None;
    for (at, c) in text.char_indices() {
        match (quote, c) {
            (None, '=') => return Some((&text[..at], &text[at + 1..])),
            (None, '"' | '\'') => quote = Some(c),
            (Some(open), _) if c == open => quote = None,
            _ => {}
        }
    }
    None
}

fn is_word(value: &str) -> bool {
    value.starts_with(|c: char| c.is_alphabetic()) && value.chars().all(|c| c.is_alphanumeric() || c == '-' || c == '_')
}

/// Text of the robot file after all assignments, made in their order.
///
/// # Errors
/// [`EditError`] for a path that the file does not have.
pub fn apply(text: &str, assignments: &[Assignment]) -> Result<String> {
    // The reader has better messages for a file that is not TOML than this parser.
    let Ok(mut document) = text.trim_start_matches('\u{feff}').parse::<DocumentMut>() else {
        return Ok(text.to_owned());
    };
    for assignment in assignments {
        assign(&mut document, assignment)
            .map_err(|reason| EditError(format!("{} {}: {reason}", assignment.option, assignment.text)))?;
    }
    Ok(document.to_string())
}

fn assign(document: &mut DocumentMut, assignment: &Assignment) -> Result<()> {
    let path = &assignment.path;
    if let Some((count, names)) = parameters::unknown_component(path) {
        let (array, rest) = path.split_at(count);
        bail!("`{}` has the numbers {names}, and no `{}`", array.join("."), rest.join("."));
    }
    let component = parameters::component(path);
    let (to_key, rest) = path.split_at(path.len() - component.map_or(0, |component| component.beyond_key));
    let Some((key, parents)) = to_key.split_last() else { bail!("the path is empty") };
    if parents.is_empty() && !document.contains_key(key) && !parameters::is_top_key(key) {
        bail!("the robot file has no `{key}`{}", path_suggestion(key, &paths(document)));
    }

    // For a tip, found before the document is borrowed.
    let is_known = parents.first().is_none_or(|parent| document.contains_key(parent));
    let known = if is_known { Vec::new() } else { paths(document) };
    let tip = (!known.is_empty()).then(|| path_suggestion(&to_key.join("."), &known));

    let mut table: &mut dyn TableLike = document.as_table_mut();
    let mut parents = parents.iter();
    let mut walked: Vec<&str> = Vec::new();
    // A comment can follow only a value on its own line.
    let mut in_lines = true;
    while let Some(parent) = parents.next() {
        walked.push(parent);
        if walked.len() == 1 && table.get(parent).is_none() && parameters::is_optional_table(parent) {
            table.insert(parent, Item::Table(Table::new()));
        }
        let names: Vec<String> = table.iter().map(|(name, _)| name.to_owned()).collect();
        let Some(item) = table.get_mut(parent) else {
            let tip = tip.unwrap_or_else(|| suggestion(parent, &names));
            bail!("the robot file has no `{}`{tip}", walked.join("."))
        };
        in_lines &= !item.is_value();
        table = if walked == ["cables"] {
            let Some(name) = parents.next() else { bail!("name a cable and a key, as in cables.1.anchor_m=[0,0,4]") };
            walked.push(name);
            cable(item, name)?
        } else {
            match item.as_table_like_mut() {
                Some(inner) => inner,
                None => bail!("`{}` is a value and has no keys", walked.join(".")),
            }
        };
    }

    match component {
        None => put(table, key, in_lines, assignment, assignment.value.clone()),
        Some(component) => {
            let value = with_component(table.get(key), &component, key, &rest.join("."), &assignment.value)?;
            put(table, key, in_lines, assignment, value)
        }
    }
}

/// Paths of all numbers of a robot file; none if the reader refuses it.
fn paths(document: &DocumentMut) -> Vec<String> {
    let parameters = Parameters::from_toml(&document.to_string());
    parameters.map_or_else(|_| Vec::new(), |found| found.list().iter().map(Parameter::path).collect())
}

/// Array of a key with one number replaced.
fn with_component(
    item: Option<&Item>,
    component: &ComponentOfKey,
    key: &str,
    name: &str,
    number: &Value,
) -> Result<Value> {
    let mut array = match (item.map(Item::as_value), component.default) {
        (Some(Some(Value::Array(array))), _) => array.clone(),
        (None, Some(default)) => default.into_iter().collect(),
        (None, None) => {
            bail!("the robot file has no `{key}` there: give all its numbers, for example `{}`", component.example)
        }
        (Some(_), _) => bail!("`{key}` is not an array in the robot file and has no `{name}`"),
    };
    let ComponentOfKey { row, column, .. } = *component;
    let count = array.len();
    let Some(element) = array.get_mut(row) else { bail!("`{key}` has {count} elements and no `{name}`") };

    match (element.is_array(), column) {
        (true, None) => {
            bail!("`{name}` of `{key}` is a row of numbers: name one by row and column, as in `{row}.{row}`")
        }
        (true, Some(column)) => {
            for (row, column) in [(row, column), (column, row)] {
                let entry = array.get_mut(row).and_then(Value::as_array_mut).and_then(|row| row.get_mut(column));
                let Some(entry) = entry else { bail!("`{key}` has no `{name}` in the robot file") };
                replace(entry, number);
            }
        }
        (false, Some(column)) if column != row => {
            bail!("`{key}` has only the principal moments and no `{name}`: give three rows of three numbers")
        }
        _ => replace(element, number),
    }

    Ok(Value::Array(array))
}

/// Replaces a number and keeps the space around it.
fn replace(element: &mut Value, number: &Value) {
    let decor = element.decor().clone();
    *element = number.clone();
    *element.decor_mut() = decor;
}

/// Cable with a given name, in `[[cables]]` or `cables = [{ … }]`.
fn cable<'d>(item: &'d mut Item, name: &str) -> Result<&'d mut dyn TableLike> {
    let mut names = Vec::new();
    let tables: Vec<&mut dyn TableLike> = match item {
        Item::ArrayOfTables(tables) => tables.iter_mut().map(|table| table as &mut dyn TableLike).collect(),
        Item::Value(Value::Array(values)) => values
            .iter_mut()
            .filter_map(|value| value.as_inline_table_mut().map(|table| table as &mut dyn TableLike))
            .collect(),
        _ => bail!("`cables` is not a list of tables in the robot file"),
    };
    for table in tables {
        match table.get("name").and_then(Item::as_str) {
            Some(found) if found == name => return Ok(table),
            Some(other) => names.push(other.to_owned()),
            None => {}
        }
    }
    bail!("the robot file has no cable \"{name}\"{}", suggestion(name, &names))
}

fn put(table: &mut dyn TableLike, key: &str, in_lines: bool, assignment: &Assignment, mut value: Value) -> Result<()> {
    if in_lines {
        // An error shows this line, and the comment shows where the value comes from.
        let origin: String = assignment.text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        *value.decor_mut() = Decor::new(" ", format!(" # set: {origin}"));
    }
    match table.get_mut(key) {
        Some(item @ (Item::Table(_) | Item::ArrayOfTables(_))) => {
            let keys: Vec<String> = match item.as_table_like() {
                Some(inner) => inner.iter().map(|(name, _)| name.to_owned()).collect(),
                None => Vec::new(),
            };
            bail!("it names a table: set one of its values{}", listed(&keys))
        }
        Some(item) => *item = Item::Value(value),
        // The reader refuses an unknown key and suggests the nearest known key.
        None => drop(table.insert(key, Item::Value(value))),
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = "name = \"r\"\n[platform]\nmass_kg = 1 # light\n[[cables]]\nname = \"a.b\"\nx = 1\n";

    fn set(text: &str) -> Result<String> {
        apply(FILE, &[assignment(text).map_err(EditError)?])
    }

    #[test]
    fn a_changed_value_says_where_it_comes_from() {
        let changed = set("platform.mass_kg=20").unwrap();
        assert!(changed.contains("mass_kg = 20 # set: platform.mass_kg=20\n"), "{changed}");
    }

    #[test]
    fn cables_are_found_by_name_quoted_where_needed() {
        assert!(set("cables.\"a.b\".x=[1, 2]").unwrap().contains("x = [1, 2] # set:"));
        let error = set("cables.a.x=1").unwrap_err().to_string();
        assert!(error.contains("no cable \"a\"") && error.contains("a.b"), "{error}");
    }

    #[test]
    fn a_part_of_a_path_gives_a_tip() {
        let text = funicular_robots::COGIRO;
        let error = |change: &str| apply(text, &[assignment(change).unwrap()]).unwrap_err().to_string();
        assert_eq!(error("mass=75"), "⟪set⟫ mass=75: the robot file has no `mass`; did you mean `platform.mass_kg`?");
        assert!(error("robot.mass=75").contains("has no `robot`; did you mean `platform.mass_kg`?"));
        assert!(error("force=75").contains("did you mean `loads.force_n`?"));
        // A key at the top that the file leaves out is set.
        assert!(apply("name = 'a'\n", &[assignment("source=book").unwrap()]).unwrap().contains("source = \"book\""));
    }

    #[test]
    fn inline_cables_are_found_too() {
        let text = "cables = [{ name = \"1\", x = 1 }]";
        let changed = apply(text, &[assignment("cables.1.x=-2").unwrap()]).unwrap();
        assert_eq!(changed.trim_end(), "cables = [{ name = \"1\", x =-2 }]".replace("=-", "= -"));
    }

    #[test]
    fn a_bare_word_is_text_and_a_new_key_is_left_to_the_reader() {
        assert!(set("platform.motion=point-mass").unwrap().contains("motion = \"point-mass\""));
    }

    #[test]
    fn one_number_of_an_array_is_set_and_the_others_stay() {
        let file =
            "gravity_m_s2 = [0, 0, -10]\n[platform]\ninertia_kg_m2 = [[1, 2, 3], [2, 4, 5], [3, 5, 6]]\n[wind]\n";
        let set = |file: &str, text: &str| apply(file, &[assignment(text).unwrap()]).map_err(|error| error.to_string());
        assert!(
            set(file, "gravity_m_s2.z=-1.6")
                .unwrap()
                .contains("gravity_m_s2 = [0, 0, -1.6] # set: gravity_m_s2.z=-1.6\n")
        );
        assert!(set(file, "platform.inertia_kg_m2.xz=9").unwrap().contains("[[1, 2, 9], [2, 4, 5], [9, 5, 6]]"));
        // A vector that the file leaves out starts from its default.
        assert!(set(file, "platform.center_of_mass_m.x=0.1").unwrap().contains("center_of_mass_m = [0.1, 0.0, 0.0]"));
        assert!(set("", "gravity_m_s2.x=1").unwrap().contains("gravity_m_s2 = [1, 0.0, -9.81]"));

        // A table that may be absent is made.
        assert!(
            set("name = 'a'\n", "loads.force_n.z=-5").unwrap().contains("[loads]\nforce_n = [0.0, 0.0, -5] # set:")
        );
        assert!(set(file, "wind.velocity_m_s.x=3").unwrap().contains("velocity_m_s = [3, 0.0, 0.0]"));

        let error = set(file, "state.position_m.0=1").unwrap_err();
        assert!(error.contains("give all its numbers, for example `position_m = [0.0, 0.0, 1.0]`"), "{error}");
        assert!(
            set("[platform]\ninertia_kg_m2 = [1, 2, 3]", "platform.inertia_kg_m2.xy=1")
                .unwrap_err()
                .contains("principal")
        );
        assert!(set("gravity_m_s2 = 3", "gravity_m_s2.x=3").unwrap_err().contains("not an array"));
        assert!(set("gravity_m_s2 = []", "gravity_m_s2.x=3").unwrap_err().contains("0 elements"));
    }

    #[test]
    fn an_index_is_another_name_of_a_number() {
        let rows = "[platform]\ninertia_kg_m2 = [[1, 2, 3], [2, 4, 5], [3, 5, 6]]\n";
        let moments = "[platform]\ninertia_kg_m2 = [1, 2, 3]\n";
        let value = |text: &str| text.split(" # set").next().unwrap_or_default().to_owned();
        let set = |file: &str, text: &str| {
            apply(file, &[assignment(text).unwrap()]).map(|text| value(&text)).map_err(|error| error.to_string())
        };
        for (file, by_index, by_name) in [
            ("gravity_m_s2 = [0, 0, -10]\n", "gravity_m_s2.2", "gravity_m_s2.z"),
            ("", "loads.force_n.1", "loads.force_n.y"),
            ("[state]\nposition_m = [1, 2, 3]\n", "state.roll_pitch_yaw_deg.2", "state.roll_pitch_yaw_deg.yaw"),
            (moments, "platform.inertia_kg_m2.1", "platform.inertia_kg_m2.yy"),
            (moments, "platform.inertia_kg_m2.1.1", "platform.inertia_kg_m2.yy"),
            (rows, "platform.inertia_kg_m2.0.1", "platform.inertia_kg_m2.xy"),
            (rows, "platform.inertia_kg_m2.2.1", "platform.inertia_kg_m2.yz"),
        ] {
            let changed = set(file, &format!("{by_index}=7")).unwrap();
            assert_eq!(changed, set(file, &format!("{by_name}=7")).unwrap());
            assert!(changed.contains('7'), "{changed}");
            let is_same = |a: &str, b: &str| path(a).unwrap().is_same(&path(b).unwrap());
            assert!(is_same(by_index, by_name) && !is_same(by_index, "gravity_m_s2.x"));
        }

        let error = set(rows, "platform.inertia_kg_m2.1=7").unwrap_err();
        assert!(error.contains("`1` of `inertia_kg_m2` is a row of numbers: name one by row and column, as in `1.1`"));
        for (text, last) in [("gravity_m_s2.3=1", "3"), ("gravity_m_s2.-1=1", "-1"), ("gravity_m_s2.0.0=1", "0.0")] {
            let error = set("gravity_m_s2 = [0, 0, -10]\n", text).unwrap_err();
            let says = format!("`gravity_m_s2` has the numbers x, y and z, or 0, 1 and 2, and no `{last}`");
            assert!(error.contains(&says), "{error}");
        }
        let error = set("", "loads.force_n.w=1").unwrap_err();
        assert!(error.contains("`loads.force_n` has the numbers x, y and z"), "{error}");
    }

    #[test]
    fn what_cannot_be_set_is_refused() {
        for (text, reason) in [
            ("platform", "no `=`"),
            ("platform.=1", "not a path"),
            ("platform.mass_kg=", "not a TOML value"),
            ("platform.mass_kg=[1", "not a TOML value"),
            ("platfrom.mass_kg=1", "did you mean `platform`"),
            ("platform=1", "names a table"),
            ("cables=1", "names a table"),
            ("cables.x=1", "as in cables.1.anchor_m"),
            ("name.x=1", "is a value"),
        ] {
            let error = set(text).unwrap_err().to_string();
            assert!(error.contains(reason), "{text}: {error}");
        }
    }
}

//! Arguments that become keys of a request in JSON, by the readers that all arguments have.

use crate::arrays::{self, Count, Number, Numbers};
use crate::elements::Unusable;
use crate::errors;
use crate::labels::Names;
use crate::pose::{PoseLike, PyPose};
use crate::sweep;
use crate::texts::Texts;
use funicular_formats::number_columns;
use funicular_study::names::no_such;
use funicular_study::request::{self, Choice, Declared, Experiment, Key, Pose, ProgramForm, commands};
use funicular_study::wording::{Words, told};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyFloat, PyInt, PyList, PyMapping, PyString, PyTuple};
use serde_json::{Map, Value as Json, json};
use std::convert::Infallible;
use std::path::PathBuf;
use std::sync::LazyLock;
use std::{fs, io};

/// Kinds of the values of requests.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Number,
    /// Whole number from the first to the last.
    Count(u64, u64),
    Flag,
    Text,
    /// One of several names of such a thing.
    Name(&'static str, &'static [Choice]),
    /// One text or several, which are a list.
    Texts,
    /// One text, or a list of several.
    TextOrTexts,
    /// Three numbers x, y, z.
    Vector,
    /// Components xx, yy, zz, xy, xz, yz.
    Inertia,
    /// Minimum and maximum.
    Bounds,
    Row,
    OneOrRow,
    PerCable,
    OneOrPerCable,
    Pose,
    Poses,
    /// Columns by their names, or a CSV file with them.
    Columns,
    /// Columns of numbers with None in gaps.
    GappedColumns,
    /// First value, last value and their number.
    Masses,
    /// Axes with their values.
    Axes,
    /// Paths with deviations or tolerances.
    Sizes,
    /// Limits of quantities by their names.
    Limits,
    /// Points of the platform by their names.
    Points,
    /// Lists of events by their kinds, with tables in them.
    Scenario,
    /// Anything that JSON can hold.
    Any,
}

impl Kind {
    /// Kind of a declared key.
    fn of(key: &'static Key) -> Self {
        match &key.kind {
            request::Kind::Switch => Self::Flag,
            request::Kind::Number(_) => Self::Number,
            request::Kind::Count(range) => Self::Count(*range.start(), *range.end()),
            request::Kind::PerCable(_) => Self::PerCable,
            request::Kind::OneOrPerCable(_) => Self::OneOrPerCable,
            request::Kind::Vector => Self::Vector,
            request::Kind::Pose => Self::Pose,
            request::Kind::Poses => Self::Poses,
            request::Kind::Columns => Self::Columns,
            request::Kind::GappedColumns => Self::GappedColumns,
            request::Kind::Tensor => Self::Inertia,
            request::Kind::Name(what, choices) => Self::Name(what, choices),
            request::Kind::Text => Self::Text,
            request::Kind::Texts => Self::Texts,
            request::Kind::Sizes => Self::Sizes,
            request::Kind::Written(form) => match form {
                ProgramForm::Positive | ProgramForm::NotNegative => Self::Number,
                ProgramForm::MassRange => Self::Masses,
                ProgramForm::Band => Self::Bounds,
                _ => Self::Text,
            },
            request::Kind::List(form) | request::Kind::Commas(form) => match form {
                ProgramForm::GridAxis | ProgramForm::Side | ProgramForm::Variation => Self::Axes,
                ProgramForm::Positive => Self::Row,
                ProgramForm::NotNegative => Self::OneOrRow,
                ProgramForm::Fit | ProgramForm::Change | ProgramForm::Prior => Self::Any,
                ProgramForm::Bound => Self::Limits,
                ProgramForm::Point => Self::Points,
                _ => Self::Texts,
            },
            request::Kind::OneOrMore(_) => Self::TextOrTexts,
            request::Kind::Data(_) if key.name == "cables" => Self::Texts,
            request::Kind::Data(_) if key.name == "scenario" => Self::Scenario,
            request::Kind::Data(_) | request::Kind::ByCable(_) => Self::Any,
        }
    }

    /// Kind of a key of a command; of a part of a value, such as the bounds of a number, without a command.
    fn of_key(command: &str, name: &str) -> Self {
        static OF_EXPERIMENTS: LazyLock<Vec<Key>> = LazyLock::new(Experiment::keys);

        let command = commands().iter().find(|of| of.name == command);
        let declared = command.map_or(&[][..], |of| &of.keys).iter();
        let in_experiments = OF_EXPERIMENTS.iter().filter(|_| command.is_some_and(|of| of.name == "identify"));
        if let Some(key) = declared.chain(in_experiments).find(|key| key.name == name) {
            return Self::of(key);
        }
        match name {
            "minimum" | "maximum" | "prior" | "prior_std" | "plus_minus" => Self::Number,
            "count" => Self::Count(0, u64::MAX),
            "point_m" => Self::Vector,
            _ => Self::Any,
        }
    }

    /// Type of Python's keyword.
    fn python_type(self) -> &'static str {
        match self {
            Self::Number => "SupportsFloat | SupportsIndex",
            Self::Count(..) => "SupportsIndex",
            Self::Flag => "bool",
            Self::Text | Self::Name(..) => "str",
            Self::Texts | Self::TextOrTexts => "str | Sequence[str]",
            Self::Vector
            | Self::Inertia
            | Self::Bounds
            | Self::Row
            | Self::OneOrRow
            | Self::PerCable
            | Self::OneOrPerCable
            | Self::Poses => "ArrayLike",
            Self::Pose => "Pose | ArrayLike",
            Self::Masses => "tuple[SupportsFloat | SupportsIndex, SupportsFloat | SupportsIndex, SupportsIndex]",
            Self::Axes | Self::Points => "Mapping[str, ArrayLike]",
            Self::Limits => "Mapping[str, SupportsFloat | SupportsIndex]",
            Self::Columns | Self::GappedColumns => "str | PathLike[str] | Mapping[str, ArrayLike]",
            Self::Sizes | Self::Scenario | Self::Any => "Any",
        }
    }
}

/// Returns the declarations of all keywords as JSON: by commands, each key with its name, its type in Python, its
/// meaning, its default, what stands for it if it is not given, the heading under which it stands, and its names.
#[pyfunction]
pub(crate) fn declarations() -> String {
    let key = |key: &'static Key| {
        let (names, meanings) = match &key.kind {
            request::Kind::Name(_, choices) => {
                choices.iter().map(|of| (of.name, told(of.about, Words::Python))).unzip()
            }
            _ => (Vec::new(), Vec::new()),
        };
        json!({
            "name": key.name,
            "type": Kind::of(key).python_type(),
            "about": told(&key.about, Words::Python),
            "default": key.default,
            "otherwise": key.otherwise,
            "heading": key.heading,
            "required": key.required,
            "names": names,
            "meanings": meanings,
        })
    };
    let all = commands().iter().map(|of| (of.name.to_owned(), of.keys.iter().map(key).collect::<Json>()));
    Json::Object(all.collect()).to_string()
}

/// Reads the value of a key of a request, as JSON; `name` stands in errors, and `cables` are the names of the cables,
/// if there are any. For functions of the package that are written in Python.
#[pyfunction]
pub(crate) fn argument(
    command: &str,
    key: &str,
    name: &str,
    value: &Bound<'_, PyAny>,
    cables: Vec<String>,
) -> PyResult<String> {
    Ok(read(command, key, name, value, &cables)?.to_string())
}

/// Reads the value of a key of a command; `name` stands in errors.
pub(crate) fn read(
    command: &str,
    key: &str,
    name: &str,
    value: &Bound<'_, PyAny>,
    cables: &[String],
) -> PyResult<Json> {
    of_kind(Kind::of_key(command, key), name, value, cables)
}

fn of_kind(kind: Kind, name: &str, value: &Bound<'_, PyAny>, cables: &[String]) -> PyResult<Json> {
    let numbers = || {
        let Ok::<Numbers, Infallible>(numbers) = value.extract();
        numbers
    };
    Ok(match kind {
        Kind::Number => {
            let Ok::<Number, Infallible>(number) = value.extract();
            json!(number.finite(name)?)
        }
        Kind::Count(first, last) => {
            let Ok::<Count, Infallible>(count) = value.extract();
            let rule = match (first, last) {
                (0, u64::MAX) => "it must be zero or more".to_owned(),
                (_, u64::MAX) => format!("give a whole number from {first} on"),
                _ => format!("give a whole number from {first} to {last}"),
            };
            json!(count.within(name, first as usize..=last as usize, &rule)?)
        }
        Kind::Flag => json!(flag(name, value)?),
        Kind::Text => json!(text(name, value)?),
        Kind::Name(what, choices) => {
            let given = text(name, value)?;
            if !choices.iter().any(|choice| choice.name == given) {
                let names: Vec<String> = choices.iter().map(|choice| choice.name.to_owned()).collect();
                return Err(errors::input(format!("`{name}`: {}", no_such(what, &given, &names))));
            }
            json!(given)
        }
        Kind::Texts => {
            let Ok::<Texts, Infallible>(texts) = value.extract();
            json!(texts.not_empty(name)?)
        }
        Kind::TextOrTexts => {
            let Ok::<Texts, Infallible>(texts) = value.extract();
            match texts.one_or_several(name)? {
                (mut texts, true) => json!(texts.pop()),
                (texts, false) => json!(texts),
            }
        }
        Kind::Vector => json!(checked(name, &numbers().three(name)?)?),
        Kind::Inertia => {
            let names = Names::of_components(name, &["xx", "yy", "zz", "xy", "xz", "yz"]);
            json!(checked(name, &numbers().named_row(name, &names)?)?)
        }
        Kind::Bounds => json!(bounds(name, value)?),
        Kind::Row => json!(checked(name, &numbers().row(name)?)?),
        Kind::OneOrRow => json!(checked(name, &numbers().one_or_row(name)?.0)?),
        Kind::PerCable => json!(checked(name, &numbers().named_row(name, &Names::of_cables(cables, name))?)?),
        Kind::OneOrPerCable => json!(checked(name, &numbers().one_or_per_cable(name, cables)?)?),
        Kind::Pose => {
            let PoseLike(pose) = PoseLike::read(name, value)?;
            match &pose {
                Pose::Angles(numbers) => drop(checked(name, numbers)?),
                Pose::Quaternion(position, quaternion) => {
                    checked(name, position)?;
                    checked(name, quaternion)?;
                }
            }
            serde_json::to_value(pose).map_err(|error| errors::input(error.to_string()))?
        }
        Kind::Poses => {
            let poses = sweep::poses(numbers())?;
            for (i, pose) in poses.iter().enumerate() {
                checked(&format!("{name}[{i}]"), pose)?;
            }
            json!(poses)
        }
        Kind::Columns => columns(name, value, |shown, bytes| Ok(json!(number_columns::read(shown, bytes)?.columns)))?,
        Kind::GappedColumns => {
            columns(name, value, |shown, bytes| Ok(json!(number_columns::read_with_gaps(shown, bytes)?.columns)))?
        }
        Kind::Masses => json!(value.extract::<arrays::FirstLastCount>()?.masses(name, usize::MAX)?),
        // A request in JSON has a list of axes, of limits and of points.
        Kind::Axes | Kind::Limits | Kind::Points if value.cast::<PyList>().is_ok() => any(name, value, 0)?,
        Kind::Axes => {
            let axes = value.extract::<sweep::Axes>()?;
            serde_json::to_value(&axes.0).map_err(|error| errors::input(error.to_string()))?
        }
        Kind::Sizes => json!(sizes(name, value)?),
        Kind::Limits => limits(name, value)?,
        Kind::Points => points(name, value)?,
        Kind::Scenario => scenario(name, value)?,
        Kind::Any => any(name, value, 0)?,
    })
}

/// One text.
fn text(name: &str, value: &Bound<'_, PyAny>) -> PyResult<String> {
    match value.cast::<PyString>() {
        Ok(text) => Ok(text.to_str()?.to_owned()),
        Err(_) => Err(Unusable::value(value, "give text").named(name)),
    }
}

/// Truth value.
fn flag(name: &str, value: &Bound<'_, PyAny>) -> PyResult<bool> {
    value.extract().map_err(|_| Unusable::value(value, "give True or False").named(name))
}

/// Numbers that are all finite.
fn checked<'a>(name: &str, numbers: &'a [f64]) -> PyResult<&'a [f64]> {
    for (i, number) in numbers.iter().enumerate() {
        arrays::finite(&format!("{name}[{i}]"), *number)?;
    }
    Ok(numbers)
}

/// Minimum and maximum of an interval.
fn bounds(name: &str, value: &Bound<'_, PyAny>) -> PyResult<[f64; 2]> {
    let Ok::<Numbers, Infallible>(numbers) = value.extract();
    let row = numbers.named_row(name, &Names::of_bounds())?;
    let &[low, high] = checked(name, &row)? else {
        return Err(errors::input(format!("`{name}` has {} numbers: give minimum and maximum", row.len())));
    };
    Ok([low, high])
}

/// Reads one number; `name` stands in errors. For functions of the package that are written in Python.
#[pyfunction]
pub(crate) fn number(name: &str, value: &Bound<'_, PyAny>) -> PyResult<f64> {
    let Ok::<Number, Infallible>(number) = value.extract();
    number.finite(name)
}

/// Reads a row of numbers; `name` stands in errors. For functions of the package that are written in Python.
#[pyfunction]
pub(crate) fn numbers(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let Ok::<Numbers, Infallible>(numbers) = value.extract();
    let row = numbers.row(name)?;
    checked(name, &row)?;
    Ok(row)
}

/// Reads minimum and maximum of an interval; `name` stands in errors. For functions of the package that are written in
/// Python.
#[pyfunction]
pub(crate) fn interval(name: &str, value: &Bound<'_, PyAny>) -> PyResult<(f64, f64)> {
    let [low, high] = bounds(name, value)?;
    Ok((low, high))
}

/// Texts `PATH=VALUE` of a mapping, a series or texts.
pub(crate) fn sizes(name: &str, given: &Bound<'_, PyAny>) -> PyResult<Vec<String>> {
    if given.cast::<PyMapping>().is_ok() || is_series(given)? {
        let pair = |item: PyResult<Bound<'_, PyAny>>| {
            let (path, size): (Bound<'_, PyAny>, Bound<'_, PyAny>) = item?.extract()?;
            let Ok(path) = path.extract::<String>() else {
                return Err(Unusable::value(&path, "a path is text").named(name));
            };
            if let Ok(text) = size.cast::<PyString>() {
                return Ok(format!("{path}={}", text.to_str()?));
            }
            let Ok::<Number, Infallible>(number) = size.extract();
            Ok(format!("{path}={}", number.finite(&format!("{name}[\"{path}\"]"))?))
        };
        return given.call_method0("items")?.try_iter()?.map(pair).collect();
    }
    let Ok::<Texts, Infallible>(texts) = given.extract();
    texts.list(name).map_err(|_| {
        errors::input(format!(
            "`{name}` is no mapping from paths to numbers: give one, as in {{\"platform.mass_kg\": \"1%\"}}, or a list \
             of texts, as in [\"platform.mass_kg=1%\"]"
        ))
    })
}

/// Limits of a mapping from quantities to numbers.
fn limits(name: &str, given: &Bound<'_, PyAny>) -> PyResult<Json> {
    if given.cast::<PyMapping>().is_err() {
        let wanted = "give a mapping from quantities to numbers, as in {\"load-factor\": 1}";
        return Err(Unusable::value(given, wanted).named(name));
    }
    let limit = |item: PyResult<Bound<'_, PyAny>>| {
        let (quantity, value): (Bound<'_, PyAny>, Bound<'_, PyAny>) = item?.extract()?;
        let Ok(quantity) = quantity.extract::<String>() else {
            return Err(Unusable::value(&quantity, "the name of a quantity is text").named(name));
        };
        let Ok::<Number, Infallible>(number) = value.extract();
        let value = number.finite(&format!("{name}[\"{quantity}\"]"))?;
        Ok(json!({ "quantity": quantity, "value": value }))
    };
    given.call_method0("items")?.try_iter()?.map(limit).collect()
}

/// Points of a mapping from names to x, y, z.
fn points(name: &str, given: &Bound<'_, PyAny>) -> PyResult<Json> {
    if given.cast::<PyMapping>().is_err() {
        let wanted = "give a mapping from names to places, as in {\"hook\": [0, 0, -0.5]}";
        return Err(Unusable::value(given, wanted).named(name));
    }
    let point = |item: PyResult<Bound<'_, PyAny>>| {
        let (key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>) = item?.extract()?;
        let Ok(key) = key.extract::<String>() else {
            return Err(Unusable::value(&key, "the name of a point is text").named(name));
        };
        let place = of_kind(Kind::Vector, &format!("{name}[\"{key}\"]"), &value, &[])?;
        Ok(json!({ "name": key, "point_m": place }))
    };
    given.call_method0("items")?.try_iter()?.map(point).collect()
}

/// Lists of events by their kinds. A table in an event is read as any table; the study checks everything else.
fn scenario(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Json> {
    let Ok(kinds) = value.cast::<PyMapping>() else { return any(name, value, 0) };
    let mut all = Map::new();
    for item in kinds.items()?.iter() {
        let (kind, events): (Bound<'_, PyAny>, Bound<'_, PyAny>) = item.extract()?;
        let kind: String = kind.extract().map_err(|_| Unusable::value(&kind, "keys are text").named(name))?;
        let place = format!("{name}.{kind}");
        let is_list = events.is_instance_of::<PyList>() || events.is_instance_of::<PyTuple>();
        let read = if is_list {
            let each = events.try_iter()?.enumerate().map(|(i, event)| self::event(&format!("{place}[{i}]"), &event?));
            each.collect::<PyResult<Json>>()?
        } else {
            any(&place, &events, 1)?
        };
        all.insert(kind, read);
    }
    Ok(all.into())
}

/// Keys of one event.
fn event(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Json> {
    let Ok(keys) = value.cast::<PyMapping>() else { return any(name, value, 2) };
    let mut all = Map::new();
    for item in keys.items()?.iter() {
        let (key, of_key): (Bound<'_, PyAny>, Bound<'_, PyAny>) = item.extract()?;
        let key: String = key.extract().map_err(|_| Unusable::value(&key, "keys are text").named(name))?;
        let place = format!("{name}.{key}");
        let read = match &*key {
            "table" => of_kind(Kind::Columns, &place, &of_key, &[])?,
            _ if is_series(&of_key)? => any(&place, &of_key.call_method0("to_dict")?, 3)?,
            _ => any(&place, &of_key, 3)?,
        };
        all.insert(key, read);
    }
    Ok(all.into())
}

/// True for a series of pandas, which has names for its values as a mapping has.
fn is_series(value: &Bound<'_, PyAny>) -> PyResult<bool> {
    Ok(!value.hasattr("columns")? && value.hasattr("index")? && value.hasattr("items")?)
}

/// Columns of a file, of a mapping or of a data frame.
fn columns(name: &str, value: &Bound<'_, PyAny>, read: impl Fn(&str, &[u8]) -> anyhow::Result<Json>) -> PyResult<Json> {
    if let Ok(path) = value.extract::<PathBuf>() {
        let shown = path.display().to_string();
        let bytes =
            fs::read(&path).map_err(|error| io::Error::new(error.kind(), format!("cannot read {shown}: {error}")))?;
        return read(&shown, &bytes).map_err(|error| errors::study(&error));
    }
    if value.hasattr("columns")? && value.hasattr("to_dict")? {
        return any(name, &value.call_method1("to_dict", ("list",))?, 0);
    }
    if value.cast::<PyMapping>().is_err() {
        return Err(Unusable::value(value, "give a CSV file, or a mapping from names of columns to rows").named(name));
    }
    any(name, value, 0)
}

/// Any value that JSON can hold, also arrays and numbers of NumPy.
fn any(name: &str, value: &Bound<'_, PyAny>, depth: usize) -> PyResult<Json> {
    const MAX_DEPTH: usize = 32;
    if depth > MAX_DEPTH {
        return Err(errors::input(format!("`{name}` is nested more than {MAX_DEPTH} deep: no value of a request is")));
    }
    if value.is_none() {
        return Ok(Json::Null);
    }
    if let Ok(value) = value.cast::<PyBool>() {
        return Ok(value.is_true().into());
    }
    if let Ok(value) = value.cast::<PyString>() {
        return Ok(value.to_str()?.into());
    }
    if value.is_instance_of::<PyInt>() {
        let whole = value.extract::<i64>().map(Json::from);
        return whole.map_err(|_| Unusable::value(value, "no value of a request is so large").named(name));
    }
    if let Ok(number) = value.cast::<PyFloat>() {
        return Ok(arrays::finite(name, number.value())?.into());
    }
    if let Ok(pose) = value.cast::<PyPose>() {
        let pose = Pose::from(&pose.get().0);
        return serde_json::to_value(pose).map_err(|error| errors::input(error.to_string()));
    }
    if let Ok(mapping) = value.cast::<PyMapping>() {
        let mut all = Map::new();
        for item in mapping.items()?.iter() {
            let (key, of_key): (Bound<'_, PyAny>, Bound<'_, PyAny>) = item.extract()?;
            let key: String = key.extract().map_err(|_| Unusable::value(&key, "keys are text").named(name))?;
            let of_key = any(&format!("{name}.{key}"), &of_key, depth + 1)?;
            all.insert(key, of_key);
        }
        return Ok(all.into());
    }
    if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        let items = value.try_iter()?.enumerate().map(|(i, item)| any(&format!("{name}[{i}]"), &item?, depth + 1));
        return items.collect::<PyResult<Vec<_>>>().map(Json::Array);
    }
    if let Some(plain) = arrays::as_python(name, value, errors::input)? {
        return any(name, &plain, depth + 1);
    }
    Err(Unusable::value(value, "a request holds numbers, text, lists and mappings").named(name))
}

/// End of a message about an unknown word: the nearest known one, or all. For functions of the package that are written
/// in Python.
#[pyfunction]
pub(crate) fn suggested(word: &str, known: Vec<String>) -> String {
    funicular_study::names::suggestion(word, &known)
}

/// Unit that the end of a name tells, as the conventions for climate and forecast (CF) write it; empty for a name
/// without one.
#[pyfunction]
pub(crate) fn unit_of_name(name: &str) -> String {
    funicular_study::units::of_name(name).map_or_else(String::new, |unit| unit.text.replace('²', "2").replace('³', "3"))
}

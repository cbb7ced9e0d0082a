//! Arguments that become keys of a request in JSON, by the readers that all arguments have.

use crate::arrays::{self, Count, Number, Numbers};
use crate::elements::Unusable;
use crate::errors;
use crate::labels::Names;
use crate::pose::{PoseLike, PyPose};
use crate::sweep;
use crate::texts::Texts;
use funicular_study::request::Pose;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyFloat, PyInt, PyList, PyMapping, PyString, PyTuple};
use serde_json::{Map, Value as Json, json};
use std::convert::Infallible;

/// Kinds of the values of requests.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Number,
    Count,
    Flag,
    Text,
    /// One text or several.
    Texts,
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
    /// First value, last value and their number.
    Masses,
    /// Axes with their values.
    Axes,
    /// Paths with deviations or tolerances.
    Sizes,
    /// Anything that JSON can hold.
    Any,
}

/// Kind of the value of a key.
fn kind(command: &str, key: &str) -> Kind {
    match (command, key) {
        ("pose-error", "mass_kg") => return Kind::Masses,
        ("uncertainty", "at_hz") => return Kind::OneOrRow,
        ("new", "cables") => return Kind::Count,
        _ => {}
    }
    match key {
        "mass_kg"
        | "min_tension_n"
        | "max_tension_n"
        | "at_hz"
        | "below_hz"
        | "from_hz"
        | "to_hz"
        | "prominence_db"
        | "platform_share"
        | "tolerance"
        | "tolerance_mm"
        | "damping_at_hz"
        | "up_to_hz"
        | "min_frequency_hz"
        | "min_stiffness_n_per_m"
        | "response_noise"
        | "frequency_noise"
        | "damping_noise"
        | "axial_stiffness_n"
        | "mass_kg_per_m"
        | "youngs_modulus_pa"
        | "diameter_m"
        | "modes_below_hz"
        | "position_std_m"
        | "rotation_std_deg"
        | "tension_std_n"
        | "length_std_m"
        | "minimum"
        | "maximum"
        | "prior"
        | "prior_std"
        | "plus_minus" => Kind::Number,
        "points" | "stations" | "order" | "samples" | "seed" | "max_iterations" | "starts" | "segments" => Kind::Count,
        "hold_lengths_of_pose"
        | "all"
        | "friction_interval"
        | "in_plane_only"
        | "log"
        | "adaptive"
        | "damped"
        | "rigid_cables"
        | "platform" => Kind::Flag,
        "static_model" | "tension_rule" | "cable_model" | "assembly" | "winches" | "hold" | "per" | "method"
        | "goal" | "form" | "to" | "name" | "motion" | "rope" | "csv_unit" | "cable_set" | "path" => Kind::Text,
        "of" | "by" | "quantities" | "profile" | "cables" => Kind::Texts,
        "force_n" | "moment_n_m" | "load_point_m" | "wind_m_s" | "cable_load_n_per_m" | "input_point_m"
        | "output_point_m" | "payload_center_m" | "box_m" | "center_of_mass_m" | "point_m" => Kind::Vector,
        "inertia_kg_m2" => Kind::Inertia,
        "avoid_hz" => Kind::Bounds,
        "weights" => Kind::Row,
        "lengths_m" | "measured_lengths_m" | "measured_tensions_n" => Kind::PerCable,
        "target_tension_n" => Kind::OneOrPerCable,
        "pose" | "measured_pose" => Kind::Pose,
        "poses" => Kind::Poses,
        "grid" | "vary" => Kind::Axes,
        "deviations" | "tolerances" => Kind::Sizes,
        _ => Kind::Any,
    }
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
    Ok(of_kind(kind(command, key), name, value, &cables)?.to_string())
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
        Kind::Count => {
            let Ok::<Count, Infallible>(count) = value.extract();
            json!(count.within(name, 0..=usize::MAX, "it must be zero or more")?)
        }
        Kind::Flag => json!(flag(name, value)?),
        Kind::Text => match value.cast::<PyString>() {
            Ok(text) => json!(text.to_str()?),
            Err(_) => return Err(Unusable::value(value, "give text").named(name)),
        },
        Kind::Texts => {
            let Ok::<Texts, Infallible>(texts) = value.extract();
            json!(texts.list(name)?)
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
        Kind::Masses => json!(value.extract::<arrays::FirstLastCount>()?.masses(name, usize::MAX)?),
        Kind::Axes if value.cast::<PyMapping>().is_ok() => {
            let axes = value.extract::<sweep::Axes>()?;
            serde_json::to_value(&axes.0).map_err(|error| errors::input(error.to_string()))?
        }
        Kind::Sizes => json!(sizes(name, value)?),
        Kind::Axes | Kind::Any => any(name, value, 0)?,
    })
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

/// Reads minimum and maximum of an interval; `name` stands in errors. For functions of the package that are written in
/// Python.
#[pyfunction]
pub(crate) fn interval(name: &str, value: &Bound<'_, PyAny>) -> PyResult<(f64, f64)> {
    let [low, high] = bounds(name, value)?;
    Ok((low, high))
}

/// Texts `PATH=VALUE` of a mapping, a series or texts.
pub(crate) fn sizes(name: &str, given: &Bound<'_, PyAny>) -> PyResult<Vec<String>> {
    let is_series = !given.hasattr("columns")? && given.hasattr("index")? && given.hasattr("items")?;
    if given.cast::<PyMapping>().is_ok() || is_series {
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
            "`{name}` is no mapping from paths to numbers: give one, as in {{\"platform.mass_kg\": \"1%\"}}, or a list of \
             texts, as in [\"platform.mass_kg=1%\"]"
        ))
    })
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

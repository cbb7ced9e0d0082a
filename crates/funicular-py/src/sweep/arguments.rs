//! Arguments of a sweep, with the types that the `.pyi` names.

use crate::arrays::{ARRAY_LIKE, Count, Number, Numbers, finite};
use crate::errors;
use funicular_study::request::Axis;
use pyo3::inspect::{PyStaticExpr, PyStaticOperator};
use pyo3::prelude::*;
use pyo3::types::{PyMapping, PyTuple};

const ABC: PyStaticExpr = PyStaticExpr::Name { id: "collections.abc" };
const CALLABLE: PyStaticExpr = PyStaticExpr::Attribute { value: &ABC, attr: "Callable" };
const EXECUTOR: PyStaticExpr =
    PyStaticExpr::Attribute { value: &PyStaticExpr::Name { id: "concurrent.futures" }, attr: "Executor" };

/// Values along axes by name, in the given order.
pub(crate) struct Axes(pub(crate) Vec<Axis>);

impl<'a, 'py> FromPyObject<'a, 'py> for Axes {
    type Error = PyErr;

    const INPUT_TYPE: PyStaticExpr = PyStaticExpr::Subscript {
        value: &PyStaticExpr::Attribute { value: &ABC, attr: "Mapping" },
        slice: &PyStaticExpr::Tuple { elts: &[PyStaticExpr::Name { id: "str" }, ARRAY_LIKE] },
    };

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        let Ok(axes) = object.cast::<PyMapping>() else {
            let kind = object.get_type().name()?.to_string();
            return Err(errors::input(format!(
                "the axes are of type {kind}: give a mapping from their names to values, as in {{\"x\": (-4, 4, 81), \
                 \"z\": [0.5, 1]}}"
            )));
        };
        let axes = axes.items()?;
        let axes: PyResult<_> = axes
            .iter()
            .map(|axis| {
                let (name, values): (Bound<'_, PyAny>, Bound<'_, PyAny>) = axis.extract()?;
                let Ok(name) = name.extract::<String>() else {
                    return Err(errors::input(format!("the name of an axis is {name}: names are text")));
                };
                self::axis(name, &values)
            })
            .collect();
        Ok(Self(axes?))
    }
}

/// Axis from a tuple of first value, last value and their number, or from values.
fn axis(name: String, values: &Bound<'_, PyAny>) -> PyResult<Axis> {
    if let Ok(tuple) = values.cast::<PyTuple>()
        && tuple.len() == 3
    {
        let third = format!("{name}[2]");
        let rule = "the third of a tuple is the number of values, 2 or more; give a list for values";
        let count = tuple.get_item(2)?.extract::<Count>()?.within(&third, 2..=usize::MAX, rule)?;
        let end = |place: usize| tuple.get_item(place)?.extract::<Number>()?.finite(&format!("{name}[{place}]"));
        return Ok(Axis::Range { from: end(0)?, to: end(1)?, count, axis: name });
    }
    let (values, _) = values.extract::<Numbers>()?.one_or_row(&name)?;
    for (i, value) in values.iter().enumerate() {
        finite(&format!("{name}[{i}]"), *value)?;
    }
    Ok(Axis::List { axis: name, values })
}

/// Executor, or a function that makes one.
pub(crate) struct ExecutorArgument(pub(crate) Py<PyAny>);

impl<'py> FromPyObject<'_, 'py> for ExecutorArgument {
    type Error = PyErr;

    const INPUT_TYPE: PyStaticExpr = PyStaticExpr::BinOp {
        left: &EXECUTOR,
        op: PyStaticOperator::BitOr,
        right: &PyStaticExpr::Subscript {
            value: &CALLABLE,
            slice: &PyStaticExpr::Tuple { elts: &[PyStaticExpr::List { elts: &[] }, EXECUTOR] },
        },
    };

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if !object.hasattr("submit")? && !object.is_callable() {
            let kind = object.get_type().name()?.to_string();
            return Err(errors::input(format!(
                "`executor` is a {kind}: give an executor of concurrent.futures, or a function that makes one"
            )));
        }
        Ok(Self(object.to_owned().unbind()))
    }
}

/// Function that is called with the progress.
pub(crate) struct ProgressArgument(pub(crate) Py<PyAny>);

impl<'py> FromPyObject<'_, 'py> for ProgressArgument {
    type Error = PyErr;

    const INPUT_TYPE: PyStaticExpr = PyStaticExpr::Subscript {
        value: &CALLABLE,
        slice: &PyStaticExpr::Tuple {
            elts: &[
                PyStaticExpr::List { elts: &[PyStaticExpr::Name { id: "int" }, PyStaticExpr::Name { id: "int" }] },
                PyStaticExpr::Name { id: "object" },
            ],
        },
    };

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if !object.is_callable() {
            return Err(errors::input(
                "`progress` is no function: give one that takes the number of finished rows and of all rows".to_owned(),
            ));
        }
        Ok(Self(object.to_owned().unbind()))
    }
}

/// Position [m] and roll, pitch, yaw [degrees], which are zero if not given.
fn six(what: &str, row: &[f64]) -> PyResult<[f64; 6]> {
    match *row {
        [x, y, z] => Ok([x, y, z, 0.0, 0.0, 0.0]),
        [x, y, z, roll, pitch, yaw] => Ok([x, y, z, roll, pitch, yaw]),
        _ => Err(errors::input(format!(
            "`{what}` has {} numbers: give x, y, z [m], or these and roll, pitch, yaw [degrees]",
            row.len()
        ))),
    }
}

/// Poses from an array with one row per pose.
pub(crate) fn poses(numbers: Numbers) -> PyResult<Vec<[f64; 6]>> {
    let (flat, columns) = numbers.poses("poses")?;
    if columns == 0 {
        return six("poses", &[]).map(|_| Vec::new());
    }
    flat.chunks_exact(columns).map(|row| six("poses", row)).collect()
}

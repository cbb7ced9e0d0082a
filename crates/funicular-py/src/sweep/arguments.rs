//! What Python hands to a sweep, with the types that the `.pyi` names.

use super::plan::{PointsAsked, Request, StepsAsked};
use crate::arrays::{ARRAY_LIKE, Count, Number, Numbers, finite};
use crate::errors;
use crate::request::{Given, Options};
use funicular::statics::TensionRule;
use pyo3::inspect::{PyStaticExpr, PyStaticOperator};
use pyo3::prelude::*;
use pyo3::types::{PyMapping, PyTuple};

const ABC: PyStaticExpr = PyStaticExpr::Name { id: "collections.abc" };
const CALLABLE: PyStaticExpr = PyStaticExpr::Attribute { value: &ABC, attr: "Callable" };
const EXECUTOR: PyStaticExpr =
    PyStaticExpr::Attribute { value: &PyStaticExpr::Name { id: "concurrent.futures" }, attr: "Executor" };

/// Values along axes, by name, in the order given.
pub(crate) struct Axes(pub(crate) Vec<(String, StepsAsked)>);

impl<'a, 'py> FromPyObject<'a, 'py> for Axes {
    type Error = PyErr;

    const INPUT_TYPE: PyStaticExpr = PyStaticExpr::Subscript {
        value: &PyStaticExpr::Attribute { value: &ABC, attr: "Mapping" },
        slice: &PyStaticExpr::Tuple { elts: &[PyStaticExpr::Name { id: "str" }, ARRAY_LIKE] },
    };

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        let axes = object.cast::<PyMapping>()?.items()?;
        let axes: PyResult<_> = axes
            .iter()
            .map(|axis| {
                let (name, values): (String, Bound<'_, PyAny>) = axis.extract()?;
                let steps = steps(&name, &values)?;
                Ok((name, steps))
            })
            .collect();
        Ok(Self(axes?))
    }
}

/// A tuple of first, last and how many; else values.
fn steps(name: &str, values: &Bound<'_, PyAny>) -> PyResult<StepsAsked> {
    if let Ok(tuple) = values.cast::<PyTuple>()
        && tuple.len() == 3
    {
        let third = format!("{name}[2]");
        let rule = "the third of a tuple is how many values there are, 2 or more; give a list for values";
        let count = tuple.get_item(2)?.extract::<Count>()?.within(&third, 2..=usize::MAX, rule)?;
        let end = |place: usize| tuple.get_item(place)?.extract::<Number>()?.finite(&format!("{name}[{place}]"));
        return Ok(StepsAsked::Range { from: end(0)?, to: end(1)?, count });
    }
    let (values, _) = values.extract::<Numbers>()?.one_or_row(name)?;
    if values.is_empty() {
        return Err(errors::input(format!("`{name}` has no values: give (first, last, how many), or values")));
    }
    values.iter().try_for_each(|value| finite(name, *value).map(drop))?;
    Ok(StepsAsked::List { values })
}

/// An executor, or what makes one.
pub(crate) struct Makes(pub(crate) Py<PyAny>);

impl<'py> FromPyObject<'_, 'py> for Makes {
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

/// Who is told of the progress.
pub(crate) struct Told(pub(crate) Py<PyAny>);

impl<'py> FromPyObject<'_, 'py> for Told {
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
                "`progress` is no function: it is called with rows done and all rows".to_owned(),
            ));
        }
        Ok(Self(object.to_owned().unbind()))
    }
}

/// All but points and state, as Python gives it.
pub(crate) struct Settings<'a> {
    pub(crate) quantities: Option<Vec<String>>,
    pub(crate) statics: Given<'a>,
    pub(crate) cable_model: Option<&'a str>,
    pub(crate) assembly: &'a str,
    pub(crate) in_plane_only: bool,
    pub(crate) up_to_hz: Number,
    pub(crate) pose: Option<Numbers>,
    pub(crate) lengths: Option<Numbers>,
}

impl Settings<'_> {
    /// With points; not yet checked against a robot.
    pub(crate) fn request(self, points: PointsAsked) -> PyResult<Request> {
        let statics = Options::read(self.statics)?;
        let wanted_tension_n = match &statics.rule {
            Some(TensionRule::Closest(wanted)) => Some(wanted.clone()),
            _ => None,
        };
        let pose = self.pose.map(|pose| pose.row("pose").and_then(|row| six("pose", &row))).transpose()?;
        let lengths = self.lengths.map(|lengths| lengths.row("lengths")).transpose()?;
        for length in lengths.iter().flatten() {
            finite("lengths", *length)?;
        }
        Ok(Request {
            points,
            quantities: self.quantities.unwrap_or_else(|| vec!["tension-min".to_owned(), "tension-max".to_owned()]),
            model: statics.model.name().to_owned(),
            tension_rule: statics.rule.map(|rule| rule.name().to_owned()),
            wanted_tension_n,
            min_tension_n: statics.limits.minimum,
            max_tension_n: statics.limits.maximum,
            force_n: statics.force_n,
            moment_n_m: statics.moment_n_m,
            load_point_m: statics.load_point_m,
            cable_model: self.cable_model.map(str::to_owned),
            assembly: self.assembly.to_owned(),
            in_plane_only: self.in_plane_only,
            up_to_hz: self.up_to_hz.positive("up_to_hz")?,
            pose,
            lengths,
        })
    }
}

/// Position [m] and roll, pitch, yaw [degrees]; these are zero if they are not given.
fn six(what: &str, row: &[f64]) -> PyResult<[f64; 6]> {
    row.iter().try_for_each(|value| finite(what, *value).map(drop))?;
    match *row {
        [x, y, z] => Ok([x, y, z, 0.0, 0.0, 0.0]),
        [x, y, z, roll, pitch, yaw] => Ok([x, y, z, roll, pitch, yaw]),
        _ => Err(errors::input(format!(
            "`{what}` has {} numbers: give x, y, z [m], or these and roll, pitch, yaw [degrees]",
            row.len()
        ))),
    }
}

/// Poses in rows.
pub(crate) fn poses(numbers: Numbers) -> PyResult<Vec<[f64; 6]>> {
    let (flat, columns) = numbers.rows("poses")?;
    if columns == 0 {
        return six("poses", &[]).map(|_| Vec::new());
    }
    flat.chunks_exact(columns).map(|row| six("poses", row)).collect()
}

//! Texts as arguments: one text, or several.

use crate::elements::{Unusable, has_method};
use crate::errors;
use pyo3::inspect::{PyStaticExpr, PyStaticOperator};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyMapping, PyString};
use std::convert::Infallible;

/// One text, or several in a list, tuple, array or series. An error is raised when they are read with the name of their
/// argument.
pub(crate) struct Texts(Result<(Vec<String>, bool), Unusable>);

impl<'py> FromPyObject<'_, 'py> for Texts {
    type Error = Infallible;

    const INPUT_TYPE: PyStaticExpr = PyStaticExpr::BinOp {
        left: &PyStaticExpr::Name { id: "str" },
        op: PyStaticOperator::BitOr,
        right: &PyStaticExpr::Subscript {
            value: &PyStaticExpr::Attribute { value: &PyStaticExpr::Name { id: "collections.abc" }, attr: "Sequence" },
            slice: &PyStaticExpr::Name { id: "str" },
        },
    };

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> Result<Self, Infallible> {
        Ok(Self(texts(&object)))
    }
}

/// Texts of an object; the flag is true for one text.
fn texts(object: &Bound<'_, PyAny>) -> Result<(Vec<String>, bool), Unusable> {
    const WANTED: &str = "give text, or a list of texts";
    if let Ok(text) = object.cast::<PyString>() {
        return Ok((vec![text.to_str()?.to_owned()], true));
    }
    // Tables and mappings give the names of their columns or keys.
    let is_other =
        object.is_instance_of::<PyBytes>() || object.cast::<PyMapping>().is_ok() || has_method(object, "columns")?;
    let Some(items) = (!is_other).then(|| object.try_iter().ok()).flatten() else {
        return Err(Unusable::value(object, WANTED));
    };
    let mut all = Vec::new();
    for (i, item) in items.enumerate() {
        let item = item?;
        let Ok(text) = item.cast::<PyString>() else {
            return Err(Unusable::value(&item, "give text").at(&format!("[{i}]")));
        };
        all.push(text.to_str()?.to_owned());
    }
    Ok((all, false))
}

impl Texts {
    /// All texts; there may be none.
    pub(crate) fn list(self, what: &str) -> PyResult<Vec<String>> {
        Ok(self.one_or_several(what)?.0)
    }

    /// All texts; the flag is true for one text that stands alone.
    pub(crate) fn one_or_several(self, what: &str) -> PyResult<(Vec<String>, bool)> {
        self.0.map_err(|error| error.named(what))
    }

    /// All texts, at least one: an empty list is neither all nor nothing.
    pub(crate) fn not_empty(self, what: &str) -> PyResult<Vec<String>> {
        let all = self.list(what)?;
        if all.is_empty() {
            return Err(errors::input(format!("`{what}` is an empty list: name at least one, or leave it out")));
        }
        Ok(all)
    }
}

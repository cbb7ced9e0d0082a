//! NumPy arrays in and out, with the types that the `.pyi` names. An array that goes out owns what it was made of.

use crate::errors;
use numpy::ndarray::{Array, ArrayD, Dimension, Ix1, Ix2, Ix3};
use numpy::{Complex64, Element, IntoPyArray, PyArray, PyArrayDyn, PyArrayMethods};
use pyo3::inspect::PyStaticExpr;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::convert::Infallible;

/// An item of NumPy's module of types.
const fn typing(name: &'static str) -> PyStaticExpr {
    PyStaticExpr::Attribute { value: &PyStaticExpr::Name { id: "numpy.typing" }, attr: name }
}

/// Numbers in anything that NumPy makes an array of.
pub(crate) const ARRAY_LIKE: PyStaticExpr = typing("ArrayLike");

/// What an element is called in NumPy.
pub(crate) trait Named: Element {
    const NAME: &'static str;
}

impl Named for f64 {
    const NAME: &'static str = "float64";
}

impl Named for Complex64 {
    const NAME: &'static str = "complex128";
}

impl Named for bool {
    const NAME: &'static str = "bool_";
}

impl Named for i64 {
    const NAME: &'static str = "int64";
}

/// An array on its way to Python, without a copy.
pub(crate) struct Out<T, D>(pub(crate) Array<T, D>);

impl<'py, T: Named, D: Dimension> IntoPyObject<'py> for Out<T, D> {
    type Target = PyArray<T, D>;
    type Output = Bound<'py, Self::Target>;
    type Error = Infallible;

    const OUTPUT_TYPE: PyStaticExpr = PyStaticExpr::Subscript {
        value: &typing("NDArray"),
        slice: &PyStaticExpr::Attribute { value: &PyStaticExpr::Name { id: "numpy" }, attr: T::NAME },
    };

    fn into_pyobject(self, py: Python<'py>) -> Result<Self::Output, Self::Error> {
        Ok(self.0.into_pyarray(py))
    }
}

/// One row.
pub(crate) type Vector<T = f64> = Out<T, Ix1>;
/// Rows of equal length.
pub(crate) type Matrix<T = f64> = Out<T, Ix2>;
/// Matrices one after the other.
pub(crate) type Tensor<T = f64> = Out<T, Ix3>;

impl<T> FromIterator<T> for Vector<T> {
    fn from_iter<I: IntoIterator<Item = T>>(items: I) -> Self {
        Self(items.into_iter().collect())
    }
}

impl<T> Matrix<T> {
    /// Of its rows one after the other, each of `columns` numbers.
    pub(crate) fn of_rows(flat: Vec<T>, columns: usize) -> Self {
        let rows = flat.len() / columns.max(1);
        Self(Array::from_shape_vec((rows, columns), flat).expect("whole rows"))
    }
}

impl<T> Tensor<T> {
    /// Of 6×6 matrices, each column by column, without a copy: the array has the rows and columns where they are.
    pub(crate) fn of_six(matrices: Vec<[[T; 6]; 6]>) -> Self {
        let count = matrices.len();
        let flat = matrices.into_flattened().into_flattened();
        let columns = Array::from_shape_vec((count, 6, 6), flat).expect("whole matrices");
        Self(columns.permuted_axes([0, 2, 1]))
    }

    /// Of its matrices one after the other, each row by row.
    pub(crate) fn of_rows(flat: Vec<T>, rows: usize, columns: usize) -> Self {
        let count = flat.len() / (rows * columns).max(1);
        Self(Array::from_shape_vec((count, rows, columns), flat).expect("whole matrices"))
    }
}

/// What a pickle is made of: a function and its arguments.
pub(crate) type Reduced<'py, T> = (Bound<'py, PyAny>, T);

/// A dictionary with text as keys, in or out.
pub(crate) struct Keyed<'py>(pub(crate) Bound<'py, PyDict>);

const KEYED: PyStaticExpr = PyStaticExpr::Subscript {
    value: &PyStaticExpr::Name { id: "dict" },
    slice: &PyStaticExpr::Tuple {
        elts: &[
            PyStaticExpr::Name { id: "str" },
            PyStaticExpr::Attribute { value: &PyStaticExpr::Name { id: "typing" }, attr: "Any" },
        ],
    },
};

impl<'py> IntoPyObject<'py> for Keyed<'py> {
    type Target = PyDict;
    type Output = Bound<'py, PyDict>;
    type Error = Infallible;

    const OUTPUT_TYPE: PyStaticExpr = KEYED;

    fn into_pyobject(self, _: Python<'py>) -> Result<Self::Output, Self::Error> {
        Ok(self.0)
    }
}

impl<'py> FromPyObject<'_, 'py> for Keyed<'py> {
    type Error = PyErr;

    const INPUT_TYPE: PyStaticExpr = KEYED;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        Ok(Self(object.to_owned().cast_into::<PyDict>()?))
    }
}

/// One row of complex numbers from Python.
pub(crate) struct ComplexRow(pub(crate) Vec<Complex64>);

impl<'a, 'py> FromPyObject<'a, 'py> for ComplexRow {
    type Error = PyErr;

    const INPUT_TYPE: PyStaticExpr = ARRAY_LIKE;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        let array = object.py().import("numpy")?.call_method1("asarray", (object, "complex128"))?;
        let array = array.cast_into::<PyArrayDyn<Complex64>>()?;
        let array = array.try_readonly()?;
        match array.as_array().ndim() {
            1 => Ok(Self(array.as_array().iter().copied().collect())),
            other => Err(errors::input(format!("the response has {other} dimensions: give one row of numbers"))),
        }
    }
}

/// Numbers from Python, of any shape.
pub(crate) struct Numbers(pub(crate) ArrayD<f64>);

impl<'a, 'py> FromPyObject<'a, 'py> for Numbers {
    type Error = PyErr;

    const INPUT_TYPE: PyStaticExpr = ARRAY_LIKE;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        let owned = |array: &Bound<'py, PyArrayDyn<f64>>| Ok(Self(array.try_readonly()?.as_array().to_owned()));
        if let Ok(array) = object.cast::<PyArrayDyn<f64>>() {
            return owned(&array);
        }
        let array = object.py().import("numpy")?.call_method1("asarray", (object, "float64"))?;
        owned(&array.cast_into::<PyArrayDyn<f64>>()?)
    }
}

impl Numbers {
    /// One row of numbers.
    pub(crate) fn row(self, what: &str) -> PyResult<Vec<f64>> {
        if self.0.ndim() != 1 {
            return Err(errors::input(format!("`{what}` has {} dimensions: give one row of numbers", self.0.ndim())));
        }
        Ok(self.0.iter().copied().collect())
    }

    /// Three numbers, finite.
    pub(crate) fn three(self, what: &str) -> PyResult<[f64; 3]> {
        let row = self.row(what)?;
        let [x, y, z] = row[..] else {
            return Err(errors::input(format!("`{what}` has {} numbers where x, y, z are needed", row.len())));
        };
        for value in [x, y, z] {
            finite(what, value)?;
        }
        Ok([x, y, z])
    }

    /// Rows of numbers, with their length.
    pub(crate) fn rows(self, what: &str) -> PyResult<(Vec<f64>, usize)> {
        let [_, columns] = *self.0.shape() else {
            let dimensions = self.0.ndim();
            return Err(errors::input(format!(
                "`{what}` has {dimensions} dimensions: give an array of rows, one a state"
            )));
        };
        Ok((self.0.iter().copied().collect(), columns))
    }

    /// Frequencies, one or a row of them.
    pub(crate) fn frequencies(self) -> PyResult<(Vec<f64>, bool)> {
        let one = self.0.ndim() == 0;
        let frequencies = if one { self.0.iter().copied().collect() } else { self.row("hz")? };
        for &hz in &frequencies {
            not_negative("hz", hz)?;
        }
        Ok((frequencies, one))
    }
}

/// Largest magnitude of a number, as in robot files.
const LARGEST: f64 = 1e12;
/// Smallest quantity that has to be positive, as in robot files.
const SMALLEST: f64 = 1e-12;

/// Says what is wrong with what is no number to compute with.
pub(crate) fn magnitude(what: &str, value: f64) -> Result<f64, String> {
    if value.abs() <= LARGEST {
        Ok(value)
    } else if value.is_finite() {
        Err(format!("{what} is {value:e}: it must be at most {LARGEST:e} in magnitude"))
    } else {
        Err(format!("{what} is {value}: it must be finite"))
    }
}

/// Refuses what is no number to compute with.
pub(crate) fn finite(what: &str, value: f64) -> PyResult<f64> {
    // Arrays are long: a text is made of what is wrong alone.
    if value.abs() <= LARGEST { Ok(value) } else { magnitude(&format!("`{what}`"), value).map_err(errors::input) }
}

/// Refuses negative numbers, too.
pub(crate) fn not_negative(what: &str, value: f64) -> PyResult<f64> {
    if finite(what, value)? < 0.0 {
        return Err(errors::input(format!("`{what}` is {value}: it must not be negative")));
    }
    Ok(value)
}

/// Refuses zero, too.
pub(crate) fn positive(what: &str, value: f64) -> PyResult<f64> {
    if finite(what, value)? < SMALLEST {
        return Err(errors::input(format!("`{what}` is {value}: it must be positive, at least {SMALLEST:e}")));
    }
    Ok(value)
}

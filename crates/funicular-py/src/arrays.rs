//! NumPy arrays as arguments and results, with the types that the `.pyi` names. A returned array owns its numbers.

use crate::elements::{ElementName, Unusable, check_mask, check_type, has_method, is_number_like, read};
use crate::errors;
use crate::labels::{LabelledNumbers, Names};
use funicular::math::Vec3;
use funicular_study::values;
use numpy::ndarray::{Array, ArrayD, Dimension, Ix1, Ix2, Ix3, IxDyn};
use numpy::{Complex64, IntoPyArray, PyArray, PyUntypedArray};
use pyo3::inspect::PyStaticExpr;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyList, PyString, PyTuple};
use std::convert::Infallible;
use std::ops::RangeInclusive;

/// Name in the module `numpy.typing`.
const fn typing(name: &'static str) -> PyStaticExpr {
    PyStaticExpr::Attribute { value: &PyStaticExpr::Name { id: "numpy.typing" }, attr: name }
}

/// Type of every argument that NumPy can convert to an array.
pub(crate) const ARRAY_LIKE: PyStaticExpr = typing("ArrayLike");

/// Array that is handed to Python without a copy.
pub(crate) struct OwnedArray<T, D>(pub(crate) Array<T, D>);

impl<'py, T: ElementName, D: Dimension> IntoPyObject<'py> for OwnedArray<T, D> {
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
pub(crate) type Vector<T = f64> = OwnedArray<T, Ix1>;
/// Rows of equal length.
pub(crate) type Matrix<T = f64> = OwnedArray<T, Ix2>;
/// Matrices in sequence.
pub(crate) type Tensor<T = f64> = OwnedArray<T, Ix3>;

impl<T> FromIterator<T> for Vector<T> {
    fn from_iter<I: IntoIterator<Item = T>>(items: I) -> Self {
        Self(items.into_iter().collect())
    }
}

impl<T> Matrix<T> {
    /// Makes a matrix from its rows in sequence, each with `columns` numbers.
    pub(crate) fn of_rows(flat: Vec<T>, columns: usize) -> Self {
        let rows = flat.len() / columns.max(1);
        Self(Array::from_shape_vec((rows, columns), flat).expect("whole rows"))
    }
}

impl Matrix {
    /// Makes a matrix with one point per row.
    pub(crate) fn of_points(points: impl Iterator<Item = Vec3>) -> Self {
        Self::of_rows(points.flat_map(<[f64; 3]>::from).collect(), 3)
    }
}

impl<T> Tensor<T> {
    /// Makes an array of 6×6 matrices, each stored by columns, without a copy: its strides name rows and columns.
    pub(crate) fn of_six(matrices: Vec<[[T; 6]; 6]>) -> Self {
        let count = matrices.len();
        let flat = matrices.into_flattened().into_flattened();
        let columns = Array::from_shape_vec((count, 6, 6), flat).expect("whole matrices");
        Self(columns.permuted_axes([0, 2, 1]))
    }

    /// Makes an array of matrices in sequence, each stored by rows.
    pub(crate) fn of_rows(flat: Vec<T>, rows: usize, columns: usize) -> Self {
        let count = flat.len() / (rows * columns).max(1);
        Self(Array::from_shape_vec((count, rows, columns), flat).expect("whole matrices"))
    }
}

/// Content of a pickle: a function and its arguments.
pub(crate) type PickleParts<'py, T> = (Bound<'py, PyAny>, T);

/// Dictionary with text as keys.
pub(crate) struct TextKeyed<'py>(pub(crate) Bound<'py, PyDict>);

const TEXT_KEYED: PyStaticExpr = PyStaticExpr::Subscript {
    value: &PyStaticExpr::Name { id: "dict" },
    slice: &PyStaticExpr::Tuple {
        elts: &[
            PyStaticExpr::Name { id: "str" },
            PyStaticExpr::Attribute { value: &PyStaticExpr::Name { id: "typing" }, attr: "Any" },
        ],
    },
};

impl<'py> IntoPyObject<'py> for TextKeyed<'py> {
    type Target = PyDict;
    type Output = Bound<'py, PyDict>;
    type Error = Infallible;

    const OUTPUT_TYPE: PyStaticExpr = TEXT_KEYED;

    fn into_pyobject(self, _: Python<'py>) -> Result<Self::Output, Self::Error> {
        Ok(self.0)
    }
}

impl<'py> FromPyObject<'_, 'py> for TextKeyed<'py> {
    type Error = PyErr;

    const INPUT_TYPE: PyStaticExpr = TEXT_KEYED;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        Ok(Self(object.to_owned().cast_into::<PyDict>()?))
    }
}

/// `funicular.Results`: a dictionary with the keys of the program's JSON, which notebooks show as tables.
pub(crate) struct ResultsObject<'py>(pub(crate) Bound<'py, PyDict>);

impl<'py> IntoPyObject<'py> for ResultsObject<'py> {
    type Target = PyDict;
    type Output = Bound<'py, PyDict>;
    type Error = Infallible;

    const OUTPUT_TYPE: PyStaticExpr =
        PyStaticExpr::Attribute { value: &PyStaticExpr::Name { id: "funicular._results" }, attr: "Results" };

    fn into_pyobject(self, _: Python<'py>) -> Result<Self::Output, Self::Error> {
        Ok(self.0)
    }
}

/// Converts an array or a number of another library to Python's own numbers, booleans, text and lists of them, for a
/// robot file; `None` for any other value.
pub(crate) fn as_python<'py>(
    what: &str,
    object: &Bound<'py, PyAny>,
    error: fn(String) -> PyErr,
) -> PyResult<Option<Bound<'py, PyAny>>> {
    let read = || {
        if has_method(object, "__array__")? {
            let array = object.py().import("numpy")?.call_method1("asanyarray", (object,))?;
            let kind = check_type(&array, "fiuObUT", "give numbers or text")?;
            check_mask(&array)?;
            // Floats of more than 64 bits have no counterpart in Python.
            let array = if kind == "f" { array.call_method1("astype", (f64::NAME,))? } else { array };
            return Ok(Some(array.call_method0("tolist")?));
        }
        if is_number_like(object)? {
            let number: ArrayD<f64> = self::read(object)?;
            return Ok(number.first().map(|value| PyFloat::new(object.py(), *value).into_any()));
        }
        Ok(None)
    };
    read().map_err(|unusable: Unusable| unusable.named_as(what, error))
}

/// Complex numbers from Python in an array of any shape.
pub(crate) struct ComplexNumbers(Result<ArrayD<Complex64>, Unusable>);

impl<'a, 'py> FromPyObject<'a, 'py> for ComplexNumbers {
    type Error = Infallible;

    const INPUT_TYPE: PyStaticExpr = ARRAY_LIKE;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> Result<Self, Infallible> {
        Ok(Self(read(&object)))
    }
}

impl ComplexNumbers {
    fn array(self, what: &str) -> PyResult<ArrayD<Complex64>> {
        self.0.map_err(|error| error.named(what))
    }

    /// Numbers of one row.
    pub(crate) fn row(self, what: &str) -> PyResult<Vec<Complex64>> {
        one_row(self.array(what)?, what)
    }
}

/// One real number from Python. An error is raised when the number is read with the name of its argument.
pub(crate) struct Number(Result<f64, Unusable>);

impl<'a, 'py> FromPyObject<'a, 'py> for Number {
    type Error = Infallible;

    const INPUT_TYPE: PyStaticExpr = <f64 as FromPyObject<'a, 'py>>::INPUT_TYPE;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> Result<Self, Infallible> {
        if object.is_exact_instance_of::<PyFloat>()
            && let Ok(value) = object.extract::<f64>()
        {
            return Ok(Self(Ok(value)));
        }
        let one = |array: ArrayD<f64>| match (array.ndim(), array.first()) {
            (0, Some(value)) => Ok(*value),
            (dimensions, _) => Err(Unusable::here(format!("has {dimensions} dimensions: give one number"))),
        };
        Ok(Self(read(&object).and_then(one)))
    }
}

impl Number {
    /// The number, finite or not.
    pub(crate) fn value(self, what: &str) -> PyResult<f64> {
        self.0.map_err(|error| error.named(what))
    }

    /// The number if it is finite, by the rule for requests.
    pub(crate) fn finite(self, what: &str) -> PyResult<f64> {
        finite(what, self.value(what)?)
    }

    /// The number if it is positive, by the rule for requests.
    pub(crate) fn positive(self, what: &str) -> PyResult<f64> {
        values::positive(self.value(what)?).map_err(|reason| errors::input(format!("`{what}`: {reason}")))
    }

    /// The number if it is not negative, by the rule for requests.
    pub(crate) fn not_negative(self, what: &str) -> PyResult<f64> {
        not_negative(what, self.value(what)?)
    }
}

/// Whole number from Python: an int or an object with `__index__`, but no boolean.
pub(crate) struct Count(Result<Integer, Unusable>);

/// Text of a whole number, and its value if that fits.
struct Integer {
    text: String,
    value: Option<usize>,
}

impl<'a, 'py> FromPyObject<'a, 'py> for Count {
    type Error = Infallible;

    const INPUT_TYPE: PyStaticExpr = <usize as FromPyObject<'a, 'py>>::INPUT_TYPE;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> Result<Self, Infallible> {
        let integer = |object: &Bound<'py, PyAny>| {
            let refused = || Unusable::value(object, "give a whole number");
            if object.is_instance_of::<PyBool>() || !has_method(object, "__index__")? {
                return Err(refused());
            }
            if let Some(mask) = object.getattr_opt("mask")?
                && mask.is_truthy()?
            {
                return Err(Unusable::masked());
            }
            let index = object.call_method0("__index__").map_err(|_| refused())?;
            Ok(Integer { text: index.to_string(), value: index.extract().ok() })
        };
        Ok(Self(integer(&object)))
    }
}

impl Count {
    /// The number if it lies in a range; `rule` is the remedy in the message.
    pub(crate) fn within(self, what: &str, range: RangeInclusive<usize>, rule: &str) -> PyResult<usize> {
        let Integer { text, value } = self.0.map_err(|error| error.with(rule).named(what))?;
        value.filter(|value| range.contains(value)).ok_or_else(|| errors::input(format!("`{what}` is {text}: {rule}")))
    }
}

/// First value, last value and number of values, in a tuple, list or array.
pub(crate) struct FirstLastCount(Result<[Py<PyAny>; 3], Unusable>);

impl<'a, 'py> FromPyObject<'a, 'py> for FirstLastCount {
    type Error = Infallible;

    const INPUT_TYPE: PyStaticExpr = <(Number, Number, Count) as FromPyObject<'a, 'py>>::INPUT_TYPE;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> Result<Self, Infallible> {
        const WANTED: &str = "give the first value, the last value and their number, as in (10, 90, 9)";
        let three = |object: &Bound<'py, PyAny>| {
            if object.is_instance_of::<PyString>() || object.is_instance_of::<PyDict>() {
                return Err(Unusable::value(object, WANTED));
            }
            let Ok(items) = object.try_iter() else { return Err(Unusable::value(object, WANTED)) };
            let items: Vec<Py<PyAny>> = items.take(4).map(|item| item.map(Bound::unbind)).collect::<PyResult<_>>()?;
            let count = object.len().unwrap_or(items.len());
            <[Py<PyAny>; 3]>::try_from(items).map_err(|_| Unusable::here(format!("has {count} numbers: {WANTED}")))
        };
        Ok(Self(three(&object)))
    }
}

impl FirstLastCount {
    /// The three numbers, of which the third is at least 2 and at most `max`.
    pub(crate) fn masses(self, what: &str, max: usize) -> PyResult<(f64, f64, usize)> {
        let [first, last, count] = self.0.map_err(|error| error.named(what))?;
        Python::attach(|py| {
            let number = |object: &Py<PyAny>, place: usize| {
                let Ok(number) = object.bind(py).extract::<Number>();
                number.value(&format!("{what}[{place}]"))
            };
            let (first, last) = (number(&first, 0)?, number(&last, 1)?);
            // An array has one type for all three.
            let whole = number(&count, 2).ok().filter(|value| value.fract() == 0.0 && (2.0..1e15).contains(value));
            let Ok(given) = count.bind(py).extract::<Count>();
            let given = match (whole, has_method(count.bind(py), "dtype")?) {
                (Some(whole), true) => Count(Ok(Integer { text: whole.to_string(), value: Some(whole as usize) })),
                _ => given,
            };
            let rule = format!("the third is the number of masses, from 2 to {max}");
            Ok((first, last, given.within(&format!("{what}[2]"), 2..=max, &rule)?))
        })
    }
}

/// Numbers of an array with one dimension.
fn one_row<T: Copy>(array: ArrayD<T>, what: &str) -> PyResult<Vec<T>> {
    if array.ndim() != 1 {
        return Err(errors::input(format!("`{what}` has {} dimensions: give one row of numbers", array.ndim())));
    }
    Ok(array.iter().copied().collect())
}

/// Real numbers from Python in an array of any shape. An error is raised when they are read with the name of their
/// argument.
pub(crate) struct Numbers(Held);

enum Held {
    Read(Result<ArrayD<f64>, Unusable>),
    Labelled(LabelledNumbers),
}

impl<'a, 'py> FromPyObject<'a, 'py> for Numbers {
    type Error = Infallible;

    const INPUT_TYPE: PyStaticExpr = ARRAY_LIKE;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> Result<Self, Infallible> {
        let is_plain = object.get_type().is(object.py().get_type::<PyUntypedArray>())
            || object.is_instance_of::<PyList>()
            || object.is_instance_of::<PyTuple>();
        let labelled = if is_plain { Ok(None) } else { LabelledNumbers::of(&object) };
        Ok(Self(match labelled {
            Ok(Some(labelled)) => Held::Labelled(labelled),
            Ok(None) => Held::Read(read(&object)),
            Err(error) => Held::Read(Err(error.into())),
        }))
    }
}

impl Numbers {
    fn array(self, what: &str) -> PyResult<ArrayD<f64>> {
        match self.0 {
            Held::Read(array) => array,
            Held::Labelled(labelled) => labelled.array(),
        }
        .map_err(|error| error.named(what))
    }

    /// Numbers of one row, in which places have no meaning of their own.
    pub(crate) fn row(self, what: &str) -> PyResult<Vec<f64>> {
        one_row(self.array(what)?, what)
    }

    /// Numbers of one row, each of which has a name: labels of a series count.
    pub(crate) fn named_row(self, what: &str, names: &Names) -> PyResult<Vec<f64>> {
        if let Held::Labelled(labelled) = &self.0
            && !labelled.is_table()
            && let Some(numbers) = labelled.by_name(names).map_err(|error| error.named(what))?
        {
            return Ok(numbers.concat());
        }
        self.row(what)
    }

    /// Row of a pose: position, then angles or a quaternion if they are there.
    pub(crate) fn pose(self, what: &str) -> PyResult<Vec<f64>> {
        if let Held::Labelled(labelled) = &self.0
            && !labelled.is_table()
            && let Some(numbers) = labelled.of_pose().map_err(|error| error.named(what))?
        {
            return Ok(numbers.concat());
        }
        self.row(what)
    }

    /// One number or one row of numbers; the flag is true for one number.
    pub(crate) fn one_or_row(self, what: &str) -> PyResult<(Vec<f64>, bool)> {
        let array = self.array(what)?;
        if array.ndim() == 0 {
            return Ok((array.iter().copied().collect(), true));
        }
        Ok((one_row(array, what)?, false))
    }

    /// One number for all cables, or one per cable in the order of `cables`.
    pub(crate) fn one_or_per_cable(self, what: &str, cables: &[String]) -> PyResult<Vec<f64>> {
        match self.0 {
            Held::Labelled(_) => self.named_row(what, &Names::of_cables(cables, what)),
            Held::Read(_) => Ok(self.one_or_row(what)?.0),
        }
    }

    /// Three numbers x, y, z.
    pub(crate) fn three(self, what: &str) -> PyResult<[f64; 3]> {
        let row = self.named_row(what, &Names::of_vector(what))?;
        let [x, y, z] = row[..] else {
            return Err(errors::input(format!("`{what}` has {} numbers where x, y, z are needed", row.len())));
        };
        Ok([x, y, z])
    }

    /// Rows of numbers in sequence, and the length of a row.
    fn rows(self, what: &str) -> PyResult<(Vec<f64>, usize)> {
        let array = self.array(what)?;
        let [_, columns] = *array.shape() else {
            return Err(errors::input(format!(
                "`{what}` has {} dimensions: give an array with one row per state",
                array.ndim()
            )));
        };
        Ok((array.iter().copied().collect(), columns))
    }

    /// Rows of poses in sequence, and the length of a row: position, then angles or a quaternion if they are there.
    pub(crate) fn poses(self, what: &str) -> PyResult<(Vec<f64>, usize)> {
        if let Held::Labelled(labelled) = &self.0
            && labelled.is_table()
            && let Some(columns) = labelled.of_pose().map_err(|error| error.named(what))?
        {
            return Ok(transposed(&columns));
        }
        self.rows(what)
    }

    /// Rows with one number per cable in sequence.
    pub(crate) fn rows_per_cable(self, what: &str, cables: &[String]) -> PyResult<Vec<f64>> {
        if let Held::Labelled(labelled) = &self.0
            && labelled.is_table()
            && let Some(columns) =
                labelled.by_name(&Names::of_cables(cables, what)).map_err(|error| error.named(what))?
        {
            return Ok(transposed(&columns).0);
        }
        let (flat, columns) = self.rows(what)?;
        if columns != cables.len() {
            return Err(errors::input(format!(
                "`{what}` has rows of {columns} numbers, and the robot has {} cables: give one number per cable, in \
                 the order of the file",
                cables.len()
            )));
        }
        Ok(flat)
    }

    /// Frequencies of the argument `hz`: one or a row; the flag is true for one.
    pub(crate) fn frequencies(self) -> PyResult<(Vec<f64>, bool)> {
        self.frequencies_of("hz")
    }

    /// Frequencies of an argument: one or a row; the flag is true for one.
    pub(crate) fn frequencies_of(self, what: &str) -> PyResult<(Vec<f64>, bool)> {
        let (frequencies, one) = self.one_or_row(what)?;
        for &hz in &frequencies {
            not_negative(what, hz)?;
        }
        Ok((frequencies, one))
    }
}

/// Makes an array of real numbers of any shape; `name` stands in errors. For functions of the package that are written
/// in Python.
#[pyfunction]
pub(crate) fn real_numbers(name: &str, values: Numbers) -> PyResult<OwnedArray<f64, IxDyn>> {
    values.array(name).map(OwnedArray)
}

/// Makes an array of complex numbers of any shape; `name` stands in errors. For functions of the package that are
/// written in Python.
#[pyfunction]
pub(crate) fn complex_numbers(name: &str, values: ComplexNumbers) -> PyResult<OwnedArray<Complex64, IxDyn>> {
    values.array(name).map(OwnedArray)
}

/// Rows in sequence of columns of equal length, and the length of a row.
fn transposed(columns: &[Vec<f64>]) -> (Vec<f64>, usize) {
    let count = columns.first().map_or(0, Vec::len);
    let rows = (0..count).flat_map(|row| columns.iter().map(move |column| column[row]));
    (rows.collect(), columns.len())
}

/// The value if it is finite, by the rule for requests.
pub(crate) fn finite(what: &str, value: f64) -> PyResult<f64> {
    values::finite(value).map_err(|reason| errors::input(format!("`{what}`: {reason}")))
}

/// The value if it is finite and not negative, by the rule for requests.
pub(crate) fn not_negative(what: &str, value: f64) -> PyResult<f64> {
    values::not_negative(value).map_err(|reason| errors::input(format!("`{what}`: {reason}")))
}

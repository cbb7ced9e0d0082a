//! NumPy arrays in and out, with the types that the `.pyi` names. An array that goes out owns what it was made of.

use crate::errors;
use funicular_study::values;
use numpy::ndarray::{Array, ArrayD, Dimension, Ix1, Ix2, Ix3, IxDyn};
use numpy::{Complex64, Element, IntoPyArray, PyArray, PyArrayDyn, PyArrayMethods, PyUntypedArray};
use pyo3::exceptions::{PyOverflowError, PyTypeError, PyValueError};
use pyo3::inspect::PyStaticExpr;
use pyo3::prelude::*;
use pyo3::types::{
    PyBool, PyByteArray, PyBytes, PyComplex, PyDict, PyFloat, PyInt, PyList, PyMemoryView, PySequence, PyString,
    PyTuple,
};
use std::convert::Infallible;
use std::ops::RangeInclusive;

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

/// Elements that arguments are read as.
trait Read: Named + Copy {
    /// An imaginary part is no loss.
    const COMPLEX: bool;
    /// What to give, for errors.
    const WANTED: &'static str;
}

impl Read for f64 {
    const COMPLEX: bool = false;
    const WANTED: &'static str = "give real numbers, int or float";
}

impl Read for Complex64 {
    const COMPLEX: bool = true;
    const WANTED: &'static str = "give real or complex numbers";
}

/// Depth of nested lists that is refused: no argument has more than two dimensions, and a list may hold itself.
const MAX_DEPTH: usize = 16;

/// Number of letters of a value that an error shows.
const MAX_SHOWN: usize = 60;

/// Why an argument holds no numbers to compute with. Reading an argument does not know its name; [`Unusable::named`] adds
/// it.
#[derive(Debug)]
enum Unusable {
    /// A place in the argument, such as `[3][2]`, and what is wrong there.
    Refused { place: String, reason: String },
    /// An exception that Python raised and that says nothing of the argument, such as Ctrl-C.
    Raised(PyErr),
}

impl From<PyErr> for Unusable {
    fn from(error: PyErr) -> Self {
        Self::Raised(error)
    }
}

impl Unusable {
    fn here(reason: String) -> Self {
        Self::Refused { place: String::new(), reason }
    }

    /// Refuses a value by its text and its type.
    fn value(object: &Bound<'_, PyAny>, wanted: &str) -> Self {
        let kind = match object.get_type().name() {
            Ok(name) => name.to_string(),
            Err(error) => return Self::Raised(error),
        };
        Self::here(match shown(object) {
            Some(text) => format!("is {text}, of type {kind}: {wanted}"),
            None => format!("is of type {kind}: {wanted}"),
        })
    }

    /// Refuses a number that a mask hides.
    fn masked() -> Self {
        Self::here("is masked: give a number in its place, or leave out what is masked".to_owned())
    }

    /// Puts a place before that of the error.
    fn at(self, outer: &str) -> Self {
        match self {
            Self::Refused { place, reason } => Self::Refused { place: format!("{outer}{place}"), reason },
            raised @ Self::Raised(_) => raised,
        }
    }

    /// Adds a rule to what is wrong.
    fn with(self, rule: &str) -> Self {
        match self {
            Self::Refused { place, reason } => Self::Refused { place, reason: format!("{reason}; {rule}") },
            raised @ Self::Raised(_) => raised,
        }
    }

    fn named(self, what: &str) -> PyErr {
        self.named_as(what, errors::input)
    }

    fn named_as(self, what: &str, error: fn(String) -> PyErr) -> PyErr {
        match self {
            Self::Refused { place, reason } => error(format!("`{what}{place}` {reason}")),
            Self::Raised(raised) => raised,
        }
    }
}

/// Python's text of a value, if it has a short one.
fn shown(object: &Bound<'_, PyAny>) -> Option<String> {
    let text = object.repr().ok()?.to_string();
    (text.chars().count() <= MAX_SHOWN && !text.contains('\n')).then_some(text)
}

/// Whether objects of its type have a method.
fn has_method(object: &Bound<'_, PyAny>, name: &str) -> PyResult<bool> {
    object.get_type().hasattr(name)
}

/// Refuses what NumPy would turn into numbers without a word although something is lost or no number was meant: masks,
/// imaginary parts, booleans, text, times, records, None.
///
/// Numbers are Python's and NumPy's integers and floats, and every other object that says by `__float__` or `__index__`
/// that it is one: Fraction and Decimal, rounded to the nearest float.
fn check<T: Read>(object: &Bound<'_, PyAny>, depth: usize) -> Result<(), Unusable> {
    // Long lists hold little else.
    if object.is_exact_instance_of::<PyFloat>() || object.is_exact_instance_of::<PyInt>() {
        return Ok(());
    }

    // Python's own types; NumPy's float64 and complex128 are subclasses of them.
    let is_text = object.is_instance_of::<PyString>()
        || object.is_instance_of::<PyBytes>()
        || object.is_instance_of::<PyByteArray>();
    if object.is_instance_of::<PyBool>() || is_text {
        return Err(Unusable::value(object, T::WANTED));
    }
    if object.is_instance_of::<PyComplex>() {
        return if T::COMPLEX { Ok(()) } else { Err(Unusable::value(object, T::WANTED)) };
    }
    if object.is_instance_of::<PyFloat>() || object.is_instance_of::<PyInt>() {
        return Ok(());
    }

    // What holds other objects. NumPy finds one type for all elements of a list, so they are looked at one by one.
    if depth > MAX_DEPTH {
        return Err(Unusable::here(format!("is nested more than {MAX_DEPTH} deep: {}", T::WANTED)));
    }
    let is_list = object.is_instance_of::<PyList>() || object.is_instance_of::<PyTuple>();
    if !is_list && (has_method(object, "__array__")? || object.is_instance_of::<PyMemoryView>()) {
        let array = object.py().import("numpy")?.call_method1("asanyarray", (object,))?;
        return check_array::<T>(&array, depth);
    }
    if is_list || object.cast::<PySequence>().is_ok() {
        for (i, item) in object.try_iter()?.enumerate() {
            check::<T>(&item?, depth + 1).map_err(|error| error.at(&format!("[{i}]")))?;
        }
        return Ok(());
    }

    let is_number = is_number_like(object)? || (T::COMPLEX && has_method(object, "__complex__")?);
    if is_number { Ok(()) } else { Err(Unusable::value(object, T::WANTED)) }
}

/// Whether an object says that it is a real number.
fn is_number_like(object: &Bound<'_, PyAny>) -> PyResult<bool> {
    Ok(has_method(object, "__float__")? || has_method(object, "__index__")?)
}

/// [`check`] of an array of NumPy, by the type of its elements.
fn check_array<T: Read>(array: &Bound<'_, PyAny>, depth: usize) -> Result<(), Unusable> {
    let kind = check_type(array, if T::COMPLEX { "fiuOc" } else { "fiuO" }, T::WANTED)?;
    check_mask(array)?;
    if kind == "O" {
        for item in array.py().import("numpy")?.call_method1("ndenumerate", (array,))?.try_iter()? {
            let (index, element): (Vec<Bound<'_, PyAny>>, Bound<'_, PyAny>) = item?.extract()?;
            check::<T>(&element, depth + 1).map_err(|error| error.at(&place(&index)))?;
        }
    }
    Ok(())
}

/// The letter that NumPy has for the elements' kind of type (`dtype.kind`), which has to be one of those given.
fn check_type(array: &Bound<'_, PyAny>, kinds: &str, wanted: &str) -> Result<String, Unusable> {
    let dtype = array.getattr("dtype")?;
    let kind: String = dtype.getattr("kind")?.extract()?;
    if kinds.contains(&kind) {
        return Ok(kind);
    }
    let first = array.getattr("flat")?.get_item(0).ok().and_then(|first| shown(&first));
    let first = first.map_or_else(String::new, |first| format!(", as in {first}"));
    Err(Unusable::here(format!("is of type {}{first}: {wanted}", dtype.str()?)))
}

/// Refuses an array that hides elements behind a mask.
fn check_mask(array: &Bound<'_, PyAny>) -> Result<(), Unusable> {
    let Some(mask) = array.getattr_opt("mask")? else { return Ok(()) };
    let masked = array.py().import("numpy")?.call_method1("argwhere", (mask,))?;
    if masked.len()? == 0 {
        return Ok(());
    }
    let first: PyResult<Vec<_>> = masked.get_item(0)?.try_iter()?.collect();
    Err(Unusable::masked().at(&place(&first?)))
}

/// An index as Python writes it; nothing for an array without dimensions.
fn place(index: &[Bound<'_, PyAny>]) -> String {
    let index: Vec<String> = index.iter().map(ToString::to_string).collect();
    if index.is_empty() { String::new() } else { format!("[{}]", index.join(", ")) }
}

/// Reads an argument as an array. Here alone is decided what is a number.
fn read<T: Read>(object: &Bound<'_, PyAny>) -> Result<ArrayD<T>, Unusable> {
    let py = object.py();
    let is_plain = object.get_type().is(py.get_type::<PyUntypedArray>());
    if !(is_plain && object.cast::<PyArrayDyn<T>>().is_ok()) {
        check::<T>(object, 0)?;
    }

    let made = py.import("numpy")?.call_method1("asarray", (object, T::NAME));
    let array = made.map_err(|error| {
        let of_numbers = error.is_instance_of::<PyValueError>(py)
            || error.is_instance_of::<PyTypeError>(py)
            || error.is_instance_of::<PyOverflowError>(py);
        if !of_numbers {
            return Unusable::Raised(error);
        }
        Unusable::here(format!(
            "makes no array ({}): {}, in rows of equal length",
            error.value(py).to_string().trim_end_matches('.'),
            T::WANTED
        ))
    })?;
    let array = array.cast_into::<PyArrayDyn<T>>().map_err(PyErr::from)?;
    let array = array.try_readonly().map_err(PyErr::from)?;
    Ok(array.as_array().to_owned())
}

/// A value for a robot file as Python's own numbers, booleans, text and lists of them, where it is an array or a number of
/// another library; None where it is neither.
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

/// Complex numbers from Python, of any shape.
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

    /// One row of numbers.
    pub(crate) fn row(self, what: &str) -> PyResult<Vec<Complex64>> {
        one_row(self.array(what)?, what)
    }
}

/// One number from Python, real. Whatever is wrong with it is said when it is asked for by the argument's name.
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
    /// A default of our own.
    pub(crate) const fn of(value: f64) -> Self {
        Self(Ok(value))
    }

    /// The number, finite or not.
    pub(crate) fn value(self, what: &str) -> PyResult<f64> {
        self.0.map_err(|error| error.named(what))
    }

    /// Refuses what is not positive, by the rule for requests.
    pub(crate) fn positive(self, what: &str) -> PyResult<f64> {
        values::positive(self.value(what)?).map_err(|reason| errors::input(format!("`{what}`: {reason}")))
    }

    /// Checks as [`not_negative`].
    pub(crate) fn not_negative(self, what: &str) -> PyResult<f64> {
        not_negative(what, self.value(what)?)
    }
}

/// A whole number from Python: an int, or what has `__index__`; no boolean.
pub(crate) struct Count(Result<Whole, Unusable>);

/// A whole number as it was written, and its value where that is not beyond all limits.
struct Whole {
    text: String,
    value: Option<usize>,
}

impl<'a, 'py> FromPyObject<'a, 'py> for Count {
    type Error = Infallible;

    const INPUT_TYPE: PyStaticExpr = <usize as FromPyObject<'a, 'py>>::INPUT_TYPE;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> Result<Self, Infallible> {
        let whole = |object: &Bound<'py, PyAny>| {
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
            Ok(Whole { text: index.to_string(), value: index.extract().ok() })
        };
        Ok(Self(whole(&object)))
    }
}

impl Count {
    /// A default of our own.
    pub(crate) fn of(value: usize) -> Self {
        Self(Ok(Whole { text: value.to_string(), value: Some(value) }))
    }

    /// The number, which has to be in a range; `rule` says in an error what to give.
    pub(crate) fn within(self, what: &str, range: RangeInclusive<usize>, rule: &str) -> PyResult<usize> {
        let Whole { text, value } = self.0.map_err(|error| error.with(rule).named(what))?;
        value.filter(|value| range.contains(value)).ok_or_else(|| errors::input(format!("`{what}` is {text}: {rule}")))
    }
}

/// The numbers of an array that is one row.
fn one_row<T: Copy>(array: ArrayD<T>, what: &str) -> PyResult<Vec<T>> {
    if array.ndim() != 1 {
        return Err(errors::input(format!("`{what}` has {} dimensions: give one row of numbers", array.ndim())));
    }
    Ok(array.iter().copied().collect())
}

/// Real numbers from Python, of any shape. Whatever is wrong with them is said when they are asked for by the argument's
/// name.
pub(crate) struct Numbers(Result<ArrayD<f64>, Unusable>);

impl<'a, 'py> FromPyObject<'a, 'py> for Numbers {
    type Error = Infallible;

    const INPUT_TYPE: PyStaticExpr = ARRAY_LIKE;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> Result<Self, Infallible> {
        Ok(Self(read(&object)))
    }
}

impl Numbers {
    fn array(self, what: &str) -> PyResult<ArrayD<f64>> {
        self.0.map_err(|error| error.named(what))
    }

    /// One row of numbers.
    pub(crate) fn row(self, what: &str) -> PyResult<Vec<f64>> {
        one_row(self.array(what)?, what)
    }

    /// One number or one row of numbers, and whether it is one number.
    pub(crate) fn one_or_row(self, what: &str) -> PyResult<(Vec<f64>, bool)> {
        let array = self.array(what)?;
        if array.ndim() == 0 {
            return Ok((array.iter().copied().collect(), true));
        }
        Ok((one_row(array, what)?, false))
    }

    /// Three numbers.
    pub(crate) fn three(self, what: &str) -> PyResult<[f64; 3]> {
        let row = self.row(what)?;
        let [x, y, z] = row[..] else {
            return Err(errors::input(format!("`{what}` has {} numbers where x, y, z are needed", row.len())));
        };
        Ok([x, y, z])
    }

    /// Rows of numbers, with their length.
    pub(crate) fn rows(self, what: &str) -> PyResult<(Vec<f64>, usize)> {
        let array = self.array(what)?;
        let [_, columns] = *array.shape() else {
            return Err(errors::input(format!(
                "`{what}` has {} dimensions: give an array of rows, one a state",
                array.ndim()
            )));
        };
        Ok((array.iter().copied().collect(), columns))
    }

    /// Frequencies, one or a row of them.
    pub(crate) fn frequencies(self) -> PyResult<(Vec<f64>, bool)> {
        self.frequencies_of("hz")
    }

    /// Frequencies by the name of their argument.
    pub(crate) fn frequencies_of(self, what: &str) -> PyResult<(Vec<f64>, bool)> {
        let (frequencies, one) = self.one_or_row(what)?;
        for &hz in &frequencies {
            not_negative(what, hz)?;
        }
        Ok((frequencies, one))
    }
}

/// Real numbers of any shape as an array; `name` is what errors call them. For the package's own functions in Python.
#[pyfunction]
pub(crate) fn real_numbers(name: &str, values: Numbers) -> PyResult<Out<f64, IxDyn>> {
    values.array(name).map(Out)
}

/// Complex numbers of any shape as an array; `name` is what errors call them. For the package's own functions in Python.
#[pyfunction]
pub(crate) fn complex_numbers(name: &str, values: ComplexNumbers) -> PyResult<Out<Complex64, IxDyn>> {
    values.array(name).map(Out)
}

/// Refuses negative numbers and what is no number to compute with, by the rule for requests.
pub(crate) fn not_negative(what: &str, value: f64) -> PyResult<f64> {
    values::not_negative(value).map_err(|reason| errors::input(format!("`{what}`: {reason}")))
}

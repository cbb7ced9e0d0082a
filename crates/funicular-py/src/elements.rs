//! Elements of arrays: reading of the numbers of an argument, with the place and the reason where they cannot be used.

use crate::errors;
use numpy::ndarray::ArrayD;
use numpy::{Complex64, Element, PyArrayDyn, PyArrayMethods, PyUntypedArray};
use pyo3::exceptions::{PyOverflowError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{
    PyBool, PyByteArray, PyBytes, PyComplex, PyFloat, PyInt, PyList, PyMemoryView, PySequence, PyString, PyTuple,
};

/// Elements of arrays, with their names in NumPy.
pub(crate) trait ElementName: Element {
    const NAME: &'static str;
}

impl ElementName for f64 {
    const NAME: &'static str = "float64";
}

impl ElementName for Complex64 {
    const NAME: &'static str = "complex128";
}

impl ElementName for bool {
    const NAME: &'static str = "bool_";
}

impl ElementName for i64 {
    const NAME: &'static str = "int64";
}

/// Elements of array arguments.
pub(crate) trait ReadableElement: ElementName + Copy {
    /// True if an imaginary part is allowed.
    const COMPLEX: bool;
    /// Remedy in messages.
    const WANTED: &'static str;
}

impl ReadableElement for f64 {
    const COMPLEX: bool = false;
    const WANTED: &'static str = "give real numbers, int or float";
}

impl ReadableElement for Complex64 {
    const COMPLEX: bool = true;
    const WANTED: &'static str = "give real or complex numbers";
}

/// Maximum depth of nested lists: no argument has more than two dimensions, and a list may contain itself.
const MAX_DEPTH: usize = 16;

/// Maximum number of letters of a value in a message.
const MAX_SHOWN: usize = 60;

/// Reason why an argument contains no usable numbers. The reader of an argument does not know its name;
/// [`Unusable::named`] adds it.
#[derive(Debug)]
pub(crate) enum Unusable {
    /// Place in the argument, such as `[3][2]`, and the error there.
    Refused { place: String, reason: String },
    /// Exception of Python that does not concern the argument, such as Ctrl-C.
    Raised(PyErr),
}

impl From<PyErr> for Unusable {
    fn from(error: PyErr) -> Self {
        Self::Raised(error)
    }
}

impl Unusable {
    pub(crate) fn here(reason: String) -> Self {
        Self::Refused { place: String::new(), reason }
    }

    /// Error for a value, with its text and its type.
    pub(crate) fn value(object: &Bound<'_, PyAny>, wanted: &str) -> Self {
        let kind = match object.get_type().name() {
            Ok(name) => name.to_string(),
            Err(error) => return Self::Raised(error),
        };
        Self::here(match shown(object) {
            Some(text) => format!("is {text}, of type {kind}: {wanted}"),
            None => format!("is of type {kind}: {wanted}"),
        })
    }

    /// Error for a number that a mask hides.
    pub(crate) fn masked() -> Self {
        Self::here("is masked: give a number in its place, or leave out what is masked".to_owned())
    }

    /// Puts a place before the place of the error.
    pub(crate) fn at(self, outer: &str) -> Self {
        match self {
            Self::Refused { place, reason } => Self::Refused { place: format!("{outer}{place}"), reason },
            raised @ Self::Raised(_) => raised,
        }
    }

    /// Adds a rule to the reason.
    pub(crate) fn with(self, rule: &str) -> Self {
        match self {
            Self::Refused { place, reason } => Self::Refused { place, reason: format!("{reason}; {rule}") },
            raised @ Self::Raised(_) => raised,
        }
    }

    pub(crate) fn named(self, what: &str) -> PyErr {
        self.named_as(what, errors::input)
    }

    pub(crate) fn named_as(self, what: &str, error: fn(String) -> PyErr) -> PyErr {
        match self {
            Self::Refused { place, reason } => error(format!("`{}{place}` {reason}", short(what))),
            Self::Raised(raised) => raised,
        }
    }
}

/// Python's text of a value; `None` if it is long.
pub(crate) fn shown(object: &Bound<'_, PyAny>) -> Option<String> {
    let text = object.repr().ok()?.to_string();
    (text.chars().count() <= MAX_SHOWN && !text.contains('\n')).then_some(text)
}

/// True if the type of an object has a method.
pub(crate) fn has_method(object: &Bound<'_, PyAny>, name: &str) -> PyResult<bool> {
    object.get_type().hasattr(name)
}

/// Refuses values that NumPy would convert silently although information is lost or no number was meant: masks,
/// imaginary parts, booleans, text, times, records, None.
///
/// Numbers are the integers and floats of Python and NumPy, and other objects with `__float__` or `__index__`, such as
/// Fraction and Decimal, which are rounded to the nearest float.
pub(crate) fn check<T: ReadableElement>(object: &Bound<'_, PyAny>, depth: usize) -> Result<(), Unusable> {
    // Most elements of long lists.
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

    // Containers. NumPy chooses one type for all elements of a list, so each element is checked here.
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

/// True if an object declares itself a real number.
pub(crate) fn is_number_like(object: &Bound<'_, PyAny>) -> PyResult<bool> {
    Ok(has_method(object, "__float__")? || has_method(object, "__index__")?)
}

/// Checks an array of NumPy by the type of its elements, as [`check`] does for other objects.
pub(crate) fn check_array<T: ReadableElement>(array: &Bound<'_, PyAny>, depth: usize) -> Result<(), Unusable> {
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

/// Letter of NumPy for the type of the elements (`dtype.kind`), which has to be one of `kinds`.
pub(crate) fn check_type(array: &Bound<'_, PyAny>, kinds: &str, wanted: &str) -> Result<String, Unusable> {
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
pub(crate) fn check_mask(array: &Bound<'_, PyAny>) -> Result<(), Unusable> {
    let Some(mask) = array.getattr_opt("mask")? else { return Ok(()) };
    let masked = array.py().import("numpy")?.call_method1("argwhere", (mask,))?;
    if masked.len()? == 0 {
        return Ok(());
    }
    let first: PyResult<Vec<_>> = masked.get_item(0)?.try_iter()?.collect();
    Err(Unusable::masked().at(&place(&first?)))
}

/// Index as Python writes it; empty for an array without dimensions.
pub(crate) fn place(index: &[Bound<'_, PyAny>]) -> String {
    let index: Vec<String> = index.iter().map(ToString::to_string).collect();
    if index.is_empty() { String::new() } else { format!("[{}]", index.join(", ")) }
}

/// Reads an argument as an array. The decision which values are numbers is made here alone.
pub(crate) fn read<T: ReadableElement>(object: &Bound<'_, PyAny>) -> Result<ArrayD<T>, Unusable> {
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

/// First letters of a text, without control characters.
pub(crate) fn short(text: &str) -> String {
    const LETTERS: usize = 40;
    let shown: String = text.chars().filter(|c| !c.is_control()).take(LETTERS).collect();
    if text.chars().count() > LETTERS { format!("{shown}…") } else { shown }
}

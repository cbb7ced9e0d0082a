//! Results that make their page: those of `identify`, `design` and `uncertainty`.

use crate::errors;
use crate::interrupt::interruptible_in_steps;
use funicular_pages::pages;
use funicular_study::columns::{Cell, ResultTable};
use funicular_study::request::Request;
use funicular_study::wording::{Words, worded};
use funicular_study::{Results, run};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use std::sync::OnceLock;

/// Results of a request, from which their page is made.
///
/// A pickle contains the request. Its results are computed again when a page is wanted.
#[pyclass(frozen, module = "funicular._funicular", name = "Answered")]
pub(crate) struct PyAnswered {
    request: Request,
    found: OnceLock<Results>,
}

impl PyAnswered {
    pub(crate) fn new(request: Request, found: Results) -> Self {
        Self { request, found: found.into() }
    }

    fn found(&self, py: Python<'_>) -> PyResult<&Results> {
        if let Some(found) = self.found.get() {
            return Ok(found);
        }
        let request = self.request.clone();
        let found = interruptible_in_steps(py, move |watch| run(&request, watch))?;
        let found = found.map_err(|error| errors::study(&error.into()))?;
        Ok(self.found.get_or_init(|| found))
    }
}

/// Name, unit and values of a column of CSV.
type ColumnOfCsv = (String, String, Vec<Py<PyAny>>);

/// Value of a cell; `None` for one that the row does not have.
fn object(py: Python<'_>, cell: Cell) -> PyResult<Py<PyAny>> {
    Ok(match cell {
        Cell::Number(value) => value.into_py_any(py)?,
        Cell::Count(count) => count.into_py_any(py)?,
        Cell::Flag(is) => is.into_py_any(py)?,
        Cell::Text(text) => text.into_py_any(py)?,
        Cell::Missing(_) => py.None(),
    })
}

#[pymethods]
impl PyAnswered {
    /// Takes a request in JSON, whose results are computed when they are wanted.
    #[new]
    fn of_request(request: &str) -> PyResult<Self> {
        let request = Request::from_json(request).map_err(|error| errors::study(&error.into()))?;
        Ok(Self { request, found: OnceLock::new() })
    }

    /// Request, as JSON.
    #[getter]
    fn request(&self) -> String {
        self.request.to_value().to_string()
    }

    /// Returns the keys of the program's JSON.
    fn json(&self, py: Python<'_>) -> PyResult<String> {
        let bytes = self.found(py)?.to_json(Words::Python).map_err(|error| errors::study(&error.into()))?;
        String::from_utf8(bytes).map_err(|error| errors::input(error.to_string()))
    }

    /// Returns name, unit and values of every column of the program's CSV.
    fn table(&self, py: Python<'_>) -> PyResult<Vec<ColumnOfCsv>> {
        let ResultTable { columns, rows } = self.found(py)?.table();
        let named = columns.into_iter().map(|column| (column.name, column.unit.into_owned(), Vec::new()));
        let mut table: Vec<ColumnOfCsv> = named.collect();
        for row in rows {
            for ((_, _, values), cell) in table.iter_mut().zip(row) {
                values.push(object(py, cell)?);
            }
        }
        Ok(table)
    }

    /// Makes the page in HTML; `call` is the code that makes it again.
    fn page(&self, py: Python<'_>, call: String) -> PyResult<String> {
        let page = match self.found(py)? {
            Results::Identify(found) => pages::identify::page(found, call),
            Results::Design(found) => pages::design::page(found, call),
            Results::Uncertainty(found) => pages::uncertainty::page(found, call),
            _ => return Err(errors::input(format!("`{}` has no page of its own", self.request.command()))),
        };
        let page = page.map_err(|error| errors::study(&error))?;
        Ok(worded(&page, Words::Python))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> (Bound<'py, PyAny>, (String,)) {
        (slf.get_type().into_any(), (slf.get().request(),))
    }
}

//! Results that the compiled half holds with their request, from which tables, pages and other files are made.

use crate::answers::{CtrlC, in_words};
use crate::errors;
use crate::interrupt::interruptible_in_steps;
use funicular_answers::FigureOptions;
use funicular_answers::outputs::{self, Answered, Opened, Wanted};
use funicular_files::Guard;
use funicular_files::endings::Kind;
use funicular_study::columns::{Cell, ResultTable};
use funicular_study::request::{Request, commands};
use funicular_study::wording::{Words, told};
use funicular_study::{Results, run};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use serde_json::{Value, json};
use std::path::PathBuf;
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

    /// Returns the rounded table for LaTeX, or for Markdown.
    fn reading_table(&self, py: Python<'_>, latex: bool) -> PyResult<String> {
        let table = self.found(py)?.table().reading();
        Ok(if latex { table.latex() } else { table.markdown() })
    }

    /// Makes the page in HTML; `call` is the code that makes it again.
    fn page(&self, py: Python<'_>, call: String) -> PyResult<String> {
        let found = self.found(py)?;
        let at = Answered {
            request: &self.request,
            results: Some(found),
            validated: None,
            call: &call,
            words: Words::Python,
        };
        outputs::page_of(&at).map_err(|error| errors::study(&error))
    }

    /// Writes files that the command writes besides its result, by their keys, and returns sentences about them; `call`
    /// is the code that writes them again.
    fn write(&self, py: Python<'_>, files: Vec<(String, PathBuf)>, call: String) -> PyResult<Vec<String>> {
        let wanted = wanted(files);
        let opened = Opened::open(&self.request, &wanted, FigureOptions::default(), &mut Guard::default());
        let opened = opened.map_err(|error| errors::of_file(&error))?;
        // The study does not know the results of `validate`.
        let validated = match &self.request {
            Request::Validate(of) => Some(py.detach(|| funicular_validation::run(of))),
            _ => None,
        };
        let validated = validated.transpose().map_err(|error| errors::study(&error))?;
        let needs = opened.needs_results() && validated.is_none();
        let found = if needs { Some(self.found(py)?) } else { None };
        let mut sentences = Vec::new();
        let written = py.detach(|| {
            let at = Answered {
                request: &self.request,
                results: found,
                validated: validated.as_ref(),
                call: &call,
                words: Words::Python,
            };
            let mut watch = CtrlC::new();
            let made = opened.make(at, &mut watch);
            watch.result(made)
        })?;
        for file in written {
            file.write().map_err(|error| errors::of_file(&error))?;
            sentences.extend(in_words(&file.warnings));
        }
        Ok(sentences)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> (Bound<'py, PyAny>, (String,)) {
        (slf.get_type().into_any(), (slf.get().request(),))
    }
}

fn wanted(files: Vec<(String, PathBuf)>) -> Vec<Wanted> {
    files.into_iter().map(|(key, path)| Wanted { key, path }).collect()
}

/// Checks files that a command shall write besides its result, before the work; `given` has its keys as JSON.
#[pyfunction]
pub(crate) fn check_files(command: &str, given: &str, files: Vec<(String, PathBuf)>) -> PyResult<()> {
    let given = serde_json::from_str(given).map_err(|error| errors::input(error.to_string()))?;
    let opened = Opened::of_keys(command, &given, &wanted(files), FigureOptions::default(), &mut Guard::default());
    opened.map(drop).map_err(|error| errors::of_file(&error))
}

/// Files that commands write besides their result, as JSON: by the name of the command, with key, meaning, and whether
/// there may be several.
#[pyfunction]
pub(crate) fn outputs_of_commands() -> String {
    let one = |of: &outputs::Output| {
        let ending = |kind: &Kind| kind.ending().map(|ending| format!(".{ending}"));
        let endings: Vec<String> = of.kinds.iter().filter_map(ending).collect();
        json!({ "key": of.key, "about": told(of.about, Words::Python), "several": of.several, "endings": endings })
    };
    let all = commands().iter().map(|of| (of.name.to_owned(), outputs::of(of.name).iter().map(one).collect::<Value>()));
    Value::Object(all.collect()).to_string()
}

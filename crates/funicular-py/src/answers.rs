//! Results of requests: dictionaries from the JSON of the study, pages, and files.

use crate::arrays::{ResultsObject, TextKeyed};
use crate::errors;
use crate::interrupt::{check_signals, interruptible_in_steps, seconds};
use crate::sweep::ProgressArgument;
use funicular_answers::document;
use funicular_files::atomic_file::{TemporaryFile, is_regular_or_new};
use funicular_files::{SweepFile, merge};
use funicular_formats::import::{self, SourceFile};
use funicular_formats::measurements::{self, FileOptions};
use funicular_pages::figures;
use funicular_pages::pages;
use funicular_study::analyses::Found;
use funicular_study::request::Request;
use funicular_study::wording::{Words, told, worded};
use funicular_study::{Error, Watch, json, run};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::fs;
use std::io::{self, Write};
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Watch that ends long work when a handler of a signal raises, as that of Ctrl-C does, and tells a function how far it
/// is.
pub(crate) struct CtrlC {
    checked: Instant,
    raised: Option<PyErr>,
    told: Option<ProgressArgument>,
}

impl CtrlC {
    /// Time between two checks for Ctrl-C.
    const INTERVAL: Duration = Duration::from_millis(50);

    pub(crate) fn new() -> Self {
        Self::telling(None)
    }

    pub(crate) fn telling(told: Option<ProgressArgument>) -> Self {
        Self { checked: Instant::now(), raised: None, told }
    }

    /// Results of work, or the exception that ended it.
    pub(crate) fn result<T>(self, found: anyhow::Result<T>) -> PyResult<T> {
        match self.part(found)? {
            (found, None) => Ok(found),
            (_, Some(raised)) => Err(raised),
        }
    }

    /// Results of work that may have been stopped with a part of them, and the exception that stopped it.
    pub(crate) fn part<T>(self, found: anyhow::Result<T>) -> PyResult<(T, Option<PyErr>)> {
        match (found, self.raised) {
            (Err(error), raised) => Err(raised.unwrap_or_else(|| errors::study(&error))),
            (Ok(found), raised) => Ok((found, raised)),
        }
    }
}

impl Watch for CtrlC {
    fn progress(&mut self, done: usize, total: usize, _what: &'static str) {
        if self.raised.is_some() || (self.checked.elapsed() < Self::INTERVAL && done < total) {
            return;
        }
        self.checked = Instant::now();
        self.raised = check_signals().err();
        if let (Some(ProgressArgument(function)), None) = (&self.told, &self.raised) {
            self.raised = Python::attach(|py| function.call1(py, (done, total)).err());
        }
    }

    fn is_cancelled(&self) -> bool {
        self.raised.is_some()
    }

    fn now_s(&self) -> Option<f64> {
        Some(seconds())
    }
}

/// Dictionary from JSON.
pub(crate) fn loaded<'py>(py: Python<'py>, bytes: &[u8]) -> PyResult<TextKeyed<'py>> {
    let dictionary = py.import("json")?.call_method1("loads", (PyBytes::new(py, bytes),))?;
    Ok(TextKeyed(dictionary.cast_into()?))
}

/// Results with the keys of the program's JSON.
pub(crate) fn plain<'py, R: Found>(py: Python<'py>, results: &R) -> PyResult<TextKeyed<'py>> {
    loaded(py, &json::of_results(results, Words::Python).map_err(|error| errors::study(&error.into()))?)
}

/// Results with the keys of the program's JSON, in which lists of numbers are arrays.
pub(crate) fn with_arrays<'py, R: Found>(py: Python<'py>, results: &R) -> PyResult<ResultsObject<'py>> {
    let plain = plain(py, results)?;
    Ok(ResultsObject(py.import("funicular._results")?.call_method1("results", (plain.0,))?.cast_into()?))
}

fn request(text: &str) -> PyResult<Request> {
    Request::from_json(text).map_err(|error| errors::study(&error.into()))
}

/// Adds the defaults to a request; both are JSON.
#[pyfunction]
pub(crate) fn complete_request(request: &str) -> PyResult<String> {
    Ok(self::request(request)?.to_value().to_string())
}

/// Computes the results of a request; both are JSON. Commands that make files, pages or rows are refused.
#[pyfunction]
pub(crate) fn answer(py: Python<'_>, request: &str) -> PyResult<String> {
    let request = self::request(request)?;
    let bytes = interruptible_in_steps(py, move |watch| {
        json_of(&request, watch).map_err(|error| errors::study(&error.into()))
    })??;
    String::from_utf8(bytes).map_err(|error| errors::input(error.to_string()))
}

fn json_of(request: &Request, watch: &mut dyn Watch) -> Result<Vec<u8>, Error> {
    match request {
        Request::Validate(of) => json::of_results(&funicular_validation::run(of)?, Words::Python),
        _ => run(request, watch)?.to_json(Words::Python),
    }
}

/// Computes text and caveats of a request whose result is a file, such as `report` or `export`; `call` is the code that
/// makes a page again.
#[pyfunction]
pub(crate) fn text_of(py: Python<'_>, request: &str, call: String) -> PyResult<(String, Vec<String>)> {
    let request = self::request(request)?;
    let made = interruptible_in_steps(py, move |watch| document::make(&request, &call, Words::Python, watch))?;
    let made = made.map_err(|error| errors::study(&error))?;
    if made.bytes.is_some() {
        let advice = "a unit for co-simulation is no text: write its file with `Equilibrium.export`";
        return Err(errors::study(&anyhow::anyhow!(advice)));
    }
    Ok((worded(&made.text, Words::Python), in_words(&made.warnings)))
}

/// Texts with the names of options as Python writes them.
pub(crate) fn in_words(texts: &[String]) -> Vec<String> {
    texts.iter().map(|text| told(text, Words::Python)).collect()
}

/// Returns the widths of columns of journals [mm], and minimum and maximum of a figure's width [mm] and of its texts
/// [pt].
#[pyfunction]
#[expect(clippy::type_complexity, reason = "a tuple for Python")]
pub(crate) fn figure_sizes() -> (Vec<(&'static str, f64)>, (f64, f64), (f64, f64)) {
    (figures::WIDTHS.to_vec(), figures::WIDTH_LIMITS_MM, figures::FONT_SIZE_LIMITS_PT)
}

/// Reads a file of another program for a request: path, text, and the encoding if it had to be guessed, as JSON.
#[pyfunction]
pub(crate) fn source_file(path: PathBuf) -> PyResult<String> {
    let name = path.display().to_string();
    let bytes =
        fs::read(&path).map_err(|error| io::Error::new(error.kind(), format!("cannot read {name}: {error}")))?;
    let file = SourceFile::decode(name, &bytes).map_err(|error| errors::study(&error))?;
    serde_json::to_string(&file).map_err(|error| errors::input(error.to_string()))
}

/// Reads a file of measurements as an experiment in JSON. What is left out or converted is a `MeasurementWarning`.
#[pyfunction]
pub(crate) fn measurements_of_file(py: Python<'_>, path: PathBuf, options: &str) -> PyResult<String> {
    let options: FileOptions =
        serde_json::from_str(options).map_err(|error| errors::input(format!("the options cannot be read: {error}")))?;
    let name = path.display().to_string();
    let bytes =
        fs::read(&path).map_err(|error| io::Error::new(error.kind(), format!("cannot read {name}: {error}")))?;
    let experiment = measurements::read(&name, &bytes, &options).map_err(|error| errors::study(&error))?;
    experiment.notes.iter().try_for_each(|note| errors::warn(py, "MeasurementWarning", note, 2))?;
    serde_json::to_string(&experiment).map_err(|error| errors::input(error.to_string()))
}

/// Computes robot file, assumptions and losses of a request of `import`.
#[pyfunction]
pub(crate) fn imported(request: &str) -> PyResult<(String, Vec<String>, Vec<String>)> {
    let Request::Import(of) = self::request(request)? else {
        return Err(errors::input("this is no request of `import`".to_owned()));
    };
    let import::Imported { text, assumed, lost } =
        import::run(&of, Words::Python).map_err(|error| errors::study(&error))?;
    Ok((text, assumed, lost))
}

/// Makes page and notes of the Parquet file of a map or sweep; `label` names the rows, `call` is the code that makes
/// the page again.
#[pyfunction]
pub(crate) fn plot_page(py: Python<'_>, path: PathBuf, label: String, call: String) -> PyResult<(String, Vec<String>)> {
    let file = SweepFile::open(&path).map_err(|error| errors::files(&error))?;
    py.detach(|| {
        let mut watch = CtrlC::new();
        let page = pages::plot::plot(&file, label, call, &mut watch);
        let page = watch.result(page)?;
        Ok((worded(&page.html, Words::Python), in_words(&page.notes)))
    })
}

/// Joins the parts of a map or sweep; returns the number of rows.
#[pyfunction]
pub(crate) fn merge_parts(py: Python<'_>, parts: Vec<PathBuf>, path: PathBuf) -> PyResult<usize> {
    py.detach(|| merge(&parts, &path)).map_err(|error| errors::files(&error))
}

/// Tries whether a file can be written, before the work whose result it shall hold.
#[pyfunction]
pub(crate) fn try_file(path: PathBuf) -> PyResult<()> {
    let target = path.canonicalize().unwrap_or_else(|_| path.clone());
    let tried = if target.is_dir() {
        Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a folder"))
    } else if is_regular_or_new(&target) {
        // The empty file is removed again.
        TemporaryFile::beside(&target).map(drop)
    } else {
        Ok(())
    };
    tried.map_err(|error| errors::unwritable(format!("cannot write to {}: {error}", path.display())))
}

/// Writes a text to a file, which is complete or absent.
#[pyfunction]
pub(crate) fn write_file(path: PathBuf, text: &str) -> PyResult<()> {
    write_bytes(path, text.as_bytes())
}

/// Writes a file that is complete or absent.
pub(crate) fn write_bytes(path: PathBuf, bytes: &[u8]) -> PyResult<()> {
    // A symbolic link stays: the file that it points to is replaced.
    let target = path.canonicalize().unwrap_or_else(|_| path.clone());
    let write = || {
        if !is_regular_or_new(&target) {
            return fs::OpenOptions::new().write(true).open(&target)?.write_all(bytes);
        }
        let mut file = TemporaryFile::beside(&target)?;
        file.as_file_mut().write_all(bytes)?;
        file.persist(&target)
    };
    write().map_err(|error: io::Error| errors::unwritable(format!("cannot write to {}: {error}", path.display())))
}

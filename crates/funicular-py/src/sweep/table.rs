//! Table of the rows of a sweep for NumPy, Arrow and files.

use crate::arrays::Vector;
use crate::errors;
use arrow_array::RecordBatchIterator;
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use funicular_files::Table;
use funicular_study::table::Values;
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::types::PyCapsule;
use std::path::PathBuf;
use std::sync::Arc;

/// Rows of a sweep as columns in memory.
#[pyclass(frozen, name = "SweepTable", module = "funicular._funicular")]
pub(crate) struct PyTable(Table);

impl PyTable {
    pub(crate) fn of(table: Table) -> Self {
        Self(table)
    }
}

#[pymethods]
impl PyTable {
    /// Reads a Parquet file of a sweep.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        py.detach(|| Table::read(&path)).map(Self).map_err(|error| errors::files(&error))
    }

    /// Names, units and meanings of the columns.
    #[getter]
    fn fields(&self) -> Vec<(String, String, String)> {
        let columns = self.0.record().columns.iter();
        columns.map(|column| (column.name.clone(), column.unit.to_string(), column.about.clone())).collect()
    }

    /// Returns one column: numbers (NaN if missing), flags, or a list of texts (None if missing).
    fn column(&self, py: Python<'_>, index: usize) -> PyResult<Py<PyAny>> {
        let values = py.detach(|| self.0.column(index));
        Ok(match values.ok_or_else(|| PyIndexError::new_err(index))? {
            Values::Real(values) => {
                let numbers: Vector = values.into_iter().map(|value| value.unwrap_or(f64::NAN)).collect();
                numbers.into_pyobject(py)?.into_any().unbind()
            }
            Values::Flag(values) => values.into_iter().collect::<Vector<bool>>().into_pyobject(py)?.into_any().unbind(),
            Values::Text(values) => {
                let texts: Vec<Option<String>> =
                    values.into_iter().map(|text| text.map(std::borrow::Cow::into_owned)).collect();
                texts.into_pyobject(py)?.into_any().unbind()
            }
        })
    }

    /// Number of rows.
    #[getter]
    fn rows(&self) -> usize {
        self.0.rows()
    }

    /// True if every row of the plan is there.
    #[getter]
    fn complete(&self) -> bool {
        self.0.is_complete()
    }

    /// Text of the robot file.
    #[getter]
    fn robot_file(&self) -> &str {
        &self.0.record().robot_file
    }

    /// Points, quantities and options, as JSON.
    #[getter]
    fn plan(&self) -> String {
        serde_json::Value::from(self.0.record().plan.clone()).to_string()
    }

    /// Writes .parquet, .csv or .vti; the file is complete or absent.
    fn write(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| self.0.write(&path)).map_err(|error| errors::files(&error))
    }

    /// Exports the rows as a C stream of Arrow, without copies.
    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        // The protocol allows a producer to use its own schema.
        let _ = requested_schema;
        let batches: Vec<_> = self.0.batches().iter().cloned().map(Ok).collect();
        let reader = RecordBatchIterator::new(batches, Arc::clone(self.0.schema()));
        let stream = FFI_ArrowArrayStream::new(Box::new(reader));
        // `Any`: the type of a capsule has a name in Python only since 3.13.
        Ok(PyCapsule::new_with_value(py, stream, c"arrow_array_stream")?.into_any())
    }
}

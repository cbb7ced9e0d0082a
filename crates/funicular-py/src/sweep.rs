//! Maps and sweeps: the plan, which can be pickled, the collection of its rows, and the table of all rows.
//!
//! Python distributes the rows among workers and replaces workers that die (`_runs.py`, `_executors.py`).

mod arguments;
mod plan;
mod plan_data;
mod table;
mod work;

pub(crate) use arguments::{Axes, ExecutorArgument, ProgressArgument, poses};
pub(crate) use plan::PyPlan;
pub(crate) use table::PyTable;
pub(crate) use work::PyWork;

use crate::arrays::Count;
use crate::threads::Threads;
use pyo3::inspect::PyStaticExpr;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::convert::Infallible;
use std::path::PathBuf;

/// `funicular.Sweep`.
pub(crate) struct SweepObject(Py<PyAny>);

impl<'py> IntoPyObject<'py> for SweepObject {
    type Target = PyAny;
    type Output = Bound<'py, PyAny>;
    type Error = Infallible;

    const OUTPUT_TYPE: PyStaticExpr =
        PyStaticExpr::Attribute { value: &PyStaticExpr::Name { id: "funicular._sweeps" }, attr: "Sweep" };

    fn into_pyobject(self, py: Python<'py>) -> Result<Self::Output, Self::Error> {
        Ok(self.0.into_bound(py))
    }
}

/// Keywords of `map` and `sweep` for the computation and the file of the rows.
pub(crate) struct RunKeywords {
    pub(crate) file: Option<PathBuf>,
    pub(crate) resume: bool,
    pub(crate) discard: bool,
    pub(crate) threads: Option<Threads>,
    pub(crate) executor: Option<ExecutorArgument>,
    pub(crate) chunks_per_task: Option<Count>,
    pub(crate) progress: Option<ProgressArgument>,
}

impl RunKeywords {
    /// Computes all rows of a plan.
    pub(crate) fn rows(self, py: Python<'_>, plan: PyPlan) -> PyResult<SweepObject> {
        let at_least_one = |count: Count| count.within("chunks_per_task", 1..=usize::MAX, "give at least one");
        let chunks_per_task = self.chunks_per_task.map(at_least_one).transpose()?;
        let keywords = PyDict::new(py);
        keywords.set_item("file", self.file)?;
        keywords.set_item("resume", self.resume)?;
        keywords.set_item("discard", self.discard)?;
        keywords.set_item("threads", self.threads.map(|threads| threads.0))?;
        keywords.set_item("executor", self.executor.map(|executor| executor.0))?;
        keywords.set_item("chunks_per_task", chunks_per_task)?;
        keywords.set_item("progress", self.progress.map(|progress| progress.0))?;
        let run = py.import("funicular._runs")?.getattr("run")?;
        Ok(SweepObject(run.call((plan,), Some(&keywords))?.unbind()))
    }
}

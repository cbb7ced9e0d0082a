//! Computations for a robot; `_robot_methods.py` declares the methods that call them.

use super::PyRobot;
use crate::answered::PyAnswered;
use crate::answers::CtrlC;
use crate::arrays::{Count, Numbers};
use crate::batch::{self, Equilibria, States};
use crate::equilibrium::PyEquilibrium;
use crate::errors;
use crate::interrupt::interruptible_by_flag;
use crate::request::{Keywords, state_and_tensions};
use crate::sweep::{ExecutorArgument, ProgressArgument, PyPlan, RunKeywords, SweepObject};
use crate::threads::Threads;
use funicular::robot::Robot;
use funicular_answers::answer;
use funicular_answers::{Running, Stopped};
use funicular_files::Begin;
use funicular_study::Watch;
use funicular_study::request::Request;
use funicular_study::wording::{Words, worded};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

impl PyRobot {
    fn request_of(&self, command: &str, given: &Bound<'_, PyDict>) -> PyResult<Request> {
        Keywords::read(command, given, &self.names())?.request(&self.source)
    }
}

#[pymethods]
impl PyRobot {
    #[pyo3(name = "_equilibrium")]
    fn equilibrium(slf: Py<Self>, py: Python<'_>, given: &Bound<'_, PyDict>) -> PyResult<Py<PyEquilibrium>> {
        let (state, tensions) = state_and_tensions(given, &slf.get().names())?;
        PyEquilibrium::of(py, slf, state, tensions)?.into_object(py)
    }

    #[pyo3(name = "_equilibria")]
    fn equilibria(
        &self,
        py: Python<'_>,
        poses: Option<Numbers>,
        lengths_m: Option<Numbers>,
        threads: Option<Threads>,
        given: &Bound<'_, PyDict>,
    ) -> PyResult<Equilibria> {
        let cables = self.names();
        let states = States::read(poses, lengths_m, &cables)?;
        let (state, tensions) = state_and_tensions(given, &cables)?;
        batch::equilibria(py, self, states, &state, &tensions, threads)
    }

    /// Results of a command, with the keys of the program's JSON. `progress` is called where the work has steps, and
    /// the samples of `uncertainty` go to a file.
    #[pyo3(name = "_answer")]
    #[pyo3(signature = (
        command, given, threads=None, progress=None, samples_file=None, resume=false, discard=false
    ))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn answer(
        &self,
        py: Python<'_>,
        command: &str,
        given: &Bound<'_, PyDict>,
        threads: Option<Threads>,
        progress: Option<ProgressArgument>,
        samples_file: Option<PathBuf>,
        resume: bool,
        discard: bool,
    ) -> PyResult<PyAnswered> {
        let request = self.request_of(command, given)?;
        if samples_file.is_none() && (resume || discard) {
            return Err(errors::input("`resume` and `discard` need `samples_file`".to_owned()));
        }
        if resume && discard {
            return Err(errors::input("give `resume` or `discard`, not both: one keeps the robots".to_owned()));
        }
        let samples = samples_file.map(|path| (path, Begin::of(resume, discard)));
        answered(py, request, (*self.robot).clone(), Asked { threads: Threads::of(threads), progress, samples })
    }

    /// Rows of `map` or `sweep`.
    #[pyo3(name = "_rows")]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn rows(
        &self,
        py: Python<'_>,
        command: &str,
        given: &Bound<'_, PyDict>,
        part: Option<String>,
        file: Option<PathBuf>,
        resume: bool,
        discard: bool,
        threads: Option<Threads>,
        executor: Option<ExecutorArgument>,
        chunks_per_task: Option<Count>,
        progress: Option<ProgressArgument>,
    ) -> PyResult<SweepObject> {
        let plan = PyPlan::of(py, self.request_of(command, given)?, part)?;
        RunKeywords { file, resume, discard, threads, executor, chunks_per_task, progress }.rows(py, plan)
    }
}

/// Exception that stopped work, with the results that are there as its attribute `partial_results`.
fn with_part(py: Python<'_>, raised: PyErr, part: PyAnswered) -> PyErr {
    let attach = || {
        let results = py.import("funicular._results")?.call_method1("of_stopped", (part,))?;
        raised.value(py).setattr("partial_results", results)
    };
    // An exception whose class has no room for attributes is raised without the results.
    let _: PyResult<()> = attach();
    raised
}

/// Way of running a request.
struct Asked {
    threads: NonZeroUsize,
    progress: Option<ProgressArgument>,
    samples: Option<(PathBuf, Begin)>,
}

/// Runs a request. Work that a signal or the function of the progress stops keeps what it has until then, if it can.
/// Work on several threads runs beside the calling one.
fn answered(py: Python<'_>, request: Request, robot: Robot, asked: Asked) -> PyResult<PyAnswered> {
    let Asked { threads, progress, samples } = asked;
    if !matches!(request, Request::Workspace(_) | Request::Uncertainty(_)) {
        let cancel = AtomicBool::new(false);
        let (answer, raised) = py.detach(|| {
            let mut watch = CtrlC::telling(progress);
            let running =
                Running { watch: &mut watch, threads, cancel: &cancel, samples: None, has_figure: false, keeper: None };
            let found = answer::run(&request, Some(robot), running);
            watch.part(found)
        })?;
        let found = PyAnswered::new(request, answer.results);
        return match raised {
            Some(raised) if answer.stopped.is_some() => Err(with_part(py, raised, found)),
            Some(raised) => Err(raised),
            None => Ok(found),
        };
    }

    let asked = request.clone();
    let ((found, refused), raised) = interruptible_by_flag(py, move |cancel| {
        let mut watch = Telling { progress, raised: None };
        let samples = samples.as_ref().map(|(path, begin)| (path.as_path(), *begin));
        let running = Running { watch: &mut watch, threads, cancel, samples, has_figure: false, keeper: None };
        let found = answer::run(&asked, Some(robot), running);
        (found, watch.raised)
    })?;
    match (found, refused.or(raised)) {
        (Ok(answer), Some(raised)) => Err(with_part(py, raised, PyAnswered::new(request, answer.results))),
        (Ok(answer), None) => Ok(PyAnswered::new(request, answer.results)),
        (Err(error), raised) => match (error.downcast_ref::<Stopped>(), raised) {
            (Some(Stopped(reason)), Some(raised)) => Err(with_note(py, raised, &worded(reason, Words::Python))),
            (_, Some(raised)) => Err(raised),
            (_, None) => Err(errors::study(&error)),
        },
    }
}

/// Exception with a sentence about the work that it stopped.
fn with_note(py: Python<'_>, raised: PyErr, sentence: &str) -> PyErr {
    // An exception that takes no notes is raised without the sentence.
    let _ = raised.value(py).call_method1("add_note", (sentence,));
    raised
}

/// Watch that tells a function how far the work is, and stops the work when the function raises.
struct Telling {
    progress: Option<ProgressArgument>,
    raised: Option<PyErr>,
}

impl Watch for Telling {
    fn progress(&mut self, done: usize, total: usize, _what: &'static str) {
        if let (Some(ProgressArgument(function)), None) = (&self.progress, &self.raised) {
            self.raised = Python::attach(|py| function.call1(py, (done, total)).err());
        }
    }

    fn is_cancelled(&self) -> bool {
        self.raised.is_some()
    }
}

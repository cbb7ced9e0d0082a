//! Computations for a robot; `_robot_methods.py` declares the methods that call them.

use super::PyRobot;
use crate::answered::PyAnswered;
use crate::answers::{self, CtrlC};
use crate::arrays::{Count, Numbers};
use crate::batch::{self, Equilibria, States};
use crate::equilibrium::PyEquilibrium;
use crate::errors;
use crate::interrupt::interruptible_by_flag;
use crate::request::{Keywords, state_and_tensions};
use crate::sweep::{ExecutorArgument, ProgressArgument, PyPlan, RunKeywords, SweepObject};
use crate::threads::Threads;
use funicular_files::{Begin, UncertaintyOutcome, UncertaintyRun, WorkspaceRun};
use funicular_formats::surface::{self, SurfaceFormat};
use funicular_pages::figures::{self, Figure, Size};
use funicular_pages::pages;
use funicular_study::analyses::uncertainty::UncertaintyStudy;
use funicular_study::analyses::workspace::{Workspace, WorkspaceStudy};
use funicular_study::analyses::{simulate, trajectory};
use funicular_study::request::{Request, UncertaintyRequest};
use funicular_study::wording::{Words, worded};
use funicular_study::{Results, run_on};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

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

    /// Results of a command, with the keys of the program's JSON.
    #[pyo3(name = "_answer")]
    fn answer(&self, py: Python<'_>, command: &str, given: &Bound<'_, PyDict>) -> PyResult<PyAnswered> {
        let request = self.request_of(command, given)?;
        let found = py.detach(|| {
            let mut watch = CtrlC::new();
            let found = run_on(&request, Some((*self.robot).clone()), &mut watch);
            watch.result(found)
        })?;
        Ok(PyAnswered::new(request, found))
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

    /// Deviations of results, from robots that are sampled on all threads, with calls of `progress`.
    #[pyo3(name = "_uncertainty")]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn uncertainty(
        &self,
        py: Python<'_>,
        given: &Bound<'_, PyDict>,
        samples_file: Option<PathBuf>,
        resume: bool,
        discard: bool,
        threads: Option<Threads>,
        progress: Option<ProgressArgument>,
    ) -> PyResult<PyAnswered> {
        let Request::Uncertainty(request) = self.request_of("uncertainty", given)? else {
            unreachable!("the request is of uncertainty")
        };
        let samples = samples_file.map(|path| (path, Begin::of(resume, discard)));
        if samples.is_none() && (resume || discard) {
            return Err(errors::input("`resume` and `discard` need `samples_file`".to_owned()));
        }
        if resume && discard {
            return Err(errors::input("give `resume` or `discard`, not both: one keeps the robots".to_owned()));
        }
        sampled(py, request, samples, threads, progress)
    }

    /// Motion along a path, whose page goes to a file.
    #[pyo3(name = "_trajectory")]
    fn trajectory(&self, py: Python<'_>, given: &Bound<'_, PyDict>, page: Option<PathBuf>) -> PyResult<PyAnswered> {
        let asked = self.request_of("trajectory", given)?;
        let Request::Trajectory(request) = &asked else { unreachable!("the request is of trajectory") };
        answers::try_files(&[page.as_deref()])?;
        let found = py.detach(|| {
            let mut watch = CtrlC::new();
            let found = trajectory::run((*self.robot).clone(), request, &mut watch);
            watch.result(found)
        })?;
        if let Some(path) = page {
            let command_line = format!("robot.trajectory(…, page={:?})", path.display().to_string());
            let page = pages::trajectory::page(&self.robot, &found, command_line);
            let page = page.map_err(|error| errors::study(&error))?;
            answers::write_bytes(path, worded(&page, Words::Python).as_bytes())?;
        }
        Ok(PyAnswered::new(asked, Results::Trajectory(found)))
    }

    /// Calibration, whose page and figure go to files.
    #[pyo3(name = "_calibrate")]
    fn calibrate(
        &self,
        py: Python<'_>,
        given: &Bound<'_, PyDict>,
        page: Option<PathBuf>,
        figure: Option<PathBuf>,
    ) -> PyResult<PyAnswered> {
        let request = self.request_of("calibrate", given)?;
        let is_svg = figure.as_deref().map(figure_is_svg).transpose()?;
        answers::try_files(&[page.as_deref(), figure.as_deref()])?;
        let found = py.detach(|| {
            let mut watch = CtrlC::new();
            let found = run_on(&request, Some((*self.robot).clone()), &mut watch);
            watch.result(found)
        })?;
        if let Results::Calibrate(found) = &found {
            if let Some(path) = page {
                let call = format!("robot.calibrate(…, page={:?})", path.display().to_string());
                let page = pages::calibrate::page(found, call).map_err(|error| errors::study(&error))?;
                answers::write_bytes(path, worded(&page, Words::Python).as_bytes())?;
            }
            if let (Some(path), Some(is_svg)) = (figure, is_svg) {
                write_figure(&figures::of_calibration(found), path, is_svg)?;
            }
        }
        Ok(PyAnswered::new(request, found))
    }

    /// Simulation, whose page, figure and animation go to files.
    #[pyo3(name = "_simulate")]
    fn simulate(
        &self,
        py: Python<'_>,
        given: &Bound<'_, PyDict>,
        page: Option<PathBuf>,
        figure: Option<PathBuf>,
        animation: Option<PathBuf>,
        progress: Option<ProgressArgument>,
    ) -> PyResult<PyAnswered> {
        let asked = self.request_of("simulate", given)?;
        let Request::Simulate(request) = &asked else { unreachable!("the request is of simulate") };
        let is_svg = figure.as_deref().map(figure_is_svg).transpose()?;
        if let Some(path) = animation.as_deref().filter(|path| !figure_is_svg(path).unwrap_or_default()) {
            return Err(errors::input(format!("`animation` {}: the file ends in .svg", path.display())));
        }
        answers::try_files(&[page.as_deref(), figure.as_deref(), animation.as_deref()])?;
        let (found, raised) = py.detach(|| {
            let mut watch = CtrlC::telling(progress);
            let found = simulate::run((*self.robot).clone(), request, &mut watch);
            watch.part(found)
        })?;
        if let Some(raised) = raised {
            return Err(with_part(py, raised, PyAnswered::new(asked, Results::Simulate(Box::new(found)))));
        }
        if let Some(path) = page {
            let call = format!("robot.simulate(…, page={:?})", path.display().to_string());
            let page = pages::simulate::page(&found, call).map_err(|error| errors::study(&error))?;
            answers::write_bytes(path, worded(&page, Words::Python).as_bytes())?;
        }
        if let (Some(path), Some(is_svg)) = (figure, is_svg) {
            write_figure(&figures::of_simulation(&found), path, is_svg)?;
        }
        if let Some(path) = animation {
            answers::write_bytes(path, figures::animation_of_simulation(&found).as_bytes())?;
        }
        Ok(PyAnswered::new(asked, Results::Simulate(Box::new(found))))
    }

    /// Workspace, found on all threads, with calls of `progress`; its surface goes to files.
    #[pyo3(name = "_workspace")]
    fn workspace(
        &self,
        py: Python<'_>,
        given: &Bound<'_, PyDict>,
        surfaces: Vec<PathBuf>,
        page: Option<PathBuf>,
        threads: Option<Threads>,
        progress: Option<ProgressArgument>,
    ) -> PyResult<PyAnswered> {
        let asked = self.request_of("workspace", given)?;
        let Request::Workspace(request) = &asked else { unreachable!("the request is of workspace") };
        let formats: Vec<(SurfaceFormat, PathBuf)> =
            surfaces.into_iter().map(|path| Ok((surface_format(&path)?, path))).collect::<PyResult<_>>()?;
        answers::try_files(&[page.as_deref()])?;
        formats.iter().try_for_each(|(_, path)| answers::try_file(path.clone()))?;
        let study = WorkspaceStudy::new((*self.robot).clone(), request).map_err(|error| errors::study(&error))?;
        let found = workspace_of(py, study, threads, progress)?;
        for (format, path) in formats {
            let bytes = surface::of_workspace(&found, format).map_err(|error| errors::study(&error))?;
            answers::write_bytes(path, &bytes)?;
        }
        if let Some(path) = page {
            let page =
                pages::workspace::page(&found, format!("robot.workspace(…, page={:?})", path.display().to_string()));
            let page = page.map_err(|error| errors::study(&error))?;
            answers::write_bytes(path, worded(&page, Words::Python).as_bytes())?;
        }
        Ok(PyAnswered::new(asked, Results::Workspace(Box::new(found))))
    }
}

/// Exception that stopped work, with the results that are there as its attribute `partial_results`.
fn with_part(py: Python<'_>, raised: PyErr, part: PyAnswered) -> PyErr {
    let attach = || {
        let results = py.import("funicular._results")?.call_method1("of_answered", (part,))?;
        raised.value(py).setattr("partial_results", results)
    };
    // An exception whose class has no room for attributes is raised without the results.
    let _: PyResult<()> = attach();
    raised
}

/// Writes a figure with its usual size.
fn write_figure(figure: &Figure, path: PathBuf, is_svg: bool) -> PyResult<()> {
    let size = Size::new(None, None).map_err(|error| errors::study(&error))?;
    let bytes = if is_svg { figure.svg(size).into_bytes() } else { figure.pdf(size) };
    answers::write_bytes(path, &bytes)
}

/// True for the name of an SVG file, false for that of a PDF file.
fn figure_is_svg(path: &Path) -> PyResult<bool> {
    match path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).as_deref() {
        Some("svg") => Ok(true),
        Some("pdf") => Ok(false),
        _ => Err(errors::input(format!("`figure` {}: the file ends in .svg or .pdf", path.display()))),
    }
}

/// Format of a surface by the ending of its file.
fn surface_format(path: &Path) -> PyResult<SurfaceFormat> {
    let format = path.extension().and_then(|ending| SurfaceFormat::of_ending(&ending.to_string_lossy()));
    let wanted = || errors::input(format!("`surface` {}: the file ends in .stl, .ply or .vtp", path.display()));
    format.ok_or_else(wanted)
}

fn workspace_of(
    py: Python<'_>,
    study: WorkspaceStudy,
    threads: Option<Threads>,
    progress: Option<ProgressArgument>,
) -> PyResult<Workspace> {
    let threads = Threads::of(threads);
    let outcome = interruptible_by_flag(py, move |cancel| {
        let mut raised = None;
        let mut report = |done: usize, total: usize, _: &'static str| {
            if let (Some(ProgressArgument(function)), None) = (&progress, &raised) {
                raised = Python::attach(|py| function.call1(py, (done, total)).err());
                cancel.fetch_or(raised.is_some(), Ordering::Relaxed);
            }
        };
        let found = WorkspaceRun { threads, cancel }.run(&study, &mut report)?;
        Ok::<_, anyhow::Error>((found, raised))
    })?;

    let (found, raised) = outcome.map_err(|error| errors::study(&error))?;
    match (found, raised) {
        (_, Some(raised)) => Err(raised),
        (Some(found), None) => Ok(found),
        // Only Ctrl-C stops the work, and its exception has been raised before.
        (None, None) => Err(PyKeyboardInterrupt::new_err("stopped before anything was found")),
    }
}

fn sampled(
    py: Python<'_>,
    request: UncertaintyRequest,
    samples: Option<(PathBuf, Begin)>,
    threads: Option<Threads>,
    progress: Option<ProgressArgument>,
) -> PyResult<PyAnswered> {
    let threads = Threads::of(threads);
    let asked = Request::Uncertainty(request.clone());
    let outcome = interruptible_by_flag(py, move |cancel| {
        let study = UncertaintyStudy::new(&request)?;
        let samples = samples.as_ref().map(|(path, begin)| (path.as_path(), *begin));
        let mut raised = None;
        let mut report = |done: usize, total: usize, _: &'static str| {
            if let (Some(ProgressArgument(function)), None) = (&progress, &raised) {
                raised = Python::attach(|py| function.call1(py, (done, total)).err());
            }
        };
        let outcome = UncertaintyRun { threads, samples, cancel }.run(&study, &mut report)?;
        Ok::<_, anyhow::Error>((outcome, raised))
    })?;

    let (outcome, raised) = outcome.map_err(|error| errors::study(&error))?;
    if let Some(raised) = raised {
        return Err(raised);
    }
    match outcome {
        UncertaintyOutcome::Complete(found) => Ok(PyAnswered::new(asked, Results::Uncertainty(*found))),
        // Only Ctrl-C stops the work, and its exception has been raised before.
        UncertaintyOutcome::Stopped(reason) => Err(PyKeyboardInterrupt::new_err(reason)),
    }
}

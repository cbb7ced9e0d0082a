//! What is asked of which points: as Python hands it over, as it travels to workers, and as the core has it.

use super::work::PyWork;
use crate::arrays::Reduced;
use crate::errors;
use crate::names;
use crate::request::{Asked, Options};
use crate::robot::PyRobot;
use crate::threads::Threads;
use crate::waiting::hand_over;
use funicular::robot::{Freedoms, Pose, Robot, State};
use funicular::statics;
use funicular::sweep::{Chunk, Plan, Points, Poses, Quantity, Steps};
use funicular_files::{Begin, Grid, Job, Opened, Record, Source, Variation, Variations, edit, table};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde::{Deserialize, Serialize};
use std::num::NonZeroUsize;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::sync_channel;
use std::thread;

/// Chunks that may wait between the threads and who takes them.
const WAITING: usize = 8;

/// Values along an axis.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(untagged)]
pub(crate) enum StepsAsked {
    Range { from: f64, to: f64, count: usize },
    List { values: Vec<f64> },
}

impl StepsAsked {
    fn steps(&self, name: &str) -> PyResult<Steps> {
        match self {
            Self::Range { from, to, count } => {
                Steps::range(*from, *to, *count).map_err(|reason| errors::input(format!("`{name}`: {reason}")))
            }
            Self::List { values } => Ok(Steps::List(values.clone())),
        }
    }
}

/// Where the points are.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum PointsAsked {
    Grid(Vec<(String, StepsAsked)>),
    Poses(Vec<[f64; 6]>),
    Vary(Vec<(String, StepsAsked)>),
}

/// All that is asked; with the text of a robot file it is the same rows everywhere.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Request {
    pub(crate) points: PointsAsked,
    pub(crate) quantities: Vec<String>,
    pub(crate) model: String,
    pub(crate) tension_rule: Option<String>,
    pub(crate) wanted_tension_n: Option<Vec<f64>>,
    pub(crate) min_tension_n: Option<f64>,
    pub(crate) max_tension_n: Option<f64>,
    pub(crate) force_n: Option<[f64; 3]>,
    pub(crate) moment_n_m: Option<[f64; 3]>,
    pub(crate) load_point_m: Option<[f64; 3]>,
    pub(crate) cable_model: Option<String>,
    pub(crate) assembly: String,
    pub(crate) in_plane_only: bool,
    pub(crate) up_to_hz: f64,
    pub(crate) pose: Option<[f64; 6]>,
    pub(crate) lengths: Option<Vec<f64>>,
}

impl Request {
    fn statics(&self) -> PyResult<Options> {
        Ok(Options {
            model: names::static_model(&self.model)?,
            rule: names::tension_rule(self.tension_rule.as_deref(), self.wanted_tension_n.clone())?,
            limits: funicular::robot::TensionLimits { minimum: self.min_tension_n, maximum: self.max_tension_n },
            force_n: self.force_n,
            moment_n_m: self.moment_n_m,
            load_point_m: self.load_point_m,
        })
    }

    fn state(&self) -> PyResult<Asked> {
        match (self.pose, &self.lengths) {
            (Some(_), Some(_)) => Err(errors::input("give `pose` or `lengths`, not both".to_owned())),
            (Some([x, y, z, roll, pitch, yaw]), None) => Ok(Asked::Pose(Pose::new([x, y, z], [roll, pitch, yaw]))),
            (None, Some(lengths)) => Ok(Asked::Lengths(lengths.clone())),
            (None, None) => Ok(Asked::OfFile),
        }
    }

    fn options(&self, robot: &Robot, statics: &Options) -> PyResult<funicular::sweep::Options> {
        let (cables, freedoms) = (robot.cables.len(), robot.platform.freedoms.count());
        if statics.rule.is_some() && cables <= freedoms {
            return Err(errors::input(format!(
                "a tension rule has nothing to choose: {cables} cables for {freedoms} freedoms have one set of tensions \
                 at a pose; leave out `tension_rule` and `wanted_tension_n`"
            )));
        }
        Ok(funicular::sweep::Options {
            static_model: statics.model,
            tension_rule: statics.rule.clone().unwrap_or_default(),
            linearisation: names::linearisation(
                self.cable_model.as_deref(),
                &self.assembly,
                self.in_plane_only,
                statics.model,
            )?,
            highest_hz: self.up_to_hz,
        })
    }
}

/// The points as the core has them.
enum Found {
    Grid { poses: Poses, base: Option<Pose> },
    List { poses: Poses, rows: Vec<[f64; 6]> },
    Values { robots: Variations<'static>, grid: Grid },
}

impl Found {
    fn points(&self) -> &dyn Points {
        match self {
            Self::Grid { poses, .. } | Self::List { poses, .. } => poses,
            Self::Values { robots, .. } => robots,
        }
    }

    fn source(&self) -> Source<'_> {
        match self {
            Self::Grid { poses, base } => Source::Grid { poses, base: base.as_ref() },
            Self::List { rows, .. } => Source::List(rows),
            Self::Values { grid, .. } => Source::Values(grid),
        }
    }
}

/// A plan with all that it is made of.
pub(crate) struct Whole {
    robot: Robot,
    found: Found,
    quantities: Vec<Quantity>,
    options: funicular::sweep::Options,
    pub(crate) record: Record,
}

fn plan_of<'a>(
    robot: &Robot,
    found: &'a Found,
    quantities: &'a [Quantity],
    options: &'a funicular::sweep::Options,
) -> PyResult<Plan<'a>> {
    Plan::new(found.points(), robot, quantities, options).map_err(|error| errors::input(error.to_string()))
}

impl Whole {
    fn of(file: &PyRobot, request: &Request) -> PyResult<Self> {
        let (statics, state) = (request.statics()?, request.state()?);
        let (robot, found) = match &request.points {
            PointsAsked::Vary(axes) => varied(file, axes, statics.clone(), state)?,
            PointsAsked::Grid(axes) => {
                let robot = state.robot(statics.robot(&file.robot)?)?;
                let base = base(&robot, &statics)?;
                let axes: PyResult<Vec<(String, Steps)>> =
                    axes.iter().map(|(name, steps)| Ok((name.clone(), steps.steps(name)?))).collect();
                let poses = Poses::grid(robot.clone(), &axes?, base.as_ref())
                    .map_err(|error| errors::input(error.to_string()))?;
                (robot, Found::Grid { poses, base })
            }
            PointsAsked::Poses(rows) => {
                if request.pose.is_some() || request.lengths.is_some() {
                    return Err(errors::input(
                        "`poses` says where the platform is: leave out `pose` and `lengths`".to_owned(),
                    ));
                }
                let robot = state.robot(statics.robot(&file.robot)?)?;
                let turned = |row: &[f64; 6]| row[3..].iter().any(|angle| *angle != 0.0);
                if robot.platform.freedoms == Freedoms::PointMass && rows.iter().any(turned) {
                    return Err(errors::input("a point mass has no orientation: give poses of x, y, z".to_owned()));
                }
                let (poses, rows) = (Poses::list(robot.clone(), rows.clone()), rows.clone());
                (robot, Found::List { poses, rows })
            }
        };
        let quantities: PyResult<Vec<Quantity>> = request
            .quantities
            .iter()
            .map(|name| {
                name.parse().map_err(|error: funicular::sweep::UnknownQuantity| errors::input(error.to_string()))
            })
            .collect();
        let (quantities, options) = (quantities?, request.options(&robot, &statics)?);
        let vector = |given: Option<[f64; 3]>| given.map(Into::into);
        let asked = funicular_files::Asked {
            options: &options,
            quantities: &quantities,
            wanted_tension_n: request.wanted_tension_n.as_deref(),
            min_tension_n: request.min_tension_n,
            max_tension_n: request.max_tension_n,
            pose: request.pose,
            lengths_m: request.lengths.as_deref(),
            mass_kg: None,
            force_n: vector(request.force_n),
            moment_n_m: vector(request.moment_n_m),
            load_point_m: vector(request.load_point_m),
            wind_m_s: None,
            cable_load_n_per_m: None,
        };
        let plan = plan_of(&robot, &found, &quantities, &options)?;
        let record = Record::of(&plan, file.text.clone(), &robot.name, found.source(), &asked, None);
        Ok(Self { robot, found, quantities, options, record })
    }

    /// Computes chunks on threads of this call alone, and hands them over in order to this one, which looks for Ctrl-C.
    pub(crate) fn run(
        &self,
        chunks: Range<usize>,
        threads: NonZeroUsize,
        mut take: impl FnMut(Chunk) -> PyResult<()>,
        mut look: impl FnMut() -> PyResult<()>,
    ) -> PyResult<()> {
        let plan = plan_of(&self.robot, &self.found, &self.quantities, &self.options)?;
        let cancel = AtomicBool::new(false);
        thread::scope(|scope| {
            let (sender, receiver) = sync_channel(WAITING);
            let (plan, cancel) = (&plan, &cancel);
            let runner = scope.spawn(move || plan.run(chunks, threads, cancel, |chunk| sender.send(chunk)));
            let ended = hand_over(&receiver, cancel, &mut take, &mut look);
            // Nobody takes the rest.
            cancel.store(true, Ordering::Relaxed);
            drop(receiver);
            match runner.join() {
                Err(panic) => std::panic::resume_unwind(panic),
                Ok(_) => ended,
            }
        })
    }
}

/// Robots of which values vary, and the first of them.
fn varied(file: &PyRobot, axes: &[(String, StepsAsked)], statics: Options, state: Asked) -> PyResult<(Robot, Found)> {
    let axes: PyResult<Vec<Variation>> = axes
        .iter()
        .map(|(name, steps)| {
            let path = edit::path(name).map_err(|reason| errors::input(format!("`vary`: {reason}")))?;
            Ok(Variation { path, steps: steps.steps(name)? })
        })
        .collect();
    let adjust = Box::new(move |robot: Robot| state.put(statics.adjusted(&robot)?));
    let robots = Variations::new(file.text.clone(), axes?, "vary", adjust).map_err(errors::change)?;
    let robot = robots.first().map_err(errors::change)?;
    if robot.state == State::Unknown {
        return Err(errors::input(
            "the robot has no state: give `lengths` or `pose`, or give every cable of the robot file an \
             `unstrained_length_m`, or the file a [state] with `position_m`"
                .to_owned(),
        ));
    }
    let grid = Grid(robots.axes().iter().map(|axis| (axis.path.text.clone(), axis.steps.clone())).collect());
    Ok((robot, Found::Values { robots, grid }))
}

/// Where the axes stay that a grid does not have.
fn base(robot: &Robot, statics: &Options) -> PyResult<Option<Pose>> {
    Ok(match &robot.state {
        State::Pose(pose) => Some(*pose),
        State::Unknown => None,
        State::Lengths(lengths) => {
            let rest =
                statics::forward(robot, lengths, statics.model, None).map_err(|error| errors::statics(&error))?;
            Some(rest.pose)
        }
    })
}

/// What is asked of which points; a pickle of it is the text of the robot file and the request.
#[pyclass(frozen, name = "SweepPlan", module = "funicular._funicular")]
pub(crate) struct PyPlan {
    robot: Py<PyRobot>,
    request: Request,
    pub(crate) whole: Arc<Whole>,
}

impl PyPlan {
    pub(crate) fn of(robot: Py<PyRobot>, request: Request) -> PyResult<Self> {
        let whole = Arc::new(Whole::of(robot.get(), &request)?);
        Ok(Self { robot, request, whole })
    }
}

#[pymethods]
impl PyPlan {
    /// Of a robot and a request as JSON.
    #[new]
    fn new(robot: Py<PyRobot>, request: &str) -> PyResult<Self> {
        let request =
            serde_json::from_str(request).map_err(|error| errors::input(format!("this is no request: {error}")))?;
        Self::of(robot, request)
    }

    /// Number of rows.
    #[getter]
    fn rows(&self) -> usize {
        self.whole.record.rows
    }

    /// Number of chunks of rows; each is computed by itself.
    #[getter]
    fn chunks(&self) -> usize {
        self.whole.record.chunks()
    }

    /// Rows of every chunk but the last.
    #[getter]
    fn chunk_rows(&self) -> usize {
        self.whole.record.chunk_rows
    }

    /// Chunks from `first` to before `end`, as bytes that `SweepWork.add` takes.
    #[pyo3(signature = (first, end, threads=Threads(NonZeroUsize::MIN)))]
    fn compute<'py>(
        &self,
        py: Python<'py>,
        first: usize,
        end: usize,
        threads: Threads,
    ) -> PyResult<Bound<'py, PyBytes>> {
        if first > end || end > self.chunks() {
            return Err(errors::input(format!("there are no chunks {first} to {end} of {}", self.chunks())));
        }
        let mut bytes = Vec::new();
        py.detach(|| {
            self.whole.run(
                first..end,
                threads.0,
                |chunk| table::pack(&mut bytes, &chunk).map_err(PyErr::from),
                crate::waiting::look,
            )
        })?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Begins to collect rows, in memory or in a file; None if the file has them all.
    #[pyo3(signature = (file=None, resume=false, force=false))]
    fn begin(&self, py: Python<'_>, file: Option<PathBuf>, resume: bool, force: bool) -> PyResult<Option<PyWork>> {
        let begin = match (resume, force) {
            (true, true) => return Err(errors::input("give `resume` or `force`, not both".to_owned())),
            (true, false) => Begin::Resume,
            (false, true) => Begin::Discard,
            (false, false) => Begin::Anew,
        };
        let whole = Arc::clone(&self.whole);
        let Some(path) = file else {
            if resume || force {
                return Err(errors::input("`resume` and `force` go with `file`".to_owned()));
            }
            return Ok(Some(PyWork::in_memory(whole)));
        };
        let opened =
            py.detach(|| Job::open(&path, whole.record.clone(), begin)).map_err(|error| errors::files(&error))?;
        Ok(match opened {
            Opened::Done => None,
            Opened::Work(job) => Some(PyWork::in_file(whole, *job, path)),
        })
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py, (Py<PyRobot>, String)>> {
        let this = slf.get();
        let request = serde_json::to_string(&this.request).map_err(|error| errors::input(error.to_string()))?;
        Ok((slf.get_type().into_any(), (this.robot.clone_ref(slf.py()), request)))
    }
}

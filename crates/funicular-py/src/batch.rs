//! Equilibria of many states of one robot, computed in parallel.

use crate::arrays::{Matrix, Numbers, Vector};
use crate::errors;
use crate::interrupt::{check_signals, on_threads};
use crate::pose;
use crate::robot::PyRobot;
use crate::threads::Threads;
use funicular::cable::Sag;
use funicular::math::rotation;
use funicular::robot::{Robot, State};
use funicular::statics::{self, Solution, StaticModel, TensionRule};
use funicular_study::at_rest;
use funicular_study::request::{State as SharedState, Tensions};
use funicular_study::values;
use funicular_study::wording::{Words, told};
use pyo3::inspect::PyStaticExpr;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::convert::Infallible;
use std::ops::Range;

/// Number of states that a thread takes at once: some milliseconds.
const BLOCK: usize = 64;

/// `funicular.Equilibria`.
pub(crate) struct Equilibria(Py<PyAny>);

impl<'py> IntoPyObject<'py> for Equilibria {
    type Target = PyAny;
    type Output = Bound<'py, PyAny>;
    type Error = Infallible;

    const OUTPUT_TYPE: PyStaticExpr =
        PyStaticExpr::Attribute { value: &PyStaticExpr::Name { id: "funicular._results" }, attr: "Equilibria" };

    fn into_pyobject(self, py: Python<'py>) -> Result<Self::Output, Self::Error> {
        Ok(self.0.into_bound(py))
    }
}

/// States to solve: rows of poses or of unstrained lengths.
pub(crate) struct States {
    poses: bool,
    flat: Vec<f64>,
    columns: usize,
}

impl States {
    pub(crate) fn read(poses: Option<Numbers>, lengths_m: Option<Numbers>, cables: &[String]) -> PyResult<Self> {
        match (poses, lengths_m) {
            (Some(poses), None) => {
                let (flat, columns) = poses.poses("poses")?;
                if ![3, 6, 7].contains(&columns) {
                    return Err(errors::input(format!(
                        "`poses` has rows of {columns} numbers: give x, y, z, these and roll, pitch, yaw in degrees, \
                         or these and a quaternion w, x, y, z"
                    )));
                }
                Ok(Self { poses: true, flat, columns })
            }
            (None, Some(lengths)) => {
                let flat = lengths.rows_per_cable("lengths_m", cables)?;
                Ok(Self { poses: false, flat, columns: cables.len() })
            }
            _ => Err(errors::input("give `poses` or `lengths_m`, one of them".to_owned())),
        }
    }

    fn count(&self) -> usize {
        self.flat.len() / self.columns.max(1)
    }

    /// State of a row, or the reason why the row is no state.
    fn state(&self, robot: &Robot, row: usize) -> Result<State, String> {
        let row = &self.flat[row * self.columns..(row + 1) * self.columns];
        if self.poses {
            let text = |error: anyhow::Error| told(&format!("{error:#}"), Words::Python);
            let pose = pose::of_row("pose", row)?.to_robot().map_err(text)?;
            at_rest::check_pose(robot, &pose).map_err(text)?;
            return Ok(State::Pose(pose));
        }
        for length in row {
            values::finite(*length).map_err(|reason| format!("an unstrained length: {reason}"))?;
        }
        Ok(State::Lengths(row.to_vec()))
    }
}

/// Result of one state: its numbers, or a code and a reason.
type StateResult = Result<StateNumbers, (&'static str, String)>;

/// Numbers of one equilibrium that go into columns.
struct StateNumbers {
    pose: [f64; 10],
    /// Per cable: unstrained length, tensions at platform and anchor, sag ratio.
    cables: Vec<[f64; 4]>,
    residual: f64,
    /// `None` for ideal cables.
    stable: Option<bool>,
    min_stiffness: f64,
    distance: f64,
}

impl StateNumbers {
    fn of(robot: &Robot, rest: &Solution) -> Self {
        let Solution { equilibrium, requested_pose, .. } = rest;
        let (p, rot_wp) = (&equilibrium.pose.position_w, &equilibrium.pose.rot_wp);
        let [w, i, j, k] = rotation::quaternion_wxyz(rot_wp);
        let [roll, pitch, yaw] = rotation::to_roll_pitch_yaw_deg(&pose::PyPose::of(&equilibrium.pose).0.rot_wp);

        let cables = equilibrium.cables.iter().enumerate().map(|(at, cable)| {
            let sag = Sag::of(robot, at, cable);
            let ratio = if sag.tension > 0.0 { sag.ratio() } else { f64::NAN };
            [cable.unstrained_length, cable.tension_platform, cable.tension_anchor, ratio]
        });

        Self {
            pose: [p.x, p.y, p.z, w, i, j, k, roll, pitch, yaw],
            cables: cables.collect(),
            residual: equilibrium.residual,
            stable: equilibrium.stability.is_stable(),
            min_stiffness: equilibrium.stability.min_stiffness().unwrap_or(f64::NAN),
            distance: requested_pose.map_or(f64::NAN, |(_, distance)| distance),
        }
    }
}

/// Problem that is solved for every state.
struct StateSolver<'a> {
    robot: &'a Robot,
    /// Robot whose unstrained lengths at each pose are held.
    holder: Option<&'a Robot>,
    states: &'a States,
    model: StaticModel,
    rule: Option<TensionRule>,
}

impl StateSolver<'_> {
    fn row(&self, robot: &mut Robot, holder: Option<&mut Robot>, row: usize) -> StateResult {
        robot.state = self.states.state(robot, row).map_err(|reason| ("input", reason))?;
        let solution = match holder {
            None => statics::solve(robot, self.model, self.rule.clone()),
            Some(holder) => {
                holder.state = robot.state.clone();
                statics::solve_held(holder, robot, self.model, self.rule.clone())
            }
        };
        match solution {
            Ok(rest) => Ok(StateNumbers::of(robot, &rest)),
            Err(error) => Err((error.code(), error.to_string())),
        }
    }

    /// Results of a block of states.
    fn block(&self, index: usize) -> (Range<usize>, Vec<StateResult>) {
        let (mut robot, mut holder) = (self.robot.clone(), self.holder.cloned());
        let rows = index * BLOCK..((index + 1) * BLOCK).min(self.states.count());
        let found = rows.clone().map(|row| self.row(&mut robot, holder.as_mut(), row)).collect();
        (rows, found)
    }
}

pub(crate) fn equilibria(
    py: Python<'_>,
    of: &PyRobot,
    states: States,
    state: &SharedState,
    tensions: &Tensions,
    threads: Option<Threads>,
) -> PyResult<Equilibria> {
    let prepared = || {
        let robot = at_rest::with_limits(&at_rest::with_state((*of.robot).clone(), state)?, tensions)?;
        let holder = state.hold_lengths_of_pose.then(|| at_rest::holder(&of.source, state, tensions)).transpose()?;
        if holder.is_some() && !states.poses {
            anyhow::bail!("give ⟪lengths_m⟫ or ⟪hold_lengths_of_pose⟫, not both: both give the lengths");
        }
        anyhow::Ok((robot, holder, at_rest::rule(tensions)?))
    };
    let (robot, holder, rule) = prepared().map_err(|error| errors::study(&error))?;

    let model = state.static_model;
    let mut columns = Columns::new(robot.cables.len(), states.count());
    let solver = StateSolver { robot: &robot, holder: holder.as_ref(), states: &states, model, rule };
    let blocks = 0..states.count().div_ceil(BLOCK);

    let put = |(rows, found)| {
        columns.put(rows, found);
        Ok(())
    };
    py.detach(|| on_threads(blocks, Threads::of(threads), |index, _| Some(solver.block(index)), put, check_signals))?;
    columns.into_python(py, model).map(Equilibria)
}

/// Columns of the result; NaN in rows without an equilibrium.
struct Columns {
    cables: usize,
    pose: [Vec<f64>; 3],
    of_cables: [Vec<f64>; 4],
    residual: Vec<f64>,
    /// Without meaning for ideal cables.
    stable: Vec<bool>,
    min_stiffness: Vec<f64>,
    distance: Vec<f64>,
    status: Vec<&'static str>,
    reason: Vec<String>,
}

/// Places of position, quaternion and angles among the numbers of a pose.
const POSE: [Range<usize>; 3] = [0..3, 3..7, 7..10];

impl Columns {
    fn new(cables: usize, count: usize) -> Self {
        let nan = |width: usize| vec![f64::NAN; count * width];
        Self {
            cables,
            pose: POSE.map(|places| nan(places.len())),
            of_cables: [(); 4].map(|()| nan(cables)),
            residual: nan(1),
            stable: vec![false; count],
            min_stiffness: nan(1),
            distance: nan(1),
            status: vec!["ok"; count],
            reason: vec![String::new(); count],
        }
    }

    fn put(&mut self, rows: Range<usize>, found: Vec<StateResult>) {
        for (row, found) in rows.zip(found) {
            match found {
                Err((code, reason)) => (self.status[row], self.reason[row]) = (code, reason),
                Ok(found) => {
                    for (column, places) in self.pose.iter_mut().zip(POSE) {
                        let width = places.len();
                        column[row * width..(row + 1) * width].copy_from_slice(&found.pose[places]);
                    }

                    for (i, column) in self.of_cables.iter_mut().enumerate() {
                        let here = &mut column[row * self.cables..(row + 1) * self.cables];
                        here.iter_mut().zip(&found.cables).for_each(|(to, from)| *to = from[i]);
                    }

                    self.residual[row] = found.residual;
                    self.stable[row] = found.stable.unwrap_or(false);
                    self.min_stiffness[row] = found.min_stiffness;
                    self.distance[row] = found.distance;
                }
            }
        }
    }

    fn into_python(self, py: Python<'_>, model: StaticModel) -> PyResult<Py<PyAny>> {
        let fields = PyDict::new(py);
        let numpy = py.import("numpy")?;
        fields.set_item("status", numpy.call_method1("array", (self.status, "U18"))?)?;
        fields.set_item("reason", pyo3::types::PyTuple::new(py, self.reason)?)?;

        let [position, quaternion, angles] = self.pose;
        fields.set_item("position_m", Matrix::of_rows(position, 3))?;
        fields.set_item("quaternion_wxyz", Matrix::of_rows(quaternion, 4))?;
        fields.set_item("roll_pitch_yaw_deg", Matrix::of_rows(angles, 3))?;

        let [unstrained_length, tension_platform, tension_anchor, sag_ratio] = self.of_cables;
        fields.set_item("unstrained_length_m", Matrix::of_rows(unstrained_length, self.cables))?;
        fields.set_item("tension_platform_n", Matrix::of_rows(tension_platform, self.cables))?;
        fields.set_item("tension_anchor_n", Matrix::of_rows(tension_anchor, self.cables))?;
        fields.set_item("sag_ratio", Matrix::of_rows(sag_ratio, self.cables))?;

        fields.set_item("residual", Vector::<f64>::from_iter(self.residual))?;
        let stable = (model != StaticModel::Ideal).then(|| Vector::<bool>::from_iter(self.stable));
        fields.set_item("stable", stable)?;
        fields.set_item("stiffness_min_n_per_m", Vector::<f64>::from_iter(self.min_stiffness))?;
        fields.set_item("nearest_pose_distance_m", Vector::<f64>::from_iter(self.distance))?;
        fields.set_item("static_model", model.name())?;
        Ok(py.import("funicular._results")?.getattr("Equilibria")?.call((), Some(&fields))?.unbind())
    }
}

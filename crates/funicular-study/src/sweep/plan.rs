//! Many points of a robot's workspace, or of its parameters, one row each.
//!
//! A [`Plan`] is what is asked: points in a fixed order, quantities, options. Its rows come in chunks of a size that
//! the plan alone determines, and every row is computed from its own point alone, so that a row is the same bit for bit
//! whatever the number of threads, however the chunks are shared between machines, and wherever a run was interrupted.
//! A point without an equilibrium is a row, with a [code](super::CODES) and a reason; what does not exist is `None`, never NaN.

use super::columns::{Chunk, Column, Kind, Value, Values};
use super::points::Points;
use super::quantity::Quantity;
use super::row;
use super::status::Status;
use funicular::dynamics::Linearisation;
use funicular::robot::Robot;
use funicular::statics::{self, StaticModel, StaticsError, TensionRule};
use thiserror::Error;

/// How every point is computed.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// How cables carry their static load.
    pub static_model: StaticModel,
    /// Which tensions a pose has, for robots with more cables than degrees of freedom.
    pub tension_rule: TensionRule,
    /// How cables answer motion, for natural frequencies.
    pub linearisation: Linearisation,
    /// Where the search for natural frequencies ends [Hz].
    pub highest_hz: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            static_model: StaticModel::default(),
            tension_rule: TensionRule::default(),
            linearisation: Linearisation::default(),
            highest_hz: MAX_HZ,
        }
    }
}

/// Default of [`Options::highest_hz`]: far above the first frequency of any cable robot, low enough to end.
pub const MAX_HZ: f64 = 1000.0;

/// Most points of a plan.
pub const MAX_POINTS: usize = 100_000_000;

/// Most rows of a chunk: some milliseconds of work where only statics is asked, some seconds with natural frequencies.
const MAX_ROWS: usize = 256;

/// Chunks that a small plan is cut into at least, so that all cores have work to the end.
const MIN_CHUNKS: usize = 64;

/// Why a sweep cannot be.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SweepError {
    /// No such axis.
    #[error("there is no axis `{axis}`: x, y, z are positions [m], roll, pitch, yaw angles [degrees]")]
    UnknownAxis {
        /// As given.
        axis: String,
    },
    /// An axis twice.
    #[error("the axis `{axis}` is given twice: one grid has it once")]
    RepeatedAxis {
        /// Its name.
        axis: String,
    },
    /// A value twice on an axis.
    #[error("the axis `{axis}` has the value {value} twice: leave one out")]
    RepeatedValue {
        /// Name of the axis.
        axis: String,
        /// The value [m, degrees].
        value: f64,
    },
    /// An axis along which the platform cannot move.
    #[error("the platform cannot move along the axis `{axis}`: its degrees of freedom are {dof}, which has {has}")]
    NoSuchMotion {
        /// The axis.
        axis: &'static str,
        /// Name of the degrees of freedom.
        dof: &'static str,
        /// Axes that it has.
        has: String,
    },
    /// A position without a value.
    #[error(
        "the grid has no `{axis}`, and neither the robot nor an option gives a pose to take it from: add the axis, or a pose"
    )]
    NoPosition {
        /// The axis.
        axis: &'static str,
    },
    /// Nothing to compute.
    #[error("there are no points to compute: give at least one")]
    NoPoints,
    /// Too much to compute.
    #[error(
        "{count} points are more than the {MAX_POINTS} that one sweep may have: take larger steps, or several sweeps"
    )]
    TooMany {
        /// How many.
        count: String,
    },
    /// Nothing asked.
    #[error("no quantity is asked for: name one, as tension-max")]
    NoQuantity,
    /// A column twice.
    #[error("the column `{column}` would be there twice: ask for each quantity once")]
    RepeatedColumn {
        /// Its name.
        column: String,
    },
    /// A quantity that the static model does not have.
    #[error("`{quantity}` does not exist with the static model `{}`: use the default, catenary", .model.name())]
    NotWithModel {
        /// Name of the quantity.
        quantity: String,
        /// The model.
        model: StaticModel,
    },
    /// Options that fit no point.
    #[error(transparent)]
    Statics(#[from] StaticsError),
}

/// What is asked of which points.
pub struct Plan<'a> {
    points: &'a dyn Points,
    quantities: &'a [Quantity],
    options: &'a Options,
    /// Number of points.
    rows: usize,
    columns: Vec<Column>,
    /// Columns behind the coordinates.
    width: usize,
    /// Fewer cables than degrees of freedom: poses asked are not the poses found.
    with_distance: bool,
}

impl<'a> Plan<'a> {
    /// Of points, quantities and options. `robot` is one that the points have: the number and the names of its cables, and
    /// its degrees of freedom, are those of every point.
    ///
    /// # Errors
    /// [`SweepError`] if there is nothing to compute, too much, or something that no point can have.
    ///
    /// # Example
    /// ```
    /// use funicular::robot::Robot;
    /// use funicular_study::sweep::{Options, Plan, Poses, Quantity, Steps, Values};
    ///
    /// let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM)?;
    /// let axes = [("x", Steps::range(-5.0, 5.0, 11)?), ("y", Steps::List(vec![0.0])), ("z", Steps::List(vec![0.5]))];
    /// let poses = Poses::grid(robot.clone(), &axes.map(|(axis, steps)| (axis.to_owned(), steps)), None)?;
    /// let (quantities, options) = (["tension-max".parse::<Quantity>()?], Options::default());
    /// let plan = Plan::new(&poses, &robot, &quantities, &options)?;
    /// let mut rows = Vec::new();
    /// for chunk in (0..plan.chunks()).filter_map(|index| plan.evaluate(index, || false)) {
    ///     let [.., Values::Text(status), _, Values::Real(tension_max)] = &chunk.columns[..] else { unreachable!() };
    ///     rows.extend(status.iter().cloned().zip(tension_max.iter().copied()));
    /// }
    /// assert_eq!(rows[0], (Some("negative-tension".into()), None));
    /// assert!((rows[5].1.unwrap() - 55.174).abs() < 1e-3); // N, in the middle
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(
        points: &'a dyn Points,
        robot: &Robot,
        quantities: &'a [Quantity],
        options: &'a Options,
    ) -> Result<Self, SweepError> {
        let rows = points.count();
        match rows {
            0 => return Err(SweepError::NoPoints),
            usize::MAX => return Err(SweepError::TooMany { count: format!("{:.0e} and more", usize::MAX as f64) }),
            rows if rows > MAX_POINTS => return Err(SweepError::TooMany { count: rows.to_string() }),
            _ => {}
        }
        if quantities.is_empty() {
            return Err(SweepError::NoQuantity);
        }
        if let Some(quantity) = quantities.iter().find(|quantity| quantity.excludes(options.static_model)) {
            return Err(SweepError::NotWithModel { quantity: quantity.name(), model: options.static_model });
        }
        let with_distance = robot.cables.len() < robot.platform.motion.count();
        let of_points = points.columns();
        let of_rows = row_columns(robot, quantities, with_distance);
        let width = of_rows.len();
        let columns: Vec<Column> = of_points.into_iter().chain(of_rows).collect();
        for (i, column) in columns.iter().enumerate() {
            if columns[..i].iter().any(|other| other.name == column.name) {
                return Err(SweepError::RepeatedColumn { column: column.name.clone() });
            }
        }
        let plan = Self { points, quantities, options, rows, columns, width, with_distance };
        plan.check_first()?;
        Ok(plan)
    }

    /// What is wrong at the first point and would be at every other.
    fn check_first(&self) -> Result<(), SweepError> {
        let first = self.points.point(0);
        let Ok((robot, state)) = &first.robot else { return Ok(()) };
        let Options { static_model, tension_rule, .. } = self.options;
        match statics::solve_at(robot, state, *static_model, tension_rule) {
            Err(error) if Status::of_error(&error).code == "invalid-state" => Err(error.into()),
            _ => Ok(()),
        }
    }

    /// The columns of the rows: coordinates, `feasible`, `status`, `reason`, then the quantities.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Rows of every chunk but the last, which may have fewer.
    pub fn chunk_rows(&self) -> usize {
        (self.rows / MIN_CHUNKS).clamp(1, MAX_ROWS)
    }

    /// Number of chunks.
    pub fn chunks(&self) -> usize {
        self.rows.div_ceil(self.chunk_rows())
    }

    /// Chunk `index`; `None` if it was given up, which is asked between two rows.
    pub fn evaluate(&self, index: usize, given_up: impl Fn() -> bool) -> Option<Chunk> {
        let begin = index * self.chunk_rows();
        let end = (begin + self.chunk_rows()).min(self.rows);
        let mut columns: Vec<Values> =
            self.columns.iter().map(|column| Values::new(column.kind, end - begin)).collect();
        let mut row = Vec::with_capacity(columns.len());
        for i in begin..end {
            if given_up() {
                return None;
            }
            let point = self.points.point(i);
            row.clear();
            row.extend(point.coordinates.iter().map(|value| Value::real(Some(*value))));
            row::cells(&point, self.quantities, self.options, self.with_distance, self.width, &mut row);
            for (column, value) in columns.iter_mut().zip(row.drain(..)) {
                column.push(value);
            }
        }
        Some(Chunk { index, columns })
    }
}

/// Columns behind the coordinates.
fn row_columns(robot: &Robot, quantities: &[Quantity], with_distance: bool) -> Vec<Column> {
    let own = |name: &str, about: &str, kind| Column {
        name: name.to_owned(),
        unit: "".into(),
        about: about.to_owned(),
        kind,
    };
    let mut columns = vec![
        own("feasible", "there is an equilibrium with tensions within the limits", Kind::Flag),
        own("status", "ok, or a short code of what is missing and why", Kind::Text),
        own("reason", "the same with its numbers", Kind::Text),
    ];
    if with_distance {
        columns.push(Column {
            name: "nearest_pose_distance_m".to_owned(),
            unit: "m".into(),
            about: "distance of the pose found from the one asked, which so few cables do not hold".to_owned(),
            kind: Kind::Real,
        });
    }
    columns.extend(quantities.iter().flat_map(|quantity| quantity.columns(robot)));
    columns
}

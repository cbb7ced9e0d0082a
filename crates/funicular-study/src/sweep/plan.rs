//! Plan of many points in a robot's workspace or of its parameters, with one row per point.
//!
//! A [`Plan`] is a set of points in a fixed order with quantities and options. Its rows come in chunks. The plan alone
//! determines the size of the chunks, and every row is computed from its own point alone. A row is therefore the same
//! bit for bit for any number of threads, for any distribution of the chunks over machines, and after any interruption.
//! A point without an equilibrium has a row too, with a [code](super::CODES) and a reason. A value that does not exist
//! is `None`, never NaN.

use super::error::{MAX_POINTS, SweepError};
use super::options::Options;
use super::points::Points;
use super::quantity::Quantity;
use super::row;
use super::status::Status;
use crate::table::{Chunk, Column, ColumnKind, Value, Values};
use funicular::robot::Robot;
use std::borrow::Cow;

/// Maximum number of rows per chunk: some milliseconds of work for statics, some seconds with natural frequencies.
const MAX_ROWS: usize = 256;

/// Minimum number of chunks of a small plan, so that all cores have work until the end.
const MIN_CHUNKS: usize = 64;

/// Points with the quantities to compute and the options.
pub struct Plan<'a> {
    points: &'a dyn Points,
    quantities: &'a [Quantity],
    options: &'a Options,
    /// Number of points.
    rows: usize,
    columns: Vec<Column>,
    /// Number of columns that follow the coordinates.
    width: usize,
    /// True with fewer cables than degrees of freedom: the pose of the equilibrium then differs from the requested
    /// pose.
    with_distance: bool,
}

impl<'a> Plan<'a> {
    /// Makes a plan of points, quantities and options. `robot` is the robot of any of the points: all of them have the
    /// same number and names of cables and the same degrees of freedom.
    ///
    /// # Errors
    /// [`SweepError`] if there are no points, too many points, or a quantity or option that no point can have.
    ///
    /// # Example
    /// ```
    /// use funicular::robot::Robot;
    /// use funicular_study::sweep::{Options, Plan, Poses, Quantity, Steps};
    /// use funicular_study::table::Values;
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

        if let Some(quantity) = quantities.iter().find(|quantity| quantity.needs_more_cables(robot)) {
            let (cables, dof) = (robot.cables.len(), robot.platform.motion.count());
            return Err(SweepError::TooFewCables { quantity: quantity.name(), cables, dof });
        }

        let with_distance = robot.constraint().is_under();
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

    /// Checks the first point for errors that every other point would have too.
    fn check_first(&self) -> Result<(), SweepError> {
        let first = self.points.point(0);
        let Ok((robot, state)) = &first.robot else { return Ok(()) };
        match first.solve(robot, state, self.options) {
            Err(error) if Status::of_error(&error).code == "invalid-state" => Err(error.into()),
            _ => Ok(()),
        }
    }

    /// Columns of the rows: coordinates, `feasible`, `status`, `reason`, then the quantities.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of rows per chunk. The last chunk may have fewer.
    pub fn chunk_rows(&self) -> usize {
        (self.rows / MIN_CHUNKS).clamp(1, MAX_ROWS)
    }

    /// Number of chunks.
    pub fn chunks(&self) -> usize {
        self.rows.div_ceil(self.chunk_rows())
    }

    /// Computes chunk `index`; `None` if `given_up`, which is called between two rows, returned true.
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
            let read = || self.points.parameters(i).map(Cow::into_owned);
            row::cells(&point, &read, self.quantities, self.options, self.with_distance, self.width, &mut row);
            for (column, value) in columns.iter_mut().zip(row.drain(..)) {
                column.push(value);
            }
        }
        Some(Chunk { index, columns })
    }
}

/// Columns that follow the coordinates.
pub(super) fn row_columns(robot: &Robot, quantities: &[Quantity], with_distance: bool) -> Vec<Column> {
    let own = |name: &str, about: &str, kind| Column {
        name: name.to_owned(),
        unit: "".into(),
        about: about.to_owned(),
        kind,
    };

    let mut columns = vec![
        own("feasible", "there is an equilibrium with tensions within the limits", ColumnKind::Flag),
        own("status", "ok, or a short code of the value that is missing and why", ColumnKind::Text),
        own("reason", "reason of the status, with numbers", ColumnKind::Text),
    ];

    if with_distance {
        columns.push(Column {
            name: "nearest_pose_distance_m".to_owned(),
            unit: "m".into(),
            about: "distance between the pose of the equilibrium and the requested pose".to_owned(),
            kind: ColumnKind::Real,
        });
    }

    columns.extend(quantities.iter().flat_map(|quantity| quantity.columns(robot)));
    columns
}

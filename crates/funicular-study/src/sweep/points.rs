//! Points of a sweep: grids and lists of poses, or robots that the caller supplies.

use super::error::SweepError;
use super::options::Options;
use crate::request::{Steps, digits};
use crate::table::{Column, ColumnKind};
use funicular::math::rotation;
use funicular::robot::parameters::Parameters;
use funicular::robot::{PlatformMotion, Pose, Robot, State};
use funicular::statics::{self, Solution, StaticsError};
use std::borrow::Cow;
use std::sync::Arc;

/// Points of a sweep, in a fixed order.
pub trait Points: Sync {
    /// Number of points.
    fn count(&self) -> usize;

    /// Columns of the coordinates, all [`ColumnKind::Real`].
    fn columns(&self) -> Vec<Column>;

    /// Point `i`. Equal `i` give equal points on all threads.
    fn point(&self, i: usize) -> Point<'_>;

    /// Numbers of the robot file of point `i`, for derivatives; `None` if the points have none.
    fn parameters(&self, i: usize) -> Option<Cow<'_, Parameters>> {
        let _ = i;
        None
    }
}

/// Point of a sweep.
#[derive(Debug, Clone)]
pub struct Point<'a> {
    /// Coordinates, in the order of the columns.
    pub coordinates: Vec<f64>,
    /// Robot and its state, or the reason why there is no robot.
    pub robot: Result<(Cow<'a, Robot>, Cow<'a, State>), String>,
    /// Robot whose unstrained lengths at the state are held; `None` if none are held.
    pub holder: Option<Cow<'a, Robot>>,
}

impl Point<'_> {
    /// Equilibrium of a robot of this point at a state.
    pub(super) fn solve(&self, robot: &Robot, state: &State, options: &Options) -> Result<Solution, StaticsError> {
        let Options { static_model, tension_rule, .. } = options;
        match &self.holder {
            None => statics::solve_at(robot, state, *static_model, tension_rule),
            Some(holder) => statics::solve_held_at(holder, robot, state, *static_model, tension_rule),
        }
    }
}

/// Names of the axes of a pose, in the order of its six numbers.
pub const AXES: [&str; 6] = ["x", "y", "z", "roll", "pitch", "yaw"];

/// Poses of one robot.
#[derive(Debug, Clone)]
pub struct Poses {
    robot: Robot,
    /// Robot whose unstrained lengths at each pose are held.
    holder: Option<Robot>,
    /// Numbers of the robot file, for derivatives.
    parameters: Option<Arc<Parameters>>,
    which: PoseSet,
}

#[derive(Debug, Clone)]
enum PoseSet {
    /// Grid of all combinations of values along axes.
    Grid { axes: Box<[Steps; 6]>, turns: bool, base: Pose },
    /// List of poses: position [m] and roll, pitch, yaw [degrees].
    List(Vec<[f64; 6]>),
}

impl Poses {
    /// Grid of all combinations of values [m, degrees] along axes (named as in [`AXES`]). x runs fastest, then y and so
    /// on. Axes that are not given keep the value of `base`. Without `base` angles are zero.
    ///
    /// # Errors
    /// [`SweepError`]: an axis or a value that is given twice, an axis along which the platform cannot move, or a
    /// position axis without values and without `base`.
    ///
    /// # Example
    /// ```
    /// use funicular::robot::{Pose, Robot};
    /// use funicular_study::sweep::{Points, Poses, Steps};
    ///
    /// let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM)?;
    /// let base = Pose::new([0.0, 0.0, 0.5], [0.0; 3]);
    /// let axes = [("x", Steps::range(-1.0, 1.0, 5)?), ("y", Steps::List(vec![0.0, 0.3]))];
    /// let grid = Poses::grid(robot, &axes.map(|(axis, steps)| (axis.to_owned(), steps)), Some(&base))?;
    /// assert_eq!(grid.count(), 10);
    /// assert_eq!(grid.point(7).coordinates, [0.0, 0.3, 0.5, 0.0, 0.0, 0.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn grid(robot: Robot, given: &[(String, Steps)], base: Option<&Pose>) -> Result<Self, SweepError> {
        let mut found: [Option<Steps>; 6] = Default::default();
        for (name, steps) in given {
            let Some(axis) = AXES.iter().position(|axis| axis == name) else {
                return Err(SweepError::UnknownAxis { axis: name.clone() });
            };
            refuse_missing_freedom(&robot.platform.motion, axis)?;
            if let Some(value) = steps.repeated() {
                return Err(SweepError::RepeatedValue { axis: name.clone(), value });
            }
            if found[axis].replace(steps.clone()).is_some() {
                return Err(SweepError::RepeatedAxis { axis: name.clone() });
            }
        }

        if base.is_none()
            && let Some(axis) = (0..3).find(|&axis| found[axis].is_none())
        {
            return Err(SweepError::NoPosition { axis: AXES[axis] });
        }
        let base = base.copied().unwrap_or_else(|| Pose::new([0.0; 3], [0.0; 3]));
        let at_base: [f64; 6] = numbers(&base);
        let turns = found[3..].iter().any(Option::is_some);

        let mut at_base = at_base.into_iter();
        let axes = Box::new(found.map(|steps| {
            let value = at_base.next().unwrap_or(0.0);
            steps.unwrap_or_else(|| Steps::List(vec![value]))
        }));
        Ok(Self { robot, holder: None, parameters: None, which: PoseSet::Grid { axes, turns, base } })
    }

    /// List of poses in the given order: position [m] and roll, pitch, yaw [degrees].
    pub fn list(robot: Robot, poses: Vec<[f64; 6]>) -> Self {
        Self { robot, holder: None, parameters: None, which: PoseSet::List(poses) }
    }

    /// Map whose robot holds unstrained lengths: those with which `holder` rests at each pose.
    #[must_use]
    pub fn holding(self, holder: Option<Robot>) -> Self {
        Self { holder, ..self }
    }

    /// Map with the numbers of the robot file, for derivatives.
    #[must_use]
    pub(crate) fn with_parameters(self, parameters: Option<Parameters>) -> Self {
        Self { parameters: parameters.map(Arc::new), ..self }
    }

    /// Values along the six axes of a grid, including axes with one value; `None` for a list.
    pub fn axes(&self) -> Option<&[Steps; 6]> {
        match &self.which {
            PoseSet::Grid { axes, .. } => Some(axes),
            PoseSet::List(_) => None,
        }
    }

    /// Robot.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// True if angles are columns, because the platform can rotate.
    fn width(&self) -> usize {
        if self.robot.platform.motion.can_turn() { 6 } else { 3 }
    }
}

/// Position [m] and roll, pitch, yaw [degrees] of a pose, without negative zeros.
fn numbers(pose: &Pose) -> [f64; 6] {
    let p = pose.position_w;
    let [roll, pitch, yaw] = rotation::to_roll_pitch_yaw_deg(&pose.rot_wp);
    [p.x, p.y, p.z, roll, pitch, yaw].map(|value| value + 0.0)
}

/// Refuses an axis along which the platform cannot move.
fn refuse_missing_freedom(motion: &PlatformMotion, axis: usize) -> Result<(), SweepError> {
    if motion.components().contains(&axis) {
        return Ok(());
    }
    let has = motion.components().into_iter().map(|i| AXES[i]).collect::<Vec<_>>().join(", ");
    Err(SweepError::NoSuchMotion { axis: AXES[axis], dof: motion.name(), has })
}

impl Points for Poses {
    fn parameters(&self, _i: usize) -> Option<Cow<'_, Parameters>> {
        self.parameters.as_deref().map(Cow::Borrowed)
    }

    fn count(&self) -> usize {
        match &self.which {
            PoseSet::Grid { axes, .. } => axes.iter().fold(1, |count, steps| count.saturating_mul(steps.count())),
            PoseSet::List(poses) => poses.len(),
        }
    }

    fn columns(&self) -> Vec<Column> {
        AXES[..self.width()]
            .iter()
            .enumerate()
            .map(|(i, axis)| {
                let (unit, suffix) = if i < 3 { ("m", "m") } else { ("deg", "deg") };
                let about = if i < 3 { "requested position, world axes" } else { "requested angle, R = Rz Ry Rx" };
                Column {
                    name: format!("{axis}_{suffix}"),
                    unit: unit.into(),
                    about: about.to_owned(),
                    kind: ColumnKind::Real,
                }
            })
            .collect()
    }

    fn point(&self, i: usize) -> Point<'_> {
        let (mut at, pose) = match &self.which {
            PoseSet::List(poses) => {
                let [x, y, z, roll, pitch, yaw] = poses[i];
                (poses[i], Pose::new([x, y, z], [roll, pitch, yaw]))
            }

            PoseSet::Grid { axes, turns, base } => {
                let mut at = [0.0; 6];
                for ((value, steps), digit) in
                    at.iter_mut().zip(axes.iter()).zip(digits(i, axes.iter().map(Steps::count)))
                {
                    *value = steps.at(digit);
                }

                let mut pose = Pose::new([at[0], at[1], at[2]], [at[3], at[4], at[5]]);
                if !turns {
                    // The quaternion is used directly, without the rounding of angles.
                    pose.rot_wp = base.rot_wp;
                }
                (at, pose)
            }
        };

        for value in &mut at {
            *value += 0.0;
        }

        Point {
            coordinates: at[..self.width()].to_vec(),
            robot: Ok((Cow::Borrowed(&self.robot), Cow::Owned(State::Pose(pose)))),
            holder: self.holder.as_ref().map(Cow::Borrowed),
        }
    }
}

//! Poses of a request: a grid, or a list; for candidates of a proposal of `calibrate` or `identify`, and for commands
//! that work at several poses.

use crate::at_rest::check_pose;
use crate::names::suggestion;
use crate::request::{self, Axis, Places};
use anyhow::{Result, anyhow, bail};
use funicular::robot::{PlatformMotion, Pose, Robot, State};

/// Names of the axes.
const AXES: [&str; 6] = ["x", "y", "z", "roll", "pitch", "yaw"];

/// Maximum number of candidates: each is a small matrix that every proposed pose goes through.
const MAX_CANDIDATES: usize = 100_000;

/// Candidates before the axes that are not given are known.
pub(crate) enum Candidates {
    /// None were asked for.
    None,
    /// Poses as they are: position [m], then roll, pitch, yaw [degrees].
    Poses(Vec<[f64; 6]>),
    /// Values along each axis; an axis without values stays at the middle pose.
    Grid([Vec<f64>; 6]),
}

/// Candidates that a request wants, whose options `needs` say that there is a proposal.
///
/// # Errors
/// A proposal without candidates, an axis that does not exist or is there twice, or a pose that the platform cannot
/// have.
pub(crate) fn wanted(
    (is_wanted, needs): (bool, &str),
    given_grid: &[Axis],
    given_poses: Option<&Vec<[f64; 6]>>,
    robot: &Robot,
) -> Result<Candidates> {
    of_keys((is_wanted, needs), ["grid", "poses"], given_grid, given_poses, robot)
}

/// Poses that a request gives by other keys than those of a proposal: a grid or a list, or none.
///
/// # Errors
/// Both of them, an axis that does not exist or is there twice, or a pose that the platform cannot have.
pub(crate) fn given(
    keys: [&str; 2],
    given_grid: &[Axis],
    given_poses: Option<&Vec<[f64; 6]>>,
    robot: &Robot,
) -> Result<Candidates> {
    let is_given = !given_grid.is_empty() || given_poses.is_some();
    of_keys((is_given, ""), keys, given_grid, given_poses, robot)
}

fn of_keys(
    (is_wanted, needs): (bool, &str),
    [grid_key, poses_key]: [&str; 2],
    given_grid: &[Axis],
    given_poses: Option<&Vec<[f64; 6]>>,
    robot: &Robot,
) -> Result<Candidates> {
    if !is_wanted {
        if !given_grid.is_empty() || given_poses.is_some() {
            bail!("candidates need a number of poses: give {needs}");
        }
        return Ok(Candidates::None);
    }
    match (given_poses, given_grid.is_empty()) {
        (Some(_), false) => bail!("⟪{poses_key}⟫ and ⟪{grid_key}⟫ are both given: leave out one of them"),
        (None, true) => bail!("a proposal needs candidates: give their ⟪grid⟫ or a list of ⟪poses⟫"),
        (Some(poses), true) => {
            poses.iter().try_for_each(|row| check_pose(robot, &pose(row)))?;
            Ok(Candidates::Poses(poses.clone()))
        }
        (None, false) => grid(grid_key, given_grid),
    }
}

fn grid(key: &str, given: &[Axis]) -> Result<Candidates> {
    let mut values: [Vec<f64>; 6] = Default::default();
    let known = AXES.map(str::to_owned);
    for axis in given {
        let name = axis.name();
        let place = AXES
            .iter()
            .position(|of| *of == name)
            .ok_or_else(|| anyhow!("⟪{key}⟫: there is no axis `{name}`{}", suggestion(name, &known)))?;
        if !values[place].is_empty() {
            bail!("⟪{key}⟫: the axis {name} is there twice");
        }
        let steps = axis.steps().map_err(|reason| anyhow!("⟪{key}⟫ {name}: {reason}"))?;
        if steps.count() > MAX_CANDIDATES {
            bail!("⟪{key}⟫ {name} has {} values: give at most {MAX_CANDIDATES}", steps.count());
        }
        values[place] = (0..steps.count()).map(|k| steps.at(k)).collect();
    }
    let count = values.iter().fold(1_usize, |count, of| count.saturating_mul(of.len().max(1)));
    if count > MAX_CANDIDATES {
        bail!("⟪{key}⟫ has {count} candidates: give at most {MAX_CANDIDATES}");
    }
    Ok(Candidates::Grid(values))
}

impl Candidates {
    /// Poses of the candidates; axes that are not given have the values of `middle`, or follow from the plane of a
    /// planar platform.
    ///
    /// # Errors
    /// A pose that the platform cannot have.
    pub(crate) fn poses(&self, robot: &Robot, middle: &Pose) -> Result<Vec<Pose>> {
        Ok(self.rows(robot, middle)?.iter().map(pose).collect())
    }

    /// Position [m] and roll, pitch, yaw [degrees] of [`Self::poses`].
    fn rows(&self, robot: &Robot, middle: &Pose) -> Result<Vec<[f64; 6]>> {
        let values = match self {
            Self::None => return Ok(Vec::new()),
            Self::Poses(rows) => return Ok(rows.clone()),
            Self::Grid(values) => values,
        };
        let [x, y, z] = middle.position_w.into();
        let [roll, pitch, yaw] = funicular::math::rotation::to_roll_pitch_yaw_deg(&middle.rot_wp);
        let mut rows = vec![[x, y, z, roll, pitch, yaw]];
        for (k, values) in values.iter().enumerate() {
            if !values.is_empty() {
                rows = rows
                    .iter()
                    .flat_map(|row| {
                        values.iter().map(move |value| {
                            let mut next = *row;
                            next[k] = *value;
                            next
                        })
                    })
                    .collect();
            }
        }
        // A planar platform takes the coordinate that the grid leaves out from its plane.
        let in_plane = |point: [f64; 3]| {
            let given = [0, 1, 2].map(|k| (!values[k].is_empty()).then_some(point[k]));
            let PlatformMotion::Planar(plane) = &robot.platform.motion else { return point };
            plane.point_with(given).map_or(point, Into::into)
        };
        for [x, y, z, ..] in &mut rows {
            [*x, *y, *z] = in_plane([*x, *y, *z]);
        }
        rows.iter().try_for_each(|row| check_pose(robot, &pose(row)))?;
        Ok(rows)
    }
}

/// Pose of a row: position [m], then roll, pitch, yaw [degrees].
pub(crate) fn pose([x, y, z, roll, pitch, yaw]: &[f64; 6]) -> Pose {
    Pose::new([*x, *y, *z], [*roll, *pitch, *yaw])
}

/// Poses of a request that works at several, as rows of position [m] and roll, pitch, yaw [degrees]; `None` if it has
/// neither a grid nor a list. A grid lies about the pose of the state.
///
/// # Errors
/// A grid and a list, an axis that does not exist or is there twice, or a pose that the platform cannot have.
pub(crate) fn of_places(places: &Places, state: &request::State, robot: &Robot) -> Result<Option<Vec<[f64; 6]>>> {
    let middle = match (&state.pose, &robot.state) {
        (Some(pose), _) => pose.to_robot()?,
        (None, State::Pose(pose)) => *pose,
        (None, _) => Pose::new([0.0; 3], [0.0; 3]),
    };
    match given(["grid", "poses"], &places.grid, places.poses.as_ref(), robot)? {
        Candidates::None => Ok(None),
        candidates => Ok(Some(candidates.rows(robot, &middle)?)),
    }
}

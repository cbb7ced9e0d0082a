//! Path of a request, and the state from which it starts.

use super::super::timed_rows::{Holds, TimedRows};
use super::KEY;
use crate::at_rest::check_pose;
use crate::request::{self, MotionOptions, NumberColumns, State, TrajectoryRequest};
use crate::table_fault::TableFault;
use anyhow::{Result, bail};
use funicular::math::Vec3;
use funicular::path::{MotionLimits, PathError, PlatformPath};
use funicular::robot::{Pose, Robot};

/// Change of a written angle between two rows [degrees] that may be meant as the long or as the short way round: from
/// half a turn to a whole one without 30°, by which angles pass the end of their range.
const AMBIGUOUS_DEG: std::ops::Range<f64> = 180.0..330.0;

/// Checks the table of a path for a robot.
///
/// # Errors
/// The first fault: a column that is missing or unknown, fewer than two rows, times that do not rise, a pose that the
/// platform cannot have, a jump, or a turn whose way is not known.
pub fn check(columns: &NumberColumns, robot: &Robot) -> Result<(), TableFault> {
    of_table(columns, robot).map(drop)
}

/// Rows of a path, with the path through them.
fn of_table(columns: &NumberColumns, robot: &Robot) -> Result<(TimedRows, PlatformPath), TableFault> {
    let rows = TimedRows::read(KEY, columns, robot)?;
    let fault = |row: Option<usize>, text: String| TableFault { key: KEY, row, text };
    if rows.holds == Holds::Lengths {
        let text = "a path has poses: give x_m, y_m, z_m and, where the platform turns, angles; ⟪trajectory⟫ of \
                    `settle` takes lengths";
        return Err(fault(None, text.to_owned()));
    }

    for (row, pair) in (1..).zip(rows.values.windows(2)) {
        for (k, name) in [(3, "roll_deg"), (4, "pitch_deg"), (5, "yaw_deg")] {
            let change = (pair[1][k] - pair[0][k]).abs();
            if AMBIGUOUS_DEG.contains(&change) {
                let text = format!(
                    "`{name}` changes by {change}° in one row: more than half a turn can be meant either way round; \
                     add rows between"
                );
                return Err(fault(Some(row), text));
            }
        }
    }

    let poses: Vec<Pose> = (0..rows.times.len()).map(|row| rows.pose(row)).collect();
    let path = PlatformPath::of_table(&rows.times, &poses).map_err(|error| {
        let row = match error {
            PathError::TimesFall { row, .. } | PathError::TurnsTooFar { row, .. } | PathError::Jump { row, .. } => {
                Some(row - 1)
            }
            PathError::NoLimit { .. } | PathError::NoMove { .. } | PathError::NoRadius => None,
        };
        fault(row, error.to_string())
    })?;
    Ok((rows, path))
}

/// State from which the path starts: that of the request, or the first row of its table.
pub(super) fn state(robot: &Robot, request: &TrajectoryRequest) -> Result<State> {
    let mut state = request.state.clone();
    let Some(columns) = &request.path else { return Ok(state) };
    if state.pose.is_some() || state.lengths_m.is_some() || state.hold_lengths_of_pose {
        bail!("⟪path⟫ has the poses of the platform: leave out ⟪pose⟫, ⟪lengths_m⟫ and ⟪hold_lengths_of_pose⟫");
    }
    let (rows, _) = of_table(columns, robot)?;
    let first: [f64; 6] = std::array::from_fn(|k| rows.values[0][k]);
    state.pose = Some(request::Pose::Angles(first));
    Ok(state)
}

/// Path of a request that starts at a pose, and the times of the rows of its table.
///
/// # Errors
/// Several paths or none, options of another path, poses that the platform cannot have, or a [`PathError`].
pub(super) fn path(
    robot: &Robot,
    start: &Pose,
    request: &TrajectoryRequest,
) -> Result<(PlatformPath, Option<Vec<f64>>)> {
    refuse_mixtures(request)?;
    let limits = limits(&request.motion);
    let form = request.motion.course;
    let (path, times) = if let Some(columns) = &request.path {
        let (rows, path) = of_table(columns, robot)?;
        (path, Some(rows.times))
    } else if let Some(center) = request.circle_center_m {
        let axis = Vec3::from(request.circle_axis);
        if axis == Vec3::zeros() {
            bail!("⟪circle_axis⟫ is zero: give the direction of the axis, as 0,0,1");
        }
        if request.turns == 0.0 {
            bail!("⟪turns⟫ is zero: give the number of turns on the circle, as 1");
        }
        (named(PlatformPath::circle(start, (&center.into(), &axis), request.turns, &limits, form))?, None)
    } else {
        let poses = poses(robot, start, request)?;
        (named(PlatformPath::through(&poses, &limits, form, request.blend))?, None)
    };

    let factor = request.motion.duration_s.map_or(1.0, |duration| duration / path.duration());
    let times = times.map(|times| times.iter().map(|time| time * factor).collect());
    Ok((path.slowed(factor), times))
}

/// Error of a path with the way out.
fn named(path: Result<PlatformPath, PathError>) -> Result<PlatformPath> {
    path.map_err(|error| match error {
        PathError::NoLimit { of: "turn" } => {
            anyhow::anyhow!("{error}, ⟪angular_speed_rad_s⟫ and ⟪angular_acceleration_rad_s2⟫")
        }
        PathError::NoLimit { .. } => anyhow::anyhow!("{error}, ⟪speed_m_s⟫ and ⟪acceleration_m_s2⟫"),
        error => error.into(),
    })
}

/// Poses of the moves, the start first.
fn poses(robot: &Robot, start: &Pose, request: &TrajectoryRequest) -> Result<Vec<Pose>> {
    let Some(end) = request.move_to else {
        bail!("there is no path: give ⟪path⟫, ⟪move_to⟫ or ⟪circle_center_m⟫");
    };
    let end = end.to_robot()?;
    let up_w = robot.up_w();
    let lifted = |pose: &Pose, height: f64| Pose { position_w: pose.position_w + up_w * height, ..*pose };
    let via =
        request.via.iter().flatten().map(|[x, y, z, roll, pitch, yaw]| Pose::new([*x, *y, *z], [*roll, *pitch, *yaw]));

    let poses: Vec<Pose> = match request.lift_m {
        Some(height) => vec![*start, lifted(start, height), lifted(&end, height), end],
        None => std::iter::once(*start).chain(via).chain([end]).collect(),
    };
    poses.iter().try_for_each(|pose| check_pose(robot, pose))?;
    Ok(poses)
}

/// Refuses options that belong to different paths.
fn refuse_mixtures(request: &TrajectoryRequest) -> Result<()> {
    let given = [
        ("path", request.path.is_some()),
        ("move_to", request.move_to.is_some()),
        ("circle_center_m", request.circle_center_m.is_some()),
    ];
    let given: Vec<&str> = given.iter().filter(|(_, is_given)| *is_given).map(|(name, _)| *name).collect();
    if let [first, second, ..] = given[..] {
        bail!("⟪{first}⟫ and ⟪{second}⟫ are two paths: give one of them");
    }
    if request.via.is_some() && request.lift_m.is_some() {
        bail!("⟪via⟫ and ⟪lift_m⟫ are two ways to ⟪move_to⟫: give one of them");
    }
    if request.blend > 1.0 {
        bail!("⟪blend⟫ {} is above 1, the whole time of slowing down: give a number from 0 to 1", request.blend);
    }
    let motion = &request.motion;
    let limited = limits(motion) != MotionLimits::default();
    if request.path.is_some() && limited {
        bail!("⟪path⟫ has its own times: leave out the limits of speed, acceleration and jerk, or give ⟪duration_s⟫");
    }
    Ok(())
}

fn limits(motion: &MotionOptions) -> MotionLimits {
    let or_none = |limit: Option<f64>| limit.unwrap_or(f64::INFINITY);
    MotionLimits {
        speed: or_none(motion.speed_m_s),
        acceleration: or_none(motion.acceleration_m_s2),
        jerk: or_none(motion.jerk_m_s3),
        angular_speed: or_none(motion.angular_speed_rad_s),
        angular_acceleration: or_none(motion.angular_acceleration_rad_s2),
        angular_jerk: or_none(motion.angular_jerk_rad_s3),
    }
}

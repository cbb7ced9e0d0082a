//! Path of a request, and the state from which it starts.

use super::super::timed_rows::{Holds, TimedRows};
use super::KEY;
use super::job::{self, Job, JobPlace};
use super::rounded::{self, RoundedRows};
use crate::at_rest::check_pose;
use crate::request::{self, MotionOptions, NumberColumns, State, TrajectoryRequest};
use crate::table_fault::TableFault;
use crate::text::significant;
use anyhow::{Result, bail};
use funicular::math::Vec3;
use funicular::path::{MotionLimits, PathError, PlatformPath};
use funicular::robot::{Pose, Robot};

/// Change of a written angle between two rows [degrees] that may be meant as the long or as the short way round: from
/// half a turn to a whole one without 30°, by which angles pass the end of their range.
const AMBIGUOUS_DEG: std::ops::Range<f64> = 180.0..330.0;

/// Excess of a limit of speed, acceleration or jerk that counts as rounding.
const MAX_EXCESS: f64 = 1e-6;

/// Checks the table of a path for a robot.
///
/// # Errors
/// The first fault: a column that is missing or unknown, fewer than two rows, times that do not rise, a pose that the
/// platform cannot have, a jump, or a turn whose way is not known.
pub fn check(columns: &NumberColumns, robot: &Robot) -> Result<(), TableFault> {
    if job::is_job(columns) {
        return Job::read(columns, robot, &JobPlace::default()).map(drop);
    }
    of_table(columns, robot, None).map(drop)
}

/// Rows of a path, smoothed by less than a distance [m], with the path through them.
fn of_table(
    columns: &NumberColumns,
    robot: &Robot,
    tolerance: Option<f64>,
) -> Result<(TimedRows, PlatformPath), TableFault> {
    let mut rows = TimedRows::read(KEY, columns, robot)?;
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

    if let Some(tolerance) = tolerance {
        rounded::smooth(&mut rows, tolerance, robot.platform_length());
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
    if job::is_job(columns) {
        let place = JobPlace::of(request)?;
        if state.pose.is_none() {
            state.pose = Some(request::Pose::Angles(Job::read(columns, robot, &place)?.first_row));
        }
        return Ok(state);
    }
    if state.pose.is_some() || state.lengths_m.is_some() || state.hold_lengths_of_pose {
        bail!("⟪path⟫ has the poses of the platform: leave out ⟪pose⟫, ⟪lengths_m⟫ and ⟪hold_lengths_of_pose⟫");
    }
    let (rows, _) = of_table(columns, robot, request.row_tolerance_m)?;
    let first: [f64; 6] = std::array::from_fn(|k| rows.values[0][k]);
    state.pose = Some(request::Pose::Angles(first));
    Ok(state)
}

/// Path of a request.
pub(super) struct PathOfRequest {
    pub(super) path: PlatformPath,
    /// Times of the rows of its table [s].
    pub(super) times: Option<Vec<f64>>,
    /// Rows of the table whose rounding is part of the motion.
    pub(super) rounded: Option<RoundedRows>,
}

/// Path of a request that starts at a pose.
///
/// # Errors
/// Several paths or none, options of another path, poses that the platform cannot have, or a [`PathError`].
pub(super) fn path(robot: &Robot, start: &Pose, request: &TrajectoryRequest) -> Result<PathOfRequest> {
    refuse_mixtures(request)?;
    let form = request.motion.course;
    let given = limits(&request.motion);
    let limits = if given == MotionLimits::default() && form.is_polynomial() && request.motion.duration_s.is_some() {
        // The duration follows; any speed gives moves in a row times by their length.
        MotionLimits { speed: 1.0, angular_speed: 1.0, ..given }
    } else {
        given
    };
    let mut rounded = None;
    let (path, times) = if let Some(columns) = request.path.as_ref().filter(|columns| job::is_job(columns)) {
        let job = Job::read(columns, robot, &JobPlace::of(request)?)?;
        (named(PlatformPath::along(&job.start, &job.legs, &limits, form, request.blend))?, None)
    } else if let Some(columns) = &request.path {
        let (rows, path) = of_table(columns, robot, request.row_tolerance_m)?;
        rounded = RoundedRows::of(&rows, columns, robot.platform_length());
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
    Ok(PathOfRequest { path: path.slowed(factor), times, rounded })
}

/// Warning about a path that is faster than the limits of the request, because its duration was changed.
pub(super) fn beyond_limits(path: &PlatformPath, motion: &MotionOptions) -> Option<String> {
    let limits = limits(motion);
    if limits == MotionLimits::default() {
        return None;
    }
    let used = path.used_parts(&limits);
    let parts = [("speed", used.speed), ("acceleration", used.acceleration), ("jerk", used.jerk)];
    let beyond = parts.iter().filter(|(_, part)| *part > 1.0 + MAX_EXCESS);
    let told: Vec<String> =
        beyond.map(|(of, part)| format!("the {of} {} % of its limit", significant(100.0 * part, 4))).collect();
    let option = if motion.fastest { "⟪fastest⟫" } else { "⟪duration_s⟫" };
    (!told.is_empty()).then(|| format!("{option} makes the platform faster than it may be: {}", told.join(", ")))
}

/// Way to a move without limits.
const WITHOUT_LIMITS: &str = "; ⟪duration_s⟫ alone is enough with ⟪course⟫ `septic` or `quintic`";

/// Error of a path with the way out.
fn named(path: Result<PlatformPath, PathError>) -> Result<PlatformPath> {
    path.map_err(|error| match error {
        PathError::NoLimit { of: "turn" } => {
            anyhow::anyhow!("{error}, ⟪angular_speed_rad_s⟫ and ⟪angular_acceleration_rad_s2⟫{WITHOUT_LIMITS}")
        }
        PathError::NoLimit { .. } => anyhow::anyhow!("{error}, ⟪speed_m_s⟫ and ⟪acceleration_m_s2⟫{WITHOUT_LIMITS}"),
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
    if request.row_tolerance_m.is_some() && request.path.is_none() {
        bail!("⟪row_tolerance_m⟫ smooths the rows of a table: give it with ⟪path⟫");
    }
    let motion = &request.motion;
    let limited = limits(motion) != MotionLimits::default();
    let is_job = request.path.as_ref().is_some_and(job::is_job);
    if is_job && request.row_tolerance_m.is_some() {
        bail!("⟪row_tolerance_m⟫ smooths rows over time, and the moves of a job are exact: leave it out");
    }
    if request.path_origin_m.is_some() && !is_job {
        bail!("⟪path_origin_m⟫ is the place of the zero of a job: give it with a job as ⟪path⟫");
    }
    if request.path.is_some() && !is_job && limited {
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

//! A trajectory: poses or unstrained lengths over time from a table, with straight lines of the lengths between its
//! rows.

use super::super::timed_rows::{Holds, MAX_SAMPLES, TimedRows};
use super::LengthsRow;
use super::motion::{on_the_way, tangent};
use super::rows::{mixed, no_solution_or_input, sample_times, tensions, unstrained};
use crate::at_rest::AtRest;
use crate::request::{self, NumberColumns, SettleRequest, State};
use crate::table_fault::TableFault;
use crate::text::significant;
use anyhow::{Result, bail};
use funicular::modes::LengthCommand;
use funicular::path::{Shaper, StraightMove};
use funicular::robot::{Pose, Robot};
use funicular::statics::{self, Equilibrium};

/// Key of the request.
const KEY: &str = "trajectory";

/// Part of the duration below which two times of a shaped trajectory are one.
const SAME_TIME: f64 = 1e-9;

/// Lengths over time, which begin and end at rest.
pub(super) struct Trajectory<'a> {
    at_rest: &'a AtRest,
    rows: TimedRows,
    /// Unstrained lengths at each time [m].
    lengths: Vec<Vec<f64>>,
    /// Lengths at each time of a robot that is linear about the end, relative to those at the end [m].
    linear: Vec<Vec<f64>>,
    start: Equilibrium,
    /// Tensions at rest with the lengths of each time [N].
    still: Vec<Vec<f64>>,
}

/// Checks the table of a trajectory for a robot.
///
/// # Errors
/// The first fault: a column that is missing or unknown, fewer than two rows, times that do not rise, a pose that the
/// platform cannot have, or a length that is none.
pub fn check(columns: &NumberColumns, robot: &Robot) -> Result<(), TableFault> {
    TimedRows::read(KEY, columns, robot).map(drop)
}

/// State at the end of a trajectory, for a request that gives neither pose nor lengths.
///
/// # Errors
/// A [`TableFault`].
pub(super) fn state(robot: &Robot, request: &SettleRequest) -> Result<State> {
    let mut state = request.state.clone();
    let Some(columns) = &request.trajectory else { return Ok(state) };
    let rows = TimedRows::read(KEY, columns, robot)?;
    if state.pose.is_some() || state.lengths_m.is_some() {
        return Ok(state);
    }
    let last = rows.values.last().cloned().unwrap_or_default();
    match (rows.holds, <[f64; 6]>::try_from(last.as_slice())) {
        (Holds::Poses, Ok(pose)) => state.pose = Some(request::Pose::Angles(pose)),
        _ if state.hold_lengths_of_pose => {}
        _ => state.lengths_m = Some(last),
    }
    Ok(state)
}

impl TimedRows {
    /// Values at a time, by straight lines; constant before and after.
    fn at(&self, time: f64) -> Vec<f64> {
        along(&self.times, time, |row| &self.values[row])
    }

    /// Rows after a shaper: the sum of the delayed parts at every time at which a part has a corner.
    fn shaped(&self, shaper: &Shaper) -> Result<Self> {
        let duration = self.times.last().copied().unwrap_or_default() + shaper.duration();
        let impulses = &shaper.impulses;
        let mut times: Vec<f64> =
            impulses.iter().flat_map(|impulse| self.times.iter().map(move |time| time + impulse.time)).collect();
        times.sort_by(f64::total_cmp);
        times.dedup_by(|later, time| *later - *time <= SAME_TIME * duration);
        if times.len() as f64 > MAX_SAMPLES {
            bail!(
                "⟪trajectory⟫ has {} rows with the shaper, and at most {MAX_SAMPLES} are computed: give fewer rows",
                times.len()
            );
        }
        let sum = |time: f64| {
            let mut sum = vec![0.0; self.values[0].len()];
            for impulse in impulses {
                let part = self.at(time - impulse.time);
                sum.iter_mut().zip(part).for_each(|(sum, part)| *sum += impulse.amplitude * part);
            }
            sum
        };
        Ok(Self { values: times.iter().map(|time| sum(*time)).collect(), times, ..*self })
    }
}

/// Values at a time, by straight lines between the rows at ascending times; constant before and after.
fn along<'a>(times: &[f64], time: f64, row: impl Fn(usize) -> &'a Vec<f64>) -> Vec<f64> {
    let next = times.partition_point(|at| *at <= time);
    if next == 0 || next == times.len() {
        return row(next.saturating_sub(1)).clone();
    }
    let part = (time - times[next - 1]) / (times[next] - times[next - 1]);
    mixed(row(next - 1), row(next), part)
}

impl<'a> Trajectory<'a> {
    /// Trajectory of a table, which ends at the lengths at rest within the tolerance [m].
    ///
    /// # Errors
    /// A [`TableFault`], poses or lengths that the cables cannot hold, or another end.
    pub(super) fn of(at_rest: &'a AtRest, columns: &NumberColumns, tolerance: f64) -> Result<Self> {
        let found = Self::of_rows(at_rest, TimedRows::read(KEY, columns, &at_rest.robot)?)?;
        let (end, rest) = (&found.lengths[found.lengths.len() - 1], unstrained(&at_rest.equilibrium));
        let Some(i) = (0..rest.len()).find(|i| (end[*i] - rest[*i]).abs() > tolerance) else { return Ok(found) };
        bail!(
            "⟪trajectory⟫ ends with cable \"{}\" {} m long, and at rest it is {} m long, which differs by more than \
             ⟪tolerance_m⟫: the motion is about the rest at the end; give the last row as ⟪pose⟫ or ⟪lengths_m⟫, or \
             leave both out",
            at_rest.robot.cables[i].name,
            significant(end[i], 6),
            significant(rest[i], 6)
        )
    }

    /// Trajectory with the equilibria of its rows.
    ///
    /// # Errors
    /// Poses or lengths that the cables cannot hold.
    fn of_rows(at_rest: &'a AtRest, rows: TimedRows) -> Result<Self> {
        let (mut still, mut lengths, mut linear) = (Vec::new(), Vec::new(), Vec::new());
        let mut start = at_rest.equilibrium.clone();
        // From the end on, where the platform is at rest: lengths are followed from pose to pose.
        for row in (0..rows.times.len()).rev() {
            // Lengths that differ from those of the tension rule stretch the cables against each other.
            let (found, beside) = match rows.holds {
                Holds::Poses => (on_the_way(at_rest, &rows.pose(row))?, None),
                Holds::Lengths => {
                    let found = with_lengths(at_rest, &rows.values[row], &start.pose, rows.times[row])?;
                    let by_rule = unstrained(&on_the_way(at_rest, &found.pose)?);
                    (found, Some(by_rule))
                }
            };
            let own = unstrained(&found);
            let way = linear_lengths(at_rest, &found.pose)?;
            linear.push(match beside {
                Some(by_rule) => way.iter().zip(own.iter().zip(by_rule)).map(|(way, (a, b))| way + a - b).collect(),
                None => way,
            });
            still.push(tensions(&found));
            lengths.push(own);
            start = found;
        }
        for of in [&mut still, &mut lengths, &mut linear] {
            of.reverse();
        }
        Ok(Self { at_rest, rows, lengths, linear, start, still })
    }

    /// Trajectory after a shaper, which acts on the values of the table: on the poses, if it has poses.
    ///
    /// # Errors
    /// Too many rows, or poses or lengths that the cables cannot hold.
    pub(super) fn shaped(&self, shaper: &Shaper) -> Result<Self> {
        Self::of_rows(self.at_rest, self.rows.shaped(shaper)?)
    }

    /// Lengths over time of a robot that is linear about the end: the real ones are curved along the path, which it
    /// would take for a stretch.
    pub(super) fn lengths(&self) -> LengthCommand {
        LengthCommand::Samples { times: self.rows.times.clone(), lengths: self.linear.clone() }
    }

    pub(super) fn start(&self) -> &Equilibrium {
        &self.start
    }

    /// Warning about a rule of tensions that jumps between the poses of the table.
    pub(super) fn rule_jumps(&self) -> Option<String> {
        let mut pose = |part: f64| {
            let place = part * (self.rows.times.len() - 1) as f64;
            let row = (place as usize).min(self.rows.times.len() - 2);
            let way = StraightMove::between(&self.rows.pose(row), &self.rows.pose(row + 1));
            way.pose(place - row as f64)
        };
        let has_poses = self.rows.holds == Holds::Poses;
        has_poses.then(|| self.at_rest.rule_jumps_on_way(&mut pose, "rows of the trajectory")).flatten()
    }

    /// Lengths at equal steps of time [m].
    ///
    /// # Errors
    /// Too many samples.
    pub(super) fn sampled(&self, step: f64) -> Result<Vec<LengthsRow>> {
        let times = &self.rows.times;
        let at = |t_s: f64| along(times, t_s, |row| &self.lengths[row]);
        let end = times[times.len() - 1];
        Ok(sample_times(end, step)?.map(|t_s| LengthsRow { t_s, unstrained_lengths_m: at(t_s) }).collect())
    }

    /// Tensions at rest with the lengths of several times [N].
    pub(super) fn still_at(&self, times: &[f64]) -> Vec<Vec<f64>> {
        times.iter().map(|time| along(&self.rows.times, *time, |row| &self.still[row])).collect()
    }
}

/// Change of the lengths from the end to a pose with the derivatives at the end [m].
fn linear_lengths(at_rest: &AtRest, pose: &Pose) -> Result<Vec<f64>> {
    let end = &at_rest.equilibrium.pose;
    tangent(at_rest, &[pose.position_w - end.position_w, (pose.rot_wp * end.rot_wp.inverse()).scaled_axis()])
}

/// Equilibrium with the lengths of a time, near a pose.
fn with_lengths(at_rest: &AtRest, lengths: &[f64], near: &Pose, time: f64) -> Result<Equilibrium> {
    statics::forward(&at_rest.robot, lengths, at_rest.equilibrium.model, Some(near)).map_err(|error| {
        no_solution_or_input(&error, format!("{} s after the start of the trajectory: {error}", significant(time, 4)))
    })
}

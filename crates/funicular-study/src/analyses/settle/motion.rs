//! A stop or a move: the lengths that inverse statics commands along a line of poses.

use super::LengthsRow;
use super::rows::{mixed, no_solution_or_input, sample_times, tensions, unstrained};
use crate::at_rest::{AtRest, check_pose};
use crate::request::SettleRequest;
use crate::text::significant;
use anyhow::{Result, bail};
use funicular::math::{DMat, Vec3};
use funicular::modes::LengthCommand;
use funicular::path::{Profile, Shaper};
use funicular::robot::{CableChange, Pose, Robot, RobotChange, State};
use funicular::statics::{self, Equilibrium, derivatives};

/// Kind of the motion that ends at rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum MotionKind {
    Stop,
    Move,
}

/// Motion of the platform along a line of poses, which ends at the pose of the robot at rest.
#[derive(Clone)]
pub(super) struct Motion<'a> {
    at_rest: &'a AtRest,
    pub(super) kind: MotionKind,
    /// Translation and rotation vector, world axes: of the whole move [m, rad], or per second before the stop.
    whole: [Vec3; 2],
    /// Course of the change, or of the loss of speed.
    pub(super) profile: Profile,
    /// Change of each length with the move [m], or rate before the stop [m/s].
    by: Vec<f64>,
}

/// Displacement for the derivative of the lengths, relative to the longest cable: the error of the central difference
/// is a sixth of its square, that of the equilibria about 1e-12 over it.
const STEP: f64 = 1e-4;

/// Singular value of the motions by lengths, over their size, below which a motion is none that lengths command.
const RANK: f64 = 1e-3;

/// Maximum number of steps of the lengths to the nearest pose, a guard: each leaves a part of the distance.
const MAX_STEPS: usize = 60;

/// Equilibria along a path for its static tensions; between them lie straight lines.
const ALONG_PATH: usize = 9;

/// Relative difference of lengths that counts as rounding.
const SAME_LENGTH: f64 = 1e-6;

impl<'a> Motion<'a> {
    /// Motion of a request.
    ///
    /// # Errors
    /// A motion that the platform cannot have, or a pose beside that of rest which the cables cannot hold.
    pub(super) fn of(at_rest: &'a AtRest, kind: MotionKind, request: &SettleRequest) -> Result<Self> {
        let of = |numbers: Option<[f64; 3]>| Vec3::from(numbers.unwrap_or_default());
        let motion = match kind {
            MotionKind::Stop => [of(request.stop_m_s), of(request.stop_rad_s)],
            MotionKind::Move => [of(request.move_m), of(request.move_deg).map(f64::to_radians)],
        };
        let profile = Profile::new(request.profile_s.as_deref().unwrap_or_default());
        let mut command = Self { at_rest, kind, whole: motion, profile, by: Vec::new() };
        check_pose(&at_rest.robot, &command.pose(1.0))?;
        command.by = tangent(at_rest, &motion)?;
        Ok(command)
    }

    /// Pose from which the part `left` of the motion is left, in units of the motion.
    fn pose(&self, left: f64) -> Pose {
        before_end(self.at_rest, &self.whole, left)
    }

    /// Equilibrium from which the part `left` of the motion is left.
    fn equilibrium(&self, left: f64) -> Result<Equilibrium> {
        on_the_way(self.at_rest, &self.pose(left))
    }

    /// Part of the motion that is left at a time [s], in units of the motion.
    fn left(&self, time: f64) -> f64 {
        match self.kind {
            MotionKind::Stop => self.profile.remaining(time),
            MotionKind::Move => 1.0 - self.profile.done(time),
        }
    }

    /// Lengths about the pose of rest.
    pub(super) fn lengths(&self) -> LengthCommand {
        let (by, profile) = (self.by.clone(), self.profile.clone());
        match self.kind {
            MotionKind::Stop => LengthCommand::Stop { rates: by, profile },
            MotionKind::Move => LengthCommand::Move { by, profile },
        }
    }

    /// The command after a shaper, which acts on the poses: a mean of lengths is not the lengths of a mean pose.
    pub(super) fn shaped(&self, shaper: &Shaper) -> Self {
        Self { profile: self.profile.shaped(shaper), ..self.clone() }
    }

    /// Equilibrium at the start of the command.
    ///
    /// # Errors
    /// A pose that the cables cannot hold.
    pub(super) fn start(&self) -> Result<Equilibrium> {
        self.equilibrium(self.left(0.0))
    }

    /// Warning about a rule of tensions that jumps on the way.
    pub(super) fn rule_jumps(&self) -> Option<String> {
        let whole = self.left(0.0);
        self.at_rest.rule_jumps_on_way(&mut |part| self.pose(whole * (1.0 - part)), "motion")
    }

    /// Lengths at equal steps of time, from the start to the end [m].
    ///
    /// # Errors
    /// Too many samples, lengths of the state that the tension rule does not give, or a pose that the cables cannot
    /// hold.
    pub(super) fn sampled(&self, step: f64) -> Result<Vec<LengthsRow>> {
        let times = sample_times(self.profile.duration(), step)?;
        self.check_rest()?;
        let row = |t_s: f64| {
            let found = self.equilibrium(self.left(t_s))?;
            Ok(LengthsRow { t_s, unstrained_lengths_m: unstrained(&found) })
        };
        times.map(row).collect()
    }

    /// Refuses lengths at rest that the tension rule does not give.
    fn check_rest(&self) -> Result<()> {
        let by_rule = self.equilibrium(0.0)?;
        let pairs = by_rule.cables.iter().zip(&self.at_rest.equilibrium.cables);
        let differs = |(i, (a, b)): (usize, (&statics::CableState, &statics::CableState))| {
            let (a, b) = (a.unstrained_length, b.unstrained_length);
            ((a - b).abs() > SAME_LENGTH * b).then_some((i, a, b))
        };
        let Some((i, by_rule, held)) = pairs.enumerate().find_map(differs) else { return Ok(()) };
        bail!(
            "cable \"{}\" is {} m long at rest, and the rule of tensions gives {} m at the same pose: the lengths of a \
             motion follow from poses by this rule; give ⟪pose⟫, or leave out ⟪sample_time_s⟫",
            self.at_rest.robot.cables[i].name,
            significant(held, 6),
            significant(by_rule, 6)
        )
    }

    /// Tensions of the cables at rest in the places of several times [N].
    pub(super) fn still_at(&self, times: &[f64]) -> Result<Vec<Vec<f64>>> {
        let (still, start) = (self.still_tensions()?, self.left(0.0));
        let place = |time: f64| if start > 0.0 { (1.0 - self.left(time) / start).clamp(0.0, 1.0) } else { 1.0 };
        Ok(times.iter().map(|time| between(&still, place(*time))).collect())
    }

    /// Tension of each cable at rest at equal steps along the path, from start to end [N].
    fn still_tensions(&self) -> Result<Vec<Vec<f64>>> {
        let (start, last) = (self.left(0.0), (ALONG_PATH - 1) as f64);
        (0..ALONG_PATH)
            .map(|k| match k {
                _ if k + 1 == ALONG_PATH || start <= 0.0 => Ok(tensions(&self.at_rest.equilibrium)),
                _ => Ok(tensions(&self.equilibrium(start * (1.0 - k as f64 / last))?)),
            })
            .collect()
    }
}

/// Change of each length per unit of a motion at its end [m, or m/s for a velocity]: of inverse statics with the
/// tension rule, so that sag and tensions follow.
///
/// # Errors
/// A pose beside that of rest which the cables cannot hold.
pub(super) fn tangent(at_rest: &AtRest, motion: &[Vec3; 2]) -> Result<Vec<f64>> {
    let cables = &at_rest.equilibrium.cables;
    let [shift, turn] = motion.map(|part| part.norm());
    if shift + turn == 0.0 {
        return Ok(vec![0.0; cables.len()]);
    }
    if at_rest.robot.constraint().is_under()
        && let Some(by) = nearest_rates(&at_rest.robot, &at_rest.equilibrium, motion)
    {
        return Ok(by);
    }
    let longest = cables.iter().map(|cable| cable.unstrained_length).fold(0.0, f64::max);
    let reach = cables.iter().map(|cable| cable.lever_w.norm()).fold(0.0, f64::max);
    let step = STEP * longest / (shift + turn * reach.max(f64::MIN_POSITIVE)).max(f64::MIN_POSITIVE);
    let [before, after] = [step, -step].map(|left| on_the_way(at_rest, &before_end(at_rest, motion, left)));
    let (before, after) = (unstrained(&before?), unstrained(&after?));
    Ok(before.iter().zip(after).map(|(before, after)| (after - before) / (2.0 * step)).collect())
}

/// Rates of the lengths with which the equilibria of a robot with too few cables come nearest to a motion: searches for
/// the nearest poses beside the rest need not end. `None` without derivatives of the equilibrium.
fn nearest_rates(robot: &Robot, equilibrium: &Equilibrium, motion: &[Vec3; 2]) -> Option<Vec<f64>> {
    let size = robot.platform_length();
    let count = robot.cables.len();
    let as_column = |[shift, turn]: [Vec3; 2]| [shift.x, shift.y, shift.z, turn.x * size, turn.y * size, turn.z * size];
    let by_length = |cable: usize| {
        let mut change = RobotChange { cables: vec![CableChange::default(); count], ..RobotChange::default() };
        change.cables[cable].unstrained_length = 1.0;
        let found = derivatives::at_held_lengths(robot, equilibrium, &change).ok()?;
        Some(as_column([found.translation_w, found.rotation_w]))
    };
    let columns: Vec<[f64; 6]> = (0..count).map(by_length).collect::<Option<_>>()?;
    let rates = DMat::from_fn(6, count, |row, column| columns[column][row]);
    let wanted = DMat::from_column_slice(6, 1, &as_column(*motion));
    let largest = rates.norm();
    let found = rates.svd(true, true).solve(&wanted, RANK * largest).ok()?;
    Some(found.iter().copied().collect())
}

/// Pose from which the part `left` of a motion leads to the rest.
fn before_end(at_rest: &AtRest, motion: &[Vec3; 2], left: f64) -> Pose {
    let [shift, turn] = motion.map(|part| part * -left);
    at_rest.equilibrium.pose.moved(&shift, &turn)
}

/// Equilibrium of a robot with too few cables that is nearest to a pose, by steps of the lengths from another one;
/// `None` if they do not end.
fn nearest_from_rest(robot: &Robot, rest: &Equilibrium, pose: &Pose) -> Option<Equilibrium> {
    let mut here = rest.clone();
    for _ in 0..MAX_STEPS {
        let turn_w = (pose.rot_wp * here.pose.rot_wp.inverse()).scaled_axis();
        let by = nearest_rates(robot, &here, &[pose.position_w - here.pose.position_w, turn_w])?;
        let mut lengths = unstrained(&here);
        let longest = lengths.iter().copied().fold(0.0, f64::max);
        let largest = by.iter().map(|by| by.abs()).fold(0.0, f64::max);
        if largest <= SAME_LENGTH * longest {
            return Some(here);
        }
        lengths.iter_mut().zip(&by).for_each(|(length, by)| *length += by);
        here = statics::forward(robot, &lengths, here.model, Some(&here.pose)).ok()?;
    }
    None
}

/// Equilibrium at a pose by the tension rule of the robot at rest.
///
/// # Errors
/// A pose that the cables cannot hold.
pub(super) fn on_the_way(AtRest { robot, equilibrium, rule, .. }: &AtRest, pose: &Pose) -> Result<Equilibrium> {
    let rule = rule.clone().unwrap_or_default();
    let found = statics::solve_at(robot, &State::Pose(*pose), equilibrium.model, &rule).map(|found| found.equilibrium);
    if found.is_err()
        && robot.constraint().is_under()
        && let Some(nearest) = nearest_from_rest(robot, equilibrium, pose)
    {
        return Ok(nearest);
    }
    found.map_err(|error| {
        let [x, y, z] = [0, 1, 2].map(|k| significant(pose.position_w[k], 4));
        no_solution_or_input(&error, format!("at {x}, {y}, {z} m, on the way: {error}"))
    })
}

/// Row at a place from 0 (first row) to 1 (last row), by straight lines.
fn between(rows: &[Vec<f64>], place: f64) -> Vec<f64> {
    let at = place * (rows.len() - 1) as f64;
    let k = (at as usize).min(rows.len() - 2);
    mixed(&rows[k], &rows[k + 1], at - k as f64)
}

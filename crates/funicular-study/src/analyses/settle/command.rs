//! Motions of the platform that the lengths command, a stop or a move: rates, lengths along the path, and tensions on
//! it.

use super::LengthsRow;
use crate::at_rest::{AtRest, check_pose};
use crate::error::NoSolution;
use crate::request::{SettleRequest, check};
use crate::text::significant;
use crate::values::{not_negative, positive};
use anyhow::{Result, anyhow, bail};
use funicular::math::Vec3;
use funicular::modes::{CommandedMotions, LengthCommand, Profile, Shaper};
use funicular::robot::{Pose, State};
use funicular::statics::{self, Equilibrium};
use serde::Serialize;
use std::f64::consts::TAU;

/// Motion of the platform along a line of poses, which ends at the pose of the robot at rest.
#[derive(Clone)]
pub(super) struct Command<'a> {
    at_rest: &'a AtRest,
    pub(super) kind: CommandKind,
    /// Translation and rotation vector, world axes: of the whole move [m, rad], or per second before the stop.
    motion: [Vec3; 2],
    /// Course of the change, or of the loss of speed.
    pub(super) profile: Profile,
    /// Change of each length with the move [m], or rate before the stop [m/s].
    by: Vec<f64>,
}

/// Kind of the motion that ends at rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CommandKind {
    Stop,
    Move,
}

/// Lowest tension of a cable during a motion and after it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LowestTension {
    pub cable: String,
    /// Time since the start of the command.
    pub t_s: f64,
    pub tension_n: f64,
}

/// Displacement for the derivative of the lengths, relative to the longest cable: the error of the central difference
/// is a sixth of its square, that of the equilibria about 1e-12 over it.
const STEP: f64 = 1e-4;

/// Equilibria along a path for its static tensions; between them lie straight lines.
const ALONG_PATH: usize = 9;

/// Maximum number of times at which tensions are checked, and the number per period of the fastest mode.
const MAX_CHECKS: f64 = 2000.0;
const CHECKS_PER_PERIOD: f64 = 12.0;

/// Maximum number of samples of the commanded lengths: an hour at 0.1 s, or 36 s at 1 ms.
pub(super) const MAX_SAMPLES: f64 = 36_000.0;

/// Part of a sample beyond the last one that counts as rounding.
const ROUNDING: f64 = 1e-9;

/// Relative difference of lengths that counts as rounding.
const SAME_LENGTH: f64 = 1e-6;

impl CommandKind {
    /// Motion that a request gives, with its numbers; `None` for a release.
    pub(super) fn of(request: &SettleRequest) -> Option<Self> {
        if request.stop_m_s.is_some() || request.stop_rad_s.is_some() {
            Some(Self::Stop)
        } else if request.move_m.is_some() || request.move_deg.is_some() {
            Some(Self::Move)
        } else {
            None
        }
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Stop => "stop",
            Self::Move => "move",
        }
    }
}

/// Checks the times of a command.
///
/// # Errors
/// Too many times, a time that is longer than the one before, a move in no time, or a negative number.
pub(super) fn check_profile(kind: CommandKind, request: &SettleRequest) -> Result<()> {
    let times = request.profile_s.as_deref().unwrap_or_default();
    times.iter().try_for_each(|time| check("profile_s", Some(*time), not_negative))?;
    check("sample_time_s", request.sample_time_s, positive)?;
    if let Some(frequencies) = &request.shape_modes_hz {
        frequencies.iter().try_for_each(|frequency| check("shape_modes_hz", Some(*frequency), positive))?;
    }
    if times.len() > 3 {
        bail!(
            "⟪profile_s⟫ has {} times, and at most three are used: those of speed, acceleration and jerk",
            times.len()
        );
    }
    if let Some((before, time)) = times.iter().zip(times.iter().skip(1)).find(|(before, time)| time > before) {
        bail!(
            "⟪profile_s⟫: the time {time} s is longer than the one before it, {before} s: give the longest first, as \
             1.2,0.3,0.1"
        );
    }
    if kind == CommandKind::Move && times.iter().sum::<f64>() <= 0.0 {
        bail!("a move takes time: give ⟪profile_s⟫, as 1.2,0.3,0.1");
    }
    Ok(())
}

/// Refuses options of a command for a release.
///
/// # Errors
/// The first such option.
pub(super) fn refuse_for_release(request: &SettleRequest) -> Result<()> {
    let given = [
        ("profile_s", request.profile_s.is_some()),
        ("shaper", request.shaper.is_some()),
        ("shape_modes_hz", request.shape_modes_hz.is_some()),
        ("sample_time_s", request.sample_time_s.is_some()),
    ];
    if let Some((name, _)) = given.iter().find(|(_, given)| *given) {
        bail!("⟪{name}⟫ is used by a stop or a move, not by a release: give ⟪stop_m_s⟫ or ⟪move_m⟫, or leave it out");
    }
    Ok(())
}

impl<'a> Command<'a> {
    /// Command of a request; `None` for a release.
    ///
    /// # Errors
    /// A motion that the platform cannot have, or a pose beside that of rest which the cables cannot hold.
    pub(super) fn of(at_rest: &'a AtRest, request: &SettleRequest) -> Result<Option<Self>> {
        let Some(kind) = CommandKind::of(request) else { return Ok(None) };
        let of = |numbers: Option<[f64; 3]>| Vec3::from(numbers.unwrap_or_default());
        let motion = match kind {
            CommandKind::Stop => [of(request.stop_m_s), of(request.stop_rad_s)],
            CommandKind::Move => [of(request.move_m), of(request.move_deg).map(f64::to_radians)],
        };
        let profile = Profile::new(request.profile_s.as_deref().unwrap_or_default());
        let mut command = Self { at_rest, kind, motion, profile, by: Vec::new() };
        check_pose(&at_rest.robot, &command.pose(1.0))?;
        command.by = command.rates()?;
        Ok(Some(command))
    }

    /// Change of each length per unit of the motion at its end [m or m/s]: of inverse statics with the tension rule, so
    /// that sag and tensions follow.
    fn rates(&self) -> Result<Vec<f64>> {
        let cables = &self.at_rest.equilibrium.cables;
        let longest = cables.iter().map(|cable| cable.unstrained_length).fold(0.0, f64::max);
        let reach = cables.iter().map(|cable| cable.lever_w.norm()).fold(0.0, f64::max);
        let [shift, turn] = self.motion.map(|part| part.norm());
        let step = STEP * longest / (shift + turn * reach.max(f64::MIN_POSITIVE)).max(f64::MIN_POSITIVE);
        let [before, after] = [step, -step].map(|left| self.equilibrium(left));
        let (before, after) = (before?, after?);
        let pairs = before.cables.iter().zip(&after.cables);
        Ok(pairs.map(|(from, to)| (to.unstrained_length - from.unstrained_length) / (2.0 * step)).collect())
    }

    /// Pose from which the part `left` of the motion is left, in units of the motion.
    fn pose(&self, left: f64) -> Pose {
        let [shift, turn] = self.motion.map(|part| part * -left);
        self.at_rest.equilibrium.pose.moved(&shift, &turn)
    }

    /// Equilibrium from which the part `left` of the motion is left.
    fn equilibrium(&self, left: f64) -> Result<Equilibrium> {
        let AtRest { robot, equilibrium, rule, .. } = self.at_rest;
        let (pose, rule) = (self.pose(left), rule.clone().unwrap_or_default());
        let found = statics::solve_at(robot, &State::Pose(pose), equilibrium.model, &rule);
        found.map(|solution| solution.equilibrium).map_err(|error| {
            let [x, y, z] = [0, 1, 2].map(|k| significant(pose.position_w[k], 4));
            let text = format!("at {x}, {y}, {z} m, on the way: {error}");
            if error.is_no_solution() { NoSolution(text).into() } else { anyhow!(text) }
        })
    }

    /// Part of the motion that is left at a time [s], in units of the motion.
    fn left(&self, time: f64) -> f64 {
        match self.kind {
            CommandKind::Stop => self.profile.remaining(time),
            CommandKind::Move => 1.0 - self.profile.done(time),
        }
    }

    /// Lengths about the pose of rest.
    pub(super) fn lengths(&self) -> LengthCommand {
        let (by, profile) = (self.by.clone(), self.profile.clone());
        match self.kind {
            CommandKind::Stop => LengthCommand::Stop { rates: by, profile },
            CommandKind::Move => LengthCommand::Move { by, profile },
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

    /// Lengths at equal steps of time, from the start to the end [m].
    ///
    /// # Errors
    /// Too many samples, lengths of the state that the tension rule does not give, or a pose that the cables cannot
    /// hold.
    pub(super) fn sampled(&self, step: f64) -> Result<Vec<LengthsRow>> {
        let end = self.profile.duration();
        let count = (end / step - ROUNDING).ceil().max(0.0);
        if count > MAX_SAMPLES {
            bail!(
                "⟪sample_time_s⟫ {step} gives {count} samples of the lengths, and at most {MAX_SAMPLES} are computed: \
                 give a longer time"
            );
        }
        self.check_rest()?;
        (0..=count as usize)
            .map(|i| {
                let time = i as f64 * step;
                let found = self.equilibrium(self.left(time))?;
                let lengths = found.cables.iter().map(|cable| cable.unstrained_length).collect();
                Ok(LengthsRow { t_s: time, unstrained_lengths_m: lengths })
            })
            .collect()
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

    /// Lowest tension during the command and after it.
    ///
    /// # Errors
    /// [`NoSolution`] for a cable that would be slack.
    pub(super) fn lowest_tension(&self, motions: &CommandedMotions) -> Result<LowestTension> {
        let command = self.lengths();
        let still = self.still_tensions()?;
        let start = self.left(0.0);
        let times = checked_times(motions, command.duration());
        let beside = motions.tensions_beside_static(&command, &times);

        let mut lowest: Option<(f64, usize, f64)> = None;
        for (time, beside) in times.iter().zip(&beside) {
            let place = if start > 0.0 { (1.0 - self.left(*time) / start).clamp(0.0, 1.0) } else { 1.0 };
            for i in 0..still[0].len() {
                let tension = between(&still, place, i) + beside.get(i).copied().unwrap_or_default();
                if lowest.is_none_or(|(_, _, least)| tension < least) {
                    lowest = Some((*time, i, tension));
                }
            }
        }
        let (t_s, i, tension_n) = lowest.unwrap_or((0.0, 0, 0.0));
        let cable = self.at_rest.robot.cables[i].name.clone();
        if tension_n <= 0.0 {
            return Err(NoSolution(format!(
                "cable \"{cable}\" becomes slack {} s after the start of the motion: its tension would be {} N, and a \
                 cable pulls in one direction only. The linear motion does not know that; only a simulation in time \
                 can tell what happens. Move more slowly: give longer times in ⟪profile_s⟫, or more tension",
                significant(t_s, 3),
                significant(tension_n, 3)
            ))
            .into());
        }
        Ok(LowestTension { cable, t_s, tension_n })
    }

    /// Tension of each cable at rest at equal steps along the path, from start to end [N].
    fn still_tensions(&self) -> Result<Vec<Vec<f64>>> {
        let (start, last) = (self.left(0.0), (ALONG_PATH - 1) as f64);
        let tensions = |found: &Equilibrium| found.cables.iter().map(|cable| cable.tension_platform).collect();
        (0..ALONG_PATH)
            .map(|k| match k {
                _ if k + 1 == ALONG_PATH || start <= 0.0 => Ok(tensions(&self.at_rest.equilibrium)),
                _ => Ok(tensions(&self.equilibrium(start * (1.0 - k as f64 / last))?)),
            })
            .collect()
    }
}

/// Value of column `i` at a place from 0 (first row) to 1 (last row), by straight lines.
fn between(rows: &[Vec<f64>], place: f64, i: usize) -> f64 {
    let at = place * (rows.len() - 1) as f64;
    let k = (at as usize).min(rows.len() - 2);
    let part = at - k as f64;
    rows[k][i] * (1.0 - part) + rows[k + 1][i] * part
}

/// Times during a command and for a period of the slowest mode after it.
fn checked_times(motions: &CommandedMotions, duration: f64) -> Vec<f64> {
    let frequencies = motions.motions.iter().map(|motion| motion.omega.re / TAU);
    let (slowest, fastest) = frequencies.fold((f64::INFINITY, 0.0), |(low, high), f| (f.min(low), f.max(high)));
    let until = duration + 1.0 / slowest;
    let points = (until * fastest * CHECKS_PER_PERIOD).clamp(2.0, MAX_CHECKS).ceil();
    (0..=points as usize).map(|i| until * i as f64 / points).collect()
}

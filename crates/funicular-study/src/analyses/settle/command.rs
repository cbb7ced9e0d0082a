//! Commands of the lengths: a stop or a move of the platform, or a trajectory from a table.

use super::LengthsRow;
use super::motion::{Motion, MotionKind};
use super::trajectory::Trajectory;
use crate::at_rest::AtRest;
use crate::request::{SettleRequest, check};
use crate::values::{not_negative, positive};
use anyhow::{Result, bail};
use funicular::modes::LengthCommand;
use funicular::path::Shaper;
use funicular::statics::Equilibrium;

/// Command that ends with the robot at rest.
pub(super) enum Command<'a> {
    Motion(Motion<'a>),
    Trajectory(Trajectory<'a>),
}

/// Kind of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CommandKind {
    Motion(MotionKind),
    Trajectory,
}

impl CommandKind {
    /// Command that a request gives; `None` for a release.
    pub(super) fn of(request: &SettleRequest) -> Option<Self> {
        if request.trajectory.is_some() {
            Some(Self::Trajectory)
        } else if request.stop_m_s.is_some() || request.stop_rad_s.is_some() {
            Some(Self::Motion(MotionKind::Stop))
        } else if request.move_m.is_some() || request.move_deg.is_some() {
            Some(Self::Motion(MotionKind::Move))
        } else {
            None
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Motion(MotionKind::Stop) => "stop",
            Self::Motion(MotionKind::Move) => "move",
            Self::Trajectory => "trajectory",
        }
    }
}

/// Checks the times of a command.
///
/// # Errors
/// Too many times, a time that is longer than the one before, a move in no time, or a negative number.
pub(super) fn check_times(kind: CommandKind, request: &SettleRequest) -> Result<()> {
    let times = request.profile_s.as_deref().unwrap_or_default();
    times.iter().try_for_each(|time| check("profile_s", Some(*time), not_negative))?;
    check("sample_time_s", request.sample_time_s, positive)?;
    let payloads = request.robust_payload_kg.as_deref().unwrap_or_default();
    payloads.iter().try_for_each(|mass| check("robust_payload_kg", Some(*mass), not_negative))?;
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
    if kind == CommandKind::Trajectory && request.profile_s.is_some() {
        bail!("⟪profile_s⟫ is used by a stop or a move: a trajectory has its own times; leave one of the two out");
    }
    if kind == CommandKind::Motion(MotionKind::Move) && times.iter().sum::<f64>() <= 0.0 {
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
        ("robust_payload_kg", request.robust_payload_kg.is_some()),
    ];
    if let Some((name, _)) = given.iter().find(|(_, given)| *given) {
        bail!(
            "⟪{name}⟫ is used by a command, not by a release: give ⟪stop_m_s⟫, ⟪move_m⟫ or ⟪trajectory⟫, or leave it \
             out"
        );
    }
    Ok(())
}

impl<'a> Command<'a> {
    /// Command of a request; `None` for a release.
    ///
    /// # Errors
    /// A motion that the platform cannot have, or poses or lengths that the cables cannot hold.
    pub(super) fn of(at_rest: &'a AtRest, request: &SettleRequest) -> Result<Option<Self>> {
        Ok(match (CommandKind::of(request), &request.trajectory) {
            (Some(CommandKind::Motion(kind)), _) => Some(Self::Motion(Motion::of(at_rest, kind, request)?)),
            (Some(CommandKind::Trajectory), Some(columns)) => {
                Some(Self::Trajectory(Trajectory::of(at_rest, columns, request.tolerance_m)?))
            }
            _ => None,
        })
    }

    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::Motion(of) => CommandKind::Motion(of.kind),
            Self::Trajectory(_) => CommandKind::Trajectory,
        }
        .name()
    }

    /// Time from its start to its end [s].
    pub(super) fn duration(&self) -> f64 {
        self.lengths().duration()
    }

    /// Lengths over time.
    pub(super) fn lengths(&self) -> LengthCommand {
        match self {
            Self::Motion(of) => of.lengths(),
            Self::Trajectory(of) => of.lengths(),
        }
    }

    /// Command after a shaper.
    ///
    /// # Errors
    /// Poses or lengths that the cables cannot hold, or too many samples.
    pub(super) fn shaped(&self, shaper: &Shaper) -> Result<Self> {
        Ok(match self {
            Self::Motion(of) => Self::Motion(of.shaped(shaper)),
            Self::Trajectory(of) => Self::Trajectory(of.shaped(shaper)?),
        })
    }

    /// Equilibrium at its start.
    ///
    /// # Errors
    /// A pose or lengths that the cables cannot hold.
    pub(super) fn start(&self) -> Result<Equilibrium> {
        match self {
            Self::Motion(of) => of.start(),
            Self::Trajectory(of) => Ok(of.start().clone()),
        }
    }

    /// Warning about a rule of tensions that jumps between poses of the command.
    pub(super) fn rule_jumps(&self) -> Option<String> {
        match self {
            Self::Motion(of) => of.rule_jumps(),
            Self::Trajectory(of) => of.rule_jumps(),
        }
    }

    /// Lengths at equal steps of time, from the start to the end [m].
    ///
    /// # Errors
    /// Too many samples, or the errors of [`Motion::sampled`].
    pub(super) fn sampled(&self, step: f64) -> Result<Vec<LengthsRow>> {
        match self {
            Self::Motion(of) => of.sampled(step),
            Self::Trajectory(of) => of.sampled(step),
        }
    }

    /// Tensions of the cables at rest in the places of several times [N].
    ///
    /// # Errors
    /// A pose that the cables cannot hold.
    pub(super) fn still_at(&self, times: &[f64]) -> Result<Vec<Vec<f64>>> {
        match self {
            Self::Motion(of) => of.still_at(times),
            Self::Trajectory(of) => Ok(of.still_at(times)),
        }
    }
}

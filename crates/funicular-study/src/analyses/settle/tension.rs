//! Lowest tension of a cable while a command runs and after it.

use super::command::Command;
use crate::at_rest::AtRest;
use crate::error::NoSolution;
use crate::text::significant;
use anyhow::Result;
use funicular::modes::CommandedMotions;
use serde::Serialize;
use std::f64::consts::TAU;

/// Lowest tension of a cable during a motion and after it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LowestTension {
    pub cable: String,
    /// Time since the start of the command.
    pub t_s: f64,
    pub tension_n: f64,
}

/// Maximum number of times at which tensions are checked, and the number per period of the fastest mode.
const MAX_CHECKS: f64 = 2000.0;
const CHECKS_PER_PERIOD: f64 = 12.0;

impl LowestTension {
    /// Lowest tension during a command and after it.
    ///
    /// # Errors
    /// [`NoSolution`] for a cable that would be slack.
    pub(super) fn of(at_rest: &AtRest, command: &Command, motions: &CommandedMotions) -> Result<Self> {
        let times = checked_times(motions, command.duration());
        let still = command.still_at(&times)?;
        let beside = motions.tensions_beside_static(&command.lengths(), &times);

        let mut lowest: Option<(f64, usize, f64)> = None;
        for ((time, still), beside) in times.iter().zip(&still).zip(&beside) {
            for (i, still) in still.iter().enumerate() {
                let tension = still + beside.get(i).copied().unwrap_or_default();
                if lowest.is_none_or(|(_, _, least)| tension < least) {
                    lowest = Some((*time, i, tension));
                }
            }
        }
        let (t_s, i, tension_n) = lowest.unwrap_or((0.0, 0, 0.0));
        let cable = at_rest.robot.cables[i].name.clone();
        if tension_n <= 0.0 {
            return Err(NoSolution(format!(
                "cable \"{cable}\" becomes slack {} s after the start of the motion: its tension would be {} N, and a \
                 cable pulls in one direction only. The linear motion does not know that; only a simulation in time \
                 can tell what happens. Move more slowly, a stop and a move with longer times in ⟪profile_s⟫, or with \
                 more tension",
                significant(t_s, 3),
                significant(tension_n, 3)
            ))
            .into());
        }
        Ok(Self { cable, t_s, tension_n })
    }
}

/// Times during a command and for a period of the slowest mode after it.
fn checked_times(motions: &CommandedMotions, duration: f64) -> Vec<f64> {
    let frequencies = motions.motions.iter().map(|motion| motion.omega.re / TAU);
    let (slowest, fastest) = frequencies.fold((f64::INFINITY, 0.0), |(low, high), f| (f.min(low), f.max(high)));
    let until = duration + 1.0 / slowest;
    let points = (until * fastest * CHECKS_PER_PERIOD).clamp(2.0, MAX_CHECKS).ceil();
    (0..=points as usize).map(|i| until * i as f64 / points).collect()
}

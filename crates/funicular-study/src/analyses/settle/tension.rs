//! Lowest tension of a cable while a command runs and after it, or after a release.

use super::command::Command;
use crate::at_rest::AtRest;
use crate::error::NoSolution;
use crate::rows::rows;
use crate::text::significant;
use anyhow::Result;
use funicular::math::{Complex, Vec3, Vec6};
use funicular::modes::{CommandedMotions, Release};
use funicular::robot::Cable;
use funicular::statics::CableState;
use std::f64::consts::TAU;

rows! {
    /// Lowest tension of a cable during a command and after it, or after a release.
    #[derive(Debug, Clone, PartialEq)]
    pub struct LowestTension {
        pub cable: String;
        /// Time since the start of the command, or the release.
        pub t_s: f64;
        pub tension_n: f64;
    }
}

/// Maximum number of times at which tensions are checked, and the number per period of the fastest mode.
const MAX_CHECKS: f64 = 20_000.0;
const CHECKS_PER_PERIOD: f64 = 12.0;

impl LowestTension {
    /// Lowest tension during a command and after it.
    ///
    /// # Errors
    /// [`NoSolution`] for a cable that would be slack.
    pub(super) fn of(at_rest: &AtRest, command: &Command, motions: &CommandedMotions) -> Result<Self> {
        let frequencies = motions.motions.iter().map(|motion| motion.omega.re / TAU);
        let times = checked_times(frequencies, command.duration());
        let still = command.still_at(&times)?;
        let beside = motions.tensions_beside_static(&command.lengths(), &times);
        let lowest = lowest(&times, |k, i| still[k][i] + beside[k].get(i).copied().unwrap_or_default(), still[0].len());
        let remedy = "Move more slowly, a stop and a move with longer times in ⟪profile_s⟫, or with more tension";
        Self::named(at_rest, lowest, "the start of the motion", remedy)
    }

    /// Lowest tension after a release.
    ///
    /// # Errors
    /// [`NoSolution`] for a cable that would be slack.
    pub(super) fn after_release(at_rest: &AtRest, released: &Release) -> Result<Self> {
        let AtRest { robot, equilibrium, .. } = &*at_rest.vibrating();
        let times = checked_times(released.free.iter().map(|motion| motion.omega.re / TAU), 0.0);
        let rows: Vec<Vec6> = (robot.cables.iter().zip(&equilibrium.cables)).map(row_at_rest).collect();
        let amplitudes: Vec<Vec<Complex>> = (released.free.iter())
            .map(|motion| {
                let along =
                    |row: &Vec6| -> Complex { motion.platform.iter().zip(row.iter()).map(|(a, r)| a * *r).sum() };
                motion.tensions.iter().zip(&rows).map(|(own, row)| own.unwrap_or_else(|| along(row))).collect()
            })
            .collect();
        let factors: Vec<Vec<Complex>> = (released.free.iter())
            .map(|motion| times.iter().map(|time| (Complex::i() * motion.omega * *time).exp() * 2.0).collect())
            .collect();
        let tension = |k: usize, i: usize| {
            let beside: f64 = amplitudes.iter().zip(&factors).map(|(of, factors)| (of[i] * factors[k]).re).sum();
            equilibrium.cables[i].tension_platform + beside
        };
        let lowest = lowest(&times, tension, robot.cables.len());
        Self::named(at_rest, lowest, "the release", "Release less, or choose a state with more tension")
    }

    /// Lowest tension with the name of its cable.
    fn named(at_rest: &AtRest, (t_s, i, tension_n): (f64, usize, f64), start: &str, remedy: &str) -> Result<Self> {
        let cable = at_rest.robot.cables[i].name.clone();
        if tension_n <= 0.0 {
            return Err(NoSolution(format!(
                "cable \"{cable}\" becomes slack {} s after {start}: its tension would be {} N, and a cable pulls in \
                 one direction only. The linear motion does not know that; only a simulation in time can tell what \
                 happens. {remedy}",
                significant(t_s, 3),
                significant(tension_n, 3)
            ))
            .into());
        }
        Ok(Self { cable, t_s, tension_n })
    }
}

/// Time, index of the cable and tension where the tension is lowest.
fn lowest(times: &[f64], tension: impl Fn(usize, usize) -> f64, cables: usize) -> (f64, usize, f64) {
    let mut lowest = (0.0, 0, f64::INFINITY);
    for (k, time) in times.iter().enumerate() {
        for i in 0..cables {
            let tension = tension(k, i);
            if tension < lowest.2 {
                lowest = (*time, i, tension);
            }
        }
    }
    lowest
}

/// Row of the tension at the platform over the motion of the platform about its origin, world axes, of a cable at rest.
fn row_at_rest((cable, state): (&Cable, &CableState)) -> Vec6 {
    let pull = state.force_on_platform_w.try_normalize(0.0).unwrap_or_else(Vec3::zeros);
    let by_place = match &state.hanging {
        Some(hanging) => -(hanging.tangent_w() * pull),
        None => -pull * (cable.material.axial_stiffness / state.unstrained_length),
    };
    let by_turn = state.lever_w.cross(&by_place);
    Vec6::new(by_place.x, by_place.y, by_place.z, by_turn.x, by_turn.y, by_turn.z)
}

/// Times during a command and for a period of the slowest mode after it.
fn checked_times(frequencies: impl Iterator<Item = f64>, duration: f64) -> Vec<f64> {
    let (slowest, fastest) = frequencies.fold((f64::INFINITY, 0.0), |(low, high), f| (f.min(low), f.max(high)));
    let until = if slowest.is_finite() { duration + 1.0 / slowest } else { duration };
    let points = (until * fastest * CHECKS_PER_PERIOD).clamp(2.0, MAX_CHECKS).ceil();
    (0..=points as usize).map(|i| until * i as f64 / points).collect()
}

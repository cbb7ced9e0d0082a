//! Pairs that come too near between the times at which the robot is computed.

use super::Planned;
use super::at_time::in_motion;
use crate::error::Cancelled;
use crate::watch::Watch;
use anyhow::Result;
use funicular::clearance::{BetweenPlaces, Clearance, Surroundings, WayBetween};
use funicular::path::{PlatformPath, Side};
use funicular::statics::Equilibrium;

/// Number of parts in which the way of a path is added up, and the part that is added for what the speed does within
/// one of them.
const PARTS: usize = 4096;
const OF_A_PART: f64 = 0.01;

/// Pair that comes too near between two times, or a time at which this cannot be told.
#[derive(Debug, Clone, Copy)]
pub(super) enum Passing {
    TooNear { time: f64, clearance: Clearance },
    Undecided { time: f64 },
}

impl Passing {
    /// Looks between the times of a motion whose equilibria are known; `None` if every pair keeps its required distance
    /// there.
    ///
    /// # Errors
    /// A time at which the cables do not hold the platform, or [`Cancelled`].
    pub(super) fn look(
        planned: &Planned,
        known: &[(f64, &Equilibrium)],
        watch: &mut dyn Watch,
    ) -> Result<Option<Self>> {
        let around = Surroundings::of(planned.robot);
        let ways = WaysOfPath::of(&planned.path);
        let mut along = planned.along();
        let mut looked = 0;
        let rest_at = |time: f64| -> Result<Equilibrium> {
            looked += 1;
            watch.progress(looked, looked, "times between the rows");
            if watch.is_cancelled() {
                return Err(Cancelled.into());
            }
            Ok(in_motion(&mut along, planned, time, Side::After)?.equilibrium)
        };
        Ok(match around.too_near_between(known, |times| ways.between(times), rest_at)? {
            BetweenPlaces::Free => None,
            BetweenPlaces::TooNear { place, clearance } => Some(Self::TooNear { time: place, clearance }),
            BetweenPlaces::Undecided { place } => Some(Self::Undecided { time: place }),
        })
    }

    /// Pair that comes too near, with its time.
    pub(super) fn too_near(&self) -> Option<(f64, &Clearance)> {
        if let Self::TooNear { time, clearance } = self { Some((*time, clearance)) } else { None }
    }
}

/// Ways of the origin of the platform and its turns from the start of a path on.
struct WaysOfPath {
    duration: f64,
    translations: Vec<f64>,
    turns: Vec<f64>,
}

impl WaysOfPath {
    fn of(path: &PlatformPath) -> Self {
        let (duration, part) = (path.duration(), path.duration() / PARTS as f64);
        let speeds = |k: usize| path.at(part * k as f64).twist().map(|of| of.norm());
        let mut ways = Self { duration, translations: vec![0.0], turns: vec![0.0] };
        let (mut last, mut sums) = (speeds(0), [0.0; 2]);
        for k in 1..=PARTS {
            let next = speeds(k);
            for i in 0..2 {
                sums[i] += last[i].max(next[i]) * part * (1.0 + OF_A_PART);
            }
            ways.translations.push(sums[0]);
            ways.turns.push(sums[1]);
            last = next;
        }
        ways
    }

    fn between(&self, [from, to]: [f64; 2]) -> WayBetween {
        let at = |sums: &[f64], time: f64| {
            let place = (time / self.duration * PARTS as f64).clamp(0.0, PARTS as f64);
            let low = (place as usize).min(PARTS - 1);
            sums[low] + (sums[low + 1] - sums[low]) * (place - low as f64)
        };
        let way = |sums: &[f64]| at(sums, to) - at(sums, from);
        WayBetween { translation: way(&self.translations), turn: way(&self.turns) }
    }
}

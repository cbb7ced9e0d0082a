//! Shaper of a command: the modes that it cancels, its impulses, and what it leaves if the frequencies are others.

use super::history::SwingHistory;
use super::{HistoryRow, finite};
use crate::request::SettleRequest;
use crate::rows::rows;
use anyhow::{Result, anyhow, bail};
use funicular::modes::{Decay, DecayingMotion};
use funicular::path::{Impulse, Shaper, ShaperKind};
use std::f64::consts::TAU;

rows! {
    /// Shaper and what it does.
    pub struct Shaping {
        /// Name, as `zvd` or `ei:0.05`.
        pub shaper: String;
        /// Frequencies of the vibrations that it cancels.
        pub modes_hz: Vec<f64>;
        pub impulses: Vec<ImpulseRow>;
        /// Time by which the command is longer.
        pub longer_s: f64;
        /// Sum of all amplitudes at the end, with frequencies as they are and with others.
        pub robustness: Vec<Robustness>;
        /// Last time at which the point is at the tolerance without the shaper, since the end of the command without
        /// it; absent if it never settles.
        pub settled_without_s: Option<f64>;
        /// Time from which on the sum of all amplitudes without the shaper is within the tolerance; absent if it never
        /// is.
        pub surely_settled_without_s: Option<f64>;
        /// Motion from the end of the command without it.
        pub history_without: Vec<HistoryRow>;
    }
}

rows! {
    /// Part of the command and its delay.
    #[derive(Debug, Clone, Copy)]
    pub struct ImpulseRow {
        pub t_s: f64;
        pub part: f64;
    }
}

rows! {
    /// Vibration that is left if all frequencies are multiplied by a factor, with the shaper unchanged.
    #[derive(Debug, Clone, Copy)]
    pub struct Robustness {
        pub frequency_factor: f64;
        /// Sum of all amplitudes at the end of the shaped command.
        pub amplitude_m: f64;
        /// Sum of all amplitudes at the end of the command without the shaper.
        pub without_m: f64;
    }
}

/// Maximum number of modes that are chosen, or given: every mode makes the command longer.
const MAX_CHOSEN: usize = 3;
const MAX_GIVEN: usize = 5;

/// Factors of all frequencies for which the rest is listed: the range that a change of payload or pose easily brings.
const FACTORS: [f64; 3] = [0.9, 1.0, 1.1];

/// Maximum relative distance of a given frequency from that of a mode.
const SAME_MODE: f64 = 0.05;

/// Kind of the shaper of a request; `None` without one.
///
/// # Errors
/// A text that names no shaper, or frequencies without a shaper.
pub(super) fn kind(request: &SettleRequest) -> Result<Option<ShaperKind>> {
    let Some(text) = &request.shaper else {
        if request.shape_modes_hz.is_some() {
            bail!("⟪shape_modes_hz⟫ needs a shaper: give ⟪shaper⟫ zv, zvd or ei:0.05");
        }
        return Ok(None);
    };
    let refused = || {
        anyhow!(
            "⟪shaper⟫ `{text}` is no shaper: give zv, zvd, or ei:V with the vibration V that may be left, as in ei:0.05"
        )
    };
    Ok(Some(match text.trim() {
        "zv" => ShaperKind::Zv,
        "zvd" => ShaperKind::Zvd,
        other => {
            let vibration: f64 = other.strip_prefix("ei:").and_then(|v| v.parse().ok()).ok_or_else(refused)?;
            if !(vibration > 0.0 && vibration < 1.0) {
                bail!(
                    "⟪shaper⟫ `{text}`: the vibration that may be left is {vibration}; give a fraction between 0 and \
                     1, as in ei:0.05"
                );
            }
            ShaperKind::Ei(vibration)
        }
    }))
}

/// Shaper of a request for the motion that the command alone leaves, and the frequencies of its modes [Hz].
///
/// # Errors
/// A given frequency that no mode has.
pub(super) fn chosen(kind: ShaperKind, request: &SettleRequest, without: &Decay) -> Result<(Shaper, Vec<f64>)> {
    let Some(given) = &request.shape_modes_hz else { return Ok(loudest(kind, without, request.tolerance_m)) };
    if given.len() > MAX_GIVEN {
        bail!(
            "⟪shape_modes_hz⟫ has {} frequencies, and at most {MAX_GIVEN} are shaped: each makes the command longer",
            given.len()
        );
    }
    let mut shaper = Shaper::none();
    let mut found = Vec::new();
    for frequency_hz in given {
        let distance = |motion: &DecayingMotion| (motion.omega.norm() / TAU / frequency_hz - 1.0).abs();
        let nearest = without.motions.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let Some(mode) = nearest.filter(|mode| distance(mode) <= SAME_MODE) else {
            let near = nearest
                .map_or_else(String::new, |mode| format!("; the nearest is at {:.4} Hz", mode.omega.norm() / TAU));
            bail!(
                "⟪shape_modes_hz⟫ {frequency_hz}: no mode in which the platform moves is within {} % of it{near}",
                100.0 * SAME_MODE
            );
        };
        shaper = add(&shaper, kind, mode)?;
        found.push(mode.omega.norm() / TAU);
    }
    Ok((shaper, found))
}

fn add(shaper: &Shaper, kind: ShaperKind, mode: &DecayingMotion) -> Result<Shaper> {
    let own = Shaper::of_mode(kind, mode.omega);
    let own =
        own.ok_or_else(|| anyhow!("a motion that does not oscillate has no shaper: leave it out of ⟪shape_modes_hz⟫"))?;
    Ok(shaper.convolved(&own))
}

/// Shaper of the modes with the largest amplitudes, one after the other, until the sum of all amplitudes is within the
/// tolerance.
fn loudest(kind: ShaperKind, without: &Decay, tolerance: f64) -> (Shaper, Vec<f64>) {
    let (mut shaper, mut found) = (Shaper::none(), Vec::new());
    while found.len() < MAX_CHOSEN && total(without, &shaper, 1.0) > tolerance {
        let left = |motion: &DecayingMotion| motion.size() * shaper.left(motion.omega);
        let loudest = without.motions.iter().max_by(|a, b| left(a).total_cmp(&left(b)));
        let Some(mode) = loudest else { break };
        let Ok(more) = add(&shaper, kind, mode) else { break };
        shaper = more;
        found.push(mode.omega.norm() / TAU);
    }
    (shaper, found)
}

/// Sum of all amplitudes after a shaper, with all frequencies multiplied by a factor.
fn total(without: &Decay, shaper: &Shaper, factor: f64) -> f64 {
    without.motions.iter().map(|motion| motion.size() * shaper.left(motion.omega * factor)).sum()
}

impl Shaping {
    pub(super) fn of(name: &str, shaper: &Shaper, modes_hz: Vec<f64>, without: &Decay, tolerance: f64) -> Self {
        let surely = without.surely_settled(tolerance);
        let row = |impulse: &Impulse| ImpulseRow { t_s: impulse.time, part: impulse.amplitude };
        let robustness = |factor: f64| Robustness {
            frequency_factor: factor,
            amplitude_m: total(without, shaper, factor),
            without_m: total(without, &Shaper::none(), factor),
        };
        Self {
            shaper: name.trim().to_owned(),
            modes_hz,
            impulses: shaper.impulses.iter().map(row).collect(),
            longer_s: shaper.duration(),
            robustness: FACTORS.map(robustness).to_vec(),
            settled_without_s: finite(without.settled(tolerance)),
            surely_settled_without_s: finite(surely),
            history_without: SwingHistory::of(without, surely).rows,
        }
    }
}

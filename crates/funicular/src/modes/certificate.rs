//! Checks of a list of modes: its length before it is computed, and caveats about the result.

use super::damped::{self, DampedMode, DampedModes};
use super::{Modes, RESIDUAL_LIMIT};
use crate::counted;
use crate::dynamics::Dynamics;
use std::f64::consts::TAU;
use thiserror::Error;

/// Maximum number of modes in one list; a thousand modes take about 40 ms.
pub const MAX_MODES: usize = 20_000;
/// Maximum number of modes whose damped partners are computed; these take about 5 s.
const MAX_DAMPED: usize = 2_000;

/// More modes below the limit than a list may have.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error(
    "{count} natural frequencies lie below {below_hz} Hz, at most {max} are listed: lower the limit, or use the cable \
     model `spring`, in which cables have no frequencies of their own"
)]
pub struct TooMany {
    /// Number of modes below the limit.
    pub count: usize,
    /// Frequency limit [Hz].
    pub below_hz: f64,
    /// Maximum number of modes in a list.
    pub max: usize,
}

/// Checks that there are at most `max` modes below a limit. Counting is much faster than computing the list.
///
/// # Errors
/// [`TooMany`].
pub fn check_count(dynamics: &Dynamics, below_hz: f64, max: usize) -> Result<(), TooMany> {
    let count = dynamics.modes_below(below_hz * TAU);
    if count > max { Err(TooMany { count, below_hz, max }) } else { Ok(()) }
}

impl Modes {
    /// Caveat about a list that is not certified; `None` for a certified list.
    pub fn caveat(&self) -> Option<String> {
        if self.certified {
            return None;
        }

        let Self { modes, count_below, unstable_directions, below_hz, .. } = self;
        let listed = counted(modes.len(), "mode");
        let inexact = modes.iter().max_by(|a, b| a.residual.total_cmp(&b.residual));
        Some(match inexact {
            Some(mode) if modes.len() + unstable_directions == *count_below && mode.residual <= RESIDUAL_LIMIT => {
                format!(
                    "the list of {listed} is not certified, though the count confirms its number: the catenary-dynamic \
                     cables are not resolved up to {below_hz} Hz; lower the limit"
                )
            }
            Some(mode) if modes.len() + unstable_directions == *count_below => format!(
                "the list of {listed} is not certified, though the count confirms its number: the largest residual is \
                 {:.1e}, of the mode at {:.4} Hz",
                mode.residual, mode.frequency_hz
            ),
            _ => format!(
                "the list of {listed} is not certified: the count says {count_below} below {below_hz} Hz \
                 ({unstable_directions} of them unstable directions); modes may be missing or listed twice"
            ),
        })
    }
}

/// Damped partners of the modes of a list, unless it is too long, and caveats about them.
pub fn damped_partners(dynamics: &Dynamics, undamped: &Modes) -> (Option<DampedModes>, Vec<String>) {
    let count = undamped.modes.len();
    if count > MAX_DAMPED {
        let caveat = format!(
            "damping ratios are of first order: complex frequencies are computed for at most {MAX_DAMPED} modes, the \
             list has {count}; lower the limit"
        );
        return (None, vec![caveat]);
    }
    let damped = damped::damped_modes(dynamics, undamped);
    let caveats = damped.caveat(undamped).into_iter().chain(damped.caveat_of_pairs(undamped)).collect();
    (Some(damped), caveats)
}

/// Ratio of growth to frequency above which a motion grows: a thousand times the error of a damped frequency.
const GROWING: f64 = 1e-6;

impl DampedModes {
    /// Caveat about modes whose damped partners are not clear.
    pub fn caveat_of_pairs(&self, undamped: &Modes) -> Option<String> {
        /// Maximum number of frequencies that are named.
        const MAX_NAMED: usize = 5;

        let of = |k: &usize| format!("{:.4}", undamped.modes[*k].frequency_hz);
        let named: Vec<String> = self.unclear.iter().take(MAX_NAMED).map(of).collect();
        let more = self.unclear.len().saturating_sub(MAX_NAMED);
        (!named.is_empty()).then(|| {
            format!(
                "damping makes neighbouring vibrations one, so that it is not clear which damped vibration belongs to \
                 which of the modes at {}{} Hz: their eigenvalues and damping ratios are right as a set, \
                 not mode by mode",
                named.join(", "),
                if more > 0 { format!(" and {more} more") } else { String::new() }
            )
        })
    }

    /// Caveat about the damped partners of an undamped list, in addition to the caveat about that list.
    fn caveat(&self, undamped: &Modes) -> Option<String> {
        let grows = |mode: &&DampedMode| mode.omega.im < -GROWING * mode.omega.norm();
        if let Some(fastest) = self.modes.iter().filter(grows).min_by(|a, b| a.omega.im.total_cmp(&b.omega.im)) {
            let count = self.modes.iter().filter(grows).count();
            return Some(format!(
                "the control of the motors is unstable: {} by themselves, the fastest at {:.4} Hz; reduce its gain or \
                 its delay",
                if count == 1 { "one motion grows".to_owned() } else { format!("{count} motions grow") },
                fastest.ringing_hz()
            ));
        }

        match self.overdamped {
            0 if undamped.certified && !self.certified => Some(
                "the damped list is not certified: one of its searches did not settle, or its count differs; damping \
                 ratios may be wrong"
                    .to_owned(),
            ),
            0 if !self.others.is_empty() => {
                let frequencies: Vec<String> =
                    self.others.iter().map(|mode| format!("{:.4} Hz", mode.ringing_hz())).collect();
                Some(format!(
                    "damping lowers {} from above the limit to below it, at {}: raise the limit to list {}",
                    if frequencies.len() == 1 { "a frequency" } else { "frequencies" },
                    frequencies.join(", "),
                    if frequencies.len() == 1 { "the mode" } else { "the modes" },
                ))
            }
            0 => None,
            1 => Some(
                "one mode is so strongly damped that it does not ring: its damping ratio is 1 and its frequency one of \
                 two decay rates"
                    .to_owned(),
            ),
            n => Some(format!(
                "{n} modes are so strongly damped that they do not ring: their damping ratios are 1 and their \
                 frequencies one of two decay rates each"
            )),
        }
    }
}

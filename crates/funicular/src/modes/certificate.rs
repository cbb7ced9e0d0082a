//! What there is to say of a list of modes before it is computed and after.

use super::damped::{self, DampedModes};
use super::{Modes, RESIDUAL_LIMIT};
use crate::counted;
use crate::dynamics::Dynamics;
use std::f64::consts::TAU;
use thiserror::Error;

/// Most modes of one list that anyone reads; a thousand take some 40 ms.
pub const MOST: usize = 20_000;
/// Most modes whose damped partners are sought; these take some 5 s.
const MAX_DAMPED: usize = 2_000;

/// More modes than a list is made of.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error(
    "{count} natural frequencies lie below {below_hz} Hz, at most {most} are listed: lower the limit, or use the cable \
     model `spring`, which has none of the cables' own"
)]
pub struct TooMany {
    /// How many there are.
    pub count: usize,
    /// The limit [Hz].
    pub below_hz: f64,
    /// How many would be listed.
    pub most: usize,
}

/// Refuses a limit below which there are more than `most` modes; a count is much cheaper than the list.
///
/// # Errors
/// [`TooMany`].
pub fn check_count(dynamics: &Dynamics, below_hz: f64, most: usize) -> Result<(), TooMany> {
    let count = dynamics.modes_below(below_hz * TAU);
    if count > most { Err(TooMany { count, below_hz, most }) } else { Ok(()) }
}

impl Modes {
    /// What to say of a list that is not certified.
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
                    "the list of {listed} is not certified, though the count confirms its number: the catenary-dynamic cables are \
                     not resolved up to {below_hz} Hz; lower the limit"
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

/// The damped partners of a list, unless it is too long for them, and what there is to say of that.
pub fn damped_partners(dynamics: &Dynamics, undamped: &Modes) -> (Option<DampedModes>, Option<String>) {
    let count = undamped.modes.len();
    if count > MAX_DAMPED {
        let said = format!(
            "damping ratios are of first order: {count} modes are more than the {MAX_DAMPED} whose complex frequencies \
             are sought; lower the limit"
        );
        return (None, Some(said));
    }
    let damped = damped::damped_modes(dynamics, undamped);
    let caveat = damped.caveat(undamped);
    (Some(damped), caveat)
}

impl DampedModes {
    /// What to say of the partners of an undamped list, beyond what there is to say of that list.
    fn caveat(&self, undamped: &Modes) -> Option<String> {
        match self.overdamped {
            0 if undamped.certified && !self.certified => Some(
                "the damped list is not certified: one of its searches did not settle, or its count differs; damping \
                 ratios may be wrong"
                    .to_owned(),
            ),
            0 => None,
            n => Some(format!(
                "{} so strongly damped that they do not ring: their damping ratio is 1 and their frequency one of two \
                 decay rates",
                if n == 1 { "one mode is".to_owned() } else { format!("{n} modes are") }
            )),
        }
    }
}

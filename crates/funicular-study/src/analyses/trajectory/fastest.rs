//! Shortest duration of a path that keeps all limits, by one factor of all its times.

use super::samples::MotionSamples;
use super::{JudgedLimits, Planned, ROUNDING, used};
use crate::error::{ErrorKind, NoSolution};
use crate::watch::Watch;
use anyhow::Result;

/// Relative error of the duration.
pub(super) const TOLERANCE: f64 = 1e-4;

/// Number of times of the search, and largest number of halvings or doublings of the duration.
const TIMES: usize = 400;
const MAX_DOUBLINGS: usize = 30;

/// Factor by which a duration grows if a limit is exceeded between the times of the search.
const GROWTH: f64 = 1.0 + 0.5 * TOLERANCE;
const MAX_GROWTHS: usize = 40;

/// Fastest motion along the same poses.
///
/// # Errors
/// [`NoSolution`] if the limits are not kept even without motion or if nothing limits the motion, or
/// [`Cancelled`](crate::error::Cancelled).
pub(super) fn fastest<'a>(planned: &Planned<'a>, watch: &mut dyn Watch) -> Result<Planned<'a>> {
    let mut keeps = |factor: f64, times: usize| keeps_limits(&planned.slowed(factor), times, watch);

    // Bracket: too fast, slow enough.
    let (mut fast, mut slow) = (0.0, f64::INFINITY);
    let mut factor = 1.0;
    for _ in 0..MAX_DOUBLINGS {
        if keeps(factor, TIMES)? {
            slow = factor;
            factor *= 0.5;
        } else {
            fast = factor;
            factor *= 2.0;
        }
        if fast > 0.0 && slow.is_finite() {
            break;
        }
    }
    if slow.is_infinite() {
        return Err(NoSolution(
            "the path is beyond a limit at any speed: compute it without ⟪fastest⟫ and with a long ⟪duration_s⟫, which \
             shows the limit and its time"
                .to_owned(),
        )
        .into());
    }
    if fast == 0.0 {
        return Err(NoSolution(
            "nothing limits the speed on this path: give maximum tensions, or limits of the winches in the robot file"
                .to_owned(),
        )
        .into());
    }

    // Bisection, then what the times of the search have passed over.
    while slow > fast * (1.0 + TOLERANCE) {
        let middle = (fast * slow).sqrt();
        if keeps(middle, TIMES)? { slow = middle } else { fast = middle }
    }
    for _ in 0..MAX_GROWTHS {
        if keeps(slow, 4 * TIMES)? {
            break;
        }
        slow *= GROWTH;
    }
    Ok(planned.slowed(slow))
}

/// True if the motion keeps all limits of tensions and winches. Distances do not depend on the speed but by the sag,
/// and tensions by choice are found or not.
fn keeps_limits(planned: &Planned, count: usize, watch: &mut dyn Watch) -> Result<bool> {
    let judged = JudgedLimits { clearance: false, inertia: false, ..planned.judged };
    let plain = Planned { judged, ..planned.clone() };
    let samples = match MotionSamples::at(&plain, &[], count, watch) {
        Ok(samples) => samples,
        Err(error) if ErrorKind::of(&error) == ErrorKind::NoSolution => return Ok(false),
        Err(error) => return Err(error),
    };
    let within =
        |k: usize| used::most(&used::parts(&samples, &plain, k)).is_none_or(|(_, part)| part <= 1.0 + ROUNDING);
    Ok((0..samples.times.len()).all(within))
}

//! Search for slack cables that hold a pose, from many starts, for poses where the iteration from straight cables
//! fails.
//!
//! Near a pose that straight cables cannot hold, or hold only with enormous tensions, slack cables may have a stable
//! equilibrium. Their forces point away from the chord, so neither the straight tensions nor their derivatives lead to
//! the solution.

use super::{CableSearch, MIN_STRAIN, at_tension, lengthened, newton, tightened, wrench_residual};
use crate::catenary::space::HangingCable;
use crate::math::Mat6;
use crate::platform::{Coordinates, load_size};
use crate::robot::{Pose, Robot};
use crate::statics::equilibrium::RESIDUAL_LIMIT;
use crate::statics::loaded_cable::LoadedCable;

/// Maximum number of starts. Of 60,000 random robots in equilibrium with slack cables, 190 needed this search: for 150
/// of them the first two starts found tensions, for all of them 31 starts.
pub(super) const MAX_STARTS: usize = 40;

/// Number of starts after which the search continues only if one of them came near, see [`NEAR`].
const FEW_STARTS: usize = 8;

/// Scaled residual below which a failed start came near.
const NEAR: f64 = 0.03;

/// Maximum number of damped steps from one start. Half as many find 9 of 10 solutions that these find.
const MAX_STEPS: usize = 60;

/// Ratio of the imbalance after a step to that before, above which the search from a start ends: it has reached a local
/// minimum of the imbalance, not a balance. With 0.99 half of the solutions found with 0.9999 are lost.
const SLOW: f64 = 0.9999;

/// Scaled residual at which the undamped iteration takes over.
const HANDED_OVER: f64 = 1e-4;

/// Limits of the damping, relative to the mean square of the derivatives.
const MIN_DAMPING: f64 = 1e-15;
const MAX_DAMPING: f64 = 1e6;

/// Initial damping, and its factors after a step that does not gain and one that does. From a far smaller value the
/// first step leaves the region where its derivatives hold; from a far larger one the first ten steps are wasted.
const FIRST_DAMPING: f64 = 1e-2;
const DAMPING_AFTER_FAILURE: f64 = 5.0;
const DAMPING_AFTER_GAIN: f64 = 0.2;

/// Residual over [`HANDED_OVER`] at which the damped search ends and the undamped iteration goes on.
const WELL_HANDED_OVER: f64 = 0.01;

/// Range of start tensions over the cable's weight, if the platform weighs less: a level cable sags by its full chord
/// at the lower end, by a sixteenth of it at the upper one.
const MIN_TENSION_TO_WEIGHT: f64 = 0.2;
const MAX_TENSION_TO_WEIGHT: f64 = 2.0;

/// Largest change of the logarithm of a tension or of a length in one step.
const MAX_CHANGE: f64 = 2.0;

/// Irrational numbers, one per cable, whose multiples spread over [0, 1) without pattern (Weyl).
const SPREAD: [f64; 6] = [
    std::f64::consts::SQRT_2,
    1.732_050_807_568_877,
    2.236_067_977_499_79,
    2.645_751_311_064_591,
    3.316_624_790_355_4,
    3.605_551_275_463_989,
];

/// Result of the search.
pub(super) struct FoundStart {
    /// Accepted balance, or else the cables nearest to balance.
    pub best: CableSearch,
    /// Number of starts.
    pub starts: usize,
}

/// Searches from many starts for cables that balance the platform and satisfy `accept`.
pub(super) fn search(
    robot: &Robot,
    pose: &Pose,
    loaded: &[LoadedCable<'_>],
    accept: impl Fn(&CableSearch) -> bool,
) -> Option<FoundStart> {
    // Without sag, straight cables decide.
    if loaded.iter().all(|cable| cable.load.size == 0.0) {
        return None;
    }

    let mut best: Option<CableSearch> = None;
    let (mut iterations, mut starts) = (0, 0);
    for k in 0..MAX_STARTS {
        if k == FEW_STARTS && best.as_ref().is_none_or(|best| best.residual > NEAR) {
            break;
        }
        starts += 1;
        let mut found = levenberg_marquardt(robot, pose, start(robot, pose, loaded, k));
        iterations += found.iterations;

        // The undamped iteration gives the last digits.
        if found.residual < HANDED_OVER {
            for step in [lengthened, tightened] {
                let polished = newton(robot, pose, found.hanging.clone(), step);
                iterations += polished.iterations;
                if polished.residual <= RESIDUAL_LIMIT {
                    found = polished;
                    break;
                }
            }
        }

        if accept(&found) {
            found.iterations = iterations;
            return Some(FoundStart { best: found, starts });
        }
        if best.as_ref().is_none_or(|best| found.residual < best.residual) {
            best = Some(found);
        }
    }
    let mut best = best?;
    best.iterations = iterations;
    Some(FoundStart { best, starts })
}

/// Cables of the `k`-th start: tensions from a fifth of their weight, which is a deep sag, up to the total weight of
/// the platform.
fn start(robot: &Robot, pose: &Pose, loaded: &[LoadedCable<'_>], k: usize) -> Vec<HangingCable> {
    let cables = loaded.iter().zip(SPREAD);
    let hung = cables.map(|(cable, spread)| {
        let chord = cable.chord_w(pose).norm();
        let weight = (cable.load.size * chord).max(MIN_STRAIN * cable.axial_stiffness());
        let (low, high) = (MIN_TENSION_TO_WEIGHT * weight, load_size(robot).max(MAX_TENSION_TO_WEIGHT * weight));
        let part = ((k as f64 + 1.0) * spread).fract();
        cable.hang_with_tension(pose, low * (high / low).powf(part))
    });
    hung.collect()
}

/// Least squares of the remaining wrench by the method of Levenberg and Marquardt.
///
/// The unknowns are logarithms, see [`LogarithmicUnit`]: so damping has the same meaning for a taut and for a slack
/// cable.
fn levenberg_marquardt(robot: &Robot, pose: &Pose, mut hanging: Vec<HangingCable>) -> CableSearch {
    let coordinates = Coordinates::of(robot);
    let (mut wrench, mut residual) = wrench_residual(robot, &coordinates, pose, &hanging);
    let mut damping = FIRST_DAMPING;
    let mut iterations = 0;
    while iterations < MAX_STEPS && residual > WELL_HANDED_OVER * HANDED_OVER {
        iterations += 1;

        // Derivatives of the wrench with respect to the logarithms.
        let mut columns = Mat6::zeros();
        for (i, cable) in hanging.iter().enumerate() {
            let force = cable.force_by_length_w() * LogarithmicUnit::of(cable).length();
            columns.set_column(i, &coordinates.reduce_force(&force, &(cable.start_w - pose.position_w)));
        }

        // Limited damped step.
        let left = coordinates.reduce(&wrench);
        let mut normal = columns.transpose() * columns;
        let shift = damping * normal.trace().max(f64::MIN_POSITIVE) / hanging.len() as f64;
        (0..6).for_each(|k| normal[(k, k)] += shift);
        let Some(factor) = normal.cholesky() else { break };
        let change = -factor.solve(&(columns.transpose() * left));
        let change = change * (MAX_CHANGE / change.amax()).min(1.0);
        let next: Vec<HangingCable> = (hanging.iter().zip(&change))
            .map(|(cable, change)| LogarithmicUnit::of(cable).moved(cable, *change))
            .collect();

        // Take it if it is a gain.
        let (next_wrench, next_residual) = wrench_residual(robot, &coordinates, pose, &next);
        let (before, after) = (left.norm(), coordinates.reduce(&next_wrench).norm());
        if after < before {
            (hanging, wrench, residual) = (next, next_wrench, next_residual);
            damping = (DAMPING_AFTER_GAIN * damping).max(MIN_DAMPING);
            if after > SLOW * before {
                break;
            }
        } else {
            damping *= DAMPING_AFTER_FAILURE;
            if damping > MAX_DAMPING {
                break;
            }
        }
    }
    CableSearch { hanging, residual, iterations }
}

/// Change of length [m] that changes a cable's logarithm by one: that of its tension (falling) if it is taut, that of
/// its length if it is slack. The shorter of the two is used: the forces are less curved in it.
enum LogarithmicUnit {
    Tension(f64),
    Length(f64),
}

impl LogarithmicUnit {
    fn of(cable: &HangingCable) -> Self {
        let length = cable.catenary.rope().unstrained_length;
        let by_tension = -cable.catenary.parallel_tension() / cable.catenary.parallel_tension_by_length();
        if by_tension < length { Self::Tension(by_tension) } else { Self::Length(length) }
    }

    fn length(&self) -> f64 {
        match *self {
            Self::Tension(length) | Self::Length(length) => length,
        }
    }

    fn moved(&self, cable: &HangingCable, change: f64) -> HangingCable {
        match self {
            Self::Tension(_) => at_tension(cable, cable.catenary.parallel_tension() * (-change).exp()),
            Self::Length(length) => cable.at_length(length * change.exp()),
        }
    }
}

//! The search for slack cables that hold a pose, from many starts: where the iteration from straight cables fails.
//!
//! Next to a pose that straight cables cannot hold, or hold only with enormous tensions, slack ones may rest stably. Their
//! forces bend away from the chord, so that neither the straight tensions nor their derivatives point to the solution.

use super::{Balanced, MIN_STRAIN, at_tension, balanced, lengthened, tightened, unbalanced};
use crate::catenary::space::HangingCable;
use crate::math::Mat6;
use crate::platform::{Coordinates, load_size};
use crate::robot::{Pose, Robot};
use crate::statics::equilibrium::RESIDUAL_LIMIT;
use crate::statics::loaded_cable::LoadedCable;

/// Limit of starts. Of 60,000 random robots that rest with slack cables, 190 needed this search: 150 of them found
/// tensions from the first two starts, all from 31.
pub(super) const MAX_STARTS: usize = 40;

/// After so many starts the search goes on only if one of them came near, see [`NEAR`].
const FEW_STARTS: usize = 8;

/// Scaled residual below which a start that failed came near.
const NEAR: f64 = 0.03;

/// Limit of damped steps from one start. Half as many find 9 in 10 of what these find.
const MAX_STEPS: usize = 60;

/// A step that leaves more than this part of the imbalance ends the way from a start: it has come to rest at the least
/// imbalance around, which is none of balance. At 0.99 half of what is found with 0.9999 is lost.
const SLOW: f64 = 0.9999;

/// Scaled residual at which the undamped iteration takes over.
const HANDED_OVER: f64 = 1e-4;

/// Limits of the damping, in parts of the mean square of the derivatives.
const MIN_DAMPING: f64 = 1e-15;
const MAX_DAMPING: f64 = 1e6;

/// The damping at first, and its factors after a step that does not gain and one that does. From far less the first step
/// leaves the place where its derivatives hold; from far more the first ten are wasted.
const FIRST_DAMPING: f64 = 1e-2;
const MORE_DAMPING: f64 = 5.0;
const LESS_DAMPING: f64 = 0.2;

/// Residual over [`HANDED_OVER`] at which a way ends for the undamped iteration to go on.
const WELL_HANDED_OVER: f64 = 0.01;

/// Range of tensions at the start over the cable's weight, where the platform weighs less: a level cable sags by its whole
/// chord at the lower end, by a sixteenth at the upper one.
const DEEPEST: f64 = 0.2;
const TAUTEST: f64 = 2.0;

/// Largest change of the logarithm of a tension or of a length in one step.
const MAX_CHANGE: f64 = 2.0;

/// Irrational numbers whose multiples spread over [0, 1) without pattern (Weyl), one for each cable.
const SPREAD: [f64; 6] = [
    std::f64::consts::SQRT_2,
    1.732_050_807_568_877,
    2.236_067_977_499_79,
    2.645_751_311_064_591,
    3.316_624_790_355_4,
    3.605_551_275_463_989,
];

/// What the search found.
pub(super) struct Searched {
    /// The balance found, if one was accepted; else the nearest to balance.
    pub best: Balanced,
    /// Number of starts.
    pub starts: usize,
}

/// Searches from many starts for cables that balance the platform and that `accept` takes.
pub(super) fn search(
    robot: &Robot,
    pose: &Pose,
    loaded: &[LoadedCable<'_>],
    accept: impl Fn(&Balanced) -> bool,
) -> Option<Searched> {
    // Straight cables decide where no cable sags.
    if loaded.iter().all(|cable| cable.load.size == 0.0) {
        return None;
    }

    let mut best: Option<Balanced> = None;
    let (mut iterations, mut starts) = (0, 0);
    for k in 0..MAX_STARTS {
        if k == FEW_STARTS && best.as_ref().is_none_or(|best| best.residual > NEAR) {
            break;
        }
        starts += 1;
        let mut found = damped(robot, pose, start(robot, pose, loaded, k));
        iterations += found.iterations;

        // The last digits are those of the undamped iteration.
        if found.residual < HANDED_OVER {
            for step in [lengthened, tightened] {
                let polished = balanced(robot, pose, found.hanging.clone(), step);
                iterations += polished.iterations;
                if polished.residual <= RESIDUAL_LIMIT {
                    found = polished;
                    break;
                }
            }
        }

        if accept(&found) {
            found.iterations = iterations;
            return Some(Searched { best: found, starts });
        }
        if best.as_ref().is_none_or(|best| found.residual < best.residual) {
            best = Some(found);
        }
    }
    let mut best = best?;
    best.iterations = iterations;
    Some(Searched { best, starts })
}

/// Cables of the `k`-th start: tensions from a fifth of their weight, a deep sag, to all that the platform weighs.
fn start(robot: &Robot, pose: &Pose, loaded: &[LoadedCable<'_>], k: usize) -> Vec<HangingCable> {
    let cables = loaded.iter().zip(SPREAD);
    let hung = cables.map(|(cable, spread)| {
        let chord = cable.chord_w(pose).norm();
        let weight = (cable.load.size * chord).max(MIN_STRAIN * cable.axial_stiffness());
        let (low, high) = (DEEPEST * weight, load_size(robot).max(TAUTEST * weight));
        let part = ((k as f64 + 1.0) * spread).fract();
        cable.hang_with_tension(pose, low * (high / low).powf(part))
    });
    hung.collect()
}

/// Least squares of what is left of the balance, by the method of Levenberg and Marquardt.
///
/// The unknowns are logarithms, see [`Unit`]: damping then means the same for a taut cable and for a slack one.
fn damped(robot: &Robot, pose: &Pose, mut hanging: Vec<HangingCable>) -> Balanced {
    let coordinates = Coordinates::of(robot);
    let (mut wrench, mut residual) = unbalanced(robot, &coordinates, pose, &hanging);
    let mut damping = FIRST_DAMPING;
    let mut iterations = 0;
    while iterations < MAX_STEPS && residual > WELL_HANDED_OVER * HANDED_OVER {
        iterations += 1;

        // Derivatives of the wrench by the logarithms.
        let mut columns = Mat6::zeros();
        for (i, cable) in hanging.iter().enumerate() {
            let force = cable.force_by_length_w() * Unit::of(cable).length();
            columns.set_column(i, &coordinates.reduce_force(&force, &(cable.start_w - pose.position_w)));
        }

        // The damped step, limited.
        let left = coordinates.reduce(&wrench);
        let mut normal = columns.transpose() * columns;
        let shift = damping * normal.trace().max(f64::MIN_POSITIVE) / hanging.len() as f64;
        (0..6).for_each(|k| normal[(k, k)] += shift);
        let Some(factor) = normal.cholesky() else { break };
        let change = -factor.solve(&(columns.transpose() * left));
        let change = change * (MAX_CHANGE / change.amax()).min(1.0);
        let next: Vec<HangingCable> =
            (hanging.iter().zip(&change)).map(|(cable, change)| Unit::of(cable).moved(cable, *change)).collect();

        // Taken if it is a gain.
        let (next_wrench, next_residual) = unbalanced(robot, &coordinates, pose, &next);
        let (before, after) = (left.norm(), coordinates.reduce(&next_wrench).norm());
        if after < before {
            (hanging, wrench, residual) = (next, next_wrench, next_residual);
            damping = (LESS_DAMPING * damping).max(MIN_DAMPING);
            if after > SLOW * before {
                break;
            }
        } else {
            damping *= MORE_DAMPING;
            if damping > MAX_DAMPING {
                break;
            }
        }
    }
    Balanced { hanging, residual, iterations }
}

/// The change of length [m] by which a cable's logarithm grows by one: that of its tension where it is taut, downwards,
/// that of its length where it is slack. The shorter of the two is the one in which its forces bend less.
enum Unit {
    Tension(f64),
    Length(f64),
}

impl Unit {
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

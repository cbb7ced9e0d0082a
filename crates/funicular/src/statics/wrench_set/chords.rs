//! Wrenches of cables whose curves are replaced by their chords: a zonotope, with bounds of what the curves add to it
//! and take from it.

use super::cable_at_pose::CableAtPose;
use super::facets::facet_normals;
use super::reach::ReachableTensions;
use crate::math::{Mat6, Vec6};
use crate::robot::PlatformMotion;

/// Number of steps of the search for the bulge of a curve. Each shortens the interval by 0.618: its value, which is
/// flat at the maximum, is then known to its rounding.
const BULGE_STEPS: usize = 24;

/// Share of a chord in a normal, over its length, below which the chord lies in the facet.
const IN_FACET: f64 = 1e-9;

/// Excess of the tightening over the bound of the first order, for the Newton step that it stands for.
const TIGHTENING: f64 = 1.1;

/// Search for the deviations of the curves from their chords.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::statics) enum BulgeSearch {
    /// To their rounding.
    Exact,
    /// Bounds of them from three points of a taut cable, which take a tenth of the time.
    Bounds,
}

/// Wrenches that cables can apply to the platform together with its dead load; reduced [N].
#[derive(Debug, Clone)]
pub(in crate::statics) struct AvailableWrenches {
    /// Wrench of each cable at its minimum, and the change to its maximum.
    chords: Vec<[Vec6; 2]>,
    /// True for cables without a maximum.
    unlimited: Vec<bool>,
    /// Wrench of a unit force along the load of each cable, and the greatest deviations of the curve from its chord in
    /// this direction and against it [N].
    bulges: Vec<(Vec6, [f64; 2])>,
    facets: Vec<Facet>,
}

/// Half space `n·e ≤ reach` that contains all available wrenches.
#[derive(Debug, Clone, Copy)]
pub(in crate::statics) struct Facet {
    /// Outward unit normal.
    pub normal: Vec6,
    /// Reach that no wrench of the curves exceeds [N].
    pub outer: f64,
    /// Reach of the chords between tightened limits [N].
    pub inner: f64,
}

impl AvailableWrenches {
    /// Wrenches of cables with a dead load, reduced; without facets if the cables do not span all degrees of freedom or
    /// are too many.
    pub(in crate::statics) fn of(
        cables: Vec<CableAtPose>,
        load: &Vec6,
        motion: PlatformMotion,
        search: BulgeSearch,
    ) -> Self {
        let unlimited = cables.iter().map(|cable| cable.range.maximum.is_infinite()).collect();
        let (mut chords, mut bulges) = (Vec::new(), Vec::new());
        for mut cable in cables {
            let minimum = cable.at_minimum();
            let reach = ReachableTensions::of(&cable, minimum);
            let [from, to] = reach.wrenches(&motion);
            chords.push([from, to - from]);
            bulges.push(bulge(&cable, &reach, &motion, search));
        }

        let mut set = Self { chords, unlimited, bulges, facets: Vec::new() };
        let changes: Vec<Vec6> = set.chords.iter().map(|[_, change]| *change).collect();
        let normals = facet_normals(&changes, motion.count()).unwrap_or_default();
        let tightening = set.tightening(&changes, motion.count());
        set.facets = normals.into_iter().flat_map(|n| [n, -n]).map(|n| set.facet(&n, load, &tightening)).collect();
        set
    }

    /// True if no cable sags, so that the chords are the cables' wrenches.
    pub(in crate::statics) fn is_straight(&self) -> bool {
        self.bulges.iter().all(|(_, [above, below])| above.max(*below) <= 0.0)
    }

    /// Facets; empty if the set has no inside, or too many of them.
    pub(in crate::statics) fn facets(&self) -> &[Facet] {
        &self.facets
    }

    fn facet(&self, normal: &Vec6, load: &Vec6, tightening: &[f64]) -> Facet {
        let own = normal.dot(load);
        let [mut outer, mut inner] = [own; 2];
        let cables = self.chords.iter().zip(&self.unlimited).zip(self.bulges.iter().zip(tightening));
        for (([from, change], unlimited), ((upward, [above, below]), tight)) in cables {
            let (at_minimum, along) = (normal.dot(from), normal.dot(change));
            let is_endless = *unlimited && along > IN_FACET * change.norm();
            let farthest = if is_endless { f64::INFINITY } else { at_minimum + along.max(0.0) };
            let up = normal.dot(upward);
            outer += farthest + (up * above).max(-up * below).max(0.0);
            inner += farthest - tight * along.abs();
        }
        Facet { normal: *normal, outer, inner }
    }

    /// Part of every chord by which its limits are tightened, so that a Newton step from a point of the chords to one
    /// of the curves stays within the limits: (40k).
    fn tightening(&self, changes: &[Vec6], dof: usize) -> Vec<f64> {
        let height = |bulge: &(Vec6, [f64; 2])| bulge.1[0].max(bulge.1[1]);
        if self.is_straight() {
            return vec![0.0; changes.len()];
        }
        // The least change of the parts d with Σ change_i d_i = w is Cᵀ (C Cᵀ)⁻¹ w.
        let mut gram = Mat6::from_fn(|i, j| if i == j && i >= dof { 1.0 } else { 0.0 });
        for change in changes {
            gram.ger(1.0, change, change, 1.0);
        }
        let Some(inverse) = gram.cholesky().map(|factor| factor.inverse()) else { return vec![1.0; changes.len()] };
        let part = |change: &Vec6| {
            let along = inverse * change;
            TIGHTENING * self.bulges.iter().map(|bulge| along.dot(&bulge.0).abs() * height(bulge)).sum::<f64>()
        };
        changes.iter().map(part).collect()
    }
}

/// Wrench of a unit force upwards at the end of a cable, and the greatest deviations of the wrench from its chord along
/// it and against it [N]. At one horizontal force, chord and curve differ by a vertical force alone.
fn bulge(
    cable: &CableAtPose,
    reach: &ReachableTensions,
    motion: &PlatformMotion,
    search: BulgeSearch,
) -> (Vec6, [f64; 2]) {
    let up_w = cable.hanging.axes_w().1;
    let upward = motion.reduced(&cable.wrench(&up_w));
    if cable.weight_per_length() == 0.0 {
        return (upward, [0.0; 2]);
    }

    let [low, high] = reach.limits();
    let vertical = |tau: f64| {
        let mut there = cable.clone();
        there.set(tau);
        there.force().0.dot(&up_w)
    };
    let (from, to) = (vertical(low), vertical(high));
    let deviation = |part: f64| {
        // Nearly all of the bend is at low tensions: parts of the logarithm.
        let tau = low * (high / low).powf(part);
        let along = if high > low { (tau - low) / (high - low) } else { 0.0 };
        vertical(tau) - from - (to - from) * along
    };
    let weight_to_tension = cable.weight_per_length() * cable.hanging.chord_w().norm() / low;
    if search == BulgeSearch::Bounds && weight_to_tension < TAUT {
        return (upward, taut_bulge(deviation, low * weight_to_tension.powi(3)));
    }
    let above = greatest(deviation).max(0.0);
    let below = greatest(|part| -deviation(part)).max(0.0);
    (upward, [above, below])
}

/// Weight of a cable over its lowest tension below which [`taut_bulge`] holds.
const TAUT: f64 = 0.3;

/// Bounds of the deviations of a taut cable above and below its chord [N].
///
/// To first order in weight over tension the deviation is that of 1/H, whose greatest value is in the middle of the
/// logarithm. The next order is at most a twelfth of `third`, the weight cubed over the lowest tension squared; it is
/// added whole.
fn taut_bulge(deviation: impl Fn(f64) -> f64, third: f64) -> [f64; 2] {
    let near = [0.45, 0.5, 0.55].map(deviation);
    let largest = near.into_iter().fold(0.0, f64::max);
    let smallest = near.into_iter().fold(0.0, f64::min);
    [largest + third, third - smallest]
}

/// Greatest value of a function with one maximum between 0 and 1, by the golden section.
fn greatest(of: impl Fn(f64) -> f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    let (mut from, mut to) = (0.0, 1.0);
    let (mut a, mut b) = (1.0 - GOLDEN, GOLDEN);
    let (mut at_a, mut at_b) = (of(a), of(b));
    for _ in 0..BULGE_STEPS {
        if at_a > at_b {
            (to, b, at_b) = (b, a, at_a);
            a = to - GOLDEN * (to - from);
            at_a = of(a);
        } else {
            (from, a, at_a) = (a, b, at_b);
            b = from + GOLDEN * (to - from);
            at_b = of(b);
        }
    }
    at_a.max(at_b)
}

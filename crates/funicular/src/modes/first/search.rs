//! The lowest eigenvalue of a pencil, between a shift at which it is positive definite and a Rayleigh quotient.

use super::cables::Cables;
use super::factor::Factor;
use super::pencil::{Motion, Pencil};
use crate::cable::exact::abreast::{Kept, place};
use crate::math::DMat;

/// How far a search goes.
pub(super) struct Aim {
    /// Relative width in ω² between the shift and the Rayleigh quotient.
    width: f64,
    /// Most steps of inverse iteration at one shift; they end when the quotient stands still.
    steps: usize,
    /// The last step has to be finer than the one before.
    checked: bool,
}

/// Rounding, which is the stiffest spring's over the softest motion's, comes to 1e-13 in usual robots.
pub(super) const EXACT: Aim = Aim { width: 1e-9, steps: 6, checked: true };
/// Where a step costs little.
pub(super) const NEAR: Aim = Aim { width: 0.1, steps: 10, checked: false };

/// One shift, at rest or well below: as good as cables allow whose unknowns follow as at another frequency.
pub(super) const ROUGH: Aim = Aim { width: 2.0, steps: 6, checked: false };

/// Evaluations after which the slow way is faster.
const MOST_EVALUATIONS: usize = 40;

/// Motions that go along where frequencies are close to each other.
const BLOCK: usize = 3;

/// Motions, and the Rayleigh quotient of the first.
pub(super) struct Found {
    pub(super) square: f64,
    pub(super) motions: Vec<Motion>,
    /// Mass of platform and cables in the first motion.
    pub(super) mass: f64,
    /// The part of each arm.
    pub(super) arms: Vec<f64>,
}

/// The lowest eigenvalue within the aim's width, from a shift x and motions near it; none if the pencil is not positive
/// definite at rest, or the search does not end.
///
/// Inverse iteration at each shift; the next shift is half the width below the quotient, so that the search ends with the
/// first one that is positive definite. Where this leads to a higher mode, or above several, more motions go along, and
/// shifts are halved between what is known.
pub(super) fn lowest(
    pencil: &Pencil,
    cables: &mut impl Cables,
    metric: &[Kept],
    mut x: f64,
    mut motions: Vec<Motion>,
    aim: &Aim,
) -> Option<Found> {
    let (mut low, mut high) = (0.0_f64, f64::INFINITY);
    let mut kept = Vec::with_capacity(metric.len());
    let mut before = f64::INFINITY;
    let mut refined = false;
    let mut last: Option<Found> = None;
    for _ in 0..MOST_EVALUATIONS {
        cables.kept(x, &mut kept);
        let factor = Factor::of(pencil, &kept, x);
        if let Some(found) = last.take() {
            // A finer discretisation has nothing below either.
            if aim.checked && refined && factor.negative == 0 {
                return Some(found);
            }
            motions = found.motions;
        }
        if factor.negative == 0 {
            low = x;
        } else if x == 0.0 {
            return None;
        } else {
            high = high.min(x);
        }
        if factor.negative > 1 {
            motions.extend(
                (motions.len()..factor.negative.clamp(2, BLOCK)).map(|number| pencil.any_motion(metric, number)),
            );
        }
        let mut found = improved(pencil, cables, metric, &factor, x, std::mem::take(&mut motions), aim);
        let quotient = found.square;
        if !quotient.is_finite() {
            return None;
        }
        if !aim.checked && factor.negative == 0 && quotient - x <= aim.width * quotient {
            return Some(found);
        }
        let next = quotient * (1.0 - 0.5 * aim.width);
        // A quotient that does not fall belongs to another mode.
        let leads = quotient > 0.0 && quotient <= high && quotient < before;
        // Only a shift that a coarser discretisation led to checks this one.
        refined = leads && (quotient - x).abs() < CLOSE * quotient;
        if refined {
            cables.refine();
        }
        if leads {
            (before, high) = (quotient, quotient);
        } else {
            let more = found.motions.len()..BLOCK;
            found.motions.extend(more.map(|number| pencil.any_motion(metric, number)));
        }
        last = Some(found);
        // A lower bound of a coarser discretisation may lie above.
        low = if low < high { low } else { 0.9 * high };
        x = match () {
            () if leads => next,
            () if low > 0.0 => 0.25 * low + 0.75 * high,
            () => 0.75 * high,
        };
    }
    None
}

/// Relative distance of a shift from its quotient below which a coarse discretisation would be felt.
const CLOSE: f64 = 0.1;

/// Inverse iteration at a shift, and what is best of several motions.
fn improved(
    pencil: &Pencil,
    cables: &impl Cables,
    metric: &[Kept],
    factor: &Factor,
    x: f64,
    mut motions: Vec<Motion>,
    aim: &Aim,
) -> Found {
    let count = motions.len();
    let mut forces: Vec<Motion> = motions.iter().map(|motion| pencil.inertia(metric, motion)).collect();
    // A z = B y, so zᵀ A z without another product.
    let mut images = Vec::new();
    let mut before = f64::INFINITY;
    for _ in 0..aim.steps {
        images = std::mem::take(&mut forces);
        let mut least = f64::INFINITY;
        for k in 0..count {
            motions[k] = factor.solve(pencil, &images[k]);
            // Apart from each other, or all become the first.
            let (done, rest) = motions.split_at_mut(k);
            let (images_done, images_rest) = images.split_at_mut(k);
            for ((motion, image), force) in done.iter().zip(&*images_done).zip(&forces) {
                let part = force.dot(&rest[0]);
                rest[0].add(-part, motion);
                images_rest[0].add(-part, image);
            }
            let mut force = pencil.inertia(metric, &rest[0]);
            let size = 1.0 / force.dot(&rest[0]).sqrt();
            for vector in [&mut force, &mut rest[0], &mut images_rest[0]] {
                vector.scale(size);
            }
            least = least.min(rest[0].dot(&images_rest[0]));
            forces.push(force);
        }
        if (least - before).abs() <= 0.01 * least.abs() + 0.1 * aim.width * (x + least).abs() {
            break;
        }
        before = least;
    }
    let work = |i: usize, j: usize| motions[i].dot(&images[j]);
    let mut arms = vec![Vec::with_capacity(pencil.arms.len()); place(count, 0)];
    for group in 0..metric.len() {
        let ends: Vec<_> = motions.iter().map(|motion| motion.lanes(&pencil.arms, group)).collect();
        let lanes = pencil.arms.iter().filter(|arm| arm.group == group).count();
        for (arms, masses) in arms.iter_mut().zip(cables.mass(group, &ends)) {
            arms.extend_from_slice(&masses[..lanes]);
        }
    }
    let mass = |i: usize, j: usize| {
        let by_arms: f64 = arms[place(i.max(j), i.min(j))].iter().sum();
        motions[i].platform.dot(&(pencil.mass * motions[j].platform)) + by_arms
    };
    if count == 1 {
        let mass = mass(0, 0);
        return Found { square: x + work(0, 0) / mass, mass, motions, arms: arms.swap_remove(0) };
    }
    combined(x, &DMat::from_fn(count, count, work), &DMat::from_fn(count, count, mass), &motions, &arms)
}

/// The motions in which stiffness and mass are diagonal, ascending by their quotient.
fn combined(x: f64, work: &DMat, mass: &DMat, motions: &[Motion], arms: &[Vec<f64>]) -> Found {
    let count = motions.len();
    let nothing = || Found { square: f64::NAN, motions: motions.to_vec(), mass: f64::NAN, arms: Vec::new() };
    let Some(factor) = mass.clone().cholesky() else { return nothing() };
    let l = factor.l();
    let (Some(inverse), symmetric) = (l.try_inverse(), (work + work.transpose()) * 0.5) else { return nothing() };
    let eigen = (&inverse * symmetric * inverse.transpose()).symmetric_eigen();
    let parts = inverse.transpose() * &eigen.eigenvectors;
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));
    let motion = |&k: &usize| {
        let mut sum = motions[0].clone();
        sum.scale(parts[(0, k)]);
        for i in 1..count {
            sum.add(parts[(i, k)], &motions[i]);
        }
        sum
    };
    let first = parts.column(order[0]);
    let of_arm = |arm: usize| {
        let pairs = (0..count).flat_map(|i| (0..count).map(move |j| (i, j)));
        pairs.map(|(i, j)| first[i] * first[j] * arms[place(i.max(j), i.min(j))][arm]).sum()
    };
    Found {
        square: x + eigen.eigenvalues[order[0]],
        motions: order.iter().map(motion).collect(),
        mass: 1.0,
        arms: (0..arms[0].len()).map(of_arm).collect(),
    }
}

//! The lowest eigenvalue of a pencil, between a shift at which it is positive definite and a Rayleigh quotient.

use super::batched_cable::{Kept, place};
use super::condensed_cables::{Cables, KeptMotion};
use super::factor::Factor;
use super::lever_axes::RobotMotion;
use super::pencil::RobotPencil;
use crate::math::simd::{LANES, Lane, sum};
use crate::math::{DMat, symmetric_part};
use pulp::Simd;

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
const MAX_EVALUATIONS: usize = 40;

/// Motions that go along where frequencies are close to each other.
const BLOCK: usize = 3;

/// Motions, and the Rayleigh quotient of the first.
pub(super) struct LowestPair {
    pub(super) square: f64,
    pub(super) motions: Vec<RobotMotion>,
    /// Mass of platform and cables in the first motion.
    pub(super) mass: f64,
    /// The part of each cable, in groups.
    pub(super) cables: Vec<Lane>,
}

/// The interval that holds the lowest eigenvalue, as far as it is known.
struct Bracket {
    /// Highest shift at which the pencil was positive definite.
    low: f64,
    /// Lowest Rayleigh quotient, or shift with an eigenvalue below.
    high: f64,
    /// Last Rayleigh quotient that led downwards.
    leading: f64,
}

impl Bracket {
    /// Takes the inertia of the pencil at a shift: so many eigenvalues lie below. False at a shift of zero with any: then
    /// the pencil is not positive definite at rest.
    fn narrow(&mut self, x: f64, negative: usize) -> bool {
        if negative == 0 {
            self.low = x;
            return true;
        }
        self.high = self.high.min(x);
        x > 0.0
    }

    /// Takes a Rayleigh quotient. False if it leads nowhere: a quotient that does not fall belongs to another mode.
    fn lower_to(&mut self, quotient: f64) -> bool {
        let leads = quotient > 0.0 && quotient <= self.high && quotient < self.leading;
        if leads {
            (self.leading, self.high) = (quotient, quotient);
        }

        // A lower bound of a coarser discretisation may lie above.
        if self.low >= self.high {
            self.low = WITHIN_COARSE * self.high;
        }
        leads
    }

    /// A shift inside, nearer to its upper end, where the eigenvalue usually is.
    fn inside(&self) -> f64 {
        if self.low > 0.0 { 0.25 * self.low + 0.75 * self.high } else { 0.75 * self.high }
    }
}

/// Fraction of an upper bound that is taken for a lower one where a coarse discretisation has given one above it. The
/// coarsest has two digits (see [`degree_of_start`](super::condensed_cables::degree_of_start)), so 0.9 is safe; much less
/// would forget what is known.
const WITHIN_COARSE: f64 = 0.9;

/// What an evaluation has found.
struct UnprovenPair {
    found: LowestPair,
    /// The pencil of a finer discretisation at the next shift proves it by being positive definite there.
    provable: bool,
}

/// Lowest eigenvalue within the aim's width, from a shift x and motions near it; none if the pencil is not positive
/// definite at rest, or the search does not end.
///
/// Inverse iteration at each shift; the next shift is half the width below the quotient, so that the search ends with the
/// first one that is positive definite. Where this leads to a higher mode, or above several, more motions go along, and
/// shifts are halved between what is known.
pub(super) fn lowest(
    pencil: &RobotPencil,
    cables: &mut impl Cables,
    metric: &[Kept],
    mut x: f64,
    mut motions: Vec<RobotMotion>,
    aim: &Aim,
) -> Option<LowestPair> {
    let mut bracket = Bracket { low: 0.0, high: f64::INFINITY, leading: f64::INFINITY };
    let mut kept = Vec::with_capacity(metric.len());
    let mut claim: Option<UnprovenPair> = None;

    for _ in 0..MAX_EVALUATIONS {
        // Bracket: the eigenvalues below the shift are counted.
        cables.kept(x, &mut kept);
        let factor = Factor::of(pencil, &kept, x);
        if !bracket.narrow(x, factor.negative) {
            return None;
        }

        // Verify: no eigenvalue lies below the shift that the last quotient led to. A finer discretisation has nothing
        // below either.
        if let Some(UnprovenPair { found, provable }) = claim.take() {
            if provable && factor.negative == 0 {
                return Some(found);
            }
            motions = found.motions;
        }

        // Iterate: the motions come nearer to the lowest ones. Where several eigenvalues lie below, as many go along.
        if factor.negative > 1 {
            add_any_motions(pencil, metric, &mut motions, factor.negative.min(BLOCK));
        }
        let mut found = improved(pencil, cables, metric, &factor, x, std::mem::take(&mut motions), aim);
        let quotient = found.square;
        if !quotient.is_finite() {
            return None;
        }
        if !aim.checked && factor.negative == 0 && quotient - x <= aim.width * quotient {
            return Some(found);
        }

        // The next shift: just below the quotient, or between what is known. Only a shift that a coarser discretisation
        // led to checks this one.
        let leads = bracket.lower_to(quotient);
        let close = leads && (quotient - x).abs() < CLOSE * quotient;
        if close {
            cables.refine();
        }
        if !leads {
            add_any_motions(pencil, metric, &mut found.motions, BLOCK);
        }
        x = if leads { quotient * (1.0 - 0.5 * aim.width) } else { bracket.inside() };
        claim = Some(UnprovenPair { found, provable: aim.checked && close });
    }
    None
}

/// Adds motions of no particular shape until there are `count`.
fn add_any_motions(pencil: &RobotPencil, metric: &[Kept], motions: &mut Vec<RobotMotion>, count: usize) {
    motions.extend((motions.len()..count).map(|number| pencil.any_motion(metric, number)));
}

/// Relative distance of a shift from its quotient below which a coarse discretisation would be felt.
const CLOSE: f64 = 0.1;

/// Inverse iteration at a shift, and what is best of several motions.
fn improved(
    pencil: &RobotPencil,
    cables: &impl Cables,
    metric: &[Kept],
    factor: &Factor,
    x: f64,
    motions: Vec<RobotMotion>,
    aim: &Aim,
) -> LowestPair {
    let Iterated { motions, work, ends } =
        pulp::Arch::new().dispatch(Iteration { pencil, metric, factor, x, motions, aim });
    let count = motions.len();

    // Masses of the cables in groups, for each pair of motions.
    let mut parts = vec![Vec::with_capacity(ends.len()); place(count, 0)];
    for (group, ends) in ends.iter().enumerate() {
        for (part, masses) in parts.iter_mut().zip(cables.mass(group, ends)) {
            part.push(masses);
        }
    }
    let mass = |i: usize, j: usize| {
        let by_cables: f64 = parts[place(i.max(j), i.min(j))].iter().map(sum).sum();
        pencil.platform_mass(&motions[i], &motions[j]) + by_cables
    };

    if count == 1 {
        let mass = mass(0, 0);
        return LowestPair { square: x + work[0] / mass, mass, motions, cables: parts.swap_remove(0) };
    }
    let work = |i: usize, j: usize| work[count * i + j];
    combined(x, &DMat::from_fn(count, count, work), &DMat::from_fn(count, count, mass), motions, &parts)
}

struct Iteration<'a> {
    pencil: &'a RobotPencil,
    metric: &'a [Kept],
    factor: &'a Factor,
    x: f64,
    motions: Vec<RobotMotion>,
    aim: &'a Aim,
}

struct Iterated {
    motions: Vec<RobotMotion>,
    /// `yᵀ (K − xM) z` of all pairs of motions.
    work: Vec<f64>,
    /// The kept unknowns of each group, of each motion.
    ends: Vec<Vec<KeptMotion>>,
}

impl pulp::WithSimd for Iteration<'_> {
    type Output = Iterated;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Iterated {
        let Self { pencil, metric, factor, x, mut motions, aim } = self;
        let count = motions.len();

        // B y of each motion.
        let (mut forces, mut images) = (Vec::with_capacity(count), Vec::with_capacity(count));
        for motion in &motions {
            let mut force = RobotMotion::any(metric.len());
            pencil.inertia(simd, metric, motion, &mut force);
            forces.push(force);
            images.push(RobotMotion::any(metric.len()));
        }

        // Inverse iteration until the least quotient stands still.
        let mut before = f64::INFINITY;
        for _ in 0..aim.steps {
            // A z = B y, so zᵀ A z without another product.
            std::mem::swap(&mut images, &mut forces);
            let mut least = f64::INFINITY;
            for k in 0..count {
                factor.solve(simd, pencil, &images[k], &mut motions[k]);

                // Apart from each other, or all become the first.
                let (done, rest) = motions.split_at_mut(k);
                let (images_done, images_rest) = images.split_at_mut(k);
                let (forces_done, forces_rest) = forces.split_at_mut(k);
                let (motion, image, force) = (&mut rest[0], &mut images_rest[0], &mut forces_rest[0]);
                for i in 0..k {
                    let part = forces_done[i].dot(simd, motion);
                    motion.add(simd, -part, &done[i]);
                    image.add(simd, -part, &images_done[i]);
                }

                // To unit length, with the force that goes along.
                pencil.inertia(simd, metric, motion, force);
                let size = 1.0 / force.dot(simd, motion).sqrt();
                for vector in [&mut *force, &mut *motion, &mut *image] {
                    vector.scale(simd, size);
                }
                least = least.min(motion.dot(simd, image));
            }

            if (least - before).abs() <= 0.01 * least.abs() + 0.1 * aim.width * (x + least).abs() {
                break;
            }
            before = least;
        }

        // Products of all pairs, and the motion of the kept unknowns.
        let mut work = Vec::with_capacity(count * count);
        for motion in &motions {
            for image in &images {
                work.push(motion.dot(simd, image));
            }
        }

        let mut ends = Vec::with_capacity(metric.len());
        for (group, arms) in pencil.arms.iter().enumerate() {
            let mut of_group = Vec::with_capacity(count);
            for motion in &motions {
                of_group.push(motion.kept(simd, arms, group));
            }
            ends.push(of_group);
        }

        Iterated { motions, work, ends }
    }
}

/// `Σ factor motion`.
struct Sum<'a> {
    motions: &'a [RobotMotion],
    factors: Vec<f64>,
    groups: usize,
}

impl pulp::WithSimd for Sum<'_> {
    type Output = RobotMotion;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> RobotMotion {
        let Self { motions, factors, groups } = self;
        let mut sum = RobotMotion::any(groups);
        sum.clear();
        for (motion, factor) in motions.iter().zip(factors) {
            sum.add(simd, factor, motion);
        }
        sum
    }
}

/// The motions in which stiffness and mass are diagonal, ascending by their quotient.
fn combined(x: f64, work: &DMat, mass: &DMat, motions: Vec<RobotMotion>, parts: &[Vec<Lane>]) -> LowestPair {
    let count = motions.len();
    let groups = parts[0].len();

    // L⁻¹ A L⁻ᵀ with the mass L Lᵀ has the quotients as its eigenvalues.
    let factor = mass.clone().cholesky();
    let Some(inverse) = factor.and_then(|factor| factor.l().try_inverse()) else {
        return LowestPair { square: f64::NAN, motions, mass: f64::NAN, cables: Vec::new() };
    };
    let symmetric = symmetric_part(work);
    let eigen = (&inverse * symmetric * inverse.transpose()).symmetric_eigen();
    let vectors = inverse.transpose() * &eigen.eigenvectors;
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));

    // Motions, ascending, and the masses of the cables in the first.
    let motion = |&k: &usize| {
        let factors = vectors.column(k).iter().copied().collect();
        pulp::Arch::new().dispatch(Sum { motions: &motions, factors, groups })
    };
    let first = vectors.column(order[0]);
    let of_group = |group: usize| {
        let mut masses = [0.0; LANES];
        for i in 0..count {
            for j in 0..count {
                let part = &parts[place(i.max(j), i.min(j))][group];
                for (mass, part) in masses.iter_mut().zip(part) {
                    *mass += first[i] * first[j] * part;
                }
            }
        }
        masses
    };

    LowestPair {
        square: x + eigen.eigenvalues[order[0]],
        motions: order.iter().map(motion).collect(),
        mass: 1.0,
        cables: (0..groups).map(of_group).collect(),
    }
}

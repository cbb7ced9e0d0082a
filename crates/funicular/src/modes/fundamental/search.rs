//! Search for the lowest eigenvalue of a pencil, between a shift at which the pencil is positive definite and a
//! Rayleigh quotient.

use super::batched_cable::{KeptStiffness, place};
use super::condensed_cables::{Cables, KeptMotion};
use super::factor::Factor;
use super::lever_axes::RobotMotion;
use super::pencil::RobotPencil;
use crate::math::simd::{LANES, Lane, sum};
use crate::math::{DMat, order, symmetric_part};
use pulp::Simd;

/// Accuracy and effort of a search.
pub(super) struct SearchOptions {
    /// Relative width in ω² between the shift and the Rayleigh quotient.
    width: f64,
    /// Maximum number of steps of inverse iteration at one shift; they end when the quotient is constant.
    steps: usize,
    /// True if the last step must have a finer discretisation than the step before.
    checked: bool,
}

/// Final search. The rounding errors, those of the stiffest spring relative to the softest motion, are 1e-13 in usual
/// robots.
pub(super) const FINAL: SearchOptions = SearchOptions { width: 1e-9, steps: 6, checked: true };

/// First search for cables of one element, whose steps cost little.
pub(super) const NEAR: SearchOptions = SearchOptions { width: 0.1, steps: 10, checked: false };

/// First search for divided cables: one shift, zero or well below the result. More accuracy is useless while the
/// eliminated unknowns follow as at another frequency.
pub(super) const ROUGH: SearchOptions = SearchOptions { width: 2.0, steps: 6, checked: false };

/// Maximum number of evaluations; beyond it the slow method is faster.
const MAX_EVALUATIONS: usize = 40;

/// Maximum number of motions iterated together if frequencies are close to each other.
const BLOCK: usize = 3;

/// Approximation of the lowest eigenvalue and its motion.
pub(super) struct LowestPair {
    /// Rayleigh quotient of the first motion [rad²/s²].
    pub(super) square: f64,
    /// Motions, the lowest first.
    pub(super) motions: Vec<RobotMotion>,
    /// Mass of platform and cables in the first motion.
    pub(super) mass: f64,
    /// Mass of each cable in the first motion, in groups.
    pub(super) cables: Vec<Lane>,
}

/// Interval that contains the lowest eigenvalue.
struct Bracket {
    /// Highest shift at which the pencil was positive definite.
    low: f64,
    /// Lowest Rayleigh quotient or lowest shift with an eigenvalue below.
    high: f64,
    /// Last Rayleigh quotient that was lower than all before.
    leading: f64,
}

impl Bracket {
    /// Uses the inertia of the pencil at a shift, with `negative` eigenvalues below. The result is false if there are
    /// any below a shift of zero: then the stiffness is not positive definite.
    fn narrow(&mut self, x: f64, negative: usize) -> bool {
        if negative == 0 {
            self.low = x;
            return true;
        }
        self.high = self.high.min(x);
        x > 0.0
    }

    /// Uses a Rayleigh quotient. The result is false if the quotient does not fall: then it belongs to another mode.
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

    /// Shift inside the interval, nearer to its upper end, where the eigenvalue usually is.
    fn inside(&self) -> f64 {
        if self.low > 0.0 { 0.25 * self.low + 0.75 * self.high } else { 0.75 * self.high }
    }
}

/// Fraction of the upper bound that becomes the lower bound if a coarse discretisation has given a lower bound above
/// it. The coarsest discretisation has two digits (see [`degree_of_start`](super::condensed_cables::degree_of_start)),
/// so 0.9 is safe; a much smaller value would lose information.
const WITHIN_COARSE: f64 = 0.9;

/// Result of an evaluation that the next one may prove.
struct UnprovenPair {
    found: LowestPair,
    /// True if it is proved when the pencil of a finer discretisation is positive definite at the next shift.
    provable: bool,
}

/// Lowest eigenvalue within the aim's width, from a shift x and motions near it; `None` if the stiffness is not
/// positive definite, or the search does not end.
///
/// Each shift has an inverse iteration. The next shift is half the width below the quotient, so that the search ends at
/// the first shift at which the pencil is positive definite. If the iteration leads to a higher mode, or several modes
/// lie below, more motions are iterated together, and the next shift lies inside the known interval.
pub(super) fn lowest(
    pencil: &RobotPencil,
    cables: &mut impl Cables,
    metric: &[KeptStiffness],
    mut x: f64,
    mut motions: Vec<RobotMotion>,
    options: &SearchOptions,
) -> Option<LowestPair> {
    let mut bracket = Bracket { low: 0.0, high: f64::INFINITY, leading: f64::INFINITY };
    let mut kept = Vec::with_capacity(metric.len());
    let mut claim: Option<UnprovenPair> = None;

    for _ in 0..MAX_EVALUATIONS {
        // Bracket: count the eigenvalues below the shift.
        cables.kept(x, &mut kept);
        let factor = Factor::of(pencil, &kept, x);
        if !bracket.narrow(x, factor.negative) {
            return None;
        }

        // Verify: no eigenvalue lies below the shift that the last quotient led to, also with a finer discretisation.
        if let Some(UnprovenPair { found, provable }) = claim.take() {
            if provable && factor.negative == 0 {
                return Some(found);
            }
            motions = found.motions;
        }

        // Iterate: the motions approach the lowest modes. If several eigenvalues lie below, as many motions are needed.
        if factor.negative > 1 {
            add_any_motions(pencil, metric, &mut motions, factor.negative.min(BLOCK));
        }
        let mut found = improved(pencil, cables, metric, &factor, x, std::mem::take(&mut motions), options);
        let quotient = found.square;
        if !quotient.is_finite() {
            return None;
        }
        if !options.checked && factor.negative == 0 && quotient - x <= options.width * quotient {
            return Some(found);
        }

        // Next shift: just below the quotient, or inside the interval. If the quotient is near its shift, the
        // discretisation is refined, and the next shift can prove the result.
        let leads = bracket.lower_to(quotient);
        let close = leads && (quotient - x).abs() < CLOSE * quotient;
        if close {
            cables.refine();
        }
        if !leads {
            add_any_motions(pencil, metric, &mut found.motions, BLOCK);
        }
        x = if leads { quotient * (1.0 - 0.5 * options.width) } else { bracket.inside() };
        claim = Some(UnprovenPair { found, provable: options.checked && close });
    }
    None
}

/// Adds start vectors until there are `count` motions.
fn add_any_motions(pencil: &RobotPencil, metric: &[KeptStiffness], motions: &mut Vec<RobotMotion>, count: usize) {
    motions.extend((motions.len()..count).map(|number| pencil.any_motion(metric, number)));
}

/// Relative distance of a shift from its quotient below which the error of a coarse discretisation matters.
const CLOSE: f64 = 0.1;

/// Inverse iteration at a shift, and the lowest combination of several motions.
fn improved(
    pencil: &RobotPencil,
    cables: &impl Cables,
    metric: &[KeptStiffness],
    factor: &Factor,
    x: f64,
    motions: Vec<RobotMotion>,
    options: &SearchOptions,
) -> LowestPair {
    let Iterated { motions, work, ends } =
        pulp::Arch::new().dispatch(Iteration { pencil, metric, factor, x, motions, options });
    let count = motions.len();

    // Masses of the cables in groups, for each pair of motions.
    let mut masses = vec![Vec::with_capacity(ends.len()); place(count, 0)];
    for (group, ends) in ends.iter().enumerate() {
        for (of_pair, of_group) in masses.iter_mut().zip(cables.mass(group, ends)) {
            of_pair.push(of_group);
        }
    }
    let mass = |i: usize, j: usize| {
        let by_cables: f64 = masses[place(i.max(j), i.min(j))].iter().map(sum).sum();
        pencil.platform_mass(&motions[i], &motions[j]) + by_cables
    };

    if count == 1 {
        let mass = mass(0, 0);
        return LowestPair { square: x + work[0] / mass, mass, motions, cables: masses.swap_remove(0) };
    }
    let work = |i: usize, j: usize| work[count * i + j];
    combined(x, &DMat::from_fn(count, count, work), &DMat::from_fn(count, count, mass), motions, &masses)
}

/// Job for vector registers: inverse iteration at a shift.
struct Iteration<'a> {
    pencil: &'a RobotPencil,
    metric: &'a [KeptStiffness],
    factor: &'a Factor,
    x: f64,
    motions: Vec<RobotMotion>,
    options: &'a SearchOptions,
}

/// Result of [`Iteration`].
struct Iterated {
    motions: Vec<RobotMotion>,
    /// Products `yᵀ (K − xM) z` of all pairs of motions.
    work: Vec<f64>,
    /// Motions of the kept unknowns per group, for each motion of the robot.
    ends: Vec<Vec<KeptMotion>>,
}

impl pulp::WithSimd for Iteration<'_> {
    type Output = Iterated;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Iterated {
        let Self { pencil, metric, factor, x, mut motions, options } = self;
        let count = motions.len();

        // B y for each motion.
        let (mut forces, mut images) = (Vec::with_capacity(count), Vec::with_capacity(count));
        for motion in &motions {
            let mut force = RobotMotion::any(metric.len());
            pencil.inertia(simd, metric, motion, &mut force);
            forces.push(force);
            images.push(RobotMotion::any(metric.len()));
        }

        // Inverse iteration until the minimum quotient is constant.
        let mut before = f64::INFINITY;
        for _ in 0..options.steps {
            // A z = B y, so that zᵀ A z needs no other product.
            std::mem::swap(&mut images, &mut forces);
            let mut minimum = f64::INFINITY;
            for k in 0..count {
                factor.solve(simd, pencil, &images[k], &mut motions[k]);
                let (motion, image, force) = orthogonal(simd, k, &mut motions, &mut images, &mut forces);

                // Scale to unit length, together with force and image.
                pencil.inertia(simd, metric, motion, force);
                let size = 1.0 / force.dot(simd, motion).sqrt();
                for vector in [&mut *force, &mut *motion, &mut *image] {
                    vector.scale(simd, size);
                }
                minimum = minimum.min(motion.dot(simd, image));
            }

            if (minimum - before).abs() <= 0.01 * minimum.abs() + 0.1 * options.width * (x + minimum).abs() {
                break;
            }
            before = minimum;
        }

        // Products of all pairs, and the motion of the kept unknowns.
        let mut work = Vec::with_capacity(count * count);
        for motion in &motions {
            for image in &images {
                work.push(motion.dot(simd, image));
            }
        }

        let mut ends = Vec::with_capacity(metric.len());
        for (group, lever_axes) in pencil.lever_axes.iter().enumerate() {
            let mut of_group = Vec::with_capacity(count);
            for motion in &motions {
                of_group.push(motion.kept(simd, lever_axes, group));
            }
            ends.push(of_group);
        }

        Iterated { motions, work, ends }
    }
}

/// Makes motion `k` orthogonal to those before it, or all of them would converge to the first mode. The result is this
/// motion with its image and its force, which is still that of the motion before.
#[inline(always)]
fn orthogonal<'m, S: Simd>(
    simd: S,
    k: usize,
    motions: &'m mut [RobotMotion],
    images: &'m mut [RobotMotion],
    forces: &'m mut [RobotMotion],
) -> (&'m mut RobotMotion, &'m mut RobotMotion, &'m mut RobotMotion) {
    let (done, rest) = motions.split_at_mut(k);
    let (images_done, images_rest) = images.split_at_mut(k);
    let (forces_done, forces_rest) = forces.split_at_mut(k);
    let (motion, image, force) = (&mut rest[0], &mut images_rest[0], &mut forces_rest[0]);
    for i in 0..k {
        let component = forces_done[i].dot(simd, motion);
        motion.add(simd, -component, &done[i]);
        image.add(simd, -component, &images_done[i]);
    }
    (motion, image, force)
}

/// Job for vector registers: the sum `Σ factor motion`.
struct WeightedSum<'a> {
    motions: &'a [RobotMotion],
    factors: Vec<f64>,
    groups: usize,
}

impl pulp::WithSimd for WeightedSum<'_> {
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

/// Combinations of motions in which stiffness and mass are diagonal, in ascending order of their quotient.
fn combined(x: f64, work: &DMat, mass: &DMat, motions: Vec<RobotMotion>, masses: &[Vec<Lane>]) -> LowestPair {
    let count = motions.len();
    let groups = masses[0].len();

    // L⁻¹ A L⁻ᵀ with the mass L Lᵀ has the quotients as its eigenvalues.
    let factor = mass.clone().cholesky();
    let Some(inverse) = factor.and_then(|factor| factor.l().try_inverse()) else {
        return LowestPair { square: f64::NAN, motions, mass: f64::NAN, cables: Vec::new() };
    };
    let symmetric = symmetric_part(work);
    let eigen = (&inverse * symmetric * inverse.transpose()).symmetric_eigen();
    let vectors = inverse.transpose() * &eigen.eigenvectors;
    let order = order::ascending(eigen.eigenvalues.as_slice());

    // Motions, ascending, and the masses of the cables in the first.
    let motion = |&k: &usize| {
        let factors = vectors.column(k).iter().copied().collect();
        pulp::Arch::new().dispatch(WeightedSum { motions: &motions, factors, groups })
    };
    let first = vectors.column(order[0]);
    let of_group = |group: usize| {
        let mut sums = [0.0; LANES];
        for i in 0..count {
            for j in 0..count {
                let of_pair = &masses[place(i.max(j), i.min(j))][group];
                for (sum, mass) in sums.iter_mut().zip(of_pair) {
                    *sum += first[i] * first[j] * mass;
                }
            }
        }
        sums
    };

    LowestPair {
        square: x + eigen.eigenvalues[order[0]],
        motions: order.iter().map(motion).collect(),
        mass: 1.0,
        cables: (0..groups).map(of_group).collect(),
    }
}

//! Factorisation of the pencil at a shift: bubbles first, then the platform.

use super::batched_cable::KeptStiffness;
use super::lever_axes::{LeverAxes, RobotMotion};
use super::pencil::RobotPencil;
use crate::math::Mat6;
use crate::math::simd::{LANES, Lane, Part, sum};
use pulp::Simd;

/// Factored pencil at a shift.
pub(super) struct Factor {
    /// L below the diagonal, inverse pivots on it.
    platform: Mat6,
    bubbles: Vec<Bubbles>,
    /// Number of pivots that are not positive. It is the number of eigenvalues below the shift, provided that no
    /// eigenvalue of the eliminated unknowns lies below.
    pub(super) negative: usize,
}

/// Stiffness of the bubbles of a group's cables against the platform ends, and the inverse pivots of the bubbles.
#[derive(Default)]
struct Bubbles {
    normal: Lane,
    along: Lane,
    out: Lane,
    inverse: Lane,
    inverse_out_of_plane: Lane,
}

/// Job for vector registers: factors the pencil.
struct FactorisePencil<'a> {
    pencil: &'a RobotPencil,
    kept: &'a [KeptStiffness],
    x: f64,
}

impl pulp::WithSimd for FactorisePencil<'_> {
    type Output = Factor;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Factor {
        let Self { pencil, kept, x } = self;
        let mut platform = pencil.constant - pencil.mass * x;
        let mut negative = 0;
        let mut all = Vec::with_capacity(kept.len());
        for ((k, lever_axes), cables) in kept.iter().zip(&pencil.lever_axes).zip(&pencil.members) {
            negative += (0..cables.len()).map(|lane| negative_pivots(k, lane)).sum::<usize>();
            let (bubbles, entries) = eliminate_bubbles(simd, k, lever_axes);
            let mut entry = entries.iter();
            for j in 0..6 {
                for (i, entry) in (j..6).zip(&mut entry) {
                    platform[(i, j)] += sum(entry);
                }
            }
            all.push(bubbles);
        }

        negative += factor_platform(&mut platform, pencil.dof);
        Factor { platform, bubbles: all, negative }
    }
}

/// Number of pivots of a cable in a group that are not positive.
#[inline(always)]
fn negative_pivots(k: &KeptStiffness, lane: usize) -> usize {
    let pivots = [k.min_pivot[lane], k.min_pivot[lane], k.in_plane[5][lane], k.out_of_plane[2][lane]];
    pivots.into_iter().filter(|pivot| not_positive(*pivot)).count()
}

/// Eliminates the bubbles of a group of cables. The result also has the stiffness of each cable in the coordinates of
/// the platform, its lower triangle by columns.
#[inline(always)]
fn eliminate_bubbles<S: Simd>(simd: S, k: &KeptStiffness, lever_axes: &LeverAxes) -> (Bubbles, [Lane; 21]) {
    let mut bubbles = Bubbles::default();
    let [nn, en, ee, qn, qe, qq] = &k.in_plane;
    let [oo, bo, bb] = &k.out_of_plane;
    let mut entries = [[0.0; LANES]; 21];
    for part in Part::all(simd) {
        // Stiffness of the platform end alone.
        let (qn, qe, bo) = (part.of(qn), part.of(qe), part.of(bo));
        let (inverse, inverse_out_of_plane) = (part.inverse(part.of(qq)), part.inverse(part.of(bb)));
        let (by_qn, by_qe) = (part.neg(part.mul(qn, inverse)), part.neg(part.mul(qe, inverse)));
        let nn = part.mul_add(qn, by_qn, part.of(nn));
        let en = part.mul_add(qn, by_qe, part.of(en));
        let ee = part.mul_add(qe, by_qe, part.of(ee));
        let oo = part.mul_add(bo, part.neg(part.mul(bo, inverse_out_of_plane)), part.of(oo));

        // In the coordinates of the platform.
        let mut entry = entries.iter_mut();
        for j in 0..6 {
            let (normal, along) = (part.of(&lever_axes.normal[j]), part.of(&lever_axes.along[j]));
            let by_n = part.mul_add(nn, normal, part.mul(en, along));
            let by_e = part.mul_add(en, normal, part.mul(ee, along));
            let by_b = part.mul(oo, part.of(&lever_axes.out[j]));
            for (i, entry) in (j..6).zip(&mut entry) {
                part.set(entry, lever_axes.wrench(part, i, [by_n, by_e, by_b]));
            }
        }

        part.set(&mut bubbles.normal, qn);
        part.set(&mut bubbles.along, qe);
        part.set(&mut bubbles.out, bo);
        part.set(&mut bubbles.inverse, inverse);
        part.set(&mut bubbles.inverse_out_of_plane, inverse_out_of_plane);
    }
    (bubbles, entries)
}

/// Factors the stiffness of the platform with `n` degrees of freedom in place: L below the diagonal, inverse pivots on
/// it. The result is the number of pivots that are not positive.
#[inline(always)]
fn factor_platform(d: &mut Mat6, n: usize) -> usize {
    let mut negative = 0;
    for k in 0..n {
        negative += usize::from(not_positive(d[(k, k)]));
        let inverse = 1.0 / d[(k, k)];
        for j in k + 1..n {
            let factor = d[(j, k)] * inverse;
            for i in j..n {
                d[(i, j)] -= d[(i, k)] * factor;
            }
        }
        for j in k + 1..n {
            d[(j, k)] *= inverse;
        }
        d[(k, k)] = inverse;
    }
    negative
}

/// True for negative pivots, zero and NaN.
fn not_positive(pivot: f64) -> bool {
    pivot.is_nan() || pivot <= 0.0
}

impl Factor {
    /// Factors a pencil at a shift, without pivoting: a positive definite pencil needs none, and for an indefinite one
    /// an approximate direction is enough.
    pub(super) fn of(pencil: &RobotPencil, kept: &[KeptStiffness], x: f64) -> Self {
        pulp::Arch::new().dispatch(FactorisePencil { pencil, kept, x })
    }

    /// Solves (K − xM) `into` = `force`.
    #[inline(always)]
    pub(super) fn solve<S: Simd>(&self, simd: S, pencil: &RobotPencil, force: &RobotMotion, into: &mut RobotMotion) {
        let n = pencil.dof;
        let mut v = *force.platform();

        // Eliminate the forces on the bubbles.
        for (group, (lever_axes, bubbles)) in pencil.lever_axes.iter().zip(&self.bubbles).enumerate() {
            let [f, g] = force.bubbles(group);
            let mut wrench = [[0.0; LANES]; 6];
            for part in Part::all(simd) {
                let f = part.mul(part.of(f), part.of(&bubbles.inverse));
                let g = part.mul(part.of(g), part.of(&bubbles.inverse_out_of_plane));
                let ends = [
                    part.mul(part.of(&bubbles.normal), f),
                    part.mul(part.of(&bubbles.along), f),
                    part.mul(part.of(&bubbles.out), g),
                ];
                for (i, wrench) in wrench.iter_mut().enumerate() {
                    part.set(wrench, lever_axes.wrench(part, i, ends));
                }
            }
            for (v, wrench) in v.iter_mut().zip(&wrench) {
                *v -= sum(wrench);
            }
        }

        // The platform.
        for j in 0..n {
            for i in j + 1..n {
                v[i] -= self.platform[(i, j)] * v[j];
            }
        }
        for j in (0..n).rev() {
            v[j] *= self.platform[(j, j)];
            for i in j + 1..n {
                v[j] -= self.platform[(i, j)] * v[i];
            }
        }

        // Back substitution of the bubbles.
        *into.platform_mut() = v;
        for (group, (lever_axes, bubbles)) in pencil.lever_axes.iter().zip(&self.bubbles).enumerate() {
            let [f, g] = force.bubbles(group);
            let [q, p] = into.bubbles_mut(group);
            for part in Part::all(simd) {
                let [n, e, b] = lever_axes.ends(part, &v);
                let left = part.mul_add(part.neg(n), part.of(&bubbles.normal), part.of(f));
                let left = part.mul_add(part.neg(e), part.of(&bubbles.along), left);
                part.set(q, part.mul(left, part.of(&bubbles.inverse)));
                let left = part.mul_add(part.neg(b), part.of(&bubbles.out), part.of(g));
                part.set(p, part.mul(left, part.of(&bubbles.inverse_out_of_plane)));
            }
        }
    }
}

//! One element of each of several cables: its matrices, and their elimination.

use super::lanes::{Lane, Lanes, Part, ZERO};
use super::tables::{MASSES, RULES, TRIPLES};
use crate::catenary::Catenary;
use pulp::Simd;
use std::array::from_fn;

/// Components of C in the plane, and out of it: (nn, en, ee, oo).
const PARTS: usize = 4;

/// Place in a lower triangle by rows.
#[inline(always)]
pub(crate) const fn place(row: usize, column: usize) -> usize {
    row * (row + 1) / 2 + column
}

/// Stiffness and mass of an element of each cable over its hats and bubbles.
#[derive(Debug)]
pub(super) struct Element {
    /// Degree that the matrices have.
    degree: usize,
    /// Legendre coefficients of C over half the length [N/m], the parts of each degree.
    coefficients: Lanes,
    /// Lower triangle by rows, unknowns n, e of each function: hats, then bubbles, ascending.
    plane: Lanes,
    /// The same out of plane.
    across: Lanes,
    /// Half the mass [kg].
    half_mass: Lane,
    /// The factors at the last frequency: rows of eliminated unknowns, the inverses of their pivots on the diagonal.
    pub(super) plane_factor: Lanes,
    pub(super) across_factor: Lanes,
    /// Functions of the factors.
    functions: usize,
}

/// What C depends on: the force along the unstrained length of an element.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Shapes {
    /// Force at the middle of the element, along e and n [N].
    along: Lane,
    normal: Lane,
    /// Half its change from end to end [N].
    along_change: Lane,
    normal_change: Lane,
    axial_stiffness: Lane,
    inverse_half: Lane,
    half_mass: Lane,
}

impl Shapes {
    /// Lane `i`: the element between two arc lengths [m] of a cable of mass m per length [kg/m]; e has the components
    /// `axis` along the horizontal and up.
    pub(super) fn set(&mut self, i: usize, (catenary, mass): (&Catenary, f64), axis: [f64; 2], from: f64, to: f64) {
        let rope = catenary.rope();
        let w = rope.weight_per_length;
        let [cos, sin] = axis;
        let (h, v) = (catenary.horizontal_force(), catenary.vertical_force_at_start() + 0.5 * w * (from + to));
        let change = 0.5 * w * (to - from);
        (self.along[i], self.normal[i]) = (h * cos + v * sin, v * cos - h * sin);
        (self.along_change[i], self.normal_change[i]) = (change * sin, change * cos);
        self.axial_stiffness[i] = rope.axial_stiffness;
        self.inverse_half[i] = 2.0 / (to - from);
        self.half_mass[i] = 0.5 * mass * (to - from);
    }
}

impl Element {
    /// With so many Legendre terms of C, by Gauss's rule.
    #[inline(always)]
    pub(super) fn new<S: Simd>(simd: S, s: &Shapes, terms: usize) -> Self {
        let mut coefficients = Lanes::zeros(PARTS * terms);
        // With as many points as terms, what is left out comes back in the last term at most.
        let rule = &RULES[terms - 1];
        let mut at_points = Lanes::zeros(PARTS * terms);
        for part in Part::all(simd) {
            for (xi, parts) in rule.points.iter().zip(at_points.chunks_exact_mut(PARTS)) {
                for (lane, value) in parts.iter_mut().zip(s.integrands(part, *xi)) {
                    part.set(lane, value);
                }
            }
            for (weights, sums) in rule.weights.iter().zip(coefficients.chunks_exact_mut(PARTS)) {
                let mut sum = [part.splat(0.0); PARTS];
                for (weight, parts) in weights.iter().zip(at_points.chunks_exact(PARTS)) {
                    let weight = part.splat(*weight);
                    for k in 0..PARTS {
                        sum[k] = part.mul_add(weight, part.of(&parts[k]), sum[k]);
                    }
                }
                for k in 0..PARTS {
                    part.set(&mut sums[k], sum[k]);
                }
            }
        }
        Self {
            degree: 0,
            coefficients,
            plane: Lanes::new(),
            across: Lanes::new(),
            half_mass: s.half_mass,
            plane_factor: Lanes::new(),
            across_factor: Lanes::new(),
            functions: 0,
        }
    }

    /// Adds rows of the stiffness up to a degree: `∫ C N_a′ N_b′` over products of slopes. H hats; the slope of the second
    /// is minus that of the first.
    #[inline(always)]
    fn refine<S: Simd, const H: usize>(&mut self, simd: S, degree: usize) {
        let Self { coefficients, plane, across, .. } = self;
        let functions = |degree: usize| if degree == 0 { 0 } else { degree + H - 1 };
        for f in functions(self.degree)..functions(degree) {
            let (row, row_across) = (plane.len(), across.len());
            plane.resize(row + 4 * f + 3, ZERO);
            across.resize(row_across + f + 1, ZERO);
            let (of_n, of_e) = plane[row..].split_at_mut(2 * f + 1);
            let of_b = &mut across[row_across..];
            let slope = |f: usize| if f < H { 0 } else { f + 1 - H };
            for part in Part::all(simd) {
                for j in 0..=f {
                    let (high, low) = (slope(f), slope(j));
                    let mut sums = [part.splat(0.0); PARTS];
                    let every_second =
                        coefficients[PARTS * (high - low).min(coefficients.len() / PARTS)..].chunks_exact(PARTS);
                    for (factor, c) in TRIPLES.of(high, low).iter().zip(every_second.step_by(2)) {
                        let factor = part.splat(*factor);
                        for k in 0..PARTS {
                            sums[k] = part.mul_add(factor, part.of(&c[k]), sums[k]);
                        }
                    }
                    if H == 2 && (f == 1) != (j == 1) {
                        for sum in &mut sums {
                            *sum = part.neg(*sum);
                        }
                    }
                    let [nn, en, ee, oo] = sums;
                    part.set(&mut of_n[2 * j], nn);
                    if j < f {
                        part.set(&mut of_n[2 * j + 1], en);
                    }
                    part.set(&mut of_e[2 * j], en);
                    part.set(&mut of_e[2 * j + 1], ee);
                    part.set(&mut of_b[j], oo);
                }
            }
        }
        self.degree = self.degree.max(degree);
    }

    /// Factors K − xM at a degree, down to `plane` and `across` unknowns.
    #[inline(always)]
    pub(super) fn factorise<S: Simd, const H: usize>(
        &mut self,
        simd: S,
        x: f64,
        degree: usize,
        (plane_kept, across_kept): (usize, usize),
        least_pivot: &mut Lane,
    ) {
        self.refine::<S, H>(simd, degree);
        let functions = degree + H - 1;
        let inertia: Lane = from_fn(|i| x * self.half_mass[i]);
        let Self { plane, across, plane_factor, across_factor, .. } = self;
        plane_factor.clear();
        plane_factor.extend_from_slice(&plane[..place(2 * functions, 0)]);
        across_factor.clear();
        across_factor.extend_from_slice(&across[..place(functions, 0)]);
        for part in Part::all(simd) {
            take_inertia::<S, 2, H>(part, plane_factor, functions, &inertia);
            take_inertia::<S, 1, H>(part, across_factor, functions, &inertia);
            eliminate(part, plane_factor, 2 * functions, plane_kept, least_pivot);
            eliminate(part, across_factor, functions, across_kept, least_pivot);
        }
        self.functions = functions;
    }

    /// Amplitudes of all functions, in plane and across, that follow the kept ones.
    #[inline(always)]
    pub(super) fn moved<S: Simd>(&self, simd: S, plane: &[Lane], across: &[Lane]) -> [Lanes; 2] {
        let Self { plane_factor, across_factor, functions, .. } = self;
        [substitute(simd, plane_factor, 2 * functions, plane), substitute(simd, across_factor, *functions, across)]
    }

    /// M a in plane and out of plane, over half the mass; the same for all elements.
    #[inline(always)]
    pub(super) fn weighed<S: Simd, const H: usize>(simd: S, [plane, across]: &[Lanes; 2]) -> [Lanes; 2] {
        let mut all = [Lanes::zeros(plane.len()), Lanes::zeros(across.len())];
        for part in Part::all(simd) {
            weigh::<S, 2, H>(part, plane, &mut all[0]);
            weigh::<S, 1, H>(part, across, &mut all[1]);
        }
        all
    }

    /// `aᵀ M b` in plane and out of plane, from a and what [`weighed`](Self::weighed) makes of b.
    #[inline(always)]
    pub(super) fn mass<S: Simd>(&self, simd: S, a: &[Lanes; 2], weighed: &[Lanes; 2]) -> [Lane; 2] {
        let mut masses = [ZERO; 2];
        for part in Part::all(simd) {
            let half_mass = part.of(&self.half_mass);
            for ((mass, a), b) in masses.iter_mut().zip(a).zip(weighed) {
                part.set(mass, part.mul(half_mass, part.dot(a, b)));
            }
        }
        masses
    }
}

impl Shapes {
    /// C over half the length at ξ: its parts.
    #[inline(always)]
    fn integrands<S: Simd>(&self, part: Part<S>, xi: f64) -> [S::f64s; PARTS] {
        let simd = part.simd;
        let xi = part.splat(xi);
        let along = part.mul_add(xi, part.of(&self.along_change), part.of(&self.along));
        let normal = part.mul_add(xi, part.of(&self.normal_change), part.of(&self.normal));
        let square = part.mul_add(along, along, part.mul(normal, normal));
        let tension = simd.sqrt_f64s(square);
        let ea = part.of(&self.axial_stiffness);
        let scale = simd.div_f64s(part.mul(part.of(&self.inverse_half), ea), simd.add_f64s(ea, tension));
        let across = part.mul(scale, tension);
        let extra = simd.div_f64s(part.mul(scale, ea), square);
        let by_normal = part.mul(extra, normal);
        [
            part.mul_add(by_normal, normal, across),
            part.mul(by_normal, along),
            part.mul_add(part.mul(extra, along), along, across),
            across,
        ]
    }
}

/// Takes x M off the stiffness of D components a function.
#[inline(always)]
fn take_inertia<S: Simd, const D: usize, const H: usize>(
    part: Part<S>,
    matrix: &mut [Lane],
    functions: usize,
    inertia: &Lane,
) {
    let inertia = part.neg(part.of(inertia));
    for (k, j, mass) in MASSES[H - 1].of(functions) {
        let mass = part.mul(part.splat(*mass), inertia);
        for d in 0..D {
            let entry = &mut matrix[place(D * k + d, D * j + d)];
            part.set(entry, part.simd.add_f64s(part.of(entry), mass));
        }
    }
}

/// Eliminates the unknowns from the last of `n` down to number `kept`, two at a time; their rows keep what
/// [`substitute`] needs.
#[inline(always)]
fn eliminate<S: Simd>(part: Part<S>, matrix: &mut [Lane], n: usize, kept: usize, least_pivot: &mut Lane) {
    let mut t = n;
    if (n - kept) % 2 == 1 {
        t -= 1;
        let (above, pivot_row) = matrix[..place(t + 1, 0)].split_at_mut(place(t, 0));
        let inverse = part.neg(invert_pivot(part, pivot_row, t, least_pivot));
        for row in 0..t {
            let factor = part.mul(part.of(&pivot_row[row]), inverse);
            for (entry, a) in above[place(row, 0)..=place(row, row)].iter_mut().zip(&*pivot_row) {
                part.set(entry, part.mul_add(factor, part.of(a), part.of(entry)));
            }
        }
    }
    while t > kept {
        t -= 2;
        let (above, rows) = matrix[..place(t + 2, 0)].split_at_mut(place(t, 0));
        let (second, first) = rows.split_at_mut(t + 1);
        let inverse = part.neg(invert_pivot(part, first, t + 1, least_pivot));
        let factor = part.mul(part.of(&first[t]), inverse);
        for (entry, a) in second.iter_mut().zip(&*first) {
            part.set(entry, part.mul_add(factor, part.of(a), part.of(entry)));
        }
        let inverse_second = part.neg(invert_pivot(part, second, t, least_pivot));
        for row in 0..t {
            let p = part.mul(part.of(&first[row]), inverse);
            let q = part.mul(part.of(&second[row]), inverse_second);
            let entries = &mut above[place(row, 0)..=place(row, row)];
            for ((entry, a), b) in entries.iter_mut().zip(&*first).zip(&*second) {
                let once = part.mul_add(p, part.of(a), part.of(entry));
                part.set(entry, part.mul_add(q, part.of(b), once));
            }
        }
    }
}

#[inline(always)]
fn invert_pivot<S: Simd>(part: Part<S>, row: &mut [Lane], at: usize, least_pivot: &mut Lane) -> S::f64s {
    let pivot = part.of(&row[at]);
    let least = part.of(least_pivot);
    let lower = part.simd.less_than_f64s(pivot, least);
    part.set(least_pivot, part.simd.select_f64s(lower, pivot, least));
    let inverse = part.inverse(pivot);
    part.set(&mut row[at], inverse);
    inverse
}

/// The eliminated unknowns, at rest but for what the kept ones do to them.
#[inline(always)]
fn substitute<S: Simd>(simd: S, factor: &[Lane], n: usize, kept: &[Lane]) -> Lanes {
    let mut all = Lanes::zeros(n);
    all[..kept.len()].copy_from_slice(kept);
    for part in Part::all(simd) {
        for t in kept.len()..n {
            let row = &factor[place(t, 0)..=place(t, t)];
            let sum = part.dot(&row[..t], &all[..t]);
            part.set(&mut all[t], part.neg(part.mul(sum, part.of(&row[t]))));
        }
    }
    all
}

#[inline(always)]
fn weigh<S: Simd, const D: usize, const H: usize>(part: Part<S>, a: &[Lane], into: &mut [Lane]) {
    for (k, j, mass) in MASSES[H - 1].of(a.len() / D) {
        let mass = part.splat(*mass);
        for d in 0..D {
            let (k, j) = (D * k + d, D * j + d);
            part.add_scaled(&mut into[k], mass, &a[j]);
            if j != k {
                part.add_scaled(&mut into[j], mass, &a[k]);
            }
        }
    }
}

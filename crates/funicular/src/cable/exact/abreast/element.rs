//! One element of each of several cables: its matrices, and their elimination.

use super::tables::{MASSES, RULES, TRIPLES};
use super::{LANES, Lane, ZERO};
use crate::catenary::Catenary;
use std::array::from_fn;

/// Components of C in the plane, and out of it: (nn, en, ee, oo).
const PARTS: usize = 4;

/// As many functions as usual searches end with; room for them saves copies.
const LIKELY_FUNCTIONS: usize = 12;

/// Place in a lower triangle by rows.
#[inline(always)]
pub(crate) const fn place(row: usize, column: usize) -> usize {
    row * (row + 1) / 2 + column
}

/// Stiffness and mass of an element of each cable over its hats and bubbles.
#[derive(Debug, Clone)]
pub(super) struct Element {
    /// Degree that the matrices have.
    degree: usize,
    /// Legendre coefficients of C over half the length [N/m], by degree.
    coefficients: Vec<[Lane; PARTS]>,
    /// Lower triangle by rows, unknowns n, e of each function: hats, then bubbles, ascending.
    plane: Vec<Lane>,
    /// The same out of plane.
    across: Vec<Lane>,
    /// Half the mass [kg].
    half_mass: Lane,
    /// The factors at the last frequency: rows of eliminated unknowns, the inverses of their pivots on the diagonal.
    pub(super) plane_factor: Vec<Lane>,
    pub(super) across_factor: Vec<Lane>,
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
    pub(super) fn new(s: &Shapes, terms: usize) -> Self {
        let mut coefficients = vec![[ZERO; PARTS]; terms];
        // With as many points as terms, what is left out comes back in the last term at most.
        for (xi, weighted) in &RULES[terms - 1] {
            let along: Lane = from_fn(|i| s.along[i] + xi * s.along_change[i]);
            let normal: Lane = from_fn(|i| s.normal[i] + xi * s.normal_change[i]);
            let square: Lane = from_fn(|i| along[i] * along[i] + normal[i] * normal[i]);
            let tension = square.map(f64::sqrt);
            let ea = &s.axial_stiffness;
            let part: Lane = from_fn(|i| s.inverse_half[i] * ea[i] / (ea[i] + tension[i]));
            let across: Lane = from_fn(|i| part[i] * tension[i]);
            let extra: Lane = from_fn(|i| part[i] * ea[i] / square[i]);
            let parts: [Lane; PARTS] = [
                from_fn(|i| across[i] + extra[i] * normal[i] * normal[i]),
                from_fn(|i| extra[i] * along[i] * normal[i]),
                from_fn(|i| across[i] + extra[i] * along[i] * along[i]),
                across,
            ];
            for (sums, weight) in coefficients.iter_mut().zip(weighted) {
                for (sum, part) in sums.iter_mut().zip(&parts) {
                    add_scaled(sum, *weight, part);
                }
            }
        }
        Self {
            degree: 0,
            coefficients,
            plane: Vec::with_capacity(place(2 * LIKELY_FUNCTIONS, 0)),
            across: Vec::with_capacity(place(LIKELY_FUNCTIONS, 0)),
            half_mass: s.half_mass,
            plane_factor: Vec::new(),
            across_factor: Vec::new(),
            functions: 0,
        }
    }

    /// Adds rows of the stiffness up to a degree: `∫ C N_a′ N_b′` over products of slopes. H hats; the slope of the second
    /// is minus that of the first.
    #[inline(always)]
    fn refine<const H: usize>(&mut self, degree: usize) {
        let Self { coefficients, plane, across, .. } = self;
        let functions = |degree: usize| if degree == 0 { 0 } else { degree + H - 1 };
        for f in functions(self.degree)..functions(degree) {
            let row = plane.len();
            plane.resize(row + 4 * f + 3, ZERO);
            let (of_n, of_e) = plane[row..].split_at_mut(2 * f + 1);
            let slope = |f: usize| if f < H { 0 } else { f + 1 - H };
            for j in 0..=f {
                let (high, low) = (slope(f), slope(j));
                let mut sums = [ZERO; PARTS];
                for (factor, c) in TRIPLES.of(high, low).iter().zip(coefficients.iter().skip(high - low).step_by(2)) {
                    for (sum, c) in sums.iter_mut().zip(c) {
                        add_scaled(sum, *factor, c);
                    }
                }
                if H == 2 && (f == 1) != (j == 1) {
                    for sum in &mut sums {
                        *sum = sum.map(|entry| -entry);
                    }
                }
                let [nn, en, ee, oo] = sums;
                of_n[2 * j] = nn;
                if j < f {
                    of_n[2 * j + 1] = en;
                }
                (of_e[2 * j], of_e[2 * j + 1]) = (en, ee);
                across.push(oo);
            }
        }
        self.degree = self.degree.max(degree);
    }

    /// Factors K − xM at a degree, down to `plane` and `across` unknowns.
    #[inline(always)]
    pub(super) fn factorise<const H: usize>(
        &mut self,
        x: f64,
        degree: usize,
        (plane_kept, across_kept): (usize, usize),
        least_pivot: &mut Lane,
    ) {
        self.refine::<H>(degree);
        let functions = degree + H - 1;
        let inertia: Lane = from_fn(|i| x * self.half_mass[i]);
        let Self { plane, across, plane_factor, across_factor, .. } = self;
        plane_factor.clear();
        plane_factor.extend_from_slice(&plane[..place(2 * functions, 0)]);
        across_factor.clear();
        across_factor.extend_from_slice(&across[..place(functions, 0)]);
        take_inertia::<2, H>(plane_factor, functions, &inertia);
        take_inertia::<1, H>(across_factor, functions, &inertia);
        eliminate(plane_factor, 2 * functions, plane_kept, least_pivot);
        eliminate(across_factor, functions, across_kept, least_pivot);
        self.functions = functions;
    }

    /// Amplitudes of all functions, in plane and across, that follow the kept ones.
    #[inline(always)]
    pub(super) fn moved(&self, plane: &[Lane], across: &[Lane]) -> [Vec<Lane>; 2] {
        let Self { plane_factor, across_factor, functions, .. } = self;
        [substitute(plane_factor, 2 * functions, plane), substitute(across_factor, *functions, across)]
    }

    /// `aᵀ M b` in plane and out of plane.
    #[inline(always)]
    pub(super) fn weigh<const H: usize>(&self, a: &[Vec<Lane>; 2], b: &[Vec<Lane>; 2]) -> [Lane; 2] {
        let [plane, across] = [weigh::<2, H>(&a[0], &b[0]), weigh::<1, H>(&a[1], &b[1])];
        [from_fn(|i| plane[i] * self.half_mass[i]), from_fn(|i| across[i] * self.half_mass[i])]
    }
}

/// Takes x M off the stiffness of D components a function.
#[inline(always)]
fn take_inertia<const D: usize, const H: usize>(matrix: &mut [Lane], functions: usize, inertia: &Lane) {
    for k in 0..functions {
        for (j, mass) in MASSES.row::<H>(k) {
            for d in 0..D {
                add_scaled(&mut matrix[place(D * k + d, D * j + d)], -mass, inertia);
            }
        }
    }
}

/// Eliminates the unknowns from the last of `n` down to number `kept`, two at a time; their rows keep what
/// [`substitute`] needs.
#[inline(always)]
pub(super) fn eliminate(matrix: &mut [Lane], n: usize, kept: usize, least_pivot: &mut Lane) {
    let mut t = n;
    if (n - kept) % 2 == 1 {
        t -= 1;
        let (above, pivot_row) = matrix[..place(t + 1, 0)].split_at_mut(place(t, 0));
        let inverse = invert_pivot(pivot_row, t, least_pivot);
        for row in 0..t {
            let factor: Lane = from_fn(|i| pivot_row[row][i] * inverse[i]);
            for (entry, a) in above[place(row, 0)..=place(row, row)].iter_mut().zip(&*pivot_row) {
                for i in 0..LANES {
                    entry[i] -= factor[i] * a[i];
                }
            }
        }
    }
    while t > kept {
        t -= 2;
        let (above, rows) = matrix[..place(t + 2, 0)].split_at_mut(place(t, 0));
        let (second, first) = rows.split_at_mut(t + 1);
        let inverse = invert_pivot(first, t + 1, least_pivot);
        let factor: Lane = from_fn(|i| first[t][i] * inverse[i]);
        for (entry, a) in second.iter_mut().zip(&*first) {
            for i in 0..LANES {
                entry[i] -= factor[i] * a[i];
            }
        }
        let inverse_second = invert_pivot(second, t, least_pivot);
        for row in 0..t {
            let p: Lane = from_fn(|i| first[row][i] * inverse[i]);
            let q: Lane = from_fn(|i| second[row][i] * inverse_second[i]);
            let entries = &mut above[place(row, 0)..=place(row, row)];
            for ((entry, a), b) in entries.iter_mut().zip(&*first).zip(&*second) {
                for i in 0..LANES {
                    entry[i] -= p[i] * a[i] + q[i] * b[i];
                }
            }
        }
    }
}

#[inline(always)]
fn invert_pivot(row: &mut [Lane], at: usize, least_pivot: &mut Lane) -> Lane {
    let pivot = &mut row[at];
    for i in 0..LANES {
        least_pivot[i] = if pivot[i] < least_pivot[i] { pivot[i] } else { least_pivot[i] };
        pivot[i] = 1.0 / pivot[i];
    }
    *pivot
}

/// The eliminated unknowns, at rest but for what the kept ones do to them.
#[inline(always)]
pub(super) fn substitute(factor: &[Lane], n: usize, kept: &[Lane]) -> Vec<Lane> {
    let mut all = vec![ZERO; n];
    all[..kept.len()].copy_from_slice(kept);
    for t in kept.len()..n {
        let row = &factor[place(t, 0)..=place(t, t)];
        let mut sum = ZERO;
        for (a, u) in row[..t].iter().zip(&all) {
            sum = from_fn(|i| sum[i] + a[i] * u[i]);
        }
        all[t] = from_fn(|i| -sum[i] * row[t][i]);
    }
    all
}

#[inline(always)]
fn weigh<const D: usize, const H: usize>(a: &[Lane], b: &[Lane]) -> Lane {
    let mut sum = ZERO;
    for k in 0..a.len() / D {
        for (j, mass) in MASSES.row::<H>(k) {
            for d in 0..D {
                add_product(&mut sum, mass, &a[D * k + d], &b[D * j + d]);
                if j != k {
                    add_product(&mut sum, mass, &a[D * j + d], &b[D * k + d]);
                }
            }
        }
    }
    sum
}

// Read whole, then written whole: what may alias between lanes would be worked on one by one.

#[inline(always)]
fn add_scaled(sum: &mut Lane, factor: f64, a: &Lane) {
    *sum = from_fn(|i| sum[i] + factor * a[i]);
}

#[inline(always)]
fn add_product(sum: &mut Lane, factor: f64, a: &Lane, b: &Lane) {
    *sum = from_fn(|i| sum[i] + factor * a[i] * b[i]);
}

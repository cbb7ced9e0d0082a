//! Elements of several cables side by side: their matrices and the elimination of their unknowns.

use super::CableSpan;
use super::element_integrals::{MASSES, RULES, TRIPLES, Triples, place};
use crate::math::simd::{LANES, Lane, Lanes, Line, Part};
use pulp::Simd;
use std::array::from_fn;

/// Number of entries of C in plane and out of plane: (nn, en, ee, oo).
const COMPONENTS: usize = 4;

/// Number of functions of an element at the end of most searches; room for them is reserved.
const USUAL_FUNCTIONS: usize = 12;

/// Elements side by side, one per lane, with their stiffness and mass over hats and bubbles.
#[derive(Debug)]
pub(super) struct ElementBatch {
    /// Degree of the matrices.
    degree: usize,
    /// Legendre coefficients of C over half the length [N/m]: the entries of C for each degree.
    coefficients: Lanes,
    /// Stiffness in plane: lower triangle by rows, unknowns n, e of each function; hats, then bubbles, ascending.
    in_plane: Lanes,
    /// Stiffness out of plane: lower triangle by rows, one unknown per function.
    out_of_plane: Lanes,
    /// Half the mass [kg].
    half_mass: Lane,
    /// Factor in plane at the last frequency: rows of eliminated unknowns, with the inverse pivots on the diagonal.
    pub(super) in_plane_factor: Lanes,
    /// Factor out of plane at the last frequency, in the layout of the one in plane.
    pub(super) out_of_plane_factor: Lanes,
    /// Number of functions of the factors.
    functions: usize,
}

/// Data on which C depends: the force along the unstrained length of each element.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ForceShapes {
    /// Force at the middle of the element, along e and n [N].
    along: Lane,
    normal: Lane,
    /// Half the change of this force from end to end [N].
    along_change: Lane,
    normal_change: Lane,
    /// Axial stiffness EA [N].
    axial_stiffness: Lane,
    /// Inverse of half the length [1/m].
    inverse_half: Lane,
    /// Half the mass [kg].
    half_mass: Lane,
}

impl ForceShapes {
    /// Sets lane `i` to the element between two arc lengths [m] of a cable. The components of e along the horizontal
    /// and up are `axis`.
    pub(super) fn set(&mut self, i: usize, cable: &CableSpan, axis: [f64; 2], from: f64, to: f64) {
        let CableSpan { catenary, mass_per_length, .. } = cable;
        let rope = catenary.rope();
        let w = rope.weight_per_length;
        let [cos, sin] = axis;
        let (h, v) = (catenary.horizontal_force(), catenary.vertical_force_at_start() + 0.5 * w * (from + to));
        let change = 0.5 * w * (to - from);
        (self.along[i], self.normal[i]) = (h * cos + v * sin, v * cos - h * sin);
        (self.along_change[i], self.normal_change[i]) = (change * sin, change * cos);
        self.axial_stiffness[i] = rope.axial_stiffness;
        self.inverse_half[i] = 2.0 / (to - from);
        self.half_mass[i] = 0.5 * mass_per_length * (to - from);
    }
}

impl ElementBatch {
    /// Elements with a given number of Legendre terms of C, computed by Gauss's rule.
    #[inline(always)]
    pub(super) fn new<S: Simd>(simd: S, s: &ForceShapes, terms: usize) -> Self {
        let mut coefficients = Lanes::any(COMPONENTS * terms);

        // With as many points as terms, the terms left out affect at most the last term.
        let rule = &RULES[terms - 1];

        // C at the points of the rule, and its coefficients.
        let mut at_points = Lanes::any(COMPONENTS * terms);
        for part in Part::all(simd) {
            for (xi, entries) in rule.points.iter().zip(at_points.chunks_exact_mut(COMPONENTS)) {
                for (lane, value) in entries.iter_mut().zip(s.integrands(part, *xi)) {
                    part.set(lane, value);
                }
            }
            for (weights, sums) in rule.weights.iter().zip(coefficients.chunks_exact_mut(COMPONENTS)) {
                let mut sum = [part.splat(0.0); COMPONENTS];
                for (weight, entries) in weights.iter().zip(at_points.chunks_exact(COMPONENTS)) {
                    let weight = part.splat(*weight);
                    for k in 0..COMPONENTS {
                        sum[k] = part.mul_add(weight, part.of(&entries[k]), sum[k]);
                    }
                }
                for k in 0..COMPONENTS {
                    part.set(&mut sums[k], sum[k]);
                }
            }
        }

        Self {
            degree: 0,
            coefficients,
            in_plane: Lanes::with_room(place(2 * USUAL_FUNCTIONS, 0)),
            out_of_plane: Lanes::with_room(place(USUAL_FUNCTIONS, 0)),
            half_mass: s.half_mass,
            in_plane_factor: Lanes::with_room(place(2 * USUAL_FUNCTIONS, 0)),
            out_of_plane_factor: Lanes::with_room(place(USUAL_FUNCTIONS, 0)),
            functions: 0,
        }
    }

    /// Adds rows of the stiffness up to a degree: `∫ C N_a′ N_b′` over products of slopes. There are H hats; the slope
    /// of the second hat is minus that of the first.
    #[inline(always)]
    fn refine<S: Simd, const H: usize>(&mut self, simd: S, degree: usize) {
        let Self { coefficients, in_plane, out_of_plane, .. } = self;
        let triples = &*TRIPLES;

        let functions = |degree: usize| if degree == 0 { 0 } else { degree + H - 1 };
        for f in functions(self.degree)..functions(degree) {
            // Room for the row of the function.
            let (row, row_out_of_plane) = (in_plane.len(), out_of_plane.len());
            in_plane.resize(row + 4 * f + 3, Line::ZERO);
            out_of_plane.resize(row_out_of_plane + f + 1, Line::ZERO);
            let (of_n, of_e) = in_plane[row..].split_at_mut(2 * f + 1);
            let of_b = &mut out_of_plane[row_out_of_plane..];

            for part in Part::all(simd) {
                for j in 0..=f {
                    let [nn, en, ee, oo] = slope_products::<S, H>(part, (coefficients, triples), f, j);
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

    /// Factors K − xM at a degree, down to the given numbers of unknowns in plane and out of plane.
    #[inline(always)]
    pub(super) fn factorise<S: Simd, const H: usize>(
        &mut self,
        simd: S,
        x: f64,
        degree: usize,
        (in_plane_kept, out_of_plane_kept): (usize, usize),
        min_pivot: &mut Lane,
    ) {
        self.refine::<S, H>(simd, degree);
        let functions = degree + H - 1;
        let inertia = self.half_mass.map(|mass| x * mass);
        let Self { in_plane, out_of_plane, in_plane_factor, out_of_plane_factor, .. } = self;
        in_plane_factor.resize(place(2 * functions, 0), Line::ZERO);
        out_of_plane_factor.resize(place(functions, 0), Line::ZERO);
        for part in Part::all(simd) {
            factor::<S, 2, H>(part, in_plane, in_plane_factor, functions, &inertia, in_plane_kept, min_pivot);
            factor::<S, 1, H>(
                part,
                out_of_plane,
                out_of_plane_factor,
                functions,
                &inertia,
                out_of_plane_kept,
                min_pivot,
            );
        }

        self.functions = functions;
    }

    /// Amplitudes of all functions, in plane and out of plane, that follow the kept ones.
    #[inline(always)]
    pub(super) fn moved<S: Simd>(&self, simd: S, in_plane: &[Lane], out_of_plane: &[Lane]) -> [Lanes; 2] {
        let Self { in_plane_factor, out_of_plane_factor, functions, .. } = self;
        [
            substitute(simd, in_plane_factor, 2 * functions, in_plane),
            substitute(simd, out_of_plane_factor, *functions, out_of_plane),
        ]
    }

    /// Products `aᵀ M b` in plane and out of plane.
    #[inline(always)]
    pub(super) fn mass<S: Simd, const H: usize>(&self, simd: S, a: &[Lanes; 2], b: &[Lanes; 2]) -> [Lane; 2] {
        let mut masses = [[0.0; LANES]; 2];
        for part in Part::all(simd) {
            let half_mass = part.of(&self.half_mass);
            part.set(&mut masses[0], part.mul(half_mass, mass::<S, 2, H>(part, &a[0], &b[0])));
            part.set(&mut masses[1], part.mul(half_mass, mass::<S, 1, H>(part, &a[1], &b[1])));
        }
        masses
    }
}

/// Integrals of the components of C, from their `coefficients`, times the slopes of the functions f and j ≤ f, of which
/// H are hats.
#[inline(always)]
fn slope_products<S: Simd, const H: usize>(
    part: Part<S>,
    (coefficients, triples): (&[Line], &Triples),
    f: usize,
    j: usize,
) -> [S::f64s; COMPONENTS] {
    let slope = |f: usize| if f < H { 0 } else { f + 1 - H };
    let (high, low) = (slope(f), slope(j));

    // Every second coefficient of C contributes to the product of both slopes.
    let mut sums = [part.splat(0.0); COMPONENTS];
    let first = COMPONENTS * (high - low).min(coefficients.len() / COMPONENTS);
    let every_second = coefficients[first..].chunks_exact(COMPONENTS).step_by(2);
    for (factor, c) in triples.of(high, low).iter().zip(every_second) {
        let factor = part.splat(*factor);
        for k in 0..COMPONENTS {
            sums[k] = part.mul_add(factor, part.of(&c[k]), sums[k]);
        }
    }

    // The slope of the second hat is minus that of the first.
    if H == 2 && (f == 1) != (j == 1) {
        for sum in &mut sums {
            *sum = part.neg(*sum);
        }
    }
    sums
}

impl ForceShapes {
    /// Entries of C over half the length at ξ.
    #[inline(always)]
    fn integrands<S: Simd>(&self, part: Part<S>, xi: f64) -> [S::f64s; COMPONENTS] {
        let simd = part.simd;
        let xi = part.splat(xi);
        let along = part.mul_add(xi, part.of(&self.along_change), part.of(&self.along));
        let normal = part.mul_add(xi, part.of(&self.normal_change), part.of(&self.normal));
        let square = part.mul_add(along, along, part.mul(normal, normal));
        let tension = simd.sqrt_f64s(square);
        let ea = part.of(&self.axial_stiffness);
        let scale = simd.div_f64s(part.mul(part.of(&self.inverse_half), ea), simd.add_f64s(ea, tension));
        let out_of_plane = part.mul(scale, tension);
        let extra = simd.div_f64s(part.mul(scale, ea), square);
        let by_normal = part.mul(extra, normal);
        [
            part.mul_add(by_normal, normal, out_of_plane),
            part.mul(by_normal, along),
            part.mul_add(part.mul(extra, along), along, out_of_plane),
            out_of_plane,
        ]
    }
}

/// Eliminates the unknowns from number `kept` on of K − xM with D components per function. Their rows keep the values
/// that [`substitute`] needs.
#[inline(always)]
fn factor<S: Simd, const D: usize, const H: usize>(
    part: Part<S>,
    stiffness: &[Line],
    matrix: &mut [Line],
    functions: usize,
    inertia: &Lane,
    kept: usize,
    min_pivot: &mut Lane,
) {
    // K − xM.
    for (entry, k) in matrix.iter_mut().zip(stiffness) {
        part.set(entry, part.of(k));
    }
    let inertia = part.neg(part.of(inertia));
    for (k, j, mass) in MASSES[H - 1].of(functions) {
        let mass = part.mul(part.splat(*mass), inertia);
        for d in 0..D {
            let entry = &mut matrix[place(D * k + d, D * j + d)];
            let less = part.simd.add_f64s(part.of(entry), mass);
            part.set(entry, less);
        }
    }

    // Eliminate from the last unknown down, four at a time.
    let n = D * functions;
    let odd = (n - kept) % BATCH;
    let first = n - odd;
    match odd {
        1 => eliminate::<S, 1>(part, matrix, first, min_pivot),
        2 => eliminate::<S, 2>(part, matrix, first, min_pivot),
        3 => eliminate::<S, 3>(part, matrix, first, min_pivot),
        _ => {}
    }
    for t in (kept..first).step_by(BATCH).rev() {
        eliminate::<S, BATCH>(part, matrix, t, min_pivot);
    }
}

/// Number of unknowns eliminated at a time, which is also the number of products per number loaded and stored.
const BATCH: usize = 4;

/// Eliminates unknowns t, t + 1, … t + R − 1, the last of the remaining ones.
#[inline(always)]
fn eliminate<S: Simd, const R: usize>(part: Part<S>, matrix: &mut [Line], t: usize, min_pivot: &mut Lane) {
    let (above, mut rest) = matrix[..place(t + R, 0)].split_at_mut(place(t, 0));
    let mut rows: [&mut [Line]; R] = from_fn(|r| {
        let (row, further) = std::mem::take(&mut rest).split_at_mut(t + r + 1);
        rest = further;
        row
    });

    // Elimination among these rows.
    let mut inverses = [part.splat(0.0); R];
    for r in (0..R).rev() {
        let (lower, row) = rows.split_at_mut(r);
        inverses[r] = part.neg(invert_pivot(part, row[0], t + r, min_pivot));
        for (k, lower) in lower.iter_mut().enumerate() {
            let factor = part.mul(part.of(&row[0][t + k]), inverses[r]);
            for (entry, a) in lower.iter_mut().zip(&*row[0]) {
                let less = part.mul_add(factor, part.of(a), part.of(entry));
                part.set(entry, less);
            }
        }
    }

    // Their contribution to the rows above; two rows at a time share the loaded numbers.
    let rows: [&[Line]; R] = rows.map(|row| &row[..t]);
    let mut row = t % 2;
    if row == 1 {
        let mut sum = part.of(&above[0]);
        for r in 0..R {
            let a = part.of(&rows[r][0]);
            sum = part.mul_add(part.mul(a, inverses[r]), a, sum);
        }
        part.set(&mut above[0], sum);
    }
    while row < t {
        let (mut factors, mut further_factors) = (inverses, inverses);
        for r in 0..R {
            factors[r] = part.mul(part.of(&rows[r][row]), inverses[r]);
            further_factors[r] = part.mul(part.of(&rows[r][row + 1]), inverses[r]);
        }
        let (entries, further) = above[place(row, 0)..place(row + 2, 0)].split_at_mut(row + 1);
        let (further, last) = further.split_at_mut(row + 1);
        for (column, (entry, further)) in entries.iter_mut().zip(further).enumerate() {
            let (mut sum, mut further_sum) = (part.of(entry), part.of(further));
            for r in 0..R {
                let a = part.of(&rows[r][column]);
                sum = part.mul_add(factors[r], a, sum);
                further_sum = part.mul_add(further_factors[r], a, further_sum);
            }
            part.set(entry, sum);
            part.set(further, further_sum);
        }
        let mut sum = part.of(&last[0]);
        for r in 0..R {
            sum = part.mul_add(further_factors[r], part.of(&rows[r][row + 1]), sum);
        }
        part.set(&mut last[0], sum);
        row += 2;
    }
}

/// Replaces a pivot by its inverse, returns the inverse, and updates the minimum pivot.
#[inline(always)]
fn invert_pivot<S: Simd>(part: Part<S>, row: &mut [Line], at: usize, min_pivot: &mut Lane) -> S::f64s {
    let pivot = part.of(&row[at]);
    let minimum = part.of(min_pivot);
    let lower = part.simd.less_than_f64s(pivot, minimum);
    part.set(min_pivot, part.simd.select_f64s(lower, pivot, minimum));
    let inverse = part.inverse(pivot);
    part.set(&mut row[at], inverse);
    inverse
}

/// Motion of all n unknowns: the eliminated ones follow the kept ones, without other forces on them.
#[inline(always)]
fn substitute<S: Simd>(simd: S, factor: &[Line], n: usize, kept: &[Lane]) -> Lanes {
    let mut all = Lanes::any(n);
    for (line, lane) in all.iter_mut().zip(kept) {
        line.0 = *lane;
    }

    for part in Part::all(simd) {
        let mut t = kept.len();
        if (n - t) % 2 == 1 {
            let row = &factor[place(t, 0)..=place(t, t)];
            let sum = part.dot(&row[..t], &all[..t]);
            part.set(&mut all[t], part.neg(part.mul(sum, part.of(&row[t]))));
            t += 1;
        }
        // Two at a time: only one product of the second depends on the first.
        while t < n {
            let (first, second) = factor[place(t, 0)..place(t + 2, 0)].split_at(t + 1);
            let (known, new) = all.split_at_mut(t);
            let mut sums = [part.splat(0.0); 4];
            let mut columns = first.chunks_exact(2).zip(second.chunks_exact(2)).zip(known.chunks_exact(2));
            for ((a, b), known) in columns.by_ref() {
                for k in 0..2 {
                    let value = part.of(&known[k]);
                    sums[k] = part.mul_add(part.of(&a[k]), value, sums[k]);
                    sums[2 + k] = part.mul_add(part.of(&b[k]), value, sums[2 + k]);
                }
            }
            if t % 2 == 1 {
                let value = part.of(&known[t - 1]);
                sums[0] = part.mul_add(part.of(&first[t - 1]), value, sums[0]);
                sums[2] = part.mul_add(part.of(&second[t - 1]), value, sums[2]);
            }
            let value = part.neg(part.mul(simd.add_f64s(sums[0], sums[1]), part.of(&first[t])));
            let sum = part.mul_add(part.of(&second[t]), value, simd.add_f64s(sums[2], sums[3]));
            part.set(&mut new[0], value);
            part.set(&mut new[1], part.neg(part.mul(sum, part.of(&second[t + 1]))));
            t += 2;
        }
    }

    all
}

/// Product `aᵀ M b` with D components per function, divided by half the mass.
#[inline(always)]
fn mass<S: Simd, const D: usize, const H: usize>(part: Part<S>, a: &[Line], b: &[Line]) -> S::f64s {
    let (a, b) = (a.as_chunks::<D>().0, b.as_chunks::<D>().0);
    let mut sums = [part.splat(0.0); D];
    for (k, j, mass) in MASSES[H - 1].of(a.len()) {
        let mass = part.splat(*mass);
        let (a_k, a_j, b_k, b_j) = (&a[*k], &a[*j], &b[*k], &b[*j]);
        for (d, sum) in sums.iter_mut().enumerate() {
            let mut product = part.mul(part.of(&a_k[d]), part.of(&b_j[d]));
            if j != k {
                product = part.mul_add(part.of(&a_j[d]), part.of(&b_k[d]), product);
            }
            *sum = part.mul_add(mass, product, *sum);
        }
    }
    if D == 1 { sums[0] } else { part.simd.add_f64s(sums[0], sums[1]) }
}

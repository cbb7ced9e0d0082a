//! Several exact cables side by side at one frequency, each condensed onto its platform end and its lowest bubbles.
//!
//! The first natural frequency of a robot is not above the first clamped one of any of its cables, so that a single
//! element of modest degree resolves every cable, and one factorisation a frequency costs less than the clamped modes.
//! The unknowns are those of `mesh` in axes along (e) and normal (n) to the chord. They are eliminated from the highest
//! bubble down; the lowest bubble along n, and that out of plane, are kept beside the platform end: they carry the first
//! clamped modes, so that what has been eliminated has its poles far above.

use super::mesh::{ellipse, has_tension};
use crate::catenary::Catenary;
use crate::math::legendre;
use std::array::from_fn;
use std::sync::LazyLock;

/// Numbers side by side: two AVX2 registers, one of AVX-512.
pub(crate) const LANES: usize = 8;

/// One number a cable.
pub(crate) type Lane = [f64; LANES];

const ZERO: Lane = [0.0; LANES];

/// Most degrees of an element; two products of slopes take [`MOST_TERMS`].
pub(crate) const MOST_DEGREES: usize = 40;

/// Most Legendre terms of C.
const MOST_TERMS: usize = 2 * MOST_DEGREES - 1;

/// Coefficients of C below this part are left out.
const TRUNCATION: f64 = 1e-15;

/// Components of C in the plane, and out of it: (nn, en, ee, oo).
const PARTS: usize = 4;

/// Up to [`LANES`] cables; the last lanes repeat the last cable.
#[derive(Debug, Clone)]
pub(crate) struct Abreast {
    /// Degree that the matrices have.
    degree: usize,
    /// Legendre coefficients of C over half the length [N/m], by degree.
    coefficients: Vec<[Lane; PARTS]>,
    /// Lower triangle by rows, unknowns n, e of each function: the hat of the platform end, then bubbles, ascending.
    plane: Vec<Lane>,
    /// The same out of plane.
    across: Vec<Lane>,
    /// Half the mass [kg].
    half_mass: Lane,
    /// The factors at the last frequency: rows of eliminated unknowns, the inverses of their pivots on the diagonal.
    plane_factor: Vec<Lane>,
    across_factor: Vec<Lane>,
    /// Degree of the factors.
    factored: usize,
}

/// Unknowns kept in plane: n and e of the end, n of the lowest bubble.
pub(crate) const IN_PLANE: usize = 3;
/// Unknowns kept out of plane: the end, the lowest bubble.
pub(crate) const ACROSS: usize = 2;

/// The dynamic stiffness of the kept unknowns [N/m], lower triangles by rows.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Kept {
    pub(crate) plane: [Lane; 6],
    pub(crate) across: [Lane; 3],
    /// Least pivot of what was eliminated: positive if nothing of it has a natural frequency below.
    pub(crate) least_pivot: Lane,
}

impl Kept {
    /// The entries of one cable, in plane and out of plane.
    #[inline(always)]
    pub(crate) fn of(&self, lane: usize) -> ([f64; 6], [f64; 3]) {
        (from_fn(|entry| self.plane[entry][lane]), from_fn(|entry| self.across[entry][lane]))
    }
}

/// Place in a lower triangle by rows.
#[inline(always)]
pub(crate) const fn place(row: usize, column: usize) -> usize {
    row * (row + 1) / 2 + column
}

impl Abreast {
    /// Cables of mass m per unstrained length [kg/m], at least one and at most [`LANES`]. None if one has no tension
    /// somewhere, or needs more than one element or more than [`MOST_DEGREES`].
    pub(crate) fn new(cables: &[(&Catenary, f64)]) -> Option<Self> {
        let mut size = f64::INFINITY;
        for (catenary, _) in cables {
            if !has_tension(catenary) {
                return None;
            }
            let half = 0.5 * catenary.rope().unstrained_length;
            size = size.min(ellipse(catenary, half, half));
        }
        let terms = if size.is_finite() { (-TRUNCATION.ln() / size.ln()).ceil() as usize + 1 } else { 1 };
        if terms > MOST_TERMS {
            return None;
        }
        let lane = |i: usize| cables[i.min(cables.len() - 1)];
        let half_mass = from_fn(|i| 0.5 * lane(i).1 * lane(i).0.rope().unstrained_length);
        let mut shapes = Shapes::default();
        for i in 0..LANES {
            shapes.set(i, lane(i).0);
        }
        let mut coefficients = vec![[ZERO; PARTS]; terms];
        pulp::Arch::new().dispatch(Expand { shapes: &shapes, coefficients: &mut coefficients });
        Some(Self {
            degree: 0,
            coefficients,
            plane: Vec::new(),
            across: Vec::new(),
            half_mass,
            plane_factor: Vec::new(),
            across_factor: Vec::new(),
            factored: 0,
        })
    }

    /// Number of Legendre terms that C takes.
    pub(crate) fn terms(&self) -> usize {
        self.coefficients.len()
    }

    /// K − xM of the kept unknowns at x = ω² [rad²/s²], from functions up to `degree`, which is at least 2.
    pub(crate) fn kept(&mut self, x: f64, degree: usize) -> Kept {
        pulp::Arch::new().dispatch(Factorise { cables: self, x, degree })
    }

    /// Motion of all functions for motions of the kept unknowns, at the frequency and the degree of the last
    /// [`kept`](Self::kept).
    pub(crate) fn moved(&self, plane: [Lane; IN_PLANE], across: [Lane; ACROSS]) -> Motion {
        pulp::Arch::new().dispatch(Substitute { cables: self, plane, across })
    }

    /// `aᵀ M b` in plane and out of plane [kg × motion²].
    pub(crate) fn mass(&self, a: &Motion, b: &Motion) -> [Lane; 2] {
        pulp::Arch::new().dispatch(Weigh { cables: self, a, b })
    }
}

/// Amplitudes of all functions of cables side by side.
#[derive(Debug, Clone)]
pub(crate) struct Motion {
    plane: Vec<Lane>,
    across: Vec<Lane>,
}

/// What C depends on: the force along the unstrained length, in axes along and normal to the chord.
#[derive(Debug, Clone, Copy, Default)]
struct Shapes {
    /// Force at the middle of the cable, along the chord and normal to it [N].
    along: Lane,
    normal: Lane,
    /// Half its change from end to end [N].
    along_change: Lane,
    normal_change: Lane,
    axial_stiffness: Lane,
    inverse_half: Lane,
}

impl Shapes {
    fn set(&mut self, i: usize, catenary: &Catenary) {
        let rope = catenary.rope();
        let (h, v) = (catenary.horizontal_force(), catenary.vertical_force_at_start() + 0.5 * catenary.weight());
        let [cos, sin] = catenary.chord_direction();
        let change = 0.5 * catenary.weight();
        (self.along[i], self.normal[i]) = (h * cos + v * sin, v * cos - h * sin);
        (self.along_change[i], self.normal_change[i]) = (change * sin, change * cos);
        self.axial_stiffness[i] = rope.axial_stiffness;
        self.inverse_half[i] = 2.0 / rope.unstrained_length;
    }
}

/// Legendre coefficients of C by Gauss's rule.
struct Expand<'a> {
    shapes: &'a Shapes,
    coefficients: &'a mut [[Lane; PARTS]],
}

impl pulp::NullaryFnOnce for Expand<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { shapes: s, coefficients } = self;
        // With as many points as terms, what is left out comes back in the last term at most.
        let rule = &RULES[coefficients.len() - 1];
        for (xi, weighted) in rule {
            let mut parts = [ZERO; PARTS];
            for i in 0..LANES {
                let (along, normal) = (s.along[i] + xi * s.along_change[i], s.normal[i] + xi * s.normal_change[i]);
                let square = along * along + normal * normal;
                let tension = square.sqrt();
                let ea = s.axial_stiffness[i];
                let part = s.inverse_half[i] * ea / (ea + tension);
                let across = part * tension;
                let extra = part * ea / square;
                parts[0][i] = across + extra * normal * normal;
                parts[1][i] = extra * along * normal;
                parts[2][i] = across + extra * along * along;
                parts[3][i] = across;
            }
            for (sums, weight) in coefficients.iter_mut().zip(weighted) {
                for (sum, part) in sums.iter_mut().zip(&parts) {
                    for i in 0..LANES {
                        sum[i] += part[i] * weight;
                    }
                }
            }
        }
    }
}

/// Adds rows of the stiffness up to a degree: `∫ C N_a′ N_b′` over products of slopes.
#[inline(always)]
fn refine(cables: &mut Abreast, degree: usize) {
    let Abreast { coefficients, plane, across, .. } = cables;
    for k in cables.degree..degree {
        let row = plane.len();
        plane.resize(row + 4 * k + 3, ZERO);
        let (of_n, of_e) = plane[row..].split_at_mut(2 * k + 1);
        for j in 0..=k {
            let mut sums = [ZERO; PARTS];
            for (factor, c) in TRIPLES.of(k, j).iter().zip(coefficients.iter().skip(k - j).step_by(2)) {
                for (sum, c) in sums.iter_mut().zip(c) {
                    for i in 0..LANES {
                        sum[i] += factor * c[i];
                    }
                }
            }
            let [nn, en, ee, oo] = sums;
            of_n[2 * j] = nn;
            if j < k {
                of_n[2 * j + 1] = en;
            }
            (of_e[2 * j], of_e[2 * j + 1]) = (en, ee);
            across.push(oo);
        }
    }
    cables.degree = cables.degree.max(degree);
}

struct Factorise<'a> {
    cables: &'a mut Abreast,
    x: f64,
    degree: usize,
}

impl pulp::NullaryFnOnce for Factorise<'_> {
    type Output = Kept;

    #[inline(always)]
    fn call(self) -> Kept {
        let Self { cables, x, degree } = self;
        refine(cables, degree);
        let inertia: Lane = from_fn(|i| x * cables.half_mass[i]);
        let Abreast { plane, across, plane_factor, across_factor, .. } = cables;
        plane_factor.clear();
        plane_factor.extend_from_slice(&plane[..place(2 * degree, 0)]);
        across_factor.clear();
        across_factor.extend_from_slice(&across[..place(degree, 0)]);
        take_inertia::<2>(plane_factor, degree, &inertia);
        take_inertia::<1>(across_factor, degree, &inertia);
        let mut least_pivot = [f64::INFINITY; LANES];
        eliminate(plane_factor, 2 * degree, IN_PLANE, &mut least_pivot);
        eliminate(across_factor, degree, ACROSS, &mut least_pivot);
        cables.factored = degree;
        Kept {
            plane: from_fn(|k| cables.plane_factor[k]),
            across: from_fn(|k| cables.across_factor[k]),
            least_pivot,
        }
    }
}

/// Takes x M off the stiffness of D components a function.
#[inline(always)]
fn take_inertia<const D: usize>(matrix: &mut [Lane], degree: usize, inertia: &Lane) {
    for k in 0..degree {
        for (j, mass) in MASSES.row(k) {
            for d in 0..D {
                let entry = &mut matrix[place(D * k + d, D * j + d)];
                for i in 0..LANES {
                    entry[i] -= mass * inertia[i];
                }
            }
        }
    }
}

/// Eliminates the unknowns from the last of `n` down to number `kept`, two at a time; their rows keep what
/// [`substitute`] needs.
#[inline(always)]
fn eliminate(matrix: &mut [Lane], n: usize, kept: usize, least_pivot: &mut Lane) {
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

struct Substitute<'a> {
    cables: &'a Abreast,
    plane: [Lane; IN_PLANE],
    across: [Lane; ACROSS],
}

impl pulp::NullaryFnOnce for Substitute<'_> {
    type Output = Motion;

    #[inline(always)]
    fn call(self) -> Motion {
        let Self { cables, plane, across } = self;
        Motion {
            plane: substitute(&cables.plane_factor, 2 * cables.factored, &plane),
            across: substitute(&cables.across_factor, cables.factored, &across),
        }
    }
}

/// The eliminated unknowns, at rest but for what the kept ones do to them.
#[inline(always)]
fn substitute(factor: &[Lane], n: usize, kept: &[Lane]) -> Vec<Lane> {
    let mut all = vec![ZERO; n];
    all[..kept.len()].copy_from_slice(kept);
    for t in kept.len()..n {
        let row = &factor[place(t, 0)..=place(t, t)];
        let mut sum = ZERO;
        for (a, u) in row[..t].iter().zip(&all) {
            for i in 0..LANES {
                sum[i] += a[i] * u[i];
            }
        }
        all[t] = from_fn(|i| -sum[i] * row[t][i]);
    }
    all
}

struct Weigh<'a> {
    cables: &'a Abreast,
    a: &'a Motion,
    b: &'a Motion,
}

impl pulp::NullaryFnOnce for Weigh<'_> {
    type Output = [Lane; 2];

    #[inline(always)]
    fn call(self) -> [Lane; 2] {
        let Self { cables, a, b } = self;
        let half = &cables.half_mass;
        let sums = [weigh::<2>(&a.plane, &b.plane), weigh::<1>(&a.across, &b.across)];
        sums.map(|sum| from_fn(|i| sum[i] * half[i]))
    }
}

#[inline(always)]
fn weigh<const D: usize>(a: &[Lane], b: &[Lane]) -> Lane {
    let mut sum = ZERO;
    for k in 0..a.len() / D {
        for (j, mass) in MASSES.row(k) {
            for d in 0..D {
                let (ak, aj, bk, bj) = (&a[D * k + d], &a[D * j + d], &b[D * k + d], &b[D * j + d]);
                for i in 0..LANES {
                    let product = if j == k { ak[i] * bk[i] } else { ak[i] * bj[i] + aj[i] * bk[i] };
                    sum[i] += mass * product;
                }
            }
        }
    }
    sum
}

/// `∫ N_a N_b dξ` of the hat at −1 (k = 0) and the bubbles N_{k+1}.
struct Masses {
    /// With itself, with the function two below.
    own: [f64; MOST_DEGREES],
    two_below: [f64; MOST_DEGREES],
    /// Of the lowest bubble with the hat.
    first: f64,
}

impl Masses {
    /// The entries of row k up to the diagonal.
    #[inline(always)]
    fn row(&self, k: usize) -> impl Iterator<Item = (usize, f64)> + use<> {
        let below = match k {
            0 => None,
            1 => Some((0, self.first)),
            _ => Some((k - 2, self.two_below[k])),
        };
        [Some((k, self.own[k])), below].into_iter().flatten()
    }
}

static MASSES: LazyLock<Masses> = LazyLock::new(|| {
    let (mut own, mut two_below) = ([2.0 / 3.0; MOST_DEGREES], [0.0; MOST_DEGREES]);
    for k in 1..MOST_DEGREES {
        let n = k as f64 + 1.0;
        own[k] = 2.0 / ((2.0 * n + 1.0) * (2.0 * n - 3.0));
        if k > 2 {
            two_below[k] = -1.0 / ((2.0 * n - 3.0) * ((2.0 * n - 5.0) * (2.0 * n - 1.0)).sqrt());
        }
    }
    two_below[2] = 1.0 / (3.0 * 10f64.sqrt());
    Masses { own, two_below, first: -1.0 / 6f64.sqrt() }
});

/// `∫ P_l s_j s_k dξ` of the slopes s of two functions and Legendre's P_l, for l = |k − j|, |k − j| + 2, … k + j, outside
/// of which they vanish.
struct Triples {
    /// Where each pair (k, j ≤ k) begins.
    starts: Vec<usize>,
    values: Vec<f64>,
}

impl Triples {
    #[inline(always)]
    fn of(&self, k: usize, j: usize) -> &[f64] {
        let at = place(k, j);
        &self.values[self.starts[at]..self.starts[at + 1]]
    }
}

/// By Adams's product: `P_k P_j = Σ_r a_r a_{k−r} a_{j−r}/a_{k+j−r} (2l + 1)/(2l + 2r + 1) P_l`, l = k + j − 2r,
/// a_r = (2r − 1)!!/r!; a sum of positive terms.
static TRIPLES: LazyLock<Triples> = LazyLock::new(|| {
    let mut a = vec![1.0_f64; 2 * MOST_DEGREES];
    for r in 1..a.len() {
        a[r] = a[r - 1] * (2.0 * r as f64 - 1.0) / r as f64;
    }
    let (mut starts, mut values) = (vec![0], Vec::new());
    // Of the orthonormal polynomials; the hat's slope is −1/2.
    let scale = |k: usize| if k == 0 { -0.5 } else { (k as f64 + 0.5).sqrt() };
    for k in 0..MOST_DEGREES {
        for j in 0..=k {
            for r in (0..=j).rev() {
                let l = k + j - 2 * r;
                let product = a[r] * a[k - r] * a[j - r] / a[k + j - r] * 2.0 / (2 * l + 2 * r + 1) as f64;
                values.push(product * scale(k) * scale(j));
            }
            starts.push(values.len());
        }
    }
    Triples { starts, values }
});

/// Gauss's rules of 1, 2, … points: ξ, and its weight times (2l + 1)/2 P_l(ξ).
static RULES: LazyLock<Vec<Vec<(f64, Vec<f64>)>>> = LazyLock::new(|| {
    (1..=MOST_TERMS)
        .map(|points| {
            let expanded = |(xi, weight): (f64, f64)| {
                let p = legendre::orthonormal(xi, points - 1);
                (xi, p.iter().enumerate().map(|(l, p)| weight * p * (l as f64 + 0.5).sqrt()).collect())
            };
            legendre::gauss(points).into_iter().map(expanded).collect()
        })
        .collect()
});

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cable::exact::Exact;
    use crate::catenary::Rope;
    use proptest::prelude::*;

    /// Slope, length over chord, elasticity.
    fn cable((slope, slack, stiffness): (f64, f64, f64)) -> Catenary {
        let (span, rise) = (6.0 * (1.0 - slope * slope).sqrt(), 6.0 * slope);
        let rope = Rope {
            unstrained_length: 6.0 * slack,
            weight_per_length: 0.657_27,
            axial_stiffness: 10f64.powf(stiffness),
        };
        Catenary::between(span, rise, rope).unwrap()
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..Default::default() })]

        /// Up to the first clamped frequency, taut cables and such that sag by a sixth; at a degree that resolves all.
        #[test]
        fn cables_side_by_side_have_the_stiffness_of_each_by_its_poles(
            shapes in prop::collection::vec((-0.9f64..0.9, 0.99f64..1.08, 4.5f64..6.0), 1..=LANES), part in 0.0f64..0.98,
        ) {
            const MASS: f64 = 0.067;
            let cables: Vec<Catenary> = shapes.into_iter().map(cable).collect();
            let oracles: Vec<Exact> = cables.iter().map(|c| Exact::new(c, MASS, 60.0).unwrap()).collect();
            let first = |e: &Exact| e.in_plane.poles[0].min(e.out_of_plane.poles[0]);
            let x = part * oracles.iter().map(first).fold(f64::INFINITY, f64::min);
            let pairs: Vec<_> = cables.iter().map(|c| (c, MASS)).collect();
            let mut abreast = Abreast::new(&pairs).unwrap();
            let kept = abreast.kept(x, 30);
            for (i, (catenary, exact)) in cables.iter().zip(&oracles).enumerate() {
                let ([nn, en, ee, qn, qe, qq], [oo, bo, bb]) = kept.of(i);
                prop_assert!(kept.least_pivot[i] > 0.0 && qq > 0.0 && bb > 0.0);
                let ours = [ee - qe * qe / qq, en - qn * qe / qq, nn - qn * qn / qq, oo - bo * bo / bb];
                let k = exact.undamped(x.sqrt());
                let [c, s] = catenary.chord_direction();
                let theirs = [
                    k.axial * c * c + 2.0 * k.coupling * c * s + k.normal * s * s,
                    (k.normal - k.axial) * c * s + k.coupling * (c * c - s * s),
                    k.axial * s * s - 2.0 * k.coupling * c * s + k.normal * c * c,
                    k.out_of_plane,
                ];
                let size = theirs.iter().fold(0.0, |m: f64, k| m.max(k.abs()));
                for (ours, theirs) in ours.into_iter().zip(theirs) {
                    prop_assert!((ours - theirs).abs() < 1e-8 * size, "{ours} for {theirs}, largest {size}");
                }
            }
        }

        /// Unit motions of the end, bubbles following.
        #[test]
        fn the_mass_of_a_motion_is_minus_the_change_of_stiffness(
            shape in (-0.9f64..0.9, 0.99f64..1.08, 4.5f64..6.0), part in 0.1f64..0.5, n in -1.0f64..1.0, e in -1.0f64..1.0,
        ) {
            const MASS: f64 = 0.067;
            let catenary = cable(shape);
            let exact = Exact::new(&catenary, MASS, 20.0).unwrap();
            let x = part * exact.in_plane.poles[0].min(exact.out_of_plane.poles[0]);
            let mut abreast = Abreast::new(&[(&catenary, MASS)]).unwrap();
            let mut work = |x: f64| {
                let ([nn, en, ee, ..], [oo, ..]) = abreast.kept(x, 24).of(0);
                [nn * n * n + 2.0 * en * n * e + ee * e * e, oo * n * n]
            };
            let step = 1e-3 * x;
            let change = {
                let (more, less) = (work(x + step), work(x - step));
                [0, 1].map(|k| (less[k] - more[k]) / (2.0 * step))
            };
            abreast.kept(x, 24);
            let lanes = |value: f64| [value; LANES];
            let motion = abreast.moved([lanes(n), lanes(e), lanes(0.0)], [lanes(n), lanes(0.0)]);
            let mass = abreast.mass(&motion, &motion).map(|lane| lane[0]);
            for (mass, change) in mass.into_iter().zip(change) {
                prop_assert!((mass - change).abs() < 1e-5 * mass.max(1e-3), "{mass} for {change}");
            }
        }
    }

    #[test]
    fn a_loop_without_tension_and_one_too_slack_for_one_element_are_left_to_others() {
        let rope = Rope { unstrained_length: 8.0, weight_per_length: 0.6, axial_stiffness: 1e5 };
        for span in [0.0, 1e-3] {
            let slack = Catenary::between(span, 6.0, rope).unwrap();
            assert!(Abreast::new(&[(&slack, 0.06)]).is_none(), "{span}");
        }
    }
}

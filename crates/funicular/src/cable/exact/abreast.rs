//! Several exact cables side by side at one frequency, each condensed onto its platform end and one more function.
//!
//! The first natural frequency of a robot is not above the first clamped one of any of its cables, so that a mesh of
//! modest degree resolves every cable, and one factorisation a frequency costs less than the clamped modes. The unknowns
//! are those of `mesh`: one element, or, where a cable hangs nearly without tension, several that grow with the distance
//! from its lowest point. They are eliminated from the highest bubble down. Kept beside the platform end are, in plane and
//! out of plane, the lowest bubble, or the node at the lowest point: they carry the first clamped modes, so that what has
//! been eliminated has its poles far above.

mod cuts;
mod element;
mod tables;

pub(crate) use element::place;

use crate::catenary::Catenary;
use cuts::Mesh;
use element::{Element, Shapes, eliminate, substitute};
use std::array::from_fn;

/// Numbers side by side: two AVX2 registers, one of AVX-512.
pub(crate) const LANES: usize = 8;

/// One number a cable.
pub(crate) type Lane = [f64; LANES];

const ZERO: Lane = [0.0; LANES];

/// Most degrees of an element. Robots take up to 20.
pub(crate) const MOST_DEGREES: usize = 32;

/// Most Legendre terms of C, those of the smallest ellipse.
const MOST_TERMS: usize = 45;

/// Coefficients of C below this part are left out.
const TRUNCATION: f64 = 1e-15;

/// Up to [`LANES`] cables; the last lanes repeat the last cable.
#[derive(Debug, Clone)]
pub(crate) struct Abreast {
    elements: Vec<Element>,
    /// Legendre terms of C.
    terms: usize,
    /// Which node is kept; 0 if there is one element.
    node: usize,
    /// Factors of the nodes where there are several elements: the platform end, the kept node, the others.
    plane_factor: Vec<Lane>,
    across_factor: Vec<Lane>,
    /// Components of e along the horizontal and up, of each cable: the chord's, or upright where the cable is slack.
    axes: [[f64; 2]; LANES],
}

/// Unknowns kept in plane: n and e of the end, n of the bubble or node.
pub(crate) const IN_PLANE: usize = 3;
/// Unknowns kept out of plane: the end, the bubble or node.
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

/// Amplitudes of all functions of cables side by side: of each element, in plane and out of plane.
#[derive(Debug, Clone)]
pub(crate) struct Motion(Vec<[Vec<Lane>; 2]>);

impl Abreast {
    /// Cables of mass m per unstrained length [kg/m], at least one and at most [`LANES`]. None if one has no tension
    /// somewhere.
    pub(crate) fn new(cables: &[(&Catenary, f64)]) -> Option<Self> {
        let Mesh { nodes, axes, kept, size } = Mesh::of(cables)?;
        let terms = if size.is_finite() { (-TRUNCATION.ln() / size.ln()).ceil() as usize + 1 } else { 1 };
        let terms = terms.min(MOST_TERMS);
        let lane = |i: usize| i.min(cables.len() - 1);
        let shapes: Vec<Shapes> = (1..nodes[0].len())
            .map(|end| {
                let mut shapes = Shapes::default();
                for i in 0..LANES {
                    let cable = lane(i);
                    shapes.set(i, cables[cable], axes[cable], nodes[cable][end - 1], nodes[cable][end]);
                }
                shapes
            })
            .collect();
        Some(Self {
            elements: pulp::Arch::new().dispatch(Expand { shapes: &shapes, terms }),
            terms,
            node: kept,
            plane_factor: Vec::new(),
            across_factor: Vec::new(),
            axes: from_fn(|i| axes[lane(i)]),
        })
    }

    /// In several elements.
    pub(crate) fn is_cut(&self) -> bool {
        self.elements.len() > 1
    }

    /// Number of Legendre terms that C takes.
    pub(crate) fn terms(&self) -> usize {
        self.terms
    }

    /// Components of a cable's axis e along the horizontal and up.
    pub(crate) fn axis(&self, lane: usize) -> [f64; 2] {
        self.axes[lane]
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

    /// Where a node stands in the factors of the nodes; the last, the anchor, does not move.
    #[inline(always)]
    fn place_of(&self, node: usize) -> Option<usize> {
        match node {
            0 => Some(0),
            _ if node == self.elements.len() => None,
            _ if node == self.node => Some(1),
            _ if node < self.node => Some(node + 1),
            _ => Some(node),
        }
    }
}

struct Expand<'a> {
    shapes: &'a [Shapes],
    terms: usize,
}

impl pulp::NullaryFnOnce for Expand<'_> {
    type Output = Vec<Element>;

    #[inline(always)]
    fn call(self) -> Vec<Element> {
        let Self { shapes, terms } = self;
        let mut elements = Vec::with_capacity(shapes.len());
        for shapes in shapes {
            elements.push(Element::new(shapes, terms));
        }
        elements
    }
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
        let mut least_pivot = [f64::INFINITY; LANES];
        if let [element] = cables.elements.as_mut_slice() {
            element.factorise::<1>(x, degree, (IN_PLANE, ACROSS), &mut least_pivot);
            return Kept {
                plane: from_fn(|k| element.plane_factor[k]),
                across: from_fn(|k| element.across_factor[k]),
                least_pivot,
            };
        }
        let nodes = cables.elements.len();
        let (mut plane, mut across) = (vec![ZERO; place(2 * nodes, 0)], vec![ZERO; place(nodes, 0)]);
        for e in 0..nodes {
            cables.elements[e].factorise::<2>(x, degree, (4, 2), &mut least_pivot);
            let places = [cables.place_of(e), cables.place_of(e + 1)];
            let element = &cables.elements[e];
            add_between::<2>(&mut plane, &element.plane_factor, places);
            add_between::<1>(&mut across, &element.across_factor, places);
        }
        eliminate(&mut plane, 2 * nodes, IN_PLANE, &mut least_pivot);
        eliminate(&mut across, nodes, ACROSS, &mut least_pivot);
        let kept = Kept { plane: from_fn(|k| plane[k]), across: from_fn(|k| across[k]), least_pivot };
        (cables.plane_factor, cables.across_factor) = (plane, across);
        kept
    }
}

/// Adds an element's stiffness between its ends to that of the nodes.
#[inline(always)]
fn add_between<const D: usize>(nodes: &mut [Lane], element: &[Lane], places: [Option<usize>; 2]) {
    for row in 0..2 * D {
        for column in 0..=row {
            let (Some(p), Some(q)) = (places[row / D], places[column / D]) else { continue };
            let (p, q) = (D * p + row % D, D * q + column % D);
            let entry = &mut nodes[place(p.max(q), p.min(q))];
            let part = &element[place(row, column)];
            for i in 0..LANES {
                entry[i] += part[i];
            }
        }
    }
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
        if let [element] = cables.elements.as_slice() {
            return Motion(vec![element.moved(&plane, &across)]);
        }
        let nodes = cables.elements.len();
        let plane = substitute(&cables.plane_factor, 2 * nodes, &plane);
        let across = substitute(&cables.across_factor, nodes, &across);
        let mut all = Vec::with_capacity(nodes);
        for (e, element) in cables.elements.iter().enumerate() {
            let (mut ends, mut ends_across) = ([ZERO; 4], [ZERO; 2]);
            for (side, place) in [cables.place_of(e), cables.place_of(e + 1)].into_iter().enumerate() {
                if let Some(place) = place {
                    ends[2 * side..2 * side + 2].copy_from_slice(&plane[2 * place..2 * place + 2]);
                    ends_across[side] = across[place];
                }
            }
            all.push(element.moved(&ends, &ends_across));
        }
        Motion(all)
    }
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
        let mut sums = [ZERO; 2];
        if let [element] = cables.elements.as_slice() {
            element.weigh::<1>(&a.0[0], &b.0[0], &mut sums);
            return sums;
        }
        for ((element, a), b) in cables.elements.iter().zip(&a.0).zip(&b.0) {
            element.weigh::<2>(a, b, &mut sums);
        }
        sums
    }
}

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

        /// Up to the first clamped frequency, from taut cables to such as hang in a loop; at a degree that resolves all.
        #[test]
        fn cables_side_by_side_have_the_stiffness_of_each_by_its_poles(
            shapes in prop::collection::vec((-0.9f64..0.9, 0.99f64..1.3, 4.5f64..6.0), 1..=LANES), part in 0.0f64..0.98,
        ) {
            const MASS: f64 = 0.067;
            let cables: Vec<Catenary> = shapes.into_iter().map(cable).collect();
            let oracles: Vec<Exact> = cables.iter().map(|c| Exact::new(c, MASS, 60.0).unwrap()).collect();
            let first = |e: &Exact| e.in_plane.poles[0].min(e.out_of_plane.poles[0]);
            let x = part * oracles.iter().map(first).fold(f64::INFINITY, f64::min);
            let pairs: Vec<_> = cables.iter().map(|c| (c, MASS)).collect();
            let mut abreast = Abreast::new(&pairs).unwrap();
            let kept = abreast.kept(x, 30);
            for (i, exact) in oracles.iter().enumerate() {
                let ([nn, en, ee, qn, qe, qq], [oo, bo, bb]) = kept.of(i);
                prop_assert!(kept.least_pivot[i] > 0.0 && qq > 0.0 && bb > 0.0);
                let ours = [ee - qe * qe / qq, en - qn * qe / qq, nn - qn * qn / qq, oo - bo * bo / bb];
                let k = exact.undamped(x.sqrt());
                let [c, s] = abreast.axis(i);
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
    fn a_loop_without_tension_is_left_to_others() {
        let rope = Rope { unstrained_length: 8.0, weight_per_length: 0.6, axial_stiffness: 1e5 };
        let slack = Catenary::between(0.0, 6.0, rope).unwrap();
        assert!(Abreast::new(&[(&slack, 0.06)]).is_none());
    }
}

//! Catenary-dynamic cables side by side at one frequency, each condensed onto its platform end and one more function.
//!
//! The first natural frequency of a robot is not above the first clamped frequency of any of its cables. So a mesh of
//! modest degree resolves every cable, and one factorisation per frequency costs less than the clamped modes.
//!
//! The unknowns are those of `mesh`: one element, or, if a cable hangs nearly without tension, several elements that
//! grow with the distance from its lowest point. Elements are computed side by side: cables of one element in one
//! group, the elements of all other cables in another.
//!
//! Unknowns are eliminated from the highest bubble down. Besides the platform end one function is kept in plane and one
//! out of plane: the lowest bubble, or the node at the lowest point. These functions carry the first clamped modes, so
//! that the eliminated unknowns have their poles far above.

mod element;
mod element_integrals;
mod end_elimination;
mod mesh;
mod node_elimination;

pub(super) use element_integrals::place;

use crate::cable::catenary_dynamic::MovingEnd;
use crate::catenary::Catenary;
use crate::math::simd::{LANES, Lane, Lanes};
use element::{ElementBatch, ForceShapes};
use end_elimination::CableEnd;
use mesh::GradedMesh;
use node_elimination::ElementChain;
use pulp::Simd;
use std::array::from_fn;

/// Maximum degree of an element. Robots take up to 20.
pub(super) const MAX_DEGREES: usize = 32;

/// Maximum number of Legendre terms of C, needed for the smallest Bernstein ellipse.
const MAX_TERMS: usize = 45;

/// Relative size below which coefficients of C are left out.
const TRUNCATION: f64 = 1e-13;

/// Free span of a cable with mass, or with a drive that has mass.
#[derive(Debug)]
pub(super) struct CableSpan<'a> {
    pub(super) catenary: &'a Catenary,
    /// Mass m per unstrained length [kg/m].
    pub(super) mass_per_length: f64,
    /// Motion of its far end with the drive behind it; `None` for an end that is held.
    pub(super) end: Option<MovingEnd>,
}

/// Group of up to [`LANES`] cables, either all of one element or all of several.
#[derive(Debug)]
pub(super) struct CableGroup {
    /// Indices of the group's cables in the list given to [`groups`](Self::groups).
    members: Vec<usize>,
    /// Elements side by side; unused lanes repeat the last element.
    packs: Vec<ElementBatch>,
    /// Elimination of the nodes of each cable; empty for cables of one element.
    chains: Vec<ElementChain>,
    /// Far end of each cable; empty if all ends are held.
    ends: Vec<CableEnd>,
    /// Number of Legendre terms of C.
    terms: usize,
    /// Components of e along the horizontal and up, per cable: along the chord, or vertical if the cable is slack.
    axes: Vec<[f64; 2]>,
}

/// Number of unknowns kept in plane: n and e of the end, n of the bubble or node.
pub(super) const IN_PLANE: usize = 3;
/// Number of unknowns kept out of plane: the end, the bubble or node.
pub(super) const OUT_OF_PLANE: usize = 2;

/// Dynamic stiffness of the kept unknowns [N/m], lower triangles by rows.
#[derive(Debug, Clone, Copy)]
pub(super) struct KeptStiffness {
    pub(super) in_plane: [Lane; 6],
    pub(super) out_of_plane: [Lane; 3],
    /// Minimum pivot of the elimination: positive if the eliminated unknowns have no natural frequency below.
    pub(super) min_pivot: Lane,
}

impl Default for KeptStiffness {
    /// Zero stiffness without an elimination.
    fn default() -> Self {
        Self { in_plane: Default::default(), out_of_plane: Default::default(), min_pivot: [f64::INFINITY; LANES] }
    }
}

/// Amplitudes of all functions of a group's cables.
#[derive(Debug)]
pub(super) struct FunctionMotion {
    /// Functions of elements side by side, in plane and out of plane for each pack.
    elements: Vec<[Lanes; 2]>,
    /// Unknowns at the far ends, cable by cable.
    ends: Vec<f64>,
}

impl CableGroup {
    /// Groups of all cables. `None` if a point of a cable has no tension.
    pub(super) fn groups(cables: &[CableSpan]) -> Option<Vec<Self>> {
        let meshes = cables.iter().map(|cable| GradedMesh::of(cable.catenary)).collect::<Option<Vec<_>>>()?;
        let (single, divided): (Vec<usize>, Vec<usize>) = (0..cables.len()).partition(|i| meshes[*i].kept == 0);
        let (moving, held): (Vec<usize>, Vec<usize>) = single.into_iter().partition(|i| cables[*i].end.is_some());
        let groups = held.chunks(LANES).chain(moving.chunks(LANES)).chain(divided.chunks(LANES));
        Some(groups.map(|members| Self::of(cables, &meshes, members)).collect())
    }

    fn of(cables: &[CableSpan], meshes: &[GradedMesh], members: &[usize]) -> Self {
        let size = members.iter().map(|i| meshes[*i].size).fold(f64::INFINITY, f64::min);
        let terms = if size.is_finite() { (-TRUNCATION.ln() / size.ln()).ceil() as usize + 1 } else { 1 };
        let terms = terms.min(MAX_TERMS);

        // List of the elements of all cables.
        let mut elements = Vec::with_capacity(2 * LANES);
        let mut chains = Vec::new();
        for i in members {
            let mesh = &meshes[*i];
            if mesh.kept > 0 {
                chains.push(ElementChain::new(mesh, elements.len()));
            }
            elements.extend(mesh.nodes.windows(2).map(|ends| (*i, ends[0], ends[1])));
        }

        // Packs of elements side by side.
        let shapes = elements.chunks(LANES).map(|pack| {
            let mut shapes = ForceShapes::default();
            for lane in 0..LANES {
                let (i, from, to) = pack[lane.min(pack.len() - 1)];
                shapes.set(lane, &cables[i], meshes[i].axis, from, to);
            }
            shapes
        });
        let shapes: Vec<ForceShapes> = shapes.collect();

        // Far ends.
        let moving = members.iter().any(|i| cables[*i].end.is_some());
        let end = |i: &usize| CableEnd::new(&cables[*i], meshes[*i].axis, meshes[*i].kept > 0);
        let ends = if moving { members.iter().map(end).collect() } else { Vec::new() };
        Self {
            members: members.to_vec(),
            packs: pulp::Arch::new().dispatch(Expand { shapes: &shapes, terms }),
            chains,
            ends,
            terms,
            axes: members.iter().map(|i| meshes[*i].axis).collect(),
        }
    }

    /// Index of the cable in each lane.
    pub(super) fn members(&self) -> &[usize] {
        &self.members
    }

    /// True if the cables have several elements.
    pub(super) fn is_divided(&self) -> bool {
        !self.chains.is_empty()
    }

    /// Number of Legendre terms of C.
    pub(super) fn terms(&self) -> usize {
        self.terms
    }

    /// Components of a cable's axis e along the horizontal and up.
    pub(super) fn axis(&self, lane: usize) -> [f64; 2] {
        self.axes[lane]
    }

    /// Matrix K − xM of the kept unknowns at x = ω² [rad²/s²], from functions up to `degree`, which is at least 2.
    pub(super) fn kept(&mut self, x: f64, degree: usize) -> KeptStiffness {
        pulp::Arch::new().dispatch(FactoriseCables { cables: self, x, degree })
    }

    /// Amplitudes of all functions for motions of the kept unknowns, at the frequency and the degree of the last
    /// [`kept`](Self::kept).
    pub(super) fn moved(&self, in_plane: [Lane; IN_PLANE], out_of_plane: [Lane; OUT_OF_PLANE]) -> FunctionMotion {
        pulp::Arch::new().dispatch(Substitute { cables: self, in_plane, out_of_plane })
    }

    /// Products `aᵀ M b` in plane and out of plane [kg × motion²].
    pub(super) fn mass(&self, a: &FunctionMotion, b: &FunctionMotion) -> [Lane; 2] {
        let mut masses = pulp::Arch::new().dispatch(Mass { cables: self, a: &a.elements, b: &b.elements });
        end_elimination::add_mass(&self.ends, &a.ends, &b.ends, &mut masses);
        masses
    }

    /// Mass of the drive of each cable in a motion [kg × motion²].
    pub(super) fn drive_mass(&self, motion: &FunctionMotion) -> Lane {
        end_elimination::drive_mass(&self.ends, &motion.ends)
    }
}

/// Job for vector registers: makes packs of elements.
struct Expand<'a> {
    shapes: &'a [ForceShapes],
    terms: usize,
}

impl pulp::WithSimd for Expand<'_> {
    type Output = Vec<ElementBatch>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Vec<ElementBatch> {
        let Self { shapes, terms } = self;
        let mut elements = Vec::with_capacity(shapes.len());
        for shapes in shapes {
            elements.push(ElementBatch::new(simd, shapes, terms));
        }
        elements
    }
}

/// Job for vector registers: eliminates all unknowns of a group but the kept ones.
struct FactoriseCables<'a> {
    cables: &'a mut CableGroup,
    x: f64,
    degree: usize,
}

impl pulp::WithSimd for FactoriseCables<'_> {
    type Output = KeptStiffness;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> KeptStiffness {
        let Self { cables: CableGroup { packs, chains, ends, .. }, x, degree } = self;

        // Cables of one element with moving ends: the element, then the motions at its far end.
        if chains.is_empty() && !ends.is_empty() {
            let mut min_pivot = [f64::INFINITY; LANES];
            packs[0].factorise::<S, 2>(simd, x, degree, (5, 3), &mut min_pivot);
            return end_elimination::condense(ends, &packs[0], x, &min_pivot);
        }

        // Cables of one element with ends that are held.
        if chains.is_empty() {
            let mut min_pivot = [f64::INFINITY; LANES];
            let element = &mut packs[0];
            element.factorise::<S, 1>(simd, x, degree, (IN_PLANE, OUT_OF_PLANE), &mut min_pivot);
            return KeptStiffness {
                in_plane: from_fn(|k| element.in_plane_factor[k].0),
                out_of_plane: from_fn(|k| element.out_of_plane_factor[k].0),
                min_pivot,
            };
        }

        // Cables of several elements: the elements, then the nodes between them.
        let mut min_pivots = Vec::with_capacity(packs.len());
        for element in packs.iter_mut() {
            let mut min_pivot = [f64::INFINITY; LANES];
            element.factorise::<S, 2>(simd, x, degree, (4, 2), &mut min_pivot);
            min_pivots.push(min_pivot);
        }
        node_elimination::condense(chains, ends, packs, x, &min_pivots)
    }
}

/// Job for vector registers: motion of all functions from that of the kept unknowns.
struct Substitute<'a> {
    cables: &'a CableGroup,
    in_plane: [Lane; IN_PLANE],
    out_of_plane: [Lane; OUT_OF_PLANE],
}

impl pulp::WithSimd for Substitute<'_> {
    type Output = FunctionMotion;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> FunctionMotion {
        let Self { cables: CableGroup { packs, chains, ends, .. }, in_plane, out_of_plane } = self;
        if chains.is_empty() && !ends.is_empty() {
            let (in_plane, out_of_plane, ends) = end_elimination::follow(ends, &in_plane, &out_of_plane);
            return FunctionMotion { elements: vec![packs[0].moved(simd, &in_plane, &out_of_plane)], ends };
        }
        if chains.is_empty() {
            let elements = vec![packs[0].moved(simd, &in_plane, &out_of_plane)];
            return FunctionMotion { elements, ends: Vec::new() };
        }
        let mut elements = Vec::with_capacity(packs.len());
        let (of_packs, ends) = node_elimination::ends(chains, ends, packs.len(), &in_plane, &out_of_plane);
        for (element, ends) in packs.iter().zip(of_packs) {
            elements.push(element.moved(simd, &ends.in_plane, &ends.out_of_plane));
        }
        FunctionMotion { elements, ends }
    }
}

/// Job for vector registers: products with the mass.
struct Mass<'a> {
    cables: &'a CableGroup,
    a: &'a [[Lanes; 2]],
    b: &'a [[Lanes; 2]],
}

impl pulp::WithSimd for Mass<'_> {
    type Output = [Lane; 2];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> [Lane; 2] {
        let Self { cables: CableGroup { packs, chains, ends, .. }, a, b } = self;
        if chains.is_empty() && !ends.is_empty() {
            return packs[0].mass::<S, 2>(simd, &a[0], &b[0]);
        }
        if chains.is_empty() {
            return packs[0].mass::<S, 1>(simd, &a[0], &b[0]);
        }
        let mut masses = Vec::with_capacity(packs.len());
        for ((element, a), b) in packs.iter().zip(a).zip(b) {
            masses.push(element.mass::<S, 2>(simd, a, b));
        }
        node_elimination::sums(chains, &masses)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cable::LocalStiffness;
    use crate::cable::catenary_dynamic::{CatenaryDynamic, EndAlong, EndSideways};
    use crate::catenary::Rope;
    use crate::drive::DriveChain;
    use crate::math::DMat;
    use proptest::prelude::*;

    /// Entries of one cable, in plane and out of plane.
    fn of(kept: &KeptStiffness, lane: usize) -> ([f64; 6], [f64; 3]) {
        (from_fn(|entry| kept.in_plane[entry][lane]), from_fn(|entry| kept.out_of_plane[entry][lane]))
    }

    /// Stiffness ee, en, nn, bb of the platform end, the inner unknowns that are kept condensed, too.
    fn at_platform(kept: &KeptStiffness, lane: usize) -> [f64; 4] {
        let ([nn, en, ee, qn, qe, qq], [oo, bo, bb]) = of(kept, lane);
        assert!(qq > 0.0 && bb > 0.0);
        [ee - qe * qe / qq, en - qn * qe / qq, nn - qn * qn / qq, oo - bo * bo / bb]
    }

    /// Stiffness ee, en, nn, bb in axes with these components of e along the horizontal and up.
    fn in_axes(k: &LocalStiffness<f64>, [c, s]: [f64; 2]) -> [f64; 4] {
        [
            k.axial * c * c + 2.0 * k.coupling * c * s + k.normal * s * s,
            (k.normal - k.axial) * c * s + k.coupling * (c * c - s * s),
            k.axial * s * s - 2.0 * k.coupling * c * s + k.normal * c * c,
            k.out_of_plane,
        ]
    }

    /// End over a wheel, with a drum on a spring and a motor behind a shaft; masses [kg] of all three and of the
    /// swivel.
    fn moving(catenary: &Catenary, [wheel, drum, motor, swivel]: [f64; 4]) -> MovingEnd {
        let tension = catenary.tension_at_end();
        let (h, v) = (catenary.horizontal_force(), catenary.vertical_force_at_end());
        let direction = [-h / tension, -v / tension, 0.0];
        let (rope, shaft, servo) = (2e5, 5e4, 1e4);
        let chain = DriveChain {
            stiffness: DMat::from_row_slice(
                3,
                3,
                &[rope, -rope, 0.0, -rope, rope + shaft, -shaft, 0.0, -shaft, shaft + servo],
            ),
            mass: DMat::from_partial_diagonal(3, 3, &[wheel, drum, motor]),
            cable_mass: DMat::zeros(3, 3),
            drum: None,
            motor: None,
            by_length: Vec::new(),
            drum_side: Vec::new(),
            drum_side_mass: 0.0,
            drum_end: None,
            stretch_drum: 1.0,
            stretches: Vec::new(),
        };

        let sideways = EndSideways { direction: [0.0, 0.0, 1.0], stiffness: 500.0, coupling: 0.0, mass: swivel };
        MovingEnd { along: Some(EndAlong { direction, chain }), sideways: Some(sideways) }
    }

    /// Cable whose far end is held.
    fn held(catenary: &Catenary, mass_per_length: f64) -> CableSpan<'_> {
        CableSpan { catenary, mass_per_length, end: None }
    }

    /// Cable from the sine of its slope, the ratio of length to chord, and the decimal logarithm of EA.
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

        /// Frequencies up to the first clamped one, cables from taut to hanging in a loop, a degree that resolves all.
        #[test]
        fn cables_side_by_side_have_the_stiffness_of_each_by_its_poles(
            shapes in prop::collection::vec((-0.9f64..0.9, 0.99f64..1.3, 4.5f64..6.0), 1..=LANES), part in 0.0f64..0.98,
        ) {
            const MASS: f64 = 0.067;
            let cables: Vec<Catenary> = shapes.into_iter().map(cable).collect();
            let oracles: Vec<CatenaryDynamic> = cables.iter().map(|c| CatenaryDynamic::new(c, MASS,
                60.0).unwrap()).collect();
            let first = |e: &CatenaryDynamic| e.in_plane.poles[0].min(e.out_of_plane.poles[0]);
            let x = part * oracles.iter().map(first).fold(f64::INFINITY, f64::min);
            let spans: Vec<_> = cables.iter().map(|c| held(c, MASS)).collect();
            let mut groups = CableGroup::groups(&spans).unwrap();
            let kept: Vec<KeptStiffness> = groups.iter_mut().map(|group| group.kept(x, 30)).collect();
            let lanes = |(k, group): (usize, &CableGroup)| -> Vec<_> {
                group.members().iter().enumerate().map(|(lane, i)| (k, lane, *i)).collect()
            };
            let places: Vec<_> = groups.iter().enumerate().flat_map(lanes).collect();
            prop_assert_eq!(places.len(), cables.len());

            for (k, lane, i) in places {
                let (group, kept, oracle) = (&groups[k], &kept[k], &oracles[i]);
                prop_assert!(kept.min_pivot[lane] > 0.0);
                let ours = at_platform(kept, lane);
                let theirs = in_axes(&oracle.undamped(x.sqrt()), group.axis(lane));
                let size = theirs.iter().fold(0.0, |m: f64, k| m.max(k.abs()));
                // The stiffness of a cable that hangs in a loop is a millionth of the elastic stiffness, whose rounding
                // errors remain.
                let rope = cables[i].rope();
                let elastic = rope.axial_stiffness / rope.unstrained_length;
                for (ours, theirs) in ours.into_iter().zip(theirs) {
                    let bound = 1e-8 * size + 1e-12 * elastic;
                    prop_assert!((ours - theirs).abs() < bound, "{ours} for {theirs}, largest {size}, elastic \
                        {elastic}");
                }
            }
        }

        /// Drives from light to heavy: the lowest clamped mode is that of the cable, the swivel, or the drive.
        #[test]
        fn cables_with_moving_ends_have_the_stiffness_of_each_by_its_poles(
            shapes in prop::collection::vec((-0.9f64..0.9, 0.99f64..1.3, 4.5f64..6.0), 1..=LANES),
            masses in prop::array::uniform4(-3.0f64..4.0), held in 0usize..LANES, part in 0.0f64..0.98,
        ) {
            const MASS: f64 = 0.067;
            let cables: Vec<Catenary> = shapes.into_iter().map(cable).collect();
            let end = |i: usize| (i != held).then(|| moving(&cables[i], masses.map(|mass| 10f64.powf(mass))));
            let oracle = |(i, c): (usize, &Catenary)| {
                CatenaryDynamic::with_stations(c, end(i), MASS, 60.0, &[], false, 0).unwrap().0
            };
            let oracles: Vec<CatenaryDynamic> = cables.iter().enumerate().map(oracle).collect();
            let first = |e: &CatenaryDynamic| e.in_plane.poles[0].min(e.out_of_plane.poles[0]);
            let x = part * oracles.iter().map(first).fold(f64::INFINITY, f64::min);
            let spans: Vec<_> = (cables.iter().enumerate())
                .map(|(i, catenary)| CableSpan { catenary, mass_per_length: MASS, end: end(i) })
                .collect();

            for group in &mut CableGroup::groups(&spans).unwrap() {
                let kept = group.kept(x, 30);
                for (lane, i) in group.members().iter().enumerate() {
                    prop_assert!(kept.min_pivot[lane] > 0.0);
                    let theirs = in_axes(&oracles[*i].undamped(x.sqrt()), group.axis(lane));
                    let size = theirs.iter().fold(0.0, |m: f64, k| m.max(k.abs()));
                    let rope = cables[*i].rope();
                    let elastic = rope.axial_stiffness / rope.unstrained_length + 2e5;
                    for (ours, theirs) in at_platform(&kept, lane).into_iter().zip(theirs) {
                        let bound = 1e-8 * size + 1e-12 * elastic;
                        prop_assert!((ours - theirs).abs() < bound, "{ours} for {theirs}, largest {size}");
                    }
                }
            }
        }

        /// Motions of the end that the bubbles follow.
        #[test]
        fn the_mass_of_a_motion_is_minus_the_change_of_stiffness(
            shape in (-0.9f64..0.9, 0.99f64..1.08, 4.5f64..6.0), part in 0.1f64..0.5, n in -1.0f64..1.0,
            e in -1.0f64..1.0,
            masses in prop::option::of(prop::array::uniform4(-3.0f64..3.0)),
        ) {
            const MASS: f64 = 0.067;
            let catenary = cable(shape);
            let end = masses.map(|masses| moving(&catenary, masses.map(|mass| 10f64.powf(mass))));
            let oracle = CatenaryDynamic::with_stations(&catenary, end.clone(), MASS, 20.0, &[], false, 0).unwrap().0;
            let x = part * oracle.in_plane.poles[0].min(oracle.out_of_plane.poles[0]);
            let span = CableSpan { catenary: &catenary, mass_per_length: MASS, end };
            let group = &mut CableGroup::groups(&[span]).unwrap()[0];
            let mut work = |x: f64| {
                let ([nn, en, ee, ..], [oo, ..]) = of(&group.kept(x, 24), 0);
                [nn * n * n + 2.0 * en * n * e + ee * e * e, oo * n * n]
            };
            let step = 1e-3 * x;
            let change = {
                let (more, less) = (work(x + step), work(x - step));
                [0, 1].map(|k| (less[k] - more[k]) / (2.0 * step))
            };
            group.kept(x, 24);
            let lanes = |value: f64| [value; LANES];
            let motion = group.moved([lanes(n), lanes(e), lanes(0.0)], [lanes(n), lanes(0.0)]);
            let mass = group.mass(&motion, &motion).map(|lane| lane[0]);

            for (mass, change) in mass.into_iter().zip(change) {
                prop_assert!((mass - change).abs() < 1e-5 * mass.max(1e-3), "{mass} for {change}");
            }
        }
    }

    #[test]
    fn a_loop_without_tension_is_left_to_others() {
        let rope = Rope { unstrained_length: 8.0, weight_per_length: 0.6, axial_stiffness: 1e5 };
        let slack = Catenary::between(0.0, 6.0, rope).unwrap();
        assert!(CableGroup::groups(&[held(&slack, 0.06)]).is_none());
    }
}

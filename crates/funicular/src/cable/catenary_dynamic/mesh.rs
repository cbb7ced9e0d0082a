//! Cable as a few elements of high polynomial degree, condensed onto its ends.

use super::CatenaryDynamicError;
use super::partition::{Condensed, Functions, Guide, Partition};
use super::stretch::StrainMoments;
use crate::catenary::Catenary;
use crate::math::{Complex, DMat, legendre, order};
use std::f64::consts::SQRT_2;

/// Cable divided into elements, each with its polynomial degree.
pub(super) struct Mesh<'a> {
    catenary: &'a Catenary,
    mass_per_length: f64,
    elements: Vec<Element>,
    /// True if the end of the cable can move: its hat function is then an inner one.
    free_end: bool,
    /// Number of refinements so far.
    pub(super) refined: usize,
}

#[derive(Debug, Clone, Copy)]
struct Element {
    from: f64,
    to: f64,
    degree: usize,
}

/// Gauss rule (ξ, weight), and the slopes d/dξ of hats and bubbles (rows) at its points (columns).
pub(super) struct ElementTable {
    rule: Vec<(f64, f64)>,
    slopes: DMat,
}

impl ElementTable {
    fn new(degree: usize) -> Self {
        // A product of two slopes has degree 2p − 2.
        let rule = legendre::gauss(degree + POINTS_FOR_TANGENT);
        let mut slopes = DMat::zeros(degree + 1, rule.len());
        for (mut column, (xi, _)) in slopes.column_iter_mut().zip(&rule) {
            column[0] = -0.5;
            column[1] = 0.5;
            for (j, p) in legendre::orthonormal(*xi, degree - 1).iter().enumerate().skip(1) {
                column[j + 1] = *p;
            }
        }
        Self { rule, slopes }
    }
}

/// Points of the Gauss rule beyond the degree of an element. Products of two slopes of degree p − 1 need p points; the
/// additional ones are for C, whose coefficients fall by the size of the Bernstein ellipse per degree. The rule is
/// exact up to twice the points, so that eight of them leave 1.5^-16 = 2e-3 of the highest products only, and those
/// with the low modes far less.
const POINTS_FOR_TANGENT: usize = 8;

/// Degree per radian of a wave's phase over an element. A half wave needs π/2 degrees, 0.5 per radian (docs/theory.md,
/// section 9); the rest is margin, fitted to the estimate of the error.
const DEGREE_PER_RADIAN: f64 = 0.53;

/// Degrees per cube root of half the phase: width of the transition after which the error of a resolved wave falls
/// exponentially.
const DEGREES_OF_TRANSITION: f64 = 2.2;

/// Degrees that every element has besides, and the exponent of the decrease that the coefficients of C get: e^-13,
/// whose square, 5e-12, is the error of a frequency. Fitted to the estimate of the error; 6 and 14 were the values
/// before.
const BASE_DEGREE: f64 = 4.0;
const DECREASE_OF_TANGENT: f64 = 13.0;

/// Maximum degree that is asked for: far above `MAX_UNKNOWNS`, so that the error names the number of unknowns, and a
/// number that fits `usize`.
const MAX_DEGREE: f64 = 1e6;

/// Refinement of an element: the inverse fraction of its degree that is added, and the degrees that are added besides.
/// Eight degrees divide the error of a smooth element by at least 1.5^16 = 660.
const REFINED_PART: usize = 6;
const REFINED_DEGREES: usize = 8;

/// Minimum tension of a cable, over its largest: below it the stiffness of a taut string, and with it a vibration, is
/// rounding of the forces at the ends.
const MIN_TENSION: f64 = 1e-9;

/// Number of degrees that the matrices of an element have beyond its own. The response of these additional functions
/// estimates the error of the discretisation.
pub(super) const BEYOND: usize = 2;

/// Points of the Gauss rule of an element beyond its degree.
pub(crate) const POINTS_BEYOND_DEGREE: usize = POINTS_FOR_TANGENT + BEYOND;

/// Degree of an element for a wave of this phase over it and a tangent C whose Bernstein ellipse has this size.
pub(super) fn degree(phase: f64, size: f64) -> usize {
    let waves = DEGREE_PER_RADIAN * phase + DEGREES_OF_TRANSITION * (0.5 * phase).cbrt();
    (waves + BASE_DEGREE + DECREASE_OF_TANGENT / size.ln()).ceil().min(MAX_DEGREE) as usize
}

/// Degree of an element after a refinement.
pub(super) fn refined(degree: usize) -> usize {
    degree + degree / REFINED_PART + REFINED_DEGREES
}

impl<'a> Mesh<'a> {
    /// Mesh for frequencies up to ω = `limit`, with nodes at the arc lengths `cuts`, where the motion has a kink under
    /// a force. With `free_end` the end of the cable can move.
    pub(super) fn new(
        catenary: &'a Catenary,
        mass_per_length: f64,
        limit: f64,
        cuts: &[f64],
        free_end: bool,
    ) -> Result<Self, CatenaryDynamicError> {
        let rope = catenary.rope();
        if !has_tension(catenary) {
            return Err(CatenaryDynamicError::NoTension);
        }

        // Nodes where forces act.
        let mut nodes: Vec<f64> = cuts.iter().copied().filter(|s| *s > 0.0 && *s < rope.unstrained_length).collect();
        nodes.extend([0.0, rope.unstrained_length]);
        order::sort_descending(&mut nodes, |s| *s);
        nodes.dedup();

        // The last interval is taken first, so that the elements are in ascending order.
        let intervals = nodes.windows(2).map(|pair| (pair[1], pair[0])).collect();
        let mut elements = Vec::new();
        for (from, to, size) in smooth_pieces(catenary, intervals) {
            let center = 0.5 * (from + to);

            // Phase of the transverse wave, the slower of the two waves, over the element (Simpson's rule).
            let slowness = |s: f64| {
                let t = catenary.tension_at(s);
                (mass_per_length * (rope.axial_stiffness + t) / (rope.axial_stiffness * t)).sqrt()
            };
            let mean = (slowness(from) + 4.0 * slowness(center) + slowness(to)) / 6.0;
            let phase = limit * mean * (to - from);

            // Degree for the waves, and for the variation of C along the element.
            elements.push(Element { from, to, degree: degree(phase, size) });
        }
        Ok(Self { catenary, mass_per_length, elements, free_end, refined: 0 })
    }

    pub(super) fn refine(&mut self) {
        self.refined += 1;
        for element in &mut self.elements {
            element.degree = refined(element.degree);
        }
    }

    /// Quadrature and slopes of each element; all components share them.
    pub(super) fn tables(&self) -> Vec<ElementTable> {
        self.elements.iter().map(|element| ElementTable::new(element.degree + BEYOND)).collect()
    }

    /// Arc lengths of the points of all rules, element by element.
    pub(super) fn points(&self, tables: &[ElementTable]) -> Vec<f64> {
        let of_element = |(element, table): (&Element, &ElementTable)| {
            let (center, half) = (0.5 * (element.from + element.to), 0.5 * (element.to - element.from));
            table.rule.iter().map(|(xi, _)| center + half * xi).collect::<Vec<_>>()
        };
        self.elements.iter().zip(tables).flat_map(of_element).collect()
    }

    /// Polynomial degree of each element.
    pub(super) fn degrees(&self) -> Vec<usize> {
        self.elements.iter().map(|e| e.degree).collect()
    }

    /// Number of inner unknowns with this number of components per function.
    pub(super) fn unknowns(&self, components: usize) -> usize {
        components * self.inner_functions(self.free_end)
    }

    /// C at arc length s [N]: its entries in plane (hh, hv, vv) and the one out of plane.
    fn tangent_at(&self, s: f64) -> ([f64; 3], f64) {
        let rope = self.catenary.rope();
        let h = self.catenary.horizontal_force();
        let v = self.catenary.vertical_force_at_start() + rope.weight_per_length * s;
        let tension = h.hypot(v);
        let ea = rope.axial_stiffness;
        let transverse = ea * tension / (ea + tension);
        let (c, s) = (h / tension, v / tension);
        let extra = ea - transverse;
        ([transverse + extra * c * c, extra * c * s, transverse + extra * s * s], transverse)
    }

    /// Condenses D components per point onto the two ends (N = 2D), whose static stiffness is `still`, and finds the
    /// displacements of the points at the arc lengths `stations`. The first `moments` moments of the strain follow as
    /// stations of their own. An `end` that can move is part of the inside, with the motions behind it; their
    /// displacements are the last.
    pub(super) fn condense<const D: usize, const N: usize, const E: usize>(
        &self,
        tables: &[ElementTable],
        still: [[f64; N]; N],
        end: Option<&Guide<D>>,
        limit: f64,
        stations: &[f64],
        moments: usize,
    ) -> Result<Condensed<D, N, E>, CatenaryDynamicError> {
        let behind = moments + end.map_or(0, |end| end.stiffness.nrows());
        let mut partition = self.assemble::<D, N>(tables, stations, end.is_some(), behind);
        if moments > 0 {
            self.add_moments(&mut partition, tables, stations.len(), (moments, end.is_some()));
        }
        if let Some(end) = end {
            partition.guide(self.elements.len() - 1, end, stations.len() + moments);
        }
        partition.reduce(still, limit)
    }

    /// Adds moments of the strain t·p′ as stations from the number `first` on; `moves` as in
    /// [`assemble`](Self::assemble).
    fn add_moments<const D: usize, const N: usize>(
        &self,
        partition: &mut Partition<D, N>,
        tables: &[ElementTable],
        first: usize,
        (moments, moves): (usize, bool),
    ) {
        for (e, (element, table)) in self.elements.iter().zip(tables).enumerate() {
            let functions = self.functions_of(e, moves);
            let mut rows = vec![vec![[0.0; 2]; table.slopes.nrows()]; moments];
            for (q, (_, weight, direction, weights)) in self.strain_weights(element, table, moments).enumerate() {
                for (row, by_strain) in rows.iter_mut().zip(weights) {
                    for (entry, slope) in row.iter_mut().zip(table.slopes.column(q).iter()) {
                        // The slopes are by ξ: their arc length cancels that of the integral.
                        (0..2).for_each(|d| entry[d] += weight * by_strain * direction[d] * slope);
                    }
                }
            }
            for (j, row) in rows.iter().enumerate() {
                partition.add_motion(&functions, first + j, row);
            }
        }
    }

    /// Points of the rule of an element: ξ, weight, direction of the cable in plane, and the weight of the strain there
    /// in each moment, √2 times the orthonormal Legendre polynomials of the whole arc length.
    fn strain_weights<'t>(
        &'t self,
        element: &Element,
        table: &'t ElementTable,
        moments: usize,
    ) -> impl Iterator<Item = (f64, f64, [f64; 2], Vec<f64>)> + 't {
        let Element { from, to, .. } = *element;
        table.rule.iter().map(move |(xi, weight)| {
            let s = 0.5 * (from + to) + 0.5 * (to - from) * xi;
            let x = 2.0 * s / self.catenary.rope().unstrained_length - 1.0;
            let weights = legendre::orthonormal(x, moments - 1).iter().map(|p| SQRT_2 * p).collect();
            (*xi, *weight, self.direction_at(s), weights)
        })
    }

    /// First moments of the strain at rest.
    pub(super) fn moments(&self, tables: &[ElementTable], count: usize) -> StrainMoments {
        if count == 0 {
            return StrainMoments::none();
        }
        let rope = self.catenary.rope();
        let mut by_force = vec![[0.0; 2]; count];
        for (element, table) in self.elements.iter().zip(tables) {
            let per_force = 0.5 * (element.to - element.from) / rope.axial_stiffness;
            for (_, weight, direction, weights) in self.strain_weights(element, table, count) {
                for (sum, by_strain) in by_force.iter_mut().zip(weights) {
                    (0..2).for_each(|d| sum[d] += per_force * weight * by_strain * direction[d]);
                }
            }
        }
        StrainMoments { by_force, stiffness: vec![rope.axial_stiffness / rope.unstrained_length; count] }
    }

    /// Direction of the cable in plane at arc length s, a unit vector.
    fn direction_at(&self, s: f64) -> [f64; 2] {
        let h = self.catenary.horizontal_force();
        let v = self.catenary.vertical_force_at_start() + self.catenary.rope().weight_per_length * s;
        let tension = h.hypot(v);
        [h / tension, v / tension]
    }

    /// Stiffness and mass of all functions, assembled element by element in the blocks of a [`Partition`]. There is
    /// room for `behind` further stations.
    fn assemble<const D: usize, const N: usize>(
        &self,
        tables: &[ElementTable],
        stations: &[f64],
        moves: bool,
        behind: usize,
    ) -> Partition<D, N> {
        let inner = self.inner_functions(moves);
        let mut partition = Partition::new(inner, BEYOND * self.elements.len(), stations.len() + behind);

        for (e, (element, table)) in self.elements.iter().zip(tables).enumerate() {
            let functions = self.functions_of(e, moves);

            let (stiffness, mass) = self.element_matrices::<D>(element, table);
            partition.add_inner(&functions, &stiffness, &mass);
            partition.add_columns(&functions, &stiffness, &mass);
            partition.add_end_mass(&functions, &mass);
            partition.set_beyond(&functions, &stiffness, &mass);

            for (station, s) in stations.iter().enumerate().filter(|(_, s)| self.holds(e, **s)) {
                partition.set_station(&functions, station, &element.values_at(*s));
            }
        }

        partition
    }

    /// Number of inner functions; their order is nodes between elements, the end if it moves, then bubbles.
    fn inner_functions(&self, moves: bool) -> usize {
        self.elements.iter().map(|e| e.degree).sum::<usize>() - usize::from(!moves)
    }

    /// Indices of the functions of element `e` in the [`Partition`].
    fn functions_of(&self, e: usize, moves: bool) -> Functions {
        let last = self.elements.len() - 1;
        let degree = self.elements[e].degree;
        let nodes = last + usize::from(moves);
        let first_bubble = nodes + self.elements[..e].iter().map(|before| before.degree - 1).sum::<usize>();

        // Hats: those of nodes between elements are inner functions, the others belong to the ends of the cable.
        let (mut inner, mut ends) = (Vec::with_capacity(degree + 1), Vec::new());
        match e {
            0 => ends.push((0, 0)),
            _ => inner.push((0, e - 1)),
        }
        if e == last {
            ends.push((1, 1));
        }
        // The motions at an end that moves are relative to what carries it, whose motion is that of the end function.
        if e < last || moves {
            inner.push((1, e));
        }

        // Bubbles up to the degree, and those beyond it.
        inner.extend((0..degree - 1).map(|k| (2 + k, first_bubble + k)));
        let beyond = (0..BEYOND).map(|k| (degree + 1 + k, BEYOND * e + k)).collect();

        Functions { inner, ends, beyond }
    }

    /// True if a station lies on element `e`; a station between two elements lies on the first of them.
    fn holds(&self, e: usize, s: f64) -> bool {
        let Element { from, to, .. } = self.elements[e];
        (s > from || e == 0) && (s <= to || e + 1 == self.elements.len())
    }

    /// Stiffness per entry of C (hh, hv, vv; one out of plane; or all four) and mass of an element over its hats and
    /// bubbles, [`BEYOND`] included.
    fn element_matrices<const D: usize>(&self, element: &Element, table: &ElementTable) -> (Vec<DMat>, DMat) {
        let half = 0.5 * (element.to - element.from);
        let middle = 0.5 * (element.to + element.from);
        let ElementTable { rule, slopes } = table;

        // C at the points of the rule: its entries in plane, and the one out of plane.
        let entries = if D == 1 { 3..4 } else { 0..D + 1 };
        let mut weights = vec![vec![0.0; rule.len()]; entries.len()];
        for (q, (xi, weight)) in rule.iter().enumerate() {
            let ([hh, hv, vv], out_of_plane) = self.tangent_at(middle + half * xi);
            for (entry, weights) in [hh, hv, vv, out_of_plane][entries.clone()].iter().zip(&mut weights) {
                weights[q] = weight / half * entry;
            }
        }

        // Weighted products of slopes.
        let stiffness = weights
            .iter()
            .map(|weights| {
                let mut weighted = slopes.clone();
                for (mut column, w) in weighted.column_iter_mut().zip(weights) {
                    column *= *w;
                }
                weighted * slopes.transpose()
            })
            .collect();

        (stiffness, legendre::element_mass(element.degree + BEYOND) * (half * self.mass_per_length))
    }
}

impl Element {
    /// Values of hats and bubbles at arc length s.
    fn values_at(&self, s: f64) -> Vec<f64> {
        let xi = (2.0 * s - self.from - self.to) / (self.to - self.from);
        let p = legendre::orthonormal(xi, self.degree);
        // Legendre's P_k from the orthonormal polynomials.
        let p = |k: usize| p[k] / (k as f64 + 0.5).sqrt();
        let bubble = |j: usize| (p(j) - p(j - 2)) / (2.0 * (2.0 * j as f64 - 1.0)).sqrt();
        [0.5 * (1.0 - xi), 0.5 * (1.0 + xi)].into_iter().chain((2..=self.degree).map(bubble)).collect()
    }
}

/// Minimum size of the Bernstein ellipse of an element, the sum of its semi-axes: the coefficients of C fall by at
/// least this factor per degree. Nearer to 1 the degree grows without bound; with a larger value cables with little sag
/// would be divided.
const SMOOTH_ENOUGH: f64 = 1.5;

/// Pieces of a cable on which C is smooth, ascending: ends [m], and the size of the Bernstein ellipse. `intervals` are
/// the parts of the cable to divide, the last one first; a node between two of them stays one.
pub(crate) fn smooth_pieces(catenary: &Catenary, mut intervals: Vec<(f64, f64)>) -> Vec<(f64, f64, f64)> {
    let mut pieces = Vec::new();
    while let Some((from, to)) = intervals.pop() {
        let (center, half) = (0.5 * (from + to), 0.5 * (to - from));
        let size = ellipse(catenary, center, half);
        if size < SMOOTH_ENOUGH {
            intervals.extend([(center, to), (from, center)]);
        } else {
            pieces.push((from, to, size));
        }
    }
    pieces
}

/// True if every point of the cable has tension.
pub(crate) fn has_tension(catenary: &Catenary) -> bool {
    let (h, va) = (catenary.horizontal_force(), catenary.vertical_force_at_start());
    let (start, end) = (catenary.tension_at_start(), catenary.tension_at_end());
    let w = catenary.rope().weight_per_length;
    // The minimum is at the lowest point if the cable has one, otherwise at an end.
    let inside = w != 0.0 && (0.0..=catenary.rope().unstrained_length).contains(&(-va / w));
    let minimum = if inside { h } else { start.min(end) };
    minimum > MIN_TENSION * end.max(start)
}

/// Size of the Bernstein ellipse of the element center ± half [m] through the singularity of C: the sum of its
/// semi-axes over half. The coefficients of C fall like the powers of this size.
pub(crate) fn ellipse(catenary: &Catenary, center: f64, half: f64) -> f64 {
    let w = catenary.rope().weight_per_length;
    if w == 0.0 {
        return f64::INFINITY;
    }
    // T is analytic except at V = ±iH, that is at s = lowest ± i H/w.
    let (lowest, depth) = (-catenary.vertical_force_at_start() / w, catenary.horizontal_force() / w);
    let z = Complex::new((lowest - center) / half, depth / half);
    let root = (z * z - 1.0).sqrt();
    (z + root).norm().max((z - root).norm())
}

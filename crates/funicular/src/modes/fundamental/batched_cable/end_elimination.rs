//! Far ends of cables that can move: the end, and the motions of the drive behind it, are eliminated cable by cable.
//!
//! The first motion in plane is σ, that of the cable along itself at its wheel; it moves the last point of the span
//! along the cable, and the other motions of the chain follow it. Out of plane the end moves with the swivel
//! (docs/theory.md, section 18). Of these motions and the lowest bubble, the one that carries the lowest clamped mode
//! is kept.

use super::element::ElementBatch;
use super::element_integrals::place;
use super::{CableSpan, IN_PLANE, KeptStiffness, OUT_OF_PLANE};
use crate::cable::catenary_dynamic::EndSideways;
use crate::math::DMat;
use crate::math::simd::{LANES, Lane};
use std::f64::consts::PI;

/// Far end of one cable with its drive, and the elimination of their motions at the last frequency.
#[derive(Debug)]
pub(super) struct CableEnd {
    in_plane: EndMotions<2>,
    out_of_plane: EndMotions<1>,
}

/// Motions at the far end of a cable in one family of its functions, with D unknowns per node: in plane or out of
/// plane.
#[derive(Debug)]
pub(super) struct EndMotions<const D: usize> {
    /// Direction in which the first motion moves the end of the span.
    direction: [f64; D],
    /// Number n of motions; 0 if the end is held.
    count: usize,
    /// Stiffness [N/m] and mass [kg] over the motions, n×n.
    stiffness: Vec<f64>,
    mass: Vec<f64>,
    /// Mass per motion that belongs to the drive and not to the cable [kg].
    drive_mass: Vec<f64>,
    /// Places of the inner unknowns in `matrix`: of the bubble, if the cable has one element, then of the motions.
    places: Vec<usize>,
    /// Number of unknowns that are kept; they come first.
    kept: usize,
    /// Lower triangle by rows: kept unknowns, and rows of the eliminated ones with the inverse pivots on the diagonal.
    matrix: Vec<f64>,
}

impl CableEnd {
    /// Far end of a cable whose axis e has these components along the horizontal and up. A cable of one element keeps a
    /// bubble or a motion of its end besides the platform end, a `divided` one keeps neither.
    pub(super) fn new(cable: &CableSpan, [cos, sin]: [f64; 2], divided: bool) -> Self {
        let catenary = cable.catenary;

        // A clamped cable alone: 1/ω² of a taut string.
        let chord = catenary.span().hypot(catenary.rise());
        let string = cable.mass_per_length * (chord / PI).powi(2) / catenary.parallel_tension();

        // The chain along the cable.
        let along = cable.end.as_ref().and_then(|end| end.along.as_ref());
        let in_plane = match along {
            None => EndMotions::held(divided),
            Some(along) => {
                let ([h, v, _], [[hh, hv], [_, vv]]) = (along.direction, catenary.tangent());
                let held = h * h * hh + 2.0 * h * v * hv + v * v * vv;
                let chain = &along.chain;
                let mass = &chain.mass + &chain.cable_mass;
                let kept = slowest(&chain.stiffness, &mass, held).filter(|(_, slowness)| *slowness > string);
                let kept = kept.map(|(motion, _)| motion);
                let direction = [v * cos - h * sin, h * cos + v * sin];
                EndMotions::new(direction, &chain.stiffness, &mass, &chain.mass, divided, kept)
            }
        };

        // The swivel.
        let out_of_plane = match cable.end.as_ref().and_then(|end| end.sideways) {
            None => EndMotions::held(divided),
            Some(EndSideways { stiffness, mass, .. }) => {
                let kept = (mass / (catenary.out_of_plane_stiffness() + stiffness) > string).then_some(0);
                let [stiffness, mass] = [stiffness, mass].map(|entry| DMat::from_element(1, 1, entry));
                EndMotions::new([1.0], &stiffness, &mass, &mass, divided, kept)
            }
        };
        Self { in_plane, out_of_plane }
    }

    /// Number of unknowns in plane and out of plane, those of the near end included.
    fn unknowns(&self) -> usize {
        self.in_plane.unknowns() + self.out_of_plane.unknowns()
    }

    /// Motions in plane and out of plane.
    pub(super) fn families(&self) -> (&EndMotions<2>, &EndMotions<1>) {
        (&self.in_plane, &self.out_of_plane)
    }

    pub(super) fn families_mut(&mut self) -> (&mut EndMotions<2>, &mut EndMotions<1>) {
        (&mut self.in_plane, &mut self.out_of_plane)
    }
}

/// Motion of a chain with the largest part of the sum Σ 1/ω² over its modes, and this sum: the trace of the flexibility
/// times the mass. This motion carries the lowest mode. The cable adds the stiffness `held` [N/m] to the first motion.
/// `None` without mass.
fn slowest(stiffness: &DMat, mass: &DMat, held: f64) -> Option<(usize, f64)> {
    let n = stiffness.nrows();
    if mass.diagonal().amax() == 0.0 {
        return None;
    }

    // Inverse in place (sweep operator); the chain needs no exchanges, because springs hold it.
    let mut a = stiffness.clone();
    a[(0, 0)] += held;
    for k in 0..n {
        let inverse = 1.0 / a[(k, k)];
        for i in (0..n).filter(|i| *i != k) {
            let factor = a[(i, k)] * inverse;
            for j in (0..n).filter(|j| *j != k) {
                let by = a[(k, j)];
                a[(i, j)] -= factor * by;
            }
            a[(i, k)] = -factor;
        }
        for j in (0..n).filter(|j| *j != k) {
            a[(k, j)] *= inverse;
        }
        a[(k, k)] = inverse;
    }

    let slowness = |i: usize| a[(i, i)] * mass[(i, i)];
    let slowest = (0..n).max_by(|i, j| slowness(*i).total_cmp(&slowness(*j)))?;
    Some((slowest, (0..n).map(slowness).sum()))
}

impl<const D: usize> EndMotions<D> {
    /// End that is held.
    fn held(divided: bool) -> Self {
        let none = DMat::zeros(0, 0);
        Self::new([0.0; D], &none, &none, &none, divided, None)
    }

    /// End with the given stiffness and mass over its motions. `kept` is the motion that is kept instead of the bubble.
    fn new(
        direction: [f64; D],
        stiffness: &DMat,
        mass: &DMat,
        drive_mass: &DMat,
        divided: bool,
        kept: Option<usize>,
    ) -> Self {
        let count = stiffness.nrows();
        let (bubbles, kept_inside) = if divided { (0, 0) } else { (1, 1) };

        // The inner unknown that is kept comes first, the others in their order.
        let first = if divided { 0 } else { kept.map_or(0, |motion| 1 + motion) };
        let places: Vec<usize> = (0..bubbles + count)
            .map(|inner| D + if inner == first { 0 } else { inner + usize::from(inner < first) })
            .collect();
        let unknowns = D + places.len();
        Self {
            direction,
            count,
            stiffness: stiffness.as_slice().to_vec(),
            mass: mass.as_slice().to_vec(),
            drive_mass: drive_mass.diagonal().as_slice().to_vec(),
            places,
            kept: D + kept_inside,
            matrix: vec![0.0; place(unknowns, 0)],
        }
    }

    fn unknowns(&self) -> usize {
        D + self.places.len()
    }

    /// Places of the motions.
    fn motions(&self) -> &[usize] {
        &self.places[self.places.len() - self.count..]
    }

    /// Place of the bubble, if there is one.
    fn bubble(&self) -> Option<usize> {
        (self.places.len() > self.count).then(|| self.places[0])
    }

    /// Entry of the condensed stiffness of the unknowns that are kept.
    pub(super) fn at(&self, row: usize, column: usize) -> f64 {
        self.matrix[place(row.max(column), row.min(column))]
    }

    /// Eliminates all unknowns but the kept ones at x = ω². `entry` is the stiffness K − xM of the element: near end,
    /// far end, lowest bubble.
    pub(super) fn condense(&mut self, x: f64, entry: impl Fn(usize, usize) -> f64, min_pivot: &mut f64) {
        let bubble = self.bubble();
        let Self { direction, count, stiffness, mass, places, kept, matrix, .. } = self;
        let motions = &places[places.len() - *count..];
        let unknowns = D + places.len();
        let far = |column: usize| -> f64 { (0..D).map(|d| direction[d] * entry(D + d, column)).sum() };
        let at = |a: usize, b: usize| place(a.max(b), a.min(b));

        // Near end and bubble.
        matrix.fill(0.0);
        for row in 0..D {
            for column in 0..=row {
                matrix[place(row, column)] = entry(row, column);
            }
        }
        if let Some(bubble) = bubble {
            for column in 0..D {
                matrix[place(bubble, column)] = entry(2 * D, column);
            }
            matrix[place(bubble, bubble)] = entry(2 * D, 2 * D);
        }

        // Far end, which follows the first motion, and the chain.
        if let Some(&sigma) = motions.first() {
            for column in 0..D {
                matrix[place(sigma, column)] = far(column);
            }
            if let Some(bubble) = bubble {
                matrix[at(sigma, bubble)] = far(2 * D);
            }
            matrix[place(sigma, sigma)] = (0..D).map(|d| direction[d] * far(D + d)).sum();
        }
        for (i, a) in motions.iter().enumerate() {
            for (j, b) in motions[..=i].iter().enumerate() {
                matrix[at(*a, *b)] += stiffness[i * *count + j] - x * mass[i * *count + j];
            }
        }

        // Elimination from the last unknown down.
        for t in (*kept..unknowns).rev() {
            let (above, row) = matrix.split_at_mut(place(t, 0));
            let pivot = row[t];
            *min_pivot = if pivot < *min_pivot { pivot } else { *min_pivot };
            let inverse = 1.0 / pivot;
            for i in 0..t {
                let factor = row[i] * inverse;
                for j in 0..=i {
                    above[place(i, j)] -= factor * row[j];
                }
            }
            row[t] = inverse;
        }
    }

    /// Appends the motion of all unknowns, which follows that of the `kept` ones.
    fn follow(&self, kept: &[f64], into: &mut Vec<f64>) {
        let start = into.len();
        into.extend_from_slice(kept);
        for t in self.kept..self.unknowns() {
            let row = &self.matrix[place(t, 0)..=place(t, t)];
            let sum: f64 = row[..t].iter().zip(&into[start..]).map(|(entry, value)| entry * value).sum();
            into.push(-sum * row[t]);
        }
    }

    /// Motion of the end of the span.
    fn far_end(&self, unknowns: &[f64]) -> [f64; D] {
        let sigma = self.motions().first().map_or(0.0, |place| unknowns[*place]);
        self.direction.map(|component| component * sigma)
    }

    /// Product `aᵀ M b` of the motions.
    fn mass(&self, a: &[f64], b: &[f64]) -> f64 {
        let motions = self.motions().iter().enumerate();
        let rows = motions.map(|(i, row)| {
            let row_mass = &self.mass[i * self.count..(i + 1) * self.count];
            let along: f64 = row_mass.iter().zip(self.motions()).map(|(mass, column)| mass * b[*column]).sum();
            a[*row] * along
        });
        rows.sum()
    }

    /// Mass of the drive alone in a motion.
    fn drive_mass(&self, unknowns: &[f64]) -> f64 {
        self.drive_mass.iter().zip(self.motions()).map(|(mass, place)| mass * unknowns[*place] * unknowns[*place]).sum()
    }
}

/// Stiffness of the kept unknowns of cables of one element, condensed onto its ends and its lowest bubble.
pub(super) fn condense(ends: &mut [CableEnd], element: &ElementBatch, x: f64, min_pivots: &Lane) -> KeptStiffness {
    let mut kept = KeptStiffness::default();
    // In lanes without a cable the pivots must not be zero.
    (kept.in_plane[5], kept.out_of_plane[2]) = ([1.0; LANES], [1.0; LANES]);
    for (lane, end) in ends.iter_mut().enumerate() {
        let at = |row: usize, column: usize| place(row.max(column), row.min(column));
        let mut min_pivot = min_pivots[lane];
        end.in_plane.condense(x, |row, column| element.in_plane_factor[at(row, column)][lane], &mut min_pivot);
        end.out_of_plane.condense(x, |row, column| element.out_of_plane_factor[at(row, column)][lane], &mut min_pivot);

        for (into, entry) in kept.in_plane.iter_mut().zip(&end.in_plane.matrix) {
            into[lane] = *entry;
        }
        for (into, entry) in kept.out_of_plane.iter_mut().zip(&end.out_of_plane.matrix) {
            into[lane] = *entry;
        }
        kept.min_pivot[lane] = min_pivot;
    }
    kept
}

/// Motion of the near end, the far end and the lowest bubble of cables of one element, in plane and out of plane, which
/// follow the kept unknowns; and the motion of all unknowns at the ends.
pub(super) fn follow(
    ends: &[CableEnd],
    in_plane: &[Lane; IN_PLANE],
    out_of_plane: &[Lane; OUT_OF_PLANE],
) -> ([Lane; 5], [Lane; 3], Vec<f64>) {
    let (mut all_in_plane, mut all_out_of_plane) = ([[0.0; LANES]; 5], [[0.0; LANES]; 3]);
    let mut unknowns = Vec::with_capacity(ends.iter().map(CableEnd::unknowns).sum());
    for (lane, end) in ends.iter().enumerate() {
        let (plane, out) = (&end.in_plane, &end.out_of_plane);
        let start = unknowns.len();
        plane.follow(&in_plane.map(|values| values[lane]), &mut unknowns);
        let all = &unknowns[start..];
        let [n, e] = plane.far_end(all);
        let values = [all[0], all[1], n, e, plane.bubble().map_or(0.0, |place| all[place])];
        for (lanes, value) in all_in_plane.iter_mut().zip(values) {
            lanes[lane] = value;
        }

        let start = unknowns.len();
        out.follow(&out_of_plane.map(|values| values[lane]), &mut unknowns);
        let all = &unknowns[start..];
        let [b] = out.far_end(all);
        let values = [all[0], b, out.bubble().map_or(0.0, |place| all[place])];
        for (lanes, value) in all_out_of_plane.iter_mut().zip(values) {
            lanes[lane] = value;
        }
    }
    (all_in_plane, all_out_of_plane, unknowns)
}

impl CableEnd {
    /// Appends the motion of all unknowns at the end, which follows that of the last node of a divided cable. The
    /// result is the motion of the end of the span.
    pub(super) fn follow_node(&self, in_plane: [f64; 2], out_of_plane: [f64; 1], into: &mut Vec<f64>) -> [f64; 3] {
        let start = into.len();
        self.in_plane.follow(&in_plane, into);
        let [n, e] = self.in_plane.far_end(&into[start..]);
        let start = into.len();
        self.out_of_plane.follow(&out_of_plane, into);
        let [b] = self.out_of_plane.far_end(&into[start..]);
        [n, e, b]
    }
}

/// Adds the products `aᵀ M b` of the motions at the ends to those of the cables, in plane and out of plane.
pub(super) fn add_mass(ends: &[CableEnd], a: &[f64], b: &[f64], masses: &mut [Lane; 2]) {
    let mut start = 0;
    for (lane, end) in ends.iter().enumerate() {
        let middle = start + end.in_plane.unknowns();
        let next = middle + end.out_of_plane.unknowns();
        masses[0][lane] += end.in_plane.mass(&a[start..middle], &b[start..middle]);
        masses[1][lane] += end.out_of_plane.mass(&a[middle..next], &b[middle..next]);
        start = next;
    }
}

/// Mass of the drive of each cable in a motion of the unknowns at the ends.
pub(super) fn drive_mass(ends: &[CableEnd], unknowns: &[f64]) -> Lane {
    let mut masses = [0.0; LANES];
    let mut start = 0;
    for (mass, end) in masses.iter_mut().zip(ends) {
        let middle = start + end.in_plane.unknowns();
        let next = middle + end.out_of_plane.unknowns();
        *mass =
            end.in_plane.drive_mass(&unknowns[start..middle]) + end.out_of_plane.drive_mass(&unknowns[middle..next]);
        start = next;
    }
    masses
}

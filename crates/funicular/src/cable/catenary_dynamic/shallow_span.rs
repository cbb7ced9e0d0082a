//! Shallow sagging span whose far end moves with a pulley and the drive behind it, by poles and residues.
//!
//! The span is the cable of Starossek with both of its ends free to move: transverse motion v(s) and b(s) of a string
//! along the chord, and one increment of the chordwise tension, which is the elongation times EA/L_e. The elongation is
//! linear in the motions, so that sag is a stiffness of rank one (docs/theory.md, equations (21), (86) and (87)). The
//! closed form of [`ShallowDynamic`](crate::cable::shallow_dynamic::ShallowDynamic) holds the far end. With the motions
//! of a drive as further inner unknowns the poles are no longer those of a formula. So the span is discretised by
//! polynomials, exactly as a catenary-dynamic cable is, and counts, modes, losses and signals are those of such a
//! cable.

use super::mesh::{self, BEYOND};
use super::moving_end::{MovingEnd, StaticEnds};
use super::partition::{Blocks, Condensed, Guide, MotionRow, Partition};
use super::stretch::StrainMoments;
use super::{CatenaryDynamic, CatenaryDynamicError, Families, MAX_REFINEMENTS, MAX_UNKNOWNS, WANTED_ERROR};
use crate::cable::{Sag, shallow_static};
use crate::math::{DMat, DVec, legendre};
use std::ops::Range;

/// Span condensed onto its ends, for frequencies up to ω = `limit` [rad/s]. `end` is its far end, in the axes of the
/// chord; `None` for one that is held. With `has_strains` its elongation
/// is one more motion.
///
/// # Errors
/// [`CatenaryDynamicError`].
pub(super) fn condensed(
    sag: &Sag,
    end: Option<MovingEnd>,
    limit: f64,
    has_strains: bool,
) -> Result<CatenaryDynamic, CatenaryDynamicError> {
    let held = MovingEnd { along: None, sideways: None };
    let moves = end.as_ref().unwrap_or(&held);
    let phase = limit * sag.chord * (sag.mass_per_length / sag.tension).sqrt();
    let mut span = ShallowSpan { sag, degree: mesh::degree(phase, f64::INFINITY), has_strains };

    for refinements in 0.. {
        let unknowns = span.degree + moves.counts().1;
        if unknowns > MAX_UNKNOWNS {
            return Err(CatenaryDynamicError::ShallowTooFine { unknowns, limit: MAX_UNKNOWNS });
        }
        let found = if moves.couples() { span.together(moves, limit)? } else { span.apart(moves, limit)? };
        if found.error <= WANTED_ERROR || refinements == MAX_REFINEMENTS {
            return Ok(found.split(end, limit, vec![span.degree]).0);
        }
        span.degree = mesh::refined(span.degree);
    }
    unreachable!("the last refinement is accepted")
}

/// Span as one element.
struct ShallowSpan<'a> {
    sag: &'a Sag,
    degree: usize,
    has_strains: bool,
}

/// Components of the motion of a family with `count` components: out of plane alone, along the chord and normal to it,
/// or all three. Those in the range are transverse; before them is that along the chord.
fn transverse(count: usize) -> Range<usize> {
    count.min(2) - 1..count
}

impl ShallowSpan<'_> {
    /// Static stiffness of the platform end with the far end held: in plane, and out of plane.
    fn held(&self) -> ([[f64; 2]; 2], f64) {
        let still = shallow_static::stiffness(self.sag);
        ([[still.axial, still.coupling], [still.coupling, still.normal]], still.out_of_plane)
    }

    /// Motions in plane and out of plane for themselves.
    fn apart(&self, end: &MovingEnd, limit: f64) -> Result<Families, CatenaryDynamicError> {
        let (held, held_out_of_plane) = self.held();
        let StaticEnds { in_plane, out_of_plane, flexibility } = end.static_stiffness(held, held_out_of_plane)?;

        let in_plane = self.condense(end.guide_in_plane().as_ref(), in_plane, limit)?;
        let out_of_plane = self.condense(end.guide_out_of_plane().as_ref(), out_of_plane, limit)?;
        let error = in_plane.error.max(out_of_plane.error);
        let strain = self.strain();
        let flexibility = strain.flexibility(flexibility, Some(end), held);
        let (arc_lengths, stretch) = (Vec::new(), strain.motions(Some(end)));
        Ok(Families { in_plane, out_of_plane, coupled: None, flexibility, error, arc_lengths, stretch })
    }

    /// Motions in plane and out of plane, which the end couples.
    fn together(&self, end: &MovingEnd, limit: f64) -> Result<Families, CatenaryDynamicError> {
        let (held, held_out_of_plane) = self.held();
        let (ends, flexibility) = end.static_stiffness_coupled(held, held_out_of_plane)?;
        let coupled = self.condense(Some(&end.guide()), ends, limit)?;
        let error = coupled.error;
        let strain = self.strain();
        let flexibility = strain.flexibility(flexibility, Some(end), held);
        Ok(Families {
            in_plane: Condensed::none(),
            out_of_plane: Condensed::none(),
            coupled: Some(coupled),
            flexibility,
            error,
            arc_lengths: Vec::new(),
            stretch: strain.motions(Some(end)),
        })
    }

    /// Strain of the span, whose only moment is its elongation; none without loss.
    fn strain(&self) -> StrainMoments {
        if !self.has_strains {
            return StrainMoments::none();
        }
        let stiffness = self.sag.axial_stiffness / self.sag.effective_length;
        StrainMoments { by_force: vec![[1.0 / stiffness, 0.0]], stiffness: vec![stiffness] }
    }

    /// Elongation of the chord and of the first bubble, the only function whose mean the ends do not cancel: places and
    /// factors. None out of plane.
    fn elongation<const D: usize>(&self) -> Vec<(usize, f64)> {
        if D == 1 {
            return Vec::new();
        }
        vec![
            (self.place::<D>(0, 0), -1.0),
            (self.place::<D>(0, 1), 1.0),
            (self.place::<D>(1, 2), self.sag.epsilon / 6f64.sqrt()),
        ]
    }

    /// Place of a function of a component: the platform end, the far end, then the bubbles.
    fn place<const D: usize>(&self, component: usize, function: usize) -> usize {
        match function {
            0 | 1 => function * D + component,
            bubble => 2 * D + (component - transverse(D).start) * self.bubbles() + bubble - 2,
        }
    }

    /// Number of bubbles per transverse component, with those beyond the degree.
    fn bubbles(&self) -> usize {
        self.degree - 1 + BEYOND
    }

    /// Stiffness and mass of the span over the D components of the platform end, those of the far end, and the bubbles
    /// of each transverse component.
    ///
    /// # References
    /// docs/theory.md, equation (87).
    fn matrices<const D: usize>(&self) -> [DMat; 2] {
        let Sag { chord, tension, axial_stiffness, mass_per_length, effective_length, .. } = *self.sag;
        let (bubbles, half) = (self.bubbles(), 0.5 * chord);
        let count = 2 * D + transverse(D).len() * bubbles;

        // Strings: the slopes of the bubbles are orthonormal, and orthogonal to those of the hats.
        let (mut stiffness, mut mass) = (DMat::zeros(count, count), DMat::zeros(count, count));
        let of_element = legendre::element_mass(self.degree + BEYOND) * (half * mass_per_length);
        for component in transverse(D) {
            let at = |function: usize| self.place::<D>(component, function);
            for (i, j, sign) in [(0, 0, 1.0), (0, 1, -1.0), (1, 0, -1.0), (1, 1, 1.0)] {
                stiffness[(at(i), at(j))] = sign * tension / chord;
            }
            for bubble in 2..bubbles + 2 {
                stiffness[(at(bubble), at(bubble))] = tension / half;
            }
            for i in 0..bubbles + 2 {
                for j in 0..bubbles + 2 {
                    mass[(at(i), at(j))] = of_element[(i, j)];
                }
            }
        }

        // Sag.
        let elongation = self.elongation::<D>();
        for (i, a) in &elongation {
            for (j, b) in &elongation {
                stiffness[(*i, *j)] += axial_stiffness / effective_length * a * b;
            }
        }
        [stiffness, mass]
    }

    /// Condenses D components per point onto the two ends (N = 2D), whose static stiffness is `still`. The motions of a
    /// `guide` move the far end; they are inner unknowns, whose displacements are stations.
    fn condense<const D: usize, const N: usize, const E: usize>(
        &self,
        guide: Option<&Guide<D>>,
        still: [[f64; N]; N],
        limit: f64,
    ) -> Result<Condensed<D, N, E>, CatenaryDynamicError> {
        let matrices = self.matrices::<D>();
        let (bubbles, total) = (self.bubbles(), matrices[0].nrows());
        let beyond = |bubble: usize| bubble % bubbles >= self.degree - 1;
        let (inner, outer): (Vec<usize>, Vec<usize>) = (N..total).partition(|place| !beyond(place - N));
        let outer: Vec<usize> = (0..N).chain(outer).collect();

        // Every inner unknown as motions of the span: its bubbles, then the motions of the guide, which move the far
        // end.
        let motions = guide.map_or(0, |guide| guide.stiffness.nrows());
        let unknowns = inner.len() + motions;
        let mut of_span = DMat::zeros(total, unknowns);
        for (unknown, place) in inner.iter().enumerate() {
            of_span[(*place, unknown)] = 1.0;
        }
        for (motion, direction) in guide.iter().flat_map(|guide| &guide.directions) {
            for (component, part) in direction.iter().enumerate() {
                of_span[(D + component, inner.len() + motion)] = *part;
            }
        }

        let mut square = matrices.each_ref().map(|matrix| of_span.tr_mul(&(matrix * &of_span)));
        if let Some(Guide { stiffness, mass, .. }) = guide {
            for (square, added) in square.iter_mut().zip([stiffness, mass]) {
                let mut corner = square.view_mut((inner.len(), inner.len()), (motions, motions));
                corner += added;
            }
        }
        // Its elongation, and the motions of the guide.
        let elongation = DVec::from_fn(total, |place, _| {
            self.elongation::<D>().iter().filter(|(at, _)| *at == place).map(|(_, factor)| factor).sum()
        });
        let stretched = (self.has_strains && D > 1).then(|| MotionRow {
            inner: of_span.tr_mul(&elongation).iter().copied().enumerate().filter(|(_, entry)| *entry != 0.0).collect(),
            ends: elongation.as_slice()[..N].to_vec(),
        });
        let of_guide = (inner.len()..unknowns).map(|at| MotionRow { inner: vec![(at, 1.0)], ends: vec![0.0; N] });
        let stations = stretched.into_iter().chain(of_guide).collect();

        let blocks = Blocks {
            inner: square,
            to_outer: matrices.each_ref().map(|matrix| of_span.tr_mul(&matrix.select_columns(&outer))),
            end_mass: matrices[1].view((0, 0), (N, N)).into_owned(),
            beyond: outer[N..]
                .iter()
                .map(|&place| (matrices[0][(place, place)], matrices[1][(place, place)]))
                .collect(),
            stations,
        };
        Partition::of(&blocks).reduce(still, limit)
    }
}

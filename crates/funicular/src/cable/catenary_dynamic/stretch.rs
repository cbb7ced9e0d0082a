//! Loss of the stretch of a rope: motions in which it stretches, on which the loss acts.
//!
//! Only the increment of the tension along the cable is lossy. Its strain t·p′ is expanded in Legendre polynomials of
//! the arc length; in slow motion it is almost uniform, so that a few moments have all of its energy. Each moment is a
//! motion of the cable beside those of its drive, without mass. The loss acts on it as the stiffness (h − 1) k of
//! equation (81), and the elongations of a drum side follow (docs/theory.md, equations (27a) to (27e)).

use super::Displacements;
use super::moving_end::MovingEnd;
use crate::catenary::Rope;
use crate::drive::ChainStretch;
use crate::math::{DMat, RowVec3};

/// Motions in which a cable with loss stretches. They stand between the motions of its drive along the cable and that
/// sideways.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StretchMotions {
    /// Number of moments of the strain of the free span.
    pub moments: usize,
    /// Stiffness of each motion [N/m]: of the moments, then of the elongations of the drum side.
    pub stiffness: Vec<f64>,
}

impl StretchMotions {
    /// Brings the motions of a family, with the moments first, into their order: chain, moments, elongations of the
    /// drum side, and that sideways if the family has it.
    pub(super) fn put_in_order<const D: usize, const N: usize>(
        &self,
        motions: &mut Displacements<D, N>,
        end: Option<&MovingEnd>,
    ) {
        if self.moments == 0 {
            return;
        }
        let (chain, _) = end.map_or((0, 0), MovingEnd::counts);
        let mut of_end = motions.split_off(self.moments);
        let of_drum_side = of_end.sums(&sums_of_chain(end));
        of_end.insert(chain, motions);
        of_end.insert(chain + self.moments, &of_drum_side);
        *motions = of_end;
    }
}

/// Moments of the strain of a free span in slow motion. With three, the loss of the stiffness is wrong by 3e-6 for FAST
/// at 0.45 Hz and by 3e-7 for the cables of Yuan 2014; with six, by 1e-7 and 5e-9.
const BASE_MOMENTS: f64 = 6.0;

/// Moments per radian of the phase of an axial wave over the span: those of a drum side with mass.
const MOMENTS_PER_RADIAN: f64 = 0.7;

/// Number of moments of the strain of a free span with this mass per length [kg/m] up to ω = `limit` [rad/s].
pub(super) fn moments(rope: &Rope, mass_per_length: f64, limit: f64) -> usize {
    let phase = limit * rope.unstrained_length * (mass_per_length / rope.axial_stiffness).sqrt();
    (BASE_MOMENTS + MOMENTS_PER_RADIAN * phase).ceil() as usize
}

/// Moments of the strain of a free span at rest.
pub(super) struct StrainMoments {
    /// Moments of the strain by a constant change of the tension vector in plane, over EA [m/N].
    pub(super) by_force: Vec<[f64; 2]>,
    /// Stiffness of each moment [N/m].
    pub(super) stiffness: Vec<f64>,
}

impl StrainMoments {
    /// No moments, for a rope without loss.
    pub(super) fn none() -> Self {
        Self { by_force: Vec::new(), stiffness: Vec::new() }
    }

    /// Number of moments.
    pub(super) fn count(&self) -> usize {
        self.stiffness.len()
    }

    /// Stiffness of all motions in which a cable with this end stretches.
    pub(super) fn motions(&self, end: Option<&MovingEnd>) -> StretchMotions {
        if self.stiffness.is_empty() {
            return StretchMotions::default();
        }
        let of_drum_side = stretches(end).iter().map(|motion| motion.stiffness);
        let stiffness = self.stiffness.iter().copied().chain(of_drum_side).collect();
        StretchMotions { moments: self.count(), stiffness }
    }

    /// Motions of the chain, the stretches, and the motion sideways by the motions of the end alone, the platform end
    /// held. `held` is the stiffness of the span with both ends held, in plane.
    fn by_end(&self, end: Option<&MovingEnd>, held: [[f64; 2]; 2]) -> DMat {
        let (chain, all) = end.map_or((0, 0), MovingEnd::counts);
        let pieces = stretches(end);
        let first_piece = chain + self.count();
        let sideways = first_piece + pieces.len();

        let mut rows = DMat::zeros(sideways + all - chain, all);
        for motion in 0..all {
            rows[(if motion < chain { motion } else { sideways + motion - chain }, motion)] = 1.0;
        }
        for (i, piece) in pieces.iter().enumerate() {
            piece.parts.iter().for_each(|part| rows[(first_piece + i, part.motion)] += part.factor);
        }
        for (motion, [h, v, _]) in end.map_or_else(Vec::new, |end| end.guide().directions) {
            for (j, of) in self.by_force.iter().enumerate() {
                let [pull_h, pull_v] = pulled(held, *of);
                rows[(chain + j, motion)] = pull_h * h + pull_v * v;
            }
        }
        rows
    }

    /// Static response of all motions at the end to forces on them, the platform end held: those of the chain, the
    /// stretches, and that sideways. `of_end` is that of the motions of the end alone, `held` the stiffness of the span
    /// with both ends held, in plane.
    ///
    /// # References
    /// docs/theory.md, equation (27d).
    pub(super) fn flexibility(&self, of_end: DMat, end: Option<&MovingEnd>, held: [[f64; 2]; 2]) -> DMat {
        if self.stiffness.is_empty() {
            return of_end;
        }
        let rows = self.by_end(end, held);
        let mut total = &rows * of_end * rows.transpose();

        // The span by forces on its own moments.
        let (chain, _) = end.map_or((0, 0), MovingEnd::counts);
        for (i, of) in self.by_force.iter().enumerate() {
            for (j, other) in self.by_force.iter().enumerate() {
                let (own, pull) = (if i == j { 1.0 / self.stiffness[i] } else { 0.0 }, pulled(held, *other));
                total[(chain + i, chain + j)] += own - of[0] * pull[0] - of[1] * pull[1];
            }
        }
        total
    }

    /// Slow motions at the end by the platform end (horizontal, up, out of plane), in the order of
    /// [`flexibility`](Self::flexibility); `held` with its stiffness out of plane.
    pub(super) fn by_start(
        &self,
        of_end: &DMat,
        end: Option<&MovingEnd>,
        (held, out_of_plane): ([[f64; 2]; 2], f64),
    ) -> Vec<[f64; 3]> {
        let (chain, all) = end.map_or((0, 0), MovingEnd::counts);
        let mut forces = DMat::zeros(all, 3);
        for (motion, [h, v, b]) in end.map_or_else(Vec::new, |end| end.guide().directions) {
            let [pull_h, pull_v] = pulled(held, [h, v]);
            forces.set_row(motion, &RowVec3::new(pull_h, pull_v, out_of_plane * b));
        }
        let mut moved = self.by_end(end, held) * of_end * forces;
        for (j, of) in self.by_force.iter().enumerate() {
            let pull = pulled(held, *of);
            (0..2).for_each(|k| moved[(chain + j, k)] -= pull[k]);
        }
        moved.row_iter().map(|row| [row[0], row[1], row[2]]).collect()
    }
}

/// Product of the stiffness of a span in plane with a vector.
fn pulled(held: [[f64; 2]; 2], [h, v]: [f64; 2]) -> [f64; 2] {
    held.map(|row| row[0] * h + row[1] * v)
}

/// Motions in which the drum side behind an end stretches.
fn stretches(end: Option<&MovingEnd>) -> &[ChainStretch] {
    end.and_then(MovingEnd::chain).map_or(&[], |chain| &chain.stretches)
}

/// The motions in which a drum side stretches, as sums of the motions of its chain.
fn sums_of_chain(end: Option<&MovingEnd>) -> Vec<Vec<(usize, f64)>> {
    stretches(end).iter().map(|motion| motion.parts.iter().map(|part| (part.motion, part.factor)).collect()).collect()
}

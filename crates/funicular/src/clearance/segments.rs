//! Nearest points of two segments.
//!
//! The library takes segments within 4e-8 rad as parallel, whose distance is then wrong by that angle times their
//! length.

use crate::math::Vec3;

/// Nearest points of two segments.
pub(super) struct NearSegments {
    /// Distance [m].
    pub(super) distance: f64,
    /// Place of the nearest point on each segment, from 0 to 1.
    pub(super) fractions: [f64; 2],
    /// Vector from the nearest point of the second to that of the first [m].
    pub(super) apart_w: Vec3,
}

/// Nearest points of two segments, each given by its ends [m]. The squared distance is convex over both places, so it
/// is least between the ends of both or at an end of one.
pub(super) fn nearest(own_w: &[Vec3; 2], others_w: &[Vec3; 2]) -> NearSegments {
    let (own, other) = (own_w[1] - own_w[0], others_w[1] - others_w[0]);
    let between = others_w[0] - own_w[0];
    let squares = [own.norm_squared(), other.norm_squared()];
    let (mixed, along) = (own.dot(&other), [own.dot(&between), other.dot(&between)]);
    let at = |fractions: [f64; 2]| {
        let apart_w = own * fractions[0] - between - other * fractions[1];
        NearSegments { distance: apart_w.norm(), fractions, apart_w }
    };
    // Place of the nearest point of a segment to a point; that of a segment without length is its start.
    let within = |product: f64, square: f64| if square > 0.0 { (product / square).clamp(0.0, 1.0) } else { 0.0 };
    let on_own = |of_other: f64| within(along[0] + of_other * mixed, squares[0]);
    let on_other = |of_own: f64| within(of_own * mixed - along[1], squares[1]);

    // Of nearly parallel segments the common normal is inaccurate, and all places along them are about as near.
    let normal = own.cross(&other);
    let place = between.cross(&other).dot(&normal) / normal.norm_squared();
    let other_place = between.cross(&own).dot(&normal) / normal.norm_squared();
    if (0.0..=1.0).contains(&place) && (0.0..=1.0).contains(&other_place) {
        return at([place, on_other(place)]);
    }

    let [first, others @ ..] =
        [[0.0, on_other(0.0)], [1.0, on_other(1.0)], [on_own(0.0), 0.0], [on_own(1.0), 1.0]].map(at);
    others.into_iter().fold(first, |best, of| if of.distance < best.distance { of } else { best })
}

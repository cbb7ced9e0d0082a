//! Depth of the overlap of two convex bodies: the shortest way that separates them.
//!
//! Along a direction the bodies overlap by the reach of the one less the beginning of the other. The least of these
//! widths over all directions is the depth, and each of them is a way that separates.

use super::depth;
use crate::math::Vec3;
use crate::robot::{from_vector, vector};
use parry3d_f64::math::Pose as Placement;
use parry3d_f64::query;
use parry3d_f64::shape::{SharedShape, SupportMap};

/// Difference between the depth of the library and the width along its direction, over the width, up to which the
/// library is right; both are exact to some 1e-7.
const SAME: f64 = 1e-5;

/// Maximum number of normals of one body that are tried with those of the other.
const MAX_NORMALS: usize = 64;

/// Number of the best directions from which the search descends, and its first and last step [rad].
const DESCENTS: usize = 8;
const FIRST_STEP: f64 = 0.2;
const LAST_STEP: f64 = 1e-9;

/// Number of directions around the present one that a step tries.
const AROUND: usize = 8;

/// Overlap along a direction.
#[derive(Debug, Clone, Copy)]
struct Width {
    direction_w: Vec3,
    /// Way along the direction, against which the first body separates from the second [m].
    way: f64,
}

/// Two convex parts at their places.
struct ConvexPair<'a> {
    shapes: [&'a dyn SupportMap; 2],
    places: [&'a Placement; 2],
}

impl ConvexPair<'_> {
    fn point_w(&self, which: usize, direction_w: &Vec3) -> Vec3 {
        from_vector(self.shapes[which].support_point(self.places[which], vector(direction_w)))
    }

    fn width(&self, direction_w: Vec3) -> Width {
        let reach = self.point_w(0, &direction_w).dot(&direction_w);
        let begin = self.point_w(1, &-direction_w).dot(&direction_w);
        Width { direction_w, way: reach - begin }
    }

    /// Narrowest width near one, by steps that shrink.
    fn descended(&self, mut least: Width) -> Width {
        let mut step = FIRST_STEP;
        let mut turn = 0.0;
        while step > LAST_STEP {
            let along = crate::math::any_normal(&least.direction_w);
            let across = least.direction_w.cross(&along);
            // Other directions each time: a ridge hides the way down from some of them.
            turn += 0.7;
            let tried = (0..AROUND).map(|k| {
                let (sin, cos) = (turn + std::f64::consts::TAU * k as f64 / AROUND as f64).sin_cos();
                self.width((least.direction_w + (along * cos + across * sin) * step).normalize())
            });
            match tried.min_by(|a, b| a.way.total_cmp(&b.way)) {
                Some(lower) if lower.way < least.way => least = lower,
                _ => step *= 0.5,
            }
        }
        least
    }
}

/// Depth of two overlapping convex parts with a negative sign [m], and the points between which it is measured: one of
/// the first body, and where it comes to. `None` if one is not convex, or if they do not overlap.
pub(super) fn depth([one, other]: [&SharedShape; 2], [own, others]: [&Placement; 2]) -> Option<(f64, [Vec3; 2])> {
    let pair = ConvexPair { shapes: [one.as_support_map()?, other.as_support_map()?], places: [own, others] };
    if let Ok(Some(contact)) = query::contact(own, &*one.0, others, &*other.0, 0.0)
        && contact.dist < 0.0
    {
        let along = pair.width(from_vector(contact.normal1));
        if (along.way + contact.dist).abs() <= SAME * along.way.abs() {
            return Some((contact.dist, [from_vector(contact.point1), from_vector(contact.point2)]));
        }
    }

    // The library leaves out or misses contacts in symmetric places.
    let mut widths: Vec<Width> = directions([one, other], [own, others]).map(|along| pair.width(along)).collect();
    widths.sort_by(|a, b| a.way.total_cmp(&b.way));
    widths.truncate(DESCENTS);
    let least = widths.into_iter().map(|width| pair.descended(width)).min_by(|a, b| a.way.total_cmp(&b.way))?;
    let from_w = pair.point_w(0, &least.direction_w);
    (least.way > 0.0).then(|| (-least.way, [from_w, from_w - least.direction_w * least.way]))
}

/// Directions at which widths may be least: normals of faces and axes, those across two of them, and between the
/// bodies, each with its opposite.
fn directions(shapes: [&SharedShape; 2], places: [&Placement; 2]) -> impl Iterator<Item = Vec3> {
    let of = |which: usize| -> Vec<Vec3> {
        let turn = |along: Vec3| from_vector(places[which].rotation * vector(&along));
        let mut found: Vec<Vec3> = depth::normals(shapes[which]).into_iter().map(turn).collect();
        found.truncate(MAX_NORMALS);
        found
    };
    let [first, second] = [of(0), of(1)];
    let between = from_vector(places[1].translation) - from_vector(places[0].translation);
    let mut all = [first.clone(), second.clone(), vec![between, Vec3::x(), Vec3::y(), Vec3::z()]].concat();
    for one in &first {
        all.extend(second.iter().map(|other| one.cross(other)));
        // A round body has a normal in every direction across its axis.
        all.push(one.cross(&between).cross(one));
    }
    all.extend(second.iter().map(|other| other.cross(&between).cross(other)));
    let unit = all.into_iter().filter_map(|along| along.try_normalize(1e-9));
    unit.flat_map(|along| [along, -along])
}

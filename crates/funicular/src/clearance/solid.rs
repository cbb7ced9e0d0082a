//! Bodies at their places: distances from segments, points and each other.

use super::{BODY_TOLERANCE, convex_overlap, depth};
use crate::math::Vec3;
use crate::robot::{Body, Pose, Solid, from_vector, vector};
use parry3d_f64::bounding_volume::BoundingVolume;
use parry3d_f64::math::{Pose as Placement, Rot3, Vector};
use parry3d_f64::query::{self, ClosestPoints};
use parry3d_f64::shape::{Segment, SharedShape};

/// Body at a place in the world.
pub(super) struct PlacedBody {
    /// Parts of the body: a mesh may have several, any other body has one.
    shapes: Vec<SharedShape>,
    /// Frame of the shapes in the world.
    frame: Pose,
    method: Method,
    /// Ball around the body: its centre in the world, and its radius [m], infinite for a half space.
    ball: (Vec3, f64),
}

/// Method by which the distance from a segment is found.
enum Method {
    /// Library of shapes.
    Library,
    /// Own: that of the library is exact to 1e-5 m only.
    Cylinder { radius: f64, half_length: f64 },
    /// Own: signed inside.
    HalfSpace,
}

/// Nearest points of a body and a segment.
pub(super) struct NearSegment {
    /// Distance [m]; inside, the depth of the deepest point with a negative sign.
    pub(super) distance: f64,
    /// Place of the nearest or deepest point on the segment, from 0 to 1.
    pub(super) fraction: f64,
    /// Nearest point of the surface of the body, world axes [m].
    pub(super) point_w: Vec3,
}

impl PlacedBody {
    /// Obstacle.
    pub(super) fn in_world(body: &Body) -> Self {
        Self::of_body(body, body.pose)
    }

    /// Body of a platform at a pose.
    pub(super) fn on_platform(body: &Body, platform: &Pose) -> Self {
        let position_w = platform.point_w(&body.pose.position_w);
        Self::of_body(body, Pose { position_w, rot_wp: platform.rot_wp * body.pose.rot_wp })
    }

    /// Shape in a frame.
    pub(super) fn of_shape(shape: SharedShape, frame: &Pose) -> Self {
        Self::new(vec![shape], *frame, Method::Library)
    }

    fn of_body(body: &Body, frame: Pose) -> Self {
        let method = match body.solid {
            Solid::Cylinder { radius, half_length } => Method::Cylinder { radius, half_length },
            Solid::HalfSpace => Method::HalfSpace,
            Solid::Box { .. } | Solid::Mesh(_) => Method::Library,
        };
        let (shapes, turn) = body.solid.shapes();
        Self::new(shapes, Pose { rot_wp: frame.rot_wp * turn, ..frame }, method)
    }

    fn new(shapes: Vec<SharedShape>, frame: Pose, method: Method) -> Self {
        let boxes = shapes.iter().map(|shape| shape.compute_local_aabb());
        let ball = match (&method, boxes.reduce(|one, other| one.merged(&other))) {
            (Method::HalfSpace, _) | (_, None) => (frame.position_w, f64::INFINITY),
            (_, Some(around)) => (frame.point_w(&from_vector(around.center())), around.half_extents().length()),
        };
        Self { shapes, frame, method, ball }
    }

    /// True if distances are dear: a surface of triangles.
    pub(super) fn is_mesh(&self) -> bool {
        self.shapes.iter().any(|shape| shape.as_trimesh().is_some())
    }

    /// Lower bound of the distance from another body, from the balls around both [m]; negative if they overlap.
    pub(super) fn lower_bound_to(&self, other: &Self) -> f64 {
        (self.ball.0 - other.ball.0).norm() - self.ball.1 - other.ball.1
    }

    /// Lower bound of the distance from a segment in the world, from the ball around the body [m].
    pub(super) fn lower_bound_to_segment(&self, from_w: &Vec3, to_w: &Vec3) -> f64 {
        let along = to_w - from_w;
        let square = along.norm_squared();
        let fraction = if square > 0.0 { (self.ball.0 - from_w).dot(&along) / square } else { 0.0 };
        (from_w + along * fraction.clamp(0.0, 1.0) - self.ball.0).norm() - self.ball.1
    }

    fn local(&self, point_w: &Vec3) -> Vec3 {
        self.frame.rot_wp.inverse() * (point_w - self.frame.position_w)
    }

    fn placement(&self) -> Placement {
        let q = self.frame.rot_wp.quaternion();
        Placement::from_parts(vector(&self.frame.position_w), Rot3::from_xyzw(q.i, q.j, q.k, q.w))
    }

    /// Nearest points of the body and a segment in the world, which may be a point.
    pub(super) fn nearest_to_segment(&self, from_w: &Vec3, to_w: &Vec3) -> NearSegment {
        let (from, to) = (self.local(from_w), self.local(to_w));
        let at = |fraction: f64| from + (to - from) * fraction;
        let (distance, fraction, point) = match &self.method {
            Method::HalfSpace => {
                let fraction = if from.z <= to.z { 0.0 } else { 1.0 };
                let nearest = at(fraction);
                (nearest.z, fraction, Vec3::new(nearest.x, nearest.y, 0.0))
            }
            Method::Cylinder { radius, half_length } => {
                let fraction = nearest_to_cylinder(&from, &to, *radius, *half_length);
                let offset = from_cylinder(&at(fraction), *radius, *half_length);
                if offset == Vec3::zeros() {
                    depth::in_cylinder(&from, &to, *radius, *half_length)
                } else {
                    (offset.norm(), fraction, at(fraction) - offset)
                }
            }
            Method::Library => {
                let of_parts = self.shapes.iter().map(|shape| by_library(shape, &from, &to));
                let nearest = of_parts.min_by(|a, b| a.0.total_cmp(&b.0));
                nearest.unwrap_or((f64::INFINITY, 0.0, from))
            }
        };
        NearSegment { distance, fraction, point_w: self.frame.point_w(&point) }
    }

    /// Distance of this body of the platform from an obstacle, negative by the depth where they overlap, and the
    /// nearest points [m]. Between cylinders and other bodies it is exact to 1e-5 m.
    pub(super) fn nearest_to(&self, obstacle: &Self) -> (f64, [Vec3; 2]) {
        if matches!(obstacle.method, Method::HalfSpace) {
            let (point_w, height) = self.lowest(obstacle);
            return (height, [point_w, point_w - obstacle.frame.rot_wp * Vec3::z() * height]);
        }
        let (own, other) = (self.placement(), obstacle.placement());
        let each = self.shapes.iter().flat_map(|one| obstacle.shapes.iter().map(move |two| [one, two]));
        let pairs = each.map(|[one, two]| {
            let inside = |outer: &SharedShape, at: &Self, inner_w: Vec3| {
                // One of two bodies may be inside the other without touching its surface.
                outer.contains_local_point(vector(&at.local(&inner_w)))
            };
            let touch = inside(two, obstacle, self.any_point_w(one)) || inside(one, self, obstacle.any_point_w(two));
            if touch {
                return self.overlap(obstacle, [one, two]);
            }
            match query::closest_points(&own, &*one.0, &other, &*two.0, f64::INFINITY) {
                Ok(ClosestPoints::WithinMargin(a, b)) => ((a - b).length(), [from_vector(a), from_vector(b)]),
                _ => self.overlap(obstacle, [one, two]),
            }
        });
        let nearest = pairs.min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.unwrap_or((f64::INFINITY, [self.frame.position_w, obstacle.frame.position_w]))
    }

    /// Depth of the overlap of two parts that touch, with a negative sign, and the points between which it is measured
    /// [m]: for convex bodies the shortest way that separates them, otherwise the greatest depth of an edge of one in
    /// the other.
    fn overlap(&self, obstacle: &Self, [one, two]: [&SharedShape; 2]) -> (f64, [Vec3; 2]) {
        let (own, other) = (self.placement(), obstacle.placement());
        if let Some(found) = convex_overlap::depth([one, two], [&own, &other]) {
            return found;
        }

        let [own_box, other_box] = [one.compute_aabb(&own), two.compute_aabb(&other)];
        let mut deepest = (0.0, [self.any_point_w(one); 2]);
        for (edges_of, edges, within, reach) in [(self, one, obstacle, other_box), (obstacle, two, self, own_box)] {
            for edge in depth::edges(edges) {
                let [from_w, to_w] = edge.map(|end| edges_of.frame.point_w(&end));
                if !Segment::new(vector(&from_w), vector(&to_w)).local_aabb().intersects(&reach) {
                    continue;
                }
                let near = within.nearest_to_segment(&from_w, &to_w);
                if near.distance < deepest.0 {
                    let points_w = [from_w + (to_w - from_w) * near.fraction, near.point_w];
                    let is_own = std::ptr::eq(edges_of, self);
                    deepest = (near.distance, if is_own { points_w } else { [points_w[1], points_w[0]] });
                }
            }
        }
        deepest
    }

    /// Point of the body that is lowest over a half space, and its height [m].
    fn lowest(&self, half_space: &Self) -> (Vec3, f64) {
        let down = self.frame.rot_wp.inverse() * (half_space.frame.rot_wp * -Vec3::z());
        let down = vector(&down);
        let lowest_of = |shape: &SharedShape| match (shape.as_support_map(), shape.as_trimesh()) {
            (Some(convex), _) => convex.local_support_point(down),
            (None, Some(mesh)) => {
                let lowest = mesh.vertices().iter().max_by(|a, b| a.dot(down).total_cmp(&b.dot(down)));
                lowest.copied().unwrap_or(Vector::ZERO)
            }
            (None, None) => Vector::ZERO,
        };
        let point = self.shapes.iter().map(lowest_of).max_by(|a, b| a.dot(down).total_cmp(&b.dot(down)));
        let point_w = self.frame.point_w(&point.map_or_else(Vec3::zeros, from_vector));
        (point_w, half_space.local(&point_w).z)
    }

    /// Some point of a part of the body, world axes [m].
    fn any_point_w(&self, shape: &SharedShape) -> Vec3 {
        let corner = shape.as_trimesh().and_then(|mesh| mesh.vertices().first());
        let point = corner.copied().or_else(|| Some(shape.as_support_map()?.local_support_point(Vector::X)));
        self.frame.point_w(&point.map_or_else(Vec3::zeros, from_vector))
    }
}

/// Distance, fraction and nearest point of a segment in the frame of a shape; inside, those of the deepest point.
fn by_library(shape: &SharedShape, from: &Vec3, to: &Vec3) -> (f64, f64, Vec3) {
    let along = to - from;
    let length = along.norm();
    if length <= f64::EPSILON * from.norm() {
        let point = vector(from);
        let projected = shape.project_local_point(point, true);
        if projected.is_inside {
            return depth::in_shape(shape, from, from);
        }
        return ((projected.point - point).length(), 0.0, from_vector(projected.point));
    }

    // A segment inside of a closed surface touches nothing of it.
    if shape.as_trimesh().is_some() && shape.contains_local_point(vector(from)) {
        return depth::in_shape(shape, from, to);
    }
    let segment = Segment::new(vector(from), vector(to));
    let identity = Placement::IDENTITY;
    let outside = match query::closest_points(&identity, &segment, &identity, &*shape.0, f64::INFINITY) {
        Ok(ClosestPoints::WithinMargin(on_segment, on_shape)) => {
            let fraction = (from_vector(on_segment) - from).dot(&along) / (length * length);
            ((on_segment - on_shape).length(), fraction.clamp(0.0, 1.0), from_vector(on_shape))
        }
        _ => return depth::in_shape(shape, from, to),
    };
    if outside.0 > BODY_TOLERANCE {
        return outside;
    }
    // The library may give the point at which a segment pierces a surface.
    let inside = depth::in_shape(shape, from, to);
    if inside.0 < 0.0 { inside } else { outside }
}

/// Place of the nearest point of a segment to a cylinder along y. The distance is convex along the segment, so its
/// slope changes its sign once.
fn nearest_to_cylinder(from: &Vec3, to: &Vec3, radius: f64, half_length: f64) -> f64 {
    let along = to - from;
    depth::lowest_place(|fraction| from_cylinder(&(from + along * fraction), radius, half_length).dot(&along))
}

/// Vector from the nearest point of a cylinder along y to a point; zero inside.
fn from_cylinder(point: &Vec3, radius: f64, half_length: f64) -> Vec3 {
    let from_axis = point.x.hypot(point.z);
    let outside = (from_axis - radius).max(0.0);
    let beyond = (point.y.abs() - half_length).max(0.0) * point.y.signum();
    let share = if from_axis > 0.0 { outside / from_axis } else { 0.0 };
    Vec3::new(point.x * share, beyond, point.z * share)
}

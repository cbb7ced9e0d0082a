//! Bodies at their places: distances from segments, points and each other.

use crate::math::Vec3;
use crate::robot::{Body, Pose, Solid, from_vector, vector};
use parry3d_f64::math::{Pose as Placement, Rot3, Vector};
use parry3d_f64::query::{self, ClosestPoints};
use parry3d_f64::shape::{Segment, SharedShape};

/// Body at a place in the world.
pub(super) struct PlacedBody {
    shape: SharedShape,
    /// Frame of the shape in the world.
    frame: Pose,
    method: Method,
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
    /// Distance [m]; zero inside, but negative in a half space.
    pub(super) distance: f64,
    /// Place of the nearest point on the segment, from 0 to 1.
    pub(super) fraction: f64,
    /// Nearest point of the body, world axes [m]; inside, the point of the segment.
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
        Self { shape, frame: *frame, method: Method::Library }
    }

    fn of_body(body: &Body, frame: Pose) -> Self {
        let method = match body.solid {
            Solid::Cylinder { radius, half_length } => Method::Cylinder { radius, half_length },
            Solid::HalfSpace => Method::HalfSpace,
            Solid::Box { .. } | Solid::Mesh(_) => Method::Library,
        };
        let (shape, turn) = body.solid.shape();
        Self { shape, frame: Pose { rot_wp: frame.rot_wp * turn, ..frame }, method }
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
                (offset.norm(), fraction, at(fraction) - offset)
            }
            Method::Library => self.by_library(&from, &to),
        };
        NearSegment { distance, fraction, point_w: self.frame.point_w(&point) }
    }

    /// Distance, fraction and nearest point of a segment in the frame of the shape.
    fn by_library(&self, from: &Vec3, to: &Vec3) -> (f64, f64, Vec3) {
        let along = to - from;
        let length = along.norm();
        if length <= f64::EPSILON * from.norm() {
            let point = vector(from);
            let projected = self.shape.project_local_point(point, true);
            let distance = if projected.is_inside { 0.0 } else { (projected.point - point).length() };
            return (distance, 0.0, from_vector(projected.point));
        }

        // A segment inside of a closed surface touches nothing of it.
        if self.shape.as_trimesh().is_some() && self.shape.contains_local_point(vector(from)) {
            return (0.0, 0.0, *from);
        }
        let segment = Segment::new(vector(from), vector(to));
        let identity = Placement::IDENTITY;
        match query::closest_points(&identity, &segment, &identity, &*self.shape.0, f64::INFINITY) {
            Ok(ClosestPoints::WithinMargin(on_segment, on_shape)) => {
                let fraction = (from_vector(on_segment) - from).dot(&along) / (length * length);
                ((on_segment - on_shape).length(), fraction.clamp(0.0, 1.0), from_vector(on_shape))
            }
            // It touches: the nearest points are not known, and any division of the arc finds them.
            _ => (0.0, 0.5, from + along * 0.5),
        }
    }

    /// Distance of this body of the platform from an obstacle, and the nearest points [m]. Between cylinders and other
    /// bodies it is exact to 1e-5 m.
    pub(super) fn nearest_to(&self, obstacle: &Self) -> (f64, [Vec3; 2]) {
        if matches!(obstacle.method, Method::HalfSpace) {
            let (point_w, height) = self.lowest(obstacle);
            return (height, [point_w, point_w - obstacle.frame.rot_wp * Vec3::z() * height]);
        }
        let (own, other) = (self.placement(), obstacle.placement());
        let inside = |outer: &Self, inner: &Self| {
            // One of two bodies may be inside the other without touching its surface.
            let point = outer.local(&inner.any_point_w());
            outer.shape.contains_local_point(vector(&point))
        };
        if inside(obstacle, self) || inside(self, obstacle) {
            let point_w = self.any_point_w();
            return (0.0, [point_w, point_w]);
        }
        match query::closest_points(&own, &*self.shape.0, &other, &*obstacle.shape.0, f64::INFINITY) {
            Ok(ClosestPoints::WithinMargin(one, two)) => ((one - two).length(), [from_vector(one), from_vector(two)]),
            _ => (0.0, [self.any_point_w(); 2]),
        }
    }

    /// Point of the body that is lowest over a half space, and its height [m].
    fn lowest(&self, half_space: &Self) -> (Vec3, f64) {
        let down = self.frame.rot_wp.inverse() * (half_space.frame.rot_wp * -Vec3::z());
        let point = match (self.shape.as_support_map(), self.shape.as_trimesh()) {
            (Some(convex), _) => convex.local_support_point(vector(&down)),
            (None, Some(mesh)) => {
                let down = vector(&down);
                let lowest = mesh.vertices().iter().max_by(|a, b| a.dot(down).total_cmp(&b.dot(down)));
                lowest.copied().unwrap_or(Vector::ZERO)
            }
            (None, None) => Vector::ZERO,
        };
        let point_w = self.frame.point_w(&from_vector(point));
        (point_w, half_space.local(&point_w).z)
    }

    /// Some point of the body, world axes [m].
    fn any_point_w(&self) -> Vec3 {
        let corner = self.shape.as_trimesh().and_then(|mesh| mesh.vertices().first());
        let point = corner.copied().or_else(|| Some(self.shape.as_support_map()?.local_support_point(Vector::X)));
        self.frame.point_w(&point.map_or_else(Vec3::zeros, from_vector))
    }
}

/// Number of halvings that find the nearest point of a segment to a cylinder: 1e-16 of its length.
const HALVINGS: usize = 53;

/// Place of the nearest point of a segment to a cylinder along y. The distance is convex along the segment, so its slope
/// changes its sign once.
fn nearest_to_cylinder(from: &Vec3, to: &Vec3, radius: f64, half_length: f64) -> f64 {
    let along = to - from;
    let slope = |fraction: f64| from_cylinder(&(from + along * fraction), radius, half_length).dot(&along);
    if slope(0.0) >= 0.0 {
        return 0.0;
    }
    if slope(1.0) <= 0.0 {
        return 1.0;
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        match slope(middle) {
            0.0 => return middle,
            below if below < 0.0 => low = middle,
            _ => high = middle,
        }
    }
    0.5 * (low + high)
}

/// Vector from the nearest point of a cylinder along y to a point; zero inside.
fn from_cylinder(point: &Vec3, radius: f64, half_length: f64) -> Vec3 {
    let from_axis = point.x.hypot(point.z);
    let outside = (from_axis - radius).max(0.0);
    let beyond = (point.y.abs() - half_length).max(0.0) * point.y.signum();
    let share = if from_axis > 0.0 { outside / from_axis } else { 0.0 };
    Vec3::new(point.x * share, beyond, point.z * share)
}

//! Depth of segments in solids, with a negative sign: a distance from the surface as it is seen from inside.
//!
//! The signed distance of a point from a convex solid is convex, so that along a segment its slope changes its sign
//! once. That from a mesh has several minima, which bounds from single triangles enclose.

use super::BODY_TOLERANCE;
use super::bounded::Bounded;
use crate::math::Vec3;
use crate::robot::{from_vector, vector};
use parry3d_f64::math::Vector;
use parry3d_f64::query::{PointQuery, PointQueryWithLocation};
use parry3d_f64::shape::{SharedShape, TriMesh, TriMeshFlags};
use std::collections::BinaryHeap;

/// Number of halvings that find the deepest point of a segment: 1e-16 of its length.
const HALVINGS: usize = 53;

/// Maximum number of divisions of a segment in a mesh, a guard: segments across rooms of thousands of triangles need
/// some hundred.
const MAX_DIVISIONS: usize = 4096;

/// Number of sides of the prism whose edges stand for those of a cylinder.
const SIDES: u32 = 32;

/// Depth of the deepest point of a segment in a shape that it touches, with a negative sign [m], the place of the point
/// from 0 to 1, and the point of the surface that is nearest to it. A shape without inside has no depth.
pub(super) fn in_shape(shape: &SharedShape, from: &Vec3, to: &Vec3) -> (f64, f64, Vec3) {
    if let Some(mesh) = shape.as_trimesh() {
        return if mesh.flags().contains(TriMeshFlags::ORIENTED) {
            in_mesh(mesh, from, to)
        } else {
            touching(shape, from, to)
        };
    }
    let faces = faces(shape);
    if faces.is_empty() {
        return touching(shape, from, to);
    }

    let along = to - from;
    let highest = |fraction: f64| {
        let point = from + along * fraction;
        let heights = faces.iter().map(|face| (face.normal.dot(&point) - face.height, face));
        heights.max_by(|a, b| a.0.total_cmp(&b.0))
    };
    let slope = |fraction: f64| highest(fraction).map_or(0.0, |(_, face)| face.normal.dot(&along));
    let fraction = lowest_place(slope);
    let Some((height, face)) = highest(fraction) else { return touching(shape, from, to) };
    (height.min(0.0), fraction, from + along * fraction - face.normal * height)
}

/// Depth of the deepest point of a segment in a cylinder along y, as [`in_shape`].
pub(super) fn in_cylinder(from: &Vec3, to: &Vec3, radius: f64, half_length: f64) -> (f64, f64, Vec3) {
    let along = to - from;
    let heights = |point: &Vec3| [point.x.hypot(point.z) - radius, point.y.abs() - half_length];
    let slope = |fraction: f64| {
        let point = from + along * fraction;
        let [across, beyond] = heights(&point);
        if across > beyond {
            (point.x * along.x + point.z * along.z) / (across + radius)
        } else {
            point.y.signum() * along.y
        }
    };
    let fraction = lowest_place(slope);
    let point = from + along * fraction;
    let [across, beyond] = heights(&point);
    let surface = if across > beyond {
        // Every direction leads from the axis to the surface.
        let from_axis = across + radius;
        let outward = if from_axis > 0.0 { Vec3::new(point.x, 0.0, point.z) / from_axis } else { Vec3::x() };
        point - outward * across
    } else {
        Vec3::new(point.x, half_length.copysign(point.y), point.z)
    };
    (across.max(beyond).min(0.0), fraction, surface)
}

/// Edges of a shape in its own frame [m]; those of a cylinder are the edges of a prism.
pub(super) fn edges(shape: &SharedShape) -> Vec<[Vec3; 2]> {
    if let Some(segment) = shape.as_segment() {
        return vec![[segment.a, segment.b].map(from_vector)];
    }
    let (points, triangles) = if let Some(cuboid) = shape.as_cuboid() {
        cuboid.to_trimesh()
    } else if let Some(cylinder) = shape.as_cylinder() {
        cylinder.to_trimesh(SIDES)
    } else if let Some(hull) = shape.as_convex_polyhedron() {
        hull.to_trimesh()
    } else if let Some(mesh) = shape.as_trimesh() {
        (mesh.vertices().to_vec(), mesh.indices().to_vec())
    } else {
        return Vec::new();
    };
    let ends = triangles.iter().flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]]);
    let mut ends: Vec<[u32; 2]> = ends.map(|[a, b]| [a.min(b), a.max(b)]).collect();
    ends.sort_unstable();
    ends.dedup();
    ends.into_iter().map(|ends| ends.map(|i| from_vector(points[i as usize]))).collect()
}

/// Plane of a face of a convex solid.
struct Face {
    /// Unit vector outward.
    normal: Vec3,
    /// Height of the plane along it [m].
    height: f64,
}

/// Faces of a box or a convex hull; none for other shapes.
fn faces(shape: &SharedShape) -> Vec<Face> {
    if let Some(cuboid) = shape.as_cuboid() {
        let half = from_vector(cuboid.half_extents);
        let of_axis = |k: usize| {
            [1.0, -1.0].map(|side| {
                let mut normal = Vec3::zeros();
                normal[k] = side;
                Face { normal, height: half[k] }
            })
        };
        return (0..3).flat_map(of_axis).collect();
    }
    let Some(hull) = shape.as_convex_polyhedron() else { return Vec::new() };
    let (points, of_faces) = (hull.points(), hull.vertices_adj_to_face());
    let planes = hull.faces().iter().map(|face| {
        let corner = points[of_faces[face.first_vertex_or_edge as usize] as usize];
        Face { normal: from_vector(face.normal), height: face.normal.dot(corner) }
    });
    planes.collect()
}

/// Normals of the faces of a convex solid, and of a cylinder its axis.
pub(super) fn normals(shape: &SharedShape) -> Vec<Vec3> {
    if shape.as_cylinder().is_some() {
        return vec![Vec3::y()];
    }
    faces(shape).into_iter().map(|face| face.normal).collect()
}

/// Place from 0 to 1 at which a convex function is least, by its slope.
pub(super) fn lowest_place(slope: impl Fn(f64) -> f64) -> f64 {
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

/// Contact without a depth, at the end or the middle of a segment that is nearest to the shape.
fn touching(shape: &SharedShape, from: &Vec3, to: &Vec3) -> (f64, f64, Vec3) {
    let near = [0.5, 0.0, 1.0].map(|fraction| {
        let point = vector(&(from + (to - from) * fraction));
        ((shape.project_local_point(point, true).point - point).length(), fraction)
    });
    let [middle, ends @ ..] = near;
    let (_, fraction) = ends.into_iter().fold(middle, |best, end| if end.0 < best.0 { end } else { best });
    (0.0, fraction, from + (to - from) * fraction)
}

/// Part of a segment in a mesh, by its places from 0 to 1.
struct SegmentPart {
    places: [f64; 2],
}

/// Depth of the deepest point of a segment in a closed mesh, as [`in_shape`]. The distance from one triangle is
/// convex, so that no point of a part is deeper than the farther one of its ends is from any triangle.
fn in_mesh(mesh: &TriMesh, from: &Vec3, to: &Vec3) -> (f64, f64, Vec3) {
    let at = |fraction: f64| vector(&(from + (to - from) * fraction));
    let length = (to - from).norm();
    let mut best = (0.0, 0.5, from + (to - from) * 0.5);
    let bounded = |places: [f64; 2], best: &mut (f64, f64, Vec3)| {
        let middle = 0.5 * (places[0] + places[1]);
        let point = at(middle);
        let (projected, (nearest, _)) = mesh.project_local_point_and_get_location(point, false);
        let depth = (projected.point - point).length();
        if projected.is_inside && -depth < best.0 {
            *best = (-depth, middle, from_vector(projected.point));
        }
        let triangle = mesh.triangle(nearest);
        let away = |end: Vector| (triangle.project_local_point(end, true).point - end).length();
        // Nor is a point deeper than the middle by more than its way from there: parts outside are left out soon.
        let height = if projected.is_inside { -depth } else { depth };
        let along = 0.5 * (places[1] - places[0]) * length;
        let lower = (height - along).max(-away(at(places[0])).max(away(at(places[1]))));
        Bounded { lower, of: SegmentPart { places } }
    };

    let mut queue = BinaryHeap::from([bounded([0.0, 1.0], &mut best)]);
    for _ in 0..MAX_DIVISIONS {
        let Some(Bounded { lower, of: part }) = queue.pop() else { break };
        if lower >= best.0 - 0.25 * BODY_TOLERANCE {
            break;
        }
        let [low, high] = part.places;
        let middle = 0.5 * (low + high);
        for half in [[low, middle], [middle, high]] {
            queue.push(bounded(half, &mut best));
        }
    }
    best
}

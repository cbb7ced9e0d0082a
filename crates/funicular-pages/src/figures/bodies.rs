//! Obstacles and bodies of the platform in figures: their surfaces, and the edges that a line drawing shows.

use funicular::math::Vec3;
use funicular::robot::{Body, Pose, Robot};
use std::collections::BTreeMap;

/// Cosine of the angle between two triangles above which their common edge is not drawn: sides of a cylinder of 32 meet
/// at 11°.
const SMOOTH: f64 = 0.94;

/// Surface of a body in the world.
#[derive(Debug, Clone)]
pub(crate) struct BodySurface {
    pub(crate) name: String,
    /// Triangles, three corners each [m].
    pub(crate) triangles: Vec<[Vec3; 3]>,
}

impl BodySurface {
    /// Obstacles of a robot.
    pub(crate) fn obstacles(robot: &Robot) -> Vec<Self> {
        robot.obstacles.iter().map(|body| Self::of(body, |point| point)).collect()
    }

    /// Bodies of the platform at a pose.
    pub(crate) fn of_platform(robot: &Robot, pose: &Pose) -> Vec<Self> {
        robot.platform.bodies.iter().map(|body| Self::of(body, |point| pose.point_w(&point))).collect()
    }

    fn of(body: &Body, place: impl Fn(Vec3) -> Vec3) -> Self {
        let triangles = body.triangles().into_iter().map(|triangle| triangle.map(&place)).collect();
        Self { name: body.name.clone(), triangles }
    }

    /// Corners of all triangles [m].
    pub(crate) fn points(&self) -> impl Iterator<Item = Vec3> + '_ {
        self.triangles.iter().flatten().copied()
    }

    /// Edges between triangles that meet at an angle [m].
    pub(crate) fn edges(&self) -> Vec<[Vec3; 2]> {
        let key = |point: &Vec3| [point.x, point.y, point.z].map(|number| (number * 1e6).round() as i64);
        let mut edges: BTreeMap<[[i64; 3]; 2], ([Vec3; 2], Vec<Vec3>)> = BTreeMap::new();
        for [a, b, c] in &self.triangles {
            let normal = (b - a).cross(&(c - a)).normalize();
            for [from, to] in [[a, b], [b, c], [c, a]] {
                let mut ends = [key(from), key(to)];
                ends.sort_unstable();
                edges.entry(ends).or_insert_with(|| ([*from, *to], Vec::new())).1.push(normal);
            }
        }
        let is_sharp = |normals: &[Vec3]| normals.len() != 2 || normals[0].dot(&normals[1]) < SMOOTH;
        edges.into_values().filter(|(_, normals)| is_sharp(normals)).map(|(ends, _)| ends).collect()
    }
}

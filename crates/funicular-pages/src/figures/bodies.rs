//! Obstacles and bodies of the platform in figures: their surfaces, and the edges that a line drawing shows.

use funicular::math::Vec3;
use funicular::robot::{Body, Pose, Robot, Solid};
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
    /// Obstacles of a robot; a half space as a square in its plane, below or beside the anchors.
    pub(crate) fn obstacles(robot: &Robot) -> Vec<Self> {
        let of = |body: &Body| match body.solid {
            Solid::HalfSpace => Self { name: body.name.clone(), triangles: square(robot, body) },
            _ => Self::of(body, |point| point),
        };
        robot.obstacles.iter().map(of).collect()
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

    /// Edges that a line drawing shows from a direction: those between triangles that meet at an angle, and the outline
    /// [m].
    pub(crate) fn edges(&self, towards: &Vec3) -> Vec<[Vec3; 2]> {
        // Corners to a micrometre, so that triangles share them.
        let key = |point: &Vec3| [point.x, point.y, point.z].map(|number| (number * 1e6).round() as i64);
        let mut edges: BTreeMap<[[i64; 3]; 2], EdgeOfTriangles> = BTreeMap::new();
        for [a, b, c] in &self.triangles {
            let normal = (b - a).cross(&(c - a)).normalize();
            for [from, to] in [[a, b], [b, c], [c, a]] {
                let mut ends = [key(from), key(to)];
                ends.sort_unstable();
                let new = || EdgeOfTriangles { ends: [*from, *to], normals: Vec::new() };
                edges.entry(ends).or_insert_with(new).normals.push(normal);
            }
        }
        edges.into_values().filter(|edge| edge.is_shown(towards)).map(|edge| edge.ends).collect()
    }
}

/// Distance of a half space from the middle of the anchors, over their radius, up to which it is drawn: a plane far
/// away would make the robot small.
const MAX_AWAY: f64 = 2.0;

/// Square in the plane of a half space as large as the anchors' room, at the place nearest to their middle; none for a
/// plane that is far away.
fn square(robot: &Robot, body: &Body) -> Vec<[Vec3; 3]> {
    let anchors: Vec<Vec3> = robot.cables.iter().map(|cable| cable.anchor.reference_w()).collect();
    let middle = anchors.iter().sum::<Vec3>() / anchors.len() as f64;
    let radius = anchors.iter().map(|anchor| (anchor - middle).norm()).fold(0.0, f64::max);
    let [x, y, outward] = [Vec3::x(), Vec3::y(), Vec3::z()].map(|axis| body.pose.rot_wp * axis);
    let away = outward.dot(&(middle - body.pose.position_w));
    if radius == 0.0 || away.abs() > MAX_AWAY * radius {
        return Vec::new();
    }
    let foot = middle - outward * away;
    let corner = |u: f64, v: f64| foot + (x * u + y * v) * radius;
    let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    vec![[a, b, c], [a, c, d]]
}

/// True for a point behind the surface of a half space, as below a floor: pictures need no room for it.
pub(crate) fn is_hidden(robot: &Robot, point: &Vec3) -> bool {
    let half_spaces = robot.obstacles.iter().filter(|body| body.solid == Solid::HalfSpace);
    half_spaces.into_iter().any(|body| (body.pose.rot_wp * Vec3::z()).dot(&(point - body.pose.position_w)) < 0.0)
}

/// Edge with the normals of its triangles.
struct EdgeOfTriangles {
    ends: [Vec3; 2],
    normals: Vec<Vec3>,
}

impl EdgeOfTriangles {
    fn is_shown(&self, towards: &Vec3) -> bool {
        match self.normals[..] {
            [one, other] => one.dot(&other) < SMOOTH || (one.dot(towards) > 0.0) != (other.dot(towards) > 0.0),
            _ => true,
        }
    }
}

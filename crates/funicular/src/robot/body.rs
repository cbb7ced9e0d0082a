//! Solid bodies: obstacles in the world, and parts of the platform.

use super::Pose;
use crate::math::{Rotation, Vec3};
use parry3d_f64::math::Vector;
use parry3d_f64::shape::{Cuboid, Cylinder, HalfSpace, SharedShape, TriMesh, TriMeshFlags};
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;
use thiserror::Error;

/// Solid body at a place in its frame: the world for an obstacle, the platform frame for a part of the platform.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Name in the robot file.
    pub name: String,
    /// Position and orientation of the body's own frame.
    pub pose: Pose,
    /// Solid in the body's own frame.
    pub solid: Solid,
}

/// Solid about the origin of its own frame.
#[derive(Debug, Clone, PartialEq)]
pub enum Solid {
    /// Box with its centre at the origin.
    Box {
        /// Half of its edges [m].
        half: Vec3,
    },
    /// Cylinder along z with its centre at the origin.
    Cylinder {
        /// Radius [m].
        radius: f64,
        /// Half of its length [m].
        half_length: f64,
    },
    /// Everything below the plane z = 0.
    HalfSpace,
    /// Closed surface of triangles.
    Mesh(ClosedMesh),
}

impl Solid {
    /// Words of the robot file with their meanings.
    pub const WORDS: &[(&str, &str)] = &[
        ("box", "box with the edges `size_m`, its centre at `position_m`"),
        ("cylinder", "cylinder with `diameter_m` and `length_m` along its z axis, its centre at `position_m`"),
        (
            "half-space",
            "everything below the x-y plane of its frame, which goes through `position_m`: a floor or a wall",
        ),
        ("mesh", "closed surface of the STL file `file`, whose origin is placed at `position_m`"),
    ];

    /// Shape of the library, and the rotation of its frame in that of the solid.
    pub(crate) fn shape(&self) -> (SharedShape, Rotation) {
        let unturned = |shape| (shape, Rotation::identity());
        match self {
            Self::Box { half } => unturned(SharedShape(Arc::new(Cuboid::new(vector(half))))),
            Self::Cylinder { radius, half_length } => {
                let turn = Rotation::from_axis_angle(&Vec3::x_axis(), FROM_Y);
                (SharedShape(Arc::new(Cylinder::new(*half_length, *radius))), turn)
            }
            Self::HalfSpace => unturned(SharedShape(Arc::new(HalfSpace::new(Vector::Z)))),
            Self::Mesh(mesh) => unturned(SharedShape(mesh.0.clone())),
        }
    }
}

impl Body {
    /// Distance of a point inside the body from its surface [m]; zero outside. The point is in the frame in which the body
    /// stands.
    pub(super) fn depth_inside(&self, point: &Vec3) -> f64 {
        let (shape, turn) = self.solid.shape();
        let local = vector(&(turn.inverse() * (self.pose.rot_wp.inverse() * (point - self.pose.position_w))));
        let projected = shape.project_local_point(local, false);
        if projected.is_inside { (projected.point - local).length() } else { 0.0 }
    }
}

impl Body {
    /// Triangles of the surface, three corners each, in the frame in which the body stands [m]; a cylinder as a prism, and
    /// none for a half space.
    pub fn triangles(&self) -> Vec<[Vec3; 3]> {
        let turn = self.solid.shape().1;
        let (vertices, faces) = match &self.solid {
            Solid::Box { half } => Cuboid::new(vector(half)).to_trimesh(),
            Solid::Cylinder { radius, half_length } => Cylinder::new(*half_length, *radius).to_trimesh(SIDES),
            Solid::HalfSpace => return Vec::new(),
            Solid::Mesh(mesh) => (mesh.0.vertices().to_vec(), mesh.0.indices().to_vec()),
        };
        let placed = |i: u32| self.pose.point_w(&(turn * from_vector(vertices[i as usize])));
        faces.into_iter().map(|face| face.map(placed)).collect()
    }
}

/// Number of sides of the prism that stands for a cylinder in drawings.
const SIDES: u32 = 32;

/// Rotation about x that turns y to z: the library has cylinders along y.
const FROM_Y: f64 = std::f64::consts::FRAC_PI_2;

/// Closed surface of triangles, with the tree of boxes that distances to it are found with.
#[derive(Clone)]
pub struct ClosedMesh(Arc<TriMesh>);

/// Triangles that are no closed surface; the text follows the name of the mesh.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum MeshError {
    /// No triangles.
    #[error("has no triangles")]
    Empty,
    /// Edges that do not belong to two triangles.
    #[error("is open: {edges} of its edges do not belong to two triangles, the first near ({x:.4}, {y:.4}, {z:.4}) m")]
    Open {
        /// Number of such edges.
        edges: usize,
        /// Middle of the first one [m].
        x: f64,
        /// Middle of the first one [m].
        y: f64,
        /// Middle of the first one [m].
        z: f64,
    },
    /// Triangles whose sides are not consistently inside and outside.
    #[error("has triangles that do not agree which side is inside")]
    Orientation,
}

impl ClosedMesh {
    /// Closed surface of triangles, three corners each [m]. Equal corners are one vertex; triangles without area are left
    /// out.
    ///
    /// # Errors
    /// [`MeshError`].
    pub fn of_triangles(triangles: &[[Vec3; 3]]) -> Result<Self, MeshError> {
        // Vertices by their digits: files repeat a vertex in every triangle.
        let mut numbers: BTreeMap<[u64; 3], u32> = BTreeMap::new();
        let mut vertices = Vec::new();
        let mut number_of = |corner: &Vec3| {
            // Both zeros are one number.
            let digits = [corner.x + 0.0, corner.y + 0.0, corner.z + 0.0].map(f64::to_bits);
            *numbers.entry(digits).or_insert_with(|| {
                vertices.push(vector(corner));
                (vertices.len() - 1) as u32
            })
        };
        let faces: Vec<[u32; 3]> = triangles
            .iter()
            .map(|[a, b, c]| [number_of(a), number_of(b), number_of(c)])
            .filter(|[a, b, c]| a != b && b != c && c != a)
            .collect();

        if faces.is_empty() {
            return Err(MeshError::Empty);
        }
        refuse_open_edges(&faces, &vertices)?;
        let outward =
            if signed_volume(&faces, &vertices) < 0.0 { |[a, b, c]: [u32; 3]| [a, c, b] } else { |face| face };
        let faces = faces.into_iter().map(outward).collect();
        let mesh = TriMesh::with_flags(vertices, faces, TriMeshFlags::ORIENTED);
        mesh.map(|mesh| Self(Arc::new(mesh))).map_err(|_| MeshError::Orientation)
    }

    /// Largest distance of two corners along an axis [m].
    pub fn size(&self) -> f64 {
        self.0.local_aabb().extents().max_element()
    }
}

/// Refuses a surface with edges that do not belong to two triangles.
fn refuse_open_edges(faces: &[[u32; 3]], vertices: &[Vector]) -> Result<(), MeshError> {
    let mut uses: BTreeMap<[u32; 2], usize> = BTreeMap::new();
    for [a, b, c] in faces {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            *uses.entry([*from.min(to), *from.max(to)]).or_default() += 1;
        }
    }
    let mut open = uses.iter().filter(|(_, count)| *count % 2 == 1).map(|(edge, _)| edge);
    let Some([from, to]) = open.next() else { return Ok(()) };
    let middle = (vertices[*from as usize] + vertices[*to as usize]) * 0.5;
    Err(MeshError::Open { edges: 1 + open.count(), x: middle.x, y: middle.y, z: middle.z })
}

/// Volume with the sign of the order of the corners.
fn signed_volume(faces: &[[u32; 3]], vertices: &[Vector]) -> f64 {
    let corner = |i: u32| vertices[i as usize];
    faces.iter().map(|[a, b, c]| corner(*a).dot(corner(*b).cross(corner(*c)))).sum::<f64>() / 6.0
}

impl PartialEq for ClosedMesh {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
            || self.0.vertices() == other.0.vertices() && self.0.indices() == other.0.indices()
    }
}

impl fmt::Debug for ClosedMesh {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Mesh of {} triangles", self.0.num_triangles())
    }
}

/// Distances that have to be kept free between cables, platform and obstacles [m].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RequiredClearance {
    /// Between the surfaces of two cables.
    pub cables: f64,
    /// Between a cable and the platform.
    pub platform: f64,
    /// Between an obstacle and a cable or the platform.
    pub obstacles: f64,
    /// Length of cable at an end that is not compared with what this end is mounted on: the platform, an obstacle nearer
    /// than this to the anchor, a cable whose same end is nearer than this; `None` for the share
    /// [`RequiredClearance::FROM_END`] of the platform's length.
    pub from_end: Option<f64>,
}

impl RequiredClearance {
    /// Share of the platform's length by which the ends of cables are left out if the file says nothing: an eyelet or a
    /// swivel pulley takes a few centimetres of a platform of a metre.
    pub const FROM_END: f64 = 0.1;
}

/// Vector of the library.
pub(crate) fn vector(of: &Vec3) -> Vector {
    Vector::new(of.x, of.y, of.z)
}

/// Vector from the library.
pub(crate) fn from_vector(of: Vector) -> Vec3 {
    Vec3::new(of.x, of.y, of.z)
}

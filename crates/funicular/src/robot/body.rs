//! Solid bodies: obstacles in the world, and parts of the platform.

use super::Pose;
use super::mesh::{ClosedMesh, from_vector, vector};
use crate::math::{Rotation, Vec3};
use parry3d_f64::math::Vector;
use parry3d_f64::shape::{Cuboid, Cylinder, HalfSpace, SharedShape};
use std::sync::Arc;

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
        (
            "box",
            "box with the edges `size_m`, its centre at `position_m`; or along the line from `from_m` to `to_m`, with \
             `width_m` and `height_m` across it",
        ),
        (
            "cylinder",
            "cylinder with `diameter_m` and `length_m` along its z axis, its centre at `position_m`; or with \
             `diameter_m` along the line from `from_m` to `to_m`",
        ),
        (
            "half-space",
            "everything below the x-y plane of its frame, which goes through `position_m`: a floor or a wall",
        ),
        ("mesh", "closed surface of the STL file `file`, whose origin is placed at `position_m`"),
    ];

    /// Word of the robot file.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Box { .. } => "box",
            Self::Cylinder { .. } => "cylinder",
            Self::HalfSpace => "half-space",
            Self::Mesh(_) => "mesh",
        }
    }

    /// Shapes of the library whose union is the solid, and the rotation of their frame in that of the solid. A mesh
    /// may have several.
    pub(crate) fn shapes(&self) -> (Vec<SharedShape>, Rotation) {
        let unturned = |shape| (vec![shape], Rotation::identity());
        match self {
            Self::Box { half } => unturned(SharedShape(Arc::new(Cuboid::new(vector(half))))),
            Self::Cylinder { radius, half_length } => {
                let turn = Rotation::from_axis_angle(&Vec3::x_axis(), FROM_Y);
                (vec![SharedShape(Arc::new(Cylinder::new(*half_length, *radius)))], turn)
            }
            Self::HalfSpace => unturned(SharedShape(Arc::new(HalfSpace::new(Vector::Z)))),
            Self::Mesh(mesh) => {
                (mesh.parts().iter().map(|part| SharedShape(part.clone())).collect(), Rotation::identity())
            }
        }
    }
}

impl Body {
    /// Distance of a point inside the body from its surface [m]; zero outside. The point is in the frame in which the
    /// body stands.
    pub(super) fn depth_inside(&self, point: &Vec3) -> f64 {
        let (shapes, turn) = self.solid.shapes();
        let local = vector(&(turn.inverse() * (self.pose.rot_wp.inverse() * (point - self.pose.position_w))));
        let depth = |shape: &SharedShape| {
            let projected = shape.project_local_point(local, false);
            if projected.is_inside { (projected.point - local).length() } else { 0.0 }
        };
        shapes.iter().map(depth).fold(0.0, f64::max)
    }
}

impl Body {
    /// Triangles of the surface, three corners each, in the frame in which the body stands [m]; a cylinder as a prism,
    /// and none for a half space.
    pub fn triangles(&self) -> Vec<[Vec3; 3]> {
        let turn = self.solid.shapes().1;
        let (vertices, faces) = match &self.solid {
            Solid::Box { half } => Cuboid::new(vector(half)).to_trimesh(),
            Solid::Cylinder { radius, half_length } => Cylinder::new(*half_length, *radius).to_trimesh(SIDES),
            Solid::HalfSpace => return Vec::new(),
            Solid::Mesh(mesh) => {
                let of_parts = mesh.parts().iter().flat_map(|part| part.triangles());
                return of_parts
                    .map(|of| [of.a, of.b, of.c].map(|corner| self.pose.point_w(&from_vector(corner))))
                    .collect();
            }
        };
        let placed = |i: u32| self.pose.point_w(&(turn * from_vector(vertices[i as usize])));
        faces.into_iter().map(|face| face.map(placed)).collect()
    }
}

/// Number of sides of the prism that stands for a cylinder in drawings.
const SIDES: u32 = 32;

/// Rotation about x that turns y to z: the library has cylinders along y.
const FROM_Y: f64 = std::f64::consts::FRAC_PI_2;

/// Distances that have to be kept free between cables, platform and obstacles [m].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RequiredClearance {
    /// Between the surfaces of two cables.
    pub cables: f64,
    /// Between a cable and the platform.
    pub platform: f64,
    /// Between an obstacle and a cable or the platform.
    pub obstacles: f64,
    /// Length of cable at an end that is not compared with what this end is mounted on: the platform, an obstacle
    /// nearer than this to the anchor, a cable whose same end is nearer than this; `None` for the share
    /// [`RequiredClearance::FROM_END`] of the platform's length.
    pub from_end: Option<f64>,
}

impl RequiredClearance {
    /// Share of the platform's length by which the ends of cables are left out if the file says nothing: an eyelet or a
    /// swivel pulley takes a few centimetres of a platform of a metre.
    pub const FROM_END: f64 = 0.1;
}

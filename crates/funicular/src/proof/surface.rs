//! Surface of what is proved inside: faces of its boxes beyond which nothing is.

use super::{BoxVerdict, PositionBox, ProofSearch};
use crate::math::Vec3;
use std::collections::HashMap;

/// Surface of rectangles along the axes, as triangles.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FaceMesh {
    /// Corners [m].
    pub vertices: Vec<Vec3>,
    /// Triangles by the numbers of their corners, counterclockwise from outside.
    pub triangles: Vec<[usize; 3]>,
}

impl FaceMesh {
    /// Enclosed volume [m³].
    pub fn volume(&self) -> f64 {
        let of = |[a, b, c]: &[usize; 3]| self.vertices[*a].dot(&self.vertices[*b].cross(&self.vertices[*c])) / 6.0;
        self.triangles.iter().map(of).sum()
    }
}

impl ProofSearch {
    /// Surface of the set that is proved inside; empty for a box without a volume.
    pub fn surface(&self) -> FaceMesh {
        let (mut mesh, mut known) = (FaceMesh::default(), HashMap::new());
        for inside in self.boxes().filter(|of| matches!(of.verdict, BoxVerdict::Inside(_))) {
            let sides = inside.region.upper - inside.region.lower;
            if sides.min() <= 0.0 {
                continue;
            }
            for (axis, is_upper) in (0..3).flat_map(|axis| [(axis, false), (axis, true)]) {
                let mut face = inside.region;
                let at = if is_upper { face.upper[axis] } else { face.lower[axis] };
                (face.lower[axis], face.upper[axis]) = (at, at);
                for part in self.bare_parts(&face, axis, is_upper) {
                    add(&mut mesh, &mut known, &part, axis, is_upper);
                }
            }
        }
        mesh
    }
}

/// Adds a rectangle as two triangles.
fn add(mesh: &mut FaceMesh, known: &mut HashMap<[u64; 3], usize>, face: &PositionBox, axis: usize, is_upper: bool) {
    let (across, up) = ((axis + 1) % 3, (axis + 2) % 3);
    let corner = |right: bool, top: bool| {
        let mut at = face.lower;
        at[across] = if right { face.upper[across] } else { face.lower[across] };
        at[up] = if top { face.upper[up] } else { face.lower[up] };
        at
    };
    let mut number = |at: Vec3| {
        // A zero has one sign.
        let key = [at.x + 0.0, at.y + 0.0, at.z + 0.0].map(f64::to_bits);
        *known.entry(key).or_insert_with(|| {
            mesh.vertices.push(at);
            mesh.vertices.len() - 1
        })
    };
    let [a, b, c, d] =
        [corner(false, false), corner(true, false), corner(true, true), corner(false, true)].map(&mut number);
    let faces = if is_upper { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] };
    mesh.triangles.extend(faces);
}

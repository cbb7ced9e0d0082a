//! Closed surfaces of triangles: solids, whatever way their triangles turn in the file.

use crate::math::Vec3;
use parry3d_f64::bounding_volume::{Aabb, BoundingVolume};
use parry3d_f64::math::Vector;
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::{TriMesh, TriMeshFlags};
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;
use thiserror::Error;

/// Solid inside of closed surfaces of triangles, with the trees of boxes that distances to it are found with.
///
/// Triangles that share edges are one surface, which is turned outward as a whole. Surfaces may overlap: the solid is
/// everything that is inside of one. A surface in another one is a cavity if it turns the other way in the file.
#[derive(Clone)]
pub struct ClosedMesh(Vec<Arc<TriMesh>>);

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
    /// Triangles that cannot all be turned so that neighbours agree.
    #[error(
        "has triangles near ({x:.4}, {y:.4}, {z:.4}) m that turn the other way than their neighbours, so that neither \
         side is the inside"
    )]
    Turned {
        /// Middle of an edge between them [m].
        x: f64,
        /// Middle of an edge between them [m].
        y: f64,
        /// Middle of an edge between them [m].
        z: f64,
    },
    /// Triangles from which the library of shapes makes no surface.
    #[error("has triangles that do not agree which side is inside")]
    Orientation,
}

impl ClosedMesh {
    /// Closed surfaces of triangles, three corners each [m]. Equal corners are one vertex; triangles without area are
    /// left out.
    ///
    /// # Errors
    /// [`MeshError`].
    pub fn of_triangles(triangles: &[[Vec3; 3]]) -> Result<Self, MeshError> {
        let mut mesh = Faces::of(triangles);
        if mesh.faces.is_empty() {
            return Err(MeshError::Empty);
        }
        let solids = MeshSurface::solids(mesh.surfaces()?, &mut mesh)?;

        // Solids whose boxes do not meet share a tree; those that may overlap have trees of their own.
        let mut parts: Vec<(Vec<Aabb>, Vec<usize>)> = Vec::new();
        for MeshSurface { faces, reach, .. } in solids {
            match parts.iter_mut().find(|(others, _)| others.iter().all(|other| !other.intersects(&reach))) {
                Some((others, all)) => {
                    others.push(reach);
                    all.extend(faces);
                }
                None => parts.push((vec![reach], faces)),
            }
        }
        let tree = |(_, mut faces): (Vec<Aabb>, Vec<usize>)| {
            faces.sort_unstable();
            mesh.tree(&faces).map(Arc::new)
        };
        parts.into_iter().map(tree).collect::<Result<_, _>>().map(Self)
    }

    /// Parts whose union is the solid.
    pub(super) fn parts(&self) -> &[Arc<TriMesh>] {
        &self.0
    }

    /// Largest distance of two corners along an axis [m].
    pub fn size(&self) -> f64 {
        let boxes = self.0.iter().map(|part| part.local_aabb());
        boxes.reduce(|one, other| one.merged(&other)).map_or(0.0, |of_all| of_all.extents().max_element())
    }
}

impl PartialEq for ClosedMesh {
    fn eq(&self, other: &Self) -> bool {
        let equal = |(one, two): (&Arc<TriMesh>, &Arc<TriMesh>)| {
            Arc::ptr_eq(one, two) || one.vertices() == two.vertices() && one.indices() == two.indices()
        };
        self.0.len() == other.0.len() && self.0.iter().zip(&other.0).all(equal)
    }
}

impl fmt::Debug for ClosedMesh {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Mesh of {} triangles", self.0.iter().map(|part| part.num_triangles()).sum::<usize>())
    }
}

/// Triangles by the numbers of their vertices.
struct Faces {
    vertices: Vec<Vector>,
    faces: Vec<[u32; 3]>,
}

/// Use of an edge by a triangle.
#[derive(Clone, Copy)]
struct EdgeUse {
    face: usize,
    /// True if the triangle goes from the lower to the higher number of its vertices.
    is_forward: bool,
}

/// Triangles that share edges and turn the same way: a closed surface, or a piece of one up to edges of more than two
/// triangles.
struct MeshSurface {
    faces: Vec<usize>,
    /// Volume inside, negative if the triangles turn inward as most of their area does in the file [m³].
    volume: f64,
    reach: Aabb,
}

impl Faces {
    fn of(triangles: &[[Vec3; 3]]) -> Self {
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
        let faces = triangles
            .iter()
            .map(|[a, b, c]| [number_of(a), number_of(b), number_of(c)])
            .filter(|[a, b, c]| a != b && b != c && c != a)
            .collect();
        Self { vertices, faces: without_walls(faces) }
    }

    /// Closed surfaces, whose triangles are turned so that neighbours agree, as most of their area in the file.
    fn surfaces(&mut self) -> Result<Vec<MeshSurface>, MeshError> {
        let mut uses: BTreeMap<[u32; 2], Vec<EdgeUse>> = BTreeMap::new();
        for (face, [a, b, c]) in self.faces.iter().enumerate() {
            for [from, to] in [[a, b], [b, c], [c, a]] {
                let of = EdgeUse { face, is_forward: from < to };
                uses.entry([*from.min(to), *from.max(to)]).or_default().push(of);
            }
        }
        let mut open = uses.iter().filter(|(_, uses)| uses.len() % 2 == 1).map(|(edge, _)| edge);
        if let Some(first) = open.next() {
            let middle = self.middle(*first);
            return Err(MeshError::Open { edges: 1 + open.count(), x: middle.x, y: middle.y, z: middle.z });
        }

        let mut neighbours: Vec<Vec<(usize, bool)>> = vec![Vec::new(); self.faces.len()];
        for uses in uses.values() {
            if let [one, two] = uses[..] {
                let agree = one.is_forward != two.is_forward;
                neighbours[one.face].push((two.face, agree));
                neighbours[two.face].push((one.face, agree));
            }
        }
        let pieces = self.pieces(&neighbours)?;
        let pieces = self.joined(pieces, &uses)?;
        Ok(pieces.into_iter().map(|faces| self.surface(faces)).collect())
    }

    /// Pieces of surfaces up to edges of more than two triangles. `neighbours` are the triangles beyond the edges of
    /// each one, and whether both turn the same way.
    fn pieces(&mut self, neighbours: &[Vec<(usize, bool)>]) -> Result<Vec<Vec<usize>>, MeshError> {
        // Whether a triangle has to be turned, from the first one of each piece on.
        let mut turned: Vec<Option<bool>> = vec![None; self.faces.len()];
        let mut pieces = Vec::new();
        for first in 0..self.faces.len() {
            if turned[first].is_some() {
                continue;
            }
            turned[first] = Some(false);
            let (mut piece, mut at) = (vec![first], 0);
            while let Some(&face) = piece.get(at) {
                at += 1;
                let is_turned = turned[face] == Some(true);
                for &(other, agree) in &neighbours[face] {
                    let needed = is_turned == agree;
                    match turned[other] {
                        None => {
                            turned[other] = Some(needed);
                            piece.push(other);
                        }
                        Some(known) if known != needed => return Err(self.disagreement(face, other)),
                        Some(_) => {}
                    }
                }
            }

            // Most of the area keeps its direction.
            let area = |is_turned: bool| -> f64 {
                piece.iter().filter(|face| turned[**face] == Some(is_turned)).map(|face| self.area(*face)).sum()
            };
            let mostly = area(true) > area(false);
            for face in &piece {
                if turned[*face] == Some(!mostly) {
                    self.turn(*face);
                }
            }
            pieces.push(piece);
        }
        Ok(pieces)
    }

    /// Joins the pieces that are closed only together, at edges of more than two triangles.
    fn joined(
        &self,
        pieces: Vec<Vec<usize>>,
        uses: &BTreeMap<[u32; 2], Vec<EdgeUse>>,
    ) -> Result<Vec<Vec<usize>>, MeshError> {
        let mut piece_of = vec![0; self.faces.len()];
        for (k, piece) in pieces.iter().enumerate() {
            for face in piece {
                piece_of[*face] = k;
            }
        }
        let mut group_of: Vec<usize> = (0..pieces.len()).collect();
        for (edge, uses) in uses.iter().filter(|(_, uses)| uses.len() > 2) {
            let mut balance: BTreeMap<usize, i32> = BTreeMap::new();
            for of in uses {
                let is_forward = self.goes_forward(of.face, *edge);
                *balance.entry(piece_of[of.face]).or_default() += if is_forward { 1 } else { -1 };
            }
            if balance.values().sum::<i32>() != 0 {
                let middle = self.middle(*edge);
                return Err(MeshError::Turned { x: middle.x, y: middle.y, z: middle.z });
            }
            // A piece that turns back at the edge is closed there by itself.
            let mut open = balance.into_iter().filter(|(_, sum)| *sum != 0).map(|(piece, _)| group_of[piece]);
            if let Some(first) = open.next() {
                let others: Vec<usize> = open.collect();
                group_of.iter_mut().filter(|group| others.contains(group)).for_each(|group| *group = first);
            }
        }

        let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (k, piece) in pieces.into_iter().enumerate() {
            groups.entry(group_of[k]).or_default().extend(piece);
        }
        Ok(groups.into_values().collect())
    }

    /// Closed surface of triangles that turn the same way.
    fn surface(&self, faces: Vec<usize>) -> MeshSurface {
        let corners = |face: usize| self.faces[face].map(|i| self.vertices[i as usize]);
        let origin = corners(faces[0])[0];
        let cone = |face: &usize| {
            let [a, b, c] = corners(*face).map(|corner| corner - origin);
            a.dot(b.cross(c)) / 6.0
        };
        let volume = faces.iter().map(cone).sum();
        let reach = faces.iter().fold(Aabb::new(origin, origin), |mut reach, face| {
            for corner in corners(*face) {
                reach.take_point(corner);
            }
            reach
        });
        MeshSurface { faces, volume, reach }
    }

    /// Tree of some triangles, with the vertices that they use.
    fn tree(&self, faces: &[usize]) -> Result<TriMesh, MeshError> {
        let mut numbers: Vec<Option<u32>> = vec![None; self.vertices.len()];
        let mut vertices = Vec::new();
        let mut number_of = |i: u32| {
            *numbers[i as usize].get_or_insert_with(|| {
                vertices.push(self.vertices[i as usize]);
                (vertices.len() - 1) as u32
            })
        };
        let faces = faces.iter().map(|face| self.faces[*face].map(&mut number_of)).collect();
        TriMesh::with_flags(vertices, faces, TriMeshFlags::ORIENTED).map_err(|_| MeshError::Orientation)
    }

    fn turn(&mut self, face: usize) {
        self.faces[face].swap(1, 2);
    }

    /// Twice the area of a triangle [m²].
    fn area(&self, face: usize) -> f64 {
        let [a, b, c] = self.faces[face].map(|i| self.vertices[i as usize]);
        (b - a).cross(c - a).length()
    }

    /// True if a triangle goes along one of its edges from the lower to the higher number.
    fn goes_forward(&self, face: usize, edge: [u32; 2]) -> bool {
        let [a, b, c] = self.faces[face];
        [[a, b], [b, c], [c, a]].contains(&edge)
    }

    fn middle(&self, [from, to]: [u32; 2]) -> Vec3 {
        from_vector((self.vertices[from as usize] + self.vertices[to as usize]) * 0.5)
    }

    /// Error about two triangles with a common edge.
    fn disagreement(&self, face: usize, other: usize) -> MeshError {
        let shared: Vec<u32> = self.faces[face].into_iter().filter(|i| self.faces[other].contains(i)).collect();
        let middle = self.middle([shared[0], shared[shared.len() - 1]]);
        MeshError::Turned { x: middle.x, y: middle.y, z: middle.z }
    }
}

/// Triangles without those that occur twice: of two with the same direction one remains, and two of opposite directions
/// are a wall between two solids that touch, inside of their union.
fn without_walls(faces: Vec<[u32; 3]>) -> Vec<[u32; 3]> {
    let mut known: BTreeMap<[u32; 3], Vec<usize>> = BTreeMap::new();
    let mut remains = vec![true; faces.len()];
    for (k, face) in faces.iter().enumerate() {
        let mut corners = *face;
        corners.sort_unstable();
        let same = known.entry(corners).or_default();
        let is_even = |[a, b, c]: &[u32; 3]| (a < b) == ((b < c) == (a < c));
        match same.last() {
            Some(other) if is_even(&faces[*other]) == is_even(face) => remains[k] = false,
            Some(other) => {
                (remains[k], remains[*other]) = (false, false);
                same.pop();
            }
            None => same.push(k),
        }
    }
    faces.into_iter().zip(remains).filter_map(|(face, remains)| remains.then_some(face)).collect()
}

impl MeshSurface {
    /// Solids inside of surfaces: each with the cavities in it, turned outward and the cavities inward.
    fn solids(surfaces: Vec<Self>, mesh: &mut Faces) -> Result<Vec<Self>, MeshError> {
        // Surfaces around each one, the largest first.
        let mut order: Vec<usize> = (0..surfaces.len()).collect();
        order.sort_by(|i, j| surfaces[*j].volume.abs().total_cmp(&surfaces[*i].volume.abs()));
        let mut around: Vec<Vec<usize>> = vec![Vec::new(); surfaces.len()];
        for (place, outer) in order.iter().enumerate() {
            let inner: Vec<usize> = order[place + 1..]
                .iter()
                .copied()
                .filter(|inner| surfaces[*outer].reach.contains(&surfaces[*inner].reach))
                .collect();
            if inner.is_empty() {
                continue;
            }
            // Either side shows whether a point is inside.
            let tree = mesh.tree(&surfaces[*outer].faces)?;
            let is_inward = surfaces[*outer].volume < 0.0;
            for i in inner {
                let corner = mesh.vertices[mesh.faces[surfaces[i].faces[0]][0] as usize];
                if tree.contains_local_point(corner) != is_inward {
                    around[i].push(*outer);
                }
            }
        }

        let is_cavity: Vec<bool> = (0..surfaces.len())
            .map(|i| around[i].first().is_some_and(|root| surfaces[*root].volume * surfaces[i].volume < 0.0))
            .collect();
        for (surface, is_cavity) in surfaces.iter().zip(&is_cavity) {
            if (surface.volume < 0.0) != *is_cavity {
                surface.faces.iter().for_each(|face| mesh.turn(*face));
            }
        }

        // The smallest solid around a cavity is the one that has it.
        let mut solids: Vec<Option<Self>> = surfaces.into_iter().map(Some).collect();
        for i in (0..solids.len()).filter(|i| is_cavity[*i]) {
            let owner = around[i].iter().rev().find(|outer| !is_cavity[**outer]);
            let Some(cavity) = solids[i].take() else { continue };
            if let Some(solid) = owner.and_then(|owner| solids[*owner].as_mut()) {
                solid.faces.extend(cavity.faces);
            }
        }
        Ok(solids.into_iter().flatten().collect())
    }
}

/// Vector of the library.
pub(crate) fn vector(of: &Vec3) -> Vector {
    Vector::new(of.x, of.y, of.z)
}

/// Vector from the library.
pub(crate) fn from_vector(of: Vector) -> Vec3 {
    Vec3::new(of.x, of.y, of.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Box about a place: twelve triangles that turn outward.
    fn cuboid(middle: [f64; 3], half: f64) -> Vec<[Vec3; 3]> {
        let corner = |bits: usize| Vec3::from_fn(|k, _| middle[k] + if bits & (1 << k) == 0 { -half } else { half });
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]);
        triangles.map(|triangle| triangle.map(corner)).collect()
    }

    fn turned(mut triangles: Vec<[Vec3; 3]>, which: impl Fn(usize) -> bool) -> Vec<[Vec3; 3]> {
        let chosen = triangles.iter_mut().enumerate().filter(|(k, _)| which(*k));
        chosen.for_each(|(_, triangle)| triangle.swap(0, 1));
        triangles
    }

    /// Height of a point over the surface of the solid, negative inside.
    fn height(mesh: &ClosedMesh, point: [f64; 3]) -> f64 {
        let point = Vector::new(point[0], point[1], point[2]);
        let of_part = |part: &Arc<TriMesh>| {
            let projected = part.project_local_point(point, false);
            (projected.point - point).length() * if projected.is_inside { -1.0 } else { 1.0 }
        };
        mesh.parts().iter().map(of_part).fold(f64::INFINITY, f64::min)
    }

    const POINTS: [[f64; 3]; 4] = [[0.1, 0.2, -0.3], [0.0, 0.0, 0.9], [3.0, 0.1, 0.2], [0.4, -0.7, 0.0]];

    #[test]
    fn every_choice_of_turned_triangles_of_a_box_gives_the_same_solid() {
        let right = ClosedMesh::of_triangles(&cuboid([0.0; 3], 1.0)).unwrap();
        for subset in 0..4096_usize {
            let mesh = ClosedMesh::of_triangles(&turned(cuboid([0.0; 3], 1.0), |k| subset & (1 << k) != 0)).unwrap();
            for point in POINTS {
                assert!((height(&mesh, point) - height(&right, point)).abs() < 1e-15, "{subset} {point:?}");
            }
        }
    }

    #[test]
    fn solids_of_one_file_are_united_wherever_they_are() {
        // Apart, overlapping, inside of the other, and touching along a face whose corners are the same.
        for (middle, half) in
            [([5.0, 0.0, 0.0], 1.0), ([1.5, 0.0, 0.0], 1.0), ([0.2, 0.0, 0.0], 0.5), ([2.0, 0.0, 0.0], 1.0)]
        {
            for inside_out in [0..0, 0..12, 12..24, 3..4] {
                let both = [cuboid([0.0; 3], 1.0), cuboid(middle, half)].concat();
                let shared = (middle[0] - 2.0).abs() < 1e-12 && !inside_out.is_empty();
                let nested = half < 1.0 && inside_out.len() == 12;
                if shared || nested {
                    continue;
                }
                let mesh = ClosedMesh::of_triangles(&turned(both, |k| inside_out.contains(&k))).unwrap();
                for point in [[0.5, 0.3, 0.0], [1.6, 0.1, 0.2], [5.2, 0.0, 0.1], [2.7, 0.3, 0.3], [-0.9, 0.9, 0.2]] {
                    let inside = |middle: [f64; 3], half: f64| (0..3).all(|k| (point[k] - middle[k]).abs() < half);
                    let expected = inside([0.0; 3], 1.0) || inside(middle, half);
                    assert_eq!(height(&mesh, point) < 0.0, expected, "{middle:?} {inside_out:?} {point:?}");
                }
            }
        }
    }

    #[test]
    fn a_surface_that_turns_the_other_way_in_another_one_is_a_cavity() {
        let room = [cuboid([0.0; 3], 3.0), turned(cuboid([0.0; 3], 2.0), |_| true), cuboid([0.0; 3], 0.5)].concat();
        for inside_out in [false, true] {
            let mesh = ClosedMesh::of_triangles(&turned(room.clone(), |_| inside_out)).unwrap();
            let cases =
                [([0.1, 0.0, 0.0], -0.4), ([1.0, 0.0, 0.1], 0.5), ([2.4, 0.0, 0.2], -0.4), ([4.0, 0.0, 0.0], 1.0)];
            for (point, expected) in cases {
                assert!((height(&mesh, point) - expected).abs() < 1e-14, "{point:?}");
            }
        }
    }

    #[test]
    fn triangles_that_cannot_agree_are_refused_with_their_place() {
        // A strip with half a turn, closed by a cone over its border, has one side only.
        let count = 12;
        let at = |k: usize, side: f64| {
            let angle = std::f64::consts::TAU * k as f64 / f64::from(count);
            let reach = 2.0 + 0.5 * side * (0.5 * angle).cos();
            Vec3::new(reach * angle.cos(), reach * angle.sin(), 0.5 * side * (0.5 * angle).sin())
        };
        let exact = |k: usize, side: f64| if k == count as usize { at(0, -side) } else { at(k, side) };
        let tip = Vec3::new(0.0, 0.0, 5.0);
        let mut triangles = Vec::new();
        for k in 0..count as usize {
            let [a, b, c, d] = [exact(k, -1.0), exact(k + 1, -1.0), exact(k + 1, 1.0), exact(k, 1.0)];
            triangles.extend([[a, b, c], [a, c, d], [a, b, tip], [d, c, tip]]);
        }
        let refused = ClosedMesh::of_triangles(&triangles);
        assert!(matches!(refused, Err(MeshError::Turned { .. })), "{refused:?}");
    }
}

//! Closed surface of a set: volume, area, centroid, parts and holes.

use crate::math::Vec3;
use std::collections::BTreeMap;

/// Boundary of a set as a closed surface of triangles, whose normals point outwards.
#[derive(Debug, Clone, PartialEq)]
pub struct BoundaryMesh {
    vertices: Vec<Vec3>,
    triangles: Vec<[usize; 3]>,
    /// Number of triangles on the boundary of the set itself; the others lie on the faces of the box.
    on_surface: usize,
}

/// Part of a set, or a hole in it: what one closed surface encloses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SetPart {
    /// Volume [m³]; that of a part includes its holes.
    pub volume: f64,
    /// Number of handles of its surface: 0 for a ball, 1 for a ring.
    pub handles: usize,
}

impl BoundaryMesh {
    /// Closed surface whose first `on_surface` triangles belong to the set itself, not to the faces of a box.
    pub(super) fn new(vertices: Vec<Vec3>, triangles: Vec<[usize; 3]>, on_surface: usize) -> Self {
        Self { vertices, triangles, on_surface }
    }

    /// Vertices.
    pub fn vertices(&self) -> &[Vec3] {
        &self.vertices
    }

    /// Triangles by the numbers of their vertices, counterclockwise seen from outside: first those of the set itself,
    /// then those on the faces of the box.
    pub fn triangles(&self) -> &[[usize; 3]] {
        &self.triangles
    }

    /// Number of triangles on the boundary of the set itself.
    pub fn on_surface(&self) -> usize {
        self.on_surface
    }

    /// Volume [m³], by the divergence theorem.
    pub fn volume(&self) -> f64 {
        let middle = self.middle();
        self.triangles.iter().map(|triangle| self.cone(*triangle, &middle)).sum()
    }

    /// Area of the boundary of the set itself [m²].
    pub fn area(&self) -> f64 {
        self.area_of(&self.triangles[..self.on_surface])
    }

    /// Area in which the faces of the box cut the set [m²].
    pub fn cut_area(&self) -> f64 {
        self.area_of(&self.triangles[self.on_surface..])
    }

    fn area_of(&self, triangles: &[[usize; 3]]) -> f64 {
        let area = |triangle: &[usize; 3]| {
            let [a, b, c] = triangle.map(|i| self.vertices[i]);
            0.5 * (b - a).cross(&(c - a)).norm()
        };
        triangles.iter().map(area).sum()
    }

    /// Centroid of the volume; `None` without a volume.
    pub fn centroid(&self) -> Option<Vec3> {
        let middle = self.middle();
        let mut moment = Vec3::zeros();
        for triangle in &self.triangles {
            // The centroid of a tetrahedron is the mean of its corners, one of which is the middle.
            let sum: Vec3 = triangle.iter().map(|i| self.vertices[*i] - middle).sum();
            moment += 0.25 * sum * self.cone(*triangle, &middle);
        }
        let volume = self.volume();
        (volume > 0.0).then(|| middle + moment / volume)
    }

    /// Corners of the smallest box along the axes around the set; `None` for an empty set.
    pub fn bounds(&self) -> Option<[Vec3; 2]> {
        let first = *self.vertices.first()?;
        Some(self.vertices.iter().fold([first, first], |[low, high], vertex| [low.inf(vertex), high.sup(vertex)]))
    }

    /// Parts of the set that do not touch each other, the largest first.
    pub fn parts(&self) -> Vec<SetPart> {
        self.pieces().into_iter().filter(|piece| piece.volume > 0.0).collect()
    }

    /// Holes of the set, which the outside does not reach, the largest first.
    pub fn holes(&self) -> Vec<SetPart> {
        let holes = self.pieces().into_iter().filter(|piece| piece.volume < 0.0);
        holes.map(|piece| SetPart { volume: -piece.volume, ..piece }).collect()
    }

    /// Closed surfaces that do not touch each other; the volume of a hole is negative.
    fn pieces(&self) -> Vec<SetPart> {
        let mut pieces: BTreeMap<usize, (f64, usize, usize)> = BTreeMap::new();
        let of_vertex = self.connected();
        for piece in &of_vertex {
            pieces.entry(*piece).or_default().1 += 1;
        }
        for triangle in &self.triangles {
            let (volume, _, triangles) = pieces.entry(of_vertex[triangle[0]]).or_default();
            *volume += self.cone(*triangle, &self.vertices[of_vertex[triangle[0]]]);
            *triangles += 1;
        }

        // Euler: vertices − edges + triangles = 2 − 2·handles, with three edges per two triangles.
        let part = |(volume, vertices, triangles): (f64, usize, usize)| SetPart {
            volume,
            handles: (2 + triangles / 2).saturating_sub(vertices) / 2,
        };
        let mut parts: Vec<SetPart> = pieces.into_values().map(part).collect();
        parts.sort_by(|a, b| b.volume.abs().total_cmp(&a.volume.abs()));
        parts
    }

    /// For each vertex, the smallest vertex to which triangles connect it.
    fn connected(&self) -> Vec<usize> {
        fn first(of: &mut [usize], mut vertex: usize) -> usize {
            while of[vertex] != vertex {
                of[vertex] = of[of[vertex]];
                vertex = of[vertex];
            }
            vertex
        }
        let mut of: Vec<usize> = (0..self.vertices.len()).collect();
        for [a, b, c] in &self.triangles {
            for (from, to) in [(a, b), (b, c)] {
                let (from, to) = (first(&mut of, *from), first(&mut of, *to));
                of[from.max(to)] = from.min(to);
            }
        }
        (0..of.len()).map(|vertex| first(&mut of, vertex)).collect()
    }

    /// Volume between a triangle and a point, positive if the point lies behind it.
    fn cone(&self, triangle: [usize; 3], apex: &Vec3) -> f64 {
        let [a, b, c] = triangle.map(|i| self.vertices[i] - apex);
        a.dot(&b.cross(&c)) / 6.0
    }

    /// Mean of the vertices, about which volumes are summed: sums about a far point would lose digits.
    fn middle(&self) -> Vec3 {
        self.vertices.iter().sum::<Vec3>() / self.vertices.len().max(1) as f64
    }
}

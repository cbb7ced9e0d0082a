//! Directions that cover a sphere evenly: a solid of triangles, each of which is cut into four several times.

use super::boundary::BoundaryMesh;
use crate::math::Vec3;
use std::collections::HashMap;

/// Largest number of directions.
const MAX_DIRECTIONS: usize = 200_000;

/// Directions from the centre of a sphere, with the triangles between them.
#[derive(Debug, Clone, PartialEq)]
pub struct Sphere {
    directions: Vec<Vec3>,
    triangles: Vec<[usize; 3]>,
}

impl Sphere {
    /// Sphere with a number of directions: 12, 42, 162, 642, 2562 … from an icosahedron, or 6, 18, 66, 258, 1026 … from
    /// an octahedron; `None` for another number.
    pub fn with_directions(count: usize) -> Option<Self> {
        let is_wanted = |sphere: &Self| sphere.directions.len() == count;
        [Self::octahedron(), Self::icosahedron()].into_iter().find_map(|solid| {
            std::iter::successors(Some(solid), |sphere| {
                (sphere.directions.len() < count.min(MAX_DIRECTIONS)).then(|| sphere.halved())
            })
            .find(is_wanted)
        })
    }

    /// Numbers of directions for which there is a sphere, ascending.
    pub fn numbers() -> Vec<usize> {
        // Euler: a closed surface without handles has two corners more than half its triangles.
        let series = |faces: usize| (0..).map(move |k: u32| 2 + faces / 2 * 4_usize.pow(k));
        let up_to_max = |faces: usize| series(faces).take_while(|count| *count <= MAX_DIRECTIONS).collect::<Vec<_>>();
        let mut numbers = [up_to_max(8), up_to_max(20)].concat();
        numbers.sort_unstable();
        numbers
    }

    fn octahedron() -> Self {
        let directions = vec![Vec3::x(), -Vec3::x(), Vec3::y(), -Vec3::y(), Vec3::z(), -Vec3::z()];
        let triangles = vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
        Self { directions, triangles }
    }

    fn icosahedron() -> Self {
        let golden = f64::midpoint(1.0, 5.0_f64.sqrt());
        let mut directions = Vec::with_capacity(12);
        for (a, b) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
            directions
                .extend([Vec3::new(0.0, a, b), Vec3::new(a, b, 0.0), Vec3::new(b, 0.0, a)].map(|v| v.normalize()));
        }

        // Neighbours are nearer to each other than any other two corners; the faces are three neighbours.
        let cos_between = 1.0 / 5.0_f64.sqrt();
        let near = |i: usize, j: usize| directions[i].dot(&directions[j]) > cos_between - 1e-9;
        let mut triangles = Vec::with_capacity(20);
        for i in 0..12 {
            for j in i + 1..12 {
                for k in j + 1..12 {
                    if near(i, j) && near(j, k) && near(i, k) {
                        let outwards = directions[i].dot(&directions[j].cross(&directions[k])) > 0.0;
                        triangles.push(if outwards { [i, j, k] } else { [i, k, j] });
                    }
                }
            }
        }
        Self { directions, triangles }
    }

    /// Sphere whose triangles are cut into four at the middles of their edges.
    fn halved(&self) -> Self {
        let mut directions = self.directions.clone();
        let mut middles: HashMap<[usize; 2], usize> = HashMap::new();
        let mut triangles = Vec::with_capacity(4 * self.triangles.len());
        for [a, b, c] in &self.triangles {
            let [ab, bc, ca] = [[a, b], [b, c], [c, a]].map(|[from, to]| {
                *middles.entry([*from.min(to), *from.max(to)]).or_insert_with(|| {
                    directions.push((self.directions[*from] + self.directions[*to]).normalize());
                    directions.len() - 1
                })
            });
            triangles.extend([[*a, ab, ca], [ab, *b, bc], [ca, bc, *c], [ab, bc, ca]]);
        }
        Self { directions, triangles }
    }

    /// Unit vectors from the centre.
    pub fn directions(&self) -> &[Vec3] {
        &self.directions
    }

    /// Triangles between the directions, counterclockwise seen from outside.
    pub fn triangles(&self) -> &[[usize; 3]] {
        &self.triangles
    }

    /// Surface of triangles between points at these distances from a centre, one along each direction.
    pub fn hull(&self, center: Vec3, lengths: &[f64]) -> BoundaryMesh {
        let vertices = self.directions.iter().zip(lengths).map(|(ray, length)| center + ray * *length).collect();
        BoundaryMesh::new(vertices, self.triangles.clone(), self.triangles.len())
    }

    /// Solid angle of the share of each direction [sr]: a third of its triangles. They add up to 4π.
    pub fn solid_angles(&self) -> Vec<f64> {
        let mut angles = vec![0.0; self.directions.len()];
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|i| self.directions[i]);
            // A. van Oosterom, J. Strackee, The solid angle of a plane triangle, IEEE Trans. Biomed. Eng. 30 (1983).
            let angle = 2.0 * a.dot(&b.cross(&c)).atan2(1.0 + a.dot(&b) + b.dot(&c) + c.dot(&a));
            for i in triangle {
                angles[*i] += angle / 3.0;
            }
        }
        angles
    }
}

//! Sections of a set with planes along the axes.

use super::boundary::BoundaryMesh;
use crate::math::Vec3;
use std::collections::{BTreeMap, BTreeSet};

/// Section of a set with a plane at right angles to an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct SetSection {
    /// Closed polygons; seen against the axis they run counterclockwise around the set and clockwise around its holes.
    pub polygons: Vec<Vec<Vec3>>,
    /// Area of the set in the plane [m²].
    pub area: f64,
}

impl BoundaryMesh {
    /// Section with the plane in which coordinate `axis` (0, 1 or 2) has a value [m]. Faces of the set in this plane
    /// belong to it, whichever side of the plane they bound.
    pub fn section(&self, axis: usize, at: f64) -> SetSection {
        let mut segments = self.segments(axis, at);
        let mut polygons = Vec::new();
        while let Some((begin, (mut edge, point))) = segments.pop_first() {
            let mut polygon = vec![point];
            while edge != begin
                && let Some((next, point)) = segments.remove(&edge)
            {
                polygon.push(point);
                edge = next;
            }
            polygons.push(polygon);
        }
        let area = polygons.iter().map(|polygon| signed_area(polygon, axis)).sum();
        SetSection { polygons, area }
    }

    /// Segments in which the plane cuts the triangles: from the edge that goes down through the plane, with the point
    /// there, to the edge that goes up. Neighbours share an edge, which goes down in one and up in the other.
    fn segments(&self, axis: usize, at: f64) -> BTreeMap<[usize; 2], ([usize; 2], Vec3)> {
        // The set lies above a face in the plane that looks down, so the section passes just above its vertices;
        // elsewhere just below those in the plane.
        let height = |vertex: usize| self.vertices()[vertex][axis];
        let is_in_plane = |vertex: usize| height(vertex).total_cmp(&at).is_eq();
        let mut passes_above: BTreeSet<usize> = BTreeSet::new();
        for triangle in self.triangles().iter().filter(|triangle| triangle.iter().all(|i| is_in_plane(*i))) {
            let [a, b, c] = triangle.map(|i| self.vertices()[i]);
            if (b - a).cross(&(c - a))[axis] < 0.0 {
                passes_above.extend(triangle);
            }
        }
        let is_above = |vertex: usize| height(vertex) > at || is_in_plane(vertex) && !passes_above.contains(&vertex);
        let cut = |[a, b]: [usize; 2]| {
            let [from, to] = [a, b].map(|vertex| self.vertices()[vertex]);
            let rise = to[axis] - from[axis];
            let part = if rise == 0.0 { 0.5 } else { (at - from[axis]) / rise };
            let mut point = from + (to - from) * part;
            point[axis] = at;
            point
        };

        let mut segments = BTreeMap::new();
        for [a, b, c] in self.triangles() {
            let edges = [[*a, *b], [*b, *c], [*c, *a]];
            let down = edges.iter().find(|[from, to]| is_above(*from) && !is_above(*to));
            let up = edges.iter().find(|[from, to]| !is_above(*from) && is_above(*to));
            if let (Some(down), Some(up)) = (down, up) {
                let [down, up] = [down, up].map(|edge| [edge[0].min(edge[1]), edge[0].max(edge[1])]);
                segments.insert(down, (up, cut(down)));
            }
        }
        segments
    }
}

/// Area of a polygon in a plane at right angles to axis 0, 1 or 2 [m²], positive counterclockwise: for the polygons of
/// a section, positive around the set and negative around holes.
pub fn signed_area(polygon: &[Vec3], axis: usize) -> f64 {
    let first = polygon.first().copied().unwrap_or_default();
    let pairs = polygon.iter().zip(polygon.iter().skip(1));
    0.5 * pairs.map(|(a, b)| (a - first).cross(&(b - first))[axis]).sum::<f64>()
}

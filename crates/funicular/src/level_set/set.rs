//! The set on a grid: its nodes, the boundary between them, and how far the search came.

use super::boundary::BoundaryMesh;
use super::edge_root::EdgeRoot;
use super::grid::PointGrid;
use super::inner_box;
use super::nodes::GridNodes;
use super::tetrahedra::{self, CellVertex};
use super::{BOX_FACES, Evaluate};
use crate::math::Vec3;
use std::collections::HashMap;

/// End of a search.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SearchEnd {
    /// Everything was found.
    Complete,
    /// Search that was stopped before the vertices were at the zeros of the function: they lie between nodes as if it
    /// were linear there.
    Unpolished,
    /// Search that was stopped at larger steps than those of the grid.
    Coarse,
}

/// Edge of the grid: its first node, and the bits of the axes along which it goes on.
type Edge = (usize, usize);

/// Part of a box in which a function is not negative, found on a grid.
///
/// The grid is evaluated with steps of four times its own, after larger ones that give a set to show early, and with
/// its own only along the boundary that these show.
/// A part or a hole that lies between the nodes of the larger steps is therefore not found.
///
/// # Example
/// ```
/// use funicular::level_set::{LevelSet, PointGrid};
/// use funicular::math::Vec3;
///
/// // A ball of radius 1 m.
/// let grid = PointGrid::new(Vec3::repeat(-1.2), Vec3::repeat(1.2), [48; 3]).ok_or("no grid")?;
/// let inside = |point: &Vec3| Some(1.0 - point.norm());
/// let mut evaluate = |points: &[Vec3]| Some(points.iter().map(inside).collect());
/// let set = LevelSet::find(grid, 1e-9, &mut evaluate).ok_or("stopped")?;
/// let ball = set.boundary(1);
/// assert!((ball.volume() / (4.0 / 3.0 * std::f64::consts::PI) - 1.0).abs() < 1e-3);
/// assert_eq!((ball.parts().len(), set.touches()), (1, [false; 6]));
/// # Ok::<(), &str>(())
/// ```
///
/// # References
/// docs/theory.md, section 10b.
pub struct LevelSet {
    pub(super) grid: PointGrid,
    pub(super) nodes: GridNodes,
    /// Vertices of the boundary on the edges of the finest steps.
    vertices: HashMap<Edge, Vec3>,
    evaluations: usize,
    end: SearchEnd,
    /// Tolerance of the vertices along their edges [m].
    pub(super) tolerance: f64,
    /// Volume on the wrong side of the boundary by samples between the nodes [m³], with what their number leaves open.
    pub(super) sampled: Option<f64>,
}

impl LevelSet {
    /// Finds the set on a grid, with the vertices of its boundary to a tolerance along the edges [m]. `None` if the
    /// work was stopped before the first steps were done.
    pub fn find(grid: PointGrid, tolerance: f64, evaluate: &mut Evaluate<'_>) -> Option<Self> {
        let nodes = GridNodes::find(&grid, evaluate)?;
        let stride = nodes.stride;

        let edges = crossed_edges(&grid, &nodes);
        let mut roots: Vec<EdgeRoot> = edges.iter().map(|edge| root(&grid, &nodes, *edge, tolerance)).collect();
        let (polishing, found) = match stride {
            1 => EdgeRoot::find_all(&mut roots, tolerance, evaluate),
            _ => (0, false),
        };
        let vertices = edges.into_iter().zip(roots.iter().map(EdgeRoot::end)).collect();

        let end = match (stride, found) {
            (1, true) => SearchEnd::Complete,
            (1, false) => SearchEnd::Unpolished,
            _ => SearchEnd::Coarse,
        };
        let evaluations = nodes.evaluated + polishing;
        let mut set = Self { grid, nodes, vertices, evaluations, end, tolerance, sampled: None };
        if found && let Some((wrong, count)) = set.sample(evaluate) {
            (set.sampled, set.evaluations) = (Some(wrong), set.evaluations + count);
        }
        Some(set)
    }

    /// Grid of the search.
    pub fn grid(&self) -> &PointGrid {
        &self.grid
    }

    /// End that the search reached.
    pub fn end(&self) -> SearchEnd {
        self.end
    }

    /// Number of evaluations of the function.
    pub fn evaluations(&self) -> usize {
        self.evaluations
    }

    /// Numbers of steps of the grid that can stand as one in [`Self::boundary`], the finest first. Volumes and parts of
    /// two of them tell how much depends on the steps.
    pub fn strides(&self) -> Vec<usize> {
        let largest = self.grid.largest_stride().max(self.nodes.stride);
        std::iter::successors(Some(self.nodes.stride), |stride| Some(2 * stride))
            .take_while(|stride| *stride <= largest)
            .collect()
    }

    /// Boundary of the set with a number of steps of the grid as one, closed on the faces of the box. Its vertices are
    /// among those of the finest steps.
    pub fn boundary(&self, stride: usize) -> BoundaryMesh {
        let stride = stride.max(self.nodes.stride);
        let mut mesh = MeshBuilder::default();
        for (cell, inside) in self.cells(stride) {
            tetrahedra::surface(inside, |triangle| mesh.add(self, cell, stride, triangle));
        }
        let on_surface = mesh.triangles.len();
        for (cell, inside) in self.cells(stride).filter(|(cell, _)| self.is_at_box(*cell, stride)) {
            tetrahedra::caps(&self.grid, cell, stride, inside, |triangle| mesh.add(self, cell, stride, triangle));
        }
        BoundaryMesh::new(mesh.vertices, mesh.triangles, on_surface)
    }

    /// Faces of the box up to which the set reaches, in the order of [`BOX_FACES`]. It may go on behind them.
    pub fn touches(&self) -> [bool; BOX_FACES.len()] {
        let mut touches = [false; BOX_FACES.len()];
        let steps = self.grid.steps();
        for index in (0..self.grid.nodes()).filter(|index| self.nodes.is_inside(*index)) {
            for (k, at) in self.grid.at(index).into_iter().enumerate() {
                touches[2 * k] |= at == 0;
                touches[2 * k + 1] |= at == steps[k];
            }
        }
        touches
    }

    /// Corners of the largest box along the axes whose nodes are all inside the set; `None` if no cell is. Between the
    /// nodes nothing was evaluated.
    pub fn inner_box(&self) -> Option<[Vec3; 2]> {
        inner_box::largest(&self.grid, self.nodes.stride, |index| self.nodes.is_inside(index))
    }

    /// Cells of a stride that are not all outside, with a bit for each corner that is inside.
    fn cells(&self, stride: usize) -> impl Iterator<Item = ([usize; 3], u8)> + '_ {
        self.grid.cells(stride).filter_map(move |cell| {
            let bits = self.corners_inside(&GridNodes::corners(&self.grid, cell, stride));
            (bits != 0).then_some((cell, bits))
        })
    }

    /// Bit for each corner of a cell that is inside.
    pub(super) fn corners_inside(&self, corners: &[usize; 8]) -> u8 {
        (0..8).filter(|i| self.nodes.is_inside(corners[*i])).fold(0, |bits, i| bits | 1 << i)
    }

    fn is_at_box(&self, cell: [usize; 3], stride: usize) -> bool {
        cell.iter().zip(self.grid.steps()).any(|(at, steps)| *at == 0 || at + stride == steps)
    }

    /// Point of a vertex of a cell of a stride.
    pub(super) fn vertex(&self, corners: &[usize; 8], stride: usize, vertex: CellVertex) -> Vec3 {
        let edge = match vertex {
            CellVertex::Edge(a, b) => self.vertex_edge((corners[a], a ^ b), stride),
            CellVertex::Corner(corner) => (corners[corner], 0),
        };
        self.vertices.get(&edge).copied().unwrap_or_else(|| self.grid.point(edge.0))
    }

    /// Vertex on an edge of larger steps: that of its one part that the boundary crosses.
    fn vertex_edge(&self, (first, axes): Edge, stride: usize) -> Edge {
        let along = offset(&self.grid, axes);
        let (mut from, mut length) = (first, stride);
        while length > self.nodes.stride {
            length /= 2;
            if self.nodes.is_inside(from) == self.nodes.is_inside(from + length * along) {
                from += length * along;
            }
        }
        (from, axes)
    }
}

/// Distance in the list of nodes along some axes at once.
fn offset(grid: &PointGrid, axes: usize) -> usize {
    grid.offsets().iter().enumerate().filter(|(k, _)| axes >> k & 1 == 1).map(|(_, offset)| offset).sum()
}

/// Edges of the finest steps whose ends do not agree.
fn crossed_edges(grid: &PointGrid, nodes: &GridNodes) -> Vec<Edge> {
    let mut edges = Vec::new();
    let (stride, steps) = (nodes.stride, grid.steps());
    for index in 0..grid.nodes() {
        let at = grid.at(index);
        if at.iter().any(|at| at % stride != 0) {
            continue;
        }
        let goes_on = |axes: &usize| (0..3).all(|k| axes >> k & 1 == 0 || at[k] < steps[k]);
        let is_crossed = |axes: &usize| nodes.is_inside(index) != nodes.is_inside(index + stride * offset(grid, *axes));
        edges.extend((1..8).filter(goes_on).filter(is_crossed).map(|axes| (index, axes)));
    }
    edges
}

/// Search on an edge that is crossed.
fn root(grid: &PointGrid, nodes: &GridNodes, (index, axes): Edge, tolerance: f64) -> EdgeRoot {
    let end = index + nodes.stride * offset(grid, axes);
    let [inner, outer] = if nodes.is_inside(index) { [index, end] } else { [end, index] };
    let points = [inner, outer].map(|index| grid.point(index));
    EdgeRoot::new(points, [inner, outer].map(|index| nodes.value(index)), tolerance)
}

/// Mesh while triangles are added.
#[derive(Default)]
struct MeshBuilder {
    vertices: Vec<Vec3>,
    triangles: Vec<[usize; 3]>,
    /// Numbers of the vertices on edges, and at nodes, whose edges go along no axis.
    numbers: HashMap<Edge, usize>,
}

impl MeshBuilder {
    fn add(&mut self, set: &LevelSet, cell: [usize; 3], stride: usize, triangle: [CellVertex; 3]) {
        let corners = GridNodes::corners(&set.grid, cell, stride);
        let triangle = triangle.map(|vertex| {
            let edge = match vertex {
                CellVertex::Edge(a, b) => set.vertex_edge((corners[a], a ^ b), stride),
                CellVertex::Corner(corner) => (corners[corner], 0),
            };
            *self.numbers.entry(edge).or_insert_with(|| {
                self.vertices.push(set.vertices.get(&edge).copied().unwrap_or_else(|| set.grid.point(edge.0)));
                self.vertices.len() - 1
            })
        });
        self.triangles.push(triangle);
    }
}

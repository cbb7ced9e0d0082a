//! Marching tetrahedra: triangles between the inside and the outside of a cell, and on the faces of the box.
//!
//! Every cell is cut into six tetrahedra along one diagonal, the same in all cells, so that the triangles of neighbours
//! fit together: the surface is closed and has no double edges.

use super::grid::PointGrid;

/// Tetrahedra of a cell by the numbers of its corners, whose bits are the ends of the axes: corner 0, one axis more at
/// each step, corner 7. All have a positive volume in their order.
const TETRAHEDRA: [[usize; 4]; 6] =
    [[0, 1, 3, 7], [0, 2, 6, 7], [0, 4, 5, 7], [0, 3, 2, 7], [0, 6, 4, 7], [0, 5, 1, 7]];

/// Even orders of four corners that begin with each of them.
const ONE_FIRST: [[usize; 4]; 4] = [[0, 1, 2, 3], [1, 0, 3, 2], [2, 3, 0, 1], [3, 2, 1, 0]];

/// Even orders of four corners that begin with each two of them.
const TWO_FIRST: [[usize; 4]; 6] = [[0, 1, 2, 3], [0, 2, 3, 1], [0, 3, 1, 2], [1, 2, 0, 3], [1, 3, 2, 0], [2, 3, 0, 1]];

/// Faces of a tetrahedron with its normal outwards.
const FACES: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// Corner of a triangle in a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CellVertex {
    /// On the edge between two corners of the cell, the first with the smaller number.
    Edge(usize, usize),
    /// At a corner of the cell, on a face of the box.
    Corner(usize),
}

impl CellVertex {
    fn between(a: usize, b: usize) -> Self {
        Self::Edge(a.min(b), a.max(b))
    }
}

/// Triangles of the boundary in a cell, with the inside behind them; `inside` has a bit for each corner.
pub(super) fn surface(inside: u8, mut add: impl FnMut([CellVertex; 3])) {
    let is_inside = |corner: usize| inside >> corner & 1 == 1;
    for tetrahedron in TETRAHEDRA {
        let within: Vec<usize> = (0..4).filter(|i| is_inside(tetrahedron[*i])).collect();
        let edge = |i: usize, j: usize| CellVertex::between(tetrahedron[i], tetrahedron[j]);
        match within[..] {
            [one] => {
                let [a, b, c, d] = ONE_FIRST[one];
                add([edge(a, b), edge(a, c), edge(a, d)]);
            }
            [first, second] => {
                for [a, b, c, d] in TWO_FIRST.into_iter().filter(|order| order[..2] == [first, second]) {
                    add([edge(a, c), edge(a, d), edge(b, d)]);
                    add([edge(a, c), edge(b, d), edge(b, c)]);
                }
            }
            [_, _, _] => {
                let alone = (0..4).find(|i| !within.contains(i)).unwrap_or_default();
                let [a, b, c, d] = ONE_FIRST[alone];
                add([edge(a, b), edge(a, d), edge(a, c)]);
            }
            _ => {}
        }
    }
}

/// Tetrahedra that fill the inside of a cell behind the triangles of [`surface`].
pub(super) fn solids(inside: u8, mut add: impl FnMut([CellVertex; 4])) {
    let is_inside = |corner: usize| inside >> corner & 1 == 1;
    for tetrahedron in TETRAHEDRA {
        let within: Vec<usize> = (0..4).filter(|i| is_inside(tetrahedron[*i])).collect();
        let at = |i: usize| CellVertex::Corner(tetrahedron[i]);
        let edge = |i: usize, j: usize| CellVertex::between(tetrahedron[i], tetrahedron[j]);
        match within[..] {
            [one] => {
                let [a, b, c, d] = ONE_FIRST[one];
                add([at(a), edge(a, b), edge(a, c), edge(a, d)]);
            }
            [first, second] => {
                for [a, b, c, d] in TWO_FIRST.into_iter().filter(|order| order[..2] == [first, second]) {
                    add([at(a), edge(a, c), edge(a, d), edge(b, d)]);
                    add([at(a), edge(a, c), edge(b, d), edge(b, c)]);
                    add([at(a), at(b), edge(b, c), edge(b, d)]);
                }
            }
            [a, b, c] => {
                let alone = (0..4).find(|i| !within.contains(i)).unwrap_or_default();
                add([at(a), at(b), at(c), edge(c, alone)]);
                add([at(a), at(b), edge(b, alone), edge(c, alone)]);
                add([at(a), edge(a, alone), edge(b, alone), edge(c, alone)]);
            }
            [a, b, c, d] => add([at(a), at(b), at(c), at(d)]),
            _ => {}
        }
    }
}

/// Triangles of the inside on the faces of the box, in a cell of a stride.
pub(super) fn caps(
    grid: &PointGrid,
    cell: [usize; 3],
    stride: usize,
    inside: u8,
    mut add: impl FnMut([CellVertex; 3]),
) {
    let is_inside = |corner: usize| inside >> corner & 1 == 1;
    let is_at_end =
        |axis: usize, end: usize| if end == 0 { cell[axis] == 0 } else { cell[axis] + stride == grid.steps()[axis] };
    for face in TETRAHEDRA.into_iter().flat_map(|corners| FACES.map(|face| face.map(|i| corners[i]))) {
        let lies_in = |axis: usize, end: usize| face.iter().all(|corner| corner >> axis & 1 == end);
        if !(0..3).any(|axis| (0..2).any(|end| is_at_end(axis, end) && lies_in(axis, end))) {
            continue;
        }

        // The part of the triangle inside the set has up to four corners.
        let mut polygon = Vec::with_capacity(4);
        for (here, next) in [(face[0], face[1]), (face[1], face[2]), (face[2], face[0])] {
            if is_inside(here) {
                polygon.push(CellVertex::Corner(here));
            }
            if is_inside(here) != is_inside(next) {
                polygon.push(CellVertex::between(here, next));
            }
        }
        for i in 2..polygon.len() {
            add([polygon[0], polygon[i - 1], polygon[i]]);
        }
    }
}

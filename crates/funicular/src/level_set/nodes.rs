//! Values of the function at the nodes of a grid, found from coarse to fine.

use super::grid::PointGrid;
use super::{Evaluate, is_inside};

/// Distance of the values of a cell from zero, over their range, below which the boundary may bulge into the cell: a
/// ball does so by a quarter of a step over its radius, so that steps up to the radius are covered.
const BULGE: f64 = 0.25;

/// Knowledge of a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Knowledge {
    Nothing,
    /// Node of a cell of larger steps whose corners agree; it is taken to agree with them.
    Assumed {
        inside: bool,
    },
    Evaluated {
        inside: bool,
    },
}

/// Nodes of a grid with the values that were needed.
#[derive(Debug, Clone)]
pub(super) struct GridNodes {
    knowledge: Vec<Knowledge>,
    /// Values of the nodes that were evaluated and have one.
    values: Vec<f64>,
    /// Number of nodes that were evaluated.
    pub(super) evaluated: usize,
    /// Number of steps between the nodes that are all known.
    pub(super) stride: usize,
}

impl GridNodes {
    /// Nodes of a grid, evaluated up to its largest stride and then only near the boundary of the set; `None` if the
    /// work was stopped before the first stride was ready. Otherwise [`Self::stride`] says how far it came.
    pub(super) fn find(grid: &PointGrid, evaluate: &mut Evaluate<'_>) -> Option<Self> {
        let stride = grid.first_stride();
        let count = grid.nodes();
        let mut nodes =
            Self { knowledge: vec![Knowledge::Nothing; count], values: vec![0.0; count], evaluated: 0, stride };
        nodes.add_all(grid, stride, evaluate)?;

        // Every node up to the largest stride, or while none is inside up to that of the grid.
        let largest = grid.largest_stride();
        while nodes.stride > largest || nodes.stride > 1 && !(0..count).any(|index| nodes.is_inside(index)) {
            if nodes.add_all(grid, nodes.stride / 2, evaluate).is_none() {
                return Some(nodes);
            }
            nodes.stride /= 2;
        }

        while nodes.stride > 1 {
            let before = nodes.stride;
            if nodes.refine(grid, evaluate).is_none() {
                // The nodes of the larger stride are all there still.
                nodes.stride = before;
                break;
            }
        }
        Some(nodes)
    }

    /// True if a node is inside the set.
    pub(super) fn is_inside(&self, index: usize) -> bool {
        match self.knowledge[index] {
            Knowledge::Assumed { inside } | Knowledge::Evaluated { inside } => inside,
            Knowledge::Nothing => false,
        }
    }

    /// Value of a node that was evaluated, if it has one.
    pub(super) fn value(&self, index: usize) -> Option<f64> {
        let is_number = matches!(self.knowledge[index], Knowledge::Evaluated { .. }) && self.values[index].is_finite();
        is_number.then_some(self.values[index])
    }

    /// Corners of a cell; bit k of the number of a corner says whether it lies at the greater end of axis k.
    pub(super) fn corners(grid: &PointGrid, cell: [usize; 3], stride: usize) -> [usize; 8] {
        std::array::from_fn(|corner| grid.index(std::array::from_fn(|k| cell[k] + stride * (corner >> k & 1))))
    }

    /// Evaluates all further nodes of a stride, in an order that spreads them over the box from the first ones on: if
    /// the work is stopped, those that were asked tell something of all of it.
    fn add_all(&mut self, grid: &PointGrid, stride: usize, evaluate: &mut Evaluate<'_>) -> Option<()> {
        let is_further = |index: &usize| {
            self.knowledge[*index] == Knowledge::Nothing && grid.at(*index).iter().all(|at| at % stride == 0)
        };
        let all: Vec<usize> = (0..grid.nodes()).filter(is_further).collect();
        self.add(grid, &spread(&all), evaluate)
    }

    /// Evaluates nodes.
    fn add(&mut self, grid: &PointGrid, indices: &[usize], evaluate: &mut Evaluate<'_>) -> Option<()> {
        let points: Vec<_> = indices.iter().map(|index| grid.point(*index)).collect();
        let found = evaluate(&points)?;
        for (index, value) in indices.iter().zip(found) {
            self.knowledge[*index] = Knowledge::Evaluated { inside: is_inside(value) };
            self.values[*index] = value.unwrap_or(f64::NAN);
        }
        self.evaluated += indices.len();
        Some(())
    }

    /// Halves the stride: evaluates the cells that the boundary crosses, and goes on along the boundary wherever it
    /// leaves them.
    fn refine(&mut self, grid: &PointGrid, evaluate: &mut Evaluate<'_>) -> Option<()> {
        let before = self.stride;
        self.stride = before / 2;
        self.assume(grid, before);
        let near: Vec<[usize; 3]> =
            grid.cells(before).filter(|cell| self.may_be_crossed(grid, *cell, before)).collect();
        let mut wanted = self.unknown_nodes(grid, &near, before);

        while !wanted.is_empty() {
            self.add(grid, &wanted, evaluate)?;
            wanted = self.unknown_nodes(grid, &self.crossed_cells(grid, self.stride), self.stride);
        }
        Some(())
    }

    /// True for a cell whose corners do not agree, or whose values come so near to zero that a curved boundary may
    /// bulge into it between them.
    fn may_be_crossed(&self, grid: &PointGrid, cell: [usize; 3], stride: usize) -> bool {
        let corners = Self::corners(grid, cell, stride);
        let first = self.is_inside(corners[0]);
        if corners[1..].iter().any(|corner| self.is_inside(*corner) != first) {
            return true;
        }
        let Some(values) = corners.iter().map(|corner| self.value(*corner)).collect::<Option<Vec<f64>>>() else {
            return false;
        };
        let [low, high] = [values.iter().copied().reduce(f64::min), values.iter().copied().reduce(f64::max)];
        let (Some(low), Some(high)) = (low, high) else { return false };
        low.abs().min(high.abs()) < BULGE * (high - low)
    }

    /// Cells whose corners do not all agree.
    fn crossed_cells(&self, grid: &PointGrid, stride: usize) -> Vec<[usize; 3]> {
        let disagree = |cell: &[usize; 3]| {
            let corners = Self::corners(grid, *cell, stride);
            let first = self.is_inside(corners[0]);
            corners[1..].iter().any(|corner| self.is_inside(*corner) != first)
        };
        grid.cells(stride).filter(disagree).collect()
    }

    /// Nodes of half the stride in cells whose corners agree agree with them, too.
    fn assume(&mut self, grid: &PointGrid, stride: usize) {
        for cell in grid.cells(stride) {
            let corners = Self::corners(grid, cell, stride);
            let inside = self.is_inside(corners[0]);
            if corners[1..].iter().any(|corner| self.is_inside(*corner) != inside) {
                continue;
            }
            for index in nodes_of(grid, cell, stride, stride / 2) {
                if self.knowledge[index] == Knowledge::Nothing {
                    self.knowledge[index] = Knowledge::Assumed { inside };
                }
            }
        }
    }

    /// Nodes of the present stride in cells that were not evaluated, each once.
    fn unknown_nodes(&self, grid: &PointGrid, cells: &[[usize; 3]], cell_stride: usize) -> Vec<usize> {
        let is_unknown = |index: &usize| !matches!(self.knowledge[*index], Knowledge::Evaluated { .. });
        let of_cells = cells.iter().flat_map(|cell| nodes_of(grid, *cell, cell_stride, self.stride));
        let mut unknown: Vec<usize> = of_cells.filter(is_unknown).collect();
        unknown.sort_unstable();
        unknown.dedup();
        unknown
    }
}

/// Nodes of a cell with its corners, in steps of `stride`.
fn nodes_of(grid: &PointGrid, cell: [usize; 3], size: usize, stride: usize) -> impl Iterator<Item = usize> + '_ {
    let along = move |k: usize| (cell[k]..=cell[k] + size).step_by(stride);
    along(2).flat_map(move |k| along(1).flat_map(move |j| along(0).map(move |i| grid.index([i, j, k]))))
}

/// Members of a list in an order in which the first ones are spread over all of it.
fn spread(all: &[usize]) -> Vec<usize> {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    let count = all.len();
    let divisor = |mut a: usize, mut b: usize| {
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    // A step that shares no divisor with the length comes to every member once.
    let near = (GOLDEN * count as f64) as usize;
    let step = (near.max(1)..=near + count).find(|step| divisor(*step, count) == 1).unwrap_or(1);
    (0..count).map(|k| all[k * step % count]).collect()
}

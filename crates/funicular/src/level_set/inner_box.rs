//! Largest box along the axes in a set on a grid.

use super::grid::PointGrid;
use crate::math::Vec3;

/// Box of cells: the first and the number of cells along each axis.
#[derive(Clone, Copy)]
struct CellBox {
    from: [usize; 3],
    size: [usize; 3],
}

impl CellBox {
    fn volume(&self, cell: &Vec3) -> f64 {
        (0..3).map(|k| self.size[k] as f64 * cell[k]).product()
    }
}

/// Corners of the largest box of cells of a stride whose corners are all inside; `None` if there is no such cell.
pub(super) fn largest(grid: &PointGrid, stride: usize, is_inside: impl Fn(usize) -> bool) -> Option<[Vec3; 2]> {
    let [x, y, z] = grid.steps().map(|steps| steps / stride);
    let is_full = |i: usize, j: usize, k: usize| {
        let corners = super::nodes::GridNodes::corners(grid, [i * stride, j * stride, k * stride], stride);
        corners.into_iter().all(&is_inside)
    };
    let full: Vec<Vec<bool>> = (0..z)
        .map(|k| (0..y).flat_map(|j| (0..x).map(move |i| (i, j))).map(|(i, j)| is_full(i, j, k)).collect())
        .collect();

    let cell = grid.step() * stride as f64;
    let mut best = CellBox { from: [0; 3], size: [0; 3] };
    for bottom in 0..z {
        let mut common = full[bottom].clone();
        for top in bottom..z {
            common.iter_mut().zip(&full[top]).for_each(|(all, here)| *all &= here);
            // Even with all layers above, what is left of them cannot be larger.
            let left = common.iter().filter(|full| **full).count();
            let bound = left as f64 * cell.x * cell.y * cell.z * (z - bottom) as f64;
            if bound <= best.volume(&cell) {
                break;
            }
            let ([i, j], [width, depth]) = largest_rectangle(&common, x, &cell);
            let found = CellBox { from: [i, j, bottom], size: [width, depth, top - bottom + 1] };
            if found.volume(&cell) > best.volume(&cell) {
                best = found;
            }
        }
    }

    let corner = |at: [usize; 3]| grid.point(grid.index(at.map(|at| at * stride)));
    let to = std::array::from_fn(|k| best.from[k] + best.size[k]);
    (best.volume(&cell) > 0.0).then(|| [corner(best.from), corner(to)])
}

/// Largest rectangle of full cells in a layer of rows of `width` cells: its first cell, and its size. In each row, the
/// full cells up to it are columns, and rectangles under them are found with a stack of columns that grow.
fn largest_rectangle(layer: &[bool], width: usize, cell: &Vec3) -> ([usize; 2], [usize; 2]) {
    let mut best = ([0, 0], [0, 0]);
    let mut best_area = 0.0;
    let mut heights = vec![0_usize; width];
    for (row, cells) in layer.chunks(width).enumerate() {
        for (height, full) in heights.iter_mut().zip(cells) {
            *height = if *full { *height + 1 } else { 0 };
        }

        // First column and height of rectangles that are open to the right.
        let mut open: Vec<(usize, usize)> = Vec::new();
        for (column, height) in heights.iter().copied().chain([0]).enumerate() {
            let mut first = column;
            while let Some((begin, tall)) = open.pop_if(|(_, tall)| *tall >= height) {
                let area = (column - begin) as f64 * cell.x * tall as f64 * cell.y;
                if area > best_area {
                    best_area = area;
                    best = ([begin, row + 1 - tall], [column - begin, tall]);
                }
                first = begin;
            }
            open.push((first, height));
        }
    }
    best
}

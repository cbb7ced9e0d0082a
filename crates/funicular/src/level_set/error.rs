//! Error of the volume of a set: what the steps between the nodes leave open.
//!
//! Two estimates that do not share their blind spots. The change from double steps, cell by cell, sees how the boundary
//! bends, but all its points lie on edges of one grid. Points between them ask the function itself on which side of the
//! boundary they are.

use super::nodes::GridNodes;
use super::set::{LevelSet, SearchEnd};
use super::tetrahedra;
use super::{Evaluate, is_inside};
use crate::math::Vec3;
use std::collections::BTreeSet;

/// Maximum number of cells that are sampled: enough to tell the error of a smooth set to a third.
const MAX_SAMPLED: usize = 2048;

/// Cells that the boundary does not cross are sampled beside each fourth of those that it crosses.
const BESIDE: usize = 4;

/// Number of standard deviations, and of further samples, by which the number of samples on the wrong side is
/// increased: a number of rare events that was expected to be larger is then found in fewer than one of forty searches.
const DEVIATIONS: f64 = 2.0;
const FURTHER: f64 = 3.0;

/// Fractions of a cell by which the samples move on from one to the next, so that they fill it evenly: powers of the
/// inverse of the root of x⁴ = x + 1.
const EVEN: [f64; 3] = [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_3];

/// Cell of the grid with its corners, and a bit for each that is inside.
#[derive(Clone, Copy)]
struct Cell {
    stride: usize,
    corners: [usize; 8],
    inside: u8,
}

impl Cell {
    fn is_crossed(&self) -> bool {
        self.inside != 0 && self.inside != u8::MAX
    }
}

/// Sampled cells: each stands for a number of them.
struct SampledCells {
    cells: Vec<[usize; 3]>,
    weight: f64,
}

impl SampledCells {
    /// Evenly chosen cells of a list, up to a number of them.
    fn of(all: &[[usize; 3]], most: usize) -> Self {
        let count = all.len().min(most);
        let cells = (0..count).map(|i| all[i * all.len() / count]).collect();
        Self { cells, weight: all.len() as f64 / count.max(1) as f64 }
    }
}

impl LevelSet {
    /// Bound of the error of the volume [m³] for each of [`Self::strides`]. It is no proof: it is the greatest of the
    /// change from double steps, summed up without signs, and of the volume that samples between the nodes find on the
    /// wrong side of the boundary; with unknown vertices or without both, all that the cells of the boundary leave
    /// open.
    ///
    /// # References
    /// docs/theory.md, equation (40x1).
    pub fn volume_errors(&self) -> Vec<f64> {
        let strides = self.strides();
        let finest = strides[0];
        let changes: Vec<f64> = strides[1..].iter().map(|stride| self.change_from(*stride)).collect();

        let (mut open, mut area) = (0.0, 0.0);
        for cell in self.grid.cells(finest).map(|at| self.cell(at, finest)).filter(Cell::is_crossed) {
            let (volume, whole) = (self.volume_in(&cell), self.cell_size(finest));
            open += volume.max(whole - volume);
            area += whole.powf(2.0 / 3.0);
        }
        let seen = match (self.end(), self.sampled, changes.first()) {
            (SearchEnd::Complete, Some(sampled), change) => Some(sampled.max(change.copied().unwrap_or(0.0))),
            (SearchEnd::Complete, None, Some(change)) => Some(*change),
            _ => None,
        };
        let own = seen.map_or(open, |seen| (seen + self.tolerance * area).min(open.max(seen)));

        // What changes up to the finest steps is the error of larger ones.
        let mut errors = vec![own];
        for change in changes {
            errors.push(errors[errors.len() - 1] + change);
        }
        errors
    }

    /// Change of the volume from the cells of a stride to those of half of it, without signs [m³].
    fn change_from(&self, stride: usize) -> f64 {
        let half = stride / 2;
        let mut changed = 0.0;
        for at in self.grid.cells(stride) {
            let parts: [Cell; 8] =
                std::array::from_fn(|i| self.cell(std::array::from_fn(|k| at[k] + half * (i >> k & 1)), half));
            let same = parts[0].inside;
            if !parts[0].is_crossed() && parts.iter().all(|part| part.inside == same) {
                continue;
            }
            let fine: f64 = parts.iter().map(|part| self.volume_in(part)).sum();
            changed += (fine - self.volume_in(&self.cell(at, stride))).abs();
        }
        changed
    }

    /// Samples between the nodes: the volume that they find on the wrong side of the boundary, with what their number
    /// leaves open [m³], and how many there are. `None` if the work was stopped, or without a boundary.
    pub(super) fn sample(&self, evaluate: &mut Evaluate<'_>) -> Option<(f64, usize)> {
        let crossed: Vec<[usize; 3]> = self.grid.cells(1).filter(|at| self.cell(*at, 1).is_crossed()).collect();
        let beside = SampledCells::of(&self.beside(&crossed), MAX_SAMPLED / BESIDE);
        let crossed = SampledCells::of(&crossed, MAX_SAMPLED);
        let cells: Vec<Cell> = crossed.cells.iter().chain(&beside.cells).map(|at| self.cell(*at, 1)).collect();
        if cells.is_empty() {
            return None;
        }

        let points: Vec<Vec3> = cells.iter().enumerate().map(|(i, cell)| self.sample_in(cell, i)).collect();
        let values = evaluate(&points)?;
        let is_wrong: Vec<bool> = (cells.iter().zip(&points).zip(values))
            .map(|((cell, point), value)| is_inside(value) != self.contains(cell, point))
            .collect();
        let wrong = |range: &[bool]| range.iter().filter(|wrong| **wrong).count() as f64;
        let (within, outside) = is_wrong.split_at(crossed.cells.len());
        // What lies beside the cells of the boundary may go on behind them.
        let found = [(wrong(within), crossed.weight), (2.0 * wrong(outside), beside.weight)];
        let sum: f64 = found.iter().map(|(count, weight)| count * weight).sum();
        let variance: f64 = found.iter().map(|(count, weight)| count * weight * weight).sum();
        let further = FURTHER * crossed.weight.max(1.0);
        Some(((sum + DEVIATIONS * variance.sqrt() + further) * self.cell_size(1), points.len()))
    }

    /// Neighbours of crossed cells that are not crossed themselves.
    fn beside(&self, crossed: &[[usize; 3]]) -> Vec<[usize; 3]> {
        let steps = self.grid.steps();
        let mut beside = BTreeSet::new();
        for at in crossed {
            let near = |k: usize| at[k].saturating_sub(1)..=(at[k] + 1).min(steps[k] - 1);
            let neighbours = near(0).flat_map(|i| near(1).flat_map(move |j| near(2).map(move |k| [i, j, k])));
            beside.extend(neighbours);
        }
        beside.into_iter().filter(|at| !self.cell(*at, 1).is_crossed()).collect()
    }

    /// Point in a cell.
    fn sample_in(&self, cell: &Cell, number: usize) -> Vec3 {
        let [from, to] = [cell.corners[0], cell.corners[7]].map(|corner| self.grid.point(corner));
        Vec3::from_fn(|k, _| from[k] + (to[k] - from[k]) * (0.5 + number as f64 * EVEN[k]).fract())
    }

    fn cell(&self, at: [usize; 3], stride: usize) -> Cell {
        let corners = GridNodes::corners(&self.grid, at, stride);
        Cell { stride, corners, inside: self.corners_inside(&corners) }
    }

    /// Volume of a whole cell [m³].
    fn cell_size(&self, stride: usize) -> f64 {
        (self.grid.step() * stride as f64).product()
    }

    /// Volume of the set in a cell [m³].
    fn volume_in(&self, cell: &Cell) -> f64 {
        if !cell.is_crossed() {
            return if cell.inside == 0 { 0.0 } else { self.cell_size(cell.stride) };
        }
        let mut volume = 0.0;
        self.solids(cell, |[a, b, c, d]| volume += (b - a).cross(&(c - a)).dot(&(d - a)).abs() / 6.0);
        volume
    }

    /// True if a point of a cell is behind the boundary.
    fn contains(&self, cell: &Cell, point: &Vec3) -> bool {
        if !cell.is_crossed() {
            return cell.inside != 0;
        }
        let mut is_within = false;
        self.solids(cell, |corners| is_within |= is_in_tetrahedron(point, &corners));
        is_within
    }

    /// Corners of the tetrahedra that the set fills in a cell.
    fn solids(&self, cell: &Cell, mut add: impl FnMut([Vec3; 4])) {
        tetrahedra::solids(cell.inside, |corners| {
            add(corners.map(|vertex| self.vertex(&cell.corners, cell.stride, vertex)));
        });
    }
}

/// True if a point is in a tetrahedron that has a volume.
fn is_in_tetrahedron(point: &Vec3, corners: &[Vec3; 4]) -> bool {
    let volume = |[a, b, c, d]: [Vec3; 4]| (b - a).cross(&(c - a)).dot(&(d - a));
    let whole = volume(*corners);
    let with_point = |i: usize| {
        let mut replaced = *corners;
        replaced[i] = *point;
        volume(replaced)
    };
    whole != 0.0 && (0..4).all(|i| with_point(i) * whole >= 0.0)
}

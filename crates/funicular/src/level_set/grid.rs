//! Points of a box in equal steps.

use crate::math::Vec3;

/// Maximum number of nodes of a grid: some 300 MB with their values.
pub const MAX_NODES: usize = 20_000_000;

/// Largest ratio of the first step of a search to the last one. Larger steps would miss more than they save.
const MAX_STRIDE: usize = 4;

/// Names of the faces of a box, in the order of [`LevelSet::touches`](super::LevelSet::touches).
pub const BOX_FACES: [&str; 6] = ["-x", "+x", "-y", "+y", "-z", "+z"];

/// Grid of points in a box, with equal steps along each axis.
#[derive(Debug, Clone, PartialEq)]
pub struct PointGrid {
    lower: Vec3,
    upper: Vec3,
    /// Number of steps along each axis.
    steps: [usize; 3],
}

impl PointGrid {
    /// Grid between two corners with a number of steps along each axis; `None` without a volume, without steps, or with
    /// more than [`MAX_NODES`] nodes.
    pub fn new(lower: Vec3, upper: Vec3, steps: [usize; 3]) -> Option<Self> {
        let has_volume = (0..3).all(|k| (upper[k] - lower[k]).is_finite() && upper[k] > lower[k] && steps[k] > 0);
        let nodes = steps.iter().try_fold(1_usize, |count, steps| count.checked_mul(steps.checked_add(1)?));
        (has_volume && nodes? <= MAX_NODES).then_some(Self { lower, upper, steps })
    }

    /// Corner with the least coordinates.
    pub fn lower(&self) -> Vec3 {
        self.lower
    }

    /// Corner with the greatest coordinates.
    pub fn upper(&self) -> Vec3 {
        self.upper
    }

    /// Number of steps along each axis.
    pub fn steps(&self) -> [usize; 3] {
        self.steps
    }

    /// Length of a step along each axis [m].
    pub fn step(&self) -> Vec3 {
        Vec3::from_fn(|k, _| (self.upper[k] - self.lower[k]) / self.steps[k] as f64)
    }

    /// Number of steps that a search begins with as one: 4, 2 or 1, as all axes allow it.
    pub fn largest_stride(&self) -> usize {
        let mut stride = MAX_STRIDE;
        while self.steps.iter().any(|steps| steps % stride != 0) {
            stride /= 2;
        }
        stride
    }

    /// Number of steps at whose ends a search looks before those of [`Self::largest_stride`], so that it has a set to
    /// show if it is stopped early: doubled while every axis keeps two cells.
    pub(super) fn first_stride(&self) -> usize {
        let mut stride = self.largest_stride();
        while self.steps.iter().all(|steps| steps % (2 * stride) == 0 && steps / (2 * stride) >= 2) {
            stride *= 2;
        }
        stride
    }

    /// Number of nodes along each axis.
    pub(super) fn counts(&self) -> [usize; 3] {
        self.steps.map(|steps| steps + 1)
    }

    /// Number of nodes.
    pub(super) fn nodes(&self) -> usize {
        self.counts().iter().product()
    }

    /// Distance in the list of nodes between neighbours along each axis.
    pub(super) fn offsets(&self) -> [usize; 3] {
        let [x, y, _] = self.counts();
        [1, x, x * y]
    }

    /// Place of a node in the list of nodes.
    pub(super) fn index(&self, at: [usize; 3]) -> usize {
        let [x, y, z] = self.offsets();
        at[0] * x + at[1] * y + at[2] * z
    }

    /// Numbers of a node along the axes from its place in the list.
    pub(super) fn at(&self, index: usize) -> [usize; 3] {
        let [x, y, _] = self.counts();
        [index % x, index / x % y, index / x / y]
    }

    /// Point of a node. The corners of the box are exact.
    pub(super) fn point(&self, index: usize) -> Vec3 {
        let at = self.at(index);
        Vec3::from_fn(|k, _| {
            let fraction = at[k] as f64 / self.steps[k] as f64;
            if at[k] == self.steps[k] {
                self.upper[k]
            } else {
                self.lower[k] + (self.upper[k] - self.lower[k]) * fraction
            }
        })
    }

    /// Cells of a stride: the node with the least coordinates of each.
    pub(super) fn cells(&self, stride: usize) -> impl Iterator<Item = [usize; 3]> + use<> {
        let [x, y, z] = self.steps;
        let along = move |steps: usize| (0..steps).step_by(stride);
        along(z).flat_map(move |k| along(y).flat_map(move |j| along(x).map(move |i| [i, j, k])))
    }
}

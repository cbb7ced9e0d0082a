//! Lever axes of cables at the platform, side by side like their matrices, and motions of the robot.

use super::batched_cable::{IN_PLANE, OUT_OF_PLANE};
use crate::math::Vec6;
use crate::math::simd::{LANES, Lane, Lanes, Line, Part, sum};
use pulp::Simd;

/// Axes of a group's cables as scaled vectors in the platform's coordinates. Each coordinate has the cables side by
/// side, with zeros in lanes without a cable.
#[derive(Debug, Default)]
pub(super) struct LeverAxes {
    pub(super) normal: [Lane; 6],
    pub(super) along: [Lane; 6],
    pub(super) out: [Lane; 6],
}

impl LeverAxes {
    /// Sets the axes of the cable in a lane.
    pub(super) fn set(&mut self, lane: usize, [normal, along, out]: [Vec6; 3]) {
        for i in 0..6 {
            self.normal[i][lane] = normal[i];
            self.along[i][lane] = along[i];
            self.out[i][lane] = out[i];
        }
    }

    /// Motion (n, e, b) of the platform ends.
    #[inline(always)]
    pub(super) fn ends<S: Simd>(&self, part: Part<S>, platform: &Lane) -> [S::f64s; 3] {
        let mut ends = [part.splat(0.0); 3];
        for (i, by) in platform[..6].iter().enumerate() {
            let by = part.splat(*by);
            ends[0] = part.mul_add(part.of(&self.normal[i]), by, ends[0]);
            ends[1] = part.mul_add(part.of(&self.along[i]), by, ends[1]);
            ends[2] = part.mul_add(part.of(&self.out[i]), by, ends[2]);
        }
        ends
    }

    /// Component `i` of the wrench of forces (n, e, b), per cable.
    #[inline(always)]
    pub(super) fn wrench<S: Simd>(&self, part: Part<S>, i: usize, [n, e, b]: [S::f64s; 3]) -> S::f64s {
        let by_out = part.mul(part.of(&self.out[i]), b);
        part.mul_add(part.of(&self.normal[i]), n, part.mul_add(part.of(&self.along[i]), e, by_out))
    }
}

/// Motion of the platform and of the lowest bubbles of each group's cables, in plane and out of plane; or forces on
/// them.
#[derive(Debug)]
pub(super) struct RobotMotion(Lanes);

impl RobotMotion {
    /// Motion with arbitrary values.
    pub(super) fn any(groups: usize) -> Self {
        Self(Lanes::any(1 + 2 * groups))
    }

    /// Sets all values to zero.
    pub(super) fn clear(&mut self) {
        self.0.fill(Line::default());
    }

    /// The six coordinates of the platform, and two numbers that are zero.
    pub(super) fn platform(&self) -> &Lane {
        &self.0[0]
    }

    pub(super) fn platform_mut(&mut self) -> &mut Lane {
        &mut self.0[0]
    }

    /// Bubbles of a group, in plane and out of plane.
    pub(super) fn bubbles(&self, group: usize) -> [&Line; 2] {
        [&self.0[1 + 2 * group], &self.0[2 + 2 * group]]
    }

    pub(super) fn bubbles_mut(&mut self, group: usize) -> [&mut Line; 2] {
        self.0[1 + 2 * group..].get_disjoint_mut([0, 1]).expect("two lines a group")
    }

    /// Multiplies all values by a factor.
    #[inline(always)]
    pub(super) fn scale<S: Simd>(&mut self, simd: S, factor: f64) {
        for part in Part::all(simd) {
            for line in self.0.iter_mut() {
                let scaled = part.mul(part.of(line), part.splat(factor));
                part.set(line, scaled);
            }
        }
    }

    /// Adds another motion, multiplied by a factor.
    #[inline(always)]
    pub(super) fn add<S: Simd>(&mut self, simd: S, factor: f64, other: &Self) {
        for part in Part::all(simd) {
            for (line, other) in self.0.iter_mut().zip(&*other.0) {
                let sum = part.mul_add(part.of(other), part.splat(factor), part.of(line));
                part.set(line, sum);
            }
        }
    }

    /// Sum of the products of all values.
    #[inline(always)]
    pub(super) fn dot<S: Simd>(&self, simd: S, other: &Self) -> f64 {
        let mut products = [0.0; LANES];
        for part in Part::all(simd) {
            part.set(&mut products, part.dot(&self.0, &other.0));
        }
        sum(&products)
    }

    /// Motion of the kept unknowns of a group.
    #[inline(always)]
    pub(super) fn kept<S: Simd>(
        &self,
        simd: S,
        lever_axes: &LeverAxes,
        group: usize,
    ) -> ([Lane; IN_PLANE], [Lane; OUT_OF_PLANE]) {
        let [q, p] = self.bubbles(group);
        let (mut in_plane, mut out_of_plane) = ([[0.0; LANES], [0.0; LANES], q.0], [[0.0; LANES], p.0]);
        for part in Part::all(simd) {
            let [n, e, b] = lever_axes.ends(part, self.platform());
            part.set(&mut in_plane[0], n);
            part.set(&mut in_plane[1], e);
            part.set(&mut out_of_plane[0], b);
        }
        (in_plane, out_of_plane)
    }
}

/// Job for vector registers: motion of the kept unknowns of a group.
pub(super) struct KeptOf<'a> {
    pub(super) motion: &'a RobotMotion,
    pub(super) lever_axes: &'a LeverAxes,
    pub(super) group: usize,
}

impl pulp::WithSimd for KeptOf<'_> {
    type Output = ([Lane; IN_PLANE], [Lane; OUT_OF_PLANE]);

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        self.motion.kept(simd, self.lever_axes, self.group)
    }
}

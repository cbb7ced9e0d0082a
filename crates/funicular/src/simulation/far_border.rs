//! Far end of a rope in Newton's matrix: its numbers as columns beside those of the rope's nodes.

use super::body::joined;
use super::far_end::{FarEnd, FarForces, delayed_weights};
use super::rope::{Border, Newton, RopeMesh, WoundLength};
use super::skyline::{NotPositive, Skyline};
use super::system::{MotionNumbers, System, three};
use crate::math::{DMat, DVec, Mat6, Vec3};

/// Far end of a rope in the matrix: its own numbers z, behind them the end of the rope at the platform and the support.
#[derive(Clone)]
pub(super) struct FarBorder {
    border: Border,
    /// Forward solutions of the columns of z and of the support, in the order of the rope's rows.
    columns: Vec<Vec<f64>>,
    /// Inverse of the matrix of z.
    inverse: DMat,
    /// Between z and the six numbers of end and support.
    outer: DMat,
    /// Number of numbers z.
    count: usize,
    /// Numbers z of a correction.
    pub(super) z: DVec,
    /// Direction in which the last node moves with the swivel, and its number.
    swivel: Option<(usize, Vec3)>,
    /// True for numbers z that do not move.
    is_held: Vec<bool>,
}

/// Count of the numbers of end and support behind z.
const OUTER: usize = 6;

impl FarBorder {
    pub(super) fn new(rope: &RopeMesh, far: &FarEnd) -> Self {
        let count = far.places().count;
        let columns = count + if far.support.is_some() { 3 } else { 0 };
        Self {
            border: Border::new(rope),
            columns: vec![vec![0.0; rope.size() - 3]; columns],
            inverse: DMat::zeros(count, count),
            outer: DMat::zeros(count, OUTER),
            count,
            z: DVec::zeros(count),
            swivel: None,
            is_held: vec![false; count],
        }
    }

    /// Factors the far end of rope `i`, whose own matrix is factored; the result is what it adds to the complement of
    /// end and support.
    pub(super) fn factor(
        &mut self,
        (system, i): (&System, usize),
        (time, given): (f64, &WoundLength),
        m: &MotionNumbers,
        needed: &[f64],
        of: Newton,
        factor: &Skyline,
    ) -> Result<Mat6, NotPositive> {
        let Some(far) = &system.far_ends[i] else { return Ok(Mat6::zeros()) };
        let (rope, range) = (&system.ropes[i], system.of_rope(i));
        let free = system.free_length(i, given, m);
        rope.border(&free, &m.x[range.clone()], &m.v[range], of, &mut self.border);
        let state = system.far_state(i, time, given, m, needed);
        let swivel = far.places().swivel.map_or(0.0, |at| state.z[0][at]);
        self.swivel = far.places().swivel.zip(far.sideways_w(swivel));

        let own = self.own_matrix(far, rope, &far.forces(&state), of);
        let on_end = self.solve_columns(far, rope, factor);
        self.complement(far, &own, &on_end)
    }

    /// Matrix of z and support without the rope's inner nodes.
    fn own_matrix(&self, far: &FarEnd, rope: &RopeMesh, forces: &FarForces, of: Newton) -> DMat {
        let places = far.places();
        let size = self.count + 3;
        let mut own = DMat::zeros(size, size);
        let end = self.border.by_end[rope.basis.degree];
        let length_by_end = three(&self.border.by_length, 3 * rope.last());
        if let (Some(feed), Some(at)) = (&far.feed, places.feed) {
            own[(at, at)] += self.border.of_length;
            let scale = feed.stretch * feed.stretch;
            let of_feed = &forces.feed;
            for j in 0..feed.count() {
                own[(at + j, at + j)] += scale * feed.masses[j] * of.mass
                    + of_feed.stiffness[j] * of.stiffness
                    + of_feed.damping[j] * of.damping;
                if j + 1 < feed.count() {
                    let coupling = of_feed.coupling[j] * of.stiffness;
                    own[(at + j, at + j + 1)] += coupling;
                    own[(at + j + 1, at + j)] += coupling;
                }
            }
            for axis in 0..3 {
                let mut by_support = length_by_end[axis];
                // A drum side from the ground is stretched by the support.
                by_support += of_feed.stiffness[0] * forces.support_along_w[axis] * of.stiffness;
                own[(at, self.count + axis)] += by_support;
                own[(self.count + axis, at)] += by_support;
            }
            let along =
                forces.support_along_w * forces.support_along_w.transpose() * (of_feed.stiffness[0] * of.stiffness);
            let mut view = own.fixed_view_mut::<3, 3>(self.count, self.count);
            view += along;
        }
        if let Some(at) = places.integral {
            own[(at, at)] += of.mass.max(1.0);
        }
        add_delayed_servo(&mut own, far, of);
        if let Some((at, sideways_w)) = self.swivel {
            own[(at, at)] += sideways_w.dot(&(end * sideways_w))
                + forces.swivel_mass * of.mass
                + forces.swivel_stiffness * of.stiffness;
            if let Some(length) = places.feed {
                let coupling = length_by_end.dot(&sideways_w);
                own[(at, length)] += coupling;
                own[(length, at)] += coupling;
            }
            let by_support = end * sideways_w;
            for axis in 0..3 {
                own[(at, self.count + axis)] += by_support[axis];
                own[(self.count + axis, at)] += by_support[axis];
            }
        }
        let mut view = own.fixed_view_mut::<3, 3>(self.count, self.count);
        view += end + forces.support_stiffness_w * of.stiffness;
        own
    }

    /// Solves the columns of the rope's inner nodes for z and support; the result is what the end at the platform has
    /// of each.
    fn solve_columns(&mut self, far: &FarEnd, rope: &RopeMesh, factor: &Skyline) -> Vec<Vec3> {
        let places = far.places();
        let mut on_end = vec![Vec3::zeros(); self.columns.len()];
        for (k, column) in self.columns.iter_mut().enumerate() {
            column.fill(0.0);
            let is_length = places.feed == Some(k);
            let direction_w = match self.swivel {
                Some((at, sideways_w)) if at == k => Some(sideways_w),
                _ if k >= self.count => Some(Vec3::ith(k - self.count, 1.0)),
                _ => None,
            };
            if !is_length && direction_w.is_none() {
                continue;
            }
            let mut put = |node: usize, value: &Vec3| {
                let row = 3 * (rope.last() - 1 - node);
                for axis in 0..3 {
                    column[row + axis] += value[axis];
                }
            };
            if is_length {
                (0..rope.last()).for_each(|node| put(node, &three(&self.border.by_length, 3 * node)));
            }
            if let Some(direction_w) = direction_w {
                let first = rope.last() - rope.basis.degree;
                for (q, block) in self.border.by_end[..rope.basis.degree].iter().enumerate() {
                    put(first + q, &(block * direction_w));
                }
            }
            // The node on the platform keeps its own numbers.
            let kept = factor.take_kept(column);
            on_end[k] = kept - factor.forward(column);
        }
        on_end
    }

    /// Schur complement of z, end and support after the rope; of it what end and support keep after z.
    fn complement(&mut self, far: &FarEnd, own: &DMat, on_end: &[Vec3]) -> Result<Mat6, NotPositive> {
        let mut outer = DMat::zeros(self.count, OUTER);
        let mut core = own.view((0, 0), (self.count, self.count)).into_owned();
        let mut left = Mat6::zeros();
        let supports = self.columns.len() - self.count;
        let inner = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        for k in 0..self.count {
            for l in 0..=k {
                let lost = inner(&self.columns[k], &self.columns[l]);
                core[(k, l)] -= lost;
                if k != l {
                    core[(l, k)] -= lost;
                }
            }
            for axis in 0..3 {
                outer[(k, axis)] = on_end[k][axis];
            }
            for axis in 0..supports {
                outer[(k, 3 + axis)] =
                    own[(k, self.count + axis)] - inner(&self.columns[k], &self.columns[self.count + axis]);
            }
        }
        for row in 0..supports {
            for column in 0..supports {
                left[(3 + row, 3 + column)] = own[(self.count + row, self.count + column)]
                    - inner(&self.columns[self.count + row], &self.columns[self.count + column]);
            }
            for axis in 0..3 {
                left[(3 + row, axis)] = on_end[self.count + row][axis];
                left[(axis, 3 + row)] = on_end[self.count + row][axis];
            }
        }
        self.fix(far, &mut core, &mut outer);
        if self.count > 0 {
            self.inverse = core.try_inverse().ok_or(NotPositive)?;
            let lost = outer.transpose() * &self.inverse * &outer;
            left -= Mat6::from_iterator(lost.iter().copied());
        }
        self.outer = outer;
        Ok(left)
    }

    /// Takes numbers that do not move out of the matrix: a station that follows its command, a swivel on its axis.
    fn fix(&mut self, far: &FarEnd, core: &mut DMat, outer: &mut DMat) {
        let places = far.places();
        let is_held = &mut self.is_held;
        is_held.fill(false);
        let mut hold = |k: usize| {
            is_held[k] = true;
            core.row_mut(k).fill(0.0);
            core.column_mut(k).fill(0.0);
            core[(k, k)] = 1.0;
            outer.row_mut(k).fill(0.0);
        };
        if self.swivel.is_none() {
            places.swivel.into_iter().for_each(&mut hold);
        }
        if let (Some(feed), Some(at)) = (&far.feed, places.feed)
            && feed.follows_command()
        {
            hold(at + feed.count() - 1);
            places.integral.into_iter().chain(places.delayed).for_each(&mut hold);
        }
    }

    /// Right-hand side of z from that of the rope, which is forward solved, and its own; what end and support receive
    /// of both.
    pub(super) fn forward(&mut self, rows: &[f64], needed: &[f64]) -> [Vec3; 2] {
        let inner = |a: &[f64]| rows.iter().zip(a).map(|(x, y)| x * y).sum::<f64>();
        for (k, needed) in needed.iter().enumerate() {
            self.z[k] = if self.is_held[k] { 0.0 } else { needed - inner(&self.columns[k]) };
        }
        let solved = &self.inverse * &self.z;
        let received = self.outer.transpose() * &solved;
        let mut on_support = three(received.as_slice(), 3);
        for (axis, column) in self.columns[self.count..].iter().enumerate() {
            on_support[axis] += inner(column);
        }
        self.z = solved;
        [three(received.as_slice(), 0), on_support]
    }

    /// Correction of z, and what the rope's right-hand side loses by it and by the motion of the support.
    pub(super) fn backward(&mut self, rows: &mut [f64], of_end: &Vec3, of_support: &Vec3) {
        let outside = joined(of_end, of_support);
        let outside = DVec::from_column_slice(outside.as_slice());
        self.z = -&self.z - &self.inverse * (&self.outer * outside);
        for (k, column) in self.columns.iter().enumerate() {
            let by = if k < self.count { self.z[k] } else { of_support[k - self.count] };
            // The correction is minus what the rows give.
            rows.iter_mut().zip(column).for_each(|(row, entry)| *row += by * entry);
        }
    }
}

/// Adds the delay of a servo between its angle and its torque.
fn add_delayed_servo(own: &mut DMat, far: &FarEnd, of: Newton) {
    let places = far.places();
    if let (Some(feed), Some(at), Some(delayed)) = (&far.feed, places.feed, places.delayed)
        && let Some((delay, gains)) = feed.delayed_servo()
    {
        let last = at + feed.count() - 1;
        let [after, before] = delayed_weights(delay, [of.stiffness, of.damping, of.mass]);
        own[(delayed, delayed)] += after;
        own[(delayed, last)] -= before;
        own[(last, delayed)] += gains[0] * of.stiffness + gains[1] * of.damping;
    }
}

//! Robot of bars: every cable is a row of straight two-node bars with consistent mass, the platform is a rigid body.
//!
//! Its matrices are derived from the energy, without the library's dynamics. From the program the robot uses only the
//! equilibrium (places and tensions along the cables, forces on the platform). Natural frequencies are counted: by
//! Sylvester's law the signs of the pivots of a block elimination, cable by cable from the anchor to the platform, are
//! those of the eigenvalues of `K − ω² M`.

use funicular::math::{DMat, Mat3, Mat6, Vec3, Vec6, skew};
use funicular::robot::{PlatformMotion, Robot};
use funicular::statics::{CableState, Equilibrium};
use std::f64::consts::PI;

/// Stiffness of one bar: in plane (horizontal and horizontal, mixed, up and up), and out of plane [N/m].
#[derive(Debug, Clone, Copy)]
struct Bar {
    hh: f64,
    hv: f64,
    vv: f64,
    out_of_plane: f64,
}

/// Cable as a row of bars, from the platform to its anchor.
#[derive(Debug)]
struct RowOfBars {
    bars: Vec<Bar>,
    /// Unstrained mass of a bar [kg].
    bar_mass: f64,
    /// Axes: horizontal towards the anchor, up, out of plane.
    axes_w: [Vec3; 3],
    lever_w: Vec3,
    span: Span,
}

/// Data from which the number of bars of a cable follows.
#[derive(Debug, Clone, Copy)]
struct Span {
    /// `L √(m (EA + T)/(EA T))` at the minimum tension: the phase of the slowest wave over ω [s]. Zero if massless.
    phase: f64,
    /// Angle through which the cable would bend if it had its maximum curvature everywhere.
    bend: f64,
    /// Ratio of EA to the minimum tension.
    stiff: f64,
}

/// Robot of bars.
#[derive(Debug)]
pub(crate) struct Bars {
    rows: Vec<RowOfBars>,
    dof: usize,
    /// Geometric stiffness of static forces on their lever arms, and mass, of the platform about its origin, world
    /// axes.
    platform_stiffness: Mat6,
    platform_mass: Mat6,
    /// Length by which rotations are multiplied [m].
    length: f64,
    /// Factor 1/(1 − γ) on the error, because static forces reduce the stiffness; see [`Bars::bound`].
    softening: f64,
}

impl Bars {
    /// Robot with so many bars that [`Bars::bound`] at `omega` [rad/s] is below `wanted`.
    pub(crate) fn fine_enough(robot: &Robot, rest: &Equilibrium, omega: f64, wanted: f64) -> Self {
        let counts = |wanted: f64| -> Vec<usize> {
            let cables = robot.cables.iter().zip(&rest.cables);
            cables.map(|(cable, state)| Span::of(state, cable.material.mass_per_length).bars(omega, wanted)).collect()
        };
        let bars = Self::new(robot, rest, &counts(wanted));
        if bars.softening > 1.0 && bars.softening < 1e3 {
            return Self::new(robot, rest, &counts(wanted / bars.softening));
        }
        bars
    }

    /// Robot with given numbers of bars in each cable; a massless cable is straight, and one bar is exact.
    pub(crate) fn new(robot: &Robot, rest: &Equilibrium, counts: &[usize]) -> Self {
        let up = robot.up_w();
        let mut rows = Vec::new();
        let rot = rest.pose.rot_wp.to_rotation_matrix();
        let com = rot * robot.platform.center_of_mass_p;
        let (mut platform_stiffness, mut platform_mass) = (Mat6::zeros(), Mat6::zeros());
        let mut add = |force: &Vec3, lever: &Vec3| {
            // A constant force f on a lever arm r does the work f·(θ×(θ×r))/2 of second order in a turn θ.
            let outer = force * lever.transpose();
            let turn = Mat3::identity() * force.dot(lever) - (outer + outer.transpose()) * 0.5;
            let mut block = platform_stiffness.fixed_view_mut::<3, 3>(3, 3);
            block += turn;
        };
        add(&(robot.gravity_w * robot.platform.mass), &com);
        for ((cable, state), count) in robot.cables.iter().zip(&rest.cables).zip(counts) {
            add(&state.force_on_platform_w, &state.lever_w);
            rows.push(RowOfBars::new(cable.material.mass_per_length, state, up, *count));
        }
        // Kinetic energy of the mass at the centre of mass, and of the rotation about it.
        let mut motion_of_com = Mat6::zeros();
        motion_of_com.fixed_view_mut::<3, 3>(0, 0).copy_from(&Mat3::identity());
        motion_of_com.fixed_view_mut::<3, 3>(0, 3).copy_from(&-skew(&com));
        platform_mass += motion_of_com.transpose() * motion_of_com * robot.platform.mass;
        let mut block = platform_mass.fixed_view_mut::<3, 3>(3, 3);
        block += rot.matrix() * robot.platform.inertia_p * rot.matrix().transpose();
        let dof = match robot.platform.motion {
            PlatformMotion::Rigid => 6,
            PlatformMotion::PointMass => 3,
            PlatformMotion::Planar(_) => panic!("the random robots have none"),
        };
        let longest = rest.cables.iter().map(|c| c.lever_w.norm()).fold(0.0, f64::max);
        let length = if longest > 0.0 { longest } else { 1.0 };
        let mut all = Self { rows, dof, platform_stiffness, platform_mass, length, softening: 1.0 };
        all.softening = all.softening();
        all
    }

    /// Number of bars in each cable.
    pub(crate) fn counts(&self) -> Vec<usize> {
        self.rows.iter().map(|row| row.bars.len()).collect()
    }

    /// Maximum relative error of a natural frequency ω [rad/s] of these bars.
    ///
    /// A straight bar of length h with consistent mass carries a wave of number k with a frequency that is too high by
    /// (kh)²/24: its energy lacks ∫ u″² h²/12 of ∫ u′². Here u″ follows from the equation of motion. A change of
    /// tension that is constant along the cable (the chord stretches, the sag gives way) adds a parabola over the
    /// length L, (πh/L)²/24. The bar is straight where the cable turns by κh, which adds (κh)²/24. The bound is three
    /// times their sum, for a cable in which all three meet; in 2,000 robots one frequency needed two thirds of that.
    ///
    /// All these errors are fractions of the cables' energy. If static forces on lever arms reduce the stiffness, the
    /// same change is a larger fraction of the remaining energy: at most by the factor `1/(1 − γ)`, if they cancel the
    /// fraction γ of the cables' static stiffness, which is the minimum energy of the cables for a motion of the
    /// platform.
    ///
    /// Rounding is added: EA is known to ε EA. Rotated out of the bar's direction this is ε EA/T of T, and each of N
    /// bars contributes.
    pub(crate) fn bound(&self, omega: f64) -> f64 {
        self.softening * self.rows.iter().map(|row| row.bound(omega)).fold(0.0, f64::max)
    }

    fn softening(&self) -> f64 {
        let cables = self.scaled(&self.condensed(0.0).0);
        let levers = self.scaled(&self.platform_stiffness);
        let Some(factor) = cables.cholesky() else { return f64::INFINITY };
        let half = factor.l().solve_lower_triangular(&levers).expect("regular");
        let part = factor.l().solve_lower_triangular(&half.transpose()).expect("regular");
        let taken = -part.symmetric_eigenvalues().min();
        if taken < 1.0 { 1.0 / (1.0 - taken.max(0.0)) } else { f64::INFINITY }
    }

    /// Scales a matrix over the platform's degrees of freedom: rotations are multiplied by a length.
    fn scaled(&self, matrix: &Mat6) -> DMat {
        let scale = |i: usize| if i < 3 { 1.0 } else { 1.0 / self.length };
        DMat::from_fn(self.dof, self.dof, |i, j| matrix[(i, j)] * scale(i) * scale(j))
    }

    /// Matrix `K − ω² M` of the cables condensed onto the platform, and the number of negative pivots of the
    /// condensation.
    fn condensed(&self, omega: f64) -> (Mat6, usize) {
        let (mut total, mut negative) = (Mat6::zeros(), 0);
        for row in &self.rows {
            let ([hh, hv, vv, out_of_plane], below) = row.condensed(omega);
            negative += below;
            let [e, n, b] = row.axes_w.map(|axis| vector(&axis, &row.lever_w));
            total += e * e.transpose() * hh + n * n.transpose() * vv + b * b.transpose() * out_of_plane;
            total += (e * n.transpose() + n * e.transpose()) * hv;
        }
        (total, negative)
    }

    /// Number of natural frequencies below ω [rad/s], including the unstable directions.
    pub(crate) fn below(&self, omega: f64) -> usize {
        let (cables, negative) = self.condensed(omega);
        let all = cables + self.platform_stiffness - self.platform_mass * (omega * omega);
        negative + self.scaled(&all).symmetric_eigenvalues().iter().filter(|value| **value < 0.0).count()
    }

    /// Natural frequency number `index` [rad/s], from zero, between two frequencies with different counts.
    pub(crate) fn frequency(&self, index: usize, mut low: f64, mut high: f64) -> f64 {
        while high - low > 1e-13 * high {
            let middle = 0.5 * (low + high);
            if self.below(middle) > index { high = middle } else { low = middle }
        }
        0.5 * (low + high)
    }

    /// Stiffness and mass of all nodes and the platform; the anchors are held.
    fn dense(&self) -> (DMat, DMat) {
        let inner: usize = self.rows.iter().map(|row| 3 * (row.bars.len() - 1)).sum();
        let size = self.dof + inner;
        let (mut stiffness, mut mass) = (DMat::zeros(size, size), DMat::zeros(size, size));
        let platform = |matrix: &Mat6| matrix.view((0, 0), (self.dof, self.dof)).clone_owned();
        stiffness.view_mut((0, 0), (self.dof, self.dof)).copy_from(&platform(&self.platform_stiffness));
        mass.view_mut((0, 0), (self.dof, self.dof)).copy_from(&platform(&self.platform_mass));
        let mut next = self.dof;
        for row in &self.rows {
            // Motion of every node in world axes over all unknowns.
            let count = row.bars.len();
            let node = |k: usize| {
                let mut of_all = DMat::zeros(3, size);
                if k == 0 {
                    for (component, axis) in row.axes_w.iter().enumerate() {
                        let vector = vector(axis, &row.lever_w);
                        (0..self.dof).for_each(|i| of_all[(component, i)] = vector[i]);
                    }
                } else if k < count {
                    (0..3).for_each(|d| of_all[(d, next + 3 * (k - 1) + d)] = 1.0);
                }
                of_all
            };
            for (k, bar) in row.bars.iter().enumerate() {
                let (one, other) = (node(k), node(k + 1));
                let of_bar =
                    DMat::from_row_slice(3, 3, &[bar.hh, bar.hv, 0., bar.hv, bar.vv, 0., 0., 0., bar.out_of_plane]);
                let stretch = &other - &one;
                stiffness += stretch.transpose() * of_bar * &stretch;
                let (mean, half) = ((&one + &other) * 0.5, &stretch * 0.5);
                mass += (mean.transpose() * mean + half.transpose() * half / 3.0) * row.bar_mass;
            }
            next += 3 * (count - 1);
        }
        (stiffness, mass)
    }
}

/// Motion of a point on the lever arm along an axis, over the platform's six degrees of freedom.
fn vector(axis: &Vec3, lever: &Vec3) -> Vec6 {
    let turn = lever.cross(axis);
    Vec6::new(axis.x, axis.y, axis.z, turn.x, turn.y, turn.z)
}

impl Span {
    fn of(state: &CableState, mass_per_length: f64) -> Self {
        let catenary = &state.hanging.as_ref().expect("catenaries").catenary;
        let rope = catenary.rope();
        let (h, v) = (catenary.horizontal_force(), catenary.vertical_force_at_start());
        // At the lowest point if the cable has one.
        let (weight, length) = (rope.weight_per_length, rope.unstrained_length);
        let lowest = if weight > 0.0 { (-v / weight).clamp(0.0, length) } else { 0.0 };
        let (least, ea) = (catenary.tension_at(lowest), rope.axial_stiffness);
        let phase = length * (mass_per_length * (ea + least) / (ea * least)).sqrt();
        Self { phase, bend: length * weight * h / (least * least), stiff: ea / least }
    }

    /// Bound of [`Bars::bound`] without rounding, times the square of the number of bars.
    fn defect(&self, omega: f64) -> f64 {
        if self.phase == 0.0 { 0.0 } else { ((self.phase * omega).powi(2) + PI.powi(2) + self.bend.powi(2)) / 8.0 }
    }

    fn bars(&self, omega: f64, wanted: f64) -> usize {
        // A minimum number, and a maximum for the computing time; the bound includes the remaining error.
        (self.defect(omega) / wanted).sqrt().ceil().clamp(4.0, 20_000.0) as usize
    }
}

impl RowOfBars {
    fn new(mass_per_length: f64, state: &CableState, up: Vec3, count: usize) -> Self {
        let hanging = state.hanging.as_ref().expect("catenaries");
        let rope = hanging.catenary.rope();
        let (along_w, _) = hanging.axes_w();
        let span = Span::of(state, mass_per_length);
        let count = if mass_per_length == 0.0 { 1 } else { count };
        let step = rope.unstrained_length / count as f64;
        let mut from = [0.0, 0.0];
        let bars = (0..count).map(|k| {
            let to = hanging.catenary.point_at((k as f64 + 1.0) * step);
            let (dx, dz) = (to[0] - from[0], to[1] - from[1]);
            from = to;
            let length = dx.hypot(dz);
            let (c, s) = (dx / length, dz / length);
            let out_of_plane = hanging.catenary.tension_at((k as f64 + 0.5) * step) / length;
            let along = rope.axial_stiffness / step;
            Bar {
                hh: along * c * c + out_of_plane * s * s,
                hv: (along - out_of_plane) * c * s,
                vv: along * s * s + out_of_plane * c * c,
                out_of_plane,
            }
        });
        let axes_w = [along_w, up, along_w.cross(&up)];
        Self { bars: bars.collect(), bar_mass: mass_per_length * step, axes_w, lever_w: state.lever_w, span }
    }

    fn bound(&self, omega: f64) -> f64 {
        let squared = (self.bars.len() as f64).powi(2);
        self.span.defect(omega) / squared + f64::EPSILON * self.span.stiff * self.bars.len() as f64 + 1e-9
    }

    /// Matrix `K − ω² M` of the platform end (hh, hv, vv, out of plane), all inner nodes eliminated from the anchor on,
    /// and the number of negative pivots.
    ///
    /// With i = ω² m h/6 a bar has `k − 2i` on the diagonal and `−A = −(k + i)` off it. If the bars behind a node put
    /// the stiffness R there, its pivot is `A + Q` with `Q = R − 3i`, and the stiffness at the node before is
    /// `k − 2i − A (A + Q)⁻¹ A = Q − Q (A + Q)⁻¹ Q − 3i`: with the smaller of A and Q, so that no large terms cancel.
    fn condensed(&self, omega: f64) -> ([f64; 4], usize) {
        let inertia = self.bar_mass * omega * omega / 6.0;
        let mut negative = 0;
        // R at the node before the anchor.
        let last = &self.bars[self.bars.len() - 1];
        let (mut hh, mut hv, mut vv, mut out_of_plane) =
            (last.hh - 2.0 * inertia, last.hv, last.vv - 2.0 * inertia, last.out_of_plane - 2.0 * inertia);
        for bar in self.bars[..self.bars.len() - 1].iter().rev() {
            let (a, b, c, d) = (hh - 3.0 * inertia, hv, vv - 3.0 * inertia, out_of_plane - 3.0 * inertia);
            let (p, q, r) = (a + bar.hh + inertia, b + bar.hv, c + bar.vv + inertia);
            let pivot = d + bar.out_of_plane + inertia;
            let determinant = p * r - q * q;
            // Signs of the eigenvalues of a 2×2 matrix: different if the determinant is negative, otherwise those of
            // the diagonal.
            negative += if determinant < 0.0 { 1 } else { 2 * usize::from(p + r < 0.0) } + usize::from(pivot < 0.0);
            let behind = a.abs().max(c.abs()) <= bar.hh.max(bar.vv);
            let [a, b, c] = if behind { [a, b, c] } else { [bar.hh + inertia, bar.hv, bar.vv + inertia] };
            // Rows of M (A + Q)⁻¹, where M is the smaller of Q and A.
            let (s, t) = ((a * r - b * q) / determinant, (b * p - a * q) / determinant);
            let (u, v) = ((b * r - c * q) / determinant, (c * p - b * q) / determinant);
            hh = a - (s * a + t * b) - 3.0 * inertia;
            hv = b - 0.5 * (s * b + t * c + u * a + v * b);
            vv = c - (u * b + v * c) - 3.0 * inertia;
            let d = if d.abs() <= bar.out_of_plane { d } else { bar.out_of_plane + inertia };
            out_of_plane = d - d * d / pivot - 3.0 * inertia;
        }
        ([hh, hv, vv, out_of_plane], negative)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::campaign::robots::{self, Purpose};
    use funicular::statics::{self, StaticModel};

    /// Robots with an equilibrium, from the first on.
    fn at_rest(most: usize) -> impl Iterator<Item = (robots::RandomRobot, Equilibrium)> {
        let proper = |sample: &robots::RandomRobot| sample.purpose == Purpose::Proper;
        (0..).map(robots::sample).filter(proper).take(most).map(|sample| {
            let rest =
                statics::forward(&sample.robot, &sample.lengths, StaticModel::Catenary, Some(&sample.pose)).unwrap();
            (sample, rest)
        })
    }

    #[test]
    fn the_count_of_pivots_is_that_of_all_eigenvalues() {
        for (sample, rest) in at_rest(12) {
            for coarse in [1, 3] {
                // So few unknowns that a dense solution is possible, with different numbers for the cables.
                let counts: Vec<usize> = (0..rest.cables.len()).map(|i| coarse + (2 * i) % 5).collect();
                let bars = Bars::new(&sample.robot, &rest, &counts);
                let (stiffness, mass) = bars.dense();
                let factor = mass.cholesky().expect("mass is positive").l();
                let half = factor.solve_lower_triangular(&stiffness).unwrap();
                let all = factor.solve_lower_triangular(&half.transpose()).unwrap().symmetric_eigenvalues();
                let mut squares: Vec<f64> = all.iter().copied().collect();
                squares.sort_by(f64::total_cmp);
                let largest = squares[squares.len() - 1];
                for (i, pair) in squares.windows(2).enumerate() {
                    // Between neighbours that the dense eigenvalues separate.
                    if pair[0] > 0.0 && pair[1] - pair[0] > 1e-12 * largest {
                        let omega = (0.5 * (pair[0] + pair[1])).sqrt();
                        assert_eq!(bars.below(omega), i + 1, "robot {}, between {pair:?}", sample.index);
                    }
                }
            }
        }
    }
}

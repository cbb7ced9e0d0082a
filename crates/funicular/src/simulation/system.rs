//! Platform and ropes as one system: the forces that a motion needs, and Newton's corrections of it.
//!
//! A motion is stored as numbers in a row: centre of mass, turn since the beginning of the step, then the nodes of each
//! rope. A node on the platform is filled from the motion of the platform.

use super::body::{BodyMotion, MovingBody, halves, joined};
use super::rope::{Newton, RopeMesh, WoundLength};
use super::skyline::{NotPositive, Profile3, Skyline};
use super::winding::Winding;
use crate::math::{Mat3, Mat6, Rotation, Vec3, Vec6, inverse6, skew};

/// Number of numbers of the platform in a motion.
pub(super) const BODY: usize = 6;

/// End of a rope at the platform.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum RopeEnd {
    /// On the platform.
    Attached,
    /// Free after a cut.
    Free,
    /// A rope without mass that was cut: it is gone.
    Gone,
}

/// Platform and ropes.
pub(super) struct System {
    pub(super) body: MovingBody,
    pub(super) ropes: Vec<RopeMesh>,
    pub(super) ends: Vec<RopeEnd>,
    pub(super) windings: Vec<Winding>,
    /// First number of each rope in a motion.
    pub(super) offsets: Vec<usize>,
    /// Number of numbers of a motion.
    pub(super) size: usize,
    /// Wind at a time: the mean and gusts.
    pub(super) air: super::air::Air,
    /// Rotation of the platform at the beginning of the step.
    pub(super) rotation: Rotation,
    /// Residuals computed so far.
    pub(super) evaluations: usize,
}

/// Positions, velocities and accelerations of a motion.
#[derive(Debug, Clone, Default)]
pub(super) struct MotionNumbers {
    pub(super) x: Vec<f64>,
    pub(super) v: Vec<f64>,
    pub(super) a: Vec<f64>,
}

impl MotionNumbers {
    pub(super) fn zeros(size: usize) -> Self {
        Self { x: vec![0.0; size], v: vec![0.0; size], a: vec![0.0; size] }
    }
}

/// The first six numbers.
#[inline]
pub(super) fn six(numbers: &[f64]) -> Vec6 {
    Vec6::from_column_slice(&numbers[..BODY])
}

#[inline]
fn three(numbers: &[f64], from: usize) -> Vec3 {
    Vec3::from_column_slice(&numbers[from..from + 3])
}

/// Rate of the turn θ in the chart `R = R_n exp θ` for an angular velocity in platform axes.
///
/// # References
/// docs/theory.md, equation (97c).
pub(super) fn turn_rate(turn: &Vec3, omega: &Vec3) -> Vec3 {
    let square = turn.norm_squared();
    // (1 − (φ/2) cot(φ/2))/φ²; the series has an error of φ⁶/30240·… below the switch.
    let factor = if square < 1e-4 {
        1.0 / 12.0 + square / 720.0
    } else {
        let half = 0.5 * square.sqrt();
        (1.0 - half / half.tan()) / square
    };
    let once = turn.cross(omega);
    omega + once * 0.5 + turn.cross(&once) * factor
}

impl System {
    /// Motion of the platform in a row of numbers.
    pub(super) fn body_motion(&self, m: &MotionNumbers) -> BodyMotion {
        BodyMotion {
            center_w: three(&m.x, 0),
            rot_wp: self.rotation_at(&three(&m.x, 3)).to_rotation_matrix().into_inner(),
            velocity: six(&m.v),
            acceleration: six(&m.a),
        }
    }

    /// Rotation after a turn since the beginning of the step.
    pub(super) fn rotation_at(&self, turn: &Vec3) -> Rotation {
        self.rotation * Rotation::from_scaled_axis(*turn)
    }

    /// Numbers of rope `i` in a motion.
    #[inline]
    pub(super) fn of_rope(&self, i: usize) -> std::ops::Range<usize> {
        self.offsets[i]..self.offsets[i] + self.ropes[i].size()
    }

    /// Fills the nodes on the platform.
    pub(super) fn fill_ends(&self, body: &BodyMotion, m: &mut MotionNumbers) {
        for (i, end) in self.ends.iter().enumerate() {
            if *end != RopeEnd::Attached {
                continue;
            }
            let [x, v, a] = body.point(&self.body.lever_p(i));
            let from = self.offsets[i];
            m.x[from..from + 3].copy_from_slice(x.as_slice());
            m.v[from..from + 3].copy_from_slice(v.as_slice());
            m.a[from..from + 3].copy_from_slice(a.as_slice());
        }
    }

    /// Lengths of all ropes at a time.
    pub(super) fn lengths(&self, time: f64) -> Vec<WoundLength> {
        self.windings.iter().map(|winding| winding.at(time)).collect()
    }

    /// Forces that the motion needs, in a row of numbers: zero where the motion is right, at the ends of the ropes what
    /// holds them. The ends have been filled.
    pub(super) fn needed(
        &mut self,
        time: f64,
        lengths: &[WoundLength],
        body: &BodyMotion,
        m: &MotionNumbers,
        out: &mut [f64],
    ) {
        self.evaluations += 1;
        out.fill(0.0);
        let mut on_body = self.body.needed(time, &self.air.on_body(time), body);
        for (i, rope) in self.ropes.iter().enumerate() {
            if self.ends[i] == RopeEnd::Gone {
                continue;
            }
            let range = self.of_rope(i);
            let wind = self.air.on_rope(i, time);
            let out = &mut out[range.clone()];
            rope.needed(&lengths[i], &wind, &m.x[range.clone()], &m.v[range.clone()], &m.a[range], out);
            if self.ends[i] == RopeEnd::Attached {
                on_body += MovingBody::wrench(body, &self.body.lever_p(i), &three(out, 0));
            }
        }
        out[..BODY].copy_from_slice(on_body.as_slice());
    }
}

/// Factored Newton matrix of the system: the ropes, and the platform behind them.
pub(super) struct Arrow {
    factors: Vec<Skyline>,
    /// Stiffness of each attached end as the platform meets it.
    complements: Vec<Mat3>,
    /// Translation of each attached end for a turn of the platform, `−R [a]×`.
    turns: Vec<Mat3>,
    /// Inverse of the matrix of the platform's coordinates.
    inverse: Mat6,
    /// Work space: right-hand sides of the ropes in the order of their rows.
    rows: Vec<Vec<f64>>,
}

impl Arrow {
    pub(super) fn new(system: &System) -> Self {
        let shape = |rope: &RopeMesh| Skyline::zeros(Profile3::new(rope.elements, rope.basis.degree));
        Self {
            factors: system.ropes.iter().map(shape).collect(),
            complements: vec![Mat3::zeros(); system.ropes.len()],
            turns: vec![Mat3::zeros(); system.ropes.len()],
            inverse: Mat6::identity(),
            rows: system.ropes.iter().map(|rope| vec![0.0; rope.size() - 3]).collect(),
        }
    }

    /// Factors the Newton matrix at a motion, whose needed forces are `needed`.
    ///
    /// # References
    /// docs/theory.md, equations (97h) and (97i).
    pub(super) fn factor(
        &mut self,
        system: &System,
        time: f64,
        lengths: &[WoundLength],
        m: &MotionNumbers,
        needed: &[f64],
        of: Newton,
    ) -> Result<(), NotPositive> {
        let body = system.body_motion(m);
        let mut matrix = system.body.matrix(&body, of.mass, of.damping, of.stiffness);
        for (i, rope) in system.ropes.iter().enumerate() {
            let (range, end) = (system.of_rope(i), system.ends[i]);
            if end == RopeEnd::Gone {
                continue;
            }
            let wind = system.air.on_rope(i, time);
            let factor = &mut self.factors[i];
            rope.assemble(&lengths[i], &wind, &m.x[range.clone()], &m.v[range.clone()], of, factor);
            let complement = factor.factor(end == RopeEnd::Attached)?;
            if end == RopeEnd::Free {
                continue;
            }

            let lever = system.body.lever_p(i);
            let turn = -body.rot_wp * skew(&lever);
            let by_turn = complement * turn;
            let force_p = body.rot_wp.transpose() * three(needed, range.start);
            let mut add = |row, column, block: &Mat3| {
                let mut view = matrix.fixed_view_mut::<3, 3>(row, column);
                view += block;
            };
            add(0, 0, &complement);
            add(0, 3, &by_turn);
            add(3, 0, &by_turn.transpose());
            add(3, 3, &(turn.transpose() * by_turn + skew(&lever) * skew(&force_p) * of.stiffness));
            self.complements[i] = complement;
            self.turns[i] = turn;
        }
        self.inverse = inverse6(&system.body.reduced_matrix(&matrix)).ok_or(NotPositive)?;
        Ok(())
    }

    /// Correction of the velocities that takes the needed forces to zero, written over them.
    pub(super) fn solve(&mut self, system: &System, needed: &mut [f64]) {
        let mut on_body = six(needed);
        for (i, rope) in system.ropes.iter().enumerate() {
            let end = system.ends[i];
            if end == RopeEnd::Gone {
                continue;
            }
            let (from, free) = (system.offsets[i], rope.last());
            let rows = &mut self.rows[i];
            for node in 0..free {
                let row = 3 * (free - 1 - node);
                rows[row..row + 3].copy_from_slice(&needed[from + 3 * node..from + 3 * node + 3]);
            }
            let passed = self.factors[i].forward(rows);
            if end == RopeEnd::Attached {
                on_body -= joined(&passed, &self.turns[i].tr_mul(&passed));
            }
        }

        let move_of_body = -system.body.expanded(&(self.inverse * system.body.reduced(&on_body)));
        let (translation, turn) = halves(&move_of_body);
        needed[..BODY].copy_from_slice(move_of_body.as_slice());
        for (i, rope) in system.ropes.iter().enumerate() {
            let end = system.ends[i];
            let (from, free) = (system.offsets[i], rope.last());
            if end == RopeEnd::Gone {
                needed[from..from + rope.size()].fill(0.0);
                continue;
            }
            let of_end = translation + self.turns[i] * turn;
            let rows = &mut self.rows[i];
            // `backward` subtracts; the correction has the opposite sign of the right-hand side.
            self.factors[i].backward(rows, &if end == RopeEnd::Attached { -of_end } else { Vec3::zeros() });
            for node in 0..free {
                let row = 3 * (free - 1 - node);
                for axis in 0..3 {
                    needed[from + 3 * node + axis] = -rows[row + axis];
                }
            }
            if end == RopeEnd::Attached {
                needed[from..from + 3].copy_from_slice(of_end.as_slice());
            }
            needed[from + 3 * free..from + 3 * free + 3].fill(0.0);
        }
    }
}

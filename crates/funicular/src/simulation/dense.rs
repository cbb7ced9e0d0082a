//! Motion within a step: polynomials of the fifth degree through both ends.

use super::system::{BODY, MotionNumbers, turn_rate};
use crate::math::{Rotation, Vec3};

/// Motion between the two ends of a step.
#[derive(Clone)]
pub(super) struct DenseOutput {
    pub(super) from: f64,
    pub(super) until: f64,
    /// Rotation at the beginning, from which turns count.
    pub(super) rotation: Rotation,
    before: MotionNumbers,
    after: MotionNumbers,
}

/// Hermite polynomial of the fifth degree with its derivatives: values, rates times h and accelerations times h² at
/// both ends, at s in [0, 1].
fn quintic([x0, v0, a0]: [f64; 3], [x1, v1, a1]: [f64; 3], s: f64) -> [f64; 3] {
    let (d, e, f) = (x1 - x0 - v0 - 0.5 * a0, v1 - v0 - a0, a1 - a0);
    let (c3, c4, c5) = (10.0 * d - 4.0 * e + 0.5 * f, -15.0 * d + 7.0 * e - f, 6.0 * d - 3.0 * e + 0.5 * f);
    [
        x0 + s * (v0 + s * (0.5 * a0 + s * (c3 + s * (c4 + s * c5)))),
        v0 + s * (a0 + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5))),
        a0 + s * (6.0 * c3 + s * (12.0 * c4 + s * 20.0 * c5)),
    ]
}

impl DenseOutput {
    pub(super) fn new(from: f64, until: f64, rotation: Rotation, before: MotionNumbers, after: MotionNumbers) -> Self {
        Self { from, until, rotation, before, after }
    }

    /// Motions at both ends.
    pub(super) fn motions(&mut self) -> [&mut MotionNumbers; 2] {
        [&mut self.before, &mut self.after]
    }

    /// Motion at a time of the step, written to `out`; ends of ropes on the platform are to be filled.
    pub(super) fn at(&self, time: f64, out: &mut MotionNumbers) {
        let h = self.until - self.from;
        let s = ((time - self.from) / h).clamp(0.0, 1.0);
        for k in 0..self.before.x.len() {
            let end = |m: &MotionNumbers| [m.x[k], m.v[k] * h, m.a[k] * h * h];
            let [x, v, a] = quintic(end(&self.before), end(&self.after), s);
            (out.x[k], out.v[k], out.a[k]) = (x, v / h, a / (h * h));
        }
        self.turn_at(s, h, out);
    }

    fn turn_at(&self, s: f64, h: f64, out: &mut MotionNumbers) {
        let of = |values: &[f64]| Vec3::from_column_slice(&values[3..BODY]);
        let (omega, alpha) = (of(&self.before.v), of(&self.before.a));
        let (turn, end_omega, end_alpha) = (of(&self.after.x), of(&self.after.v), of(&self.after.a));
        let rate = turn_rate(&turn, &end_omega);
        // Change of the rate along the motion, by a central difference whose error is far below that of the step.
        let near = 1e-3 * h;
        let shifted = |by: f64| turn_rate(&(turn + rate * by), &(end_omega + end_alpha * by));
        let change = (shifted(near) - shifted(-near)) / (2.0 * near);
        for axis in 0..3 {
            let k = 3 + axis;
            let start = [0.0, omega[axis] * h, alpha[axis] * h * h];
            out.x[k] = quintic(start, [turn[axis], rate[axis] * h, change[axis] * h * h], s)[0];
            // Angular velocity by the cubic through both ends.
            let (v0, v1) = (omega[axis], end_omega[axis]);
            let (a0, a1) = (alpha[axis] * h, end_alpha[axis] * h);
            let (c2, c3) = (3.0 * (v1 - v0) - 2.0 * a0 - a1, 2.0 * (v0 - v1) + a0 + a1);
            out.v[k] = v0 + s * (a0 + s * (c2 + s * c3));
            out.a[k] = (a0 + s * (2.0 * c2 + s * 3.0 * c3)) / h;
        }
    }
}

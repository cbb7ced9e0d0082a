//! The pencil at a shift, factored: bubbles first, then the platform.

use super::pencil::{Motion, Pencil};
use crate::cable::exact::abreast::Kept;
use crate::math::Mat6;

pub(super) struct Factor {
    /// L below the diagonal, inverse pivots on it.
    platform: Mat6,
    /// Of each arm: stiffness of its bubbles against the end (qn, qe, bo), and the inverses of their pivots.
    bubbles: Vec<([f64; 3], [f64; 2])>,
    /// Pivots that are not positive; as many eigenvalues lie below the shift, if those of what has been eliminated do not.
    pub(super) negative: usize,
}

impl Factor {
    /// Without exchanges: a positive definite pencil needs none, and of another one only a direction is wanted.
    pub(super) fn of(pencil: &Pencil, kept: &[Kept], x: f64) -> Self {
        let n = pencil.freedoms;
        let mut d = pencil.constant - pencil.mass * x;
        let mut bubbles = Vec::with_capacity(pencil.arms.len());
        let mut negative = 0;
        let not_positive = |pivot: f64| usize::from(pivot.is_nan() || pivot <= 0.0);
        for arm in &pencil.arms {
            let (k, lane) = (&kept[arm.group], arm.lane);
            let ([nn, en, ee, qn, qe, qq], [oo, bo, bb]) = k.of(lane);
            negative += 2 * not_positive(k.least_pivot[lane]) + not_positive(qq) + not_positive(bb);
            let (inverse, inverse_across) = (1.0 / qq, 1.0 / bb);
            let nn = nn - qn * qn * inverse;
            let en = en - qn * qe * inverse;
            let ee = ee - qe * qe * inverse;
            let oo = oo - bo * bo * inverse_across;
            let by_n = arm.normal * nn + arm.along * en;
            let by_e = arm.normal * en + arm.along * ee;
            let by_b = arm.out * oo;
            for j in 0..6 {
                for i in 0..6 {
                    d[(i, j)] += arm.normal[i] * by_n[j] + arm.along[i] * by_e[j] + arm.out[i] * by_b[j];
                }
            }
            bubbles.push(([qn, qe, bo], [inverse, inverse_across]));
        }
        for k in 0..n {
            negative += not_positive(d[(k, k)]);
            let inverse = 1.0 / d[(k, k)];
            for j in k + 1..n {
                let factor = d[(j, k)] * inverse;
                for i in j..n {
                    d[(i, j)] -= d[(i, k)] * factor;
                }
            }
            for j in k + 1..n {
                d[(j, k)] *= inverse;
            }
            d[(k, k)] = inverse;
        }
        Self { platform: d, bubbles, negative }
    }

    pub(super) fn solve(&self, pencil: &Pencil, force: &Motion) -> Motion {
        let n = pencil.freedoms;
        let mut v = force.platform;
        let arms = || pencil.arms.iter().zip(&force.bubbles).zip(&self.bubbles);
        for ((arm, [f, g]), ([qn, qe, bo], [inverse, inverse_across])) in arms() {
            let (f, g) = (f * inverse, g * inverse_across);
            v -= arm.wrench([qn * f, qe * f, bo * g]);
        }
        for j in 0..n {
            for i in j + 1..n {
                v[i] -= self.platform[(i, j)] * v[j];
            }
        }
        for j in (0..n).rev() {
            v[j] *= self.platform[(j, j)];
            for i in j + 1..n {
                v[j] -= self.platform[(i, j)] * v[i];
            }
        }
        let bubbles = arms()
            .map(|((arm, [f, g]), ([qn, qe, bo], [inverse, inverse_across]))| {
                let [n, e, b] = arm.end(&v);
                [(f - qn * n - qe * e) * inverse, (g - bo * b) * inverse_across]
            })
            .collect();
        Motion { platform: v, bubbles }
    }
}

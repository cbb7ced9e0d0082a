//! Proof that a load is held nowhere in a box: one direction of wrenches along which the cables fall short everywhere.

use super::cutting::{LinearCut, largest_last};
use super::frame::BoxFrame;
use crate::math::{Vec3, Vec6};

/// Wrench that is missing everywhere in a box.
pub(super) struct Missing {
    /// Direction, reduced; its greatest component is at most 1.
    pub(super) direction: Vec6,
    /// Least size of the wrench that is missing [N].
    pub(super) by: f64,
}

/// Rounding of the test over the sum of the magnitudes of its terms: fewer than a thousand operations.
pub(super) const ROUNDING: f64 = 1e-12;

/// Range of the chord tension of a cable that its limits allow, and what its sag may add.
struct PulledCable {
    tensions: [f64; 2],
    deviation: f64,
    /// Half of its weight per length [N/m].
    hangs: f64,
}

/// Corner of a box: wrenches of unit tensions, and the load with the weight of sagging cables; reduced.
struct Corner {
    columns: Vec<Vec6>,
    load: Vec6,
}

impl BoxFrame<'_> {
    /// Direction along which a load is missing at every position of the box without a turn: (41e).
    pub(super) fn missing(&self, load: usize) -> Option<Missing> {
        let cables = self.pulled()?;
        let corners: Vec<Corner> = self.corners.iter().map(|corner| self.at_corner(corner, load, &cables)).collect();
        let n = self.statement.coordinates.count();
        let scale = corners.iter().map(|corner| corner.load.norm()).fold(1.0, f64::max);
        // Rows: y·(load + wrenches of the best tensions) + s ≤ 0 at each corner, and |y| ≤ 1.
        let mut bounds = vec![1.0; n + 1];
        bounds[n] = 1e4 * scale;
        let next = |x: &[f64], cut: &mut LinearCut| {
            let y = Vec6::from_fn(|i, _| if i < n { x[i] } else { 0.0 });
            let farthest = (0..n).max_by(|a, b| x[*a].abs().total_cmp(&x[*b].abs()));
            if let Some(k) = farthest.filter(|k| x[*k].abs() > 1.0 + 1e-9) {
                cut.row.fill(0.0);
                cut.row[k] = x[k].signum();
                cut.limit = 1.0;
                return true;
            }
            let reach = |corner: &Corner| y.dot(&corner.load) + most(&cables, &corner.columns, &y);
            let reaches = corners.iter().map(|corner| (reach(corner), corner));
            let Some((reach, worst)) = reaches.max_by(|a, b| a.0.total_cmp(&b.0)) else { return false };
            if reach + x[n] <= 1e-9 * scale {
                return false;
            }
            let total = cables.iter().zip(&worst.columns).fold(worst.load, |sum, (cable, column)| {
                let [least, greatest] = cable.tensions;
                sum + column * if y.dot(column) > 0.0 { greatest.min(1e6 * scale) } else { least }
            });
            cut.row[..n].copy_from_slice(&total.as_slice()[..n]);
            cut.row[n] = 1.0;
            cut.limit = 0.0;
            true
        };
        let found = largest_last(&bounds, 0.0, next)?;
        let direction = Vec6::from_fn(|i, _| if i < n { found[i].clamp(-1.0, 1.0) } else { 0.0 });
        let short = -self.reach(&direction, &cables, &corners);
        (short > 0.0).then(|| Missing { direction, by: short / direction.norm() })
    }

    /// Upper bound of the component along a direction of the load with the pulls of the cables, over the box.
    fn reach(&self, y: &Vec6, cables: &[PulledCable], corners: &[Corner]) -> f64 {
        let mut most_at_corner = f64::NEG_INFINITY;
        for corner in corners {
            most_at_corner = most_at_corner.max(y.dot(&corner.load) + most(cables, &corner.columns, y));
        }
        let (mut rest, mut size) = (0.0, corners.iter().map(|corner| corner.load.norm()).fold(0.0, f64::max));
        let expanded = self.statement.coordinates.expand(y);
        let [force, moment] = [0, 3].map(|at| Vec3::new(expanded[at], expanded[at + 1], expanded[at + 2]));
        for (i, (cable, frame)) in cables.iter().zip(&self.cables).enumerate() {
            let arm = self.statement.cables[i].arm_w;
            let along = force + moment.cross(&(arm / self.statement.coordinates.ell()));
            let moves = frame.moves[0];
            let (span, rounding) = (frame.shortest, 4.0 * frame.rounding);
            let curve = along.norm() * (moves * moves / (3.0_f64.sqrt() * span * span) + rounding / span);
            let pulls = corners.iter().any(|corner| y.dot(&corner.columns[i]) + curve > 0.0);
            let tension = cable.tensions[usize::from(pulls)];
            rest += tension * curve;
            // The length is convex: with y·lift > 0 the weight along y is concave.
            let lift = y.dot(&frame.lift);
            rest += cable.hangs * (lift.max(0.0) * 0.5 * moves * moves / span + lift.abs() * rounding);
            rest += cable.deviation * lift.abs();
            size += tension * along.norm() + cable.hangs * frame.length * lift.abs();
        }
        most_at_corner + rest + ROUNDING * size * y.norm().max(1.0)
    }

    /// Chord tensions that the limits allow; `None` for a cable so slack that its sag has no bound.
    fn pulled(&self) -> Option<Vec<PulledCable>> {
        let cables = self.statement.cables.iter().zip(&self.cables);
        let pulled = cables.map(|(of, frame)| {
            let (least, greatest) = (of.least.at(frame.shortest), of.greatest);
            let (Some(sag), Some(over)) = (of.sag, &frame.sag) else {
                return Some(PulledCable { tensions: [least, greatest], deviation: 0.0, hangs: 0.0 });
            };
            let tensions = sag.chord_tensions(&over.chords, [least, greatest])?;
            let deviation = sag.bound(&over.chords, [least, greatest])?.deviation;
            deviation.is_finite().then_some(PulledCable { tensions, deviation, hangs: 0.5 * sag.weight })
        });
        pulled.collect()
    }

    fn at_corner(&self, position: &Vec3, load: usize, cables: &[PulledCable]) -> Corner {
        let coordinates = &self.statement.coordinates;
        let mut corner = Corner { columns: Vec::with_capacity(cables.len()), load: self.statement.loads[load] };
        for ((of, frame), cable) in self.statement.cables.iter().zip(&self.cables).zip(cables) {
            let chord = of.anchor_w - position - of.arm_w;
            let length = chord.norm();
            corner.columns.push(coordinates.reduce_force(&(chord / length), &of.arm_w));
            corner.load -= frame.lift * (cable.hangs * length);
        }
        corner
    }
}

/// Greatest component along a direction that the cables can pull with.
fn most(cables: &[PulledCable], columns: &[Vec6], y: &Vec6) -> f64 {
    let pull = |(cable, column): (&PulledCable, &Vec6)| {
        let along = y.dot(column);
        along * if along > 0.0 { cable.tensions[1] } else { cable.tensions[0] }
    };
    cables.iter().zip(columns).map(pull).sum()
}

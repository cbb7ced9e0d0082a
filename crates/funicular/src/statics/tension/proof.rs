//! Proof that no tensions within the limits balance the platform: a wrench direction in which the cables cannot reach
//! balance.
//!
//! For any direction y, balance requires `y·e + Σ y·w_i(τ_i) = 0`, e being the load and w_i the wrench of a cable. Take
//! the load's contribution plus the maximum contribution of every cable within its limits. If this sum is negative, no
//! tensions within the limits balance the platform, however the cables sag: (39a). Each maximum is a search in one
//! variable, along the true curve of the cable.

use crate::math::Vec6;
use crate::math::active_set::Polyhedron;
use crate::platform::Coordinates;
use crate::robot::Robot;
use crate::statics::missing_wrench::MissingWrench;
use crate::statics::wrench_set::WrenchSet;

/// Maximum number of directions tried after the first.
const MAX_CUTS: usize = 60;

/// Violation of a cut that counts as rounding; the cuts are unit vectors.
const CUT_ROUNDING: f64 = 1e-9;

/// Change of a unit direction below which it counts as the direction before: then rounding decides, far below
/// [`CUT_ROUNDING`].
const SAME_DIRECTION: f64 = 1e-12;

/// Result of the directions tried.
pub(super) struct ProofResult {
    /// Direction that proves that no tensions within the limits balance the platform, of length 1, reduced; `None`
    /// without a proof.
    pub direction: Option<Vec6>,
    /// Tensions with the maximum contributions in the first direction [N].
    pub max_shares: Vec<f64>,
}

/// Load to be balanced by cables within their ranges; in the platform's coordinates, scaled.
pub(super) struct Infeasibility<'a> {
    pub set: WrenchSet<'a>,
    pub load: Vec6,
}

impl Infeasibility<'_> {
    /// Tries to prove that the load cannot be balanced, with the first direction and with those that follow from it.
    ///
    /// Every direction that proves nothing comes with a set of tensions within the limits on the wrong side of its
    /// plane. The next direction has all of these sets on the right side, with the largest minimum angle (cutting
    /// planes). There is no such direction if the load lies in the convex hull of the wrenches that these tensions
    /// balance; then no direction is a proof.
    pub(super) fn prove(&self, first: &Vec6) -> ProofResult {
        let n = self.set.motion.count();
        let mut seen: Vec<[f64; 6]> = Vec::new();
        let mut y = *first;
        let mut verdict = ProofResult { direction: None, max_shares: Vec::new() };

        for _ in 0..=MAX_CUTS {
            let (proved, max_shares) = self.set.separates(&y, &self.load);
            if seen.is_empty() {
                verdict.max_shares = max_shares.iter().map(|point| point.tau).collect();
            }
            if proved {
                verdict.direction = y.try_normalize(0.0);
                break;
            }

            // Cut of this direction.
            let wrench = max_shares.iter().fold(self.load, |sum, point| sum + point.wrench);
            let Some(unit) = wrench.try_normalize(0.0) else { break };
            seen.push(std::array::from_fn(|k| unit[k]));

            let mut sides = Polyhedron::new(n);
            for unit in &seen {
                sides.add(unit[..n].iter(), -1.0, None, 1.0);
            }
            let mut next = [0.0; 6];
            if sides.nearest(&mut next[..n], CUT_ROUNDING).is_none() {
                break;
            }
            let next = Vec6::from(next).normalize();
            // If the last direction repeats, rounding decides.
            if (next - y).amax() < SAME_DIRECTION {
                break;
            }
            y = next;
        }
        verdict
    }

    /// Wrench that is missing in a direction that proves it.
    pub(super) fn missing(&self, robot: &Robot, direction: &Vec6) -> MissingWrench {
        let coordinates = Coordinates::of(robot);
        let (reach, tensions) = self.set.reach(direction);
        let (mut minimum_of, mut maximum_of) = (Vec::new(), Vec::new());
        for ((cable, reach), tau) in robot.cables.iter().zip(self.set.reaches).zip(&tensions) {
            let [low, high] = reach.limits();
            let names = if tau - low < high - tau { &mut minimum_of } else { &mut maximum_of };
            names.push(cable.name.clone());
        }
        let expanded = self.set.motion.expanded(direction);
        MissingWrench {
            force_w: expanded.fixed_rows::<3>(0).into(),
            moment_w: expanded.fixed_rows::<3>(3).into(),
            size: -(direction.dot(&self.load) + reach),
            length: coordinates.ell(),
            minimum_of,
            maximum_of,
            holds_exits: false,
        }
    }
}

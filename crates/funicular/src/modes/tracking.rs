//! Tracking of modes while the robot changes: branches by the MAC of motions.
//!
//! Modes sorted by frequency exchange their order where curves cross. Where curves veer instead, they come near,
//! exchange their motions and separate. A list by frequency does not distinguish the two. Here each mode is paired with
//! the mode of the next step that has the most similar motion, for all modes together.

use super::mac::mac;
use pathfinding::kuhn_munkres::kuhn_munkres;
use pathfinding::matrix::Matrix;

/// Frequency and motion of a mode for tracking.
#[derive(Debug, Clone, PartialEq)]
pub struct Tracked {
    /// Natural frequency [Hz].
    pub frequency_hz: f64,
    /// Motion in coordinates weighted by the square roots of their masses: the square of its length is twice the
    /// kinetic energy over the square of the frequency [1/s]. Size (not zero) and sign are arbitrary. All modes have
    /// the same number of coordinates.
    pub motion: Vec<f64>,
}

/// Minimum MAC for which a mode continues the branch of a mode of the previous step. If two modes exchange their
/// motions, only one pairing can be above it.
pub const MIN_MAC: f64 = 0.5;

/// Relative distance of frequencies below which the motions of modes may be arbitrary mixtures, as for a symmetric
/// robot.
const TOGETHER: f64 = 1e-6;

/// Modal assurance criterion of two motions in coordinates weighted by mass.
pub(crate) fn mac_of_motions(a: &[f64], b: &[f64]) -> f64 {
    mac(a, b, |a, b| a.iter().zip(b).map(|(x, y)| x * y).sum())
}

/// Branch of every mode of every step: a number from 0, in the order of first appearance.
///
/// Each step is compared with the last step that has modes. The pairs are those with the maximum sum of MACs (Hungarian
/// method). If the MAC of a pair is below [`MIN_MAC`], one branch ends and another begins. Branches depend on the step
/// width. If steps are wider than the range in which two curves veer, branches cross, as the motions do. If steps are
/// finer, branches follow the separating curves.
///
/// # Example
/// ```
/// # use funicular::modes::tracking::{Tracked, track};
/// let mode = |frequency_hz, motion: [f64; 2]| Tracked { frequency_hz, motion: motion.to_vec() };
/// let before = vec![mode(1.0, [1.0, 0.1]), mode(1.2, [-0.1, 1.0])];
/// let after = vec![mode(1.1, [0.1, -1.0]), mode(1.3, [1.0, 0.1])];
/// assert_eq!(track(&[before, after]), [[0, 1], [1, 0]]);
/// ```
pub fn track(steps: &[Vec<Tracked>]) -> Vec<Vec<usize>> {
    let mut known = 0;
    let mut last: Option<(&[Tracked], Vec<usize>)> = None;
    let mut found = Vec::with_capacity(steps.len());
    for step in steps {
        let mut of_step = vec![None; step.len()];

        // Branches that continue in this step.
        if let Some((before, branch)) = &last {
            let macs = all_macs(before, step);
            for (i, j) in best_pairs(&macs, step.len()) {
                if macs[i][j] >= MIN_MAC {
                    of_step[j] = Some(branch[i]);
                }
            }
        }

        // New branches.
        let of_step: Vec<usize> = of_step
            .into_iter()
            .map(|branch| {
                branch.unwrap_or_else(|| {
                    known += 1;
                    known - 1
                })
            })
            .collect();

        if !step.is_empty() {
            last = Some((step, of_step.clone()));
        }
        found.push(of_step);
    }
    found
}

/// MAC of every mode before with every mode after. Modes at one frequency span a space of motions, and the listed
/// motions are an arbitrary basis of it. For them the value is the fraction of a motion that lies in this space.
fn all_macs(before: &[Tracked], after: &[Tracked]) -> Vec<Vec<f64>> {
    let plain: Vec<Vec<f64>> =
        before.iter().map(|a| after.iter().map(|b| mac_of_motions(&a.motion, &b.motion)).collect()).collect();
    let (of_before, of_after) = (degenerate_groups(before), degenerate_groups(after));
    let in_space = |i: usize, j: usize| {
        let with_after: f64 = of_after[j].clone().map(|k| plain[i][k]).sum();
        let with_before: f64 = of_before[i].clone().map(|k| plain[k][j]).sum();
        with_after.max(with_before).min(1.0)
    };
    (0..before.len()).map(|i| (0..after.len()).map(|j| in_space(i, j).max(plain[i][j])).collect()).collect()
}

/// Index range of the modes at the frequency of each mode; modes are in ascending order.
fn degenerate_groups(modes: &[Tracked]) -> Vec<std::ops::Range<usize>> {
    let mut degenerate_groups = Vec::with_capacity(modes.len());
    let mut begin = 0;
    for end in 1..=modes.len() {
        let apart = |i: usize| modes[i].frequency_hz - modes[i - 1].frequency_hz > TOGETHER * modes[i].frequency_hz;
        if end == modes.len() || apart(end) {
            degenerate_groups.extend((begin..end).map(|_| begin..end));
            begin = end;
        }
    }
    degenerate_groups
}

/// Pairs (row, column) with the maximum sum of values from 0 to 1 (Hungarian method); their number is that of the
/// shorter side.
///
/// # Example
/// ```
/// use funicular::modes::tracking::best_pairs;
///
/// // The second row has only one good partner, which the first row also likes best.
/// assert_eq!(best_pairs(&[vec![0.9, 0.8], vec![0.7, 0.1]], 2), [(0, 1), (1, 0)]);
/// ```
pub fn best_pairs(values: &[Vec<f64>], columns: usize) -> Vec<(usize, usize)> {
    let rows = values.len();
    let (short, long) = (rows.min(columns), rows.max(columns));
    if short == 0 {
        return Vec::new();
    }
    let as_pair = |(short, long)| if rows <= columns { (short, long) } else { (long, short) };
    // The method needs integers, which have a total order; rounding to 1e-12 does not matter.
    let weights = Matrix::from_fn(short, long, |place| {
        let (row, column) = as_pair(place);
        (1e12 * values[row][column]).round() as i64
    });
    let (_, partners) = kuhn_munkres(&weights);
    partners.into_iter().enumerate().map(as_pair).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two oscillators of unit mass with stiffnesses 10 ± p and a coupling c. The squares of the frequencies are 10 ±
    /// √(p² + c²). The motion of the upper mode is (cos φ, sin φ) with tan 2φ = c/p, that of the lower is orthogonal.
    fn veering(p: f64, c: f64) -> Vec<Tracked> {
        let (root, phi) = (p.hypot(c), 0.5 * c.atan2(p));
        let hz = |square: f64| square.sqrt() / std::f64::consts::TAU;
        vec![
            Tracked { frequency_hz: hz(10.0 - root), motion: vec![-phi.sin(), phi.cos()] },
            Tracked { frequency_hz: hz(10.0 + root), motion: vec![phi.cos(), phi.sin()] },
        ]
    }

    fn last(steps: &[Vec<Tracked>]) -> Vec<usize> {
        track(steps).pop().unwrap()
    }

    #[test]
    fn branches_cross_where_a_step_is_wider_than_the_veering_and_veer_where_it_is_finer() {
        // From −p to p the motions turn by φ(−p) − φ(p) = π/2 − atan(c/p), by more than 45° if p > c.
        for (ratio, expected) in [(1.01, [1, 0]), (0.99, [0, 1]), (30.0, [1, 0]), (0.05, [0, 1])] {
            let c = 0.1;
            assert_eq!(last(&[veering(-ratio * c, c), veering(ratio * c, c)]), expected, "{ratio}");
        }
        // Through the whole range in fine steps.
        let fine: Vec<_> = (-200..=200).map(|k| veering(0.01 * f64::from(k), 0.1)).collect();
        assert_eq!(last(&fine), [0, 1]);
        let coarse: Vec<_> = (-3..=4).map(|k| veering(f64::from(k) - 0.5, 0.1)).collect();
        assert_eq!(last(&coarse), [1, 0]);
    }

    #[test]
    fn uncoupled_modes_cross_and_neither_size_nor_sign_of_motions_counts() {
        let mut steps: Vec<_> = (-5..=6).map(|k| veering(f64::from(k) - 0.5, 1e-9)).collect();
        for (k, mode) in steps.iter_mut().flatten().enumerate() {
            mode.motion.iter_mut().for_each(|x| *x *= (1.0 + k as f64) * if k % 3 == 0 { -1.0 } else { 1.0 });
        }
        assert_eq!(last(&steps), [1, 0]);
    }

    #[test]
    fn modes_at_one_frequency_go_on_however_they_are_mixed() {
        let mode = |frequency_hz, motion: [f64; 3]| Tracked { frequency_hz, motion: motion.to_vec() };
        let turned = |angle: f64| {
            let (s, c) = angle.sin_cos();
            vec![mode(1.0, [c, s, 0.0]), mode(1.0, [-s, c, 0.0]), mode(2.0, [0.0, 0.0, 1.0])]
        };
        let steps: Vec<_> = [0.0, 0.785, 1.3, 2.2].map(turned).to_vec();
        assert!(track(&steps).iter().flatten().all(|branch| *branch < 3), "{:?}", track(&steps));
    }

    #[test]
    fn branches_begin_end_and_bridge_steps_without_modes() {
        let mode = |frequency_hz, k: usize| Tracked {
            frequency_hz,
            motion: (0..4).map(|i| f64::from(u8::from(i == k))).collect(),
        };
        let steps = [vec![mode(1.0, 0), mode(2.0, 1)], vec![], vec![mode(1.5, 1), mode(1.7, 2)], vec![mode(1.0, 2)]];
        assert_eq!(track(&steps), [vec![0, 1], vec![], vec![1, 2], vec![2]]);
        assert_eq!(track(&[]), Vec::<Vec<usize>>::new());
        // A motion of zero has a MAC of zero.
        assert!(mac_of_motions(&[0.0, 0.0], &[1.0, 0.0]) <= 0.0);
    }

    #[test]
    fn the_pairs_have_the_greatest_sum_of_all() {
        /// Maximum sum by trying every pairing of a row with a remaining column.
        fn maximum(values: &[Vec<f64>], taken: &mut Vec<usize>) -> f64 {
            let Some(row) = values.get(taken.len()) else { return 0.0 };
            let mut best = f64::NEG_INFINITY;
            for (j, value) in row.iter().enumerate() {
                if !taken.contains(&j) {
                    taken.push(j);
                    best = best.max(value + maximum(values, taken));
                    taken.pop();
                }
            }
            best
        }

        // A fixed sequence without pattern: fractions of multiples of the golden ratio.
        let number = |k: usize| (k as f64 * 0.618_033_988_749_894_9).fract();

        for (rows, columns) in [(1, 1), (3, 3), (4, 6), (6, 6)] {
            for seed in 0..20 {
                let values: Vec<Vec<f64>> = (0..rows)
                    .map(|i| (0..columns).map(|j| number(seed * 97 + i * 31 + j * j * 7 + 1)).collect())
                    .collect();
                let pairs = best_pairs(&values, columns);
                assert_eq!(pairs.len(), rows);
                let sum: f64 = pairs.iter().map(|&(i, j)| values[i][j]).sum();
                assert!((sum - maximum(&values, &mut Vec::new())).abs() < 1e-11, "{rows}×{columns}, {seed}");
            }
        }
    }
}

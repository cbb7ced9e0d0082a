//! Ways on which nothing touches: whether a straight move is one, and a way through other poses where it is not.

use super::moves::{MIN_STEP, OF_SAG, Station, least_between};
use super::{BODY_TOLERANCE, Clearance, Surroundings};
use crate::path::StraightMove;
use crate::robot::Pose;
use crate::statics::Equilibrium;
use std::rc::Rc;

/// Search for a way between two poses.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeWay {
    /// Poses between the first and the last one; `None` if no way was found, which does not mean that there is none.
    pub through: Option<Vec<Pose>>,
    /// Number of straight moves that were examined.
    pub moves: usize,
}

impl Surroundings<'_> {
    /// True if every pair keeps its required distance everywhere on a move; then no cables cross either. A move that
    /// comes nearer to a limit than the finest step can tell counts as not free, and so does one with a pose that the
    /// cables do not hold. `rest_at` gives the equilibrium at a pose.
    ///
    /// # References
    /// docs/theory.md, equation (40u).
    pub fn is_free_way<E>(
        &self,
        straight: &StraightMove,
        rest_at: &mut dyn FnMut(&Pose) -> Result<Equilibrium, E>,
    ) -> bool {
        let mut station = |fraction: f64, of: Option<&[usize]>, enough: Option<&[f64]>| {
            let rest = rest_at(&straight.pose(fraction)).ok()?;
            let all: Vec<usize>;
            let of = if let Some(of) = of {
                of
            } else {
                all = (0..self.at(&rest).pairs().len()).collect();
                &all
            };
            let exact = vec![f64::INFINITY; self.at(&rest).pairs().len()];
            let enough = enough.unwrap_or(&exact);
            let station = self.station(fraction, &rest, of, enough, BODY_TOLERANCE);
            let is_free = station.clearances.iter().flatten().all(Clearance::is_kept);
            is_free.then_some((station, rest))
        };
        let Some((end, _)) = station(1.0, None, None) else { return false };
        let Some((start, rest)) = station(0.0, None, None) else { return false };
        let ways = self.ways_of(&self.at(&rest).pairs(), straight);

        // Parts of the way, the nearest one last. Each is divided for those pairs alone that may be too near in it.
        let mut ahead: Vec<[Rc<Station>; 2]> = vec![[Rc::new(start), Rc::new(end)]];
        while let Some([from, to]) = ahead.pop() {
            let open: Vec<usize> =
                least_between(&from, &to, &ways).filter(|(_, least)| *least < 0.0).map(|(k, _)| k).collect();
            if open.is_empty() {
                continue;
            }
            if to.fraction - from.fraction <= MIN_STEP {
                return false;
            }
            // A pair that keeps more than its way settles both halves.
            let step = to.fraction - from.fraction;
            let enough: Vec<f64> = ways.iter().map(|way| way * step + OF_SAG).collect();
            let at = 0.5 * (from.fraction + to.fraction);
            let Some((middle, _)) = station(at, Some(&open), Some(&enough)) else { return false };
            let middle = Rc::new(middle);
            ahead.extend([[middle.clone(), to], [from, middle]]);
        }
        true
    }

    /// Way from one pose to another along straight moves on which every pair keeps its distance: directly, through one
    /// of the given poses, or through two of them, shorter ways first. At most `most` moves are examined.
    pub fn free_way<E>(
        &self,
        [from, to]: [&Pose; 2],
        candidates: &[Pose],
        most: usize,
        rest_at: &mut dyn FnMut(&Pose) -> Result<Equilibrium, E>,
    ) -> FreeWay {
        let mut moves = 0;
        let mut is_free = |a: &Pose, b: &Pose| {
            moves += 1;
            (moves <= most).then(|| self.is_free_way(&StraightMove::between(a, b), rest_at))
        };
        let through = way_through([from, to], candidates, &mut is_free);
        FreeWay { through, moves: moves.min(most) }
    }
}

/// Poses between the ends of the first way that is free; `is_free` is `None` when the search shall end.
fn way_through(
    [from, to]: [&Pose; 2],
    candidates: &[Pose],
    is_free: &mut dyn FnMut(&Pose, &Pose) -> Option<bool>,
) -> Option<Vec<Pose>> {
    if is_free(from, to)? {
        return Some(Vec::new());
    }

    let length = |a: &Pose, b: &Pose| (a.position_w - b.position_w).norm();
    let mut sorted: Vec<&Pose> = candidates.iter().collect();
    sorted.sort_by(|a, b| (length(from, a) + length(a, to)).total_cmp(&(length(from, b) + length(b, to))));
    let (mut behind_first, mut before_last) = (Vec::new(), Vec::new());
    for pose in sorted {
        let (first, last) = (is_free(from, pose)?, is_free(pose, to)?);
        if first && last {
            return Some(vec![*pose]);
        }
        if first {
            behind_first.push(pose);
        }
        if last {
            before_last.push(pose);
        }
    }

    let of_two = |[a, b]: [&Pose; 2]| length(from, a) + length(a, b) + length(b, to);
    let mut pairs: Vec<[&Pose; 2]> =
        behind_first.iter().flat_map(|a| before_last.iter().map(move |b| [*a, *b])).collect();
    pairs.sort_by(|a, b| of_two(*a).total_cmp(&of_two(*b)));
    for [a, b] in pairs {
        if is_free(a, b)? {
            return Some(vec![*a, *b]);
        }
    }
    None
}

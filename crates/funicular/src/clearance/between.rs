//! Pairs that come too near between known poses of a motion, whatever its course.

use super::bounded::Bounded;
use super::moves::OF_SAG;
use super::{Clearance, ClearancePair, Surroundings, TOUCHING};
use crate::statics::Equilibrium;
use std::collections::BinaryHeap;

/// Maximum number of places between the known ones that are looked at: a pair that slides along its limit would need
/// any number. A body that is passed needs some sixty.
const MAX_PLACES: usize = 4000;

/// Result of [`Surroundings::too_near_between`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BetweenPlaces {
    /// Every pair keeps its required distance.
    Free,
    /// Pair that does not, at a place.
    TooNear {
        /// Place.
        place: f64,
        /// Pair.
        clearance: Clearance,
    },
    /// So many places come so near to a limit that they do not tell, one of them this.
    Undecided {
        /// Place.
        place: f64,
    },
}

/// Motion of the platform between two places of its course.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WayBetween {
    /// Bound of the way of the origin [m].
    pub translation: f64,
    /// Bound of the turn [rad].
    pub turn: f64,
}

/// Pairs at one place.
struct PlaceOnCourse {
    at: f64,
    /// Lower bounds of the margins of all pairs [m]; infinite for a pair without a distance, and for one that was not
    /// asked.
    margins: Vec<f64>,
    /// Pair with the least margin.
    least: Option<Clearance>,
    /// Largest distance of each cable from its chord [m].
    sagittas: Vec<f64>,
}

/// Part of a course between two places, with the pairs that may be too near in it.
struct CoursePart {
    ends: [usize; 2],
    open: Vec<usize>,
}

impl Surroundings<'_> {
    /// First pair found that does not keep its required distance somewhere on a course, of which the equilibria at some
    /// ascending places are known. `way` bounds the motion of the platform between two places, and `rest_at` gives the
    /// equilibrium at a place between them.
    ///
    /// # Errors
    /// Error of a place without an equilibrium.
    ///
    /// # References
    /// docs/theory.md, equation (40u).
    pub fn too_near_between<E>(
        &self,
        known: &[(f64, &Equilibrium)],
        way: impl Fn([f64; 2]) -> WayBetween,
        mut rest_at: impl FnMut(f64) -> Result<Equilibrium, E>,
    ) -> Result<BetweenPlaces, E> {
        let Some((_, first)) = known.first() else { return Ok(BetweenPlaces::Free) };
        let pairs = self.at(first).pairs();
        let all: Vec<usize> = (0..pairs.len()).collect();
        let chords = self.chords_of(known);
        let ways = |ends: [f64; 2]| -> Vec<f64> {
            let way = way(ends);
            pairs.iter().map(|pair| self.way_between(*pair, &way, &chords)).collect()
        };

        // The known places. Where a pair keeps more than its way to both neighbours, it needs no exact distance.
        let mut places: Vec<PlaceOnCourse> = Vec::with_capacity(known.len());
        for (k, (at, rest)) in known.iter().enumerate() {
            let neighbours = [k.saturating_sub(1), (k + 1).min(known.len() - 1)].map(|k| known[k].0);
            let place = self.place(*at, rest, &all, &ways(neighbours));
            if let Some(clearance) = place.too_near() {
                return Ok(BetweenPlaces::TooNear { place: *at, clearance });
            }
            places.push(place);
        }
        let mut queue = BinaryHeap::new();
        for k in 1..places.len() {
            queue.extend(open_part(&places, [k - 1, k], &pairs, &ways([places[k - 1].at, places[k].at])));
        }

        // Parts in which a pair may be too near, the least bound first.
        while let Some(Bounded { of: CoursePart { ends, open }, .. }) = queue.pop() {
            let [from, to] = ends.map(|k| &places[k]);
            let at = 0.5 * (from.at + to.at);
            let whole = ways([from.at, to.at]);
            if open.iter().all(|k| whole[*k] <= TOUCHING) || at <= from.at || at >= to.at {
                // Both sides are nearer to a limit than distances are exact.
                let nearer = [from, to].into_iter().filter_map(|place| Some((place.at, place.least?)));
                let nearer = nearer.min_by(|a, b| a.1.margin().total_cmp(&b.1.margin()));
                let Some((place, clearance)) = nearer else { continue };
                return Ok(BetweenPlaces::TooNear { place, clearance });
            }
            if places.len() >= known.len() + MAX_PLACES {
                return Ok(BetweenPlaces::Undecided { place: at });
            }
            let place = self.place(at, &rest_at(at)?, &open, &whole);
            if let Some(clearance) = place.too_near() {
                return Ok(BetweenPlaces::TooNear { place: at, clearance });
            }
            let halves = [ways([from.at, at]), ways([at, to.at])];
            let middle = places.len();
            places.push(place);
            for (ends, ways) in [[ends[0], middle], [middle, ends[1]]].into_iter().zip(halves) {
                queue.extend(open_part(&places, ends, &pairs, &ways));
            }
        }
        Ok(BetweenPlaces::Free)
    }

    /// Shortest and longest chord of each cable at some places [m].
    fn chords_of(&self, known: &[(f64, &Equilibrium)]) -> Vec<[f64; 2]> {
        let of = |i: usize| {
            let chords = known.iter().map(|(_, rest)| rest.cables[i].chord());
            chords.fold([f64::INFINITY, 0.0], |[least, most], chord| [least.min(chord), most.max(chord)])
        };
        (0..self.robot.cables.len()).map(of).collect()
    }

    /// Bound of the change of a pair's distance during a motion [m]. Seen from the platform, a point of a cable moves
    /// by its share of the way of the anchor, and points farther along than the platform reaches are not too near.
    fn way_between(&self, pair: ClearancePair, way: &WayBetween, chords: &[[f64; 2]]) -> f64 {
        let WayBetween { translation, turn } = *way;
        let whole = self.way_of(pair, translation, turn);
        let ClearancePair::CableAndPlatform { cable: i, .. } = pair else { return whole };
        let cable = &self.robot.cables[i];
        let lever = cable.attachment_p.norm();
        let [least, most] = [chords[i][0] - whole, chords[i][1] + whole];
        let near = self.platform_reach() + lever + self.required.platform + cable.radius();
        let share = if least > near { near / least } else { 1.0 };
        whole.min(share * (translation + turn * (most + lever)))
    }

    /// Some pairs at a place, by their numbers. A margin that is surely larger than its entry of `enough` is told as
    /// that.
    fn place(&self, place: f64, rest: &Equilibrium, of: &[usize], enough: &[f64]) -> PlaceOnCourse {
        let at = self.at(rest);
        let pairs = at.pairs();
        let mut margins = vec![f64::INFINITY; pairs.len()];
        let mut least: Option<Clearance> = None;
        for k in of {
            let enough = enough[*k] + OF_SAG;
            margins[*k] = enough;
            let Some(found) = at.clearance(pairs[*k], enough) else { continue };
            margins[*k] = found.margin();
            if least.is_none_or(|least| found.margin() < least.margin()) {
                least = Some(found);
            }
        }
        let sagittas = at.sagittas();
        PlaceOnCourse { at: place, margins, least, sagittas }
    }
}

impl PlaceOnCourse {
    fn too_near(&self) -> Option<Clearance> {
        self.least.filter(|least| !least.is_kept())
    }
}

/// Part between two places, if a pair may be too near in it; `ways` bounds the change of every pair's distance.
fn open_part(
    places: &[PlaceOnCourse],
    ends: [usize; 2],
    pairs: &[ClearancePair],
    ways: &[f64],
) -> Option<Bounded<CoursePart>> {
    let [from, to] = ends.map(|k| &places[k]);
    let sag = |i: usize| (from.sagittas[i] - to.sagittas[i]).abs();
    let bound = |k: usize| 0.5 * (from.margins[k] + to.margins[k] - ways[k]) - pairs[k].of_cables(sag);
    let open: Vec<usize> = (0..pairs.len()).filter(|k| bound(*k) < 0.0).collect();
    let lower = open.iter().map(|k| bound(*k)).reduce(f64::min)?;
    Some(Bounded { lower, of: CoursePart { ends, open } })
}

//! Straight moves between two poses: what comes too near on the way, and which cables cross each other.

use super::{Clearance, ClearancePair, Placed, Surroundings};
use crate::math::Vec3;
use crate::path::StraightMove;
use crate::robot::{Body, Pose, Robot};
use crate::statics::Equilibrium;
use std::rc::Rc;

/// Bound of the least distance on the way [m]: nowhere on the way a pair is nearer by more than this, for straight
/// cables surely, and with sag as far as it changes evenly between two stations.
pub const WAY_TOLERANCE: f64 = 2e-3;

/// Error of the distances from bodies at places on the way [m], a part of [`WAY_TOLERANCE`]: a third of the steps of
/// exact ones. What is told is exact.
const OF_PLACES: f64 = 1e-4;

/// Margin that a pair keeps beyond its way, so that a change of its sag leaves it settled [m].
pub(super) const OF_SAG: f64 = 0.02;

/// Least part of a move between two stations, a guard.
pub(super) const MIN_STEP: f64 = 1.0 / 16384.0;

/// Triple product over the lengths that it is made of at which two lines lie in one plane: rounding.
const COPLANAR: f64 = 1e-13;

/// Number of parts of a move at whose ends lines are tested for a common plane: a product that is not zero everywhere
/// has few zeros.
const COPLANAR_TRIALS: usize = 8;

/// Distance of two zeros that are one, at the common end of two intervals.
const SAME_ZERO: f64 = 1e-12;

/// Number of halvings that find a crossing: 1e-15 of the move.
const HALVINGS: usize = 50;

/// Distance of the centre lines at which two cables count as crossing [m]: what remains after the halvings.
const CROSSED: f64 = 1e-6;

/// Crossing of two straight cables on a move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// Indices of the cables.
    pub cables: [usize; 2],
    /// Fraction of the move.
    pub fraction: f64,
    /// Place of the crossing on each cable, from its anchor (0) to the platform (1).
    pub along: [f64; 2],
    /// Place in the world [m].
    pub point_w: Vec3,
}

/// Pair on the way.
#[derive(Debug, Clone, PartialEq)]
pub struct OnTheWay {
    /// Least margin on the way.
    pub least: Clearance,
    /// Fraction of the move where it is least.
    pub fraction: f64,
    /// Fractions at which the centre lines of two cables cross.
    pub crossings: Vec<f64>,
}

/// All crossings of straight cables with fixed anchors on a move, in the order of the move.
///
/// # Example
/// ```
/// use funicular::clearance::straight_crossings;
/// use funicular::path::StraightMove;
/// use funicular::robot::{Pose, Robot};
///
/// let robot = Robot::from_toml(funicular_robots::COGIRO)?;
/// let straight = StraightMove::between(&Pose::new([0.0, 0.0, 1.5], [0.0; 3]), &Pose::new([2.0, 1.0, 1.5], [0.0; 3]));
/// assert!(straight_crossings(&robot, &straight).is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # References
/// docs/theory.md, equations (40s) and (40t).
pub fn straight_crossings(robot: &Robot, straight: &StraightMove) -> Vec<Crossing> {
    let fixed: Vec<usize> = (0..robot.cables.len()).filter(|i| robot.cables[*i].anchor.is_fixed()).collect();
    let mut found = Vec::new();
    for (k, i) in fixed.iter().enumerate() {
        for j in &fixed[k + 1..] {
            let pair = StraightPair { robot, straight, cables: [*i, *j] };
            found.extend(pair.zeros().into_iter().filter_map(|fraction| pair.crossing(fraction)));
        }
    }
    found.sort_by(|a, b| a.fraction.total_cmp(&b.fraction));
    found
}

/// Two straight cables on a move.
struct StraightPair<'a> {
    robot: &'a Robot,
    straight: &'a StraightMove,
    cables: [usize; 2],
}

impl StraightPair<'_> {
    /// Anchors, and vectors from the anchors to the attachments.
    fn lines(&self, fraction: f64) -> ([Vec3; 2], [Vec3; 2]) {
        let pose = self.straight.pose(fraction);
        let anchors = self.cables.map(|i| self.robot.cables[i].anchor.point_w);
        let ends = self.cables.map(|i| pose.point_w(&self.robot.cables[i].attachment_p));
        (anchors, [ends[0] - anchors[0], ends[1] - anchors[1]])
    }

    /// Triple product (40s), zero where the lines of the cables meet.
    fn product(&self, fraction: f64) -> f64 {
        let (anchors, along) = self.lines(fraction);
        (anchors[1] - anchors[0]).dot(&along[0].cross(&along[1]))
    }

    /// Zeros of the triple product in the move, ascending.
    fn zeros(&self) -> Vec<f64> {
        if self.straight.turn_w.norm() == 0.0 {
            // Linear in the fraction.
            let (first, last) = (self.product(0.0), self.product(1.0));
            let zero = first / (first - last);
            // Not a number if the lines of the cables stay in one plane.
            return if (0.0..=1.0).contains(&zero) { vec![zero] } else { Vec::new() };
        }

        // Bounds of the first and second derivative isolate all zeros.
        let (anchors, start) = self.lines(0.0);
        let levers = self.cables.map(|i| self.robot.cables[i].attachment_p.norm());
        let ways = levers.map(|lever| self.straight.way(lever));
        let bends = levers.map(|lever| self.straight.turn_w.norm_squared() * lever);
        let lengths = [start[0].norm() + ways[0], start[1].norm() + ways[1]];
        let between = (anchors[1] - anchors[0]).norm();
        let slope = between * (ways[0] * lengths[1] + lengths[0] * ways[1]);
        let bend = between * (bends[0] * lengths[1] + 2.0 * ways[0] * ways[1] + lengths[0] * bends[1]);
        // The lines stay in one plane, as those of a planar robot: no crossing is one of the others.
        let scale = between * lengths[0] * lengths[1];
        if (0..=COPLANAR_TRIALS).all(|k| self.product(k as f64 / COPLANAR_TRIALS as f64).abs() <= COPLANAR * scale) {
            return Vec::new();
        }
        let mut zeros = Vec::new();
        self.isolate([0.0, 1.0], [slope, bend], &mut zeros);
        zeros.sort_by(f64::total_cmp);
        zeros.dedup_by(|a, b| (*a - *b).abs() < SAME_ZERO);
        zeros
    }

    /// Adds the zeros in an interval, for bounds of the first and second derivative over the fraction.
    fn isolate(&self, [low, high]: [f64; 2], bounds: [f64; 2], zeros: &mut Vec<f64>) {
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let [first, last] = [self.product(low), self.product(high)];
        if self.product(middle).abs() > bounds[0] * half {
            return;
        }
        // The secant has the slope of some point inside, from which the slope changes by less than this.
        let is_monotone = ((last - first) / (high - low)).abs() > 2.0 * bounds[1] * half;
        if is_monotone || half < MIN_STEP {
            if first * last <= 0.0 {
                zeros.push(bisected([low, high], first, |fraction| Some(self.product(fraction))));
            }
            return;
        }
        self.isolate([low, middle], bounds, zeros);
        self.isolate([middle, high], bounds, zeros);
    }

    /// Crossing at a zero of the triple product, if the lines meet between the ends of both cables.
    fn crossing(&self, fraction: f64) -> Option<Crossing> {
        let (anchors, along) = self.lines(fraction);
        let normal = along[0].cross(&along[1]);
        let square = normal.norm_squared();
        let between = anchors[1] - anchors[0];
        let places = [between.cross(&along[1]).dot(&normal) / square, between.cross(&along[0]).dot(&normal) / square];
        let inside = places.iter().all(|place| (0.0..1.0).contains(place));
        inside.then(|| Crossing {
            cables: self.cables,
            fraction,
            along: places,
            point_w: anchors[0] + along[0] * places[0],
        })
    }
}

/// Zero of a function between two places at which its signs differ, by halving; `first` is its value at the first
/// place. Ends where the function has no value.
fn bisected([mut low, mut high]: [f64; 2], first: f64, mut value: impl FnMut(f64) -> Option<f64>) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        match value(middle) {
            Some(0.0) => return middle,
            Some(found) if (found < 0.0) == (first < 0.0) => low = middle,
            Some(_) => high = middle,
            None => break,
        }
    }
    0.5 * (low + high)
}

/// Distances of all pairs at one place of a move.
pub(super) struct Station {
    pub(super) fraction: f64,
    /// Distances of the pairs, in their order; `None` without one, for a pair that is not compared there, and for one
    /// whose margin is larger than was asked.
    pub(super) clearances: Vec<Option<Clearance>>,
    /// Lower bounds of the margins of the pairs [m]; `None` for a pair that is not compared there.
    margins: Vec<Option<f64>>,
    pairs: Vec<ClearancePair>,
    /// Signs of the pairs of cables: the side on which the first passes the second.
    sides: Vec<f64>,
    /// Largest distance of each cable from its chord [m].
    sagittas: Vec<f64>,
}

impl Surroundings<'_> {
    /// Every pair on a move, with its least margin, where it is, and where cables cross. `rest_at` gives the
    /// equilibrium at a pose.
    ///
    /// # Errors
    /// Fraction of the move and error of the first pose without an equilibrium.
    ///
    /// # References
    /// docs/theory.md, equation (40u).
    pub fn on_the_way<E>(
        &self,
        straight: &StraightMove,
        mut rest_at: impl FnMut(&Pose) -> Result<Equilibrium, E>,
    ) -> Result<Vec<OnTheWay>, (f64, E)> {
        let mut rest = |fraction: f64| rest_at(&straight.pose(fraction)).map_err(|error| (fraction, error));
        let start = rest(0.0)?;
        let pairs = self.at(&start).pairs();
        let all: Vec<usize> = (0..pairs.len()).collect();
        let any = vec![f64::INFINITY; pairs.len()];
        let ends =
            [self.station(0.0, &start, &all, &any, OF_PLACES), self.station(1.0, &rest(1.0)?, &all, &any, OF_PLACES)];
        let ways = self.ways_of(&pairs, straight);

        let mut found: Vec<Option<OnTheWay>> = vec![None; pairs.len()];
        for station in &ends {
            keep_least(&mut found, station);
        }
        let mut sided: Vec<(usize, [Rc<Station>; 2])> = Vec::new();

        // Parts of the way, the nearest one last. Each is divided for those pairs alone that may be nearer in it than
        // known.
        let mut ahead = vec![(ends.map(Rc::new), all)];
        while let Some(([one, other], open)) = ahead.pop() {
            let is_long = other.fraction - one.fraction > MIN_STEP;
            let nearer = if is_long { may_be_nearer(&found, [&one, &other], &ways, &open) } else { Vec::new() };
            let settled = open.into_iter().filter(|k| nearer.binary_search(k).is_err());
            sided.extend(
                settled.filter(|k| one.sides[*k] * other.sides[*k] < 0.0).map(|k| (k, [one.clone(), other.clone()])),
            );
            if nearer.is_empty() {
                continue;
            }
            let fraction = 0.5 * (one.fraction + other.fraction);
            // A pair that keeps more than its way beyond the least known margin settles both halves.
            let enough: Vec<f64> = found
                .iter()
                .zip(&ways)
                .map(|(found, way)| {
                    let known = found.as_ref().map_or(f64::INFINITY, |found| found.least.margin());
                    known + way * (other.fraction - one.fraction) + OF_SAG
                })
                .collect();
            let middle = Rc::new(self.station(fraction, &rest(fraction)?, &nearer, &enough, OF_PLACES));
            keep_least(&mut found, &middle);
            ahead.push(([middle.clone(), other], nearer.clone()));
            ahead.push(([one, middle], nearer));
        }

        self.tell_exactly(&mut found, &mut rest)?;
        self.add_crossings(&mut found, sided, &mut rest)?;
        Ok(found.into_iter().flatten().collect())
    }

    /// Gives pairs on the way the exact distances at their places, those of one place together.
    fn tell_exactly<E>(
        &self,
        found: &mut [Option<OnTheWay>],
        rest: &mut impl FnMut(f64) -> Result<Equilibrium, (f64, E)>,
    ) -> Result<(), (f64, E)> {
        let mut places: Vec<f64> = found.iter().flatten().map(|found| found.fraction).collect();
        places.sort_by(f64::total_cmp);
        places.dedup();
        for place in places {
            let rest = rest(place)?;
            let at = self.at(&rest);
            for found in found.iter_mut().flatten().filter(|found| found.fraction.total_cmp(&place).is_eq()) {
                found.least = at.clearance(found.least.pair, f64::INFINITY).unwrap_or(found.least);
            }
        }
        Ok(())
    }

    /// Adds the crossings of cables that change sides between two stations: they cross unless one passes an end of the
    /// other.
    fn add_crossings<E>(
        &self,
        found: &mut [Option<OnTheWay>],
        sided: Vec<(usize, [Rc<Station>; 2])>,
        rest: &mut impl FnMut(f64) -> Result<Equilibrium, (f64, E)>,
    ) -> Result<(), (f64, E)> {
        for (k, neighbours) in sided {
            let Some(found) = &mut found[k] else { continue };
            let pair = found.least.pair;
            let between = [neighbours[0].fraction, neighbours[1].fraction];
            let mut pair_at = |fraction: f64| {
                let rest = rest(fraction)?;
                let at = self.at(&rest);
                Ok(at.clearance(pair, f64::INFINITY).map(|found| (at.side(&found), found)))
            };
            let side = |fraction: f64| Some(pair_at(fraction).ok()??.0);
            let crossing = bisected(between, neighbours[0].sides[k], side);
            let Some((_, clearance)) = pair_at(crossing)? else { continue };
            if clearance.points_w[0].metric_distance(&clearance.points_w[1]) < CROSSED {
                found.crossings.push(crossing);
                if clearance.margin() < found.least.margin() {
                    (found.least, found.fraction) = (clearance, crossing);
                }
            }
        }
        Ok(())
    }

    /// Distances of some pairs, by their numbers, at a place of a move. A margin that is surely larger than its finite
    /// entry of `enough` is told as that. Distances from bodies are too large by the tolerance at most.
    pub(super) fn station(
        &self,
        fraction: f64,
        rest: &Equilibrium,
        of: &[usize],
        enough: &[f64],
        tolerance: f64,
    ) -> Station {
        let at = Placed { tolerance, ..self.at(rest) };
        let pairs = at.pairs();
        let mut clearances: Vec<Option<Clearance>> = vec![None; pairs.len()];
        let mut margins: Vec<Option<f64>> = vec![None; pairs.len()];
        for k in of {
            clearances[*k] = at.clearance(pairs[*k], enough[*k]);
            let beyond = Some(enough[*k]).filter(|enough| enough.is_finite());
            margins[*k] = clearances[*k].map(|found| found.margin() - tolerance).or(beyond);
        }
        let sides = clearances.iter().map(|found| found.map_or(0.0, |found| at.side(&found))).collect();
        let sagittas = at.sagittas();
        Station { fraction, clearances, margins, pairs, sides, sagittas }
    }

    /// Bounds of the changes of all distances over the fraction of a move, as [`Self::way_of`].
    pub(super) fn ways_of(&self, pairs: &[ClearancePair], straight: &StraightMove) -> Vec<f64> {
        let (translation, turn) = (straight.translation_w.norm(), straight.turn_w.norm());
        pairs.iter().map(|pair| self.way_of(*pair, translation, turn)).collect()
    }

    /// Bound of the change of a pair's distance while the origin of the platform moves by a translation [m] and it
    /// turns [rad], with straight cables [m]: each point of a cable moves by its share of the way of the attachment.
    pub(super) fn way_of(&self, pair: ClearancePair, translation: f64, turn: f64) -> f64 {
        let lever = |i: usize| self.robot.cables[i].attachment_p.norm();
        let levers = match pair {
            ClearancePair::Cables(i, j) => lever(i) + lever(j),
            ClearancePair::CableAndPlatform { cable, .. } => lever(cable) + self.platform_reach(),
            ClearancePair::CableAndObstacle { cable, .. } => lever(cable),
            ClearancePair::PlatformAndObstacle { .. } => self.platform_reach(),
        };
        translation + turn * levers
    }

    /// Largest distance of a point of the platform from its origin [m].
    pub fn platform_reach(&self) -> f64 {
        let attachments = self.robot.cables.iter().map(|cable| cable.attachment_p.norm());
        let bodies = self.robot.platform.bodies.iter().flat_map(Body::triangles);
        attachments.chain(bodies.flatten().map(|corner| corner.norm())).fold(0.0, f64::max)
    }
}

/// Keeps the least margin of every pair.
fn keep_least(found: &mut [Option<OnTheWay>], station: &Station) {
    for (found, clearance) in found.iter_mut().zip(&station.clearances) {
        let Some(least) = *clearance else { continue };
        let known = found.as_ref().map_or(f64::INFINITY, |known| known.least.margin());
        if least.margin() < known {
            *found = Some(OnTheWay { least, fraction: station.fraction, crossings: Vec::new() });
        }
    }
}

/// Pairs among some, by their ascending numbers, that may be nearer between two stations than known so far, by more
/// than the tolerance.
fn may_be_nearer(found: &[Option<OnTheWay>], [one, other]: [&Station; 2], ways: &[f64], among: &[usize]) -> Vec<usize> {
    let known = |k: usize| found[k].as_ref().map(|known| known.least.margin());
    let bounds = least_between(one, other, ways).filter(|(k, _)| among.binary_search(k).is_ok());
    let nearer = bounds.filter(|(k, least)| known(*k).is_some_and(|known| *least < known - WAY_TOLERANCE));
    nearer.map(|(k, _)| k).collect()
}

/// Lower bounds of the margins of the pairs that are compared at two stations, with the numbers of the pairs, (40u).
pub(super) fn least_between(one: &Station, other: &Station, ways: &[f64]) -> impl Iterator<Item = (usize, f64)> {
    let step = other.fraction - one.fraction;
    let sag = |i: usize| (one.sagittas[i] - other.sagittas[i]).abs();
    let pairs = one.margins.iter().zip(&other.margins).zip(ways).enumerate();
    pairs.filter_map(move |(k, ((a, b), way))| {
        Some((k, 0.5 * ((*a)? + (*b)? - way * step) - one.pairs[k].of_cables(sag)))
    })
}

impl Placed<'_> {
    /// Largest distance of each cable from its chord [m].
    pub(super) fn sagittas(&self) -> Vec<f64> {
        self.spans.iter().map(|span| span.arc([0.0, span.length]).sagitta).collect()
    }

    /// Side on which the first of two cables passes the second at their nearest points; zero for other pairs.
    fn side(&self, found: &Clearance) -> f64 {
        let ClearancePair::Cables(i, j) = found.pair else { return 0.0 };
        self.spans[i].chord_w().cross(&self.spans[j].chord_w()).dot(&(found.points_w[0] - found.points_w[1]))
    }
}

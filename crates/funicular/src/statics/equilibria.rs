//! All equilibria of given lengths that a search finds: with cables that sag or stretch there are several (Merlet).
//!
//! The energy of an elastic cable is a convex function of the positions of its ends. So for every orientation of the
//! platform there is one position of minimum energy, and only orientations have to be searched; a point mass has one
//! equilibrium. The space of orientations is compact, so Morse theory gives a count. The sum of (−1)^index over all
//! equilibria, the index being the number of directions in which the energy falls, is the Euler characteristic of this
//! space for every robot (theory, section 16). A list with another sum lacks an equilibrium; a list with this sum may
//! still lack a pair.

use super::equilibrium::Equilibrium;
use super::error::StaticsError;
use super::forward::{CONVERGED, EnergySearch, descend_to_equilibrium, forward};
use super::model::StaticModel;
use super::nearest_pose::pose_distance;
use super::residual::check_lengths;
use crate::math::{Vec3, order, symmetric};
use crate::platform::load_size;
use crate::robot::{PlatformMotion, Pose, Robot};
use std::f64::consts::TAU;

/// Equilibrium, perhaps one of several for the same lengths.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// Equilibrium, stable or not.
    pub equilibrium: Equilibrium,
    /// Number of directions in which the energy falls.
    pub falling: usize,
    /// Number of directions in which the energy does not change: the platform can move there freely.
    pub indifferent: usize,
    /// Energy above the lowest one of the list [J]; none if the drag of the wind turns with the cables or a moment
    /// acts, which have no potential.
    pub energy: Option<f64>,
    /// Distance from the requested pose [m], see [`pose_distance`](super::pose_distance).
    pub distance: f64,
}

impl Candidate {
    /// True if the equilibrium is stable.
    pub fn is_stable(&self) -> bool {
        self.falling == 0 && self.indifferent == 0
    }
}

/// Equilibria of given lengths.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidates {
    /// Equilibria found: sorted by energy, or without energy by distance from the requested pose.
    pub found: Vec<Candidate>,
    /// Number of orientations from which the search started.
    pub starts: usize,
    /// Sum of (−1)^falling over the list.
    pub index_sum: i64,
    /// Value of the sum if no equilibrium is missing; none if some equilibrium is indifferent or the loads have no
    /// potential.
    pub expected_index_sum: Option<i64>,
}

impl Candidates {
    /// True if the sum shows that some equilibria are missing; false if it gives no information.
    pub fn lacks_some(&self) -> bool {
        self.expected_index_sum.is_some_and(|expected| expected != self.index_sum)
    }
}

/// Number of starts without a find after which the list counts as complete (ten times as many while the sum shows that
/// some are missing), and maximum number of starts. With catenaries, 400 starts give the same lists, up to 50 long, for
/// all robots of the library as 4,000. Springs, whose stiffness jumps when they go slack, may need some 10,000 starts.
const IDLE_STARTS: usize = 400;
const IDLE_FACTOR_WHILE_MISSING: usize = 10;
const MAX_STARTS: usize = 20_000;

/// Number of starts of the search for another stable equilibrium.
const FEW_STARTS: usize = 40;

/// Maximum number of equilibria in the list; more of them are points of a plateau.
const MAX_FOUND: usize = 200;

/// Distance over the size of the platform below which two equilibria count as one.
const SAME_POSE: f64 = 1e-5;

/// Eigenvalue, relative to the largest, below which a direction is indifferent.
const INDIFFERENT: f64 = 1e-9;

/// Difference of two energies, over their size, below which the platform moves from one pose to the other without work:
/// far above the rounding of an energy, which is a sum of a few products. Not tuned: it only merges points of plateaus.
const LEVEL: f64 = 1e-9;

/// Minimum curvature in Newton's method, relative to the largest: a direction of lower stiffness is stepped along as if
/// it had this one. Without a minimum, a stiffness of zero would have an infinite step; its length is limited besides.
const MIN_CURVATURE: f64 = 1e-6;

/// Maximum number of Newton steps from one start. Not tuned: a guard against wandering, after which the next start
/// follows.
const MAX_NEWTON_STEPS: usize = 80;

/// All equilibria for given unstrained lengths [m], one per cable in file order, that a search finds. Stable ones are
/// found by descent of the energy, unstable ones by Newton's method, from orientations spread over the space of
/// rotations. Deterministic. `requested` is the pose from which distances are measured; without it the pose that
/// [`forward`](super::forward) finds.
///
/// # Errors
/// [`StaticsError`]: lengths that do not fit the robot, ideal cables, or no equilibrium at all.
///
/// # Example
/// ```
/// # use funicular::{robot::Robot, statics::{self, StaticModel}};
/// # let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM)?;
/// let lengths = [6.863, 6.565, 6.756, 6.663, 6.801, 6.604];
/// let all = statics::all_equilibria(&robot, &lengths, StaticModel::Catenary, None)?;
/// assert!(all.found[0].is_stable() && all.found[0].distance < 1e-6);
/// assert!(all.found.len() >= 4 && Some(all.index_sum) == all.expected_index_sum);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # References
/// docs/theory.md, equations (50) and (51).
pub fn all_equilibria(
    robot: &Robot,
    lengths: &[f64],
    model: StaticModel,
    requested: Option<&Pose>,
) -> Result<Candidates, StaticsError> {
    if model == StaticModel::Ideal {
        return Err(StaticsError::NeedsElasticCables);
    }
    let first = forward(robot, lengths, model, requested)?;

    let mut search = EquilibriumSearch::new(robot, lengths, model, requested.copied().unwrap_or(first.pose));
    search.take(&first);
    let mut last_find = 0;
    let mut starts = 0;
    let max_starts = if robot.platform.motion.can_turn() { MAX_STARTS } else { 0 };

    while starts < max_starts && search.found.len() < MAX_FOUND {
        let wanting = search.expected().is_some_and(|expected| expected != search.index_sum());
        if starts >= last_find + if wanting { IDLE_FACTOR_WHILE_MISSING * IDLE_STARTS } else { IDLE_STARTS } {
            break;
        }
        starts += 1;

        let Some(start) = search.start(starts) else { continue };
        let new = [search.downhill(start), search.stationary(start)].into_iter().flatten();
        for equilibrium in new.collect::<Vec<_>>() {
            if search.take(&equilibrium) {
                last_find = starts;
            }
        }
    }
    Ok(search.sorted(starts))
}

/// Another stable equilibrium for the lengths of a given one, if a short search finds any. Of several the one with the
/// lowest energy, or without energy the nearest. Also returns its energy above the given one [J].
///
/// # Example
/// ```
/// # use funicular::{robot::Robot, statics::{self, StaticModel}};
/// # let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM)?;
/// let lengths = [6.863, 6.565, 6.756, 6.663, 6.801, 6.604];
/// let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None)?;
/// let other = statics::another_stable_equilibrium(&robot, &rest);
/// let (other, energy) = other.expect("turned about the vertical");
/// assert!(other.is_stable() && other.distance > 0.4 && energy > Some(7.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn another_stable_equilibrium(robot: &Robot, equilibrium: &Equilibrium) -> Option<(Candidate, Option<f64>)> {
    let lengths: Vec<f64> = equilibrium.cables.iter().map(|cable| cable.unstrained_length).collect();
    if equilibrium.model == StaticModel::Ideal
        || !robot.platform.motion.can_turn()
        || check_lengths(robot, &lengths).is_err()
    {
        return None;
    }

    let mut search = EquilibriumSearch::new(robot, &lengths, equilibrium.model, equilibrium.pose);
    search.take(equilibrium);
    let one = search.found.remove(0);
    for k in 1..=FEW_STARTS {
        if let Some(other) = search.start(k).and_then(|start| search.downhill(start))
            && !(one.0.indifferent > 0 && search.same_plateau(&one, &other))
            && pose_distance(robot, &other.pose, &equilibrium.pose) > SAME_POSE * search.size
        {
            search.take(&other);
        }
    }

    search.found.retain(|(candidate, _)| candidate.is_stable());
    let key = |found: &(Candidate, f64)| if search.has_energy() { found.1 } else { found.0.distance };
    let (other, energy) = search.found.iter().min_by(|a, b| key(a).total_cmp(&key(b)))?.clone();
    Some((other, search.has_energy().then_some(energy - one.1)))
}

/// Search with its finds, each with its energy [J].
struct EquilibriumSearch<'a> {
    robot: &'a Robot,
    lengths: &'a [f64],
    model: StaticModel,
    requested: Pose,
    /// Reference for distances: the size of the platform [m].
    size: f64,
    found: Vec<(Candidate, f64)>,
}

impl<'a> EquilibriumSearch<'a> {
    fn new(robot: &'a Robot, lengths: &'a [f64], model: StaticModel, requested: Pose) -> Self {
        Self { robot, lengths, model, requested, size: robot.platform_length(), found: Vec::new() }
    }

    /// True if the loads have a potential.
    fn has_energy(&self) -> bool {
        !self.robot.wind_turns_with_cables() && self.robot.load.moment_w == Vec3::zeros()
    }

    /// Start pose number `k`: orientations spread evenly over all rotations, at the position of minimum energy.
    fn start(&self, k: usize) -> Option<Pose> {
        let [a, b, c] = [2, 3, 5].map(|base| van_der_corput(k, base));
        let turn = match self.robot.platform.motion {
            PlatformMotion::PointMass => Vec3::zeros(),
            PlatformMotion::Planar(plane) => plane.normal_w() * (TAU * a),
            PlatformMotion::Rigid => {
                // Evenly over all rotations (Shoemake): unit quaternion from three numbers, as axis times angle.
                let (s, t) = ((1.0 - a).sqrt(), a.sqrt());
                let (w, x) = (s * (TAU * b).sin(), s * (TAU * b).cos());
                let axis = Vec3::new(x, t * (TAU * c).sin(), t * (TAU * c).cos());
                let sine = axis.norm();
                if sine > 0.0 { axis * (2.0 * sine.atan2(w) / sine) } else { axis }
            }
        };
        let turned = self.requested.moved(&Vec3::zeros(), &turn);
        let mut search = EnergySearch::new(self.robot, self.lengths, self.model, &turned);
        search.turns = false;
        let (trial, _) = search.minimise(turned);
        search.is_equilibrium(&trial).then_some(trial.pose)
    }

    fn downhill(&self, start: Pose) -> Option<Equilibrium> {
        descend_to_equilibrium(self.robot, self.lengths, self.model, start).ok()
    }

    /// Equilibrium of any stability that Newton's method converges to.
    fn stationary(&self, start: Pose) -> Option<Equilibrium> {
        if !self.has_energy() {
            return None;
        }
        let search = EnergySearch::new(self.robot, self.lengths, self.model, &start);
        let mut here = search.at(start);
        let mut steps = 0;

        while here.residual > CONVERGED {
            // Newton's step, limited in directions of very low stiffness.
            let (values, vectors) = symmetric::eigen(&search.stiffness(&here), search.coordinates.count());
            let least = MIN_CURVATURE * values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
            if least == 0.0 {
                return None;
            }

            let step = values
                .iter()
                .zip(&vectors)
                .map(|(value, vector)| {
                    let curvature = if value.abs() < least { least.copysign(*value) } else { *value };
                    vector * (vector.dot(&here.wrench) / curvature)
                })
                .sum();
            let next = search.at(search.coordinates.moved(&here.pose, &search.limited(&here, &step).0));

            let near = here.residual < here.limit;
            if near && next.residual >= here.residual {
                break;
            }
            here = next;
            steps += 1;
            if steps > MAX_NEWTON_STEPS || !here.residual.is_finite() {
                return None;
            }
        }
        search.is_equilibrium(&here).then(|| search.collected(here, self.model, steps))
    }

    /// Adds an equilibrium unless the list contains it; true if it was added.
    fn take(&mut self, equilibrium: &Equilibrium) -> bool {
        let search = EnergySearch::new(self.robot, self.lengths, self.model, &equilibrium.pose);
        let trial = search.at(equilibrium.pose);

        let (values, _) = symmetric::eigen(&search.stiffness(&trial), search.coordinates.count());
        let zero = INDIFFERENT * values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let falling = values.iter().filter(|value| **value < -zero).count();
        let indifferent = values.iter().filter(|value| value.abs() <= zero).count();

        let distance_of = |other: &Pose| pose_distance(self.robot, &equilibrium.pose, other);
        let candidate = Candidate {
            falling,
            indifferent,
            energy: None,
            distance: distance_of(&self.requested),
            equilibrium: equilibrium.clone(),
        };
        let new = (candidate, trial.energy);

        let known = self.found.iter().any(|old| {
            distance_of(&old.0.equilibrium.pose) <= SAME_POSE * self.size
                || (old.0.indifferent > 0 && indifferent > 0 && self.level(old.1, new.1))
        });
        if !known {
            self.found.push(new);
        }
        !known
    }

    /// True if two energies [J] are equal to rounding.
    fn level(&self, a: f64, b: f64) -> bool {
        let scale = load_size(self.robot) * self.size;
        (a - b).abs() <= LEVEL * (a.abs() + b.abs() + scale)
    }

    /// True if an equilibrium has the energy of an indifferent one: the platform gets there without work.
    fn same_plateau(&self, one: &(Candidate, f64), other: &Equilibrium) -> bool {
        let search = EnergySearch::new(self.robot, self.lengths, self.model, &other.pose);
        self.level(one.1, search.at(other.pose).energy)
    }

    fn index_sum(&self) -> i64 {
        self.found.iter().map(|(candidate, _)| if candidate.falling % 2 == 0 { 1 } else { -1 }).sum()
    }

    /// Euler characteristic of the space of orientations: 0 for orientations in space or in a plane, 1 for a single
    /// one.
    fn expected(&self) -> Option<i64> {
        if !self.has_energy() || self.found.iter().any(|(candidate, _)| candidate.indifferent > 0) {
            return None;
        }
        Some(i64::from(!self.robot.platform.motion.can_turn()))
    }

    fn sorted(mut self, starts: usize) -> Candidates {
        let (index_sum, expected_index_sum) = (self.index_sum(), self.expected());
        if self.has_energy() {
            order::sort_ascending(&mut self.found, |(_, energy)| *energy);
            let lowest = self.found.first().map_or(0.0, |(_, energy)| *energy);
            for (candidate, energy) in &mut self.found {
                candidate.energy = Some(*energy - lowest);
            }
        } else {
            order::sort_ascending(&mut self.found, |(candidate, _)| candidate.distance);
        }
        let found = self.found.into_iter().map(|(candidate, _)| candidate).collect();
        Candidates { found, starts, index_sum, expected_index_sum }
    }
}

/// Van der Corput's sequence: the digits of `k` mirrored at the point, evenly spread between 0 and 1.
fn van_der_corput(mut k: usize, base: usize) -> f64 {
    let (mut value, mut place) = (0.0, 1.0 / base as f64);
    while k > 0 {
        value += place * (k % base) as f64;
        k /= base;
        place /= base as f64;
    }
    value
}

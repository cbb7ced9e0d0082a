//! Centre of the tensions: the rule `centre`.
//!
//! Of all tensions within the limits that hold the platform, the centre minimises `−Σ ln(τ − α) + ln(β − τ)` (40b1). It
//! is a smooth function of the pose and of every number of the robot, because no limit is ever reached. Newton's method
//! on the tensions and the multipliers of the balance finds it without a first phase: the balance may be violated at
//! the start. A bound on the curvature of the balance, evaluated with the result, proves that there is no other centre
//! (docs/theory.md, (40b1) to (40b7)).

pub(crate) mod corners;
pub(crate) mod curve;

use super::{TensionRule, cables_at, distribute_tensions};
use crate::drive::CableAtRest;
use crate::math::{Mat6, Vec3, Vec6};
use crate::platform::{Coordinates, load_size, load_wrench, wrench_of};
use crate::robot::{Pose, Robot};
use crate::statics::collect::{with_stability, without_stability};
use crate::statics::equilibrium::Equilibrium;
use crate::statics::error::StaticsError;
use crate::statics::free_motion::SpannedWrenches;
use crate::statics::ideal;
use crate::statics::model::StaticModel;
use crate::statics::supports;
use curve::{ForceByTau, TensionCurve};

/// Maximum number of Newton steps. From the middle of the limits 7 to 15 are usual, 20 a hundred-thousandth of a newton
/// within the border of the workspace.
const MAX_STEPS: usize = 60;

/// Part of the way to the nearest limit that a step may take.
const MAX_PART: f64 = 0.95;

/// Fraction of Newton's step below which the search has run into the limits: no tensions within them, or none found.
const MIN_FRACTION: f64 = 1e-9;

/// Change of a tension over its distance from the nearer limit, and over the size of the tensions, that ends the
/// search: Newton's method squares the first, and the second is rounding.
const LAST_STEP: f64 = 1e-8;
const ROUNDING: f64 = 1e-13;

/// Maximum change of a tension over its distance from the nearer limit with which a derivative that holds the exit
/// point is good enough for a step.
const FAR: f64 = 1e-2;

/// Minimum curvature of the Lagrangian over that of the logarithms in a step; only very slack cables come near.
const MIN_CURVATURE: f64 = 0.1;

/// Minimum pivot of the scaled matrix of the balance below which the cables do not span the degrees of freedom.
const MIN_PIVOT: f64 = 1e-12;

/// Maximum share of the load along the motions that the cables leave free; see `BALANCED_ALONG_FREE` in
/// `tension/null_space.rs`.
const BALANCED_ALONG_FREE: f64 = 1e-12;

/// Least distance of a start from a limit over the distance between the limits.
const MIN_START: f64 = 1e-3;

/// Left side of (40b5) below which the centre is proved to be the only one: one half, and the other half for the orders
/// that (36a) leaves out.
const UNIQUE: f64 = 0.5;

/// Places between the limits at which the curvature is looked at where (40b5) proves nothing.
const PLACES: usize = 16;

/// Centre of the tensions at a pose.
#[derive(Debug, Clone, PartialEq)]
pub struct TensionCentre {
    /// Equilibrium with these tensions.
    pub equilibrium: Equilibrium,
    /// Tension τ of each cable parallel to its chord [N], in file order.
    pub tensions: Vec<f64>,
    /// Limits of τ of each cable [N]: at the first its lowest tension is at its minimum, at the second its highest one
    /// at its maximum.
    pub limits: Vec<[f64; 2]>,
    /// Multipliers of the balance [1/N]: those of the force, then those of the moment over
    /// [`Robot::platform_length`], in the coordinates of the degrees of freedom.
    pub multipliers: Vec<f64>,
    /// True if it is proved that no other tensions are a centre.
    pub unique: bool,
}

/// Centre of the tensions that hold the platform at a pose within their limits: the rule [`TensionRule::Centre`], with
/// the multipliers of the balance and the proof that it is the only one. `last` is a centre nearby, from which the
/// search starts; the result does not depend on it but for rounding.
///
/// # Errors
/// [`StaticsError`], as for [`distribute_tensions`]; [`StaticsError::NoCentre`] if the tensions cannot be strictly
/// within their limits.
///
/// # Example
/// ```
/// use funicular::robot::{Pose, Robot};
/// use funicular::statics::{self, StaticModel};
///
/// let robot = Robot::from_toml(funicular_robots::COGIRO)?;
/// let at = |x: f64| Pose::new([x, -2.0, 1.5], [0.0, 0.0, 5.0]);
/// let first = statics::tension_centre(&robot, &at(1.0), StaticModel::Catenary, None)?;
/// let next = statics::tension_centre(&robot, &at(1.004), StaticModel::Catenary, Some(&first))?;
/// assert!(first.unique && next.unique && next.equilibrium.iterations < first.equilibrium.iterations);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # References
/// docs/theory.md, equations (40b1) to (40b7).
pub fn tension_centre(
    robot: &Robot,
    pose: &Pose,
    model: StaticModel,
    last: Option<&TensionCentre>,
) -> Result<TensionCentre, StaticsError> {
    cables_at(robot, pose, model, &TensionRule::Centre)?;
    if !robot.has_supports() {
        let mut found = on_rigid_supports(robot, pose, model, last)?;
        found.equilibrium = with_stability(robot, found.equilibrium);
        return Ok(found);
    }

    // Flexible supports are displaced by the forces of the round before, and held in each.
    let in_round = |rigid: &Robot| on_rigid_supports(rigid, pose, model, last);
    let mut found = supports::on_flexible_supports(robot, in_round, |found| &mut found.equilibrium.cables, &[])?;
    found.equilibrium = with_stability(robot, found.equilibrium);
    Ok(found)
}

/// Centre by [`tension_centre`] on rigid supports, the stability left open.
fn on_rigid_supports(
    robot: &Robot,
    pose: &Pose,
    model: StaticModel,
    last: Option<&TensionCentre>,
) -> Result<TensionCentre, StaticsError> {
    let mut search = CentreSearch::new(robot, pose, model)?;
    let has_room = search.cables.iter().all(|cable| cable.lower < cable.upper);
    let mut found = false;
    if has_room {
        if let Some(last) = last {
            search.start(|i| last.tensions.get(i).copied().unwrap_or(0.0), &last.multipliers);
            found = search.newton();
        }
        if !found {
            search.start(|_| f64::NAN, &[]);
            found = search.newton();
        }
    }

    // The tensions farthest from the limits are another start; the search for them proves that there are none.
    if !found {
        let middle = distribute_tensions(robot, pose, model, &TensionRule::Middle)?;
        let of_state = |i: usize| {
            let state = &middle.cables[i];
            state.hanging.as_ref().map_or(state.tension_platform, |span| span.catenary.parallel_tension())
        };
        if has_room {
            search.start(of_state, &[]);
            found = search.newton();
        }
        if !found {
            return Err(search.no_centre(of_state));
        }
    }
    Ok(search.collected())
}

/// Cable with its limits.
struct CentreCable<'a> {
    curve: TensionCurve<'a>,
    /// Lever arm over ℓ.
    lever_w: Vec3,
    /// Limits of τ.
    lower: f64,
    upper: f64,
}

impl CentreCable<'_> {
    /// Distances of τ from both limits.
    fn room(&self) -> [f64; 2] {
        [self.curve.tau() - self.lower, self.upper - self.curve.tau()]
    }

    /// First and second derivative of the logarithms by τ.
    fn barrier(&self) -> [f64; 2] {
        barrier(self.room())
    }
}

/// First and second derivative of `−ln s⁻ − ln s⁺` by τ.
fn barrier([below, above]: [f64; 2]) -> [f64; 2] {
    [1.0 / above - 1.0 / below, 1.0 / (below * below) + 1.0 / (above * above)]
}

/// Search for the centre.
struct CentreSearch<'a> {
    robot: &'a Robot,
    pose: &'a Pose,
    model: StaticModel,
    coordinates: Coordinates,
    cables: Vec<CentreCable<'a>>,
    /// Wrench of weight and load, reduced.
    load: Vec6,
    /// Reference size of the tensions [N].
    size: f64,
    multipliers: Vec6,
    iterations: usize,
}

/// Newton's step: changes of the tensions and of the multipliers.
struct CentreStep {
    tau: Vec<f64>,
    multipliers: Vec6,
}

impl<'a> CentreSearch<'a> {
    fn new(robot: &'a Robot, pose: &'a Pose, model: StaticModel) -> Result<Self, StaticsError> {
        let coordinates = Coordinates::of(robot);
        let cables = (0..robot.cables.len())
            .map(|i| {
                let curve = TensionCurve::new(robot, i, pose, model)?;
                let [lower, upper] = curve.limits().map(|limit| limit.curve.tau());
                let lever_w = (curve.span.start_w - pose.position_w) / coordinates.ell();
                Ok(CentreCable { curve, lever_w, lower, upper })
            })
            .collect::<Result<Vec<_>, StaticsError>>()?;
        let load = coordinates.reduce(&load_wrench(robot, pose));
        let size = load_size(robot) + cables.iter().map(|cable| cable.lower.abs()).sum::<f64>();
        let multipliers = Vec6::zeros();
        Ok(Self { robot, pose, model, coordinates, cables, load, size, multipliers, iterations: 0 })
    }

    /// Goes to these tensions, moved inside the limits; not a number stands for their middle.
    fn start(&mut self, tau: impl Fn(usize) -> f64, multipliers: &[f64]) {
        for (i, cable) in self.cables.iter_mut().enumerate() {
            let (middle, width) = (0.5 * (cable.lower + cable.upper), cable.upper - cable.lower);
            let wanted = tau(i);
            let wanted = if wanted.is_nan() { middle } else { wanted };
            cable.curve.set(wanted.clamp(cable.lower + MIN_START * width, cable.upper - MIN_START * width));
        }
        self.multipliers = Vec6::from_fn(|k, _| multipliers.get(k).copied().unwrap_or(0.0));
    }

    /// Reduced wrench of a force at a cable.
    fn wrench(&self, cable: &CentreCable<'_>, force_w: &Vec3) -> Vec6 {
        self.coordinates.motion().reduced(&wrench_of(force_w, &cable.lever_w))
    }

    /// Newton's method; true if it converges. It does not at a singular pose, and where so many tensions have run into
    /// their limits that the others do not span the degrees of freedom: the search of the rule `middle` tells which.
    fn newton(&mut self) -> bool {
        let mut far = true;
        for _ in 0..MAX_STEPS {
            self.iterations += 1;
            let Some(step) = self.step(!far) else { return false };

            // Part of the way to the nearest limit.
            let (mut fraction, mut change, mut rounding) = (1.0_f64, 0.0_f64, true);
            for (cable, step) in self.cables.iter().zip(&step.tau) {
                let [below, above] = cable.room();
                let room = if *step < 0.0 { below } else { above };
                if step.abs() * fraction > MAX_PART * room {
                    fraction = MAX_PART * room / step.abs();
                }
                let part = step.abs() / below.min(above);
                if part.is_nan() {
                    return false;
                }
                change = change.max(part);
                rounding &= step.abs() <= LAST_STEP * below.min(above) + ROUNDING * self.size;
            }
            if fraction <= MIN_FRACTION {
                return false;
            }

            for (cable, step) in self.cables.iter_mut().zip(&step.tau) {
                cable.curve.set(cable.curve.tau() + fraction * step);
            }
            self.multipliers += step.multipliers * fraction;
            if rounding && !far {
                return true;
            }
            far = change > FAR && self.has_moving_exits();
        }
        false
    }

    fn has_moving_exits(&self) -> bool {
        self.cables.iter().any(|cable| cable.curve.has_moving_exit())
    }

    /// Newton's step (40b6); `None` if its matrix is singular. `follows` lets the exit points follow in the
    /// derivatives.
    fn step(&self, follows: bool) -> Option<CentreStep> {
        let y = &self.multipliers;
        let (mut balance, mut matrix, mut right) = (self.load, Mat6::zeros(), Vec6::zeros());
        let mut rows = Vec::with_capacity(self.cables.len());
        for cable in &self.cables {
            let ForceByTau { first_w, second_up } = cable.curve.force_by_tau(follows);
            let [slope, curvature] = cable.barrier();
            let column = self.wrench(cable, &first_w);
            balance += self.wrench(cable, &cable.curve.span.force_on_start_w());
            let bend = y.dot(&self.wrench(cable, &cable.curve.span.axes_w().1)) * second_up;
            let weight = 1.0 / (curvature - bend).max(MIN_CURVATURE * curvature);
            let residual = slope - column.dot(y);
            matrix.ger(weight, &column, &column, 1.0);
            right += column * (weight * residual);
            rows.push((column, weight, residual));
        }

        let multipliers = self.solved(&matrix, &(right - balance), &rows)?;
        let tau = rows.iter().map(|(column, weight, residual)| weight * (column.dot(&multipliers) - residual));
        Some(CentreStep { tau: tau.collect(), multipliers })
    }

    /// Solution of `S Δy = right`; `None` if there is none. If the cables do not span the degrees of freedom, that in
    /// the wrenches which they span.
    fn solved(&self, matrix: &Mat6, right: &Vec6, rows: &[(Vec6, f64, f64)]) -> Option<Vec6> {
        let n = self.coordinates.count();
        if let Some(solution) = solved_if_regular(matrix, right, n) {
            return Some(solution);
        }
        let columns: Vec<Vec6> = rows.iter().map(|(column, ..)| *column).collect();
        let SpannedWrenches { spanned, free } = SpannedWrenches::of(&columns, n);
        let unbalanced = free.iter().map(|free| free.dot(right).abs()).fold(0.0, f64::max);
        if spanned.is_empty() || unbalanced > BALANCED_ALONG_FREE * (right.norm() + self.size) {
            return None;
        }

        let row = |k: usize| spanned.get(k).copied().unwrap_or_else(Vec6::zeros);
        let within = Mat6::from_fn(|j, k| row(j).dot(&(matrix * row(k))));
        let along = Vec6::from_fn(|k, _| row(k).dot(right));
        let solution = solved_if_regular(&within, &along, spanned.len())?;
        Some(spanned.iter().zip(solution.iter()).map(|(wrench, part)| wrench * *part).sum())
    }

    /// True if (40b5), or the curvature at some places between the limits, shows that the centre is the only one.
    fn is_unique(&self) -> bool {
        self.cables.iter().all(|cable| {
            let up = self.multipliers.dot(&self.wrench(cable, &cable.curve.span.axes_w().1)).abs();
            let catenary = &cable.curve.span.catenary;
            let [cos, sin] = catenary.chord_direction();
            let weight = catenary.rope().weight_per_length * cable.curve.span.chord_w().norm();
            let inclined = weight * weight * sin.abs() / (6.0 * cable.lower);
            let level = weight.powi(3) * cos * cos / (8.0 * cable.lower * cable.lower);
            weight == 0.0 || up * (inclined + level) < UNIQUE || self.is_convex(cable)
        })
    }

    /// True if the Lagrangian is convex in the tension of a cable at [`PLACES`] places between its limits, (40b4).
    fn is_convex(&self, cable: &CentreCable<'_>) -> bool {
        let ratio = cable.upper / cable.lower;
        (0..PLACES).all(|place| {
            let tau = cable.lower * ratio.powf((place as f64 + 0.5) / PLACES as f64);
            let mut there = cable.curve.clone();
            there.set(tau);
            let [_, curvature] = barrier([tau - cable.lower, cable.upper - tau]);
            let bend = self.multipliers.dot(&self.wrench(cable, &there.span.axes_w().1));
            curvature > bend * there.force_by_tau(false).second_up
        })
    }

    /// Error of a pose whose tensions have no room between their limits. `tau` are the tensions farthest from them.
    fn no_centre(&self, tau: impl Fn(usize) -> f64) -> StaticsError {
        let room = |i: usize| (tau(i) - self.cables[i].lower).min(self.cables[i].upper - tau(i));
        let count = self.cables.len();
        let tightest = (0..count).min_by(|a, b| room(*a).total_cmp(&room(*b))).unwrap_or(0);
        StaticsError::NoCentre { cable: self.robot.cables[tightest].name.clone(), room: room(tightest).max(0.0) }
    }

    fn collected(self) -> TensionCentre {
        let unique = self.is_unique();
        let tensions: Vec<f64> = self.cables.iter().map(|cable| cable.curve.tau()).collect();
        let limits = self.cables.iter().map(|cable| [cable.lower, cable.upper]).collect();
        let multipliers = self.multipliers.iter().copied().take(self.coordinates.count()).collect();
        let (robot, pose, model, iterations) = (self.robot, self.pose, self.model, self.iterations);
        let equilibrium = if model == StaticModel::Ideal {
            ideal::collect(robot, *pose, &tensions, iterations)
        } else {
            let at_rest: Vec<_> = self.cables.iter().map(|cable| cable.curve.at_rest()).collect();
            let lengths: Vec<f64> = at_rest.iter().map(CableAtRest::unstrained_length).collect();
            without_stability(robot, *pose, model, at_rest, &lengths, iterations)
        };
        TensionCentre { equilibrium, tensions, limits, multipliers, unique }
    }
}

/// Solution of a positive system of the first `n` unknowns by the method of Cholesky, with the diagonal scaled to one;
/// `None` if it is singular.
fn solved_if_regular(matrix: &Mat6, right: &Vec6, n: usize) -> Option<Vec6> {
    let scale = Vec6::from_fn(|k, _| if k < n { 1.0 / matrix[(k, k)].sqrt() } else { 1.0 });
    if !scale.iter().all(|scale| scale.is_finite()) {
        return None;
    }
    let unit = |j: usize, k: usize| f64::from(u8::from(j == k));
    let scaled = Mat6::from_fn(|j, k| if j < n && k < n { matrix[(j, k)] * scale[j] * scale[k] } else { unit(j, k) });
    let factor = scaled.cholesky()?;
    let pivot = factor.l_dirty().diagonal().iter().fold(f64::INFINITY, |least: f64, pivot| least.min(pivot * pivot));
    if pivot.is_nan() || pivot <= MIN_PIVOT {
        return None;
    }
    let right = Vec6::from_fn(|k, _| if k < n { right[k] * scale[k] } else { 0.0 });
    Some(factor.solve(&right).component_mul(&scale))
}

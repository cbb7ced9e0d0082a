//! Centre of the tensions: the rule `centre`.
//!
//! Of all tensions within the limits that hold the platform, the centre minimises `−Σ ln(τ − α) + ln(β − τ)` (40b1). It
//! is a smooth function of the pose and of every number of the robot, because no limit is ever reached. Newton's method
//! on the tensions and the multipliers of the balance finds it without a first phase: the balance may be violated at
//! the start. A bound on the curvature of the balance, evaluated with the result, proves that there is no other centre
//! (docs/theory.md, (40b1) to (40b7)).

pub(crate) mod along;
pub(crate) mod corners;
pub(crate) mod curve;
mod missing;
mod potential;
pub(crate) mod rates;

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
pub(crate) use potential::Potential;

/// Maximum number of Newton steps. From the middle of the limits 7 to 15 are usual, 20 a hundred-thousandth of a newton
/// within the border of the workspace.
const MAX_STEPS: usize = 60;

/// Part of the way to the nearest limit that a step may take.
const MAX_PART: f64 = 0.95;

/// Fraction of Newton's step below which the search has run into the limits: no tensions within them, or none found.
const MIN_FRACTION: f64 = 1e-9;

/// Change of a tension over its distance from the nearer limit, and over the size of the tensions, that ends the
/// search: Newton's method squares the first, and the second is rounding.
const LAST_STEP: f64 = 3e-7;
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

/// Places between the limits at which the curvature is looked at where (40b5) proves nothing.
const PLACES: usize = 16;

/// Maximum number of cables whose tensions are proved not to exist without memory from the heap: that of a control
/// loop.
const MAX_INLINE: usize = 16;

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
    /// Proof that no other tensions are a centre.
    pub certificate: CentreCertificate,
}

/// Proof that the tensions of a centre are the only ones, by the curvature of the balance over that of the logarithms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CentreCertificate {
    /// Largest left side of (40b5) over all cables [-]: a bound of the curvature of the balance over that of the
    /// logarithms, without higher orders. Zero for straight cables.
    pub curvature: f64,
    /// Index of the cable with this value.
    pub cable: usize,
    /// Least left side of (40b4) over φ'' [-], at sixteen places between the limits of each cable for which (40b5)
    /// fails; `None` if it holds for all cables.
    pub convexity: Option<f64>,
}

impl CentreCertificate {
    /// Maximum of [`Self::curvature`] that proves it: one half, and the other half is for the orders that (36a) leaves
    /// out.
    pub const MAX_CURVATURE: f64 = 0.5;

    /// True if no other tensions are a centre: proved by the bound, or seen at the places.
    pub fn is_unique(&self) -> bool {
        self.curvature < Self::MAX_CURVATURE || self.convexity.is_some_and(|least| least > 0.0)
    }
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
/// assert!(first.certificate.is_unique() && next.certificate.is_unique());
/// assert!(next.equilibrium.iterations < first.equilibrium.iterations);
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
    let coordinates = Coordinates::of(robot);
    let mut cables = (0..robot.cables.len())
        .map(|i| Ok(CentreCable::new(TensionCurve::new(robot, i, pose, model)?, pose, coordinates, None)))
        .collect::<Result<Vec<_>, StaticsError>>()?;
    let mut rows = vec![CentreRow::default(); cables.len()];
    let load = CentreLoad { wrench: coordinates.reduce(&load_wrench(robot, pose)), size: load_size(robot) };
    let mut search = CentreSearch::new(coordinates, &mut cables, &mut rows, load);
    search.may_be_dependent = true;
    let has_room = search.has_room();
    let mut found = false;
    if has_room {
        if let Some(last) = last {
            search.start(|i| last.tensions.get(i).copied().unwrap_or(0.0), &last.multipliers);
            found = search.newton(MAX_STEPS);
        }
        if !found {
            search.start(|_| f64::NAN, &[]);
            found = search.newton(MAX_STEPS);
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
            found = search.newton(MAX_STEPS);
        }
        if !found {
            return Err(search.no_centre(robot, of_state));
        }
    }
    Ok(search.collected(robot, pose, model))
}

/// Cable with its limits.
#[derive(Debug, Clone)]
pub(crate) struct CentreCable<'a> {
    pub(crate) curve: TensionCurve<'a>,
    /// Lever arm over ℓ.
    lever_w: Vec3,
    /// Limits of τ.
    pub(crate) lower: f64,
    pub(crate) upper: f64,
}

impl<'a> CentreCable<'a> {
    /// Cable with its limits, searched from those of a pose nearby.
    pub(crate) fn new(curve: TensionCurve<'a>, pose: &Pose, coordinates: Coordinates, near: Option<[f64; 2]>) -> Self {
        let [lower, upper] = curve.limits_near(near).map(|limit| limit.curve.tau());
        Self::within(curve, pose, coordinates, [lower, upper])
    }

    /// Cable with these limits of τ [N].
    pub(crate) fn within(curve: TensionCurve<'a>, pose: &Pose, coordinates: Coordinates, limits: [f64; 2]) -> Self {
        let lever_w = (curve.span.start_w - pose.position_w) / coordinates.ell();
        Self { curve, lever_w, lower: limits[0], upper: limits[1] }
    }

    /// Distances of τ from both limits.
    pub(crate) fn room(&self) -> [f64; 2] {
        [self.curve.tau() - self.lower, self.upper - self.curve.tau()]
    }
}

/// Load on the platform.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CentreLoad {
    /// Wrench of weight and load, reduced.
    pub(crate) wrench: Vec6,
    /// Sum of the sizes of their forces, and of moments over ℓ [N].
    pub(crate) size: f64,
}

/// Cable in Newton's step.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct CentreRow {
    /// Wrench by τ, reduced.
    column: Vec6,
    /// Inverse curvature of the Lagrangian, and its slope.
    weight: f64,
    residual: f64,
    /// Change of τ [N].
    pub(crate) step: f64,
}

/// Search for the centre, in memory of the caller: one row per cable.
pub(crate) struct CentreSearch<'a, 's> {
    coordinates: Coordinates,
    pub(crate) cables: &'s mut [CentreCable<'a>],
    rows: &'s mut [CentreRow],
    load: CentreLoad,
    /// Reference size of the tensions [N].
    size: f64,
    pub(crate) multipliers: Vec6,
    pub(crate) iterations: usize,
    /// Function whose minimum is searched.
    pub(crate) potential: Potential,
    /// True if the first step of the last search had no solution: the cables do not span the degrees of freedom.
    pub(crate) is_singular: bool,
    /// True if cables that do not span the degrees of freedom are searched for a solution too, in memory from the heap.
    may_be_dependent: bool,
}

impl<'a, 's> CentreSearch<'a, 's> {
    pub(crate) fn new(
        coordinates: Coordinates,
        cables: &'s mut [CentreCable<'a>],
        rows: &'s mut [CentreRow],
        load: CentreLoad,
    ) -> Self {
        let size = load.size + cables.iter().map(|cable| cable.lower.abs()).sum::<f64>();
        Self {
            coordinates,
            cables,
            rows,
            load,
            size,
            multipliers: Vec6::zeros(),
            iterations: 0,
            potential: Potential::Logarithms,
            is_singular: false,
            may_be_dependent: false,
        }
    }

    /// True if every cable has tensions between its limits.
    pub(crate) fn has_room(&self) -> bool {
        self.cables.iter().all(|cable| cable.lower < cable.upper)
    }

    /// Goes to these tensions, moved inside the limits; not a number stands for their middle.
    pub(crate) fn start(&mut self, tau: impl Fn(usize) -> f64, multipliers: &[f64]) {
        for (i, cable) in self.cables.iter_mut().enumerate() {
            let (middle, width) = (0.5 * (cable.lower + cable.upper), cable.upper - cable.lower);
            let wanted = tau(i);
            let wanted = if wanted.is_nan() { middle } else { wanted };
            cable.curve.set(wanted.clamp(cable.lower + MIN_START * width, cable.upper - MIN_START * width));
        }
        self.multipliers = Vec6::from_fn(|k, _| multipliers.get(k).copied().unwrap_or(0.0));
    }

    /// Goes to these tensions as they are; not a number stands for the middle of the limits, or without a maximum for a
    /// taut cable.
    pub(crate) fn start_at(&mut self, tau: impl Fn(usize) -> f64, multipliers: Vec6) {
        for (i, cable) in self.cables.iter_mut().enumerate() {
            let wanted = tau(i);
            if !wanted.is_nan() {
                cable.curve.set(wanted);
            } else if cable.upper.is_finite() {
                cable.curve.set(0.5 * (cable.lower + cable.upper));
            }
        }
        self.multipliers = multipliers;
    }

    /// True if no tension is so near to a limit that a relaxed logarithm differs from the logarithm.
    pub(crate) fn is_inside(&self) -> bool {
        self.violation() < -1.0
    }

    /// Largest violation of a limit, over the width in which a logarithm is relaxed; negative within the limits.
    pub(crate) fn violation(&self) -> f64 {
        let of_cable = |cable: &CentreCable<'_>| potential::violation(cable);
        self.cables.iter().map(of_cable).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Reduced wrench of a force at a cable.
    fn wrench(&self, cable: &CentreCable<'_>, force_w: &Vec3) -> Vec6 {
        self.coordinates.motion().reduced(&wrench_of(force_w, &cable.lever_w))
    }

    /// Newton's method; true if it converges. It does not at a singular pose, and where so many tensions have run into
    /// their limits that the others do not span the degrees of freedom: the search of the rule `middle` tells which.
    pub(crate) fn newton(&mut self, max_steps: usize) -> bool {
        let mut far = true;
        for step_count in 0..max_steps {
            self.iterations += 1;
            let Some(multipliers) = self.step(!far) else {
                self.is_singular = step_count == 0;
                return false;
            };

            // Part of the way to the nearest limit.
            let (mut fraction, mut change, mut rounding) = (1.0_f64, 0.0_f64, true);
            for (cable, row) in self.cables.iter().zip(&*self.rows) {
                let (step, reach) = (row.step, self.potential.reach(cable, row.step));
                if step.abs() * fraction > MAX_PART * reach {
                    fraction = MAX_PART * reach / step.abs();
                }
                let near = self.potential.size(cable);
                let part = step.abs() / near;
                if part.is_nan() {
                    return false;
                }
                change = change.max(part);
                rounding &= step.abs() <= LAST_STEP * near + ROUNDING * self.size;
            }
            if fraction <= MIN_FRACTION {
                return false;
            }

            for (cable, row) in self.cables.iter_mut().zip(&*self.rows) {
                cable.curve.set(self.potential.moved(cable, fraction * row.step));
            }
            if self.potential != Potential::None {
                self.multipliers += multipliers * fraction;
            }
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

    /// Newton's step (40b6), with the change of the multipliers; `None` if its matrix is singular. `follows` lets the
    /// exit points follow in the derivatives.
    fn step(&mut self, follows: bool) -> Option<Vec6> {
        let y = self.multipliers;
        let (mut balance, mut matrix, mut right) = (self.load.wrench, Mat6::zeros(), Vec6::zeros());
        for (i, cable) in self.cables.iter().enumerate() {
            let ForceByTau { first_w, second_up } = cable.curve.force_by_tau(follows);
            let [slope, curvature] = self.potential.derivatives(cable);
            let column = self.wrench(cable, &first_w);
            balance += self.wrench(cable, &cable.curve.span.force_on_start_w());
            let bend = y.dot(&self.wrench(cable, &cable.curve.span.axes_w().1)) * second_up;
            let weight = 1.0 / (curvature - bend).max(MIN_CURVATURE * curvature);
            let residual = slope - column.dot(&y);
            matrix.ger(weight, &column, &column, 1.0);
            right += column * (weight * residual);
            self.rows[i] = CentreRow { column, weight, residual, step: 0.0 };
        }

        if self.potential == Potential::None {
            return self.balancing_step(&balance);
        }
        let multipliers = self.solved(&matrix, &(right - balance))?;
        for row in &mut *self.rows {
            row.step = row.weight * (row.column.dot(&multipliers) - row.residual);
        }
        Some(multipliers)
    }

    /// Newton's step of as many cables as degrees of freedom, which the balance alone determines. The matrix of (40b6)
    /// would square its condition.
    fn balancing_step(&mut self, balance: &Vec6) -> Option<Vec6> {
        let mut columns = Mat6::identity();
        for (i, row) in self.rows.iter().enumerate().take(6) {
            columns.set_column(i, &row.column);
        }
        let step = columns.lu().solve(&-balance)?;
        for (row, step) in self.rows.iter_mut().zip(step.iter()) {
            row.step = *step;
        }
        Some(Vec6::zeros())
    }

    /// Solution of `S Δy = right`; `None` if there is none. If the cables do not span the degrees of freedom, that in
    /// the wrenches which they span.
    fn solved(&self, matrix: &Mat6, right: &Vec6) -> Option<Vec6> {
        let n = self.coordinates.count();
        if let Some(solution) = solved_if_regular(matrix, right, n) {
            return Some(solution);
        }
        if !self.may_be_dependent {
            return None;
        }
        let columns: Vec<Vec6> = self.rows.iter().map(|row| row.column).collect();
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

    /// Remaining wrench [N]: the larger of force and moment/ℓ; and the sum of the sizes of all forces [N].
    pub(crate) fn unbalanced(&self) -> [f64; 2] {
        let (mut sum, mut size) = (self.load.wrench, self.load.size);
        for cable in &*self.cables {
            let force_w = cable.curve.span.force_on_start_w();
            sum += self.wrench(cable, &force_w);
            size += force_w.norm();
        }
        let sum = self.coordinates.expand(&sum);
        [sum.fixed_rows::<3>(0).norm().max(sum.fixed_rows::<3>(3).norm()), size]
    }

    /// Last step of each cable [N].
    pub(crate) fn last_step(&self, i: usize) -> f64 {
        self.rows[i].step
    }

    /// Proof that the centre is the only one, by (40b5) or by the curvature at some places between the limits.
    pub(crate) fn certificate(&self) -> CentreCertificate {
        let mut found = CentreCertificate { curvature: 0.0, cable: 0, convexity: None };
        for (i, cable) in self.cables.iter().enumerate() {
            let up = self.multipliers.dot(&self.wrench(cable, &cable.curve.span.axes_w().1)).abs();
            let catenary = &cable.curve.span.catenary;
            let [cos, sin] = catenary.chord_direction();
            let weight = catenary.rope().weight_per_length * cable.curve.span.chord_w().norm();
            if weight == 0.0 {
                continue;
            }
            let inclined = weight * weight * sin.abs() / (6.0 * cable.lower);
            let level = weight.powi(3) * cos * cos / (8.0 * cable.lower * cable.lower);
            let curvature = up * (inclined + level);
            if curvature > found.curvature {
                (found.curvature, found.cable) = (curvature, i);
            }
            if curvature.is_nan() || curvature >= CentreCertificate::MAX_CURVATURE {
                let least = self.least_convexity(cable);
                found.convexity = Some(found.convexity.map_or(least, |other| other.min(least)));
            }
        }
        found
    }

    /// Least curvature of the Lagrangian in the tension of a cable over that of the logarithms, at [`PLACES`] places
    /// between its limits, (40b4).
    fn least_convexity(&self, cable: &CentreCable<'_>) -> f64 {
        let ratio = cable.upper / cable.lower;
        let at = |place: usize| {
            let tau = cable.lower * ratio.powf((place as f64 + 0.5) / PLACES as f64);
            let mut there = cable.curve.clone();
            there.set(tau);
            let [_, curvature] = potential::logarithms([tau - cable.lower, cable.upper - tau]);
            let bend = self.multipliers.dot(&self.wrench(cable, &there.span.axes_w().1));
            1.0 - bend * there.force_by_tau(false).second_up / curvature
        };
        (0..PLACES).map(at).fold(f64::INFINITY, f64::min)
    }

    /// Error of a pose whose tensions have no room between their limits. `tau` are the tensions farthest from them.
    fn no_centre(&self, robot: &Robot, tau: impl Fn(usize) -> f64) -> StaticsError {
        let room = |i: usize| (tau(i) - self.cables[i].lower).min(self.cables[i].upper - tau(i));
        let count = self.cables.len();
        let tightest = (0..count).min_by(|a, b| room(*a).total_cmp(&room(*b))).unwrap_or(0);
        StaticsError::NoCentre { cable: robot.cables[tightest].name.clone(), room: room(tightest).max(0.0) }
    }

    fn collected(self, robot: &Robot, pose: &Pose, model: StaticModel) -> TensionCentre {
        let certificate = self.certificate();
        let tensions: Vec<f64> = self.cables.iter().map(|cable| cable.curve.tau()).collect();
        let limits = self.cables.iter().map(|cable| [cable.lower, cable.upper]).collect();
        let multipliers = self.multipliers.iter().copied().take(self.coordinates.count()).collect();
        let iterations = self.iterations;
        let equilibrium = if model == StaticModel::Ideal {
            ideal::collect(robot, *pose, &tensions, iterations)
        } else {
            let at_rest: Vec<_> = self.cables.iter().map(|cable| cable.curve.at_rest()).collect();
            let lengths: Vec<f64> = at_rest.iter().map(CableAtRest::unstrained_length).collect();
            without_stability(robot, *pose, model, at_rest, &lengths, iterations)
        };
        TensionCentre { equilibrium, tensions, limits, multipliers, certificate }
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

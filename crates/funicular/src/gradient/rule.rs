//! Tensions that follow the rule of their distribution while the pose is held.
//!
//! The tensions of more cables than degrees of freedom solve a small problem with constraints (docs/theory.md,
//! equations (38) and (39)). Its optimality conditions hold for the changed robot as well, with equations for the
//! limits that are reached: each condition is a scalar that stays zero. Multiples of these scalars are added to the
//! differential of a result, so that the coefficients of all tensions become zero (equations (60r) to (60t)). Over
//! pulleys the distribution holds the exit points while it chooses the tensions: its conditions contain the free span,
//! while the balance contains the whole cable (equations (60t2) and (60t3)).

use super::GradientError;
use super::adjoint::{Adjoint, CableAdjoint};
use super::cable_form::CableForm;
use super::parallel_tension::{ParallelTension, by_length};
use super::scalar::{add_real, add_times};
use crate::catenary::Catenary;
use crate::drive::derivatives::end;
use crate::math::{DMat, Vec3, Vec6};
use crate::platform::Coordinates;
use crate::robot::Robot;
use crate::statics::derivatives::{CablePartials, StaticDerivativeError, force_at_anchor, load_of};
use crate::statics::{CableState, Equilibrium, Limit, MinimumTension, StaticModel, TensionRange, TensionRule};

/// Relative tolerance, over the maximum tension: a tension this near a limit is at it, and a smaller multiplier is
/// zero. The search for tensions ends when they change by less than 1e-10; over pulleys and for the rule `middle` it
/// keeps a limit to 1e-9. Its results are documented to a millionth.
const AT_LIMIT: f64 = 1e-7;

/// Minimum ratio of a pivot to the largest one; below it the conditions are singular and do not determine the tensions.
/// Rounding leaves 1e-15 times the number of cables.
const MIN_PIVOT_RATIO: f64 = 1e-11;

/// Relative distance of the tension at a drum from the tensions in the free span, above which the drum has the minimum
/// or the maximum tension. A weightless cable has the same tension everywhere, but for rounding; the weight of a real
/// one along the height of a wheel is 1e-6 of its tension and more.
const DRUM_ROUNDING: f64 = 1e-13;

/// Optimality conditions of the tensions, solved for their multipliers.
pub(super) struct RuleFollower {
    /// Multipliers of the balance, then of the conditions, from the coefficients of the parallel tensions.
    solution: DMat,
    conditions: Vec<Condition>,
    degrees_of_freedom: usize,
}

/// Optimality condition: a scalar that is zero at the tensions of the rule.
struct Condition {
    cable: usize,
    coefficients: CableAdjoint<f64>,
    /// Coefficients of the mass of the platform and of gravity.
    mass: f64,
    gravity_w: Vec3,
    /// Coefficient of the relative distance from the limits, which the rule `middle` maximises.
    distance: f64,
    /// True for the stationarity of a tension between its limits, which contains the multipliers of the balance.
    is_stationarity: bool,
}

/// Limit of a tension, in terms of which conditions are written.
#[derive(Debug, Clone, Copy, PartialEq)]
enum TensionBound {
    /// Minimum tension anywhere in the cable.
    Minimum,
    /// Maximum tension anywhere in the cable.
    Maximum,
    /// Minimum parallel tension of a sagging cable, (37).
    Slackest,
}

/// Equilibrium with the quantities that stand in the conditions.
struct RuleConditions<'a> {
    robot: &'a Robot,
    equilibrium: &'a Equilibrium,
    coordinates: &'a Coordinates,
    partials: &'a [CablePartials],
    tensions: &'a [ParallelTension],
    /// Wrenches per parallel tension, reduced; one column per cable.
    wrenches: &'a DMat,
    /// Wrenches per parallel tension with held exit points, reduced; the distribution uses these.
    held_wrenches: DMat,
    ranges: Vec<TensionRange>,
    /// Maximum tension [N].
    size: f64,
}

impl RuleFollower {
    pub(super) fn new(
        robot: &Robot,
        equilibrium: &Equilibrium,
        coordinates: &Coordinates,
        (partials, tensions, wrenches): (&[CablePartials], &[ParallelTension], &DMat),
        rule: &TensionRule,
    ) -> Result<Self, GradientError> {
        // Limits and size of the tensions.
        let ranges = (0..equilibrium.cables.len()).map(|i| range_of(robot, equilibrium, i)).collect();
        let size = equilibrium.cables.iter().fold(0.0, |most: f64, state| most.max(state.tension_platform));

        // Wrenches with held exit points.
        let mut held_wrenches = wrenches.clone();
        for (i, state) in equilibrium.cables.iter().enumerate().filter(|(_, state)| state.drive.is_some()) {
            let per_tension = ForceByTension::of(state)?;
            let column = coordinates.reduce_force(&per_tension.force_w(), &state.lever_w);
            (0..coordinates.count()).for_each(|k| held_wrenches[(k, i)] = column[k]);
        }

        let conditions = RuleConditions {
            robot,
            equilibrium,
            coordinates,
            partials,
            tensions,
            wrenches,
            held_wrenches,
            ranges,
            size,
        };
        match rule {
            TensionRule::Lowest => conditions.nearest(rule, None),
            TensionRule::Closest(target) => conditions.nearest(rule, Some(target)),
            TensionRule::Middle => conditions.middle(rule),
            TensionRule::Stiffest => Err(GradientError::Stiffest),
        }
    }

    /// Adds multiples of the conditions, so that the given coefficients of the parallel tensions become zero. Returns
    /// the multiplier of the balance that has to be added, reduced.
    pub(super) fn follow(&self, total: &mut Adjoint<f64>, of_tensions: &DMat) -> Vec6 {
        let multipliers = &self.solution * of_tensions;
        let n = self.degrees_of_freedom;
        for (condition, multiplier) in self.conditions.iter().zip(multipliers.iter().skip(n)) {
            let factor = -multiplier;
            add_cable(&mut total.cables[condition.cable], &condition.coefficients, factor);
            total.mass += condition.mass * factor;
            add_real(&mut total.gravity, condition.gravity_w * factor);
        }
        Vec6::from_fn(|k, _| if k < n { -multipliers[(k, 0)] } else { 0.0 })
    }
}

impl RuleFollower {
    /// Solution for coefficients of the tensions of this number of cables alone, without the further unknowns.
    fn of_tensions(self, cables: usize) -> Self {
        let solution = self.solution.columns(0, cables).into_owned();
        Self { solution, ..self }
    }
}

impl RuleConditions<'_> {
    fn state(&self, i: usize) -> &CableState {
        &self.equilibrium.cables[i]
    }

    /// Conditions of the tensions nearest to a target, or to their minima.
    fn nearest(&self, rule: &TensionRule, target: Option<&Vec<f64>>) -> Result<RuleFollower, GradientError> {
        let (cables, n) = (self.tensions.len(), self.coordinates.count());
        let wanted = |i: usize| match target {
            Some(target) => target[i % target.len()],
            None => self.ranges[i].minimum + self.below_span(i),
        };
        let held: Vec<Option<TensionBound>> = (0..cables).map(|i| self.reached(i)).collect();
        let free: Vec<usize> = (0..cables).filter(|i| held[*i].is_none()).collect();
        if free.len() < n {
            return Err(self.one_sided(rule, held.iter().position(Option::is_some).unwrap_or(0), &held));
        }

        // Multipliers of the balance, by least squares over the cables between their limits.
        let columns = DMat::from_fn(free.len(), n, |row, k| self.held_wrenches[(k, free[row])]);
        let excess = |i: usize| self.parallel(i) - wanted(i);
        let right = DMat::from_fn(free.len(), 1, |row, _| excess(free[row]));
        let factors = columns.qr();
        let solved = factors.r().solve_upper_triangular(&(factors.q().transpose() * right));
        let solved = solved.ok_or(StaticDerivativeError::Singular)?;
        let pressure = |i: usize| excess(i) - (0..n).map(|k| self.held_wrenches[(k, i)] * solved[(k, 0)]).sum::<f64>();

        let rounding = AT_LIMIT * self.size;
        for (i, bound) in held.iter().enumerate() {
            let pressure = pressure(i);
            let outwards = match bound {
                None if pressure.abs() <= rounding => continue,
                None => -1.0,
                Some(TensionBound::Maximum) => -pressure,
                Some(_) => pressure,
            };
            if outwards < -rounding {
                return Err(GradientError::NotByRule { rule: rule.name(), cable: self.name(i) });
            }
            if outwards <= rounding {
                return Err(self.one_sided(rule, i, &held));
            }
        }

        // The conditions, each with its cable.
        let reduced = Vec6::from_fn(|k, _| if k < n { solved[(k, 0)] } else { 0.0 });
        let expanded = self.coordinates.expand(&reduced);
        let y_v = Vec3::new(expanded[0], expanded[1], expanded[2]);
        let y_theta = Vec3::new(expanded[3], expanded[4], expanded[5]) / self.coordinates.ell();
        let conditions = (0..cables)
            .map(|i| match held[i] {
                Some(bound) => self.at_bound(i, bound, 1.0, None),
                None => self.stationarity(i, target.is_none(), &y_v, &y_theta),
            })
            .collect::<Result<Vec<_>, _>>()?;
        let found = self.solved(rule, conditions, n, |condition, k| {
            if condition.is_stationarity { -self.held_wrenches[(k, condition.cable)] } else { 0.0 }
        })?;
        Ok(found.of_tensions(cables))
    }

    /// Conditions of the tensions with the maximum distance from the limits.
    fn middle(&self, rule: &TensionRule) -> Result<RuleFollower, GradientError> {
        let (cables, n) = (self.tensions.len(), self.coordinates.count());
        if let Some(i) = self.ranges.iter().position(|range| range.maximum.is_infinite()) {
            return Err(GradientError::NotByRule { rule: rule.name(), cable: self.name(i) });
        }
        let widths: Vec<f64> = self.ranges.iter().map(|range| range.maximum - range.minimum).collect();
        let distances: Vec<[f64; 2]> = (0..cables)
            .map(|i| {
                [
                    self.tension(i, TensionBound::Minimum) - self.ranges[i].minimum,
                    self.ranges[i].maximum - self.tension(i, TensionBound::Maximum),
                ]
            })
            .collect();
        let smallest = distances.iter().zip(&widths).flat_map(|(d, width)| d.map(|d| d / width));
        let smallest = smallest.fold(f64::INFINITY, f64::min);

        let mut conditions = Vec::new();
        for i in 0..cables {
            for (bound, sign, distance) in
                [(TensionBound::Minimum, 1.0, distances[i][0]), (TensionBound::Maximum, -1.0, distances[i][1])]
            {
                if distance - smallest * widths[i] <= AT_LIMIT * self.size {
                    conditions.push(self.at_bound(i, bound, sign, Some((smallest, widths[i])))?);
                }
            }
        }
        if let Some(i) = (0..cables).find(|&i| self.reached(i) == Some(TensionBound::Slackest)) {
            return Err(self.one_sided(rule, i, &[]));
        }

        // A corner: as many cables at the smallest distance as there are unknowns beyond the balance.
        if conditions.len() != cables + 1 - n {
            return Err(self.one_sided(rule, conditions.first().map_or(0, |condition| condition.cable), &[]));
        }
        let cables_held: Vec<usize> = conditions.iter().map(|condition| condition.cable).collect();
        let found = self.solved(rule, conditions, 1, |condition, _| condition.distance)?;

        // Multipliers of the distance itself; all have to hold it.
        let presses = |k: usize| found.solution[(n + k, cables)];
        let strongest = (0..cables_held.len()).fold(0.0, |most: f64, k| most.max(presses(k).abs()));
        for (k, cable) in cables_held.iter().enumerate() {
            let sign = -presses(k);
            if sign < -AT_LIMIT * strongest {
                return Err(GradientError::NotByRule { rule: rule.name(), cable: self.name(*cable) });
            }
            if sign <= AT_LIMIT * strongest {
                return Err(self.one_sided(rule, *cable, &[]));
            }
        }
        Ok(found.of_tensions(cables))
    }

    /// Solves the conditions and the balance for their multipliers. `extra` further unknowns have the coefficients
    /// `by_extra`; in the solution they follow the tensions as columns.
    fn solved(
        &self,
        rule: &TensionRule,
        conditions: Vec<Condition>,
        extra: usize,
        by_extra: impl Fn(&Condition, usize) -> f64,
    ) -> Result<RuleFollower, GradientError> {
        let (cables, n) = (self.tensions.len(), self.coordinates.count());
        let size = cables + extra;
        let mut matrix = DMat::zeros(size, n + conditions.len());
        assert!(matrix.is_square(), "as many multipliers as unknowns");
        for i in 0..cables {
            (0..n).for_each(|k| matrix[(i, k)] = self.wrenches[(k, i)]);
        }
        for (column, condition) in conditions.iter().enumerate() {
            let (i, column) = (condition.cable, n + column);
            matrix[(i, column)] = self.by_tension(i, &condition.coefficients);
            for k in 0..extra {
                matrix[(cables + k, column)] = by_extra(condition, k);
            }
        }

        let factors = matrix.full_piv_lu();
        let pivots = factors.u().diagonal().map(f64::abs);
        if pivots.min().is_nan() || pivots.min() <= MIN_PIVOT_RATIO * pivots.max() {
            return Err(self.one_sided(rule, conditions.first().map_or(0, |condition| condition.cable), &[]));
        }
        let inverse = factors.try_inverse().ok_or(StaticDerivativeError::Singular)?;
        Ok(RuleFollower { solution: inverse, conditions, degrees_of_freedom: n })
    }

    fn name(&self, i: usize) -> String {
        self.robot.cables[i].name.clone()
    }

    /// Error of tensions whose rule has different derivatives on both sides.
    fn one_sided(&self, rule: &TensionRule, i: usize, held: &[Option<TensionBound>]) -> GradientError {
        let limit = match held.get(i).copied().flatten() {
            Some(TensionBound::Maximum) => Some(Limit::Maximum),
            Some(_) => Some(Limit::Minimum),
            None => None,
        };
        GradientError::OneSided { rule: rule.name(), cable: self.name(i), limit }
    }

    /// Parallel tension τ of a cable, (10a) [N].
    fn parallel(&self, i: usize) -> f64 {
        let state = self.state(i);
        state.hanging.as_ref().map_or(state.tension_platform, |hanging| hanging.catenary.parallel_tension())
    }

    /// Minimum or maximum tension in a cable, the drum included [N].
    fn tension(&self, i: usize, bound: TensionBound) -> f64 {
        let (in_span, drum) = (self.tension_in_span(i, bound), self.state(i).tension_drum());
        match bound {
            TensionBound::Minimum => in_span.min(drum),
            TensionBound::Maximum => in_span.max(drum),
            TensionBound::Slackest => in_span,
        }
    }

    /// Minimum or maximum tension in the free span of a cable [N].
    fn tension_in_span(&self, i: usize, bound: TensionBound) -> f64 {
        let state = self.state(i);
        let both =
            state.hanging.as_ref().map(|hanging| [hanging.catenary.min_tension(), hanging.catenary.max_tension()]);
        let [low, high] = both.unwrap_or([state.tension_platform; 2]);
        match bound {
            TensionBound::Minimum => low,
            TensionBound::Maximum => high,
            TensionBound::Slackest => self.parallel(i),
        }
    }

    /// True if a cable has its minimum or maximum tension at its drum.
    fn is_at_drum(&self, i: usize, bound: TensionBound) -> bool {
        let state = self.state(i);
        let (in_span, drum) = (self.tension_in_span(i, bound), state.tension_drum());
        let beyond = match bound {
            TensionBound::Minimum => in_span - drum,
            TensionBound::Maximum => drum - in_span,
            TensionBound::Slackest => 0.0,
        };
        state.drive.is_some() && beyond > DRUM_ROUNDING * drum
    }

    /// Minimum tension in the free span less that in the whole cable [N]: the minimum of the span is higher by it.
    fn below_span(&self, i: usize) -> f64 {
        self.tension_in_span(i, TensionBound::Minimum) - self.tension(i, TensionBound::Minimum)
    }

    /// Limit at which a tension is, within rounding.
    fn reached(&self, i: usize) -> Option<TensionBound> {
        let (range, rounding) = (&self.ranges[i], AT_LIMIT * self.size);
        let state = self.state(i);
        let slackest = Catenary::MIN_TENSION_TO_WEIGHT * load_of(state).norm() * state.chord();
        if self.tension(i, TensionBound::Minimum) <= range.minimum + rounding {
            Some(TensionBound::Minimum)
        } else if self.tension(i, TensionBound::Maximum) >= range.maximum - rounding {
            Some(TensionBound::Maximum)
        } else {
            (self.parallel(i) <= slackest + rounding).then_some(TensionBound::Slackest)
        }
    }

    /// Derivative of a scalar with these coefficients by the parallel tension of cable `i`.
    fn by_tension(&self, i: usize, coefficients: &CableAdjoint<f64>) -> f64 {
        by_length(coefficients, &self.partials[i]) / self.tensions[i].by_length
    }

    /// Tension at a limit: `sign (T − limit)`, less the distance from it in proportion to the width of the limits.
    fn at_bound(
        &self,
        i: usize,
        bound: TensionBound,
        sign: f64,
        distance: Option<(f64, f64)>,
    ) -> Result<Condition, GradientError> {
        let mut condition = Condition::new(i);
        if bound == TensionBound::Slackest {
            let state = self.state(i);
            let (q, d) = (load_of(state), state.chord_w());
            self.tensions[i].add(&mut condition.coefficients, sign);
            let factor = -sign * Catenary::MIN_TENSION_TO_WEIGHT;
            add_real(&mut condition.coefficients.load, q.normalize() * (d.norm() * factor));
            add_real(&mut condition.coefficients.chord, d.normalize() * (q.norm() * factor));
            return Ok(condition);
        }

        self.add_tension(&mut condition.coefficients, i, bound, sign);
        let of_minimum = if bound == TensionBound::Minimum { -sign } else { 0.0 };
        let (by_width, width) = distance.unwrap_or_default();
        self.add_minimum(&mut condition, of_minimum + by_width)?;
        condition.distance = -width;
        Ok(condition)
    }

    /// Stationarity of a tension between its limits: `τ − c − G·y`.
    fn stationarity(
        &self,
        i: usize,
        from_minimum: bool,
        y_v: &Vec3,
        y_theta: &Vec3,
    ) -> Result<Condition, GradientError> {
        let mut condition = Condition { is_stationarity: true, ..Condition::new(i) };
        self.tensions[i].add(&mut condition.coefficients, 1.0);
        if from_minimum {
            self.add_minimum(&mut condition, -1.0)?;
            if self.is_at_drum(i, TensionBound::Minimum) {
                self.add_tension_in_span(&mut condition.coefficients, i, TensionBound::Minimum, -1.0);
                condition.coefficients.end[end::TENSION_DRUM] += 1.0;
            }
        }

        // The force per tension b turns with chord and load; the exit point is held.
        let (state, tension) = (self.state(i), &self.tensions[i]);
        let (q, d) = (load_of(state), state.chord_w());
        let per_tension = ForceByTension::of(state)?;
        let (by_length, by_tension) = (per_tension.by_length_w, per_tension.force_w());
        let along = y_v + y_theta.cross(&state.lever_w);
        let sum = &mut condition.coefficients;
        add_real(&mut sum.lever, -by_tension.cross(y_theta));
        if q == Vec3::zeros() {
            let axis = d.normalize();
            add_real(&mut sum.chord, -(along - axis * axis.dot(&along)) / d.norm());
            return Ok(condition);
        }

        let rate = along.dot(&by_tension);
        let held = (along - tension.force_w * rate) / per_tension.tension_by_length;
        CableForm::of_span(state)?.add_force_by_length(sum, &held, &by_length, &d, -1.0);
        let [by_chord, by_load] = along_coefficients(&d, &q, &(by_tension * rate));
        add_real(&mut sum.chord, by_chord);
        add_real(&mut sum.load, by_load);
        Ok(condition)
    }

    /// Adds `factor` times the coefficients of the minimum or maximum tension in a cable, the drum included.
    fn add_tension(&self, sum: &mut CableAdjoint<f64>, i: usize, bound: TensionBound, factor: f64) {
        if self.is_at_drum(i, bound) {
            sum.end[end::TENSION_DRUM] += factor;
        } else {
            self.add_tension_in_span(sum, i, bound, factor);
        }
    }

    /// Adds `factor` times the coefficients of the minimum or maximum tension in the free span of a cable.
    fn add_tension_in_span(&self, sum: &mut CableAdjoint<f64>, i: usize, bound: TensionBound, factor: f64) {
        let state = self.state(i);
        let (f, q, at_anchor) = (state.force_on_platform_w, load_of(state), force_at_anchor(state));
        let is_sagging = q != Vec3::zeros();
        let lowest_between = is_sagging && f.dot(&q) > 0.0 && at_anchor.dot(&q) < 0.0;
        if bound == TensionBound::Minimum && lowest_between {
            // Horizontal force: f less its part along the load.
            let up = -q.normalize();
            let horizontal = (f - up * f.dot(&up)).normalize();
            add_real(&mut sum.force, horizontal * factor);
            add_real(&mut sum.load, horizontal * (f.dot(&up) / q.norm() * factor));
            return;
        }

        let anchor_is_higher = at_anchor.norm() > f.norm();
        if is_sagging && anchor_is_higher == (bound == TensionBound::Maximum) {
            let along = at_anchor.normalize();
            add_real(&mut sum.force, along * factor);
            add_real(&mut sum.load, along * (-state.free_length() * factor));
            sum.free_length -= along.dot(&q) * factor;
        } else {
            add_real(&mut sum.force, f.normalize() * factor);
        }
    }

    /// Adds `factor` times the coefficients of the minimum of a cable's tension.
    fn add_minimum(&self, condition: &mut Condition, factor: f64) -> Result<(), GradientError> {
        let (i, robot) = (condition.cable, self.robot);
        let state = self.state(i);
        let d = state.chord_w();

        match MinimumTension::of(robot, i, &d) {
            MinimumTension::Given(_) => {}
            MinimumTension::OfCable { .. } if self.equilibrium.model != StaticModel::Catenary => {
                // Straight cables do not follow their load, but this minimum does.
                if factor != 0.0 {
                    return Err(GradientError::DefaultMinimum { cable: self.name(i) });
                }
            }
            MinimumTension::OfCable { factor: of_load } => {
                let q = load_of(state);
                let factor = factor * of_load;
                add_real(&mut condition.coefficients.load, q.normalize() * (d.norm() * factor));
                add_real(&mut condition.coefficients.chord, d.normalize() * (q.norm() * factor));
            }
            MinimumTension::OfPlatform { factor: of_weight } => {
                let (g, mass, factor) = (robot.gravity_w, robot.platform.mass, factor * of_weight);
                condition.mass += g.norm() * factor;
                condition.gravity_w += g.try_normalize(0.0).unwrap_or_else(Vec3::zeros) * (mass * factor);
            }
        }
        Ok(())
    }
}

/// Limits of cable `i` for the load that it carries.
fn range_of(robot: &Robot, equilibrium: &Equilibrium, i: usize) -> TensionRange {
    let (state, model) = (&equilibrium.cables[i], equilibrium.model);
    let chord_w = state.chord_w();
    let mut range = TensionRange::of(robot, i, &chord_w);
    // The drag over a pulley is that of a straight cable.
    if let (MinimumTension::OfCable { factor }, StaticModel::Catenary) = (MinimumTension::of(robot, i, &chord_w), model)
    {
        range.minimum = factor * load_of(state).norm() * chord_w.norm();
    }
    range
}

/// Force of a free span on the platform by its parallel tension, both ends held: `(∂f/∂S)/(∂τ/∂S)`.
struct ForceByTension {
    by_length_w: Vec3,
    tension_by_length: f64,
}

impl ForceByTension {
    fn of(state: &CableState) -> Result<Self, GradientError> {
        let span = state.hanging.as_ref().ok_or(StaticDerivativeError::Ideal)?;
        let tension_by_length = span.catenary.parallel_tension_by_length();
        Ok(Self { by_length_w: span.force_by_length_w(), tension_by_length })
    }

    fn force_w(&self) -> Vec3 {
        self.by_length_w / self.tension_by_length
    }
}

impl Condition {
    fn new(cable: usize) -> Self {
        Self {
            cable,
            coefficients: CableAdjoint::default(),
            mass: 0.0,
            gravity_w: Vec3::zeros(),
            distance: 0.0,
            is_stationarity: false,
        }
    }
}

/// Coefficients over chord and load of `x·e`, where `e = h/cos α = P d |d|/|P d|²` is the derivative of the parallel
/// tension by the force, P the projection on the plane across the load, and `x` is held.
fn along_coefficients(d: &Vec3, q: &Vec3, x: &Vec3) -> [Vec3; 2] {
    let up = -q.normalize();
    let across = |v: &Vec3| v - up * up.dot(v);
    let span = across(d);
    let (l, square) = (d.norm(), span.norm_squared());
    let product = x.dot(&span);
    let by_span = (x - span * (2.0 * product / square)) * (l / square);
    let by_chord = across(&by_span) + d * (product / (square * l));
    let by_up = -(by_span * up.dot(d) + d * up.dot(&by_span));
    [by_chord, -across(&by_up) / q.norm()]
}

/// Adds `factor` times the coefficients of a cable to others.
fn add_cable(sum: &mut CableAdjoint<f64>, of: &CableAdjoint<f64>, factor: f64) {
    let vectors = [
        (&mut sum.force, &of.force),
        (&mut sum.lever, &of.lever),
        (&mut sum.chord, &of.chord),
        (&mut sum.load, &of.load),
    ];
    for (sum, of) in vectors {
        add_times(sum, of, factor);
    }
    sum.end.iter_mut().zip(of.end).for_each(|(sum, of)| *sum += of * factor);
    sum.length += of.length * factor;
    sum.free_length += of.free_length * factor;
    sum.stiffness += of.stiffness * factor;
    assert!(of.mass == 0.0 && of.damping == 0.0, "conditions of rest have no inertia");
}

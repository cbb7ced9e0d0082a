//! Tensions that follow the rule of their distribution while the pose is held.
//!
//! The tensions of more cables than degrees of freedom solve a small problem with constraints (docs/theory.md,
//! equations (38) and (39)). Its optimality conditions hold for the changed robot as well, with equations for the
//! limits that are reached: each condition is a scalar that stays zero. Multiples of these scalars are added to the
//! differential of a result, so that the coefficients of all tensions become zero (equations (60r) to (60t)). Over
//! pulleys the distribution holds the exit points while it chooses the tensions: its conditions contain the free span,
//! while the balance contains the whole cable (equations (60t2) and (60t3)).

use super::GradientError;
use super::adjoint::Adjoint;
use super::at_limits::{AT_LIMIT, Condition, TensionBound, TensionsAtLimits};
use super::cable_form::CableForm;
use super::centre::add_limit;
use super::scalar::add_real;
use crate::drive::derivatives::{end, place};
use crate::math::{DMat, Vec3, Vec6};
use crate::platform::Coordinates;
use crate::statics::derivatives::{StaticDerivativeError, load_of};
use crate::statics::{CableState, Limit, TauLimit, TensionCurve, TensionRule};

/// Minimum ratio of a pivot to the largest one; below it the conditions are singular and do not determine the tensions.
/// Rounding leaves 1e-15 times the number of cables.
const MIN_PIVOT_RATIO: f64 = 1e-11;

/// Optimality conditions of the tensions, solved for their multipliers.
pub(super) struct RuleFollower {
    /// Multipliers of the balance, then of the conditions, from the coefficients of the parallel tensions.
    solution: DMat,
    conditions: Vec<Condition>,
    degrees_of_freedom: usize,
}

/// Derivatives of the two logarithms of a tension by τ.
struct Barrier {
    slope: f64,
    /// Second derivatives of the one of the minimum and of that of the maximum.
    curvatures: [f64; 2],
}

impl Barrier {
    fn curvature(&self) -> f64 {
        self.curvatures[0] + self.curvatures[1]
    }
}

/// Equilibrium with the quantities that stand in the conditions.
struct RuleConditions<'a> {
    at: TensionsAtLimits<'a>,
    coordinates: &'a Coordinates,
    /// Wrenches per parallel tension, reduced; one column per cable.
    wrenches: &'a DMat,
    /// Wrenches per parallel tension with held exit points, reduced; the distribution uses these.
    held_wrenches: DMat,
}

impl RuleFollower {
    pub(super) fn new(
        at: TensionsAtLimits<'_>,
        coordinates: &Coordinates,
        wrenches: &DMat,
        rule: &TensionRule,
    ) -> Result<Self, GradientError> {
        // Wrenches with held exit points.
        let mut held_wrenches = wrenches.clone();
        for (i, state) in at.equilibrium.cables.iter().enumerate().filter(|(_, state)| state.drive.is_some()) {
            let per_tension = ForceByTension::of(state)?;
            let column = coordinates.reduce_force(&per_tension.force_w(), &state.lever_w);
            (0..coordinates.count()).for_each(|k| held_wrenches[(k, i)] = column[k]);
        }

        let conditions = RuleConditions { at, coordinates, wrenches, held_wrenches };
        match rule {
            TensionRule::Lowest => conditions.nearest(rule, None),
            TensionRule::Closest(target) => conditions.nearest(rule, Some(target)),
            TensionRule::Middle => conditions.middle(rule),
            TensionRule::Centre => conditions.centre(rule),
            TensionRule::Stiffest => Err(GradientError::Stiffest),
        }
    }

    /// Adds multiples of the conditions, so that the given coefficients of the parallel tensions become zero. Returns
    /// the multiplier of the balance that has to be added, reduced.
    pub(super) fn follow(&self, total: &mut Adjoint<f64>, of_tensions: &DMat) -> Vec6 {
        let multipliers = &self.solution * of_tensions;
        let n = self.degrees_of_freedom;
        for (condition, multiplier) in self.conditions.iter().zip(multipliers.iter().skip(n)) {
            condition.add(total, -multiplier);
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
    /// Conditions of the tensions nearest to a target, or to their minima.
    fn nearest(&self, rule: &TensionRule, target: Option<&Vec<f64>>) -> Result<RuleFollower, GradientError> {
        let (cables, n) = (self.at.tensions.len(), self.coordinates.count());
        let wanted = |i: usize| match target {
            Some(target) => target[i % target.len()],
            None => self.at.ranges[i].minimum + self.at.below_span(i),
        };
        let held: Vec<Option<TensionBound>> = (0..cables).map(|i| self.at.reached(i)).collect();
        let free: Vec<usize> = (0..cables).filter(|i| held[*i].is_none()).collect();
        if free.len() < n {
            return Err(self.one_sided(rule, held.iter().position(Option::is_some).unwrap_or(0), &held));
        }

        // Multipliers of the balance, by least squares over the cables between their limits.
        let columns = DMat::from_fn(free.len(), n, |row, k| self.held_wrenches[(k, free[row])]);
        let excess = |i: usize| self.at.parallel(i) - wanted(i);
        let right = DMat::from_fn(free.len(), 1, |row, _| excess(free[row]));
        let factors = columns.qr();
        let solved = factors.r().solve_upper_triangular(&(factors.q().transpose() * right));
        let solved = solved.ok_or(StaticDerivativeError::Singular)?;
        let pressure = |i: usize| excess(i) - (0..n).map(|k| self.held_wrenches[(k, i)] * solved[(k, 0)]).sum::<f64>();

        let rounding = self.at.rounding();
        for (i, bound) in held.iter().enumerate() {
            let pressure = pressure(i);
            let outwards = match bound {
                None if pressure.abs() <= rounding => continue,
                None => -1.0,
                Some(TensionBound::Maximum) => -pressure,
                Some(_) => pressure,
            };
            if outwards < -rounding {
                return Err(GradientError::NotByRule { rule: rule.name(), cable: self.at.name(i) });
            }
            if outwards <= rounding {
                return Err(self.one_sided(rule, i, &held));
            }
        }

        // The conditions, each with its cable.
        let (y_v, y_theta) = self.expanded(&solved);
        let conditions = (0..cables)
            .map(|i| match held[i] {
                Some(bound) => self.at.at_bound(i, bound, 1.0, None),
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
        let (cables, n) = (self.at.tensions.len(), self.coordinates.count());
        if let Some(i) = self.at.ranges.iter().position(|range| range.maximum.is_infinite()) {
            return Err(GradientError::NotByRule { rule: rule.name(), cable: self.at.name(i) });
        }
        let widths: Vec<f64> = self.at.ranges.iter().map(|range| range.maximum - range.minimum).collect();
        let distances: Vec<[f64; 2]> = (0..cables)
            .map(|i| {
                [
                    self.at.tension(i, TensionBound::Minimum) - self.at.ranges[i].minimum,
                    self.at.ranges[i].maximum - self.at.tension(i, TensionBound::Maximum),
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
                if distance - smallest * widths[i] <= self.at.rounding() {
                    conditions.push(self.at.at_bound(i, bound, sign, Some((smallest, widths[i])))?);
                }
            }
        }
        if let Some(i) = (0..cables).find(|&i| self.at.reached(i) == Some(TensionBound::Slackest)) {
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
                return Err(GradientError::NotByRule { rule: rule.name(), cable: self.at.name(*cable) });
            }
            if sign <= AT_LIMIT * strongest {
                return Err(self.one_sided(rule, *cable, &[]));
            }
        }
        Ok(found.of_tensions(cables))
    }

    /// Conditions of the centre of the tensions: `φ' − G·y`, over φ''. The exit point follows in G and in its change.
    fn centre(&self, rule: &TensionRule) -> Result<RuleFollower, GradientError> {
        let (cables, n) = (self.at.tensions.len(), self.coordinates.count());
        let not_by_rule = |i: usize| GradientError::NotByRule { rule: rule.name(), cable: self.at.name(i) };
        if let Some(i) = self.at.ranges.iter().position(|range| range.maximum.is_infinite()) {
            return Err(not_by_rule(i));
        }
        let limits: Vec<[TauLimit<'_>; 2]> = (0..cables)
            .map(|i| TensionCurve::of_state(self.at.robot, i, self.at.state(i)).map(|curve| curve.limits()))
            .collect::<Option<_>>()
            .ok_or(StaticDerivativeError::Ideal)?;

        // First and second derivatives of the logarithms.
        let mut barriers = Vec::with_capacity(cables);
        for (i, [lower, upper]) in limits.iter().enumerate() {
            let [below, above] = [self.at.parallel(i) - lower.curve.tau(), upper.curve.tau() - self.at.parallel(i)];
            if below.min(above).is_nan() || below.min(above) <= 0.0 {
                return Err(not_by_rule(i));
            }
            let curvatures = [(below * below).recip(), (above * above).recip()];
            barriers.push(Barrier { slope: above.recip() - below.recip(), curvatures });
        }

        // Multipliers of the balance, by least squares with the metric of the logarithms.
        let root = |i: usize| barriers[i].curvature().sqrt().recip();
        let columns = DMat::from_fn(cables, n, |i, k| self.wrenches[(k, i)] * root(i));
        let right = DMat::from_fn(cables, 1, |i, _| barriers[i].slope * root(i));
        let factors = columns.qr();
        let solved = factors.r().solve_upper_triangular(&(factors.q().transpose() * right));
        let solved = solved.ok_or(StaticDerivativeError::Singular)?;
        for (i, barrier) in barriers.iter().enumerate() {
            let residual = barrier.slope - (0..n).map(|k| self.wrenches[(k, i)] * solved[(k, 0)]).sum::<f64>();
            if residual.is_nan() || residual.abs() > self.at.rounding() * barrier.curvature() {
                return Err(not_by_rule(i));
            }
        }

        let (y_v, y_theta) = self.expanded(&solved);
        let conditions = (0..cables)
            .map(|i| {
                let share = barriers[i].curvature().recip();
                let mut condition = self.of_centre(i, &(y_v * share), &(y_theta * share))?;
                for (limit, curvature) in limits[i].iter().zip(barriers[i].curvatures) {
                    add_limit(&mut condition, &self.at, limit, -curvature * share)?;
                }
                Ok(condition)
            })
            .collect::<Result<Vec<_>, GradientError>>()?;
        let least = barriers.iter().map(Barrier::curvature).fold(f64::INFINITY, f64::min);
        let found = self.solved(rule, conditions, n, |condition, k| {
            -self.wrenches[(k, condition.cable)] * (least / barriers[condition.cable].curvature())
        })?;
        Ok(found.of_tensions(cables))
    }

    /// Stationarity `τ − G·y` whose exit point follows the tension, as in the centre of the tensions.
    fn of_centre(&self, i: usize, y_v: &Vec3, y_theta: &Vec3) -> Result<Condition, GradientError> {
        let (state, tension) = (self.at.state(i), &self.at.tensions[i]);
        let along_w = y_v + y_theta.cross(&state.lever_w);
        let curve = TensionCurve::of_state(self.at.robot, i, state);
        let (Some(second), Some(drive)) =
            (curve.and_then(|curve| curve.second_by_outer(&along_w)), &self.at.partials[i].drive)
        else {
            return self.stationarity(i, false, y_v, y_theta);
        };

        let mut condition = Condition { is_stationarity: true, ..Condition::new(i) };
        let sum = &mut condition.coefficients;
        tension.add(sum, 1.0 - second[place::LENGTH]);
        for (variable, (sum, by)) in sum.outer.iter_mut().zip(second).enumerate() {
            *sum -= if variable == place::LENGTH { 0.0 } else { by };
        }
        let force_w = Vec3::from_fn(|k, _| drive.by_outer.force_w[k][place::LENGTH]) / tension.by_length;
        add_real(&mut sum.lever, -force_w.cross(y_theta));
        Ok(condition)
    }

    /// Multipliers of force and moment by those of the reduced balance.
    fn expanded(&self, reduced: &DMat) -> (Vec3, Vec3) {
        let n = self.coordinates.count();
        let expanded = self.coordinates.expand(&Vec6::from_fn(|k, _| if k < n { reduced[(k, 0)] } else { 0.0 }));
        let of_force = Vec3::new(expanded[0], expanded[1], expanded[2]);
        (of_force, Vec3::new(expanded[3], expanded[4], expanded[5]) / self.coordinates.ell())
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
        let (cables, n) = (self.at.tensions.len(), self.coordinates.count());
        let size = cables + extra;
        let mut matrix = DMat::zeros(size, n + conditions.len());
        assert!(matrix.is_square(), "as many multipliers as unknowns");
        for i in 0..cables {
            (0..n).for_each(|k| matrix[(i, k)] = self.wrenches[(k, i)]);
        }
        for (column, condition) in conditions.iter().enumerate() {
            let (i, column) = (condition.cable, n + column);
            matrix[(i, column)] = self.at.by_tension(i, &condition.coefficients);
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

    /// Error of tensions whose rule has different derivatives on both sides.
    fn one_sided(&self, rule: &TensionRule, i: usize, held: &[Option<TensionBound>]) -> GradientError {
        let limit = match held.get(i).copied().flatten() {
            Some(TensionBound::Maximum) => Some(Limit::Maximum),
            Some(_) => Some(Limit::Minimum),
            None => None,
        };
        GradientError::OneSided { rule: rule.name(), cable: self.at.name(i), limit }
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
        self.at.tensions[i].add(&mut condition.coefficients, 1.0);
        if from_minimum {
            self.at.add_minimum(&mut condition, -1.0)?;
            if self.at.is_at_drum(i, TensionBound::Minimum) {
                self.at.add_tension_in_span(&mut condition.coefficients, i, TensionBound::Minimum, -1.0);
                condition.coefficients.end[end::TENSION_DRUM] += 1.0;
            }
        }

        // The force per tension b turns with chord and load; the exit point is held.
        let (state, tension) = (self.at.state(i), &self.at.tensions[i]);
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

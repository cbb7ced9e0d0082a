//! Limits of tensions as scalars of the state at rest, with their coefficients.

use super::GradientError;
use super::adjoint::{Adjoint, CableAdjoint};
use super::parallel_tension::{ParallelTension, by_length};
use super::scalar::{add_real, add_times};
use crate::catenary::Catenary;
use crate::drive::derivatives::end;
use crate::math::Vec3;
use crate::robot::Robot;
use crate::statics::derivatives::{CablePartials, force_at_anchor, load_of};
use crate::statics::{CableState, Equilibrium, MinimumTension, StaticModel, TensionRange};

/// Relative tolerance, over the maximum tension: a tension this near a limit is at it, and a smaller multiplier is
/// zero. The search for tensions ends when they change by less than 1e-10; over pulleys and for the rule `middle` it
/// keeps a limit to 1e-9. Its results are documented to a millionth.
pub(super) const AT_LIMIT: f64 = 1e-7;

/// Relative distance of the tension at a drum from the tensions in the free span, above which the drum has the minimum
/// or the maximum tension. A weightless cable has the same tension everywhere, but for rounding; the weight of a real
/// one along the height of a wheel is 1e-6 of its tension and more.
const DRUM_ROUNDING: f64 = 1e-13;

/// Optimality condition: a scalar that is zero at the tensions of the rule.
pub(super) struct Condition {
    pub(super) cable: usize,
    pub(super) coefficients: CableAdjoint<f64>,
    /// Coefficients of the mass of the platform and of gravity.
    pub(super) mass: f64,
    pub(super) gravity_w: Vec3,
    /// Coefficient of the relative distance from the limits, which the rule `middle` maximises.
    pub(super) distance: f64,
    /// True for the stationarity of a tension between its limits, which contains the multipliers of the balance.
    pub(super) is_stationarity: bool,
}

/// Limit of a tension, in terms of which conditions are written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum TensionBound {
    /// Minimum tension anywhere in the cable.
    Minimum,
    /// Maximum tension anywhere in the cable.
    Maximum,
    /// Minimum parallel tension of a sagging cable, (37).
    Slackest,
}

/// Equilibrium with the limits of its tensions.
pub(super) struct TensionsAtLimits<'a> {
    pub(super) robot: &'a Robot,
    pub(super) equilibrium: &'a Equilibrium,
    pub(super) partials: &'a [CablePartials],
    /// Parallel tension of each cable.
    pub(super) tensions: &'a [ParallelTension],
    pub(super) ranges: Vec<TensionRange>,
    /// Maximum tension [N].
    size: f64,
}

impl<'a> TensionsAtLimits<'a> {
    pub(super) fn new(
        robot: &'a Robot,
        equilibrium: &'a Equilibrium,
        partials: &'a [CablePartials],
        tensions: &'a [ParallelTension],
    ) -> Self {
        let ranges = (0..equilibrium.cables.len()).map(|i| range_of(robot, equilibrium, i)).collect();
        let size = equilibrium.cables.iter().fold(0.0, |most: f64, state| most.max(state.tension_platform));
        Self { robot, equilibrium, partials, tensions, ranges, size }
    }

    /// Difference of tensions that counts as rounding [N].
    pub(super) fn rounding(&self) -> f64 {
        AT_LIMIT * self.size
    }

    pub(super) fn state(&self, i: usize) -> &CableState {
        &self.equilibrium.cables[i]
    }

    pub(super) fn name(&self, i: usize) -> String {
        self.robot.cables[i].name.clone()
    }

    /// Parallel tension τ of a cable, (10a) [N].
    pub(super) fn parallel(&self, i: usize) -> f64 {
        let state = self.state(i);
        state.hanging.as_ref().map_or(state.tension_platform, |hanging| hanging.catenary.parallel_tension())
    }

    /// Minimum or maximum tension in a cable, the drum included [N].
    pub(super) fn tension(&self, i: usize, bound: TensionBound) -> f64 {
        let (in_span, drum) = (self.tension_in_span(i, bound), self.state(i).tension_drum());
        match bound {
            TensionBound::Minimum => in_span.min(drum),
            TensionBound::Maximum => in_span.max(drum),
            TensionBound::Slackest => in_span,
        }
    }

    /// Minimum or maximum tension in the free span of a cable [N].
    pub(super) fn tension_in_span(&self, i: usize, bound: TensionBound) -> f64 {
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
    pub(super) fn is_at_drum(&self, i: usize, bound: TensionBound) -> bool {
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
    pub(super) fn below_span(&self, i: usize) -> f64 {
        self.tension_in_span(i, TensionBound::Minimum) - self.tension(i, TensionBound::Minimum)
    }

    /// Limit at which a tension is, within rounding.
    pub(super) fn reached(&self, i: usize) -> Option<TensionBound> {
        let (range, rounding) = (&self.ranges[i], self.rounding());
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
    pub(super) fn by_tension(&self, i: usize, coefficients: &CableAdjoint<f64>) -> f64 {
        by_length(coefficients, &self.partials[i]) / self.tensions[i].by_length
    }

    /// Tension at a limit: `sign (T − limit)`, less the distance from it in proportion to the width of the limits.
    pub(super) fn at_bound(
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

    /// Adds `factor` times the coefficients of the minimum or maximum tension in a cable, the drum included.
    fn add_tension(&self, sum: &mut CableAdjoint<f64>, i: usize, bound: TensionBound, factor: f64) {
        if self.is_at_drum(i, bound) {
            sum.end[end::TENSION_DRUM] += factor;
        } else {
            self.add_tension_in_span(sum, i, bound, factor);
        }
    }

    /// Adds `factor` times the coefficients of the minimum or maximum tension in the free span of a cable.
    pub(super) fn add_tension_in_span(&self, sum: &mut CableAdjoint<f64>, i: usize, bound: TensionBound, factor: f64) {
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
    pub(super) fn add_minimum(&self, condition: &mut Condition, factor: f64) -> Result<(), GradientError> {
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

impl Condition {
    pub(super) fn new(cable: usize) -> Self {
        Self {
            cable,
            coefficients: CableAdjoint::default(),
            mass: 0.0,
            gravity_w: Vec3::zeros(),
            distance: 0.0,
            is_stationarity: false,
        }
    }

    /// Adds `factor` times the coefficients of this condition to others.
    pub(super) fn add(&self, total: &mut Adjoint<f64>, factor: f64) {
        add_cable(&mut total.cables[self.cable], &self.coefficients, factor);
        total.mass += self.mass * factor;
        add_real(&mut total.gravity, self.gravity_w * factor);
    }
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
    sum.outer.iter_mut().zip(of.outer).for_each(|(sum, of)| *sum += of * factor);
    sum.length += of.length * factor;
    sum.free_length += of.free_length * factor;
    sum.stiffness += of.stiffness * factor;
    assert!(of.mass == 0.0 && of.damping == 0.0, "conditions of rest have no inertia");
}

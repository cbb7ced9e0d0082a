//! Limits of tensions and lengths in the search for the nearest pose.

use crate::math::active_set::Polyhedron;
use crate::math::{DMat, Vec3, Vec6};
use crate::platform::{Coordinates, load_size};
use crate::robot::Robot;
use crate::statics::equilibrium::{CableState, Equilibrium};
use crate::statics::error::StaticsError;
use crate::statics::limits::{Limit, TensionMargin, TensionRange};
use crate::statics::loaded_cable::MAX_LENGTH_RATIO;

/// Maximum ratio of a cable's length to its chord that the search keeps where it can. A level cable then sags by a
/// third of its chord. Without it the search would lengthen a cable by kilometres and use the loop as a weight.
const WANTED_LENGTH_RATIO: f64 = 1.25;

/// Violation of a limit, relative to it, that the end of the search may leave: rounding, some decades below the six
/// digits to which a limit counts as reached.
const ROUNDING: f64 = 1e-8;

/// Size of a slope, per metre, below which a step cannot change the value that is limited.
const NO_SLOPE: f64 = 1e-9;

/// Maximum component of a step, in metres, if no step keeps all limits.
const LONGEST: f64 = 1e3;

/// Limit about an equilibrium: `value + slope · z` is not negative for a step with the components z.
pub(super) struct Bound {
    /// Distance from the limit, relative: tensions over the size of limit and load, lengths over the chord.
    pub(super) value: f64,
    pub(super) slope: Vec<f64>,
}

/// Largest relative violation.
pub(super) fn excess(bounds: &[Bound]) -> f64 {
    bounds.iter().fold(0.0, |most: f64, bound| most.max(-bound.value))
}

/// Tension limits that are given for cable `i`, as distances; infinite without limits.
fn given(robot: &Robot, i: usize, state: &CableState) -> TensionMargin {
    let limits = robot.cables[i].limits();
    let range = TensionRange {
        minimum: limits.minimum.unwrap_or(f64::NEG_INFINITY),
        maximum: limits.maximum.unwrap_or(f64::INFINITY),
    };
    range.margin(state)
}

/// Rates of a cable along a direction: of its chord, its length and the forces at its ends.
struct RatesAlong {
    chord: f64,
    length: f64,
    force_w: Vec3,
    anchor_force_w: Vec3,
}

/// Limits of all cables about an equilibrium, for the directions of a surface and the changes of length in each.
pub(super) fn about(robot: &Robot, here: &Equilibrium, directions: &[Vec6], lengths: &[Vec<f64>]) -> Vec<Bound> {
    let coordinates = Coordinates::of(robot);
    let mut bounds = Vec::new();
    for (i, state) in here.cables.iter().enumerate() {
        let (Some(span), Some(tangent_w), Some(by_length_w)) =
            (&state.hanging, state.tangent_w(), state.force_by_length_w())
        else {
            continue;
        };
        let TensionMargin { range, min, max } = given(robot, i, state);
        let (chord_w, weight_w) = (state.chord_w(), span.load_w());
        let (force_w, free) = (state.force_on_platform_w, state.free_length());
        let anchor_w = force_w - weight_w * free;

        let rates_along = |(direction, lengths): (&Vec6, &Vec<f64>)| {
            let motion = coordinates.expand(direction);
            let turn: Vec3 = Vec3::new(motion[3], motion[4], motion[5]) / coordinates.ell();
            let moved = Vec3::new(motion[0], motion[1], motion[2]) + turn.cross(&state.lever_w);
            let force_w = by_length_w * lengths[i] - tangent_w * moved;
            let chord = -chord_w.dot(&moved) / chord_w.norm();
            RatesAlong { chord, length: lengths[i], force_w, anchor_force_w: force_w - weight_w * lengths[i] }
        };
        let rates: Vec<RatesAlong> = directions.iter().zip(lengths).map(rates_along).collect();
        let of_end = |end_w: &Vec3, at_anchor: bool, factor: f64| -> Vec<f64> {
            let unit = end_w.try_normalize(0.0).unwrap_or_else(Vec3::zeros) * factor;
            rates.iter().map(|of| unit.dot(if at_anchor { &of.anchor_force_w } else { &of.force_w })).collect()
        };

        // Where the tension is lowest and highest; the drum follows the anchor.
        let drum = state.tension_drum() / state.tension_anchor.max(f64::MIN_POSITIVE);
        let is_at_drum = |value: f64| (value - state.tension_drum()).abs() < (value - state.tension_anchor).abs();
        let end = |is_beyond: bool, value: f64| match (is_beyond, is_at_drum(value)) {
            (false, _) => of_end(&force_w, false, 1.0),
            (true, false) => of_end(&anchor_w, true, 1.0),
            (true, true) => of_end(&anchor_w, true, drum),
        };
        let reference = load_size(robot).max(f64::MIN_POSITIVE);
        if range.minimum.is_finite() {
            let ends = state.tension_platform.min(state.tension_anchor).min(state.tension_drum());
            let slope = if min < ends {
                // The lowest point is between the ends.
                let up = span.axes_w().1;
                of_end(&(force_w - up * up.dot(&force_w)), false, 1.0)
            } else {
                end(min < state.tension_platform, min)
            };
            let size = reference.max(range.minimum);
            let slope = slope.iter().map(|slope| slope / size).collect();
            bounds.push(Bound { value: (min - range.minimum) / size, slope });
        }
        if range.maximum.is_finite() {
            let size = reference.max(range.maximum);
            let slope = end(max > state.tension_platform, max).iter().map(|slope| -slope / size).collect();
            bounds.push(Bound { value: (range.maximum - max) / size, slope });
        }
        if weight_w != Vec3::zeros() {
            let chord = chord_w.norm();
            let slope = rates.iter().map(|of| (WANTED_LENGTH_RATIO * of.chord - of.length) / chord).collect();
            bounds.push(Bound { value: WANTED_LENGTH_RATIO - free / chord, slope });
        }
    }
    bounds
}

/// Quadratic problem `½ zᵀ M z − right · z` of a step.
pub(super) struct Quadratic {
    pub(super) matrix: DMat,
    pub(super) right: Vec<f64>,
}

impl Quadratic {
    /// Best components z within limits, and the multiplier of each limit. Of a violated limit, this part of the
    /// violation is removed. If no step does that, the violations are reduced as far as the limits allow.
    pub(super) fn within(&self, bounds: &[Bound], part: f64) -> Option<(Vec<f64>, Vec<f64>)> {
        let r = self.right.len();
        if r == 0 {
            return Some((Vec::new(), vec![0.0; bounds.len()]));
        }

        // In the coordinates y = Lᵀ z of M = L Lᵀ the best step is the point nearest to L⁻¹ right.
        let factor = self.matrix.clone().cholesky()?.l();
        let start = factor.solve_lower_triangular(&DMat::from_column_slice(r, 1, &self.right))?;
        let mut rows: Vec<(usize, Vec<f64>, f64, f64)> = Vec::new();
        for (i, bound) in bounds.iter().enumerate() {
            let normal = factor.solve_lower_triangular(&DMat::from_column_slice(r, 1, &bound.slope))?;
            let size = normal.norm();
            if size > NO_SLOPE {
                let value = if bound.value < 0.0 { part * bound.value } else { bound.value };
                rows.push((i, normal.iter().map(|x| x / size).collect(), -value / size, size));
            }
        }

        let nearest = |relaxed: f64| {
            let mut set = Polyhedron::new(r);
            for (_, normal, level, _) in &rows {
                set.add(normal.iter(), 1.0, None, level - relaxed);
            }
            let mut point: Vec<f64> = start.iter().copied().collect();
            set.nearest(&mut point, 0.0).map(|held| (point, held))
        };
        let (point, held) = match nearest(0.0) {
            Some(found) => found,
            None => nearest(self.violation(&rows)?)?,
        };

        let mut pressure = vec![0.0; bounds.len()];
        for held in &held {
            pressure[rows[held.row].0] += held.multiplier / rows[held.row].3;
        }
        let parts = factor.transpose().solve_upper_triangular(&DMat::from_column_slice(r, 1, &point))?;
        Some((parts.iter().copied().collect(), pressure))
    }

    /// Smallest amount by which all limits have to be moved for a step within them to exist.
    fn violation(&self, rows: &[(usize, Vec<f64>, f64, f64)]) -> Option<f64> {
        let r = self.right.len();
        let mut set = Polyhedron::new(r + 1);
        for (_, normal, level, _) in rows {
            set.add(normal.iter(), 1.0, Some(-1.0), *level);
        }
        for k in 0..r {
            let unit: Vec<f64> = (0..r).map(|j| if j == k { 1.0 } else { 0.0 }).collect();
            set.add(unit.iter(), 1.0, Some(0.0), -LONGEST);
            set.add(unit.iter(), -1.0, Some(0.0), -LONGEST);
        }
        set.add([0.0].iter().cycle().take(r), 1.0, Some(-1.0), 0.0);
        let mut point = vec![0.0; r + 1];
        set.highest(&mut point, 0.0)?;
        let height = point.last().copied()?;
        Some(-height * (1.0 + ROUNDING) + ROUNDING * ROUNDING)
    }
}

/// Refuses an equilibrium beyond a given tension limit, or with a cable so long that only its weight holds the
/// platform.
pub(super) fn check(robot: &Robot, here: &Equilibrium) -> Result<(), StaticsError> {
    let p = here.pose.position_w;
    for (i, (cable, state)) in robot.cables.iter().zip(&here.cables).enumerate() {
        let TensionMargin { range, min, max } = given(robot, i, state);
        let reference = load_size(robot);
        let below = min < range.minimum - ROUNDING * reference.max(range.minimum);
        let above = max > range.maximum + ROUNDING * reference.max(range.maximum);
        let beyond = if below { Some((Limit::Minimum, min)) } else { above.then_some((Limit::Maximum, max)) };
        if let Some((limit, tension)) = beyond {
            let value = if limit == Limit::Minimum { range.minimum } else { range.maximum };
            let cable = cable.name.clone();
            return Err(StaticsError::NearestBeyondLimits { cable, limit, tension, value, x: p.x, y: p.y, z: p.z });
        }

        let (length, chord) = (state.free_length(), state.chord());
        let has_weight = state.hanging.as_ref().is_some_and(|span| span.load_w() != Vec3::zeros());
        if has_weight && length > MAX_LENGTH_RATIO * chord {
            let cable = cable.name.clone();
            return Err(StaticsError::NearestByLoop { cable, length, chord, x: p.x, y: p.y, z: p.z });
        }
    }
    Ok(())
}

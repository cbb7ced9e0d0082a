//! Required wind that loads the cables as well as the platform: each direction has its own shapes of the cables.
//!
//! Equation (40l1) of docs/theory.md.

use super::required_set::RequiredSet;
use super::{LoadCapacity, LoadFactor, unscaled, wind_loads_cables, with_lightest_payload};
use crate::math::{DMat, Vec3, Vec6, any_normal, order};
use crate::platform::{Coordinates, wrench_of};
use crate::robot::{Cable, Pose, RequiredLoads, Robot, Wind};
use crate::statics::error::StaticsError;
use crate::statics::model::StaticModel;
use crate::statics::tension::with_wrench;
use crate::statics::wrench_set::{BulgeSearch, Facet};
use std::borrow::Cow;
use std::f64::consts::TAU;

/// Number of directions in which the worst wind is sought at first. The load factor over the direction is the least of
/// a few smooth curves, one per set of limits, each with one valley.
const DIRECTIONS: usize = 24;

/// Width of the direction of the worst wind [rad]: the load factor is flat there, and known to its square.
const DIRECTION_WIDTH: f64 = 1e-5;

/// Change of the direction of the worst wind [rad] at which a search by parabolas ends, and the maximum number of its
/// steps: a step squares the distance, and 2 or 3 are usual.
const SAME_DIRECTION: f64 = 1e-4;
const MAX_PARABOLAS: usize = 6;

/// Difference between the multiple of the pressure on the cables and the load factor, over the load factor, at which
/// both are equal.
const SAME_MULTIPLE: f64 = 1e-11;

/// Maximum number of pressures tried for one direction, a guard: 3 to 5 are usual.
const MAX_PRESSURES: usize = 60;

/// Verdict at a pose with required wind on the cables: the load factor with the drag of the ropes in a wind of
/// `multiple` of the required pressure. It is on that side of the multiple on which the load factor is, and takes a
/// hundredth of its time: bounds from the facets decide most directions of the wind. `None` without wind on the
/// cables, for which [`load_factor_bounds`](super::load_factor_bounds) is enough.
///
/// # Errors
/// As [`LoadCapacity::at`]; a dead load that is not held, or a wind in which no load is.
///
/// # References
/// docs/theory.md, equation (40l1).
pub fn load_factor_verdict_in_wind(
    robot: &Robot,
    pose: &Pose,
    model: StaticModel,
    multiple: f64,
) -> Result<Option<f64>, StaticsError> {
    if !wind_loads_cables(robot, model) {
        return Ok(None);
    }
    let capacity = LoadCapacity::at(robot, pose, model, None)?;
    capacity.rest.as_ref().map_err(Clone::clone)?;
    capacity.verdict_in_wind(multiple).map(Some)
}

impl<'a> LoadCapacity<'a> {
    /// Load factor with the wind on the cables: the least over all directions of the wind.
    pub(super) fn load_factor_in_wind(&self) -> Result<LoadFactor, StaticsError> {
        self.rest.as_ref().map_err(Clone::clone)?;
        self.in_worst_wind(|wind| self.load_factor_in(wind), |factor| factor.value)
    }

    /// Capacity margin with the wind on the cables [N].
    pub(super) fn margin_in_wind(&self) -> Option<f64> {
        let margin = |wind: &Wind| Ok(self.in_wind(wind, 1.0)?.margin().unwrap_or(f64::NAN));
        self.in_worst_wind(margin, |margin| *margin).ok().filter(|margin| !margin.is_nan())
    }

    /// Load factor with the drag of the ropes in a wind of a multiple of the pressure, as
    /// [`load_factor_verdict_in_wind`].
    fn verdict_in_wind(&self, multiple: f64) -> Result<f64, StaticsError> {
        let horizon = Horizon::of(self.given);
        let in_wind = |velocity_w: Vec3| self.in_wind(&Wind { velocity_w, ..self.given.wind }, multiple);
        let exact = |velocity_w: Vec3| in_wind(velocity_w)?.load_factor_value();

        // Bounds for all directions and for calm air, the lowest first.
        let step = TAU / DIRECTIONS as f64;
        let mut bounded = Vec::with_capacity(DIRECTIONS + 1);
        for k in 0..=DIRECTIONS {
            let angle = (k < DIRECTIONS).then_some(step * k as f64);
            let blown = in_wind(angle.map_or_else(Vec3::zeros, |angle| horizon.wind_w(angle)))?;
            let available = blown.wrenches(BulgeSearch::Bounds);
            let bound = |reach: fn(&Facet) -> f64| blown.smallest(&available, reach);
            bounded.push((angle, bound(|facet| facet.inner).zip(bound(|facet| facet.outer))));
        }
        let lowest = |bounds: &Option<(f64, f64)>| bounds.map_or(f64::NEG_INFINITY, |(lower, _)| lower);
        order::sort_ascending(&mut bounded, |(_, bounds)| lowest(bounds));

        // Bounds on one side of the multiple decide for all directions; the upper one is nearer to the value.
        let bounds: Option<Vec<(f64, f64)>> = bounded.iter().map(|(_, bounds)| *bounds).collect();
        let upper = |angle: f64| {
            let blown = in_wind(horizon.wind_w(angle))?;
            blown.smallest(&blown.wrenches(BulgeSearch::Bounds), |facet| facet.outer).ok_or(StaticsError::NoLoadFactor)
        };
        if let Some(bounds) = bounds {
            let least_upper = bounds.iter().enumerate().min_by(|a, b| a.1.1.total_cmp(&b.1.1));
            let (at, on_grid) = least_upper.map_or((0, f64::INFINITY), |(at, (_, upper))| (at, *upper));
            let least = bounded[at].0.map_or(Ok(on_grid), |angle| lowest_near(angle, step, on_grid, upper))?;
            // The lower bound falls between the directions as the upper one does.
            let between = if on_grid.is_finite() { on_grid - least } else { 0.0 };
            if least < multiple || bounds[0].0 - between >= multiple {
                return Ok(least);
            }
        }

        // Otherwise the load factor itself decides, in the directions that may be the worst.
        let mut worst: Option<(Option<f64>, f64)> = None;
        for (angle, bounds) in &bounded {
            if worst.is_some_and(|(_, least)| lowest(bounds) >= least) {
                break;
            }
            let found = exact(angle.map_or_else(Vec3::zeros, |angle| horizon.wind_w(angle)))?;
            if worst.is_none_or(|(_, least)| found < least) {
                worst = Some((*angle, found));
            }
        }
        let (angle, least) = worst.ok_or(StaticsError::NoLoadFactor)?;
        match angle {
            Some(angle) if least.is_finite() => lowest_near(angle, step, least, |angle| exact(horizon.wind_w(angle))),
            _ => Ok(least),
        }
    }

    /// Load factor in wind from one direction. The pressure on the cables has the multiple of all loads.
    fn load_factor_in(&self, wind: &Wind) -> Result<LoadFactor, StaticsError> {
        let (mut held, mut not_held) = ([0.0, 0.0], f64::INFINITY);
        let mut multiple = 1.0;
        for _ in 0..MAX_PRESSURES {
            let found = match self.in_wind(wind, multiple)?.load_factor() {
                // Too much wind on the cables for any load.
                Err(StaticsError::NoLoadFactor) => None,
                found => Some(found?),
            };

            // End if the wind on the cables is that of the loads.
            let excess = found.as_ref().map_or(f64::NEG_INFINITY, |found| found.value - multiple);
            if let Some(found) = found.filter(|_| excess == f64::INFINITY || excess.abs() <= SAME_MULTIPLE * multiple) {
                return Ok(LoadFactor { lower_bound: None, wind_w: wind.velocity_w, ..found });
            }

            // The load factor changes little with the pressure: secant, or the load factor itself, within the bracket.
            let [before, excess_before] = held;
            let slope = if before > 0.0 { (excess - excess_before) / (multiple - before) } else { -1.0 };
            let next = multiple - excess / slope;
            if excess >= 0.0 {
                held = [multiple, excess];
            } else {
                not_held = multiple;
            }
            let is_between = next > held[0] && next < not_held;
            multiple = if is_between { next } else { 0.5 * (held[0] + not_held.min(2.0 * multiple)) };
        }
        Err(StaticsError::NoLoadFactor)
    }

    /// Least result over all horizontal directions of the required wind, and in calm air.
    fn in_worst_wind<T>(
        &self,
        of: impl Fn(&Wind) -> Result<T, StaticsError>,
        value: impl Fn(&T) -> f64,
    ) -> Result<T, StaticsError> {
        let horizon = Horizon::of(self.given);
        let blowing = |velocity_w: Vec3| of(&Wind { velocity_w, ..self.given.wind });
        let at = |angle: f64| blowing(horizon.wind_w(angle));
        let calm = blowing(Vec3::zeros())?;

        // All directions, …
        let step = TAU / DIRECTIONS as f64;
        let mut worst = (0.0, at(0.0)?);
        for k in 1..DIRECTIONS {
            let (angle, found) = (step * k as f64, at(step * k as f64)?);
            if value(&found) < value(&worst.1) {
                worst = (angle, found);
            }
        }

        // … then those about the worst one, by the golden section.
        const GOLDEN: f64 = 0.618_033_988_749_894_8;
        let [mut low, mut high] = [worst.0 - step, worst.0 + step];
        let inner = [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
        let mut pair = [(inner[0], at(inner[0])?), (inner[1], at(inner[1])?)];
        while high - low > DIRECTION_WIDTH {
            let [a, b] = pair;
            pair = if value(&a.1) < value(&b.1) {
                high = b.0;
                let next = high - GOLDEN * (high - low);
                [(next, at(next)?), a]
            } else {
                low = a.0;
                let next = low + GOLDEN * (high - low);
                [b, (next, at(next)?)]
            };
        }
        let found = pair.into_iter().chain([worst]).map(|(_, found)| found).chain([calm]);
        found.min_by(|a, b| value(a).total_cmp(&value(b))).ok_or(StaticsError::NoLoadFactor)
    }

    /// Capacity in wind from one direction. Its force on the platform is one of the required loads; its drag on the
    /// straight cables, times a multiple, is a part of their loads.
    fn in_wind(&self, wind: &Wind, multiple: f64) -> Result<LoadCapacity<'a>, StaticsError> {
        let (loaded, required) = blown(&self.loaded, &self.pose, wind, multiple);
        LoadCapacity::about(self.given, Cow::Owned(loaded), &self.pose, self.model, (self.rest.clone(), required))
    }
}

/// Robot with the drag of a required wind on its straight cables, times a multiple, and its other required loads with
/// the force of this wind on the platform.
fn blown(robot: &Robot, pose: &Pose, wind: &Wind, multiple: f64) -> (Robot, RequiredSet) {
    let mut loaded = robot.clone();
    for cable in &mut loaded.cables {
        let width = cable.material.drag_width.unwrap_or(0.0) * multiple;
        cable.load_per_length_w += wind.drag_along_w(&cable.chord_w(pose)) * width;
    }
    loaded.required.wind_speed = 0.0;

    let arm_w = pose.rot_wp * loaded.platform.center_of_mass_p;
    let force = wrench_of(&(wind.pressure_w() * loaded.platform.drag_area), &arm_w);
    let mut required = RequiredSet::of(&loaded, pose, &loaded.required);
    required.add_fixed(Coordinates::of(&loaded).reduce(&force));
    (loaded, required)
}

/// Required loads of a robot at a pose, each as a robot that carries it, with its wrench in addition to the dead load,
/// world axes about the platform origin (N, N m). The first is the dead load with the lightest payload; wind comes from
/// [`DIRECTIONS`] sides.
///
/// All corners of the required loads are there. Where there are too many, and where a part of the loads is a ball, the
/// loads are those that straight cables feel most.
pub(crate) fn robots_under_required_loads(robot: &Robot, pose: &Pose) -> Vec<(Robot, Vec6)> {
    let loaded = with_lightest_payload(robot, pose);
    let directions = directions_of_tensions(robot, pose);
    let mut sets = vec![((*loaded).clone(), without_wind(&loaded, pose))];
    if robot.required.wind_speed > 0.0 {
        let horizon = Horizon::of(robot);
        sets.extend((0..DIRECTIONS).map(|k| {
            let velocity_w = horizon.wind_w(TAU * k as f64 / DIRECTIONS as f64);
            blown(&loaded, pose, &Wind { velocity_w, ..robot.wind }, 1.0)
        }));
    }
    let under = |(robot, required): &(Robot, RequiredSet)| {
        let loads = required.extremes(&directions).into_iter().map(|load| unscaled(robot, &load));
        loads.map(|load_w| (with_wrench(robot, pose, &load_w), load_w)).collect::<Vec<_>>()
    };
    sets.iter().flat_map(under).collect()
}

/// Required loads without the wind.
fn without_wind(robot: &Robot, pose: &Pose) -> RequiredSet {
    RequiredSet::of(robot, pose, &RequiredLoads { wind_speed: 0.0, ..robot.required.clone() })
}

/// Directions of loads, reduced, along which the tension of each straight cable rises most.
fn directions_of_tensions(robot: &Robot, pose: &Pose) -> Vec<Vec6> {
    let coordinates = Coordinates::of(robot);
    let column = |cable: &Cable| {
        let force_w = cable.chord_w(pose).try_normalize(0.0).unwrap_or_else(Vec3::zeros);
        coordinates.reduce_force(&force_w, &(pose.rot_wp * cable.attachment_p))
    };
    let columns: Vec<Vec6> = robot.cables.iter().map(column).collect();
    let matrix = DMat::from_fn(6, columns.len(), |i, j| columns[j][i]);
    let least = f64::EPSILON.sqrt() * matrix.norm();
    // The tensions that balance a load are minus this inverse times the load.
    matrix
        .pseudo_inverse(least)
        .map_or(columns, |inverse| inverse.row_iter().map(|row| -Vec6::from_iterator(row.iter().copied())).collect())
}

/// Horizontal directions of the required wind.
struct Horizon {
    along_w: Vec3,
    across_w: Vec3,
    /// Speed of the wind [m/s].
    speed: f64,
}

impl Horizon {
    fn of(robot: &Robot) -> Self {
        let up_w = robot.up_w();
        let along_w = any_normal(&up_w);
        Self { along_w, across_w: up_w.cross(&along_w), speed: robot.required.wind_speed }
    }

    /// Velocity of the wind at an angle.
    fn wind_w(&self, angle: f64) -> Vec3 {
        let (sin, cos) = angle.sin_cos();
        (self.along_w * cos + self.across_w * sin) * self.speed
    }
}

/// Least value of a function of the direction near an angle with its value, lower than a step away, by parabolas.
fn lowest_near(
    angle: f64,
    step: f64,
    at_angle: f64,
    value: impl Fn(f64) -> Result<f64, StaticsError>,
) -> Result<f64, StaticsError> {
    let mut middle = (angle, at_angle);
    let (mut low, mut high) = ((angle - step, value(angle - step)?), (angle + step, value(angle + step)?));
    for _ in 0..MAX_PARABOLAS {
        // Vertex of the parabola through three points, the middle one of which is the lowest.
        let [left, right] = [low, high].map(|(at, value)| (at - middle.0, value - middle.1));
        let bend = right.0 * left.1 - left.0 * right.1;
        let move_by = 0.5 * (right.0 * right.0 * left.1 - left.0 * left.0 * right.1) / bend;
        if !move_by.is_finite() || move_by.abs() < SAME_DIRECTION || move_by <= left.0 || move_by >= right.0 {
            break;
        }
        let next = (middle.0 + move_by, value(middle.0 + move_by)?);
        let is_lower = next.1 < middle.1;
        let (inner, outer) = if is_lower { (next, middle) } else { (middle, next) };
        if outer.0 < inner.0 {
            low = outer;
        } else {
            high = outer;
        }
        middle = inner;
    }
    Ok(middle.1)
}

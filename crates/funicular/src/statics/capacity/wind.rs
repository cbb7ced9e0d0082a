//! Required wind that loads the cables as well as the platform: each direction has its own shapes of the cables.
//!
//! Equation (40l1) of docs/theory.md.

use super::required_set::RequiredSet;
use super::{LoadCapacity, LoadFactor, unscaled, wind_loads_cables, with_lightest_payload};
use crate::math::{DMat, Vec3, Vec6, any_normal};
use crate::platform::{Coordinates, wrench_of};
use crate::robot::{Cable, Pose, RequiredLoads, Robot, Wind};
use crate::statics::error::StaticsError;
use crate::statics::exit_points;
use crate::statics::model::StaticModel;
use crate::statics::tension::with_wrench;
use crate::statics::wrench_set::{BulgeSearch, Facet};
use std::borrow::Cow;
use std::cell::Cell;
use std::f64::consts::TAU;

/// Number of directions in which the worst wind is sought at first. The load factor over the direction is the least of
/// a few smooth curves, one per set of limits, each with one valley.
const DIRECTIONS: usize = 24;

/// Width of the direction of the worst wind [rad]: the load factor is flat there, and known to its square.
const DIRECTION_WIDTH: f64 = 1e-5;

/// Difference between the multiple of the pressure on the cables and the load factor, over the load factor, at which
/// both are equal.
const SAME_MULTIPLE: f64 = 1e-11;

/// Maximum number of pressures tried for one direction, a guard: 3 to 5 are usual.
const MAX_PRESSURES: usize = 60;

/// Bounds of the load factor at a pose with required wind on the cables, as
/// [`load_factor_bounds`](super::load_factor_bounds) for calm ropes: with their drag in a wind of `multiple` of the
/// required pressure, they are on that side of the multiple on which the load factor is. They take a hundredth of the
/// time of the load factor. `None` without wind on the cables, with exit points that move with the tensions, and
/// without facets.
///
/// # Errors
/// As [`LoadCapacity::at`]; a dead load that is not held.
///
/// # References
/// docs/theory.md, equation (40l1).
pub fn load_factor_bounds_in_wind(
    robot: &Robot,
    pose: &Pose,
    model: StaticModel,
    multiple: f64,
) -> Result<Option<[f64; 2]>, StaticsError> {
    if !wind_loads_cables(robot, model) || exit_points::depend_on_tensions(robot, model) {
        return Ok(None);
    }
    let capacity = LoadCapacity::at(robot, pose, model, None)?;
    match capacity.bounds_in_wind(multiple) {
        Err(StaticsError::NoLoadFactor) => Ok(None),
        bounds => bounds.map(Some),
    }
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

    /// Bounds of the load factor from the facets, with the drag of the ropes in a wind of a multiple of the pressure:
    /// they are on that side of the multiple on which the load factor is.
    fn bounds_in_wind(&self, multiple: f64) -> Result<[f64; 2], StaticsError> {
        self.rest.as_ref().map_err(Clone::clone)?;
        let least = Cell::new(f64::INFINITY);
        let upper_in = |wind: &Wind| {
            let blown = self.in_wind(wind, multiple)?;
            let available = blown.wrenches(BulgeSearch::Bounds);
            let bound = |reach: fn(&Facet) -> f64| blown.smallest(&available, reach).ok_or(StaticsError::NoLoadFactor);
            let [lower, upper] = [bound(|facet| facet.inner)?, bound(|facet| facet.outer)?];
            least.set(least.get().min(lower));
            Ok(upper)
        };
        let upper = self.in_worst_wind(upper_in, |upper| *upper)?;
        Ok([least.get(), upper])
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
        let up_w = self.given.up_w();
        let along_w = any_normal(&up_w);
        let across_w = up_w.cross(&along_w);
        let blowing = |velocity_w: Vec3| of(&Wind { velocity_w, ..self.given.wind });
        let at = |angle: f64| {
            let (sin, cos) = angle.sin_cos();
            blowing((along_w * cos + across_w * sin) * self.given.required.wind_speed)
        };
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
        let up_w = robot.up_w();
        let along_w = any_normal(&up_w);
        let across_w = up_w.cross(&along_w);
        sets.extend((0..DIRECTIONS).map(|k| {
            let (sin, cos) = (TAU * k as f64 / DIRECTIONS as f64).sin_cos();
            let velocity_w = (along_w * cos + across_w * sin) * robot.required.wind_speed;
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

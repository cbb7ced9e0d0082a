//! Capacity of a pose: the loads that cables within their limits hold there, compared with the required ones.

mod closure;
mod load_factor;
mod required_set;
mod wind;

pub use closure::{WrenchClosure, wrench_closure};
pub use load_factor::{LoadFactor, load_factor_bounds};
pub use wind::load_factor_verdict_in_wind;
pub(crate) use wind::robots_under_required_loads;

use super::equilibrium::Equilibrium;
use super::error::StaticsError;
use super::exit_points;
use super::limits::LimitViolation;
use super::model::StaticModel;
use super::solve::inverse;
use super::tension::{TensionRule, cables_at, tension_margins, with_weight};
use super::wrench_set::{AvailableWrenches, BulgeSearch, CableAtPose, Facet};
use crate::math::Vec6;
use crate::platform::{Coordinates, load_wrench, wrench_of};
use crate::robot::{Pose, RequiredLoads, RequiredPayload, Robot};
pub(crate) use required_set::LoadCoefficients;
use required_set::RequiredSet;
use std::borrow::Cow;
use std::sync::OnceLock;

/// Violation of a limit by the dead load, over the tension, that counts as rounding: tensions are found to a millionth.
const BEYOND: f64 = 1e-6;

/// Loads that cables within their limits hold at a pose, for comparison with the required loads of the robot.
///
/// # Example
/// ```
/// # use funicular::{math::Vec3, robot::{Pose, Robot}, statics::{LoadCapacity, StaticModel}};
/// let mut robot = Robot::from_toml(funicular_robots::COGIRO)?;
/// robot.required.force_w = Vec3::repeat(150.0); // N, every way along every axis
/// robot.required.moment_w = Vec3::repeat(30.0); // N m
/// let pose = Pose::new([0.0, 0.0, 1.5], [0.0; 3]);
/// let capacity = LoadCapacity::at(&robot, &pose, StaticModel::Catenary, None)?;
/// let factor = capacity.load_factor()?;
/// assert!(factor.value > 1.0 && factor.upper_bound < 1.001 * factor.value);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # References
/// docs/theory.md, equations (40f) to (40n).
pub struct LoadCapacity<'a> {
    given: &'a Robot,
    /// Robot with the lightest payload as a part of its load.
    loaded: Cow<'a, Robot>,
    pose: Pose,
    model: StaticModel,
    /// Dead load held within the limits, or the reason why it is not.
    rest: Result<Equilibrium, StaticsError>,
    /// Cables that leave their pulleys as they do under the dead load.
    cables: Vec<CableAtPose>,
    /// Dead load, reduced [N].
    load: Vec6,
    /// Wrenches of these cables, once they are asked for.
    available: OnceLock<AvailableWrenches>,
    required: RequiredSet,
}

impl<'a> LoadCapacity<'a> {
    /// Capacity at a pose for the required loads of the robot. `start` is an equilibrium of the robot at the pose, if
    /// it is known; it saves time.
    ///
    /// # Errors
    /// [`StaticsError`]: fewer cables than degrees of freedom, a pose that the platform cannot have, coinciding ends,
    /// or limits that exclude each other. A dead load beyond the limits is no error here.
    pub fn at(
        robot: &'a Robot,
        pose: &Pose,
        model: StaticModel,
        start: Option<&Equilibrium>,
    ) -> Result<Self, StaticsError> {
        let loaded = with_lightest_payload(robot, pose);

        // The dead load.
        let start = start.filter(|_| matches!(loaded, Cow::Borrowed(_))).cloned();
        let rest = start.map_or_else(|| inverse(&loaded, pose, model), Ok);
        let rest = rest.and_then(|rest| within_limits(&loaded, rest));

        let required = RequiredSet::of(robot, pose, &robot.required);
        Self::about(robot, loaded, pose, model, (rest, required))
    }

    /// Capacity about a dead load, for required loads.
    fn about(
        given: &'a Robot,
        loaded: Cow<'a, Robot>,
        pose: &Pose,
        model: StaticModel,
        (rest, required): (Result<Equilibrium, StaticsError>, RequiredSet),
    ) -> Result<Self, StaticsError> {
        // The wrenches of cables that leave their pulleys as they do under the dead load.
        let held = match &rest {
            Ok(rest) if exit_points::depend_on_tensions(&loaded, model) => {
                Cow::Owned(exit_points::held_at(&rest.settled(&loaded), pose, &rest.cables))
            }
            _ => Cow::Borrowed(&*loaded),
        };
        let cables = cables_at(&held, pose, model, &TensionRule::Lowest)?;
        let load = Coordinates::of(given).reduce(&load_wrench(&loaded, pose));
        Ok(Self { given, loaded, pose: *pose, model, rest, cables, load, available: OnceLock::new(), required })
    }

    fn robot(&self) -> &Robot {
        &self.loaded
    }

    /// Wrenches that the cables can apply together with the dead load.
    fn available(&self) -> &AvailableWrenches {
        self.available.get_or_init(|| self.wrenches(BulgeSearch::Exact))
    }

    fn wrenches(&self, search: BulgeSearch) -> AvailableWrenches {
        AvailableWrenches::of(self.cables.clone(), &self.load, self.given.platform.motion, search)
    }

    /// Equilibrium with the dead load and the lightest payload.
    ///
    /// # Errors
    /// The reason why the cables do not hold the dead load within their limits.
    pub fn dead_load(&self) -> Result<&Equilibrium, &StaticsError> {
        self.rest.as_ref()
    }

    /// True if the required wind loads the cables.
    pub(crate) fn has_wind_on_cables(&self) -> bool {
        wind_loads_cables(&self.loaded, self.model)
    }

    /// Robot without the lightest payload.
    pub(crate) fn given(&self) -> &'a Robot {
        self.given
    }

    /// Equilibrium with the dead load and the multiple of the load that binds; `None` for an infinite multiple.
    pub(crate) fn at_limit(&self, factor: &LoadFactor) -> Option<Equilibrium> {
        let rest = self.rest.as_ref().ok().filter(|_| factor.value.is_finite())?;
        Some(Equilibrium { cables: factor.cables.clone(), residual: factor.residual, ..rest.clone() })
    }

    /// True if nothing is required but the dead load.
    pub fn requires_nothing(&self) -> bool {
        self.required.is_empty()
    }

    /// Capacity margin [N]: radius of the largest ball of wrenches, moments over ℓ, that the cables hold in addition to
    /// every required load. Negative if a required load is not held; its magnitude is then a lower bound of the
    /// distance. `None` if the cables do not span all degrees of freedom or are too many. Sagging cables count with the
    /// convex hull of their curves, in the directions of the facets of straight ones.
    ///
    /// # References
    /// docs/theory.md, equation (40h).
    pub fn margin(&self) -> Option<f64> {
        let facets = self.available().facets();
        if wind_loads_cables(&self.loaded, self.model) && !facets.is_empty() {
            return self.margin_in_wind();
        }
        let margins = facets.iter().map(|facet| facet.outer - self.required.reach(&-facet.normal));
        self.as_judged(margins.reduce(f64::min)?)
    }

    /// Capacity margin with the sign of the verdict. The hull of sagging cables may contain loads that no tensions
    /// within the limits hold; then the plane at the end of the load that binds is one more facet.
    fn as_judged(&self, margin: f64) -> Option<f64> {
        match &self.rest {
            Err(_) if margin < 0.0 => return Some(margin),
            Err(StaticsError::BeyondLimits(miss)) => return Some(-miss.by),
            Err(_) => return None,
            Ok(_) => {}
        }
        let facets = self.available().facets();
        let inner = facets.iter().map(|facet| facet.inner - self.required.reach(&-facet.normal)).reduce(f64::min);
        let is_clear = inner.is_some_and(|inner| inner >= 0.0) || self.available().is_straight();
        let is_slacker = self.may_be_slacker();
        if is_clear || margin < 0.0 && !is_slacker {
            return Some(margin);
        }
        if self.required.is_empty() {
            return Some(margin).filter(|margin| *margin >= 0.0);
        }
        let held = self.worst_plane().ok()?;
        if held.multiple >= 1.0 {
            // Cables that are slacker than those of the facets hold the loads: no facet tells how much more.
            return Some(margin).filter(|margin| *margin >= 0.0);
        }
        Some(margin.min((held.multiple - 1.0) * held.along))
    }

    /// Largest acceleration in every direction from rest [m/s²], with the dead load alone; angular accelerations count
    /// times ℓ. Infinite without maximum tensions. `None` if the dead load is not held, or as [`Self::margin`].
    ///
    /// # References
    /// docs/theory.md, equation (40o).
    pub fn largest_acceleration(&self) -> Option<f64> {
        let accelerations = RequiredSet::unit_accelerations(&self.loaded, &self.pose);
        let ratio = |facet: &Facet| facet.outer / accelerations.reach(&-facet.normal);
        let smallest = self.available().facets().iter().map(ratio).reduce(f64::min)?;
        (self.rest.is_ok() && smallest >= 0.0).then_some(smallest)
    }

    /// Load in world axes about the platform origin (N, N m) from its reduced wrench.
    fn unscaled(&self, reduced: &Vec6) -> Vec6 {
        unscaled(&self.loaded, reduced)
    }
}

/// Lightest payload and a multiple of a required load of a robot at a pose: everything on the platform besides its own
/// weight, load and wind. World axes about the platform origin (N, N m).
pub(crate) fn required_wrench(robot: &Robot, pose: &Pose, multiple: f64, coefficients: &LoadCoefficients) -> Vec6 {
    let RequiredPayload { min_mass, center_p, .. } = robot.required.payload;
    let lightest = wrench_of(&(robot.gravity_w * min_mass), &(pose.rot_wp * center_p));
    let load = RequiredSet::of(robot, pose, &robot.required).load(coefficients);
    lightest + unscaled(robot, &load) * multiple
}

/// Maximum number of loads of a proof: each takes some 20 µs in every box.
const MAX_PROVED: usize = 1024;

/// Dead load with each of the required loads that all others are combinations of, reduced; `None` for a set without
/// corners or with too many.
pub(crate) fn required_vertices(robot: &Robot, pose: &Pose) -> Option<Vec<Vec6>> {
    let loaded = with_lightest_payload(robot, pose);
    let dead = Coordinates::of(robot).reduce(&load_wrench(&loaded, pose));
    let vertices = RequiredSet::of(robot, pose, &robot.required).vertices()?;
    (vertices.len() <= MAX_PROVED).then(|| vertices.iter().map(|vertex| dead + vertex).collect())
}

/// Wrench in world axes about the platform origin (N, N m) from its reduced one.
fn unscaled(robot: &Robot, reduced: &Vec6) -> Vec6 {
    let coordinates = Coordinates::of(robot);
    let scaled = coordinates.expand(reduced);
    Vec6::from_fn(|i, _| if i < 3 { scaled[i] } else { scaled[i] * coordinates.ell() })
}

/// True if the required wind of a robot changes the loads of its cables.
fn wind_loads_cables(robot: &Robot, model: StaticModel) -> bool {
    let has_drag = |width: Option<f64>| width.is_some_and(|width| width > 0.0);
    model == StaticModel::Catenary
        && robot.required.wind_speed > 0.0
        && robot.cables.iter().any(|cable| has_drag(cable.material.drag_width))
}

/// Robot with the lightest required payload as a part of its load.
fn with_lightest_payload<'a>(robot: &'a Robot, pose: &Pose) -> Cow<'a, Robot> {
    let RequiredLoads { payload: RequiredPayload { min_mass, center_p, .. }, .. } = robot.required;
    if min_mass > 0.0 {
        Cow::Owned(with_weight(robot, pose, &center_p, min_mass * robot.gravity_w.norm()))
    } else {
        Cow::Borrowed(robot)
    }
}

/// True if no tension of an equilibrium is beyond its limits, for a search that ends at one.
fn keeps_limits(robot: &Robot, rest: &Equilibrium) -> bool {
    tension_margins(robot, rest).iter().all(|margin| margin.distance() >= 0.0)
}

/// Equilibrium whose tensions are within their limits, but for [`BEYOND`].
///
/// # Errors
/// [`StaticsError::BeyondLimits`].
fn within_limits(robot: &Robot, rest: Equilibrium) -> Result<Equilibrium, StaticsError> {
    let none = Vec::new;
    let mut miss = LimitViolation { by: 0.0, minimum_of: none(), maximum_of: none(), obstacle: None, missing: None };
    for (i, margin) in tension_margins(robot, &rest).iter().enumerate() {
        let distance = margin.distance();
        if distance >= -BEYOND * margin.max.max(margin.range.minimum) {
            continue;
        }
        miss.by = miss.by.max(-distance);
        let of = if margin.min < margin.range.minimum { &mut miss.minimum_of } else { &mut miss.maximum_of };
        of.push(robot.cables[i].name.clone());
    }
    if miss.by > 0.0 { Err(StaticsError::BeyondLimits(miss)) } else { Ok(rest) }
}

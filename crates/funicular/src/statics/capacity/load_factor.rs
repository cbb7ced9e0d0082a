//! Load factor: the largest multiple of the required loads that the cables hold in every combination.

use super::required_set::{LoadCoefficients, RequiredSet};
use super::{LoadCapacity, keeps_limits, wind_loads_cables, with_lightest_payload};
use crate::math::{Mat6, Vec3, Vec6, order};
use crate::platform::{Coordinates, load_size, load_wrench};
use crate::robot::{Pose, Robot};
use crate::statics::equilibrium::{CableState, Equilibrium};
use crate::statics::error::StaticsError;
use crate::statics::exit_points;
use crate::statics::limits::{Limit, TensionMargin};
use crate::statics::model::StaticModel;
use crate::statics::solve::{has_unique_tensions, inverse};
use crate::statics::tension::{
    LimitAtCable, RaySearch, TensionRule, WrenchRay, cables_at, equilibrium_of, limits_reached, start_from,
};
use crate::statics::wrench_set::{
    AvailableWrenches, BulgeSearch, CableAtPose, Facet, ReachableTensions, WrenchSet, spread_start,
};

/// Gap between a multiple and its upper bound, over the multiple, above which the search begins again elsewhere: the
/// bound itself is exact to about 1e-9.
const OPEN_GAP: f64 = 1e-7;

/// Gaps over the multiple above which the search begins again more often, and the number of starts up to each. The
/// bends of heavy ropes leave gaps of up to 1 % where there is no higher optimum; one that was higher by 1.2e-4 has
/// been met.
const GAPS: [(f64, usize); 3] = [(OPEN_GAP, 1), (1e-5, 5), (0.02, 12)];

/// Maximum number of directions tried from one start in a set without vertices. Each step to the worst load of the last
/// direction gains about two digits; robots of the library take 2 to 5.
const MAX_DIRECTIONS: usize = 30;

/// Change of the worst load, over its size, at which the search for a set without vertices ends.
const SAME_LOAD: f64 = 1e-9;

/// First step of a search along a load beyond the sag of (37), over the multiple, and the number of steps: 30
/// doublings, and as many halvings.
const FIRST_STEP: f64 = 1e-3;
const MAX_STEPS: usize = 90;

/// Largest multiple of the required loads.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadFactor {
    /// Multiple up to which the cables hold all vertices of the required set with tensions within their limits;
    /// infinite if no maximum tension limits it.
    pub value: f64,
    /// Multiple from which on it is proved that no tensions within the limits hold the load that binds; infinite as
    /// `value`.
    pub upper_bound: f64,
    /// Multiple up to which the cables hold all of the set, not only its vertices. It differs from `value` only if
    /// cables sag; `None` if too many cables, supports, pulleys or wind on the cables leave it open.
    pub lower_bound: Option<f64>,
    /// Required wind that binds, if it loads the cables, at the multiple 1 [m/s]; otherwise zero.
    pub wind_w: Vec3,
    /// Load that binds, of the multiple 1, in addition to the dead load, world axes about the platform origin (N, N m).
    pub load: Vec6,
    /// Tensions at their limits, in the order of the file.
    pub limits: Vec<LimitAtCable>,
    /// Cables with the dead load and the multiple of the load that binds; empty for an infinite multiple.
    pub cables: Vec<CableState>,
    /// Scaled residual of the balance with this load.
    pub residual: f64,
    /// Load that binds, as it follows a change of pose and robot.
    pub(crate) coefficients: LoadCoefficients,
}

/// Largest multiple of one load.
struct HeldMultiple {
    multiple: f64,
    upper_bound: f64,
    /// Direction in which the cables cannot reach more, reduced.
    direction: Vec6,
    limits: Vec<LimitAtCable>,
    cables: Vec<CableState>,
    residual: f64,
}

impl HeldMultiple {
    /// Multiple of a load that nothing limits.
    fn unlimited() -> Self {
        Self {
            multiple: f64::INFINITY,
            upper_bound: f64::INFINITY,
            direction: Vec6::zeros(),
            limits: Vec::new(),
            cables: Vec::new(),
            residual: 0.0,
        }
    }
}

/// Plane through the largest multiple of the load that binds, beyond which the cables reach no farther.
pub(super) struct WorstPlane {
    /// Largest multiple of the load.
    pub multiple: f64,
    /// Size of the load at right angles to the plane [N].
    pub along: f64,
}

impl LoadCapacity<'_> {
    /// Largest multiple of the required loads.
    ///
    /// With straight cables it follows from the facets; with sagging cables from the vertices that the facets leave
    /// open, each by a search along the true curves of the cables.
    ///
    /// # Errors
    /// [`StaticsError`]: the reason why the cables do not hold the dead load; nothing required; no convergence.
    ///
    /// # References
    /// docs/theory.md, equations (40i) to (40l).
    pub fn load_factor(&self) -> Result<LoadFactor, StaticsError> {
        if self.required.is_empty() {
            return Err(StaticsError::NothingRequired);
        }
        if wind_loads_cables(self.robot(), self.model) {
            return self.load_factor_in_wind();
        }
        self.rest.as_ref().map_err(Clone::clone)?;
        let (coefficients, held) = self.worst_load(self.available())?;
        let lower_bound = self.smallest(self.available(), |facet| facet.inner);
        Ok(LoadFactor {
            value: held.multiple,
            upper_bound: held.upper_bound,
            lower_bound: lower_bound.map(|lowest| lowest.min(held.multiple)),
            load: self.unscaled(&self.required.load(&coefficients)),
            limits: held.limits,
            cables: held.cables,
            residual: held.residual,
            wind_w: Vec3::zeros(),
            coefficients,
        })
    }

    /// Load that binds, with its largest multiple.
    fn worst_load(&self, available: &AvailableWrenches) -> Result<(LoadCoefficients, HeldMultiple), StaticsError> {
        match self.required.vertices() {
            Some(vertices) => self.worst_vertex(available, &vertices),
            None => self.worst_of_ball(available),
        }
    }

    /// Plane in which the multiples of the load that binds end.
    pub(super) fn worst_plane(&self) -> Result<WorstPlane, StaticsError> {
        let (coefficients, held) = self.worst_load(self.available())?;
        let load = self.required.load(&coefficients);
        let along = -held.direction.dot(&load) / held.direction.norm();
        Ok(WorstPlane { multiple: held.multiple, along: if along > 0.0 { along } else { load.norm() } })
    }

    /// Value of [`Self::load_factor`] alone, in less time: straight cables have it from the facets, and bounds of the
    /// bends of sagging ones are enough to choose the loads.
    ///
    /// # Errors
    /// As [`Self::load_factor`].
    pub fn load_factor_value(&self) -> Result<f64, StaticsError> {
        self.rest.as_ref().map_err(Clone::clone)?;
        if self.required.is_empty() {
            return Err(StaticsError::NothingRequired);
        }
        if wind_loads_cables(self.robot(), self.model) {
            return Ok(self.load_factor_in_wind()?.value);
        }
        let available = self.wrenches(BulgeSearch::Bounds);
        match self.smallest(&available, |facet| facet.inner) {
            Some(value) if available.is_straight() => Ok(value),
            _ => Ok(self.worst_load(&available)?.1.multiple),
        }
    }

    /// Smallest ratio of the reach of the cables to that of the required loads over all facets; `None` without facets,
    /// or with exit points that move with the tensions.
    pub(super) fn smallest(&self, available: &AvailableWrenches, reach: impl Fn(&Facet) -> f64) -> Option<f64> {
        if exit_points::depend_on_tensions(self.robot(), self.model) {
            return None;
        }
        smallest_ratio(available.facets(), &self.required, reach)
    }

    /// Vertex with the smallest multiple. Vertices are taken in the order of their lower bounds, until the bound of the
    /// next one is above the smallest multiple so far.
    fn worst_vertex(
        &self,
        available: &AvailableWrenches,
        vertices: &[Vec6],
    ) -> Result<(LoadCoefficients, HeldMultiple), StaticsError> {
        let single = |load: &Vec6| {
            let ratio = |facet: &Facet| facet.inner / -facet.normal.dot(load);
            let opposed = available.facets().iter().filter(|facet| facet.normal.dot(load) < 0.0);
            opposed.map(ratio).fold(f64::INFINITY, f64::min)
        };
        let is_bounded = self.smallest(available, |facet| facet.inner).is_some();
        let mut bounded: Vec<(f64, usize)> = (0..vertices.len())
            .filter(|at| vertices[*at].norm() > 0.0)
            .map(|at| (if is_bounded { single(&vertices[at]) } else { 0.0 }, at))
            .collect();
        order::sort_ascending(&mut bounded, |(bound, _)| *bound);

        let mut worst: Option<(usize, HeldMultiple)> = None;
        for (bound, at) in bounded {
            if worst.as_ref().is_some_and(|(_, held)| bound >= held.multiple) {
                break;
            }
            let held = self.largest_multiple(&vertices[at])?;
            if worst.as_ref().is_none_or(|(_, least)| held.multiple < least.multiple) {
                worst = Some((at, held));
            }
        }
        // Without any load that the platform can feel, every multiple is held.
        let (at, held) = worst.unwrap_or((0, HeldMultiple::unlimited()));
        Ok((self.required.vertex(at), held))
    }

    /// Load with the smallest multiple of a set without vertices. Sagging cables end the multiples in bent surfaces, so
    /// a descent may stop in a hollow that is not the deepest: each facet whose lower bound is below the smallest
    /// multiple so far starts another.
    fn worst_of_ball(&self, available: &AvailableWrenches) -> Result<(LoadCoefficients, HeldMultiple), StaticsError> {
        let is_bounded = self.smallest(available, |facet| facet.inner).is_some();
        let start_of = |facet: &Facet| {
            let reach = self.required.reach(&-facet.normal);
            let bound = if is_bounded { facet.inner / reach } else { 0.0 };
            (reach > 0.0).then_some((bound, -facet.normal))
        };
        let mut starts: Vec<(f64, Vec6)> = available.facets().iter().filter_map(start_of).collect();
        order::sort_ascending(&mut starts, |(bound, _)| *bound);
        if starts.is_empty() {
            starts.push((0.0, Coordinates::of(self.robot()).reduce(&load_wrench(self.robot(), &self.pose))));
        }

        let mut worst: Option<(LoadCoefficients, HeldMultiple)> = None;
        for (bound, direction) in starts {
            if worst.as_ref().is_some_and(|(_, least)| bound >= least.multiple) {
                break;
            }
            let (at, held) = self.lowest_near(self.required.farthest(&direction))?;
            if worst.as_ref().is_none_or(|(_, least)| held.multiple < least.multiple) {
                worst = Some((at, held));
            }
        }
        worst.ok_or(StaticsError::NothingRequired)
    }

    /// Load with the smallest multiple near a load of the set: the direction in which the cables reach no farther gives
    /// the next load; a step that does not lower the multiple is halved.
    fn lowest_near(&self, mut at: LoadCoefficients) -> Result<(LoadCoefficients, HeldMultiple), StaticsError> {
        let mut load = self.required.load(&at);
        if load.norm() == 0.0 {
            return Ok((at, HeldMultiple::unlimited()));
        }
        let mut held = self.largest_multiple(&load)?;
        let mut share = 1.0;
        for _ in 0..MAX_DIRECTIONS {
            let next_at = self.required.between(&at, &self.required.farthest(&-held.direction), share);
            let next = self.required.load(&next_at);
            if next.norm() == 0.0 || (next - load).norm() <= SAME_LOAD * load.norm() {
                break;
            }
            let found = self.largest_multiple(&next)?;
            if found.multiple < held.multiple {
                (at, load, held, share) = (next_at, next, found, f64::min(2.0 * share, 1.0));
            } else {
                share /= 2.0;
            }
        }
        Ok((at, held))
    }

    /// Largest multiple of one reduced load that the cables hold in addition to the dead load.
    fn largest_multiple(&self, load: &Vec6) -> Result<HeldMultiple, StaticsError> {
        let (robot, model) = (self.robot(), self.model);
        let found = if exit_points::depend_on_tensions(robot, model) {
            let solve = |held: &Robot, _: Option<&HeldMultiple>| self.multiple_at_exit_points(held, load);
            exit_points::with_places(robot, &self.pose, model, solve, |held| &mut held.cables, &[])
        } else {
            self.multiple_at_exit_points(robot, load)
        }?;
        let is_open = found.multiple.is_finite() && self.may_be_slacker();
        Ok(if is_open { self.with_slacker_cables(load, found) } else { found })
    }

    /// True if a cable with the load that binds is slacker than (37). The load factor of a robot with as many cables as
    /// degrees of freedom counts such cables; its capacity margin and its largest acceleration do not.
    pub fn counts_slacker_cables(&self, factor: &LoadFactor) -> bool {
        let is_slacker = |(cable, state): (&CableAtPose, &CableState)| {
            let tau = state.hanging.as_ref().map_or(f64::INFINITY, |hanging| hanging.catenary.parallel_tension());
            tau < cable.slackest * (1.0 - SAME_LOAD)
        };
        self.cables.iter().zip(&factor.cables).any(is_slacker)
    }

    /// True if the tensions are unique and a cable may be slacker than (37), which limits the sag of all other robots.
    pub(super) fn may_be_slacker(&self) -> bool {
        let is_unique = has_unique_tensions(self.robot(), &self.pose, self.model);
        is_unique && {
            let reaches = reaches_of(&self.cables);
            WrenchSet { reaches: &reaches, motion: self.robot().platform.motion }.may_be_slacker()
        }
    }

    /// Largest multiple of cables that end at fixed points.
    fn multiple_at_exit_points(&self, robot: &Robot, load: &Vec6) -> Result<HeldMultiple, StaticsError> {
        let rest = self.rest.as_ref().map_err(Clone::clone)?;
        let mut cables = cables_at(robot, &self.pose, self.model, &TensionRule::Lowest)?;
        start_from(&mut cables, rest);
        let reaches = reaches_of(&cables);
        let set = WrenchSet { reaches: &reaches, motion: robot.platform.motion };
        let mut best = self.multiple_from(robot, load, cables.clone(), &set)?;

        // Another optimum may be higher: begin again from the tensions that reach farthest in the direction of the
        // bound, and if the gap is wide, from others between the limits.
        let starts = GAPS.iter().map(|(_, starts)| *starts).max().unwrap_or(0);
        for k in 0..starts {
            let open = GAPS.iter().find(|(_, starts)| k < *starts).map_or(f64::INFINITY, |(gap, _)| *gap);
            if best.multiple.is_infinite() || best.upper_bound - best.multiple <= open * best.multiple {
                break;
            }
            let start = if k == 0 { set.reach(&best.direction).1 } else { spread_start(&reaches, load_size(robot), k) };
            for (cable, tau) in cables.iter_mut().zip(start) {
                cable.set(tau);
            }
            let Ok(other) = self.multiple_from(robot, load, cables.clone(), &set) else { continue };
            let upper_bound = best.upper_bound.min(other.upper_bound);
            if other.multiple > best.multiple {
                best = other;
            }
            best.upper_bound = upper_bound.max(best.multiple);
        }
        Ok(best)
    }

    /// Largest multiple of the load without the limit (37) of the sag, which as many cables as degrees of freedom do
    /// not have: their tensions are those of the equilibrium, however slack. It follows the equilibrium as the load
    /// grows.
    fn with_slacker_cables(&self, load: &Vec6, best: HeldMultiple) -> HeldMultiple {
        let robot = self.robot();
        let held = |multiple: f64| {
            let loaded = self.with_extra(robot, &(load * multiple));
            inverse(&loaded, &self.pose, self.model).ok().filter(|rest| keeps_limits(&loaded, rest))
        };
        let mut step = FIRST_STEP * best.multiple.max(load_size(robot) / load.norm());
        let (mut at, mut beyond) = (best.multiple, None);
        let Some(mut rest) = held(at + SAME_LOAD * step) else { return best };
        for _ in 0..MAX_STEPS {
            let next = beyond.map_or(at + step, |beyond| f64::midpoint(at, beyond));
            match held(next) {
                Some(found) => (at, rest, step) = (next, found, 2.0 * step),
                None => beyond = Some(next),
            }
            if beyond.is_some_and(|beyond| beyond - at <= SAME_LOAD * beyond) {
                break;
            }
        }
        if beyond.is_none() {
            return HeldMultiple::unlimited();
        }

        // The limit that ends it, and the direction that only this tension changes.
        let Some((limits, direction)) = self.ending_limit(&rest, load) else { return best };
        let upper_bound = best.upper_bound.max(at);
        HeldMultiple { multiple: at, upper_bound, direction, limits, cables: rest.cables, residual: rest.residual }
    }

    /// Tensions at their limits in an equilibrium with unique tensions, and the direction against a load in which the
    /// tension nearest to its limit is the only one that matters; `None` for dependent cables.
    fn ending_limit(&self, rest: &Equilibrium, load: &Vec6) -> Option<(Vec<LimitAtCable>, Vec6)> {
        let robot = self.robot();
        let mut cables = cables_at(robot, &self.pose, self.model, &TensionRule::Lowest).ok()?;
        let mut columns = Mat6::identity();
        let mut nearest: Option<(usize, TensionMargin)> = None;
        for (i, (cable, state)) in cables.iter_mut().zip(&rest.cables).enumerate() {
            cable.set(state.hanging.as_ref()?.catenary.parallel_tension());
            columns.set_column(i, &robot.platform.motion.reduced(&cable.column()));
            let margin = cable.range.margin(state);
            if nearest.is_none_or(|(_, least)| margin.distance() < least.distance()) {
                nearest = Some((i, margin));
            }
        }

        let (i, TensionMargin { range, min, max }) = nearest?;
        let limit = if min - range.minimum < range.maximum - max { Limit::Minimum } else { Limit::Maximum };
        let direction: Vec6 = columns.try_inverse()?.row(i).transpose();
        let sign = -direction.dot(load).signum();
        Some((limits_reached(&cables, &[(i, limit)]), direction * sign))
    }

    /// Largest multiple by a search from the tensions of cables, whose ranges are `set`.
    fn multiple_from(
        &self,
        robot: &Robot,
        load: &Vec6,
        cables: Vec<CableAtPose>,
        set: &WrenchSet<'_>,
    ) -> Result<HeldMultiple, StaticsError> {
        let (pose, size) = (&self.pose, load.norm());
        let unit = load / size;
        let mut search = RaySearch::new(robot, pose, self.model, cables, WrenchRay { unit, sign: 1.0, least: 0.0 });
        let end = search.extreme()?.ok_or(StaticsError::NoLoadFactor)?;
        let mut multiple = end.multiple / size;
        if end.unlimited {
            multiple = f64::INFINITY;
        }

        // No tensions reach farther in the direction of the multipliers: (40j).
        let cables = search.into_cables_at(&end);
        let limits = limits_reached(&cables, &end.held_by);
        let direction = end.multipliers;
        let own = Coordinates::of(robot).reduce(&load_wrench(robot, pose));
        let along = -direction.dot(&unit);
        let upper_bound = if end.unlimited || along <= 0.0 {
            f64::INFINITY
        } else {
            let reach = if has_unique_tensions(self.robot(), pose, self.model) {
                set.reach_with_slack(&direction)
            } else {
                set.reach(&direction).0
            };
            (direction.dot(&own) + reach) / (along * size)
        };

        if multiple.is_infinite() {
            return Ok(HeldMultiple { direction, ..HeldMultiple::unlimited() });
        }
        let loaded = self.with_extra(robot, &(load * multiple));
        let rest = equilibrium_of(&loaded, pose, self.model, cables, 0);
        Ok(HeldMultiple {
            multiple,
            upper_bound: upper_bound.max(multiple),
            direction,
            limits,
            cables: rest.cables,
            residual: rest.residual,
        })
    }

    /// Robot with a further load, reduced.
    fn with_extra(&self, robot: &Robot, load: &Vec6) -> Robot {
        let extra = self.unscaled(load);
        let mut own = robot.load;
        // A force at the platform origin, moved to the point of the robot's own load.
        let force_w = extra.fixed_rows::<3>(0).into_owned();
        own.force_w += force_w;
        own.moment_w += extra.fixed_rows::<3>(3).into_owned() - (self.pose.rot_wp * own.point_p).cross(&force_w);
        robot.with_load(own)
    }
}

/// Smallest ratio of a reach of facets to that of a set of loads; `None` without facets.
fn smallest_ratio(facets: &[Facet], loads: &RequiredSet, reach: impl Fn(&Facet) -> f64) -> Option<f64> {
    let ratio = |facet: &Facet| {
        let load = loads.reach(&-facet.normal);
        if load > 0.0 { reach(facet) / load } else { f64::INFINITY }
    };
    facets.iter().map(ratio).reduce(f64::min).map(|smallest| smallest.max(0.0))
}

/// Bounds of the load factor at a pose from the facets alone, without an equilibrium: it takes a fraction of the time
/// of
/// [`LoadCapacity::load_factor_value`]. Up to the lower one all required loads are held, and the dead load with them if
/// it is positive; beyond the upper one, no tensions within the limits hold them. `None` if nothing is required,
/// without facets, with exit points that move with the tensions, or with required wind on the cables.
///
/// # Errors
/// As [`LoadCapacity::at`].
///
/// # References
/// docs/theory.md, equations (40i) and (40k).
pub fn load_factor_bounds(robot: &Robot, pose: &Pose, model: StaticModel) -> Result<Option<[f64; 2]>, StaticsError> {
    let required = RequiredSet::of(robot, pose, &robot.required);
    if required.is_empty() || exit_points::depend_on_tensions(robot, model) || wind_loads_cables(robot, model) {
        return Ok(None);
    }
    let loaded = with_lightest_payload(robot, pose);
    let cables = cables_at(&loaded, pose, model, &TensionRule::Lowest)?;
    let load = Coordinates::of(robot).reduce(&load_wrench(&loaded, pose));
    let available = AvailableWrenches::of(cables, &load, robot.platform.motion, BulgeSearch::Bounds);

    let bound = |reach: fn(&Facet) -> f64| smallest_ratio(available.facets(), &required, reach);
    Ok(bound(|facet| facet.inner).zip(bound(|facet| facet.outer)).map(|(lower, upper)| [lower, upper]))
}

/// Ranges of cables in any state.
fn reaches_of(cables: &[CableAtPose]) -> Vec<ReachableTensions> {
    let of = |cable: &CableAtPose| {
        let mut cable = cable.clone();
        let minimum = cable.at_minimum();
        ReachableTensions::of(&cable, minimum)
    };
    cables.iter().map(of).collect()
}

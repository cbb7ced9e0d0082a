//! Tensions and lengths at one time of a motion, in a control loop.

use super::input::LoopInput;
use super::model::{LoopModel, MAX_CABLES};
use super::rates;
use super::state::{LoopCable, LoopFault, LoopMissing, LoopState, LoopStatus};
use crate::math::Vec6;
use crate::path::PathPoint;
use crate::platform::{load_size, load_wrench};
use crate::statics::{
    CentreCable, CentreLoad, CentreRow, CentreSearch, Potential, RESIDUAL_LIMIT, StaticModel, TensionCurve,
    TensionRange,
};
use arrayvec::ArrayVec;
use std::cmp::Ordering;

/// Maximum numbers of Newton steps: from the last state, from the middle of the limits, and from a state near the
/// limits to the centre. Three, ten and eight are usual.
pub(super) const MAX_WARM_STEPS: usize = 12;
pub(super) const MAX_COLD_STEPS: usize = 24;

/// Tensions from which the next search starts.
#[derive(Debug, Clone, Copy)]
pub(super) struct NearInverse {
    tau: [f64; MAX_CABLES],
    limits: [[f64; 2]; MAX_CABLES],
    multipliers: Vec6,
    potential: Potential,
}

/// Tensions and lengths at one time.
pub(super) struct SolvedState {
    pub(super) near: NearInverse,
    pub(super) state: LoopState,
    /// True if the centre is proved to be the only one, and the balance holds.
    pub(super) is_proved: bool,
    /// Smallest distance of a tension τ from its limits [N].
    least_room: f64,
}

/// Tensions and lengths at one time of a motion, from a state nearby or from the middle of the limits. `with_rates`
/// adds rates and accelerations of the lengths.
pub(super) fn solve(
    model: &LoopModel,
    input: &LoopInput,
    near: Option<&NearInverse>,
    with_rates: bool,
) -> Result<SolvedState, LoopFault> {
    let (robot, coordinates, motion) = (model.robot(), model.coordinates(), &input.motion);
    let pose = &motion.pose;

    // The inertia is a load. Its size belongs to the sum of the forces.
    let [force_w, moment_w] = motion.inertia(robot);
    let inertia = Vec6::new(force_w.x, force_w.y, force_w.z, moment_w.x, moment_w.y, moment_w.z);
    let added = input.wrench() + inertia;
    let load = CentreLoad {
        wrench: coordinates.reduce(&(load_wrench(robot, pose) + added)),
        size: load_size(robot) + coordinates.wrench_size(&added),
    };

    let mut cables = ArrayVec::<CentreCable<'_>, MAX_CABLES>::new();
    for i in 0..model.cables() {
        let curve = TensionCurve::at(robot, i, pose, StaticModel::Catenary);
        cables.push(if model.has_choice() {
            CentreCable::new(curve, pose, coordinates, near.map(|near| near.limits[i]))
        } else {
            let limits = [0.0, f64::INFINITY];
            CentreCable::within(curve, pose, coordinates, limits)
        });
    }
    if let Some(cable) = cables.iter().position(|cable| cable.lower.partial_cmp(&cable.upper) != Some(Ordering::Less)) {
        return Err(LoopFault::LimitsContradict { cable });
    }

    let mut rows = [CentreRow::default(); MAX_CABLES];
    let count = cables.len();
    let mut search_for = CentreSearch::new(coordinates, &mut cables, &mut rows[..count], load);
    if model.has_choice() {
        best(&mut search_for, near)?;
    } else {
        the_only(&mut search_for, near)?;
    }
    let mut solved = collected(model, motion, &search_for);
    if with_rates && !rates::add(model, input, &search_for, &mut solved.state) {
        solved.state.status = solved.state.status.max(LoopStatus::Accepted);
    }
    Ok(solved)
}

/// Searches for the centre, or where there is none for tensions beyond the limits.
fn best(search: &mut CentreSearch<'_, '_>, near: Option<&NearInverse>) -> Result<(), LoopFault> {
    // A relaxed logarithm has the same centre if that is not next to a limit.
    search.potential = Potential::Relaxed;
    let mut found = false;
    if let Some(near) = near {
        search.start_at(|i| near.tau[i], near.multipliers);
        found = search.newton(MAX_WARM_STEPS);
    }
    if !found {
        search.start(|_| f64::NAN, &[]);
        found = search.newton(MAX_COLD_STEPS);
    }
    if !found {
        return Err(if search.is_singular { LoopFault::Singular } else { LoopFault::NotFound });
    }
    if search.is_inside() {
        search.potential = Potential::Logarithms;
        return Ok(());
    }

    // Next to a limit: the centre by its logarithms, if there is one.
    let relaxed: ArrayVec<f64, MAX_CABLES> = search.cables.iter().map(|cable| cable.curve.tau()).collect();
    let (multipliers, violation) = (search.multipliers, search.violation());
    if violation > MAX_VIOLATION {
        return Ok(());
    }
    search.potential = Potential::Logarithms;
    let start: ArrayVec<f64, 6> = multipliers.iter().copied().collect();
    search.start(|i| relaxed[i], &start);
    if !search.newton(MAX_COLD_STEPS) {
        search.potential = Potential::Relaxed;
        search.start_at(|i| relaxed[i], multipliers);
    }
    Ok(())
}

/// Maximum violation by the relaxed logarithms, over their width, beside which tensions within the limits may exist: up
/// to a fifth was seen.
const MAX_VIOLATION: f64 = 0.5;

/// Searches for the only tensions that hold the platform with as many cables as degrees of freedom.
fn the_only(search: &mut CentreSearch<'_, '_>, near: Option<&NearInverse>) -> Result<(), LoopFault> {
    search.potential = Potential::None;
    if let Some(near) = near {
        search.start_at(|i| near.tau[i], Vec6::zeros());
        if search.newton(MAX_WARM_STEPS) {
            return Ok(());
        }
    }
    search.start_at(|_| f64::NAN, Vec6::zeros());
    if search.newton(MAX_COLD_STEPS) {
        return Ok(());
    }
    Err(if search.is_singular { LoopFault::Singular } else { LoopFault::NotFound })
}

/// State with the tensions of a search.
fn collected(model: &LoopModel, motion: &PathPoint, search: &CentreSearch<'_, '_>) -> SolvedState {
    let (robot, count) = (model.robot(), model.cables());
    let mut cables = [LoopCable::default(); MAX_CABLES];
    let (mut tau, mut limits) = ([0.0; MAX_CABLES], [[0.0; 2]; MAX_CABLES]);
    let (mut error_length, mut least_room) = (0.0_f64, f64::INFINITY);
    for (i, cable) in search.cables.iter().enumerate() {
        let (curve, span) = (&cable.curve, &cable.curve.span);
        let (beyond, free_length) = (curve.beyond_exit(), span.catenary.rope().unstrained_length);
        let margin = TensionRange::of(robot, i, &span.chord_w()).margin_of_span(span, beyond.tension_drum);
        cables[i] = LoopCable {
            length: free_length + beyond.length,
            free_length,
            tension_platform: span.catenary.tension_at_start(),
            tension_drum: beyond.tension_drum,
            margin: margin.distance(),
            ..LoopCable::default()
        };
        tau[i] = curve.tau();
        limits[i] = [cable.lower, cable.upper];
        let by_tau = span.catenary.by_parallel_tension().length[0];
        error_length = error_length.max((by_tau * search.last_step(i)).abs());
        least_room = cable.room().into_iter().fold(least_room, f64::min);
    }

    let [unbalanced, size] = search.unbalanced();
    let is_balanced = unbalanced <= RESIDUAL_LIMIT * size;
    let is_proved = is_balanced && (search.potential == Potential::None || search.certificate().is_unique());
    let state = LoopState {
        status: LoopStatus::Certified,
        age: 0,
        iterations: u32::try_from(search.iterations).unwrap_or(u32::MAX),
        pose: motion.pose,
        error_force: unbalanced,
        error_length,
        least_margin: 0.0,
        least_margin_cable: 0,
        missing: None,
        cables,
    };
    let near = NearInverse { tau, limits, multipliers: search.multipliers, potential: search.potential };
    let mut solved = SolvedState { near, state: state.with_margins(count), is_proved, least_room };
    solved.state.status = solved.status();
    if solved.state.status == LoopStatus::BeyondLimits && model.has_choice() {
        solved.state.missing = missing(model, search);
    }
    solved
}

/// Proof that no tensions within the limits exist.
fn missing(model: &LoopModel, search: &CentreSearch<'_, '_>) -> Option<LoopMissing> {
    let found = search.missing()?;
    let expanded = model.coordinates().expand(&found.direction);
    Some(LoopMissing {
        force_w: expanded.fixed_rows::<3>(0).into(),
        moment_w: expanded.fixed_rows::<3>(3).into(),
        size: found.size,
        at_maximum: found.at_maximum,
    })
}

impl SolvedState {
    /// Trust in the tensions.
    fn status(&self) -> LoopStatus {
        let is_within = match self.near.potential {
            Potential::Logarithms => true,
            Potential::Relaxed => self.least_room >= 0.0,
            Potential::None => self.state.least_margin >= 0.0,
        };
        match (is_within, self.near.potential) {
            (false, _) => LoopStatus::BeyondLimits,
            (true, Potential::Logarithms | Potential::None) if self.is_proved => LoopStatus::Certified,
            (true, _) => LoopStatus::Accepted,
        }
    }
}

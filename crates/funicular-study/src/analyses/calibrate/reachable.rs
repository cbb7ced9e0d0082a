//! Candidates of a proposal that the calibrated robot can reach: with tensions within their limits, and without
//! touching anything.

use super::Calibrated;
use super::report::CalibrationReport;
use super::rows::{LeftOut, Reachable};
use crate::Watch;
use crate::at_rest;
use crate::error::Cancelled;
use crate::request::CalibrateRequest;
use anyhow::Result;
use funicular::calibration::CandidatePose;
use funicular::clearance::Surroundings;
use funicular::robot::{Pose, Robot, State};
use funicular::statics::{self, Equilibrium, StaticModel, TensionRange, TensionRule};

/// Tension beyond its limit, relative to the limit, that is rounding of the search for tensions.
const ROUNDING: f64 = 1e-6;

impl CalibrationReport<'_> {
    /// Checks candidates.
    ///
    /// # Errors
    /// Tension limits or a rule that contradict each other, or work that was stopped.
    pub(super) fn reachable(&self, poses: &[Pose], watch: &mut dyn Watch) -> Result<Reachable> {
        let request = self.request;
        let robot = at_rest::with_limits(&self.of.robot_at(&self.found.best.values).robot, &request.tensions)?;
        let is_elastic = self.of.is_elastic();
        let has_bodies = robot.clearance.is_some() || !robot.obstacles.is_empty() || !robot.platform.bodies.is_empty();
        if !is_elastic && !has_bodies && !has_limits(&robot, request) {
            let candidates: Vec<CandidatePose> = poses.iter().copied().map(CandidatePose::from).collect();
            return Ok(Reachable { rules: vec![None; candidates.len()], candidates, left_out: None });
        }

        let rules = rules(&robot, request, is_elastic)?;
        let surroundings = has_bodies.then(|| Surroundings::of(&robot));
        let mut found = Reachable { candidates: Vec::new(), rules: Vec::new(), left_out: None };
        let mut left_out = LeftOut { candidates: poses.len(), ..LeftOut::default() };
        for (number, pose) in poses.iter().enumerate() {
            watch.progress(number, poses.len(), "candidates");
            if watch.is_cancelled() {
                return Err(Cancelled.into());
            }
            let mut rests: Vec<(Equilibrium, Option<&'static str>)> =
                rules.iter().filter_map(|rule| at_pose(&robot, pose, request.static_model, rule)).collect();
            if rests.is_empty() {
                left_out.by_tensions += 1;
            }
            rests.dedup_by(|a, b| a.1.is_none() && b.1.is_none());
            let is_free = |rest: &Equilibrium| {
                surroundings
                    .as_ref()
                    .and_then(|around| around.least(rest, None))
                    .is_none_or(|least| least.margin() >= 0.0)
            };
            let free: Vec<_> = rests.iter().filter(|(rest, _)| is_free(rest)).collect();
            if free.is_empty() && !rests.is_empty() {
                left_out.by_clearance += 1;
            }
            for (rest, rule) in free {
                let lengths = rest.cables.iter().map(|cable| cable.unstrained_length);
                let lengths = if is_elastic { lengths.collect() } else { Vec::new() };
                found.candidates.push(CandidatePose { pose: rest.pose, lengths });
                found.rules.push(*rule);
            }
        }
        found.left_out = Some(left_out);
        Ok(found)
    }
}

/// True if tensions of straight rigid cables are limited.
fn has_limits(robot: &Robot, request: &CalibrateRequest) -> bool {
    let is_limited = |cable: &funicular::robot::Cable| {
        let limits = cable.limits();
        limits.minimum.is_some() || limits.maximum.is_some()
    };
    robot.cables.iter().any(is_limited) || request.tensions != crate::request::Tensions::default()
}

/// Rules of the tensions that each candidate tries.
fn rules(robot: &Robot, request: &CalibrateRequest, is_elastic: bool) -> Result<Vec<TensionRule>> {
    if let Some(rule) = at_rest::rule(&request.tensions)? {
        return Ok(vec![rule]);
    }
    let has_middle = is_elastic && robot.cables.iter().all(|cable| cable.limits().maximum.is_some());
    let middle = has_middle.then_some(TensionRule::Middle);
    Ok([TensionRule::Lowest].into_iter().chain(middle).collect())
}

/// Equilibrium at a pose with tensions within their limits, and the rule if there was a choice.
fn at_pose(
    robot: &Robot,
    pose: &Pose,
    model: StaticModel,
    rule: &TensionRule,
) -> Option<(Equilibrium, Option<&'static str>)> {
    let found = statics::solve_at(robot, &State::Pose(*pose), model, rule).ok()?;
    let rest = found.equilibrium;
    let within = rest.cables.iter().enumerate().all(|(i, cable)| {
        let range = TensionRange::of(robot, i, &cable.chord_w());
        range.margin(cable).distance() >= -ROUNDING * cable.tension_platform.abs().max(1.0)
    });
    within.then(|| (rest, found.rule.as_ref().map(TensionRule::name)))
}

/// Sentence on what was left out, for results whose candidates are all gone.
pub(super) fn none_left(results: &Calibrated) -> Option<String> {
    let LeftOut { candidates, by_tensions, by_clearance } = results.left_out?;
    (results.proposals.is_empty() && candidates > 0 && by_tensions + by_clearance == candidates).then(|| {
        format!(
            "no pose is proposed: of {candidates} candidates {by_tensions} have no equilibrium with tensions within \
             the limits and {by_clearance} bring cables, platform or obstacles too near to each other; give other \
             candidates or limits"
        )
    })
}

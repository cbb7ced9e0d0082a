//! Used parts of the limits of tensions, winches and distances.

use super::Planned;
use super::samples::MotionSamples;
use funicular::clearance::Clearance;
use funicular::math::Vec3;
use funicular::robot::{Cable, LimitOfWinch, Load, RequiredLoads, Robot, WinchLimits};
use funicular::statics::{Limit, LoadCapacity, TensionRange};
use funicular::trajectory::InMotion;

/// Excess of a tension by choice over its limit that is the error of the rule's solution.
const ROUNDING_OF_RULE: f64 = 1e-6;

/// Largest number of times at which the reserve of the inertia is computed.
const MAX_RESERVES: usize = 800;

/// Limit, of which a motion uses a part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum UsedLimit {
    Tension(Limit, usize),
    Winch(LimitOfWinch, usize),
    Clearance,
}

impl UsedLimit {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Tension(Limit::Maximum, _) => "maximum-tension",
            Self::Tension(Limit::Minimum, _) => "minimum-tension",
            Self::Winch(limit, _) => limit.name(),
            Self::Clearance => "clearance",
        }
    }

    /// Cable to which it belongs.
    pub(super) fn cable(self) -> Option<usize> {
        match self {
            Self::Tension(_, cable) | Self::Winch(_, cable) => Some(cable),
            Self::Clearance => None,
        }
    }
}

/// Used part of every limit at a sample: tension over maximum, minimum over tension, and what the winches and distances
/// use of theirs. Infinite for what has no bound there.
pub(super) fn parts(samples: &MotionSamples, planned: &Planned, k: usize) -> Vec<(UsedLimit, f64)> {
    let robot = planned.robot;
    let mut found = Vec::new();
    for i in 0..robot.cables.len() {
        found.extend(of_tensions(planned, &samples.motions[k], i));
        found.extend(of_winch(samples, robot, k, i));
    }
    let row = samples.rows.binary_search(&k).ok();
    let pair = row.and_then(|row| samples.nearest[row].as_ref());
    found.extend(pair.map(|pair| (UsedLimit::Clearance, part_of_clearance(pair))));
    found
}

/// Used part of the distance of a pair that comes too near between the samples, with its time.
pub(super) fn between_rows(samples: &MotionSamples) -> Option<(f64, (UsedLimit, f64))> {
    let (time, pair) = samples.passing.as_ref()?.too_near()?;
    // No distance is required of what touches, and still it is beyond its limit.
    Some((time, (UsedLimit::Clearance, part_of_clearance(pair).max(1.0))))
}

/// Largest used part.
pub(super) fn most(parts: &[(UsedLimit, f64)]) -> Option<(UsedLimit, f64)> {
    parts.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1))
}

fn of_tensions(planned: &Planned, motion: &InMotion, i: usize) -> [(UsedLimit, f64); 2] {
    let state = &motion.equilibrium.cables[i];
    let margin = TensionRange::of(planned.robot, i, &state.chord_w()).margin(state);
    let minimum = match margin.range.minimum {
        none if none <= 0.0 => 0.0,
        _ if margin.min <= 0.0 => f64::INFINITY,
        least => least / margin.min,
    };
    // Tensions by choice are within their limits, or there are none.
    let kept = |part: f64| if planned.judged.choice && part <= 1.0 + ROUNDING_OF_RULE { part.min(1.0) } else { part };
    [
        (UsedLimit::Tension(Limit::Minimum, i), kept(minimum)),
        (UsedLimit::Tension(Limit::Maximum, i), kept(margin.max / margin.range.maximum)),
    ]
}

fn of_winch(samples: &MotionSamples, robot: &Robot, k: usize, i: usize) -> Vec<(UsedLimit, f64)> {
    let winch = samples.winch(robot, k, i);
    let Some((limits, motor)) = limits_of(&robot.cables[i]).zip(winch.motor) else { return Vec::new() };
    let beside = || samples.jumps.iter().filter(move |jump| jump.is_beside(k));
    let no_bound = |limit: LimitOfWinch| match limit {
        LimitOfWinch::Speed => limits.speed.is_finite() && beside().any(|jump| jump.has_length_jump(i)),
        LimitOfWinch::Acceleration => limits.acceleration.is_finite() && beside().any(|jump| jump.has_rate_jump(i)),
        LimitOfWinch::Torque | LimitOfWinch::Power | LimitOfWinch::BrakePower => false,
    };
    let parts = limits.use_of(winch.speed, winch.acceleration, &motor);
    let judged = |(limit, part)| (UsedLimit::Winch(limit, i), if no_bound(limit) { f64::INFINITY } else { part });
    parts.into_iter().map(judged).collect()
}

/// Inertia over the largest multiple of it that tensions within their limits hold, the largest on the path; `None`
/// where the dead load alone is not held, and where the tensions are no matter of choice.
pub(super) fn part_of_inertia(planned: &Planned, motions: &[InMotion]) -> Option<f64> {
    if !planned.judged.inertia {
        return None;
    }
    let stride = motions.len().div_ceil(MAX_RESERVES);
    let mut robot = Robot { required: RequiredLoads::default(), ..planned.robot.clone() };
    let part = |motion: &InMotion| {
        let [force_w, moment_w] = motion.point.inertia(planned.robot);
        if [force_w, moment_w] == [Vec3::zeros(); 2] {
            return Some(0.0);
        }
        robot.required.listed = vec![Load { force_w, moment_w, point_p: Vec3::zeros() }];
        let capacity = LoadCapacity::at(&robot, &motion.point.pose, planned.model, None).ok()?;
        Some(1.0 / capacity.load_factor().ok()?.value)
    };
    motions.iter().step_by(stride).filter_map(part).reduce(f64::max)
}

/// Required distance over the distance of a pair; infinite where it touches.
fn part_of_clearance(pair: &Clearance) -> f64 {
    if pair.touches() { f64::INFINITY } else { pair.required / pair.distance }
}

/// Limits of the winch of a cable.
fn limits_of(cable: &Cable) -> Option<&WinchLimits> {
    cable.anchor.winch.as_ref().map(|winch| &winch.limits)
}

//! Sentences about a motion: the verdict on its limits, numbers without a bound, and why cables run fast.

use super::jumps::{JumpCause, LengthJump};
use super::samples::MotionSamples;
use super::{ACCELERATION, Extreme, MostUsed, Planned, SPEED, TrajectoryResult};
use crate::at_rest::SMOOTH_RULES;
use crate::text::{counted, significant};
use funicular::math::Vec3;
use funicular::statics::{Limit, TensionRule};

/// Speed of a cable over that of its end at the platform from which on it is explained.
const FAST: f64 = 1.1;

impl TrajectoryResult {
    /// Sentence on the limits.
    pub fn verdict(&self) -> String {
        let Some(of) = &self.most_used else {
            return "The robot file has no limit of tensions, winches or distances for this path.".to_owned();
        };
        format!(
            "{}; the nearest is the {}.",
            if self.within_limits { "Within all limits" } else { "BEYOND a limit" },
            self.told_use(of)
        )
    }

    /// Limit with the used part and its place: "maximum tension of cable "3", used to 82 % at 1.2 s".
    pub fn told_use(&self, of: &MostUsed) -> String {
        let cable = of.cable.as_ref().map_or_else(String::new, |cable| format!(" of cable \"{cable}\""));
        let no_bound =
            self.extremes.iter().find(|extreme| extreme.no_bound.is_some() && extreme.what.ends_with(of.limit));
        let part = match (of.part, no_bound) {
            (Some(part), _) if of.limit == "maximum-tension" => format!("T/T_max = {} %", significant(100.0 * part, 4)),
            (Some(part), _) if of.limit == "minimum-tension" => format!("T_min/T = {} %", significant(100.0 * part, 4)),
            (Some(part), _) => format!("used to {} %", significant(100.0 * part, 4)),
            (None, Some(_)) => "which has no bound".to_owned(),
            (None, None) => "where nothing is allowed".to_owned(),
        };
        format!("{}{cable}, {part} at {} s", of.limit.replace('-', " "), significant(of.t_s, 4))
    }
}

/// Reason why an extreme has no bound, with the place of the largest jump.
pub(super) fn no_bound(planned: &Planned, samples: &MotionSamples, what: &str) -> Option<String> {
    let size = |jump: &LengthJump| {
        let lengths = jump.length_jumps().map_or(0.0, |(_, size)| size);
        let rates = jump.rate_jumps().map_or(0.0, |(_, size)| size);
        match what {
            SPEED => lengths,
            ACCELERATION => lengths * 1e6 + rates,
            _ => 0.0,
        }
    };
    let jumping = samples.jumps.iter().filter(|jump| size(jump) > 0.0);
    let worst = jumping.max_by(|a, b| size(a).total_cmp(&size(b)))?;
    Some(format!("because {} ({})", worst.because(planned), worst.told(planned.robot)))
}

/// True if the rates of lengths jump where other conditions hold the tensions, so that the acceleration has no number.
pub(super) fn jumps_at_kinks(samples: &MotionSamples, what: &str) -> bool {
    let jumps = |jump: &LengthJump| jump.is_kink() && jump.rate_jumps().is_some();
    what == ACCELERATION && samples.jumps.iter().any(jumps)
}

/// Warning about a rule that goes over to other tensions on the way.
pub(super) fn rule_that_jumps(planned: &Planned, samples: &MotionSamples) -> Option<String> {
    let jumps: Vec<&LengthJump> = samples.jumps.iter().filter(|jump| jump.cause == JumpCause::Rule).collect();
    let worst = jumps.iter().max_by(|a, b| a.tension_jump().1.total_cmp(&b.tension_jump().1))?;
    Some(format!(
        "the rule `{}` jumps to other tensions at {}: {}; no winch follows that: take ⟪tension_rule⟫ {SMOOTH_RULES}",
        planned.rule.name(),
        counted(jumps.len(), "time"),
        worst.told(planned.robot)
    ))
}

/// Sentences that explain the largest numbers.
pub(super) fn notes(planned: &Planned, samples: &MotionSamples, extremes: &[Extreme]) -> Vec<String> {
    let mut found: Vec<String> = fast_cable(planned, samples, extremes).into_iter().collect();
    let jumps_of_path = samples.jumps.iter().any(|jump| matches!(jump.cause, JumpCause::Path(3)));
    if jumps_of_path {
        found.push(
            "lengths follow the acceleration through sag and stretch, so that their rates jump where the jerk jumps: \
             the courses `continuous-jerk` and `septic` have no such jumps"
                .to_owned(),
        );
    }

    let at_minimum = |jump: &&LengthJump| {
        let is_at_minimum = |changes: &[(usize, Limit, bool)]| changes.iter().any(|of| of.1 == Limit::Minimum);
        jump.rate_jumps().is_some() && matches!(&jump.cause, JumpCause::Limits(changes) if is_at_minimum(changes))
    };
    if samples.jumps.iter().any(|jump| at_minimum(&jump)) {
        found.push(format!(
            "the rule `{}` lets cables come to their minimum tension and leave it, where all rates jump: {}",
            planned.rule.name(),
            if matches!(planned.rule, TensionRule::Closest(_)) {
                "a larger ⟪target_tension_n⟫, or ⟪tension_rule⟫ `centre`, keeps them above it"
            } else {
                "⟪tension_rule⟫ `centre`, or `closest` with a ⟪target_tension_n⟫ well above the minimum, keeps them \
                 above it"
            }
        ));
    }
    found
}

/// Reason why the fastest cable is faster than its end at the platform.
fn fast_cable(planned: &Planned, samples: &MotionSamples, extremes: &[Extreme]) -> Option<String> {
    let fastest = extremes.iter().find(|of| of.what == SPEED)?;
    let speed = fastest.value?;
    let i = planned.robot.cables.iter().position(|cable| cable.name == fastest.cable)?;
    let k = (0..samples.times.len())
        .filter(|k| samples.times[*k].total_cmp(&fastest.t_s).is_eq())
        .find(|k| samples.winch(planned.robot, *k, i).speed.abs().total_cmp(&speed).is_eq())?;

    let point = &samples.motions[k].point;
    let [velocity, omega]: [Vec3; 2] = point.twist();
    let end = (velocity + omega.cross(&(point.pose.rot_wp * planned.robot.cables[i].attachment_p))).norm();
    (speed > FAST * end && speed > 1e-3).then(|| {
        format!(
            "cable \"{}\" runs at {} m/s while its end at the platform moves at {} m/s: its tension changes, and the \
             slack of its sag is wound in or paid out; higher tensions (⟪tension_rule⟫, ⟪min_tension_n⟫) or a smaller \
             jerk make it slower",
            fastest.cable,
            significant(speed, 3),
            significant(end, 3)
        )
    })
}

//! Jumps of a rule of tensions from pose to pose: `middle` and `stiffest` have several best tensions at some poses, and
//! go over from one to the other there (docs/theory.md, section 10).

use super::AtRest;
use crate::text::significant;
use funicular::math::{Vec3, Vec6};
use funicular::robot::{Pose, State};
use funicular::statics::{self, TensionRule};

/// Rules of tensions whose tensions are continuous from pose to pose.
pub(crate) const SMOOTH_RULES: &str = "`centre`, `lowest` or `closest`";

/// Distance from a pose within which jumps are looked for [m]; for a turn that of the attachments.
const NEARBY: f64 = 1e-3;

/// Number of parts of a way in each of which a jump is looked for.
const PARTS: usize = 60;

/// Number of halvings of such a part.
const HALVINGS: usize = 16;

/// Change of a tension, over the largest one, that can be a jump: rules are exact to a millionth, `stiffest` of the
/// stiffness, which leaves a thousandth of the tensions.
pub(crate) const MIN_TENSION: f64 = 2e-3;

/// Part of a change that a jump keeps at least, however near the two poses; a smooth change keeps an eighth after three
/// halvings.
pub(crate) const LEFT: f64 = 0.2;

/// Jump of the tension of a cable.
struct Jump {
    /// Part of the way at which it is.
    at: f64,
    cable: usize,
    /// Change of the tension [N].
    tension: f64,
}

impl AtRest {
    /// True if a rule chooses the tensions that can jump from pose to pose.
    pub(crate) fn has_rule_that_jumps(&self) -> bool {
        self.held_pose.is_none() && matches!(self.rule, Some(TensionRule::Middle | TensionRule::Stiffest))
    }

    /// Warning for rates and derivatives at the pose at rest: the nearest jump of the rule along a coordinate, or that
    /// there is none near.
    pub(crate) fn rule_near_jump(&self) -> Option<String> {
        if !self.has_rule_that_jumps() {
            return None;
        }
        let pose = self.equilibrium.pose;
        let motion = &self.robot.platform.motion;
        let length = self.robot.platform_length();
        let mut found: Option<(f64, Jump)> = None;
        for sign in [1.0, -1.0] {
            for k in 0..motion.count() {
                let step = if motion.is_rotation(k) { NEARBY / length } else { NEARBY };
                let unit = motion.expanded(&Vec6::ith(k, sign * step));
                let moved = |part: f64| {
                    let by = unit * part;
                    pose.moved(&Vec3::new(by[0], by[1], by[2]), &Vec3::new(by[3], by[4], by[5]))
                };
                let jump = self.first_jump(&mut |part| moved(part), 1);
                let nearer = |jump: &Jump| found.as_ref().is_none_or(|(_, last): &(f64, Jump)| jump.at < last.at);
                if let Some(jump) = jump.filter(nearer) {
                    found = Some((NEARBY * jump.at, jump));
                }
            }
        }
        let (distance, jump) = found?;
        Some(format!(
            "{} {} µm beside this pose the tension of cable \"{}\" jumps by {} N: rates and derivatives hold on this \
             side of the jump alone; take ⟪tension_rule⟫ {SMOOTH_RULES}",
            self.rule_name(),
            significant(1e6 * distance, 2),
            self.robot.cables[jump.cable].name,
            significant(jump.tension, 3)
        ))
    }

    /// Warning for lengths that follow from poses on a way by a rule that jumps there; `pose` gives the pose at a part
    /// of the way.
    pub(crate) fn rule_jumps_on_way(&self, pose: &mut dyn FnMut(f64) -> Pose, what: &str) -> Option<String> {
        if !self.has_rule_that_jumps() {
            return None;
        }
        let jump = self.first_jump(pose, PARTS)?;
        Some(format!(
            "{} at {} % of the {what} the tension of cable \"{}\" jumps by {} N, and the lengths with it; no winch \
             follows that: take ⟪tension_rule⟫ {SMOOTH_RULES}",
            self.rule_name(),
            significant(100.0 * jump.at, 4),
            self.robot.cables[jump.cable].name,
            significant(jump.tension, 3)
        ))
    }

    fn rule_name(&self) -> String {
        format!("the rule `{}` jumps:", self.rule.as_ref().map_or("", TensionRule::name))
    }

    /// First jump on a way in equal parts; poses that the cables do not hold are left out.
    fn first_jump(&self, pose: &mut dyn FnMut(f64) -> Pose, parts: usize) -> Option<Jump> {
        let rule = self.rule.clone()?;
        let mut tensions = |part: f64| -> Option<Vec<f64>> {
            let state = State::Pose(pose(part));
            let found = statics::solve_at(&self.robot, &state, self.equilibrium.model, &rule).ok()?.equilibrium;
            Some(found.cables.iter().map(|cable| cable.tension_platform).collect())
        };
        let mut last = tensions(0.0)?;
        for k in 0..parts {
            let ends = [k, k + 1].map(|k| k as f64 / parts as f64);
            let Some(next) = tensions(ends[1]) else { continue };
            let found = jump_between(&mut tensions, (ends[0], last), (ends[1], next.clone()));
            if found.is_some() {
                return found;
            }
            last = next;
        }
        None
    }
}

/// Jump between two parts of a way with their tensions.
fn jump_between(
    tensions: &mut dyn FnMut(f64) -> Option<Vec<f64>>,
    mut from: (f64, Vec<f64>),
    mut to: (f64, Vec<f64>),
) -> Option<Jump> {
    let change = |a: &[f64], b: &[f64]| {
        let each = a.iter().zip(b).map(|(a, b)| (b - a).abs()).enumerate();
        each.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, 0.0))
    };
    let (_, initial) = change(&from.1, &to.1);
    if initial < MIN_TENSION * to.1.iter().copied().fold(0.0, f64::max) {
        return None;
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (from.0 + to.0);
        let at = tensions(middle)?;
        if change(&from.1, &at).1 > change(&at, &to.1).1 {
            to = (middle, at);
        } else {
            from = (middle, at);
        }
        if change(&from.1, &to.1).1 < LEFT * initial {
            return None;
        }
    }
    let (cable, tension) = change(&from.1, &to.1);
    Some(Jump { at: to.0, cable, tension })
}

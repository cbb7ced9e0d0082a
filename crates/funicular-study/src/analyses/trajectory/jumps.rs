//! Times at which lengths or their rates jump, each with its cause.

use super::Planned;
use super::at_time::{in_motion, lengths};
use super::instants::Instant;
use crate::at_rest::{LEFT, MIN_TENSION};
use crate::text::significant;
use anyhow::Result;
use funicular::path::{PathCorner, Side};
use funicular::robot::Robot;
use funicular::statics::{Limit, TensionRule};
use funicular::trajectory::{AlongPath, InMotion, RATE_DIFFERENCE};

/// Number of halvings of the time between two samples in which a tension reaches a limit.
const HALVINGS: usize = 20;

/// Largest number of changes of limits between two samples, and on the whole path.
const MAX_CHANGES_BETWEEN: usize = 8;
pub(super) const MAX_CHANGES: usize = 100;

/// Parts between two samples at which a limit is looked for that may be reached and left within them: the middle first.
/// One that is reached for less than an eighth of the time changes the rates by little.
const PROBES: [f64; 7] = [0.5, 0.25, 0.75, 0.375, 0.625, 0.125, 0.875];

/// Multiple of the last change of a distance by which the next one may be larger: a parabola has up to 3 between
/// samples of equal distance about its end.
const NEXT_CHANGE: f64 = 3.0;

/// Part of the time between two samples that is too short to tell how a distance goes on.
const SHORT: f64 = 0.01;

/// Jump of a rate [m/s] and of a length [m] that counts: within the period of a servo, 1 ms, the first is 0.01 m/s² and
/// the second 10 µm/s. Rounding leaves 1e-8 m/s, and 1e-11 m.
const MIN_RATE: f64 = 1e-5;
const MIN_LENGTH: f64 = 1e-8;

/// Difference between the change of a length and the integral of its rate from which on a jump is looked for [m]: one
/// of 1 N in 10 m of rope with 1 MN is 10 µm.
const MIN_WAY: f64 = 1e-6;

/// Distance from a kink at which differences tell the rates on its side, over half the time between their ends.
const BESIDE: f64 = 1.5;

/// Least jump of rates that are differences [m/s], whose noise is 3e-4, and multiple of their change beside it.
const MIN_BEND: f64 = 3e-3;
const STEEPER: f64 = 3.0;

/// Largest number of jumps of a rule that are looked for inside each other.
const MAX_DEPTH: usize = 4;

/// Robot at one time of a path.
pub(super) type Sample = (Instant, InMotion);

/// Jump of lengths or of their rates.
pub(super) struct LengthJump {
    /// Index of the sample just before it; the next one is just after it.
    pub(super) before: usize,
    pub(super) time: f64,
    pub(super) cause: JumpCause,
    /// Jump of every length [m], of its rate [m/s], and of the tension at the platform [N].
    lengths: Vec<f64>,
    rates: Vec<f64>,
    tensions: Vec<f64>,
}

/// Cause of a jump.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum JumpCause {
    /// Derivative of the path of this order jumps.
    Path(usize),
    /// Tensions reach limits (true) or leave them.
    Limits(Vec<(usize, Limit, bool)>),
    /// Rule of tensions goes over to other tensions.
    Rule,
    /// Other conditions hold the tensions of a rule, none of them a limit: other margins are the smallest, or
    /// eigenvalues of the stiffness meet.
    Conditions,
}

impl LengthJump {
    /// Jump at a corner of the path between two samples; `None` within a phase, and where lengths and rates go on.
    pub(super) fn at_corner(planned: &Planned, last: &Sample, next: &Sample, before: usize) -> Option<Self> {
        if last.0.phase == next.0.phase {
            return None;
        }
        let time = next.0.time;
        let nearest = |a: &PathCorner, b: &PathCorner| (a.time - time).abs().total_cmp(&(b.time - time).abs());
        let order = planned.path.corners().into_iter().min_by(nearest)?.order;
        let jump = Self::of(&last.1, &next.1, time, JumpCause::Path(order), before - 1);
        (jump.rate_jumps().is_some() || jump.length_jumps().is_some()).then_some(jump)
    }

    fn of(last: &InMotion, next: &InMotion, time: f64, cause: JumpCause, before: usize) -> Self {
        let by = |a: Vec<f64>, b: Vec<f64>| a.iter().zip(b).map(|(a, b)| (b - a).abs()).collect();
        Self {
            before,
            time,
            cause,
            lengths: by(lengths(last), lengths(next)),
            rates: by(last.length_rates.clone(), next.length_rates.clone()),
            tensions: by(tensions(last), tensions(next)),
        }
    }

    /// True if a sample is just before this jump or just after it.
    pub(super) fn is_beside(&self, sample: usize) -> bool {
        sample == self.before || sample == self.before + 1
    }

    /// True if lengths go on, because only the conditions change that hold the tensions.
    pub(super) fn is_kink(&self) -> bool {
        matches!(self.cause, JumpCause::Limits(_) | JumpCause::Conditions)
    }

    /// True if the length of a cable jumps.
    pub(super) fn has_length_jump(&self, cable: usize) -> bool {
        !self.is_kink() && self.lengths[cable] > MIN_LENGTH
    }

    /// True if the rate of a cable has no bound, or jumps: its acceleration has none then.
    pub(super) fn has_rate_jump(&self, cable: usize) -> bool {
        self.rates[cable] > MIN_RATE || self.has_length_jump(cable)
    }

    /// Cable whose length jumps most, with the jump [m]; `None` if none does.
    pub(super) fn length_jumps(&self) -> Option<(usize, f64)> {
        largest(&self.lengths).filter(|(cable, _)| self.has_length_jump(*cable))
    }

    /// Cable whose rate jumps most, with the jump [m/s]; `None` if none does.
    pub(super) fn rate_jumps(&self) -> Option<(usize, f64)> {
        largest(&self.rates).filter(|(_, jump)| *jump > MIN_RATE)
    }

    /// Cable whose tension jumps most, with the jump [N].
    pub(super) fn tension_jump(&self) -> (usize, f64) {
        largest(&self.tensions).unwrap_or_default()
    }

    /// Cause as part of a sentence: "the jerk jumps".
    pub(super) fn because(&self, planned: &Planned) -> String {
        match &self.cause {
            JumpCause::Path(2) => "the acceleration of the platform jumps".to_owned(),
            JumpCause::Path(_) => "the jerk of the platform jumps".to_owned(),
            JumpCause::Rule => format!("the rule `{}` jumps to other tensions", planned.rule.name()),
            JumpCause::Conditions => match &planned.rule {
                TensionRule::Stiffest => "stiffnesses meet or part under the rule `stiffest`".to_owned(),
                rule => format!("other margins become the smallest under the rule `{}`", rule.name()),
            },
            JumpCause::Limits(changes) => {
                let (cable, limit, reached) = changes[0];
                format!(
                    "cable \"{}\" {} its {} tension under the rule `{}`",
                    planned.robot.cables[cable].name,
                    if reached { "reaches" } else { "leaves" },
                    limit.name(),
                    planned.rule.name()
                )
            }
        }
    }

    /// Place and size as part of a sentence.
    pub(super) fn told(&self, robot: &Robot) -> String {
        let (what, (cable, jump), unit) = match (self.length_jumps(), self.rate_jumps()) {
            _ if self.cause == JumpCause::Rule => ("tension", self.tension_jump(), "N"),
            (Some(of), _) => ("length", of, "m"),
            (None, Some(of)) => ("rate", of, "m/s"),
            (None, None) => ("rate", (0, 0.0), "m/s"),
        };
        format!(
            "at {} s the {what} of cable \"{}\" jumps by {} {unit}",
            significant(self.time, 4),
            robot.cables[cable].name,
            significant(jump, 3)
        )
    }
}

/// Tensions at the platform [N].
fn tensions(of: &InMotion) -> Vec<f64> {
    of.equilibrium.cables.iter().map(|cable| cable.tension_platform).collect()
}

fn largest(of: &[f64]) -> Option<(usize, f64)> {
    of.iter().copied().enumerate().max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Samples on both sides of every time between two samples at which a tension of choice reaches a limit or leaves it;
/// the first of each pair has the jump.
///
/// # Errors
/// A time at which the cables do not hold the platform.
pub(super) fn between(
    along: &mut AlongPath,
    planned: &Planned,
    known: &[Sample],
    next: &Sample,
    found: usize,
) -> Result<Vec<(Sample, Option<LengthJump>)>> {
    let Some((last, before)) = known.split_last() else { return Ok(Vec::new()) };
    // Tensions that are no matter of choice pass their limits smoothly.
    if !planned.judged.choice || last.0.phase != next.0.phase || found >= MAX_CHANGES {
        return Ok(Vec::new());
    }

    let comes_near = may_change(before.last(), [last, next]);
    let Some(inside) = reached_between(along, planned, comes_near, [last, next])? else {
        let mut samples = of_changes(along, planned, last, next)?;
        if samples.is_empty() && comes_near == Some(true) && next.1.no_exact_rates.is_some() {
            samples = bent_between(along, planned, [last, next])?;
        }
        return Ok(samples);
    };
    let mut samples = of_changes(along, planned, last, &inside)?;
    samples.push((inside.clone(), None));
    samples.extend(of_changes(along, planned, &inside, next)?);
    Ok(samples)
}

/// True if other conditions come so near that they may hold the tensions for a moment between two samples, as the
/// changes since the sample before tell; `None` without that sample.
fn may_change(before: Option<&Sample>, [last, next]: [&Sample; 2]) -> Option<bool> {
    let whole = next.0.time - last.0.time;
    // Both sides of a jump tell no change, and the path bends at its corners.
    let before = before.filter(|of| of.0.phase == last.0.phase && last.0.time - of.0.time > SHORT * whole)?;
    let times = whole / (last.0.time - before.0.time);
    let mut pairs = before.1.distances.iter().zip(&last.1.distances);
    let is_near = |(before, last): (&f64, &f64)| *last < NEXT_CHANGE * times * (before - last);
    Some(!before.1.held.are_alike(&last.1.held) || pairs.any(is_near))
}

/// Sample between two at which other conditions hold the tensions than at both of them: a limit is reached and left,
/// say. `None` if there is none.
fn reached_between(
    along: &mut AlongPath,
    planned: &Planned,
    comes_near: Option<bool>,
    [last, next]: [&Sample; 2],
) -> Result<Option<Sample>> {
    if !last.1.held.are_alike(&next.1.held) {
        return Ok(None);
    }

    let whole = next.0.time - last.0.time;
    let probes = match comes_near {
        Some(true) => &PROBES[..],
        Some(false) => &[],
        None => &PROBES[..1],
    };
    for part in probes {
        let time = last.0.time + part * whole;
        let at = (Instant { time, is_row: false, ..last.0 }, in_motion(along, planned, time, Side::After)?);
        if !at.1.held.are_alike(&last.1.held) {
            return Ok(Some(at));
        }
    }
    Ok(None)
}

/// Samples on both sides of a bend of tensions whose rates are differences: stiffnesses that touch for a moment are the
/// same ones before and after.
fn bent_between(
    along: &mut AlongPath,
    planned: &Planned,
    [last, next]: [&Sample; 2],
) -> Result<Vec<(Sample, Option<LengthJump>)>> {
    let mut at = |time: f64| -> Result<Sample> {
        let instant = Instant { time, is_row: false, side: Side::After, ..last.0 };
        Ok((instant, in_motion(along, planned, time, Side::After)?))
    };
    let (mut from, mut to) = (last.clone(), next.clone());
    let beside = BESIDE * RATE_DIFFERENCE;
    while to.0.time - from.0.time > 2.0 * beside {
        let middle = at(0.5 * (from.0.time + to.0.time))?;
        if rate_change(&from, &middle) > rate_change(&middle, &to) { to = middle } else { from = middle }
    }

    let time = 0.5 * (from.0.time + to.0.time);
    let ends = [time - 3.0 * beside, time - beside, time + beside, time + 3.0 * beside];
    if ends[0] <= last.0.time || ends[3] >= next.0.time {
        return Ok(Vec::new());
    }
    let [before, from, to, after] = [at(ends[0])?, at(ends[1])?, at(ends[2])?, at(ends[3])?];
    let smooth = rate_change(&before, &from).max(rate_change(&to, &after));
    if rate_change(&from, &to) < MIN_BEND + STEEPER * smooth {
        return Ok(Vec::new());
    }
    let jump = LengthJump::of(&from.1, &to.1, time, JumpCause::Conditions, 0);
    Ok(vec![(from, Some(jump)), (to, None)])
}

/// Largest change of a rate between two samples [m/s].
fn rate_change(a: &Sample, b: &Sample) -> f64 {
    let pairs = a.1.length_rates.iter().zip(&b.1.length_rates);
    pairs.map(|(a, b)| (b - a).abs()).fold(0.0, f64::max)
}

/// Samples on both sides of the jumps between two samples, as [`between`] returns them.
fn of_changes(
    along: &mut AlongPath,
    planned: &Planned,
    last: &Sample,
    next: &Sample,
) -> Result<Vec<(Sample, Option<LengthJump>)>> {
    let mut samples = Vec::new();
    if matches!(planned.rule, TensionRule::Middle | TensionRule::Stiffest) {
        samples = of_rule(along, planned, last, next, MAX_DEPTH)?;
    }
    let mut last = samples.last().map_or_else(|| last.clone(), |(sample, _): &(Sample, _)| sample.clone());
    for _ in 0..MAX_CHANGES_BETWEEN {
        if last.1.held.are_alike(&next.1.held) {
            break;
        }
        let (mut from, mut to) = (last.clone(), next.clone());
        for _ in 0..HALVINGS {
            let time = 0.5 * (from.0.time + to.0.time);
            let at = (Instant { time, is_row: false, ..from.0 }, in_motion(along, planned, time, Side::After)?);
            if at.1.held.are_alike(&from.1.held) { from = at } else { to = at }
        }
        if from.1.held.are_alike(&to.1.held) {
            break;
        }
        let limits = changes(&from.1, &to.1);
        let cause = if limits.is_empty() { JumpCause::Conditions } else { JumpCause::Limits(limits) };
        let told = to.clone();
        let (from, to) = around_kink(along, planned, (&last, next), (from, to))?;
        let jump = LengthJump::of(&from.1, &to.1, to.0.time, cause, 0);
        // A limit that is left counts as reached for a moment after the kink.
        last = if told.0.time > to.0.time { told } else { to.clone() };
        samples.push((from, Some(jump)));
        samples.push((to, None));
    }
    Ok(samples)
}

/// Samples on both sides of the time at which the rates jump, near those between which a limit counts as reached or
/// left: this is told within a millionth of the limit, some microseconds beside it.
fn around_kink(
    along: &mut AlongPath,
    planned: &Planned,
    (first, end): (&Sample, &Sample),
    near: (Sample, Sample),
) -> Result<(Sample, Sample)> {
    let mut at = |time: f64| -> Result<Sample> {
        // At the end of a phase the motion before it counts.
        let side = if time < end.0.time { Side::After } else { end.0.side };
        let instant = Instant { time, side, is_row: false, ..first.0 };
        Ok((instant, in_motion(along, planned, time, side)?))
    };

    // Rates that are differences have to lie on their side.
    if near.0.1.no_exact_rates.is_some() || near.1.1.no_exact_rates.is_some() {
        let beside = BESIDE * RATE_DIFFERENCE;
        let ends = [(near.0.0.time - beside).max(first.0.time), (near.1.0.time + beside).min(end.0.time)];
        return Ok((at(ends[0])?, at(ends[1])?));
    }

    // The rates of a smooth motion change in proportion to the time, those at a kink by as much in less of it.
    let whole = end.0.time - first.0.time;
    let mut best: Option<(f64, Sample, Sample)> = None;
    for halvings in (0..=HALVINGS).step_by(2) {
        let beside = whole * 0.5_f64.powi(i32::try_from(halvings).unwrap_or(i32::MAX));
        let ends = [(near.0.0.time - beside).max(first.0.time), (near.1.0.time + beside).min(end.0.time)];
        let (from, to) = (at(ends[0])?, at(ends[1])?);
        let steepness = rate_change(&from, &to) / (ends[1] - ends[0]);
        if best.as_ref().is_none_or(|(last, ..)| steepness > *last) {
            best = Some((steepness, from, to));
        }
    }
    let Some((_, mut from, mut to)) = best else { return Ok(near) };
    for _ in 0..HALVINGS {
        if to.0.time - from.0.time <= whole * 0.5_f64.powi(i32::try_from(HALVINGS).unwrap_or(i32::MAX)) {
            break;
        }
        let middle = at(0.5 * (from.0.time + to.0.time))?;
        if rate_change(&from, &middle) > rate_change(&middle, &to) { to = middle } else { from = middle }
    }
    Ok((from, to))
}

/// Samples on both sides of every jump of a rule between two samples: where the tensions change as much within ever
/// shorter times. Kinks and steep changes become smaller.
fn of_rule(
    along: &mut AlongPath,
    planned: &Planned,
    last: &Sample,
    next: &Sample,
    depth: usize,
) -> Result<Vec<(Sample, Option<LengthJump>)>> {
    let changes = |a: &Sample, b: &Sample| {
        let pairs = tensions(&a.1).into_iter().zip(tensions(&b.1));
        pairs.map(|(a, b)| (b - a).abs()).fold(0.0, f64::max)
    };
    let initial = changes(last, next);
    if depth == 0 || initial < MIN_TENSION * tensions(&next.1).into_iter().fold(0.0, f64::max) || fits(last, next) {
        return Ok(Vec::new());
    }

    let (mut from, mut to) = (last.clone(), next.clone());
    for _ in 0..HALVINGS {
        let time = 0.5 * (from.0.time + to.0.time);
        let at = (Instant { time, is_row: false, ..from.0 }, in_motion(along, planned, time, Side::After)?);
        if changes(&from, &at) > changes(&at, &to) {
            to = at;
        } else {
            from = at;
        }
        if changes(&from, &to) < LEFT * initial {
            return Ok(Vec::new());
        }
    }
    for of in [&mut from, &mut to] {
        of.0.is_row = false;
    }
    let mut found = of_rule(along, planned, last, &from, depth - 1)?;
    let after = of_rule(along, planned, &to, next, depth - 1)?;
    let jump = LengthJump::of(&from.1, &to.1, to.0.time, JumpCause::Rule, 0);
    found.push((from, Some(jump)));
    found.push((to, None));
    found.extend(after);
    Ok(found)
}

/// True if the lengths change between two samples as their rates say: by the trapezoidal rule.
fn fits(last: &Sample, next: &Sample) -> bool {
    let time = next.0.time - last.0.time;
    let rates = last.1.length_rates.iter().zip(&next.1.length_rates);
    let ways = lengths(&last.1).into_iter().zip(lengths(&next.1)).map(|(a, b)| b - a);
    rates.zip(ways).all(|((a, b), way)| (way - 0.5 * time * (a + b)).abs() < MIN_WAY)
}

/// Limits that are left and reached between two samples.
fn changes(before: &InMotion, after: &InMotion) -> Vec<(usize, Limit, bool)> {
    let pairs = before.held.at_limit.iter().zip(&after.held.at_limit).enumerate();
    let each = pairs
        .filter(|(_, (before, after))| before != after)
        .flat_map(|(i, (before, after))| [before.map(|limit| (i, limit, false)), after.map(|limit| (i, limit, true))]);
    each.flatten().collect()
}

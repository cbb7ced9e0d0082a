//! Maximum contribution of cables within their limits to a wrench in one direction, along their true curves.

use super::cable_at_pose::CableAtPose;
use crate::math::{Vec3, Vec6};
use crate::robot::PlatformMotion;

/// Maximum number of intervals halved for one direction.
const MAX_HALVINGS: usize = 100;

/// Sine of a chord's inclination up to which the unstrained length counts as a convex function of the tension; it is
/// one up to 0.98.
const STEEP: f64 = 0.95;

/// Relative distance within which a tension counts as the slackest one, and a minimum as its tension.
const AT_SLACKEST: f64 = 1e-9;

/// Rounding of the sum of all contributions, relative to their magnitudes.
const ROUNDING: f64 = 1e-12;

/// Wrenches of the cables for all tensions within their limits; reduced.
pub(in crate::statics) struct WrenchSet<'a> {
    pub reaches: &'a [ReachableTensions],
    pub motion: PlatformMotion,
}

impl WrenchSet<'_> {
    /// Upper bound of the contribution of all cables in the direction `y` [N, in the unit of y], and the tensions τ
    /// that contribute most [N].
    pub(in crate::statics) fn reach(&self, y: &Vec6) -> (f64, Vec<f64>) {
        let (mut bound, mut tensions) = (0.0, Vec::with_capacity(self.reaches.len()));
        for reach in self.reaches {
            let seen = reach.seen(y, &self.motion);
            let end = |k: usize| SharePoint::of(&reach.ends[k], y, &seen, &self.motion);
            let mut parts = vec![TauInterval { cable: 0, ends: [end(0), end(1)] }];
            let mut best = parts[0].best();
            for _ in 0..MAX_HALVINGS {
                let excess = |part: &TauInterval| part.bound(&seen) - best.share();
                let widest = (0..parts.len()).max_by(|&a, &b| excess(&parts[a]).total_cmp(&excess(&parts[b])));
                let Some(widest) = widest.filter(|at| excess(&parts[*at]) > ROUNDING * best.share().abs()) else {
                    break;
                };
                let [from, to] = parts[widest].ends;
                let mut there = reach.ends[0].clone();
                there.set((from.tau * to.tau).sqrt());
                let middle = SharePoint::of(&there, y, &seen, &self.motion);
                if middle.share() > best.share() {
                    best = middle;
                }
                parts[widest].ends = [from, middle];
                parts.push(TauInterval { cable: 0, ends: [middle, to] });
            }
            bound += parts.iter().map(|part| part.bound(&seen)).fold(best.share(), f64::max);
            tensions.push(best.tau);
        }
        (bound, tensions)
    }

    /// Reach in the direction `y` with cables that may also be slacker than (37), by an upper bound; infinite where the
    /// weight of rope that hangs ever deeper pulls that way.
    pub(in crate::statics) fn reach_with_slack(&self, y: &Vec6) -> f64 {
        let (taut, _) = self.reach(y);
        let slack = self.reaches.iter().map(|reach| reach.slack_excess(y, &self.motion));
        taut + slack.sum::<f64>()
    }

    /// Cables whose minimum tension would allow them to be slacker than (37).
    pub(in crate::statics) fn may_be_slacker(&self) -> bool {
        self.reaches.iter().any(ReachableTensions::may_be_slacker)
    }

    /// True if the direction `y` proves that no tensions balance a load, with the points of maximum contribution of the
    /// cables in this direction.
    pub(in crate::statics) fn separates(&self, y: &Vec6, load: &Vec6) -> (bool, Vec<SharePoint>) {
        let mut parts: Vec<TauInterval> = Vec::with_capacity(self.reaches.len());
        let seen: Vec<DirectionalShare> = self.reaches.iter().map(|reach| reach.seen(y, &self.motion)).collect();
        for (cable, reach) in self.reaches.iter().enumerate() {
            let end = |k: usize| SharePoint::of(&reach.ends[k], y, &seen[cable], &self.motion);
            parts.push(TauInterval { cable, ends: [end(0), end(1)] });
        }
        let mut best: Vec<SharePoint> = parts.iter().map(TauInterval::best).collect();
        let own = y.dot(load);
        let size = own.abs() + best.iter().map(|point| point.share().abs()).sum::<f64>();

        for _ in 0..=MAX_HALVINGS {
            // The sum of all upper bounds decides, …
            let mut bounds: Vec<f64> = best.iter().map(SharePoint::share).collect();
            for part in &parts {
                bounds[part.cable] = bounds[part.cable].max(part.bound(&seen[part.cable]));
            }
            if own + bounds.iter().sum::<f64>() < -ROUNDING * size {
                return (true, best);
            }

            // … or the sum of contributions that the cables do reach.
            if own + best.iter().map(SharePoint::share).sum::<f64>() >= -ROUNDING * size {
                break;
            }

            // Between the two, halve the interval with the largest uncertainty.
            let excess = |part: &TauInterval| part.bound(&seen[part.cable]) - best[part.cable].share();
            let widest = (0..parts.len()).max_by(|&a, &b| excess(&parts[a]).total_cmp(&excess(&parts[b])));
            let Some(widest) = widest else { break };
            let TauInterval { cable, ends: [from, to] } = parts[widest];
            let mut there = self.reaches[cable].ends[0].clone();
            there.set((from.tau * to.tau).sqrt());
            let middle = SharePoint::of(&there, y, &seen[cable], &self.motion);
            if middle.share() > best[cable].share() {
                best[cable] = middle;
            }
            parts[widest].ends = [from, middle];
            parts.push(TauInterval { cable, ends: [middle, to] });
        }
        (false, best)
    }
}

/// Range of a cable's tension.
#[derive(Debug, Clone)]
pub(in crate::statics) struct ReachableTensions {
    /// Cable at the minimum τ within its limits, not slacker than (37), and at the maximum.
    ends: [CableAtPose; 2],
}

impl ReachableTensions {
    /// Range of a cable in any state; `minimum` is its [`CableAtPose::at_minimum`].
    pub(in crate::statics) fn of(cable: &CableAtPose, minimum: f64) -> Self {
        let mut ends = [cable.clone(), cable.clone()];
        ends[0].set(minimum);
        ends[1].at_maximum();
        // The limits may be narrower than the variation of tension along a heavy rope.
        if ends[1].tau() < minimum {
            ends[1].set(minimum);
        }
        Self { ends }
    }

    /// True if the slackest state that (37) allows is within the limit of the minimum tension.
    pub(in crate::statics) fn may_be_slacker(&self) -> bool {
        let cable = &self.ends[0];
        let is_slackest = cable.slackest > 0.0 && cable.tau() <= cable.slackest * (1.0 + AT_SLACKEST);
        is_slackest && cable.min_tension().value > cable.range.minimum * (1.0 + AT_SLACKEST)
    }

    /// Bound of what a slacker cable contributes in the direction `y` beyond the slackest state that (37) allows [N, in
    /// the unit of y]. Its horizontal force is smaller than there; its vertical force on the platform falls with it if
    /// the anchor is above, and points down if the anchor is below.
    fn slack_excess(&self, y: &Vec6, motion: &PlatformMotion) -> f64 {
        if !self.may_be_slacker() {
            return 0.0;
        }
        let cable = &self.ends[0];
        let (force_w, up_w) = (cable.force().0, cable.hanging.axes_w().1);
        let in_direction = |force_w: &Vec3| y.dot(&motion.reduced(&cable.wrench(force_w)));
        let (vertical, upward) = (force_w.dot(&up_w), in_direction(&up_w));
        if upward < 0.0 {
            return f64::INFINITY;
        }
        let horizontal = in_direction(&(force_w - up_w * vertical));
        let highest = if cable.sin() >= 0.0 { vertical } else { vertical.max(0.0) };
        (horizontal.max(0.0) + upward * highest - in_direction(&force_w)).max(0.0)
    }

    fn seen(&self, y: &Vec6, motion: &PlatformMotion) -> DirectionalShare {
        let cable = &self.ends[0];
        let in_direction = |force_w: &Vec3| y.dot(&motion.reduced(&cable.wrench(force_w)));
        let upward = in_direction(&cable.hanging.axes_w().1);
        let along = in_direction(&cable.hanging.chord_w().normalize());
        DirectionalShare::new(along, upward, cable.weight_per_length(), cable.sin())
    }

    /// Wrenches at the minimum and at the maximum, reduced [N].
    pub(in crate::statics) fn wrenches(&self, motion: &PlatformMotion) -> [Vec6; 2] {
        [0, 1].map(|k| motion.reduced(&self.ends[k].wrench(&self.ends[k].force().0)))
    }

    /// Minimum and maximum τ [N].
    pub(in crate::statics) fn limits(&self) -> [f64; 2] {
        [self.ends[0].tau(), self.ends[1].tau()]
    }
}

/// Start number `k` of a search: tensions τ that spread over the ranges, evenly in their logarithms [N]. `size` is the
/// reference size of the tensions.
pub(in crate::statics) fn spread_start(reaches: &[ReachableTensions], size: f64, k: usize) -> Vec<f64> {
    let tensions = reaches.iter().enumerate().map(|(i, reach)| {
        let [low, high] = reach.limits();
        // Without a maximum, the upper end of the range is too high for a start.
        let high = if reach.ends[0].range.maximum.is_infinite() { high.min(size.max(2.0 * low)) } else { high };
        let low = low.max(f64::MIN_POSITIVE);
        // Multiples of irrational numbers have no pattern (Weyl).
        let part = ((k as f64 + 1.0) * (i as f64 + 2.0).sqrt() * std::f64::consts::E).fract();
        low * (high / low).max(1.0).powf(part)
    });
    tensions.collect()
}

/// Contribution of a cable in one direction: `along τ + b D(τ) − ½ b w L0(τ)`, see (39b).
#[derive(Debug, Clone, Copy)]
struct DirectionalShare {
    /// Contribution per τ of a straight cable.
    along: f64,
    /// Factor of the length, `−½ b w` [N/m, in the unit of y].
    of_length: f64,
    /// True if D enters as a convex function.
    convex_bend: bool,
    /// True if the length may not be a convex function of the tension.
    steep: bool,
}

/// Contribution of a cable at one τ.
#[derive(Debug, Clone, Copy)]
pub(in crate::statics) struct SharePoint {
    /// Tension τ [N].
    pub tau: f64,
    /// Wrench of the cable, scaled, in the platform's coordinates.
    pub wrench: Vec6,
    /// Straight part, `along τ`.
    straight: f64,
    /// Contributions of D and of the length, each with its derivative with respect to τ.
    bend: [f64; 2],
    length: [f64; 2],
}

impl DirectionalShare {
    /// Contribution of a cable whose chord has this inclination; a unit force along the chord and one upwards
    /// contribute `along` and `upward`.
    fn new(along: f64, upward: f64, weight_per_length: f64, sin: f64) -> Self {
        Self {
            along,
            of_length: -0.5 * upward * weight_per_length,
            convex_bend: upward * sin >= 0.0,
            steep: sin.abs() > STEEP,
        }
    }
}

/// Cable at one τ.
#[derive(Debug, Clone, Copy)]
pub(in crate::statics) struct CurvePoint {
    /// Tension τ [N].
    pub tau: f64,
    /// Wrench and its derivative by τ, reduced.
    pub wrench: Vec6,
    pub by_tau: Vec6,
    /// Unstrained length and its derivative by τ.
    pub length: [f64; 2],
}

/// Cable whose exit point is held, between two τ.
#[derive(Debug, Clone, Copy)]
pub(in crate::statics) struct CurveBetween {
    /// Wrench of a unit force along the chord, and of one upwards, reduced.
    pub chord: Vec6,
    pub up: Vec6,
    pub weight_per_length: f64,
    /// Sine of the inclination of the chord.
    pub sin: f64,
    pub ends: [CurvePoint; 2],
}

impl CurveBetween {
    /// Upper bound of the contribution in the direction `y` at any τ between the ends, (39b).
    pub(in crate::statics) fn bound(&self, y: &Vec6) -> f64 {
        let seen = DirectionalShare::new(y.dot(&self.chord), y.dot(&self.up), self.weight_per_length, self.sin);
        let ends = [0, 1].map(|k| SharePoint::at(&self.ends[k], y, &seen));
        let interval = TauInterval { cable: 0, ends };
        interval.bound(&seen).max(interval.best().share())
    }
}

impl SharePoint {
    fn of(cable: &CableAtPose, y: &Vec6, seen: &DirectionalShare, motion: &PlatformMotion) -> Self {
        let point = CurvePoint {
            tau: cable.tau(),
            wrench: motion.reduced(&cable.wrench(&cable.force().0)),
            by_tau: motion.reduced(&cable.column()),
            length: cable.length(),
        };
        Self::at(&point, y, seen)
    }

    fn at(point: &CurvePoint, y: &Vec6, seen: &DirectionalShare) -> Self {
        let CurvePoint { tau, wrench, .. } = *point;
        let straight = seen.along * tau;
        let length = point.length.map(|value| seen.of_length * value);
        let slope = y.dot(&point.by_tau);
        let bend = [y.dot(&wrench) - straight - length[0], slope - seen.along - length[1]];
        Self { tau, wrench, straight, bend, length }
    }

    fn share(&self) -> f64 {
        self.straight + self.bend[0] + self.length[0]
    }
}

/// Interval of a cable's τ.
#[derive(Debug, Clone, Copy)]
struct TauInterval {
    cable: usize,
    ends: [SharePoint; 2],
}

impl TauInterval {
    /// Upper bound of the contribution between the ends: (39b).
    fn bound(&self, seen: &DirectionalShare) -> f64 {
        let [from, to] = &self.ends;
        let width = to.tau - from.tau;

        // Straight lines above each part, by their values at both ends: a convex part is below its chord, a concave one
        // below the tangent at either end.
        let lines = |[p, q]: [[f64; 2]; 2], convex: bool| {
            if convex { [[p[0], q[0]]; 2] } else { [[p[0], p[0] + p[1] * width], [q[0] - q[1] * width, q[0]]] }
        };
        let bends = lines([from.bend, to.bend], seen.convex_bend);
        let lengths = if seen.steep {
            // It is only known that the length falls.
            [[from.length[0].max(to.length[0]); 2]; 2]
        } else {
            lines([from.length, to.length], seen.of_length >= 0.0)
        };

        // Minimum of the sums.
        let above = |bend: &[f64; 2], length: &[f64; 2]| {
            (from.straight + bend[0] + length[0]).max(to.straight + bend[1] + length[1])
        };
        let sums = bends.iter().flat_map(|bend| lengths.iter().map(move |length| above(bend, length)));
        sums.fold(f64::INFINITY, f64::min)
    }

    fn best(&self) -> SharePoint {
        let [from, to] = self.ends;
        if from.share() > to.share() { from } else { to }
    }
}

//! Tensions under a controller that commands lengths alone: they follow from the stretch of the cables, and a cable may
//! go slack.

use super::Planned;
use super::samples::MotionSamples;
use crate::rows::rows;
use crate::text::significant;
use funicular::path::{PathPoint, Side};
use funicular::statics::{self, CableState, Equilibrium};
use funicular::trajectory::AlongPath;

/// Largest number of times at which the equilibrium with the commanded lengths is computed.
const MAX_TIMES: usize = 201;

/// Number of halvings of the interval in which a cable goes slack: a billionth of it is left.
const HALVINGS: usize = 30;

rows! {
    /// Tensions under a controller that commands lengths alone.
    #[derive(Debug, Clone)]
    pub struct LengthCommand {
        /// `computed` with stretch and sag, or `geometric`: the straight distances at the pose.
        pub lengths: &'static str;
        /// Cables that go slack, in the order of time.
        pub slack: Vec<SlackCable>;
        pub lowest_tension_n: f64;
        pub lowest_cable: String;
        pub lowest_t_s: f64;
        /// Largest distance of the platform from its path.
        pub displacement_m: f64;
        /// First time from which on the lengths hold the platform nowhere near; absent if they always do.
        pub lost_t_s: Option<f64>;
        /// Sentence with these numbers.
        pub told: String;
    }
}

rows! {
    /// Cable that goes slack.
    #[derive(Debug, Clone)]
    pub struct SlackCable {
        pub cable: String;
        /// First time.
        pub t_s: f64;
    }
}

/// True for a cable that is slack: one without weight that is longer than its chord, or one that is so loose that its
/// weight is more than its tension; it then sags by more than an eighth of its span.
fn is_slack(cable: &CableState) -> bool {
    let hangs = |hanging: &funicular::catenary::space::HangingCable| {
        let rope = hanging.catenary.rope();
        hanging.catenary.parallel_tension() < rope.weight_per_length * rope.unstrained_length
    };
    cable.is_slack() || cable.hanging.as_ref().is_some_and(hangs)
}

/// Commands of a controller for a robot with more cables than degrees of freedom: with computed lengths, and with
/// geometric ones.
pub(super) fn of(planned: &Planned, samples: &MotionSamples) -> Vec<LengthCommand> {
    if !planned.robot.constraint().is_redundant() {
        return Vec::new();
    }
    let (last, parts) = (samples.rows.len() - 1, MAX_TIMES - 1);
    let chosen = |k: usize| if last <= parts { k } else { (k * last + parts / 2) / parts };
    let rows: Vec<usize> = (0..=last.min(parts)).map(|k| samples.rows[chosen(k)]).collect();

    let computed = rows.iter().map(|k| (samples.times[*k], Some(samples.motions[*k].equilibrium.clone()), 0.0));
    let computed = FoundTensions::of(planned, computed.collect());
    let mut along = planned.along();
    let geometric = rows.iter().map(|k| held(planned, &mut along, samples.times[*k], &samples.motions[*k].point));
    let mut geometric = FoundTensions::of(planned, geometric.collect());
    geometric.narrow(planned, &mut along);
    vec![computed.told(planned, "computed"), geometric.told(planned, "geometric")]
}

/// Time, equilibrium with the commanded lengths, and distance of the platform from its path.
type AtTime = (f64, Option<Equilibrium>, f64);

/// Equilibrium with the straight distances at a pose as unstrained lengths.
fn held(planned: &Planned, along: &mut AlongPath, time: f64, point: &PathPoint) -> AtTime {
    let lengths: Vec<f64> = planned.robot.cables.iter().map(|cable| cable.straight_length(&point.pose)).collect();
    let found = statics::forward(along.loaded_at(point), &lengths, planned.model, Some(&point.pose)).ok();
    let moved = found.as_ref().map_or(0.0, |found| (found.pose.position_w - point.pose.position_w).norm());
    (time, found, moved)
}

/// Slack cables, tensions and displacements on a path.
struct FoundTensions {
    at: Vec<AtTime>,
    /// For each cable the time before it goes slack, if there is one, and the first at which it is slack.
    slack: Vec<Option<(Option<f64>, f64)>>,
}

impl FoundTensions {
    fn of(planned: &Planned, at: Vec<AtTime>) -> Self {
        let first = |i: usize| {
            let slack = |of: &AtTime| of.1.as_ref().is_some_and(|found| is_slack(&found.cables[i]));
            let k = at.iter().position(slack)?;
            Some((k.checked_sub(1).map(|before| at[before].0), at[k].0))
        };
        Self { slack: (0..planned.robot.cables.len()).map(first).collect(), at }
    }

    /// Narrows the times at which cables go slack down.
    fn narrow(&mut self, planned: &Planned, along: &mut AlongPath) {
        for (i, of) in self.slack.iter_mut().enumerate() {
            let Some((Some(before), after)) = of else { continue };
            for _ in 0..HALVINGS {
                let middle = 0.5 * (*before + *after);
                let point = planned.path.beside(middle, Side::After);
                match held(planned, along, middle, &point).1 {
                    Some(found) if !is_slack(&found.cables[i]) => *before = middle,
                    _ => *after = middle,
                }
            }
        }
    }

    /// Result with its sentence.
    fn told(&self, planned: &Planned, lengths: &'static str) -> LengthCommand {
        let name = |i: usize| planned.robot.cables[i].name.clone();
        let mut slack: Vec<SlackCable> = (0..self.slack.len())
            .filter_map(|i| self.slack[i].map(|(_, t_s)| SlackCable { cable: name(i), t_s }))
            .collect();
        slack.sort_by(|a, b| a.t_s.total_cmp(&b.t_s));

        let tensions = self.at.iter().flat_map(|(time, found, _)| {
            let cables = found.iter().flat_map(|found| found.cables.iter().enumerate());
            cables.map(move |(i, cable)| (cable.tension_platform.min(cable.tension_anchor), i, *time))
        });
        let lowest = tensions.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((0.0, 0, 0.0));
        let mut command = LengthCommand {
            lengths,
            lowest_tension_n: lowest.0,
            lowest_cable: name(lowest.1),
            lowest_t_s: lowest.2,
            displacement_m: self.at.iter().map(|of| of.2).fold(0.0, f64::max),
            lost_t_s: self.at.iter().find(|of| of.1.is_none()).map(|of| of.0),
            slack,
            told: String::new(),
        };
        command.told = command.sentence();
        command
    }
}

impl LengthCommand {
    fn sentence(&self) -> String {
        let with = match self.lengths {
            "computed" => "with the computed lengths (stretch and sag)",
            _ => "with the geometric lengths (straight, without stretch)",
        };
        let slack: Vec<String> = self
            .slack
            .iter()
            .map(|of| format!("cable \"{}\" goes slack at t = {} s", of.cable, significant(of.t_s, 4)))
            .collect();
        let slack = if slack.is_empty() {
            format!(
                "no cable goes slack; lowest tension {} N, cable \"{}\", at t = {} s",
                significant(self.lowest_tension_n, 4),
                self.lowest_cable,
                significant(self.lowest_t_s, 4)
            )
        } else {
            slack.join(", ")
        };
        let moved = match (self.lengths, self.lost_t_s) {
            (_, Some(time)) => {
                format!(
                    "; from t = {} s on there are times at which they do not hold the platform",
                    significant(time, 4)
                )
            }
            ("computed", None) => String::new(),
            (_, None) => {
                format!("; the platform is up to {} mm off its path", significant(1e3 * self.displacement_m, 3))
            }
        };
        format!("a controller that commands lengths alone, {with}: {slack}{moved}")
    }
}

//! Results of `uncertainty` as data.

use super::position::PositionDeviation;
use crate::analyses::fields;
use crate::analyses::shared::Models;
use crate::columns::{Columns, ResultTable, Style, Tabled, any, column, only_read, parts};
use crate::rows::rows;
use crate::table::Column;
use crate::text::{digits_for, significant};

rows! {
    /// Results of `uncertainty`.
    pub struct Uncertainties {
        pub robot: String = hidden;
        pub models: Models = spread;
        /// Quantity that is held while the numbers deviate: `lengths` or `pose`.
        pub held: &'static str;
        /// Sentence that says what is held, and by which rule the rest follows.
        pub held_means: &'static str;
        /// Frequency response among the results.
        pub response: Option<UncertainResponse>;
        /// Numbers that deviate.
        pub inputs: Vec<UncertainInput>;
        /// Groups of numbers, one per option.
        pub groups: Vec<InputGroup>;
        /// Number of sampled robots per pose that needs them.
        pub samples: usize;
        /// Number of robots that were computed for the samples and the corners of the tolerances.
        pub evaluations: usize;
        /// Notes on the accuracy.
        pub notes: Vec<String>;
        /// Results at each pose.
        pub poses: Vec<PoseUncertainty>;
        pub warnings: Vec<String> = hidden;
    }
}

rows! {
    /// Frequency response whose magnitudes and phases are results.
    #[derive(Debug, Clone)]
    pub struct UncertainResponse {
        pub input: String;
        pub output: String;
        /// Unit; magnitudes are in decibels of it, phases in degrees.
        pub unit: String;
    }
}

rows! {
    /// Number of the robot file that deviates.
    #[derive(Debug, Clone)]
    pub struct UncertainInput in tables(groups: &[InputGroup]) with {
        let names: Vec<String> = groups.iter().map(|group| group.name.clone()).collect();
    } rows {
        /// Path of the number.
        pub path: String => one.plain("number");
        /// Unit of the number.
        pub unit: &'static str => one.plain("unit");
        /// Value; empty if it changes from pose to pose.
        ///
        /// Value; absent if it changes from pose to pose.
        pub value: Option<f64> => one.unit("").short("value", 6);
        /// Distribution.
        ///
        /// Distribution: `normal` or `uniform`.
        pub distribution: &'static str => one.plain("distribution");
        /// Standard deviation.
        ///
        /// Absent if it changes from pose to pose.
        pub deviation: Option<f64> => one.unit("").short("deviation", 6);
        /// Half width of the tolerance.
        ///
        /// Absent for a normal distribution.
        pub tolerance: Option<f64>
            => one.unit("").short("tolerance", 6)
            => column("group", "", "group of the number", move |of: &Self| names[of.group].clone()).plain("group");
        /// Index of its group, from 0.
        pub group: usize;
    }
}

rows! {
    /// Numbers that one option makes deviate.
    #[derive(Debug, Clone)]
    pub struct InputGroup {
        pub name: String;
        /// Count of parameters in the group.
        pub count: usize;
    }
}

rows! {
    /// Results at one pose.
    #[derive(Debug, Clone)]
    pub struct PoseUncertainty {
        /// Pose of the undisturbed robot; absent if it has no equilibrium.
        pub position_m: Option<[f64; 3]>;
        pub roll_pitch_yaw_deg: Option<[f64; 3]>;
        /// Reason why there are no results.
        pub reason: Option<String>;
        /// Number of sampled robots without results, with the first reason.
        pub failed: Option<FailedSamples>;
        /// Deviation of the platform's position; absent if the pose is not among the results or does not deviate.
        pub position: Option<PositionDeviation>;
        pub results: Vec<UncertainResult>;
    }
}

rows! {
    /// Sampled robots without results.
    #[derive(Debug, Clone)]
    pub struct FailedSamples {
        pub count: usize;
        pub reason: String;
    }
}

rows! {
    /// Result with its deviation.
    #[derive(Debug, Clone)]
    pub struct UncertainResult {
        /// Name, such as `frequency 3` or `tension of cable "2" at the anchor`.
        pub name: String;
        /// Identity as data: `kind`, and the cable, mode or frequency to which the result belongs.
        pub measure: serde_json::Value;
        pub unit: &'static str;
        /// Frequency of a response [Hz].
        pub at_hz: Option<f64>;
        /// Value of the undisturbed robot.
        pub value: f64;
        /// Standard deviation; absent if too few sampled robots have the result.
        pub deviation: Option<f64>;
        /// Interval that holds 95 % of the robots.
        pub interval_95: Option<[f64; 2]>;
        /// Method: `linear` or `sampled`.
        pub method: &'static str;
        /// Reason for sampling. With the requested method `linear` it is the reason why the linear deviation is
        /// doubtful.
        pub sampling_reason: Option<String>;
        /// Standard deviation by the gradient, also of a sampled result.
        pub linear_deviation: Option<f64>;
        /// Mean of the sampled robots.
        pub mean: Option<f64>;
        /// Shares of the groups in the variance; of a sampled result total shares, which may add up to more than 1.
        pub group_shares: Option<Vec<f64>>;
        /// Largest linear shares of single numbers in the variance.
        pub largest: Vec<ShareOfInput> = sparse;
        /// Linear shares of all numbers, in the order of `inputs`; for one pose only.
        pub shares: Option<Vec<f64>>;
        /// Worst case within the tolerances.
        pub worst: Option<WorstCase>;
    }
}

rows! {
    /// Share of a number in the variance of a result.
    #[derive(Debug, Clone)]
    pub struct ShareOfInput {
        pub path: String;
        pub share: f64;
    }
}

rows! {
    /// Worst case within the tolerances.
    #[derive(Debug, Clone, Copy)]
    pub struct WorstCase {
        /// Sum of the absolute linear changes over all tolerances: neither a lower nor an upper bound.
        pub linear: f64;
        /// Change at the corner of the tolerances where the linear result is smallest. The true worst case is at least
        /// as far.
        pub down: Option<f64>;
        /// Change at the opposite corner, where the linear result is largest.
        pub up: Option<f64>;
    }
}

/// Number of contributions that a table for reading shows for each result.
const SHOWN: usize = 3;

/// Result with the pose to which it belongs.
pub struct ResultAtPose<'a> {
    found: &'a Uncertainties,
    index: usize,
    pose: &'a PoseUncertainty,
    result: &'a UncertainResult,
}

impl<'a> ResultAtPose<'a> {
    /// Results at the poses from `first` on, `count` of them.
    pub fn all(found: &'a Uncertainties, first: usize, count: usize) -> impl Iterator<Item = Self> {
        let poses = found.poses.iter().enumerate().skip(first).take(count);
        poses.flat_map(move |(index, pose)| pose.results.iter().map(move |result| Self { found, index, pose, result }))
    }

    /// Largest contributions to the result: single numbers, or groups where only these are known.
    fn largest(&self) -> String {
        let Self { found, result, .. } = self;
        let mut parts: Vec<(f64, &str)> = result.largest.iter().map(|of| (of.share, of.path.as_str())).collect();
        if result.method == "sampled"
            && let Some(shares) = &result.group_shares
        {
            parts = shares.iter().copied().zip(found.groups.iter().map(|group| group.name.as_str())).collect();
            parts.sort_by(|a, b| b.0.total_cmp(&a.0));
        }
        let shown = parts.iter().take(SHOWN).filter(|(share, _)| *share > 0.0);
        shown.map(|(share, name)| format!("{name} {} %", significant(100.0 * share, 2))).collect::<Vec<_>>().join(", ")
    }

    /// Columns of the results of a robot whose numbers deviate in these groups; tables for reading have the corners of
    /// the tolerances if there are any.
    pub fn columns(groups: &[InputGroup], has_worst: bool) -> Columns<Self> {
        let digits = |of: &Self| digits_for(of.result.value, of.result.deviation);
        let [from, to] = fields::interval_95(|of: &Self| of.result.interval_95, digits, "95 % of the robots");
        let [position, angles] = fields::pose(|of: &Self| of.pose.position_m, |of: &Self| of.pose.roll_pitch_yaw_deg);
        let worst = |of: &Self, side: fn(&WorstCase) -> Option<f64>| of.result.worst.as_ref().and_then(side);

        let place = [
            column("pose", "1", "number of the pose, from 1", |of: &Self| of.index + 1)
                .plain("pose")
                .only_in(Style::Typeset),
            position,
            angles,
        ];
        let values = [
            column("result", "", "name of the result", |of: &Self| of.result.name.clone()).plain("result"),
            column("unit", "", "unit of the result", |of: &Self| of.result.unit).plain("unit"),
            column("value", "", "value of the undisturbed robot", |of: &Self| of.result.value).shown(
                "value",
                "",
                move |of, style| style.significant(of.result.value, digits(of)),
            ),
            column("deviation", "", "standard deviation", |of: &Self| of.result.deviation).significant("deviation", 3),
            from,
            to,
            column("method", "", "method: linear or sampled", |of: &Self| of.result.method).plain("method"),
            column("linear_deviation", "", "standard deviation by the gradient", |of: &Self| {
                of.result.linear_deviation
            }),
            column("worst_linear", "", "sum of the absolute linear changes over the tolerances", |of: &Self| {
                of.result.worst.map(|worst| worst.linear)
            }),
            column(
                "worst_down",
                "",
                "change at the corner of the tolerances with the smallest linear result",
                move |of: &Self| worst(of, |case| case.down),
            )
            .significant("corner down", 3)
            .read_if(has_worst),
            column("worst_up", "", "change at the opposite corner", move |of: &Self| worst(of, |case| case.up))
                .significant("up", 3)
                .read_if(has_worst),
            column("sampling_reason", "", "reason for sampling", |of: &Self| {
                of.result.sampling_reason.clone().unwrap_or_default()
            }),
        ];
        let shares = [
            parts("share of {}", groups.iter().map(|group| &group.name), "1", "share of {} in the variance", {
                let count = groups.len();
                move |of: &Self| {
                    let shares = of.result.group_shares.as_ref();
                    shares.map_or_else(|| vec![None; count], |all| all.iter().copied().map(Some).collect())
                }
            }),
            only_read().shown("largest shares", "", |of: &Self, _| of.largest()),
        ];
        Columns::new(place.into_iter().chain(values).chain(shares))
    }
}

impl Tabled for Uncertainties {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        let groups = any().into_iter().map(|name| InputGroup { name, count: 1 }).collect::<Vec<_>>();
        vec![("", ResultAtPose::columns(&groups, true).described())]
    }

    fn table(&self) -> ResultTable<'_> {
        ResultTable::new(ResultAtPose::columns(&self.groups, true), ResultAtPose::all(self, 0, usize::MAX))
    }
}

/// Sentence on the least and the largest deviation of the position over several poses.
pub(super) fn position_note(poses: &[PoseUncertainty]) -> Option<String> {
    let mut known: Vec<(&PoseUncertainty, PositionDeviation)> =
        poses.iter().filter_map(|pose| Some((pose, pose.position?))).collect();
    known.sort_by(|a, b| a.1.deviation_m.total_cmp(&b.1.deviation_m));
    let ([best, .., worst], true) = (&known[..], poses.len() > 1) else { return None };
    let at = |(pose, of): &(&PoseUncertainty, PositionDeviation)| {
        let [x, y, z] = pose.position_m.unwrap_or_default().map(|value| significant(value, 4));
        format!("{} at ({x}, {y}, {z}) m", of.told())
    };
    Some(format!("Position: from {} to {}, standard deviations in the worst direction", at(best), at(worst)))
}

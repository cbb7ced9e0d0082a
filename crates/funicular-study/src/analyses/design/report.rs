//! Result of a design: rows of its tables, and sentences on what limits it.

use super::at_poses::RobotAtPoses;
use super::band::{self, SidesTried};
use super::rows::{DemandKind, Evaluated, PoseValues};
use super::search::{RELEVANT, TOLERANCE, Tried};
use super::variables::Variable;
use crate::chosen_numbers::at_bound;
use crate::columns::{Style, column, only_read};
use crate::names::DesignGoal;
use crate::request::DesignRequest;
use crate::rows::rows;
use crate::text::{counted, significant, with_unit};
use anyhow::Result;
use funicular::math::max_min::{Found, MaxMinEnding};
use funicular::math::rotation;
use funicular::robot::parameters::Parameters;

/// Distance from a bound, relative to the distance of both bounds, up to which a value counts as at it. It is the
/// distance of the linear problem, whose multipliers belong to values at bounds.
const AT_BOUND: f64 = 1e-9;

/// Number of bounds that the sentences on limits name.
const MAX_BOUNDS: usize = 5;

rows! {
    /// Results at one pose.
    pub struct DesignPose {
        /// Position of the platform [m].
        pub position_m: [f64; 3];
        /// Roll, pitch, yaw [degrees].
        pub roll_pitch_yaw_deg: [f64; 3];
        /// Value of the goal with the values of the file.
        pub before: f64;
        /// Value of the goal with the chosen values.
        pub after: f64;
        /// Gain of the goal if this pose alone gains one. The shares of all poses sum to 1, except for a weighted mean.
        pub share: f64;
        pub frequency_before_hz: Option<f64>;
        pub frequency_after_hz: Option<f64>;
        pub stiffness_before_n_per_m: Option<f64>;
        pub stiffness_after_n_per_m: Option<f64>;
        /// Natural frequency that is deepest in the band to avoid or nearest to it.
        pub beside_band_before_hz: Option<f64>;
        pub beside_band_after_hz: Option<f64>;
    }
}

rows! {
    /// Chosen value of the robot file.
    pub struct ChosenValue in tables() {
        /// Path of the number.
        pub path: String => one.plain("value");
        /// Unit of the number.
        pub unit: &'static str => one.plain("unit");
        /// Value of the file.
        pub start: f64 => one.unit("").significant("before", 6);
        /// Chosen value.
        pub value: f64 => one.unit("").significant("after", 6);
        /// Lower bound.
        pub minimum: f64 => one.unit("").significant("minimum", 6);
        /// Upper bound.
        pub maximum: f64 => one.unit("").significant("maximum", 6);
        /// Bound at which the value is.
        ///
        /// `minimum` or `maximum` if the value is at this bound.
        pub at_bound: Option<&'static str>
            => one.shown("remark", "", |row, _| row.remark()).only_in(Style::Typeset)
            => only_read().shown("", "", |row: &Self, _| row.remark()).only_in(Style::Plain);
        /// Gain of the goal per unit by which the bound moves outwards.
        ///
        /// Improvement of the goal per unit of the value by which its bound is moved outwards; zero between the bounds.
        pub gain_per_unit: f64 => one.unit("")
            .shown("gain per unit", "", |row, style| {
                row.at_bound.map_or_else(String::new, |_| style.significant(row.gain_per_unit, 3))
            })
            .only_in(Style::Typeset);
    }
}

impl ChosenValue {
    fn remark(&self) -> String {
        self.at_bound.map_or_else(String::new, |bound| format!("at its {bound}"))
    }
}

rows! {
    /// Part of the gain of an entry of the changes.
    pub struct ChangeGain in tables() {
        /// Path of the values, as it was given.
        pub change: String => one.plain("change");
        /// Gain of the goal that is lost if these values alone go back to those of the file.
        ///
        /// Absent if a pose is not held then.
        pub gain: Option<f64> => one.unit("").significant("lost without it", 3);
    }
}

rows! {
    /// Demand at the pose where it is met least.
    pub struct DemandRow in tables() {
        /// Demand.
        pub name: String => one.plain("demand");
        pub unit: &'static str;
        /// Limit.
        pub limit: f64 => one.unit("").significant("limit", 5);
        /// Value with the numbers of the file.
        pub before: f64 => one.unit("").significant("before", 5);
        /// Value with the chosen numbers.
        pub after: f64
            => one.unit("").significant("after", 5)
            => column("unit", "", "unit", |row: &Self| row.unit).plain("unit");
        /// Number of the pose, from 1.
        pub pose: usize => one.plain("at pose");
        /// Improvement of the goal per unit by which the demand is lowered, summed over the poses.
        pub gain_per_unit: f64;
    }
}

/// Search, its request and its robots, from which the parts of the result are made.
pub(super) struct DesignReport<'a> {
    pub(super) request: &'a DesignRequest,
    pub(super) poses: &'a RobotAtPoses<'a>,
    pub(super) variables: &'a [Variable],
    pub(super) found: &'a Found,
    pub(super) tried: &'a Tried,
    pub(super) before: &'a Evaluated,
    pub(super) after: &'a Evaluated,
}

impl DesignReport<'_> {
    /// Goal in words.
    pub(super) fn goal_means(&self) -> String {
        let what = self.request.goal.in_words();
        if self.request.goal == DesignGoal::Workspace {
            return format!("{what} ({} in all)", counted(self.poses.count(), "pose"));
        }
        let extreme = if self.request.goal.sign() > 0.0 { "lowest" } else { "largest" };
        match (&self.request.weights, self.poses.count()) {
            (_, 1) => what.to_owned(),
            (Some(_), count) => format!("weighted mean of the {what} of {count} poses"),
            (None, count) => format!("{extreme} {what} of {count} poses"),
        }
    }

    /// Reason for the end of the search, as a sentence.
    pub(super) fn ending(&self) -> String {
        match self.found.ending {
            MaxMinEnding::Converged => {
                format!("no further step improves the goal by more than {} %", 100.0 * TOLERANCE)
            }
            MaxMinEnding::Iterations => {
                format!("the search has not ended after {}", counted(self.found.iterations, "iteration"))
            }
            MaxMinEnding::Cancelled => {
                format!(
                    "the search was stopped after {}; these are its best values",
                    counted(self.found.iterations, "iteration")
                )
            }
        }
    }

    /// Shares of the poses in the optimum. The rows of the goal are in the order of the poses.
    fn shares(&self) -> Vec<f64> {
        let count = self.poses.count();
        if self.request.goal == DesignGoal::Workspace {
            return vec![1.0 / count as f64; count];
        }
        let mut of_rows = self.found.objective_shares.iter();
        let per_pose = self.after.rows_per_pose.iter();
        per_pose.map(|count| of_rows.by_ref().take(*count).sum()).collect()
    }

    /// Results at the poses.
    ///
    /// # Errors
    /// A robot file that cannot be changed, or a pose without equilibrium.
    pub(super) fn pose_rows(&self) -> Result<Vec<DesignPose>> {
        let parameters = self.poses.text_with(&self.variables.iter().map(|v| v.start).collect::<Vec<_>>())?;
        let robot = Parameters::from_toml(&parameters)?.robot().clone();
        let shares = self.shares();

        let mut rows = Vec::with_capacity(shares.len());
        for (i, ((before, after), share)) in self.before.poses.iter().zip(&self.after.poses).zip(shares).enumerate() {
            let (position_m, roll_pitch_yaw_deg) = if let Some(poses) = &self.poses.listed {
                let [x, y, z, roll, pitch, yaw] = poses[i];
                ([x, y, z], [roll, pitch, yaw])
            } else {
                let pose = self.poses.at_rest(robot.clone(), i)?.equilibrium.pose;
                (pose.position_w.into(), rotation::to_roll_pitch_yaw_deg(&pose.rot_wp))
            };
            rows.push(DesignPose {
                position_m,
                roll_pitch_yaw_deg,
                before: before.goal,
                after: after.goal,
                share,
                frequency_before_hz: before.frequency_hz,
                frequency_after_hz: after.frequency_hz,
                stiffness_before_n_per_m: before.stiffness,
                stiffness_after_n_per_m: after.stiffness,
                beside_band_before_hz: before.beside_band_hz,
                beside_band_after_hz: after.beside_band_hz,
            });
        }
        Ok(rows)
    }

    /// Chosen values.
    pub(super) fn values(&self) -> Vec<ChosenValue> {
        let rows = self.variables.iter().zip(&self.found.x).zip(&self.found.bound_multipliers);
        rows.map(|((variable, value), multiplier)| {
            let [minimum, maximum] = variable.bounds;
            ChosenValue {
                path: variable.path.clone(),
                unit: variable.unit,
                start: variable.start,
                value: *value,
                minimum,
                maximum,
                at_bound: at_bound(*value, variable.bounds, AT_BOUND * (maximum - minimum)),
                gain_per_unit: *multiplier,
            }
        })
        .collect()
    }

    /// Demands, each at the pose where it is met least.
    pub(super) fn demands(&self) -> Vec<DemandRow> {
        let request = self.request;
        let mut rows = Vec::new();
        if let Some(limit) = request.min_frequency_hz {
            let name = "first natural frequency at least";
            rows.extend(self.lower_limit((name, "Hz"), DemandKind::Frequency, limit, |pose| pose.frequency_hz));
        }
        if let Some(limit) = request.min_stiffness_n_per_m {
            let name = "minimum stiffness at least";
            rows.extend(self.lower_limit((name, "N/m"), DemandKind::Stiffness, limit, |pose| pose.stiffness));
        }
        rows.extend(request.avoid_hz.and_then(|band| self.band_demand(band)));
        rows
    }

    /// Improvement of the goal per unit by which a demand is lowered. Rows of demands are relative to their limits.
    fn gain_per_unit(&self, kind: DemandKind, limit: f64) -> f64 {
        let multipliers = self.after.demands.iter().zip(&self.found.demand_multipliers);
        multipliers.filter(|(own, _)| **own == kind).map(|(_, multiplier)| multiplier / limit).sum()
    }

    /// Demand that a result is at least a limit, at the pose where the result is smallest.
    fn lower_limit(
        &self,
        (name, unit): (&str, &'static str),
        kind: DemandKind,
        limit: f64,
        result: fn(&PoseValues) -> Option<f64>,
    ) -> Option<DemandRow> {
        let after = self.after.poses.iter().enumerate().filter_map(|(pose, values)| Some((pose, result(values)?)));
        let (pose, after) = after.min_by(|(_, a), (_, b)| a.total_cmp(b))?;
        Some(DemandRow {
            name: name.to_owned(),
            unit,
            limit,
            before: result(&self.before.poses[pose]).unwrap_or(after),
            after,
            pose: pose + 1,
            gain_per_unit: self.gain_per_unit(kind, limit),
        })
    }

    /// Demand that natural frequencies avoid a band, at the pose where one is deepest in it or nearest to it.
    fn band_demand(&self, band: [f64; 2]) -> Option<DemandRow> {
        let after =
            self.after.poses.iter().enumerate().filter_map(|(pose, values)| Some((pose, values.beside_band_hz?)));
        let (pose, after) = after.max_by(|(_, a), (_, b)| band::depth(band, *a).total_cmp(&band::depth(band, *b)))?;
        let (side, limit) = if after < band::middle(band) { ("at most", band[0]) } else { ("at least", band[1]) };
        Some(DemandRow {
            name: format!("natural frequency beside the band {side}"),
            unit: "Hz",
            limit,
            before: self.before.poses[pose].beside_band_hz.unwrap_or(after),
            after,
            pose: pose + 1,
            gain_per_unit: self.gain_per_unit(DemandKind::Band, limit),
        })
    }

    /// Sentence on demands that are not met.
    pub(super) fn unmet(&self) -> String {
        let reached: Vec<String> = self
            .demands()
            .iter()
            .map(|row| {
                let (limit, after) = (significant(row.limit, 6), significant(row.after, 6));
                format!("{} {limit} {}: {after} {} at pose {}", row.name, row.unit, row.unit, row.pose)
            })
            .collect();
        let choices = match self.tried.sides.len() {
            0 => String::new(),
            count => format!(" with any of {count} choices of the sides of the band"),
        };
        let stopped = if self.found.ending == MaxMinEnding::Converged { "" } else { " (the search had not ended)" };
        format!(
            "no values within the bounds of ⟪change⟫ meet all demands{choices}{stopped}; reached after {}: {}; allow \
             larger changes, or lower a demand",
            counted(self.found.iterations, "iteration"),
            reached.join(", ")
        )
    }

    /// Sentence on the poses that are held before and after.
    fn poses_held(&self) -> String {
        let held = |of: &Evaluated| of.poses.iter().filter(|pose| pose.goal >= 1.0).count();
        let (count, before, after) = (self.poses.count(), held(self.before), held(self.after));
        format!(
            "Of {count} poses {before} hold the required loads with the values of the file, and {after} with the \
             chosen ones; the goal counts a pose whose load factor is near 1 in part"
        )
    }

    /// Sentence on the choices of the sides of a band.
    fn sides_tried(&self) -> Option<String> {
        let unit = self.request.goal.unit();
        let choice = |(i, tried): (usize, &SidesTried)| {
            let numbers: Vec<String> = tried.below.iter().map(usize::to_string).collect();
            let nearer = if i == 0 { " (the nearer sides)" } else { "" };
            let chosen = if tried.is_chosen { ", chosen" } else { "" };
            let after = match tried.after {
                Some(after) => with_unit(&significant(after, 5), unit),
                None => "demands not met".to_owned(),
            };
            format!("{}{nearer}: {after}{chosen}", numbers.join(", "))
        };
        let choices: Vec<String> = self.tried.sides.iter().enumerate().map(choice).collect();
        let left_out = match self.tried.left_out {
            0 => String::new(),
            more => format!("; {} not tried", counted(more, "further choice")),
        };
        let at_each = if self.poses.count() > 1 { "at each pose " } else { "" };
        (!choices.is_empty()).then(|| {
            format!("Choices of the number of frequencies {at_each}below the band: {}{left_out}", choices.join("; "))
        })
    }

    /// Sentences on what limits the result: poses, demands and bounds.
    pub(super) fn limits(&self) -> Vec<String> {
        let mut sentences = Vec::new();
        let unit = self.request.goal.unit();
        let better = if self.request.goal.sign() > 0.0 { "more" } else { "less" };

        let shares = self.shares();
        let is_sum = self.request.goal == DesignGoal::Workspace;
        if is_sum {
            sentences.push(self.poses_held());
        }
        if shares.len() > 1 && self.request.weights.is_none() && !is_sum {
            let limiting: Vec<String> =
                (1..).zip(&shares).filter(|(_, share)| **share > RELEVANT).map(|(pose, _)| pose.to_string()).collect();
            let noun = if limiting.len() == 1 { "pose" } else { "poses" };
            sentences.push(format!("The goal is limited by {noun} {}", limiting.join(", ")));
        }
        sentences.extend(self.sides_tried());
        for row in self.demands() {
            if row.gain_per_unit > 0.0 {
                let gain = with_unit(&significant(row.gain_per_unit, 3), unit);
                sentences.push(format!(
                    "{} {} {}: {gain} {better} per {} by which it is relaxed",
                    row.name,
                    significant(row.limit, 6),
                    row.unit,
                    row.unit
                ));
            }
        }

        // The bounds that cost most, relative to the range of each value.
        let mut bounds: Vec<ChosenValue> = self.values();
        bounds.retain(|value| value.at_bound.is_some() && value.gain_per_unit > 0.0);
        let cost = |value: &ChosenValue| value.gain_per_unit * (value.maximum - value.minimum);
        bounds.sort_by(|a, b| cost(b).total_cmp(&cost(a)));
        for value in bounds.iter().take(MAX_BOUNDS) {
            let (per, factor) = if value.unit == "m" { ("cm", 0.01) } else { (value.unit, 1.0) };
            sentences.push(format!(
                "{} is at its {}: {} {better} per {per} of more room",
                value.path,
                value.at_bound.unwrap_or_default(),
                with_unit(&significant(value.gain_per_unit * factor, 3), unit),
            ));
        }
        sentences
    }
}

//! `design`: values of the robot file with which the robot is best at several poses.

mod band;
mod rows;
mod variables;

use super::found;
use super::shared::Models;
use crate::Watch;
use crate::error::{Cancelled, NoSolution};
use crate::names::{DesignGoal, Named};
use crate::request::{self, DesignRequest};
use crate::text::{counted, significant};
use anyhow::{Result, anyhow, bail};
use band::Places;
use band::{Sides, SidesTried};
use funicular::math::max_min::{self, Ending, Evaluation, Found, Goal, MET, Problem, Settings};
use funicular::math::rotation;
use funicular::robot::State;
use funicular::robot::parameters::Parameters;
use rows::{AtPoses, BAND, Evaluated, PoseValues, linearisation_of_goal};
use serde::Serialize;
use variables::{Variable, rounded, variables};

/// Maximum number of poses, each of which is an equilibrium with a list of modes per step.
const MAX_POSES: usize = 1000;

/// Maximum number of iterations that a request may give.
const MAX_ITERATIONS: usize = 10_000;

/// Gain of a step, relative to the value, below which the search ends.
const TOLERANCE: f64 = 1e-5;

/// Share of a pose in the optimum, and multiplier over the largest one, below which it is rounding.
const RELEVANT: f64 = 1e-6;

/// Results of `design`.
#[derive(Serialize)]
pub struct Designed {
    #[serde(skip)]
    pub robot: String,
    #[serde(flatten)]
    pub models: Models,
    /// Name of the goal.
    pub goal: &'static str,
    /// Goal in words.
    pub goal_means: String,
    pub unit: &'static str,
    /// Value of the goal with the values of the file.
    pub before: f64,
    /// Value of the goal with the chosen values.
    pub after: f64,
    /// Results at the poses.
    pub poses: Vec<PoseRow>,
    /// Chosen values.
    pub values: Vec<ChosenValue>,
    /// Demands, each at the pose where it is met least.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub demands: Vec<DemandRow>,
    /// Choices of the sides to which frequencies leave the band, if there were several.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub band_sides: Vec<SidesTried>,
    /// True if no step gains more than the tolerance.
    pub converged: bool,
    /// Reason for the end of the search, as a sentence.
    pub ending: String,
    pub iterations: usize,
    /// Number of evaluated robots, those of all choices of sides included.
    pub evaluations: usize,
    /// Value of the goal after each iteration.
    pub history: Vec<f64>,
    /// Sentences on what limits the result.
    pub limits: Vec<String>,
    /// Robot file with the values.
    pub robot_file: String,
    #[serde(skip)]
    pub warnings: Vec<String>,
}

/// Results at one pose.
#[derive(Serialize)]
pub struct PoseRow {
    /// Position of the platform [m].
    pub position_m: [f64; 3],
    /// Roll, pitch, yaw [degrees].
    pub roll_pitch_yaw_deg: [f64; 3],
    /// Value of the goal before and after.
    pub before: f64,
    pub after: f64,
    /// Gain of the goal if this pose alone gains one; the shares of all poses sum to 1, but for a weighted mean.
    pub share: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frequency_before_hz: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frequency_after_hz: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stiffness_before_n_per_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stiffness_after_n_per_m: Option<f64>,
    /// Natural frequency deepest in the band to avoid, or nearest to it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub beside_band_before_hz: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub beside_band_after_hz: Option<f64>,
}

/// Chosen value of the robot file.
#[derive(Serialize)]
pub struct ChosenValue {
    pub path: String,
    pub unit: &'static str,
    pub start: f64,
    pub value: f64,
    pub minimum: f64,
    pub maximum: f64,
    /// `minimum` or `maximum` if the value is at this bound.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_bound: Option<&'static str>,
    /// Improvement of the goal per unit of the value by which its bound is moved outwards; zero between the bounds.
    pub gain_per_unit: f64,
}

impl ChosenValue {
    /// Cells of a row in a table: path, unit, value before and after, minimum, maximum, and the bound at which it is.
    /// `number` writes a number with a count of significant digits.
    pub fn cells(&self, number: impl Fn(f64, usize) -> String) -> [String; 7] {
        [
            self.path.clone(),
            self.unit.to_owned(),
            number(self.start, 6),
            number(self.value, 6),
            number(self.minimum, 6),
            number(self.maximum, 6),
            self.at_bound.map_or_else(String::new, |bound| format!("at its {bound}")),
        ]
    }
}

/// Demand at the pose where it is met least.
#[derive(Serialize)]
pub struct DemandRow {
    pub name: String,
    pub unit: &'static str,
    pub limit: f64,
    pub before: f64,
    pub after: f64,
    /// Number of the pose, from 1.
    pub pose: usize,
    /// Improvement of the goal per unit by which the demand is lowered, summed over the poses.
    pub gain_per_unit: f64,
}

found!(Designed, "design");

/// Chooses values of a robot file.
///
/// # Errors
/// A request that contradicts itself or the robot; a pose without equilibrium; demands that no values within the bounds
/// meet, with those that were reached; work that was stopped before its first step.
pub fn run(request: &DesignRequest, watch: &mut dyn Watch) -> Result<Designed> {
    check(request)?;
    let file = request.robot.read()?;
    let parameters = Parameters::from_toml(&file.text).map_err(|error| anyhow!("{error}"))?;
    let variables = variables(&parameters, &request.change)?;
    let poses = AtPoses::new(request, &variables, request.robot.changed_text()?);

    // The robot of the file, whose errors are the user's.
    let start: Vec<f64> = variables.iter().map(|variable| variable.start).collect();
    let first = poses.at_rest(parameters.robot().clone(), 0)?;
    let models = Models::of(&first, linearisation_of_goal(request, first.equilibrium.model));
    let (cables, motion) = (first.robot.cables.len(), &first.robot.platform.motion);
    if cables < motion.count() {
        bail!(
            "a design needs as many cables as degrees of freedom or more, to hold its poses: the robot has {cables} cables \
             for {} degrees of freedom",
            motion.count()
        );
    }
    if !matches!(first.robot.state, State::Pose(_)) {
        bail!("a design holds its poses: give ⟪poses⟫ or ⟪pose⟫, or the robot file a [state] with `position_m`");
    }
    let before = poses.evaluate(&start, &[])?;
    if watch.is_cancelled() {
        return Err(Cancelled.into());
    }

    // The search, by the nearer sides of a band.
    let settings = Settings {
        goal: match &request.weights {
            Some(weights) => {
                let sum: f64 = weights.iter().sum();
                Goal::Weighted(weights.iter().map(|weight| weight / sum).collect())
            }
            None => Goal::Worst,
        },
        bounds: variables.iter().map(|variable| variable.bounds).collect(),
        tolerance: TOLERANCE,
        max_iterations: request.max_iterations,
    };
    let mut search = Search {
        poses: &poses,
        watch,
        total: request.max_iterations,
        done: 0,
        sign: request.goal.sign(),
        sides: Sides::new(),
        history: Vec::new(),
        refusal: None,
        first: Some(before.evaluation.clone()),
    };
    let nearer = search.run(&start, &settings).ok_or_else(|| anyhow!("the start has no results"))?;
    let (chosen, tried) = other_sides(nearer, &before, &mut search, (&start, &settings));
    let Searched { mut found, sides, history, refusal } = chosen;
    for (value, [low, high]) in found.x.iter_mut().zip(&settings.bounds) {
        *value = rounded(*value).clamp(*low, *high);
    }
    let after = poses.evaluate(&found.x, &sides)?;

    let report = Report {
        request,
        poses: &poses,
        variables: &variables,
        found: &found,
        tried: &tried,
        before: &before,
        after: &after,
    };
    if found.violation > MET {
        return Err(NoSolution(report.unmet()).into());
    }
    let rest = poses.at_rest(Parameters::from_toml(&poses.text_with(&found.x)?)?.robot().clone(), 0)?;
    let linearisation = linearisation_of_goal(request, rest.equilibrium.model);
    let highest = after
        .poses
        .iter()
        .filter_map(|pose| pose.frequency_hz)
        .chain(frequency_of(request, &after))
        .fold(0.0, f64::max);
    let (_, mut warnings) = rest.dynamics(linearisation, highest)?;
    if let Some(reason) = refusal {
        warnings.push(format!("some steps were shortened, because there {reason}"));
    }
    let sign = request.goal.sign();
    let goal_of = |evaluated: &Evaluated| sign * value_of(&settings.goal, &evaluated.evaluation);
    Ok(Designed {
        robot: parameters.robot().name.clone(),
        models,
        goal: request.goal.name(),
        goal_means: report.goal_means(),
        unit: request.goal.in_words().1,
        before: goal_of(&before),
        after: goal_of(&after),
        poses: report.pose_rows()?,
        values: report.values(),
        demands: report.demands(),
        converged: found.ending == Ending::Converged,
        ending: report.ending(),
        iterations: found.iterations,
        evaluations: tried.evaluations,
        history,
        limits: report.limits(),
        robot_file: poses.text_with(&found.x)?,
        band_sides: tried.sides,
        warnings,
    })
}

/// Frequencies of a goal in Hz.
fn frequency_of<'a>(request: &DesignRequest, evaluated: &'a Evaluated) -> impl Iterator<Item = f64> + use<'a> {
    let is_frequency = matches!(request.goal, DesignGoal::First);
    evaluated.poses.iter().filter(move |_| is_frequency).map(|pose| pose.goal)
}

/// Value of a goal of an evaluation.
fn value_of(goal: &Goal, evaluation: &Evaluation) -> f64 {
    let lowest = |group: Option<usize>| {
        let rows = evaluation.objectives.iter().filter(|row| group.is_none_or(|group| row.group == group));
        rows.map(|row| row.value).fold(f64::INFINITY, f64::min)
    };
    match goal {
        Goal::Worst => lowest(None),
        Goal::Weighted(weights) => weights.iter().enumerate().map(|(group, weight)| weight * lowest(Some(group))).sum(),
    }
}

/// Checks what a request says beside its values.
fn check(request: &DesignRequest) -> Result<()> {
    let DesignRequest { state, poses, weights, .. } = request;
    if state.lengths_m.is_some() || state.hold_lengths_of_pose {
        bail!("a design holds its poses: leave out ⟪lengths_m⟫ and ⟪hold_lengths_of_pose⟫, and give ⟪pose⟫ or ⟪poses⟫");
    }
    if poses.is_some() && state.pose.is_some() {
        bail!("give ⟪pose⟫ or ⟪poses⟫, not both");
    }
    if let Some(poses) = poses
        && !(1..=MAX_POSES).contains(&poses.len())
    {
        bail!("⟪poses⟫: {} poses are not possible: give 1 to {MAX_POSES}", poses.len());
    }
    if let Some(weights) = weights {
        let count = poses.as_ref().map_or(1, Vec::len);
        if weights.len() != count {
            bail!("⟪weights⟫: {} weights given for {}: give one per pose", weights.len(), counted(count, "pose"));
        }
        weights.iter().try_for_each(|weight| request::check_positive("weights", *weight))?;
    }
    if !(1..=MAX_ITERATIONS).contains(&request.max_iterations) {
        let given = request.max_iterations;
        bail!("⟪max_iterations⟫: {given} iterations are not possible: give a whole number from 1 to {MAX_ITERATIONS}");
    }
    request.min_frequency_hz.map_or(Ok(()), |hz| request::check_positive("min_frequency_hz", hz))?;
    request.min_stiffness_n_per_m.map_or(Ok(()), |k| request::check_positive("min_stiffness_n_per_m", k))?;
    if let Some([first, last]) = request.avoid_hz {
        request::check_positive("avoid_hz", first)?;
        request::check_positive("avoid_hz", last)?;
        if first >= last {
            bail!("⟪avoid_hz⟫: the first frequency {first} Hz is not below the last one {last} Hz");
        }
    }
    Ok(())
}

/// True if the band to avoid limits a result, or if demands are not met.
fn is_limited_by_band(found: &Found, poses: &AtPoses<'_>) -> bool {
    let Ok(there) = poses.evaluate(&found.x, &[]) else { return false };
    let mut multipliers = there.demands.iter().zip(&found.demand_multipliers);
    found.violation > MET || multipliers.any(|((_, kind), multiplier)| *kind == BAND && *multiplier > RELEVANT)
}

/// Search with its progress.
struct Search<'a> {
    poses: &'a AtPoses<'a>,
    watch: &'a mut dyn Watch,
    /// Maximum number of iterations of all searches, and the number of those that are done.
    total: usize,
    done: usize,
    sign: f64,
    /// Sides of the band to avoid.
    sides: Sides,
    history: Vec<f64>,
    /// Reason for which the last refused point had no results.
    refusal: Option<anyhow::Error>,
    /// Functions at the start, which are known.
    first: Option<Evaluation>,
}

/// Result of a search.
struct Searched {
    found: Found,
    sides: Sides,
    history: Vec<f64>,
    refusal: Option<anyhow::Error>,
}

/// Searches by several choices of the sides of a band.
struct Tried {
    /// The choices, if there were several.
    sides: Vec<SidesTried>,
    /// Number of choices that were left out.
    left_out: usize,
    evaluations: usize,
}

impl Search<'_> {
    /// Searches from the start; `None` if it has no results.
    fn run(&mut self, start: &[f64], settings: &Settings) -> Option<Searched> {
        let found = max_min::maximise(self, start, settings)?;
        self.done += found.iterations;
        let (history, refusal) = (std::mem::take(&mut self.history), self.refusal.take());
        Some(Searched { found, sides: std::mem::take(&mut self.sides), history, refusal })
    }
}

/// Searches again with other sides for the frequencies that are in the band at the start, if the band limits the result of
/// the nearer sides or is not avoided there; keeps the best result.
fn other_sides(
    nearer: Searched,
    before: &Evaluated,
    search: &mut Search<'_>,
    (start, settings): (&[f64], &Settings),
) -> (Searched, Tried) {
    let mut tried = Tried { sides: Vec::new(), left_out: 0, evaluations: nearer.found.evaluations };
    let places: Vec<Places> = before.poses.iter().filter_map(|pose| pose.places).collect();
    let (choices, left_out) = band::others(&places);
    if choices.is_empty() || search.is_cancelled() || !is_limited_by_band(&nearer.found, search.poses) {
        return (nearer, tried);
    }
    tried.left_out = left_out;
    search.total *= 1 + choices.len();

    let is_met = |searched: &Searched| searched.found.violation <= MET;
    let sign = search.sign;
    let told = |searched: &Searched, below: Vec<usize>| {
        let after = is_met(searched).then_some(sign * searched.found.value);
        SidesTried { below, after, is_chosen: false }
    };
    tried.sides.push(told(&nearer, places.iter().map(|of| of.nearer_below).collect()));
    let (mut best, mut chosen) = (nearer, 0);
    for sides in choices {
        if search.is_cancelled() {
            break;
        }
        let below = sides.iter().zip(&places).map(|(number, of)| number.unwrap_or(of.nearer_below)).collect();
        search.sides = sides;
        let Some(other) = search.run(start, settings) else { continue };
        tried.evaluations += other.found.evaluations;
        tried.sides.push(told(&other, below));
        let is_better = match (is_met(&other), is_met(&best)) {
            (true, true) => other.found.value > best.found.value,
            (is_met, was_met) => is_met && !was_met,
        };
        if is_better {
            (best, chosen) = (other, tried.sides.len() - 1);
        }
    }
    tried.sides[chosen].is_chosen = true;
    (best, tried)
}

impl Problem for Search<'_> {
    fn evaluate(&mut self, x: &[f64]) -> Option<Evaluation> {
        if let Some(first) = self.first.take() {
            return Some(first);
        }
        match self.poses.evaluate(x, &self.sides) {
            Ok(found) => Some(found.evaluation),
            Err(error) => {
                self.refusal = Some(error);
                None
            }
        }
    }

    fn is_cancelled(&self) -> bool {
        self.watch.is_cancelled()
    }

    fn progress(&mut self, iteration: usize, value: f64) {
        self.history.push(self.sign * value);
        self.watch.progress(self.done + iteration, self.total, "iterations");
    }
}

/// Parts of the result.
struct Report<'a> {
    request: &'a DesignRequest,
    poses: &'a AtPoses<'a>,
    variables: &'a [Variable],
    found: &'a Found,
    tried: &'a Tried,
    before: &'a Evaluated,
    after: &'a Evaluated,
}

impl Report<'_> {
    fn goal_means(&self) -> String {
        let (what, _) = self.request.goal.in_words();
        let extreme = if self.request.goal.sign() > 0.0 { "lowest" } else { "largest" };
        match (&self.request.weights, self.poses.count()) {
            (_, 1) => what.to_owned(),
            (Some(_), count) => format!("weighted mean of the {what} of {count} poses"),
            (None, count) => format!("{extreme} {what} of {count} poses"),
        }
    }

    fn ending(&self) -> String {
        match self.found.ending {
            Ending::Converged => "no further step improves the goal by more than 0.001 %".to_owned(),
            Ending::Iterations => {
                format!("the search has not ended after {}", counted(self.found.iterations, "iteration"))
            }
            Ending::Cancelled => {
                format!(
                    "the search was stopped after {}; these are its best values",
                    counted(self.found.iterations, "iteration")
                )
            }
        }
    }

    /// Shares of the poses in the optimum. Rows of the goal follow the poses.
    fn shares(&self) -> Vec<f64> {
        let mut of_rows = self.found.objective_shares.iter();
        let per_pose = self.after.rows_per_pose.iter();
        per_pose.map(|count| of_rows.by_ref().take(*count).sum()).collect()
    }

    fn pose_rows(&self) -> Result<Vec<PoseRow>> {
        let parameters = self.poses.text_with(&self.variables.iter().map(|v| v.start).collect::<Vec<_>>())?;
        let robot = Parameters::from_toml(&parameters)?.robot().clone();
        let shares = self.shares();
        let mut rows = Vec::with_capacity(shares.len());
        for (i, ((before, after), share)) in self.before.poses.iter().zip(&self.after.poses).zip(shares).enumerate() {
            let (position_m, roll_pitch_yaw_deg) = if let Some(poses) = &self.request.poses {
                let [x, y, z, roll, pitch, yaw] = poses[i];
                ([x, y, z], [roll, pitch, yaw])
            } else {
                let pose = self.poses.at_rest(robot.clone(), i)?.equilibrium.pose;
                (pose.position_w.into(), rotation::to_roll_pitch_yaw_deg(&pose.rot_wp))
            };
            rows.push(PoseRow {
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

    fn values(&self) -> Vec<ChosenValue> {
        let rows = self.variables.iter().zip(&self.found.x).zip(&self.found.bound_multipliers);
        rows.map(|((variable, value), multiplier)| {
            let [minimum, maximum] = variable.bounds;
            let near = 1e-9 * (maximum - minimum);
            let at_bound = match *value {
                value if value <= minimum + near => Some("minimum"),
                value if value >= maximum - near => Some("maximum"),
                _ => None,
            };
            ChosenValue {
                path: variable.path.clone(),
                unit: variable.unit,
                start: variable.start,
                value: *value,
                minimum,
                maximum,
                at_bound,
                gain_per_unit: *multiplier,
            }
        })
        .collect()
    }

    fn demands(&self) -> Vec<DemandRow> {
        let request = self.request;
        let mut rows = Vec::new();
        // Demands are relative to their limits, in the order of the poses and of the kinds.
        let multiplier = |kind: usize, limit: f64| {
            let of_kind = self.after.demands.iter().zip(&self.found.demand_multipliers);
            of_kind.filter(|((_, own), _)| *own == kind).map(|(_, multiplier)| multiplier / limit).sum::<f64>()
        };
        let mut add = |name: String, unit, limit: f64, kind: usize, sign: f64, of: fn(&PoseValues) -> Option<f64>| {
            let after = self.after.poses.iter().enumerate().filter_map(|(pose, values)| Some((pose, of(values)?)));
            let Some((pose, after)) = after.min_by(|(_, a), (_, b)| (sign * a).total_cmp(&(sign * b))) else { return };
            let before = of(&self.before.poses[pose]).unwrap_or(after);
            rows.push(DemandRow {
                name,
                unit,
                limit,
                before,
                after,
                pose: pose + 1,
                gain_per_unit: multiplier(kind, limit),
            });
        };
        if let Some(limit) = request.min_frequency_hz {
            add("first natural frequency at least".to_owned(), "Hz", limit, 0, 1.0, |pose| pose.frequency_hz);
        }
        if let Some(limit) = request.min_stiffness_n_per_m {
            add("minimum stiffness at least".to_owned(), "N/m", limit, 1, 1.0, |pose| pose.stiffness);
        }
        if let Some([first, last]) = request.avoid_hz {
            let half = 0.5 * (first + last);
            let depth = |hz: f64| (hz - first).min(last - hz);
            let after =
                self.after.poses.iter().enumerate().filter_map(|(pose, values)| Some((pose, values.beside_band_hz?)));
            if let Some((pose, after)) = after.max_by(|(_, a), (_, b)| depth(*a).total_cmp(&depth(*b))) {
                let (side, limit) = if after < half { ("at most", first) } else { ("at least", last) };
                rows.push(DemandRow {
                    name: format!("natural frequency beside the band {side}"),
                    unit: "Hz",
                    limit,
                    before: self.before.poses[pose].beside_band_hz.unwrap_or(after),
                    after,
                    pose: pose + 1,
                    gain_per_unit: multiplier(BAND, limit),
                });
            }
        }
        rows
    }

    /// Sentence on demands that are not met.
    fn unmet(&self) -> String {
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
        let stopped = if self.found.ending == Ending::Converged { "" } else { " (the search had not ended)" };
        format!(
            "no values within the bounds of ⟪change⟫ meet all demands{choices}{stopped}; reached after {}: {}; allow larger changes, \
             or lower a demand",
            counted(self.found.iterations, "iteration"),
            reached.join(", ")
        )
    }

    /// Sentence on the choices of the sides of a band.
    fn sides_tried(&self) -> Option<String> {
        let unit = self.request.goal.in_words().1;
        let choices: Vec<String> = self
            .tried
            .sides
            .iter()
            .enumerate()
            .map(|(i, tried)| {
                let numbers: Vec<String> = tried.below.iter().map(usize::to_string).collect();
                let nearer = if i == 0 { " (the nearer sides)" } else { "" };
                let chosen = if tried.is_chosen { ", chosen" } else { "" };
                let after = tried
                    .after
                    .map_or("demands not met".to_owned(), |after| format!("{} {unit}", significant(after, 5)));
                format!("{}{nearer}: {after}{chosen}", numbers.join(", "))
            })
            .collect();
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
    fn limits(&self) -> Vec<String> {
        let mut sentences = Vec::new();
        let unit = self.request.goal.in_words().1;
        let better = if self.request.goal.sign() > 0.0 { "more" } else { "less" };
        let shares = self.shares();
        if shares.len() > 1 && self.request.weights.is_none() {
            let limiting: Vec<String> =
                (1..).zip(&shares).filter(|(_, share)| **share > RELEVANT).map(|(pose, _)| pose.to_string()).collect();
            let noun = if limiting.len() == 1 { "pose" } else { "poses" };
            sentences.push(format!("The goal is limited by {noun} {}", limiting.join(", ")));
        }
        sentences.extend(self.sides_tried());
        for row in self.demands() {
            if row.gain_per_unit > 0.0 {
                let gain = significant(row.gain_per_unit, 3);
                sentences.push(format!(
                    "{} {} {}: {gain} {unit} {better} per {} by which it is relaxed",
                    row.name,
                    significant(row.limit, 6),
                    row.unit,
                    row.unit
                ));
            }
        }

        // The bounds that cost most, each by its own room.
        let mut bounds: Vec<ChosenValue> = self.values();
        bounds.retain(|value| value.at_bound.is_some() && value.gain_per_unit > 0.0);
        let cost = |value: &ChosenValue| value.gain_per_unit * (value.maximum - value.minimum);
        bounds.sort_by(|a, b| cost(b).total_cmp(&cost(a)));
        for value in bounds.iter().take(5) {
            let (per, factor) = if value.unit == "m" { ("cm", 0.01) } else { (value.unit, 1.0) };
            sentences.push(format!(
                "{} is at its {}: {} {unit} {better} per {per} of more room",
                value.path,
                value.at_bound.unwrap_or_default(),
                significant(value.gain_per_unit * factor, 3),
            ));
        }
        sentences
    }
}

//! `design`: values of the robot file with which the robot is best at several poses.

mod at_poses;
mod band;
mod choices;
mod cures;
mod differences;
mod report;
mod rows;
mod search;
mod variables;

pub use choices::{ExchangeRow, RopeTried};
pub use report::{ChangeGain, ChosenValue, DemandRow, DesignPose};

use super::shared::Models;
use super::{candidate_poses, found};
use crate::Watch;
use crate::at_rest::AtRest;
use crate::columns::{ResultTable, Tabled};
use crate::error::{Cancelled, NoSolution};
use crate::names::{DesignGoal, Named};
use crate::request::{self, ChangeValue, DesignRequest};
use crate::rows::rows;
use crate::table::Column;
use crate::text::counted;
use anyhow::{Result, anyhow, bail};
use at_poses::{RobotAtPoses, is_no_solution};
use band::SidesTried;
use choices::{Exchanges, best_rope, reconnected};
use cures::cures;
use funicular::math::max_min::{Goal, MaxMinEnding, Settings};
use funicular::robot::parameters::Parameters;
use funicular::robot::{Robot, State};
use funicular::statics::LoadCapacity;
use report::DesignReport;
use rows::{Evaluated, linearisation_of_goal};
use search::{DesignSearch, SearchResult, TOLERANCE, Tried, try_other_sides};
use serde_json::Value;
use variables::{Variable, rounded, variables};

/// Maximum number of poses. Each step computes an equilibrium and a list of modes for each of them.
const MAX_POSES: usize = 1000;

/// Maximum number of iterations that a request may give.
const MAX_ITERATIONS: usize = 10_000;

rows! {
    /// Results of `design`.
    pub struct Designed {
        pub robot: String = hidden;
        pub models: Models = spread;
        /// Name of the goal.
        pub goal: &'static str;
        /// Identity of the number that improves, as `gradient` writes it.
        pub measure: Value;
        /// Goal in words.
        pub goal_means: String;
        pub unit: &'static str;
        /// Value of the goal with the values of the file.
        pub before: f64;
        /// Value of the goal with the chosen values.
        pub after: f64;
        /// Results at the poses.
        pub poses: Vec<DesignPose>;
        /// Chosen values.
        pub values: Vec<ChosenValue>;
        /// Part of the gain of each entry of the changes.
        pub gains: Vec<ChangeGain>;
        /// Ropes that were tried.
        pub ropes: Vec<RopeTried> = sparse;
        /// Exchanges of attachments.
        pub exchanges: Vec<ExchangeRow> = sparse;
        /// Demands, each at the pose where it is met least.
        pub demands: Vec<DemandRow> = sparse;
        /// Choices of the sides to which frequencies leave the band, if there were several.
        pub band_sides: Vec<SidesTried> = sparse;
        /// True if no step gains more than the tolerance.
        pub converged: bool;
        /// Reason for the end of the search, as a sentence.
        pub ending: String;
        pub iterations: usize;
        /// Number of evaluated robots, those of all choices of sides included.
        pub evaluations: usize;
        /// Value of the goal after each iteration.
        pub history: Vec<f64>;
        /// Sentences on what limits the result.
        pub limits: Vec<String>;
        /// Robot file with the values.
        pub robot_file: String;
        pub warnings: Vec<String> = hidden;
    }
}

impl Tabled for Designed {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        vec![("", ChosenValue::columns().described())]
    }

    fn table(&self) -> ResultTable<'_> {
        ResultTable::new(ChosenValue::columns(), &self.values)
    }
}

found!(Designed, "design");

/// Chooses values of a robot file.
///
/// # Errors
/// A request that contradicts itself or the robot; a pose without equilibrium, with what would cure it; demands that no
/// values within the bounds meet, with those that were reached; work that was stopped before its first step.
pub fn run(request: &DesignRequest, watch: &mut dyn Watch) -> Result<Designed> {
    check(request)?;
    // The robot of the file, whose errors are the user's.
    let file = request.robot.read()?;
    let parameters = Parameters::from_toml(&file.text).map_err(|error| anyhow!("{error}"))?;
    let listed = candidate_poses::of_places(&request.places, &request.state, parameters.robot())?;
    check_weights(request, listed.as_ref().map_or(1, Vec::len))?;
    let mut run = DesignRun { request, listed, watch };

    let text = request.robot.changed_text()?;
    let (text, exchanges) = if request.reconnect { reconnected(&mut run, text)? } else { (text, Exchanges::default()) };
    let (chosen, ropes) = match &request.ropes {
        Some(ropes) => best_rope(&mut run, &text, ropes)?,
        None => (run.search(text)?, Vec::new()),
    };
    run.results(&chosen, exchanges, ropes)
}

/// Searches of a request.
struct DesignRun<'a> {
    request: &'a DesignRequest,
    /// Poses of a list or grid.
    listed: Option<Vec<[f64; 6]>>,
    watch: &'a mut dyn Watch,
}

/// Values that a search has chosen for a robot file.
struct Chosen {
    /// Text of the file with the values before.
    text: String,
    variables: Vec<Variable>,
    settings: Settings,
    before: Evaluated,
    after: Evaluated,
    result: SearchResult,
    tried: Tried,
}

impl Chosen {
    /// Value of the goal, larger for a better one.
    fn value(&self) -> f64 {
        self.settings.goal.value(&self.after.evaluation)
    }
}

impl DesignRun<'_> {
    /// Robots with values of this text at the poses.
    fn at_poses<'b>(&'b self, text: &str, variables: &'b [Variable]) -> RobotAtPoses<'b> {
        RobotAtPoses::new(self.request, variables, text.to_owned(), self.listed.clone())
    }

    /// Value of the goal with the values of a text, larger for a better one.
    fn start_value(&self, text: &str) -> Result<f64> {
        let parameters = Parameters::from_toml(text).map_err(|error| anyhow!("{error}"))?;
        let variables = variables(&parameters, &self.request.change)?;
        let start: Vec<f64> = variables.iter().map(|variable| variable.start).collect();
        let evaluated = self.at_poses(text, &variables).evaluate(&start, &[])?;
        Ok(settings(self.request, &variables).goal.value(&evaluated.evaluation))
    }

    /// Robot at rest at the first pose that is held.
    fn first_at_rest(&self, robot: &Robot) -> Result<AtRest> {
        let poses = self.at_poses("", &[]);
        let mut first = poses.at_rest(robot.clone(), 0);
        for pose in 1..poses.count() {
            match &first {
                Err(error) if poses.may_lose(error) => first = poses.at_rest(robot.clone(), pose),
                _ => break,
            }
        }
        first
    }

    /// Search for the best values of a text, by the nearer sides of a band, then by other sides.
    ///
    /// # Errors
    /// As [`run`].
    fn search(&mut self, text: String) -> Result<Chosen> {
        let request = self.request;
        let parameters = Parameters::from_toml(&text).map_err(|error| anyhow!("{error}"))?;
        let variables = variables(&parameters, &request.change)?;
        let start: Vec<f64> = variables.iter().map(|variable| variable.start).collect();
        let first = self.first_at_rest(parameters.robot());
        let first = first.map_err(|error| self.with_cures(error, parameters.robot()))?;
        check_robot(&first.robot)?;
        check_goal(request, &first)?;
        check_limits(request, &variables)?;
        let poses = RobotAtPoses::new(request, &variables, text.clone(), self.listed.clone());
        let before = poses.evaluate(&start, &[]).map_err(|error| self.with_cures(error, parameters.robot()))?;
        if self.watch.is_cancelled() {
            return Err(Cancelled.into());
        }

        let settings = settings(request, &variables);
        let mut search = DesignSearch::new(request, &poses, &mut *self.watch, before.evaluation.clone());
        let nearer = search.run(&start, &settings).ok_or_else(|| anyhow!("the start has no results"))?;
        let (mut result, tried) = try_other_sides(nearer, &before, &mut search, (&start, &settings));
        for (value, [low, high]) in result.found.x.iter_mut().zip(&settings.bounds) {
            *value = rounded(*value).clamp(*low, *high);
        }

        let after = poses.evaluate(&result.found.x, &result.sides)?;
        if !result.is_met() {
            let (found, tried) = (&result.found, &tried);
            let (variables, before, after) = (&variables, &before, &after);
            let report = DesignReport { request, poses: &poses, variables, found, tried, before, after };
            return Err(NoSolution(report.unmet()).into());
        }
        Ok(Chosen { text, variables, settings, before, after, result, tried })
    }

    /// Error of a pose that is not held, with what would cure it.
    fn with_cures(&self, error: anyhow::Error, robot: &Robot) -> anyhow::Error {
        if !is_no_solution(&error) {
            return error;
        }
        let poses = self.at_poses("", &[]);
        let found = (0..poses.count()).find_map(|pose| {
            poses.at_rest(robot.clone(), pose).is_err().then(|| poses.placed(robot, pose).ok()).flatten()
        });
        let Some((placed, rule)) = found else { return error };
        let State::Pose(pose) = placed.state else { return error };
        let cures = cures(&placed, &pose, self.request.state.static_model, &rule);
        if cures.is_empty() {
            return error;
        }
        NoSolution(format!("{error:#}; each of these alone would hold the pose: {}", cures.join("; "))).into()
    }

    /// Results from the chosen values.
    fn results(&self, chosen: &Chosen, exchanges: Exchanges, ropes: Vec<RopeTried>) -> Result<Designed> {
        let request = self.request;
        let Chosen { text, variables, settings, before, after, result, tried } = chosen;
        let poses = &RobotAtPoses::new(request, variables, text.clone(), self.listed.clone());
        let parameters = Parameters::from_toml(text)?;
        let first = self.first_at_rest(parameters.robot())?;
        let found = &result.found;
        let report = DesignReport { request, poses, variables, found, tried, before, after };
        let goal_of = |evaluated: &Evaluated| request.goal.sign() * settings.goal.value(&evaluated.evaluation);
        let gains = self.gains(chosen, poses)?;
        let mut limits = report.limits();
        limits.extend(exchanges.in_words(request.goal.unit()));
        Ok(Designed {
            robot: parameters.robot().name.clone(),
            models: Models::of(&first, linearisation_of_goal(request, first.equilibrium.model)),
            goal: request.goal.name(),
            goal_means: report.goal_means(),
            measure: request.goal.identity(parameters.robot()),
            unit: request.goal.unit(),
            before: goal_of(before),
            after: goal_of(after),
            poses: report.pose_rows()?,
            values: report.values(),
            gains,
            ropes,
            exchanges: exchanges.rows,
            demands: report.demands(),
            converged: found.ending == MaxMinEnding::Converged,
            ending: report.ending(),
            iterations: found.iterations,
            evaluations: tried.evaluations,
            limits,
            robot_file: poses.text_with(&found.x)?,
            band_sides: tried.sides.clone(),
            history: result.history.clone(),
            warnings: self.warnings(chosen, poses)?,
        })
    }

    /// Part of the gain of each entry of ⟪change⟫: what is lost if its values alone go back.
    fn gains(&self, chosen: &Chosen, poses: &RobotAtPoses<'_>) -> Result<Vec<ChangeGain>> {
        let after = chosen.value();
        let of_change = |(k, change): (usize, &ChangeValue)| {
            let back = chosen.variables.iter().zip(&chosen.result.found.x);
            let values: Vec<f64> =
                back.map(|(variable, value)| if variable.change == k { variable.start } else { *value }).collect();
            let without = match poses.evaluate(&values, &chosen.result.sides) {
                Ok(evaluated) => Some(chosen.settings.goal.value(&evaluated.evaluation)),
                Err(error) if is_no_solution(&error) => None,
                Err(error) => return Err(error),
            };
            Ok(ChangeGain { change: change.path.clone(), gain: without.map(|without| after - without) })
        };
        self.request.change.iter().enumerate().map(of_change).collect()
    }

    /// Warnings about the models at the result, and about steps that were shortened.
    fn warnings(&self, chosen: &Chosen, poses: &RobotAtPoses<'_>) -> Result<Vec<String>> {
        let text = poses.text_with(&chosen.result.found.x)?;
        let rest = self.first_at_rest(Parameters::from_toml(&text)?.robot())?;
        let linearisation = linearisation_of_goal(self.request, rest.equilibrium.model);
        let demanded = chosen.after.poses.iter().filter_map(|pose| pose.frequency_hz);
        let highest = demanded.chain(frequency_of(self.request, &chosen.after)).fold(0.0, f64::max);
        let (_, mut warnings) = rest.dynamics(linearisation, highest)?;
        if let Some(reason) = &chosen.result.refusal {
            warnings.push(format!("some steps were shortened, because there {reason}"));
        }
        Ok(warnings)
    }
}

/// Refuses limits of tensions as values where results have no derivatives by them.
fn check_limits(request: &DesignRequest, variables: &[Variable]) -> Result<()> {
    let Some(limit) = variables.iter().find(|variable| variable.is_limit) else { return Ok(()) };
    let has_demands =
        request.min_frequency_hz.is_some() || request.min_stiffness_n_per_m.is_some() || request.avoid_hz.is_some();
    let is_of_modes = matches!(request.goal, DesignGoal::First | DesignGoal::Platform | DesignGoal::Stiffness);
    if has_demands || is_of_modes {
        bail!(
            "⟪change⟫ {}: frequencies and stiffnesses have no derivatives by limits of tensions; choose a ⟪goal⟫ such \
             as load-factor, workspace or winch-power, without demands",
            limit.path
        );
    }
    Ok(())
}

/// Refuses a goal that the robot or other options contradict.
fn check_goal(request: &DesignRequest, first: &AtRest) -> Result<()> {
    let AtRest { robot, equilibrium, .. } = first;
    if request.goal != DesignGoal::Workspace {
        return Ok(());
    }
    if LoadCapacity::at(robot, &equilibrium.pose, equilibrium.model, None)?.requires_nothing() {
        bail!(
            "the goal workspace counts poses at which required loads are held, and none are: give the \
             robot file [required] or [[required_loads]]"
        );
    }
    Ok(())
}

/// Refuses a robot whose poses cannot be held.
fn check_robot(robot: &Robot) -> Result<()> {
    if robot.constraint().is_under() {
        let (cables, degrees_of_freedom) = (robot.cables.len(), robot.platform.motion.count());
        bail!(
            "a design needs as many cables as degrees of freedom or more, to hold its poses: the robot has {cables} \
             cables for {degrees_of_freedom} degrees of freedom"
        );
    }
    if !matches!(robot.state, State::Pose(_)) {
        bail!(
            "a design holds its poses: give ⟪poses⟫, ⟪grid⟫ or ⟪pose⟫, or the robot file a [state] with `position_m`"
        );
    }
    Ok(())
}

/// Settings of the search: goal, bounds and ends.
fn settings(request: &DesignRequest, variables: &[Variable]) -> Settings {
    let goal = match &request.weights {
        Some(weights) => {
            let sum: f64 = weights.iter().sum();
            Goal::Weighted(weights.iter().map(|weight| weight / sum).collect())
        }
        None => Goal::Worst,
    };
    Settings {
        goal,
        bounds: variables.iter().map(|variable| variable.bounds).collect(),
        tolerance: TOLERANCE,
        max_iterations: request.max_iterations,
    }
}

/// Values of the goal at the poses, if it is a frequency [Hz].
fn frequency_of<'a>(request: &DesignRequest, evaluated: &'a Evaluated) -> impl Iterator<Item = f64> + use<'a> {
    let is_frequency = matches!(request.goal, DesignGoal::First);
    evaluated.poses.iter().filter(move |_| is_frequency).map(|pose| pose.goal)
}

/// Checks the number of poses and their weights.
fn check_weights(request: &DesignRequest, count: usize) -> Result<()> {
    if !(1..=MAX_POSES).contains(&count) {
        bail!("⟪poses⟫: {count} poses are not possible: give 1 to {MAX_POSES}");
    }
    let Some(weights) = &request.weights else { return Ok(()) };
    if request.goal == DesignGoal::Workspace {
        bail!("⟪weights⟫ have no place in the goal workspace, which counts poses: leave them out");
    }
    if weights.len() != count {
        bail!("⟪weights⟫: {} weights given for {}: give one per pose", weights.len(), counted(count, "pose"));
    }
    weights.iter().try_for_each(|weight| request::check_positive("weights", *weight))
}

/// Checks state, iterations and demands of a request.
fn check(request: &DesignRequest) -> Result<()> {
    let DesignRequest { state, .. } = request;
    if state.lengths_m.is_some() || state.hold_lengths_of_pose {
        bail!("a design holds its poses: leave out ⟪lengths_m⟫ and ⟪hold_lengths_of_pose⟫, and give ⟪pose⟫ or ⟪poses⟫");
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

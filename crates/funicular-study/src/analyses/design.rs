//! `design`: values of the robot file with which the robot is best at several poses.

mod at_poses;
mod band;
mod report;
mod rows;
mod search;
mod variables;

pub use report::{ChosenValue, DemandRow, DesignPose};

use super::found;
use super::shared::Models;
use crate::Watch;
use crate::columns::{ResultTable, Tabled};
use crate::error::{Cancelled, NoSolution};
use crate::names::{DesignGoal, Named};
use crate::request::{self, DesignRequest};
use crate::rows::rows;
use crate::table::Column;
use crate::text::counted;
use anyhow::{Result, anyhow, bail};
use at_poses::RobotAtPoses;
use band::SidesTried;
use funicular::math::max_min::{Goal, MaxMinEnding, Settings};
use funicular::robot::parameters::Parameters;
use funicular::robot::{Robot, State};
use report::DesignReport;
use rows::{Evaluated, linearisation_of_goal};
use search::{DesignSearch, SearchResult, TOLERANCE, try_other_sides};
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
/// A request that contradicts itself or the robot; a pose without equilibrium; demands that no values within the bounds
/// meet, with those that were reached; work that was stopped before its first step.
pub fn run(request: &DesignRequest, watch: &mut dyn Watch) -> Result<Designed> {
    check(request)?;
    let file = request.robot.read()?;
    let parameters = Parameters::from_toml(&file.text).map_err(|error| anyhow!("{error}"))?;
    let variables = &variables(&parameters, &request.change)?;
    let poses = &RobotAtPoses::new(request, variables, request.robot.changed_text()?);

    // The robot of the file, whose errors are the user's.
    let start: Vec<f64> = variables.iter().map(|variable| variable.start).collect();
    let first = poses.at_rest(parameters.robot().clone(), 0)?;
    let models = Models::of(&first, linearisation_of_goal(request, first.equilibrium.model));
    check_robot(&first.robot)?;
    let before = &poses.evaluate(&start, &[])?;
    if watch.is_cancelled() {
        return Err(Cancelled.into());
    }

    // The search, by the nearer sides of a band, then by other sides.
    let settings = settings(request, variables);
    let mut search = DesignSearch::new(request, poses, watch, before.evaluation.clone());
    let nearer = search.run(&start, &settings).ok_or_else(|| anyhow!("the start has no results"))?;
    let (mut chosen, tried) = try_other_sides(nearer, before, &mut search, (&start, &settings));
    for (value, [low, high]) in chosen.found.x.iter_mut().zip(&settings.bounds) {
        *value = rounded(*value).clamp(*low, *high);
    }

    let after = &poses.evaluate(&chosen.found.x, &chosen.sides)?;
    let (found, tried) = (&chosen.found, &tried);
    let report = DesignReport { request, poses, variables, found, tried, before, after };
    if !chosen.is_met() {
        return Err(NoSolution(report.unmet()).into());
    }
    let warnings = warnings(request, poses, &chosen, after)?;
    let goal_of = |evaluated: &Evaluated| request.goal.sign() * settings.goal.value(&evaluated.evaluation);
    Ok(Designed {
        robot: parameters.robot().name.clone(),
        models,
        goal: request.goal.name(),
        goal_means: report.goal_means(),
        measure: request.goal.measure().identity(parameters.robot()),
        unit: request.goal.measure().unit(),
        before: goal_of(before),
        after: goal_of(after),
        poses: report.pose_rows()?,
        values: report.values(),
        demands: report.demands(),
        converged: found.ending == MaxMinEnding::Converged,
        ending: report.ending(),
        iterations: found.iterations,
        evaluations: tried.evaluations,
        limits: report.limits(),
        robot_file: poses.text_with(&found.x)?,
        band_sides: tried.sides.clone(),
        history: chosen.history,
        warnings,
    })
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
        bail!("a design holds its poses: give ⟪poses⟫ or ⟪pose⟫, or the robot file a [state] with `position_m`");
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

/// Warnings about the models at the result, and about steps that were shortened.
fn warnings(
    request: &DesignRequest,
    poses: &RobotAtPoses<'_>,
    chosen: &SearchResult,
    after: &Evaluated,
) -> Result<Vec<String>> {
    let text = poses.text_with(&chosen.found.x)?;
    let rest = poses.at_rest(Parameters::from_toml(&text)?.robot().clone(), 0)?;
    let linearisation = linearisation_of_goal(request, rest.equilibrium.model);
    let demanded = after.poses.iter().filter_map(|pose| pose.frequency_hz);
    let highest = demanded.chain(frequency_of(request, after)).fold(0.0, f64::max);
    let (_, mut warnings) = rest.dynamics(linearisation, highest)?;
    if let Some(reason) = &chosen.refusal {
        warnings.push(format!("some steps were shortened, because there {reason}"));
    }
    Ok(warnings)
}

/// Values of the goal at the poses, if it is a frequency [Hz].
fn frequency_of<'a>(request: &DesignRequest, evaluated: &'a Evaluated) -> impl Iterator<Item = f64> + use<'a> {
    let is_frequency = matches!(request.goal, DesignGoal::First);
    evaluated.poses.iter().filter(move |_| is_frequency).map(|pose| pose.goal)
}

/// Checks state, poses, weights, iterations and demands of a request.
fn check(request: &DesignRequest) -> Result<()> {
    let DesignRequest { state, poses, weights, .. } = request;
    if state.lengths_m.is_some() || state.hold_lengths_of_pose {
        bail!("a design holds its poses: leave out ⟪lengths_m⟫ and ⟪hold_lengths_of_pose⟫, and give ⟪pose⟫ or ⟪poses⟫");
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

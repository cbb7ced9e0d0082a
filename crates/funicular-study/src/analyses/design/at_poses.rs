//! Robot with other values at all poses.

use super::differences::{Ends, HALF_STEP};
use super::rows::{Direction, Evaluated};
use super::variables::Variable;
use crate::at_rest::{self, AtRest};
use crate::error::ErrorKind;
use crate::names::DesignGoal;
use crate::request::{DesignRequest, Pose, RobotText, State};
use crate::set_values;
use anyhow::{Result, anyhow};
use funicular::robot::Robot;
use funicular::robot::parameters::Parameters;
use funicular::statics::TensionRule;

/// Robot whose values change, at all poses.
pub(crate) struct RobotAtPoses<'a> {
    request: &'a DesignRequest,
    variables: &'a [Variable],
    /// Text of the robot file with all changes of the request.
    text: String,
    states: Vec<State>,
    /// Poses of a list or grid: position [m] and roll, pitch, yaw [degrees].
    pub(crate) listed: Option<Vec<[f64; 6]>>,
}

impl<'a> RobotAtPoses<'a> {
    pub(crate) fn new(
        request: &'a DesignRequest,
        variables: &'a [Variable],
        text: String,
        listed: Option<Vec<[f64; 6]>>,
    ) -> Self {
        let states = match &listed {
            None => vec![request.state.clone()],
            Some(poses) => {
                poses.iter().map(|pose| State { pose: Some(Pose::Angles(*pose)), ..request.state.clone() }).collect()
            }
        };
        Self { request, variables, text, states, listed }
    }

    /// Number of poses.
    pub(crate) fn count(&self) -> usize {
        self.states.len()
    }

    /// Text of the robot file with these values.
    pub(crate) fn text_with(&self, values: &[f64]) -> Result<String> {
        let assignments = self
            .variables
            .iter()
            .zip(values)
            .map(|(variable, value)| variable.assignment(*value))
            .collect::<Result<Vec<_>>>()?;
        Ok(set_values::apply(&self.text, &assignments)?)
    }

    /// Robot at rest at the pose with this index.
    ///
    /// # Errors
    /// A robot without equilibrium there.
    pub(crate) fn at_rest(&self, robot: Robot, pose: usize) -> Result<AtRest> {
        let source = RobotText::default();
        at_rest::equilibrium(robot, &source, &self.states[pose], &self.request.tensions)
            .map_err(|error| self.at_pose(pose, error))
    }

    /// Robot with state, loads and limits at the pose with this index, and the rule of its tensions.
    ///
    /// # Errors
    /// State or limits that the robot cannot have.
    pub(crate) fn placed(&self, robot: &Robot, pose: usize) -> Result<(Robot, TensionRule)> {
        let robot = at_rest::with_state(robot.clone(), &self.states[pose])?;
        let rule = at_rest::rule(&self.request.tensions)?.unwrap_or_default();
        Ok((at_rest::with_limits(&robot, &self.request.tensions)?, rule))
    }

    /// Error with the pose at which it arose.
    fn at_pose(&self, pose: usize, error: anyhow::Error) -> anyhow::Error {
        let Some(poses) = self.listed.as_ref().filter(|poses| poses.len() > 1) else { return error };
        let [x, y, z, ..] = poses[pose];
        error.context(format!("pose {}, ({x}, {y}, {z}) m", pose + 1))
    }

    /// Results at all poses with their derivatives. `sides` says how many frequencies go below the band to avoid.
    ///
    /// # Errors
    /// Values that the robot file cannot have, a pose without equilibrium, or results without derivatives.
    pub(crate) fn evaluate(&self, values: &[f64], sides: &[Option<usize>]) -> Result<Evaluated> {
        let parameters = Parameters::from_toml(&self.text_with(values)?).map_err(|error| anyhow!("{error}"))?;
        let robots = self.robots_beside(values)?;
        let mut found = Evaluated::default();
        for pose in 0..self.count() {
            let at_rest = match self.at_rest(parameters.robot().clone(), pose) {
                Err(error) if self.may_lose(&error) => {
                    found.add_lost_pose(self.variables.len());
                    continue;
                }
                at_rest => at_rest?,
            };
            let below = sides.get(pose).copied().flatten();
            let ends: Vec<Option<Ends>> =
                robots.iter().map(|beside| beside.as_ref().map(|beside| self.ends(beside, pose))).collect();
            self.directions(&parameters, &at_rest.robot)
                .and_then(|of| found.add_pose(self.request, &at_rest, (&of, &ends), (self.count(), below)))
                .map_err(|error| self.at_pose(pose, error))?;
        }
        Ok(found)
    }

    /// True if the goal counts the poses that are held, and the error says that one is not.
    pub(crate) fn may_lose(&self, error: &anyhow::Error) -> bool {
        self.request.goal == DesignGoal::Workspace && is_no_solution(error)
    }

    /// Robots on both sides of each value whose derivatives are differences, with the steps to them.
    fn robots_beside(&self, values: &[f64]) -> Result<Vec<Option<Beside>>> {
        let beside = |(k, variable): (usize, &Variable)| {
            if !variable.is_limit && !matches!(self.request.goal, DesignGoal::Differenced(_)) {
                return Ok(None);
            }
            let [low, high] = variable.bounds;
            let step = HALF_STEP * (high - low);
            let ends = [(values[k] - step).max(low), (values[k] + step).min(high)];
            let robot = |end: f64| -> Result<Robot> {
                let mut moved = values.to_vec();
                moved[k] = end;
                Ok(Parameters::from_toml(&self.text_with(&moved)?).map_err(|error| anyhow!("{error}"))?.robot().clone())
            };
            let robots = [robot(ends[0])?, robot(ends[1])?];
            Ok(Some(Beside { robots, steps: [values[k] - ends[0], ends[1] - values[k]] }))
        };
        self.variables.iter().enumerate().map(beside).collect()
    }

    /// These robots at rest at a pose.
    fn ends(&self, beside: &Beside, pose: usize) -> Ends {
        Ends {
            at_rest: beside.robots.each_ref().map(|robot| self.at_rest(robot.clone(), pose).ok()),
            steps: beside.steps,
        }
    }

    /// Changes of a robot per unit of each value.
    fn directions(&self, parameters: &Parameters, robot: &Robot) -> Result<Vec<Direction>> {
        let direction = |variable: &Variable| {
            if variable.is_limit {
                return Ok(Direction::Limit);
            }
            let change = parameters.change_of(variable.index, robot);
            let none = || anyhow!("{}: results have no derivatives by this value", variable.path);
            change.map(|change| Direction::Exact(Box::new(change))).ok_or_else(none)
        };
        self.variables.iter().map(direction).collect()
    }
}

/// Robots on both sides of a value.
struct Beside {
    robots: [Robot; 2],
    /// Distances to them, in the unit of the value.
    steps: [f64; 2],
}

/// True if a valid request has no such equilibrium.
pub(crate) fn is_no_solution(error: &anyhow::Error) -> bool {
    ErrorKind::of(error) == ErrorKind::NoSolution
}

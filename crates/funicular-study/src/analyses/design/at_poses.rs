//! Robot with other values at all poses.

use super::rows::Evaluated;
use super::variables::Variable;
use crate::at_rest::{self, AtRest};
use crate::request::{DesignRequest, Pose, RobotText, State};
use crate::set_values;
use anyhow::{Result, anyhow};
use funicular::robot::parameters::Parameters;
use funicular::robot::{Robot, RobotChange};

/// Robot whose values change, at all poses.
pub(crate) struct RobotAtPoses<'a> {
    request: &'a DesignRequest,
    variables: &'a [Variable],
    /// Text of the robot file with all changes of the request.
    text: String,
    states: Vec<State>,
}

impl<'a> RobotAtPoses<'a> {
    pub(crate) fn new(request: &'a DesignRequest, variables: &'a [Variable], text: String) -> Self {
        let states = match &request.poses {
            None => vec![request.state.clone()],
            Some(poses) => {
                poses.iter().map(|pose| State { pose: Some(Pose::Angles(*pose)), ..request.state.clone() }).collect()
            }
        };
        Self { request, variables, text, states }
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

    /// Error with the pose at which it arose.
    fn at_pose(&self, pose: usize, error: anyhow::Error) -> anyhow::Error {
        let Some(poses) = self.request.poses.as_ref().filter(|poses| poses.len() > 1) else { return error };
        let [x, y, z, ..] = poses[pose];
        error.context(format!("pose {}, ({x}, {y}, {z}) m", pose + 1))
    }

    /// Results at all poses with their derivatives. `sides` says how many frequencies go below the band to avoid.
    ///
    /// # Errors
    /// Values that the robot file cannot have, a pose without equilibrium, or results without derivatives.
    pub(crate) fn evaluate(&self, values: &[f64], sides: &[Option<usize>]) -> Result<Evaluated> {
        let parameters = Parameters::from_toml(&self.text_with(values)?).map_err(|error| anyhow!("{error}"))?;
        let mut found = Evaluated::default();
        for pose in 0..self.count() {
            let at_rest = self.at_rest(parameters.robot().clone(), pose)?;
            let below = sides.get(pose).copied().flatten();
            self.directions(&parameters, &at_rest.robot)
                .and_then(|directions| found.add_pose(self.request, &at_rest, &directions, below))
                .map_err(|error| self.at_pose(pose, error))?;
        }
        Ok(found)
    }

    /// Changes of a robot per unit of each value.
    fn directions(&self, parameters: &Parameters, robot: &Robot) -> Result<Vec<RobotChange>> {
        let direction = |variable: &Variable| {
            let change = parameters.change_of(variable.index, robot);
            change.ok_or_else(|| anyhow!("{}: results have no derivatives by this value", variable.path))
        };
        self.variables.iter().map(direction).collect()
    }
}

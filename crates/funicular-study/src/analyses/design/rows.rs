//! Robot with other values at all poses: its results and their derivatives by the values, as rows of a linear problem.

use super::band::Places;
use super::variables::Variable;
use crate::analyses::gradient::{held, no_solution};
use crate::at_rest::{self, AtRest};
use crate::names::DesignGoal;
use crate::request::{DesignRequest, Pose, RobotText, State};
use crate::set_values;
use anyhow::{Result, anyhow};
use funicular::cable::CableModel;
use funicular::dynamics::Linearisation;
use funicular::gradient::{Gradients, Hold, VibrationGradients};
use funicular::math::max_min::{Evaluation, LinearisedFunction};
use funicular::modes::{self, Mode};
use funicular::robot::parameters::Parameters;
use funicular::robot::{Robot, RobotChange};
use funicular::statics::StaticModel;

/// Number of lowest modes that are rows: more than exchange their places in one step.
const MODES: usize = 6;

/// Limit of the search for the lowest modes [Hz].
const HIGHEST_HZ: f64 = 1e4;

/// Relative distance of frequencies below which their modes mix within a step, so that combinations of them are rows
/// as well.
const NEAR: f64 = 1e-3;

/// Upper limit of the frequencies beside a band, over its last frequency: modes farther above do not reach it in a step.
const ABOVE_BAND: f64 = 1.2;

/// Kind of a demand: frequency beside a band.
pub(crate) const BAND: usize = 2;

/// Derivatives of a result by every value.
type Slopes = Vec<f64>;

/// Robot whose values change, at all poses.
pub(crate) struct AtPoses<'a> {
    request: &'a DesignRequest,
    variables: &'a [Variable],
    /// Text of the robot file with all changes of the request.
    text: String,
    states: Vec<State>,
}

/// Results at one pose.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct PoseValues {
    /// Value of the goal.
    pub(crate) goal: f64,
    /// First natural frequency, if it is demanded [Hz].
    pub(crate) frequency_hz: Option<f64>,
    /// Minimum stiffness, if it is demanded [N/m].
    pub(crate) stiffness: Option<f64>,
    /// Natural frequency that is deepest in the band or nearest to it, if a band is to be avoided [Hz].
    pub(crate) beside_band_hz: Option<f64>,
    /// Places of the natural frequencies beside and in the band.
    pub(crate) places: Option<Places>,
}

/// Functions of the values of all poses, with the results of every pose.
#[derive(Default)]
pub(crate) struct Evaluated {
    pub(crate) evaluation: Evaluation,
    pub(crate) poses: Vec<PoseValues>,
    /// Number of rows of the goal of each pose.
    pub(crate) rows_per_pose: Vec<usize>,
    /// Pose of every demand, and its kind: 0 frequency, 1 stiffness, [`BAND`].
    pub(crate) demands: Vec<(usize, usize)>,
}

impl<'a> AtPoses<'a> {
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

    /// Text of the robot file with other values.
    pub(crate) fn text_with(&self, values: &[f64]) -> Result<String> {
        let assignments = self
            .variables
            .iter()
            .zip(values)
            .map(|(variable, value)| variable.assignment(*value))
            .collect::<Result<Vec<_>>>()?;
        Ok(set_values::apply(&self.text, &assignments)?)
    }

    /// Robot at one pose with other values.
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

    /// Results at all poses with their derivatives. `sides` are those of the band to avoid.
    ///
    /// # Errors
    /// Values that the robot file cannot have, a pose without equilibrium, or results without derivatives.
    pub(crate) fn evaluate(&self, values: &[f64], sides: &[Option<usize>]) -> Result<Evaluated> {
        let parameters = Parameters::from_toml(&self.text_with(values)?).map_err(|error| anyhow!("{error}"))?;
        let mut found = Evaluated::default();
        for pose in 0..self.count() {
            let at_rest = self.at_rest(parameters.robot().clone(), pose)?;
            let below = sides.get(pose).copied().flatten();
            self.add(&parameters, &at_rest, (pose, below), &mut found).map_err(|error| self.at_pose(pose, error))?;
        }
        Ok(found)
    }

    /// Adds the rows of one pose, where this number of frequencies has to be below the band; without a number each goes to the
    /// nearer side.
    fn add(
        &self,
        parameters: &Parameters,
        at_rest: &AtRest,
        (pose, below): (usize, Option<usize>),
        found: &mut Evaluated,
    ) -> Result<()> {
        let request = self.request;
        let directions = self
            .variables
            .iter()
            .map(|variable| {
                parameters
                    .change_of(variable.index, &at_rest.robot)
                    .ok_or_else(|| anyhow!("{}: results have no derivatives by this value", variable.path))
            })
            .collect::<Result<Vec<_>>>()?;
        let group = if request.weights.is_some() { pose } else { 0 };
        let along = |gradient: &RobotChange| -> Slopes { directions.iter().map(|of| gradient.dot(of)).collect() };
        let row = |value: f64, slopes: &Slopes, factor: f64| LinearisedFunction {
            value: value * factor,
            gradient: slopes.iter().map(|slope| factor * slope).collect(),
            group,
        };
        let gradients = held(at_rest, Hold::Rule)?;
        let linearisation = at_rest::linearisation(&request.model, at_rest.equilibrium.model);
        let mut values = PoseValues::default();

        // The goal.
        match request.goal {
            DesignGoal::First | DesignGoal::Platform => {
                let of_goal = linearisation_of_goal(request, at_rest.equilibrium.model);
                let lowest = lowest(at_rest, &gradients, of_goal, &along)?;
                values.goal = lowest.first().map_or(0.0, |(hz, _)| *hz);
                found.evaluation.objectives.extend(lowest.iter().map(|(hz, gradient)| row(*hz, gradient, 1.0)));
            }
            DesignGoal::Stiffness => {
                let stiffnesses = gradients.stiffnesses().map_err(no_solution)?;
                values.goal = stiffnesses.first().map_or(0.0, |(value, _)| *value);
                found.evaluation.objectives.extend(stiffnesses.iter().map(|(value, of)| row(*value, &along(of), 1.0)));
            }
            DesignGoal::RopeMass | DesignGoal::RopeLength => {
                let by_mass = request.goal == DesignGoal::RopeMass;
                let (value, slopes) = rope(at_rest, &gradients, by_mass, &along);
                values.goal = value;
                // Less is better.
                found.evaluation.objectives.push(row(value, &slopes, -1.0));
            }
        }

        // The demands, each relative to its limit.
        let before = found.evaluation.objectives.len();
        let counted: usize = found.rows_per_pose.iter().sum();
        found.rows_per_pose.push(before - counted);
        let mut demand = |kind: usize, row: LinearisedFunction| {
            found.evaluation.demands.push(row);
            found.demands.push((pose, kind));
        };
        let over = |mut row: LinearisedFunction, limit: f64, scale: f64| {
            row.value = (row.value - limit) / scale;
            row.gradient.iter_mut().for_each(|slope| *slope /= scale);
            row
        };
        if let Some(limit) = request.min_frequency_hz {
            let lowest = lowest(at_rest, &gradients, linearisation, &along)?;
            values.frequency_hz = lowest.first().map(|(hz, _)| *hz);
            for (hz, slopes) in &lowest {
                demand(0, over(row(*hz, slopes, 1.0), limit, limit));
            }
        }
        if let Some(limit) = request.min_stiffness_n_per_m {
            let stiffnesses = gradients.stiffnesses().map_err(no_solution)?;
            values.stiffness = stiffnesses.first().map(|(value, _)| *value);
            for (value, gradient) in &stiffnesses {
                demand(1, over(row(*value, &along(gradient), 1.0), limit, limit));
            }
        }
        if let Some([first, last]) = request.avoid_hz {
            // A frequency that has to be below the band may be far above it.
            let mut limit = ABOVE_BAND * last;
            let (dynamics, list) = loop {
                let (dynamics, _) = at_rest.dynamics_for_gradients(linearisation, limit)?;
                modes::check_count(&dynamics, limit, modes::MAX_MODES)?;
                let list = modes::below(&dynamics, limit).modes;
                if list.len() >= below.unwrap_or(0) || limit > HIGHEST_HZ {
                    break (dynamics, list);
                }
                limit *= ABOVE_BAND;
            };

            let half = 0.5 * (first + last);
            let count = |limit: f64| list.iter().filter(|mode| mode.frequency_hz < limit).count();
            values.places = Some(Places { below: count(first), nearer_below: count(half), not_above: count(last) });

            let vibration = gradients.vibration(&dynamics).map_err(no_solution)?;
            let depth = |hz: f64| (hz - first).min(last - hz);
            for ModeRow { hz, slopes, modes } in rows_of(&vibration, &list, &along) {
                if values.beside_band_hz.is_none_or(|other| depth(hz) > depth(other)) {
                    values.beside_band_hz = Some(hz);
                }
                let goes_below = match below {
                    // Modes that part have no row for their common motions.
                    Some(number) if modes[0] < number && modes[1] >= number => continue,
                    Some(number) => modes[0] < number,
                    None => hz < half,
                };
                let beside = if goes_below {
                    over(row(hz, &slopes, -1.0), -first, first)
                } else {
                    over(row(hz, &slopes, 1.0), last, last)
                };
                demand(BAND, beside);
            }
        }
        found.poses.push(values);
        Ok(())
    }
}

/// Linearisation of a request for its goal: for that of the platform, the platform alone vibrates, on the static
/// stiffness of its cables.
pub(crate) fn linearisation_of_goal(request: &DesignRequest, model: StaticModel) -> Linearisation {
    let linearisation = at_rest::linearisation(&request.model, model);
    match (request.goal, model) {
        (DesignGoal::Platform, StaticModel::Catenary) => {
            Linearisation { cable_model: CableModel::CatenaryStatic, ..linearisation }
        }
        (DesignGoal::Platform, StaticModel::Ideal | StaticModel::Spring) => {
            Linearisation { cable_model: CableModel::Spring, ..linearisation }
        }
        _ => linearisation,
    }
}

/// Lowest natural frequencies [Hz] with their derivatives.
fn lowest(
    at_rest: &AtRest,
    gradients: &Gradients<'_>,
    linearisation: Linearisation,
    along: &dyn Fn(&RobotChange) -> Slopes,
) -> Result<Vec<(f64, Slopes)>> {
    let (robot, rest) = (&at_rest.robot, &at_rest.equilibrium);
    // The platform alone has no more modes than degrees of freedom.
    let is_dynamic = linearisation.cable_model.is_dynamic();
    let wanted = if is_dynamic { MODES } else { MODES.min(robot.platform.motion.count()) };
    let (dynamics, list) = modes::lowest(robot, rest, linearisation, wanted, HIGHEST_HZ)?;
    let vibration = gradients.vibration(&dynamics).map_err(no_solution)?;
    let rows = rows_of(&vibration, &list.modes[..list.modes.len().min(wanted)], along);
    Ok(rows.into_iter().map(|row| (row.hz, row.slopes)).collect())
}

/// Natural frequency with its derivatives.
struct ModeRow {
    hz: f64,
    slopes: Slopes,
    /// Numbers of the two modes whose motions it combines, the lower one first; twice the same for a mode alone.
    modes: [usize; 2],
}

/// Natural frequencies with their derivatives. Modes that nearly share a frequency mix within a step: for each pair of
/// them, the sum and the difference of their motions have a row as well, so that the linear problem knows all of the
/// block of derivatives.
fn rows_of(vibration: &VibrationGradients<'_>, modes: &[Mode], along: &dyn Fn(&RobotChange) -> Slopes) -> Vec<ModeRow> {
    let mut rows = Vec::with_capacity(modes.len());
    let mut from = 0;
    while from < modes.len() {
        let mut to = from + 1;
        while to < modes.len() && modes[to].frequency_hz < (1.0 + NEAR) * modes[to - 1].frequency_hz {
            to += 1;
        }
        let cluster: Vec<&Mode> = modes[from..to].iter().collect();
        let block: Vec<Vec<Slopes>> =
            vibration.block(&cluster).iter().map(|row| row.iter().map(along).collect()).collect();
        for (i, mode) in cluster.iter().enumerate() {
            rows.push(ModeRow { hz: mode.frequency_hz, slopes: block[i][i].clone(), modes: [from + i; 2] });
            for (j, other) in cluster.iter().enumerate().skip(i + 1) {
                let mean = (0.5 * (mode.frequency_hz.powi(2) + other.frequency_hz.powi(2))).sqrt();
                for sign in [1.0, -1.0] {
                    let both = (0..block[i][i].len())
                        .map(|k| 0.5 * (block[i][i][k] + block[j][j][k]) + sign * block[i][j][k])
                        .collect();
                    rows.push(ModeRow { hz: mean, slopes: both, modes: [from + i, from + j] });
                }
            }
        }
        from = to;
    }
    rows
}

/// Mass [kg] or length [m] of all ropes, with its derivatives.
fn rope(
    at_rest: &AtRest,
    gradients: &Gradients<'_>,
    by_mass: bool,
    along: &dyn Fn(&RobotChange) -> Slopes,
) -> (f64, Slopes) {
    let cables = &at_rest.robot.cables;
    let mut own = RobotChange::none(cables.len());
    let (mut sum, mut slopes) = (0.0, Vec::new());
    for (i, (length, state)) in gradients.lengths().iter().zip(&at_rest.equilibrium.cables).enumerate() {
        let factor = if by_mass { cables[i].material.mass_per_length } else { 1.0 };
        sum += factor * state.unstrained_length;
        let of_length = along(length);
        slopes.resize(of_length.len(), 0.0);
        slopes.iter_mut().zip(&of_length).for_each(|(sum, slope)| *sum += factor * slope);
        if by_mass {
            own.cables[i].mass_per_length = state.unstrained_length;
        }
    }
    slopes.iter_mut().zip(along(&own)).for_each(|(sum, slope)| *sum += slope);
    (sum, slopes)
}

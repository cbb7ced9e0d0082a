//! Predictions of all measurements by a robot with other values, and their derivatives.

use super::observations::{Kind, Observation, Stage, observations, weights};
use super::unknowns::Unknown;
use crate::at_rest::{self, AtRest};
use crate::measurements::MeasuredFrequency;
use crate::request::{Experiment, IdentifyRequest};
use crate::signals::{Input, Output};
use anyhow::{Result, anyhow, bail};
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::least_squares::Problem;
use funicular::math::{Complex, DMat, Vec3};
use funicular::modes::{self, Mode, tracking::best_pairs};
use funicular::response::{self, Port, Quantity, Signal};
use funicular::robot::parameters::Parameters;
use funicular::robot::{Robot, State};

/// Step of the central differences, relative to the spread of a value: their error grows with its square, the rounding of
/// the equilibrium with its inverse.
const STEP: f64 = 3e-4;

/// Ratio of the limit of a list of modes to the highest measured frequency.
const BEYOND: f64 = 1.3;

/// Number of times that this limit is doubled until the list has all numbered modes.
const MAX_DOUBLINGS: usize = 8;

/// Deviations beyond which a mode does not differ as a partner of a measured frequency.
const FAR: f64 = 1000.0;

/// Response of an experiment with its signals.
struct ResponseOf {
    input: Input,
    input_point_p: Option<Vec3>,
    output: Output,
    output_point_p: Option<Vec3>,
    /// Range of its values in the predictions.
    first: usize,
    /// True if the first response of its group has the same frequencies.
    group: usize,
}

/// Experiment with what its predictions need.
struct Prepared<'a> {
    given: &'a Experiment,
    name: String,
    responses: Vec<ResponseOf>,
    observations: Vec<Observation>,
    highest_hz: f64,
}

/// Modes to which the frequencies of each experiment are assigned: indices in the ascending list.
pub(crate) type Assigned = Vec<Vec<usize>>;

/// Predictions of all experiments.
#[derive(Debug, Clone)]
pub(crate) struct Predicted {
    /// Values in the order of the observations.
    pub(crate) values: Vec<Complex>,
    /// Modes of the frequencies.
    pub(crate) assigned: Assigned,
}

/// Robot with values to identify and its measurements.
pub(crate) struct IdentifiedModel<'a> {
    pub(crate) parameters: &'a Parameters,
    pub(crate) unknowns: &'a [Unknown],
    request: &'a IdentifyRequest,
    experiments: Vec<Prepared<'a>>,
    /// All observations.
    pub(crate) observations: Vec<Observation>,
    /// Residuals in use.
    pub(crate) stage: Stage,
    /// Choices at the point that was linearised last: modes of frequencies, weights of observations.
    held: Option<(Assigned, Vec<f64>)>,
    /// Stops the search.
    is_cancelled: &'a dyn Fn() -> bool,
    /// Number of robots that were computed.
    pub(crate) evaluations: usize,
    /// Reason for which the last point had no prediction.
    pub(crate) refusal: Option<anyhow::Error>,
}

impl<'a> IdentifiedModel<'a> {
    /// Checks the measurements.
    ///
    /// # Errors
    /// Signals that the robot does not have, measurements that are not possible, or none.
    pub(crate) fn new(
        parameters: &'a Parameters,
        unknowns: &'a [Unknown],
        request: &'a IdentifyRequest,
        is_cancelled: &'a dyn Fn() -> bool,
    ) -> Result<Self> {
        if request.experiments.is_empty() {
            bail!("⟪experiments⟫ is empty: give at least one measurement");
        }
        let several = request.experiments.len() > 1;
        let mut experiments = Vec::with_capacity(request.experiments.len());
        for (i, given) in request.experiments.iter().enumerate() {
            let name = match given.name.as_str() {
                "" if several => format!("experiment {}", i + 1),
                "" => "the experiment".to_owned(),
                name => format!("experiment {name}"),
            };
            experiments.push(Prepared::new(parameters.robot(), given, name, request)?);
        }
        let observations = experiments.iter().flat_map(|experiment| experiment.observations.iter().copied()).collect();
        Ok(Self {
            parameters,
            unknowns,
            request,
            experiments,
            observations,
            stage: Stage::Complex,
            held: None,
            is_cancelled,
            evaluations: 0,
            refusal: None,
        })
    }

    /// Values of the unknowns at coordinates.
    pub(crate) fn values(&self, x: &[f64]) -> Vec<f64> {
        self.unknowns.iter().zip(x).map(|(unknown, x)| unknown.value(*x)).collect()
    }

    /// Robot with values at coordinates, before the changes of an experiment.
    pub(crate) fn robot(&self, x: &[f64]) -> Result<Robot> {
        let values: Vec<(usize, f64)> =
            self.unknowns.iter().zip(self.values(x)).map(|(unknown, value)| (unknown.index, value)).collect();
        Ok(self.parameters.robot_with(&values)?)
    }

    /// Robot of an experiment at rest, linearised up to a frequency.
    pub(crate) fn at_rest(&self, x: &[f64], experiment: usize) -> Result<AtRest> {
        self.experiments[experiment].at_rest(self.robot(x)?, self.request)
    }

    /// Names of the experiments.
    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        self.experiments.iter().map(|experiment| experiment.name.as_str())
    }

    /// Linearisation of an equilibrium up to a frequency [Hz].
    pub(crate) fn linearisation(&self, at_rest: &AtRest) -> Linearisation {
        at_rest::linearisation(&self.request.model, at_rest.equilibrium.model)
    }

    /// Predictions at coordinates; modes are assigned anew, or as `assigned` says.
    ///
    /// # Errors
    /// Values that the robot cannot have, or a robot without equilibrium or response.
    pub(crate) fn predict(&mut self, x: &[f64], assigned: Option<&Assigned>) -> Result<Predicted> {
        self.evaluations += 1;
        let robot = self.robot(x)?;
        let mut predicted = Predicted { values: Vec::with_capacity(self.observations.len()), assigned: Vec::new() };
        for (i, experiment) in self.experiments.iter().enumerate() {
            let held = assigned.map(|all| &all[i][..]);
            let own = experiment
                .predict(robot.clone(), self.request, self.stage, held, &mut predicted.values)
                .map_err(|error| error.context(experiment.name.clone()))?;
            predicted.assigned.push(own);
        }
        Ok(predicted)
    }

    /// Predictions, or the reason why there are none, kept for the message.
    fn try_predict(&mut self, x: &[f64], assigned: Option<&Assigned>) -> Option<Predicted> {
        match self.predict(x, assigned) {
            Ok(predicted) => Some(predicted),
            Err(error) => {
                self.refusal = Some(error);
                None
            }
        }
    }

    /// Residuals of predictions and of the priors.
    fn residuals_of(&self, x: &[f64], values: &[Complex], weights: &[f64]) -> Option<Vec<f64>> {
        let mut residuals = Vec::new();
        for ((observation, value), weight) in self.observations.iter().zip(values).zip(weights) {
            observation.residuals(self.stage, *value, *weight, &mut residuals);
        }
        for (unknown, x) in self.unknowns.iter().zip(x) {
            if let Some((prior, deviation)) = unknown.coordinate_prior() {
                residuals.push((x - prior) / deviation);
            }
        }
        residuals.iter().all(|residual| residual.is_finite()).then_some(residuals)
    }

    /// Weights of the observations at the point that was linearised last.
    pub(crate) fn weights(&self) -> &[f64] {
        self.held.as_ref().map_or(&[], |(_, weights)| weights)
    }

    /// Number of residuals of the priors.
    pub(crate) fn prior_count(&self) -> usize {
        self.unknowns.iter().filter(|unknown| unknown.prior.is_some()).count()
    }

    /// Derivatives of the predictions by a coordinate, by central differences; one-sided ones at a bound or beside a
    /// robot without equilibrium.
    fn differences(&mut self, x: &[f64], here: &Predicted, k: usize) -> Option<Vec<Complex>> {
        let step = STEP * self.unknowns[k].spread();
        let (low, high) = self.unknowns[k].coordinate_bounds();
        let mut at = |shift: f64| -> Option<Vec<Complex>> {
            if !(low..=high).contains(&(x[k] + shift)) {
                return None;
            }
            let mut moved = x.to_vec();
            moved[k] += shift;
            Some(self.try_predict(&moved, Some(&here.assigned))?.values)
        };
        let (before, after) = (at(-step), at(step));
        let difference = |a: &[Complex], b: &[Complex], width: f64| {
            a.iter().zip(b).map(|(a, b)| (b - a) / width).collect::<Vec<Complex>>()
        };
        Some(match (before, after) {
            (Some(before), Some(after)) => difference(&before, &after, 2.0 * step),
            (None, Some(after)) => difference(&here.values, &after, step),
            (Some(before), None) => difference(&before, &here.values, step),
            (None, None) => return None,
        })
    }
}

impl Problem for IdentifiedModel<'_> {
    fn residuals(&mut self, x: &[f64]) -> Option<Vec<f64>> {
        let (assigned, weights) = self.held.clone()?;
        let predicted = self.try_predict(x, Some(&assigned))?;
        self.residuals_of(x, &predicted.values, &weights)
    }

    fn linearised(&mut self, x: &[f64]) -> Option<(Vec<f64>, DMat)> {
        let here = self.try_predict(x, None)?;
        let weights = weights(&self.observations, &here.values, self.stage);
        let residuals = self.residuals_of(x, &here.values, &weights)?;

        let mut jacobian = DMat::zeros(residuals.len(), x.len());
        let mut prior_row = residuals.len() - self.prior_count();
        for k in 0..x.len() {
            if (self.is_cancelled)() {
                // The search notices it before the next step; the point itself is complete.
                break;
            }
            let change = self.differences(x, &here, k)?;
            let mut column = Vec::with_capacity(residuals.len());
            for (((observation, value), change), weight) in
                self.observations.iter().zip(&here.values).zip(&change).zip(&weights)
            {
                observation.derivatives(self.stage, *value, *change, *weight, &mut column);
            }
            for (row, value) in column.iter().enumerate() {
                jacobian[(row, k)] = *value;
            }
            if let Some((_, deviation)) = self.unknowns[k].coordinate_prior() {
                jacobian[(prior_row, k)] = 1.0 / deviation;
                prior_row += 1;
            }
        }
        if !jacobian.iter().all(|entry| entry.is_finite()) {
            return None;
        }
        self.held = Some((here.assigned, weights));
        Some((residuals, jacobian))
    }

    fn is_cancelled(&self) -> bool {
        (self.is_cancelled)()
    }
}

impl<'a> Prepared<'a> {
    fn new(robot: &Robot, given: &'a Experiment, name: String, request: &IdentifyRequest) -> Result<Self> {
        let observations = observations(given, &name, request)?;
        let robot = mounted(robot.clone(), given, &name)?;
        for (key, values) in
            [("measured_tensions_n", &given.measured_tensions_n), ("measured_lengths_m", &given.measured_lengths_m)]
        {
            if let Some(values) = values
                && values.len() != robot.cables.len()
            {
                bail!("{name}: `{key}` has {} numbers for {} cables", values.len(), robot.cables.len());
            }
        }
        if let Some(pose) = given.measured_pose {
            at_rest::check_pose(&robot, &pose.to_robot()?)?;
        }
        if request.rigid_cables && !given.responses.is_empty() {
            bail!(
                "⟪rigid_cables⟫ does not go with responses, which are computed for cables that stretch: leave it out"
            );
        }
        if given.cables.is_some() && given.state.hold_lengths_of_pose {
            bail!("{name}: `hold_lengths_of_pose` does not go with `cables`: give `lengths_m`");
        }

        // Responses with the same frequencies are computed together.
        let mut responses: Vec<ResponseOf> = Vec::with_capacity(given.responses.len());
        let mut first = observations.iter().filter(|observation| observation.kind != Kind::Response).count();
        for (i, response) in given.responses.iter().enumerate() {
            let input = Input::parse(&response.input)
                .map_err(|error| anyhow!("{name}, `input` {}: {error}", response.input))?;
            let output = Output::parse(&response.output)
                .map_err(|error| anyhow!("{name}, `output` {}: {error}", response.output))?;
            let [input_point_p, output_point_p] =
                [response.input_point_m, response.output_point_m].map(|point| point.map(Vec3::from));
            let refuse = |error| anyhow!("{name}, response {i}: {error}");
            input.signal(&robot, input_point_p).map_err(refuse)?;
            output.signal(&robot, output_point_p).map_err(refuse)?;
            let group = (0..i).find(|&j| given.responses[j].frequency_hz == response.frequency_hz).unwrap_or(i);
            responses.push(ResponseOf { input, input_point_p, output, output_point_p, first, group });
            first += response.frequency_hz.len();
        }
        let of_responses = given.responses.iter().flat_map(|response| response.frequency_hz.iter().copied());
        let of_list = given.frequencies.iter().map(|frequency| BEYOND * frequency.frequency_hz);
        let highest_hz = of_responses.chain(of_list).fold(0.0, f64::max);
        Ok(Self { given, name, responses, observations, highest_hz })
    }

    fn at_rest(&self, robot: Robot, request: &IdentifyRequest) -> Result<AtRest> {
        let robot = mounted(robot, self.given, &self.name)?;
        at_rest::equilibrium(robot, &request.robot, &self.given.state, &request.tensions)
    }

    /// Appends the predictions, and returns the modes of the frequencies.
    fn predict(
        &self,
        robot: Robot,
        request: &IdentifyRequest,
        stage: Stage,
        assigned: Option<&[usize]>,
        out: &mut Vec<Complex>,
    ) -> Result<Vec<usize>> {
        let at_rest = self.at_rest(robot, request)?;
        self.statics(&at_rest, out)?;
        if stage == Stage::Statics {
            // The other predictions are not used.
            let rest = self.observations.iter().filter(|observation| observation.kind != Kind::Static);
            out.extend(rest.map(|observation| observation.measured));
            return Ok(vec![0; self.given.frequencies.len()]);
        }

        let linearisation = at_rest::linearisation(&request.model, at_rest.equilibrium.model);
        let list = self.modes(&at_rest, linearisation, request.rigid_cables)?;
        let assigned = match assigned {
            Some(assigned) => assigned.to_vec(),
            None => self.assigned(&list)?,
        };
        let mode = |k: usize| list.get(assigned[k]).ok_or_else(|| anyhow!("the list of modes is too short"));
        for k in 0..self.given.frequencies.len() {
            out.push(mode(k)?.frequency_hz.into());
        }
        for (k, measured) in self.given.frequencies.iter().enumerate() {
            if measured.damping_ratio.is_some() {
                out.push(mode(k)?.damping_ratio.into());
            }
        }
        self.responses(&at_rest, linearisation, out)?;
        Ok(assigned)
    }

    /// Appends differences from the measured pose, tensions and lengths.
    fn statics(&self, at_rest: &AtRest, out: &mut Vec<Complex>) -> Result<()> {
        let rest = &at_rest.equilibrium;
        if let Some(pose) = self.given.measured_pose {
            let measured = pose.to_robot()?;
            let shift = rest.pose.position_w - measured.position_w;
            let turn = (rest.pose.rot_wp * measured.rot_wp.inverse()).scaled_axis();
            out.extend(shift.iter().chain(turn.iter()).map(|number| Complex::from(*number)));
        }
        if self.given.measured_tensions_n.is_some() {
            out.extend(rest.cables.iter().map(|cable| Complex::from(cable.tension_platform)));
        }
        if self.given.measured_lengths_m.is_some() {
            out.extend(rest.cables.iter().map(|cable| Complex::from(cable.unstrained_length)));
        }
        Ok(())
    }

    /// Modes for the list of measured frequencies, ascending.
    fn modes(&self, at_rest: &AtRest, linearisation: Linearisation, rigid: bool) -> Result<Vec<Mode>> {
        let measured = &self.given.frequencies;
        if measured.is_empty() {
            return Ok(Vec::new());
        }
        let highest = measured.iter().map(|frequency| frequency.frequency_hz).fold(0.0, f64::max);
        let numbered = measured.iter().filter_map(MeasuredFrequency::number).max().unwrap_or(0);
        let needed = numbered.max(measured.len());
        if rigid {
            let found = modes::with_rigid_cables(&at_rest.robot, &at_rest.equilibrium, f64::MAX)
                .map_err(|error| anyhow!("⟪rigid_cables⟫: {error}"))?;
            return enough(found.modes, needed);
        }
        let mut limit = BEYOND * highest;
        for _ in 0..MAX_DOUBLINGS {
            let dynamics = Dynamics::about(&at_rest.robot, &at_rest.equilibrium, linearisation, limit)?;
            modes::check_count(&dynamics, limit, modes::MAX_MODES)?;
            let found = modes::below(&dynamics, limit);
            if found.modes.len() >= needed {
                return Ok(found.modes);
            }
            limit *= 2.0;
        }
        enough(Vec::new(), needed)
    }

    /// Mode of each measured frequency: by its number, or else the pairs with the least distances altogether.
    fn assigned(&self, list: &[Mode]) -> Result<Vec<usize>> {
        let measured = &self.given.frequencies;
        let mut assigned: Vec<Option<usize>> =
            measured.iter().map(|frequency| frequency.number().map(|number| number - 1)).collect();
        let open: Vec<usize> = (0..measured.len()).filter(|&k| assigned[k].is_none()).collect();
        let free: Vec<usize> = (0..list.len()).filter(|i| !assigned.contains(&Some(*i))).collect();
        if open.len() > free.len() {
            bail!("{} frequencies have no number, and the robot has {} more modes", open.len(), free.len());
        }
        let deviations: Vec<f64> = self
            .observations
            .iter()
            .filter(|observation| observation.kind == Kind::Frequency)
            .map(|observation| observation.deviation)
            .collect();
        let likeness: Vec<Vec<f64>> = open
            .iter()
            .map(|&k| {
                let distance =
                    |i: &usize| (list[*i].frequency_hz / measured[k].frequency_hz).ln().abs() / deviations[k];
                free.iter().map(|i| 1.0 - distance(i).min(FAR) / FAR).collect()
            })
            .collect();
        for (row, column) in best_pairs(&likeness, free.len()) {
            assigned[open[row]] = Some(free[column]);
        }
        Ok(assigned.into_iter().flatten().collect())
    }

    /// Appends the responses.
    fn responses(&self, at_rest: &AtRest, linearisation: Linearisation, out: &mut Vec<Complex>) -> Result<()> {
        if self.responses.is_empty() {
            return Ok(());
        }
        let AtRest { robot, equilibrium, .. } = at_rest;
        let dynamics = Dynamics::about(robot, equilibrium, linearisation, self.highest_hz)?;
        let start = out.len();
        let offset = self.responses[0].first;
        out.resize(start + self.observations.len() - offset, Complex::default());
        for group in 0..self.responses.len() {
            let members: Vec<&ResponseOf> = self.responses.iter().filter(|response| response.group == group).collect();
            if members.is_empty() {
                continue;
            }
            // Signals of the group, each once.
            let mut inputs: Vec<Signal> = Vec::new();
            let mut outputs: Vec<(Signal, Quantity)> = Vec::new();
            let mut places = Vec::with_capacity(members.len());
            for member in &members {
                let input = member.input.signal(robot, member.input_point_p)?;
                let output = (member.output.signal(robot, member.output_point_p)?, member.output.quantity);
                let from = place(&mut inputs, input);
                let to = place(&mut outputs, output);
                places.push((from, to));
            }
            let signals: Vec<Signal> = inputs.iter().copied().chain(outputs.iter().map(|output| output.0)).collect();
            let mut input_ports = Port::all(robot, equilibrium, &dynamics, &signals, true)?;
            let output_ports = input_ports.split_off(inputs.len());
            let output_ports: Vec<(Port, Quantity)> =
                output_ports.into_iter().zip(outputs.iter().map(|output| output.1)).collect();
            let rows =
                response::matrix(&dynamics, &self.given.responses[group].frequency_hz, &input_ports, &output_ports)?;
            for (member, (from, to)) in members.iter().zip(places) {
                let row = &rows[to * inputs.len() + from];
                out[start + member.first - offset..][..row.len()].copy_from_slice(row);
            }
        }
        Ok(())
    }
}

/// Place of an element in a list, to which it is added if it is new.
fn place<T: PartialEq>(list: &mut Vec<T>, element: T) -> usize {
    list.iter().position(|other| *other == element).unwrap_or_else(|| {
        list.push(element);
        list.len() - 1
    })
}

/// List of modes that is long enough.
fn enough(list: Vec<Mode>, needed: usize) -> Result<Vec<Mode>> {
    if list.len() < needed {
        bail!("the robot has {} modes, and {needed} are measured or numbered", list.len());
    }
    Ok(list)
}

/// Robot with the cables that were mounted in an experiment.
fn mounted(mut robot: Robot, given: &Experiment, name: &str) -> Result<Robot> {
    let Some(cables) = &given.cables else { return Ok(robot) };
    let known: Vec<String> = robot.cables.iter().map(|cable| cable.name.clone()).collect();
    if let Some(unknown) = cables.iter().find(|cable| !known.contains(cable)) {
        bail!("{name}: the robot has no cable \"{unknown}\"{}", crate::names::suggestion(unknown, &known));
    }
    if cables.is_empty() {
        bail!("{name}: `cables` is empty: name the cables that were mounted");
    }
    if let State::Lengths(lengths) = &mut robot.state {
        let mut kept = known.iter().map(|cable| cables.contains(cable));
        lengths.retain(|_| kept.next().unwrap_or(false));
    }
    robot.cables.retain(|cable| cables.contains(&cable.name));
    Ok(robot)
}

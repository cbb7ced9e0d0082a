//! Predictions of the measurements of one experiment.

use super::observations::{Observation, ROBUST, Stage, Subject};
use super::reading::observations;
use crate::at_rest::{self, AtRest};
use crate::measurements::MeasuredFrequency;
use crate::payload::carrying;
use crate::request::{self, Experiment, IdentifyRequest};
use crate::signals::{Input, Output};
use crate::values::not_negative;
use anyhow::{Result, anyhow, bail};
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{Complex, Vec3};
use funicular::modes::{self, Mode, Wanted, tracking::best_pairs};
use funicular::response::{self, Port, Quantity, Signal};
use funicular::robot::{Robot, State};
use funicular::statics::Equilibrium;

/// Ratio of the limit of a list of modes to the highest measured frequency.
const BEYOND: f64 = 1.3;

/// Ratio of the highest limit to this one: the limit is doubled until the list has all numbered modes.
const MAX_RAISE: f64 = 128.0;

/// Response of an experiment with its signals.
pub(super) struct ResponseOf {
    input: Input,
    input_point_p: Option<Vec3>,
    output: Output,
    output_point_p: Option<Vec3>,
    /// Index of its first value in the predictions.
    first: usize,
    /// Number of the first response with the same frequencies.
    group: usize,
}

/// Responses with the same frequencies, which are computed together.
pub(super) struct ResponseGroup {
    /// Inputs, each once.
    pub(super) inputs: Vec<Signal>,
    /// Outputs, each once.
    pub(super) outputs: Vec<(Signal, Quantity)>,
    /// Frequencies [Hz].
    pub(super) frequency_hz: Vec<f64>,
    /// Per response: index of its pair, as [`response::matrix`] counts them, and of its first value in the predictions.
    pub(super) rows: Vec<(usize, usize)>,
}

/// Robot of an experiment at values, with its predictions.
pub(super) struct Solved {
    /// Robot at rest.
    pub(super) at_rest: AtRest,
    /// Modes, ascending, and the linearisation to which they belong; none for rigid cables.
    pub(super) modes: (Vec<Mode>, Option<Dynamics>),
    /// Modes to which the measured frequencies are assigned.
    pub(super) assigned: Vec<usize>,
    /// Linearisation for the responses.
    pub(super) of_responses: Option<Dynamics>,
    /// Predictions.
    pub(super) values: Vec<Complex>,
}

/// Experiment with checked measurements and signals, ready for predictions.
pub(super) struct Prepared<'a> {
    pub(super) given: &'a Experiment,
    pub(super) name: String,
    responses: Vec<ResponseOf>,
    pub(super) observations: Vec<Observation>,
    highest_hz: f64,
}

impl<'a> Prepared<'a> {
    /// Checks the measurements of an experiment.
    ///
    /// # Errors
    /// Signals that the robot does not have, or measurements that are not possible.
    pub(super) fn new(
        robot: &Robot,
        (number, given): (usize, &'a Experiment),
        name: String,
        request: &IdentifyRequest,
    ) -> Result<Self> {
        let observations = observations(given, number, &name, request)?;
        check_payload(given, &name)?;
        let robot = mounted(robot.clone(), given, &name)?;
        check_statics(&robot, given, &name)?;
        if request.rigid_cables && !given.responses.is_empty() {
            bail!(
                "⟪rigid_cables⟫ does not go with responses, which are computed for cables that stretch: leave it out"
            );
        }

        let mut responses: Vec<ResponseOf> = Vec::with_capacity(given.responses.len());
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
            let subject = Subject::Response { response: i, line: 0 };
            let first = observations.iter().position(|observation| observation.subject == subject).unwrap_or_default();
            let group = (0..i).find(|&j| given.responses[j].frequency_hz == response.frequency_hz).unwrap_or(i);
            responses.push(ResponseOf { input, input_point_p, output, output_point_p, first, group });
        }

        let of_responses = given.responses.iter().flat_map(|response| response.frequency_hz.iter().copied());
        let of_list = given.frequencies.iter().map(|frequency| BEYOND * frequency.frequency_hz);
        let highest_hz = of_responses.chain(of_list).fold(0.0, f64::max);
        Ok(Self { given, name, responses, observations, highest_hz })
    }

    /// Robot of the experiment at rest.
    ///
    /// # Errors
    /// A robot without equilibrium.
    pub(super) fn at_rest(&self, robot: Robot, request: &IdentifyRequest) -> Result<AtRest> {
        let robot = mounted(robot, self.given, &self.name)?;
        at_rest::equilibrium(robot, &request.robot, &self.given.state, &request.tensions)
    }

    /// Solves the robot and predicts all measurements; modes are assigned anew, or as `assigned` says.
    ///
    /// # Errors
    /// A robot without equilibrium or response, or with fewer modes than were measured.
    pub(super) fn solve(
        &self,
        robot: Robot,
        request: &IdentifyRequest,
        stage: Stage,
        assigned: Option<&[usize]>,
    ) -> Result<Solved> {
        let at_rest = self.at_rest(robot, request)?;
        if stage == Stage::Statics {
            let values = self.values(&at_rest, None)?;
            let assigned = vec![0; self.given.frequencies.len()];
            return Ok(Solved { at_rest, modes: (Vec::new(), None), assigned, of_responses: None, values });
        }

        let linearisation = at_rest::linearisation(&request.model, at_rest.equilibrium.model);
        let modes = self.modes(&at_rest, linearisation, request.rigid_cables)?;
        let assigned = match assigned {
            Some(assigned) => assigned.to_vec(),
            None => self.assigned(&modes.0)?,
        };
        let mut values = self.values(&at_rest, Some((&modes.0, &assigned)))?;
        let of_responses = self.responses(&at_rest, linearisation, &mut values)?;
        Ok(Solved { at_rest, modes, assigned, of_responses, values })
    }

    /// Predictions in the order of the observations, except those of responses, which are zero. Without modes,
    /// predictions of vibration are the measured values: they are not used.
    ///
    /// # Errors
    /// Fewer modes than were measured.
    fn values(&self, at_rest: &AtRest, modes: Option<(&[Mode], &[usize])>) -> Result<Vec<Complex>> {
        let rest = &at_rest.equilibrium;
        let difference = self.pose_difference(rest)?;
        let value = |observation: &Observation| -> Result<Complex> {
            Ok(match (observation.subject, modes) {
                (Subject::Pose(k), _) => difference[k].into(),
                (Subject::Tension(i), _) => rest.cables[i].tension_platform.into(),
                (Subject::Length(i), _) => rest.cables[i].unstrained_length.into(),
                (_, None) => observation.measured,
                (Subject::Frequency(k), Some((list, assigned))) => mode_at(list, assigned[k])?.frequency_hz.into(),
                (Subject::Damping(k), Some((list, assigned))) => mode_at(list, assigned[k])?.damping_ratio.into(),
                (Subject::Response { .. }, Some(_)) => Complex::default(),
            })
        };
        self.observations.iter().map(value).collect()
    }

    /// Difference of an equilibrium from the measured pose: position [m], then rotation vector [rad]; zeros if no pose
    /// was measured.
    fn pose_difference(&self, rest: &Equilibrium) -> Result<[f64; 6]> {
        let Some(pose) = self.given.measured_pose else { return Ok([0.0; 6]) };
        let measured = pose.to_robot()?;
        let shift = rest.pose.position_w - measured.position_w;
        let turn = (rest.pose.rot_wp * measured.rot_wp.inverse()).scaled_axis();
        Ok([shift.x, shift.y, shift.z, turn.x, turn.y, turn.z])
    }

    /// Modes for the list of measured frequencies, ascending, and the linearisation to which they belong.
    fn modes(
        &self,
        at_rest: &AtRest,
        linearisation: Linearisation,
        rigid: bool,
    ) -> Result<(Vec<Mode>, Option<Dynamics>)> {
        let measured = &self.given.frequencies;
        if measured.is_empty() {
            return Ok((Vec::new(), None));
        }
        let highest = measured.iter().map(|frequency| frequency.frequency_hz).fold(0.0, f64::max);
        let numbered = measured.iter().filter_map(MeasuredFrequency::number).max().unwrap_or(0);
        let needed = numbered.max(measured.len());
        if rigid {
            let found = modes::with_rigid_cables(&at_rest.robot, &at_rest.equilibrium, f64::MAX)
                .map_err(|error| anyhow!("⟪rigid_cables⟫: {error}"))?;
            return Ok((enough(found.modes, needed)?, None));
        }

        let (wanted, first) = (Wanted::Count(needed), BEYOND * highest);
        let found = modes::until(wanted, first, modes::doubled(MAX_RAISE * first), |limit| -> Result<_> {
            let dynamics = Dynamics::about(&at_rest.robot, &at_rest.equilibrium, linearisation, limit)?;
            modes::check_count(&dynamics, limit, modes::MAX_MODES)?;
            Ok(dynamics)
        })?;
        Ok((enough(found.modes.modes, needed)?, Some(found.dynamics)))
    }

    /// Mode of each measured frequency: the numbered one, otherwise the one of the pairs with the smallest χ², in which
    /// a distant pair has less weight.
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
            .filter(|observation| matches!(observation.subject, Subject::Frequency(_)))
            .map(|observation| observation.deviation)
            .collect();
        let similarity: Vec<Vec<f64>> = open
            .iter()
            .map(|&k| {
                let residual = |i: &usize| (list[*i].frequency_hz / measured[k].frequency_hz - 1.0) / deviations[k];
                free.iter().map(|i| 1.0 / (1.0 + (residual(i) / ROBUST).powi(2))).collect()
            })
            .collect();
        for (row, column) in best_pairs(&similarity, free.len()) {
            assigned[open[row]] = Some(free[column]);
        }
        Ok(assigned.into_iter().flatten().collect())
    }

    /// Writes the responses into the predictions, and returns the linearisation to which they belong.
    fn responses(
        &self,
        at_rest: &AtRest,
        linearisation: Linearisation,
        values: &mut [Complex],
    ) -> Result<Option<Dynamics>> {
        if self.responses.is_empty() {
            return Ok(None);
        }
        let AtRest { robot, equilibrium, .. } = at_rest;
        let dynamics = Dynamics::about(robot, equilibrium, linearisation, self.highest_hz)?;

        for group in self.groups(robot)? {
            let ResponseGroup { inputs, outputs, .. } = &group;
            let signals: Vec<Signal> = inputs.iter().copied().chain(outputs.iter().map(|output| output.0)).collect();
            let mut input_ports = Port::all(robot, equilibrium, &dynamics, &signals, true)?;
            let output_ports = input_ports.split_off(inputs.len());
            let output_ports: Vec<(Port, Quantity)> =
                output_ports.into_iter().zip(outputs.iter().map(|output| output.1)).collect();
            let rows = response::matrix(&dynamics, &group.frequency_hz, &input_ports, &output_ports)?;
            for (pair, first) in group.rows {
                values[first..][..rows[pair].len()].copy_from_slice(&rows[pair]);
            }
        }
        Ok(Some(dynamics))
    }

    /// Responses that are computed together.
    ///
    /// # Errors
    /// A signal that the robot does not have.
    pub(super) fn groups(&self, robot: &Robot) -> Result<Vec<ResponseGroup>> {
        let mut groups = Vec::new();
        for number in 0..self.responses.len() {
            let members: Vec<&ResponseOf> = self.responses.iter().filter(|other| other.group == number).collect();
            if members.is_empty() {
                continue;
            }
            let (mut inputs, mut outputs): (Vec<Signal>, Vec<(Signal, Quantity)>) = (Vec::new(), Vec::new());
            let mut places = Vec::with_capacity(members.len());
            for member in members {
                let input = member.input.signal(robot, member.input_point_p)?;
                let output = (member.output.signal(robot, member.output_point_p)?, member.output.quantity);
                places.push((place(&mut outputs, output), place(&mut inputs, input), member.first));
            }
            let rows = places.into_iter().map(|(to, from, first)| (to * inputs.len() + from, first)).collect();
            let frequency_hz = self.given.responses[number].frequency_hz.clone();
            groups.push(ResponseGroup { inputs, outputs, frequency_hz, rows });
        }
        Ok(groups)
    }
}

/// Place of an element in a list, to which it is added if it is new.
fn place<T: PartialEq>(list: &mut Vec<T>, element: T) -> usize {
    list.iter().position(|other| *other == element).unwrap_or_else(|| {
        list.push(element);
        list.len() - 1
    })
}

/// Checks the numbers of measured tensions and lengths, and the states at which lengths can be measured.
fn check_statics(robot: &Robot, given: &Experiment, name: &str) -> Result<()> {
    let cables = robot.cables.len();
    for (option, values) in
        [("measured_tensions_n", &given.measured_tensions_n), ("measured_lengths_m", &given.measured_lengths_m)]
    {
        if let Some(values) = values
            && values.len() != cables
        {
            bail!("{name}: ⟪{option}⟫ has {} numbers for {cables} cables", values.len());
        }
    }
    if let Some(pose) = given.measured_pose {
        at_rest::check_pose(robot, &pose.to_robot()?)?;
    }

    let holds_pose =
        given.state.pose.is_some() || matches!(robot.state, State::Pose(_)) && given.state.lengths_m.is_none();
    if given.measured_lengths_m.is_some() && (!holds_pose || given.state.hold_lengths_of_pose) {
        bail!("{name}: ⟪measured_lengths_m⟫ needs a pose that is held, from which lengths follow: give ⟪pose⟫");
    }
    if given.cables.is_some() && given.state.hold_lengths_of_pose {
        bail!("{name}: ⟪hold_lengths_of_pose⟫ does not go with the key `cables` of the experiment: give ⟪lengths_m⟫");
    }
    Ok(())
}

/// Mode with this index.
fn mode_at(list: &[Mode], index: usize) -> Result<&Mode> {
    list.get(index).ok_or_else(|| anyhow!("the list of modes is too short"))
}

/// List of modes that is long enough.
fn enough(list: Vec<Mode>, needed: usize) -> Result<Vec<Mode>> {
    if list.len() < needed {
        bail!("the robot has {} modes, and {needed} are measured or numbered", list.len());
    }
    Ok(list)
}

/// Checks the payload of an experiment.
///
/// # Errors
/// A payload that is not possible, or that the state replaces.
fn check_payload(given: &Experiment, name: &str) -> Result<()> {
    request::check("payload_kg", given.payload_kg, not_negative)?;
    request::check_vector("payload_center_m", given.payload_center_m)?;
    if given.payload_kg.is_some() && given.state.mass_kg.is_some() {
        bail!("{name}: ⟪mass_kg⟫ is the mass of platform and payload together: leave out it or ⟪payload_kg⟫");
    }
    Ok(())
}

/// Robot with the cables that were mounted and the payload that was carried in an experiment.
pub(super) fn mounted(robot: Robot, given: &Experiment, name: &str) -> Result<Robot> {
    let payload = given.payload_kg.unwrap_or(0.0);
    let center_p = given.payload_center_m.map_or(robot.platform.center_of_mass_p, Vec3::from);
    let mut robot = if payload > 0.0 { carrying(&robot, payload, center_p) } else { robot };
    let Some(cables) = &given.cables else { return Ok(robot) };

    let known: Vec<String> = robot.cables.iter().map(|cable| cable.name.clone()).collect();
    if let Some(unknown) = cables.iter().find(|cable| !known.contains(cable)) {
        bail!("{name}: the robot has no cable \"{unknown}\"{}", crate::names::suggestion(unknown, &known));
    }
    if cables.is_empty() {
        bail!("{name}: the key `cables` of the experiment is empty: name the cables that were mounted");
    }
    if let State::Lengths(lengths) = &mut robot.state {
        let mut kept = known.iter().map(|cable| cables.contains(cable));
        lengths.retain(|_| kept.next().unwrap_or(false));
    }
    robot.cables.retain(|cable| cables.contains(&cable.name));
    Ok(robot)
}

//! Predictions of the measurements of one experiment.

use super::observations::{Kind, Observation, Stage, observations};
use crate::at_rest::{self, AtRest};
use crate::measurements::MeasuredFrequency;
use crate::request::{Experiment, IdentifyRequest};
use crate::signals::{Input, Output};
use anyhow::{Result, anyhow, bail};
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{Complex, Vec3};
use funicular::modes::{self, Mode, tracking::best_pairs};
use funicular::response::{self, Port, Quantity, Signal};
use funicular::robot::{Robot, State};

/// Ratio of the limit of a list of modes to the highest measured frequency.
const BEYOND: f64 = 1.3;

/// Number of times that this limit is doubled until the list has all numbered modes.
const MAX_DOUBLINGS: usize = 8;

/// Deviations beyond which a mode does not differ as a partner of a measured frequency.
const FAR: f64 = 1000.0;

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
pub(super) struct Group {
    /// Inputs, each once.
    pub(super) inputs: Vec<Signal>,
    /// Outputs, each once.
    pub(super) outputs: Vec<(Signal, Quantity)>,
    /// Frequencies [Hz].
    pub(super) frequency_hz: Vec<f64>,
    /// Per response: index of its pair, as [`response::matrix`] counts them, and of its first value in the predictions.
    pub(super) rows: Vec<(usize, usize)>,
}

/// Robot of an experiment, solved as far as its predictions need.
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

/// Experiment with what its predictions need.
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
    pub(super) fn new(robot: &Robot, given: &'a Experiment, name: String, request: &IdentifyRequest) -> Result<Self> {
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
        let holds_pose =
            given.state.pose.is_some() || matches!(robot.state, State::Pose(_)) && given.state.lengths_m.is_none();
        if given.measured_lengths_m.is_some() && (!holds_pose || given.state.hold_lengths_of_pose) {
            bail!("{name}: `measured_lengths_m` needs a pose that is held, from which lengths follow: give ⟪pose⟫");
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
        let mut values = Vec::with_capacity(self.observations.len());
        self.statics(&at_rest, &mut values)?;
        if stage == Stage::Statics {
            // The other predictions are not used.
            let rest = self.observations.iter().filter(|observation| observation.kind != Kind::Static);
            values.extend(rest.map(|observation| observation.measured));
            let assigned = vec![0; self.given.frequencies.len()];
            return Ok(Solved { at_rest, modes: (Vec::new(), None), assigned, of_responses: None, values });
        }

        // Natural frequencies, then damping ratios.
        let linearisation = at_rest::linearisation(&request.model, at_rest.equilibrium.model);
        let modes = self.modes(&at_rest, linearisation, request.rigid_cables)?;
        let assigned = match assigned {
            Some(assigned) => assigned.to_vec(),
            None => self.assigned(&modes.0)?,
        };
        let mode = |k: usize| modes.0.get(assigned[k]).ok_or_else(|| anyhow!("the list of modes is too short"));
        for k in 0..self.given.frequencies.len() {
            values.push(mode(k)?.frequency_hz.into());
        }
        for (k, measured) in self.given.frequencies.iter().enumerate() {
            if measured.damping_ratio.is_some() {
                values.push(mode(k)?.damping_ratio.into());
            }
        }

        let of_responses = self.responses(&at_rest, linearisation, &mut values)?;
        Ok(Solved { at_rest, modes, assigned, of_responses, values })
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
        let mut limit = BEYOND * highest;
        for _ in 0..MAX_DOUBLINGS {
            let dynamics = Dynamics::about(&at_rest.robot, &at_rest.equilibrium, linearisation, limit)?;
            modes::check_count(&dynamics, limit, modes::MAX_MODES)?;
            let found = modes::below(&dynamics, limit);
            if found.modes.len() >= needed {
                return Ok((found.modes, Some(dynamics)));
            }
            limit *= 2.0;
        }
        Ok((enough(Vec::new(), needed)?, None))
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

    /// Appends the responses, and returns the linearisation to which they belong.
    fn responses(
        &self,
        at_rest: &AtRest,
        linearisation: Linearisation,
        values: &mut Vec<Complex>,
    ) -> Result<Option<Dynamics>> {
        if self.responses.is_empty() {
            return Ok(None);
        }
        let AtRest { robot, equilibrium, .. } = at_rest;
        let dynamics = Dynamics::about(robot, equilibrium, linearisation, self.highest_hz)?;
        values.resize(self.observations.len(), Complex::default());
        for group in self.groups(robot)? {
            let Group { inputs, outputs, .. } = &group;
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
    pub(super) fn groups(&self, robot: &Robot) -> Result<Vec<Group>> {
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
            groups.push(Group { inputs, outputs, frequency_hz, rows });
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

//! Numbers of the robot file that deviate, with their distributions.

use crate::analyses::gradient::{Tolerance, refuse_replaced, value_at};
use crate::at_rest::AtRest;
use crate::normal::normal_quantile;
use crate::request::UncertaintyRequest;
use crate::set_values::{self, Assignment};
use anyhow::{Result, anyhow, bail};
use funicular::gradient::Hold;
use funicular::math::{Vec3, Vec6, rotation};
use funicular::robot::parameters::{Parameter, Parameters, RobotPart};
use funicular::robot::{Robot, RobotChange};
use serde_json::json;

/// Maximum count of uncertain parameters: a Latin hypercube has as many axes.
const MAX_INPUTS: usize = 5000;

/// Distribution of the deviation of a number, in the unit of the number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Distribution {
    /// Normal, with this standard deviation.
    Normal(f64),
    /// Uniform between ± this half width.
    Uniform(f64),
}

impl Distribution {
    /// Standard deviation.
    pub(crate) fn deviation(self) -> f64 {
        match self {
            Self::Normal(deviation) => deviation,
            Self::Uniform(half_width) => half_width / 3.0_f64.sqrt(),
        }
    }

    /// Half width of the tolerance; `None` for a normal distribution, which has no bounds.
    pub(crate) fn half_width(self) -> Option<f64> {
        match self {
            Self::Normal(_) => None,
            Self::Uniform(half_width) => Some(half_width),
        }
    }

    /// Deviation with this cumulative probability.
    pub(super) fn at(self, probability: f64) -> f64 {
        match self {
            Self::Normal(deviation) => deviation * normal_quantile(probability),
            Self::Uniform(half_width) => half_width * (2.0 * probability - 1.0),
        }
    }

    /// Name in files.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Normal(_) => "normal",
            Self::Uniform(_) => "uniform",
        }
    }
}

/// NumberPlace of a number in the robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum NumberPlace {
    /// Index in the list of parameters of the stated text.
    Number(usize),
    /// Unstrained length of a cable, which need not be in the file.
    Length(usize),
    /// Index in the list of parameters of the stated text of a number of the pose.
    Pose(usize),
    /// Coordinate of a pose that is not in the file: position, then roll, pitch, yaw.
    Coordinate(usize),
}

/// Number that deviates.
#[derive(Debug, Clone)]
pub(crate) struct DeviatingNumber {
    /// Path.
    pub(crate) path: String,
    /// Unit.
    pub(crate) unit: &'static str,
    /// Index of the option that gives the deviation: the group of the number.
    pub(crate) group: usize,
    /// True if its value is that of the pose or of the lengths, and changes from pose to pose.
    pub(crate) is_of_state: bool,
    place: NumberPlace,
    parameter: Parameter,
}

/// Numbers that one option makes deviate.
pub(crate) struct DeviationGroup {
    /// Text of the option.
    pub(crate) name: String,
    amount: Tolerance,
    is_normal: bool,
}

impl DeviationGroup {
    /// Key of the request that gives the deviation.
    fn key(&self) -> &'static str {
        if self.is_normal { "deviations" } else { "tolerances" }
    }
}

/// All numbers that deviate.
pub(crate) struct Inputs {
    /// Numbers, in the order of the file.
    pub(crate) list: Vec<DeviatingNumber>,
    /// Groups, in the order of the request.
    pub(crate) groups: Vec<DeviationGroup>,
    /// Robot file in which every number that deviates is stated, with the loads of the request.
    stated: Parameters,
}

impl Inputs {
    /// Chooses the numbers of a request; `at_rest` is the robot at any of its states.
    ///
    /// # Errors
    /// No deviation, a path that no number has, a negative deviation, or numbers that what is held excludes.
    pub(crate) fn new(request: &UncertaintyRequest, at_rest: &AtRest) -> Result<Self> {
        let text = request.robot.changed_text()?;
        let original = Parameters::from_toml(&text).map_err(|error| anyhow!("{error}"))?;
        let groups = groups(request, &original)?;
        let candidates = candidates(&original, &at_rest.robot);
        let entries: Vec<_> = groups.iter().map(|of| (of.key(), of.name.as_str(), &of.amount)).collect();
        refuse_replaced(&entries, &candidates)?;

        // The last option that matches a number gives its deviation.
        let mut chosen: Vec<(Parameter, usize)> = Vec::new();
        let mut met = vec![Met::default(); groups.len()];
        for parameter in candidates {
            let mut group = None;
            for (index, (option, met)) in groups.iter().zip(&mut met).enumerate() {
                if option.amount.matches(&parameter) {
                    met.any = true;
                    let fits = fits(request.hold, &parameter);
                    met.fitting |= fits;
                    group = fits.then_some(index).or(group);
                }
            }
            chosen.extend(group.map(|group| (parameter, group)));
        }
        refuse_unmet(&groups, &met, request.hold, &original)?;
        if chosen.len() > MAX_INPUTS {
            bail!("{} numbers deviate, and at most {MAX_INPUTS} can at once: choose fewer", chosen.len());
        }

        let stated = stated(&text, &original, &chosen, request, at_rest)?;
        let list =
            chosen.into_iter().map(|(parameter, group)| DeviatingNumber::new(parameter, group, &stated)).collect();
        Ok(Self { list, groups, stated })
    }

    /// Values of the numbers at a state.
    pub(crate) fn values(&self, at_rest: &AtRest) -> Vec<f64> {
        let value = |input: &DeviatingNumber| match input.place {
            NumberPlace::Length(cable) => at_rest.equilibrium.cables[cable].unstrained_length,
            NumberPlace::Number(_) | NumberPlace::Pose(_) | NumberPlace::Coordinate(_) => {
                value_at(at_rest, &input.parameter)
            }
        };
        self.list.iter().map(value).collect()
    }

    /// Distributions of the numbers with these values.
    pub(crate) fn distributions(&self, values: &[f64]) -> Vec<Distribution> {
        let distribution = |(input, value): (&DeviatingNumber, &f64)| {
            let group = &self.groups[input.group];
            let size = group.amount.of(*value);
            if group.is_normal { Distribution::Normal(size) } else { Distribution::Uniform(size) }
        };
        self.list.iter().zip(values).map(distribution).collect()
    }

    /// True if the size of a number's deviation changes from pose to pose.
    pub(crate) fn follows_state(&self, input: &DeviatingNumber) -> bool {
        input.is_of_state && self.groups[input.group].amount.is_percent()
    }

    /// Changes of a robot per unit of each number; `None` for numbers without derivatives.
    pub(crate) fn changes(&self, robot: &Robot) -> Vec<Option<RobotChange>> {
        let change = |input: &DeviatingNumber| match input.place {
            NumberPlace::Number(index) | NumberPlace::Pose(index) => self.stated.change_of(index, robot),
            NumberPlace::Coordinate(k) => coordinate_change(robot, k),
            NumberPlace::Length(cable) => {
                let mut change = RobotChange::none(robot.cables.len());
                change.cables[cable].unstrained_length = 1.0;
                Some(change)
            }
        };
        self.list.iter().map(change).collect()
    }

    /// Robot whose numbers deviate, without its state, and the deviations of its unstrained lengths [m].
    ///
    /// # Errors
    /// Values that a robot cannot have.
    pub(super) fn robot(&self, values: &[f64], deviations: &[f64]) -> Result<(Robot, Vec<f64>), String> {
        let mut lengths = vec![0.0; self.stated.robot().cables.len()];
        let mut numbers = Vec::with_capacity(self.list.len());
        for ((input, value), deviation) in self.list.iter().zip(values).zip(deviations) {
            match input.place {
                NumberPlace::Number(index) => numbers.push((index, value + deviation)),
                NumberPlace::Length(cable) => lengths[cable] += deviation,
                NumberPlace::Pose(_) | NumberPlace::Coordinate(_) => {}
            }
        }
        let robot = self.stated.robot_with(&numbers).map_err(|error| error.to_string())?;
        Ok((robot, lengths))
    }

    /// True for a number of the pose.
    pub(super) fn is_of_pose(&self, index: usize) -> bool {
        matches!(self.list[index].place, NumberPlace::Pose(_) | NumberPlace::Coordinate(_))
    }
}

impl DeviatingNumber {
    fn new(parameter: Parameter, group: usize, stated: &Parameters) -> Self {
        let index = stated.list().iter().position(|other| other.keys == parameter.keys);
        let place = match (parameter.part, parameter.key, index) {
            (RobotPart::Cable(cable), "unstrained_length_m", _) => NumberPlace::Length(cable),
            (RobotPart::State, _, Some(index)) => NumberPlace::Pose(index),
            (RobotPart::State, _, None) => {
                let is_own = |(_, _, component): &(_, _, &'static str)| Some(*component) == parameter.component;
                NumberPlace::Coordinate(COORDINATES.iter().position(is_own).unwrap_or(0))
            }
            (_, _, index) => NumberPlace::Number(index.unwrap_or(usize::MAX)),
        };
        let is_of_state = !matches!(place, NumberPlace::Number(_));
        Self { path: parameter.path(), unit: parameter.unit, group, is_of_state, place, parameter }
    }
}

/// Options that give deviations, normal ones first.
fn groups(request: &UncertaintyRequest, original: &Parameters) -> Result<Vec<DeviationGroup>> {
    let parse = |key: &'static str, is_normal: bool| {
        let texts = if is_normal { &request.deviations } else { &request.tolerances };
        texts.iter().map(move |text| {
            let amount = Tolerance::parse(key, text, original)?;
            Ok(DeviationGroup { name: text.trim().to_owned(), amount, is_normal })
        })
    };
    let groups = parse("deviations", true).chain(parse("tolerances", false)).collect::<Result<Vec<_>>>()?;
    if groups.is_empty() {
        bail!(
            "no number deviates: give ⟪deviations⟫ or ⟪tolerances⟫, as in platform.mass_kg=1% or \
             cables.*.anchor_m=0.002"
        );
    }
    Ok(groups)
}

/// Numbers that the path of an option names.
#[derive(Clone, Default)]
struct Met {
    /// True if there is at least one.
    any: bool,
    /// True if at least one of them may deviate while lengths or pose are held.
    fitting: bool,
}

/// True if a number may deviate while the lengths or the pose are held.
fn fits(hold: Hold, parameter: &Parameter) -> bool {
    let is_length = parameter.key == "unstrained_length_m";
    match hold {
        Hold::Lengths => parameter.part != RobotPart::State,
        _ => !is_length,
    }
}

/// Refuses options without a number.
fn refuse_unmet(groups: &[DeviationGroup], met: &[Met], hold: Hold, original: &Parameters) -> Result<()> {
    for (group, met) in groups.iter().zip(met) {
        if !met.any {
            return Err(group.amount.missing(original));
        }
        if !met.fitting {
            let key = group.key();
            let (held, other, follows) = match hold {
                Hold::Lengths => ("lengths", "pose", "pose follows"),
                _ => ("pose", "lengths", "lengths follow"),
            };
            bail!(
                "⟪{key}⟫ {}: with the {held} held the {follows}, and cannot deviate by itself: leave it out, or give \
                 ⟪hold⟫ {other}",
                group.name
            );
        }
    }
    Ok(())
}

/// Coordinates of a pose: key, unit, component.
const COORDINATES: [(&str, &str, &str); 6] = [
    ("position_m", "m", "x"),
    ("position_m", "m", "y"),
    ("position_m", "m", "z"),
    ("roll_pitch_yaw_deg", "degrees", "roll"),
    ("roll_pitch_yaw_deg", "degrees", "pitch"),
    ("roll_pitch_yaw_deg", "degrees", "yaw"),
];

/// Rounding of the axes of a platform's motion is about 1e-16 of it; a part beyond this fraction is a motion that the
/// platform does not have.
const MAX_ROUNDING: f64 = 1e-12;

/// Change of a pose per unit of one of its [`COORDINATES`]; `None` for a motion that the platform does not have.
fn coordinate_change(robot: &Robot, k: usize) -> Option<RobotChange> {
    let mut change = RobotChange::none(robot.cables.len());
    let [_, pitch, yaw] = robot.written_angles_deg;
    // R = Rz(yaw) Ry(pitch) Rx(roll): each angle turns about the axis of its rotation, after those left of it.
    let axis_w = match k {
        0..3 => {
            change.position_w[k] = 1.0;
            Vec3::zeros()
        }
        3 => rotation::from_roll_pitch_yaw_deg(0.0, pitch, yaw) * Vec3::x(),
        4 => rotation::from_roll_pitch_yaw_deg(0.0, 0.0, yaw) * Vec3::y(),
        _ => Vec3::z(),
    };
    change.rotation_w = axis_w * 1_f64.to_radians();

    let (v, turn) = (change.position_w, change.rotation_w);
    let motion = Vec6::new(v.x, v.y, v.z, turn.x, turn.y, turn.z);
    let beyond = motion - robot.platform.motion.allowed(&motion);
    (beyond.norm() <= MAX_ROUNDING * motion.norm()).then_some(change)
}

/// Numbers of the robot file, and the lengths of the cables and the pose if the file has none.
fn candidates(original: &Parameters, robot: &Robot) -> Vec<Parameter> {
    // Coordinates of the pose along which the platform cannot move are no numbers that deviate.
    let moves = |(i, parameter): &(usize, &Parameter)| {
        parameter.part != RobotPart::State || original.change_of(*i, robot).is_some()
    };
    let mut list: Vec<Parameter> =
        original.list().iter().enumerate().filter(moves).map(|(_, parameter)| parameter.clone()).collect();

    let has_lengths = list.iter().any(|parameter| parameter.key == "unstrained_length_m");
    // A length has the unit, range and meaning of the file's key, whose row an anchor stands in for.
    let Some(pattern) = list.iter().find(|parameter| parameter.key == "anchor_m").cloned() else { return list };
    if !original.list().iter().any(|parameter| parameter.part == RobotPart::State) {
        let of_platform = COORDINATES.into_iter().enumerate().filter(|(k, _)| coordinate_change(robot, *k).is_some());
        for (_, (key, unit, component)) in of_platform {
            let mut coordinate = pattern.clone();
            coordinate.keys = vec!["state".to_owned(), key.to_owned(), component.to_owned()];
            coordinate.part = RobotPart::State;
            (coordinate.key, coordinate.unit, coordinate.component) = (key, unit, Some(component));
            coordinate.given = false;
            list.push(coordinate);
        }
    }

    if !has_lengths {
        for (i, cable) in robot.cables.iter().enumerate() {
            let mut length = pattern.clone();
            length.keys = vec!["cables".to_owned(), cable.name.clone(), "unstrained_length_m".to_owned()];
            length.part = RobotPart::Cable(i);
            length.key = "unstrained_length_m";
            length.component = None;
            length.given = false;
            list.push(length);
        }
    }
    list
}

/// Robot file that states every number that deviates, with the changes that a request makes besides.
fn stated(
    text: &str,
    original: &Parameters,
    chosen: &[(Parameter, usize)],
    request: &UncertaintyRequest,
    at_rest: &AtRest,
) -> Result<Parameters> {
    // A vector is stated as a whole, because the file may not have it.
    let mut assignments: Vec<Assignment> = Vec::new();
    let mut state = |path: &str, value: serde_json::Value| -> Result<()> {
        assignments.push(set_values::of_json(path, &value).map_err(|error| anyhow!("{error}"))?);
        Ok(())
    };

    // Numbers of the request that stand for numbers of the file.
    let load = &request.state.load;
    if let Some(mass) = request.state.mass_kg {
        state("platform.mass_kg", json!(mass))?;
    }
    for vector in load.of_file() {
        if let Some(value) = vector.value {
            state(vector.path, json!(value))?;
        }
    }
    for cable in at_rest.robot.cables.iter().filter(|_| load.cable_load_n_per_m.is_some()) {
        state(&format!("cables.{}.load_n_per_m", quoted(&cable.name)), json!(load.cable_load_n_per_m))?;
    }

    // Numbers that the file leaves out.
    for (parameter, _) in chosen.iter().filter(|(parameter, _)| !parameter.given) {
        if parameter.part == RobotPart::State || parameter.key == "unstrained_length_m" {
            continue;
        }
        if parameter.component.is_none() {
            state(&parameter.path(), json!(value_at(at_rest, parameter)))?;
            continue;
        }
        let of_vector = &parameter.keys[..parameter.keys.len() - 1];
        let components = original.list().iter().filter(|other| other.keys.starts_with(of_vector));
        let vector: Vec<f64> = components.map(|other| value_at(at_rest, other)).collect();
        let mut whole = parameter.clone();
        whole.keys.pop();
        state(&whole.path(), json!(vector))?;
    }
    let text = set_values::apply(text, &assignments)?;
    Parameters::from_toml(&text).map_err(|error| anyhow!("{error}"))
}

/// Name as a key of a path.
fn quoted(name: &str) -> String {
    if name.contains('\'') {
        format!("\"{}\"", name.replace('\\', "\\\\").replace('"', "\\\""))
    } else {
        format!("'{name}'")
    }
}

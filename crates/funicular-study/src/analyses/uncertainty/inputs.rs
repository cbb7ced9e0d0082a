//! Numbers of the robot file that deviate, with their distributions.

use super::joint::JointDeviations;
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

/// Number that deviates by itself, or combination of numbers that deviate together.
#[derive(Debug, Clone)]
pub(crate) struct DeviatingNumber {
    /// Path, or name of the combination.
    pub(crate) path: String,
    /// Unit.
    pub(crate) unit: &'static str,
    /// Index of the option that gives the deviation: the group of the number.
    pub(crate) group: usize,
    /// True if its value is that of the pose or of the lengths, and changes from pose to pose.
    pub(crate) is_of_state: bool,
    /// Numbers that move with it: one by itself, and all of a combination.
    moved: Vec<MovedNumber>,
    is_combination: bool,
}

/// Number of the robot that moves with a deviation.
#[derive(Debug, Clone)]
struct MovedNumber {
    place: NumberPlace,
    parameter: Parameter,
    /// Change per unit of the deviation.
    weight: f64,
}

/// Numbers that one option makes deviate.
pub(crate) struct DeviationGroup {
    /// Text of the option.
    pub(crate) name: String,
    of: GroupOf,
}

/// Deviations of a group.
enum GroupOf {
    /// Each number by itself, by the same amount.
    Each { amount: Tolerance, is_normal: bool },
    /// All numbers together: combinations of deviation 1.
    Joint,
}

impl DeviationGroup {
    /// Key, text and amount of the option; `None` for a joint group.
    fn entry(&self) -> Option<(&'static str, &str, &Tolerance)> {
        self.amount().map(|(key, amount)| (key, self.name.as_str(), amount))
    }

    /// Key of the request that gives the deviation, and its amount; `None` for a joint one.
    fn amount(&self) -> Option<(&'static str, &Tolerance)> {
        match &self.of {
            GroupOf::Each { amount, is_normal } => Some((if *is_normal { "deviations" } else { "tolerances" }, amount)),
            GroupOf::Joint => None,
        }
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
        let mut groups = groups(request, &original)?;
        let candidates = candidates(&original, &at_rest.robot);
        let entries: Vec<_> = groups.iter().filter_map(DeviationGroup::entry).collect();
        refuse_replaced(&entries, &candidates)?;
        let joint = joint(request, &original, &candidates)?;

        // The last option that matches a number gives its deviation.
        let mut chosen: Vec<(Parameter, usize)> = Vec::new();
        let mut met = vec![Met::default(); groups.len()];
        for parameter in candidates {
            let mut group = None;
            for (index, (option, met)) in groups.iter().zip(&mut met).enumerate() {
                if option.amount().is_some_and(|(_, amount)| amount.matches(&parameter)) {
                    met.any = true;
                    let fits = fits(request.hold, &parameter);
                    met.fitting |= fits;
                    group = fits.then_some(index).or(group);
                }
            }
            chosen.extend(group.map(|group| (parameter, group)));
        }
        refuse_unmet(&groups, &met, request.hold, &original)?;
        if let Some((both, group)) = chosen.iter().find(|(of, _)| joint.members.iter().any(|own| own.keys == of.keys)) {
            bail!(
                "⟪covariance⟫ has {}, and {} makes it deviate as well: leave out one of them",
                both.path(),
                groups[*group].name
            );
        }
        let count = chosen.len() + joint.combinations.len();
        if count > MAX_INPUTS {
            bail!("{count} numbers deviate, and at most {MAX_INPUTS} can at once: choose fewer");
        }

        let all: Vec<&Parameter> = chosen.iter().map(|(parameter, _)| parameter).chain(&joint.members).collect();
        let stated = stated(&text, &original, &all, request, at_rest)?;
        let mut list: Vec<DeviatingNumber> =
            chosen.into_iter().map(|(parameter, group)| DeviatingNumber::new(parameter, group, &stated)).collect();
        if !joint.members.is_empty() {
            list.extend(
                joint.combinations.iter().enumerate().map(|(k, weights)| {
                    DeviatingNumber::combination(k, (&joint.members, weights), groups.len(), &stated)
                }),
            );
            groups.push(DeviationGroup { name: "covariance".to_owned(), of: GroupOf::Joint });
        }
        Ok(Self { list, groups, stated })
    }

    /// Values of the numbers at a state.
    pub(crate) fn values(&self, at_rest: &AtRest) -> Vec<f64> {
        let value = |input: &DeviatingNumber| match &input.moved[..] {
            // A combination deviates from zero.
            _ if input.is_combination => 0.0,
            [MovedNumber { place: NumberPlace::Length(cable), .. }] => {
                at_rest.equilibrium.cables[*cable].unstrained_length
            }
            moved => moved.iter().map(|of| value_at(at_rest, &of.parameter)).sum(),
        };
        self.list.iter().map(value).collect()
    }

    /// Distributions of the numbers with these values.
    pub(crate) fn distributions(&self, values: &[f64]) -> Vec<Distribution> {
        let distribution = |(input, value): (&DeviatingNumber, &f64)| match &self.groups[input.group].of {
            GroupOf::Each { amount, is_normal: true } => Distribution::Normal(amount.of(*value)),
            GroupOf::Each { amount, is_normal: false } => Distribution::Uniform(amount.of(*value)),
            GroupOf::Joint => Distribution::Normal(1.0),
        };
        self.list.iter().zip(values).map(distribution).collect()
    }

    /// True if the size of a number's deviation changes from pose to pose.
    pub(crate) fn follows_state(&self, input: &DeviatingNumber) -> bool {
        input.is_of_state && self.groups[input.group].amount().is_some_and(|(_, amount)| amount.is_percent())
    }

    /// Changes of a robot per unit of each number; `None` for numbers without derivatives.
    pub(crate) fn changes(&self, robot: &Robot) -> Vec<Option<RobotChange>> {
        let of_place = |place: NumberPlace| match place {
            NumberPlace::Number(index) | NumberPlace::Pose(index) => self.stated.change_of(index, robot),
            NumberPlace::Coordinate(k) => coordinate_change(robot, k),
            NumberPlace::Length(cable) => {
                let mut change = RobotChange::none(robot.cables.len());
                change.cables[cable].unstrained_length = 1.0;
                Some(change)
            }
        };
        let change = |input: &DeviatingNumber| {
            let mut total = RobotChange::none(robot.cables.len());
            for moved in &input.moved {
                total.add_scaled(moved.weight, &of_place(moved.place)?);
            }
            Some(total)
        };
        self.list.iter().map(change).collect()
    }

    /// Robot whose numbers deviate, without its state, and the deviations of its unstrained lengths [m].
    ///
    /// # Errors
    /// Values that a robot cannot have.
    pub(super) fn robot(&self, values: &[f64], deviations: &[f64]) -> Result<(Robot, Vec<f64>), String> {
        let mut lengths = vec![0.0; self.stated.robot().cables.len()];
        let mut numbers: Vec<(usize, f64)> = Vec::with_capacity(self.list.len());
        // Combinations come last, and several of them move one number.
        let singles = self.list.iter().filter(|input| !input.is_combination).count();
        for ((input, value), deviation) in self.list.iter().zip(values).zip(deviations) {
            for MovedNumber { place, weight, .. } in &input.moved {
                match *place {
                    NumberPlace::Number(index) if input.is_combination => {
                        let known = numbers.iter().skip(singles).position(|(of, _)| *of == index);
                        let at = known.map_or_else(
                            || {
                                numbers.push((index, self.stated.list()[index].value));
                                numbers.len() - 1
                            },
                            |at| at + singles,
                        );
                        numbers[at].1 += weight * deviation;
                    }
                    NumberPlace::Number(index) => numbers.push((index, value + deviation)),
                    NumberPlace::Length(cable) => lengths[cable] += weight * deviation,
                    NumberPlace::Pose(_) | NumberPlace::Coordinate(_) => {}
                }
            }
        }
        let robot = self.stated.robot_with(&numbers).map_err(|error| error.to_string())?;
        Ok((robot, lengths))
    }

    /// True for a number of the pose.
    pub(super) fn is_of_pose(&self, index: usize) -> bool {
        let is_of_pose = |of: &MovedNumber| matches!(of.place, NumberPlace::Pose(_) | NumberPlace::Coordinate(_));
        self.list[index].moved.iter().any(is_of_pose)
    }
}

impl DeviatingNumber {
    fn new(parameter: Parameter, group: usize, stated: &Parameters) -> Self {
        let (path, unit) = (parameter.path(), parameter.unit);
        let moved = MovedNumber::new(parameter, 1.0, stated);
        let is_of_state = !matches!(moved.place, NumberPlace::Number(_));
        Self { path, unit, group, is_of_state, moved: vec![moved], is_combination: false }
    }

    /// Combination with this index of numbers that deviate together, with the change of each per unit.
    fn combination(k: usize, (members, weights): (&[Parameter], &[f64]), group: usize, stated: &Parameters) -> Self {
        let moved: Vec<MovedNumber> = (members.iter().zip(weights))
            .filter(|(_, weight)| **weight != 0.0)
            .map(|(member, weight)| MovedNumber::new(member.clone(), *weight, stated))
            .collect();
        let largest = moved.iter().max_by(|a, b| a.weight.abs().total_cmp(&b.weight.abs()));
        let most = largest.map_or_else(String::new, |of| format!(", most of {}", of.parameter.path()));
        let path = format!("combination {}{most}", k + 1);
        Self { path, unit: "1", group, is_of_state: false, moved, is_combination: true }
    }
}

impl MovedNumber {
    fn new(parameter: Parameter, weight: f64, stated: &Parameters) -> Self {
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
        Self { place, parameter, weight }
    }
}

/// Options that give deviations, normal ones first.
fn groups(request: &UncertaintyRequest, original: &Parameters) -> Result<Vec<DeviationGroup>> {
    let parse = |key: &'static str, is_normal: bool| {
        let texts = if is_normal { &request.deviations } else { &request.tolerances };
        texts.iter().map(move |text| {
            let amount = Tolerance::parse(key, text, original)?;
            Ok(DeviationGroup { name: text.trim().to_owned(), of: GroupOf::Each { amount, is_normal } })
        })
    };
    let groups = parse("deviations", true).chain(parse("tolerances", false)).collect::<Result<Vec<_>>>()?;
    if groups.is_empty() && request.covariance.is_none() {
        bail!(
            "no number deviates: give ⟪deviations⟫, ⟪tolerances⟫ or ⟪covariance⟫, as in platform.mass_kg=1% or \
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
        let Some((key, amount)) = group.amount() else { continue };
        if !met.any {
            return Err(amount.missing(original));
        }
        if !met.fitting {
            return Err(follows(key, &group.name, hold));
        }
    }
    Ok(())
}

/// Message about numbers that follow from what is held.
fn follows(key: &str, name: &str, hold: Hold) -> anyhow::Error {
    let (held, other, follows) = match hold {
        Hold::Lengths => ("lengths", "pose", "pose follows"),
        _ => ("pose", "lengths", "lengths follow"),
    };
    anyhow!(
        "⟪{key}⟫ {name}: with the {held} held the {follows}, and cannot deviate by itself: leave it out, or give \
         ⟪hold⟫ {other}"
    )
}

/// Numbers of the covariance of a request, which may deviate while its lengths or pose are held.
fn joint(request: &UncertaintyRequest, original: &Parameters, candidates: &[Parameter]) -> Result<JointDeviations> {
    let Some(entries) = &request.covariance else { return Ok(JointDeviations::default()) };
    let found = JointDeviations::new(entries, original, candidates)?;
    match found.members.iter().find(|member| !fits(request.hold, member)) {
        Some(member) => Err(follows("covariance", &member.path(), request.hold)),
        None => Ok(found),
    }
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
    chosen: &[&Parameter],
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
    for parameter in chosen.iter().filter(|parameter| !parameter.given) {
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
        let mut whole = (*parameter).clone();
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

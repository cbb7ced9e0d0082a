//! `gradient`: derivatives of results by numbers of the robot file.

use super::found;
use super::shared::Models;
use crate::at_rest::{self, AtRest};
use crate::error::NoSolution;
use crate::names::{Named, Per};
use crate::request::{self, GradientRequest, RobotText};
use anyhow::{Result, anyhow, bail};
use funicular::dynamics::Dynamics;
use funicular::gradient::{GradientError, Gradients, Hold, VibrationGradients};
use funicular::math::Vec3;
use funicular::modes;
use funicular::response::Quantity;
use funicular::robot::parameters::{Parameter, Parameters, RobotPart};
use funicular::robot::{Load, Robot, RobotChange};
use funicular::statics::derivatives::StaticDerivativeError;
use funicular::statics::{CableState, TensionRule};
use serde::Serialize;

/// Tolerance of a position or length that is not given [m], and of an angle [degrees]: what is usually measured.
const TOLERANCE_OF_LENGTH_M: f64 = 1e-3;
const TOLERANCE_OF_ANGLE_DEG: f64 = 0.1;

/// Tolerance of any other value that is not given, relative to it.
const RELATIVE_TOLERANCE: f64 = 0.01;

/// Results of `gradient`: derivatives of results by numbers of the robot file.
#[derive(Serialize)]
pub struct GradientTable {
    #[serde(skip)]
    pub robot: String,
    #[serde(flatten)]
    pub models: Models,
    /// Quantity that is held while a number changes: `lengths` or `pose`.
    pub held: &'static str,
    /// Sentence that says what is held, and by which rule the rest follows.
    pub held_means: &'static str,
    /// Step that the derivatives are for: `unit`, `percent` or `tolerance`.
    pub per: &'static str,
    /// Numbers of the robot file; one column of `derivatives` each.
    pub parameters: Vec<GradientParameter>,
    /// Results; one row of `derivatives` each.
    pub results: Vec<GradientResult>,
    /// Results without a gradient, each with the reason.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub refused: Vec<Refused>,
    /// Paths of numbers without derivatives, such as limits.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub without_derivative: Vec<String>,
    #[serde(skip)]
    pub warnings: Vec<String>,
}

/// Number of the robot file.
#[derive(Debug, Clone, Serialize)]
pub struct GradientParameter {
    pub path: String,
    /// Value with which the results are computed.
    pub value: f64,
    pub unit: &'static str,
    /// Step `tolerance`, in the unit of the number.
    pub tolerance: f64,
}

/// Result with its derivatives.
#[derive(Serialize)]
pub struct GradientResult {
    /// Name, such as `frequency 3` or `tension of cable "2" at the anchor`.
    pub name: String,
    pub unit: String,
    pub value: f64,
    /// Entry of the block of modes that share a frequency: numbers of the two modes in the list, from 1. Along a change,
    /// the derivatives of the frequencies are the eigenvalues of the block.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub block_entry: Option<[usize; 2]>,
    /// Derivatives, one per number of the robot file.
    pub derivatives: Vec<f64>,
}

/// Result without a gradient.
#[derive(Serialize)]
pub struct Refused {
    pub name: String,
    pub reason: String,
}

found!(GradientTable, "gradient");

/// Groups of results, by the names of a request.
pub const RESULTS: [&str; 7] = ["pose", "lengths", "tensions", "stiffness-min", "frequencies", "damping", "response"];

/// Computes the derivatives.
///
/// # Errors
/// A request that contradicts itself or the robot, a robot without such an equilibrium, or an equilibrium without
/// derivatives.
pub fn run(robot: Robot, request: &GradientRequest) -> Result<GradientTable> {
    // A request that has to change is refused before the work.
    groups(request)?;
    about(&at_rest::equilibrium(robot, &request.robot, &request.state, &request.tensions)?, request)
}

/// Groups of results of a request, checked.
fn groups(request: &GradientRequest) -> Result<Vec<&'static str>> {
    let all = request.of.iter().map(|name| {
        RESULTS.into_iter().find(|known| known == name).ok_or_else(|| {
            anyhow!("⟪of⟫: there is no result `{name}`{}", crate::names::suggestion(name, &RESULTS.map(str::to_owned)))
        })
    });
    let of: Vec<&str> = all.collect::<Result<_>>()?;
    if of.is_empty() {
        bail!("⟪of⟫ names no result{}", crate::names::listed(&RESULTS.map(str::to_owned)));
    }

    let needs = |name: &str, key: &str, given: bool| {
        if of.contains(&name) && !given { Err(anyhow!("`{name}` needs ⟪{key}⟫")) } else { Ok(()) }
    };
    needs("frequencies", "below_hz", request.below_hz.is_some())?;
    needs("damping", "below_hz", request.below_hz.is_some())?;
    needs("response", "at_hz", request.at_hz.is_some())?;
    needs("response", "input", request.input.is_some())?;
    needs("response", "output", request.output.is_some())?;
    request.below_hz.map_or(Ok(()), |hz| request::check_positive("below_hz", hz))?;
    request.at_hz.map_or(Ok(()), |hz| request::check_not_negative("at_hz", hz))?;
    Ok(of)
}

/// Computes the derivatives about an equilibrium.
///
/// # Errors
/// The errors of [`run`].
pub fn about(at_rest: &AtRest, request: &GradientRequest) -> Result<GradientTable> {
    let of = groups(request)?;
    let AtRest { robot, equilibrium, .. } = at_rest;
    let linearisation = at_rest::linearisation(&request.model, equilibrium.model);
    let text = RobotText::read(&request.robot)?.text;
    let columns = Columns::of(at_rest, &text, &request.by, &request.tolerances)?;
    let Columns { parameters, changes, without_derivative } = columns;
    let gradients = held(at_rest, request.hold)?;

    // Results of the equilibrium.
    let mut rows = Rows { changes: &changes, results: Vec::new(), refused: Vec::new() };
    let mut warnings = at_rest.warnings(None);
    if of.contains(&"pose") {
        rows.pose(&gradients);
    }
    if of.contains(&"lengths") {
        let lengths: Vec<f64> = equilibrium.cables.iter().map(|cable| cable.unstrained_length).collect();
        rows.of_cables(robot, "length of cable", "", "m", &lengths, &gradients.lengths());
    }
    if of.contains(&"tensions") {
        let values = |of: fn(&CableState) -> f64| equilibrium.cables.iter().map(of).collect::<Vec<f64>>();
        let (platform, anchor) = (values(|cable| cable.tension_platform), values(|cable| cable.tension_anchor));
        rows.of_cables(robot, "tension of cable", " at the platform", "N", &platform, &gradients.tensions_platform());
        rows.of_cables(robot, "tension of cable", " at the anchor", "N", &anchor, &gradients.tensions_anchor());
        if equilibrium.cables.iter().any(|cable| cable.drive.is_some()) {
            let drum = values(CableState::tension_drum);
            rows.of_cables(robot, "tension of cable", " at the drum", "N", &drum, &gradients.tensions_drum());
        }
    }
    if of.contains(&"stiffness-min") {
        let value = equilibrium.stability.min_stiffness().unwrap_or_default();
        rows.push("minimum stiffness".to_owned(), "N/m", value, gradients.min_stiffness());
    }

    // Results of vibration.
    let limit = request.below_hz.into_iter().chain(request.at_hz).fold(0.0, f64::max);
    if ["frequencies", "damping", "response"].iter().any(|name| of.contains(name)) {
        let (dynamics, found) = at_rest.dynamics_for_gradients(linearisation, limit)?;
        warnings = found;
        let vibration = gradients.vibration(&dynamics)?;
        if of.contains(&"frequencies") || of.contains(&"damping") {
            rows.modes(&dynamics, &vibration, &of, request.below_hz.unwrap_or(limit));
        }
        if of.contains(&"response") {
            rows.response(robot, &vibration, request)?;
        }
    }

    // Derivatives per step.
    let Rows { mut results, refused, .. } = rows;
    for result in &mut results {
        for (derivative, parameter) in result.derivatives.iter_mut().zip(&parameters) {
            *derivative *= match request.per {
                Per::Unit => 1.0,
                Per::Percent => 0.01 * parameter.value.abs(),
                Per::Tolerance => parameter.tolerance,
            };
        }
    }

    Ok(GradientTable {
        robot: robot.name.clone(),
        models: Models::of(at_rest, linearisation),
        held: request.hold.name(),
        held_means: meaning(at_rest, request.hold),
        per: request.per.name(),
        parameters,
        results,
        refused,
        without_derivative,
        warnings,
    })
}

/// Gradients about an equilibrium with this held.
///
/// # Errors
/// A rule to be held without one that has chosen the tensions, or an equilibrium without derivatives.
pub(crate) fn held(at_rest: &AtRest, hold: Hold) -> Result<Gradients<'_>> {
    let AtRest { robot, equilibrium, rule, held_pose, .. } = at_rest;
    let gradients = match (hold, rule) {
        (Hold::Rule, _) if held_pose.is_some() => {
            bail!(
                "⟪hold⟫ rule: the lengths of a pose are held, which no rule changes; leave out ⟪hold_lengths_of_pose⟫"
            )
        }
        (Hold::Rule, Some(rule)) => Gradients::by_rule(robot, equilibrium, rule),
        (Hold::Rule, None) if robot.cables.len() > robot.platform.motion.count() => {
            bail!(
                "⟪hold⟫ rule needs tensions that a rule has chosen: give ⟪pose⟫, or the robot file a [state] with `position_m`"
            )
        }
        (Hold::Rule, None) => Gradients::new(robot, equilibrium, Hold::Pose),
        (Hold::Lengths | Hold::Pose, _) => Gradients::new(robot, equilibrium, hold),
    };
    gradients.map_err(no_solution)
}

/// Sentence about what is held.
pub(crate) fn meaning(at_rest: &AtRest, hold: Hold) -> &'static str {
    let redundant = at_rest.robot.cables.len() > at_rest.robot.platform.motion.count();
    match (hold, &at_rest.rule) {
        (Hold::Lengths, _) => "the unstrained lengths are held, the pose follows",
        (Hold::Pose, _) if redundant => {
            "the pose is held, the lengths follow such that the tensions parallel to the chords change least"
        }
        (Hold::Rule, Some(TensionRule::Lowest)) => {
            "the pose is held, the lengths follow such that the tensions obey the rule `lowest`"
        }
        (Hold::Rule, Some(TensionRule::Closest(_))) => {
            "the pose is held, the lengths follow such that the tensions obey the rule `closest`"
        }
        (Hold::Rule, Some(TensionRule::Middle)) => {
            "the pose is held, the lengths follow such that the tensions obey the rule `middle`"
        }
        (Hold::Rule, Some(TensionRule::Stiffest)) => {
            "the pose is held, the lengths follow such that the tensions obey the rule `stiffest`"
        }
        (Hold::Pose | Hold::Rule, _) => "the pose is held, the lengths follow",
    }
}

/// Error for a robot without derivatives: a state that has none is no solution, the rest is input.
pub(crate) fn no_solution(error: GradientError) -> anyhow::Error {
    match &error {
        GradientError::Static(StaticDerivativeError::Slack { .. } | StaticDerivativeError::Singular)
        | GradientError::Vertical { .. }
        | GradientError::OneSided { .. } => NoSolution(error.to_string()).into(),
        _ => error.into(),
    }
}

/// Numbers of the robot file by which results are differentiated.
pub(crate) struct Columns {
    pub(crate) parameters: Vec<GradientParameter>,
    /// Change of the robot per unit of each number.
    pub(crate) changes: Vec<RobotChange>,
    /// Paths of chosen numbers without derivatives.
    without_derivative: Vec<String>,
}

impl Columns {
    /// Numbers of the `text` of a robot file at the paths of `by`, or all, with their tolerances.
    ///
    /// # Errors
    /// A path that no number has, or numbers that all lack derivatives.
    pub(crate) fn of(at_rest: &AtRest, text: &str, by: &[String], tolerances: &[String]) -> Result<Self> {
        let all = Parameters::from_toml(text).map_err(|error| anyhow!("{error}"))?;
        let patterns = by.iter().map(|text| Pattern::parse("by", text)).collect::<Result<Vec<_>>>()?;
        let tolerances =
            tolerances.iter().map(|text| Tolerance::parse("tolerances", text)).collect::<Result<Vec<_>>>()?;

        let mut columns = Self { parameters: Vec::new(), changes: Vec::new(), without_derivative: Vec::new() };
        let mut met = vec![false; patterns.len()];
        let mut met_tolerances = vec![false; tolerances.len()];
        for (index, parameter) in all.list().iter().enumerate() {
            let mut chosen = patterns.is_empty();
            for (pattern, met) in patterns.iter().zip(&mut met) {
                let matches = pattern.matches(&parameter.keys);
                *met |= matches;
                chosen |= matches;
            }
            let value = value_at(at_rest, parameter);
            let mut tolerance = usual_tolerance(parameter, value);
            for (given, met) in tolerances.iter().zip(&mut met_tolerances) {
                if given.pattern.matches(&parameter.keys) {
                    (tolerance, *met) = (given.of(value), true);
                }
            }
            if !chosen {
                continue;
            }
            match all.change_of(index, &at_rest.robot) {
                Some(change) => {
                    columns.parameters.push(GradientParameter {
                        path: parameter.path(),
                        value,
                        unit: parameter.unit,
                        tolerance,
                    });
                    columns.changes.push(change);
                }
                None => columns.without_derivative.push(parameter.path()),
            }
        }

        let paths: Vec<String> = all.list().iter().map(Parameter::path).collect();
        let unmet = patterns.iter().zip(&met).map(|(pattern, met)| ("by", pattern, *met));
        let unmet_tolerances =
            tolerances.iter().zip(&met_tolerances).map(|(of, met)| ("tolerances", &of.pattern, *met));
        if let Some((key, pattern, _)) = unmet.chain(unmet_tolerances).find(|(.., met)| !met) {
            let nearest = crate::names::suggestion(&pattern.text, &paths);
            bail!("⟪{key}⟫ {}: the robot file has no such number{nearest}", pattern.text);
        }
        if columns.parameters.is_empty() {
            bail!(
                "⟪by⟫: {} without derivatives: limits, the plane of a planar platform and the friction of pulleys have \
                 none",
                columns.without_derivative.join(", ")
            );
        }
        Ok(columns)
    }
}

/// Path of numbers in which `*` stands for any key; numbers below it belong to it.
pub(crate) struct Pattern {
    text: String,
    keys: Vec<String>,
}

impl Pattern {
    pub(crate) fn parse(key: &str, text: &str) -> Result<Self> {
        // A star is a key of its own, which TOML would want in quotes.
        let quoted: Vec<&str> = text.trim().split('.').map(|part| if part == "*" { "'*'" } else { part }).collect();
        let path = crate::set_values::path(&quoted.join(".")).map_err(|reason| anyhow!("⟪{key}⟫: {reason}"))?;
        Ok(Self { text: text.trim().to_owned(), keys: path.keys().to_vec() })
    }

    pub(crate) fn matches(&self, keys: &[String]) -> bool {
        keys.len() >= self.keys.len() && self.keys.iter().zip(keys).all(|(own, key)| own == "*" || own == key)
    }
}

/// Given tolerance or deviation of numbers.
pub(crate) struct Tolerance {
    pattern: Pattern,
    value: f64,
    is_percent: bool,
}

impl Tolerance {
    /// Tolerance from its text `PATH=VALUE` or `PATH=PERCENT%`; `key` is the option.
    ///
    /// # Errors
    /// A text that is not of this form, or a negative value.
    pub(crate) fn parse(key: &str, text: &str) -> Result<Self> {
        let wrong = || anyhow!("⟪{key}⟫ {text}: write PATH=VALUE or PATH=PERCENT%, as in platform.mass_kg=1%");
        let (path, value) = text.rsplit_once('=').ok_or_else(wrong)?;
        let number = value.trim().trim_end_matches('%');
        let parsed: f64 = number.trim().parse().map_err(|_| wrong())?;
        if !(parsed.is_finite() && parsed >= 0.0) {
            bail!("⟪{key}⟫ {text}: it must be finite and not negative");
        }
        let is_percent = value.trim_end().ends_with('%');
        Ok(Self { pattern: Pattern::parse(key, path)?, value: parsed, is_percent })
    }

    /// Size for a number with this value.
    pub(crate) fn of(&self, value: f64) -> f64 {
        if self.is_percent { 0.01 * self.value * value.abs() } else { self.value }
    }

    /// True for a size relative to the value.
    pub(crate) fn is_percent(&self) -> bool {
        self.is_percent
    }

    /// True for a number with these keys.
    pub(crate) fn matches(&self, keys: &[String]) -> bool {
        self.pattern.matches(keys)
    }

    /// Path, as it was written.
    pub(crate) fn path(&self) -> &str {
        &self.pattern.text
    }
}

/// Tolerance of a number that no option gives.
fn usual_tolerance(parameter: &Parameter, value: f64) -> f64 {
    match (parameter.unit, parameter.key) {
        // The thickness of a rope is no position.
        ("m", key) if !key.contains("diameter") => TOLERANCE_OF_LENGTH_M,
        ("degrees", _) => TOLERANCE_OF_ANGLE_DEG,
        _ => RELATIVE_TOLERANCE * value.abs(),
    }
}

/// Value of a number of the file, or what an option has put in its place.
pub(crate) fn value_at(at_rest: &AtRest, parameter: &Parameter) -> f64 {
    let robot = &at_rest.robot;
    let Load { force_w, moment_w, point_p } = &robot.load;
    let axis = ["x", "y", "z"].iter().position(|axis| Some(*axis) == parameter.component);
    let of = |vector: &Vec3| axis.map(|axis| vector[axis]);
    let angle = |angles: [f64; 3]| {
        ["roll", "pitch", "yaw"].iter().position(|name| Some(*name) == parameter.component).map(|axis| angles[axis])
    };
    let found = match (parameter.part, parameter.key) {
        (RobotPart::Platform, "mass_kg") => Some(robot.platform.mass),
        (RobotPart::Load, "force_n") => of(force_w),
        (RobotPart::Load, "moment_n_m") => of(moment_w),
        (RobotPart::Load, "point_m") => of(point_p),
        (RobotPart::Wind, "velocity_m_s") => of(&robot.wind.velocity_w),
        (RobotPart::State, "position_m") => of(&at_rest.equilibrium.pose.position_w),
        (RobotPart::State, "roll_pitch_yaw_deg") => angle(robot.written_angles_deg),
        (RobotPart::Cable(i), "unstrained_length_m") => Some(at_rest.equilibrium.cables[i].unstrained_length),
        _ => None,
    };
    found.unwrap_or(parameter.value)
}

/// Rows of the table under construction.
struct Rows<'a> {
    changes: &'a [RobotChange],
    results: Vec<GradientResult>,
    refused: Vec<Refused>,
}

impl Rows<'_> {
    fn push(&mut self, name: String, unit: &str, value: f64, gradient: Result<RobotChange, GradientError>) {
        match gradient {
            Ok(gradient) => self.add(name, unit, value, None, &gradient),
            Err(error) => self.refused.push(Refused { name, reason: error.to_string() }),
        }
    }

    fn add(&mut self, name: String, unit: &str, value: f64, block_entry: Option<[usize; 2]>, gradient: &RobotChange) {
        // `+ 0.0` makes a negative zero positive.
        let derivatives = self.changes.iter().map(|change| gradient.dot(change) + 0.0).collect();
        self.results.push(GradientResult { name, unit: unit.to_owned(), value, block_entry, derivatives });
    }

    fn pose(&mut self, gradients: &Gradients) {
        const NAMES: [(&str, &str); 6] = [
            ("x", "m"),
            ("y", "m"),
            ("z", "m"),
            ("rotation about x", "rad"),
            ("rotation about y", "rad"),
            ("rotation about z", "rad"),
        ];
        let position: [f64; 3] = gradients.equilibrium().pose.position_w.into();
        for (k, ((name, unit), gradient)) in NAMES.into_iter().zip(gradients.pose()).enumerate() {
            // A rotation is counted from the equilibrium.
            self.add(name.to_owned(), unit, position.get(k).copied().unwrap_or(0.0), None, &gradient);
        }
    }

    fn of_cables(
        &mut self,
        robot: &Robot,
        before: &str,
        after: &str,
        unit: &str,
        values: &[f64],
        gradients: &[RobotChange],
    ) {
        for ((cable, value), gradient) in robot.cables.iter().zip(values).zip(gradients) {
            self.add(format!("{before} \"{}\"{after}", cable.name), unit, *value, None, gradient);
        }
    }

    /// Natural frequencies and damping ratios below a limit.
    fn modes(&mut self, dynamics: &Dynamics, vibration: &VibrationGradients, of: &[&str], below_hz: f64) {
        let found = modes::below(dynamics, below_hz);
        if of.contains(&"frequencies") {
            let mut next = 0;
            while next < found.modes.len() {
                let count = found.modes[next].multiplicity.clamp(1, found.modes.len() - next);
                let shared: Vec<&modes::Mode> = found.modes[next..next + count].iter().collect();
                let value = shared[0].frequency_hz;
                if count == 1 {
                    self.push(format!("frequency {}", next + 1), "Hz", value, vibration.frequency(shared[0]));
                } else {
                    for (i, row) in vibration.block(&shared).iter().enumerate() {
                        for (j, gradient) in row.iter().enumerate().skip(i) {
                            let entry = [next + i + 1, next + j + 1];
                            let name = format!(
                                "frequencies {} to {}, entry {}, {}",
                                next + 1,
                                next + count,
                                entry[0],
                                entry[1]
                            );
                            self.add(name, "Hz", value, Some(entry), gradient);
                        }
                    }
                }
                next += count;
            }
        }

        if of.contains(&"damping") {
            let damped = modes::damped::damped_modes(dynamics, &found);
            for (k, mode) in damped.modes.iter().enumerate() {
                let gradient = vibration.damped(mode);
                let name = format!("damping ratio {}", k + 1);
                self.push(name, "1", mode.damping_ratio(), gradient.map(|gradient| gradient.damping_ratio));
            }
        }
    }

    /// Response at one frequency: real and imaginary part.
    fn response(&mut self, robot: &Robot, vibration: &VibrationGradients, request: &GradientRequest) -> Result<()> {
        let (Some(input), Some(output), Some(at_hz)) = (&request.input, &request.output, request.at_hz) else {
            bail!("a response needs ⟪input⟫, ⟪output⟫ and ⟪at_hz⟫");
        };
        let (input, output) = (request::input(input)?, request::output(output)?);
        request.points.check()?;
        let [at_input, at_output] =
            [request.points.input_point_m, request.points.output_point_m].map(|point| point.map(Vec3::from));
        let (from, to) = (input.signal(robot, at_input)?, output.signal(robot, at_output)?);
        let quantity: Quantity = output.quantity;
        let rows = vibration.responses(&[from], &[(to, quantity)], &[at_hz], self.changes)?;
        let Some(found) = rows.first().and_then(|row| row.first()) else { bail!("the response has no value") };

        let unit = crate::signals::response_unit(&input, &output);
        for (part, value, derivatives) in [
            ("real part", found.value.re, found.along.iter().map(|z| z.re + 0.0).collect()),
            ("imaginary part", found.value.im, found.along.iter().map(|z| z.im + 0.0).collect()),
        ] {
            let name = format!("response at {at_hz} Hz, {part}");
            self.results.push(GradientResult { name, unit: unit.clone(), value, block_entry: None, derivatives });
        }
        Ok(())
    }
}

//! Functions of a Universal File as measured responses of the robot: signals, points and SI units.

use super::given_signals::{
    ACCELERATION, DISPLACEMENT, DataQuantity, FORCE, FREQUENCY, GENERAL, GivenSignals, UNKNOWN, VELOCITY,
    given_signals, quantity_of, sign_along,
};
use super::uff::{Function, NodeDirection, UffAxis, UffFile};
use super::unit_label::{self, Dimension, FORCE as NEWTON, LENGTH as METRE, MOMENT, NO_DIMENSION};
use super::{MeasuredResponse, ResponseName};
use anyhow::{Result, anyhow, bail};
use funicular::response::Quantity;
use funicular_study::signals::{Input, Output, Place};
use funicular_study::text::{counted, short};
use serde::Deserialize;
use std::collections::BTreeMap;

/// Node of a file and its point of the platform.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NodePoint {
    /// Number of the node.
    pub node: i64,
    /// Point, platform frame [m].
    pub point_m: [f64; 3],
}

/// Magnitudes of the numbers of a response; binary data that are read in a wrong byte order are soon outside.
const MAGNITUDES: std::ops::RangeInclusive<f64> = 1e-30..=1e30;

/// Relative difference of two factors to SI units that are not the same unit: rounded factors of a file have it.
const SAME_UNIT: f64 = 1e-3;

/// Stands for the line of a function in a reason to leave it out.
const LINE: &str = "<line>";

/// End of a message: how to give the signals of a function.
const GIVE_SIGNALS: &str = "give its signals, as in ⟪response⟫ \"<line>=az/fz\" (output/input), or write it as CSV";

/// Type of function of a frequency response.
pub(crate) const RESPONSE: i64 = 4;

/// Frequency responses of a file, with points by `nodes`, or else by the nodes of the file. `names` gives the signals
/// of functions that do not tell them. SI units follow from the labels of the units and from dataset 164. The second
/// list names what was left out, converted or replaced.
///
/// # Errors
/// A unit that is not known or contradicts dataset 164, damaged numbers, or a file without a single function that can
/// be used; the message names the line of the dataset.
pub(crate) fn responses_of_uff(
    path: &str,
    file: &UffFile,
    nodes: &[NodePoint],
    names: &[ResponseName],
) -> Result<(Vec<MeasuredResponse>, Vec<String>)> {
    let mut notes = Vec::new();

    for (i, known) in nodes.iter().enumerate() {
        if nodes[..i].iter().any(|other| other.node == known.node) {
            bail!("⟪node⟫ {}: the node is there twice; give it one point", known.node);
        }

        let is_of =
            |function: &Function| [&function.response, &function.reference].iter().any(|end| end.node == known.node);
        if !file.functions.iter().any(is_of) {
            notes.push(format!("{path}: no function is at node {}, whose point is not used", known.node));
        }
    }

    let given = given_signals(path, file, names, &mut notes)?;
    let mut found = FoundResponses::default();
    for (i, function) in file.functions.iter().enumerate() {
        let signals = given.get(&i);
        let is_frequency = matches!(function.abscissa.kind, FREQUENCY | UNKNOWN | GENERAL);
        if signals.is_some() || (function.kind == RESPONSE && is_frequency) {
            let of = UffResponse { path, file, function, nodes, signals };
            match of.converted(&mut found.conversions) {
                Ok(response) => found.responses.push(response),
                Err(Refusal::Unfit(reason)) => found.unfit.entry(reason).or_default().push(function.line + 1),
                Err(Refusal::Wrong(error)) => return Err(error),
            }
        } else {
            *found.others.entry(function.kind).or_default() += 1;
        }
    }

    found.checked(path, file, notes)
}

/// Responses of a file, and what a note says about the others.
#[derive(Default)]
struct FoundResponses {
    responses: Vec<MeasuredResponse>,
    /// Sentences on conversions, with the number of functions.
    conversions: BTreeMap<String, usize>,
    /// Reasons to leave functions out, with their lines.
    unfit: BTreeMap<String, Vec<usize>>,
    /// Numbers of functions of other types.
    others: BTreeMap<i64, usize>,
}

impl FoundResponses {
    /// Responses and notes; or the first reason why there are none.
    fn checked(self, path: &str, file: &UffFile, notes: Vec<String>) -> Result<(Vec<MeasuredResponse>, Vec<String>)> {
        let mut notes = notes;
        if self.responses.is_empty() {
            let first = self.unfit.iter().min_by_key(|(_, lines)| lines.first());
            let Some((reason, lines)) = first else {
                bail!("{path} has no frequency response: no dataset 58 has a function of type {RESPONSE}");
            };
            let line = format!("line {}", lines.first().copied().unwrap_or_default());
            bail!("{path}: the function in {line} {}", reason.replace(LINE, &line));
        }

        for (sentence, count) in self.conversions {
            notes.push(format!("{path}: {}: {sentence}", counted(count, "function")));
        }
        for (reason, lines) in self.unfit {
            let others = match lines.len() {
                0 | 1 => String::new(),
                2 => ", as is another one".to_owned(),
                count => format!(", as are {} others", count - 1),
            };
            let line = format!("line {}", lines.first().copied().unwrap_or_default());
            let reason = reason.replace(LINE, &line);
            notes.push(format!("{path}: the function in {line} is left out{others}: it {reason}"));
        }
        for (kind, count) in self.others {
            notes.push(format!(
                "{path}: {} of type {kind} left out; frequency responses have type {RESPONSE}",
                counted(count, "function")
            ));
        }
        for (kind, count) in &file.skipped {
            notes.push(format!("{path}: {} {kind} left out", counted(*count, "dataset")));
        }
        Ok((self.responses, notes))
    }
}

/// Reason why a function is no response.
enum Refusal {
    /// The function is something else, or tells too little: the others may be used. The text follows `the function`.
    Unfit(String),
    /// The file has to change.
    Wrong(anyhow::Error),
}

impl From<anyhow::Error> for Refusal {
    fn from(error: anyhow::Error) -> Self {
        Self::Wrong(error)
    }
}

/// Response in a file.
struct UffResponse<'a> {
    path: &'a str,
    file: &'a UffFile,
    function: &'a Function,
    nodes: &'a [NodePoint],
    signals: Option<&'a GivenSignals>,
}

/// Names of output and input, and the sign of their directions.
struct Signals {
    output: Output,
    input: Input,
    sign: f64,
}

impl UffResponse<'_> {
    /// Beginning of a message about this function.
    fn place(&self) -> String {
        format!("{}: the function in line {}", self.path, self.function.line + 1)
    }

    fn converted(&self, conversions: &mut BTreeMap<String, usize>) -> Result<MeasuredResponse, Refusal> {
        let Function { response, reference, abscissae, values, .. } = self.function;
        if !self.function.is_complex {
            return Err(Refusal::Unfit(
                "has real ordinates: a response needs its phase, so export it with complex numbers".to_owned(),
            ));
        }
        let mut notes = Vec::new();
        let Signals { output, input, sign } = match self.signals {
            Some(given) => self.with_given(given, &mut notes),
            None => self.told(&mut notes)?,
        };
        let [input_point_m, output_point_m] = [(reference, &input.place), (response, &output.place)]
            .map(|(end, place)| matches!(place, Place::Platform { turns: false, .. }).then(|| self.point(end.node)));
        let (input_point_m, output_point_m) = (input_point_m.transpose()?, output_point_m.transpose()?);

        let factor = sign * self.to_si(&output, &input, &mut notes)?;
        let hertz = self.hertz(&mut notes)?;
        let parts = values.iter().flat_map(|value| [value.re, value.im]).chain(abscissae.iter().copied());
        if let Some(number) = parts.into_iter().find(|number| *number != 0.0 && !MAGNITUDES.contains(&number.abs())) {
            return Err(Refusal::Wrong(anyhow!(
                "{} has the number {number:e}, which nobody measures: in binary data (dataset 58b) the byte order of \
                 the file is wrong, or the data are damaged",
                self.place()
            )));
        }

        for note in notes {
            *conversions.entry(note).or_default() += 1;
        }
        Ok(MeasuredResponse {
            name: format!("{} at node {} / {} at node {}", output.name, response.node, input.name, reference.node),
            input: input.name,
            input_point_m,
            output: output.name,
            output_point_m,
            frequency_hz: abscissae.iter().map(|abscissa| abscissa * hertz).collect(),
            real: values.iter().map(|value| value.re * factor).collect(),
            imag: values.iter().map(|value| value.im * factor).collect(),
            std: None,
        })
    }

    /// Signals that the user has given, with the signs of the file along the same axes.
    fn with_given(&self, given: &GivenSignals, notes: &mut Vec<String>) -> Signals {
        let Function { response, reference, .. } = self.function;
        let mut sign = 1.0;
        for (end, place, name) in
            [(response, &given.output.place, &given.output.name), (reference, &given.input.place, &given.input.name)]
        {
            match sign_along(end, place) {
                Some(of_end) => sign *= of_end,
                None if end.direction != 0 => {
                    notes.push(format!("⟪response⟫ {name} replaces the direction {} of the file", end.direction));
                }
                None => {}
            }
        }
        Signals { output: given.output.clone(), input: given.input.clone(), sign }
    }

    /// Signals by the types and directions of the file; where the type of the ordinates tells nothing, by the label of
    /// their unit.
    fn told(&self, notes: &mut Vec<String>) -> Result<Signals, Refusal> {
        let Function { numerator, denominator, response, reference, .. } = self.function;
        if quantity_of(numerator.kind) == DataQuantity::Other {
            return Err(Refusal::Unfit(format!(
                "has ordinates of data type {}: a response needs displacement ({DISPLACEMENT}), velocity ({VELOCITY}) \
                 or acceleration ({ACCELERATION})",
                numerator.kind
            )));
        }
        if !matches!(denominator.kind, FORCE | UNKNOWN | GENERAL) {
            return Err(Refusal::Unfit(format!(
                "is a response per data type {}: it must be force ({FORCE})",
                denominator.kind
            )));
        }
        let (out_axis, out_turns, out_sign) = direction(response, "response")?;
        let (in_axis, in_turns, in_sign) = direction(reference, "reference")?;
        let input = format!("{}{in_axis}", if in_turns { "m" } else { "f" });
        let input = Input::parse(&input).map_err(anyhow::Error::from)?;

        let named = |prefix: &str| {
            let name = format!("{prefix}{}{out_axis}", if out_turns { "r" } else { "" });
            Output::parse(&name).map_err(anyhow::Error::from)
        };
        let all = [named("")?, named("v")?, named("a")?];
        let output = if let DataQuantity::Motion(quantity) = quantity_of(numerator.kind) {
            all.into_iter().find(|output| output.quantity == quantity)
        } else {
            let fits = |output: &Output| {
                size_of(unit_of(numerator, |label| size_of(label, output, &input).is_some()), output, &input).is_some()
            };
            let mut fitting = all.into_iter().filter(fits);
            let only = fitting.next().filter(|_| fitting.next().is_none());
            if let Some(output) = &only {
                let fits = |label: &str| size_of(label, output, &input).is_some();
                let unit = unit_of(numerator, fits);
                notes.push(format!("taken as {} by the unit `{unit}` of the ordinates", output.name));
            }
            only
        };
        let Some(output) = output else {
            return Err(Refusal::Unfit(format!(
                "has ordinates of data type {} and the unit `{}`, which do not tell whether they are displacement, \
                 velocity or acceleration: {}",
                numerator.kind, numerator.unit, GIVE_SIGNALS
            )));
        };
        Ok(Signals { output, input, sign: out_sign * in_sign })
    }

    /// Point of the platform at a node [m].
    fn point(&self, node: i64) -> Result<[f64; 3], Refusal> {
        if let Some(known) = self.nodes.iter().find(|known| known.node == node) {
            return Ok(known.point_m);
        }
        match self.file.nodes.get(&node) {
            Some(place) => Ok(place.map(|number| number / self.file.units.length)),
            None => Err(Refusal::Unfit(format!(
                "is at node {node}, whose place on the platform is unknown: give ⟪node⟫ {node}=x,y,z in the platform \
                 frame [m]"
            ))),
        }
    }

    /// Factor to SI units, in which displacements are metres or radians, and loads newtons or newton metres.
    fn to_si(&self, output: &Output, input: &Input, notes: &mut Vec<String>) -> Result<f64> {
        let Function { numerator, denominator, .. } = self.function;
        let (of_output, of_input) = (dimension_of_output(output), dimension_of_input(input));
        let wrong = |axis: &UffAxis, what: &str| {
            anyhow!(
                "{} has the unit `{}` of its {what}, which is no known unit of {}: correct the label, or export the \
                 file in SI units",
                self.place(),
                axis.unit,
                if what == "ordinates" { &output.name } else { &input.name }
            )
        };

        let of_ratio = ratio(of_output, of_input);
        let is_of_load = |label: &str| unit_label::size(label, of_input).is_some();
        let is_of_ordinates = |label: &str| size_of(label, output, input).is_some();
        let (above, below) = (unit_of(numerator, is_of_ordinates), unit_of(denominator, is_of_load));

        let load = if unit_label::is_blank(below) {
            self.by_dataset(of_input)
        } else {
            let size = unit_label::size(below, of_input).ok_or_else(|| wrong(denominator, "denominator"))?;
            self.agreed(below, size, of_input)?
        };
        if unit_label::is_blank(above) {
            return Ok(self.by_dataset(of_output) / noted(notes, below, load));
        }
        if let Some(size) = unit_label::size(above, of_output) {
            let size = self.agreed(above, size, of_output)?;
            return Ok(noted(notes, above, size) / noted(notes, below, load));
        }
        let size = unit_label::size(above, of_ratio).ok_or_else(|| wrong(numerator, "ordinates"))?;
        let size = self.agreed(above, size, of_ratio)?;
        if !unit_label::is_blank(below) && !unit_label::is_part_of(below, above) {
            bail!(
                "{} has the unit `{above}` of its ordinates and the unit `{below}` of its denominator, which \
                 contradict each other: correct one of the labels",
                self.place()
            );
        }
        Ok(noted(notes, above, size))
    }

    /// Size of the unit that dataset 164 gives a quantity; 1 without such a dataset.
    fn by_dataset(&self, [length, mass, _]: Dimension) -> f64 {
        let units = self.file.units;
        // A force has a length and a mass.
        units.length.powi(mass - length) * units.force.powi(-mass)
    }

    /// Size of a label's unit, which dataset 164 must not contradict unless it says that the file is in SI units: then
    /// the label, which stands at the numbers, counts.
    fn agreed(&self, label: &str, size: f64, dimension: Dimension) -> Result<f64> {
        let by_dataset = self.by_dataset(dimension);
        if self.file.units.converts() && (size / by_dataset - 1.0).abs() > SAME_UNIT {
            bail!(
                "{} has the unit `{label}`, which is {} in SI units, but by the factors of the file (dataset 164) it \
                 is {}: correct one of them, or remove dataset 164",
                self.place(),
                short(size, 7),
                short(by_dataset, 7)
            );
        }
        Ok(size)
    }

    /// Factor of the abscissae to hertz.
    fn hertz(&self, notes: &mut Vec<String>) -> Result<f64, Refusal> {
        let kind = self.function.abscissa.kind;
        let unit = unit_of(&self.function.abscissa, |label| unit_label::hertz(label).is_some());
        if unit_label::is_blank(unit) {
            return Ok(1.0);
        }
        match unit_label::hertz(unit) {
            Some(size) => {
                if (size - 1.0).abs() > f64::EPSILON {
                    notes.push(format!("the unit `{unit}` of the abscissae is converted: it is {} Hz", short(size, 7)));
                }
                Ok(size)
            }
            None if kind != FREQUENCY && self.signals.is_none() => {
                Err(Refusal::Unfit(format!("has abscissae in the unit `{unit}`, which is no known unit of frequency")))
            }
            None => Err(Refusal::Wrong(anyhow!(
                "{} has abscissae in the unit `{unit}`, which is no known unit of frequency: correct the label, or \
                 export the file with Hz",
                self.place()
            ))),
        }
    }
}

/// Axis, true for a rotation or moment, and sign of a direction.
fn direction(end: &NodeDirection, what: &str) -> Result<(char, bool, f64), Refusal> {
    let sign = if end.direction < 0 { -1.0 } else { 1.0 };
    let (axis, turns) = match end.direction.abs() {
        1 => ('x', false),
        2 => ('y', false),
        3 => ('z', false),
        4 => ('x', true),
        5 => ('y', true),
        6 => ('z', true),
        _ => {
            return Err(Refusal::Unfit(format!(
                "has no direction of its {what}: it is {}, it must be 1 to 6 or -1 to -6; {}",
                end.direction, GIVE_SIGNALS
            )));
        }
    };
    Ok((axis, turns, sign))
}

/// Label of an axis's unit; where its field says nothing, the unit that stands in the label of the axis, as in
/// `Acceleration (g's)`.
fn unit_of(axis: &UffAxis, fits: impl Fn(&str) -> bool) -> &str {
    let UffAxis { label, unit, .. } = axis;
    if !unit_label::is_blank(unit) {
        return unit;
    }
    let bracketed = label.find(['(', '[']).and_then(|at| label.get(at..));
    // A single letter is a name of an axis.
    let whole = Some(label.as_str()).filter(|label| label.len() > 1);
    bracketed.into_iter().chain(whole).find(|label| fits(label)).unwrap_or(unit)
}

/// Dimension of an output: that of its unit, with a second less for each derivative.
fn dimension_of_output(output: &Output) -> Dimension {
    let [length, mass, time] = dimension_of(output.unit());
    let derivatives = match output.quantity {
        Quantity::Displacement => 0,
        Quantity::Velocity => 1,
        Quantity::Acceleration => 2,
    };
    [length, mass, time - derivatives]
}

fn dimension_of_input(input: &Input) -> Dimension {
    dimension_of(input.unit())
}

/// Dimension of a unit in which signals are given.
fn dimension_of(unit: &str) -> Dimension {
    match unit {
        "N" => NEWTON,
        "N m" => MOMENT,
        "m" => METRE,
        _ => NO_DIMENSION,
    }
}

fn ratio(of_output: Dimension, of_input: Dimension) -> Dimension {
    [0, 1, 2].map(|i| of_output[i] - of_input[i])
}

/// Size of a label's unit, as that of the output or of the whole response.
fn size_of(label: &str, output: &Output, input: &Input) -> Option<f64> {
    let of_output = dimension_of_output(output);
    let whole = ratio(of_output, dimension_of_input(input));
    [of_output, whole].into_iter().find_map(|dimension| unit_label::size(label, dimension))
}

/// Size of a unit, with a note if it is no SI unit.
fn noted(notes: &mut Vec<String>, label: &str, size: f64) -> f64 {
    if (size - 1.0).abs() > f64::EPSILON && !unit_label::is_blank(label) {
        notes.push(format!("the unit `{label}` is converted: it is {} in SI units", short(size, 7)));
    }
    size
}

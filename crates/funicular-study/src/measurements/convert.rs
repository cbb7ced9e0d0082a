//! Functions of a Universal File as measured responses of the robot: signals, points and SI units.

use super::MeasuredResponse;
use super::uff::{Function, NodeDirection, UffAxis, UffFile};
use anyhow::{Result, bail};
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

/// Specific data types of dataset 58.
const DISPLACEMENT: i64 = 8;
const VELOCITY: i64 = 11;
const ACCELERATION: i64 = 12;
const FORCE: i64 = 13;
const UNKNOWN: i64 = 0;
const GENERAL: i64 = 1;
const FREQUENCY: i64 = 18;

/// Magnitudes of the numbers of a response; binary data that are read in a wrong byte order are soon outside.
const MAGNITUDES: std::ops::RangeInclusive<f64> = 1e-30..=1e30;

/// Type of function of a frequency response.
pub(crate) const RESPONSE: i64 = 4;

/// Frequency responses of a file, with points by `nodes`, or else by the nodes of the file. Their SI units follow from
/// dataset 164. The second list names what was left out.
///
/// # Errors
/// A node without a place, a response without a direction, a quantity that is no motion per force, or units that
/// contradict each other; the message names the line of the dataset.
pub fn responses_of_uff(
    path: &str,
    file: &UffFile,
    nodes: &[NodePoint],
) -> Result<(Vec<MeasuredResponse>, Vec<String>)> {
    let (mut responses, mut notes) = (Vec::new(), Vec::new());

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

    let mut others: BTreeMap<i64, usize> = BTreeMap::new();

    for function in &file.functions {
        if function.kind == RESPONSE && matches!(function.abscissa.kind, FREQUENCY | UNKNOWN | GENERAL) {
            let of = UffResponse { path, file, function, nodes };
            responses.push(of.converted()?);
        } else {
            *others.entry(function.kind).or_default() += 1;
        }
    }

    for (kind, count) in others {
        notes.push(format!(
            "{path}: {} of type {kind} left out; frequency responses have type {RESPONSE}",
            crate::text::counted(count, "function")
        ));
    }
    for (kind, count) in &file.skipped {
        notes.push(format!("{path}: {} {kind} left out", crate::text::counted(*count, "dataset")));
    }

    if responses.is_empty() {
        bail!("{path} has no frequency response: no dataset 58 has a function of type {RESPONSE}");
    }

    Ok((responses, notes))
}

/// Response in a file.
struct UffResponse<'a> {
    path: &'a str,
    file: &'a UffFile,
    function: &'a Function,
    nodes: &'a [NodePoint],
}

impl UffResponse<'_> {
    /// Beginning of a message about this function.
    fn place(&self) -> String {
        format!("{}: the function in line {}", self.path, self.function.line + 1)
    }

    fn converted(&self) -> Result<MeasuredResponse> {
        let Function { numerator, denominator, response, reference, .. } = self.function;
        if !self.function.is_complex {
            bail!("{} has real ordinates: a response needs its phase, so export it with complex numbers", self.place());
        }
        let prefix = match numerator.kind {
            DISPLACEMENT => "",
            VELOCITY => "v",
            ACCELERATION => "a",
            other => bail!(
                "{} has ordinates of data type {other}: a response needs displacement ({DISPLACEMENT}), velocity \
                 ({VELOCITY}) or acceleration ({ACCELERATION})",
                self.place()
            ),
        };
        if !matches!(denominator.kind, FORCE | UNKNOWN | GENERAL) {
            bail!("{} is a response per data type {}: it must be force ({FORCE})", self.place(), denominator.kind);
        }
        let (out_axis, out_turns, out_sign) = self.direction(response, "response")?;
        let (in_axis, in_turns, in_sign) = self.direction(reference, "reference")?;
        let input = format!("{}{in_axis}", if in_turns { "m" } else { "f" });
        let output = format!("{prefix}{}{out_axis}", if out_turns { "r" } else { "" });

        let factor = out_sign * in_sign * self.to_si(numerator, denominator, out_turns, in_turns)?;
        let Function { abscissae, values, .. } = self.function;
        let parts = values.iter().flat_map(|value| [value.re, value.im]).chain(abscissae.iter().copied());
        if let Some(number) = parts.into_iter().find(|number| *number != 0.0 && !MAGNITUDES.contains(&number.abs())) {
            bail!(
                "{} has the number {number:e}, which nobody measures: in binary data (dataset 58b) the byte order of \
                 the file is wrong, or the data are damaged",
                self.place()
            );
        }
        let [input_point_m, output_point_m] =
            [(reference, in_turns), (response, out_turns)].map(|(end, turns)| (!turns).then(|| self.point(end.node)));
        Ok(MeasuredResponse {
            name: format!("{output} at node {} / {input} at node {}", response.node, reference.node),
            input,
            input_point_m: input_point_m.transpose()?,
            output,
            output_point_m: output_point_m.transpose()?,
            frequency_hz: abscissae.clone(),
            real: values.iter().map(|value| value.re * factor).collect(),
            imag: values.iter().map(|value| value.im * factor).collect(),
            std: None,
        })
    }

    /// Axis, true for a rotation or moment, and sign of a direction.
    fn direction(&self, end: &NodeDirection, what: &str) -> Result<(char, bool, f64)> {
        let sign = if end.direction < 0 { -1.0 } else { 1.0 };
        let (axis, turns) = match end.direction.abs() {
            1 => ('x', false),
            2 => ('y', false),
            3 => ('z', false),
            4 => ('x', true),
            5 => ('y', true),
            6 => ('z', true),
            _ => bail!(
                "{} has no direction of its {what}: it is {}, it must be 1 to 6 or -1 to -6",
                self.place(),
                end.direction
            ),
        };
        Ok((axis, turns, sign))
    }

    /// Point of the platform at a node [m].
    fn point(&self, node: i64) -> Result<[f64; 3]> {
        if let Some(known) = self.nodes.iter().find(|known| known.node == node) {
            return Ok(known.point_m);
        }
        match self.file.nodes.get(&node) {
            Some(place) => Ok(place.map(|number| number / self.file.units.length)),
            None => bail!(
                "{} is at node {node}, whose place on the platform is unknown: give ⟪node⟫ {node}=x,y,z in the \
                 platform frame [m]",
                self.place()
            ),
        }
    }

    /// Factor to SI units, in which displacements are metres or radians, and loads newtons or newton metres.
    fn to_si(&self, numerator: &UffAxis, denominator: &UffAxis, out_turns: bool, in_turns: bool) -> Result<f64> {
        let units = self.file.units;
        for axis in [numerator, denominator] {
            let label = axis.unit.to_lowercase();
            // Labels of units that are no SI units; without factors nobody would notice.
            let first = label.split(['/', ' ', '*', '(']).next().unwrap_or_default();
            if matches!(first, "g" | "gn" | "mm" | "cm" | "in" | "inch" | "ft" | "lbf" | "lb" | "kn" | "kgf")
                && !units.converts()
            {
                bail!(
                    "{} has the unit `{}`, but the file gives no factor to SI units (dataset 164): export it \
                     in SI units",
                    self.place(),
                    axis.unit
                );
            }
        }
        let length = if out_turns { 1.0 } else { units.length };
        let load = units.force * if in_turns { units.length } else { 1.0 };
        Ok(load / length)
    }
}

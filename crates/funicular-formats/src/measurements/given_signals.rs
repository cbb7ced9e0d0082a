//! Signals of functions of a Universal File: by their data types and directions, and as the user gives them for
//! functions that do not tell them.

use super::ResponseName;
use super::uff::{Function, NodeDirection, UffFile};
use super::unit_label;
use anyhow::{Result, anyhow, bail};
use funicular::math::Vec3;
use funicular::response::Quantity;
use funicular_study::signals::{Input, Output, Place};
use std::collections::BTreeMap;

/// Specific data types of dataset 58.
pub(super) const DISPLACEMENT: i64 = 8;
pub(super) const VELOCITY: i64 = 11;
pub(super) const ACCELERATION: i64 = 12;
pub(super) const FORCE: i64 = 13;
pub(super) const UNKNOWN: i64 = 0;
pub(super) const GENERAL: i64 = 1;
pub(super) const FREQUENCY: i64 = 18;

/// Signals that the user has given for a function.
pub(super) struct GivenSignals {
    pub(super) output: Output,
    pub(super) input: Input,
}

/// Signals by the index of their function. A name that belongs to no function is told in a note.
pub(super) fn given_signals(
    path: &str,
    file: &UffFile,
    names: &[ResponseName],
    notes: &mut Vec<String>,
) -> Result<BTreeMap<usize, GivenSignals>> {
    let mut given = BTreeMap::new();
    for named in names {
        let output = Output::parse(&named.output)
            .map_err(|error| anyhow!("⟪response⟫ {}: {}: {error}", named.name, named.output))?;
        let input = Input::parse(&named.input)
            .map_err(|error| anyhow!("⟪response⟫ {}: {}: {error}", named.name, named.input))?;
        let signals = GivenSignals { output, input };
        let functions = file.functions.iter().enumerate();
        let matching: Vec<usize> =
            functions.filter(|(_, function)| signals.belong_to(&named.name, function)).map(|(i, _)| i).collect();
        match matching[..] {
            [] => notes.push(format!("{path}: no function is called {}, whose signals are not used", named.name)),
            [only] => {
                if given.insert(only, signals).is_some() {
                    bail!(
                        "⟪response⟫ {}: {path}: the function in line {} has two names; give its signals once",
                        named.name,
                        file.functions[only].line + 1
                    );
                }
            }
            [first, second, ..] => {
                let [first, second] = [first, second].map(|i| file.functions[i].line + 1);
                bail!(
                    "⟪response⟫ {}: {path}: {} functions have this name, the first in lines {first} and {second}: name \
                     one by its line, as in line {first}=az/fz",
                    named.name,
                    matching.len()
                )
            }
        }
    }
    Ok(given)
}

impl GivenSignals {
    /// True if a name means a function: its line, its first line of text, or these signals at its nodes, as in `az at
    /// node 1`. In the last case, what the function tells must not contradict the signals.
    fn belong_to(&self, name: &str, function: &Function) -> bool {
        if name == format!("line {}", function.line + 1) {
            return true;
        }
        if !unit_label::is_blank(&function.texts[0]) && name == function.texts[0] {
            return true;
        }

        let response = format!("{} at node {}", self.output.name, function.response.node);
        let whole = format!("{response} / {} at node {}", self.input.name, function.reference.node);
        let may_be = |end: &NodeDirection, place: &Place| end.direction == 0 || sign_along(end, place).is_some();
        (name == response || name == whole)
            && match quantity_of(function.numerator.kind) {
                DataQuantity::Unsaid => true,
                DataQuantity::Motion(quantity) => quantity == self.output.quantity,
                DataQuantity::Other => false,
            }
            && may_be(&function.response, &self.output.place)
            && may_be(&function.reference, &self.input.place)
    }
}

/// Quantity that a specific data type tells.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum DataQuantity {
    /// The type is general or unknown.
    Unsaid,
    Motion(Quantity),
    /// The type is no motion.
    Other,
}

/// Quantity of a specific data type.
pub(super) fn quantity_of(kind: i64) -> DataQuantity {
    match kind {
        UNKNOWN | GENERAL => DataQuantity::Unsaid,
        DISPLACEMENT => DataQuantity::Motion(Quantity::Displacement),
        VELOCITY => DataQuantity::Motion(Quantity::Velocity),
        ACCELERATION => DataQuantity::Motion(Quantity::Acceleration),
        _ => DataQuantity::Other,
    }
}

/// Sign of the file's direction if it is along the axis of a signal of the platform.
pub(super) fn sign_along(end: &NodeDirection, place: &Place) -> Option<f64> {
    let Place::Platform { turns, direction_w } = place else { return None };
    let axis = [Vec3::x(), Vec3::y(), Vec3::z()].iter().position(|axis| axis == direction_w)?;
    let number = axis + if *turns { 4 } else { 1 };
    (usize::try_from(end.direction.abs()) == Ok(number)).then(|| if end.direction < 0 { -1.0 } else { 1.0 })
}

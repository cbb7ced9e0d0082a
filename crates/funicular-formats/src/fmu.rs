//! Functional Mock-up Units: a reduced state space as a unit for Simulink, Modelica and other programs of simulation.
//!
//! Version 2.0 of the standard, because Simulink, OpenModelica and Dymola all read both kinds of units of this version,
//! and version 3.0 would add nothing to a linear model of numbers. The unit is its own C program: its description and
//! its source are made here, a C compiler makes the library.
//!
//! # References
//! Functional Mock-up Interface for Model Exchange and Co-Simulation 2.0.4, <https://fmi-standard.org>.

pub mod robot_unit;

use crate::export::xml_text::{in_comment, names};
use anyhow::{Result, bail};
use askama::Template;
use funicular::math::DMat;
use funicular::reduced_model::StateSpace;
use std::collections::BTreeSet;

/// Name of source and library in the unit.
pub const IDENTIFIER: &str = "funicular_model";

/// Steps of the default experiment per period of the highest frequency of the model.
const STEPS_PER_PERIOD: f64 = 20.0;

/// Description that a unit gives of its model.
pub struct UnitModel<'a> {
    /// Name of the robot.
    pub robot: &'a str,
    /// Highest frequency for which the model is made [Hz].
    pub below_hz: f64,
    /// Largest error of a response, relative to its peak.
    pub error: f64,
    /// Names and units of the inputs.
    pub inputs: Vec<(String, String)>,
    /// Names and units of the outputs.
    pub outputs: Vec<(String, String)>,
    /// Matrices.
    pub space: &'a StateSpace,
}

/// Texts of a unit.
pub struct UnitTexts {
    /// `modelDescription.xml`.
    pub description: String,
    /// `sources/funicular_model.c`.
    pub source: String,
    /// Names that are not those of the model, one sentence each.
    pub warnings: Vec<String>,
}

#[derive(Template)]
#[template(path = "fmu.xml", escape = "html")]
struct Description {
    name: String,
    guid: String,
    statement: String,
    version: &'static str,
    identifier: &'static str,
    units: BTreeSet<String>,
    step: f64,
    tolerance: f64,
    inputs: Vec<(String, String)>,
    outputs: Vec<(String, String)>,
    states: Vec<String>,
    nominals: Vec<f64>,
    first_state: usize,
}

#[derive(Template)]
#[template(path = "fmu.c", escape = "none")]
struct Source {
    comment_name: String,
    statement: String,
    identifier: &'static str,
    guid: String,
    inputs: usize,
    outputs: usize,
    states: usize,
    matrices: Vec<SparseMatrix>,
    nominals: Vec<f64>,
}

/// Entries of a matrix that are not zero: row, column, value.
struct SparseMatrix {
    name: &'static str,
    entries: Vec<(usize, usize, f64)>,
}

/// Writes description and source of a unit. An output that has the name of an input, such as the motion of a motor,
/// gets `(output)` behind it, because names in a unit differ.
///
/// # Errors
/// A model without states.
pub fn texts(of: &UnitModel) -> Result<UnitTexts> {
    let states = of.space.a.nrows();
    if states == 0 {
        bail!("the model has no states: a unit of a simulation needs some; raise ⟪order⟫ or lower ⟪tolerance⟫");
    }

    let given: Vec<&str> = of.inputs.iter().map(|(name, _)| name.as_str()).collect();
    let doubled = |name: &str| if given.contains(&name) { format!("{name} (output)") } else { name.to_owned() };
    let all: Vec<String> =
        given.iter().map(|name| (*name).to_owned()).chain(of.outputs.iter().map(|(name, _)| doubled(name))).collect();
    let mut warnings = Vec::new();
    let written = names("signal", all.iter().map(String::as_str), &[], &mut warnings);
    let units = of.inputs.iter().chain(&of.outputs).map(|(_, unit)| unit.clone());
    let mut signals: Vec<(String, String)> = written.into_iter().zip(units.clone()).collect();
    let outputs = signals.split_off(of.inputs.len());

    let matrices = [("A", &of.space.a), ("B", &of.space.b), ("C", &of.space.c), ("D", &of.space.d)];
    let statement = format!(
        "state space of the robot for frequencies below {} Hz; its responses differ from those of the complete model \
         by at most {:.3e} of their peaks",
        of.below_hz, of.error
    );
    let guid = guid(of, &matrices.map(|(_, matrix)| matrix));

    let source = Source {
        comment_name: in_comment(of.robot).replace("*/", "* /"),
        statement: statement.clone(),
        identifier: IDENTIFIER,
        guid: guid.clone(),
        inputs: signals.len(),
        outputs: outputs.len(),
        states,
        matrices: matrices.map(|(name, matrix)| sparse(name, matrix)).into(),
        nominals: nominals(of.space, &of.inputs),
    };
    let description = Description {
        name: names("robot", std::iter::once(of.robot), &[], &mut Vec::new()).remove(0),
        guid,
        statement,
        version: env!("CARGO_PKG_VERSION"),
        identifier: IDENTIFIER,
        units: units.collect(),
        step: 1.0 / (STEPS_PER_PERIOD * of.below_hz),
        tolerance: TOLERANCE,
        nominals: nominals(of.space, &of.inputs),
        first_state: signals.len() + outputs.len(),
        inputs: signals,
        outputs,
        states: (1..=states).map(|i| format!("x{i}")).collect(),
    };
    Ok(UnitTexts { description: description.render()? + "\n", source: source.render()? + "\n", warnings })
}

/// Relative tolerance of the default experiment, which importers take unless told otherwise. With 1e-5, the default of
/// many, a lightly damped mode gains or loses a tenth in a hundred periods.
const TOLERANCE: f64 = 1e-8;

/// Part of the largest size that a state has under one of the inputs below which an input does not decide about its
/// size: it hardly moves the state.
const MIN_SHARE: f64 = 1e-3;

/// Usual size of a command by its unit: a millimetre or ten newtons move a robot as far.
fn usual_size(unit: &str) -> f64 {
    match unit {
        "N" | "N m" => 10.0,
        "m" | "rad" => 1e-3,
        _ => 1.0,
    }
}

/// Sizes of the states under a usual size of an input: integrators compare their errors with them. Of several inputs
/// that which moves the state least decides, because a simulation may use it alone. A state without an input of its
/// own has the size of the states that drive it.
fn nominals(space: &StateSpace, inputs: &[(String, String)]) -> Vec<f64> {
    let states = space.a.nrows();
    let rates: Vec<f64> = (0..states).map(|i| space.a.row(i).amax()).collect();
    let under = |j: usize| -> Vec<f64> {
        let size = usual_size(&inputs[j].1);
        let own = |i: usize| if rates[i] > 0.0 { size * space.b[(i, j)].abs() / rates[i] } else { 0.0 };
        let mut sizes: Vec<f64> = (0..states).map(own).collect();
        let driven = |i: usize| space.a.row(i).iter().zip(&sizes).map(|(a, size)| (a * size).abs()).fold(0.0, f64::max);
        let by_others: Vec<f64> =
            (0..states).map(|i| if rates[i] > 0.0 { driven(i) / rates[i] } else { 0.0 }).collect();
        sizes.iter_mut().zip(by_others).for_each(|(size, other)| *size = size.max(other));
        sizes
    };
    let each: Vec<Vec<f64>> = (0..inputs.len()).map(under).collect();
    let of_state = |i: usize| {
        let most = each.iter().map(|sizes| sizes[i]).fold(0.0, f64::max);
        let deciding = each.iter().map(|sizes| sizes[i]).filter(|size| *size >= MIN_SHARE * most);
        if most > 0.0 { deciding.fold(most, f64::min) } else { 1.0 }
    };
    (0..states).map(of_state).collect()
}

fn sparse(name: &'static str, matrix: &DMat) -> SparseMatrix {
    let mut entries = Vec::new();
    for (i, row) in matrix.row_iter().enumerate() {
        entries.extend(row.iter().enumerate().filter(|(_, value)| **value != 0.0).map(|(j, value)| (i, j, *value)));
    }
    SparseMatrix { name, entries }
}

/// Mark of the unit, which description and library share: a hash of its numbers and names, so that equal models give
/// equal files.
fn guid(of: &UnitModel, matrices: &[&DMat]) -> String {
    let mut bytes: Vec<u8> = of.robot.bytes().collect();
    for (name, unit) in of.inputs.iter().chain(&of.outputs) {
        bytes.extend([name.as_bytes(), &[0], unit.as_bytes(), &[0]].concat());
    }
    bytes.extend(matrices.iter().flat_map(|matrix| matrix.iter().flat_map(|value| value.to_le_bytes())));
    mark(&bytes)
}

/// Mark of bytes in the form of a GUID.
fn mark(bytes: &[u8]) -> String {
    // FNV-1a with 64 bits, from two starts.
    const PRIME: u64 = 0x0000_0100_0000_01b3;
    const STARTS: [u64; 2] = [0xcbf2_9ce4_8422_2325, 0x8422_2325_cbf2_9ce4];

    let [a, b] =
        STARTS.map(|start| bytes.iter().fold(start, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(PRIME)));
    format!(
        "{{{:08x}-{:04x}-{:04x}-{:04x}-{:012x}}}",
        a >> 32,
        a >> 16 & 0xffff,
        a & 0xffff,
        b >> 48,
        b & 0xffff_ffff_ffff
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn model() -> StateSpace {
        let matrix = |rows, columns, values: &[f64]| DMat::from_row_slice(rows, columns, values);
        StateSpace {
            a: matrix(2, 2, &[0.0, 2.0, -2.0, -0.1]),
            b: matrix(2, 1, &[0.0, 1.0]),
            c: matrix(1, 2, &[1.0, 0.0]),
            d: matrix(1, 1, &[0.0]),
        }
    }

    fn unit<'a>(space: &'a StateSpace, robot: &'a str) -> UnitModel<'a> {
        let signal = |name: &str, unit: &str| vec![(name.to_owned(), unit.to_owned())];
        UnitModel {
            robot,
            below_hz: 5.0,
            error: 0.01,
            inputs: signal("motor:1", "N"),
            outputs: signal("motor:1", "m"),
            space,
        }
    }

    #[test]
    fn a_unit_has_a_variable_for_every_signal_state_and_rate_and_no_name_twice() {
        let space = model();
        let texts = texts(&unit(&space, "a < b */ \u{fffe}")).unwrap();
        let document = roxmltree::Document::parse(&texts.description).unwrap();
        let variables: Vec<&str> = (document.descendants())
            .filter(|node| node.has_tag_name("ScalarVariable"))
            .map(|node| node.attribute("name").unwrap())
            .collect();
        assert_eq!(variables, ["motor:1", "motor:1 (output)", "x1", "x2", "der(x1)", "der(x2)"]);
        assert_eq!(document.root_element().attribute("modelName"), Some("a < b */ _"));
        let guid = document.root_element().attribute("guid").unwrap();
        assert!(texts.source.contains(guid) && texts.source.contains("a < b * / _"), "{}", texts.source);
        assert!(texts.source.contains("{ 0, 1, 2e0 }, { 1, 0, -2e0 }, { 1, 1, -1e-1 }"), "{}", texts.source);
    }

    /// The size of a state is that under a millimetre or ten newtons, whichever moves it less; an input that hardly
    /// moves it does not count.
    #[test]
    fn nominals_are_those_of_usual_commands() {
        let mut space = model();
        space.b = DMat::from_row_slice(2, 3, &[0.0, 0.0, 0.0, 1.0, 50.0, 1e-9]);
        let input = |name: &str, unit: &str| (name.to_owned(), unit.to_owned());
        let nominals = nominals(&space, &[input("fz", "N"), input("length:1", "m"), input("mx", "N m")]);
        // A step of 1 mm moves both states by 50 · 1e-3 / 2.
        assert!(nominals.iter().all(|nominal| (nominal - 0.025).abs() < 1e-12), "{nominals:?}");
        let texts = texts(&unit(&space, "robot")).unwrap();
        let document = roxmltree::Document::parse(&texts.description).unwrap();
        let experiment = document.descendants().find(|node| node.has_tag_name("DefaultExperiment")).unwrap();
        let tolerance: f64 = experiment.attribute("tolerance").unwrap().parse().unwrap();
        assert!(tolerance <= 1e-8);
    }

    #[test]
    fn the_mark_follows_every_number() {
        let space = model();
        let mark = |space: &StateSpace| guid(&unit(space, "robot"), &[&space.a, &space.b, &space.c, &space.d]);
        let mut other = space.clone();
        other.d[(0, 0)] = 1e-300;
        assert_ne!(mark(&space), mark(&other));
        assert_eq!(mark(&space), mark(&space.clone()));
    }
}

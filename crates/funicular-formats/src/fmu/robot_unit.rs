//! The non-linear robot as a unit for co-simulation, of FMI 2.0 and 3.0: its own C program around the C library.
//!
//! # References
//! Functional Mock-up Interface 2.0.4 and 3.0.2, <https://fmi-standard.org>.

use super::{IDENTIFIER, mark};
use crate::export::xml_text::{in_comment, names};
use anyhow::{Context, Result, bail};
use askama::Template;
use funicular::simulation::{SimulationSettings, StepSignal, StepSignals, SteppedSimulation};
use funicular_study::at_rest::{self, AtRest};
use funicular_study::request::{Change, ExportRequest, RobotText};
use std::collections::BTreeSet;

/// Version of the standard.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FmiVersion {
    /// Version 2.0, which most programs read.
    Two,
    /// Version 3.0.
    Three,
}

/// Texts of a unit.
pub struct RobotUnit {
    /// `modelDescription.xml`.
    pub description: String,
    /// `sources/funicular_model.c`.
    pub source: String,
    /// Robot file of the unit.
    pub robot: String,
    /// Sentences that the user should know.
    pub warnings: Vec<String>,
}

/// Signal as the description has it.
struct UnitSignal {
    name: String,
    unit: &'static str,
    start: f64,
    reference: usize,
    follows_at_once: bool,
}

#[derive(Template)]
#[template(path = "fmu_robot2.xml", escape = "html")]
struct DescriptionTwo<'a>(&'a DescriptionOfRobot);

#[derive(Template)]
#[template(path = "fmu_robot3.xml", escape = "html")]
struct DescriptionThree<'a>(&'a DescriptionOfRobot);

struct DescriptionOfRobot {
    name: String,
    guid: String,
    version: &'static str,
    identifier: &'static str,
    units: BTreeSet<&'static str>,
    inputs: Vec<UnitSignal>,
    outputs: Vec<UnitSignal>,
}

#[derive(Template)]
#[template(path = "fmu_robot.c", escape = "none")]
struct RobotSource {
    comment_name: String,
    identifier: &'static str,
    guid: String,
    inputs: usize,
    outputs: usize,
    robot: Vec<u8>,
    lengths: Vec<f64>,
    pose: [f64; 7],
    tolerance: f64,
}

/// Writes description and source of the unit of a request.
///
/// # Errors
/// Loads or an option that the unit cannot have, no equilibrium, or a robot that is not simulated.
pub fn of_request(request: &ExportRequest, version: FmiVersion) -> Result<RobotUnit> {
    let text = robot_text(request)?;
    let file = text.read()?;
    let at_rest = at_rest::equilibrium(file.robot, &request.robot, &request.state, &request.tensions)?;
    let tolerance = request.tolerance_m.unwrap_or(SimulationSettings::TOLERANCE);
    let [least, most] = SimulationSettings::TOLERANCES;
    if !(least..=most).contains(&tolerance) {
        bail!("⟪tolerance_m⟫ is {tolerance} m: give {least} to {most} m");
    }
    let settings = SimulationSettings { tolerance, ..SimulationSettings::default() };
    let vibrating = at_rest.vibrating();
    let mut simulation = SteppedSimulation::new(&vibrating.robot, &vibrating.equilibrium, &[], &settings)
        .context("a unit has the robot in motion")?;
    texts(&at_rest, &StepSignals::of(&mut simulation), file.text, tolerance, version)
}

/// Text of the robot with all changes of the request, as the library in the unit reads it.
fn robot_text(request: &ExportRequest) -> Result<RobotText> {
    let load = &request.state.load;
    let loads = [
        ("force_n", load.force_n.is_some()),
        ("moment_n_m", load.moment_n_m.is_some()),
        ("load_point_m", load.load_point_m.is_some()),
        ("wind_m_s", load.wind_m_s.is_some()),
        ("cable_load_n_per_m", load.cable_load_n_per_m.is_some()),
    ];
    if let Some((key, _)) = loads.iter().find(|(_, is_given)| *is_given) {
        bail!(
            "a unit has the loads of its robot file, and inputs for more: leave out ⟪{key}⟫, or write it into the file"
        );
    }
    let mut text = request.robot.clone();
    if let Some(mass) = request.state.mass_kg {
        text.set.push(Change { path: "platform.mass_kg".to_owned(), value: mass.into() });
    }
    Ok(text)
}

fn texts(
    at_rest: &AtRest,
    signals: &StepSignals,
    robot: String,
    tolerance: f64,
    version: FmiVersion,
) -> Result<RobotUnit> {
    let mut warnings: Vec<String> = at_rest.implausible().collect();
    let all = signals.inputs.iter().chain(&signals.outputs);
    let written = names("signal", all.clone().map(|of| of.name.as_str()), &[], &mut warnings);
    let unit_signal = |(reference, (of, name)): (usize, (&StepSignal, String))| {
        let StepSignal { unit, start, follows_at_once, .. } = *of;
        UnitSignal { name, unit, start, reference, follows_at_once }
    };
    let mut inputs: Vec<UnitSignal> = all.zip(written).enumerate().map(unit_signal).collect();
    let outputs = inputs.split_off(signals.inputs.len());

    let pose = &at_rest.equilibrium.pose;
    let (p, q) = (&pose.position_w, pose.rot_wp.quaternion());
    let pose = [p.x, p.y, p.z, q.w, q.i, q.j, q.k];
    let lengths: Vec<f64> = at_rest.equilibrium.cables.iter().map(|cable| cable.unstrained_length).collect();
    let numbers = lengths.iter().chain(&pose).chain([&tolerance]).flat_map(|value| value.to_le_bytes());
    let bytes: Vec<u8> = robot.bytes().chain(numbers).chain(env!("CARGO_PKG_VERSION").bytes()).collect();
    let guid = mark(&bytes);

    let name = &at_rest.robot.name;
    let source = RobotSource {
        comment_name: in_comment(name).replace("*/", "* /"),
        identifier: IDENTIFIER,
        guid: guid.clone(),
        inputs: inputs.len(),
        outputs: outputs.len(),
        robot: robot.bytes().collect(),
        lengths,
        pose,
        tolerance,
    };
    let description = DescriptionOfRobot {
        name: names("robot", std::iter::once(name.as_str()), &[], &mut Vec::new()).remove(0),
        guid,
        version: env!("CARGO_PKG_VERSION"),
        identifier: IDENTIFIER,
        units: inputs.iter().chain(&outputs).map(|signal| signal.unit).collect(),
        inputs,
        outputs,
    };
    let description = match version {
        FmiVersion::Two => DescriptionTwo(&description).render()?,
        FmiVersion::Three => DescriptionThree(&description).render()?,
    };
    Ok(RobotUnit { description: description + "\n", source: source.render()? + "\n", robot, warnings })
}

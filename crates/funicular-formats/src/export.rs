//! Export of a robot at equilibrium to files of other programs; docs/export.md describes the content of each file.

pub(crate) mod chain;
mod firmware;
mod links;
pub(crate) mod moordyn;
mod mujoco;
pub(crate) mod opensees;
mod springs;
pub(crate) mod support;
pub(crate) mod vtk;
pub(crate) mod xml_text;

use anyhow::{Result, bail};
use funicular::cable::CableModel;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::modes::{self, LowestError, Modes};
use funicular::robot::Robot;
use funicular::statics::StaticModel;
use funicular_study::at_rest::{self, AtRest};
use funicular_study::request;
use funicular_study::values::positive;

pub use funicular_study::names::ExportFormat;

/// Maximum number of modes in a file: each mode is a field of the whole robot, or a row of a table.
const MAX_MODES: usize = 500;

/// File for another program.
#[derive(Debug, Clone, PartialEq)]
pub struct Exported {
    /// Text of the file.
    pub text: String,
    /// Caveats about the file, one sentence each.
    pub warnings: Vec<String>,
}

/// Maximum number of elements per cable.
const MAX_SEGMENTS: usize = 1000;

/// Numbers of pieces of a cable in MuJoCo: one has no mass, and a hundred of eight cables take a step of a millisecond.
const CABLE_PIECES: std::ops::RangeInclusive<usize> = 2..=100;

/// Writes the robot of a request as a file of another program, at its equilibrium.
///
/// # Errors
/// Those of [`run`], or no equilibrium.
pub fn of_request(robot: Robot, request: &request::ExportRequest) -> Result<Exported> {
    refuse(request)?;
    if request.to.is_length_table() {
        return firmware::of_request(&robot, request);
    }
    run(&at_rest::equilibrium(robot, &request.robot, &request.state, &request.tensions)?, request)
}

/// Writes the robot at equilibrium as a file of another program.
///
/// # Errors
/// A request that the file format cannot hold, a slack cable, or no equilibrium with catenaries.
pub fn run(at_rest: &AtRest, request: &request::ExportRequest) -> Result<Exported> {
    let request::ExportRequest { to, segments, modes_below_hz, .. } = *request;
    refuse(request)?;
    if to.is_length_table() {
        return firmware::file(&at_rest.robot, request);
    }
    let given = &at_rest.equilibrium;
    let straight = has_straight_cables(request).then(|| springs::at_rest(at_rest)).transpose()?;
    let at_rest = straight.as_ref().unwrap_or(at_rest);

    // Supports settle under the cables that the file has.
    let rigid = at_rest.with_rigid_supports();
    let mut warnings = Vec::new();
    if rigid.is_some() {
        warnings.push(format!(
            "files of {} have no flexible supports: anchors are fixed where they are at rest",
            to.program()
        ));
    }
    let at_rest = rigid.as_ref().unwrap_or(at_rest);
    let text = match to {
        ExportFormat::Opensees => opensees::script(at_rest, segments, modes_below_hz, &mut warnings)?,
        ExportFormat::Moordyn => match &request.scenario {
            None => moordyn::input(at_rest, segments, &mut warnings)?,
            Some(scenario) => {
                let duration = request.duration_s.unwrap_or(request::SIMULATED_S);
                moordyn::script(at_rest, scenario, duration, segments, &mut warnings)?
            }
        },
        ExportFormat::Mujoco => match request.cable_pieces {
            None => mujoco::model(at_rest, given, &mut warnings)?,
            Some(pieces) => mujoco::model_of_chains(at_rest, pieces, &mut warnings)?,
        },
        ExportFormat::Sdf => links::sdf(at_rest, given, &mut warnings)?,
        ExportFormat::Urdf => links::urdf(at_rest, given, &mut warnings)?,
        ExportFormat::Vtk => vtk::poly_data(at_rest, segments, modes_below_hz, &mut warnings)?,
        ExportFormat::C | ExportFormat::Json => unreachable!("a table of lengths is no file of one equilibrium"),
        ExportFormat::Fmu | ExportFormat::Fmu3 => bail!("a unit of {} is no text: write it to a file", to.program()),
    };
    warnings.extend(at_rest.warnings(None));
    Ok(Exported { text, warnings })
}

/// True if the file has straight springs without mass as cables.
fn has_straight_cables(request: &request::ExportRequest) -> bool {
    request.to.has_straight_cables() && request.cable_pieces.is_none()
}

/// Refuses a request that no file can hold, before any computation.
///
/// # Errors
/// The option to leave out or to change.
pub fn refuse(request: &request::ExportRequest) -> Result<()> {
    let model = request.state.static_model;
    if request.cable_pieces.is_some() && request.to != ExportFormat::Mujoco {
        bail!("⟪cable_pieces⟫ is for MuJoCo: for {} leave it out", request.to.program());
    }
    firmware::refuse(request)?;
    if request.to.is_length_table() {
        if model == StaticModel::Ideal {
            bail!(
                "ideal cables are as long as they are straight, and there is nothing to correct: leave out \
                 ⟪static_model⟫"
            );
        }
    } else if has_straight_cables(request) {
        if model == StaticModel::Ideal {
            bail!("ideal cables have no stiffness, which {} needs: leave out ⟪static_model⟫", request.to.program());
        }
    } else if model != StaticModel::Catenary {
        bail!(
            "export writes cables for {} with the catenary model only: leave out ⟪static_model⟫",
            request.to.program()
        );
    }
    if !request.to.has_modes() && request.modes_below_hz.is_some() {
        bail!("{} has no modes: leave out ⟪modes_below_hz⟫", request.to.program());
    }
    match (&request.scenario, request.to) {
        (Some(scenario), ExportFormat::Moordyn) => moordyn::refuse_scenario(scenario)?,
        (Some(_), to) => bail!("a file of {} has no events: leave out ⟪scenario⟫, or export to MoorDyn", to.program()),
        (None, _) if request.duration_s.is_some() => bail!("⟪duration_s⟫ is the time of a ⟪scenario⟫: leave it out"),
        (None, _) => {}
    }
    request::check("duration_s", request.duration_s, positive)?;
    if !(1..=MAX_SEGMENTS).contains(&request.segments) {
        bail!("⟪segments⟫: {} is not a number of elements from 1 to {MAX_SEGMENTS}", request.segments);
    }
    if let Some(pieces) = request.cable_pieces.filter(|pieces| !CABLE_PIECES.contains(pieces)) {
        bail!(
            "⟪cable_pieces⟫: {pieces} is not a number of pieces from {} to {}",
            CABLE_PIECES.start(),
            CABLE_PIECES.end()
        );
    }
    request::check("modes_below_hz", request.modes_below_hz, positive)
}

/// Finds all modes with the model catenary-dynamic below a frequency [Hz].
fn modes_below(at_rest: &AtRest, below_hz: f64, warnings: &mut Vec<String>) -> Result<(Dynamics, Modes)> {
    let linearisation = Linearisation { cable_model: CableModel::CatenaryDynamic, ..Linearisation::default() };
    let dynamics = Dynamics::about(&at_rest.robot, &at_rest.equilibrium, linearisation, below_hz)?;
    modes::check_count(&dynamics, below_hz, MAX_MODES)?;
    let found = modes::below(&dynamics, below_hz);
    warnings.extend(found.caveat());
    Ok((dynamics, found))
}

/// Finds the lowest natural frequencies with the model catenary-dynamic [Hz]: `count` of them, or fewer if there are
/// fewer.
fn first_frequencies(at_rest: &AtRest, count: usize, warnings: &mut Vec<String>) -> Result<Vec<f64>> {
    // Upper limit of the search. A robot has fewer modes than requested only if its cables are massless; the modes that
    // it does have are far below this limit.
    const MAX_HZ: f64 = 1e4;
    let lowest = |count| {
        let AtRest { robot, equilibrium, .. } = at_rest;
        modes::lowest(robot, equilibrium, Linearisation::default(), count, MAX_HZ)
    };
    let (_, list) = match lowest(count) {
        // A cable without tension keeps its own error, which reports that there is no solution.
        Err(LowestError::Dynamics(error)) => return Err(error.into()),
        Err(LowestError::TooFew { found, .. }) => lowest(found)?,
        Ok(found) => found,
    };
    warnings.extend(list.caveat());
    Ok(list.modes.iter().take(count).map(|mode| mode.frequency_hz).collect())
}

/// Puts a text of the user on one line, for titles and comments.
fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

//! The robot at rest as files of other programs; docs/export.md says what each file holds.

pub(crate) mod chain;
pub(crate) mod moordyn;
pub(crate) mod opensees;
pub(crate) mod vtk;

use crate::at_rest::AtRest;
use crate::names::Named;
use crate::request;
use anyhow::{Result, bail};
use funicular::cable::CableModel;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::modes::{self, LowestError, Modes};
use funicular::statics::StaticModel;

/// Most modes that a file takes: each is a field of the whole robot, or a row of a table.
const MAX_MODES: usize = 500;

/// Programs that files are written for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExportFormat {
    /// Python script for OpenSeesPy.
    Opensees,
    /// MoorDyn input file of version 2.
    Moordyn,
    /// VTK XML of polylines and polygons (.vtp), for ParaView.
    Vtk,
}

impl Named for ExportFormat {
    const WHAT: &'static str = "format of export";
    const ALL: &'static [Self] = &[Self::Opensees, Self::Moordyn, Self::Vtk];

    fn name(self) -> &'static str {
        match self {
            Self::Opensees => "opensees",
            Self::Moordyn => "moordyn",
            Self::Vtk => "vtk",
        }
    }
}

/// A file for another program.
#[derive(Debug, Clone, PartialEq)]
pub struct Exported {
    /// The file.
    pub text: String,
    /// Sentences that the user should know before trusting it.
    pub warnings: Vec<String>,
}

/// Maximum number of elements of a cable.
pub const MAX_SEGMENTS: usize = 1000;

/// The robot at rest as a file of another program.
///
/// # Errors
/// A request that the program's files cannot answer, a slack cable, or no equilibrium of the catenary.
pub fn run(at_rest: &AtRest, request: &request::ExportRequest) -> Result<Exported> {
    let request::ExportRequest { to, segments, modes_below_hz, .. } = *request;
    refuse(request)?;
    let mut warnings = Vec::new();
    let text = match to {
        ExportFormat::Opensees => opensees::script(at_rest, segments, modes_below_hz, &mut warnings)?,
        ExportFormat::Moordyn => moordyn::input(at_rest, segments)?,
        ExportFormat::Vtk => vtk::poly_data(at_rest, segments, modes_below_hz, &mut warnings)?,
    };
    warnings.extend(at_rest.warnings(None));
    Ok(Exported { text, warnings })
}

/// Refuses a request that no file can answer, before any work.
///
/// # Errors
/// What to leave out or to change.
pub fn refuse(request: &request::ExportRequest) -> Result<()> {
    if request.state.static_model != StaticModel::Catenary {
        bail!("export writes cables that hang: leave out ⟪static_model⟫");
    }
    if request.to == ExportFormat::Moordyn && request.modes_below_hz.is_some() {
        bail!("MoorDyn has no modes: leave out ⟪modes_below_hz⟫");
    }
    if !(1..=MAX_SEGMENTS).contains(&request.segments) {
        bail!("⟪segments⟫: {} is not a number of elements from 1 to {MAX_SEGMENTS}", request.segments);
    }
    if let Some(limit) = request.modes_below_hz {
        request::check_positive("modes_below_hz", limit)?;
    }
    Ok(())
}

/// All modes of catenary-dynamic cables below a frequency [Hz].
fn modes_below(at_rest: &AtRest, below_hz: f64, warnings: &mut Vec<String>) -> Result<(Dynamics, Modes)> {
    let linearisation = Linearisation { cable_model: CableModel::CatenaryDynamic, ..Linearisation::default() };
    let dynamics = Dynamics::about(&at_rest.robot, &at_rest.equilibrium, linearisation, below_hz)?;
    modes::check_count(&dynamics, below_hz, MAX_MODES)?;
    let found = modes::below(&dynamics, below_hz);
    warnings.extend(found.caveat());
    Ok((dynamics, found))
}

/// The lowest natural frequencies of catenary-dynamic cables [Hz], and no more of them than there are.
fn first_frequencies(at_rest: &AtRest, count: usize, warnings: &mut Vec<String>) -> Result<Vec<f64>> {
    // A robot has fewer modes than requested only if its cables are massless; those that it has are not far up.
    const MAX_HZ: f64 = 1e4;
    let lowest = |count| {
        let AtRest { robot, equilibrium, .. } = at_rest;
        modes::lowest(robot, equilibrium, Linearisation::default(), count, MAX_HZ)
    };
    let (_, list) = match lowest(count) {
        // A cable without tension keeps its own error, which says that there is no solution.
        Err(LowestError::Dynamics(error)) => return Err(error.into()),
        Err(LowestError::TooFew { found, .. }) => lowest(found)?,
        Ok(found) => found,
    };
    warnings.extend(list.caveat());
    Ok(list.modes.iter().take(count).map(|mode| mode.frequency_hz).collect())
}

/// A text of the user on one line, for titles and comments.
fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

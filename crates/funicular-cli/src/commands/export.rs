//! `export`: the robot at its equilibrium as a file of another program.

use super::simulate;
use crate::args::{Cli, ExportArgs};
use crate::errors;
use crate::output::{Content, Target};
use anyhow::Result;
use funicular::robot::Robot;
use funicular_files::Guard;
use funicular_files::endings::Kind;
use funicular_formats::export::{self, ExportFormat};
use funicular_study::request::{ExportRequest, Request};
use serde_json::{Map, Value};
use std::path::Path;

/// Request of an export. Errors of its scenario name the file.
pub(super) fn request(cli: &Cli, further: Map<String, Value>) -> Result<Request> {
    let mut request = cli.request(further)?;
    let files = cli.files::<ExportArgs>()?;
    if let (Request::Export(of), Some(path)) = (&mut request, &files.scenario) {
        of.scenario = Some(simulate::scenario(path)?);
    }
    Ok(request)
}

/// Writes the robot at its equilibrium as a file of another program.
pub(super) fn run(of: &ExportRequest, args: &ExportArgs, guard: &mut Guard) -> Result<()> {
    if let Some(path) = &args.scenario {
        guard.reads("the scenario", path);
    }
    let robot = of.robot.read()?.robot;
    write(of, robot, guard, &args.to.output_file)
}

/// Writes the file of an exported robot.
pub(super) fn write(of: &ExportRequest, robot: Robot, guard: &mut Guard, path: &Path) -> Result<()> {
    let (in_words, fitting): (_, &[Kind]) = match of.to {
        ExportFormat::Opensees => ("a Python script for OpenSees", &[Kind::Python]),
        ExportFormat::Moordyn if of.scenario.is_some() => ("a Python script for MoorDyn", &[Kind::Python]),
        ExportFormat::Moordyn => ("an input file of MoorDyn", &[Kind::Text]),
        ExportFormat::Mujoco => ("a model of MuJoCo", &[Kind::Xml]),
        ExportFormat::Sdf => ("a world of Gazebo", &[Kind::Sdf]),
        ExportFormat::Urdf => ("a robot in URDF", &[Kind::Urdf]),
        ExportFormat::Vtk => ("curves and polygons of VTK", &[Kind::Vtp]),
        ExportFormat::C => ("C source", &[Kind::C]),
        ExportFormat::Json => ("a table of lengths in JSON", &[Kind::Json]),
    };
    let content = Content { name: "the exported robot", in_words, fitting };
    let target = Target::open(Some(path), content, guard)?;
    export::refuse(of)?;
    let exported = export::of_request(robot, of)?;
    target.write(exported.text.as_bytes())?;
    if target.is_file() {
        errors::note(&format!("wrote {}", path.display()));
    }
    exported.warnings.iter().for_each(|warning| errors::warn(warning));
    Ok(())
}

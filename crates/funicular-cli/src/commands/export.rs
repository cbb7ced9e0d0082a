//! `export`: the robot at its state as a file of another program.

use crate::args::{ExportArgs, ExportFormat, StaticModelName};
use crate::errors;
use crate::export::{moordyn, opensees, vtk};
use crate::output::{Content, Target};
use crate::{robot_file, state};
use anyhow::{Result, bail};
use funicular_files::endings::Kind;

pub(crate) fn run(args: &ExportArgs) -> Result<()> {
    let file = robot_file::read(Some(&args.robot.robot), &args.robot.changes)?;
    let (in_words, fitting): (_, &[Kind]) = match args.to {
        ExportFormat::Opensees => ("a Python script for OpenSees", &[Kind::Python]),
        ExportFormat::Moordyn => ("an input file of MoorDyn", &[Kind::Text]),
        ExportFormat::Vtk => ("curves and polygons of VTK", &[Kind::Vtp]),
    };
    let content = Content { name: "the exported robot", option: "-o", in_words, fitting };
    let target = Target::open(Some(&args.output_file), content, &mut robot_file::guard(Some(&args.robot.robot)))?;
    if !matches!(args.state.static_model, StaticModelName::Catenary) {
        bail!("export writes cables that hang: leave out --static-model");
    }
    if args.to == ExportFormat::Moordyn && args.modes_below_hz.is_some() {
        bail!("MoorDyn has no modes: leave out --modes-below-hz");
    }
    let (at_rest, _) = state::equilibrium_with(file.robot, &args.state, &args.tensions)?;
    let segments = args.segments as usize;
    let text = match args.to {
        ExportFormat::Opensees => opensees::script(&at_rest, segments, args.modes_below_hz)?,
        ExportFormat::Moordyn => moordyn::input(&at_rest, segments)?,
        ExportFormat::Vtk => vtk::poly_data(&at_rest, segments, args.modes_below_hz)?,
    };
    target.write(text.as_bytes())?;
    if target.is_file() {
        errors::note(&format!("wrote {}", args.output_file.display()));
    }
    at_rest.warnings(None).iter().for_each(|warning| errors::warn(warning));
    Ok(())
}

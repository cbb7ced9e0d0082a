//! `export`: the robot at its state as a file of another program.

use crate::args::{ExportArgs, ExportFormat, StaticModelName};
use crate::errors;
use crate::export::{moordyn, opensees, vtk};
use crate::output::Target;
use crate::{robot_file, state};
use anyhow::{Result, bail};

pub(crate) fn run(args: &ExportArgs) -> Result<()> {
    let file = robot_file::read(Some(&args.robot.robot), &args.robot.changes)?;
    let target = Target::open(Some(&args.output_file), Some(&args.robot.robot))?;
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

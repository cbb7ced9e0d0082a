//! Options of `export`.

use super::{RobotArgs, StateArgs, TensionArgs, values};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct ExportArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgs,

    /// Program that the file is for
    #[arg(long, value_name = "PROGRAM", value_enum)]
    pub(crate) to: ExportFormat,

    /// Elements per cable, 1 to 1000: bars in OpenSees, segments in MoorDyn, pieces of a curve in VTK
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1000), allow_hyphen_values = true, default_value = "20")]
    pub(crate) segments: u64,

    /// Upper limit of the frequencies of modes in the file [Hz]: in VTK one field per mode, in OpenSees the modes to
    /// compare with [default: no modes in VTK, the first ten in OpenSees]
    #[arg(long, value_name = "HZ", value_parser = values::positive, allow_hyphen_values = true)]
    pub(crate) modes_below_hz: Option<f64>,

    #[command(flatten)]
    pub(crate) state: StateArgs,
    #[command(flatten)]
    pub(crate) tensions: TensionArgs,

    /// Write to FILE, completely or not at all; - is standard output
    #[arg(short, long, value_name = "FILE", default_value = "-", help_heading = "Output")]
    pub(crate) output_file: PathBuf,
}

/// Program that files are written for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ExportFormat {
    /// Python script for OpenSeesPy
    Opensees,
    /// Input file of version 2
    Moordyn,
    /// VTK XML of polylines and polygons (.vtp), for ParaView
    Vtk,
}

//! Arguments of the commands that write a page about a robot.

use super::groups::{LinearisedArgs, OptionalRobotArgs, PointArgs, ShareArgs};
use super::values::{self};
use clap::Args;
use funicular_study::signals::{Input, Output};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct ReportArgs {
    #[command(flatten)]
    pub(crate) robot: OptionalRobotArgs,

    /// Upper limit of the frequencies [Hz]
    #[arg(long, value_name = "HZ", value_parser = values::positive, allow_hyphen_values = true, default_value = "20")]
    pub(crate) below_hz: f64,

    /// Input of the frequency response: fx … mz, or f:ux,uy,uz, m:ux,uy,uz, see `funicular frf` [default: fz; fx if the
    /// platform cannot move along z]
    #[arg(long, value_name = "INPUT", value_parser = Input::parse)]
    pub(crate) input: Option<Input>,

    /// Output of the frequency response: x … arz, or x:ux,uy,uz, v:…, a:…, see `funicular frf` [default: az; ax if the
    /// platform cannot move along z]
    #[arg(long, value_name = "OUTPUT", value_parser = Output::parse)]
    pub(crate) output: Option<Output>,
    #[command(flatten)]
    pub(crate) points: PointArgs,

    #[command(flatten)]
    pub(crate) share: ShareArgs,

    #[command(flatten)]
    pub(crate) linearised: LinearisedArgs,

    /// Write the page to FILE, completely or not at all; - is standard output
    #[arg(short, long, value_name = "FILE", default_value = "funicular-report.html", help_heading = "Output")]
    pub(crate) output_file: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct LiveArgs {
    #[command(flatten)]
    pub(crate) robot: OptionalRobotArgs,
    #[command(flatten)]
    pub(crate) linearised: LinearisedArgs,

    /// Write the page to FILE, completely or not at all; - is standard output
    #[arg(short, long, value_name = "FILE", default_value = "funicular-live.html", help_heading = "Output")]
    pub(crate) output_file: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct PaperArgs {
    /// Write the page to FILE, completely or not at all; - is standard output
    #[arg(short, long, value_name = "FILE", default_value = "funicular-paper.html")]
    pub(crate) output_file: PathBuf,
}

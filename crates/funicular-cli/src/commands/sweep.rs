//! `sweep`: its run.

use crate::args::SweepArgs;
use crate::{robot_file, sweep_run};
use anyhow::Result;
use funicular_study::request::Request;

/// Computes the rows of a sweep.
pub(super) fn run(request: &Request, args: &SweepArgs) -> Result<()> {
    sweep_run::run(request, &mut robot_file::guard(Some(&args.robot.robot)), &args.run)
}

//! `map`: its request and its run.

use crate::args::{Cli, MapArgs};
use crate::{pose_csv, sweep_run};
use anyhow::Result;
use funicular_files::Guard;
use funicular_study::request::Request;
use serde_json::{Map, Value};

/// Request of a map. Errors of its poses name the line in the file of poses.
pub(super) fn request(cli: &Cli, further: Map<String, Value>) -> Result<Request> {
    let mut request = cli.request(further)?;
    if let Request::Map(of) = &mut request {
        of.poses = pose_csv::read_if_given(cli.files::<MapArgs>()?.poses.as_deref(), &of.robot)?;
    }
    Ok(request)
}

/// Computes the rows of a map.
pub(super) fn run(request: &Request, args: &MapArgs, guard: &mut Guard) -> Result<()> {
    if let Some(poses) = &args.poses {
        guard.reads("the poses", poses);
    }
    sweep_run::run(request, guard, &args.run)
}

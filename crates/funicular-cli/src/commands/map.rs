//! `map`: its request and its run.

use crate::args::MapArgs;
use crate::{pose_csv, robot_file, sweep_run};
use anyhow::Result;
use funicular_study::request::{MapRequest, Request, RobotText};

/// Request of a map. Errors of its poses name the line in the file of poses.
pub(super) fn request(args: &MapArgs, robot: RobotText) -> Result<MapRequest> {
    let poses = pose_csv::read_if_given(args.poses.as_deref(), &robot)?;
    Ok(args.request(robot, poses))
}

/// Computes the rows of a map.
pub(super) fn run(request: &Request, args: &MapArgs) -> Result<()> {
    let mut guard = robot_file::guard(Some(&args.robot.robot));
    if let Some(poses) = &args.poses {
        guard.reads("the poses", poses);
    }
    sweep_run::run(request, &mut guard, &args.run)
}

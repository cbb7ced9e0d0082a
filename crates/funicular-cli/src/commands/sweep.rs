//! `sweep`: quantities over values of the robot file.

use crate::args::SweepArgs;
use crate::robot_file;
use crate::sweeping::{self, Job};
use anyhow::{Result, anyhow, bail};
use funicular::robot::State;
use funicular_files::{Grid, Source, Variations};

pub(crate) fn run(args: &SweepArgs) -> Result<()> {
    let file = robot_file::read(Some(&args.robot.robot), &args.robot.changes)?;
    let adjust = Box::new(|robot| sweeping::adjusted(robot, &args.point).map_err(|error| format!("{error:#}")));
    let points =
        Variations::new(file.text.clone(), args.vary.clone(), "--vary", adjust).map_err(|error| anyhow!("{error}"))?;
    let robot = points.first().map_err(|error| anyhow!("{error}"))?;
    if robot.state == State::Unknown {
        bail!(
            "the robot has no state: give --lengths-m or --pose, or give every cable of the robot file an \
             `unstrained_length_m`, or the file a [state] with `position_m`"
        );
    }
    let axes = Grid(points.axes().iter().map(|axis| (axis.path.text.clone(), axis.steps.clone())).collect());
    sweeping::run(&Job {
        command: "sweep",
        robot: &robot,
        robot_file: file.text,
        robot_path: &args.robot.robot,
        poses_path: None,
        points: &points,
        source: Source::Values(&axes),
        point: &args.point,
        run: &args.run,
    })
}

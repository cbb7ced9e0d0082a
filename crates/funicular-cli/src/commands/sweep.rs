//! `sweep`: quantities over values of the robot file.

use crate::args::SweepArgs;
use crate::robot_file;
use crate::state;
use crate::sweeping::{self, Job};
use anyhow::{Result, anyhow, bail};
use funicular::robot::{Robot, State};
use funicular_files::{Grid, Source, Variations};

pub(crate) fn run(args: &SweepArgs) -> Result<()> {
    let file = robot_file::read(Some(&args.robot.robot), &args.robot.changes)?;
    let as_asked = |robot: Robot| {
        let robot = state::with_options(robot, &args.state)?;
        state::with_limits(&robot, &args.tensions)
    };
    let adjust = Box::new(|robot| as_asked(robot).map_err(|error| format!("{error:#}")));
    let points =
        Variations::new(file.text.clone(), args.vary.clone(), "--vary", adjust).map_err(|error| anyhow!("{error}"))?;
    let robot = points.first().map_err(|error| anyhow!("{error}"))?;
    if robot.state == State::Unknown {
        bail!(
            "the robot has no state: give --lengths-m or --pose, or give every cable of the robot file an \
             `unstrained_length_m`, or the file a [state] with `position_m`"
        );
    }
    let options = sweeping::options(&robot, &args.state, &args.tensions, &args.model, &args.what)?;
    let axes = Grid(points.axes().iter().map(|axis| (axis.path.text.clone(), axis.steps.clone())).collect());
    sweeping::run(&Job {
        command: "sweep",
        robot: &robot,
        robot_path: &args.robot.robot,
        robot_file: file.text,
        points: &points,
        source: Source::Values(&axes),
        asked: sweeping::asked(&options, &args.state, &args.tensions, &args.what.quantity),
        run: &args.run,
    })
}

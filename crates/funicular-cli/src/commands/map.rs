//! `map`: quantities over poses.

use crate::args::MapArgs;
use crate::poses;
use crate::robot_file;
use crate::sweeping::{self, Job};
use anyhow::{Context, Result};
use funicular::robot::{Pose, Robot, State};
use funicular::statics;
use funicular::sweep::Poses;
use funicular_files::Source;

pub(crate) fn run(args: &MapArgs) -> Result<()> {
    let file = robot_file::read(Some(&args.robot.robot), &args.robot.changes)?;
    let robot = sweeping::adjusted(file.robot, &args.point)?;
    let (listed, base);
    let points;
    let source = if let Some(path) = &args.poses {
        listed = poses::read(path, &robot)?;
        points = Poses::list(robot.clone(), listed.clone());
        Source::List(&listed)
    } else {
        base = self::base(&robot, args)?;
        points = Poses::grid(robot.clone(), &args.grid, base.as_ref())?;
        Source::Grid { poses: &points, base: base.as_ref() }
    };
    sweeping::run(&Job {
        command: "map",
        robot: &robot,
        robot_file: file.text,
        robot_path: &args.robot.robot,
        poses_path: args.poses.as_deref(),
        points: &points,
        source,
        point: &args.point,
        run: &args.run,
    })
}

/// Where the axes stay that the grid does not have: the pose of the options, or of the robot's state.
fn base(robot: &Robot, args: &MapArgs) -> Result<Option<Pose>> {
    Ok(match &robot.state {
        State::Pose(pose) => Some(*pose),
        State::Unknown => None,
        State::Lengths(lengths) => {
            let rest = statics::forward(robot, lengths, args.point.state.static_model.into(), None).context(
                "axes that the grid does not have are those of the robot's state, which gives none; give --pose",
            )?;
            Some(rest.pose)
        }
    })
}

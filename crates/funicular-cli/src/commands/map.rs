//! `map`: quantities over poses.

use crate::args::MapArgs;
use crate::robot_file;
use crate::state;
use crate::sweeping::{self, Job};
use anyhow::{Context, Result, bail};
use funicular::robot::{Freedoms, Pose, Robot, State};
use funicular::statics;
use funicular::sweep::Poses;
use funicular_files::Source;
use std::fs::File;
use std::path::Path;

pub(crate) fn run(args: &MapArgs) -> Result<()> {
    let file = robot_file::read(Some(&args.robot.robot), &args.robot.changes)?;
    let robot = state::with_limits(&state::with_options(file.robot, &args.state)?, &args.tensions)?;
    let options = sweeping::options(&robot, &args.state, &args.tensions, &args.model, &args.what)?;
    let (listed, base);
    let points;
    let source = if let Some(path) = &args.poses {
        listed = read_poses(path, &robot)?;
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
        robot_path: &args.robot.robot,
        robot_file: file.text,
        points: &points,
        source,
        asked: sweeping::asked(&options, &args.state, &args.tensions, &args.what.quantity),
        run: &args.run,
    })
}

/// Where the axes stay that the grid does not have: the pose of the options, or of the robot's state.
fn base(robot: &Robot, args: &MapArgs) -> Result<Option<Pose>> {
    Ok(match &robot.state {
        State::Pose(pose) => Some(*pose),
        State::Unknown => None,
        State::Lengths(lengths) => {
            let rest = statics::forward(robot, lengths, args.state.static_model.into(), None).context(
                "axes that the grid does not have are those of the robot's state, which gives none; give --pose",
            )?;
            Some(rest.pose)
        }
    })
}

/// The columns of a file of poses; all others are left alone.
const COLUMNS: [&str; 6] = ["x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg"];

fn read_poses(path: &Path, robot: &Robot) -> Result<Vec<[f64; 6]>> {
    let shown = path.display();
    let file = File::open(path).with_context(|| format!("cannot read the poses {shown}"))?;
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(file);
    let header = reader.headers().with_context(|| format!("cannot read the poses {shown}"))?.clone();
    let places = COLUMNS.map(|column| header.iter().position(|name| name.trim_start_matches('\u{feff}') == column));
    if let Some(missing) = (0..3).find(|&i| places[i].is_none()) {
        bail!(
            "{shown} has no column `{}`: the first line names x_m, y_m, z_m and, if wanted, roll_deg, pitch_deg, yaw_deg",
            COLUMNS[missing]
        );
    }
    let mut poses = Vec::new();
    for record in reader.records() {
        let record = record.with_context(|| format!("cannot read the poses {shown}"))?;
        let line = record.position().map_or(0, csv::Position::line);
        let mut pose = [0.0; 6];
        for ((value, place), column) in pose.iter_mut().zip(places).zip(COLUMNS) {
            let Some(place) = place else { continue };
            let text = record.get(place).unwrap_or_default();
            *value = crate::args::values::finite(text)
                .map_err(|reason| anyhow::anyhow!("{shown}, line {line}, column `{column}`: {reason}"))?;
        }
        if robot.platform.freedoms == Freedoms::PointMass && pose[3..].iter().any(|angle| *angle != 0.0) {
            bail!("{shown}, line {line}: a point mass has no orientation; leave out the angles");
        }
        poses.push(pose);
    }
    Ok(poses)
}

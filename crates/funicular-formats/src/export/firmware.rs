//! Export of unstrained lengths over a box of poses for firmware: polynomials that correct the lengths of straight
//! cables, as a C99 file and in JSON.

mod c;
mod json;

use super::{Exported, one_line};
use anyhow::{Result, anyhow, bail};
use funicular::length_table::{BoxSide, LengthTable, LengthTableError, PoseBox, length_table};
use funicular::robot::{PlatformMotion, Pose, Robot, State};
use funicular::statics::{self, TensionRule};
use funicular::warnings;
use funicular_study::NoSolution;
use funicular_study::at_rest::{self, check_pose};
use funicular_study::names::ExportFormat;
use funicular_study::request::{Axis, ExportRequest, Steps, TABLE_TOLERANCE_M};
use funicular_study::sweep::AXES;

/// Narrowest range of a coordinate [m, degrees].
const MIN_WIDTH: f64 = 1e-6;

/// Largest angle [degrees].
const MAX_ANGLE_DEG: f64 = 360.0;

/// Number of poses at which the file tests itself.
const SELF_TESTS: usize = 20;

/// Beginning of the points of the self-test in the sequence of which the errors take the first thousand.
const FIRST_SELF_TEST: usize = 5000;

/// Longest beginning of the names in a C file.
const MAX_PREFIX: usize = 40;

/// Refuses what no table of lengths can have, and keys of tables for other programs.
///
/// # Errors
/// The option to leave out or to change.
pub(super) fn refuse(request: &ExportRequest) -> Result<()> {
    if !request.to.is_length_table() {
        let given = [
            ("within", !request.within.is_empty()),
            ("tolerance_m", request.tolerance_m.is_some() && !request.to.is_unit()),
            ("prefix", request.prefix.is_some()),
        ];
        if let Some((key, _)) = given.iter().find(|(_, given)| *given) {
            bail!("⟪{key}⟫ is for tables of lengths, C and JSON: for {} leave it out", request.to.program());
        }
        return Ok(());
    }

    if request.prefix.is_some() && request.to != ExportFormat::C {
        bail!("⟪prefix⟫ is for names in C: for {} leave it out", request.to.program());
    }
    if let Some(prefix) = &request.prefix {
        let letters = prefix.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        if !letters || !prefix.starts_with(|c: char| c.is_ascii_alphabetic()) || prefix.len() > MAX_PREFIX {
            bail!(
                "⟪prefix⟫ {prefix:?}: names in C begin with a letter and have letters without accents, digits and \
                 underscores; give at most {MAX_PREFIX} of them"
            );
        }
    }
    if let Some(tolerance) = request.tolerance_m
        && !(tolerance > 0.0 && tolerance.is_finite())
    {
        bail!("⟪tolerance_m⟫: {tolerance} is no error that a polynomial can keep: give a positive number");
    }
    if request.within.is_empty() {
        bail!("a table of lengths needs a box of poses: give ⟪within⟫ for each coordinate that moves, as in x=-3:3");
    }
    if request.state.hold_lengths_of_pose {
        bail!("each pose of the box has its own lengths: leave out ⟪hold_lengths_of_pose⟫");
    }
    Ok(())
}

/// Writes the table of lengths of a request; the robot is that of its file.
///
/// # Errors
/// A request that contradicts itself or the robot, a box that is not wholly feasible, or a tolerance that cannot be
/// kept.
pub(super) fn of_request(robot: &Robot, request: &ExportRequest) -> Result<Exported> {
    let robot = at_rest::with_limits(&at_rest::with_state(robot.clone(), &request.state)?, &request.tensions)?;
    file(&robot, request)
}

/// Writes the table of lengths of a robot with all changes of a request.
///
/// # Errors
/// Those of [`of_request`].
pub(super) fn file(robot: &Robot, request: &ExportRequest) -> Result<Exported> {
    let pose_box = pose_box(robot, &request.within)?;
    let given = at_rest::rule(&request.tensions)?;
    let mut caveats = Vec::new();
    let rule = rule(robot, given.as_ref(), &mut caveats)?;

    // A rule without a choice is refused as everywhere, and limits that contradict before a pose of the box is.
    let centre = pose_box.pose(&pose_box.coordinates(&vec![0.0; pose_box.sides().len()]));
    let at_centre = Robot { state: State::Pose(centre), ..robot.clone() };
    let model = request.state.static_model;
    let has_choice = match statics::solve(&at_centre, model, given.as_ref().map(|_| rule.clone())) {
        Err(error) if !error.is_no_solution() => return Err(error.into()),
        Err(_) => true,
        Ok(found) => found.rule.is_some(),
    };

    let tolerance = request.tolerance_m.unwrap_or(TABLE_TOLERANCE_M);
    let table = length_table(robot, &pose_box, model, &rule, tolerance).map_err(|error| told(&error))?;
    if !has_choice {
        caveats.clear();
    }
    caveats.extend(warnings::of_robot(robot).iter().map(ToString::to_string));
    let firmware = Firmware { robot, request, table, tolerance, rule: has_choice.then(|| rule.name()) };
    let text = match request.to {
        ExportFormat::Json => json::text(&firmware)?,
        _ => c::text(&firmware)?,
    };
    Ok(Exported { text, warnings: caveats })
}

/// Error of a table: bad input if the robot or its limits contradict themselves, else no solution.
fn told(error: &LengthTableError) -> anyhow::Error {
    match error {
        LengthTableError::NotHeld { reason, .. } if !reason.is_no_solution() => anyhow!("{error}"),
        _ => NoSolution(error.to_string()).into(),
    }
}

/// Rule of the tensions: the given one, or `centre` where all cables have a maximum.
///
/// # Errors
/// A rule whose tensions jump from pose to pose.
fn rule(robot: &Robot, given: Option<&TensionRule>, caveats: &mut Vec<String>) -> Result<TensionRule> {
    if let Some(TensionRule::Middle | TensionRule::Stiffest) = given {
        bail!(
            "the rule `{}` jumps from pose to pose, and no polynomial follows a jump: take ⟪tension_rule⟫ `centre`, \
             `lowest` or `closest`",
            given.map_or("", TensionRule::name)
        );
    }
    if let Some(rule) = given {
        return Ok(rule.clone());
    }
    let Some(cable) = robot.cables.iter().find(|cable| cable.limits().maximum.is_none()) else {
        return Ok(TensionRule::Centre);
    };
    caveats.push(format!(
        "the tensions follow the rule `lowest`, because cable \"{}\" has no maximum tension: lengths have kinks where \
         a limit begins to bind, and polynomials follow them slowly; give ⟪max_tension_n⟫ for the rule `centre`",
        cable.name
    ));
    Ok(TensionRule::Lowest)
}

/// Box of poses of a request. Coordinates that it does not give are those of the pose of the state, or else no
/// rotation.
///
/// # Errors
/// An axis that is given twice or along which the platform cannot move, an empty range, a position that nothing gives,
/// or poses that the platform cannot have.
fn pose_box(robot: &Robot, within: &[Axis]) -> Result<PoseBox> {
    let mut ends: [Option<[f64; 2]>; 6] = [None; 6];
    for axis in within {
        let name = axis.name();
        let Some(k) = AXES.iter().position(|axis| *axis == name) else {
            bail!("⟪within⟫: there is no axis `{name}`: give x, y, z, roll, pitch or yaw");
        };
        if ends[k].replace(ends_of(axis)?).is_some() {
            bail!("⟪within⟫ {name}: the axis is given twice");
        }
    }

    let mut sides = Vec::new();
    for (axis, ends) in ends.iter().enumerate() {
        if let Some([from, to]) = ends.filter(|[from, to]| from < to) {
            sides.push(side(robot, axis, from, to)?);
        }
    }
    if sides.is_empty() {
        bail!(
            "⟪within⟫: no coordinate has a range, as in x=-3:3: the lengths of one pose are those of `funicular \
             statics`"
        );
    }

    let base = base_pose(robot, &ends)?;
    let mut position: [f64; 3] = base.position_w.into();
    let mut angles = [0.0; 3];
    let fixes_angles = ends[3..].iter().any(Option::is_some);
    if fixes_angles {
        angles = funicular::math::rotation::to_roll_pitch_yaw_deg(&base.rot_wp);
    }
    for (coordinate, ends) in position.iter_mut().chain(&mut angles).zip(&ends) {
        *coordinate = ends.map_or(*coordinate, |[from, _]| from);
    }
    let base = if fixes_angles {
        Pose::new(position, angles)
    } else {
        // The rotation of the state with every digit.
        Pose { position_w: position.into(), rot_wp: base.rot_wp }
    };
    let pose_box = PoseBox::new(base, sides);
    let n = pose_box.sides().len();
    for i in 0..1 << n {
        let place: Vec<f64> = (0..n).map(|k| if i >> k & 1 == 0 { -1.0 } else { 1.0 }).collect();
        check_pose(robot, &pose_box.pose(&pose_box.coordinates(&place)))
            .map_err(|error| error.context("⟪within⟫: the platform cannot have all poses of the box"))?;
    }
    Ok(pose_box)
}

/// Pose for the coordinates that a request does not give.
///
/// # Errors
/// A coordinate that neither the state nor the request gives.
fn base_pose(robot: &Robot, ends: &[Option<[f64; 2]>; 6]) -> Result<Pose> {
    if let State::Pose(pose) = &robot.state {
        return Ok(*pose);
    }
    let given = [0, 1, 2].map(|k| ends[k].map(|[from, _]| from));
    let position = match &robot.platform.motion {
        PlatformMotion::Planar(plane) => plane.point_with(given).map(Into::into),
        _ => None,
    };
    if let Some(k) = (0..3).find(|k| given[*k].is_none() && position.is_none()) {
        bail!("nothing gives the coordinate {}: give it by ⟪within⟫, or give ⟪pose⟫", AXES[k]);
    }
    Ok(Pose::new(position.unwrap_or_else(|| given.map(Option::unwrap_or_default)), [0.0; 3]))
}

/// Ends of a side; twice the same for a coordinate that is fixed.
fn ends_of(axis: &Axis) -> Result<[f64; 2]> {
    let name = axis.name();
    let steps = axis.steps().map_err(|reason| anyhow!("⟪within⟫ {name}: {reason}"))?;
    let [from, to] = match steps {
        Steps::Range { from, to, .. } => [from, to],
        Steps::List(values) => match values[..] {
            [at] => [at, at],
            [from, to] => [from, to],
            _ => bail!("⟪within⟫ {name}: a side has two ends, and {} values are given", values.len()),
        },
    };
    if from > to {
        bail!("⟪within⟫ {name}: the side begins at {from} and ends at {to}: give the smaller end first");
    }
    Ok([from, to])
}

/// Side of the box with a range.
fn side(robot: &Robot, axis: usize, from: f64, to: f64) -> Result<BoxSide> {
    let (name, motion) = (AXES[axis], &robot.platform.motion);
    if !motion.components().contains(&axis) {
        let has = motion.components().into_iter().map(|i| AXES[i]).collect::<Vec<_>>().join(", ");
        bail!("⟪within⟫ {name}: a {} platform does not move along it; it has {has}", motion.name());
    }
    if to - from < MIN_WIDTH {
        bail!("⟪within⟫ {name}: the range is narrower than {MIN_WIDTH}: give one value for a coordinate that is fixed");
    }
    if axis >= 3 && from.abs().max(to.abs()) > MAX_ANGLE_DEG {
        bail!("⟪within⟫ {name}: give angles from -{MAX_ANGLE_DEG} to {MAX_ANGLE_DEG} degrees");
    }
    Ok(BoxSide { axis, from, to })
}

/// Table with all that its file says about it.
struct Firmware<'a> {
    robot: &'a Robot,
    request: &'a ExportRequest,
    table: LengthTable,
    tolerance: f64,
    /// Name of the rule, if there was a choice.
    rule: Option<&'static str>,
}

impl Firmware<'_> {
    /// Coordinates of the poses at which a file tests itself.
    fn self_tests(&self) -> Vec<Vec<f64>> {
        let pose_box = &self.table.pose_box;
        let place = |i| funicular::math::chebyshev::even_point(pose_box.sides().len(), FIRST_SELF_TEST + i);
        (0..SELF_TESTS).map(|i| pose_box.coordinates(&place(i))).collect()
    }

    /// Checksum of the text of the robot file.
    fn checksum(&self) -> String {
        format!("{:08x}", crc32fast::hash(self.request.robot.text.as_bytes()))
    }

    /// Changes of the robot file, each as `PATH=VALUE`.
    fn changes(&self) -> Vec<String> {
        let changes = self.request.robot.set.iter();
        changes.map(|change| format!("{}={}", change.path, change.value)).collect()
    }

    fn static_model(&self) -> &'static str {
        self.request.state.static_model.name()
    }
}

/// Names of the coordinates with their units.
const COORDINATES: [&str; 6] = ["x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg"];

//! Table of readings: rows of the calibration, with the faults that a table of lengths usually has.

use super::KEY;
use crate::analyses::timed_rows::POSE;
use crate::at_rest::check_pose;
use crate::names::suggestion;
use crate::request::GappedColumns;
use crate::table_fault::TableFault;
use crate::text::significant;
use crate::values::finite;
use anyhow::{Result, bail};
use funicular::calibration::MeasuredRow;
use funicular::math::Vec3;
use funicular::robot::{PlatformMotion, Pose, Robot};

/// Maximum number of rows.
const MAX_ROWS: usize = 10_000;

/// Ratio of the middle reading to the middle length of the file from which on they cannot be the same lengths: the size
/// of a robot is known within a factor of 20, and millimetres are a factor of 1000.
const OTHER_UNIT: f64 = 20.0;

/// Checks a table of readings for a robot.
///
/// # Errors
/// The first fault: a column that is missing or unknown, no rows, a value that is none, a pose that the platform cannot
/// have, or readings in another unit.
pub fn check(columns: &GappedColumns, robot: &Robot) -> Result<(), TableFault> {
    rows(columns, robot, [false; 2]).map(drop)
}

/// Names of the columns of a cable's lengths; a table in another unit has been converted.
fn length_names(cable: &str) -> [String; 2] {
    [format!("length_{cable}_m"), format!("unstrained_length_{cable}_m")]
}

fn tension_name(cable: &str) -> String {
    format!("tension_{cable}_n")
}

/// Rows of a table; where `measured` says so, the coordinates of the platform are data, and its angles.
pub(super) fn rows(
    columns: &GappedColumns,
    robot: &Robot,
    measured: [bool; 2],
) -> Result<Vec<MeasuredRow>, TableFault> {
    let fault = |text: String| TableFault { key: KEY, row: None, text };
    check_columns(columns, robot).map_err(fault)?;
    let lengths = length_columns(columns, robot).map_err(fault)?;
    let count = count(columns, &lengths).map_err(fault)?;

    let of_row = |row: usize| {
        let fault = |text: String| TableFault { key: KEY, row: Some(row), text };
        for (name, values) in columns {
            let checked = values[row].map_or(Ok(0.0), finite);
            checked.map_err(|reason| fault(format!("`{name}`: {reason}")))?;
        }
        let value = |name: &str| columns.get(name).and_then(|values| values[row]);
        let of_pose = |first: usize| [0, 1, 2].map(|k| POSE[first + k]);
        let reading = |of: &LengthColumn| of.and_then(|values| values[row]);
        Ok(MeasuredRow {
            readings: lengths.iter().map(reading).collect(),
            position: of_pose(0).map(|name| value(name).filter(|_| measured[0])),
            angles: of_pose(3).map(|name| value(name).filter(|_| measured[1]).map(f64::to_radians)),
            tensions: robot.cables.iter().map(|cable| value(&tension_name(&cable.name))).collect(),
            start: pose(value, robot).map_err(fault)?,
        })
    };
    let rows = (0..count).map(of_row).collect::<Result<Vec<_>, TableFault>>()?;
    check_unit(&rows, robot).map_err(fault)?;
    Ok(rows)
}

/// Rows without those that a request leaves out, and before them their numbers in the table, from 1.
pub(super) fn kept(rows: Vec<MeasuredRow>, left_out: &[f64]) -> Result<(Vec<usize>, Vec<MeasuredRow>)> {
    let count = rows.len();
    let is_row = |number: f64| number.fract() == 0.0 && (1.0..=count as f64).contains(&number);
    if let Some(wrong) = left_out.iter().find(|number| !is_row(**number)) {
        bail!("⟪leave_out⟫ {wrong}: there is no such row: give numbers from 1 to {count}");
    }
    let numbered = rows.into_iter().enumerate().map(|(j, row)| (j + 1, row));
    let kept = numbered.filter(|(number, _)| !left_out.contains(&(*number as f64)));
    let (numbers, rows): (Vec<usize>, Vec<MeasuredRow>) = kept.unzip();
    if rows.is_empty() {
        bail!("⟪leave_out⟫ leaves no row of {count}: keep at least one");
    }
    Ok((numbers, rows))
}

/// Refuses a column that no cable and no pose has.
fn check_columns(columns: &GappedColumns, robot: &Robot) -> Result<(), String> {
    let cables = || robot.cables.iter().map(|cable| cable.name.as_str());
    let of_cables = cables().flat_map(length_names);
    let poses = POSE.iter().map(|name| (*name).to_owned());
    let known: Vec<String> = poses.chain(of_cables).chain(cables().map(tension_name)).collect();
    columns.keys().find(|name| !known.contains(name)).map_or(Ok(()), |unknown| {
        Err(format!(
            "there is a column `{unknown}`{}: give length_NAME_m, _mm or _in of the cables {}, and x_m, y_m, z_m, \
              roll_deg, pitch_deg, yaw_deg, tension_NAME_n; drop other columns",
            suggestion(unknown, &known),
            cables().collect::<Vec<_>>().join(", ")
        ))
    })
}

/// Column of the lengths of one cable; `None` for a cable without.
type LengthColumn<'a> = Option<&'a [Option<f64>]>;

/// Column of the lengths of each cable.
fn length_columns<'a>(columns: &'a GappedColumns, robot: &Robot) -> Result<Vec<LengthColumn<'a>>, String> {
    let of_cable = |cable: &funicular::robot::Cable| {
        let names = length_names(&cable.name).into_iter();
        let mut given = names.filter_map(|name| Some((columns.get(&name)?, name)));
        let first = given.next();
        if let (Some((_, one)), Some((_, other))) = (&first, given.next()) {
            return Err(format!("there are columns `{one}` and `{other}`: keep one of them"));
        }
        Ok(first.map(|(values, _)| values.as_slice()))
    };
    robot.cables.iter().map(of_cable).collect()
}

/// Number of rows.
fn count(columns: &GappedColumns, lengths: &[LengthColumn]) -> Result<usize, String> {
    let Some(count) = lengths.iter().flatten().map(|values| values.len()).next() else {
        return Err("there is no column length_NAME_m, _mm or _in of a cable: give one per cable".to_owned());
    };
    if let Some((name, values)) = columns.iter().find(|(_, values)| values.len() != count) {
        let own = values.len();
        return Err(format!("`{name}` has {own} values, other columns have {count}: give as many in all"));
    }
    if !(1..=MAX_ROWS).contains(&count) {
        return Err(format!("there are {count} rows: give 1 to {MAX_ROWS}"));
    }
    Ok(count)
}

/// Pose at which a row starts; `None` if a coordinate in which the platform moves is not given.
fn pose(value: impl Fn(&str) -> Option<f64>, robot: &Robot) -> Result<Option<Pose>, String> {
    let given = [0, 1, 2].map(|axis| value(POSE[axis]));
    let position = match &robot.platform.motion {
        PlatformMotion::Planar(plane) => plane.point_with(given),
        _ => given[0].zip(given[1]).zip(given[2]).map(|((x, y), z)| Vec3::new(x, y, z)),
    };
    let Some(position) = position else { return Ok(None) };
    let angles = [3, 4, 5].map(|axis| value(POSE[axis]).unwrap_or(0.0));
    let pose = Pose::new(position.into(), angles);
    check_pose(robot, &pose).map_err(|error| error.to_string())?;
    Ok(Some(pose))
}

/// Refuses readings in another unit than metres.
fn check_unit(rows: &[MeasuredRow], robot: &Robot) -> Result<(), String> {
    let middle = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).copied().unwrap_or(0.0)
    };
    let read = middle(rows.iter().flat_map(|row| row.readings.iter().flatten().map(|value| value.abs())).collect());
    let anchors: Vec<_> = robot.cables.iter().map(|cable| cable.anchor.point_w).collect();
    let mean = anchors.iter().sum::<Vec3>() / anchors.len().max(1) as f64;
    let size = middle(anchors.iter().map(|anchor| (anchor - mean).norm()).collect());
    let ratio = read / size;
    if size <= 0.0 || ratio <= OTHER_UNIT {
        return Ok(());
    }
    let thousand = (ratio / 1000.0).ln().abs() < OTHER_UNIT.ln() / 2.0;
    let remedy = if thousand {
        "they look like millimetres: name the columns length_NAME_mm"
    } else {
        "readings in steps of a motor have to be converted: multiply them by the metres of one step"
    };
    Err(format!(
        "the readings are about {} m, but the anchors of the robot file are about {} m from their middle; lengths of \
         another unit would fit a robot of another size perfectly; {remedy}",
        significant(read, 3),
        significant(size, 3)
    ))
}

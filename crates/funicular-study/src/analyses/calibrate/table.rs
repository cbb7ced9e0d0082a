//! Table of readings: rows of the calibration, with the faults that a table of lengths usually has.

use super::KEY;
use crate::at_rest::check_pose;
use crate::names::suggestion;
use crate::request::NumberColumns;
use crate::table_fault::TableFault;
use crate::text::significant;
use crate::values::finite;
use funicular::calibration::MeasuredRow;
use funicular::robot::{Pose, Robot};

/// Columns of a pose.
const POSE: [&str; 6] = ["x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg"];

/// Maximum number of rows.
const MAX_ROWS: usize = 10_000;

/// Ratio of the middle reading to the middle length of the file from which on they cannot be the same lengths: the size of
/// a robot is known within a factor of 20, and millimetres are a factor of 1000.
const OTHER_UNIT: f64 = 20.0;

/// Checks a table of readings for a robot.
///
/// # Errors
/// The first fault: a column that is missing or unknown, no rows, a value that is none, a pose that the platform cannot
/// have, or readings in another unit.
pub fn check(columns: &NumberColumns, robot: &Robot) -> Result<(), TableFault> {
    rows(columns, robot, false).map(drop)
}

/// Rows of a table; with `measured` the coordinates of the platform are data.
pub(super) fn rows(columns: &NumberColumns, robot: &Robot, measured: bool) -> Result<Vec<MeasuredRow>, TableFault> {
    let fault = |text: String| TableFault { key: KEY, row: None, text };
    let names = |cable: &str| {
        [
            (format!("length_{cable}_m"), 1.0),
            (format!("length_{cable}_mm"), 1e-3),
            (format!("unstrained_length_{cable}_m"), 1.0),
        ]
    };
    let of_cables: Vec<String> =
        robot.cables.iter().flat_map(|cable| names(&cable.name).map(|(name, _)| name)).collect();
    let of_tension = |cable: &str| format!("tension_{cable}_n");
    let tensions = robot.cables.iter().map(|cable| of_tension(&cable.name));
    let known: Vec<String> = POSE.iter().map(|name| (*name).to_owned()).chain(of_cables).chain(tensions).collect();
    if let Some(unknown) = columns.keys().find(|name| !known.contains(name)) {
        return Err(fault(format!(
            "there is a column `{unknown}`{}: give length_NAME_m or length_NAME_mm of the cables {}, and x_m, y_m, z_m, \
             roll_deg, pitch_deg, yaw_deg, tension_NAME_n; drop other columns",
            suggestion(unknown, &known),
            robot.cables.iter().map(|cable| cable.name.as_str()).collect::<Vec<_>>().join(", ")
        )));
    }

    // The column of each cable.
    let mut readings: Vec<Option<(&[f64], f64)>> = Vec::new();
    for cable in &robot.cables {
        let mut given =
            names(&cable.name).into_iter().filter_map(|(name, unit)| Some((columns.get(&name)?, unit, name)));
        let first = given.next();
        if let (Some((_, _, one)), Some((_, _, other))) = (&first, given.next()) {
            return Err(fault(format!("there are columns `{one}` and `{other}`: keep one of them")));
        }
        readings.push(first.map(|(values, unit, _)| (values.as_slice(), unit)));
    }
    let Some(count) = readings.iter().flatten().map(|(values, _)| values.len()).next() else {
        return Err(fault(
            "there is no column length_NAME_m or length_NAME_mm of a cable: give one per cable".to_owned(),
        ));
    };
    if let Some((name, values)) = columns.iter().find(|(_, values)| values.len() != count) {
        return Err(fault(format!(
            "`{name}` has {} values, other columns have {count}: give as many in all",
            values.len()
        )));
    }
    if !(1..=MAX_ROWS).contains(&count) {
        return Err(fault(format!("there are {count} rows: give 1 to {MAX_ROWS}")));
    }

    let rows: Vec<MeasuredRow> = (0..count)
        .map(|row| {
            let reading = |of: &Option<(&[f64], f64)>| of.map(|(values, unit)| values[row] * unit);
            let coordinate = |name: &str| columns.get(name).map(|values| values[row]);
            let start = pose(row, columns, robot).map_err(|text| TableFault { key: KEY, row: Some(row), text })?;
            let position = if measured { ["x_m", "y_m", "z_m"].map(coordinate) } else { [None; 3] };
            let tensions = robot.cables.iter().map(|cable| coordinate(&of_tension(&cable.name))).collect();
            let made = MeasuredRow { readings: readings.iter().map(reading).collect(), position, tensions, start };
            for (name, values) in columns {
                finite(values[row]).map_err(|reason| TableFault {
                    key: KEY,
                    row: Some(row),
                    text: format!("`{name}`: {reason}"),
                })?;
            }
            Ok(made)
        })
        .collect::<Result<_, TableFault>>()?;
    check_unit(&rows, robot).map_err(fault)?;
    Ok(rows)
}

/// Pose at which a row starts; `None` without columns of a position.
fn pose(row: usize, columns: &NumberColumns, robot: &Robot) -> Result<Option<Pose>, String> {
    if !POSE[..3].iter().any(|name| columns.contains_key(*name)) {
        return Ok(None);
    }
    let value = |name: &str| columns.get(name).map_or(0.0, |values| values[row]);
    let [x, y, z, roll, pitch, yaw] = POSE.map(value);
    let pose = Pose::new([x, y, z], [roll, pitch, yaw]);
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
    let mean = anchors.iter().sum::<funicular::math::Vec3>() / anchors.len().max(1) as f64;
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

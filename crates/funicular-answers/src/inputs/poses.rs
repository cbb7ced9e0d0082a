//! Reading of poses from a CSV file.

use anyhow::{Context, Result, anyhow, bail};
use funicular::robot::{PlatformMotion, Pose, Robot};
use funicular_formats::csv_lines::CsvText;
use funicular_study::at_rest::refuse_orientation;
use funicular_study::written::number;
use std::fs;
use std::path::Path;

/// Columns of a file of poses.
const COLUMNS: [&str; 6] = ["x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg"];

/// Reads position [m] and roll, pitch, yaw [degrees] of every line. Other columns are ignored, and a note names them.
///
/// # Errors
/// A file that cannot be read or has no poses; a pose column that is missing, is there twice or has another unit; a
/// value that is not a number; or an angle of a point mass.
pub(super) fn read(path: &Path, robot: &Robot, notes: &mut Vec<String>) -> Result<Vec<[f64; 6]>> {
    let shown = path.display();
    let bytes = fs::read(path).with_context(|| format!("cannot read the poses {shown}"))?;
    let name = shown.to_string();
    let text = CsvText::open(&name, &bytes)?;
    let places = places(&text.header, notes).map_err(|reason| anyhow!("{shown} {reason}"))?;
    let written = text.written.clone();

    let is_point_mass = robot.platform.motion == PlatformMotion::PointMass;
    let mut poses = Vec::new();
    for record in text.records() {
        let (line, record) = record?;
        let mut pose = [0.0; 6];
        for (value, place) in pose.iter_mut().zip(places) {
            let Some(place) = place else { continue };
            let column = &written[place];
            *value = number(record.get(place).unwrap_or_default())
                .map_err(|reason| anyhow!("{shown}, line {line}, column `{column}`: {reason}"))?;
        }
        let [x, y, z, roll, pitch, yaw] = pose;
        refuse_orientation(is_point_mass, &Pose::new([x, y, z], [roll, pitch, yaw]))
            .map_err(|error| anyhow!("{shown}, line {line}: {error}"))?;
        poses.push(pose);
    }

    if poses.is_empty() {
        bail!("{shown} has a header and no poses: give one pose per line below it");
    }

    Ok(poses)
}

/// Place of each column. An unknown column is reported, and refused if its name is close to that of a pose column.
fn places(header: &[String], notes: &mut Vec<String>) -> Result<[Option<usize>; 6], String> {
    let mut places = [None; 6];
    let mut others = Vec::new();

    for (i, name) in header.iter().map(String::as_str).enumerate() {
        if let Some(k) = COLUMNS.iter().position(|column| *column == name) {
            if places[k].replace(i).is_some() {
                return Err(format!("has the column `{name}` twice: keep one of them"));
            }
        } else {
            others.push(name);
        }
    }

    let all = COLUMNS.join(", ");
    if let Some(missing) = (0..3).find(|&k| places[k].is_none()) {
        let missing = COLUMNS[missing];
        return Err(format!("has no column `{missing}`: the first line names {all}; angles may be left out"));
    }

    let stem = |name: &str| name.split('_').next().unwrap_or_default().to_lowercase();
    let meant = |name: &str| (0..6).find(|&k| places[k].is_none() && stem(COLUMNS[k]) == stem(name));

    if let Some((name, k)) = others.iter().find_map(|name| Some((name, meant(name)?))) {
        let column = COLUMNS[k];
        return Err(format!(
            "has a column `{name}` and no `{column}`: give the angle in degrees as `{column}`, or drop the column"
        ));
    }
    if !others.is_empty() {
        notes.push(format!("columns that do not belong to a pose are ignored: {}", others.join(", ")));
    }

    Ok(places)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_found_in_any_order_and_those_of_a_pose_in_another_unit_refused() {
        let of = |line: &str| places(&line.split(',').map(str::to_owned).collect::<Vec<_>>(), &mut Vec::new());
        assert_eq!(of("t_s,z_m,x_m,y_m,yaw_deg"), Ok([Some(2), Some(3), Some(1), None, None, Some(4)]));
        assert_eq!(of("x_m,y_m,z_m,x_dot_m_s"), Ok([Some(0), Some(1), Some(2), None, None, None]));
        for (line, says) in [
            ("x_m,y_m", "has no column `z_m`"),
            ("x_m,y_m,z_m,x_m", "the column `x_m` twice"),
            ("x_m,y_m,z_m,yaw_rad", "has a column `yaw_rad` and no `yaw_deg`"),
            ("x_m,y_m,z_m,Roll", "give the angle in degrees as `roll_deg`"),
        ] {
            let error = of(line).unwrap_err();
            assert!(error.contains(says), "{error}");
        }
    }
}

//! Poses over time from ROS, as `rostopic echo -p` and exports of bags write them: a time in nanoseconds or in two
//! columns, `pose.position.x` and others, and a quaternion `pose.orientation.w`.

use crate::csv_lines::CsvText;
use crate::number_table::NumberTable;
use anyhow::{Result, anyhow, bail};
use funicular::math::Quaternion;

use funicular_study::values::number;

/// Ends of the names of the columns, which may stand below the names of a topic and of a field.
const POSITION: [&str; 3] = ["position.x", "position.y", "position.z"];
const ORIENTATION: [&str; 4] = ["orientation.w", "orientation.x", "orientation.y", "orientation.z"];

/// Times in nanoseconds.
const NANOSECONDS: [&str; 2] = ["%time", "header.stamp"];
/// Times in seconds and nanoseconds, of ROS 1 and ROS 2.
const SECONDS: [&str; 2] = ["stamp.secs", "stamp.sec"];
const PARTS: [&str; 2] = ["stamp.nsecs", "stamp.nanosec"];

/// Difference of the norm of a quaternion from 1 that is rounding.
const MAX_NORM_ERROR: f64 = 1e-3;

/// True for a table whose header names poses of ROS.
pub(crate) fn is_of_ros(header: &[String]) -> bool {
    place(header, &POSITION[..1]).is_some()
}

/// Place of the first column with one of these ends: the whole name, or behind a `.` or `/`.
fn place(header: &[String], ends: &[&str]) -> Option<usize> {
    let has_end = |name: &str, end: &str| {
        name.strip_suffix(end).is_some_and(|before| before.is_empty() || before.ends_with(['.', '/']))
    };
    header.iter().position(|name| ends.iter().any(|end| has_end(name, end)))
}

/// Time column or columns.
enum Time {
    Nanoseconds(usize),
    Parts(usize, usize),
}

/// Reads times from the first row on [s], positions [m] and, with a quaternion, angles [degrees].
///
/// # Errors
/// A column that is missing, or a value that is none; the message names the line.
pub(crate) fn read(path: &str, text: CsvText) -> Result<NumberTable> {
    let header = text.header.clone();
    let found = |ends: &[&str]| place(&header, ends);
    let time = match (found(&PARTS), found(&SECONDS), found(&NANOSECONDS)) {
        (Some(part), Some(whole), _) => Time::Parts(whole, part),
        (_, _, Some(whole)) => Time::Nanoseconds(whole),
        _ => bail!(
            "{path} has poses of ROS without a time: it needs `%time` or `header.stamp` in nanoseconds, or \
             `header.stamp.sec` and `header.stamp.nanosec`"
        ),
    };
    let position = POSITION.map(|end| found(&[end]));
    let orientation = ORIENTATION.map(|end| found(&[end]));
    let [Some(x), Some(y), Some(z)] = position else {
        bail!("{path} has `position.x`, but not all of {}", POSITION.join(", "));
    };

    let mut table = NumberTable::default();
    let mut first = None;
    for record in text.records() {
        let (line, record) = record?;
        let fault = |k: usize, reason: String| anyhow!("{path}, line {line}, column `{}`: {reason}", header[k]);
        let cell = |k: usize| record.get(k).unwrap_or_default();
        let value = |k: usize| number(cell(k)).map_err(|reason| fault(k, reason.to_string()));
        // Nanoseconds since 1970 have more digits than a number of floating point.
        let whole = |k: usize| {
            cell(k).parse::<i64>().map_err(|_| fault(k, format!("`{}` is no whole number of time", cell(k))))
        };
        let nanoseconds = match time {
            Time::Nanoseconds(k) => i128::from(whole(k)?),
            Time::Parts(seconds, part) => i128::from(whole(seconds)?) * 1_000_000_000 + i128::from(whole(part)?),
        };
        let since = nanoseconds - *first.get_or_insert(nanoseconds);

        let mut add = |name: &str, value: f64| table.columns.entry(name.to_owned()).or_default().push(value);
        add("t_s", since as f64 * 1e-9);
        for (name, k) in ["x_m", "y_m", "z_m"].into_iter().zip([x, y, z]) {
            add(name, value(k)?);
        }
        if let [Some(w), Some(i), Some(j), Some(k)] = orientation {
            let quaternion = Quaternion::new(value(w)?, value(i)?, value(j)?, value(k)?);
            if (quaternion.norm() - 1.0).abs() > MAX_NORM_ERROR {
                return Err(fault(w, format!("the quaternion has the norm {}, not 1", quaternion.norm())));
            }
            for (name, angle) in ["roll_deg", "pitch_deg", "yaw_deg"].into_iter().zip(angles(quaternion)) {
                add(name, angle);
            }
        }
        table.lines.push(line);
    }
    Ok(table)
}

/// Roll, pitch and yaw of a quaternion [degrees].
fn angles(quaternion: Quaternion) -> [f64; 3] {
    let rot_wp = funicular::math::Rotation::new_normalize(quaternion);

    let (roll, pitch, yaw) = rot_wp.euler_angles();
    [roll, pitch, yaw].map(f64::to_degrees)
}

#[cfg(test)]
mod tests {
    use crate::number_columns::read;

    #[test]
    fn nanoseconds_and_quaternions_become_seconds_and_angles() {
        let half = 0.5_f64.sqrt();
        let one = format!(
            "%time,field.header.seq,field.header.frame_id,field.pose.position.x,field.pose.position.y,\
             field.pose.position.z,field.pose.orientation.x,field.pose.orientation.y,field.pose.orientation.z,\
             field.pose.orientation.w\n1700000000000000001,0,map,1,2,3,0,0,0,1\n1700000000500000002,1,map,1.5,2,3,0,0,\
             {half},{half}\n"
        );
        let two = format!(
            "/pose/header/stamp/sec,header.stamp.sec,header.stamp.nanosec,pose.position.x,pose.position.y,\
             pose.position.z,pose.orientation.w,pose.orientation.x,pose.orientation.y,pose.orientation.z\n0,\
             1700000000,999999999,1,2,3,1,0,0,0\n0,1700000001,500000000,1.5,2,3,{half},0,0,{half}\n"
        );
        for text in [one, two] {
            let found = read("way.csv", text.as_bytes()).unwrap();
            assert!((found.columns["t_s"][1] - 0.500_000_001).abs() < 1e-15, "{:?}", found.columns["t_s"]);
            assert_eq!(found.columns["x_m"], [1.0, 1.5]);
            assert!((found.columns["yaw_deg"][1] - 90.0).abs() < 1e-12 && found.columns["roll_deg"][1].abs() < 1e-12);
        }
        let told = read("way.csv", b"position.x,position.y,position.z\n1,2,3\n").unwrap_err().to_string();
        assert!(told.contains("without a time"), "{told}");
        let told = read("way.csv", b"%time,position.x,position.y,position.z\n1.5,1,2,3\n").unwrap_err().to_string();
        assert!(told.contains("line 2, column `%time`: `1.5` is no whole number"), "{told}");
    }
}

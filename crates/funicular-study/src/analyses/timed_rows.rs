//! Rows over time of poses or of unstrained lengths, from a table.

use crate::at_rest::check_pose;
use crate::request::NumberColumns;
use crate::table_fault::TableFault;
use crate::values::{finite, positive};
use funicular::robot::{Pose, Robot};

/// Column of the times.
pub(super) const TIME: &str = "t_s";

/// Column that makes a table a job, whose rows are moves: the speed of the move to a row.
pub(super) const FEED: &str = "feed_m_s";

/// Columns of poses; the angles may be left out.
pub(super) const POSE: [&str; 6] = ["x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg"];

/// Maximum number of rows over time: an hour at 0.1 s, or 36 s at 1 ms.
pub(super) const MAX_SAMPLES: f64 = 36_000.0;

/// Part of a step beyond the last one that counts as rounding.
const ROUNDING: f64 = 1e-9;

/// Number of equal steps from 0 to a time [s], the last of which may be shorter.
pub(super) fn count_of_steps(end: f64, step: f64) -> f64 {
    (end / step - ROUNDING).ceil().max(0.0)
}

/// Times in equal steps from 0 on; the last step ends at this time and may be shorter [s].
pub(super) fn in_steps(end: f64, step: f64) -> impl Iterator<Item = f64> {
    // A step of 0.002 s is 1/500 s: quotients are the decimal numbers that a user expects, products are not.
    let per_second = (1.0 / step).round();
    let is_part = per_second >= 1.0 && (per_second * step - 1.0).abs() < 1e-12;
    let count = count_of_steps(end, step) as usize;
    let at = move |k: usize| if is_part { k as f64 / per_second } else { k as f64 * step };
    (0..count).map(at).chain([end])
}

/// Rows over time.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TimedRows {
    pub(super) holds: Holds,
    /// Times since the first row [s], rising.
    pub(super) times: Vec<f64>,
    /// Pose [m, degrees] or unstrained lengths [m] at each time.
    pub(super) values: Vec<Vec<f64>>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Holds {
    Poses,
    Lengths,
}

impl TimedRows {
    /// Reads the table in a key of a request.
    ///
    /// # Errors
    /// The first fault: a column that is missing or unknown, fewer than two rows, times that do not rise, a pose that
    /// the platform cannot have, or a length that is none.
    pub(super) fn read(key: &'static str, columns: &NumberColumns, robot: &Robot) -> Result<Self, TableFault> {
        let fault = |text: String| TableFault::of_table(key, text);
        let of_lengths: Vec<String> =
            robot.cables.iter().map(|cable| format!("unstrained_length_{}_m", cable.name)).collect();
        let known: Vec<String> =
            [TIME].iter().chain(&POSE).map(|name| (*name).to_owned()).chain(of_lengths.clone()).collect();
        if columns.contains_key(FEED) {
            return Err(fault(
                "a job has no times: compute them by `trajectory` with the job as ⟪path⟫, and give its table of \
                 lengths over time"
                    .to_owned(),
            ));
        }
        let wanted = "a trajectory has t_s, and either x_m, y_m, z_m, roll_deg, pitch_deg, yaw_deg or \
                      unstrained_length_NAME_m of every cable";
        TableFault::refuse_unknown(key, columns, &known, wanted)?;
        TableFault::refuse_uneven(key, columns)?;
        let is_there = |name: &str| columns.contains_key(name);
        let [poses, lengths] = [POSE.iter().any(|name| is_there(name)), of_lengths.iter().any(|name| is_there(name))];
        let holds = match (poses, lengths) {
            (true, true) => {
                return Err(fault("there are columns of poses and of lengths: keep those of one".to_owned()));
            }
            (true, false) => Holds::Poses,
            _ => Holds::Lengths,
        };
        let needed: Vec<&str> = match holds {
            Holds::Poses => POSE[..3].to_vec(),
            Holds::Lengths => of_lengths.iter().map(String::as_str).collect(),
        };
        if let Some(missing) = [TIME].iter().chain(&needed).find(|name| !is_there(name)) {
            return Err(fault(format!(
                "there is no column `{missing}`: give {TIME}, and either x_m, y_m, z_m and, where the platform turns, \
                 angles, or the length of every cable"
            )));
        }
        Self::of_columns(key, columns, holds, &if holds == Holds::Poses { POSE.to_vec() } else { needed }, robot)
    }

    /// Rows of the columns `names`; a column that is not there holds zeros.
    fn of_columns(
        key: &'static str,
        columns: &NumberColumns,
        holds: Holds,
        names: &[&str],
        robot: &Robot,
    ) -> Result<Self, TableFault> {
        let count = columns[TIME].len();
        if count < 2 || count as f64 > MAX_SAMPLES {
            let text = format!("there are {count} rows: give at least two and at most {MAX_SAMPLES}");
            return Err(TableFault::of_table(key, text));
        }
        let value = |name: &str, row: usize| columns.get(name).map_or(0.0, |values| values[row]);
        let rows = Self {
            holds,
            times: columns[TIME].iter().map(|time| time - columns[TIME][0]).collect(),
            values: (0..count).map(|row| names.iter().map(|name| value(name, row)).collect()).collect(),
        };
        for row in 0..count {
            rows.check_row(columns, row, names, robot).map_err(|text| TableFault { key, row: Some(row), text })?;
        }
        Ok(rows)
    }

    fn check_row(&self, columns: &NumberColumns, row: usize, names: &[&str], robot: &Robot) -> Result<(), String> {
        let time = columns[TIME][row];
        finite(time).map_err(|reason| format!("`{TIME}`: {reason}"))?;
        if row > 0 && time <= columns[TIME][row - 1] {
            let before = columns[TIME][row - 1];
            return Err(format!("the time {time} s is not after the one before, {before} s: give rising times"));
        }
        for (name, value) in names.iter().zip(&self.values[row]) {
            let checked = if self.holds == Holds::Lengths { positive(*value) } else { finite(*value) };
            checked.map_err(|reason| format!("`{name}`: {reason}"))?;
        }
        match self.holds {
            Holds::Poses => check_pose(robot, &self.pose(row)).map_err(|error| error.to_string()),
            Holds::Lengths => Ok(()),
        }
    }

    pub(super) fn pose(&self, row: usize) -> Pose {
        let value = |k: usize| self.values[row].get(k).copied().unwrap_or_default();
        Pose::new([0, 1, 2].map(value), [3, 4, 5].map(value))
    }
}

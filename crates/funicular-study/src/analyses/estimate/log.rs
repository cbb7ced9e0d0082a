//! Log of a machine: columns of sensors by their names, with the faults that a log usually has.

use crate::analyses::shared::AXES;
use crate::request::GappedColumns;
use crate::table_fault::TableFault;
use crate::text::significant;
use crate::values::finite;
use funicular::estimation::{SensorGroup, SensorReadings};
use funicular::math::Vec3;
use funicular::robot::Robot;

/// Key of the log.
const KEY: &str = "log";

/// Names of the column of the times; stamps in ns have become seconds.
const TIMES: [&str; 3] = ["t_s", "time_s", "stamp_s"];

/// Maximum number of rows: an hour at 1 kHz has 3.6 million.
const MAX_ROWS: usize = 4_000_000;

/// Ratio of the middle length to the size of the robot from which on the lengths have another unit: millimetres are a
/// factor of 1000.
const OTHER_UNIT: f64 = 20.0;

/// Range of the middle specific force [m/s²] of a log in multiples of the earth's gravity.
const IN_GRAVITIES: [f64; 2] = [0.8, 1.2];

/// Column with gaps; `None` for a reading that the log does not have.
type LogColumn<'a> = Option<(&'a [Option<f64>], f64)>;

/// Columns of a log by their sensors.
pub(super) struct EstimateLog<'a> {
    pub(super) times: Vec<f64>,
    /// First row with the lengths of all cables.
    pub(super) first: usize,
    lengths: Vec<LogColumn<'a>>,
    tensions: Vec<LogColumn<'a>>,
    angles: Vec<[LogColumn<'a>; 2]>,
    gyroscope: [LogColumn<'a>; 3],
    accelerometer: [LogColumn<'a>; 3],
    tracker: [LogColumn<'a>; 3],
}

/// Checks a log for a robot.
///
/// # Errors
/// The first fault: a column that is missing, unknown or there twice, times that do not rise, a value that is none, or
/// numbers in another unit.
pub fn check(columns: &GappedColumns, robot: &Robot) -> Result<(), TableFault> {
    EstimateLog::read(columns, robot).map(drop)
}

/// Names of a column with the factors that bring it to the unit of the first.
type ColumnNames = Vec<(String, f64)>;

fn length_names(cable: &str) -> ColumnNames {
    vec![(format!("length_{cable}_m"), 1.0), (format!("unstrained_length_{cable}_m"), 1.0)]
}

fn tension_names(cable: &str) -> ColumnNames {
    vec![(format!("tension_anchor_{cable}_n"), 1.0), (format!("tension_{cable}_n"), 1.0)]
}

/// Names of a column of angles or their rates: radians or degrees.
fn angle_names(stem: &str, ending: &str) -> ColumnNames {
    vec![(format!("{stem}_rad{ending}"), 1.0), (format!("{stem}_deg{ending}"), 1f64.to_radians())]
}

impl<'a> EstimateLog<'a> {
    /// Reads the columns of a log.
    ///
    /// # Errors
    /// Those of [`check`].
    pub(super) fn read(columns: &'a GappedColumns, robot: &Robot) -> Result<Self, TableFault> {
        TableFault::refuse_unknown(KEY, columns, &known(robot), &wanted(robot))?;
        TableFault::refuse_uneven(KEY, columns)?;
        let fault = |text: String| TableFault::of_table(KEY, text);
        let find = |names: ColumnNames| one_of(columns, &names).map_err(fault);
        let of_cables = |names: fn(&str) -> ColumnNames| {
            robot.cables.iter().map(|cable| find(names(&cable.name))).collect::<Result<Vec<_>, _>>()
        };
        let of_axes = |names: &dyn Fn(&str) -> ColumnNames| -> Result<[LogColumn; 3], TableFault> {
            let [x, y, z] = AXES.map(|axis| find(names(axis)));
            Ok([x?, y?, z?])
        };
        let azimuths = of_cables(|cable| angle_names(&format!("azimuth_{cable}"), ""))?;
        let elevations = of_cables(|cable| angle_names(&format!("elevation_{cable}"), ""))?;

        let mut log = Self {
            times: times(columns)?,
            first: 0,
            lengths: of_cables(length_names)?,
            tensions: of_cables(tension_names)?,
            angles: azimuths.into_iter().zip(elevations).map(|(azimuth, elevation)| [azimuth, elevation]).collect(),
            gyroscope: of_axes(&|axis| angle_names(&format!("gyroscope_{axis}"), "_s"))?,
            accelerometer: of_axes(&|axis| vec![(format!("accelerometer_{axis}_m_s2"), 1.0)])?,
            tracker: of_axes(&|axis| vec![(format!("tracker_{axis}_m"), 1.0)])?,
        };
        check_values(columns)?;
        log.check_lengths(robot)?;
        log.check_gravity().map_err(fault)?;
        Ok(log)
    }

    /// Number of rows.
    pub(super) fn count(&self) -> usize {
        self.times.len()
    }

    /// True if a group of sensors has a column.
    pub(super) fn has(&self, group: SensorGroup) -> bool {
        match group {
            SensorGroup::Tensions => self.tensions.iter().any(Option::is_some),
            SensorGroup::Angles => self.angles.iter().flatten().any(Option::is_some),
            SensorGroup::Gyroscope => self.gyroscope.iter().any(Option::is_some),
            SensorGroup::Accelerometer => self.accelerometer.iter().any(Option::is_some),
            SensorGroup::Tracker => self.tracker.iter().any(Option::is_some),
        }
    }

    /// True if a row has the lengths of all cables.
    pub(super) fn has_lengths(&self, row: usize) -> bool {
        self.lengths.iter().all(|column| value(*column, row).is_finite())
    }

    /// Readings of a row.
    pub(super) fn readings(&self, row: usize) -> SensorReadings {
        let mut readings = SensorReadings::default();
        let fill = |to: &mut [f64], columns: &[LogColumn]| {
            to.iter_mut().zip(columns).for_each(|(to, column)| *to = value(*column, row));
        };
        fill(&mut readings.lengths, &self.lengths);
        fill(&mut readings.tensions, &self.tensions);
        for (to, columns) in readings.angles.iter_mut().zip(&self.angles) {
            fill(to, columns);
        }
        fill(&mut readings.gyroscope, &self.gyroscope);
        fill(&mut readings.accelerometer, &self.accelerometer);
        fill(&mut readings.tracker, &self.tracker);
        readings
    }

    /// Refuses a log without the lengths of all cables, or with lengths in another unit; finds the first row.
    fn check_lengths(&mut self, robot: &Robot) -> Result<(), TableFault> {
        let fault = |text: String| TableFault::of_table(KEY, text);
        if let Some((cable, _)) = robot.cables.iter().zip(&self.lengths).find(|(_, column)| column.is_none()) {
            return Err(fault(format!(
                "there is no column `length_{}_m`: the lengths of all cables are needed, because they and the load \
                 give the pose",
                cable.name
            )));
        }
        let first = (0..self.count()).find(|row| self.has_lengths(*row));
        self.first = first.ok_or_else(|| {
            fault("no row has the lengths of all cables: the estimate starts at one that has them".to_owned())
        })?;
        for (cable, column) in robot.cables.iter().zip(&self.lengths) {
            let values = column.map_or(&[][..], |(values, _)| values);
            if let Some(row) = values.iter().position(|value| value.is_some_and(|value| value <= 0.0)) {
                let text = format!("the length of cable {} is not positive: give unstrained lengths", cable.name);
                return Err(TableFault { key: KEY, row: Some(row), text });
            }
        }
        let anchors: Vec<Vec3> = robot.cables.iter().map(|cable| cable.anchor.point_w).collect();
        let mean = anchors.iter().sum::<Vec3>() / anchors.len().max(1) as f64;
        let size = anchors.iter().map(|anchor| (anchor - mean).norm()).fold(0.0, f64::max);
        let read = self.readings(self.first).lengths[..anchors.len()].iter().copied().fold(0.0, f64::max);
        if size > 0.0 && read > OTHER_UNIT * size {
            return Err(fault(format!(
                "the lengths are up to {} m, but the anchors of the robot file are within {} m of their middle: \
                 lengths in millimetres have columns length_NAME_mm",
                significant(read, 3),
                significant(size, 3)
            )));
        }
        Ok(())
    }

    /// Refuses specific forces in multiples of the earth's gravity.
    fn check_gravity(&self) -> Result<(), String> {
        let mut sizes: Vec<f64> = (0..self.count())
            .map(|row| Vec3::from(self.accelerometer.map(|column| value(column, row))).norm())
            .filter(|size| size.is_finite())
            .collect();
        sizes.sort_by(f64::total_cmp);
        match sizes.get(sizes.len() / 2) {
            Some(size) if (IN_GRAVITIES[0]..=IN_GRAVITIES[1]).contains(size) => Err(format!(
                "the specific force is about {}: it looks like multiples of the earth's gravity; multiply the columns \
                 accelerometer_… by 9.81 to have m/s²",
                significant(*size, 3)
            )),
            _ => Ok(()),
        }
    }
}

/// Reading of a row in the unit of the program; NaN without one.
fn value(column: LogColumn, row: usize) -> f64 {
    column.and_then(|(values, factor)| Some(values[row]? * factor)).unwrap_or(f64::NAN)
}

/// Column with one of several names; an error if two of them are there.
fn one_of<'a>(columns: &'a GappedColumns, names: &ColumnNames) -> Result<LogColumn<'a>, String> {
    let mut found = names.iter().filter_map(|(name, factor)| Some((name, columns.get(name)?, *factor)));
    let first = found.next();
    if let (Some((one, ..)), Some((other, ..))) = (first, found.next()) {
        return Err(format!("`{one}` and `{other}` are readings of one sensor: keep one of the columns"));
    }
    Ok(first.map(|(_, values, factor)| (values.as_slice(), factor)))
}

/// Times of the rows, which have to rise.
fn times(columns: &GappedColumns) -> Result<Vec<f64>, TableFault> {
    let fault = |text: String| TableFault::of_table(KEY, text);
    let names: ColumnNames = TIMES.iter().map(|name| ((*name).to_owned(), 1.0)).collect();
    let Some((values, _)) = one_of(columns, &names).map_err(fault)? else {
        return Err(fault("there is no column `t_s` of the times [s]".to_owned()));
    };
    let count = values.len();
    if !(2..=MAX_ROWS).contains(&count) {
        return Err(fault(format!("there are {count} rows: give 2 to {MAX_ROWS}")));
    }
    let mut times = Vec::with_capacity(count);
    for (row, time) in values.iter().enumerate() {
        let fault = |text: String| TableFault { key: KEY, row: Some(row), text };
        let time = time.ok_or_else(|| fault("the row has no time".to_owned()))?;
        finite(time).map_err(|reason| fault(format!("the time: {reason}")))?;
        if let Some(before) = times.last()
            && time <= *before
        {
            let what = if time < *before { "before" } else { "also that of" };
            return Err(fault(format!(
                "the time {time} s is {what} the row before, {before} s: sort the rows, and join those of one time"
            )));
        }
        times.push(time);
    }
    Ok(times)
}

/// Refuses values that are none.
fn check_values(columns: &GappedColumns) -> Result<(), TableFault> {
    for (name, values) in columns {
        for (row, value) in values.iter().enumerate() {
            let checked = value.map_or(Ok(()), |value| finite(value).map(drop));
            checked.map_err(|reason| TableFault { key: KEY, row: Some(row), text: format!("`{name}`: {reason}") })?;
        }
    }
    Ok(())
}

/// Names of all columns that a log of a robot may have.
fn known(robot: &Robot) -> Vec<String> {
    let mut names: ColumnNames = TIMES.iter().map(|name| ((*name).to_owned(), 1.0)).collect();
    for cable in robot.cables.iter().map(|cable| &cable.name) {
        names.extend(length_names(cable).into_iter().chain(tension_names(cable)));
        names.extend(angle_names(&format!("azimuth_{cable}"), ""));
        names.extend(angle_names(&format!("elevation_{cable}"), ""));
    }
    for axis in AXES {
        names.extend(angle_names(&format!("gyroscope_{axis}"), "_s"));
        names.push((format!("accelerometer_{axis}_m_s2"), 1.0));
        names.push((format!("tracker_{axis}_m"), 1.0));
    }
    names.into_iter().map(|(name, _)| name).collect()
}

/// Columns that a log has, for messages.
fn wanted(robot: &Robot) -> String {
    let cables: Vec<&str> = robot.cables.iter().map(|cable| cable.name.as_str()).collect();
    format!(
        "a log has t_s, length_NAME_m, tension_anchor_NAME_n, azimuth_NAME_rad, elevation_NAME_rad of the cables {}, \
         gyroscope_x_rad_s, accelerometer_x_m_s2, tracker_x_m (y, z)",
        cables.join(", ")
    )
}

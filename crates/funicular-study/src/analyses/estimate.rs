//! `estimate`: pose, velocity, payload and tensions over time from the log of a machine, with alarms.
//!
//! docs/theory.md, section 18f, has the filter; docs/estimation.md the columns of a log.

mod follower;
mod in_loop;
mod log;
mod log_run;
mod rows;
mod settings;
mod told;
mod words;

pub use in_loop::LoopEstimator;
pub use log::check as check_log;
pub use rows::{CableErrors, EstimateAlarm, EstimateRow, SensorFit};

use super::found;
use crate::Watch;
use crate::columns::{ResultTable, Tabled};
use crate::request::EstimateRequest;
use crate::rows::rows;
use crate::table::Column;
use anyhow::Result;
use funicular::robot::Robot;
use log::EstimateLog;
use log_run::LogRun;

rows! {
    /// Results of `estimate`.
    pub struct Estimated {
        pub robot: String = hidden;
        /// Sentence on the fit of the readings.
        pub fit: String;
        /// Sentences on numbers that these sensors do not determine.
        pub not_determined: Vec<String>;
        /// Alarms in the order of their times.
        pub alarms: Vec<EstimateAlarm>;
        pub sensors: Vec<SensorFit>;
        pub cable_errors: Vec<CableErrors>;
        /// Names of the cables, in the order of all lists.
        pub cables: Vec<String>;
        /// Number of rows of the log.
        pub log_rows: usize;
        pub rows: Vec<EstimateRow>;
        pub warnings: Vec<String> = hidden;
    }
}

impl Estimated {
    /// Sentences on the fit and the alarms.
    pub fn summary(&self) -> String {
        let alarms = match self.alarms.len() {
            0 => "No alarm".to_owned(),
            1 => "One alarm".to_owned(),
            count => format!("{count} alarms"),
        };
        let mut letters = self.fit.chars();
        let fit: String =
            letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect());
        format!("{fit}. {alarms}.")
    }
}

impl Tabled for Estimated {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        vec![("", EstimateRow::columns(&["NAME".to_owned()]).described())]
    }

    fn table(&self) -> ResultTable<'_> {
        ResultTable::new(EstimateRow::columns(&self.cables), &self.rows)
    }
}

found!(Estimated, "estimate");

/// Estimates the states of a log.
///
/// # Errors
/// A log with a fault, a robot that the filter does not follow, lengths without an equilibrium, or work that was
/// stopped.
pub fn run(robot: &Robot, request: &EstimateRequest, watch: &mut dyn Watch) -> Result<Estimated> {
    let log = EstimateLog::read(&request.log, robot)?;
    let settings = request.sensors.settings();
    let mut run = LogRun::start(robot, &log, request, settings)?;
    run.follow(watch)?;
    let cables: Vec<String> = robot.cables.iter().map(|cable| cable.name.clone()).collect();
    let told = told::of_run(&mut run, &log, &settings, &cables);
    Ok(Estimated {
        robot: robot.name.clone(),
        fit: told.fit,
        not_determined: told.not_determined,
        alarms: run.follower.alarms,
        sensors: told.sensors,
        cable_errors: told.cable_errors,
        cables,
        log_rows: log.count(),
        rows: run.rows,
        warnings: run.warnings.into_iter().chain(told.warnings).collect(),
    })
}

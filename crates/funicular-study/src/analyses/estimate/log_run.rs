//! Filter over a log: rows of the result, alarms with their explanation, and pauses.

use super::follower::{Follower, LatestPayload};
use super::log::EstimateLog;
use super::rows::EstimateRow;
use crate::Watch;
use crate::at_rest::check_pose;
use crate::error::{Cancelled, NoSolution};
use crate::request::{self, EstimateRequest};
use crate::text::significant;
use anyhow::{Context, Result, anyhow};
use funicular::estimation::{EstimationError, EstimationSettings, Estimator, SensorGroup, chi2_quantile};
use funicular::robot::Robot;

/// Number of rows between two reports of the progress.
const REPORT_EVERY: usize = 500;

/// Probability with which the first row of a log that fits is called one that does not.
const NO_FIT: f64 = 1e-6;

/// Run of a filter over a log.
pub(super) struct LogRun<'a> {
    log: &'a EstimateLog<'a>,
    pub(super) follower: Follower,
    every: f64,
    pub(super) rows: Vec<EstimateRow>,
    pub(super) warnings: Vec<String>,
    /// Time of the last row of the result [s], and number of rows of the log that were not trusted.
    last: f64,
    pub(super) mistrusted: usize,
    /// True if the filter has lost the platform, until a row has the lengths of all cables.
    is_lost: bool,
}

impl<'a> LogRun<'a> {
    /// Starts at the first row with all lengths.
    pub(super) fn start(
        robot: &'a Robot,
        log: &'a EstimateLog<'a>,
        request: &EstimateRequest,
        settings: EstimationSettings,
    ) -> Result<Self> {
        let near = request.near_pose.map(request::Pose::to_robot).transpose()?;
        if let Some(pose) = &near {
            check_pose(robot, pose).context("⟪near_pose⟫")?;
        }
        let readings = log.readings(log.first);
        let estimator = Estimator::new(robot.clone(), settings, &readings, near.as_ref()).map_err(at_start)?;
        let mut run = Self {
            log,
            follower: Follower::new(estimator, robot.cables.iter().map(|cable| cable.name.clone()).collect()),
            every: request.every_s,
            rows: Vec::new(),
            warnings: Vec::new(),
            last: f64::NEG_INFINITY,
            mistrusted: 0,
            is_lost: false,
        };
        run.follower.estimator.set_false_alarms_per_hour(request.false_alarms_per_hour);
        run.check_start();
        if log.first > 0 {
            run.warnings.push(format!(
                "the first {} rows of the log do not have the lengths of all cables: the estimate starts at {} s",
                log.first, log.times[log.first]
            ));
        }
        run.add_row(log.first, true);
        Ok(run)
    }

    /// Warns if the first row does not fit the robot at rest.
    fn check_start(&mut self) {
        let fits = SensorGroup::ALL.into_iter().filter_map(|group| {
            let of = self.follower.estimator.consistency(group);
            (of.count > 0 && of.nis > chi2_quantile(1.0 - NO_FIT, of.count as f64)).then(|| group.name())
        });
        let wrong: Vec<&str> = fits.collect();
        if !wrong.is_empty() {
            self.warnings.push(format!(
                "the first row does not fit the robot at rest ({}): the platform moves there, cables or pulleys of the \
                 file are others than those of the machine, a sensor has another unit, or ⟪offset_std_m⟫ and \
                 ⟪tension_bias_std_n⟫ are too small; `calibrate` finds anchors and offsets",
                wrong.join(", ")
            ));
        }
    }

    /// Takes all further rows.
    pub(super) fn follow(&mut self, watch: &mut dyn Watch) -> Result<()> {
        let count = self.log.count();
        for row in self.log.first + 1..count {
            if row % REPORT_EVERY == 0 {
                if watch.is_cancelled() {
                    return Err(Cancelled.into());
                }
                watch.progress(row, count, "rows");
            }
            self.take(row)?;
        }
        self.follower.explain();
        self.follower.close_payload();
        Ok(())
    }

    /// Takes a row.
    fn take(&mut self, row: usize) -> Result<()> {
        let times = &self.log.times;
        let (now, step) = (times[row], times[row] - times[row - 1]);
        let readings = self.log.readings(row);
        let lost = if self.is_lost {
            Some("the lengths are there again".to_owned())
        } else {
            match self.follower.take(&readings, now, step) {
                Ok(notes) => {
                    self.add_row(row, notes.is_trusted);
                    return Ok(());
                }
                Err(EstimationError::BadStep { .. }) => Some(format!("the log pauses for {} s", significant(step, 3))),
                Err(error) => Some(error.to_string()),
            }
        };
        self.is_lost = !self.log.has_lengths(row);
        if let Some(reason) = lost.filter(|_| !self.is_lost) {
            let anew = self.follower.restart(&readings, None, now, &reason);
            anew.map_err(|error| anyhow!(NoSolution(format!("at {now} s: {error}"))))?;
            self.add_row(row, true);
        }
        Ok(())
    }

    /// Adds a row of the result, if it is time for one.
    fn add_row(&mut self, row: usize, is_trusted: bool) {
        self.mistrusted += usize::from(!is_trusted);
        let now = self.log.times[row];
        let is_end = row + 1 == self.log.count();
        if now - self.last < self.every * (1.0 - 1e-9) && !is_end {
            return;
        }
        self.last = now;
        let found = EstimateRow::now(now, &mut self.follower.estimator, is_trusted);
        let (payload_kg, std_kg) = (found.payload_kg, found.payload_std_kg);
        self.follower.latest = Some(LatestPayload { t_s: now, payload_kg, std_kg });
        self.rows.push(found);
    }
}

/// Error of the start: lengths without an equilibrium have no solution, everything else has to change.
pub(super) fn at_start(error: EstimationError) -> anyhow::Error {
    match error {
        EstimationError::NoStart(_) | EstimationError::NoBalance | EstimationError::Diverged => {
            NoSolution(format!("{error}; ⟪near_pose⟫ can say where the platform is")).into()
        }
        other => other.into(),
    }
}

//! Filter in a control loop of the user: one row of results per update.

use super::follower::{Follower, LatestPayload};
use super::log_run::at_start;
use super::rows::{EstimateAlarm, EstimateRow};
use crate::at_rest::check_pose;
use crate::error::NoSolution;
use crate::request::EstimateRequest;
use anyhow::{Context, Result};
use funicular::estimation::{EstimationError, Estimator, SensorReadings};
use funicular::robot::{Pose, Robot};

/// Estimator that is fed step by step, with the rows and alarms of `estimate`.
pub struct LoopEstimator {
    follower: Follower,
    time: f64,
    is_trusted: bool,
    /// Number of alarms that have been handed out.
    told: usize,
}

impl LoopEstimator {
    /// Estimator at rest with the lengths of all cables; of the request, noise, priors and the rate of false alarms
    /// count.
    ///
    /// # Errors
    /// A robot that the filter does not follow, a length that is missing, or lengths without an equilibrium.
    pub fn start(
        robot: &Robot,
        request: &EstimateRequest,
        readings: &SensorReadings,
        near: Option<&Pose>,
    ) -> Result<Self> {
        if let Some(pose) = near {
            check_pose(robot, pose).context("⟪near_pose⟫")?;
        }
        let mut estimator =
            Estimator::new(robot.clone(), request.sensors.settings(), readings, near).map_err(at_start)?;
        estimator.set_false_alarms_per_hour(request.false_alarms_per_hour);
        let names = robot.cables.iter().map(|cable| cable.name.clone()).collect();
        Ok(Self { follower: Follower::new(estimator, names), time: 0.0, is_trusted: true, told: 0 })
    }

    /// Moves the estimate by a time step [s] and takes the readings at its end.
    ///
    /// # Errors
    /// A step that cannot be, which has to change, or a filter that has lost the platform: no solution. The estimator
    /// is as it was.
    pub fn update(&mut self, readings: &SensorReadings, step: f64) -> Result<()> {
        let now = self.time + step;
        let notes = self.follower.take(readings, now, step).map_err(|error| match error {
            EstimationError::EncodersLost { .. } | EstimationError::Diverged => NoSolution(error.to_string()).into(),
            other => anyhow::Error::from(other),
        })?;
        (self.time, self.is_trusted) = (now, notes.is_trusted);
        Ok(())
    }

    /// Begins anew at rest: with payload and errors of the sensors as they are known, or with what was known before
    /// the first reading.
    ///
    /// # Errors
    /// As for [`Self::start`]; the estimator is as it was.
    pub fn restart(&mut self, readings: &SensorReadings, near: Option<&Pose>, forgets: bool) -> Result<()> {
        if forgets {
            self.follower.estimator.reset(readings, near).map_err(at_start)?;
        } else {
            self.follower.restart(readings, near, self.time, "restart").map_err(at_start)?;
        }
        self.is_trusted = true;
        Ok(())
    }

    /// Present state as a row of `estimate`; its time is that since the start.
    pub fn row(&mut self) -> EstimateRow {
        let row = EstimateRow::now(self.time, &mut self.follower.estimator, self.is_trusted);
        let (payload_kg, std_kg) = (row.payload_kg, row.payload_std_kg);
        self.follower.latest = Some(LatestPayload { t_s: self.time, payload_kg, std_kg });
        row
    }

    /// Alarms since the last call.
    pub fn new_alarms(&mut self) -> &[EstimateAlarm] {
        let before = std::mem::replace(&mut self.told, self.follower.alarms.len());
        &self.follower.alarms[before..]
    }

    /// All alarms in the order of their times.
    pub fn alarms(&self) -> &[EstimateAlarm] {
        &self.follower.alarms
    }
}

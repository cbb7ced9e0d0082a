//! Filter over a log: rows of the result, alarms with their explanation, and pauses.

use super::log::EstimateLog;
use super::rows::{EstimateAlarm, EstimateRow};
use super::words;
use crate::Watch;
use crate::analyses::shared::PoseRow;
use crate::at_rest::check_pose;
use crate::error::{Cancelled, NoSolution};
use crate::request::{self, EstimateRequest};
use crate::text::significant;
use anyhow::{Context, Result, anyhow};
use funicular::estimation::{
    Estimate, EstimatedState, EstimationError, EstimationSettings, Estimator, FaultAlarm, FaultHypothesis, FaultKind,
    FaultVerdict, SensorGroup, Slackness, UNDECIDED, UpdateNotes, chi2_quantile,
};
use funicular::robot::Robot;

/// Number of rows between two reports of the progress.
const REPORT_EVERY: usize = 500;

/// Deviation within which the centre of mass of a payload is told [m].
const CENTER_KNOWN: f64 = 0.1;

/// Deviations with which a length that slipped [m] and the error of a load cell [N] are unknown again.
const NEW_OFFSET: f64 = 5e-3;
const NEW_BIAS: f64 = 200.0;

/// Time after an alarm of the load cells at which it is explained [s]: the platform has moved, and what was before is
/// still kept.
const EXPLAINED_AFTER: f64 = 0.05;

/// Probability with which the first row of a log that fits is called one that does not.
const NO_FIT: f64 = 1e-6;

/// Run of a filter over a log.
pub(super) struct LogRun<'a> {
    robot: &'a Robot,
    log: &'a EstimateLog<'a>,
    pub(super) estimator: Estimator,
    every: f64,
    pub(super) rows: Vec<EstimateRow>,
    pub(super) alarms: Vec<EstimateAlarm>,
    pub(super) warnings: Vec<String>,
    /// Time of the last row of the result [s], and number of rows of the log that were not trusted.
    last: f64,
    pub(super) mistrusted: usize,
    /// True if the filter has lost the platform, until a row has the lengths of all cables.
    is_lost: bool,
    /// Alarm of the load cells that is not explained yet, and its time.
    unexplained: Option<(f64, FaultAlarm)>,
    /// Payload alarm whose size is not told yet.
    open_payload: Option<usize>,
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
            robot,
            log,
            estimator,
            every: request.every_s,
            rows: Vec::new(),
            alarms: Vec::new(),
            warnings: Vec::new(),
            last: f64::NEG_INFINITY,
            mistrusted: 0,
            is_lost: false,
            unexplained: None,
            open_payload: None,
        };
        run.estimator.set_false_alarms_per_hour(request.false_alarms_per_hour);
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
            let of = self.estimator.consistency(group);
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
        self.explain();
        self.close_payload();
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
            match self.estimator.update(&readings, step) {
                Ok(notes) => {
                    if self.unexplained.is_some_and(|(time, _)| now - time >= EXPLAINED_AFTER) {
                        self.explain();
                    }
                    self.note(now, &notes);
                    self.add_row(row, notes.is_trusted);
                    return Ok(());
                }
                Err(EstimationError::BadStep { .. }) => Some(format!("the log pauses for {} s", significant(step, 3))),
                Err(error) => Some(error.to_string()),
            }
        };
        self.is_lost = !self.log.has_lengths(row);
        if let Some(reason) = lost.filter(|_| !self.is_lost) {
            self.restart(row, &reason)?;
        }
        Ok(())
    }

    /// Begins anew from rest, with payload, offsets and biases as they were known.
    fn restart(&mut self, row: usize, reason: &str) -> Result<()> {
        let (now, pose) = (self.log.times[row], self.estimator.state().pose);
        let anew = self.estimator.rest_anew(&self.log.readings(row), Some(&pose));
        anew.map_err(|error| anyhow!(NoSolution(format!("at {now} s: {error}"))))?;
        let text = format!(
            "the estimate starts anew, as if the platform rested, with the payload and the errors of the sensors as \
             before: {}",
            reason.split_once(": start").map_or(reason, |(reason, _)| reason)
        );
        self.alarms.push(EstimateAlarm { t_s: now, fault: "restart", cable: None, size: None, size_std: None, text });
        self.add_row(row, true);
        Ok(())
    }

    /// Tells an alarm of an update, and lets the filter follow what changed.
    fn note(&mut self, now: f64, notes: &UpdateNotes) {
        let Some(alarm) = notes.alarm else { return };
        self.explain();
        self.close_payload();
        match (alarm.kind, alarm.cable) {
            (Some(FaultKind::Payload), _) => {
                self.open_payload = Some(self.alarms.len());
                self.push(now, "payload", None, None, "a payload was taken up or put down".to_owned());
            }
            (Some(FaultKind::Stuck), Some(i)) => {
                let text = format!("the load cell of cable {} repeats one reading", self.name(i));
                self.push(now, "stuck", Some(i), None, text);
            }
            _ => self.unexplained = Some((now, alarm)),
        }
    }

    /// Explains an alarm of the load cells by the readings around it.
    fn explain(&mut self) {
        let Some((now, alarm)) = self.unexplained.take() else { return };
        let Some(FaultVerdict { hypotheses, is_decided }) = self.estimator.explain() else { return };
        let found: Vec<FaultHypothesis> = hypotheses.into_iter().flatten().collect();
        let Some(first) = found.first() else { return };
        let near = if is_decided { 1 } else { found.iter().filter(|of| of.worse_by <= UNDECIDED).count() };
        let names = |of: &FaultHypothesis| words::fault(of, |i| self.name(i));
        let (fault, cable, text) = if is_decided {
            (words::fault_name(first.kind), first.cable, names(first))
        } else {
            let all: Vec<String> = found[..near].iter().map(names).collect();
            ("undecided", alarm.cable, format!("undecided between: {}", all.join("; or ")))
        };
        self.push(now, fault, cable, is_decided.then_some(Estimate { value: first.size, std: first.std }), text);

        // The number that changed is unknown again; otherwise the filter would go on with a wrong one.
        for of in &found[..near] {
            match (of.kind, of.cable) {
                (FaultKind::Slip | FaultKind::Cut, Some(i)) => self.estimator.reopen_offset(i, NEW_OFFSET),
                (FaultKind::LoadCell, Some(i)) => self.estimator.reopen_tension_bias(i, NEW_BIAS),
                _ => {}
            }
        }
    }

    fn push(&mut self, t_s: f64, fault: &'static str, cable: Option<usize>, size: Option<Estimate>, text: String) {
        let cable = cable.map(|i| self.name(i).to_owned());
        let (size, size_std) = (size.map(|of| of.value), size.map(|of| of.std));
        self.alarms.push(EstimateAlarm { t_s, fault, cable, size, size_std, text });
    }

    fn name(&self, i: usize) -> &'a str {
        &self.robot.cables[i].name
    }

    /// Tells the payload that the filter has after an alarm.
    fn close_payload(&mut self) {
        let (Some(k), Some(row)) = (self.open_payload.take(), self.rows.last()) else { return };
        let alarm = &mut self.alarms[k];
        let after = significant(row.t_s - alarm.t_s, 3);
        (alarm.size, alarm.size_std) = (Some(row.payload_kg), row.payload_std_kg);
        let std = row.payload_std_kg.map_or_else(String::new, |std| format!(" ± {}", significant(std, 2)));
        alarm.text = format!("{}: {}{std} kg, known {after} s later", alarm.text, significant(row.payload_kg, 4));
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
        let residuals = self.estimator.relative_innovations();
        let residuals = residuals.iter().all(|z| z.is_finite()).then(|| residuals.to_vec());
        let state = self.estimator.state();
        self.rows.push(row_of(now, &state, residuals, self.robot.cables.len(), is_trusted));
    }
}

/// Row of a state.
fn row_of(t_s: f64, of: &EstimatedState, residuals: Option<Vec<f64>>, cables: usize, is_trusted: bool) -> EstimateRow {
    let cables = &of.cables[..cables];
    let std = |of: &[Estimate; 3]| is_trusted.then(|| of.map(|part| part.std));
    let value = |of: &[Estimate; 3]| of.map(|part| part.value);
    EstimateRow {
        t_s,
        pose: PoseRow::of(&of.pose),
        position_std_m: is_trusted.then_some(of.position_std),
        rotation_std_deg: is_trusted.then(|| of.rotation_std.map(f64::to_degrees)),
        velocity_m_s: value(&of.velocity),
        velocity_std_m_s: std(&of.velocity),
        angular_velocity_rad_s: value(&of.angular_velocity),
        angular_velocity_std_rad_s: std(&of.angular_velocity),
        payload_kg: of.payload.value,
        payload_std_kg: is_trusted.then_some(of.payload.std),
        payload_center_m: of.payload_center(CENTER_KNOWN).filter(|_| is_trusted).map(|center| value(&center)),
        force_n: value(&of.force),
        force_std_n: std(&of.force),
        tensions_n: cables.iter().map(|cable| cable.tension.value).collect(),
        tensions_std_n: is_trusted.then(|| cables.iter().map(|cable| cable.tension.std).collect()),
        slack: (cables.iter())
            .map(|cable| match cable.slackness {
                _ if !is_trusted => "unknown",
                Slackness::Slack => "slack",
                Slackness::Taut => "taut",
                Slackness::Unknown => "unknown",
            })
            .collect(),
        residuals,
        is_trusted,
        rings: of.rings,
    }
}

/// Error of the start: lengths without an equilibrium have no solution, everything else has to change.
fn at_start(error: EstimationError) -> anyhow::Error {
    match error {
        EstimationError::NoStart(_) | EstimationError::NoBalance | EstimationError::Diverged => {
            NoSolution(format!("{error}; ⟪near_pose⟫ can say where the platform is")).into()
        }
        other => other.into(),
    }
}

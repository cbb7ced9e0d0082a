//! Filter with its alarms, their explanations, and what it does about them.

use super::rows::EstimateAlarm;
use super::words;
use crate::text::significant;
use funicular::estimation::{
    Estimate, EstimationError, Estimator, FaultAlarm, FaultHypothesis, FaultKind, FaultVerdict, SensorReadings,
    UNDECIDED, UpdateNotes,
};
use funicular::robot::Pose;

/// Time after an alarm of the load cells at which it is explained [s]: the platform has moved, and what was before is
/// still kept.
const EXPLAINED_AFTER: f64 = 0.05;

/// Payload with its deviation at a time, which an alarm tells later.
#[derive(Clone, Copy)]
pub(super) struct LatestPayload {
    pub(super) t_s: f64,
    pub(super) payload_kg: f64,
    pub(super) std_kg: Option<f64>,
}

/// Filter that explains its alarms and goes on.
pub(super) struct Follower {
    pub(super) estimator: Estimator,
    names: Vec<String>,
    pub(super) alarms: Vec<EstimateAlarm>,
    /// Alarm of the load cells that is not explained yet, and its time.
    unexplained: Option<(f64, FaultAlarm)>,
    /// Payload alarm whose size is not told yet.
    open_payload: Option<usize>,
    /// Payload of the last state that was told.
    pub(super) latest: Option<LatestPayload>,
}

impl Follower {
    pub(super) fn new(estimator: Estimator, names: Vec<String>) -> Self {
        Self { estimator, names, alarms: Vec::new(), unexplained: None, open_payload: None, latest: None }
    }

    /// Begins anew from rest, with payload, offsets and biases as they were known.
    ///
    /// # Errors
    /// Those of the filter, which is as it was then.
    pub(super) fn restart(
        &mut self,
        readings: &SensorReadings,
        near: Option<&Pose>,
        now: f64,
        reason: &str,
    ) -> Result<(), EstimationError> {
        self.explain();
        let here = self.estimator.state().pose;
        self.estimator.rest_anew(readings, Some(near.unwrap_or(&here)))?;
        let text = format!(
            "the estimate starts anew, as if the platform rested, with the payload and the errors of the sensors as \
             before: {}",
            reason.split_once(": start").map_or(reason, |(reason, _)| reason)
        );
        self.push(now, "restart", None, None, text);
        Ok(())
    }

    /// Takes the readings at the end of a step, tells an alarm, and lets the filter follow what changed.
    ///
    /// # Errors
    /// Those of the filter, which is as it was then.
    pub(super) fn take(
        &mut self,
        readings: &SensorReadings,
        now: f64,
        step: f64,
    ) -> Result<UpdateNotes, EstimationError> {
        let notes = self.estimator.update(readings, step)?;
        if self.unexplained.is_some_and(|(time, _)| now - time >= EXPLAINED_AFTER) {
            self.explain();
        }
        self.note(now, &notes);
        Ok(notes)
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
    pub(super) fn explain(&mut self) {
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
        found[..near].iter().for_each(|of| self.estimator.take_fault(of));
    }

    fn push(&mut self, t_s: f64, fault: &'static str, cable: Option<usize>, size: Option<Estimate>, text: String) {
        let cable = cable.map(|i| self.name(i).to_owned());
        let (size, size_std) = (size.map(|of| of.value), size.map(|of| of.std));
        self.alarms.push(EstimateAlarm { t_s, fault, cable, size, size_std, text });
    }

    fn name(&self, i: usize) -> &str {
        &self.names[i]
    }

    /// Tells the payload that the filter has after an alarm.
    pub(super) fn close_payload(&mut self) {
        let (Some(k), Some(latest)) = (self.open_payload.take(), self.latest) else { return };
        let alarm = &mut self.alarms[k];
        let after = significant(latest.t_s - alarm.t_s, 3);
        (alarm.size, alarm.size_std) = (Some(latest.payload_kg), latest.std_kg);
        let std = latest.std_kg.map_or_else(String::new, |std| format!(" ± {}", significant(std, 2)));
        alarm.text = format!("{}: {}{std} kg, known {after} s later", alarm.text, significant(latest.payload_kg, 4));
    }
}

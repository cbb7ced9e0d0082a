//! Vibration that the same lengths leave if the platform carries a payload: the command is made for the robot without
//! it.

use super::rows::unstrained;
use super::{Swing, check_rest, finite};
use crate::at_rest::AtRest;
use crate::error::{ErrorKind, NoSolution};
use crate::payload::carrying;
use crate::request::SettleRequest;
use crate::rows::rows;
use anyhow::{Result, anyhow};
use funicular::modes::{CommandedMotions, Decay, DecayingMotion, LengthCommand};
use funicular::statics;
use std::f64::consts::TAU;

rows! {
    /// Vibration with a payload.
    #[derive(Debug, Clone, Copy)]
    pub struct WithPayload {
        pub payload_kg: f64;
        /// Frequency of the mode with the largest amplitude.
        pub frequency_hz: f64;
        /// Sum of all amplitudes at the end of the command.
        pub amplitude_m: f64;
        /// Sum of all amplitudes at the end of the command without its shaper; absent without one.
        pub without_m: Option<f64>;
        /// Last time at which the point is at the tolerance, since the end of the command; absent if it never settles.
        pub settled_s: Option<f64>;
    }
}

impl Swing<'_> {
    /// Vibration after lengths, and after those without the shaper, with each payload of a request.
    ///
    /// # Errors
    /// A payload with which the lengths have no such rest; the message names it.
    pub(super) fn with_payloads(
        &self,
        request: &SettleRequest,
        lengths: &LengthCommand,
        without: Option<&LengthCommand>,
    ) -> Result<Vec<WithPayload>> {
        let row = |payload: &f64| {
            self.with_payload(request, lengths, without, *payload).map_err(|error| {
                let text = format!("with a payload of {payload} kg: {error}");
                match ErrorKind::of(&error) {
                    ErrorKind::NoSolution => NoSolution(text).into(),
                    _ => anyhow!(text),
                }
            })
        };
        request.robust_payload_kg.as_deref().unwrap_or_default().iter().map(row).collect()
    }

    fn with_payload(
        &self,
        request: &SettleRequest,
        lengths: &LengthCommand,
        without: Option<&LengthCommand>,
        payload_kg: f64,
    ) -> Result<WithPayload> {
        let AtRest { robot, equilibrium, .. } = self.at_rest;
        let required = robot.required.payload;
        let center_p = if required.max_mass > 0.0 { required.center_p } else { robot.platform.center_of_mass_p };
        let robot = carrying(robot, payload_kg, center_p);
        let at_end = unstrained(equilibrium);
        let equilibrium = statics::forward(&robot, &at_end, equilibrium.model, Some(&equilibrium.pose))?;
        let at_rest = AtRest { robot, equilibrium, requested_pose: None, rule: None, held_pose: None };
        check_rest(&at_rest)?;

        let (swing, _) = Swing::of(&at_rest, request, None)?;
        let motions = CommandedMotions::of(&swing.dynamics, &swing.modes, &swing.damped, &swing.arm_w)?;
        let decay = motions.after(lengths);
        let largest = decay.motions.iter().max_by(|a, b| a.size().total_cmp(&b.size()));
        Ok(WithPayload {
            payload_kg,
            frequency_hz: largest.map_or(0.0, |motion| motion.omega.norm() / TAU),
            amplitude_m: sum(&decay),
            without_m: without.map(|lengths| sum(&motions.after(lengths))),
            settled_s: finite(decay.settled(request.tolerance_m)),
        })
    }
}

fn sum(decay: &Decay) -> f64 {
    decay.motions.iter().map(DecayingMotion::size).sum()
}

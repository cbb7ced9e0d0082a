//! Frequency responses among the results: magnitude and phase.

use crate::analyses::result_groups::missing_option;
use crate::at_rest::AtRest;
use crate::measure::MeasureGroup;
use crate::request::{self, ResponsePoints, UncertaintyRequest};
use crate::signals::{Input, Output, response_unit};
use anyhow::{Result, anyhow, bail};
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{Complex, Vec3};
use funicular::response::{self, Port, Quantity, Signal};
use funicular::robot::Robot;
use funicular::statics::Equilibrium;
use std::f64::consts::{LN_10, PI};

/// Decibels of a factor e.
const DECIBELS: f64 = 20.0 / LN_10;

/// Degrees of a radian.
const DEGREES: f64 = 180.0 / PI;

/// Maximum number of frequencies.
const MAX_FREQUENCIES: usize = 10_000;

/// Response whose magnitudes and phases a request asks for.
#[derive(Debug, Clone)]
pub(crate) struct RequestedResponse {
    input: Input,
    output: Output,
    points: ResponsePoints,
    at_hz: Vec<f64>,
}

impl RequestedResponse {
    /// Reads the response of a request.
    ///
    /// # Errors
    /// A frequency or signal that is missing, a frequency that is negative or given twice, or a signal that the robot
    /// does not have.
    pub(super) fn new(request: &UncertaintyRequest, robot: &Robot) -> Result<Self> {
        let needs = |option: &str| missing_option(&MeasureGroup::Response, option);
        let at_hz = request.at_hz.clone().filter(|all| !all.is_empty()).ok_or_else(|| needs("at_hz"))?;
        let input = request::input(request.input.as_ref().ok_or_else(|| needs("input"))?)?;
        let output = request::output(request.output.as_ref().ok_or_else(|| needs("output"))?)?;
        if at_hz.len() > MAX_FREQUENCIES {
            bail!("⟪at_hz⟫: {} frequencies, and at most {MAX_FREQUENCIES} are possible: give fewer", at_hz.len());
        }
        for (i, hz) in at_hz.iter().enumerate() {
            request::check_not_negative("at_hz", *hz)?;
            if at_hz[..i].contains(hz) {
                bail!("⟪at_hz⟫: {hz} Hz is there twice: give every frequency once");
            }
            if *hz == 0.0 && output.quantity != Quantity::Displacement {
                bail!("⟪at_hz⟫: at 0 Hz nothing moves, and a response of zero has no decibels: leave 0 out");
            }
        }
        request.points.check()?;
        let requested = Self { input, output, points: request.points, at_hz };
        requested.signals(robot)?;
        Ok(requested)
    }

    /// Frequencies [Hz].
    pub(super) fn at_hz(&self) -> &[f64] {
        &self.at_hz
    }

    /// Names of input and output, and unit of the response.
    pub(super) fn names(&self) -> (&str, &str, String) {
        (&self.input.name, &self.output.name, response_unit(&self.input, &self.output))
    }

    /// Quantity of the output.
    pub(super) fn quantity(&self) -> Quantity {
        self.output.quantity
    }

    /// Input and output on a robot.
    pub(super) fn signals(&self, robot: &Robot) -> Result<[Signal; 2]> {
        let [from, to] = [self.points.input_point_m, self.points.output_point_m].map(|point| point.map(Vec3::from));
        Ok([self.input.signal(robot, from)?, self.output.signal(robot, to)?])
    }

    /// Values at the frequencies for a linearised robot.
    fn values(&self, robot: &Robot, rest: &Equilibrium, dynamics: &Dynamics) -> Result<Vec<Complex>> {
        let mut ports = Port::all(robot, rest, dynamics, &self.signals(robot)?, true)?;
        let output = ports.split_off(1).into_iter().map(|port| (port, self.output.quantity)).collect::<Vec<_>>();
        let mut rows = response::matrix(dynamics, &self.at_hz, &ports, &output)?;
        rows.pop().ok_or_else(|| anyhow!("the response has no value"))
    }
}

/// Change of magnitude and phase: logarithm of the ratio of a response to the response of the undisturbed robot.
pub(super) struct ResponseChange(pub(super) Complex);

impl ResponseChange {
    /// ResponseChange of the magnitude [dB].
    pub(super) fn decibels(&self) -> f64 {
        DECIBELS * self.0.re
    }

    /// ResponseChange of the phase [degrees].
    pub(super) fn degrees(&self) -> f64 {
        DEGREES * self.0.im
    }
}

/// Responses of the undisturbed robot.
#[derive(Debug, Clone)]
pub(super) struct Responses {
    pub(super) requested: RequestedResponse,
    /// Values, one per frequency.
    pub(super) values: Vec<Complex>,
}

impl Responses {
    /// Computes the responses of an equilibrium.
    ///
    /// # Errors
    /// An undamped resonance at a frequency, or a response of zero.
    pub(super) fn new(requested: &RequestedResponse, at_rest: &AtRest, dynamics: &Dynamics) -> Result<Self> {
        let AtRest { robot, equilibrium, .. } = &*at_rest.vibrating();
        let values = requested.values(robot, equilibrium, dynamics)?;
        if let Some((hz, _)) = requested.at_hz.iter().zip(&values).find(|(_, value)| value.norm() < f64::MIN_POSITIVE) {
            bail!(
                "the response at {hz} Hz is zero, and has no decibels: choose another ⟪input⟫ or ⟪output⟫, or leave \
                 this frequency out"
            );
        }
        Ok(Self { requested: requested.clone(), values })
    }

    /// Number of a frequency.
    pub(super) fn place(&self, hz: f64) -> Option<usize> {
        self.requested.at_hz.iter().position(|other| other.to_bits() == hz.to_bits())
    }

    /// Magnitude at the frequency with this number [dB].
    pub(super) fn decibels(&self, place: usize) -> f64 {
        DECIBELS * self.values[place].norm().ln()
    }

    /// Phase at the frequency with this number [degrees].
    pub(super) fn degrees(&self, place: usize) -> f64 {
        DEGREES * self.values[place].arg()
    }

    /// Changes of the responses of another robot, one per frequency; phases change by at most half a turn. `None` for a
    /// robot without responses.
    pub(super) fn changes(
        &self,
        robot: &Robot,
        rest: &Equilibrium,
        linearisation: Linearisation,
    ) -> Option<Vec<ResponseChange>> {
        let highest_hz = self.requested.at_hz.iter().copied().fold(0.0, f64::max);
        let dynamics = Dynamics::about(robot, rest, linearisation, highest_hz).ok()?;
        let values = self.requested.values(robot, rest, &dynamics).ok()?;
        Some(
            values
                .iter()
                .zip(&self.values)
                .map(|(value, undisturbed)| ResponseChange((value / undisturbed).ln()))
                .collect(),
        )
    }
}

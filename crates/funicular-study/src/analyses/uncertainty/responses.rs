//! Frequency responses among the results: magnitude and phase, their derivatives, and the test of where they are linear.

use super::UncertainResponse;
use super::linear::{Along, Row};
use super::results::{NominalModes, ResultKind};
use crate::analyses::frf;
use crate::at_rest::AtRest;
use crate::request::{self, ResponsePoints, UncertaintyRequest};
use crate::signals::{Input, Output};
use anyhow::{Result, anyhow, bail};
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::gradient::Gradients;
use funicular::math::{Complex, Vec3};
use funicular::response::{self, Port, Quantity, Signal};
use funicular::robot::Robot;
use funicular::statics::Equilibrium;
use std::f64::consts::{LN_10, PI, TAU};

/// Decibels of a factor e.
const DECIBELS: f64 = 20.0 / LN_10;

/// Degrees of a radian.
const DEGREES: f64 = 180.0 / PI;

/// Deviations within which a response must be nearly linear. Two let a phase of 0.2° pass whose deviation a weak mode
/// increases by 16 %.
const DEVIATIONS: f64 = 3.0;

/// Share of the linear change that the change beyond it may have there. A result z + a z² of a standard normal z has
/// a = 0.1 then: its deviation is 1 % more than the linear one, and its mean is off by 0.1 deviations.
const BEYOND_LINEAR: f64 = 0.3;

/// Maximum number of modes whose distance from the frequencies is tested.
const MAX_MODES: usize = 5000;

/// Maximum number of frequencies.
const MAX_FREQUENCIES: usize = 10_000;

/// Responses that a request asks for.
#[derive(Debug, Clone)]
pub(crate) struct Asked {
    input: Input,
    output: Output,
    points: ResponsePoints,
    at_hz: Vec<f64>,
}

impl Asked {
    /// Reads the responses of a request.
    ///
    /// # Errors
    /// A missing frequency or signal, a frequency that is negative or there twice, or a signal that the robot does not have.
    pub(super) fn new(request: &UncertaintyRequest, robot: &Robot) -> Result<Self> {
        let needs = |key: &str| anyhow!("`response` needs ⟪{key}⟫");
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
        let asked = Self { input, output, points: request.points, at_hz };
        asked.signals(robot)?;
        Ok(asked)
    }

    /// Frequencies [Hz].
    pub(super) fn at_hz(&self) -> &[f64] {
        &self.at_hz
    }

    /// Description for the results.
    pub(super) fn description(&self) -> UncertainResponse {
        UncertainResponse {
            input: self.input.name.clone(),
            output: self.output.name.clone(),
            unit: frf::unit(&self.input, &self.output),
        }
    }

    /// Input and output on a robot.
    fn signals(&self, robot: &Robot) -> Result<[Signal; 2]> {
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

/// Logarithm of the ratio of a response to that of the undisturbed robot: change of magnitude and phase.
pub(super) struct Change(Complex);

impl Change {
    /// Change of a result, in its unit.
    pub(super) fn of(&self, kind: ResultKind) -> f64 {
        match kind {
            ResultKind::Phase(_) => DEGREES * self.0.im,
            _ => DECIBELS * self.0.re,
        }
    }
}

/// Responses of the undisturbed robot.
#[derive(Debug, Clone)]
pub(super) struct Responses {
    asked: Asked,
    values: Vec<Complex>,
}

impl Responses {
    /// Computes the responses of an equilibrium.
    ///
    /// # Errors
    /// An undamped resonance at a frequency, or a response of zero.
    pub(super) fn new(asked: &Asked, at_rest: &AtRest, dynamics: &Dynamics) -> Result<Self> {
        let values = asked.values(&at_rest.robot, &at_rest.equilibrium, dynamics)?;
        if let Some((hz, _)) = asked.at_hz.iter().zip(&values).find(|(_, value)| value.norm() < f64::MIN_POSITIVE) {
            bail!(
                "the response at {hz} Hz is zero, and has no decibels: choose another ⟪input⟫ or ⟪output⟫, or leave this \
                 frequency out"
            );
        }
        Ok(Self { asked: asked.clone(), values })
    }

    /// Number of a frequency.
    pub(super) fn place(&self, hz: f64) -> Option<usize> {
        self.asked.at_hz.iter().position(|other| other.to_bits() == hz.to_bits())
    }

    /// Value of a result at the frequency with this number.
    pub(super) fn value(&self, kind: ResultKind, place: usize) -> Option<f64> {
        let value = self.values.get(place)?;
        Some(match kind {
            ResultKind::Phase(_) => DEGREES * value.arg(),
            _ => DECIBELS * value.norm().ln(),
        })
    }

    /// Changes of the responses of another robot, one per frequency; phases change by at most half a turn. `None` for a
    /// robot without responses.
    pub(super) fn changes(
        &self,
        robot: &Robot,
        rest: &Equilibrium,
        linearisation: Linearisation,
    ) -> Option<Vec<Change>> {
        let highest_hz = self.asked.at_hz.iter().copied().fold(0.0, f64::max);
        let dynamics = Dynamics::about(robot, rest, linearisation, highest_hz).ok()?;
        let values = self.asked.values(robot, rest, &dynamics).ok()?;
        Some(values.iter().zip(&self.values).map(|(value, undisturbed)| Change((value / undisturbed).ln())).collect())
    }
}

/// Adds the derivatives of responses, or the reason why they have none.
pub(super) fn differentiate(
    rows: &mut [Row],
    of: &Responses,
    robot: &Robot,
    gradients: &Gradients,
    modes: &NominalModes,
    along: &Along,
) {
    let derivatives = || {
        let directions = along.directions()?;
        let reason = |error: &dyn std::fmt::Display| error.to_string();
        let [from, to] = of.asked.signals(robot).map_err(|error| reason(&error))?;
        let vibration = gradients.vibration(&modes.dynamics).map_err(|error| reason(&error))?;
        let to = (to, of.asked.output.quantity);
        vibration.responses(&[from], &[to], &of.asked.at_hz, &directions).map_err(|error| reason(&error))
    };
    let found: Result<Vec<_>, String> = derivatives();
    for row in rows {
        let Some(place) = row.kind.at_hz().and_then(|hz| of.place(hz)) else { continue };
        match &found {
            Ok(pairs) => {
                let relative = pairs[0][place].along.iter().map(|change| Change(change / of.values[place]));
                row.derivatives = Some(relative.map(|change| change.of(row.kind) + 0.0).collect());
            }
            Err(reason) => row.doubt = Some(reason.clone()),
        }
    }
}

/// Mode near the frequencies of a response.
struct NearMode {
    number: usize,
    frequency_hz: f64,
    /// Square of the complex angular frequency [rad²/s²].
    square: Complex,
    /// Distance that the deviations of the real part of this square reach [rad²/s²].
    reach: f64,
    /// Product of the mode at input and output over the modal mass.
    residue: f64,
}

/// Tests whether responses are nearly linear in the deviations: a natural frequency may come near, or the change may not be
/// small against the response.
///
/// # References
/// docs/theory.md, equation (94d1).
pub(super) fn test(
    rows: &mut [Row],
    of: &Responses,
    robot: &Robot,
    gradients: &Gradients,
    modes: &NominalModes,
    along: &Along,
) {
    let near = match near_modes(of, robot, gradients, modes, along) {
        Ok(near) => near,
        Err(reason) => {
            for row in rows.iter_mut().filter(|row| row.kind.at_hz().is_some()) {
                row.doubt.get_or_insert_with(|| reason.clone());
            }
            return;
        }
    };

    let derivatives: Vec<(ResultKind, Option<Vec<f64>>)> =
        rows.iter().map(|row| (row.kind, row.derivatives.clone())).collect();
    for row in rows {
        let (Some(hz), None) = (row.kind.at_hz(), &row.doubt) else { continue };
        let Some(place) = of.place(hz) else { continue };
        // Linear relative change: of the magnitude, and of the phase in radians.
        let relative = |kind: ResultKind| {
            let own = derivatives.iter().find(|(other, _)| *other == kind).and_then(|(_, own)| own.as_deref());
            along.reach(own.unwrap_or_default(), DEVIATIONS) / Change(Complex::new(1.0, 1.0)).of(kind)
        };
        let (magnitude, phase) = (relative(ResultKind::Magnitude(hz)), relative(ResultKind::Phase(hz)));
        let is_phase = matches!(row.kind, ResultKind::Phase(_));
        let linear = if is_phase { phase } else { magnitude };
        let part = |value: Complex| if is_phase { value.im.abs() } else { value.re.abs() };

        // Beyond the linear change: second order of the logarithm, and the modes that come nearer.
        let of_logarithm = if is_phase { magnitude * phase } else { 0.5 * (magnitude * magnitude + phase * phase) };
        let omega = TAU * hz;
        let factor = match of.asked.output.quantity {
            Quantity::Displacement => Complex::new(1.0, 0.0),
            Quantity::Velocity => Complex::new(0.0, omega),
            Quantity::Acceleration => Complex::new(-omega * omega, 0.0),
        };
        let mut worst: Option<(f64, &NearMode)> = None;
        let mut beyond = of_logarithm;
        for mode in &near {
            let of_mode = mode.beyond_linear(omega, factor / of.values[place], part);
            beyond += of_mode;
            if worst.is_none_or(|(before, _)| of_mode > before) {
                worst = Some((of_mode, mode));
            }
        }
        if beyond > BEYOND_LINEAR * linear {
            row.doubt = Some(match worst.filter(|(of_mode, _)| *of_mode > of_logarithm) {
                Some((_, mode)) => format!(
                    "mode {} at {} Hz may come near the frequency of the response",
                    mode.number,
                    crate::text::significant(mode.frequency_hz, 4)
                ),
                None => format!("the response changes too much within {DEVIATIONS} deviations for a linear change"),
            });
        }
    }
}

impl NearMode {
    /// Change of the mode's part in a response beyond the linear one, if its frequency shifts as far as the deviations
    /// reach, to either side. `factor` multiplies the displacement; `part` is the magnitude of a part of a complex number.
    fn beyond_linear(&self, omega: f64, factor: Complex, part: impl Fn(Complex) -> f64) -> f64 {
        if self.residue == 0.0 {
            return 0.0;
        }
        // Nothing is lost at rest.
        let square = if omega > 0.0 { self.square } else { self.square.re.into() };
        let distance = square - omega * omega;
        let own = factor * self.residue / distance;
        let beyond = |shift: f64| {
            // 1/(1 − ε) is 1 + ε + ε²/(1 − ε).
            let ratio = Complex::from(shift) / distance;
            part(own * ratio * ratio / (Complex::new(1.0, 0.0) - ratio))
        };
        if self.reach < distance.norm() {
            beyond(self.reach).max(beyond(-self.reach))
        } else {
            // The frequency may pass: the part is then as large as its peak.
            factor.norm() * self.residue.abs() / self.square.im.abs()
        }
    }
}

/// Modes up to somewhat beyond the highest frequency, with the deviations of their frequencies.
fn near_modes(
    of: &Responses,
    robot: &Robot,
    gradients: &Gradients,
    modes: &NominalModes,
    along: &Along,
) -> Result<Vec<NearMode>, String> {
    let signals = of.asked.signals(robot).map_err(|error| error.to_string())?;
    let [Some(from), Some(to)] = signals.map(|signal| signal.platform_vector(&gradients.equilibrium().pose)) else {
        return Err("whether a response is linear is tested for signals on the platform only".to_owned());
    };
    let list = &modes.found.modes;
    if list.len() > MAX_MODES {
        return Err(format!(
            "{} natural frequencies lie below {} Hz, and whether the response is linear is tested for at most {MAX_MODES}",
            list.len(),
            crate::text::significant(modes.found.below_hz, 4)
        ));
    }
    let vibration = gradients.vibration(&modes.dynamics).map_err(|error| error.to_string())?;
    let near = |(i, mode): (usize, &funicular::modes::Mode)| {
        let omega = TAU * mode.frequency_hz;
        // A mode that shares its frequency is taken as a single one: its entry of the block.
        let gradient = vibration.block(&[mode]).remove(0).remove(0);
        let by_hz = along.of(&gradient)?;
        let at = |vector: &funicular::math::Vec6| (0..6).map(|k| vector[k] * mode.shape[k]).sum::<f64>();
        Ok(NearMode {
            number: i + 1,
            frequency_hz: mode.frequency_hz,
            square: Complex::new(1.0, 2.0 * mode.damping_ratio) * omega * omega,
            reach: 2.0 * omega * TAU * along.reach(&by_hz, DEVIATIONS),
            residue: at(&from) * at(&to) / mode.modal_mass,
        })
    };
    list.iter().enumerate().map(near).collect()
}

//! Derivatives of frequency responses, and the test of whether responses are nearly linear.

use super::responses::{ResponseChange, Responses};
use super::results::NominalModes;
use super::row::{Along, Row};
use crate::measure::{Measure, ResponsePart};
use funicular::gradient::Gradients;
use funicular::math::{Complex, Vec6};
use funicular::modes::Mode;
use funicular::robot::Robot;
use std::f64::consts::TAU;

/// Range within which a response must be nearly linear, in standard deviations. With two, a phase of 0.2° passed the
/// test although a weak mode increased its deviation by 16 %.
const DEVIATIONS: f64 = 3.0;

/// Maximum nonlinear part of the change at the ends of this range, relative to the linear part. For a result z + a z²
/// of a standard normal z it means a = 0.1: the deviation is 1 % above the linear one, and the mean is off by 0.1
/// deviations.
const MAX_NONLINEAR: f64 = 0.3;

/// Maximum number of modes for which responses are tested.
const MAX_MODES: usize = 5000;

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
        let [from, to] = of.requested.signals(robot).map_err(|error| reason(&error))?;
        let vibration = gradients.vibration(&modes.dynamics).map_err(|error| reason(&error))?;
        let to = (to, of.requested.quantity());
        vibration.responses(&[from], &[to], of.requested.at_hz(), &directions).map_err(|error| reason(&error))
    };
    let found: Result<Vec<_>, String> = derivatives();

    for row in rows {
        let Some(place) = row.kind.at_hz().and_then(|hz| of.place(hz)) else { continue };
        match &found {
            Ok(pairs) => {
                let relative =
                    pairs[0][place].along.iter().map(|change| change_of(row.kind, change / of.values[place]) + 0.0);
                row.derivatives = Some(relative.collect());
            }
            Err(reason) => row.sampling_reason = Some(reason.clone()),
        }
    }
}

/// ResponseChange of a result, in its unit, by a relative change of the response.
fn change_of(kind: Measure, relative: Complex) -> f64 {
    let change = ResponseChange(relative);
    if matches!(kind, Measure::Response(_, ResponsePart::Phase)) { change.degrees() } else { change.decibels() }
}

/// Mode near the frequencies of a response.
struct NearMode {
    number: usize,
    frequency_hz: f64,
    /// Square of the complex angular frequency [rad²/s²].
    square: Complex,
    /// Maximum change of the real part of this square within the deviations [rad²/s²].
    reach: f64,
    /// Product of the mode at input and output over the modal mass.
    residue: f64,
}

/// Tests whether responses are nearly linear within the deviations. They are not where a natural frequency may come
/// near, or where the change is not small against the response.
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
                row.sampling_reason.get_or_insert_with(|| reason.clone());
            }
            return;
        }
    };

    let derivatives: Vec<(Measure, Option<Vec<f64>>)> =
        rows.iter().map(|row| (row.kind, row.derivatives.clone())).collect();
    for row in rows {
        let (Some(hz), None) = (row.kind.at_hz(), &row.sampling_reason) else { continue };
        let Some(place) = of.place(hz) else { continue };
        // Linear relative change of the magnitude, and change of the phase in radians.
        let relative = |kind: Measure| {
            let own = derivatives.iter().find(|(other, _)| *other == kind).and_then(|(_, own)| own.as_deref());
            along.reach(own.unwrap_or_default(), DEVIATIONS) / change_of(kind, Complex::new(1.0, 1.0))
        };
        let (magnitude, phase) = (
            relative(Measure::Response(hz, ResponsePart::Magnitude)),
            relative(Measure::Response(hz, ResponsePart::Phase)),
        );
        let is_phase = matches!(row.kind, Measure::Response(_, ResponsePart::Phase));
        let linear = if is_phase { phase } else { magnitude };
        let part = |value: Complex| if is_phase { value.im.abs() } else { value.re.abs() };

        // The nonlinear part: second order of the logarithm, and the modes that come nearer.
        let of_logarithm = if is_phase { magnitude * phase } else { 0.5 * (magnitude * magnitude + phase * phase) };
        let omega = TAU * hz;
        let factor = of.requested.quantity().factor(omega);
        let mut worst: Option<(f64, &NearMode)> = None;
        let mut beyond = of_logarithm;
        for mode in &near {
            let of_mode = mode.beyond_linear(omega, factor / of.values[place], part);
            beyond += of_mode;
            if worst.is_none_or(|(before, _)| of_mode > before) {
                worst = Some((of_mode, mode));
            }
        }
        if beyond > MAX_NONLINEAR * linear {
            row.sampling_reason = Some(match worst.filter(|(of_mode, _)| *of_mode > of_logarithm) {
                Some((_, mode)) => mode.may_come_near(),
                None => format!("the response changes too much within {DEVIATIONS} deviations for a linear change"),
            });
        }
    }
}

impl NearMode {
    /// Sentence on a mode that makes a response nonlinear.
    fn may_come_near(&self) -> String {
        format!(
            "mode {} at {} Hz may come near the frequency of the response",
            self.number,
            crate::text::significant(self.frequency_hz, 4)
        )
    }

    /// ResponseChange of the mode's part in a response beyond the linear one, if its frequency shifts as far as the
    /// deviations reach, to either side. `factor` multiplies the displacement; `part` is the magnitude of a part of a
    /// complex number.
    fn beyond_linear(&self, omega: f64, factor: Complex, part: impl Fn(Complex) -> f64) -> f64 {
        if self.residue == 0.0 {
            return 0.0;
        }
        // A static response has no damping.
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
    let signals = of.requested.signals(robot).map_err(|error| error.to_string())?;
    let [Some(from), Some(to)] = signals.map(|signal| signal.platform_vector(&gradients.equilibrium().pose)) else {
        return Err("whether a response is linear is tested for signals on the platform only".to_owned());
    };
    let list = &modes.found.modes;
    if list.len() > MAX_MODES {
        return Err(format!(
            "{} natural frequencies lie below {} Hz, and whether the response is linear is tested for at most \
             {MAX_MODES}",
            list.len(),
            crate::text::significant(modes.found.below_hz, 4)
        ));
    }

    let vibration = gradients.vibration(&modes.dynamics).map_err(|error| error.to_string())?;
    let near = |(i, mode): (usize, &Mode)| {
        let omega = TAU * mode.frequency_hz;
        // A mode that shares its frequency is taken as a single one: its entry of the block.
        let gradient = vibration.block(&[mode]).remove(0).remove(0);
        let by_hz = along.of(&gradient)?;
        let at = |vector: &Vec6| (0..6).map(|k| vector[k] * mode.shape[k]).sum::<f64>();
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

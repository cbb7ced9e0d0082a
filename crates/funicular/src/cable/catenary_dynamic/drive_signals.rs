//! Signals of the drive of a cable: commanded length, force of the motor, motions of drum and motor, tension.

use super::{CatenaryDynamicEnd, DriveAt, DriveLosses};
use crate::drive::DriveChain;
use crate::math::Complex;

/// Quantity of a cable's drive in a response.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DriveSignal {
    /// Commanded unstrained length, paid out [m]; an input.
    Length,
    /// Force on the drum at the cable [N] as an input, motion of the cable at the drum [m] as an output; both towards
    /// the wheel.
    Drum,
    /// Force of the motor at the cable [N] as an input, motion of the motor at the cable [m] as an output; both pay out.
    Motor,
    /// Tension of the cable at the platform [N]; an output.
    Tension,
}

impl DriveSignal {
    /// All quantities.
    pub const ALL: [Self; 4] = [Self::Length, Self::Drum, Self::Motor, Self::Tension];

    /// Name before the name of the cable, as in `length:3`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Length => "length",
            Self::Drum => "drum",
            Self::Motor => "motor",
            Self::Tension => "tension",
        }
    }

    /// True if it can be an input.
    pub fn is_input(self) -> bool {
        self != Self::Tension
    }

    /// True if it can be an output.
    pub fn is_output(self) -> bool {
        self != Self::Length
    }
}

/// Direction of a cable in its plane and its stretch, at both ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct EndDirections {
    /// Direction from the platform into the cable: components (horizontal, up).
    pub(crate) from_platform: [f64; 2],
    /// Direction at the far end towards the platform.
    pub(crate) to_platform: [f64; 2],
    /// Stretch at the far end.
    pub(crate) stretch: f64,
}

impl CatenaryDynamicEnd {
    /// Vector of a signal at ω [rad/s] in (e, n, b): the force on the held platform end per unit of an input, and by
    /// reciprocity the output per motion of the platform end. `None` if the cable has no such signal.
    pub(crate) fn signal_vector(&self, signal: DriveSignal, omega: f64) -> Option<[Complex; 3]> {
        let zero = Complex::new(0.0, 0.0);
        if signal == DriveSignal::Tension {
            let k = self.damped(omega);
            let [h, v] = self.directions.from_platform;
            return Some([-(k.axial * h + k.coupling * v), -(k.coupling * h + k.normal * v), zero]);
        }
        let square = self.square(omega);
        let Some(chain) = self.chain() else {
            // The drum is rigid and holds the far end: the cable that is paid out moves it towards the platform.
            let ([h, v], family) = (self.directions.to_platform, &self.cable.in_plane);
            let towards =
                |i: usize| -self.directions.stretch * (family.entry(i, 2, square) * h + family.entry(i, 3, square) * v);
            return (signal == DriveSignal::Length).then(|| [towards(0), towards(1), zero]);
        };

        let force = self.forces_of(chain, signal, omega)?;
        let (motions, losses) = self.motions_with_losses(omega)?;
        let moved = motions.moved(&losses.values_along());
        let sum = |s: usize| (0..force.len()).map(|j| moved[j][s] * force[j]).sum();
        Some([sum(0), sum(1), zero])
    }

    /// Output per input of signals of this cable, its platform end held, at ω [rad/s]. `None` if the cable has no such
    /// signals.
    pub(crate) fn signal_response(&self, input: DriveSignal, output: DriveSignal, omega: f64) -> Option<Complex> {
        if output == DriveSignal::Tension {
            let [h, v] = self.directions.from_platform;
            let [x, y, _] = self.signal_vector(input, omega)?;
            return Some(x * h + y * v);
        }
        let chain = self.chain()?;
        let (force, row) = (self.forces_of(chain, input, omega)?, self.forces_of(chain, output, omega)?);
        let (motions, losses) = self.motions_with_losses(omega)?;
        let free: Vec<Complex> =
            (0..force.len()).map(|i| (0..force.len()).map(|j| motions.receptance[(i, j)] * force[j]).sum()).collect();
        let held = motions.freed(&losses.values_along(), &free);
        Some(row.iter().zip(&held).map(|(row, moved)| row * moved).sum())
    }

    fn motions_with_losses(&self, omega: f64) -> Option<(DriveAt<2>, DriveLosses)> {
        let motions = self.drive_at(self.square(omega), &(0..0, 0..0))?;
        Some((motions.along, self.beyond_undamped(omega.into(), 1.0)))
    }

    /// Forces on the motions of the drive per unit of an input [N/m or 1]; for drum and motor also the row of their
    /// motion.
    fn forces_of(&self, chain: &DriveChain, signal: DriveSignal, omega: f64) -> Option<Vec<Complex>> {
        Some(DriveForce::of(chain, signal)?.at(omega, self.square(omega)))
    }
}

/// Force on the motions of a drive per unit of an input, or the row of the motion of drum or motor:
/// `(still + iω rate) e^{−iωτ} + ω_c² square`.
pub(super) struct DriveForce {
    /// Constant part [N/m or 1].
    pub(super) still: Vec<f64>,
    /// Force per rate of the input, by the speed gain of a control [N s/m].
    pub(super) rate: Vec<f64>,
    /// Force by the mass of a cable whose end is moved [kg].
    pub(super) square: Vec<f64>,
    /// Delay τ of the control [s].
    delay: f64,
}

impl DriveForce {
    /// Force of a signal on a chain; `None` without such a signal.
    pub(super) fn of(chain: &DriveChain, signal: DriveSignal) -> Option<Self> {
        let zeros = || vec![0.0; chain.len()];
        let mut force = Self { still: zeros(), rate: zeros(), square: zeros(), delay: 0.0 };
        match (signal, &chain.motor) {
            (DriveSignal::Drum, _) => {
                let drum = chain.drum?;
                force.still[drum.motion] = drum.factor;
            }
            (DriveSignal::Motor, motor) => {
                let place = (*motor)?.place;
                force.still[place.motion] = place.factor;
            }
            (DriveSignal::Length, Some(motor)) => {
                let (servo, place) = (motor.servo?, motor.place);
                force.still[place.motion] = servo.position_gain * chain.stretch_drum * place.factor;
                force.rate[place.motion] = servo.speed_gain * chain.stretch_drum * place.factor;
                force.delay = servo.delay;
            }
            (DriveSignal::Length, None) => {
                (force.still, force.square) = chain.by_length.iter().copied().unzip();
            }
            (DriveSignal::Tension, _) => return None,
        }
        Some(force)
    }

    /// Force at ω [rad/s] with `square` = ω_c².
    fn at(&self, omega: f64, square: Complex) -> Vec<Complex> {
        let delayed = Complex::from_polar(1.0, -omega * self.delay);
        let parts = self.still.iter().zip(&self.rate).zip(&self.square);
        parts.map(|((still, rate), moved)| Complex::new(*still, omega * rate) * delayed + square * *moved).collect()
    }
}

//! Signals of the drive of a cable: commanded length, force of the motor, motions of drum and motor, tension.

use super::{CatenaryDynamicEnd, DriveAt, DriveLosses, NearRanges};
use crate::drive::{DriveChain, Place};
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
        if signal == DriveSignal::Tension {
            let k = self.damped(omega);
            let [h, v] = self.directions.from_platform;
            let [along, normal] = k.across;
            return Some([
                -(k.axial * h + k.coupling * v),
                -(k.coupling * h + k.normal * v),
                -(along * h + normal * v),
            ]);
        }
        let square = self.square(omega);
        let Some(chain) = self.chain() else {
            // The drum is rigid and holds the far end: the cable that is paid out moves it towards the platform.
            let ([h, v], family) = (self.directions.to_platform, &self.cable.in_plane);
            let towards =
                |i: usize| -self.directions.stretch * (family.entry(i, 2, square) * h + family.entry(i, 3, square) * v);
            let known = signal == DriveSignal::Length && self.cable.coupled.is_none();
            return known.then(|| [towards(0), towards(1), Complex::new(0.0, 0.0)]);
        };

        let force = self.forces_of(chain, signal, omega)?;
        let (motions, losses) = self.motions_with_losses(omega)?;
        let moved = motions.moved(&losses.values());
        Some(std::array::from_fn(|s| force.iter().zip(&moved).map(|(force, moved)| moved[s] * force).sum()))
    }

    /// Output per input of signals of this cable, its platform end held, at ω [rad/s]. `None` if the cable has no such
    /// signals.
    pub(crate) fn signal_response(&self, input: DriveSignal, output: DriveSignal, omega: f64) -> Option<Complex> {
        if output == DriveSignal::Tension {
            return Some(self.tension_of(&self.signal_vector(input, omega)?));
        }
        let chain = self.chain()?;
        let (force, row) = (self.forces_of(chain, input, omega)?, self.forces_of(chain, output, omega)?);
        let (motions, losses) = self.motions_with_losses(omega)?;
        let count = losses.0.len();
        let free: Vec<Complex> = (0..count)
            .map(|i| force.iter().enumerate().map(|(j, force)| motions.receptance[(i, j)] * force).sum())
            .collect();
        let held = motions.freed(&losses.values(), &free);
        Some(row.iter().zip(&held).map(|(row, moved)| row * moved).sum())
    }

    /// Tension at the platform for a force on the held platform end in (e, n, b).
    pub(super) fn tension_of(&self, [x, y, _]: &[Complex; 3]) -> Complex {
        let [h, v] = self.directions.from_platform;
        x * h + y * v
    }

    pub(super) fn motions_with_losses(&self, omega: f64) -> Option<(DriveAt, DriveLosses)> {
        let motions = self.drive_at(self.square(omega), &NearRanges::default())?;
        Some((motions, self.beyond_undamped(omega.into(), 1.0)))
    }

    /// Forces on the motions of the drive per unit of an input [N/m or 1]; for drum and motor also the row of their
    /// motion.
    pub(super) fn forces_of(&self, chain: &DriveChain, signal: DriveSignal, omega: f64) -> Option<Vec<Complex>> {
        let mut force = vec![Complex::new(0.0, 0.0); chain.len()];
        let mut at = |place: Place, factor: Complex| force[place.motion] += factor * place.factor;
        match signal {
            DriveSignal::Drum => at(chain.drum?, 1.0.into()),
            DriveSignal::Motor => at(chain.motor?.place, 1.0.into()),
            DriveSignal::Tension => return None,
            DriveSignal::Length => {
                if let Some(motor) = &chain.motor {
                    at(motor.place, motor.servo?.control(omega.into()).0 * chain.stretch_drum);
                } else {
                    let square = self.square(omega);
                    for (force, (still, moving)) in force.iter_mut().zip(&chain.by_length) {
                        *force = still + square * *moving;
                    }
                }
            }
        }
        Some(force)
    }
}

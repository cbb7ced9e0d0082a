//! Aerodynamic damping of the natural modes, and their resonances in gusts.

use super::cable::Drag;
use super::{GustError, Setting};
use crate::dynamics::Dynamics;
use crate::math::{Vec3, Vec6};
use crate::modes::Mode;
use crate::response::along;
use crate::robot::Robot;
use crate::statics::Equilibrium;
use std::f64::consts::TAU;

/// Peak that a mode makes in the spectra of the response to gusts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GustResonance {
    /// Natural frequency of the mode [Hz].
    pub frequency_hz: f64,
    /// Damping ratio of the mode with that by the mean wind; the half width of the peak over its frequency.
    pub damping_ratio: f64,
}

impl GustResonance {
    /// Resonances of all modes, whose damping by the mean wind is given in their order.
    pub fn of_modes(modes: &[Mode], aerodynamic: &[f64]) -> Vec<Self> {
        let of = |(mode, by_wind): (&Mode, &f64)| Self {
            frequency_hz: mode.frequency_hz,
            damping_ratio: mode.damping_ratio + by_wind,
        };
        modes.iter().zip(aerodynamic).map(of).collect()
    }
}

/// Damping ratio that the mean wind gives each mode by the drag of cables and platform on their motion, of first order.
/// The modes belong to the dynamics.
///
/// # Errors
/// [`GustError::CableMotion`]: a model without motion along the cables.
///
/// # References
/// docs/theory.md, equation (49j).
pub fn aerodynamic_damping_ratio(
    robot: &Robot,
    equilibrium: &Equilibrium,
    dynamics: &Dynamics,
    modes: &[Mode],
) -> Result<Vec<f64>, GustError> {
    let setting = Setting { robot, equilibrium, dynamics };
    let on_platform = robot.wind.pressure_by_velocity_w() * robot.platform.drag_area;
    let center_p = &robot.platform.center_of_mass_p;
    let of_platform = |mode: &Mode| {
        let shape = Vec6::from(mode.shape);
        let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
        let moved = Vec3::from(axes.map(|axis_w| along(&axis_w, center_p, &equilibrium.pose).dot(&shape)));
        moved.dot(&(on_platform * moved))
    };
    let mut powers: Vec<f64> = modes.iter().map(of_platform).collect();

    for i in 0..robot.cables.len() {
        let Some(Drag { stations, lengths, by_velocity_w }) = Drag::of(&setting, i)? else { continue };
        let axes = stations.axes;
        for (power, mode) in powers.iter_mut().zip(modes) {
            for (at, [e, n, b]) in stations.in_mode(dynamics, mode).into_iter().enumerate() {
                let moved = axes.e * e + axes.n * n + axes.b * b;
                *power += lengths[at % lengths.len()] * moved.dot(&(by_velocity_w * moved));
            }
        }
    }

    let ratio = |(power, mode): (f64, &Mode)| {
        // The shape of a mode in which the platform is at rest has a modal mass of 1 kg.
        let mass = if mode.modal_mass > 0.0 { mode.modal_mass } else { 1.0 };
        power / (2.0 * TAU * mode.frequency_hz * mass)
    };
    Ok(powers.into_iter().zip(modes).map(ratio).collect())
}

//! Modes whose stiffness is stretch of the ropes, and the loss that they lack.

use super::{Mode, below};
use crate::cable::CableModel;
use crate::dynamics::{Dynamics, Linearisation};
use crate::math::Vec3;
use crate::robot::Robot;
use crate::statics::{CableState, Equilibrium};
use std::f64::consts::TAU;

/// Minimum share of the stretch of ropes without loss in a mode of which the caveat tells.
const MOSTLY_STRETCH: f64 = 0.5;

/// Damping ratio from which on something else damps such a mode: what a loss factor of 0.01 gives.
const DAMPED_OTHERWISE: f64 = 0.005;

/// Limit below which the modes of the platform are sought [Hz]: far above those of any robot.
const MAX_HZ: f64 = 1e5;

/// Stretch of the ropes in one mode of the platform.
#[derive(Debug, Clone, PartialEq)]
pub struct StretchOfMode {
    /// Natural frequency [Hz].
    pub frequency_hz: f64,
    /// Share of the stretch of each cable in the energy of deformation, in file order.
    pub shares: Vec<f64>,
}

/// Modes of the platform on massless ropes, lowest first, with the stretch of each cable: its tension changes by the
/// same amount all along it, `δT = t·K δp`, which stretches it by `δT L₀/EA`. Empty if the robot has no such modes.
pub fn stretch_of_platform(robot: &Robot, equilibrium: &Equilibrium) -> Vec<StretchOfMode> {
    let linearisation = Linearisation { cable_model: CableModel::CatenaryStatic, ..Linearisation::default() };
    let Ok(dynamics) = Dynamics::about(robot, equilibrium, linearisation, MAX_HZ) else { return Vec::new() };
    let of_mode = |mode: &Mode| {
        let [x, y, z, a, b, c] = mode.shape;
        let (translation_w, turn_w) = (Vec3::new(x, y, z), Vec3::new(a, b, c));
        let deformation = (TAU * mode.frequency_hz).powi(2) * mode.modal_mass;
        let share = |(state, cable): (&CableState, &crate::robot::Cable)| {
            let size = state.tension_platform;
            let Some(tangent_w) = state.tangent_w().filter(|_| size > 0.0) else { return 0.0 };
            let along_w = state.force_on_platform_w / size;
            let moved_w = translation_w + turn_w.cross(&state.lever_w);
            let change = along_w.dot(&(tangent_w * moved_w));
            let compliance = state.unstrained_length / cable.material.axial_stiffness;
            (change * change * compliance / deformation).min(1.0)
        };
        let shares = equilibrium.cables.iter().zip(&robot.cables).map(share).collect();
        StretchOfMode { frequency_hz: mode.frequency_hz, shares }
    };
    below(&dynamics, MAX_HZ).modes.iter().filter(|mode| mode.modal_mass > 0.0).map(of_mode).collect()
}

/// Caveat about the first mode of the platform whose stiffness is mostly stretch of ropes without loss and that hardly
/// anything else damps; it names the ropes. `damping` has the damping ratio of each mode, and `platform_share` is the
/// fraction of its kinetic energy that makes a mode one of the platform. `None` also if the modes have no
/// [shares of the stretch](Mode::stretching_shares).
pub fn caveat_of_stretch(robot: &Robot, modes: &[Mode], damping: &[f64], platform_share: f64) -> Option<String> {
    let without_loss = |i: usize| !robot.cables[i].material.stretch_loss.is_some();
    let share_of = |mode: &Mode| -> f64 {
        let shares = mode.stretching_shares.iter().enumerate();
        shares.filter(|(i, _)| without_loss(*i)).map(|(_, share)| share).sum()
    };
    let (mode, ratio) = modes.iter().zip(damping).find(|(mode, ratio)| {
        let is_of_platform = mode.platform_energy_fraction >= platform_share;
        is_of_platform && share_of(mode) >= MOSTLY_STRETCH && **ratio < DAMPED_OTHERWISE
    })?;

    let mut ropes: Vec<String> = Vec::new();
    for cable in robot.cables.iter().enumerate().filter(|(i, _)| without_loss(*i)).map(|(_, cable)| cable) {
        let name = format!("\"{}\"", cable.material.name);
        if !ropes.contains(&name) {
            ropes.push(name);
        }
    }
    let share = share_of(mode);
    Some(format!(
        "the mode of the platform at {:.3} Hz lives on the stretch of the ropes ({:.0} %), but the robot file gives \
         the stretch of {} no loss, so that its damping ratio of {} lacks what damps it most: give \
         `axial_loss_factor`; a loss factor of 0.01 adds {:.4}",
        mode.frequency_hz,
        100.0 * share,
        ropes.join(", "),
        if *ratio == 0.0 { "0".to_owned() } else { format!("{ratio:.2e}") },
        0.005 * share
    ))
}

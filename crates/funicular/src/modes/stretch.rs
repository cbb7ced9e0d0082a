//! Modes whose stiffness is stretch of the ropes, and the loss that they lack.

use super::Mode;
use crate::robot::Robot;

/// Minimum share of the stretch of ropes without loss in a mode of which the caveat tells.
const MOSTLY_STRETCH: f64 = 0.5;

/// Damping ratio from which on something else damps such a mode: what a loss factor of 0.01 gives.
const DAMPED_OTHERWISE: f64 = 0.005;

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
        "the mode of the platform at {:.3} Hz lives on the stretch of the ropes ({:.0} %), but the robot file gives the \
         stretch of {} no loss, so that its damping ratio of {} lacks what damps it most: give `axial_loss_factor`; a \
         loss factor of 0.01 adds {:.4}",
        mode.frequency_hz,
        100.0 * share,
        ropes.join(", "),
        if ratio == 0.0 { "0".to_owned() } else { format!("{ratio:.2e}") },
        0.005 * share
    ))
}

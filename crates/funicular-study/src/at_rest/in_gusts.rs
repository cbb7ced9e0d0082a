//! Motions and tensions in the gusts of the robot file, about an equilibrium in the mean wind.

use super::{AtRest, ModesBelow};
use anyhow::{Result, bail};
use funicular::dynamics::Linearisation;
use funicular::gust::{self, GustResonance, Gusts, Moments, PeakFactor};
use funicular::modes;
use funicular::response::{Quantity, Signal};
use funicular::statics::CableState;

/// Moments of displacements and tensions in gusts, one per signal.
///
/// # Errors
/// A robot file without turbulence or mean wind, a slack cable, or a response that is not finite.
pub(crate) fn moments_in_gusts(
    at_rest: &AtRest,
    linearisation: Linearisation,
    signals: &[Signal],
) -> Result<Vec<Moments>> {
    if at_rest.robot.turbulence.is_none() {
        bail!("the robot file has no turbulence: give it `turbulence` in [wind]");
    }
    if at_rest.equilibrium.cables.iter().any(CableState::is_slack) {
        bail!("a cable is slack in the mean wind, and the linear response does not know that");
    }

    let at_rest = &*at_rest.vibrating();
    let limit = at_rest.sway_limit(linearisation)?;
    let ModesBelow { dynamics, modes, .. } = at_rest.modes_below(linearisation, limit, modes::MAX_MODES)?;
    let AtRest { robot, equilibrium, .. } = at_rest;
    let signals: Vec<(Signal, Quantity)> = signals.iter().map(|signal| (*signal, Quantity::Displacement)).collect();
    let in_air = gust::aerodynamic_damping_ratio(robot, equilibrium, &dynamics, &modes.modes)?;
    let resonances = GustResonance::of_modes(&modes.modes, &in_air);
    let spectra = Gusts::new(robot, equilibrium, &dynamics, &signals, limit)?.spectra(limit, &resonances)?;
    Ok(spectra.moments)
}

/// Expected largest excursion to one side within a duration [s]; `None` for too few crossings of the mean.
pub(crate) fn expected_peak(of: &Moments, duration: f64) -> Option<f64> {
    // An output without motion has no crossings, and no peak.
    if of.variance == 0.0 { Some(0.0) } else { Some(PeakFactor::new(of.rate(), duration)?.mean * of.rms()) }
}

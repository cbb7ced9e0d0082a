//! Modes as vectors over platform and cables, weighted by the square roots of their masses.

use super::{CableMotionError, CableStations};
use crate::dynamics::Dynamics;
use crate::math::DMat;
use crate::modes::Mode;
use crate::modes::tracking::Tracked;
use crate::robot::Robot;
use crate::statics::Equilibrium;

/// Number of stations along a cable: more than the number of half waves in the modes of interest.
const STATIONS: usize = 32;

/// Modes of a robot as vectors whose inner products are those of the kinetic energy. Vectors of robots that differ only
/// in values of parameters are comparable.
#[derive(Debug)]
pub struct WeightedMotions<'a> {
    dynamics: &'a Dynamics,
    /// Lᵀ of the platform's mass matrix L Lᵀ over its degrees of freedom.
    platform: DMat,
    /// Stations of each cable and the square root of the mass per station; `None` for models without motion along the
    /// cables.
    cables: Option<Vec<(CableStations, f64)>>,
}

impl<'a> WeightedMotions<'a> {
    /// Weights and stations of a robot linearised about an equilibrium.
    ///
    /// # Errors
    /// [`CableMotionError::CatenaryDynamic`]: a cable that cannot be discretised.
    pub fn new(robot: &Robot, equilibrium: &Equilibrium, dynamics: &'a Dynamics) -> Result<Self, CableMotionError> {
        let n = dynamics.dof();
        let mass = DMat::from_fn(n, n, |i, j| dynamics.platform_mass()[(i, j)]);
        let platform = mass.cholesky().map_or_else(|| DMat::zeros(n, n), |factor| factor.l().transpose());
        let fractions: Vec<f64> = (0..STATIONS).map(|k| (k as f64 + 0.5) / STATIONS as f64).collect();
        let cables = (0..robot.cables.len())
            .map(|i| {
                let mass = dynamics.moving_mass_per_length(i) * equilibrium.cables[i].free_length();
                let stations = CableStations::new(robot, equilibrium, dynamics, i, &fractions, false)?;
                Ok((stations, (mass / STATIONS as f64).sqrt()))
            })
            .collect();
        let cables = match cables {
            Ok(cables) => Some(cables),
            Err(CableMotionError::Model(_)) => None,
            Err(error) => return Err(error),
        };
        Ok(Self { dynamics, platform, cables })
    }

    /// Weighted motion of a mode of these dynamics, for [`crate::modes::tracking`].
    ///
    /// It has the platform's coordinates and three coordinates per station of each cable. For models that describe only
    /// the cables' ends it has one coordinate per cable, the square root of the cable's energy fraction.
    pub fn of(&self, mode: &Mode) -> Tracked {
        let n = self.dynamics.dof();
        let mut motion: Vec<f64> =
            (&self.platform * DMat::from_fn(n, 1, |i, _| mode.motion.platform[i])).iter().copied().collect();
        match &self.cables {
            Some(cables) => {
                // `in_mode` has the scale of `Mode::shape`, the platform's motion above has unit modal mass.
                let unit = if mode.modal_mass > 0.0 { 1.0 / mode.modal_mass.sqrt() } else { 0.0 };
                let unit = if self.turned(mode) { -unit } else { unit };
                for (stations, root) in cables {
                    let moved = stations.in_mode(self.dynamics, mode);
                    motion.extend(moved.iter().flatten().map(|u| u * root * unit));
                }
            }
            None => motion.extend(mode.cable_energy_fractions.iter().map(|fraction| fraction.max(0.0).sqrt())),
        }
        Tracked { frequency_hz: mode.frequency_hz, motion }
    }

    /// True if `Mode::shape` has the opposite sign of the motion from which it was scaled.
    fn turned(&self, mode: &Mode) -> bool {
        let motion_w = self.dynamics.coordinates().expand(&mode.motion.platform);
        motion_w[motion_w.iamax()] < 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::Linearisation;
    use crate::modes::{below, tracking::mac_of_motions};
    use crate::robot::State;
    use crate::statics::{StaticModel, forward};

    #[test]
    fn motions_of_different_modes_have_no_energy_in_common_and_their_length_is_that_of_the_whole() {
        let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap();
        let State::Lengths(lengths) = &robot.state else { panic!("the file gives lengths") };
        let rest = forward(&robot, lengths, StaticModel::Catenary, None).unwrap();
        let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 6.0).unwrap();
        let weighted = WeightedMotions::new(&robot, &rest, &dynamics).unwrap();
        let modes = below(&dynamics, 6.0).modes;
        assert!(modes.len() > 20);
        let tracked: Vec<Tracked> = modes.iter().map(|mode| weighted.of(mode)).collect();
        for (i, a) in tracked.iter().enumerate() {
            // Unit modal mass, up to the error of the midpoint rule.
            let length: f64 = a.motion.iter().map(|x| x * x).sum();
            assert!((length - 1.0).abs() < 0.02, "mode {i}: {length}");
            for b in &tracked[..i] {
                let alike = mac_of_motions(&a.motion, &b.motion);
                assert!(alike < 1e-3, "mode {i} at {} Hz and {} Hz: {alike}", a.frequency_hz, b.frequency_hz);
            }
        }
    }
}

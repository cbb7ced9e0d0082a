//! A whole mode as one vector: platform and cables, weighted by the square roots of their masses.

use super::{CableMotionError, CableStations};
use crate::dynamics::Dynamics;
use crate::math::DMat;
use crate::modes::Mode;
use crate::modes::tracking::Tracked;
use crate::robot::Robot;
use crate::statics::Equilibrium;

/// Stations along a cable: more than the half waves of the modes that anybody follows.
const STATIONS: usize = 32;

/// Modes of a robot as vectors whose inner products are those of the kinetic energy; vectors of robots that differ in
/// values alone are comparable.
#[derive(Debug)]
pub struct WeightedMotions<'a> {
    dynamics: &'a Dynamics,
    /// Lᵀ of the platform's mass L Lᵀ in its degrees of freedom.
    platform: DMat,
    /// Of each cable, the square root of the mass that a station stands for; none where cables end in models without
    /// motion along them.
    cables: Option<Vec<(CableStations, f64)>>,
}

impl<'a> WeightedMotions<'a> {
    /// Of a robot linearised about an equilibrium.
    ///
    /// # Errors
    /// [`CableMotionError::Exact`]: a cable that cannot be discretised.
    pub fn new(robot: &Robot, rest: &Equilibrium, dynamics: &'a Dynamics) -> Result<Self, CableMotionError> {
        let n = dynamics.dof();
        let mass = DMat::from_fn(n, n, |i, j| dynamics.platform_mass()[(i, j)]);
        let platform = mass.cholesky().map_or_else(|| DMat::zeros(n, n), |factor| factor.l().transpose());
        let fractions: Vec<f64> = (0..STATIONS).map(|k| (k as f64 + 0.5) / STATIONS as f64).collect();
        let cables = (0..robot.cables.len())
            .map(|i| {
                let mass = dynamics.moving_mass_per_length(i) * rest.cables[i].unstrained_length;
                let stations = CableStations::new(robot, rest, dynamics, i, &fractions, false)?;
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

    /// A mode of these dynamics, for [`crate::modes::tracking`]. Its motion has the platform's coordinates and three for each
    /// station of a cable; for models that know a cable's end only, one for each cable: the root of its energy.
    pub fn of(&self, mode: &Mode) -> Tracked {
        let n = self.dynamics.dof();
        let mut motion: Vec<f64> =
            (&self.platform * DMat::from_fn(n, 1, |i, _| mode.motion.platform[i])).iter().copied().collect();
        match &self.cables {
            Some(cables) => {
                // `in_mode` moves with `Mode::shape`, the platform above with unit modal mass.
                let unit = if mode.modal_mass > 0.0 { 1.0 / mode.modal_mass.sqrt() } else { 0.0 };
                let unit = if self.turned(mode) { -unit } else { unit };
                for (stations, root) in cables {
                    let moved = stations.in_mode(self.dynamics, mode);
                    motion.extend(moved.iter().flatten().map(|u| u * root * unit));
                }
            }
            None => motion.extend(mode.cable_energy_fractions.iter().map(|part| part.max(0.0).sqrt())),
        }
        Tracked { frequency_hz: mode.frequency_hz, motion }
    }

    /// Whether `Mode::shape` has the other sign than the motion it was scaled from.
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
            // Unit modal mass, up to the rule of midpoints.
            let length: f64 = a.motion.iter().map(|x| x * x).sum();
            assert!((length - 1.0).abs() < 0.02, "mode {i}: {length}");
            for b in &tracked[..i] {
                let alike = mac_of_motions(&a.motion, &b.motion);
                assert!(alike < 1e-3, "mode {i} at {} Hz and {} Hz: {alike}", a.frequency_hz, b.frequency_hz);
            }
        }
    }
}

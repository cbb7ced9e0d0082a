//! Parts of a picture of a simulation beyond a sample: the curves of the ropes, and the platform that is left.

use super::{Simulation, SlackCable};
use crate::math::Vec3;
use crate::robot::Platform;
use crate::simulation::system::{MotionNumbers, RopeEnd};

impl SlackCable {
    /// Tension at the platform below which a cable counts as slack [N].
    pub const TENSION: f64 = 0.5;
}

impl Simulation {
    /// Nodes of every rope [m] from the platform to the anchor, in file order, at a time of the last step or at its
    /// end. A cut rope without mass has none. Behind the cables stand the halves at the platform of those that fail
    /// at a place ([`parted`](Self::parted)).
    ///
    /// # Example
    /// ```
    /// use funicular::robot::Robot;
    /// use funicular::simulation::{Simulation, SimulationSettings};
    /// use funicular::statics::{self, StaticModel};
    ///
    /// let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM)?;
    /// let rest = statics::solve(&robot, StaticModel::Catenary, None)?.equilibrium;
    /// let mut simulation = Simulation::new(&robot, &rest, &[], 0.1, &SimulationSettings::default())?;
    /// let sample = simulation.at(0.05)?;
    /// let first = &simulation.curves_w(0.05)[0];
    /// let attachment_w = sample.pose.point_w(&robot.cables[0].attachment_p);
    /// assert!((first[0] - attachment_w).norm() < 1e-9); // m
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn curves_w(&mut self, time: f64) -> Vec<Vec<Vec3>> {
        let system = &mut self.stepper.system;
        let Some((dense, ..)) = self.last.as_ref().filter(|_| time < self.stepper.time) else {
            return self.curves_of(&self.stepper.now);
        };
        let mut motion = std::mem::take(&mut self.work);
        dense.at(time, &mut motion);
        // The motion is given about the rotation at the beginning of the step.
        let rotation = std::mem::replace(&mut system.rotation, dense.rotation);
        let body = system.body_motion(&motion);
        let lengths = system.lengths(time);
        system.fill_ends(time, &body, &lengths, &mut motion);
        system.rotation = rotation;
        let curves = self.curves_of(&motion);
        self.work = motion;
        curves
    }

    fn curves_of(&self, motion: &MotionNumbers) -> Vec<Vec<Vec3>> {
        let system = &self.stepper.system;
        let curve = |i: usize| {
            if system.ends[i] == RopeEnd::Gone {
                return Vec::new();
            }
            motion.x[system.of_rope(i)].chunks_exact(3).map(Vec3::from_column_slice).collect()
        };
        (0..system.ropes.len()).map(curve).collect()
    }

    /// Cables that fail at a place, by their indices: the rope of the half at the platform stands behind those of the
    /// cables in [`curves_w`](Self::curves_w), in this order, and is empty before.
    pub fn parted(&self) -> Vec<usize> {
        self.stepper.system.halves.iter().map(|(cable, _)| *cable).collect()
    }

    /// Platform with the payloads that it has now; `before` is that of the start.
    pub fn platform(&self, before: &Platform) -> Platform {
        let body = &self.stepper.system.body;
        Platform { mass: body.mass, inertia_p: body.inertia_p, center_of_mass_p: body.center_p, ..before.clone() }
    }
}

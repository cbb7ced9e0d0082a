//! Warnings about a robot at its equilibrium.

use super::AtRest;
use funicular::cable::CableModel;
use funicular::warnings;

impl AtRest {
    /// Warnings about implausible values, about the statics and, if given, about a cable model up to a frequency [Hz].
    pub fn warnings(&self, dynamics: Option<(CableModel, f64)>) -> Vec<String> {
        let mut warnings = warnings::of_statics(&self.robot, &self.equilibrium);
        if let Some((model, up_to_hz)) = dynamics {
            warnings.extend(warnings::of_dynamics(&self.robot, &self.equilibrium, model, up_to_hz));
        }
        let elsewhere = self
            .requested_pose
            .and_then(|(pose, distance)| warnings::of_pose(&self.robot, &self.equilibrium, &pose, distance));
        self.implausible().chain(elsewhere.iter().chain(&warnings).map(ToString::to_string)).collect()
    }

    /// Warning of a robot that nothing damps, for results that depend on damping.
    pub fn without_damping(&self) -> Option<String> {
        warnings::of_damping(&self.robot).map(|warning| warning.to_string())
    }

    /// Warnings about values of the robot and of its equilibrium that no usual robot has.
    pub fn implausible(&self) -> impl Iterator<Item = String> + use<> {
        let of_robot = warnings::of_robot(&self.robot).into_iter();
        let all = of_robot.chain(warnings::of_plausibility(&self.robot, &self.equilibrium));
        all.map(|warning| warning.to_string())
    }
}

//! Tensions to the load on the platform in a control loop.

use super::ControlLoop;
use super::input::{LoopInput, MAX_INPUT};
use super::model::LoopModel;
use super::state::LoopFault;
use crate::math::{Vec3, Vec6};
use crate::platform::{load_wrench, wrench_of};
use crate::statics::{StaticModel, TensionCurve};

/// Load that measured tensions hold, besides weight, load and inertia of the robot file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadOnPlatform {
    /// Force, world axes [N].
    pub force_w: Vec3,
    /// Moment about the origin of the platform, world axes [N m].
    pub moment_w: Vec3,
    /// Mass whose weight is the part of the force along gravity [kg]; zero without gravity.
    pub payload: f64,
}

impl ControlLoop {
    /// Load on the platform at a pose for tensions at the drums, or at the anchors without drums [N]: what has to act
    /// on it, besides its weight, the load of the robot file and its inertia in this motion, for these tensions. It is
    /// the external load of [`Self::inverse`] for its tensions. The external load of the input does not count.
    ///
    /// # Errors
    /// [`LoopFault`].
    pub fn load(
        &self,
        model: &LoopModel,
        input: &LoopInput,
        tensions_drum: &[f64],
    ) -> Result<LoadOnPlatform, LoopFault> {
        let robot = model.robot();
        input.check(robot)?;
        let is_tension = |tension: &f64| *tension >= 0.0 && *tension <= MAX_INPUT;
        if tensions_drum.len() != model.cables() || !tensions_drum.iter().all(is_tension) {
            return Err(LoopFault::BadInput);
        }

        let pose = &input.motion.pose;
        let [force_w, moment_w] = input.motion.inertia(robot);
        let mut sum = load_wrench(robot, pose);
        sum += Vec6::new(force_w.x, force_w.y, force_w.z, moment_w.x, moment_w.y, moment_w.z);
        for (i, tension) in tensions_drum.iter().enumerate() {
            let mut curve = TensionCurve::at(robot, i, pose, StaticModel::Catenary);
            if !curve.set_drum_tension(*tension) {
                return Err(LoopFault::TooSlack { cable: i });
            }
            sum += wrench_of(&curve.span.force_on_start_w(), &(curve.span.start_w - pose.position_w));
        }

        // A guide carries what the platform cannot follow.
        let load = -robot.platform.motion.allowed(&sum);
        let force_w = Vec3::new(load[0], load[1], load[2]);
        let gravity = robot.gravity_w.norm_squared();
        let payload = if gravity > 0.0 { force_w.dot(&robot.gravity_w) / gravity } else { 0.0 };
        Ok(LoadOnPlatform { force_w, moment_w: Vec3::new(load[3], load[4], load[5]), payload })
    }
}

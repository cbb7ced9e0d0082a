//! Results of a control loop: state, status, fault.

use super::model::MAX_CABLES;
use crate::math::Vec3;
use crate::robot::Pose;
use thiserror::Error;

/// Trust in a result; a smaller value is better.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum LoopStatus {
    /// The balance, the limits and the certificate hold.
    Certified,
    /// The balance and the limits hold; that this is the centre, the only one, or the nearest stable pose is not
    /// proved.
    Accepted,
    /// The balance holds, and a tension is beyond its limit. Not the least possible violation.
    BeyondLimits,
    /// Nothing was found in the largest number of steps: the last certified result, [`LoopState::age`] calls old.
    Held,
}

/// Reason for a call without a result. Numbers only; [`std::fmt::Display`] makes text outside of the loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum LoopFault {
    /// Input that is not finite, too large or of the wrong number.
    #[error("a number of the input is not finite, too large, not positive where it has to be, or one is missing")]
    BadInput,
    /// Pose that the platform cannot have.
    #[error("the platform cannot have this pose: it is out of its plane, or an attachment is at its anchor")]
    ImpossiblePose,
    /// Attachment inside a wheel.
    #[error("the attachment of cable number {cable} (from 0) is inside the wheel of its pulley")]
    InsidePulley {
        /// Index of the cable.
        cable: usize,
    },
    /// Cable whose minimum is not below its maximum at this pose.
    #[error("the tension limits of cable number {cable} (from 0) leave no tension at this pose")]
    LimitsContradict {
        /// Index of the cable.
        cable: usize,
    },
    /// Cables that do not oppose every motion at this pose.
    #[error("the cables do not oppose every motion of the platform at this pose")]
    Singular,
    /// Tension that no cable can have.
    #[error("cable number {cable} (from 0) cannot have this tension at its drum at this pose: it sags too far")]
    TooSlack {
        /// Index of the cable.
        cable: usize,
    },
    /// No result in the largest number of steps, and no earlier one.
    #[error("nothing was found in the largest number of steps, and there is no earlier result to hold")]
    NotFound,
    /// Lengths without a pose to start from.
    #[error("there is no pose to start from: give one")]
    NoStart,
}

/// State of one cable.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LoopCable {
    /// Unstrained length to the drum [m], as [`CableState::unstrained_length`](crate::statics::CableState).
    pub length: f64,
    /// Rate of that length [m/s], positive while it is paid out.
    pub length_rate: f64,
    /// Acceleration of that length [m/s²].
    pub length_acceleration: f64,
    /// Unstrained length of the free span [m].
    pub free_length: f64,
    /// Tension at the platform [N].
    pub tension_platform: f64,
    /// Tension at the drum, or at the anchor without one [N].
    pub tension_drum: f64,
    /// Distance of the tensions from the nearer limit [N]; negative beyond it.
    pub margin: f64,
}

/// Result of a call.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopState {
    /// Trust.
    pub status: LoopStatus,
    /// Number of calls since this state was computed: zero but for [`LoopStatus::Held`].
    pub age: u32,
    /// Number of Newton steps.
    pub iterations: u32,
    /// Pose.
    pub pose: Pose,
    /// Wrench that is not balanced [N]: the larger of force and moment over the length of the platform.
    pub error_force: f64,
    /// Error of the lengths or of the pose that the last Newton step bounds [m].
    pub error_length: f64,
    /// Smallest margin of all cables [N], and its cable.
    pub least_margin: f64,
    /// Index of that cable.
    pub least_margin_cable: usize,
    /// Proof that no tensions within the limits balance the load; `None` without one, and with as many cables as
    /// degrees of freedom, which have no choice.
    pub missing: Option<LoopMissing>,
    /// Cables in file order; zeros beyond their number.
    pub cables: [LoopCable; MAX_CABLES],
}

/// Part of the balance that no tensions within the limits can provide, as
/// [`MissingWrench`](crate::statics::MissingWrench), the exit points of pulleys held.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopMissing {
    /// Direction of the missing force, world axes. Together with the moment of length 1.
    pub force_w: Vec3,
    /// Direction of the missing moment, world axes, over [`Robot::platform_length`](crate::robot::Robot).
    pub moment_w: Vec3,
    /// Least size of the missing wrench along that direction [N].
    pub size: f64,
    /// Cables that reach farthest along the direction at their maximum: bit i for cable number i, from zero. The others
    /// do at their minimum.
    pub at_maximum: u32,
}

impl LoopState {
    /// State whose margins are those of its cables.
    pub(super) fn with_margins(mut self, cables: usize) -> Self {
        self.least_margin = f64::INFINITY;
        for (i, cable) in self.cables.iter().enumerate().take(cables) {
            if cable.margin < self.least_margin {
                (self.least_margin, self.least_margin_cable) = (cable.margin, i);
            }
        }
        self
    }
}

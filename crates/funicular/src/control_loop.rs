//! Statics inside a control loop: pose to lengths, lengths to pose, tensions to the wrench on the platform, thousands
//! of times a second.
//!
//! A [`LoopModel`] is a robot that was checked at set-up; a [`ControlLoop`] remembers the last state, from which the
//! next call starts. The functions reserve no memory, take no locks, print nothing, and every iteration in them has a
//! largest number of steps. The physics is that of [`crate::statics`] with the rule
//! [`Centre`](crate::statics::TensionRule::Centre), whose tensions are smooth along every path.
//!
//! A result has a [`LoopStatus`], which orders trust. A [`LoopFault`] says that there is no result.
//!
//! ```
//! use funicular::control_loop::{ControlLoop, LoopInput, LoopModel, LoopStatus};
//! use funicular::path::{CourseForm, MotionLimits, PlatformPath};
//! use funicular::robot::{Pose, Robot};
//!
//! // Set-up: may reserve memory and may fail.
//! let robot = Robot::from_toml(funicular_robots::COGIRO_WINCHES)?;
//! let model = LoopModel::new(robot)?;
//! let mut control = ControlLoop::new();
//!
//! let limits = MotionLimits { speed: 1.0, acceleration: 2.0, jerk: 20.0, ..MotionLimits::default() };
//! let ends = [Pose::new([0.0, 0.0, 1.5], [0.0; 3]), Pose::new([0.2, 0.0, 1.6], [0.0; 3])];
//! let path = PlatformPath::through(&ends, &limits, CourseForm::JerkLimited, 0.0)?;
//!
//! // Loop: one call per millisecond.
//! let mut before: Option<f64> = None;
//! for tick in 0..(path.duration() * 1000.0) as u32 {
//!     let point = path.at(f64::from(tick) * 1e-3);
//!     let found = control.inverse(&model, &LoopInput::moving(point), true)?;
//!     assert_eq!(found.status, LoopStatus::Certified);
//!     let first = found.cables[0];
//!     if let Some(before) = before {
//!         let difference = (first.length - before) / 1e-3; // m/s
//!         assert!((difference - first.length_rate).abs() < 2e-3);
//!     }
//!     before = Some(first.length);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod forward;
mod input;
mod inverse;
mod model;
mod rates;
mod solved;
mod state;
mod wrench;

pub use input::{LoopInput, MAX_INPUT, MAX_QUATERNION_ERROR, pose_from_quaternion};
pub use model::{LoopModel, MAX_CABLES, NotForLoop};
pub use state::{LoopCable, LoopFault, LoopMissing, LoopState, LoopStatus};
pub use wrench::LoadOnPlatform;

use crate::robot::Pose;
use forward::NearForward;
use solved::NearInverse;

/// Memory of a control loop: the last states, from which the next searches start. Plain numbers without pointers.
///
/// One loop belongs to one thread; a model may serve many loops. The same calls give the same digits. A result depends
/// on the calls before by rounding only, some 1e-13 of it; after [`Self::reset`] not at all.
#[derive(Debug, Clone, Default)]
pub struct ControlLoop {
    near_inverse: Option<NearInverse>,
    near_forward: Option<NearForward>,
    /// Last certified results, for calls that find none.
    last_inverse: Option<LoopState>,
    last_forward: Option<LoopState>,
    /// Pose of the last result, from which lengths to pose starts.
    last_pose: Option<Pose>,
}

impl ControlLoop {
    /// Loop that has not seen a state yet: its first call starts cold.
    pub fn new() -> Self {
        Self::default()
    }

    /// Forgets all states: the next call starts cold.
    pub fn reset(&mut self) {
        *self = Self::default();
    }

    /// Last certified result in place of a missing one, its age counted; without any the fault.
    fn held(last: &mut Option<LoopState>, fault: LoopFault) -> Result<LoopState, LoopFault> {
        let Some(last) = last else { return Err(fault) };
        last.age = last.age.saturating_add(1);
        Ok(LoopState { status: LoopStatus::Held, ..*last })
    }
}

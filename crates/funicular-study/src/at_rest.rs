//! Static state that an analysis starts from, given by the request or else by the robot file.

mod holder;
mod in_gusts;
mod loads;
mod pose;
mod requirements;
mod rule_jumps;
mod state;
mod tensions;
mod vibration;
mod warnings;

pub use holder::holder;
pub(crate) use holder::holder_of;
pub(crate) use in_gusts::{expected_peak, moments_in_gusts};
pub(crate) use loads::payload_center;
pub use pose::{OrientationOfPointMass, check_pose, refuse_orientation};
pub(crate) use requirements::{with_required, with_required_velocities};
pub(crate) use rule_jumps::{LEFT, MIN_TENSION, SMOOTH_RULES};
pub use state::with_state;
pub(crate) use state::{refuse_no_pose, refuse_no_state};
pub use tensions::{rule, with_limits};
pub use vibration::{ModesBelow, cable_model, linearisation, signals};

use crate::error::with_warnings;
use crate::request::{self, RobotText, Tensions};
use anyhow::Result;
use funicular::robot::{Pose, Robot};
use funicular::statics::{self, Equilibrium, Solution, TensionRule};
use std::borrow::Cow;

/// Robot at an equilibrium.
#[derive(Debug, Clone)]
pub struct AtRest {
    /// Robot with all changes of the request.
    pub robot: Robot,
    /// Equilibrium of the robot.
    pub equilibrium: Equilibrium,
    /// Requested pose and its distance from the equilibrium's pose [m]. Present if the cables cannot hold the requested
    /// pose; the equilibrium then has the nearest pose that they can hold.
    pub requested_pose: Option<(Pose, f64)>,
    /// Rule that chose the tensions, if there was a choice.
    pub rule: Option<TensionRule>,
    /// Pose whose unstrained lengths are held, before the changes of the request; absent if no lengths are held.
    pub held_pose: Option<Pose>,
}

impl AtRest {
    /// State about which the robot vibrates: where ropes have a dynamic axial stiffness, with the ropes of
    /// [`Equilibrium::with_dynamic_stiffness`]; otherwise this state.
    pub fn vibrating(&self) -> Cow<'_, Self> {
        match self.equilibrium.with_dynamic_stiffness(&self.robot) {
            (Cow::Owned(robot), equilibrium) => {
                let equilibrium = equilibrium.into_owned();
                let (rule, held_pose) = (self.rule.clone(), self.held_pose);
                Cow::Owned(Self { robot, equilibrium, requested_pose: self.requested_pose, rule, held_pose })
            }
            _ => Cow::Borrowed(self),
        }
    }

    /// Robot at this equilibrium whose supports are rigid where they have settled; `None` on a rigid frame.
    pub fn with_rigid_supports(&self) -> Option<Self> {
        self.robot.has_supports().then(|| Self {
            robot: self.equilibrium.settled(&self.robot).into_owned(),
            equilibrium: self.equilibrium.clone(),
            requested_pose: self.requested_pose,
            rule: self.rule.clone(),
            held_pose: self.held_pose,
        })
    }
}

/// Solves the static problem of a request. `source` is the text from which the robot was read.
///
/// # Errors
/// A request that contradicts itself or the robot, or a robot without such an equilibrium.
pub fn equilibrium(robot: Robot, source: &RobotText, state: &request::State, tensions: &Tensions) -> Result<AtRest> {
    let robot = with_limits(&with_state(robot, state)?, tensions)?;
    let rule = rule(tensions)?;
    let solution = if state.hold_lengths_of_pose {
        let holder = holder(source, state, tensions)?;
        refuse_no_pose(&holder)?;
        statics::solve_held(&holder, &robot, state.static_model, rule)
    } else {
        refuse_no_state(&robot)?;
        statics::solve(&robot, state.static_model, rule)
    };
    let solution = solution.map_err(|error| with_warnings(error, &robot))?;
    let Solution { equilibrium, requested_pose, rule, held_pose } = solution;
    Ok(AtRest { robot, equilibrium, requested_pose, rule, held_pose })
}

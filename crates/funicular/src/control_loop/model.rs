//! Robot that a control loop can compute, checked at set-up.

use crate::platform::Coordinates;
use crate::robot::{Constraint, Pose, Robot, State};
use crate::statics::{self, StaticModel, independent_directions};
use thiserror::Error;

/// Maximum number of cables in a control loop, which has arrays of this size. Robots have 2 to 12; more have been built
/// as models only.
pub const MAX_CABLES: usize = 16;

/// Reason why a robot cannot be computed in a control loop.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum NotForLoop {
    /// More cables than a loop has room for.
    #[error(
        "the robot has {cables} cables in [[cables]]: a control loop has room for {MAX_CABLES}; compute it with the \
         commands of the program"
    )]
    TooManyCables {
        /// Number of cables.
        cables: usize,
    },
    /// Fewer cables than degrees of freedom.
    #[error(
        "the robot has fewer cables ({cables}) than its platform has degrees of freedom ({dof}), so that the cables do \
         not hold every pose: a control loop needs at least as many; see `motion` in [platform]"
    )]
    TooFewCables {
        /// Number of cables.
        cables: usize,
        /// Degrees of freedom.
        dof: usize,
    },
    /// Cables that leave the platform free to turn.
    #[error(
        "the cables cannot oppose every motion of the platform, because all end at one point or on one line of it: a \
         control loop needs `motion = \"point-mass\"` in [platform], or other values of `attachment_m` in [[cables]]"
    )]
    FreeMotion,
    /// Flexible supports.
    #[error(
        "the support \"{support}\" in [[supports]] yields under its cables, which takes rounds without a bound: a \
         control loop needs rigid anchors; leave out `support` in [[cables]]"
    )]
    Supports {
        /// Name of the first support.
        support: String,
    },
    /// Rope over sheaves.
    #[error(
        "the rope of cable \"{cable}\" runs over sheaves, which a control loop does not know: leave out \
         `shares_rope_with` in [[cables]]"
    )]
    RopeOverSheaves {
        /// Name of the first cable of the rope.
        cable: String,
    },
    /// Redundant cable without a maximum.
    #[error(
        "cable \"{cable}\" has no maximum tension, which the rule `centre` needs: give `maximum_tension_n` in \
         [[cables]] or in its material, or the material's `breaking_load_n`"
    )]
    NoMaximum {
        /// Name of the cable.
        cable: String,
    },
    /// Minimum that is not below its maximum.
    #[error("cable \"{cable}\" has a minimum tension of {minimum} N, not below its maximum of {maximum} N")]
    LimitsContradict {
        /// Name of the cable.
        cable: String,
        /// Minimum [N].
        minimum: f64,
        /// Maximum [N].
        maximum: f64,
    },
}

/// Robot that was checked for a control loop. It never changes, so that many threads may use it.
#[derive(Debug, Clone)]
pub struct LoopModel {
    robot: Robot,
    coordinates: Coordinates,
    home: Option<Pose>,
}

impl LoopModel {
    /// Checks a robot: its number of cables, its supports and the limits that the rule `centre` needs.
    ///
    /// # Errors
    /// [`NotForLoop`].
    ///
    /// # Example
    /// ```
    /// use funicular::control_loop::{LoopModel, NotForLoop};
    /// use funicular::robot::Robot;
    ///
    /// let mut robot = Robot::from_toml(funicular_robots::COGIRO)?;
    /// assert_eq!(LoopModel::new(robot.clone())?.cables(), 8);
    /// robot.cables.extend_from_within(..);
    /// robot.cables.push(robot.cables[0].clone());
    /// assert_eq!(LoopModel::new(robot).unwrap_err(), NotForLoop::TooManyCables { cables: 17 });
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(robot: Robot) -> Result<Self, NotForLoop> {
        let (cables, dof) = (robot.cables.len(), robot.platform.motion.count());
        if cables > MAX_CABLES {
            return Err(NotForLoop::TooManyCables { cables });
        }
        if let Some(support) = robot.supports.first().filter(|_| robot.has_supports()) {
            return Err(NotForLoop::Supports { support: support.name.clone() });
        }
        if let Some(rope) = robot.ropes.first() {
            return Err(NotForLoop::RopeOverSheaves { cable: robot.cables[rope.cables[0]].name.clone() });
        }
        if robot.constraint().is_under() {
            return Err(NotForLoop::TooFewCables { cables, dof });
        }
        if independent_directions(&robot) < dof {
            return Err(NotForLoop::FreeMotion);
        }
        for cable in &robot.cables {
            let limits = cable.limits();
            if limits.maximum.is_none() && robot.constraint().is_redundant() {
                return Err(NotForLoop::NoMaximum { cable: cable.name.clone() });
            }
            if let (Some(minimum), Some(maximum)) = (limits.minimum, limits.maximum)
                && minimum >= maximum
            {
                return Err(NotForLoop::LimitsContradict { cable: cable.name.clone(), minimum, maximum });
            }
        }
        let coordinates = Coordinates::of(&robot);
        let home = match &robot.state {
            State::Pose(pose) => Some(*pose),
            State::Lengths(lengths) => {
                statics::forward(&robot, lengths, StaticModel::Catenary, None).ok().map(|rest| rest.pose)
            }
            State::Unknown => None,
        };
        Ok(Self { robot, coordinates, home })
    }

    /// Pose of the robot file, or that of its lengths; `None` if it gives neither.
    pub fn home(&self) -> Option<&Pose> {
        self.home.as_ref()
    }

    /// Robot of the model.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// Number of cables.
    pub fn cables(&self) -> usize {
        self.robot.cables.len()
    }

    pub(super) fn coordinates(&self) -> Coordinates {
        self.coordinates
    }

    /// True if more cables than degrees of freedom leave a choice of the tensions.
    pub(super) fn has_choice(&self) -> bool {
        matches!(self.robot.constraint(), Constraint::Redundantly(_))
    }
}

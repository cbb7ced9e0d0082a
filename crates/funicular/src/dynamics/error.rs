//! Reasons for which a robot cannot be linearised.

use crate::cable::catenary_dynamic::CatenaryDynamicError;
use crate::cable::{CableModel, NoStiffness};
use thiserror::Error;

/// Case in which the vibration of a rope that runs over sheaves is not computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum RunningRopeRefusal {
    /// Motion in plane alone.
    #[error("include the stiffness out of plane")]
    InPlaneOnly,
    /// Rope with mass that runs over a sheave of the frame, too.
    #[error(
        "a sheave of the frame between cables with mass is not computed; choose the cable model `catenary-static`, or \
         give the sheave a `sheave_efficiency` below 1, with which it stays at rest"
    )]
    FrameSheave,
}

/// Reason for which a robot cannot be linearised.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum DynamicsError {
    /// A cable has no stiffness by poles and residues: a catenary-dynamic one, or a shallow one with a drive.
    #[error("cable \"{cable}\": {reason}")]
    CatenaryDynamic {
        /// Name of the cable.
        cable: String,
        /// Reason.
        reason: CatenaryDynamicError,
    },
    /// A cable carries no tension.
    #[error(
        "cable \"{cable}\" has no tension: the {model} model does not exist for it; choose a state in which all cables \
         are taut, or the model `spring` or `catenary-static`"
    )]
    NoTension {
        /// Name of the cable.
        cable: String,
        /// Requested model.
        model: CableModel,
    },
    /// The anchor of a cable is on a flexible support.
    #[error(
        "the anchor of cable \"{cable}\" is on a flexible support, which moves in all directions: include the \
         stiffness out of plane"
    )]
    Support {
        /// Name of the cable.
        cable: String,
    },
    /// Rope runs over a sheave in a case that is not computed.
    #[error("the rope of cable \"{cable}\" runs over sheaves: {reason}")]
    RunningRope {
        /// Name of the first cable of the rope.
        cable: String,
        /// Reason, and what to do.
        reason: RunningRopeRefusal,
    },
    /// A rope has a second stiffness for vibration, and the robot has not been replaced by the one that vibrates.
    #[error(
        "this analysis knows one axial stiffness only, and rope \"{rope}\" has a second one for vibration: leave \
         `dynamic_axial_stiffness_n` out here; `modes`, `frf`, `settle`, `reduce`, maps and sweeps have both"
    )]
    TwoStiffnesses {
        /// Name of the rope.
        rope: String,
    },
    /// An equilibrium with ideal cables has no tangent stiffness.
    #[error(
        "ideal cables are rigid: they have no stiffness in the models `catenary-static` and `catenary-dynamic`; use \
         the static model `catenary` or `spring`"
    )]
    Rigid,
}

impl DynamicsError {
    /// True if the request is valid and the robot has no linear vibration at this equilibrium, because a cable has no
    /// tension; otherwise another model or frequency limit helps.
    pub fn is_no_solution(&self) -> bool {
        match self {
            Self::NoTension { .. } => true,
            Self::CatenaryDynamic { reason, .. } => *reason == CatenaryDynamicError::NoTension,
            Self::Rigid | Self::Support { .. } | Self::RunningRope { .. } | Self::TwoStiffnesses { .. } => false,
        }
    }

    /// Error for the cable of this name, which has no stiffness in a model.
    pub fn of_cable(name: &str, model: CableModel, reason: NoStiffness) -> Self {
        let cable = name.to_owned();
        match reason {
            NoStiffness::Rigid => Self::Rigid,
            NoStiffness::NoTension => Self::NoTension { cable, model },
            NoStiffness::CatenaryDynamic(reason) => Self::CatenaryDynamic { cable, reason },
        }
    }
}

//! Reasons why there is no reduced model.

use crate::cable_motion::CableMotionError;
use crate::response::ResponseError;
use thiserror::Error;

/// Reason why there is no reduced model.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ReductionError {
    /// A cable is in the shallow-dynamic model.
    #[error(
        "the reduced model consists of the modes of catenary-dynamic cables: choose the cable model \
         `catenary-dynamic`, or a model without vibration"
    )]
    Model,
    /// The control of a motor has a delay.
    #[error(
        "the control of the motor of cable \"{cable}\" has a delay of {delay_s} s, which no second-order model and no \
         state space can have: set `delay_s = 0` in its winch and put the delay into the controller as a Padé \
         approximation, or compute responses with `frf`, which has the delay"
    )]
    Delay {
        /// Name of the cable.
        cable: String,
        /// Delay [s].
        delay_s: f64,
    },
    /// A part of a drive has losses and no mass.
    #[error(
        "the motor of cable \"{cable}\" has damping or a speed gain, but no inertia: a second-order model needs the \
         inertia; give `motor_inertia_kg_m2`, or leave damping and speed gain out"
    )]
    Massless {
        /// Name of the cable.
        cable: String,
    },
    /// The stretch of a rope has a loss in a model without inertia of the cables.
    #[error(
        "the stretch of cable \"{cable}\" has a loss, but the cable has no mass in this model, so that no matrices of \
         second order have it: choose the cable model `catenary-dynamic` and give the rope its mass, or leave \
         `axial_loss_factor` and `axial_damping_time_s` out"
    )]
    StretchAtRest {
        /// Name of the cable.
        cable: String,
    },
    /// An output follows the rate of an input.
    #[error(
        "output {output} contains the rate of change of input {input}, which the state space of the second-order model \
         cannot have: use its matrices, or take the state space of few states (form `state-space`)"
    )]
    Improper {
        /// Number of the output, from 1.
        output: usize,
        /// Number of the input, from 1.
        input: usize,
    },
    /// The motion of a point on a cable is not known.
    #[error(transparent)]
    CableMotion(#[from] CableMotionError),
    /// The full model has no response to compare with.
    #[error(transparent)]
    Response(#[from] ResponseError),
    /// The mass matrix is not positive definite.
    #[error(
        "the mass matrix of the reduced model is not positive definite: check masses and inertia of the robot file"
    )]
    Mass,
    /// A mode has no damping, so that its peak is not finite.
    #[error(
        "the natural frequency {frequency_hz} Hz has no damping: a response has no peak to which an error could be \
         related; give the ropes or the platform damping, or take the second-order form"
    )]
    Undamped {
        /// Frequency [Hz].
        frequency_hz: f64,
    },
    /// Nothing holds the platform in some direction.
    #[error(
        "the equilibrium is indifferent: in some direction nothing holds the platform, and an input, an output or the \
         damping sees this motion, so that it has no stable state space; choose inputs and outputs that do not see it, \
         add a cable, or another attachment point, or take the second-order form"
    )]
    Indifferent,
    /// The equilibrium is unstable.
    #[error(
        "the equilibrium is unstable, so that it has no stable state space; choose another state, or take the \
         second-order form"
    )]
    Unstable,
    /// No input moves any output.
    #[error("no input moves any output below the limit: choose other inputs or outputs")]
    NoResponse,
    /// The eigenvalues of the damped modes are not found.
    #[error("the eigenvalues of the damped modes cannot be computed: choose a lower frequency limit")]
    Eigenvalues,
    /// Too few states for any mode.
    #[error("{0} states hold no mode: a mode needs two")]
    Order(usize),
    /// The observer has stopped the work.
    #[error("stopped before the end")]
    Stopped,
    /// No choice of modes keeps the tolerance.
    #[error(
        "no state space has an error of at most {requested:e} of the peaks: {order} states reach {reached:.2e}, \
         because a constant damping ratio has no exact state space or because of modes that are left out; choose a \
         larger tolerance"
    )]
    Tolerance {
        /// Requested error.
        requested: f64,
        /// Smallest error.
        reached: f64,
        /// Number of states with this error.
        order: usize,
    },
}

impl ReductionError {
    /// True if the request is valid, but the robot has no such model.
    pub fn is_no_solution(&self) -> bool {
        matches!(
            self,
            Self::Undamped { .. }
                | Self::Indifferent
                | Self::Unstable
                | Self::NoResponse
                | Self::Eigenvalues
                | Self::Tolerance { .. }
        )
    }
}

//! Static equilibrium: forward statics computes the pose from lengths ([`forward`]), inverse statics computes the
//! lengths from a pose ([`inverse`]).
//!
//! | Question | Function |
//! |---|---|
//! | equilibrium of a robot at its state | [`solve`], at another state [`solve_at`] |
//! | equilibrium at the lengths that hold a pose with another mass or load | [`solve_held`], [`solve_held_at`] |
//! | pose from unstrained lengths | [`forward`] |
//! | all equilibria of given lengths | [`all_equilibria`], [`another_stable_equilibrium`] |
//! | lengths from a pose, fully constrained (as many cables as degrees of freedom) | [`inverse`] |
//! | lengths from a pose, redundantly constrained (more cables) | [`distribute_tensions`] by a [`TensionRule`] |
//! | minimum and maximum payload that cables within their limits hold at a pose | [`payload_bound`] |
//! | load factor, capacity margin and largest acceleration at a pose for the required loads | [`LoadCapacity`] |
//! | whether straight cables could balance every load at a pose | [`wrench_closure`] |
//! | nearest pose that fewer cables can hold (under-constrained) | [`nearest_equilibrium`] |
//! | motions that no cable opposes, as with all cables at one point of the platform | [`free_motions`] |
//! | stiffness of an equilibrium | [`tangent_stiffness`], in wind [`tangent_with_drag`] |
//! | derivatives of an equilibrium with respect to a number of the robot | [`derivatives`] |
//! | intervals of pose and tensions that friction of pulleys permits | [`friction_interval`] |
//! | wrench at any pose, energy, nearness to a singular pose | [`wrench`], [`energy`], [`tension_gain`] |
//!
//! Every solution contains an [`Equilibrium`]; every refusal is a [`StaticsError`].

// Parts of a solution: plain data.
mod equilibrium; // pose, cables, residual, stability; the limits of the residual
mod error; // reasons for the lack of an equilibrium, with their messages
mod limits; // tension limits, their defaults, distance from them
mod missing_wrench; // wrench that cables within their limits cannot apply
mod model; // ideal, spring, catenary
mod obstacle; // direction in which no cable can pull, whatever the limits

// Pieces shared by several solvers.
mod collect; // equilibrium from the cables that hang at a pose
mod dynamic_stiffness; // robot that vibrates about an equilibrium, where ropes have a second stiffness
mod energy; // potential energy, minimised by forward statics
mod exit_points; // exit points of cables over pulleys, which follow from the tensions
mod free_motion; // motions that no cable opposes, because the directions of the cables are dependent
mod initial_pose; // start pose from the lengths
mod loaded_cable; // cable with its load, before its length is known
mod residual; // residual of the balance at a pose, and its rounding
mod ropes; // ropes over sheaves: how each divides its length among its cables
mod supports; // balance of flexible supports under the forces of their cables
mod wrench_set; // wrenches that the cables can apply within their limits

// Solvers.
mod capacity;
mod closed_form; // loads that cables within their limits hold at a pose
mod equilibria; // all equilibria of given lengths that a search finds
mod forward; // lengths to pose, elastic cables
mod ideal; // rigid cables: lengths to pose, pose to tensions
mod inverse; // pose to lengths, as many cables as degrees of freedom
mod nearest_pose; // nearest pose that fewer cables than degrees of freedom can hold
mod ropes_at_pose; // pose to lengths with ropes over sheaves
mod solve; // choice of the solver by the state and the number of cables
mod tension; // pose to lengths, more cables than degrees of freedom

// Properties of an equilibrium.
pub mod derivatives; // with respect to a number of the robot
mod drag; // stiffness added by the turn of the wind's drag
mod friction; // interval in which friction of pulleys leaves the equilibrium
mod stiffness; // tangent stiffness and stability
mod tension_gain; // nearness to a singular pose

pub use capacity::{
    LoadCapacity, LoadFactor, WrenchClosure, load_factor_bounds, load_factor_verdict_in_wind, wrench_closure,
};
pub(crate) use capacity::{LoadCoefficients, required_vertices, required_wrench, robots_under_required_loads};
pub use closed_form::closed_form_margin;
pub use drag::{antisymmetric_fraction, drag_effect, drag_stiffness, stiffness_along_coordinates, tangent_with_drag};
pub use energy::energy;
pub use equilibria::{Candidate, Candidates, all_equilibria, another_stable_equilibrium};
pub use equilibrium::{CableState, Equilibrium, MAX_RESIDUAL_OF_ROUNDING, RESIDUAL_LIMIT, Stability};
pub use error::{RopeRefusal, StaticsError};
pub(crate) use exit_points::distance_inside_pulley;
pub use forward::forward;
pub(crate) use free_motion::independent_directions;
pub use free_motion::{FreeMotion, free_motions, leaves_choice};
pub use friction::{
    CableFriction, FrictionError, FrictionInterval, Held, Interval, MotionInterval, friction_exponents,
    friction_interval,
};
pub(crate) use limits::MinimumTension;
pub use limits::{Limit, LimitViolation, TensionMargin, TensionRange};
pub(crate) use loaded_cable::LoadedCable;
pub use missing_wrench::MissingWrench;
pub use model::StaticModel;
pub use nearest_pose::{NearestEquilibrium, nearest_equilibrium, pose_distance};
pub(crate) use obstacle::spread;
pub use obstacle::{Obstacle, OneSidedCause};
pub use residual::{is_unloaded, wrench};
pub use solve::{Solution, inverse, solve, solve_at, solve_held, solve_held_at};
pub(crate) use stiffness::assembled;
pub use stiffness::tangent_stiffness;
pub(crate) use supports::{SupportSide, on_support, support_side};
pub(crate) use tension::{
    CentreCable, CentreLoad, CentreRow, CentreSearch, PlatformAlong, Potential, RatesRow, TauLimit, TauLimitKind,
    TensionCurve,
};
pub use tension::{
    CentreCertificate, CentreMotion, CentreRates, HeldTensions, LimitAtCable, PayloadBound, PayloadSide,
    RequestedPayload, TensionCentre, TensionRule, centre_rates, distribute_tensions, payload_bound, tension_centre,
};
pub(crate) use tension_gain::tension_gain_exceeds;
pub use tension_gain::{inverse_condition, tension_gain};
pub use wrench_set::TensionPlace;

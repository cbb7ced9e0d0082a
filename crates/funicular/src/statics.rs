//! Static equilibrium: lengths to pose ([`forward`]), pose to lengths ([`inverse`]).
//!
//! | Question | Function |
//! |---|---|
//! | the equilibrium of a robot at its state | [`rest`] |
//! | pose from unstrained lengths | [`forward`] |
//! | every equilibrium of given lengths | [`all_equilibria`], [`another_stable_equilibrium`] |
//! | lengths from a pose, as many cables as degrees of freedom | [`inverse`] |
//! | lengths from a pose, more cables than degrees of freedom | [`distribute_tensions`] by a [`TensionRule`] |
//! | the nearest pose that fewer cables hold | [`nearest_equilibrium`] |
//! | stiffness of an equilibrium | [`tangent_stiffness`], in wind [`tangent_with_drag`] |
//! | how an equilibrium follows a number of the robot | [`derivatives`] |
//! | balance at any pose, energy, nearness to a singular pose | [`wrench`], [`energy`], [`tension_gain`] |
//!
//! Every answer is an [`Equilibrium`], every refusal a [`StaticsError`].

// The parts of an answer: plain data.
mod equilibrium; // pose, cables, residual, stability; the limits of the residual
mod error; // reasons why there is no equilibrium, with their texts
mod limits; // limits of tension, their defaults, distance from them
mod model; // ideal, spring, catenary

// Pieces that several solvers share.
mod collect; // an equilibrium made of cables that hang at a pose
mod energy; // potential energy, which forward statics minimises
mod initial_pose;
mod loaded_cable; // a cable with its load, before its length is known
mod residual; // what is left of the balance at a pose, and how much of it is rounding // a start pose from the lengths

// Solvers.
mod equilibria; // every equilibrium of given lengths that a search finds
mod forward; // lengths to pose, cables that stretch
mod ideal; // rigid cables: lengths to pose, pose to tensions
mod inverse; // pose to lengths, as many cables as degrees of freedom
mod nearest_pose; // the nearest pose that fewer cables than degrees of freedom hold
mod solve; // the choice between the solvers, by the state and the number of cables
mod tension; // pose to lengths, more cables than degrees of freedom

// Questions to an equilibrium.
pub mod derivatives; // how it follows a number of the robot
mod drag; // what the turn of the wind's drag adds to the stiffness
mod stiffness; // tangent stiffness and stability
mod tension_gain; // nearness to a singular pose

pub use drag::{antisymmetric_fraction, drag_effect, drag_stiffness, tangent_with_drag};
pub use energy::energy;
pub use equilibria::{Candidate, Candidates, all_equilibria, another_stable_equilibrium};
pub use equilibrium::{CableState, Equilibrium, MAX_RESIDUAL_OF_ROUNDING, RESIDUAL_LIMIT, Stability};
pub use error::StaticsError;
pub use forward::forward;
pub use limits::{Limit, LimitViolation, TensionMargin, TensionRange};
pub use model::StaticModel;
pub use nearest_pose::{NearestEquilibrium, nearest_equilibrium, pose_distance};
pub use residual::{carries_nothing, wrench};
pub use solve::{Solution, inverse, solve, solve_at};
pub use stiffness::{stiffness_along_coordinates, tangent_stiffness};
pub use tension::{TensionRule, distribute_tensions};
pub(crate) use tension_gain::tension_gain_exceeds;
pub use tension_gain::{inverse_condition, tension_gain};

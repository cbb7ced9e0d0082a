//! Static equilibrium: lengths to pose ([`forward`]), pose to lengths ([`inverse`]).
//!
//! | Question | Function |
//! |---|---|
//! | the equilibrium of a robot at its state | [`rest`] |
//! | pose from unstrained lengths | [`forward`] |
//! | every equilibrium of given lengths | [`all`], [`other_stable`] |
//! | lengths from a pose, as many cables as freedoms | [`inverse`] |
//! | lengths from a pose, more cables than freedoms | [`distribute`] by a [`TensionRule`] |
//! | the nearest pose that fewer cables hold | [`nearest`] |
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
mod loaded_cable; // a cable with its load, before its length is known
mod residual; // what is left of the balance at a pose, and how much of it is rounding
mod start; // a start pose from the lengths

// Solvers.
mod all; // every equilibrium of given lengths that a search finds
mod forward; // lengths to pose, cables that stretch
mod ideal; // rigid cables: lengths to pose, pose to tensions
mod inverse; // pose to lengths, as many cables as freedoms
mod nearest; // the nearest pose that fewer cables than freedoms hold
mod rest; // the choice between the solvers, by the robot's state
mod tension; // pose to lengths, more cables than freedoms

// Questions to an equilibrium.
pub mod derivatives; // how it follows a number of the robot
mod drag; // what the turn of the wind's drag adds to the stiffness
mod stiffness; // tangent stiffness and stability
mod tension_gain; // nearness to a singular pose

pub use all::{Candidate, Candidates, all, other_stable};
pub use drag::{antisymmetric_part, drag_effect, drag_stiffness, tangent_with_drag};
pub use energy::energy;
pub use equilibrium::{CableState, Equilibrium, MAX_RESIDUAL_OF_ROUNDING, RESIDUAL_LIMIT, Stability};
pub use error::StaticsError;
pub use forward::forward;
pub use inverse::inverse;
pub use limits::{Limit, Miss, TensionMargin, TensionRange};
pub use model::StaticModel;
pub use nearest::{Nearest, distance, nearest};
pub use residual::{carries_nothing, wrench};
pub use rest::{Rest, rest};
pub use stiffness::tangent_stiffness;
pub use tension::{TensionRule, distribute};
pub use tension_gain::tension_gain;
pub(crate) use tension_gain::tension_gain_exceeds;

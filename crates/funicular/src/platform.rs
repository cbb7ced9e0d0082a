//! Mechanics of the platform as a rigid body, independent of its cables: coordinates, wrenches, mass, and the stiffness
//! of forces and loads.

mod coordinates;
mod mass;
mod straight;
mod wrench;

pub(crate) use coordinates::Coordinates;
pub(crate) use mass::{damping_matrix, mass_matrix};
pub(crate) use straight::StraightCable;
pub(crate) use wrench::{
    add_congruent, add_lever_term, add_load_terms, balance, load_size, load_wrench, wrench_columns, wrench_of,
};

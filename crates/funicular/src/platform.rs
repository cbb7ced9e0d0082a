//! Mechanics of the platform as a rigid body, whatever cables hold it: wrenches and the stiffness of its loads.

mod wrench;

pub(crate) use wrench::{
    add_congruent, add_lever_term, add_load_terms, balance, load_size, load_wrench, scaled, scaled_wrench, wrench_of,
};

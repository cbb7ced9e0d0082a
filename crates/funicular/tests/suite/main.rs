//! One binary: what others published or computed, limits, properties, and broken robot files.
#![allow(missing_docs)]

mod catenary;
mod independent;
mod robot_files;

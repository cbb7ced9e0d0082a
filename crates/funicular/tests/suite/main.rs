//! One binary: what others published or computed, limits, properties, and broken robot files.
#![allow(missing_docs)]
#![allow(clippy::excessive_precision)] // published values keep their digits

mod catenary;
mod independent;
mod robot_files;

//! One binary: what others published or computed, limits, properties, and broken robot files.
#![allow(missing_docs)]
#![allow(clippy::excessive_precision, clippy::unreadable_literal, clippy::approx_constant)] // published values keep their digits

mod architecture;
mod cable;
mod campaign;
mod catenary;
mod damped;
mod exact;
mod first;
mod freedoms;
mod independent;
mod library;
mod loads;
mod modes;
mod oracle;
mod random;
mod reduction;
mod reference;
mod response;
mod robot_files;
mod several;
mod statics;
mod tension;
mod underconstrained;
mod wind;

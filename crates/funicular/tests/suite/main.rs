//! One test binary: limits, identities, properties and broken robot files, each module's in the file of its name
//! (CONTRIBUTING.md). Comparisons with other programs' and published numbers are in `funicular_validation`.
#![allow(missing_docs)]
// Published values keep their digits.
#![allow(clippy::excessive_precision, clippy::unreadable_literal, clippy::approx_constant)]

mod architecture;
mod cable;
mod cable_motion;
mod calibration;
mod catenary;
mod clearance;
mod compare;
mod control_loop;
mod control_model;
mod derivatives;
mod drive;
mod dynamic_stiffness;
mod dynamics;
mod estimation;
mod gust;
mod histories;
mod length_table;
mod level_set;
mod library;
mod modes;
mod path;
mod platform;
mod pose_error;
mod proof;
mod random;
mod reduced_model;
mod response;
mod robot;
mod ropes;
mod simulation;
mod speeds;
mod statics;
mod stretch_loss;
mod support;
mod trajectory;
mod warnings;
mod winch_needs;

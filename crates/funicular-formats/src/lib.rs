//! Files of other programs, read and written in memory.
//!
//! [`import`] makes a robot file of their descriptions of a robot, and [`new_robot`] one to start from. [`export`]
//! writes the robot at rest for them. [`measurements`] reads measured responses and frequencies for `identify`, and
//! [`uff_writing`] writes computed ones in the same format. [`fmu`] makes units of simulations of reduced models.
//! [`number_columns`] reads tables of numbers, [`gcode`] jobs of machine tools, [`belt_lengths`] readings of a machine,
//! and [`surface`] writes the surfaces of workspaces. Requests and results
//! are those of [`funicular_study`].

pub mod belt_lengths;
pub mod csv_lines;
pub mod export;
pub mod fmu;
pub mod gcode;
pub mod import;
pub mod measurements;
pub mod new_robot;
pub mod number_columns;
pub mod number_table;
mod ros_poses;
pub mod surface;
pub mod uff_writing;

/// Example of README.md, which is tested like those of the documentation.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

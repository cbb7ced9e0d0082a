//! Statics and vibration of cable-driven parallel robots whose cables sag, stretch and vibrate.
//!
//! # A tour
//!
//! Data flows one way: robot file → [`Robot`](robot::Robot) → [`Equilibrium`](statics::Equilibrium) →
//! [`Dynamics`](dynamics::Dynamics) → [`Modes`](modes::Modes) or a [response]. Every step is a free function or a
//! constructor, and its result is plain data. Nothing changes after it has been built.
//!
//! SI units throughout; angles in rad, but roll, pitch and yaw in degrees, as people write them; harmonic motion
//! e^{+iωt}. World frame `w`, platform frame `p`: `exit_w` is a point in world coordinates, `attachment_p` a point in
//! platform coordinates, and `rot_wp` turns platform coordinates into world coordinates. Wrenches, small motions and
//! the 6×6 matrices refer to the origin of the platform frame and to world axes.
//!
//! ```
//! use funicular::cable::CableModel;
//! use funicular::dynamics::{Dynamics, Linearisation};
//! use funicular::math::Vec3;
//! use funicular::modes;
//! use funicular::response::{self, Quantity};
//! use funicular::robot::{Robot, State};
//! use funicular::statics::{self, Stability, StaticModel};
//!
//! // Six cables with given unstrained lengths.
//! let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM)?;
//! let State::Lengths(lengths) = &robot.state else { panic!("its file gives lengths") };
//!
//! // Equilibrium pose of the platform; no start pose is needed.
//! let rest = statics::forward(&robot, lengths, StaticModel::Catenary, None)?;
//! assert!((rest.pose.position_w - Vec3::new(0.020305, 0.010232, 0.455485)).norm() < 1e-6);
//! assert!((rest.cables[0].tension_platform - 17.685).abs() < 1e-3); // N
//! assert!(matches!(rest.stability, Stability::Stable { .. }));
//!
//! // All natural frequencies below 20 Hz, for any sag; the Wittrick–Williams count confirms their number.
//! let exact = Linearisation { cable_model: CableModel::CatenaryDynamic, ..Linearisation::default() };
//! let dynamics = Dynamics::about(&robot, &rest, exact, 20.0)?;
//! let found = modes::below(&dynamics, 20.0);
//! assert!(found.certified && found.modes.len() == 147);
//! assert!((found.modes[0].frequency_hz - 1.020_75).abs() < 1e-5);
//!
//! // Vertical acceleration per vertical force at the platform origin.
//! let z = response::along(&Vec3::z(), &Vec3::zeros(), &rest.pose);
//! let accelerance = response::frf(&dynamics, &[1.1], &z, &z, Quantity::Acceleration)?;
//! assert!((accelerance[0].norm() - 0.011_975).abs() < 1e-5); // (m/s²)/N
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The equations are in docs/theory.md, the comparisons with published numbers in docs/validation.md.

pub mod cable;
pub mod cable_motion;
pub mod calibration;
pub mod catenary;
pub mod clearance;
pub mod compare;
pub mod control_loop;
pub mod drive;
pub mod dynamics;
pub mod estimation;
pub mod gradient;
pub mod gust;
pub mod histories;
pub mod length_table;
pub mod level_set;
pub mod math;
pub mod modes;
pub mod path;
mod platform;
pub mod pose_error;
pub mod proof;
pub mod reduced_model;
pub mod response;
pub mod robot;
pub mod simulation;
pub mod speeds;
pub mod statics;
pub mod suggest;
pub mod trajectory;
pub mod warnings;
pub mod winch_needs;

/// Number with its noun in the singular or plural: "1 cable", "2 cables", "2 frequencies", "2 masses".
#[doc(hidden)]
pub fn counted(count: usize, noun: &str) -> String {
    if count == 1 {
        return format!("{count} {noun}");
    }
    match noun.strip_suffix('y') {
        Some(stem) if !stem.ends_with(['a', 'e', 'o', 'u']) => format!("{count} {stem}ies"),
        _ if noun.ends_with('s') || noun.ends_with('x') => format!("{count} {noun}es"),
        _ => format!("{count} {noun}s"),
    }
}

/// Example of README.md, which is tested like those of the documentation.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

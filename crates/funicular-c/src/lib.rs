//! C library: statics of a cable-driven parallel robot inside a control loop, its motion in time step by step,
//! and an estimator of its state from sensors.
//!
//! `include/funicular.h` documents the functions for their callers. Here, every exported function checks the addresses
//! that it gets, copies the input, calls safe code of [`funicular::control_loop`], and writes the results if there are
//! any. No reference to memory of the caller lives longer than a call. A panic, which is a mistake in this library,
//! ends at the border: the call returns a status, and the handle is of no use any more.

mod border;
mod est_calls;
pub mod est_layout;
pub mod flat;
mod handles;
pub mod layout;
mod loop_calls;
mod model_calls;
mod owned;
mod sim_calls;
pub mod status;

pub use est_calls::*;
pub use handles::{Loop, Model};
pub use loop_calls::*;
pub use model_calls::*;
pub use owned::Owned;
pub use sim_calls::*;

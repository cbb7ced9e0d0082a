//! Statics and vibration of cable-driven parallel robots whose cables sag, stretch and vibrate.

pub mod cable;
pub mod catenary;
pub mod compare;
pub mod dynamics;
pub mod math;
pub mod modes;
pub mod pose_error;
pub mod response;
pub mod robot;
pub mod statics;
pub mod validity;

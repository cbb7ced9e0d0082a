//! Statics and vibration of cable-driven parallel robots whose cables sag, stretch and vibrate.

pub mod cable;
pub mod catenary;
pub mod dynamics;
pub mod math;
pub mod modes;
pub mod response;
pub mod robot;
pub mod statics;

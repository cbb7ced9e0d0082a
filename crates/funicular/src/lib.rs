//! Statics and vibration of cable-driven parallel robots whose cables sag, stretch and vibrate.

pub mod catenary;
pub mod math;
pub mod robot;
pub mod statics;

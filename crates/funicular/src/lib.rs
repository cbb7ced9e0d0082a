//! Statics and vibration of cable-driven parallel robots whose cables sag, stretch and vibrate.

pub mod math;
pub mod robot;

//! Winch of a cable: drum and shaft, and the cable between drum and entry point.
//!
//! All numbers refer to motion of the rope at the drum: a torsional stiffness k counts as k/R², R being the radius of the
//! drum.

/// Winch.
#[derive(Debug, Clone, PartialEq)]
pub struct Winch {
    /// Name in the robot file.
    pub name: String,
    /// Length of the rope from the drum to the entry point [m], guide wheels included.
    pub drum_side_length: f64,
    /// Mechanical stiffness of shaft, gear and drum at the rope [N/m]; infinite for a rigid winch.
    pub stiffness: f64,
}

impl Winch {
    /// Length by which the drum pays out rope per tension at rest [m/N].
    pub fn compliance(&self) -> f64 {
        1.0 / self.stiffness
    }
}

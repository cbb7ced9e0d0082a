//! Massless straight spring: k_a = EA/l, all other entries zero (the paper's reference [27]).

use super::{LocalStiffness, Sag};

/// Local stiffness [N/m] of a straight massless spring along the cable's chord.
pub fn stiffness(sag: &Sag) -> LocalStiffness<f64> {
    LocalStiffness { axial: sag.axial_stiffness / sag.chord, ..LocalStiffness::default() }
}

//! Static stiffness of a shallow sagging cable (Irvine's equivalent modulus; the paper's reference [22]).

use super::{LocalStiffness, Sag};

/// Local stiffness [N/m]: `k_a = (EA/L_e)/(1 + λ²/12)` along the chord, τ/l in both normal directions, no coupling.
///
/// Equals the shallow-dynamic stiffness at ω = 0. The exact tangent of the catenary is
/// [`super::CableModel::CatenaryStatic`].
///
/// # References
/// H. M. Irvine, Cable Structures, MIT Press 1981, section 2.5; docs/theory.md, equation (19).
pub fn stiffness(sag: &Sag) -> LocalStiffness<f64> {
    let transverse = sag.tension / sag.chord;
    LocalStiffness {
        axial: sag.axial_stiffness / sag.effective_length / (1.0 + sag.lambda2 / 12.0),
        coupling: 0.0,
        normal: transverse,
        out_of_plane: transverse,
        across: Default::default(),
    }
}

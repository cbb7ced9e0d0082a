//! Static stiffness of a shallow sagging cable (Irvine's equivalent modulus; the paper's reference [22]).

use super::situation::CableSituation;
use super::{EndStiffness, LocalAxes, LocalStiffness, NoStiffness, Sag};
use crate::math::Mat3;
use crate::robot::Robot;
use crate::statics::CableState;

/// End stiffness of a cable in this model.
pub(super) fn end(of: &CableSituation<'_>) -> Result<EndStiffness, NoStiffness> {
    let sag = of.sag();
    Ok(of.in_plane(of.along_chord(stiffness(&sag), sag.axial_stiffness / sag.effective_length)?))
}

/// Static stiffness of the free span of cable `i` [N/m].
#[expect(clippy::unnecessary_wraps, reason = "other models have none of some cables")]
pub(super) fn span(robot: &Robot, i: usize, state: &CableState) -> Option<Mat3> {
    Some(stiffness(&Sag::of(robot, i, state)).in_world(&LocalAxes::of_cable(robot, i, state)))
}

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

//! Static stiffness of the platform at an equilibrium, and stability from its eigenvalues.

use super::equilibrium::{Equilibrium, Stability};
use super::{ropes, supports};
use crate::math::{Mat3, Mat6, Vec3, Vec6, symmetric};
use crate::platform::{Coordinates, add_congruent, add_lever_term, add_load_terms};
use crate::robot::{Pose, Robot};

/// Tangent stiffness `−∂wrench/∂(δp, δθ)` of cables, platform weight and load at an equilibrium, about the platform
/// origin, world axes [N/m, N, N·m]. This is the `Consistent` static stiffness; symmetric at an equilibrium.
///
/// Every load keeps its direction: in wind this is the stiffness with the drag of the equilibrium held. The stiffness
/// with a drag that turns with the cables is [`tangent_with_drag`].
///
/// Flexible supports yield, and ropes run over sheaves without friction. `None` for ideal cables, which have no finite
/// stiffness. Zero for motions that the platform does not have. The antisymmetric half of a moment's stiffness is left
/// out: such a moment has no energy.
///
/// # References
/// docs/theory.md, equations (14), (91) and (92f).
pub fn tangent_stiffness(robot: &Robot, equilibrium: &Equilibrium) -> Option<Mat6> {
    let parts: Option<Vec<_>> = equilibrium
        .cables
        .iter()
        .map(|cable| Some((cable.tangent_w()?, cable.force_on_platform_w, cable.lever_w)))
        .collect();
    let mut whole = assembled(robot, &equilibrium.pose, parts?.into_iter());
    if robot.has_supports() {
        let carried = equilibrium.cables.iter().enumerate().filter_map(|(i, cable)| {
            let held = cable.hanging.as_ref()?.tangent_w();
            Some((i, supports::on_support(robot, i, cable, &held)?, cable.lever_w))
        });
        whole -= supports::lost_stiffness(robot, carried);
    }
    if robot.has_ropes_over_sheaves() {
        whole -= ropes::lost_at_rest(robot, &equilibrium.cables)?;
    }
    Some(Coordinates::of(robot).allowed_matrix(&whole))
}

/// Sum of the stiffness of cables and the geometric stiffness of weight and load at a pose. A cable is given by its 3×3
/// stiffness, its force on the platform and its lever arm.
pub(crate) fn assembled(robot: &Robot, pose: &Pose, cables: impl Iterator<Item = (Mat3, Vec3, Vec3)>) -> Mat6 {
    let mut total = Mat6::zeros();
    for (stiffness, force, lever) in cables {
        add_congruent(&mut total, &stiffness, &lever);
        add_lever_term(&mut total, &force, &lever);
    }
    add_load_terms(&mut total, robot, pose);
    total
}

impl Stability {
    /// True if every small displacement meets resistance; `None` for ideal cables, which are rigid, so that stability
    /// has no meaning for them.
    pub fn is_stable(&self) -> Option<bool> {
        match self {
            Self::Stable { .. } => Some(true),
            Self::Unstable { .. } => Some(false),
            Self::Rigid => None,
        }
    }

    /// True if nothing holds the platform in some direction, and nothing drives it away in any.
    pub fn is_indifferent(&self) -> bool {
        matches!(self, Self::Unstable { min_stiffness: 0.0, .. })
    }

    /// Minimum eigenvalue of the scaled stiffness [N/m]; `None` for ideal cables.
    pub fn min_stiffness(&self) -> Option<f64> {
        match *self {
            Self::Stable { min_stiffness } | Self::Unstable { min_stiffness, .. } => Some(min_stiffness),
            Self::Rigid => None,
        }
    }
}

/// Orthonormal motions, reduced, along which a reduced stiffness is zero but for rounding.
pub(super) fn indifferent_motions(stiffness: &Mat6, dof: usize) -> Vec<Vec6> {
    let (values, vectors) = symmetric::eigen(stiffness, dof);
    let zero = rounding(&values);
    values.iter().zip(vectors).filter(|(value, _)| value.abs() <= zero).map(|(_, vector)| vector).collect()
}

/// Size below which an eigenvalue is rounding in the sum of the cables' stiffnesses; observed: 1e-16 of the largest.
fn rounding(values: &[f64]) -> f64 {
    1e-12 * values.iter().fold(0.0_f64, |m, v| m.max(v.abs()))
}

pub(super) fn stability(robot: &Robot, stiffness: &Mat6) -> Stability {
    let coordinates = Coordinates::of(robot);
    let values = symmetric::eigenvalues(&coordinates.reduce_symmetric(stiffness), coordinates.count());
    let zero = rounding(&values);
    let directions = values.iter().filter(|v| **v <= zero).count();
    match directions {
        0 => Stability::Stable { min_stiffness: values[0] },
        _ => Stability::Unstable { min_stiffness: if values[0] < -zero { values[0] } else { 0.0 }, directions },
    }
}

//! Closed-form tensions: a sufficient test that others use, for comparison.

use super::limits::TensionRange;
use crate::math::{Mat6, Vec6, inverse6};
use crate::platform::{Coordinates, StraightCable, load_wrench};
use crate::robot::{Pose, Robot};

/// Distance of the closed-form tensions from their limits [N], with straight cables; negative if one is beyond its
/// limit. The tensions are the middles of their limits with the least change, in the sum of squares, that balances the
/// load.
///
/// Where it is positive the pose is feasible, but not the other way round: other tensions may be within the limits. The
/// program uses it nowhere else. `None` without maximum tensions, and where the cables do not span all degrees of
/// freedom.
///
/// # References
/// docs/theory.md, equation (40z).
pub fn closed_form_margin(robot: &Robot, pose: &Pose) -> Option<f64> {
    let coordinates = Coordinates::of(robot);
    let mut cables = Vec::with_capacity(robot.cables.len());
    for (i, cable) in robot.cables.iter().enumerate() {
        let straight = StraightCable::at(cable, pose);
        let range = TensionRange::of(robot, i, &straight.chord_w);
        if straight.chord_w.norm() == 0.0 || !range.maximum.is_finite() {
            return None;
        }
        cables.push((straight.unit_wrench(&coordinates), range, f64::midpoint(range.minimum, range.maximum)));
    }

    // Beyond the degrees of freedom all wrenches are zero, and any regular entry gives zero.
    let mut gram = Mat6::from_fn(|i, k| f64::from(u8::from(i == k && i >= coordinates.count())));
    let mut unbalanced: Vec6 = coordinates.reduce(&load_wrench(robot, pose));
    for (wrench, _, middle) in &cables {
        gram += wrench * wrench.transpose();
        unbalanced += *wrench * *middle;
    }
    let change = inverse6(&gram)? * unbalanced;

    let margin = |(wrench, range, middle): &(Vec6, TensionRange, f64)| {
        let tension = middle - wrench.dot(&change);
        (tension - range.minimum).min(range.maximum - tension)
    };
    cables.iter().map(margin).reduce(f64::min).filter(|margin| margin.is_finite())
}

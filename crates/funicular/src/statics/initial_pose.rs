//! Start pose from the lengths alone.

use crate::math::{Mat6, Vec3, Vec6};
use crate::platform::{Coordinates, StraightCable};
use crate::robot::{PlatformMotion, Pose, Robot};

/// Maximum number of steps. Only a start pose is needed: the gaps need not vanish, because sagging cables are longer
/// than the chord.
const MAX_STEPS: usize = 20;

/// Initial damping of the normal equations, whose entries are about one per cable, and its limits. Far below the
/// initial value, the first step from a place where the rows are nearly dependent throws the platform far away; far
/// above, twenty steps do not arrive. The lower limit keeps the matrix positive definite in rounding; at the upper
/// limit a step is a thousandth of the gap, and the search ends.
const FIRST_DAMPING: f64 = 1e-3;
const MIN_DAMPING: f64 = 1e-9;
const MAX_DAMPING: f64 = 1e3;

/// Factor of the damping after a step that did not reduce the gaps; its inverse after a step that did (Marquardt).
const DAMPING_FACTOR: f64 = 10.0;

/// Minimum relative decrease of the sum of squared gaps per step, below which the search ends. A larger value gives
/// start poses whose deficits cost more than the saved steps; with a smaller value the twenty steps are spent on work
/// that forward statics does better.
const MIN_GAIN: f64 = 1e-3;

/// Sum of squared gaps [m²] that counts as zero: a tenth of a millimetre, far less than any cable sags or stretches.
const CLOSED: f64 = 1e-8;

/// Minimum distance between the ends of a cable with a direction [m]; nearer ends count as this far apart.
const MIN_DISTANCE: f64 = 1e-12;

/// Pose at which straight cables of the given lengths [m] come closest to closing, in least squares.
///
/// The search starts with the platform upright, as far below the middle of the anchors as the lengths allow.
pub(super) fn pose_from_lengths(robot: &Robot, lengths: &[f64]) -> Pose {
    let n = robot.cables.len() as f64;

    // Start: the platform upright, below the middle of the anchors.
    let up_w = robot.up_w();
    let anchors = robot.cables.iter().map(|c| c.anchor.reference_w()).sum::<Vec3>() / n;
    let attachments = robot.cables.iter().map(|c| c.attachment_p).sum::<Vec3>() / n;
    // Point-like platform: Σ|p − B|²/n = |p − B̄|² + Σ|B − B̄|²/n = Σ L²/n.
    let spread = robot.cables.iter().map(|c| (c.anchor.reference_w() - anchors).norm_squared()).sum::<f64>() / n;
    let reach = lengths.iter().map(|l| l * l).sum::<f64>() / n - spread;
    let mut pose = Pose {
        position_w: anchors - up_w * reach.max(0.0).sqrt() - attachments,
        rot_wp: crate::math::Rotation::identity(),
    };

    // Move into the plane of a planar platform.
    let coordinates = Coordinates::of(robot);
    if let PlatformMotion::Planar(plane) = coordinates.motion() {
        pose.position_w -= plane.normal_w() * plane.distance(&pose.position_w);
    }

    // Damped least squares (Levenberg and Marquardt).
    let mut damping = FIRST_DAMPING;
    let mut gaps = closure(robot, lengths, &pose, &coordinates);
    for _ in 0..MAX_STEPS {
        // Damped step.
        let (normal, gradient, cost) = gaps;
        let Some(factor) = (normal + Mat6::identity() * damping).cholesky() else { break };
        let next = coordinates.moved(&pose, &factor.solve(&gradient));
        let next_gaps = closure(robot, lengths, &next, &coordinates);

        // Take it if the gaps get smaller.
        if next_gaps.2 < cost {
            let gained = cost - next_gaps.2;
            (pose, gaps) = (next, next_gaps);
            damping = (damping * (1.0 / DAMPING_FACTOR)).max(MIN_DAMPING);
            if gained < MIN_GAIN * gaps.2 || gaps.2 < CLOSED {
                break;
            }
        } else {
            damping *= DAMPING_FACTOR;
            if damping > MAX_DAMPING {
                break;
            }
        }
    }

    pose
}

/// Normal matrix, gradient and cost of the closure gaps `|B − A| − L`, with rotations scaled by ℓ.
fn closure(robot: &Robot, lengths: &[f64], pose: &Pose, coordinates: &Coordinates) -> (Mat6, Vec6, f64) {
    let (mut normal, mut gradient, mut cost) = (Mat6::zeros(), Vec6::zeros(), 0.0);
    for (cable, length) in robot.cables.iter().zip(lengths) {
        let StraightCable { lever_w, chord_w } = StraightCable::at(cable, pose);
        let distance = chord_w.norm().max(MIN_DISTANCE);
        let row = coordinates.reduce_force(&(chord_w / distance), &lever_w);
        let beyond = cable.anchor.length_beyond(&(pose.position_w + lever_w));
        let gap = distance + beyond - length;
        normal += row * row.transpose();
        gradient += row * gap;
        cost += gap * gap;
    }
    (normal, gradient, cost)
}

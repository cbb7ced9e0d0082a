//! A start pose from the lengths alone.

use crate::math::{Mat6, Vec3, Vec6};
use crate::platform::{Coordinates, StraightCable};
use crate::robot::{Freedoms, Pose, Robot};

/// The pose at which straight cables of the given lengths [m] come closest to closing, in least squares.
///
/// Starts with the platform upright, below the middle of the anchors as far as the lengths allow.
pub(super) fn pose_from_lengths(robot: &Robot, lengths: &[f64]) -> Pose {
    let n = robot.cables.len() as f64;
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
    let coordinates = Coordinates::of(robot);
    if let Freedoms::Planar(plane) = coordinates.freedoms() {
        pose.position_w -= plane.normal_w() * plane.distance(&pose.position_w);
    }
    let mut damping = 1e-3;
    let mut gaps = closure(robot, lengths, &pose, &coordinates);
    // Only a start is wanted: the gaps need not vanish, sagging cables are longer than the chord.
    for _ in 0..20 {
        let (normal, gradient, cost) = gaps;
        let Some(factor) = (normal + Mat6::identity() * damping).cholesky() else { break };
        let next = coordinates.moved(&pose, &factor.solve(&gradient));
        let next_gaps = closure(robot, lengths, &next, &coordinates);
        if next_gaps.2 < cost {
            let gained = cost - next_gaps.2;
            (pose, gaps) = (next, next_gaps);
            damping = (damping * 0.1).max(1e-9);
            if gained < 1e-3 * gaps.2 || gaps.2 < 1e-8 {
                break;
            }
        } else {
            damping *= 10.0;
            if damping > 1e3 {
                break;
            }
        }
    }
    pose
}

/// Normal matrix, gradient and cost of the closure gaps `|B − A| − L`, rotations scaled by ℓ.
fn closure(robot: &Robot, lengths: &[f64], pose: &Pose, coordinates: &Coordinates) -> (Mat6, Vec6, f64) {
    let (mut normal, mut gradient, mut cost) = (Mat6::zeros(), Vec6::zeros(), 0.0);
    for (cable, length) in robot.cables.iter().zip(lengths) {
        let StraightCable { lever_w, chord_w } = StraightCable::at(cable, pose);
        let distance = chord_w.norm().max(1e-12);
        let row = coordinates.reduce_force(&(chord_w / distance), &lever_w);
        let beyond = cable.anchor.length_beyond(&(pose.position_w + lever_w));
        let gap = distance + beyond - length;
        normal += row * row.transpose();
        gradient += row * gap;
        cost += gap * gap;
    }
    (normal, gradient, cost)
}

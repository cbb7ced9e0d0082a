//! Ideal cables: straight, massless and rigid in length.

use super::equilibrium::{CableState, Equilibrium, Stability};
use super::error::StaticsError;
use super::model::StaticModel;
use super::residual::residual_of;
use crate::math::{Mat6, Vec3, Vec6, inverse6};
use crate::platform::{Coordinates, StraightCable, load_wrench};
use crate::robot::{Pose, Robot};

/// Largest gap over the longest length at which the lengths are closed, rounding being 1e-16 per cable; and the value
/// that still counts as closed where rounding leaves more, near singular poses.
const CLOSED: f64 = 1e-14;
const NEARLY_CLOSED: f64 = 1e-10;

/// Maximum number of steps, a guard: a search that does not converge ends by [`MIN_FRACTION`].
const MAX_ITERATIONS: usize = 100;

/// Minimum fraction of Newton's step: if a step cut to this fraction does not reduce the gap, the search has reached a
/// local minimum of the gap.
const MIN_FRACTION: f64 = 1e-6;

/// Bound of the balance's condition number below which singular values need not be computed; and the ratio of the
/// smallest to the largest singular value below which a pose is singular. At this ratio ten of the tensions' sixteen
/// digits are lost; a limit nearer to 1 would refuse poses that are merely badly conditioned.
const MAX_BOUND: f64 = 1e9;
const SINGULAR: f64 = 1e-10;

/// Forward statics of ideal cables: first the closure of the lengths, then the tensions from the wrench balance.
pub(super) fn forward(robot: &Robot, lengths: &[f64], start: Pose) -> Result<Equilibrium, StaticsError> {
    let coordinates = Coordinates::of(robot);
    let mut pose = start;
    let mut iterations = 0;
    let gap_of = |pose: &Pose| {
        robot
            .cables
            .iter()
            .zip(lengths)
            .fold(0.0_f64, |worst, (cable, length)| worst.max((cable.straight_length(pose) - length).abs()))
    };

    // Find the pose at which the cables have their lengths.
    let longest = lengths.iter().copied().fold(0.0, f64::max);
    let mut gap = gap_of(&pose);
    while gap > CLOSED * longest && iterations < MAX_ITERATIONS {
        iterations += 1;

        // Newton's step.
        let columns = unit_wrenches(robot, &pose, &coordinates);
        let rows = columns.transpose();
        let gaps = Vec6::from_fn(|i, _| match (robot.cables.get(i), lengths.get(i)) {
            (Some(cable), Some(length)) => cable.straight_length(&pose) - length,
            _ => 0.0,
        });
        let step = rows.lu().solve(&gaps).ok_or_else(|| StaticsError::singular(robot, &pose, StaticModel::Ideal))?;
        let step = coordinates.expand(&step);

        // Halve the step until the gap falls.
        let mut part = 1.0;
        let next = loop {
            let translation = Vec3::new(step[0], step[1], step[2]) * part;
            let turn = Vec3::new(step[3], step[4], step[5]) * (part / coordinates.ell());
            let next = pose.moved(&translation, &turn);
            if gap_of(&next) < gap {
                break Some(next);
            }
            part *= 0.5;
            if part < MIN_FRACTION {
                break None;
            }
        };
        let Some(next) = next else { break };
        pose = next;
        gap = gap_of(&pose);
    }
    if gap > NEARLY_CLOSED * longest {
        let p = pose.position_w;
        let (residual, limit) = (gap / longest, NEARLY_CLOSED);
        return Err(StaticsError::NotConverged { iterations, residual, limit, x: p.x, y: p.y, z: p.z });
    }

    // Tensions at this pose.
    let tensions = straight_tensions(robot, &pose, &load_wrench(robot, &pose))?;
    if let Some((i, tension)) = most_negative(&tensions) {
        let (cable, p) = (robot.cables[i].name.clone(), pose.position_w);
        return Err(StaticsError::LengthsPush { cable, tension, x: p.x, y: p.y, z: p.z });
    }
    Ok(collect(robot, pose, &tensions, iterations))
}

/// Maximum number of rounds of [`forward_of_few`], a guard: a round leaves about the strain of the cables as a fraction
/// of the gap, so that two to six are observed.
const MAX_ROUNDS: usize = 60;

/// Minimum ratio of an unstrained length in one round to that before, so that lengths stay positive.
const MIN_SHORTENED: f64 = 0.5;

/// Forward statics of fewer ideal cables than degrees of freedom: the platform hangs as low as its cables allow.
///
/// `springs` solves the problem for straight cables that stretch: from unstrained lengths [m] and a start to a stable
/// equilibrium. The unstrained lengths are shortened until the stretched cables have the given lengths. Rigid cables of
/// these lengths then have the equilibrium, too, since the forces of straight cables do not depend on their stiffness.
/// An equilibrium that is stable for cables that stretch is stable for rigid ones.
///
/// # References
/// docs/theory.md, section 14.
pub(super) fn forward_of_few(
    robot: &Robot,
    lengths: &[f64],
    start: Pose,
    springs: impl Fn(&[f64], Pose) -> Result<Equilibrium, StaticsError>,
) -> Result<Equilibrium, StaticsError> {
    let longest = lengths.iter().copied().fold(0.0, f64::max);
    let mut unstrained = lengths.to_vec();
    let (mut pose, mut iterations, mut relative) = (start, 0, f64::INFINITY);

    for _ in 0..MAX_ROUNDS {
        // Rest of the cables that stretch.
        let rest = springs(&unstrained, pose)?;
        pose = rest.pose;
        iterations += rest.iterations;

        // Lengths that are missing; a slack cable may be longer than its path.
        let gaps = robot.cables.iter().zip(&rest.cables).zip(lengths).map(|((cable, state), length)| {
            let gap = length - cable.straight_length(&pose);
            if state.is_slack() { gap.min(0.0) } else { gap }
        });
        let gaps: Vec<f64> = gaps.collect();
        let before = relative;
        relative = gaps.iter().fold(0.0, |most: f64, gap| most.max(gap.abs())) / longest;

        // End where they are closed as well as rounding allows.
        if relative <= CLOSED || (relative <= NEARLY_CLOSED && relative >= before) {
            let tensions: Vec<f64> = rest.cables.iter().map(|cable| cable.tension_platform).collect();
            let mut found = collect(robot, pose, &tensions, iterations);
            for (state, length) in found.cables.iter_mut().zip(lengths) {
                state.unstrained_length = *length;
            }
            return Ok(found);
        }

        // Shorten the unstrained lengths by the gaps.
        for (length, gap) in unstrained.iter_mut().zip(gaps) {
            *length = (*length + gap).max(MIN_SHORTENED * *length);
        }
    }

    let p = pose.position_w;
    Err(StaticsError::NotConverged { iterations, residual: relative, limit: NEARLY_CLOSED, x: p.x, y: p.y, z: p.z })
}

/// Rounding of a tension relative to the largest one: a cable with zero tension gets the wrong sign in about half of
/// all cases. The condition number of the balance, which is up to 1e10, may cause more; then the pose is nearly
/// singular.
const ZERO_TENSION: f64 = 1e-12;

/// Straight cable with the most negative tension, and this tension [N], if one is negative beyond rounding.
pub(super) fn most_negative(tensions: &[f64]) -> Option<(usize, f64)> {
    let largest = tensions.iter().fold(0.0, |most: f64, tension| most.max(tension.abs()));
    let least = tensions.iter().copied().enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
    least.filter(|(_, tension)| *tension < -ZERO_TENSION * largest)
}

/// Wrenches (e, r × e/ℓ) of unit tensions of straight cables in the platform's coordinates, as columns; columns of the
/// identity beyond them.
fn unit_wrenches(robot: &Robot, pose: &Pose, coordinates: &Coordinates) -> Mat6 {
    let mut columns = Mat6::identity();
    for (i, cable) in robot.cables.iter().enumerate().take(6) {
        columns.set_column(i, &StraightCable::at(cable, pose).unit_wrench(coordinates));
    }
    columns
}

/// Tensions of straight cables, as many as degrees of freedom, that balance a wrench about the platform origin.
pub(super) fn straight_tensions(robot: &Robot, pose: &Pose, load: &Vec6) -> Result<Vec<f64>, StaticsError> {
    for cable in &robot.cables {
        if cable.chord_w(pose).norm() == 0.0 {
            return Err(StaticsError::CoincidingEnds { cable: cable.name.clone() });
        }
    }

    let coordinates = Coordinates::of(robot);
    let right = -coordinates.reduce(load);
    let columns = unit_wrenches(robot, pose, &coordinates);
    let singular = || StaticsError::singular(robot, pose, StaticModel::Ideal);
    if is_singular(&columns) {
        return Err(singular());
    }
    let tensions = columns.lu().solve(&right).ok_or_else(singular)?;
    Ok(tensions.iter().copied().take(robot.cables.len()).collect())
}

/// True if the unit wrenches of as many straight cables as degrees of freedom are dependent.
fn is_singular(columns: &Mat6) -> bool {
    let Some(inverse) = inverse6(columns) else { return true };
    // Frobenius norms bound the condition number from above and cost a tenth of the singular values.
    let bound = columns.norm() * inverse.norm();
    if bound <= MAX_BOUND {
        return false;
    }
    let singular = columns.svd(false, false).singular_values;
    singular.min() < SINGULAR * singular.max()
}

/// True if as many straight cables as degrees of freedom have independent directions at a pose.
pub(super) fn is_determinate(robot: &Robot, pose: &Pose) -> bool {
    !is_singular(&unit_wrenches(robot, pose, &Coordinates::of(robot)))
}

/// Equilibrium of ideal cables.
pub(super) fn collect(robot: &Robot, pose: Pose, tensions: &[f64], iterations: usize) -> Equilibrium {
    let cables: Vec<CableState> = robot
        .cables
        .iter()
        .zip(tensions)
        .map(|(cable, &tension)| {
            let attachment_w = pose.point_w(&cable.attachment_p);
            let chord = cable.chord_w(&pose);
            CableState {
                attachment_w,
                lever_w: attachment_w - pose.position_w,
                anchor_w: cable.anchor.exit_w(&attachment_w),
                unstrained_length: cable.straight_length(&pose),
                force_on_platform_w: chord.normalize() * tension,
                tension_platform: tension,
                tension_anchor: tension,
                hanging: None,
                drive: None,
                displacement_w: Vec3::zeros(),
            }
        })
        .collect();

    let residual = residual_of(robot, &pose, &cables);
    Equilibrium { pose, model: StaticModel::Ideal, cables, residual, iterations, stability: Stability::Rigid }
}

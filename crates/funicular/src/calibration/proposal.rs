//! Poses that reduce the deviations most if they are measured next (96k).

use super::elimination::EliminatedRow;
use super::frame::CalibrationFrame;
use super::{Calibration, CalibrationFit, CalibrationPrecision, MeasuredRow};
use crate::math::{DMat, DVec};
use crate::robot::Pose;

/// Pose to measure.
#[derive(Debug, Clone)]
pub struct ProposedPose {
    /// Index of the candidate.
    pub candidate: usize,
    /// Readings of all cables at this pose with the present values [m].
    pub readings: Vec<f64>,
    /// Root of the sum of the variances of the chosen unknowns after this pose and those before it are measured.
    pub total: f64,
    /// Standard deviation of each unknown then.
    pub deviations: Vec<f64>,
}

/// Chooses poses one after the other, each so that the sum of the variances of the chosen unknowns falls most. `weights`
/// are factors of the variances, one per unknown.
pub fn proposals(
    of: &Calibration,
    fit: &CalibrationFit,
    frame: &CalibrationFrame,
    precision: &CalibrationPrecision,
    candidates: &[Pose],
    count: usize,
    weights: &[f64],
) -> Vec<ProposedPose> {
    // A pose of elastic cables has tensions of its own choice.
    if of.is_elastic() {
        return Vec::new();
    }
    let robot = of.robot_at(&fit.values);
    let reading = |pose: &Pose| -> Vec<f64> {
        let cables = robot.robot.cables.iter().zip(&robot.offsets);
        cables.map(|(cable, offset)| (cable.straight_length(pose) - offset) / robot.scale).collect()
    };
    let readings: Vec<Vec<f64>> = candidates.iter().map(reading).collect();
    let net: Vec<Option<DMat>> = candidates
        .iter()
        .zip(&readings)
        .map(|(pose, readings)| {
            let terms = of.row_terms(&robot, &MeasuredRow::of_readings(readings), pose);
            let row = EliminatedRow::of(&terms, &frame.free, None);
            row.fixes_pose().then_some(row.net)
        })
        .collect();
    let weighted = DMat::from_fn(frame.free.nrows(), frame.free.ncols(), |i, j| weights[i] * frame.free[(i, j)]);
    let weight = frame.free.transpose() * weighted;

    // Along a combination that no row sees, all that is known is the size of the robot.
    let mut covariance = precision.free_covariance.clone();
    for lost in &precision.lost {
        let direction = frame.free.transpose() * DVec::from_column_slice(lost) * of.anchor_spread();
        covariance += &direction * direction.transpose();
    }
    let mut proposed = Vec::new();
    for _ in 0..count {
        let now = (&weight * &covariance).trace();
        let best = net
            .iter()
            .enumerate()
            .filter_map(|(k, net)| {
                let gain = gain(&covariance, &weight, net.as_ref()?)?;
                gain.is_finite().then_some((k, gain))
            })
            .max_by(|a, b| a.1.total_cmp(&b.1));
        let Some((candidate, gain)) = best else { break };
        let Some(next) = net[candidate].as_ref().and_then(|net| with_row(&covariance, net)) else { break };
        covariance = next;
        let full = &frame.free * &covariance * frame.free.transpose();
        proposed.push(ProposedPose {
            candidate,
            readings: readings[candidate].clone(),
            total: (now - gain).max(0.0).sqrt(),
            deviations: full.diagonal().iter().map(|variance| variance.max(0.0).sqrt()).collect(),
        });
    }
    proposed
}

/// Decrease of the weighted sum of variances by a row: trace of `(I + W S Wᵀ)⁻¹ W S w S Wᵀ`.
fn gain(covariance: &DMat, weight: &DMat, net: &DMat) -> Option<f64> {
    let seen = covariance * net.transpose();
    let inner = DMat::identity(net.nrows(), net.nrows()) + net * &seen;
    let solved = inner.cholesky()?.solve(&seen.transpose());
    Some((solved * weight * seen).trace())
}

/// Covariance with one more row.
fn with_row(covariance: &DMat, net: &DMat) -> Option<DMat> {
    let seen = covariance * net.transpose();
    let inner = DMat::identity(net.nrows(), net.nrows()) + net * &seen;
    let solved = inner.cholesky()?.solve(&seen.transpose());
    Some(covariance - seen * solved)
}

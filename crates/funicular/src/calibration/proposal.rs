//! Poses that reduce the deviations most if they are measured next (96k).

use super::elastic::RowState;
use super::elimination::EliminatedRow;
use super::frame::CalibrationFrame;
use super::{CalibratedRobot, Calibration, CalibrationFit, CalibrationPrecision, MeasuredRow, ToolRows};
use crate::math::chosen_rows::{ChosenRows, RowCriterion, choose_rows};
use crate::math::{DMat, DVec};
use crate::robot::Pose;

/// Pose that can be measured.
#[derive(Debug, Clone, PartialEq)]
pub struct CandidatePose {
    /// Pose.
    pub pose: Pose,
    /// Unstrained lengths of elastic cables with which the platform rests there [m]; empty for straight rigid ones.
    pub lengths: Vec<f64>,
}

impl From<Pose> for CandidatePose {
    fn from(pose: Pose) -> Self {
        Self { pose, lengths: Vec::new() }
    }
}

/// Quantity whose variance proposed poses reduce.
#[derive(Debug, Clone, Copy)]
pub enum ProposalAim<'a> {
    /// Unknowns, with factors of their variances; a factor of stiffness or mass counts as one length of mean variance.
    Unknowns(&'a [f64]),
    /// Position of the platform at the poses of these rows (96n), the same weight for each.
    Tool(&'a [ToolRows]),
}

/// Pose to measure.
#[derive(Debug, Clone)]
pub struct ProposedPose {
    /// Index of the candidate.
    pub candidate: usize,
    /// Readings of all cables at this pose with the present values [m].
    pub readings: Vec<f64>,
    /// Covariance of the unknowns after this pose and those before it are measured.
    pub covariance: DMat,
    /// Root of the sum of the variances of the lengths then, those of an aim at unknowns with their factors [m].
    pub total: f64,
    /// Standard deviation of each unknown then.
    pub deviations: Vec<f64>,
}

/// Chooses poses one after the other, each so that the criterion falls most. At each pose is measured what the rows
/// have: readings of all cables, and the tensions and coordinates that any row has.
pub fn proposals(
    of: &Calibration,
    fit: &CalibrationFit,
    (frame, precision): (&CalibrationFrame, &CalibrationPrecision),
    candidates: &[CandidatePose],
    (count, criterion): (usize, RowCriterion),
    aim: ProposalAim<'_>,
) -> Vec<ProposedPose> {
    let robot = of.robot_at(&fit.values);
    let readings: Vec<Vec<f64>> = candidates.iter().map(|candidate| robot.readings(candidate)).collect();
    let measured = of.measured_kinds();
    let net: Vec<Option<DMat>> = candidates
        .iter()
        .zip(&readings)
        .map(|(candidate, readings)| {
            let row = MeasuredRow { readings: MeasuredRow::of_readings(readings).readings, ..measured.clone() };
            let state = RowState { pose: candidate.pose, lengths: candidate.lengths.clone() };
            let row = EliminatedRow::of(&of.terms_of(&robot, &row, &state)?, &frame.free, None);
            row.fixes_pose().then_some(row.net)
        })
        .collect();
    // Along a combination that no row sees, all that is known is the size of the robot.
    let mut covariance = precision.free_covariance.clone();
    for lost in &precision.lost {
        let direction = frame.free.transpose() * DVec::from_column_slice(lost) * of.anchor_spread();
        covariance += &direction * direction.transpose();
    }
    let over_unknowns = match aim {
        ProposalAim::Unknowns(weights) => {
            let sizes = of.natural_sizes(&(&frame.free * &covariance * frame.free.transpose()));
            DMat::from_diagonal(&DVec::from_fn(weights.len(), |i, _| weights[i] * sizes[i] * sizes[i]))
        }
        ProposalAim::Tool(rows) => {
            let squares = rows.iter().map(|row| row.position.transpose() * &row.position);
            squares.fold(DMat::zeros(of.unknowns.len(), of.unknowns.len()), |sum, square| sum + square)
        }
    };
    let weight = frame.free.transpose() * over_unknowns * &frame.free;
    let proposed = |ChosenRows { candidate, covariance }: ChosenRows| {
        let full = &frame.free * &covariance * frame.free.transpose();
        let factor = |k: usize| match aim {
            ProposalAim::Unknowns(weights) => weights[k],
            ProposalAim::Tool(_) => 1.0,
        };
        let lengths = (0..full.nrows()).filter(|&k| of.is_length(k));
        ProposedPose {
            candidate,
            readings: readings[candidate].clone(),
            total: lengths.map(|k| factor(k) * full[(k, k)]).sum::<f64>().max(0.0).sqrt(),
            deviations: full.diagonal().iter().map(|variance| variance.max(0.0).sqrt()).collect(),
            covariance: full,
        }
    };
    choose_rows(&covariance, &weight, &net, count, criterion).into_iter().map(proposed).collect()
}

impl CalibratedRobot {
    /// Readings of all cables at a pose.
    fn readings(&self, candidate: &CandidatePose) -> Vec<f64> {
        let cables = self.robot.cables.iter().zip(&self.offsets).enumerate();
        let reading = |(i, (cable, offset)): (usize, (&crate::robot::Cable, &f64))| {
            let length = candidate.lengths.get(i).copied().unwrap_or_else(|| cable.straight_length(&candidate.pose));
            (length - offset) / self.scale
        };
        cables.map(reading).collect()
    }
}

impl Calibration {
    /// Row with the kinds of data besides readings that any of the rows has; the values have no meaning.
    fn measured_kinds(&self) -> MeasuredRow {
        let any = |has: &dyn Fn(&MeasuredRow) -> bool| self.rows.iter().any(has).then_some(0.0);
        let tension = |cable: usize| any(&|row: &MeasuredRow| row.tensions.get(cable).copied().flatten().is_some());
        MeasuredRow {
            position: [0, 1, 2].map(|axis| any(&|row: &MeasuredRow| row.position[axis].is_some())),
            angles: [0, 1, 2].map(|axis| any(&|row: &MeasuredRow| row.angles[axis].is_some())),
            tensions: (0..self.robot.cables.len()).map(tension).collect(),
            ..MeasuredRow::default()
        }
    }
}

//! Rows of elastic, sagging cables: the unknowns of a row are the true unstrained lengths of its cables, and the pose
//! follows from them.

use super::row::RowTerms;
use super::{CalibratedRobot, Calibration, CalibrationUnknown, MeasuredRow};
use crate::math::{DMat, DVec, Vec3};
use crate::robot::{CableChange, Pose, RobotChange};
use crate::statics::{self, Equilibrium, StaticModel, derivatives};

/// Unknowns of one row: its pose, and where cables are elastic their unstrained lengths [m], of which the pose follows.
#[derive(Debug, Clone)]
pub(super) struct RowState {
    pub(super) pose: Pose,
    /// Empty for straight rigid cables.
    pub(super) lengths: Vec<f64>,
}

impl Calibration {
    /// True if cables stretch or sag, so that a row needs more than lengths.
    pub fn is_elastic(&self) -> bool {
        self.model != StaticModel::Ideal
    }

    /// States in which a search begins: at poses, with the lengths of the readings.
    pub(super) fn states(&self, values: &[f64], poses: &[Pose]) -> Vec<RowState> {
        let at = self.robot_at(values);
        let state = |(row, pose): (&MeasuredRow, &Pose)| {
            if !self.is_elastic() {
                return RowState { pose: *pose, lengths: Vec::new() };
            }
            let length = |(i, cable): (usize, &crate::robot::Cable)| {
                let read = row.readings.get(i).copied().flatten();
                read.map_or_else(|| cable.straight_length(pose), |reading| at.offsets[i] + at.scale * reading)
            };
            RowState { pose: *pose, lengths: at.robot.cables.iter().enumerate().map(length).collect() }
        };
        self.rows.iter().zip(poses).map(state).collect()
    }

    /// State after a step of the row's unknowns.
    pub(super) fn moved_state(&self, state: &RowState, step: &DVec) -> RowState {
        if self.is_elastic() {
            let lengths = state.lengths.iter().zip(step.iter()).map(|(length, step)| length + step).collect();
            return RowState { pose: state.pose, lengths };
        }
        RowState { pose: self.moved(&state.pose, step), lengths: Vec::new() }
    }

    /// Residuals of a row, with its state at rest; `None` without an equilibrium.
    pub(super) fn row_residuals(
        &self,
        at: &CalibratedRobot,
        row: &MeasuredRow,
        state: &RowState,
    ) -> Option<(DVec, RowState)> {
        if !self.is_elastic() {
            return Some((self.residuals(at, row, &state.pose), state.clone()));
        }
        let rest = self.rest(at, state)?;
        Some((self.elastic_residuals(at, row, &rest), RowState { pose: rest.pose, lengths: state.lengths.clone() }))
    }

    /// Residuals of a row with their derivatives; `None` without an equilibrium or its derivatives.
    pub(super) fn terms_of(&self, at: &CalibratedRobot, row: &MeasuredRow, state: &RowState) -> Option<RowTerms> {
        if !self.is_elastic() {
            return Some(self.row_terms(at, row, &state.pose));
        }
        let rest = self.rest(at, state)?;
        let residuals = self.elastic_residuals(at, row, &rest);
        let (count, cables) = (residuals.len(), at.robot.cables.len());
        let mut terms = RowTerms {
            residuals,
            by_unknowns: DMat::zeros(count, self.unknowns.len()),
            by_pose: DMat::zeros(count, cables),
        };

        // Along each true length.
        for cable in 0..cables {
            let mut change = RobotChange { cables: vec![CableChange::default(); cables], ..RobotChange::default() };
            change.cables[cable].unstrained_length = 1.0;
            let column = self.column(at, row, &rest, &change, |i| if i == cable { 1.0 / at.scale } else { 0.0 })?;
            terms.by_pose.set_column(cable, &column);
        }
        // Along each unknown of the robot.
        for (k, unknown) in self.unknowns.iter().enumerate() {
            let change = self.change(at, unknown);
            let of_reading = |i: usize| match *unknown {
                CalibrationUnknown::Offset { cable } if cable == i => -1.0 / at.scale,
                CalibrationUnknown::Scale => {
                    -(rest.cables[i].unstrained_length - at.offsets[i]) / (at.scale * at.scale * self.scale_length)
                }
                _ => 0.0,
            };
            let column = self.column(at, row, &rest, &change, of_reading)?;
            terms.by_unknowns.set_column(k, &column);
        }
        Some(terms)
    }

    /// Equilibrium at the lengths of a state, near its pose if there is one.
    fn rest(&self, at: &CalibratedRobot, state: &RowState) -> Option<Equilibrium> {
        if state.lengths.iter().any(|length| !length.is_finite() || *length <= 0.0) {
            return None;
        }
        let near = statics::forward(&at.robot, &state.lengths, self.model, Some(&state.pose));
        near.or_else(|_| statics::forward(&at.robot, &state.lengths, self.model, None)).ok()
    }

    fn elastic_residuals(&self, at: &CalibratedRobot, row: &MeasuredRow, rest: &Equilibrium) -> DVec {
        let readings = row.readings.iter().enumerate().filter_map(|(i, reading)| {
            let length = rest.cables[i].unstrained_length;
            Some(((length - at.offsets[i]) / at.scale - (*reading)?) / self.deviations.reading)
        });
        let positions = (0..3)
            .filter_map(|axis| Some((rest.pose.position_w[axis] - row.position[axis]?) / self.deviations.position));
        let tensions = row
            .tensions
            .iter()
            .zip(&rest.cables)
            .filter_map(|(measured, cable)| Some((cable.tension_anchor - (*measured)?) / self.deviations.tension));
        DVec::from_vec(readings.chain(positions).chain(tensions).collect())
    }

    /// Derivatives of the residuals along a change; `of_reading` is the derivative of the reading of each cable.
    fn column(
        &self,
        at: &CalibratedRobot,
        row: &MeasuredRow,
        rest: &Equilibrium,
        change: &RobotChange,
        of_reading: impl Fn(usize) -> f64,
    ) -> Option<DVec> {
        let by = derivatives::at_held_lengths(&at.robot, rest, change).ok()?;
        let readings = row.readings.iter().enumerate();
        let readings = readings.filter_map(|(i, reading)| reading.map(|_| of_reading(i) / self.deviations.reading));
        let positions =
            (0..3).filter_map(|axis| row.position[axis].map(|_| by.translation_w[axis] / self.deviations.position));
        let tensions = row
            .tensions
            .iter()
            .zip(&by.cables)
            .filter_map(|(measured, cable)| measured.map(|_| cable.tension_anchor / self.deviations.tension));
        Some(DVec::from_vec(readings.chain(positions).chain(tensions).collect()))
    }

    /// Change of the robot along an unknown.
    fn change(&self, at: &CalibratedRobot, unknown: &CalibrationUnknown) -> RobotChange {
        let cables = at.robot.cables.len();
        let mut change = RobotChange { cables: vec![CableChange::default(); cables], ..RobotChange::default() };
        match *unknown {
            CalibrationUnknown::Anchor { cable, axis } => change.cables[cable].anchor_w = Vec3::ith(axis, 1.0),
            CalibrationUnknown::Attachment { cable, axis } => {
                change.cables[cable].attachment_p = Vec3::ith(axis, 1.0);
            }
            CalibrationUnknown::AxialStiffness => {
                for (change, cable) in change.cables.iter_mut().zip(&at.robot.cables) {
                    change.axial_stiffness = cable.material.axial_stiffness / self.scale_length;
                }
            }
            CalibrationUnknown::Mass => change.mass = at.robot.platform.mass / self.scale_length,
            CalibrationUnknown::Offset { .. } | CalibrationUnknown::Scale => {}
        }
        change
    }
}

//! Rows of elastic, sagging cables: the unknowns of a row are the true unstrained lengths of its cables, and the pose
//! follows from them.

use super::row::RowTerms;
use super::{CalibratedRobot, Calibration, CalibrationUnknown, MeasuredRow};
use crate::math::{DMat, DVec, Vec3};
use crate::robot::{CableChange, Pose, RobotChange, State, Support, SupportChange};
use crate::statics::{self, Equilibrium, StaticModel, TensionRule, derivatives};

/// Step of differences along an unknown [m]. Equilibria are exact to 1e-12 m, the error of a difference is 1e-8 of its
/// curvature.
const DIFFERENCE: f64 = 1e-4;

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

    /// Tension of a cable in a row with its deviation [N]: measured, or known beforehand; `None` for rigid cables.
    pub(super) fn tension_datum(&self, row: &MeasuredRow, cable: usize) -> Option<(f64, f64)> {
        let measured = row.tensions.get(cable).copied().flatten();
        let measured = measured.map(|tension| (tension, self.deviations.tension));
        if self.is_elastic() { measured.or(self.deviations.tension_prior) } else { measured }
    }

    /// States in which a search begins: at poses, with the lengths of the readings.
    pub(super) fn states(&self, values: &[f64], poses: &[Pose]) -> Vec<RowState> {
        let at = self.robot_at(values);
        let state = |(row, pose): (&MeasuredRow, &Pose)| {
            if !self.is_elastic() {
                return RowState { pose: *pose, lengths: Vec::new() };
            }
            if row.tensions.iter().flatten().count() == 0
                && let Some(lengths) = self.lengths_of_prior(&at, pose)
            {
                return RowState { pose: *pose, lengths };
            }
            let length = |(i, cable): (usize, &crate::robot::Cable)| {
                let read = row.readings.get(i).copied().flatten();
                read.map_or_else(|| cable.straight_length(pose), |reading| at.offsets[i] + at.scale * reading)
            };
            RowState { pose: *pose, lengths: at.robot.cables.iter().enumerate().map(length).collect() }
        };
        self.rows.iter().zip(poses).map(state).collect()
    }

    /// Lengths with which the platform rests at a pose with tensions near their prior: where nothing else tells the
    /// tensions, lengths that fit the readings exactly have tensions far from it, or slack cables.
    fn lengths_of_prior(&self, at: &CalibratedRobot, pose: &Pose) -> Option<Vec<f64>> {
        let (tension, _) = self.deviations.tension_prior?;
        let rule = TensionRule::Closest(vec![tension]);
        let found = statics::solve_at(&at.robot, &State::Pose(*pose), self.model, &rule).ok()?;
        Some(found.equilibrium.cables.iter().map(|cable| cable.unstrained_length).collect())
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
        let of_pose = self.pose_data(row, &rest.pose).into_iter().map(|datum| datum.residual);
        let tensions = rest.cables.iter().enumerate().filter_map(|(i, cable)| {
            let (known, deviation) = self.tension_datum(row, i)?;
            Some((cable.tension_anchor - known) / deviation)
        });
        DVec::from_vec(readings.chain(of_pose).chain(tensions).collect())
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
        let ([translation_w, rotation_w], tensions) = self.rates(at, rest, change)?;
        let readings = row.readings.iter().enumerate();
        let readings = readings.filter_map(|(i, reading)| reading.map(|_| of_reading(i) / self.deviations.reading));
        let of_pose = self.pose_data(row, &rest.pose).into_iter().map(|datum| datum.rate(&translation_w, &rotation_w));
        let tensions = tensions.iter().enumerate().filter_map(|(i, rate)| {
            let (_, deviation) = self.tension_datum(row, i)?;
            Some(rate / deviation)
        });
        Some(DVec::from_vec(readings.chain(of_pose).chain(tensions).collect()))
    }

    /// Rates of translation and rotation and of the tensions at the anchors along a change, at held lengths; by
    /// differences where supports settle.
    fn rates(&self, at: &CalibratedRobot, rest: &Equilibrium, change: &RobotChange) -> Option<([Vec3; 2], Vec<f64>)> {
        if !at.robot.has_supports() {
            let by = derivatives::at_held_lengths(&at.robot, rest, change).ok()?;
            let motion = [by.translation_w, by.rotation_w];
            return Some((motion, by.cables.iter().map(|cable| cable.tension_anchor).collect()));
        }
        let moved = |step: f64| {
            let lengths = rest.cables.iter().zip(&change.cables);
            let lengths: Vec<f64> =
                lengths.map(|(cable, change)| cable.unstrained_length + change.unstrained_length * step).collect();
            let robot = at.robot.changed(change, step);
            statics::forward(&robot, &lengths, self.model, Some(&rest.pose)).ok()
        };
        let (below, above) = (moved(-DIFFERENCE)?, moved(DIFFERENCE)?);
        let per_step = 0.5 / DIFFERENCE;
        let tensions = above.cables.iter().zip(&below.cables);
        let tensions = tensions.map(|(above, below)| (above.tension_anchor - below.tension_anchor) * per_step);
        let turn = (above.pose.rot_wp * below.pose.rot_wp.inverse()).scaled_axis();
        Some((
            [above.pose.position_w - below.pose.position_w, turn].map(|motion| motion * per_step),
            tensions.collect(),
        ))
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
            CalibrationUnknown::PulleyRadius { .. } => {
                for (cable, change) in change.cables.iter_mut().enumerate() {
                    if unknown.is_radius_of(&at.robot, cable) {
                        change.pulley.radius = 1.0;
                    }
                }
            }
            CalibrationUnknown::SupportStiffness => {
                let by_factor = |support: &Support| SupportChange {
                    stiffness_w: support.stiffness_w / self.scale_length,
                    ..SupportChange::default()
                };
                change.supports = at.robot.supports.iter().map(by_factor).collect();
            }
            CalibrationUnknown::Offset { .. } | CalibrationUnknown::Scale => {}
        }
        change
    }
}

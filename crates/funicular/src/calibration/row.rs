//! One row of measured readings: residuals and their derivatives by the unknowns of the robot and by the row's pose.

use super::{CalibratedRobot, Calibration, CalibrationUnknown};
use crate::math::{DMat, DVec, Mat3, Vec3, Vec6};
use crate::platform::StraightCable;
use crate::robot::Pose;

/// Readings of the cables at one pose, which is unknown.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MeasuredRow {
    /// Reading of each cable [m]; `None` where a cable was not read or was slack.
    pub readings: Vec<Option<f64>>,
    /// Measured coordinates of the platform origin, world axes [m].
    pub position: [Option<f64>; 3],
    /// Measured angles roll, pitch and yaw of the platform [rad], `R = Rz Ry Rx`.
    pub angles: [Option<f64>; 3],
    /// Tension of each cable at its anchor [N]; `None` where it was not measured, empty if none was.
    pub tensions: Vec<Option<f64>>,
    /// Pose at which the search begins.
    pub start: Option<Pose>,
}

impl MeasuredRow {
    /// Row with readings of all cables [m].
    pub fn of_readings(readings: &[f64]) -> Self {
        Self { readings: readings.iter().copied().map(Some).collect(), ..Self::default() }
    }
}

/// Standard deviations of the data of all rows, and what is known of the tensions beforehand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReadingDeviations {
    /// Deviation of a reading [m].
    pub reading: f64,
    /// Deviation of a measured coordinate of the platform [m].
    pub position: f64,
    /// Deviation of a measured angle of the platform [rad].
    pub angle: f64,
    /// Deviation of a measured tension [N].
    pub tension: f64,
    /// Tension of elastic cables at the anchor that was not measured, with its standard deviation [N]; `None` if
    /// nothing is known.
    pub tension_prior: Option<(f64, f64)>,
}

/// Residuals of one row and their derivatives, each divided by the standard deviation of its datum.
#[derive(Debug, Clone)]
pub(super) struct RowTerms {
    /// Residuals, computed less measured.
    pub(super) residuals: DVec,
    /// Derivatives by the unknowns of the robot.
    pub(super) by_unknowns: DMat,
    /// Derivatives by the coordinates of the pose, rotations times ℓ.
    pub(super) by_pose: DMat,
}

/// Measured coordinate or angle of the platform: its residual and derivatives, divided by its standard deviation.
pub(super) struct PoseDatum {
    pub(super) residual: f64,
    /// By the translation of the platform, world axes.
    by_translation: Vec3,
    /// By its rotation vector, world axes.
    by_rotation: Vec3,
}

impl PoseDatum {
    /// Rate along a motion of the platform.
    pub(super) fn rate(&self, translation_w: &Vec3, rotation_w: &Vec3) -> f64 {
        self.by_translation.dot(translation_w) + self.by_rotation.dot(rotation_w)
    }
}

impl Calibration {
    /// Residuals of a row at a pose, in deviations (96a).
    pub(super) fn residuals(&self, at: &CalibratedRobot, row: &MeasuredRow, pose: &Pose) -> DVec {
        let readings = row.readings.iter().enumerate().filter_map(|(i, reading)| {
            let length = at.robot.cables[i].straight_length(pose);
            Some(((length - at.offsets[i]) / at.scale - (*reading)?) / self.deviations.reading)
        });
        DVec::from_vec(readings.chain(self.pose_data(row, pose).into_iter().map(|datum| datum.residual)).collect())
    }

    /// Number of measured coordinates of the platform in a row, and of measured angles; cables that end in one point
    /// say nothing of angles.
    pub(super) fn pose_data_counts(&self, row: &MeasuredRow) -> [usize; 2] {
        let angles = if self.is_point { 0 } else { row.angles.iter().flatten().count() };
        [row.position.iter().flatten().count(), angles]
    }

    /// Measured coordinates and angles of the platform in a row, against those of a pose (96a).
    pub(super) fn pose_data(&self, row: &MeasuredRow, pose: &Pose) -> Vec<PoseDatum> {
        let position = |axis: usize| {
            let deviation = self.deviations.position;
            Some(PoseDatum {
                residual: (pose.position_w[axis] - row.position[axis]?) / deviation,
                by_translation: Vec3::ith(axis, 1.0 / deviation),
                by_rotation: Vec3::zeros(),
            })
        };
        let (roll, pitch, yaw) = pose.rot_wp.euler_angles();
        // The platform turns by the rates of the angles about these axes; upright, the first and the last coincide, and
        // least squares share the turn between them.
        let axes = Mat3::from_columns(&[pose.rot_wp * Vec3::x(), Vec3::new(-yaw.sin(), yaw.cos(), 0.0), Vec3::z()]);
        let rates = axes.try_inverse().unwrap_or_else(|| axes.transpose());
        let angle = |k: usize| {
            let (deviation, turn) = (self.deviations.angle, std::f64::consts::TAU);
            let apart = [roll, pitch, yaw][k] - row.angles[k]?;
            Some(PoseDatum {
                residual: (apart - turn * (apart / turn).round()) / deviation,
                by_translation: Vec3::zeros(),
                by_rotation: rates.row(k).transpose() / deviation,
            })
        };
        let angles = (0..if self.is_point { 0 } else { 3 }).filter_map(angle);
        (0..3).filter_map(position).chain(angles).collect()
    }

    /// Residuals of a row with their derivatives: a straight length changes with its anchor by the unit vector `u`
    /// towards it, with the platform by −(u, RA × u), with the attachment by −Rᵀu, with the radius of its pulley by the
    /// wrap angle and `u` along the exit offset (96b).
    pub(super) fn row_terms(&self, at: &CalibratedRobot, row: &MeasuredRow, pose: &Pose) -> RowTerms {
        let residuals = self.residuals(at, row, pose);
        let (count, coordinates) = (residuals.len(), self.coordinates());
        let mut by_unknowns = DMat::zeros(count, self.unknowns.len());
        let mut by_pose = DMat::zeros(count, self.coordinate_count());

        let read = row.readings.iter().enumerate().filter(|(_, reading)| reading.is_some());
        for (k, (cable, _)) in read.enumerate() {
            let per_length = 1.0 / (at.scale * self.deviations.reading);
            let line = StraightCable::at(&at.robot.cables[cable], pose);
            // A cable without length has no direction.
            let Some(u) = line.chord_w.try_normalize(f64::MIN_POSITIVE) else { continue };
            let by_motion = coordinates.reduce_force(&u, &line.lever_w);
            for c in 0..by_pose.ncols() {
                by_pose[(k, c)] = -by_motion[c] * per_length;
            }
            let by_attachment = -(pose.rot_wp.inverse() * u);
            let contact = at.robot.cables[cable].anchor.contact(&(pose.position_w + line.lever_w));
            for (j, unknown) in self.unknowns.iter().enumerate() {
                by_unknowns[(k, j)] = per_length
                    * match *unknown {
                        CalibrationUnknown::Anchor { cable: of, axis } if of == cable => u[axis],
                        CalibrationUnknown::Attachment { cable: of, axis } if of == cable => by_attachment[axis],
                        CalibrationUnknown::Offset { cable: of } if of == cable => -1.0,
                        // The arc grows by the wrap angle, and the exit point moves away from the entry point.
                        of if of.is_radius_of(&at.robot, cable) => contact
                            .map_or(0.0, |contact| contact.wrap + u.dot(&contact.exit_offset_w()) / contact.radius),
                        CalibrationUnknown::Scale => {
                            let length = at.robot.cables[cable].straight_length(pose);
                            -(length - at.offsets[cable]) / (at.scale * self.scale_length)
                        }
                        _ => 0.0,
                    };
            }
        }

        let first = row.readings.iter().flatten().count();
        for (k, datum) in self.pose_data(row, pose).iter().enumerate() {
            for c in 0..by_pose.ncols() {
                let [translation, rotation] = coordinates.translation_and_rotation(&Vec6::ith(c, 1.0));
                by_pose[(first + k, c)] = datum.rate(&translation, &rotation);
            }
        }
        RowTerms { residuals, by_unknowns, by_pose }
    }

    /// Pose after a step of the row's coordinates, rotations times ℓ.
    pub(super) fn moved(&self, pose: &Pose, step: &DVec) -> Pose {
        let mut reduced = Vec6::zeros();
        for (c, value) in step.iter().enumerate() {
            reduced[c] = *value;
        }
        self.coordinates().moved(pose, &reduced)
    }
}

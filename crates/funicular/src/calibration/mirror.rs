//! Mirror images of single anchors. If all points of the platform from which a cable was read lie in a plane, or on a
//! line of a planar robot, its anchor may as well stand on the other side of it.

use super::elastic::RowState;
use super::fit::states_of;
use super::frame::CalibrationFrame;
use super::{Calibration, CalibrationFit, CalibrationUnknown, ITERATIONS_OF_START, MeasuredRow};
use crate::math::{DMat, DVec, Vec3};
use crate::platform::StraightCable;
use crate::robot::Pose;
use crate::statics::StaticModel;

/// Maximum number of fits that look for mirror images. Waypoints on one line with four cables have eight minima, which
/// need some thirty.
const MAX_FITS: usize = 48;

/// Maximum number of images that are fitted with elastic cables, whose fits take a hundred times longer.
const MAX_ELASTIC_FITS: usize = 8;

/// Excess of χ² over the largest one up to which an image of straight rigid cables is fitted with elastic ones.
const WORTH_FITTING: f64 = 100.0;

/// Iterations of a fit after which it has to be near noise: the readings of a true mirror image fit at once.
const ITERATIONS_OF_IMAGE: usize = 25;

/// Factor of the largest χ² that a fit may have after these iterations.
const ON_ITS_WAY: f64 = 100.0;

/// Thickness of the points of a cable, relative to their next larger extent, above which they are not nearly flat.
const MAX_THICKNESS: f64 = 0.5;

/// Distances from the plane of the rows, relative to the spread of the anchors, at which a further row is tried.
const OFF_THE_PLANE: [f64; 4] = [-0.5, -0.25, 0.25, 0.5];

/// Number of starts from which a row of one minimum looks for its pose in another one.
const POSES_IN_OTHER: usize = 5;

/// Minimum whose anchors stand elsewhere than those of the best one.
#[derive(Debug, Clone)]
pub struct OtherMinimum {
    /// Fit there.
    pub fit: CalibrationFit,
    /// Cables whose anchors are mirrored through the plane or line of their rows; empty for another kind of minimum.
    pub mirrored: Vec<usize>,
}

/// Row that would tell two minima apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TellingRow {
    /// Pose of the best minimum to measure at.
    pub pose: Pose,
    /// Least root of the mean square by which the other minimum misses the readings there [m].
    pub difference: f64,
}

impl Calibration {
    /// Minima up to a χ² that have anchors of a minimum on the other side of their rows.
    pub(super) fn mirror_images(
        &self,
        from: &CalibrationFit,
        frame: &CalibrationFrame,
        largest_chi2: f64,
    ) -> Vec<OtherMinimum> {
        if self.is_elastic() {
            return self.elastic_images(from, frame, largest_chi2);
        }
        let count = self.robot.cables.len();
        let mut found = vec![OtherMinimum { fit: from.clone(), mirrored: Vec::new() }];
        let (mut next, mut fits) = (0, 0);
        while let Some(OtherMinimum { fit: base, mirrored }) = found.get(next).cloned() {
            next += 1;
            for cable in 0..count {
                let Some((values, poses)) = self.with_mirrored_anchor(&base, frame, cable) else { continue };
                if fits == MAX_FITS {
                    break;
                }
                fits += 1;
                let states = self.states(&values, &poses);
                let mut fit = self.fit_within(ITERATIONS_OF_IMAGE, &values, states, &frame.free);
                if !fit.converged && fit.chi2 < ON_ITS_WAY * largest_chi2 {
                    let states = self.states(&fit.values, &fit.poses);
                    fit = self.fit_within(ITERATIONS_OF_START, &fit.values, states, &frame.free);
                }
                if !fit.converged || fit.chi2 > largest_chi2 {
                    continue;
                }
                let fit = self.canonical(fit, frame);
                if !found.iter().any(|other| self.is_same(&other.fit, &fit)) {
                    found.push(OtherMinimum { fit, mirrored: toggled(&mirrored, cable, count) });
                }
            }
        }
        found.remove(0);
        found
    }

    /// Mirror images of elastic cables: found with straight rigid ones between the same points, and then fitted.
    fn elastic_images(&self, from: &CalibrationFit, frame: &CalibrationFrame, largest_chi2: f64) -> Vec<OtherMinimum> {
        let rigid = self.rigid_at(from);
        let straight = CalibrationFit { lengths: vec![Vec::new(); from.poses.len()], chi2: 0.0, ..from.clone() };
        let largest = WORTH_FITTING * (largest_chi2 - from.chi2).max(1.0);
        let images = rigid.mirror_images(&straight, frame, largest);
        let fitted = images.into_iter().take(MAX_ELASTIC_FITS).map(|OtherMinimum { fit: image, mirrored }| {
            // The true lengths are those of the minimum.
            let lengths = image.poses.iter().zip(&from.lengths);
            let states = lengths.map(|(pose, lengths)| RowState { pose: *pose, lengths: lengths.clone() }).collect();
            let mut fit = self.fit_within(ITERATIONS_OF_IMAGE, &image.values, states, &frame.free);
            if !fit.converged && fit.chi2 < ON_ITS_WAY * largest_chi2 {
                fit = self.fit_within(ITERATIONS_OF_START, &fit.values, states_of(&fit), &frame.free);
            }
            OtherMinimum { fit, mirrored }
        });
        let is_other =
            |of: &OtherMinimum| of.fit.converged && of.fit.chi2 <= largest_chi2 && !self.is_same(&of.fit, from);
        fitted.filter(is_other).collect()
    }

    /// Calibration of straight rigid cables whose readings are the distances of a fit.
    fn rigid_at(&self, fit: &CalibrationFit) -> Self {
        let at = self.robot_at(&fit.values);
        let row = |(row, pose): (&MeasuredRow, &Pose)| {
            let read = row.readings.iter().enumerate();
            let readings = read.map(|(i, reading)| {
                reading.map(|_| (at.robot.cables[i].straight_length(pose) - at.offsets[i]) / at.scale)
            });
            MeasuredRow { readings: readings.collect(), tensions: Vec::new(), ..row.clone() }
        };
        let rows = self.rows.iter().zip(&fit.poses).map(row).collect();
        Self { rows, model: StaticModel::Ideal, ..self.clone() }
    }

    /// Values and poses with one anchor on the other side of its rows, placed by the frame; `None` where it has no such
    /// side or is known.
    fn with_mirrored_anchor(
        &self,
        fit: &CalibrationFit,
        frame: &CalibrationFrame,
        cable: usize,
    ) -> Option<(Vec<f64>, Vec<Pose>)> {
        let places: Vec<(usize, usize)> = self
            .axes()
            .into_iter()
            .map(|axis| Some((axis, self.position_of(&CalibrationUnknown::Anchor { cable, axis })?)))
            .collect::<Option<_>>()?;
        let (middle, normal) = self.flat_rows(fit, cable)?;
        let point = self.robot_at(&fit.values).robot.cables[cable].anchor.point_w;
        let image = point - normal * (2.0 * normal.dot(&(point - middle)));
        let mut values = fit.values.clone();
        for (axis, place) in places {
            values[place] = image[axis];
        }
        Some(frame.placed(self, &values, &fit.poses))
    }

    /// Middle and unit normal of the plane, or of the line of a planar robot, near which the attachment of a cable was
    /// when it was read; `None` if the points are not flat.
    fn flat_rows(&self, fit: &CalibrationFit, cable: usize) -> Option<(Vec3, Vec3)> {
        let robot = self.robot_at(&fit.values).robot;
        let rows = self.rows.iter().zip(&fit.poses);
        let points: Vec<Vec3> = rows
            .filter(|(row, _)| row.readings.get(cable).copied().flatten().is_some())
            .map(|(_, pose)| pose.position_w + StraightCable::at(&robot.cables[cable], pose).lever_w)
            .collect();
        let middle = points.iter().sum::<Vec3>() / points.len().max(1) as f64;
        let centred: Vec<DVec> = points.iter().map(|point| self.place(&(point - middle))).collect();
        let dimension = self.translations_w().len();
        let spread =
            centred.iter().fold(DMat::zeros(dimension, dimension), |sum, point| sum + point * point.transpose());
        let eigen = spread.symmetric_eigen();
        let mut order: Vec<usize> = (0..dimension).collect();
        order.sort_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
        let [least, second] = [0, 1].map(|k| eigen.eigenvalues[order[k]].max(0.0).sqrt());
        if second <= 0.0 || least > MAX_THICKNESS * second {
            return None;
        }
        let along = self.translations_w();
        let normal = eigen.eigenvectors.column(order[0]).iter().zip(&along).map(|(part, along)| along * *part).sum();
        Some((middle, normal))
    }

    /// Row off the plane or line of the rows of a fit that tells it from another one; `None` if no pose that was tried
    /// does so by more than the noise of the readings. Elastic cables are straight and rigid for it.
    pub fn telling_row(&self, fit: &CalibrationFit, other: &CalibrationFit) -> Option<TellingRow> {
        let robot = self.robot_at(&fit.values);
        let middle = fit.poses.iter().map(|pose| pose.position_w).sum::<Vec3>() / fit.poses.len().max(1) as f64;
        let first = fit.poses.first()?;
        let along: Vec<Vec3> = match self.flat_rows(fit, 0) {
            Some((_, normal)) => vec![normal],
            None => self.translations_w(),
        };
        let poses = along.iter().flat_map(|along| {
            OFF_THE_PLANE.map(|part| Pose { position_w: middle + along * (part * self.anchor_spread()), ..*first })
        });
        let of_pose = |pose: Pose| {
            let cables = robot.robot.cables.iter().zip(&robot.offsets);
            let readings: Vec<f64> =
                cables.map(|(cable, offset)| (cable.straight_length(&pose) - offset) / robot.scale).collect();
            let row = MeasuredRow::of_readings(&readings);
            let starts = (0..POSES_IN_OTHER).map(|k| {
                let start = other.poses.get(k * other.poses.len() / POSES_IN_OTHER).copied().unwrap_or(pose);
                if k == 0 { pose } else { self.nearby(&start, 104_729 * (k + 1)) }
            });
            let chi2 =
                starts.map(|start| self.pose_of_row(&other.values, &row, &start).1).fold(f64::INFINITY, f64::min);
            let difference = self.deviations.reading * (chi2 / readings.len().max(1) as f64).sqrt();
            TellingRow { pose, difference }
        };
        let best = poses.map(of_pose).max_by(|a, b| a.difference.total_cmp(&b.difference))?;
        (best.difference.is_finite() && best.difference > self.deviations.reading).then_some(best)
    }
}

/// Set of mirrored cables with one more, or one less; the larger of the two sides of the robot counts as not mirrored.
fn toggled(mirrored: &[usize], cable: usize, count: usize) -> Vec<usize> {
    let is_in = |of: usize| mirrored.contains(&of) != (of == cable);
    let inside: Vec<usize> = (0..count).filter(|of| is_in(*of)).collect();
    if 2 * inside.len() > count { (0..count).filter(|of| !is_in(*of)).collect() } else { inside }
}

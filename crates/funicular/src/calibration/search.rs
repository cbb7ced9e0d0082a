//! Search for all minima that fit: starts from the file, from nothing but lengths, and from anchors that are moved;
//! other poses of single rows; mirror images.

use super::frame::CalibrationFrame;
use super::mirror::OtherMinimum;
use super::spread::spread;
use super::{
    Calibration, CalibrationFit, CalibrationUnknown, ITERATIONS_OF_START, MeasuredRow, anchors_from_lengths, null_space,
};
use crate::math::{DMat, DVec, Vec3};
use crate::robot::{Pose, Robot};
use crate::statics::StaticModel;

/// Arrivals at the best minimum that end the search: two if its χ² is one of noise.
const ENOUGH_ARRIVALS: usize = 5;
const ENOUGH_OF_NOISE: usize = 2;

/// Deviations of χ² above its expectation up to which a minimum fits as noise does.
const OF_NOISE: f64 = 3.0;

/// Starts after which a search ends whose best χ² is this many times that of noise: then the readings are wrong, not
/// the starts.
const STARTS_OF_MISFIT: usize = 5;
const FAR_FROM_NOISE: f64 = 100.0;

/// Rise of χ² up to which another minimum is kept, in the variance of the residuals.
const FITS_AS_WELL: f64 = 20.0;

/// Decrease of χ² by a mirror image, in the variance of the residuals, above which the readings choose it: three
/// deviations.
const CHOSEN: f64 = 9.0;

/// Distance of two minima, relative to the spread of the anchors, up to which they are one.
const SAME_MINIMUM: f64 = 1e-5;

/// Decrease of χ² by another pose of one row with which the row takes it.
const BETTER_POSE: f64 = 1.0;

/// Shift of anchors in further starts, relative to their spread, and turn of the poses [rad].
const START_SHIFT: f64 = 0.05;
const START_TURN: f64 = 0.25;

/// Number of other poses that a row tries.
const OTHER_POSES: usize = 6;

/// Minima that a search has found.
#[derive(Debug, Clone)]
pub struct CalibrationSearch {
    /// Best minimum.
    pub best: CalibrationFit,
    /// Other minima whose χ² is at most 20 higher, in the variance of the residuals, by χ²; mirror images of single
    /// anchors among them.
    pub others: Vec<OtherMinimum>,
    /// Number of starts.
    pub starts: usize,
    /// Number of starts that arrived at the best minimum.
    pub arrivals: usize,
    /// True if the start from nothing but lengths was possible.
    pub from_nothing: bool,
}

/// Searches from several starts for the minima of χ²; `None` if none is found.
pub fn search(
    of: &Calibration,
    frame: &CalibrationFrame,
    starts: usize,
    progress: &mut dyn FnMut(usize, usize) -> bool,
) -> Option<CalibrationSearch> {
    let nothing = of.start_from_nothing(frame);
    let from_nothing = nothing.is_some();
    let mut minima: Vec<(CalibrationFit, usize)> = Vec::new();
    let mut done = 0;
    let noise = of.largest_of_noise(frame);
    for number in 0..starts.max(1) {
        if !progress(number, starts) && number > 0 {
            break;
        }
        let (values, poses) = match (number, &nothing) {
            (0, _) => (of.start(), of.start_poses()),
            (1, Some(nothing)) => nothing.clone(),
            (1, None) | (2, Some(_)) if !of.is_elastic() => of.poses_first(),
            _ => of.moved_start(frame, number),
        };
        done += 1;
        let found =
            of.polished(of.fit_within(ITERATIONS_OF_START, &values, of.states(&values, &poses), &frame.free), frame);
        if !found.chi2.is_finite() {
            continue;
        }
        of.add_arrival(&mut minima, of.canonical(found, frame));
        let enough = |(best, arrivals): &(CalibrationFit, usize)| {
            *arrivals >= if best.chi2 <= noise { ENOUGH_OF_NOISE } else { ENOUGH_ARRIVALS }
        };
        let is_misfit =
            minima.first().is_some_and(|(best, _)| best.chi2 > FAR_FROM_NOISE * noise) && done >= STARTS_OF_MISFIT;
        if number > 0 && (minima.first().is_some_and(enough) || is_misfit) {
            break;
        }
    }

    let mut minima = minima.into_iter();
    let (mut best, arrivals) = minima.next()?;
    if !best.converged {
        best = of.canonical(of.fit_on(&best, &best.values, &frame.free), frame);
    }
    frame.hold(&mut best.values, &of.start());
    let variance = (best.chi2 / of.degrees(frame).max(1) as f64).max(1.0);
    let largest = best.chi2 + FITS_AS_WELL * variance;
    let minima = minima.map(|(fit, _)| fit).filter(|fit| fit.converged && fit.chi2 < largest);
    let mut others = of.with_mirror_images(minima.collect(), &best, frame, largest);
    choose_nearest_to_file(&mut best, &mut others, CHOSEN * variance);
    Some(CalibrationSearch { best, others, starts: done, arrivals, from_nothing })
}

/// Exchanges the best minimum for the first other one, if that is lower by more than a difference of χ² between which
/// the readings do not choose: what the starts found is more like the file.
fn choose_nearest_to_file(best: &mut CalibrationFit, others: &mut [OtherMinimum], indifferent: f64) {
    let Some(first) = others.first_mut().filter(|first| first.fit.chi2 < best.chi2 - indifferent) else { return };
    std::mem::swap(&mut first.fit, best);
    let turned = first.mirrored.clone();
    for other in others.iter_mut().skip(1).filter(|other| !other.mirrored.is_empty()) {
        other.mirrored = symmetric_difference(&other.mirrored, &turned);
    }
    others.sort_by(|a, b| a.fit.chi2.total_cmp(&b.fit.chi2));
}

/// Members of one of two sets.
fn symmetric_difference(a: &[usize], b: &[usize]) -> Vec<usize> {
    let mut of_one: Vec<usize> =
        a.iter().filter(|of| !b.contains(of)).chain(b.iter().filter(|of| !a.contains(of))).copied().collect();
    of_one.sort_unstable();
    of_one
}

impl Calibration {
    /// Counts the arrival of a start at a minimum, and keeps the minima in the order of their χ².
    fn add_arrival(&self, minima: &mut Vec<(CalibrationFit, usize)>, found: CalibrationFit) {
        match minima.iter_mut().find(|(other, _)| self.is_same(other, &found)) {
            Some((other, arrivals)) => {
                *arrivals += 1;
                if found.chi2 < other.chi2 {
                    *other = found;
                }
            }
            None => minima.push((found, 1)),
        }
        minima.sort_by(|a, b| a.0.chi2.total_cmp(&b.0.chi2));
    }

    /// Other minima up to a χ², those among them that are mirror images of the best one marked.
    fn with_mirror_images(
        &self,
        minima: Vec<CalibrationFit>,
        best: &CalibrationFit,
        frame: &CalibrationFrame,
        largest: f64,
    ) -> Vec<OtherMinimum> {
        let mut others: Vec<OtherMinimum> =
            minima.into_iter().map(|fit| OtherMinimum { fit, mirrored: Vec::new() }).collect();
        for image in self.mirror_images(best, frame, largest) {
            match others.iter_mut().find(|other| self.is_same(&other.fit, &image.fit)) {
                Some(other) => other.mirrored = image.mirrored,
                None => others.push(image),
            }
        }
        others.sort_by(|a, b| a.fit.chi2.total_cmp(&b.fit.chi2));
        others
    }

    /// True if two fits are one minimum.
    pub(super) fn is_same(&self, a: &CalibrationFit, b: &CalibrationFit) -> bool {
        let apart = a.values.iter().zip(&b.values).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        apart <= SAME_MINIMUM * self.anchor_spread() && (a.chi2 - b.chi2).abs() <= 1e-3 * (1.0 + a.chi2)
    }

    /// Number of data less that of the unknowns and the coordinates of all poses.
    pub(super) fn degrees(&self, frame: &CalibrationFrame) -> usize {
        let data = self.rows.iter().map(|row| self.data_count(row)).sum::<usize>() + self.prior_count();
        data.saturating_sub(frame.free_count() + self.rows.len() * self.row_unknown_count())
    }

    /// χ² up to which a fit is one of noise.
    pub(super) fn largest_of_noise(&self, frame: &CalibrationFrame) -> f64 {
        let degrees = self.degrees(frame) as f64;
        degrees + OF_NOISE * (2.0 * degrees).sqrt()
    }

    /// Start with the values of the file, and for each row the pose that fits them best.
    pub(super) fn poses_first(&self) -> (Vec<f64>, Vec<Pose>) {
        let values = self.start();
        let rows = self.rows.iter().zip(self.start_poses());
        let poses = rows.map(|(row, start)| self.pose_of_row(&values, row, &start).0).collect();
        (values, poses)
    }

    /// Start with anchors that are moved along the free directions, and poses about the middle.
    fn moved_start(&self, frame: &CalibrationFrame, number: usize) -> (Vec<f64>, Vec<Pose>) {
        let size = self.anchor_spread();
        let shift = DVec::from_fn(self.unknowns.len(), |k, _| match self.unknowns[k] {
            CalibrationUnknown::Anchor { .. } => START_SHIFT * size * (2.0 * spread(number, k) - 1.0),
            _ => 0.0,
        });
        let values = DVec::from_vec(self.start()) + &frame.free * (frame.free.transpose() * shift);
        let starts = self.start_poses().into_iter().enumerate();
        let poses = starts.map(|(j, pose)| self.nearby(&pose, number * 1000 + j)).collect();
        (values.as_slice().to_vec(), poses)
    }

    /// Pose in the neighbourhood of another one.
    pub(super) fn nearby(&self, pose: &Pose, number: usize) -> Pose {
        let translations = self.translations_w().len();
        let step = DVec::from_fn(self.coordinate_count(), |c, _| {
            let size = if c < translations {
                2.0 * START_SHIFT * self.anchor_spread()
            } else {
                START_TURN * self.coordinates().ell()
            };
            size * (2.0 * spread(number, 100 + c) - 1.0)
        });
        self.moved(pose, &step)
    }

    /// Pose of one row with the unknowns held, from a start; with its χ². Elastic cables are straight and rigid for it.
    pub(super) fn pose_of_row(&self, values: &[f64], row: &MeasuredRow, start: &Pose) -> (Pose, f64) {
        let alone = Self {
            robot: self.robot.clone(),
            unknowns: self.unknowns.clone(),
            rows: vec![MeasuredRow { tensions: Vec::new(), ..row.clone() }],
            deviations: self.deviations,
            model: StaticModel::Ideal,
            scale_length: self.scale_length,
            priors: Vec::new(),
            is_point: self.is_point,
        };
        let found = alone.fit(values, &[*start], &DMat::zeros(values.len(), 0));
        (found.poses[0], found.chi2)
    }

    /// Fit in which no row has a better pose elsewhere: rows that have take it, and everything is fitted again.
    pub(super) fn polished(&self, mut found: CalibrationFit, frame: &CalibrationFrame) -> CalibrationFit {
        if self.is_elastic() {
            return found;
        }
        for _ in 0..3 {
            let mut poses = found.poses.clone();
            let mut is_moved = false;
            let at = self.robot_at(&found.values);
            for (j, row) in self.rows.iter().enumerate() {
                let now = self.residuals(&at, row, &found.poses[j]).norm_squared();
                let middle = self.middle();
                let others = (0..OTHER_POSES).map(|k| {
                    let start = if k == 0 { middle } else { self.nearby(&found.poses[j], 7919 * (k + 1) + j) };
                    self.pose_of_row(&found.values, row, &start)
                });
                if let Some((pose, chi2)) = others.min_by(|a, b| a.1.total_cmp(&b.1))
                    && chi2 < now - BETTER_POSE.max(1e-6 * now)
                {
                    poses[j] = pose;
                    is_moved = true;
                }
            }
            if !is_moved {
                break;
            }
            let next = self.fit(&found.values, &poses, &frame.free);
            if next.chi2 >= found.chi2 {
                break;
            }
            found = CalibrationFit { iterations: found.iterations + next.iterations, ..next };
        }
        found
    }

    /// True if the readings alone leave the robot its mirror image and every place: points, all anchors unknown.
    fn is_free_figure(&self, frame: &CalibrationFrame) -> bool {
        let all = if self.translations_w().len() == 2 { 3 } else { 6 };
        let anchors = (0..self.robot.cables.len()).all(|cable| {
            self.axes().iter().all(|&axis| self.position_of(&CalibrationUnknown::Anchor { cable, axis }).is_some())
        });
        !self.is_elastic()
            && self.is_point
            && anchors
            && frame.motion_count() == all
            && self.robot.cables.iter().all(|cable| cable.anchor.is_fixed())
    }

    /// The fit or its mirror image, whichever is more like the file.
    pub(super) fn canonical(&self, found: CalibrationFit, frame: &CalibrationFrame) -> CalibrationFit {
        if !self.is_free_figure(frame) {
            return found;
        }
        let across = self.translations_w()[0];
        let mirrored = self.with_points(&found, |point| point - across * (2.0 * across.dot(point)));
        if self.unlikeness(&found) <= self.unlikeness(&mirrored) {
            return self.in_frame(&found, frame);
        }
        self.in_frame(&mirrored, frame)
    }

    /// Fit that is turned towards the file and then placed by the conditions.
    fn in_frame(&self, found: &CalibrationFit, frame: &CalibrationFrame) -> CalibrationFit {
        let (points, wanted) = self.figures(found);
        let alignment = Alignment::of(&points, &wanted, false);
        let aligned = self.with_points(found, |point| self.placed(point, &alignment.apply(&self.place(point))));
        let (values, poses) = frame.placed(self, &aligned.values, &aligned.poses);
        CalibrationFit { values, poses, ..aligned }
    }

    /// Fit whose anchors and positions are moved.
    fn with_points(&self, found: &CalibrationFit, moved: impl Fn(&Vec3) -> Vec3) -> CalibrationFit {
        let at = self.robot_at(&found.values);
        let mut out = found.clone();
        for (value, unknown) in out.values.iter_mut().zip(&self.unknowns) {
            if let CalibrationUnknown::Anchor { cable, axis } = unknown {
                *value = moved(&at.robot.cables[*cable].anchor.point_w)[*axis];
            }
        }
        for pose in &mut out.poses {
            pose.position_w = moved(&pose.position_w);
        }
        out
    }

    /// Coordinates of a point along the translations of the platform.
    pub(super) fn place(&self, point: &Vec3) -> DVec {
        DVec::from_vec(self.translations_w().iter().map(|along| along.dot(point)).collect())
    }

    /// Point with other coordinates along the translations of the platform.
    fn placed(&self, point: &Vec3, place: &DVec) -> Vec3 {
        let along = self.translations_w();
        along
            .iter()
            .zip(place.iter())
            .fold(*point, |point, (along, wanted)| point + along * (wanted - along.dot(&point)))
    }

    /// Anchors and mean position of a fit, and of the file, as rows.
    fn figures(&self, found: &CalibrationFit) -> (DMat, DMat) {
        let at = self.robot_at(&found.values);
        let mean = found.poses.iter().map(|pose| pose.position_w).sum::<Vec3>() / found.poses.len().max(1) as f64;
        let start = self.start_poses();
        let wanted_mean = start.iter().map(|pose| pose.position_w).sum::<Vec3>() / start.len().max(1) as f64;
        let figure = |robot: &Robot, mean: Vec3| {
            let points = robot.cables.iter().map(|cable| cable.anchor.point_w).chain([mean]);
            self.places(points)
        };
        (figure(&at.robot, mean), figure(&self.robot, wanted_mean))
    }

    /// Coordinates of points along the translations of the platform, as rows.
    fn places(&self, points: impl Iterator<Item = Vec3>) -> DMat {
        DMat::from_columns(&points.map(|point| self.place(&point)).collect::<Vec<_>>()).transpose()
    }

    /// Sum of squared distances to the file after the best shift and turn.
    fn unlikeness(&self, found: &CalibrationFit) -> f64 {
        let (points, wanted) = self.figures(found);
        let alignment = Alignment::of(&points, &wanted, false);
        let rows = points.row_iter().zip(wanted.row_iter());
        rows.map(|(point, wanted)| (alignment.apply(&point.transpose()) - wanted.transpose()).norm_squared()).sum()
    }

    /// Start from nothing but lengths; `None` where it is not possible.
    fn start_from_nothing(&self, frame: &CalibrationFrame) -> Option<(Vec<f64>, Vec<Pose>)> {
        if !self.is_free_figure(frame) || self.rows.iter().any(|row| row.readings.iter().any(Option::is_none)) {
            return None;
        }
        let count = self.robot.cables.len();
        let lengths = DMat::from_fn(self.rows.len(), count, |j, i| self.rows[j].readings[i].unwrap_or_default());
        let (anchors, positions) = anchors_from_lengths(&lengths, self.translations_w().len())?;

        // Turned to the file, mirrored if need be.
        let wanted = self.places(self.robot.cables.iter().map(|cable| cable.anchor.point_w));
        let alignment = Alignment::of(&anchors, &wanted, true);
        let mut values = self.start();
        for (value, unknown) in values.iter_mut().zip(&self.unknowns) {
            if let CalibrationUnknown::Anchor { cable, axis } = unknown {
                let placed = alignment.apply(&anchors.row(*cable).transpose());
                *value = self.placed(&self.robot.cables[*cable].anchor.point_w, &placed)[*axis];
            }
        }
        let middle = self.middle();
        let pose = |j: usize| {
            let placed = alignment.apply(&positions.row(j).transpose());
            Pose { position_w: self.placed(&middle.position_w, &placed), ..middle }
        };
        let poses: Vec<Pose> = (0..self.rows.len()).map(pose).collect();
        let (values, poses) = frame.placed(self, &values, &poses);

        // Anchors first, everything else after.
        let held: Vec<DVec> = (0..self.unknowns.len())
            .filter(|&k| !matches!(self.unknowns[k], CalibrationUnknown::Anchor { .. }))
            .map(|k| DVec::from_fn(frame.free.ncols(), |c, _| frame.free[(k, c)]))
            .collect();
        if held.is_empty() {
            return Some((values, poses));
        }
        let anchors_only = &frame.free * null_space(&DMat::from_columns(&held).transpose());
        let first = self.fit(&values, &poses, &anchors_only);
        Some((first.values, first.poses))
    }
}

/// Shift and turn of a figure onto another one, with a mirror image if allowed.
struct Alignment {
    turn: DMat,
    from: DVec,
    to: DVec,
}

impl Alignment {
    /// Best alignment of points (rows) with wanted points.
    ///
    /// # References
    /// W. Kabsch, Acta Cryst. A32 (1976) 922.
    fn of(points: &DMat, wanted: &DMat, mirrors: bool) -> Self {
        let d = points.ncols();
        let mean = |of: &DMat| DVec::from_fn(d, |k, _| of.column(k).mean());
        let (from, to) = (mean(points), mean(wanted));
        let centred = |of: &DMat, mean: &DVec| DMat::from_fn(of.nrows(), d, |i, k| of[(i, k)] - mean[k]);
        let cross = centred(wanted, &to).transpose() * centred(points, &from);
        let svd = cross.svd(true, true);
        let (Some(u), Some(v_t)) = (svd.u, svd.v_t) else { return Self { turn: DMat::identity(d, d), from, to } };
        let mut signs = DVec::from_element(d, 1.0);
        if !mirrors && (&u * &v_t).determinant() < 0.0 {
            signs[svd.singular_values.imin()] = -1.0;
        }
        Self { turn: u * DMat::from_diagonal(&signs) * v_t, from, to }
    }

    fn apply(&self, point: &DVec) -> DVec {
        &self.to + &self.turn * (point - &self.from)
    }
}

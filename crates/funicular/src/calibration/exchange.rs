//! Cables whose readings are exchanged.

use super::ITERATIONS_OF_START;
use super::fit::MAX_ITERATIONS;
use super::frame::CalibrationFrame;
use super::{Calibration, CalibrationFit, CalibrationUnknown, MeasuredRow};
use crate::robot::Pose;

/// χ² of an exchange, relative to that before, below which rows look for better poses.
const WORTH_POLISHING: f64 = 1.0;

/// Maximum number of pairs of elastic cables whose readings are exchanged: their fits take a hundred times longer.
const MAX_ELASTIC_PAIRS: usize = 6;

/// Exchange of two cables.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CableExchange {
    /// Indices of the cables.
    pub cables: [usize; 2],
    /// χ² with their readings exchanged; for points the squared difference of the figure from the file [m²].
    pub chi2: f64,
}

/// Pairs of cables.
fn pairs(count: usize) -> impl Iterator<Item = [usize; 2]> {
    (0..count).flat_map(move |a| (a + 1..count).map(move |b| [a, b]))
}

fn exchanged(row: &MeasuredRow, [a, b]: [usize; 2]) -> MeasuredRow {
    let mut row = row.clone();
    row.readings.swap(a, b);
    row
}

/// Exchange of two cables in all rows that fits better than the rows as they are: by a factor of 10 in χ², or for
/// points, whose readings only rename anchors, by a figure that is nearer to the file by a factor of 4.
pub fn cable_exchange(of: &Calibration, fit: &CalibrationFit, frame: &CalibrationFrame) -> Option<CableExchange> {
    let count = of.robot.cables.len();
    if of.is_point() && !of.is_elastic() {
        return renamed_anchors(of, fit);
    }
    let start = of.start();
    let exchanged_rows = |cables: [usize; 2]| of.rows.iter().map(move |row| exchanged(row, cables));
    let by_poses = |cables: [usize; 2]| -> f64 {
        let rows = exchanged_rows(cables).zip(of.start_poses());
        rows.map(|(row, pose)| of.pose_of_row(&start, &row, &pose).1).sum()
    };
    let mut ranked: Vec<CableExchange> =
        pairs(count).map(|cables| CableExchange { cables, chi2: by_poses(cables) }).collect();
    ranked.sort_by(|a, b| a.chi2.total_cmp(&b.chi2));
    if of.is_elastic() {
        ranked.truncate(MAX_ELASTIC_PAIRS);
    }

    // From rough values of the file the poses alone mislead: every pair is fitted, until one fits as noise.
    let noise = of.largest_of_noise(frame);
    let mut best: Option<CableExchange> = None;
    for ranked in ranked {
        let mut other = of.clone();
        other.rows = exchanged_rows(ranked.cables).collect();
        let from =
            |poses: &[Pose]| other.fit_within(ITERATIONS_OF_START, &start, other.states(&start, poses), &frame.free);
        let (middle, first) = (from(&other.start_poses()), from(&other.poses_first().1));
        let mut found = if first.chi2 < middle.chi2 { first } else { middle };
        if found.chi2 > noise && found.chi2 < WORTH_POLISHING * fit.chi2 {
            found = other.polished(found, frame);
        }
        if best.is_none_or(|best| found.chi2 < best.chi2) {
            best = Some(CableExchange { chi2: found.chi2, ..ranked });
        }
        if found.chi2 <= noise {
            break;
        }
    }
    best.filter(|best| best.chi2 < BETTER_FIT * fit.chi2)
}

/// Cable whose readings fall while it pays out, with χ² after a change of their sign: it falls by a factor of 10. The
/// search needs unknown offsets, because a length is positive.
pub fn encoder_of_other_sign(of: &Calibration, fit: &CalibrationFit, frame: &CalibrationFrame) -> Option<(usize, f64)> {
    let flipped = |cable: usize| {
        let offset = of.position_of(&CalibrationUnknown::Offset { cable })?;
        let readings: Vec<f64> = of.rows.iter().filter_map(|row| row.readings[cable]).collect();
        let mean = readings.iter().sum::<f64>() / readings.len().max(1) as f64;
        let mut other = of.clone();
        for reading in other.rows.iter_mut().filter_map(|row| row.readings[cable].as_mut()) {
            *reading = -*reading;
        }
        // The mean length stays that of the readings as they were.
        let mut start = of.start();
        start[offset] = 2.0 * mean;
        let states = other.states(&start, &of.start_poses());
        let found = other.fit_within(
            if of.is_elastic() { ITERATIONS_OF_START } else { MAX_ITERATIONS },
            &start,
            states,
            &frame.free,
        );
        Some((cable, found.chi2))
    };
    let best = (0..of.robot.cables.len()).filter_map(flipped).min_by(|a, b| a.1.total_cmp(&b.1))?;
    (best.1 < BETTER_FIT * fit.chi2).then_some(best)
}

/// Exchange of two cables in one row with which it agrees with the others, whose fit without this row is given, with χ²
/// of all rows then. `None` if none does: χ² of the row has to fall by a factor of 10, and that of all rows must not
/// rise by more than noise of a variance that is at least `least_variance`.
pub(super) fn row_exchange(
    of: &Calibration,
    others: &CalibrationFit,
    frame: &CalibrationFrame,
    row: usize,
    least_variance: f64,
) -> Option<CableExchange> {
    let (measured, start) = (&of.rows[row], of.start_poses()[row]);
    let (_, now) = of.best_pose_of_row(&others.values, measured, &start);
    let of_pair =
        |cables: [usize; 2]| (cables, of.best_pose_of_row(&others.values, &exchanged(measured, cables), &start));
    let is_read = |[a, b]: &[usize; 2]| measured.readings[*a].is_some() || measured.readings[*b].is_some();
    let mut held: Vec<([usize; 2], (Pose, f64))> = pairs(of.robot.cables.len()).filter(is_read).map(of_pair).collect();
    held.retain(|(_, (_, chi2))| *chi2 < BETTER_FIT * now);
    held.sort_by(|a, b| a.1.1.total_cmp(&b.1.1));

    // The values without the row have deviations of their own: everything is fitted again.
    let fitted = held.into_iter().take(FITTED).map(|(cables, (pose, _))| {
        let mut all = of.clone();
        all.rows[row] = exchanged(measured, cables);
        let mut poses = others.poses.clone();
        poses.insert(row, pose);
        let states = all.states(&others.values, &poses);
        let chi2 = all.fit_within(ITERATIONS_OF_START, &others.values, states, &frame.free).chi2;
        CableExchange { cables, chi2 }
    });
    let best = fitted.min_by(|a, b| a.chi2.total_cmp(&b.chi2))?;
    let net = of.data_count(measured).saturating_sub(of.row_unknown_count()) as f64;
    let degrees = (of.degrees(frame) as f64 - net).max(1.0);
    let variance = (others.chi2 / degrees).max(least_variance);
    let largest_rise = variance * (net + OF_ROW_NOISE * (2.0 * net).sqrt());
    (best.chi2 <= others.chi2 + largest_rise).then_some(best)
}

/// Deviations of χ² of a row above its expectation up to which an exchange explains the row. Of one net row the factor
/// allows 4 deviations of its residual.
const OF_ROW_NOISE: f64 = 10.0;

/// Exchanges in a row that are fitted completely, after all were compared with the values held.
const FITTED: usize = 3;

/// χ² after an exchange, relative to that before, below which the exchange is reported. True exchanges gave 1e-4 and
/// less.
const BETTER_FIT: f64 = 0.1;

/// Squared difference from the file after an exchange of names, relative to that before, below which it is reported.
const NEARER_FIGURE: f64 = 0.25;

/// Root of the mean squared difference from the file, relative to the spread of the anchors, from which on an exchange
/// of names is looked for: smaller ones are errors of the file.
const FAR_FROM_FILE: f64 = 0.05;

fn renamed_anchors(of: &Calibration, fit: &CalibrationFit) -> Option<CableExchange> {
    let at = of.robot_at(&fit.values);
    let count = at.robot.cables.len();
    let distance = |robot: &crate::robot::Robot, a: usize, b: usize| {
        (robot.cables[a].anchor.point_w - robot.cables[b].anchor.point_w).norm()
    };
    let difference = |names: &dyn Fn(usize) -> usize| -> f64 {
        pairs(count).map(|[a, b]| (distance(&at.robot, a, b) - distance(&of.robot, names(a), names(b))).powi(2)).sum()
    };
    let now = difference(&|a| a);
    let far = (now / pairs(count).count().max(1) as f64).sqrt();
    if far < FAR_FROM_FILE * of.anchor_spread() {
        return None;
    }
    let renamed = |cables: [usize; 2]| {
        let [x, y] = cables;
        let names = move |a: usize| {
            if a == x {
                y
            } else if a == y {
                x
            } else {
                a
            }
        };
        CableExchange { cables, chi2: difference(&names) }
    };
    let best = pairs(count).map(renamed).min_by(|a, b| a.chi2.total_cmp(&b.chi2))?;
    (best.chi2 < NEARER_FIGURE * now).then_some(best)
}

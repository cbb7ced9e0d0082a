//! Cables whose readings are exchanged.

use super::frame::CalibrationFrame;
use super::{Calibration, CalibrationFit, CalibrationUnknown, MeasuredRow};

/// Exchanges that are fitted completely, after all were compared with the unknowns held.
const FITTED: usize = 3;

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

/// Exchange of two cables in all rows that fits better than the rows as they are: by a factor of 10 in χ², or for points,
/// whose readings only rename anchors, by a figure that is nearer to the file by a factor of 4.
pub fn cable_exchange(of: &Calibration, fit: &CalibrationFit, frame: &CalibrationFrame) -> Option<CableExchange> {
    let count = of.robot.cables.len();
    if of.is_elastic() {
        return None;
    }
    if of.is_point() {
        return renamed_anchors(of, fit);
    }
    let start = of.start();
    let by_poses = |cables: [usize; 2]| -> f64 {
        let rows = of.rows.iter().zip(of.start_poses());
        rows.map(|(row, pose)| of.pose_of_row(&start, &exchanged(row, cables), &pose).1).sum()
    };
    let mut ranked: Vec<CableExchange> =
        pairs(count).map(|cables| CableExchange { cables, chi2: by_poses(cables) }).collect();
    ranked.sort_by(|a, b| a.chi2.total_cmp(&b.chi2));
    let fitted = ranked.iter().take(FITTED).map(|of_pair| {
        let mut other = of.clone();
        other.rows = of.rows.iter().map(|row| exchanged(row, of_pair.cables)).collect();
        let found = other.fit(&start, &of.start_poses(), &frame.free);
        CableExchange { chi2: found.chi2, ..*of_pair }
    });
    let best = fitted.min_by(|a, b| a.chi2.total_cmp(&b.chi2))?;
    (best.chi2 < BETTER_FIT * fit.chi2).then_some(best)
}

/// Cable whose readings fall while it pays out, with χ² after a change of their sign: it falls by a factor of 10. The search
/// needs unknown offsets, because a length is positive.
pub fn encoder_of_other_sign(of: &Calibration, fit: &CalibrationFit, frame: &CalibrationFrame) -> Option<(usize, f64)> {
    if of.is_elastic() {
        return None;
    }
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
        let found = other.fit(&start, &of.start_poses(), &frame.free);
        Some((cable, found.chi2))
    };
    let best = (0..of.robot.cables.len()).filter_map(flipped).min_by(|a, b| a.1.total_cmp(&b.1))?;
    (best.1 < BETTER_FIT * fit.chi2).then_some(best)
}

/// Exchange of two cables in one row with which it agrees with the others; `None` if none helps by a factor of 10. The
/// others are fitted without the row first, because a wrong row drags all values along.
pub fn row_exchange(
    of: &Calibration,
    fit: &CalibrationFit,
    frame: &CalibrationFrame,
    row: usize,
) -> Option<CableExchange> {
    if of.is_elastic() {
        return None;
    }
    let mut others = of.clone();
    let measured = others.rows.remove(row);
    let mut poses = fit.poses.clone();
    poses.remove(row);
    let found =
        [others.fit(&fit.values, &poses, &frame.free), others.fit(&others.start(), &others.start_poses(), &frame.free)];
    let found = found.into_iter().min_by(|a, b| a.chi2.total_cmp(&b.chi2))?;

    let start = of.start_poses()[row];
    let (_, now) = of.pose_of_row(&found.values, &measured, &start);
    let of_pair = |cables: [usize; 2]| {
        let (_, chi2) = of.pose_of_row(&found.values, &exchanged(&measured, cables), &start);
        CableExchange { cables, chi2 }
    };
    let best = pairs(of.robot.cables.len()).map(of_pair).min_by(|a, b| a.chi2.total_cmp(&b.chi2))?;
    (best.chi2 < BETTER_FIT * now).then_some(best)
}

/// χ² after an exchange, relative to that before, below which the exchange is reported. True exchanges gave 1e-4 and less.
const BETTER_FIT: f64 = 0.1;

/// Squared difference from the file after an exchange of names, relative to that before, below which it is reported.
const NEARER_FIGURE: f64 = 0.25;

/// Root of the mean squared difference from the file, relative to the spread of the anchors, from which on an exchange of
/// names is looked for: smaller ones are errors of the file.
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

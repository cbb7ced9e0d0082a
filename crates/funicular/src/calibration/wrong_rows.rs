//! Rows that do not agree with the others, told from fits without them: a wrong row drags a fit along, so that its
//! linearisation blames others.

use super::ITERATIONS_OF_START;
use super::exchange::{CableExchange, row_exchange};
use super::fit::states_of;
use super::frame::CalibrationFrame;
use super::{Calibration, CalibrationFit, CalibrationUnknown, MeasuredRow};
use crate::robot::Pose;

/// Largest number of rows of which each is left out in turn; of longer tables the most suspicious ones.
const MAX_TRIED: usize = 40;

/// Largest number of rows of elastic cables of which each is left out in turn: their fits take a hundred times longer.
const MAX_TRIED_ELASTIC: usize = 10;

/// Largest part of the rows that can be wrong.
const MAX_PART: usize = 5;

/// Part of χ² by which fits without different rows count as equal.
const ABOUT_AS_WELL: f64 = 0.1;

/// Row that does not agree with the others.
#[derive(Debug, Clone)]
pub struct WrongRow {
    /// Index of the row.
    pub row: usize,
    /// Decrease of χ² without the row, with everything fitted again.
    pub chi2_drop: f64,
    /// χ² without the row.
    pub chi2: f64,
    /// Degrees of freedom without the row.
    pub degrees: usize,
    /// Values without the row.
    pub values: Vec<f64>,
    /// Exchange of the readings of two cables with which the row agrees with the others.
    pub exchange: Option<CableExchange>,
}

/// Rows without some of them, and their fit.
struct Rest {
    of: Calibration,
    /// Indices of these rows among all.
    rows: Vec<usize>,
    fit: CalibrationFit,
}

/// Rows that may be wrong, the worst one first, one at a time: each is the row without which the others fit best, from
/// the robot file and from the fit. The list ends where the others fit as noise, or where a row is not `beyond` noise,
/// whose variance is at least `least_variance` of that of the data: 1 where their deviations are known, else 0.
pub fn wrong_rows(
    of: &Calibration,
    fit: &CalibrationFit,
    frame: &CalibrationFrame,
    least_variance: f64,
    beyond: &dyn Fn(&WrongRow) -> bool,
) -> Vec<WrongRow> {
    let mut wrong = Vec::new();
    let mut rest = Rest { of: of.clone(), rows: (0..of.rows.len()).collect(), fit: fit.clone() };
    while wrong.len() * MAX_PART < of.rows.len() {
        let Some((place, next)) = rest.without_worst(frame, least_variance) else { break };
        let row = rest.rows[place];
        let found = WrongRow {
            row,
            chi2_drop: rest.fit.chi2 - next.fit.chi2,
            chi2: next.fit.chi2,
            degrees: next.of.degrees(frame),
            values: next.fit.values.clone(),
            exchange: row_exchange(&rest.of, &next.fit, frame, place, least_variance),
        };
        if !beyond(&found) {
            break;
        }
        wrong.push(found);
        let is_noise = least_variance > 0.0 && next.fit.chi2 <= next.of.largest_of_noise(frame);
        rest = next;
        if is_noise {
            break;
        }
    }
    wrong
}

impl Rest {
    /// The row without which the others fit best, by its place, and the others. Among rows without which they fit about
    /// as well, the one that an exchange of readings explains best.
    fn without_worst(&self, frame: &CalibrationFrame, least_variance: f64) -> Option<(usize, Self)> {
        let order = self.suspicious(frame);
        let mut tried: Vec<(usize, Self)> =
            order.into_iter().filter_map(|j| Some((j, self.without(j, frame)?))).collect();
        tried.sort_by(|a, b| a.1.fit.chi2.total_cmp(&b.1.fit.chi2));
        let least = tried.first()?.1.fit.chi2;
        let as_well = |(_, rest): &(usize, Self)| {
            let noise = least_variance * rest.of.largest_of_noise(frame);
            rest.fit.chi2 <= noise.max(least * (1.0 + ABOUT_AS_WELL))
        };
        tried.retain(as_well);
        let mut best = (0, f64::INFINITY);
        if tried.len() > 1 {
            for (k, (j, rest)) in tried.iter().enumerate() {
                let exchange = row_exchange(&self.of, &rest.fit, frame, *j, least_variance);
                let explained = exchange.map_or(f64::INFINITY, |of| of.chi2);
                if explained < best.1 {
                    best = (k, explained);
                }
            }
        }
        Some(tried.swap_remove(best.0))
    }

    /// Places of the rows in the order of suspicion: by the decrease of χ² of the linearised fit, and by how badly the
    /// row fits with the values of the file, in turn.
    fn suspicious(&self, frame: &CalibrationFrame) -> Vec<usize> {
        let of = &self.of;
        let left_out = of.precision(&self.fit, frame).rows_left_out(frame);
        let drops: Vec<f64> = left_out.iter().map(|row| row.chi2_drop.unwrap_or(0.0)).collect();
        let (start, poses) = (of.start(), of.start_poses());
        let by_file: Vec<f64> =
            of.rows.iter().zip(&poses).map(|(row, pose)| of.best_pose_of_row(&start, row, pose).1).collect();
        let ranked = |by: &[f64]| {
            let mut order: Vec<usize> = (0..by.len()).collect();
            order.sort_by(|a, b| by[*b].total_cmp(&by[*a]));
            order
        };
        let mut order = Vec::new();
        for pair in ranked(&drops).into_iter().zip(ranked(&by_file)) {
            for place in [pair.0, pair.1] {
                if !order.contains(&place) {
                    order.push(place);
                }
            }
        }
        order.truncate(if of.is_elastic() { MAX_TRIED_ELASTIC } else { MAX_TRIED });
        order
    }

    /// The others, fitted again from the values of the file and from this fit; `None` for a row that they need.
    fn without(&self, place: usize, frame: &CalibrationFrame) -> Option<Self> {
        let (mut of, mut rows, mut fit) = (self.of.clone(), self.rows.clone(), self.fit.clone());
        of.rows.remove(place);
        rows.remove(place);
        fit.poses.remove(place);
        fit.lengths.remove(place);
        let is_read = |cable: usize| of.rows.iter().any(|row| row.readings[cable].is_some());
        let is_open = |unknown: &CalibrationUnknown| unknown.cable().is_some_and(|cable| !is_read(cable));
        if of.degrees(frame) == 0 || of.unknowns.iter().any(is_open) {
            return None;
        }
        let from = |values: &[f64], states| of.fit_within(ITERATIONS_OF_START, values, states, &frame.free);
        let here = from(&fit.values, states_of(&fit));
        if of.is_elastic() && here.chi2 <= of.largest_of_noise(frame) {
            return Some(Self { of, rows, fit: here });
        }
        let file = from(&of.start(), of.states(&of.start(), &of.poses_first().1));
        let best = if here.chi2 <= file.chi2 { here } else { file };
        // A row in another pose of the same lengths spoils a fit that is none of noise.
        let fit = if best.chi2 > of.largest_of_noise(frame) { of.polished(best, frame) } else { best };
        fit.chi2.is_finite().then_some(Self { of, rows, fit })
    }
}

impl Calibration {
    /// Pose of one row with the unknowns held, the best from a start, the middle, and places about the start; with its
    /// χ².
    pub(super) fn best_pose_of_row(&self, values: &[f64], row: &MeasuredRow, start: &Pose) -> (Pose, f64) {
        let starts = [*start, self.middle(), self.nearby(start, 15_485_863), self.nearby(start, 32_452_843)];
        let found = starts.map(|start| self.pose_of_row(values, row, &start));
        found.into_iter().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((*start, f64::INFINITY))
    }
}

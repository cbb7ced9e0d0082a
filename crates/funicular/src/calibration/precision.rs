//! Precision with which rows determine the unknowns: net rows, covariance, rank, distances between anchors, and rows
//! left out.

use super::elimination::EliminatedRow;
use super::frame::CalibrationFrame;
use super::{Calibration, CalibrationFit, CalibrationUnknown};
use crate::math::{DMat, DVec};

/// Singular value of the net rows with unit columns, relative to the largest one, below which rank is lost: the root of
/// 1e-9 for their normal matrix. The weakest sound set that was seen, rigid platform with offsets and scale, has 2e-3.
const LOST_RANK: f64 = 3e-5;

/// Least eigenvalue of `I − h` of a row with which it can be checked.
const INDISPENSABLE: f64 = 1e-9;

/// Precision of a fit, from its linearisation.
#[derive(Debug, Clone)]
pub struct CalibrationPrecision {
    /// Covariance of the unknowns in the frame of the fit; along lost directions it has no part.
    pub covariance: DMat,
    /// Covariance along the free directions.
    pub(super) free_covariance: DMat,
    /// Net rows of each row, along the free directions.
    net: Vec<NetRow>,
    /// Information `Σ WᵀW` of all net rows and priors, along the free directions.
    pub information: DMat,
    /// Directions of the unknowns that no datum sees, unit vectors.
    pub lost: Vec<Vec<f64>>,
    /// Ratio of the least to the largest singular value of the net rows with unit columns.
    pub condition: f64,
    /// Number of data less the number of unknowns that they determine.
    pub degrees: usize,
    /// Rows that do not fix their poses, as indices.
    pub open_rows: Vec<usize>,
}

/// Equations that a row leaves for the unknowns.
#[derive(Debug, Clone)]
struct NetRow {
    by_free: DMat,
    residuals: DVec,
    directions: DMat,
}

/// Row left out of a fit, by the linearisation (96j).
#[derive(Debug, Clone)]
pub struct LeftOutRow {
    /// Decrease of χ² if the row is left out; `None` for a row that no other row checks.
    pub chi2_drop: Option<f64>,
    /// Number of net rows: the expected decrease.
    pub degrees: usize,
    /// Change of the unknowns if the row is left out.
    pub shift: Vec<f64>,
    /// Residual of each datum of the row in its deviations, as the row leaves it: the same for all data if one is left.
    pub normalised: Vec<f64>,
}

/// Distance between two anchors, which no frame changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AnchorDistance {
    /// Indices of the cables.
    pub cables: [usize; 2],
    /// Distance [m].
    pub distance: f64,
    /// Standard deviation of the distance [m].
    pub deviation: f64,
}

impl Calibration {
    /// Rows without their poses, and the numbers of those that do not fix theirs.
    fn net_rows(&self, fit: &CalibrationFit, frame: &CalibrationFrame) -> (Vec<NetRow>, Vec<usize>) {
        let mut open_rows = Vec::new();
        let terms = self.terms_at(fit);
        let net = terms.iter().enumerate().map(|(j, terms)| {
            let row = EliminatedRow::with_directions(terms, &frame.free);
            if row.fixes_pose() {
                let directions = row.directions.unwrap_or_else(|| DMat::zeros(0, 0));
                return NetRow { by_free: row.net, residuals: row.residuals, directions };
            }
            open_rows.push(j);
            NetRow {
                by_free: DMat::zeros(0, frame.free.ncols()),
                residuals: DVec::zeros(0),
                directions: DMat::zeros(terms.residuals.len(), 0),
            }
        });
        (net.collect(), open_rows)
    }

    /// Precision of a fit.
    pub fn precision(&self, fit: &CalibrationFit, frame: &CalibrationFrame) -> CalibrationPrecision {
        let (net, open_rows) = self.net_rows(fit, frame);
        let count = frame.free.ncols();
        let priors = self.prior_rows(&frame.free);
        let height = net.iter().map(|row| row.by_free.nrows()).sum::<usize>() + priors.nrows();
        let mut all = DMat::zeros(height.max(count), count);
        let mut first = 0;
        for rows in net.iter().map(|row| &row.by_free).chain([&priors]) {
            all.view_mut((first, 0), rows.shape()).copy_from(rows);
            first += rows.nrows();
        }
        let information = all.transpose() * &all;
        let scales: Vec<f64> = all.column_iter().map(|column| column.norm()).collect();
        let largest = scales.iter().copied().fold(0.0, f64::max).max(f64::MIN_POSITIVE);
        let scales: Vec<f64> = scales.iter().map(|scale| 1.0 / scale.max(1e-12 * largest)).collect();
        for (k, mut column) in all.column_iter_mut().enumerate() {
            column *= scales[k];
        }
        let svd = all.svd(false, true);
        let top = if svd.singular_values.is_empty() { 0.0 } else { svd.singular_values.max() };
        let right = svd.v_t.unwrap_or_else(|| DMat::identity(count, count));

        let mut free_covariance = DMat::zeros(count, count);
        let mut lost = Vec::new();
        let mut least = f64::INFINITY;
        for (k, value) in svd.singular_values.iter().enumerate() {
            let direction = DVec::from_fn(count, |i, _| right[(k, i)] * scales[i]);
            least = least.min(*value / top.max(f64::MIN_POSITIVE));
            if *value <= LOST_RANK * top {
                lost.push((&frame.free * direction.normalize()).as_slice().to_vec());
            } else {
                free_covariance += &direction * direction.transpose() / (value * value);
            }
        }
        let rank = count - lost.len();
        CalibrationPrecision {
            covariance: &frame.free * &free_covariance * frame.free.transpose(),
            free_covariance,
            net,
            information,
            condition: if count == 0 { 1.0 } else { least },
            degrees: height.saturating_sub(rank),
            lost,
            open_rows,
        }
    }

    /// Distances between all anchors that have unknown coordinates, with deviations.
    pub fn anchor_distances(&self, fit: &CalibrationFit, precision: &CalibrationPrecision) -> Vec<AnchorDistance> {
        let at = self.robot_at(&fit.values);
        let count = at.robot.cables.len();
        let mut distances = Vec::new();
        for a in 0..count {
            for b in a + 1..count {
                let apart = at.robot.cables[b].anchor.point_w - at.robot.cables[a].anchor.point_w;
                let Some(along) = apart.try_normalize(f64::MIN_POSITIVE) else { continue };
                let by_unknowns = DVec::from_fn(self.unknowns.len(), |k, _| match self.unknowns[k] {
                    CalibrationUnknown::Anchor { cable, axis } if cable == b => along[axis],
                    CalibrationUnknown::Anchor { cable, axis } if cable == a => -along[axis],
                    _ => 0.0,
                });
                if by_unknowns.amax() > 0.0 {
                    let variance = by_unknowns.dot(&(&precision.covariance * &by_unknowns));
                    let deviation = variance.max(0.0).sqrt();
                    distances.push(AnchorDistance { cables: [a, b], distance: apart.norm(), deviation });
                }
            }
        }
        distances
    }
}

impl CalibrationPrecision {
    /// Standard deviation of each unknown; zero for one that the frame holds.
    pub fn deviations(&self) -> Vec<f64> {
        self.covariance.diagonal().iter().map(|variance| variance.max(0.0).sqrt()).collect()
    }

    /// Net rows `W` of each row along the free directions, with their residuals `e` (96c).
    pub fn net_rows(&self) -> impl Iterator<Item = (&DMat, &[f64])> {
        self.net.iter().map(|row| (&row.by_free, row.residuals.as_slice()))
    }

    /// Root of the sum of the variances of the unknowns.
    pub fn total(&self) -> f64 {
        self.covariance.trace().max(0.0).sqrt()
    }

    /// Largest deviation of a combination of the unknowns, in the frame of the fit [m].
    pub fn weakest(&self) -> f64 {
        let eigenvalues = self.free_covariance.symmetric_eigenvalues();
        if eigenvalues.is_empty() { 0.0 } else { eigenvalues.max().max(0.0).sqrt() }
    }

    /// Each row left out of the fit.
    pub fn rows_left_out(&self, frame: &CalibrationFrame) -> Vec<LeftOutRow> {
        self.net.iter().map(|row| self.left_out(row, &frame.free)).collect()
    }

    fn left_out(&self, row: &NetRow, free: &DMat) -> LeftOutRow {
        let degrees = row.residuals.len();
        let influence = &row.by_free * &self.free_covariance * row.by_free.transpose();
        let rest = DMat::identity(degrees, degrees) - influence;
        let eigen = rest.clone().symmetric_eigen();
        let is_checked = degrees > 0 && eigen.eigenvalues.min() > INDISPENSABLE;
        let solved = is_checked.then(|| rest.clone().lu().solve(&row.residuals)).flatten();
        let shift = solved.as_ref().map_or_else(
            || vec![0.0; free.nrows()],
            |solved| (free * (&self.free_covariance * (row.by_free.transpose() * solved))).as_slice().to_vec(),
        );

        // Residuals of the data, and their variances after the fit.
        let data = &row.directions * &row.residuals;
        let variances = (&row.directions * &rest * row.directions.transpose()).diagonal();
        let normalised = data
            .iter()
            .zip(variances.iter())
            .map(|(residual, variance)| if *variance > INDISPENSABLE { residual / variance.sqrt() } else { 0.0 });
        LeftOutRow {
            chi2_drop: solved.map(|solved| row.residuals.dot(&solved)),
            degrees,
            shift,
            normalised: normalised.collect(),
        }
    }
}

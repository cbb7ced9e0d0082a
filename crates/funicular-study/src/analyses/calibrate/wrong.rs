//! Rows and columns that are wrong: exchanged readings, and rows that do not agree with the others.

use crate::normal::NOISE_DEVIATIONS;
use crate::quantiles::chi2_above;
use funicular::calibration::{
    CableExchange, Calibration, CalibrationFit, CalibrationFrame, CalibrationPrecision, WrongRow, cable_exchange,
    wrong_rows,
};

/// Probability that the limit of a row allows for any of the rows.
pub(super) const OUTLIER: f64 = 0.05;

/// Best fit with what judges its rows.
pub(super) struct FoundFit<'a> {
    pub(super) of: &'a Calibration,
    pub(super) fit: &'a CalibrationFit,
    pub(super) frame: &'a CalibrationFrame,
    pub(super) precision: &'a CalibrationPrecision,
    /// True if the deviation of the readings is given.
    pub(super) is_noise_known: bool,
    /// Variance of the residuals over that of the data.
    pub(super) variance: f64,
}

/// Fault of readings that do not fit.
#[derive(Default)]
pub(super) struct Wrong {
    /// Rows that do not agree with the others, the worst one first.
    pub(super) rows: Vec<WrongRow>,
    /// Cables whose columns are exchanged.
    pub(super) columns: Option<CableExchange>,
}

/// True if the readings miss the model by more than noise.
pub(super) fn misses(of: &FoundFit<'_>) -> bool {
    let degrees = of.precision.degrees as f64;
    degrees > 0.0 && of.fit.chi2 > degrees + 2.0 * NOISE_DEVIATIONS * (2.0 * degrees).sqrt()
}

/// Looks for wrong rows and columns where readings do not fit, or where a row stands out.
pub(super) fn found(of: &FoundFit<'_>) -> Wrong {
    let left_out = of.precision.rows_left_out(of.frame);
    let stands_out = left_out.iter().any(|row| {
        row.chi2_drop.is_some_and(|drop| drop / of.variance > limit(of, row.degrees))
            && of.precision.degrees > row.degrees
    });
    let (is_missed, is_point) = (misses(of), of.of.is_point() && !of.of.is_elastic());
    let mut wrong = Wrong::default();
    if is_missed || stands_out {
        let least = if of.is_noise_known { 1.0 } else { 0.0 };
        let beyond = |row: &WrongRow| row.chi2_drop / variance(of, row) > limit_of(of, row);
        wrong.rows = wrong_rows(of.of, of.fit, of.frame, least, &beyond);
    }

    // Rows explain what is wrong if the others fit as noise does.
    let is_explained = wrong.rows.last().is_some_and(|row| is_noise(of, row));
    if is_explained || !(is_missed || is_point) {
        return wrong;
    }
    wrong.columns = cable_exchange(of.of, of.fit, of.frame);
    let of_rows = wrong.rows.last().map(|row| row.chi2 / row.degrees.max(1) as f64);
    let of_columns = wrong.columns.map(|of_pair| of_pair.chi2 / of.precision.degrees.max(1) as f64);
    match of_rows.zip(of_columns) {
        Some(_) if is_point => wrong.columns = None,
        Some((rows, columns)) if columns < rows => wrong.rows.clear(),
        Some(_) => wrong.columns = None,
        None => {}
    }
    wrong
}

/// Variance of the residuals of the others over that of the data.
pub(super) fn variance(of: &FoundFit<'_>, row: &WrongRow) -> f64 {
    let ratio = row.chi2 / row.degrees.max(1) as f64;
    if is_noise(of, row) { 1.0 } else { ratio.max(f64::MIN_POSITIVE) }
}

/// True if the deviation of the readings is known and the others fit as noise does.
fn is_noise(of: &FoundFit<'_>, row: &WrongRow) -> bool {
    let degrees = row.degrees as f64;
    of.is_noise_known && row.chi2 <= degrees + NOISE_DEVIATIONS * (2.0 * degrees).sqrt()
}

/// Decrease of χ² that noise gives in one of the rows with 95 %, where its variance is known.
fn limit(of: &FoundFit<'_>, net: usize) -> f64 {
    chi2_above(OUTLIER / of.of.rows.len() as f64, net.max(1))
}

/// Limit of χ² beside the variance of the others, which comes from few degrees of freedom.
pub(super) fn limit_of(of: &FoundFit<'_>, row: &WrongRow) -> f64 {
    let net = of.of.data_count(&of.of.rows[row.row]).saturating_sub(of.of.row_unknown_count());
    let limit = limit(of, net);
    if is_noise(of, row) {
        return limit;
    }
    // Quantile of Student's t from that of the normal distribution: within 15 % from 4 degrees of freedom on.
    let degrees = row.degrees as f64;
    degrees * (limit / degrees).exp_m1()
}

//! Peaks of measured responses that the steps of their frequencies do not resolve.

use super::model::IdentifiedModel;
use crate::request::Experiment;
use crate::text::{counted, significant};
use anyhow::Result;
use funicular::dynamics::Dynamics;
use funicular::math::Complex;
use funicular::modes;
use funicular::response;

/// Prominence of a measured peak that has to be resolved [dB].
const PROMINENCE_DB: f64 = 6.0;

/// Maximum number of natural frequencies for which the steps are checked.
const MAX_CHECKED: usize = 2_000;

/// Sentence on the peaks of an experiment's responses whose half width ζf at the fitted values is below the step of the
/// frequencies beside them; `None` if all peaks are resolved.
///
/// # Errors
/// A robot without equilibrium.
pub(crate) fn unresolved_peaks(
    model: &IdentifiedModel<'_>,
    x: &[f64],
    number: usize,
    experiment: &Experiment,
) -> Result<Option<String>> {
    if experiment.responses.is_empty() {
        return Ok(None);
    }
    let at_rest = model.at_rest(x, number)?;
    let linearisation = model.linearisation(&at_rest);
    let frequencies = || experiment.responses.iter().flat_map(|response| response.frequency_hz.iter().copied());
    let (low, high) = (frequencies().fold(f64::INFINITY, f64::min), frequencies().fold(0.0, f64::max));
    let dynamics = Dynamics::about(&at_rest.robot, &at_rest.equilibrium, linearisation, high)?;
    if modes::count_within(&dynamics, low, high) > MAX_CHECKED {
        return Ok(None);
    }
    let list = modes::within(&dynamics, low, high);

    let (mut count, mut worst): (usize, Option<(f64, f64, f64)>) = (0, None);
    for response in &experiment.responses {
        let points = &response.frequency_hz;
        if points.len() < 3 || !points.windows(2).all(|pair| pair[0] < pair[1]) {
            continue;
        }
        let values: Vec<Complex> =
            response.real.iter().zip(&response.imag).map(|(re, im)| Complex::new(*re, *im)).collect();
        for peak in response::peaks(points, &values, PROMINENCE_DB) {
            let near = list.iter().min_by(|a, b| {
                (a.frequency_hz - peak.frequency_hz).abs().total_cmp(&(b.frequency_hz - peak.frequency_hz).abs())
            });
            let Some(mode) = near else { continue };
            let after = points.partition_point(|hz| *hz < peak.frequency_hz).clamp(1, points.len() - 1);
            let step = points[after] - points[after - 1];
            let half_width = mode.damping_ratio * mode.frequency_hz;
            if step > half_width {
                count += 1;
                if worst.is_none_or(|(_, other_step, width)| step / half_width > other_step / width) {
                    worst = Some((peak.frequency_hz, step, half_width));
                }
            }
        }
    }
    Ok(worst.map(|(hz, step, half_width)| {
        format!(
            "{} {} not resolved: at {} Hz the step of the frequencies is {} Hz, more than the half width ζf of {} Hz; \
             other starts may find other values: measure with finer steps",
            counted(count, "peak"),
            if count == 1 { "is" } else { "are" },
            significant(hz, 4),
            significant(step, 3),
            significant(half_width, 3)
        )
    }))
}

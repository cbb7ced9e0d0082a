//! Profiles of χ² over calibrated values: each is held at steps, and everything else is fitted again.

use super::report::CalibrationReport;
use crate::Watch;
use crate::analyses::profile::{OpenEnd, Profile, ProfilePoint, ProfileSide};
use crate::error::Cancelled;
use anyhow::Result;
use funicular::calibration::CalibrationFit;

/// Maximum distance at which an end is searched, in deviations.
const REACH: f64 = 30.0;

/// Step of a value that the readings do not determine, relative to the spread of the anchors.
const UNDETERMINED_STEP: f64 = 0.01;

impl CalibrationReport<'_> {
    /// Profiles of the marked values; none for a value that the frame holds, or without a deviation of the data.
    ///
    /// # Errors
    /// Work that was stopped.
    pub(super) fn profiles(&self, marks: &[bool], watch: &mut dyn Watch) -> Result<Vec<Option<Profile>>> {
        let Some((variance, limit)) = self.noise() else { return Ok(vec![None; marks.len()]) };
        let total = marks.iter().filter(|mark| **mark).count();
        let mut found = Vec::with_capacity(marks.len());
        let mut done = 0;
        for (k, mark) in marks.iter().enumerate() {
            if !mark || self.frame.holds(k) {
                found.push(None);
                continue;
            }
            watch.progress(done, total, "profiles");
            done += 1;
            found.push(Some(profile(self, k, (variance, limit), watch)?));
        }
        Ok(found)
    }
}

fn profile(
    of: &CalibrationReport,
    unknown: usize,
    (variance, limit): (f64, f64),
    watch: &mut dyn Watch,
) -> Result<Profile> {
    let best = &of.found.best;
    let meaning = |value: f64| of.of.meaning(unknown, value)[0];
    let deviation = variance.sqrt() * of.precision.deviations()[unknown];
    let step = if deviation > 0.0 { deviation } else { UNDETERMINED_STEP * of.of.anchor_spread() };
    let mut fits: Vec<CalibrationFit> = vec![best.clone()];
    let mut points = vec![ProfilePoint { value: meaning(best.values[unknown]), chi2_rise: 0.0 }];
    let mut ends: [(Option<f64>, Option<OpenEnd>); 2] = [(None, None); 2];
    for (side, sign) in [-1.0, 1.0].into_iter().enumerate() {
        let mut rise = |distance: f64| {
            if watch.is_cancelled() {
                return Err(Cancelled.into());
            }
            let at = best.values[unknown] + sign * distance;
            let apart = |fit: &&CalibrationFit| (fit.values[unknown] - at).abs();
            let near = fits.iter().min_by(|a, b| apart(a).total_cmp(&apart(b))).unwrap_or(best);
            let fit = of.of.fit_held(near, &of.frame, &of.precision, (unknown, at));
            if !fit.chi2.is_finite() {
                return Ok(None);
            }
            let rise = (fit.chi2 - best.chi2) / variance;
            points.push(ProfilePoint { value: meaning(at), chi2_rise: rise });
            fits.push(fit);
            Ok(Some(rise))
        };
        let ways = ProfileSide { limit, step, bound: f64::INFINITY, reach: REACH * step };
        let (distance, open) = ways.end(&mut rise)?;
        ends[side] = (distance.map(|distance| meaning(best.values[unknown] + sign * distance)), open);
    }
    let count = fits.len() - 1;
    Ok(Profile::of(ends, points, count))
}

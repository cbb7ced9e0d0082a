//! Values whose deviation does not hold, because they move along a ridge of χ² with a value that the measurements
//! determine poorly.

use super::model::IdentifiedModel;
use super::profile::{Profiler, USUAL_FITS};
use crate::analyses::profile::{LIMIT, Profile};
use anyhow::Result;
use funicular::math::least_squares::Minimum;

/// Standard deviation of a logarithm from which on χ² is not taken as a parabola along it: the value is between 0.55
/// and 1.8 times the identified one, and not between 1 ± 0.6 times.
const MAX_LOG_DEVIATION: f64 = 0.3;

/// Standard deviation of a value without a logarithm, in units of its usual error, from which on χ² is not taken as a
/// parabola.
const MAX_DEVIATION: f64 = 1.0;

/// Distance of a fit with another value held, over the half width of the interval of the deviation, beyond which this
/// interval does not hold. Fits to the last digit have 1.
const BEYOND: f64 = 1.15;

/// Maximum number of experiments with which profiles are computed without being asked for. Each fit of a profile
/// computes all experiments; with 200 of them the profiles take a minute, and the search a second.
const MAX_EXPERIMENTS: usize = 30;

/// Profiles of the values of a fit.
pub(crate) struct Profiled {
    /// Profile of each unknown, if it was requested or is needed.
    pub(crate) profiles: Vec<Option<Profile>>,
    /// Indices of the unknowns with which each unknown moves farther than its deviation says.
    pub(crate) moves_with: Vec<Vec<usize>>,
    /// True for an unknown whose interval is that of its profile.
    pub(crate) takes_profile: Vec<bool>,
}

/// Computes the profiles of the unknowns with the indices `requested`, and, with up to [`MAX_EXPERIMENTS`] experiments,
/// of those whose deviation does not hold. `deviations` are the standard deviations of the coordinates, and `factor` is
/// the factor by which they were multiplied. `progress` gets the number of fits and the expected number of all.
///
/// # Errors
/// Work that was stopped.
///
/// # References
/// docs/theory.md, section 18a, "Ridges".
pub(crate) fn profiles(
    model: &mut IdentifiedModel<'_>,
    best: &Minimum,
    requested: &[usize],
    deviations: &[Option<f64>],
    factor: f64,
    progress: &dyn Fn(usize, usize),
) -> Result<Profiled> {
    let count = deviations.len();
    let is_poor = |k: usize| {
        let limit = if model.unknowns[k].is_log { MAX_LOG_DEVIATION } else { MAX_DEVIATION };
        deviations[k].is_none_or(|deviation| deviation > limit)
    };
    // Without any deviation nothing is said that may be wrong.
    let has_any = model.experiments.len() <= MAX_EXPERIMENTS && deviations.iter().any(Option::is_some);
    let poor: Vec<usize> = (0..count).filter(|&k| has_any && is_poor(k)).collect();

    let mut found = Profiled {
        profiles: vec![None; count],
        moves_with: vec![Vec::new(); count],
        takes_profile: (0..count).map(|k| deviations[k].is_some() && poor.contains(&k)).collect(),
    };
    let mut profiler = Profiler { model, best, factor, fits: Vec::new() };
    let mut wanted: Vec<usize> = poor.iter().chain(requested).copied().collect();
    wanted.dedup();
    let mut done = 0;
    while let Some(&k) = wanted.get(done) {
        let (first, total) = (profiler.fits.len(), 2 * USUAL_FITS * wanted.len());
        let begin = 2 * USUAL_FITS * done;
        done += 1;
        if found.profiles[k].is_some() {
            continue;
        }
        let profile = profiler.profile(k, deviations[k], &|fits| progress(begin + fits, total))?;
        found.profiles[k] = Some(profile);
        if !poor.contains(&k) {
            continue;
        }

        // Other values at fits that do not contradict the measurements.
        let within = profiler.fits[first..].iter().filter(|fit| fit.rise.is_some_and(|rise| rise <= LIMIT * LIMIT));
        for x in within.map(|fit| &fit.x) {
            for j in (0..count).filter(|j| *j != k) {
                let leaves = |deviation: f64| (x[j] - best.x[j]).abs() > BEYOND * LIMIT * deviation;
                if deviations[j].is_some_and(leaves) && !found.moves_with[j].contains(&k) {
                    found.moves_with[j].push(k);
                    found.takes_profile[j] = true;
                    wanted.push(j);
                }
            }
        }
    }
    let total = 2 * USUAL_FITS * wanted.len();
    if total > 0 {
        progress(total, total);
    }
    Ok(found)
}

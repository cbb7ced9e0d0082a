//! Profile likelihood: how χ² rises if one value is held beside its best one and all others are fitted again.

use super::model::IdentifiedModel;
use super::unknowns::Unknown;
use crate::analyses::profile::{LIMIT, OpenEnd, Profile, ProfilePoint, ProfileSide};
use crate::error::Cancelled;
use anyhow::Result;
use funicular::math::least_squares::{LeastSquaresEnding, Minimum, minimise};

/// Number of fits that is expected per side, for the progress alone.
pub(super) const USUAL_FITS: usize = 8;

/// Maximum distance at which an end is searched, in spreads of the value.
const REACH: f64 = 30.0;

/// Distance at which an end is searched at least, over the distance of the value in the file.
const BEYOND_START: f64 = 1.5;

/// Maximum number of iterations of one fit, which starts beside its minimum.
const MAX_ITERATIONS: usize = 60;

/// Fit with one value held.
#[derive(Debug, Clone)]
pub(super) struct HeldFit {
    /// All coordinates at the minimum.
    pub(super) x: Vec<f64>,
    /// Rise of χ²; `None` if the robot has no equilibrium.
    pub(super) rise: Option<f64>,
}

/// Computes profiles about a minimum.
pub(super) struct Profiler<'p, 'm> {
    /// Model at the last stage of the search.
    pub(super) model: &'p mut IdentifiedModel<'m>,
    /// Minimum.
    pub(super) best: &'p Minimum,
    /// Factor by which the deviations were multiplied.
    pub(super) factor: f64,
    /// Fits of all profiles so far, from which later ones start.
    pub(super) fits: Vec<HeldFit>,
}

impl Profiler<'_, '_> {
    /// Profile of the unknown with this index, whose coordinate has the standard deviation `deviation`. `progress` gets
    /// the number of fits, at most two times [`USUAL_FITS`].
    ///
    /// # Errors
    /// Work that was stopped.
    ///
    /// # References
    /// docs/theory.md, equation (93h).
    pub(super) fn profile(&mut self, k: usize, deviation: Option<f64>, progress: &dyn Fn(usize)) -> Result<Profile> {
        let choices = self.model.choices();
        let unknown = &self.model.unknowns[k];
        // A deviation beyond the usual error is of a direction that is hardly seen: its step leads to fits so far away
        // that others that start from them end at another minimum.
        let usual = unknown.spread();
        let step = deviation.filter(|deviation| *deviation > 0.0).map_or(usual, |deviation| deviation.min(usual));
        let mut ends = [(None, None); 2];
        let first = self.fits.len();
        for (side, sign) in [-1.0, 1.0].into_iter().enumerate() {
            let begin = side * USUAL_FITS;
            let first = self.fits.len();
            let mut of_side =
                Side { profiler: self, k, sign, first, begin: &|fits| progress(begin + fits.min(USUAL_FITS)) };
            ends[side] = of_side.end(step)?;
        }
        self.model.choose(choices);

        let unknown: &Unknown = &self.model.unknowns[k];
        let fits = &self.fits[first..];
        let at_minimum = ProfilePoint { value: unknown.value(self.best.x[k]), chi2_rise: 0.0 };
        let point = |fit: &HeldFit| Some(ProfilePoint { value: unknown.value(fit.x[k]), chi2_rise: fit.rise? });
        let points = fits.iter().filter_map(point).chain([at_minimum]).collect();
        Ok(Profile::of(ends.map(|(end, open)| (end.map(|x| unknown.value(x)), open)), points, fits.len()))
    }
}

/// One side of a profile.
struct Side<'s, 'p, 'm> {
    profiler: &'s mut Profiler<'p, 'm>,
    k: usize,
    sign: f64,
    /// Index of the first fit of this side.
    first: usize,
    /// Reports the number of fits.
    begin: &'s dyn Fn(usize),
}

impl Side<'_, '_, '_> {
    /// Coordinate at which χ² reaches its limit, or the reason why there is none.
    fn end(&mut self, step: f64) -> Result<(Option<f64>, Option<OpenEnd>)> {
        let (unknown, best) = (&self.profiler.model.unknowns[self.k], self.profiler.best.x[self.k]);
        let (low, high) = unknown.coordinate_bounds();
        let bound = if self.sign < 0.0 { best - low } else { high - best };
        // A value without an end has run away from the file's value, which the profile has to come back to.
        let from_start = (best - unknown.coordinate(unknown.start)).abs();
        let reach = (REACH * step.max(unknown.spread())).max(BEYOND_START * from_start);
        let side = ProfileSide { limit: LIMIT, step, bound, reach };
        let (distance, open) = side.end(&mut |distance| self.rise(distance))?;
        Ok((distance.map(|distance| best + self.sign * distance), open))
    }

    /// Rise of χ² if the coordinate is held at a distance; `None` if the robot has no equilibrium there.
    fn rise(&mut self, distance: f64) -> Result<Option<f64>> {
        let Profiler { model, best, factor, fits } = &mut *self.profiler;
        (self.begin)(fits.len() - self.first);
        let at = best.x[self.k] + self.sign * distance;
        let near = fits.iter().filter(|fit| fit.rise.is_some()).map(|fit| &fit.x).chain([&best.x]);
        let nearest = near.min_by(|a, b| (a[self.k] - at).abs().total_cmp(&(b[self.k] - at).abs()));
        let mut start = nearest.unwrap_or(&best.x).clone();
        start[self.k] = at;

        // Equal bounds hold the value.
        let mut bounds: Vec<(f64, f64)> = model.unknowns.iter().map(Unknown::coordinate_bounds).collect();
        bounds[self.k] = (at, at);
        let found = minimise(*model, &start, &bounds, MAX_ITERATIONS);
        if found.as_ref().is_none_or(|found| found.ending == LeastSquaresEnding::Cancelled) && model.is_stopped() {
            return Err(Cancelled.into());
        }
        let rise = found.as_ref().map(|found| (found.chi2() - best.chi2()) / (*factor * *factor));
        fits.push(HeldFit { x: found.map_or(start, |found| found.x), rise });
        Ok(rise)
    }
}

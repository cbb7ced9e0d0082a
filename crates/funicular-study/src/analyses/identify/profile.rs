//! Profile likelihood: how χ² rises if one value is held beside its best one and all others are fitted again.

use super::model::IdentifiedModel;
use super::unknowns::Unknown;
use crate::error::Cancelled;
use anyhow::Result;
use funicular::math::least_squares::{LeastSquaresEnding, Minimum, minimise};

/// Root of the rise of χ² at the ends of an interval of 95 %: the quantile of the normal distribution, whose square
/// 3.84 is the quantile of χ² with one degree of freedom.
pub(crate) const LIMIT: f64 = 1.959_963_984_540_054;

/// Maximum relative error of this root at an end: the interval is accurate to this fraction of its half width.
const ACCURACY: f64 = 1e-3;

/// Maximum number of fits on the way to one end; four are usual.
const MAX_FITS: usize = 30;

/// Number of fits that is expected per side, for the progress alone.
pub(super) const USUAL_FITS: usize = 8;

/// Maximum distance at which an end is searched, in spreads of the value.
const REACH: f64 = 30.0;

/// Distance at which an end is searched at least, over the distance of the value in the file.
const BEYOND_START: f64 = 1.5;

/// Minimum and maximum factor by which the distance grows from one fit to the next before an end is enclosed.
const MIN_GROWTH: f64 = 1.1;
const MAX_GROWTH: f64 = 4.0;

/// Minimum distance of the next fit from both sides of an interval that encloses an end, relative to its width.
const MIN_PART: f64 = 0.05;

/// Width of the interval that encloses an end, relative to its outer side, up to which χ² jumps over its limit there.
const MIN_WIDTH: f64 = ACCURACY * ACCURACY;

/// Maximum number of iterations of one fit, which starts beside its minimum.
const MAX_ITERATIONS: usize = 60;

/// Distances at which points of the curve are computed, relative to the distance of the end; the last one is beyond it.
const FRACTIONS: [f64; 4] = [0.25, 0.5, 0.75, 1.25];

/// Fall of χ² below the minimum, in units in which the limit of its rise is 3.84. A point this far below the minimum
/// shows that the search missed it.
const FALL: f64 = 1e-2;

/// Point of a profile.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct ProfilePoint {
    /// Value that is held.
    pub value: f64,
    /// Rise of χ² over its minimum, divided by the square of the factor of the deviations.
    pub chi2_rise: f64,
}

/// Reason why a profile has no end on a side.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum OpenEnd {
    /// χ² stays below its limit up to the bound of the value.
    Bound,
    /// χ² stays below its limit within the searched distance.
    Flat,
    /// The robot has no equilibrium beyond.
    NoEquilibrium,
}

/// Profile of one value.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Profile {
    /// Lower end of the interval that holds the value with 95 %; absent if χ² does not reach its limit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from: Option<f64>,
    /// Upper end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to: Option<f64>,
    /// Reason why there is no lower end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub open_below: Option<OpenEnd>,
    /// Reason why there is no upper end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub open_above: Option<OpenEnd>,
    /// Points, ascending, with the minimum.
    pub points: Vec<ProfilePoint>,
    /// Fits that were made.
    pub fits: usize,
    /// True if a fit has a smaller χ² than the minimum: the search has missed it.
    pub falls: bool,
}

impl Profile {
    /// Rise of χ² at the ends of an interval of 95 %.
    pub const RISE_95: f64 = LIMIT * LIMIT;
}

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
        // A deviation beyond the usual error is of a direction that is hardly seen: its step leads to fits so far away that
        // others that start from them end at another minimum.
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

        let fits = &self.fits[first..];
        let mut points: Vec<(f64, f64)> = fits.iter().filter_map(|fit| Some((fit.x[k], fit.rise?))).collect();
        points.push((self.best.x[k], 0.0));
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let unknown: &Unknown = &self.model.unknowns[k];
        let [from, to] = ends.map(|(end, _)| end.map(|x| unknown.value(x)));
        let [open_below, open_above] = ends.map(|(_, open)| open);
        Ok(Profile {
            from,
            to,
            open_below,
            open_above,
            falls: points.iter().any(|(_, rise)| *rise < -FALL),
            points: points
                .into_iter()
                .map(|(x, chi2_rise)| ProfilePoint { value: unknown.value(x), chi2_rise })
                .collect(),
            fits: fits.len(),
        })
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
        if bound <= 0.0 {
            return Ok((None, Some(OpenEnd::Bound)));
        }
        // A value without an end has run away from the file's value, which the profile has to come back to.
        let from_start = (best - unknown.coordinate(unknown.start)).abs();
        let reach = (REACH * step.max(unknown.spread())).max(BEYOND_START * from_start);

        // The root of the rise is nearly proportional to the distance.
        let (mut below, mut above) = ((0.0, 0.0), None::<(f64, f64)>);
        let mut distance = (LIMIT * step).min(bound);
        let mut end = None;
        for _ in 0..MAX_FITS {
            let root = self.rise(distance)?.map_or(f64::INFINITY, |rise| rise.max(0.0).sqrt());
            if (root / LIMIT - 1.0).abs() <= ACCURACY {
                end = Some(distance);
                break;
            }
            if root < LIMIT {
                below = (distance, root);
                if distance >= bound || distance >= reach {
                    break;
                }
            } else {
                above = Some((distance, root));
            }
            distance = match above {
                None => (distance * (LIMIT / root).clamp(MIN_GROWTH, MAX_GROWTH)).min(bound).min(reach),
                Some((far, root)) if root.is_finite() => {
                    let part = (LIMIT - below.1) / (root - below.1);
                    below.0 + part.clamp(MIN_PART, 1.0 - MIN_PART) * (far - below.0)
                }
                Some((far, _)) => 0.5 * (below.0 + far),
            };
            if above.is_some_and(|(far, _)| far - below.0 <= MIN_WIDTH * far) {
                break;
            }
        }
        let (end, open) = match (end, above) {
            (Some(end), _) => (end, None),
            // χ² jumps over its limit, as where a measured frequency changes its mode.
            (None, Some((far, root))) if root.is_finite() => (0.5 * (below.0 + far), None),
            (None, Some(_)) => (below.0, Some(OpenEnd::NoEquilibrium)),
            (None, None) if below.0 >= bound => (below.0, Some(OpenEnd::Bound)),
            (None, None) => (below.0, Some(OpenEnd::Flat)),
        };

        // The curve between, and beyond.
        for fraction in FRACTIONS {
            let at = fraction * end;
            if at < bound && at > 0.0 && (fraction < 1.0 || open.is_none()) {
                self.rise(at)?;
            }
        }
        Ok((open.is_none().then_some(best + self.sign * end), open))
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

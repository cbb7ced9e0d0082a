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
const USUAL_FITS: usize = 8;

/// Maximum distance at which an end is searched, in spreads of the value.
const REACH: f64 = 30.0;

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

/// Computes the profiles of the unknowns with these indices. `deviations` are the standard deviations of the
/// coordinates, and `factor` is the factor by which they were multiplied. `progress` gets the number of fits and the
/// expected number of all.
///
/// # Errors
/// Work that was stopped.
///
/// # References
/// docs/theory.md, equation (93h).
pub(crate) fn profiles(
    model: &mut IdentifiedModel<'_>,
    best: &Minimum,
    numbers: &[usize],
    deviations: &[Option<f64>],
    factor: f64,
    progress: &dyn Fn(usize, usize),
) -> Result<Vec<Profile>> {
    let total = 2 * USUAL_FITS * numbers.len();
    let held = model.choices();
    let mut found = Vec::with_capacity(numbers.len());
    for (i, &k) in numbers.iter().enumerate() {
        let unknown = &model.unknowns[k];
        let step = deviations[k].filter(|deviation| *deviation > 0.0).unwrap_or_else(|| unknown.spread());
        let mut ends = [(None, None); 2];
        let mut points = vec![(best.x[k], 0.0)];
        let mut fits = 0;
        for (side, sign) in [-1.0, 1.0].into_iter().enumerate() {
            let begin = USUAL_FITS * (2 * i + side);
            let mut of_side = Side {
                model,
                best,
                k,
                sign,
                factor,
                known: vec![Known { distance: 0.0, x: best.x.clone(), rise: Some(0.0) }],
                begin: &|fits| progress(begin + fits.min(USUAL_FITS), total),
            };
            ends[side] = of_side.end(step)?;
            let known = &of_side.known[1..];
            fits += known.len();
            points.extend(known.iter().filter_map(|known| Some((known.x[k], known.rise?))));
        }

        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let unknown: &Unknown = &model.unknowns[k];
        let [from, to] = ends.map(|(end, _)| end.map(|x| unknown.value(x)));
        let [open_below, open_above] = ends.map(|(_, open)| open);
        found.push(Profile {
            from,
            to,
            open_below,
            open_above,
            falls: points.iter().any(|(_, rise)| *rise < -FALL),
            points: points
                .into_iter()
                .map(|(x, chi2_rise)| ProfilePoint { value: unknown.value(x), chi2_rise })
                .collect(),
            fits,
        });
    }
    model.choose(held);
    progress(total, total);
    Ok(found)
}

/// Fit with one value held.
struct Known {
    /// Distance of the coordinate from the best one.
    distance: f64,
    /// All coordinates at the minimum.
    x: Vec<f64>,
    /// Rise of χ²; `None` if the robot has no equilibrium.
    rise: Option<f64>,
}

/// One side of a profile.
struct Side<'s, 'm> {
    model: &'s mut IdentifiedModel<'m>,
    best: &'s Minimum,
    k: usize,
    sign: f64,
    factor: f64,
    known: Vec<Known>,
    /// Reports the number of fits.
    begin: &'s dyn Fn(usize),
}

impl Side<'_, '_> {
    /// Coordinate at which χ² reaches its limit, or the reason why there is none.
    fn end(&mut self, step: f64) -> Result<(Option<f64>, Option<OpenEnd>)> {
        let (low, high) = self.model.unknowns[self.k].coordinate_bounds();
        let bound = if self.sign < 0.0 { self.best.x[self.k] - low } else { high - self.best.x[self.k] };
        if bound <= 0.0 {
            return Ok((None, Some(OpenEnd::Bound)));
        }
        let reach = REACH * step.max(self.model.unknowns[self.k].spread());

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
        let x = self.best.x[self.k] + self.sign * end;
        Ok((open.is_none().then_some(x), open))
    }

    /// Rise of χ² if the coordinate is held at a distance; `None` if the robot has no equilibrium there.
    fn rise(&mut self, distance: f64) -> Result<Option<f64>> {
        (self.begin)(self.known.len() - 1);
        let nearest = (self.known.iter())
            .filter(|known| known.rise.is_some())
            .min_by(|a, b| (a.distance - distance).abs().total_cmp(&(b.distance - distance).abs()));
        let mut start = nearest.map_or_else(|| self.best.x.clone(), |known| known.x.clone());
        start[self.k] = self.best.x[self.k] + self.sign * distance;

        // Equal bounds hold the value.
        let mut bounds: Vec<(f64, f64)> = self.model.unknowns.iter().map(Unknown::coordinate_bounds).collect();
        bounds[self.k] = (start[self.k], start[self.k]);
        let found = minimise(self.model, &start, &bounds, MAX_ITERATIONS);
        if found.as_ref().is_none_or(|found| found.ending == LeastSquaresEnding::Cancelled) && self.model.is_stopped() {
            return Err(Cancelled.into());
        }
        let rise = found.as_ref().map(|found| (found.chi2() - self.best.chi2()) / (self.factor * self.factor));
        self.known.push(Known { distance, x: found.map_or(start, |found| found.x), rise });
        Ok(rise)
    }
}

//! Profile of χ²: how it rises if one value is held beside its best one and all others are fitted again, and where it
//! reaches the limit of an interval. `identify` and `calibrate` make the fits.

use crate::rows::{Described, rows};
use anyhow::Result;
use serde_json::{Value, json};

/// Root of the rise of χ² at the ends of an interval of 95 %: the quantile of the normal distribution, whose square
/// 3.84 is the quantile of χ² with one degree of freedom.
pub(crate) const LIMIT: f64 = 1.959_963_984_540_054;

/// Maximum relative error of this root at an end: the interval is accurate to this fraction of its half width.
const ACCURACY: f64 = 1e-3;

/// Maximum number of fits on the way to one end; four are usual.
const MAX_FITS: usize = 30;

/// Minimum and maximum factor by which the distance grows from one fit to the next before an end is enclosed.
const MIN_GROWTH: f64 = 1.1;
const MAX_GROWTH: f64 = 4.0;

/// Minimum distance of the next fit from both sides of an interval that encloses an end, relative to its width.
const MIN_PART: f64 = 0.05;

/// Width of the interval that encloses an end, relative to its outer side, up to which χ² jumps over its limit there.
const MIN_WIDTH: f64 = ACCURACY * ACCURACY;

/// Distances at which points of the curve are computed, relative to the distance of the end; the last one is beyond it.
const FRACTIONS: [f64; 4] = [0.25, 0.5, 0.75, 1.25];

/// Fall of χ² below the minimum, in units in which the limit of its rise is 3.84. A point this far below the minimum
/// shows that the search missed it.
const FALL: f64 = 1e-2;

rows! {
    /// Point of a profile.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct ProfilePoint {
        /// Value that is held.
        pub value: f64;
        /// Rise of χ² over its minimum, divided by the square of the factor of the deviations.
        pub chi2_rise: f64;
    }
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

impl Described for OpenEnd {
    fn schema() -> Value {
        json!({ "type": "string", "enum": ["bound", "flat", "no-equilibrium"] })
    }
}

rows! {
    /// Profile of one value.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Profile {
        /// Lower end of the interval that holds the value with 95 %; absent if χ² does not reach its limit.
        pub from: Option<f64>;
        /// Upper end.
        pub to: Option<f64>;
        /// Reason why there is no lower end.
        pub open_below: Option<OpenEnd>;
        /// Reason why there is no upper end.
        pub open_above: Option<OpenEnd>;
        /// Points, ascending, with the minimum.
        pub points: Vec<ProfilePoint>;
        /// Fits that were made.
        pub fits: usize;
        /// True if a fit has a smaller χ² than the minimum: the search has missed it.
        pub falls: bool;
    }
}

impl Profile {
    /// Rise of χ² at the ends of an interval of 95 %.
    pub const RISE_95: f64 = LIMIT * LIMIT;

    /// Profile from the ends below and above, with the reasons why there is none, and points of value and rise of χ² in
    /// any order.
    pub(crate) fn of(ends: [(Option<f64>, Option<OpenEnd>); 2], mut points: Vec<ProfilePoint>, fits: usize) -> Self {
        let [(from, open_below), (to, open_above)] = ends;
        points.sort_by(|a, b| a.value.total_cmp(&b.value));
        let falls = points.iter().any(|point| point.chi2_rise < -FALL);
        Self { from, to, open_below, open_above, points, fits, falls }
    }
}

/// Distances of one side of a profile.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ProfileSide {
    /// Root of the rise of χ² at the end.
    pub(crate) limit: f64,
    /// Expected distance at which the root is one.
    pub(crate) step: f64,
    /// Distance of the bound of the value.
    pub(crate) bound: f64,
    /// Distance at which the search ends.
    pub(crate) reach: f64,
}

impl ProfileSide {
    /// Distance at which χ² reaches its limit, or the reason why there is none; fits points of the curve as well.
    /// `rise` is the rise of χ² with the value held at a distance, `None` if nothing can be fitted there.
    ///
    /// # Errors
    /// Those of `rise`.
    pub(crate) fn end(
        self,
        rise: &mut dyn FnMut(f64) -> Result<Option<f64>>,
    ) -> Result<(Option<f64>, Option<OpenEnd>)> {
        let Self { limit, step, bound, reach } = self;
        if bound <= 0.0 {
            return Ok((None, Some(OpenEnd::Bound)));
        }
        // The root of the rise is nearly proportional to the distance.
        let (mut below, mut above) = ((0.0, 0.0), None::<(f64, f64)>);
        let mut distance = (limit * step).min(bound);
        let mut end = None;
        for _ in 0..MAX_FITS {
            let root = rise(distance)?.map_or(f64::INFINITY, |rise| rise.max(0.0).sqrt());
            if (root / limit - 1.0).abs() <= ACCURACY {
                end = Some(distance);
                break;
            }
            if root < limit {
                below = (distance, root);
                if distance >= bound || distance >= reach {
                    break;
                }
            } else {
                above = Some((distance, root));
            }
            distance = match above {
                None => (distance * (limit / root).clamp(MIN_GROWTH, MAX_GROWTH)).min(bound).min(reach),
                Some((far, root)) if root.is_finite() => {
                    let part = (limit - below.1) / (root - below.1);
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
                rise(at)?;
            }
        }
        Ok((open.is_none().then_some(end), open))
    }
}

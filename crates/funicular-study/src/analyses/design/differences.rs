//! Derivatives by differences: robots on both sides of a value, and the share of poses that are held as a smooth
//! number.

use crate::at_rest::AtRest;

/// Half step of a difference over the distance of the bounds of its value. Results are exact to 1e-11: the difference
/// is wrong by 1e-6 of its size from rounding, and by 1e-10 of the second derivative over that distance.
pub(super) const HALF_STEP: f64 = 1e-5;

/// Change of the load factor about 1 over which a pose passes from not held to held. A smaller one lets fewer poses
/// pull at the values, a larger one counts poses that are clearly held or lost; the text counts them sharply.
const SOFT: f64 = 0.1;

/// Robot at rest on both sides of a value.
pub(super) struct Ends {
    /// Below and above; none without equilibrium.
    pub(super) at_rest: [Option<AtRest>; 2],
    /// Distances to them, in the unit of the value; zero at a bound of what the value may be.
    pub(super) steps: [f64; 2],
}

impl Ends {
    /// Derivative of a result with this value in the middle.
    pub(super) fn slope(&self, middle: f64, of: impl Fn(&AtRest) -> Option<f64>) -> f64 {
        self.slope_of(self.at_rest.each_ref().map(|end| end.as_ref().and_then(&of)), middle)
    }

    /// Derivative from the values at both ends: of one side where the other has none, zero without both.
    pub(super) fn slope_of(&self, ends: [Option<f64>; 2], middle: f64) -> f64 {
        let [below, above] = self.steps;
        let (from, to) = (ends[0].filter(|_| below > 0.0), ends[1].filter(|_| above > 0.0));
        let distance = from.map_or(0.0, |_| below) + to.map_or(0.0, |_| above);
        if distance > 0.0 { (to.unwrap_or(middle) - from.unwrap_or(middle)) / distance } else { 0.0 }
    }
}

/// Share of a pose with this load factor in the poses that are held, from 0 to 1, and its derivative.
pub(super) fn smooth_share(factor: f64) -> (f64, f64) {
    let share = 1.0 / (1.0 + ((1.0 - factor) / SOFT).exp());
    (share, share * (1.0 - share) / SOFT)
}

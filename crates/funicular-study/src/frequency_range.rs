//! Frequencies of a range.

use crate::at_rest::AtRest;
use crate::request::{FrequencyRange, MAX_HZ, ResponseRange, check};
use crate::values::{not_negative, positive};
use anyhow::{Result, anyhow, bail};
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::modes::{self, LowestError};
use std::f64::consts::TAU;

/// Maximum number of frequencies of one range.
pub const MAX_POINTS: usize = 1_000_000;

/// Number of frequencies from which an adaptive response starts if the request gives none.
pub const START_POINTS: usize = 200;

/// Number of the lowest natural frequencies that `modes` shows and a response contains if the request gives no limit: a
/// suspended robot of eight cables has its platform's modes among them, and they fit on a screen.
pub const LOWEST: usize = 20;

/// Default end of a response over the frequency of the platform's first mode.
const BEYOND_PLATFORM: f64 = 1.5;

/// Default limit of the modes that take part in the sway of the platform over its highest frequency: modes that veer
/// with cables lie a few per cent above it.
const BEYOND_SWAY: f64 = 1.2;

/// Maximum number of modes below that limit: their damped list takes some seconds.
const MOST_OF_SWAY: usize = 1000;

/// Default first frequency of a response with equal ratios, over the last one.
const FIRST_OVER_LAST: f64 = 1e-3;

/// Frequency a little higher with two digits [Hz], for a limit.
pub(crate) fn rounded_up(hz: f64) -> f64 {
    let unit = 10_f64.powi(hz.log10().floor() as i32 - 1);
    let digits = (hz / unit).floor() + 1.0;
    // Text has the nearest number to the decimal one, a product has not.
    format!("{:.*}", 9, digits * unit).parse().unwrap_or(digits * unit)
}

impl AtRest {
    /// Limit [Hz] of a list of modes: the given one, or a little above the [`LOWEST`] natural frequencies. If there are
    /// fewer, it is above all of them.
    ///
    /// # Errors
    /// A limit that is not positive, or a cable model that has no stiffness at this equilibrium.
    pub fn modes_limit(&self, given: Option<f64>, linearisation: Linearisation) -> Result<f64> {
        if let Some(given) = given {
            return check("below_hz", Some(given), positive).map(|()| given);
        }
        let AtRest { robot, equilibrium, .. } = &*self.vibrating();
        let list = match modes::lowest(robot, equilibrium, linearisation, LOWEST, MAX_HZ) {
            Ok((_, list)) => list.modes,
            Err(LowestError::TooFew { .. }) => self.modes_below(linearisation, MAX_HZ, modes::MAX_MODES)?.modes.modes,
            Err(error @ LowestError::Dynamics(_)) => return Err(error.into()),
        };
        Ok(list.iter().take(LOWEST).next_back().map_or(MAX_HZ, |mode| rounded_up(mode.frequency_hz)))
    }

    /// End of a response [Hz] above the lowest natural frequencies and the first mode of the platform.
    pub(crate) fn response_limit(&self, linearisation: Linearisation) -> Result<f64> {
        let limit = self.modes_limit(None, linearisation)?;
        let share = modes::PLATFORM_SHARE;
        let AtRest { robot, equilibrium, .. } = &*self.vibrating();
        let found = modes::lowest_with_platform(robot, equilibrium, linearisation, share, MAX_HZ);
        // Without a mode of the platform the lowest natural frequencies are the range.
        let first = found.ok().and_then(|(_, list)| Some(list.modes[list.first_platform(share)?].frequency_hz));
        Ok(first.map_or(limit, |hz| limit.max(rounded_up(BEYOND_PLATFORM * hz))))
    }

    /// Limit [Hz] of the modes that take part in the sway of the platform: above all frequencies of the platform on
    /// cables that follow it as at rest, unless there are too many modes below it.
    pub(crate) fn sway_limit(&self, linearisation: Linearisation) -> Result<f64> {
        let limit = self.response_limit(linearisation)?;
        let AtRest { robot, equilibrium, .. } = &*self.vibrating();
        let of_platform = Dynamics::about(robot, equilibrium, linearisation, limit)?.platform_frequencies();
        let Some(highest) = of_platform.and_then(|all| all.last().copied()) else { return Ok(limit) };
        let wanted = limit.max(rounded_up(BEYOND_SWAY * highest));
        let count = Dynamics::about(robot, equilibrium, linearisation, wanted)?.modes_below(wanted * TAU);
        Ok(if count <= MOST_OF_SWAY { wanted } else { limit })
    }

    /// Frequencies of a response, with limits that follow from the robot where the request leaves them out.
    ///
    /// # Errors
    /// The errors of [`modes_limit`](Self::modes_limit).
    pub fn response_range(&self, range: &ResponseRange, linearisation: Linearisation) -> Result<FrequencyRange> {
        let to_hz = range.to_hz.map_or_else(|| self.response_limit(linearisation), Ok)?;
        let first = if range.log { FIRST_OVER_LAST * to_hz } else { 0.0 };
        Ok(FrequencyRange { from_hz: range.from_hz.unwrap_or(first), to_hz, points: range.points, log: range.log })
    }
}

impl FrequencyRange {
    /// Frequencies [Hz] from which an adaptive response starts, by default [`START_POINTS`].
    ///
    /// # Errors
    /// The errors of [`frequencies`](Self::frequencies).
    pub fn starts(&self) -> Result<Vec<f64>> {
        Self { points: Some(self.points.unwrap_or(START_POINTS)), ..*self }.frequencies()
    }

    /// Frequencies [Hz], ascending. The first and the last are exact.
    ///
    /// # Errors
    /// A range that does not ascend, a logarithmic range from zero, or no, too few or too many points.
    pub fn frequencies(&self) -> Result<Vec<f64>> {
        let Self { from_hz: from, to_hz: to, points, log } = *self;
        not_negative(from).map_err(|reason| anyhow!("⟪from_hz⟫: {reason}"))?;
        positive(to).map_err(|reason| anyhow!("⟪to_hz⟫: {reason}"))?;
        let Some(points) = points else { bail!("⟪points⟫ is missing: give the number of frequencies") };
        if !(2..=MAX_POINTS).contains(&points) {
            bail!("⟪points⟫: {points} frequencies are not possible: give a number from 2 to {MAX_POINTS}");
        }
        if to <= from {
            bail!("⟪to_hz⟫ {to} is not above ⟪from_hz⟫ {from}: the range has to ascend");
        }
        if log && from <= 0.0 {
            bail!("⟪log⟫ needs ⟪from_hz⟫ above zero: equal ratios cannot start at zero");
        }

        let last = points - 1;
        let at = |i: usize| {
            let fraction = i as f64 / last as f64;
            match i {
                0 => from,
                _ if i == last => to,
                _ if log => from * (to / from).powf(fraction),
                _ => from + (to - from) * fraction,
            }
        };
        let grid: Vec<f64> = (0..=last).map(at).collect();
        if grid.windows(2).any(|pair| pair[1] <= pair[0]) {
            bail!(
                "⟪points⟫: between {from} and {to} Hz there are fewer than {points} different numbers: request fewer \
                 points"
            );
        }
        Ok(grid)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(from_hz: f64, to_hz: f64, points: usize, log: bool) -> Result<Vec<f64>> {
        FrequencyRange { from_hz, to_hz, points: Some(points), log }.frequencies()
    }

    #[test]
    fn both_ends_are_exact_and_steps_are_equal_or_in_equal_ratio() {
        assert_eq!(range(0.0, 1.0, 5, false).unwrap(), [0.0, 0.25, 0.5, 0.75, 1.0]);
        let grid = range(0.1, 10.0, 3, true).unwrap();
        assert!((grid[1] - 1.0).abs() < 1e-15 && grid[2].to_bits() == 10.0_f64.to_bits());
    }

    #[test]
    fn a_default_limit_is_above_the_frequency_and_has_two_digits() {
        for (hz, limit) in [(4.513, 4.6), (9.97, 10.0), (0.0123, 0.013), (120.0, 130.0), (2.0, 2.1)] {
            assert_eq!(rounded_up(hz).to_bits(), f64::to_bits(limit), "{hz}: {}", rounded_up(hz));
        }
    }

    #[test]
    fn ranges_that_do_not_ascend_are_refused() {
        assert!(range(1.0, 1.0, 5, false).is_err() && range(2.0, 1.0, 5, false).is_err());
        assert!(range(0.0, 1.0, 5, true).is_err());
        assert!(range(1.0, 1.0 + 1e-15, 50, false).is_err());
        assert!(range(f64::NAN, 1.0, 5, false).is_err() && range(0.0, 1.0, 1, false).is_err());
    }
}

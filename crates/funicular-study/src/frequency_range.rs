//! Frequencies of a range.

use crate::request::FrequencyRange;
use crate::values::{not_negative, positive};
use anyhow::{Result, anyhow, bail};

/// Maximum number of frequencies of one range.
pub const MAX_POINTS: usize = 1_000_000;

/// Number of frequencies from which an adaptive response starts if the request gives none.
pub const START_POINTS: usize = 200;

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
    fn ranges_that_do_not_ascend_are_refused() {
        assert!(range(1.0, 1.0, 5, false).is_err() && range(2.0, 1.0, 5, false).is_err());
        assert!(range(0.0, 1.0, 5, true).is_err());
        assert!(range(1.0, 1.0 + 1e-15, 50, false).is_err());
        assert!(range(f64::NAN, 1.0, 5, false).is_err() && range(0.0, 1.0, 1, false).is_err());
    }
}

//! Frequencies from one to another.

use crate::args::RangeArgs;
use anyhow::{Result, bail};

/// The frequencies that the options ask for [Hz], ascending; the first and the last are exact.
pub(crate) fn frequencies(args: &RangeArgs) -> Result<Vec<f64>> {
    let (from, to) = (args.from_hz, args.to_hz);
    if to <= from {
        bail!("--to-hz {to} is not above --from-hz {from}: the range has to ascend");
    }
    if args.log && from <= 0.0 {
        bail!("--log needs a --from-hz above zero: equal ratios never start from it");
    }
    let last = args.points as usize - 1;
    let at = |i: usize| {
        let part = i as f64 / last as f64;
        match i {
            0 => from,
            _ if i == last => to,
            _ if args.log => from * (to / from).powf(part),
            _ => from + (to - from) * part,
        }
    };
    let grid: Vec<f64> = (0..=last).map(at).collect();
    if grid.windows(2).any(|pair| pair[1] <= pair[0]) {
        bail!(
            "--points {} are more than the numbers between {from} and {to} Hz can tell apart; ask for fewer",
            args.points
        );
    }
    Ok(grid)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(from_hz: f64, to_hz: f64, points: u64, log: bool) -> Result<Vec<f64>> {
        frequencies(&RangeArgs { from_hz, to_hz, points, log })
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
    }
}

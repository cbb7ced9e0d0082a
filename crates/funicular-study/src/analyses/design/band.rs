//! Band of frequencies to avoid: for each pose, the natural frequencies that go below it and those that go above it.

use crate::rows::rows;

/// Maximum number of choices that are tried besides the nearer sides. Each choice is a search of its own.
const MAX_OTHERS: usize = 6;

/// Number of natural frequencies that go below the band, one entry per pose; the others go above it. `None` stands for
/// a pose where each frequency goes to its nearer side. Without entries this holds at all poses.
pub(crate) type Sides = Vec<Option<usize>>;

/// Numbers of the natural frequencies of a pose below and within the band to avoid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct BandCounts {
    /// Number of frequencies below the band.
    pub(crate) below: usize,
    /// Number of frequencies below the middle of the band: their nearer side is below.
    pub(crate) nearer_below: usize,
    /// Number of frequencies below or within the band.
    pub(crate) not_above: usize,
}

/// Depth of a frequency within a band, its distance from the nearer end; negative outside.
pub(crate) fn depth([first, last]: [f64; 2], hz: f64) -> f64 {
    (hz - first).min(last - hz)
}

/// Middle of a band. A frequency below it has its nearer side below the band.
pub(crate) fn middle([first, last]: [f64; 2]) -> f64 {
    0.5 * (first + last)
}

impl BandCounts {
    /// True if a frequency is in the band.
    fn in_band(&self) -> bool {
        self.below < self.not_above
    }
}

rows! {
    /// Choice of the sides of a band, with its result.
    #[derive(Debug, Clone)]
    pub struct SidesTried {
        /// Number of natural frequencies that had to go below the band, one per pose.
        pub below: Vec<usize>;
        /// Value of the goal; `None` if a demand was not met.
        pub after: Option<f64>;
        /// True for the choice of the result.
        pub is_chosen: bool;
    }
}

/// Choices besides the nearer sides for the frequencies that are in the band at the start, and the number of further
/// choices that are left out.
///
/// Frequencies keep their order, so a choice is a number of frequencies below the band at each pose. Choices with the
/// same number at all poses come first, as far as the frequencies in the band allow: neighbouring poses have similar
/// lists of modes. Choices that differ from the nearer sides at a single pose follow. Within each kind, a choice comes
/// earlier if it sends fewer frequencies to their farther side.
pub(crate) fn others(poses: &[BandCounts]) -> (Vec<Sides>, usize) {
    let nearer: Sides = poses.iter().map(|of| of.in_band().then_some(of.nearer_below)).collect();
    let moved = |sides: &Sides| -> usize {
        sides.iter().zip(&nearer).filter_map(|(one, other)| Some(one.as_ref()?.abs_diff((*other)?))).sum()
    };
    let concerned = || poses.iter().filter(|of| of.in_band());
    let fewest = concerned().map(|of| of.below).min().unwrap_or(0);
    let most = concerned().map(|of| of.not_above).max().unwrap_or(0);

    // One count for all poses; a pose whose frequencies in the band do not allow it takes the nearest count.
    let common = |number: usize| -> Sides {
        poses.iter().map(|of| of.in_band().then(|| number.clamp(of.below, of.not_above))).collect()
    };
    let mut all: Vec<Sides> = (fewest..=most).map(common).collect();
    all.sort_by_key(moved);

    // One pose alone.
    let mut single = Vec::new();
    for (pose, of) in poses.iter().enumerate().filter(|(_, of)| of.in_band()) {
        for number in of.below..=of.not_above {
            let mut sides = nearer.clone();
            sides[pose] = Some(number);
            single.push(sides);
        }
    }
    single.sort_by_key(moved);

    let mut choices: Vec<Sides> = Vec::new();
    for sides in all.into_iter().chain(single) {
        if sides != nearer && !choices.contains(&sides) {
            choices.push(sides);
        }
    }
    let left = choices.len().saturating_sub(MAX_OTHERS);
    choices.truncate(MAX_OTHERS);
    (choices, left)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn places(below: usize, nearer_below: usize, not_above: usize) -> BandCounts {
        BandCounts { below, nearer_below, not_above }
    }

    #[test]
    fn frequencies_go_to_the_other_side_together_first_and_then_at_single_poses() {
        // One frequency in the band at one pose, below its middle: it may go above.
        assert_eq!(others(&[places(2, 3, 3)]), (vec![vec![Some(2)]], 0));
        // Two, one on each side.
        assert_eq!(others(&[places(2, 3, 4)]), (vec![vec![Some(2)], vec![Some(4)]], 0));
        // A pose without frequencies in the band keeps the nearer sides.
        let (choices, left) = others(&[places(2, 3, 3), places(3, 3, 3), places(2, 3, 3)]);
        let expected = vec![vec![Some(2), None, Some(2)], vec![Some(2), None, Some(3)], vec![Some(3), None, Some(2)]];
        assert_eq!((choices, left), (expected, 0));
        assert_eq!(others(&[places(2, 2, 2)]), (Vec::new(), 0));
    }

    #[test]
    fn no_more_choices_are_searched_than_the_limit() {
        let poses: Vec<BandCounts> = (0..9).map(|_| places(1, 2, 3)).collect();
        let (choices, left) = others(&poses);
        // 1 or 3 everywhere, and 1 or 3 at each pose alone.
        assert_eq!((choices.len(), left), (MAX_OTHERS, 2 + 18 - MAX_OTHERS));
        assert!(choices[0].iter().all(|number| *number == Some(1)));
    }
}

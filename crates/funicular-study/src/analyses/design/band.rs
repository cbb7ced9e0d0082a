//! Sides of the band to avoid to which the natural frequencies of every pose go.

use serde::Serialize;

/// Maximum number of choices that are searched besides the nearer sides: each is a search of its own.
const MAX_OTHERS: usize = 6;

/// Number of natural frequencies of every pose that go below the band, the others above it; `None` for a pose where each goes
/// to its nearer side, and no entries if all poses are so.
pub(crate) type Sides = Vec<Option<usize>>;

/// Natural frequencies of a pose by their places, counted from the lowest one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Places {
    /// Number of those below the band, …
    pub(crate) below: usize,
    /// … below its middle, …
    pub(crate) nearer_below: usize,
    /// … and of those that are not above the band.
    pub(crate) not_above: usize,
}

impl Places {
    fn in_band(&self) -> bool {
        self.below < self.not_above
    }
}

/// Choice of the sides of a band, with what it led to.
#[derive(Debug, Clone, Serialize)]
pub struct SidesTried {
    /// Number of natural frequencies of each pose that were to be below the band.
    pub below: Vec<usize>,
    /// Value of the goal; none if some demand was not met.
    pub after: Option<f64>,
    /// True for the choice of the result.
    pub is_chosen: bool,
}

/// Choices besides the nearer sides, for the frequencies that are in the band at the start, and how many more there are.
///
/// Frequencies keep their order, so a choice is a number of them below the band for every pose. First come choices with the
/// same number at all poses, as far as their frequencies in the band allow: a mode has much the same order at neighbouring
/// poses. Then come choices that differ from the nearer sides at a single pose. Of each kind, those that send fewer
/// frequencies to their farther side are first.
pub(crate) fn others(poses: &[Places]) -> (Vec<Sides>, usize) {
    let nearer: Sides = poses.iter().map(|of| of.in_band().then_some(of.nearer_below)).collect();
    let moved = |sides: &Sides| -> usize {
        sides.iter().zip(&nearer).filter_map(|(one, other)| Some(one.as_ref()?.abs_diff((*other)?))).sum()
    };
    let concerned = || poses.iter().filter(|of| of.in_band());
    let fewest = concerned().map(|of| of.below).min().unwrap_or(0);
    let most = concerned().map(|of| of.not_above).max().unwrap_or(0);

    // Every way of asking gives this number.
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

    fn places(below: usize, nearer_below: usize, not_above: usize) -> Places {
        Places { below, nearer_below, not_above }
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
        let poses: Vec<Places> = (0..9).map(|_| places(1, 2, 3)).collect();
        let (choices, left) = others(&poses);
        // 1 or 3 everywhere, and 1 or 3 at each pose alone.
        assert_eq!((choices.len(), left), (MAX_OTHERS, 2 + 18 - MAX_OTHERS));
        assert!(choices[0].iter().all(|number| *number == Some(1)));
    }
}

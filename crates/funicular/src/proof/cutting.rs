//! Linear program with far more rows than unknowns: rows are asked for one by one, the most violated first.

/// Row `g·x ≤ h`.
pub(super) struct LinearCut {
    pub(super) row: Vec<f64>,
    pub(super) limit: f64,
}

/// Largest number of rows that are exchanged: three times what boxes of six coordinates needed.
const MAX_EXCHANGES: usize = 400;

/// Unknowns with the largest last one, among those within a bound by which all rows hold that `next` knows; or the best
/// so far, after many exchanges. `None` if the last one is at most `enough`. Dual simplex method: it begins at a corner
/// of the bounds, and every row that is added makes the last unknown smaller.
///
/// `next` writes the row that the unknowns violate most, and returns false if they violate none.
pub(super) fn largest_last(
    bounds: &[f64],
    enough: f64,
    mut next: impl FnMut(&[f64], &mut LinearCut) -> bool,
) -> Option<Vec<f64>> {
    let d = bounds.len();
    let mut x = bounds.to_vec();
    // Inverse of the matrix of the rows that hold as equations, by rows, and their multipliers.
    let mut inverse: Vec<Vec<f64>> = (0..d).map(|i| (0..d).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    let mut multipliers: Vec<f64> = (0..d).map(|i| f64::from(u8::from(i + 1 == d))).collect();
    let mut cut = LinearCut { row: vec![0.0; d], limit: 0.0 };
    let mut combination = vec![0.0; d];

    for _ in 0..MAX_EXCHANGES {
        if x[d - 1] <= enough {
            return None;
        }
        if !next(&x, &mut cut) {
            break;
        }
        let beyond = cut.row.iter().zip(&x).map(|(g, x)| g * x).sum::<f64>() - cut.limit;
        combination.fill(0.0);
        for (g, row) in cut.row.iter().zip(&inverse) {
            combination.iter_mut().zip(row).for_each(|(w, of)| *w += g * of);
        }

        // The row that leaves: its multiplier is the first to become zero.
        let mut leaving = None;
        for (k, w) in combination.iter().enumerate().filter(|(_, w)| **w > 1e-11) {
            let ratio = multipliers[k] / w;
            let is_first = leaving.is_none_or(|(other, least): (usize, f64)| {
                ratio < least - 1e-14 || (ratio <= least + 1e-14 && *w > combination[other])
            });
            if is_first {
                leaving = Some((k, ratio.max(0.0)));
            }
        }
        let Some((k, ratio)) = leaving else { break };
        multipliers.iter_mut().zip(&combination).for_each(|(of, w)| *of -= ratio * w);
        multipliers[k] = ratio;
        let pivot = combination[k];
        for (row, x) in inverse.iter_mut().zip(&mut x) {
            let along = row[k] / pivot;
            *x -= along * beyond;
            row.iter_mut().zip(&combination).for_each(|(of, w)| *of -= along * w);
            row[k] = along;
        }
    }
    (x[d - 1] > enough).then_some(x)
}

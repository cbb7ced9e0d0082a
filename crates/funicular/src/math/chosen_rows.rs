//! Choice of further rows of least squares that reduce a covariance most, one after the other.

use super::DMat;

/// Quantity that the chosen rows make small.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum RowCriterion {
    /// Weighted sum of the variances.
    #[default]
    Variances,
    /// Determinant of the covariance, which does not depend on units.
    Determinant,
}

/// Row that was chosen.
#[derive(Debug, Clone)]
pub struct ChosenRows {
    /// Index of the candidate.
    pub candidate: usize,
    /// Covariance with these rows and those chosen before.
    pub covariance: DMat,
}

/// Chooses candidates one after the other, each so that the criterion falls most (96k). `covariance` S is that without
/// them; each candidate has rows W over the same unknowns, in their deviations, or `None` if it cannot be measured;
/// `weight` is the symmetric matrix of the weighted sum of variances, trace of `weight · S`. A candidate can be chosen
/// several times.
///
/// # Example
/// ```
/// use funicular::math::{DMat, chosen_rows::{RowCriterion, choose_rows}};
///
/// // Two unknowns with variances 4 and 1; the first candidate measures the sum, the second one the first of them.
/// let mut covariance = DMat::identity(2, 2);
/// covariance[(0, 0)] = 4.0;
/// let rows = [Some(DMat::from_row_slice(1, 2, &[1.0, 1.0])), Some(DMat::from_row_slice(1, 2, &[1.0, 0.0]))];
/// let chosen = choose_rows(&covariance, &DMat::identity(2, 2), &rows, 1, RowCriterion::Variances);
/// assert_eq!(chosen[0].candidate, 1);
/// assert!((chosen[0].covariance[(0, 0)] - 0.8).abs() < 1e-14); // 1 / (1/4 + 1)
/// ```
///
/// # References
/// docs/theory.md, equation (96k).
pub fn choose_rows(
    covariance: &DMat,
    weight: &DMat,
    candidates: &[Option<DMat>],
    count: usize,
    criterion: RowCriterion,
) -> Vec<ChosenRows> {
    let mut covariance = covariance.clone();
    let mut chosen = Vec::new();
    for _ in 0..count {
        let gain = |(k, rows): (usize, &Option<DMat>)| {
            let gain = match criterion {
                RowCriterion::Variances => fall_of_variances(&covariance, weight, rows.as_ref()?)?,
                RowCriterion::Determinant => fall_of_determinant(&covariance, rows.as_ref()?)?,
            };
            gain.is_finite().then_some((k, gain))
        };
        let best = candidates.iter().enumerate().filter_map(gain).max_by(|a, b| a.1.total_cmp(&b.1));
        let Some((candidate, _)) = best else { break };
        let Some(next) = candidates[candidate].as_ref().and_then(|rows| with_rows(&covariance, rows)) else { break };
        covariance = next;
        chosen.push(ChosenRows { candidate, covariance: covariance.clone() });
    }
    chosen
}

/// `I + W S Wᵀ` with `S Wᵀ`.
fn seen_by(covariance: &DMat, rows: &DMat) -> (DMat, DMat) {
    let seen = covariance * rows.transpose();
    (DMat::identity(rows.nrows(), rows.nrows()) + rows * &seen, seen)
}

/// Decrease of the weighted sum of variances: trace of `(I + W S Wᵀ)⁻¹ W S w S Wᵀ`.
fn fall_of_variances(covariance: &DMat, weight: &DMat, rows: &DMat) -> Option<f64> {
    let (inner, seen) = seen_by(covariance, rows);
    let solved = inner.cholesky()?.solve(&seen.transpose());
    Some((solved * weight * seen).trace())
}

/// Decrease of the logarithm of the determinant: that of `I + W S Wᵀ`.
fn fall_of_determinant(covariance: &DMat, rows: &DMat) -> Option<f64> {
    let factor = seen_by(covariance, rows).0.cholesky()?;
    Some(2.0 * factor.l_dirty().diagonal().iter().map(|entry| entry.ln()).sum::<f64>())
}

/// Covariance with further rows.
fn with_rows(covariance: &DMat, rows: &DMat) -> Option<DMat> {
    let (inner, seen) = seen_by(covariance, rows);
    let solved = inner.cholesky()?.solve(&seen.transpose());
    Some(covariance - seen * solved)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The information matrix `S⁻¹ + Σ WᵀW` inverted, another way to the same covariance; and its criteria tell the
    /// best.
    #[test]
    fn chosen_rows_are_the_best_of_all_by_the_information_matrix() {
        let entry = |k: usize| ((k * 7919 + 13) % 101) as f64 / 50.0 - 1.0;
        let information = DMat::from_fn(6, 4, |i, j| entry(4 * i + j));
        let information = information.transpose() * &information + DMat::identity(4, 4) * 0.01;
        let covariance = information.clone().try_inverse().unwrap();
        let candidates: Vec<Option<DMat>> =
            (0..9).map(|c| (c != 4).then(|| DMat::from_fn(2, 4, |i, j| entry(100 + 8 * c + 4 * i + j)))).collect();
        let weight = DMat::from_diagonal(&super::super::DVec::from_vec(vec![1.0, 0.0, 2.0, 1.0]));
        for criterion in [RowCriterion::Variances, RowCriterion::Determinant] {
            let chosen = choose_rows(&covariance, &weight, &candidates, 3, criterion);
            let mut information = information.clone();
            for choice in &chosen {
                let after = |rows: &DMat| (&information + rows.transpose() * rows).try_inverse().unwrap();
                let measure = |covariance: &DMat| match criterion {
                    RowCriterion::Variances => (&weight * covariance).trace(),
                    RowCriterion::Determinant => covariance.determinant(),
                };
                let best = candidates.iter().flatten().map(|rows| measure(&after(rows))).fold(f64::INFINITY, f64::min);
                let rows = candidates[choice.candidate].as_ref().unwrap();
                // Rounding of two inversions.
                assert!((measure(&choice.covariance) / best - 1.0).abs() < 1e-9);
                assert!((&choice.covariance - after(rows)).amax() < 1e-9 * covariance.amax());
                information += rows.transpose() * rows;
            }
        }
    }
}

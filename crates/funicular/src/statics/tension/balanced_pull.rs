//! Tensions that balance each other without a load, as nearly equal as they can be.

use super::feasible_set::FeasibleSet;
use super::null_space::Solutions;
use crate::math::Vec6;

/// Rounding of the ratio of two tensions.
const ROUNDING: f64 = 1e-13;

/// Largest ratio of the minimum to the maximum tension of tensions that balance each other, from 0 to 1; zero if there
/// are none. `columns` are the reduced wrenches per unit tension.
///
/// # References
/// docs/theory.md, equation (40f): one linear problem, largest s with `W t = 0` and `s ≤ t_i ≤ 1`.
pub(in crate::statics) fn balanced_pull(columns: &[Vec6], dof: usize) -> f64 {
    let count = columns.len();
    let Some(solutions) = Solutions::of(columns, &vec![1.0; count], &Vec6::zeros(), dof, true) else { return 0.0 };
    let mut feasible = FeasibleSet::new(&solutions, true);
    for i in 0..count {
        feasible.add(Some(i), 1.0, -1.0, 0.0);
        feasible.add(Some(i), -1.0, 0.0, -1.0);
    }
    let found = feasible.highest(|_| 0.0, ROUNDING);
    found.map_or(0.0, |found| found.height.clamp(0.0, 1.0))
}

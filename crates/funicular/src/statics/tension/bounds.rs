//! Bounds of tensions within limits, for many cables.
//!
//! Every inequality bounds one tension (and a height common to all), so nothing of the size of the null space is
//! needed. The active-set method needs projections only, and a projection on the balance of the free tensions is a
//! system with as many equations as degrees of freedom. A step costs time in proportion to the number of cables; with a
//! basis of the null space a step costs its square, and a dropped inequality its cube. Theory, equations (40a) and
//! (40b).

use super::null_space::Solutions;
use crate::math::active_set::{ConstraintSet, DEPENDENT, Magnitude, NO_NORMAL, ROUNDING, worst};
use crate::math::{Mat6, Vec6, symmetric};

/// Inequalities `sign σ_i + lift t ≥ level` for tensions σ that satisfy the balance, and a height t.
pub(super) struct Bounds {
    /// Row of each cable in an orthonormal basis of the balance.
    balance: Vec<Vec6>,
    dof: usize,
    /// True if there is a height, the last component of a point.
    lifted: bool,
    rows: Vec<Row>,
    /// Active rows.
    active: Vec<usize>,
    /// Index in `active` of the row that holds the tension of each cable, …
    holder: Vec<Option<usize>>,
    /// … and index of the one further row, which then holds the height.
    pin: Option<usize>,
    rest: Vec<f64>,
    shares: Vec<f64>,
    /// Product of the balance's basis with every solution.
    right: Vec6,
    /// Number of consecutive corrections of a point to the balance.
    restored: usize,
}

/// Free unknowns, and the inverse of the matrix (40b).
struct Free {
    /// True if the height is free.
    rises: bool,
    following: Vec6,
    weight: f64,
    inverse: Mat6,
}

/// Maximum number of consecutive corrections; each removes all but the rounding of the remainder.
const MAX_RESTORED: usize = 3;

#[derive(Debug, Clone, Copy)]
struct Row {
    /// None if only the height is bounded.
    cable: Option<usize>,
    sign: f64,
    lift: f64,
    level: f64,
}

impl Bounds {
    /// All tensions that satisfy the balance, with a height if `lifted`.
    pub(super) fn new(solutions: &Solutions, lifted: bool) -> Self {
        let (cables, dof) = (solutions.particular.len(), solutions.dof());
        let balance: Vec<Vec6> = (0..cables).map(|i| solutions.balance(i)).collect();
        let right = balance.iter().zip(&solutions.particular).map(|(balance, p)| balance * *p).sum();
        Self {
            balance,
            right,
            restored: 0,
            dof,
            lifted,
            rows: Vec::new(),
            active: Vec::new(),
            holder: vec![None; cables],
            pin: None,
            rest: vec![0.0; cables + usize::from(lifted)],
            shares: Vec::new(),
        }
    }

    /// Adds `sign σ_i + lift t ≥ level`, or without a cable `lift t ≥ level`.
    pub(super) fn add(&mut self, cable: Option<usize>, sign: f64, lift: f64, level: f64) {
        self.rows.push(Row { cable, sign, lift, level });
    }

    /// Records the active row `at` as a holder or as the pin.
    fn place(&mut self, at: usize) {
        match self.rows[self.active[at]].cable {
            Some(i) if self.holder[i].is_none() => self.holder[i] = Some(at),
            _ => self.pin = Some(at),
        }
    }

    /// Change of a held tension per unit of height.
    fn slope(&self, at: usize) -> f64 {
        let row = self.rows[self.active[at]];
        -row.lift * row.sign
    }

    /// Free unknowns: the tensions that are not held, and the height with all tensions that follow it.
    fn free(&self) -> Free {
        let rises = self.lifted && self.pin.is_none();
        let mut gram = Mat6::from_fn(|i, j| if i == j && i >= self.dof { 1.0 } else { 0.0 });
        let (mut following, mut weight) = (Vec6::zeros(), 1.0);
        for (balance, holder) in self.balance.iter().zip(&self.holder) {
            match holder {
                None => gram.ger(1.0, balance, balance, 1.0),
                Some(at) if rises => {
                    let slope = self.slope(*at);
                    following += balance * slope;
                    weight += slope * slope;
                }
                Some(_) => {}
            }
        }
        if rises {
            gram.ger(1.0 / weight, &following, &following, 1.0);
        }
        Free { rises, following, weight, inverse: inverse_of(&gram) }
    }

    /// Splits the vector with these components at one cable and at the height.
    fn split_vector(&mut self, cable: Option<usize>, sign: f64, lift: f64) -> bool {
        let cables = self.balance.len();
        let part = |i: usize| if cable == Some(i) { sign } else { 0.0 };

        let Free { rises, following, weight, inverse } = self.free();
        let held = cable.and_then(|i| self.holder[i]);
        let upward = lift + held.map_or(0.0, |at| self.slope(at) * sign);

        // Projection on the balance; repeated to remove the rounding of the first pass.
        let (mut multipliers, mut height) = (Vec6::zeros(), 0.0);
        for pass in 0..3 {
            height = if rises { (upward - following.dot(&multipliers)) / weight } else { 0.0 };
            let mut unbalanced = following * height;
            for i in 0..cables {
                self.rest[i] = match self.holder[i] {
                    None => {
                        let rest = part(i) - self.balance[i].dot(&multipliers);
                        unbalanced += self.balance[i] * rest;
                        rest
                    }
                    Some(at) if rises => self.slope(at) * height,
                    Some(_) => 0.0,
                };
            }
            if pass < 2 {
                multipliers += inverse * unbalanced;
            }
        }
        if self.lifted {
            self.rest[cables] = height;
        }

        self.share(part, &multipliers, lift - height);

        // Check for a part outside.
        let reach = cable.map_or(0.0, |i| (1.0 - self.balance[i].norm_squared()).max(0.0));
        let size = (reach + lift * lift).sqrt();
        let length = self.rest.iter().map(|x| x * x).sum::<f64>().sqrt();
        let outside = size > NO_NORMAL && length > DEPENDENT * size && self.active.len() < self.dimension();
        if !outside {
            self.rest.fill(0.0);
        }
        outside
    }

    /// Shares of the active rows in the remainder of a vector with the components `part`: cable by cable, and of the
    /// pin for the rest `lacking` of the height.
    #[inline]
    fn share(&mut self, part: impl Fn(usize) -> f64, multipliers: &Vec6, mut lacking: f64) {
        self.shares.clear();
        self.shares.resize(self.active.len(), 0.0);
        for i in 0..self.balance.len() {
            if let Some(at) = self.holder[i] {
                let row = self.rows[self.active[at]];
                self.shares[at] = row.sign * (part(i) - self.rest[i] - self.balance[i].dot(multipliers));
                lacking -= row.lift * self.shares[at];
            }
        }

        if let Some(at) = self.pin {
            let pin = self.rows[self.active[at]];
            // On a cable held by another row, the pin takes over a part of it.
            let holder = pin.cable.and_then(|i| self.holder[i]);
            let exchange = holder.map_or(0.0, |at| pin.sign * self.rows[self.active[at]].sign);
            let by_holder = holder.map_or(0.0, |at| self.rows[self.active[at]].lift);
            let share = lacking / (pin.lift - exchange * by_holder);
            self.shares[at] = share;
            if let Some(at) = holder {
                self.shares[at] -= exchange * share;
            }
        }
    }
}

impl ConstraintSet for Bounds {
    fn dimension(&self) -> usize {
        self.balance.len() - self.dof + usize::from(self.lifted)
    }

    fn most_violated<M: Magnitude>(&self, x: &[M], tolerance: f64) -> Option<(usize, M)> {
        let height = if self.lifted { x[self.balance.len()] } else { M::ZERO };
        worst(self.rows.iter().map(|row| {
            let tension = row.cable.map(|i| (row.sign, x[i]));
            let height = self.lifted.then_some((row.lift, height));
            M::lack(tension.into_iter().chain(height), row.level, tolerance)
        }))
    }

    fn split(&mut self, row: usize) -> bool {
        let Row { cable, sign, lift, .. } = self.rows[row];
        self.split_vector(cable, sign, lift)
    }

    fn split_vertical(&mut self) {
        self.split_vector(None, 0.0, 1.0);
    }

    fn rest(&self) -> &[f64] {
        &self.rest
    }

    fn shares(&self) -> &[f64] {
        &self.shares
    }

    /// Long steps move a point off the balance by their rounding, and the height follows with the multipliers of the
    /// balance, which may be large. All is corrected but the rounding of the point itself.
    fn restore<M: Magnitude>(&mut self, x: &mut [M]) -> bool {
        let cables = self.balance.len();
        let rounding = x.iter().fold(0.0, |most: f64, x| most.max(ROUNDING * x.near().abs()));
        let mut lacking = self.right;
        for (balance, x) in self.balance.iter().zip(&*x) {
            lacking -= balance * x.near();
        }
        if self.restored >= MAX_RESTORED || lacking.amax() <= rounding || lacking.amax().is_nan() {
            return false;
        }
        self.restored += 1;

        // Smallest correcting motion along the active inequalities.
        let Free { rises, following, weight, inverse } = self.free();
        let multipliers = inverse * lacking;
        let height = if rises { following.dot(&multipliers) / weight } else { 0.0 };
        for (i, x) in x.iter_mut().take(cables).enumerate() {
            let change = match self.holder[i] {
                None => self.balance[i].dot(&multipliers),
                Some(at) => self.slope(at) * height,
            };
            *x = x.plus_near(change);
        }
        if self.lifted {
            x[cables] = x[cables].plus_near(height);
        }
        true
    }

    fn hold(&mut self, row: usize) {
        self.restored = 0;
        self.active.push(row);
        self.place(self.active.len() - 1);
    }

    fn release(&mut self, at: usize) {
        self.active.remove(at);
        self.holder.fill(None);
        self.pin = None;
        for at in 0..self.active.len() {
            self.place(at);
        }
    }
}

/// Inverse of a positive matrix; if rounding has made it singular, the inverse of its regular part.
fn inverse_of(matrix: &Mat6) -> Mat6 {
    if let Some(factor) = matrix.cholesky() {
        return factor.inverse();
    }
    let (values, vectors) = symmetric::eigen(matrix, 6);
    let zero = f64::EPSILON * values.iter().fold(0.0, |most: f64, value| most.max(*value));
    let parts = values.iter().zip(&vectors).filter(|(value, _)| **value > zero);
    parts.map(|(value, vector)| vector * (vector.transpose() / *value)).sum()
}

#[cfg(test)]
mod tests {
    use super::super::feasible_set::{FeasiblePoint, FeasibleSet};
    use super::super::null_space::Solutions;
    use crate::math::Vec6;
    use proptest::prelude::*;

    /// Bounds of one cable: lower bound, width, the rates at which both approach with the height, and the depth of a
    /// floor that stays.
    type CableBounds = (f64, f64, f64, f64, f64);

    fn solutions(columns: &[[f64; 6]], right: &[f64; 6], dof: usize, directions: bool) -> Option<Solutions> {
        let columns: Vec<Vec6> = columns.iter().map(|column| Vec6::from_column_slice(column)).collect();
        Solutions::of(&columns, &vec![1.0; columns.len()], &Vec6::from_column_slice(right), dof, directions)
    }

    /// Bounds of tensions with a height as the rules build them: with floors, and a ceiling of the height.
    fn room<'a>(solutions: &'a Solutions, bounds: &[CableBounds], lifted: bool) -> FeasibleSet<'a> {
        let mut room = FeasibleSet::new(solutions, lifted);
        for (i, (lower, width, by_lower, by_upper, floor)) in bounds.iter().enumerate() {
            let lift = |by: &f64| if lifted { -by } else { 0.0 };
            room.add(Some(i), 1.0, lift(by_lower), *lower);
            room.add(Some(i), -1.0, lift(by_upper), -(lower + width));
            room.add(Some(i), 1.0, 0.0, lower - floor);
        }
        if lifted {
            room.add(None, 1.0, -1.0, -0.2);
        }
        room
    }

    /// Compares the results of the method in the null space and of the one in the space of the cables.
    fn compare(
        few: Option<FeasiblePoint>,
        many: Option<FeasiblePoint>,
        start: &[f64],
        height: Option<f64>,
    ) -> Result<(), TestCaseError> {
        prop_assert_eq!(few.is_some(), many.is_some());
        let (Some(few), Some(many)) = (few, many) else { return Ok(()) };
        let size = 1.0 + few.height.abs();
        let Some(height) = height else {
            // The optimum is promised to a millionth. Observed: mostly 1e-12; with nearly level edges either way may
            // end at a corner beside the highest, up to 1e-7 below it. Rounding decides which of equally high points is
            // taken.
            prop_assert!((few.height - many.height).abs() < 1e-6 * size, "{} {}", few.height, many.height);
            return Ok(());
        };
        prop_assert!((few.height - many.height).abs() < 1e-9 * size, "{} {}", few.height, many.height);
        let distance = |found: &FeasiblePoint| {
            let cables: f64 = found.sigma.iter().zip(start).map(|(a, b)| (a - b) * (a - b)).sum();
            (cables + (found.height - height) * (found.height - height)).sqrt()
        };
        prop_assert!((distance(&many) - distance(&few)).abs() < 1e-9 * size, "{} {}", distance(&few), distance(&many));

        // The active inequalities of the nearest point agree.
        let multipliers = |found: &FeasiblePoint| {
            let mut sum = std::collections::BTreeMap::new();
            for held in found.held.iter().filter(|held| held.multiplier > 1e-7) {
                *sum.entry(held.row).or_insert(0.0) += held.multiplier;
            }
            sum
        };
        let (few, many) = (multipliers(&few), multipliers(&many));
        prop_assert!(few.keys().eq(many.keys()), "{few:?} {many:?}");
        prop_assert!(
            few.values().zip(many.values()).all(|(a, b)| (a - b).abs() < 1e-6 * (1.0 + a)),
            "{few:?} {many:?}"
        );
        Ok(())
    }

    /// Checks all bounds and the balance.
    fn check(
        found: Option<&FeasiblePoint>,
        columns: &[[f64; 6]],
        right: &[f64],
        bounds: &[CableBounds],
        lifted: bool,
    ) -> Result<(), TestCaseError> {
        let Some(FeasiblePoint { sigma, height, .. }) = found else { return Ok(()) };
        for (k, right) in right.iter().enumerate() {
            let sum: f64 = columns.iter().zip(sigma).map(|(column, sigma)| column[k] * sigma).sum();
            prop_assert!((sum - right).abs() < 1e-10, "{sum} for {right}");
        }
        for (sigma, (lower, width, by_lower, by_upper, floor)) in sigma.iter().zip(bounds) {
            let lift = |by: &f64| if lifted { by * height } else { 0.0 };
            prop_assert!(*sigma >= lower + lift(by_lower) - 1e-10, "{sigma} {height}");
            prop_assert!(*sigma <= lower + width - lift(by_upper) + 1e-10, "{sigma} {height}");
            prop_assert!(*sigma >= lower - floor - 1e-10, "{sigma} {height}");
        }
        Ok(())
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, ..Default::default() })]

        /// Oracle: the method in the null space, whose directions are formed. Bounds of all widths, so that some
        /// problems have no solution.
        #[test]
        fn in_the_space_of_the_cables_the_same_point_is_found_as_in_the_null_space(
            columns in prop::collection::vec(prop::array::uniform6(-1.0f64..1.0), 24),
            bounds in prop::collection::vec(
                (-1.0f64..0.2, 0.3f64..2.0, 0.5f64..2.0, 0.5f64..2.0, -0.1f64..0.4), 24),
            right in prop::array::uniform6(-6.0f64..6.0),
            start in prop::collection::vec(-3.0f64..3.0, 24),
            count in 8usize..24,
            dof in prop::sample::select(vec![3usize, 6]),
        ) {
            let (columns, bounds) = (&columns[..count], &bounds[..count]);
            let few = solutions(columns, &right, dof, true);
            let many = solutions(columns, &right, dof, false);
            prop_assert_eq!(few.is_some(), many.is_some());
            let (Some(few), Some(many)) = (few, many) else { return Ok(()) };
            let start_at = |i: usize| start[i];
            let right = &right[..dof];
            let nearest = |all| room(all, bounds, false).nearest(start_at, 0.0, 1e-12);
            let highest = |all| room(all, bounds, true).highest(start_at, 1e-12);
            let climbing = |all| room(all, bounds, true).nearest(start_at, 0.1, 1e-12);
            check(nearest(&many).as_ref(), columns, right, bounds, false)?;
            check(highest(&many).as_ref(), columns, right, bounds, true)?;
            check(climbing(&many).as_ref(), columns, right, bounds, true)?;
            compare(nearest(&few), nearest(&many), &start, Some(0.0))?;
            compare(highest(&few), highest(&many), &start, None)?;

            compare(climbing(&few), climbing(&many), &start, Some(0.1))?;
        }
    }
}

//! Nearest point of a polyhedron to a given one, and with it the highest point of a polyhedron.

mod dense;
mod magnitude;

use dense::Dense;
use magnitude::TwoMagnitudes;

pub(crate) use magnitude::Magnitude;

/// Polyhedron of inequalities `normal · x ≥ level` in few unknowns.
#[derive(Debug, Default)]
pub(crate) struct Polyhedron {
    dimension: usize,
    normals: Vec<f64>,
    levels: Vec<f64>,
}

/// Active inequality at the nearest point, with its multiplier.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Active<M = f64> {
    /// Number of the inequality, in the order of addition.
    pub row: usize,
    /// Multiplier, not negative.
    pub multiplier: M,
}

/// Component of a normal, made of columns of an orthogonal matrix, below which it is rounding. A normal with only such
/// components is zero: the unknowns do not affect the quantity.
pub(crate) const NO_NORMAL: f64 = 1e-12;

/// Rounding of a violation, relative to the sum of the magnitudes of its terms.
pub(crate) const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Relative length of the component outside the span of the active normals below which a normal counts as dependent.
pub(crate) const DEPENDENT: f64 = 1e-10;

impl Polyhedron {
    /// Complete space of this dimension.
    pub(crate) fn new(dimension: usize) -> Self {
        Self { dimension, ..Self::default() }
    }

    /// Number of inequalities.
    pub(crate) fn len(&self) -> usize {
        self.levels.len()
    }

    fn normal(&self, row: usize) -> &[f64] {
        &self.normals[row * self.dimension..(row + 1) * self.dimension]
    }

    /// Adds `normal · x ≥ level`. The normal has the given components times `sign`, and then the component `last`.
    pub(crate) fn add<'a>(&mut self, normal: impl Iterator<Item = &'a f64>, sign: f64, last: Option<f64>, level: f64) {
        let from = self.normals.len();
        self.normals.extend(normal.map(|x| sign * x).chain(last));
        assert_eq!(self.normals.len() - from, self.dimension);
        if self.normals[from..].iter().all(|x| x.abs() < NO_NORMAL) {
            self.normals[from..].fill(0.0);
        }
        self.levels.push(level);
    }

    /// Moves `x` to the nearest point that satisfies all inequalities, see [`nearest`].
    pub(crate) fn nearest(&self, x: &mut [f64], tolerance: f64) -> Option<Vec<Active>> {
        nearest(&mut Dense::of(self), x, tolerance)
    }

    /// Moves `x` to a point with the maximum last component, see [`highest`].
    pub(crate) fn highest(&self, x: &mut [f64], tolerance: f64) -> Option<Vec<Active>> {
        highest(&mut Dense::of(self), x, tolerance)
    }
}

/// Inequalities with their active subset: the interface of the active-set method.
pub(crate) trait ConstraintSet {
    /// Number of independent directions in which a point may move.
    fn dimension(&self) -> usize;

    /// Inequality with the largest violation above `tolerance` and rounding, and this violation.
    fn most_violated<M: Magnitude>(&self, x: &[M], tolerance: f64) -> Option<(usize, M)>;

    /// Splits the normal of an inequality into its parts inside and outside the span of the active ones; true if there
    /// is a part outside.
    fn split(&mut self, row: usize) -> bool;

    /// Splits the last unit vector in the same way.
    fn split_vertical(&mut self);

    /// Outside part of the normal that was split last.
    fn rest(&self) -> &[f64];

    /// Coefficients of the active normals in the inside part of this normal.
    fn shares(&self) -> &[f64];

    /// Makes the inequality active whose normal was split last.
    fn hold(&mut self, row: usize);

    /// Drops the active inequality at this index of their list.
    fn release(&mut self, at: usize);

    /// Moves a point back to where the constraints allow it, if rounding has moved it; true if that was necessary.
    fn restore<M: Magnitude>(&mut self, x: &mut [M]) -> bool;
}

/// Moves `x` to the nearest point at which no inequality is violated by more than `tolerance` and rounding. Returns the
/// active inequalities; `None` if there is no such point.
pub(crate) fn nearest(constraints: &mut impl ConstraintSet, x: &mut [f64], tolerance: f64) -> Option<Vec<Active>> {
    let tolerance = tolerance.max(rounding(x));
    approach(constraints, x, tolerance)
}

/// Moves `x` to a point with the maximum last component; of all these to the one nearest to the original `x`. Returns
/// the inequalities that limit it (the solution of the dual linear problem; inequalities only passed on the way have
/// zero multipliers). `None` if the polyhedron is empty or unbounded in this direction.
///
/// The result is the point nearest to one far above (Mangasarian and Meyer 1979), however far that has to be: see
/// [`TwoMagnitudes`].
pub(crate) fn highest(constraints: &mut impl ConstraintSet, x: &mut [f64], tolerance: f64) -> Option<Vec<Active>> {
    let mut point: Vec<TwoMagnitudes> = x.iter().map(|&near| TwoMagnitudes { far: 0.0, near }).collect();
    point.last_mut()?.far = 1.0;
    let held = approach(constraints, &mut point, tolerance.max(rounding(x)))?;
    if point.iter().any(|x| x.far != 0.0) {
        return None;
    }
    x.iter_mut().zip(&point).for_each(|(x, point)| *x = point.near);
    Some(held.into_iter().map(|Active { row, multiplier }| Active { row, multiplier: multiplier.far }).collect())
}

/// Dual active-set method of Goldfarb and Idnani (1983) for the identity. From the free optimum, the most violated
/// inequality is made active until none is violated. Each step raises the dual objective, so the method ends.
fn approach<W: ConstraintSet, M: Magnitude>(
    constraints: &mut W,
    x: &mut [M],
    tolerance: f64,
) -> Option<Vec<Active<M>>> {
    let mut active: Vec<Active<M>> = Vec::with_capacity(constraints.dimension() + 1);
    // Each pass makes an inequality active for good or drops some on the way; observed: at most 3 passes per unknown.
    for _ in 0..100 * (constraints.dimension() + 1) {
        // Find the most violated inequality.
        let Some((row, mut lack)) = constraints.most_violated(x, tolerance) else {
            if constraints.restore(x) {
                continue;
            }
            return Some(active);
        };

        // Move towards it, dropping inequalities that block the way.
        let mut multiplier = M::ZERO;
        loop {
            let free = constraints.split(row);
            let squared: f64 = constraints.rest().iter().map(|z| z * z).sum();

            // Step until the inequality is satisfied, or until a multiplier vanishes before.
            let full = free.then(|| lack / squared);
            let blocked =
                blocking(&active, constraints.shares()).filter(|(until, _)| full.is_none_or(|full| *until < full));
            let step = blocked.map(|(until, _)| until).or(full)?;

            // Take the step.
            for (held, share) in active.iter_mut().zip(constraints.shares()) {
                held.multiplier = held.multiplier.less(step * *share);
            }
            multiplier = multiplier + step;
            if free {
                x.iter_mut().zip(constraints.rest()).for_each(|(x, z)| *x = *x + step * *z);
                lack = lack - step * squared;
            }

            // The inequality is satisfied, or the blocking one is dropped.
            let Some((_, at)) = blocked else {
                constraints.hold(row);
                active.push(Active { row, multiplier });
                M::settle(x, constraints);
                break;
            };
            active.remove(at);
            constraints.release(at);
        }
    }
    None
}

/// Shortest step after which a multiplier vanishes, with the index of its inequality among the active ones.
#[inline]
fn blocking<M: Magnitude>(active: &[Active<M>], shares: &[f64]) -> Option<(M, usize)> {
    let mut blocking: Option<(M, usize)> = None;
    for (at, (held, share)) in active.iter().zip(shares).enumerate().filter(|(_, (_, share))| **share > 0.0) {
        let until = held.multiplier / *share;
        if blocking.is_none_or(|(first, _)| until < first) {
            blocking = Some((until, at));
        }
    }
    blocking
}

/// Rounding of the coordinates of the start, which no step removes.
fn rounding(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |most, x| most.max(ROUNDING * x.abs()))
}

/// Largest violation and its index; NaN comes before all others.
pub(crate) fn worst<M: Magnitude>(lacks: impl Iterator<Item = Option<M>>) -> Option<(usize, M)> {
    let mut worst: Option<(usize, M)> = None;
    for (row, lack) in lacks.enumerate() {
        if let Some(lack) = lack
            && worst.is_none_or(|(_, most)| most < lack || lack.is_nan())
        {
            worst = Some((row, lack));
        }
    }
    worst
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests;

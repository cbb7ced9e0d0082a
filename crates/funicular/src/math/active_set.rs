//! Nearest point of a polyhedron to a given one, and from it the highest point of a polyhedron.

use std::ops::{Add, Div, Mul, Sub};

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

/// Length of a normal, made of columns of an orthogonal matrix, below which it is rounding: the unknowns do not affect
/// the quantity.
pub(crate) const NO_NORMAL: f64 = 1e-12;

/// Rounding of a violation, relative to the terms that it is the difference of.
pub(crate) const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Relative length of the component outside the span of the active normals below which a normal counts as dependent.
pub(crate) const DEPENDENT: f64 = 1e-10;

/// Relative rounding of slopes and of parts of multipliers.
const FLAT: f64 = 1e-14;

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

    /// Adds `normal · x ≥ level`; the normal is given as components times `sign` and a last component.
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

    /// Outside part of the normal that was split last, …
    fn rest(&self) -> &[f64];

    /// … and the coefficients of the active normals in its inside part.
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

            // Step until a multiplier vanishes, and until the inequality is satisfied.
            let mut blocking: Option<(M, usize)> = None;
            for (at, (held, share)) in active.iter().zip(constraints.shares()).enumerate() {
                if *share > 0.0 {
                    let until = held.multiplier / *share;
                    if blocking.is_none_or(|(first, _)| until < first) {
                        blocking = Some((until, at));
                    }
                }
            }

            let full = free.then(|| lack / squared);
            let blocked = blocking.filter(|(until, _)| full.is_none_or(|full| *until < full));
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

/// Rounding of a point at the start, which stays.
fn rounding(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |most, x| most.max(ROUNDING * x.abs()))
}

/// Number type of coordinates, violations and multipliers: plain numbers, or numbers of two magnitudes.
pub(crate) trait Magnitude:
    Copy + PartialOrd + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self> + Div<f64, Output = Self>
{
    const ZERO: Self;

    /// Violation: the amount by which the sum of terms, factor times coordinate, is below `level`, if it is more than
    /// `tolerance` and rounding, or NaN: then there is no such point.
    fn lack(terms: impl Iterator<Item = (f64, Self)>, level: f64, tolerance: f64) -> Option<Self>;

    /// Multiplier reduced by `by`, at least zero.
    fn less(self, by: Self) -> Self;

    fn is_nan(&self) -> bool;

    /// The number itself, or the smaller part of two magnitudes.
    fn near(self) -> f64;

    /// Adds a number to this part.
    fn plus_near(self, by: f64) -> Self;

    /// Removes rounding from a point that lies on all active inequalities.
    fn settle(x: &mut [Self], constraints: &mut impl ConstraintSet);
}

impl Magnitude for f64 {
    const ZERO: Self = 0.0;

    fn lack(terms: impl Iterator<Item = (f64, Self)>, level: f64, tolerance: f64) -> Option<Self> {
        let (mut lack, mut size) = (level, level.abs());
        for (a, x) in terms {
            lack -= a * x;
            size += (a * x).abs();
        }
        (lack > tolerance.max(ROUNDING * size) || lack.is_nan()).then_some(lack)
    }

    fn less(self, by: Self) -> Self {
        (self - by).max(0.0)
    }

    fn is_nan(&self) -> bool {
        Self::is_nan(*self)
    }

    fn near(self) -> f64 {
        self
    }

    fn plus_near(self, by: f64) -> Self {
        self + by
    }

    fn settle(_: &mut [Self], _: &mut impl ConstraintSet) {}
}

/// Number `far · L + near` with an L larger than every number: the far parts are compared first.
///
/// The highest point of a polyhedron is the point nearest to one high enough above. The necessary height depends on the
/// flattest edge, and so large a number would leave no digits to the others; so L stays a symbol.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub(crate) struct TwoMagnitudes {
    far: f64,
    near: f64,
}

impl Add for TwoMagnitudes {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { far: self.far + other.far, near: self.near + other.near }
    }
}

impl Sub for TwoMagnitudes {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self { far: self.far - other.far, near: self.near - other.near }
    }
}

impl Mul<f64> for TwoMagnitudes {
    type Output = Self;
    fn mul(self, by: f64) -> Self {
        Self { far: self.far * by, near: self.near * by }
    }
}

impl Div<f64> for TwoMagnitudes {
    type Output = Self;
    fn div(self, by: f64) -> Self {
        Self { far: self.far / by, near: self.near / by }
    }
}

impl Magnitude for TwoMagnitudes {
    const ZERO: Self = Self { far: 0.0, near: 0.0 };

    fn lack(terms: impl Iterator<Item = (f64, Self)>, level: f64, tolerance: f64) -> Option<Self> {
        let (mut lack, mut sizes) = (Self { far: 0.0, near: level }, Self { far: 0.0, near: level.abs() });
        for (a, x) in terms {
            lack = lack - x * a;
            // The far part was a unit vector at the start: its rounding stays that of one.
            sizes = sizes + Self { far: a.abs(), near: (a * x.near).abs() };
        }
        if lack.far.abs() <= FLAT * sizes.far {
            lack.far = 0.0;
        }
        let violated = lack.far > 0.0 || lack.far == 0.0 && lack.near > tolerance.max(ROUNDING * sizes.near);
        (violated || lack.is_nan()).then_some(lack)
    }

    fn less(self, by: Self) -> Self {
        let mut left = self - by;
        if left.far.abs() <= FLAT * self.far.abs() {
            left.far = 0.0;
        }
        if left < Self::ZERO { Self::ZERO } else { left }
    }

    fn is_nan(&self) -> bool {
        self.far.is_nan() || self.near.is_nan()
    }

    fn near(self) -> f64 {
        self.near
    }

    fn plus_near(self, by: f64) -> Self {
        Self { far: self.far, near: self.near + by }
    }

    /// The far part is the component of the vertical outside the span of the active normals.
    fn settle(x: &mut [Self], constraints: &mut impl ConstraintSet) {
        constraints.split_vertical();
        x.iter_mut().zip(constraints.rest()).for_each(|(x, rest)| x.far = *rest);
    }
}

/// Polyhedron with a basis of its active normals.
struct Dense<'a> {
    set: &'a Polyhedron,
    active: Vec<usize>,
    basis: Basis,
}

impl<'a> Dense<'a> {
    fn of(set: &'a Polyhedron) -> Self {
        Self { set, active: Vec::with_capacity(set.dimension + 1), basis: Basis::new(set.dimension) }
    }
}

impl ConstraintSet for Dense<'_> {
    fn dimension(&self) -> usize {
        self.set.dimension
    }

    fn most_violated<M: Magnitude>(&self, x: &[M], tolerance: f64) -> Option<(usize, M)> {
        worst(self.set.levels.iter().enumerate().map(|(row, level)| {
            let terms = self.set.normal(row).iter().copied().zip(x.iter().copied());
            M::lack(terms, *level, tolerance)
        }))
    }

    fn split(&mut self, row: usize) -> bool {
        self.basis.split(self.set.normal(row))
    }

    fn split_vertical(&mut self) {
        let mut vertical = vec![0.0; self.set.dimension];
        if let Some(last) = vertical.last_mut() {
            *last = 1.0;
        }
        self.basis.split(&vertical);
    }

    fn rest(&self) -> &[f64] {
        &self.basis.rest
    }

    fn shares(&self) -> &[f64] {
        &self.basis.shares
    }

    fn hold(&mut self, row: usize) {
        self.basis.push();
        self.active.push(row);
    }

    fn release(&mut self, at: usize) {
        self.active.remove(at);
        self.basis.rebuild(self.active.iter().map(|row| self.set.normal(*row)));
    }

    /// Every point of the space is allowed.
    fn restore<M: Magnitude>(&mut self, _: &mut [M]) -> bool {
        false
    }
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

/// Orthonormal basis of the active normals, and the triangle that expresses them in it.
struct Basis {
    dimension: usize,
    vectors: Vec<f64>,
    triangle: Vec<Vec<f64>>,
    /// Components of the last split normal along the basis, …
    along: Vec<f64>,
    /// … its outside part, …
    rest: Vec<f64>,
    /// … and the coefficients of the active normals in its inside part.
    shares: Vec<f64>,
}

impl Basis {
    fn new(dimension: usize) -> Self {
        let rest = vec![0.0; dimension];
        Self { dimension, vectors: Vec::new(), triangle: Vec::new(), along: Vec::new(), rest, shares: Vec::new() }
    }

    /// Splits a normal into its parts inside and outside the span of the active ones; true if there is a part outside.
    fn split(&mut self, normal: &[f64]) -> bool {
        let count = self.triangle.len();
        self.rest.copy_from_slice(normal);
        self.along.clear();
        self.along.resize(count, 0.0);
        let size = dot(normal, normal).sqrt();

        // Twice: the second pass removes the rounding of the first.
        for _ in 0..2 {
            for (k, vector) in self.vectors.chunks_exact(self.dimension).enumerate() {
                let part = dot(vector, &self.rest);
                self.along[k] += part;
                self.rest.iter_mut().zip(vector).for_each(|(rest, v)| *rest -= part * v);
            }
        }

        self.shares.clear();
        self.shares.extend_from_slice(&self.along);
        for k in (0..count).rev() {
            self.shares[k] /= self.triangle[k][k];
            let share = self.shares[k];
            for j in 0..k {
                self.shares[j] -= share * self.triangle[k][j];
            }
        }

        let outside = dot(&self.rest, &self.rest).sqrt() > DEPENDENT * size && count < self.dimension;
        if !outside {
            self.rest.fill(0.0);
        }
        outside
    }

    /// Adds the normal that was split last.
    fn push(&mut self) {
        let length = dot(&self.rest, &self.rest).sqrt();
        self.vectors.extend(self.rest.iter().map(|z| z / length));
        let mut column = std::mem::take(&mut self.along);
        column.push(length);
        self.triangle.push(column);
    }

    fn rebuild<'a>(&mut self, normals: impl Iterator<Item = &'a [f64]>) {
        self.vectors.clear();
        self.triangle.clear();
        for normal in normals {
            self.split(normal);
            self.push();
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn polyhedron(dimension: usize, rows: &[(Vec<f64>, f64)]) -> Polyhedron {
        let mut polyhedron = Polyhedron::new(dimension);
        for (normal, level) in rows {
            polyhedron.add(normal.iter(), 1.0, None, *level);
        }
        polyhedron
    }

    #[test]
    fn the_nearest_point_of_a_corner_is_the_corner() {
        let quadrant = polyhedron(2, &[(vec![1.0, 0.0], 1.0), (vec![0.0, 1.0], 2.0)]);
        let mut x = [-3.0, 0.0];
        let active = quadrant.nearest(&mut x, 1e-12).unwrap();
        assert!((x[0] - 1.0).abs() < 1e-15 && (x[1] - 2.0).abs() < 1e-15, "{x:?}");
        assert!((active.iter().map(|a| a.multiplier).sum::<f64>() - 6.0).abs() < 1e-14);
        let mut inside = [5.0, 5.0];
        assert_eq!(quadrant.nearest(&mut inside, 1e-12).unwrap(), []);
    }

    #[test]
    fn an_empty_polyhedron_has_no_point() {
        let empty = polyhedron(2, &[(vec![1.0, 1.0], 1.0), (vec![-1.0, -1.0], 0.0), (vec![1.0, 0.0], -9.0)]);
        assert!(empty.nearest(&mut [0.3, 8.0], 1e-12).is_none());
        let beyond_reach = polyhedron(1, &[(vec![1e-17], 1.0)]);
        assert!(beyond_reach.nearest(&mut [0.0], 1e-12).is_none());
    }

    /// Corner of three constraints that no number hits exactly, far from the origin.
    #[test]
    fn a_tolerance_below_the_rounding_of_the_levels_hides_no_point() {
        for i in 1..200 {
            let (x, y) = (60.0 / f64::from(i), -47.0 / f64::from(i + 1));
            let wall = |a: f64, b: f64| (vec![a, b], a * x + b * y);
            let constraints = [wall(0.3, 0.7), wall(-0.9, 0.1), wall(0.6, -0.8)];
            assert!(polyhedron(2, &constraints).nearest(&mut [0.0, 0.0], 1e-300).is_some(), "{constraints:?}");
        }
    }

    #[test]
    fn of_equally_high_points_the_nearest_is_taken() {
        // Roof with a level ridge: y ≤ 1, and a constraint x ≥ 3.
        let roof = polyhedron(2, &[(vec![0.0, -1.0], -1.0), (vec![1.0, 0.0], 3.0), (vec![-1.0, -0.001], -9.0)]);
        let mut x = [4.0, 0.0];
        roof.highest(&mut x, 1e-12).unwrap();
        assert!((x[0] - 4.0).abs() < 1e-9 && (x[1] - 1.0).abs() < 1e-12, "{x:?}");
    }

    type Rows = [(Vec<f64>, f64)];

    /// Point deepest inside of all constraints, or least outside; its depth (at most 1) is the last component.
    fn deepest(rows: &Rows, start: &[f64]) -> (Vec<f64>, Vec<Active>) {
        let mut lifted = Polyhedron::new(4);
        for (normal, level) in rows {
            lifted.add(normal.iter(), 1.0, Some(-1.0), *level);
        }
        lifted.add([0.0; 3].iter(), 1.0, Some(-1.0), -1.0);
        let mut point = [start, &[0.0]].concat();
        let held = lifted.highest(&mut point, 1e-12).unwrap();
        (point, held)
    }

    fn check_deepest(rows: &Rows, start: &[f64]) -> Result<(), TestCaseError> {
        let (point, held) = deepest(rows, start);
        let (x, depth) = (&point[..3], point[3]);
        let size = 1.0 + dot(x, x).sqrt();
        for (normal, level) in rows {
            prop_assert!(dot(normal, x) - depth >= level - 1e-10 * size, "{point:?}");
        }
        prop_assert!(depth <= 1.0 + 1e-12, "{point:?}");
        let mut balance = [0.0, 0.0, 0.0, 1.0];
        let total: f64 = held.iter().map(|held| held.multiplier).sum();
        prop_assert!((total - 1.0).abs() < 1e-9, "{held:?}");
        for held in held {
            prop_assert!(held.multiplier >= 0.0);
            balance[3] -= held.multiplier;
            let Some((normal, level)) = rows.get(held.row) else { continue };
            balance.iter_mut().zip(normal).for_each(|(b, a)| *b += held.multiplier * a);
            prop_assert!((dot(normal, x) - depth - level).abs() < 1e-9 * size, "{point:?}");
        }
        prop_assert!(balance.iter().all(|b| b.abs() < 1e-9), "{balance:?}");
        Ok(())
    }

    /// Edge that rises by 2e-6 over a length of 1. Corners by elimination in fractions: the upper one is (-0.108,
    /// -0.278, -0.486) at a depth of -0.114 641 518 089 681 27.
    #[test]
    #[expect(clippy::unreadable_literal, reason = "found by chance")]
    fn of_nearly_level_edges_the_higher_end_is_found() {
        let rows = [
            (vec![0.9413309181437038, -0.8639406653083862, 0.5194989338345024], 0.0),
            (vec![-0.8593923931211953, 0.33509511964269273, 0.23586161720763274], 0.0),
            (vec![-0.9757476174678755, 0.8580810771530126, 0.8871393169496077], -0.44921481569361793),
            (vec![0.08799948055057977, 0.09715565023731912, -0.2299596200531202], 0.18993859794459775),
            (vec![0.0, 0.0, -0.9171303545971431], 0.0),
        ];
        let (point, _) = deepest(&rows, &[0.0; 3]);
        let corner = [-0.10827657628128794, -0.2776140979462413, -0.4861598766716261, -0.11464151808968127];
        assert!(point.iter().zip(corner).all(|(x, c)| (x - c).abs() < 1e-12), "{point:?}");
    }

    #[test]
    fn where_there_is_no_highest_point_none_is_given() {
        let open = polyhedron(2, &[(vec![1.0, 0.0], 1.0), (vec![-1.0, -1e-7], -2.0)]);
        assert!(open.highest(&mut [1.5, 0.0], 1e-12).is_some_and(|held| held.len() == 2));
        let open = polyhedron(2, &[(vec![1.0, 0.0], 1.0), (vec![-1.0, 1e-7], -2.0)]);
        assert!(open.highest(&mut [1.5, 0.0], 1e-12).is_none());
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, ..Default::default() })]

        /// Optimality without a second solver: the point is inside, and the way back is a combination of active
        /// normals.
        #[test]
        fn the_nearest_point_satisfies_the_conditions_of_kuhn_and_tucker(
            rows in prop::collection::vec((prop::collection::vec(-1.0f64..1.0, 3), -1.0f64..0.5), 1..24),
            start in prop::collection::vec(-5.0f64..5.0, 3),
        ) {
            let set = polyhedron(3, &rows);
            let mut x = start.clone();
            if let Some(active) = set.nearest(&mut x, 1e-12) {
                let mut way: Vec<f64> = x.iter().zip(&start).map(|(x, s)| x - s).collect();
                for held in active {
                    let (normal, level) = &rows[held.row];
                    prop_assert!(held.multiplier >= 0.0);
                    prop_assert!((dot(normal, &x) - level).abs() < 1e-7);
                    way.iter_mut().zip(normal).for_each(|(way, a)| *way -= held.multiplier * a);
                }
                prop_assert!(way.iter().all(|w| w.abs() < 1e-7 * (1.0 + dot(&x, &x).sqrt())), "{way:?}");
                for (normal, level) in &rows {
                    prop_assert!(dot(normal, &x) >= level - 1e-10);
                }
            } else {
                // Farkas' lemma checked in another way: the minimum common violation is positive.
                let (point, _) = deepest(&rows, &start);
                prop_assert!(point[3] < 1e-9, "{point:?}");
            }
        }

        /// Optimality without a second solver: the point is inside, and the active constraints are satisfied with
        /// equality and balance the lift.
        #[test]
        fn the_highest_point_solves_the_linear_problem_and_its_dual(
            rows in prop::collection::vec((prop::collection::vec(-1.0f64..1.0, 3), -1.0f64..0.5), 1..24),
            start in prop::collection::vec(-5.0f64..5.0, 3),
        ) {
            check_deepest(&rows, &start)?;
        }

        /// Comparison with all corners, in the plane.
        #[test]
        fn the_highest_point_is_the_highest_corner(
            rows in prop::collection::vec((-1.0f64..1.0, 0.2f64..1.0, 0.0f64..3.0), 2..12),
        ) {
            // Roofs: every row bounds the height, and two constraints bound the width.
            let mut all: Vec<(Vec<f64>, f64)> =
                rows.iter().map(|(slope, down, level)| (vec![*slope, -down], -level)).collect();
            all.extend([(vec![1.0, 0.0], -4.0), (vec![-1.0, 0.0], -4.0)]);
            let mut best = f64::NEG_INFINITY;
            for i in 0..all.len() {
                for j in 0..i {
                    let ((a, p), (b, q)) = (&all[i], &all[j]);
                    let det = a[0] * b[1] - a[1] * b[0];
                    if det.abs() > 1e-9 {
                        let corner = [(p * b[1] - q * a[1]) / det, (a[0] * q - b[0] * p) / det];
                        if all.iter().all(|(n, level)| dot(n, &corner) >= level - 1e-9) {
                            best = best.max(corner[1]);
                        }
                    }
                }
            }
            let mut x = vec![0.5, -100.0];
            polyhedron(2, &all).highest(&mut x, 1e-12).unwrap();
            prop_assert!((x[1] - best).abs() < 1e-8, "{} {best}", x[1]);
        }
    }
}

//! The point of a polyhedron nearest to a given one; with it, the highest point of a polyhedron.

/// Inequalities `normal · x ≥ level`, few unknowns.
#[derive(Debug, Default)]
pub(super) struct Polyhedron {
    dimension: usize,
    normals: Vec<f64>,
    levels: Vec<f64>,
}

/// An inequality that holds the nearest point, and how hard it has to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Active {
    /// Its number, in the order in which it was added.
    pub row: usize,
    /// Multiplier, not negative.
    pub multiplier: f64,
}

/// Normals shorter than this, of columns of an orthogonal matrix, are rounding: the unknowns do not reach the quantity.
const NO_NORMAL: f64 = 1e-12;

/// Violation that is rounding, in parts of the terms that it is the difference of.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// A normal that the others make up to this part of its length adds nothing.
const DEPENDENT: f64 = 1e-10;

impl Polyhedron {
    /// Everything, in a space of this dimension.
    pub(super) fn new(dimension: usize) -> Self {
        Self { dimension, ..Self::default() }
    }

    /// Number of inequalities.
    pub(super) fn len(&self) -> usize {
        self.levels.len()
    }

    fn normal(&self, row: usize) -> &[f64] {
        &self.normals[row * self.dimension..(row + 1) * self.dimension]
    }

    /// Adds `normal · x ≥ level`; the normal may be given in parts.
    pub(super) fn add<'a>(&mut self, normal: impl Iterator<Item = &'a f64>, sign: f64, last: Option<f64>, level: f64) {
        let from = self.normals.len();
        self.normals.extend(normal.map(|x| sign * x).chain(last));
        debug_assert_eq!(self.normals.len() - from, self.dimension);
        if self.normals[from..].iter().all(|x| x.abs() < NO_NORMAL) {
            self.normals[from..].fill(0.0);
        }
        self.levels.push(level);
    }

    /// Moves `x` to the nearest point in which no inequality is violated by more than `tolerance` and rounding, and returns what
    /// holds it there; `None` if there is no such point.
    ///
    /// The dual active-set method of Goldfarb and Idnani (1983) for the identity: from the free optimum, the most
    /// violated inequality is made active until none is violated; each step raises the dual objective, so it ends.
    pub(super) fn nearest(&self, x: &mut [f64], tolerance: f64) -> Option<Vec<Active>> {
        // What the point has of rounding where it starts, it keeps.
        let tolerance = x.iter().fold(tolerance, |most, x| most.max(ROUNDING * x.abs()));
        let mut active: Vec<Active> = Vec::with_capacity(self.dimension + 1);
        let mut basis = Basis::new(self.dimension);
        // Each pass makes an inequality active for good or drops some on the way; seen: at most 3 per unknown.
        for _ in 0..100 * (self.dimension + 1) {
            let Some((row, mut lack)) = self.most_violated(x, tolerance) else { return Some(active) };
            let normal = self.normal(row);
            let mut multiplier = 0.0;
            loop {
                let free = basis.split(normal);
                let squared: f64 = basis.rest.iter().map(|z| z * z).sum();
                // How far until a multiplier vanishes, and until the inequality holds.
                let mut blocking = (f64::INFINITY, 0);
                for (at, held) in active.iter().enumerate() {
                    if basis.shares[at] > 0.0 && held.multiplier < blocking.0 * basis.shares[at] {
                        blocking = (held.multiplier / basis.shares[at], at);
                    }
                }
                let full = if free { lack / squared } else { f64::INFINITY };
                let step = full.min(blocking.0);
                if step == f64::INFINITY {
                    return None;
                }
                for (held, share) in active.iter_mut().zip(&basis.shares) {
                    held.multiplier = (held.multiplier - step * share).max(0.0);
                }
                multiplier += step;
                if free {
                    x.iter_mut().zip(&basis.rest).for_each(|(x, z)| *x += step * z);
                    lack -= step * squared;
                }
                if full <= blocking.0 {
                    basis.push();
                    active.push(Active { row, multiplier });
                    break;
                }
                active.remove(blocking.1);
                basis.rebuild(active.iter().map(|held| self.normal(held.row)));
            }
        }
        None
    }

    fn most_violated(&self, x: &[f64], tolerance: f64) -> Option<(usize, f64)> {
        let mut worst: Option<(usize, f64)> = None;
        for (row, level) in self.levels.iter().enumerate() {
            let (mut lack, mut size) = (*level, level.abs());
            for (a, x) in self.normal(row).iter().zip(x) {
                lack -= a * x;
                size += (a * x).abs();
            }
            // Also when it is not a number: then there is no such point.
            if lack > worst.map_or(tolerance.max(ROUNDING * size), |(_, most)| most) || lack.is_nan() {
                worst = Some((row, lack));
            }
        }
        worst
    }

    /// Moves `x` to a point whose last component is greatest, of all these the one nearest to where `x` was, and
    /// returns what holds it there. The polyhedron must have points, and a highest one; `size` is that of its
    /// components.
    ///
    /// A projection of a point far above: if it is far enough, the projection is the highest point nearest to it
    /// (Mangasarian and Meyer 1979). If it was not, the next one begins higher.
    pub(super) fn highest(&self, x: &mut [f64], size: f64, tolerance: f64) -> Option<Vec<Active>> {
        let last = self.dimension - 1;
        let mut best = f64::NEG_INFINITY;
        let mut lift = 10.0 * size;
        let mut held = Vec::new();
        for _ in 0..60 {
            let mut next = x.to_vec();
            next[last] = next[last].max(best) + lift;
            let active = self.nearest(&mut next, tolerance)?;
            let gain = next[last] - best;
            if gain <= 4.0 * tolerance {
                // Held from where it began, or by this projection: the multipliers are those of the larger lift.
                return Some(if held.is_empty() { active } else { held });
            }
            best = next[last];
            x.copy_from_slice(&next);
            held = active;
            lift *= 3.0;
        }
        Some(held)
    }
}

/// Orthonormal basis of the active normals, and the triangle that makes them of it.
struct Basis {
    dimension: usize,
    vectors: Vec<f64>,
    triangle: Vec<Vec<f64>>,
    /// Of the last normal split: components along the basis, …
    along: Vec<f64>,
    /// … its part outside, …
    rest: Vec<f64>,
    /// … and what the active normals make its part inside of.
    shares: Vec<f64>,
}

impl Basis {
    fn new(dimension: usize) -> Self {
        let rest = vec![0.0; dimension];
        Self { dimension, vectors: Vec::new(), triangle: Vec::new(), along: Vec::new(), rest, shares: Vec::new() }
    }

    /// Splits a normal into its parts inside and outside the span of the active ones; whether there is any outside.
    fn split(&mut self, normal: &[f64]) -> bool {
        let count = self.triangle.len();
        self.rest.copy_from_slice(normal);
        self.along.clear();
        self.along.resize(count, 0.0);
        let size = dot(normal, normal).sqrt();
        // Twice: the second time takes away the rounding of the first.
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

    /// Takes the normal that was split last.
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

    /// A corner of three walls that no number hits exactly, far from the origin.
    #[test]
    fn a_tolerance_below_the_rounding_of_the_levels_hides_no_point() {
        for i in 1..200 {
            let (x, y) = (60.0 / f64::from(i), -47.0 / f64::from(i + 1));
            let wall = |a: f64, b: f64| (vec![a, b], a * x + b * y);
            let walls = [wall(0.3, 0.7), wall(-0.9, 0.1), wall(0.6, -0.8)];
            assert!(polyhedron(2, &walls).nearest(&mut [0.0, 0.0], 1e-300).is_some(), "{walls:?}");
        }
    }

    #[test]
    fn of_equally_high_points_the_nearest_is_taken() {
        // A roof with a level ridge: y ≤ 1, and a wall at x ≥ 3.
        let roof = polyhedron(2, &[(vec![0.0, -1.0], -1.0), (vec![1.0, 0.0], 3.0), (vec![-1.0, -0.001], -9.0)]);
        let mut x = [4.0, 0.0];
        roof.highest(&mut x, 1.0, 1e-12).unwrap();
        assert!((x[0] - 4.0).abs() < 1e-9 && (x[1] - 1.0).abs() < 1e-12, "{x:?}");
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, ..Default::default() })]

        /// Optimality without a second solver: the point is inside, and the way back is made of active normals.
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
                // Farkas, by another way: the least common violation is positive.
                let mut lifted = Polyhedron::new(4);
                for (normal, level) in &rows {
                    lifted.add(normal.iter(), 1.0, Some(-1.0), *level);
                }
                lifted.add([0.0; 3].iter(), 1.0, Some(-1.0), -1.0);
                let mut point = vec![0.0; 4];
                lifted.highest(&mut point, 1.0, 1e-12).unwrap();
                prop_assert!(point[3] < 1e-9, "{point:?}");
            }
        }

        /// Against all corners, in the plane.
        #[test]
        fn the_highest_point_is_the_highest_corner(
            rows in prop::collection::vec((-1.0f64..1.0, 0.2f64..1.0, 0.0f64..3.0), 2..12),
        ) {
            // Roofs: every row bounds the height, and walls bound the breadth.
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
            polyhedron(2, &all).highest(&mut x, 1.0, 1e-12).unwrap();
            prop_assert!((x[1] - best).abs() < 1e-8, "{} {best}", x[1]);
        }
    }
}

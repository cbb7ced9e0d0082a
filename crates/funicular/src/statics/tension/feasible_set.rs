//! Tensions that satisfy the linearised balance within linear bounds, in one of two representations.

use super::bounds::Bounds;
use super::null_space::Solutions;
use crate::math::active_set::{self, Active, Polyhedron};

/// Number of null-space directions from which on the search is made in the space of the cables. With few directions the
/// null space has shorter vectors and no system to solve; with hundreds the space of the cables takes a small fraction
/// of the time. Both ways end at the same point, so the value affects only the time.
pub(super) const MIN_DIRECTIONS_IN_CABLE_SPACE: usize = 34;

/// Bounds of tensions (scaled, σ) that satisfy the balance, and of a height if there is one.
pub(super) struct FeasibleSet<'a> {
    solutions: &'a Solutions,
    lifted: bool,
    constraints: Constraints,
}

enum Constraints {
    InNullSpace(Polyhedron),
    InCableSpace(Bounds),
}

/// Result of a search.
pub(super) struct FeasiblePoint {
    pub sigma: Vec<f64>,
    /// Height; zero if there is none.
    pub height: f64,
    pub held: Vec<Active>,
}

impl<'a> FeasibleSet<'a> {
    /// Feasible set without bounds yet.
    pub(super) fn new(solutions: &'a Solutions, lifted: bool) -> Self {
        let constraints = if solutions.has_directions() {
            Constraints::InNullSpace(Polyhedron::new(solutions.redundancy() + usize::from(lifted)))
        } else {
            Constraints::InCableSpace(Bounds::new(solutions, lifted))
        };
        Self { solutions, lifted, constraints }
    }

    /// Adds `sign σ_i + lift t ≥ level`, or without a cable `lift t ≥ level`.
    pub(super) fn add(&mut self, cable: Option<usize>, sign: f64, lift: f64, level: f64) {
        match &mut self.constraints {
            Constraints::InCableSpace(bounds) => bounds.add(cable, sign, lift, level),
            Constraints::InNullSpace(set) => {
                let last = self.lifted.then_some(lift);
                match cable {
                    Some(i) => set.add(self.solutions.part(i), sign, last, level - sign * self.solutions.particular[i]),
                    None => {
                        set.add([0.0].iter().cycle().take(self.solutions.redundancy()), 1.0, last, level);
                    }
                }
            }
        }
    }

    /// Feasible tensions nearest to `start`, see [`active_set::nearest`].
    pub(super) fn nearest(self, start: impl Fn(usize) -> f64, height: f64, tolerance: f64) -> Option<FeasiblePoint> {
        self.search(start, height, |constraints, x| match constraints {
            Constraints::InNullSpace(set) => set.nearest(x, tolerance),
            Constraints::InCableSpace(bounds) => active_set::nearest(bounds, x, tolerance),
        })
    }

    /// Feasible tensions with the maximum height, see [`active_set::highest`].
    pub(super) fn highest(self, start: impl Fn(usize) -> f64, tolerance: f64) -> Option<FeasiblePoint> {
        self.search(start, 0.0, |constraints, x| match constraints {
            Constraints::InNullSpace(set) => set.highest(x, tolerance),
            Constraints::InCableSpace(bounds) => active_set::highest(bounds, x, tolerance),
        })
    }

    fn search(
        mut self,
        start: impl Fn(usize) -> f64,
        height: f64,
        end: impl FnOnce(&mut Constraints, &mut [f64]) -> Option<Vec<Active>>,
    ) -> Option<FeasiblePoint> {
        let in_null_space = matches!(self.constraints, Constraints::InNullSpace(_));
        let mut point = if in_null_space { self.solutions.along(start) } else { self.solutions.projected(start) };
        if self.lifted {
            point.push(height);
        }
        let held = end(&mut self.constraints, &mut point)?;
        let height = if self.lifted { point.pop()? } else { 0.0 };
        let sigma = if in_null_space { self.solutions.at(&point) } else { point };
        Some(FeasiblePoint { sigma, height, held })
    }
}

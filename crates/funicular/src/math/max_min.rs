//! Maximises the minimum of smooth functions, with bounds and constraints.
//!
//! Sequential linear programs with a trust region (Madsen 1975): the functions are linearised, the linear problem is
//! solved exactly inside a box about the point, and the box grows or shrinks by the ratio of the real gain to the
//! predicted one. The minimum of the functions has a kink where another function becomes the lowest one. The kink does
//! no harm, because all functions are rows of the linear problem.

use super::active_set::{Active, Polyhedron};

/// Linearised function at a point.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearisedFunction {
    /// Value.
    pub value: f64,
    /// Derivatives with respect to the unknowns.
    pub gradient: Vec<f64>,
    /// Number of the group to which an objective belongs, from 0; see [`Goal::Weighted`].
    pub group: usize,
}

/// Functions at a point. Different points may have different numbers of functions.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Evaluation {
    /// Objectives: the search maximises their minimum.
    pub objectives: Vec<LinearisedFunction>,
    /// Demands, that is constraints: functions that have to be at least zero, scaled so that a lack of 1 is large.
    pub demands: Vec<LinearisedFunction>,
}

impl Evaluation {
    /// Minimum of the objectives of a group, or of all objectives; infinite without objectives.
    fn lowest(&self, group: Option<usize>) -> f64 {
        let rows = self.objectives.iter().filter(|row| group.is_none_or(|group| row.group == group));
        rows.map(|row| row.value).fold(f64::INFINITY, f64::min)
    }
}

/// Problem that the search solves: it evaluates the functions at a point.
pub trait MaxMinProblem {
    /// Functions at a point. `None` if they do not exist there; the search then tries a shorter step.
    fn evaluate(&mut self, x: &[f64]) -> Option<Evaluation>;

    /// True to stop the search, which then returns its best point.
    fn is_cancelled(&self) -> bool {
        false
    }

    /// Reports the value after an iteration.
    fn progress(&mut self, iteration: usize, value: f64) {
        let _ = (iteration, value);
    }
}

/// Quantity that the search maximises.
#[derive(Debug, Clone, PartialEq)]
pub enum Goal {
    /// Minimum of all objectives.
    Worst,
    /// Weighted sum of the minima of the groups, with one weight per group.
    Weighted(Vec<f64>),
}

impl Goal {
    /// Value of the goal at a point.
    pub fn value(&self, evaluation: &Evaluation) -> f64 {
        match self {
            Self::Worst => evaluation.lowest(None),
            Self::Weighted(weights) => {
                let of_group = |(group, weight): (usize, &f64)| weight * evaluation.lowest(Some(group));
                weights.iter().enumerate().map(of_group).sum()
            }
        }
    }
}

/// Settings of the search.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Quantity that the search maximises.
    pub goal: Goal,
    /// Minimum and maximum of each unknown; both are finite, and the minimum is less than the maximum.
    pub bounds: Vec<[f64; 2]>,
    /// Minimum gain of a step, relative to the value. The search ends when a step promises less.
    pub tolerance: f64,
    /// Maximum number of iterations.
    pub max_iterations: usize,
}

/// Reason why a search has ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MaxMinEnding {
    /// No step gains more than the tolerance.
    Converged,
    /// The search has made the maximum number of iterations.
    Iterations,
    /// The problem has stopped the search.
    Cancelled,
}

/// Result of a search.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// LinearUnknowns.
    pub x: Vec<f64>,
    /// Value of the goal.
    pub value: f64,
    /// Functions at these unknowns.
    pub evaluation: Evaluation,
    /// Maximum lack of a demand; zero if all demands are met.
    pub violation: f64,
    /// Reason why the search has ended.
    pub ending: MaxMinEnding,
    /// Number of iterations.
    pub iterations: usize,
    /// Number of points at which the functions were evaluated.
    pub evaluations: usize,
    /// Multiplier of each objective: gain of the value per gain of the objective. For [`Goal::Worst`] the sum of the
    /// multipliers is 1.
    pub objective_shares: Vec<f64>,
    /// Multiplier of each demand: gain of the value if the demand is lowered by 1.
    pub demand_multipliers: Vec<f64>,
    /// Multiplier of each bound: gain of the value per distance by which the bound moves outwards. It is zero for an
    /// unknown between its bounds.
    pub bound_multipliers: Vec<f64>,
}

/// Half width of the box about the first point, and minimum half width, as fractions of the distance of the bounds.
/// Below the minimum a step is rounding of functions that are known to ten digits.
const FIRST_RADIUS: f64 = 0.1;
const MIN_RADIUS: f64 = 1e-9;

/// Half width of the box, in minimum half widths, in which the multipliers are computed if the search has ended in a
/// smaller box: there a step, and with it a multiplier, may be rounding. The multipliers of the tests agree to their
/// tolerances with factors from 1 to 1e8.
const MULTIPLIER_RADIUS: f64 = 1e3;

/// Fractions of the predicted gain below which the box shrinks and above which it grows, with the factors of both.
const POOR: f64 = 0.3;
const GOOD: f64 = 0.7;
const SHRINK: f64 = 1.0 / 3.0;
const GROW: f64 = 2.0;

/// Minimum length of a step, over the half width of the box, after which the box may grow. A shorter step did not need
/// a larger box. The tests find the same optima with 0.5, with 1, and if the box never grows.
const FULL_STEP: f64 = 0.99;

/// Penalty at the start: loss of the value, relative to the value, per lack of a demand. Factor by which the penalty
/// grows if the search converges with unmet demands, and maximum number of times that it grows.
const FIRST_PENALTY: f64 = 10.0;
const PENALTY_GROWTH: f64 = 10.0;
const MAX_PENALTIES: usize = 5;

/// Minimum size of the value to which tolerances refer, relative to the maximum change of an objective by one unknown
/// within its bounds.
const CLOSE_TO_ZERO: f64 = 1e-3;

/// Maximum lack of a demand that counts as met.
pub const MET: f64 = 1e-7;

/// Maximum distance of an unknown from its bound, relative to the distance of the bounds, at which it counts as at the
/// bound.
const AT_BOUND: f64 = 1e-9;

/// Point with its functions.
struct Point {
    x: Vec<f64>,
    evaluation: Evaluation,
    /// Value of the goal.
    value: f64,
    /// Maximum lack of a demand.
    violation: f64,
}

/// Solution of a linear problem.
struct Step {
    x: Vec<f64>,
    /// Predicted gain of the merit: value less penalty, relative to the size of the value.
    gain: f64,
    objective_shares: Vec<f64>,
    demand_multipliers: Vec<f64>,
    /// Length of the step over the half width of the box.
    reach: f64,
}

/// Maximises the goal from a start within the bounds. `None` if the functions do not exist at the start.
///
/// # Example
/// ```
/// use funicular::math::max_min::{Evaluation, Goal, MaxMinProblem, LinearisedFunction, Settings, maximise};
///
/// // The minimum of two parabolas is highest where they cross.
/// struct Parabolas;
/// impl MaxMinProblem for Parabolas {
///     fn evaluate(&mut self, x: &[f64]) -> Option<Evaluation> {
///         let row = |at: f64| {
///             let (value, slope) = (-(x[0] - at).powi(2), -2.0 * (x[0] - at));
///             LinearisedFunction { value, gradient: vec![slope], group: 0 }
///         };
///         Some(Evaluation { objectives: vec![row(0.0), row(2.0)], demands: Vec::new() })
///     }
/// }
/// let settings = Settings { goal: Goal::Worst, bounds: vec![[-3.0, 5.0]], tolerance: 1e-9, max_iterations: 100 };
/// let found = maximise(&mut Parabolas, &[4.0], &settings).unwrap();
/// assert!((found.x[0] - 1.0).abs() < 1e-6 && (found.value + 1.0).abs() < 1e-6);
/// ```
///
/// # References
/// K. Madsen, "An algorithm for minimax solution of overdetermined systems of non-linear equations", J. Inst. Maths
/// Applics 16, 321–328, 1975; docs/theory.md, equations (95a) to (95c).
pub fn maximise(problem: &mut impl MaxMinProblem, start: &[f64], settings: &Settings) -> Option<Found> {
    let mut search = MaxMinSearch { settings, penalty: FIRST_PENALTY, size: 1.0 };
    let mut evaluations = 1;
    let mut here = search.point(start.to_vec(), problem.evaluate(start)?);
    search.size = search.size_of(&here);

    let (mut radius, mut penalties, mut iterations) = (FIRST_RADIUS, 0, 0);
    let ending = loop {
        if problem.is_cancelled() {
            break MaxMinEnding::Cancelled;
        }
        if iterations == settings.max_iterations {
            break MaxMinEnding::Iterations;
        }

        // Solve the linear problem in the box.
        let step = search.step(&here, radius);
        let Some(step) = step.filter(|step| step.gain > settings.tolerance && radius > MIN_RADIUS) else {
            // A penalty that is too small leaves demands unmet that could be met.
            if here.violation > MET && penalties < MAX_PENALTIES {
                penalties += 1;
                search.penalty *= PENALTY_GROWTH;
                radius = FIRST_RADIUS;
                continue;
            }
            break MaxMinEnding::Converged;
        };
        iterations += 1;

        // Evaluate the functions at the new point, and compare the real gain with the predicted one.
        evaluations += 1;
        let there = problem.evaluate(&step.x).map(|evaluation| search.point(step.x.clone(), evaluation));
        let ratio =
            there.as_ref().map_or(f64::NEG_INFINITY, |there| (search.merit(there) - search.merit(&here)) / step.gain);
        if ratio > 0.0
            && let Some(there) = there
        {
            here = there;
            problem.progress(iterations, here.value);
        }

        // Choose the next box.
        radius = next_radius(radius, ratio, step.reach);
    };

    Some(search.found(here, ending, (iterations, evaluations), radius))
}

/// Half width of the next box after a step with this ratio of the real gain to the predicted one.
fn next_radius(radius: f64, ratio: f64, reach: f64) -> f64 {
    if ratio < POOR || ratio.is_nan() {
        SHRINK * radius.min(reach * radius)
    } else if ratio > GOOD && reach > FULL_STEP {
        (GROW * radius).min(1.0)
    } else {
        radius
    }
}

/// Search in progress.
struct MaxMinSearch<'a> {
    settings: &'a Settings,
    penalty: f64,
    /// Size of the value at the start.
    size: f64,
}

/// Places of the unknowns of a linear problem: the steps of the unknowns over the distances of their bounds, the lack
/// of the demands if there are demands, the values of the groups for a weighted goal, and last the height.
struct LinearUnknowns {
    lack: Option<usize>,
    first_group: usize,
    height: usize,
}

impl LinearUnknowns {
    fn of(here: &Point, groups: usize) -> Self {
        let count = here.x.len();
        let has_demands = !here.evaluation.demands.is_empty();
        let first_group = count + usize::from(has_demands);
        Self { lack: has_demands.then_some(count), first_group, height: first_group + groups }
    }

    /// Number of unknowns.
    fn count(&self) -> usize {
        self.height + 1
    }
}

impl MaxMinSearch<'_> {
    fn point(&self, x: Vec<f64>, evaluation: Evaluation) -> Point {
        let value = self.settings.goal.value(&evaluation);
        let violation = evaluation.demands.iter().fold(0.0, |most: f64, row| most.max(-row.value));
        Point { x, evaluation, value, violation }
    }

    /// Size of the value at a point, or of its changes within the bounds if the value is close to zero there.
    fn size_of(&self, here: &Point) -> f64 {
        let entries = here.evaluation.objectives.iter().flat_map(|row| row.gradient.iter().zip(&self.settings.bounds));
        let largest = entries.map(|(slope, [low, high])| slope.abs() * (high - low)).fold(0.0, f64::max);
        let size = here.value.abs().max(CLOSE_TO_ZERO * largest);
        if size > 0.0 { size } else { 1.0 }
    }

    /// Value less penalty, over the size of the value.
    fn merit(&self, point: &Point) -> f64 {
        point.value / self.size - self.penalty * point.violation
    }

    /// Weights of the groups; none for the minimum of all objectives.
    fn weights(&self) -> &[f64] {
        match &self.settings.goal {
            Goal::Worst => &[],
            Goal::Weighted(weights) => weights,
        }
    }

    /// Distances of the bounds.
    fn widths(&self) -> Vec<f64> {
        self.settings.bounds.iter().map(|[low, high]| high - low).collect()
    }

    /// Solution of the linear problem within a box; `None` if rounding leaves none.
    fn step(&self, here: &Point, radius: f64) -> Option<Step> {
        let unknowns = LinearUnknowns::of(here, self.weights().len());
        let mut polyhedron = Polyhedron::new(unknowns.count());
        self.add_objectives(&mut polyhedron, here, &unknowns);
        self.add_demands(&mut polyhedron, here, &unknowns);
        self.add_weighted_sum(&mut polyhedron, &unknowns);
        self.add_box(&mut polyhedron, here, &unknowns, radius);

        let mut solution = vec![0.0; unknowns.count()];
        if let Some(lack) = unknowns.lack {
            solution[lack] = here.violation;
        }
        let active = polyhedron.highest(&mut solution, 0.0)?;
        Some(self.step_of(here, radius, &solution, &active))
    }

    /// Normal of a linearised function over its size, with zeros for all unknowns but the steps.
    fn scaled(&self, row: &LinearisedFunction, size: f64, unknowns: &LinearUnknowns) -> Vec<f64> {
        let widths = self.widths();
        let mut normal: Vec<f64> = row.gradient.iter().zip(&widths).map(|(g, width)| g * width / size).collect();
        normal.resize(unknowns.count(), 0.0);
        normal
    }

    /// Adds the objectives: each is above the height, or above the value of its group.
    fn add_objectives(&self, polyhedron: &mut Polyhedron, here: &Point, unknowns: &LinearUnknowns) {
        let groups = self.weights().len();
        let lowest_of: Vec<f64> = (0..groups).map(|group| here.evaluation.lowest(Some(group))).collect();
        for row in &here.evaluation.objectives {
            let mut normal = self.scaled(row, self.size, unknowns);
            let lowest = if groups == 0 {
                normal[unknowns.height] = -1.0;
                if let Some(lack) = unknowns.lack {
                    normal[lack] = -self.penalty;
                }
                here.value
            } else {
                normal[unknowns.first_group + row.group] = -1.0;
                lowest_of[row.group]
            };
            polyhedron.add(normal.iter(), 1.0, None, (lowest - row.value) / self.size);
        }
    }

    /// Adds the demands, each met up to the common lack, which is not negative.
    fn add_demands(&self, polyhedron: &mut Polyhedron, here: &Point, unknowns: &LinearUnknowns) {
        let Some(lack) = unknowns.lack else { return };
        for row in &here.evaluation.demands {
            let mut normal = self.scaled(row, 1.0, unknowns);
            normal[lack] = 1.0;
            polyhedron.add(normal.iter(), 1.0, None, -row.value);
        }

        let mut normal = vec![0.0; unknowns.count()];
        normal[lack] = 1.0;
        polyhedron.add(normal.iter(), 1.0, None, 0.0);
    }

    /// Adds the weighted sum of the values of the groups, less the penalty, which is above the height.
    fn add_weighted_sum(&self, polyhedron: &mut Polyhedron, unknowns: &LinearUnknowns) {
        let weights = self.weights();
        if weights.is_empty() {
            return;
        }
        let mut normal = vec![0.0; unknowns.count()];
        normal[unknowns.first_group..unknowns.height].copy_from_slice(weights);
        if let Some(lack) = unknowns.lack {
            normal[lack] = -self.penalty;
        }
        normal[unknowns.height] = -1.0;
        polyhedron.add(normal.iter(), 1.0, None, 0.0);
    }

    /// Adds the box within the bounds.
    fn add_box(&self, polyhedron: &mut Polyhedron, here: &Point, unknowns: &LinearUnknowns, radius: f64) {
        let mut normal = vec![0.0; unknowns.count()];
        for (i, [low, high]) in self.settings.bounds.iter().enumerate() {
            let width = high - low;
            normal[i] = 1.0;
            polyhedron.add(normal.iter(), 1.0, None, -radius.min((here.x[i] - low) / width));
            normal[i] = -1.0;
            polyhedron.add(normal.iter(), 1.0, None, -radius.min((high - here.x[i]) / width));
            normal[i] = 0.0;
        }
    }

    /// Step of a solution of the linear problem, whose last unknown is the height. Objectives and demands are its first
    /// inequalities.
    fn step_of(&self, here: &Point, radius: f64, solution: &[f64], active: &[Active]) -> Step {
        let count = here.x.len();
        let height = solution[solution.len() - 1];
        let widths = self.widths();
        let moved = solution[..count].iter().fold(0.0, |most: f64, step| most.max(step.abs()));
        let x = (0..count).map(|i| {
            let [low, high] = self.settings.bounds[i];
            (here.x[i] + solution[i] * widths[i]).clamp(low, high)
        });
        let multiplier = |row: usize| {
            active.iter().find(|active| active.row == row).map_or(0.0, |Active { multiplier, .. }| *multiplier)
        };
        let (objectives, demands) = (here.evaluation.objectives.len(), here.evaluation.demands.len());
        Step {
            x: x.collect(),
            gain: height + self.penalty * here.violation,
            reach: moved / radius,
            objective_shares: (0..objectives).map(multiplier).collect(),
            demand_multipliers: (0..demands).map(|k| multiplier(objectives + k) * self.size).collect(),
        }
    }

    /// Result at the last point, with the multipliers of the linear problem there.
    fn found(
        &self,
        here: Point,
        ending: MaxMinEnding,
        (iterations, evaluations): (usize, usize),
        radius: f64,
    ) -> Found {
        let last = self.step(&here, radius.max(MULTIPLIER_RADIUS * MIN_RADIUS));
        let (objective_shares, demand_multipliers) = last.map_or_else(
            || (vec![0.0; here.evaluation.objectives.len()], vec![0.0; here.evaluation.demands.len()]),
            |step| (step.objective_shares, step.demand_multipliers),
        );
        let bound_multipliers = self.bound_multipliers(&here, &objective_shares, &demand_multipliers);

        Found {
            value: here.value,
            violation: here.violation,
            x: here.x,
            evaluation: here.evaluation,
            ending,
            iterations,
            evaluations,
            objective_shares,
            demand_multipliers,
            bound_multipliers,
        }
    }

    /// Multipliers of the bounds: derivatives of the Lagrangian that are left at a bound, outwards.
    fn bound_multipliers(&self, here: &Point, shares: &[f64], demands: &[f64]) -> Vec<f64> {
        let rows = here.evaluation.objectives.iter().zip(shares);
        let rows: Vec<_> = rows.chain(here.evaluation.demands.iter().zip(demands)).collect();
        let bounds = self.settings.bounds.iter().enumerate();
        let of_bound = |(i, [low, high]): (usize, &[f64; 2])| {
            let slope: f64 = rows.iter().map(|(row, multiplier)| row.gradient[i] * *multiplier).sum();
            let near = AT_BOUND * (high - low);
            match here.x[i] {
                x if x >= high - near => slope.max(0.0),
                x if x <= low + near => (-slope).max(0.0),
                _ => 0.0,
            }
        };
        bounds.map(of_bound).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Problem from closures.
    struct Of<F>(F);

    impl<F: FnMut(&[f64]) -> Option<Evaluation>> MaxMinProblem for Of<F> {
        fn evaluate(&mut self, x: &[f64]) -> Option<Evaluation> {
            (self.0)(x)
        }
    }

    fn row(value: f64, gradient: &[f64]) -> LinearisedFunction {
        LinearisedFunction { value, gradient: gradient.to_vec(), group: 0 }
    }

    fn settings(bounds: Vec<[f64; 2]>, tolerance: f64) -> Settings {
        Settings { goal: Goal::Worst, bounds, tolerance, max_iterations: 200 }
    }

    /// Problem CB2 of Charalambous and Bandler (1976): minimum of the maximum 1.952 224 5 at (1.139 038, 0.899 560).
    #[test]
    fn a_published_problem_has_its_published_optimum() {
        let mut problem = Of(|x: &[f64]| {
            let (a, b) = (x[0], x[1]);
            let e = 2.0 * (b - a).exp();
            Some(Evaluation {
                objectives: vec![
                    row(-(a * a + b.powi(4)), &[-2.0 * a, -4.0 * b.powi(3)]),
                    row(-((2.0 - a).powi(2) + (2.0 - b).powi(2)), &[2.0 * (2.0 - a), 2.0 * (2.0 - b)]),
                    row(-e, &[e, -e]),
                ],
                demands: Vec::new(),
            })
        });
        let found = maximise(&mut problem, &[1.0, -0.1], &settings(vec![[-5.0, 5.0]; 2], 1e-10)).unwrap();
        assert_eq!(found.ending, MaxMinEnding::Converged);
        assert!((found.value + 1.952_224_5).abs() < 1e-6, "{found:?}");
        assert!((found.x[0] - 1.139_038).abs() < 1e-3 && (found.x[1] - 0.899_560).abs() < 1e-3, "{found:?}");
        assert!((found.objective_shares.iter().sum::<f64>() - 1.0).abs() < 1e-9, "{found:?}");
    }

    /// The largest x + 2y within a circle of radius one and with y at most 0.6: at (0.8, 0.6), where the demand has the
    /// multiplier 1/(2·0.8) and the bound the rest, 2 − 0.6/0.8. Both are compared with optima beside it.
    #[test]
    fn multipliers_are_the_gains_of_wider_limits() {
        let solve = |radius: f64, top: f64| {
            let mut problem = Of(move |x: &[f64]| {
                let square = radius * radius - x[0] * x[0] - x[1] * x[1];
                Some(Evaluation {
                    objectives: vec![row(x[0] + 2.0 * x[1], &[1.0, 2.0])],
                    demands: vec![row(square, &[-2.0 * x[0], -2.0 * x[1]])],
                })
            });
            maximise(&mut problem, &[-0.3, 0.1], &settings(vec![[-2.0, 2.0], [-2.0, top]], 1e-11)).unwrap()
        };
        let found = solve(1.0, 0.6);
        assert!((found.x[0] - 0.8).abs() < 1e-5 && (found.x[1] - 0.6).abs() < 1e-9, "{found:?}");
        assert!(found.violation <= MET);
        assert!((found.demand_multipliers[0] - 0.625).abs() < 1e-4, "{found:?}");
        assert!((found.bound_multipliers[1] - 1.25).abs() < 1e-4 && found.bound_multipliers[0] == 0.0, "{found:?}");
        let wider = solve(1.0, 0.61).value - found.value;
        assert!((wider / 0.01 - 1.25).abs() < 0.02, "{wider}");
    }

    /// A start outside of the demands is led inside, also where the objective pulls away from them.
    #[test]
    fn demands_that_the_start_does_not_meet_are_met_in_the_end() {
        let mut problem = Of(|x: &[f64]| {
            let square = x[0] * x[0] + x[1] * x[1];
            Some(Evaluation {
                objectives: vec![row(-1000.0 * x[0], &[-1000.0, 0.0])],
                demands: vec![row(square - 4.0, &[2.0 * x[0], 2.0 * x[1]])],
            })
        });
        let found = maximise(&mut problem, &[0.5, 0.2], &settings(vec![[0.0, 3.0], [0.0, 1.0]], 1e-9)).unwrap();
        assert!(found.violation <= MET, "{found:?}");
        assert!((found.x[0] - 3.0_f64.sqrt()).abs() < 1e-5 && (found.x[1] - 1.0).abs() < 1e-9, "{found:?}");
    }

    /// The mean of two groups is highest elsewhere than their smaller one.
    #[test]
    fn weights_sum_the_lowest_of_every_group() {
        let of = |goal: Goal| {
            let mut problem = Of(|x: &[f64]| {
                let parabola = |at: f64, height: f64, group: usize| LinearisedFunction {
                    value: height - (x[0] - at).powi(2),
                    gradient: vec![-2.0 * (x[0] - at)],
                    group,
                };
                Some(Evaluation { objectives: vec![parabola(0.0, 5.0, 0), parabola(2.0, 1.0, 1)], demands: Vec::new() })
            });
            let settings = Settings { goal, ..settings(vec![[-3.0, 3.0]], 1e-12) };
            maximise(&mut problem, &[-1.0], &settings).unwrap()
        };
        // The smaller parabola alone; the weighted sum 0.75 (5 − x²) + 0.25 (1 − (x − 2)²) is highest at 0.5.
        assert!((of(Goal::Worst).x[0] - 2.0).abs() < 1e-4);
        let weighted = of(Goal::Weighted(vec![0.75, 0.25]));
        assert!((weighted.x[0] - 0.5).abs() < 1e-4, "{weighted:?}");
        assert!((weighted.value - (0.75 * 4.75 + 0.25 * (1.0 - 2.25))).abs() < 1e-8, "{weighted:?}");
    }

    /// Steps into a region where the functions do not exist get shorter until they do.
    #[test]
    fn points_without_functions_are_not_stepped_on() {
        let mut problem = Of(|x: &[f64]| {
            (x[0] < 1.234).then(|| Evaluation { objectives: vec![row(x[0], &[1.0])], demands: Vec::new() })
        });
        let found = maximise(&mut problem, &[0.0], &settings(vec![[-10.0, 10.0]], 1e-9)).unwrap();
        assert!(found.x[0] < 1.234 && found.x[0] > 1.23, "{found:?}");
    }
}

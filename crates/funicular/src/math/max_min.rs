//! Maximum of the smallest of several smooth functions within bounds, and under demands on others.
//!
//! Sequential linear programs with a trust region (Madsen 1975): the functions are linearised, the linear problem is
//! solved exactly inside a box about the point, and the box grows or shrinks by what the functions have gained of what
//! was predicted. Functions that exchange their places as the smallest one are no kink for it, because all of them are
//! rows of the linear problem.

use super::active_set::{Active, Polyhedron};

/// Linearised function at a point.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Value.
    pub value: f64,
    /// Derivatives by the unknowns.
    pub gradient: Vec<f64>,
    /// Number of the group to which an objective belongs, from 0; see [`Goal::Weighted`].
    pub group: usize,
}

/// Functions at a point. Their numbers may differ from point to point.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Evaluation {
    /// Functions whose smallest value is to be as large as possible.
    pub objectives: Vec<Row>,
    /// Functions that have to be at least zero, in units in which one is much.
    pub demands: Vec<Row>,
}

/// Functions of a problem.
pub trait Problem {
    /// Functions at a point; `None` if they do not exist there, so that a shorter step is tried.
    fn evaluate(&mut self, x: &[f64]) -> Option<Evaluation>;

    /// True if the search shall stop; it returns its best point.
    fn is_cancelled(&self) -> bool {
        false
    }

    /// Reports the value after an iteration.
    fn progress(&mut self, iteration: usize, value: f64) {
        let _ = (iteration, value);
    }
}

/// Number to be maximised.
#[derive(Debug, Clone, PartialEq)]
pub enum Goal {
    /// Smallest objective of all.
    Worst,
    /// Sum over the groups of a weight times the smallest objective of the group.
    Weighted(Vec<f64>),
}

/// Settings of the search.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Number to be maximised.
    pub goal: Goal,
    /// Minimum and maximum of every unknown; finite, the first below the second.
    pub bounds: Vec<[f64; 2]>,
    /// Gain of one step, relative to the value, below which the search ends.
    pub tolerance: f64,
    /// Maximum number of iterations.
    pub max_iterations: usize,
}

/// Reason for which a search has ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// No step gains more than the tolerance.
    Converged,
    /// The maximum number of iterations.
    Iterations,
    /// The search was stopped.
    Cancelled,
}

/// Result of a search.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// Unknowns.
    pub x: Vec<f64>,
    /// Value of the goal.
    pub value: f64,
    /// Functions there.
    pub evaluation: Evaluation,
    /// Largest lack of a demand; zero if all are met.
    pub violation: f64,
    /// Reason for the end.
    pub ending: Ending,
    /// Number of iterations.
    pub iterations: usize,
    /// Number of points at which the functions were requested.
    pub evaluations: usize,
    /// Share of each objective in the optimum: how much the value gains if this objective gains one. For
    /// [`Goal::Worst`] their sum is 1.
    pub objective_shares: Vec<f64>,
    /// Gain of the value if a demand is lowered by one.
    pub demand_multipliers: Vec<f64>,
    /// Gain of the value per unit of an unknown by which its bound is moved outwards; zero between the bounds.
    pub bound_multipliers: Vec<f64>,
}

/// Half of the box about the first point, as a fraction of the distance of the bounds, and the minimum of this half.
/// Below the minimum a step is rounding of functions that are known to ten digits.
const FIRST_RADIUS: f64 = 0.1;
const MIN_RADIUS: f64 = 1e-9;

/// Fractions of the predicted gain below which the box shrinks and above which it grows, and by which factors.
const POOR: f64 = 0.3;
const GOOD: f64 = 0.7;
const SHRINK: f64 = 1.0 / 3.0;
const GROW: f64 = 2.0;

/// Loss of the value, relative to it, per unit of a demand that is not met, at the start; factor by which it grows while
/// demands stay unmet; and number of times that it may grow.
const FIRST_PENALTY: f64 = 10.0;
const PENALTY_GROWTH: f64 = 10.0;
const MAX_PENALTIES: usize = 5;

/// Value over its largest change within the bounds by one unknown, below which the change is the size that tolerances
/// refer to.
const CLOSE_TO_ZERO: f64 = 1e-3;

/// Lack of a demand that counts as met.
pub const MET: f64 = 1e-7;

/// Distance from a bound, relative to that of the bounds, at which an unknown counts as at it.
const AT_BOUND: f64 = 1e-9;

/// Point with its functions.
struct Point {
    x: Vec<f64>,
    evaluation: Evaluation,
    value: f64,
    violation: f64,
}

/// Solution of a linear problem.
struct Step {
    x: Vec<f64>,
    /// Gain of value less penalty, relative to the size of the value.
    gain: f64,
    objective_shares: Vec<f64>,
    demand_multipliers: Vec<f64>,
    /// Length of the step over the half of the box.
    reach: f64,
}

/// Maximises the smallest objective, or a weighted sum of smallest ones, from a start within the bounds. `None` if the
/// functions do not exist at the start.
///
/// # Example
/// ```
/// use funicular::math::max_min::{Evaluation, Goal, Problem, Row, Settings, maximise};
///
/// // The lower one of two parabolas is highest where they cross.
/// struct Parabolas;
/// impl Problem for Parabolas {
///     fn evaluate(&mut self, x: &[f64]) -> Option<Evaluation> {
///         let row = |at: f64| Row { value: -(x[0] - at).powi(2), gradient: vec![-2.0 * (x[0] - at)], group: 0 };
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
pub fn maximise(problem: &mut impl Problem, start: &[f64], settings: &Settings) -> Option<Found> {
    let mut search = Search { settings, penalty: FIRST_PENALTY, size: 1.0 };
    let mut evaluations = 1;
    let mut here = search.point(start.to_vec(), problem.evaluate(start)?);
    search.size = search.size_of(&here);

    let (mut radius, mut penalties, mut iterations) = (FIRST_RADIUS, 0, 0);
    let ending = loop {
        if problem.is_cancelled() {
            break Ending::Cancelled;
        }
        if iterations == settings.max_iterations {
            break Ending::Iterations;
        }

        // Linear problem in the box.
        let step = search.step(&here, radius);
        let Some(step) = step.filter(|step| step.gain > settings.tolerance && radius > MIN_RADIUS) else {
            // A penalty that is too small leaves demands unmet that could be met.
            if here.violation > MET && penalties < MAX_PENALTIES {
                penalties += 1;
                search.penalty *= PENALTY_GROWTH;
                radius = FIRST_RADIUS;
                continue;
            }
            break Ending::Converged;
        };
        iterations += 1;

        // The functions there, and what they have gained of what was predicted.
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

        // The next box. Bounds may have shortened the step inside a box that was large enough.
        if ratio < POOR || ratio.is_nan() {
            radius = SHRINK * radius.min(step.reach * radius);
        } else if ratio > GOOD && step.reach > 0.99 {
            radius = (GROW * radius).min(1.0);
        }
    };

    // Multipliers of the last linear problem; those of bounds are the derivatives that are left there.
    let last = search.step(&here, radius.max(1e3 * MIN_RADIUS));
    let (objective_shares, demand_multipliers) = last.map_or_else(
        || (vec![0.0; here.evaluation.objectives.len()], vec![0.0; here.evaluation.demands.len()]),
        |step| (step.objective_shares, step.demand_multipliers),
    );
    let bound_multipliers = search.bound_multipliers(&here, &objective_shares, &demand_multipliers);
    Some(Found {
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
    })
}

struct Search<'a> {
    settings: &'a Settings,
    penalty: f64,
    /// Size of the value at the start.
    size: f64,
}

impl Search<'_> {
    fn point(&self, x: Vec<f64>, evaluation: Evaluation) -> Point {
        let lowest = |rows: &mut dyn Iterator<Item = &Row>| rows.map(|row| row.value).fold(f64::INFINITY, f64::min);
        let value = match &self.settings.goal {
            Goal::Worst => lowest(&mut evaluation.objectives.iter()),
            Goal::Weighted(weights) => {
                let of_group = |(group, weight): (usize, &f64)| {
                    weight * lowest(&mut evaluation.objectives.iter().filter(|row| row.group == group))
                };
                weights.iter().enumerate().map(of_group).sum()
            }
        };
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

    /// Solution of the linear problem within a box; `None` if rounding leaves none.
    ///
    /// Its unknowns are the step of every unknown over the distance of its bounds, the lack of the demands, the values
    /// of the groups for a weighted goal, and last the height.
    fn step(&self, here: &Point, radius: f64) -> Option<Step> {
        let count = here.x.len();
        let widths: Vec<f64> = self.settings.bounds.iter().map(|[low, high]| high - low).collect();
        let has_demands = !here.evaluation.demands.is_empty();
        let weights = match &self.settings.goal {
            Goal::Worst => &[][..],
            Goal::Weighted(weights) => weights,
        };
        let lack = count;
        let first_group = count + usize::from(has_demands);
        let height = first_group + weights.len();
        let mut polyhedron = Polyhedron::new(height + 1);
        let mut add = |normal: &[f64], level: f64| polyhedron.add(normal.iter(), 1.0, None, level);
        let scaled = |row: &Row, size: f64| -> Vec<f64> {
            let mut normal: Vec<f64> = row.gradient.iter().zip(&widths).map(|(g, width)| g * width / size).collect();
            normal.resize(height + 1, 0.0);
            normal
        };

        // Objectives above the height, or above the value of their group.
        let lowest_of: Vec<f64> = (0..weights.len())
            .map(|group| {
                let own = here.evaluation.objectives.iter().filter(|row| row.group == group);
                own.map(|row| row.value).fold(f64::INFINITY, f64::min)
            })
            .collect();
        for row in &here.evaluation.objectives {
            let mut normal = scaled(row, self.size);
            if weights.is_empty() {
                normal[height] = -1.0;
                if has_demands {
                    normal[lack] = -self.penalty;
                }
                add(&normal, (here.value - row.value) / self.size);
            } else {
                normal[first_group + row.group] = -1.0;
                add(&normal, (lowest_of[row.group] - row.value) / self.size);
            }
        }
        let objectives = here.evaluation.objectives.len();

        // Demands, and their lack.
        for row in &here.evaluation.demands {
            let mut normal = scaled(row, 1.0);
            normal[lack] = 1.0;
            add(&normal, -row.value);
        }
        let mut fixed = vec![0.0; height + 1];
        if has_demands {
            fixed[lack] = 1.0;
            add(&fixed, 0.0);
            fixed[lack] = 0.0;
        }
        if !weights.is_empty() {
            let mut normal = fixed.clone();
            normal[first_group..height].copy_from_slice(weights);
            if has_demands {
                normal[lack] = -self.penalty;
            }
            normal[height] = -1.0;
            add(&normal, 0.0);
        }

        // The box within the bounds.
        for (i, ([low, high], width)) in self.settings.bounds.iter().zip(&widths).enumerate() {
            fixed[i] = 1.0;
            add(&fixed, -radius.min((here.x[i] - low) / width));
            fixed[i] = -1.0;
            add(&fixed, -radius.min((high - here.x[i]) / width));
            fixed[i] = 0.0;
        }

        let mut solution = vec![0.0; height + 1];
        if has_demands {
            solution[lack] = here.violation;
        }
        let active = polyhedron.highest(&mut solution, 0.0)?;
        let gain = solution[height] + self.penalty * here.violation;
        let moved = solution[..count].iter().fold(0.0, |most: f64, step| most.max(step.abs()));
        let x = (0..count).map(|i| {
            let [low, high] = self.settings.bounds[i];
            (here.x[i] + solution[i] * widths[i]).clamp(low, high)
        });
        let multiplier = |row: usize| {
            active.iter().find(|active| active.row == row).map_or(0.0, |Active { multiplier, .. }| *multiplier)
        };
        Some(Step {
            x: x.collect(),
            gain,
            reach: moved / radius,
            objective_shares: (0..objectives).map(multiplier).collect(),
            demand_multipliers: (0..here.evaluation.demands.len())
                .map(|k| multiplier(objectives + k) * self.size)
                .collect(),
        })
    }

    /// Derivatives of the Lagrangian at the bounds, outwards.
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

    impl<F: FnMut(&[f64]) -> Option<Evaluation>> Problem for Of<F> {
        fn evaluate(&mut self, x: &[f64]) -> Option<Evaluation> {
            (self.0)(x)
        }
    }

    fn row(value: f64, gradient: &[f64]) -> Row {
        Row { value, gradient: gradient.to_vec(), group: 0 }
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
        assert_eq!(found.ending, Ending::Converged);
        assert!((found.value + 1.952_224_5).abs() < 1e-6, "{found:?}");
        assert!((found.x[0] - 1.139_038).abs() < 1e-3 && (found.x[1] - 0.899_560).abs() < 1e-3, "{found:?}");
        assert!((found.objective_shares.iter().sum::<f64>() - 1.0).abs() < 1e-9, "{found:?}");
    }

    /// The largest x + 2y within a circle of radius one and with y at most 0.6: at (0.8, 0.6), where the demand has the
    /// multiplier 1/(2·0.8) and the bound what is left, 2 − 0.6/0.8. Both are compared with optima beside it.
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
                let parabola = |at: f64, height: f64, group: usize| Row {
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

    /// Where the functions do not exist, steps get shorter until they do.
    #[test]
    fn points_without_functions_are_not_stepped_on() {
        let mut problem = Of(|x: &[f64]| {
            (x[0] < 1.234).then(|| Evaluation { objectives: vec![row(x[0], &[1.0])], demands: Vec::new() })
        });
        let found = maximise(&mut problem, &[0.0], &settings(vec![[-10.0, 10.0]], 1e-9)).unwrap();
        assert!(found.x[0] < 1.234 && found.x[0] > 1.23, "{found:?}");
    }
}

//! Levenberg–Marquardt search over all unknowns of the robot and all poses at once, with the poses eliminated row by
//! row: the cost of a step is linear in the number of rows.

use super::Calibration;
use super::elastic::RowState;
use super::elimination::EliminatedRow;
use super::row::RowTerms;
use crate::math::{DMat, DVec};
use crate::robot::Pose;

/// First damping, relative to the largest column norms so far.
const FIRST_DAMPING: f64 = 1e-3;

/// Damping with which a small predicted decrease ends the search. With a larger one the step may be small because it is
/// damped.
const LAST_DAMPING: f64 = 1e-9;

/// Largest damping: a step with it is rounding.
const MAX_DAMPING: f64 = 1e16;

/// Predicted decrease of χ² that ends the search: its root is the distance from the minimum in deviations, 1e-6.
const MIN_DECREASE: f64 = 1e-12;

/// Smallest decrease relative to χ², which is rounding of the sum of squares.
const MIN_RELATIVE_DECREASE: f64 = 1e-14;

/// Maximum number of iterations of a fit. Eight cables with offsets and 32 rows, started at the middle, take about 40;
/// exchanged cables creep for hundreds.
pub(super) const MAX_ITERATIONS: usize = 300;

/// Result of one search.
#[derive(Debug, Clone)]
pub struct CalibrationFit {
    /// Values of the unknowns, in the form of [`Calibration::start`].
    pub values: Vec<f64>,
    /// Pose of each row.
    pub poses: Vec<Pose>,
    /// Unstrained lengths of the cables in each row, if cables are elastic; else each is empty [m].
    pub lengths: Vec<Vec<f64>>,
    /// Sum of the squares of the residuals, each divided by its standard deviation.
    pub chi2: f64,
    /// Number of iterations.
    pub iterations: usize,
    /// True if the search ended at a minimum.
    pub converged: bool,
}

/// Linearisation of all rows at a point, and the residuals of the priors.
struct Linearised {
    rows: Vec<RowTerms>,
    priors: DVec,
    chi2: f64,
}

/// Step of all unknowns, with the decrease of χ² that the linearisation predicts.
struct DampedStep {
    values: DVec,
    poses: Vec<DVec>,
    predicted: f64,
}

/// Values and states before the first iteration.
fn unfitted(values: &[f64], states: &[RowState]) -> CalibrationFit {
    CalibrationFit {
        values: values.to_vec(),
        poses: states.iter().map(|state| state.pose).collect(),
        lengths: states.iter().map(|state| state.lengths.clone()).collect(),
        chi2: f64::INFINITY,
        iterations: 0,
        converged: false,
    }
}

/// Damping of the steps of a fit.
struct StepDamping {
    value: f64,
    /// Factor of the next failure.
    growth: f64,
}

impl StepDamping {
    fn new() -> Self {
        Self { value: FIRST_DAMPING, growth: 2.0 }
    }

    /// Less damping, the nearer the decrease of χ² was to the predicted one.
    fn after_success(&mut self, share_of_predicted: f64) {
        self.value *= (1.0 - (2.0 * share_of_predicted - 1.0).powi(3)).clamp(1.0 / 3.0, 2.0);
        self.value = self.value.max(LAST_DAMPING * 1e-3);
        self.growth = 2.0;
    }

    fn after_failure(&mut self) {
        self.value *= self.growth;
        self.growth *= 2.0;
    }
}

impl Calibration {
    /// Minimises χ² from a point, over values that move along the columns of `free`.
    ///
    /// # References
    /// Elimination of separable unknowns: G. H. Golub, V. Pereyra, SIAM J. Numer. Anal. 10 (1973); damping: H. B.
    /// Nielsen (1999).
    pub(super) fn fit(&self, values: &[f64], poses: &[Pose], free: &DMat) -> CalibrationFit {
        self.fit_within(MAX_ITERATIONS, values, self.states(values, poses), free)
    }

    /// Fit from the poses and lengths of another fit.
    pub(super) fn fit_on(&self, from: &CalibrationFit, values: &[f64], free: &DMat) -> CalibrationFit {
        self.fit_within(MAX_ITERATIONS, values, states_of(from), free)
    }

    /// Fit from states of the rows, with at most so many iterations.
    pub(super) fn fit_within(
        &self,
        max_iterations: usize,
        values: &[f64],
        mut states: Vec<RowState>,
        free: &DMat,
    ) -> CalibrationFit {
        let mut fit = unfitted(values, &states);
        let priors = self.prior_rows(free);
        let Some(mut at) = self.linearised(&fit.values, &states) else { return fit };
        fit.chi2 = at.chi2;
        let mut scale = Scales::new(free.ncols(), self.rows.len(), self.row_unknown_count());
        let mut damping = StepDamping::new();

        while fit.iterations < max_iterations && fit.chi2.is_finite() {
            fit.iterations += 1;
            scale.grow(&at.rows, free, &priors);
            let step = scale.step(&at, free, &priors, damping.value);
            if step.predicted <= MIN_DECREASE + MIN_RELATIVE_DECREASE * fit.chi2 {
                if damping.value <= LAST_DAMPING {
                    fit.converged = true;
                    break;
                }
                damping.value *= LAST_DAMPING.sqrt();
                continue;
            }

            // The step counts if χ² falls.
            let moved = DVec::from_column_slice(&fit.values) + free * &step.values;
            let next_states: Vec<RowState> =
                states.iter().zip(&step.poses).map(|(state, step)| self.moved_state(state, step)).collect();
            let next = self.chi2_at(moved.as_slice(), &next_states);
            let decrease = next.as_ref().map_or(f64::NAN, |(chi2, _)| fit.chi2 - chi2);
            if decrease > 0.0
                && let Some((_, next_states)) = next
                && let Some(linearised) = self.linearised(moved.as_slice(), &next_states)
            {
                fit.values = moved.as_slice().to_vec();
                states = next_states;
                at = linearised;
                fit.chi2 = at.chi2;
                damping.after_success(decrease / step.predicted);
            } else {
                // Rounding of χ² hides what is left to gain.
                if step.predicted <= ROUNDING * fit.chi2.max(1.0) {
                    fit.converged = true;
                    break;
                }
                damping.after_failure();
                if damping.value > MAX_DAMPING {
                    break;
                }
            }
        }
        fit.poses = states.iter().map(|state| state.pose).collect();
        fit.lengths = states.into_iter().map(|state| state.lengths).collect();
        fit
    }

    fn linearised(&self, values: &[f64], states: &[RowState]) -> Option<Linearised> {
        let robot = self.robot_at(values);
        let terms = self.rows.iter().zip(states).map(|(row, state)| self.terms_of(&robot, row, state));
        let rows: Vec<RowTerms> = terms.collect::<Option<_>>()?;
        let priors = self.prior_residuals(values);
        let of_rows: f64 = rows.iter().map(|row| row.residuals.norm_squared()).sum();
        let chi2 = of_rows + priors.norm_squared();
        Some(Linearised { rows, priors, chi2 })
    }

    /// Linearisation of the rows of a fit; empty without equilibria.
    pub(super) fn terms_at(&self, fit: &CalibrationFit) -> Vec<RowTerms> {
        self.linearised(&fit.values, &states_of(fit)).map_or_else(Vec::new, |linearised| linearised.rows)
    }

    /// χ² at a point, with the states of the rows at rest; `None` without an equilibrium.
    fn chi2_at(&self, values: &[f64], states: &[RowState]) -> Option<(f64, Vec<RowState>)> {
        let robot = self.robot_at(values);
        let (mut chi2, mut at_rest) = (self.prior_residuals(values).norm_squared(), Vec::with_capacity(states.len()));
        for (row, state) in self.rows.iter().zip(states) {
            let (residuals, state) = self.row_residuals(&robot, row, state)?;
            chi2 += residuals.norm_squared();
            at_rest.push(state);
        }
        Some((chi2, at_rest))
    }

    /// Residuals of every row at a fit, computed less measured, in the units of the data: readings of the cables that
    /// were read [m], measured coordinates [m] and angles [rad], tensions [N].
    pub fn residuals_of(&self, fit: &CalibrationFit) -> Vec<Vec<f64>> {
        let of_row = |(row, terms): (&super::MeasuredRow, &RowTerms)| {
            let read = row.readings.iter().flatten().count();
            let [placed, turned] = self.pose_data_counts(row);
            let tensions = (0..self.robot.cables.len()).filter_map(|cable| self.tension_datum(row, cable));
            let tensions: Vec<f64> = tensions.map(|(_, deviation)| deviation).collect();
            let unit = |k: usize| match k {
                k if k < read => self.deviations.reading,
                k if k < read + placed => self.deviations.position,
                k if k < read + placed + turned => self.deviations.angle,
                k => tensions[k - read - placed - turned],
            };
            terms.residuals.iter().enumerate().map(|(k, residual)| residual * unit(k)).collect()
        };
        self.rows.iter().zip(&self.terms_at(fit)).map(of_row).collect()
    }
}

/// States of the rows of a fit.
pub(super) fn states_of(fit: &CalibrationFit) -> Vec<RowState> {
    let states = fit.poses.iter().enumerate();
    states.map(|(j, pose)| RowState { pose: *pose, lengths: fit.lengths.get(j).cloned().unwrap_or_default() }).collect()
}

/// Decrease of χ² relative to χ² below which rounding decides whether it falls.
const ROUNDING: f64 = 1e-9;

/// Largest column norms so far: of the unknowns, and of the coordinates of each row's pose.
struct Scales {
    values: DVec,
    poses: Vec<DVec>,
}

impl Scales {
    fn new(values: usize, rows: usize, coordinates: usize) -> Self {
        Self { values: DVec::zeros(values), poses: vec![DVec::zeros(coordinates); rows] }
    }

    fn grow(&mut self, rows: &[RowTerms], free: &DMat, priors: &DMat) {
        let mut squares = DVec::from_fn(self.values.len(), |k, _| priors.column(k).norm_squared());
        for (row, scale) in rows.iter().zip(&mut self.poses) {
            let along = &row.by_unknowns * free;
            for (k, column) in along.column_iter().enumerate() {
                squares[k] += column.norm_squared();
            }
            for (c, column) in row.by_pose.column_iter().enumerate() {
                scale[c] = scale[c].max(column.norm());
            }
        }
        for (scale, square) in self.values.iter_mut().zip(squares.iter()) {
            *scale = scale.max(square.sqrt());
        }
    }

    /// Damped step of all unknowns.
    fn step(&self, at: &Linearised, free: &DMat, priors: &DMat, damping: f64) -> DampedStep {
        let rows = &at.rows;
        let root = damping.sqrt();
        let eliminated: Vec<EliminatedRow> = rows
            .iter()
            .zip(&self.poses)
            .map(|(row, scale)| EliminatedRow::of(row, free, Some(&(scale * root))))
            .collect();

        // The net rows of all rows and of the priors, with the damping of the unknowns below.
        let height = eliminated.iter().map(|row| row.net.nrows()).sum::<usize>() + priors.nrows();
        let count = free.ncols();
        let mut all = DMat::zeros(height + count, count);
        let mut right = DMat::zeros(height + count, 1);
        let mut first = 0;
        for row in &eliminated {
            all.view_mut((first, 0), row.net.shape()).copy_from(&row.net);
            right.view_mut((first, 0), (row.net.nrows(), 1)).copy_from(&(-&row.residuals));
            first += row.net.nrows();
        }
        all.view_mut((first, 0), priors.shape()).copy_from(priors);
        right.view_mut((first, 0), (priors.nrows(), 1)).copy_from(&(-&at.priors));
        // A column that no datum sees is damped as well, so that its unknown stays.
        let largest = self.values.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        for k in 0..count {
            all[(height + k, k)] = root * self.values[k].max(1e-12 * largest);
        }
        // Poses alone leave nothing to factorise.
        let values = if count == 0 {
            DVec::zeros(0)
        } else {
            let factors = all.qr();
            factors.q_tr_mul(&mut right);
            let right = right.rows(0, count).column(0).into_owned();
            factors.r().solve_upper_triangular(&right).unwrap_or_else(|| DVec::zeros(count))
        };

        // The poses follow.
        let poses: Vec<DVec> = eliminated.iter().map(|row| row.pose_step(&values)).collect();
        let along = free * &values;
        let (mut before, mut after) = (at.priors.norm_squared(), (&at.priors + priors * &values).norm_squared());
        for (row, pose) in rows.iter().zip(&poses) {
            before += row.residuals.norm_squared();
            after += (&row.residuals + &row.by_unknowns * &along + &row.by_pose * pose).norm_squared();
        }
        DampedStep { values, poses, predicted: before - after }
    }
}

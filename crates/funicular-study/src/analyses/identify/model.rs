//! Predictions of all measurements by a robot with other values, and their derivatives.

use super::experiment::{Prepared, Solved};
use super::observations::{Observation, Stage, Subject, left_out, weights};
use super::unknowns::Unknown;
use crate::at_rest::{self, AtRest};
use crate::request::{IdentifyRequest, RobotText};
use crate::set_values;
use anyhow::{Result, bail};
use funicular::dynamics::Linearisation;
use funicular::math::least_squares::LeastSquaresProblem;
use funicular::math::{Complex, DMat};
use funicular::robot::parameters::Parameters;
use funicular::robot::{Robot, RobotChange};
use std::ops::Range;

/// Step of the central differences, relative to the spread of a value: their error grows with its square, the rounding
/// of the equilibrium with its inverse.
const STEP: f64 = 3e-4;

/// Relative change of an assumed deviation up to which it stays: it is far below the noise, with which a deviation at
/// the measured value varies.
const SAME_DEVIATION: f64 = 1e-3;

/// Modes to which the frequencies of each experiment are assigned: indices in the ascending list.
pub(crate) type Assigned = Vec<Vec<usize>>;

/// Predictions of all experiments.
#[derive(Debug, Clone)]
pub(crate) struct Predicted {
    /// Values in the order of the observations.
    pub(crate) values: Vec<Complex>,
    /// Modes of the frequencies.
    pub(crate) assigned: Assigned,
}

/// Robot with values to identify and its measurements.
pub(crate) struct IdentifiedModel<'a> {
    pub(crate) parameters: &'a Parameters,
    pub(crate) unknowns: &'a [Unknown],
    request: &'a IdentifyRequest,
    pub(super) experiments: Vec<Prepared<'a>>,
    /// All observations.
    pub(crate) observations: Vec<Observation>,
    /// Residuals in use.
    pub(crate) stage: Stage,
    /// Choices at the point that was linearised last: modes of frequencies, weights of observations.
    held: Option<(Assigned, Vec<f64>)>,
    /// True per observation that is left out, because the model misses it and its neighbours.
    pub(crate) left_out: Vec<bool>,
    /// True for derivatives from gradients, where they exist; false for differences alone.
    pub(crate) has_gradients: bool,
    /// Stops the search.
    is_cancelled: &'a dyn Fn() -> bool,
    /// Number of equilibria that were computed.
    pub(crate) evaluations: usize,
    /// Reason for which the last point had no prediction.
    pub(crate) refusal: Option<anyhow::Error>,
}

impl<'a> IdentifiedModel<'a> {
    /// Checks the measurements.
    ///
    /// # Errors
    /// Signals that the robot does not have, measurements that are not possible, or none.
    pub(crate) fn new(
        parameters: &'a Parameters,
        unknowns: &'a [Unknown],
        request: &'a IdentifyRequest,
        is_cancelled: &'a dyn Fn() -> bool,
    ) -> Result<Self> {
        if request.experiments.is_empty() {
            bail!("⟪experiments⟫ is empty: give at least one measurement");
        }
        let several = request.experiments.len() > 1;
        let mut experiments = Vec::with_capacity(request.experiments.len());
        for (i, given) in request.experiments.iter().enumerate() {
            let name = match given.name.as_str() {
                "" if several => format!("experiment {}", i + 1),
                "" => "the experiment".to_owned(),
                name => format!("experiment {name}"),
            };
            experiments.push(Prepared::new(parameters.robot(), (i, given), name, request)?);
        }
        let observations: Vec<Observation> =
            experiments.iter().flat_map(|experiment| experiment.observations.iter().copied()).collect();

        Ok(Self {
            left_out: vec![false; observations.len()],
            has_gradients: true,
            parameters,
            unknowns,
            request,
            experiments,
            observations,
            stage: Stage::Complex,
            held: None,
            is_cancelled,
            evaluations: 0,
            refusal: None,
        })
    }

    /// Values of the unknowns at coordinates.
    pub(crate) fn values(&self, x: &[f64]) -> Vec<f64> {
        self.unknowns.iter().zip(x).map(|(unknown, x)| unknown.value(*x)).collect()
    }

    /// Robot with values at coordinates, before the changes of an experiment.
    pub(crate) fn robot(&self, x: &[f64]) -> Result<Robot> {
        let values: Vec<(usize, f64)> =
            self.unknowns.iter().zip(self.values(x)).map(|(unknown, value)| (unknown.index, value)).collect();
        Ok(self.parameters.robot_with(&values)?)
    }

    /// Text of the robot file with values at coordinates.
    ///
    /// # Errors
    /// Values that the robot cannot have.
    pub(crate) fn text(&self, x: &[f64]) -> Result<String> {
        let source: &RobotText = &self.request.robot;
        let mut assignments = Vec::with_capacity(x.len());
        for (unknown, value) in self.unknowns.iter().zip(self.values(x)) {
            let path = set_values::path(&unknown.path).map_err(|error| anyhow::anyhow!("{error}"))?;
            assignments.push(path.with("⟪fit⟫", value));
        }
        Ok(set_values::apply(&source.changed_text()?, &assignments)?)
    }

    /// Robot of an experiment at rest, with values at coordinates.
    ///
    /// # Errors
    /// Values that the robot cannot have, or a robot without equilibrium.
    pub(crate) fn at_rest(&self, x: &[f64], experiment: usize) -> Result<AtRest> {
        self.experiments[experiment].at_rest(self.robot(x)?, self.request)
    }

    /// Names of the experiments.
    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        self.experiments.iter().map(|experiment| experiment.name.as_str())
    }

    /// Cable model and reference of vibrations about an equilibrium, as the request chooses them.
    pub(crate) fn linearisation(&self, at_rest: &AtRest) -> Linearisation {
        at_rest::linearisation(&self.request.model, at_rest.equilibrium.model)
    }

    /// Predictions at coordinates; modes are assigned anew, or as `assigned` says.
    ///
    /// # Errors
    /// Values that the robot cannot have, or a robot without equilibrium or response.
    pub(crate) fn predict(&mut self, x: &[f64], assigned: Option<&Assigned>) -> Result<Predicted> {
        Ok(Predicted::of(&self.solve(x, assigned)?))
    }

    /// Experiments solved at coordinates.
    pub(super) fn solve(&mut self, x: &[f64], assigned: Option<&Assigned>) -> Result<Vec<Solved>> {
        let robot = self.robot(x)?;
        (0..self.experiments.len()).map(|i| self.solve_one(i, robot.clone(), assigned.map(|all| &all[i][..]))).collect()
    }

    fn solve_one(&mut self, number: usize, robot: Robot, assigned: Option<&[usize]>) -> Result<Solved> {
        self.evaluations += 1;
        let experiment = &self.experiments[number];
        experiment
            .solve(robot, self.request, self.stage, assigned)
            .map_err(|error| error.context(experiment.name.clone()))
    }

    /// Result, or `None` with the reason kept for the message.
    fn try_or_keep<T>(&mut self, result: Result<T>) -> Option<T> {
        match result {
            Ok(found) => Some(found),
            Err(error) => {
                self.refusal = Some(error);
                None
            }
        }
    }

    /// Residuals of predictions and of the priors.
    fn residuals_of(&self, x: &[f64], values: &[Complex], weights: &[f64]) -> Option<Vec<f64>> {
        let mut residuals = Vec::new();
        for ((observation, value), weight) in self.observations.iter().zip(values).zip(weights) {
            observation.residuals(self.stage, *value, *weight, &mut residuals);
        }
        for (unknown, x) in self.unknowns.iter().zip(x) {
            if let Some((prior, deviation)) = unknown.coordinate_prior() {
                residuals.push((x - prior) / deviation);
            }
        }
        residuals.iter().all(|residual| residual.is_finite()).then_some(residuals)
    }

    /// Reason for which a residual is not finite.
    fn not_finite(&self, values: &[Complex]) -> anyhow::Error {
        let mut all = self.observations.iter().zip(values);
        if all.any(|(observation, value)| matches!(observation.subject, Subject::Damping(_)) && value.re <= 0.0) {
            return anyhow::anyhow!(
                "a damping ratio was measured, and the mode has no damping in the model: give the ropes a \
                 `damping_ratio` or an `axial_loss_factor`, or leave the measured one out"
            );
        }
        anyhow::anyhow!("a residual is not finite: the robot or its measurements are too far apart")
    }

    /// Weights of the observations at the point that was linearised last.
    pub(crate) fn weights(&self) -> &[f64] {
        self.held.as_ref().map_or(&[], |(_, weights)| weights)
    }

    /// Takes the assumed deviations of responses from their predictions at coordinates, and leaves out the ranges of
    /// responses that the model misses there. Returns true if deviations or ranges differ from those before.
    pub(crate) fn renew_responses(&mut self, x: &[f64]) -> bool {
        let Some((assigned, _)) = self.held.clone() else { return false };
        let Ok(predicted) = self.predict(x, Some(&assigned)) else { return false };
        let renewed = self.observations.iter_mut().zip(&predicted.values);
        let change = renewed.map(|(observation, value)| observation.renew_deviation(*value)).fold(0.0, f64::max);
        let found = left_out(&self.observations, &predicted.values, &self.left_out);
        let is_new = found != self.left_out;
        self.left_out = found;
        is_new || change > SAME_DEVIATION
    }

    /// Choices at the point that was linearised last: modes of frequencies, weights of observations.
    pub(super) fn choices(&self) -> Option<(Assigned, Vec<f64>)> {
        self.held.clone()
    }

    /// Makes choices of [`Self::choices`] again.
    pub(super) fn choose(&mut self, choices: Option<(Assigned, Vec<f64>)>) {
        self.held = choices;
    }

    /// True if the work was stopped.
    pub(super) fn is_stopped(&self) -> bool {
        (self.is_cancelled)()
    }

    /// Number of residuals of the priors.
    pub(crate) fn prior_count(&self) -> usize {
        self.unknowns.iter().filter(|unknown| unknown.prior.is_some()).count()
    }

    /// Derivatives of the predictions by all coordinates, one list per coordinate: from gradients, or by differences
    /// for an experiment or a value without them.
    pub(super) fn derivatives(&mut self, x: &[f64], here: &[Solved]) -> Option<Vec<Vec<Complex>>> {
        let parameters = self.parameters_at(x)?;
        let values = self.values(x);
        let mut columns: Vec<Vec<Complex>> = x.iter().map(|_| Vec::with_capacity(self.observations.len())).collect();

        for (number, solved) in here.iter().enumerate() {
            if (self.is_cancelled)() {
                return None;
            }
            let experiment = &self.experiments[number];
            let known: Vec<usize> = (0..x.len())
                .filter(|&k| self.has_gradients && parameters.change(self.unknowns[k].index).is_some())
                .collect();
            let changes: Vec<_> = (known.iter())
                .filter_map(|&k| parameters.change(self.unknowns[k].index))
                .map(|change| experiment.change(change, parameters.robot()))
                .collect();
            let from_gradients =
                if known.is_empty() { None } else { experiment.derivatives(solved, self.stage, &changes).ok() };
            let mut found: Vec<Option<Vec<Complex>>> = vec![None; x.len()];
            for (k, column) in known.into_iter().zip(from_gradients.into_iter().flatten()) {
                let rate = self.unknowns[k].rate(values[k]);
                found[k] = Some(column.into_iter().map(|derivative| derivative * rate).collect());
            }
            for (k, column) in found.into_iter().enumerate() {
                columns[k].extend(match column {
                    Some(column) => column,
                    None => self.differences(x, number, solved, k, STEP * self.unknowns[k].spread())?,
                });
            }
        }
        Some(columns)
    }

    /// Numbers of the robot file with values at coordinates.
    fn parameters_at(&mut self, x: &[f64]) -> Option<Parameters> {
        let text = self.text(x);
        let text = self.try_or_keep(text)?;
        self.try_or_keep(Parameters::from_toml(&text).map_err(anyhow::Error::from))
    }

    /// Derivatives of the logarithms of frequencies by all coordinates, for a range of the list of modes of each
    /// experiment: per experiment one list per mode. They follow from gradients, or from differences of the ascending
    /// list over `steps`. The list may end earlier than the range.
    pub(super) fn list_rates(
        &mut self,
        x: &[f64],
        here: &[Solved],
        ranges: &[Range<usize>],
        steps: &[f64],
    ) -> Option<Vec<Vec<Vec<f64>>>> {
        let parameters = self.parameters_at(x)?;
        let values = self.values(x);
        let changes: Option<Vec<RobotChange>> =
            self.unknowns.iter().map(|unknown| parameters.change(unknown.index)).collect();
        let mut found = Vec::with_capacity(here.len());
        for (number, (solved, range)) in here.iter().zip(ranges).enumerate() {
            let experiment = &self.experiments[number];
            let along = |change: &RobotChange| experiment.change(change.clone(), parameters.robot());
            let changes: Option<Vec<RobotChange>> = changes.as_ref().map(|changes| changes.iter().map(along).collect());
            let by_gradients =
                changes.and_then(|changes| experiment.list_derivatives(solved, range.clone(), &changes).ok());
            if let Some(mut rates) = by_gradients {
                let units = || self.unknowns.iter().zip(&values).map(|(unknown, value)| unknown.rate(*value));
                for (rate, unit) in rates.iter_mut().flat_map(|rates| rates.iter_mut().zip(units())) {
                    *rate *= unit;
                }
                found.push(rates);
                continue;
            }

            let mut rates = vec![Vec::with_capacity(x.len()); range.len()];
            for (k, step) in steps.iter().enumerate() {
                let (_, high) = self.unknowns[k].coordinate_bounds();
                let step = if x[k] + step <= high { *step } else { -*step };
                let mut moved = x.to_vec();
                moved[k] += step;
                let robot = self.robot(&moved);
                let robot = self.try_or_keep(robot)?;
                let solved_there = self.solve_one(number, robot, Some(&solved.assigned));
                let there = self.try_or_keep(solved_there)?;
                let pairs = solved.modes.0[range.clone()].iter().zip(there.modes.0.get(range.start..)?);
                let length = pairs.len();
                for ((here, there), rates) in pairs.zip(&mut rates) {
                    rates.push((there.frequency_hz / here.frequency_hz).ln() / step);
                }
                rates.truncate(length);
            }
            found.push(rates);
        }
        Some(found)
    }

    /// Derivatives of the predictions of an experiment by a coordinate, by central differences over a step; one-sided
    /// ones at a bound or beside a robot without equilibrium.
    fn differences(&mut self, x: &[f64], number: usize, here: &Solved, k: usize, step: f64) -> Option<Vec<Complex>> {
        let (low, high) = self.unknowns[k].coordinate_bounds();
        let mut at = |shift: f64| -> Option<Vec<Complex>> {
            if !(low..=high).contains(&(x[k] + shift)) {
                return None;
            }
            let mut moved = x.to_vec();
            moved[k] += shift;
            let solved = self.robot(&moved).and_then(|robot| self.solve_one(number, robot, Some(&here.assigned)));
            Some(self.try_or_keep(solved)?.values)
        };
        let (before, after) = (at(-step), at(step));
        let difference = |a: &[Complex], b: &[Complex], width: f64| {
            a.iter().zip(b).map(|(a, b)| (b - a) / width).collect::<Vec<Complex>>()
        };
        Some(match (before, after) {
            (Some(before), Some(after)) => difference(&before, &after, 2.0 * step),
            (None, Some(after)) => difference(&here.values, &after, step),
            (Some(before), None) => difference(&before, &here.values, step),
            (None, None) => return None,
        })
    }
}

impl Predicted {
    fn of(solved: &[Solved]) -> Self {
        Self {
            values: solved.iter().flat_map(|experiment| experiment.values.iter().copied()).collect(),
            assigned: solved.iter().map(|experiment| experiment.assigned.clone()).collect(),
        }
    }
}

impl LeastSquaresProblem for IdentifiedModel<'_> {
    fn residuals(&mut self, x: &[f64]) -> Option<Vec<f64>> {
        let (assigned, weights) = self.held.clone()?;
        let predicted = self.predict(x, Some(&assigned));
        let predicted = self.try_or_keep(predicted)?;
        self.residuals_of(x, &predicted.values, &weights)
    }

    fn linearised(&mut self, x: &[f64]) -> Option<(Vec<f64>, DMat)> {
        let solved = self.solve(x, None);
        let solved = self.try_or_keep(solved)?;
        let here = Predicted::of(&solved);
        let weights = weights(&self.observations, &here.values, self.stage, &self.left_out);
        let residuals = self.residuals_of(x, &here.values, &weights);
        let residuals = self.try_or_keep(residuals.ok_or_else(|| self.not_finite(&here.values)))?;
        let columns = self.derivatives(x, &solved)?;

        let mut jacobian = DMat::zeros(residuals.len(), x.len());
        let mut prior_row = residuals.len() - self.prior_count();
        for (k, changes) in columns.iter().enumerate() {
            let mut column = Vec::with_capacity(residuals.len());
            for (((observation, value), change), weight) in
                self.observations.iter().zip(&here.values).zip(changes).zip(&weights)
            {
                observation.derivatives(self.stage, *value, *change, *weight, &mut column);
            }
            for (row, value) in column.iter().enumerate() {
                jacobian[(row, k)] = *value;
            }
            if let Some((_, deviation)) = self.unknowns[k].coordinate_prior() {
                jacobian[(prior_row, k)] = 1.0 / deviation;
                prior_row += 1;
            }
        }
        if !jacobian.iter().all(|entry| entry.is_finite()) {
            return None;
        }
        self.held = Some((here.assigned, weights));
        Some((residuals, jacobian))
    }

    fn is_cancelled(&self) -> bool {
        (self.is_cancelled)()
    }
}

#[cfg(test)]
mod tests;

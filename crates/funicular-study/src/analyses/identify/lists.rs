//! Linear model of a sampled robot: all modes near the measured frequencies with their derivatives. In it, other
//! assignments and other measured frequencies cost no equilibrium.

use super::model::IdentifiedModel;
use super::observations::{ROBUST, Stage, Subject};
use crate::error::Cancelled;
use anyhow::Result;
use funicular::math::DMat;
use funicular::modes::Mode;

/// Logarithmic distance from a measured frequency up to which modes belong to the model.
const NEAR: f64 = 0.3;

/// Number of modes on either side of a measured frequency that always belong to it.
const NEIGHBOURS: usize = 3;

/// Step of the differences of a list without gradients, in spreads of the value: frequencies of the ascending list are
/// continuous, and the model is linear over far longer ways.
const STEP: f64 = 0.01;

/// Maximum number of times that modes are assigned again; two are usual.
const MAX_ROUNDS: usize = 6;

/// Ridge of the normal equations relative to their largest entry: a value that no residual sees stays.
const RIDGE: f64 = 1e-12;

/// Measured natural frequency.
#[derive(Debug, Clone)]
pub(super) struct Target {
    /// Index of the experiment.
    pub(super) experiment: usize,
    /// Logarithm of the frequency in Hz.
    pub(super) ln_hz: f64,
    /// Relative standard deviation.
    pub(super) deviation: f64,
    /// Index of its mode in the ascending list, if it has a number.
    pub(super) mode: Option<usize>,
}

/// Mode of a sampled robot.
struct ListedMode {
    /// Index in the ascending list.
    index: usize,
    ln_hz: f64,
    /// Derivatives by the coordinates.
    rates: Vec<f64>,
}

/// Robot at sampled values.
pub(super) struct ListSample {
    pub(super) x: Vec<f64>,
    /// Modes near the measured frequencies, ascending, per experiment.
    modes: Vec<Vec<ListedMode>>,
    /// Residuals of poses, tensions and lengths with their derivatives.
    statics: Vec<(f64, Vec<f64>)>,
}

/// Best values near a sample.
pub(super) struct NearBest {
    /// Sum of the squares of the residuals, priors included and damping ratios left out.
    pub(super) chi2: f64,
    pub(super) x: Vec<f64>,
    /// Index of the mode of each measured frequency.
    pub(super) partners: Vec<usize>,
}

/// Part of χ² of a residual of a frequency whose mode is found by its distance.
fn robust(residual: f64) -> f64 {
    residual * residual / (1.0 + (residual / ROBUST).powi(2))
}

/// Measured frequencies of all experiments, in the order of the observations.
pub(super) fn targets(model: &IdentifiedModel<'_>) -> Vec<Target> {
    let frequencies = model.observations.iter().filter_map(|observation| match observation.subject {
        Subject::Frequency(k) => Some((observation, k)),
        _ => None,
    });
    frequencies
        .map(|(observation, k)| {
            let number = model.experiments[observation.experiment].given.frequencies[k].number();
            Target {
                experiment: observation.experiment,
                ln_hz: observation.measured.re.ln(),
                deviation: observation.deviation,
                mode: number.map(|number| number - 1),
            }
        })
        .collect()
}

/// Range of the ascending logarithms of a list that are near the measured frequencies of an experiment.
fn near(list: &[f64], targets: &[Target], experiment: usize) -> std::ops::Range<usize> {
    let of_list = targets.iter().filter(|target| target.experiment == experiment);
    let (mut from, mut to) = (list.len(), 0);
    for target in of_list {
        let below = list.partition_point(|ln_hz| *ln_hz < target.ln_hz - NEAR);
        let at = list.partition_point(|ln_hz| *ln_hz < target.ln_hz);
        let above = list.partition_point(|ln_hz| *ln_hz < target.ln_hz + NEAR);
        from = from.min(below.min(at.saturating_sub(NEIGHBOURS))).min(target.mode.unwrap_or(from));
        to = to.max(above.max(at + NEIGHBOURS)).max(target.mode.map_or(to, |mode| mode + 1));
    }
    from..to.clamp(from, list.len().max(from))
}

impl IdentifiedModel<'_> {
    /// Linear model of the robot at coordinates; `None` if it has no equilibrium there.
    ///
    /// # Errors
    /// Work that was stopped.
    pub(super) fn sample(&mut self, x: &[f64], targets: &[Target]) -> Result<Option<ListSample>> {
        if self.is_stopped() {
            return Err(Cancelled.into());
        }
        let Ok(solved) = self.solve(x, None) else { return Ok(None) };
        let lists: Vec<Vec<f64>> = solved.iter().map(|solved| ln_hz(&solved.modes.0)).collect();
        let ranges: Vec<_> = lists.iter().enumerate().map(|(i, list)| near(list, targets, i)).collect();
        let steps: Vec<f64> = self.unknowns.iter().map(|unknown| STEP * unknown.spread()).collect();
        let Some(rates) = self.list_rates(x, &solved, &ranges, &steps) else { return Ok(None) };
        let modes = lists.iter().zip(ranges).zip(rates).map(|((list, range), rates)| {
            let of_range = range.clone().zip(&list[range]).zip(rates);
            of_range.map(|((index, ln_hz), rates)| ListedMode { index, ln_hz: *ln_hz, rates }).collect()
        });
        let modes = modes.collect();

        let mut statics = Vec::new();
        if self.observations.iter().any(|observation| observation.subject.is_static()) {
            let before = std::mem::replace(&mut self.stage, Stage::Statics);
            let columns = self.derivatives(x, &solved);
            self.stage = before;
            let Some(columns) = columns else { return Ok(None) };
            let values = solved.iter().flat_map(|solved| &solved.values);
            for (row, (observation, value)) in self.observations.iter().zip(values).enumerate() {
                if observation.subject.is_static() {
                    let residual = (value.re - observation.measured.re) / observation.deviation;
                    let rates = columns.iter().map(|column| column[row].re / observation.deviation).collect();
                    statics.push((residual, rates));
                }
            }
        }
        Ok(Some(ListSample { x: x.to_vec(), modes, statics }))
    }
}

/// Logarithms of the frequencies of a list in Hz.
fn ln_hz(list: &[Mode]) -> Vec<f64> {
    list.iter().map(|mode| mode.frequency_hz.ln()).collect()
}

impl ListSample {
    /// Best values within `reach` of each coordinate for measured frequencies; `None` if the list has too few modes.
    pub(super) fn best(
        &self,
        model: &IdentifiedModel<'_>,
        targets: &[Target],
        reach: &[f64],
        bounds: &[(f64, f64)],
    ) -> Option<NearBest> {
        let n = self.x.len();
        let mut shift = vec![0.0; n];
        let mut best: Option<NearBest> = None;
        for _ in 0..MAX_ROUNDS {
            let partners = self.partners(targets, &shift)?;
            let (chi2, hessian, gradient) = self.normal_equations(model, targets, &partners, &shift);
            let x: Vec<f64> = self.x.iter().zip(&shift).map(|(x, shift)| x + shift).collect();
            let indices =
                || (partners.iter().zip(targets)).map(|(at, target)| self.modes[target.experiment][*at].index);
            let is_same = best.as_ref().is_some_and(|best| indices().eq(best.partners.iter().copied()));
            if best.as_ref().is_none_or(|best| chi2 < best.chi2) {
                best = Some(NearBest { chi2, x, partners: indices().collect() });
            }
            let step = solve(hessian, &gradient);
            let before = shift.clone();
            for (i, shift) in shift.iter_mut().enumerate() {
                let (low, high) = (bounds[i].0 - self.x[i], bounds[i].1 - self.x[i]);
                *shift = (*shift - step[i]).clamp(low.max(-reach[i]).min(0.0), high.min(reach[i]).max(0.0));
            }
            let moved = shift.iter().zip(&before).zip(reach);
            if is_same && moved.into_iter().all(|((after, before), reach)| (after - before).abs() <= 1e-4 * reach) {
                break;
            }
        }
        best
    }

    /// Fits in which one frequency without a number belongs to another mode within `deviations`, and all others stay.
    pub(super) fn exchanges(
        &self,
        model: &IdentifiedModel<'_>,
        targets: &[Target],
        deviations: f64,
    ) -> Vec<(usize, NearBest)> {
        let none = vec![0.0; self.x.len()];
        let Some(partners) = self.partners(targets, &none) else { return Vec::new() };
        let mut found = Vec::new();
        for (k, target) in targets.iter().enumerate().filter(|(_, target)| target.mode.is_none()) {
            let taken: Vec<usize> = (partners.iter().zip(targets))
                .filter(|(_, other)| other.experiment == target.experiment)
                .map(|(at, _)| *at)
                .collect();
            for (at, mode) in self.modes[target.experiment].iter().enumerate() {
                if taken.contains(&at) || (mode.ln_hz - target.ln_hz).abs() > deviations * target.deviation {
                    continue;
                }
                let mut others = partners.clone();
                others[k] = at;
                let (_, hessian, gradient) = self.normal_equations(model, targets, &others, &none);
                let shift: Vec<f64> = solve(hessian, &gradient).into_iter().map(|step| -step).collect();
                let (chi2, ..) = self.normal_equations(model, targets, &others, &shift);
                let x = self.x.iter().zip(&shift).map(|(x, shift)| x + shift).collect();
                found.push((k, NearBest { chi2, x, partners: vec![mode.index] }));
            }
        }
        found
    }

    /// Logarithmic distance of the nearest modes from a measured frequency: that of the last of `count` modes, or of
    /// the farthest if there are fewer.
    pub(super) fn distance(&self, target: &Target, count: usize) -> f64 {
        let modes = self.modes[target.experiment].iter();
        let mut distances: Vec<f64> = modes.map(|mode| (mode.ln_hz - target.ln_hz).abs()).collect();
        distances.sort_by(f64::total_cmp);
        distances.get(count - 1).or(distances.last()).copied().unwrap_or(0.0)
    }

    /// Logarithm of the frequency of a mode after a shift.
    fn predicted(&self, experiment: usize, at: usize, shift: &[f64]) -> f64 {
        let mode = &self.modes[experiment][at];
        mode.ln_hz + mode.rates.iter().zip(shift).map(|(rate, shift)| rate * shift).sum::<f64>()
    }

    /// Place of the mode of each measured frequency in the near list: the numbered one, otherwise that of the
    /// assignment with the smallest χ² in which both lists ascend.
    fn partners(&self, targets: &[Target], shift: &[f64]) -> Option<Vec<usize>> {
        let mut partners = vec![usize::MAX; targets.len()];
        for (experiment, modes) in self.modes.iter().enumerate() {
            let of_list: Vec<usize> = (0..targets.len()).filter(|&k| targets[k].experiment == experiment).collect();
            let mut taken = vec![false; modes.len()];
            for &k in &of_list {
                if let Some(index) = targets[k].mode {
                    partners[k] = index.checked_sub(modes.first()?.index).filter(|at| *at < modes.len())?;
                    taken[partners[k]] = true;
                }
            }
            let mut open: Vec<usize> = of_list.into_iter().filter(|&k| targets[k].mode.is_none()).collect();
            open.sort_by(|a, b| targets[*a].ln_hz.total_cmp(&targets[*b].ln_hz));
            let mut free: Vec<(f64, usize)> = (0..modes.len())
                .filter(|&at| !taken[at])
                .map(|at| (self.predicted(experiment, at, shift), at))
                .collect();
            free.sort_by(|a, b| a.0.total_cmp(&b.0));
            let cost = |row: usize, column: usize| {
                let target = &targets[open[row]];
                robust((free[column].0 - target.ln_hz) / target.deviation)
            };
            for (row, column) in ascending_pairs(open.len(), free.len(), cost)?.into_iter().enumerate() {
                partners[open[row]] = free[column].1;
            }
        }
        Some(partners)
    }

    /// χ² after a shift, and matrix and right side of the normal equations.
    fn normal_equations(
        &self,
        model: &IdentifiedModel<'_>,
        targets: &[Target],
        partners: &[usize],
        shift: &[f64],
    ) -> (f64, DMat, Vec<f64>) {
        let n = shift.len();
        let (mut chi2, mut hessian, mut gradient) = (0.0, DMat::zeros(n, n), vec![0.0; n]);
        let mut add = |residual: f64, rates: &dyn Fn(usize) -> f64| {
            chi2 += residual * residual;
            for i in 0..n {
                gradient[i] += rates(i) * residual;
                for j in 0..n {
                    hessian[(i, j)] += rates(i) * rates(j);
                }
            }
        };
        for (target, at) in targets.iter().zip(partners) {
            let residual = (self.predicted(target.experiment, *at, shift) - target.ln_hz) / target.deviation;
            let weight = if target.mode.is_some() { 1.0 } else { 1.0 / (1.0 + (residual / ROBUST).powi(2)).sqrt() };
            let rates = &self.modes[target.experiment][*at].rates;
            add(weight * residual, &|i| weight * rates[i] / target.deviation);
        }
        for (residual, rates) in &self.statics {
            add(residual + rates.iter().zip(shift).map(|(rate, shift)| rate * shift).sum::<f64>(), &|i| rates[i]);
        }
        for (k, unknown) in model.unknowns.iter().enumerate() {
            if let Some((prior, deviation)) = unknown.coordinate_prior() {
                add((self.x[k] + shift[k] - prior) / deviation, &|i| f64::from(u8::from(i == k)) / deviation);
            }
        }
        (chi2, hessian, gradient)
    }
}

/// Solution of normal equations with a small ridge; zero if there is none.
fn solve(mut hessian: DMat, gradient: &[f64]) -> Vec<f64> {
    let n = gradient.len();
    let largest = (0..n).map(|i| hessian[(i, i)]).fold(0.0, f64::max);
    (0..n).for_each(|i| hessian[(i, i)] += RIDGE * largest);
    let right = DMat::from_column_slice(n, 1, gradient);
    hessian.cholesky().map_or_else(|| vec![0.0; n], |factor| factor.solve(&right).iter().copied().collect())
}

/// Column of each row in the assignment with the smallest sum of costs in which columns ascend with the rows; `None` if
/// there are fewer columns than rows. For costs that grow with the distance between ascending lists, no other one is
/// better.
fn ascending_pairs(rows: usize, columns: usize, cost: impl Fn(usize, usize) -> f64) -> Option<Vec<usize>> {
    if rows > columns {
        return None;
    }
    // Smallest sum of the first rows over the first columns.
    let mut sums = vec![vec![f64::INFINITY; columns + 1]; rows + 1];
    sums[0].fill(0.0);
    for row in 0..rows {
        for column in row..columns {
            sums[row + 1][column + 1] = sums[row + 1][column].min(sums[row][column] + cost(row, column));
        }
    }
    let mut found = vec![0; rows];
    let mut column = columns;
    for row in (0..rows).rev() {
        while column > row + 1 && sums[row + 1][column] >= sums[row + 1][column - 1] {
            column -= 1;
        }
        column -= 1;
        found[row] = column;
    }
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ascending_pairs_have_the_smallest_sum() {
        let (rows, columns): ([f64; 3], [f64; 5]) = ([1.0, 1.1, 4.0], [0.0, 1.05, 1.3, 3.0, 9.0]);
        let cost = |row: usize, column: usize| (rows[row] - columns[column]).powi(2);
        let found = ascending_pairs(3, 5, cost).unwrap();
        let sum = |columns: &[usize]| columns.iter().enumerate().map(|(row, column)| cost(row, *column)).sum::<f64>();
        let mut least = f64::INFINITY;
        for a in 0..5 {
            for b in 0..5 {
                for c in 0..5 {
                    if a != b && b != c && a != c {
                        least = least.min(sum(&[a, b, c]));
                    }
                }
            }
        }
        assert!((sum(&found) - least).abs() < 1e-12, "{found:?}");
        assert_eq!(found, [1, 2, 3]);
        assert_eq!(ascending_pairs(2, 1, cost), None);
    }
}

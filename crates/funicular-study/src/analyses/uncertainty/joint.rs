//! Numbers that deviate together: from the entries of their covariance to combinations that deviate by themselves.

use crate::names::suggestion;
use crate::request::CovarianceEntry;
use crate::set_values;
use crate::text::significant;
use anyhow::{Result, anyhow, bail};
use funicular::math::DMat;
use funicular::robot::parameters::{Parameter, Parameters};

/// Minimum eigenvalue of a matrix of correlations that counts as rounding of its entries, which files have to six
/// digits at least.
const MIN_EIGENVALUE: f64 = -1e-5;

/// Minimum eigenvalue of a combination that deviates.
const MIN_VARIANCE: f64 = 1e-12;

/// Difference of two entries of one pair that is more than rounding, relative to their size.
const ROUNDING: f64 = 1e-9;

/// Numbers with a joint normal distribution.
#[derive(Default)]
pub(super) struct JointDeviations {
    /// Numbers, in the order in which the entries name them.
    pub(super) members: Vec<Parameter>,
    /// Independent combinations of deviation 1: the change of every member, in its unit.
    pub(super) combinations: Vec<Vec<f64>>,
}

impl JointDeviations {
    /// Combinations of the numbers whose covariance has these entries: the eigenvectors of their correlations, so that
    /// units do not matter.
    ///
    /// # Errors
    /// A number that the robot does not have, two values for one pair, a negative variance, or a matrix that no random
    /// numbers have.
    pub(super) fn new(entries: &[CovarianceEntry], original: &Parameters, candidates: &[Parameter]) -> Result<Self> {
        let mut members: Vec<Parameter> = Vec::new();
        let mut given: Vec<(usize, usize, f64)> = Vec::with_capacity(entries.len());
        for (row, entry) in entries.iter().enumerate() {
            let mut place = |path: &str| -> Result<usize> {
                let found = number(path, original, candidates).map_err(|reason| at_row(row, &reason))?;
                let known = members.iter().position(|member| member.keys == found.keys);
                Ok(known.unwrap_or_else(|| {
                    members.push(found.clone());
                    members.len() - 1
                }))
            };
            let (i, j) = (place(&entry.first)?, place(&entry.second)?);
            if !entry.covariance.is_finite() {
                return Err(at_row(row, "the covariance is not a number"));
            }
            given.push((i, j, entry.covariance));
        }
        let covariance = matrix(members.len(), &given, entries)?;
        let combinations = combinations(&covariance, &members)?;
        Ok(Self { members, combinations })
    }
}

fn at_row(row: usize, reason: &str) -> anyhow::Error {
    anyhow!("⟪covariance⟫, row {}: {reason}", row + 1)
}

/// Number of a robot at a path.
fn number<'a>(path: &str, original: &Parameters, candidates: &'a [Parameter]) -> Result<&'a Parameter, String> {
    let keys = set_values::path(path)?.keys().to_vec();
    let own = original.find(&keys).map_or(keys, |index| original.list()[index].keys.clone());
    candidates.iter().find(|candidate| candidate.keys == own).ok_or_else(|| {
        let known: Vec<String> = candidates.iter().map(Parameter::path).collect();
        format!("the robot has no number `{path}`{}", suggestion(path, &known))
    })
}

/// Symmetric matrix of entries; pairs without an entry are independent.
fn matrix(count: usize, given: &[(usize, usize, f64)], entries: &[CovarianceEntry]) -> Result<DMat> {
    let mut found: Vec<Option<f64>> = vec![None; count * count];
    for (row, (i, j, value)) in given.iter().enumerate() {
        for place in [i * count + j, j * count + i] {
            if let Some(other) = found[place].filter(|other| (other - value).abs() > ROUNDING * value.abs()) {
                let CovarianceEntry { first, second, .. } = &entries[row];
                let reason = format!("{first} and {second} have {other} above and {value} here: leave out one of them");
                return Err(at_row(row, &reason));
            }
            found[place] = Some(*value);
        }
    }
    Ok(DMat::from_fn(count, count, |i, j| found[i * count + j].unwrap_or(0.0)))
}

/// Independent combinations of deviation 1.
fn combinations(covariance: &DMat, members: &[Parameter]) -> Result<Vec<Vec<f64>>> {
    let count = members.len();
    for (i, member) in members.iter().enumerate() {
        let (variance, path) = (covariance[(i, i)], member.path());
        if variance < 0.0 {
            bail!("⟪covariance⟫: the variance of {path} is {}: give a positive one", significant(variance, 3));
        }
        if variance == 0.0 && (0..count).any(|j| covariance[(i, j)] != 0.0) {
            bail!("⟪covariance⟫: {path} has no variance and still covariances: add the row {path},{path},VARIANCE");
        }
    }

    let deviations: Vec<f64> = (0..count).map(|i| covariance[(i, i)].sqrt()).collect();
    let correlation = |i: usize, j: usize| match deviations[i] * deviations[j] {
        size if size > 0.0 => covariance[(i, j)] / size,
        _ => 0.0,
    };
    let eigen = DMat::from_fn(count, count, correlation).symmetric_eigen();
    let least = eigen.eigenvalues.iter().copied().fold(f64::INFINITY, f64::min);
    if least < MIN_EIGENVALUE {
        bail!(
            "⟪covariance⟫: no random numbers have these covariances, because the least eigenvalue of their \
             correlations is {}: write all entries with all digits",
            significant(least, 3)
        );
    }
    let mut order: Vec<usize> = (0..count).filter(|k| eigen.eigenvalues[*k] > MIN_VARIANCE).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
    let combination = |k: usize| {
        let size = eigen.eigenvalues[k].sqrt();
        (0..count).map(|i| deviations[i] * eigen.eigenvectors[(i, k)] * size).collect()
    };
    Ok(order.into_iter().map(combination).collect())
}

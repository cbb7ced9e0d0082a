//! Stiffest tensions by cutting planes: slow and reliable, for cases in which Newton's method does not converge, and as
//! its oracle.
//!
//! The stiffness of straight cables is affine in the tensions (EA/L0 = (EA + T)/l along a cable, T/l across it). Its
//! minimum eigenvalue is therefore concave, and the optimum over the tensions within the limits is a convex problem in
//! any number of dimensions. It is solved by cutting planes: every eigenvector q bounds the eigenvalue from above by
//! the affine qᵀ K(τ) q. Cables that sag are linearised about the last tensions; a step that does not increase the
//! stiffness is shortened.

use super::super::null_space::Solutions;
use super::super::search::{Linear, TensionSearch};
use super::{GAIN, min_eigenvalue, present};
use crate::math::active_set::Polyhedron;
use crate::math::{Mat6, Vec6, symmetric, symmetric_part};
use crate::statics::error::StaticsError;
use crate::statics::wrench_set::CableAtPose;

/// Maximum number of linearisations; straight cables need two, sagging ones many more.
const MAX_LINEARISATIONS: usize = 60;

/// Maximum number of rounds of cuts per linearisation.
const MAX_ROUNDS: usize = 100;

/// Number of eigenvectors that cut in each round: more than one, because the two lowest eigenvalues tend to meet at the
/// optimum.
const CUTS: usize = 3;

/// Moves to the tensions within the limits with the maximum stiffness.
pub(super) fn search(search: &mut TensionSearch<'_>) -> Result<(), StaticsError> {
    search.middle()?;
    let mut best = search.tensions();
    let mut stiffness = min_eigenvalue(search);
    let mut reach = f64::INFINITY;

    for _ in 0..MAX_LINEARISATIONS {
        let linear = search.linearise();
        let (next, promised) = stiffest_of_linear(search, &linear, reach)?;
        if promised - stiffness <= GAIN * stiffness.abs() {
            break;
        }

        // Take the step if it is stiffer; otherwise shorten the next one.
        let step = next.iter().zip(&best).fold(0.0, |m: f64, (to, from)| m.max((to - from).abs()));

        let reached = match search.nearest_to(&next) {
            Ok(()) => min_eigenvalue(search),
            Err(_) => f64::NEG_INFINITY,
        };

        if reached > stiffness {
            (best, stiffness) = (search.tensions(), reached);
            reach *= 2.0;
        } else {
            search.set(&best);
            reach = 0.3 * step;
            if reach < 1e-7 * search.size() {
                break;
            }
        }
    }
    Ok(())
}

/// Stiffest tensions of the linearised robot, none further than `reach` from where it was linearised, and its stiffness
/// there.
fn stiffest_of_linear(
    search: &TensionSearch<'_>,
    linear: &Linear,
    reach: f64,
) -> Result<(Vec<f64>, f64), StaticsError> {
    let dof = search.robot().platform.motion.count();
    let here = search.tensions();
    let solutions = search.solutions(linear, &vec![1.0; here.len()])?;
    let stiffness = present(search);
    let rates = stiffness_by_tensions(search);
    // Height in the unit of tensions.
    let unit = rates.iter().fold(0.0, |m: f64, rate| m.max(rate.amax())).max(f64::MIN_POSITIVE);

    let mut set = within_reach(search, linear, &solutions, reach);

    // Cuts: in each round those of the lowest eigenvectors.
    let mut z = solutions.along(|i| here[i]);
    let mut best = (here.clone(), f64::NEG_INFINITY);

    for _ in 0..MAX_ROUNDS {
        let tau = solutions.at(&z);
        let mut there = stiffness;
        for ((rate, to), from) in rates.iter().zip(&tau).zip(&here) {
            there += rate * (to - from);
        }

        let (values, vectors) = symmetric::eigen(&there, dof);
        if values[0] > best.1 {
            best = (tau, values[0]);
        }

        // Each eigenvector bounds the stiffness from above.
        for q in vectors.iter().take(CUTS) {
            let slopes: Vec<f64> = rates.iter().map(|rate| q.dot(&(rate * q)) / unit).collect();
            let level = form(&stiffness, q) / unit
                + slopes.iter().zip(&solutions.particular).zip(&here).map(|((g, p), t)| g * (p - t)).sum::<f64>();
            let normal = solutions.along(|i| slopes[i]);
            set.add(normal.iter(), 1.0, Some(-1.0), -level);
        }

        // Highest point under all cuts.
        let height = best.1 / unit;
        let mut point = z.clone();
        point.push(height);
        let tolerance = 1e-12 * (search.size() + stiffness.amax() / unit);
        if set.highest(&mut point, tolerance).is_none() {
            break;
        }

        let bound = point.pop().unwrap_or(height);
        z = point;
        if bound - height <= 0.1 * GAIN * height.abs() + tolerance {
            break;
        }
    }
    Ok(best)
}

/// Derivative of the stiffness of the robot by the tension of each cable.
fn stiffness_by_tensions(search: &TensionSearch<'_>) -> Vec<Mat6> {
    let motion = search.robot().platform.motion;
    let rate = |cable: &CableAtPose| motion.reduced_matrix(&symmetric_part(&cable.stiffness_by_tension()));
    search.cables().iter().map(rate).collect()
}

/// Limits of the tensions, none further than `reach` from the present ones; the last coordinate is the height.
fn within_reach(search: &TensionSearch<'_>, linear: &Linear, solutions: &Solutions, reach: f64) -> Polyhedron {
    let here = search.tensions();
    let mut set = Polyhedron::new(solutions.redundancy() + 1);
    for (i, [lower, upper]) in linear.limits.iter().enumerate() {
        let particular = solutions.particular[i];
        let least = lower.at.max(search.cables()[i].slackest).max(here[i] - reach);
        let most = upper.at.min(here[i] + reach);
        set.add(solutions.part(i), 1.0, Some(0.0), least - particular);
        set.add(solutions.part(i), -1.0, Some(0.0), particular - most);
    }

    set
}

fn form(matrix: &Mat6, q: &Vec6) -> f64 {
    q.dot(&(matrix * q))
}

//! Stiffest tensions: maximum of the minimum eigenvalue of the scaled stiffness.
//!
//! The minimum eigenvalue has a second-order model that costs the eigenvectors of one 6×6 matrix, see [`model`]. So the
//! optimum is found by Newton's method, with one small optimisation problem per step. If that does not converge,
//! cutting planes are used.

mod cutting_planes;
mod model;

use super::search::TensionSearch;
use crate::math::{Mat6, symmetric, symmetric_part};
use crate::platform::Coordinates;
use crate::statics::error::StaticsError;
use crate::statics::stiffness::assembled;
use model::{Model, StiffeningStep};

/// Relative gain of stiffness that is not worth a step.
const GAIN: f64 = 3e-8;

/// Maximum number of Newton steps; a handful is usual, more if eigenvalues meet.
const MAX_STEPS: usize = 40;

/// Minimum fraction of a step that is tried.
const MIN_STEP: f64 = 1e-3;

/// Moves to the tensions within the limits with the maximum stiffness.
pub(super) fn search(search: &mut TensionSearch<'_>) -> Result<(), StaticsError> {
    search.near_middle()?;
    survey(search)?;
    if climb(search) { Ok(()) } else { cutting_planes::search(search) }
}

/// Moves to the stiffest of a few tensions: the present ones and those half-way from them to the limits, both ways
/// along every direction. With sagging ropes there are several optima; this starts near a high one.
fn survey(search: &mut TensionSearch<'_>) -> Result<(), StaticsError> {
    let linear = search.linearise();
    let middle = search.tensions();
    let solutions = search.solutions(&linear, &vec![1.0; middle.len()])?;
    let mut best = (min_eigenvalue(search), middle.clone());

    for k in 0..solutions.redundancy() {
        for sign in [1.0, -1.0] {
            let direction: Vec<f64> = solutions.direction(k).iter().map(|n| sign * n).collect();
            let cables = linear.limits.iter().zip(&direction).zip(&middle);
            let room = cables.fold(f64::INFINITY, |room, (([lower, upper], n), tau)| match n {
                n if *n > 0.0 => room.min((upper.at - tau) / n),
                n if *n < 0.0 => room.min((lower.at - tau) / n),
                _ => room,
            });
            let there: Vec<f64> = middle.iter().zip(&direction).map(|(tau, n)| tau + 0.5 * room * n).collect();
            search.set(&there);
            if is_above(search, best.0) {
                best = (min_eigenvalue(search), there);
            }
        }
    }

    search.set(&best.1);
    Ok(())
}

/// Start of a step.
struct Start {
    tau: Vec<f64>,
    value: f64,
    step: StiffeningStep,
}

impl Start {
    /// Restores the balance and adds this fraction of the stiffening part of the step.
    fn go(&self, search: &mut TensionSearch<'_>, part: f64) {
        let step = self.step.restoring.iter().zip(&self.step.stiffening);
        let tau: Vec<f64> = self.tau.iter().zip(step).map(|(from, (to, on))| from + to + part * on).collect();
        search.set(&tau);
    }
}

/// Newton's method from the present tensions; true if it converges.
fn climb(search: &mut TensionSearch<'_>) -> bool {
    let dof = search.robot().platform.motion.count();
    let mut last: Option<Start> = None;
    let mut part = 1.0;

    for _ in 0..MAX_STEPS {
        search.count();
        let stiffness = present(search);
        let eigen = symmetric::eigen(&stiffness, dof);

        // A loss this large does not come from the small imbalance: the model need not be made.
        let lost = last.as_ref().is_some_and(|last| eigen.0[0] < last.value - last.step.gain);
        let here = if lost { None } else { Model::here(search, &stiffness, eigen) };

        let enough = |last: &Start, value: f64| value >= last.value + 0.1 * part * last.step.gain;
        let Some(here) = here.filter(|here| last.as_ref().is_none_or(|last| enough(last, here.value))) else {
            part *= 0.3;
            let Some(last) = last.as_ref().filter(|_| part >= MIN_STEP) else { return false };
            last.go(search, part);
            continue;
        };

        let weights = here.weights(last.as_ref().map(|last| &last.step.weights));
        let Some(step) = here.step(search, &weights) else { return false };
        let arrived = step.gain <= GAIN * here.value.abs() + here.rounding;

        let start = Start { tau: search.tensions(), value: here.value, step };
        part = 1.0;
        // If the step's change is only rounding, restore the balance alone.
        start.go(search, if start.step.gain > 0.0 { part } else { 0.0 });
        if arrived {
            return search.settle();
        }
        last = Some(start);
    }
    false
}

/// Scaled stiffness of the robot at the present tensions, in the platform's coordinates.
fn present(search: &TensionSearch<'_>) -> Mat6 {
    let cables = search.cables().iter().map(|cable| {
        let (force, lever) = cable.force();
        (cable.hanging.tangent_w(), force, lever)
    });
    let total = Coordinates::of(search.robot()).scale_matrix(&assembled(search.robot(), search.pose(), cables));
    search.robot().platform.motion.reduced_matrix(&symmetric_part(&total))
}

fn min_eigenvalue(search: &TensionSearch<'_>) -> f64 {
    symmetric::eigenvalues(&present(search), search.robot().platform.motion.count())[0]
}

/// True if the minimum eigenvalue is above a value; takes a fraction of its time.
fn is_above(search: &TensionSearch<'_>, value: f64) -> bool {
    let dof = search.robot().platform.motion.count();
    let mut above = present(search);
    for k in 0..6 {
        above[(k, k)] += if k < dof { -value } else { 1.0 };
    }
    above.cholesky().is_some()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::{Pose, Robot, TensionLimits};
    use crate::statics::StaticModel;
    use crate::statics::tension::CableAtPose;

    const COGIRO: &str = funicular_robots::COGIRO;
    const CAROCA: &str = funicular_robots::CAROCA;
    const POINT: &str = funicular_robots::SAP2000_8_CABLE_POINT_MASS;

    /// Robots with other ropes, masses per length [kg/m] and stiffnesses [N], and poses without pattern.
    fn cases(ropes: [(f64, f64); 3]) -> impl Iterator<Item = (Robot, Pose)> {
        let boxes = [
            (COGIRO, [50.0, 1500.0], [0.0, 0.0, 2.0], [6.0, 4.0, 1.5], 10.0),
            (CAROCA, [30.0, 1000.0], [0.0, 0.0, 1.0], [2.0, 1.5, 0.8], 5.0),
            (POINT, [20.0, 400.0], [1.0, 1.0, 1.2], [0.8, 0.8, 0.8], 0.0),
        ];
        boxes.into_iter().zip(ropes).flat_map(
            |((text, [minimum, maximum], middle, reach, angle), (mass, stiffness))| {
                let mut robot = Robot::from_toml(text).unwrap();
                for cable in &mut robot.cables {
                    (cable.material.mass_per_length, cable.material.axial_stiffness) = (mass, stiffness);
                }
                let limits = TensionLimits { minimum: Some(minimum), maximum: Some(maximum) };
                let robot = robot.with_tension_limits(limits);
                (1..=100u32).map(move |i| {
                    let part = |square: f64| 2.0 * (f64::from(i) * square.sqrt()).fract() - 1.0;
                    let at = std::array::from_fn(|k| middle[k] + reach[k] * part([2.0, 3.0, 5.0][k]));
                    (robot.clone(), Pose::new(at, [7.0, 11.0, 13.0].map(|square| angle * part(square))))
                })
            },
        )
    }

    fn begun<'a>(robot: &'a Robot, pose: &'a Pose) -> Option<TensionSearch<'a>> {
        let coordinates = Coordinates::of(robot);
        let cable = |i| CableAtPose::new(robot, i, pose, StaticModel::Catenary, coordinates);
        let mut search =
            TensionSearch::new(robot, pose, StaticModel::Catenary, (0..robot.cables.len()).map(cable).collect());
        search.middle().ok()?;
        Some(search)
    }

    /// Straight cables have one optimum; with soft ones, of rubber, eigenvalues meet there.
    #[test]
    fn newtons_method_finds_what_cutting_planes_find() {
        let (mut tried, mut meeting) = (0, 0);
        for (robot, pose) in cases([(0.0, 820e3); 3]).chain(cases([(0.0, 2e3); 3])) {
            let Some(mut search) = begun(&robot, &pose) else { continue };
            assert!(climb(&mut search), "{}: {pose:?}", robot.name);
            let values = symmetric::eigenvalues(&present(&search), robot.platform.motion.count());
            let mut oracle = begun(&robot, &pose).unwrap();
            cutting_planes::search(&mut oracle).unwrap();
            let gap = values[0] / min_eigenvalue(&oracle) - 1.0;
            assert!(gap.abs() < 1e-7, "{}: {gap:e} at {pose:?}", robot.name);
            tried += 1;
            meeting += usize::from(values[1] < values[0] * (1.0 + 1e-6));
        }
        assert!(tried > 300 && meeting > 10, "{tried} {meeting}");
    }

    /// Sagging cables may have several optima, and either method may end in the lower one.
    #[test]
    fn with_sagging_ropes_newtons_method_arrives_no_lower_than_cutting_planes_on_the_whole() {
        let (mut tried, mut ratios) = (0, 0.0);
        for (robot, pose) in cases([(0.064, 820e3), (0.064, 820e3), (0.0256, 2e6)]) {
            let Some(mut oracle) = begun(&robot, &pose) else { continue };
            cutting_planes::search(&mut oracle).unwrap();
            let mut found = begun(&robot, &pose).unwrap();
            found.near_middle().unwrap();
            survey(&mut found).unwrap();
            assert!(climb(&mut found), "{}: {pose:?}", robot.name);
            ratios += min_eigenvalue(&found) / min_eigenvalue(&oracle);
            tried += 1;
        }
        assert!(tried > 150 && ratios > f64::from(tried) * (1.0 - 1e-6), "{tried} {ratios}");
    }
}

//! Ropes over sheaves at rest: how each divides its unstrained length among its cables.
//!
//! With the platform held, the energy of a rope is a function of the lengths of its cables, whose sum is given. Without
//! friction the rope rests where this energy has its minimum: the sum Φ = ψ(T) + q·p, ψ(T) = T + T²/2EA, is equal at
//! the platform ends of all its cables. To the platform the rope has still an energy, whose second derivative is that
//! of the cables with their lengths held, less what the running of the rope takes away (docs/theory.md, equations (92d)
//! to (92f)).

use super::equilibrium::CableState;
use super::error::{RopeRefusal, StaticsError};
use super::loaded_cable::LoadedCable;
use super::model::StaticModel;
use crate::catenary::space::HangingCable;
use crate::drive::CableAtRest;
use crate::math::{DMat, Mat6, Vec3, Vec6};
use crate::platform::wrench_of;
use crate::robot::{Pose, Robot, RopeOverSheaves};

/// Maximum number of Newton steps for the lengths of a rope, a guard: three to six are usual.
const MAX_STEPS: usize = 100;

/// Maximum number of halvings of a step that gains nothing.
const MAX_HALVINGS: usize = 40;

/// Minimum ratio of a length after a step to that before.
const MIN_SHORTENED: f64 = 0.2;

/// Resistance of a cable to a change of its length, over its tension and weight per length, that is assumed where it is
/// lower: a loop of rope that gets heavier with its length has a negative one.
const MIN_RESISTANCE: f64 = 0.1;

/// Imbalance of the cables of a rope, over the size of Φ, below which a step that gains nothing is not halved: rounding
/// allows no better balance.
const NEARLY_BALANCED: f64 = 1e-9;

/// Minimum decrease of the energy as a fraction of that expected to first order, and maximum ratio of the imbalance
/// after a step to that before, for a step that is taken.
const ARMIJO: f64 = 1e-4;
const MAX_IMBALANCE_RATIO: f64 = 0.9;

/// Imbalance of a rope in balance: over the size of Φ, and over the axial stiffness, whose rounding it is.
const BALANCED: f64 = 1e-8;
const BALANCED_STIFF: f64 = 1e-12;

/// End of a cable at the platform, at which rope runs into it.
#[derive(Debug, Clone, Copy)]
pub(super) struct RunningEnd {
    /// Derivative of the force on the platform by the length [N/m].
    by_length_w: Vec3,
    lever_w: Vec3,
    /// ψ(T) + q·(p − p₀), p₀ being any fixed point [N].
    potential: f64,
    /// Minus its derivative by the length [N/m].
    resistance: f64,
}

impl RunningEnd {
    fn new(span: &HangingCable, by_length_w: Vec3, lever_w: Vec3, origin_w: &Vec3) -> Self {
        let force_w = span.force_on_start_w();
        let (tension, axial_stiffness) = (force_w.norm(), span.catenary.rope().axial_stiffness);
        let stretch = 1.0 + tension / axial_stiffness;
        let along = if tension > 0.0 { force_w.dot(&by_length_w) / tension } else { 0.0 };
        let lifted = span.load_w().dot(&(span.start_w - origin_w));
        let potential = tension * (1.0 + 0.5 * tension / axial_stiffness) + lifted;
        Self { by_length_w, lever_w, potential, resistance: -stretch * along }
    }

    /// End of a cable that hangs at a pose.
    pub(super) fn of_trial(cable: &CableAtRest, pose: &Pose) -> Self {
        let origin_w = pose.position_w;
        Self::new(&cable.span, cable.force_by_length_w(), cable.span.start_w - origin_w, &origin_w)
    }

    /// End of a cable at equilibrium; `None` for a rigid cable.
    pub(super) fn of_state(state: &CableState) -> Option<Self> {
        let span = state.hanging.as_ref()?;
        Some(Self::new(span, state.force_by_length_w()?, state.lever_w, &(state.attachment_w - state.lever_w)))
    }

    /// Wrench on the platform per length [N/m, N].
    fn wrench(&self) -> Vec6 {
        wrench_of(&self.by_length_w, &self.lever_w)
    }
}

/// Stiffness that the platform loses because ropes run between the cables of each part: 6×6 about the platform origin,
/// world axes. `ends` has all cables of the robot.
///
/// # References
/// docs/theory.md, equation (92f).
pub(super) fn lost_stiffness<'a>(parts: impl Iterator<Item = &'a [usize]>, ends: &[RunningEnd]) -> Mat6 {
    let mut lost = Mat6::zeros();
    for part in parts {
        let Some((last, others)) = part.split_last() else { continue };
        let last = &ends[*last];
        let columns: Vec<Vec6> = others.iter().map(|i| ends[*i].wrench() - last.wrench()).collect();
        let resistance = DMat::from_fn(others.len(), others.len(), |k, j| {
            last.resistance + if k == j { ends[others[k]].resistance } else { 0.0 }
        });
        // Slack ropes have no resistance and no force that depends on it.
        let Some(compliance) = resistance.try_inverse() else { continue };
        for (k, a) in columns.iter().enumerate() {
            for (j, b) in columns.iter().enumerate() {
                lost += a * b.transpose() * compliance[(k, j)];
            }
        }
    }
    lost
}

/// Such a stiffness at an equilibrium for small motions, in which sheaves with friction stay at rest; `None` for ideal
/// cables.
pub(super) fn lost_at_rest(robot: &Robot, cables: &[CableState]) -> Option<Mat6> {
    let ends: Option<Vec<RunningEnd>> = cables.iter().map(RunningEnd::of_state).collect();
    Some(lost_stiffness(robot.ropes.iter().flat_map(RopeOverSheaves::running_parts), &ends?))
}

/// Change of the platform's wrench per length of rope that is added to a rope [N/m, N].
pub(super) fn wrench_by_length(cables: &[usize], ends: &[RunningEnd]) -> Vec6 {
    // With equal changes of Φ each cable takes a share in proportion to its compliance.
    let compliance = |i: &usize| 1.0 / ends[*i].resistance;
    let sum: f64 = cables.iter().map(compliance).sum();
    cables.iter().map(|i| ends[*i].wrench() * (compliance(i) / sum)).sum()
}

/// Potential energy that the references of cables with drives leave out [J]: rope that runs from one cable into another
/// has to be counted from the same height in both. Zero without ropes over sheaves.
pub(super) fn energy_of_references(robot: &Robot, cables: &[CableAtRest], lengths: &[f64]) -> f64 {
    let of = |i: &usize| {
        let cable = &cables[*i];
        let from_entry = cable.drive.as_ref().map_or(0.0, |_| 1.0);
        -from_entry * cable.span.load_w().dot(&robot.cables[*i].anchor.point_w) * lengths[*i]
    };
    robot.ropes.iter().flat_map(|rope| &rope.cables).map(of).sum()
}

/// Unstrained lengths of all cables of a robot at a pose, each rope over sheaves divided among its cables [m].
pub(super) fn divided(robot: &Robot, loaded: &[LoadedCable], lengths: &[f64], pose: &Pose) -> Vec<f64> {
    let mut divided = lengths.to_vec();
    for rope in &robot.ropes {
        let total: f64 = rope.cables.iter().map(|i| lengths[*i]).sum();
        let division = Division { robot, loaded, pose, cables: &rope.cables };
        for (i, length) in rope.cables.iter().zip(division.lengths(total)) {
            divided[*i] = length;
        }
    }
    divided
}

/// Refuses a rope whose cables are not in balance with each other.
///
/// # Errors
/// [`StaticsError::RopeUnbalanced`].
pub(super) fn check_balance(robot: &Robot, cables: &[CableState]) -> Result<(), StaticsError> {
    for rope in &robot.ropes {
        let ends: Vec<RunningEnd> = rope.cables.iter().filter_map(|i| RunningEnd::of_state(&cables[*i])).collect();
        let (low, high) = ends.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), end| {
            (low.min(end.potential), high.max(end.potential))
        });
        let first = rope.cables[0];
        let axial_stiffness = robot.cables[first].material.axial_stiffness;
        if high - low > BALANCED * low.abs().max(high.abs()) + BALANCED_STIFF * axial_stiffness {
            let cable = robot.cables[first].name.clone();
            return Err(StaticsError::RopeUnbalanced { cable, difference: high - low });
        }
    }
    Ok(())
}

/// Rope with the platform held at a pose.
struct Division<'a> {
    robot: &'a Robot,
    loaded: &'a [LoadedCable<'a>],
    pose: &'a Pose,
    /// Indices of its cables.
    cables: &'a [usize],
}

/// Rope with lengths of its cables.
struct DividedRope {
    lengths: Vec<f64>,
    ends: Vec<RunningEnd>,
    /// Tension and weight of each cable at the platform [N], by which its resistance is judged.
    sizes: Vec<f64>,
    energy: f64,
    /// Difference between the largest and the smallest Φ [N].
    imbalance: f64,
}

impl Division<'_> {
    fn at(&self, lengths: Vec<f64>) -> DividedRope {
        let (mut ends, mut sizes, mut energy) = (Vec::new(), Vec::new(), 0.0);
        for (&i, &length) in self.cables.iter().zip(&lengths) {
            let cable = self.loaded[i].hang(self.pose, length);
            let load_w = cable.span.load_w();
            energy += cable.energy();
            if cable.drive.is_some() {
                energy -= load_w.dot(&self.robot.cables[i].anchor.point_w) * length;
            }
            ends.push(RunningEnd::of_trial(&cable, self.pose));
            sizes.push(cable.force_w().norm() + load_w.norm() * length);
        }
        let potentials = || ends.iter().map(|end: &RunningEnd| end.potential);
        let imbalance = potentials().fold(f64::NEG_INFINITY, f64::max) - potentials().fold(f64::INFINITY, f64::min);
        DividedRope { lengths, ends, sizes, energy, imbalance }
    }

    /// Lengths of the cables in balance, whose sum is `total` [m].
    fn lengths(&self, total: f64) -> Vec<f64> {
        // Straight cables of one tension. Without weight and with rigid winches this is the solution.
        let straight: Vec<f64> = self.cables.iter().map(|i| self.robot.cables[*i].straight_length(self.pose)).collect();
        let sum: f64 = straight.iter().sum();
        if sum == 0.0 {
            return vec![total / self.cables.len() as f64; self.cables.len()];
        }
        let mut here = self.at(straight.iter().map(|length| length * total / sum).collect());

        for _ in 0..MAX_STEPS {
            let size = here
                .ends
                .iter()
                .zip(&here.sizes)
                .fold(0.0, |most: f64, (end, size)| most.max(end.potential.abs()).max(*size));
            if here.imbalance <= f64::EPSILON * size {
                break;
            }

            // Newton's step, and the decrease of the energy along it.
            let (step, slope) = here.step();
            let halvings = if here.imbalance <= NEARLY_BALANCED * size { 0 } else { MAX_HALVINGS };
            let mut part = 1.0;
            let mut taken = None;
            for _ in 0..=halvings {
                let mut lengths: Vec<f64> =
                    here.lengths.iter().zip(&step).map(|(length, step)| length + part * step).collect();
                let last = lengths.len() - 1;
                lengths[last] = total - lengths[..last].iter().sum::<f64>();
                let next = self.at(lengths);
                let gains = next.energy <= here.energy - ARMIJO * part * slope && halvings > 0;
                if gains || next.imbalance < MAX_IMBALANCE_RATIO * here.imbalance {
                    taken = Some(next);
                    break;
                }
                part *= 0.5;
            }
            let Some(next) = taken else { break };
            here = next;
        }
        here.lengths
    }
}

impl DividedRope {
    /// Newton's step towards equal Φ with the sum of the lengths held, limited; and the decrease of the energy along it
    /// to first order [J].
    fn step(&self) -> (Vec<f64>, f64) {
        let compliances: Vec<f64> = (self.ends.iter().zip(&self.sizes).zip(&self.lengths))
            .map(|((end, size), length)| {
                1.0 / end.resistance.max(MIN_RESISTANCE * size / length).max(f64::MIN_POSITIVE)
            })
            .collect();
        let weighted: f64 = self.ends.iter().zip(&compliances).map(|(end, c)| end.potential * c).sum();
        let mean = weighted / compliances.iter().sum::<f64>();
        let mut step: Vec<f64> =
            self.ends.iter().zip(&compliances).map(|(end, c)| (end.potential - mean) * c).collect();
        let excess = (step.iter().zip(&self.lengths))
            .fold(1.0, |most: f64, (step, length)| most.max(-step / ((1.0 - MIN_SHORTENED) * length)));
        for step in &mut step {
            *step /= excess;
        }
        let slope = self.ends.iter().zip(&step).map(|(end, step)| end.potential * step).sum();
        (step, slope)
    }
}

/// Refuses cases that are not computed with ropes over sheaves: rigid cables, and wind whose drag turns with them.
///
/// # Errors
/// [`StaticsError::RopeOverSheaves`].
pub(super) fn check(robot: &Robot, model: StaticModel) -> Result<(), StaticsError> {
    let reason = match model {
        StaticModel::Ideal => RopeRefusal::Ideal,
        StaticModel::Catenary if robot.wind_turns_with_cables() => RopeRefusal::Wind,
        StaticModel::Spring | StaticModel::Catenary => return Ok(()),
    };
    refuse(robot, reason)
}

/// Refuses a robot with ropes over sheaves.
///
/// # Errors
/// [`StaticsError::RopeOverSheaves`].
pub(super) fn refuse(robot: &Robot, reason: RopeRefusal) -> Result<(), StaticsError> {
    match robot.ropes.first() {
        Some(rope) => Err(StaticsError::RopeOverSheaves { cable: robot.cables[rope.cables[0]].name.clone(), reason }),
        None => Ok(()),
    }
}

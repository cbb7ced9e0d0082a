//! Flexible supports at rest: each yields until its stiffness balances the forces of its cables.
//!
//! With the platform held, the energy of the cables and of one support is a function of its displacement e alone. So a
//! support settles by Newton's method in three unknowns, and to the platform a cable on a support has still an energy,
//! whose second derivative is the stiffness below (docs/theory.md, equations (90) and (91)).

use super::equilibrium::{CableState, Equilibrium};
use super::error::StaticsError;
use super::loaded_cable::LoadedCable;
use crate::catenary::space::HangingCable;
use crate::drive::{self, CableAtRest, DriveAtRest, DrumSideAtRest, OnSupport};
use crate::math::{Mat3, Mat6, Vec3, Vec6};
use crate::platform::wrench_columns;
use crate::robot::{Anchor, Pose, Robot, Support};
use std::borrow::Cow;

/// Maximum number of Newton steps for the balance of a support, a guard: two to six are usual.
const MAX_STEPS: usize = 60;

/// Maximum number of halvings of a step that does not reduce the imbalance.
const MAX_HALVINGS: usize = 30;

/// Maximum number of rounds at a pose, a guard. Each round displaces the supports by the forces of the round before. It
/// reduces their motion by the ratio of the tension over the length of a cable to the stiffness of its support.
const MAX_ROUNDS: usize = 60;

/// Convergence: maximum motion of a support in a round, over the length of the longest cable. Rounding of the forces
/// leaves 1e-16 of the displacement.
const CONVERGED: f64 = 1e-15;

/// Maximum residual force on a support that is in balance, over the forces on it. Rounding of the chords leaves 1e-16
/// times the stiffness over the tensions.
const BALANCED: f64 = 1e-15;

/// Residual force, over the forces on the support, below which a step that does not reduce it is not halved: rounding
/// allows no better balance.
const NEARLY_BALANCED: f64 = 1e-9;

/// Displacements of all supports of a robot at an equilibrium, in the order of [`Robot::supports`] [m].
fn displacements(robot: &Robot, cables: &[CableState]) -> Vec<Vec3> {
    let mut all = vec![Vec3::zeros(); robot.supports.len()];
    for (cable, state) in robot.cables.iter().zip(cables) {
        if let Some(support) = cable.anchor.support {
            all[support] = state.displacement_w;
        }
    }
    all
}

impl Equilibrium {
    /// Robot with rigid supports at their displaced positions of this equilibrium; the robot itself if it has no
    /// flexible supports.
    pub fn settled<'a>(&self, robot: &'a Robot) -> Cow<'a, Robot> {
        if robot.has_supports() {
            Cow::Owned(robot.displaced(&displacements(robot, &self.cables)))
        } else {
            Cow::Borrowed(robot)
        }
    }

    /// Displacement of each support of a robot at this equilibrium, in the order of [`Robot::supports`], world axes
    /// [m].
    pub fn support_displacements(&self, robot: &Robot) -> Vec<Vec3> {
        displacements(robot, &self.cables)
    }
}

/// Cable on a support, at rest.
struct SupportedCable<'a> {
    anchor: &'a Anchor,
    support: &'a Support,
    displacement_w: Vec3,
    force_on_platform_w: Vec3,
    /// Weight of the cable that the support carries, with other loads along the cable [N].
    load_w: Vec3,
    tension_drum: f64,
}

impl<'a> SupportedCable<'a> {
    fn new(
        (anchor, support): (&'a Anchor, &'a Support),
        displacement_w: Vec3,
        force_on_platform_w: Vec3,
        (span, drive): (Option<&HangingCable>, Option<&DriveAtRest>),
        unstrained_length: f64,
    ) -> Self {
        // The weight of a drum side that comes from the ground is not the support's.
        let from_ground = support.drum_side_from_ground(anchor).map_or(0.0, |_| anchor.drum_side_length());
        let load_w = span.map_or_else(Vec3::zeros, HangingCable::load_w) * (unstrained_length - from_ground);
        let tension_drum = drive.map_or_else(|| force_on_platform_w.norm(), |drive| drive.tension_drum);
        Self { anchor, support, displacement_w, force_on_platform_w, load_w, tension_drum }
    }

    /// Cable of a robot at rest on its support; `None` if its anchor is rigid.
    fn of_state(robot: &'a Robot, i: usize, state: &CableState) -> Option<Self> {
        let anchor = &robot.cables[i].anchor;
        let support = &robot.supports[anchor.support?];
        let parts = (state.hanging.as_ref(), state.drive.as_deref());
        let force_w = state.force_on_platform_w;
        Some(Self::new((anchor, support), state.displacement_w, force_w, parts, state.unstrained_length))
    }

    /// Cable that hangs with its support at its displacement in `displacements_w`; `None` if its anchor is rigid.
    fn of_trial(
        robot: &'a Robot,
        i: usize,
        cable: &CableAtRest,
        unstrained_length: f64,
        displacements_w: &[Vec3],
    ) -> Option<Self> {
        let anchor = &robot.cables[i].anchor;
        let support = anchor.support?;
        let (parts, of) = ((Some(&cable.span), cable.drive.as_deref()), (anchor, &robot.supports[support]));
        Some(Self::new(of, displacements_w[support], cable.force_w(), parts, unstrained_length))
    }

    /// Drum side, if the drum is on the ground.
    fn drum_side(&self) -> Option<DrumSideAtRest> {
        let side_w = self.support.drum_side_from_ground(self.anchor)? * self.anchor.drum_side_length();
        let (length, tension) = ((side_w + self.displacement_w).norm(), self.tension_drum);
        Some(DrumSideAtRest { direction_w: (side_w + self.displacement_w) / length, length, tension })
    }

    /// Force of the cable on its support [N].
    fn force_w(&self) -> Vec3 {
        let at_drum = self.drum_side().map_or_else(Vec3::zeros, |side| side.direction_w * side.tension);
        self.load_w - self.force_on_platform_w - at_drum
    }
}

/// Equilibrium with the displacements of its supports [m]; none for a rigid frame.
pub(super) fn displaced(robot: &Robot, mut equilibrium: Equilibrium, displacements_w: &[Vec3]) -> Equilibrium {
    displace(robot, &mut equilibrium.cables, displacements_w);
    equilibrium
}

/// Gives the states of cables the displacements of their supports [m]; none for a rigid frame.
fn displace(robot: &Robot, cables: &mut [CableState], displacements_w: &[Vec3]) {
    for (state, cable) in cables.iter_mut().zip(&robot.cables) {
        if let Some(displacement_w) = cable.anchor.support.and_then(|support| displacements_w.get(support)) {
            state.displacement_w = *displacement_w;
        }
    }
}

/// Displacement of each support by the forces of its cables, and the maximum of the distances from the present
/// displacements [m].
fn displaced_by_forces(robot: &Robot, cables: &[CableState], displacements_w: &[Vec3]) -> (Vec<Vec3>, f64) {
    let next: Vec<Vec3> = (robot.supports.iter().zip(forces(robot, cables)))
        .map(|(support, force_w)| support.stiffness_w.try_inverse().unwrap_or_else(Mat3::zeros) * force_w)
        .collect();
    let moved = next.iter().zip(displacements_w).map(|(next, here)| (next - here).norm()).fold(0.0, f64::max);
    (next, moved)
}

/// Result on flexible supports of a solver for rigid ones. Each round solves with the supports held where the forces of
/// the round before displace them, in the first round where they are with the cables of `start`. `cables` gives access
/// to the cables of a result.
///
/// # Errors
/// Errors of `solve`; [`StaticsError::NotConverged`].
pub(super) fn on_flexible_supports<T>(
    robot: &Robot,
    solve: impl Fn(&Robot) -> Result<T, StaticsError>,
    cables: impl Fn(&mut T) -> &mut Vec<CableState>,
    start: &[CableState],
) -> Result<T, StaticsError> {
    let mut displacements_w = displacements(robot, start);
    let (mut moved, mut at_w) = (f64::INFINITY, Vec3::zeros());

    for _ in 0..MAX_ROUNDS {
        // Solve with rigid supports.
        let mut found = solve(&robot.displaced(&displacements_w))?;
        let states = cables(&mut found);
        displace(robot, states, &displacements_w);

        // Displace the supports. The rounds end where only rounding moves them.
        let before = moved;
        let next;
        (next, moved) = displaced_by_forces(robot, states, &displacements_w);
        let size = states.iter().map(CableState::chord).fold(0.0, f64::max);
        at_w = states.first().map_or(at_w, |state| state.attachment_w);
        if moved <= CONVERGED * size || (moved < CONVERGED.sqrt() * size && moved >= before) {
            return Ok(found);
        }
        displacements_w = next;
    }
    let (iterations, residual, limit) = (MAX_ROUNDS, moved, CONVERGED);
    Err(StaticsError::NotConverged { iterations, residual, limit, x: at_w.x, y: at_w.y, z: at_w.z })
}

/// Force of all cables on each support of a robot [N].
fn forces(robot: &Robot, cables: &[CableState]) -> Vec<Vec3> {
    let mut all = vec![Vec3::zeros(); robot.supports.len()];
    for (i, state) in cables.iter().enumerate() {
        if let (Some(support), Some(carried)) =
            (robot.cables[i].anchor.support, SupportedCable::of_state(robot, i, state))
        {
            all[support] += carried.force_w();
        }
    }
    all
}

/// Static stiffness of cable `i` for a motion of its support; `None` if its anchor is rigid. `held` is the stiffness of
/// its span.
pub(crate) fn on_support(robot: &Robot, i: usize, state: &CableState, held: &Mat3) -> Option<OnSupport> {
    let carried = SupportedCable::of_state(robot, i, state)?;
    Some(drive::on_support(held, state.drive.as_deref(), carried.drum_side()))
}

/// Direction of the drum side of cable `i` from the ground to its support, unit vector, world axes, and derivative of
/// the tension at the drum with respect to the unstrained length [N/m], both ends held. `None` unless the drum is on
/// the ground.
pub(super) fn pull_by_length(robot: &Robot, i: usize, state: &CableState) -> Option<(Vec3, f64)> {
    let side = SupportedCable::of_state(robot, i, state)?.drum_side()?;
    let (span, drive) = (state.hanging.as_ref()?, state.drive.as_deref()?);
    let by_drum_side = drive.end.drum_side_tension(&span.tangent_w(), &Vec3::zeros(), [0.0; 2], 1.0);
    Some((side.direction_w, -drive.end.stretch_drum * by_drum_side))
}

/// Drum side of a cable on a support, for small vibrations.
pub(crate) struct SupportSide {
    /// Direction in which the entry point moves along the drum side, unit vector, world axes; zero without a drum side.
    pub(crate) direction_w: Vec3,
    /// True if the drum stays on the ground.
    pub(crate) from_ground: bool,
    /// Stiffness of the tension of a drum side from the ground against a sideways motion of the entry point [N/m].
    pub(crate) sideways_w: Mat3,
    /// Force of the cable on the support without that of the drum side [N].
    pub(crate) carried_w: Vec3,
}

/// Drum side of cable `i` of a robot at rest; `None` if its anchor is rigid.
pub(crate) fn support_side(robot: &Robot, i: usize, state: &CableState) -> Option<SupportSide> {
    let carried = SupportedCable::of_state(robot, i, state)?;
    let carried_w = carried.load_w - carried.force_on_platform_w;
    if let Some(DrumSideAtRest { direction_w, length, tension }) = carried.drum_side() {
        let sideways_w = (Mat3::identity() - direction_w * direction_w.transpose()) * (tension / length);
        return Some(SupportSide { direction_w, from_ground: true, sideways_w, carried_w });
    }
    let along = |drive: &DriveAtRest| drive.contact.as_ref().map_or(drive.end.travel_w, |contact| contact.axis_w);
    let direction_w = state.drive.as_deref().map_or_else(Vec3::zeros, along);
    Some(SupportSide { direction_w, from_ground: false, sideways_w: Mat3::zeros(), carried_w })
}

/// Stiffness that the platform loses because supports yield, at rest: 6×6 about the platform origin, world axes. Each
/// cable has its stiffness for a motion of its support, its index and its lever arm.
pub(super) fn lost_stiffness(robot: &Robot, cables: impl Iterator<Item = (usize, OnSupport, Vec3)>) -> Mat6 {
    let mut own: Vec<Mat3> = robot.supports.iter().map(|support| support.stiffness_w).collect();
    let mut columns = vec![[Vec6::zeros(); 3]; own.len()];
    for (i, cable, lever_w) in cables {
        let Some(support) = robot.cables[i].anchor.support else { continue };
        own[support] += cable.stiffness_w;
        for (column, add) in columns[support].iter_mut().zip(wrench_columns(&cable.force_w, &lever_w)) {
            *column += add;
        }
    }

    let mut lost = Mat6::zeros();
    for (own, columns) in own.iter().zip(&columns) {
        // An equilibrium has no support that its cables make unstable.
        let Some(compliance) = own.try_inverse() else { continue };
        for (i, a) in columns.iter().enumerate() {
            for (j, b) in columns.iter().enumerate() {
                lost += a * b.transpose() * compliance[(i, j)];
            }
        }
    }
    lost
}

/// Stiffness of cable `i` for a motion of its support, which is in balance; `None` if its anchor is rigid.
pub(super) fn stiffness_on_support(
    robot: &Robot,
    i: usize,
    cable: &CableAtRest,
    unstrained_length: f64,
    displacements_w: &[Vec3],
) -> Option<OnSupport> {
    let carried = SupportedCable::of_trial(robot, i, cable, unstrained_length, displacements_w)?;
    Some(drive::on_support(&cable.span.tangent_w(), cable.drive.as_deref(), carried.drum_side()))
}

/// Cables of a robot at a pose with its supports in balance, and the displacement of each support [m].
pub(super) struct CablesOnSupports {
    pub(super) cables: Vec<CableAtRest>,
    pub(super) displacements_w: Vec<Vec3>,
}

impl CablesOnSupports {
    /// Hangs all cables, whose unstrained lengths are known, at a pose.
    pub(super) fn at(robot: &Robot, loaded: &[LoadedCable], lengths: &[f64], pose: &Pose) -> Self {
        let mut displacements_w = vec![Vec3::zeros(); robot.supports.len()];
        for (support, displacement_w) in displacements_w.iter_mut().enumerate() {
            let members: Vec<usize> =
                (0..robot.cables.len()).filter(|i| robot.cables[*i].anchor.support == Some(support)).collect();
            *displacement_w =
                SupportBalance { robot, loaded, lengths, pose, support, members: &members }.displacement_w();
        }
        let cables = (0..robot.cables.len())
            .map(|i| {
                let displacement_w = robot.cables[i].anchor.support.map_or_else(Vec3::zeros, |of| displacements_w[of]);
                hang(robot, loaded, lengths, pose, i, &displacement_w)
            })
            .collect();
        Self { cables, displacements_w }
    }
}

/// Cable `i` at a pose with its support displaced.
fn hang(
    robot: &Robot,
    loaded: &[LoadedCable],
    lengths: &[f64],
    pose: &Pose,
    i: usize,
    displacement_w: &Vec3,
) -> CableAtRest {
    let Some(support) = robot.cables[i].anchor.support else { return loaded[i].hang(pose, lengths[i]) };
    let mut cable = robot.cables[i].clone();
    cable.anchor.displace(&robot.supports[support], displacement_w);
    LoadedCable { cable: &cable, ..loaded[i] }.hang(pose, lengths[i])
}

/// Balance of a support with its cables at a pose.
struct SupportBalance<'a> {
    robot: &'a Robot,
    loaded: &'a [LoadedCable<'a>],
    lengths: &'a [f64],
    pose: &'a Pose,
    support: usize,
    /// Indices of its cables.
    members: &'a [usize],
}

/// Support at a displacement.
struct SupportTrial {
    displacement_w: Vec3,
    /// Residual: force of its cables less the force of its stiffness [N].
    imbalance_w: Vec3,
    /// Sum of all forces on it [N].
    size: f64,
    /// Resistance to a displacement [N/m].
    stiffness_w: Mat3,
}

impl SupportBalance<'_> {
    fn at(&self, displacement_w: Vec3) -> SupportTrial {
        let support = &self.robot.supports[self.support];
        let own_w = support.stiffness_w * displacement_w;
        let mut trial =
            SupportTrial { displacement_w, imbalance_w: -own_w, size: own_w.norm(), stiffness_w: support.stiffness_w };
        for &i in self.members {
            let cable = hang(self.robot, self.loaded, self.lengths, self.pose, i, &displacement_w);
            let anchor = &self.robot.cables[i].anchor;
            let parts = (Some(&cable.span), cable.drive.as_deref());
            let carried =
                SupportedCable::new((anchor, support), displacement_w, cable.force_w(), parts, self.lengths[i]);
            let force_w = carried.force_w();
            trial.imbalance_w += force_w;
            trial.size += force_w.norm() + carried.load_w.norm();
            trial.stiffness_w +=
                drive::on_support(&cable.span.tangent_w(), cable.drive.as_deref(), carried.drum_side()).stiffness_w;
        }
        trial
    }

    /// Displacement at which the support is balanced.
    fn displacement_w(&self) -> Vec3 {
        let mut here = self.at(Vec3::zeros());
        for _ in 0..MAX_STEPS {
            if here.imbalance_w.norm() <= BALANCED * here.size {
                break;
            }

            // Newton's step, halved until it reduces the residual.
            let Some(factor) = here.stiffness_w.cholesky() else { break };
            let mut step_w = factor.solve(&here.imbalance_w);
            let mut next = self.at(here.displacement_w + step_w);
            let halvings = if here.imbalance_w.norm() <= NEARLY_BALANCED * here.size { 0 } else { MAX_HALVINGS };
            for _ in 0..halvings {
                if next.imbalance_w.norm() < here.imbalance_w.norm() {
                    break;
                }
                step_w *= 0.5;
                next = self.at(here.displacement_w + step_w);
            }

            // Rounding allows no better balance.
            if next.imbalance_w.norm() >= here.imbalance_w.norm() {
                break;
            }
            here = next;
        }

        here.displacement_w
    }
}

/// Potential energy of all supports, and of the weight of cables over pulleys that they lift [J].
pub(super) fn energy(robot: &Robot, cables: &[CableAtRest], lengths: &[f64], displacements_w: &[Vec3]) -> f64 {
    let of_supports: f64 =
        (robot.supports.iter().zip(displacements_w)).map(|(support, e)| 0.5 * e.dot(&(support.stiffness_w * e))).sum();
    let lifted: f64 = (cables.iter().zip(lengths).enumerate())
        .filter(|(_, (cable, _))| cable.drive.is_some())
        .filter_map(|(i, (cable, length))| SupportedCable::of_trial(robot, i, cable, *length, displacements_w))
        .map(|carried| carried.load_w.dot(&carried.displacement_w))
        .sum();
    of_supports - lifted
}

//! Motions of the platform that no cable opposes: its cables have dependent directions, as when all of them end at one
//! point or on one line of the platform.

use super::drag::tangent_with_drag;
use super::equilibrium::Equilibrium;
use super::obstacle::direction;
use super::residual::scaled_residual;
use super::stiffness::indifferent_motions;
use crate::math::{DMat, Vec3, Vec6};
use crate::platform::{Coordinates, StraightCable, balance};
use crate::robot::{PlatformMotion, Pose, Robot};
use crate::statics::loaded_cable::LoadedCable;
use crate::statics::model::StaticModel;
use std::fmt;

/// Ratio of a singular value of the cables' wrenches to the largest one below which it counts as zero. The condition
/// number of what is left is then below that at which a balance counts as singular (1e10).
const DEPENDENT: f64 = 1e-9;

/// Maximum scaled wrench along the free motions at which a load counts as balanced there; the search for tensions ends
/// at this residual.
const BALANCED_ALONG_FREE: f64 = 1e-12;

/// Component of a unit motion that counts as rounding.
const ROUNDING: f64 = 1e-9;

/// Orthonormal basis of the reduced wrenches: those that cables span, and those that they do not reach.
pub(super) struct SpannedWrenches {
    pub(super) spanned: Vec<Vec6>,
    /// Wrenches without a cable. As motions they are those along which no tension does work.
    pub(super) free: Vec<Vec6>,
}

impl SpannedWrenches {
    /// Basis for the wrenches of cables per unit tension (their first `dof` components).
    pub(super) fn of(columns: &[Vec6], dof: usize) -> Self {
        // Zero columns make all left singular vectors appear.
        let count = columns.len().max(dof);
        let matrix = DMat::from_fn(dof, count, |i, j| columns.get(j).map_or(0.0, |column| column[i]));
        let svd = matrix.svd(true, false);
        let (vectors, values) = (svd.u.unwrap_or_else(|| DMat::identity(dof, dof)), svd.singular_values);
        let least = DEPENDENT * values.max();
        let vector = |k: usize| Vec6::from_fn(|i, _| if i < dof { vectors[(i, k)] } else { 0.0 });
        let (spanned, free): (Vec<usize>, Vec<usize>) = (0..dof).partition(|k| values[*k] > least);
        Self { spanned: spanned.into_iter().map(vector).collect(), free: free.into_iter().map(vector).collect() }
    }

    /// Basis for straight cables at a pose.
    fn at(robot: &Robot, pose: &Pose) -> Self {
        let coordinates = Coordinates::of(robot);
        let wrench = |i: usize| StraightCable::at(&robot.cables[i], pose).unit_wrench(&coordinates);
        let columns: Vec<Vec6> =
            robot.cables_of_ropes().into_iter().map(|rope| rope.into_iter().map(wrench).sum()).collect();
        Self::of(&columns, coordinates.count())
    }
}

/// True if the tensions that hold a pose are a matter of choice: there are more cables than independent directions of
/// cables, and the load has no part along the motions that they leave free. With more cables than degrees of freedom
/// it is always true.
pub(super) fn has_choice(robot: &Robot, pose: &Pose, model: StaticModel) -> bool {
    if robot.constraint().is_redundant() {
        return true;
    }
    if robot.cables.iter().any(|cable| cable.chord_w(pose).norm() == 0.0) {
        return false;
    }
    let SpannedWrenches { spanned, free } = SpannedWrenches::at(robot, pose);
    if spanned.len() == robot.rope_count() {
        return false;
    }

    // Straight cables without tension, with half of their load at the platform.
    let loads = LoadedCable::all(robot, pose, model).into_iter().map(|cable| {
        let StraightCable { lever_w, chord_w } = StraightCable::at(cable.cable, pose);
        (cable.load.vector_w() * (0.5 * chord_w.norm()), lever_w)
    });
    let (wrench, scale) = balance(robot, pose, loads);
    let coordinates = Coordinates::of(robot);
    let reduced = coordinates.reduce(&wrench);
    let along: Vec6 = free.iter().map(|free| free * free.dot(&reduced)).sum();
    let back = coordinates.expand(&along);
    let along = Vec6::from_fn(|i, _| if i < 3 { back[i] } else { back[i] * coordinates.ell() });
    scaled_residual(&coordinates, &along, scale) <= BALANCED_ALONG_FREE
}

/// Largest number of independent directions that the cables of a robot have at any pose: fewer than the degrees of
/// freedom if all end at one point or on one line of the platform.
pub(crate) fn independent_directions(robot: &Robot) -> usize {
    let dof = robot.platform.motion.count();
    let turns = match robot.platform.motion {
        PlatformMotion::Rigid => 3,
        PlatformMotion::Planar(_) => 1,
        PlatformMotion::PointMass => 0,
    };
    let Some(first) = robot.cables.first() else { return 0 };
    let offsets: Vec<Vec3> = robot.cables.iter().map(|cable| cable.attachment_p - first.attachment_p).collect();
    let longest = offsets.iter().copied().max_by(|a, b| a.norm().total_cmp(&b.norm())).unwrap_or_else(Vec3::zeros);
    let size = DEPENDENT * robot.platform_length();
    let is_point = longest.norm() <= size;
    let is_line = offsets.iter().all(|offset| offset.cross(&longest).norm() <= size * longest.norm());
    // Turns about a common point, or about a common line, are opposed by no cable.
    let free = match (is_point, is_line) {
        (true, _) => turns,
        (false, true) if turns == 3 => 1,
        _ => 0,
    };
    (dof - free).min(robot.rope_count())
}

/// True if a tension rule has something to choose: there are more cables than independent directions that they can
/// have. At single poses with dependent directions there may be a choice although this is false.
pub fn leaves_choice(robot: &Robot) -> bool {
    robot.rope_count() > independent_directions(robot)
}

/// Motion along which a reduced wrench acts and that no cable opposes, at a pose; `None` if there is none.
pub(super) fn unopposed(robot: &Robot, pose: &Pose, wrench: &Vec6) -> Option<FreeMotion> {
    let free = SpannedWrenches::at(robot, pose).free;
    let along: Vec6 = free.iter().map(|free| free * free.dot(wrench)).sum();
    if along.norm() <= BALANCED_ALONG_FREE * wrench.norm() {
        return None;
    }
    let coordinates = Coordinates::of(robot);
    let scaled = coordinates.expand(&along);
    let motion = Vec6::from_fn(|i, _| if i < 3 { scaled[i] } else { scaled[i] / coordinates.ell() });
    Some(FreeMotion::new(&motion, pose, Some(false)))
}

/// Motion of the platform that no cable opposes by its tension.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeMotion {
    /// Velocity of the platform origin [m, or m/rad with a rotation], world axes.
    pub translation_w: Vec3,
    /// Angular velocity, world axes: of length 1, or zero for a translation.
    pub rotation_w: Vec3,
    /// Point on the axis of the rotation, nearest to the platform origin, world axes [m].
    pub point_w: Vec3,
    /// False if nothing holds the platform against this motion; true if weight or the directions of the tensions do.
    /// `None` for ideal cables, whose equilibrium has no stiffness.
    pub is_held: Option<bool>,
}

/// Motions of a robot at equilibrium that no cable opposes by its tension. Those that nothing holds come first.
///
/// A robot with fewer cables than degrees of freedom always has such motions. They are listed if the cables have fewer
/// independent directions than their number and the degrees of freedom allow, or if nothing holds the platform.
///
/// # Example
/// ```
/// # use funicular::{robot::Robot, statics::{self, StaticModel}};
/// // All cables of this robot end at one point of the platform, 0.1 m above its origin.
/// let text = r#"
///     name = "camera"
///     [platform]
///     mass_kg = 20.0
///     inertia_kg_m2 = [0.5, 0.5, 0.1]
///     [materials.rope]
///     axial_stiffness_n = 1e6
///     mass_kg_per_m = 0.05
///     [[cables]]
///     name = "1"
///     material = "rope"
///     anchor_m = [4, 3, 4]
///     attachment_m = [0, 0, 0.1]
///     [[cables]]
///     name = "2"
///     material = "rope"
///     anchor_m = [-4, 3, 4]
///     attachment_m = [0, 0, 0.1]
///     [[cables]]
///     name = "3"
///     material = "rope"
///     anchor_m = [-4, -3, 4]
///     attachment_m = [0, 0, 0.1]
///     [[cables]]
///     name = "4"
///     material = "rope"
///     anchor_m = [4, -3, 4]
///     attachment_m = [0, 0, 0.1]
///     [state]
///     position_m = [0.5, 0.2, 1.5]
/// "#;
/// let robot = Robot::from_toml(text)?;
/// let rest = statics::solve(&robot, StaticModel::Catenary, None)?;
/// let free = statics::free_motions(&robot, &rest.equilibrium);
/// assert_eq!(free.len(), 3); // nothing holds the turn about the vertical; the weight holds the two swings
/// assert_eq!(free[0].is_held, Some(false));
/// assert!((free[0].rotation_w.z.abs() - 1.0).abs() < 1e-9 && free[1].is_held == Some(true));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn free_motions(robot: &Robot, equilibrium: &Equilibrium) -> Vec<FreeMotion> {
    let coordinates = Coordinates::of(robot);
    let wrench = |i: usize| {
        let cable = &equilibrium.cables[i];
        let direction = cable.chord_w().try_normalize(0.0)?;
        Some(coordinates.reduce_force(&direction, &cable.lever_w))
    };
    let columns: Vec<Vec6> = (robot.cables_of_ropes().into_iter())
        .filter_map(|rope| rope.into_iter().map(wrench).sum::<Option<Vec6>>())
        .collect();
    let SpannedWrenches { spanned, free } = SpannedWrenches::of(&columns, coordinates.count());
    let is_deficient = spanned.len() < columns.len().min(coordinates.count());

    let stiffness = tangent_with_drag(robot, equilibrium).map(|whole| coordinates.reduce_symmetric(&whole));
    let loose = stiffness.as_ref().map_or_else(Vec::new, |whole| indifferent_motions(whole, coordinates.count()));
    // The rest of the motions that no cable opposes.
    let mut held: Vec<Vec6> = Vec::new();
    for motion in free.iter().filter(|_| is_deficient) {
        let left = (loose.iter().chain(&held)).fold(*motion, |left, of| left - of * of.dot(&left));
        if left.norm() > ROUNDING.sqrt() {
            held.push(left.normalize());
        }
    }

    let pose = &equilibrium.pose;
    let all = |motions: Vec<Vec6>, is_held: Option<bool>| {
        let expanded = motions.iter().map(|motion| {
            let scaled = coordinates.expand(motion);
            Vec6::from_fn(|i, _| if i < 3 { scaled[i] } else { scaled[i] / coordinates.ell() })
        });
        let plain = plainest(expanded.collect());
        plain.into_iter().map(move |motion| FreeMotion::new(&motion, pose, is_held))
    };
    all(loose, Some(false)).chain(all(held, stiffness.map(|_| true))).collect()
}

/// Other basis of the same motions with as many zeros as elimination gives, rotations about world axes first.
fn plainest(mut motions: Vec<Vec6>) -> Vec<Vec6> {
    let mut done = 0;
    for component in [3, 4, 5, 0, 1, 2] {
        let size = |motion: &Vec6| motion[component].abs();
        let pivot = (done..motions.len()).max_by(|a, b| size(&motions[*a]).total_cmp(&size(&motions[*b])));
        let Some(pivot) = pivot.filter(|k| size(&motions[*k]) > ROUNDING * motions[*k].norm()) else { continue };
        motions.swap(done, pivot);
        let unit = motions[done] / motions[done][component];
        motions[done] = unit;
        for (_, other) in motions.iter_mut().enumerate().filter(|(k, _)| *k != done) {
            *other -= unit * other[component];
        }
        done += 1;
    }
    motions
}

impl FreeMotion {
    /// Motion of a platform at a pose: translation of its origin and rotation, of any length.
    fn new(motion: &Vec6, pose: &Pose, is_held: Option<bool>) -> Self {
        let clean = |vector: Vec3, size: f64| vector.map(|x| if x.abs() <= ROUNDING * size { 0.0 } else { x });
        let (translation, rotation): (Vec3, Vec3) =
            (motion.fixed_rows::<3>(0).into(), motion.fixed_rows::<3>(3).into());
        let turns = rotation.norm() > ROUNDING * translation.norm();
        let length = if turns { rotation.norm() } else { translation.norm() };
        let translation_w = clean(translation / length, if turns { 1.0 + pose.position_w.norm() } else { 1.0 });
        let rotation_w = if turns { clean(rotation / length, 1.0) } else { Vec3::zeros() };
        Self { translation_w, rotation_w, point_w: pose.position_w + rotation_w.cross(&translation_w), is_held }
    }
}

impl fmt::Display for FreeMotion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { translation_w, rotation_w, point_w, .. } = self;
        if *rotation_w == Vec3::zeros() {
            return write!(f, "move along {}", direction(translation_w));
        }
        write!(f, "turn about {} through {} m", direction(rotation_w), direction(point_w))?;
        let pitch = translation_w.dot(rotation_w);
        if pitch.abs() > ROUNDING { write!(f, ", moving by {pitch:.4} m per radian along it") } else { Ok(()) }
    }
}

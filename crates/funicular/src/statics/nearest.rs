//! The pose nearest to a given one that fewer cables than freedoms can hold.
//!
//! With m cables the equilibria are a surface of m dimensions in the space of poses and lengths. A step along it
//! satisfies `K dx = B dL`, B being the wrench by the lengths; the one that comes nearest to the pose asked is taken, and
//! forward statics brings the platform back to the surface, to a stable equilibrium of the new lengths. How the surface
//! bends is learnt from the steps (Broyden, Fletcher, Goldfarb, Shanno), which start as those of a flat one.

use super::drag::tangent_with_drag;
use super::equilibrium::{CableState, Equilibrium};
use super::error::StaticsError;
use super::forward::forward;
use super::limits::TensionRange;
use super::loaded_cable::LoadedCable;
use super::model::StaticModel;
use crate::math::{DMat, Mat6, Vec6};
use crate::platform::{Coordinates, StraightCable, load_wrench, wrench_of};
use crate::robot::{Cable, Pose, Robot};

/// An equilibrium near a pose that was asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Nearest {
    /// The equilibrium, stable or indifferent; its pose is not the one asked.
    pub equilibrium: Equilibrium,
    /// Distance of its pose from the one asked [m], see [`distance`].
    pub distance: f64,
}

/// Limit of steps; 3 to 30 are seen.
const MOST_STEPS: usize = 300;

/// Length over the size of the robot that the pose could still come nearer, along the surface, at which it counts as
/// nearest; and up to which it does when rounding allows no more.
const NEAREST: f64 = 1e-11;
const NEAR: f64 = 1e-6;

/// Singular values over the largest that are zero.
const ZERO: f64 = 1e-12;

/// Least motion by a unit step along the surface that counts: what moves less is a change of tensions alone.
const ALONG: f64 = 1e-9;

/// How far apart two poses are [m]: translation and ℓ times the angle between them, in the root of the sum of squares, ℓ
/// being [`Robot::platform_length`].
pub fn distance(robot: &Robot, from: &Pose, to: &Pose) -> f64 {
    gap(robot, from, to).norm()
}

/// Scaled motion from one pose to another, in the platform's coordinates.
fn gap(robot: &Robot, from: &Pose, to: &Pose) -> Vec6 {
    let p = to.position_w - from.position_w;
    let turn = (to.rot_wp * from.rot_wp.inverse()).scaled_axis() * robot.platform_length();
    robot.platform.freedoms.reduced(&Vec6::new(p.x, p.y, p.z, turn.x, turn.y, turn.z))
}

/// The pose nearest to a given one that the cables can hold by some lengths, for robots with fewer cables than freedoms;
/// nearest by [`distance`], among poses around the one that the first guess of lengths leads to.
///
/// # Errors
/// [`StaticsError`]: ideal cables, a pose out of a planar platform's plane, coinciding ends, or no convergence.
///
/// # Example
/// ```
/// # use funicular::{robot::{Pose, Robot}, statics::{self, StaticModel}};
/// // A body on one cable hangs straight below the anchor: of a pose beside it the nearest is below.
/// let text = r#"
///     name = "pendulum"
///     [platform]
///     mass_kg = 2.0
///     freedoms = "point-mass"
///     [materials.cord]
///     axial_stiffness_n = 1e6
///     mass_kg_per_m = 0.0
///     [[cables]]
///     name = "only"
///     material = "cord"
///     anchor_m = [0.0, 0.0, 3.0]
/// "#;
/// let robot = Robot::from_toml(text)?;
/// let found = statics::nearest(&robot, &Pose::new([0.3, 0.0, 1.0], [0.0; 3]), StaticModel::Catenary)?;
/// assert!((found.distance - 0.3).abs() < 1e-9);
/// assert!((found.equilibrium.pose.position_w.z - 1.0).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn nearest(robot: &Robot, asked: &Pose, model: StaticModel) -> Result<Nearest, StaticsError> {
    let (cables, freedoms) = (robot.cables.len(), robot.platform.freedoms.count());
    if model == StaticModel::Ideal {
        return Err(StaticsError::InverseCableCount { cables, freedoms });
    }
    robot.platform.freedoms.check(asked)?;
    let coordinates = Coordinates::of(robot);
    let mut lengths = first_lengths(robot, asked, model)?;
    let mut here = forward(robot, &lengths, model, Some(asked))?;
    let mut iterations = here.iterations;
    let size = coordinates.ell() + lengths.iter().copied().fold(0.0, f64::max);
    let mut surface = Surface::at(robot, &here);
    let mut missing = gap(robot, &here.pose, asked);
    let (mut bend, mut damping) = (Mat6::identity(), 0.0);
    for _ in 0..MOST_STEPS {
        let could = surface.along(&missing);
        if could.norm() <= NEAREST * size {
            break;
        }
        let (motion, by_length) = surface.step(&missing, &bend, damping);
        let trial: Vec<f64> = lengths.iter().zip(&by_length).map(|(l, d)| (l + d).max(0.2 * l)).collect();
        let start = coordinates.moved(&here.pose, &motion);
        if let Ok(next) = forward(robot, &trial, model, Some(&start)) {
            iterations += next.iterations;
            let next_missing = gap(robot, &next.pose, asked);
            let next_surface = Surface::at(robot, &next);
            let next_could = next_surface.along(&next_missing);
            let nearer = next_missing.norm() < missing.norm();
            // Near the end the distance drowns in rounding; there the direction decides.
            let straighter = could.norm() < 1e-4 * missing.norm() && next_could.norm() < 0.9 * could.norm();
            if nearer || straighter {
                let moved = gap(robot, &here.pose, &next.pose);
                update(&mut bend, &next_surface.along(&moved), &(could - next_could));
                (here, lengths, missing, surface) = (next, trial, next_missing, next_surface);
                damping = if damping < 1e-3 { 0.0 } else { 0.1 * damping };
                continue;
            }
        }
        if damping == 0.0 {
            bend = Mat6::identity();
        }
        damping = (10.0 * damping).max(0.1);
        if damping > 1e12 {
            break;
        }
    }
    let could = surface.along(&missing).norm();
    if could > NEAR * size {
        let p = here.pose.position_w;
        let (residual, limit) = (could / size, NEAR);
        return Err(StaticsError::NotNearest { iterations, residual, limit, x: p.x, y: p.y, z: p.z });
    }
    // Only ropes of no length come near a pose on the line between their anchors.
    let torn = |(cable, state): (&Cable, &CableState)| state.tension_platform > cable.material.axial_stiffness;
    if robot.cables.iter().zip(&here.cables).any(torn) {
        return Err(StaticsError::Singular);
    }
    here.iterations = iterations;
    Ok(Nearest { equilibrium: here, distance: missing.norm() })
}

/// Lengths of cables whose tensions balance the platform's load as well as straight cables can, none below its least.
fn first_lengths(robot: &Robot, pose: &Pose, model: StaticModel) -> Result<Vec<f64>, StaticsError> {
    let coordinates = Coordinates::of(robot);
    let n = robot.cables.len();
    let mut load = load_wrench(robot, pose);
    let mut columns = DMat::zeros(6, n);
    let mut lines = Vec::with_capacity(n);
    for (i, cable) in robot.cables.iter().enumerate() {
        let straight = StraightCable::at(cable, pose);
        let chord = straight.chord_w.norm();
        if chord == 0.0 {
            return Err(StaticsError::CoincidingEnds { cable: cable.name.clone() });
        }
        let line = LoadedCable::at(robot, i, pose, model);
        load += wrench_of(&(line.load.vector_w() * (0.5 * chord)), &straight.lever_w);
        columns.set_column(i, &straight.unit_wrench(&coordinates));
        lines.push((line, straight.chord_w));
    }
    let right = -coordinates.reduce(&load);
    let balanced = columns.svd(true, true).solve(&right, 1e-9).unwrap_or_else(|_| Vec6::zeros().rows(0, n).into());
    let lengths = (0..n).map(|i| {
        let (line, chord_w) = &lines[i];
        let chord = chord_w.norm();
        // Not so slack that its length would be all sag.
        let least = TensionRange::of(robot, i, chord_w).minimum.max(0.25 * line.load.size * chord);
        line.hang_with_tension(pose, balanced[i].max(least)).catenary.rope().unstrained_length
    });
    Ok(lengths.collect())
}

/// Learns from a step how the slope of half the squared distance changes along it; positive definite it stays.
fn update(bend: &mut Mat6, moved: &Vec6, slope: &Vec6) {
    let (by, bent) = (moved.dot(slope), *bend * moved);
    let along = moved.dot(&bent);
    if by > 1e-3 * moved.norm() * slope.norm() && along > 0.0 {
        *bend += slope * slope.transpose() / by - bent * bent.transpose() / along;
    }
}

/// The directions in which an equilibrium can go by changes of the lengths.
struct Surface {
    /// Orthonormal motions.
    directions: Vec<Vec6>,
    /// The changes of the lengths that go with each [m/m].
    lengths: Vec<Vec<f64>>,
}

impl Surface {
    fn at(robot: &Robot, equilibrium: &Equilibrium) -> Self {
        let coordinates = Coordinates::of(robot);
        let (n, m) = (coordinates.count(), equilibrium.cables.len());
        let stiffness = tangent_with_drag(robot, equilibrium).expect("the cables are elastic");
        let stiffness = coordinates.reduce_matrix(&stiffness);
        // Zero rows make it square, so that its right singular vectors are all there are.
        let mut equations = DMat::zeros(n + m, n + m);
        equations.view_mut((0, 0), (n, n)).copy_from(&stiffness.view((0, 0), (n, n)));
        for (i, cable) in equilibrium.cables.iter().enumerate() {
            let hanging = cable.hanging.as_ref().expect("an elastic cable hangs");
            let column = coordinates.reduce_force(&hanging.force_by_length_w(), &cable.lever_w);
            equations.view_mut((0, n + i), (n, 1)).copy_from(&-column.rows(0, n));
        }
        let svd = equations.svd(false, true);
        let rows = svd.v_t.expect("asked for");
        let largest = svd.singular_values.max();
        let free: Vec<usize> = (0..n + m).filter(|&k| svd.singular_values[k] <= ZERO * largest).collect();
        let motions = DMat::from_fn(6, free.len(), |i, k| if i < n { rows[(free[k], i)] } else { 0.0 });
        let svd = motions.svd(true, true);
        let (u, v_t) = (svd.u.expect("asked for"), svd.v_t.expect("asked for"));
        let kept: Vec<usize> = (0..svd.singular_values.len()).filter(|&k| svd.singular_values[k] > ALONG).collect();
        let lengths = kept.iter().map(|&k| {
            let of = |i: usize| free.iter().enumerate().map(|(j, &row)| v_t[(k, j)] * rows[(row, n + i)]).sum::<f64>();
            (0..m).map(|i| of(i) / svd.singular_values[k]).collect()
        });
        Self { lengths: lengths.collect(), directions: kept.iter().map(|&k| Vec6::from_fn(|i, _| u[(i, k)])).collect() }
    }

    /// The part of a motion that is along the surface.
    fn along(&self, motion: &Vec6) -> Vec6 {
        self.directions.iter().map(|direction| direction * direction.dot(motion)).sum()
    }

    /// The motion along the surface that comes nearest to another, if it bends like this, and the change of the lengths
    /// that it takes.
    fn step(&self, motion: &Vec6, bend: &Mat6, damping: f64) -> (Vec6, Vec<f64>) {
        let r = self.directions.len();
        let u = &self.directions;
        let matrix = DMat::from_fn(r, r, |i, j| u[i].dot(&(bend * u[j])) + if i == j { damping } else { 0.0 });
        let right = DMat::from_fn(r, 1, |i, _| u[i].dot(motion));
        let parts = matrix.cholesky().map_or_else(|| right.clone(), |factor| factor.solve(&right));
        let mut by_length = vec![0.0; self.lengths.first().map_or(0, Vec::len)];
        let mut moved = Vec6::zeros();
        for ((part, direction), lengths) in parts.iter().zip(u).zip(&self.lengths) {
            moved += direction * *part;
            by_length.iter_mut().zip(lengths).for_each(|(sum, length)| *sum += part * length);
        }
        (moved, by_length)
    }
}

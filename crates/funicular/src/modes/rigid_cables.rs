//! Natural modes of a robot on straight cables without mass whose lengths do not change.
//!
//! The platform keeps the motions that change no length to first order, the null space of the cables' unit wrenches. A
//! robot with fewer cables than degrees of freedom swings in them. The stiffness of these motions comes from the
//! tensions and the weight alone: turning cables, moving exit points, and lever arms of static forces.

use super::{Kind, Mode, Modes, RESIDUAL_LIMIT};
use crate::dynamics::{NullVector, PlatformTerms, constant_cable, platform_damping, platform_terms};
use crate::math::{DMat, Mat3, Mat6, Vec3, Vec6, symmetric, symmetric_part};
use crate::robot::Robot;
use crate::statics::{CableState, Equilibrium, StaticModel};
use std::f64::consts::TAU;
use thiserror::Error;

/// Ratio of a singular value of the unit wrenches to the largest one up to which it counts as zero. Rounding leaves
/// 1e-16; at 1e-10 two cables would be parallel to 1e-10 rad.
const DEPENDENT: f64 = 1e-10;

/// Ratio of an eigenvalue of the free motions' stiffness to the largest one up to which it counts as zero. Rounding
/// leaves 1e-16 of terms that partly cancel.
const INDIFFERENT: f64 = 1e-12;

/// Relative distance of neighbouring frequencies that count as one multiple frequency.
const MULTIPLE_WIDTH: f64 = 1e-12;

/// Reason for which a robot has no modes with rigid cables.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum RigidCablesError {
    /// Sagging cables change the distance between their ends at constant length.
    #[error(
        "rigid cables are straight and have no mass, and the equilibrium has sagging cables: choose the static model \
         `ideal`"
    )]
    Sagging,
    /// The platform has no mass in a motion that the cables leave free.
    #[error("a motion that the cables leave free moves no mass: give the platform a positive mass and inertia")]
    Massless,
}

/// Natural modes below `below_hz` [Hz] with cables that are straight, without mass and rigid in length, undamped.
/// Winches and supports are rigid, too, and motors held; pulleys have no inertia.
///
/// There are as many modes and unstable directions as the cables leave motions free: usually the degrees of freedom
/// less the number of cables. The equilibrium has the static model `ideal` or `spring`. A slack cable holds nothing.
///
/// # Errors
/// [`RigidCablesError`]: an equilibrium with sagging cables, or a motion without mass.
///
/// # Example
/// ```
/// # use funicular::{modes, robot::{Pose, Robot}, statics::{self, StaticModel}};
/// // A point mass on one cable of 2 m is a pendulum in two directions.
/// let text = r#"
///     name = "pendulum"
///     [platform]
///     mass_kg = 2.0
///     motion = "point-mass"
///     [materials.cord]
///     axial_stiffness_n = 1e6
///     mass_kg_per_m = 0.0
///     [[cables]]
///     name = "only"
///     material = "cord"
///     anchor_m = [0.0, 0.0, 3.0]
/// "#;
/// let robot = Robot::from_toml(text)?;
/// let rest = statics::forward(&robot, &[2.0], StaticModel::Ideal, None)?;
/// let found = modes::with_rigid_cables(&robot, &rest, 10.0)?;
/// let exact = (9.81_f64 / 2.0).sqrt() / std::f64::consts::TAU; // Hz
/// assert_eq!(found.modes.len(), 2);
/// assert!((found.modes[0].frequency_hz / exact - 1.0).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # References
/// docs/theory.md, equations (48a) and (48b).
pub fn with_rigid_cables(robot: &Robot, equilibrium: &Equilibrium, below_hz: f64) -> Result<Modes, RigidCablesError> {
    if equilibrium.model == StaticModel::Catenary {
        return Err(RigidCablesError::Sagging);
    }

    // Stiffness and mass of the motions that keep all lengths.
    let platform = platform_terms(robot, equilibrium);
    let mut stiffness = platform.constant;
    for (i, state) in equilibrium.cables.iter().enumerate().filter(|(_, state)| !state.is_slack()) {
        stiffness += constant_cable(robot, state, &turning_stiffness(robot, i, state));
    }
    let free = free_motions(equilibrium, &platform);
    let within = |matrix: &Mat6| {
        let whole = DMat::from_column_slice(6, 6, matrix.as_slice());
        symmetric_part(&(free.transpose() * whole * &free))
    };
    let (k, m) = (within(&stiffness), within(&platform.mass));

    // Eigenvalues ω² in the coordinates that make the mass the identity.
    let factor = m.clone().cholesky().ok_or(RigidCablesError::Massless)?;
    let inverse = factor.l().try_inverse().ok_or(RigidCablesError::Massless)?;
    let count = free.ncols();
    let mut pencil = Mat6::zeros();
    pencil.view_mut((0, 0), (count, count)).copy_from(&symmetric_part(&(&inverse * &k * inverse.transpose())));
    let (squares, vectors) = if count == 0 { (Vec::new(), Vec::new()) } else { symmetric::eigen(&pencil, count) };

    let zero = INDIFFERENT * squares.iter().fold(0.0_f64, |most, square| most.max(square.abs()));
    let unstable_directions = squares.iter().filter(|square| **square <= zero).count();
    let limit = below_hz * TAU;
    let damping = platform_damping(robot, equilibrium);
    let mut modes = Vec::new();
    for (square, vector) in squares.iter().zip(&vectors).filter(|(square, _)| **square > zero) {
        let omega = square.sqrt();
        if omega >= limit {
            continue;
        }
        let y = inverse.transpose() * DMat::from_fn(count, 1, |i, _| vector[i]);
        let residual = ((y.transpose() * (&k - &m * *square) * &y)[(0, 0)] / square).abs();
        let moved = &free * y;
        let x = Vec6::from_fn(|i, _| moved[(i, 0)]);
        modes.push(mode(&platform, x, omega, x.dot(&(damping * x)), residual, robot.cables.len()));
    }
    mark_multiple(&mut modes);

    let certified = modes.iter().all(|mode| mode.residual <= RESIDUAL_LIMIT);
    let count_below = modes.len() + unstable_directions;
    Ok(Modes { modes, below_hz, count_below, unstable_directions, certified })
}

/// Stiffness of a cable at the platform end against motions that keep its length, 3×3, world axes [N/m].
///
/// # References
/// docs/theory.md, equation (48b).
fn turning_stiffness(robot: &Robot, i: usize, state: &CableState) -> Mat3 {
    let (length, tension) = (state.chord(), state.tension_platform);
    let Some(contact) = robot.cables[i].anchor.contact(&state.attachment_w) else {
        let along_w = state.chord_w() / length;
        return (Mat3::identity() - along_w * along_w.transpose()) * (tension / length);
    };

    // In the plane of the wheel the cable turns about its exit point. Out of the plane it turns about the swivel axis,
    // which the line of the cable meets behind the exit point.
    let behind = contact.radius * (0.5 * contact.wrap).tan();
    let turned = |direction_w: Vec3, length: f64| direction_w * direction_w.transpose() * (tension / length);
    turned(contact.exit_normal_w(), length) + turned(contact.sideways_w, length + behind)
}

/// Orthonormal basis of the scaled motions that change no length of a taut cable, as columns of six numbers.
fn free_motions(equilibrium: &Equilibrium, platform: &PlatformTerms) -> DMat {
    let n = platform.coordinates.count();
    let taut: Vec<&CableState> = equilibrium.cables.iter().filter(|state| !state.is_slack()).collect();
    // Zero rows make it at least square, so that all right singular vectors are computed.
    let mut rows = DMat::zeros(n.max(taut.len()), n);
    for (i, state) in taut.iter().enumerate() {
        let unit = platform.coordinates.reduce_force(&state.chord_w().normalize(), &state.lever_w);
        rows.view_mut((i, 0), (1, n)).copy_from(&unit.rows(0, n).transpose());
    }

    let svd = rows.svd(false, true);
    let right = svd.v_t.expect("requested above");
    let largest = svd.singular_values.max();
    let kept: Vec<usize> = (0..n).filter(|&k| svd.singular_values[k] <= DEPENDENT * largest).collect();
    DMat::from_fn(6, kept.len(), |i, k| if i < n { right[(kept[k], i)] } else { 0.0 })
}

/// Mode of a scaled motion `x` with unit modal mass at ω [rad/s].
fn mode(platform: &PlatformTerms, x: Vec6, omega: f64, damping: f64, residual: f64, cables: usize) -> Mode {
    let motion_w = platform.coordinates.expand(&x);
    let largest = motion_w[motion_w.iamax()];
    let shape = std::array::from_fn(|i| motion_w[i] / largest / if i < 3 { 1.0 } else { platform.coordinates.ell() });
    let energies = vec![0.0; cables];

    Mode {
        frequency_hz: omega / TAU,
        multiplicity: 1,
        damping_ratio: damping / (2.0 * omega),
        kind: Kind::Platform,
        platform_energy_fraction: 1.0,
        cable_energy_fractions: energies.clone(),
        drive_energy_fractions: Vec::new(),
        support_energy_fractions: Vec::new(),
        stretching_shares: Vec::new(),
        shape,
        modal_mass: (1.0 / largest).powi(2),
        residual,
        motion: NullVector {
            platform: x,
            near: Vec::new(),
            supports: Vec::new(),
            support_energies: Vec::new(),
            platform_energy: 1.0,
            cable_energies: energies,
            drive_energies: Vec::new(),
            stretching: Vec::new(),
            drive_damping: 0.0,
            residual,
        },
    }
}

/// Gives modes that share a frequency their number.
fn mark_multiple(modes: &mut [Mode]) {
    let same = |a: &Mode, b: &Mode| (a.frequency_hz - b.frequency_hz).abs() <= MULTIPLE_WIDTH * b.frequency_hz;
    for cluster in modes.chunk_by_mut(same) {
        let several = cluster.len();
        for mode in cluster {
            mode.multiplicity = several;
        }
    }
}

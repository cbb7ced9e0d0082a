//! Derivative of a natural frequency by a parameter of the robot.
//!
//! The quadratic form `W = xᵀ D x` of the dynamic stiffness D(ω) is stationary in the mode x and in the motion along
//! every cable. So its derivative needs neither the derivative of the mode nor that of the cables' motion. Only the
//! changes of forces, lever arms, masses and ropes at constant motion count: `dω = dW/(2ω · modal mass)`.

use super::Mode;
use crate::cable::catenary_dynamic::{CatenaryDynamic, InternalMotion};
use crate::cable::{CableModel, DynamicCable};
use crate::dynamics::{Assembly, Dynamics, Linearisation};
use crate::math::{Mat3, Vec3, legendre, skew};
use crate::robot::{CableChange, Robot, RobotChange};
use crate::statics::derivatives::{CableDerivative, EquilibriumDerivative, load_of};
use crate::statics::{CableState, Equilibrium};
use std::f64::consts::TAU;
use thiserror::Error;

/// Number of pieces of a cable over which the motion is integrated. With half of them the derivatives of the library's
/// robots are the same to 1e-9 (a test compares them).
const PIECES: usize = 16;

/// Number of nodes of the Gauss rule in each piece.
const NODES: usize = 12;

/// Reason for which the derivative of a natural frequency is not available.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FrequencyDerivativeError {
    /// The derivative is not implemented for this cable model.
    #[error("derivatives of frequencies need the cable model `catenary-dynamic` or `catenary-static`, not `{0}`")]
    Model(CableModel),
    /// Terms of the stiffness are left out.
    #[error("derivatives of frequencies need all terms of the stiffness: assembly `consistent`, in and out of plane")]
    Terms,
    /// Several modes share the frequency, so that it has several derivatives.
    #[error("{multiplicity} modes share the frequency {frequency_hz} Hz: it has no single derivative")]
    Multiple {
        /// Frequency [Hz].
        frequency_hz: f64,
        /// Number of modes.
        multiplicity: usize,
    },
    /// A cable has no catenary-dynamic stiffness.
    #[error("cable \"{cable}\": {reason}")]
    CatenaryDynamic {
        /// Name of the cable.
        cable: String,
        /// Reason.
        reason: crate::cable::catenary_dynamic::CatenaryDynamicError,
    },
}

/// Derivative of a natural frequency by the parameter of a change [Hz per unit of the parameter].
///
/// `by` is the derivative of the equilibrium by this parameter, from [`crate::statics::derivatives::at_held_lengths`]
/// or `at_held_pose`: the lengths or the pose held there are held here. Mode, dynamics and equilibrium belong to the
/// robot.
///
/// # Errors
/// [`FrequencyDerivativeError`].
///
/// # Example
/// ```
/// use funicular::dynamics::{Dynamics, Linearisation};
/// use funicular::modes::{self, derivatives};
/// use funicular::robot::{Robot, RobotChange};
/// use funicular::statics::{self, StaticModel, derivatives::at_held_lengths};
///
/// let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM)?;
/// let lengths = [6.863, 6.565, 6.756, 6.663, 6.801, 6.604];
/// let first = |robot: &Robot| -> Result<_, Box<dyn std::error::Error>> {
///     let rest = statics::forward(robot, &lengths, StaticModel::Catenary, None)?;
///     let dynamics = Dynamics::about(robot, &rest, Linearisation::default(), 5.0)?;
///     let mode = modes::below(&dynamics, 5.0).modes.swap_remove(0);
///     Ok((rest, dynamics, mode))
/// };
/// let (rest, dynamics, mode) = first(&robot)?;
/// let change = RobotChange::of_mass(&robot);
/// let by_mass = derivatives::frequency(&robot, &rest, &dynamics, &mode, &change, &at_held_lengths(&robot, &rest, &change)?)?;
///
/// let [lighter, heavier] = [-1e-3, 1e-3].map(|step| first(&robot.changed(&change, step)).map(|found| found.2.frequency_hz));
/// assert!((by_mass - (heavier? - lighter?) / 2e-3).abs() < 1e-4 * by_mass.abs()); // Hz/kg
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # References
/// docs/theory.md, equations (56) to (60).
pub fn frequency(
    robot: &Robot,
    equilibrium: &Equilibrium,
    dynamics: &Dynamics,
    mode: &Mode,
    change: &RobotChange,
    by: &EquilibriumDerivative,
) -> Result<f64, FrequencyDerivativeError> {
    in_pieces(robot, equilibrium, dynamics, mode, change, by, PIECES)
}

/// Computes [`frequency`] with integrals over a given number of pieces of every cable.
fn in_pieces(
    robot: &Robot,
    equilibrium: &Equilibrium,
    dynamics: &Dynamics,
    mode: &Mode,
    change: &RobotChange,
    by: &EquilibriumDerivative,
    pieces: usize,
) -> Result<f64, FrequencyDerivativeError> {
    let Linearisation { cable_model, assembly, in_plane_only, .. } = dynamics.linearisation;
    if !matches!(cable_model, CableModel::CatenaryStatic | CableModel::CatenaryDynamic) {
        return Err(FrequencyDerivativeError::Model(cable_model));
    }
    if assembly != Assembly::Consistent || in_plane_only {
        return Err(FrequencyDerivativeError::Terms);
    }
    if mode.multiplicity != 1 {
        let Mode { frequency_hz, multiplicity, .. } = *mode;
        return Err(FrequencyDerivativeError::Multiple { frequency_hz, multiplicity });
    }

    let omega = mode.frequency_hz * TAU;
    let shape = &mode.shape;
    let v = Vec3::new(shape[0], shape[1], shape[2]);
    let theta = Vec3::new(shape[3], shape[4], shape[5]);
    let mut total = platform_terms(robot, equilibrium, change, by, omega, [&v, &theta]);

    for (i, state) in equilibrium.cables.iter().enumerate() {
        let (of_cable, by) = (&change.cables[i], &by.cables[i]);
        let end_w = v + theta.cross(&state.lever_w);
        let motion = CableMotion::new(robot, dynamics, mode, i, state, &end_w, pieces).map_err(|reason| {
            FrequencyDerivativeError::CatenaryDynamic { cable: robot.cables[i].name.clone(), reason }
        })?;
        total += motion.energy_change(robot, i, state, of_cable, by, omega);
        // The platform end moves with its lever arm against the force that holds it.
        total += 2.0 * motion.end_force_w.dot(&theta.cross(&by.lever_w));
        total += lever_change(&state.force_on_platform_w, &state.lever_w, &by.force_on_platform_w, &by.lever_w, &theta);
    }
    Ok(total / (2.0 * omega * mode.modal_mass) / TAU)
}

/// Change of the quadratic form by the platform: weight and load on their lever arms, mass and inertia.
fn platform_terms(
    robot: &Robot,
    equilibrium: &Equilibrium,
    change: &RobotChange,
    by: &EquilibriumDerivative,
    omega: f64,
    [v, theta]: [&Vec3; 2],
) -> f64 {
    let (platform, rot) = (&robot.platform, &equilibrium.pose.rot_wp);
    let turned = |arm_w: &Vec3, change_p: &Vec3| rot * change_p + by.rotation_w.cross(arm_w);

    let centre_w = rot * platform.center_of_mass_p;
    let centre_change_w = turned(&centre_w, &change.center_of_mass_p);
    let weight_change_w =
        robot.gravity_w * change.mass + change.gravity_w * platform.mass + robot.wind.pressure_w() * change.drag_area;
    let point_w = rot * robot.load.point_p;
    let point_change_w = turned(&point_w, &change.point_p);
    let stiffness = lever_change(&robot.force_at_mass_centre_w(), &centre_w, &weight_change_w, &centre_change_w, theta)
        + lever_change(&robot.load.force_w, &point_w, &change.force_w, &point_change_w, theta);

    let rot = rot.to_rotation_matrix();
    let to_world = |tensor_p: &Mat3| rot.matrix() * tensor_p * rot.matrix().transpose();
    let inertia_w = to_world(&platform.inertia_p);
    let turn = skew(&by.rotation_w);
    let inertia_change_w = turn * inertia_w - inertia_w * turn + to_world(&change.inertia_p);
    let at_centre = v + theta.cross(&centre_w);
    let mass = change.mass * at_centre.norm_squared()
        + 2.0 * platform.mass * at_centre.dot(&theta.cross(&centre_change_w))
        + theta.dot(&(inertia_change_w * theta));
    stiffness - omega * omega * mass
}

/// Change of `−θᵀ[f]×[r]×θ = (f·r)|θ|² − (θ·r)(f·θ)`, the geometric stiffness of a force on its lever arm.
fn lever_change(force: &Vec3, lever: &Vec3, force_change: &Vec3, lever_change: &Vec3, theta: &Vec3) -> f64 {
    (force_change.dot(lever) + force.dot(lever_change)) * theta.norm_squared()
        - theta.dot(lever_change) * force.dot(theta)
        - theta.dot(lever) * force_change.dot(theta)
}

/// Motion along a cable in a mode.
struct CableMotion {
    /// Nodes of the integrals along the cable: unstrained arc length and weight [m].
    nodes: Vec<(f64, f64)>,
    /// Displacement at each node, world axes; empty if the model has no inertia of the cable.
    displacement_w: Vec<Vec3>,
    /// Change δN of the tension vector at each node, world axes [N].
    tension_w: Vec<Vec3>,
    /// Force that holds the platform end in this motion, world axes [N].
    end_force_w: Vec3,
}

impl CableMotion {
    fn new(
        robot: &Robot,
        dynamics: &Dynamics,
        mode: &Mode,
        i: usize,
        state: &CableState,
        end_w: &Vec3,
        pieces: usize,
    ) -> Result<Self, crate::cable::catenary_dynamic::CatenaryDynamicError> {
        // Nodes of the integrals.
        let hanging = state.hanging.as_ref().expect("the catenary models have hanging cables");
        let length = state.unstrained_length;
        let rule = legendre::gauss(NODES);
        let step = length / pieces as f64;
        let nodes: Vec<(f64, f64)> = (0..pieces)
            .flat_map(|piece| {
                rule.iter().map(move |(x, weight)| ((piece as f64 + 0.5 * (1.0 + x)) * step, 0.5 * weight * step))
            })
            .collect();

        let Some((term, at)) = dynamics.terms().iter().zip(0..).find(|(term, _)| term.cable() == i) else {
            // Without inertia the tension vector changes by the same amount all along the cable.
            let end_force_w = hanging.tangent_w() * end_w;
            let tension_w = vec![-end_force_w; nodes.len()];
            return Ok(Self { nodes, displacement_w: Vec::new(), tension_w, end_force_w });
        };
        let DynamicCable::CatenaryDynamic(end) = term.form() else { unreachable!("other models were refused") };

        // Displacement at the nodes: slow shape and clamped modes. Modes with near poles have their amplitudes in the
        // mode.
        let arc_lengths = nodes.iter().map(|(s, _)| *s).collect();
        let (_, stations) = CatenaryDynamic::with_stations(
            &hanging.catenary,
            None,
            end.mass_per_length,
            end.cable.limit,
            arc_lengths,
            false,
        )?;
        let axes = [&end.axes.e, &end.axes.n, &end.axes.b];
        let omega = mode.frequency_hz * TAU;
        let start = axes.map(|axis| axis.dot(end_w).into());
        let mut motion = InternalMotion::new(&end.cable, start, (omega * omega).into());
        let platform_w = dynamics.coordinates().expand(&mode.motion.platform);
        let largest = platform_w[platform_w.iamax()];
        let scale = if mode.shape.iter().all(|component| *component == 0.0) { 1.0 } else { 1.0 / largest };
        for near in mode.motion.near.iter().filter(|near| near.term == at) {
            let family = motion.amplitudes(near.family);
            family[near.pole] = (near.amplitude * scale).into();
        }
        let displacement_w: Vec<Vec3> = (0..nodes.len())
            .map(|k| {
                let components = stations.displacement(k, &motion);
                components.iter().zip(axes).map(|(component, axis)| axis * component.re).sum()
            })
            .collect();

        // Momentum: δN(s) = δN(0) − ω² m ∫₀ˢ δp ds.
        let factor = -omega * omega * robot.cables[i].material.mass_per_length;
        let gathered = gathered(&rule, step, &displacement_w);

        // The anchor is held: the strains of δN along the cable add up to −a, where a is the motion of the platform
        // end.
        let mut beyond = Vec3::zeros();
        for ((s, weight), gathered) in nodes.iter().zip(&gathered) {
            beyond += compliance(&TensionVector::at(state, *s), hanging.catenary.rope().axial_stiffness)
                * gathered
                * (*weight * factor);
        }
        let at_start = -(hanging.tangent_w() * (end_w + beyond));
        let tension_w = gathered.iter().map(|gathered| at_start + gathered * factor).collect();
        Ok(Self { nodes, displacement_w, tension_w, end_force_w: -at_start })
    }

    /// Change of the quadratic form of this cable at constant motion.
    fn energy_change(
        &self,
        robot: &Robot,
        i: usize,
        state: &CableState,
        change: &CableChange,
        by: &CableDerivative,
        omega: f64,
    ) -> f64 {
        let material = &robot.cables[i].material;
        let (stiffness, length) = (material.axial_stiffness, state.unstrained_length);

        // Integrals along the cable.
        let (mut by_force, mut by_load) = (Vec3::zeros(), Vec3::zeros());
        let (mut by_stiffness, mut work) = (0.0, 0.0);
        for ((s, weight), change_w) in self.nodes.iter().zip(&self.tension_w) {
            let tension = TensionVector::at(state, *s);
            // Third derivative of |N|, twice along δN.
            let along = tension.direction.dot(change_w);
            let transverse = change_w - tension.direction * along;
            let third =
                (tension.direction * transverse.norm_squared() + transverse * (2.0 * along)) / tension.size.powi(2);
            by_force += third * *weight;
            by_load += third * (*weight * s / length);
            by_stiffness += change_w.norm_squared() * weight / stiffness.powi(2);
            work += change_w.dot(&(compliance(&tension, stiffness) * change_w)) * weight;
        }
        let squares: f64 =
            self.nodes.iter().zip(&self.displacement_w).map(|((_, weight), p)| weight * p.norm_squared()).sum();

        by_force.dot(&by.force_on_platform_w)
            - by_load.dot(&(by.load_w * length + load_of(state) * by.unstrained_length))
            + by_stiffness * change.axial_stiffness
            - (work + omega * omega * material.mass_per_length * squares) * by.unstrained_length / length
            - omega * omega * squares * change.mass_per_length
    }
}

/// Tension vector at a point of a cable at equilibrium.
struct TensionVector {
    direction: Vec3,
    size: f64,
}

impl TensionVector {
    /// Tension vector at an unstrained arc length s from the platform [m]: N = f − s q.
    fn at(state: &CableState, s: f64) -> Self {
        let vector = state.force_on_platform_w - load_of(state) * s;
        let size = vector.norm();
        Self { direction: vector / size, size }
    }
}

/// Derivative of dp/ds by the tension vector: `I/EA + (I − ttᵀ)/T` [1/N].
fn compliance(tension: &TensionVector, axial_stiffness: f64) -> Mat3 {
    let along = tension.direction * tension.direction.transpose();
    Mat3::identity() / axial_stiffness + (Mat3::identity() - along) / tension.size
}

/// Integrals of a vector from the start of the cable to every node, from the polynomial through the nodes of each
/// piece.
fn gathered(rule: &[(f64, f64)], step: f64, values: &[Vec3]) -> Vec<Vec3> {
    let count = rule.len();
    // Orthonormal polynomials at the nodes, and their integrals from −1: of P_k it is (P_{k+1} − P_{k−1})/(2k + 1).
    let at_nodes: Vec<Vec<f64>> = rule.iter().map(|(x, _)| legendre::orthonormal(*x, count)).collect();
    let plain = |values: &[f64], k: usize| values[k] / (k as f64 + 0.5).sqrt();
    let integral = |values: &[f64], k: usize| {
        let below = if k == 0 { -1.0 } else { plain(values, k - 1) };
        (plain(values, k + 1) - below) / (2.0 * k as f64 + 1.0) * (k as f64 + 0.5).sqrt()
    };

    let mut sums = Vec::with_capacity(values.len());
    let mut before = Vec3::zeros();
    for piece in values.chunks_exact(count) {
        let coefficients: Vec<Vec3> = (0..count)
            .map(|k| piece.iter().zip(rule).zip(&at_nodes).map(|((p, (_, weight)), own)| p * (weight * own[k])).sum())
            .collect();
        for own in &at_nodes {
            let inside: Vec3 =
                coefficients.iter().enumerate().map(|(k, coefficient)| coefficient * integral(own, k)).sum();
            sums.push(before + inside * (0.5 * step));
        }
        before += piece.iter().zip(rule).map(|(p, (_, weight))| p * *weight).sum::<Vec3>() * (0.5 * step);
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::modes;
    use crate::statics::derivatives::at_held_lengths;
    use crate::statics::{StaticModel, solve};

    #[test]
    fn the_integrals_are_those_of_half_as_many_pieces() {
        for text in [funicular_robots::YUAN2014_4MM, funicular_robots::FAST, funicular_robots::STADIUM_CAMERA] {
            let robot = Robot::from_toml(text).unwrap();
            let rest = solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
            let linearisation = Linearisation { cable_model: CableModel::CatenaryDynamic, ..Linearisation::default() };
            let dynamics = Dynamics::about(&robot, &rest, linearisation, 2.0).unwrap();
            let change = RobotChange::of_mass(&robot);
            let by = at_held_lengths(&robot, &rest, &change).unwrap();
            let modes = modes::below(&dynamics, 2.0).modes;
            let compared = modes.iter().filter(|mode| mode.multiplicity == 1).map(|mode| {
                let [half, whole] = [PIECES / 2, PIECES]
                    .map(|pieces| in_pieces(&robot, &rest, &dynamics, mode, &change, &by, pieces).unwrap());
                // Relative to the largest effect that the platform's mass can have on a frequency.
                let scale = mode.frequency_hz / robot.platform.mass;
                assert!((half - whole).abs() < 1e-9 * scale, "{} {}: {half} {whole}", robot.name, mode.frequency_hz);
            });
            assert!(compared.count() > 2, "{}", robot.name);
        }
    }

    #[test]
    fn a_power_is_integrated_to_every_node() {
        let rule = legendre::gauss(6);
        let step = 0.7;
        let nodes: Vec<f64> = (0..3)
            .flat_map(|piece| rule.iter().map(move |(x, _)| (f64::from(piece) + 0.5 * (1.0 + x)) * step))
            .collect();
        for power in 0..6 {
            let values: Vec<Vec3> = nodes.iter().map(|s| Vec3::new(s.powi(power), 0.0, -1.0)).collect();
            for (s, sum) in nodes.iter().zip(gathered(&rule, step, &values)) {
                let exact = s.powi(power + 1) / f64::from(power + 1);
                // The bound is the rounding of a dozen sums of size 2.
                assert!((sum - Vec3::new(exact, 0.0, -s)).amax() < 1e-14, "{power} {s} {sum}");
            }
        }
    }
}

//! Flexible supports in the quadratic form of the robot: their displacements are motions beside that of the platform.
//!
//! A support moves the far end of its cables, and the entry point of their drum sides along these. To the form it adds
//! its stiffness and mass, and the tension of drum sides from the ground, which turn (docs/theory.md, equation (60q)).

use super::adjoint::{Adjoint, CableAdjoint};
use super::scalar::{Field, Vector, add_times, dot, symmetric_outer, times, vector};
use crate::cable::catenary_dynamic::{Displacements, Family, PoleResidue, TwoEnded};
use crate::drive::DriveAtRest;
use crate::drive::derivatives::end;
use crate::math::{Mat3, Vec3};
use crate::robot::{DrumSide, Robot, Support};
use crate::statics::{CableState, Equilibrium, on_support, support_side};

/// Motion of a cable with its support.
#[derive(Debug, Clone, Copy)]
pub(super) struct Carrier<T> {
    /// Displacement of the far end, world axes.
    pub(super) displacement_w: Vector<T>,
    /// Motion of the entry point along the drum side, towards the platform.
    pub(super) along: T,
}

/// Motions of the entry point of a cable along its drum side in two motions of the robot.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sides<T> {
    pub(super) along: [T; 2],
    /// True if the drum stays on the ground, so that they stretch the drum side; else they carry it along.
    pub(super) from_ground: bool,
}

impl<T: Field> Sides<T> {
    /// Entry point at rest.
    pub(super) fn still() -> Self {
        Self { along: [T::default(); 2], from_ground: false }
    }
}

/// Forces of a drum side on its entry point along it, in two motions.
pub(super) type SideForces<T> = [T; 2];

/// Flexible supports of a robot about an equilibrium.
pub(super) struct SupportForm {
    supports: Vec<Support>,
    /// Cables on supports, in file order; `None` for a rigid anchor.
    cables: Vec<Option<CarriedForm>>,
}

/// Cable on a support.
struct CarriedForm {
    support: usize,
    /// Direction of the drum side; zero if its motion has no effect.
    direction_w: Vec3,
    side: SideForm,
    /// Resistance to a motion of the support at rest, and force on the platform with it, transposed; lever arm.
    resistance_w: Mat3,
    by_platform_w: Mat3,
    lever_w: Vec3,
}

/// Drum side that a support moves.
enum SideForm {
    None,
    /// From a drum on the ground: length and tension.
    FromGround {
        length: f64,
        tension: f64,
    },
    /// Rod that moves with the support.
    Carried(Rod),
}

/// Mass of a drum side that moves with its support, and the quantities on which this mass depends.
struct Rod {
    mass: f64,
    mass_per_length: f64,
    axial_stiffness: f64,
    stretch: f64,
    rope_compliance: f64,
    /// True if a pulley gives its direction, false if it follows the cable.
    has_pulley: bool,
}

impl Rod {
    fn of(robot: &Robot, i: usize, state: &CableState) -> Option<Self> {
        let (anchor, material) = (&robot.cables[i].anchor, &robot.cables[i].material);
        let drive: &DriveAtRest = state.drive.as_deref()?;
        let (stretch, rope_compliance) = (drive.end.stretch, drive.end.rope_compliance);
        let is_rod = anchor.winch.as_ref().is_some_and(|winch| winch.drum_side == DrumSide::Rod);
        if !is_rod || rope_compliance <= 0.0 {
            return None;
        }
        let (axial_stiffness, mass_per_length) = (material.axial_stiffness, material.mass_per_length);
        // A rod of the length EA/k, k = 1/(λ²Γ).
        let mass = mass_per_length * axial_stiffness * stretch * stretch * rope_compliance;
        let has_pulley = anchor.pulley.is_some();
        Some(Self { mass, mass_per_length, axial_stiffness, stretch, rope_compliance, has_pulley })
    }
}

impl SupportForm {
    /// Supports of a robot; `None` on a rigid frame. `has_rods` if drum sides have mass.
    pub(super) fn of(robot: &Robot, equilibrium: &Equilibrium, has_rods: bool) -> Option<Self> {
        if !robot.has_supports() {
            return None;
        }
        let of_cable = |(i, state): (usize, &CableState)| {
            let anchor = &robot.cables[i].anchor;
            let (support, found) = (anchor.support?, support_side(robot, i, state)?);
            let held = state.hanging.as_ref()?.tangent_w();
            let at_rest = on_support(robot, i, state, &held)?;
            let tension = state.drive.as_ref().map_or(0.0, |drive| drive.tension_drum);

            let side = if found.from_ground {
                let side_w = anchor.pulley.as_ref()?.entry_direction_w * anchor.drum_side_length();
                SideForm::FromGround { length: (side_w + state.displacement_w).norm(), tension }
            } else {
                Rod::of(robot, i, state).filter(|_| has_rods).map_or(SideForm::None, SideForm::Carried)
            };
            let direction_w = if matches!(side, SideForm::None) { Vec3::zeros() } else { found.direction_w };
            Some(CarriedForm {
                support,
                direction_w,
                side,
                resistance_w: at_rest.stiffness_w,
                by_platform_w: at_rest.force_w.transpose(),
                lever_w: state.lever_w,
            })
        };

        let cables = equilibrium.cables.iter().enumerate().map(of_cable).collect();
        Some(Self { supports: robot.supports.clone(), cables })
    }

    /// Motion of a cable with its support; `None` for a rigid anchor.
    pub(super) fn carrier<T: Field>(&self, i: usize, supports: &[Vector<T>]) -> Option<Carrier<T>> {
        let carried = self.cables[i].as_ref()?;
        let displacement_w = supports[carried.support];
        Some(Carrier { displacement_w, along: dot(&displacement_w, &vector(&carried.direction_w)) })
    }

    /// Motions of a cable's entry point along its drum side in two motions of the robot.
    pub(super) fn sides<T: Field>(&self, i: usize, a: &[Vector<T>], b: &[Vector<T>]) -> Sides<T> {
        let (Some(of_a), Some(of_b)) = (self.carrier(i, a), self.carrier(i, b)) else { return Sides::still() };
        let from_ground = matches!(&self.cables[i], Some(CarriedForm { side: SideForm::FromGround { .. }, .. }));
        Sides { along: [of_a.along, of_b.along], from_ground }
    }

    /// Displacements of the supports that follow a motion of the platform (translation, rotation) at rest.
    pub(super) fn at_rest(&self, v: &[f64; 3], theta: &[f64; 3]) -> Vec<Vector<f64>> {
        let mut forces = vec![Vec3::zeros(); self.supports.len()];
        let mut resistances: Vec<Mat3> = self.supports.iter().map(|support| support.stiffness_w).collect();
        for carried in self.cables.iter().flatten() {
            let end_w = Vec3::from(*v) + Vec3::from(*theta).cross(&carried.lever_w);
            forces[carried.support] += carried.by_platform_w * end_w;
            resistances[carried.support] += carried.resistance_w;
        }
        let followed = |(resistance, force): (&Mat3, &Vec3)| -> Vector<f64> {
            (resistance.try_inverse().unwrap_or_else(Mat3::zeros) * force).into()
        };
        resistances.iter().zip(&forces).map(followed).collect()
    }

    /// Adds `factor` times the coefficients of the terms by which a support extends the form of one of its cables, over
    /// two motions. `forces` are the forces of the drum side on its entry point.
    pub(super) fn add_cable<T: Field>(
        &self,
        sum: &mut CableAdjoint<T>,
        i: usize,
        (a, b): (&[Vector<T>], &[Vector<T>]),
        forces: &SideForces<T>,
        (own_square, factor): (T, T),
    ) {
        let Some(carried) = &self.cables[i] else { return };
        let (a, b) = (&a[carried.support], &b[carried.support]);
        let direction: Vector<T> = vector(&carried.direction_w);
        let [along_a, along_b] = [a, b].map(|of| dot(of, &direction));
        let across = dot(a, b) - along_a * along_b;

        // Coefficient of the direction in which the entry point moves.
        let mut by_direction = times(b, factor * forces[0]);
        add_times(&mut by_direction, a, factor * forces[1]);
        match &carried.side {
            SideForm::None => {}
            SideForm::FromGround { length, tension } => {
                // The tension turns: T/ℓ on the motion across.
                let turned = factor * (tension / length);
                add_times(&mut by_direction, b, -(turned * along_a));
                add_times(&mut by_direction, a, -(turned * along_b));
                sum.end[end::TENSION_DRUM] += factor * across * (1.0 / length);

                // The direction is that of a vector with this length.
                let radial = dot(&by_direction, &direction) + turned * across;
                add_times(&mut by_direction, &direction, -radial);
                add_times(&mut sum.side.vector, &by_direction, T::from(1.0 / length));
            }
            SideForm::Carried(rod) => {
                let inertia = -(factor * own_square);
                add_times(&mut by_direction, b, -(inertia * along_a * rod.mass));
                add_times(&mut by_direction, a, -(inertia * along_b * rod.mass));
                let by_mass = inertia * across * rod.mass;
                sum.mass += by_mass * (1.0 / rod.mass_per_length);
                sum.stiffness += by_mass * (1.0 / rod.axial_stiffness);
                sum.end[end::STRETCH] += by_mass * (2.0 / rod.stretch);
                sum.end[end::ROPE_COMPLIANCE] += by_mass * (1.0 / rod.rope_compliance);
                Self::add_direction(sum, rod, &by_direction);
            }
        }
    }

    /// Adds the coefficient of the direction along which a support carries a drum side.
    fn add_direction<T: Field>(sum: &mut CableAdjoint<T>, rod: &Rod, by_direction: &Vector<T>) {
        if rod.has_pulley {
            add_times(&mut sum.side.entry_direction, by_direction, T::from(1.0));
        } else {
            for (sum, by) in sum.end[end::TRAVEL..].iter_mut().zip(by_direction) {
                *sum += *by;
            }
        }
    }

    /// Adds the coefficient of the direction of the drum side by a force on its entry point along it, in a motion.
    pub(super) fn add_side_force<T: Field>(
        &self,
        sum: &mut CableAdjoint<T>,
        i: usize,
        supports: &[Vector<T>],
        force: T,
    ) {
        let Some(carried) = &self.cables[i] else { return };
        let mut by_direction = times(&supports[carried.support], force);
        match &carried.side {
            SideForm::None => {}
            SideForm::FromGround { length, .. } => {
                let direction: Vector<T> = vector(&carried.direction_w);
                let radial = dot(&by_direction, &direction);
                add_times(&mut by_direction, &direction, -radial);
                add_times(&mut sum.side.vector, &by_direction, T::from(1.0 / length));
            }
            SideForm::Carried(rod) => Self::add_direction(sum, rod, &by_direction),
        }
    }

    /// Adds `factor` times the coefficients of stiffness, mass and damping of the supports over two motions. `loss` is
    /// the factor of 2ζ: i with all damping.
    pub(super) fn add_own<T: Field>(
        &self,
        sum: &mut Adjoint<T>,
        (a, b): (&[Vector<T>], &[Vector<T>]),
        (own_square, loss): (T, T),
        factor: T,
    ) {
        for (k, (support, (a, b))) in self.supports.iter().zip(a.iter().zip(b)).enumerate() {
            let of_support = sum.support(k);
            let by_stiffness = factor * (T::from(1.0) + loss * (2.0 * support.damping_ratio));
            for (sum, row) in of_support.stiffness.iter_mut().zip(symmetric_outer(a, b)) {
                add_times(sum, &row, by_stiffness);
            }
            of_support.mass += -(factor * own_square * dot(a, b));
            let pulled: Vector<T> = std::array::from_fn(|i| {
                let row: Vector<T> = vector(&support.stiffness_w.row(i).transpose());
                dot(&row, b)
            });
            of_support.damping_ratio += factor * loss * dot(a, &pulled) * 2.0;
        }
    }
}

/// Motion of clamped modes and drive by a motion of the entry point along the drum side.
pub(super) struct AlongDrumSide {
    /// Slow motions of the drive.
    still: Vec<f64>,
    /// Participation and slow amplitude of each mode in plane, out of plane, and of both together.
    families: [Vec<(f64, f64)>; 3],
}

impl AlongDrumSide {
    pub(super) fn of(both: &TwoEnded) -> Self {
        let families =
            [Family::InPlane, Family::OutOfPlane, Family::Coupled].map(|family| both.along_drum_side(family));
        Self { still: both.still_along_drum_side(), families }
    }

    /// Adds the slow motions of the drive.
    pub(super) fn add_motions<T: Field>(&self, motions: &mut [T], along: T) {
        motions.iter_mut().zip(&self.still).for_each(|(motion, still)| *motion += along * *still);
    }

    /// Adds the slow amplitudes of the modes, which their amplitudes beside a pole do not contain.
    pub(super) fn add_still<T: Field>(&self, families: [&mut Vec<T>; 3], along: T) {
        for (amplitudes, modes) in families.into_iter().zip(&self.families) {
            amplitudes.iter_mut().zip(modes).for_each(|(amplitude, (_, still))| *amplitude += along * *still);
        }
    }

    /// Participation of a mode of a family: in plane, out of plane, or both together.
    fn participation(&self, family: usize, index: usize) -> f64 {
        self.families[family].get(index).map_or(0.0, |mode| mode.0)
    }
}

/// Adds the amplitudes of clamped modes by a motion of the far end at x = ω_c². `far` are the components of the motion
/// in the family, given by its number. Amplitudes for which `is_given` is true stay.
pub(super) fn add_far_amplitudes<T: Field, const N: usize, const E: usize>(
    amplitudes: &mut [T],
    family: &PoleResidue<N, E>,
    far: &[T],
    (side, number, along): (Option<&AlongDrumSide>, usize, T),
    square: T,
    is_given: impl Fn(usize) -> bool,
) {
    let modes = family.poles.iter().zip(&family.participation);
    for (index, (amplitude, (pole, g))) in amplitudes.iter_mut().zip(modes).enumerate() {
        if is_given(index) {
            continue;
        }
        let mut moved = along * side.map_or(0.0, |side| side.participation(number, index));
        far.iter().zip(&g[N - far.len()..]).for_each(|(u, g)| moved += *u * *g);
        *amplitude += square * moved / (T::from(*pole) - square);
    }
}

/// Adds slow motions of a drive for a motion of the far end.
pub(super) fn add_far_motions<T: Field, const D: usize, const N: usize>(
    motions: &mut [T],
    of: &Displacements<D, N>,
    far: &[T],
) {
    for (sum, still) in motions.iter_mut().zip(&of.still) {
        far.iter().zip(&still[0][N - far.len()..]).for_each(|(u, psi)| *sum += *u * *psi);
    }
}

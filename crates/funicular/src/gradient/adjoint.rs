//! Coefficients of the differential of a scalar over the state of the equilibrium. [`pullback`](super::pullback)
//! follows them back to the numbers of the robot.

use super::scalar::{Field, Vector};
use crate::drive::derivatives::{VARIABLES, end};

/// Derivatives of a scalar with respect to each quantity of the state at rest, all others held. They are the
/// coefficients of df, dr, dq and so on in its differential; world axes.
#[derive(Debug, Clone)]
pub(super) struct Adjoint<T> {
    /// Coefficients of the motion of the platform: translation of its origin, and rotation vector.
    pub(super) translation: Vector<T>,
    pub(super) rotation: Vector<T>,
    /// Coefficients of the force at the centre of mass, and of the arm of that centre.
    pub(super) weight: Vector<T>,
    pub(super) center: Vector<T>,
    /// Coefficients of the load: of its force, of the arm of its point, and of its moment.
    pub(super) force: Vector<T>,
    pub(super) point: Vector<T>,
    pub(super) moment: Vector<T>,
    /// Coefficient of the mass of the platform as inertia.
    pub(super) mass: T,
    /// Coefficient of the acceleration of gravity, without the forces that contain it.
    pub(super) gravity: Vector<T>,
    /// Coefficients of the inertia tensor about the centre of mass, symmetric.
    pub(super) inertia: [Vector<T>; 3],
    /// Coefficients of the viscous damping matrices of the platform, symmetric.
    pub(super) translational_damping: [Vector<T>; 3],
    pub(super) rotational_damping: [Vector<T>; 3],
    /// Coefficient of the mean distance of the attachments from the origin of the platform.
    pub(super) ell: T,
    /// Coefficients of the cables, in file order.
    pub(super) cables: Vec<CableAdjoint<T>>,
    /// Coefficients of the flexible supports; zero for supports beyond the end of the list.
    pub(super) supports: Vec<SupportAdjoint<T>>,
}

/// Coefficients of one flexible support.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct SupportAdjoint<T> {
    /// Coefficient of its displacement at rest, without the chords and drum sides that contain it.
    pub(super) displacement: Vector<T>,
    /// Coefficients of its stiffness, symmetric.
    pub(super) stiffness: [Vector<T>; 3],
    /// Coefficients of its mass and of its damping ratio.
    pub(super) mass: T,
    pub(super) damping_ratio: T,
}

/// Coefficients of a drum side to a displaced support.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct SideAdjoint<T> {
    /// Coefficient of the vector from the drum to the entry point, without that of its length, which is the length of
    /// the drum side at rest.
    pub(super) vector: Vector<T>,
    /// Coefficient of the length of the drum side that the robot file gives.
    pub(super) given_length: T,
    /// Coefficient of the direction in which a support carries the drum side along.
    pub(super) entry_direction: Vector<T>,
}

/// Coefficients of one cable.
#[derive(Debug, Clone, Default)]
pub(super) struct CableAdjoint<T> {
    /// Coefficient of the force on the platform.
    pub(super) force: Vector<T>,
    /// Coefficient of the lever arm.
    pub(super) lever: Vector<T>,
    /// Coefficient of the chord.
    pub(super) chord: Vector<T>,
    /// Coefficient of the load per unstrained length.
    pub(super) load: Vector<T>,
    /// Coefficient of the unstrained length.
    pub(super) length: T,
    /// Coefficient of the unstrained length of the free span, besides [`Self::length`]. Without a drive both lengths
    /// are equal.
    pub(super) free_length: T,
    /// Coefficient of the axial stiffness.
    pub(super) stiffness: T,
    /// Coefficient of the mass per length as inertia.
    pub(super) mass: T,
    /// Coefficient of the damping ratio, or of the viscous damping per length.
    pub(super) damping: T,
    /// Coefficients of the loss factor and of the damping time of its stretch.
    pub(super) stretch_loss: [T; 2],
    /// Coefficients of the numbers of the end at the exit point, in the order of
    /// [`end`](crate::drive::derivatives::end).
    pub(super) end: [T; end::COUNT],
    /// Coefficients of the outer variables of a cable with a drive, in the order of
    /// [`place`](crate::drive::derivatives::place), besides those that follow from its state.
    pub(super) outer: [T; VARIABLES],
    /// Coefficients of the numbers of the drive.
    pub(super) drive: DriveAdjoint<T>,
    /// Coefficients of the distance and the mass of each guide wheel; zero for wheels beyond the end of the list.
    pub(super) guides: Vec<[T; 2]>,
    /// Coefficients of its drum side, if a flexible support moves it.
    pub(super) side: SideAdjoint<T>,
}

impl<T: Field> CableAdjoint<T> {
    /// Coefficients of a guide wheel.
    fn guide(&mut self, wheel: usize) -> &mut [T; 2] {
        if self.guides.len() <= wheel {
            self.guides.resize(wheel + 1, [T::default(); 2]);
        }
        &mut self.guides[wheel]
    }

    /// Adds to the coefficient of the distance of a guide wheel.
    pub(super) fn guide_distance(&mut self, wheel: usize, coefficient: T) {
        self.guide(wheel)[0] += coefficient;
    }

    /// Adds to the coefficient of the mass of a guide wheel.
    pub(super) fn guide_mass(&mut self, wheel: usize, coefficient: T) {
        self.guide(wheel)[1] += coefficient;
    }
}

/// Coefficients of the numbers of a cable's drive that stand in its motion.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct DriveAdjoint<T> {
    /// Coefficients of the radius of the wheel, of its moment of inertia and of that of the swivel.
    pub(super) radius: T,
    pub(super) inertia: T,
    pub(super) swivel_inertia: T,
    /// Coefficient of the length from the drum to the entry point.
    pub(super) drum_side_length: T,
    /// Coefficient of the length that the winch pays out per tension at rest.
    pub(super) compliance: T,
    /// Coefficients of the stiffness of the winch, of the masses of drum and motor, and of the damping.
    pub(super) stiffness: T,
    pub(super) drum_mass: T,
    pub(super) motor_mass: T,
    pub(super) damping: T,
    /// Coefficients of the gains and of the delay of the control.
    pub(super) position_gain: T,
    pub(super) speed_gain: T,
    pub(super) delay: T,
}

impl<T: Field> DriveAdjoint<T> {
    fn map<U: Field>(&self, of: impl Fn(T) -> U) -> DriveAdjoint<U> {
        DriveAdjoint {
            radius: of(self.radius),
            inertia: of(self.inertia),
            swivel_inertia: of(self.swivel_inertia),
            drum_side_length: of(self.drum_side_length),
            compliance: of(self.compliance),
            stiffness: of(self.stiffness),
            drum_mass: of(self.drum_mass),
            motor_mass: of(self.motor_mass),
            damping: of(self.damping),
            position_gain: of(self.position_gain),
            speed_gain: of(self.speed_gain),
            delay: of(self.delay),
        }
    }
}

impl<T: Field> Adjoint<T> {
    /// Zero coefficients for a robot with this number of cables.
    pub(super) fn zeros(cables: usize) -> Self {
        let zero = [T::default(); 3];
        Self {
            translation: zero,
            rotation: zero,
            weight: zero,
            center: zero,
            force: zero,
            point: zero,
            moment: zero,
            mass: T::default(),
            gravity: zero,
            inertia: [zero; 3],
            translational_damping: [zero; 3],
            rotational_damping: [zero; 3],
            ell: T::default(),
            cables: vec![CableAdjoint::default(); cables],
            supports: Vec::new(),
        }
    }

    /// Coefficients of a flexible support.
    pub(super) fn support(&mut self, index: usize) -> &mut SupportAdjoint<T> {
        if self.supports.len() <= index {
            self.supports.resize(index + 1, SupportAdjoint::default());
        }
        &mut self.supports[index]
    }

    /// Coefficients of another scalar, whose differential is a linear function of this one's: `of` of each coefficient.
    pub(super) fn map<U: Field>(&self, of: impl Fn(T) -> U) -> Adjoint<U> {
        let vector = |v: &Vector<T>| v.map(&of);
        let matrix = |m: &[Vector<T>; 3]| m.map(|row| row.map(&of));
        let cable = |cable: &CableAdjoint<T>| CableAdjoint {
            force: vector(&cable.force),
            lever: vector(&cable.lever),
            chord: vector(&cable.chord),
            load: vector(&cable.load),
            length: of(cable.length),
            free_length: of(cable.free_length),
            stiffness: of(cable.stiffness),
            mass: of(cable.mass),
            damping: of(cable.damping),
            stretch_loss: cable.stretch_loss.map(&of),
            end: cable.end.map(&of),
            outer: cable.outer.map(&of),
            drive: cable.drive.map(&of),
            guides: cable.guides.iter().map(|guide| guide.map(&of)).collect(),
            side: SideAdjoint {
                vector: vector(&cable.side.vector),
                given_length: of(cable.side.given_length),
                entry_direction: vector(&cable.side.entry_direction),
            },
        };
        let support = |support: &SupportAdjoint<T>| SupportAdjoint {
            displacement: vector(&support.displacement),
            stiffness: matrix(&support.stiffness),
            mass: of(support.mass),
            damping_ratio: of(support.damping_ratio),
        };

        Adjoint {
            translation: vector(&self.translation),
            rotation: vector(&self.rotation),
            weight: vector(&self.weight),
            center: vector(&self.center),
            force: vector(&self.force),
            point: vector(&self.point),
            moment: vector(&self.moment),
            mass: of(self.mass),
            gravity: vector(&self.gravity),
            inertia: matrix(&self.inertia),
            translational_damping: matrix(&self.translational_damping),
            rotational_damping: matrix(&self.rotational_damping),
            ell: of(self.ell),
            cables: self.cables.iter().map(cable).collect(),
            supports: self.supports.iter().map(support).collect(),
        }
    }
}

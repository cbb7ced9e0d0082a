//! Clamped modes of a cable that vibrates: displacements of its points and motions of its drive.

use super::CableAt;
use super::sums::ShapeColumns;
use crate::cable::catenary_dynamic::{
    CatenaryDynamic, Displacements, DriveAt, DriveLosses, DriveMotion, Family, PoleResidue,
};
use crate::gradient::drive_form::VibratingDriveForm;
use crate::gradient::scalar::{Field, Vector};
use crate::gradient::support_form::{AlongDrumSide, add_far_amplitudes, add_far_motions};
use crate::math::{CDMat, Complex};

/// Cable that vibrates by its clamped modes, with the drive at its end.
pub(super) struct Vibrating {
    pub(super) cable: CatenaryDynamic,
    /// Number of points.
    pub(super) points: usize,
    /// Displacements of the points in plane, out of plane, and in all directions if the end couples both.
    pub(super) in_plane: ShapeColumns,
    pub(super) out_of_plane: ShapeColumns,
    pub(super) coupled: ShapeColumns,
    pub(super) drive: Option<VibratingEnd>,
    /// Number of motions of the drive in plane, with the stretches, and number of all motions.
    pub(super) along: usize,
    pub(super) count: usize,
    /// Motions along a drum side that a flexible support moves.
    pub(super) side: Option<AlongDrumSide>,
}

/// Drive at the end of a cable that vibrates.
pub(super) struct VibratingEnd {
    pub(super) form: VibratingDriveForm,
    /// Directions in which the end moves, in the axes of the cable, each with the motion.
    pub(super) directions: Vec<(usize, [f64; 3])>,
}

/// Losses of a drive at a frequency, for its motions.
#[derive(Debug, Clone)]
pub(in crate::gradient) struct LossesAt<T> {
    /// Stiffness Δ per motion besides that of the undamped model [N/m].
    pub(in crate::gradient) delta: Vec<T>,
    /// Receptance R, by rows, and (1 + R Δ)⁻¹.
    pub(in crate::gradient) receptance: Vec<Vec<T>>,
    pub(in crate::gradient) inverse: Vec<Vec<T>>,
}

/// Amplitude of a clamped mode that does not follow from the end: family, index, amplitude.
pub(in crate::gradient) type FamilyAmplitude<T> = (Family, usize, T);

/// Amplitudes of the clamped modes of a cable: in plane, out of plane, and of both together if the end couples them.
struct Amplitudes<T> {
    in_plane: Vec<T>,
    out_of_plane: Vec<T>,
    coupled: Vec<T>,
}

impl<T> Amplitudes<T> {
    /// Amplitudes by their families.
    fn by_families(&mut self) -> [(Family, &mut Vec<T>); 3] {
        [
            (Family::InPlane, &mut self.in_plane),
            (Family::OutOfPlane, &mut self.out_of_plane),
            (Family::Coupled, &mut self.coupled),
        ]
    }
}

/// True if the amplitude of a clamped mode is given.
fn is_given<T>(near: &[FamilyAmplitude<T>], family: Family, index: usize) -> bool {
    near.iter().any(|near| near.0 == family && near.1 == index)
}

impl Vibrating {
    /// Displacement of the points, axis by axis, for a motion of the platform end, and the motions of the drive. `far`
    /// are the motions of the far end and along the drum side with a flexible support.
    pub(super) fn displacement<T: Field>(
        &self,
        end: &Vector<T>,
        far: Option<&(Vector<T>, T)>,
        at: &CableAt<T>,
        near: &[FamilyAmplitude<T>],
        forces: &[T],
    ) -> (Vec<T>, Vec<T>) {
        let mut amplitudes = self.amplitudes(end, far, at.square, near);
        let mut motions = Vec::new();
        if let Some(shapes) = &self.cable.drive {
            motions = self.drive_motions(shapes, end, far, &mut amplitudes);
            // The losses and forces of the drive act on the clamped modes.
            if let Some(losses) = &at.losses {
                let act = losses.act_on(&mut motions, forces);
                self.add_forced(&mut amplitudes, shapes, &act, at.square, near);
            }
        }
        (self.point_displacements(end, far, &amplitudes), motions)
    }

    /// Amplitudes of the clamped modes for motions of both ends at ω_c²; those of the modes in `near` are given.
    fn amplitudes<T: Field>(
        &self,
        end: &Vector<T>,
        far: Option<&(Vector<T>, T)>,
        square: T,
        near: &[FamilyAmplitude<T>],
    ) -> Amplitudes<T> {
        let cable = &self.cable;
        let of = |family: Family| near.iter().filter(move |near| near.0 == family);
        let mut in_plane = amplitudes(&cable.in_plane, &[end[0], end[1]], square, of(Family::InPlane));
        let mut out_of_plane = amplitudes(&cable.out_of_plane, &[end[2]], square, of(Family::OutOfPlane));
        let mut coupled = match &cable.coupled {
            Some(family) => amplitudes(family, end, square, of(Family::Coupled)),
            None => Vec::new(),
        };

        if let Some((far, along)) = far {
            let given = |family: Family| move |index: usize| is_given(near, family, index);
            let by_side = |number: usize| (self.side.as_ref(), number, *along);
            add_far_amplitudes(&mut in_plane, &cable.in_plane, &far[..2], by_side(0), square, given(Family::InPlane));
            let (out, is_given) = (&mut out_of_plane, given(Family::OutOfPlane));
            add_far_amplitudes(out, &cable.out_of_plane, &far[2..], by_side(1), square, is_given);
            if let Some(family) = &cable.coupled {
                add_far_amplitudes(&mut coupled, family, far, by_side(2), square, given(Family::Coupled));
            }
        }
        Amplitudes { in_plane, out_of_plane, coupled }
    }

    /// Motions of the drive by the motions of both ends and the clamped modes. The amplitudes get the slow motion along
    /// a drum side.
    fn drive_motions<T: Field>(
        &self,
        shapes: &DriveMotion,
        end: &Vector<T>,
        far: Option<&(Vector<T>, T)>,
        amplitudes: &mut Amplitudes<T>,
    ) -> Vec<T> {
        let is_coupled = self.cable.coupled.is_some();
        let mut motions = vec![T::default(); self.count];
        let (along, sideways) = motions.split_at_mut(self.along);
        if is_coupled {
            add_motions(&mut motions, &shapes.coupled, end, &amplitudes.coupled);
        } else {
            add_motions(along, &shapes.along, &[end[0], end[1]], &amplitudes.in_plane);
            add_motions(sideways, &shapes.sideways, &[end[2]], &amplitudes.out_of_plane);
        }

        let Some((far, moved)) = far else { return motions };
        let (along, sideways) = motions.split_at_mut(self.along);
        if is_coupled {
            add_far_motions(&mut motions, &shapes.coupled, far);
        } else {
            add_far_motions(along, &shapes.along, &far[..2]);
            add_far_motions(sideways, &shapes.sideways, &far[2..]);
        }
        if let Some(side) = &self.side {
            side.add_motions(&mut motions, *moved);
            side.add_still(amplitudes.by_families().map(|(_, family)| family), *moved);
        }
        motions
    }

    /// Adds the amplitudes by forces on the drive at ω_c²; given amplitudes stay.
    fn add_forced<T: Field>(
        &self,
        amplitudes: &mut Amplitudes<T>,
        shapes: &DriveMotion,
        act: &[T],
        square: T,
        near: &[FamilyAmplitude<T>],
    ) {
        for (family, all) in amplitudes.by_families() {
            let modes = all.iter_mut().zip(self.cable.poles_of(family)).enumerate();
            for (index, (amplitude, pole)) in modes.filter(|(index, _)| !is_given(near, family, *index)) {
                let mut force = T::default();
                shapes.in_mode(family, index).iter().zip(act).for_each(|(phi, act)| force += *act * *phi);
                *amplitude += -(force / (T::from(*pole) - square));
            }
        }
    }

    /// Displacements of the points, axis by axis, by the motions of both ends and the clamped modes.
    fn point_displacements<T: Field>(
        &self,
        end: &Vector<T>,
        far: Option<&(Vector<T>, T)>,
        amplitudes: &Amplitudes<T>,
    ) -> Vec<T> {
        let mut displacement = vec![T::default(); 3 * self.points];
        if self.cable.coupled.is_some() {
            self.coupled.add(&mut displacement, end, &amplitudes.coupled);
            if let Some((far, _)) = far {
                self.coupled.add_far(&mut displacement, far);
            }
            return displacement;
        }

        let (plane, normal) = displacement.split_at_mut(2 * self.points);
        self.in_plane.add(plane, &end[..2], &amplitudes.in_plane);
        self.out_of_plane.add(normal, &end[2..], &amplitudes.out_of_plane);
        if let Some((far, _)) = far {
            self.in_plane.add_far(plane, &far[..2]);
            self.out_of_plane.add_far(normal, &far[2..]);
        }
        displacement
    }
}

impl LossesAt<Complex> {
    /// Losses of a drive with these motions.
    pub(in crate::gradient) fn of(motions: &DriveAt, losses: &DriveLosses) -> Self {
        let delta: Vec<Complex> = losses.0.iter().map(|(value, _)| *value).collect();
        let rows = |matrix: &CDMat| matrix.row_iter().map(|row| row.iter().copied().collect()).collect();
        Self { receptance: rows(&motions.receptance), inverse: rows(&motions.inverse(&delta)), delta }
    }
}

impl<T: Field> LossesAt<T> {
    /// Applies losses and given forces to the motions of a drive. The result is the forces with which the drive
    /// resists: the forces of the losses less the given ones.
    fn act_on(&self, motions: &mut Vec<T>, forces: &[T]) -> Vec<T> {
        let product = |matrix: &[Vec<T>], vector: &[T]| -> Vec<T> {
            let row = |row: &Vec<T>| {
                let mut sum = T::default();
                row.iter().zip(vector).for_each(|(entry, value)| sum += *entry * *value);
                sum
            };
            matrix.iter().map(row).collect()
        };
        let by_forces = product(&self.receptance, forces);
        motions.iter_mut().zip(&by_forces).for_each(|(motion, moved)| *motion += *moved);
        *motions = product(&self.inverse, motions);
        let mut act: Vec<T> = motions.iter().zip(&self.delta).map(|(motion, delta)| *motion * *delta).collect();
        act.iter_mut().zip(forces).for_each(|(act, force)| *act += -*force);
        act
    }
}

/// Adds the motions of a drive by a motion of the platform end; they are the first components of the stations.
fn add_motions<T: Field, const D: usize, const N: usize>(
    motions: &mut [T],
    of: &Displacements<D, N>,
    end: &[T; D],
    amplitudes: &[T],
) {
    for (sum, still) in motions.iter_mut().zip(&of.still) {
        end.iter().zip(&still[0]).for_each(|(u, psi)| *sum += *u * *psi);
    }
    for (mode, q) in of.modes.iter().zip(amplitudes) {
        motions.iter_mut().zip(mode).for_each(|(sum, phi)| *sum += *q * phi[0]);
    }
}

/// Amplitudes of the clamped modes (unit modal mass) for a motion of the platform end, `q_k = ω_c² g_k·u/(ω_k² −
/// ω_c²)`. The amplitudes of the modes in `near` are given.
fn amplitudes<'n, T: Field + 'n, const N: usize, const E: usize, const M: usize>(
    family: &PoleResidue<N, E>,
    end: &[T; M],
    square: T,
    near: impl Iterator<Item = &'n FamilyAmplitude<T>>,
) -> Vec<T> {
    let mut all: Vec<T> = (family.poles.iter().zip(&family.participation))
        .map(|(pole, g)| {
            let mut drive = T::default();
            for (u, g) in end.iter().zip(g) {
                drive += *u * *g;
            }
            square * drive / (T::from(*pole) - square)
        })
        .collect();
    for (_, index, amplitude) in near {
        all[*index] = *amplitude;
    }
    all
}

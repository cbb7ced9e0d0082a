//! Motions of the drive at the end of a cable, and the terms that its losses add to the undamped model.
//!
//! The clamped modes of a cable contain the motions of its drive. What an undamped model cannot hold is added
//! afterwards, exactly: with the motion `z = T u − R p` of the drive under the motion u of the platform end and the
//! forces p that the drive has besides, `p = Δ z`, the cable has the stiffness `K + Tᵀ Δ (1 + R Δ)⁻¹ T`
//! (docs/theory.md, equations (80) and (81)).

use super::moving_end::MovingEnd;
use super::{CatenaryDynamic, CatenaryDynamicEnd, Displacements, Family, InternalMotion, NearRanges, PoleResidue};
use crate::cable::LocalStiffness;
use crate::drive::DriveChain;
use crate::math::{CDMat, Complex, DMat};
use std::ops::Range;

/// Motions of a drive, and those in which a rope with loss stretches, in the clamped modes of their cable. In each
/// displacement the first component is the motion.
#[derive(Debug, Clone, PartialEq)]
pub struct DriveMotion {
    /// Motions of the chain along the cable and stretches, in the modes in plane.
    pub along: Displacements<2, 4>,
    /// Motion sideways, if the end has one, in the modes out of plane.
    pub sideways: Displacements<1, 2>,
    /// All motions, those of the chain, the stretches and then that sideways, for an end that couples the families.
    pub coupled: Displacements<3, 6>,
    /// Static response of all motions to unit forces on them, the platform end of the cable held [m/N].
    pub(super) flexibility: DMat,
}

/// Motions of a drive at x = ω² without the poles left out.
pub(crate) type MotionsOfDrive<'a> = dyn Fn(f64, &NearRanges) -> Vec<f64> + 'a;

/// Motions of a drive at one frequency: those of the chain, the stretches, then that sideways if there is one.
pub(crate) struct DriveAt {
    /// T: motion per component (e, n, b) of the platform end, and its derivative by x = ω_c².
    pub(crate) transfer: Vec<[Complex; 3]>,
    pub(crate) transfer_slope: Vec<[Complex; 3]>,
    /// R: motion per force, the platform end held, and its derivative by x [m/N].
    pub(crate) receptance: CDMat,
    pub(crate) receptance_slope: CDMat,
}

impl DriveAt {
    /// First `count` motions of a drive at x = ω_c², without the poles `left_out`.
    pub(super) fn at(
        cable: &CatenaryDynamic,
        drive: &DriveMotion,
        count: usize,
        x: Complex,
        left_out: &NearRanges,
    ) -> Self {
        Self::of((cable, drive), &(0..count).collect::<Vec<usize>>(), x, left_out)
    }

    /// The given motions of a drive, ascending, at x = ω_c², without the poles `left_out`.
    fn of(
        (cable, drive): (&CatenaryDynamic, &DriveMotion),
        motions: &[usize],
        x: Complex,
        left_out: &NearRanges,
    ) -> Self {
        let (zero, count) = (Complex::new(0.0, 0.0), motions.len());
        let mut at = Self {
            transfer: vec![[zero; 3]; count],
            transfer_slope: vec![[zero; 3]; count],
            receptance: CDMat::from_fn(count, count, |i, j| drive.flexibility[(motions[i], motions[j])].into()),
            receptance_slope: CDMat::zeros(count, count),
        };
        if let Some(coupled) = &cable.coupled {
            at.add(coupled, &drive.coupled, 0, motions, [0, 1, 2], x, &left_out.coupled);
            return at;
        }
        let sideways = drive.along.still.len();
        let (along, beside) = motions.split_at(motions.partition_point(|motion| *motion < sideways));
        at.add(&cable.in_plane, &drive.along, 0, along, [0, 1], x, &left_out.in_plane);
        let beside: Vec<usize> = beside.iter().map(|motion| motion - sideways).collect();
        at.add(&cable.out_of_plane, &drive.sideways, along.len(), &beside, [2], x, &left_out.out_of_plane);
        at
    }

    /// Motion per component (e, n, b) of the carrier of the end, the platform end held, for the first `count` motions.
    pub(super) fn by_carrier(
        cable: &CatenaryDynamic,
        drive: &DriveMotion,
        count: usize,
        x: Complex,
    ) -> Vec<[Complex; 3]> {
        let mut rows = vec![[Complex::new(0.0, 0.0); 3]; count];
        let along = drive.along.still.len();
        add_carrier(&mut rows, &cable.in_plane, &drive.along, 0, [0, 1], x);
        if count > along {
            add_carrier(&mut rows, &cable.out_of_plane, &drive.sideways, along, [2], x);
        }
        if let Some(coupled) = &cable.coupled {
            add_carrier(&mut rows, coupled, &drive.coupled, 0, [0, 1, 2], x);
        }
        rows
    }

    /// Adds the given motions of one family, as rows from `first` on, by its modes, for the components `axes` of the
    /// platform end.
    #[expect(clippy::too_many_arguments, reason = "motions of a family, a frequency, and the poles left out")]
    fn add<const D: usize, const N: usize, const E: usize>(
        &mut self,
        family: &PoleResidue<N, E>,
        motion: &Displacements<D, N>,
        first: usize,
        motions: &[usize],
        axes: [usize; D],
        x: Complex,
        left_out: &Range<usize>,
    ) {
        if motions.is_empty() {
            return;
        }
        for (row, of) in self.transfer[first..].iter_mut().zip(motions) {
            for (still, axis) in motion.still[*of][0].iter().zip(axes) {
                row[axis] += *still;
            }
        }

        let mut phi = vec![0.0; motions.len()];
        for (k, (pole, g)) in family.poles.iter().zip(&family.participation).enumerate() {
            phi.iter_mut().zip(motions).for_each(|(phi, of)| *phi = motion.modes[k][*of][0]);
            if left_out.contains(&k) {
                // The mode is an unknown beside these motions: only its static response, which the flexibility
                // contains, has to be taken out.
                self.add_receptance(first, &phi, (-1.0 / pole).into(), Complex::new(0.0, 0.0));
                continue;
            }

            // x/(p − x), x/(p (p − x)) and their derivatives p/(p − x)², 1/(p − x)².
            let inverse = (*pole - x).inv();
            let square = inverse * inverse;
            let (by_end, by_end_slope) = (x * inverse, square * *pole);
            self.add_receptance(first, &phi, by_end / *pole, square);
            let rows = self.transfer[first..].iter_mut().zip(&mut self.transfer_slope[first..]);
            for ((row, slope), phi) in rows.zip(&phi) {
                for (g, axis) in g.iter().zip(axes) {
                    row[axis] += by_end * (phi * g);
                    slope[axis] += by_end_slope * (phi * g);
                }
            }
        }
        self.mirror_receptance(first..first + motions.len());
    }

    /// Adds a mode with the motions `phi`, which begin at the row `first`, to R and its derivative, with these factors.
    /// R is symmetric: only the part on and below the diagonal is summed over the modes.
    #[inline]
    fn add_receptance(&mut self, first: usize, phi: &[f64], factor: Complex, slope: Complex) {
        for (j, by) in phi.iter().enumerate() {
            for (i, of) in phi.iter().enumerate().skip(j) {
                self.receptance[(first + i, first + j)] += factor * (of * by);
                self.receptance_slope[(first + i, first + j)] += slope * (of * by);
            }
        }
    }

    /// Copies the part of R below the diagonal, and of its derivative, to the part above it.
    fn mirror_receptance(&mut self, rows: Range<usize>) {
        for i in rows.clone() {
            for j in rows.start..i {
                self.receptance[(j, i)] = self.receptance[(i, j)];
                self.receptance_slope[(j, i)] = self.receptance_slope[(i, j)];
            }
        }
    }

    /// `(1 + R Δ)⁻¹`; not finite at a resonance of the drive without damping.
    pub(crate) fn inverse(&self, delta: &[Complex]) -> CDMat {
        let count = delta.len();
        let one =
            CDMat::from_fn(count, count, |i, j| self.receptance[(i, j)] * delta[j] + if i == j { 1.0 } else { 0.0 });
        one.try_inverse().unwrap_or_else(|| CDMat::repeat(count, count, Complex::new(f64::INFINITY, 0.0)))
    }

    /// Motion z per component of the platform end with the additional stiffness `delta` of the drive [N/m]:
    /// `(1 + R Δ)⁻¹ T`.
    pub(crate) fn moved(&self, delta: &[Complex]) -> Vec<[Complex; 3]> {
        let (count, inverse) = (delta.len(), self.inverse(delta));
        let moved = |i: usize, s: usize| (0..count).map(|j| inverse[(i, j)] * self.transfer[j][s]).sum();
        (0..count).map(|i| std::array::from_fn(|s| moved(i, s))).collect()
    }

    /// Adds the motions `R p` by forces p on the motions to `motions`.
    pub(crate) fn add_motion_by(&self, forces: &[Complex], motions: &mut [Complex]) {
        for (i, motion) in motions.iter_mut().enumerate() {
            *motion += forces.iter().enumerate().map(|(j, force)| self.receptance[(i, j)] * force).sum::<Complex>();
        }
    }

    /// Forces `Δ (1 + R Δ)⁻¹ z` of the additional stiffness `delta` of the drive [N/m], whose motion without them is
    /// `free`.
    pub(super) fn forces(&self, delta: &[Complex], free: &[Complex]) -> Vec<Complex> {
        self.freed(delta, free).iter().zip(delta).map(|(moved, delta)| moved * delta).collect()
    }

    /// Forces `Δ (1 + R Δ)⁻¹ z` of losses.
    pub(crate) fn forces_by(&self, losses: &DriveLosses, free: &[Complex]) -> Vec<Complex> {
        self.forces(&losses.values(), free)
    }

    /// Motion `(1 + R Δ)⁻¹ z` of the drive, whose motion without the additional stiffness `delta` [N/m] is `free`.
    pub(super) fn freed(&self, delta: &[Complex], free: &[Complex]) -> Vec<Complex> {
        let inverse = self.inverse(delta);
        (0..delta.len()).map(|i| (0..delta.len()).map(|j| inverse[(i, j)] * free[j]).sum()).collect()
    }

    /// Stiffness of the platform end that the additional stiffness `delta` of the drive adds [N/m]:
    /// `Tᵀ Δ (1 + R Δ)⁻¹ T`.
    fn added(&self, delta: &[Complex]) -> [[Complex; 3]; 3] {
        let moved = self.moved(delta);
        let entry = |r: usize, c: usize| (0..delta.len()).map(|j| self.transfer[j][r] * delta[j] * moved[j][c]).sum();
        std::array::from_fn(|r| std::array::from_fn(|c| entry(r, c)))
    }
}

/// Adds the motions from `first` on by the carrier in one family, whose components are `axes`.
fn add_carrier<const D: usize, const N: usize, const E: usize>(
    rows: &mut [[Complex; 3]],
    family: &PoleResidue<N, E>,
    motion: &Displacements<D, N>,
    first: usize,
    axes: [usize; D],
    x: Complex,
) {
    for (j, still) in motion.still.iter().enumerate() {
        for (s, axis) in axes.iter().enumerate() {
            let by_modes: Complex = (family.poles.iter().zip(&family.participation).zip(&motion.modes))
                .map(|((pole, g), phi)| phi[j][0] * g[D + s] * x / (*pole - x))
                .sum();
            rows[first + j][*axis] += still[0][D + s] + by_modes;
        }
    }
}

/// Dynamic stiffness of a drive besides that of the undamped model [N/m], and its derivative by ω, per motion: those of
/// the chain, the stretches, then that sideways if there is one.
pub(crate) struct DriveLosses(pub(crate) Vec<(Complex, Complex)>);

impl DriveLosses {
    /// Stiffness per motion [N/m].
    pub(super) fn values(&self) -> Vec<Complex> {
        self.0.iter().map(|(value, _)| *value).collect()
    }
}

/// Energies of a drive in a natural motion.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct DriveShare {
    /// Twice its kinetic energy over ω² [kg m²].
    pub(crate) mass: f64,
    /// Work of its losses and of that of the stretch, by which the damping grows [N m].
    pub(crate) loss: f64,
    /// Twice the energy of the stretch of a rope with loss [N m].
    pub(crate) stretch: f64,
}

impl DriveMotion {
    /// Slow motion of all motions with the carrier of the end, the platform end held: per component (e, n, b).
    pub(super) fn with_carrier(&self) -> Vec<[f64; 3]> {
        let along = self.along.still.iter().map(|[[_, _, e, n], _]| [*e, *n, 0.0]);
        let sideways = self.sideways.still.iter().map(|[[_, b]]| [0.0, 0.0, *b]);
        let coupled = self.coupled.still.iter().map(|[[_, _, _, e, n, b], ..]| [*e, *n, *b]);
        along.chain(sideways).chain(coupled).collect()
    }

    /// Motions in the clamped mode with this index of a family [1/√kg]; zero for motions that it does not contain.
    pub(crate) fn in_mode(&self, family: Family, index: usize) -> Vec<f64> {
        let mut motions = vec![0.0; self.flexibility.nrows()];
        let sideways = self.along.still.len();
        match family {
            Family::InPlane => {
                motions.iter_mut().zip(&self.along.modes[index]).for_each(|(motion, [phi, _])| *motion = *phi);
            }
            Family::OutOfPlane => {
                motions[sideways..]
                    .iter_mut()
                    .zip(&self.sideways.modes[index])
                    .for_each(|(motion, [phi])| *motion = *phi);
            }
            Family::Coupled => {
                motions.iter_mut().zip(&self.coupled.modes[index]).for_each(|(motion, [phi, ..])| *motion = *phi);
            }
        }
        motions
    }
}

impl InternalMotion {
    /// Motion with the losses of the drive at the end of the cable: the forces `Δ z` act on the clamped modes.
    #[must_use]
    pub(crate) fn with_drive(mut self, cable: &CatenaryDynamic, losses: &DriveLosses, square: Complex) -> Self {
        let Some(drive) = &cable.drive else { return self };
        let (along, count) = (drive.along.still.len(), losses.0.len());

        // The motion z without these forces, then the forces with them.
        let free: Vec<Complex> = (0..count)
            .map(|j| match (&cable.coupled, j.checked_sub(along)) {
                (Some(_), _) => drive.coupled.at(j, &self.ends(), &self.coupled)[0],
                (None, None) => drive.along.at(j, &self.in_plane_ends, &self.in_plane)[0],
                (None, Some(k)) => drive.sideways.at(k, &self.out_of_plane_ends, &self.out_of_plane)[0],
            })
            .collect();
        let at = DriveAt::at(cable, drive, count, square, &NearRanges::default());
        let forces = at.forces(&losses.values(), &free);

        // The clamped modes under these forces.
        for family in Family::ALL {
            for (index, (amplitude, pole)) in self.amplitudes(family).iter_mut().zip(cable.poles_of(family)).enumerate()
            {
                let force: Complex =
                    drive.in_mode(family, index).iter().zip(&forces).map(|(phi, force)| force * *phi).sum();
                *amplitude -= force / (*pole - square);
            }
        }
        self
    }
}

impl CatenaryDynamicEnd {
    /// Drive behind its end, if something there moves along the cable.
    pub(super) fn chain(&self) -> Option<&DriveChain> {
        self.cable.end.as_ref().and_then(MovingEnd::chain)
    }

    /// Stiffness at ω [rad/s] by the losses that the undamped model of the drive leaves out [N/m]; `None` without
    /// losses.
    pub(crate) fn drive_stiffness(&self, omega: Complex) -> Option<LocalStiffness<Complex>> {
        if !self.has_drive_losses() {
            return None;
        }
        let drive = self.drive_at(self.square(omega), &NearRanges::default())?;
        let added = drive.added(&self.beyond_undamped(omega, 1.0).values());
        Some(LocalStiffness {
            axial: added[0][0],
            coupling: added[0][1],
            normal: added[1][1],
            out_of_plane: added[2][2],
            across: [added[0][2], added[1][2]],
        })
    }

    /// True if the undamped model does not describe the cable with its drive completely: masses of the drive that do
    /// not share the damping of the cable, losses of its control, or of the stretch of the rope.
    pub(crate) fn has_drive_losses(&self) -> bool {
        (self.has_strains() && self.stretch_loss.is_some()) || self.has_losses_of_end()
    }

    /// True if masses of the drive do not share the damping of the cable, or its control has losses.
    pub(super) fn has_losses_of_end(&self) -> bool {
        let Some(end) = &self.cable.end else { return false };
        let damped_cable = self.damping.ratio_at(1.0, self.mass_per_length) > 0.0;
        (damped_cable && end.has_mass()) || end.chain().is_some_and(DriveChain::has_losses)
    }

    /// True if the motions in which it stretches are known.
    pub(crate) fn has_strains(&self) -> bool {
        !self.cable.stretch.stiffness.is_empty()
    }

    /// Numbers of motions of its drive: of the chain, and of these with the stretches.
    pub(crate) fn motions_along(&self) -> (usize, usize) {
        let (chain, _) = self.cable.end.as_ref().map_or((0, 0), MovingEnd::counts);
        (chain, chain + self.cable.stretch.stiffness.len())
    }

    /// Number of motions at its end that count: without motion out of plane only those along the cable.
    pub(crate) fn motions(&self) -> usize {
        let (chain, all) = self.cable.end.as_ref().map_or((0, 0), MovingEnd::counts);
        let (_, along) = self.motions_along();
        if self.in_plane_only { along } else { along + all - chain }
    }

    /// Motions of the drive at x = ω_c², without the poles `left_out`; `None` without a drive.
    pub(crate) fn drive_at(&self, x: Complex, left_out: &NearRanges) -> Option<DriveAt> {
        Some(DriveAt::at(&self.cable, self.cable.drive.as_ref()?, self.motions(), x, left_out))
    }

    /// The given motions of the drive, ascending, at x = ω_c², without the poles `left_out`; `None` without a drive.
    pub(crate) fn motions_at(&self, motions: &[usize], x: Complex, left_out: &NearRanges) -> Option<DriveAt> {
        Some(DriveAt::of((&self.cable, self.cable.drive.as_ref()?), motions, x, left_out))
    }

    /// True if the control of its motor has a delay.
    pub(crate) fn has_delay(&self) -> bool {
        self.delay() > 0.0
    }

    /// Delay of the control of its motor [s].
    pub(crate) fn delay(&self) -> f64 {
        let servo = self.chain().and_then(|chain| chain.motor).and_then(|motor| motor.servo);
        servo.map_or(0.0, |servo| servo.delay)
    }

    /// True if wheel, swivel, drum or motor has mass.
    pub(crate) fn has_drive_mass(&self) -> bool {
        self.cable.end.as_ref().is_some_and(MovingEnd::has_mass)
    }

    /// Energies of the drive in a motion of the platform end (e, n, b) at the undamped ω [rad/s]. `near` has the
    /// amplitudes of the clamped modes that are unknowns of their own; `by_support` gives the motions of the drive by a
    /// support at x = ω², without some poles.
    pub(crate) fn drive_share(
        &self,
        omega: f64,
        end: [f64; 3],
        near: &[(usize, Family, f64)],
        by_support: Option<&MotionsOfDrive>,
    ) -> DriveShare {
        let x = omega * omega;
        let left_out = |family: Family| {
            let mut indices = near.iter().filter(|near| near.1 == family).map(|near| near.0);
            indices.next().map_or(0..0, |first| first..indices.next_back().unwrap_or(first) + 1)
        };
        let left_out = NearRanges {
            in_plane: left_out(Family::InPlane),
            out_of_plane: left_out(Family::OutOfPlane),
            coupled: left_out(Family::Coupled),
        };
        let Some(motions) = self.drive_at(x.into(), &left_out) else { return DriveShare::default() };

        // Motions by the platform end, and in the near modes.
        let by_end = |row: &[Complex; 3]| row.iter().zip(end).map(|(transfer, u)| transfer.re * u).sum();
        let mut motion: Vec<f64> = motions.transfer.iter().map(by_end).collect();
        if let Some(by_support) = by_support {
            motion.iter_mut().zip(by_support(x, &left_out)).for_each(|(sum, moved)| *sum += moved);
        }
        for (index, family, amplitude) in near {
            let of_mode = self.drive_in_mode(*index, *family);
            motion.iter_mut().zip(&of_mode).for_each(|(sum, phi)| *sum += phi * amplitude);
        }

        // Masses, and the imaginary part of what the drive has besides the undamped model, without the cable's damping.
        let (chain, along) = self.motions_along();
        let swivel = self.cable.end.as_ref().map_or(0.0, MovingEnd::swivel_mass);
        let mut share =
            DriveShare { mass: motion[along..].iter().map(|z| swivel * z * z).sum(), ..DriveShare::default() };
        if let Some(of) = self.chain() {
            let undamped = (Complex::from(x), Complex::from(2.0 * omega));
            let losses = of.beyond_undamped(omega.into(), undamped, 1.0);
            for (j, z) in motion[..chain].iter().enumerate() {
                share.mass += of.mass[(j, j)] * z * z;
                share.loss += losses[j].0.im * z * z;
            }
        }
        share.stretch = self.cable.stretch.stiffness.iter().zip(&motion[chain..along]).map(|(k, z)| k * z * z).sum();
        share.loss += self.stretch_loss.factor_at(omega) * share.stretch;
        share
    }

    /// Motions of the drive in the clamped mode with this index of a family [1/√kg].
    pub(crate) fn drive_in_mode(&self, index: usize, family: Family) -> Vec<f64> {
        self.cable.drive.as_ref().map_or_else(Vec::new, |motion| motion.in_mode(family, index))
    }

    /// Dynamic stiffness that the drive has besides that of the undamped model, per motion, at the complex ω [N/m],
    /// with its derivative by ω. `losses` is the fraction of the damping that acts.
    pub(crate) fn beyond_undamped(&self, omega: Complex, losses: f64) -> DriveLosses {
        let square = self.damping.times(losses).square_with_slope(omega, self.mass_per_length);
        let along = self.chain().map(|chain| chain.beyond_undamped(omega, square, losses));
        let mut all = along.unwrap_or_default();
        let (loss, slope) = self.stretch_loss.at(omega);
        all.extend(self.cable.stretch.stiffness.iter().map(|k| (loss * (losses * k), slope * (losses * k))));
        let mass = self.cable.end.as_ref().map_or(0.0, MovingEnd::swivel_mass);
        all.resize(self.motions(), (mass * (square.0 - omega * omega), mass * (square.1 - 2.0 * omega)));
        DriveLosses(all)
    }
}

//! Motions of the drive at the end of a cable, and what its losses add to the undamped model.
//!
//! The clamped modes of a cable contain the motions of its drive. What an undamped model cannot hold is added afterwards,
//! exactly: with the motion `z = T u − R p` of the drive under the motion u of the platform end and the forces p that the
//! drive has besides, `p = Δ z`, the cable has the stiffness `K + Tᵀ Δ (1 + R Δ)⁻¹ T` (docs/theory.md, equations (80) and
//! (81)).

use super::moving_end::MovingEnd;
use super::{CatenaryDynamic, CatenaryDynamicEnd, Displacements, InternalMotion, PoleResidue, local};
use crate::cable::LocalStiffness;
use crate::drive::DriveChain;
use crate::math::{CDMat, Complex, DMat};
use std::ops::Range;

/// Motions of a drive in the clamped modes of its cable.
#[derive(Debug, Clone, PartialEq)]
pub struct DriveMotion {
    /// Motions of the chain along the cable, in the first component of each.
    pub along: Displacements<2, 4>,
    /// Motion out of plane, if the end has one.
    pub out_of_plane: Displacements<1, 2>,
    /// Static response of the chain to unit forces on its motions, the platform end of the cable held [m/N].
    pub(super) flexibility: DMat,
    /// Static response of the motion out of plane to a unit force on it [m/N].
    pub(super) flexibility_out_of_plane: f64,
}

/// Motions of a drive at one frequency, in one family of modes: S components of the platform end move it.
pub(crate) struct DriveAt<const S: usize> {
    /// T: motion per component of the platform end, and its derivative by x = ω_c².
    pub(crate) transfer: Vec<[Complex; S]>,
    pub(crate) transfer_slope: Vec<[Complex; S]>,
    /// R: motion per force, the platform end held, and its derivative by x [m/N].
    pub(crate) receptance: CDMat,
    pub(crate) receptance_slope: CDMat,
}

impl<const S: usize> DriveAt<S> {
    /// Motions of `count` parts at x = ω_c², without the poles `left_out`.
    pub(super) fn at<const D: usize, const N: usize, const E: usize>(
        family: &PoleResidue<N, E>,
        motion: &Displacements<D, N>,
        flexibility: &DMat,
        x: Complex,
        left_out: &Range<usize>,
    ) -> Self {
        let zero = Complex::new(0.0, 0.0);
        let count = flexibility.nrows();
        let mut at = Self {
            transfer: (0..count).map(|j| std::array::from_fn(|s| motion.still[j][0][s].into())).collect(),
            transfer_slope: vec![[zero; S]; count],
            receptance: flexibility.map(Complex::from),
            receptance_slope: CDMat::zeros(count, count),
        };

        for (k, (pole, g)) in family.poles.iter().zip(&family.participation).enumerate() {
            let phi = |j: usize| motion.modes[k][j][0];
            if left_out.contains(&k) {
                // The mode is an unknown beside these motions: only its static response, which the flexibility
                // contains, has to be taken out.
                for i in 0..count {
                    for j in 0..count {
                        at.receptance[(i, j)] -= phi(i) * phi(j) / pole;
                    }
                }
                continue;
            }
            let inverse = (*pole - x).inv();
            // x/(p − x), x/(p (p − x)) and their derivatives p/(p − x)², 1/(p − x)².
            let (by_end, by_end_slope) = (x * inverse, *pole * inverse * inverse);
            let (by_force, by_force_slope) = (x * inverse / *pole, inverse * inverse);
            for i in 0..count {
                for (s, g) in g.iter().take(S).enumerate() {
                    at.transfer[i][s] += phi(i) * g * by_end;
                    at.transfer_slope[i][s] += phi(i) * g * by_end_slope;
                }
                for j in 0..count {
                    at.receptance[(i, j)] += phi(i) * phi(j) * by_force;
                    at.receptance_slope[(i, j)] += phi(i) * phi(j) * by_force_slope;
                }
            }
        }
        at
    }

    /// `(1 + R Δ)⁻¹`; not finite at a resonance of the drive without damping.
    fn inverse(&self, delta: &[Complex]) -> CDMat {
        let count = delta.len();
        let one =
            CDMat::from_fn(count, count, |i, j| self.receptance[(i, j)] * delta[j] + if i == j { 1.0 } else { 0.0 });
        one.try_inverse().unwrap_or_else(|| CDMat::repeat(count, count, Complex::new(f64::INFINITY, 0.0)))
    }

    /// Motion z per component of the platform end with the additional stiffness `delta` of the drive [N/m]:
    /// `(1 + R Δ)⁻¹ T`.
    pub(crate) fn moved(&self, delta: &[Complex]) -> Vec<[Complex; S]> {
        let (count, inverse) = (delta.len(), self.inverse(delta));
        let moved = |i: usize, s: usize| (0..count).map(|j| inverse[(i, j)] * self.transfer[j][s]).sum();
        (0..count).map(|i| std::array::from_fn(|s| moved(i, s))).collect()
    }

    /// Forces `Δ (1 + R Δ)⁻¹ z` of the additional stiffness `delta` of the drive [N/m], whose motion without them is
    /// `free`.
    pub(super) fn forces(&self, delta: &[Complex], free: &[Complex]) -> Vec<Complex> {
        self.freed(delta, free).iter().zip(delta).map(|(moved, delta)| moved * delta).collect()
    }

    /// Motion `(1 + R Δ)⁻¹ z` of the drive, whose motion without the additional stiffness `delta` [N/m] is `free`.
    pub(super) fn freed(&self, delta: &[Complex], free: &[Complex]) -> Vec<Complex> {
        let inverse = self.inverse(delta);
        (0..delta.len()).map(|i| (0..delta.len()).map(|j| inverse[(i, j)] * free[j]).sum()).collect()
    }

    /// Stiffness of the platform end that the additional stiffness `delta` of the drive adds [N/m]:
    /// `Tᵀ Δ (1 + R Δ)⁻¹ T`.
    fn added(&self, delta: &[Complex]) -> [[Complex; S]; S] {
        let moved = self.moved(delta);
        let entry = |r: usize, c: usize| (0..delta.len()).map(|j| self.transfer[j][r] * delta[j] * moved[j][c]).sum();
        std::array::from_fn(|r| std::array::from_fn(|c| entry(r, c)))
    }
}

/// Motions of a drive at one frequency, along the cable and sideways.
pub(crate) struct DriveMotions {
    pub(crate) along: DriveAt<2>,
    /// `None` if the end does not move sideways.
    pub(crate) sideways: Option<DriveAt<1>>,
}

/// Dynamic stiffness of a drive besides that of the undamped model [N/m], and its derivative by ω, per motion.
pub(crate) struct DriveLosses {
    pub(crate) along: Vec<(Complex, Complex)>,
    pub(crate) sideways: (Complex, Complex),
}

impl DriveLosses {
    /// Stiffness per motion along the cable [N/m].
    pub(super) fn values_along(&self) -> Vec<Complex> {
        self.along.iter().map(|(value, _)| *value).collect()
    }
}

impl DriveMotions {
    /// Entries of the stiffness that the losses add to the platform end, in plane and out of plane [N/m].
    pub(super) fn added_stiffness(&self, losses: &DriveLosses) -> ([Complex; 3], [Complex; 1]) {
        let delta = losses.values_along();
        let [[axial, coupling], [_, normal]] = self.along.added(&delta);
        let out_of_plane =
            self.sideways.as_ref().map_or_else(Complex::default, |sideways| sideways.added(&[losses.sideways.0])[0][0]);
        ([axial, coupling, normal], [out_of_plane])
    }
}

impl InternalMotion {
    /// This motion with the losses of the drive at the end of the cable: their forces `Δ z` act on the clamped modes.
    #[must_use]
    pub(crate) fn with_drive(mut self, cable: &CatenaryDynamic, losses: &DriveLosses, square: Complex) -> Self {
        let Some(drive) = &cable.drive else { return self };

        // Along the cable: the motion z without these forces, then with them.
        let free: Vec<Complex> =
            (0..losses.along.len()).map(|j| drive.along.at(j, &self.in_plane_ends, &self.in_plane)[0]).collect();
        let delta = losses.values_along();
        let at = DriveAt::<2>::at(&cable.in_plane, &drive.along, &drive.flexibility, square, &(0..0));
        let forces = at.forces(&delta, &free);
        for ((amplitude, pole), mode) in self.in_plane.iter_mut().zip(&cable.in_plane.poles).zip(&drive.along.modes) {
            let force: Complex = mode.iter().zip(&forces).map(|([phi, _], force)| force * *phi).sum();
            *amplitude -= force / (*pole - square);
        }

        // Sideways.
        if drive.flexibility_out_of_plane > 0.0 {
            let free = drive.out_of_plane.at(0, &self.out_of_plane_ends, &self.out_of_plane)[0];
            let flexibility = DMat::from_element(1, 1, drive.flexibility_out_of_plane);
            let at = DriveAt::<1>::at(&cable.out_of_plane, &drive.out_of_plane, &flexibility, square, &(0..0));
            let force = at.forces(&[losses.sideways.0], &[free])[0];
            let modes = cable.out_of_plane.poles.iter().zip(&drive.out_of_plane.modes);
            for (amplitude, (pole, mode)) in self.out_of_plane.iter_mut().zip(modes) {
                *amplitude -= force * mode[0][0] / (*pole - square);
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

    /// Stiffness at ω [rad/s] that comes from what the undamped model of the drive leaves out [N/m]; `None` without it.
    pub(crate) fn drive_stiffness(&self, omega: f64) -> Option<LocalStiffness<Complex>> {
        if !self.has_drive_losses() {
            return None;
        }
        let drive = self.drive_at(self.square(omega), &(0..0, 0..0))?;
        let (in_plane, out_of_plane) = drive.added_stiffness(&self.beyond_undamped(omega.into(), 1.0));
        Some(local(in_plane, out_of_plane))
    }

    /// True if the undamped model does not describe its drive completely: masses of the drive that do not share the
    /// damping of the cable, or losses of its control.
    pub(crate) fn has_drive_losses(&self) -> bool {
        let Some(end) = &self.cable.end else { return false };
        let damped_cable = self.damping.ratio_at(1.0, self.mass_per_length) > 0.0;
        (damped_cable && end.has_mass()) || end.chain().is_some_and(DriveChain::has_losses)
    }

    /// Motions of the drive at x = ω_c², without the poles `left_out` in plane and out of plane; `None` without a drive.
    pub(crate) fn drive_at(&self, x: Complex, left_out: &(Range<usize>, Range<usize>)) -> Option<DriveMotions> {
        let motion = self.cable.drive.as_ref()?;
        Some(DriveMotions {
            along: DriveAt::at(&self.cable.in_plane, &motion.along, &motion.flexibility, x, &left_out.0),
            sideways: (self.out_of_plane().filter(|_| motion.flexibility_out_of_plane > 0.0)).map(|family| {
                let flexibility = DMat::from_element(1, 1, motion.flexibility_out_of_plane);
                DriveAt::at(family, &motion.out_of_plane, &flexibility, x, &left_out.1)
            }),
        })
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

    /// Kinetic energy of the drive over ω²/2 [kg m²], and the work of its losses, by which its damping grows [N m], in
    /// a motion of the platform end (e, n, b) at the undamped ω [rad/s]. `near` has the amplitudes of the clamped modes
    /// that are unknowns of their own.
    pub(crate) fn drive_share(&self, omega: f64, end: [f64; 3], near: &[(usize, bool, f64)]) -> (f64, f64) {
        let x = omega * omega;
        let left_out = |out_of_plane: bool| {
            let mut indices = near.iter().filter(|near| near.1 == out_of_plane).map(|near| near.0);
            indices.next().map_or(0..0, |first| first..indices.next_back().unwrap_or(first) + 1)
        };
        let Some(motions) = self.drive_at(x.into(), &(left_out(false), left_out(true))) else { return (0.0, 0.0) };

        // Motions by the platform end, and in the near modes.
        let mut along: Vec<f64> = motions.along.transfer.iter().map(|[e, n]| e.re * end[0] + n.re * end[1]).collect();
        let mut sideways = motions.sideways.as_ref().map_or(0.0, |sideways| sideways.transfer[0][0].re * end[2]);
        for (index, out_of_plane, amplitude) in near {
            let motion = self.drive_in_mode(*index, *out_of_plane);
            if *out_of_plane {
                sideways += motion.iter().map(|phi| phi * amplitude).sum::<f64>();
            } else {
                along.iter_mut().zip(&motion).for_each(|(sum, phi)| *sum += phi * amplitude);
            }
        }

        // Masses, and the imaginary part of what the drive has besides the undamped model, without the cable's damping.
        let swivel = self.cable.end.as_ref().map_or(0.0, MovingEnd::swivel_mass);
        let (mut mass, mut loss) = (swivel * sideways * sideways, 0.0);
        if let Some(chain) = self.chain() {
            let undamped = (Complex::from(x), Complex::from(2.0 * omega));
            let losses = chain.beyond_undamped(omega.into(), undamped, 1.0);
            for (j, z) in along.iter().enumerate() {
                mass += chain.mass[(j, j)] * z * z;
                loss += losses[j].0.im * z * z;
            }
        }
        (mass, loss)
    }

    /// Motions of the drive in the clamped mode with this index, along the cable or sideways [1/√kg].
    pub(crate) fn drive_in_mode(&self, index: usize, out_of_plane: bool) -> Vec<f64> {
        let Some(motion) = &self.cable.drive else { return Vec::new() };
        if out_of_plane {
            motion.out_of_plane.modes[index].iter().map(|[motion]| *motion).collect()
        } else {
            motion.along.modes[index].iter().map(|[motion, _]| *motion).collect()
        }
    }

    /// Dynamic stiffness that the drive has besides that of the undamped model, over its motions along the cable and
    /// sideways, at the complex ω [N/m], with its derivative by ω. `losses` is the fraction of the damping that acts.
    pub(crate) fn beyond_undamped(&self, omega: Complex, losses: f64) -> DriveLosses {
        let square = self.damping.times(losses).square_with_slope(omega, self.mass_per_length);
        let along = self.chain().map(|chain| chain.beyond_undamped(omega, square, losses));
        let mass = self.cable.end.as_ref().map_or(0.0, MovingEnd::swivel_mass);
        let sideways = (mass * (square.0 - omega * omega), mass * (square.1 - 2.0 * omega));
        DriveLosses { along: along.unwrap_or_default(), sideways }
    }
}

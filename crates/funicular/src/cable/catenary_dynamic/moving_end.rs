//! End of a cable that can move: along the cable, as on a pulley with a drive behind it, and out of plane, as on a pulley
//! that swivels.
//!
//! The motions of the drive are inner unknowns of the cable, so that its clamped modes contain them, and the count of
//! natural frequencies with them. What an undamped model cannot hold is added afterwards, exactly: with the motion
//! `z = T u − R p` of the drive under the motion u of the platform end and the forces p that the drive has besides,
//! `p = Δ z`, the cable has the stiffness `K + Tᵀ Δ (1 + R Δ)⁻¹ T` (docs/theory.md, equations (80) and (81)).

use super::{CatenaryDynamic, CatenaryDynamicError, Displacements, InternalMotion, PoleResidue};
use crate::catenary::space::HangingCable;
use crate::drive::{AnchorEnd, DriveChain};
use crate::math::{CDMat, Complex, DMat};
use std::ops::Range;

/// End of a cable that can move.
#[derive(Debug, Clone, PartialEq)]
pub struct MovingEnd {
    /// Motion in plane; `None` if the end is held there.
    pub along: Option<EndAlong>,
    /// Stiffness [N/m] and mass [kg] against motion out of plane; `None` if the end is held there.
    pub out_of_plane: Option<(f64, f64)>,
}

/// Motion of an end along the cable, with the drive behind it.
#[derive(Debug, Clone, PartialEq)]
pub struct EndAlong {
    /// Direction towards the platform: its components (horizontal, up).
    pub direction: [f64; 2],
    /// Drive; its first motion is that of the end.
    pub chain: DriveChain,
}

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

/// Maximum component out of plane of the direction in which an end moves along the cable, and maximum coupling between
/// its motions over their stiffness: rounding is 1e-15, and the frequencies change by the square of both.
const IN_PLANE: f64 = 1e-8;

impl MovingEnd {
    /// Motion of the end of a hanging cable at its pulley and winch; `None` if it is held. `chain` is the drive behind
    /// it, and `swivel_mass` the mass that the swivel adds to the motion out of plane [kg].
    ///
    /// # Errors
    /// [`CatenaryDynamicError::Skew`]: the end moves in and out of plane at the same time.
    pub(super) fn of(
        hanging: &HangingCable,
        end: &AnchorEnd,
        chain: Option<DriveChain>,
        swivel_mass: f64,
    ) -> Result<Option<Self>, CatenaryDynamicError> {
        if chain.is_none() && end.sideways_w.is_none() {
            return Ok(None);
        }
        let (horizontal_w, up_w) = hanging.axes_w();
        let out_w = horizontal_w.cross(&up_w);

        // The motions have to be in plane and out of plane.
        let [[stiffness, coupling], [_, sideways]] = end.stiffness;
        let skew = end.sideways_w.map_or(0.0, |sideways_w| {
            let turned = (sideways_w - out_w * out_w.dot(&sideways_w)).norm();
            turned.max(coupling.abs() / (stiffness * sideways).abs().sqrt())
        });
        if skew.max(out_w.dot(&end.travel_w).abs()) > IN_PLANE {
            return Err(CatenaryDynamicError::Skew);
        }

        let direction = [horizontal_w.dot(&end.travel_w), up_w.dot(&end.travel_w)];
        let along = chain.map(|chain| EndAlong { direction, chain });
        Ok(Some(Self { along, out_of_plane: end.sideways_w.map(|_| (sideways, swivel_mass)) }))
    }

    /// Static stiffness of the start in plane and out of plane, from those with the end held, and the static response of
    /// the motions at the end to forces on them. The stiffness of an end that moves is zero.
    pub(super) fn still(&self, [[hh, hv], [_, vv]]: [[f64; 2]; 2], o: f64) -> Result<Still, CatenaryDynamicError> {
        let mut in_plane = [[hh, hv, -hh, -hv], [hv, vv, -hv, -vv], [-hh, -hv, hh, hv], [-hv, -vv, hv, vv]];
        let mut flexibility = DMat::zeros(0, 0);
        if let Some(EndAlong { direction: [h, v], chain }) = &self.along {
            let pulled = [hh * h + hv * v, hv * h + vv * v];
            flexibility = chain.flexibility(h * pulled[0] + v * pulled[1]).ok_or(CatenaryDynamicError::RunsOut)?;
            let left = |held: f64, i: usize, j: usize| held - pulled[i] * pulled[j] * flexibility[(0, 0)];
            in_plane = [[0.0; 4]; 4];
            (in_plane[0][0], in_plane[1][1]) = (left(hh, 0, 0), left(vv, 1, 1));
            (in_plane[0][1], in_plane[1][0]) = (left(hv, 0, 1), left(hv, 0, 1));
        }
        let (out_of_plane, flexibility_out_of_plane) = match self.out_of_plane {
            Some((sideways, _)) => ([[o - o * o / (o + sideways), 0.0], [0.0, 0.0]], 1.0 / (o + sideways)),
            None => ([[o, -o], [-o, o]], 0.0),
        };
        Ok(Still { in_plane, out_of_plane, flexibility, flexibility_out_of_plane })
    }
}

/// Static stiffness of a cable whose end may move, and flexibility of that end.
pub(super) struct Still {
    pub(super) in_plane: [[f64; 4]; 4],
    pub(super) out_of_plane: [[f64; 2]; 2],
    pub(super) flexibility: DMat,
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

impl DriveMotions {
    /// Entries of the stiffness that the losses add to the platform end, in plane and out of plane [N/m].
    pub(super) fn added_stiffness(&self, losses: &DriveLosses) -> ([Complex; 3], [Complex; 1]) {
        let delta: Vec<Complex> = losses.along.iter().map(|(value, _)| *value).collect();
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
        let delta: Vec<Complex> = losses.along.iter().map(|(value, _)| *value).collect();
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

//! Motion of the points along a cable, from the motion of its ends and the amplitudes of its clamped modes.

use super::{CatenaryDynamic, CatenaryDynamicEnd, Family, PoleResidue};
use crate::math::{Complex, DMat};
use std::array::from_fn;

/// Displacement of stations along a catenary-dynamic cable (D components per point) by motions of its ends (N = 2D
/// components).
#[derive(Debug, Clone, PartialEq)]
pub struct Displacements<const D: usize, const N: usize> {
    /// Ψ per station: its components in slow motion per component of the ends [-].
    pub still: Vec<[[f64; N]; D]>,
    /// φ_k at each station, per pole, normalised to φᵀMφ = 1 [1/√kg].
    pub modes: Vec<Vec<[f64; D]>>,
}

/// Stations along a catenary-dynamic cable, measured from its start, with their displacements.
#[derive(Debug, Clone, PartialEq)]
pub struct Stations {
    /// Unstrained arc length of each station [m].
    pub arc_lengths: Vec<f64>,
    /// Displacements in plane: components (horizontal, up).
    pub in_plane: Displacements<2, 4>,
    /// Displacements out of plane: one component.
    pub out_of_plane: Displacements<1, 2>,
    /// Displacements (horizontal, up, out of plane) of a cable whose end couples the families.
    pub coupled: Displacements<3, 6>,
}

impl<const D: usize, const N: usize> Displacements<D, N> {
    /// No stations and no modes.
    pub(super) fn none() -> Self {
        Self { still: Vec::new(), modes: Vec::new() }
    }

    /// Keeps the first `count` clamped modes and replaces all others by a few combinations with the given weights; see
    /// [`PoleResidue::compressed`].
    pub(crate) fn compress(&mut self, count: usize, weights: &DMat) {
        let beyond = self.modes.split_off(count);
        for column in weights.column_iter() {
            let mut mode = vec![[0.0; D]; self.still.len()];
            for (weight, values) in column.iter().zip(&beyond) {
                for (sum, value) in mode.iter_mut().zip(values) {
                    (0..D).for_each(|d| sum[d] += weight * value[d]);
                }
            }
            self.modes.push(mode);
        }
    }

    /// Takes the stations from this number on away; the result has them.
    pub(super) fn split_off(&mut self, first: usize) -> Self {
        let modes = self.modes.iter_mut().map(|mode| mode.split_off(first)).collect();
        Self { still: self.still.split_off(first), modes }
    }

    /// Inserts the stations of another list before the station `at`.
    pub(super) fn insert(&mut self, at: usize, others: &Self) {
        self.still.splice(at..at, others.still.iter().copied());
        for (mode, other) in self.modes.iter_mut().zip(&others.modes) {
            mode.splice(at..at, other.iter().copied());
        }
    }

    /// Sums of stations, each with its factor.
    pub(super) fn sums(&self, of: &[Vec<(usize, f64)>]) -> Self {
        let still = |sum: &Vec<(usize, f64)>| {
            from_fn(|d| from_fn(|n| sum.iter().map(|(at, factor)| factor * self.still[*at][d][n]).sum()))
        };
        let mode = |mode: &Vec<[f64; D]>| {
            let at = |sum: &Vec<(usize, f64)>| from_fn(|d| sum.iter().map(|(at, factor)| factor * mode[*at][d]).sum());
            of.iter().map(at).collect()
        };
        Self { still: of.iter().map(still).collect(), modes: self.modes.iter().map(mode).collect() }
    }

    /// Adds a clamped mode: its values at the stations and its products `K_ibᵀ φ` with the ends, φᵀKφ = 1, μ = 1/ω².
    pub(super) fn add_mode(&mut self, values: &[f64], stiff: &[f64], mu: f64) {
        self.add_still(values, stiff);
        let root = mu.sqrt();
        self.modes.push(values.chunks_exact(D).map(|value| std::array::from_fn(|d| value[d] / root)).collect());
    }

    /// Adds the static response of a clamped mode without mass; it has no frequency.
    pub(super) fn add_still(&mut self, values: &[f64], stiff: &[f64]) {
        for (still, value) in self.still.iter_mut().zip(values.chunks_exact(D)) {
            for (row, value) in still.iter_mut().zip(value) {
                for (entry, stiff) in row.iter_mut().zip(stiff) {
                    *entry -= value * stiff;
                }
            }
        }
    }

    /// Displacement of station `at` for motions `ends` of the ends and amplitudes of the clamped modes.
    pub(super) fn at(&self, at: usize, ends: &[Complex; N], amplitudes: &[Complex]) -> [Complex; D] {
        let mut sum = self.still[at].map(|row| ends.iter().zip(row).map(|(u, psi)| u * psi).sum());
        for (mode, amplitude) in self.modes.iter().zip(amplitudes) {
            for (sum, value) in sum.iter_mut().zip(&mode[at]) {
                *sum += amplitude * *value;
            }
        }
        sum
    }
}

impl<const N: usize, const E: usize> PoleResidue<N, E> {
    /// Amplitudes of the clamped modes (unit modal mass) for motions of the ends at the square ω_c² [m √kg]:
    /// `q_k = ω_c² g_kᵀ u/(ω_k² − ω_c²)`.
    fn amplitudes(&self, ends: &[Complex; N], square: Complex) -> Vec<Complex> {
        let amplitude = |(pole, g): (&f64, &[f64; N])| {
            let drive: Complex = ends.iter().zip(g).map(|(u, g)| u * g).sum();
            square * drive / (*pole - square)
        };
        self.poles.iter().zip(&self.participation).map(amplitude).collect()
    }
}

/// Motion along a cable whose ends move.
pub(crate) struct InternalMotion {
    /// Motions of both ends in plane (horizontal, up) and out of plane.
    pub(super) in_plane_ends: [Complex; 4],
    pub(super) out_of_plane_ends: [Complex; 2],
    /// Amplitudes of the clamped modes [m √kg], by families.
    pub(crate) in_plane: Vec<Complex>,
    pub(crate) out_of_plane: Vec<Complex>,
    pub(crate) coupled: Vec<Complex>,
}

impl InternalMotion {
    /// Motion that follows from the start's (horizontal towards the end, up, out of plane) at the complex square ω_c²
    /// [rad²/s²].
    pub(crate) fn new(cable: &CatenaryDynamic, start: [Complex; 3], square: Complex) -> Self {
        Self::between(cable, start, [Complex::new(0.0, 0.0); 3], square)
    }

    /// Motion that follows from those of both ends (horizontal, up, out of plane) at the complex square ω_c² [rad²/s²].
    pub(crate) fn between(cable: &CatenaryDynamic, start: [Complex; 3], end: [Complex; 3], square: Complex) -> Self {
        let mut motion = Self {
            in_plane_ends: [start[0], start[1], end[0], end[1]],
            out_of_plane_ends: [start[2], end[2]],
            in_plane: Vec::new(),
            out_of_plane: Vec::new(),
            coupled: Vec::new(),
        };
        motion.in_plane = cable.in_plane.amplitudes(&motion.in_plane_ends, square);
        motion.out_of_plane = cable.out_of_plane.amplitudes(&motion.out_of_plane_ends, square);
        if let Some(coupled) = &cable.coupled {
            motion.coupled = coupled.amplitudes(&motion.ends(), square);
        }
        motion
    }

    /// Motion with the ends held and a force along (horizontal, up, out of plane) at station `loaded`.
    pub(crate) fn under_force(
        cable: &CatenaryDynamic,
        stations: &Stations,
        (loaded, force): (usize, [f64; 3]),
        square: Complex,
    ) -> Self {
        let held = Complex::new(0.0, 0.0);
        let along = |mode: &[f64], force: &[f64]| -> f64 { mode.iter().zip(force).map(|(phi, f)| phi * f).sum() };
        let in_plane = cable.in_plane.poles.iter().zip(&stations.in_plane.modes);
        let out_of_plane = cable.out_of_plane.poles.iter().zip(&stations.out_of_plane.modes);
        let coupled = cable.coupled_poles().iter().zip(&stations.coupled.modes);
        Self {
            in_plane_ends: [held; 4],
            out_of_plane_ends: [held; 2],
            in_plane: in_plane.map(|(pole, mode)| along(&mode[loaded], &force[..2]) / (*pole - square)).collect(),
            out_of_plane: (out_of_plane.map(|(pole, mode)| along(&mode[loaded], &force[2..]) / (*pole - square)))
                .collect(),
            coupled: coupled.map(|(pole, mode)| along(&mode[loaded], &force) / (*pole - square)).collect(),
        }
    }

    /// Motions (horizontal, up, out of plane) of the start, then of the end.
    pub(super) fn ends(&self) -> [Complex; 6] {
        let ([a, b, d, e], [c, f]) = (self.in_plane_ends, self.out_of_plane_ends);
        [a, b, c, d, e, f]
    }

    /// Amplitudes of some clamped modes, by family and index [m √kg].
    pub(super) fn of_modes(mut self, modes: &[(Family, usize)]) -> Vec<Complex> {
        modes.iter().map(|(family, index)| self.amplitudes(*family)[*index]).collect()
    }

    /// Amplitudes of the clamped modes of a family [m √kg].
    pub(crate) fn amplitudes(&mut self, family: Family) -> &mut Vec<Complex> {
        match family {
            Family::InPlane => &mut self.in_plane,
            Family::OutOfPlane => &mut self.out_of_plane,
            Family::Coupled => &mut self.coupled,
        }
    }
}

impl CatenaryDynamicEnd {
    /// Amplitudes of clamped modes, by family and index, for a motion (e, n, b) of the platform end at ω [rad/s]. Not
    /// finite at a pole.
    pub(crate) fn amplitudes_by_platform(
        &self,
        start: [Complex; 3],
        omega: Complex,
        modes: &[(Family, usize)],
    ) -> Vec<Complex> {
        let (square, losses) = (self.square(omega), self.beyond_undamped(omega, 1.0));
        let moved = InternalMotion::new(&self.cable, start, square);
        moved.with_drive(&self.cable, &losses, square).of_modes(modes)
    }

    /// Mass of the cable at its held platform end, the sum over all directions [kg].
    pub(crate) fn end_mass(&self) -> f64 {
        let CatenaryDynamic { in_plane, out_of_plane, coupled, .. } = &self.cable;
        let of_coupled = coupled.as_ref().map_or(0.0, |of| (0..3).map(|k| of.mass[k][k]).sum());
        in_plane.mass[0][0] + in_plane.mass[1][1] + out_of_plane.mass[0][0] + of_coupled
    }
}

impl Stations {
    /// Displacement (horizontal, up, out of plane) of station `at` for displacements of the start and of the far end,
    /// with the amplitudes of the clamped modes at rest.
    pub(crate) fn still(&self, at: usize, start: [f64; 3], end: [f64; 3]) -> [f64; 3] {
        let ([a, b, c], [d, e, f]) = (start.map(Complex::from), end.map(Complex::from));
        if !self.coupled.still.is_empty() {
            return self.coupled.at(at, &[a, b, c, d, e, f], &[]).map(|u| u.re);
        }
        let [horizontal, up] = self.in_plane.at(at, &[a, b, d, e], &[]);
        let [out_of_plane] = self.out_of_plane.at(at, &[c, f], &[]);
        [horizontal.re, up.re, out_of_plane.re]
    }

    /// Displacement (horizontal, up, out of plane) of station `at`.
    pub(crate) fn displacement(&self, at: usize, motion: &InternalMotion) -> [Complex; 3] {
        if !self.coupled.still.is_empty() {
            return self.coupled.at(at, &motion.ends(), &motion.coupled);
        }
        let [horizontal, up] = self.in_plane.at(at, &motion.in_plane_ends, &motion.in_plane);
        let [out_of_plane] = self.out_of_plane.at(at, &motion.out_of_plane_ends, &motion.out_of_plane);
        [horizontal, up, out_of_plane]
    }
}

//! End stiffness of a rope with a constant loss factor by complex poles and residues.
//!
//! A loss factor does not depend on frequency, so that a cable with it is a system with a constant complex stiffness,
//! and has poles and residues as one without loss. They take about four solutions with all poles for each pole, but
//! then every frequency is as cheap as without loss (docs/theory.md, equations (27f1) to (27f3)).

use super::poles::{at_start, entry_indices};
use super::{CatenaryDynamicEnd, Displacements, DriveMotion, PoleResidue, local, local_of_coupled};
use crate::cable::LocalStiffness;
use crate::math::{CDMat, Complex, DMat};
use std::array::from_fn;
use std::ops::Range;
use std::sync::OnceLock;

/// Symmetric stiffness of the start of a cable by complex poles and residues: D components with E independent entries.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LossyPoles<const D: usize, const E: usize> {
    /// Entries of the static stiffness [N/m].
    pub(crate) stiffness: [Complex; E],
    /// Entries of the mass [kg].
    pub(crate) mass: [Complex; E],
    /// Complex poles λ_k, each in the place of its partner without loss [rad²/s²].
    pub(crate) poles: Vec<Complex>,
    /// Participations of the start [√kg].
    pub(crate) participation: Vec<[Complex; D]>,
    /// Products of the participations, one row per entry [kg].
    pub(crate) residues: [Vec<Complex>; E],
}

/// Family of clamped modes in which a rope with loss stretches.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum LossyFamily {
    /// Motions in the plane of the cable.
    InPlane(LossyPoles<2, 3>),
    /// Motions in all directions, of a cable whose end couples them.
    Coupled(LossyPoles<3, 6>),
}

/// Value that follows from the others of a type and is computed when it is first asked for: it does not count in
/// comparisons.
#[derive(Debug, Clone, Default)]
pub(super) struct Derived<T>(OnceLock<T>);

impl<T> PartialEq for Derived<T> {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// Maximum relative step of Newton's method at which a pole has been found. Its steps end at a few times 1e-16, and
/// converge quadratically before.
const FOUND: f64 = 1e-13;

/// Maximum number of steps for one pole: four are usual. Where two poles without loss nearly meet there may be none
/// that converges to the right one; the cable is then solved frequency by frequency.
const MAX_STEPS: usize = 12;

/// Minimum relative distance of two poles that have been found: nearer ones may be one pole that was found twice.
const MIN_DISTANCE: f64 = 1e-9;

/// Number of solutions at single frequencies, over the number of poles, that cost as much as the poles: the steps of
/// each pole.
const SOLUTIONS_PER_POLE: usize = 4;

/// Stiffness of a cable with a constant loss factor without its poles near a frequency, and those poles.
pub(crate) struct LossyBesidePoles {
    /// Stiffness at the complex x = ω_c² [N/m].
    pub(crate) stiffness: LocalStiffness<Complex>,
    /// Minus its derivative by x [kg].
    pub(crate) mass: LocalStiffness<Complex>,
    /// Near poles [rad²/s²], each with the participation (e, n, b) of the platform end [√kg].
    pub(crate) near: Vec<(Complex, [Complex; 3])>,
    /// Poles that are not near and whose partners without loss lie below the limit [rad²/s²].
    pub(crate) others: Vec<Complex>,
}

impl CatenaryDynamicEnd {
    /// Stiffness with the poles of `lossy` at the complex x = ω_c² without the poles in the relative distance `width`
    /// of x; `below` is the square of the limit of the other poles [rad²/s²].
    pub(crate) fn lossy_beside_poles(
        &self,
        lossy: &LossyFamily,
        x: Complex,
        width: f64,
        below: f64,
    ) -> LossyBesidePoles {
        match lossy {
            LossyFamily::Coupled(of) => {
                let near = of.near(x, width);
                let (stiffness, mass) = of.without(x, &near);
                let count = self.coupled().map_or(0, |family| family.poles_below(below));
                LossyBesidePoles {
                    stiffness: local_of_coupled(stiffness),
                    mass: local_of_coupled(mass),
                    others: of.others(count, &near).collect(),
                    near: near.map(|k| (of.poles[k], of.participation[k])).collect(),
                }
            }
            LossyFamily::InPlane(of) => {
                let near = of.near(x, width);
                let (stiffness, mass) = of.without(x, &near);
                let mut beside = LossyBesidePoles {
                    stiffness: local(stiffness, Default::default()),
                    mass: local(mass, Default::default()),
                    others: of.others(self.in_plane().poles_below(below), &near).collect(),
                    near: near
                        .map(|k| (of.poles[k], [of.participation[k][0], of.participation[k][1], 0.0.into()]))
                        .collect(),
                };
                if let Some(family) = self.out_of_plane() {
                    beside.add_out_of_plane(family, x, width, below);
                }
                beside
            }
        }
    }

    /// Poles and residues with the loss of the stretch, if this many frequencies are worth them or they are known from
    /// before; `None` if the losses are not constant over frequency, or if two poles nearly meet.
    pub(crate) fn lossy_family(&self, frequencies: usize) -> Option<&LossyFamily> {
        let known = self.lossy.0.get();
        if known.is_none() && !(self.is_loss_constant() && frequencies > SOLUTIONS_PER_POLE * self.lossy_pole_count()) {
            return None;
        }
        self.lossy.0.get_or_init(|| self.with_constant_loss()).as_ref()
    }

    /// True if the loss factor of the stretch is all that the undamped model leaves out.
    fn is_loss_constant(&self) -> bool {
        let loss = self.stretch_loss;
        let is_by_factor = self.has_strains() && loss.factor > 0.0 && loss.time == 0.0;
        is_by_factor && !self.has_losses_of_end()
    }

    /// Number of poles of the family in which the rope stretches.
    fn lossy_pole_count(&self) -> usize {
        self.coupled().map_or(self.in_plane().poles.len(), |family| family.poles.len())
    }

    /// Poles and residues of a rope with a constant loss factor.
    fn with_constant_loss(&self) -> Option<LossyFamily> {
        let drive = self.cable.drive.as_ref()?;
        let (chain, along) = self.motions_along();
        let loss = self.stretch_loss.factor * Complex::i();
        let compliance: Vec<Complex> = self.cable.stretch.stiffness.iter().map(|k| (loss * *k).inv()).collect();
        Some(match self.coupled() {
            Some(family) => {
                LossyFamily::Coupled(Strains::of(family, (drive, &drive.coupled), chain..along, &compliance).poles()?)
            }
            None => LossyFamily::InPlane(
                Strains::of(self.in_plane(), (drive, &drive.along), chain..along, &compliance).poles()?,
            ),
        })
    }
}

/// Motions z in which a rope with loss stretches, in one family of clamped modes: their modal values φ, their slow
/// motion T by the start, and the compliance `Δ⁻¹ + R`.
struct Strains<'a, const N: usize, const E: usize> {
    family: &'a PoleResidue<N, E>,
    /// φ_k of the motions, per pole [1/√kg].
    modes: Vec<Vec<f64>>,
    /// Products `φ_i φ_j` with i ≥ j of each pole, row by row [1/kg].
    products: Vec<f64>,
    /// Slow motion of each by the components of the start.
    by_start: DMat,
    /// `Δ⁻¹ + R` at rest [m/N].
    at_rest: CDMat,
    /// `Δ⁻¹ + R` without all clamped modes [m/N].
    without_modes: CDMat,
}

/// Pole that has been found: its value, the forces y on the motions in its mode, and the square of the mode.
struct FoundPole {
    value: Complex,
    forces: Vec<Complex>,
    square: Complex,
}

impl<'a, const N: usize, const E: usize> Strains<'a, N, E> {
    /// The `motions` of a drive in a family; `compliance` is Δ⁻¹ of each.
    fn of<const D: usize>(
        family: &'a PoleResidue<N, E>,
        (drive, motion): (&DriveMotion, &Displacements<D, N>),
        motions: Range<usize>,
        compliance: &[Complex],
    ) -> Self {
        let (first, count) = (motions.start, motions.len());
        let modes: Vec<Vec<f64>> =
            motion.modes.iter().map(|mode| mode[motions.clone()].iter().map(|phi| phi[0]).collect()).collect();
        let pairs: Vec<(usize, usize)> = (0..count).flat_map(|i| (0..=i).map(move |j| (i, j))).collect();
        let products = modes.iter().flat_map(|phi| pairs.iter().map(|(i, j)| phi[*i] * phi[*j])).collect();
        let at_rest = CDMat::from_fn(count, count, |i, j| {
            let own = if i == j { compliance[i] } else { Complex::new(0.0, 0.0) };
            own + drive.flexibility[(first + i, first + j)]
        });
        let by_modes = |i: usize, j: usize| -> f64 {
            family.poles.iter().zip(&modes).map(|(pole, phi)| phi[i] * phi[j] / pole).sum()
        };
        let without_modes = CDMat::from_fn(count, count, |i, j| at_rest[(i, j)] - by_modes(i, j));
        let by_start = DMat::from_fn(count, D, |i, s| motion.still[first + i][0][s]);
        Self { family, modes, products, by_start, at_rest, without_modes }
    }

    /// Poles and residues with the loss; `None` if two poles nearly meet.
    fn poles<const D: usize>(&self) -> Option<LossyPoles<D, E>> {
        // One pole for each without loss. A polynomial of this degree has no others if all are different.
        let found: Vec<FoundPole> = (0..self.modes.len()).map(|k| self.pole(k)).collect::<Option<_>>()?;
        let mut sorted: Vec<Complex> = found.iter().map(|pole| pole.value).collect();
        sorted.sort_by(|a, b| a.re.total_cmp(&b.re));
        let meet = |pair: &[Complex]| (pair[1] - pair[0]).norm() < MIN_DISTANCE * pair[1].norm();
        if sorted.windows(2).any(meet) {
            return None;
        }

        let participation: Vec<[Complex; D]> =
            found.iter().enumerate().map(|(k, pole)| self.participation(k, pole)).collect();
        let residues =
            entry_indices().map(|(i, j): (usize, usize)| participation.iter().map(|g| g[i] * g[j]).collect());
        let (stiffness, mass) = self.slow()?;
        Some(LossyPoles {
            stiffness,
            mass,
            poles: found.into_iter().map(|pole| pole.value).collect(),
            participation,
            residues,
        })
    }

    /// Pole with loss in the place of pole k, by Newton's method.
    ///
    /// # References
    /// docs/theory.md, equation (27f2).
    fn pole(&self, k: usize) -> Option<FoundPole> {
        let (own, phi) = (self.family.poles[k], &self.modes[k]);
        let mut value = Complex::from(own);
        for _ in 0..MAX_STEPS {
            let (forces, square) = self.mode_at(k, value)?;
            let by_forces: Complex = forces.iter().zip(phi).map(|(force, phi)| force * *phi).sum();
            let step = (value - own - by_forces) / square;
            value -= step;
            if !value.is_finite() {
                return None;
            }
            if step.norm() <= FOUND * value.norm() {
                return Some(FoundPole { value, forces, square });
            }
        }
        None
    }

    /// Forces y on the motions at x while clamped mode k has the amplitude one, and the sum of the squares of all
    /// amplitudes.
    fn mode_at(&self, k: usize, x: Complex) -> Option<(Vec<Complex>, Complex)> {
        let count = self.at_rest.nrows();
        let entries = count * (count + 1) / 2;
        let zero = Complex::new(0.0, 0.0);

        // Sums over the other poles of φφᵀ/(x − p).
        let (mut re, mut im) = (vec![0.0; entries], vec![0.0; entries]);
        for (j, (pole, products)) in self.family.poles.iter().zip(self.products.chunks_exact(entries)).enumerate() {
            if j == k {
                continue;
            }
            let factor = (x - *pole).inv();
            for ((re, im), product) in re.iter_mut().zip(&mut im).zip(products) {
                *re += factor.re * product;
                *im += factor.im * product;
            }
        }
        let matrix = CDMat::from_fn(count, count, |i, j| {
            let (row, column) = (i.max(j), i.min(j));
            let at = row * (row + 1) / 2 + column;
            self.without_modes[(i, j)] - Complex::new(re[at], im[at])
        });
        let forces = CDMat::from_fn(count, 1, |i, _| self.modes[k][i].into());
        let forces: Vec<Complex> = matrix.lu().solve(&forces)?.iter().copied().collect();

        // Amplitudes of the other clamped modes under these forces.
        let amplitude = |(pole, phi): (&f64, &Vec<f64>)| -> Complex {
            forces.iter().zip(phi).map(|(force, phi)| force * *phi).sum::<Complex>() / (x - *pole)
        };
        let others = self.family.poles.iter().zip(&self.modes).enumerate().filter(|(j, _)| *j != k);
        let square = others.map(|(_, mode)| amplitude(mode)).fold(zero, |sum, v| sum + v * v) + 1.0;
        Some((forces, square))
    }

    /// Participation of the start in the mode of a pole.
    fn participation<const D: usize>(&self, k: usize, pole: &FoundPole) -> [Complex; D] {
        let FoundPole { value, forces, square } = pole;
        let mut sum: [Complex; D] = from_fn(|s| self.family.participation[k][s].into());
        for (j, (other, phi)) in self.family.poles.iter().zip(&self.modes).enumerate().filter(|(j, _)| *j != k) {
            let force: Complex = forces.iter().zip(phi).map(|(force, phi)| force * *phi).sum();
            let amplitude = force / (*value - *other);
            sum.iter_mut().zip(&self.family.participation[j]).for_each(|(sum, g)| *sum += amplitude * *g);
        }
        let size = square.sqrt();
        from_fn(|s| {
            let by_start: Complex = forces.iter().enumerate().map(|(i, force)| force * self.by_start[(i, s)]).sum();
            (sum[s] - by_start / *value) / size
        })
    }

    /// Entries of the static stiffness and of the mass with the loss.
    fn slow(&self) -> Option<([Complex; E], [Complex; E])> {
        let (family, count) = (self.family, self.at_rest.nrows());
        let start = self.by_start.ncols();
        let complex = |matrix: &DMat| matrix.map(Complex::from);

        // Derivatives by x at rest of the motions by the start and by forces.
        let poles = || family.poles.iter().zip(&self.modes);
        let start_slope = complex(&DMat::from_fn(count, start, |i, s| {
            poles().zip(&family.participation).map(|((pole, phi), g)| phi[i] * g[s] / pole).sum()
        }));
        let own_slope = complex(&DMat::from_fn(count, count, |i, j| {
            poles().map(|(pole, phi)| phi[i] * phi[j] / (pole * pole)).sum()
        }));

        let by_start = complex(&self.by_start);
        let forces = self.at_rest.clone().lu().solve(&by_start)?;
        let added = by_start.transpose() * &forces;
        let turned = start_slope.transpose() * &forces;
        let added_slope = &turned + turned.transpose() - forces.transpose() * own_slope * &forces;
        let entries = entry_indices::<E>();
        let (stiffness, mass) = (at_start(&family.stiffness), at_start(&family.mass));
        let entry = |real: [f64; E], matrix: &CDMat, sign: f64| -> [Complex; E] {
            from_fn(|e| matrix[entries[e]] * sign + real[e])
        };
        Some((entry(stiffness, &added, 1.0), entry(mass, &added_slope, -1.0)))
    }
}

impl LossyBesidePoles {
    /// Adds the motions out of plane, in which no rope stretches.
    fn add_out_of_plane(&mut self, family: &PoleResidue<2, 1>, x: Complex, width: f64, below: f64) {
        let near = family.near(x.re, width);
        [self.stiffness.out_of_plane] = family.damped_without(x, near.clone());
        [self.mass.out_of_plane] = family.damped_mass_without(x, near.clone());
        let others = (0..family.poles_below(below)).filter(|k| !near.contains(k));
        self.others.extend(others.map(|k| Complex::from(family.poles[k])));
        let zero = Complex::new(0.0, 0.0);
        self.near.extend(near.map(|k| (family.poles[k].into(), [zero, zero, family.participation[k][0].into()])));
    }
}

impl<const D: usize, const E: usize> LossyPoles<D, E> {
    /// Poles of the first `count` that are not near.
    fn others<'a>(&'a self, count: usize, near: &Range<usize>) -> impl Iterator<Item = Complex> + use<'a, D, E> {
        let near = near.clone();
        self.poles[..count].iter().enumerate().filter(move |(k, _)| !near.contains(k)).map(|(_, pole)| *pole)
    }

    /// Entries of the stiffness at the complex x = ω_c² [N/m], and of minus its derivative by x [kg], without the poles
    /// `left_out`.
    pub(crate) fn without(&self, x: Complex, left_out: &Range<usize>) -> ([Complex; E], [Complex; E]) {
        let zero = Complex::new(0.0, 0.0);
        let (mut sums, mut slopes) = ([zero; E], [zero; E]);
        for k in (0..left_out.start).chain(left_out.end..self.poles.len()) {
            let pole = self.poles[k];
            let inverse = (pole - x).inv();
            let slope = inverse * inverse * x * (2.0 * pole - x);
            for ((sum, by_square), residues) in sums.iter_mut().zip(&mut slopes).zip(&self.residues) {
                *sum += inverse * residues[k];
                *by_square += slope * residues[k];
            }
        }
        let stiffness = from_fn(|e| self.stiffness[e] - x * (self.mass[e] + x * sums[e]));
        (stiffness, from_fn(|e| self.mass[e] + slopes[e]))
    }

    /// Indices from the first to the last pole in the relative distance `width` of x.
    pub(crate) fn near(&self, x: Complex, width: f64) -> Range<usize> {
        let is_near = |pole: &Complex| (pole - x).norm() < width * x.norm();
        let Some(first) = self.poles.iter().position(is_near) else { return 0..0 };
        first..self.poles.iter().rposition(is_near).map_or(first, |last| last + 1)
    }
}

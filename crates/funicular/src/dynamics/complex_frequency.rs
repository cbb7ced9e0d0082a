//! Dynamic stiffness D at a complex frequency, for the damped natural frequencies.
//!
//! As in [`null_vectors`](super::null_vectors), poles near the frequency are separate unknowns, so that no entry is
//! large:
//!
//! ```text
//! B(ω) = [ D_regular   −s g_k  ]
//!        [ −s g_kᵀ     ω_k² − s ]      s = ω_c²(ω)
//! ```
//!
//! The motions z of a drive that have losses are unknowns, too: the forces Δ z of its losses act on platform and
//! clamped modes by T and φ_k, and `z = T x + φ_k q_k − R Δ z` (docs/theory.md, equation (82)). Motions without losses
//! follow the others. Where only the determinant is wanted, the motions of each drive are eliminated, except near a
//! frequency at which the drive alone vibrates with losses.

use super::supports::{Supports, SupportsAt};
use super::{DynamicCableAt, Dynamics, NEAR_POLE_FRACTION, add_local};
use crate::cable::catenary_dynamic::{
    CatenaryDynamicEnd, DriveAt, Family, LossyBesidePoles, LossyFamily, NearPole, NearRanges,
};
use crate::math::{CDMat, CMat6, CVec6, Complex, complex_symmetric, order};

/// Results wanted of a bordered dynamic stiffness.
#[derive(Clone, Copy, PartialEq, Eq)]
enum BorderedFor {
    /// Motions: all are unknowns, and the derivative belongs to them.
    Motion,
    /// Logarithmic derivative of the determinant: the motions of drives are no unknowns where that loses no digits;
    /// their determinant is then part of the product.
    Slope,
    /// Determinant, as for its derivative, which stays incomplete.
    Determinant,
}

/// Dynamic stiffness at a complex frequency, bordered by near poles, and its derivative.
struct Bordered {
    value: CDMat,
    /// Incomplete where only the determinant is wanted.
    slope: CDMat,
    /// Sum of (d/dω) ln(ω_k² − s) over the poles below a limit that are not in the border.
    pole_slope: Complex,
    /// Phase of the product of ω_k² − s over these poles.
    pole_phase: f64,
}

/// Motion at a zero of the damped dynamic stiffness.
pub(crate) struct DampedMotion {
    /// Motion of the platform, scaled, in its coordinates.
    pub(crate) platform: CVec6,
    /// Amplitudes of the clamped modes whose poles lie near: index of the cable among those whose stiffness depends on
    /// frequency, family, index of the mode, amplitude.
    pub(crate) near: Vec<(usize, Family, usize, Complex)>,
    /// Displacements of the supports, world axes; none on a rigid frame.
    pub(crate) supports: Vec<Complex>,
    /// Derivative of the quadratic form of the motion with respect to ω.
    pub(crate) slope: Complex,
}

/// Second smallest singular value over the largest below which a zero is shared: rounding leaves 1e-15.
const SHARED_ZERO: f64 = 1e-13;

impl Dynamics {
    /// Motion at a simple zero ω [rad/s], for cables that are catenary-dynamic or do not depend on frequency; of size
    /// one.
    pub(crate) fn damped_motion(&self, omega: Complex) -> Option<DampedMotion> {
        let at = ZeroVectors::of(self, omega)?;
        if at.shared > 1 {
            return None;
        }
        let motion = at.motion(0);
        let slope = at.product(&at.left(&motion), &motion);
        Some(at.damped_motion(&motion, slope))
    }

    /// Motions at zeros that lie so near to each other that one ω [rad/s] stands for all: at least `count`, independent
    /// of each other, with their places relative to ω [rad/s]. Places within `same` [rad/s] of each other are one
    /// place, zero. `None` if two motions are one, so that their sum does not decay by exponentials alone.
    ///
    /// The derivative of D between motions that span the space is a symmetric matrix G. In vectors that are orthogonal
    /// by it, the residue of the receptance is the sum of those of the motions, whichever vectors these are.
    ///
    /// # References
    /// docs/theory.md, equation (46f1).
    pub(crate) fn shared_motions(
        &self,
        omega: Complex,
        count: usize,
        same: f64,
    ) -> Option<Vec<(Complex, DampedMotion)>> {
        let at = ZeroVectors::of(self, omega)?;
        let all: Vec<Vec<Complex>> = (0..count.max(at.shared).min(at.motions())).map(|k| at.motion(k)).collect();
        let lefts: Vec<Vec<Complex>> = all.iter().map(|motion| at.left(motion)).collect();
        let between = |of: &dyn Fn(&[Complex], &[Complex]) -> Complex| {
            CDMat::from_fn(all.len(), all.len(), |i, j| 0.5 * (of(&lefts[i], &all[j]) + of(&lefts[j], &all[i])))
        };
        let slopes = between(&|left, motion| at.product(left, motion));
        let values = between(&|left, motion| at.value_product(left, motion));

        let orthogonal = complex_symmetric::orthogonalised(&slopes)?;
        let places = orthogonal.transpose() * values * &orthogonal;
        let (places, turned) = complex_symmetric::diagonalised(places, same)?;
        let vectors = orthogonal * turned;
        let found = (0..all.len()).map(|k| {
            let sum = |i: usize| -> Complex { all.iter().enumerate().map(|(j, of)| of[i] * vectors[(j, k)]).sum() };
            let motion: Vec<Complex> = (0..all[0].len()).map(sum).collect();
            // D(ω) + (ω_k − ω) D'(ω) is zero along the motion.
            (-places[k], at.damped_motion(&motion, Complex::new(1.0, 0.0)))
        });
        Some(found.collect())
    }

    /// Poles of a cable that are unknowns of their own at the square ω_c² of its frequency, as in the border.
    pub(crate) fn near_of_border(form: &CatenaryDynamicEnd, square: Complex) -> NearRanges {
        form.near(square.re, NEAR_POLE_FRACTION)
    }

    /// Square ω_c² of cable `i` at a complex ω [rad/s], and its derivatives by the mass per length and by the damping.
    pub(crate) fn square_by_damping(&self, i: usize, omega: Complex) -> (Complex, [Complex; 2]) {
        let (damping, mass_per_length) = self.damping[i];
        (damping.square_with_slope(omega, mass_per_length).0, damping.square_by_values(omega, mass_per_length))
    }

    /// Finds the poles of the cables with constant loss factors, if the determinant at this many frequencies is worth
    /// them.
    pub(crate) fn find_lossy_poles(&self, frequencies: usize) {
        for form in self.terms.iter().filter_map(|term| term.form.by_poles()) {
            form.lossy_family(frequencies);
        }
    }

    /// Logarithmic derivative (d/dω) ln f at ω. f is det D times the product of ω_k² − ω_c² over all clamped modes of
    /// the cables below `poles_below` [rad/s].
    ///
    /// The zeros of f are the damped natural frequencies, with their multiplicity, and f has no pole in their region.
    /// `losses` is the fraction of the damping that acts: 1 all, 0 none.
    pub(crate) fn logarithmic_slope(&self, omega: Complex, losses: f64, poles_below: f64) -> Complex {
        let Bordered { value, slope, pole_slope, .. } = self.bordered(omega, losses, poles_below, BorderedFor::Slope);
        match value.lu().solve(&slope) {
            Some(solved) => solved.trace() + pole_slope,
            None => Complex::new(f64::INFINITY, 0.0),
        }
    }

    /// Phase of f of [`logarithmic_slope`](Self::logarithmic_slope) [rad], up to multiples of 2π.
    pub(crate) fn phase(&self, omega: Complex, losses: f64, poles_below: f64) -> f64 {
        let Bordered { value, pole_phase, .. } = self.bordered(omega, losses, poles_below, BorderedFor::Determinant);
        value.lu().determinant().arg() + pole_phase
    }

    /// Bordered dynamic stiffness at a complex ω [rad/s] with the fraction `losses` of the damping. The clamped modes
    /// of the cables below `poles_below` [rad/s] complete the determinant.
    fn bordered(&self, omega: Complex, losses: f64, poles_below: f64, purpose: BorderedFor) -> Bordered {
        let mut parts = BorderedParts::of_platform(self, omega, losses, purpose);
        (0..self.terms.len()).for_each(|t| parts.add_cable(t, poles_below));
        parts.assembled()
    }
}

/// Vectors that the bordered dynamic stiffness takes nearly to zero at a complex frequency.
struct ZeroVectors<'d> {
    dynamics: &'d Dynamics,
    value: CDMat,
    slope: CDMat,
    /// Poles near ω, as the border has them: index of the cable among those whose stiffness depends on frequency,
    /// family, index of the mode.
    near: Vec<(usize, Family, usize)>,
    /// Row from which on motions of drives follow.
    first_drive: usize,
    /// Stiffness of the losses of each motion of the drives, Δ.
    losses: Vec<Complex>,
    /// Conjugate right singular vectors as rows, of entries over their units, and their order by singular values.
    rows: CDMat,
    order: Vec<usize>,
    units: Vec<f64>,
    /// Number of singular values that are zero except for rounding, at least one.
    shared: usize,
}

impl<'d> ZeroVectors<'d> {
    /// `None` for a cable model without motions at complex frequencies.
    fn of(dynamics: &'d Dynamics, omega: Complex) -> Option<Self> {
        let Bordered { value, slope, .. } = dynamics.bordered(omega, 1.0, 0.0, BorderedFor::Motion);
        // Poles near ω, as the border has them.
        let (mut near, mut losses) = (Vec::new(), Vec::new());
        for (t, term) in dynamics.terms.iter().enumerate() {
            let form = term.form.by_poles()?;
            let (damping, mass_per_length) = dynamics.damping[term.cable];
            let (square, _) = damping.square_with_slope(omega, mass_per_length);
            let poles = form.near_poles(&Dynamics::near_of_border(form, square));
            near.extend(poles.into_iter().map(|pole| (t, pole.family, pole.index)));
            losses.extend(motions_with_losses(form, omega, 1.0).into_iter().map(|(_, (delta, _))| delta));
        }

        // Amplitudes of clamped modes in the unit of the platform's motion, so that all entries have one size. Supports
        // follow, then drives, whose rows are motions.
        let (dof, bordered) = (dynamics.dof(), dynamics.dof() + near.len());
        let first_drive = bordered + dynamics.supports.as_ref().map_or(0, |supports| supports.count());
        let stiffest = (0..dof).map(|k| value[(k, k)].norm()).fold(0.0, f64::max);
        let unit = |k: usize| if (dof..bordered).contains(&k) { stiffest.sqrt() / omega.norm() } else { 1.0 };
        let weight = |row: usize| if row < first_drive { unit(row) } else { stiffest };
        let scaled = CDMat::from_fn(value.nrows(), value.ncols(), |r, c| value[(r, c)] * (weight(r) * unit(c)));
        let svd = scaled.svd(false, true);
        let mut values: Vec<(f64, usize)> = svd.singular_values.iter().copied().zip(0..).collect();
        order::sort_ascending(&mut values, |(value, _)| *value);
        let largest = values.last()?.0;
        let shared = values.iter().skip(1).take_while(|(of, _)| *of <= SHARED_ZERO * largest).count() + 1;
        let order = values.into_iter().map(|(_, index)| index).collect();
        let units = (0..value.nrows()).map(unit).collect();
        Some(Self { dynamics, value, slope, near, first_drive, losses, rows: svd.v_t?, order, units, shared })
    }

    /// Number of vectors.
    fn motions(&self) -> usize {
        self.order.len()
    }

    /// Vector with the `k`-th smallest singular value.
    fn motion(&self, k: usize) -> Vec<Complex> {
        self.rows.row(self.order[k]).iter().zip(&self.units).map(|(z, unit)| z.conj() * *unit).collect()
    }

    /// Vector of the transposed matrix: it has the forces −Δz of the drives in place of their motions z.
    fn left(&self, motion: &[Complex]) -> Vec<Complex> {
        let mut left = motion.to_vec();
        left[self.first_drive..].iter_mut().zip(&self.losses).for_each(|(z, delta)| *z *= -delta);
        left
    }

    /// Product of two vectors with the derivative of the matrix.
    fn product(&self, left: &[Complex], motion: &[Complex]) -> Complex {
        Self::between(&self.slope, left, motion)
    }

    /// Product of two vectors with the matrix.
    fn value_product(&self, left: &[Complex], motion: &[Complex]) -> Complex {
        Self::between(&self.value, left, motion)
    }

    fn between(matrix: &CDMat, left: &[Complex], motion: &[Complex]) -> Complex {
        let product = |r: usize| -> Complex { (0..motion.len()).map(|c| matrix[(r, c)] * motion[c]).sum() };
        (0..motion.len()).map(|r| left[r] * product(r)).sum()
    }

    /// Parts of a motion with the derivative of its quadratic form.
    fn damped_motion(&self, motion: &[Complex], slope: Complex) -> DampedMotion {
        let dof = self.dynamics.dof();
        let near = self.near.iter().enumerate();
        let near: Vec<_> = near.map(|(k, (t, family, index))| (*t, *family, *index, motion[dof + k])).collect();
        let platform = CVec6::from_fn(|i, _| if i < dof { motion[i] } else { Complex::new(0.0, 0.0) });
        let supports = motion[dof + near.len()..self.first_drive].to_vec();
        DampedMotion { platform, near, supports, slope }
    }
}

/// Parts of the bordered dynamic stiffness, to which one cable after the other is added. Every derivative is by ω.
struct BorderedParts<'d> {
    dynamics: &'d Dynamics,
    omega: Complex,
    /// Fraction of the damping that acts.
    losses: f64,
    purpose: BorderedFor,
    /// Stiffness of platform and cables without the poles near ω.
    value: CMat6,
    slope: CMat6,
    /// Logarithmic derivative and phase of the product over the poles that are not near.
    pole_slope: Complex,
    pole_phase: f64,
    /// Near poles of all cables.
    borders: Vec<BorderRow>,
    /// Motions of drives with losses.
    drives: Vec<DriveRows>,
    /// Square ω_c² of each cable, and its derivative.
    squares: Vec<(Complex, Complex)>,
}

/// Pole near ω, whose clamped mode is an unknown of its own.
struct BorderRow {
    /// g_k in the platform's coordinates [√kg].
    participation: CVec6,
    /// g_k over the displacements of the supports [√kg]; empty on a rigid frame.
    on_supports: Vec<f64>,
    /// ω_k², or with a constant loss factor λ_k [rad²/s²].
    pole: Complex,
    /// Square ω_c² of its cable, and its derivative.
    square: (Complex, Complex),
}

impl<'d> BorderedParts<'d> {
    /// Platform without cables.
    fn of_platform(dynamics: &'d Dynamics, omega: Complex, losses: f64, purpose: BorderedFor) -> Self {
        let i = Complex::i();
        let Dynamics { constant, mass, .. } = dynamics;
        let damping = dynamics.platform_damping * losses;
        let value =
            CMat6::from_fn(|r, c| constant[(r, c)] + i * omega * damping[(r, c)] - omega * omega * mass[(r, c)]);
        let slope = CMat6::from_fn(|r, c| i * damping[(r, c)] - 2.0 * omega * mass[(r, c)]);
        Self {
            dynamics,
            omega,
            losses,
            purpose,
            value,
            slope,
            pole_slope: Complex::new(0.0, 0.0),
            pole_phase: 0.0,
            borders: Vec::new(),
            drives: Vec::new(),
            squares: Vec::with_capacity(dynamics.terms.len()),
        }
    }

    /// Adds cable `t` of those whose stiffness depends on frequency.
    fn add_cable(&mut self, t: usize, poles_below: f64) {
        let term = &self.dynamics.terms[t];
        let (damping, mass_per_length) = self.dynamics.damping[term.cable];
        let square = damping.times(self.losses).square_with_slope(self.omega, mass_per_length);
        self.squares.push(square);
        if let Some((form, lossy)) = self.lossy_family(term) {
            let beside = form.lossy_beside_poles(lossy, square.0, NEAR_POLE_FRACTION, poles_below * poles_below);
            self.add_lossy_cable(term, &beside, square);
            return;
        }

        // Stiffness without the poles near ω.
        let (stiffness, near) = term.form.complex_beside_poles(square.0, NEAR_POLE_FRACTION);
        add_local(&mut self.value, term, &stiffness);
        if self.purpose != BorderedFor::Determinant {
            let mass = term.form.complex_mass_beside_poles(square.0, NEAR_POLE_FRACTION);
            add_local(&mut self.slope, term, &mass.map(|mass| -square.1 * mass));
        }

        // Poles that are not near are factors of the product.
        let is_near = |pole: f64| near.iter().any(|near| near.pole.to_bits() == pole.to_bits());
        for pole in term.form.poles_below(poles_below).iter().filter(|pole| !is_near(**pole)) {
            let gap = pole - square.0;
            self.pole_slope -= square.1 / gap;
            self.pole_phase += gap.arg();
        }

        // Motions of the drive, and the near poles, which are unknowns.
        self.drives.extend(self.drive_rows(t, square, &near));
        let supports = self.dynamics.supports();
        self.borders.extend(near.iter().map(|near| BorderRow {
            participation: term.vector(near.direction).map(Complex::from),
            on_supports: supports.map_or_else(Vec::new, |supports| supports.participation(t, near)),
            pole: near.pole.into(),
            square,
        }));
    }

    /// Poles of a cable with a constant loss of its stretch, where they say all and are known: for the determinant with
    /// all of the damping, and on a rigid frame.
    fn lossy_family(&self, term: &'d DynamicCableAt) -> Option<(&'d CatenaryDynamicEnd, &'d LossyFamily)> {
        if self.purpose == BorderedFor::Motion || self.losses < 1.0 || self.dynamics.supports().is_some() {
            return None;
        }
        let form = term.form.by_poles()?;
        Some((form, form.lossy_family(0)?))
    }

    /// Adds a cable by its poles with loss.
    fn add_lossy_cable(&mut self, term: &DynamicCableAt, beside: &LossyBesidePoles, square: (Complex, Complex)) {
        add_local(&mut self.value, term, &beside.stiffness);
        if self.purpose != BorderedFor::Determinant {
            add_local(&mut self.slope, term, &beside.mass.map(|mass| -square.1 * mass));
        }
        for pole in &beside.others {
            let gap = pole - square.0;
            self.pole_slope -= square.1 / gap;
            self.pole_phase += gap.arg();
        }

        let axes = term.axes();
        self.borders.extend(beside.near.iter().map(|(pole, direction)| BorderRow {
            participation: CVec6::from_fn(|i, _| direction.iter().zip(axes).map(|(g, axis)| g * axis[i]).sum()),
            on_supports: Vec::new(),
            pole: *pole,
            square,
        }));
    }

    /// Rows of the drive of cable `t`, whose near poles follow those of the cables before; `None` without losses.
    fn drive_rows(&self, t: usize, (square, square_slope): (Complex, Complex), near: &[NearPole]) -> Option<DriveRows> {
        let term = &self.dynamics.terms[t];
        let form = term.form.by_poles()?;
        let (indices, loss): (Vec<usize>, Vec<(Complex, Complex)>) =
            motions_with_losses(form, self.omega, self.losses).into_iter().unzip();
        if indices.is_empty() {
            return None;
        }
        let left_out = form.near(square.re, NEAR_POLE_FRACTION);
        let motions = form.motions_at(&indices, square, &left_out)?;
        let mut rows = DriveRows::new(term, form, (&indices, &motions), loss, (near, self.borders.len()), square_slope);
        if let Some(supports) = self.dynamics.supports() {
            let by_supports = supports.drive(t, &indices, square, &left_out);
            rows.on_supports =
                by_supports.or_else(|| supports.sheaves().drive(t, &motions, supports.count())).unwrap_or_default();
            rows.on_supports.iter_mut().flatten().for_each(|(_, slope)| *slope *= square_slope);
        }
        Some(rows)
    }

    /// Matrix over the platform, the near poles, the supports and the motions of drives that are not eliminated, in
    /// this order.
    fn assembled(self) -> Bordered {
        let dynamics = self.dynamics;
        let f = dynamics.dof();
        let first_support = f + self.borders.len();
        let first_drive = first_support + dynamics.supports().map_or(0, Supports::count);
        let drives: Vec<(DriveRows, Option<EliminatedDrive>)> = (self.drives.into_iter())
            .map(|drive| {
                let found = if self.purpose == BorderedFor::Motion { None } else { EliminatedDrive::of(&drive) };
                (drive, found)
            })
            .collect();
        let kept = drives.iter().filter(|(_, found)| found.is_none());
        let n = first_drive + kept.map(|(drive, _)| drive.loss.len()).sum::<usize>();

        // The platform, then each near pole with its row.
        let (mut value, mut slope) = (CDMat::zeros(n, n), CDMat::zeros(n, n));
        value.view_mut((0, 0), (f, f)).copy_from(&self.value.view((0, 0), (f, f)));
        slope.view_mut((0, 0), (f, f)).copy_from(&self.slope.view((0, 0), (f, f)));
        for (k, border) in self.borders.iter().enumerate() {
            border.add((&mut value, &mut slope), f, f + k, first_support);
        }

        // The supports.
        if let Some(supports) = dynamics.supports() {
            let (omega, losses) = (self.omega, self.losses);
            let support_square = (omega * omega, 2.0 * omega);
            let at = SupportsAt { squares: self.squares, support_square, losses, width: NEAR_POLE_FRACTION };
            let rows = supports.rows(&dynamics.terms, &at);
            add_supports(&mut value, &rows.coupling.0, &rows.own.0, f, first_support);
            add_supports(&mut slope, &rows.coupling.1, &rows.own.1, f, first_support);
        }

        // The drives.
        let (mut pole_slope, mut pole_phase, mut first) = (self.pole_slope, self.pole_phase, first_drive);
        for (drive, found) in drives {
            if let Some(found) = found {
                let (places, transfer) = drive.by_others(f, first_support);
                found.add(&mut value, &mut slope, &places, &transfer);
                pole_slope += found.log_slope;
                pole_phase += found.phase;
                continue;
            }
            drive.add(&mut value, &mut slope, f, first);
            drive.add_to_supports(&mut value, &mut slope, first_support, first);
            first += drive.loss.len();
        }
        Bordered { value, slope, pole_slope, pole_phase }
    }
}

impl BorderRow {
    /// Adds row and column `own` of this pole to a matrix and its derivative, in which the platform's `dof` coordinates
    /// come first and the supports begin at `first_support`.
    fn add(&self, (value, slope): (&mut CDMat, &mut CDMat), dof: usize, own: usize, first_support: usize) {
        let (square, square_slope) = self.square;
        value[(own, own)] = self.pole - square;
        slope[(own, own)] = -square_slope;

        let by_platform = self.participation.iter().copied().take(dof).enumerate();
        let by_supports = self.on_supports.iter().enumerate().map(|(j, g)| (first_support + j, (*g).into()));
        for (other, g) in by_platform.chain(by_supports) {
            for (matrix, entry) in [(&mut *value, -square * g), (&mut *slope, -square_slope * g)] {
                matrix[(other, own)] = entry;
                matrix[(own, other)] = entry;
            }
        }
    }
}

/// Rows and columns of the motions z of a drive with losses; every entry with its derivative by ω.
struct DriveRows {
    /// T in the platform's coordinates, per motion.
    transfer: Vec<[(Complex, Complex); 6]>,
    /// R between the motions.
    receptance: Vec<Vec<(Complex, Complex)>>,
    /// Δ per motion.
    loss: Vec<(Complex, Complex)>,
    /// Near poles of the cable: their numbers in the border, and φ_k per motion.
    near: Vec<(usize, Vec<f64>)>,
    /// T for displacements of supports, per motion; empty for a rigid anchor.
    on_supports: Vec<Vec<(Complex, Complex)>>,
}

impl DriveRows {
    fn new(
        term: &DynamicCableAt,
        form: &CatenaryDynamicEnd,
        (indices, motions): (&[usize], &DriveAt),
        loss: Vec<(Complex, Complex)>,
        (near, first_border): (&[NearPole], usize),
        square_slope: Complex,
    ) -> Self {
        let count = indices.len();
        let axes = term.axes();

        // T and R.
        let in_platform =
            |row: &[Complex; 3], i: usize| -> Complex { row.iter().zip(axes).map(|(t, axis)| t * axis[i]).sum() };
        let transfer = (motions.transfer.iter().zip(&motions.transfer_slope))
            .map(|(row, slope)| std::array::from_fn(|i| (in_platform(row, i), in_platform(slope, i) * square_slope)))
            .collect();
        let entry = |i: usize, j: usize| (motions.receptance[(i, j)], motions.receptance_slope[(i, j)] * square_slope);
        let receptance = (0..count).map(|i| (0..count).map(|j| entry(i, j)).collect()).collect();

        let near = (near.iter().enumerate())
            .map(|(k, near)| {
                let all = form.drive_in_mode(near.index, near.family);
                (first_border + k, indices.iter().map(|motion| all[*motion]).collect())
            })
            .collect();
        Self { transfer, receptance, loss, near, on_supports: Vec::new() }
    }

    /// Places of `f` coordinates of the platform, of the near poles and of the supports in the matrix, and the motions
    /// by these: T and its derivative, one row per motion.
    fn by_others(&self, f: usize, first_support: usize) -> (Vec<usize>, Vec<Vec<(Complex, Complex)>>) {
        let zero = Complex::new(0.0, 0.0);
        let supports = self.on_supports.first().map_or(0, Vec::len);
        let border = self.near.iter().map(|(border, _)| f + border);
        let places = (0..f).chain(border).chain(first_support..first_support + supports).collect();
        let of = |j: usize| {
            let by_platform = self.transfer[j].iter().take(f).copied();
            let by_border = self.near.iter().map(|(_, phi)| (phi[j].into(), zero));
            let by_supports = self.on_supports.get(j).into_iter().flatten().copied();
            by_platform.chain(by_border).chain(by_supports).collect()
        };
        (places, (0..self.loss.len()).map(of).collect())
    }

    /// Adds the rows and columns to a matrix and its derivative: `f` coordinates of the platform, then the border, and
    /// these motions from the row `first` on.
    fn add(&self, value: &mut CDMat, slope: &mut CDMat, f: usize, first: usize) {
        for (j, (delta, delta_slope)) in self.loss.iter().enumerate() {
            let column = first + j;
            for r in 0..f {
                let (t, t_slope) = self.transfer[j][r];
                value[(r, column)] = t * delta;
                slope[(r, column)] = t_slope * delta + t * delta_slope;
                value[(column, r)] = -t;
                slope[(column, r)] = -t_slope;
            }
            for (border, phi) in &self.near {
                value[(f + border, column)] = phi[j] * delta;
                slope[(f + border, column)] = phi[j] * delta_slope;
                value[(column, f + border)] = (-phi[j]).into();
            }
            for (i, row) in self.receptance.iter().enumerate() {
                let (r, r_slope) = row[j];
                value[(first + i, column)] = r * delta + if i == j { 1.0 } else { 0.0 };
                slope[(first + i, column)] = r_slope * delta + r * delta_slope;
            }
        }
    }

    /// Adds the entries between these motions, from the row `first` on, and the supports, from the row `first_support`
    /// on.
    fn add_to_supports(&self, value: &mut CDMat, slope: &mut CDMat, first_support: usize, first: usize) {
        for (j, (row, (delta, delta_slope))) in self.on_supports.iter().zip(&self.loss).enumerate() {
            let column = first + j;
            for (k, (t, t_slope)) in row.iter().enumerate() {
                let at = first_support + k;
                value[(at, column)] = t * delta;
                slope[(at, column)] = t_slope * delta + t * delta_slope;
                value[(column, at)] = -t;
                slope[(column, at)] = -t_slope;
            }
        }
    }
}

/// Motions of a drive at a complex ω [rad/s] that have losses, ascending, with their stiffness Δ and its derivative by
/// ω. The other motions of the drive, as the waves of a drum side, follow these.
fn motions_with_losses(form: &CatenaryDynamicEnd, omega: Complex, losses: f64) -> Vec<(usize, (Complex, Complex))> {
    if !form.has_drive_losses() {
        return Vec::new();
    }
    let zero = Complex::new(0.0, 0.0);
    let all = form.beyond_undamped(omega, losses).0.into_iter().enumerate();
    all.filter(|(_, (delta, slope))| *delta != zero || *slope != zero).collect()
}

/// Motions of a drive that are eliminated: the stiffness `G = Δ (1 + R Δ)⁻¹` that they leave, and what they add to the
/// logarithm of the determinant.
struct EliminatedDrive {
    /// G and its derivative by ω.
    stiffness: CDMat,
    slope: CDMat,
    /// Derivative and imaginary part of ln det(1 + R Δ).
    log_slope: Complex,
    phase: f64,
}

/// Minimum of |det(1 + R Δ)| over the product of its columns' lengths at which the motions of a drive are eliminated:
/// two digits are lost there. It is zero where the drive vibrates with its losses while the platform rests, and about
/// one elsewhere.
const MIN_DETERMINANT: f64 = 1e-2;

impl EliminatedDrive {
    /// `None` near a frequency at which the drive alone vibrates with its losses.
    fn of(drive: &DriveRows) -> Option<Self> {
        let count = drive.loss.len();
        let (r, loss) = (&drive.receptance, &drive.loss);
        let one = |i: usize, j: usize| if i == j { 1.0 } else { 0.0 };
        let matrix = CDMat::from_fn(count, count, |i, j| r[i][j].0 * loss[j].0 + one(i, j));
        let slope = CDMat::from_fn(count, count, |i, j| r[i][j].1 * loss[j].0 + r[i][j].0 * loss[j].1);
        let lengths: f64 = matrix.column_iter().map(|column| column.norm()).product();
        let lu = matrix.lu();
        let determinant = lu.determinant();
        let is_separate = determinant.norm() >= MIN_DETERMINANT * lengths;
        if !is_separate {
            return None;
        }

        let inverse = lu.try_inverse()?;
        let turned = &inverse * slope;
        let by_inverse = &turned * &inverse;
        Some(Self {
            stiffness: CDMat::from_fn(count, count, |i, j| loss[i].0 * inverse[(i, j)]),
            slope: CDMat::from_fn(count, count, |i, j| loss[i].1 * inverse[(i, j)] - loss[i].0 * by_inverse[(i, j)]),
            log_slope: turned.trace(),
            phase: determinant.arg(),
        })
    }

    /// Adds `Tᵀ G T` to a matrix, and its derivative. T has one row per motion, with entries at these places. `G T` is
    /// formed first: the product of all three at once has a term for each pair of motions and each pair of places.
    fn add(&self, value: &mut CDMat, slope: &mut CDMat, places: &[usize], transfer: &[Vec<(Complex, Complex)>]) {
        for (i, row) in transfer.iter().enumerate() {
            for (c, column) in places.iter().enumerate() {
                // Force on this motion by a unit displacement.
                let (mut force, mut force_slope) = (Complex::new(0.0, 0.0), Complex::new(0.0, 0.0));
                for (j, moved) in transfer.iter().enumerate() {
                    let (t, t_slope) = moved[c];
                    force += self.stiffness[(i, j)] * t;
                    force_slope += self.slope[(i, j)] * t + self.stiffness[(i, j)] * t_slope;
                }
                for ((t, t_slope), place) in row.iter().zip(places) {
                    value[(*place, *column)] += t * force;
                    slope[(*place, *column)] += t_slope * force + t * force_slope;
                }
            }
        }
    }
}

/// Adds the rows of supports to a matrix over `f` coordinates of the platform and others, from the row `first` on.
fn add_supports(total: &mut CDMat, coupling: &CDMat, own: &CDMat, f: usize, first: usize) {
    let count = own.nrows();
    total.view_mut((first, first), (count, count)).copy_from(own);
    for j in 0..count {
        for i in 0..f {
            total[(i, first + j)] = coupling[(i, j)];
            total[(first + j, i)] = coupling[(i, j)];
        }
    }
}

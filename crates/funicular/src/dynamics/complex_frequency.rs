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
//! The motions z of a drive with losses are unknowns, too: the forces Δ z of its losses act on platform and clamped modes
//! by T and φ_k, and `z = T x + φ_k q_k − R Δ z` (docs/theory.md, equation (82)).

use super::supports::SupportsAt;
use super::{DynamicCableAt, Dynamics, NEAR_POLE_FRACTION, add_local};
use crate::cable::catenary_dynamic::{CatenaryDynamicEnd, DriveAt, DriveLosses, Family, NearPole, NearRanges};
use crate::cable::{DynamicCable, LocalStiffness};
use crate::math::{CDMat, CMat6, CVec6, Complex, order};

/// Dynamic stiffness at a complex frequency, bordered by near poles, and its derivative.
struct Bordered {
    value: CDMat,
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
    /// Motion at a simple zero ω [rad/s], for cables that are catenary-dynamic or do not depend on frequency; of size one.
    pub(crate) fn damped_motion(&self, omega: Complex) -> Option<DampedMotion> {
        let no_poles = vec![Vec::new(); self.terms.len()];
        let Bordered { value, slope, .. } = self.bordered(omega, 1.0, &no_poles);
        // Poles near ω, as the border has them.
        let mut near = Vec::new();
        for (t, term) in self.terms.iter().enumerate() {
            let DynamicCable::CatenaryDynamic(form) = &term.form else { return None };
            let (damping, mass_per_length) = self.damping[term.cable];
            let (square, _) = damping.square_with_slope(omega, mass_per_length);
            let (.., poles) = form.complex_beside_poles(square, NEAR_POLE_FRACTION);
            near.extend(poles.into_iter().map(|pole| (t, pole.family, pole.index)));
        }

        // Amplitudes of clamped modes in the unit of the platform's motion, so that all entries have one size. Supports follow,
        // then drives, whose rows are motions.
        let (dof, bordered) = (self.dof(), self.dof() + near.len());
        let first_drive = bordered + self.supports.as_ref().map_or(0, |supports| supports.count());
        let stiffest = (0..dof).map(|k| value[(k, k)].norm()).fold(0.0, f64::max);
        let unit = |k: usize| if (dof..bordered).contains(&k) { stiffest.sqrt() / omega.norm() } else { 1.0 };
        let weight = |row: usize| if row < first_drive { unit(row) } else { stiffest };
        let scaled = CDMat::from_fn(value.nrows(), value.ncols(), |r, c| value[(r, c)] * (weight(r) * unit(c)));
        let svd = scaled.svd(false, true);
        let mut values: Vec<(f64, usize)> = svd.singular_values.iter().copied().zip(0..).collect();
        order::sort_ascending(&mut values, |(value, _)| *value);
        if values.get(1).is_some_and(|(second, _)| *second <= SHARED_ZERO * values[values.len() - 1].0) {
            return None;
        }
        let row = svd.v_t?;
        let motion: Vec<Complex> = row.row(values[0].1).iter().enumerate().map(|(k, z)| z.conj() * unit(k)).collect();

        // The null vector of the transposed matrix has the forces −Δz of the drives in place of their motions z.
        let mut left = motion.clone();
        let mut first = first_drive;
        for term in &self.terms {
            let DynamicCable::CatenaryDynamic(form) = &term.form else { continue };
            if form.has_drive_losses() {
                for (delta, _) in form.beyond_undamped(omega, 1.0).0 {
                    left[first] *= -delta;
                    first += 1;
                }
            }
        }
        let product = |r: usize| -> Complex { (0..motion.len()).map(|c| slope[(r, c)] * motion[c]).sum() };
        let slope = (0..motion.len()).map(|r| left[r] * product(r)).sum();
        let near =
            near.into_iter().enumerate().map(|(k, (t, family, index))| (t, family, index, motion[dof + k])).collect();
        let platform = CVec6::from_fn(|i, _| if i < self.dof() { motion[i] } else { Complex::new(0.0, 0.0) });
        let supports = motion[bordered..first_drive].to_vec();
        Some(DampedMotion { platform, near, supports, slope })
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

    /// Squares of the clamped frequencies below ω [rad/s] of each cable whose stiffness depends on frequency.
    pub(crate) fn poles_below(&self, omega: f64) -> Vec<Vec<f64>> {
        self.terms.iter().map(|term| term.form.poles_below(omega)).collect()
    }

    /// Logarithmic derivative (d/dω) ln f at ω. f is det D times the product of ω_k² − ω_c² over the `poles` of
    /// [`poles_below`](Self::poles_below).
    ///
    /// The zeros of f are the damped natural frequencies, with their multiplicity, and f has no pole in their region.
    /// `losses` is the fraction of the damping that acts: 1 all, 0 none.
    pub(crate) fn logarithmic_slope(&self, omega: Complex, losses: f64, poles: &[Vec<f64>]) -> Complex {
        let Bordered { value, slope, pole_slope, .. } = self.bordered(omega, losses, poles);
        match value.lu().solve(&slope) {
            Some(solved) => solved.trace() + pole_slope,
            None => Complex::new(f64::INFINITY, 0.0),
        }
    }

    /// Phase of f of [`logarithmic_slope`](Self::logarithmic_slope) [rad], up to multiples of 2π.
    pub(crate) fn phase(&self, omega: Complex, losses: f64, poles: &[Vec<f64>]) -> f64 {
        let Bordered { value, pole_phase, .. } = self.bordered(omega, losses, poles);
        value.lu().determinant().arg() + pole_phase
    }

    fn bordered(&self, omega: Complex, losses: f64, poles: &[Vec<f64>]) -> Bordered {
        let i = Complex::i();
        let platform_damping = self.platform_damping * losses;

        // The platform.
        let mut value = CMat6::from_fn(|r, c| {
            self.constant[(r, c)] + i * omega * platform_damping[(r, c)] - omega * omega * self.mass[(r, c)]
        });
        let mut slope = CMat6::from_fn(|r, c| i * platform_damping[(r, c)] - 2.0 * omega * self.mass[(r, c)]);

        // The cables, without the poles near ω.
        let (mut pole_slope, mut pole_phase) = (Complex::new(0.0, 0.0), 0.0);
        let (mut borders, mut drives) = (Vec::new(), Vec::new());
        let (mut squares, mut on_supports) = (Vec::with_capacity(self.terms.len()), Vec::new());
        for (t, (term, poles)) in self.terms.iter().zip(poles).enumerate() {
            let (damping, mass_per_length) = self.damping[term.cable];
            let (square, square_slope) = damping.times(losses).square_with_slope(omega, mass_per_length);
            let (stiffness, mass, near) = match &term.form {
                DynamicCable::ShallowDynamic(form) => {
                    let (stiffness, mass) = form.at(square);
                    (stiffness, mass, Vec::new())
                }
                DynamicCable::CatenaryDynamic(form) => form.complex_beside_poles(square, NEAR_POLE_FRACTION),
            };
            squares.push((square, square_slope));
            add_scaled(&mut value, term, &stiffness, Complex::new(1.0, 0.0));
            add_scaled(&mut slope, term, &mass, -square_slope);

            // Poles that are not near are factors of the product.
            let is_near = |pole: f64| near.iter().any(|near| near.pole.to_bits() == pole.to_bits());
            for pole in poles.iter().filter(|pole| !is_near(**pole)) {
                let gap = pole - square;
                pole_slope -= square_slope / gap;
                pole_phase += gap.arg();
            }
            if let DynamicCable::CatenaryDynamic(form) = &term.form {
                let left_out = form.near(square.re, NEAR_POLE_FRACTION);
                if let Some(motions) = form.drive_at(square, &left_out).filter(|_| form.has_drive_losses()) {
                    let losses = form.beyond_undamped(omega, losses);
                    let first_border = borders.len();
                    let mut rows = DriveRows::new(term, form, &motions, &losses, (&near, first_border), square_slope);
                    if let Some(supports) = &self.supports {
                        rows.on_supports = supports.drive(t, square, &left_out).unwrap_or_default();
                        rows.on_supports.iter_mut().flatten().for_each(|(_, slope)| *slope *= square_slope);
                    }
                    drives.push(rows);
                }
            }
            if let Some(supports) = &self.supports {
                on_supports.extend(near.iter().map(|near| supports.participation(t, near)));
            }
            borders.extend(near.iter().map(|near| (term.vector(near.direction), near.pole, square, square_slope)));
        }

        // The border: each near pole is a separate unknown.
        let (f, mut first) = (self.dof(), self.dof() + borders.len());
        let first_support = first;
        first += self.supports.as_ref().map_or(0, |supports| supports.count());
        let n = first + drives.iter().map(|drive| drive.loss.len()).sum::<usize>();
        let (mut all, mut all_slope) = (CDMat::zeros(n, n), CDMat::zeros(n, n));
        all.view_mut((0, 0), (f, f)).copy_from(&value.view((0, 0), (f, f)));
        all_slope.view_mut((0, 0), (f, f)).copy_from(&slope.view((0, 0), (f, f)));
        let near_squares: Vec<(Complex, Complex)> =
            borders.iter().map(|(_, _, square, slope)| (*square, *slope)).collect();
        for (k, (g, pole, square, square_slope)) in borders.into_iter().enumerate() {
            all[(f + k, f + k)] = pole - square;
            all_slope[(f + k, f + k)] = -square_slope;
            for r in 0..f {
                for (entry, at) in [(&mut all, -square * g[r]), (&mut all_slope, -square_slope * g[r])] {
                    entry[(r, f + k)] = at;
                    entry[(f + k, r)] = at;
                }
            }
        }
        if let Some(supports) = &self.supports {
            let support_square = (omega * omega, 2.0 * omega);
            let rows =
                supports.rows(&self.terms, &SupportsAt { squares, support_square, losses, width: NEAR_POLE_FRACTION });
            add_supports(&mut all, &rows.coupling.0, &rows.own.0, f, first_support);
            add_supports(&mut all_slope, &rows.coupling.1, &rows.own.1, f, first_support);
            for (k, (participation, (square, square_slope))) in on_supports.iter().zip(&near_squares).enumerate() {
                for (j, g) in participation.iter().enumerate() {
                    for (entry, at) in [(&mut all, -square * *g), (&mut all_slope, -square_slope * *g)] {
                        entry[(first_support + j, f + k)] = at;
                        entry[(f + k, first_support + j)] = at;
                    }
                }
            }
        }
        for drive in drives {
            drive.add(&mut all, &mut all_slope, f, first);
            drive.add_to_supports(&mut all, &mut all_slope, first_support, first);
            first += drive.loss.len();
        }
        Bordered { value: all, slope: all_slope, pole_slope, pole_phase }
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
        motions: &DriveAt,
        losses: &DriveLosses,
        (near, first_border): (&[NearPole], usize),
        square_slope: Complex,
    ) -> Self {
        let count = losses.0.len();
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
            .map(|(k, near)| (first_border + k, form.drive_in_mode(near.index, near.family)))
            .collect();
        let loss = losses.0.clone();
        Self { transfer, receptance, loss, near, on_supports: Vec::new() }
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
}

impl DriveRows {
    /// Adds the entries between these motions, from the row `first` on, and the supports, from the row `first_support` on.
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

fn add_scaled(total: &mut CMat6, term: &DynamicCableAt, k: &LocalStiffness<Complex>, factor: Complex) {
    add_local(total, term, k, |k, product| k * factor * product);
}

//! Modes at a known natural frequency: null vectors of D, with near poles as separate unknowns.
//!
//! A mode at or very near a cable's clamped frequency is almost only a vibration of that cable, and the pole dominates
//! D there. So a pole ω_k² near x = ω² is not summed; the amplitude q_k of its clamped mode (unit modal mass) is an
//! unknown:
//!
//! ```text
//! A(x) = [ D_regular   −x g_k  ]      −dA/dx = [ M_regular   g_k ]
//!        [ −x g_kᵀ     ω_k² − x ]               [ g_kᵀ         1  ]
//! ```
//!
//! A is regular, and its null vectors contain the motions of both the platform and that cable.

use super::supports::SupportRows;
use super::{Dynamics, NEAR_POLE_FRACTION, add_local};
use crate::cable::catenary_dynamic::{Family, MotionsOfDrive, NearRanges};
use crate::math::{DMat, Mat6, Vec6, order, symmetric};

/// Amplitude of one clamped mode of one cable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct NearMotion {
    /// Index of the cable among those whose stiffness depends on frequency.
    pub(crate) term: usize,
    /// Family of the mode.
    pub(crate) family: Family,
    /// Index of the pole among those of the cable in that family.
    pub(crate) pole: usize,
    /// Amplitude q_k, in the scale of the platform's motion [m √kg].
    pub(crate) amplitude: f64,
}

/// Natural motion, normalised to unit modal mass.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct NullVector {
    /// Scaled motion of the platform [m].
    pub(crate) platform: Vec6,
    /// Amplitudes of the clamped modes whose poles lie near.
    pub(crate) near: Vec<NearMotion>,
    /// Displacements of the supports, world axes, and lengths that have run over sheaves [m]; empty without either.
    pub(crate) supports: Vec<f64>,
    /// Kinetic energy of the platform as a fraction of the total.
    pub(crate) platform_energy: f64,
    /// Kinetic energy of each cable as a fraction of the total, without its drive.
    pub(crate) cable_energies: Vec<f64>,
    /// Kinetic energy of the drive of each cable as a fraction of the total; empty if no drive has mass.
    pub(crate) drive_energies: Vec<f64>,
    /// Kinetic energy of each support as a fraction of the total; empty on a rigid frame.
    pub(crate) support_energies: Vec<f64>,
    /// Share of the stretch of each cable in the energy of deformation, ω² times the modal mass; empty unless the
    /// strains are known.
    pub(crate) stretching: Vec<f64>,
    /// Damping ratio of drives, supports and the loss of stretch to first order.
    pub(crate) drive_damping: f64,
    /// Residual |vᵀ A v|/x: twice the relative change of the frequency by another Newton step.
    pub(crate) residual: f64,
}

impl Dynamics {
    /// Natural motions at ω [rad/s]; `several` is their number.
    pub(crate) fn null_vectors(&self, omega: f64, several: usize) -> Vec<NullVector> {
        if self.terms.iter().any(|term| term.form.by_poles().is_none()) {
            self.null_vectors_of_shallow_dynamic(omega, several)
        } else {
            self.null_vectors_beside_poles(omega, several)
        }
    }

    /// Null vectors of D itself, for cables in the shallow-dynamic model.
    fn null_vectors_of_shallow_dynamic(&self, omega: f64, several: usize) -> Vec<NullVector> {
        let d = self.dynamic_stiffness(omega);
        let (values, vectors) = symmetric::eigen(&d, self.dof());
        nearest_zero(&values, several)
            .map(|k| {
                let (platform, cables) = self.effective_masses(omega, &vectors[k]);
                let total = platform + cables.iter().sum::<f64>();
                NullVector {
                    platform: vectors[k] / total.sqrt(),
                    near: Vec::new(),
                    supports: Vec::new(),
                    support_energies: Vec::new(),
                    platform_energy: platform / total,
                    cable_energies: cables.iter().map(|mass| mass / total).collect(),
                    drive_energies: Vec::new(),
                    stretching: Vec::new(),
                    drive_damping: 0.0,
                    residual: values[k].abs() / (omega * omega * total),
                }
            })
            .collect()
    }

    /// Null vectors of the pencil in which each near pole is a separate unknown, for catenary-dynamic cables.
    fn null_vectors_beside_poles(&self, omega: f64, several: usize) -> Vec<NullVector> {
        let x = omega * omega;
        let pencil = BorderedPencil::at(self, x);
        let (a, m) = pencil.matrices(self.dof(), x);
        let (a, m, massless) = without_massless(a, m, self.dof() + pencil.near.len());

        // The mass of platform and cables is positive definite, because the motions are independent.
        let Some(factor) = m.cholesky() else { return Vec::new() };
        let l = factor.l();
        let half = l.solve_lower_triangular(&a).unwrap_or(a);
        let standard = l.solve_lower_triangular(&half.transpose()).unwrap_or(half);
        let all = standard.symmetric_eigen();

        nearest_zero(all.eigenvalues.as_slice(), several)
            .map(|k| {
                let v = l.tr_solve_lower_triangular(&all.eigenvectors.column(k)).expect("the factor is regular");
                let v = massless.as_ref().map_or_else(|| v.as_slice().to_vec(), |rest| rest.completed(v.as_slice()));
                pencil.null_vector(self, omega, &v, all.eigenvalues[k].abs() / x)
            })
            .collect()
    }
}

/// Pencil at x = ω² in which the amplitudes of the clamped modes with a pole near x are unknowns.
struct BorderedPencil {
    /// Stiffness of the platform at x, without the near poles [N/m].
    stiffness: Mat6,
    /// Minus its derivative by x [kg].
    mass: Mat6,
    /// Part of that mass that belongs to each cable whose stiffness depends on frequency [kg].
    cable_masses: Vec<Mat6>,
    /// Clamped modes with a pole near x.
    near: Vec<NearMode>,
    /// Rows of the supports; their derivatives are by x.
    supports: Option<SupportRows>,
}

/// Clamped mode with a pole near x.
struct NearMode {
    /// Place of the mode; the amplitude is not known yet.
    motion: NearMotion,
    /// g_k in the platform's coordinates [√kg].
    participation: Vec6,
    /// g_k over the displacements of the supports [√kg]; empty on a rigid frame.
    on_supports: Vec<f64>,
    /// ω_k² [rad²/s²].
    pole: f64,
}

impl BorderedPencil {
    fn at(dynamics: &Dynamics, x: f64) -> Self {
        let mut stiffness = dynamics.constant - dynamics.mass * x;
        let mut mass = dynamics.mass;
        let (mut near, mut cable_masses) = (Vec::new(), Vec::new());

        for (t, term) in dynamics.terms.iter().enumerate() {
            let mut moving = Mat6::zeros();
            if let Some(form) = term.form.by_poles() {
                let (regular, poles) = form.beside_poles(x, NEAR_POLE_FRACTION);
                add_local(&mut stiffness, term, &regular);
                add_local(&mut moving, term, &form.effective_mass_beside_poles(x, NEAR_POLE_FRACTION));
                near.extend(poles.iter().map(|near| NearMode {
                    motion: NearMotion { term: t, family: near.family, pole: near.index, amplitude: 0.0 },
                    participation: term.vector(near.direction),
                    on_supports: dynamics.supports().map_or_else(Vec::new, |of| of.participation(t, near)),
                    pole: near.pole,
                }));
            }
            mass += moving;
            cable_masses.push(moving);
        }

        let at = dynamics.undamped_at(x, NEAR_POLE_FRACTION);
        let supports = dynamics.supports().map(|supports| supports.rows(&dynamics.terms, &at));
        Self { stiffness, mass, cable_masses, near, supports }
    }

    /// A(x) and −dA/dx over the platform's `dof` coordinates and the near modes.
    fn matrices(&self, dof: usize, x: f64) -> (DMat, DMat) {
        let (first, count) = (dof + self.near.len(), self.supports.as_ref().map_or(0, |rows| rows.own.0.nrows()));
        let n = first + count;
        let (mut a, mut m) = (DMat::zeros(n, n), DMat::identity(n, n));
        a.view_mut((0, 0), (dof, dof)).copy_from(&self.stiffness.view((0, 0), (dof, dof)));
        m.view_mut((0, 0), (dof, dof)).copy_from(&self.mass.view((0, 0), (dof, dof)));
        for (k, NearMode { participation, pole, .. }) in self.near.iter().enumerate() {
            let at = dof + k;
            a[(at, at)] = pole - x;
            for i in 0..dof {
                let g = participation[i];
                (a[(i, at)], a[(at, i)]) = (-x * g, -x * g);
                (m[(i, at)], m[(at, i)]) = (g, g);
            }
        }

        if let Some(SupportRows { coupling, own }) = &self.supports {
            for j in 0..count {
                let at = first + j;
                for i in 0..dof {
                    (a[(i, at)], a[(at, i)]) = (coupling.0[(i, j)].re, coupling.0[(i, j)].re);
                    (m[(i, at)], m[(at, i)]) = (-coupling.1[(i, j)].re, -coupling.1[(i, j)].re);
                }
                for (k, NearMode { on_supports, .. }) in self.near.iter().enumerate() {
                    let g = on_supports[j];
                    (a[(dof + k, at)], a[(at, dof + k)]) = (-x * g, -x * g);
                    (m[(dof + k, at)], m[(at, dof + k)]) = (g, g);
                }
                for i in 0..count {
                    a[(first + i, at)] = own.0[(i, j)].re;
                    m[(first + i, at)] = -own.1[(i, j)].re;
                }
            }
        }
        (a, m)
    }

    /// Natural motion from a null vector `v` of A with unit modal mass.
    fn null_vector(&self, dynamics: &Dynamics, omega: f64, v: &[f64], residual: f64) -> NullVector {
        let dof = dynamics.dof();
        let platform = Vec6::from_fn(|i, _| if i < dof { v[i] } else { 0.0 });
        let supports = v[dof + self.near.len()..].to_vec();
        let (near, mut cable_energies) = self.cable_motions(dynamics, (&platform, &supports), &v[dof..]);

        // The supports, and what their motion adds to the energies of their cables.
        let (mut support_energies, mut support_loss) = (Vec::new(), 0.0);
        if let Some(of) = dynamics.supports() {
            (support_energies, support_loss) = of.energies(&supports);
            let at = dynamics.undamped_at(omega * omega, NEAR_POLE_FRACTION);
            let added = of.added_energies(&dynamics.terms, &at, &platform, &supports);
            for (term, added) in dynamics.terms.iter().zip(added) {
                cable_energies[term.cable] += added;
            }
        }

        // The total is 1 except for rounding; dividing by it makes the sum of the fractions exactly 1.
        let platform_energy = platform.dot(&(dynamics.mass * platform));
        let total = platform_energy + cable_energies.iter().sum::<f64>() + support_energies.iter().sum::<f64>();
        for energy in cable_energies.iter_mut().chain(&mut support_energies) {
            *energy /= total;
        }
        let mut motion = NullVector {
            platform,
            near,
            supports,
            platform_energy: platform_energy / total,
            cable_energies,
            drive_energies: Vec::new(),
            stretching: Vec::new(),
            support_energies,
            drive_damping: support_loss / (2.0 * omega * omega * total),
            residual,
        };
        motion.part_drives(dynamics, omega, total);
        motion
    }

    /// Amplitudes of the near modes of all cables, and the energy of each cable of the robot: of its motion with the
    /// platform, and of its near modes. `amplitudes` are in the order of the near modes.
    fn cable_motions(
        &self,
        dynamics: &Dynamics,
        (platform, supports): (&Vec6, &[f64]),
        amplitudes: &[f64],
    ) -> (Vec<NearMotion>, Vec<f64>) {
        let mut energies = vec![0.0; dynamics.cable_count()];
        for (term, moving) in dynamics.terms.iter().zip(&self.cable_masses) {
            energies[term.cable] = platform.dot(&(moving * platform));
        }

        let mut near = Vec::with_capacity(self.near.len());
        for (NearMode { motion, participation, on_supports, .. }, &amplitude) in self.near.iter().zip(amplitudes) {
            let cable = dynamics.terms[motion.term].cable;
            let by_supports: f64 = on_supports.iter().zip(supports).map(|(g, e)| g * e).sum();
            energies[cable] += amplitude * (amplitude + 2.0 * (participation.dot(platform) + by_supports));
            near.push(NearMotion { amplitude, ..*motion });
        }
        (near, energies)
    }
}

impl NullVector {
    /// Parts the energies of the drives from those of their cables, which contain them so far, and adds the losses of
    /// the drives to the damping. `total` is twice the kinetic energy over ω².
    fn part_drives(&mut self, dynamics: &Dynamics, omega: f64, total: f64) {
        for (t, term) in dynamics.terms.iter().enumerate() {
            let Some(form) = term.form.by_poles() else { continue };
            if !(form.has_drive_mass() || form.has_drive_losses() || form.has_strains()) {
                continue;
            }

            // Motions of this cable: of its near modes, and of its far end with the support.
            let of_cable: Vec<(usize, Family, f64)> = (self.near.iter().filter(|near| near.term == t))
                .map(|near| (near.pole, near.family, near.amplitude))
                .collect();
            let carrier = dynamics.supports().and_then(|of| of.both_ends(t).zip(of.ends(t, &self.supports)));
            let by_support =
                carrier.map(|(both, ends)| move |x: f64, left_out: &NearRanges| both.drive_by(x, left_out, &ends));
            let by_support = by_support.as_ref().map(|of| of as &MotionsOfDrive);

            let mut end = term.displacement(&self.platform);
            if let Some(of) = dynamics.supports() {
                let running = of.sheaves().displacement(t, &self.supports);
                end.iter_mut().zip(running).for_each(|(end, running)| *end += running);
            }
            let share = form.drive_share(omega, end, &of_cable, by_support);
            if form.has_drive_mass() {
                self.drive_energies.resize(dynamics.cable_count(), 0.0);
                self.drive_energies[term.cable] = share.mass / total;
                self.cable_energies[term.cable] -= share.mass / total;
            }
            if form.has_strains() {
                self.stretching.resize(dynamics.cable_count(), 0.0);
                self.stretching[term.cable] = share.stretch / (omega * omega * total);
            }
            self.drive_damping += share.loss / (2.0 * omega * omega * total);
        }
    }
}

/// Coordinates without mass, which follow the others.
struct Massless {
    /// Places of the coordinates with mass.
    with_mass: Vec<usize>,
    /// Places of the coordinates without mass.
    without_mass: Vec<usize>,
    /// Coordinates without mass per coordinate with mass.
    follow: DMat,
}

impl Massless {
    /// Vector over all coordinates from one over those with mass.
    fn completed(&self, motion: &[f64]) -> Vec<f64> {
        let mut all = vec![0.0; self.with_mass.len() + self.without_mass.len()];
        self.with_mass.iter().zip(motion).for_each(|(place, value)| all[*place] = *value);
        for (row, place) in self.follow.row_iter().zip(&self.without_mass) {
            all[*place] = row.iter().zip(motion).map(|(follow, value)| follow * value).sum();
        }
        all
    }
}

/// Matrices without the coordinates of supports that have no mass, which begin at `first`; `None` if all have some.
fn without_massless(a: DMat, m: DMat, first: usize) -> (DMat, DMat, Option<Massless>) {
    let (without_mass, with_mass): (Vec<usize>, Vec<usize>) =
        (0..a.nrows()).partition(|i| *i >= first && m[(*i, *i)] == 0.0);
    if without_mass.is_empty() {
        return (a, m, None);
    }
    let block = |of: &DMat, rows: &[usize], columns: &[usize]| of.select_rows(rows).select_columns(columns);
    let held = block(&a, &without_mass, &without_mass).lu().solve(&block(&a, &without_mass, &with_mass));
    let follow = -held.unwrap_or_else(|| DMat::zeros(without_mass.len(), with_mass.len()));
    let reduced = block(&a, &with_mass, &with_mass) + block(&a, &with_mass, &without_mass) * &follow;
    let mass = block(&m, &with_mass, &with_mass);
    (reduced, mass, Some(Massless { with_mass, without_mass, follow }))
}

/// Indices of the `several` values of smallest magnitude, in ascending order of magnitude.
fn nearest_zero(values: &[f64], several: usize) -> impl Iterator<Item = usize> {
    let magnitudes: Vec<f64> = values.iter().map(|value| value.abs()).collect();
    let mut order = order::ascending(&magnitudes);
    order.truncate(several);
    order.into_iter()
}

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

use super::{Dynamics, NEAR_POLE_FRACTION, add_local};
use crate::cable::DynamicCable;
use crate::math::{DMat, Mat6, Vec6, symmetric};

/// Amplitude of one clamped mode of one cable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct NearMotion {
    /// Index of the cable among those whose stiffness depends on frequency.
    pub(crate) term: usize,
    /// True for a mode out of the cable's plane.
    pub(crate) out_of_plane: bool,
    /// Index of the pole among those of the cable in plane or out of plane.
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
    /// Kinetic energy of the platform as a fraction of the total.
    pub(crate) platform_energy: f64,
    /// Kinetic energy of each cable as a fraction of the total.
    pub(crate) cable_energies: Vec<f64>,
    /// Residual |vᵀ A v|/x: twice the relative change of the frequency by another Newton step.
    pub(crate) residual: f64,
}

impl Dynamics {
    /// Natural motions at ω [rad/s]; `several` is their number.
    pub(crate) fn null_vectors(&self, omega: f64, several: usize) -> Vec<NullVector> {
        if self.terms.iter().any(|term| matches!(term.form, DynamicCable::ShallowDynamic(_))) {
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
                    platform_energy: platform / total,
                    cable_energies: cables.iter().map(|mass| mass / total).collect(),
                    residual: values[k].abs() / (omega * omega * total),
                }
            })
            .collect()
    }

    /// Null vectors of the pencil in which each near pole is a separate unknown, for catenary-dynamic cables.
    fn null_vectors_beside_poles(&self, omega: f64, several: usize) -> Vec<NullVector> {
        let x = omega * omega;
        let mut stiffness = self.constant - self.mass * x;
        let mut mass = self.mass;

        // Cables, without the poles near ω.
        let (mut borders, mut cable_masses): (Vec<(NearMotion, Vec6, f64)>, Vec<Mat6>) = (Vec::new(), Vec::new());
        for (t, term) in self.terms.iter().enumerate() {
            let mut moving = Mat6::zeros();
            if let DynamicCable::CatenaryDynamic(form) = &term.form {
                let (regular, poles) = form.beside_poles(x, NEAR_POLE_FRACTION);
                add_local(&mut stiffness, term, &regular, |k, product| k * product);
                add_local(&mut moving, term, &form.effective_mass_beside_poles(x, NEAR_POLE_FRACTION), |m, product| {
                    m * product
                });
                borders.extend(poles.iter().map(|near| {
                    let motion =
                        NearMotion { term: t, out_of_plane: near.out_of_plane, pole: near.index, amplitude: 0.0 };
                    (motion, term.vector(near.direction), near.pole)
                }));
            }
            mass += moving;
            cable_masses.push(moving);
        }

        // The pencil with each near pole as a separate unknown.
        let (f, n) = (self.dof(), self.dof() + borders.len());
        let (mut a, mut m) = (DMat::zeros(n, n), DMat::identity(n, n));
        a.view_mut((0, 0), (f, f)).copy_from(&stiffness.view((0, 0), (f, f)));
        m.view_mut((0, 0), (f, f)).copy_from(&mass.view((0, 0), (f, f)));
        for (k, (_, g, pole)) in borders.iter().enumerate() {
            a[(f + k, f + k)] = pole - x;
            for i in 0..f {
                (a[(i, f + k)], a[(f + k, i)]) = (-x * g[i], -x * g[i]);
                (m[(i, f + k)], m[(f + k, i)]) = (g[i], g[i]);
            }
        }

        // The mass of platform and cables is positive definite, because the motions are independent.
        let Some(factor) = m.cholesky() else { return Vec::new() };
        let l = factor.l();
        let half = l.solve_lower_triangular(&a).unwrap_or(a);
        let standard = l.solve_lower_triangular(&half.transpose()).unwrap_or(half);
        let all = standard.symmetric_eigen();

        nearest_zero(all.eigenvalues.as_slice(), several)
            .map(|k| {
                let v = l.tr_solve_lower_triangular(&all.eigenvectors.column(k)).expect("the factor is regular");

                // Motion of the platform and energies of the cables.
                let platform = Vec6::from_fn(|i, _| if i < f { v[i] } else { 0.0 });
                let mut cable_energies = vec![0.0; self.cable_count()];
                for (term, moving) in self.terms.iter().zip(&cable_masses) {
                    cable_energies[term.cable] = platform.dot(&(moving * platform));
                }

                let mut near = Vec::with_capacity(borders.len());
                for (at, (motion, g, _)) in borders.iter().enumerate() {
                    let amplitude = v[f + at];
                    cable_energies[self.terms[motion.term].cable] += amplitude * (amplitude + 2.0 * g.dot(&platform));
                    near.push(NearMotion { amplitude, ..*motion });
                }

                let platform_energy = platform.dot(&(self.mass * platform));
                // The total is 1 except for rounding; dividing by it makes the sum of the fractions exactly 1.
                let total = platform_energy + cable_energies.iter().sum::<f64>();
                for energy in &mut cable_energies {
                    *energy /= total;
                }
                NullVector {
                    platform,
                    near,
                    platform_energy: platform_energy / total,
                    cable_energies,
                    residual: all.eigenvalues[k].abs() / x,
                }
            })
            .collect()
    }
}

/// Indices of the `several` values of smallest magnitude, in ascending order of magnitude.
fn nearest_zero(values: &[f64], several: usize) -> impl Iterator<Item = usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&i, &j| values[i].abs().total_cmp(&values[j].abs()));
    order.truncate(several);
    order.into_iter()
}

//! Number of natural frequencies below a frequency.

use super::{DynamicCableAt, Dynamics, NEAR_POLE_FRACTION, Supports, add_local};
use crate::cable::shallow_dynamic::{Entire, ShallowDynamic};
use crate::cable::{DynamicCable, LocalStiffness};
use crate::math::{DMat, Mat6, Vec6, symmetric};

impl Dynamics {
    /// Number with the sign of the determinant of the undamped dynamic stiffness of platform and supports at ω [rad/s].
    pub(super) fn determinant_with_supports(&self, supports: &Supports, omega: f64) -> f64 {
        let x = omega * omega;
        let rows = supports.rows(&self.terms, &self.undamped_at(x, 0.0));
        let mut matrix = self.constant - self.mass * x;
        for term in &self.terms {
            add_local(&mut matrix, term, &term.form.undamped(omega));
        }

        // Entries over their size, so that no product overflows.
        let (m, count) = (self.dof(), supports.count());
        let mut all = DMat::zeros(m + count, m + count);
        all.view_mut((0, 0), (m, m)).copy_from(&matrix.view((0, 0), (m, m)));
        for j in 0..count {
            for i in 0..m {
                let entry = rows.coupling.0[(i, j)].re;
                (all[(i, m + j)], all[(m + j, i)]) = (entry, entry);
            }
            (0..count).for_each(|i| all[(m + i, m + j)] = rows.own.0[(i, j)].re);
        }
        let size = all.amax().max(f64::MIN_POSITIVE);
        (all / size).lu().determinant()
    }

    /// Number of natural frequencies below ω [rad/s], undamped, with multiplicity:
    /// `J(ω) = Σ J0_i(ω) + s{D(ω)}` (Wittrick and Williams 1971). The unstable directions of an equilibrium count as
    /// frequencies below every ω > 0.
    ///
    /// # References
    /// W. H. Wittrick, F. W. Williams, Q. J. Mech. Appl. Math. 24(3), 1971; docs/theory.md, equation (28).
    pub fn modes_below(&self, omega: f64) -> usize {
        let clamped: usize = self.terms.iter().map(|t| t.form.clamped_modes_below(omega)).sum();
        clamped + self.negative_eigenvalues(omega)
    }

    /// Number s{D(ω)} of negative eigenvalues of D.
    ///
    /// Near a pole of a cable D has a very large rank-one term κ w wᵀ. It becomes a bordering row,
    /// `[[D, w], [wᵀ, −1/κ]]`, whose last entry passes through zero at the pole of κ. So no term overflows and no
    /// digits are lost: s{D + κ w wᵀ} = s{bordered} − [κ > 0].
    fn negative_eigenvalues(&self, omega: f64) -> usize {
        let bordered = BorderedStiffness::at(self, omega);
        if bordered.borders.is_empty() && self.supports.is_none() {
            return symmetric::negative_eigenvalues(&bordered.regular, self.dof());
        }

        let (mut matrix, n) = bordered.matrix(self, omega);
        let positive = bordered.borders.iter().filter(|(_, inverse)| *inverse > 0.0).count();
        symmetric::negative_eigenvalues_in(&mut matrix, n) - positive
    }
}

/// Stiffness D without the terms κ w wᵀ that are large near a pole, and these terms as borders.
struct BorderedStiffness {
    regular: Mat6,
    /// w and 1/κ of each border.
    borders: Vec<(Vec6, f64)>,
    /// Forces of the borders of catenary-dynamic cables on the supports; empty on a rigid frame. With supports all
    /// cables whose stiffness depends on frequency have that form.
    on_supports: Vec<Vec<f64>>,
}

impl BorderedStiffness {
    /// Stiffness at ω [rad/s].
    fn at(dynamics: &Dynamics, omega: f64) -> Self {
        let x = omega * omega;
        let mut regular = dynamics.constant - dynamics.mass * x;
        let mut borders: Vec<(Vec6, f64)> = Vec::new();
        let mut on_supports: Vec<Vec<f64>> = Vec::new();
        for (t, term) in dynamics.terms.iter().enumerate() {
            match &term.form {
                DynamicCable::ShallowDynamic(form) => {
                    let of = Entire::real(x * form.gamma_by_square);
                    if is_regular(&of, form) {
                        add_local(&mut regular, term, &form.undamped(omega));
                    } else {
                        add_bordered(&mut regular, &mut borders, term, form, &of);
                    }
                }
                DynamicCable::CatenaryDynamic(form) => {
                    let (stiffness, poles) = form.beside_poles(x, NEAR_POLE_FRACTION);
                    add_local(&mut regular, term, &stiffness);
                    borders.extend(poles.iter().map(|near| (term.vector(near.direction), (x - near.pole) / (x * x))));
                    if let Some(supports) = dynamics.supports() {
                        on_supports.extend(poles.iter().map(|near| supports.participation(t, near)));
                    }
                }
            }
        }

        Self { regular, borders, on_supports }
    }

    /// Matrix over the platform, the borders and the supports, by columns, and its size. The stiffness is divided by
    /// its maximum, so that platform and borders are of similar magnitude.
    fn matrix(&self, dynamics: &Dynamics, omega: f64) -> (Vec<f64>, usize) {
        let (m, first) = (dynamics.dof(), dynamics.dof() + self.borders.len());
        let n = first + dynamics.supports().map_or(0, Supports::count);
        let size = self.regular.amax().max(f64::MIN_POSITIVE);

        // Platform and borders.
        let mut a = vec![0.0; n * n];
        for j in 0..m {
            for i in 0..m {
                a[j * n + i] = self.regular[(i, j)] / size;
            }
            for (k, (w, _)) in self.borders.iter().enumerate() {
                a[j * n + m + k] = w[j];
                a[(m + k) * n + j] = w[j];
            }
        }
        for (k, (_, inverse)) in self.borders.iter().enumerate() {
            a[(m + k) * n + m + k] = -inverse * size;
        }

        // Supports.
        let Some(supports) = dynamics.supports() else { return (a, n) };
        let rows = supports.rows(&dynamics.terms, &dynamics.undamped_at(omega * omega, NEAR_POLE_FRACTION));
        for j in 0..supports.count() {
            for i in 0..m {
                let entry = rows.coupling.0[(i, j)].re / size;
                a[(first + j) * n + i] = entry;
                a[i * n + first + j] = entry;
            }
            for (k, participation) in self.on_supports.iter().enumerate() {
                a[(first + j) * n + m + k] = participation[j];
                a[(m + k) * n + first + j] = participation[j];
            }
            for i in 0..supports.count() {
                a[(first + j) * n + first + i] = rows.own.0[(i, j)].re / size;
            }
        }
        (a, n)
    }
}

/// Quotient above which a cable is near a pole. The counts are the same from 1e1 (every second evaluation is bordered)
/// to 1e6 (the sum loses six digits of the soft directions).
const NEAR_POLE: f64 = 1e3;

/// True if no quotient of the shallow-dynamic model is near a pole.
fn is_regular(of: &Entire<f64>, form: &ShallowDynamic) -> bool {
    let determinant = of.c + 0.25 * form.sag.lambda2 * of.q;
    let (antisymmetric, symmetric) = (of.c / of.sigma, of.gamma * of.sigma / of.c);
    let transverse = 1.0 + of.gamma.abs();
    (of.c / determinant).abs() < NEAR_POLE
        && (of.gamma * (of.sigma + 0.25 * form.sag.lambda2 * of.q) / determinant).abs() < NEAR_POLE * transverse
        && antisymmetric.abs() < NEAR_POLE * transverse
        && (form.in_plane_only || symmetric.abs() < NEAR_POLE * transverse)
}

/// Adds a cable near a pole: regular terms to `matrix`, the others as borders (w, 1/κ).
///
/// With the transverse stiffness t = c/σ − γσ/c of a string, the stiffness in plane is `k_a w wᵀ + (τ/l) t n nᵀ` with
/// `w = a + (ε/2)(γq/c) n`: a spring with λ²-softening beside a taut string (docs/theory.md, equation (25)).
fn add_bordered(
    matrix: &mut Mat6,
    borders: &mut Vec<(Vec6, f64)>,
    term: &DynamicCableAt,
    form: &ShallowDynamic,
    of: &Entire<f64>,
) {
    let sag = &form.sag;
    let (along, transverse) = (sag.axial_stiffness / sag.effective_length, sag.tension / sag.chord);
    let Entire { gamma, c, sigma, q } = *of;
    let sagging = 0.25 * sag.lambda2 * q;
    let determinant = c + sagging;

    // The products c t and σ t are regular at the poles of t.
    let string = |w: &Vec6, matrix: &mut Mat6, borders: &mut Vec<(Vec6, f64)>| {
        let numerator = c * c - gamma * sigma * sigma;
        let inverse = sigma * c / numerator;
        if inverse.abs() * NEAR_POLE < 1.0 {
            borders.push((*w, inverse / transverse));
        } else {
            *matrix += w * w.transpose() * (transverse / inverse);
        }
    };

    // Out of plane.
    if !form.in_plane_only {
        string(&term.out, matrix, borders);
    }

    // In plane: the term depends on which of the three stiffnesses is near a pole.
    let turn = 0.5 * sag.epsilon * gamma * q;
    if sigma.abs() * NEAR_POLE < c.abs() {
        // Antisymmetric pole: only c/σ of k_c is large.
        borders.push((term.normal, sigma / c / transverse));
        let normal = -gamma * (sigma + sagging) / determinant * transverse;
        let (axial, coupling) = (c / determinant * along, turn / determinant * along);
        let k = LocalStiffness { axial, coupling, normal, ..LocalStiffness::default() };
        add_local(matrix, term, &k);
    } else if turn.abs() <= c.abs() {
        // Symmetric pole, mainly along the chord.
        let w = term.along + term.normal * (turn / c);
        borders.push((w, determinant / (c * along)));
        string(&term.normal, matrix, borders);
    } else {
        // Symmetric pole of a cable with little sag near (2j − 1)π, mainly along the normal.
        let numerator = determinant * c / sigma - gamma * (sigma + sagging);
        let w = term.normal + term.along * (turn * along / (numerator * transverse));
        borders.push((w, determinant / (numerator * transverse)));
        let axial = along * (c * c / sigma - gamma * sigma) / numerator;
        *matrix += term.along * term.along.transpose() * axial;
    }
}

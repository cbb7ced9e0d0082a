//! Coefficients of a change of a cable's force per length: a second derivative of the cable at rest.

use super::{CableAt, CableForm, CableMotion};
use crate::gradient::adjoint::CableAdjoint;
use crate::gradient::scalar::{Vector, add_times, dot, vector};
use crate::math::Vec3;
use std::array::from_fn;

impl CableForm {
    /// Adds `factor` times the coefficients of `v·∂f/∂L` with the vector `v` held; L is the length of the free span,
    /// whose ends are held.
    ///
    /// `∂f/∂L = S₀⁻¹(S₁ q − d/L)`, where S₀ and S₁ are the integrals of the compliance along the cable, contains the
    /// tension vector in S alone. With `a = S₀⁻¹ v` the differential has the integrals of (60a) over the constant `a`
    /// and over `σ q − ∂f/∂L`, and three terms beside them.
    ///
    /// # References
    /// docs/theory.md, equation (60t).
    pub(in crate::gradient) fn add_force_by_length(
        &self,
        sum: &mut CableAdjoint<f64>,
        v_w: &Vec3,
        force_by_length_w: &Vec3,
        chord_w: &Vec3,
        factor: f64,
    ) {
        let [v, by_length] = [v_w, force_by_length_w].map(|of| -> Vector<f64> { from_fn(|k| self.axes_w[k].dot(of)) });
        let a = self.static_force(&v, None);

        // Integrals along the cable; of the compliance S there is the minus of its derivative in (60a).
        let held = [0.0; 3];
        let constant = vec![a; self.points.len()];
        let growing = self.points.iter().map(|point| {
            let mut change: Vector<f64> = from_fn(|k| -by_length[k]);
            change[1] += point.fraction * self.load;
            change
        });
        let motion = |tension: Vec<Vector<f64>>| CableMotion {
            displacement: Vec::new(),
            tension,
            end_force_w: held,
            theta: held,
            end: Vec::new(),
            far_force: held,
        };
        self.add(sum, &motion(constant), &motion(growing.collect()), (0.0, &CableAt::default()), -factor);

        // Load, chord and length where they stand.
        let mut by_load = [0.0; 3];
        for point in &self.points {
            add_times(&mut by_load, &self.strain(point, &a, None), point.weight * point.fraction);
        }
        let a_w = self.world(&a);
        add_times(&mut sum.load, &self.world(&by_load), factor);
        add_times(&mut sum.chord, &a_w, -factor / self.length);
        sum.free_length += factor * dot(&a_w, &vector(chord_w)) / self.length.powi(2);
    }
}

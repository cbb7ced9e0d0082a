//! Derivative of a hanging cable's end force with respect to the load per length, with ends and length held.

use super::space::HangingCable;
use super::{Catenary, Slope};
use crate::math::{Mat3, Vec3};

impl Catenary {
    /// Derivative of `(H, V_A)` with respect to the weight per length w [m], for a cable with weight.
    ///
    /// `k` is proportional to w, so `w ∂v/∂w = k ∂v/∂k`. Terms of the quotients (7) that cancel each other are left
    /// out.
    fn start_force_by_weight(&self) -> [f64; 2] {
        let half_length = 0.5 * self.rope.unstrained_length;
        let k = self.half_strain_of_weight();
        match self.slope {
            Slope::Slack | Slope::Straight => [0.0; 2],
            Slope::Loop => [0.0, 0.5 * self.rise / ((1.0 + k) * (1.0 + k)) - half_length],
            Slope::Curved { v, tanh_v, sech2_v, .. } => {
                let (.., by_k) = self.parameter_derivatives();
                let (across, along) = (v + k, tanh_v + k);
                [
                    0.5 * self.span / (across * across) * (v - k * by_k),
                    0.5 * self.rise / (along * along) * (tanh_v - k * sech2_v * by_k) - half_length,
                ]
            }
        }
    }
}

impl HangingCable {
    /// Derivative of [`Self::force_on_start_w`] with respect to the vector of the load per unstrained length, with ends
    /// and length held; 3×3, world axes, not symmetric [m].
    ///
    /// A load change normal to the load's direction turns the load. A cable whose ends turn with the load keeps its
    /// shape, so the effect of the turn follows from [`Self::tangent_w`]. For a taut cable without load the derivative
    /// is half the length in all directions. A slack cable without load has no shape to start from; its derivative is
    /// set to zero.
    ///
    /// # References
    /// docs/theory.md, equation (49b).
    pub fn force_by_load_w(&self) -> Mat3 {
        let Catenary { rope, span: x, rise: z, slope, .. } = self.catenary;
        let w = rope.weight_per_length;
        if w == 0.0 {
            let half_length = if slope == Slope::Slack { 0.0 } else { 0.5 * rope.unstrained_length };
            return Mat3::identity() * half_length;
        }

        let (h, u): (Vec3, Vec3) = self.axes_w();
        let o = h.cross(&u);
        let (horizontal, vertical) = (self.catenary.horizontal_force(), self.catenary.vertical_force_at_start());
        let [[hh, hv], [_, vv]] = self.catenary.tangent();

        let [horizontal_by_weight, vertical_by_weight] = self.catenary.start_force_by_weight();
        let by_size = h * horizontal_by_weight + u * vertical_by_weight;
        let by_turn_in_plane = h * ((hh * z - hv * x - vertical) / w) + u * ((hv * z - vv * x + horizontal) / w);
        let by_turn_out_of_plane = o * ((self.catenary.out_of_plane_stiffness() * z - vertical) / w);
        by_turn_in_plane * h.transpose() + by_turn_out_of_plane * o.transpose() - by_size * u.transpose()
    }
}

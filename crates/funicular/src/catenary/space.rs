//! Catenary placed in space: end forces and stiffness in world axes.

use super::{Catenary, CatenaryError, Rope};
use crate::math::{Mat3, Vec3, any_normal};

/// Cable in static equilibrium between a platform point (its start) and an anchor (its end). World axes.
#[derive(Debug, Clone, PartialEq)]
pub struct HangingCable {
    /// Curve in its own plane.
    pub catenary: Catenary,
    /// Start point: the attachment in the world [m].
    pub start_w: Vec3,
    /// End point: the anchor [m].
    pub end_w: Vec3,
    /// Unit vector against its load: up.
    up_w: Vec3,
    /// Horizontal unit vector from start to end; for a vertical cable any horizontal one.
    along_w: Vec3,
}

impl HangingCable {
    /// Cable from `start_w` to `end_w` [m] whose load points against `up_w`.
    ///
    /// # Errors
    /// Errors of [`Catenary::between`], and an error for a direction `up_w` without length.
    pub fn new(start_w: Vec3, end_w: Vec3, up_w: Vec3, rope: Rope) -> Result<Self, CatenaryError> {
        let up = up_w.norm();
        if !(up > 0.0 && up.is_finite()) {
            let must = "finite and positive";
            return Err(CatenaryError::Input { quantity: "length of the upward direction", value: up, must });
        }
        let chord = end_w - start_w;
        Catenary::between(chord.norm(), 0.0, rope)?;
        Ok(Self::between(start_w, end_w, up_w / up, rope))
    }

    /// Cable of [`HangingCable::new`], without checks: for numbers that a [`crate::robot::Robot`] has already checked.
    /// `up_w` is a unit vector.
    #[inline]
    pub(crate) fn between(start_w: Vec3, end_w: Vec3, up_w: Vec3, rope: Rope) -> Self {
        let (span, rise, along_w) = plane(&start_w, &end_w, &up_w);
        Self { catenary: Catenary::solve(span, rise, rope), start_w, end_w, up_w, along_w }
    }

    /// Cable with a given parallel tension [N] instead of a length, see [`Catenary::with_parallel_tension`].
    pub(crate) fn with_parallel_tension(start_w: Vec3, end_w: Vec3, up_w: Vec3, rope: Rope, tension: f64) -> Self {
        let (span, rise, along_w) = plane(&start_w, &end_w, &up_w);
        Self { catenary: Catenary::with_parallel_tension(span, rise, rope, tension), start_w, end_w, up_w, along_w }
    }

    /// Cable between the same points with another parallel tension [N].
    pub(crate) fn at_parallel_tension(&self, tension: f64) -> Self {
        let Catenary { span, rise, rope, .. } = self.catenary;
        Self { catenary: Catenary::with_parallel_tension(span, rise, rope, tension), ..*self }
    }

    /// Cable between the same points with another unstrained length [m].
    pub(crate) fn at_length(&self, unstrained_length: f64) -> Self {
        let Catenary { span, rise, rope, .. } = self.catenary;
        Self { catenary: Catenary::solve(span, rise, Rope { unstrained_length, ..rope }), ..*self }
    }

    /// Vector from start to end [m].
    pub fn chord_w(&self) -> Vec3 {
        self.end_w - self.start_w
    }

    /// Axes of the cable's plane: the horizontal unit vector from start to end, and up.
    pub fn axes_w(&self) -> (Vec3, Vec3) {
        (self.along_w, self.up_w)
    }

    /// Load of the cable per unstrained length, world axes [N/m].
    pub fn load_w(&self) -> Vec3 {
        self.up_w * -self.catenary.rope().weight_per_length
    }

    /// Force of the cable on the body that holds its start, the platform [N].
    #[inline]
    pub fn force_on_start_w(&self) -> Vec3 {
        self.along_w * self.catenary.horizontal_force() + self.up_w * self.catenary.vertical_force_at_start()
    }

    /// Derivative of the force on the start with respect to the unstrained length [N/m].
    pub fn force_by_length_w(&self) -> Vec3 {
        let [h, v] = self.catenary.start_force_by_length();
        self.along_w * h + self.up_w * v
    }

    /// Static stiffness of the start with the end held: minus the derivative of [`Self::force_on_start_w`] with respect
    /// to the start's position; 3×3, world axes, symmetric [N/m].
    pub fn tangent_w(&self) -> Mat3 {
        let [[hh, hv], [_, vv]] = self.catenary.tangent();
        let (h, v) = (&self.along_w, &self.up_w);
        let out = h.cross(v);
        let hv_product = h * v.transpose();
        h * h.transpose() * hh
            + (hv_product + hv_product.transpose()) * hv
            + v * v.transpose() * vv
            + out * out.transpose() * self.catenary.out_of_plane_stiffness()
    }

    /// Potential energy [J]; its gradient with respect to the start is minus [`Self::force_on_start_w`].
    pub fn energy(&self) -> f64 {
        self.catenary.energy() + self.catenary.weight() * self.start_w.dot(&self.up_w)
    }

    /// Position of the point at unstrained arc length `s` [m] from the start, world axes [m].
    pub fn point_w(&self, s: f64) -> Vec3 {
        let [x, z] = self.catenary.point_at(s);
        self.start_w + self.along_w * x + self.up_w * z
    }
}

/// Span over rise below which the horizontal direction of a chord is computed twice. Rounding of the first result is
/// 1e-16 of the rise, so elsewhere its error is below 1e-8 of the direction.
const NEARLY_VERTICAL: f64 = 1e-8;

/// Span, rise and horizontal direction from one point to another.
#[inline]
fn plane(start_w: &Vec3, end_w: &Vec3, up_w: &Vec3) -> (f64, f64, Vec3) {
    let chord = end_w - start_w;
    let rise = chord.dot(up_w);
    let mut across = chord - up_w * rise;
    let mut span = across.norm();
    // For a cable that is vertical to rounding, the remaining horizontal part is rounding and may even point up: make
    // it horizontal again.
    if span < NEARLY_VERTICAL * rise.abs() {
        across -= up_w * across.dot(up_w);
        // If most of it pointed up, all of it was rounding: the cable is vertical.
        span = if across.norm() < 0.5 * span { 0.0 } else { across.norm() };
    }
    (span, rise, if span > 0.0 { across / span } else { any_normal(up_w) })
}
